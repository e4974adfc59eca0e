"""Ashikhmin-Shirley: an anisotropic Phong lobe with Fresnel's rise, over a base that takes what it leaves.

For brushed and polished plastics and metals: two exponents, the colour at normal incidence, and the
colour of the base. It obeys both laws for every pair of exponents: no facet is seen by wo and a wi above
the horizon at a cosine below cosθo/2, so F ≤ Rs + (1 − Rs)(1 − cosθo/2)⁵, and what the base adds brings
the albedo to 1 at most. The base alone has Rd (1 − Rs)(1 − (1 − cosθo/2)⁵), at normal incidence 31/32 of
Rd (1 − Rs); the lobe alone, with Rs = 1, 0.25 there for n = 1, 0.961 for n = 100 and 0.9996 for n = 1e4,
the largest that was found.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.elementary import exp, log1p, sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics.facet import reflect
from radiokit.physics.fresnel import schlick_symbolic
from radiokit.physics.half import HORIZON, half_length, power_slope, schlick_at_half

__all__ = ["AshikhminShirley"]

SOURCE = Source(
    authors="Ashikhmin, Shirley",
    year=2000,
    title="An Anisotropic Phong BRDF Model. Journal of Graphics Tools 5(2)",
    doi="10.1080/10867651.2000.10487522",
    equation="the specular and the diffuse term, and the sampling of the half vector, in which one turn of "
    "the azimuth stands for the four quadrants",
)


@kernel
def _lobe(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, n_u: Any, n_v: Any) -> Any:
    """Return the density of wi about half vectors, √((nu + 1)(nv + 1))/(2π) cosᵉδ / (4 wo·ĥ)."""
    above = (iz > HORIZON) & (oz > HORIZON)
    x, y, z = ix + ox, iy + oy, select(above, iz + oz, 1.0)
    across = x * x + y * y
    exponent = (n_u * x * x + n_v * y * y) / select(across > 0.0, across, 1.0)
    lobe = exp(-0.5 * exponent * log1p(across / (z * z)))
    length = select(above, half_length(ix, iy, iz, ox, oy, oz), 1.0)
    return select(above, np.sqrt((n_u + 1.0) * (n_v + 1.0)) / (4.0 * np.pi) * lobe / length, 0.0)


@kernel
def _rest(z: Any) -> Any:
    """Return 1 − (1 − z/2)⁵, by the sum of the powers."""
    q = 1.0 - 0.5 * z
    return 0.5 * z * (1.0 + q * (1.0 + q * (1.0 + q * (1.0 + q))))


@kernel
def _sum(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, lobe: Any, f0: Any, reflectance: Any) -> Any:
    """Return the specular and the diffuse term together, of a pair above the horizon."""
    larger = select(iz > oz, iz, oz)
    base = 28.0 / (23.0 * np.pi) * reflectance * (1.0 - f0) * _rest(iz) * _rest(oz)
    return lobe * schlick_at_half(ix, iy, iz, ox, oy, oz, f0) / larger + base


@kernel
def _value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, n_u: Any, n_v: Any, f0: Any, reflectance: Any
) -> Any:
    above = (iz > HORIZON) & (oz > HORIZON)
    lobe = _lobe(ix, iy, iz, ox, oy, oz, n_u, n_v)
    up_i, up_o = select(above, iz, 1.0), select(above, oz, 1.0)
    return select(above, _sum(ix, iy, up_i, ox, oy, up_o, lobe, f0, reflectance), 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, n_u: Any, n_v: Any, f0: Any, reflectance: Any
) -> Any:
    above = (iz > HORIZON) & (oz > HORIZON)
    return select(above, 0.5 * (_lobe(ix, iy, iz, ox, oy, oz, n_u, n_v) + iz / np.pi), 0.0)


@kernel
def _sample(
    u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, n_u: Any, n_v: Any, f0: Any, reflectance: Any
) -> Any:
    """Return wi, half of the time about a half vector and else by the cosine, and f cosθi / pdf."""
    sine, cosine = sincos(u1)
    x, y = np.sqrt(n_v + 1.0) * cosine, np.sqrt(n_u + 1.0) * sine
    across = x * x + y * y
    slope = power_slope(u0, (n_u * x * x + n_v * y * y) / across) / np.sqrt(across)
    sx, sy, sz = reflect(ox, oy, oz, slope * x, slope * y, 1.0)
    radius, about_half = np.sqrt(u0), u2 < 0.5
    wx, wy = select(about_half, sx, radius * cosine), select(about_half, sy, radius * sine)
    wz = select(about_half, sz, np.sqrt(1.0 - u0))
    above = (wz > HORIZON) & (oz > HORIZON)
    lobe = _lobe(wx, wy, wz, ox, oy, oz, n_u, n_v)
    up_i, up_o = select(above, wz, 1.0), select(above, oz, 1.0)
    density = 0.5 * (lobe + up_i / np.pi)
    weight = _sum(wx, wy, up_i, ox, oy, up_o, lobe, f0, reflectance) * up_i / density
    return wx, wy, wz, select(above, weight, 0.0)


@dataclass(frozen=True, kw_only=True)
class AshikhminShirley(ScalarBSDF):
    """The Ashikhmin-Shirley model: a specular term with nu and nv, and a diffuse one that is coupled to it.

    Parameters
    ----------
    exponent_u, exponent_v : float
        nu and nv [1], in [1, 1e5]: how narrow the lobe is along x and along y.
    f0 : float or sequence of float
        Rs [1], in [0, 1]: the specular reflectance at normal incidence, of Schlick's formula.
    reflectance : float or sequence of float
        Rd [1], in [0, 1]: that of the base.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> f = AshikhminShirley(exponent_u=10.0, exponent_v=1000.0, f0=0.5, reflectance=0.2)
    >>> f.isotropic, round(float(f([0, 0, 1], [0, 0, 1])), 6)
    (False, 2.123949)
    """

    name = "ashikhmin_shirley"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"exponent_u": 10.0, "exponent_v": 100.0, "f0": 0.5},
        {"exponent_u": 1e4, "exponent_v": 1e4, "f0": 1.0},
        {"exponent_u": 1.0, "exponent_v": 1.0, "f0": 0.0, "reflectance": 1.0},
    )
    dimensions = 3

    exponent_u: float = parameter("[1, 1e5]", "1", "exponent of the lobe along x", default=100.0)
    exponent_v: float = parameter("[1, 1e5]", "1", "exponent of the lobe along y", default=100.0)
    f0: Spectrum = parameter("[0, 1]", "1", "specular reflectance", spectral=True, default=0.04)
    reflectance: Spectrum = parameter("[0, 1]", "1", "diffuse reflectance", spectral=True, default=0.5)

    def symbolic(self) -> Twin:
        """Return the symbolic twin; at the normal, where the exponent has no limit, its power is 1."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        n_u, n_v, r_s, r_d = sympy.symbols("n_u n_v R_s R_d", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        half = wi + wo
        length = sympy.sqrt(half.dot(half))
        x, y, cos_h = half / length
        across = x**2 + y**2
        exponent = (n_u * x**2 + n_v * y**2) / sympy.Piecewise((across, across > 0), (1, True))
        cos_k = wi.dot(half) / length
        peak = sympy.sqrt((n_u + 1) * (n_v + 1)) / (8 * sympy.pi)
        specular = peak * cos_h**exponent / (cos_k * sympy.Max(wi[2], wo[2])) * schlick_symbolic(cos_k, r_s)
        rest = [1 - (1 - w[2] / 2) ** 5 for w in (wi, wo)]
        diffuse = sympy.Rational(28, 23) * r_d / sympy.pi * (1 - r_s) * rest[0] * rest[1]
        values = {n_u: self.exponent_u, n_v: self.exponent_v, r_s: self.f0, r_d: self.reflectance}
        return Twin(specular + diffuse, values)

    def kernels(self) -> Kernels:
        """Return the kernels."""
        constants = (self.exponent_u, self.exponent_v, self.f0, self.reflectance)
        return Kernels(_value, _density, _sample, constants)

    @property
    def isotropic(self) -> bool:
        """Whether the two exponents are equal."""
        return self.exponent_u == self.exponent_v

    @property
    def smooth(self) -> bool:
        """False: the larger cosine has a kink where they are equal."""
        return False

    def lobe_width(self) -> float:
        """Return the median slope of half vectors with the geometric mean of the exponents."""
        return float(power_slope(0.5, np.sqrt(self.exponent_u * self.exponent_v)))

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless."""
        return Claims(reciprocity="yes", conserves=True)
