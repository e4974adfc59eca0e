"""Dielectric: a polished surface of glass or water, which reflects a part of the light and refracts the rest.

Use it for windows, lenses and coats, and as the limit of a rough dielectric, α → 0. Two delta lobes, for
light from either side; from the denser one, beyond the critical angle, everything is reflected. Lossless, and
reciprocal once the index is counted: radiance that passes is multiplied by n(wo)² / n(wi)² (by 2.25 out of
air into glass), so that f(wi, wo) = f(wo, wi) itself does not hold.

The weight of a delta lobe is the share of the flux, F or 1 − F. The weight of a sample is that of radiance:
it has the factor n(wo)² / n(wi)² too, 1/η² for a viewer above the surface and η² for one below.
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
from radiokit.physics.interface import refraction_kernel

__all__ = ["Dielectric"]

SOURCE = Source(
    authors="Pharr, Jakob, Humphreys",
    year=2023,
    title="Physically Based Rendering, 4th edition",
    equation="section 9.5.1, the smooth dielectric; 9.5.2, the factor of the squared indices; Fresnel's "
    "equations from Born & Wolf (1999), Principles of Optics, 7th edition, section 1.5.2, equation 21",
)


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    return 0.0 * abs(iz * oz) * eta


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    return 0.0 * abs(iz * oz)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    """Return the mirror direction with chance F and weight 1, else the refracted one with n(wo)² / n(wi)²."""
    tx, ty, tz, reflectance, _ = refraction_kernel(ox, oy, oz, eta)
    mirrored = u0 < reflectance
    brighter = select(oz < 0.0, eta * eta, 1.0 / (eta * eta))
    x, y, z = select(mirrored, -ox, tx), select(mirrored, -oy, ty), select(mirrored, oz, tz)
    return x, y, z, select(mirrored, 1.0, brighter)


@dataclass(frozen=True, kw_only=True)
class Dielectric(ScalarBSDF):
    """The polished interface between two transparent media.

    Parameters
    ----------
    eta : float
        η, the index below the surface over that above it [1], in [1e-3, 1e3]. A single number: the refracted
        direction depends on it.

    >>> import numpy as np
    >>> mirrored, refracted = Dielectric(eta=1.5).delta_lobes(np.array([[0.6, 0.0, 0.8]]))
    >>> refracted.wi.round(6).tolist(), (mirrored.weight + refracted.weight).round(12).tolist()
    ([[-0.4, -0.0, -0.916515]], [1.0])
    >>> wi, weight = Dielectric(eta=1.5).sample(np.array([[0.99, 0.0]]), np.array([[0.6, 0.0, 0.8]]))
    >>> float(weight[0]) == 1 / 1.5**2
    True
    """

    name = "dielectric"
    kind = "transmission"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"eta": 1 / 1.5}, {"eta": 1.0}, {"eta": 2.42})

    transmissive = True

    eta: float = parameter("[1e-3, 1e3]", "1", "index below the surface over that above it", default=1.5)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with Fresnel's amplitudes in the cosines and indices of both sides.

        The refracted part is T n(wo)² δ(n(wi) x_i + n(wo) x_o) δ(n(wi) y_i + n(wo) y_o): Snell's law is the
        delta, and dx dy = |cosθ| dω.
        """
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        eta = sympy.Symbol("eta", positive=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        delta = sympy.DiracDelta

        def reflectance(n_1: Any, c_1: Any, n_2: Any, c_2: Any) -> Any:
            r_s = (n_1 * c_1 - n_2 * c_2) / (n_1 * c_1 + n_2 * c_2)
            r_p = (n_2 * c_1 - n_1 * c_2) / (n_2 * c_1 + n_1 * c_2)
            return (sympy.Abs(r_s) ** 2 + sympy.Abs(r_p) ** 2) / 2

        def mirrored(n_1: Any, n_2: Any) -> Any:
            cosine = sympy.sqrt((1 + x_i * x_o + y_i * y_o + z_i * z_o) / 2)
            behind = sympy.sqrt(1 - n_1**2 / n_2**2 * (1 - cosine**2))  # imaginary in total reflection
            return reflectance(n_1, cosine, n_2, behind) * delta(x_i + x_o) * delta(y_i + y_o)

        def refracted(n_i: Any, n_o: Any) -> Any:
            snell = delta(n_i * x_i + n_o * x_o) * delta(n_i * y_i + n_o * y_o)
            return (1 - reflectance(n_i, sympy.Abs(z_i), n_o, sympy.Abs(z_o))) * n_o**2 * snell

        one = sympy.S.One
        whole = sympy.Piecewise(
            (mirrored(one, eta), (z_i > 0) & (z_o > 0)),
            (mirrored(eta, one), (z_i < 0) & (z_o < 0)),
            (refracted(eta, one), (z_i < 0) & (z_o > 0)),
            (refracted(one, eta), (z_i > 0) & (z_o < 0)),
            (0, True),
        )
        return Twin(whole, {eta: self.eta})

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

    def relative_index(self) -> float:
        """Return η."""
        return self.eta

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return two lobes for ``wo`` (N, 3): mirrored with weight F, refracted with weight 1 − F."""
        wo = np.asarray(wo, dtype=np.float64)
        *refracted, reflectance, rest = run(refraction_kernel, tuple(np.ascontiguousarray(wo.T)), (self.eta,))
        through = np.stack(refracted, axis=-1)
        return DeltaLobe(wo * [-1.0, -1.0, 1.0], reflectance), DeltaLobe(through, rest)

    @property
    def claims(self) -> Claims:
        """Lossless, nothing but deltas; reciprocal for η = 1, and else once the index is counted."""
        matched = self.eta == 1.0
        return Claims(
            reciprocity="yes" if matched else "eta-scaled", conserves=True, lossless=True, delta=True
        )
