"""Lambert transmitter: a thin sheet that scatters a share of the light evenly above it, and another below.

Leaves, paper, lampshades. It looks the same from both sides and has no thickness, so that no index enters.
The simplest surface through which light passes, and the exact answer for judges of those.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import Claims
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.measure.twin import Twin
from radiokit.measure.vectors import from_disk

__all__ = ["LambertTransmitter"]

SOURCE = Source(
    authors="Bartell, Dereniak, Wolfe",
    year=1981,
    title="The Theory and Measurement of Bidirectional Reflectance Distribution Function (BRDF) and "
    "Bidirectional Transmittance Distribution Function (BTDF). Proc. SPIE 257",
    doi="10.1117/12.959611",
    equation="the Lambertian reflector and transmitter, ρ/π and τ/π",
)

_ROUNDING = 4 * float(np.finfo(float).eps)  # by which two shares that make a whole may exceed it


@kernel
def _value(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, reflectance: Any, transmittance: Any) -> Any:
    same = (iz > 0.0) == (oz > 0.0)
    return select((iz != 0.0) & (oz != 0.0), select(same, reflectance, transmittance) / np.pi, 0.0)


@kernel
def _density(
    ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, reflectance: Any, transmittance: Any
) -> Any:
    return select(oz != 0.0, 0.5 * abs(iz) / np.pi, 0.0)


@kernel
def _sample(
    u0: Any, u1: Any, u2: Any, ox: Any, oy: Any, oz: Any, reflectance: Any, transmittance: Any
) -> Any:
    """Return wi on either side with probability 1/2, whatever the wavelength, and 2ρ or 2τ."""
    x, y, z = from_disk(u0, u1)
    above = u2 < 0.5
    weight = 2.0 * select(above == (oz > 0.0), reflectance, transmittance)
    return x, y, select(above, z, -z), select((z > 0.0) & (oz != 0.0), weight, 0.0)


@dataclass(frozen=True, kw_only=True)
class LambertTransmitter(ScalarBSDF):
    """The diffuse sheet: f = ρ/π for two directions on one side, τ/π for two on opposite sides.

    Parameters
    ----------
    reflectance : float or sequence of float
        ρ, the share of the flux that is scattered back [1], in [0, 1].
    transmittance : float or sequence of float
        τ, the share of the flux that passes [1], in [0, 1]; ρ + τ ≤ 1.

    Raises
    ------
    ParameterError
        When a parameter is out of its range, or ρ + τ is above 1.

    >>> import numpy as np
    >>> f = LambertTransmitter(reflectance=0.2, transmittance=0.7)
    >>> f([0, 0, 1], [0.6, 0, 0.8]) == 0.2 / np.pi, f([0, 0, -1], [0.6, 0, 0.8]) == 0.7 / np.pi
    (np.True_, np.True_)
    """

    name = "lambert_transmitter"
    kind = "transmission"
    SOURCE = SOURCE
    EXAMPLES = ({}, {"reflectance": 0.2, "transmittance": 0.7}, {"reflectance": 0.0, "transmittance": 1.0})
    transmissive: ClassVar[bool] = True
    dimensions: ClassVar[int] = 3

    reflectance: Spectrum = parameter("[0, 1]", "1", "share scattered back", spectral=True, default=0.5)
    transmittance: Spectrum = parameter("[0, 1]", "1", "share that passes", spectral=True, default=0.5)

    def __post_init__(self) -> None:
        super().__post_init__()
        if np.any(np.add(self.reflectance, self.transmittance) > 1.0 + _ROUNDING):
            raise ParameterError(
                "transmittance",
                self.transmittance,
                f"at most 1 - reflectance, and reflectance = {self.reflectance!r}",
            )

    def symbolic(self) -> Twin:
        """Return the symbolic twin, ρ/π or τ/π."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        rho, tau = sympy.symbols("rho tau", nonnegative=True)
        opposite = DIRECTION_SYMBOLS[2] * DIRECTION_SYMBOLS[5] < 0
        value = sympy.Piecewise((tau / sympy.pi, opposite), (rho / sympy.pi, True))
        return Twin(value, {rho: self.reflectance, tau: self.transmittance})

    def kernels(self) -> Kernels:
        """Return the kernels."""
        return Kernels(_value, _density, _sample, (self.reflectance, self.transmittance))

    @property
    def smooth(self) -> bool:
        """True, on either side."""
        return True

    def lobe_width(self) -> float:
        """Return 1, the width of a diffuse lobe."""
        return 1.0

    def diffuse_sides(self) -> tuple[Any, Any]:
        """Return ρ and τ, each of shape () or (K,)."""
        both = (self.reflectance, self.transmittance)
        rho, tau = (np.asarray(each) if isinstance(each, tuple) else each for each in both)
        return rho, tau

    @property
    def claims(self) -> Claims:
        """Reciprocal and conserving; lossless when ρ + τ = 1."""
        whole = np.add(self.reflectance, self.transmittance) >= 1.0 - _ROUNDING
        return Claims(reciprocity="yes", conserves=True, lossless=bool(np.all(whole)))
