"""Lune: quadrature over the part of the upper hemisphere that lies in another half-space."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import angle_between
from radiokit.facts.estimate import Estimate
from radiokit.measure.quadrature import box, hemisphere
from radiokit.measure.slope import find_lobe

__all__ = ["lune"]

FloatArray = npt.NDArray[np.float64]
_UP = np.array([0.0, 0.0, 1.0])


def lune(
    integrand: Callable[[FloatArray], Any],
    zenith: npt.ArrayLike,
    *,
    wo: npt.ArrayLike = (0.0, 0.0, 1.0),
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Integrate over the directions that are above both the horizon and that of ``zenith``: ∫ g(ω) dω.

    Longitude and latitude about the axis in which the two horizons meet make both of them coordinate
    lines, so that no kink is inside. The lune is cut where the lobe peaks, and the nodes crowd there.

    Parameters
    ----------
    integrand : callable
        Takes unit vectors (N, 3), returns (N,) or (N, K).
    zenith : array_like, shape (3,)
        Unit normal of the half-space.
    wo : array_like, shape (3,)
        The direction whose mirror image the integrand may peak at; above the horizon.
    width : float, optional
        The lobe's width in slope; found when not given, and then a lobe around ``wo`` itself is found too.
    rtol, atol : float
        The error may be ``max(atol, rtol |value|)``.
    max_evaluations : int
        A budget. The estimate says ``converged=False`` when it did not suffice.

    >>> estimate = lune(lambda w: w[:, 2], (0.0, 0.8, 0.6))
    >>> round(float(estimate.value) / np.pi, 9)  # (1 + cosβ)/2
    0.8
    """
    start = time.perf_counter()
    zenith, wo = np.asarray(zenith, dtype=float), np.asarray(wo, dtype=float)
    sine = float(np.hypot(zenith[0], zenith[1]))
    if sine == 0 and zenith[2] > 0:
        return hemisphere(
            integrand, wo=wo, width=width, rtol=rtol, atol=atol, max_evaluations=max_evaluations
        )
    if sine == 0:
        nothing: Any = 0.0 * np.asarray(integrand(_UP[None, :]), dtype=float)[0]
        return Estimate(nothing, nothing, "truncation", 1, method="lune")
    spent, peak = 0, np.array([-wo[0], -wo[1], wo[2]])
    if width is None:
        lobe = find_lobe(integrand, wo)
        width, spent = lobe.core, lobe.evaluations
        peak = wo if lobe.retro else peak
    opening = float(angle_between(_UP, -zenith))
    across = np.array([zenith[0], zenith[1], 0.0]) / sine
    axis = np.array([-across[1], across[0], 0.0])

    # χ is the longitude above the horizon, up to that of the zenith at χ = opening; λ is the latitude.
    along = float(peak @ across)
    peak_chi = float(np.clip(np.arctan2(peak[2], along), 0.0, opening))
    peak_lambda = float(np.arctan2(peak @ axis, np.hypot(peak[2], along)))
    chi_sides = [side for side in ((1.0, opening - peak_chi), (-1.0, peak_chi)) if side[1] > 0]
    lambda_sides = [(1.0, np.pi / 2 - peak_lambda), (-1.0, np.pi / 2 + peak_lambda)]
    # Near the horizon a lobe is as wide as ever in elevation, but in azimuth only 2 w (wo·h) wide.
    narrow = width * float(np.clip(wo[2] + width, 0.0, 1.0))
    pieces = [(*a, *b) for a in chi_sides for b in lambda_sides if b[1] > 0]

    def square(points: FloatArray) -> Any:
        directions, weights = [], []
        for chi_sign, chi_span, lambda_sign, lambda_span in pieces:
            chi, d_chi = _crowd(points[:, 0], chi_span, width)
            lat, d_lat = _crowd(points[:, 1], lambda_span, narrow)
            chi, lat = peak_chi + chi_sign * chi, peak_lambda + lambda_sign * lat
            ring = np.cos(lat)[:, None]
            meridian = np.sin(chi)[:, None] * _UP + np.cos(chi)[:, None] * across
            directions.append(ring * meridian + np.sin(lat)[:, None] * axis)
            weights.append(ring[:, 0] * d_chi * d_lat)
        value = np.asarray(integrand(np.concatenate(directions)), dtype=float)
        value = (value.T * np.concatenate(weights)).T
        return value.reshape(len(pieces), len(points), *value.shape[1:]).sum(axis=0)

    budget = (max_evaluations - spent) // len(pieces)
    found = box(square, (0.0, 0.0), (1.0, 1.0), rtol=rtol, atol=atol, max_evaluations=budget)
    return replace(
        found,
        evaluations=found.evaluations * len(pieces) + spent,
        seconds=time.perf_counter() - start,
        method=f"{found.method} over the lune",
    )


def _crowd(x: FloatArray, span: float, width: float) -> tuple[FloatArray, FloatArray]:
    """Map [0, 1] to [0, span], crowded towards 0 within ``width``; return the points and the slope."""
    length = np.arcsinh(span / width)
    return width * np.sinh(length * x), width * length * np.cosh(length * x)
