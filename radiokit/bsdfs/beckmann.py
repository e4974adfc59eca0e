"""Beckmann: a rough metal, made of tiny mirrors whose slopes are Gaussian.

For surfaces whose height is a Gaussian process: polished and ground metals, water under wind. The highlight
ends sooner than that of GGX. Shadowing and masking are Smith's, which suits such a surface, or those of
Torrance and Sparrow's V-grooves. Single scattering only, so a rough surface loses energy. Without an index
its facets reflect everything.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.facets import RoughMirror
from radiokit.contracts.parameters import choice
from radiokit.contracts.scalar import Kernels
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin
from radiokit.physics.reflection import BECKMANN, MASKINGS, Law

__all__ = ["Beckmann"]

SOURCE = Source(
    authors="Walter, Marschner, Li, Torrance",
    year=2007,
    title="Microfacet Models for Refraction through Rough Surfaces. Eurographics Symposium on Rendering",
    doi="10.2312/EGWR/EGSR07/195-206",
    equation="20 (the BRDF) and 25 (D, of Beckmann & Spizzichino, 1963); two widths, Λ and G₂ from Heitz "
    "(2014), Understanding the Masking-Shadowing Function, Journal of Computer Graphics Techniques 3(2), "
    "section 5.3 and equations 80, 86, 98, 99; the V-groove's G from Cook & Torrance (1982). Walter's "
    "equation 27 is a rational fit of G₁, of relative error 0.35 %: here G₁ is exact",
)


@dataclass(frozen=True, kw_only=True)
class Beckmann(RoughMirror):
    """Gaussian facets, f = F D G₂ / (4 cosθi cosθo), with Smith's or the V-groove's G₂.

    Parameters
    ----------
    alpha : float, optional
        Width α of the slope distribution [1], √2 times the slope's root mean square along one axis, in
        [1e-4, 1]; 0.3 by default.
    alpha_x, alpha_y : float, optional
        Widths along x and y [1], in [1e-4, 1]; both, in place of ``alpha``.
    masking : {"height-correlated", "separable", "v-groove"}
        Smith's G₂ = 1/(1 + Λi + Λo), or independent shadowing and masking, G₂ = 1/((1 + Λi)(1 + Λo)), or
        min(1, 2 (n·h)(n·wi)/(wi·h), 2 (n·h)(n·wo)/(wo·h)).
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

    >>> f = Beckmann(alpha=0.5)
    >>> round(float(f([0, 0, 1], [0, 0, 1])), 12) == round(1 / (4 * 3.141592653589793 * 0.25), 12)
    True
    """

    name = "beckmann"
    SOURCE = SOURCE
    EXAMPLES = (
        {},
        {"alpha": 1.0},
        {"alpha": 0.001},
        {"alpha": 0.2, "eta": 0.2, "k": 3.9},
        {"alpha_x": 0.5, "alpha_y": 0.1},
        {"alpha": 0.6, "masking": "v-groove"},
        {"alpha": 0.6, "masking": "separable", "f0": 0.04},
    )
    LAW: ClassVar[Law] = BECKMANN

    masking: str = choice(*MASKINGS, meaning="how facets hide one another")

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the tangents and error functions of the sources."""
        return self.reflection_twin()

    def kernels(self) -> Kernels:
        """Return the kernels, without a Fresnel factor where there is no index."""
        return self.reflection_kernels()

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving, but not lossless: light that bounces twice is gone."""
        return Claims(reciprocity="yes", conserves=True)
