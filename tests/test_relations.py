"""The dimension checker: wrong formulas are caught, with the message a student needs; right ones pass."""

from __future__ import annotations

import pickle

import pytest
import sympy
from sympy import DiracDelta, Integral, Limit, Piecewise, Sum, atan2, cos, exp, log, oo, pi, sin, sqrt, tan

import radiokit as rk
from radiokit.facts.errors import ParameterError
from radiokit.physics.relations import SR, Dimension, Notation, check_dimensions, eq
from radiokit.physics.relations.notation import HALF


class Symbols:
    """The symbols that the formulas below are made of."""

    def __init__(self):
        n = self.notation = Notation()
        self.L, self.L_o = n.quantity("L", "radiance"), n.quantity("L_o", "radiance")
        self.E, self.M = n.quantity("E", "irradiance"), n.quantity("M", "radiant_exitance")
        self.I, self.F = n.quantity("I", "radiant_intensity"), n.quantity("Φ", "radiant_flux")
        self.f, self.rho = n.quantity("f", "bsdf"), n.quantity("ρ", "reflectance")
        self.dE, self.dL_o = n.quantity("dE", "irradiance", order=1), n.quantity("dL_o", "radiance", order=1)
        self.dL_i = n.quantity("dL_i", "radiance", order=1)
        self.d2F = n.quantity("d2Φ", "radiant_flux", order=2)
        self.dw, self.dA = n.differential("dω", "sr"), n.differential("dA", "m^2")
        self.dtheta, self.dphi = (n.differential(name, "rad", order=HALF) for name in ("dθ", "dφ"))
        self.theta, self.phi, self.w = n.angle("θ"), n.angle("φ"), n.symbol("ω", "sr")
        self.r, self.x, self.t = n.symbol("r", "m"), n.symbol("x", "m"), n.symbol("t", "s")
        self.y, self.u = n.symbol("y", "m", real=True), n.symbol("u", "s", real=True)
        self.j, self.m = (n.symbol(name, integer=True, positive=True) for name in "jm")
        self.L_j, self.theta_j = n.quantity("L_j", "radiance", of=(self.j,)), n.angle("θ_j", of=(self.j,))
        self.E_j = n.quantity("E_j", "irradiance", of=(self.j,))
        self.L_w = n.quantity("L_i", "radiance", of=(self.w,))
        self.Q = n.quantity("Q", "radiant_energy", of=(self.t,))
        self.tau = n.symbol("τ", kind="transmittance")
        self.dB = n.quantity("dB", "radiance", order=1)


S = Symbols()

WRONG = {
    "irradiance without its solid angle": (
        eq(S.dE, S.L * cos(S.theta)),
        "unit",
        "dE = L*cos(θ): the left side is a differential of irradiance [W/m²], the right side is radiance "
        "[W/(m² sr)]; expected the same unit on both sides; a solid angle dω is missing on the right",
    ),
    "a sum of radiances over lights": (
        eq(S.L_o, Sum(S.f * S.L_j(S.j) * cos(S.theta_j(S.j)), (S.j, 0, S.m - 1))),
        "unit",
        "the right side is a quantity [W/(m² sr²)]; expected the same unit on both sides; "
        "a solid angle (Δω_j, or Ω₀ = 1 sr) is missing on the right",
    ),
    "intensity plus flux": (
        S.I + S.F,
        "unit",
        "I is radiant intensity [W/sr], Φ is radiant flux [W]; expected terms of one unit in a sum; "
        "they differ by a factor in sr",
    ),
    "irradiance compared with exitance": (
        eq(S.E, S.M),
        "kind",
        "the unit is the same, the quantity is not: irradiance is the flux that arrives per area, "
        "radiant exitance is the flux that leaves per area",
    ),
    "irradiance below exitance": (S.E < S.M, "kind", "the unit is the same, the quantity is not"),
    "irradiance plus twice exitance": (S.E + 2 * S.M, "kind", "the unit is the same, the quantity is not"),
    "the larger of irradiance and exitance": (sympy.Max(S.E, S.M), "kind", "terms of one kind in Max"),
    "a BRDF over dL_i": (
        eq(S.f, S.dL_o / (S.dL_i * cos(S.theta) * S.dw)),
        "order",
        "a differential is missing on the right, or L_i, not dL_i, is meant below the fraction bar",
    ),
    "a radiance that is a differential": (
        eq(S.L, S.dL_o),
        "order",
        "a differential is missing on the left, or too many stand on the right",
    ),
    "flux by a number times intensity": (eq(S.F, 4 * pi * S.I), "unit", "Ω₀ = 1 sr) is missing on the right"),
    "a BRDF that is a number": (eq(S.f, 1 / pi), "unit", "Ω₀ = 1 sr) is missing on the left"),
    "the sine of a length": (
        sin(S.x),
        "function",
        "the argument x of sin is a length [m]",
    ),
    "the tangent of a solid angle": (tan(S.w / 2), "function", "divide by the unit solid angle Ω₀ = 1 sr"),
    "the exponential of a differential": (exp(S.dtheta), "function", "a function takes no differential"),
    "an exponent with a unit": (S.r**S.x, "exponent", "the exponent x is a length [m]; expected a number"),
    "an unknown power of a unit": (S.r**S.rho, "exponent", "the exponent ρ is not known"),
    "a flux missing an area": (
        eq(S.d2F, S.L * cos(S.theta) * S.dw),
        "unit",
        "an area dA is missing on the right",
    ),
    "an energy missing a time": (eq(S.Q(S.t), S.F), "unit", "a time is missing on the right"),
    "a bound of another unit": (Integral(S.L_w(S.w), (S.w, 0, S.x)), "unit", "a variable and its bounds"),
    "a limit at another unit": (Limit(S.r, S.r, S.t), "unit", "terms of one unit in a limit"),
    "cases of different units": (Piecewise((S.E, S.x > S.r), (S.L, True)), "unit", "in the cases"),
    "a length compared with a number": (S.x > 1, "unit", "a length or a wavelength is missing on the right"),
    "an angle of two units": (atan2(S.y, S.u), "unit", "terms of one unit in atan2"),
    "a function at another unit": (S.L_w(S.x), "function", "expected a solid angle [sr]"),
    "a symbol without meaning": (sympy.Symbol("q") * S.E, "unknown", "nothing says what it means"),
    "a function without meaning": (sympy.Function("g")(S.E), "unknown", "nothing says what g means"),
    "a function that is not known": (sympy.besselj(0, S.theta), "unknown", "besselj is not understood"),
}

