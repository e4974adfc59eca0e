"""Cosine lobes: a power of the cosine about a direction, what Phong's model and its relatives are made of."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.measure.elementary import exp, expm1, log, log1p, sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.vectors import from_frame

__all__ = ["lobe", "lobe_sample", "median_angle", "median_slope", "mirror_lobe"]


@kernel
def lobe(wx: Any, wy: Any, wz: Any, ax: Any, ay: Any, az: Any, exponent: Any) -> Any:
    """Return cosⁿα, with α the angle between the unit vectors w and a; 0 where it is obtuse.

    Near the axis, cosα has too few digits for a large n; |w − a|² = 2(1 − cosα) has them.

    >>> float(lobe(0.0, 0.6, 0.8, 0.0, 0.0, 1.0, 2.0))
    0.64
    """
    x, y, z = wx - ax, wy - ay, wz - az
    depth = 0.5 * (x * x + y * y + z * z)
    cosine = wz * az + wx * ax + wy * ay
    acute, near = cosine > 0.0, depth < 0.5
    log_cosine = select(near, log1p(-select(near, depth, 0.0)), log(select(acute, cosine, 1.0)))
    return select(acute, exp(exponent * log_cosine), 0.0)


@kernel
def mirror_lobe(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any) -> Any:
    """Return cosⁿα, with α the angle of i from the mirror direction of o; 0 below the horizon.

    >>> round(float(mirror_lobe(0.0, 0.0, 1.0, 0.6, 0.0, 0.8, 2.0)), 12)
    0.64
    """
    return select((iz > 0.0) & (oz > 0.0), lobe(ix, iy, iz, -ox, -oy, oz, exponent), 0.0)


@kernel
def lobe_sample(u0: Any, u1: Any, ax: Any, ay: Any, az: Any, exponent: Any) -> Any:
    """Return a unit vector of density (n + 1)/(2π) cosⁿα about the unit vector a.

    Source: Lafortune & Willems (1994), Using the Modified Phong Reflectance Model for Physically Based
    Rendering, KU Leuven, CW 197, section 3, the sampling of the specular lobe.

    >>> tuple(map(float, lobe_sample(0.0, 0.3, 0.0, 0.6, 0.8, 10.0)))
    (0.0, 0.6, 0.8)
    """
    loss = -expm1(log(1.0 - u0) / (exponent + 1.0))  # 1 − cosα; the difference is exact
    radius = np.sqrt(loss * (2.0 - loss))
    sine, cosine = sincos(u1)
    return from_frame(radius * cosine, radius * sine, 1.0 - loss, ax, ay, az)


def median_angle(exponent: float) -> float:
    """Return the angle α [rad] within which half of ∫ cosⁿα dω lies.

    >>> round(float(np.cos(median_angle(1.0))) ** 2, 15)
    0.5
    """
    log_cosine = -np.log(2.0) / (exponent + 1.0)
    return float(np.arctan2(np.sqrt(-np.expm1(2.0 * log_cosine)), np.exp(log_cosine)))


def median_slope(exponent: float) -> float:
    """Return the median slope of the half vectors of a lobe about the mirror direction: tan(α/2).

    >>> round(median_slope(1e4), 6)
    0.005887
    """
    return float(np.tan(0.5 * median_angle(exponent)))
