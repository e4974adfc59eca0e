"""Checking: arguments that must be numbers or vectors, and how a wrong one is shown."""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError

__all__ = ["check_above_zero", "check_integration", "numbers", "reject", "short", "vectors"]

FloatArray = npt.NDArray[np.float64]


def numbers(name: str, value: Any, allowed: str) -> FloatArray:
    """Return real numbers as float64, refusing text, booleans, complex numbers and ragged lists."""
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise ParameterError(name, short(value), allowed) from None
    if array.dtype.kind not in "fiu":
        raise ParameterError(name, short(value), allowed)
    return array.astype(np.float64, copy=False)


class _Text(str):
    """Text that an error message shows without quotation marks."""

    __repr__ = str.__str__


def short(value: Any) -> _Text:
    """Return a value as text that an error message shows without quotation marks, cut where it is long."""
    text = repr(value.tolist() if isinstance(value, np.ndarray) and value.size <= 12 else value)
    return _Text(text if len(text) <= 60 else text[:57] + "...")


def reject(name: str, array: FloatArray, bad: npt.NDArray[np.bool_], allowed: str) -> None:
    """Raise for the first element, or the first row, of ``array`` that ``bad`` marks."""
    if not bad.any():
        return
    index = tuple(int(i) for i in np.argwhere(bad)[0])
    where = f"{name}[{', '.join(map(str, index))}]" if index else name
    value = array[index]
    raise ParameterError(where, tuple(value.tolist()) if value.ndim else float(value), allowed)


def vectors(name: str, value: npt.ArrayLike, allowed: str) -> FloatArray:
    """Return real vectors (..., 3) as float64.

    >>> vectors("v", [0, 0, 1], "a vector")
    array([0., 0., 1.])
    """
    array = numbers(name, value, allowed)
    if array.ndim == 0 or array.shape[-1] != 3:
        shown = short(value) if array.size <= 12 else _Text(f"an array of shape {array.shape}")
        raise ParameterError(name, shown, allowed)
    return array


def check_above_zero(**limits: Any) -> None:
    """Refuse a limit, such as ``seconds`` or ``rtol``, that is neither a number above 0 nor None.

    >>> check_above_zero(rtol=1e-3, seconds=None)
    >>> check_above_zero(rtol=0)
    Traceback (most recent call last):
    ...
    radiokit.facts.errors.ParameterError: rtol = 0 is not allowed: it must be above 0, or None
    """
    for name, limit in limits.items():
        if limit is not None and not (isinstance(limit, Real) and float(limit) > 0):
            raise ParameterError(name, limit, "above 0, or None")


def check_integration(integrand: Any, **tolerances: Any) -> None:
    """Refuse an integrand that cannot be called, and a tolerance that is no number at least 0.

    >>> check_integration(abs, rtol=1e-8, atol=0.0)
    >>> check_integration(abs, atol=-1.0)
    Traceback (most recent call last):
    ...
    radiokit.facts.errors.ParameterError: atol = -1.0 is not allowed: it must be a number at least 0
    """
    if not callable(integrand):
        raise ParameterError("integrand", short(integrand), "a function of an array of points")
    for name, tolerance in tolerances.items():
        if not (isinstance(tolerance, Real) and float(tolerance) >= 0):
            raise ParameterError(name, tolerance, "a number at least 0")
