"""Lattice: points that fill the unit cube evenly, the same ones in every run."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from radiokit.facts.source import Source

__all__ = ["KOROBOV_LOG2", "korobov", "kronecker"]

SOURCE = Source(
    authors="Roberts",
    year=2018,
    title="The unreasonable effectiveness of quasirandom sequences",
    equation="the recurrence R_d",
)


def kronecker(count: int, dimensions: int) -> npt.NDArray[np.float64]:
    """Return the first ``count`` low-discrepancy points (count, dimensions) of the recurrence R_d.

    Point k is the fractional part of 1/2 + k a, where a holds the powers of the reciprocal of the root of
    x^(d+1) = x + 1, the generalised golden ratio. More points continue the same sequence.

    Source: Roberts (2018), The unreasonable effectiveness of quasirandom sequences.

    >>> kronecker(2, 2).round(3).tolist()
    [[0.255, 0.07], [0.01, 0.64]]
    """
    root = 1.5
    for _ in range(64):
        root = (1 + root) ** (1 / (dimensions + 1))
    steps = root ** -np.arange(1.0, dimensions + 1)
    points: npt.NDArray[np.float64] = (0.5 + np.arange(1.0, count + 1)[:, None] * steps) % 1.0
    return points


KOROBOV_MULTIPLIER = 8693451
"""The best of 6000 random odd numbers by the worst ratio, over 2⁵ to 2²⁰ points in 2 and 4 dimensions, of P₂
(the worst-case error for smooth periodic integrands) to the least that any of the candidates reached."""

KOROBOV_LOG2 = 24
"""The largest lattice has 2²⁴ points."""


def korobov(index: npt.ArrayLike, count: int, dimensions: int) -> npt.NDArray[np.float64]:
    """Return points (N, dimensions) of the Korobov lattice of ``count`` points, by their ``index`` (N,).

    Point k is the fractional part of k (1, a, a², ...) / count. The lattice of 2 count points consists of
    this one, at its even indices, and of as many new points between them: a run that is doubled keeps all
    of its work.

    Parameters
    ----------
    index : array_like of int, shape (N,)
        In [0, count).
    count : int
        A power of 2 up to 2²⁴.
    dimensions : int

    Source: Hickernell, Hong, L'Ecuyer, Lemieux (2000), Extensible lattice sequences for quasi-Monte Carlo
    quadrature, SIAM Journal on Scientific Computing 22(3), doi:10.1137/S1064827599356638; the multiplier is
    our own.

    >>> korobov([0, 1, 2, 3], 4, 2).tolist()
    [[0.0, 0.0], [0.25, 0.75], [0.5, 0.5], [0.75, 0.25]]
    """
    steps = [pow(KOROBOV_MULTIPLIER, power, count) for power in range(dimensions)]
    turns = np.asarray(index, dtype=np.int64)[:, None] * np.array(steps, dtype=np.int64)
    points: npt.NDArray[np.float64] = (turns & (count - 1)) / count
    return points
