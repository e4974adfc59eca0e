"""GGX with multiple scattering: a rough metal that keeps the light its facets throw at each other.

Use it in place of GGX where a rough metal must not darken: what single scattering loses, up to 69 % at normal
incidence for α = 1, comes back as a broad second lobe. Perfect mirrors then lose nothing: the directional
albedo is 1 to 1e-11 for every direction. The second lobe has the right energy, not the right shape: that of
facets which scatter twice is broader towards the mirror direction.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.elementary import log1p
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.kernels import Kernel, bind, kernel, select
from radiokit.measure.slope import slope_rule
from radiokit.measure.twin import Twin
from radiokit.measure.vectors import from_disk
from radiokit.physics import fresnel
from radiokit.physics import microfacet as paper
from radiokit.physics.facet import reflect
from radiokit.physics.fresnel import conductor_kernel
from radiokit.physics.masking import HORIZON, correlated_over_cosines
from radiokit.physics.ndf import ggx_area_isotropic, ggx_density
from radiokit.physics.reflection import metal_share, schlick_share
from radiokit.physics.visible import ggx_visible, reflected_density

__all__ = ["GGXMultiscatter"]

SOURCE = Source(
    authors="Kulla, Conty",
    year=2017,
    title="Revisiting Physically Based Shading at Imageworks. SIGGRAPH Course: Physically Based Shading in "
    "Theory and Practice",
    equation="f_ms = (1 − E(μi))(1 − E(μo)) / (π (1 − E_avg)), of Kelemen & Szirmay-Kalos (2001), and its "
    "colour F_ms = F_avg E_avg / (1 − F_avg (1 − E_avg)). Hill (2018), A Multi-Faceted Exploration, part 2, "
    "has F_avg² in it, for two bounces or more; here it stands as published",
)

_NODES, _RULE = 96, (208, 152)
_CHOP = 1e-12  # coefficients whose magnitudes sum to less are left out


@kernel
def _loss(mu: Any, alpha: Any, per_span: Any, *series: Any) -> Any:
    """Return 1 − E(μ) [1], a Chebyshev series in the fourth root of asinh(μ/α) over √(1 + μ²/α²).

    1 − E is a function of μ/α for narrow lobes, and as μ → 0 it goes like μ log μ, which the root flattens.
    """
    m = mu / alpha
    steep = np.sqrt(1.0 + m * m)
    x = np.sqrt(np.sqrt(log1p(m + m * m / (1.0 + steep)) * per_span))
    # Clenshaw's sum in Reinsch's form, which keeps the digits at both ends: T_k(-y) = (-1)^k T_k(y).
    low = x < 0.5
    sign, u = select(low, -1.0, 1.0), -4.0 * select(low, x, 1.0 - x)
    step, total = 0.0 * mu, 0.0 * mu
    for k in range(len(series) - 1, 0, -1):
        total = series[k] * (sign if k % 2 else 1.0) + u * step + total
        step = total + step
    loss = series[0] + 0.5 * u * step + total
    return select(loss > 0.0, loss / steep, 0.0)


@kernel
def _single(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any) -> Any:
    """Return D G₂ / (4 cosθi cosθo), for two directions above the horizon."""
    density = ggx_density(ix + ox, iy + oy, iz + oz, alpha, alpha)
    areas = ggx_area_isotropic(iz, alpha), ggx_area_isotropic(oz, alpha)
    return density * correlated_over_cosines(iz, oz, areas[0], areas[1])


@kernel
def _perfect(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, a: Any, b: Any) -> Any:
    return 1.0 + 0.0 * iz


@kernel
def _schlick(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, a: Any, b: Any) -> Any:
    return schlick_share(ix, iy, iz, ox, oy, oz, a)


def _value(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any,
    alpha: Any, a: Any, b: Any, tint: Any, scale: Any, per_span: Any, *series: Any,
) -> Any:  # fmt: skip
    above = (iz > HORIZON) & (oz > HORIZON)
    zi, zo = select(above, iz, 1.0), select(above, oz, 1.0)
    single = _mirror(ix, iy, zi, ox, oy, zo, a, b) * _single(ix, iy, zi, ox, oy, zo, alpha)
    lost = _loss(zi, alpha, per_span, *series) * _loss(zo, alpha, per_span, *series)
    return select(above, single + tint * (lost * scale), 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any,
    alpha: Any, a: Any, b: Any, tint: Any, scale: Any, per_span: Any, *series: Any,
) -> Any:  # fmt: skip
    """Return the density of visible normals, and the cosine's for the share that is lost at first."""
    above = (iz > HORIZON) & (oz > HORIZON)
    zi, zo = select(above, iz, 1.0), select(above, oz, 1.0)
    again = _loss(zo, alpha, per_span, *series)
    normals = ggx_density(ix + ox, iy + oy, zi + zo, alpha, alpha)
    first = reflected_density(normals, ggx_area_isotropic(zo, alpha))
    return select(above, (1.0 - again) * first + again * zi / np.pi, 0.0)


