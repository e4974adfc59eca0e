"""Monte Carlo: honest errors, the same answer for any number of workers, clear refusals."""

from __future__ import annotations

import itertools
import time
import tracemalloc
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import mpmath
import numpy as np
import pytest

import radiokit as rk
from radiokit.facts.errors import CallableError, NonFiniteError, ParameterError
from radiokit.measure.fused import FusedDraw, fused_mean, fused_means
from radiokit.measure.moments import Moments
from radiokit.measure.montecarlo import block_generator, mean, seed_from
from radiokit.measure.statistics import binomial_interval, sidak, z_test

LEVEL = 1e-6  # chance that a right thing is rejected in a test of this file


def square(generator, n):
    """Squares of uniform numbers: mean 1/3."""
    return generator.random(n) ** 2


def three(generator, n):
    """Three means at once: 1/2, 1/3, 1/4."""
    return generator.random((n, 1)) ** np.array([1.0, 2.0, 3.0])


# Moments


def exact_moments(values):
    with mpmath.workdps(60):
        numbers = [mpmath.mpf(float(x)) for x in values]
        centre = mpmath.fsum(numbers) / len(numbers)
        return centre, mpmath.fsum((x - centre) ** 2 for x in numbers)


@pytest.mark.parametrize(
    ("centre", "spread"), [(1e9, 1.0), (0.0, 1.0), (-1e15, 3.0), (1e-100, 1e-110), (1e150, 1e140)]
)
def test_moments_keep_their_digits(centre, spread, rng):
    values = centre + spread * rng.standard_normal(3000)
    total = Moments.of(values[:7])
    for part in np.array_split(values[7:], 37):
        total = total.merge(Moments.of(part))
    mean_exact, m2_exact = exact_moments(values)
    assert total.count == 3000
    assert abs(float(total.mean - mean_exact)) <= 20 * np.spacing(abs(float(mean_exact)))
    # Merging sees the parts' means only as float64: what one unit in their last place is worth.
    lost = np.spacing(abs(centre)) / spread
    assert abs(float(total.m2 / m2_exact) - 1) <= 1e-13 + 0.2 * lost
    assert (total.low, total.high) == (values.min(), values.max())


def test_the_sum_of_squares_loses_what_moments_keep(rng):
    """Planted: the textbook's E[x²] − E[x]² on the same data."""
    values = 1e9 + rng.standard_normal(3000)
    truth = float(exact_moments(values)[1] / 2999)
    naive = (np.sum(values**2) - np.sum(values) ** 2 / 3000) / 2999
    assert abs(naive / truth - 1) > 1e-2
    assert abs(Moments.of(values).variance / truth - 1) < 1e-13


def test_moments_of_constants_and_of_columns(rng):
    constant = Moments.of(np.full(1000, 0.1))
    assert (constant.mean, constant.variance, constant.dominance) == (0.1, 0.0, 0.0)
    values = rng.random((100, 3))
    both = Moments.of(values[:40]).merge(Moments.of(values[40:]))
    np.testing.assert_allclose(both.variance, values.var(axis=0, ddof=1), rtol=1e-13)
    np.testing.assert_allclose(both.standard_error, np.sqrt(values.var(axis=0, ddof=1) / 100), rtol=1e-13)
    assert Moments.of([1.0]).variance == np.inf
    assert Moments.of([0.0] * 9 + [1.0]).dominance == pytest.approx(0.9)
    with pytest.raises(ParameterError, match="with n at least 1"):
        Moments.of([])


def test_deviations_too_small_to_square_have_no_smaller_error_for_it(rng):
    values = 1e-200 * (1 + 1e-10 * rng.standard_normal(1000))
    found = Moments.of(values)
    assert found.m2 == 0
    assert found.standard_error >= np.std(1e200 * values) * 1e-200 / np.sqrt(999) > 0


# The estimate


@pytest.mark.parametrize("workers", [1, 2, 4])
def test_the_answer_does_not_depend_on_the_workers(workers, seed):
    alone = mean(three, samples=10_001, rng=seed, block=512)
    with ThreadPoolExecutor(workers) as pool:
        shared = mean(three, samples=10_001, rng=seed, block=512, executor=pool)
    np.testing.assert_array_equal(alone.value, shared.value)
    np.testing.assert_array_equal(alone.error, shared.error)
    assert alone.evaluations == shared.evaluations == 10_001


