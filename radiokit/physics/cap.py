"""Cap: the irradiance of a circular cone of uniform radiance, whole or cut by the receiver's horizon."""

from __future__ import annotations

import math

import numpy as np

from radiokit.facts.source import Source

__all__ = ["CAP_SOURCE", "cap_irradiance"]

CAP_SOURCE = Source(
    authors="Snyder",
    year=1996,
    title="Area Light Sources for Real-Time Graphics. Microsoft Research, MSR-TR-96-11",
    equation="irradiance of a sphere that the horizon cuts",
    errata="its differences cancel for a sliver of a sphere: here they are one integral of positive terms",
)

_X, _W = (0.5 * (x + shift) for x, shift in zip(np.polynomial.legendre.leggauss(20), (1.0, 0.0), strict=True))


def cap_irradiance(
    *, sine: float, cosine: float, height: float, offset: float, angle: float, half_azimuth: float
) -> float:
    r"""Return E/L [sr] of a cone that the horizon cuts.

    The boundary is the cone's arc above the horizon and the horizon between its ends, so that the contour
    integral E/L = ½∮ n·(r × dr) gives, for an axis ``e`` below the horizon with |cosθ| = sin e,

        E/L = g(β) − |cosθ| sin²σ g(T),   g(x) = x − sin x cos x,

    with β half the azimuth that the cone takes of the horizon, and T half the arc's own angle. Both terms are
    ∫ over v = sinσ sin τ of a common form, whose difference is a positive integrand: it is summed in
    ξ = asinh tan τ where the terms nearly cancel. An axis above the horizon adds π sin²σ cosθ.

    Parameters
    ----------
    sine, cosine : float
        Of the cone's half-angle σ, at most 90°.
    height, offset : float
        cosθ and sinθ of the axis, θ from the normal.
    angle, half_azimuth : float
        T and β [rad], for the axis that is not above the horizon, in (0, π/2].

    >>> half = cap_irradiance(
    ...     sine=0.6, cosine=0.8, height=0.0, offset=1.0, angle=np.pi / 2, half_azimuth=math.asin(0.6)
    ... )
    >>> round(half - (math.asin(0.6) - 0.48), 15)  # the axis in the horizon: β − sinβ cosβ
    0.0
    """
    c = abs(height)
    whole = math.pi * sine * sine * height if height > 0 else 0.0
    first, second = _lens(half_azimuth), c * sine * sine * _lens(angle)
    if second < 0.5 * first:
        return whole + (first - second)
    return whole + _sliver(sine, cosine, c, offset, angle)


def _lens(x: float) -> float:
    """Return x − sin x cos x for x in [0, π/2]."""
    if x > 0.5:
        return x - math.sin(x) * math.cos(x)
    y = 4.0 * x * x
    total = 0.0
    for n in range(11, 0, -1):  # (2x)³/12 (1 − y/(4·5) (1 − y/(6·7) (1 − …)))
        total = 1.0 - y / ((2 * n + 2) * (2 * n + 3)) * total if n < 11 else 1.0
    return 2.0 / 3.0 * x**3 * total


def _sliver(sine: float, cosine: float, c: float, offset: float, angle: float) -> float:
    end = math.asinh(math.tan(angle))
    panels = max(1, math.ceil(end / 1.5))
    share = (np.arange(panels)[:, None] + _X) / panels
    xi, rest = end * share, end * (1.0 - share)
    sinh, cosh = np.sinh(xi), np.cosh(xi)
    edge = np.hypot(1.0, cosine * sinh)
    # sin²T − sin²τ in ξ, over cosh²ξ; the last factor keeps sinh(Ξ + ξ)/cosh²Ξ in range.
    above = np.sinh(rest) * np.sinh(end + xi) / math.cosh(end) ** 2
    values = (sinh / cosh) ** 2 * above * sine / (cosh * edge * (sine + c * edge))
    return float(2.0 * sine**3 * offset * offset * end / panels * np.sum(values * _W))
