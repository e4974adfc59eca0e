"""Cook-Torrance: Beckmann's facets in V-grooves, with the constant as the paper of 1982 prints it.

For teaching, and for what follows the paper to the letter. It reflects four times the light that its own
facets do: 400 % of what arrives at normal incidence for small slopes, and, without an index, at any slope as
θ → 90°; with F₀ = 0.04 and m = 0.3, 205 %. It conserves energy where F, averaged over facets seen along the
surface, is at most 1/4: with Schlick's F from m = 0.846 up for F₀ = 0, and up to F₀ = 0.0336 for m = 1; for
glass of m = 1 up to η = 1.466. The same facets with the right constant are those of ``beckmann`` with
``masking="v-groove"``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.facets import WIDTH, FacetBSDF
from radiokit.contracts.parameters import parameter
from radiokit.contracts.scalar import Kernels
from radiokit.facts.source import Source
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.kernels import Kernel, bind
from radiokit.measure.twin import Twin
from radiokit.physics.microfacet import cosine_symbolic, groove_symbolic
from radiokit.physics.reflection import BECKMANN, Law

__all__ = ["CookTorrance"]

SOURCE = Source(
    authors="Cook, Torrance",
    year=1982,
    title="A Reflectance Model for Computer Graphics. ACM Transactions on Graphics 1(1)",
    doi="10.1145/357290.357293",
    equation="R_s = (F/π) D G / ((n·l)(n·v)), with G, and with Beckmann's D = exp(−tan²α/m²)/(m² cos⁴α). "
    "Erratum: ∫ D cosα dω is π, so that D/π is the density of normals, and the factor 1/4 of the change from "
    "normals to directions (Walter et al., 2007, equation 20) is missing. The version of 1981 (Computer "
    "Graphics 15(3)) has it, in D = exp(−tan²α/m²)/(4 m² cos⁴α); a D that is normalised, put into the same "
    "R_s, is off by 4/π",
)

_PRINTED = 4.0
"""What the paper's factor is to that of facets which reflect no more than arrives."""

_REACH = 6.0
"""Slopes beyond this many widths are as good as none: exp(−36)."""

_value: Any = None  # these two stand for kernels
_sample: Any = None


def _printed_value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, *constants: Any) -> Any:
    return _PRINTED * _value(ix, iy, iz, ox, oy, oz, *constants)


def _printed_sample(u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, *constants: Any) -> Any:
    wx, wy, wz, share = _sample(u0, u1, u2, ox, oy, oz, *constants)
    return wx, wy, wz, _PRINTED * share


@lru_cache(maxsize=8)
def _printed(value: Kernel, sample: Kernel) -> tuple[Kernel, Kernel]:
    return bind(_printed_value, _value=value), bind(_printed_sample, _sample=sample)


@dataclass(frozen=True, kw_only=True)
class CookTorrance(FacetBSDF):
    """The specular part of Cook and Torrance's reflectance, f = F D G / (π cosθi cosθo), as printed.

    Parameters
    ----------
    alpha : float
        The root mean square slope m of the facets [1], in [1e-4, 1].
    eta, k : float or sequence of float, optional
        Relative index η + ik of the facets [1]: η above 0, extinction k at least 0; both or neither.
    f0 : float or sequence of float, optional
        Reflectance of a facet at normal incidence [1], in [0, 1], for Schlick's F. Without an index or
        ``f0`` the facets reflect everything (F = 1).

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or those that exclude each other or belong together are not
        given so.

    >>> f = CookTorrance(alpha=0.5, f0=0.04)
    >>> round(float(f([0, 0, 1], [0, 0, 1])), 12) == round(0.04 / (3.141592653589793 * 0.25), 12)
    True
    """

    name = "cook_torrance"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"f0": 0.04}, {"alpha": 0.001}, {"alpha": 1.0, "f0": 0.0}, {"eta": 0.2, "k": 3.9})
    LAW: ClassVar[Law] = BECKMANN

    alpha: float = parameter(WIDTH, "1", "root mean square slope of the facets", default=0.3)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, in the paper's angles."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        m = sympy.Symbol("m", positive=True)
        light, viewer = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:]
        half = [a + b for a, b in zip(light, viewer, strict=True)]
        cos_a = cosine_symbolic(half, (0, 0, 1))
        tan2 = (half[0] ** 2 + half[1] ** 2) / half[2] ** 2
        slopes = sympy.exp(-tan2 / m**2) / (m**2 * cos_a**4)
        share, values = self.reflectance_symbolic(cosine_symbolic(viewer, half))
        hidden = groove_symbolic(half, light, viewer)
        return Twin(share / sympy.pi * slopes * hidden / (light[2] * viewer[2]), {m: self.alpha} | values)

    def kernels(self) -> Kernels:
        """Return the kernels: the V-groove's, with the paper's factor."""
        found = self.reflection_kernels()
        value, sample = _printed(found.value, found.sample)
        return replace(found, value=value, sample=sample)

    def grazing_albedo(self) -> Any:
        """Return the directional albedo [1] as θ → 90°, where it is largest: 4 times the mean of F.

        One of a groove's two facets is seen then, as much of it as the groove covers of the surface, so that
        every pair counts by its share of the area; F is that at o·h, with o along x.
        """
        x, weight = gauss_legendre(96)
        slope, azimuth = self.alpha * _REACH * x[:, None], 0.5 * np.pi * x
        area = 2.0 * _REACH**2 * x * np.exp(-((_REACH * x) ** 2)) * weight
        cosine = slope * np.cos(azimuth) / np.sqrt(1.0 + slope * slope)
        mean = np.tensordot(self.reflectance(cosine), np.outer(area, weight), axes=((-2, -1), (0, 1)))
        return _PRINTED * mean

    @property
    def claims(self) -> Claims:
        """Reciprocal; conserving where even at grazing incidence F outweighs the factor."""
        return Claims(reciprocity="yes", conserves=bool(np.all(self.grazing_albedo() <= 1.0)))
