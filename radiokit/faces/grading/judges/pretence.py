"""Pretence: shows an estimate to be known and made noisy, or of more samples than it was asked for.

Either looks right from its answers at N samples. What gives it away is one seed asked for several answers,
and one sample alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.finding import Callee
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.judges.given import NUMBERS
from radiokit.faces.grading.judges.runs import SAME, SEEDS, Runs
from radiokit.faces.grading.judges.runtests import ROUNDS
from radiokit.faces.grading.judges.samplewords import tell

__all__ = ["in_step", "invented", "overdrawn", "pretence"]

TWINS, PAIRED = 5, 64
"""Seeds that are asked for several answers, of which two always agree, and the samples of each.

What is in step counts when it is so in each of ``ROUNDS``, with other seeds: random deviations are with
a chance of 1e-10 in one, those of few hits more often.
"""

STEP, ROUNDED = 1e-5, 2e-7
"""How far deviations may be out of step: by a part of the largest, and by a part of the value (float32).

Samples of a right estimator are out of step by far more: by 0.7 of the deviations where 2 N samples begin
with the same N, and by some 1/N where both are grids that are shifted alike. Such grids may be in step for
some inputs at N and 2 N, but 1 : √2 is no ratio of theirs."""

LEAST = 1e-3
"""The part of the value from which a deviation is more than rounding."""

FEW, MANY = 3, 256
"""Seeds for one sample: at first, and for each input where it has a standard error."""

ALONE = 1e-3
"""The standard error of one sample, by its value, that is nothing but rounding."""

NEAR, SCATTER = math.log(4.0), 0.002
"""How far the errors' squares may be from the variance, and the least part of them that chance decides."""

EVEN, ABOUT = math.log(1.4), math.log(2.0)
"""How far the variance of one sample may be from what 64 give, and from what many more give.

The former is off by 2 for N + 1 samples instead of N, some five times its error, and by more for grids."""


def pretence(
    callee: Callee, rng: np.random.Generator, runs: Runs, *, alike: bool, counted: bool, language: str
) -> tuple[str, str]:
    """Return the name of what right answers pretend, and how that shows; or empty texts.

    ``counted`` is whether it matters how many samples there are.
    """
    with np.errstate(all="ignore"):  # values may be of any size
        for _ in range(ROUNDS):
            step = invented(callee, rng, runs, alike=alike)
            if not step:
                break
        else:
            return "noise-invented", tell(language, f"step-{step}", samples=PAIRED, more=2 * PAIRED)
        return "too-many-samples" if counted and overdrawn(callee, rng, runs) else "", ""


def invented(callee: Callee, rng: np.random.Generator, runs: Runs, *, alike: bool) -> str:
    """Return how deviations are in step, ``"samples"`` or ``"inputs"``, as no mean of samples is; or nothing.

    A known value with noise v + σ z/√N has the same z for the same seed: at N and 2 N samples it deviates in
    the ratio √2 whatever the seed. Where z changes with N, it is still the same for all inputs at one N; so
    may be what samples deviate by, unless inputs change the integrand's shape: ``alike`` says whether.
    """
    seeds = rng.integers(SEEDS, size=TWINS)

    def values(group: int, count: int) -> Array:
        return _answers(callee, runs, group, count, seeds)[:, 0]

    first, second = values(0, PAIRED), values(0, 2 * PAIRED)
    for ratio in (1 / 2, (PAIRED - 1) / (2 * PAIRED - 1)):  # σ/√N, and σ/√(N − 1)
        if in_step(first, second, math.sqrt(ratio)):
            return "samples"
    others = range(2, 0 if alike else len(runs.right), 2)
    unlike = [group for group in others if not _same(runs.inputs[0], runs.inputs[group])]
    return "inputs" if unlike and all(in_step(first, values(group, PAIRED)) for group in unlike) else ""


def _same(first: Mapping[str, Any], second: Mapping[str, Any]) -> bool:
    return all(np.array_equal(first[name], second[name]) for name in first)


