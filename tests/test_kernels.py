"""Kernels: one source, compiled or not; random numbers by seed and index; fused sums that are honest."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tracemalloc
from typing import Any

import mpmath
import numpy as np
import pytest

from radiokit.bsdfs.ggx import GGX
from radiokit.contracts.albedo import albedo, directional_albedo
from radiokit.contracts.bsdf import bsdf
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import NonFiniteError, ParameterError
from radiokit.measure import elementary, passes
from radiokit.measure.elementary import atan2, exp, expm1, key_of, log, log1p, sincos, stream, uniform
from radiokit.measure.fused import BLOCK, FusedDraw, fused_mean, points
from radiokit.measure.kernels import Kernel, kernel, last, numba_runs, select
from radiokit.measure.moments import Moments
from radiokit.measure.passes import processors, run
from radiokit.measure.statistics import binomial_interval, chi_square, sidak, z_test
from radiokit.physics.fresnel import clip_index, conductor, conductor_kernel

LEVEL = 1e-6  # chance that a right thing is rejected in a test of this file
EPS = float(np.finfo(float).eps)
BITS = 1 << 64

both = pytest.mark.parametrize("mode", ["plain", "compiled"])
MODELS = (
    ("ggx", {"alpha": 0.3}),
    ("ggx", {"alpha": 0.2, "eta": 0.2, "k": 3.9}),
    ("phong", {"exponent": 10.0}),
)
models = pytest.mark.parametrize(("name", "parameters"), MODELS, ids=["ggx", "ggx-metal", "phong"])


def apply(function: Kernel, mode: str, *columns: Any) -> Any:
    """Return a kernel's values for columns of arguments, by NumPy or number by number from machine code."""
    if mode == "plain":
        with np.errstate(invalid="ignore"):
            return function(*columns)
    rows = zip(*(column.tolist() for column in np.broadcast_arrays(*columns)), strict=True)
    return np.array([function.compiled(*row) for row in rows]).T


@kernel
def product(u0, u1, a):
    """Mean a/4."""
    return a * u0 * u1


@kernel
def narrow(u0, u1, centre, spread):
    """Mean ``centre``."""
    return centre + spread * (u0 - u1)


@kernel
def root(u0, u1, below):
    """NaN where u0 is below the limit."""
    return np.sqrt(u0 - below)


# Elementary functions


def worst_ulps(found, inputs, exact):
    """Return the largest error in units in the last place of the exact value."""
    with mpmath.workdps(50):
        truths = [exact(mpmath.mpf(float(x))) for x in inputs]
        return max(
            float(abs(mpmath.mpf(float(y)) - t) / np.spacing(abs(float(t)))) if t else abs(float(y)) / EPS
            for y, t in zip(found, truths, strict=True)
        )


def turns(rng):
    near = np.array([0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0])
    around = np.concatenate(
        [np.nextafter(near, 2.0), np.nextafter(near[1:], -1.0), near + 1e-9, near[1:] - 1e-9]
    )
    inside = around[(around >= 0) & (around <= 1)]
    return np.concatenate([near, inside, [2.0**-53, 1e-300], rng.random(1500)])


def exact_sine(turn):
    return mpmath.sinpi(2 * turn)


def exact_cosine(turn):
    return mpmath.cospi(2 * turn)


@both
def test_sincos_agrees_with_50_digits(mode, rng):
    u = turns(rng)
    sine, cosine = apply(sincos, mode, u)
    assert worst_ulps(sine, u, exact_sine) <= 2
    assert worst_ulps(cosine, u, exact_cosine) <= 2


def test_sincos_with_a_term_less_is_rejected(rng):
    u = rng.random(300) / 8
    t = u * u
    e = elementary
    short = u * (e._S0 + t * (e._S1 + t * (e._S2 + t * (e._S3 + t * (e._S4 + t * e._S5)))))
    assert worst_ulps(short, u, exact_sine) > 2


