"""Skies: surfaces of any tilt under skies that are not uniform, and between sky and ground."""

from __future__ import annotations

import math

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.vectors import Triple
from radiokit.emitters.constant import Constant
from radiokit.emitters.sky_gradient import SkyGradient
from radiokit.emitters.sky_overcast import SkyOvercast
from radiokit.facts.source import Source
from radiokit.measure.cancelling import sine_minus_x_cosine
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES", "towards"]

_GROUND = Source(
    authors="Liu, Jordan",
    year=1963,
    title="The long-term average performance of flat-plate solar-energy collectors",
    doi="10.1016/0038-092X(63)90006-9",
    equation="what a tilted plane gets of the sky, (1 + cosβ)/2, and of the ground, (1 − cosβ)/2",
)

_LUNE = (
    r"The sky and the surface's hemisphere share a lune of angle $\gamma = \pi - \beta$. In longitude and "
    r"latitude about its axis the moments $M_k = \int \cos^k\theta_z \cos\theta\, d\omega$ are "
    r"$M_0 = \pi\cos^2(\beta/2)$, $M_1 = \frac{2}{3}(\sin\gamma - \gamma\cos\gamma)$ and "
    r"$M_2 = \frac{\pi}{2}\cos^4(\beta/2)$; $L_o = \rho E/\pi$ with "
)
_OVERCAST = "the CIE's standard overcast sky, L = (1 + 2 cosθ)/3 at θ from the zenith"


def towards(tilt_deg: float) -> Triple:
    """Return the direction ``tilt_deg`` off z, with a cosine that keeps its digits near the horizon."""
    tilt, rest = math.radians(tilt_deg), math.radians(90 - tilt_deg)
    return (math.sin(tilt), 0.0, math.sin(rest))


def _moments(tilt_deg: float) -> tuple[float, float, float]:
    """Return M₀/π, M₁/π and M₂/π."""
    opening = math.radians(180 - tilt_deg)
    square = math.sin(opening / 2) ** 2
    return square, 2 / 3 * float(sine_minus_x_cosine(opening)) / math.pi, square * square / 2


def _slope(name: str, title: str, words: str, sky: Emitter, law: str, exact: float, tilt_deg: float) -> Case:
    normal = towards(tilt_deg)
    return shading_case(
        name=f"lambert-under-{name}-tilted-{tilt_deg:g}deg",
        title=f"Lambert under {title}, tilted by {tilt_deg:g}°",
        setup=(
            f"A diffuse surface of reflectance 0.5 whose normal is tilted by {tilt_deg:g}° from the zenith, "
            f"under {words}, and nothing from below the horizon, seen along its normal."
        ),
        exact=exact,
        derivation=_LUNE + law,
        source=SkyOvercast.SOURCE if isinstance(sky, SkyOvercast) else SkyGradient.SOURCE,
        scene=Scene(f=Lambert(reflectance=0.5), emitters=(sky,), wo=normal, normal=normal),
        tags=("sky", "lambert"),
    )


def _overcast(tilt_deg: float) -> Case:
    even, linear, _ = _moments(tilt_deg)
    law = r"$E = (M_0 + 2M_1)/3$, which is $7\pi/9$ on the horizontal."
    exact = 0.5 * (even + 2 * linear) / 3
    return _slope("overcast-sky", "the overcast sky", _OVERCAST, SkyOvercast(), law, exact, tilt_deg)


def _gradient(tilt_deg: float) -> Case:
    even, linear, _ = _moments(tilt_deg)
    sky = SkyGradient(radiance=1.0, horizon=3.0)
    words = "a sky of radiance 3 at the horizon and 1 at the zenith, linear in cosθ"
    law = r"$E = 3M_0 - 2M_1$."
    return _slope("linear-sky", "a linear sky", words, sky, law, 0.5 * (3 * even - 2 * linear), tilt_deg)


def _quadratic(tilt_deg: float) -> Case:
    even, linear, square = _moments(tilt_deg)
    sky = SkyGradient(radiance=2.0, horizon=1.0, curvature=0.5)
    words = "a sky of radiance 1 + ½ cosθ + ½ cos²θ"
    law = r"$E = M_0 + \frac{1}{2}M_1 + \frac{1}{2}M_2$."
    exact = 0.5 * (even + linear / 2 + square / 2)
    return _slope("quadratic-sky", "a quadratic sky", words, sky, law, exact, tilt_deg)


