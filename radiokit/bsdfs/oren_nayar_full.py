"""Oren-Nayar in full: the rough diffuse surface with all terms that the authors fitted, and a second bounce.

Darker than the qualitative form away from the light, and with ρ² for what two facets reflect. Take it to see
what the short form leaves out. Its albedo rises with the angle, from ρ C₁ + 0.17 ρ² σ²/(σ² + 0.13) at normal
incidence to, as θ → 90°,

    ρ (C₁ + 0.177197 σ²/(σ² + 0.09)) + 0.17 ρ² σ²/(σ² + 0.13), with C₁ = 1 − σ²/(2σ² + 0.66),

so that for ρ = 1 it gains energy for 0 < σ < 0.6276: 1.05102 at worst, at σ = 0.3044. At grazing angles,
straight across from the light, the fit turns negative, for σ above 0.664 when ρ is small: there f is 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.elementary import atan2
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.measure.vectors import even, from_disk, leaning

__all__ = ["OrenNayarFull"]

SOURCE = Source(
    authors="Oren, Nayar",
    year=1994,
    title="Generalization of Lambert's Reflectance Model. SIGGRAPH 94",
    doi="10.1145/192161.192213",
    equation="the functional approximation: C₁, C₂ and C₃ of the direct illumination, and the "
    "interreflection term; cut off at 0, below which the fit falls",
)

_HORIZON = 1e-150  # a cosine below this is 0: f grows without bound towards two equal directions there
_GRAZING = (9.0 * (np.pi**4 + 12 * np.pi**2 - 48)) / (160 * np.pi**4) + (np.pi - 2) * (
    np.pi**3 + 54 * np.pi - 96
) / (48 * np.pi**3)  # 0.177197: ∫ of the terms of C₂ and C₃ at θo = 90°


@kernel
def _value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, c1: Any, rough: Any, second: Any, reflectance: Any
) -> Any:
    """Return f, with the terms that grow as 1/cosθ at grazing angles written in the angles' complements."""
    above = (iz > _HORIZON) & (oz > _HORIZON)
    sine_i, sine_o = np.sqrt(ix * ix + iy * iy), np.sqrt(ox * ox + oy * oy)
    both = sine_i * sine_o
    across, askew = ix * ox + iy * oy, ix * oy - iy * ox
    turn, skew = across / select(both > 0.0, both, 1.0), askew / select(both > 0.0, both, 1.0)
    higher = iz > oz
    sine_b, cosine_b = select(higher, sine_i, sine_o), select(above, select(higher, iz, oz), 1.0)
    sine_a, cosine_a = select(higher, sine_o, sine_i), select(above, select(higher, oz, iz), 1.0)
    a = atan2(sine_a, cosine_a) / (0.5 * np.pi)  # 2α/π
    gap = atan2(cosine_b, sine_b) / (0.5 * np.pi)  # 1 − 2β/π
    b = 1.0 - gap
    # sinα − (2β/π)³ = 1 − (1 − gap)³ − (1 − sinα)
    less = gap * (3.0 - gap * (3.0 - gap)) - cosine_a * cosine_a / (1.0 + sine_a)
    towards = 0.45 * across / cosine_b
    away = 0.45 * turn * less * (sine_b / cosine_b)
    slope = (sine_a + sine_b) / (cosine_a + cosine_b)  # tan((α + β)/2)
    beside = 0.125 * (a * b) * (a * b) * slope * (skew * skew / (1.0 + abs(turn)))
    direct = c1 + rough * (select(turn > 0.0, towards, away) + beside)
    total = direct + reflectance * second * (1.0 - turn * b * b)
    return select(above & (total > 0.0), reflectance / np.pi * total, 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, c1: Any, rough: Any, second: Any, reflectance: Any
) -> Any:
    """Return the density of three lobes: about the normal, about wo's horizontal direction, even."""
    upright, across = c1 + second, ix * ox + iy * oy
    sine = np.sqrt(ox * ox + oy * oy)
    lean = 0.45 * rough * select(across > 0.0, across, 0.0)
    total = upright + rough * sine * (0.225 + 0.125)
    found = (upright * iz + lean + 0.0625 * rough * sine) / (np.pi * total)
    return select((iz > _HORIZON) & (oz > _HORIZON), found, 0.0)


