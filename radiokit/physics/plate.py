"""Plate: a flat disk from one point off its plane: what it hides, how far it is, what it sends."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import frame
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.circlecone import CircleCone
from radiokit.measure.exact import RationalVector, difference, inner, rational, root
from radiokit.physics.disk import DiskView, against

__all__ = ["Plate"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Plate:
    """A disk from one point in front of it, in a unit in which all lengths are at most about 1.

    >>> plate = Plate.seen((0.0, 0.0, 4.0), (0.0, 0.0, -1.0), 1.0, np.zeros(3))
    >>> plate.distance(np.array([[0.0, 0.0, 1.0]])).tolist()
    [4.0]
    """

    towards: RationalVector  # to the centre
    normal: RationalVector
    radius: Fraction
    unit: Fraction  # in metres
    view: DiskView
    axes: FloatArray  # (3, 3): rows along the cone's first and second half-width, and its axis

    @classmethod
    def seen(
        cls, center: Iterable[float], normal: Iterable[float], radius: float, position: Iterable[float]
    ) -> Plate | None:
        """Return what a position sees of a disk of that centre, normal and radius [m].

        None where it sees nothing, from behind and from within the plane.

        Raises
        ------
        ParameterError
            When the position is on the disk, or too far away or too near for floats.
        """
        center, position, normal = tuple(center), tuple(map(float, position)), tuple(normal)
        m, v = rational(normal), difference(center, position)
        depth, across, square = -inner(m, v), inner(m, m), inner(v, v)
        size = Fraction(radius) ** 2
        if depth == 0 and square <= size:
            raise ParameterError("position", position, f"off the disk of radius {radius!r} around {center}")
        if depth <= 0:
            return None
        larger = max(square, size)
        unit = Fraction(2) ** ((larger.numerator.bit_length() - larger.denominator.bit_length()) // 2)
        v, scaled = (v[0] / unit, v[1] / unit, v[2] / unit), Fraction(radius) / unit
        depth, square, size = depth / unit, square / unit**2, size / unit**2
        foot = depth * depth / across
        offset = root(square - foot)
        if not min(root(foot), float(scaled)) > 1e-100:
            allowed = f"within 1e100 radii of the disk around {center}, and as far off its plane"
            raise ParameterError("position", position, allowed)
        view = DiskView(
            radius=float(scaled),
            depth=root(foot),
            offset=offset,
            rim=float(square - foot - size) / (offset + float(scaled)),
            power=float(square - size),
        )
        tilt = 0.5 * math.atan2(2 * view.depth * offset, float(2 * foot + size - square))
        return cls(v, m, scaled, unit, view, _axes(normal, v, depth / across, tilt))

    @property
    def center(self) -> RationalVector:
        """The way to the centre [m]."""
        x, y, z = self.towards
        return x * self.unit, y * self.unit, z * self.unit

    @property
    def size(self) -> Fraction:
        """The radius [m]."""
        return self.radius * self.unit

    @cached_property
    def cone(self) -> CircleCone:
        """The directions that meet the disk."""
        return CircleCone(self.towards, self.normal, self.radius**2)

    def near(self, direction: FloatArray) -> BoolArray:
        """Return which unit vectors (N, 3) meet the disk; a sample at its rim may be off by rounding."""
        a, b = self.view.semi_axes
        x, y, z = (direction @ self.axes.T).T
        return np.asarray(np.hypot(x / a, y / b) <= z * (1 + 8 * _EPS) + 4 * _EPS / min(a, b))

    def contains(self, direction: FloatArray) -> BoolArray:
        """Return which directions (N, 3) meet the disk, its edge included, without any rounding."""
        a, b = self.view.semi_axes
        x, y, z = (direction @ self.axes.T).T
        doubt = 32 * _EPS * (1.0 + 1.0 / min(a, b))
        return self.cone.decide(direction, np.hypot(x / a, y / b) - z, doubt)

    def distance(self, direction: FloatArray) -> FloatArray:
        """Return how far (N,) the disk's plane is along unit vectors (N, 3); infinite if it is not ahead."""
        normal = np.array([float(x) for x in self.normal])
        facing = -(direction @ normal) / math.sqrt(normal @ normal)
        depth = self.view.depth * float(self.unit)
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(np.where(facing > 0, depth / np.abs(facing), np.inf))

    def solid_angle(self) -> Estimate:
        """Return Ω [sr] by one elliptic integral."""
        value = self.view.solid_angle()
        return Estimate(value, 32 * _EPS * value, "rounding", method="closed form")

    def irradiance(self, normal: FloatArray) -> Estimate:
        """Return E/L [sr] on a receiver of any pose, for Lambert's law.

        In closed form where the horizon does not cut the disk, and else by an integral of positive strips
        that is bisected down to rounding. What the horizon cuts is decided in rational arithmetic.
        """
        view, horizon = self.view, against(normal, self.normal, self.towards, self.radius)
        if horizon.hidden <= 0 and horizon.along <= 0:
            return Estimate(0.0, 0.0, "rounding", method="closed form")
        if horizon.hidden <= 0:
            height = root(horizon.along * horizon.along / horizon.length)
            value = view.whole(height=height, facing=horizon.facing)
            return Estimate(value, 31 * _EPS * value, "rounding", method="closed form")
        share, error, evaluations = view.cut(
            turn=horizon.turn, slope=horizon.slope, facing=horizon.facing, aside=horizon.aside
        )
        return Estimate(share, error, "truncation", evaluations, method="integral along the disk's edge")


def _axes(normal: tuple[float, ...], v: RationalVector, steps: Fraction, tilt: float) -> FloatArray:
    """Return the cone's axes, ``tilt`` from the way across towards the centre's side."""
    across = -np.array(normal)
    inside = [x + steps * Fraction(y) for x, y in zip(v, normal, strict=True)]
    largest = max(map(abs, inside))
    if largest:
        outward = np.array([float(x / largest) for x in inside])
        outward /= np.linalg.norm(outward)
    else:
        outward = frame(across)[0]
    first = math.cos(tilt) * outward - math.sin(tilt) * across
    return np.stack((first, np.cross(across, outward), math.cos(tilt) * across + math.sin(tilt) * outward))
