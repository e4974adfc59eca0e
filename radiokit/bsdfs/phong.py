"""Phong: a cosine lobe about the mirror direction, in the modified form that is reciprocal and conserves.

For teaching: one exponent, a closed form for everything, and a plain lesson in what a normalisation is worth.
At normal incidence the albedo is exactly the reflectance; away from it, much of the lobe falls below the
horizon and is lost (0.228 is left at 80° for an exponent of 10).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims, FloatArray
from radiokit.contracts.parameters import parameter
from radiokit.facts.directions import dot, frame, reflect, to_world
from radiokit.facts.source import Source
from radiokit.measure.elementary import expm1, log, sincos
from radiokit.measure.kernels import Kernel, kernel, select
from radiokit.measure.twin import Twin

__all__ = ["Phong"]

SOURCE = Source(
    authors="Lafortune, Willems",
    year=1994,
    title="Using the Modified Phong Reflectance Model for Physically Based Rendering. KU Leuven, CW 197",
    equation="section 3, the specular part of the modified Phong BRDF",
)


@kernel
def _weight(u0: float, u1: float, scale: float, power: float, x: float, y: float, z: float) -> Any:
    """Return the weight of ``sample``; −x, −y, z are the z components of the mirror direction's frame."""
    loss = -expm1(log(1.0 - u0) * power)  # 1 − cosα; the difference is exact
    radius = np.sqrt(loss * (2.0 - loss))
    sine, cosine = sincos(u1)
    cos_i = (1.0 - loss) * z + radius * (cosine * x + sine * y)
    return scale * select(cos_i > 0.0, cos_i, 0.0)


@dataclass(frozen=True, kw_only=True)
class Phong(BSDF):
    """The modified Phong lobe, f = ρ (n + 2)/(2π) cosⁿα, with α the angle from the mirror direction.

    Parameters
    ----------
    exponent : float
        n [1], in [1, 1e6]. The lobe's half-width at half its height is about √(1.39/n) rad.
    reflectance : float
        ρ, the albedo at normal incidence [1], in [0, 1].

    >>> import numpy as np
    >>> peak = Phong(exponent=10.0)([0, 0, 1], [0, 0, 1])
    >>> peak == 12 / (2 * np.pi)
    np.True_
    """

    name = "phong"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"exponent": 1.0}, {"exponent": 1000.0, "reflectance": 0.5})

    exponent: float = parameter("[1, 1e6]", "1", "exponent of the lobe's cosine", default=10.0)
    reflectance: float = parameter("[0, 1]", "1", "albedo at normal incidence", default=1.0)

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

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹]."""
        return self.reflectance * (self.exponent + 2.0) / (2.0 * np.pi) * self._lobe(wi, wo)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``, (n + 1)/(2π) cosⁿα; 0 below the horizon."""
        return (self.exponent + 1.0) / (2.0 * np.pi) * self._lobe(wi, wo)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` about the mirror direction, and ``weight = ρ (n + 2)/(n + 1) cosθi``.

        Source: Lafortune & Willems (1994), section 3, the sampling of the specular lobe.
        """
        log_cosine = np.log1p(-u[..., 0]) / (self.exponent + 1.0)
        cosine, sine = np.exp(log_cosine), np.sqrt(-np.expm1(2.0 * log_cosine))
        phi = 2.0 * np.pi * u[..., 1]
        local = np.stack((sine * np.cos(phi), sine * np.sin(phi), cosine), axis=-1)
        wi = to_world(frame(reflect(wo)), local)
        scale = self.reflectance * (self.exponent + 2.0) / (self.exponent + 1.0)
        return wi, np.where(wo[..., 2] > 0.0, scale * np.maximum(wi[..., 2], 0.0), 0.0)

    def weight_kernel(self, wo: FloatArray) -> tuple[Kernel, tuple[float, ...]]:
        """Return ρ (n + 2)/(n + 1) cosθi as a kernel."""
        scale = self.reflectance * (self.exponent + 2.0) / (self.exponent + 1.0)
        return _weight, (scale, 1.0 / (self.exponent + 1.0), float(wo[0]), float(wo[1]), float(wo[2]))

    def _lobe(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return cosⁿα, or 0 below the horizon.

        Near the mirror direction r, cosα has too few digits for a large n; |r − wi|² = 2(1 − cosα) has them.
        """
        mirror = reflect(wo)
        offset, cosine = wi - mirror, dot(wi, mirror)
        depth = 0.5 * dot(offset, offset)
        with np.errstate(divide="ignore", invalid="ignore"):
            log_cosine = np.where(depth < 0.5, np.log1p(-depth), np.log(cosine))
            lobe = np.exp(self.exponent * log_cosine)
        lit = (cosine > 0.0) & (np.minimum(wi[..., 2], wo[..., 2]) > 0.0)
        return np.where(lit, lobe, 0.0)

    @property
    def smooth(self) -> bool:
        """Whether cosⁿα ends softly enough where the lobe does: not for a small exponent."""
        return self.exponent >= 4.0

    def lobe_width(self) -> float:
        """Return the median slope of the half vectors, tan(α/2) for half the lobe's flux within 2α."""
        log_cosine = -np.log(2.0) / (self.exponent + 1.0)
        alpha = np.arctan2(np.sqrt(-np.expm1(2.0 * log_cosine)), np.exp(log_cosine))
        return float(np.tan(0.5 * alpha))

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: the horizon cuts the lobe."""
        return Claims(reciprocity="yes", conserves=True)
