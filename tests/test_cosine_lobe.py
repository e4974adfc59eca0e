"""Cosine lobes, and the directions that are made from cosine-distributed ones: density against samples."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from radiokit.facts.directions import spherical_to_cartesian, unit
from radiokit.measure.statistics import chi_square, sidak
from radiokit.measure.vectors import even, from_disk, leaning
from radiokit.physics.cosine_lobe import lobe, lobe_sample, median_angle

SAMPLES, CELLS = 1 << 15, 32
LEVEL = 1e-4  # chance that one right sampler of all is rejected
TESTS = 9


def p_value(share: np.ndarray) -> float:
    """Return the p-value of numbers that should be uniform in [0, 1]."""
    counts = np.bincount(np.minimum((share * CELLS).astype(int), CELLS - 1), minlength=CELLS)
    return float(chi_square(counts, np.full(CELLS, len(share) / CELLS)).p_value)


@pytest.mark.parametrize("exponent", [1.0, 7.5, 1e4])
def test_the_samples_of_a_lobe_follow_its_power(exponent, rng):
    axis = unit(rng.normal(size=3))
    w = np.stack(lobe_sample(*rng.random((2, SAMPLES)), *axis, exponent), axis=-1)
    np.testing.assert_allclose(np.linalg.norm(w, axis=1), 1.0, rtol=1e-14)
    inside = lobe(*w.T, *axis, exponent + 1.0)  # the share of the lobe outside α is cosⁿ⁺¹α
    assert p_value(inside) > sidak(LEVEL, TESTS)
    other = unit(np.cross(axis, [0.3, 0.5, -0.7]))
    azimuth = np.arctan2(w @ np.cross(axis, other), w @ other)
    assert p_value(azimuth / (2 * np.pi) % 1.0) > sidak(LEVEL, TESTS)
    assert np.mean(w @ axis > np.cos(median_angle(exponent))) == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("exponent", [1.0, 1e3, 1e6])
def test_a_lobe_has_all_digits_near_its_axis(exponent):
    axis = spherical_to_cartesian(0.7, 0.4)
    for angle in (0.0, 1e-9, 1e-4, 1e-3):
        w = spherical_to_cartesian(0.7 + angle, 0.4)
        with mpmath.workdps(50):
            one, other = ([mpmath.mpf(float(x)) for x in v] for v in (w, axis))
            cosine = mpmath.fdot(one, other) / mpmath.norm(one) / mpmath.norm(other)
            exact = cosine**exponent
            condition = 1 + exponent * mpmath.sqrt(1 - cosine**2)
            error = abs(mpmath.mpf(float(lobe(*w, *axis, exponent))) / exact - 1) / condition
        assert error < 8 * 2.0**-53


def test_even_and_leaning_directions_have_the_densities_they_say(rng):
    w = from_disk(*rng.random((2, SAMPLES)))
    x, y, z = even(*w)
    assert p_value(z) > sidak(LEVEL, TESTS)
    assert p_value(np.arctan2(y, x) / (2 * np.pi) % 1.0) > sidak(LEVEL, TESTS)
    wo = spherical_to_cartesian(0.9, 2.0)
    x, y, z = leaning(*w, *wo[:2])
    along = x * np.cos(2.0) + y * np.sin(2.0)
    across = y * np.cos(2.0) - x * np.sin(2.0)
    assert p_value(along**2) > sidak(LEVEL, TESTS)
    assert p_value(np.arctan2(z, across) / np.pi) > sidak(LEVEL, TESTS)
    for directions in ((x, y, z), even(*w)):
        np.testing.assert_allclose(np.linalg.norm(directions, axis=0), 1.0, rtol=1e-14)


def test_a_lobe_of_another_power_is_rejected(rng):
    """Planted: an exponent a twentieth too large, and even directions left cosine-distributed."""
    w = np.stack(lobe_sample(*rng.random((2, SAMPLES)), 0.0, 0.6, 0.8, 10.5), axis=-1)
    assert p_value(lobe(*w.T, 0.0, 0.6, 0.8, 11.0)) < sidak(LEVEL, TESTS)
    assert p_value(from_disk(*rng.random((2, SAMPLES)))[2]) < sidak(LEVEL, TESTS)
