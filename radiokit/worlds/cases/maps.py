"""Maps: surfaces under latitude–longitude environment maps: a furnace, one bright cell, one that is cut."""

from __future__ import annotations

import math

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.bsdf import BSDF
from radiokit.emitters.environment import Environment
from radiokit.facts.source import Source
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case
from radiokit.worlds.cases.skies import towards

__all__ = ["CASES"]

_POLYGON = Source(
    authors="Lambert",
    year=1760,
    title="Photometria, sive de mensura et gradibus luminis, colorum et umbrae",
    equation="the irradiance of a polygon, a sum over its sides",
)

_CELL = "one cell of a latitude–longitude map"
_GGX = "GGX with α = 1, height-correlated Smith masking and Fresnel factor 1"
_PHONG = "Modified Phong, f = (n + 2)/2π · cosⁿα with n = 10"


def _facing_zenith(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    f: BSDF,
    light: Environment,
    wo_deg: float,
) -> Case:
    return shading_case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=derivation,
        source=f.SOURCE,
        scene=Scene(f=f, emitters=(light,), wo=towards(wo_deg)),
        tags=("environment", f.name),
    )


def _cell_map(rows: int, columns: int, row: int, column: int, radiance: float) -> Environment:
    table = [[0.0] * columns for _ in range(rows)]
    table[row][column] = radiance
    return Environment(radiance=table)


_TEXEL = _cell_map(4, 8, 1, 0, 8.0)  # polar angles 45° to 90°, azimuths 0 to 45°
_TEXEL_WORDS = (
    f"radiance 8 from {_CELL} of 4 rows and 8 columns: polar angles 45° to 90°, azimuths 0° to 45° from x"
)


def _octant(tilt_deg: float) -> Case:
    x, _, z = towards(tilt_deg)
    normal = (-x + 0.0, 0.0, z)
    return shading_case(
        name=f"lambert-under-bright-octant-tilted-{tilt_deg:g}deg",
        title=f"Lambert under a bright octant, tilted by {tilt_deg:g}°",
        setup=(
            f"A diffuse surface of reflectance 0.5 whose normal is tilted by {tilt_deg:g}° from z towards "
            f"−x, under radiance 2 from the octant x, y, z > 0, {_CELL} of 2 rows and 4 columns, seen along "
            "its normal."
            + (
                " The surface's horizon cuts the cell, a kink that quadrature resolves slowly."
                if tilt_deg
                else ""
            )
        ),
        exact=(1 - math.sin(math.radians(tilt_deg))) / 4,
        derivation=(
            r"The surface's horizon cuts a triangle from the octant. By Lambert's formula "
            r"$E = \frac{L}{2} \sum_k \gamma_k\, n\cdot m_k$, $m_k$ the inner normals of sides of length "
            r"$\gamma_k$: the side on the horizon gives $\frac{\pi}{2}$, that in $x = 0$ gives "
            r"$-\frac{\pi}{2}\sin\beta$, that in $y = 0$ nothing. $E = L\frac{\pi}{4}(1 - \sin\beta)$ and "
            r"$L_o = \rho E/\pi$."
        ),
        source=_POLYGON,
        scene=Scene(
            f=Lambert(reflectance=0.5),
            emitters=(_cell_map(2, 4, 0, 0, 2.0),),
            wo=normal,
            normal=normal,
        ),
        tags=("environment", "lambert"),
        left_out=("quadrature",) if tilt_deg else (),
    )


CASES: tuple[Case, ...] = (
    _facing_zenith(
        "lambert-in-furnace-map",
        "Lambert in a furnace that is a map",
        "A diffuse surface of reflectance 0.5 under a map of 3 rows and 5 columns, radiance 1 in each cell, "
        "seen 60° off its normal.",
        0.5,
        r"$L_o = \int \frac{\rho}{\pi} \cos\theta\, d\omega = \rho$: what the cells send adds up to $\pi$.",
        Lambert(reflectance=0.5),
        Environment(radiance=[[1.0] * 5] * 3),
        60.0,
    ),
    _facing_zenith(
        "lambert-under-bright-cell",
        "Lambert under one bright cell of a map",
        f"A diffuse surface of reflectance 0.5 that faces the zenith, seen 30° off its normal, under "
        f"{_TEXEL_WORDS}.",
        0.25,
        r"$E = L\,\Delta\varphi \int \cos\theta \sin\theta\, d\theta = 8 \cdot \frac{\pi}{4} \cdot "
        r"\frac{\cos^2 45° - \cos^2 90°}{2} = \frac{\pi}{2}$ and $L_o = \rho E/\pi$.",
        Lambert(reflectance=0.5),
        _TEXEL,
        30.0,
    ),
    _facing_zenith(
        "phong-10-under-bright-cell",
        "Modified Phong, n = 10, under one bright cell of a map",
        f"{_PHONG}, facing the zenith and seen along its normal, under radiance 8 from {_CELL} of 4 rows and "
        "8 columns: polar angles 0° to 45°, azimuths 0° to 45°.",
        1 - 0.5**6,
        r"$L_o = L \frac{n+2}{2\pi} \Delta\varphi \int \cos^{n+1}\theta \sin\theta\, d\theta = "
        r"L \frac{\Delta\varphi}{2\pi} (1 - \cos^{n+2} 45°) = 1 - 2^{-6}$.",
        Phong(exponent=10, reflectance=1.0),
        _cell_map(4, 8, 0, 0, 8.0),
        0.0,
    ),
    _facing_zenith(
        "ggx-1-under-bright-cell",
        "GGX, α = 1, under one bright cell of a map",
        f"{_GGX}, facing the zenith and seen 60° off its normal, under {_TEXEL_WORDS}.",
        math.sqrt(0.5) - 0.5 * math.log1p(math.sqrt(2)),
        r"$f = 1/(2\pi(\mu_i+\mu_o))$, whatever the azimuth, so $L_o = L \frac{\Delta\varphi}{2\pi} "
        r"\int_0^m \frac{\mu}{\mu+\mu_o} d\mu = m - \mu_o \ln\frac{m+\mu_o}{\mu_o}$ with $m = \cos 45°$ and "
        r"$\mu_o = \frac{1}{2}$.",
        GGX(alpha=1.0),
        _TEXEL,
        60.0,
    ),
    *(_octant(tilt) for tilt in (0, 30, 60)),
)
