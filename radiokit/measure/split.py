"""Split: slope-space rules cut at curves where an integrand has kinks, such as the circle cosθi = cosθo."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.converge import Integrand
from radiokit.measure.curves import CURVES, Curve
from radiokit.measure.gauss import eased, gauss_legendre
from radiokit.measure.ridge import Ridge
from radiokit.measure.slope import mirrored, slope_map

__all__ = ["kinked", "split_rule"]

FloatArray = npt.NDArray[np.float64]

STEPS = (4e-5, 2e-5)
"""Distances from a curve, in the radial coordinate, at which second differences are taken."""

AZIMUTHS = 16
"""Places on each panel of a curve at which an integrand is looked at."""

FEW = 8
"""Places that are kept of them where few integrands bend: on all curves but the circle."""

KINK = (0.35, 0.65)
"""By what second differences shrink when the step is halved: by 1/2 at a kink, by 1/4 where f is smooth."""

NOISE = 1e-9
"""Second differences below this share of the integrand are no kink that matters, or rounding."""


def _radius(curve: Curve, wo: FloatArray, width: npt.ArrayLike, s: FloatArray) -> FloatArray:
    """Return ``slope_map``'s x of a curve at azimuths s: in [0, 1], and at an end where it does not run."""
    tan_o = float(np.hypot(wo[0], wo[1]) / wo[2])
    y = np.arcsinh(tan_o) * np.cos(np.pi * s)
    rho, edge, width = curve.slope(tan_o, y), np.exp(y), np.asarray(width, dtype=float)
    share = np.arcsinh(np.minimum(rho, edge) / width) / np.arcsinh(edge / width)
    share = np.clip(share, 0.0, 1.0)
    result: FloatArray = share / (1 + np.sqrt(1 - share))
    return result


def _turns(curves: tuple[Curve, ...], wo: FloatArray) -> tuple[float, ...]:
    """Return the azimuths s in (0, 1) at which curves start, stop or meet."""
    tan_o = float(np.hypot(wo[0], wo[1]) / wo[2])
    big_y = float(np.arcsinh(tan_o))
    ends = {y for curve in curves for y in curve.ends(tan_o) if abs(y) < big_y}
    return tuple(float(np.arccos(y / big_y)) / np.pi for y in ends)