@both
def test_log_and_expm1_agree_with_50_digits(mode, rng):
    ends = [1.0, 1 - 2.0**-53, 1 + 2.0**-52, 0.5, np.sqrt(0.5), 2.0**-53, 1e-300, 1e300, 1 - 1e-9, 1.5]
    x = np.concatenate([ends, 10.0 ** rng.uniform(-16, 1, 700), rng.random(700)])
    assert worst_ulps(apply(log, mode, x), x, mpmath.log) <= 3
    x = np.concatenate(
        [[0.0, -1e-300, -1e-20, -0.34657, -0.3466, -37.0], -(10.0 ** rng.uniform(-18, 1, 1000))]
    )
    x = np.concatenate([x, -x[-100:]])
    worst = [
        worst_ulps([y], [v], mpmath.expm1) - abs(v) for y, v in zip(apply(expm1, mode, x), x, strict=True)
    ]
    assert max(worst) <= 3
    x = np.concatenate([x, -x, rng.uniform(-699, 699, 500), [700.0, -700.0]])
    worst = [worst_ulps([y], [v], mpmath.exp) - abs(v) for y, v in zip(apply(exp, mode, x), x, strict=True)]
    assert max(worst) <= 2
    assert apply(exp, mode, np.array([-709.0, -1e300, -np.inf])).tolist() == [0.0, 0.0, 0.0]
    x = np.concatenate([[-0.29, 0.41, -0.5, 1.0, 1e9], 10.0 ** rng.uniform(-300, 3, 500)])
    x = np.concatenate([x, -(10.0 ** rng.uniform(-300, -0.001, 500)), rng.uniform(-0.5, 0.7, 500)])
    assert worst_ulps(apply(log1p, mode, x), x, mpmath.log1p) <= 3


def plane(rng):
    """Return x and y of points in every direction: on the axes and diagonals, near them, at any distance."""
    angle = np.concatenate([rng.uniform(-np.pi, np.pi, 600), np.arange(-8, 9) * (np.pi / 8)])
    angle = np.concatenate([angle, angle[-17:] + 1e-9, 10.0 ** rng.uniform(-300, 0, 200)])
    length = 10.0 ** rng.uniform(-8, 8, len(angle))
    x, y = length * np.cos(angle), length * np.sin(angle)
    axes = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.0, 0.0), (1.0, 1.0), (-3.0, 3.0)]
    return tuple(np.concatenate([a, b]) for a, b in zip((x, y), np.array(axes).T, strict=True))


def worst_atan2(found, x, y):
    return worst_ulps(found, range(len(x)), lambda i: mpmath.atan2(float(y[int(i)]), float(x[int(i)])))


@both
def test_atan2_agrees_with_50_digits(mode, rng):
    x, y = plane(rng)
    assert worst_atan2(apply(atan2, mode, y, x), x, y) <= 3


def test_atan2_with_a_term_less_is_rejected(rng, monkeypatch):
    x, y = plane(rng)
    monkeypatch.setattr(elementary, "_A11", 0.0)
    assert worst_atan2(atan2.plain(y, x), x, y) > 3


@both
def test_the_conductor_is_one_kernel(mode, rng):
    cosine = np.concatenate([[0.0, 1.0, 1e-9, 0.75], rng.random(100)])
    for eta, k in ((0.2, 3.9), (1.5, 0.0), (1.0, 0.0), (1e-6, 1e6), (1e80, 1e80), (1e-80, 0.0)):
        found = apply(conductor_kernel, mode, cosine, *clip_index(eta, k))
        np.testing.assert_allclose(found, conductor(cosine, eta, k), rtol=1e-13, atol=1e-150)


# Random numbers


def reference(key: int, dimension: int, index: int) -> float:
    """The hash once more, in Python's integers."""

    def mix(z: int) -> int:
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 % BITS
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB % BITS
        return z ^ (z >> 31)

    golden = 0x9E3779B97F4A7C15
    start = mix((key + (dimension + 1) * golden) % BITS)
    return (mix((start + index * golden) % BITS) >> 11) / 2**53


