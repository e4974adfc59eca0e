"""Low discrepancy: errors from independent shifts cover, and shrink faster than those of random points."""

from __future__ import annotations

import math
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import t as student

import radiokit as rk
from radiokit.facts.errors import CallableError, NonFiniteError, ParameterError
from radiokit.facts.estimate import Estimate, student_widening
from radiokit.measure.lattice import KOROBOV_LOG2, korobov
from radiokit.measure.lowdiscrepancy import lattice_samples, mean
from radiokit.measure.statistics import binomial_interval, z_test
from radiokit.worlds.terms import MAX_SAMPLES

LEVEL = 1e-6  # chance that a right thing is rejected in a test of this file
TRIALS = 400


def smooth(u):
    """A product of means 1 that is not periodic."""
    return np.prod(np.exp(u) / math.expm1(1.0), axis=1)


def kinked(u):
    """|u − v|, with a ridge that no axis follows: mean 1/3."""
    return np.abs(u[:, 0] - u[:, 1])


def cut(u):
    """A quarter disk: mean π/4."""
    return (u[:, 0] ** 2 + u[:, 1] ** 2 < 1).astype(float)


CASES = [(smooth, 1.0), (kinked, 1 / 3), (cut, math.pi / 4)]

# The points


@pytest.mark.parametrize("dimensions", [1, 2, 4, 9])
def test_a_lattice_holds_its_half_and_every_projection_is_even(dimensions):
    points = korobov(np.arange(256), 256, dimensions)
    for column in points.T:
        assert sorted(column.tolist()) == [k / 256 for k in range(256)]
    np.testing.assert_array_equal(points[::2], korobov(np.arange(128), 128, dimensions))


def test_the_largest_lattice_has_no_overflow():
    count = 1 << KOROBOV_LOG2
    last = korobov([count - 1], count, 4)
    first = korobov([1], count, 4)
    np.testing.assert_array_equal(first + last, 1.0)  # k and −k


# The error


@pytest.mark.parametrize(("f", "exact"), CASES)
@pytest.mark.parametrize("replicates", [8, 16])
def test_the_interval_covers_as_often_as_it_says(f, exact, replicates, seed):
    """Intervals of 400 seeds, at 95 % by ± 1.96 error too, must be a plausible draw for what they claim."""
    found = [mean(f, dimensions=2, samples=1024, replicates=replicates, rng=seed + i) for i in range(TRIALS)]
    for level in (0.5, 0.95):
        covered = sum(estimate.covers(exact, level) for estimate in found)
        low, high = binomial_interval(covered, TRIALS, 1 - LEVEL)
        assert low <= level <= high
    plain = sum(abs(estimate.value - exact) <= 1.959964 * estimate.error for estimate in found)
    low, high = binomial_interval(plain, TRIALS, 1 - LEVEL)
    assert low <= 0.95 <= high


def test_the_interval_covers_after_an_early_stop(seed):
    """Stopping on rtol costs little coverage: at most two points of it here."""
    found = [mean(kinked, dimensions=2, samples=1 << 16, rng=seed + i, rtol=2e-3) for i in range(TRIALS)]
    covered = sum(estimate.covers(1 / 3) for estimate in found)
    low, high = binomial_interval(covered, TRIALS, 1 - LEVEL)
    assert low <= 0.95
    assert high >= 0.93
    assert all(estimate.converged for estimate in found)


def test_planted_an_error_that_is_not_widened_is_seen_to_cover_too_little(seed):
    """With 8 replicates a normal interval of the plain standard error covers 91 %, not 95 %."""
    trials = 2000
    off = [
        mean(smooth, dimensions=2, samples=64, replicates=8, rng=seed + i).ratio(1.0) for i in range(trials)
    ]
    for widening, right in ((1.0, True), (student_widening(7), False)):
        covered = int(np.sum(np.array(off) * widening <= 1.959964))
        low, high = binomial_interval(covered, trials, 1 - LEVEL)
        assert (low <= 0.95 <= high) is right


def test_planted_an_error_from_within_one_point_set_is_seen_to_lie(seed):
    """Points of a lattice are not independent: all 64 of each fall on the same phase of this wave."""

    def wave(u):
        return 1 + np.cos(2 * np.pi * 32 * u[:, 0])

    within = honest = 0
    for i in range(TRIALS):
        seen = []
        found = mean(
            lambda u, seen=seen: (seen.append(wave(u)), seen[-1])[1], dimensions=1, samples=1024, rng=seed + i
        )
        honest += found.covers(1.0)
        one = np.concatenate(seen).reshape(-1, 16)[:, 0]  # the points of one replicate
        assert len(one) == 64
        within += Estimate(one.mean(), one.std(ddof=1) / 8, "statistical").covers(1.0)
    low, high = binomial_interval(honest, TRIALS, 1 - LEVEL)
    assert low <= 0.95 <= high
    assert binomial_interval(within, TRIALS, 1 - LEVEL)[1] < 0.5