RIGHT = {
    "irradiance from a solid angle": eq(S.dE, S.L * cos(S.theta) * S.dw),
    "flux of a beam": eq(S.d2F, S.L * cos(S.theta) * S.dw * S.dA),
    "radiance by flux": eq(S.L, S.d2F / (S.dw * S.dA * cos(S.theta))),
    "a BRDF over L_i": eq(S.f, S.dL_o / (S.L * cos(S.theta) * S.dw)),
    "a sum of irradiances over lights": eq(
        S.L_o, Sum(S.f * S.E_j(S.j) * cos(S.theta_j(S.j)), (S.j, 0, S.m - 1))
    ),
    "a solid angle of two sides": eq(S.dw, SR * sin(S.theta) * S.dtheta * S.dphi),
    "irradiance by an integral": eq(S.E, Integral(S.L_w(S.w) * cos(S.theta), (S.w, 0, 2 * pi * SR))),
    "a delta in a direction": eq(S.L, S.E * DiracDelta(S.w - SR)),
    "a derivative": eq(sympy.Derivative(S.Q(S.t), S.t), S.F),
    "the inverse square": eq(S.E, SR * S.I * cos(S.theta) / S.r**2),
    "a quotient in a logarithm": eq(S.theta, log(S.x / S.r) + sqrt(S.x**2 + S.r**2) / S.r),
    "nothing": eq(S.E, 0),
    "no light on one side": eq(S.E, Piecewise((0, S.x < 0), (S.rho * S.E, True))),
    "an infinite bound": eq(S.E, Limit(S.E * S.r / (S.r + S.x), S.r, oo)),
    "exitance by a reflectance": eq(S.M, S.rho * S.E),
    "shares of different kinds": eq(S.rho + S.tau, 1),
    "a tangent of a solid angle over the unit": tan(S.w / (2 * SR)),
    "an angle": eq(S.theta, atan2(S.y, S.y)),
    "differentials of one order": eq(S.dL_o + S.dB, S.f * S.dE),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_caught_and_explained(name):
    expression, code, words = WRONG[name]
    found = check_dimensions(expression, S.notation)
    assert not found.ok
    assert found.clashes[0].code == code
    assert words in str(found)
    assert found.clashes[0].to_json()["code"] == code


@pytest.mark.parametrize("name", RIGHT)
def test_what_is_right_is_let_through(name):
    found = check_dimensions(RIGHT[name], S.notation)
    assert found.ok, str(found)
    assert str(found) == "units, kinds and differentials agree"


def test_what_a_formula_is():
    found = check_dimensions(2 * S.L * cos(S.theta), S.notation)
    assert (str(found.dimension), found.kind, found.order) == ("W/(m² sr)", "radiance", 0)
    found = check_dimensions(S.L * S.dw, S.notation)
    assert (str(found.dimension), found.kind, found.order) == ("W/m²", "", 1)


@pytest.mark.parametrize("name", rk.list_quantities())
def test_every_quantity_has_a_dimension_that_reads_back(name):
    dimension = Dimension.of(rk.quantity(name).unit)
    superscripts = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
    text = str(dimension)
    spelled = "".join(f"^{c.translate(superscripts)}" if c in "²³⁴" else c for c in text)
    assert Dimension.of(spelled) == dimension, text


def test_half_a_power_of_a_unit():
    assert Dimension.of("m^4") ** HALF == Dimension.of("m^2")
    assert check_dimensions(sqrt(S.x * S.r), S.notation).dimension == Dimension.of("m")


def test_a_notation_says_what_its_symbols_are():
    assert S.notation.describe(S.E) == "E: irradiance [W/m²]"
    assert S.notation.describe(S.dE) == "dE: differential of irradiance [W/m²]"
    assert S.notation.describe(S.dw) == "dω: differential of solid angle [sr]"
    assert S.notation.describe(S.theta) == "θ: angle"
    assert S.notation.latex(eq(S.dE, S.L * S.dw)) == r"\mathrm{d}E = L \mathrm{d}\omega"
    with pytest.raises(ParameterError, match="name = 'E'"):
        S.notation.quantity("E", "irradiance")
    with pytest.raises(ParameterError, match="symbol = q"):
        S.notation.meaning(sympy.Symbol("q"))


def test_findings_cross_a_process_boundary():
    found = check_dimensions(WRONG["intensity plus flux"][0], S.notation)
    assert pickle.loads(pickle.dumps(found)) == found
