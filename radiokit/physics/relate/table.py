"""Table: the relations between the quantities of light, an entry for each way from the one to the other."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.facts.errors import ParameterError
from radiokit.facts.quantities import Q
from radiokit.physics.relate.givens import Shown
from radiokit.physics.relate.relation import Relation

__all__ = ["RELATIONS"]

_AXIS = {"angle_deg": 0.0}
_STEADY = "the flux does not change meanwhile"
_EVEN = "it is the same everywhere on the area; otherwise this is the mean"
_ISOTROPIC = "the source is isotropic: the same intensity in all directions"
_DIFFUSE = "the surface is Lambertian: the same radiance in all directions"
_FLAT = "the source is flat and Lambertian, and the intensity is that along its normal"
_POINT = "the source is a point: at least five of its diameters away (then the error is at most 1 %)"
_SMALL = "the solid angle is small: the cosine is the same all over it"
_CAMERA = "the lens focuses far away, and the object fills the pixel"


def _sr() -> Any:
    return Q("1 sr")


def _pi() -> Any:
    return Q("1 sr") * math.pi


def _cos(angle: Any) -> Any:
    return np.sin(np.radians(90.0 - angle.to("deg").magnitude))  # exactly 0 at 90°


def _five_times(*, distance: Any, diameter: Any = None, **_: Any) -> str | None:
    if diameter is None:
        return None
    ratio = float(np.min((distance / diameter).to("").magnitude)) if float(np.max(diameter.magnitude)) else math.inf
    if ratio >= 5:
        return ""
    return f"only {ratio:.3g} diameters away: the error is up to {25 / ratio**2:.2g} %"


def _sine(radius: Any, distance: Any) -> Any:
    sine = (radius / distance).to("").magnitude
    if np.any(np.asarray(sine) >= 1):
        raise ParameterError("radius", Shown(radius), "smaller than the distance, which counts from the centre")
    return sine


def _above_horizon(*, radius: Any, distance: Any, angle_deg: Any, **_: Any) -> str | None:
    edge = np.degrees(np.arcsin(_sine(radius, distance))) + angle_deg.to("deg").magnitude
    return "" if np.all(edge <= 90) else "part of the sphere is below the receiver's horizon"


def _small(*, solid_angle: Any, **_: Any) -> str | None:
    value = float(np.max(solid_angle.to("sr").magnitude))
    return "" if value <= 0.1 else f"{value:.3g} sr is not small"


def _small_area(*, area: Any, distance: Any, **_: Any) -> str | None:
    ratio = float(np.max((area / distance**2).to("").magnitude))
    return "" if ratio <= 0.03 else f"the area is {ratio:.3g} of the distance squared: not small"


def _sphere_from(*, flux: Any, area: Any, reflectance: Any, port_share: Any) -> Any:
    rho, p = reflectance.to("").magnitude, port_share.to("").magnitude
    return flux / (_pi() * area) * (rho / ((1 - rho) + rho * p))


def _cone(half_angle_deg: Any) -> Any:
    return 4 * _pi() * np.sin(0.5 * half_angle_deg.to("rad").magnitude) ** 2


def _ball(radius: Any, distance: Any) -> Any:
    return 4 * _pi() * np.sin(0.5 * np.arcsin(_sine(radius, distance))) ** 2


def _at_most_all(*, exitance: Any, irradiance: Any) -> str | None:
    return "" if np.all((exitance / irradiance).to("").magnitude <= 1) else "more leaves than arrives"


def _at_most_one(*, bsdf: Any) -> str | None:
    return "" if np.all((_pi() * bsdf).to("").magnitude <= 1) else "more leaves than arrives"


def _row(name: str, target: str, needs: str, formula: str, compute: Any, condition: str, derivation: str, **more: Any) -> Relation:
    return Relation(
        name=name,
        target=target,
        needs=tuple(needs.split()),
        formula=formula,
        compute=compute,
        condition=condition,
        derivation=derivation,
        **more,
    )


_FLUX = (
    _row("energy-from-flux", "energy", "flux time", r"Q = \Phi t",
         lambda flux, time: flux * time, _STEADY, "flux-from-energy"),
    _row("flux-from-energy", "flux", "energy time", r"\Phi = \frac{Q}{t}",
         lambda energy, time: energy / time, _STEADY, "flux-from-energy"),
    _row("isotropic-flux", "flux", "intensity", r"\Phi = 4 \pi I",
         lambda intensity: 4 * _pi() * intensity, _ISOTROPIC, "isotropic-flux"),
    _row("lambertian-flux", "flux", "intensity", r"\Phi = \pi I",
         lambda intensity: _pi() * intensity, _FLAT, "lambertian-disk-flux"),
    _row("flux-into-solid-angle", "flux", "intensity solid_angle", r"\Phi = I \Omega",
         lambda intensity, solid_angle: intensity * solid_angle, "the intensity is the same all over the solid angle",
         "definition-graph"),
    _row("flux-on-area", "flux", "irradiance area", r"\Phi = E A",
         lambda irradiance, area: irradiance * area, _EVEN, "definition-graph"),
    _row("flux-from-area", "flux", "exitance area", r"\Phi = M A",
         lambda exitance, area: exitance * area, _EVEN, "definition-graph"),
    _row("flux-of-lambertian-area", "flux", "radiance area", r"\Phi = \pi L A",
         lambda radiance, area: _pi() * radiance * area, _DIFFUSE, "lambertian-exitance"),
    _row("flux-of-beam", "flux", "radiance area solid_angle", r"\Phi = L A \Omega \cos\theta",
         lambda radiance, area, solid_angle, angle_deg: radiance * area * solid_angle * _cos(angle_deg),
         _SMALL, "definition-graph", may=_AXIS, judge=_small),
)  # fmt: skip

_INTENSITY = (
    _row("isotropic-intensity", "intensity", "flux", r"I = \frac{\Phi}{4 \pi}",
         lambda flux: flux / (4 * _pi()), _ISOTROPIC, "isotropic-flux"),
    _row("lambertian-axial-intensity", "intensity", "flux", r"I = \frac{\Phi}{\pi}",
         lambda flux: flux / _pi(), _FLAT, "lambertian-disk-flux"),
    _row("intensity-in-solid-angle", "intensity", "flux solid_angle", r"I = \frac{\Phi}{\Omega}",
         lambda flux, solid_angle: flux / solid_angle, "it is the same all over the solid angle; otherwise this is the mean",
         "definition-graph"),
    _row("intensity-from-irradiance", "intensity", "irradiance distance", r"I = \frac{E r^2}{\Omega_0 \cos\theta}",
         lambda irradiance, distance, angle_deg: irradiance * distance**2 / (_sr() * _cos(angle_deg)),
         _POINT, "irradiance-from-intensity", may=_AXIS, notes=("diameter",), judge=_five_times),
    _row("intensity-of-area", "intensity", "radiance area", r"I = L A \cos\theta",
         lambda radiance, area, angle_deg: radiance * area * _cos(angle_deg),
         "the radiance is the same everywhere on the area, which is flat", "lambertian-intensity", may=_AXIS),
)  # fmt: skip

_IRRADIANCE = (
    _row("irradiance-from-intensity", "irradiance", "intensity distance", r"E = \frac{I \cos\theta}{r^2} \Omega_0",
         lambda intensity, distance, angle_deg: intensity * _cos(angle_deg) / distance**2 * _sr(),
         _POINT, "irradiance-from-intensity", may=_AXIS, notes=("diameter",), judge=_five_times),
    _row("irradiance-on-area", "irradiance", "flux area", r"E = \frac{\Phi}{A}",
         lambda flux, area: flux / area, _EVEN, "definition-graph"),
    _row("irradiance-from-isotropic-flux", "irradiance", "flux distance", r"E = \frac{\Phi \cos\theta}{4 \pi r^2}",
         lambda flux, distance, angle_deg: flux * _cos(angle_deg) / (4 * math.pi * distance**2),
         f"{_ISOTROPIC}, and a point", "inverse-square-law", may=_AXIS, notes=("diameter",), judge=_five_times, pi="1"),
    _row("irradiance-at-new-distance", "irradiance", "irradiance distance new_distance", r"E_s = E \frac{r^2}{s^2}",
         lambda irradiance, distance, new_distance: irradiance * (distance / new_distance).to("").magnitude ** 2,
         _POINT, "inverse-square-law"),
    _row("irradiance-from-solid-angle", "irradiance", "radiance solid_angle", r"E = L \Omega \cos\theta",
         lambda radiance, solid_angle, angle_deg: radiance * solid_angle * _cos(angle_deg),
         _SMALL, "irradiance-from-radiance", may=_AXIS, judge=_small),
    _row("irradiance-from-hemisphere", "irradiance", "radiance", r"E = \pi L",
         lambda radiance: _pi() * radiance, "the same radiance arrives from the whole hemisphere",
         "irradiance-from-hemisphere"),
    _row("irradiance-from-sphere", "irradiance", "radiance radius distance",
         r"E = \pi L \frac{R^2}{r^2} \cos\theta",
         lambda radiance, radius, distance, angle_deg: _pi() * radiance * (radius / distance) ** 2 * _cos(angle_deg),
         "the source is a Lambertian sphere, r from its centre, all of it above the receiver's horizon", "irradiance-from-sphere",
         may=_AXIS, judge=_above_horizon),
    _row("irradiance-under-disk", "irradiance", "radiance radius distance", r"E = \pi L \frac{R^2}{R^2 + r^2}",
         lambda radiance, radius, distance: _pi() * radiance * radius**2 / (radius**2 + distance**2),
         "the source is a Lambertian disk that faces the receiver, which is on its axis", "irradiance-under-disk"),
    _row("irradiance-on-sensor", "irradiance", "radiance f_number",
         r"E = \frac{\pi \tau L \cos^4\theta}{4 N^2}",
         lambda radiance, f_number, angle_deg, transmittance: (
             _pi() * radiance * transmittance * _cos(angle_deg) ** 4 / (4 * f_number**2)),
         _CAMERA, "camera-equation", may={"angle_deg": 0.0, "transmittance": 1.0}),
)  # fmt: skip

_LEAVING = (
    _row("exitance-of-area", "exitance", "flux area", r"M = \frac{\Phi}{A}",
         lambda flux, area: flux / area, _EVEN, "definition-graph"),
    _row("lambertian-exitance", "exitance", "radiance", r"M = \pi L",
         lambda radiance: _pi() * radiance, _DIFFUSE, "lambertian-exitance"),
    _row("reflected-exitance", "exitance", "irradiance reflectance", r"M = \rho E",
         lambda irradiance, reflectance: irradiance * reflectance, "the surface gives out no light of its own",
         "flux-balance"),
    _row("lambertian-radiance", "radiance", "exitance", r"L = \frac{M}{\pi}",
         lambda exitance: exitance / _pi(), _DIFFUSE, "lambertian-exitance"),
    _row("radiance-from-intensity", "radiance", "intensity area", r"L = \frac{I}{A \cos\theta}",
         lambda intensity, area, angle_deg: intensity / (area * _cos(angle_deg)), _EVEN, "radiance-from-others",
         may=_AXIS),
    _row("radiance-from-irradiance", "radiance", "irradiance solid_angle", r"L = \frac{E}{\Omega \cos\theta}",
         lambda irradiance, solid_angle, angle_deg: irradiance / (solid_angle * _cos(angle_deg)),
         _SMALL, "radiance-from-others", may=_AXIS, judge=_small),
    _row("radiance-of-beam", "radiance", "flux area solid_angle", r"L = \frac{\Phi}{A \Omega \cos\theta}",
         lambda flux, area, solid_angle, angle_deg: flux / (area * solid_angle * _cos(angle_deg)),
         _SMALL, "definition-graph", may=_AXIS, judge=_small),
    _row("reflected-radiance", "radiance", "irradiance bsdf", r"L = f E",
         lambda irradiance, bsdf: irradiance * bsdf, "the light comes from one direction, to which f belongs",
         "brdf-definition"),
    _row("diffusely-reflected-radiance", "radiance", "irradiance reflectance", r"L = \frac{\rho E}{\pi}",
         lambda irradiance, reflectance: reflectance * irradiance / _pi(), _DIFFUSE, "lambertian-brdf"),
    _row("radiance-from-sensor", "radiance", "irradiance f_number",
         r"L = \frac{4 N^2 E}{\pi \tau \cos^4\theta}",
         lambda irradiance, f_number, angle_deg, transmittance: (
             4 * f_number**2 * irradiance / (_pi() * transmittance * _cos(angle_deg) ** 4)),
         _CAMERA, "camera-equation", may={"angle_deg": 0.0, "transmittance": 1.0}),
    _row("radiance-in-sphere", "radiance", "flux area reflectance",
         r"L = \frac{\Phi \rho}{\pi A (1 - \rho (1 - p))}", _sphere_from,
         "it is an integrating sphere, A its whole area, with a Lambertian wall on which the flux falls first",
         "integrating-sphere", may={"port_share": 0.0}),
)  # fmt: skip

_SURFACES = (
    _row("lambertian-brdf", "bsdf", "reflectance", r"f = \frac{\rho}{\pi}",
         lambda reflectance: reflectance / _pi(), _DIFFUSE, "lambertian-brdf"),
    _row("brdf-from-radiance", "bsdf", "radiance irradiance", r"f = \frac{L}{E}",
         lambda radiance, irradiance: radiance / irradiance, "the light comes from one direction", "brdf-definition"),
    _row("reflectance-from-exitance", "reflectance", "exitance irradiance", r"\rho = \frac{M}{E}",
         lambda exitance, irradiance: exitance / irradiance, "the surface gives out no light of its own",
         "flux-balance", judge=_at_most_all),
    _row("reflectance-from-brdf", "reflectance", "bsdf", r"\rho = \pi f",
         lambda bsdf: _pi() * bsdf, "f is the same for all directions", "lambertian-brdf", judge=_at_most_one),
    _row("solid-angle-of-area", "solid_angle", "area distance", r"\Omega = \Omega_0 \frac{A \cos\theta}{r^2}",
         lambda area, distance, angle_deg: _sr() * area * _cos(angle_deg) / distance**2,
         "the area is small against the distance squared", "irradiance-from-intensity", may=_AXIS, judge=_small_area),
    _row("solid-angle-of-cone", "solid_angle", "half_angle_deg", r"\Omega = 4 \pi \sin^2(\frac{\alpha}{2})",
         lambda half_angle_deg: _cone(half_angle_deg), "the cone is round", "solid-angle-of-cone"),
    _row("solid-angle-of-sphere", "solid_angle", "radius distance", r"\Omega = 2 \pi (1 - (1 - \frac{R^2}{r^2})^{1/2})",
         lambda radius, distance: _ball(radius, distance), "it is a sphere, r from its centre", "solid-angle-of-cone"),
)  # fmt: skip


def _crossing(role: str, symbol: str) -> tuple[Relation, Relation]:
    condition = "the efficacy K is that of the light's spectrum: 683 lm/W times the mean of V(λ)"
    kinds = (role, "luminous_efficacy")
    return (
        Relation(
            name=f"photometric-{role}",
            target=role,
            needs=kinds,
            formula=rf"{symbol}_v = K {symbol}_e",
            compute=lambda luminous_efficacy, **light: light[role] * luminous_efficacy,
            condition=condition,
            derivation="luminous-flux",
            crosses="photometric",
        ),
        Relation(
            name=f"radiometric-{role}",
            target=role,
            needs=kinds,
            formula=rf"{symbol}_e = \frac{{{symbol}_v}}{{K}}",
            compute=lambda luminous_efficacy, **light: light[role] / luminous_efficacy,
            condition=condition,
            derivation="luminous-flux",
            crosses="radiometric",
        ),
    )


_TWINS = tuple(
    relation
    for role, symbol in (
        ("energy", "Q"),
        ("flux", r"\Phi"),
        ("intensity", "I"),
        ("irradiance", "E"),
        ("exitance", "M"),
        ("radiance", "L"),
    )
    for relation in _crossing(role, symbol)
)

RELATIONS: tuple[Relation, ...] = (*_FLUX, *_INTENSITY, *_IRRADIANCE, *_LEAVING, *_SURFACES, *_TWINS)
