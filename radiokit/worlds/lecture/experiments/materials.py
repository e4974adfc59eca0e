"""Materials: experiments on what surfaces do with light, and on the assumptions that a BRDF rests on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.contracts.albedo import albedo
from radiokit.contracts.bsdf import bsdf
from radiokit.contracts.emitter import emitter
from radiokit.facts.verdict import Verdict
from radiokit.physics.integrating_sphere import IntegratingSphere
from radiokit.worlds.lecture.deciding import found
from radiokit.worlds.lecture.experiments.optics import polarised_and_not
from radiokit.worlds.shading import shade

__all__ = [
    "by_wavelength",
    "conservation",
    "diffuse_albedo",
    "elsewhere",
    "facets_scatter",
    "fluorescent",
    "furnace",
    "glowing",
    "kinds_of_scattering",
    "polarisation_added",
    "proportional",
    "reciprocal",
    "share_passed",
    "shrinking_lamp",
    "sum_of_lamps",
    "switched_on",
    "there_and_back",
    "two_lamps",
]

_TILT = (0.6, 0.0, 0.8)
_PAIRS = [
    ((0.6, 0.0, 0.8), (-0.28, 0.0, 0.96)),
    ((0.0, 0.8, 0.6), (0.48, 0.36, 0.8)),
    ((0.36, -0.48, 0.8), (0, 0, 1)),
]


def _lamps() -> list[Any]:
    return [
        emitter("point", position=(0.5, 0.0, 2.0), intensity=3.0),
        emitter("point", position=(-1.0, 1.0, 1.5), intensity=5.0),
    ]


def two_lamps(power: int) -> Verdict:
    """The response to two lamps and to each alone, where it goes as a power of the light."""
    f, lamps = bsdf("ggx", alpha=0.5), _lamps()
    both = float(shade(f, lamps, _TILT).value) ** power
    each = sum(float(shade(f, lamp, _TILT).value) ** power for lamp in lamps)
    return found(
        "together as much as one by one",
        both / each,
        1.0,
        1e-9,
        f"both lamps at once give {both / each:.4g} of what they give one by one (response of order {power})",
    )


def conservation() -> tuple[Verdict, ...]:
    """Albedos of lossless and rough surfaces, and of a formula that gives out more than it gets."""
    up = (0.0, 0.0, 1.0)
    verdicts = []
    for name, parameters in (("lambert", {"reflectance": 1.0}), ("ggx", {"alpha": 1.0}), ("phong", {})):
        value = float(albedo(bsdf(name, **parameters), up).value)
        verdicts.append(
            found(f"{name} gives no more", value <= 1 + 1e-9, True, 0, f"albedo of {name}: {value:.6f}")
        )
    value = float(albedo(bsdf("blinn_phong", exponent=10.0, normalization="n+8"), up).value)
    message = f"Blinn-Phong with (n + 8)/8π has {value:.4f}: it is caught"
    return (*verdicts, found("one that breaks the law is caught", value > 1.07, True, 0, message))


def polarisation_added(theta_deg: float = 56.309932474) -> tuple[Verdict, ...]:
    """Two numbers a ray in the place of one, for s and p, and a matrix in the place of a reflectance."""
    s, p = polarised_and_not(theta_deg)
    ray = np.diag([s, p]) @ np.diag([s, p]) @ np.array([0.5, 0.5])
    spectrum = np.array([[0.2, 0.0], [0.3, 0.4]]) @ np.array([1.0, 0.0])
    return (
        found(
            "s and p kept apart",
            float(ray.sum()),
            0.5 * (s * s + p * p),
            1e-15,
            "two numbers a ray are exact",
        ),
        found("light changes its wavelength", float(spectrum[1]), 0.3, 1e-15, "a matrix moves light to λ₂"),
    )


def fluorescent(moved: float) -> Verdict:
    """Light of λ₁ alone on a paint that moves a share of it to λ₂: what a reflectance at λ₂ says of it."""
    paint = np.array([[0.2, 0.0], [moved, 0.4]])  # rows: out, columns: in
    arriving = np.array([1.0, 0.0])
    leaving, alone = float((paint @ arriving)[1]), float(paint[1, 1] * arriving[1])
    message = f"nothing arrives at λ₂, and {leaving:g} leaves there; a reflectance gives {alone:g}"
    return found("one wavelength knows nothing of another", leaving, alone, 1e-15, message)


def switched_on(time_constants: float) -> Verdict:
    """The radiance in an integrating sphere of 1 m and reflectance 0.99, some time after the lamp is on."""
    tau = float(IntegratingSphere(radius=1.0, reflectance=0.99).time_constant)
    share = -math.expm1(-time_constants)
    message = f"{1e9 * tau * time_constants:.4g} ns after the lamp is on, {share:.6f} of the light is there"
    return found("the light does not depend on time", share, 1.0, 1e-9, message)


def elsewhere(scatter_mm: float, radius_mm: float = 1.0) -> Verdict:
    """Light enters at a point and leaves with a Gaussian spread; the share that leaves beyond a radius."""
    share = math.exp(-0.5 * (radius_mm / scatter_mm) ** 2)
    message = f"{share:.3g} of the light leaves more than {radius_mm:g} mm from where it entered"
    return found("light leaves where it arrives", share, 0.0, 1e-12, message)


def proportional(name: str = "phong_original") -> tuple[Verdict, ...]:
    """Twice the light gives twice the radiance, also of a formula that keeps no other law."""
    verdicts = []
    for each in ("lambert", "ggx", name):
        f = bsdf(each)
        one, two = (
            float(shade(f, emitter("point", position=(1, 0, 2), intensity=i), _TILT).value) for i in (1, 2)
        )
        verdicts.append(
            found(f"{each} is proportional", two / one, 2.0, 1e-12, f"{each}: {two / one:.9g} times")
        )
    return tuple(verdicts)


def reciprocal() -> tuple[Verdict, ...]:
    """f(wi, wo) and f(wo, wi) of two physical models, and of a formula that breaks the law."""
    verdicts = []
    for name in ("lambert", "ggx", "phong_original"):
        f = bsdf(name)
        gap = max(abs(float(f(a, b)) - float(f(b, a))) for a, b in _PAIRS)
        keeps = name != "phong_original"
        shown = f"{name}: the two values differ by {gap:.2g}{'' if keeps else ', it is caught'}"
        verdicts.append(found(f"{name} exchanged", gap < 1e-12, keeps, 0, shown))
    return tuple(verdicts)


def there_and_back(divided: bool, eta: float = 1.5) -> Verdict:
    """Through rough glass from above to below and back: f, or f/n², n where the light goes to."""
    f = bsdf("rough_dielectric", alpha=0.4, eta=eta)
    above = np.array([0.3, 0.1, math.sqrt(0.9)])
    below = np.array([-0.25, 0.05, -math.sqrt(1 - 0.25**2 - 0.05**2)])
    ratio = float(f(above, below)) / float(f(below, above))
    if divided:
        ratio /= eta**2
    message = f"{'f/n²' if divided else 'f'} there is {ratio:.9g} times that back"
    return found("the same both ways", ratio, 1.0, 1e-9, message)


def furnace(reflectance: float = 0.6) -> tuple[Verdict, ...]:
    """A diffuse surface under a sky of radiance 1: ∫ f L cosθ dω by quadrature and in closed form."""
    sky, f = emitter("constant", radiance=1.0), bsdf("lambert", reflectance=reflectance)
    return tuple(
        found(
            "L_o = ρ L",
            float(shade(f, sky, _TILT, method=method).value),
            reflectance,
            1e-6,
            f"by {method}: {float(shade(f, sky, _TILT, method=method).value):.9f}",
        )
        for method in ("quadrature", "closed form")
    )


def diffuse_albedo(reflectance: float) -> tuple[Verdict, ...]:
    """The value and the albedo of a diffuse surface."""
    f = bsdf("lambert", reflectance=reflectance)
    value, share = float(f(_TILT, _TILT)), float(albedo(f, _TILT).value)
    message = f"a diffuse surface of albedo {share:.6f} has f = {value * math.pi:.6g}/π"
    return (found("f = 1/π", value, 1 / math.pi, 1e-12, message),)


def shrinking_lamp(mirror: bool) -> tuple[Verdict, ...]:
    """A ball of radiance 1 in the mirror direction, smaller and smaller: what is seen in the surface."""
    f = bsdf("mirror", reflectance=1.0) if mirror else bsdf("lambert", reflectance=1.0)
    verdicts = []
    for radius in (0.1, 0.001):
        ball = emitter("sphere", center=(3, 0, 4), radius=radius, radiance=1.0)
        seen = float(shade(f, ball, (-0.6, 0.0, 0.8)).value)
        message = f"of a ball of radius {radius:g} m at 5 m, radiance {seen:.3g} of 1 is seen"
        verdicts.append(found("a mirror shows the lamp itself", seen, 1.0, 1e-9, message))
    return tuple(verdicts)


def share_passed(name: str, **parameters: float) -> Verdict:
    """Reflected and transmitted light together, of what arrives at an interface."""
    lobes = bsdf(name, **parameters).delta_lobes(np.array([_TILT]))
    share = float(sum(lobe.weight[0] for lobe in lobes))
    return found(
        "R + T = 1", share, 1.0, 1e-12, f"{name}: reflected and transmitted are {share:.4f} of what arrives"
    )


def glowing(emissivity: float) -> Verdict:
    """A body in a furnace of radiance 1 at the furnace's temperature: its own light, and what it reflects."""
    f = bsdf("lambert", reflectance=1 - emissivity)
    reflected = float(shade(f, emitter("constant", radiance=1.0), _TILT).value)
    message = f"{reflected:g} is reflected of the {reflected + emissivity:g} that is seen"
    return found("all the light is reflected light", reflected, reflected + emissivity, 1e-12, message)


