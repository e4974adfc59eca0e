"""Rough dielectric: frosted glass, made of tiny windows that each reflect one part and refract the rest.

Use it for ground glass and rough water, seen from either side; the limit α → 0 is the dielectric. The
facets are GGX's, or Beckmann's where frost has no long tails. Single scattering only: what one facet sends
into another is lost, for α = 0.3 and η = 1.5 1.2 % at normal incidence and up to 26 % elsewhere. Reciprocity
holds once the index is counted: f(wi, wo) = f(wo, wi) itself is off by η² for light that passes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims, FloatArray
from radiokit.contracts.microfacet import Microfacets
from radiokit.contracts.parameters import choice, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.kernels import Kernel, bind, kernel, select
from radiokit.measure.passes import run
from radiokit.measure.twin import Twin
from radiokit.physics import microfacet as paper
from radiokit.physics.facet import reflect, refract, refraction_share
from radiokit.physics.interface import conductor_facet_kernel
from radiokit.physics.masking import HORIZON, masking, separable_ratio
from radiokit.physics.ndf import beckmann_area, beckmann_density, ggx_area, ggx_density
from radiokit.physics.visible import beckmann_visible, ggx_visible

__all__ = ["RoughDielectric"]

SOURCE = Source(
    authors="Walter, Marschner, Li, Torrance",
    year=2007,
    title="Microfacet Models for Refraction through Rough Surfaces. Eurographics Symposium on Rendering",
    doi="10.2312/EGWR/EGSR07/195-206",
    equation="13 and 16 (half vectors), 20 and 21 (reflection and transmission), 22 (F), 23 (separable G), "
    "25 and 33 (D). Equation 16 points into the rarer medium; here it is turned to the side of the normal, "
    "as the D of equations 25 and 33 asks for",
)

LEAST_STEP = 1e-4
"""How far η must be from 1: the facet that refracts is known to ε/|η − 1|."""


@kernel
def _sides(iz: Any, oz: Any, eta: Any) -> Any:
    """Return whether light passes, the indices on the sides of wi and wo, and whether both have a side."""
    up_i, up_o = iz > 0.0, oz > 0.0
    off = (abs(iz) > HORIZON) & (abs(oz) > HORIZON)
    return up_i != up_o, select(up_i, 1.0, eta), select(up_o, 1.0, eta), off


@kernel
def _passed(n_i: Any, n_o: Any, along_i: Any, along_o: Any) -> Any:
    """Return 1 − F [1] from both cosines, which may have a common factor: nothing cancels, near any angle."""
    s_i, s_o, p_i, p_o = n_i * along_i, n_o * along_o, n_o * along_i, n_i * along_o
    s, p = s_i + s_o, p_i + p_o
    s, p = 1.0 / select(s > 0.0, s, 1.0), 1.0 / select(p > 0.0, p, 1.0)
    return 2.0 * ((s_i * s) * (s_o * s) + (p_i * p) * (p_o * p))


def _lobe(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any) -> Any:
    """Return what value and density share, D F or 4 D (1 − F) |i·h| |o·h|/|n_i i + n_o o|², and n_i and n_o.

    The half vector is n_i i + n_o o across the surface, and i + o on one side of it: the sum of the
    directions, exact where they nearly cancel, and what the index adds to the one below.
    """
    through, n_i, n_o, off = _sides(iz, oz, eta)
    down_i = iz < 0.0
    step = select(through, eta - 1.0, 0.0)
    hx = (ix + ox) + step * select(down_i, ix, ox)
    hy = (iy + oy) + step * select(down_i, iy, oy)
    hz = (iz + oz) + step * select(down_i, iz, oz)
    along_i, along_o, length2 = (
        ix * hx + iy * hy + iz * hz,
        ox * hx + oy * hy + oz * hz,
        hx * hx + hy * hy + hz * hz,
    )
    # A facet's front is on the side of the normal, and turned to the direction that is there.
    front = ((along_i * hz) > 0.0) != down_i
    share = select(front, refraction_share(along_i, along_o, length2), 0.0)
    passed = 4.0 * share * _passed(n_i, n_o, abs(along_i), abs(along_o))
    cosine = 0.5 * np.sqrt(length2)
    dx, dy, dz = ix - ox, iy - oy, iz - oz
    sine = 0.5 * np.sqrt(dx * dx + dy * dy + dz * dz)
    cosine, sine = select(cosine < 1.0, cosine, 1.0), select(sine < 1.0, sine, 1.0)
    mirrored = conductor_facet_kernel(cosine, sine, select(down_i, 1.0 / eta, eta), 0.0)
    lobe = _facets(hx, hy, hz, alpha, alpha) * select(through, passed, mirrored)
    return select(off, lobe, 0.0), select(through, n_i, 1.0), select(through, n_o, 1.0)


def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any) -> Any:
    lobe, _, n_o = _shared(ix, iy, iz, ox, oy, oz, alpha, eta)
    seen = _area(ix, iy, iz, alpha, alpha) * _area(ox, oy, oz, alpha, alpha)
    return 0.25 * lobe * (n_o * n_o) / seen


def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any) -> Any:
    lobe, n_i, _ = _shared(ix, iy, iz, ox, oy, oz, alpha, eta)
    return 0.25 * lobe * (n_i * n_i) / _area(ox, oy, oz, alpha, alpha)


def _sample(u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, alpha: Any, eta: Any) -> Any:
    """Return wi about a visible normal, mirrored with chance F or refracted, and G₁(wi) n_o²/n_i²."""
    up = oz > 0.0
    n_o, n_t = select(up, 1.0, eta), select(up, eta, 1.0)
    z = abs(oz)
    hx, hy, hz = _visible(u0, u1, ox, oy, z, alpha, alpha)
    inverse = 1.0 / np.sqrt(hx * hx + hy * hy + hz * hz)
    hx, hy, hz = hx * inverse, hy * inverse, hz * inverse
    tx, ty, tz, behind = refract(ox, oy, z, hx, hy, hz, n_t / n_o)
    rx, ry, rz = reflect(ox, oy, z, hx, hy, hz)
    through = u2 < _passed(n_t, n_o, behind, abs(ox * hx + oy * hy + z * hz))
    wx, wy, wz = select(through, tx, rx), select(through, ty, ry), select(through, tz, rz)
    inverse = 1.0 / np.sqrt(wx * wx + wy * wy + wz * wz)
    wx, wy, wz = wx * inverse, wy * inverse, wz * inverse
    away = select(through, -wz, wz)  # above 0 on the side to which light is meant to go
    ratio = select(through, n_o / n_t, 1.0)
    weight = separable_ratio(away, z, _area(wx, wy, wz, alpha, alpha), 1.0) * (ratio * ratio)
    return wx, wy, select(up, wz, -wz), weight


_shared: Any = None  # these stand for kernels of the distributions
_facets: Any = None
_area: Any = None
_visible: Any = None


def _kernels(density: Kernel, area: Kernel, visible: Kernel) -> tuple[Kernel, Kernel, Kernel]:
    shared = bind(_lobe, _facets=density)
    return (
        bind(_value, _shared=shared, _area=area),
        bind(_density, _shared=shared, _area=area),
        bind(_sample, _visible=visible, _area=area),
    )


_GGX = _kernels(ggx_density, ggx_area, ggx_visible)
_BECKMANN = _kernels(beckmann_density, beckmann_area, beckmann_visible)


@dataclass(frozen=True, kw_only=True)
class _Facets:
    """The facets of one distribution, with Smith's masking and shadowing independent of each other."""

    distribution: Kernel
    area: Kernel
    alpha: float

    def density(self, h: FloatArray) -> FloatArray:
        return np.asarray(run(self.distribution, list(h.T), (self.alpha, self.alpha)))

    def masking(self, w: FloatArray, h: FloatArray) -> FloatArray:
        return np.asarray(masking(np.abs(w[:, 2]), run(self.area, list(w.T), (self.alpha, self.alpha))))

    def shadowing(self, wi: FloatArray, wo: FloatArray, h: FloatArray) -> FloatArray:
        return self.masking(wi, h) * self.masking(wo, h)