@both
def test_the_numbers_are_the_hash_to_the_last_bit(mode, seed):
    key = key_of(seed)
    index = np.array([0, 1, 2, 1000, 2**32, 2**63, 2**64 - 1], dtype=np.uint64)
    for dimension in (0, 1, 5):
        with np.errstate(over="ignore"):
            start = stream(key, np.uint64(dimension))
        if mode == "compiled":
            assert stream.compiled(key, np.uint64(dimension)) == start
            found = [uniform.compiled(np.uint64(start), i) for i in index]
        else:
            with np.errstate(over="ignore"):
                found = uniform(start, index)
        assert list(found) == [reference(int(key), dimension, int(i)) for i in index]


def test_the_numbers_are_uniform_and_independent(seed):
    """Pairs within a sample, of neighbours in a stream, and of neighbouring seeds: 32 × 32 cells each."""
    n = 1 << 18
    u0, u1 = points(key_of(seed), 0, n + 1)
    v0, v1 = points(key_of(seed + 1), 0, n + 1)
    pairs = [(u0, u1), (u0[:-1], u0[1:]), (u1[:-1], u1[1:]), (u0, v0), (u1, v1), (u0[:-1], u1[1:])]
    fine = [(np.ldexp(u0, 20) % 1, np.ldexp(u1, 20) % 1)]  # the low bits
    for a, b in pairs + fine:
        counts = np.histogram2d(a, b, bins=32, range=((0, 1), (0, 1)))[0]
        assert counts.sum() == len(a)
        result = chi_square(counts, np.full(counts.shape, len(a) / 1024))
        assert result.p_value > sidak(LEVEL, len(pairs) + 1)
    assert len(np.unique(np.concatenate([u0, u1, v0, v1]))) > 4 * n * (1 - 1e-6)


def test_a_lattice_in_place_of_the_hash_is_rejected():
    n = 1 << 18
    a = np.arange(n) * 0.6180339887498949 % 1
    counts = np.histogram2d(a[:-1], a[1:], bins=32, range=((0, 1), (0, 1)))[0]
    assert chi_square(counts, np.full(counts.shape, (n - 1) / 1024)).p_value < LEVEL


def test_any_part_of_a_stream_is_had_alone(seed):
    whole, part = points(key_of(seed), 0, 1000), points(key_of(seed), 700, 10)
    np.testing.assert_array_equal(np.stack(whole)[:, 700:710], part)
    assert key_of(2**200 + seed) != key_of(seed)


# The decorator


def test_a_kernel_is_a_plain_function_too():
    assert product(0.5, 0.5, 2.0) == 0.5
    np.testing.assert_array_equal(product(np.array([0.5, 1.0]), 0.5, 2.0), [0.5, 1.0])
    assert select(False, 1.0, 2.0) == 2.0
    assert repr(sincos) == "kernel(radiokit.measure.elementary.sincos)"
    assert pickle.loads(pickle.dumps(sincos)) is sincos
    assert sincos.__doc__.startswith("Return sine and cosine")


@both
def test_a_pass_takes_arrays_numbers_and_spectra(mode, rng, monkeypatch):
    if mode == "plain":
        monkeypatch.setenv("RADIOKIT_NO_NUMBA", "1")
    u = rng.random(20_003)
    assert run(product, ([0.5], 0.5), (4,), compiled=True) == [1.0]
    assert np.isnan(run(root, ([0.0], 0.0), (1.0,), compiled=True))
    sine, cosine = run(sincos, (u,), compiled=True)
    np.testing.assert_allclose(sine, np.sin(2 * np.pi * u), atol=1e-14)
    np.testing.assert_allclose(cosine, np.cos(2 * np.pi * u), atol=1e-14)
    spectrum = run(product, (u, 0.5), ([1.0, 2.0, 4.0],), compiled=True)
    np.testing.assert_array_equal(spectrum, 0.5 * u[:, None] * [1.0, 2.0, 4.0])
    assert run(product, (u, 0.5), ([2.0],)).shape == (len(u), 1)
    assert run(sincos, (np.empty(0),), compiled=True)[1].shape == (0,)
    two = kernel(lambda a, b, scale: (a + b, a * scale))
    total, scaled = run(two, (u, u), ([3.0],))
    assert total.shape == (len(u),)
    assert scaled.shape == (len(u), 1)


