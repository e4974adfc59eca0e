"""Vectors as three numbers each: what kernels do with directions."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.measure.elementary import sincos
from radiokit.measure.kernels import kernel, select

__all__ = ["even", "from_disk", "from_frame", "leaning"]


@kernel
def from_disk(u0: Any, u1: Any) -> Any:
    """Return a cosine-distributed unit vector: its projection x, y is uniform in the unit disk.

    Squares about the centre become circles, so that points that fill the square evenly fill the disk so too.

    Source: Shirley & Chiu (1997), A Low Distortion Map Between Disk and Square, Journal of Graphics Tools
    2(3), doi:10.1080/10867651.1997.10487479.

    >>> tuple(map(float, from_disk(0.5, 0.5)))
    (0.0, 0.0, 1.0)
    """
    a, b = 2.0 * u0 - 1.0, 2.0 * u1 - 1.0
    first = abs(a) > abs(b)
    radius, other = select(first, a, b), select(first, b, a)
    sine, cosine = sincos(0.125 * other / select(radius == 0.0, 1.0, radius))
    x, y = radius * select(first, cosine, sine), radius * select(first, sine, cosine)
    return x, y, np.sqrt((1.0 - radius) * (1.0 + radius))


@kernel
def from_frame(a: Any, b: Any, c: Any, nx: Any, ny: Any, nz: Any) -> Any:
    """Return the vector with components a, b, c in the frame whose third axis is the unit vector n.

    Source: Duff et al. (2017), Building an Orthonormal Basis, Revisited, Journal of Computer Graphics
    Techniques 6(1), listing 3.

    >>> tuple(map(float, from_frame(1.0, 2.0, 3.0, 0.0, 0.0, 1.0)))
    (1.0, 2.0, 3.0)
    """
    sign = select(nz < 0.0, -1.0, 1.0)
    d = -1.0 / (sign + nz)  # |sign + nz| ≥ 1: nothing to cancel
    e = nx * ny * d
    x = a * (1.0 + sign * nx * nx * d) + b * e + c * nx
    y = a * (sign * e) + b * (sign + ny * ny * d) + c * ny
    return x, y, c * nz - a * sign * nx - b * ny


@kernel
def even(x: Any, y: Any, z: Any) -> Any:
    """Turn a cosine-distributed unit vector into one distributed evenly over the hemisphere.

    The share 1 − z² of the cosine's distribution lies above z, and 1 − z' of the even one above z': z' = z².

    >>> tuple(map(float, even(0.6, 0.0, 0.8)))[2] == 0.8 * 0.8
    True
    """
    scale = np.sqrt(1.0 + z * z)
    return x * scale, y * scale, z * z


@kernel
def leaning(x: Any, y: Any, z: Any, ox: Any, oy: Any) -> Any:
    """Turn a cosine-distributed unit vector into one of density (2/π) max(0, w·t) above the horizon.

    The lobe lies about t, the horizontal direction of (ox, oy), and its lower half is folded upwards.

    >>> tuple(map(float, leaning(0.0, 0.0, 1.0, 0.0, 3.0)))
    (0.0, 1.0, 0.0)
    """
    length = np.sqrt(ox * ox + oy * oy)
    tx = select(length > 0.0, ox / select(length > 0.0, length, 1.0), 1.0)
    ty = select(length > 0.0, oy / select(length > 0.0, length, 1.0), 0.0)
    return z * tx - x * ty, z * ty + x * tx, abs(y)
