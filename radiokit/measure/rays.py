"""Rays: where straight lines meet spheres, planes and boxes, without the cancellation of b² − 4ac.

Each function takes one origin (3,) and unit directions (N, 3), and returns distances (N,), infinite where the
ray misses.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["through_box", "to_plane", "to_sphere"]

FloatArray = npt.NDArray[np.float64]


def to_sphere(origin: FloatArray, direction: FloatArray, *, center: FloatArray, radius: float) -> FloatArray:
    """Return the distances to a sphere from a point outside it.

    With D the vector to the centre, b = D·w and p = D − bw the way from the ray to the centre across it, half
    the chord is h = √((r − |p|)(r + |p|)), and the nearer end is at (|D| − r)(|D| + r)/(b + h): p is small
    where D is large, and no sum has terms of different signs but those that are data.

    Source: Haines, Günther, Akenine-Möller (2019), Precision Improvements for Ray/Sphere Intersection, Ray
    Tracing Gems, chapter 7, doi:10.1007/978-1-4842-4427-2_7.

    >>> to_sphere(np.zeros(3), np.array([[0.0, 0.0, 1.0]]), center=np.array([0.0, 0.0, 3.0]), radius=1.0)
    array([2.])
    """
    to_center = center - origin
    distance = np.hypot(np.hypot(to_center[0], to_center[1]), to_center[2])
    along = direction @ to_center
    across = to_center - along[:, None] * direction
    off = np.hypot(np.hypot(across[:, 0], across[:, 1]), across[:, 2])
    met = (along > 0) & (off <= radius)
    half = np.sqrt(np.where(met, (radius - off) * (radius + off), 0.0))
    found = (distance - radius) * (distance + radius) / np.where(met, along + half, 1.0)
    return np.where(met, found, np.inf)


def to_plane(
    origin: FloatArray, direction: FloatArray, *, point: FloatArray, normal: FloatArray
) -> FloatArray:
    """Return the distances to a plane.

    >>> down = np.array([[0.0, 0.6, -0.8], [0.0, 0.6, 0.8]])
    >>> to_plane(np.array([0.0, 0.0, 4.0]), down, point=np.zeros(3), normal=np.array([0.0, 0.0, 1.0]))
    array([ 5., inf])
    """
    height, slope = float((point - origin) @ normal), direction @ normal
    with np.errstate(divide="ignore", invalid="ignore"):
        found = height / slope
    return np.where((slope != 0) & (found > 0), found, np.inf)


def through_box(
    origin: FloatArray, direction: FloatArray, *, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, FloatArray, npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Return the distances at which rays enter and leave a box, and the faces where they do.

    Faces are counted −x, +x, −y, +y, −z, +z from 0. Both distances are infinite where the ray misses; that of
    entering is below 0 from inside.

    >>> corners = {"low": np.zeros(3), "high": np.ones(3)}
    >>> enter, leave, first, last = through_box(
    ...     np.array([0.5, -1.0, 0.5]), np.array([[0.0, 1.0, 0.0]]), **corners
    ... )
    >>> enter.tolist(), leave.tolist(), first.tolist(), last.tolist()
    ([1.0], [2.0], [2], [3])
    """
    upward = direction > 0
    near_end, far_end = np.where(upward, low, high), np.where(upward, high, low)
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (near_end - origin) / direction, (far_end - origin) / direction
    level = direction == 0  # along the slab: within it for ever, or never
    within = (origin >= low) & (origin <= high)
    near = np.where(level, np.where(within, -np.inf, np.inf), near)
    far = np.where(level, np.where(within, np.inf, -np.inf), far)
    first, last = np.argmax(near, axis=1), np.argmin(far, axis=1)
    rows = np.arange(len(direction))
    enter, leave = near[rows, first], far[rows, last]
    met = (enter <= leave) & (leave > 0)
    faces = (2 * first + ~upward[rows, first], 2 * last + upward[rows, last])
    return np.where(met, enter, np.inf), np.where(met, leave, np.inf), *faces
