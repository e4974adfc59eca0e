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
HALF, SINGLE, DOUBLE = 1e-2, 2e-5, 1e-6
"""The relative deviation of a right formula with its digits lost, of numbers in float16, float32, others."""
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
    half = _is_half(answer)
    if answer.dtype == np.float32:
        near = close(answer, right, np.maximum((HALF if half else SINGLE) * size, atol))
        if out_of_range(answer, right, given, near, widest=1e2 if half else 1e15):
            kind = "float16" if half else "float32"
            return "float32-range", {"kind": kind, "bad": rows(~near), "count": len(right)}
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
    eps = float(np.finfo(np.float16 if half else np.float32 if single else np.float64).eps)
    least = HALF if half else SINGLE if single else DOUBLE
    sizes = np.maximum(least * size, SLACK * eps * np.abs(terms))
    near = np.maximum(sizes, atol)
    if not np.all(np.abs(numbers - right) <= near):
        return "", {}
    deviations = (numbers / right - 1)[size > atol]
    values = {"error": f"{np.max(np.abs(deviations), initial=0.0):.1g}", "rtol": rtol}
    values["kind"] = "float16" if half else "float32"
    if len(deviations) >= FEWEST and np.ptp(deviations) < 0.01 * np.abs(deviations).min():
        return "constant-rounded", values
    return "float32" if single else "imprecise", values


def _is_half(answer: Array) -> bool:
    """Return whether numbers come from float16, which is carried as float32: no other has so few digits."""
    if answer.dtype != np.float32 or len(answer) < FEWEST:
        return False
    with np.errstate(over="ignore"):
        short = answer.astype(np.float16)
    finite = np.isfinite(answer)
    return bool(np.all(answer[finite] == short[finite]) and np.any(answer != np.round(answer)))