@pytest.mark.parametrize("columns", [([0.5, 1.0], [0.5]), (0.5, 0.5), ([[0.5]], [[0.5]])])
def test_columns_that_are_no_columns_are_refused(columns):
    with pytest.raises(ParameterError, match=r"columns = .* is not allowed: it must be arrays of one shape"):
        run(product, columns, (4.0,))


def test_machine_code_and_numpy_give_the_same_bits(rng, monkeypatch):
    """What passes run is strict; the loops that sum are not, and give other bits."""
    x = np.concatenate([rng.normal(size=40_000), 10 ** rng.uniform(-300, 2, size=40_000), [0.0, -700.0, 1e9]])
    small = np.concatenate([rng.uniform(-0.999, 3.0, size=40_000), 10 ** rng.uniform(-300, 2, size=40_000)])
    for function, column in ((sincos, rng.random(80_000)), (log, abs(x) + 1e-300), (exp, x), (log1p, small)):
        np.testing.assert_array_equal(
            run(function, (column,), compiled=False), run(function, (column,), compiled=True)
        )
    loose = np.array([log1p.compiled(value) for value in small.tolist()])
    assert np.any(loose != run(log1p, (small,), compiled=True))


def test_a_pass_of_many_rows_is_machine_code_on_all_processors(rng, monkeypatch):
    taken = []

    def told(*arguments):
        taken.append(arguments[-2:])
        return machine(*arguments)

    machine = passes._loop(product, (True, True), 1, 0)
    monkeypatch.setattr(passes, "_loop", lambda *_: told)
    u = rng.random((2, passes.PAYS))
    few = run(product, u[:, :-1], (0.5,))
    assert taken == []
    many = run(product, u, (0.5,))
    assert len(taken) > 1
    np.testing.assert_array_equal(many[:-1], few)


def test_what_is_no_kernel_is_refused():
    with pytest.raises(TypeError, match="made from a function, not from int"):
        kernel(3)
    inner = kernel(lambda x: x + 1.0)
    with pytest.raises(TypeError, match="not enclosed ones: inner"):
        _ = kernel(lambda x: inner(x)).inlined


def test_the_fingerprint_follows_every_kernel_and_constant():
    def made(body, **names):
        space = {"kernel": kernel, **names}
        exec(f"@kernel\ndef f(x):\n    return {body}", space)
        return space["f"]

    helper, other = made("x + 1.0"), made("x + 2.0")
    prints = [
        made("g(x)", g=helper).fingerprint,
        made("g(x)", g=other).fingerprint,
        made("c * x", c=2.0).fingerprint,
        made("c * x", c=3.0).fingerprint,
    ]
    assert len(set(prints)) == 4
    assert made("g(x)", g=made("x + 1.0")).fingerprint == prints[0]


def test_the_switch_and_the_absence_of_numba(monkeypatch):
    assert numba_runs()
    monkeypatch.setenv("RADIOKIT_NO_NUMBA", "1")
    assert not numba_runs()
    monkeypatch.setenv("RADIOKIT_NO_NUMBA", "0")
    assert numba_runs()
    numba = pytest.importorskip("numba")
    with monkeypatch.context() as patch:
        patch.setattr(numba.config, "DISABLE_JIT", 1)
        assert not numba_runs()
    monkeypatch.setitem(sys.modules, "numba", None)
    assert not numba_runs()


# Models


