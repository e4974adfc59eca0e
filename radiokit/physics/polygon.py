"""Polygons as light: the solid angle that one subtends, and the irradiance of one of radiance 1.

A polygon is an array (N, 3) of vertices in world coordinates [m], counter-clockwise as seen from its front.
It may be concave. Lambert's sum over its edges cancels where it is small, thin or seen at grazing angles.
What float64 cannot vouch for is evaluated again, at the precision that it takes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import dot
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source
from radiokit.measure.twin import working_precision

__all__ = [
    "IRRADIANCE_SOURCE",
    "SOLID_ANGLE_SOURCE",
    "above",
    "cross",
    "inner",
    "irradiance",
    "refined",
    "seen_from",
    "solid_angle",
]

FloatArray = npt.NDArray[np.float64]

SOLID_ANGLE_SOURCE = Source(
    authors="van Oosterom, Strackee",
    year=1983,
    title="The Solid Angle of a Plane Triangle. IEEE Transactions on Biomedical Engineering 30(2)",
    doi="10.1109/TBME.1983.325207",
    equation="equation 8",
)
IRRADIANCE_SOURCE = Source(
    authors="Arvo",
    year=1994,
    title="The Irradiance Jacobian for Partially Occluded Polyhedral Sources",
    doi="10.1145/192161.192250",
    equation="equation 2, Lambert's formula",
)

DIGITS = (32, 64, 128, 256, 512, 1024, 2048)
"""Digits tried in turn where float64 has too few."""

TRUSTED = 2.0**-45
"""Relative bound up to which the float64 result stands."""

_EPS = float(np.finfo(float).eps)
_NOTHING = 2.0**-1080  # rounds to 0


def solid_angle(vertices: FloatArray, position: FloatArray) -> Estimate:
    """Return the solid angle [sr] of a polygon's front, in [0, 2π]; 0 from behind and from within its plane.

    For each triangle of a fan, tan(Ω/2) = a·(b × c) / (abc + (a·b)c + (b·c)a + (c·a)b), quadrant included.

    Parameters
    ----------
    vertices : ndarray, shape (N, 3)
        [m]
    position : ndarray, shape (3,)
        Of the receiver [m], not on the polygon.

    >>> face = np.array([[-1.0, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]])  # of a cube, from its centre
    >>> round(float(solid_angle(face, np.zeros(3)).value) / np.pi, 14)
    0.66666666666667
    """
    v, d = _scaled(vertices, position)
    r = np.sqrt(dot(v, v))
    r0, v0, r1, v1, r2, v2 = r[0], v[0], r[1:-1], v[1:-1], r[2:], v[2:]
    det = dot(np.cross(d[1:-1], d[2:]), v0)
    volume = r0 * r1 * r2
    below = volume + dot(v1, v0) * r2 + dot(v2, v0) * r1 + dot(v1, v2) * r0
    square = det * det + below * below
    spans = _lengths(d)
    doubt = 8 * _EPS * r0 * spans[1:-1] * spans[2:]
    if square.min() > 0:
        value = -2 * float(np.sum(np.arctan2(det, below)))
        error = (doubt * np.abs(below) + 8 * _EPS * volume * np.abs(det)) / square
        bound = 2 * float(np.sum(error)) + 4 * _EPS * float(np.sum(np.abs(np.arctan2(det, below))))
        if bound <= TRUSTED * abs(value):
            return (
                Estimate(value, bound, "rounding", method="closed form")
                if value > 0
                else rounding(0.0, ulps=0)
            )
    if _in_plane(vertices, position):
        return rounding(0.0, ulps=0)

    def precisely() -> tuple[Any, Any]:
        import mpmath

        points = seen_from(vertices, position)
        lengths = [mpmath.sqrt(inner(p, p)) for p in points]
        a, ra = points[0], lengths[0]
        total, size = mpmath.mpf(0), mpmath.mpf(0)
        for b, c, rb, rc in zip(points[1:], points[2:], lengths[1:], lengths[2:], strict=False):
            above = inner(a, cross(b, c))
            volume = ra * rb * rc
            under = volume + inner(a, b) * rc + inner(b, c) * ra + inner(c, a) * rb
            total -= 2 * mpmath.atan2(above, under)
            size += volume / mpmath.hypot(above, under) + 1
        return total, 64 * mpmath.eps * size

    return refined(precisely)


def irradiance(vertices: FloatArray, position: FloatArray, normal: FloatArray) -> Estimate:
    """Return the irradiance [sr] that a polygon of radiance 1, shining from its front, brings to a receiver.

    Lambert's formula, E = ½ Σ θ n·γ over the edges of what is above the horizon, with θ the angle that an
    edge subtends and γ the unit normal of the plane through it and the receiver.

    Parameters
    ----------
    vertices : ndarray, shape (N, 3)
        [m]
    position : ndarray, shape (3,)
        Of the receiver [m], not on the polygon.
    normal : ndarray, shape (3,)
        Of the receiver, a unit vector.

    >>> square = np.array([[-1.0, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]])
    >>> up = np.array([0.0, 0.0, 1.0])
    >>> exact = 2 * np.sqrt(2) * np.arctan(1 / np.sqrt(2))
    >>> bool(abs(irradiance(square, np.zeros(3), up).value - exact) < 1e-15)
    True
    """
    v, d = _scaled(vertices, position)
    r = np.sqrt(dot(v, v))
    height = dot(v, normal)
    if np.all(height < -8 * _EPS * r):
        return rounding(0.0, ulps=0)
    if np.all(height > 8 * _EPS * r):
        value, bound = _whole(v, d, r, normal)
        if bound <= TRUSTED * abs(value):
            return (
                Estimate(value, bound, "rounding", method="closed form")
                if value > 0
                else rounding(0.0, ulps=0)
            )
    if _in_plane(vertices, position):
        return rounding(0.0, ulps=0)

    def precisely() -> tuple[Any, Any]:
        import mpmath

        up = [mpmath.mpf(float(x)) for x in normal]
        points = above(seen_from(vertices, position), up)
        total, count = mpmath.mpf(0), len(points)
        for a, b in zip(points, points[1:] + points[:1], strict=True):
            across = cross(a, b)
            length = mpmath.sqrt(inner(across, across))
            if length:
                total -= mpmath.atan2(length, inner(a, b)) * inner(across, up) / length / 2
        return total, 64 * count * mpmath.eps

    return refined(precisely)


def _whole(v: FloatArray, d: FloatArray, r: FloatArray, normal: FloatArray) -> tuple[float, float]:
    """Return Lambert's sum of a polygon above the horizon, in float64, and a bound on its error.

    With unit vectors u and θ = sinθ + (θ − sinθ), the sum of all u × u' is that of (u − u₀) × (u' − u₀): for
    a small polygon nothing cancels in it, and what is left is of third order.
    """
    u = v / r[:, None]
    chords = (d - u[0] * (dot(d, v + v[0]) / (r + r[0]))[:, None]) / r[:, None]  # u − u₀
    spans = _lengths(d) / r
    flat = np.cross(chords[1:-1], chords[2:]).sum(axis=0)
    step = np.roll(d, -1, axis=0) - d
    after, next_r = np.roll(v, -1, axis=0), np.roll(r, -1)
    across = np.cross(v, step)
    sine, cosine = _lengths(across), dot(v, after)
    theta = np.arctan2(sine, cosine)
    excess = _excess(theta)
    round_part = (excess / (r * next_r)) @ across
    value = -0.5 * float((flat + round_part) @ normal)
    edge = _lengths(step) / next_r
    loose = (spans + np.roll(spans, -1)) * r / np.minimum(r, next_r)  # of the differences of vertices
    size = 3 * np.sum(spans[1:-1] * spans[2:]) + np.sum((excess + theta**2) * (edge + loose))
    return value, 2 * _EPS * float(size)


def _excess(theta: FloatArray) -> FloatArray:
    """Return θ/sinθ − 1 for θ in [0, π)."""
    square = theta * theta
    series = np.zeros_like(theta)
    for k in range(9, 0, -1):  # (θ − sinθ)/θ = θ²/3! − θ⁴/5! + …
        series = square / ((2 * k) * (2 * k + 1)) * (1 - series)
    small = series / (1 - series)
    sine = np.sin(theta)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(theta < 1.0, small, (theta - sine) / sine)


# --- at any precision ---


def refined(compute: Callable[[], tuple[Any, Any]], digits: tuple[int, ...] = DIGITS) -> Estimate:
    """Return what ``compute`` gives with a bound, at rising precision until all of float64 is right.

    ``compute`` is called within mpmath's working precision. A negative value, that of a light which faces
    away, becomes 0.
    """
    for places in digits:
        with working_precision(places):
            value, bound = compute()
            enough = bound <= abs(value) * 2**-56 or abs(value) + bound < _NOTHING
            if enough or places == digits[-1]:
                nearest = max(0.0, float(value))
                spread = 0.0 if value < 0 else float(bound)
                break
    error = spread + (float(np.spacing(nearest)) if nearest else 0.0)
    return Estimate(nearest, error, "rounding", method="closed form")


def seen_from(vertices: FloatArray, position: FloatArray) -> list[list[Any]]:
    """Return the vertices relative to the receiver, as mpmath numbers of the working precision."""
    import mpmath

    origin = [mpmath.mpf(float(x)) for x in position]
    return [[mpmath.mpf(float(x)) - p for x, p in zip(v, origin, strict=True)] for v in vertices]


def above(points: list[list[Any]], normal: Any) -> list[list[Any]]:
    """Return the part of a polygon with p·n ≥ 0, for any type of number; empty where nothing is above.

    Source: Sutherland, Hodgman (1974), Reentrant polygon clipping, doi:10.1145/360767.360802. A concave
    polygon that falls apart keeps edges to and fro along the cut, which cancel in every integral along the
    boundary.

    >>> above([[1, 0, 1], [-1, 0, 1], [0, 0, -1]], [0, 0, 1])
    [[0.5, 0.0, 0.0], [1, 0, 1], [-1, 0, 1], [-0.5, 0.0, 0.0]]
    """
    heights = [inner(p, normal) for p in points]
    if not any(h > 0 for h in heights):
        return []
    found = []
    for k, (p, h) in enumerate(zip(points, heights, strict=True)):
        before, low = points[k - 1], heights[k - 1]
        if (low < 0 < h) or (h < 0 < low):
            share = low / (low - h)
            found.append([a + share * (b - a) for a, b in zip(before, p, strict=True)])
        if h >= 0:
            found.append(p)
    return found


def inner(a: Any, b: Any) -> Any:
    """Return the dot product of vectors of any type of number."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Any, b: Any) -> list[Any]:
    """Return the cross product of vectors of any type of number."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _scaled(vertices: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the vertices relative to the receiver and to the first of them, over a power of two."""
    v, d = vertices - position, vertices - vertices[0]
    exponent = -math.frexp(float(np.abs(v).max()))[1]
    return np.ldexp(v, exponent), np.ldexp(d, exponent)


def _lengths(v: FloatArray) -> FloatArray:
    length: FloatArray = np.sqrt(dot(v, v))
    return length


def _in_plane(vertices: FloatArray, position: FloatArray) -> bool:
    """Return whether a receiver lies in the planes of all triangles of the fan, without any rounding."""
    origin = [Fraction(float(x)) for x in position]
    a, *rest = [[Fraction(float(x)) - p for x, p in zip(v, origin, strict=True)] for v in vertices]
    return all(inner(a, cross(b, c)) == 0 for b, c in pairwise(rest))
