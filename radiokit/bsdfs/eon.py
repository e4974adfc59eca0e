"""EON: Oren-Nayar made to keep all energy, by giving back what its single scattering loses.

The diffuse base of OpenPBR. Fujii's form of Oren-Nayar, whose albedo has a closed form that never exceeds 1,
and a second lobe for what is scattered more than once, tinted by ρ at every bounce. White is lossless at any
roughness; the exact albedo is used, not the polynomial that the authors offer for speed.
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
from radiokit.measure.vectors import from_disk, leaning

__all__ = ["EON"]

SOURCE = Source(
    authors="Portsmouth, Kutz, Hill",
    year=2025,
    title="EON: A Practical Energy-Preserving Rough Diffuse BRDF. Journal of Computer Graphics "
    "Techniques 14(1)",
    doi="10.48550/arXiv.2410.18026",
    equation="listing 1, with the exact directional albedo of the Fujii-Oren-Nayar model",
)

_HORIZON = 1e-150  # a cosine below this is 0: f grows without bound towards two equal directions there
_C1 = 0.5 - 2.0 / (3.0 * np.pi)
_C2 = 2.0 / 3.0 - 28.0 / (15.0 * np.pi)
_OFFSET = 0.5 * np.pi - 2.0 / 3.0


@kernel
def _lost(sine: Any, z: Any) -> Any:
    """Return π (C₁ − G/π): the share of light lost by single scattering, over A r/π.

    Near grazing angles the loss vanishes with the cosine, which is drawn out of it.
    """
    rest = z / (1.0 + sine)  # (1 − sinθ)/cosθ
    inner = _OFFSET * rest - (2.0 / 3.0) * sine * (1.0 + sine + sine * sine) / (1.0 + sine)
    return z * (inner + sine * sine) + sine * atan2(z, sine)


@kernel
def _lean(ix: Any, iy: Any, ox: Any, oy: Any) -> Any:
    """Return s = sinθi sinθo cosΔφ where it is positive, and 0 elsewhere."""
    across = ix * ox + iy * oy
    return select(across > 0.0, across, 0.0)


@kernel
def _value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, single: Any, several: Any
) -> Any:
    above = (iz > _HORIZON) & (oz > _HORIZON)
    lean = _lean(ix, iy, ox, oy)
    higher = select(above, select(iz > oz, iz, oz), 1.0)
    x, y = ix + ox, iy + oy
    less = 0.5 * (x * x + y * y + iz * iz + oz * oz)  # 1 + s, which vanishes straight opposite at grazing
    once = select(lean > 0.0, 1.0 + roughness * (lean / higher), (1.0 - roughness) + roughness * less)
    lost = _lost(np.sqrt(ix * ix + iy * iy), iz) * _lost(np.sqrt(ox * ox + oy * oy), oz)
    return select(above, single * once + several * lost, 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, single: Any, several: Any
) -> Any:
    """Return the density of a cosine about the normal, and one about wo's horizontal direction."""
    total = 1.0 + 0.5 * roughness * np.sqrt(ox * ox + oy * oy)
    found = (iz + roughness * _lean(ix, iy, ox, oy)) / (np.pi * total)
    return select((iz > _HORIZON) & (oz > _HORIZON), found, 0.0)


@kernel
def _sample(
    u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, roughness: Any, single: Any, several: Any
) -> Any:
    """Return wi from one of the two lobes, and f cosθi / pdf, which is bounded."""
    x, y, z = from_disk(u0, u1)
    lx, ly, lz = leaning(x, y, z, ox, oy)
    upright = u2 * (1.0 + 0.5 * roughness * np.sqrt(ox * ox + oy * oy)) < 1.0
    wx, wy, wz = select(upright, x, lx), select(upright, y, ly), select(upright, z, lz)
    density = _density(wx, wy, wz, ox, oy, oz, roughness, single, several)
    value = _value(wx, wy, wz, ox, oy, oz, roughness, single, several)
    return wx, wy, wz, value * wz / select(density > 0.0, density, 1.0)


@dataclass(frozen=True, kw_only=True)
class EON(ScalarBSDF):
    """The energy-preserving Oren-Nayar model.

    f = ρ A/π (1 + r s/t) + ρ'/π (1 − E(θi)) (1 − E(θo)) / (1 − Ē), with s = sinθi sinθo cosΔφ and t the
    larger cosine where s > 0, 1 elsewhere; E is the albedo of the first part for ρ = 1, Ē its mean, and
    ρ' = ρ² Ē / (1 − ρ (1 − Ē)).

    Parameters
    ----------
    reflectance : float or sequence of float
        ρ, the single-scattering albedo [1], in [0, 1].
    roughness : float
        r [1], in [0, 1]; 0 is Lambert.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> import numpy as np
    >>> EON(roughness=0.0, reflectance=0.5)([0, 0, 1], [0.6, 0, 0.8]) == 0.5 / np.pi
    np.True_
    >>> EON(reflectance=1.0).claims.lossless
    True
    """

    name = "eon"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"roughness": 1.0, "reflectance": 1.0}, {"roughness": 0.0, "reflectance": 1.0})
    dimensions: ClassVar[int] = 3

    reflectance: Spectrum = parameter("[0, 1]", "1", "single-scattering albedo", spectral=True, default=0.9)
    roughness: float = parameter("[0, 1]", "1", "roughness", default=0.5)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in polar angles and azimuths, with E and Ē as the source gives them."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, r = sympy.symbols("rho r", nonnegative=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        pi, third = sympy.pi, sympy.Rational(1, 3)
        a = 1 / (1 + (sympy.Rational(1, 2) - 2 * third / pi) * r)

        def albedo(theta: sympy.Expr) -> sympy.Expr:
            s, c = sympy.sin(theta), sympy.cos(theta)
            g = s * (theta - s * c) + 2 * third * (s / c * (1 - s**3) - s)
            return a + r * a / pi * g

        theta_i = sympy.atan2(sympy.sqrt(x_i**2 + y_i**2), z_i)
        theta_o = sympy.atan2(sympy.sqrt(x_o**2 + y_o**2), z_o)
        turn = sympy.cos(sympy.atan2(y_i, x_i) - sympy.atan2(y_o, x_o))
        s = sympy.sin(theta_i) * sympy.sin(theta_o) * turn
        t = sympy.Piecewise((sympy.Max(sympy.cos(theta_i), sympy.cos(theta_o)), s > 0), (1, True))
        mean = a * (1 + (2 * third - 28 / (15 * pi)) * r)
        tint = rho**2 * mean / (1 - rho * (1 - mean))
        several = tint / pi * (1 - albedo(theta_i)) * (1 - albedo(theta_o)) / (1 - mean)
        first = rho / pi * a * (1 + r * s / t)
        return Twin(first + several if self.roughness else first, {rho: self.reflectance, r: self.roughness})

    def kernels(self) -> Kernels:
        """Return the kernels, whose constants are r and the two parts' factors."""
        rho, r = np.asarray(self.reflectance, dtype=float), self.roughness
        a = 1.0 / (1.0 + _C1 * r)
        missing = a * r * (_C1 - _C2)  # 1 − Ē
        tint = rho * rho * (1.0 - missing) / (1.0 - rho * missing)
        several = tint * (a * r / ((_C1 - _C2) * np.pi**3))
        return Kernels(_value, _density, _sample, (r, rho * (a / np.pi), several))

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, with the albedo ρ E + ρ' (1 − E); lossless when ρ = 1."""
        return Claims(
            reciprocity="yes", conserves=True, lossless=bool(np.all(np.equal(self.reflectance, 1.0)))
        )
