"""Photometry: lumens for a watt, against 50 digits and what the standards say."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise

import mpmath
import numpy as np
import pytest

import radiokit as rk
from radiokit.facts.errors import NonFiniteError, ParameterError
from radiokit.physics import photometry
from radiokit.physics.planck import spectral_radiance


def efficacy(wavelength, spectrum, **options):
    return photometry.luminous_efficacy(wavelength_nm=wavelength, spectrum=spectrum, **options)


VISIONS = ("photopic", "scotopic")


def linear(x, nodes, values):
    """The broken line through nodes, exactly; 0 beyond them."""
    if not nodes[0] <= x <= nodes[-1]:
        return mpmath.mpf(0)
    at = min(int(np.searchsorted(nodes, float(x), side="right")) - 1, len(nodes) - 2)
    low, high = (mpmath.mpf(float(nodes[at + k])) for k in (0, 1))
    first, second = (mpmath.mpf(float(values[at + k])) for k in (0, 1))
    return first + (second - first) * (x - low) / (high - low)


def twin(wavelength, spectrum, vision):
    """K by Simpson's rule on each piece, where it is exact, at 50 digits."""
    with mpmath.workdps(50):
        table = np.arange(360.0, 831.0) if vision == "photopic" else np.arange(380.0, 781.0)
        seen = photometry.luminous_efficiency(wavelength_nm=table, vision=vision)
        nodes = sorted({mpmath.mpf(float(w)) for w in (*wavelength, *table)})
        above = whole = mpmath.mpf(0)
        for low, high in pairwise(w for w in nodes if wavelength[0] <= w <= wavelength[-1]):
            places = (low, (low + high) / 2, high)
            light = [linear(w, wavelength, spectrum) for w in places]
            inside = table[0] <= low and high <= table[-1]
            eye = [linear(w, table, seen) if inside else mpmath.mpf(0) for w in places]
            for factor, a, b in zip((1, 4, 1), light, eye, strict=True):
                above += (high - low) / 6 * factor * a * b
                whole += (high - low) / 6 * factor * a
        return 683 / linear(mpmath.mpf(555.017), table, seen) * above / whole


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize(
    "make",
    [
        lambda rng: (np.sort(rng.uniform(300, 900, 40)), rng.random(40)),
        lambda rng: (np.sort(rng.uniform(300, 900, 40)), 10.0 ** rng.uniform(-300, 300, 40)),
        lambda rng: (np.array([1.0, 1e6]), np.array([1.0, 1e-9])),
        lambda rng: (np.nextafter(555.0, [0, 1e9]), np.array([1.0, 0.0])),
        lambda rng: (np.array([829.5, 830.5]), np.array([0.0, 1.0])),
        lambda rng: (np.array([500.0, 500.25, 500.75]), np.array([0.0, 1.0, 0.0])),
        lambda rng: (np.array([380.0, 780.0]), np.array([5e-324, 0.0])),
    ],
    ids=["ordinary", "600 decades", "far infrared", "one line", "the end", "narrow", "tiny"],
)
def test_the_efficacy_is_its_integral(make, vision, rng):
    wavelength, spectrum = make(rng)
    found, exact = (
        efficacy(wavelength, spectrum, vision=vision),
        twin(wavelength, spectrum, vision),
    )
    assert abs(mpmath.mpf(found) - exact) <= 16 * 2.0**-53 * exact


def test_what_the_standards_say():
    assert efficacy([554.9999, 555.0001], [1, 1]) == pytest.approx(683.002, abs=1e-3)
    assert efficacy([506.9999, 507.0001], [1, 1], vision="scotopic") == pytest.approx(1700.13, abs=0.01)
    wavelength = np.arange(200.0, 100_000.0, 1.0)
    radiance = spectral_radiance(
        wavelength_nm=wavelength, temperature=2041.4
    )  # of platinum as it freezes: 60 cd/cm² were the standard once
    assert efficacy(wavelength, radiance) * np.trapezoid(radiance, wavelength) * 1e-4 == pytest.approx(
        60, rel=0.01
    )


def test_spectra_in_rows_and_what_is_beyond_sight():
    wavelength = np.array([400.0, 500.0, 600.0, 700.0])
    rows = np.array([[1.0, 0, 0, 0], [0, 1, 1, 0], [1, 1, 1, 1]])
    found = efficacy(wavelength, rows)
    assert found.shape == (3,)
    alone = [efficacy(wavelength, row) for row in rows]
    np.testing.assert_allclose(found, alone, rtol=1e-15)
    assert efficacy([900.0, 1000.0], [1.0, 1.0]) == 0
    assert photometry.luminous_efficiency(wavelength_nm=[[300.0, 900.0]]).tolist() == [[0, 0]]


def test_watts_become_lumens():
    found = efficacy([380.0, 780.0], [1.0, 1.0])
    lux = rk.relate("illuminance", irradiance="2 W/m^2", luminous_efficacy=f"{found!r} lm/W")
    assert float(lux.value.magnitude) == pytest.approx(2 * found, rel=1e-12)


def test_a_planted_observer_is_rejected(monkeypatch, rng):
    table, values = photometry._table("photopic")
    wavelength, spectrum = np.sort(rng.uniform(400, 700, 20)), rng.random(20)
    exact = twin(wavelength, spectrum, "photopic")
    monkeypatch.setattr(photometry, "_table", lambda vision: (table + 1e-6, values))
    found = efficacy(wavelength, spectrum)
    assert abs(mpmath.mpf(found) - exact) > 16 * 2.0**-53 * exact


@pytest.mark.parametrize(
    ("wavelength", "spectrum", "message"),
    [
        ([500.0], [1.0], "wavelength_nm = .500.0. is not allowed: it must be of shape .M,., M at least 2"),
        ([500.0, 400.0], [1.0, 1.0], "increasing"),
        (
            [0.0, 400.0],
            [1.0, 1.0],
            "wavelength_nm.0. = 0.0 is not allowed: it must be finite and above 0",
        ),
        ([400.0, np.nan], [1.0, 1.0], "finite and above 0"),
        (
            [400.0, 500.0],
            [1.0, 1.0, 1.0],
            r"spectrum = \(3,\) is not allowed: it must be of shape \(..., 2\)",
        ),
        ([400.0, 500.0], 1.0, r"spectrum = \(\) is not allowed"),
        (
            [400.0, 500.0],
            [1.0, -1.0],
            "spectrum = .1.0, -1.0. is not allowed: it must be at least 0, and not all 0",
        ),
        ([400.0, 500.0], [0.0, 0.0], "not all 0"),
    ],
)
def test_what_is_no_spectrum(wavelength, spectrum, message):
    with pytest.raises(ParameterError, match=message):
        efficacy(wavelength, spectrum)


def test_other_mistakes():
    with pytest.raises(NonFiniteError, match="spectrum has NaN or infinity"):
        efficacy([400.0, 500.0], [1.0, np.inf])
    with pytest.raises(
        ParameterError, match="vision = 'mesopic' is not allowed: it must be 'photopic' or 'scotopic'"
    ):
        photometry.luminous_efficiency(wavelength_nm=555.0, vision="mesopic")
    with pytest.raises(ParameterError, match=r"wavelength_nm = -1\.0 is not allowed"):
        photometry.luminous_efficiency(wavelength_nm=-1.0)


def test_arrays_are_printed_as_before():
    code = (
        "import numpy as np; np.set_printoptions(precision=3); before = np.get_printoptions();"
        "from radiokit.physics import photometry; photometry.luminous_efficiency(wavelength_nm=555.0);"
        "assert np.get_printoptions() == before"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)
