"""Quadrature: bounds hold against exact values, kinks and divergence are found out, rules do not lie."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import NonFiniteError, ParameterError
from radiokit.measure.converge import converge
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.quadrature import box, hemisphere
from radiokit.measure.slope import find_lobe, slope_inverse, slope_map, slope_rule

ANGLES_DEG = (0.0, 30.0, 60.0, 80.0, 89.0, 89.9, 89.99)


def toward(theta_deg, phi=0.4):
    return spherical_to_cartesian(np.deg2rad(theta_deg), phi)


def ggx_times_cosine(wi, wo, alpha):
    s = wi + wo
    d = s[:, 0] ** 2 + s[:, 1] ** 2 + alpha**2 * s[:, 2] ** 2
    ndf = alpha**2 * np.sum(s * s, axis=1) ** 2 / (np.pi * d * d)
    ri = np.sqrt(wi[:, 2] ** 2 + alpha**2 * (wi[:, 0] ** 2 + wi[:, 1] ** 2))
    ro = np.sqrt(wo[2] ** 2 + alpha**2 * (wo[0] ** 2 + wo[1] ** 2))
    return ndf * 0.5 * wi[:, 2] / (wi[:, 2] * ro + wo[2] * ri)


def phong_albedo(n, theta):
    """∫ (r·w)ⁿ cosθ dω over the hemisphere, by mpmath in the frame of the mirror direction r."""
    with mpmath.workdps(25):
        c, s = mpmath.cos(theta), mpmath.sin(theta)

        def ring(a):  # at angle a from r: ∫ max(0, cosθ) dφ, where cosθ = c cos a + s sin a cosφ
            p, q = c * mpmath.cos(a), s * mpmath.sin(a)
            if p >= q or q == 0:
                return 2 * mpmath.pi * p
            edge = mpmath.acos(-p / q)
            return 2 * (p * edge + q * mpmath.sin(edge))

        knots = [0, mpmath.pi / 2 - theta, mpmath.pi / 2]
        return mpmath.quad(lambda a: mpmath.cos(a) ** n * mpmath.sin(a) * ring(a), knots)


def test_gauss_legendre_is_exact_to_its_degree():
    for n in (1, 2, 5, 24):
        x, w = gauss_legendre(n)
        assert w @ x ** (2 * n - 1) == pytest.approx(1 / (2 * n), rel=1e-13)
    x, w = gauss_legendre(2)
    assert abs(w @ x**4 - 1 / 5) > 1e-3  # one degree more is not exact


@pytest.mark.parametrize("theta", ANGLES_DEG)
@pytest.mark.parametrize("width", [1e-3, 0.05, 1.0])
def test_slope_nodes_are_unit_vectors_above_the_horizon(theta, width):
    wi, weight = slope_rule(toward(theta), width, 24)
    assert np.abs(np.linalg.norm(wi, axis=1) - 1).max() < 5e-15
    assert wi[:, 2].min() > 0
    assert weight.min() > 0


@pytest.mark.parametrize("theta", ANGLES_DEG)
def test_slope_map_inverts(theta, rng):
    x, s = rng.random((2, 200))
    wo = toward(theta)
    wi, _, _ = slope_map(wo, 0.1, x, s)
    back_x, back_s, far = slope_inverse(wo, 0.1, wi)
    assert np.abs(back_x - x).max() < 1e-6
    assert np.abs(back_s - s).max() < 1e-6
    assert not far.any()


def test_one_rule_for_many_directions_is_many_rules():
    wo = toward(np.array([10.0, 70.0]))
    wi, weight = slope_rule(wo, [0.1, 0.5], 12)
    for k, width in enumerate((0.1, 0.5)):
        one, w = slope_rule(wo[k], width, 12)
        assert np.array_equal(one, wi[k])
        assert np.array_equal(w, weight[k])


@pytest.mark.parametrize("theta", ANGLES_DEG)
def test_bound_holds_for_ggx_of_full_roughness(theta):
    wo = toward(theta)
    found = hemisphere(lambda w: ggx_times_cosine(w, wo, 1.0), wo=wo, width=1.0, rtol=1e-12)
    exact = float(1 - mpmath.mpf(wo[2]) * mpmath.log1p(1 / mpmath.mpf(wo[2])))
    assert found.converged
    assert abs(found.value - exact) <= found.error <= 1e-12 * exact


@pytest.mark.parametrize("theta", [0.0, 45.0, 80.0, 89.0])
@pytest.mark.parametrize("n", [1, 2, 10, 1000])
def test_bound_holds_for_phong_lobes_cut_by_the_horizon(n, theta):
    wo = toward(theta)
    mirror = wo * [-1, -1, 1]
    found = hemisphere(lambda w: np.maximum(w @ mirror, 0) ** n * w[:, 2], wo=wo)
    exact = float(phong_albedo(n, mpmath.atan2(mpmath.hypot(*wo[:2]), wo[2])))
    assert abs(found.value - exact) <= found.error <= 2e-5 * exact


@pytest.mark.parametrize("alpha", [1e-4, 1e-3, 0.01, 0.05, 0.3])
@pytest.mark.parametrize("theta", [0.0, 60.0, 89.0, 89.9])
def test_a_black_box_agrees_with_the_known_width_within_both_bounds(alpha, theta):
    wo = toward(theta)

    def f(w):
        return ggx_times_cosine(w, wo, alpha)

    known = hemisphere(f, wo=wo, width=alpha, rtol=1e-10)
    unknown = hemisphere(f, wo=wo, rtol=1e-8)
    assert known.converged
    assert unknown.converged
    assert abs(known.value - unknown.value) <= known.error + unknown.error


@pytest.mark.parametrize("alpha", [1e-4, 0.01, 0.3])
@pytest.mark.parametrize("retro", [False, True])
def test_the_lobe_is_found(alpha, retro):
    wo = toward(50.0)
    turn = np.array([-1.0, -1.0, 1.0]) if retro else np.ones(3)
    lobe = find_lobe(lambda w: ggx_times_cosine(w * turn, wo, alpha), wo)
    assert alpha / 4 < lobe.width <= 4 * alpha
    assert lobe.retro is (retro and alpha < 0.1)  # a wide lobe is resolved either way


def test_bound_holds_for_a_band_with_jumps():
    low, high = 0.498, 0.502
    found = hemisphere(lambda w: 100.0 * ((w[:, 2] > low) & (w[:, 2] < high)) * w[:, 2])
    exact = 100 * np.pi * (high**2 - low**2)
    assert not found.converged
    assert abs(found.value - exact) <= found.error


def test_a_divergent_integral_is_not_given_a_number():
    wo = toward(30.0)
    mirror = wo * [-1, -1, 1]
    found = hemisphere(lambda w: 1 / np.sum((w - mirror) ** 2, axis=1), wo=wo, max_evaluations=500_000)
    assert not found.converged
    assert found.error > 0.01 * found.value
    assert found.note


def test_several_channels_at_once():
    found = hemisphere(lambda w: np.stack([w[:, 2], w[:, 2] ** 2, np.ones(len(w))], axis=1), rtol=1e-10)
    exact = np.array([np.pi, 2 * np.pi / 3, 2 * np.pi])
    assert np.all(np.abs(found.value - exact) <= found.error)


def test_a_value_that_is_not_finite_is_named():
    with pytest.raises(NonFiniteError, match=r"the integrand is nan at \("):
        hemisphere(lambda w: np.where(w[:, 2] > 0.5, np.nan, 1.0))


def test_too_small_a_budget_is_admitted():
    wo = toward(89.9)
    found = hemisphere(lambda w: ggx_times_cosine(w, wo, 1e-3), wo=wo, rtol=1e-10, max_evaluations=12_000)
    assert not found.converged
    assert found.evaluations <= 12_000
    assert found.note == "the tolerance was not reached"


def test_evaluations_are_counted(rng):
    seen = 0

    def f(w):
        nonlocal seen
        seen += len(w)
        return np.abs(w[:, 0]) * w[:, 2]  # a kink, so that every stage is used

    found = hemisphere(f, rtol=1e-12, max_evaluations=300_000)
    assert found.evaluations == seen


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: slope_rule((1.0, 0.0, 0.0), 1.0, 8), "above the horizon"),
        (lambda: slope_rule((0.0, 0.0, 1.0), 0.0, 8), "width = 0.0"),
        (lambda: box(lambda p: p[:, 0], (0, 0), (1, -1)), "high = "),
        (lambda: box(lambda p: p[:, 0], (0, 0), (1, np.inf)), "high = "),
    ],
)
def test_invalid_arguments_are_named(call, says):
    with pytest.raises(ParameterError, match=says):
        call()


def test_box_bounds_hold_for_smooth_kinked_and_jumping_integrands():
    cases = [
        (lambda p: np.exp(p[:, 0]) * p[:, 1], (np.e - 1) / 2, 1e-12),
        (lambda p: np.abs(p[:, 0] - 0.3), 0.29, 1e-6),
        (lambda p: (p[:, 0] + p[:, 1] < 0.7).astype(float), 0.245, 1e-3),
    ]
    for f, exact, reached in cases:
        found = box(f, (0, 0), (1, 1), max_evaluations=1_000_000)
        assert abs(found.value - exact) <= found.error <= reached


def test_an_accidental_agreement_of_two_rules_is_not_believed():
    class Rule:
        def __init__(self, value):
            self.value, self.size, self.points = value, abs(value), 1

    found = converge([Rule(v) for v in (0.5, 1.0, 1.0)], 1e-9, 0.0)
    assert not found.converged
    assert found.error >= 0.005


def test_bounds_hold_beside_jumps_wherever_they_run(rng):
    """Discontinuous integrands, where no rule can be sure: nearly every bound holds, none is far off."""
    ratios = []
    for k in range(60):
        wo = spherical_to_cartesian(np.deg2rad(rng.uniform(0, 89.5)), rng.uniform(0, 6.28))
        axis = spherical_to_cartesian(np.pi / 2 if k % 2 else rng.uniform(0, 0.7), rng.uniform(0, 6.28))
        edge = 0.0 if k % 2 else rng.uniform(0.8, 0.95)
        exact = np.pi / 2 if k % 2 else 2 * np.pi * (1 - edge)

        def f(w, axis=axis, edge=edge, power=k % 2):
            return (w @ axis > edge) * w[:, 2] ** power

        for rtol, budget in ((1e-2, 20_000), (1e-3, 300_000), (1e-6, 300_000)):
            found = hemisphere(f, wo=wo, rtol=rtol, max_evaluations=budget)
            ratios.append(found.ratio(exact))
            assert abs(found.value - exact) <= found.error + 2e-3 * exact
    assert np.quantile(ratios, 0.97) <= 1


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-12])
def test_twenty_hard_lobes_to_twelve_digits_in_4096_evaluations(rtol):
    for alpha in (1e-3, 0.01, 0.05, 0.3, 1.0):
        for theta in (0.0, 60.0, 89.0, 89.9):
            wo = toward(theta)

            def f(w, wo=wo, alpha=alpha):
                return ggx_times_cosine(w, wo, alpha)

            wi, weight = slope_rule(wo, alpha, (220, 200), symmetric=True)
            exact = weight @ f(wi)  # rounding: 3e-13 at the narrowest
            options = {"width": alpha, "symmetric": True, "smooth": True, "max_evaluations": 4096}
            found = hemisphere(f, wo=wo, rtol=rtol, **options)
            assert found.evaluations <= 4096
            assert abs(found.value - exact) <= max(1e-12, rtol / 10) * exact
            assert abs(found.value - exact) <= found.error + 3e-13 * exact


# Diffuse surfaces that bend at θi = θo and at right angles to wo


def rough_diffuse(wi, wo):
    """Oren and Nayar's qualitative law for σ = 0.3, times cosθ."""
    sigma2 = 0.09
    theta = np.arctan2(np.hypot(wi[:, 0], wi[:, 1]), wi[:, 2]), np.arctan2(np.hypot(*wo[:2]), wo[2])
    facing = np.maximum(wi[:, 0] * wo[0] + wi[:, 1] * wo[1], 0) / np.maximum(np.hypot(*wo[:2]), 1e-300)
    facing = facing / np.maximum(np.hypot(wi[:, 0], wi[:, 1]), 1e-300)
    bent = facing * np.sin(np.maximum(*theta)) * np.tan(np.minimum(*theta))
    law = 1 - 0.5 * sigma2 / (sigma2 + 0.33) + 0.45 * sigma2 / (sigma2 + 0.09) * bent
    return law / np.pi * wi[:, 2]


