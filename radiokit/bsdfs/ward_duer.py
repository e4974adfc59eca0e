"""Ward-Dür: Ward's lobe with a normalisation that keeps a narrow lobe's albedo up to grazing angles.

Where the lobe reaches the horizon it gains energy, more than Ward's own form: the albedo tends to 0.282 ρ
α/cosθ, without bound. For α = 0.3 and ρ = 1 it passes 1 at 82.1° and is 386 at 89.99°; before that angle
it passes 1 wherever α exceeds 0.000202. ``ward_gmd`` is bounded.
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
from radiokit.physics.half import HORIZON
from radiokit.physics.ward import ward_density, ward_direction, ward_lobe

__all__ = ["WardDuer"]

SOURCE = Source(
    authors="Dür",
    year=2006,
    title="An Improved Normalization for the Ward Reflectance Model. Journal of Graphics Tools 11(1)",
    doi="10.1080/2151237X.2006.10129215",
    equation="the new normalisation, 1/(cosθi cosθo) for 1/√(cosθi cosθo)",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, rho: Any) -> Any:
    above = (iz > HORIZON) & (oz > HORIZON)
    density, up, square = ward_lobe(ix, iy, iz, ox, oy, oz, alpha_x, alpha_y)
    value = 0.25 * rho * density * (up / square) * (up / square) / select(above, iz * oz, 1.0)
    return select(above, value, 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, rho: Any
) -> Any:
    return ward_density(ix, iy, iz, ox, oy, oz, alpha_x, alpha_y)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha_x: Any, alpha_y: Any, rho: Any) -> Any:
    """Return wi about a Gaussian slope, and ρ hz³ / (2 |h|² cosθo)."""
    wx, wy, wz, above = ward_direction(u0, u1, ox, oy, oz, alpha_x, alpha_y)
    x, y, z = wx + ox, wy + oy, wz + oz
    weight = 0.5 * rho * (z * z * z) / (select(above, x * x + y * y + z * z, 1.0) * select(above, oz, 1.0))
    return wx, wy, wz, select(above, weight, 0.0)


@dataclass(frozen=True, kw_only=True)
class WardDuer(ScalarBSDF):
    """The Ward-Dür lobe, f = ρ exp(−tan²δ (cos²φ/αx² + sin²φ/αy²)) / (4π αx αy cosθi cosθo).

    Parameters
    ----------
    alpha_x, alpha_y : float
        Widths αx and αy of the slopes along x and y [1], in [1e-4, 1]; equal ones make it isotropic.
    reflectance : float or sequence of float
        ρ [1], in [0, 1]: the albedo of a narrow lobe away from the horizon.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> f = WardDuer(alpha_x=0.5, alpha_y=0.25)
    >>> round(float(f([0, 0, 1], [0, 0, 1])), 12) == round(2 / np.pi, 12)
    True
    """

    name = "ward_duer"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"alpha_x": 0.1, "alpha_y": 0.1, "reflectance": 0.5},
        {"alpha_x": 0.1, "alpha_y": 0.5},
        {"alpha_x": 0.001, "alpha_y": 0.001},
        {"alpha_x": 0.0003, "alpha_y": 0.0003},
    )

    alpha_x: float = parameter("[1e-4, 1]", "1", "width of the slopes along x", default=0.3)
    alpha_y: float = parameter("[1e-4, 1]", "1", "width of the slopes along y", default=0.3)
    reflectance: Spectrum = parameter("[0, 1]", "1", "factor of the lobe", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with δ and φ from the normalised half vector."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, a_x, a_y = sympy.symbols("rho alpha_x alpha_y", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        half = wi + wo
        length = sympy.sqrt(half.dot(half))
        x, y, z = half / length
        lobe = sympy.exp(-((x / a_x) ** 2 + (y / a_y) ** 2) / z**2)
        value = rho * lobe / (4 * sympy.pi * a_x * a_y * wi[2] * wo[2])
        return Twin(value, {rho: self.reflectance, a_x: self.alpha_x, a_y: self.alpha_y})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.alpha_x, self.alpha_y, self.reflectance))

    @property
    def isotropic(self) -> bool:
        """Whether the two widths are equal."""
        return self.alpha_x == self.alpha_y

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return the geometric mean of the widths."""
        return float(np.sqrt(self.alpha_x * self.alpha_y))

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving where the albedo stays within 1 up to 89.99°.

        It gains energy beyond, however narrow the lobe, unless the reflectance is 0.
        """
        return Claims(reciprocity="yes", conserves=largest_albedo(self) <= 1.0 + 1e-9)
