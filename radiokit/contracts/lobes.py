"""Lobes: whether a sum of lobes of known widths conserves energy, for models whose claims depend on that.

Each lobe has its own rule in slope space, made for its width: cheaper and surer than one rule for all.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.verdict import TOLERANCE
from radiokit.measure.kernels import Kernel
from radiokit.measure.passes import run
from radiokit.measure.slope import slope_rule

__all__ = ["LAST_DEG", "WeightedLobe", "linear_lobes", "lobes_albedo", "lobes_conserve"]

FloatArray = npt.NDArray[np.float64]

LAST_DEG = 89.99
"""The last polar angle that is looked at, as by the judges [degrees]."""

SCAN_DEG = (*np.linspace(0.0, 84.0, 29), *(90.0 - np.geomspace(5.5, 90.0 - LAST_DEG, 16)))
AZIMUTHS_DEG = (0.0, 30.0, 60.0, 90.0)
SIZES = (32, 48, 72, 104, 152)
"""Nodes along each axis of the scan's rule and of those that follow it near the limit."""

PER_STRETCH = 0.5
"""Times as many nodes in azimuth, for each unit of a lobe's length over its width."""

CLEAR = 0.01
"""How far from the limit the scan decides alone; it errs by less than 1e-3."""


@dataclass(frozen=True)
class WeightedLobe:
    """J functions of one width, and what each of them weighs in each of K channels.

    Parameters
    ----------
    evaluate : callable
        ``evaluate(wi, wo)`` [sr⁻¹] takes (N, 3) twice and returns (N, J).
    width : float
        In the slope space of half vectors, above 0.
    weights : ndarray, shape (J, K)
    stretch : float
        The lobe's length over its width: 1 if it is unchanged by a turn about the normal. If it is not, the
        length must be along x or y, so that nothing changes with the sign of both directions' x, or y.
    """

    evaluate: Callable[[FloatArray, FloatArray], FloatArray]
    width: float
    weights: FloatArray
    stretch: float = 1.0


def linear_lobes(
    value: Kernel,
    coefficients: Sequence[Any],
    shape: Sequence[float],
    parts: Sequence[tuple[int, int, float, float]],
) -> list[WeightedLobe]:
    """Return the lobes of a model whose value is linear in the first of its constants.

    Parameters
    ----------
    value : Kernel
        As in ``Kernels``.
    coefficients, shape : sequence
        Its constants: those in which it is linear, each a number or an array (K,), and the other ones.
    parts : sequence of (int, int, float, float)
        For each lobe the first of its coefficients, the one after its last, its width and its stretch.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> paint = bsdf("lambert").kernels().value
    >>> lobes = linear_lobes(paint, [np.array([0.2, 0.5])], (), [(0, 1, 1.0, 1.0)])
    >>> lobes_albedo(lobes, 60.0, 0.0, 32).round(9).tolist()
    [0.2, 0.5]
    """
    weights = np.array(np.broadcast_arrays(*(np.atleast_1d(c) for c in coefficients)), dtype=float)

    def lobe(first: int, last: int, width: float, stretch: float) -> WeightedLobe:
        unit = tuple(np.eye(len(weights))[first:last].T)

        def evaluate(wi: FloatArray, wo: FloatArray) -> FloatArray:
            return run(value, (*wi.T, *wo.T), (*unit, *shape))

        return WeightedLobe(evaluate, width, weights[first:last], stretch)

    return [lobe(*part) for part in parts if np.any(weights[part[0] : part[1]])]


def lobes_albedo(lobes: Sequence[WeightedLobe], theta_deg: float, phi_deg: float, n: int) -> FloatArray:
    """Return the directional albedo (K,) of a sum of lobes, by a rule of n x n nodes for each.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> paint = bsdf("lambert", reflectance=0.5)
    >>> lobe = WeightedLobe(lambda wi, wo: paint.evaluate(wi, wo)[:, None], 1.0, np.array([[1.0, 2.0]]))
    >>> lobes_albedo([lobe], 60.0, 0.0, 32).round(9).tolist()
    [0.5, 1.0]
    """
    wo = spherical_to_cartesian(np.deg2rad(theta_deg), np.deg2rad(phi_deg))
    total = np.zeros(lobes[0].weights.shape[1]) if lobes else np.zeros(1)
    for lobe in lobes:
        azimuths = round(n * max(1.0, PER_STRETCH * lobe.stretch))
        wi, weight = slope_rule(wo, lobe.width, (n, azimuths), symmetric=lobe.stretch == 1)
        found = lobe.evaluate(wi, np.broadcast_to(wo, wi.shape))
        total = total + (weight * wi[:, 2]) @ found @ lobe.weights
    return total


def lobes_conserve(lobes: Sequence[WeightedLobe]) -> bool:
    """Return whether the largest directional albedo of a sum of lobes is at most 1, to ``TOLERANCE``.

    Polar angles up to 89.99° are scanned, for four azimuths where a lobe is not isotropic. Only within 0.01
    of the limit is the scan not enough: then each peak is climbed, and integrated by ever larger rules until
    the limit is farther away than ten times what the last step changed.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> paint = bsdf("lambert", reflectance=1.0)
    >>> for weight in (1.0, 1.0 + 1e-8):
    ...     lobe = WeightedLobe(lambda wi, wo: paint.evaluate(wi, wo)[:, None], 1.0, np.array([[weight]]))
    ...     print(lobes_conserve([lobe]))
    True
    False
    """
    fixed, turned = ([lobe for lobe in lobes if (lobe.stretch == 1) is flag] for flag in (True, False))
    azimuths = AZIMUTHS_DEG if turned else AZIMUTHS_DEG[:1]
    scan = np.full((len(SCAN_DEG) + 2, len(azimuths)), -np.inf)
    for row, theta in enumerate(SCAN_DEG, start=1):
        still = lobes_albedo(fixed, theta, 0.0, SIZES[0])
        scan[row] = [np.max(still + lobes_albedo(turned, theta, phi, SIZES[0])) for phi in azimuths]
    if abs(scan.max() - 1) > CLEAR:
        return bool(scan.max() < 1)
    here = scan[1:-1]
    peaks = (here >= scan[:-2]) & (here >= scan[2:])
    peaks[[0, -1]] = True  # an end may be higher than the scan can tell
    peaks &= here > 1 - CLEAR
    return not any(_exceeds(lobes, *_climbed(lobes, row, azimuths[k])) for row, k in np.argwhere(peaks))


def _climbed(lobes: Sequence[WeightedLobe], row: int, phi_deg: float) -> tuple[float, float]:
    """Return the highest place between a scanned one's neighbours in polar angle."""
    from scipy.optimize import minimize_scalar

    low, high = SCAN_DEG[max(row - 1, 0)], SCAN_DEG[min(row + 1, len(SCAN_DEG) - 1)]

    def negative(theta: float) -> float:
        return -float(np.max(lobes_albedo(lobes, theta, phi_deg, SIZES[1])))

    found = minimize_scalar(
        negative, bounds=(low, high), method="bounded", options={"maxiter": 30, "xatol": 1e-6}
    )
    places = (SCAN_DEG[row], low, high, float(found.x))
    return max(places, key=lambda theta: -negative(theta)), phi_deg


def _exceeds(lobes: Sequence[WeightedLobe], theta_deg: float, phi_deg: float) -> bool:
    value = previous = np.inf
    for n in SIZES[1:]:
        previous, value = value, float(np.max(lobes_albedo(lobes, theta_deg, phi_deg, n)))
        if abs(value - 1 - TOLERANCE) > 10 * abs(value - previous):
            break
    return value > 1 + TOLERANCE
