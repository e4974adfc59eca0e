"""Twins: exact inputs, honest digits, condition numbers, ulps, and proofs that end."""

from __future__ import annotations

import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import mpmath
import numpy as np
import pytest
import sympy

from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.measure.proof import TimeIsUp, proved_zero, time_limit
from radiokit.measure.twin import DIRECTION_SYMBOLS, Twin, scaled_ulps, ulps

X_I, Y_I, Z_I, X_O, Y_O, Z_O = DIRECTION_SYMBOLS
A, B = sympy.symbols("a b", positive=True)
UP = (0.0, 0.0, 1.0)


def test_importing_the_module_loads_no_sympy():
    code = "import sys, radiokit.measure.proof; print('sympy' in sys.modules, 'mpmath' in sys.modules)"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert out.split() == ["False", "False"]


def test_inputs_are_the_exact_binary_numbers():
    twin = Twin(X_I + A, {A: 0.1})
    with mpmath.workdps(60):
        assert twin.evaluate((0.1, 0, 0), UP) == 2 * mpmath.mpf(0.1)
        assert twin.evaluate((0.1, 0, 0), UP) != mpmath.mpf("0.2")


def test_cancellation_in_the_source_costs_precision_and_no_digits():
    """1 − cos at 1e-40 leaves nothing of fifty digits: the precision is doubled until they are there."""
    twin = Twin(1 - sympy.cos(A), {}, (A,))
    with mpmath.workdps(60):
        truth = 2 * mpmath.sin(mpmath.mpf(1e-40) / 2) ** 2
        assert abs(twin.at(1e-40) / truth - 1) < mpmath.mpf(10) ** -50


def test_noise_around_zero_is_zero_and_a_small_value_is_itself():
    assert Twin(sympy.sqrt(A) ** 2 - sympy.exp(sympy.log(A)), {}, (A,)).at(0.3) == 0
    assert float(Twin(sympy.exp(-A), {}, (A,)).at(690.0)) == pytest.approx(np.exp(-690.0), rel=1e-13)


def test_a_term_lost_at_every_ordinary_precision_is_found():
    """Both sixty and a hundred and twenty digits agree that 1 − cos 1e-100 is 0: they are wrong."""
    twin = Twin(1 + (1 - sympy.cos(A)) / A**2, {}, (A,))
    assert twin.at(1e-100) == pytest.approx(1.5)
    assert twin.at(1e-160) == pytest.approx(1.5)


def test_a_value_that_does_not_settle_is_an_error():
    large = sympy.Integer(10) ** 2000
    twin = Twin((sympy.sqrt(2 * large**2 + A) - sympy.sqrt(2) * large) * large, {}, (A,))
    with pytest.raises(RadiokitError, match="no 50 digits"):
        twin.at(1.0)


def test_a_division_by_zero_means_the_limit_where_there_is_one():
    x = sympy.Symbol("x")
    for expression in (sympy.sin(x) / x, sympy.erf(1 / x) + sympy.exp(-1 / x**2) / x):
        assert abs(Twin(expression, {}, (x,)).at(0.0) - 1) < mpmath.mpf(10) ** -50
    with pytest.raises(RadiokitError, match="no 50 digits"):
        Twin(1 / x, {}, (x,)).at(0.0)


def test_a_complex_value_is_an_error():
    with pytest.raises(RadiokitError, match="is complex"):
        Twin(sympy.sqrt(A - B), {B: 2.0}, (A,)).at(1.0)


def test_unbound_symbols_and_wrong_counts_are_named():
    with pytest.raises(ParameterError, match=r"unbound symbols \(a\)"):
        Twin(A + X_I)
    with pytest.raises(ParameterError, match="two directions"):
        Twin(X_I).evaluate((0, 0), UP)
    with pytest.raises(ParameterError, match="1 numbers"):
        Twin(A, {}, (A,)).at(1.0, 2.0)


def test_deltas_count_as_nothing():
    assert Twin(sympy.DiracDelta(X_I) + 1).evaluate(UP, UP) == 1


def test_condition_is_the_sum_over_arguments_and_parameters():
    twin = Twin(X_I**3 * Z_O**-2 * A**0.5, {A: 2.0})
    assert twin.condition((0.3, 0, 0), UP) == pytest.approx(5.5, rel=1e-12)
    near_one = Twin(1 - X_I**2)
    assert near_one.condition((0.999, 0, 0), UP) == pytest.approx(2 * 0.999**2 / (1 - 0.999**2), rel=1e-12)


def test_condition_where_the_function_vanishes():
    assert Twin(0 * X_I).condition(UP, UP) == 0
    assert Twin(X_I - Z_I).condition((1.0, 0, 1.0), UP) == np.inf


def test_swapping_exchanges_the_directions():
    twin = Twin(X_I * Y_O**2)
    assert twin.swapped().expression == X_O * Y_I**2
    assert twin.swapped().swapped() == twin