def _sample(
    u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any,
    alpha: Any, a: Any, b: Any, tint: Any, scale: Any, per_span: Any, *series: Any,
) -> Any:  # fmt: skip
    hx, hy, hz = ggx_visible(u0, u1, ox, oy, oz, alpha, alpha)
    rx, ry, rz = reflect(ox, oy, oz, hx, hy, hz)
    dx, dy, dz = from_disk(u0, u1)
    again = u2 < _loss(select(oz > HORIZON, oz, 1.0), alpha, per_span, *series)
    wx, wy, wz = select(again, dx, rx), select(again, dy, ry), select(again, dz, rz)
    value = _whole(wx, wy, wz, ox, oy, oz, alpha, a, b, tint, scale, per_span, *series)
    density = _density(wx, wy, wz, ox, oy, oz, alpha, a, b, tint, scale, per_span, *series)
    weight = value * wz / select(density > 0.0, density, 1.0)
    return wx, wy, wz, select(density > 0.0, weight, 0.0)


_mirror: Any = None  # these stand for kernels
_whole: Any = None


def _kernels(mirror: Kernel) -> tuple[Kernel, Kernel, Kernel]:
    value = bind(_value, _mirror=mirror)
    return value, _density, bind(_sample, _whole=value)


_PERFECT, _BY_F0, _METAL = _kernels(_perfect), _kernels(_schlick), _kernels(metal_share)


def _per_span(alpha: float) -> float:
    """Return 1/asinh(1/α), which makes the series' variable 1 at μ = 1."""
    return float(1.0 / np.arcsinh(1.0 / alpha))


@lru_cache(maxsize=64)
def _table(alpha: float) -> tuple[tuple[float, ...], float]:
    """Return the series of 1 − E, whose last digits are those of E, and 1 − E_avg.

    E by the slope-space rule, at Chebyshev's points.
    """
    span = float(np.arcsinh(1.0 / alpha))
    t = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    lost = np.zeros(_NODES)
    for k, mu in enumerate(np.minimum(alpha * np.sinh(span * (0.5 + 0.5 * t) ** 4), 1.0)):
        if mu > 1e-15:  # below it all of it is in the last digits
            wo = np.array([np.sqrt((1.0 - mu) * (1.0 + mu)), 0.0, mu])
            wi, weight = slope_rule(wo, alpha, _RULE, symmetric=True)
            lost[k] = 1.0 - np.sum(_single(*wi.T, *wo, alpha) * wi[:, 2] * weight)
    lost *= np.cosh(span * (0.5 + 0.5 * t) ** 4)
    series = np.polynomial.chebyshev.chebfit(t, lost, _NODES - 1)
    tail = np.cumsum(np.abs(series[::-1]))[::-1]
    series = series[: int(np.argmax(tail < _CHOP)) or _NODES]
    x, weight = gauss_legendre(200)
    mu, slope = alpha * np.sinh(span * x**4), alpha * np.cosh(span * x**4) * 4.0 * span * x**3
    mean = 2.0 * np.sum(weight * slope * mu * _loss(mu, alpha, _per_span(alpha), *series.tolist()))
    return tuple(series.tolist()), float(mean)


@lru_cache(maxsize=64)
def _loss_symbolic(alpha: float) -> Any:
    """Return 1 − E as a SymPy function of μ, of 1/asinh(1/α), and of two factors that are 1.

    They are those of the even and the odd terms of the series: a condition number then counts what the
    rounding of the series and of its argument does.
    """
    from sympy.utilities.lambdify import implemented_function

    series, _ = _table(alpha)

    def series_sum(mu: Any, per_span: Any, even: Any, odd: Any) -> Any:
        import mpmath

        if isinstance(mu, np.ndarray):  # of floats, with which the nodes of an integral are planned
            steep, asinh, sqrt = np.maximum(mu, 0.0) / alpha, np.arcsinh, np.sqrt
        else:
            steep, asinh, sqrt = mu / mpmath.mpf(alpha), mpmath.asinh, mpmath.sqrt
        t = 2 * sqrt(sqrt(asinh(steep) * per_span)) - 1
        total, before, term = even * series[0], 1, t
        for k, coefficient in enumerate(series[1:], start=1):
            total += (odd if k % 2 else even) * coefficient * term
            before, term = term, 2 * t * term - before
        return total / sqrt(1 + steep**2)

    return implemented_function("L", series_sum)


