"""Statistics: right things pass at the stated rate, planted wrong ones are rejected."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.statistics import binomial_interval, chi_square, sidak, z_test

LEVEL = 1e-6  # chance that a right thing is rejected in a test of this file


def test_sidak_is_exact_where_the_naive_form_has_lost_its_digits():
    assert (1 - sidak(0.05, 100)) ** 100 == pytest.approx(0.95, rel=1e-12)
    assert sidak(1e-18, 3) == pytest.approx(1e-18 / 3, rel=1e-12)
    assert sidak(0.01, 1) == pytest.approx(0.01, rel=1e-15)


def test_sidak_holds_the_level_of_all_tests_together(rng):
    p = rng.random((20_000, 25))
    rejected = int(np.count_nonzero((p < sidak(0.05, 25)).any(axis=1)))
    low, high = binomial_interval(rejected, 20_000, 1 - LEVEL)
    assert low <= 0.05 <= high


def test_z_test_is_the_normal_tail():
    assert z_test(Estimate(1.0, 0.5, "statistical"), 2.0) == pytest.approx(2 * stats.norm.sf(2.0), rel=1e-12)
    assert z_test(Estimate(1.0, 0.0, "statistical"), 1.0) == 1
    assert z_test(Estimate(1.0, 0.0, "statistical"), 1.1) == 0
    assert z_test(Estimate(0.0, 1.0, "statistical"), 12.0) == pytest.approx(
        2 * stats.norm.sf(12.0), rel=1e-10
    )
    several = z_test(Estimate(np.zeros(2), np.ones(2), "statistical"), np.array([0.0, 1.0]))
    assert several.tolist() == [1.0, pytest.approx(0.3173, abs=1e-4)]


def test_z_test_refuses_a_bound():
    with pytest.raises(ParameterError, match=r"estimate\.kind = 'truncation'"):
        z_test(Estimate(1.0, 0.5, "truncation"), 1.0)


def test_chi_square_agrees_with_scipy():
    observed = np.array([[18, 25], [30, 27]])
    found = chi_square(observed, np.full((2, 2), 25.0))
    truth = stats.chisquare(observed.ravel())
    assert (found.statistic, found.p_value) == (pytest.approx(truth.statistic), pytest.approx(truth.pvalue))
    assert (found.dof, found.pooled) == (3, 0)


def test_chi_square_of_the_right_distribution_is_uniform(rng):
    """With many cells that need pooling, p-values are still spread as they should be."""
    probability = np.array([0.5, 0.3, 0.15, *np.full(20, 0.05 / 20)])
    p = [chi_square(counts, 400 * probability).p_value for counts in rng.multinomial(400, probability, 400)]
    assert stats.kstest(p, "uniform").pvalue > LEVEL


def test_chi_square_rejects_a_distribution_that_is_a_little_off(rng):
    right = np.full(50, 1 / 50)
    wrong = right * (1 + 0.1 * np.where(np.arange(50) % 2, 1, -1))
    assert chi_square(rng.multinomial(50_000, right), 50_000 * right).p_value > LEVEL
    assert chi_square(rng.multinomial(50_000, wrong), 50_000 * right).p_value < LEVEL


def test_chi_square_sees_a_fault_in_the_pooled_tail(rng):
    right = np.array([0.9, 0.06, *np.full(40, 0.001)])
    wrong = np.array([0.94, 0.06, *np.full(40, 0.0)])
    assert chi_square(rng.multinomial(2000, wrong), 2000 * right).p_value < LEVEL
    assert chi_square(rng.multinomial(2000, right), 2000 * right).p_value > LEVEL


def test_small_cells_are_pooled_from_the_smallest_up():
    found = chi_square([50, 3, 2, 3, 2, 40], [50, 2.5, 2.5, 2.5, 2.5, 40])
    assert (found.pooled, found.dof) == (4, 3)
    rest = chi_square([50, 1, 49], [49.5, 1.0, 49.5])  # a remainder too small to stand alone
    assert (rest.pooled, rest.dof) == (1, 1)


def test_a_count_where_nothing_is_expected_refutes_at_once():
    found = chi_square([99, 100, 1], [100, 100, 0])
    assert (found.p_value, found.statistic) == (0.0, math.inf)
    assert chi_square([100, 100, 0], [100, 100, 0]).p_value == 1


@pytest.mark.parametrize(
    ("observed", "expected", "what"),
    [
        ([10, 10], [10, 10, 0], "of the shape of observed"),
        ([10, -1], [5, 4], "finite and at least 0"),
        ([10, 10], [np.nan, 10], "finite and at least 0"),
        ([100, 100], [90, 90], "a sum of 200, the number observed"),
        ([2, 1], [2, 1], "enough for two cells"),
    ],
)
def test_chi_square_says_what_is_wrong(observed, expected, what):
    with pytest.raises(ParameterError, match=what):
        chi_square(observed, expected)


def test_the_binomial_interval_is_scipy_s():
    for successes, trials, level in ((0, 10, 0.95), (10, 10, 0.95), (3, 10, 0.9), (480, 500, 0.999999)):
        truth = stats.binomtest(successes, trials).proportion_ci(level, method="exact")
        assert binomial_interval(successes, trials, level) == pytest.approx((truth.low, truth.high), rel=1e-9)


def test_the_binomial_interval_covers(rng):
    for p in (0.02, 0.5, 0.95):
        intervals = {k: binomial_interval(k, 40, 0.9) for k in range(41)}
        hits = sum(intervals[int(k)][0] <= p <= intervals[int(k)][1] for k in rng.binomial(40, p, 5000))
        assert binomial_interval(hits, 5000, 1 - LEVEL)[1] >= 0.9


@pytest.mark.parametrize(
    "call",
    [
        lambda: sidak(0.0, 3),
        lambda: sidak(0.05, 0),
        lambda: binomial_interval(1, 0),
        lambda: binomial_interval(3, 2),
        lambda: binomial_interval(1, 2, 1.0),
        lambda: chi_square([1, 1], [1, 1], min_expected=0.0),
    ],
)
def test_arguments_out_of_range(call):
    with pytest.raises(ParameterError):
        call()
