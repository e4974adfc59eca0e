"""Lobes: whether a sum of lobes of known widths conserves energy, for models whose claims depend on that.

Each lobe has its own rule in slope space, made for its width: cheaper and surer than one rule for all.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.verdict import TOLERANCE
from radiokit.measure.slope import slope_rule

__all__ = ["LAST_DEG", "WeightedLobe", "lobes_albedo", "lobes_conserve"]

FloatArray = npt.NDArray[np.float64]

LAST_DEG = 89.99
"""The last polar angle that is looked at, as by the judges [degrees]."""

SCAN_DEG = (*np.linspace(0.0, 84.0, 29), *(90.0 - np.geomspace(5.5, 90.0 - LAST_DEG, 16)))
AZIMUTHS_DEG = tuple(np.linspace(0.0, 90.0, 7))
SIZES = (32, 48, 72, 104, 152)
"""Nodes along each axis of the scan's rule and of those that follow it near the limit."""

CLEAR, CLIMBS = 0.01, 4
"""How far from the limit the scan decides alone, and from how many angles a climb starts otherwise."""


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
    isotropic : bool
        Whether the functions are unchanged by a turn about the normal. If not, they are by a change of sign
        of both directions' x, or y.
    """

    evaluate: Callable[[FloatArray, FloatArray], FloatArray]
    width: float
    weights: FloatArray
    isotropic: bool = True


def lobes_albedo(lobes: Sequence[WeightedLobe], theta_deg: float, phi_deg: float, n: int) -> FloatArray:
    """Return the directional albedo (K,) of a sum of lobes, by a rule of n x n nodes for each.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> paint = bsdf("lambert", reflectance=0.5)
    >>> lobe = WeightedLobe(lambda wi, wo: paint.evaluate(wi, wo)[:, None], 1.0, np.array([[1.0, 2.0]]))
    >>> lobes_albedo([lobe], 60.0, 0.0, 32).round(9).tolist()
    [0.5, 1.0]
    """
    wo = spherical_to_cartesian(np.deg2rad(theta_deg), np.deg2rad(phi_deg))
    total = 0.0
    for lobe in lobes:
        wi, weight = slope_rule(wo, lobe.width, n, symmetric=lobe.isotropic)
        found = lobe.evaluate(wi, np.broadcast_to(wo, wi.shape))
        total = total + (weight * wi[:, 2]) @ found @ lobe.weights
    return np.asarray(total)


def lobes_conserve(lobes: Sequence[WeightedLobe]) -> bool:
    """Return whether the largest directional albedo of a sum of lobes is at most 1, to ``TOLERANCE``.

    Polar angles up to 89.99° are scanned, for seven azimuths where a lobe is not isotropic. Only within 0.01
    of the limit is the scan not enough: then the highest few angles are climbed from, and integrated by ever
    larger rules until the limit is farther than ten times what the last step changed.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> paint = bsdf("lambert", reflectance=1.0)
    >>> for weight in (1.0, 1.0 + 1e-8):
    ...     lobe = WeightedLobe(lambda wi, wo: paint.evaluate(wi, wo)[:, None], 1.0, np.array([[weight]]))
    ...     print(lobes_conserve([lobe]))
    True
    False
    """
    azimuths = (0.0,) if all(lobe.isotropic for lobe in lobes) else AZIMUTHS_DEG
    places = [(theta, phi) for theta in SCAN_DEG for phi in (azimuths if theta else azimuths[:1])]
    turned, fixed = ([lobe for lobe in lobes if lobe.isotropic is flag] for flag in (False, True))
    still = {theta: lobes_albedo(fixed, theta, 0.0, SIZES[0]) for theta in SCAN_DEG}
    scan = np.array(
        [np.max(still[theta] + lobes_albedo(turned, theta, phi, SIZES[0])) for theta, phi in places]
    )
    if abs(scan.max() - 1) > CLEAR:
        return bool(scan.max() < 1)
    order = np.argsort(-scan, kind="stable")[:CLIMBS]
    return not any(_exceeds(lobes, *_climbed(lobes, *places[index])) for index in order)


def _climbed(lobes: Sequence[WeightedLobe], theta_deg: float, phi_deg: float) -> tuple[float, float]:
    """Return the highest place between a scanned one's neighbours in polar angle."""
    from scipy.optimize import minimize_scalar

    k = SCAN_DEG.index(theta_deg)
    low, high = SCAN_DEG[max(k - 1, 0)], SCAN_DEG[min(k + 1, len(SCAN_DEG) - 1)]

    def negative(theta: float) -> float:
        return -float(np.max(lobes_albedo(lobes, theta, phi_deg, SIZES[1])))

    found = minimize_scalar(
        negative, bounds=(low, high), method="bounded", options={"maxiter": 30, "xatol": 1e-6}
    )
    places = (theta_deg, low, high, float(found.x))
    return max(places, key=lambda theta: -negative(theta)), phi_deg


def _exceeds(lobes: Sequence[WeightedLobe], theta_deg: float, phi_deg: float) -> bool:
    value = previous = np.inf
    for n in SIZES[1:]:
        previous, value = value, float(np.max(lobes_albedo(lobes, theta_deg, phi_deg, n)))
        if abs(value - 1 - TOLERANCE) > 10 * abs(value - previous):
            break
    return value > 1 + TOLERANCE
