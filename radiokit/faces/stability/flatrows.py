"""Flat rows: the closed forms of lights with straight edges, and of the lobes that they are seen by."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from radiokit.contracts.emitter import Emitter, emitter
from radiokit.faces.stability import lighttruth as truth
from radiokit.faces.stability.lights import Case, LightRow
from radiokit.faces.stability.roundrows import generator, received
from radiokit.facts.directions import unit
from radiokit.physics.axial_moments import axial_moment, double_axis_moment
from radiokit.physics.cosine_lobe import lobe

__all__ = ["rows"]

_RANDOM = 16
_QUADRATURE = (54, 60, 75, 100)
_UP = (0.0, 0.0, 1.0)
_HERE = (0.0, 0.0, 0.0)
_TILTED = (0.6, 0.0, 0.8)


def rows() -> tuple[LightRow, ...]:
    """Return the rows."""
    lambert, girard = "Lambert's sum with arcs by acos", "Girard: the sum of the angles less (N − 2)π"
    found = []
    for name, cases in (("polygon", _polygons()), ("triangle", _triangles()), ("rectangle", _rectangles())):
        found += [
            LightRow(
                name=f"{name} irradiance",
                truth=lambert,
                kernel=lambda *x, name=name: received(_light(name, x[:-7], x[-7]), x[-6:-3], x[-3:]),
                exact=lambda *x, name=name: (
                    x[-7] * truth.lambert_sum(_corners(name, x[:-7]), x[-6:-3], x[-3:])
                ),
                textbook=lambda *x, name=name: x[-7] * _by_acos(_corners_of(name, x[:-7]), x[-6:-3], x[-3:]),
                cases=cases,
            ),
            LightRow(
                name=f"{name} solid angle",
                truth=girard,
                kernel=lambda *x, name=name: _light(name, x[:-3], 1.0).solid_angle(np.array(x[-3:])),
                exact=lambda *x, name=name: truth.angles_of_polygon(_corners(name, x[:-3]), x[-3:]),
                textbook=lambda *x, name=name: _angles(_corners_of(name, x[:-3]), x[-3:]),
                cases=tuple((label, (*x[:-7], *x[-6:-3])) for label, x in cases),
            ),
            LightRow(
                name=f"{name} flux",
                truth="πLA, by the length of half the sum of cross products",
                kernel=lambda *x, name=name: _light(name, x[:-1], x[-1]).flux(),
                exact=lambda *x, name=name: _flux(_corners(name, x[:-1]), x[-1]),
                cases=tuple((label, x[:-6]) for label, x in cases),
            ),
        ]
    return (
        *found,
        LightRow(
            name="axial moment",
            truth="rings about the axis, by quadrature in the azimuth",
            kernel=lambda *x: axial_moment(vertices=_points(x[:-4]), axis=x[-4:-1], exponent=int(x[-1])),
            exact=lambda *x: truth.moment(_points(x[:-4]), x[-4:-1], x[-1], None),
            cases=tuple((label, (*x[:-7], *x[-7:-3])) for label, x in _moments()),
            whole=1,
            digits=_QUADRATURE,
        ),
        LightRow(
            name="double-axis moment",
            truth="rings about the axis, by quadrature in the azimuth",
            kernel=lambda *x: double_axis_moment(
                vertices=_points(x[:-7]), axis=x[-7:-4], exponent=int(x[-4]), normal=x[-3:]
            ),
            exact=lambda *x: truth.moment(_points(x[:-7]), x[-7:-4], x[-4], x[-3:]),
            cases=_moments(),
            digits=_QUADRATURE,
        ),
        LightRow(
            name="cosine lobe",
            truth="(w·a)ⁿ of the normalised vectors",
            kernel=lambda *x: float(lobe(*x)),
            exact=lambda *x: max(truth.dot(truth.unit(x[:3]), truth.unit(x[3:6])), 0) ** x[6],
            textbook=lambda *x: max(sum(a * b for a, b in zip(x[:3], x[3:6], strict=True)), 0.0) ** x[6],
            cases=_lobes(),
        ),
    )


def _points(x: tuple[Any, ...]) -> list[truth.Vector]:
    return [x[k : k + 3] for k in range(0, len(x), 3)]


def _corners(name: str, x: tuple[Any, ...]) -> list[Any]:
    """Return the corners that a configuration's numbers are."""
    if name == "rectangle":
        return truth.rectangle_corners(x[:3], x[3:6], x[6], x[7], x[8:11])
    return _points(x)


