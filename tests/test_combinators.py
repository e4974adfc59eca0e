"""Mixtures, scaled, clamped and coated BSDFs: their values, samplers, claims, and planted wrong ones."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from radiokit.checks.claims import claims
from radiokit.checks.energy import energy
from radiokit.checks.judge import check
from radiokit.checks.reciprocity import reciprocity
from radiokit.checks.sampling import sampling
from radiokit.contracts.albedo import albedo, directional_albedo
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import Claims, bsdf
from radiokit.contracts.clamped import clamped
from radiokit.contracts.coatalbedo import coat_albedo
from radiokit.contracts.coated import Coated, coated
from radiokit.contracts.mixture import Mixture, mixture, scaled
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.report import schema
from radiokit.measure.proof import proved_zero
from radiokit.measure.twin import scaled_ulps

WHITE, MIRROR, GLASS = bsdf("lambert"), bsdf("mirror"), bsdf("dielectric")
SLAB, SHARP, ROUGH = bsdf("thin_slab"), bsdf("ggx", alpha=0.05), bsdf("ggx", alpha=0.3)
SATIN = bsdf("ggx", alpha=0.3, eta=1.5, k=0.0)
FLAG = spherical_to_cartesian(np.radians(60.0), 0.4)
ROOM = {"samples": 1 << 13, "tests": 40}
BUDGET = 600_000


def plain(wi, wo):
    return np.full(len(wi), 0.3)


COMBINED = {
    "diffuse and glossy": 0.5 * WHITE + 0.5 * ROUGH,
    "wide and narrow": 0.9 * WHITE + 0.1 * SHARP,
    "diffuse and mirror": mixture([(0.3, WHITE), (0.7, MIRROR)]),
    "diffuse and glass": mixture([(0.4, WHITE), (0.6, GLASS)]),
    "two panes": mixture([(0.25, SLAB), (0.75, bsdf("thin_slab", eta=1.2))]),
    "nested": mixture([(0.2, WHITE), (0.8, Mixture(weights=(0.5, 0.5), components=(MIRROR, WHITE)))]),
    "unknown": mixture([(0.5, plain), (0.5, ROUGH)]),
    "scaled": scaled(ROUGH, factor=0.5),
    "clamped": clamped(ROUGH, maximum=0.5),
    "varnish": coated(WHITE, coat=GLASS),
    "satin": coated(0.5 * WHITE, coat=SATIN),
    "varnished metal": coated(ROUGH, coat=GLASS),
    "varnished mirror": coated(MIRROR, coat=GLASS),
    "spectral": mixture([([0.1, 0.4], WHITE), (0.5, bsdf("lambert", reflectance=[0.5, 0.2]))]),
}
named = pytest.mark.parametrize("f", COMBINED.values(), ids=COMBINED)


def pairs(rng, count=200):
    w = rng.normal(size=(2, count, 3))
    return w / np.linalg.norm(w, axis=-1, keepdims=True)


# Before the judges


@named
def test_every_combination_obeys_what_it_claims(f):
    said = f.claims
    if said is None:
        assert f is COMBINED["unknown"]
        return
    assert reciprocity(f, count=1 << 10, refine=0).ok
    found = energy(f, budget=BUDGET, reciprocal=True)
    assert found.ok == said.conserves, found
    assert found.details["lossless"] == said.lossless, found


@named
def test_every_combination_samples_what_it_says(f, seed):
    found = sampling(f, seed=seed, **ROOM)
    assert found.ok, found


@named
def test_every_combination_survives_what_models_survive(f, rng):
    edge = np.array([[1.0, 0, 0], [-1, 0, 0], [1, 0, 5e-324], [0, 0, 1], [0, 0, -1]])
    wi, wo = (np.concatenate([e, p]) for e, p in zip((edge, edge[::-1]), pairs(rng), strict=True))
    with np.errstate(all="raise", under="ignore"):
        value, density = np.asarray(f.evaluate(wi, wo)), f.pdf(wi, wo)
        _, weight = f.sample(rng.random((len(wo), f.dimensions)), wo)
    assert value.shape == weight.shape
    assert all(np.isfinite(found).all() and (found >= 0).all() for found in (value, density, weight))
    dark = (wi[:, 2] <= 0) | (wo[:, 2] <= 0)
    if not f.transmissive and f is not COMBINED["clamped"]:
        assert not value[dark].any()
    json.dumps(check(f, laws=["values"]).to_json(), allow_nan=False)
    if f is not COMBINED["unknown"]:
        assert pickle.loads(pickle.dumps(f)) == f
    again = replace(f)
    assert again == f
    assert repr(again) == repr(f)


def test_a_report_on_a_combination_follows_the_schema():
    import jsonschema

    report = check(COMBINED["varnish"], laws=["values"]).to_json()
    jsonschema.validate(report, schema())
    assert report["parameters"]["coat"] == {"model": "dielectric", "parameters": {"eta": 1.5}}
    assert report["subject"] == "coated"


# Planted


class Forgetful(Mixture):
    """Adds its components up without their weights."""

    def _sum(self, values, wi, wo):
        return sum(values, start=np.zeros(len(wi)))


class Blind(Mixture):
    """Forgets the other components' density, and so counts twice what two of them can sample."""

    def pdf(self, wi, wo):
        return self._chances(wo)[:, 0] * self.components[0].pdf(wi, wo)


