"""BRDFs: the definition and its unit, the reflection integral, mirrors, and light that wanders below."""

from __future__ import annotations

from sympy import DiracDelta, Integral, Sum, cos, oo

from radiokit.physics.relations.derivation import Derivation
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.sources import NICODEMUS_1977, VEACH
from radiokit.physics.relations.steps import follows, premise

__all__ = ["DERIVATIONS"]


def _brdf() -> Derivation:
    n = Notation()
    f, theta = n.quantity("f", "bsdf"), n.angle("θ_i", "of incidence")
    some = n.quantity("E", "irradiance", "from the direction of incidence")
    answer = n.quantity("Λ", "radiance", "reflected from so much irradiance", of=(some,))
    times = n.symbol("k", "1", "how often as much")
    arriving, reflected = (
        n.quantity("L_i", "radiance", "that arrives"),
        n.quantity("dL_o", "radiance", order=1),
    )
    dE, dw = n.quantity("dE", "irradiance", order=1), n.differential("dω_i", "sr")
    return Derivation(
        name="brdf-definition",
        title="The BRDF, from linearity",
        statement="f = dL_o/dE = dL_o/(L_i cosθ_i dω_i): L_i, not dL_i, stands below.",
        assumptions=("linearity: k times the light gives k times the reflection",),
        notation=n,
        steps=(
            premise(answer(times * some), times * answer(some), "linearity", "linear"),
            follows(
                answer(times * some) / (times * some),
                answer(some) / some,
                "radiance over irradiance is the same for any irradiance",
                "linear",
                label="quotient",
            ),
            premise(f, answer(some) / some, "that quotient is the BRDF"),
            follows(
                answer(some),
                f * some,
                "reflected radiance is proportional to irradiance",
                ("f", answer(some)),
            ),
            premise(reflected, f * dE, "so it is of the irradiance from dω_i"),
            premise(dE, arriving * cos(theta) * dw, "irradiance from dω_i"),
            follows(f, reflected / dE, "solved for f", "dL_o", "f"),
            follows(f, reflected / (arriving * cos(theta) * dw), "the irradiance put in", "dE"),
        ),
        source=NICODEMUS_1977,
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
        source=NICODEMUS_1977,
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
        source=NICODEMUS_1977,
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
        statement="L_o = Σ f E_j cosθ_j, E_j the irradiance on a plane that faces the j-th light.",
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
        source=NICODEMUS_1977,
        tags=("brdf", "mirror", "lecture"),
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
        source=NICODEMUS_1977,
        tags=("brdf", "bssrdf", "lecture"),
    )


DERIVATIONS = (_brdf(), _unit(), _reflection(), _delta_lights(), _mirror(), _bssrdf())