def _corners_of(name: str, x: tuple[float, ...]) -> Any:
    return _light(name, x, 1.0).corners


def _light(name: str, x: tuple[float, ...], radiance: float) -> Any:
    if name == "rectangle":
        sides = {"width": x[6], "height": x[7]}
        return emitter(name, center=x[:3], normal=x[3:6], up=x[8:11], radiance=radiance, **sides)
    light: Emitter = emitter(name, vertices=_points(x), radiance=radiance)
    return light


def _flux(corners: list[Any], radiance: Any) -> Any:
    import mpmath

    first, total = corners[0], [mpmath.mpf(0)] * 3
    for b, c in pairwise(corners[1:]):
        part = truth.cross(truth.minus(b, first), truth.minus(c, first))
        total = [x + y / 2 for x, y in zip(total, part, strict=True)]
    return mpmath.pi * radiance * mpmath.sqrt(truth.dot(total, total))


def _by_acos(corners: Any, position: Any, normal: Any) -> float:
    """Return Lambert's sum in floats as it is printed."""
    points = truth.clipped([list(v) for v in np.array(corners) - position], normal)
    points = [p / np.linalg.norm(p) for p in np.array(points)]
    total = 0.0
    for a, b in zip(points, points[1:] + points[:1], strict=True):
        side = np.cross(a, b)
        arc = math.acos(min(1.0, max(-1.0, float(a @ b))))
        total -= arc * float(side @ normal) / float(np.linalg.norm(side)) / 2
    return max(total, 0.0)


def _angles(corners: Any, position: Any) -> float:
    points = [p / np.linalg.norm(p) for p in np.array(corners) - position]
    total = -(len(points) - 2) * math.pi
    for before, here, after in zip(points[-1:] + points[:-1], points, points[1:] + points[:1], strict=True):
        first, second = np.cross(here, before), np.cross(here, after)
        cosine = first @ second / np.linalg.norm(first) / np.linalg.norm(second)
        turn = math.acos(min(1.0, max(-1.0, float(cosine))))
        total += turn if here @ np.cross(first, second) >= 0 else 2 * math.pi - turn
    return total % (4 * math.pi)


def _case(label: str, points: Any, radiance: float, position: Any, normal: Any) -> Case:
    numbers = (*np.array(points, dtype=float).ravel().tolist(), radiance, *position, *normal)
    return label, tuple(map(float, numbers))


def _moved(points: Any, *shift: float) -> Any:
    return points + np.array(shift)


