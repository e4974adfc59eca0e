"""Schlick: rational functions of 1994 in place of a microfacet model's costly ones; three numbers to tune.

Fresnel, a lobe like GGX with α = √r, an azimuth factor for brushed surfaces, and Smith's shadowing in a
form whose k is r itself. For a smooth surface that shadows far too little, and the albedo gains at
grazing angles: at 89.99° it is 1.38 for r = 0.1, 4.7 for r = 0.01 and 18 for r = 1e-4 (f0 = 1, p = 1); it
stays within 1 from r = 0.169. With p that limit moves between 0.12 (p = 0.01) and 0.2 (p = 0.3).

This is the self-shadowed single layer. The term that gives the shadowed light back, (1 − GG')/(4π cosθi
cosθo), is left out: with it the albedo grows as 1/(2 cosθ), without bound. So is the mixture with a
diffuse part and a mirror, by which the source replaces this lobe as r goes to 1 and to 0.
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
from radiokit.measure.elementary import sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics.facet import reflect
from radiokit.physics.fresnel import schlick_symbolic
from radiokit.physics.half import HORIZON, schlick_at_half

__all__ = ["Schlick"]

SOURCE = Source(
    authors="Schlick",
    year=1994,
    title="An Inexpensive BRDF Model for Physically-based Rendering. Computer Graphics Forum 13(3)",
    doi="10.1111/1467-8659.1330233",
    equation="24 (S), 28 (Z and A), and 31 (G) in the first term of 30",
)


@kernel
def _parts(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, isotropy: Any) -> Any:
    """Return Z, p/A², hz and |h|² of h = wi + wo; A is 1 where h is the normal, and it has no limit."""
    above = (iz > HORIZON) & (oz > HORIZON)
    x, y, z = ix + ox, iy + oy, select(above, iz + oz, 1.0)
    across, up = x * x + y * y, z * z
    ratio = (across + up) / (across + roughness * up)
    some = across > 0.0
    stretch = (x * x + isotropy * isotropy * y * y) / select(some, across, 1.0)
    return roughness * ratio * ratio, select(some, stretch, isotropy), z, across + up


@kernel
def _shadow(z: Any, roughness: Any) -> Any:
    """Return cosθ/G = r + (1 − r) cosθ."""
    return roughness + (1.0 - roughness) * z


@kernel
def _value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, isotropy: Any, f0: Any
) -> Any:
    above = (iz > HORIZON) & (oz > HORIZON)
    zenith, stretch, _, _ = _parts(ix, iy, iz, ox, oy, oz, roughness, isotropy)
    below = 4.0 * np.pi * _shadow(iz, roughness) * _shadow(oz, roughness)
    lobe = zenith * np.sqrt(isotropy / stretch) / select(above, below, 1.0)
    return select(above, schlick_at_half(ix, iy, iz, ox, oy, oz, f0) * lobe, 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, roughness: Any, isotropy: Any, f0: Any
) -> Any:
    """Return Z cosδ p/(π (cos²φ + p² sin²φ)) / (4 wo·ĥ): it follows A², since A itself has no closed form."""
    above = (iz > HORIZON) & (oz > HORIZON)
    zenith, stretch, z, square = _parts(ix, iy, iz, ox, oy, oz, roughness, isotropy)
    return select(above, zenith * isotropy * z / (2.0 * np.pi * stretch * square), 0.0)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, roughness: Any, isotropy: Any, f0: Any) -> Any:
    """Return wi about a half vector with tan²δ = r u/(1 − u), and the weight, in which Z cancels."""
    sine, cosine = sincos(u1)
    x, y = isotropy * cosine, sine
    slope = np.sqrt(roughness * u0 / ((1.0 - u0) * (x * x + y * y)))
    wx, wy, wz = reflect(ox, oy, oz, slope * x, slope * y, 1.0)
    above = (wz > HORIZON) & (oz > HORIZON)
    _, stretch, z, square = _parts(wx, wy, wz, ox, oy, oz, roughness, isotropy)
    below = 2.0 * z * _shadow(wz, roughness) * _shadow(oz, roughness)
    share = np.sqrt(stretch / isotropy) * square * wz / select(above, below, 1.0)
    return wx, wy, wz, select(above, schlick_at_half(wx, wy, wz, ox, oy, oz, f0) * share, 0.0)


@dataclass(frozen=True, kw_only=True)
class Schlick(ScalarBSDF):
    """Schlick's single layer, f = S(u) G(v) G(v') Z(t) A(w) / (4π v v').

    Parameters
    ----------
    roughness : float
        r [1], in [1e-4, 1]; √r is GGX's α.
    isotropy : float
        p [1], in [0.01, 1]; 1 is isotropic. A smaller one stretches the lobe along y and narrows it along x.
    f0 : float or sequence of float
        C [1], in [0, 1]: the reflectance at normal incidence, of Schlick's formula.

    Raises
    ------
    ParameterError
        When a parameter is out of its range.

    >>> f = Schlick(roughness=1.0, f0=1.0)
    >>> float(f([0, 0, 1], [0.6, 0, 0.8])) == 1 / (4 * np.pi)
    True
    """

    name = "schlick"
    kind = "glossy"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"roughness": 0.1, "f0": 1.0},
        {"roughness": 0.3, "isotropy": 0.3, "f0": 0.9},
        {"roughness": 0.001, "f0": 0.04},
        {"roughness": 1.0, "f0": 0.0},
    )

    roughness: float = parameter("[1e-4, 1]", "1", "roughness", default=0.3)
    isotropy: float = parameter("[0.01, 1]", "1", "1 where the lobe is isotropic", default=1.0)
    f0: Spectrum = parameter("[0, 1]", "1", "reflectance at normal incidence", spectral=True, default=0.5)

    def symbolic(self) -> Twin:
        """Return the symbolic twin; where h is the normal, and w has no value, A is 1."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        r, p, f0 = sympy.symbols("r p f_0", positive=True)
        wi, wo = sympy.Matrix(DIRECTION_SYMBOLS[:3]), sympy.Matrix(DIRECTION_SYMBOLS[3:])
        half = wi + wo
        length = sympy.sqrt(half.dot(half))
        x, y, t = half / length
        across = x**2 + y**2
        w2 = x**2 / sympy.Piecewise((across, across > 0), (1, True))
        zenith = r / (1 + r * t**2 - t**2) ** 2
        azimuth = sympy.Piecewise((sympy.sqrt(p / (p**2 - p**2 * w2 + w2)), across > 0), (1, True))

        def shadowing(v: Any) -> Any:  # G
            return v / (r - r * v + v)

        both = shadowing(wi[2]) * shadowing(wo[2]) / (4 * sympy.pi * wi[2] * wo[2])
        value = schlick_symbolic(wi.dot(half) / length, f0) * both * zenith * azimuth
        return Twin(value, {r: self.roughness, p: self.isotropy, f0: self.f0})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.roughness, self.isotropy, self.f0))

    @property
    def isotropic(self) -> bool:
        """Whether p is 1."""
        return self.isotropy == 1.0

    @property
    def smooth(self) -> bool:
        """True, in the polar coordinates about the half vector that quadrature uses."""
        return True

    def lobe_width(self) -> float:
        """Return √r, the median slope of the half vectors."""
        return float(np.sqrt(self.roughness))

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving where the albedo stays within 1 up to 89.99°."""
        return Claims(reciprocity="yes", conserves=largest_albedo(self) <= 1.0 + 1e-9)
