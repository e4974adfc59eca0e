"""The judges reject planted wrong transmitting models, and accept hard legal ones, on both sides."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass

import numpy as np
import pytest

from radiokit.bsdfs.lambert import SOURCE
from radiokit.checks.claims import claims
from radiokit.checks.delta import way_back
from radiokit.checks.energy import energy
from radiokit.checks.judge import check
from radiokit.checks.parts import delta_share, mean_weight, scattered, share
from radiokit.checks.probes import pairs
from radiokit.checks.reciprocity import reciprocity
from radiokit.checks.sampling import sampling
from radiokit.checks.values import values
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, Claims, DeltaLobe
from radiokit.contracts.parameters import parameter
from radiokit.facts.directions import dot, reflect, refract, spherical_to_cartesian
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.verdict import Outcome
from radiokit.physics import fresnel

BUDGET = 1_000_000


def sheet(r=0.4, t=0.6):
    """A Lambertian reflector and transmitter."""

    def f(wi, wo):
        return np.where(wi[:, 2] * wo[:, 2] > 0, r, t) / np.pi

    return f


def n_of(w, eta):
    return np.where(w[..., 2] < 0, eta, 1.0)


def smith_one(w, alpha):
    c2 = w[:, 2] ** 2
    return 2 / (1 + np.sqrt(1 + alpha**2 * (1 - c2) / c2))


class RoughGlass:
    """Walter's rough dielectric with GGX facets and a separable G, and ways to get it wrong."""

    transmissive = True

    def __init__(self, eta=1.5, alpha=0.3, index="o", jacobian=True):
        self.eta, self.alpha, self.index, self.jacobian = eta, alpha, index, jacobian
        self.__name__ = "rough glass"

    def facet(self, wi, wo):
        """Return the facet's normal, upwards, and n_i (wi·h) + n_o (wo·h)."""
        across = wi[:, 2] * wo[:, 2] < 0
        n_i, n_o = (np.where(across, n_of(w, self.eta), 1.0) for w in (wi, wo))
        h = n_i[:, None] * wi + n_o[:, None] * wo
        length = np.linalg.norm(h, axis=1)
        h = h / np.where(length > 0, length, 1.0)[:, None]
        h = np.where(h[:, 2:] < 0, -h, h)
        return across, n_i, n_o, h, n_i * dot(wi, h) + n_o * dot(wo, h)

    def density(self, h):
        c2 = np.maximum(h[:, 2] ** 2, 1e-300)
        d = self.alpha**2 * c2 + (1 - c2)
        return self.alpha**2 / (np.pi * d * d)

    def fresnel(self, w, h):
        return fresnel.dielectric(np.clip(dot(w, h), -1, 1), self.eta)

    def __call__(self, wi, wo):
        across, n_i, n_o, h, total = self.facet(wi, wo)
        i_h, o_h = dot(wi, h), dot(wo, h)
        right = (i_h * wi[:, 2] > 0) & (o_h * wo[:, 2] > 0) & np.where(across, i_h * o_h < 0, True)
        common = self.density(h) * smith_one(wi, self.alpha) * smith_one(wo, self.alpha)
        common = common / np.abs(wi[:, 2] * wo[:, 2])
        reflectance = self.fresnel(wo, h)
        scale = {"o": n_o**2, "i": n_i**2, None: 1.0}[self.index]
        passed = (1 - reflectance) * np.abs(i_h * o_h) * scale
        passed = passed / np.maximum(total * total, 1e-300)
        return np.where(right, common * np.where(across, passed, reflectance / 4), 0.0)

    def pdf(self, wi, wo):
        across, n_i, _, h, total = self.facet(wi, wo)
        i_h, o_h = dot(wi, h), dot(wo, h)
        right = np.where(across, i_h * o_h < 0, i_h * o_h > 0) & (o_h * wo[:, 2] > 0)
        reflectance = self.fresnel(wo, h)
        turn = (n_i**2 if self.jacobian else 1.0) * np.abs(i_h) / np.maximum(total * total, 1e-300)
        said = np.where(across, (1 - reflectance) * turn, reflectance / np.maximum(4 * np.abs(i_h), 1e-300))
        return np.where(right, said * self.density(h) * h[:, 2], 0.0)

    def sample(self, u, wo):
        tangent = self.alpha * np.sqrt(u[:, 0] / (1 - u[:, 0]))
        cosine = 1 / np.sqrt(1 + tangent * tangent)
        phi = 2 * np.pi * u[:, 1]
        h = (
            np.stack([tangent * np.cos(phi), tangent * np.sin(phi), np.ones(len(u))], axis=1)
            * cosine[:, None]
        )
        reflectance = self.fresnel(wo, h)
        mirrored = u[:, 2] < reflectance
        through, _ = refract(wo, h, eta=self.eta)
        wi = np.where(mirrored[:, None], reflect(wo, h), through)
        # A facet that is not turned to wo, or sends light to the wrong side, absorbs.
        crossed = wi[:, 2] * wo[:, 2] < 0
        good = (dot(wo, h) * wo[:, 2] > 0) & (crossed == ~mirrored) & (wi[:, 2] != 0)
        safe = np.where(good[:, None], wi, reflect(wo))
        pdf = np.where(good, self.pdf(safe, wo), 1.0)
        weight = self(safe, wo) * np.abs(safe[:, 2]) / np.where(pdf > 0, pdf, 1.0)
        return safe, np.where(good & (pdf > 0), weight, 0.0)


