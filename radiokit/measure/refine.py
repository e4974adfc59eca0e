"""Refine: panels of squares, halved where two rules differ, many at a time."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import NonFiniteError
from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import BLOCK, ROUNDING

__all__ = ["PANEL", "lobatto", "refine"]

FloatArray = npt.NDArray[np.float64]

FINE, COARSE = 9, 6
"""Nodes along each axis of the two rules whose difference on a panel is taken for its error."""

PANEL = FINE * FINE + COARSE * COARSE
"""Evaluations on a panel."""

LEFT = 0.1
"""Share of the whole error that may stay in the panels that are not refined next."""

SAFETY, FEW = 4.0, 6.0
"""Factors on the sum of the panels' differences, and on the root of the sum of their squares: on few panels,
or where a kink crosses all of them alike, they may be small by chance."""

HOPE = 4.0
"""Times the budget that a run may be foretold to need without being given up: the error falls unevenly."""

ROUNDS = 4
"""Rounds after which the cost of reaching the tolerance is foretold from how the error falls."""


def lobatto(n: int) -> tuple[FloatArray, FloatArray]:
    """Return the nodes and weights of the n-point Gauss-Lobatto rule on [0, 1], which has both ends.

    A rule without the ends does not see a kink between its last node and the end.

    >>> x, w = lobatto(4)
    >>> x[[0, -1]].tolist(), round(float(w @ x**5), 15)
    ([0.0, 1.0], 0.166666666666667)
    """
    last = np.zeros(n)
    last[-1] = 1.0  # the Legendre polynomial of degree n − 1
    inner = np.polynomial.legendre.legroots(np.polynomial.legendre.legder(last))
    x = np.concatenate([[-1.0], np.real(inner), [1.0]])
    w = 2.0 / (n * (n - 1) * np.polynomial.legendre.legval(x, last) ** 2)
    return (x + 1.0) / 2.0, w / 2.0


@lru_cache(maxsize=1)
def _pair() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the points of both rules together, and the weights of the finer one and of the difference."""
    points, weights = [], []
    for n in (FINE, COARSE):
        x, w = lobatto(n)
        points.append(np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2))
        weights.append(np.outer(w, w).ravel())
    fine = np.concatenate([weights[0], np.zeros(COARSE * COARSE)])
    return np.concatenate(points), fine, fine - np.concatenate([np.zeros(FINE * FINE), weights[1]])


