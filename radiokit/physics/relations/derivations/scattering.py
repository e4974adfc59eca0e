"""Scattering: the BRDF, the reflection integral, albedo, and the laws that every material keeps."""

from __future__ import annotations

from sympy import DiracDelta, Integral, Le, Sum, cos, oo

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import NICODEMUS_1963, NICODEMUS_1977, VEACH, at
from radiokit.physics.relations.steps import follows, holds, premise

__all__ = ["DERIVATIONS"]


def _brdf() -> Derivation:
    n = Notation()
    f, theta = n.quantity("f", "bsdf"), n.angle("θ_i", "of incidence")
    arriving, reflected = (
        n.quantity("L_i", "radiance", "that arrives"),
        n.quantity("dL_o", "radiance", order=1),
    )
    dE, dw = n.quantity("dE", "irradiance", order=1), n.differential("dω_i", "sr")
    return Derivation(
        name="brdf-definition",
        title="The BRDF, from linearity",
        statement="f = dL_o/dE = dL_o/(L_i cosθ_i dω_i): L_i, not dL_i, stands below.",
        assumptions=("linearity: twice the light gives twice the reflection",),
        notation=n,
        steps=(
            premise(reflected, f * dE, "linearity: dL_o is proportional to dE, and f is the factor"),
            premise(dE, arriving * cos(theta) * dw, "irradiance from dω_i"),
            follows(f, reflected / dE, "solved for f", ("dL_o", f)),
            follows(f, reflected / (arriving * cos(theta) * dw), "the irradiance put in", "dE"),
        ),
        source=at(NICODEMUS_1977, "equation 5"),
        tags=("brdf", "lecture"),
    )


def _unit() -> Derivation:
    n = Notation()
    f, number = n.quantity("f", "bsdf"), n.symbol("k", "1", "the value of f in 1/sr")
    light, arriving = n.quantity("L_o", "radiance"), n.quantity("E", "irradiance")
    watt, metre = n.symbol("W_1", "W", "one watt"), n.symbol("m_1", "m", "one metre")
    a, b = n.symbol("a", "1", "the radiance in W/(m² sr)"), n.symbol("b", "1", "the irradiance in W/m²")
    return Derivation(
        name="brdf-unit",
        title="The unit of a BRDF",
        statement="A BRDF is in 1/sr: radiance per irradiance.",
        notation=n,
        steps=(
            premise(f, light / arriving, "definition, for light from one direction"),
            premise(light, a * watt / (metre**2 * SR), "radiance in its unit"),
            premise(arriving, b * watt / metre**2, "irradiance in its unit"),
            premise(number, a / b, "the quotient of the numbers"),
            follows(f, number / SR, "watts and metres cancel, the steradian stays", "L_o", "E", "k"),
        ),
        source=at(NICODEMUS_1977, "equation 5"),
        tags=("brdf", "lecture"),
    )


def _reflection() -> Derivation:
    n = Notation()
    w, all_ = n.symbol("ω", "sr", "solid angle, swept"), n.symbol("Ω", "sr", "the hemisphere")
    f = n.quantity("f", "bsdf", of=(w,))
    theta = n.symbol("θ", "rad", "of incidence", of=(w,))
    arriving = n.quantity("L_i", "radiance", "that arrives", of=(w,))
    rate = n.symbol("l", "W/(m^2 sr^2)", "radiance reflected per solid angle of incidence", of=(w,))
    light = n.quantity("L_o", "radiance", "reflected")
    return Derivation(
        name="reflection-integral",
        title="The reflection integral",
        statement="L_o = ∫ f L_i cosθ_i dω_i over the hemisphere.",
        assumptions=("linearity: light from different directions adds",),
        notation=n,
        steps=(
            premise(
                rate(w), f(w) * arriving(w) * cos(theta(w)), "dL_o/dω = f L_i cosθ (brdf-definition)", "rate"
            ),
            premise(light, Integral(rate(w), (w, 0, all_)), "contributions add"),
            follows(light, Integral(f(w) * arriving(w) * cos(theta(w)), (w, 0, all_)), "put in", "rate"),
        ),
        source=at(NICODEMUS_1977, "section III"),
        tags=("brdf", "lecture"),
    )


