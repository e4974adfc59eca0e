"""Ball: a sphere from one point, inside or outside: what it hides, how far it is, what it sends."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import unit
from radiokit.facts.estimate import Estimate
from radiokit.measure.circlecone import CircleCone
from radiokit.measure.exact import RationalVector, cross, difference, inner, rational, root
from radiokit.physics.cap import cap_irradiance

__all__ = ["Ball"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Ball:
    """A sphere as one point sees it, which is not on it.

    ``towards`` is the way to the centre; ``square`` and ``tangent`` are the squares of the distance to it and
    of that along a tangent, which is below 0 inside the sphere.

    >>> moon = Ball.seen((0.0, 0.0, 2.0), 1.0, np.zeros(3))
    >>> moon.sine, moon.surrounds, moon.distance(np.array([[0.0, 0.0, 1.0]])).round(12).tolist()
    (0.5, False, [1.0])
    """

    towards: RationalVector
    radius: Fraction
    square: Fraction
    tangent: Fraction

    @classmethod
    def seen(cls, center: Iterable[float], radius: float, position: Iterable[float]) -> Ball:
        """Return the sphere of that centre and radius [m] as it is seen from a position."""
        towards, size = difference(center, position), Fraction(radius)
        square = inner(towards, towards)
        return cls(towards, size, square, square - size * size)

    @property
    def surrounds(self) -> bool:
        """Whether the point is inside."""
        return self.tangent < 0

    @cached_property
    def axis(self) -> FloatArray:
        """The unit vector (3,) to the centre."""
        if not self.square:
            return np.array([0.0, 0.0, 1.0])  # from the centre all ways are alike
        largest = max(map(abs, self.towards))
        return unit([float(component / largest) for component in self.towards])

    @cached_property
    def sine(self) -> float:
        """Sine of half the angle that the sphere takes, seen from outside."""
        return root(self.radius**2 / self.square)

    @cached_property
    def cosine(self) -> float:
        """Cosine of it."""
        return root(self.tangent / self.square)

    @cached_property
    def cone(self) -> CircleCone:
        """The directions that meet the sphere, by the circle in which they touch it."""
        x, y, z = (component * self.tangent / self.square for component in self.towards)
        return CircleCone((x, y, z), self.towards, self.radius**2 * self.tangent / self.square)

    def near(self, direction: FloatArray) -> BoolArray:
        """Return which unit vectors (N, 3) meet the sphere, its rim with a few units of rounding."""
        chord = self.sine * math.sqrt(2.0 / (1.0 + self.cosine))
        return np.asarray(self._chords(direction) <= chord * (1.0 + 4 * _EPS) + 2 * _EPS)

    def contains(self, direction: FloatArray) -> BoolArray:
        """Return which directions (N, 3) meet the sphere, tangents included, without any rounding."""
        if self.surrounds:
            return np.ones(len(direction), dtype=bool)
        chord = self.sine * math.sqrt(2.0 / (1.0 + self.cosine))
        return self.cone.decide(direction, self._chords(direction) - chord, 16 * _EPS * (1.0 + chord))

    def distance(self, direction: FloatArray) -> FloatArray:
        """Return how far (N,) the sphere is along unit vectors (N, 3) that meet it, if only by rounding.

        From t² − 2bt + (d² − R²) = 0, whose nearer root is the last term over the farther one.
        """
        away = root(self.square)
        along = away * (direction @ self.axis)
        across = away * np.sqrt(np.sum(np.cross(direction, self.axis) ** 2, axis=1))
        radius = float(self.radius)
        depth = np.sqrt(np.maximum((radius - across) * (radius + across), 0.0))
        if self.surrounds:
            room = root(-self.tangent)  # and nothing cancels in the farther root, the only one ahead
            return np.asarray(np.where(along > 0, along + depth, room / (depth - along + (along > 0)) * room))
        length, ahead = root(self.tangent), along > 0
        return np.asarray(np.where(ahead, length * (length / np.where(ahead, along + depth, 1.0)), np.inf))

    def solid_angle(self) -> Estimate:
        """Return Ω = 2π (1 − cosσ) [sr], seen from outside."""
        value = 2.0 * math.pi * self.sine * self.sine / (1.0 + self.cosine)
        return Estimate(value, 8 * _EPS * value, "rounding", method="closed form")

    def irradiance(self, normal: FloatArray) -> Estimate:
        """Return E/L [sr] on a receiver outside, of any tilt: π (R/d)² cosθ, less what the horizon hides.

        Whether the horizon cuts the sphere, and by how much, is decided in rational arithmetic, so that the
        relative error is that of a few operations for every sphere and every tilt.
        """
        n = rational(normal)
        length, along = inner(n, n), inner(n, self.towards)
        hidden = self.radius**2 * length - along * along
        height = math.copysign(root(along * along / (length * self.square)), along)
        if hidden <= 0:
            value = math.pi * self.sine * self.sine * max(height, 0.0)
        else:
            aside = cross(n, self.towards)
            value = cap_irradiance(
                sine=self.sine,
                cosine=self.cosine,
                height=height,
                offset=root(inner(aside, aside) / (length * self.square)),
                angle=math.atan2(root(hidden * self.square), root(self.tangent * along * along)),
                half_azimuth=math.atan2(root(hidden), root(self.tangent * length)),
            )
        return Estimate(value, 47 * _EPS * value, "rounding", method="closed form")

    def _chords(self, direction: FloatArray) -> FloatArray:
        """Return the distances (N,) of directions from the axis, on the unit sphere."""
        return np.asarray(np.sqrt(np.sum((direction - self.axis) ** 2, axis=1)))
