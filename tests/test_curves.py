"""Curves: kinks on V-grooves and at lobes' edges are where the formulas say, are found, and are cut."""

import numpy as np
import pytest

from radiokit.contracts.albedo import albedo, directional_albedo, integrand
from radiokit.contracts.bsdf import bsdf
from radiokit.faces.stability.charts import slope_chart, turned_chart
from radiokit.faces.stability.sides import Rule, Side
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.measure.curves import CURVES
from radiokit.measure.slope import slope_map, slope_rule
from radiokit.measure.split import _radius, kinked, split_rule

EQUAL, LIGHT, VIEWER, MIRROR = CURVES
WALL = bsdf("beckmann", alpha=0.6, masking="v-groove")
EDGES = {
    "walls": WALL,
    "lobe": bsdf("phong", exponent=1.0),
    "lobe around wo": bsdf("retro", exponent=1.0),
}


def toward(theta_deg):
    return spherical_to_cartesian(np.deg2rad(theta_deg), 0.4)


def exactly(f, wo):
    """Integrate the twin in floats between the kinks that its expression shows."""
    chart = slope_chart(float(wo[2]), float(np.hypot(*wo[:2])), 1.0)
    chart = turned_chart(chart, -1, 1) if f.name == "retro" else chart
    side = Side(f.symbolic(), wo, chart, 1.0, cut=True)
    rough, fine = (2 * side.planned(1, Rule(n, n, eased=True, midpoints=False))[0] for n in (56, 72))
    assert abs(rough - fine) < 2e-12 * fine
    return fine


def gap(curve, wo, wi):
    """Return what is 0 on the curve, from the directions."""
    half = wi + wo
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    cosine = half @ wo
    return {
        EQUAL.name: wi[..., 2] - wo[2],
        LIGHT.name: 2 * half[..., 2] * wi[..., 2] - cosine,
        VIEWER.name: 2 * half[..., 2] * wo[2] - cosine,
        MIRROR.name: wi @ (wo * [-1, -1, 1]),
    }[curve.name]


@pytest.mark.parametrize("curve", CURVES, ids=lambda curve: curve.name)
@pytest.mark.parametrize("theta", [0.0, 1e-3, 20.0, 60.0, 85.0, 89.9])
def test_a_curve_is_where_its_equation_says(curve, theta, rng):
    wo, s = toward(theta), rng.random(2000)
    x = _radius(curve, wo, 0.3, s)
    inside = (x > 0) & (x < 1)
    wi, _, _ = slope_map(wo, 0.3, x[inside], s[inside])
    assert np.all(np.abs(gap(curve, wo, wi)) < 1e-13)
    beside, _, _ = slope_map(wo, 0.3, x[inside] + 0.01 * (1 - x[inside]), s[inside])
    assert np.all(np.abs(gap(curve, wo, beside)) > 1e-13)
    expected = {
        EQUAL.name: theta >= 1e-3,
        LIGHT.name: True,
        VIEWER.name: theta > 45,
        MIRROR.name: theta >= 1e-3,
    }
    assert np.any(inside) == expected[curve.name]


@pytest.mark.parametrize("theta", [60.0, 85.0])
def test_walls_and_edges_are_found(theta):
    wo = toward(theta)
    for name, seen in (("walls", [EQUAL, LIGHT, VIEWER]), ("lobe", [MIRROR]), ("lobe around wo", [])):
        found, evaluations = kinked(integrand(EDGES[name], wo, "wo"), wo, 0.6)
        assert list(found) == seen
        assert evaluations < 500


@pytest.mark.parametrize("theta", [0.0, 60.0, 85.0])
@pytest.mark.parametrize("name", EDGES)
def test_kinks_cost_no_digits(name, theta):
    f, wo = EDGES[name], toward(theta)
    found = albedo(f, wo, rtol=1e-10)
    assert found.converged
    assert found.evaluations < 120_000
    exact = exactly(f, wo)
    assert abs(found.value - exact) <= found.error + 2e-12 * exact
    assert found.error <= 1e-10 * found.value


@pytest.mark.parametrize("theta", [30.0, 50.0, 70.0, 80.0, 88.0])
@pytest.mark.parametrize("name", EDGES)
def test_two_widths_agree_within_their_bounds(name, theta):
    one, two = (directional_albedo(EDGES[name], toward(theta), width=w, rtol=1e-10) for w in (0.4, 0.9))
    assert abs(one.value - two.value) <= one.error + two.error


def test_a_rule_that_ignores_the_walls_is_off():
    """The planted failures: no cut, and a cut at the circle alone."""
    wo = toward(60.0)
    exact = exactly(WALL, wo)
    value = integrand(WALL, wo, "wo")
    rules = {
        "none": slope_rule(wo, 0.6, (60, 60)),
        "circle": split_rule(wo, 0.6, (24, 24)),
        "all": split_rule(wo, 0.6, (24, 24), curves=(EQUAL, LIGHT, VIEWER)),
    }
    off = {name: abs(weight @ value(wi) - exact) / exact for name, (wi, weight) in rules.items()}
    assert off["none"] > 1e-7
    assert off["circle"] > 1e-7
    assert off["all"] < 1e-10
