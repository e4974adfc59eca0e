"""Run tests: p-values of what the runs of an estimator should be, and names for what they are instead."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.runs import Runs

__all__ = [
    "LEVEL",
    "ROUNDS",
    "bias",
    "claims",
    "each_level",
    "error_slip",
    "excess",
    "honest",
    "rate",
    "rate_slip",
    "settled",
]

LEVEL = 1e-6 / 16
"""The probability that one judge rejects a right function: sixteen of them reject one in 1e6 gradings."""

ROUNDS = 3
"""How often a test must fail, each time with other seeds, before it counts.

So each needs a level of only ``each_level``, near 0.002, where Student's and χ² distributions hold for what
is not normal; at 1e-7 they would not."""

MOST = 2 * ROUNDS
"""How many rounds there are at most.

A function is right by one round in which no test fails. What fails one test here and another there fails none
in each, but may tell the rounds apart and be right in none; a right function does so in all of these rounds
less often than `LEVEL`."""


def settled(rounds: Sequence[set[str]]) -> set[str]:
    """Return what tells that a function is wrong, from the tests that failed in each round; or nothing yet.

    >>> settled([{"bias"}, {"bias", "rate"}]), settled([{"bias"}, {"bias", "rate"}, {"bias"}])
    (set(), {'bias'})
    """
    if len(rounds) < ROUNDS:
        return set()
    return set.intersection(*rounds) or (rounds[-1] if len(rounds) == MOST else set())


def each_level(tests: int) -> float:
    """Return the level of each of ``tests`` tests in each round.

    >>> round(each_level(3), 5)
    0.00275
    """
    return float((LEVEL / tests) ** (1 / ROUNDS))


def bias(runs: Runs) -> tuple[float, float]:
    """Return the p-values that no group is biased, and that they are not all together (Stouffer's sum)."""
    from scipy.special import ndtri, stdtr

    count = runs.values.shape[1]
    off = runs.means - runs.right
    off = np.sign(off) * np.maximum(np.abs(off) - runs.floor, 0.0)
    error = np.sqrt(runs.variances / count)
    with np.errstate(all="ignore"):
        t = np.where(off == 0, 0.0, off / error)
    tails = np.maximum(stdtr(count - 1, -np.abs(t)), 1e-300)
    scores = -np.sign(t) * ndtri(tails)
    # A relative bias stands out by √N.
    together = float(np.sqrt(runs.samples) @ scores / math.sqrt(runs.samples.sum()))
    return min(1.0, 2 * float(tails.min()) * len(t)), math.erfc(abs(together) / math.sqrt(2))


def steady(runs: Runs) -> tuple[Array, float, float]:
    """Return the logarithms of the groups' variances without the bias of few runs, and their variance.

    The latter is that of normal runs, and what heavy tails add: as the runs' kurtosis shows it, or the
    unsteadiness of the standard errors, whichever is more.

    Source: Bartlett, Kendall (1946), The statistical analysis of variance-heterogeneity and the logarithmic
    transformation, Supplement to the Journal of the Royal Statistical Society 8(1).
    """
    from scipy.special import polygamma, psi

    count = runs.values.shape[1]
    dof = count - 1
    bias = float(psi(dof / 2) - math.log(dof / 2))
    residuals = runs.values - runs.means[:, None]
    with np.errstate(all="ignore"):
        scaled = np.nan_to_num(residuals / np.sqrt(runs.variances)[:, None])
    kurtosis = max(0.0, float(np.mean(scaled**4)) - 3)
    logs: Array = np.log(runs.variances + (runs.floor / 10) ** 2 + 1e-300) - bias
    tails = max(kurtosis, float(runs.unsteadiness.mean()))
    return logs, float(polygamma(1, dof / 2)), tails / count


def rate(runs: Runs) -> float:
    """Return the p-value that quadrupling the samples divides the variance by 4 or more."""
    logs, normal, extra = steady(runs)
    gain = logs[0::2] - logs[1::2] - math.log(4)
    gain = np.where(runs.variances[1::2] <= runs.floor[1::2] ** 2, 0.0, gain)
    score = float(gain.sum()) / math.sqrt(2 * len(gain) * (normal + extra))
    return 0.5 * math.erfc(-score / math.sqrt(2)) if score < 0 else 1.0


def claims(runs: Runs) -> tuple[Array, Array]:
    """Return the logarithm of the ratio of claimed to true variance for each group, and its variance."""
    logs, normal, _ = steady(runs)
    claimed = np.log(runs.claimed + (runs.floor / 10) ** 2 + 1e-300)
    return claimed - logs, normal + 2 * runs.unsteadiness / runs.values.shape[1]


def honest(runs: Runs, groups: slice) -> float:
    """Return the p-value that the standard errors are the spread between seeds."""
    ratios, spread = (array[groups] for array in claims(runs))
    rounding = (runs.variances <= runs.floor**2) & (runs.claimed <= runs.floor**2)
    ratios = np.where(rounding[groups], 0.0, ratios)
    return math.erfc(abs(float(ratios.sum())) / math.sqrt(2 * float(spread.sum())))


def excess(runs: Runs, budget: Array) -> float:
    """Return the p-value that the variance of one sample is at most the budget."""
    logs, normal, extra = steady(runs)
    over = logs + np.log(runs.samples) - np.log(budget)
    score = float(over.sum()) / math.sqrt(len(over) * (normal + extra))
    return 0.5 * math.erfc(score / math.sqrt(2)) if score > 0 else 1.0


def error_slip(runs: Runs) -> str:
    """Return the name of what was given for the standard error."""
    ratios, spread = claims(runs)
    if (runs.errors <= 1e-3 * runs.floor[:, None]).all():
        repeated = rate(runs) < each_level(1) and rate_slip(runs) == "sample-repeated"
        return "sample-repeated" if repeated else "error-zero"
    count, variance = np.log(runs.samples), steady(runs)[0]
    known = {  # the ratio's logarithm, and how often the variance between seeds is in the misfit
        "deviation-for-error": (count, 1),
        "error-of-sum": (2 * count, 1),
        "error-divided-by-samples": (-count, 1),
        "variance-for-error": (variance, 2),
        "sample-variance-for-error": (variance + 2 * count, 2),
        "interval-for-error": (np.full_like(count, 2 * math.log(1.96)), 1),
    }
    misfit = {
        name: float(np.sum((ratios - log) ** 2 / (times**2 * spread))) for name, (log, times) in known.items()
    }
    best = min(misfit, key=lambda name: misfit[name])
    if misfit[best] < 4 * len(ratios):
        return best
    return "error-too-large" if ratios.sum() > 0 else "error-too-small"


def swapped(runs: Runs) -> bool:
    """Return whether the standard errors are what the values should be, and the values are not."""
    if runs.exact:
        return False
    means, spread = runs.errors.mean(axis=1), runs.errors.std(axis=1)
    near = 5 * spread / math.sqrt(runs.errors.shape[1]) + runs.floor
    return bool((np.abs(means - runs.right) <= near).all() and (spread < np.abs(means) / 2).all())


def rate_slip(runs: Runs) -> str:
    """Return why the error does not fall as 1/√N."""
    logs, normal, extra = steady(runs)
    gain = logs[0::2] - logs[1::2]
    score = float(gain.sum()) / math.sqrt(2 * len(gain) * (normal + extra))
    if abs(score) > 2.5:
        return "error-not-falling"
    claimed = runs.claimed <= 1e-6 * runs.variances
    return "sample-repeated" if claimed.all() else "samples-ignored"