def test_threads_do_not_lower_each_other_s_precision():
    twin = Twin(sympy.sin(A) * sympy.log(A), {}, (A,))
    values = list(np.linspace(0.5, 2.0, 40))
    alone = [twin.at(x, digits=20 + 10 * (i % 3)) for i, x in enumerate(values)]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda ix: twin.at(ix[1], digits=20 + 10 * (ix[0] % 3)), enumerate(values)))
    assert alone == together


def test_hundreds_of_points_take_no_time():
    twin = Twin(sympy.exp(-((X_I + X_O) ** 2) / A) / (Z_I * Z_O + A), {A: 0.3})
    start = time.perf_counter()
    for x in np.linspace(0, 0.9, 300):
        twin.evaluate((x, 0, 0.5), UP)
        twin.condition((x, 0, 0.5), UP)
    assert time.perf_counter() - start < 60


# Ulps


def test_ulps_count_units_of_the_truth():
    one = mpmath.mpf(1)
    assert ulps(1.0, one) == 0
    assert ulps(1 + 2**-52, one) == 1
    assert ulps(1 - 2**-53, one) == 0.5
    with mpmath.workdps(50):
        assert ulps(1.0, one + mpmath.mpf(2) ** -54) == 0.25


def test_ulps_near_zero_and_beyond_the_largest():
    assert ulps(0.0, mpmath.mpf(0)) == 0
    assert ulps(5e-324, mpmath.mpf(0)) == 1
    assert ulps(0.0, mpmath.mpf("2e-324")) == pytest.approx(0.4048, abs=1e-3)
    assert ulps(np.nan, mpmath.mpf(1)) == np.inf
    assert ulps(np.inf, mpmath.mpf(1)) == np.inf
    assert ulps(np.inf, mpmath.mpf("1e400")) == 0
    assert ulps(np.finfo(float).max, mpmath.mpf("1e400")) == np.inf


def test_ulps_of_arrays_keep_their_shape():
    found = ulps([[1.0, 2.0]], [[mpmath.mpf(1), mpmath.mpf(2)]])
    assert found.shape == (1, 2)
    assert ulps([1.0, 1.0], mpmath.mpf(1)).tolist() == [0, 0]


def test_scaled_ulps_excuse_what_the_condition_explains_and_no_more():
    off = 1 + 16 * 2**-52
    assert scaled_ulps(off, mpmath.mpf(1), 4.0) == 4
    assert scaled_ulps(off, mpmath.mpf(1), 0.1) == 16
    assert scaled_ulps(off, mpmath.mpf(1), np.inf) == 16
    assert scaled_ulps(np.nan, mpmath.mpf(1), np.inf) == np.inf


# Proofs


def test_identities_are_proved():
    unit_i = X_I**2 + Y_I**2 + Z_I**2
    half = sympy.sqrt((X_I + X_O) ** 2 + (Y_I + Y_O) ** 2 + (Z_I + Z_O) ** 2)
    for zero in (
        sympy.Integer(0),
        (A + B) ** 2 - A**2 - 2 * A * B - B**2,
        sympy.sin(A) ** 2 + sympy.cos(A) ** 2 - 1,
        1 / (A - B) - (A + B) / (A**2 - B**2),
        unit_i - 1,
        sympy.exp(unit_i) - sympy.E,
        # The cosine to the half vector is the same for wi and wo, for unit vectors only.
        sympy.log((X_I * (X_I + X_O) + Y_I * (Y_I + Y_O) + Z_I * (Z_I + Z_O)) / half)
        - sympy.log((X_O * (X_I + X_O) + Y_O * (Y_I + Y_O) + Z_O * (Z_I + Z_O)) / half),
    ):
        assert proved_zero(zero), zero


def test_what_is_no_identity_is_not_proved():
    for other in (A - B, X_I - X_O, X_I**2 - 1, sympy.sin(A) - A, A * 1e-20, (Z_I - Z_O) / 10**9):
        assert not proved_zero(other), other


def test_a_proof_that_takes_too_long_is_given_up():
    """True, and a million terms when expanded."""
    monster = sum(sympy.symbols("s0:14")) ** 10
    identity = monster * sympy.sin(A) ** 2 + monster * sympy.cos(A) ** 2 - monster * sympy.cos(0)
    start = time.perf_counter()
    assert not proved_zero(identity, seconds=0.5)
    assert time.perf_counter() - start < 60


def test_atime_limit_ends_loops_without_calls_and_leaves_nothing_behind():
    def spin():
        while True:
            pass

    for _ in range(3):
        with pytest.raises(TimeIsUp), time_limit(0.02):
            spin()
    for _ in range(50):  # ending just as the time is up: the exception comes inside, or not at all
        try:
            with time_limit(0.002):
                time.sleep(0.0019)
        except TimeIsUp:
            pass
    time.sleep(0.01)


def test_proofs_work_in_threads():
    with ThreadPoolExecutor(4) as pool:
        proofs = pool.map(proved_zero, [sympy.sin(A) ** 2 + sympy.cos(A) ** 2 - 1, A - B] * 4)
        assert list(proofs) == [True, False] * 4
