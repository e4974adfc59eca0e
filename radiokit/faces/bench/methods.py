"""Methods: radiokit's own integrators as the bench runs them, each over a range of sizes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.albedo import albedo, integrand
from radiokit.contracts.bsdf import BSDF
from radiokit.facts.estimate import Estimate
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.slope import slope_rule

__all__ = ["METHODS", "SAMPLED", "Method", "classroom_rule", "fixed_slope_rule"]


@dataclass(frozen=True)
class Method:
    """A method with the sizes it runs at: nodes along an axis, samples, or a tolerance.

    ``answer(f, wo, size, seed)`` returns an Estimate, or a bare value with the number of evaluations where
    nothing is claimed.
    """

    name: str
    size: str
    sizes: tuple[float, ...]
    quick: tuple[float, ...]
    answer: Callable[[BSDF, Any, float, int], Estimate | tuple[float, int]]


def fixed_slope_rule(f: BSDF, wo: Any, n: int) -> float:
    """Return the albedo by the slope-space rule of n × n nodes."""
    wi, weight = slope_rule(wo, f.lobe_width() or 1.0, n, symmetric=True)
    return float(weight @ integrand(f, np.asarray(wo), "wo")(wi))


def classroom_rule(f: BSDF, wo: Any, n: int) -> float:
    """Return the albedo by n × n nodes of Gauss and Legendre in cosθ and φ."""
    x, w = gauss_legendre(n)
    phi = 2 * np.pi * x
    sine = np.sqrt((1 - x) * (1 + x))
    wi = np.stack(
        [np.outer(sine, np.cos(phi)), np.outer(sine, np.sin(phi)), np.repeat(x[:, None], n, axis=1)], axis=-1
    ).reshape(-1, 3)
    return float(2 * np.pi * np.outer(w, w).ravel() @ integrand(f, np.asarray(wo), "wo")(wi))


def _quadrature(f: BSDF, wo: Any, rtol: float, seed: int) -> Estimate:
    return albedo(f, wo, rtol=rtol)


def _sampled(method: Any) -> Callable[[BSDF, Any, float, int], Estimate]:
    return lambda f, wo, samples, seed: albedo(f, wo, method=method, samples=int(samples), rng=seed)


SAMPLED = ("mc", "qmc")

METHODS = (
    Method(
        "slope rule",
        "nodes",
        (6, 8, 12, 16, 24, 32, 48, 64, 96),
        (6, 8, 12, 16, 24, 32, 48),
        lambda f, wo, n, seed: (fixed_slope_rule(f, wo, int(n)), int(n) ** 2),
    ),
    Method("quadrature", "rtol", (1e-4, 1e-6, 1e-8, 1e-10), (1e-4, 1e-8), _quadrature),
    Method("mc", "samples", (2**10, 2**13, 2**16, 2**19), (2**9, 2**13, 2**17), _sampled("mc")),
    Method("qmc", "samples", (2**10, 2**13, 2**16, 2**19), (2**9, 2**13, 2**17), _sampled("qmc")),
)
