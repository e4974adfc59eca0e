"""Shading through a surface: light from the other side, by every method, in the right amount."""

from __future__ import annotations

import math

import numpy as np
import pytest

import radiokit as rk
from radiokit.measure.statistics import sidak
from radiokit.worlds.planning import METHODS

SAMPLED = ("mc-bsdf", "mc-light", "mis", "qmc")
LEVEL = sidak(1e-3, 120)
SKY = rk.emitter("constant", radiance=1.0)
DISK = rk.emitter("disk", center=(0, 0, -2), normal=(0, 0, 1), radius=1, radiance=2.0)
SHEET = rk.bsdf("lambert_transmitter", reflectance=0.3, transmittance=0.6)
GLASS = rk.bsdf("rough_dielectric", alpha=0.3)
UP, TILTED, UNDER = (0.0, 0.0, 1.0), (0.0, 0.6, 0.8), (0.0, 0.6, -0.8)


@pytest.mark.parametrize("wo", [UP, TILTED, UNDER], ids=["up", "tilted", "under"])
@pytest.mark.parametrize("f", [SHEET, GLASS, rk.bsdf("rough_dielectric", alpha=0.1, eta=0.7)], ids=repr)
def test_in_a_furnace_it_has_the_radiance_of_its_albedo(f, wo, seed):
    """Basic radiance 1 on all sides: what is reflected and what passes make the albedo of both."""
    exact = rk.albedo(f, wo)
    found = rk.shade(f, SKY, wo)
    assert found.converged
    assert abs(found.value - exact.value) <= found.error + exact.error
    for method in SAMPLED:
        sampled = rk.shade(f, SKY, wo, method=method, samples=1 << 13, rng=seed)
        assert sampled.covers(exact.value, level=1 - LEVEL), method


@pytest.mark.parametrize("f", [SHEET, GLASS, rk.bsdf("rough_dielectric", alpha=0.02)], ids=repr)
def test_methods_agree_on_a_lamp_behind(f, seed):
    wo = (0.0, 0.1, math.sqrt(0.99))
    found = rk.shade(f, DISK, wo)
    assert found.converged
    assert found.value > 0.01
    for method in SAMPLED[1:]:
        sampled = rk.shade(f, DISK, wo, method=method, samples=1 << 13, rng=seed)
        assert sampled.covers(found.value, level=1 - LEVEL), method


def test_a_sheet_passes_its_share():
    """τE/π of a disk at two radii, and of a point lamp: E = πL R²/(R² + h²), I/r²."""
    passed = rk.shade(SHEET, DISK, UP)
    assert passed.value == pytest.approx(0.6 * 2.0 / 5, rel=1e-12)
    lamp = rk.emitter("point", position=(0, 0, -2), intensity=4 * np.pi)
    assert rk.shade(SHEET, lamp, UP).value == pytest.approx(0.6, rel=1e-14)
    assert rk.shade(SHEET, lamp, (0.0, 0.6, -0.8)).value == pytest.approx(0.3, rel=1e-14)
    ground = rk.emitter("constant", radiance=1.0, normal=(0, 0, -1))
    assert rk.shade(SHEET, ground, UP).value == pytest.approx(0.6, rel=1e-12)
    assert rk.shade(SHEET, ground, UP, normal=(0, 0, -1)).value == pytest.approx(0.6, rel=1e-12)
    assert rk.shade(SHEET, ground, (0, 0, -1)).value == pytest.approx(0.3, rel=1e-12)


def test_a_sheet_has_a_closed_form_on_either_side():
    for wo in (UP, UNDER):
        for light in (SKY, DISK):
            plan = rk.explain(SHEET, light, wo)
            assert [row.method for row in plan.rows] == ["closed form", "closed form"]
            exact = rk.shade(SHEET, light, wo)
            found = rk.shade(SHEET, light, wo, method="quadrature")
            assert exact.kind == "rounding"
            assert abs(exact.value - found.value) <= exact.error + found.error
    colours = rk.bsdf("lambert_transmitter", reflectance=(0.1, 0.2), transmittance=(0.3, 0.4))
    assert rk.shade(colours, SKY, UP).value == pytest.approx([0.4, 0.6], rel=1e-14)


def test_a_surface_turned_over_is_the_same_sheet():
    tilt = rk.emitter("sphere", center=(1, 0.5, -2), radius=0.7, radiance=3.0)
    one = rk.shade(SHEET, tilt, TILTED, normal=(0.3, 0.1, 0.9))
    other = rk.shade(SHEET, tilt, TILTED, normal=(-0.3, -0.1, -0.9))
    assert abs(one.value - other.value) <= one.error + other.error


def test_what_only_reflects_is_left_alone():
    plan = rk.explain(rk.bsdf("ggx"), [SKY, DISK], TILTED)
    assert len(plan.rows) == 2
    both = rk.explain(GLASS, [SKY, DISK], TILTED)
    assert [row.name for row in both.rows] == [
        "constant, smooth",
        "constant, smooth, through the surface",
        "disk, smooth",
        "disk, smooth, through the surface",
    ]
    assert "no sample sees any light" in str(both)
    assert "inf" not in str(both)
    assert set(METHODS) >= {cost.method for row in both.rows for cost in row.costs}


def test_forgotten_squares_of_the_index_are_seen():
    """Planted: radiance in place of basic radiance would be off by η² or 1/η²."""
    passed = rk.shade(GLASS, rk.emitter("constant", radiance=1.0, normal=(0, 0, -1)), UP)
    share = rk.albedo(GLASS, UP, side="transmitted")
    assert abs(passed.value - share.value) <= passed.error + share.error
    assert abs(1.5**2 * passed.value - share.value) > 0.1
