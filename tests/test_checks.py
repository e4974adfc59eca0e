"""The judges reject planted wrong models, and accept hard legal ones."""

from __future__ import annotations

import time

import numpy as np
import pytest

from radiokit.checks.energy import energy
from radiokit.checks.judge import check
from radiokit.checks.probes import isotropic, pairs, polar
from radiokit.checks.reciprocity import reciprocity
from radiokit.checks.sampling import sampling
from radiokit.checks.values import values
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import bsdf
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.facts.verdict import Outcome
from radiokit.measure.lattice import kronecker


def lambert(albedo):
    return lambda wi, wo: np.full(len(wi), albedo / np.pi)


def phong(wi, wo, n=10):
    mirror = wo * [-1, -1, 1]
    return (n + 2) / (2 * np.pi) * np.maximum(np.sum(mirror * wi, axis=-1), 0) ** n


def blinn_phong(wi, wo, n=10):
    half = wi + wo
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    return (n + 8) / (8 * np.pi) * half[:, 2] ** n


def oren_nayar(wi, wo, sigma=0.3, rho=1.0):
    a = 1 - 0.5 * sigma**2 / (sigma**2 + 0.33)
    b = 0.45 * sigma**2 / (sigma**2 + 0.09)
    ti, to = np.arccos(wi[:, 2]), np.arccos(wo[:, 2])
    turn = np.arctan2(wi[:, 1], wi[:, 0]) - np.arctan2(wo[:, 1], wo[:, 0])
    low, high = np.minimum(ti, to), np.maximum(ti, to)
    return rho / np.pi * (a + b * np.maximum(0, np.cos(turn)) * np.sin(high) * np.tan(low))


def ggx(alpha):
    def f(wi, wo):
        s = wi + wo
        d = s[:, 0] ** 2 + s[:, 1] ** 2 + alpha**2 * s[:, 2] ** 2
        ndf = alpha**2 * np.sum(s * s, axis=1) ** 2 / (np.pi * d * d)
        ci, co = wi[:, 2], wo[:, 2]
        ri = np.sqrt(ci**2 + alpha**2 * (wi[:, 0] ** 2 + wi[:, 1] ** 2))
        ro = np.sqrt(co**2 + alpha**2 * (wo[:, 0] ** 2 + wo[:, 1] ** 2))
        return ndf * 0.5 / (ci * ro + co * ri)

    return f


def degrees(w):
    return np.rad2deg(np.arctan2(np.hypot(w[:, 0], w[:, 1]), w[:, 2]))


# ---------------------------------------------------------------------------------------------- probes


def test_kronecker_points_fill_the_square_more_evenly_than_random_ones(rng):
    def emptiest(points):
        counts, *_ = np.histogram2d(*points.T, bins=16, range=[[0, 1], [0, 1]])
        return counts.min()

    assert emptiest(kronecker(4096, 2)) >= 12 > emptiest(rng.random((4096, 2)))


def test_pairs_are_unit_vectors_above_the_horizon_down_to_89_9999_degrees():
    wi, wo = pairs(4096)
    for w in (wi, wo):
        assert np.abs(np.linalg.norm(w, axis=1) - 1).max() < 1e-14
        assert w[:, 2].min() >= np.cos(np.deg2rad(89.9999)) * 0.999
        assert degrees(w).max() > 89.999


def test_isotropy_is_seen_both_ways():
    assert isotropic(as_bsdf(ggx(0.1)))
    assert not isotropic(as_bsdf(lambda wi, wo: (1 + wi[:, 0] * wo[:, 0]) / 10))


# ---------------------------------------------------------------------------------------------- values


@pytest.mark.parametrize(
    ("f", "says"),
    [
        (lambda wi, wo: 0.3 - 0.5 * wi[:, 2], "negative at"),
        (lambda wi, wo: np.where(wi[:, 2] > 0.99, np.nan, 0.1), "NaN at"),
        (lambda wi, wo: np.where(wo[:, 2] < 1e-4, np.inf, 0.1), "infinite at"),
    ],
)
def test_values_rejects_what_is_negative_or_not_finite(f, says):
    verdict = values(as_bsdf(f))
    assert verdict.outcome is Outcome.VIOLATED
    assert says in verdict.message
    wi, wo = (np.array([verdict.witness.directions[name]]) for name in ("wi", "wo"))
    value = f(wi, wo)[0]
    assert not np.isfinite(value) or value < 0  # the witness re-evaluates to the fault


