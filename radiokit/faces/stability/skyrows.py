"""Sky rows: the closed forms of environments and of lights without extent."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.contracts.emitter import emitter
from radiokit.faces.stability import lighttruth as truth
from radiokit.faces.stability.lights import Case, LightRow
from radiokit.faces.stability.roundrows import generator, received
from radiokit.facts.directions import unit

__all__ = ["rows"]

_QUADRATURE = (54, 60, 75, 100)
_HERE = (0.0, 0.0, 0.0)
_CANDELA = (
    (900.0, 500.0, 200.0),
    (800.0, 400.0, 100.0),
)  # at horizontal angles 0 and 90°, vertical 0, 30, 90
_IES = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 2 1 2 0 0 0\n1 1 9\n0 30 90\n0 90\n900 500 200\n800 400 100"


def rows() -> tuple[LightRow, ...]:
    """Return the rows."""
    rings = "rings about the zenith that the horizon cuts, by quadrature"
    return (
        LightRow(
            name="constant sky irradiance",
            truth="πL (1 + cosβ)/2",
            kernel=lambda *x: received(emitter("constant", radiance=x[6], normal=x[:3]), _HERE, x[3:6]),
            exact=lambda *x: _pi() * x[6] * (1 + truth.dot(truth.unit(x[:3]), truth.unit(x[3:6]))) / 2,
            textbook=lambda *x: math.pi * x[6] * (1 + math.cos(_angle(x[:3], x[3:6]))) / 2,
            cases=_tilts(0.7),
        ),
        LightRow(
            name="overcast sky irradiance",
            truth=rings,
            kernel=lambda *x: received(emitter("sky_overcast", normal=x[:3], radiance=x[6]), _HERE, x[3:6]),
            exact=lambda *x: truth.sky_irradiance(lambda c: x[6] * (1 + 2 * c) / 3, x[:3], x[3:6]),
            cases=_tilts(9.0),
            digits=_QUADRATURE,
        ),
        *(
            LightRow(
                name=f"gradient sky irradiance, {label}",
                truth=rings,
                kernel=lambda *x: received(
                    emitter("sky_gradient", normal=x[:3], radiance=x[6], horizon=x[7], curvature=x[8]),
                    _HERE,
                    x[3:6],
                ),
                exact=lambda *x: truth.sky_irradiance(_parabola(*x[6:]), x[:3], x[3:6]),
                cases=_tilts(*law),
                digits=_QUADRATURE,
            )
            for label, law in (
                ("brighter at the zenith", (3.0, 0.25, 0.5)),
                ("brighter at the horizon", (0.1, 2.0, -0.75)),
                ("dark at the horizon", (2.0, 0.0, 1.0)),
            )
        ),
        LightRow(
            name="environment irradiance",
            truth="rings of the lit cells, cut by the horizon, by quadrature",
            kernel=lambda *x: received(_map(x[3], x[4]), _HERE, x[:3]),
            exact=_cells,
            cases=tuple(
                (f"{label}, cells of {lit[0]:g} and {lit[1]:g}", (*x[3:6], *lit))
                for k, (label, x) in enumerate(_tilts())
                for lit in [((2.0, 0.5), (2.0, 0.0), (0.0, 0.5))[k % 3]]
            ),
            digits=_QUADRATURE,
        ),
        LightRow(
            name="directional irradiance",
            truth="E⊥ cosθ",
            kernel=lambda *x: received(
                emitter("directional", direction=x[:3], irradiance=x[6]), _HERE, x[3:6]
            ),
            exact=lambda *x: x[6] * max(truth.dot(truth.unit(x[:3]), truth.unit(x[3:6])), 0),
            cases=_tilts(1000.0),
        ),
        LightRow(
            name="point irradiance",
            truth="I cosθ/r²",
            kernel=lambda *x: received(emitter("point", position=x[:3], intensity=x[3]), x[4:7], x[7:]),
            exact=lambda *x: x[3] * _seen(x),
            cases=_points(),
        ),
        LightRow(
            name="spot irradiance",
            truth="I t²(3 − 2t) cosθ/r², t by cosines",
            kernel=lambda *x: received(
                emitter("spot", position=x[:3], intensity=x[3], direction=x[10:13], inner=x[13], outer=x[14]),
                x[4:7],
                x[7:10],
            ),
            exact=lambda *x: (
                x[3]
                * _seen(x[:10])
                * truth.spot_intensity(truth.minus(x[4:7], x[:3]), x[10:13], x[13], x[14])
            ),
            textbook=_spot_textbook,
            cases=_spots(),
        ),
        LightRow(
            name="goniometric irradiance",
            truth="bilinear between the table's angles, cosθ/r²",
            kernel=lambda *x: received(
                emitter("goniometric", position=x[:3], ies=_IES, scale=x[3]), x[4:7], x[7:10]
            ),
            exact=lambda *x: x[3] / 683 * _seen(x) * _candela(truth.minus(x[4:7], x[:3])),
            cases=tuple(case for case in _points() if case[1][6] < case[1][2]),
        ),
        LightRow(
            name="point flux",
            truth="4πI",
            kernel=lambda i: emitter("point", position=_HERE, intensity=i).flux(),
            exact=lambda i: 4 * _pi() * i,
            cases=tuple((f"I {i:g}", (i,)) for i in (0.3, 7e-300, 1e100)),
        ),
        LightRow(
            name="spot flux",
            truth="2πI (1 − (cos inner + cos outer)/2)",
            kernel=lambda i, inner, outer: emitter(
                "spot", position=_HERE, direction=(0, 0, 1), intensity=i, inner=inner, outer=outer
            ).flux(),
            exact=lambda i, inner, outer: 2 * _pi() * i * (1 - (_cos(inner) + _cos(outer)) / 2),
            textbook=lambda i, inner, outer: 2 * math.pi * i * (1 - (math.cos(inner) + math.cos(outer)) / 2),
            cases=tuple(
                (f"inner {inner:g}, outer {outer:g}", (1.5, inner, outer))
                for outer in (1e-150, 1e-8, 0.3, 1.5, 3.14)
                for inner in (0.0, outer / 3, outer)
            ),
        ),
        LightRow(
            name="goniometric flux",
            truth="∫ of the interpolant over the sphere, by quadrature",
            kernel=lambda s: emitter("goniometric", position=_HERE, ies=_IES, scale=s).flux(),
            exact=_table_flux,
            cases=(("scale 1", (1.0,)), ("scale 1e-9", (1e-9,))),
            digits=_QUADRATURE,
        ),
    )


def _pi() -> Any:
    import mpmath

    return +mpmath.pi


def _cos(x: Any) -> Any:
    import mpmath

    return mpmath.cos(x)


def _angle(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return math.acos(max(-1.0, min(1.0, sum(x * y for x, y in zip(a, b, strict=True)))))


def _parabola(zenith: Any, horizon: Any, q: Any) -> Callable[[Any], Any]:
    return lambda c: horizon + (zenith - horizon) * ((1 - q) * c + q * c * c)


def _tilts(*law: float) -> tuple[Case, ...]:
    """The zenith, or a direction, and the receiver's normal; then what the light is."""
    found = []
    tilts = (0.0, 1e-9, 0.3, 1.0, 1.5, math.pi / 2 - 1e-9, 1.6, 2.5, 3.1, math.pi - 1e-5, math.pi - 1e-9)
    for tilt in tilts:
        normal = (math.sin(tilt), 0.0, math.cos(tilt))
        found.append((f"tilted by {tilt:.10g}", (0.0, 0.0, 1.0, *normal, *law)))
    rng = generator("tilts")
    for k in range(6):
        a, b = unit(rng.normal(size=(2, 3)))
        found.append((f"random {k}", tuple(map(float, (*a, *b, *law)))))
    return tuple(found)