class Delta(BSDF):
    """What models made of delta lobes have in common."""

    transmissive = True
    dimensions = 3
    SOURCE = SOURCE

    def symbolic(self):
        raise RadiokitError("it has no formula")

    def evaluate(self, wi, wo):
        return np.zeros(len(wi))

    def pdf(self, wi, wo):
        return np.zeros(len(wi))

    def sample(self, u, wo):
        one, two = self.delta_lobes(wo)
        first = u[:, 2] < self.chance(one.weight)
        scale = (n_of(wo, self.relative_index()) / n_of(two.wi, self.relative_index())) ** 2
        p = self.chance(one.weight)
        weight = np.where(
            first, one.weight / np.where(p > 0, p, 1), two.weight / np.where(p < 1, 1 - p, 1) * scale
        )
        return np.where(first[:, None], one.wi, two.wi), weight

    def chance(self, reflectance):
        return reflectance

    @property
    def claims(self):
        law = "yes" if self.relative_index() == 1 else "eta-scaled"
        return Claims(reciprocity=law, conserves=True, lossless=True, delta=True)


@dataclass(frozen=True, kw_only=True)
class Glass(Delta):
    """A smooth dielectric."""

    eta: float = parameter("(0, inf)", "1", "relative index", default=1.5)

    def relative_index(self):
        return self.eta

    def delta_lobes(self, wo):
        reflectance = fresnel.dielectric(wo[:, 2], self.eta)
        through, _ = refract(wo, eta=self.eta)
        return DeltaLobe(reflect(wo), reflectance), DeltaLobe(through, 1 - reflectance)


@dataclass(frozen=True, kw_only=True)
class Slab(Delta):
    """A thin parallel plate: all orders of reflection inside, straight through."""

    def delta_lobes(self, wo):
        once = fresnel.dielectric(np.abs(wo[:, 2]), 1.5)
        twice = 2 * once / (1 + once)
        return DeltaLobe(reflect(wo), twice), DeltaLobe(-wo, 1 - twice)


class Half(Glass):
    """Picks a lobe by a fair coin."""

    def chance(self, reflectance):
        return np.full(len(reflectance), 0.5)


class Forgetful(Glass):
    """Its sampler forgets the factor n²."""

    def sample(self, u, wo):
        wi, weight = super().sample(u, wo)
        return wi, np.where(weight > 0, 1.0, 0.0)


class Biased(Glass):
    """Takes the reflected lobe a little too often, at full weight."""

    def sample(self, u, wo):
        return super().sample(u * [1, 1, 0.8], wo)


