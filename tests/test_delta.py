"""Smooth interfaces: their shares and directions to 50 digits, on both sides, and at the edges."""

from __future__ import annotations

import numpy as np
import pytest
import sympy

from radiokit.contracts.bsdf import bsdf
from radiokit.facts.directions import refract, spherical_to_cartesian
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.twin import Twin, scaled_ulps

INDICES = (1.5, 1 / 1.5, 2.42, 1 + 1e-12, 1 - 1e-12, 1e-3, 1e3)
ULPS = 8


def directions(eta: float) -> np.ndarray:
    """Return directions on both sides: steep, ordinary, grazing, and round the critical angle."""
    critical = float(np.arcsin(min(eta, 1 / eta)))
    near = [critical * (1 + sign * 10.0**-k) for sign in (-1, 1) for k in (3, 8, 12)]
    theta = np.array([0.0, 1e-7, 0.5, 1.2, 1.57, np.radians(89.9999), *near])
    above = spherical_to_cartesian(theta[theta < np.pi / 2], 0.4)
    return np.concatenate([above, above * [1, 1, -1]])


def twins(eta: float, below: bool) -> dict[str, Twin]:
    """Return the shares and the refracted direction as functions of a direction of any length."""
    x, y, z = sympy.symbols("x y z", real=True)
    n = sympy.Symbol("eta", positive=True)
    near, far = (n, sympy.S.One) if below else (sympy.S.One, n)
    length = sympy.sqrt(x**2 + y**2 + z**2)
    cosine, sine2 = sympy.Abs(z) / length, (x**2 + y**2) / length**2
    behind = sympy.sqrt(1 - near**2 / far**2 * sine2)
    r_s = (near * cosine - far * behind) / (near * cosine + far * behind)
    r_p = (far * cosine - near * behind) / (far * cosine + near * behind)
    share = (sympy.Abs(r_s) ** 2 + sympy.Abs(r_p) ** 2) / 2
    slab = 2 * share / (1 + share)
    found = {"F": share, "1 − F": 1 - share, "slab": slab, "1 − slab": 1 - slab}
    found |= {"x": -near / far * x / length, "z": behind if below else -behind}
    return {name: Twin(part, {n: eta}, (x, y, z)) for name, part in found.items()}


def worst(values: np.ndarray, twin: Twin, wo: np.ndarray) -> float:
    exact = [twin.at(*w) for w in wo]
    return float(np.max(scaled_ulps(values, exact, [twin.condition_at(*w) for w in wo])))


@pytest.mark.parametrize("below", [False, True], ids=["above", "below"])
@pytest.mark.parametrize("eta", INDICES)
def test_the_shares_and_directions_agree_with_50_digits(eta, below):
    wo = directions(eta)
    wo = wo[(wo[:, 2] < 0) == below]
    exact = twins(eta, below)
    mirrored, refracted = bsdf("dielectric", eta=eta).delta_lobes(wo)
    passes = refracted.weight > 0
    assert passes.any()
    assert worst(mirrored.weight, exact["F"], wo) <= ULPS
    assert worst(refracted.weight[passes], exact["1 − F"], wo[passes]) <= ULPS
    assert worst(refracted.wi[passes, 0], exact["x"], wo[passes]) <= ULPS
    assert worst(refracted.wi[passes, 2], exact["z"], wo[passes]) <= ULPS
    back, on = bsdf("thin_slab", eta=eta).delta_lobes(wo)
    if not below:
        live = on.weight > 0
        assert worst(back.weight, exact["slab"], wo) <= ULPS
        assert worst(on.weight[live], exact["1 − slab"], wo[live]) <= ULPS


def test_a_share_that_loses_digits_is_rejected():
    """Planted: F as the difference of 1 and what passes, for an index near 1."""
    wo, eta = directions(1 + 1e-12), 1 + 1e-12
    wo = wo[wo[:, 2] > 0.01]
    _, refracted = bsdf("dielectric", eta=eta).delta_lobes(wo)
    assert worst(1 - refracted.weight, twins(eta, False)["F"], wo) > 1e6


def test_total_reflection_begins_at_the_critical_angle():
    f = bsdf("dielectric", eta=1.5)
    critical = np.arcsin(1 / 1.5)
    wo = spherical_to_cartesian(critical + np.array([-1e-9, 1e-9, 0.3]), 0.4) * [1, 1, -1]
    mirrored, refracted = f.delta_lobes(wo)
    assert refracted.weight[0] > 0
    np.testing.assert_array_equal(refracted.weight[1:], 0.0)
    np.testing.assert_array_equal(mirrored.weight[1:], 1.0)
    wi, weight = f.sample(np.full((3, 2), 1 - 2**-53), wo)
    np.testing.assert_array_equal(weight, [1.5**2, 1.0, 1.0])
    np.testing.assert_array_equal(wi[1:], wo[1:] * [-1, -1, 1])


