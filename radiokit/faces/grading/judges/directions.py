"""Directions: where a density is asked for, and integrals of what a judge of samplers compares."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.checks.cells import Cells
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.slope import find_lobe, slope_map

__all__ = [
    "ABOVE",
    "ASKED",
    "UNIFORM",
    "integral",
    "moments",
    "probes",
    "uniform_density",
    "uniform_variance",
    "weighed_by",
]

ABOVE = np.array([0.0, 0.0, 1.0])
UNIFORM = 0.5 / math.pi
ASKED = 256
BELOW = 12
"""Directions at which a density is asked for, and how many lie below the horizon: too few to hide why."""


def integral(function: Callable[[Array], Array], width: float) -> float:
    """Return the integral over the hemisphere, to some four digits if it is smooth."""
    return float(hemisphere(function, wo=ABOVE, width=width, rtol=1e-5, max_evaluations=20_000).value)


def uniform_variance(integrand: Callable[[Array], Array]) -> tuple[float, float]:
    """Return the integral over the hemisphere, and the variance of a uniform direction's weight."""
    width = find_lobe(integrand, ABOVE, around=(False,)).width
    options: dict[str, Any] = {"wo": ABOVE, "width": width, "rtol": 1e-8, "max_evaluations": 1_000_000}
    mean = float(hemisphere(integrand, **options).value)
    square = float(hemisphere(lambda w: integrand(w) ** 2, **options).value)
    return mean, square / UNIFORM - mean**2


def moments(directions: Array) -> Array:
    """Return the numbers in [0, 1] by which an integrand is weighed to see where samples are, (2, N)."""
    found: Array = np.stack([np.clip(directions[:, 2], 0.0, 1.0), 0.5 * (1 + directions[:, 0])])
    return found


def weighed_by(k: int, integrand: Callable[[Array], Array], directions: Array) -> Array:
    """Return an integrand times the k-th of the ``moments``."""
    found: Array = moments(directions)[k] * integrand(directions)
    return found


def uniform_density(directions: Array, **given: Any) -> Array:
    """Return the density [sr⁻¹] of uniform directions of the hemisphere, wherever they point."""
    return np.full(len(directions), UNIFORM)


def probes(cells: Cells, rng: np.random.Generator) -> Array:
    """Return directions where a density is large, and all over the sphere."""
    wide, count = (ASKED - BELOW) // 2, ASKED - BELOW
    near, _, _ = slope_map(cells.aim, cells.width, rng.random(count - wide), rng.random(count - wide))
    turn = 2 * math.pi * rng.random(wide + BELOW)
    height = rng.random(wide + BELOW)
    height[wide:] *= -1
    radius = np.sqrt(1 - height**2)
    far = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    return np.concatenate([near, far])
