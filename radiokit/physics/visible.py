"""Visible normals: facets drawn as a direction sees them, and the densities with which that happens.

Kernels for a direction o above the horizon; α are the widths of ``ndf``, in [1e-4, 1], and σ its areas. The
normals have any length. The visible normals' density is D(ĥ) (o·ĥ)/σ(o), so that of a reflected direction is
D(ĥ)/(4 σ(o)): the weight of a sample is F G₂/G₁ of ``masking``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.facts.source import Source
from radiokit.measure.elementary import exp, log, sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.special import erfcx, erfinv

__all__ = [
    "CAPS_SOURCE",
    "SLOPES_SOURCE",
    "beckmann_slope",
    "beckmann_visible",
    "ggx_visible",
    "groove_reflected_density",
    "groove_visible",
    "groove_visible_density",
    "reflected_density",
    "visible_density",
]

CAPS_SOURCE = Source(
    authors="Dupuy, Benyoub",
    year=2023,
    title="Sampling Visible GGX Normals with Spherical Caps. Computer Graphics Forum 42(8)",
    doi="10.1111/cgf.14867",
    equation="the cap's radius and height are written without cancellation",
)
SLOPES_SOURCE = Source(
    authors="Heitz, d'Eon",
    year=2014,
    title="Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals. Computer "
    "Graphics Forum 33(4)",
    doi="10.1111/cgf.12417",
    equation="the slopes of Beckmann's visible normals, and the V-groove's choice of one facet of two",
)

_PER_ROOT_PI, _ROOT_PI, _EIGHT_PER_PI = 0.5641895835477563, 1.772453850905516, 2.5464790894703255
_LEAST, _LEAST_SINE = 2.0**-54, 1e-145
_FAR = 100.0  # a slope that no sample reaches
# Winitzki: erf²t ≈ 1 − exp(−t² (4/π + at²)/(1 + at²)) with a = 0.147, to 2 in a thousand. 1/a and 2/(πa):
_PER_WINITZKI, _CENTRE = 6.802721088435374, 4.330746750799873


@kernel
def ggx_visible(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return a visible normal (hx, hy, hz) of GGX: a uniform cap on the sphere that is stretched to it.

    >>> [round(float(c), 12) for c in ggx_visible(0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.5)]
    [0.0, 0.0, 2.0]
    """
    x, y = alpha_x * ox, alpha_y * oy
    scale = 1.0 / np.sqrt(x * x + y * y + oz * oz)
    x, y, z = x * scale, y * scale, abs(oz) * scale
    up, down = (1.0 - u0) * (1.0 + z), u0 * (1.0 + z)  # above −z, and below 1
    radius = np.sqrt(down * (up + (x * x + y * y) / (1.0 + z)))
    sine, cosine = sincos(u1)
    return alpha_x * (radius * cosine + x), alpha_y * (radius * sine + y), up


@kernel
def _halley(t: Any, u: Any, v: Any, sine: Any, cosine: Any, hidden: Any) -> Any:
    """Return a slope nearer to the one below which a share ``u`` = 1 − ``v`` lies: a step of third order."""
    bell, ratio = exp(-t * t), erfcx(abs(t))
    k = _PER_ROOT_PI * sine
    above = 0.5 * bell * (k + cosine * ratio) - v * (cosine + hidden)
    below = u * (cosine + hidden) - hidden + 0.5 * bell * (k - cosine * ratio)
    excess = _ROOT_PI * select(t >= 0.0, above, below)
    seen = cosine + t * sine
    # Newton's step over 1 + half the step times the density's logarithmic derivative: one division.
    least = 0.25 * seen * seen * bell
    bent = 4.0 * least + 0.5 * excess * (sine - 2.0 * t * seen)
    step = excess * seen / select(bent > least, bent, least)
    floor = seen * (-0.75 / select(sine > _LEAST_SINE, sine, _LEAST_SINE))  # stays above the slopes' end
    return t + select(step > floor, step, floor)


@kernel
def _start(u: Any, v: Any, sine: Any, cosine: Any, end: Any, hidden: Any) -> Any:
    """Return a slope near the one below which a share ``u`` lies: off by 0.4 at most, less in the tails.

    With b = erf t and exp(−t²) ≈ 1 − b² the share is quadratic in b; a first bound on b holds near the end.
    Nearer still, the density is that of its first term, (t + end) exp(−end²).
    """
    bell, k, area = exp(-end * end), _PER_ROOT_PI * sine, cosine + hidden
    reach, slope = 2.0 - bell * erfcx(end), cosine + 2.0 * k  # reach = 1 + erf(end)
    inner = slope * slope - 8.0 * k * v * area
    top = 4.0 * v * area / (slope + np.sqrt(select(inner > 0.0, inner, 0.0)))  # 1 − b
    least = np.sqrt(u * v * (_EIGHT_PER_PI * area * bell / select(k > _LEAST_SINE, k, _LEAST_SINE)))
    top = select(reach - top < least, reach - least, top)
    top = select(top > _LEAST, select(top < 2.0 - 4.0 * _LEAST, top, 2.0 - 4.0 * _LEAST), _LEAST)
    low = log(top * (2.0 - top))
    centre = _CENTRE + 0.5 * low
    square = np.sqrt(centre * centre - _PER_WINITZKI * low) - centre
    t = np.sqrt(select(square > 0.0, square, 0.0))
    t = select(top > 1.0, -t, t)
    last = -end * (1.0 - 1e-6)
    t = select(t > last, t, last)
    weak = sine * bell
    near = np.sqrt(u * (2.0 * _ROOT_PI * area / select(weak > _LEAST_SINE, weak, _LEAST_SINE)))
    return select((1.0 + end) * near < 0.4, near - end, t)


