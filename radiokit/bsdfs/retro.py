"""Retro: a cosine lobe about the direction that the light came from, as of cats' eyes and road signs.

Phong's lobe turned by half a turn about the normal, so that all that is known of it holds: reciprocal, an
albedo of exactly the reflectance at normal incidence, and less away from it, where the horizon cuts the lobe
(0.228 is left at 80° for an exponent of 10). For judges and integrators, a lobe that is not where they look.
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
from radiokit.physics.cosine_lobe import lobe, lobe_sample

__all__ = ["Retro"]

SOURCE = Source(
    authors="Lafortune, Foo, Torrance, Greenberg",
    year=1997,
    title="Non-Linear Approximation of Reflectance Functions. SIGGRAPH 97",
    doi="10.1145/258734.258801",
    equation="the generalised cosine lobe with C_x = C_y = C_z, its retro-reflective case; normalised as in "
    "Lafortune & Willems (1994), Using the Modified Phong Reflectance Model, KU Leuven, CW 197, section 3",
)


@kernel
def _lobe(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any) -> Any:
    return select((iz > 0.0) & (oz > 0.0), lobe(ix, iy, iz, ox, oy, oz, exponent), 0.0)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, reflectance: Any) -> Any:
    return reflectance * (exponent + 2.0) / (2.0 * np.pi) * _lobe(ix, iy, iz, ox, oy, oz, exponent)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, reflectance: Any) -> Any:
    return (exponent + 1.0) / (2.0 * np.pi) * _lobe(ix, iy, iz, ox, oy, oz, exponent)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, exponent: Any, reflectance: Any) -> Any:
    """Return wi about wo, and ρ (n + 2)/(n + 1) cosθi."""
    wx, wy, wz = lobe_sample(u0, u1, ox, oy, oz, exponent)
    scale = reflectance * (exponent + 2.0) / (exponent + 1.0)
    return wx, wy, wz, select((wz > 0.0) & (oz > 0.0), scale * wz, 0.0)


@dataclass(frozen=True, kw_only=True)
class Retro(ScalarBSDF):
    """The retro-reflective cosine lobe, f = ρ (n + 2)/(2π) cosⁿα, with α the angle between wi and wo.

    Parameters
    ----------
    exponent : float
        n [1], in [1, 1e6]. The lobe's half-width at half its height is about √(1.39/n) rad.
    reflectance : float or sequence of float
        ρ, the albedo at normal incidence [1], in [0, 1].

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> import numpy as np
    >>> peak = Retro(exponent=10.0)([0.6, 0, 0.8], [0.6, 0, 0.8])
    >>> peak == 12 / (2 * np.pi)
    np.True_
    """

    name = "retro"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"exponent": 1.0}, {"exponent": 100.0, "reflectance": 0.5})

    exponent: float = parameter("[1, 1e6]", "1", "exponent of the lobe's cosine", default=10.0)
    reflectance: Spectrum = parameter("[0, 1]", "1", "albedo at normal incidence", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with cosα from the dot product over the lengths."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, n = sympy.symbols("rho n", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        cosine = wi.dot(wo) / sympy.sqrt(wi.dot(wi) * wo.dot(wo))
        shape = sympy.Piecewise((cosine**n, cosine > 0), (0, True))
        return Twin(rho * (n + 2) / (2 * sympy.pi) * shape, {rho: self.reflectance, n: self.exponent})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.exponent, self.reflectance))

    @property
    def smooth(self) -> bool:
        """Whether cosⁿα ends softly enough where the lobe does: not for a small exponent."""
        return self.exponent >= 4.0

    def lobe_width(self) -> None:
        """Return None: a width is measured about the mirror direction, and the lobe is not there."""
        return None

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: the horizon cuts the lobe."""
        return Claims(reciprocity="yes", conserves=True)