def _polygons() -> tuple[Case, ...]:
    """Vertices, radiance, position, normal."""
    square = np.array([[-1.0, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]])
    wall = np.array([[1.0, 1, 0], [1, -1, 0], [1, -1, 1], [1, 1, 1]])
    ell = np.array([(0.25, 2, 1), (1, 2, 1), (1, 1, 1), (2, 1, 1), (2, 0.125, 1), (0.25, 0.125, 1)])
    star = np.array([(3, 0, 1), (0.5, -0.5, 1), (0, -3, 1), (-0.5, -0.5, 1), (-3, 0, 1), (0, 2, 1)])
    shapes = [
        ("square", square, _HERE, _UP),
        ("square aslant", square, _HERE, _TILTED),
        ("square from elsewhere", _moved(square, 3.0, -2.0, 5.0), (3.125, -1.5, 5.25), _UP),
        ("tiny", square * [1e-8, 1e-8, 1], _HERE, _UP),
        ("tiny aside", _moved(square * [1e-8, 1e-8, 1], 0.75, 0.5, 0), _HERE, _TILTED),
        ("tiny, far from the origin", _moved(square * 2.0**-10, 1e6, 1.0, 2.0), (1e6 + 0.25, 1.0, 1.0), _UP),
        ("tiniest", square * [1e-90, 1e-90, 1], _HERE, _UP),
        ("far", _moved(square, 2e7, -1e7, 3e7), _HERE, _UP),
        ("huge", square * [1e8, 1e8, 1], _HERE, _UP),
        ("huge, cut", square * [1e8, 1e8, 1], _HERE, _TILTED),
        ("grazing", _moved(wall * [1, 1, 1e-8], 0, 0, 1e-8), _HERE, _UP),
        ("grazing and tiny", _moved(wall * [1, 1e-8, 1e-8], 0, 0, 1e-8), _HERE, _UP),
        ("an edge in the horizon", wall, _HERE, _UP),
        ("cut at its vertices", _moved(wall * [1, 1, 2], 0, 0, -1), _HERE, (0.0, 0.6, 0.8)),
        ("cut to a hair", _moved(wall, 0, 0, -1 + 2.0**-40), _HERE, _UP),
        ("all but a hair", _moved(wall * [1, 1, 2], 0, 0, -(2.0**-40)), _HERE, _UP),
        ("edge-on", square * [1, 1, 1e-12], _HERE, (0.96, 0.0, 0.28)),
        ("close to an edge", _moved(square, 1 + 2.0**-30, 0.25, -1 + 2.0**-30), _HERE, _TILTED),
        ("close to a corner", _moved(square, 1 + 2.0**-30, 1 + 2.0**-30, -1 + 2.0**-31), _HERE, _UP),
        ("from close by", _moved(square * [1, 1, 1e-9], 0.25, 0.125, 0), _HERE, _UP),
        ("ell", ell, _HERE, _UP),
        ("ell cut through its arms", ell, _HERE, (0.8, -0.48, -0.36)),
        ("star", star, _HERE, _UP),
        ("star cut into parts", star, _HERE, (0.0, -0.8, -0.6)),
        ("star tiny", star * [1e-7, 1e-7, 1] + [0.5, 0.25, 0], _HERE, _TILTED),
        ("from behind", square[::-1], _HERE, _UP),
        ("in its plane", _moved(wall, -1.0, 0, 1), _HERE, _UP),
        ("below the horizon", square[::-1] * [1, 1, -1], _HERE, _UP),
        ("small numbers", square * 1e-90, _HERE, _TILTED),
        ("large numbers", square * 1e90, _HERE, _TILTED),
    ]
    return tuple(_case(label, points, 1.5, *rest) for label, points, *rest in shapes)


def _triangles() -> tuple[Case, ...]:
    """Vertices, radiance, position, normal."""
    plain = np.array([[-0.3, -0.4, 1.0], [0.1, 0.7, 1.25], [0.5, -0.2, 0.75]])
    shapes: list[tuple[Any, ...]] = [
        ("plain", plain, _HERE, _UP),
        ("octant", [(1, 0, 0), (0, 0, 1), (0, 1, 0)], _HERE, _UP),
        ("vertex in the horizon", [(1, 0, 0), (1, -0.5, 1), (1, 0.5, 1)], _HERE, _UP),
        ("vertex an ulp below the horizon", [(1, 0, -1e-16), (1, -0.5, 1), (1, 0.5, 1)], _HERE, _UP),
        ("all but in its plane", [(1, 0, 0.25), (2, 0, 1), (2, 1e-15, 0.375)], _HERE, _TILTED),
        ("sliver", [(-1, -0.5, 1), (0, 0.25 + 2.0**-40, 1), (1, 1, 1)], _HERE, _UP),
        ("needle", [(0, 0, 1), (0, 2.0**-30, 1), (3, 0, 2)], _HERE, _UP),
        ("needle cut", [(-3, 0, -1), (-3, 2.0**-30, -1), (3, 0, 2)], _HERE, _UP),
        ("tiny", _moved(plain * [1e-8, 1e-8, 1e-8], 0, 0, 1.0), _HERE, _UP),
        ("tiny, aslant", _moved(plain * 1e-10, 0.5, -0.25, 1.0), _HERE, _TILTED),
        ("far", _moved(plain, 0, 3e8, 4e8), _HERE, _UP),
    ]
    rng = generator("triangle")
    for k in range(_RANDOM):
        size, position = 10 ** rng.uniform(-6, 3), 10 ** rng.uniform(-2, 2) * rng.normal(size=3)
        points = position + rng.normal(size=3) + size * rng.normal(size=(3, 3))
        normal = np.cross(points[1] - points[0], points[2] - points[0])
        points = points[::-1] if normal @ (points[0] - position) > 0 else points
        shapes.append((f"random {k}", points, position, unit(rng.normal(size=3))))
    return tuple(_case(label, points, 1.5, *rest) for label, points, *rest in shapes)