def _plain(tilt_deg: float) -> Case:
    half = math.radians(tilt_deg) / 2
    normal = towards(tilt_deg)
    return shading_case(
        name=f"lambert-between-sky-and-ground-tilted-{tilt_deg:g}deg",
        title=f"Lambert between sky and ground, tilted by {tilt_deg:g}°",
        setup=(
            f"A diffuse surface of reflectance 0.5 whose normal is tilted by {tilt_deg:g}° from the zenith, "
            "above an infinite horizontal plane of radiance 0.2 and under a sky of radiance 1, seen along "
            "its normal."
        ),
        exact=0.5 * (math.cos(half) ** 2 + 0.2 * math.sin(half) ** 2),
        derivation=(
            r"The sky gives $\pi L \cos^2(\beta/2)$, and the plane, the sky of the surface turned over, "
            r"$\pi L_g \sin^2(\beta/2)$; $L_o = \rho E/\pi$."
        ),
        source=_GROUND,
        scene=Scene(
            f=Lambert(reflectance=0.5),
            emitters=(
                Constant(radiance=1.0, normal=(0.0, 0.0, 1.0)),
                Constant(radiance=0.2, normal=(0.0, 0.0, -1.0)),
            ),
            wo=normal,
            normal=normal,
        ),
        tags=("sky", "ground", "lambert"),
    )


# --- surfaces that face the zenith ---


def _ggx_moment(power: int, mu: float) -> float:
    """Return ∫ μᵏ⁺¹/(μ + μo) dμ over [0, 1] for k = ``power``, by its recurrence in k.

    >>> round(_ggx_moment(0, 1.0), 15)
    0.306852819440055
    """
    value = 1 - mu * math.log1p(1 / mu)
    for k in range(1, power + 1):
        value = 1 / (k + 1) - mu * value
    return value


_GGX_ONE = (
    r"For $\alpha = 1$ the model is $f = 1/(2\pi(\mu_i+\mu_o))$, so $L_o = \int_0^1 L(\mu) "
    r"\frac{\mu}{\mu+\mu_o} d\mu$. With $J_k = \int_0^1 \frac{\mu^{k+1}}{\mu+\mu_o} d\mu$, "
    r"$J_0 = 1 - \mu_o\ln\frac{1+\mu_o}{\mu_o}$ and $J_k = \frac{1}{k+1} - \mu_o J_{k-1}$, it is "
)
_GGX = "GGX with α = 1, height-correlated Smith masking and Fresnel factor 1"
_PHONG = "Modified Phong, f = (n + 2)/2π · cosⁿα with n = 10"


def _facing_zenith(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    f: BSDF,
    light: Emitter,
    wo_deg: float,
) -> Case:
    return shading_case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=derivation,
        source=f.SOURCE,
        scene=Scene(f=f, emitters=(light,), wo=towards(wo_deg)),
        tags=("sky", f.name),
    )


def _ggx_overcast(theta_deg: float) -> Case:
    mu = towards(theta_deg)[2]
    return _facing_zenith(
        f"ggx-1-under-overcast-sky-at-{theta_deg:g}deg",
        f"GGX, α = 1, under the overcast sky at {theta_deg:g}°",
        f"{_GGX}, facing the zenith and seen {theta_deg:g}° off its normal, under {_OVERCAST}.",
        (_ggx_moment(0, mu) + 2 * _ggx_moment(1, mu)) / 3,
        _GGX_ONE + r"$(J_0 + 2J_1)/3$.",
        GGX(alpha=1.0),
        SkyOvercast(),
        theta_deg,
    )


CASES: tuple[Case, ...] = (
    *(_overcast(tilt) for tilt in (0.0, 30.0, 60.0, 90.0, 150.0)),
    *(_gradient(tilt) for tilt in (0.0, 45.0, 90.0)),
    *(_quadratic(tilt) for tilt in (0.0, 60.0, 120.0)),
    *(_plain(tilt) for tilt in (0.0, 45.0, 90.0, 135.0)),
    _facing_zenith(
        "mirror-under-overcast-sky",
        "A mirror under the overcast sky",
        f"A mirror of reflectance 0.9, facing the zenith and seen 60° off its normal, under {_OVERCAST}.",
        0.6,
        r"$L_o = \rho L(60°) = 0.9 \cdot \frac{1 + 2\cdot\frac{1}{2}}{3}$.",
        Mirror(reflectance=0.9),
        SkyOvercast(),
        60.0,
    ),
    _facing_zenith(
        "phong-10-under-overcast-sky",
        "Modified Phong, n = 10, under the overcast sky",
        f"{_PHONG}, facing the zenith and seen along its normal, under {_OVERCAST}.",
        1 / 3 + 2 * 12 / (3 * 13),
        r"$L_o = (n+2)\int_0^1 \mu^{n+1} \frac{1 + 2\mu}{3} d\mu = \frac{1}{3} + \frac{2(n+2)}{3(n+3)}$.",
        Phong(exponent=10, reflectance=1.0),
        SkyOvercast(),
        0.0,
    ),
    *(_ggx_overcast(theta) for theta in (0.0, 60.0)),
    _facing_zenith(
        "ggx-1-under-quadratic-sky",
        "GGX, α = 1, under a quadratic sky",
        f"{_GGX}, facing the zenith and seen 60° off its normal, under a sky of radiance cos²θ.",
        _ggx_moment(2, towards(60.0)[2]),
        _GGX_ONE + r"$J_2$.",
        GGX(alpha=1.0),
        SkyGradient(radiance=1.0, horizon=0.0, curvature=1.0),
        60.0,
    ),
)
