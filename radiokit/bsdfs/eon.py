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
from radiokit.measure.vectors import even, from_disk

__all__ = ["EON"]

SOURCE = Source(
    authors="Portsmouth, Kutz, Hill",
    year=2025,
    title="EON: A Practical Energy-Preserving Rough Diffuse BRDF. Journal of Computer Graphics "
    "Techniques 14(1)",
    doi="10.48550/arXiv.2410.18026",
    equation="listing 1, with the exact directional albedo of the Fujii-Oren-Nayar model; sampled by its "
    "clipped linearly transformed cosine",
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
def _value(
    ix: Any,
    iy: Any,
    iz: Any,
    ox: Any,
    oy: Any,
    oz: Any,
    roughness: Any,
    share: Any,
    single: Any,
    several: Any,
) -> Any:
    above = (iz > _HORIZON) & (oz > _HORIZON)
    across = ix * ox + iy * oy  # s
    lean = select(across > 0.0, across, 0.0)
    higher = select(above, select(iz > oz, iz, oz), 1.0)
    x, y = ix + ox, iy + oy
    less = 0.5 * (x * x + y * y + iz * iz + oz * oz)  # 1 + s, which vanishes straight opposite at grazing
    once = select(lean > 0.0, 1.0 + roughness * (lean / higher), (1.0 - roughness) + roughness * less)
    lost = _lost(np.sqrt(ix * ix + iy * iy), iz) * _lost(np.sqrt(ox * ox + oy * oy), oz)
    return select(above, single * once + several * lost, 0.0)


@kernel
def _transform(mu: Any, r: Any) -> Any:
    """Return a, b, c, d of the matrix ((a, 0, b), (0, c, 0), (d, 0, 1)), and the even share over r^0.1.

    The lobe is a cosine, transformed by it, in the frame where wo has the azimuth 0: the source's fit.
    """
    a = 1.0 + r * (0.303392 + (-0.518982 + 0.111709 * mu) * mu + (-0.276266 + 0.335918 * mu) * r)
    b = r * (-1.16407 + 1.15859 * mu + (0.150815 - 0.150105 * mu) * r) / (mu * mu * mu - 1.43545)
    c = 1.0 + r * (0.20013 + (-0.506373 + 0.261777 * mu) * mu)
    d = r * (0.540852 + (-1.01625 + 0.475392 * mu) * mu) / (-1.0743 + (0.0725628 + mu) * mu)
    return a, b, c, d, 0.162925 + (-0.372058 + (0.538233 - 0.290822 * mu) * mu) * mu


@kernel
def _azimuth(ox: Any, oy: Any) -> Any:
    """Return cosine and sine of wo's azimuth; 1 and 0 at the pole."""
    length = np.sqrt(ox * ox + oy * oy)
    inverse = 1.0 / select(length > 0.0, length, 1.0)
    return select(length > 0.0, ox * inverse, 1.0), oy * inverse


@kernel
def _density(
    ix: Any,
    iy: Any,
    iz: Any,
    ox: Any,
    oy: Any,
    oz: Any,
    roughness: Any,
    share: Any,
    single: Any,
    several: Any,
) -> Any:
    """Return the density of the transformed cosine, cut at the horizon, and of an even lobe."""
    a, b, c, d, part = _transform(abs(oz), roughness)
    part = part * share
    tx, ty = _azimuth(ox, oy)
    along, across = ix * tx + iy * ty, iy * tx - ix * ty
    inner = a - b * d
    hx, hy, hz = c * (along - b * iz), inner * across, c * (a * iz - d * along)  # the adjugate's image
    square, size = hx * hx + hy * hy + hz * hz, c * inner
    kept = 0.5 * (1.0 + 1.0 / np.sqrt(1.0 + d * d))  # of the disk that the cosine projects to
    ratio = size / select(square > 0.0, square, 1.0)
    lobe = ratio * ratio * select(hz > 0.0, hz, 0.0) / (np.pi * kept)
    found = part / (2.0 * np.pi) + (1.0 - part) * lobe
    return select((iz > _HORIZON) & (oz > _HORIZON), found, 0.0)


@kernel
def _sample(
    u0: Any,
    u1: Any,
    u2: Any,
    ox: Any,
    oy: Any,
    oz: Any,
    roughness: Any,
    share: Any,
    single: Any,
    several: Any,
) -> Any:
    """Return wi from one of the two lobes, and f cosθi / pdf, at most about 1.5.

    Source: the same paper's listing of clipped linearly transformed cosine sampling.
    """
    a, b, c, d, part = _transform(abs(oz), roughness)
    x, y, z = from_disk(u0, u1)
    ex, ey, ez = even(x, y, z)
    kept, chord = 0.5 * (1.0 + 1.0 / np.sqrt(1.0 + d * d)), np.sqrt((1.0 - y) * (1.0 + y))
    hx = -(chord + kept * (x - chord))  # the part of the disk above the transformed horizon
    up = (chord - hx) * (chord + hx)
    hz = np.sqrt(select(up > 0.0, up, 0.0))
    along, across, height = a * hx + b * hz, c * y, d * hx + hz
    length = np.sqrt(along * along + across * across + height * height)
    length = select(length > 0.0, length, 1.0)
    tx, ty = _azimuth(ox, oy)
    spread = u2 < part * share
    wx = select(spread, ex, (along * tx - across * ty) / length)
    wy = select(spread, ey, (along * ty + across * tx) / length)
    wz = select(spread, ez, height / length)
    density = _density(wx, wy, wz, ox, oy, oz, roughness, share, single, several)
    value = _value(wx, wy, wz, ox, oy, oz, roughness, share, single, several)
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
    kind = "diffuse"
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
        """Return the kernels, whose constants are r, r^0.1 and the two parts' factors."""
        rho, r = np.asarray(self.reflectance, dtype=float), self.roughness
        a = 1.0 / (1.0 + _C1 * r)
        missing = a * r * (_C1 - _C2)  # 1 − Ē
        tint = rho * rho * (1.0 - missing) / (1.0 - rho * missing)
        several = tint * (a * r / ((_C1 - _C2) * np.pi**3))
        return Kernels(_value, _density, _sample, (r, r**0.1, rho * (a / np.pi), several))

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, with the albedo ρ E + ρ' (1 − E); lossless when ρ = 1."""
        return Claims(
            reciprocity="yes", conserves=True, lossless=bool(np.all(np.equal(self.reflectance, 1.0)))
        )
