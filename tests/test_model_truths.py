"""Every model against its twin: values at hard pairs and extreme parameters, albedos against integrals."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import partial

import mpmath
import numpy as np
import pytest
import sympy

from radiokit.bsdfs.beckmann import Beckmann
from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.albedo import albedo, directional_albedo
from radiokit.contracts.bsdf import REGISTRY
from radiokit.contracts.parameters import Parameter
from radiokit.faces.cli import main
from radiokit.faces.stability.albedos import albedo_row, model_albedos
from radiokit.faces.stability.charts import refracted_chart, slope_chart, sphere_chart
from radiokit.faces.stability.grid import edge_pairs, examples, extremes, hard_pairs, parameter_ends
from radiokit.faces.stability.measure import LIMIT
from radiokit.faces.stability.models import examine, model_stability
from radiokit.faces.stability.sides import Rule, Side
from radiokit.faces.stability.truth import NoTruthError, twin_albedo
from radiokit.facts.directions import half_vector, spherical_to_cartesian
from radiokit.facts.errors import UnknownNameError
from radiokit.facts.verdict import Outcome
from radiokit.measure.twin import Twin, working_precision


@pytest.fixture
def run(capfd):
    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main(["stability", *arguments])
        out, err = capfd.readouterr()
        return stop.value.code or 0, out, err

    return call


@dataclass(frozen=True, kw_only=True)
class Sheet(Lambert):
    """A diffuse sheet of which the same share passes, between media of different indices."""

    name = ""
    transmissive = True
    eta: float = 1.5

    def relative_index(self):
        return self.eta

    def symbolic(self):
        twin = Lambert.symbolic(self)
        z_i, z_o = twin.arguments[2], twin.arguments[5]
        passing = sympy.Piecewise((1 / sympy.Float(self.eta) ** 2, z_i < 0), (self.eta**2, True))
        whole = sympy.Piecewise((twin.expression, z_i * z_o > 0), (twin.expression * passing, True))
        return Twin(whole, twin.parameters)


# Values


def test_the_grid_has_every_kind_of_hard_pair(rng):
    wi, wo = (np.concatenate(side) for side in zip(hard_pairs(GGX(), rng), edge_pairs(GGX()), strict=True))
    assert wi.shape == wo.shape
    assert (wi[:, 2] > 0).all()
    assert np.min(wo[:, 2]) < 2e-6
    mirror = np.hypot(*(wi + wo)[:, :2].T)
    assert (mirror < 1e-15).any()
    assert ((mirror > 1e-10) & (mirror < 1e-8)).any()
    assert (np.abs(wi - wo).max(axis=1) == 0).any()
    assert ((wi[:, 2] == wo[:, 2]) & (wi[:, 0] != wo[:, 0])).any()
    assert ((np.hypot(*wi[:, :2].T) < 2e-9) & (np.hypot(*wi[:, :2].T) > 0)).any()
    slopes = np.sort(np.unique((mirror / (wi + wo)[:, 2] / GGX().alpha).round(6)))
    assert {0.1, 1.0, 10.0} <= set(slopes.tolist())


def test_what_transmits_is_seen_from_all_sides_and_near_the_critical_angle(rng):
    sheet = Sheet()
    wi, wo = (np.concatenate(side) for side in zip(hard_pairs(sheet, rng), edge_pairs(sheet), strict=True))
    assert len(set(zip(wi[:, 2] > 0, wo[:, 2] > 0, strict=True))) == 4
    sines = np.hypot(*wo[wi[:, 2] * wo[:, 2] < 0, :2].T)
    gaps = np.abs(np.arcsin(np.clip(sines, 0, 1)) - np.arcsin(1 / 1.5))
    assert (gaps < 2e-9).any()
    assert ((gaps > 5e-4) & (gaps < 2e-3)).any()
    bent = np.abs(
        wi[:, :2] * np.where(wi[:, 2:] < 0, 1.5, 1.0) + wo[:, :2] * np.where(wo[:, 2:] < 0, 1.5, 1.0)
    )
    assert ((bent.max(axis=1) < 1e-15) & (wi[:, 2] * wo[:, 2] < 0)).sum() > 5


def test_extremes_come_from_the_declared_ranges():
    found, _ = extremes(GGX)
    assert {f.alpha for f in found} >= {1e-4, 1.0}
    assert {f.eta for f in found} >= {1e-6, 1e6}
    assert any(f.eta is not None and f.alpha == 1e-4 for f in found)
    assert not set(found) & set(examples(GGX))
    assert parameter_ends(Parameter("[0, 1)", "1", "share")) == (0.0, 1 - 1e-6)


def test_a_spectrum_is_examined_at_each_wavelength():
    class Coloured(Lambert):
        name = ""
        EXAMPLES = ({"reflectance": (0.2, 0.4)},)

    assert [f.reflectance for f in examples(Coloured)] == [0.2, 0.4]


def test_models_hold_and_are_counted():
    for result in model_stability(["lambert", "phong", "mirror"]):
        assert result.outcome is Outcome.HOLDS, result.worst
        cls = REGISTRY.get(result.name)
        assert len(result.sets) == len(examples(cls)) + len(extremes(cls)[0])
        assert all(found.pairs > 50 and not found.nonfinite for found in result.sets)


class Sloppy(GGX):
    """Planted: D with (α² − 1) cos² + 1, which loses the digits of a small α."""

    name = ""

    def evaluate(self, wi, wo):
        z = half_vector(wi, wo)[:, 2]
        a = self.alpha
        lost = ((a * a - 1) * z * z + 1) / ((1 - z) * (1 + z) + a * a * z * z)
        return super().evaluate(wi, wo) / lost**2


class Broken(Lambert):
    """Planted: NaN at the exact mirror pair."""

    name = ""

    def evaluate(self, wi, wo):
        found = super().evaluate(wi, wo)
        return np.where(np.abs((wi + wo)[:, :2]).max(axis=1) == 0, np.nan, found)


class Slanted(Lambert):
    """Planted: another function than the twin's, by 1e-13."""

    name = ""

    def evaluate(self, wi, wo):
        return super().evaluate(wi, wo) * (1 + 1e-13)


