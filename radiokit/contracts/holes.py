"""Holes: patches of what is between planes and within a cone, outside of round bodies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

import numpy as np
import numpy.typing as npt

from radiokit.contracts.piece import Patch, fan
from radiokit.measure.circlecone import CircleCone
from radiokit.measure.clip import Cone, sides
from radiokit.measure.exact import RationalVector, inner, rational
from radiokit.measure.lattice import kronecker
from radiokit.measure.lunes import Region
from radiokit.physics.ball import Ball
from radiokit.physics.litparts import corners
from radiokit.physics.plate import Plate

__all__ = ["around", "axis_of", "joined_patches", "pierced"]

FloatArray = npt.NDArray[np.float64]


def around(cone: Cone, holes: Sequence[Ball | Plate]) -> Sequence[Patch] | None:
    """Return patches of a convex cone of straight sides outside of round holes."""
    met = []
    for hole in holes:
        if all(hole.cone.holds(p) for p in cone):
            return ()
        crossed = any(hole.cone.crossed_by(cone[k - 1], p) for k, p in enumerate(cone))
        if crossed or all(inner(side, hole.cone.center) > 0 for side in sides(cone)):
            met.append(hole)
    if not met:
        return fan(corners(cone))
    return pierced(sides(cone), None, axis_of(met[0]), met)


def pierced(
    planes: Sequence[RationalVector], cone: CircleCone | None, axis: FloatArray, holes: Sequence[Ball | Plate]
) -> list[Patch] | None:
    """Return patches between planes and within a cone, outside of round holes.

    Planes part holes that lie apart; those that overlap must have a direction in common.
    """
    for first, second in combinations(holes, 2):
        plane = _between(first, second)
        if plane is None:
            continue
        halves = []
        for sign in (1, -1):
            side = (sign * plane[0], sign * plane[1], sign * plane[2])
            left = [hole for hole in holes if hole.cone.to_half_space(side) != "apart"]
            halves.append(pierced([*planes, side], cone, axis, left))
        return joined_patches(halves)
    middle = _common(holes) if holes else axis
    return None if middle is None else list(Region(middle, planes, cone, [hole.cone for hole in holes]).arcs)


def joined_patches(parts: Iterable[Sequence[Patch] | None]) -> list[Patch] | None:
    """Return all patches, or None where some are not known."""
    found: list[Patch] = []
    for part in parts:
        if part is None:
            return None
        found += part
    return found


def _common(holes: Sequence[Ball | Plate]) -> FloatArray | None:
    """Return a direction inside of all of these cones, if one is found."""
    axes = np.array([axis_of(hole) for hole in holes])
    for weights in (np.ones(len(axes)), *np.eye(len(axes)), *(np.eye(len(axes)) + 0.2), *_mixed(axes)):
        middle = weights @ axes
        size = float(np.sqrt(middle @ middle))
        if size > 0 and all(hole.cone.holds(middle / size) for hole in holes):
            return np.asarray(middle / size)
    return None


def _mixed(axes: FloatArray) -> FloatArray:
    """Return weights (N, K), the evenly spread ones of K axes."""
    weights = kronecker(64, max(len(axes), 2))[:, : len(axes)]
    return np.asarray(weights / weights.sum(axis=1)[:, None])


def _between(first: Ball | Plate, second: Ball | Plate) -> RationalVector | None:
    """Return a plane with one cone on its positive side and another on its negative one, if one is found."""
    a, b = axis_of(first), axis_of(second)
    across = np.cross(np.cross(a, b), a)
    size = float(np.sqrt(across @ across))
    if not size > 0:
        return None
    across /= size
    angle = float(np.arctan2(size, a @ b))
    for share in (0.5, *(np.arange(1, 32) / 32)):
        s = angle * float(share)
        plane = rational(np.sin(s) * a - np.cos(s) * across)
        if (first.cone.to_half_space(plane), second.cone.to_half_space(plane)) == ("within", "apart"):
            return plane
    return None


def axis_of(body: Ball | Plate) -> FloatArray:
    """Return the middle (3,) of the directions to a round body."""
    return body.axis if isinstance(body, Ball) else body.axes[2]
