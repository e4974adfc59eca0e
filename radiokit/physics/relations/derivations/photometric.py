"""Photometric units: lumen, lux and nit from the candela, and the eye's weight."""

from __future__ import annotations

from sympy import DiracDelta, Integral, cos, oo, pi, sin

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import ISO_LIGHT, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _lumen() -> Derivation:
    n = Notation()
    intensity = n.quantity("I", "luminous_intensity", "the same in all directions")
    cone, omega = n.quantity("Φ_1", "luminous_flux", "into one steradian"), n.symbol("Ω", "sr", "of a cone")
    flux = n.quantity("Φ", "luminous_flux", "in all directions")
    candela = n.quantity("cd", "luminous_intensity", "one candela")
    lumen = n.quantity("lm", "luminous_flux", "one lumen")
    theta, phi = n.angle("θ", "from the pole"), n.angle("φ", "azimuth")
    return Derivation(
        name="lumen-from-candela",
        title="The lumen",
        statement="A lumen is the flux of one candela into one steradian; one candela all round gives 4π lm.",
        assumptions=("the source has the same intensity in all directions",),
        notation=n,
        steps=(
            premise(lumen, candela * SR, "definition of the lumen: lm = cd sr"),
            premise(cone, intensity * omega, "flux of a constant intensity into a cone"),
            premise(
                flux,
                Integral(intensity * SR * sin(theta), (theta, 0, pi), (phi, 0, 2 * pi)),
                "Φ = ∫ I dω over all directions",
            ),
            premise(intensity, candela, "one candela"),
            premise(omega, SR, "one steradian"),
            follows(cone, lumen, "one lumen", "I", "Ω", "lm"),
            follows(flux, 4 * pi * lumen, "4π lumens", "I", "lm"),
        ),
        source=at(ISO_LIGHT, "items 7-13 and 7-14"),
        tags=("photometry", "lecture"),
    )


def _lux() -> Derivation:
    n = Notation()
    candela, lumen = (
        n.quantity("cd", "luminous_intensity", "one candela"),
        n.quantity("lm", "luminous_flux", "one lumen"),
    )
    lux, metre = n.quantity("lx", "illuminance", "one lux"), n.symbol("m", "m", "one metre")
    intensity, arriving = n.quantity("I", "luminous_intensity"), n.quantity("E", "illuminance")
    theta, r = n.angle("θ", "of incidence"), n.symbol("r", "m", "distance")
    return Derivation(
        name="lux-from-candela",
        title="The lux",
        statement="One candela at one metre, seen squarely, gives one lux.",
        notation=n,
        steps=(
            premise(lumen, candela * SR, "definition of the lumen"),
            premise(lux, lumen / metre**2, "definition of the lux"),
            premise(
                arriving, SR * intensity * cos(theta) / r**2, "as of irradiance (irradiance-from-intensity)"
            ),
            premise(intensity, candela, "one candela"),
            premise(r, metre, "at one metre"),
            premise(theta, 0, "squarely"),
            follows(arriving, SR * candela / metre**2, "put in", "I", "r", "θ"),
            follows(arriving, lux, "one lux", "lx", "lm"),
        ),
        source=at(ISO_LIGHT, "item 7-16"),
        tags=("photometry", "lecture"),
    )


def _nit() -> Derivation:
    n = Notation()
    candela, lumen = (
        n.quantity("cd", "luminous_intensity", "one candela"),
        n.quantity("lm", "luminous_flux", "one lumen"),
    )
    nit, metre = n.quantity("nt", "luminance", "one nit"), n.symbol("m", "m", "one metre")
    light, exitance = n.quantity("L", "luminance"), n.quantity("M", "luminous_exitance")
    return Derivation(
        name="nit-from-candela",
        title="The nit",
        statement="A nit is one candela per square metre; a Lambertian source of one nit gives π lm/m².",
        assumptions=("the source is Lambertian",),
        notation=n,
        steps=(
            premise(nit, candela / metre**2, "definition of the nit"),
            premise(lumen, candela * SR, "definition of the lumen"),
            premise(exitance, pi * SR * light, "as of exitance (lambertian-exitance)"),
            premise(light, nit, "one nit"),
            follows(exitance, pi * SR * nit, "put in", "L"),
            follows(exitance, pi * lumen / metre**2, "in lumens", "nt", "lm"),
        ),
        source=at(ISO_LIGHT, "item 7-15"),
        tags=("photometry", "lecture"),
    )


def _weight() -> Derivation:
    n = Notation()
    wave, line = n.symbol("λ", "nm", "wavelength", real=True), n.symbol("λ_0", "nm", "of the line")
    weight = n.symbol("V", "1", "the eye's relative sensitivity", of=(wave,))
    K = n.symbol("K_m", "lm/W", "683 lm/W")
    part = n.quantity("Φ_λ", "spectral_radiant_flux", of=(wave,))
    whole, seen = n.quantity("Φ_e", "radiant_flux"), n.quantity("Φ_v", "luminous_flux")
    return Derivation(
        name="luminous-flux",
        title="Luminous flux is flux as the eye weighs it",
        statement="Φ_v = K_m ∫ V Φ_λ dλ; a line gives K_m V(λ₀) Φ_e.",
        assumptions=("the flux of the line is all at λ₀",),
        notation=n,
        steps=(
            premise(
                seen, K * Integral(weight(wave) * part(wave), (wave, -oo, oo)), "definition of luminous flux"
            ),
            premise(part(wave), whole * DiracDelta(wave - line), "a spectral line", "line"),
            follows(seen, K * weight(line) * whole, "the delta sifts", "line"),
        ),
        source=at(ISO_LIGHT, "item 7-13"),
        tags=("photometry", "spectral", "lecture"),
    )


DERIVATIONS = (_lumen(), _lux(), _nit(), _weight())