def _map(first: float, second: float) -> Any:
    table = np.zeros((3, 5))
    table[1, 1], table[2, 4] = first, second
    return emitter("environment", radiance=table)


def _cells(x: Any, y: Any, z: Any, *radiances: Any) -> Any:
    """Return the irradiance of the two lit cells of a 3 x 5 map."""
    import mpmath

    n = truth.unit((x, y, z))
    across, middle = mpmath.hypot(n[0], n[1]), mpmath.atan2(n[1], n[0])
    total = mpmath.mpf(0)
    for (i, j), radiance in zip(((1, 1), (2, 4)), radiances, strict=True):
        low, high = mpmath.pi * i / 3, mpmath.pi * (i + 1) / 3
        start, stop = (2 * mpmath.pi * k / 5 - middle for k in (j, j + 1))

        def ring(theta: Any, start: Any = start, stop: Any = stop) -> Any:
            a, b = across * mpmath.sin(theta), n[2] * mpmath.cos(theta)
            return mpmath.sin(theta) * _above(a, b, start, stop)

        bend = abs(mpmath.atan2(n[2], across))
        bends = [bend, mpmath.pi - bend]
        bends += [mpmath.atan2(n[2], -across * mpmath.cos(phi)) % mpmath.pi for phi in (start, stop)]
        inside = sorted(b for b in bends if low + mpmath.mpf("1e-30") < b < high - mpmath.mpf("1e-30"))
        for a, b in zip([low, *inside], [*inside, high], strict=True):
            total += radiance * truth.relative_quad(ring, [a, b])
    return total