@pytest.mark.parametrize("theta_deg", [0.0, 30.0, 60.0, 80.0, 89.0, 89.99])
@pytest.mark.parametrize("phi", [0.0, 0.7])
def test_a_rough_diffuse_surface_takes_few_evaluations(theta_deg, phi):
    theta = np.radians(theta_deg)
    wo = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    with mpmath.workdps(30):
        t = mpmath.mpf(float(theta))
        s, c = mpmath.sin(t), mpmath.cos(t)
        a, b = 1 - 0.5 * 0.09 / 0.42, 0.45 * 0.09 / 0.18
        exact = float(a + b / mpmath.pi * (s * (t - s * c) + 2 * s / c * (1 - s**3) / 3))
    found = hemisphere(lambda w: rough_diffuse(w, wo), wo=wo, rtol=1e-10)
    assert found.converged
    assert found.evaluations < 40_000
    assert abs(found.value - exact) <= found.error < 1e-12


@pytest.mark.parametrize("turn", [0.05, 0.5, 1.3])
def test_polar_rules_are_not_believed_where_they_are_cut_in_the_wrong_place(turn):
    """Planted: the same surface with its kinks turned away from where the rules are cut."""
    wo = np.array([0.6, 0.0, 0.8])
    away = np.array([0.6 * np.cos(turn), 0.6 * np.sin(turn), 0.8])
    found = hemisphere(lambda w: rough_diffuse(w, away), wo=wo, rtol=1e-8)
    exact = hemisphere(lambda w: rough_diffuse(w, away), wo=away, rtol=1e-10)
    assert found.method != "polar quadrature"
    assert abs(found.value - exact.value) <= found.error + exact.error


