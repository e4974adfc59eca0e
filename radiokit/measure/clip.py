"""Clip: convex cones of directions, cut by planes and by each other in rational numbers, without rounding."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from radiokit.measure.exact import RationalVector, cross, inner

__all__ = ["Cone", "clipped", "cut", "has_area", "hemisphere", "sides", "without"]

Cone = list[RationalVector]
"""The corners of a convex cone, counter-clockwise as seen from outside: ``cross(a, b)`` points into it."""


def cut(points: Sequence[RationalVector], heights: Sequence[Fraction]) -> Cone:
    """Return the part of a convex polygon where an affine function, given at its corners, is at least 0.

    Source: Sutherland, Hodgman (1974), Reentrant polygon clipping, doi:10.1145/360767.360802.
    """
    found: Cone = []
    for k, (p, h) in enumerate(zip(points, heights, strict=True)):
        q, low = points[k - 1], heights[k - 1]
        if (low < 0 < h) or (h < 0 < low):
            share = low / (low - h)
            found.append(
                (q[0] + share * (p[0] - q[0]), q[1] + share * (p[1] - q[1]), q[2] + share * (p[2] - q[2]))
            )
        if h >= 0:
            found.append(p)
    return found


def clipped(cone: Sequence[RationalVector], plane: RationalVector) -> Cone:
    """Return the part of a cone with w·n ≥ 0.

    >>> octant = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> clipped(octant, (1, -1, 0))
    [(1, 0, 0), (Fraction(1, 2), Fraction(1, 2), Fraction(0, 1)), (0, 0, 1)]
    """
    return cut(cone, [Fraction(inner(p, plane)) for p in cone])


def sides(cone: Sequence[RationalVector]) -> list[RationalVector]:
    """Return the normals of a cone's sides, which point into it."""
    return [cross(cone[k - 1], p) for k, p in enumerate(cone) if any(cross(cone[k - 1], p))]


def has_area(cone: Sequence[RationalVector]) -> bool:
    """Return whether a cone is more than a fan of rays in a plane."""
    return any(inner(cone[0], cross(cone[k], cone[k + 1])) > 0 for k in range(1, len(cone) - 1))


def without(cone: Cone, planes: Sequence[RationalVector]) -> list[Cone]:
    """Return convex cones that make up what of ``cone`` is outside the convex one that ``planes`` bound.

    >>> octant = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> [len(part) for part in without(octant, [(1, -1, 0)])], without(octant, sides(octant))
    ([3], [])
    """
    found: list[Cone] = []
    rest = cone
    for plane in planes:
        outside = clipped(rest, (-plane[0], -plane[1], -plane[2]))
        if has_area(outside):
            found.append(outside)
        rest = clipped(rest, plane)
        if not has_area(rest):
            return [cone]
    return found


def hemisphere(normal: RationalVector) -> list[Cone]:
    """Return four cones that make up the half-space around ``normal``.

    >>> [has_area(part) for part in hemisphere((Fraction(0), Fraction(0), Fraction(1)))]
    [True, True, True, True]
    """
    least = min(range(3), key=lambda k: abs(normal[k]))
    axis = (Fraction(least == 0), Fraction(least == 1), Fraction(least == 2))
    first = cross(axis, normal)
    second = cross(normal, first)
    around = [first, second]
    around += [(-x, -y, -z) for x, y, z in around]
    return [[normal, around[k], around[(k + 1) % 4]] for k in range(4)]
