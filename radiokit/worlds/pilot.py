"""Pilot: what each method would cost for a term, foretold in order of magnitude from a few evaluations."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from radiokit.facts.jsonable import jsonable
from radiokit.measure import lowdiscrepancy
from radiokit.measure.lattice import kronecker
from radiokit.worlds.budget import Budget
from radiokit.worlds.integral import GUARD, expected_peaks, lobe_angle, product_of, whole_lobe
from radiokit.worlds.lookout import Lookout, look
from radiokit.worlds.sampling import BLOCK, ZENITH, Sampler, best_sampling
from radiokit.worlds.terms import DELTA_LIGHT, DELTA_LOBES, MAX_SAMPLES, Term

__all__ = ["Cost", "Pilot", "foretell"]

PILOT = 512
"""Lattice samples from which a variance is foretold."""

LATTICES = (512, 2048)
"""Low-discrepancy samples from which the fall of their error is foretold."""

PER_EVALUATION, PER_CALL, PER_SUM = 3e-7, 2e-3, 2e-4
"""What an evaluation takes, a quadrature over a piece of a light before any, and a sum or closed form [s]."""

FIRST_RULES, CROWDED_RULES = 464, 532
"""Evaluations of the first three rules in a plain square, and in each part of one cut at a peak."""

DOME = 4500
"""Evaluations under a dome."""


@dataclass(frozen=True)
class Cost:
    """What a method is expected to take for a tolerance: all of it in order of magnitude.

    ``evaluations`` of the material and ``seconds`` [s] are what the tolerance needs, ``spent`` is how many
    evaluations the limits of the call allow of them, and ``error`` the relative error that is then reached;
    None where it is that of rounding.
    """

    method: str
    evaluations: float
    seconds: float
    error: float | None = None
    spent: float = 0.0

    @property
    def limited(self) -> Cost:
        """What the method takes within the limits of the call."""
        seconds = self.seconds * (self.spent / self.evaluations if self.evaluations > 0 else 1.0)
        return replace(self, evaluations=self.spent, seconds=max(seconds, min(self.seconds, PER_CALL)))

    def to_json(self) -> dict[str, Any]:
        """Return the cost as JSON-ready data."""
        return {name: jsonable(getattr(self, name)) for name in self.__dataclass_fields__}

    def __str__(self) -> str:
        if not math.isfinite(self.evaluations):
            return "no sample sees any light, so that it does not stop before its limit"
        count = f"{self.evaluations:.0f}" if self.evaluations < 1e6 else f"{self.evaluations:.0e}"
        text = f"about {count} evaluations, {_duration(self.seconds)}"
        return text if self.error is None else f"{text}, reaching ± {self.error:.0e}"


def _duration(seconds: float) -> str:
    """Return a time with one digit.

    >>> _duration(2e-4), _duration(0.021), _duration(7200.0)
    ('0.2 ms', '20 ms', '2 h')
    """
    for size, unit in ((86400.0, "d"), (3600.0, "h"), (1.0, "s")):
        if seconds >= size:
            return f"{_one_digit(seconds / size)} {unit}"
    return f"{_one_digit(1e3 * seconds)} ms"


def _one_digit(value: float) -> str:
    if not 0 < value < math.inf:
        return f"{value:g}"
    return f"{float(f'{value:.0e}'):g}"


@dataclass(frozen=True)
class Pilot:
    """A term, and what a quadrature sees in the pieces of its light."""

    term: Term
    rtol: float
    bounded: bool

    @cached_property
    def within(self) -> bool:
        """Whether the lobe lies within a finite light and is integrated in slope coordinates."""
        return not self.bounded and whole_lobe(self.term, self.rtol) is not None

    @cached_property
    def lookouts(self) -> list[Lookout]:
        """What is seen in the squares of a finite light's pieces."""
        term, receiver = self.term, self.term.receiver
        product, towards = product_of(term), expected_peaks(term)
        return [
            look(piece, receiver, product(piece), width=lobe_angle(term), towards=towards)
            for piece in term.light.pieces(receiver.origin, receiver.axis) or ()
        ]


def foretell(
    pilot: Pilot, method: str, rtol: float, samples: int | None, budget: Budget, seconds: float | None
) -> Cost:
    """Return what a method is expected to take, and to reach within the limits."""
    term = pilot.term
    if method == "sum":
        count = len(term.lobes) if term.part == DELTA_LOBES else 0
        if term.part == DELTA_LIGHT and not term.only_delta:
            count = len(term.light.incident(term.receiver.origin)[0])
        return Cost(method, count, PER_SUM, spent=count)
    if method == "closed form":
        return Cost(method, 0, PER_SUM)
    if method == "quadrature":
        return _quadrature(pilot, rtol, budget, seconds)
    strategy = best_sampling(term) if method == "qmc" else method
    each = 2 if strategy == "mis" else 1
    law = _even if method == "qmc" else _random
    needed, error_of = law(Sampler(term, strategy), rtol)
    most = budget.samples(strategy, samples, MAX_SAMPLES)
    limit = math.inf if most is None else float(most)
    if seconds is not None:
        limit = min(limit, seconds / (each * PER_EVALUATION))
    if method == "qmc" and math.isfinite(limit):
        limit = lowdiscrepancy.lattice_samples(int(max(limit, lowdiscrepancy.REPLICATES)))
    if samples is not None:
        needed = limit
    drawn = max(1.0, min(needed, limit))
    seconds = each * needed * PER_EVALUATION + PER_CALL
    return Cost(method, each * needed, seconds, error_of(drawn), each * drawn)


