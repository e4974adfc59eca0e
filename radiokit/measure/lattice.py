"""Lattice: points that fill the unit cube evenly, the same ones in every run."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from radiokit.facts.source import Source

__all__ = ["kronecker"]

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