class Crooked(Glass):
    """Refracts to where it is not."""

    def sample(self, u, wo):
        wi, weight = super().sample(u, wo)
        wi = wi + 1e-5 * np.array([1.0, 0, 0])
        return wi / np.linalg.norm(wi, axis=1)[:, None], weight


class Leaky(Glass):
    """Lets 1 % through where reflection is total."""

    def delta_lobes(self, wo):
        one, two = super().delta_lobes(wo)
        to, total = refract(wo, eta=self.eta)
        to[:, 2] = np.where(total, np.copysign(1e-3, -wo[:, 2]), to[:, 2])
        to = to / np.linalg.norm(to, axis=1)[:, None]
        return one, DeltaLobe(to, np.where(total, 0.01, two.weight))


class OneWay(Glass):
    """Transmits less from above than from below."""

    def delta_lobes(self, wo):
        one, two = super().delta_lobes(wo)
        return one, DeltaLobe(two.wi, np.where(wo[:, 2] > 0, 0.9, 1.0) * two.weight)


# --------------------------------------------------------------------------------------------- probes


def test_pairs_fall_on_all_four_combinations_of_sides():
    f = as_bsdf(sheet(), transmissive=True, eta=1.5)
    wi, wo = pairs(1 << 12, f)
    np.testing.assert_allclose(np.linalg.norm([wi, wo], axis=2), 1.0, rtol=1e-14)
    assert np.abs([wi[:, 2], wo[:, 2]]).min() > 0.9e-6
    combination = 2 * (wi[:, 2] < 0) + (wo[:, 2] < 0)
    assert np.bincount(combination).min() > (1 << 12) // 5
    to, total = refract(wo, eta=1.5)
    off = np.linalg.norm(wi - to, axis=1)[~total]
    assert off.min() < 1e-4
    sine = np.hypot(wi[:, 0], wi[:, 1])[wi[:, 2] < 0]
    near = sine / (1 / 1.5) - 1
    assert ((near > 0) & (near < 1e-4)).any()
    assert ((near < 0) & (near > -1e-4)).any()


def test_pairs_of_a_surface_that_does_not_transmit_are_as_they_were():
    one, two = pairs(256), pairs(256, as_bsdf(sheet()))
    np.testing.assert_array_equal(one, two)


# --------------------------------------------------------------------------------------------- values


@pytest.mark.parametrize("below_i", [False, True])
@pytest.mark.parametrize("below_o", [False, True])
def test_values_looks_at_every_combination_of_sides(below_i, below_o):
    def f(wi, wo):
        return np.where(((wi[:, 2] < 0) == below_i) & ((wo[:, 2] < 0) == below_o), -1.0, 0.1)

    assert values(as_bsdf(f, transmissive=True)).outcome is Outcome.VIOLATED


def test_values_finds_a_nan_that_stands_only_at_the_refracted_pair():
    def f(wi, wo):
        to, _ = refract(wo, eta=1.5)
        return np.where(np.abs(wi - to).sum(axis=1) == 0, np.nan, 0.1)

    assert values(as_bsdf(f, transmissive=True, eta=1.5)).outcome is Outcome.VIOLATED


def test_values_accepts_rough_glass():
    for eta in (1.5, 1 / 1.5, 1.0001):
        assert values(as_bsdf(RoughGlass(eta=eta))).ok


# ---------------------------------------------------------------------------------------- reciprocity


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 1.0001, 2.5])
def test_reciprocity_accepts_the_scaled_law(eta):
    verdict = reciprocity(as_bsdf(RoughGlass(eta=eta), eta=eta))
    assert verdict.ok, verdict
    assert verdict.details["law"] == "eta-scaled"
    assert not verdict.details["plain_holds"]


def test_reciprocity_finds_the_missing_factor():
    verdict = reciprocity(as_bsdf(RoughGlass(index=None), eta=1.5))
    assert verdict.outcome is Outcome.VIOLATED
    assert "is the factor n² missing" in verdict.message
    assert verdict.details["plain_holds"]
    seen = verdict.witness.values
    wi, wo = (np.array([verdict.witness.directions[name]]) for name in ("wi", "wo"))
    f = RoughGlass(index=None)
    assert seen["f(wi, wo)"] == pytest.approx(f(wi, wo)[0], rel=1e-12)
    assert (seen["n(wi)²"], seen["n(wo)²"]) in ((1.0, 2.25), (2.25, 1.0))


