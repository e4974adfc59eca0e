"""Slope space: directions and weights that resolve a reflection lobe of any width up to the horizon."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.measure.gauss import gauss_legendre

__all__ = [
    "Lobe",
    "find_lobe",
    "mirrored",
    "slope_inverse",
    "slope_map",
    "slope_rule",
    "turned",
]

FloatArray = npt.NDArray[np.float64]

PROBE = (48, 16)
"""Radii and azimuths at which an unknown integrand is looked at for its lobe."""
PROBE_WIDTH = 1e-5
KEPT = 2100
"""Nodes of the largest rule that is kept for the next integral at the same angle and width: 8 MB in all."""

RETRO = 0.1
"""How much more mass must be seen around ``wo`` than around its mirror direction to aim there."""


def slope_map(
    wo: FloatArray, width: npt.ArrayLike, x: FloatArray, s: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Map the unit square's (x, s) to directions on one side of the plane of incidence.

    With T = tanθo and y = asinh(T) cos(π s), the azimuth of the half vector's slope is cosφ = sinh(y)/T.
    The cosine of the incident direction is then cosθo (e^y − ρ)(ρ + e^−y)/(1 + ρ²), so that the horizon is
    exactly ρ = e^y; the radius runs over it as ρ = w sinh(L x (2 − x)).

    Parameters
    ----------
    wo : ndarray, broadcastable with ``x``, shape (..., 3)
        Unit vectors above the horizon.
    width : array_like
        The lobe's width w in slope, > 0.
    x, s : ndarray, shape (...)
        Points of the unit square.

    Returns
    -------
    wi : ndarray, shape (..., 3)
        Unit vectors. Mirror them at the plane of incidence with ``slope_rule`` for the other half.
    weight : ndarray, shape (...)
        Solid angle per unit of x and s [sr], for both halves together.
    rho : ndarray, shape (...)
        The half vector's slope.
    """
    width = np.asarray(width, dtype=float)
    cos_o = wo[..., 2]
    sin_o = np.hypot(wo[..., 0], wo[..., 1])
    tan_o = sin_o / cos_o
    angle = np.pi * s
    big_y = np.arcsinh(tan_o)
    y = big_y * np.cos(angle)
    low, high = big_y * np.sin(angle / 2) ** 2, big_y * np.cos(angle / 2) ** 2  # (Y ∓ y)/2
    root = 2 * np.sqrt(np.sinh(low) * np.cosh(high) * np.sinh(high) * np.cosh(low))  # tanθo sinφ
    flat = tan_o < 1e-6  # the limit of normal incidence, where sinh(y)/tanθo is 0/0
    safe_tan, safe_root = np.where(flat, 1.0, tan_o), np.where(flat | (root == 0), 1.0, root)
    cos_phi = np.where(flat, np.cos(angle), np.sinh(y) / safe_tan)
    sin_phi = np.where(flat, np.sin(angle), root / safe_tan)
    jacobian = np.where(flat, 1.0, big_y * np.cosh(y) * np.sin(angle) / safe_root)

    edge = np.exp(y)
    length = np.arcsinh(edge / width)
    t = length * (x * (2 - x))
    rho = width * np.sinh(t)
    gap = 2 * width * np.cosh((length + t) / 2) * np.sinh(length * (1 - x) ** 2 / 2)  # e^y − ρ
    square = 1 + rho * rho
    inner = 1 + rho * np.sinh(y)  # (wo·h) √(1 + ρ²) / cosθo
    lift = 2 * cos_o * inner / square
    # In the plane of incidence, then turned to the azimuth of wo.
    along, across = lift * rho * cos_phi - sin_o, lift * rho * sin_phi
    upright = sin_o == 0
    radius = np.where(upright, 1.0, sin_o)
    c = np.where(upright, 1.0, wo[..., 0] / radius)
    d = np.where(upright, 0.0, wo[..., 1] / radius)
    wi = np.stack(
        [
            c * along - d * across,
            d * along + c * across,
            cos_o * gap * (rho + 1 / edge) / square,
        ],
        axis=-1,
    )
    radial = width * np.cosh(t) * length * (1 - x)
    weight = 16 * np.pi * cos_o * inner * rho / (square * square) * radial * jacobian
    return wi, weight, rho


