"""GGX: a rough metal, made of tiny mirrors whose slopes follow the distribution with the long tails.

The everyday microfacet model: visible-normal sampling, shadowing and masking correlated by height. Single
scattering only, so a rough surface loses energy (white-sky albedo 4/3 (1 − ln 2) = 0.409 at α = 1). Without
an index its facets reflect everything.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.elementary import sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics import fresnel
from radiokit.physics.fresnel import conductor_kernel

__all__ = ["GGX"]

SOURCE = Source(
    authors="Walter, Marschner, Li, Torrance",
    year=2007,
    title="Microfacet Models for Refraction through Rough Surfaces. Eurographics Symposium on Rendering",
    doi="10.2312/EGWR/EGSR07/195-206",
    equation="20 (the BRDF) and 33 (D); Λ and G₂ from Heitz (2014), Understanding the Masking-Shadowing "
    "Function, Journal of Computer Graphics Techniques 3(2), equations 72 and 99",
)

_HORIZON = 1e-150  # a cosine below this is 0: no unit vector tells them apart, and squares would underflow


@kernel
def _root(z: Any, alpha: Any) -> Any:
    """Return √(α² sin²θ + cos²θ) = (1 + 2Λ) |cosθ|."""
    return np.sqrt(alpha * alpha * ((1.0 - z) * (1.0 + z)) + z * z)


@kernel
def _distribution(hx: Any, hy: Any, hz: Any, alpha: Any) -> Any:
    """Return D(h) [sr⁻¹] of a half vector of any length: normalising it would cost digits."""
    across, up = hx * hx + hy * hy, hz * hz
    ratio = (across + up) / (across / alpha + alpha * up)
    return ratio * ratio / np.pi


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any) -> Any:
    """Return D G₂ / (4 cosθi cosθo), after Smith's roots and the cosines are multiplied out."""
    above = (iz > _HORIZON) & (oz > _HORIZON)
    density = _distribution(ix + ox, iy + oy, select(above, iz + oz, 1.0), alpha)
    below = 2.0 * (iz * _root(oz, alpha) + oz * _root(iz, alpha))
    return select(above, density / select(above, below, 1.0), 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any) -> Any:
    """Return G₁ D / (4 cosθo)."""
    above = (iz > _HORIZON) & (oz > _HORIZON)
    density = _distribution(ix + ox, iy + oy, select(above, iz + oz, 1.0), alpha)
    return select(above, 0.5 * density / select(above, oz + _root(oz, alpha), 1.0), 0.0)


@kernel
def _facet(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha: Any) -> Any:
    """Return a visible normal, not of unit length.

    Source: Dupuy & Benyoub (2023), Sampling Visible GGX Normals with Spherical Caps, Computer Graphics
    Forum 42(8), doi:10.1111/cgf.14867; the cap's radius and height are written without cancellation.
    """
    x, y, z = alpha * ox, alpha * oy, abs(oz)
    length = np.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    up, down = (1.0 - u0) * (1.0 + z), u0 * (1.0 + z)  # above −z, and below 1
    radius = np.sqrt(down * (up + (x * x + y * y) / (1.0 + z)))
    sine, cosine = sincos(u1)
    return alpha * (radius * cosine + x), alpha * (radius * sine + y), up


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha: Any) -> Any:
    """Return wi about a visible normal, and G₂ / G₁, the cosines multiplied out."""
    nx, ny, nz = _facet(u0, u1, ox, oy, oz, alpha)
    twice = 2.0 * (ox * nx + oy * ny + oz * nz) / (nx * nx + ny * ny + nz * nz)
    wz = twice * nz - oz
    above = (wz > _HORIZON) & (oz > _HORIZON)
    root_o = _root(oz, alpha)
    share = wz * (oz + root_o) / select(above, wz * root_o + oz * _root(wz, alpha), 1.0)
    return twice * nx - ox, twice * ny - oy, wz, select(above, share, 0.0)


@kernel
def _mirrors(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any, k: Any) -> Any:
    """Return F at the angle between a direction and h, whose cosine is |wi + wo| / 2."""
    x, y, z = ix + ox, iy + oy, iz + oz
    cosine = 0.5 * np.sqrt(x * x + y * y + z * z)
    return conductor_kernel(select(cosine < 1.0, cosine, 1.0), eta, k)