def _random(sampler: Sampler, rtol: float) -> tuple[float, Callable[[float], float]]:
    """Return the random samples that a tolerance needs, and the relative error of a number of them."""
    values = sampler(kronecker(PILOT, sampler.dimensions))
    by_material, by_light, _ = sampler.foretold(PILOT)
    variance = np.maximum(np.maximum(by_material, by_light), values.var(axis=0))
    mean = np.abs(values.mean(axis=0))
    ratio = _ratio(np.sqrt(variance), mean)
    if not np.any(mean):  # nothing is seen: sampling does not stop before its limit
        return math.inf, lambda count: ratio and math.inf
    needed = (ratio / rtol) ** 2
    if math.isfinite(needed):  # the error is looked at after 1, 2, 4, ... blocks
        needed = BLOCK * 2.0 ** math.ceil(math.log2(max(needed / BLOCK, 1.0)))
    return needed, lambda count: ratio / math.sqrt(count)


def _even(sampler: Sampler, rtol: float) -> tuple[float, Callable[[float], float]]:
    """Return the same for low-discrepancy samples, whose error falls as a power between −1/2 and −3/2."""
    found = [
        lowdiscrepancy.mean(
            sampler.stepped if sampler.edged else sampler,
            dimensions=sampler.dimensions,
            samples=n,
            rng=0,
            stepped=sampler.edged,
        )
        for n in LATTICES
    ]
    ratios = [_ratio(each.error, each.value) for each in found]
    if not np.any(found[-1].value):
        return math.inf, lambda count: ratios[-1]
    if not all(0 < ratio < math.inf for ratio in ratios):
        return 1024.0, lambda count: ratios[-1]
    rate = float(np.clip(math.log(ratios[0] / ratios[1]) / math.log(LATTICES[1] / LATTICES[0]), 0.5, 1.5))
    needed = LATTICES[1] * (ratios[1] / rtol) ** (1 / rate)
    # It must hold at two lattices in a row, each twice as large as the one before.
    needed = 2.0 ** math.ceil(math.log2(max(2 * needed, 1024.0)))
    return needed, lambda count: ratios[1] * (LATTICES[1] / count) ** rate


def _ratio(error: Any, value: Any) -> float:
    """Return the largest relative error: 0 where there is none, infinite where there is but no value."""
    error, value = np.asarray(error), np.abs(value)
    share = np.divide(error, value, out=np.full(np.shape(error), np.inf), where=value > 0)
    return float(np.max(np.where(error > 0, share, 0.0)))


def _quadrature(pilot: Pilot, rtol: float, budget: Budget, seconds: float | None) -> Cost:
    """Return what a quadrature takes, by the lobe's width, the light's size, and what bends in between."""
    needed, pieces = _rules(pilot, rtol)
    limits = [math.inf] if budget.evaluations is None else [float(budget.evaluations)]
    limits += [] if seconds is None else [seconds / PER_EVALUATION]
    error = rtol if needed <= min(limits) else min(1.0, rtol * (needed / max(min(limits), 1.0)) ** 2)
    taken = pieces * PER_CALL + needed * PER_EVALUATION
    return Cost("quadrature", needed, taken, error, min(needed, *limits))


def _rules(pilot: Pilot, rtol: float) -> tuple[float, int]:
    """Return the evaluations that the tolerance needs, and over how many pieces."""
    term = pilot.term
    dome = term.light.dome(term.receiver.origin)
    if dome is not None and any(float(zenith @ term.receiver.axis) < -ZENITH for zenith in dome):
        return 1.0, 1
    if dome is not None or pilot.within:
        return float(DOME if term.f.smooth else 2 * DOME) * (1 if rtol >= 1e-7 else 4), 1
    seen = pilot.lookouts
    if not seen:
        return 1.0, 1
    return 2.0 * GUARD + sum(_in_square(each, term.f.smooth, rtol) for each in seen), len(seen)


def _in_square(seen: Lookout, smooth: bool, rtol: float) -> float:
    """Return the evaluations in the square of one piece."""
    if seen.kinks:  # refinement along a curve: the error falls as the square of the evaluations or so
        return seen.evaluations + 6000.0 * (1e-2 / rtol) ** 0.35
    parts = 4 ** len(seen.foci)
    first = parts * (CROWDED_RULES if seen.foci else FIRST_RULES)
    finer = 1.0 if rtol >= 1e-5 else 2.0
    if not smooth:
        finer = 2.0 * max(1e-3 / rtol, 1.0) ** 0.25
    return seen.evaluations + first * finer
