"""Phong, original: the cosine lobe of 1975 as it stands, which as a BRDF breaks both laws.

Phong gave the light that is seen, k_s cosⁿα for unit flux on a plane that faces the light, without a
cosine of incidence. A BRDF must have it in the denominator, f = k_s cosⁿα / cosθi. For teaching what that
costs: it is not reciprocal, f(wi, wo)/f(wo, wi) = cosθo/cosθi, and for fixed wi the albedo grows as
1/cosθi without bound. For n = 10 and k_s = 0.5 it is 0.262 at normal incidence, 1 at 87.9° and 185 at
89.99°. ``phong`` obeys both laws.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.gain import largest_albedo
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics.cosine_lobe import lobe_sample, median_slope, mirror_lobe
from radiokit.physics.half import HORIZON

__all__ = ["PhongOriginal"]

SOURCE = Source(
    authors="Phong",
    year=1975,
    title="Illumination for Computer Generated Pictures. Communications of the ACM 18(6)",
    doi="10.1145/360825.360839",
    equation="the specular term W(i) cosⁿ(s) of the shading formula; the division by cosθi that makes a BRDF "
    "of it: Lewis (1993), Making Shaders More Physically Plausible, Eurographics Workshop on Rendering",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, coefficient: Any) -> Any:
    above = (iz > HORIZON) & (oz > HORIZON)
    lobe = select(above, mirror_lobe(ix, iy, iz, ox, oy, oz, exponent), 0.0)
    return coefficient * lobe / select(above, iz, 1.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, coefficient: Any) -> Any:
    return (exponent + 1.0) / (2.0 * np.pi) * mirror_lobe(ix, iy, iz, ox, oy, oz, exponent)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, exponent: Any, coefficient: Any) -> Any:
    """Return wi about the mirror direction, and 2π k_s/(n + 1): the cosines cancel."""
    wx, wy, wz = lobe_sample(u0, u1, -ox, -oy, oz, exponent)
    share = coefficient * (2.0 * np.pi) / (exponent + 1.0)
    return wx, wy, wz, select((wz > HORIZON) & (oz > HORIZON), share, 0.0)


@dataclass(frozen=True, kw_only=True)
class PhongOriginal(ScalarBSDF):
    """Phong's lobe of 1975, f = k_s cosⁿα / cosθi, with α the angle from the mirror direction.

    Parameters
    ----------
    exponent : float
        n [1], in [1, 1e6]; Phong used 1 to 10.
    coefficient : float or sequence of float
        k_s [sr⁻¹], in [0, 1]: Phong's W, which he let range from 0.1 to 0.8. The albedo for fixed wo is at
        most 2π k_s/(n + 1), at normal incidence.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> f = PhongOriginal(exponent=10.0, coefficient=0.5)
    >>> float(f([-0.6, 0, 0.8], [0.6, 0, 0.8])), float(f([0, 0, 1], [0, 0, 1]))
    (0.625, 0.5)
    """

    name = "phong_original"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"exponent": 4.0, "coefficient": 0.1}, {"exponent": 200.0, "coefficient": 0.8})

    exponent: float = parameter("[1, 1e6]", "1", "exponent of the lobe's cosine", default=10.0)
    coefficient: Spectrum = parameter("[0, 1]", "1/sr", "radiance for unit flux", spectral=True, default=0.5)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with cosα from the mirror direction's dot product over the lengths."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        k_s, n = sympy.symbols("k_s n", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        mirror = sympy.Matrix([-wo[0], -wo[1], wo[2]])
        cosine = mirror.dot(wi) / sympy.sqrt(mirror.dot(mirror) * wi.dot(wi))
        lobe = sympy.Piecewise((cosine**n, cosine > 0), (0, True))
        return Twin(k_s * lobe / wi[2], {k_s: self.coefficient, n: self.exponent})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.exponent, self.coefficient))

    @property
    def smooth(self) -> bool:
        """Whether cosⁿα ends softly enough where the lobe does: not for a small exponent."""
        return self.exponent >= 4.0

    def lobe_width(self) -> float:
        """Return the median slope of the half vectors."""
        return median_slope(self.exponent)

    @property
    def claims(self) -> Claims:
        """Neither reciprocal nor conserving, unless it is black.

        The albedo is followed to 89.99°: a lobe so narrow or faint that it has not passed 1 by then (n above
        590 for k_s = 1) is said to conserve, though it gains beyond.
        """
        black = not np.any(self.coefficient)
        gains = not black and max(largest_albedo(self, fixed=side) for side in ("wi", "wo")) > 1.0 + 1e-9
        return Claims(reciprocity="yes" if black else "no", conserves=not gains)