def by_wavelength() -> Verdict:
    """A surface of three wavelengths at once, and each of them alone."""
    spectrum, lamp = (0.1, 0.5, 0.9), emitter("point", position=(0, 0, 2), intensity=3.0)
    at_once = np.asarray(shade(bsdf("lambert", reflectance=spectrum), lamp, _TILT).value)
    alone = [float(shade(bsdf("lambert", reflectance=share), lamp, _TILT).value) for share in spectrum]
    gap = float(np.max(np.abs(at_once - alone)))
    return found("each wavelength for itself", gap, 0.0, 1e-15, f"at once and one by one differ by {gap:.1g}")


def sum_of_lamps(factor: str) -> Verdict:
    """Σ f L cosθ over two small balls, L their radiance, or their irradiance on a surface that faces them."""
    f = bsdf("ggx", alpha=0.5)
    centers = [np.array([0.6, 0.0, 2.0]), np.array([-1.0, 1.0, 1.5])]
    total = 0.0
    for center in centers:
        distance = float(np.linalg.norm(center))
        wi = center / distance
        factors = {"radiance": 2.0, "irradiance": 2.0 * math.pi * (0.001 / distance) ** 2}
        total += float(f(wi, _TILT)) * factors[factor] * wi[2]
    balls = [emitter("sphere", center=tuple(c), radius=0.001, radiance=2.0) for c in centers]
    truth = float(shade(f, balls, _TILT).value)
    message = f"with the {factor} of each lamp the sum is {total / truth:.7g} of the radiance that is seen"
    return found("the sum is the radiance", total / truth, 1.0, 1e-5, message)


