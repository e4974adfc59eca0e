"""Lambertian sources: of the same radiance in every direction, and what cosines make of it."""

from __future__ import annotations

from typing import Any

from sympy import Integral, S, cos, pi, sin

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import ISO_LIGHT, LAMBERT, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _angles(n: Notation) -> tuple[Any, ...]:
    return (
        n.angle("θ", "from the normal"),
        n.angle("φ", "azimuth"),
        n.symbol("μ", "1", "cosθ"),
    )


def _exitance() -> Derivation:
    n = Notation()
    light, exitance = n.quantity("L", "radiance", "the same everywhere"), n.quantity("M", "radiant_exitance")
    theta, phi, mu = _angles(n)
    return Derivation(
        name="lambertian-exitance",
        title="The exitance of a Lambertian source",
        statement="A source of the same radiance in all directions has the exitance M = π L (π in sr).",
        assumptions=("L does not depend on direction",),
        notation=n,
        steps=(
            premise(
                exitance,
                Integral(light * cos(theta) * SR * sin(theta), (theta, 0, pi / 2), (phi, 0, 2 * pi)),
                "M = ∫ L cosθ dω over the hemisphere, dω = Ω₀ sinθ dθ dφ",
            ),
            follows(
                exitance,
                2 * pi * SR * light * Integral(cos(theta) * sin(theta), (theta, 0, pi / 2)),
                "nothing depends on the azimuth",
            ),
            follows(
                exitance, 2 * pi * SR * light * Integral(mu, (mu, 0, 1)), "μ = cosθ", change={mu: cos(theta)}
            ),
            follows(exitance, pi * SR * light, "∫ μ dμ = 1/2"),
        ),
        source=LAMBERT,
        tags=("exitance", "lecture"),
    )


def _intensity() -> Derivation:
    n = Notation()
    light, area = n.quantity("L", "radiance", "the same everywhere"), n.symbol("A", "m^2", "of the source")
    theta = n.angle("θ", "from the normal")
    intensity = n.quantity("I", "radiant_intensity", of=(theta,))
    axial = n.quantity("I_0", "radiant_intensity", "along the normal")
    return Derivation(
        name="lambertian-intensity",
        title="Lambert's cosine law",
        statement="A flat Lambertian source has the intensity I(θ) = I₀ cosθ.",
        assumptions=("L does not depend on direction or place", "the source is flat"),
        notation=n,
        steps=(
            premise(intensity(theta), light * area * cos(theta), "dI = L cosθ dA, over the source"),
            premise(axial, intensity(S.Zero), "I₀ is the intensity along the normal"),
            follows(axial, light * area, "cos 0 = 1", "I(θ)"),
            follows(intensity(theta), axial * cos(theta), "L A is I₀", "I_0"),
        ),
        source=LAMBERT,
        tags=("intensity", "lecture"),
    )


def _disk_flux() -> Derivation:
    n = Notation()
    axial = n.quantity("I_0", "radiant_intensity", "along the normal")
    flux = n.quantity("Φ", "radiant_flux", "of one side")
    theta, phi, mu = _angles(n)
    return Derivation(
        name="lambertian-disk-flux",
        title="The flux of a flat Lambertian source",
        statement="Φ = π I₀ (π in sr): a quarter of what an isotropic source of that intensity gives.",
        assumptions=("I(θ) = I₀ cosθ on one side, nothing on the other",),
        notation=n,
        steps=(
            premise(
                flux,
                Integral(axial * cos(theta) * SR * sin(theta), (theta, 0, pi / 2), (phi, 0, 2 * pi)),
                "Φ = ∫ I dω over the hemisphere",
            ),
            follows(
                flux,
                2 * pi * SR * axial * Integral(cos(theta) * sin(theta), (theta, 0, pi / 2)),
                "nothing depends on the azimuth",
            ),
            follows(
                flux, 2 * pi * SR * axial * Integral(mu, (mu, 0, 1)), "μ = cosθ", change={mu: cos(theta)}
            ),
            follows(flux, pi * SR * axial, "∫ μ dμ = 1/2"),
        ),
        source=at(ISO_LIGHT, "item 7-5.1"),
        tags=("flux",),
    )


def _brdf() -> Derivation:
    n = Notation()
    light, arriving = n.quantity("L_o", "radiance", "reflected"), n.quantity("E", "irradiance")
    exitance, rho = n.quantity("M", "radiant_exitance", "reflected"), n.quantity("ρ", "reflectance")
    f = n.quantity("f", "bsdf")
    return Derivation(
        name="lambertian-brdf",
        title="The BRDF of an ideal diffuse reflector",
        statement="f = ρ/π (π in sr); f = 1/π is the one that absorbs nothing.",
        assumptions=("the reflected radiance is the same in all directions",),
        notation=n,
        steps=(
            premise(f, light / arriving, "a BRDF is radiance per irradiance; here it is constant"),
            premise(rho, exitance / arriving, "definition of reflectance"),
            premise(exitance, pi * SR * light, "exitance of a Lambertian source (lambertian-exitance)"),
            follows(rho, pi * SR * light / arriving, "the exitance put in", "M"),
            follows(rho, pi * SR * f, "L_o/E is f", "f"),
            follows(f, rho / (pi * SR), "solved for f", "ρ", "f"),
        ),
        source=at(ISO_LIGHT, "item 7-31.3"),
        tags=("brdf", "lecture"),
    )


DERIVATIONS = (_exitance(), _intensity(), _disk_flux(), _brdf())