def test_values_finds_a_nan_that_stands_only_at_the_exact_mirror_pair():
    def f(wi, wo):
        gap = np.abs(wi - wo * [-1, -1, 1]).sum(axis=1)
        return np.where(gap == 0, np.nan, 0.1)

    assert values(as_bsdf(f)).outcome is Outcome.VIOLATED


def test_values_rejects_a_function_that_answers_differently(rng):
    verdict = values(as_bsdf(lambda wi, wo: 0.1 + 0.01 * rng.random(len(wi))))
    assert verdict.outcome is Outcome.VIOLATED
    assert "asked again" in verdict.message


@pytest.mark.parametrize("f", [ggx(1e-4), phong, oren_nayar], ids=["ggx 1e-4", "phong", "oren-nayar"])
def test_values_accepts_large_legal_values(f):
    verdict = values(as_bsdf(f))
    assert verdict.outcome is Outcome.HOLDS
    assert verdict.details["largest"] > 1


# ----------------------------------------------------------------------------------------- reciprocity


def in_a_cap(w, area=1e-3):
    centre = spherical_to_cartesian(0.8, 2.0)
    return np.sum((w - centre) ** 2, axis=1) < area / np.pi  # a cap's area is π times its chord squared


@pytest.mark.parametrize(
    "f",
    [
        lambda wi, wo: phong(wi, wo) / wi[:, 2],
        lambda wi, wo: np.where(in_a_cap(wi), 0.15, 0.1),
        lambda wi, wo: np.where(in_a_cap(wo), 0.1001, 0.1),
        lambda wi, wo: (1 + 1e-6 * wi[:, 2]) / 4,
        lambda wi, wo: ggx(0.01)(wi, wo) * (1 + 1e-4 * wi[:, 2]),
        lambda wi, wo: np.stack([0.1 + 0 * wi[:, 2], 0.1 + 0.01 * wi[:, 2]], axis=1),
    ],
    ids=["phong/cos", "cap 1e-3 sr", "cap, 0.1 %", "1e-6", "narrow lobe", "one channel of two"],
)
def test_reciprocity_rejects_an_asymmetry_and_its_witness_shows_it(f):
    verdict = reciprocity(as_bsdf(f))
    assert verdict.outcome is Outcome.VIOLATED
    wi, wo = (np.array([verdict.witness.directions[name]]) for name in ("wi", "wo"))
    one, two = f(wi, wo), f(wo, wi)
    assert np.any(one != two)
    assert verdict.witness.values["f(wi, wo)"] in one
    assert verdict.witness.values["f(wo, wi)"] in two


@pytest.mark.parametrize(
    "f",
    [ggx(1e-4), ggx(0.3), phong, oren_nayar, lambert(1.0)],
    ids=["ggx 1e-4", "ggx", "phong", "oren-nayar", "lambert"],
)
def test_reciprocity_accepts_hard_reciprocal_functions(f):
    assert reciprocity(as_bsdf(f)).outcome is Outcome.HOLDS


def test_reciprocity_calls_rounding_noise_no_asymmetry():
    def textbook(wi, wo, alpha=1e-3):  # (α² − 1) c² + 1 loses most of its digits near the peak
        half = wi + wo
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        return ggx(0.3)(wi, wo) + 1e-3 / ((alpha**2 - 1) * half[:, 2] ** 2 + 1) ** 2

    assert reciprocity(as_bsdf(textbook)).outcome is Outcome.HOLDS


def test_reciprocity_is_inconclusive_where_values_are_missing():
    verdict = reciprocity(as_bsdf(lambda wi, wo: np.where(wi[:, 2] * wo[:, 2] < 1e-3, np.nan, 0.1)))
    assert verdict.outcome is Outcome.INCONCLUSIVE


# ---------------------------------------------------------------------------------------------- energy


def window(low=87.0, high=87.2):
    def inside(w):
        angle = degrees(w)
        return (angle > low) & (angle < high)

    return inside