@pytest.mark.parametrize("eta", INDICES)
@pytest.mark.parametrize("name", ["dielectric", "thin_slab"])
def test_nothing_is_lost_and_the_way_back_is_the_way(name, eta):
    f = bsdf(name, eta=eta)
    wo = directions(eta)
    lobes = f.delta_lobes(wo)
    np.testing.assert_allclose(sum(lobe.weight for lobe in lobes), 1.0, rtol=4e-16)
    for lobe in lobes:
        np.testing.assert_allclose(np.linalg.norm(lobe.wi, axis=1), 1.0, rtol=4e-16)
    through = lobes[1]
    passes = through.weight > 0
    back = f.delta_lobes(through.wi[passes])[1]
    steep = (eta + 1 / eta) / np.minimum(np.abs(wo[passes, 2]), np.abs(through.wi[passes, 2]))
    slack = 4e-16 * steep
    assert (np.linalg.norm(back.wi - wo[passes], axis=1) <= slack).all()
    assert (np.abs(back.weight - through.weight[passes]) <= slack).all()


@pytest.mark.parametrize("eta", INDICES)
def test_the_refracted_direction_is_snells(eta):
    wo = directions(eta)
    through = bsdf("dielectric", eta=eta).delta_lobes(wo)[1].wi
    expected, total = refract(wo, eta=eta)
    steep = (eta + 1 / eta) / np.maximum(np.abs(through[:, 2]), 1e-9)  # ∂(cosθt)/∂ of what is rounded
    assert (np.linalg.norm(through - expected, axis=1) <= 4e-16 * steep).all()
    assert total.any() == bool(np.any(bsdf("dielectric", eta=eta).delta_lobes(wo)[1].weight == 0))


def test_the_pane_sums_the_series_of_its_reflections():
    """R + T²R(1 + R² + R⁴ + …), path by path, for one surface's R."""
    wo = spherical_to_cartesian(np.array([0.0, 0.8, 1.4]), 0.4)
    once = bsdf("dielectric", eta=1.5).delta_lobes(wo)[0].weight
    inside = sum(once ** (2 * k + 1) for k in range(200))
    mirrored, straight = bsdf("thin_slab", eta=1.5).delta_lobes(wo)
    np.testing.assert_allclose(mirrored.weight, once + (1 - once) ** 2 * inside, rtol=1e-14)
    np.testing.assert_array_equal(straight.wi, -wo)


def test_the_pane_says_how_far_from_polarised_it_is():
    """The numbers of its docstring."""
    n = 1.5
    theta = np.radians([60.0, 73.8])
    c = np.cos(theta)
    g = np.sqrt(n * n - np.sin(theta) ** 2)
    each = [((c - g) / (c + g)) ** 2, ((n * n * c - g) / (n * n * c + g)) ** 2]
    polarised = sum(2 * r / (1 + r) for r in each) / 2
    found = bsdf("thin_slab", eta=n).delta_lobes(spherical_to_cartesian(theta, 0.0))[0].weight
    np.testing.assert_allclose(found, [0.1638, 0.373], atol=5e-4)
    np.testing.assert_allclose(polarised, [0.1519, 0.351], atol=5e-4)


def test_radiance_is_conserved_through_glass_and_back():
    """A sky of radiance 1 looks like one through glass: Σ weight n(wo)²/n(wi)² L(wi), with L = n² inside."""
    f = bsdf("dielectric", eta=1.5)
    wo = directions(1.5)
    n2 = np.where(wo[:, 2] < 0, 1.5**2, 1.0)
    seen = np.zeros(len(wo))
    for lobe in f.delta_lobes(wo):
        there = np.where(lobe.wi[:, 2] < 0, 1.5**2, 1.0)
        seen += lobe.weight * n2 / there * there
    np.testing.assert_allclose(seen, n2, rtol=1e-15)


def test_light_from_all_sides_leaves_water_as_the_known_share():
    """The share that leaves diffusely lit water of index 4/3 is (1 − r)/n², for r = 0.0666 from outside."""
    x, w = gauss_legendre(64)
    wo = np.stack([np.sqrt(1 - x * x), np.zeros_like(x), x], axis=-1)
    f = bsdf("dielectric", eta=4 / 3)
    outside = float(np.sum(2 * x * w * f.delta_lobes(wo)[0].weight))
    limit = np.sqrt(1 - (3 / 4) ** 2)  # beyond the critical angle nothing leaves
    z = limit + (1 - limit) * x * x  # squared, since 1 − F begins as a root there
    inner = np.stack([np.sqrt(1 - z * z), np.zeros_like(z), -z], axis=-1)
    inside = float(np.sum(4 * z * (1 - limit) * x * w * f.delta_lobes(inner)[1].weight))
    assert inside == pytest.approx((1 - outside) * (3 / 4) ** 2, rel=1e-9)
    assert outside == pytest.approx(0.0666, abs=2e-4)
