"""Square: integrals over the unit square, with nodes that crowd where a peak is known."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import NonFiniteError
from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import BLOCK, MEMORY, RuleSum, apply_rule, converge
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.refine import PANEL, refine

__all__ = ["Axis", "Focus", "crowded_square"]

FloatArray = npt.NDArray[np.float64]
Integrand = Callable[[FloatArray], Any]

PLAIN = (8, 12, 16, 24, 32, 48, 64, 96, 128)
"""Nodes along each axis where nothing peaks, tried in turn until rules agree."""

CROWDED = (8, 12, 18, 24, 32, 44, 60, 84)
"""The same on each side of a peak."""

DOUBT, DOUBTFUL = 10.0, (0.0, 0.0, 0.0)
"""Factor on the error where kinks may be inside, and the powers by which older differences then count."""

SMOOTH_MOST, DOUBTFUL_MOST = 60_000, 24_000
"""Evaluations that product rules may use, without and with such doubt."""

KINKED = 5
"""Panels along each axis where kinks are known to be inside, so that some of them see each kink."""

APART = 3.0
"""Peaks nearer than so many widths are resolved as one."""

LINEAR = 8.0
"""Widths above so many lengths of a segment crowd nothing."""


@dataclass(frozen=True)
class Axis:
    """A coordinate u of the square as a function of v in [0, 1].

    At a pole, where all of an edge is one point and distance from it goes as the root of u, u is quadratic
    in v; a periodic coordinate starts anywhere.
    """

    low_pole: bool = False
    high_pole: bool = False
    start: float | None = None

    def to_u(self, v: FloatArray) -> tuple[FloatArray, Any]:
        """Return u and du/dv."""
        if self.start is not None:
            return (v + self.start) % 1.0, 1.0
        if self.low_pole and self.high_pole:
            return v * v * (3.0 - 2.0 * v), 6.0 * v * (1.0 - v)
        if self.low_pole:
            return v * v, 2.0 * v
        if self.high_pole:
            return v * (2.0 - v), 2.0 * (1.0 - v)
        return v, 1.0

    def to_v(self, u: float) -> float:
        """Return v.

        >>> [round(Axis(*poles).to_v(0.36), 12) for poles in ((False, False), (True, False))]
        [0.36, 0.6]
        """
        if self.start is not None:
            return (u - self.start) % 1.0
        if self.low_pole and self.high_pole:
            return 0.5 - float(np.sin(np.arcsin(np.clip(1.0 - 2.0 * u, -1.0, 1.0)) / 3.0))
        if self.low_pole:
            return float(np.sqrt(u))
        if self.high_pole:
            return 1.0 - float(np.sqrt(1.0 - u))
        return u


@dataclass(frozen=True)
class Focus:
    """A peak at ``place`` (v, v) of the square, and its half-widths along the axes; infinite where broad."""

    place: tuple[float, float]
    width: tuple[float, float]


class _Cells:
    """Products of segments of both axes, each a unit square whose points crowd at one end."""

    def __init__(self, axes: tuple[Axis, Axis], foci: Sequence[Focus]) -> None:
        self.axes = axes
        sides = [_segments([(focus.place[k], focus.width[k]) for focus in foci]) for k in (0, 1)]
        first, second = (len(side) for side in sides)
        self.count = first * second
        self._tables = [
            sides[0][np.repeat(np.arange(first), second)],
            sides[1][np.tile(np.arange(second), first)],
        ]

    def place(self, cell: Any, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the points u (N, 2) at x (N, 2) of the cells (N,), and the area per unit of theirs (N,)."""
        u, area = np.empty_like(x), np.ones(len(x))
        for k in (0, 1):
            origin, step, length = self._tables[k][cell].T
            v = np.clip(origin + step * np.sinh(length * x[:, k]), 0.0, 1.0)
            u[:, k], slope = self.axes[k].to_u(v)
            area *= slope * np.abs(step) * length * np.cosh(length * x[:, k])
        return u, area


def _segments(foci: list[tuple[float, float]]) -> FloatArray:
    """Return (origin, step, length) of segments of [0, 1] that end, and crowd, at the foci."""
    kept: dict[float, float] = {}
    for place, width in sorted(foci, key=lambda focus: focus[1]):
        if np.isfinite(width) and all(abs(place - other) > APART * width for other in kept):
            kept[float(np.clip(place, 0.0, 1.0))] = width
    table = []
    for low, high in pairwise(sorted({0.0, 1.0, *kept})):
        ends = [(a, b) for a, b in ((low, high), (high, low)) if a in kept] or [(low, high)]
        for a, b in ends:
            span = abs(b - a) / len(ends)
            width = min(kept.get(a, np.inf), LINEAR * span)
            table.append((a, np.copysign(width, b - a), np.arcsinh(span / width)))
    return np.array(table)


