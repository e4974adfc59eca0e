"""Facets: integrals over the normals of a rough surface's facets, cut where they have kinks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from radiokit.contracts.microfacet import FloatArray, Microfacets
from radiokit.facts.directions import dot
from radiokit.facts.estimate import Estimate
from radiokit.measure.quadrature import box

__all__ = ["over_facets", "projected_area", "white_furnace"]

BUDGET = 1_500_000
"""Evaluations that one integral may cost."""


def projected_area(facets: Microfacets, wo: FloatArray, *, width: float) -> Estimate:
    """Return ∫ G₁(wo, h) (wo·h)⁺ D(h) dω / cosθo over the facets: 1, the area seen from ``wo`` (3,)."""
    return over_facets(lambda h: _seen(facets, wo, h), wo, width)


def white_furnace(facets: Microfacets, wo: FloatArray, *, width: float) -> tuple[Estimate, Estimate]:
    """Return ∫ G₁(wo, h) D(h) / (4 cosθo) dωi over the wi above and below the horizon, for wo (3,).

    Together they are 1: mirrors that cast no shadows lose no light, but send some of it down. With
    dωi = 4 (wo·h) dω each is an integral over the facets, cut where they mirror ``wo`` into the horizon.
    """
    above, below = (
        over_facets(lambda h: _seen(facets, wo, h), wo, width, below=side) for side in (False, True)
    )
    return above, below


def _seen(facets: Microfacets, wo: FloatArray, h: FloatArray) -> FloatArray:
    held = np.broadcast_to(wo, h.shape)
    return facets.density(h) * facets.masking(held, h) * np.maximum(dot(held, h), 0.0) / wo[2]


def over_facets(
    g: Callable[[FloatArray], FloatArray], wo: FloatArray, width: float, *, below: bool | None = None
) -> Estimate:
    """Integrate over the facets turned to ``wo``: all, or those that mirror it above or below the horizon.

    In slope coordinates, with cosφ = sinh(y) cotθo, facets are turned away beyond the slope −1/sinh(y) where
    y < 0, and mirror downwards beyond e^y. Where y > 0 the facet on the other side of the normal is turned
    away beyond 1/sinh(y), which a groove notices. The pieces are cut there and at y = 0, so that no kink is
    inside; the polar angle runs over each as a hyperbolic sine of the lobe's width.
    """
    cos_o, sin_o = float(wo[2]), float(np.hypot(wo[0], wo[1]))
    tangent = sin_o / cos_o
    flat = tangent < 1e-6
    top = 0.0 if flat else float(np.arcsinh(tangent))
    c, d = (1.0, 0.0) if sin_o == 0 else (wo[0] / sin_o, wo[1] / sin_o)

    def piece(points: FloatArray, ends: tuple[float, float], limits: tuple[int, int]) -> Any:
        angle = ends[0] + (ends[1] - ends[0]) * points[:, 1]
        y = top * np.cos(angle)
        if flat:
            cos_phi, sin_phi, turn = np.cos(angle), np.sin(angle), np.ones_like(angle)
        else:
            low, high = top * np.sin(angle / 2) ** 2, top * np.cos(angle / 2) ** 2
            root = 2 * np.sqrt(np.sinh(low) * np.cosh(high) * np.sinh(high) * np.cosh(low))
            cos_phi, sin_phi = np.sinh(y) / tangent, root / tangent
            turn = top * np.cosh(y) * np.sin(angle) / np.where(root > 0, root, 1.0)
        borders = [
            np.zeros_like(y),
            np.arctan(np.exp(y)),
            np.arctan2(1.0, np.sinh(np.abs(y))),
            np.full_like(y, np.pi / 2),
        ]
        a, b = (np.arcsinh(borders[limit] / width) for limit in limits)
        t = a + points[:, 0] * (b - a)
        theta = width * np.sinh(t)
        weight = np.sin(theta) * width * np.cosh(t) * (b - a) * turn * (ends[1] - ends[0])
        total: Any = 0.0
        for side in (1.0, -1.0):
            along, across = np.sin(theta) * cos_phi, side * np.sin(theta) * sin_phi
            h = np.stack([c * along - d * across, d * along + c * across, np.cos(theta)], axis=-1)
            total = total + weight * g(h)
        return total

    pieces = _pieces(top, below)

    def square(points: FloatArray) -> Any:
        return sum(piece(points, ends, limits) for ends, limits in pieces)

    cost = 2 * len(pieces)
    found = box(square, (0.0, 0.0), (1.0, 1.0), rtol=1e-8, atol=1e-10, max_evaluations=BUDGET // cost)
    return replace(found, evaluations=cost * found.evaluations)


START, HORIZON, HIDDEN, END = range(4)


def _pieces(top: float, below: bool | None) -> list[tuple[tuple[float, float], tuple[int, int]]]:
    """Return the pieces as intervals of the angle behind y, each between two limits of the polar angle."""
    quarter = np.pi / 2
    level = np.log(3) / 2  # above this y the other facet is hidden before the horizon is reached
    cut = float(np.arccos(level / top)) if top > level else 0.0
    away, near, far = (quarter, np.pi), (cut, quarter), (0.0, cut)
    if below is None:
        found = [((0.0, quarter), (START, HIDDEN)), ((0.0, quarter), (HIDDEN, END)), (away, (START, HIDDEN))]
    elif below:
        found = [(near, (HORIZON, HIDDEN)), (near, (HIDDEN, END)), (far, (HORIZON, END))]
        found.append((away, (HORIZON, HIDDEN)))
    else:
        found = [(near, (START, HORIZON)), (far, (START, HIDDEN)), (far, (HIDDEN, HORIZON))]
        found.append((away, (START, HORIZON)))
    return [(ends, limits) for ends, limits in found if ends[1] > ends[0]]
