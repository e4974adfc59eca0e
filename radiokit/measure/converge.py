"""Converge: compare ever finer rules until their differences bound the error, or refine adaptively."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import NonFiniteError
from radiokit.facts.estimate import Estimate

__all__ = [
    "BLOCK",
    "FORGETFUL",
    "GK21",
    "MEMORY",
    "ROUNDING",
    "Integrand",
    "RuleSum",
    "adaptive",
    "apply_rule",
    "converge",
]

FloatArray = npt.NDArray[np.float64]
Integrand = Callable[[FloatArray], Any]

SAFETY = 3.0
"""Factor on the difference of two rules; the coarser one errs far more than the finer one."""

MEMORY = (0.0, 0.25, 0.75)
"""Powers of the last three relative differences, by which the older ones weigh: d, d^1.25, d^1.75."""

FORGETFUL = (0.0, 1.0, 3.0)
"""The same for smooth lobes seen in their own coordinates: differences about square from rule to rule."""

SMOOTH = 1e-5
"""Relative agreement that rules for a smooth integrand reach and others reach only by a rare chance."""

ROUNDING = 64 * float(np.finfo(float).eps)
"""Rounding of a weighted sum, relative to the sum of absolute terms; 21 eps is the most seen."""

BLOCK = 1 << 16
"""Points in one call of an integrand, so that its temporaries stay in cache."""

GK21 = 2 * 21 * 21 * 4  # points of a subdivision of SciPy's cubature in two dimensions: value and error


@dataclass(frozen=True)
class RuleSum:
    """What one rule gave: the sum, the sum of absolute terms, and the points used."""

    value: Any
    size: Any
    points: int


def apply_rule(integrand: Integrand, points: FloatArray, weight: FloatArray) -> RuleSum:
    """Sum weighted values in blocks, refusing values that are not finite."""
    value: Any = 0.0
    size: Any = 0.0
    for start in range(0, len(points), BLOCK):
        part = points[start : start + BLOCK]
        found = np.asarray(integrand(part), dtype=float)
        if not np.all(np.isfinite(found)):
            row = int(np.argwhere(~np.isfinite(found))[0][0])
            raise NonFiniteError(
                f"the integrand is {found[row]} at {tuple(part[row].tolist())}",
                value=found[row],
                at=part[row].copy(),
            )
        w = weight[start : start + BLOCK]
        value = value + _weighted(w, found)
        size = size + _weighted(w, np.abs(found))
    return RuleSum(value, size, len(points))


def _weighted(weight: FloatArray, values: FloatArray) -> Any:
    """Return Σ weight · values over the rows, in pairs.

    A matrix product's sum depends on the number of its threads, which also wait for each other by spinning:
    processes that share a machine then take twice the time.
    """
    return np.multiply(values.T, weight, order="C").sum(axis=-1)


def converge(
    rules: Iterable[RuleSum],
    rtol: float,
    atol: float,
    *,
    smooth: bool = False,
    rounding: float = ROUNDING,
    memory: tuple[float, ...] = MEMORY,
) -> Estimate:
    """Go through ever finer rules until their differences bound the error as asked.

    Rules for a smooth integrand agree ever better, each difference a small power of the one before, and
    soon agree to ``SMOOTH``; rules for an integrand with jumps or kinks agree now and then by chance, but
    hardly ever so well. Only agreement to ``SMOOTH`` or better is believed. Without it the error is the
    spread of the last four values, and no less than one row of nodes' share of the whole. All this is left
    out when the integrand is known to be ``smooth``. ``rounding`` is relative to the sum of absolute terms;
    ``memory`` says by which powers of the last differences the older ones count.
    """
    start = time.perf_counter()
    values: list[Any] = []
    evaluations, converged = 0, False
    error: Any = np.inf
    for found in rules:
        evaluations += found.points
        values.append(found.value)
        if len(values) < 3:
            continue
        error = SAFETY * _credible(values, found.size, memory) + rounding * found.size
        if smooth:
            enough = np.maximum(atol, rtol * np.abs(found.value))
        else:
            enough = np.maximum(min(atol, SMOOTH), min(rtol, SMOOTH) * found.size)
        converged = bool(np.all(error <= enough))
        if converged:
            break
        if not smooth:
            error = np.maximum(error, _doubtful(values, found))
    if not converged and len(values) > 2:
        converged = bool(np.all(error <= np.maximum(atol, rtol * np.abs(values[-1]))))
    if np.isnan(error).any():  # sums that overflow
        error = np.where(np.isnan(error), np.inf, error)
    seconds = time.perf_counter() - start
    return Estimate(values[-1], error, "truncation", evaluations, seconds, "", converged)


def _doubtful(values: list[Any], found: RuleSum) -> Any:
    """Return the error of rules that have not agreed."""
    spread = SAFETY * np.ptp(values[-4:], axis=0)
    return np.maximum(spread, 2 * found.size / np.sqrt(found.points))


def _credible(values: list[Any], size: Any, memory: tuple[float, ...]) -> Any:
    """Return the smallest difference from the truth that a sequence of values makes credible."""
    differences = np.abs(np.diff(values[-4:], axis=0))[::-1]
    shares = differences / np.where(size > 0, size, 1.0)
    terms = [
        d * np.minimum(share, 1.0) ** power
        for d, share, power in zip(differences, shares, memory, strict=False)
    ]
    return np.max(terms, axis=0)


def adaptive(one: Integrand, two: Integrand, rtol: float, atol: float, budget: int) -> Estimate:
    """Run SciPy's cubature on two forms of the same integral over the unit square and compare them."""
    from scipy.integrate import cubature

    counted = 0

    def guarded(integrand: Integrand) -> Integrand:
        def count(points: FloatArray) -> Any:
            nonlocal counted
            counted += len(points)
            value = np.asarray(integrand(points), dtype=float)
            if not np.all(np.isfinite(value)):
                raise NonFiniteError("the integrand is not finite", value=value)
            return value

        return count

    limit = max(1, budget // (2 * GK21))
    runs = [
        cubature(
            guarded(form),
            [0.0, 0.0],
            [1.0, 1.0],
            rule="gk21",
            rtol=rtol / 2,
            atol=atol / 2,
            max_subdivisions=limit,
        )
        for form in (one, two)
    ]
    first, second = runs
    difference = np.abs(first.estimate - second.estimate)
    claimed = first.error + second.error
    size = np.abs(first.estimate)
    error = np.maximum(claimed, SAFETY * difference) + ROUNDING * size
    converged = bool(np.all(error <= np.maximum(atol, rtol * size)))
    note = ""
    if np.any(difference > np.maximum(claimed, 1e3 * ROUNDING * size)):
        note = (
            f"two independent rules disagree beyond their claims: {_short(first)} and {_short(second)}; "
            "the integrand may have a kink on a panel's edge, or no finite integral"
        )
    value = (first.estimate + second.estimate) / 2
    return Estimate(value[()], error[()], "truncation", counted, converged=converged, note=note)


def _short(run: Any) -> str:
    worst = int(np.argmax(np.atleast_1d(run.error)))
    value, error = np.atleast_1d(run.estimate)[worst], np.atleast_1d(run.error)[worst]
    return f"{value:.6g} ± {error:.1g}"