def test_processes_give_the_same_answer(seed):
    draw = np.random.Generator.random  # picklable by any way of starting a process
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        shared = mean(draw, samples=5000, rng=seed, block=512, executor=pool)
    assert shared.value == mean(draw, samples=5000, rng=seed, block=512).value


def test_early_stopping_does_not_depend_on_the_workers_either(seed):
    alone = mean(square, samples=1 << 20, rng=seed, block=256, rtol=0.01)
    with ThreadPoolExecutor(3) as pool:
        shared = mean(square, samples=1 << 20, rng=seed, block=256, rtol=0.01, executor=pool)
    assert (alone.value, alone.evaluations) == (shared.value, shared.evaluations)
    blocks = alone.evaluations // 256
    assert alone.converged
    assert alone.error <= 0.01 * alone.value
    assert blocks & (blocks - 1) == 0, "looked at after 1, 2, 4, 8, ... blocks only"


def test_the_interval_covers_as_often_as_it_says(seed):
    """95 % intervals of 400 seeds, whose count must be a plausible draw for a coverage of 95 %."""
    trials = 400
    covered = sum(mean(square, samples=2000, rng=seed + i, block=500).covers(1 / 3) for i in range(trials))
    low, high = binomial_interval(covered, trials, 1 - LEVEL)
    assert low <= 0.95 <= high


def test_the_interval_covers_after_an_early_stop(seed):
    """Stopping on rtol at doubled blocks costs little coverage: at most two points of it here."""
    trials = 300
    found = [mean(square, samples=1 << 17, rng=seed + i, block=128, rtol=0.03) for i in range(trials)]
    covered = sum(estimate.covers(1 / 3) for estimate in found)
    low, high = binomial_interval(covered, trials, 1 - LEVEL)
    assert low <= 0.95
    assert high >= 0.93
    assert all(estimate.converged for estimate in found)


def test_a_biased_estimator_is_rejected_and_a_right_one_is_not(seed):
    right = mean(square, samples=200_000, rng=seed)
    biased = mean(lambda g, n: 1.01 * square(g, n), samples=200_000, rng=seed + 1)
    assert z_test(right, 1 / 3) > sidak(LEVEL, 2)
    assert z_test(biased, 1 / 3) < sidak(LEVEL, 2)


