"""Row: a kernel on its hard axis, the textbook's formula for the same function, the truth, the lesson."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["PRECISIONS", "FloatArray", "Precision", "Row", "decades"]

FloatArray = npt.NDArray[np.floating[Any]]
Precision = type[np.floating[Any]]

PRECISIONS: dict[str, Precision] = {"float64": np.float64, "float32": np.float32}


@dataclass(frozen=True, kw_only=True)
class Row:
    """One kernel and the textbook's formula, along the axis on which the function is hard to compute.

    Parameters
    ----------
    name : str
        As ``radiokit stability NAME`` takes it.
    title : str
        What is computed, and where.
    axis : str
        What ``values`` are, with their unit.
    values : tuple of float
        From easy to hard.
    values_float32 : tuple of float
        The same for float32, where its range of exponents asks for others.
    inputs : callable
        Maps ``values`` (N, 1) to the function's arguments, each broadcastable to (N, K) for K variants at
        each place. They are rounded to the precision in question, and what is left counts as exact.
    kernel : callable
        radiokit's kernel: takes the arguments as arrays (M,) of float64 or of float32, returns (M,).
    textbook : callable
        The textbook's formula: takes a namespace, ``numpy`` or ``mpmath``, and then the arguments.
    twin : callable
        Returns the truth, a ``Twin`` in the same arguments, not written from either of the two.
    kernel_name, kernel_form, textbook_form : str
        The kernel's dotted name, and both formulas as text.
    fails : tuple of str
        The precisions in which the textbook's formula fails.
    lesson : str
        Why it does, and what helps.
    source : Source
        Where the stable form, or the function, comes from.
    """

    name: str
    title: str
    axis: str
    values: tuple[float, ...]
    inputs: Callable[[npt.NDArray[np.float64]], tuple[Any, ...]]
    kernel: Callable[..., Any]
    textbook: Callable[..., Any]
    twin: Callable[[], Twin]
    kernel_name: str
    kernel_form: str
    textbook_form: str
    lesson: str
    source: Source
    fails: tuple[str, ...] = ("float64", "float32")
    values_float32: tuple[float, ...] = ()

    def along(self, precision: Precision) -> tuple[float, ...]:
        """Return the values of the axis for this precision."""
        return self.values_float32 if self.values_float32 and precision is np.float32 else self.values

    def columns(self, precision: Precision) -> list[FloatArray]:
        """Return the arguments, each (N, K), rounded to ``precision``: what all forms are given."""
        values = np.asarray(self.along(precision))[:, None]
        with np.errstate(under="ignore"):
            rounded = [
                np.asarray(column, dtype=np.float64).astype(precision) for column in self.inputs(values)
            ]
        shape = np.broadcast_shapes(values.shape, *(column.shape for column in rounded))
        return [np.broadcast_to(column, shape) for column in rounded]


def decades(first: int, last: int, step: int = 1) -> tuple[float, ...]:
    """Return the powers of ten from 10^first down, or up, to 10^last.

    >>> decades(0, -4, 2)
    (1.0, 0.01, 0.0001)
    """
    sign = 1 if last > first else -1
    return tuple(float(f"1e{k}") for k in range(first, last + sign, sign * step))
