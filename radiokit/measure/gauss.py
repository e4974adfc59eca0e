"""Gauss: one-dimensional rules on [0, 1], from which the others are made."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

__all__ = ["eased", "gauss_legendre"]

FloatArray = npt.NDArray[np.float64]


@lru_cache(maxsize=64)
def gauss_legendre(n: int) -> tuple[FloatArray, FloatArray]:
    """Return the nodes and weights of the n-point Gauss-Legendre rule on [0, 1].

    >>> x, w = gauss_legendre(3)
    >>> round(float(w @ x**5), 15)
    0.166666666666667
    """
    x, w = np.polynomial.legendre.leggauss(n)
    x, w = (x + 1) / 2, w / 2
    x.setflags(write=False)
    w.setflags(write=False)
    return x, w


def eased(u: FloatArray, w: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a rule on [0, 1] for functions that go as roots at its ends, from one for polynomials.

    >>> u, w = eased(*gauss_legendre(12))
    >>> bool(abs(w @ (u * (1 - u)) ** 0.5 - np.pi / 8) < 1e-5 < abs(w @ u - 0.4))
    True
    """
    return u * u * (3.0 - 2.0 * u), w * 6.0 * u * (1.0 - u)
