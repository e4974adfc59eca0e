"""Common: the conditions of relations in words, how they are judged, and what several formulas share."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.facts.errors import ParameterError
from radiokit.facts.quantities import Q
from radiokit.physics.relate.givens import Shown
from radiokit.physics.relate.relation import Relation

__all__ = [
    "AXIS",
    "CAMERA",
    "DIFFUSE",
    "EVEN",
    "FLAT",
    "ISOTROPIC",
    "POINT",
    "SMALL",
    "STEADY",
    "above_horizon",
    "at_most_all",
    "at_most_one",
    "ball",
    "cone",
    "cos",
    "five_times",
    "pi",
    "row",
    "sine",
    "small",
    "small_area",
    "sphere_from",
    "sr",
]

AXIS = {"angle_deg": 0.0}
STEADY = "the flux does not change meanwhile"
EVEN = "it is the same everywhere on the area; otherwise this is the mean"
ISOTROPIC = "the source is isotropic: the same intensity in all directions"
DIFFUSE = "the surface is Lambertian: the same radiance in all directions"
FLAT = "the source is flat and Lambertian, and the intensity is that along its normal"
POINT = "the source is a point: at least five of its diameters away (then the error is at most 1 %)"
SMALL = "the solid angle is small: the cosine is the same all over it"
CAMERA = "the lens focuses far away, and the object fills the pixel"


def sr() -> Any:
    """Return 1 sr."""
    return Q("1 sr")


def pi() -> Any:
    """Return π sr, the projected solid angle of a hemisphere."""
    return Q("1 sr") * math.pi


def cos(angle: Any) -> Any:
    """Return the cosine of an angle, 0 at 90°."""
    return np.sin(np.radians(90.0 - angle.to("deg").magnitude))  # exactly 0 at 90°


def five_times(*, distance: Any, diameter: Any = None, **_: Any) -> str | None:
    """Judge the five-times rule; an error of (D/2d)² is what a disk gives."""
    if diameter is None:
        return None
    ratio = (
        float(np.min((distance / diameter).to("").magnitude))
        if float(np.max(diameter.magnitude))
        else math.inf
    )
    if ratio >= 5:
        return ""
    return f"only {ratio:.3g} diameters away: the error is up to {25 / ratio**2:.2g} %"


def sine(radius: Any, distance: Any) -> Any:
    """Return the sine of a ball's angular radius."""
    sine = (radius / distance).to("").magnitude
    if np.any(np.asarray(sine) >= 1):
        raise ParameterError(
            "radius", Shown(radius), "smaller than the distance, which counts from the centre"
        )
    return sine


def above_horizon(*, radius: Any, distance: Any, angle_deg: Any, **_: Any) -> str | None:
    """Judge whether all of a ball is above the receiver's horizon."""
    edge = np.degrees(np.arcsin(sine(radius, distance))) + angle_deg.to("deg").magnitude
    return "" if np.all(edge <= 90) else "part of the sphere is below the receiver's horizon"


def small(*, solid_angle: Any, **_: Any) -> str | None:
    """Judge whether a solid angle is small."""
    value = float(np.max(solid_angle.to("sr").magnitude))
    return "" if value <= 0.1 else f"{value:.3g} sr is not small"


def small_area(*, area: Any, distance: Any, **_: Any) -> str | None:
    """Judge whether an area is small against the distance squared."""
    ratio = float(np.max((area / distance**2).to("").magnitude))
    return "" if ratio <= 0.03 else f"the area is {ratio:.3g} of the distance squared: not small"


def sphere_from(*, flux: Any, area: Any, reflectance: Any, port_share: Any) -> Any:
    """Return the radiance in an integrating sphere, without the cancellation of 1 − ρ(1 − p)."""
    rho, p = reflectance.to("").magnitude, port_share.to("").magnitude
    return flux / (pi() * area) * (rho / ((1 - rho) + rho * p))


def cone(half_angle_deg: Any) -> Any:
    """Return 2π(1 − cosα) sr, which is 4π sin²(α/2) sr."""
    return 4 * pi() * np.sin(0.5 * half_angle_deg.to("rad").magnitude) ** 2


def ball(radius: Any, distance: Any) -> Any:
    """Return the solid angle of a ball."""
    return 4 * pi() * np.sin(0.5 * np.arcsin(sine(radius, distance))) ** 2


def at_most_all(*, exitance: Any, irradiance: Any) -> str | None:
    """Judge whether more leaves than arrives."""
    return "" if np.all((exitance / irradiance).to("").magnitude <= 1) else "more leaves than arrives"


def at_most_one(*, bsdf: Any) -> str | None:
    """Judge whether a diffuse surface reflects more than arrives."""
    return "" if np.all((pi() * bsdf).to("").magnitude <= 1) else "more leaves than arrives"


def row(
    name: str,
    target: str,
    needs: str,
    formula: str,
    compute: Any,
    condition: str,
    derivation: str,
    **more: Any,
) -> Relation:
    """Return an entry of the table; ``needs`` are names with spaces between."""
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
