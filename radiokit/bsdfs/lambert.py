"""Lambert: light scattered so that the surface looks equally bright from everywhere.

The reference for every other model, and the paint in nearly every closed-form case. With reflectance 1 it
is the perfect diffuser, lossless and white.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims, FloatArray
from radiokit.contracts.parameters import parameter
from radiokit.facts.source import Source
from radiokit.measure.kernels import Kernel, kernel
from radiokit.measure.twin import Twin
from radiokit.measure.warps import CosineHemisphere

__all__ = ["Lambert"]

SOURCE = Source(
    authors="Nicodemus, Richmond, Hsia, Ginsberg, Limperis",
    year=1977,
    title="Geometrical Considerations and Nomenclature for Reflectance. NBS Monograph 160",
    doi="10.6028/NBS.MONO.160",
    equation="the perfectly diffuse surface, f = ρ/π",
)

_WARP = CosineHemisphere()


@kernel
def _weight(u0: float, u1: float, reflectance: float) -> float:
    return reflectance


@dataclass(frozen=True, kw_only=True)
class Lambert(BSDF):
    """The diffuse surface, f = ρ/π.

    Parameters
    ----------
    reflectance : float
        ρ, the albedo for every direction [1], in [0, 1].

    >>> import numpy as np
    >>> Lambert(reflectance=1.0)([0, 0, 1], [0.6, 0, 0.8]) == 1 / np.pi
    np.True_
    """

    name = "lambert"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"reflectance": 0.5}, {"reflectance": 0.0})

    reflectance: float = parameter("[0, 1]", "1", "albedo", default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, ρ/π."""
        import sympy

        rho = sympy.Symbol("rho", positive=True)
        return Twin(rho / sympy.pi, {rho: self.reflectance})

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹]."""
        return np.where(np.minimum(wi[..., 2], wo[..., 2]) > 0.0, self.reflectance / np.pi, 0.0)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``, cosθ/π."""
        return np.where(wo[..., 2] > 0.0, np.maximum(wi[..., 2], 0.0) / np.pi, 0.0)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi``, cosine-distributed, and ``weight = ρ``."""
        return _WARP.sample(u), np.where(wo[..., 2] > 0.0, self.reflectance, 0.0)

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def weight_kernel(self, wo: FloatArray) -> tuple[Kernel, tuple[float, ...]]:
        """Return ρ as a kernel."""
        return _weight, (self.reflectance,)

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    def diffuse_reflectance(self) -> float:
        """Return ρ."""
        return self.reflectance

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving; lossless when ρ = 1."""
        return Claims(reciprocity="yes", conserves=True, lossless=self.reflectance == 1.0)
