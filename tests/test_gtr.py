"""GTR of exponent 1 against the paper's formulas at 50 digits, and its samples against their density."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy

from radiokit.measure.quadrature import box
from radiokit.measure.twin import Twin, scaled_ulps
from radiokit.physics.gtr import gtr1_constants, gtr1_d_symbolic, gtr1_density, gtr1_normal

A, U = sympy.symbols("alpha u", positive=True)
H = sympy.symbols("h_x h_y h_z", real=True)
WIDTHS = (1e-4, 1e-3, 0.0505, 0.1, 0.49, 0.51, 0.9, 1 - 1e-6)
TILTS = (0.0, 1e-9, 1e-4, 1e-2, 0.3, 1.0, 30.0, 1e4)
LEVELS = (0.0, 1e-12, 1e-3, 0.5, 0.9, 1 - 1e-9, 1 - 2**-53)
LIMIT = 8


def density_error(density: Any, alpha: float) -> float:
    """Return the worst error of a density, in ulps over max(1, condition)."""
    twin = Twin(gtr1_d_symbolic(H, A), {A: alpha}, arguments=H)
    rows = [(0.6 * slope * z, 0.8 * slope * z, z) for slope in TILTS for z in (1.0, 1e-100)]
    found = density(*np.array(rows).T)
    exact, condition = [twin.at(*row) for row in rows], [twin.condition_at(*row) for row in rows]
    return float(np.max(scaled_ulps(found, exact, condition)))


@pytest.mark.parametrize("alpha", WIDTHS)
def test_the_density_is_the_papers(alpha):
    scale, _ = gtr1_constants(alpha)
    assert density_error(lambda x, y, z: gtr1_density(x, y, z, alpha, scale), alpha) <= LIMIT


def test_the_common_form_is_rejected():
    """Planted: 1 + (α² − 1) cos²θ, which loses 6 digits at α = 1e-4."""

    def common(x, y, z):
        cos2 = z * z / (x * x + y * y + z * z)
        return (1e-8 - 1) / (np.pi * np.log(1e-8) * (1 + (1e-8 - 1) * cos2))

    assert density_error(common, 1e-4) > 1e4


@pytest.mark.parametrize("alpha", WIDTHS)
def test_a_normals_angle_is_the_papers(alpha):
    cos2 = (1 - (A**2) ** (1 - U)) / (1 - A**2)
    twin = Twin((1 - cos2) / cos2, {A: alpha}, arguments=(U,))
    x, y, z = gtr1_normal(np.array(LEVELS), 0.25, alpha, gtr1_constants(alpha)[1])
    np.testing.assert_array_less(np.abs(x), 1e-15 + 0.0 * y)
    exact, condition = [twin.at(u) for u in LEVELS], [twin.condition_at(u) for u in LEVELS]
    assert np.max(scaled_ulps((y / z) ** 2, exact, condition)) <= 2 * LIMIT


@pytest.mark.parametrize("alpha", WIDTHS)
def test_normals_follow_the_density_times_the_cosine(alpha):
    """The share of normals within the angle of each level is the level: ∫ D cosθ dω, in t = log tanθ."""
    scale, log_square = gtr1_constants(alpha)
    for level in (0.1, 0.5, 0.9):
        x, y, z = (float(c) for c in gtr1_normal(level, 0.25, alpha, log_square))
        end = np.arcsinh(np.hypot(x, y) / z / alpha)

        def ring(points: np.ndarray) -> np.ndarray:
            slope = alpha * np.sinh(points[:, 0])
            cosine = 1 / np.sqrt(1 + slope**2)
            return (
                gtr1_density(slope, 0.0, 1.0, alpha, scale)
                * cosine
                * slope
                * cosine**3
                * (alpha * np.cosh(points[:, 0]))
            )

        found = box(ring, (0.0, 0.0), (end, 2 * np.pi), rtol=1e-10)
        assert abs(found.value - level) <= found.error + 1e-12