def test_reciprocity_is_the_plain_law_where_the_index_is_the_same():
    verdict = reciprocity(as_bsdf(sheet(), transmissive=True))
    assert verdict.ok
    assert "law" not in verdict.details
    lopsided = as_bsdf(lambda wi, wo: np.where(wi[:, 2] > 0, 0.1, 0.1001), transmissive=True)
    assert reciprocity(lopsided).outcome is Outcome.VIOLATED


@pytest.mark.parametrize(
    "f", [Glass(), Glass(eta=1 / 1.5), Glass(eta=1.0001), Glass(eta=1.0), Slab()], ids=repr
)
def test_delta_lobes_come_back(f):
    verdict = reciprocity(f)
    assert verdict.ok, verdict
    assert verdict.details["delta_lobes_followed"] >= 4096


@pytest.mark.parametrize("f", [Leaky(), OneWay()], ids=repr)
def test_a_delta_lobe_that_does_not_come_back_is_found(f):
    verdict = reciprocity(f)
    assert verdict.outcome is Outcome.VIOLATED
    assert "way back" in verdict.message
    _, problem = way_back(f, tolerance=1e-9)
    wo, wi = (np.array([problem[1].directions[name]]) for name in ("wo", "wi"))
    assert any(np.allclose(lobe.wi, wi, atol=1e-12) for lobe in f.delta_lobes(wo))


# --------------------------------------------------------------------------------------------- energy


@pytest.mark.parametrize(
    ("r", "t", "outcome"),
    [
        (0.4, 0.6, Outcome.HOLDS),
        (0.0, 1.0, Outcome.HOLDS),
        (0.4, 0.5, Outcome.HOLDS),
        (0.4, 0.601, Outcome.VIOLATED),
        (0.4, 0.6 + 1e-8, Outcome.VIOLATED),
    ],
)
def test_energy_of_a_lambertian_transmitter(r, t, outcome):
    verdict = energy(as_bsdf(sheet(r, t), transmissive=True))
    assert verdict.outcome is outcome
    assert abs(verdict.estimate.value - r - t) <= verdict.estimate.error <= 1e-9
    assert verdict.details["lossless"] == (abs(r + t - 1) < 1e-12)
    rows = verdict.details["balance"]
    assert {row["side"] for row in rows} == {"above", "below"}
    for row in [*rows, verdict.details["at_supremum"]]:
        assert row["reflected"] == pytest.approx(r, abs=1e-6)
        assert row["transmitted"] == pytest.approx(t, abs=1e-6)
        assert row["absorbed"] == pytest.approx(1 - r - t, abs=1e-6)
    json.dumps(verdict.to_json())


def test_energy_sees_a_gain_that_happens_only_below():
    def f(wi, wo):
        return np.where(wi[:, 2] < 0, 1.01, 0.9) / (2 * np.pi)

    verdict = energy(as_bsdf(f, transmissive=True))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.witness.directions["wi"][2] < 0
    assert "from below" in verdict.message


def test_energy_of_a_diffuse_boundary_between_two_indices():
    """f = k n(wo)²/π across: more light comes through into the denser side, and neither side gains."""

    def f(wi, wo, gain=1.0):
        across = wi[:, 2] * wo[:, 2] < 0
        back = np.where(wi[:, 2] > 0, 0.1, 0.6)
        return gain * np.where(across, 0.4 * n_of(wo, 1.5) ** 2, back) / np.pi

    model = as_bsdf(f, transmissive=True, eta=1.5)
    verdict = energy(model)
    assert verdict.outcome is Outcome.HOLDS
    assert verdict.details["lossless"]
    assert reciprocity(model).ok
    brighter = as_bsdf(lambda wi, wo: f(wi, wo, 1.001), transmissive=True, eta=1.5)
    assert energy(brighter).outcome is Outcome.VIOLATED


