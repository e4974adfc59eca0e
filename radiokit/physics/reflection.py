"""Reflection: value, density and sampler of a rough mirror, put together from the law of its facets' slopes.

f = F D G₂ / (4 cosθi cosθo). A ``Law`` has D, the areas that directions see, and samplers; the masking is
Smith's, correlated by height or separable, or the V-groove's; F is that of a metal, Schlick's, or 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from radiokit.measure.kernels import Kernel, bind, kernel, select
from radiokit.physics.facet import reflect
from radiokit.physics.interface import conductor_facet_kernel
from radiokit.physics.masking import (
    HORIZON,
    correlated_over_cosines,
    correlated_ratio,
    groove_masking,
    groove_over_cosines,
    groove_ratio,
    masking,
    separable_over_cosines,
    separable_ratio,
)
from radiokit.physics.microfacet import (
    beckmann_d_symbolic,
    beckmann_lambda_symbolic,
    ggx_d_symbolic,
    ggx_lambda_symbolic,
)
from radiokit.physics.ndf import (
    beckmann_area,
    beckmann_density,
    beckmann_normal,
    ggx_area,
    ggx_density,
    ggx_normal,
)
from radiokit.physics.visible import (
    beckmann_visible,
    ggx_visible,
    groove_reflected_density,
    groove_visible,
    reflected_density,
)

__all__ = [
    "BECKMANN",
    "GGX",
    "MASKINGS",
    "Law",
    "Reflection",
    "metal_share",
    "reflecting",
    "schlick_share",
    "shares",
    "tinted",
]

MASKINGS = ("height-correlated", "separable", "v-groove")
"""How facets hide one another: Smith's G₂ = 1/(1 + Λi + Λo) or G₁(i) G₁(o), and the V-groove's."""


@dataclass(frozen=True)
class Law:
    """How the slopes of facets are distributed, as kernels and as the papers write it.

    Parameters
    ----------
    density : Kernel
        D [sr⁻¹] of ``hx, hy, hz, alpha_x, alpha_y``, a half vector of any length, hz at least 0.
    area : Kernel
        σ [1] of ``wx, wy, wz, alpha_x, alpha_y``: the area of the facets that face w, seen along w.
    visible : Kernel
        A normal that o sees, of any length, from ``u0, u1, ox, oy, oz, alpha_x, alpha_y``.
    normal : Kernel
        A normal of density D cosθ, of any length, from ``u0, u1, alpha_x, alpha_y``.
    d_symbolic, lambda_symbolic : callable
        D and Smith's Λ as SymPy, of a direction and two widths.
    """

    density: Kernel
    area: Kernel
    visible: Kernel
    normal: Kernel
    d_symbolic: Callable[..., Any]
    lambda_symbolic: Callable[..., Any]


BECKMANN = Law(
    beckmann_density,
    beckmann_area,
    beckmann_visible,
    beckmann_normal,
    beckmann_d_symbolic,
    beckmann_lambda_symbolic,
)
GGX = Law(ggx_density, ggx_area, ggx_visible, ggx_normal, ggx_d_symbolic, ggx_lambda_symbolic)


@dataclass(frozen=True)
class Reflection:
    """A rough mirror's kernels, as ``contracts.scalar.Kernels`` describes them."""

    value: Kernel
    density: Kernel
    sample: Kernel


# These names stand for kernels below; ``bind`` puts those of a law, a masking or a reflectance there.
_normals: Any = None
_area: Any = None
_draw: Any = None
_over_cosines: Any = None
_ratio: Any = None
_value: Any = None
_density: Any = None
_sample: Any = None
_reflectance: Any = None


def _smith_value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D G₂ / (4 cosθi cosθo)."""
    above = (iz > HORIZON) & (oz > HORIZON)
    density = _normals(ix + ox, iy + oy, select(above, iz + oz, 1.0), alpha_x, alpha_y)
    area_i, area_o = _area(ix, iy, iz, alpha_x, alpha_y), _area(ox, oy, oz, alpha_x, alpha_y)
    return density * _over_cosines(iz, oz, area_i, area_o)


def _smith_density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D / (4 σ(o))."""
    above = (iz > HORIZON) & (oz > HORIZON)
    density = _normals(ix + ox, iy + oy, select(above, iz + oz, 1.0), alpha_x, alpha_y)
    return select(above, reflected_density(density, _area(ox, oy, oz, alpha_x, alpha_y)), 0.0)


def _smith_sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return wi about a visible normal, and G₂ / G₁(o)."""
    hx, hy, hz = _draw(u0, u1, ox, oy, oz, alpha_x, alpha_y)
    wx, wy, wz = reflect(ox, oy, oz, hx, hy, hz)
    area_i, area_o = _area(wx, wy, wz, alpha_x, alpha_y), _area(ox, oy, oz, alpha_x, alpha_y)
    return wx, wy, wz, _ratio(wz, oz, area_i, area_o)


@kernel
def _half(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any) -> Any:
    """Return h = i + o, whether both are above the horizon (hz is 2 otherwise), and i·h = o·h = |h|²/2."""
    above = (iz > HORIZON) & (oz > HORIZON)
    hx, hy, hz = ix + ox, iy + oy, select(above, iz + oz, 2.0)
    return hx, hy, hz, above, 0.5 * (hx * hx + hy * hy + hz * hz)


def _groove_value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D G / (4 cosθi cosθo) of the V-groove."""
    hx, hy, hz, _, along = _half(ix, iy, iz, ox, oy, oz)
    return _normals(hx, hy, hz, alpha_x, alpha_y) * groove_over_cosines(iz, oz, hz, along, along)


