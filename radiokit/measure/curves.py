"""Curves: where an integrand over the hemisphere may bend, as the half vector's slope at each azimuth.

With y of ``slope_map``, T = tanθo and c = cosθo, the half vector h of slope ρ has h_z = 1/√(1 + ρ²) and
o·h = c (1 + ρ sinh y)/√(1 + ρ²), and the horizon is ρ = e^y = tan β with β = π/4 + atan(sinh y)/2. Each curve
is an explicit ρ(y); where it does not run, or is left behind by another, ρ is 0 or infinite.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

__all__ = ["CURVES", "Curve", "polar_angle"]

FloatArray = npt.NDArray[np.float64]

FLAT = 1e-6
"""tanθo below which the incidence is normal."""


@dataclass(frozen=True)
class Curve:
    """A curve of the half vector's slope.

    Parameters
    ----------
    name : str
    slope : callable
        Takes T = tanθo and y (N,), returns ρ (N,).
    ends : callable
        Takes T, returns the values of y at which the curve starts, stops, or meets another.
    crossed : bool
        Whether it ends on the circle, which then bends from there on, however little.
    """

    name: str
    slope: Callable[[float, FloatArray], FloatArray]
    ends: Callable[[float], tuple[float, ...]]
    crossed: bool = False


def polar_angle(y: FloatArray) -> FloatArray:
    """Return the angle β [rad] between the normal and the half vector at the horizon: tan β = e^y.

    >>> bool(np.isclose(np.tan(polar_angle(np.array(0.3))), np.exp(0.3)))
    True
    """
    result: FloatArray = np.pi / 4 + np.arctan(np.sinh(y)) / 2
    return result


def _equal(tan_o: float, y: FloatArray) -> FloatArray:
    """Return ρ where cosθi = cosθo: tanθo cosφ = sinh y."""
    return np.maximum(np.sinh(y), 0.0) if tan_o >= FLAT else np.zeros_like(y)


def _light(tan_o: float, y: FloatArray) -> FloatArray:
    """Return ρ where 2 h_z i_z = o·h: S ρ³ + 3 ρ² − 3 S ρ − 1 = 0 for S = sinh y, at 2/3 of the angle β."""
    return np.where(y < np.arcsinh(1.0), np.tan(2 / 3 * polar_angle(y)), np.inf)


def _viewer(tan_o: float, y: FloatArray) -> FloatArray:
    """Return ρ where 2 h_z o_z = o·h: 1/sinh y. It meets the circle and the curve above at ρ = 1 = sinh y."""
    return np.where(y > np.arcsinh(1.0), 1 / np.sinh(np.maximum(y, 0.5)), np.inf)


def _mirror(tan_o: float, y: FloatArray) -> FloatArray:
    """Return ρ where wi is at right angles to the mirror direction: ρ² (2 c² cosh² y − 1) = 1."""
    steep = 2 * (np.cosh(y) ** 2 / (1 + tan_o * tan_o)) - 1
    inside = (y > _mirror_ends(tan_o)[0]) & (steep > 0) & (tan_o >= FLAT)
    return np.where(inside, 1 / np.sqrt(np.where(inside, steep, 1.0)), np.inf)


def _mirror_ends(tan_o: float) -> tuple[float, ...]:
    return (float(np.arcsinh(tan_o * tan_o / np.sqrt(1 + 2 * tan_o * tan_o))),)


def _triple(tan_o: float) -> tuple[float, ...]:
    return (float(np.arcsinh(1.0)),)


CURVES = (
    Curve("cosθi = cosθo", _equal, lambda tan_o: (0.0,)),
    Curve("2 h_z i_z = o·h", _light, _triple, crossed=True),
    Curve("2 h_z o_z = o·h", _viewer, _triple, crossed=True),
    Curve("r·i = 0", _mirror, _mirror_ends),
)
"""The circle of equal polar angles; where the two V-groove's walls begin to hide; a lobe's edge."""
