"""Facets: a flat polygon from one point off its plane: what it hides, how far it is, what it sends."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import dot
from radiokit.facts.estimate import Estimate
from radiokit.measure.clip import Cone, sides
from radiokit.measure.exact import RationalVector, cross, difference, inner
from radiokit.measure.outline import area_vector, triangulate
from radiokit.physics import polygon

__all__ = ["Facets", "lies_on"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_EPS = float(np.finfo(float).eps)
_SLACK = 16 * _EPS


@dataclass(frozen=True, eq=False)
class Facets:
    """A polygon as one point sees it: its corners counter-clockwise, and convex parts that make it up.

    ``plane`` is q and k of the plane q·x = k that it lies in, k > 0.

    >>> square = np.array([[-1.0, -1, 2], [-1, 1, 2], [1, 1, 2], [1, -1, 2]])
    >>> seen = Facets.seen(square, np.zeros(3))
    >>> len(seen.parts), seen.distance(np.array([[0.0, 0.6, 0.8]])).tolist()
    (1, [2.5])
    """

    vertices: FloatArray
    position: FloatArray
    outline: Cone
    parts: tuple[Cone, ...]
    plane: tuple[RationalVector, Fraction]

    @classmethod
    def seen(
        cls, corners: FloatArray, position: Iterable[float], *, two_sided: bool = False
    ) -> Facets | None:
        """Return what a position sees of a polygon (N, 3) whose front has its corners counter-clockwise.

        None where it sees nothing: from within the plane, and from behind unless it has two sides.
        """
        origin = np.array(tuple(map(float, position)))
        points = [difference(corner, origin) for corner in corners.tolist()]
        normal, offset = _plane(points)
        if offset > 0 and two_sided:
            corners, points = corners[::-1], points[::-1]
            normal, offset = _plane(points)
        if offset >= 0:
            return None
        q = (-normal[0], -normal[1], -normal[2])
        outline = points[::-1]  # counter-clockwise from outside is clockwise from the point
        parts = [outline]
        if not all(inner(side, p) >= 0 for side in sides(outline) for p in outline):
            triangles = [[points[k] for k in reversed(t)] for t in triangulate(corners).tolist()]
            parts = [t for t in triangles if inner(t[0], cross(t[1], t[2])) > 0]
        return cls(corners, origin, outline, tuple(parts), (q, -offset))

    @cached_property
    def _planes(self) -> list[FloatArray]:
        return [_floats(sides(part)) for part in self.parts]

    def contains(self, direction: FloatArray) -> BoolArray:
        """Return which directions (N, 3) meet the polygon, its edges included, without any rounding."""
        found = np.zeros(len(direction), dtype=bool)
        for part, planes in zip(self.parts, self._planes, strict=True):
            least = (direction @ planes.T).min(axis=1)
            inside = least > 0
            for k in np.flatnonzero(np.abs(least) <= _SLACK):
                inside[k] = self._holds(part, direction[k])
            found |= inside
        return found

    def holds(self, direction: RationalVector) -> bool:
        """Return whether a direction of fractions meets the polygon."""
        return any(self._holds(part, direction) for part in self.parts)

    @staticmethod
    def _holds(part: Cone, direction: Iterable[float] | RationalVector) -> bool:
        x, y, z = (Fraction(v) if isinstance(v, Fraction) else Fraction(float(v)) for v in direction)
        return all(inner(side, (x, y, z)) >= 0 for side in sides(part))

    def distance(self, direction: FloatArray) -> FloatArray:
        """Return how far (N,) the polygon's plane is along directions (N, 3); infinite if it is not ahead."""
        q, k = self.plane
        largest = max(map(abs, q))
        along = direction @ np.array([float(x / largest) for x in q])
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(np.where(along > 0, float(k / largest) / np.abs(along), np.inf))

    def solid_angle(self) -> Estimate:
        """Return the solid angle [sr]."""
        return polygon.solid_angle(self.vertices, self.position)

    def irradiance(self, normal: FloatArray) -> Estimate:
        """Return E/L [sr] on a receiver of any tilt, by Lambert's formula above its horizon."""
        return polygon.irradiance(self.vertices, self.position, normal)


def lies_on(corners: FloatArray, triangles: FloatArray, position: FloatArray) -> bool:
    """Return whether a position is on a polygon (N, 3) of these triangles (T, 3, 3), but for rounding.

    >>> corner = np.eye(3)
    >>> lies_on(corner, corner[None], np.array([0.5, 0.25, 0.25])), lies_on(corner, corner[None], np.zeros(3))
    (True, False)
    """
    size = float(np.abs(corners).max())
    normal = area_vector(corners / size)
    normal = normal / np.sqrt(dot(normal, normal))
    scale = size + float(np.abs(position).max())
    if np.min(np.abs((corners - position) @ normal)) > _SLACK * scale:
        return False
    for a, b, c in triangles - position:
        if all(_height(p, q, normal) >= -_SLACK * scale for p, q in ((a, b), (b, c), (c, a))):
            return True
    return False


def _height(p: FloatArray, q: FloatArray, normal: FloatArray) -> float:
    """Return how far the origin is to the left of the line from p to q, in a plane with that normal."""
    along = q - p
    return float(np.cross(p, along / math.hypot(*along)) @ normal)


def _plane(points: Cone) -> tuple[RationalVector, Fraction]:
    """Return the area vector of a polygon, twice as long, and its product with the first corner."""
    a = points[0]
    x = y = z = Fraction(0)
    for b, c in pairwise(points[1:]):
        u, v, w = cross((b[0] - a[0], b[1] - a[1], b[2] - a[2]), (c[0] - a[0], c[1] - a[1], c[2] - a[2]))
        x, y, z = x + u, y + v, z + w
    return (x, y, z), inner((x, y, z), a)


def _floats(vectors: list[RationalVector]) -> FloatArray:
    """Return vectors of fractions (N, 3) as unit vectors."""
    sizes = [max(map(abs, v)) for v in vectors]
    found = np.array([[float(x / size) for x in v] for v, size in zip(vectors, sizes, strict=True)])
    normalised: FloatArray = found / np.sqrt(dot(found, found))[:, None]
    return normalised
