"""Polar: rules in polar angle and azimuth, cut where a rough diffuse surface's f bends or is cut off at 0."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.gauss import eased, gauss_legendre

__all__ = ["POLAR_SIZES", "LitRules", "polar_rule"]

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


class LitRules:
    """Rules for where an integrand is not 0: as ``polar_rule``, ending where the light does.

    Each quarter of a circle of equal θ ends where the light does, and θ is cut where that end comes to an
    edge of the quarter; from there it moves as a root does, which the nodes are eased for. At most one end to
    a quarter is found: more of them only slow down the convergence.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> cut_off = lambda w: np.maximum(w[:, 2] - w[:, 0], 0.0)
    >>> wi, weight = LitRules(cut_off, wo).rule(24)
    >>> round(float(weight @ cut_off(wi)), 13) == round(np.pi * (1 + 2**0.5) / 2, 13)  # a tilted half-space
    True
    """

    def __init__(
        self, integrand: Callable[[FloatArray], Any], wo: FloatArray, *, symmetric: bool = False
    ) -> None:
        self._integrand, self._wo, self._symmetric = integrand, wo, symmetric
        self.evaluations = 0
        """Values that were taken to find where the light ends."""
        look = 0.5 * np.pi * (np.arange(_LOOK) + 0.5) / _LOOK
        ends = {0.0, _polar_angle(wo), 0.5 * np.pi}
        for edge in _quarters(symmetric):
            at_edge = partial(self._at, edge)
            seen = at_edge(look)
            (changes,) = np.nonzero(seen[1:] != seen[:-1])
            ends |= set(_halved(at_edge, look[changes], look[changes + 1], seen[changes]).tolist())
        self._ends = tuple(sorted(ends))

    def rule(self, n: int) -> tuple[FloatArray, FloatArray]:
        """Return directions (N, 3) and weights (N,), with ``n`` nodes along each side of a piece."""
        u, wu = gauss_legendre(n)
        theta, w_theta = _pieces(self._ends, *eased(u, wu))
        w_theta = w_theta * np.sin(theta) * (2.0 if self._symmetric else 1.0)
        directions, weights = [], []
        for low, high in pairwise(_quarters(self._symmetric)):
            first, last = self._at(low, theta), self._at(high, theta)
            start, end = np.full_like(theta, low), np.full_like(theta, high)
            cut = first != last
            between = _halved(partial(self._lit, theta[cut]), start[cut], end[cut], first[cut])
            start[cut], end[cut] = np.where(first[cut], low, between), np.where(first[cut], between, high)
            span = (end - start)[:, None]
            directions.append(_directions(self._wo, theta[:, None], start[:, None] + span * u).reshape(-1, 3))
            weights.append((w_theta[:, None] * (span * wu)).ravel())
        return np.concatenate(directions), np.concatenate(weights)

    def _lit(self, theta: FloatArray, phi: FloatArray) -> BoolArray:
        wi = _directions(self._wo, theta, phi)
        self.evaluations += len(wi)
        value = np.asarray(self._integrand(wi)).reshape(len(wi), -1)
        return np.asarray((value != 0).any(axis=-1))

    def _at(self, phi: float, theta: FloatArray) -> BoolArray:
        return self._lit(theta, np.full_like(theta, phi))


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