def test_an_estimator_whose_error_is_too_small_is_rejected(seed):
    """Planted: samples repeated four times, so that the standard error is half of what it should be."""
    trials = 400

    def repeated(g, n):
        return np.repeat(square(g, n // 4), 4)

    covered = sum(mean(repeated, samples=2000, rng=seed + i, block=500).covers(1 / 3) for i in range(trials))
    assert binomial_interval(covered, trials, 1 - LEVEL)[1] < 0.95


def test_several_means_at_once(seed):
    found = mean(three, samples=100_000, rng=seed)
    assert found.kind == "statistical"
    assert found.value.shape == found.error.shape == (3,)
    assert np.all(z_test(found, 1 / np.array([2.0, 3.0, 4.0])) > sidak(LEVEL, 3))


def test_no_variance_claims_no_more_than_rounding(seed):
    found = mean(lambda g, n: np.full(n, 0.1), samples=100_000, rng=seed, block=1000)
    assert found.value == 0.1
    assert 0 < found.error < 1e-15
    nothing = mean(lambda g, n: np.zeros(n), samples=100, rng=seed, rtol=0.1, block=10)
    assert (nothing.value, nothing.error, nothing.evaluations) == (0.0, 0.0, 100)
    assert nothing.note == "every sample was 0"


def test_a_rare_event_does_not_stop_early_nor_pass_unremarked(seed):
    def rare(g, n):
        return np.where(g.random(n) < 1e-4, 1e4, 0.0)

    found = mean(rare, samples=4_000_000, rng=seed, block=100, rtol=0.1)
    assert found.converged
    assert found.evaluations > 500_000
    assert z_test(found, 1.0) > LEVEL
    few = mean(lambda g, n: np.where(np.arange(n) == 0, 1.0, 0.0), samples=1000, rng=seed)
    assert "one sample carries 100 % of the variance" in few.note


def test_what_was_not_reached_is_said(seed):
    short = mean(square, samples=1000, rng=seed, rtol=1e-9)
    assert not short.converged
    reached = f"{short.error / short.value:.1e}"
    assert short.note == f"rtol = 1e-09 was not reached with 1000 samples, but {reached}"
    late = mean(square, samples=10**12, rng=seed, block=1000, seconds=0.02)
    assert not late.converged
    assert 1000 <= late.evaluations < 10**12
    assert late.note.startswith(f"stopped after {late.evaluations} of {10**12} samples: 0.02 s were up")
    assert late.seconds < 60


def test_memory_does_not_grow_with_the_samples(seed):
    def peak(samples):
        tracemalloc.start()
        mean(square, samples=samples, rng=seed, block=1024)
        size = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return size

    peak(2048)
    assert peak(400_000) < 1.5 * peak(40_000)


# Early stops of the albedo

GGX_ALBEDO = rk.case("ggx-0.3-in-furnace-at-60deg").exact


@pytest.fixture(scope="module")
def rough():
    return rk.bsdf("ggx", alpha=0.3), (np.sin(np.pi / 3), 0.0, np.cos(np.pi / 3))


@pytest.mark.parametrize("method", ["mc", "qmc"])
def test_an_albedo_stops_at_the_tolerance(method, rough, seed):
    found = rk.albedo(*rough, method=method, rtol=2e-3, rng=seed % 1000)
    assert found.converged
    assert found.error <= 2e-3 * found.value
    assert found.evaluations < 1 << 18
    assert found.evaluations & (found.evaluations - 1) == 0
    assert z_test(found, GGX_ALBEDO) > LEVEL
    again = rk.albedo(*rough, method=method, rtol=2e-3, rng=seed % 1000)
    assert (found.value, found.error) == (again.value, again.error)


def test_without_a_tolerance_all_samples_are_drawn(rough, seed):
    assert rk.albedo(*rough, method="mc", rng=seed % 1000).evaluations == 1 << 20
    assert rk.albedo(*rough, method="mc", samples=5000, rng=seed % 1000).evaluations == 5000


def test_a_compiled_early_stop_does_not_depend_on_the_threads(rough, seed):
    f, wo = rough
    kernel, constants = f.weight_kernel(np.array(wo))
    for rtol in (1e-2, 3e-4, 1.2e-4):  # within the first block, after it, and after several
        found = [
            fused_mean(kernel, constants, samples=1 << 24, rng=seed % 1000, rtol=rtol, workers=workers)
            for workers in (1, 2, 3)
        ]
        assert len({(each.value, each.error, each.evaluations) for each in found}) == 1
        assert found[0].converged
    plain = FusedDraw(lambda *u: kernel(*u), constants)
    stopped = mean(plain, samples=1 << 20, rng=seed % 1000, block=1 << 20, rtol=1e-2)
    same = fused_mean(kernel, constants, samples=1 << 24, rng=seed % 1000, rtol=1e-2)
    assert stopped.evaluations == same.evaluations, "the same samples, with or without a compiler"
    assert stopped.value == pytest.approx(same.value, rel=1e-12)


@pytest.mark.parametrize("samples", [2, 4095, 4097, 70_000, (1 << 20) + 1])
def test_parts_of_the_first_block_are_all_of_it(samples, seed):
    """An unreachable tolerance draws what none draws: the same samples, summed in other parts."""
    draw = FusedDraw(lambda u0, u1: u0 * u1)
    every, parts = (mean(draw, samples=samples, rng=seed, block=1 << 20, rtol=r) for r in (None, 1e-12))
    assert every.evaluations == parts.evaluations == samples
    assert parts.value == pytest.approx(every.value, rel=1e-12)
    assert parts.error == pytest.approx(every.error, rel=1e-9)


@pytest.mark.parametrize(("method", "rtol"), [("mc", 6e-3), ("mc", 1.5e-3), ("qmc", 1e-3)])
def test_the_interval_of_an_albedo_covers_after_an_early_stop(method, rtol, rough, seed):
    """95 % intervals of 600 seeds, which stop at the first look or after several: 93 to 97 %."""
    trials = 600
    found = [rk.albedo(*rough, method=method, rtol=rtol, rng=seed % 10**6 + i) for i in range(trials)]
    assert all(estimate.converged for estimate in found)
    low, high = binomial_interval(sum(each.covers(GGX_ALBEDO) for each in found), trials, 1 - LEVEL)
    assert low <= 0.97
    assert high >= 0.93


@pytest.mark.parametrize("method", ["mc", "qmc"])
def test_planted_tolerances_out_of_reach_are_said(method, rough, seed):
    found = rk.albedo(*rough, method=method, rtol=1e-12, samples=4096, rng=seed % 1000)
    assert not found.converged
    reached = f"{found.error / found.value:.1e}"
    assert found.note == f"rtol = 1e-12 was not reached with 4096 samples, but {reached}"
    both = rk.albedo(rough[0], np.array([rough[1]] * 2), method=method, rtol=1e-12, samples=4096, rng=1)
    assert not both.converged
    assert "rtol = 1e-12 was not reached" in both.note


@pytest.fixture
def clock(monkeypatch):
    """A clock that goes on by a millisecond whenever it is looked at: no machine is slow or fast by it."""
    looks = itertools.count()
    monkeypatch.setattr(time, "perf_counter", lambda: 1e-3 * next(looks))


@pytest.mark.parametrize("method", ["mc", "qmc"])
@pytest.mark.parametrize("model", ["ggx", "own"])
def test_a_time_limit_holds_and_is_no_failure_where_nothing_else_was_asked(method, model, rough, seed, clock):
    f = rough[0] if model == "ggx" else lambda wi, wo: wi[:, 2] / np.pi
    found = rk.albedo(f, rough[1], method=method, seconds=0.05, rng=seed % 1000)
    assert found.converged
    assert found.evaluations > 1 << 12
    assert 0.02 < found.seconds < 0.06
    assert found.note.endswith("samples: 0.05 s were up")
    short = rk.albedo(f, rough[1], method=method, seconds=0.01, samples=1 << 28, rng=seed % 1000)
    assert not short.converged
    assert f" of {1 << 28} samples: 0.01 s were up" in short.note
    aimed = rk.albedo(f, rough[1], method=method, seconds=0.01, rtol=1e-15, rng=seed % 1000)
    assert not aimed.converged
    assert "rtol = 1e-15 was not reached" in aimed.note


@pytest.mark.parametrize("method", ["mc", "qmc"])
@pytest.mark.parametrize("model", ["ggx", "spectral", "own"])
def test_directions_take_turns_while_there_is_time(method, model, rough, seed, clock):
    f, wo = rough
    if model == "spectral":
        f = rk.bsdf("lambert", reflectance=[0.2, 0.5, 0.8])
    elif model == "own":
        f = lambda wi, wo: wo[:, 2:3] * wi[:, 2:3] / np.pi  # noqa: E731
    directions = np.array([wo, (0.0, 0.0, 1.0), wo])
    found = rk.albedo(f, directions, method=method, seconds=0.05, rng=seed % 1000)
    assert found.converged
    assert found.evaluations % 3 == 0
    each = rk.albedo(f, wo, method=method, samples=found.evaluations // 3, rng=seed % 1000)
    assert found.value.shape == (3, *np.shape(each.value))
    for place in (0, 2):  # as much as if it were alone
        np.testing.assert_allclose(found.value[place], each.value, rtol=1e-12)
        np.testing.assert_allclose(found.error[place], each.error, rtol=1e-6, atol=1e-12)
    assert found.seconds < 0.06


def test_means_together_are_those_of_each_whether_compiled_or_not(rough, seed):
    kernel, constants = rough[0].weight_kernel(np.array(rough[1]))
    terms = [(kernel, constants), (lambda u0, u1: u0 * u1, ())]
    for several in (terms, terms[:1] * 2, terms[1:] * 2):
        found = fused_means(several, samples=20_000, rng=seed % 1000)
        alone = [fused_mean(*term, samples=20_000, rng=seed % 1000) for term in several]
        np.testing.assert_allclose(found.value, [each.value for each in alone], rtol=1e-13)
        np.testing.assert_allclose(found.error, [each.error for each in alone], rtol=1e-9)
        assert found.evaluations == 40_000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"seconds": 0.0, "method": "mc"}, "seconds = 0.0 is not allowed: it must be above 0, or None"),
        ({"seconds": 1.0}, "seconds = 1.0 is not allowed: it must be None, or method 'mc' or 'qmc'"),
        ({"rtol": -1.0, "method": "qmc"}, "rtol = -1.0 is not allowed: it must be above 0, or None"),
        ({"samples": 1, "method": "mc"}, "samples = 1 is not allowed: it must be an integer, at least 2"),
    ],
)
def test_limits_out_of_range(arguments, message, rough):
    with pytest.raises(ParameterError) as caught:
        rk.albedo(*rough, **arguments)
    assert str(caught.value) == message


