"""Lambert: light scattered so that the surface looks equally bright from everywhere.

The reference for every other model, and the paint in nearly every closed-form case. With reflectance 1 it
is the perfect diffuser, lossless and white.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.measure.vectors import from_disk

__all__ = ["Lambert"]

SOURCE = Source(
    authors="Nicodemus, Richmond, Hsia, Ginsberg, Limperis",
    year=1977,
    title="Geometrical Considerations and Nomenclature for Reflectance. NBS Monograph 160",
    doi="10.6028/NBS.MONO.160",
    equation="the perfectly diffuse surface, f = ρ/π",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, reflectance: Any) -> Any:
    return select((iz > 0.0) & (oz > 0.0), reflectance / np.pi, 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, reflectance: Any) -> Any:
    return select((iz > 0.0) & (oz > 0.0), iz / np.pi, 0.0)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, reflectance: Any) -> Any:
    x, y, z = from_disk(u0, u1)
    return x, y, z, select((z > 0.0) & (oz > 0.0), reflectance, 0.0)


@dataclass(frozen=True, kw_only=True)
class Lambert(ScalarBSDF):
    """The diffuse surface, f = ρ/π.

    Parameters
    ----------
    reflectance : float or sequence of float
        ρ, the albedo for every direction [1], in [0, 1].

    >>> import numpy as np
    >>> Lambert(reflectance=1.0)([0, 0, 1], [0.6, 0, 0.8]) == 1 / np.pi
    np.True_
    """

    name = "lambert"
    kind = "diffuse"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"reflectance": 0.5}, {"reflectance": 0.0})

    reflectance: Spectrum = parameter("[0, 1]", "1", "albedo", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, ρ/π."""
        import sympy

        rho = sympy.Symbol("rho", positive=True)
        return Twin(rho / sympy.pi, {rho: self.reflectance})

    def kernels(self) -> Kernels:
        """Return the kernels: a constant value, and samples whose projections fill the unit disk evenly."""
        return Kernels(_value, _density, _sample, (self.reflectance,))

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    def diffuse_reflectance(self) -> Any:
        """Return ρ, of shape () or (K,)."""
        return np.asarray(self.reflectance) if isinstance(self.reflectance, tuple) else self.reflectance

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving; lossless when ρ = 1."""
        return Claims(
            reciprocity="yes", conserves=True, lossless=bool(np.all(np.equal(self.reflectance, 1.0)))
        )
