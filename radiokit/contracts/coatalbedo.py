"""Coat albedo: what a coat reflects in all, as a function of the angle, exact or tabulated with a bound."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.contracts.combining import plus, same
from radiokit.facts.directions import reflect
from radiokit.facts.errors import ParameterError

__all__ = ["CoatAlbedo", "coat_albedo"]

FIRST, MOST = 17, 513
"""Knots at first, and at most."""

AIM = 2e-6
"""Error of the interpolation that refinement aims at."""

GRAZING = 1e-3
"""The square root of the smallest tabulated cosine; below it the albedo is taken as constant."""

_RTOL = 1e-8
_NODES = 8


@dataclass(frozen=True)
class CoatAlbedo:
    """E(cosθ), the share of the flux that a coat reflects, never too small, and its cosine-weighted mean.

    Parameters
    ----------
    coat : BSDF
    bound : float
        By how much E may be too large [1]: what interpolation and quadrature may err by is added to it, so
        that nothing below the coat is given light that the coat has reflected. 0 for a coat of delta lobes.
    average : float or ndarray, shape () or (K,)
        ∫ E 2 cosθ dcosθ of this very E.
    """

    coat: BSDF = field(repr=False)
    bound: float
    average: Any
    _table: Any = field(default=None, repr=False, compare=False)

    @property
    def exact(self) -> bool:
        """Whether nothing is tabulated."""
        return self._table is None

    def __call__(self, w: FloatArray) -> FloatArray:
        """Return E [1] for directions (N, 3), of shape (N,) or (N, K); 1 below the surface."""
        z = w[:, 2]
        if self._table is None:
            found = _delta(self.coat, w)
        else:
            found = np.asarray(self._table(np.sqrt(np.clip(z, GRAZING**2, 1.0)))) + self.bound
        lit = z > 0 if found.ndim == 1 else (z > 0)[:, None]
        return np.where(lit, np.minimum(found, 1.0), 1.0)


@lru_cache(maxsize=64)
def coat_albedo(coat: BSDF) -> CoatAlbedo:
    """Tabulate a coat's albedo by quadrature, or take it from its delta lobes where it has nothing else.

    Knots are added in the square root of the cosine, where their monotone cubic misses what is between; the
    bound is three times the worst miss in the middles of all intervals, and the quadrature's.

    Raises
    ------
    ParameterError
        When the coat is not isotropic, or has a delta lobe that is no mirror's.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> glass = coat_albedo(bsdf("dielectric", eta=1.5))
    >>> round(float(glass.average), 6), round(float(glass(np.array([[0.0, 0.0, 1.0]]))[0]), 12)
    (0.091778, 0.04)
    """
    if not coat.isotropic:
        raise ParameterError("coat", coat, "isotropic")
    slanted = _upwards(np.array([0.6]))
    for lobe in coat.delta_lobes(slanted):
        if lobe.wi[0, 2] > 0 and not same(lobe.wi, reflect(slanted)).all():
            raise ParameterError("coat", coat, "without delta lobes but the mirror's and what is transmitted")
    if (said := coat.claims) is not None and said.delta:
        from scipy.integrate import quad_vec

        value, _ = quad_vec(
            lambda t: 4 * t**3 * _delta(coat, _upwards(np.array([t * t])))[0],
            0.0,
            1.0,
            epsabs=1e-13,
            limit=4000,
        )
        return CoatAlbedo(coat, 0.0, value)
    table, bound = _tabulated(coat)
    partial = CoatAlbedo(coat, bound, 0.0, table)
    x, weight = np.polynomial.legendre.leggauss(_NODES)
    ends = np.concatenate([[0.0], table.x])
    half = np.diff(ends)[:, None] / 2
    t, weight = ((ends[:-1, None] + half * (x + 1)).ravel(), (half * weight).ravel())
    mean = np.tensordot(4 * t**3 * weight, partial(_upwards(t * t)), axes=1)
    return CoatAlbedo(coat, bound, mean if np.ndim(mean) else float(mean), table)


def _tabulated(coat: BSDF) -> tuple[Any, float]:
    from scipy.interpolate import PchipInterpolator

    def at(roots: FloatArray) -> tuple[FloatArray, float]:
        found = [_integrated(coat, w) for w in _upwards(roots**2)]
        return np.array([value for value, _ in found]), max((error for _, error in found), default=0.0)

    knots = np.linspace(GRAZING, 1.0, FIRST)
    values, error = at(knots)
    doubtful = np.ones(FIRST - 1, dtype=bool)
    while doubtful.any() and len(knots) + 2 * doubtful.sum() <= MOST:
        left, step = knots[:-1][doubtful], np.diff(knots)[doubtful]
        inside = np.stack([left + 0.3 * step, left + 0.7 * step], axis=1)
        new, more = at(inside.ravel())
        miss = np.abs(PchipInterpolator(knots, values, axis=0)(inside.ravel()) - new)
        bad = miss.reshape(len(left), -1).max(axis=1) > AIM
        added, kept = inside[bad].ravel(), new.reshape(*inside.shape, *new.shape[1:])[bad]
        order = np.argsort(np.concatenate([knots, added]))
        knots = np.concatenate([knots, added])[order]
        values = np.concatenate([values, kept.reshape(-1, *new.shape[1:])])[order]
        doubtful = np.zeros(len(knots) - 1, dtype=bool)
        first = np.searchsorted(knots, left[bad])
        doubtful[(first[:, None] + np.arange(3)).ravel()] = True
        error = max(error, more)
    table = PchipInterpolator(knots, values, axis=0)
    middle = (knots[:-1] + knots[1:]) / 2  # where it was not fitted, nor looked at
    new, more = at(middle)
    miss = float(np.abs(table(middle) - new).max())
    # What the table leaves out, from its last cosine to grazing, is held against one far beyond.
    beyond, _ = at(np.array([GRAZING / 30]))
    outside = float(np.abs(beyond[0] - values[0]).max())
    return table, 3 * miss + max(error, more) + outside


def _upwards(cosine: FloatArray) -> FloatArray:
    sine = np.sqrt((1 - cosine) * (1 + cosine))
    return np.stack([sine, np.zeros_like(sine), cosine], axis=-1)


def _delta(coat: BSDF, w: FloatArray) -> FloatArray:
    """Return the share of the flux that is in the mirror lobe."""
    total: FloatArray = np.zeros(len(w))
    for lobe in coat.delta_lobes(w):
        up = (lobe.wi[:, 2] > 0) & (w[:, 2] > 0)
        weight = np.asarray(lobe.weight)
        total = plus(total, np.where(up if weight.ndim == 1 else up[:, None], weight, 0.0))
    return total


def _integrated(coat: BSDF, w: FloatArray) -> tuple[Any, float]:
    """Return what is reflected of the flux from ``w`` (3,), with an error bound."""
    from radiokit.measure.quadrature import hemisphere

    def value(other: FloatArray) -> Any:
        return (np.asarray(coat.evaluate(other, np.broadcast_to(w, other.shape))).T * other[:, 2]).T

    found = hemisphere(
        value, wo=w, width=coat.lobe_width(), rtol=_RTOL, atol=_RTOL, symmetric=True, smooth=coat.smooth
    )
    delta = _delta(coat, w[None])[0]
    return found.value + delta, float(np.max(found.error))