class Careless(Mixture):
    """Picks a component by its weight and takes the component's own weight for the sample's."""

    def sample(self, u, wo):
        wi, _ = super().sample(u, wo)
        return wi, np.ones(len(wi))


class Greedy(Coated):
    """Lets the whole base through."""

    def _let_in(self, wi, wo):
        return np.ones(len(wi))


class OneWay(Coated):
    """Dims the base by what the coat reflects of wi alone."""

    def _let_in(self, wi, wo):
        return 1 - self.albedo(wi)


def test_planted_wrong_combinations_are_rejected():
    parts = {"weights": (0.5, 0.5), "components": (WHITE, ROUGH)}
    assert not energy(Forgetful(**parts), budget=BUDGET, reciprocal=True).ok
    assert not sampling(Blind(**parts), **ROOM, seed=1).ok
    assert not sampling(Careless(**parts), **ROOM, seed=1).ok
    greedy = Greedy(base=WHITE, coat=GLASS, scaling="product")
    assert not energy(greedy, budget=BUDGET, reciprocal=True).ok
    assert claims(greedy, check(greedy, laws=["reciprocity", "energy"])).outcome == "violated"
    assert not reciprocity(OneWay(base=WHITE, coat=GLASS, scaling="product"), count=1 << 10).ok


def test_kelemens_coat_gains_over_a_mirror_as_its_docstring_says():
    f = coated(MIRROR, coat=GLASS, scaling="product")
    gain = float(albedo(f, (0.0, 0.0, 1.0)))
    assert gain == pytest.approx(0.96**2 / (1 - float(f.albedo.average)) + 0.04, abs=1e-12)
    assert gain == pytest.approx(1.0547, abs=5e-5)
    assert f.claims is None


# What is known


def test_a_mixture_is_the_sum(rng):
    wi, wo = pairs(rng)
    wi[:, 2], wo[:, 2] = np.abs(wi[:, 2]), np.abs(wo[:, 2])
    f = mixture([(0.25, WHITE), (0.5, ROUGH)])
    np.testing.assert_allclose(f.evaluate(wi, wo), 0.25 / np.pi + 0.5 * ROUGH.evaluate(wi, wo), rtol=1e-15)
    np.testing.assert_allclose(f.pdf(wi, wo), (WHITE.pdf(wi, wo) + 2 * ROUGH.pdf(wi, wo)) / 3, rtol=1e-15)
    total = float(directional_albedo(f, FLAG))
    assert total == pytest.approx(0.25 + 0.5 * float(directional_albedo(ROUGH, FLAG)), rel=1e-8)
    assert f.dimensions == 3


