"""Polar: rules in polar angle and azimuth, cut where a rough diffuse surface's f bends or is cut off at 0."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.gauss import eased, gauss_legendre

__all__ = ["POLAR_SIZES", "lit_rule", "polar_rule"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

POLAR_SIZES = (8, 12, 16, 24, 32, 48, 64)
"""Nodes along each side of a piece."""

_LOOK = 64  # polar angles at which it is looked whether an azimuth between two pieces is dark
_HALVINGS = 53  # of an interval in which light ends


def polar_rule(wo: FloatArray, n: int, *, symmetric: bool = False) -> tuple[FloatArray, FloatArray]:
    """Return directions (N, 3) and weights (N,) that integrate over the upper hemisphere.

    Gauss-Legendre rules in θ and φ between the places where max(θi, θo) and max(0, cos Δφ) bend: the
    circle θi = θo, and the azimuths at right angles to that of ``wo``. With ``symmetric`` one half of the
    azimuths stands for both.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> wi, weight = polar_rule(wo, 16)
    >>> bent = np.maximum(wi[:, 0], 0) * np.maximum(wi[:, 2], wo[2])
    >>> theta = np.arctan2(0.6, 0.8)  # ∫ sin²θ max(cosθ, cosθo) dθ, times ∫ cosφ dφ over the front
    >>> exact = 2 * (0.6**3 / 3 + 0.4 * (np.pi / 2 - theta + 0.48))
    >>> bool(abs(weight @ bent - exact) < 1e-14)
    True
    """
    u, wu = gauss_legendre(n)
    theta, w_theta = _pieces((0.0, _polar_angle(wo), 0.5 * np.pi), u, wu)
    phi, w_phi = _pieces(_quarters(symmetric), u, wu)
    weight = w_theta[:, None] * np.sin(theta)[:, None] * w_phi * (2.0 if symmetric else 1.0)
    return _directions(wo, theta[:, None], phi).reshape(-1, 3), weight.ravel()


def lit_rule(
    integrand: Callable[[FloatArray], Any], wo: FloatArray, n: int, *, symmetric: bool = False
) -> tuple[FloatArray, FloatArray, int]:
    """Return directions (N, 3) and weights (N,) for where an integrand is not 0, and the values that it took.

    As ``polar_rule``, with each quarter of a circle of equal θ ending where the light does, and θ cut where
    that end comes to an edge of the quarter; from there it moves as a root does, which the nodes are eased
    for. At most one end to a quarter is found: more of them only slow down the convergence.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> cut_off = lambda w: np.maximum(w[:, 2] - w[:, 0], 0.0)
    >>> wi, weight, _ = lit_rule(cut_off, wo, 24)
    >>> round(float(weight @ cut_off(wi)), 13) == round(np.pi * (1 + 2**0.5) / 2, 13)  # a tilted half-space
    True
    """
    spent = 0

    def lit(theta: FloatArray, phi: FloatArray) -> BoolArray:
        nonlocal spent
        wi = _directions(wo, theta, phi)
        spent += wi.size // 3
        value = np.asarray(integrand(wi.reshape(-1, 3)))
        return np.asarray((value.reshape(*wi.shape[:-1], -1) != 0).any(axis=-1))

    u, wu = gauss_legendre(n)
    look = 0.5 * np.pi * (np.arange(_LOOK) + 0.5) / _LOOK
    ends = {0.0, _polar_angle(wo), 0.5 * np.pi}
    quarters = _quarters(symmetric)
    for edge in quarters:
        at_edge = partial(_at, lit, edge)
        seen = at_edge(look)
        (changes,) = np.nonzero(seen[1:] != seen[:-1])
        ends |= set(_halved(at_edge, look[changes], look[changes + 1], seen[changes]).tolist())
    theta, w_theta = _pieces(tuple(sorted(ends)), *eased(u, wu))
    rows = []
    for low, high in pairwise(quarters):
        first, last = lit(theta, np.full_like(theta, low)), lit(theta, np.full_like(theta, high))
        from_, to = np.full_like(theta, low), np.full_like(theta, high)
        cut = first != last
        end = _halved(partial(lit, theta[cut]), from_[cut], to[cut], first[cut])
        to[cut], from_[cut] = np.where(first[cut], end, high), np.where(first[cut], low, end)
        span = (to - from_)[:, None]
        weight = w_theta[:, None] * np.sin(theta)[:, None] * (span * wu) * (2.0 if symmetric else 1.0)
        rows.append((_directions(wo, theta[:, None], from_[:, None] + span * u), weight))
    wi = np.concatenate([directions.reshape(-1, 3) for directions, _ in rows])
    return wi, np.concatenate([weight.ravel() for _, weight in rows]), spent


def _at(lit: Callable[[FloatArray, FloatArray], BoolArray], phi: float, theta: FloatArray) -> BoolArray:
    return lit(theta, np.full_like(theta, phi))


def _halved(
    lit: Callable[[FloatArray], BoolArray], low: FloatArray, high: FloatArray, first: BoolArray
) -> FloatArray:
    """Return where between ``low`` and ``high`` the light ends, or begins, as it is ``first`` at ``low``."""
    for _ in range(_HALVINGS if len(low) else 0):
        middle = 0.5 * (low + high)
        same = lit(middle) == first
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def _polar_angle(wo: FloatArray) -> float:
    return float(np.arctan2(np.hypot(wo[0], wo[1]), wo[2]))


def _quarters(symmetric: bool) -> tuple[float, ...]:
    half = (0.0, 0.5 * np.pi, np.pi)
    return half if symmetric else (*half, 1.5 * np.pi, 2 * np.pi)


def _directions(wo: FloatArray, theta: FloatArray, phi: FloatArray) -> FloatArray:
    """Return directions (..., 3) with azimuths that count from that of ``wo``."""
    across = float(np.hypot(wo[0], wo[1]))
    x, y = (wo[0] / across, wo[1] / across) if across > 0 else (1.0, 0.0)
    sine, a, b = np.sin(theta), np.cos(phi), np.sin(phi)
    z = np.broadcast_to(np.cos(theta), np.broadcast_shapes(theta.shape, phi.shape))
    return np.stack((sine * (a * x - b * y), sine * (a * y + b * x), z), axis=-1)


def _pieces(ends: tuple[float, ...], u: FloatArray, wu: FloatArray) -> tuple[FloatArray, FloatArray]:
    pieces = [(low, high - low) for low, high in pairwise(ends) if high > low]
    places = [low + span * u for low, span in pieces]
    return np.concatenate(places), np.concatenate([span * wu for _, span in pieces])
