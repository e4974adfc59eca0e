"""The microfacet judge rejects planted wrong facets, and accepts hard legal ones."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.special import erf

from radiokit.bsdfs.lambert import Lambert
from radiokit.checks.facets import projected_area, white_furnace
from radiokit.checks.judge import check
from radiokit.checks.microfacet import COVER, microfacet
from radiokit.checks.probes import polar
from radiokit.contracts.microfacet import Microfacets
from radiokit.facts.directions import half_vector
from radiokit.facts.verdict import Outcome
from radiokit.measure.quadrature import hemisphere


def tan2(w, ax, ay):
    """α² tan²θ, in the direction of w."""
    return ((ax * w[:, 0]) ** 2 + (ay * w[:, 1]) ** 2) / w[:, 2] ** 2


def ggx_density(ax, ay):
    def density(h):
        stretched = (h[:, 0] / ax) ** 2 + (h[:, 1] / ay) ** 2 + h[:, 2] ** 2
        return 1 / (np.pi * ax * ay * stretched**2)

    return density


def ggx_lambda(ax, ay):
    return lambda w: (np.sqrt(1 + tan2(w, ax, ay)) - 1) / 2


def beckmann_density(alpha):
    def density(h):
        c2 = h[:, 2] ** 2
        return np.exp(-(1 - c2) / (c2 * alpha**2)) / (np.pi * alpha**2 * c2 * c2)

    return density


def beckmann_lambda(alpha):
    def smith(w):
        a = 1 / np.sqrt(tan2(w, alpha, alpha) + 1e-300)
        return (erf(a) - 1) / 2 + np.exp(-a * a) / (2 * a * np.sqrt(np.pi))

    return smith


def smith_masking(smith):
    return lambda w, h: 1 / (1 + smith(w))


def correlated(smith):
    return lambda wi, wo, h: 1 / (1 + smith(wi) + smith(wo))


def uncorrelated(smith):
    return lambda wi, wo, h: 1 / ((1 + smith(wi)) * (1 + smith(wo)))


def groove(w, h):
    return np.minimum(1, 2 * h[:, 2] * w[:, 2] / np.sum(w * h, axis=1))


@dataclass(frozen=True)
class Facets:
    density: Any
    masking: Any
    shadowing: Any


def smith_facets(density, smith, shadowing=correlated):
    return Facets(density, smith_masking(smith), shadowing(smith))


def ggx(ax, ay=None, **kwargs):
    ay = ax if ay is None else ay
    return smith_facets(ggx_density(ax, ay), ggx_lambda(ax, ay), **kwargs)


def v_groove(density):
    return Facets(density, groove, lambda wi, wo, h: np.minimum(groove(wi, h), groove(wo, h)))


LEGAL = {
    "ggx 1e-3": ggx(1e-3),
    "ggx 0.3": ggx(0.3),
    "ggx 0.3, uncorrelated": ggx(0.3, shadowing=uncorrelated),
    "ggx 1": ggx(1.0),
    "ggx 0.1 x 0.5": ggx(0.1, 0.5),
    "beckmann 0.02": smith_facets(beckmann_density(0.02), beckmann_lambda(0.02)),
    "beckmann 0.5": smith_facets(beckmann_density(0.5), beckmann_lambda(0.5)),
    "v-groove of ggx 0.3": v_groove(ggx_density(0.3, 0.3)),
    "v-groove of ggx 1": v_groove(ggx_density(1.0, 1.0)),
    "v-groove of beckmann 0.1": v_groove(beckmann_density(0.1)),
}


@pytest.mark.parametrize("facets", LEGAL.values(), ids=LEGAL)
def test_hard_legal_facets_are_accepted(facets):
    assert isinstance(facets, Microfacets)
    verdict = microfacet(facets)
    assert verdict.ok, verdict
    assert len(verdict.details["rows"]) == 19
    json.dumps(verdict.to_json())


def scaled(facets, factor):
    return Facets(lambda h: factor * facets.density(h), facets.masking, facets.shadowing)


GOOD = ggx(0.3)
SMITH = ggx_lambda(0.3, 0.3)
WRONG = {
    "D without 1/cos⁴": (
        smith_facets(lambda h: ggx_density(0.3, 0.3)(h) * h[:, 2] ** 4, SMITH),
        COVER,
    ),
    "D 1 % too large": (scaled(GOOD, 1.01), f"{COVER} is 1.01"),
    "D 1e-6 too small": (scaled(GOOD, 1 - 1e-6), COVER),
    "D not a number": (scaled(GOOD, np.nan), "D is negative or not finite"),
    "D negative": (scaled(GOOD, -1.0), "D is negative or not finite"),
    "G₁ above 1": (
        Facets(GOOD.density, lambda w, h: 1.01 * GOOD.masking(w, h), GOOD.shadowing),
        "G₁ is not in [0, 1]",
    ),
    "no masking at all": (Facets(GOOD.density, lambda w, h: np.ones(len(h)), GOOD.shadowing), "(wo·h)⁺ D dω"),
    "Λ of another α": (smith_facets(ggx_density(0.3, 0.3), ggx_lambda(0.31, 0.31)), "(wo·h)⁺ D dω"),
    "Λ of Beckmann": (smith_facets(ggx_density(0.3, 0.3), beckmann_lambda(0.3)), "(wo·h)⁺ D dω"),
    "α exchanged": (smith_facets(ggx_density(0.1, 0.5), ggx_lambda(0.5, 0.1)), "(wo·h)⁺ D dω"),
    "G₂ the geometric mean": (
        Facets(
            GOOD.density,
            GOOD.masking,
            lambda wi, wo, h: np.sqrt(GOOD.masking(wi, h) * GOOD.masking(wo, h)),
        ),
        "G₂ is above the smaller G₁",
    ),
    "G₂ of wi alone": (
        Facets(
            GOOD.density,
            GOOD.masking,
            lambda wi, wo, h: GOOD.masking(wi, h) * GOOD.masking(wo, h) ** 2,
        ),
        "exchanged",
    ),
    "G₂ negative": (Facets(GOOD.density, GOOD.masking, lambda wi, wo, h: -0.1 * wi[:, 2]), "G₂ is negative"),
}


@pytest.mark.parametrize(("facets", "says"), WRONG.values(), ids=WRONG)
def test_planted_wrong_facets_are_rejected(facets, says):
    verdict = microfacet(facets)
    assert verdict.outcome is Outcome.VIOLATED
    assert says in verdict.message
    assert verdict.witness is not None


def test_an_integral_that_is_not_known_is_no_pass():
    def spiked(h):  # a thousandth of a radian wide ring that nothing told of
        return GOOD.density(h) + 40.0 * (np.abs(h[:, 2] - 0.3) < 1e-4)

    assert not microfacet(Facets(spiked, GOOD.masking, GOOD.shadowing)).ok


@pytest.mark.parametrize("theta", [0.0, 50.0, 89.0])
def test_the_white_furnace_is_cut_at_the_horizon_of_wi(theta):
    """What leaves above the horizon, integrated over h, is what is integrated over wi itself."""
    wo = polar(np.cos(np.deg2rad([theta])), [2.0])[0]

    def reflected(wi):
        held = np.broadcast_to(wo, wi.shape)
        h = half_vector(wi, held)
        return GOOD.density(h) * GOOD.masking(held, h) / (4 * wo[2])

    above, below = white_furnace(GOOD, wo, width=0.3)
    exact = hemisphere(reflected, wo=wo, width=0.3, rtol=1e-9)
    assert abs(above.value - exact.value) <= above.error + exact.error <= 1e-8
    assert below.value > 0


@pytest.mark.parametrize("alpha", [0.05, 1.0])
def test_without_masking_more_is_seen_than_there_is(alpha):
    """∫ (wo·h)⁺ D dω / cosθo = 1 + Λ(wo) by the definition of Smith's Λ."""
    facets = ggx(alpha)
    bare = Facets(facets.density, lambda w, h: np.ones(len(h)), facets.shadowing)
    for theta in (20.0, 75.0, 89.9):
        wo = polar(np.cos(np.deg2rad([theta])), [2.0])
        exact = 1 + ggx_lambda(alpha, alpha)(wo)[0]
        area = projected_area(bare, wo[0], width=alpha)
        assert abs(area.value - exact) <= area.error <= 1e-6 * exact
        above, below = white_furnace(bare, wo[0], width=alpha)
        assert abs(above.value + below.value - exact) <= above.error + below.error <= 1e-6 * exact


class Rough(Lambert):
    """A model that says what its facets are."""

    name = ""

    def microfacets(self):
        return ggx(0.2)


class Rougher(Lambert):
    """A model whose facets are not those of a surface."""

    name = ""

    def microfacets(self):
        return scaled(ggx(0.2), 1.01)


def test_check_judges_facets_only_where_there_are_some():
    seen = []
    report = check(Rough(), laws=["values", "microfacet"], progress=lambda *step: seen.append(step))
    assert [verdict.check for verdict in report] == ["values", "microfacet"]
    assert report["microfacet"].ok
    assert seen == [(0, 2), (1, 2)]
    assert not check(Rougher(), laws=["microfacet"]).ok
    assert [verdict.check for verdict in check(Lambert(), laws=["values", "microfacet"])] == ["values"]