def test_what_is_diffuse_stays_diffuse():
    f = 0.25 * WHITE + 0.5 * bsdf("lambert", reflectance=[0.5, 1.0])
    assert f.diffuse_reflectance().tolist() == [0.5, 0.75]
    assert (0.25 * WHITE).diffuse_reflectance() == 0.25
    assert (WHITE + ROUGH).diffuse_reflectance() is None
    assert clamped(WHITE, maximum=0.1).diffuse_reflectance() == pytest.approx(0.1 * np.pi)


def test_operators_are_the_functions():
    assert mixture([(0.3, WHITE), (0.7, ROUGH)]) == 0.3 * WHITE + 0.7 * ROUGH
    assert {np.float64(0.5) * WHITE, WHITE * 0.5} == {scaled(WHITE, factor=0.5)}
    assert scaled(WHITE, factor=[0.5, 0.2]) == np.array([0.5, 0.2]) * WHITE
    assert 0.5 * (0.4 * WHITE + ROUGH) == 0.2 * WHITE + 0.5 * ROUGH
    assert sum([WHITE, ROUGH]) == WHITE + ROUGH
    assert mixture(weights=[0.3, 0.7], components=[WHITE, ROUGH]) == 0.3 * WHITE + 0.7 * ROUGH
    assert repr(0.5 * WHITE + 0.5 * MIRROR) == "0.5*Lambert(reflectance=1.0) + 0.5*Mirror(reflectance=1.0)"
    with pytest.raises(TypeError):
        WHITE * ROUGH
    with pytest.raises(TypeError):
        WHITE + 1


def test_mixtures_of_spectra_are_their_wavelengths(rng):
    f = COMBINED["spectral"]
    wi, wo = pairs(rng)
    u = rng.random((len(wo), f.dimensions))
    values, (_, weights) = f.evaluate(wi, wo), f.sample(u, wo)
    assert values.shape == weights.shape == (len(wi), 2)
    for k in range(2):
        np.testing.assert_array_equal(values[:, k], f.wavelength(k).evaluate(wi, wo))
    varnish = coated(
        bsdf("lambert", reflectance=[0.2, 0.9]), coat=bsdf("conductor", eta=[0.2, 1.0], k=[3.0, 0])
    )
    assert varnish.evaluate(wi, wo).shape == (len(wi), 2)
    for k in range(2):
        one = varnish.wavelength(k)
        np.testing.assert_allclose(varnish.evaluate(wi, wo)[:, k], one.evaluate(wi, wo), rtol=1e-12)


@pytest.mark.parametrize(
    "f", [0.3 * WHITE + 0.7 * ROUGH, clamped(ROUGH, maximum=0.5), 0.3 * WHITE + 0.7 * SLAB], ids=repr
)
def test_a_combination_agrees_with_its_twin(f, rng):
    wi, wo = pairs(rng, 20)
    if not f.transmissive:
        wi[:, 2], wo[:, 2] = np.abs(wi[:, 2]), np.abs(wo[:, 2])
    twin = f.symbolic()
    exact = [twin.evaluate(*pair) for pair in zip(wi, wo, strict=True)]
    condition = [twin.condition(*pair) for pair in zip(wi, wo, strict=True)]
    assert np.max(scaled_ulps(f.evaluate(wi, wo), exact, condition)) <= 8


def test_reciprocity_of_a_mixture_is_proved():
    twin = (0.3 * WHITE + 0.7 * ROUGH).symbolic()
    assert {str(s) for s in twin.parameters} == {"w_1", "rho_1", "w_2", "alpha_2"}
    assert proved_zero(twin.swapped().expression - twin.expression)


