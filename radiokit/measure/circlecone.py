"""Circle cone: the directions from a point into a circle, in rational numbers, and how two such cones lie."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.measure.exact import RationalVector, cross, inner, rational
from radiokit.measure.twin import working_precision

__all__ = ["CircleCone", "Place"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

Place = Literal["apart", "within", "around", "across"]
"""How something lies to a region: beside it, in it, all around it, or over its edge."""

DIGITS = 80
"""Digits with which it is decided how two circles lie to each other."""

TOUCH = 1e-40
"""What is nearer than this to touching touches: no float could tell what is lost by it."""


@dataclass(frozen=True, eq=False)
class CircleCone:
    """The cone over a circle, its rim included: seen from the apex at the origin a sphere or a disk.

    Parameters
    ----------
    center, normal : rational vectors
        Of the circle, whose plane does not contain the origin; ``normal`` is of any length but 0.
    square : Fraction
        The square of its radius, above 0.

    >>> cone = CircleCone(rational((0, 0, 1)), rational((0, 0, 1)), Fraction(1))
    >>> cone.holds((1.0, 0.0, 1.0)), cone.holds((1.0, 0.0, 1.0 - 2**-53)), cone.holds((0.0, 0.0, -1.0))
    (True, False, False)
    """

    center: RationalVector
    normal: RationalVector
    square: Fraction

    @cached_property
    def _height(self) -> Fraction:
        return inner(self.normal, self.center)

    @cached_property
    def way(self) -> FloatArray:
        """A vector (3,) across the circle's plane, away from the apex."""
        largest = max(map(abs, self.normal))
        way = np.array([float(x / largest) for x in self.normal])
        return way if self._height > 0 else -way

    def level(self, w: Any) -> Any:
        """Return a number above 0 for a direction inside the cone and its opposite, and below 0 beside them.

        The line along w meets the circle's plane at (m·c/m·w) w: this is (m·w)² times R² less the square of
        that point's distance from the centre, a quadratic form for any type of number.
        """
        m, c = self.normal, self.center
        rise = m[0] * w[0] + m[1] * w[1] + m[2] * w[2]
        offset = [self._height * a - rise * b for a, b in zip(w, c, strict=True)]
        return self.square * rise * rise - sum(x * x for x in offset)

    def ahead(self, w: Any) -> Any:
        """Return a number above 0 where a direction goes to the circle's plane and not away from it."""
        m = self.normal
        rise = m[0] * w[0] + m[1] * w[1] + m[2] * w[2]
        return rise if self._height > 0 else -rise

    def holds(self, direction: Any) -> bool:
        """Return whether a direction (3,) of floats or fractions meets the circle, without any rounding."""
        w = tuple(x if isinstance(x, Fraction) else Fraction(float(x)) for x in direction)
        return bool(self.ahead(w) > 0 and self.level(w) >= 0)

    def decide(self, direction: FloatArray, outside: FloatArray, doubt: float) -> BoolArray:
        """Return which directions (N, 3) the cone holds: with ``outside`` ≤ 0, or exactly if in doubt."""
        found = outside <= 0
        for k in np.flatnonzero(np.abs(outside) <= doubt):
            found[k] = self.holds(direction[k])
        return np.asarray(found)

    def to_half_space(self, normal: RationalVector) -> Place:
        """Return how the cone lies to the half-space w·n ≥ 0: ``within``, ``apart`` or ``across``.

        On the disk n·w is between n·c ∓ R |n × m|/|m|.
        """
        along, aside = inner(normal, self.center), cross(normal, self.normal)
        reach = self.square * inner(aside, aside)
        if along * along * inner(self.normal, self.normal) < reach:
            return "across"
        return "within" if along > 0 else "apart" if along < 0 else "across"

    def crossed_by(self, a: RationalVector, b: RationalVector) -> bool:
        """Return whether a point of the segment from a to b is inside the cone, and not just on it.

        Along the segment the level is a parabola, the largest value of which is at an end or at its top.
        """
        step = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
        start, bend = self.level(a), self.level(step)
        slope = self.level(b) - start - bend
        low, high = self.ahead(a), self.ahead(b)
        first, last = Fraction(0), Fraction(1)
        if low <= 0 < high:
            first = low / (low - high)
        elif high <= 0 < low:
            last = low / (low - high)
        elif low <= 0:
            return False
        top = min(max(-slope / (2 * bend), first), last) if bend < 0 else first
        return any(start + s * (slope + s * bend) > 0 for s in (first, top, last))

    def to_circle(self, other: CircleCone) -> Place:
        """Return how this cone lies to another: touching from inside or outside is no crossing.

        Along this circle the other's level is a trigonometric polynomial of second degree; a quartic has its
        extremes, and their signs tell.
        """
        with working_precision(DIGITS):
            lows, highs = [], []
            for angle in self._turns(other):
                level, size, ahead = other._seen(self._rim(angle))
                tie = abs(level) <= TOUCH * size
                lows.append(ahead > 0 and (tie or level > 0))
                highs.append(ahead <= 0 or tie or level < 0)
            if all(lows):
                return "around" if all(highs) else "within"  # equal cones hide each other
        if not all(highs):
            return "across"
        return "around" if self.holds(other.center) else "apart"

    def meetings(self, other: CircleCone, frame: FloatArray) -> FloatArray:
        """Return vectors (N, 3), in a frame of rows (3, 3), along which the surfaces of two cones cross."""
        import mpmath

        found = []
        with working_precision(DIGITS):
            for root in _roots(self._harmonics(other)[0]):
                w = self._rim(mpmath.arg(root))
                if abs(abs(root) - 1) < mpmath.mpf(10) ** (-DIGITS // 4) and other._seen(w)[2] > 0:
                    size = max(map(abs, w))
                    local = (sum(a * x for a, x in zip(row, w, strict=True)) for row in frame.tolist())
                    found.append([float(x / size) for x in local])
        return np.array(found).reshape(-1, 3)

    def _rim(self, angle: Any) -> list[Any]:
        import mpmath

        c, s = mpmath.cos(angle), mpmath.sin(angle)
        first, second = self._frame
        return [_real(x) + c * p + s * q for x, p, q in zip(self.center, first, second, strict=True)]

    @property
    def _frame(self) -> tuple[list[Any], list[Any]]:
        """Two perpendicular radii of the circle, in mpmath's numbers."""
        import mpmath

        least = min(range(3), key=lambda k: abs(self.normal[k]))
        axis = rational([float(k == least) for k in range(3)])
        first = cross(self.normal, axis)
        second = cross(self.normal, first)
        return tuple(  # type: ignore[return-value]
            [_real(x) * mpmath.sqrt(_real(self.square / inner(v, v))) for x in v] for v in (first, second)
        )

    def _seen(self, w: list[Any]) -> tuple[Any, Any, Any]:
        """Return the level of a direction in mpmath's numbers, the size of its terms, and if it is ahead."""
        m, c = [_real(x) for x in self.normal], [_real(x) for x in self.center]
        height, square = _real(self._height), _real(self.square)
        rise = sum(a * b for a, b in zip(m, w, strict=True))
        inside = square * rise * rise
        offset = sum((height * a - rise * b) ** 2 for a, b in zip(w, c, strict=True))
        return inside - offset, inside + offset, rise if height > 0 else -rise

    def _harmonics(self, other: CircleCone) -> tuple[list[Any], list[Any]]:
        """Return the other's level along this rim as a polynomial in t = e^{iφ}, and its derivative's.

        The level is a₀ + a₁ cosφ + b₁ sinφ + a₂ cos2φ + b₂ sin2φ, which 8 values give.
        """
        import mpmath

        places = _eighths()
        levels = [other._seen(self._rim(angle))[0] for angle in places]
        size = max(map(abs, levels)) or mpmath.mpf(1)

        def moment(k: int, f: Any) -> Any:
            return sum(v * f(k * a) for v, a in zip(levels, places, strict=True)) / (4 * size)

        a1, b1 = moment(1, mpmath.cos), moment(1, mpmath.sin)
        a2, b2 = moment(2, mpmath.cos), moment(2, mpmath.sin)
        p2, p1, mean = mpmath.mpc(a2, -b2) / 2, mpmath.mpc(a1, -b1) / 2, moment(0, mpmath.cos) / 2
        value = [p2, p1, mean, mpmath.conj(p1), mpmath.conj(p2)]
        return value, [2 * p2, p1, mpmath.mpc(0), -mpmath.conj(p1), -2 * mpmath.conj(p2)]

    def _turns(self, other: CircleCone) -> list[Any]:
        """Return the angles along this rim at which the other's level is largest and least, and some more."""
        import mpmath

        return _eighths() + [mpmath.arg(root) for root in _roots(self._harmonics(other)[1])]


def _eighths() -> list[Any]:
    import mpmath

    return [mpmath.pi * k / 4 for k in range(8)]


def _roots(p: list[Any]) -> list[Any]:
    """Return the roots of a polynomial, whose ends may be 0."""
    import mpmath

    tiny = mpmath.mpf(10) ** (4 - DIGITS)
    while p and abs(p[0]) < tiny:
        p = p[1:]
    while p and abs(p[-1]) < tiny:
        p = p[:-1]
    return list(mpmath.polyroots(p, maxsteps=200, extraprec=200, error=False)) if len(p) > 1 else []


def _real(x: Fraction) -> Any:
    import mpmath

    return mpmath.mpf(x.numerator) / x.denominator
