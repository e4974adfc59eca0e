"""Digits: what numbers may lack where the formula is right: their digits, their range; or all are one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.asking import close, out_of_range
from radiokit.faces.grading.judges.evidence import rows

__all__ = ["DOUBLE", "FEWEST", "SINGLE", "lost"]

SLACK = 64
"""How many roundings of its terms a careless formula may be off."""
SINGLE, DOUBLE = 2e-5, 1e-6
"""The relative deviation of a right formula with its digits lost, of numbers in float32 and others."""
FEWEST = 5
"""How many answers it takes to tell something of them all."""


def lost(
    answer: Array,
    right: Array,
    given: Mapping[str, Array],
    good: Array,
    *,
    atol: float,
    rtol: float,
    terms: Array | float,
) -> tuple[str, dict[str, Any]]:
    """Return which sentence of ``words`` says what was lost, and what is in it; "" where it is no such loss.

    ``terms`` are the sizes of what a sum is of, in which digits may cancel.
    """
    finite, size = np.isfinite(answer), np.abs(right)
    if out_of_range(answer, right, given, good):
        return "out-of-range", {"bad": rows(~good), "count": len(right)}
    if answer.dtype == np.float32:
        near = close(answer, right, np.maximum(SINGLE * size, atol))
        if out_of_range(answer, right, given, near, widest=1e15):
            return "float32-range", {"bad": rows(~near), "count": len(right)}
    if not finite.all():
        worst = answer[~finite].flat[0]
        value = "NaN" if math.isnan(worst) else "inf" if worst > 0 else "-inf"
        return "not-finite", {"value": value, "bad": rows(~finite), "count": len(finite)}
    numbers = answer.astype(float)
    if len(right) > 1 and not numbers.any() and right.any():
        return "zero", {}
    if len(right) > 1 and not np.ptp(numbers):
        return ("constant", {"value": f"{numbers.flat[0]:.6g}"}) if np.ptp(right) else ("", {})
    short = len(right) >= FEWEST and bool(np.all(numbers == numbers.astype(np.float32)))
    single = short or answer.dtype == np.float32
    eps = float(np.finfo(np.float32 if single else np.float64).eps)
    sizes = np.maximum((SINGLE if single else DOUBLE) * size, SLACK * eps * np.abs(terms))
    near = np.maximum(sizes, atol)
    if not np.all(np.abs(numbers - right) <= near):
        return "", {}
    deviations = (numbers / right - 1)[size > atol]
    values = {"error": f"{np.max(np.abs(deviations), initial=0.0):.1g}", "rtol": rtol}
    if len(deviations) >= FEWEST and np.ptp(deviations) < 0.01 * np.abs(deviations).min():
        return "constant-rounded", values
    return "float32" if single else "imprecise", values
