"""Fresnel's reflectances against the complex amplitudes at 50 digits, at inputs that are hard."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import sympy

from radiokit.facts.errors import ParameterError
from radiokit.measure.passes import run
from radiokit.measure.twin import Twin, scaled_ulps
from radiokit.physics import fresnel, metals

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


def complement(twin):
    return Twin(1 - twin.expression, {}, twin.arguments)


SINE2 = (1 - C**2) * sympy.Piecewise((ETA**2, C < 0), (ETA**-2, True))
TRANSMITTED = Twin(sympy.sqrt(sympy.Max(0, 1 - SINE2)), {}, (C, ETA))


@pytest.mark.parametrize("eta", INDICES)
def test_what_a_dielectric_transmits_keeps_its_digits(eta):
    cosines = [*COSINES, *near_critical(eta), *brewster(eta)]
    cosines = [c for c in (*cosines, *(-c for c in COSINES)) if abs(c) <= 1]
    inputs = [(c, eta) for c in cosines if fresnel.transmitted_cosine_kernel(c, eta) > 0]
    assert worst(fresnel.dielectric_complement_kernel, complement(DIELECTRIC), inputs) <= 8
    assert worst(fresnel.transmitted_cosine_kernel, TRANSMITTED, inputs) <= 8
    hidden = [(c, eta) for c in cosines if fresnel.transmitted_cosine_kernel(c, eta) == 0]
    assert all(fresnel.dielectric_complement_kernel(*x) == 0 for x in hidden)


@pytest.mark.parametrize("k", [0.0, 1e-9, 0.5, 3.9, 1e6])
def test_what_a_conductor_absorbs_keeps_its_digits(k):
    inputs = [(c, eta, k) for eta, c in itertools.product((0.05, 0.2, 1.5, 1 + 1e-12, 1e-6, 1e6), COSINES)]
    assert worst(fresnel.conductor_complement_kernel, complement(CONDUCTOR), inputs) <= 8


def test_schlicks_complement_keeps_its_digits():
    inputs = list(itertools.product(COSINES, (0.0, 1e-9, 0.04, 0.9)))
    assert worst(fresnel.schlick_complement_kernel, complement(SCHLICK), inputs) <= 8


def test_one_less_the_reflectance_is_rejected():
    """Planted: the difference, at a grazing angle and for a good metal."""

    def difference(c, eta):
        return 1.0 - fresnel.dielectric(c, eta)

    def absorbed(c, eta, k):
        return 1.0 - fresnel.conductor(c, eta, k)

    assert worst(difference, complement(DIELECTRIC), [(1e-12, 1.5)]) > 8
    assert worst(absorbed, complement(CONDUCTOR), [(1.0, 1e-6, 100.0)]) > 8


KERNELS = (
    (fresnel.dielectric_kernel, 1),
    (fresnel.dielectric_complement_kernel, 1),
    (fresnel.transmitted_cosine_kernel, 1),
    (fresnel.conductor_kernel, 2),
    (fresnel.conductor_complement_kernel, 2),
    (fresnel.schlick_kernel, 0),
    (fresnel.schlick_complement_kernel, 0),
)


@pytest.mark.parametrize(("function", "constants"), KERNELS, ids=lambda x: getattr(x, "__name__", None))
def test_both_forms_of_a_kernel_agree(function, constants, rng):
    """And the plain form takes spectra: constants (K,) for cosines (N, 1)."""
    if constants == 0:
        c, rest = np.concatenate([COSINES, rng.random(99)]), (rng.random(1)[0],)
    else:
        sign = -1.0 if constants == 1 else 1.0
        c = np.concatenate([COSINES, np.multiply(sign, COSINES), rng.random(99)])
        rest = (1.5, 3.9)[:constants]
    plain, compiled = function(c, *rest), run(function, (c,), rest, compiled=True)
    np.testing.assert_array_max_ulp(plain, compiled, 8)
    spectrum = function(c[:, None], *(np.full(4, value) for value in rest))
    np.testing.assert_array_equal(spectrum, np.repeat(plain[:, None], 4, axis=1))


def test_measured_metals_look_as_they_do():
    wavelengths = [450.0, 550.0, 650.0]
    for symbol in metals.METALS:
        eta, k = fresnel.metal(symbol, np.linspace(380, 780, 101))
        assert eta.shape == k.shape == (101,)
        assert (eta > 0).all()
        assert (k > 1).all()
        assert metals.metal_source(symbol).doi
    gold, copper, silver, aluminium = (
        fresnel.conductor(1.0, *fresnel.metal(symbol, wavelengths)) for symbol in ("Au", "Cu", "Ag", "Al")
    )
    assert gold[0] < 0.45 < 0.75 < gold[1] < gold[2]
    assert copper[0] < copper[1] < 0.7 < 0.9 < copper[2]
    assert (silver > 0.95).all()
    assert (np.abs(aluminium - 0.915) < 0.015).all()
    assert fresnel.metal("Ag", 381.5) == (0.05, 1.864)  # a line of the table
    assert fresnel.metal("Au", 520.9) == (0.62, 2.081)
    halfway = 0.5 * (413.28 + 442.8)
    np.testing.assert_allclose(fresnel.metal("Al", halfway), (0.564625, 5.1842), rtol=1e-14)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: fresnel.metal("Fe", 500.0),
            "symbol = 'Fe' is not allowed: it must be one of Ag, Al, Au, Cu",
        ),
        (
            lambda: fresnel.metal("Au", [500.0, 379.9]),
            "wavelength_nm = 379.9 is not allowed: it must be finite and in [380, 780] nm",
        ),
        (
            lambda: fresnel.metal("Au", float("nan")),
            "wavelength_nm = nan is not allowed: it must be finite and in [380, 780] nm",
        ),
    ],
)
def test_what_was_not_measured_is_named(call, message):
    with pytest.raises(ParameterError) as caught:
        call()
    assert str(caught.value) == message


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
