"""Enclosure: closed rooms whose walls light each other, in which the answer is a line of algebra."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.emitters.point import Point
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.physics import view_factor
from radiokit.physics.lengths import HOWELL
from radiokit.worlds.cases.asking import SAMPLES, Ask, by_both, from_above, grey, room_case
from radiokit.worlds.cases.catalogue import Case
from radiokit.worlds.enclosure import SOURCE, Box, Sphere, Wall, enclosure_radiance

__all__ = ["CASES"]

KIRCHHOFF = Source(
    authors="Kirchhoff",
    year=1860,
    title="Ueber das Verhältniss zwischen dem Emissionsvermögen und dem Absorptionsvermögen der Körper",
    doi="10.1002/andp.18601850205",
    equation="the radiation in a cavity of one temperature does not depend on its walls",
)


# --- one material, and a wall that emits ---


class _Walk:
    """The random walk at one reflectance."""

    def __init__(self, reflectance: float) -> None:
        self.wall = Lambert(reflectance=reflectance)

    def __call__(
        self, *, rng: int | np.random.Generator | None = None, samples: int | None = None
    ) -> Estimate:
        return enclosure_radiance(self.wall, samples=2 * SAMPLES if samples is None else samples, rng=rng)


_SERIES = tuple(
    room_case(
        f"lambert-enclosure-{reflectance:g}",
        f"A closed sphere with an emitting wall of reflectance {reflectance:g}",
        "The inside of a sphere emits radiance 1 in all directions and reflects diffusely with "
        f"reflectance {reflectance:g}; nothing else is there. Wanted: the radiance that leaves any "
        "point of the wall, in any direction.",
        1 / (1 - reflectance),
        r"By symmetry $L$ is the same everywhere, so $L = L_e + \rho L$: "
        r"$L = L_e/(1-\rho) = L_e \sum_k \rho^k$, a term for each number of bounces.",
        {
            "random walk": _Walk(reflectance),
            "closed form": partial(
                Ask(Sphere(wall=grey(reflectance, 1.0)), "radiance", from_above()), "closed form"
            ),
        },
        source=SOURCE,
        tags=("lambert", "interreflection"),
    )
    for reflectance in (0.1, 0.5, 0.9)
)

# --- three scenes of radiance 1 in a sphere of radius 1 and reflectance ½ ---

_HALF = "The inside of a sphere of radius 1 reflects diffusely with reflectance 1/2"
_LOWEST = "Wanted: the radiance that leaves the lowest point of the wall, in any direction."

_FOUR = ((0.6, 0.0, -0.2), (-0.6, 0.0, -0.2), (0.0, 0.3, -0.6), (0.0, 0.0, 0.5))
_PLACES = "(0.6, 0, −0.2), (−0.6, 0, −0.2), (0, 0.3, −0.6) and (0, 0, 0.5)"


def _four(intensity: float) -> Sphere:
    return Sphere(wall=grey(0.5), lights=[Point(position=p, intensity=intensity) for p in _FOUR])


_UNITY = (
    room_case(
        "sphere-with-lamp-at-centre",
        "Radiance 1 from a lamp at the centre of a sphere",
        f"{_HALF}. At its centre is a point light of intensity π. {_LOWEST}",
        1.0,
        r"The lamp's irradiance $I/R^2$ is the same everywhere, and so is what interreflection adds: "
        r"$\pi L = \rho (I/R^2 + \pi L)$, so $L = \frac{\rho}{1-\rho}\frac{I}{\pi R^2}$, and "
        r"$I = \pi R^2 (1-\rho)/\rho$ makes it 1.",
        by_both(
            Ask(
                Sphere(wall=grey(0.5), lights=Point(position=(0, 0, 0), intensity=math.pi)),
                "radiance",
                from_above(),
            )
        ),
    ),
    room_case(
        "sphere-with-four-lamps",
        "Radiance 1 from four lamps anywhere in a sphere",
        f"{_HALF}. In it are four point lights of intensity 45π/208, at {_PLACES}. Wanted: the radiance that "
        "leaves (0, 0, −1), in any direction.",
        1.0,
        r"Wherever a lamp is, it sends its whole flux $4\pi I$ to the wall, which sends $\rho$ of it on "
        r"evenly: interreflection adds $\rho\Phi/(A(1-\rho)) = 4I\rho/(R^2(1-\rho))$. The lamps themselves "
        r"add $I \sum \cos\theta_j/d_j^2 = I(\frac45 + \frac45 + \frac{16}5 + \frac49) = \frac{236}{45} I$, "
        r"for their distances are 1, 1, 1/2 and 3/2. So $L = \frac{\rho}{\pi} I (\frac{236}{45} + 4) = "
        r"\frac{208}{45\pi} I$.",
        by_both(Ask(_four(45 * math.pi / 208), "radiance", from_above())),
    ),
    room_case(
        "sphere-with-four-lamps-on-average",
        "Mean radiance 1 from four lamps anywhere in a sphere",
        f"{_HALF}. In it are four point lights of intensity π/4, at {_PLACES}. Wanted: the mean over the "
        "wall of the radiance that leaves it.",
        1.0,
        r"Each lamp's flux reaches the wall, wherever it stands: the mean irradiance $\bar E$ is that of the "
        r"lamps, $\Phi/A$, and of the wall itself, $\rho \bar E$. So $\bar L = \rho \bar E/\pi = "
        r"\frac{\rho}{1-\rho} \frac{\Phi}{\pi A}$, with $\Phi = 4 \cdot 4\pi \cdot \pi/4$ and $A = 4\pi$.",
        by_both(Ask(_four(math.pi / 4), "flux", {"part": 0}, factor=0.5 / (4 * math.pi**2))),
    ),
    room_case(
        "sphere-with-emitting-wall",
        "Radiance 1 from the wall of a sphere",
        f"{_HALF} and emits radiance 1/2 in all directions; nothing else is there. {_LOWEST}",
        1.0,
        r"$L = L_e + \rho L$, and $L_e = 1 - \rho$.",
        by_both(Ask(Sphere(wall=grey(0.5, 0.5)), "radiance", from_above())),
        source=SOURCE,
    ),
)

# --- boxes, and walls that are not diffuse ---

_SIX = (0.0, 0.2, 0.5, 0.7, 0.9, 0.4)
_MIXED = 0.5 * Lambert(reflectance=0.6) + 0.5 * Mirror(reflectance=0.8)
_FLOOR = {"position": (0.3, 0.6, 0.0), "direction": (0.0, 0.6, 0.8)}
_KIRCHHOFF = (
    r"$L = 1$ everywhere solves $L = L_e + \rho L$ at every wall with $L_e = 1 - \rho$, whatever the shape "
    r"of the room and however the walls scatter, and the solution is unique as walls absorb. "
)


_OPPOSITE = float(view_factor.parallel_rectangles(width=3.0, length=4.0, distance=2.0))
_NEXT = float(view_factor.perpendicular_rectangles(edge=4.0, width=2.0, height=3.0))


def _lit_end(part: int) -> Ask:
    walls = [Wall(emitted=1.0), *[Wall()] * 5]
    room = Box(walls=walls, high=(2.0, 3.0, 4.0))
    return Ask(room, "flux", {"part": part}, factor=1 / (math.pi * room.area(part)))


_BOXES = (
    room_case(
        "box-of-equal-walls",
        "A box whose walls are alike",
        "The walls of a box, 1 by 2 by 3, emit radiance 1 and reflect diffusely with reflectance 0.6. "
        "Wanted: the radiance that leaves any point in any direction.",
        2.5,
        r"$L = L_e + \rho L$ holds at every point with one $L = L_e/(1-\rho)$, as in a sphere.",
        by_both(Ask(Box(walls=grey(0.6, 1.0), high=(1, 2, 3)), "radiance", _FLOOR)),
        source=SOURCE,
        tags=("box", "interreflection"),
    ),
    room_case(
        "furnace-box",
        "A box of six different walls at one temperature",
        "The walls of a box, 1 by 2 by 3, reflect diffusely, with reflectances 0, 0.2, 0.5, 0.7, 0.9 and "
        "0.4 at −x, +x, −y, +y, −z and +z, and each emits radiance 1 − ρ. Wanted: the radiance that leaves "
        "any point.",
        1.0,
        _KIRCHHOFF,
        by_both(Ask(Box(walls=[grey(r, 1 - r) for r in _SIX], high=(1, 2, 3)), "radiance", _FLOOR)),
        source=KIRCHHOFF,
        tags=("box", "kirchhoff", "furnace"),
    ),
    room_case(
        "furnace-box-of-mirrors-and-paint",
        "A box of mirrors, paint and mixtures at one temperature",
        "The furnace-box, but the walls at −y and +z are mirrors of reflectances 0.5 and 0.4, and that at +y "
        "mixes 0.5 times a diffuse surface of reflectance 0.6 and 0.5 times a mirror of 0.8. Wanted: the "
        "radiance that leaves the mixed wall.",
        1.0,
        _KIRCHHOFF,
        by_both(
            Ask(
                Box(
                    walls=[
                        grey(0.0, 1.0),
                        grey(0.2, 0.8),
                        Wall(f=Mirror(reflectance=0.5), emitted=0.5),
                        Wall(f=_MIXED, emitted=1 - (0.3 + 0.4)),
                        grey(0.9, 1 - 0.9),
                        Wall(f=Mirror(reflectance=0.4), emitted=0.6),
                    ],
                    high=(1, 2, 3),
                ),
                "radiance",
                {"position": (0.3, 2.0, 0.5), "direction": (0.6, -0.8, 0.0)},
            )
        ),
        source=KIRCHHOFF,
        tags=("box", "kirchhoff", "furnace", "mirror", "mixture"),
    ),
    room_case(
        "sphere-of-mixed-wall",
        "A sphere whose wall mixes paint and mirror",
        "The wall of a sphere emits radiance 1 and mixes 0.5 times a diffuse surface of reflectance 0.6 and "
        "0.5 times a mirror of 0.8. Wanted: the radiance that leaves any point in any direction.",
        10 / 3,
        r"The albedo $\rho = 0.3 + 0.4$ is the same for all directions, so one $L = L_e + \rho L$ holds "
        r"everywhere, whatever share is scattered and whatever is mirrored.",
        by_both(Ask(Sphere(wall=Wall(f=_MIXED, emitted=1.0)), "radiance", from_above())),
        source=SOURCE,
        tags=("mirror", "mixture", "interreflection"),
    ),
    room_case(
        "spectral-sphere",
        "A sphere of three wavelengths",
        "The wall of a sphere emits radiance 1 at three wavelengths and reflects diffusely 0.2, 0.5 and 0.9 "
        "of them; paths are shared by all three. Wanted: the radiance at the first one.",
        1.25,
        r"At each wavelength $L = L_e/(1-\rho)$. The walk's roulette follows the brightest of the three, and "
        r"must be fair to the others.",
        by_both(
            Ask(Sphere(wall=grey([0.2, 0.5, 0.9], [1.0, 1.0, 1.0])), "radiance", from_above(), wavelength=0)
        ),
        source=SOURCE,
        tags=("spectral", "interreflection"),
    ),
    room_case(
        "black-box-opposite-wall",
        "What a wall of a black box sees of the opposite one",
        "A black box, 2 by 3 by 4; the wall at x = 0 emits radiance 1. Wanted: the mean radiance that the "
        "wall at x = 2 sees, its flux over π times its area.",
        _OPPOSITE,
        r"$\Phi = \pi L A_1 F$ with the view factor $F$ of two equal parallel rectangles: the mean is $LF$.",
        by_both(_lit_end(1), known=_OPPOSITE),
        source=HOWELL,
        tags=("box", "view factor"),
    ),
    room_case(
        "black-box-next-wall",
        "What a wall of a black box sees of its neighbour",
        "A black box, 2 by 3 by 4; the wall at x = 0 emits radiance 1. Wanted: the mean radiance that the "
        "wall at y = 0 sees, its flux over π times its area.",
        _NEXT,
        r"$\Phi = \pi L A_1 F$ with the view factor $F$ of two rectangles with a common edge; by reciprocity "
        r"$A_1 F$ over the other's area is the factor back.",
        by_both(_lit_end(2), known=_NEXT),
        source=HOWELL,
        tags=("box", "view factor"),
    ),
)

CASES: tuple[Case, ...] = (*_SERIES, *_UNITY, *_BOXES)