@dataclass(frozen=True, kw_only=True)
class RoughDielectric(ScalarBSDF):
    """The rough interface between two transparent media; its masking is Smith's, G = G₁(wi) G₁(wo).

    Parameters
    ----------
    alpha : float
        Width α of the slope distribution [1], not squared, in [1e-4, 1].
    eta : float
        η, the index below the surface over that above it [1], in [0.1, 10], and at least 1e-4 away from 1:
        where nothing is bent there is no lobe. A single number, since the refracted directions depend on it.
    distribution : {"ggx", "beckmann"}
        The law of the facets' slopes.

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or the distribution unknown.

    >>> f = RoughDielectric(alpha=0.5, eta=1.5)
    >>> down, up = f([0, 0, -1], [0, 0, 1]), f([0, 0, 1], [0, 0, -1])
    >>> round(float(up / down), 12), f.claims.reciprocity
    (2.25, 'eta-scaled')
    """

    name = "rough_dielectric"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"eta": 1 / 1.5},
        {"alpha": 1.0, "eta": 1.33},
        {"alpha": 0.05, "eta": 2.4},
        {"alpha": 1e-3},
        {"alpha": 0.4, "distribution": "beckmann"},
    )

    kind = "transmission"
    transmissive = True
    dimensions = 3

    alpha: float = parameter("[1e-4, 1]", "1", "width of the slope distribution", default=0.3)
    eta: float = parameter("[0.1, 10]", "1", "index below the surface over that above it", default=1.5)
    distribution: str = choice("ggx", "beckmann", meaning="law of the facets' slopes")

    def __post_init__(self) -> None:
        super().__post_init__()
        if abs(self.eta - 1.0) < LEAST_STEP:
            raise ParameterError(
                "eta", self.eta, f"at least {LEAST_STEP:g} away from 1, where nothing is bent"
            )

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the source's half vectors and tangents, for all four sides."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        alpha, eta = sympy.symbols("alpha eta", positive=True)
        wi, wo = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:]
        n_i, n_o = (sympy.Piecewise((1, w[2] > 0), (eta, True)) for w in (wi, wo))
        ggx = self.distribution == "ggx"
        d: Callable[..., Any] = paper.ggx_d_symbolic if ggx else paper.beckmann_d_symbolic
        smith: Callable[..., Any] = paper.ggx_lambda_symbolic if ggx else paper.beckmann_lambda_symbolic
        shadowing = paper.separable_symbolic(smith(wi, alpha, alpha), smith(wo, alpha, alpha))

        def fresnel(c: Any) -> Any:  # equation 22; where g is imaginary both amplitudes have the magnitude 1
            g = sympy.sqrt((eta / n_i**2) ** 2 - 1 + c**2)  # η/n_i² is n_t/n_i on either side
            s, p = (g - c) / (g + c), (c * (g + c) - 1) / (c * (g - c) + 1)
            return sympy.Abs(s) ** 2 * (1 + sympy.Abs(p) ** 2) / 2

        same = wi[2] * wo[2] > 0
        half = [  # equations 13 and 16
            sympy.Piecewise((i + o, same), (-(n_i * i + n_o * o), True)) for i, o in zip(wi, wo, strict=True)
        ]
        i_h, o_h = (paper.cosine_symbolic(w, half) for w in (wi, wo))
        reflectance = fresnel(sympy.Abs(i_h))
        under = sympy.Piecewise((1, same), ((n_i * i_h + n_o * o_h) ** 2, True))
        passed = n_o**2 * (1 - reflectance) * sympy.Abs(i_h * o_h) / under
        fronts = [(1 + sympy.sign(w_h * half[2] * w[2])) / 2 for w_h, w in ((i_h, wi), (o_h, wo))]  # χ⁺
        both = sympy.Piecewise((reflectance / 4, same), (passed * fronts[0] * fronts[1], True))
        lobe = both * d(half, alpha, alpha) * shadowing / sympy.Abs(wi[2] * wo[2])
        return Twin(lobe, {alpha: self.alpha, eta: self.eta})

    def kernels(self) -> Kernels:
        """Return the kernels of the distribution."""
        found = _GGX if self.distribution == "ggx" else _BECKMANN
        return Kernels(*found, (self.alpha, self.eta))

    def relative_index(self) -> float:
        """Return η."""
        return self.eta

    def microfacets(self) -> Microfacets:
        """Return the facets."""
        ggx = self.distribution == "ggx"
        kernels = (ggx_density, ggx_area) if ggx else (beckmann_density, beckmann_area)
        return _Facets(distribution=kernels[0], area=kernels[1], alpha=self.alpha)

    def lobe_width(self) -> float:
        """Return α."""
        return self.alpha

    @property
    def claims(self) -> Claims:
        """Reciprocal with the squares of the indices, and conserving; light that bounces twice is gone."""
        return Claims(reciprocity="eta-scaled", conserves=True)