@models
def test_albedo_by_monte_carlo_covers_the_truth_as_often_as_it_says(name, parameters, seed):
    trials = 400
    f, wo = bsdf(name, **parameters), spherical_to_cartesian(1.0, 0.3)
    truth = directional_albedo(f, wo, rtol=1e-10).value
    found = [albedo(f, wo, method="mc", samples=20_000, rng=seed + i) for i in range(trials)]
    covered = sum(estimate.covers(truth) for estimate in found)
    low, high = binomial_interval(covered, trials, 1 - LEVEL)
    assert low <= 0.95 <= high
    z = np.array([(estimate.value - truth) / estimate.error for estimate in found])
    assert abs(z.mean()) < 5 / np.sqrt(trials)
    assert {e.kind for e in found} == {"statistical"}
    assert {e.evaluations for e in found} == {20_000}
    assert all(e.converged and e.seconds > 0 and not e.note for e in found)


ggx = GGX().kernels()
ggx_value, ggx_density, ggx_sample = ggx.value, ggx.density, ggx.sample


@kernel
def wider(u0, u1, ox, oy, oz, alpha, same):
    """Planted: facets of another width than the weight is for."""
    wx, wy, wz, _ = ggx_sample(u0, u1, ox, oy, oz, 1.01 * alpha, 1.01 * alpha)
    density = ggx_density(wx, wy, wz, ox, oy, oz, alpha, alpha)
    value = ggx_value(wx, wy, wz, ox, oy, oz, alpha, alpha)
    return wx, wy, wz, wz * value / select(density > 0.0, density, 1.0)


def test_a_biased_sampler_and_a_wrong_density_are_rejected(seed):
    f, wo = bsdf("ggx", alpha=0.3), spherical_to_cartesian(1.0, 0.3)
    truth = directional_albedo(f, wo, rtol=1e-10).value
    weight, constants = f.weight_kernel(wo)
    p = [z_test(fused_mean(weight, constants, samples=1 << 22, rng=seed + i), truth) for i in range(4)]
    assert min(p) > sidak(LEVEL, 4)
    wrong = fused_mean(last(wider), constants, samples=1 << 22, rng=seed)
    assert z_test(wrong, truth) < LEVEL
    high = fused_mean(weight, constants, samples=1 << 22, rng=seed).scaled(1.001)
    assert z_test(high, truth) < LEVEL


def test_an_interval_too_narrow_is_rejected(seed):
    """Planted: half the points are used twice."""
    trials = 400

    def twice(u0, u1):
        half = len(u0) // 2
        return np.concatenate([u0[:half], u0[:half]]) * 1.0

    found = [fused_mean(twice, samples=2000, rng=seed + i, workers=1) for i in range(trials)]
    covered = sum(estimate.covers(0.5) for estimate in found)
    assert binomial_interval(covered, trials, 1 - LEVEL)[1] < 0.95


def test_lambert_has_no_variance():
    found = albedo(
        bsdf("lambert", reflectance=0.7), (0.0, 0.6, 0.8), method="mc", samples=3 * BLOCK + 1, rng=1
    )
    assert found.value == 0.7
    assert 0 < found.error < 1e-14


def test_many_directions_share_one_compiled_kernel(seed):
    f = bsdf("ggx", alpha=0.3)
    wo = spherical_to_cartesian([0.0, 0.5, 1.0], 0.3)
    many = albedo(f, wo, method="mc", samples=5000, rng=seed)
    assert many.value.shape == many.error.shape == (3,)
    assert many.evaluations == 15_000
    truth = [directional_albedo(f, w).value for w in wo]
    assert np.all(z_test(many, truth) > sidak(LEVEL, 3))


# Sums


@models
def test_without_numba_the_numbers_are_the_same(name, parameters, seed, monkeypatch):
    f, wo = bsdf(name, **parameters), spherical_to_cartesian(1.2, 0.3)
    samples = BLOCK + 12_345
    compiled = albedo(f, wo, method="mc", samples=samples, rng=seed)
    monkeypatch.setenv("RADIOKIT_NO_NUMBA", "1")
    plain = albedo(f, wo, method="mc", samples=samples, rng=seed)
    assert plain.value == pytest.approx(compiled.value, rel=1e-13)
    assert plain.error == pytest.approx(compiled.error, rel=1e-11)
    assert plain.evaluations == compiled.evaluations == samples
    assert plain.method == compiled.method


