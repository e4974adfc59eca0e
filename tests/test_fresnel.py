"""Fresnel's reflectances against the complex amplitudes at 50 digits, at inputs that are hard."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import sympy

from radiokit.facts.errors import ParameterError
from radiokit.measure.twin import Twin, scaled_ulps
from radiokit.physics import fresnel

C, ETA, K, F0 = sympy.symbols("c eta k f0", real=True)
DIELECTRIC = Twin(fresnel.dielectric_symbolic(C, ETA), {}, (C, ETA))
CONDUCTOR = Twin(fresnel.conductor_symbolic(C, ETA, K), {}, (C, ETA, K))
SCHLICK = Twin(fresnel.schlick_symbolic(C, F0), {}, (C, F0))

GRAZING = float(np.cos(np.radians(89.9999)))
COSINES = (1.0, 1 - 2**-53, 0.9999999999, 0.7, 0.3, GRAZING, 1e-12)
INDICES = (1.5, 1 / 1.5, 2.4, 1.33, 1e3, 1e-3, 1e8, 1 + 1e-12, 1 - 1e-9, 1 + 2**-52, 1 - 2**-53)


def worst(kernel, twin, inputs):
    """Return the largest error in ulps over max(1, condition)."""
    return max(scaled_ulps(kernel(*x), twin.at(*x), twin.condition_at(*x)) for x in inputs)


def near_critical(eta):
    """Return cosines on both sides of the critical angle, however close."""
    inner = min(eta, 1 / eta)
    critical = np.sqrt((1 - inner) * (1 + inner)) * (-1 if eta > 1 else 1)
    return [float(critical * (1 + d)) for d in (1e-3, 1e-9, 1e-14, -1e-14, -1e-9, -1e-3)]


def brewster(eta):
    return [float(1 / np.hypot(1, eta)), float(-eta / np.hypot(1, eta))]


@pytest.mark.parametrize("eta", INDICES)
def test_dielectric_agrees_with_the_complex_amplitudes(eta):
    cosines = [*COSINES, *(-c for c in COSINES), *near_critical(eta), *brewster(eta), 0.0]
    inputs = [(c, eta) for c in cosines if abs(c) <= 1]
    assert worst(fresnel.dielectric, DIELECTRIC, inputs) <= 8


@pytest.mark.parametrize("k", [0.0, 1e-30, 1e-9, 1e-3, 0.5, 1.0, 3.9, 100.0, 1e6, 1e30])
def test_conductor_agrees_with_the_complex_amplitudes(k):
    indices = (0.05, 0.2, 0.7, 1.5, 1.0, 1 + 1e-12, 3.0, 1e-6, 1e6, 1e-30)
    inputs = [(c, eta, k) for eta, c in itertools.product(indices, COSINES)]
    inputs += [(c, eta, k) for eta in (0.05, 0.7) for c in near_critical(eta) if c < 1]
    inputs += [(brewster(eta)[0], eta, k) for eta in indices] + [(0.0, 1.5, k)]
    assert worst(fresnel.conductor, CONDUCTOR, inputs) <= 8


def test_schlick_agrees_with_its_definition():
    inputs = itertools.product((*COSINES, 0.0), (0.0, 1e-9, 0.04, 0.9, 1.0))
    assert worst(fresnel.schlick, SCHLICK, inputs) <= 8


def test_a_kernel_that_loses_digits_is_rejected():
    """Planted: Cook and Torrance's g = √(η² + c² − 1) at a small index, and an error of fifty ulps."""

    def cook_torrance(c, eta):
        g = np.sqrt(eta * eta + c * c - 1)
        return 0.5 * ((g - c) / (g + c)) ** 2 * (1 + ((c * (g + c) - 1) / (c * (g - c) + 1)) ** 2)

    def off(c, eta, k):
        return fresnel.conductor(c, eta, k) * (1 + 1e-14)

    assert worst(cook_torrance, DIELECTRIC, [(0.7, 1.5)]) <= 8
    assert worst(cook_torrance, DIELECTRIC, [(1.0, 1e-3)]) > 8
    assert worst(off, CONDUCTOR, [(0.7, 0.2, 3.0)]) > 8


def test_no_extinction_is_a_dielectric():
    c = np.array(COSINES)
    np.testing.assert_allclose(fresnel.conductor(c, 1.5, 0.0), fresnel.dielectric(c, 1.5), rtol=1e-15)


def test_total_internal_reflection_and_the_limits():
    assert fresnel.dielectric(-0.5, 1.5) == 1.0
    assert fresnel.dielectric(0.5, 1 / 1.5) == 1.0
    assert fresnel.dielectric(0.0, 1.5) == fresnel.conductor(0.0, 1.5, 2.0) == 1.0
    assert fresnel.dielectric([1.0, 0.3, 0.0], 1.0).tolist() == [0.0, 0.0, 0.0]
    assert fresnel.conductor([1.0, 0.3, 0.0], 1.0, 0.0).tolist() == [0.0, 0.0, 0.0]
    assert fresnel.schlick(0.0, 0.04) == 1.0


def test_the_two_sides_agree_along_one_ray():
    """The reflectance along a ray is the same from either side: the eta-scaled reciprocity of glass."""
    cos_i, eta = np.linspace(0.01, 1.0, 50), 1.5
    cos_t = np.sqrt(1 - (1 - cos_i**2) / eta**2)
    np.testing.assert_allclose(fresnel.dielectric(cos_i, eta), fresnel.dielectric(-cos_t, eta), rtol=1e-12)


@pytest.mark.filterwarnings("error")
def test_every_valid_input_gives_a_reflectance(rng):
    magnitude = 10.0 ** rng.uniform(-320, 308, 4000)
    c = np.concatenate([[0.0, 1.0, 5e-324, 1e-200], rng.random(3996)])
    k = np.where(rng.random(4000) < 0.5, 0.0, rng.permutation(magnitude))
    for value in (
        fresnel.dielectric(c, np.maximum(magnitude, 5e-324)),
        fresnel.dielectric(-c, np.maximum(magnitude, 5e-324)),
        fresnel.conductor(c, np.maximum(magnitude, 5e-324), k),
        fresnel.schlick(c, rng.random(4000)),
    ):
        assert np.isfinite(value).all()
        assert ((value >= 0) & (value <= 1)).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: fresnel.dielectric(2.0, 1.5),
            "cos_i = 2.0 is not allowed: it must be finite and in [-1, 1]",
        ),
        (lambda: fresnel.dielectric(0.5, 0.0), "eta = 0.0 is not allowed: it must be finite and above 0"),
        (lambda: fresnel.dielectric(0.5, np.nan), "eta = nan is not allowed: it must be finite and above 0"),
        (
            lambda: fresnel.conductor(-0.1, 1.5, 0),
            "cos_i = -0.1 is not allowed: it must be finite and in [0, 1]",
        ),
        (
            lambda: fresnel.conductor(0.5, 1.5, -1),
            "k = -1.0 is not allowed: it must be finite and at least 0",
        ),
        (
            lambda: fresnel.schlick(0.5, [0.5, 1.5]),
            "f0 = 1.5 is not allowed: it must be finite and in [0, 1]",
        ),
        (lambda: fresnel.schlick("x", 0.5), "cos_i = 'x' is not allowed: it must be finite and in [0, 1]"),
    ],
)
def test_wrong_input_is_named(call, message):
    with pytest.raises(ParameterError) as caught:
        call()
    assert str(caught.value) == message
