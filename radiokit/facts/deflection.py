"""Deflection: where a smooth surface sends a direction, mirrored or refracted."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject
from radiokit.facts.triples import dot, length

__all__ = ["reflect", "refract"]

FloatArray = npt.NDArray[np.float64]


def reflect(w: FloatArray, normal: FloatArray | None = None) -> FloatArray:
    """Return the mirror directions 2(w·n)n − w of ``w`` (..., 3); ``normal`` (..., 3) is z by default.

    >>> reflect(np.array([0.6, 0.0, 0.8]))
    array([-0.6, -0. ,  0.8])
    """
    w = np.asarray(w, dtype=np.float64)
    if normal is None:
        return np.multiply(w, (-1.0, -1.0, 1.0))
    normal = np.asarray(normal, dtype=np.float64)
    result: FloatArray = 2.0 * dot(w, normal)[..., None] * normal - w
    return result


def refract(
    w: FloatArray, normal: FloatArray | None = None, *, eta: npt.ArrayLike
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return the refracted directions and where total internal reflection leaves none.

    Parameters
    ----------
    w : ndarray, shape (..., 3)
        Unit vectors away from the surface, towards where the light comes from.
    normal : ndarray, shape (..., 3)
        z by default.
    eta : array_like, shape (...)
        Index on the side that the normal leaves behind, over the index on the side that it points to
        (η_t/η_i for light from outside), in [1e-100, 1e100]. For ``w`` below the surface it is inverted.

    Returns
    -------
    direction : ndarray, shape (..., 3)
        Unit vectors away from the surface on the other side. Under total internal reflection, the limit
        at the critical angle: along the surface.
    total : ndarray of bool, shape (...)

    Raises
    ------
    ParameterError
        When ``eta`` is not in that range.

    Source: Pharr, Jakob, Humphreys (2023), Physically Based Rendering, 4th edition, section 9.3.3.

    >>> direction, total = refract(np.array([0.6, 0.0, 0.8]), eta=1.5)
    >>> [round(float(x), 6) for x in direction], bool(total)
    ([-0.4, 0.0, -0.916515], False)
    """
    allowed = "a number in [1e-100, 1e100]"
    ratio = numbers("eta", eta, allowed)
    reject("eta", ratio, np.asarray(~((ratio >= 1e-100) & (ratio <= 1e100))), allowed)
    w = np.asarray(w, dtype=np.float64)
    n = np.array([0.0, 0.0, 1.0]) if normal is None else np.asarray(normal, dtype=np.float64)
    cosine = dot(w, n)
    side = np.copysign(1.0, cosine)[..., None]
    # Indices of the far and the near side: 1/η is never rounded, so η next to 1 keeps its digits both ways.
    far = np.where(side[..., 0] > 0.0, ratio, 1.0)
    near = np.where(side[..., 0] > 0.0, 1.0, ratio)
    # The part along the surface, w − (w·n)n, from the small w ∓ n: it keeps its digits near the normal.
    offset = w - side * n
    along = offset - dot(offset, n)[..., None] * n
    sine = length(along)
    # (far cos θt)² = far² − near² sin² = far² − near² + near² cos²: each is good where the other cancels.
    by_sine = (far - near * sine) * (far + near * sine)
    by_cosine = (far - near) * (far + near) + (near * cosine) ** 2
    square = np.where((far < near) & (cosine * cosine > 0.5), by_sine, by_cosine)
    total = np.asarray(square < 0.0)
    across = np.sqrt(np.maximum(square, 0.0))[..., None]
    limit = -along / np.where(sine > 0.0, sine, 1.0)[..., None]
    direction = -(near[..., None] * along + side * across * n) / far[..., None]
    return np.where(total[..., None], limit, direction) + 0.0, total
