"""Normals of microfacets: how many point where (D), and what area of them a direction sees (σ).

Laws of the slopes with widths along x and y, α in [1e-4, 1], as kernels. A half vector h has any length, so
that no digit is lost in normalising it. Instead of Smith's Λ, which is infinite at the horizon, stand two
areas per area of surface, each seen along w: that of the facets which face w,
σ(w) = ∫ max(w·m, 0) D(m) dm = |cosθ| (1 + Λ), and that of those which face away, σ(−w) = |cosθ| Λ. They
differ by |cosθ|; G₁ is |cosθ|/σ(w).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.facts.source import Source
from radiokit.measure.elementary import exp, log, sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.special import erfcx

__all__ = [
    "AREA_SOURCE",
    "BECKMANN_SOURCE",
    "GGX_SOURCE",
    "beckmann_area",
    "beckmann_density",
    "beckmann_hidden",
    "beckmann_normal",
    "ggx_area",
    "ggx_area_isotropic",
    "ggx_density",
    "ggx_hidden",
    "ggx_normal",
]

GGX_SOURCE = Source(
    authors="Walter, Marschner, Li, Torrance",
    year=2007,
    title="Microfacet Models for Refraction through Rough Surfaces. Eurographics Symposium on Rendering",
    doi="10.2312/EGWR/EGSR07/195-206",
    equation="33 (D), 35 and 36 (samples); of two widths in Heitz (2014), JCGT 3(2), equation 85",
)
BECKMANN_SOURCE = Source(
    authors="Beckmann, Spizzichino",
    year=1963,
    title="The Scattering of Electromagnetic Waves from Rough Surfaces",
    equation="D as in Walter et al. (2007), equations 25, 28 and 29; of two widths in Heitz (2014), "
    "equation 80",
)
AREA_SOURCE = Source(
    authors="Heitz",
    year=2014,
    title="Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs. Journal of Computer "
    "Graphics Techniques 3(2)",
    equation="Λ of Beckmann and of GGX, sections 5.3 and 5.4; 86 for two widths; the areas are those of "
    "equations 14 and 37",
)

_PER_PI, _PER_ROOT_PI = 0.3183098861837907, 0.5641895835477563
_STEEPEST = 700.0  # exp of minus this is 0 to any sum it could join
_LEAST_SINE = 1e-30


@kernel
def ggx_density(hx: Any, hy: Any, hz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D [sr⁻¹] of GGX for a half vector of any length, hz at least 0.

    >>> round(float(ggx_density(0.0, 0.0, 2.0, 0.5, 0.25)) * 0.125 * np.pi, 12)
    1.0
    """
    x, y = hx / alpha_x, hy / alpha_y
    spread = x * x + y * y + hz * hz
    ratio = (hx * hx + hy * hy + hz * hz) / select(spread > 0.0, spread, 1.0)
    return ratio * ratio * (_PER_PI / (alpha_x * alpha_y))


@kernel
def beckmann_density(hx: Any, hy: Any, hz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D [sr⁻¹] of Beckmann for a half vector of any length, hz at least 0.

    >>> round(float(beckmann_density(0.0, 0.0, 2.0, 0.5, 0.25)) * 0.125 * np.pi, 12)
    1.0
    """
    x, y, up = hx / alpha_x, hy / alpha_y, hz * hz
    slope2 = x * x + y * y
    some = slope2 < _STEEPEST * up
    inverse = 1.0 / select(some, up, 1.0)
    ratio = select(some, (hx * hx + hy * hy + up) * inverse, 0.0)
    peak = _PER_PI / (alpha_x * alpha_y)
    return ratio * ratio * peak * exp(-select(some, slope2 * inverse, _STEEPEST))


@kernel
def ggx_area(wx: Any, wy: Any, wz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return σ(w) [1] of GGX: the area of the facets that face w, seen along w.

    >>> float(ggx_area(0.0, 0.0, 1.0, 0.5, 0.25))
    1.0
    """
    x, y = alpha_x * wx, alpha_y * wy
    return 0.5 * (abs(wz) + np.sqrt(x * x + y * y + wz * wz))


@kernel
def ggx_area_isotropic(wz: Any, alpha: Any) -> Any:
    """Return σ(w) [1] of GGX of one width, from the cosine of a unit vector alone.

    >>> float(ggx_area_isotropic(1.0, 0.5)), float(ggx_area_isotropic(0.0, 0.5))
    (1.0, 0.25)
    """
    square = alpha * alpha
    return 0.5 * (abs(wz) + np.sqrt(square + (1.0 - square) * (wz * wz)))


@kernel
def ggx_hidden(wx: Any, wy: Any, wz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return σ(−w) = |cosθ| Λ [1] of GGX: the area of the facets that face away from w, seen along w.

    >>> float(ggx_hidden(0.6, 0.0, 0.0, 0.5, 0.25)) == float(ggx_area(0.6, 0.0, 0.0, 0.5, 0.25))
    True
    """
    x, y = alpha_x * wx, alpha_y * wy
    across = x * x + y * y
    root = np.sqrt(across + wz * wz) + abs(wz)
    return 0.5 * across / select(root > 0.0, root, 1.0)


@kernel
def beckmann_hidden(wx: Any, wy: Any, wz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return σ(−w) = |cosθ| Λ [1] of Beckmann: the area of the facets that face away from w, seen along w.

    >>> round(float(beckmann_hidden(1.0, 0.0, 0.0, 0.5, 0.25) * np.sqrt(np.pi)), 12)
    0.25
    """
    x, y, z = alpha_x * wx, alpha_y * wy, abs(wz)
    sine = np.sqrt(x * x + y * y)
    a = z / select(sine > _LEAST_SINE, sine, _LEAST_SINE)
    # exp(−a²) outweighs what the difference of the two nearly equal terms loses.
    return 0.5 * exp(-a * a) * (_PER_ROOT_PI * sine - z * erfcx(a))


@kernel
def beckmann_area(wx: Any, wy: Any, wz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return σ(w) [1] of Beckmann: the area of the facets that face w, seen along w.

    >>> float(beckmann_area(0.0, 0.0, 1.0, 0.5, 0.25))
    1.0
    """
    return abs(wz) + beckmann_hidden(wx, wy, wz, alpha_x, alpha_y)


@kernel
def ggx_normal(u0: Any, u1: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return a normal (hx, hy, hz) of density D cosθ [sr⁻¹] of GGX, not of unit length.

    >>> [float(c) for c in ggx_normal(0.0, 0.5, 0.5, 0.25)]
    [-0.0, -0.0, 1.0]
    """
    sine, cosine = sincos(u1)
    radius = np.sqrt(u0)
    return alpha_x * radius * cosine, alpha_y * radius * sine, np.sqrt(1.0 - u0)


@kernel
def beckmann_normal(u0: Any, u1: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return a normal (hx, hy, hz) of density D cosθ [sr⁻¹] of Beckmann, not of unit length; u0 below 1.

    >>> round(float(beckmann_normal(0.5, 0.0, 0.5, 0.25)[0]) ** 2, 12)
    0.17328679514
    """
    sine, cosine = sincos(u1)
    radius = np.sqrt(-log(1.0 - u0))
    return alpha_x * radius * cosine, alpha_y * radius * sine, 1.0 + 0.0 * u0
