"""Mirror: light reflected into the single direction that leaves at the angle at which it came.

A delta lobe and nothing else: ``evaluate`` and ``pdf`` are 0 for every pair of directions, the mirror pair
included, and ``delta_lobes`` holds the reflectance. Light from it is summed, not integrated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims, DeltaLobe, FloatArray
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.directions import reflect
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin

__all__ = ["Mirror"]

SOURCE = Source(
    authors="Nicodemus, Richmond, Hsia, Ginsberg, Limperis",
    year=1977,
    title="Geometrical Considerations and Nomenclature for Reflectance. NBS Monograph 160",
    doi="10.6028/NBS.MONO.160",
    equation="the perfectly specular surface, f = 2ρ δ(sin²θr − sin²θi) δ(φr − φi ± π)",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, reflectance: Any) -> Any:
    return 0.0 * iz * oz * reflectance


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, reflectance: Any) -> Any:
    return 0.0 * iz * oz


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, reflectance: Any) -> Any:
    return -ox, -oy, oz, select(oz > 0.0, reflectance, 0.0)


@dataclass(frozen=True, kw_only=True)
class Mirror(ScalarBSDF):
    """The perfectly specular surface.

    Parameters
    ----------
    reflectance : float or sequence of float
        ρ, the share of the flux that is reflected [1], in [0, 1], at any angle.

    >>> import numpy as np
    >>> (lobe,) = Mirror(reflectance=0.9).delta_lobes(np.array([[0.6, 0.0, 0.8]]))
    >>> lobe.wi.tolist(), lobe.weight.tolist()
    ([[-0.6, -0.0, 0.8]], [0.9])
    """

    name = "mirror"
    kind = "delta"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"reflectance": 0.5})

    reflectance: Spectrum = parameter("[0, 1]", "1", "share of the flux", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, ρ δ(x_i + x_o) δ(y_i + y_o).

        The source's expression in Cartesian components: x = sinθ cosφ and y = sinθ sinφ turn its deltas
        into these, and dx dy = cosθ dω, so ∫ f cosθ dω is an integral over x and y that SymPy finishes.
        """
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho = sympy.Symbol("rho", positive=True)
        x_i, y_i, _, x_o, y_o, _ = DIRECTION_SYMBOLS
        delta = sympy.DiracDelta
        return Twin(rho * delta(x_i + x_o) * delta(y_i + y_o), {rho: self.reflectance})

    def kernels(self) -> Kernels:
        """Return the kernels: 0 beside the delta lobe, and samples that are the mirror direction."""
        return Kernels(_value, _density, _sample, (self.reflectance,))

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return the one lobe: the mirror direction of ``wo`` (N, 3), with weight ρ."""
        weight = np.multiply.outer(wo[..., 2] > 0.0, np.asarray(self.reflectance))
        return (DeltaLobe(reflect(wo), weight),)

    @property
    def claims(self) -> Claims:
        """Reciprocal, conserving, nothing but a delta; lossless when ρ = 1."""
        lossless = bool(np.all(np.equal(self.reflectance, 1.0)))
        return Claims(reciprocity="yes", conserves=True, lossless=lossless, delta=True)