@pytest.mark.parametrize(
    ("f", "side"),
    [
        (lambda wi, wo: np.where(window()(wo), 1.2, 0.9) / np.pi, "wo"),
        (lambda wi, wo: np.where(window()(wi), 1.2, 0.9) / np.pi, "wi"),
    ],
    ids=["wo", "wi"],
)
def test_energy_finds_a_gain_in_a_window_of_a_fifth_of_a_degree(f, side):
    verdict = energy(as_bsdf(f))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.details["fixed"] == side
    assert 87.0 <= verdict.details["theta_deg"] <= 87.2
    assert verdict.estimate.value == pytest.approx(1.2, rel=1e-6)


@pytest.mark.parametrize(
    ("albedo", "outcome"),
    [
        (1.000001, Outcome.VIOLATED),
        (1 + 1e-8, Outcome.VIOLATED),
        (1 + 1e-10, Outcome.HOLDS),
        (1.0, Outcome.HOLDS),
        (0.999999, Outcome.HOLDS),
    ],
)
def test_energy_tells_a_gain_from_a_loss_to_its_tolerance(albedo, outcome):
    verdict = energy(as_bsdf(lambert(albedo)))
    assert verdict.outcome is outcome
    assert abs(verdict.estimate.value - albedo) <= verdict.estimate.error <= 1e-9


def test_energy_of_blinn_phong_is_too_much_at_normal_incidence():
    verdict = energy(as_bsdf(blinn_phong))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.details["theta_deg"] == 0.0
    # (n+8)/8π ∫ cosⁿ(θ/2) cosθ dω = (n+8)/2 ∫ tⁿᐟ² (2t − 1) dt over [1/2, 1], with t = cos²(θ/2) and n = 10
    t = 0.5
    exact = 9 * ((2 / 7 - 1 / 6) - (2 * t**7 / 7 - t**6 / 6))
    assert abs(verdict.estimate.value - exact) <= verdict.estimate.error
    assert verdict.estimate.value == pytest.approx(1.0748, abs=5e-5)


def test_energy_of_qualitative_oren_nayar_is_too_much_only_near_grazing():
    verdict = energy(as_bsdf(oren_nayar))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.details["approached_at_grazing"]
    assert verdict.details["above_limit_deg"][0] > 85


def test_energy_looks_at_both_sides_of_a_function_that_is_not_reciprocal():
    def f(wi, wo):  # ∫ f cosθi dωi = 1 for every wo, and far more for wi near grazing
        return 1 / (2 * np.pi * wi[:, 2])

    verdict = energy(as_bsdf(f))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.details["fixed"] == "wi"
    assert verdict.details["supremum"]["wo"] == pytest.approx(1.0, rel=1e-6)
    assert verdict.details["supremum"]["wi"] == pytest.approx(0.5 / np.cos(np.deg2rad(89.99)), rel=1e-6)


def test_energy_finds_a_gain_at_one_azimuth_of_an_anisotropic_function():
    def f(wi, wo):
        phi = np.arctan2(wo[:, 1], wo[:, 0])
        return (0.9 + 0.15 * np.exp(-(((phi - 2.0) / 0.3) ** 2))) / np.pi

    verdict = energy(as_bsdf(f))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.details["phi_deg"] == pytest.approx(np.rad2deg(2.0), abs=1.0)
    assert verdict.estimate.value == pytest.approx(1.05, abs=1e-4)


def test_energy_does_not_give_a_number_for_an_integral_that_diverges():
    def f(wi, wo):
        gap = np.sum((wi - wo * [-1, -1, 1]) ** 2, axis=1)
        return 1e-3 / (gap + 1e-300) / np.maximum(wi[:, 2], 1e-3)

    verdict = energy(as_bsdf(f), budget=2_000_000)
    assert verdict.outcome is not Outcome.HOLDS
    assert verdict.estimate is None or verdict.estimate.error > 1e-4 * verdict.estimate.value


@pytest.mark.parametrize(("gain", "outcome"), [(1.0, Outcome.HOLDS), (1.02, Outcome.VIOLATED)])
def test_energy_resolves_a_narrow_lobe_that_is_retro_reflective(gain, outcome):
    verdict = energy(as_bsdf(lambda wi, wo: gain * ggx(0.005)(wi, wo * [-1, -1, 1])))
    assert verdict.outcome is outcome
    assert verdict.estimate.value == pytest.approx(gain, rel=1e-3)


