"""Answers: what a function of a submission returned, as arrays of numbers, or in a sentence why it is none.

It is run by the child, and imports NumPy alone. Sizes are looked at before anything is converted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from numpy import array, asarray, iinfo, nan, ndarray, stack, zeros

__all__ = ["RefusedError", "Taker"]

DIMENSIONS = 4
CARRIED = {"f": "<f8", "i": "<i8", "u": "<i8", "b": "|b1", "c": "<c16"}


class RefusedError(Exception):
    """What was returned is no answer; the message says why, and has the function as its subject."""


class Taker:
    """Takes what a function returned; ``limit`` is how many bytes all of it may have.

    >>> Taker(1 << 20).outputs((1, [2.0, 3.0]), 2)
    [array(1), array([2., 3.])]
    >>> Taker(1 << 20).outputs(5.0, 2)
    Traceback (most recent call last):
        ...
    radiokit.faces.grading...RefusedError: returned one value where 2 are wanted, as in return a, b
    """

    def __init__(self, limit: int) -> None:
        self._limit = limit

    def outputs(self, result: Any, count: int) -> list[Any]:
        """Return ``count`` arrays; with a count of 1 a tuple that is not one array may be several."""
        if result is None:
            raise RefusedError("returned None: is a return statement missing?")
        if count > 1:
            if isinstance(result, ndarray) and result.shape == (count,):
                result = list(result)
            if not isinstance(result, tuple | list):
                wanted = ", ".join("abcdefgh"[:count])
                raise RefusedError(f"returned one value where {count} are wanted, as in return {wanted}")
            if len(result) != count:
                raise RefusedError(f"returned {len(result)} values where {count} are wanted")
            return self._bounded([self._numbers(value) for value in result])
        if isinstance(result, tuple) and result:
            try:
                return self._bounded([self._numbers(result)])
            except RefusedError:
                return self._bounded([self._numbers(value) for value in result])
        return self._bounded([self._numbers(result)])

    def stacked(self, rows: Sequence[list[Any]], count: int, single: bool) -> list[Any]:
        """Return the answers for rows as one array for each output, the rows first."""
        if not rows:
            return [zeros(0) for _ in range(count)]
        if any(len(row) != len(rows[0]) for row in rows):
            raise RefusedError("returned different numbers of values for different rows")
        outputs = []
        for column in zip(*rows, strict=True):
            parts = [_one(part, single) for part in column]
            for number, part in enumerate(parts):
                if part.shape != parts[0].shape:
                    raise RefusedError(
                        f"returned shape {parts[0].shape} for row 0 and {part.shape} for row {number}"
                    )
            self._weigh((len(parts), *parts[0].shape), parts[0].dtype.itemsize)
            outputs.append(stack(parts))
        return self._bounded([self._plain(output) for output in outputs])

    def _bounded(self, arrays: list[Any]) -> list[Any]:
        total = sum(each.nbytes for each in arrays)
        if total > self._limit:
            raise RefusedError(f"returned {_amount(total)} of numbers in all: too much")
        return arrays

    def _weigh(self, shape: tuple[int, ...], itemsize: int) -> None:
        size = math.prod(shape) * itemsize
        if size > self._limit:
            raise RefusedError(f"returned an array of shape {shape}, {_amount(size)}: too much")

    def _numbers(self, value: Any) -> Any:
        if value is None:
            raise RefusedError("returned None among its values")
        found = value
        if isinstance(found, ndarray):
            self._weigh(found.shape, found.dtype.itemsize)
            found = _unmasked(found)
        else:
            shape = getattr(found, "shape", None)
            if isinstance(shape, tuple) and all(type(length) is int for length in shape):
                self._weigh(shape, 1)
        try:
            found = asarray(found)
        except ValueError as error:
            if "inhomogeneous" not in str(error) and "sequence" not in str(error):
                raise
            raise RefusedError(f"returned a {_kind(value)} whose parts have different lengths") from None
        except MemoryError:
            raise RefusedError("returned more numbers than fit in memory") from None
        self._weigh(found.shape, found.dtype.itemsize)
        if found.ndim > DIMENSIONS:
            raise RefusedError(f"returned an array of {found.ndim} dimensions, shape {found.shape}")
        if found.dtype.kind == "O":
            found = _floats(found, value)
        if found.dtype.kind not in CARRIED:
            of = f" of {found.dtype}"[:80] if isinstance(value, ndarray) else ""
            raise RefusedError(f"returned {_kind(value)}{of} that is no array of numbers")
        return self._plain(found)

    def _plain(self, found: Any) -> Any:
        """Return an array of a type that is carried."""
        kind = CARRIED[found.dtype.kind]
        if found.dtype.kind == "f" and found.dtype.itemsize <= 4:
            kind = "<f4"
        if found.dtype.kind == "u" and found.size and found.max() > iinfo("i8").max:
            kind = "<f8"
        self._weigh(found.shape, int(kind[2:]))
        return asarray(found, dtype=kind)


def _one(part: Any, single: bool) -> Any:
    """Return one row's answer without the leading axes of one row that it was wrapped in."""
    if single and part.ndim and len(part) == 1:
        return part[0]
    while part.ndim > 1 and len(part) == 1:
        part = part[0]
    return part


def _unmasked(found: Any) -> Any:
    """Return a masked array with NaN where it is masked, any other as it is."""
    mask, filled = getattr(found, "mask", None), getattr(found, "filled", None)
    if mask is None or filled is None or found.dtype.kind not in "fiub":
        return found
    return asarray(found.astype(float).filled(nan) if asarray(mask).any() else found.filled())


def _floats(found: Any, value: Any) -> Any:
    """Return objects that are numbers, as fractions, decimals, SymPy's or huge integers, as floats."""
    numbers = []
    for each in found.reshape(-1).tolist():
        if isinstance(each, str | bytes) or not hasattr(type(each), "__float__"):
            raise RefusedError(f"returned {_kind(value)} that is no array of numbers")
        try:
            numbers.append(float(each))
        except OverflowError:
            raise RefusedError("returned a number that is too large for a float") from None
        except (TypeError, ValueError):
            raise RefusedError(f"returned {_kind(each)} that is no number") from None
    return array(numbers, dtype=float).reshape(found.shape)


def _kind(value: Any) -> str:
    return str(type(value).__name__)[:60]


def _amount(size: float) -> str:
    """Return a size in words.

    >>> _amount(8e9)
    '8 GB'
    """
    for unit in ("bytes", "kB", "MB", "GB", "TB"):
        if size < 1000 or unit == "TB":
            break
        size /= 1000
    return f"{size:.3g} {unit}"
