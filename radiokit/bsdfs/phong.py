"""Phong: a cosine lobe about the mirror direction, in the modified form that is reciprocal and conserves.

For teaching: one exponent, a closed form for everything, and a plain lesson in what a normalisation is worth.
At normal incidence the albedo is exactly the reflectance; away from it, much of the lobe falls below the
horizon and is lost (0.228 is left at 80° for an exponent of 10).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics.cosine_lobe import lobe_sample, median_slope, mirror_lobe

__all__ = ["Phong"]

SOURCE = Source(
    authors="Lafortune, Willems",
    year=1994,
    title="Using the Modified Phong Reflectance Model for Physically Based Rendering. KU Leuven, CW 197",
    equation="section 3, the specular part of the modified Phong BRDF",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, reflectance: Any) -> Any:
    return reflectance * (exponent + 2.0) / (2.0 * np.pi) * mirror_lobe(ix, iy, iz, ox, oy, oz, exponent)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, reflectance: Any) -> Any:
    return (exponent + 1.0) / (2.0 * np.pi) * mirror_lobe(ix, iy, iz, ox, oy, oz, exponent)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, exponent: Any, reflectance: Any) -> Any:
    """Return wi about the mirror direction, and ρ (n + 2)/(n + 1) cosθi."""
    wx, wy, wz = lobe_sample(u0, u1, -ox, -oy, oz, exponent)
    scale = reflectance * (exponent + 2.0) / (exponent + 1.0)
    return wx, wy, wz, select((wz > 0.0) & (oz > 0.0), scale * wz, 0.0)


@dataclass(frozen=True, kw_only=True)
class Phong(ScalarBSDF):
    """The modified Phong lobe, f = ρ (n + 2)/(2π) cosⁿα, with α the angle from the mirror direction.

    Parameters
    ----------
    exponent : float
        n [1], in [1, 1e6]. The lobe's half-width at half its height is about √(1.39/n) rad.
    reflectance : float or sequence of float
        ρ, the albedo at normal incidence [1], in [0, 1].

    >>> import numpy as np
    >>> peak = Phong(exponent=10.0)([0, 0, 1], [0, 0, 1])
    >>> peak == 12 / (2 * np.pi)
    np.True_
    """

    name = "phong"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"exponent": 1.0}, {"exponent": 1000.0, "reflectance": 0.5})

    exponent: float = parameter("[1, 1e6]", "1", "exponent of the lobe's cosine", default=10.0)
    reflectance: Spectrum = parameter("[0, 1]", "1", "albedo at normal incidence", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with cosα from the mirror direction's dot product over the lengths."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, n = sympy.symbols("rho n", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        mirror = sympy.Matrix([-wo[0], -wo[1], wo[2]])
        cosine = mirror.dot(wi) / sympy.sqrt(mirror.dot(mirror) * wi.dot(wi))
        lobe = sympy.Piecewise((cosine**n, cosine > 0), (0, True))
        return Twin(rho * (n + 2) / (2 * sympy.pi) * lobe, {rho: self.reflectance, n: self.exponent})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.exponent, self.reflectance))

    @property
    def smooth(self) -> bool:
        """Whether cosⁿα ends softly enough where the lobe does: not for a small exponent."""
        return self.exponent >= 4.0

    def lobe_width(self) -> float:
        """Return the median slope of the half vectors, tan(α/2) for half the lobe's flux within α."""
        return median_slope(self.exponent)

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: the horizon cuts the lobe."""
        return Claims(reciprocity="yes", conserves=True)