def facets_scatter() -> Verdict:
    """A rough surface scatters away from the mirror direction, and a BRDF tells it."""
    value = float(bsdf("ggx", alpha=0.5)((-0.28, 0.0, 0.96), _TILT))
    return found(
        "no surface scattering", value, 0.0, 1e-12, f"off the mirror direction, GGX has f = {value:.3f} 1/sr"
    )


def kinds_of_scattering() -> tuple[Verdict, ...]:
    """Where a model of each kind sends the light that arrives from 37° to the left."""
    wi = np.array([-0.6, 0.0, 0.8])
    mirror = bsdf("mirror").delta_lobes(np.array([_TILT]))[0].wi[0]
    retro, gloss, matte = bsdf("retro", exponent=50.0), bsdf("ggx", alpha=0.1), bsdf("lambert")
    mixed = 0.5 * matte + 0.5 * gloss
    glass = bsdf("dielectric").delta_lobes(np.array([_TILT]))
    opal, frosted = bsdf("lambert_transmitter"), bsdf("rough_dielectric", alpha=0.1)
    aside = (0.9, 0.0, -math.sqrt(0.19))
    straight = min((lobe.wi[0] for lobe in glass), key=lambda w: w[2])
    return tuple(
        found(name, holds, True, 0, name)
        for name, holds in (
            ("a mirror reflects into one direction", bool(np.allclose(mirror, wi))),
            ("a diffuse surface into all alike", float(matte(wi, _TILT)) == float(matte((0, 0, 1), _TILT))),
            ("a mixture is the sum", math.isclose(
                float(mixed(wi, _TILT)), 0.5 * float(matte(wi, _TILT)) + 0.5 * float(gloss(wi, _TILT)))),
            ("a retroreflector back to the lamp", float(retro(_TILT, _TILT)) > 100 * float(retro(wi, _TILT))),
            ("a glossy surface mostly about it", float(gloss(wi, _TILT)) > 100 * float(gloss(_TILT, _TILT))),
            ("glass passes it in one direction", bool(straight[2] < 0)),
            ("an opal glass in all", float(opal((0, 0, -1), _TILT)) > 0),
            ("frosted glass in a lobe", float(frosted(straight, _TILT)) > 100 * float(frosted(aside, _TILT))),
        )
    )  # fmt: skip
