"""View factors: the share of a diffuse surface's flux that reaches another, in forms that do not cancel.

``F`` of one surface to another is the share of what leaves the first, diffusely, that arrives at the second;
``differential_to_...`` is that of a small element, and so the irradiance in it over π times the radiance of
the other. All parameters are keywords, lengths in any one unit, and arrays broadcast.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.physics.cap import cap_irradiance

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

FloatArray = npt.NDArray[np.float64]
Orientation = Literal["parallel", "perpendicular"]

HOWELL = Source(
    authors="Howell, Mengüç, Daun, Siegel",
    year=2020,
    title="Thermal Radiation Heat Transfer, 7th edition; and Howell's Catalog of Configuration Factors",
    doi="10.1201/9780429327308",
    equation="the catalogue's number stands with each function",
    errata="as printed, C-11, C-14, C-41 and the sphere's factors cancel for small or distant surfaces",
)

_X, _W = (0.5 * (x + shift) for x, shift in zip(np.polynomial.legendre.leggauss(20), (1.0, 0.0), strict=True))
_PANELS = 32
_FAR = 40.0  # beyond sinh 40 the rest of the integral is 1e-17 of it


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
    first, second = _positive("radius1", radius1), _positive("radius2", radius2)
    h = _length("distance", distance)
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
    r, h = _positive("radius", radius), _length("distance", distance)
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
    r, ball = _positive("disk_radius", disk_radius), _positive("sphere_radius", sphere_radius)
    h = _positive("distance", distance)
    reject("distance", *_where(h, h < ball), "at least sphere_radius")
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
    _orientation(orientation)
    r, a, b = _positive("radius", radius), _positive("distance", distance), _length("offset", offset)
    nearest, farthest = np.hypot(a, b - r), np.hypot(a, b + r)
    if orientation == "perpendicular":
        reject("offset", *_where(b, b < r), "at least radius, for an element that faces the axis")
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
    ball, d = _positive("radius", radius), _positive("distance", distance)
    reject("distance", *_where(d, d <= ball), "above radius")
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


def differential_to_rectangle(
    *,
    width: npt.ArrayLike,
    length: npt.ArrayLike,
    distance: npt.ArrayLike,
    orientation: Orientation = "parallel",
) -> Any:
    """Return F from an element to a rectangle with one corner opposite the element.

    Parameters
    ----------
    width, length : array_like
        The rectangle's sides, above 0. A perpendicular element lies in the plane through the side ``length``
        across to it, so that its normal is along ``width``.
    distance : array_like
        From the element to that corner, above 0, square to the rectangle.
    orientation : {"parallel", "perpendicular"}
        Of the element, to the rectangle.

    Raises
    ------
    ParameterError
        When a length or the orientation is not allowed.

    Source: Howell's catalogue, B-3 (parallel) and B-4 (perpendicular).

    >>> round(
    ...     float(differential_to_rectangle(width=1e9, length=1e9, distance=1.0)), 9
    ... )  # a quarter of the sky
    0.25
    """
    _orientation(orientation)
    a, b, c = _positive("width", width), _positive("length", length), _positive("distance", distance)
    if orientation == "parallel":
        first, second = np.hypot(a, c), np.hypot(b, c)
        total = a / first * np.arctan2(b, first) + b / second * np.arctan2(a, second)
        return (total / (2 * np.pi))[()]
    # atan(b/c) − (c/ρ) atan(b/ρ), ρ² = a² + c²: the difference of angles, and 1 − c/ρ, each as one quotient
    far = np.hypot(a, c)
    beyond = a * (a / (far + c))  # ρ − c
    angle = np.arctan2(b * (beyond / far), c + b * (b / far))
    return ((angle + beyond / far * np.arctan2(b, far)) / (2 * np.pi))[()]


def parallel_rectangles(*, width: npt.ArrayLike, length: npt.ArrayLike, distance: npt.ArrayLike) -> Any:
    """Return F from a rectangle to its equal, directly opposite.

    The catalogue's logarithm and four arcus tangents are G(X, Y) with ∂²G/∂X² = Y atan(Y/c)/c³, c² = 1 + x²,
    so that F = 2/(πX) ∫₀^X (X − x) atan(Y/c)/c³ dx, of positive terms, is summed in asinh x.

    Parameters
    ----------
    width, length, distance : array_like
        Above 0.

    Raises
    ------
    ParameterError
        When a length is not allowed.

    Source: Howell's catalogue, C-11.

    >>> round(float(parallel_rectangles(width=1.0, length=1.0, distance=1.0)), 12)
    0.199824895698
    """
    a, b, c = _positive("width", width), _positive("length", length), _positive("distance", distance)
    x, y = np.broadcast_arrays(a / c, b / c)
    x, y = np.maximum(x, y)[..., None], np.minimum(x, y)[..., None]
    end = np.arcsinh(x)
    last = np.minimum(end, _FAR)
    share = ((np.arange(_PANELS)[:, None] + _X) / _PANELS).ravel()
    weight = np.tile(_W, _PANELS) / _PANELS
    xi = last * share
    rest = (end - last) + last * (1 - share)
    cosh = np.cosh(xi)
    half = 0.5 * np.minimum(rest, 1.0)
    close = 2 * np.sinh(half) * np.cosh(xi + half) / x  # X − sinh ξ, from the difference of the arguments
    left = np.where(rest < 1.0, close, 1 - np.sinh(xi) / x)
    values = left * np.arctan2(y, cosh) / (cosh * cosh)
    return (2 / np.pi * last[..., 0] * np.sum(values * weight, axis=-1))[()]


def perpendicular_rectangles(*, edge: npt.ArrayLike, width: npt.ArrayLike, height: npt.ArrayLike) -> Any:
    """Return F from a rectangle to another, square to it, with which it shares an edge.

    Over the squared distance ρ from the edge in the plane across it, W F = 1/2π ∫ atan(1/ρ) s(ρ) dρ, with W
    and H the sides over the edge and s the difference of sin² at the ends of the arc of radius ρ within
    W × H: 1, then (min/ρ)², then (W² + H² − ρ²)/ρ². Every part is positive.

    Parameters
    ----------
    edge : array_like
        The common edge, above 0.
    width, height : array_like
        The other sides of the rectangle from which the flux comes, and of the one that it reaches, above 0.

    Raises
    ------
    ParameterError
        When a length is not allowed.

    Source: Howell's catalogue, C-14.

    >>> round(float(perpendicular_rectangles(edge=1.0, width=1.0, height=1.0)), 12)
    0.200043776075
    """
    e, w, h = _positive("edge", edge), _positive("width", width), _positive("height", height)
    wide, high = np.broadcast_arrays(w / e, h / e)
    low, top = np.minimum(wide, high), np.maximum(wide, high)
    corner = np.arctan2(1.0, low) + _log_part(low)
    between = low * _between(low, top)
    step = low * (low / (np.hypot(low, top) + top))  # from top to the diagonal
    rho = top[..., None] + step[..., None] * _X
    share = (1 - _X) * (step[..., None] / rho) * (1 + np.hypot(low, top)[..., None] / rho)
    beyond = step / low * np.sum(_W * np.arctan2(1.0, rho) * share, axis=-1)
    return (low / wide * (corner + between + beyond) / (2 * np.pi))[()]


def _log_part(low: FloatArray) -> FloatArray:
    """Return log(1 + m²)/2m."""
    square = np.log1p(np.minimum(low, 1e8) ** 2)
    return np.where(low < 1e8, square, 2 * np.log(low)) / (2 * low)


def _between(low: FloatArray, top: FloatArray) -> FloatArray:
    """Return ∫ atan(1/ρ)/ρ² dρ from ``low`` to ``top``."""
    step = (top - low)[..., None]
    rho = low[..., None] + step * _X
    near = np.sum(_W * np.arctan2(1.0, rho) / rho * (step / rho), axis=-1)
    return np.where(top < 3 * low, near, _primitive(low) - _primitive(top))


def _primitive(rho: FloatArray) -> FloatArray:
    """Return atan(1/ρ)/ρ − log(1 + 1/ρ²)/2."""
    inverse = 1 / rho
    square = np.log1p(np.minimum(inverse, 1e8) ** 2)
    return np.arctan2(1.0, rho) * inverse - 0.5 * np.where(inverse < 1e8, square, 2 * np.log(inverse))


def _orientation(orientation: str) -> None:
    if orientation not in ("parallel", "perpendicular"):
        raise ParameterError("orientation", orientation, "'parallel' or 'perpendicular'")


def _length(name: str, value: npt.ArrayLike) -> FloatArray:
    allowed = "a finite length, at least 0"
    array = numbers(name, value, allowed)
    reject(name, array, np.asarray(~((array >= 0) & np.isfinite(array))), allowed)
    return array


def _positive(name: str, value: npt.ArrayLike) -> FloatArray:
    allowed = "a finite length above 0"
    array = numbers(name, value, allowed)
    reject(name, array, np.asarray(~((array > 0) & np.isfinite(array))), allowed)
    return array


def _where(array: FloatArray, bad: Any) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return both in their common shape."""
    marked = np.asarray(bad)
    return np.broadcast_to(array, marked.shape), marked
