"""GGX: a rough metal, made of tiny mirrors whose slopes follow the distribution with the long tails.

The everyday microfacet model: visible-normal sampling, shadowing and masking correlated by height. Single
scattering only, so a rough surface loses energy (white-sky albedo 4/3 (1 − ln 2) = 0.409 at α = 1). Without
an index its facets reflect everything.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims, FloatArray
from radiokit.contracts.parameters import parameter
from radiokit.facts.directions import dot
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.elementary import sincos
from radiokit.measure.kernels import Kernel, kernel, select
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
def _facet(u0: Any, u1: Any, alpha: Any, x: Any, y: Any, z: Any, length: Any, cos_o: Any) -> Any:
    """Return cosθi, and the squared cosine at the facet: the steps of ``GGX.sample`` for one number each."""
    up, down = (1.0 - u0) * (1.0 + z), u0 * (1.0 + z)
    radius = np.sqrt(down * (up + (x * x + y * y) / (1.0 + z)))
    sine, cosine = sincos(u1)
    a, b = radius * cosine + x, radius * sine + y
    along = length * (x * a + y * b + z * up)
    inverse = 1.0 / (alpha * alpha * (a * a + b * b) + up * up)
    return 2.0 * along * up * inverse - cos_o, along * along * inverse


@kernel
def _shadowing(cos_i: Any, alpha: Any, cos_o: Any, root_o: Any) -> Any:
    """Return G₂ / G₁, the cosines multiplied out."""
    root_i = np.sqrt(alpha * alpha + (1.0 - alpha * alpha) * (cos_i * cos_i))
    above = (cos_i > _HORIZON) & (cos_o > _HORIZON)
    share = cos_i * (cos_o + root_o) / select(above, cos_i * root_o + cos_o * root_i, 1.0)
    return select(above, share, 0.0)


@kernel
def _share(u0: Any, u1: Any, alpha: Any, x: Any, y: Any, z: Any, length: Any, cos_o: Any, root_o: Any) -> Any:
    """Return the weight of facets that reflect everything."""
    cos_i, _ = _facet(u0, u1, alpha, x, y, z, length, cos_o)
    return _shadowing(cos_i, alpha, cos_o, root_o)


@kernel
def _metal_share(
    u0: Any,
    u1: Any,
    eta: Any,
    k: Any,
    alpha: Any,
    x: Any,
    y: Any,
    z: Any,
    length: Any,
    cos_o: Any,
    root_o: Any,
) -> Any:
    """Return the weight of facets with an index."""
    cos_i, square = _facet(u0, u1, alpha, x, y, z, length, cos_o)
    cos_d = np.sqrt(select(square < 1.0, square, 1.0))
    return conductor_kernel(cos_d, eta, k) * _shadowing(cos_i, alpha, cos_o, root_o)


@dataclass(frozen=True, kw_only=True)
class GGX(BSDF):
    """The GGX conductor, f = F D G₂ / (4 cosθi cosθo), with Smith's height-correlated G₂.

    Parameters
    ----------
    alpha : float
        Width α of the slope distribution [1], not squared, in [1e-4, 1].
    eta : float, optional
        Real part of the relative index η + ik [1], above 0; with ``k``.
    k : float, optional
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
    SOURCE = SOURCE
    EXAMPLES = ({}, {"alpha": 1.0}, {"alpha": 0.01}, {"alpha": 0.001}, {"alpha": 0.2, "eta": 0.2, "k": 3.9})

    alpha: float = parameter("[1e-4, 1]", "1", "width of the slope distribution", default=0.3)
    eta: float | None = parameter("(0, inf)", "1", "real part of the relative index", default=None)
    k: float | None = parameter("[0, inf)", "1", "extinction", default=None)

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

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹]; 0 unless both directions are above the horizon."""
        above = np.minimum(wi[..., 2], wo[..., 2]) > _HORIZON
        density, length2 = self._density(wi, wo, above)
        root_i, root_o = self._root(wi), self._root(wo)
        # G₂ / (4 cosθi cosθo), after Smith's roots and cosines are multiplied out.
        inverse = 2.0 * (wi[..., 2] * root_o + wo[..., 2] * root_i)
        value = self._reflectance(length2) * density / np.where(above, inverse, 1.0)
        return np.where(above, value, 0.0)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``, G₁ D / (4 cosθo); 0 below the horizon."""
        above = np.minimum(wi[..., 2], wo[..., 2]) > _HORIZON
        density, _ = self._density(wi, wo, above)
        return np.where(above, 0.5 * density / np.where(above, wo[..., 2] + self._root(wo), 1.0), 0.0)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` about visible normals, and ``weight = F G₂ / G₁``.

        Source: Dupuy & Benyoub (2023), Sampling Visible GGX Normals with Spherical Caps, Computer Graphics
        Forum 42(8), doi:10.1111/cgf.14867; the cap's radius and height are written without cancellation.
        """
        x, y, z = self.alpha * wo[..., 0], self.alpha * wo[..., 1], np.abs(wo[..., 2])
        length = np.sqrt(x * x + y * y + z * z)
        x, y, z = x / length, y / length, z / length
        up, down = (1.0 - u[..., 0]) * (1.0 + z), u[..., 0] * (1.0 + z)  # above −z, and below 1
        radius = np.sqrt(down * (up + (x * x + y * y) / (1.0 + z)))
        phi = 2.0 * np.pi * u[..., 1]
        normal = np.stack(
            (self.alpha * (radius * np.cos(phi) + x), self.alpha * (radius * np.sin(phi) + y), up), axis=-1
        )
        wi = (2.0 * dot(wo, normal) / dot(normal, normal))[..., None] * normal - wo
        return wi, self._weight(wi, wo)

    def weight_kernel(self, wo: FloatArray) -> tuple[Kernel, tuple[float, ...]]:
        """Return F G₂ / G₁ of ``sample`` as a kernel."""
        x, y, z = self.alpha * float(wo[0]), self.alpha * float(wo[1]), float(wo[2])
        length = float(np.sqrt(x * x + y * y + z * z))
        view = (self.alpha, x / length, y / length, z / length, length, z, float(self._root(wo)))
        if self.eta is None or self.k is None:
            return _share, view
        return _metal_share, (*fresnel.clip_index(self.eta, self.k), *view)

    def _weight(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return F G₂ / G₁, the cosines multiplied out."""
        cos_i, cos_o = wi[..., 2], wo[..., 2]
        above = np.minimum(cos_i, cos_o) > _HORIZON
        root_i, root_o = self._root(wi), self._root(wo)
        half = wi + wo
        share = cos_i * (cos_o + root_o) / np.where(above, cos_i * root_o + cos_o * root_i, 1.0)
        return np.where(above, self._reflectance(dot(half, half)) * share, 0.0)

    def _density(self, wi: FloatArray, wo: FloatArray, above: Any) -> tuple[FloatArray, FloatArray]:
        """Return D(h) [sr⁻¹] and |wi + wo|², without normalising h: its length would cost digits."""
        half = wi + wo
        across = half[..., 0] ** 2 + half[..., 1] ** 2
        up = half[..., 2] ** 2
        ratio = (across + up) / np.where(above, across / self.alpha + self.alpha * up, 1.0)
        return ratio * ratio / np.pi, across + up

    def _root(self, w: FloatArray) -> FloatArray:
        """Return √(α² sin²θ + cos²θ) = (1 + 2Λ) |cosθ|."""
        sine2 = w[..., 0] ** 2 + w[..., 1] ** 2
        root: FloatArray = np.sqrt(self.alpha**2 * sine2 + w[..., 2] ** 2)
        return root

    def _reflectance(self, length2: FloatArray) -> Any:
        """Return F at the angle between a direction and h, whose cosine is |wi + wo| / 2."""
        if self.eta is None or self.k is None:
            return 1.0
        return fresnel.conductor(np.minimum(0.5 * np.sqrt(length2), 1.0), self.eta, self.k)

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return α."""
        return self.alpha

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: light that bounces twice is gone."""
        return Claims(reciprocity="yes", conserves=True)
