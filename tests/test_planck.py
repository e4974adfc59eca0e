"""Planck's law at 50 digits, from the infrared's end to where nothing is left, and its integral."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
import sympy

import radiokit as rk
from radiokit.measure.twin import Twin, scaled_ulps, working_precision

LENGTH, HEAT = sympy.symbols("lambda T", positive=True)
TWIN = Twin(rk.planck.spectral_radiance_symbolic(LENGTH, HEAT), {}, (LENGTH, HEAT))
POINTS = [
    (length, heat)
    for length in (1e-3, 0.1, 380.0, 555.0, 1e4, 1e9, 1e15)
    for heat in (2.7, 300.0, 2041.4, 5772.0, 1e7, 1e12)
]


def textbook(*, wavelength_nm, temperature):
    """The planted wrong thing: exp(x) − 1, whose digits cancel where λT is large."""
    x = 14387768.775039338 / (wavelength_nm * temperature)
    return 1.1910429723971884e20 / wavelength_nm**5 / (np.exp(x) - 1)


def worst(function):
    errors = []
    for length, heat in POINTS:
        x = 14387768.775 / (length * heat)
        if x < 600:
            condition = 5 + x / -np.expm1(-x)
            found = function(wavelength_nm=length, temperature=heat)
            errors.append(scaled_ulps(found, TWIN.at(length, heat), condition))
    assert len(errors) > 30
    return max(errors)


def test_the_law_at_50_digits():
    assert worst(rk.planck.spectral_radiance) <= 2


def test_a_difference_that_cancels_is_told():
    with np.errstate(divide="ignore"):
        assert worst(textbook) > 1e3


@pytest.mark.parametrize("temperature", [2.7, 300.0, 5772.0, 1e12])
def test_all_wavelengths_together_at_50_digits(temperature):
    with working_precision(50):
        h, c, k = mpmath.mpf("6.62607015e-34"), 299_792_458, mpmath.mpf("1.380649e-23")
        exact = 2 * mpmath.pi**4 * (k * mpmath.mpf(temperature)) ** 4 / (15 * h**3 * c**2)
    assert scaled_ulps(rk.planck.radiance(temperature=temperature), exact, 4.0) <= 1


def test_the_integral_over_wavelengths_is_the_law_of_stefan_and_boltzmann():
    nm = np.geomspace(10.0, 1e12, 2001)
    found = np.trapezoid(nm * rk.planck.spectral_radiance(wavelength_nm=nm, temperature=5772.0), np.log(nm))
    assert found == pytest.approx(rk.planck.radiance(temperature=5772.0), rel=1e-12)


def test_what_is_cold_radiates_nothing():
    found = rk.planck.spectral_radiance(wavelength_nm=[500.0, 1e-3], temperature=[0.0, 1e-9])
    assert found.tolist() == [0.0, 0.0]
    assert rk.planck.radiance(temperature=0.0) == 0.0


def test_the_maximum_is_where_wien_says():
    nm = np.linspace(400.0, 600.0, 200_001)
    peak = nm[np.argmax(rk.planck.spectral_radiance(wavelength_nm=nm, temperature=5772.0))]
    assert peak * 5772.0 == pytest.approx(2.897771955e6, rel=1e-5)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"wavelength_nm": 0.0, "temperature": 300.0}, r"wavelength_nm = 0.0 .* in \[0.001, 1e\+15\]"),
        ({"wavelength_nm": "red", "temperature": 300.0}, "wavelength_nm = 'red'"),
        ({"wavelength_nm": 500.0, "temperature": -1.0}, r"temperature = -1.0 .* in \[0, 1e\+12\]"),
        ({"wavelength_nm": 500.0, "temperature": [1.0, np.nan]}, r"temperature\[1\] = nan"),
    ],
)
def test_bad_arguments_are_named(arguments, message):
    with pytest.raises(rk.errors.ParameterError, match=message):
        rk.planck.spectral_radiance(**arguments)
