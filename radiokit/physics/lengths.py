"""Lengths: how the view factors check their parameters, and the catalogue that they follow."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source

__all__ = ["HOWELL", "Orientation", "at_least_zero", "check_orientation", "positive", "spread"]

FloatArray = npt.NDArray[np.float64]
Orientation = Literal["parallel", "perpendicular"]

HOWELL = Source(
    authors="Howell, Mengüç, Daun, Siegel",
    year=2020,
    title="Thermal Radiation Heat Transfer, 7th edition; and Howell's Catalog of Configuration Factors",
    doi="10.1201/9780429327308",
    equation="the catalogue's number stands with each function",
    errata="as printed, C-11, C-14, C-41 and the sphere's factors cancel for small or distant surfaces",
)


def check_orientation(orientation: str) -> None:
    """Raise unless an element is parallel or perpendicular to what it sees."""
    if orientation not in ("parallel", "perpendicular"):
        raise ParameterError("orientation", orientation, "'parallel' or 'perpendicular'")


def at_least_zero(name: str, value: npt.ArrayLike) -> FloatArray:
    """Return finite lengths that may be 0."""
    allowed = "a finite length, at least 0"
    array = numbers(name, value, allowed)
    reject(name, array, np.asarray(~((array >= 0) & np.isfinite(array))), allowed)
    return array


def positive(name: str, value: npt.ArrayLike) -> FloatArray:
    """Return finite lengths above 0."""
    allowed = "a finite length above 0"
    array = numbers(name, value, allowed)
    reject(name, array, np.asarray(~((array > 0) & np.isfinite(array))), allowed)
    return array


def spread(array: FloatArray, bad: Any) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return both in their common shape."""
    marked = np.asarray(bad)
    return np.broadcast_to(array, marked.shape), marked