def slope_rule(
    wo: npt.ArrayLike,
    width: npt.ArrayLike,
    n: int | tuple[int, int],
    *,
    symmetric: bool = False,
) -> tuple[FloatArray, FloatArray]:
    """Return directions and solid-angle weights that resolve a lobe around the mirror direction of ``wo``.

    Gauss-Legendre in the radius and a midpoint rule in the azimuth of ``slope_map``: no node is wasted
    below the horizon and no kink is left, so the rule converges geometrically for smooth lobes.

    Parameters
    ----------
    wo : array_like, shape (3,) or (M, 3)
        Unit vectors above the horizon.
    width : float or array_like, shape (M,)
        The lobe's width in slope, > 0: α of a microfacet model, 1 for a diffuse one. A width wrong by a
        factor of 4 still converges, with about twice the nodes along each axis.
    n : int or (int, int)
        Nodes along the radius and the azimuth.
    symmetric : bool
        Whether the integrand is even in the azimuth relative to ``wo``; half the nodes then suffice.

    Returns
    -------
    wi : ndarray, shape (N, 3) or (M, N, 3)
        Unit vectors; N is twice the number of nodes unless ``symmetric``.
    weight : ndarray, shape (N,) or (M, N)
        Weights [sr]; they sum to 2π for a converged rule.

    Raises
    ------
    ParameterError
        When ``wo`` is not above the horizon or ``width`` is not positive.

    >>> wi, weight = slope_rule((0.6, 0.0, 0.8), 1.0, 48)
    >>> round(float(weight @ wi[:, 2]), 9)  # ∫ cosθ dω = π
    3.141592654
    """
    wo = np.asarray(wo, dtype=float)
    if not np.all(wo[..., 2] > 0):
        raise ParameterError("wo", wo.tolist(), "above the horizon (z > 0)")
    width = np.broadcast_to(np.asarray(width, dtype=float), wo.shape[:-1])
    if not np.all(width > 0):
        raise ParameterError("width", width.tolist(), "greater than 0")
    radial, azimuthal = (n, n) if isinstance(n, int) else n
    if wo.ndim == 1 and radial * azimuthal <= KEPT:
        polar = float(wo[2]), float(np.hypot(wo[0], wo[1]))
        plane, weight = _kept(*polar, float(width), radial, azimuthal)
        wi = _turned_to(plane, wo, polar[1])
    else:
        wi, weight, _ = _grid(wo, width, n)
    if not symmetric:
        wi = np.concatenate([wi, mirrored(wi, wo[..., None, :])], axis=-2)
        weight = np.concatenate([weight, weight], axis=-1) / 2
    return wi, weight


@lru_cache(maxsize=128)
def _kept(
    cos_o: float, sin_o: float, width: float, radial: int, azimuthal: int
) -> tuple[FloatArray, FloatArray]:
    """Keep a small rule for a polar angle: the directions, as rows, where wo has the azimuth 0."""
    wi, weight, _ = _grid(np.array([sin_o, 0.0, cos_o]), np.asarray(width), (radial, azimuthal))
    plane = np.ascontiguousarray(wi.T)
    plane.setflags(write=False)
    weight.setflags(write=False)
    return plane, weight


def _turned_to(plane: FloatArray, wo: FloatArray, sin_o: float) -> FloatArray:
    """Turn rows of directions about the normal, to the azimuth of ``wo``."""
    c, d = (1.0, 0.0) if sin_o == 0 else (wo[0] / sin_o, wo[1] / sin_o)
    wi = np.empty((plane.shape[1], 3))
    wi[:, 0] = plane[0] if d == 0 and c == 1 else c * plane[0] - d * plane[1]
    wi[:, 1] = plane[1] if d == 0 and c == 1 else d * plane[0] + c * plane[1]
    wi[:, 2] = plane[2]
    return wi


def mirrored(wi: FloatArray, wo: FloatArray) -> FloatArray:
    """Return ``wi`` mirrored at the plane that holds ``wo`` and the normal."""
    radius = np.hypot(wo[..., 0], wo[..., 1])
    upright = radius == 0
    safe = np.where(upright, 1.0, radius)
    across_x = np.where(upright, 0.0, -wo[..., 1] / safe)
    across_y = np.where(upright, 1.0, wo[..., 0] / safe)
    twice = 2 * (wi[..., 0] * across_x + wi[..., 1] * across_y)
    return np.stack([wi[..., 0] - twice * across_x, wi[..., 1] - twice * across_y, wi[..., 2]], axis=-1)


