"""Fresnel: reflectance and refraction near the normal, the horizon, the critical angle, and an index of 1."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.stability.row import Row, decades
from radiokit.facts.directions import refract
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin
from radiokit.physics import fresnel

__all__ = ["ROWS"]

_SNELL = Source(
    authors="Pharr, Jakob, Humphreys",
    year=2023,
    title="Physically Based Rendering, 4th edition",
    equation="section 9.3.3",
)


def _conductor_textbook(m: Any, c: Any, eta: Any, k: Any) -> Any:
    c2, s2 = c * c, 1 - c * c
    t0 = eta * eta - k * k - s2
    squares = m.sqrt(t0 * t0 + 4 * eta * eta * k * k)  # a² + b²
    a = m.sqrt((squares + t0) / 2)
    t1, t2 = squares + c2, 2 * a * c
    r_s = (t1 - t2) / (t1 + t2)
    t3, t4 = c2 * squares + s2 * s2, t2 * s2
    return (r_s + r_s * (t3 - t4) / (t3 + t4)) / 2


def _conductor_twin() -> Twin:
    import sympy

    cosine, eta, k = symbols = sympy.symbols("c eta k", positive=True)
    return Twin(fresnel.conductor_symbolic(cosine, eta, k), {}, symbols)


def _dielectric_textbook(m: Any, c: Any, eta: Any) -> Any:
    t = m.sqrt(1 - (1 - c * c) / (eta * eta))
    r_s, r_p = (c - eta * t) / (c + eta * t), (eta * c - t) / (eta * c + t)
    return (r_s * r_s + r_p * r_p) / 2


def _dielectric_twin() -> Twin:
    import sympy

    cosine, eta = symbols = sympy.symbols("c eta", positive=True)
    return Twin(fresnel.conductor_symbolic(cosine, eta, sympy.S.Zero), {}, symbols)


def _refracted(component: int) -> Any:
    def kernel(x: Any, z: Any, eta: Any) -> Any:
        return refract(np.stack((x, 0.0 * x, z), axis=-1), eta=eta)[0][..., component]

    return kernel


def _refracted_twin(component: str) -> Any:
    def twin() -> Twin:
        import sympy

        x, z, eta = symbols = sympy.symbols("x z eta", positive=True)
        sine = x / sympy.sqrt(x**2 + z**2) / eta
        return Twin(-sine if component == "x" else -sympy.sqrt((1 - sine) * (1 + sine)), {}, symbols)

    return twin


def _near_critical(distance: Any) -> tuple[Any, ...]:
    sine = 0.75 * (1.0 - distance)
    return sine, np.sqrt((1.0 - sine) * (1.0 + sine)), 0.75


ROWS = (
    Row(
        name="conductor-thin-absorber",
        title="Reflectance of an absorber whose index is nearly 1",
        axis="extinction k [1]",
        values=decades(0, -12),
        inputs=lambda k: (np.array([1.0, 0.75, 0.1]), 1.0, k),
        kernel=fresnel.conductor,
        textbook=_conductor_textbook,
        twin=_conductor_twin,
        kernel_name="radiokit.physics.fresnel.conductor",
        kernel_form="|(η + ik)² − 1|² / |cos θ + q|⁴, with q² = (η + ik)² − sin²θ",
        textbook_form="(a² + b² + cos²θ − 2a cos θ) / (a² + b² + cos²θ + 2a cos θ), and so for p",
        lesson="The reflectance of a smoke whose index is 1 goes with k², but the numerator subtracts "
        "numbers near 2 and is left with ε: below k = √ε only rounding is left, and it may be "
        "negative. The same numerator is |n² − 1|² over a sum of squares, and η − 1 is an exact "
        "difference.",
        source=fresnel.CONDUCTOR_SOURCE,
    ),
    Row(
        name="dielectric-index-matched",
        title="Reflectance between nearly equal indices (hard for every formula)",
        axis="η − 1 [1]",
        values=tuple(2.0**-k for k in range(1, 22, 2)),
        inputs=lambda d: (np.array([1.0, 0.75]), 1.0 + d),
        kernel=fresnel.dielectric,
        textbook=_dielectric_textbook,
        twin=_dielectric_twin,
        kernel_name="radiokit.physics.fresnel.dielectric",
        kernel_form="|a² − b²| / (a + b)², the difference of squares from (n_t − n_i)(n_t + n_i)",
        textbook_form="((cos θ − η cos θt) / (cos θ + η cos θt))², and so for p",
        lesson="The textbook's digits go, one for each that η shares with 1, but so does what η says: its "
        "last bit is 2/(η − 1) last bits of the reflectance. By the condition number the textbook is "
        "without fault. Where the index is exact, as in a test, the difference of squares still "
        "gives every digit.",
        source=fresnel.DIELECTRIC_SOURCE,
        fails=(),
    ),
    Row(
        name="dielectric-near-critical",
        title="Reflectance near the critical angle (hard for every formula)",
        axis="distance from the critical cosine [1]",
        values=decades(-1, -6),
        inputs=lambda distance: (np.sqrt(1.0 - 0.75**2) * (1.0 + distance), 0.75),
        kernel=fresnel.dielectric,
        textbook=_dielectric_textbook,
        twin=_dielectric_twin,
        kernel_name="radiokit.physics.fresnel.dielectric",
        kernel_form="|a² − b²| / (a + b)², or 1 − 2 min(a, b)/(a + b) where that cancels less",
        textbook_form="((cos θ − η cos θt) / (cos θ + η cos θt))², and so for p",
        lesson="The reflectance meets 1 with an infinite slope, as the square root does its zero: half of "
        "the digits of the angle are lost to the angle's own last bit. The condition number says so, "
        "and the textbook loses no more than that.",
        source=fresnel.DIELECTRIC_SOURCE,
        fails=(),
    ),
    Row(
        name="conductor-grazing",
        title="Reflectance of a metal at grazing incidence (easy for every formula)",
        axis="cosine of the angle of incidence [1]",
        values=decades(-1, -15),
        inputs=lambda c: (c, np.array([0.2, 1.5]), 3.9),
        kernel=fresnel.conductor,
        textbook=_conductor_textbook,
        twin=_conductor_twin,
        kernel_name="radiokit.physics.fresnel.conductor",
        kernel_form="1 − 4a cos θ / ((a + cos θ)² + b²), and so for p",
        textbook_form="(a² + b² + cos²θ − 2a cos θ) / (a² + b² + cos²θ + 2a cos θ), and so for p",
        lesson="A control: not every limit is hard. At grazing incidence the reflectance tends to 1, what "
        "is subtracted is small beside what it is subtracted from, and nothing is lost. It is the "
        "absorbed share, one minus this, that must not be had by subtraction.",
        source=fresnel.CONDUCTOR_SOURCE,
        fails=(),
    ),
    Row(
        name="refract-near-normal",
        title="Refraction near normal incidence",
        axis="angle of incidence [rad]",
        values=decades(-1, -15),
        inputs=lambda theta: (np.sin(theta), np.cos(theta), np.array([1.5, 0.75])),
        kernel=_refracted(0),
        textbook=lambda m, x, z, eta: -m.sin(m.acos(z / m.sqrt(x * x + z * z))) / eta,
        twin=_refracted_twin("x"),
        kernel_name="radiokit.facts.directions.refract",
        kernel_form="−(w − (w·n) n) / η, from the part of w along the surface",
        textbook_form="sin θt = sin(acos(w·n)) / η",
        lesson="Snell's law speaks of sines, and a program has the cosine w·n; near the normal it has "
        "forgotten the sine. The part of w along the surface is the sine, and was there all the "
        "time.",
        source=_SNELL,
    ),
    Row(
        name="refract-near-critical",
        title="Refraction near the critical angle (hard for every formula)",
        axis="distance from the critical sine [1]",
        values=decades(-1, -6),
        inputs=_near_critical,
        kernel=_refracted(2),
        textbook=lambda m, x, z, eta: -m.sqrt(1 - (1 - z * z / (x * x + z * z)) / (eta * eta)),
        twin=_refracted_twin("z"),
        kernel_name="radiokit.facts.directions.refract",
        kernel_form="√((n_t − n_i sin θ)(n_t + n_i sin θ)) / n_t",
        textbook_form="cos θt = √(1 − (1 − cos²θ)/η²)",
        lesson="A counterexample: both forms lose digits, and neither is to blame. The last bit of the "
        "index moves the critical angle, so the answer itself is uncertain by that much: the "
        "condition number grows as one over the distance, and divided by it the textbook's error is "
        "below one ulp.",
        source=_SNELL,
        fails=(),
    ),
)
