"""Shadows: eclipses, screens, walls and balls between a light and a surface, whole, partial, just beside."""

from __future__ import annotations

import math

from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.occluder import Occluder
from radiokit.emitters.constant import Constant
from radiokit.emitters.disk import Disk
from radiokit.emitters.point import Point
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.sky_overcast import SkyOvercast
from radiokit.emitters.sphere import Sphere
from radiokit.facts.source import Source
from radiokit.occluders.disk import Disk as Screen
from radiokit.occluders.polygon import Polygon as Wall
from radiokit.occluders.sphere import Sphere as Ball
from radiokit.physics.cap import CAP_SOURCE
from radiokit.physics.disk import DISK_SOURCE
from radiokit.physics.polygon import IRRADIANCE_SOURCE
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case
from radiokit.worlds.cases.polygons import corner_irradiance

__all__ = ["CASES"]

Triple = tuple[float, float, float]

_HALF = Lambert(reflectance=0.5)
_DIFFUSE = "A diffuse surface of reflectance 0.5, seen along its normal, "
_SKY = Constant(radiance=1.0, normal=(0.0, 0.0, 1.0))
_SUN = Sphere(center=(0.0, 0.0, 4.0), radius=1.0, radiance=1.0)
_SQUARE = Rectangle(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, -1.0), width=2.0, height=2.0)
_DISK = Disk(center=(0.0, 0.0, 2.0), normal=(0.0, 0.0, -1.0), radius=1.0, radiance=1.0)
_LAMBERT = r"$L_o = \rho E/\pi$"


def _case(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    light: Emitter,
    *occluders: Occluder,
    source: Source,
    f: BSDF = _HALF,
    wo: Triple = (0.0, 0.0, 1.0),
    left_out: tuple[str, ...] = (),
) -> Case:
    return shading_case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=derivation,
        source=source,
        scene=Scene(f=f, emitters=(light,), wo=wo, occluders=occluders),
        tags=("shadow", light.name, f.name),
        left_out=left_out,
    )


def _level(x: tuple[float, float], y: tuple[float, float], height: float) -> Wall:
    """Return a level screen over the rectangle x × y."""
    return Wall(
        vertices=[(x[0], y[0], height), (x[1], y[0], height), (x[1], y[1], height), (x[0], y[1], height)]
    )


def _upright(x: float, y: float, height: float) -> Wall:
    """Return a wall on the ground, 2 m wide, through (x, y) at 1 m distance and across the way there."""
    return Wall(
        vertices=[(x - y, y + x, 0.0), (x + y, y - x, 0.0), (x + y, y - x, height), (x - y, y + x, height)]
    )


def _moon(radius: float, x: float = 0.0) -> Ball:
    return Ball(center=(x, 0.0, 2.0), radius=radius)


_ROUND = (
    r"A body overhead whose cone has the half-angle $\sigma$ and which lies within an even light takes "
    r"$\pi L \sin^2\sigma$ from its irradiance"
)

