"""Half vectors: kernels that models of h ∝ wi + wo share, whatever they make of it.

A half vector here is the sum wi + wo itself: it is not normalised, and its length is 2 wo·ĥ.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.measure.elementary import exp, expm1, log, log1p
from radiokit.measure.kernels import kernel, select

__all__ = ["HORIZON", "cosine_power", "half_length", "power_slope", "schlick_at_half"]

HORIZON = 1e-150  # a cosine below this is 0: no unit vector tells them apart, and squares would underflow


@kernel
def half_length(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any) -> Any:
    """Return |wi + wo| = 2 wo·ĥ [1].

    >>> float(half_length(0.6, 0.0, 0.8, -0.6, 0.0, 0.8))
    1.6
    """
    x, y, z = ix + ox, iy + oy, iz + oz
    return np.sqrt(x * x + y * y + z * z)


@kernel
def cosine_power(hx: Any, hy: Any, hz: Any, exponent: Any) -> Any:
    """Return cosⁿδ [1] of a vector of any length, δ from the normal; hz above 0.

    A cosine near 1 has too few digits for a large n; (1 + tan²δ)^(−n/2) has them.

    >>> float(cosine_power(0.0, 3.0, 3.0, 2.0))
    0.5
    """
    return exp(-0.5 * exponent * log1p((hx * hx + hy * hy) / (hz * hz)))


@kernel
def power_slope(u: Any, exponent: Any) -> Any:
    """Return tanδ for cosδ = (1 − u)^(1/(n + 1)), the polar angle of a density (n + 1)/(2π) cosⁿδ [sr⁻¹].

    >>> float(power_slope(0.0, 10.0)), round(float(power_slope(0.5, 1.0)), 12)
    (0.0, 1.0)
    """
    return np.sqrt(expm1(-2.0 * log(1.0 - u) / (exponent + 1.0)))


@kernel
def schlick_at_half(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, f0: Any) -> Any:
    """Return Schlick's F0 + (1 − F0)(1 − u)⁵ [1] at the cosine u = wo·ĥ, with all digits of 1 − u.

    >>> float(schlick_at_half(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.04))
    0.04
    """
    cosine = 0.5 * half_length(ix, iy, iz, ox, oy, oz)
    x, y, z = ix - ox, iy - oy, iz - oz
    loss = 0.25 * (x * x + y * y + z * z) / (1.0 + cosine)  # (1 − u²)/(1 + u)
    loss = select(loss < 1.0, loss, 1.0)
    square = loss * loss
    return f0 + (1.0 - f0) * (square * square * loss)