@kernel
def _metal_value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any, k: Any) -> Any:
    return _mirrors(ix, iy, iz, ox, oy, oz, eta, k) * _value(ix, iy, iz, ox, oy, oz, alpha)


@kernel
def _metal_density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any, k: Any) -> Any:
    return _density(ix, iy, iz, ox, oy, oz, alpha)


@kernel
def _metal_sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any, k: Any) -> Any:
    wx, wy, wz, share = _sample(u0, u1, ox, oy, oz, alpha)
    return wx, wy, wz, _mirrors(wx, wy, wz, ox, oy, oz, eta, k) * share


@dataclass(frozen=True, kw_only=True)
class GGX(ScalarBSDF):
    """The GGX conductor, f = F D G₂ / (4 cosθi cosθo), with Smith's height-correlated G₂.

    Parameters
    ----------
    alpha : float
        Width α of the slope distribution [1], not squared, in [1e-4, 1].
    eta : float or sequence of float, optional
        Real part of the relative index η + ik [1], above 0; with ``k``.
    k : float or sequence of float, optional
        Extinction [1], at least 0; with ``eta``. Without both, the facets reflect everything (F = 1).

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or one of ``eta`` and ``k`` is given alone.

    >>> f = GGX(alpha=0.5)
    >>> round(float(f([0, 0, 1], [0, 0, 1])), 12) == round(1 / (4 * 3.141592653589793 * 0.25), 12)
    True
    """

    name = "ggx"
    kind = "microfacet"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"alpha": 1.0}, {"alpha": 0.01}, {"alpha": 0.001}, {"alpha": 0.2, "eta": 0.2, "k": 3.9})

    alpha: float = parameter("[1e-4, 1]", "1", "width of the slope distribution", default=0.3)
    eta: Spectrum | None = parameter(
        "(0, inf)", "1", "real part of the relative index", spectral=True, default=None
    )
    k: Spectrum | None = parameter("[0, inf)", "1", "extinction", spectral=True, default=None)

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.eta is None) != (self.k is None):
            alone, other = ("eta", "k") if self.k is None else ("k", "eta")
            raise ParameterError(other, None, f"given, as {alone} is: an index has both parts")

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the angles and tangents of the sources."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        alpha, eta, k = sympy.symbols("alpha eta k", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        half = wi + wo
        length = sympy.sqrt(half.dot(half))

        def tan2(w: Any) -> Any:
            return (w[0] ** 2 + w[1] ** 2) / w[2] ** 2

        def smith(w: Any) -> Any:  # Λ
            return (sympy.sqrt(1 + alpha**2 * tan2(w)) - 1) / 2

        cos_m = half[2] / length
        density = alpha**2 / (sympy.pi * cos_m**4 * (alpha**2 + tan2(half)) ** 2)
        shadowing = 1 / (1 + smith(wi) + smith(wo))
        values: dict[Any, float] = {alpha: self.alpha}
        reflectance = sympy.S.One
        if self.eta is not None and self.k is not None:
            reflectance = fresnel.conductor_symbolic(wi.dot(half) / length, eta, k)
            values |= {eta: self.eta, k: self.k}
        return Twin(reflectance * density * shadowing / (4 * wi[2] * wo[2]), values)

    def kernels(self) -> Kernels:
        """Return the kernels, without a Fresnel factor where there is no index."""
        if self.eta is None or self.k is None:
            return Kernels(_value, _density, _sample, (self.alpha,))
        index = fresnel.clip_index(self.eta, self.k)
        return Kernels(_metal_value, _metal_density, _metal_sample, (self.alpha, *index))

    @property
    def smooth(self) -> bool:
        """Whether F is: it has a kink at the critical angle where the facets reflect totally."""
        if self.eta is None or self.k is None:
            return True
        return bool(np.all((np.asarray(self.eta) >= 1.0) | (np.asarray(self.k) >= 0.1)))

    def lobe_width(self) -> float:
        """Return α."""
        return self.alpha

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: light that bounces twice is gone."""
        return Claims(reciprocity="yes", conserves=True)