CASES: tuple[Case, ...] = (
    _case(
        "lambert-in-total-eclipse",
        "Lambert in a total eclipse",
        f"{_DIFFUSE}under a sphere of radius 1 m and radiance 1 W/m²/sr 4 m overhead, behind an opaque one "
        "of radius 0.5 m 2 m overhead.",
        0.0,
        r"Both have $\sin\sigma = 1/4$: the nearer cone covers the other one just so, and no light is left.",
        _SUN,
        _moon(0.5),
        source=CAP_SOURCE,
    ),
    _case(
        "lambert-in-annular-eclipse",
        "Lambert in an annular eclipse",
        f"{_DIFFUSE}under a sphere of radius 1 m and radiance 1 W/m²/sr 4 m overhead, behind an opaque one "
        "of radius 0.4 m 2 m overhead.",
        0.01125,
        rf"{_ROUND}: $E = \pi L (1/16 - 1/25)$, and {_LAMBERT}.",
        _SUN,
        _moon(0.4),
        source=CAP_SOURCE,
    ),
    _case(
        "lambert-in-partial-eclipse",
        "Lambert in a partial eclipse",
        f"{_DIFFUSE}under a sphere of radius 1 m and radiance 1 W/m²/sr 4 m overhead, behind an opaque one "
        "of radius 0.5 m around (0.4, 0, 2) m.",
        0.015498232157829981,
        r"In a ring at the angle $\theta$ from the normal the nearer sphere hides the azimuths up to $\phi$ "
        r"with $\cos\sigma = \cos\theta\cos\delta + \sin\theta\sin\delta\cos\phi$ around its own, at "
        r"$\tan\delta = 1/5$ and of $\sin\sigma = 0.5/\sqrt{4.16}$: $L_o = \frac{\rho}{\pi} \int 2 (\pi - "
        r"\phi) \cos\theta \sin\theta\, d\theta$ up to $\sin\theta = 1/4$.",
        _SUN,
        _moon(0.5, 0.4),
        source=CAP_SOURCE,
    ),
    _case(
        "phong-10-in-annular-eclipse",
        "Modified Phong, n = 10, in an annular eclipse",
        "Modified Phong, f = (n + 2)/2π · cosⁿα with n = 10, seen along its normal, under a sphere of "
        "radius 1 m and radiance 1 W/m²/sr 4 m overhead, behind an opaque one of radius 0.4 m 2 m overhead. "
        "The edges are steps in one coordinate of the material's samples, so that replicates of "
        "low-discrepancy points may agree by chance.",
        0.10382363280131617,
        r"The lobe is about the normal, and $\frac{n+2}{2\pi} \int \cos^{n+1}\theta\, d\omega$ between two "
        r"cones is $\cos^{n+2}\sigma_1 - \cos^{n+2}\sigma_2$: $L_o = 0.96^6 - 0.9375^6$.",
        _SUN,
        _moon(0.4),
        f=Phong(exponent=10.0),
        source=CAP_SOURCE,
        left_out=("qmc",),
    ),
    _case(
        "mirror-in-annular-eclipse",
        "A mirror in an annular eclipse, where it is dark",
        "A mirror of reflectance 0.9, seen along its normal, under a sphere of radius 1 m and radiance 1 "
        "W/m²/sr 4 m overhead, behind an opaque one of radius 0.4 m 2 m overhead.",
        0.0,
        r"The mirror shows the one direction in which the nearer sphere is.",
        _SUN,
        _moon(0.4),
        f=Mirror(reflectance=0.9),
        source=Mirror.SOURCE,
    ),
    _case(
        "lambert-under-disk-behind-disk",
        "Lambert under a disk behind a disk",
        f"{_DIFFUSE}under a disk of radius 1 m and radiance 1 W/m²/sr that faces it from 2 m above, behind "
        "an opaque disk of radius 0.25 m 1 m above, on the same axis.",
        6 / 85,
        rf"{_ROUND}, here with $\sin^2\sigma = R^2/(R^2 + h^2)$: $E = \pi L (1/5 - 1/17)$, and {_LAMBERT}.",
        _DISK,
        Screen(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, 1.0), radius=0.25),
        source=DISK_SOURCE,
    ),
    _case(
        "lambert-under-disk-behind-speck",
        "Lambert under a disk behind a speck",
        f"{_DIFFUSE}under a disk of radius 1 m and radiance 1 W/m²/sr that faces it from 2 m above, behind "
        "an opaque disk of radius 1 µm 1 m above, on the same axis.",
        0.5 * (0.2 - 1e-12 / (1 + 1e-12)),
        rf"{_ROUND}: $E = \pi L (1/5 - 10^{{-12}}/(1 + 10^{{-12}}))$, and {_LAMBERT}.",
        _DISK,
        Screen(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, 1.0), radius=1e-6),
        source=DISK_SOURCE,
    ),
    _case(
        "lambert-under-half-of-square",
        "Lambert under a square, one half of which is hidden",
        f"{_DIFFUSE}under a square of 2 m × 2 m and radiance 1 W/m²/sr, centred 1 m above, behind an opaque "
        "rectangle with 0 ≤ x ≤ 10 m, |y| ≤ 10 m at half that height.",
        2 * corner_irradiance(1.0, 1.0) * 0.5 / math.pi,
        r"By symmetry half of the light of the square is left, two of the four rectangles $1 \times 1$ with "
        r"a corner overhead, each of $E = \frac{L}{\sqrt 2} \arctan\frac{1}{\sqrt 2}$.",
        _SQUARE,
        _level((0.0, 10.0), (-10.0, 10.0), 0.5),
        source=IRRADIANCE_SOURCE,
    ),
    _case(
        "lambert-under-square-behind-square",
        "Lambert under a square behind a corner of another",
        f"{_DIFFUSE}under a square of 2 m × 2 m and radiance 1 W/m²/sr, centred 1 m above, behind an opaque "
        "square from (0.25, 0.25) to (0.75, 0.75) m at half that height.",
        0.5
        / math.pi
        * (3 * corner_irradiance(1.0, 1.0) + 2 * corner_irradiance(0.5, 1.0) - corner_irradiance(0.5, 0.5)),
        "The shadow, twice as large at the light's height, hides $[1/2, 1]^2$ m. With $E(a, b)$ of a "
        "rectangle that has a corner overhead, $E = 4 E(1, 1) - [E(1, 1) - 2 E(1/2, 1) + E(1/2, 1/2)]$.",
        _SQUARE,
        _level((0.25, 0.75), (0.25, 0.75), 0.5),
        source=IRRADIANCE_SOURCE,
    ),
    _case(
        "lambert-under-square-below-wall",
        "Lambert under a square with something behind it",
        f"{_DIFFUSE}under a square of 2 m × 2 m and radiance 1 W/m²/sr, centred 1 m above; 2 m above is an "
        "opaque square as large.",
        4 * corner_irradiance(1.0, 1.0) * 0.5 / math.pi,
        r"What is behind a light hides nothing: $E = 4 E(1, 1)$, $E(1, 1) = \frac{L}{\sqrt 2} "
        r"\arctan\frac{1}{\sqrt 2}$.",
        _SQUARE,
        _level((-1.0, 1.0), (-1.0, 1.0), 2.0),
        source=IRRADIANCE_SOURCE,
    ),
    _case(
        "lambert-in-courtyard",
        "Lambert in a courtyard",
        f"{_DIFFUSE}under a sky of radiance 1 W/m²/sr, in the middle of a square yard of 2 m × 2 m, between "
        "dark walls of 1 m height that stand on its own level.",
        4 * corner_irradiance(1.0, 1.0) * 0.5 / math.pi,
        r"The walls touch the horizon and leave the sky in the square of 2 m × 2 m that their tops bound: "
        r"$E = 4 E(1, 1)$, $E(1, 1) = \frac{L}{\sqrt 2} \arctan\frac{1}{\sqrt 2}$.",
        _SKY,
        *(_upright(x, y, 1.0) for x, y in ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))),
        source=IRRADIANCE_SOURCE,
    ),
    _case(
        "lambert-under-sky-behind-disk",
        "Lambert under a sky behind a disk",
        f"{_DIFFUSE}under a sky of radiance 1 W/m²/sr, 1 m below the middle of an opaque disk of radius 1 m.",
        0.25,
        rf"{_ROUND}, here with $\sigma = 45°$: $E = \pi L (1 - 1/2)$, and {_LAMBERT}.",
        _SKY,
        Screen(center=(0.0, 0.0, 1.0), normal=(0.0, 0.0, 1.0), radius=1.0),
        source=DISK_SOURCE,
    ),
    _case(
        "lambert-under-sky-beside-ball",
        "Lambert under a sky, beside a ball in the horizon",
        f"{_DIFFUSE}under a sky of radiance 1 W/m²/sr, 2 m from the centre of an opaque ball of radius 1 m, "
        "which lies in the surface's plane.",
        0.5 * (5 / 6 + math.sqrt(3) / (4 * math.pi)),
        r"Half of the ball's cone is above the horizon and takes $L (\beta - \sin\beta\cos\beta)$ with "
        rf"$\sin\beta = 1/2$: $E = L (5\pi/6 + \sqrt 3/4)$, and {_LAMBERT}.",
        _SKY,
        Ball(center=(2.0, 0.0, 0.0), radius=1.0),
        source=CAP_SOURCE,
    ),
    _case(
        "lambert-under-sky-behind-two-balls",
        "Lambert under a sky behind two balls",
        f"{_DIFFUSE}under a sky of radiance 1 W/m²/sr, behind opaque balls of radius 1 m around (0, 0, 2) m "
        "and around (3.2, 0, 2.4) m.",
        0.5 * (1 - 0.25 - 0.6 / 16),
        r"The cones, of $\sin\sigma = 1/2$ and $1/4$, are apart, and each takes $\pi L "
        r"\sin^2\sigma\cos\theta$, the second with $\cos\theta = 3/5$: $E = \pi L (1 - 1/4 - 3/80)$, and "
        rf"{_LAMBERT}.",
        _SKY,
        _moon(1.0),
        Ball(center=(3.2, 0.0, 2.4), radius=1.0),
        source=CAP_SOURCE,
    ),
    _case(
        "lambert-under-overcast-sky-behind-ball",
        "Lambert under an overcast sky behind a ball",
        f"{_DIFFUSE}under the sky of radiance (1 + 2 cosθ)/3 W/m²/sr, behind an opaque ball of radius 1 m 2 "
        "m overhead.",
        25 / 72 - 2 / 9 * (1 - 0.75**1.5),
        r"The ball hides $\frac{2\pi}{3} \int (1 + 2\cos\theta) \cos\theta\sin\theta\, d\theta = "
        r"\frac{2\pi}{3} [\frac{1}{2}\sin^2\sigma + \frac{2}{3}(1 - \cos^3\sigma)]$ of the $7\pi/9$, with "
        r"$\sin\sigma = 1/2$.",
        SkyOvercast(radiance=1.0),
        _moon(1.0),
        source=SkyOvercast.SOURCE,
    ),
    _case(
        "lambert-under-point-behind-ball",
        "Lambert under a point light behind a ball",
        f"{_DIFFUSE}under a point light of 4 W/sr 4 m overhead, behind an opaque ball of radius 1 m 2 m "
        "overhead.",
        0.0,
        r"The ray to the light meets the ball.",
        Point(position=(0.0, 0.0, 4.0), intensity=4.0),
        _moon(1.0),
        source=Point.SOURCE,
    ),
    _case(
        "lambert-under-point-beside-ball",
        "Lambert under a point light just beside a ball",
        f"{_DIFFUSE}under a point light of 4 W/sr 2 m overhead; an opaque ball around (1, 0, 1) m has the "
        "radius 1 − 2⁻⁵⁰ m.",
        0.5 / math.pi,
        r"The ray passes at 1 m from the centre, a hair outside: $L_o = \frac{\rho}{\pi} I/r^2$.",
        Point(position=(0.0, 0.0, 2.0), intensity=4.0),
        Ball(center=(1.0, 0.0, 1.0), radius=1.0 - 2.0**-50),
        source=Point.SOURCE,
    ),
)
