"""Interfaces: Snell's law from Fermat's principle, and Fresnel's equations from the boundary conditions."""

from __future__ import annotations

from typing import Any

from sympy import Derivative, S, atan, cos, sin, sqrt

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import Notation
from radiokit.physics.relations.sources import BORN_WOLF, at
from radiokit.physics.relations.steps import Step, follows, premise

__all__ = ["DERIVATIONS"]


def _snell() -> Derivation:
    n = Notation()
    a, b = n.symbol("a", "m", "height of the start"), n.symbol("b", "m", "depth of the end")
    w = n.symbol("w", "m", "way along the interface", within=(2, 3))
    x = n.symbol("x", "m", "where the interface is crossed")
    c = n.symbol("c", "m/s", "speed of light")
    n1, n2 = n.symbol("n_1", "1", "index of refraction"), n.symbol("n_2", "1", "index of refraction")
    t1, t2 = n.angle("θ_1", "of incidence"), n.angle("θ_2", "of refraction")
    time = n.symbol("T", "s", "of travel", of=(x,))
    p, q = sqrt(a**2 + x**2), sqrt(b**2 + (w - x) ** 2)
    slope = n1 * x / (c * p) - n2 * (w - x) / (c * q)
    return Derivation(
        name="snell-from-fermat",
        title="Snell's law, from Fermat's principle",
        statement="n₁ sinθ₁ = n₂ sinθ₂: light takes the way of stationary time.",
        notation=n,
        steps=(
            premise(time(x), n1 * p / c + n2 * q / c, "time = length · n / c, on both sides", "time"),
            premise(sin(t1), x / p, "the sine in the first triangle", "sin1"),
            premise(sin(t2), (w - x) / q, "the sine in the second triangle", "sin2"),
            follows(Derivative(time(x), x), slope, "differentiated", "time", label="slope"),
            premise(Derivative(time(x), x), 0, "Fermat: the time is stationary", "Fermat"),
            follows(
                n1 * sin(t1),
                n2 * sin(t2),
                "the slope is 0",
                "sin1",
                "sin2",
                ("slope", n1),
                "Fermat",
                label="Snell",
            ),
        ),
        source=at(BORN_WOLF, "section 3.3.2"),
        tags=("refraction", "lecture"),
    )


def _indices(n: Notation) -> tuple[Any, Any, Any, Any]:
    return (
        n.symbol("n_1", "1", "index of refraction, before"),
        n.symbol("n_2", "1", "index of refraction, behind"),
        n.angle("θ_1", "of incidence"),
        n.angle("θ_2", "of refraction"),
    )


def _energy(R: Any, T: Any, r: Any, t: Any, before: Any, behind: Any) -> tuple[Step, ...]:
    return (
        premise(R, r**2, "flux goes with the square of the amplitude"),
        premise(T, behind * t**2 / before, "and with n cosθ: the index, and the width of the beam"),
        follows(R + T, 1, "no flux is lost", "R", "T", "t", "r", label="R + T"),
    )


def _fresnel_s() -> Derivation:
    n = Notation()
    n1, n2, t1, t2 = _indices(n)
    r, t = n.symbol("r", "1", "reflected amplitude", real=True), n.symbol("t", "1", "transmitted amplitude")
    R, T = n.quantity("R", "reflectance"), n.symbol("T", "1", kind="transmittance")
    before, behind = n1 * cos(t1), n2 * cos(t2)
    return Derivation(
        name="fresnel-s",
        title="Fresnel's equations, across the plane of incidence (s)",
        statement="r = (n₁cosθ₁ − n₂cosθ₂)/(n₁cosθ₁ + n₂cosθ₂), and R + T = 1.",
        assumptions=(
            "both media are transparent and not magnetic",
            "E is perpendicular to the plane of incidence",
        ),
        notation=n,
        steps=(
            premise(t, 1 + r, "E along the interface is continuous"),
            premise((1 - r) * before, t * behind, "H along the interface is continuous", "H"),
            follows((1 - r) * before, (1 + r) * behind, "t put in", "t", label="both"),
            follows(r, (before - behind) / (before + behind), "solved for r", ("both", r)),
            follows(t, 2 * before / (before + behind), "and t with it", "r"),
            *_energy(R, T, r, t, before, behind),
        ),
        source=at(BORN_WOLF, "section 1.5.2, equations 20 and 21"),
        tags=("fresnel", "lecture"),
    )


