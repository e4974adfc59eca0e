"""Conductor: a polished metal, a mirror that reflects what Fresnel's equations leave of the light.

Use it for smooth metal and as the limit of a rough one, α → 0. A delta lobe and nothing else: ``evaluate``
and ``pdf`` are 0 for every pair of directions, the mirror pair included. It breaks no law; what it does not
reflect it absorbs, 4η / ((η + 1)² + k²) at normal incidence, so it is lossless for no index. With k = 0 it is
the outside of a dielectric whose inside is black.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims, DeltaLobe, FloatArray
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.physics import fresnel
from radiokit.physics.fresnel import conductor_kernel

__all__ = ["Conductor"]

SOURCE = fresnel.CONDUCTOR_SOURCE


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any, k: Any) -> Any:
    return 0.0 * abs(iz * oz) * eta * k


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any, k: Any) -> Any:
    return 0.0 * abs(iz * oz)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, eta: Any, k: Any) -> Any:
    cosine = select(oz > 0.0, select(oz < 1.0, oz, 1.0), 0.0)
    return -ox, -oy, oz, select(oz > 0.0, conductor_kernel(cosine, eta, k), 0.0)


@dataclass(frozen=True, kw_only=True)
class Conductor(ScalarBSDF):
    """The polished metal, f = F(θ) δ(wi − mirrored wo) / cosθ.

    Parameters
    ----------
    eta : float or sequence of float
        Real part of the relative index η + ik [1], above 0. The defaults are silver's at 549 nm.
    k : float or sequence of float
        Extinction [1], at least 0.

    >>> import numpy as np
    >>> (lobe,) = Conductor(eta=0.2, k=3.0).delta_lobes(np.array([[0.0, 0.0, 1.0]]))
    >>> lobe.weight.round(12).tolist()
    [0.92337164751]
    """

    name = "conductor"
    kind = "delta"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"eta": 1.0728, "k": 6.7839}, {"eta": 1.5, "k": 0.0})

    eta: Spectrum = parameter("(0, inf)", "1", "real part of the relative index", spectral=True, default=0.06)
    k: Spectrum = parameter("[0, inf)", "1", "extinction", spectral=True, default=3.586)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, F δ(x_i + x_o) δ(y_i + y_o), in which dx dy = cosθ dω.

        F is written for half the angle between the directions, which under the deltas is θ: so the twin is
        the same both ways as it stands.
        """
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        eta, k = sympy.symbols("eta k", positive=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        cosine = sympy.sqrt((1 + x_i * x_o + y_i * y_o + z_i * z_o) / 2)
        delta = sympy.DiracDelta(x_i + x_o) * sympy.DiracDelta(y_i + y_o)
        return Twin(fresnel.conductor_symbolic(cosine, eta, k) * delta, {eta: self.eta, k: self.k})

    def kernels(self) -> Kernels:
        """Return the kernels: 0 beside the delta lobe, and samples that are the mirror direction."""
        return Kernels(_value, _density, _sample, fresnel.clip_index(self.eta, self.k))

    @property
    def smooth(self) -> bool:
        """True: beside the delta lobe there is nothing."""
        return True

    def lobe_width(self) -> float:
        """Return 1: beside the delta lobe there is nothing that needs nodes."""
        return 1.0

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return the one lobe: the mirror direction of ``wo`` (N, 3), with weight F."""
        return (DeltaLobe(*self.sample(np.zeros((len(wo), 2)), wo)),)

    @property
    def claims(self) -> Claims:
        """Reciprocal, conserving, nothing but a delta; never lossless."""
        return Claims(reciprocity="yes", conserves=True, delta=True)
