"""The microfacet contract: what the judges may ask of a distribution of facets."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

__all__ = ["Microfacets"]

FloatArray = npt.NDArray[np.float64]


@runtime_checkable
class Microfacets(Protocol):
    """The facets of a rough surface: how many face each way, and how they hide one another.

    ``BSDF.microfacets`` returns one, or None. Directions are unit vectors (N, 3); a facet's normal ``h`` and
    the macroscopic normal z point to the same side, and the facet is turned to ``w`` where w·h > 0.
    """

    def density(self, h: FloatArray) -> FloatArray:
        """Return D(h) [sr⁻¹], the area of facets about ``h`` per solid angle and per area of surface (N,)."""

    def masking(self, w: FloatArray, h: FloatArray) -> FloatArray:
        """Return G₁(w, h) [1] (N,), the share of the facets about ``h`` that is seen from ``w``."""

    def shadowing(self, wi: FloatArray, wo: FloatArray, h: FloatArray) -> FloatArray:
        """Return G₂(wi, wo, h) [1] (N,), the share that is seen from both."""