def test_what_has_no_twin_says_so():
    for f in (clamped(0.5 * WHITE + 0.5 * MIRROR, maximum=1.0), COMBINED["varnish"], COMBINED["unknown"]):
        with pytest.raises(RadiokitError):
            f.symbolic()


# Claims


def test_claims_follow_and_nothing_else_does():
    class Says(type(WHITE)):
        name = ""
        said: Claims | None = None

        @property
        def claims(self):
            return self.said

    def saying(claim):
        f = Says()
        object.__setattr__(f, "said", claim)
        return f

    odd = saying(Claims(reciprocity="no", conserves=True))
    gains = saying(Claims(reciprocity="yes", conserves=False))
    silent = saying(None)
    assert (0.5 * WHITE + 0.5 * odd).claims == Claims(reciprocity="no", conserves=True)
    assert (0.5 * odd + 0.5 * odd).claims is None
    assert (0.5 * WHITE + 0.5 * gains).claims is None
    assert (0.5 * gains).claims is None
    assert (1.0 * gains).claims == Claims(reciprocity="yes", conserves=False)
    assert (0.5 * WHITE + 0.5 * silent).claims is None
    assert (0.5 * WHITE + 0.0 * silent).claims == Claims(reciprocity="yes", conserves=True)
    assert (WHITE + MIRROR).claims == Claims(reciprocity="yes", conserves=False)
    assert (0.25 * WHITE + 0.75 * MIRROR).claims == Claims(reciprocity="yes", conserves=True, lossless=True)
    assert (0.5 * GLASS).claims == Claims(reciprocity="eta-scaled", conserves=True, delta=True)
    assert clamped(WHITE, maximum=0.5).claims == WHITE.claims
    assert clamped(WHITE, maximum=0.1).claims is None
    assert clamped(odd, maximum=0.1).claims is None
    assert clamped(MIRROR, maximum=0.1).claims == MIRROR.claims
    assert coated(odd, coat=GLASS).claims == Claims(reciprocity="no", conserves=True, lossless=False)
    assert coated(gains, coat=GLASS).claims is None
    assert coated(silent, coat=GLASS).claims is None


# Clamping


def test_clamping_cuts_both_ends_and_leaves_delta_lobes():
    f = clamped(lambda wi, wo: wi[:, 2] - 0.5, maximum=0.3)
    assert [float(f((0, s, c), (0, 0, 1))) for s, c in ((0.96, 0.28), (0.8, 0.6), (0.0, 1.0))] == [
        0.0,
        pytest.approx(0.1),
        0.3,
    ]
    lobe = clamped(MIRROR, maximum=0.1).delta_lobes(FLAG[None])[0]
    assert lobe.weight.tolist() == [1.0]


def test_clamping_takes_infinity_for_the_maximum(rng):
    f = clamped(lambda wi, wo: np.where(wi[:, 2] > 0.5, np.inf, 0.0), maximum=0.2)
    u = rng.random((1000, 2))
    with np.errstate(all="ignore"):
        wi, weight = f.sample(u, np.tile(FLAG, (1000, 1)))
    np.testing.assert_allclose(weight, np.where(wi[:, 2] > 0.5, 0.2 * np.pi, 0.0))


# Coats


@pytest.mark.parametrize(
    "coat", [SATIN, bsdf("ggx", alpha=0.01, eta=1.5, k=0.0), bsdf("ggx", alpha=1.0)], ids=repr
)
def test_the_table_of_a_coats_albedo_keeps_its_bound(coat, rng):
    table = coat_albedo(coat)
    assert 0 < table.bound < 1e-4
    z = np.concatenate([rng.random(20), 10.0 ** rng.uniform(-5, 0, 10)])
    w = np.stack([np.sqrt(1 - z * z), np.zeros_like(z), z], axis=-1)
    found = table(w)
    for at, value in zip(w, found, strict=True):
        truth = directional_albedo(coat, at, rtol=1e-9)
        assert -truth.error <= value - float(truth) <= 2 * table.bound + truth.error