def test_a_kernel_that_loses_digits_or_is_not_finite_is_rejected():
    assert examine(GGX(alpha=1e-3)).ok
    assert examine(Sloppy(alpha=1e-3)).worst > 100 * LIMIT
    broken = examine(Broken())
    assert broken.nonfinite > 0
    assert not broken.ok
    assert examine(Slanted()).worst > 50 * LIMIT


def test_a_twin_without_a_value_is_said_and_not_let_pass():
    class Untold(Lambert):
        name = ""

        def symbolic(self):
            twin = super().symbolic()
            return Twin(
                twin.expression * sympy.sqrt(sympy.Rational(1, 2) - twin.arguments[2]), twin.parameters
            )

    found = examine(Untold())
    assert 0 < len(found.undecided) < found.pairs
    assert not found.ok
    assert examine(Lambert()).ok


def test_the_condition_number_is_worked_out_where_it_matters():
    """Skipping those of small errors changes nothing: the worst quotient is that of all pairs."""
    from radiokit.faces.stability.grid import worst_ulps

    f = Phong(exponent=1000.0)
    wi, wo = edge_pairs(f)
    assert examine(f).worst >= worst_ulps(f.evaluate, f.symbolic(), wi, wo)


# Albedos


def area(chart, wo, twin):
    side = Side(twin, wo, chart, 1.0, cut=False)
    rule = Rule(48, 32, eased=False, midpoints=chart.whole)
    return sum(side.planned(far, rule)[0] for far in (1, -1))


