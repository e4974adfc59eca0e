"""Scan: a rough look at an integrand over the hemisphere, which sees between the nodes of rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import Integrand
from radiokit.measure.lattice import kronecker
from radiokit.measure.ridge import Ridge, find_ridge
from radiokit.measure.slope import mirrored, slope_map

__all__ = ["DOUBT", "SCAN", "Scan", "look_over", "missed"]

FloatArray = npt.NDArray[np.float64]

SCAN = 4096
"""Points of the scan that every unknown integrand gets."""

DOUBT = 2.0
"""Standard deviations between a rule and the scan that raise doubt; evenly spread points err by far less."""


@dataclass(frozen=True)
class Scan:
    """A rough integral with its uncertainty, the ridge of the lobe seen, and whether it is 0 in places."""

    mean: Any
    spread: Any
    ridge: Ridge | None
    dark: bool


def look_over(integrand: Integrand, wo: FloatArray, width: float, count: int = SCAN) -> Scan:
    """Integrate roughly with points spread evenly, which see between the nodes of the rules."""
    x, s = kronecker(count, 2).T
    wi, weight, _ = slope_map(wo, width, x, s)
    far = np.arange(count) % 2 == 0
    wi[far] = mirrored(wi[far], wo)
    terms = (np.asarray(integrand(wi), dtype=float).T * weight).T
    size = np.abs(terms.reshape(count, -1)).sum(axis=1)
    ridge, dark = find_ridge(wo, s, far, size), not size.all()
    return Scan(terms.mean(axis=0), terms.std(axis=0) / np.sqrt(count), ridge, dark)


def missed(found: Estimate, mean: Any, spread: Any) -> float:
    """Return by how much an integral and a scan differ beyond what either allows; 0 where they agree."""
    difference = np.abs(found.value - mean)
    return float(np.max(np.where(difference > DOUBT * spread + found.error, difference, 0.0)))
