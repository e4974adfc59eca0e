"""Outline: flat polygons as such: what a proper one is, its area, and its division into triangles."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import dot
from radiokit.facts.errors import ParameterError

__all__ = ["area_vector", "check_outline", "triangulate"]

FloatArray = npt.NDArray[np.float64]

FLATNESS = 1e-9
"""How far a vertex may be off the plane, relative to the polygon's size."""


def area_vector(vertices: FloatArray) -> FloatArray:
    """Return the normal of a polygon (N, 3), counter-clockwise seen from its tip, as long as the area [m²].

    >>> area_vector(np.array([[0.0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]])).tolist()
    [0.0, 0.0, 6.0]
    """
    d = vertices - vertices[0]
    total: FloatArray = 0.5 * np.cross(d[1:-1], d[2:]).sum(axis=0)
    return total


def check_outline(name: str, value: Any) -> tuple[tuple[float, float, float], ...]:
    """Return a polygon's vertices as tuples of floats, once they are known to bound a flat, simple polygon.

    Parameters
    ----------
    name : str
        What the error message calls the argument.
    value : array_like, shape (N, 3)
        [m], N at least 3.

    Raises
    ------
    ParameterError
        When they do not; it names the vertex: not finite, equal to the one before it, off the plane by more
        than 1e-9 of the size, or at an edge that turns back or meets another one.

    >>> check_outline("vertices", [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 2, 0]])
    Traceback (most recent call last):
    ...
    radiokit.facts.errors.ParameterError: vertices[0] = (0.0, 0.0, 0.0) is not allowed: it must be the start \
of an edge that meets no other; it meets the one from vertices[2]
    """
    allowed = "an array of shape (N, 3), with N at least 3 vertices"
    try:
        points = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError(name, value, allowed) from None
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 3:
        raise ParameterError(name, value, allowed)

    def refuse(k: int, what: str) -> None:
        raise ParameterError(f"{name}[{k}]", tuple(points[k].tolist()), what)

    for k in np.flatnonzero(~(np.abs(points) <= 1e100).all(axis=1)):
        refuse(int(k), "three finite numbers of at most 1e100")
    size = float(np.ptp(points, axis=0).max())
    unit = (points - points[0]) / size if size >= 1e-100 else np.zeros_like(points)
    edges = np.roll(unit, -1, axis=0) - unit
    for k in np.flatnonzero(~edges.any(axis=1)):
        refuse((int(k) + 1) % len(points), f"another point than {name}[{k}], and at least 1e-100 m from it")
    normal = area_vector(unit)
    area = float(np.sqrt(dot(normal, normal)))
    if area < 1e-14:
        raise ParameterError(name, points.tolist(), "vertices around an area that is not 0")
    normal /= area
    height = np.abs(dot(unit, normal))
    if height.max() > FLATNESS:
        refuse(
            int(np.argmax(height)), f"in the plane of the others, within {FLATNESS:g} of the polygon's size"
        )
    x, y = _flat(unit, normal).T
    turn = edges - np.roll(edges, 1, axis=0)
    back = (dot(edges, np.roll(edges, 1, axis=0)) < 0) & (_lengths(np.cross(edges, turn)) == 0)
    for k in np.flatnonzero(back):
        refuse(int(k), "a corner: the edges on its sides lie on each other")
    n = len(points)
    for i in range(n):
        for j in range(i + 2, n - (i == 0)):
            if _meet(x, y, i, (i + 1) % n, j, (j + 1) % n):
                refuse(i, f"the start of an edge that meets no other; it meets the one from {name}[{j}]")
    return tuple((a, b, c) for a, b, c in points.tolist())


def triangulate(vertices: FloatArray) -> npt.NDArray[np.intp]:
    """Return the corners' indices (T, 3) of triangles that make up a simple polygon (N, 3).

    Source: Meisters (1975), Polygons have ears, doi:10.2307/2319703.

    >>> triangulate(np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 0.5, 0]])).tolist()
    [[3, 0, 1], [1, 2, 3]]
    """
    sides = vertices - vertices[0]
    sides = sides / np.abs(sides).max()
    normal = area_vector(sides)
    x, y = _flat(sides, normal / _lengths(normal)).T
    rest, found = list(range(len(vertices))), []
    while len(rest) > 3:
        corners = list(zip(rest[-1:] + rest[:-1], rest, rest[1:] + rest[:1], strict=True))
        ears = [c for c in corners if _is_ear(x, y, c, rest)]
        # The shortest diagonal makes the stoutest triangles; what has no ear by rounding is cut anyhow.
        a, b, c = min(ears or corners, key=lambda t: np.hypot(x[t[2]] - x[t[0]], y[t[2]] - y[t[0]]))
        found.append((a, b, c))
        rest.remove(b)
    found.append((rest[0], rest[1], rest[2]))
    return np.array([t for t in found if _side(x, y, *t) > 0], dtype=np.intp)


def _flat(points: FloatArray, normal: FloatArray) -> FloatArray:
    """Return coordinates (N, 2) in the plane, right-handed as seen from the normal's tip."""
    drop = int(np.argmax(np.abs(normal)))
    first, second = points[:, (drop + 1) % 3], points[:, (drop + 2) % 3]
    return np.stack((first, second) if normal[drop] > 0 else (second, first), axis=-1)


def _side(x: FloatArray, y: FloatArray, i: int, j: int, k: int) -> float:
    """Return twice the signed area of a triangle: above 0 when it turns left."""
    return float((x[j] - x[i]) * (y[k] - y[i]) - (x[k] - x[i]) * (y[j] - y[i]))


def _is_ear(x: FloatArray, y: FloatArray, corner: tuple[int, int, int], rest: list[int]) -> bool:
    i, j, k = corner
    if _side(x, y, i, j, k) < 0:
        return False
    others = [p for p in rest if p not in corner]
    return not any(
        _side(x, y, i, j, p) >= 0 and _side(x, y, j, k, p) >= 0 and _side(x, y, k, i, p) >= 0 for p in others
    )


def _meet(x: FloatArray, y: FloatArray, a: int, b: int, c: int, d: int) -> bool:
    """Return whether the segments a b and c d have a point in common."""
    if max(x[a], x[b]) < min(x[c], x[d]) or max(x[c], x[d]) < min(x[a], x[b]):
        return False
    if max(y[a], y[b]) < min(y[c], y[d]) or max(y[c], y[d]) < min(y[a], y[b]):
        return False
    first = np.sign(_side(x, y, a, b, c)) * np.sign(_side(x, y, a, b, d))
    second = np.sign(_side(x, y, c, d, a)) * np.sign(_side(x, y, c, d, b))
    return bool(first <= 0 and second <= 0)


def _lengths(v: FloatArray) -> Any:
    return np.sqrt(dot(v, v))
