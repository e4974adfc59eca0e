"""Exact: vectors of rational numbers, for geometry in which a difference decides what is seen."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction

__all__ = ["RationalVector", "cross", "difference", "inner", "rational", "root"]

RationalVector = tuple[Fraction, Fraction, Fraction]


def rational(vector: Iterable[float]) -> RationalVector:
    """Return three floats as the binary fractions that they are."""
    x, y, z = (Fraction(float(component)) for component in vector)
    return x, y, z


def difference(a: Iterable[float], b: Iterable[float]) -> RationalVector:
    """Return ``a`` − ``b``, without rounding.

    >>> float(difference((1.0, 0.0, 0.0), (1e-20, 0.0, 0.0))[0] - 1)
    -1e-20
    """
    x, y, z = (p - q for p, q in zip(rational(a), rational(b), strict=True))
    return x, y, z


def inner(a: RationalVector, b: RationalVector) -> Fraction:
    """Return the inner product, without rounding."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: RationalVector, b: RationalVector) -> RationalVector:
    """Return the cross product, without rounding."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def root(square: Fraction) -> float:
    """Return the square root of a rational number at least 0, to one unit in the last place.

    The square itself may lie outside the range of floats.

    >>> root(Fraction(10) ** -600)
    1e-300
    """
    if not square:
        return 0.0
    exponent = (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    scale = Fraction(4) ** exponent
    return math.ldexp(math.sqrt(square / scale), exponent)