# Surfaces whose f is cut off at 0


def tilted(w, theta, phi):
    """The cosine with a direction, 0 behind it: over the upper hemisphere it makes π (1 + cosθ)/2."""
    n = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
    return np.maximum(w @ n, 0.0)


@pytest.mark.parametrize("theta_deg", [1.0, 20.0, 60.0, 89.0, 120.0, 179.0])
@pytest.mark.parametrize("turn", [0.0, np.pi])
def test_light_that_ends_along_a_curve_takes_few_evaluations(theta_deg, turn):
    wo, theta = toward(50.0), np.radians(theta_deg)
    found = hemisphere(lambda w: tilted(w, theta, 0.4 + turn), wo=wo, rtol=1e-10)
    exact = np.pi * np.cos(theta / 2) ** 2
    assert found.converged
    assert found.evaluations < 150_000  # of which most find where the light ends
    assert abs(found.value - exact) <= found.error <= 1e-10 * exact


@pytest.mark.parametrize("turn", [0.3, 1.4, 2.5])
def test_light_that_ends_twice_on_a_circle_is_not_believed_too_early(turn):
    """Planted: an end that each quarter's search cannot follow, for it may come back within a quarter."""
    wo = toward(50.0)
    for theta in (0.4, 1.5):
        found = hemisphere(lambda w, t=theta: tilted(w, t, turn), wo=wo, rtol=1e-8)
        exact = np.pi * np.cos(theta / 2) ** 2
        assert abs(found.value - exact) <= found.error
