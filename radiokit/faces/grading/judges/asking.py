"""Asking: gets a function's numbers, at once or one by one, in the shape of what is right."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from radiokit.faces.grading.finding import Callee, Mode
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.words import say

__all__ = ["asked", "close", "fitted", "is_extreme", "is_right", "out_of_range"]

RANGE = 1e100
"""Beyond which number, or below its reciprocal, products of a few may overflow or underflow."""


def asked(
    callee: Callee, given: Mapping[str, Array], right: Array, seed: int, allowed: Array
) -> tuple[Result, Mode]:
    """Return the answer to all inputs at once or, where that is none or wrong, one by one; and which."""
    arrays = list(given.values())
    best = callee.call(*arrays, mode="batch", seed=seed)
    mode: Mode = "batch"
    most = max((array.ndim for array in arrays), default=0)
    # An answer must not depend on the numbers beside its own; but rows may be asked for one by one.
    if is_right(best, right, allowed) or most == 0 or (most == 1 and _usable(best, right)):
        return best, mode
    if best.ended:  # it would do so again
        return best, mode
    one_by_one: tuple[Mode, ...] = ("scalar", "single")
    for other in one_by_one:
        result = callee.call(*arrays, mode=other, seed=seed)
        if is_right(result, right, allowed):
            return result, other
        if _rights(result, right, allowed) > _rights(best, right, allowed):
            best, mode = result, other
        elif other == "scalar" and not result.ok and best.raised in ("TypeError", "ValueError"):
            best, mode = result, other  # what arrays do to code for numbers says less
    return best, mode


def _usable(result: Result, right: Array) -> bool:
    return result.ok and len(result.values) == 1 and result.values[0].size == right.size


def _rights(result: Result, right: Array, allowed: Array) -> int:
    """Return how many numbers are right, or -1 where there are none."""
    if not _usable(result, right) or result.values[0].dtype.kind == "c":
        return -1
    return int(np.count_nonzero(close(result.values[0].reshape(right.shape), right, allowed)))


def is_right(result: Result, right: Array, allowed: Array) -> bool:
    """Return whether a result is real and right everywhere."""
    if not _usable(result, right) or result.values[0].dtype.kind == "c":
        return False
    return bool(close(result.values[0].reshape(right.shape), right, allowed).all())


def fitted(result: Result, right: Array, language: str) -> tuple[Array, str]:
    """Return the answer in the shape of what is right, or what is wrong with it."""
    (answer, *more) = result.values
    key = "one-number" if right.shape == (1,) else "shape"
    if more:
        shape = " × ".join(str(value.shape) for value in result.values)
        return answer, say(language, key, shape=shape, expected=right.shape)
    if answer.dtype.kind == "c":
        return answer, say(language, "complex")
    if answer.size != right.size or (answer.ndim > right.ndim and max(answer.shape) != answer.size):
        return answer, say(language, key, shape=answer.shape, expected=right.shape)
    if answer.dtype.kind != "f":
        answer = answer.astype(float)
    return answer.reshape(right.shape), ""


def close(answer: Array, right: Array, allowed: Array) -> Array:
    """Return where an answer is right; never where it is NaN."""
    close: Array = np.abs(answer.astype(float) - right) <= allowed
    return close


def out_of_range(
    answer: Array, right: Array, given: Mapping[str, Array], good: Array, *, widest: float = RANGE
) -> bool:
    """Return whether all that is wrong is 0, infinite or NaN, at inputs so large or small that it may be."""
    bad = ~good.reshape(len(right), -1).all(axis=1)
    if bad.all() or not bad.any():
        return False
    lost = good | ~np.isfinite(answer) | ((answer == 0) & (right != 0))
    extreme = np.zeros(len(right), dtype=bool)
    for value in given.values():
        wide = np.broadcast_to(_is_wide(value, widest), value.shape or (len(right),))
        extreme |= wide.reshape(len(right), -1).any(axis=1)
    return bool(lost.all() and extreme[bad].all())


def is_extreme(value: Array) -> bool:
    """Return whether products of a few of these numbers may overflow or underflow."""
    return bool(_is_wide(value, RANGE).any())


def _is_wide(value: Array, widest: float) -> Array:
    size = np.abs(value)
    wide: Array = (size > widest) | ((size > 0) & (size < 1 / widest))
    return wide