@kernel
def _sample(
    u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, c1: Any, rough: Any, second: Any, reflectance: Any
) -> Any:
    """Return wi from one of the lobes, and f cosθi / pdf, which is bounded as f cosθi is."""
    x, y, z = from_disk(u0, u1)
    lx, ly, lz = leaning(x, y, z, ox, oy)
    ex, ey, ez = even(x, y, z)
    upright, edge = c1 + second, rough * np.sqrt(ox * ox + oy * oy)
    pick = u2 * (upright + edge * (0.225 + 0.125))
    first, third = pick < upright, pick >= upright + 0.225 * edge
    wx = select(first, x, select(third, ex, lx))
    wy = select(first, y, select(third, ey, ly))
    wz = select(first, z, select(third, ez, lz))
    density = _density(wx, wy, wz, ox, oy, oz, c1, rough, second, reflectance)
    value = _value(wx, wy, wz, ox, oy, oz, c1, rough, second, reflectance)
    return wx, wy, wz, value * wz / select(density > 0.0, density, 1.0)


@dataclass(frozen=True, kw_only=True)
class OrenNayarFull(ScalarBSDF):
    """The full Oren-Nayar model, with interreflection.

    f = ρ/π (C₁ + C₂ cosΔφ tanβ + C₃ (1 − |cosΔφ|) tan((α + β)/2))
    + 0.17 ρ²/π σ²/(σ² + 0.13) (1 − cosΔφ (2β/π)²), or 0 where that is negative; α is the larger of the polar
    angles and β the smaller.

    Parameters
    ----------
    reflectance : float or sequence of float
        ρ, the reflectance of the facets [1], in [0, 1].
    sigma : float
        σ, the standard deviation of the facets' angle [rad], in [0, π/2]; 0 is Lambert.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> f = OrenNayarFull(reflectance=1.0, sigma=0.3)
    >>> f.claims.conserves, OrenNayarFull(reflectance=0.95, sigma=0.3).claims.conserves
    (False, True)
    """

    name = "oren_nayar_full"
    kind = "diffuse"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"reflectance": 1.0},
        {"sigma": 0.0, "reflectance": 1.0},
        {"sigma": 1.2, "reflectance": 0.2},
    )
    dimensions: ClassVar[int] = 3

    reflectance: Spectrum = parameter("[0, 1]", "1", "reflectance of the facets", spectral=True, default=0.9)
    sigma: float = parameter(
        "[0, 1.5707963267948966]", "rad", "standard deviation of the facets' angle", default=0.3
    )

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the polar angles and azimuths of the source."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, sigma = sympy.symbols("rho sigma", nonnegative=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        theta_i = sympy.atan2(sympy.sqrt(x_i**2 + y_i**2), z_i)
        theta_o = sympy.atan2(sympy.sqrt(x_o**2 + y_o**2), z_o)
        alpha, beta = sympy.Max(theta_i, theta_o), sympy.Min(theta_i, theta_o)
        turn = sympy.cos(sympy.atan2(y_i, x_i) - sympy.atan2(y_o, x_o))
        percent, pi = sympy.Rational(1, 100), sympy.pi
        rough = sigma**2 / (sigma**2 + 9 * percent)
        c1 = 1 - sigma**2 / (2 * (sigma**2 + 33 * percent))
        near, far = sympy.sin(alpha), sympy.sin(alpha) - (2 * beta / pi) ** 3
        c2 = 45 * percent * rough * sympy.Piecewise((near, turn >= 0), (far, True))
        c3 = rough / 8 * (4 * alpha * beta / pi**2) ** 2
        direct = c1 + turn * c2 * sympy.tan(beta) + (1 - abs(turn)) * c3 * sympy.tan((alpha + beta) / 2)
        bounce = 17 * percent * sigma**2 / (sigma**2 + 13 * percent) * (1 - turn * (2 * beta / pi) ** 2)
        value = sympy.Max(0, rho / pi * direct + rho**2 / pi * bounce)
        return Twin(value, {rho: self.reflectance, sigma: self.sigma})

    def kernels(self) -> Kernels:
        """Return the kernels, whose constants are C₁, σ²/(σ² + 0.09), 0.17 σ²/(σ² + 0.13) and ρ."""
        return Kernels(_value, _density, _sample, (*self._coefficients(), self.reflectance))

    def _coefficients(self) -> tuple[float, float, float]:
        square = self.sigma * self.sigma
        return 1.0 - 0.5 * square / (square + 0.33), square / (square + 0.09), 0.17 * square / (square + 0.13)

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving when the albedo's limit at 90° is at most 1; lossless as white Lambert."""
        (c1, rough, second), rho = self._coefficients(), np.asarray(self.reflectance)
        return Claims(
            reciprocity="yes",
            conserves=bool(np.all(rho * (c1 + _GRAZING * rough) + rho * rho * second <= 1.0)),
            lossless=self.sigma == 0.0 and bool(np.all(np.equal(rho, 1.0))),
        )