def _fresnel_p() -> Derivation:
    n = Notation()
    n1, n2, t1, t2 = _indices(n)
    r, t = n.symbol("r", "1", "reflected amplitude", real=True), n.symbol("t", "1", "transmitted amplitude")
    R, T = n.quantity("R", "reflectance"), n.symbol("T", "1", kind="transmittance")
    p, q = n2 * cos(t1), n1 * cos(t2)
    return Derivation(
        name="fresnel-p",
        title="Fresnel's equations, in the plane of incidence (p)",
        statement="r = (n₂cosθ₁ − n₁cosθ₂)/(n₂cosθ₁ + n₁cosθ₂), and R + T = 1.",
        assumptions=("both media are transparent and not magnetic", "E is in the plane of incidence"),
        notation=n,
        steps=(
            premise(t, n1 * (1 + r) / n2, "H along the interface is continuous"),
            premise((1 - r) * cos(t1), t * cos(t2), "E along the interface is continuous", "E"),
            follows((1 - r) * cos(t1), n1 * (1 + r) * cos(t2) / n2, "t put in", "t", label="both"),
            follows(r, (p - q) / (p + q), "solved for r", ("both", r)),
            follows(t, 2 * n1 * cos(t1) / (p + q), "and t with it", "r"),
            *_energy(R, T, r, t, n1 * cos(t1), n2 * cos(t2)),
        ),
        source=at(BORN_WOLF, "section 1.5.2, equations 20 and 21"),
        tags=("fresnel", "lecture"),
    )


def _normal_incidence() -> Derivation:
    n = Notation()
    n1, n2, t1, t2 = _indices(n)
    R_s, R_p = (
        n.quantity("R_s", "reflectance", "across the plane"),
        n.quantity("R_p", "reflectance", "in the plane"),
    )
    R = n.quantity("R", "reflectance", "of unpolarised light")
    a, b, p, q = n1 * cos(t1), n2 * cos(t2), n2 * cos(t1), n1 * cos(t2)
    return Derivation(
        name="fresnel-at-normal-incidence",
        title="Fresnel reflection at normal incidence",
        statement="R = ((n₁ − n₂)/(n₁ + n₂))²: 4 % for glass.",
        notation=n,
        steps=(
            premise(R_s, ((a - b) / (a + b)) ** 2, "fresnel-s"),
            premise(R_p, ((p - q) / (p + q)) ** 2, "fresnel-p"),
            premise(R, (R_s + R_p) / 2, "half of unpolarised light is s, half is p"),
            premise(t1, S.Zero, "normal incidence"),
            premise(t2, S.Zero, "is not bent"),
            follows(R, ((n1 - n2) / (n1 + n2)) ** 2, "both are the same", "R_s", "R_p", "θ_1", "θ_2"),
        ),
        source=at(BORN_WOLF, "section 1.5.2"),
        tags=("fresnel",),
    )


def _brewster() -> Derivation:
    n = Notation()
    n1, n2, t1, t2 = _indices(n)
    r = n.symbol("r", "1", "reflected amplitude in the plane of incidence", real=True)
    p, q = n2 * cos(t1), n1 * cos(t2)
    return Derivation(
        name="brewster-angle",
        title="Brewster's angle",
        statement="Where tanθ₁ = n₂/n₁, no light of p polarisation is reflected.",
        notation=n,
        steps=(
            premise(r, (p - q) / (p + q), "fresnel-p"),
            premise(cos(t2), sqrt(1 - (n1 * sin(t1) / n2) ** 2), "Snell's law", "Snell"),
            premise(t1, atan(n2 / n1), "Brewster's angle"),
            follows(cos(t2), n2 / sqrt(n1**2 + n2**2), "the refracted ray", "θ_1", label="refracted"),
            follows(r, 0, "both terms are n₁n₂/√(n₁² + n₂²)", "refracted", "θ_1"),
        ),
        source=at(BORN_WOLF, "section 1.5.3"),
        tags=("fresnel",),
    )


DERIVATIONS = (_snell(), _fresnel_s(), _fresnel_p(), _normal_incidence(), _brewster())
