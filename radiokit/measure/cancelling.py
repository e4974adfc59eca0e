"""Cancelling: differences of nearly equal numbers that are computed without subtracting them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["sine_minus_x_cosine", "x_minus_sine"]

_SERIES = tuple((-1) ** k / math.factorial(2 * k + 3) for k in range(9))


def x_minus_sine(x: npt.ArrayLike) -> Any:
    """Return x − sin x, by its series up to |x| = 1.

    >>> float(x_minus_sine(1e-5)) * 6e15
    0.99999999999...
    """
    x = np.asarray(x, dtype=float)
    square = np.minimum(x * x, 1.0)
    total = np.zeros_like(square)
    for coefficient in reversed(_SERIES):
        total = total * square + coefficient
    return np.where(np.abs(x) < 1.0, x * square * total, x - np.sin(x))


def sine_minus_x_cosine(x: npt.ArrayLike) -> Any:
    """Return sin x − x cos x for x in [−π, π]: 2x sin²(x/2) − (x − sin x), which loses a bit at most.

    >>> round(float(sine_minus_x_cosine(1e-5)) * 3e15, 9)
    1.0
    """
    x = np.asarray(x, dtype=float)
    return 2.0 * x * np.sin(0.5 * x) ** 2 - x_minus_sine(x)
