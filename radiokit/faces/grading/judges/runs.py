"""Runs: what an estimator of a submission gave for several inputs, numbers of samples and seeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from radiokit.faces.grading.finding import Callee, Finding
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.judges.given import drawn, number
from radiokit.faces.grading.judges.samplewords import line, slip, tell
from radiokit.faces.grading.russian import did
from radiokit.facts.errors import AssignmentError

__all__ = ["FLOOR", "SAME", "SEEDS", "Runs", "UnusableError", "described", "exact", "gather"]

FLOOR = 1e-4
"""A relative deviation below which everything is rounding, float32's sums included."""

SAME = 1e-9
"""The relative deviation that is let pass between two answers to the same question."""

QUADRUPLED = 4
SEEDS = 1 << 31
"""Seeds are drawn below this, so that any generator takes them."""


class UnusableError(Exception):
    """There are no numbers to judge; ``finding`` says why."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding.text)
        self.finding = finding


@dataclass(frozen=True)
class Runs:
    """Values and standard errors (G, R): G groups of inputs and number of samples, R seeds each.

    ``right`` and ``samples`` are (G,); ``inputs`` has the inputs of each group, two groups for each: at N and
    at 4 N samples, one after the other. ``seconds`` is the least wall time of one sample.
    """

    values: Array
    errors: Array
    right: Array
    samples: Array
    inputs: tuple[Mapping[str, Any], ...]
    seconds: float

    @cached_property
    def floor(self) -> Array:
        """What counts as rounding (G,)."""
        floor: Array = FLOOR * np.abs(self.right)
        return floor

    @cached_property
    def means(self) -> Array:
        """The mean of each group."""
        with np.errstate(all="ignore"):  # values may be of any size
            means: Array = self.values.mean(axis=1)
        return means

    @cached_property
    def variances(self) -> Array:
        """The variance between seeds of each group."""
        with np.errstate(all="ignore"):
            variances: Array = self.values.var(axis=1, ddof=1)
        return variances

    @cached_property
    def claimed(self) -> Array:
        """The mean square of the standard errors that each group was given."""
        with np.errstate(all="ignore"):
            claimed: Array = (self.errors**2).mean(axis=1)
        return claimed

    @cached_property
    def unsteadiness(self) -> Array:
        """The relative variance of the squared errors, at most 1: how little is known of their mean."""
        with np.errstate(all="ignore"):
            spread = self.errors**2
            found = spread.var(axis=1, ddof=1) / spread.mean(axis=1) ** 2
        steady: Array = np.clip(np.nan_to_num(found), 0.0, 1.0)
        return steady

    @property
    def noise(self) -> float:
        """The largest deviation of one sample, by the mean or what is right; may overflow."""
        with np.errstate(all="ignore"):
            size = np.maximum(np.abs(self.right), np.abs(self.means))
            found = np.sqrt(self.samples * self.variances) / size
        return float(found.max())

    @property
    def exact(self) -> bool:
        """Whether every value is right but for rounding, as with a zero-variance estimator."""
        return bool((np.abs(self.values - self.right[:, None]) <= self.floor[:, None]).all())

    @property
    def frozen(self) -> bool:
        """Whether the seed changes nothing."""
        return bool((np.ptp(self.values, axis=1) <= SAME * np.abs(self.values).max(axis=1)).all())

    @property
    def constant(self) -> bool:
        """Whether the inputs change nothing but noise, though what is right differs by far more."""
        noise = 4 * np.sqrt(self.variances / self.values.shape[1]).max()
        changes = np.ptp(self.means.reshape(-1, 2), axis=0).max()  # for each number of samples
        rounding = SAME * np.abs(self.means).max()
        return bool(changes <= noise + rounding and noise < np.ptp(self.right) / 4)

    def brief(self, group: int) -> str:
        """Return the inputs of a group in words."""
        numbers = {name: value for name, value in self.inputs[group].items() if np.ndim(value) == 0}
        return described({**numbers, "samples": int(self.samples[group])})


def described(numbers: Mapping[str, Any]) -> str:
    """Return inputs in words.

    >>> described({"albedo": 0.5, "samples": 64})
    'albedo = 0.5, samples = 64'
    """
    return ", ".join(
        f"{name} = {value if isinstance(value, int) else format(value, '.6g')}"
        for name, value in numbers.items()
    )


def gather(
    callee: Callee,
    rng: np.random.Generator,
    *,
    inputs: Callable[[np.random.Generator], Mapping[str, Any]],
    reference: Callable[..., Any],
    cases: int,
    samples: int,
    runs: int,
    language: str,
    hints: Mapping[str, Mapping[str, str]],
) -> Runs:
    """Call an estimator with all inputs and seeds, and the last seed of each input once more at the end.

    Raises
    ------
    UnusableError
        When it does not give two finite numbers each time, or gives others for the same seed.
    """
    given, rows, right, counts, again = [], [], [], [], []
    quickest = math.inf
    for _ in range(cases):
        chosen, truth = exact(inputs, reference, rng)
        for count in (samples, QUADRUPLED * samples):
            seeds = rng.integers(SEEDS, size=runs)
            pairs = []
            for seed in seeds.tolist():
                asked = (*chosen.values(), np.asarray(count), np.asarray(seed))
                result = callee.call(*asked, outputs=2)
                quickest = min(quickest, result.seconds / count)
                pairs.append(_pair(callee, result, {**chosen, "samples": count, "seed": seed}, language))
            again.append((asked, pairs[-1]))
            given.append(chosen)
            right.append(truth)
            counts.append(count)
            rows.append(pairs)
    values, errors = np.array(rows)[..., 0], np.array(rows)[..., 1]
    for asked, (value, error) in again:
        second, other = _pair(callee, callee.call(*asked, outputs=2), {}, language)
        if abs(second - value) > SAME * abs(value) or abs(other - error) > SAME * max(error, abs(value)):
            text = line(slip(language, "not-repeatable", hints))
            raise UnusableError(Finding(share=0.0, text=text, diagnosis="not-repeatable", confidence=1.0))
    return Runs(values, errors, np.array(right), np.array(counts), tuple(given), quickest)


def exact(
    inputs: Callable[[np.random.Generator], Mapping[str, Any]],
    reference: Callable[..., Any],
    rng: np.random.Generator,
) -> tuple[dict[str, Array], float]:
    """Return inputs and the exact value for them.

    Raises
    ------
    AssignmentError
        When the inputs are no numbers, or the value is none, infinite or 0.
    """
    found = drawn(inputs, rng, rows=False)
    value = number(reference, found)
    if not value:
        told = described({name: each for name, each in found.items() if not each.ndim})
        raise AssignmentError(
            f"reference gives 0 at {told or 'all inputs'}: errors are by its size, so that it must not"
        )
    return found, value


def _pair(callee: Callee, result: Result, inputs: Mapping[str, Any], language: str) -> tuple[float, float]:
    """Return a value and its standard error."""
    pair = line(tell(language, "pair", function=callee.name))
    if not result.ok and not result.raised and "are wanted" in result.error:
        raise UnusableError(Finding(share=0.0, text=pair))
    if not result.ok:
        raise UnusableError(Finding(share=0.0, text=did(language, callee.name, result.error)))
    numbers = [array for array in result.values if array.size == 1 and array.dtype.kind != "c"]
    if len(numbers) != 2 or len(result.values) != 2:
        raise UnusableError(Finding(share=0.0, text=pair))
    value, error = (float(array.reshape(())) for array in numbers)
    scalars = {name: np.asarray(given).item() for name, given in inputs.items() if np.ndim(given) == 0}
    told = {"value": f"{value:.6g}", "error": f"{error:.6g}", "inputs": described(scalars)}
    if not (math.isfinite(value) and math.isfinite(error)):
        text = line(tell(language, "not-a-number", **told))
        raise UnusableError(Finding(share=0.0, text=text, diagnosis="not-finite", confidence=1.0))
    if error < 0:
        raise UnusableError(Finding(share=0.0, text=line(tell(language, "negative-error", **told))))
    return value, error
