"""Lommel-Seeliger: light that was scattered once by the particles of a deep, dark layer.

The photometry of the Moon and the asteroids: a full disk as bright at its edge as in the middle. The layer is
half-infinite, its particles scatter evenly, and what is scattered twice is left out, so that the albedo never
exceeds half that of a particle (w/2, approached as θ → 90°; 0.153 w at normal incidence).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.source import Source
from radiokit.measure.elementary import sincos
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin

__all__ = ["LommelSeeliger"]

SOURCE = Source(
    authors="Hapke",
    year=1981,
    title="Bidirectional Reflectance Spectroscopy: 1. Theory. Journal of Geophysical Research 86(B4)",
    doi="10.1029/JB086iB04p03039",
    equation="the single scattering term for isotropic particles without opposition effect, divided by "
    "cosθi; the law of Lommel (1887) and Seeliger (1888)",
)

_HORIZON = 1e-150  # a cosine below this is 0: f grows without bound as both cosines vanish
_STEEP = 4.0  # how fast the sampler's density turns from even to linear in the cosine


@kernel
def _even(oz: Any) -> Any:
    """Return the share of the sampler's density that is even; the rest is proportional to cosθi."""
    return 1.0 / (1.0 + _STEEP * abs(oz))


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, albedo: Any) -> Any:
    above = (iz > _HORIZON) & (oz > _HORIZON)
    return select(above, albedo / (4.0 * np.pi * select(above, iz + oz, 1.0)), 0.0)


@kernel
def _density(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, albedo: Any) -> Any:
    even = _even(oz)
    return select((iz > _HORIZON) & (oz > _HORIZON), (even + 2.0 * (1.0 - even) * iz) / (2.0 * np.pi), 0.0)


@kernel
def _sample(u0: Any, u1: Any, ox: Any, oy: Any, oz: Any, albedo: Any) -> Any:
    """Return wi, whose cosine z solves e z + (1 − e) z² = u, and a weight of at most w/2.

    The bound is 8z² − 4z + 1 > 0.
    """
    even = _even(oz)
    z = 2.0 * u0 / (even + np.sqrt(even * even + 4.0 * (1.0 - even) * u0))
    z = select(z < 1.0, z, 1.0)
    radius = np.sqrt((1.0 - z) * (1.0 + z))
    sine, cosine = sincos(u1)
    above = (z > _HORIZON) & (oz > _HORIZON)
    share = z / select(above, (z + oz) * (even + 2.0 * (1.0 - even) * z), 1.0)
    return radius * cosine, radius * sine, z, select(above, 0.5 * albedo * share, 0.0)


@dataclass(frozen=True, kw_only=True)
class LommelSeeliger(ScalarBSDF):
    """The Lommel-Seeliger law, f = w/(4π) / (cosθi + cosθo).

    Parameters
    ----------
    albedo : float or sequence of float
        w, the single scattering albedo of a particle [1], in [0, 1].

    Raises
    ------
    ParameterError
        When ``albedo`` is out of its range.

    >>> import numpy as np
    >>> LommelSeeliger(albedo=0.8)([0, 0, 1], [0, 0, 1]) == 0.1 / np.pi
    np.True_
    """

    name = "lommel_seeliger"
    kind = "diffuse"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"albedo": 0.1}, {"albedo": 0.0})

    albedo: Spectrum = parameter("[0, 1]", "1", "single scattering albedo", spectral=True, default=1.0)

    def symbolic(self) -> Twin:
        """Return the symbolic twin, with the cosines of the polar angles."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        w = sympy.Symbol("w", nonnegative=True)
        x_i, y_i, z_i, x_o, y_o, z_o = DIRECTION_SYMBOLS
        mu_i, mu_o = z_i / sympy.sqrt(x_i**2 + y_i**2 + z_i**2), z_o / sympy.sqrt(x_o**2 + y_o**2 + z_o**2)
        return Twin(w / (4 * sympy.pi) / (mu_i + mu_o), {w: self.albedo})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.albedo,))

    @property
    def smooth(self) -> bool:
        """True."""
        return True

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving: the albedo w/2 (1 − μ ln((1 + μ)/μ)) falls with μ, from w/2."""
        return Claims(reciprocity="yes", conserves=True)