@pytest.mark.parametrize(
    ("f", "exact", "steepest"), [(*CASES[0], -1.6), (*CASES[1], -0.9), (*CASES[2], -0.6)]
)
def test_the_error_shrinks_faster_than_that_of_random_points(f, exact, steepest, seed):
    sizes = [1 << m for m in range(8, 19, 2)]
    true, claimed = [], []
    for size in sizes:
        found = [mean(f, dimensions=2, samples=size, rng=seed + i) for i in range(8)]
        true.append(math.sqrt(np.mean([(estimate.value - exact) ** 2 for estimate in found])))
        claimed.append(math.sqrt(np.mean([estimate.error**2 for estimate in found])))
    for errors in (true, claimed):
        assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] <= steepest


def test_p_values_go_by_student(seed):
    estimate = mean(kinked, dimensions=2, samples=4096, rng=seed)
    score = (estimate.value - 1 / 3) / (estimate.error / student_widening(15))
    assert z_test(estimate, 1 / 3) == pytest.approx(2 * student.sf(abs(score), 15), rel=1e-9)
    p = [z_test(mean(kinked, dimensions=2, samples=512, rng=seed + i), 1 / 3) for i in range(TRIALS)]
    low, high = binomial_interval(int(np.sum(np.array(p) < 0.1)), TRIALS, 1 - LEVEL)
    assert low <= 0.1 <= high
    assert z_test(mean(lambda u: 1.01 * kinked(u), dimensions=2, samples=4096, rng=seed), 1 / 3) < 1e-4


@pytest.mark.parametrize("dof", [7, 15, 31])
def test_the_widening_is_that_of_the_quantiles(dof):
    assert student_widening(dof) == pytest.approx(student.ppf(0.975, dof) / 1.959963984540054, rel=3e-5)


def test_sums_keep_the_fewest_degrees_of_freedom(seed):
    one = mean(kinked, dimensions=2, samples=512, rng=seed)
    two = mean(kinked, dimensions=2, samples=512, replicates=8, rng=seed + 1)
    plain = Estimate(1.0, 0.1, "statistical")
    assert [(one + two).dof, (one + plain).dof, (plain + plain).dof] == [7, 15, None]
    assert one.scaled(2.0).dof == 15


# The run


def test_the_same_seed_gives_the_same_answer_however_it_is_given(seed):
    def run(rng):
        return mean(kinked, dimensions=2, samples=5000, rng=rng)

    assert run(seed).value == run(seed).value != run(seed + 1).value
    assert run(np.random.default_rng(seed)).value == run(np.random.default_rng(seed)).value
    assert run(None).value != run(None).value


def test_values_of_several_columns(seed):
    found = mean(lambda u: u ** [1.0, 2.0], dimensions=2, samples=1 << 14, rng=seed)
    assert found.value.shape == found.error.shape == (2,)
    assert found.covers([1 / 2, 1 / 3], level=1 - LEVEL)


@pytest.mark.parametrize(
    ("samples", "replicates", "drawn"), [(16, 16, 16), (1000, 16, 512), (1024, 8, 1024), (100_000, 32, 65536)]
)
def test_samples_are_rounded_down_to_whole_lattices(samples, replicates, drawn, seed):
    found = mean(smooth, dimensions=2, samples=samples, replicates=replicates, rng=seed)
    assert found.evaluations == lattice_samples(samples, replicates) == drawn
    assert found.converged


def test_it_stops_at_the_tolerance(seed):
    found = mean(kinked, dimensions=2, samples=1 << 20, rng=seed, rtol=1e-3)
    assert found.converged
    assert found.error <= 1e-3 * found.value
    assert found.evaluations < 1 << 16
    short = mean(kinked, dimensions=2, samples=1 << 12, rng=seed, rtol=1e-9)
    assert not short.converged
    reached = f"{short.error / short.value:.1e}"
    assert short.note == f"rtol = 1e-09 was not reached with 4096 samples, but {reached}"


def test_it_stops_when_time_is_up_with_the_last_whole_lattice(seed):
    found = mean(kinked, dimensions=2, samples=1 << 22, rng=seed, seconds=1e-9)
    assert not found.converged
    assert "of 4194304 samples: 1e-09 s were up" in found.note
    assert found.value == mean(kinked, dimensions=2, samples=512, rng=seed).value


def test_a_constant_has_no_error_but_rounding_and_zeros_are_reported(seed):
    found = mean(lambda u: np.full(len(u), 0.1), dimensions=2, samples=1 << 12, rng=seed)
    assert found.value == pytest.approx(0.1, abs=found.error)
    assert 0 < found.error < 1e-15
    nothing = mean(lambda u: 0 * u[:, 0], dimensions=2, samples=512, rng=seed, rtol=0.1)
    assert (nothing.value, nothing.error, nothing.note) == (0.0, 0.0, "every sample was 0")


def test_a_rare_event_in_one_replicate_is_doubted(seed):
    found = mean(
        lambda u: np.where(np.arange(len(u)) == 5, 1e6, 0.1), dimensions=2, samples=512, rng=seed, rtol=10.0
    )
    assert not found.converged
    assert "of the variance" in found.note