def in_step(first: Array, second: Array, ratio: float | None = None) -> bool:
    """Return whether deviations, all different and more than rounding, are in a ratio, or in any.

    >>> z = np.array([0.3, -1.2, 0.4, 0.9])
    >>> in_step(1 + z, 5 + 0.5 * z), in_step(1 + z, 5 + 0.5 * z, 2.0), in_step(1 + z, 5 + z**2)
    (True, False, False)
    """
    x, y = first - first.mean(), second - second.mean()
    size, largest = abs(float(second.mean())), float(np.abs(y).max())
    if not largest > LEAST * size or len(np.unique(first)) < len(first):  # NaN included
        return False
    ratio = float(x @ y / (x @ x)) if ratio is None else ratio
    rounded = ROUNDED * (size + abs(ratio) * abs(float(first.mean())))
    return bool(np.abs(y - ratio * x).max() <= STEP * largest + rounded)


def overdrawn(callee: Callee, rng: np.random.Generator, runs: Runs) -> bool:
    """Return whether more samples are drawn than asked for, by any factor.

    One sample has no spread: its standard error is 0, or no number, or some convention that follows from its
    value. One that is right, and is no function of the value, comes of more. This is so for any sampling and
    any integrand, and there is no chance in it for a function that gives one sample no error.

    It tells nothing where one and two samples give the same, as with a least number of points, or where the
    variance of one sample differs between few and many, as it does with strata, grids and a sample too many.
    """
    seeds = rng.integers(SEEDS, size=FEW)
    one, error = _answers(callee, runs, 0, 1, seeds).T
    if not (error > ALONE * np.abs(one)).any() or (runs.variances <= runs.floor**2).any():
        return False
    two = _answers(callee, runs, 0, 2, seeds)[:, 0]
    if not np.isfinite(two).all() or (np.abs(one - two) <= SAME * np.abs(one)).all():
        return False
    far = np.log(runs.samples * runs.variances).reshape(-1, 2).mean(axis=1)
    groups = range(0, len(runs.right), 2)
    few = [_answers(callee, runs, group, 1, rng.integers(SEEDS, size=MANY)).T for group in groups]
    if not all(np.isfinite(values).all() and np.ptp(values) > 0 for values, _ in few):
        return False
    variance = np.log([values.var(ddof=1) for values, _ in few])
    claimed = np.log([np.mean(errors**2) for _, errors in few])
    scatter = [_scatter(errors, values) for values, errors in few]
    fits = abs(np.mean(claimed - variance)) <= NEAR and abs(np.mean(far - variance)) <= ABOUT
    if not fits or np.mean(scatter) <= SCATTER:
        return False
    many = [_answers(callee, runs, group, PAIRED, rng.integers(SEEDS, size=MANY))[:, 0] for group in groups]
    near = np.log([PAIRED * values.var(ddof=1) for values in many])
    return bool(abs(np.mean(near - variance)) <= EVEN)


def _scatter(errors: Array, values: Array) -> float:
    """Return what part of the variance of the errors' ranks is between neighbours in value; 0 for a function.

    Source: Bartels (1982), The rank version of von Neumann's ratio test for randomness, Journal of the
    American Statistical Association 77(377).
    """
    ranks = np.searchsorted(np.sort(errors), errors)[np.argsort(values)]
    return float(np.mean(np.diff(ranks) ** 2) / max(2 * np.var(ranks), 1.0))


def _answers(callee: Callee, runs: Runs, group: int, count: int, seeds: Array) -> Array:
    """Return values and standard errors (S, 2) for seeds; NaN where there is none, or where any raises."""
    given = (*runs.inputs[group].values(), np.asarray(count))
    if any(array.ndim for array in given):  # whose rows would be taken for the seeds' own
        return np.concatenate([_pairs(callee.call(*given, seed, outputs=2), 1) for seed in seeds])
    return _pairs(callee.call(*given, seeds, mode="scalar", outputs=2), len(seeds))


def _pairs(result: Result, count: int) -> Array:
    found = np.full((count, 2), math.nan)
    if len(result.values) == 2 and all(
        each.size == count and each.dtype.kind in NUMBERS for each in result.values
    ):
        found[:] = np.stack([each.reshape(count) for each in result.values], axis=-1)
        found[~(np.isfinite(found).all(axis=1) & (found[:, 1] >= 0))] = math.nan
    return found
