"""Spots: surfaces under point lights whose intensity depends on direction, by a law or by a table."""

from __future__ import annotations

import math

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.vectors import Triple
from radiokit.emitters.goniometric import Goniometric
from radiokit.emitters.spot import Spot
from radiokit.facts.source import Source
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES", "TWO_LOBES"]

TWO_LOBES = """IESNA:LM-63-2002
[TEST] none
[LUMINAIRE] two lobes
TILT=NONE
1 -1 1 3 2 1 2 0 0 0
1 1 10
0 45 90
0 90
0 1366 0
0 0 0
"""
"""Intensities of 2 W/sr, at 683 lm/W, 45° off the nadir in the azimuths 0° and 180°, falling to 0 in 45° of
polar angle and 90° of azimuth."""

_SPOT = r"$L_o = f\,\frac{I(\theta)}{r^2}\cos\theta_i$ with $I = I_0\,t^2(3 - 2t)$, "
_TABLE = r"$L_o = f\,\frac{I}{r^2}\cos\theta_i$ with $I$ bilinear in the table's angles, "


def _case(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    f: BSDF,
    light: Emitter,
    position: Triple,
    wo: Triple = (0.0, 0.0, 1.0),
    source: Source = Spot.SOURCE,
) -> Case:
    return shading_case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=derivation,
        source=source,
        scene=Scene(f=f, emitters=(light,), wo=wo, position=position),
        tags=("delta light", light.name, f.name),
    )


def _spot(height: float, outer: float) -> Spot:
    return Spot(position=(0.0, 0.0, height), direction=(0.0, 0.0, -1.0), intensity=5.0, outer=outer)


_SOFT_WORDS = (
    "a spot light of 5 W/sr {height} m above the origin that shines down, of intensity 0 from {outer}° off "
    "its axis on and falling smoothly from 0° on, t = (cosθ − cos {outer}°)/(1 − cos {outer}°)"
)
_GGX = "GGX with α = 1, height-correlated Smith masking and Fresnel factor 1"
_DIFFUSE = "A diffuse surface of reflectance 0.5"
_HALF = Lambert(reflectance=0.5)
_LUMINAIRE = Goniometric(position=(0.0, 0.0, 1.0), ies=TWO_LOBES)
_LUMINAIRE_WORDS = (
    "a luminaire 1 m above the origin with two lobes, tabulated at polar angles of 0°, 45° and 90° from the "
    "nadir and azimuths of 0° and 90°, symmetric in each quadrant: 2 W/sr at (45°, 0°), and 0 at the others, "
    "bilinear in between"
)
_DIAGONAL = math.sqrt(0.5)

CASES: tuple[Case, ...] = (
    _case(
        "lambert-on-axis-of-spot",
        "Lambert on the axis of a spot light",
        f"{_DIFFUSE} at the origin, under {_SOFT_WORDS.format(height=2, outer=45)}.",
        0.625 / math.pi,
        _SPOT + r"$t = 1$: $\frac{0.5}{\pi}\cdot\frac{5}{4}$.",
        _HALF,
        _spot(2.0, math.pi / 4),
        (0.0, 0.0, 0.0),
        wo=(0.6, 0.0, 0.8),
    ),
    _case(
        "lambert-in-falloff-of-spot",
        "Lambert where a spot light falls off",
        f"{_DIFFUSE} at (3, 0, 0) m, facing z, under {_SOFT_WORDS.format(height=4, outer=90)}.",
        0.07168 / math.pi,
        _SPOT + r"$t = \cos\theta = \frac{4}{5}$: $\frac{0.5}{\pi}\cdot\frac{5 \cdot 0.896}{25}\cdot 0.8$.",
        _HALF,
        _spot(4.0, math.pi / 2),
        (3.0, 0.0, 0.0),
    ),
    _case(
        "lambert-outside-of-spot",
        "Lambert outside of a spot light's cone",
        f"{_DIFFUSE} at (4, 0, 0) m, facing z, under {_SOFT_WORDS.format(height=3, outer=45)}.",
        0.0,
        _SPOT + r"$t = 0$, since $\theta = \arctan\frac{4}{3} > 45°$.",
        _HALF,
        _spot(3.0, math.pi / 4),
        (4.0, 0.0, 0.0),
    ),
    _case(
        "ggx-1-in-falloff-of-spot",
        "GGX, α = 1, where a spot light falls off",
        f"{_GGX}, at (3, 0, 0) m, facing z and seen from (0, 3, 4)/5, under "
        f"{_SOFT_WORDS.format(height=4, outer=90)}.",
        0.14336 / (3.2 * math.pi),
        _SPOT + r"$t = \frac{4}{5}$ and $f = 1/(2\pi(\mu_i+\mu_o))$, $\mu_i = \mu_o = \frac{4}{5}$.",
        GGX(alpha=1.0),
        _spot(4.0, math.pi / 2),
        (3.0, 0.0, 0.0),
        wo=(0.0, 0.6, 0.8),
    ),
    *(
        _case(
            f"lambert-in-{side}-lobe-of-luminaire",
            f"Lambert in the {side} lobe of a luminaire",
            f"{_DIFFUSE} at ({x:g}, 0, 0) m, facing z, under {_LUMINAIRE_WORDS}.",
            0.5 * _DIAGONAL / math.pi,
            _TABLE + r"here tabulated: $\frac{0.5}{\pi}\cdot\frac{2}{2}\cdot\cos 45°$.",
            _HALF,
            _LUMINAIRE,
            (x, 0.0, 0.0),
            source=Goniometric.SOURCE,
        )
        for side, x in (("right", 1.0), ("left", -1.0))
    ),
    _case(
        "lambert-between-lobes-of-luminaire",
        "Lambert between the lobes of a luminaire",
        f"{_DIFFUSE} at (√½, √½, 0) m, facing z, under {_LUMINAIRE_WORDS}.",
        0.25 * _DIAGONAL / math.pi,
        _TABLE + r"half of the lobe's at 45° of azimuth: $\frac{0.5}{\pi}\cdot\frac{1}{2}\cdot\cos 45°$.",
        _HALF,
        _LUMINAIRE,
        (_DIAGONAL, _DIAGONAL, 0.0),
        source=Goniometric.SOURCE,
    ),
    _case(
        "lambert-at-nadir-of-luminaire",
        "Lambert at the dark nadir of a luminaire",
        f"{_DIFFUSE} at the origin, facing z, under {_LUMINAIRE_WORDS}.",
        0.0,
        _TABLE + r"0 at the nadir.",
        _HALF,
        _LUMINAIRE,
        (0.0, 0.0, 0.0),
        source=Goniometric.SOURCE,
    ),
    _case(
        "ggx-1-in-lobe-of-luminaire",
        "GGX, α = 1, in the lobe of a luminaire",
        f"{_GGX}, at (1, 0, 0) m, facing z and seen along its normal, under {_LUMINAIRE_WORDS}.",
        _DIAGONAL / (2 * math.pi * (1 + _DIAGONAL)),
        _TABLE + r"here tabulated, and $f = 1/(2\pi(\mu_i+\mu_o))$ with $\mu_i = \cos 45°$, $\mu_o = 1$.",
        GGX(alpha=1.0),
        _LUMINAIRE,
        (1.0, 0.0, 0.0),
        source=Goniometric.SOURCE,
    ),
)