@pytest.mark.parametrize("alpha", [1e-3, 0.003, 0.1, 1.0])
def test_energy_accepts_legal_lobes_of_any_width(alpha):
    verdict = energy(as_bsdf(ggx(alpha)))
    assert verdict.outcome is Outcome.HOLDS
    assert 0.99 < verdict.estimate.value < 1


def test_energy_is_inconclusive_where_the_function_is_not_finite():
    verdict = energy(as_bsdf(lambda wi, wo: np.where(wi[:, 2] > 0.9, np.nan, 0.1)))
    assert verdict.outcome is Outcome.INCONCLUSIVE
    assert "nan" in verdict.message


# -------------------------------------------------------------------------------------------- sampling


def cosine_sample(u, wo):
    radius, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), np.sqrt(1 - u[:, 0])], axis=1)


def cosine_pdf(wi, wo):
    return wi[:, 2] / np.pi


def sampled(pdf=cosine_pdf, weight=lambda wi: np.full(len(wi), 0.8), sample=cosine_sample):
    def both(u, wo):
        wi = sample(u, wo)
        return wi, weight(wi)

    return as_bsdf(lambert(0.8), pdf=pdf, sample=both)


def test_sampling_accepts_a_right_sampler(seed):
    verdict = sampling(sampled(), seed=seed)
    assert verdict.outcome is Outcome.HOLDS
    assert len(verdict.details["rows"]) == 6


@pytest.mark.parametrize(
    ("f", "says"),
    [
        (
            sampled(
                pdf=lambda wi, wo: 1.01 * cosine_pdf(wi, wo), weight=lambda wi: 0 * wi[:, 2] + 0.8 / 1.01
            ),
            "more than 1",
        ),
        (
            sampled(
                pdf=lambda wi, wo: 0.99 * cosine_pdf(wi, wo), weight=lambda wi: 0 * wi[:, 2] + 0.8 / 0.99
            ),
            "chi-square",
        ),
        (sampled(pdf=lambda wi, wo: 1.01 * cosine_pdf(wi, wo)), "weight is not"),
        (sampled(weight=lambda wi: 0.8 / wi[:, 2]), "weight is not"),
        (
            sampled(pdf=lambda wi, wo: np.full(len(wi), 0.5 / np.pi), weight=lambda wi: 1.6 * wi[:, 2]),
            "chi-square",
        ),
        (sampled(sample=lambda u, wo: 2 * cosine_sample(u, wo)), "no unit vector"),
        (sampled(weight=lambda wi: np.where(wi[:, 2] > 0.5, 0.8, np.nan)), "not finite"),
        (sampled(pdf=lambda wi, wo: np.where(wi[:, 2] > 0.5, cosine_pdf(wi, wo), 0.0)), "not positive"),
    ],
    ids=[
        "pdf 1 % high",
        "pdf 1 % low",
        "pdf 1 % off its weight",
        "weight without the cosine",
        "pdf of another sampler",
        "not unit",
        "NaN weight",
        "pdf zero where sampled",
    ],
)
def test_sampling_rejects_a_wrong_sampler(f, says, seed):
    verdict = sampling(f, seed=seed)
    assert verdict.outcome is Outcome.VIOLATED
    assert says in verdict.message
    assert verdict.witness is not None


LONG = {  # lobes up to a thousand times as long as wide
    "ggx, 1 : 100": (bsdf("ggx", alpha_x=0.01, alpha_y=1.0), Outcome.HOLDS),
    "ggx, 1 : 1000": (bsdf("ggx", alpha_x=0.001, alpha_y=1.0), None),
    "beckmann, 1 : 1000": (bsdf("beckmann", alpha_x=0.001, alpha_y=1.0), None),
}


@pytest.mark.parametrize(("f", "outcome"), LONG.values(), ids=LONG)
def test_a_long_and_narrow_lobe_is_never_called_wrong(f, outcome, seed):
    found = sampling(f, seed=seed).outcome
    assert found is not Outcome.VIOLATED
    assert outcome in (None, found)


