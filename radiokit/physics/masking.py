"""Masking and shadowing: the share of facets that both directions see, the cosines cancelled.

Kernels of the cosines |cosθ| and of the areas σ of ``ndf``, whatever the law of the slopes. Each is 0 where a
cosine is 0. For refraction, too, the cosines are given without a sign.
"""

from __future__ import annotations

from typing import Any

from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select

__all__ = [
    "CORRELATED_SOURCE",
    "GROOVE_SOURCE",
    "HORIZON",
    "correlated_over_cosines",
    "correlated_ratio",
    "groove_masking",
    "groove_over_cosines",
    "groove_ratio",
    "masking",
    "separable_over_cosines",
    "separable_ratio",
]

CORRELATED_SOURCE = Source(
    authors="Heitz",
    year=2014,
    title="Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs. Journal of Computer "
    "Graphics Techniques 3(2)",
    equation="43 (G₁), 98 (separable) and 99 (correlated by height)",
)
GROOVE_SOURCE = Source(
    authors="Cook, Torrance",
    year=1982,
    title="A Reflectance Model for Computer Graphics. ACM Transactions on Graphics 1(1)",
    doi="10.1145/357290.357293",
    equation="the geometrical attenuation factor G, of Torrance & Sparrow (1967)",
)

HORIZON = 1e-150
"""A cosine up to this is 0: no unit vector tells them apart, and products would underflow."""


@kernel
def masking(cosine: Any, area: Any) -> Any:
    """Return Smith's G₁ = |cosθ|/σ [1].

    >>> float(masking(1.0, 1.0))
    1.0
    """
    return cosine / area


@kernel
def _correlated_sum(cos_i: Any, cos_o: Any, area_i: Any, area_o: Any) -> Any:
    """Return cosθi cosθo (1 + Λi + Λo): at least a third of the sum of its terms' magnitudes."""
    above = (cos_i > HORIZON) & (cos_o > HORIZON)
    return select(above, cos_i * area_o + cos_o * area_i - cos_i * cos_o, 1.0), above


@kernel
def correlated_over_cosines(cos_i: Any, cos_o: Any, area_i: Any, area_o: Any) -> Any:
    """Return G₂/(4 cosθi cosθo) [1] for shadowing and masking correlated by height, G₂ = 1/(1 + Λi + Λo).

    >>> float(correlated_over_cosines(1.0, 1.0, 1.0, 1.0))
    0.25
    """
    total, above = _correlated_sum(cos_i, cos_o, area_i, area_o)
    return select(above, 0.25 / total, 0.0)


@kernel
def correlated_ratio(cos_i: Any, cos_o: Any, area_i: Any, area_o: Any) -> Any:
    """Return G₂/G₁(o) [1] for shadowing and masking correlated by height: the weight of a visible normal.

    >>> float(correlated_ratio(1.0, 1.0, 1.0, 1.0))
    1.0
    """
    total, above = _correlated_sum(cos_i, cos_o, area_i, area_o)
    return select(above, cos_i * area_o / total, 0.0)


@kernel
def separable_over_cosines(cos_i: Any, cos_o: Any, area_i: Any, area_o: Any) -> Any:
    """Return G₂/(4 cosθi cosθo) [1] for independent shadowing and masking, G₂ = G₁(i) G₁(o).

    >>> float(separable_over_cosines(1.0, 1.0, 1.0, 1.0))
    0.25
    """
    above = (cos_i > HORIZON) & (cos_o > HORIZON)
    return select(above, 0.25 / (area_i * area_o), 0.0)


@kernel
def separable_ratio(cos_i: Any, cos_o: Any, area_i: Any, area_o: Any) -> Any:
    """Return G₂/G₁(o) = G₁(i) [1] for independent shadowing and masking.

    >>> float(separable_ratio(0.5, 1.0, 0.625, 1.0))
    0.8
    """
    above = (cos_i > HORIZON) & (cos_o > HORIZON)
    return select(above, cos_i / area_i, 0.0)


@kernel
def groove_masking(cosine: Any, up: Any, along: Any) -> Any:
    """Return the V-groove's G₁ = min(1, 2 (h·n) cosθ/(w·h)) [1]; ``up`` = h·n and ``along`` = w·h of one h.

    >>> float(groove_masking(0.1, 1.0, 0.5))
    0.4
    """
    seen = 2.0 * up * cosine
    return select(seen < along, seen / select(along > 0.0, along, 1.0), 1.0)


@kernel
def groove_over_cosines(cos_i: Any, cos_o: Any, up: Any, along_i: Any, along_o: Any) -> Any:
    """Return G₂/(4 cosθi cosθo) [1] of the V-groove, G₂ = min(G₁(i), G₁(o)), for reflection.

    ``up`` = h·n, ``along_i`` = |i·h| and ``along_o`` = |o·h| are those of one h, of any length.

    >>> float(groove_over_cosines(1.0, 1.0, 1.0, 1.0, 1.0))
    0.25
    """
    above = (cos_i > HORIZON) & (cos_o > HORIZON)
    a, b, c = 2.0 * up * cos_i * cos_o, cos_o * along_i, cos_i * along_o
    larger = select(b > c, b, c)
    larger = select(a > larger, a, larger)
    return select(above, 0.5 * up / select(above & (larger > 0.0), larger, 1.0), 0.0)


@kernel
def groove_ratio(cos_i: Any, cos_o: Any, up: Any, along_i: Any, along_o: Any) -> Any:
    """Return G₂/G₁(o) [1] of the V-groove: the weight of a visible normal; arguments as above.

    >>> float(groove_ratio(0.1, 1.0, 1.0, 0.5, 0.5))
    0.4
    """
    above = (cos_i > HORIZON) & (cos_o > HORIZON)
    first, second = groove_masking(cos_i, up, along_i), groove_masking(cos_o, up, along_o)
    ratio = first / select(above & (second > 0.0), second, 1.0)
    return select(above, select(ratio < 1.0, ratio, 1.0), 0.0)