def test_memory_does_not_grow_with_the_samples(seed):
    def peak(samples):
        tracemalloc.start()
        mean(kinked, dimensions=2, samples=samples, rng=seed)
        _, high = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return high

    assert peak(1 << 20) < 1.2 * peak(1 << 18)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("samples", 15),
        ("replicates", 7),
        ("replicates", 33),
        ("dimensions", 0),
        ("rtol", 0.0),
        ("seconds", -1),
    ],
)
def test_an_argument_out_of_range_is_named(name, value):
    arguments = {"dimensions": 2, "samples": 1000} | {name: value}
    with pytest.raises(ParameterError, match=f"{name} = "):
        mean(smooth, **arguments)


def test_a_bad_function_is_named():
    with pytest.raises(CallableError, match="returned shape"):
        mean(lambda u: u[:3, 0], dimensions=2, samples=100)
    with pytest.raises(NonFiniteError, match="returned nan at u = "):
        mean(lambda u: np.where(u[:, 0] > 0.9, np.nan, 1.0), dimensions=2, samples=1000)


# What uses it


@pytest.mark.parametrize("excess", [1e-5, 1e-3, 0.0123, 0.2])
def test_a_step_in_one_coordinate_is_allowed_for(excess, seed):
    """Nearly every shift counts the same points within it, so that their spread says little or nothing."""
    exact = 0.75 + excess

    def step(u):
        return (u[:, 0] < exact) * 1.0

    def both(u):
        return np.stack([step(u), step(u)], axis=1)

    blind = [mean(step, dimensions=2, samples=1024, rng=seed + k) for k in range(40)]
    found = [mean(both, dimensions=2, samples=1024, rng=seed + k, stepped=True) for k in range(40)]
    assert max(each.ratio(exact) for each in found) < 3.75
    if excess == 1e-5:
        assert max(each.ratio(exact) for each in blind) > 1e3  # planted: without the allowance
    rare = mean(
        lambda u: np.zeros((len(u), 2)), dimensions=2, samples=1024, rng=1, stepped=True, foretold=1e-4
    )
    assert rare.error.tolist() == [1e-2 / 32]


@pytest.mark.parametrize("name", ["ggx-0.3-in-furnace-at-60deg", "ggx-0.05-in-furnace-at-89deg"])
def test_albedo_by_lattices_is_right_and_better_than_by_random_points(name, seed):
    furnace = rk.case(name)
    f, wo = furnace.scene.f, furnace.scene.wo
    even, random = (rk.albedo(f, wo, method=method, samples=1 << 16, rng=seed) for method in ("qmc", "mc"))
    assert furnace.judge(even, level=LEVEL).ok
    assert even.evaluations == random.evaluations
    assert even.error < random.error / 5
    both = rk.albedo(f, np.array([wo, wo]), method="qmc", samples=1024, rng=seed)
    assert (both.value.shape, both.dof) == ((2,), 15)
    assert rk.albedo(lambda wi, wo: 0.5 / np.pi, (0, 0, 1), method="qmc", rng=seed).value == pytest.approx(
        0.5
    )


def test_explain_says_what_qmc_does():
    sky, at_60 = rk.emitter("constant", radiance=1.0), (0.75**0.5, 0.0, 0.5)
    (row,) = rk.explain(rk.bsdf("lambert"), [sky], method="qmc").rows
    found = rk.shade(rk.bsdf("lambert"), [sky], (0, 0, 1), method="qmc", rng=1)
    assert (row.method, row.evaluations) == ("qmc", found.evaluations)  # every sample has the same weight
    (row,) = rk.explain(rk.bsdf("ggx", alpha=0.5), [sky], at_60, method="qmc", rtol=1e-9).rows
    assert row.evaluations == MAX_SAMPLES
    assert row.why == "low-discrepancy points in place of random ones, put to mc-bsdf"
    (row,) = rk.explain(lambda wi, wo: 0.5 / np.pi, [sky], method="qmc", samples=1000).rows
    assert row.evaluations == 2 * 512


def test_validate_answers_every_sampled_case_by_qmc_too():
    """Unless a case says in its setup why it leaves it out."""
    for name in rk.list_cases():
        case = rk.case(name)
        assert "mis" in case.methods or "qmc" not in case.methods
        assert "qmc" in case.methods or "mis" not in case.methods or "low-discrepancy" in case.setup


# Efficiency


def test_efficiency_is_the_reciprocal_of_variance_times_time():
    estimate = Estimate(1.0, 0.1, "statistical", seconds=4.0)
    assert estimate.efficiency == pytest.approx(25.0)
    assert estimate.to_json()["efficiency"] == pytest.approx(25.0)
    assert replace(estimate, error=0.0).to_json()["efficiency"] == "inf"
    np.testing.assert_allclose(replace(estimate, error=np.array([0.1, 0.2])).efficiency, [25.0, 6.25])


@pytest.mark.parametrize("kind", ["rounding", "truncation"])
def test_a_bound_has_no_efficiency(kind):
    assert Estimate(1.0, 0.1, kind, seconds=1.0).efficiency is None
    assert Estimate(1.0, 0.1, "statistical").efficiency is None