@pytest.mark.parametrize("wrong", [{"alpha_x": 0.007, "alpha_y": 0.8}, {"alpha_x": 0.01, "alpha_y": 0.88}])
def test_a_wrong_sampler_of_a_long_and_narrow_lobe_is_rejected(wrong, seed):
    """Planted: a width that is off across the lobe, where cells are broad, or along it."""
    right, other = bsdf("ggx", alpha_x=0.01, alpha_y=0.8), bsdf("ggx", **wrong)

    def sample(u, wo):
        wi, _ = other.sample(u, wo)
        density = np.where(wi[:, 2] > 0, right.pdf(wi, wo), 1.0)
        return wi, right.evaluate(wi, wo) * wi[:, 2] / density

    verdict = sampling(as_bsdf(right.evaluate, pdf=right.pdf, sample=sample), seed=seed)
    assert verdict.outcome is Outcome.VIOLATED
    assert "chi-square" in verdict.message


# ----------------------------------------------------------------------------------------------- judge


def test_check_reports_every_law_and_repeats_itself():
    one, two = check(blinn_phong), check(blinn_phong)
    assert [verdict.check for verdict in one] == ["values", "reciprocity", "energy"]
    assert one.exit_code == 1
    assert one["energy"].witness == two["energy"].witness


def test_check_counts_evaluations_and_time():
    report = check(lambert(0.5))
    assert report.evaluations > 1_000_000
    assert report.seconds > 0


def test_check_doubts_everything_of_a_function_that_is_not_repeatable(rng):
    report = check(lambda wi, wo: 0.1 + 0.01 * rng.random(len(wi)))
    assert report["values"].outcome is Outcome.VIOLATED
    assert {report[law].outcome for law in ("reciprocity", "energy")} == {Outcome.INCONCLUSIVE}


def test_check_refuses_unknown_laws_and_bad_numbers():
    with pytest.raises(UnknownNameError, match="unknown law 'enrgy'; did you mean 'energy'"):
        check(lambert(1.0), laws=["enrgy"])
    with pytest.raises(ParameterError, match="seconds = 0"):
        check(lambert(1.0), seconds=0)
    with pytest.raises(ParameterError, match="tolerance = -1"):
        check(lambert(1.0), tolerance=-1)
    for wrong in (999, 1e6):
        with pytest.raises(ParameterError, match=r"evaluations = .* an integer of at least 1000, or None"):
            check(lambert(1.0), evaluations=wrong)


def timeless(data):
    if isinstance(data, dict):
        return {name: timeless(value) for name, value in data.items() if name != "seconds"}
    return [timeless(each) for each in data] if isinstance(data, list) else data


def test_a_budget_in_evaluations_makes_a_report_that_no_clock_can_change(monkeypatch):
    quick = check(blinn_phong, evaluations=50_000)
    hours = iter(range(0, 10**9, 3600))
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(hours)))
    two = check(blinn_phong, evaluations=50_000)
    assert timeless(two.to_json()) == timeless(quick.to_json())
    assert two["energy"].outcome is Outcome.VIOLATED
    assert not any("coarser" in note for note in two.notes)
    slow = check(blinn_phong)  # which believes the clock
    assert slow["values"].evaluations < quick["values"].evaluations
    assert "searches are coarser" in slow.notes[0]


def test_more_evaluations_are_a_finer_search():
    coarse, fine = (check(lambert(1.0), evaluations=count)["energy"] for count in (30_000, 1_000_000))
    assert coarse.evaluations < 40_000 < 300_000 < fine.evaluations < 700_000
    assert (coarse.outcome, fine.outcome) == (Outcome.INCONCLUSIVE, Outcome.HOLDS)
    assert coarse.details["scan_step_deg"] > 3 > 0.2 > fine.details["scan_step_deg"]
    assert check(lambert(1.0), laws=["energy"], evaluations=1 << 60)["energy"].evaluations < 16_000_000


def test_polar_gives_unit_vectors():
    w = polar([1.0, 0.5, 1e-9], [0.0, 1.0, 2.0])
    assert np.linalg.norm(w, axis=1) == pytest.approx([1, 1, 1], abs=1e-15)


def test_check_tells_its_progress():
    seen = []
    check(
        lambert(0.5), laws=["values", "reciprocity"], progress=lambda done, total: seen.append((done, total))
    )
    assert seen == [(0, 2), (1, 2)]
