"""The loss that multiple scattering makes up for: its series against closed forms, 30 digits and albedos."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from radiokit.bsdfs.ggx_multiscatter import GGXMultiscatter, _loss, _table
from radiokit.contracts.albedo import albedo, directional_albedo
from radiokit.contracts.bsdf import bsdf
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.measure.twin import working_precision

MU = np.concatenate([np.geomspace(1e-12, 1.0, 200), np.linspace(0.01, 1.0, 200)])


def loss(mu, alpha):
    return _loss(np.asarray(mu), alpha, 1 / np.arcsinh(1 / alpha), *_table(alpha)[0])


def test_the_loss_at_full_width_is_the_closed_form():
    """1 − E = μ ln((1 + μ)/μ) at α = 1, and 1 − E_avg = 1 − 4/3 (1 − ln 2)."""
    np.testing.assert_allclose(loss(MU, 1.0), MU * np.log1p(1 / MU), rtol=0, atol=1e-12)
    # ∫ 2 μ² ln((1 + μ)/μ) dμ, whose complement is the white-sky albedo
    assert _table(1.0)[1] == pytest.approx(1 - 4 / 3 * (1 - np.log(2)), abs=1e-12)


@pytest.mark.parametrize("alpha", [1.0, 0.3, 0.03, 0.01])
def test_the_loss_at_normal_incidence_has_thirty_digits(alpha):
    """A facet tilted by θ mirrors the normal to 2θ: one integral, over tanθ = α s up to 45°."""
    with working_precision(30):
        a = mpmath.mpf(alpha)

        def kept(s):
            tan2 = (a * s) ** 2
            two = (1 - tan2) / (1 + tan2)  # cos 2θ
            if two <= 0:
                return mpmath.mpf(0)
            smith = (mpmath.sqrt(1 + a**2 * (1 / two**2 - 1)) - 1) / 2
            return 2 * s / (1 + s * s) ** 2 / (1 + smith)

        exact = 1 - mpmath.quad(kept, [0, 0.5, 1, *(x for x in (4, 20, 100, 500) if x < 1 / a), 1 / a])
        assert float(loss(1.0, alpha)) == pytest.approx(float(exact), abs=2e-12)


@pytest.mark.parametrize("alpha", [0.3, 0.03, 0.01])
def test_the_loss_is_what_the_albedo_of_single_scattering_leaves(alpha):
    f = bsdf("ggx", alpha=alpha)
    for theta in np.radians([20.0, 60.0, 85.0, 89.0, 89.9]):
        kept = directional_albedo(f, spherical_to_cartesian(theta, 0.3), rtol=1e-11)
        assert abs(1 - kept.value - loss(np.cos(theta), alpha)) <= kept.error + 1e-11


@pytest.mark.parametrize("alpha", [1.0, 0.1, 0.01])
def test_nothing_is_lost_in_a_white_furnace(alpha):
    f = GGXMultiscatter(alpha=alpha)
    for theta in np.radians([0.0, 45.0, 85.0, 89.9]):
        found = albedo(f, spherical_to_cartesian(theta, 0.3), rtol=1e-10)
        assert abs(found.value - 1) <= 1e-9


def test_a_loss_for_another_width_is_rejected():
    """Planted: the series of a width one in a thousand too large."""
    assert np.max(np.abs(loss(MU, 0.3) - loss(MU, 0.3003))) > 1e-5


def test_a_grey_metal_has_the_second_lobe_of_its_colour():
    """The lobe is F_ms times that of perfect mirrors, with F_avg = (20 f0 + 1)/21."""
    f0, alpha = 0.4, 0.7
    average, lost = (20 * f0 + 1) / 21, _table(alpha)[1]
    colour = average * (1 - lost) / (1 - average * lost)
    wi, wo = spherical_to_cartesian([0.2, 0.9, 1.4], 2.0), spherical_to_cartesian([1.2, 0.4, 1.0], 0.3)
    second = loss(wi[:, 2], alpha) * loss(wo[:, 2], alpha) / (np.pi * lost)
    single = bsdf("ggx", alpha=alpha)(wi, wo)
    half = np.sqrt((1 + np.sum(wi * wo, axis=1)) / 2)
    expected = (f0 + (1 - f0) * (1 - half) ** 5) * single + colour * second
    np.testing.assert_allclose(GGXMultiscatter(alpha=alpha, f0=f0)(wi, wo), expected, rtol=1e-13)
