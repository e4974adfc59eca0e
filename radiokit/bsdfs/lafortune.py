"""Lafortune: a cosine lobe about any linear image of the viewing direction, for fits to measurements.

One lobe of the generalised cosine model: (−1, −1, 1) is ``phong``, (1, 1, 1) reflects back to where the
light came from, a Cz below 1 turns the lobe to the horizon, and Cx ≠ Cy makes it anisotropic. It is
reciprocal. The albedo is that of Phong's lobe about C wo times |C wo|ⁿ: it is at most ρ while no
coefficient exceeds 1 in size, and ρ at normal incidence for Cz = 1. Beyond, it gains: for (−1.2, −1.2,
0.9) and n = 10 it is 1.4456 at 64.5°.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.elementary import exp, log
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics.cosine_lobe import lobe_sample, median_slope

__all__ = ["Lafortune"]

SOURCE = Source(
    authors="Lafortune, Foo, Torrance, Greenberg",
    year=1997,
    title="Non-Linear Approximation of Reflectance Functions. SIGGRAPH '97",
    doi="10.1145/258734.258801",
    equation="the generalised cosine lobe with a diagonal matrix, section 4; (n + 2)/(2π), which the source "
    "lets the coefficients absorb, stands before it, so that coefficients are near 1",
)

_LEAST = 1e-150  # a length or a cosine below this is 0


@kernel
def _axis(ox: Any, oy: Any, oz: Any, cx: Any, cy: Any, cz: Any) -> Any:
    """Return the lobe's unit axis and the length of C wo; z and 0 where it vanishes."""
    x, y, z = cx * ox, cy * oy, cz * oz
    length = np.sqrt(x * x + y * y + z * z)
    some = length > _LEAST
    safe = select(some, length, 1.0)
    return select(some, x / safe, 0.0), select(some, y / safe, 0.0), select(some, z / safe, 1.0), length


@kernel
def _power(x: Any, exponent: Any) -> Any:
    """Return xⁿ, or 0 where x is not above 0."""
    some = x > _LEAST
    return select(some, exp(exponent * log(select(some, x, 1.0))), 0.0)


@kernel
def _value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, cx: Any, cy: Any, cz: Any, exponent: Any, rho: Any
) -> Any:
    along = cx * ix * ox + cy * iy * oy + cz * iz * oz
    lit = (iz > 0.0) & (oz > 0.0)
    return rho * ((exponent + 2.0) / (2.0 * np.pi) * _power(select(lit, along, 0.0), exponent))


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, cx: Any, cy: Any, cz: Any, exponent: Any, rho: Any
) -> Any:
    """Return the density about the lobe's axis."""
    x, y, z, _ = _axis(ox, oy, oz, cx, cy, cz)
    lit = (iz > 0.0) & (oz > 0.0)
    return (exponent + 1.0) / (2.0 * np.pi) * _power(select(lit, x * ix + y * iy + z * iz, 0.0), exponent)


@kernel
def _sample(
    u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, cx: Any, cy: Any, cz: Any, exponent: Any, rho: Any
) -> Any:
    """Return wi about the lobe's axis, and ρ |C wo|ⁿ (n + 2)/(n + 1) cosθi."""
    x, y, z, length = _axis(ox, oy, oz, cx, cy, cz)
    wx, wy, wz = lobe_sample(u0, u1, x, y, z, exponent)
    share = rho * ((exponent + 2.0) / (exponent + 1.0) * _power(length, exponent))
    return wx, wy, wz, select((wz > 0.0) & (oz > 0.0), share * wz, 0.0)


