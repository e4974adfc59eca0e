"""Scattering laws: albedo, energy, reciprocity and the white furnace, which every material keeps."""

from __future__ import annotations

from sympy import Integral, Le, cos

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import Notation
from radiokit.physics.relations.sources import NICODEMUS_1963, NICODEMUS_1977, VEACH, at
from radiokit.physics.relations.steps import follows, holds, premise

__all__ = ["DERIVATIONS"]


def _albedo() -> Derivation:
    n = Notation()
    w, all_ = n.symbol("ω", "sr", "solid angle of reflection, swept"), n.symbol("Ω", "sr", "the hemisphere")
    f = n.quantity("f", "bsdf", of=(w,))
    theta = n.symbol("θ", "rad", "of reflection", of=(w,))
    light = n.quantity("L_o", "radiance", "reflected", of=(w,))
    arriving, exitance = n.quantity("E", "irradiance"), n.quantity("M", "radiant_exitance", "reflected")
    rho = n.quantity("ρ", "reflectance", "directional")
    return Derivation(
        name="directional-albedo",
        title="Directional albedo",
        statement="ρ = ∫ f cosθ dω over the hemisphere.",
        assumptions=("the light comes from one direction",),
        notation=n,
        steps=(
            premise(rho, exitance / arriving, "the reflected share of the flux that arrives"),
            premise(exitance, Integral(light(w) * cos(theta(w)), (w, 0, all_)), "M = ∫ L_o cosθ dω"),
            premise(light(w), f(w) * arriving, "L_o = f E, for light from one direction", "reflected"),
            follows(rho, Integral(light(w) * cos(theta(w)), (w, 0, all_)) / arriving, "put in", "M"),
            follows(rho, Integral(f(w) * cos(theta(w)), (w, 0, all_)), "E cancels", "reflected"),
        ),
        source=NICODEMUS_1977,
        tags=("albedo", "lecture"),
    )


def _energy() -> Derivation:
    n = Notation()
    w, all_ = n.symbol("ω", "sr", "solid angle, swept"), n.symbol("Ω", "sr", "the hemisphere")
    f = n.quantity("f", "bsdf", of=(w,))
    theta = n.symbol("θ", "rad", "of reflection", of=(w,))
    rho = n.quantity("ρ", "reflectance", "directional")
    came, left = (
        n.quantity("Φ_i", "radiant_flux", "that arrives"),
        n.quantity("Φ_r", "radiant_flux", "reflected"),
    )
    lost = n.quantity("Φ_a", "radiant_flux", "not reflected", nonnegative=True)
    whole = Integral(f(w) * cos(theta(w)), (w, 0, all_))
    return Derivation(
        name="energy-conservation",
        title="A BRDF conserves energy",
        statement="∫ f cosθ dω ≤ 1 for every direction of incidence.",
        assumptions=("the surface gives out no light of its own",),
        notation=n,
        steps=(
            premise(rho, left / came, "the reflected share of the flux that arrives"),
            premise(came, left + lost, "what is not reflected is absorbed or passes, and is not negative"),
            premise(whole, rho, "the share as an integral (directional-albedo)", "integral"),
            holds(Le(rho, 1, evaluate=False), "no more is reflected than arrives", "Φ_i", label="share"),
            holds(Le(whole, 1, evaluate=False), "the same of the integral", "ρ", "Φ_i"),
        ),
        source=NICODEMUS_1977,
        tags=("energy", "lecture"),
    )


def _reciprocity() -> Derivation:
    n = Notation()
    there = n.quantity("f_io", "bsdf", "from i to o")
    back = n.quantity("f_oi", "bsdf", "from o to i")
    light = n.quantity("L", "radiance", "in equilibrium, the same everywhere")
    ti, to = n.angle("θ_i"), n.angle("θ_o")
    wi, wo, dA = n.differential("dω_i", "sr"), n.differential("dω_o", "sr"), n.differential("dA", "m^2")
    forth = n.quantity("d3Φ_io", "radiant_flux", "from i to o", order=3)
    again = n.quantity("d3Φ_oi", "radiant_flux", "from o to i", order=3)
    return Derivation(
        name="reciprocity",
        title="Helmholtz reciprocity of a BRDF",
        statement="f(i → o) = f(o → i).",
        assumptions=("thermal equilibrium keeps detailed balance", "no magnetic fields, no motion"),
        notation=n,
        steps=(
            premise(forth, there * light * cos(ti) * wi * cos(to) * wo * dA, "reflected from i to o"),
            premise(again, back * light * cos(to) * wo * cos(ti) * wi * dA, "reflected from o to i"),
            premise(forth, again, "detailed balance", "balance"),
            follows(there, forth / (light * cos(ti) * wi * cos(to) * wo * dA), "solved", ("d3Φ_io", there)),
            follows(there, back, "the flux back put in", "balance", "d3Φ_oi"),
        ),
        source=NICODEMUS_1977,
        tags=("reciprocity", "lecture"),
    )


