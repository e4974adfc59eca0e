"""Polygons: flat lights overhead and aslant, cut by the horizon, tiny and huge; over Lambert and Phong."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.flat import FlatEmitter
from radiokit.contracts.spectral import amount
from radiokit.emitters.polygon import Polygon
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.triangle import Triangle
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.physics import axial_moments
from radiokit.physics.polygon import IRRADIANCE_SOURCE
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES", "corner_irradiance"]

Triple = tuple[float, float, float]

REFLECTANCE = 0.5

CORNER = Source(
    authors="Howell, Mengüç, Daun, Siegel",
    year=2021,
    title="Thermal Radiation Heat Transfer, 7th edition, and its catalogue of configuration factors",
    equation="B-3 (parallel rectangle) and B-4 (perpendicular one), from a differential area",
)

_LAMBERT = r"$L_o = \rho E / \pi$, "
_PARALLEL = (
    r"a rectangle $a \times b$ with a corner at height 1 above the receiver gives $E = L [A \arctan B' + "
    r"B \arctan A']/2$ with $A = a/\sqrt{1 + a^2}$, $B' = b/\sqrt{1 + a^2}$, $B = b/\sqrt{1 + b^2}$, "
    r"$A' = a/\sqrt{1 + b^2}$; "
)
_EDGES = (
    r"$E = \frac{L}{2} \sum_k \theta_k\, n \cdot \gamma_k$ over the edges of the part above the horizon; the "
    r"shadow of that part on the base of the unit hemisphere, $\frac{1}{2} \oint \sin^2\theta\, d\varphi$ "
    r"(Nusselt), gives the same 30 digits: "
)
_MOMENT = (
    r"$L_o = L \rho \frac{n + 2}{2\pi} \int (r \cdot \omega)^n\, n_z \cdot \omega\, d\omega$, Arvo's "
    r"double-axis moment of the part above the horizon with $r \cdot \omega > 0$; rings about $r$, with "
    r"$\int \sin^2 \cos^n$ as an incomplete beta function, give the same digits: "
)


def corner_irradiance(a: float, b: float) -> float:
    """Return the irradiance of a rectangle a × b of radiance 1 whose corner is at height 1 overhead."""
    p, q = math.hypot(1.0, a), math.hypot(1.0, b)
    return 0.5 * (a / p * math.atan(b / p) + b / q * math.atan(a / q))


def _overhead(side: float, text: str, *, left_out: tuple[str, ...] = (), note: str = "") -> Case:
    return _lambert(
        f"lambert-under-square-of-{text.replace(' ', '')}",
        f"Lambert under a square of {text}",
        f"a square of {text} × {text}, parallel to the surface and centred 1 m above it{note}",
        4 * corner_irradiance(side / 2, side / 2) * REFLECTANCE / math.pi,
        _PARALLEL + "here four of them.",
        Rectangle(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, -1.0), width=side, height=side),
        source=CORNER,
        left_out=left_out,
    )


def _lambert(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    *lights: Emitter,
    normal: Triple = (0.0, 0.0, 1.0),
    source: Source = IRRADIANCE_SOURCE,
    left_out: tuple[str, ...] = (),
) -> Case:
    return shading_case(
        name=name,
        title=title,
        setup=f"A diffuse surface of reflectance 0.5 under light of radiance 1 W/(m² sr): {setup}.",
        exact=exact,
        derivation=_LAMBERT + derivation,
        source=source,
        scene=Scene(f=Lambert(reflectance=REFLECTANCE), emitters=lights, wo=normal, normal=normal),
        tags=("polygon", "lambert"),
        left_out=left_out,
    )


def _numeric(name: str, title: str, setup: str, digits: str, light: Emitter, **more: Any) -> Case:
    return _lambert(name, title, setup, float(digits), f"{_EDGES}{digits}.", light, **more)


def _phong(
    name: str,
    setup: str,
    exact: float,
    derivation: str,
    light: FlatEmitter,
    exponent: int,
    wo: Triple = (0.0, 0.0, 1.0),
    left_out: tuple[str, ...] = (),
) -> Case:
    found = shading_case(
        name=f"phong-{exponent}-under-{name}",
        title=f"Modified Phong, n = {exponent}, under {name.replace('-', ' ')}",
        setup=f"Modified Phong, f = (n + 2)/2π · cosⁿα with n = {exponent}, under light of radiance "
        f"1 W/(m² sr): {setup}; seen from {wo}.",
        exact=exact,
        derivation=derivation,
        source=axial_moments.SOURCE,
        scene=Scene(f=Phong(exponent=float(exponent)), emitters=(light,), wo=wo),
        tags=("polygon", "phong"),
        left_out=left_out,
    )
    moment = partial(_by_moment, light, exponent, wo)
    return dataclasses.replace(found, methods={"closed form": moment, **found.methods})


def _by_moment(
    light: FlatEmitter,
    exponent: int,
    wo: Triple,
    *,
    rng: int | np.random.Generator | None = None,
    samples: int | None = None,
) -> Estimate:
    """Return the radiance that modified Phong reflects, by the double-axis moment."""
    moment = axial_moments.double_axis_moment(
        vertices=light.corners, axis=(-wo[0], -wo[1], wo[2]), exponent=exponent, normal=(0.0, 0.0, 1.0)
    )
    found = moment.scaled(amount(light.radiance) * (exponent + 2) / (2 * math.pi))
    error = found.error + 4 * np.spacing(found.value)
    return Estimate(found.value, error, "rounding", method="closed form")


def _shining_down(points: Sequence[tuple[float, float]], height: float = 1.0) -> Polygon:
    """Return a light at a height, from points in the plane that turn counter-clockwise seen from above."""
    return Polygon(vertices=[(x, y, height) for x, y in reversed(points)])


def _wall(low: float, high: float, width: float, distance: float = 1.0) -> Rectangle:
    """Return an upright light in front of the receiver, from a height to another."""
    center = (distance, 0.0, (low + high) / 2)
    return Rectangle(center=center, normal=(-1.0, 0.0, 0.0), width=width, height=high - low, up=(0, 0, 1))


ELL = ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0))
OCTANT = Triangle(vertices=[(1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)])
SQUARE = Rectangle(center=(0.5, 0.0, 1.0), normal=(0.0, 0.0, -1.0), width=2.0, height=2.0)
_PANEL = "a square of 2 m × 2 m, parallel to the surface, its centre at (0.5, 0, 1) m"
STAR = tuple(
    point
    for x, y in ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
    for point in ((x, y), ((x - y) / 4, (x + y) / 4))
)
_ELL = "an L, the square (0, 0)–(2, 2) m without (1, 1)–(2, 2) m, 1 m above; its corner is overhead"
_WALL = "an upright square of 2 m × 2 m at 1 m distance, its centre at the surface's height"
_SEEN = ("mc-bsdf",)
_HARDLY = "; samples of the material hardly ever meet it, so that method is left out"
_TOO_SMALL = "; samples of the material all but never meet it, so that method is left out"
_BOX = tuple(
    Rectangle(center=(-0.5 * n[0], -0.5 * n[1], -0.5 * n[2]), normal=n, width=1.0, height=1.0)
    for n in ((1.0, 0, 0), (-1.0, 0, 0), (0, 1.0, 0), (0, -1.0, 0), (0, 0, 1.0), (0, 0, -1.0))
)

CASES: tuple[Case, ...] = (
    _overhead(2e-6, "2 µm", left_out=_SEEN, note=_TOO_SMALL),
    _overhead(0.02, "2 cm", left_out=_SEEN, note=_TOO_SMALL),
    _overhead(0.5, "50 cm"),
    _overhead(2.0, "2 m"),
    _overhead(2e4, "20 km"),
    _overhead(2e8, "200000 km"),
    _lambert(
        "lambert-under-ell",
        "Lambert under an L",
        _ELL,
        (2 * corner_irradiance(1.0, 2.0) - corner_irradiance(1.0, 1.0)) * REFLECTANCE / math.pi,
        _PARALLEL + r"here $2E(1, 2) - E(1, 1)$.",
        _shining_down(ELL),
        source=CORNER,
    ),
    _lambert(
        "lambert-under-octant",
        "Lambert under an octant",
        "the triangle between the points at 1 m on the three axes",
        0.125,
        r"the triangle fills an octant, $E = \frac{\pi}{4} L$ by symmetry, and $L_o = \rho L/4$.",
        OCTANT,
    ),
    _lambert(
        "lambert-beside-wall",
        "Lambert beside a wall that the horizon cuts",
        _WALL,
        2 * 0.5 * (math.atan(1.0) - math.atan(math.sqrt(0.5)) * math.sqrt(0.5)) * REFLECTANCE / math.pi,
        r"a wall of width $2a$ from the horizon to a height $b$ at distance 1 gives $E = L [\arctan a - "
        r"\arctan(a/\sqrt{1 + b^2})/\sqrt{1 + b^2}]$; what is below the horizon does not count.",
        _wall(-1.0, 1.0, 2.0),
        source=CORNER,
    ),
    _lambert(
        "lambert-under-light-behind",
        "Lambert under the back of a light",
        "a square of 2 m × 2 m 1 m above that shines upwards",
        0.0,
        "and the light shines to the other side: $E = 0$.",
        Rectangle(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, 1.0), width=2.0, height=2.0),
    ),
    _lambert(
        "lambert-in-plane-of-light",
        "Lambert in the plane of a light",
        "an upright square of 1 m × 1 m whose plane goes through the point, edge-on",
        0.0,
        "and a light seen edge-on fills no solid angle: $E = 0$.",
        Rectangle(center=(2.0, 0.0, 0.5), normal=(0.0, 1.0, 0.0), width=1.0, height=1.0),
    ),
    _lambert(
        "lambert-in-box-of-light",
        "Lambert in a box of light",
        "the six sides of a cube of 1 m, shining inwards on its centre; the normal is (0.48, 0.6, 0.64)",
        REFLECTANCE,
        r"the sides fill the hemisphere whatever its tilt: $E = \pi L$, so that $L_o = \rho L$.",
        *_BOX,
        normal=(0.48, 0.6, 0.64),
    ),
    *(
        _numeric(
            f"lambert-under-square-tilted-{text}",
            f"Lambert under a square, {text} tilted",
            f"{_PANEL}, and the surface's normal is {normal}{_HARDLY if text == 'down' else ''}",
            digits,
            SQUARE,
            normal=normal,
            left_out=("mc-bsdf",) if text == "down" else (),
        )
        for text, normal, digits in (
            ("a-little", (0.28, 0.0, 0.96), "0.2555595176242853265741"),
            ("much", (0.6, 0.64, 0.48), "0.1571354252968114602004"),
            ("upright", (1.0, 0.0, 0.0), "0.08028940667121797035159"),
            ("down", (0.6, 0.0, -0.8), "0.0002323295262605703465346"),
        )
    ),
    _numeric(
        "lambert-under-star",
        "Lambert under a star",
        "a star of four points at 1 m from the middle, and four corners at (±0.25, ±0.25) m, 1 m above",
        "0.1124212176303247527081",
        _shining_down(STAR),
    ),
    _numeric(
        "lambert-under-triangle-cut",
        "Lambert under a triangle that the horizon cuts",
        "the triangle (1, −1, −1), (1, 0, 1.5), (1, 2, −0.5) m, which the horizon cuts",
        "0.04489549196279233735190",
        Triangle(vertices=[(1.0, -1.0, -1.0), (1.0, 0.0, 1.5), (1.0, 2.0, -0.5)]),
    ),
    _numeric(
        "lambert-under-triangle-touching-horizon",
        "Lambert under a triangle with a corner on the horizon",
        "the triangle (1, 0, 0), (1, −0.5, 1), (1, 0.5, 1) m",
        "0.02161902831344950038682",
        Triangle(vertices=[(1.0, 0.0, 0.0), (1.0, -0.5, 1.0), (1.0, 0.5, 1.0)]),
    ),
    _numeric(
        "lambert-under-sliver",
        "Lambert under a sliver",
        f"the triangle (−1, −1/2, 1), (0, 1/4 + 2⁻²⁰, 1), (1, 1, 1) m, a hair wide{_TOO_SMALL}",
        "0.00000009980887394670133769342",
        Triangle(vertices=[(-1.0, -0.5, 1.0), (0.0, 0.25 + 2.0**-20, 1.0), (1.0, 1.0, 1.0)]),
        left_out=_SEEN,
    ),
    _numeric(
        "lambert-beside-skirting",
        "Lambert beside a skirting light",
        f"an upright strip 2 m wide and 2⁻¹⁰ m high, that stands on the horizon at 1 m{_TOO_SMALL}",
        "0.00000009755006134420734646344",
        _wall(0.0, 2.0**-10, 2.0),
        left_out=_SEEN,
    ),
    *(
        _phong(
            "octant",
            "the triangle between the points at 1 m on the three axes",
            0.25,
            r"the lobe is about the normal, and an octant is a quarter of the hemisphere, in which "
            r"$\frac{n + 2}{2\pi} \int \cos^{n + 1}\theta\, d\omega = 1$.",
            OCTANT,
            n,
        )
        for n in (1, 20, 200)
    ),
    *(
        _phong(name, setup, float(digits), f"{_MOMENT}{digits}.", light, n, wo)
        for name, setup, light, n, wo, digits in (
            ("square", _PANEL, SQUARE, 1, (-0.6, 0.0, 0.8), "0.5754639499494483137036"),
            ("square", _PANEL, SQUARE, 20, (0.6, 0.0, 0.8), "0.1987165023455767227802"),
            ("square", _PANEL, SQUARE, 200, (0.0, 0.6, 0.8), "0.7847678373163152206302"),
            ("ell", _ELL, _shining_down(ELL), 50, (-0.48, -0.6, 0.64), "0.5684571858720503147779"),
            ("wall", _WALL, _wall(-1.0, 1.0, 2.0), 10, (-0.96, 0.0, 0.28), "0.2673506275064849834785"),
        )
    ),
)
