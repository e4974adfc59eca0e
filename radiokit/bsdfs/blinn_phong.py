"""Blinn-Phong: a power of the cosine between the half vector and the normal, as games normalise it.

For teaching what a normalisation is worth. Three constants are met; all are reciprocal, and the albedo of
each is largest at normal incidence, where it has a closed form:

- "exact", (n + 2)(n + 4)/(8π (2^(−n/2) + n)): 1 there for every n, and less elsewhere;
- "n+8", (n + 8)/(8π), the former's approximation for large n: it gains energy for every n, 7.52 % for n =
  9, the worst, 7.48 % for n = 10 and 1.81 % for n = 100;
- "n+2", (n + 2)/(8π), of a microfacet model with G = cosθi cosθo: (2^(−n/2) + n)/(n + 4), which never
  gains.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.elementary import sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics.facet import reflect
from radiokit.physics.half import HORIZON, cosine_power, half_length, power_slope

__all__ = ["BlinnPhong"]

SOURCE = Source(
    authors="Blinn",
    year=1977,
    title="Models of Light Reflection for Computer Synthesized Pictures. SIGGRAPH '77",
    doi="10.1145/563858.563893",
    equation="the distribution D1 = cosⁿδ; the constants from Giesen (2009), Phong and Blinn-Phong "
    'Normalization Factors ("exact"), and Akenine-Möller, Haines, Hoffman (2008), Real-Time Rendering, 3rd '
    'edition, section 7.6 ("n+8"); "n+2" is D of Walter et al. (2007), doi:10.2312/EGWR/EGSR07/195-206, '
    "equation 30",
)

CONSTANTS: dict[str, Any] = {
    "exact": lambda n, pi: (n + 2) * (n + 4) / (8 * pi * (2 ** (-n / 2) + n)),
    "n+8": lambda n, pi: (n + 8) / (8 * pi),
    "n+2": lambda n, pi: (n + 2) / (8 * pi),
}
"""The constant [sr⁻¹] of each normalisation, as a function of n and π."""


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, scale: Any, rho: Any) -> Any:
    above = (iz > HORIZON) & (oz > HORIZON)
    return select(
        above, rho * scale * cosine_power(ix + ox, iy + oy, select(above, iz + oz, 1.0), exponent), 0.0
    )


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, exponent: Any, scale: Any, rho: Any
) -> Any:
    """Return (n + 1)/(2π) cosⁿδ / (4 wo·ĥ)."""
    above = (iz > HORIZON) & (oz > HORIZON)
    lobe = cosine_power(ix + ox, iy + oy, select(above, iz + oz, 1.0), exponent)
    length = select(above, half_length(ix, iy, iz, ox, oy, oz), 1.0)
    return select(above, (exponent + 1.0) / (4.0 * np.pi) * lobe / length, 0.0)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, exponent: Any, scale: Any, rho: Any) -> Any:
    """Return wi about a half vector of density (n + 1)/(2π) cosⁿδ; the powers cancel in the weight."""
    slope = power_slope(u0, exponent)
    sine, cosine = sincos(u1)
    wx, wy, wz = reflect(ox, oy, oz, slope * cosine, slope * sine, 1.0)
    share = rho * scale * (4.0 * np.pi) / (exponent + 1.0)
    weight = share * half_length(wx, wy, wz, ox, oy, oz) * wz
    return wx, wy, wz, select((wz > HORIZON) & (oz > HORIZON), weight, 0.0)


@dataclass(frozen=True, kw_only=True)
class BlinnPhong(ScalarBSDF):
    """The Blinn-Phong lobe, f = ρ N(n) cosⁿδ, with δ the angle between half vector and normal.

    Parameters
    ----------
    exponent : float
        n [1], in [1, 1e6]. About four times Phong's exponent for a highlight of the same size.
    normalization : {"exact", "n+8", "n+2"}
        Which constant N is.
    reflectance : float or sequence of float
        ρ [1], in [0, 1]: with "exact", the albedo at normal incidence.

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or the normalisation is none of the three.

    >>> f = BlinnPhong(exponent=10.0, normalization="n+8")
    >>> float(f([0, 0, 1], [0, 0, 1])) == 18 / (8 * np.pi)
    True
    """

    name = "blinn_phong"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"normalization": "n+8"},
        {"normalization": "n+8", "reflectance": 0.9},
        {"normalization": "n+2", "exponent": 1.0},
        {"exponent": 1e4},
    )

    exponent: float = parameter("[1, 1e6]", "1", "exponent of the half vector's cosine", default=10.0)
    normalization: Literal["exact", "n+8", "n+2"] = field(default="exact")
    reflectance: Spectrum = parameter("[0, 1]", "1", "factor of the lobe", spectral=True, default=1.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.normalization not in CONSTANTS:
            raise ParameterError(
                "normalization", self.normalization, f"one of {', '.join(map(repr, CONSTANTS))}"
            )

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with cosδ from the normalised half vector."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, n = sympy.symbols("rho n", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        half = wi + wo
        cosine = half[2] / sympy.sqrt(half.dot(half))
        constant = CONSTANTS[self.normalization](n, sympy.pi)
        return Twin(rho * constant * cosine**n, {rho: self.reflectance, n: self.exponent})

    def kernels(self) -> Kernels:
        """Return the kernels, with the normalisation as a number."""
        constant = float(CONSTANTS[self.normalization](self.exponent, np.pi))
        return Kernels(_value, _density, _sample, (self.exponent, constant, self.reflectance))

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return the median slope of the half vectors, over their own density."""
        return float(power_slope(0.5, self.exponent))

    def normal_albedo(self) -> Any:
        """Return the albedo at normal incidence [1], the largest, of shape () or (K,).

        >>> round(BlinnPhong(exponent=10.0, normalization="n+8").normal_albedo(), 4)
        1.0748
        """
        ratio = CONSTANTS[self.normalization](self.exponent, 1.0) / CONSTANTS["exact"](self.exponent, 1.0)
        return (
            ratio * np.asarray(self.reflectance)
            if isinstance(self.reflectance, tuple)
            else ratio * self.reflectance
        )

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving where the albedo at normal incidence is at most 1."""
        return Claims(reciprocity="yes", conserves=bool(np.all(self.normal_albedo() <= 1.0)))
