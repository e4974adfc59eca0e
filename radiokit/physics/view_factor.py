"""View factors: the share of a diffuse surface's flux that reaches another, in forms that do not cancel.

``F`` of one surface to another is the share of what leaves the first, diffusely, that arrives at the second;
``differential_to_...`` is that of a small element, and so the irradiance in it over π times the radiance of
the other. All parameters are keywords, lengths in any one unit, and arrays broadcast.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject
from radiokit.physics.cap import cap_irradiance
from radiokit.physics.lengths import (
    HOWELL,
    Orientation,
    at_least_zero,
    check_orientation,
    positive,
    spread,
)
from radiokit.physics.rectangles import (
    differential_to_rectangle,
    parallel_rectangles,
    perpendicular_rectangles,
)

__all__ = [
    "HOWELL",
    "differential_to_disk",
    "differential_to_rectangle",
    "differential_to_sphere",
    "disk_to_sphere",
    "parallel_disks",
    "parallel_rectangles",
    "perpendicular_rectangles",
    "sphere_to_disk",
]


def parallel_disks(*, radius1: npt.ArrayLike, radius2: npt.ArrayLike, distance: npt.ArrayLike) -> Any:
    """Return F from a disk to another, parallel one on the same axis.

    With p and q the shortest and longest ways from edge to edge, F = (2 r₂/(p + q))². That is the catalogue's
    [X − √(X² − 4(r₂/r₁)²)]/2 with X = 1 + (h² + r₂²)/r₁², whose difference has no digits left far away.

    Parameters
    ----------
    radius1, radius2 : array_like
        Above 0.
    distance : array_like
        h, at least 0.

    Raises
    ------
    ParameterError
        When a length is not allowed.

    Source: Howell's catalogue, C-41.

    >>> round(float(parallel_disks(radius1=1.0, radius2=1.0, distance=1.0)), 12)
    0.38196601125
    >>> far = float(parallel_disks(radius1=1.0, radius2=1.0, distance=1e9))
    >>> round(far * 1e18, 15)
    1.0
    """
    first, second = positive("radius1", radius1), positive("radius2", radius2)
    h = at_least_zero("distance", distance)
    share = 2 * second / (np.hypot(h, first - second) + np.hypot(h, first + second))
    return (share * share)[()]


def sphere_to_disk(*, radius: npt.ArrayLike, distance: npt.ArrayLike) -> Any:
    """Return F from a sphere to a disk whose axis passes through the sphere's centre, whatever its size.

    F = (1 − cosα)/2 = (sin(α/2))², with α the disk's half-angle from the sphere's centre.

    Parameters
    ----------
    radius : array_like
        The disk's, above 0.
    distance : array_like
        From the sphere's centre to the disk, at least 0; the sphere, of any radius up to it, does not count.

    Raises
    ------
    ParameterError
        When a length is not allowed.

    Source: Howell's catalogue, section C, "sphere to coaxial disk".

    >>> round(float(sphere_to_disk(radius=np.sqrt(3), distance=1.0)), 12)
    0.25
    """
    r, h = positive("radius", radius), at_least_zero("distance", distance)
    slant = np.hypot(r, h)
    return (0.5 * (r / slant) * (r / (slant + h)))[()]


def disk_to_sphere(
    *, disk_radius: npt.ArrayLike, sphere_radius: npt.ArrayLike, distance: npt.ArrayLike
) -> Any:
    """Return F from a disk to a sphere on its axis: 4(R/r)² times the factor back, by reciprocity.

    Parameters
    ----------
    disk_radius, sphere_radius : array_like
        Above 0.
    distance : array_like
        From the disk to the sphere's centre, at least the sphere's radius.

    Raises
    ------
    ParameterError
        When a length is not allowed, or the sphere reaches through the disk.

    Source: Howell's catalogue, section C, "disk to coaxial sphere".

    >>> round(float(disk_to_sphere(disk_radius=1e-6, sphere_radius=1.0, distance=2.0)), 9)  # (R/d)²
    0.25
    """
    r, ball = positive("disk_radius", disk_radius), positive("sphere_radius", sphere_radius)
    h = positive("distance", distance)
    reject("distance", *spread(h, h < ball), "at least sphere_radius")
    slant = np.hypot(r, h)
    return (2 * (ball / slant) * (ball / (slant + h)))[()]


def differential_to_disk(
    *,
    radius: npt.ArrayLike,
    distance: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
    orientation: Orientation = "parallel",
) -> Any:
    """Return F from an element to a disk, parallel to it or perpendicular.

    Parameters
    ----------
    radius, distance : array_like
        The disk's radius, and the element's distance from the disk's plane, above 0.
    offset : array_like
        The element's distance from the disk's axis, at least 0.
    orientation : {"parallel", "perpendicular"}
        Of the element: facing the disk's plane, or the disk's axis; then it must see the whole disk, so
        ``offset`` is at least ``radius``.

    Raises
    ------
    ParameterError
        When a length or the orientation is not allowed.

    Source: Howell's catalogue, B-12 on the axis and B-13 off it; the perpendicular one by the contour
    integral of the same edge.

    >>> float(differential_to_disk(radius=1.0, distance=1.0))
    0.5
    """
    check_orientation(orientation)
    r, a, b = (
        positive("radius", radius),
        positive("distance", distance),
        at_least_zero("offset", offset),
    )
    nearest, farthest = np.hypot(a, b - r), np.hypot(a, b + r)
    if orientation == "perpendicular":
        reject("offset", *spread(b, b < r), "at least radius, for an element that faces the axis")
        middle = 0.5 * (nearest + farthest)
        return ((a / nearest) * (b / farthest) * (r / middle) ** 2)[()]
    # F = sin² of half the angle of the disk in the plane of offset: (1 − cos)/2, or by the sine.
    product = nearest * farthest
    sine, cosine = 2 * (a / nearest) * (r / farthest), ((a / product) * a + (b - r) / product * (b + r))
    near = 0.5 * (1 - cosine)
    far = 0.5 * sine * (sine / (1 + np.maximum(cosine, 0.0)))
    return np.where(cosine > 0, far, near)[()]


def differential_to_sphere(
    *, radius: npt.ArrayLike, distance: npt.ArrayLike, tilt: npt.ArrayLike = 0.0
) -> Any:
    """Return F from an element to a sphere, of which its horizon may hide a part.

    (R/d)² cosθ, where the whole sphere is above the element's horizon.

    Parameters
    ----------
    radius : array_like
        Above 0.
    distance : array_like
        From the element to the sphere's centre, above ``radius``.
    tilt : array_like
        θ between the element's normal and the way to the centre [rad], in [0, π].

    Raises
    ------
    ParameterError
        When a length or the tilt is not allowed.

    Source: Howell's catalogue, section B, "planar element to sphere"; ``CAP_SOURCE`` for a cut one.

    >>> float(differential_to_sphere(radius=1.0, distance=2.0))
    0.25
    """
    ball, d = positive("radius", radius), positive("distance", distance)
    reject("distance", *spread(d, d <= ball), "above radius")
    theta = numbers("tilt", tilt, "an angle in [0, pi] radians")
    reject("tilt", theta, ~((theta >= 0) & (theta <= np.pi)), "an angle in [0, pi] radians")
    return np.vectorize(_tilted_sphere, otypes=[float])(ball, d, theta)[()]


def _tilted_sphere(ball: float, d: float, theta: float) -> float:
    sine, height, offset = ball / d, float(np.cos(theta)), float(np.sin(theta))
    cosine = float(np.sqrt(((d - ball) / d) * ((d + ball) / d)))
    shown = abs(height)
    if shown >= sine:
        return sine * sine * max(height, 0.0)
    hidden = float(np.sqrt((sine - shown) * (sine + shown)))
    angle = float(np.arctan2(hidden, cosine * shown))
    turn = float(np.arctan2(hidden, cosine))
    share = cap_irradiance(
        sine=sine, cosine=cosine, height=height, offset=offset, angle=angle, half_azimuth=turn
    )
    return share / float(np.pi)