def _grid(
    wo: FloatArray, width: FloatArray, n: int | tuple[int, int]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    radial, azimuthal = (n, n) if isinstance(n, int) else n
    x, wx = gauss_legendre(radial)
    s = (np.arange(azimuthal) + 0.5) / azimuthal
    wi, weight, rho = slope_map(wo[..., None, None, :], width[..., None, None], x[:, None], s)
    weight = weight * (wx[:, None] / azimuthal)
    size = (*wo.shape[:-1], radial * azimuthal)
    return wi.reshape(*size, 3), weight.reshape(size), np.broadcast_to(rho, weight.shape).reshape(size)


@dataclass(frozen=True)
class Lobe:
    """Where an unknown integrand has its mass: the width in slope, and whether around ``wo`` itself.

    ``core`` is the width of the narrowest part that matters, where lobes of different widths add up.
    ``retro`` says that the lobe lies around ``wo`` and not around its mirror direction; turning every
    direction by half a turn about the normal exchanges the two.
    """

    width: float
    core: float
    retro: bool
    evaluations: int


def find_lobe(
    integrand: Callable[[FloatArray], Any],
    wo: npt.ArrayLike,
    probe: tuple[int, int] = PROBE,
    *,
    around: tuple[bool, ...] = (False, True),
) -> Lobe:
    """Find the lobe at which ``slope_rule`` should aim for an unknown integrand.

    The width is the median slope of the half vector under the integrand's own mass, seen by a rule whose
    radii are spread evenly over five decades. It is α for GGX, and about 0.5 for a diffuse lobe. The rule
    looks around the mirror direction and around ``wo`` itself, and the larger mass decides; ``around`` is
    (False,) to look around the mirror direction alone.

    >>> lobe = find_lobe(lambda wi: wi[:, 2], (0.0, 0.0, 1.0))
    >>> 0.3 < lobe.width < 0.6, lobe.retro
    (True, False)
    """
    wo = np.asarray(wo, dtype=float)
    wi, weight, rho = _grid(wo, np.asarray(PROBE_WIDTH), probe)
    both = np.concatenate([wi, mirrored(wi, wo[None, :])])
    order = np.argsort(rho)
    best, best_mass, evaluations = Lobe(1.0, 1.0, False, 0), 0.0, 0
    for retro in around:
        value = np.asarray(integrand(turned(both) if retro else both), dtype=float)
        value = np.abs(value.reshape(len(value), -1)).sum(axis=1)
        evaluations += len(value)
        mass = weight * (value[: len(wi)] + value[len(wi) :])
        total = mass.sum()
        if np.isfinite(total) and total > (1 + RETRO * retro) * best_mass:
            inner, median = rho[order][np.searchsorted(np.cumsum(mass[order]), [total / 20, total / 2])]
            width = float(np.clip(median, 10 * PROBE_WIDTH, 1.0))
            core = float(np.clip(4 * inner, 10 * PROBE_WIDTH, width))
            best, best_mass = Lobe(width, core, retro, 0), total
    return replace(best, evaluations=evaluations)


def turned(w: FloatArray) -> FloatArray:
    """Return directions turned by half a turn about the normal."""
    return w * np.array([-1.0, -1.0, 1.0])


def slope_inverse(wo: FloatArray, width: float, wi: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Invert ``slope_map``: return x, s, and whether ``wi`` (N, 3) lies on the mirrored side.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> wi, _, _ = slope_map(wo, 0.3, np.array([0.25]), np.array([0.75]))
    >>> x, s, far = slope_inverse(wo, 0.3, wi)
    >>> round(float(x[0]), 12), round(float(s[0]), 12), bool(far[0])
    (0.25, 0.75, False)
    """
    total = wi + wo
    sin_o = np.hypot(wo[0], wo[1])
    along_axis = np.array([1.0, 0.0]) if sin_o == 0 else wo[:2] / sin_o
    along = total[:, :2] @ along_axis
    across = total[:, 1] * along_axis[0] - total[:, 0] * along_axis[1]
    radius = np.hypot(along, across)
    rho = radius / total[:, 2]
    cos_phi = np.divide(along, radius, out=np.ones_like(radius), where=radius > 0)
    tan_o = sin_o / wo[2]
    if tan_o < 1e-6:
        y, ratio = np.zeros_like(rho), cos_phi
    else:
        y = np.arcsinh(tan_o * cos_phi)
        ratio = y / np.arcsinh(tan_o)
    s = np.arctan2(np.sqrt(np.clip(1 - ratio * ratio, 0.0, 1.0)), ratio) / np.pi
    share = np.arcsinh(rho / width) / np.arcsinh(np.exp(y) / width)
    share = np.clip(share, 0.0, 1.0)
    return share / (1 + np.sqrt(1 - share)), s, across < 0
