"""Definitions: energy, flux, intensity, irradiance, exitance and radiance, each from the one before."""

from __future__ import annotations

from sympy import Derivative, Integral, cos

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import Notation
from radiokit.physics.relations.sources import ISO_LIGHT, NICODEMUS_1963, at
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _energy_and_flux() -> Derivation:
    n = Notation()
    t, s = n.symbol("t", "s", "time"), n.symbol("s", "s", "time")
    flux = n.quantity("Φ", "radiant_flux", of=(t,))
    energy = n.quantity("Q", "radiant_energy", of=(t,))
    return Derivation(
        name="flux-from-energy",
        title="Flux is the rate of energy",
        statement="Energy is the integral of flux over time, Q = ∫ Φ dt, hence Φ = dQ/dt.",
        notation=n,
        steps=(
            premise(energy(t), Integral(flux(s), (s, 0, t)), "definition of the energy since time 0"),
            follows(Derivative(energy(t), t), flux(t), "the derivative of an integral by its end", "Q(t)"),
        ),
        source=at(ISO_LIGHT, "items 7-2.1 and 7-4.1"),
        tags=("definition", "lecture"),
    )


def _spectral_flux() -> Derivation:
    n = Notation()
    wave, end = n.symbol("λ", "nm", "wavelength"), n.symbol("Λ", "nm", "the longest wavelength counted")
    whole = n.quantity("Φ", "radiant_flux", "up to a wavelength", of=(end,))
    part = n.quantity("Φ_λ", "spectral_radiant_flux", of=(wave,))
    return Derivation(
        name="spectral-flux",
        title="A spectral quantity is a density over wavelength",
        statement="Φ = ∫ Φ_λ dλ, hence Φ_λ = dΦ/dλ; likewise for every other quantity.",
        notation=n,
        steps=(
            premise(whole(end), Integral(part(wave), (wave, 0, end)), "all wavelengths up to Λ"),
            follows(
                Derivative(whole(end), end), part(end), "the derivative of an integral by its end", "Φ(Λ)"
            ),
        ),
        source=at(ISO_LIGHT, "item 7-4.2"),
        tags=("definition", "spectral"),
    )


def _graph() -> Derivation:
    n = Notation()
    light, theta = n.quantity("L", "radiance"), n.angle("θ", "from the normal")
    dA, dw = n.differential("dA", "m^2"), n.differential("dω", "sr")
    beam = n.quantity("d2Φ", "radiant_flux", order=2)
    dE, dM = n.quantity("dE", "irradiance", order=1), n.quantity("dM", "radiant_exitance", order=1)
    dI = n.quantity("dI", "radiant_intensity", order=1)
    return Derivation(
        name="definition-graph",
        title="From flux to intensity, irradiance, exitance and radiance",
        statement="The flux of a narrow beam, d²Φ = L cosθ dω dA, divided by dA or dω, gives the others.",
        notation=n,
        steps=(
            premise(light, beam / (dw * dA * cos(theta)), "definition of radiance"),
            premise(dE, beam / dA, "irradiance is the flux that arrives per area"),
            premise(dM, beam / dA, "exitance is the flux that leaves per area"),
            premise(dI, beam / dw, "intensity is the flux per solid angle"),
            follows(beam, light * cos(theta) * dw * dA, "solved for the flux", "L"),
            follows(dI, light * cos(theta) * dA, "the element's intensity", ("L", beam)),
            follows(dM, light * cos(theta) * dw, "the exitance into dω", ("L", beam)),
            follows(dE, light * cos(theta) * dw, "the irradiance from dω", ("L", beam)),
        ),
        source=at(ISO_LIGHT, "items 7-5.1 to 7-8.1"),
        tags=("definition", "lecture"),
    )


def _radiance_from_others() -> Derivation:
    n = Notation()
    light, theta = n.quantity("L", "radiance"), n.angle("θ", "from the normal")
    dA, dw = n.differential("dA", "m^2"), n.differential("dω", "sr")
    beam = n.quantity("d2Φ", "radiant_flux", order=2)
    dE, dM = n.quantity("dE", "irradiance", order=1), n.quantity("dM", "radiant_exitance", order=1)
    dI = n.quantity("dI", "radiant_intensity", order=1)
    return Derivation(
        name="radiance-from-others",
        title="Radiance by intensity, irradiance and exitance",
        statement="L = dI/(dA cosθ) = dE/(dω cosθ) = dM/(dω cosθ).",
        notation=n,
        steps=(
            premise(light, beam / (dw * dA * cos(theta)), "definition of radiance"),
            premise(dI, beam / dw, "intensity is the flux per solid angle"),
            premise(dE, beam / dA, "irradiance is the flux that arrives per area"),
            premise(dM, beam / dA, "exitance is the flux that leaves per area"),
            follows(light, dI / (dA * cos(theta)), "by intensity", "dI"),
            follows(light, dE / (dw * cos(theta)), "by irradiance", "dI", ("dE", beam)),
            follows(light, dM / (dw * cos(theta)), "by exitance", "dE", ("dM", beam)),
        ),
        source=at(NICODEMUS_1963, "the definition of radiance"),
        tags=("definition", "lecture"),
    )


def _irradiance_from_radiance() -> Derivation:
    n = Notation()
    w, cone = n.symbol("ω", "sr", "solid angle, swept"), n.symbol("Ω", "sr", "the whole solid angle")
    theta = n.symbol("θ", "rad", "from the normal, towards each part", of=(w,))
    light = n.quantity("L", "radiance", "that arrives from each part", of=(w,))
    local = n.quantity("E", "irradiance", "from the part swept so far", of=(w,))
    whole = n.quantity("E_Ω", "irradiance", "from all of Ω")
    return Derivation(
        name="irradiance-from-radiance",
        title="Irradiance from radiance",
        statement="E = ∫ L cosθ dω over the directions from which light arrives.",
        assumptions=("light from different directions adds (linearity)", "E = 0 from no solid angle"),
        notation=n,
        steps=(
            premise(Derivative(local(w), w), light(w) * cos(theta(w)), "dE = L cosθ dω, by definition", "dE"),
            premise(whole, Integral(Derivative(local(w), w), (w, 0, cone)), "contributions add"),
            follows(whole, Integral(light(w) * cos(theta(w)), (w, 0, cone)), "dE put in", "dE"),
        ),
        source=at(NICODEMUS_1963, "the flux of a beam"),
        tags=("irradiance", "lecture"),
    )


DERIVATIONS = (
    _energy_and_flux(),
    _spectral_flux(),
    _graph(),
    _radiance_from_others(),
    _irradiance_from_radiance(),
)