@pytest.mark.parametrize("f", [Glass(), Glass(eta=1 / 1.5), Glass(eta=1.0001), Slab()], ids=repr)
def test_energy_of_smooth_glass_is_all_there_on_both_sides(f):
    verdict = energy(f)
    assert verdict.ok, verdict
    assert verdict.details["lossless"]


def test_energy_finds_a_leak_under_total_reflection():
    verdict = energy(Leaky())
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.details["at_supremum"]["reflected"] == 1.0
    assert verdict.details["at_supremum"]["transmitted"] == 0.01
    assert verdict.witness.directions["wi"][2] < 0


@pytest.mark.parametrize(
    ("f", "budget", "outcome"),
    [
        (RoughGlass(), 4 * BUDGET, Outcome.HOLDS),
        (RoughGlass(index=None), BUDGET, Outcome.HOLDS),  # it only loses; reciprocity sees the fault
        (RoughGlass(index="i"), BUDGET, Outcome.VIOLATED),
    ],
    ids=["glass", "no n²", "n² of the other side"],
)
def test_energy_of_rough_glass(f, budget, outcome):
    verdict = energy(as_bsdf(f), budget=budget)
    assert verdict.outcome is outcome, verdict


def test_shares_are_those_of_the_delta_lobes():
    f, w = Glass(), spherical_to_cartesian([0.3, 2.9], 0.5)
    for direction in w:
        back, through = (
            float(share(f, direction, fixed="wi", side=side).value) for side in ("reflected", "transmitted")
        )
        reflectance = float(fresnel.dielectric(direction[2], 1.5))
        assert back == pytest.approx(reflectance, abs=1e-14)
        assert through == pytest.approx(1 - reflectance, abs=1e-14)
        assert float(scattered(f, direction, fixed="wo").value) == pytest.approx(1.0, abs=1e-13)
        # Radiance that enters the denser side is multiplied by η².
        seen = float(mean_weight(f, direction, rtol=1e-8, max_evaluations=100_000).value)
        into = 2.25 if direction[2] < 0 else 1 / 2.25
        assert seen == pytest.approx(reflectance + into * (1 - reflectance), abs=1e-13)
    np.testing.assert_allclose(delta_share(f, w), 1.0, rtol=1e-14)


# ------------------------------------------------------------------------------------------- sampling


@pytest.mark.parametrize(
    "f",
    [
        as_bsdf(sheet(), transmissive=True),
        as_bsdf(RoughGlass()),
        Glass(),
        Glass(eta=1 / 1.5),
        Glass(eta=1.0001),
        Half(),
        Slab(),
    ],
    ids=["sheet", "glass", "smooth", "smooth, inverted", "η = 1.0001", "fair coin", "slab"],
)
def test_sampling_accepts_right_samplers_on_both_sides(f, seed):
    verdict = sampling(f, seed=seed, samples=1 << 15)
    assert verdict.ok, verdict
    assert [row["side"] for row in verdict.details["rows"]] == ["above"] * 6 + ["below"] * 6


@pytest.mark.parametrize(
    ("f", "says"),
    [
        (as_bsdf(RoughGlass(jacobian=False)), ""),
        (Forgetful(), "delta lobes"),
        (Biased(), "delta lobes"),
        (Crooked(), "pdf is not positive"),
    ],
    ids=["no Jacobian", "no n²", "too often", "crooked"],
)
def test_sampling_rejects_wrong_samplers(f, says, seed):
    verdict = sampling(f, seed=seed, samples=1 << 15)
    assert verdict.outcome is Outcome.VIOLATED
    assert says in verdict.message
    assert verdict.witness is not None


