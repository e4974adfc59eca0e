"""Gain: whether a model's albedo passes 1 anywhere, for the claims that no closed form decides."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

import numpy as np

from radiokit.contracts.albedo import directional_albedo
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.measure.slope import slope_rule

__all__ = ["STEEPEST_DEG", "largest_albedo"]

STEEPEST_DEG = 89.99
"""How far the albedo is followed; the judges look as far, and no further."""

THETA = np.radians(
    [*np.linspace(0.0, 85.0, 18), 86.0, 87.0, 88.0, 89.0, 89.5, 89.8, 89.9, 89.96, STEEPEST_DEG]
)
PHI = np.linspace(0.0, np.pi / 2, 5)
NODES = (52, 40)
NEAR = 1e-3


@lru_cache(maxsize=64)
def largest_albedo(f: BSDF, *, fixed: Literal["wo", "wi"] = "wo") -> float:
    """Return the largest directional albedo [1] at 27 angles up to 89.99°.

    One rule in slope space shows which side of 1 it is on; where it is within a thousandth, it is integrated
    with a bound. An anisotropic model, which must be alike in all quadrants, is looked at from five azimuths.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> round(largest_albedo(bsdf("phong", exponent=10.0, reflectance=[0.2, 0.7])), 6)
    0.7
    """
    theta, phi = np.meshgrid(THETA, PHI[:1] if f.isotropic else PHI, indexing="ij")
    held = spherical_to_cartesian(theta.ravel(), phi.ravel())
    return max(_albedo(f, w, fixed) for w in held)


def _albedo(f: BSDF, held: FloatArray, fixed: Literal["wo", "wi"]) -> float:
    w, weight = slope_rule(held, f.lobe_width() or 1.0, NODES, symmetric=f.isotropic)
    other = np.broadcast_to(held, w.shape)
    value = f.evaluate(w, other) if fixed == "wo" else f.evaluate(other, w)
    found = value.T @ (w[:, 2] * weight)
    if np.any(abs(found - 1.0) < NEAR):
        found = directional_albedo(f, held, fixed=fixed, rtol=1e-10, atol=1e-11).value
    return float(np.max(found))