def _groove_density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return the density of directions that the V-groove's visible normals reflect."""
    hx, hy, hz, above, along = _half(ix, iy, iz, ox, oy, oz)
    density = _normals(hx, hy, hz, alpha_x, alpha_y)
    return select(above, groove_reflected_density(density, oz, hz, along), 0.0)


def _groove_sample(u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return wi about the visible one of a groove's two facets, and G / G₁(o)."""
    nx, ny, nz = _draw(u0, u1, alpha_x, alpha_y)
    hx, hy, hz = groove_visible(u2, ox, oy, abs(oz), nx, ny, nz)
    wx, wy, wz = reflect(ox, oy, oz, hx, hy, hz)
    along = ox * hx + oy * hy + oz * hz
    return wx, wy, wz, groove_ratio(wz, oz, hz, along, along)


@lru_cache(maxsize=64)
def reflecting(law: Law, hiding: str) -> Reflection:
    """Return the kernels for facets that reflect everything, with the constants ``alpha_x, alpha_y``.

    The V-groove's sampler takes three uniform numbers. ``hiding`` is one of ``MASKINGS``.
    """
    if hiding == "v-groove":
        value, density = (bind(form, _normals=law.density) for form in (_groove_value, _groove_density))
        return Reflection(value, density, bind(_groove_sample, _draw=law.normal))
    over, ratio = correlated_over_cosines, correlated_ratio
    if hiding == "separable":
        over, ratio = separable_over_cosines, separable_ratio
    return Reflection(
        bind(_smith_value, _normals=law.density, _area=law.area, _over_cosines=over),
        bind(_smith_density, _normals=law.density, _area=law.area),
        bind(_smith_sample, _draw=law.visible, _area=law.area, _ratio=ratio),
    )


@kernel
def _facet_cosine(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any) -> Any:
    """Return the cosine of the angle between a direction and h, |wi + wo| / 2."""
    x, y, z = ix + ox, iy + oy, iz + oz
    cosine = 0.5 * np.sqrt(x * x + y * y + z * z)
    return select(cosine < 1.0, cosine, 1.0)


@kernel
def metal_share(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any, k: Any) -> Any:
    """Return F [1] of the metal facet that reflects i to o.

    >>> round(float(metal_share(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.2, 3.0)), 12)
    0.92337164751
    """
    x, y, z = ix - ox, iy - oy, iz - oz
    sine = 0.5 * np.sqrt(x * x + y * y + z * z)
    return conductor_facet_kernel(
        _facet_cosine(ix, iy, iz, ox, oy, oz), select(sine < 1.0, sine, 1.0), eta, k
    )


@kernel
def schlick_share(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, f0: Any) -> Any:
    """Return Schlick's F [1] at the facet that reflects i to o: 1 − cosθ is sin²θ/(1 + cosθ), from i − o.

    >>> float(schlick_share(-1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.04))
    1.0
    """
    x, y, z = ix - ox, iy - oy, iz - oz
    d = 0.25 * (x * x + y * y + z * z) / (1.0 + _facet_cosine(ix, iy, iz, ox, oy, oz))
    d = select(d < 1.0, d, 1.0)
    return f0 + (1.0 - f0) * (d * d * (d * d) * d)


def _tinted_value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, *index: Any
) -> Any:
    share = _reflectance(ix, iy, iz, ox, oy, oz, *index)
    return share * _value(ix, iy, iz, ox, oy, oz, alpha_x, alpha_y)


def _tinted_density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, *index: Any
) -> Any:
    return _density(ix, iy, iz, ox, oy, oz, alpha_x, alpha_y)


def _tinted_sample(
    u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, *index: Any
) -> Any:
    wx, wy, wz, share = _sample(u0, u1, ox, oy, oz, alpha_x, alpha_y)
    return wx, wy, wz, _reflectance(wx, wy, wz, ox, oy, oz, *index) * share


def _tinted_groove_sample(
    u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, *index: Any
) -> Any:
    wx, wy, wz, share = _sample(u0, u1, u2, ox, oy, oz, alpha_x, alpha_y)
    return wx, wy, wz, _reflectance(wx, wy, wz, ox, oy, oz, *index) * share


@lru_cache(maxsize=64)
def tinted(law: Law, hiding: str, reflectance: Kernel) -> Reflection:
    """Return the kernels for facets that reflect F, with the constants ``alpha_x, alpha_y, *index``.

    ``reflectance(ix, iy, iz, ox, oy, oz, *index)`` is F [1], as ``metal_share`` is.
    """
    white = reflecting(law, hiding)
    sample = _tinted_groove_sample if hiding == "v-groove" else _tinted_sample
    return Reflection(
        bind(_tinted_value, _value=white.value, _reflectance=reflectance),
        bind(_tinted_density, _density=white.density),
        bind(sample, _sample=white.sample, _reflectance=reflectance),
    )


def shares(
    law: Law, hiding: str, wi: Any, wo: Any, h: Any, alpha_x: float, alpha_y: float
) -> tuple[Any, Any]:
    """Return G₁(wo, ĥ) and G₂(wi, wo, ĥ) [1] for directions given as three arrays each, w·h above 0.

    >>> [float(g) for g in shares(GGX, "separable", (0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0, 0, 1), 1.0, 1.0)]
    [0.888888888888889, 0.888888888888889]
    """
    if hiding == "v-groove":
        one, other = (groove_masking(w[2], h[2], w[0] * h[0] + w[1] * h[1] + w[2] * h[2]) for w in (wi, wo))
        return other, select(one < other, one, other)
    area_i, area_o = (law.area(*w, alpha_x, alpha_y) for w in (wi, wo))
    ratio = separable_ratio if hiding == "separable" else correlated_ratio
    seen = masking(wo[2], area_o)
    return seen, seen * ratio(wi[2], wo[2], area_i, area_o)