def _btdf() -> Derivation:
    n = Notation()
    there, back = n.quantity("f_12", "bsdf", "from 1 to 2"), n.quantity("f_21", "bsdf", "from 2 to 1")
    n1, n2 = n.symbol("n_1", "1", "index of refraction"), n.symbol("n_2", "1", "index of refraction")
    basic = n.quantity("L_0", "radiance", "in equilibrium, in vacuum")
    L1, L2 = n.quantity("L_1", "radiance", "in equilibrium"), n.quantity("L_2", "radiance", "in equilibrium")
    t1, t2 = n.angle("θ_1"), n.angle("θ_2")
    w1, w2, dA = n.differential("dω_1", "sr"), n.differential("dω_2", "sr"), n.differential("dA", "m^2")
    forth = n.quantity("d3Φ_12", "radiant_flux", "from 1 to 2", order=3)
    again = n.quantity("d3Φ_21", "radiant_flux", "from 2 to 1", order=3)
    return Derivation(
        name="btdf-reciprocity",
        title="Reciprocity of a BTDF",
        statement="f(1 → 2)/n₂² = f(2 → 1)/n₁²: equal only where the indices are.",
        assumptions=("thermal equilibrium keeps detailed balance",),
        notation=n,
        steps=(
            premise(L1, n1**2 * basic, "L/n² is the same on both sides (radiance-across-an-interface)"),
            premise(L2, n2**2 * basic, "L/n² is the same on both sides"),
            premise(forth, there * L1 * cos(t1) * w1 * cos(t2) * w2 * dA, "transmitted from 1 to 2"),
            premise(again, back * L2 * cos(t2) * w2 * cos(t1) * w1 * dA, "transmitted from 2 to 1"),
            follows(there, forth / (L1 * cos(t1) * w1 * cos(t2) * w2 * dA), "solved", ("d3Φ_12", there)),
            premise(forth, again, "detailed balance", "balance"),
            follows(there, back * L2 / L1, "the flux back put in", "balance", "d3Φ_21"),
            follows(there / n2**2, back / n1**2, "radiances put in", "f_12", "L_1", "L_2"),
        ),
        source=at(VEACH, "chapter 5"),
        tags=("reciprocity", "refraction", "lecture"),
    )


def _balance() -> Derivation:
    n = Notation()
    flux = {
        name: n.quantity(f"Φ_{name}", "radiant_flux", words)
        for name, words in (
            ("i", "that arrives"),
            ("r", "reflected"),
            ("t", "transmitted"),
            ("a", "absorbed"),
        )
    }
    rho, tau = n.quantity("ρ", "reflectance"), n.symbol("τ", "1", kind="transmittance")
    alpha = n.symbol("α", "1", kind="absorptance")
    return Derivation(
        name="flux-balance",
        title="The balance of flux",
        statement="Φ_i = Φ_r + Φ_t + Φ_a, hence ρ + τ + α = 1.",
        assumptions=("no fluorescence: nothing changes its wavelength",),
        notation=n,
        steps=(
            premise(flux["i"], flux["r"] + flux["t"] + flux["a"], "energy is conserved"),
            premise(rho, flux["r"] / flux["i"], "definition of reflectance"),
            premise(tau, flux["t"] / flux["i"], "definition of transmittance"),
            premise(alpha, flux["a"] / flux["i"], "definition of absorptance"),
            follows(rho + tau + alpha, 1, "divided by Φ_i", "ρ", "τ", "α", "Φ_i", label="shares"),
        ),
        source=NICODEMUS_1963,
        tags=("energy", "lecture"),
    )


def _furnace() -> Derivation:
    n = Notation()
    w, all_ = n.symbol("ω", "sr", "solid angle, swept"), n.symbol("Ω", "sr", "the hemisphere")
    f = n.quantity("f", "bsdf", of=(w,))
    theta = n.symbol("θ", "rad", "of incidence", of=(w,))
    arriving = n.quantity("L", "radiance", "from everywhere")
    light, rho = n.quantity("L_o", "radiance", "reflected"), n.quantity("ρ", "reflectance", "directional")
    return Derivation(
        name="white-furnace",
        title="The white furnace",
        statement="Under uniform light L_o = ρ L: a surface that absorbs nothing cannot be seen.",
        assumptions=("the same radiance arrives from all directions",),
        notation=n,
        steps=(
            premise(
                light, Integral(f(w) * arriving * cos(theta(w)), (w, 0, all_)), "the reflection integral"
            ),
            premise(
                rho, Integral(f(w) * cos(theta(w)), (w, 0, all_)), "ρ = ∫ f cosθ dω (directional-albedo)"
            ),
            follows(light, arriving * Integral(f(w) * cos(theta(w)), (w, 0, all_)), "L is constant"),
            follows(light, rho * arriving, "the integral is ρ", "ρ"),
        ),
        source=VEACH,
        tags=("energy",),
    )


DERIVATIONS = (_albedo(), _energy(), _reciprocity(), _btdf(), _balance(), _furnace())
