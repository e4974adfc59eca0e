"""Triples: products and lengths of vectors (..., 3), as kernels that trust what they are given."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["cross", "dot", "every", "length", "normalise"]

FloatArray = npt.NDArray[np.float64]


def dot(a: FloatArray, b: FloatArray) -> Any:
    """Return the dot products of vectors ``a`` and ``b`` (..., 3): shape (...).

    >>> float(dot(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 2.0])))
    6.0
    """
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross products of vectors ``a`` and ``b`` (..., 3): shape (..., 3).

    >>> cross(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    array([0., 0., 1.])
    """
    (ax, ay, az), (bx, by, bz) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    return np.stack((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), axis=-1)


def every(components: npt.NDArray[np.bool_]) -> Any:
    """Return whether all three of (..., 3) are true; many times as fast as ``all`` along so short an axis.

    >>> every(np.array([[True, True, True], [True, False, True]]))
    array([ True, False])
    """
    return components[..., 0] & components[..., 1] & components[..., 2]


def length(v: FloatArray) -> Any:
    """Return the lengths of vectors (..., 3) whose squares may underflow: shape (...).

    >>> float(length(np.array([0.0, 3e-300, 4e-300])))
    5e-300
    """
    return np.hypot(np.hypot(v[..., 0], v[..., 1]), v[..., 2])


def normalise(v: FloatArray) -> FloatArray:
    """Return finite non-zero vectors (..., 3) over their lengths; a power of two keeps squares in range.

    >>> normalise(np.array([0.0, 3e-300, 4e-300]))
    array([0. , 0.6, 0.8])
    """
    with np.errstate(over="ignore"):
        square = np.asarray(dot(v, v))
    if not ((square > 1e-280) & (square < 1e280)).all():
        _, exponent = np.frexp(np.max(np.abs(v), axis=-1, keepdims=True))
        v = np.ldexp(v, -exponent)
        square = np.asarray(dot(v, v))
    result: FloatArray = v / np.sqrt(square)[..., None]
    return result