@dataclass(frozen=True, kw_only=True)
class Lafortune(ScalarBSDF):
    """One generalised cosine lobe, f = ρ (n + 2)/(2π) max(0, Cx xi xo + Cy yi yo + Cz zi zo)ⁿ.

    Parameters
    ----------
    cx, cy, cz : float
        The coefficients Cx, Cy and Cz [1], in [-2, 2].
    exponent : float
        n [1], in [1, 1e3].
    reflectance : float or sequence of float
        ρ [1], in [0, 1]: the albedo at normal incidence for Cz = 1.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> f = Lafortune(cx=1.0, cy=1.0, exponent=10.0)  # light goes back
    >>> float(f([0.6, 0, 0.8], [0.6, 0, 0.8])) / (12 / (2 * np.pi))
    1.0
    """

    name = "lafortune"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"cx": 1.0, "cy": 1.0, "exponent": 20.0},
        {"cx": -1.2, "cy": -1.2, "cz": 0.9},
        {"cx": -0.9, "cy": -0.6, "cz": 0.95, "exponent": 20.0},
        {"exponent": 500.0, "reflectance": 0.5},
    )

    cx: float = parameter("[-2, 2]", "1", "coefficient of x", default=-1.0)
    cy: float = parameter("[-2, 2]", "1", "coefficient of y", default=-1.0)
    cz: float = parameter("[-2, 2]", "1", "coefficient of z", default=1.0)
    exponent: float = parameter("[1, 1e3]", "1", "exponent of the lobe", default=10.0)
    reflectance: Spectrum = parameter("[0, 1]", "1", "albedo at normal incidence", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, n = sympy.symbols("rho n", positive=True)
        coefficients = sympy.symbols("C_x C_y C_z", real=True)
        wi, wo = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:]
        inner = sum(c * a * b for c, a, b in zip(coefficients, wi, wo, strict=True))
        lobe = sympy.Piecewise((inner**n, inner > 0), (0, True))
        values = dict(zip(coefficients, (self.cx, self.cy, self.cz), strict=True))
        return Twin(
            rho * (n + 2) / (2 * sympy.pi) * lobe, {rho: self.reflectance, n: self.exponent, **values}
        )

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(
            _value, _density, _sample, (self.cx, self.cy, self.cz, self.exponent, self.reflectance)
        )

    @property
    def isotropic(self) -> bool:
        """Whether Cx = Cy."""
        return self.cx == self.cy

    @property
    def smooth(self) -> bool:
        """Whether it is Phong's lobe, with an exponent for which that ends softly."""
        return self._mirrors and self.exponent >= 4.0

    def lobe_width(self) -> float | None:
        """Return the median slope of the half vectors for Phong's lobe; unknown for another."""
        return median_slope(self.exponent) if self._mirrors else None

    @property
    def _mirrors(self) -> bool:
        return self.cx == self.cy == -self.cz < 0

    def largest_albedo(self) -> float:
        """Return the largest albedo [1] up to 89.99°, to about 1e-5.

        As a function of C wo it is convex, and even in the horizontal part: it is largest along the axis of
        the larger of |Cx| and |Cy|. About a lobe's axis at γ from the normal, cosθi is A + B cosβ with
        A = cosα cosγ and B = sinα sinγ, and is positive for |β| below acos(−A/B).

        >>> round(Lafortune(exponent=10.0, reflectance=0.5).largest_albedo(), 4)
        0.5
        """
        theta = np.radians(np.linspace(0.0, 89.99, 400))
        along, up = max(abs(self.cx), abs(self.cy)) * np.sin(theta), self.cz * np.cos(theta)
        length, gamma = np.hypot(along, up), np.arctan2(along, up)
        root, weight = gauss_legendre(256)
        log_cosine = (
            3.0 * np.log(root) / (self.exponent + 1.0)
        )  # cosⁿ⁺¹α is uniform; its cube root is smoother
        cosine, sine = np.exp(log_cosine), np.sqrt(-np.expm1(2.0 * log_cosine))
        a, b = np.multiply.outer(np.cos(gamma), cosine), np.multiply.outer(np.sin(gamma), sine)
        edge = np.arctan2(np.sqrt(np.maximum(b * b - a * a, 0.0)), -a)
        inner = 2.0 * (a * edge + b * np.sin(edge)) @ (3.0 * root * root * weight)
        shares = length**self.exponent * (self.exponent + 2.0) / (self.exponent + 1.0) / (2.0 * np.pi) * inner
        return float(np.max(shares) * np.max(self.reflectance))

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving where the albedo stays within 1."""
        within = max(abs(self.cx), abs(self.cy), abs(self.cz)) <= 1.0
        return Claims(reciprocity="yes", conserves=within or self.largest_albedo() <= 1.0 + 1e-8)