def crowded_square(
    integrand: Integrand,
    *,
    rtol: float,
    axes: tuple[Axis, Axis] = (Axis(), Axis()),
    foci: Sequence[Focus] = (),
    kinks: bool = False,
    smooth: bool = True,
    max_evaluations: int = 2_000_000,
    refinement: int = 2_000_000,
    deadline: float = np.inf,
) -> Estimate:
    """Integrate over the unit square, crowding nodes at known peaks.

    The square is cut at the foci, and on each side the coordinate is w sinh(L x), w the peak's width, so that
    a peak with tails of any length is smooth in x. Product Gauss-Legendre rules of rising size are compared;
    if they do not agree, panels are refined where two rules differ.

    Parameters
    ----------
    integrand : callable
        Takes points (N, 2), returns (N,) or (N, K).
    rtol : float
        The error may be ``rtol |value|``.
    axes : (Axis, Axis)
    foci : sequence of Focus
    kinks : bool
        Whether kinks are known to be inside: then product rules, which agree by chance, are left out.
    smooth : bool
        False where kinks may be inside: then the last three differences of rules count alike, for each of
        them may be small by chance.
    max_evaluations : int
        A budget, kept to the points of one rule or one round of refinement.
    refinement : int
        What of it may be used to refine panels.
    deadline : float
        When to stop, by ``time.perf_counter`` [s].

    Raises
    ------
    NonFiniteError
        When the integrand is NaN or infinite somewhere.

    >>> narrow = lambda u: 1e-6 / np.pi / (1e-6 + np.sum((u - 0.3) ** 2, axis=1)) ** 2
    >>> found = crowded_square(narrow, rtol=1e-5, foci=[Focus((0.3, 0.3), (1e-3, 1e-3))])
    >>> found.converged, bool(abs(found.value - 1) < 1e-5)
    (True, True)
    """
    start = time.perf_counter()
    cells = _Cells(axes, foci)

    def at(cell: Any, x: FloatArray) -> Any:
        u, area = cells.place(cell, x)
        return (np.asarray(integrand(u), dtype=float).T * area).T

    spent = 0
    found = None
    if not kinks:
        most = min(max_evaluations, SMOOTH_MOST if smooth else DOUBTFUL_MOST)
        rules = _rules(at, cells.count, len(foci) > 0, most, deadline)
        doubt = 1.0 if smooth else DOUBT
        found = converge(rules, rtol / doubt, 0.0, memory=MEMORY if smooth else DOUBTFUL)
        found = replace(found, error=doubt * found.error)
        spent = found.evaluations
    method = "Gauss-Legendre"
    left = min(max_evaluations - spent, refinement)
    if found is None or (not found.converged and left > 0 and time.perf_counter() < deadline):
        panels = KINKED if kinks and left > KINKED**2 * cells.count * PANEL else 2
        more = refine(at, cells.count, rtol=rtol, max_evaluations=left, deadline=deadline, first=panels)
        if found is None or more.converged or np.all(more.error <= found.error):
            found, method = more, "refined Gauss-Legendre"
        found = replace(found, evaluations=spent + more.evaluations)
    note = "" if found.converged else "the tolerance was not reached"
    return replace(found, method=method, note=note, seconds=time.perf_counter() - start)


def _rules(
    at: Callable[[Any, FloatArray], Any], cells: int, crowded: bool, most: int, deadline: float
) -> Iterator[RuleSum]:
    """Yield the sums of product rules of rising size; the first three share one call of the integrand."""
    sizes = CROWDED if crowded else PLAIN
    first = [_product(n) for n in sizes[:3]]
    points = np.concatenate([x for x, _ in first])
    cell = np.repeat(np.arange(cells), len(points))
    values = _checked(at, cell, np.tile(points, (cells, 1)))
    values = values.reshape(cells, len(points), *values.shape[1:])
    used, low = cells * len(points), 0
    size = np.abs(values).sum(axis=0)
    values = values.sum(axis=0)
    for x, w in first:
        part = slice(low, low + len(x))
        low += len(x)
        yield RuleSum(w @ values[part], w @ size[part], cells * len(x))
    for n in sizes[3:]:
        used += cells * n * n
        if used > most or time.perf_counter() > deadline:
            return
        x, w = _product(n)
        cell = np.repeat(np.arange(cells), len(x))
        numbered = np.column_stack([np.tile(x, (cells, 1)), cell])
        yield apply_rule(
            lambda p: at(p[:, 2].astype(np.intp), np.ascontiguousarray(p[:, :2])), numbered, np.tile(w, cells)
        )


def _checked(at: Callable[[Any, FloatArray], Any], cell: Any, x: FloatArray) -> FloatArray:
    """Return the values at points, in blocks, refusing those that are not finite."""
    parts = []
    for start in range(0, len(x), BLOCK):
        part = slice(start, start + BLOCK)
        values = np.asarray(at(cell[part], x[part]), dtype=float)
        if not np.all(np.isfinite(values)):
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            place = tuple(x[part][row].tolist())
            raise NonFiniteError(
                f"the integrand is {values[row]} at {place}", value=values[row], at=x[part][row].copy()
            )
        parts.append(values)
    return np.concatenate(parts)


def _product(n: int) -> tuple[FloatArray, FloatArray]:
    x, w = gauss_legendre(n)
    return np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2), np.outer(w, w).ravel()