@pytest.mark.parametrize("theta_deg", [0.0, 60.0, 85.0])
def test_charts_cover_the_hemisphere(theta_deg):
    """∫ cosθ dω = π in all, and the facets of a smooth glass send everything somewhere below."""
    wo = spherical_to_cartesian(np.radians(theta_deg), 0.4)
    cos_o, sin_o = float(wo[2]), float(np.hypot(*wo[:2]))
    flat = Lambert(reflectance=1.0).symbolic()
    for chart in (sphere_chart(), slope_chart(cos_o, sin_o, 1.0)):
        assert area(chart, wo, flat) == pytest.approx(1.0, abs=1e-9)
    for eta in (1.5, 1 / 1.5):
        from radiokit.measure.refraction import refracted_rule

        wi, weight, _ = refracted_rule(wo, eta, 1.0, (96, 64), symmetric=True)
        exact = float(weight @ np.abs(wi[:, 2])) / np.pi
        side = Side(flat, wo, refracted_chart(cos_o, sin_o, eta, 1.0), 1.0, cut=False)
        rule = Rule(96, 64, eased=True, midpoints=False)
        assert sum(side.planned(far, rule)[0] for far in (1, -1)) == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize(
    ("f", "theta_deg", "exact"),
    [
        (Lambert(reflectance=0.25), 85.0, lambda: 0.25),
        (Mirror(reflectance=0.3), 60.0, lambda: 0.3),
        (Phong(exponent=10.0), 0.0, lambda: 1),
        (GGX(alpha=1.0), 0.0, lambda: 1 - mpmath.log(2)),
        (GGX(alpha=1.0), 60.0, lambda: 1 - mpmath.log(3) / 2),
        (Sheet(reflectance=0.25), 60.0, lambda: 0.5),
    ],
    ids=["lambert", "mirror", "phong", "ggx 0", "ggx 60", "sheet"],
)
def test_truths_are_the_closed_forms(f, theta_deg, exact):
    found = twin_albedo(f, spherical_to_cartesian(np.radians(theta_deg), 0.4))
    with working_precision(30):
        assert abs(found.value - exact()) <= 1e-12 * exact()
    assert found.uncertainty <= 1e-12


def test_rows_hold_for_models_with_and_without_a_closed_form():
    rows = model_albedos(["lambert", "mirror"]) + tuple(
        albedo_row(f, 60.0) for f in (GGX(alpha=0.3), GGX(alpha=0.2, eta=0.2, k=3.9), Phong(exponent=10.0))
    )
    assert {row.outcome for row in rows} == {Outcome.HOLDS}
    assert {row.method.split(":")[0] for row in rows} == {"closed form", "integral"}


def test_a_kink_is_followed():
    """Phong of exponent 1 ends with a kink: a rule that knows nothing of it says that it is not there yet."""
    row = albedo_row(Phong(exponent=1.0), 60.0)
    assert row.truth.startswith("0.60899778104422")
    assert row.outcome is Outcome.HOLDS
    plain = partial(directional_albedo, max_evaluations=4000)
    row = albedo_row(Phong(exponent=1.0), 60.0, integrate=plain)
    assert row.outcome is Outcome.INCONCLUSIVE
    assert not row.converged


def test_crossing_kinks_are_followed():
    """The walls of V-grooves have three, which meet where the half vector's slope and its lean are 1."""
    wo = spherical_to_cartesian(np.radians(60.0), 0.4)
    chart = slope_chart(0.5, np.sqrt(0.75), 1.0)
    side = Side(Beckmann(alpha=0.6, masking="v-groove").symbolic(), wo, chart, 1.0, cut=True)
    meeting = np.arccos(np.arcsinh(1.0) / np.arcsinh(np.sqrt(3.0))) / np.pi
    assert min(abs(s - meeting) for s in side.lines[1].breaks[0]) < 1e-8
    rough, fine = (side.planned(1, Rule(n, n, eased=True, midpoints=False))[0] for n in (48, 64))
    assert rough == pytest.approx(fine, rel=1e-11)


def test_a_twin_that_divides_by_the_slope_of_wo_is_seen_from_beside_the_normal():
    row = albedo_row(Beckmann(alpha=0.3), 0.0)
    assert row.outcome is Outcome.HOLDS
    assert row.truth.startswith("0.99971315435138638")