def _above(a: Any, b: Any, start: Any, stop: Any) -> Any:
    """Return ∫ max(0, a cosφ + b) dφ for a ≥ 0, over an interval that begins within two turns of 0."""
    import mpmath

    if b >= a:
        return a * (mpmath.sin(stop) - mpmath.sin(start)) + b * (stop - start)
    if b <= -a:
        return mpmath.mpf(0)
    edge, total = mpmath.acos(-b / a), mpmath.mpf(0)
    for turn in (-2, -1, 0, 1, 2):
        low, high = max(start, 2 * mpmath.pi * turn - edge), min(stop, 2 * mpmath.pi * turn + edge)
        if low < high:
            total += a * (mpmath.sin(high) - mpmath.sin(low)) + b * (high - low)
    return total


def _seen(x: tuple[Any, ...]) -> Any:
    """Return cosθ/r²."""
    v = truth.minus(x[:3], x[4:7])
    return max(truth.dot(truth.unit(v), truth.unit(x[7:10])), 0) / truth.dot(v, v)


def _points() -> tuple[Case, ...]:
    """The light's place, its strength, the receiver's place and normal."""
    up = (0.0, 0.0, 1.0)
    found: list[Case] = [
        ("overhead", (0.0, 0.0, 2.0, 8.0, *_HERE, *up)),
        ("grazing", (1.0, 0.0, 1e-9, 8.0, *_HERE, *up)),
        (
            "all but in the horizon of a slope",
            (0.8, 0.25, -0.6 + 2.0**-40, 8.0, 0.0, 0.25, -1.0, 0.6, 0.0, 0.8),
        ),
        ("far", (3e150, 0.0, 4e150, 8.0, *_HERE, *up)),
        ("close", (3e-150, 0.0, 4e-150, 8.0, *_HERE, *up)),
        ("far from the origin", (1e9 + 0.5, 1.0, 1e9 + 1, 8.0, 1e9, 0.0, 1e9, *up)),
        ("behind", (0.0, 0.0, -2.0, 8.0, *_HERE, *up)),
    ]
    rng = generator("points")
    for k in range(16):
        light, position, normal = rng.normal(size=3), rng.normal(size=3), unit(rng.normal(size=3))
        found.append((f"random {k}", tuple(map(float, (*light, 1.5, *position, *normal)))))
    return tuple(found)


def _spots() -> tuple[Case, ...]:
    """As ``_points``, then the axis, the inner and the outer half-angle."""
    up, down = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    found = []
    for outer in (1e-6, 1e-3, 0.4, 1.5, 3.0):
        for inner in (0.0, outer / 2, outer * (1 - 2.0**-20)):
            for share in (0.0, 0.3, 0.5, 0.9, 1 - 2.0**-21, 1 - 2.0**-30, 1.5):
                off = share * outer
                if off < 1.5:
                    place = (math.tan(off), 0.0, 0.0)
                    label = f"{off:g} rad off, inner {inner:g}, outer {outer:g}"
                    found.append((label, (0.0, 0.0, 1.0, 2.0, *place, *up, *down, inner, outer)))
    return tuple(found)


def _spot_textbook(*x: float) -> float:
    v = np.array(x[:3]) - x[4:7]
    r = float(np.linalg.norm(v))
    c = -float(v @ x[10:13]) / r
    t = (c - math.cos(x[14])) / (math.cos(x[13]) - math.cos(x[14]))
    t = min(1.0, max(0.0, t))
    return x[3] * t * t * (3 - 2 * t) * max(float(v @ x[7:10]), 0.0) / r**3


def _candela(towards: truth.Vector) -> Any:
    """Return the table's value along a direction away from the light: angles count from −z, and from x."""
    import mpmath

    x, y, z = towards
    polar = mpmath.degrees(mpmath.atan2(mpmath.hypot(x, y), -z))
    turn = mpmath.degrees(mpmath.atan2(abs(y), abs(x)))  # a quadrant says it all
    if polar > 90:
        return mpmath.mpf(0)
    low, high, k = (0, 30, 0) if polar <= 30 else (30, 90, 1)
    share = (polar - low) / (high - low)
    ends = [row[k] + share * (row[k + 1] - row[k]) for row in _CANDELA]
    return ends[0] + turn / 90 * (ends[1] - ends[0])


def _table_flux(scale: Any) -> Any:
    """Return ∫ I dω, to the azimuth linear and so its mean, by quadrature in the polar angle."""
    import mpmath

    def ring(theta: Any) -> Any:
        degrees = mpmath.degrees(theta)
        low, high, k = (0, 30, 0) if degrees <= 30 else (30, 90, 1)
        share = (degrees - low) / (high - low)
        mean = sum(row[k] + share * (row[k + 1] - row[k]) for row in _CANDELA) / 2
        return 2 * mpmath.pi * mean * mpmath.sin(theta)

    parts = ([mpmath.mpf(0), mpmath.pi / 6], [mpmath.pi / 6, mpmath.pi / 2])
    return scale / 683 * sum(truth.relative_quad(ring, part) for part in parts)
