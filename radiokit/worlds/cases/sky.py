"""Sky: a diffuse surface of any tilt under a uniform sky."""

from __future__ import annotations

import math

from radiokit.bsdfs.lambert import Lambert
from radiokit.emitters.constant import Constant
from radiokit.facts.source import Source
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES"]

SOURCE = Source(
    authors="Liu, Jordan",
    year=1963,
    title="The long-term average performance of flat-plate solar-energy collectors",
    doi="10.1016/0038-092X(63)90006-9",
    equation="the sky's share on a tilted plane, (1 + cosβ)/2",
)

_DERIVATION = (
    r"The sky and the surface's hemisphere share a lune of angle $\pi - \beta$. About its axis "
    r"$\cos\theta = \cos\lambda\cos\psi$ and $d\omega = \cos\lambda\, d\lambda\, d\psi$, so "
    r"$E = L \int_{-\pi/2}^{\pi/2} \cos^2\lambda\, d\lambda \int_{\beta-\pi/2}^{\pi/2} \cos\psi\, d\psi "
    r"= \frac{\pi L}{2} (1 + \cos\beta) = \pi L \cos^2(\beta/2)$, and $L_o = \rho E/\pi$."
)

_SAMPLED = ("mc-bsdf", "mc-light", "mis", "qmc")


def _tilted(tilt_deg: float) -> Case:
    # From the nearer pole, so that a surface that all but faces the ground keeps its digits.
    rest = math.radians(round(180 - tilt_deg, 9))  # 0.1°, and not 0.0999999999999943°
    normal = (math.sin(rest), 0.0, -math.cos(rest)) if tilt_deg > 90 else _towards(tilt_deg)
    half = math.sin(rest / 2) if tilt_deg > 90 else math.cos(math.radians(tilt_deg) / 2)
    sliver = 179 < tilt_deg < 180
    return shading_case(
        name=f"lambert-under-sky-tilted-{tilt_deg:g}deg",
        title=f"Lambert under a uniform sky, tilted by {tilt_deg:g}°",
        setup=(
            f"A diffuse surface of reflectance 0.5 whose normal is tilted by {tilt_deg:g}° from the zenith, "
            "under radiance 1 from every direction above the horizon and 0 from below, seen along its normal."
            + (" The visible sliver of sky is too thin for samples." if sliver else "")
        ),
        exact=0.5 * half * half,
        derivation=_DERIVATION,
        source=SOURCE,
        scene=Scene(
            f=Lambert(reflectance=0.5),
            emitters=(Constant(radiance=1.0, normal=(0.0, 0.0, 1.0)),),
            wo=normal,
            normal=normal,
        ),
        tags=("sky", "lambert"),
        left_out=_SAMPLED if sliver else (),
    )


def _towards(tilt_deg: float) -> tuple[float, float, float]:
    tilt = math.radians(tilt_deg)
    return (math.sin(tilt), 0.0, math.sin(math.radians(90 - tilt_deg)))


CASES: tuple[Case, ...] = (
    shading_case(
        name="lambert-under-irradiance-pi",
        title="Lambert under an irradiance of π",
        setup=(
            "The diffuse surface f = 1/π under radiance 1 from every direction, so that E = π, seen 30° off "
            "its normal."
        ),
        exact=1.0,
        derivation=r"$E = \int \cos\theta\, d\omega = \pi$ and $L_o = E/\pi = 1$: $f = 1/\pi$ is albedo 1.",
        source=Lambert.SOURCE,
        scene=Scene(
            f=Lambert(reflectance=1.0), emitters=(Constant(radiance=1.0),), wo=(0.5, 0.0, math.sqrt(0.75))
        ),
        tags=("sky", "lambert"),
    ),
    *(_tilted(tilt) for tilt in (0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 179.9, 180.0)),
)