@pytest.mark.parametrize("mode", ["plain", "compiled", "black box"])
def test_the_answer_does_not_depend_on_the_threads(mode, seed, monkeypatch):
    if mode == "plain":
        monkeypatch.setenv("RADIOKIT_NO_NUMBA", "1")
    function = (lambda u0, u1, a: a * u0 * u1) if mode == "black box" else product
    samples = 2 * BLOCK + 17
    found = [fused_mean(function, (3.0,), samples=samples, rng=seed, workers=w) for w in (1, 2, 5, None)]
    assert found[0].evaluations == samples
    assert len({(estimate.value, estimate.error, estimate.evaluations) for estimate in found}) == 1
    assert z_test(found[0], 0.75) > LEVEL


def test_a_black_box_stands_in_for_a_kernel(seed):
    kernels = fused_mean(product, (3.0,), samples=BLOCK + 5, rng=seed)
    box = fused_mean(lambda u0, u1, a: list(a * u0 * u1), (3.0,), samples=BLOCK + 5, rng=seed)
    assert box.value == pytest.approx(kernels.value, rel=1e-14)
    assert box.error == pytest.approx(kernels.error, rel=1e-12)
    with pytest.raises(
        ParameterError, match=r"function = \(3,\) is not allowed: it must be one that returns"
    ):
        fused_mean(lambda u0, u1: np.zeros(3), samples=100, rng=seed)


@both
@pytest.mark.parametrize(
    ("centre", "spread"), [(0.0, 1.0), (1e9, 1e-3), (1.0, 1e-12), (0.1, 0.0), (1e-200, 1e-210), (-5.0, 1.0)]
)
@pytest.mark.parametrize("count", [1, 2, 63, 64, 65, 100_003])
def test_the_moments_are_those_of_the_values(centre, spread, count, mode, seed, monkeypatch):
    if mode == "plain":
        monkeypatch.setenv("RADIOKIT_NO_NUMBA", "1")
    u0, u1 = points(key_of(seed), 9, count)
    exact = Moments.of(centre + spread * (u0 - u1))
    draw = FusedDraw(narrow, (centre, spread))
    draw.prepare()
    found = draw.moments(seed, 9, count)
    assert found.count == count
    scale = abs(centre) + abs(spread)
    assert abs(found.mean - exact.mean) <= 4 * EPS * scale
    # What one rounding of each value is worth to the sum of squares.
    assert abs(found.m2 - exact.m2) <= 1e-11 * exact.m2 + 4 * count * EPS * scale * (spread + EPS * scale)
    assert found.low <= exact.low + EPS * scale
    assert found.high >= exact.high - EPS * scale
    assert found.high - found.low <= 2 * (exact.high - exact.low) + 8 * EPS * scale
    if spread == 0.0:
        assert (found.mean, found.m2, found.low, found.high) == (centre, 0.0, centre, centre)


def test_a_sample_that_dominates_is_remarked(seed):
    def rare(u0, u1):
        return np.where(np.arange(len(u0)) == 0, 1e6, u0)

    assert "of the variance" in fused_mean(rare, samples=1000, rng=seed, workers=1).note
    assert fused_mean(product, (0.0,), samples=1000, rng=seed).note == "every sample was 0"