def test_rounding_that_a_narrow_grazing_lobe_magnifies_does_not_hide_its_truth():
    assert albedo_row(Beckmann(alpha=1e-3), 85.0).outcome is Outcome.HOLDS


@pytest.mark.parametrize(
    "change",
    [
        lambda e: replace(e, value=e.value * (1 + 1e-9)),
        lambda e: replace(e, value=e.value * (1 + 1e-9), error=1e-6, converged=True),
        lambda e: replace(e, value=e.value * (1 + 1e-11), error=1e-13),
    ],
    ids=["off by 1e-9", "said to have converged", "a bound too small"],
)
def test_a_wrong_albedo_is_rejected(change):
    f = GGX(alpha=0.5)
    assert albedo_row(f, 60.0).outcome is Outcome.HOLDS
    row = albedo_row(f, 60.0, integrate=lambda *given, **options: change(albedo(*given, **options)))
    assert row.outcome is Outcome.VIOLATED


def test_a_wrong_kernel_is_rejected_by_the_integral_of_its_twin():
    class Bright(GGX):
        name = ""

        def evaluate(self, wi, wo):
            return super().evaluate(wi, wo) * (1 + 1e-9)

    assert albedo_row(Bright(alpha=0.5), 60.0).outcome is Outcome.VIOLATED


def test_no_truth_is_said_with_its_reason():
    row = albedo_row(GGX(alpha=0.3), 85.0, most=50)
    assert row.outcome is None
    assert "nodes would be needed" in row.reason or "do not converge" in row.reason
    assert row.to_json()["outcome"] == "no truth"
    with pytest.raises(NoTruthError):
        twin_albedo(GGX(alpha=0.3), spherical_to_cartesian(np.radians(85.0), 0.4), most=50)


def test_a_narrow_lobe_over_a_wide_one_is_not_missed():
    """Angles alone would converge to the wide part."""

    class Varnish(GGX):
        name = ""

        def symbolic(self):
            twin = super().symbolic()
            return Twin(twin.expression + 1 / (3 * sympy.pi), twin.parameters)

        def evaluate(self, wi, wo):
            return super().evaluate(wi, wo) + 1 / (3 * np.pi)

    wo = spherical_to_cartesian(np.radians(60.0), 0.4)
    found = float(twin_albedo(Varnish(alpha=1e-3), wo).value)
    assert found == pytest.approx(1 / 3 + float(albedo(GGX(alpha=1e-3), wo)), rel=1e-9)

    class Wide(Varnish):
        def lobe_width(self):
            return 1.0

    with pytest.raises(NoTruthError):  # a width that is wrong is noticed
        twin_albedo(Wide(alpha=1e-3), wo, most=3000)


# The command


def test_the_command_shows_models_and_albedos(run):
    code, out, err = run("--models", "--albedos", "lambert", "mirror", "--workers", "1")
    assert (code, err) == (0, "")
    assert "2 of 2 models stay within 8 ulps" in out
    assert "15 of 15 albedos are right to 1e-10" in out
    code, out, err = run("--models", "--albedos", "lambert", "--json", "--workers", "1")
    data = json.loads(out)
    assert code == 0
    assert data["models"][0]["sets"][0]["parameters"] == {"reflectance": 1.0}
    assert data["albedos"][0]["relative"] <= 1e-10


def test_the_command_fails_beyond_the_limit(run, monkeypatch):
    monkeypatch.setitem(REGISTRY.classes, "planted", Slanted)
    code, out, _ = run("--models", "planted", "--workers", "1")
    assert code == 1
    assert "0 of 1 models stay within" in out
    code, out, _ = run("--albedos", "planted", "--workers", "1")
    assert code == 1  # 1e-13 is less than is asked for, and still more than the bounds
    assert "6 are not" in out


def test_an_unknown_model_is_named(run):
    code, _, err = run("--models", "ggy")
    assert code == 2
    assert "unknown BSDF 'ggy'" in err
    with pytest.raises(UnknownNameError):
        model_albedos(["ggy"])
    assert run("cap-solid-angle", "phong-sample")[0] == 2
