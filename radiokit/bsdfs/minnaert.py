"""Minnaert: powers of the cosines, for surfaces whose edge is darker, or brighter, than Lambert's.

The empirical law of planetary photometry: one exponent k, which is 1 for Lambert and about 0.5 for the full
Moon. Normalised here so that the albedo is ρ at normal incidence; it is ρ cosᵏ⁻¹θ elsewhere. So it conserves
for k ≥ 1, and for k < 1 it gains energy, without bound as θ → 90°, beyond the angle whose cosine is ρ to the
power 1/(1 − k): 60° for k = 0.5 and ρ = 0.707, 83.8° for k = 0.9 and ρ = 0.8.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.elementary import exp, expm1, log, sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin

__all__ = ["Minnaert"]

SOURCE = Source(
    authors="Minnaert",
    year=1941,
    title="The Reciprocity Principle in Lunar Photometry. The Astrophysical Journal 93",
    doi="10.1086/144279",
    equation="the reciprocal law of powers, π A (cosθi)ᵏ (cosθo)ᵏ⁻¹ as a radiance factor; with "
    "A = ρ (k + 1)/(2π) it has the albedo ρ at normal incidence",
)

_HORIZON = 1e-150  # a cosine below this is 0: f grows without bound for k < 1


@kernel
def _power(z: Any, exponent: Any) -> Any:
    return exp(exponent * log(select(z > _HORIZON, z, 1.0)))


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, darkening: Any, reflectance: Any) -> Any:
    above = (iz > _HORIZON) & (oz > _HORIZON)
    scale = reflectance * (darkening + 1.0) / (2.0 * np.pi)
    return select(above, scale * _power(iz, darkening - 1.0) * _power(oz, darkening - 1.0), 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, darkening: Any, reflectance: Any) -> Any:
    above = (iz > _HORIZON) & (oz > _HORIZON)
    return select(above, (darkening + 1.0) / (2.0 * np.pi) * iz * _power(iz, darkening - 1.0), 0.0)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, darkening: Any, reflectance: Any) -> Any:
    """Return wi whose density is proportional to cosᵏθi, and the weight, which is the albedo."""
    log_cosine = log(1.0 - u0) / (darkening + 1.0)
    z = exp(log_cosine)
    radius = np.sqrt(-expm1(2.0 * log_cosine))
    sine, cosine = sincos(u1)
    weight = select(oz > _HORIZON, reflectance * _power(oz, darkening - 1.0), 0.0)
    return radius * cosine, radius * sine, z, weight


@dataclass(frozen=True, kw_only=True)
class Minnaert(ScalarBSDF):
    """Minnaert's law, f = ρ (k + 1)/(2π) (cosθi cosθo)ᵏ⁻¹.

    Parameters
    ----------
    darkening : float
        k, the exponent of limb darkening [1], in [0, 4]: 1 is Lambert, less brightens the edge.
    reflectance : float or sequence of float
        ρ, the albedo at normal incidence [1], in [0, 1].

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> import numpy as np
    >>> Minnaert(darkening=1.0, reflectance=0.5)([0, 0, 1], [0.6, 0, 0.8]) == 0.5 / np.pi
    np.True_
    >>> Minnaert(darkening=0.5).claims.conserves
    False
    """

    name = "minnaert"
    kind = "diffuse"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"darkening": 1.0, "reflectance": 1.0},
        {"darkening": 0.5, "reflectance": 0.5},
        {"darkening": 3.0},
    )

    darkening: float = parameter("[0, 4]", "1", "exponent of limb darkening", default=1.25)
    reflectance: Spectrum = parameter("[0, 1]", "1", "albedo at normal incidence", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with the cosines of the polar angles."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, k = sympy.symbols("rho k", nonnegative=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        mu_i, mu_o = z_i / sympy.sqrt(x_i**2 + y_i**2 + z_i**2), z_o / sympy.sqrt(x_o**2 + y_o**2 + z_o**2)
        value = rho * (k + 1) / (2 * sympy.pi) * mu_i ** (k - 1) * mu_o ** (k - 1)
        return Twin(value, {rho: self.reflectance, k: self.darkening})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.darkening, self.reflectance))

    @property
    def smooth(self) -> bool:
        """Whether cosᵏθ is a polynomial; else the horizon is a branch point."""
        return self.darkening == round(self.darkening)

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving for k ≥ 1, or when it is black; lossless as a white Lambert surface."""
        black = not np.any(self.reflectance)
        return Claims(
            reciprocity="yes",
            conserves=self.darkening >= 1.0 or black,
            lossless=self.darkening == 1.0 and bool(np.all(np.equal(self.reflectance, 1.0))),
        )
