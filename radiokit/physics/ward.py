"""Ward's lobe: what the three models share that put a Gaussian of slopes about the normal.

exp(−tan²δ (cos²φ/αx² + sin²φ/αy²)) is Beckmann's D without its cosine: D = exp(−...)/(π αx αy cos⁴δ).
"""

from __future__ import annotations

from typing import Any

from radiokit.measure.kernels import kernel, select
from radiokit.physics.facet import reflect
from radiokit.physics.half import HORIZON
from radiokit.physics.ndf import beckmann_density, beckmann_normal

__all__ = ["ward_density", "ward_direction", "ward_lobe"]


@kernel
def ward_lobe(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return D [sr⁻¹], and hz² and |h|² of h = wi + wo; all 1 below the horizon, where they mean nothing.

    >>> [round(float(v), 6) for v in ward_lobe(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5)]
    [0.63662, 4.0, 4.0]
    """
    above = (iz > HORIZON) & (oz > HORIZON)
    x, y, z = ix + ox, iy + oy, select(above, iz + oz, 1.0)
    up = z * z
    density = beckmann_density(x, y, z, alpha_x, alpha_y)
    return select(above, density, 1.0), select(above, up, 1.0), select(above, x * x + y * y + up, 1.0)


@kernel
def ward_density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return the density [sr⁻¹] of ``ward_direction``, D cosδ / (4 wo·ĥ) = D hz / (2 |h|²).

    Source: Walter (2005), Notes on the Ward BRDF. Cornell University, PCG-05-06, equation 9.

    >>> round(float(ward_density(0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5)) * 2 * 3.141592653589793, 12)
    1.0
    """
    above = (iz > HORIZON) & (oz > HORIZON)
    density, _, square = ward_lobe(ix, iy, iz, ox, oy, oz, alpha_x, alpha_y)
    return select(above, 0.5 * density * (iz + oz) / square, 0.0)


@kernel
def ward_direction(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return wi about a half vector of Gaussian slopes, and whether both directions are above the horizon.

    Source: Ward (1992), equations 8 and 9, with the sine and cosine of an angle in place of its tangent.

    >>> [round(float(c), 12) for c in ward_direction(0.0, 0.5, 0.0, 0.0, 1.0, 0.3, 0.3)]
    [0.0, 0.0, 1.0, 1.0]
    """
    hx, hy, hz = beckmann_normal(u0, u1, alpha_x, alpha_y)
    wx, wy, wz = reflect(ox, oy, oz, hx, hy, hz)
    return wx, wy, wz, (wz > HORIZON) & (oz > HORIZON)