@both
def test_a_value_that_is_none_is_never_averaged(mode, seed, monkeypatch):
    if mode == "plain":
        monkeypatch.setenv("RADIOKIT_NO_NUMBA", "1")
    u0, _ = points(key_of(seed), 0, 2 * BLOCK)
    first = int(np.flatnonzero(u0 < 1e-4)[0])
    with pytest.raises(NonFiniteError, match=rf"root returned nan as sample {first}$"):
        fused_mean(root, (1e-4,), samples=2 * BLOCK, rng=seed)
    with pytest.raises(NonFiniteError, match="narrow"):
        fused_mean(narrow, (np.inf, 1.0), samples=100, rng=seed)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"samples": 1}, "samples = 1 is not allowed: it must be an integer, at least 2"),
        ({"samples": 1e6}, "samples = 1000000.0 is not allowed: it must be an integer, at least 2"),
        ({"workers": 0}, "workers = 0 is not allowed: it must be an integer, at least 1, or None"),
        (
            {"rng": -1},
            "rng = -1 is not allowed: it must be a non-negative int, a numpy.random.Generator, or None",
        ),
    ],
)
def test_arguments_out_of_range(arguments, message):
    with pytest.raises(ParameterError) as caught:
        fused_mean(product, (1.0,), **{"samples": 100, **arguments})
    assert str(caught.value) == message


def test_memory_does_not_grow_with_the_samples(seed):
    def peak(blocks):
        tracemalloc.start()
        fused_mean(product, (1.0,), samples=blocks * BLOCK, rng=seed)
        size = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return size

    peak(2)
    assert peak(1000) < 1.5 * peak(300) < 2_000_000  # 256 blocks are on their way at most


# Fresh processes

FIRST = """
import pathlib
import sys
import numpy as np
from radiokit import albedo, bsdf
f = bsdf("ggx", alpha=0.3)
found = albedo(f, (0.6, 0.0, 0.8), method="mc", samples=SAMPLES, rng=1)
from radiokit.measure import fused
weight, constants = f.weight_kernel(np.array([0.6, 0.0, 0.8]))
hits = 0
if "numba" in sys.modules:
    hits = sum(fused._compiled(weight, len(constants), 2).stats.cache_hits.values())
status = pathlib.Path("/proc/self/status")
peak = 0
if status.exists():
    peak = next(int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith("VmHWM"))
print(float(found.value).hex(), "numba" in sys.modules, hits, peak)
"""


def fresh(cache: Any, samples: int, **environment: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", FIRST.replace("SAMPLES", str(samples))],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "NUMBA_CACHE_DIR": str(cache), **environment},
    )
    assert done.stderr == ""
    return done.stdout.split()


def test_a_second_process_finds_the_machine_code_of_the_first(tmp_path):
    first = fresh(tmp_path, 1000)
    files = sorted(tmp_path.rglob("*.nbc"))
    assert len(files) == 1
    second = fresh(tmp_path, 1000)
    assert sorted(tmp_path.rglob("*.nbc")) == files
    assert (first[0], first[2], second[2]) == (second[0], "0", "1")


@pytest.mark.skipif(sys.platform != "linux", reason="/proc/self/status counts KiB on Linux")
def test_a_quarter_of_a_billion_samples_need_no_more_memory_than_a_thousand(tmp_path):
    few, many = (int(fresh(tmp_path, samples)[3]) for samples in (1000, 1 << 28))
    assert many < few + 20_000
    assert many < 300_000


def test_a_process_without_numba_does_not_load_it(tmp_path):
    value, loaded, _, _ = fresh(tmp_path, 1000, RADIOKIT_NO_NUMBA="1")
    assert loaded == "False"
    assert float.fromhex(value) == pytest.approx(float.fromhex(fresh(tmp_path, 1000)[0]), rel=1e-13)


def test_nowhere_to_keep_the_cache_is_no_failure(monkeypatch):
    from numba.core import caching

    from radiokit.measure import fused

    def nowhere(self, function):
        raise RuntimeError("cannot cache function: no locator available")

    monkeypatch.setattr(caching.CompileResultCacheImpl, "__init__", nowhere)
    found = fused._compiled.__wrapped__(product, 1, 2)
    assert found(np.uint64(1), np.uint64(0), 100, (1.0,))[0] > 0
    assert not found.stats.cache_path


def test_a_browser_has_one_processor(monkeypatch):
    assert 1 <= processors() <= (os.cpu_count() or 1)
    monkeypatch.setattr(sys, "platform", "emscripten")
    assert processors() == 1
