"""Thin slab: a pane of glass with both its surfaces, thin enough that light passes straight through.

Use it for windows and bubbles modelled as one sheet. Light that has entered is reflected to and fro inside,
and the geometric series of what leaves on either side is summed: 2R/(1 + R) is reflected and (1 − R)/(1 + R)
goes on in its direction, with R the reflectance of one surface. Lossless and reciprocal: there is the same
medium on both sides.

R is the unpolarised reflectance, as in renderers. Light that has been reflected once is polarised, though,
and a pane reflects the mean of 2R/(1 + R) over its two polarisations: for η = 1.5 that is 0.1519 instead of
0.1638 at 60°, 0.351 instead of 0.373 at 73.8°, where they differ most, and the same at 0° and 90°.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims, DeltaLobe, FloatArray
from radiokit.contracts.parameters import parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.passes import run
from radiokit.measure.twin import Twin
from radiokit.physics import fresnel
from radiokit.physics.interface import refraction_kernel

__all__ = ["ThinSlab"]

SOURCE = Source(
    authors="Pharr, Jakob, Humphreys",
    year=2023,
    title="Physically Based Rendering, 4th edition",
    equation="section 9.5.3, the thin dielectric: R' = R + T²R/(1 − R²), T' = 1 − R'",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    return 0.0 * abs(iz * oz) * eta


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    return 0.0 * abs(iz * oz)


@kernel
def _shares(ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    """Return 2R/(1 + R) and (1 − R)/(1 + R), from R and from 1 − R, so that either keeps its digits."""
    _, _, _, once, rest = refraction_kernel(ox, oy, abs(oz), eta)
    return 2.0 * once / (1.0 + once), rest / (1.0 + once)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    """Return the mirror direction or the opposite one, each as often as its share, with weight 1."""
    mirrored, _ = _shares(ox, oy, oz, eta)
    return -ox, -oy, select(u0 < mirrored, oz, -oz), 1.0 + 0.0 * oz


@dataclass(frozen=True, kw_only=True)
class ThinSlab(ScalarBSDF):
    """A thin pane with all reflections between its two surfaces.

    Parameters
    ----------
    eta : float
        Index of the pane over that of the medium around it [1], in [1e-3, 1e3]. A single number: which way a
        sample goes depends on it.

    >>> import numpy as np
    >>> mirrored, straight = ThinSlab(eta=1.5).delta_lobes(np.array([[0.0, 0.0, 1.0]]))
    >>> round(float(mirrored.weight[0]), 12), straight.wi.tolist()  # 2 · 0.04 / 1.04
    (0.076923076923, [[-0.0, -0.0, -1.0]])
    """

    name = "thin_slab"
    kind = "transmission"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"eta": 1.0}, {"eta": 0.75})

    transmissive = True

    eta: float = parameter("[1e-3, 1e3]", "1", "index of the pane over that around it", default=1.5)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, R + T² R/(1 − R²), where T²/(1 − R²) = (1 − R)/(1 + R) for T = 1 − R."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        eta = sympy.Symbol("eta", positive=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        delta = sympy.DiracDelta(x_i + x_o) * sympy.DiracDelta(y_i + y_o)
        # Under the deltas |z_i| = |z_o|: half the angle between one direction and the other's mirror image.
        cosine = sympy.sqrt((1 + x_i * x_o + y_i * y_o + sympy.Abs(z_i * z_o)) / 2)
        once = fresnel.conductor_symbolic(cosine, eta, sympy.S.Zero)
        mirrored = once + (1 - once) * once / (1 + once)
        share = sympy.Piecewise((mirrored, z_i * z_o > 0), (1 - mirrored, True))
        return Twin(share * delta, {eta: self.eta})

    def kernels(self) -> Kernels:
        """Return the kernels: 0 beside the delta lobes, and samples that are in one of them."""
        return Kernels(_value, _density, _sample, (self.eta,))

    @property
    def smooth(self) -> bool:
        """True: beside the delta lobes there is nothing."""
        return True

    def lobe_width(self) -> float:
        """Return 1: beside the delta lobes there is nothing that needs nodes."""
        return 1.0

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return two lobes for ``wo`` (N, 3): the mirror direction and −wo, with their shares of the flux."""
        wo = np.asarray(wo, dtype=np.float64)
        mirrored, straight = run(_shares, tuple(np.ascontiguousarray(wo.T)), (self.eta,))
        return DeltaLobe(wo * [-1.0, -1.0, 1.0], mirrored), DeltaLobe(-wo, straight)

    @property
    def claims(self) -> Claims:
        """Reciprocal, conserving, lossless, nothing but deltas."""
        return Claims(reciprocity="yes", conserves=True, lossless=True, delta=True)