def test_sampling_judges_a_lobe_that_is_both_sharp_and_diffuse(seed):
    """A coat: a mirror that takes a fifth of the light, above a diffuse sheet."""

    class Coat(Delta):
        def evaluate(self, wi, wo):
            return 0.8 * sheet()(wi, wo)

        def pdf(self, wi, wo):
            return self.share * np.abs(wi[:, 2]) / (2 * np.pi)

        def delta_lobes(self, wo):
            return (DeltaLobe(reflect(wo), np.full(len(wo), 0.2)),)

        def sample(self, u, wo):
            diffuse, _ = as_bsdf(sheet(), transmissive=True).sample(u / [1, 1, 0.5] % 1.0, wo)
            sharp = u[:, 2] < 0.5
            wi = np.where(sharp[:, None], reflect(wo), diffuse)
            return wi, np.where(sharp, 0.4, 2 * 0.8 * 2 * np.pi * sheet()(wi, wo))

        share = 0.5

    class Wrong(Coat):
        share = 0.6

        def sample(self, u, wo):
            wi, weight = super().sample(u, wo)
            return wi, np.where(u[:, 2] < 0.5, weight, weight * 0.5 / 0.6)

    verdict = sampling(Coat(), seed=seed, samples=1 << 15)
    assert verdict.ok, verdict
    assert energy(Coat(), budget=BUDGET).details["lossless"]
    assert sampling(Wrong(), seed=seed, samples=1 << 15).outcome is Outcome.VIOLATED


# --------------------------------------------------------------------------------- claims and the rest


def test_claims_name_the_law_that_governs_the_model():
    class Plain(Glass):
        @property
        def claims(self):
            return Claims(reciprocity="yes", conserves=True, lossless=True, delta=True)

    for f, outcome in ((Glass(), Outcome.HOLDS), (Slab(), Outcome.HOLDS), (Plain(), Outcome.VIOLATED)):
        verdict = claims(f, check(f, laws=["reciprocity", "energy"]))
        assert verdict.outcome is outcome, verdict
    assert "eta-scaled" in verdict.message


def test_a_function_says_that_light_passes():
    for f in (as_bsdf(RoughGlass()), as_bsdf(sheet(), transmissive=True, eta=1.5)):
        assert f.transmissive
        assert f.dimensions == 3
        assert f.relative_index() == 1.5
    assert as_bsdf(sheet(), transmissive=True).relative_index() == 1.0
    assert not as_bsdf(RoughGlass(), transmissive=False).transmissive


def test_a_wrong_index_is_named():
    for eta in (0.0, -1.0, float("nan"), "dense"):
        with pytest.raises(ParameterError, match=r"eta = .* a finite number above 0"):
            as_bsdf(sheet(), transmissive=True, eta=eta)
    with pytest.raises(ParameterError, match="left out, unless transmissive=True"):
        as_bsdf(sheet(), eta=1.5)


def test_a_function_that_passes_light_unannounced_gets_a_note():
    report = check(sheet(0.4, 0.6), laws=["values"])
    assert report.ok
    assert any("is not 0 below the horizon" in note for note in report.notes)

    def dark(wi, wo):
        return np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), 0.1, 0.0)

    assert not check(dark, laws=["values"]).notes
    assert not check(as_bsdf(sheet(), transmissive=True), laws=["values"]).notes


def test_a_target_in_a_file_says_that_light_passes(tmp_path):
    from radiokit.faces.targets import load_target

    file = tmp_path / "glass.py"
    file.write_text(
        "import numpy as np\n"
        "def f(wi, wo, t=0.6, eta=1.3):\n"
        "    return np.where(wi[:, 2] * wo[:, 2] > 0, 0.4, t) / np.pi\n"
        "f.transmissive, f.eta = True, 1.3\n"
    )
    plain, given = load_target(f"{file}:f", {}), load_target(f"{file}:f", {"t": 0.5, "eta": 1.4})
    assert (plain.transmissive, plain.relative_index()) == (True, 1.3)
    assert (given.transmissive, given.relative_index()) == (True, 1.4)


def test_a_slow_function_gets_a_whole_report():
    def slow(wi, wo):
        time.sleep(3e-5 * len(wi))
        return sheet()(wi, wo)

    report = check(as_bsdf(slow, transmissive=True, eta=1.0), seconds=1)
    assert report.outcome is not Outcome.VIOLATED, str(report)
    assert [verdict.check for verdict in report] == ["values", "reciprocity", "energy"]
    assert "balance" not in report["energy"].details
    json.dumps(report.to_json())
