"""Albedo of models that transmit: sides, either direction held fixed, the n² of radiance, what is refused."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import radiokit as rk
from radiokit.contracts.albedo import directional_albedo
from radiokit.contracts.bsdf import BSDF, DeltaLobe
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source


@dataclass(frozen=True, kw_only=True)
class RoughGlass(BSDF):
    """GGX facets of glass, after Walter et al. (2007), written for clarity: the test's own model."""

    SOURCE: ClassVar[Source] = Source(authors="the test", year=2007, title="Rough glass")
    transmissive: ClassVar[bool] = True

    eta: float = 1.5
    alpha: float = 0.3

    @property
    def claims(self):
        return None

    @property
    def smooth(self):
        return False

    def relative_index(self):
        return self.eta

    def lobe_width(self):
        return self.alpha

    def evaluate(self, wi, wo):
        n_i, n_o = (np.where(w[:, 2] > 0, 1.0, self.eta) for w in (wi, wo))
        reflects = (wi[:, 2] > 0) == (wo[:, 2] > 0)
        h = n_i[:, None] * wi + n_o[:, None] * wo
        length = np.linalg.norm(h, axis=1)
        h = h / np.where(length > 0, length, 1)[:, None]
        h = h * np.where(h[:, 2] < 0, -1, 1)[:, None]
        i_h, o_h = np.sum(wi * h, axis=1), np.sum(wo * h, axis=1)
        right_side = (i_h * wi[:, 2] > 0) & (o_h * wo[:, 2] > 0)
        tail = h[:, 0] ** 2 + h[:, 1] ** 2 + (self.alpha * h[:, 2]) ** 2
        d = self.alpha**2 / (np.pi * tail**2)
        g = 1.0
        for w in (wi, wo):
            cosine = np.abs(w[:, 2])
            g = g * 2 * cosine / (cosine + np.sqrt(cosine**2 + self.alpha**2 * (1 - cosine**2)))
        c = np.abs(i_h)
        square = np.where(wi[:, 2] > 0, self.eta, 1 / self.eta) ** 2 - 1 + c * c
        bent = np.sqrt(np.maximum(square, 0))
        ratio2 = square + 1 - c * c
        s, p = (c - bent) / (c + bent), (ratio2 * c - bent) / (ratio2 * c + bent)
        fresnel = np.where(square > 0, (s * s + p * p) / 2, 1.0)
        both = np.abs(wi[:, 2] * wo[:, 2])
        reflected = fresnel * d * g / (4 * both)
        # Walter's eq. (21), with n_o the index on wo's side.
        under = np.maximum((n_i * i_h + n_o * o_h) ** 2, 1e-300)
        passed = np.abs(i_h * o_h) / both * n_o**2 * (1 - fresnel) * d * g / under
        return np.where(right_side, np.where(reflects, reflected, passed), 0.0)

    def pdf(self, wi, wo):
        return np.abs(wi[:, 2]) / (2 * np.pi)

    def sample(self, u, wo):
        radius, phi = np.sqrt(np.abs(2 * u[:, 0] - 1)), 2 * np.pi * u[:, 1]
        up = np.sqrt(1 - radius**2) * np.where(u[:, 0] > 0.5, 1, -1)
        wi = np.stack([radius * np.cos(phi), radius * np.sin(phi), up], axis=-1)
        return wi, 2 * np.pi * self.evaluate(wi, wo)

    def symbolic(self):
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class Paper(RoughGlass):
    """A diffuse sheet that also lets a tenth straight through."""

    eta: float = 1.0

    def lobe_width(self):
        return 1.0

    def evaluate(self, wi, wo):
        return np.where(wi[:, 2] * wo[:, 2] > 0, 0.5, 0.3) / np.pi

    def delta_lobes(self, wo):
        return (DeltaLobe(-wo, np.full(len(wo), 0.1)),)


def toward(theta_deg):
    return spherical_to_cartesian(np.deg2rad(theta_deg), 0.4)


@pytest.mark.parametrize("theta", [0.0, 50.0, 89.0, 91.0, 120.0, 150.0, 180.0])
def test_the_sides_of_a_sheet_are_counted_apart(theta):
    wo = toward(theta)
    for fixed in ("wo", "wi"):
        parts = [
            rk.albedo(Paper(), wo, fixed=fixed, side=side) for side in ("reflected", "transmitted", "both")
        ]
        for found, exact in zip(parts, (0.5, 0.4, 0.9), strict=True):
            assert found.converged
            assert abs(found.value - exact) <= found.error <= 1e-8


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5])
@pytest.mark.parametrize("theta", [0.0, 30.0, 60.0, 85.0, 120.0, 150.0])
def test_glass_scatters_less_than_it_gets_and_the_sides_add_up(theta, eta):
    model, wo = RoughGlass(eta=eta), toward(theta)
    reflected, transmitted, both = (
        directional_albedo(model, wo, side=side, rtol=1e-4, max_evaluations=200_000)
        for side in ("reflected", "transmitted", "both")
    )
    assert abs(reflected.value + transmitted.value - both.value) <= (
        reflected.error + transmitted.error + both.error
    )
    assert both.value - both.error < 1
    assert both.value > (0.85 if theta in (0.0, 30.0, 150.0) else 0.2)


@pytest.mark.parametrize("theta", [20.0, 70.0, 130.0])
def test_light_sent_back_along_either_direction_loses_the_same(theta):
    model, w = RoughGlass(eta=1.5), toward(theta)
    one, two = (rk.albedo(model, w, fixed=fixed, rtol=1e-4) for fixed in ("wo", "wi"))
    assert abs(one.value - two.value) <= one.error + two.error
    # The planted failure: without n(wi)²/n(wo)² the transmitted part is off by η².
    raw = directional_albedo(RoughGlass(eta=1.5), w, side="transmitted", rtol=1e-4)
    index2 = 1.5 ** (2 if theta < 90 else -2)
    assert abs(raw.value / index2 - raw.value) > 100 * raw.error


@pytest.mark.parametrize("method", ["mc", "qmc"])
@pytest.mark.parametrize("side", ["reflected", "transmitted", "both"])
@pytest.mark.parametrize("theta", [40.0, 150.0])
def test_monte_carlo_counts_the_same_flux(method, side, theta, seed):
    model, wo = RoughGlass(eta=1.5, alpha=0.5), toward(theta)
    exact = directional_albedo(model, wo, side=side, rtol=1e-4)
    found = rk.albedo(model, wo, method=method, side=side, samples=1 << 16, rng=seed)
    assert abs(found.value - exact.value) < 5 * found.error + exact.error


def test_an_opaque_model_transmits_nothing_and_is_not_seen_from_below():
    f = rk.bsdf("lambert", reflectance=0.5)
    nothing = rk.albedo(f, (0.0, 0.0, 1.0), side="transmitted")
    assert nothing.value == 0
    assert rk.albedo(f, (0.0, 0.0, 1.0), side="reflected").value == pytest.approx(0.5)
    with pytest.raises(ParameterError, match="above the horizon"):
        rk.albedo(f, (0.0, 0.0, -1.0))
    with pytest.raises(ParameterError, match="off the surface"):
        rk.albedo(Paper(), (1.0, 0.0, 0.0))
    with pytest.raises(ParameterError, match="'both', 'reflected' or 'transmitted'"):
        rk.albedo(f, (0.0, 0.0, 1.0), side="up")