@dataclass(frozen=True, kw_only=True)
class GGXMultiscatter(ScalarBSDF):
    """GGX facets with Smith's height-correlated G₂, and Kulla and Conty's lobe of what they lose.

    Parameters
    ----------
    alpha : float
        Width α of the slope distribution [1], not squared, in [0.01, 1]: narrower lobes lose next to
        nothing, and ``ggx`` will do.
    eta, k : float or sequence of float, optional
        Relative index η + ik of the metal [1]: η above 0, extinction k at least 0; both or neither.
    f0 : float or sequence of float, optional
        Reflectance of a facet at normal incidence [1], in [0, 1], for Schlick's F. Without an index or
        ``f0`` the facets reflect everything (F = 1).

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or those that exclude each other or belong together are not
        given so.

    >>> from radiokit.contracts.albedo import albedo
    >>> round(float(albedo(GGXMultiscatter(alpha=1.0), (0.0, 0.0, 1.0)).value), 9)
    1.0
    """

    name = "ggx_multiscatter"
    kind = "microfacet"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"alpha": 1.0}, {"alpha": 0.01}, {"alpha": 0.6, "eta": 0.2, "k": 3.9}, {"f0": 0.04})

    dimensions = 3
    precision = 1e-11  # that of E

    alpha: float = parameter("[0.01, 1]", "1", "width of the slope distribution", default=0.3)
    eta: Spectrum | None = parameter(
        "(0, inf)", "1", "real part of the relative index", spectral=True, default=None
    )
    k: Spectrum | None = parameter("[0, inf)", "1", "extinction", spectral=True, default=None)
    f0: Spectrum | None = parameter(
        "[0, 1]", "1", "reflectance of a facet at normal incidence", spectral=True, default=None
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.eta is None) != (self.k is None):
            alone, other = ("eta", "k") if self.k is None else ("k", "eta")
            raise ParameterError(other, None, f"given, as {alone} is: an index has both parts")
        if self.f0 is not None and self.eta is not None:
            raise ParameterError(
                "f0", self.f0, "left out, as eta and k are given: either says what facets do"
            )

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with 1 − E as the series that the kernels take."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        alpha, eta, k, f0, mean, tint = sympy.symbols("alpha eta k f0 l_avg f_ms", positive=True)
        series = sympy.symbols("s even odd", positive=True)
        wi, wo = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:]
        half = [i + o for i, o in zip(wi, wo, strict=True)]
        cosine = sympy.sqrt((1 + paper.dot_symbolic(wi, wo)) / 2)  # of half the angle between them
        loss = _loss_symbolic(self.alpha)
        values: dict[Any, Any] = {alpha: self.alpha, mean: self._lost()}
        values |= dict(zip(series, (_per_span(self.alpha), 1.0, 1.0), strict=True))
        reflectance, colour = sympy.S.One, sympy.S.One
        if self.f0 is not None:
            reflectance = fresnel.schlick_symbolic(cosine, f0)
            average = (20 * f0 + 1) / 21
            colour = average * (1 - mean) / (1 - average * mean)
            values |= {f0: self.f0}
        elif self.eta is not None and self.k is not None:
            reflectance, colour = fresnel.conductor_symbolic(cosine, eta, k), tint
            values |= {eta: self.eta, k: self.k, tint: self._tint()}
        smith = [paper.ggx_lambda_symbolic(w, alpha, alpha) for w in (wi, wo)]
        single = paper.ggx_d_symbolic(half, alpha, alpha) * paper.correlated_symbolic(*smith)
        multiple = loss(wi[2], *series) * loss(wo[2], *series) / (sympy.pi * mean)
        return Twin(reflectance * single / (4 * wi[2] * wo[2]) + colour * multiple, values)

    def kernels(self) -> Kernels:
        """Return the kernels for the facets' reflectance, and the series of 1 − E among their constants."""
        series, mean = _table(self.alpha)
        shape = (self._tint(), 1.0 / (np.pi * mean), _per_span(self.alpha), *series)
        if self.f0 is not None:
            return Kernels(*_BY_F0, (self.alpha, self.f0, 0.0, *shape))
        if self.eta is not None and self.k is not None:
            return Kernels(*_METAL, (self.alpha, *fresnel.clip_index(self.eta, self.k), *shape))
        return Kernels(*_PERFECT, (self.alpha, 0.0, 0.0, *shape))

    def _lost(self) -> float:
        """Return 1 − E_avg."""
        return _table(self.alpha)[1]

    def _tint(self) -> Any:
        """Return F_ms, () or (K,)."""
        if self.f0 is not None:
            average = (20.0 * np.asarray(self.f0) + 1.0) / 21.0
        elif self.eta is not None and self.k is not None:
            mu, weight = gauss_legendre(200)
            eta, k = fresnel.clip_index(np.asarray(self.eta)[..., None], np.asarray(self.k)[..., None])
            average = 2.0 * np.sum(weight * mu * conductor_kernel(mu, eta, k), axis=-1)
        else:
            return 1.0
        lost = self._lost()
        tint = average * (1.0 - lost) / (1.0 - average * lost)
        return float(tint) if tint.ndim == 0 else tuple(tint.tolist())

    def lobe_width(self) -> float:
        """Return α, the width of the narrower lobe."""
        return self.alpha

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving; lossless where the facets reflect everything."""
        perfect = self.eta is None and (self.f0 is None or bool(np.all(np.equal(self.f0, 1.0))))
        return Claims(reciprocity="yes", conserves=True, lossless=perfect)
