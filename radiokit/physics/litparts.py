"""Lit parts: what polygons leave of a polygon or a sky, as convex cones in rational numbers; its light."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.estimate import Estimate, rounding
from radiokit.measure.clip import Cone, clipped, has_area, hemisphere, sides, without
from radiokit.measure.exact import rational
from radiokit.physics.eclipse import Dome, before
from radiokit.physics.facets import Facets
from radiokit.physics.polygon import cross, inner, refined

__all__ = ["above", "cones_irradiance", "cones_solid_angle", "corners", "joined", "lit_parts"]

FloatArray = npt.NDArray[np.float64]


def lit_parts(light: Facets | Dome, bodies: Sequence[Facets], normal: FloatArray) -> list[Cone]:
    """Return convex cones that make up what a receiver sees of a light, above its horizon, behind polygons.

    >>> up, sky = np.array([0.0, 0.0, 1.0]), Dome()
    >>> wall = Facets.seen(np.array([[-1.0, -1, 2], [-1, 1, 2], [1, 1, 2], [1, -1, 2]]), (0, 0, 0))
    >>> hidden = cones_irradiance(lit_parts(sky, [], up), up).value
    >>> hidden -= cones_irradiance(lit_parts(sky, [wall], up), up).value
    >>> bool(abs(hidden - wall.irradiance(up).value) < 1e-14)
    True
    """
    if isinstance(light, Dome):
        cones = hemisphere(rational(normal))
        for plane in light.normals:
            cones = [clipped(cone, plane) for cone in cones]
    else:
        cones = list(light.parts)
    cones = above(cones, normal)
    for body in bodies:
        for part in before(body, light):
            planes = sides(part)
            cones = [rest for cone in cones for rest in without(cone, planes)]
    return cones


def joined(bodies: Sequence[Facets]) -> list[Cone]:
    """Return convex cones that make up what polygons cover together."""
    found: list[Cone] = []
    for body in bodies:
        for part in body.parts:
            fresh = [part]
            for cone in found:
                fresh = [rest for piece in fresh for rest in without(piece, sides(cone))]
            found += fresh
    return found


def above(cones: Sequence[Cone], normal: FloatArray) -> list[Cone]:
    """Return the parts of convex cones that are above a receiver's horizon."""
    horizon = rational(normal)
    kept = (clipped(cone, horizon) for cone in cones)
    return [cone for cone in kept if len(cone) > 2 and has_area(cone)]


def cones_irradiance(cones: Sequence[Cone], normal: FloatArray) -> Estimate:
    """Return E/L [sr] of convex cones above the horizon: Lambert's sum over their sides, at rising precision.

    Every cone's part is at least 0, so that nothing cancels however little is left.
    """
    if not cones:
        return rounding(0.0, ulps=0)

    def precisely() -> tuple[Any, Any]:
        import mpmath

        up = [mpmath.mpf(float(x)) for x in normal]
        total, count = mpmath.mpf(0), 0
        for points in map(_precise, cones):
            for a, b in zip(points[-1:] + points[:-1], points, strict=True):
                across = cross(a, b)
                length = mpmath.sqrt(inner(across, across))
                if length:
                    total += mpmath.atan2(length, inner(a, b)) * inner(across, up) / length / 2
                count += 1
        return total, 64 * count * mpmath.eps

    return refined(precisely)


def cones_solid_angle(cones: Sequence[Cone]) -> Estimate:
    """Return the solid angle [sr] of convex cones, by fans of triangles.

    >>> round(float(cones_solid_angle(hemisphere(rational((0.6, 0.0, 0.8)))).value) / np.pi, 14)
    2.0
    """
    if not cones:
        return rounding(0.0, ulps=0)

    def precisely() -> tuple[Any, Any]:
        import mpmath

        total, size = mpmath.mpf(0), mpmath.mpf(0)
        for points in map(_precise, cones):
            lengths = [mpmath.sqrt(inner(p, p)) for p in points]
            a, ra = points[0], lengths[0]
            for b, c, rb, rc in zip(points[1:], points[2:], lengths[1:], lengths[2:], strict=False):
                above = inner(a, cross(b, c))
                volume = ra * rb * rc
                under = volume + inner(a, b) * rc + inner(b, c) * ra + inner(c, a) * rb
                total += 2 * mpmath.atan2(above, under)
                size += volume / mpmath.hypot(above, under) + 1
        return total, 64 * mpmath.eps * size

    return refined(precisely)


def corners(cone: Cone) -> FloatArray:
    """Return a cone's corners (N, 3) as floats of about length 1."""
    largest = [max(map(abs, p)) for p in cone]
    return np.array([[float(x / size) for x in p] for p, size in zip(cone, largest, strict=True)])


def _precise(cone: Cone) -> list[list[Any]]:
    return [[_number(x, max(map(abs, p))) for x in p] for p in cone]


def _number(x: Any, size: Any) -> Any:
    import mpmath

    share = x / size
    return mpmath.mpf(share.numerator) / share.denominator
