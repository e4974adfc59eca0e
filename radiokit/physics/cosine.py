"""Cosine lobes: cosⁿα about a direction, as kernels that the Phong family shares."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.measure.elementary import exp, expm1, log, log1p, sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.vectors import from_frame

__all__ = ["about", "median_slope", "mirror_lobe"]


@kernel
def mirror_lobe(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any) -> Any:
    """Return cosⁿα, α from the mirror direction of o, or 0 below the horizon.

    Near the mirror direction r, cosα has too few digits for a large n; |r − wi|² = 2(1 − cosα) has them.

    >>> round(float(mirror_lobe(0.0, 0.0, 1.0, 0.6, 0.0, 0.8, 2.0)), 12)
    0.64
    """
    x, y, z = ix + ox, iy + oy, iz - oz
    depth = 0.5 * (x * x + y * y + z * z)
    cosine = iz * oz - ix * ox - iy * oy
    lit = (cosine > 0.0) & (iz > 0.0) & (oz > 0.0)
    near = depth < 0.5
    log_cosine = select(near, log1p(-select(near, depth, 0.0)), log(select(lit, cosine, 1.0)))
    return select(lit, exp(exponent * log_cosine), 0.0)


@kernel
def about(u0: Any, u1: Any, nx: Any, ny: Any, nz: Any, exponent: Any) -> Any:
    """Return a unit vector (wx, wy, wz) of density (n + 1)/(2π) cosⁿα [sr⁻¹] about the unit vector n.

    >>> [float(c) for c in about(0.0, 0.3, 0.0, 0.0, 1.0, 10.0)]
    [0.0, 0.0, 1.0]
    """
    loss = -expm1(log(1.0 - u0) / (exponent + 1.0))  # 1 − cosα; the difference is exact
    radius = np.sqrt(loss * (2.0 - loss))
    sine, cosine = sincos(u1)
    return from_frame(radius * cosine, radius * sine, 1.0 - loss, nx, ny, nz)


def median_slope(exponent: float) -> float:
    """Return the median slope of the half vectors, tan(α/2) for half the lobe's flux within α.

    >>> round(median_slope(1e4), 6)
    0.005887
    """
    log_cosine = -np.log(2.0) / (exponent + 1.0)
    alpha = np.arctan2(np.sqrt(-np.expm1(2.0 * log_cosine)), np.exp(log_cosine))
    return float(np.tan(0.5 * alpha))