# Seeds


def test_the_seed_decides(seed):
    first, again, other = (mean(square, samples=1000, rng=s).value for s in (seed, seed, seed + 1))
    assert first == again != other
    generators = (np.random.default_rng(seed), np.random.default_rng(seed))
    assert (
        mean(square, samples=1000, rng=generators[0]).value
        == mean(square, samples=1000, rng=generators[1]).value
    )
    assert mean(square, samples=1000, rng=generators[0]).value != first
    assert mean(square, samples=1000).value != mean(square, samples=1000).value
    assert seed_from(np.int64(3)) == 3


def test_blocks_are_independent(seed):
    draws = np.array([block_generator(seed, i).random(1000) for i in range(50)])
    correlation = np.corrcoef(draws)[np.triu_indices(50, 1)]
    assert len(np.unique(draws)) == draws.size
    assert np.max(np.abs(correlation)) < 6 / np.sqrt(1000)


# Refusals


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_sample_that_is_no_number_is_never_averaged(bad, seed):
    def draw(g, n):
        return np.where(np.arange(n) == 17, bad, g.random(n))

    with pytest.raises(NonFiniteError, match=rf"draw returned {bad} as sample 17 of block 0$") as caught:
        mean(draw, samples=1000, rng=seed, block=100)
    assert caught.value.fields["sample"] == 17


