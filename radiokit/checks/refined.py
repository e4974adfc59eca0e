"""Refined: what a density puts into each cell of a square, in boxes as small as a narrow ridge needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.gauss import gauss_legendre

__all__ = ["Shares", "refined_shares"]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]
Points = tuple[FloatArray, FloatArray, Any]
"""x, s and side of points (N,); the side is a boolean."""
Pair = tuple[FloatArray, FloatArray]

NODES = 6, 9
"""Gauss-Legendre nodes along each side of a box, of two rules that must agree."""

DEPTH = 11
"""Halvings of a cell's sides."""

CLOSE, FAINT = 0.02, 1e-4
"""Difference of the rules that is let pass, in standard deviations of a box's count, of at least so many."""

ODD = 4.0
"""Standard deviations by which a count must be off for its box to be looked into."""

MISSED = 4.0
"""By how much the density at a sample exceeds that at all nodes where a ridge passes between them."""


@dataclass(frozen=True)
class Shares:
    """The integral over each cell (C,), its cost, and whether every box was small enough to say so."""

    shares: FloatArray
    evaluations: int
    resolved: bool


def refined_shares(
    density: Callable[[FloatArray, FloatArray, Any], FloatArray],
    sides: tuple[int, int],
    samples: Points,
    count: int,
    most: int,
) -> Shares:
    """Integrate a density over the cells of two unit squares, one on each side of a plane.

    A box is cut into four where two rules for it differ, or where the number of samples in it is not what
    they say: a ridge may pass between all nodes, and then only the samples know of it.

    Parameters
    ----------
    density : callable
        Takes coordinates x, s (N,) in [0, 1] and the side (N,), returns the density over the square (N,).
    sides : (int, int)
        Cells along x and s.
    samples : (ndarray, ndarray, ndarray)
        x, s and side of M samples.
    count : int
        Samples in all, M and those that are elsewhere.
    most : int
        Evaluations that may be spent.

    >>> def ridge(x, s, far):
    ...     return np.where(far, 0.0, np.exp(-0.5 * ((x - s) / 1e-3) ** 2) / (1e-3 * np.sqrt(2 * np.pi)))
    >>> found = refined_shares(ridge, (2, 2), (np.zeros(0), np.zeros(0), np.zeros(0, bool)), 10_000, 10**6)
    >>> found.resolved, (found.shares[:4] + 0.0).round(2).tolist()
    (True, [0.5, 0.0, 0.0, 0.5])
    """
    total = np.zeros(2 * sides[0] * sides[1])
    far, i, j = (
        index.ravel() for index in np.meshgrid(*map(np.arange, (2, sides[0], sides[1])), indexing="ij")
    )
    heights = density(*samples)
    spent, resolved = len(heights), True
    for level in range(DEPTH + 1):
        n = sides[0] << level, sides[1] << level
        (low, _), (high, peak) = (_sums(density, far, i, j, n, nodes) for nodes in NODES)
        spent += len(far) * sum(nodes * nodes for nodes in NODES)
        seen, top = _seen(samples, heights, n, (far * n[0] + i) * n[1] + j)
        due = np.maximum(high, 0.0) * count
        odd = np.abs(seen - due) > ODD * np.sqrt(due + 1.0)
        unsure = (np.abs(high - low) * count > CLOSE * np.sqrt(due + FAINT)) | (top > MISSED * peak)
        split = unsure | odd
        if level == DEPTH or spent + 4 * split.sum() * sum(nodes * nodes for nodes in NODES) > most:
            resolved, split = not np.any(unsure), np.zeros(len(far), dtype=bool)
        done = ~split
        cell = (far[done] * sides[0] + (i[done] >> level)) * sides[1] + (j[done] >> level)
        np.add.at(total, cell, high[done])
        if not np.any(split):
            break
        far, i, j = (np.repeat(index[split], 4) for index in (far, i, j))
        i, j = 2 * i + np.tile([0, 0, 1, 1], split.sum()), 2 * j + np.tile([0, 1, 0, 1], split.sum())
    return Shares(total, spent, resolved)


def _sums(
    density: Callable[[FloatArray, FloatArray, Any], FloatArray],
    far: IntArray,
    i: IntArray,
    j: IntArray,
    n: tuple[int, int],
    nodes: int,
) -> Pair:
    """Return the integral over each box by one rule, and the largest value that it saw there."""
    u, w = gauss_legendre(nodes)
    shape = (len(far), nodes, nodes)
    x = np.broadcast_to(((i[:, None] + u) / n[0])[:, :, None], shape)
    s = np.broadcast_to(((j[:, None] + u) / n[1])[:, None, :], shape)
    side = np.broadcast_to((far > 0)[:, None, None], shape)
    value = density(x.ravel(), s.ravel(), side.ravel()).reshape(shape)
    sums = np.einsum("kab,a,b->k", value, w, w) / (n[0] * n[1])
    return sums, value.max(axis=(1, 2))


def _seen(samples: Points, heights: FloatArray, n: tuple[int, int], boxes: IntArray) -> Pair:
    """Return how many samples are in each box, given by its number, and the density's top at them."""
    x, s, far = samples
    i = np.minimum((x * n[0]).astype(np.intp), n[0] - 1)
    j = np.minimum((s * n[1]).astype(np.intp), n[1] - 1)
    number, which = np.unique((far.astype(np.intp) * n[0] + i) * n[1] + j, return_inverse=True)
    times, top = np.bincount(which, minlength=len(number)), np.zeros(len(number))
    np.maximum.at(top, which, heights)
    if not len(number):
        return np.zeros(len(boxes)), np.zeros(len(boxes))
    at = np.minimum(np.searchsorted(number, boxes), len(number) - 1)
    there = number[at] == boxes
    return np.where(there, times[at], 0).astype(float), np.where(there, top[at], 0.0)
