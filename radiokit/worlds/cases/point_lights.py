"""Point lights: the inverse square, the cosine law, and the sum over lights of no extent."""

from __future__ import annotations

import math

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.emitters.directional import Directional
from radiokit.emitters.point import Point
from radiokit.facts.source import Source
from radiokit.worlds.cases.catalogue import Case, Scene, shading_case

__all__ = ["CASES"]

LAMBERT = Source(
    authors="Lambert",
    year=1760,
    title="Photometria, sive de mensura et gradibus luminis, colorum et umbrae",
    equation="inverse-square and cosine laws, E = I cosθ / r²",
)
_SUM = r"$L_o = \sum_j f\, E_{\perp j} \cos\theta_j$, $E_{\perp j}$ the irradiance normal to the light; here "


def _case(
    name: str,
    title: str,
    setup: str,
    exact: float,
    derivation: str,
    f: BSDF,
    *lights: Emitter,
    wo: tuple[float, float, float] = (0.0, 0.0, 1.0),
    source: Source = LAMBERT,
) -> Case:
    return shading_case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=_SUM + derivation,
        source=source,
        scene=Scene(f=f, emitters=lights, wo=wo),
        tags=("delta light", f.name),
    )


def _at(theta_deg: float, azimuth: float = 1.0) -> tuple[float, float, float]:
    """Return the direction ``theta_deg`` off z, with a cosine that keeps its digits near the horizon."""
    return (azimuth * math.sin(math.radians(theta_deg)), 0.0, _cosine_of(theta_deg))


def _cosine_of(theta_deg: float) -> float:
    return math.sin(math.radians(round(90 - theta_deg, 9)))  # of 0.001°, and not 0.00100000000000477°


def _inverse_square(text: str, distance: float) -> Case:
    return _case(
        f"lambert-under-point-at-{text.replace(' ', '')}",
        f"Lambert under a point light {text} above",
        f"A diffuse surface of reflectance 0.5, a point light of 3 W/sr {text} above it.",
        1.5 / math.pi / distance / distance,
        r"$f = \rho/\pi$, $E_\perp = I/r^2$, $\cos\theta = 1$.",
        Lambert(reflectance=0.5),
        Point(position=(0.0, 0.0, distance), intensity=3.0),
        wo=(0.6, 0.0, 0.8),
    )


def _cosine(theta_deg: float) -> Case:
    return _case(
        f"lambert-under-sun-at-{theta_deg:g}deg",
        f"Lambert under parallel light at {theta_deg:g}°",
        "A diffuse surface of reflectance 0.5 under parallel light of 1000 W/m² normal irradiance, "
        f"{theta_deg:g}° off the normal.",
        500 / math.pi * max(0.0, _cosine_of(theta_deg)),
        r"$f = \rho/\pi$, and $\cos\theta = \sin(90° - \theta)$ keeps its digits near the horizon, "
        "below which the light does not count.",
        Lambert(reflectance=0.5),
        Directional(direction=_at(theta_deg), irradiance=1000.0),
    )


CASES: tuple[Case, ...] = (
    _inverse_square("1 mm", 1e-3),
    _inverse_square("1 m", 1.0),
    _inverse_square("50 m", 50.0),
    _inverse_square("1000 km", 1e6),
    *(_cosine(theta) for theta in (0.0, 60.0, 89.999, 90.001, 180.0)),
    _case(
        "lambert-under-three-lights",
        "Lambert under three lights",
        "A diffuse surface of reflectance 0.6 under a point light of 8 W/sr at (0, 3, 4) m, parallel "
        "light of 2 W/m² from (4, 0, 3)/5, and a point light of 100 W/sr below the horizon at (0, 0, −1) m.",
        0.6 / math.pi * (8 / 25 * 4 / 5 + 2 * 3 / 5),
        r"$\frac{\rho}{\pi}\left(\frac{8}{25}\cdot\frac{4}{5} + 2\cdot\frac{3}{5} + 0\right)$.",
        Lambert(reflectance=0.6),
        Point(position=(0.0, 3.0, 4.0), intensity=8.0),
        Directional(direction=(4.0, 0.0, 3.0), irradiance=2.0),
        Point(position=(0.0, 0.0, -1.0), intensity=100.0),
        wo=(0.6, 0.0, 0.8),
    ),
    _case(
        "ggx-1-under-point",
        "GGX, α = 1, under a point light",
        "GGX with α = 1, height-correlated Smith masking and Fresnel factor 1, seen from (3, 0, 4)/5, "
        "under a point light of 8 W/sr at (0, 3, 4) m.",
        8 / 25 * 0.8 / (2 * math.pi * (0.8 + 0.8)),
        r"for $\alpha = 1$, $D = 1/\pi$ and $f = 1/(2\pi(\mu_i+\mu_o))$, whatever the azimuth.",
        GGX(alpha=1.0),
        Point(position=(0.0, 3.0, 4.0), intensity=8.0),
        wo=(0.6, 0.0, 0.8),
        source=GGX.SOURCE,
    ),
    *(
        _case(
            f"ggx-{alpha:g}-highlight-at-{theta}deg",
            f"GGX, α = {alpha:g}, at the peak of the highlight of a light at {theta}°",
            f"GGX with α = {alpha:g}, height-correlated Smith masking and Fresnel factor 1, under parallel "
            f"light of 2 W/m² normal irradiance {theta}° off the normal, seen in the mirror direction.",
            2
            / (4 * math.pi * alpha**2 * math.hypot(_cosine_of(theta), alpha * math.sin(math.radians(theta)))),
            r"$h = n$, so $D = 1/(\pi\alpha^2)$, $G_2 = 1/\sqrt{1 + \alpha^2\tan^2\theta}$, and "
            r"$L_o = E_\perp/(4\pi\alpha^2 \sqrt{\cos^2\theta + \alpha^2\sin^2\theta})$.",
            GGX(alpha=alpha),
            Directional(direction=_at(theta, -1.0), irradiance=2.0),
            wo=_at(theta),
            source=GGX.SOURCE,
        )
        for alpha, theta in ((0.3, 60), (0.01, 45), (0.1, 89))
    ),
)