def refine(
    at: Callable[[Any, FloatArray], Any],
    cells: int,
    *,
    rtol: float,
    max_evaluations: int,
    deadline: float = np.inf,
    first: int = 2,
) -> Estimate:
    """Integrate over ``cells`` unit squares together, by panels that are quartered where rules differ.

    Parameters
    ----------
    at : callable
        ``at(cell, x)`` returns values (N,) or (N, K) at x (N, 2) in the squares numbered ``cell`` (N,).
    cells : int
    rtol : float
        The error may be ``rtol |value|``.
    max_evaluations : int
        A budget; it is not exceeded, but for the first round. A run that is bound to exceed it, as one sees
        from how the error falls, stops early.
    deadline : float
        When to stop, by ``time.perf_counter`` [s].
    first : int
        Panels along each axis of a square to begin with.

    Returns
    -------
    Estimate
        ``error`` goes by the sum of the panels' differences, none of which are set off against each other.

    Raises
    ------
    NonFiniteError
        When a value is NaN or infinite.

    >>> kink = lambda cell, x: np.maximum(x[:, 0] + x[:, 1] ** 2 - 0.7, 0.0)
    >>> found = refine(kink, 1, rtol=1e-4, max_evaluations=100_000)
    >>> found.converged, bool(found.error <= 1e-4 * found.value)
    (True, True)
    """
    points, fine, off = _pair()
    corner = np.array([[0.0, 0.0], [0.0, 0.5], [0.5, 0.0], [0.5, 0.5]])
    start = np.stack(np.meshgrid(np.arange(first), np.arange(first), indexing="ij"), axis=-1).reshape(-1, 2)
    cell = np.repeat(np.arange(cells), first * first)
    low, edge = np.tile(start / first, (cells, 1)), np.full(len(cell), 1.0 / first)
    done: list[Any] = []  # cell, low, edge, value, difference, size: of all panels that are kept
    spent = 0
    history: list[tuple[int, float]] = []
    while True:
        new = _measure(at, points, fine, off, cell, low, edge)
        spent += len(cell) * len(points)
        done = [np.concatenate(pair) for pair in zip(done, new, strict=True)] if done else list(new)
        total, size = done[3].sum(axis=0), done[5].sum(axis=0)
        apart = np.abs(done[4])
        error = SAFETY * apart.sum(axis=0) + FEW * np.sqrt((apart**2).sum(axis=0)) + ROUNDING * size
        aim = rtol * np.abs(total)
        excess = float(np.max(np.divide(error, aim, out=np.full_like(error, np.inf), where=aim > 0)))
        if not np.any(size > 0):
            return _estimate(total, error, spent, True)
        history.append((spent, excess))
        if excess <= 1 or time.perf_counter() > deadline or _hopeless(history, max_evaluations):
            return _estimate(total, error, spent, excess <= 1)
        share = (apart / np.where(aim > 0, aim, np.maximum(size * rtol, 1e-300))).max(axis=1)
        noise = (ROUNDING * done[5] / np.where(size > 0, size, 1.0)).max(axis=1) * 1e-2
        order = np.argsort(-share)
        kept = np.cumsum(share[order][::-1])[::-1] > LEFT * min(share.sum(), 1.0 if excess < 2 else np.inf)
        chosen = order[kept & (share[order] * rtol > noise[order])]
        most = (max_evaluations - spent) // (4 * len(points))
        chosen = chosen[:most]
        if not len(chosen):
            return _estimate(total, error, spent, False)
        cell = np.repeat(done[0][chosen], 4)
        edge = np.repeat(done[2][chosen] / 2, 4)
        low = np.repeat(done[1][chosen], 4, axis=0) + 2 * np.tile(corner, (len(chosen), 1)) * edge[:, None]
        rest = np.ones(len(done[0]), dtype=bool)
        rest[chosen] = False
        done = [each[rest] for each in done]


def _measure(
    at: Callable[[Any, FloatArray], Any],
    points: FloatArray,
    fine: FloatArray,
    off: FloatArray,
    cell: Any,
    low: FloatArray,
    edge: FloatArray,
) -> tuple[Any, ...]:
    """Return the panels with their values, differences of two rules and sums of absolute terms (P, K)."""
    found: list[list[FloatArray]] = [[], [], []]
    step = max(1, BLOCK // len(points))
    for first in range(0, len(cell), step):
        part = slice(first, first + step)
        x = (low[part, None, :] + points * edge[part, None, None]).reshape(-1, 2)
        values = np.asarray(at(np.repeat(cell[part], len(points)), x), dtype=float)
        if not np.all(np.isfinite(values)):
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            at_point = tuple(x[row].tolist())
            raise NonFiniteError(
                f"the integrand is {values[row]} at {at_point}", value=values[row], at=x[row].copy()
            )
        values = values.reshape(len(edge[part]), len(points), -1) * (edge[part] ** 2)[:, None, None]
        for kind, (weight, value) in enumerate(((fine, values), (off, values), (fine, np.abs(values)))):
            found[kind].append(np.einsum("n,pnk->pk", weight, value))
    return cell, low, edge, *(np.concatenate(parts) for parts in found)


def _hopeless(history: list[tuple[int, float]], budget: int) -> bool:
    """Return whether the error falls too slowly for the budget, by its last rounds."""
    if len(history) <= ROUNDS:
        return False
    after, now = history[-1]
    if not np.isfinite(now) or now <= 1 or now >= history[-2][1]:
        return False  # it may rise where a round has found what the ones before had not seen
    rates = [
        np.log(max(then / now, 1.0)) / np.log(after / before)
        for before, then in history[:-2]
        if np.isfinite(then)
    ]
    return bool(np.log(now) > max(rates, default=0.0) * np.log(max(HOPE * budget / after, 1.0)))


def _estimate(total: Any, error: Any, spent: int, converged: bool) -> Estimate:
    scalar = total.shape == (1,)
    value, bound = (float(total[0]), float(error[0])) if scalar else (total, error)
    return Estimate(value, bound, "truncation", spent, converged=converged)