def kinked(
    integrand: Integrand, wo: FloatArray, width: float, curves: tuple[Curve, ...] = CURVES
) -> tuple[tuple[Curve, ...], int]:
    """Return those of ``curves`` at which the integrand's slope jumps, and the evaluations.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> [curve.name for curve in kinked(lambda w: np.maximum(w[:, 2], wo[2]), wo, 0.3)[0]]
    ['cosθi = cosθo']
    >>> kinked(lambda w: w[:, 2], wo, 0.3)[0]
    ()
    """
    shift = np.array([0.0, *(sign * step for step in STEPS for sign in (-1.0, 1.0))])
    found: list[Curve] = []
    evaluations = 0
    for curve in curves:
        s, _ = _panels(wo, width, AZIMUTHS, None, False, _turns((curve,), wo))
        x = _radius(curve, wo, width, s)
        inside = np.flatnonzero((x > 0) & (x < 1))
        if not len(inside):
            continue
        if curve is not CURVES[0]:
            inside = inside[:: -(-len(inside) // FEW)]
        s, x = s[inside], x[inside]
        x = x + shift[:, None] * np.minimum(x, 1 - x)
        wi, weight, _ = slope_map(wo, width, x, s)
        flat = wi.reshape(-1, 3)
        value = np.asarray(integrand(np.concatenate([flat, mirrored(flat, wo)])), dtype=float)
        value = value.reshape(2, *x.shape, -1) * weight[..., None]
        size = np.abs(value[:, 0]).sum(axis=(0, 1))
        wide, near = (
            np.abs(value[:, k] + value[:, k + 1] - 2 * value[:, 0]).sum(axis=(0, 1)) for k in (1, 3)
        )
        bends = (near > KINK[0] * wide) & (near < KINK[1] * wide) & (near > NOISE * size)
        found += [curve] if np.any(bends) else []
        evaluations += 2 * x.size
    if any(curve.crossed for curve in found):
        found = list(dict.fromkeys([CURVES[0], *found]))
    return tuple(found), evaluations


def split_rule(
    wo: FloatArray,
    width: float,
    n: tuple[int, int],
    *,
    ridge: Ridge | None = None,
    symmetric: bool = False,
    curves: tuple[Curve, ...] = CURVES[:1],
) -> tuple[FloatArray, FloatArray]:
    """Return directions and weights like ``slope_rule``, by Gauss-Legendre rules between curves.

    Parameters
    ----------
    n : (int, int)
        Nodes along each radial part, and along each panel of azimuth: two, or up to five beside a ridge.
    ridge : Ridge, optional
        Where a long lobe lies, for azimuths to crowd at.
    curves : tuple of Curve, optional
        Where to cut: at the circle cosθi = cosθo unless given.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> wi, weight = split_rule(wo, 1.0, (24, 24))
    >>> brighter = wi[:, 2] > wo[2]  # a cap of height 1 − cosθo
    >>> round(float(weight[brighter].sum() / (2 * np.pi)), 9)
    0.2
    """
    u, wu = gauss_legendre(n[0])
    if any(curve.rooted for curve in curves):
        u, wu = eased(u, wu)
    turns = _turns(curves, wo)
    sides = []
    for far in (False,) if symmetric or ridge is None else (False, True):
        s, ws = _panels(wo, width, n[1], ridge, far, turns)
        local = np.full_like(s, width) if ridge is None else ridge.width(wo, width, s, far)
        cuts = np.sort([_radius(curve, wo, local, s) for curve in curves], axis=0)
        ends = np.concatenate([np.zeros((1, len(s))), cuts.reshape(-1, len(s)), np.ones((1, len(s)))])
        parts = []
        for low, high in pairwise(ends):
            at = high > low
            span = (high - low)[at]
            wi, weight, _ = slope_map(wo, local[at], low[at] + span * u[:, None], s[at])
            parts.append((wi, weight, wu[:, None] * span * ws[at]))
        wi, weight = _joined(parts)
        sides.append((mirrored(wi, wo) if far else wi, weight))
    wi, weight = sides[0]
    if symmetric:
        return wi, weight
    other = sides[1] if ridge is not None else (mirrored(wi, wo), weight)
    return np.concatenate([wi, other[0]]), np.concatenate([weight, other[1]]) / 2


def _panels(
    wo: FloatArray, width: float, n: int, ridge: Ridge | None, far: bool, turns: tuple[float, ...]
) -> tuple[FloatArray, FloatArray]:
    """Return azimuths s in [0, 1] and their weights, in panels that end, and crowd, where f bends."""
    big_y = float(np.arcsinh(np.hypot(wo[0], wo[1]) / wo[2]))
    # Where y is less than the width, the circle runs through the lobe.
    focus = {0.5: min(width / (np.pi * big_y), 0.5) if big_y > 0 else 0.5}
    if ridge is not None:
        place = 1 - ridge.place if far else ridge.place
        if abs(place - 0.5) > 1e-3:
            focus[place] = ridge.aspect / np.pi
        else:
            focus[0.5] = min(focus[0.5], ridge.aspect / np.pi)
        if min(place, 1 - place) * np.pi < ridge.aspect:  # the ridge is at an end, and seen from both
            focus = {0.5: focus[0.5], 0.0: ridge.aspect / np.pi, 1.0: ridge.aspect / np.pi}
    points = sorted({0.0, 1.0, *focus, *turns})
    places, weights = [], []
    v, wv = gauss_legendre(n)
    for low, high in pairwise(points):
        ends = [(low, high), (high, low)]
        ends = [(a, b) for a, b in ends if a in focus] or ends[:1]
        for a, b in ends:
            b = (a + b) / 2 if len(ends) == 2 else b
            scale = focus.get(a, 1.0)
            length = np.arcsinh(abs(b - a) / scale)
            places.append(a + np.copysign(scale, b - a) * np.sinh(length * v))
            weights.append(scale * np.cosh(length * v) * length * wv)
    return np.clip(np.concatenate(places), 0.0, 1.0), np.concatenate(weights)


def _joined(parts: list[tuple[Any, Any, Any]]) -> tuple[FloatArray, FloatArray]:
    directions = np.concatenate([wi.reshape(-1, 3) for wi, _, _ in parts])
    return directions, np.concatenate([(weight * w).ravel() for _, weight, w in parts])
