"""Probes: the pairs of directions at which the judges look, and what a look costs."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.bsdf import BSDF
from radiokit.facts.directions import reflect, refract
from radiokit.measure.lattice import kronecker

__all__ = ["GRAZING", "channels", "isotropic", "pairs", "polar", "seconds_per_evaluation"]

FloatArray = npt.NDArray[np.float64]

GRAZING = np.deg2rad(89.99)
"""The largest polar angle at which the judges integrate [rad]."""

_SMALLEST_COSINE = float(np.cos(np.deg2rad(89.9999)))


def polar(cosine: npt.ArrayLike, phi: npt.ArrayLike) -> FloatArray:
    """Return unit vectors with the given cosine of the polar angle and azimuth."""
    cosine, phi = np.broadcast_arrays(np.asarray(cosine, dtype=float), phi)
    sine = np.sqrt((1 - cosine) * (1 + cosine))
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1)


def pairs(
    count: int, f: BSDF | None = None, *, shift: FloatArray | float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Return ``count`` pairs of directions on the upper hemisphere, hard ones included.

    Half are uniform in solid angle, so that an odd region of any shape is hit by its share; a quarter
    has cosines spread evenly over six decades, down to 89.9999°; a quarter lies near the mirror pair,
    with offsets spread evenly over five decades.

    For an ``f`` that transmits, all four combinations of sides get an equal share of each kind. Across the
    surface, pairs lie near the refracted pair instead of the mirror pair, and half of the grazing ones have
    one direction within 10⁻⁵ to 1 of the critical angle.

    A ``shift`` of the numbers that they are made of, (4,) in [0, 1), gives others, just as well spread.
    """
    u = (kronecker(count, 4) + shift) % 1.0
    cos_i, cos_o = u[:, 0].copy(), u[:, 1].copy()
    phi_i, phi_o = 2 * np.pi * u[:, 2], 2 * np.pi * u[:, 3]
    kind = np.arange(count) % 4
    for cosine in (cos_i, cos_o):
        cosine[:] = np.clip(cosine, _SMALLEST_COSINE, 1.0)
        cosine[kind == 2] = _SMALLEST_COSINE ** cosine[kind == 2]
    wi, wo = polar(cos_i, phi_i), polar(cos_o, phi_o)
    near = kind == 3
    mirror = reflect(wo[near])
    offset = 10.0 ** (-5 * u[near, 0])
    moved = mirror + offset[:, None] * polar(np.zeros(near.sum()), phi_i[near])
    moved[:, 2] = np.maximum(moved[:, 2], _SMALLEST_COSINE)
    wi[near] = moved / np.linalg.norm(moved, axis=1)[:, None]
    if f is None or not f.transmissive:
        return wi, wo
    return _on_both_sides(wi, wo, u, kind, f.relative_index())


def _on_both_sides(
    wi: FloatArray, wo: FloatArray, u: FloatArray, kind: Any, eta: float
) -> tuple[FloatArray, FloatArray]:
    """Spread pairs over the four combinations of sides, those across the surface where it refracts."""
    number = np.arange(len(wi)) // 4
    below_i, below_o = (number % 2).astype(bool), (number // 2 % 2).astype(bool)
    if eta != 1:
        # The direction on the side of the larger index goes near its critical angle, on either side of it.
        critical = (kind == 2) & (below_i != below_o) & (number // 4 % 2 == 0)
        near = np.where(number // 8 % 2 == 0, 1.0, -1.0) * 10.0 ** (-5 * u[:, 0])
        sine = np.clip(min(eta, 1 / eta) * (1 + near), 0.0, 1 - _SMALLEST_COSINE)
        for w, below, phi in ((wi, below_i, u[:, 2]), (wo, below_o, u[:, 3])):
            rows = critical & (below == (eta > 1))
            w[rows] = polar(np.sqrt((1 - sine) * (1 + sine)), 2 * np.pi * phi)[rows]
    wi[below_i, 2] *= -1
    wo[below_o, 2] *= -1
    across = (kind == 3) & (below_i != below_o)
    to, _ = refract(wo[across], eta=eta)
    offset = 10.0 ** (-5 * u[across, 0])
    moved = to + offset[:, None] * polar(np.zeros(across.sum()), 2 * np.pi * u[across, 2])
    moved[:, 2] = np.copysign(np.maximum(np.abs(to[:, 2]), _SMALLEST_COSINE), -wo[across, 2])
    wi[across] = moved / np.linalg.norm(moved, axis=1)[:, None]
    return wi, wo


def channels(values: Any) -> FloatArray:
    """Return values as (N, K): a single wavelength is one column."""
    values = np.asarray(values, dtype=float)
    return values[:, None] if values.ndim == 1 else values


def isotropic(f: BSDF, count: int = 512) -> bool:
    """Return whether turning both directions about the normal leaves f unchanged, as far as can be seen."""
    wi, wo = pairs(count, f)
    angle = 2 * np.pi * kronecker(count, 1)[:, 0]
    c, s = np.cos(angle), np.sin(angle)

    def turned(w: FloatArray) -> FloatArray:
        return np.stack([c * w[:, 0] - s * w[:, 1], s * w[:, 0] + c * w[:, 1], w[:, 2]], axis=-1)

    one, two = channels(f.evaluate(wi, wo)), channels(f.evaluate(turned(wi), turned(wo)))
    usable = np.isfinite(one) & np.isfinite(two)
    # A turn rounds the directions, and a narrow lobe magnifies that: only clear differences count.
    return bool(
        np.all(np.abs(one - two)[usable] <= 1e-3 * np.maximum(np.abs(one), np.abs(two))[usable] + 1e-9)
    )


def seconds_per_evaluation(f: BSDF) -> float:
    """Measure what one evaluation costs [s], with arrays as large as the function's speed allows.

    The best of several, since another program may have been running: what is searched should depend on the
    function, and not on the moment.
    """
    count, best = 4, 0.0
    while best < 2e-3 and count < 1 << 14:
        count *= 4
        wi, wo = pairs(count)
        best = np.inf
        for _ in range(3):
            start = time.perf_counter()
            f.evaluate(wi, wo)
            best = min(best, time.perf_counter() - start)
    return best / count