def _rectangles() -> tuple[Case, ...]:
    """Centre, normal, width, height, up, radiance, position, normal."""
    down, along = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
    shapes = [
        ("panel", (0, 0, 1, *down, 2, 3, *along), _HERE, _UP),
        ("panel aslant", (0.5, 1, 2, 0.6, 0, -0.8, 2, 1, *along), _HERE, _TILTED),
        ("up askew", (0.5, 1, 2, 0.6, 0, -0.8, 2, 1, 0.3, 0.4, 0.1), _HERE, _TILTED),
        ("tiny", (0, 0, 1, *down, 1e-8, 1e-8, *along), _HERE, _UP),
        ("tiny aside", (0.5, 0.25, 1, *down, 1e-8, 1e-9, *along), _HERE, _TILTED),
        ("strip", (0.5, 0, 1, *down, 1e8, 0.125, *along), _HERE, _UP),
        ("far", (0, 3e7, 4e7, *down, 1, 2, *along), _HERE, _UP),
        ("window", (2, 0, 0, -1, 0, 0, 2, 2, 0, 0, 1), _HERE, _UP),
        (
            "aslant, from close by",
            (0.3, 0.1, 2.0**-30, 0.1, 0.2, -1, 2, 2, 1, 1, 0),
            (0.31, 0.11, 0.003),
            _UP,
        ),
        ("aslant and tiny", (0.3, 0.1, 1, 0.1, 0.2, -1, 1e-8, 3e-8, 1, 1, 0), _HERE, _TILTED),
        (
            "aslant, tiny and far from the origin",
            (1e7 + 0.3, 0.1, 1, 0.1, 0.2, -1, 1e-6, 3e-6, 1, 1, 0),
            (1e7, 0.125, 0.25),
            _TILTED,
        ),
        ("aslant and cut", (2, 0.1, 0.1, -1, 0.3, 0.2, 1, 3, 0, 0.1, 1), _HERE, _UP),
        ("window to a hair", (2, 0, -1 + 2.0**-40, -1, 0, 0, 2, 2, 0, 0, 1), _HERE, _UP),
        ("huge", (0, 0, 1, *down, 1e9, 1e9, *along), _HERE, _TILTED),
        ("from close by", (0.25, 0.125, 2.0**-30, *down, 1, 1, *along), _HERE, _UP),
    ]
    return tuple(_case(label, numbers, 1.5, *rest) for label, numbers, *rest in shapes)


def _moments() -> tuple[Case, ...]:
    """Vertices, axis, exponent, normal."""
    square = np.array([[-1.0, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]])
    ell = np.array([(0.25, 2, 1), (1, 2, 1), (1, 1, 1), (2, 1, 1), (2, 0.125, 1), (0.25, 0.125, 1)])
    shapes = [
        ("square, n 0", square, _UP, 0, _UP),
        ("square, n 1", square, _TILTED, 1, _UP),
        ("square, n 20", square, _TILTED, 20, _UP),
        ("square, n 301", square, (0.1, 0.2, 1.0), 301, _UP),
        ("tiny beside the axis, n 40", _moved(square * [1e-6, 1e-6, 1], 0.3, 0, 0), _UP, 40, _UP),
        ("square cut, n 9", square, (1.0, 0.0, 0.25), 9, (0.8, 0.0, 0.6)),
        ("ell, n 12", ell, (1.0, 1.0, 1.0), 12, _TILTED),
        ("grazing, n 7", square * [1, 1, 1e-6], _TILTED, 7, _UP),
    ]
    found = []
    for label, points, axis, n, normal in shapes:
        numbers = (*np.array(points).ravel().tolist(), *axis, n, *normal)
        found.append((label, tuple(map(float, numbers))))
    return tuple(found)


def _lobes() -> tuple[Case, ...]:
    """Two unit vectors and the exponent."""
    rng = generator("lobe")
    found = []
    for off in (0.0, 1e-12, 1e-8, 1e-5, 1e-3, 0.1, 0.7, 1.2, 1.5, 1.57):
        for n in (0.5, 1.0, 10.0, 1e3, 1e6):
            axis = unit(rng.normal(size=3))
            aside = unit(np.cross(axis, rng.normal(size=3)))
            w = unit(math.cos(off) * axis + math.sin(off) * aside)
            found.append((f"{off:g} rad off, n {n:g}", tuple(map(float, (*w, *axis, n)))))
    return tuple(found)
