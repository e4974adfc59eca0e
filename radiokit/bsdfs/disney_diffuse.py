"""Disney diffuse: Lambert with a Fresnel factor each way, and a bright rim where the surface is rough.

The diffuse part of Burley's principled material, made to look right. It gains energy when it is rough: for a
roughness r, the albedo is a polynomial in cosθ, ρ (41/42 + 5/84 r) at normal incidence and ρ (41/84 + r +
5/72 r²) as θ → 90°. With ρ = 1 it exceeds 1 for r > 0.4, first at normal incidence, and is 1.5575 at most.
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
from radiokit.measure.vectors import from_disk

__all__ = ["DisneyDiffuse"]

SOURCE = Source(
    authors="Burley",
    year=2012,
    title="Physically-Based Shading at Disney. SIGGRAPH Course, Practical Physically-Based Shading in "
    "Film and Game Production",
    doi="10.1145/2343483.2343493",
    equation="section 5.3, the base diffuse model with F_D90 = 0.5 + 2 roughness cos²θd",
)


@kernel
def _fresnel(z: Any, rise: Any) -> Any:
    """Return 1 + (F_D90 − 1)(1 − cosθ)⁵."""
    x = 1.0 - z
    square = x * x
    return 1.0 + rise * (square * square * x)


@kernel
def _shape(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any) -> Any:
    """Return both factors' product; cos²θd = |wi + wo|²/4 for unit vectors."""
    x, y, z = ix + ox, iy + oy, iz + oz
    rise = 0.5 * roughness * (x * x + y * y + z * z) - 0.5
    return _fresnel(iz, rise) * _fresnel(oz, rise)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, reflectance: Any) -> Any:
    shape = _shape(ix, iy, iz, ox, oy, oz, roughness)
    return select((iz > 0.0) & (oz > 0.0), reflectance / np.pi * shape, 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, reflectance: Any) -> Any:
    return select((iz > 0.0) & (oz > 0.0), iz / np.pi, 0.0)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, roughness: Any, reflectance: Any) -> Any:
    x, y, z = from_disk(u0, u1)
    shape = _shape(x, y, z, ox, oy, oz, roughness)
    return x, y, z, select((z > 0.0) & (oz > 0.0), reflectance * shape, 0.0)


@dataclass(frozen=True, kw_only=True)
class DisneyDiffuse(ScalarBSDF):
    """Burley's diffuse model, f = ρ/π (1 + (F_D90 − 1)(1 − cosθi)⁵) (1 + (F_D90 − 1)(1 − cosθo)⁵).

    F_D90 = 0.5 + 2 roughness cos²θd, with θd the angle between wi and the half vector.

    Parameters
    ----------
    reflectance : float or sequence of float
        ρ, the base colour [1], in [0, 1].
    roughness : float
        [1], in [0, 1].

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> import numpy as np
    >>> DisneyDiffuse(reflectance=0.5)([0, 0, 1], [0, 0, 1]) == 0.5 / np.pi
    np.True_
    >>> DisneyDiffuse(roughness=0.4).claims.conserves, DisneyDiffuse(roughness=0.41).claims.conserves
    (True, False)
    """

    name = "disney_diffuse"
    kind = "diffuse"
    SOURCE = SOURCE
    EXAMPLES = ({"reflectance": 0.6}, {"roughness": 0.0}, {"roughness": 0.5}, {"roughness": 1.0})

    reflectance: Spectrum = parameter("[0, 1]", "1", "base colour", spectral=True, default=1.0)
    roughness: float = parameter("[0, 1]", "1", "roughness", default=0.4)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with the half vector of the source."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, roughness = sympy.symbols("rho roughness", nonnegative=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        wi, wo = wi / sympy.sqrt(wi.dot(wi)), wo / sympy.sqrt(wo.dot(wo))
        half = wi + wo
        cos_d = (wi.dot(half) + wo.dot(half)) / (2 * sympy.sqrt(half.dot(half)))  # the same for both
        rise = sympy.Rational(1, 2) + 2 * roughness * cos_d**2 - 1
        value = rho / sympy.pi * (1 + rise * (1 - wi[2]) ** 5) * (1 + rise * (1 - wo[2]) ** 5)
        return Twin(value, {rho: self.reflectance, roughness: self.roughness})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.roughness, self.reflectance))

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving when ρ times the highest value of the albedo's polynomial is at most 1."""
        highest = float(np.max(self.reflectance)) * _highest(self.roughness)
        return Claims(reciprocity="yes", conserves=highest <= 1.0 + 1e-15)


def _highest(r: float) -> float:
    """Return the supremum of the albedo for ρ = 1.

    With μ = cosθ, c = (1 − μ)⁵ and q = r − ½, F_D90 − 1 is q + r μμi + r sinθ sinθi cosφ. Its mean and its
    mean square over φ, and ∫ μiʲ⁺¹ (1 − μi)⁵ dμi = 1/42, 1/168, 1/504 for j = 0, 1, 2, give the polynomial.
    """
    mu = np.polynomial.Polynomial([0.0, 1.0])
    q, c = r - 0.5, (1 - mu) ** 5
    first = q / 42 + r * mu / 168 + c * (q / 2 + r * mu / 3)
    square = q * q / 42 + q * r * mu / 84 + r * r * (mu * mu / 504 + (1 - mu * mu) * (11 / 1008))
    mean = 1 + 2 * (first + c * square)
    turns = mean.deriv().roots()
    inside = turns.real[(np.abs(turns.imag) < 1e-9) & (turns.real > 0) & (turns.real < 1)]
    return float(np.max(mean(np.concatenate([[0.0, 1.0], inside]))))