def test_wrong_shapes_are_refused(seed):
    with pytest.raises(CallableError, match=r"returned shape \(3,\) where \(10,\) or \(10, K\) is due"):
        mean(lambda g, n: np.zeros(3), samples=10, rng=seed)
    with pytest.raises(CallableError, match="blocks of different shapes"):
        mean(lambda g, n: np.ones((n, 1 + n % 2)), samples=15, rng=seed, block=10)


def test_an_error_in_the_draw_is_not_swallowed(seed):
    def broken(g, n):
        raise ZeroDivisionError("mine")

    with ThreadPoolExecutor(2) as pool, pytest.raises(ZeroDivisionError, match="mine"):
        mean(broken, samples=10_000, rng=seed, block=10, executor=pool)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"samples": None}, "samples = None is not allowed: it must be an integer, at least 2"),
        ({"samples": 1}, "samples = 1 is not allowed: it must be an integer, at least 2"),
        ({"samples": 10.0}, "samples = 10.0 is not allowed: it must be an integer, at least 2"),
        ({"samples": True}, "samples = True is not allowed: it must be an integer, at least 2"),
        ({"block": 0}, "block = 0 is not allowed: it must be an integer, at least 1"),
        ({"rtol": 0.0}, "rtol = 0.0 is not allowed: it must be above 0, or None"),
        ({"seconds": float("nan")}, "seconds = nan is not allowed: it must be above 0, or None"),
        (
            {"rng": -1},
            "rng = -1 is not allowed: it must be a non-negative int, a numpy.random.Generator, or None",
        ),
        (
            {"rng": "7"},
            "rng = '7' is not allowed: it must be a non-negative int, a numpy.random.Generator, or None",
        ),
    ],
)
def test_arguments_out_of_range(arguments, message):
    with pytest.raises(ParameterError) as caught:
        mean(square, **{"samples": 100, **arguments})
    assert str(caught.value) == message


# --- what no draw has shown ---


def test_a_foretold_variance_counts_where_the_draws_show_less(seed):
    """A draw of 1000 once in a million: none is among these, and the error says so all the same."""
    p, size = 1e-6, 1e3

    def draw(generator, n):
        return 1.0 + size * (generator.random(n) < p)

    exact, variance = 1.0 + p * size, size**2 * p * (1 - p)
    blind = mean(draw, samples=1000, rng=seed)
    found = mean(draw, samples=1000, rng=seed, foretold=variance)
    assert not blind.covers(exact)  # planted: without it
    assert found.covers(exact)
    assert found.error == pytest.approx(np.sqrt(variance / 1000))
    # Where the draws show their variance, it changes nothing.
    plain = [
        mean(lambda g, n: g.random(n), samples=1000, rng=seed, foretold=known).error for known in (0.0, 0.1)
    ]
    assert plain[0] == plain[1]


def test_an_edge_that_no_draw_has_crossed_is_allowed_for(seed):
    found = mean(lambda generator, n: np.ones(n), samples=1000, rng=seed, edge=True)
    assert found.error == 2e-3
    assert mean(lambda generator, n: np.ones(n), samples=1000, rng=seed).error < 1e-14
