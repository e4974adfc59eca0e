"""Polar: rules in polar angle and azimuth, cut where a rough diffuse surface's f bends."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import numpy.typing as npt

from radiokit.measure.slope import gauss_legendre

__all__ = ["POLAR_SIZES", "polar_rule"]

FloatArray = npt.NDArray[np.float64]

POLAR_SIZES = (8, 12, 16, 24, 32, 48, 64)
"""Nodes along each side of a piece."""


def polar_rule(wo: FloatArray, n: int, *, symmetric: bool = False) -> tuple[FloatArray, FloatArray]:
    """Return directions (N, 3) and weights (N,) that integrate over the upper hemisphere.

    Gauss-Legendre rules in θ and φ between the places where max(θi, θo) and max(0, cos Δφ) bend: the
    circle θi = θo, and the azimuths at right angles to that of ``wo``. With ``symmetric`` one half of the
    azimuths stands for both.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> wi, weight = polar_rule(wo, 16)
    >>> bent = np.maximum(wi[:, 0], 0) * np.maximum(wi[:, 2], wo[2])
    >>> theta = np.arctan2(0.6, 0.8)  # ∫ sin²θ max(cosθ, cosθo) dθ, times ∫ cosφ dφ over the front
    >>> exact = 2 * (0.6**3 / 3 + 0.4 * (np.pi / 2 - theta + 0.48))
    >>> bool(abs(weight @ bent - exact) < 1e-14)
    True
    """
    u, wu = gauss_legendre(n)
    across = float(np.hypot(wo[0], wo[1]))
    cut = float(np.arctan2(across, wo[2]))
    theta, w_theta = _pieces((0.0, cut, 0.5 * np.pi), u, wu)
    quarters = (0.0, 0.5 * np.pi, np.pi) if symmetric else (0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi, 2 * np.pi)
    phi, w_phi = _pieces(quarters, u, wu)
    sine, cosine = np.sin(theta)[:, None], np.cos(theta)[:, None]
    x, y = (wo[0] / across, wo[1] / across) if across > 0 else (1.0, 0.0)
    a, b = np.cos(phi), np.sin(phi)
    shape = (len(theta), len(phi))
    columns = (sine * (a * x - b * y), sine * (a * y + b * x), np.broadcast_to(cosine, shape))
    weight = w_theta[:, None] * sine * w_phi * (2.0 if symmetric else 1.0)
    return np.stack(columns, axis=-1).reshape(-1, 3), weight.ravel()


def _pieces(ends: tuple[float, ...], u: FloatArray, wu: FloatArray) -> tuple[FloatArray, FloatArray]:
    pieces = [(low, high - low) for low, high in pairwise(ends) if high > low]
    places = [low + span * u for low, span in pieces]
    return np.concatenate(places), np.concatenate([span * wu for _, span in pieces])
