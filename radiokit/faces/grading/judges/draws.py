"""Draws: what a sampler of a submission does with random numbers, and what it says of their density."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from radiokit.checks.cells import CELLS, Cells
from radiokit.faces.grading.finding import Callee, Finding, Mode
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.directions import ABOVE
from radiokit.faces.grading.judges.runs import SAME, UnusableError
from radiokit.faces.grading.judges.samplewords import line, slip, tell
from radiokit.faces.grading.russian import did
from radiokit.faces.grading.words import say
from radiokit.facts.errors import ParameterError
from radiokit.measure.slope import find_lobe
from radiokit.measure.statistics import chi_square

__all__ = ["Draws", "Fit", "cells_of_density", "sampled", "u_slip"]

UNIT = 1e-5
"""How far from 1 a length may be, and from each other what should be the same: float32 is let pass."""

SECTORS = 16
"""Into how many the azimuths are cut, to see whether some never occur."""
NEAR, FAR, TORN = 1e-3, 0.2, 0.05
"""Points this near in the square may lie this far apart on the sphere in only this share of cases."""

SMOOTH, EDGED = 1e-4, 1e-2
"""By how much the integral of a density may seem off: before its cells are refined, and after that."""

REFINED = 1_000_000
"""Evaluations that refining may cost."""

Density = Callable[[Array], Array]


@dataclass
class Draws:
    """A sampler and its density, with further inputs, as they answer in the mode that suits them.

    ``quickest`` is the least wall time of a sample, of the best call [s].
    """

    callee: Callee
    pdf: str
    inputs: Mapping[str, Array]
    language: str
    quickest: float = math.inf
    modes: dict[str, Mode] = field(default_factory=dict)

    def sample(self, u: Array) -> Array:
        """Return directions (N, 3) of unit length.

        Raises
        ------
        UnusableError
            When they are not.
        """
        found = self._asked(self.callee, u, (len(u), 3))
        length = np.sqrt((found**2).sum(axis=1))
        off = np.abs(length - 1)
        if off.max() > UNIT:
            row = int(np.argmax(off))
            raise self._problem("not-unit", length=f"{length[row]:.4g}", inputs=_u(u[row]))
        return found

    def claimed(self, directions: Array) -> Array:
        """Return the density (N,) that is claimed, whatever it is."""
        return self._asked(self.callee.other(self.pdf), directions, (len(directions),))

    def density(self, directions: Array) -> Array:
        """Return the density that is claimed; ``UnusableError`` where it is negative."""
        found = self.claimed(directions)
        if (found < 0).any():
            raise self._problem("density-negative", function=self.pdf)
        return found

    def _asked(self, callee: Callee, given: Array, shape: tuple[int, ...]) -> Array:
        name, problem = callee.name, None
        modes: tuple[Mode, ...] = (self.modes[name],) if name in self.modes else ("batch", "scalar")
        for mode in modes:
            result = callee.call(given, *self.inputs.values(), mode=mode)
            if callee is self.callee:
                self.quickest = min(self.quickest, result.seconds / len(given))
            if not result.ok:
                text = did(self.language, name, result.error)
                if result.error.startswith("defines no function"):
                    text = line(say(self.language, "no-function", function=name, guess=""))
                problem = problem or UnusableError(Finding(share=0.0, text=text))
                continue
            answer = result.values[0]
            right = (
                len(result.values) == 1 and answer.dtype.kind in "fiub" and answer.size == math.prod(shape)
            )
            if not right or (len(shape) == 2 and answer.shape[-1] != 3):
                got = ", ".join(str(value.shape) for value in result.values)
                said = self._problem("directions-shape", function=name, shape=got, expected=shape)
                problem = said if mode == "batch" else problem
                continue
            self.modes[name] = mode
            found: Array = answer.astype(float).reshape(shape)
            bad = ~np.isfinite(found.reshape(len(given), -1)).all(axis=1)
            if bad.any():
                where = _u(given[np.argmax(bad)])
                count = {"bad": int(bad.sum()), "count": len(given)}
                said = self._problem("directions-finite", function=name, inputs=where, **count)
                said.finding = Finding(
                    share=0.0, text=said.finding.text, diagnosis="not-finite", confidence=1.0
                )
                raise said
            return found
        assert problem is not None
        raise problem

    def _problem(self, key: str, **values: Any) -> UnusableError:
        return UnusableError(Finding(share=0.0, text=line(tell(self.language, key, **values))))


def _u(row: Array) -> str:
    return "(" + ", ".join(f"{each:.6g}" for each in row.tolist()) + ")"


def cells_of_density(density: Density) -> Cells:
    """Return cells of the hemisphere that are fine where a density is large.

    >>> shares, _ = cells_of_density(lambda w: w[:, 2] / np.pi).shares()
    >>> round(float(shares.sum()), 12)
    1.0
    """
    lobe = find_lobe(density, ABOVE, around=(False,))
    return Cells(density, ABOVE, lobe.width, lobe.retro)


@dataclass(frozen=True)
class Fit:
    """Directions (N, 3) above the horizon, counted in the cells that suit a density."""

    TESTS: ClassVar[Mapping[str, tuple[int, ...]]] = {"cells": (), "radii": (0, 2), "azimuths": (1,)}
    """The tests, by the axes of side, radius and azimuth over which cells are joined."""

    cells: Cells
    directions: Array
    total: int

    @cached_property
    def counts(self) -> Array:
        """How many directions each cell holds, and at last how many are in none."""
        found = self.cells.counts(self.directions)
        return np.append(found, self.total - found.sum())

    def p_values(self, density: Density | None = None) -> dict[str, float]:
        """Return the p-values of chi-square tests over all cells, over radii, and over azimuths.

        Few wide cells show a small and smooth difference that many do not. ``density`` is another than that
        of the cells.
        """
        expected = self._expected(density)
        expected *= self.total / expected.sum()
        return {
            name: chi_square(_joined(self.counts, axis), _joined(expected, axis)).p_value
            for name, axis in self.TESTS.items()
        }

    def never(self) -> float:
        """Return the share of the density in cells that hold no direction, though ten are expected."""
        expected = self._expected(None)
        empty = (self.counts == 0) & (expected > 10)
        return float(expected[empty].sum() / self.total)

    def lacks_azimuths(self) -> bool:
        """Return whether whole sectors about the normal hold no direction."""
        x, y = self.directions[:, 0], self.directions[:, 1]
        found = np.histogram(np.arctan2(y, x), bins=SECTORS, range=(-np.pi, np.pi))[0]
        return bool((found == 0).any())

    def _expected(self, density: Density | None) -> Array:
        cells = self.cells
        if density is not None:
            cells = Cells(density, cells.aim, cells.width, cells.retro)
        shares = cells.shares()[0]
        rest = 1 - float(shares.sum())
        if density is None and abs(rest) > SMOOTH:  # an edge runs through cells: the samples show where
            shares = cells.refined(self.directions, self.total, REFINED).shares
            rest = 1 - float(shares.sum())
            if abs(rest) > EDGED:
                raise ParameterError("density", f"{1 - rest:.4g}", "of the integral 1 over the hemisphere")
        # What a smooth density leaves is rounding; that of no density at all must not divide by 0.
        return (
            np.append(np.maximum(shares, 0.0), rest if rest > SMOOTH and density is not None else 0.0)
            * self.total
            + 1e-12
        )


def _joined(cells: Array, axis: tuple[int, ...]) -> Array:
    """Return the sums over axes of the cells, with the rest that is in none."""
    square: Array = cells[:-1].reshape(2, *CELLS)
    return np.append(square.sum(axis=axis), cells[-1])


def u_slip(draws: Draws, u: Array, directions: Array, rng: np.random.Generator) -> str:
    """Return the name of what a sampler does wrong with its random numbers, whatever it samples; or none.

    ``"rows-mixed"``: a direction depends on other rows, or on what is not u; ``"u-unused"``: on one number of
    the two alone; ``"u-torn"``: nearby numbers give directions far apart.
    """
    few = rng.permutation(len(u))[: min(512, len(u))]
    if np.abs(draws.sample(u[few]) - directions[few]).max() > UNIT:
        return "rows-mixed"
    fresh = rng.random((len(few), 2))
    for column in (0, 1):
        changed = u[few].copy()
        changed[:, column] = fresh[:, column]
        moved = np.abs(draws.sample(changed) - directions[few]).max(axis=1)
        if moved.max() <= SAME:
            return "u-unused"
    step = NEAR * (2 * rng.random((len(few), 2)) - 1)
    near = draws.sample(np.clip(u[few] + step, 1e-9, 1 - 1e-9))
    apart = np.sqrt(((near - directions[few]) ** 2).sum(axis=1))
    return "u-torn" if np.mean(apart > FAR) > TORN else ""


def sampled(draws: Draws, cells: Cells, u: Array, hints: Mapping[str, Mapping[str, str]]) -> Fit:
    """Return where the directions for u are, or say that they are below the horizon.

    Raises
    ------
    UnusableError
        When they are.
    """
    directions = draws.sample(u)
    below = directions[:, 2] < -UNIT
    if below.any():
        told = tell(draws.language, "below", bad=int(below.sum()), count=len(u))
        why = line(slip(draws.language, "below", hints), told) if "below" in hints else line(told)
        raise UnusableError(Finding(share=0.0, text=why, diagnosis="below", confidence=1.0))
    lifted = np.column_stack([directions[:, :2], np.maximum(directions[:, 2], 1e-12)])
    return Fit(cells, lifted, len(u))
