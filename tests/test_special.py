"""The error function's relatives against 50 digits, as arrays and as machine code."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from radiokit.measure.elementary import exp
from radiokit.measure.kernels import Kernel
from radiokit.measure.passes import run
from radiokit.measure.special import erfc, erfcx, erfinv
from radiokit.measure.twin import ulps

both = pytest.mark.parametrize("mode", ["plain", "compiled"])


def apply(function, mode, x):
    return run(function, (x,), compiled=True) if mode == "compiled" else function(x)


def worst(found, inputs, exact, growth=lambda x: 1.0):
    """Return the largest error in ulps over ``growth``."""
    with mpmath.workdps(60):
        truths = [exact(mpmath.mpf(float(x))) for x in inputs]
        return max(ulps(y, t) / growth(x) for y, t, x in zip(found, truths, inputs, strict=True))


def exact_erfcx(x):
    if x < 50:
        return mpmath.erfc(x) * mpmath.exp(x * x)
    terms = [(-1) ** k * mpmath.fac2(2 * k - 1) / (2 * x * x) ** k for k in range(25)]
    return mpmath.fsum(terms) / (x * mpmath.sqrt(mpmath.pi))


def exact_erfinv(x):
    """By Halley's steps on erfc beyond 1/2, since mpmath's own loses digits near 1."""
    if abs(x) < 0.5:
        return mpmath.erfinv(x)
    left, y = 1 - abs(x), mpmath.sqrt(-mpmath.log(1 - abs(x)))
    for _ in range(60):
        step = (mpmath.erfc(y) - left) / (2 / mpmath.sqrt(mpmath.pi) * mpmath.exp(-y * y))
        y += step / (1 - step * y)
        if abs(step) <= abs(y) * mpmath.mpf(10) ** -30:
            break
    return mpmath.sign(x) * y


def half_lines(rng):
    return np.concatenate([[0, 1e-300, 3, 1e8, 1e150], 10 ** rng.uniform(-9, 9, 300), 30 * rng.random(300)])


@both
def test_erfcx_agrees_with_50_digits(mode, rng):
    x = half_lines(rng)
    assert worst(apply(erfcx, mode, x), x, exact_erfcx) <= 4
    assert erfcx(np.inf) < 1e-150


@both
def test_exp_and_erfc_agree_with_50_digits(mode, rng):
    x = np.concatenate(
        [[0, 709, -708, 1e-20], rng.uniform(-700, 700, 300), -(10 ** rng.uniform(-16, 2, 300))]
    )
    assert worst(apply(exp, mode, x), x, mpmath.exp, lambda x: 2 + abs(x)) <= 1
    assert apply(exp, mode, np.array([-709.0, -1e308, -np.inf])).tolist() == [0, 0, 0]
    x = rng.uniform(-8, 26, 400)
    assert worst(apply(erfc, mode, x), x, mpmath.erfc, lambda x: 4 + 2 * x * x) <= 1


@both
def test_erfinv_agrees_with_50_digits(mode, rng):
    tails = 1 - 10 ** rng.uniform(-15.9, 0, 200)
    x = np.concatenate([rng.uniform(-1, 1, 200), tails, -tails, [0.85, -0.85, 1 - 2.0**-53, 1e-300, 1e-9]])
    assert worst(apply(erfinv, mode, x), x, exact_erfinv) <= 5
    ends = apply(erfinv, mode, np.array([-1.0, 0.0, 1.0]))
    assert ends[1] == 0
    assert ends[2] == -ends[0] == pytest.approx(5.9216, abs=1e-4)


def test_what_loses_digits_is_rejected(rng):
    """Planted: a fit with a coefficient less, and the product with the exponential."""

    def short(x):
        q = (x - 3) / (x + 3)
        space = erfcx.function.__globals__
        terms = [*space["_X0"], *space["_X1"], *space["_X2"]][:-6]
        return (1 + (q + 1) * np.polynomial.polynomial.polyval(q, terms)) / (1 + 2 * x)

    assert isinstance(erfcx, Kernel)
    x = 25 * rng.random(100)
    product = np.exp(x * x) * np.vectorize(lambda t: float(mpmath.erfc(float(t))))(x)
    for wrong in (short(x), product):
        assert worst(wrong, x, exact_erfcx) > 4