def _delta_lights() -> Derivation:
    n = Notation()
    count = n.symbol("m", "1", "number of lights", integer=True, positive=True)
    j = n.symbol("j", "1", "number of a light", integer=True, positive=True)
    w = n.symbol("ω", "sr", "direction, swept", real=True)
    place = n.symbol("w", "sr", "direction of a light", of=(j,), real=True)
    f = n.quantity("f", "bsdf", of=(w,))
    theta = n.symbol("θ", "rad", "of incidence", of=(w,))
    normal = n.quantity("E_n", "irradiance", "of a light, on a plane that faces it", of=(j,))
    one = n.quantity("l", "radiance", "reflected from one light", of=(j,))
    light = n.quantity("L_o", "radiance", "reflected")
    return Derivation(
        name="sum-over-delta-lights",
        title="The reflection integral of point lights is a sum",
        statement="L_o = Σ f E_j cosθ_j, with E_j the irradiance normal to the j-th light's direction, no radiance.",
        assumptions=("each light is seen in one direction only", "f is 0 beyond the hemisphere"),
        notation=n,
        steps=(
            premise(
                one(j),
                Integral(f(w) * normal(j) * DiracDelta(w - place(j)) * cos(theta(w)), (w, -oo, oo)),
                "the reflection integral of L_i = E_j δ(ω − ω_j)",
                "one",
            ),
            premise(light, Sum(one(j), (j, 1, count)), "lights add"),
            follows(
                one(j), f(place(j)) * normal(j) * cos(theta(place(j))), "the delta sifts", label="sifted"
            ),
            follows(
                light,
                Sum(f(place(j)) * normal(j) * cos(theta(place(j))), (j, 1, count)),
                "put in",
                "sifted",
            ),
        ),
        source=VEACH,
        tags=("brdf", "lecture"),
    )


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
        source=at(NICODEMUS_1977, "section V"),
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
        source=at(NICODEMUS_1977, "section V"),
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
        source=at(NICODEMUS_1977, "section III"),
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
        source=at(VEACH, "section 5.2"),
        tags=("reciprocity", "refraction", "lecture"),
    )


def _mirror() -> Derivation:
    n = Notation()
    mu, phi = n.symbol("μ", "1", "cosθ_i", real=True), n.symbol("φ", "rad", "azimuth", real=True)
    mu_o, phi_o = n.symbol("μ_o", "1", "cosθ_o"), n.angle("φ_o", "azimuth of the mirror direction")
    R = n.quantity("R", "reflectance", "of the mirror")
    f = n.quantity("f", "bsdf", of=(mu, phi))
    arriving = n.quantity("L_i", "radiance", "that arrives", of=(mu, phi))
    light, rho = n.quantity("L_o", "radiance", "reflected"), n.quantity("ρ", "reflectance", "directional")
    delta = R * DiracDelta(mu - mu_o) * DiracDelta(phi - phi_o) / (SR * mu_o)
    return Derivation(
        name="mirror-brdf",
        title="The BRDF of a mirror",
        statement="f = R δ(ω_i − mirror direction)/cosθ; its albedo is R, and 1 for a perfect mirror.",
        assumptions=("f is 0 beyond the hemisphere",),
        notation=n,
        steps=(
            premise(f(mu, phi), delta, "a delta over the cosine; dω = Ω₀ dμ dφ", "f"),
            premise(
                light,
                Integral(f(mu, phi) * arriving(mu, phi) * mu * SR, (mu, -oo, oo), (phi, -oo, oo)),
                "the reflection integral",
            ),
            premise(rho, Integral(f(mu, phi) * mu * SR, (mu, -oo, oo), (phi, -oo, oo)), "ρ = ∫ f cosθ dω"),
            follows(light, R * arriving(mu_o, phi_o), "the deltas sift: the mirrored radiance", "f"),
            follows(rho, R, "the cosine cancels", "f"),
        ),
        source=at(NICODEMUS_1977, "perfectly specular reflection"),
        tags=("brdf", "mirror", "lecture"),
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
            follows(
                flux["r"] / flux["i"] + flux["t"] / flux["i"] + flux["a"] / flux["i"],
                1,
                "divided by Φ_i",
                "Φ_i",
                label="shares",
            ),
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
        source=at(VEACH, "section 5.A"),
        tags=("energy",),
    )


def _bssrdf() -> Derivation:
    n = Notation()
    x, y = (n.symbol(name, "m", "from the point that is seen", real=True) for name in "xy")
    S = n.symbol("S", "1/(m^2 sr)", kind="BSSRDF", of=(x, y))
    f = n.quantity("f", "bsdf")
    arriving = n.quantity("E", "irradiance", "from one direction", of=(x, y))
    light = n.quantity("L_o", "radiance", "reflected")
    return Derivation(
        name="bssrdf-limit",
        title="The BRDF as the limit of the BSSRDF",
        statement="S = dL_o/dΦ_i in 1/(m² sr); where light leaves at the point where it enters, L_o = f E.",
        assumptions=("S = f δ(x) δ(y): no light wanders under the surface",),
        notation=n,
        steps=(
            premise(
                light,
                Integral(S(x, y) * arriving(x, y), (x, -oo, oo), (y, -oo, oo)),
                "dL_o = S dΦ_i = S E dA, over the surface",
            ),
            premise(S(x, y), f * DiracDelta(x) * DiracDelta(y), "a delta in place", "S"),
            follows(light, f * arriving(0, 0), "the deltas sift: the irradiance at the point itself", "S"),
        ),
        source=at(NICODEMUS_1977, "equation 1"),
        tags=("brdf", "bssrdf", "lecture"),
    )


DERIVATIONS = (
    _brdf(),
    _unit(),
    _reflection(),
    _delta_lights(),
    _albedo(),
    _energy(),
    _reciprocity(),
    _btdf(),
    _mirror(),
    _balance(),
    _furnace(),
    _bssrdf(),
)
