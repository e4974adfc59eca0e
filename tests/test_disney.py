"""What only the principled BRDF has: tints, lobes that are chosen, and an energy balance that is measured."""

from __future__ import annotations

import numpy as np
import pytest

import radiokit as rk
from radiokit.bsdfs.disney import Disney
from radiokit.checks.energy import energy
from radiokit.contracts.lobes import SCAN_DEG, WeightedLobe, lobes_albedo, lobes_conserve
from radiokit.faces.plots.lobe_mesh import _peak
from radiokit.facts.directions import reflect, spherical_to_cartesian, unit
from radiokit.facts.verdict import Outcome

TINTED = {"specular_tint": 1.0, "sheen": 1.0, "sheen_tint": 0.5, "metallic": 0.2, "subsurface": 0.3}


def directions(rng: np.random.Generator, count: int = 64) -> tuple[np.ndarray, np.ndarray]:
    wi, wo = (unit(np.abs(rng.normal(size=(count, 3)))) for _ in range(2))
    return wi, wo


@pytest.mark.parametrize(
    "color", [(0.9, 0.4, 0.2), (0.0, 0.0, 1.0), (0.2, 0.4, 0.6, 0.8), (0.5,), (0.0, 0.0)]
)
def test_a_wavelength_keeps_the_tint_that_it_has_among_the_others(color, rng):
    f = Disney(base_color=color, **TINTED)
    wi, wo = directions(rng)
    u = rng.random((len(wo), 3))
    for k in range(len(color)):
        one = f.wavelength(k)
        np.testing.assert_array_equal(one.evaluate(wi, wo), f.evaluate(wi, wo)[:, k])
        np.testing.assert_array_equal(one.sample(u, wo)[1], f.sample(u, wo)[1][:, k])
        assert one.wavelength(0) == one


@pytest.mark.parametrize(
    ("color", "luminance"),
    [((0.9, 0.4, 0.2), 0.3 * 0.9 + 0.6 * 0.4 + 0.1 * 0.2), ((0.2, 0.4, 0.6, 0.8), 0.5), ((0.7,), 0.7)],
)
def test_the_tint_is_the_colour_over_its_luminance(color, luminance):
    """At normal incidence a gloss alone, of a black body, shows it: f = 0.08 tint D / 4."""
    f = Disney(base_color=color, subsurface=1.0, specular=1.0, specular_tint=1.0)
    plain = Disney(base_color=color, subsurface=1.0, specular=1.0)
    up = np.array([[0.0, 0.0, 1.0]])
    gloss = plain.evaluate(up, up) - Disney(base_color=color, subsurface=1.0, specular=0.0).evaluate(up, up)
    found = f.evaluate(up, up) - plain.evaluate(up, up)
    np.testing.assert_allclose(found, gloss * (np.array(color) / luminance - 1), atol=1e-14)


def test_one_number_has_no_hue(rng):
    wi, wo = directions(rng)
    one, other = Disney(base_color=0.3, sheen=1.0), Disney(base_color=0.3, sheen=1.0, sheen_tint=0.0)
    np.testing.assert_allclose(one.evaluate(wi, wo), other.evaluate(wi, wo), rtol=1e-14)


@pytest.mark.parametrize("theta_deg", [0.0, 60.0, 89.0])
@pytest.mark.parametrize(
    "lobe", [{"metallic": 1.0}, {"clearcoat": 1.0}, {"sheen": 1.0}, {"anisotropic": 1.0}]
)
def test_weights_are_bounded(lobe, theta_deg, rng):
    """No weight is above what one lobe's is over the chance that it is chosen."""
    f = Disney(**({"base_color": 1.0, "roughness": 0.1} | lobe))
    wo = np.tile(spherical_to_cartesian(np.radians(theta_deg), 0.4), (1 << 14, 1))
    assert f.sample(rng.random((len(wo), 3)), wo)[1].max() < 8


def test_the_widths_are_the_sources():
    metal = Disney(metallic=1.0, roughness=1.0, anisotropic=1.0)
    assert not metal.isotropic
    assert metal.lobe_width() == pytest.approx(0.1**0.5)
    assert Disney(roughness=0.0, anisotropic=1.0).isotropic  # both are held at 0.001
    assert Disney(clearcoat=1.0).lobe_width() == pytest.approx(0.001)


# Three uniform numbers, wherever a sampler is called


@pytest.mark.parametrize("method", ["mc-bsdf", "mis", "qmc"])
def test_a_point_is_shaded_by_samples_of_three_numbers(method, seed):
    f = Disney(base_color=0.6, roughness=0.5, clearcoat=1.0, clearcoat_gloss=0.0)
    lamp = rk.emitter("constant", radiance=1.0)
    wo = (0.6, 0.0, 0.8)
    found = rk.shade(f, lamp, wo, method=method, samples=1 << 13, rng=seed)
    exact = rk.albedo(f, wo)
    assert abs(found.value - exact.value) <= 6 * found.error + exact.error