def test_the_mean_albedo_of_a_coat_is_the_known_one():
    """GGX of α = 1: 4/3 (1 − ln 2); glass: twice the integral of F cosθ, 0.0918 for η = 1.5."""
    rough = coat_albedo(bsdf("ggx", alpha=1.0))
    assert float(rough.average) == pytest.approx(4 / 3 * (1 - np.log(2)), abs=2 * rough.bound)
    assert float(coat_albedo(GLASS).average) == pytest.approx(0.0918, abs=5e-5)
    assert coat_albedo(GLASS).bound == 0.0


def test_a_coat_that_is_not_there_changes_nothing(rng):
    wi, wo = pairs(rng)
    wi[:, 2], wo[:, 2] = np.abs(wi[:, 2]), np.abs(wo[:, 2])
    f = coated(ROUGH, coat=bsdf("dielectric", eta=1.0))
    np.testing.assert_array_equal(f.evaluate(wi, wo), ROUGH.evaluate(wi, wo))
    assert coated(WHITE, coat=MIRROR).evaluate(wi, wo).max() == 0.0


def test_a_varnish_loses_nothing_over_white_and_max_over_a_mirror():
    for theta in (0.0, 1.0, 1.5):
        wo = spherical_to_cartesian(theta, 0.3)
        assert float(albedo(COMBINED["varnish"], wo)) == pytest.approx(1.0, abs=1e-9)
        assert float(albedo(COMBINED["varnished mirror"], wo)) == pytest.approx(1.0, abs=1e-12)


def test_monte_carlo_finds_the_albedo_of_combinations(seed):
    for name in ("diffuse and glossy", "diffuse and mirror", "satin", "varnished metal"):
        f = COMBINED[name]
        found = albedo(f, FLAG, method="mc", samples=1 << 14, rng=seed)
        exact = directional_albedo(f, FLAG, rtol=1e-6)
        assert abs(float(found) - float(exact)) <= 6 * float(found.error) + float(exact.error)


# Wrong arguments


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: mixture([(0.6, WHITE), (0.6, ROUGH)]), "at most 1 together, not 1.2"),
        (lambda: mixture([(-0.1, WHITE)]), r"weights = -0.1 is not allowed: .*\[0, inf\)"),
        (lambda: mixture([]), "at least one"),
        (lambda: mixture(weights=[1.0], components=[WHITE, ROUGH]), "as many as there are components, 2"),
        (lambda: mixture(weights=[1.0]), "pairs of a weight and a BSDF, or else"),
        (lambda: mixture([WHITE]), "pairs of a weight and a BSDF"),
        (lambda: mixture([([0.1, 0.2], WHITE), ([0.1] * 3, ROUGH)]), "one number of wavelengths"),
        (
            lambda: mixture([(0.5, bsdf("lambert", reflectance=r)) for r in ([0.1, 0.2], [0.1] * 3)]),
            "of one number of wavelengths, not 2 and 3",
        ),
        (
            lambda: mixture([(0.5, GLASS), (0.5, bsdf("dielectric", eta=2.0))]),
            "one relative index, not 1.5 and",
        ),
        (lambda: scaled(WHITE, factor=np.nan), "factor = nan"),
        (lambda: scaled(WHITE, factor="half"), "factor = 'half'"),
        (lambda: clamped(WHITE, maximum=0.0), "maximum = 0.0 is not allowed: it must be a number above 0"),
        (lambda: coated(GLASS, coat=GLASS), "base = .* through which no light passes"),
        (lambda: coated(WHITE, coat=as_bsdf(plain)), "coat = .* isotropic"),
        (lambda: coated(WHITE, coat=GLASS, scaling="sum"), "scaling = 'sum' .* 'product' or 'max'"),
    ],
)
def test_a_wrong_argument_is_named(make, words):
    with pytest.raises(ParameterError, match=words):
        make()
