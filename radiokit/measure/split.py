"""Split: slope-space rules cut at the circle cosθi = cosθo, where max(cosθi, cosθo) has its kink."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.converge import Integrand
from radiokit.measure.slope import gauss_legendre, mirrored, slope_map

__all__ = ["kinked", "split_rule"]

FloatArray = npt.NDArray[np.float64]

STEPS = (0.004, 0.002)
"""Distances from the circle, in the radial coordinate, at which second differences are taken."""

AZIMUTHS = 16
"""Places on the circle at which an integrand is looked at."""

LINEAR = 0.4
"""Second differences shrink to this or less when the step is halved: to 1/4 if smooth, to 1/2 at a kink."""

NOISE = 1e-7
"""Second differences below this share of the integrand are no kink that matters, or rounding."""


def _circle(wo: FloatArray, width: float, s: FloatArray) -> FloatArray:
    """Return ``slope_map``'s x of the circle: there the half vector's slope is ρ = tanθo cosφ = sinh y."""
    y = np.arcsinh(np.hypot(wo[0], wo[1]) / wo[2]) * np.cos(np.pi * s)
    share = np.arcsinh(np.sinh(y) / width) / np.arcsinh(np.exp(y) / width)
    share = np.clip(share, 0.0, 1.0)
    result: FloatArray = share / (1 + np.sqrt(1 - share))
    return result


def kinked(integrand: Integrand, wo: FloatArray, width: float) -> tuple[bool, int]:
    """Return whether the integrand's slope jumps at the circle cosθi = cosθo, and the evaluations.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> kinked(lambda w: np.maximum(w[:, 2], wo[2]), wo, 0.3)[0], kinked(lambda w: w[:, 2], wo, 0.3)[0]
    (True, False)
    """
    if np.hypot(wo[0], wo[1]) < 1e-6 * wo[2]:
        return False, 0  # at normal incidence the circle is a point
    s = (np.arange(AZIMUTHS) + 0.5) / (2 * AZIMUTHS)
    shift = np.array([0.0, *(sign * step for step in STEPS for sign in (-1.0, 1.0))])
    x = np.clip(_circle(wo, width, s) + shift[:, None] * _circle(wo, width, s), 0.0, 1.0)
    wi, weight, _ = slope_map(wo, width, x, s)
    flat = wi.reshape(-1, 3)
    value = np.asarray(integrand(np.concatenate([flat, mirrored(flat, wo)])), dtype=float)
    value = value.reshape(2, *x.shape, -1) * weight[..., None]
    size = np.abs(value[:, 0]).sum(axis=(0, 1))
    wide, near = (np.abs(value[:, k] + value[:, k + 1] - 2 * value[:, 0]).sum(axis=(0, 1)) for k in (1, 3))
    found = (near > LINEAR * wide) & (near > NOISE * size)
    return bool(np.any(found)), 2 * x.size


def split_rule(
    wo: FloatArray, width: float, n: tuple[int, int], *, symmetric: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Return directions and weights like ``slope_rule``, by Gauss-Legendre rules on either side of the circle.

    Parameters
    ----------
    n : (int, int)
        Nodes along each radial part, and along each of the two halves of azimuth.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> wi, weight = split_rule(wo, 1.0, (24, 24))
    >>> brighter = wi[:, 2] > wo[2]  # a cap of height 1 − cosθo
    >>> round(float(weight[brighter].sum() / (2 * np.pi)), 9)
    0.2
    """
    (u, wu), (v, wv) = gauss_legendre(n[0]), gauss_legendre(n[1])
    big_y = float(np.arcsinh(np.hypot(wo[0], wo[1]) / wo[2]))
    # Where y is less than the width, the circle runs through the lobe: nodes crowd there.
    scale = min(width / (np.pi * big_y), 0.5) if big_y > 0 else 0.5
    length = np.arcsinh(0.5 / scale)
    ahead = 0.5 - scale * np.sinh(length * v)
    d_ahead = scale * np.cosh(length * v) * length * wv
    cut = _circle(wo, width, ahead)
    pieces = (
        (cut * u[:, None], ahead, wu[:, None] * cut * d_ahead),
        (cut + (1 - cut) * u[:, None], ahead, wu[:, None] * (1 - cut) * d_ahead),
        (np.broadcast_to(u[:, None], (len(u), len(v))), 0.5 + v / 2, wu[:, None] * wv / 2),
    )
    wi, weight = _joined([(*slope_map(wo, width, x, s)[:2], w) for x, s, w in pieces])
    if symmetric:
        return wi, weight
    return np.concatenate([wi, mirrored(wi, wo)]), np.concatenate([weight, weight]) / 2


def _joined(parts: list[tuple[Any, Any, Any]]) -> tuple[FloatArray, FloatArray]:
    directions = np.concatenate([wi.reshape(-1, 3) for wi, _, _ in parts])
    return directions, np.concatenate([(weight * w).ravel() for _, weight, w in parts])