def test_paths_in_a_closed_room_take_three_numbers_a_bounce(seed):
    found = rk.enclosure_radiance(Disney(), emitted=1.0, samples=1 << 10, rng=seed)
    assert 1.0 < found.value < 1 / (1 - 0.58)


def test_a_lobe_is_found_and_drawn():
    f = Disney(metallic=1.0, roughness=0.4, anisotropic=0.8)
    wo = spherical_to_cartesian(np.radians(60.0), 0.0)
    pole = _peak(f, wo, lambda w: f.evaluate(w, np.broadcast_to(wo, w.shape)))
    assert f(pole, wo) >= f(reflect(wo), wo)


# Energy

LIMITS = (
    ({}, 0.9121254),
    ({"roughness": 1.0}, 0.6142628),
    ({"metallic": 0.5, "roughness": 0.0, "clearcoat": 1.0}, 0.9823256),
)


@pytest.mark.parametrize(("parameters", "limit"), LIMITS)
def test_the_claim_turns_where_the_judge_does(parameters, limit):
    """The base colour above which energy is gained, by the model and by the judge, to 1e-6."""
    for color, conserves in ((limit - 1e-6, True), (limit + 1e-6, False)):
        f = Disney(base_color=color, **parameters)
        verdict = energy(f, reciprocal=True)
        assert f.claims.conserves == conserves
        assert verdict.outcome is (Outcome.HOLDS if conserves else Outcome.VIOLATED), str(verdict)


def test_a_metal_conserves_unless_its_widths_differ():
    assert all(Disney(base_color=1.0, metallic=1.0, roughness=r).claims.conserves for r in (0.0, 0.3, 1.0))
    long = Disney(base_color=1.0, metallic=1.0, roughness=1.0, anisotropic=1.0)
    assert not long.claims.conserves
    verdict = energy(long, reciprocal=True)
    assert verdict.estimate is not None
    assert verdict.estimate.value == pytest.approx(1.6329462, abs=1e-3)  # along x, which the scan must find


def test_the_largest_of_many_wavelengths_decides():
    assert Disney(base_color=(0.5, 0.9, 0.6), sheen_tint=0.0).claims.conserves
    assert not Disney(base_color=(0.5, 0.95, 0.6)).claims.conserves


# The tool


def bump(theta_deg: float, width_deg: float, height: float) -> WeightedLobe:
    """Return a lobe whose albedo is 0.995, and ``height`` more at one angle."""

    def evaluate(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        angle = np.degrees(np.arctan2(np.hypot(wo[:, 0], wo[:, 1]), wo[:, 2]))
        return ((0.995 + height * np.exp(-(((angle - theta_deg) / width_deg) ** 2))) / np.pi)[:, None]

    return WeightedLobe(evaluate, 1.0, np.ones((1, 1)))


@pytest.mark.parametrize("theta_deg", [0.0, 41.234, 77.7, 89.99])
def test_a_small_gain_at_one_angle_is_found(theta_deg):
    assert lobes_conserve([bump(theta_deg, 6.0, 0.005 - 1e-7)])
    assert not lobes_conserve([bump(theta_deg, 6.0, 0.005 + 1e-7)])


def test_a_scan_that_stops_early_is_rejected(monkeypatch):
    """Planted: the scan's last rows are missing, and a gain at grazing is not seen."""
    monkeypatch.setattr("radiokit.contracts.lobes.SCAN_DEG", SCAN_DEG[:20])
    assert lobes_conserve([bump(89.99, 6.0, 0.1)])


def test_lobes_add_up_to_the_models_albedo():
    whole = Disney(base_color=0.7, clearcoat=1.0, sheen=1.0, roughness=0.3, anisotropic=0.9)
    lobe = WeightedLobe(lambda wi, wo: whole.evaluate(wi, wo)[:, None], 0.01, np.ones((1, 1)), 5.0)
    metal = Disney(base_color=1.0, metallic=1.0, roughness=1.0)
    rough = WeightedLobe(lambda wi, wo: metal.evaluate(wi, wo)[:, None], 1.0, np.ones((1, 1)))
    two = lobes_albedo([lobe, rough], 60.0, 20.0, 104)
    parts = [lobes_albedo([each], 60.0, 20.0, 104) for each in (lobe, rough)]
    np.testing.assert_allclose(two, sum(parts), rtol=1e-14)
    np.testing.assert_allclose(parts[1], 2 * (1 - np.log(2)) / 1.5, rtol=1e-10)
