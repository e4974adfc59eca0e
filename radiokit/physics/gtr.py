"""GTR of exponent 1: normals with tails longer than those of GGX, which is the same law of exponent 2.

D ∝ 1/(α² cos²θ + sin²θ), for a clear coat's narrow highlight in a wide glow. A half vector has any length.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from radiokit.facts.source import Source
from radiokit.measure.elementary import expm1, sincos
from radiokit.measure.kernels import kernel, select

__all__ = ["GTR_SOURCE", "gtr1_constants", "gtr1_d_symbolic", "gtr1_density", "gtr1_normal"]

GTR_SOURCE = Source(
    authors="Burley",
    year=2012,
    title="Physically-Based Shading at Disney. SIGGRAPH course notes, revised 31 August 2012",
    equation="appendix B, Generalized-Trowbridge-Reitz: D and the samples of γ = 1; the revision corrected "
    "the factor that normalises D",
)


def gtr1_constants(alpha: float) -> tuple[float, float]:
    """Return (1 − α²)/(−π log α²) [1] and log α² of a width α in (0, 1), which the kernels take.

    >>> scale, log_square = gtr1_constants(0.1)
    >>> round(scale, 12), log_square == 2 * math.log(0.1)
    (0.068428912417, True)
    """
    log_square = 2.0 * (math.log(alpha) if alpha < 0.5 else math.log1p(alpha - 1.0))
    return (1.0 - alpha) * (1.0 + alpha) / (-math.pi * log_square), log_square


@kernel
def gtr1_density(hx: Any, hy: Any, hz: Any, alpha: Any, scale: Any) -> Any:
    """Return D [sr⁻¹] for a half vector of any length, hz at least 0.

    >>> round(float(gtr1_density(0.0, 0.0, 2.0, 0.1, gtr1_constants(0.1)[0])), 12)
    6.842891241691
    """
    across, up = hx * hx + hy * hy, hz * hz
    spread = across + (alpha * alpha) * up
    return scale * (across + up) / select(spread > 0.0, spread, 1.0)


@kernel
def gtr1_normal(u0: Any, u1: Any, alpha: Any, log_square: Any) -> Any:
    """Return a normal (hx, hy, hz) of density D cosθ [sr⁻¹], not of unit length; u0 below 1.

    cos²θ = (1 − α^(2 − 2 u0))/(1 − α²), and sin²θ = (α^(2 − 2 u0) − α²)/(1 − α²) without cancellation.

    >>> [float(c) for c in gtr1_normal(0.0, 0.5, 0.1, gtr1_constants(0.1)[1])][:2]
    [-0.0, -0.0]
    """
    sine, cosine = sincos(u1)
    radius = alpha * np.sqrt(expm1(-u0 * log_square))
    return radius * cosine, radius * sine, np.sqrt(-expm1((1.0 - u0) * log_square))


def gtr1_d_symbolic(h: Sequence[Any], alpha: Any) -> Any:
    """Return D [sr⁻¹] as a SymPy expression: Burley (2012), appendix B, in the angle of h from the normal."""
    import sympy

    from radiokit.physics.microfacet import cosine_symbolic

    cos2 = cosine_symbolic(h, (0, 0, 1)) ** 2
    return (alpha**2 - 1) / (sympy.pi * sympy.log(alpha**2) * (1 + (alpha**2 - 1) * cos2))
