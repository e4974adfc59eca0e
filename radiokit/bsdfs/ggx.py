"""GGX: a rough metal, made of tiny mirrors whose slopes follow the distribution with the long tails.

The everyday microfacet model: visible-normal sampling, of one width or two, shadowing and masking correlated
by height (or independent). Single scattering only, so a rough surface loses energy (white-sky albedo
4/3 (1 − ln 2) = 0.409 at α = 1). Without an index its facets reflect everything.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.facets import RoughMirror
from radiokit.contracts.scalar import Kernels
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel
from radiokit.measure.twin import Twin
from radiokit.physics import reflection
from radiokit.physics.ndf import ggx_area_isotropic
from radiokit.physics.reflection import Law

__all__ = ["GGX"]

SOURCE = Source(
    authors="Walter, Marschner, Li, Torrance",
    year=2007,
    title="Microfacet Models for Refraction through Rough Surfaces. Eurographics Symposium on Rendering",
    doi="10.2312/EGWR/EGSR07/195-206",
    equation="20 (the BRDF) and 33 (D); two widths, Λ and G₂ from Heitz (2014), Understanding the "
    "Masking-Shadowing Function, Journal of Computer Graphics Techniques 3(2), equations 72, 85, 86, 98, 99",
)


@kernel
def _round_area(wx: Any, wy: Any, wz: Any, alpha_x: Any, alpha_y: Any) -> Any:
    """Return σ(w) for equal widths: the cosine is enough, and the sampler need not know the azimuth."""
    return ggx_area_isotropic(wz, alpha_x)


ROUND = replace(reflection.GGX, area=_round_area)


@dataclass(frozen=True, kw_only=True)
class GGX(RoughMirror):
    """GGX facets, f = F D G₂ / (4 cosθi cosθo), with Smith's G₂.

    Parameters
    ----------
    alpha : float, optional
        Width α of the slope distribution [1], not squared, in [1e-4, 1]; 0.3 by default.
    alpha_x, alpha_y : float, optional
        Widths along x and y [1], in [1e-4, 1]; both, in place of ``alpha``.
    masking : {"height-correlated", "separable"}
        G₂ = 1/(1 + Λi + Λo), or independent shadowing and masking, G₂ = 1/((1 + Λi)(1 + Λo)).
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

    >>> f = GGX(alpha=0.5)
    >>> round(float(f([0, 0, 1], [0, 0, 1])), 12) == round(1 / (4 * 3.141592653589793 * 0.25), 12)
    True
    >>> GGX(alpha_x=0.5, alpha_y=0.1).isotropic
    False
    """

    name = "ggx"
    kind = "microfacet"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"alpha": 1.0},
        {"alpha": 0.01},
        {"alpha": 0.001},
        {"alpha": 0.2, "eta": 0.2, "k": 3.9},
        {"alpha_x": 0.5, "alpha_y": 0.1},
        {"alpha": 0.6, "masking": "separable", "f0": 0.04},
    )
    LAW: ClassVar[Law] = reflection.GGX

    @property
    def law(self) -> Law:
        """The law of the slopes; with equal widths, one that is less work."""
        return ROUND if self.isotropic else self.LAW

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the angles and tangents of the sources."""
        return self.reflection_twin()

    def kernels(self) -> Kernels:
        """Return the kernels, without a Fresnel factor where there is no index."""
        return self.reflection_kernels()

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: light that bounces twice is gone."""
        return Claims(reciprocity="yes", conserves=True)
