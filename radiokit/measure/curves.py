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

__all__ = ["CURVES", "Curve", "critical", "polar_angle"]

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
    rooted : bool
        Whether an integrand goes as the root of the distance from it, and not just bends.
    """

    name: str
    slope: Callable[[float, FloatArray], FloatArray]
    ends: Callable[[float], tuple[float, ...]]
    crossed: bool = False
    rooted: bool = False


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


def critical(cosine: float) -> tuple[Curve, Curve]:
    """Return where facets begin, and cease, to be hit at an angle of incidence: o·h = ``cosine``.

    Where that is the critical angle of total reflection, Fresnel's reflectance goes as a root beside it. In ρ
    the equation is quadratic; where o·h comes near its largest value c cosh y, at ρ = sinh y, the two meet.

    >>> wo_tangent, y = 0.75, np.array([0.3])
    >>> rho = critical(0.7)[1].slope(wo_tangent, y)
    >>> h_z = 1 / np.sqrt(1 + rho**2)
    >>> round(float((0.8 * h_z * (1 + rho * np.sinh(y)))[0]), 12)
    0.7
    """

    def parts(tan_o: float, y: FloatArray) -> tuple[float, FloatArray, FloatArray]:
        c, sine = 1 / np.sqrt(1 + tan_o * tan_o), np.sinh(y)
        spread = (c * np.cosh(y) - cosine) * (c * np.cosh(y) + cosine)
        return float((c - cosine) * (c + cosine)), c * sine, spread

    def begin(tan_o: float, y: FloatArray) -> FloatArray:
        inner, lean, spread = parts(tan_o, y)
        if inner >= 0:  # facets along the normal are hit more steeply still
            return np.zeros_like(y)
        seen = (lean > 0) & (spread >= 0)
        steep = lean / np.sqrt(1 + tan_o * tan_o) + cosine * np.sqrt(np.maximum(spread, 0.0))
        return np.where(seen, -inner / np.where(seen, steep, 1.0), np.inf)

    def cease(tan_o: float, y: FloatArray) -> FloatArray:
        inner, lean, spread = parts(tan_o, y)
        steep = np.abs(lean) / np.sqrt(1 + tan_o * tan_o) + cosine * np.sqrt(np.maximum(spread, 0.0))
        rest = (cosine - lean) * (cosine + lean)
        ahead = (lean >= 0) & (spread >= 0) & (rest > 0)
        behind = (lean < 0) & (inner > 0)
        found = np.where(ahead, steep / np.where(ahead, rest, 1.0), np.inf)
        return np.where(behind, inner / np.where(steep > 0, steep, 1.0), found)

    def ends(tan_o: float) -> tuple[float, ...]:
        ratio = cosine * float(np.sqrt(1 + tan_o * tan_o))  # cosθc/cosθo
        met = (float(np.arccosh(ratio)),) if ratio > 1 else ()
        level = 4 * ratio * ratio - 1  # e^2y where the curve goes below the horizon
        return (*met, 0.5 * float(np.log(level))) if level > 0 else met

    return (
        Curve("o·h rises to the critical cosine", begin, ends, rooted=True),
        Curve("o·h falls to the critical cosine", cease, ends, rooted=True),
    )