@kernel
def beckmann_slope(u: Any, sine: Any, cosine: Any) -> Any:
    """Return the slope t, towards the viewer, below which a share ``u`` of Beckmann's visible slopes lies.

    Their density is max(cosθ + t sinθ, 0) exp(−t²) for a width of 1 and the viewer's ``sine`` and
    ``cosine``, at least 0 and of squares that sum to 1. Four steps invert its distribution function to
    rounding; above its median to all digits of 1 − ``u``.

    >>> round(float(beckmann_slope(0.75, 0.0, 1.0)), 12)
    0.476936276204
    >>> round(float(beckmann_slope(1.0 - np.exp(-1.0), 1.0, 0.0)), 12)
    1.0
    """
    u, v = select(u > _LEAST, u, _LEAST), select(1.0 - u > _LEAST, 1.0 - u, _LEAST)
    upright = sine * _FAR < cosine
    end = select(upright, _FAR, cosine / select(upright, 1.0, sine))  # the visible slopes begin at −end
    hidden = 0.5 * exp(-end * end) * (_PER_ROOT_PI * sine - cosine * erfcx(end))
    t = _start(u, v, sine, cosine, end, hidden)
    t = _halley(t, u, v, sine, cosine, hidden)
    t = _halley(t, u, v, sine, cosine, hidden)
    t = _halley(t, u, v, sine, cosine, hidden)
    return _halley(t, u, v, sine, cosine, hidden)


@kernel
def beckmann_visible(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return a visible normal (hx, hy, hz) of Beckmann: a slope towards the viewer, and one across.

    >>> [round(abs(float(c)), 12) for c in beckmann_visible(0.5, 0.5, 0.0, 0.0, 1.0, 0.5, 0.5)]
    [0.0, 0.0, 1.0]
    """
    x, y, z = alpha_x * ox, alpha_y * oy, abs(oz)
    across = np.sqrt(x * x + y * y)
    scale = 1.0 / np.sqrt(across * across + z * z)
    turned = across > _LEAST_SINE
    per_across = 1.0 / select(turned, across, 1.0)
    x, y = select(turned, x * per_across, 1.0), y * per_across
    t, r = beckmann_slope(u0, across * scale, z * scale), erfinv(2.0 * u1 - 1.0)
    return alpha_x * (t * x - r * y), alpha_y * (t * y + r * x), 1.0 + 0.0 * t


@kernel
def groove_visible(u2: Any, ox: Any, oy: Any, oz: Any, hx: Any, hy: Any, hz: Any) -> Any:
    """Return the visible one (hx, hy, hz) of a V-groove's two facets, for a normal of density D cosθ.

    >>> [float(c) for c in groove_visible(0.9, 0.6, 0.0, 0.8, 0.0, 0.0, 1.0)]
    [-0.0, -0.0, 1.0]
    """
    across, up = ox * hx + oy * hy, oz * hz
    one, other = up + across, up - across
    one, other = select(one > 0.0, one, 0.0), select(other > 0.0, other, 0.0)
    side = select(u2 * (one + other) < one, 1.0, -1.0)
    return side * hx, side * hy, hz


@kernel
def visible_density(density: Any, cos_d: Any, area_o: Any) -> Any:
    """Return the density [sr⁻¹] of visible normals, from D(ĥ), ``cos_d`` = o·ĥ and σ(o); 0 for one unseen.

    >>> float(visible_density(1.0, 0.5, 0.5))
    1.0
    """
    return select(cos_d > 0.0, density * cos_d / area_o, 0.0)


@kernel
def reflected_density(density: Any, area_o: Any) -> Any:
    """Return the density [sr⁻¹] of directions that visible normals reflect, from D(ĥ) and σ(o).

    >>> float(reflected_density(1.0, 0.5))
    0.5
    """
    return 0.25 * density / area_o


@kernel
def groove_visible_density(density: Any, cos_o: Any, up: Any, cos_d: Any) -> Any:
    """Return the density [sr⁻¹] of a V-groove's visible normals, from D(ĥ), cosθo, ĥ·n and o·ĥ.

    >>> float(groove_visible_density(1.0, 1.0, 1.0, 1.0))
    1.0
    """
    both = 2.0 * up * cos_o < cos_d
    near = select(both, 2.0 * up, cos_d / select(both, 1.0, select(cos_o > 0.0, cos_o, 1.0)))
    return select(cos_d > 0.0, density * near, 0.0)


@kernel
def groove_reflected_density(density: Any, cos_o: Any, up: Any, along: Any) -> Any:
    """Return the density [sr⁻¹] of directions that a V-groove's visible normals reflect.

    From D(ĥ), cosθo, and h·n and o·h for one h of any length.

    >>> float(groove_reflected_density(1.0, 1.0, 1.0, 1.0))
    0.25
    """
    seen = 2.0 * up * cos_o
    larger = select(seen > along, seen, along)
    return select(along > 0.0, 0.5 * density * up / select(along > 0.0, larger, 1.0), 0.0)
