"""Oren-Nayar: a rough diffuse surface, made of Lambertian grooves; the short, qualitative form.

For clay, plaster and the Moon: flatter than Lambert towards the edge, and brighter where light comes from. It
gains energy when it is bright and not very rough. The albedo rises with the angle, to

    ρ (A + B/2) as θ → 90°, with A = 1 − σ²/(2σ² + 0.66) and B = 0.45 σ²/(σ² + 0.09):

above 1 for ρ = 1 and 0 < σ < √(0.02925/0.275) = 0.3261; 1.00536 at σ = 0.3 (1.00409 at 89°), and 1.01518 at
worst, at σ = 0.1985. So it conserves when ρ ≤ 1/(A + B/2). ``eon`` conserves whatever its parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.measure.vectors import from_disk, leaning

__all__ = ["OrenNayar"]

SOURCE = Source(
    authors="Oren, Nayar",
    year=1994,
    title="Generalization of Lambert's Reflectance Model. SIGGRAPH 94",
    doi="10.1145/192161.192213",
    equation="the qualitative model, with 0.33 in A; the paper's 0.57, a makeshift for the interreflection "
    "that is left out, is not used",
)

_HORIZON = 1e-150  # a cosine below this is 0: f grows without bound towards two equal directions there


@kernel
def _lean(ix: Any, iy: Any, ox: Any, oy: Any) -> Any:
    """Return sinθi sinθo max(0, cosΔφ)."""
    across = ix * ox + iy * oy
    return select(across > 0.0, across, 0.0)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, a: Any, b: Any, reflectance: Any) -> Any:
    """Return ρ/π (A + B sinα tanβ max(0, cosΔφ)): sinα sinβ = sinθi sinθo, and cosβ is the larger cosine."""
    above = (iz > _HORIZON) & (oz > _HORIZON)
    higher = select(above, select(iz > oz, iz, oz), 1.0)
    return select(above, reflectance / np.pi * (a + b * _lean(ix, iy, ox, oy) / higher), 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, a: Any, b: Any, reflectance: Any) -> Any:
    """Return the density of a cosine about the normal, and one about wo's horizontal direction."""
    above = (iz > _HORIZON) & (oz > _HORIZON)
    total = a + 0.5 * b * np.sqrt(ox * ox + oy * oy)
    return select(above, (a * iz + b * _lean(ix, iy, ox, oy)) / (np.pi * total), 0.0)


@kernel
def _sample(u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, a: Any, b: Any, reflectance: Any) -> Any:
    """Return wi, and a weight that is at most ρ (A + B sinθo/2)."""
    total = a + 0.5 * b * np.sqrt(ox * ox + oy * oy)
    x, y, z = from_disk(u0, u1)
    lx, ly, lz = leaning(x, y, z, ox, oy)
    upright = u2 * total < a
    wx, wy, wz = select(upright, x, lx), select(upright, y, ly), select(upright, z, lz)
    above = (wz > _HORIZON) & (oz > _HORIZON)
    lean = b * _lean(wx, wy, ox, oy)
    higher = select(above, select(wz > oz, wz, oz), 1.0)
    share = wz * (a + lean / higher) / select(above, a * wz + lean, 1.0)
    return wx, wy, wz, select(above, reflectance * total * share, 0.0)


@dataclass(frozen=True, kw_only=True)
class OrenNayar(ScalarBSDF):
    """The qualitative Oren-Nayar model, f = ρ/π (A + B max(0, cosΔφ) sinα tanβ).

    α is the larger of the polar angles and β the smaller.

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

    >>> f = OrenNayar(reflectance=1.0, sigma=0.3)
    >>> f.claims.conserves, OrenNayar(reflectance=0.99, sigma=0.3).claims.conserves
    (False, True)
    >>> round(float(f([0, 0, 1], [0, 0, 1])) * 3.141592653589793, 6)  # A
    0.892857
    """

    name = "oren_nayar"
    kind = "diffuse"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"reflectance": 1.0},
        {"sigma": 0.0, "reflectance": 1.0},
        {"sigma": 1.2, "reflectance": 1.0},
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
        a = 1 - sigma**2 / (2 * (sigma**2 + sympy.Rational(33, 100)))
        b = sympy.Rational(45, 100) * sigma**2 / (sigma**2 + sympy.Rational(9, 100))
        value = rho / sympy.pi * (a + b * sympy.Max(0, turn) * sympy.sin(alpha) * sympy.tan(beta))
        return Twin(value, {rho: self.reflectance, sigma: self.sigma})

    def kernels(self) -> Kernels:
        """Return the kernels, whose constants are A, B and ρ."""
        return Kernels(_value, _density, _sample, (*self._coefficients(), self.reflectance))

    def _coefficients(self) -> tuple[float, float]:
        square = self.sigma * self.sigma
        return 1.0 - 0.5 * square / (square + 0.33), 0.45 * square / (square + 0.09)

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving when ρ (A + B/2) ≤ 1, and lossless when it is a white Lambert surface.

        With G(θ) = sinθ (θ − sinθ cosθ) + ⅔ tanθ (1 − sin³θ), the albedo is ρ (A + B G/π). G' is at least
        ⅔ (1 − sin³θ)/cos²θ > 0, so the supremum is the limit at 90°, where G is π/2.
        """
        a, b = self._coefficients()
        return Claims(
            reciprocity="yes",
            conserves=bool(np.all(np.asarray(self.reflectance) * (a + 0.5 * b) <= 1.0)),
            lossless=self.sigma == 0.0 and bool(np.all(np.equal(self.reflectance, 1.0))),
        )
