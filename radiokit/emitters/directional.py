"""Directional light: parallel rays from infinitely far away, such as the sun's where its disk is ignored."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.spectral import amount
from radiokit.contracts.vectors import vector
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source

__all__ = ["Directional"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Directional(Emitter):
    """A light whose rays are parallel.

    Parameters
    ----------
    direction : tuple of 3 floats
        From the receiver towards the light; any length but 0, stored as a unit vector.
    irradiance : float, or sequence of K floats
        Irradiance E⊥ [W m⁻²] on a plane that faces the light, in [0, 1e100]; one number, or one a wavelength.

    Raises
    ------
    ParameterError
        When ``direction`` is zero or not three finite numbers, or the irradiance is out of its range.

    >>> light = Directional(direction=(0, 3, 4), irradiance=1000.0)
    >>> light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value
    800.0
    """

    name: ClassVar[str] = "directional"
    delta: ClassVar[bool] = True
    SOURCE: ClassVar[Source] = Source(
        authors="Lambert",
        year=1760,
        title="Photometria, sive de mensura et gradibus luminis, colorum et umbrae",
        equation="cosine law, E = E⊥ cosθ",
    )

    direction: tuple[float, float, float] = vector("direction", "1", "from the receiver towards the light")
    irradiance: Spectrum = parameter(
        "[0, 1e100]", "W/m^2", "irradiance on a plane that faces the light", spectral=True
    )

    def incident(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the light's direction (1, 3) and E⊥ [W m⁻²], (1,) or (1, K), the same everywhere."""
        return np.array([self.direction]), np.array([self.irradiance])

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return 0 sr: a single direction subtends no solid angle."""
        return rounding(0.0, ulps=0)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return E = E⊥ max(0, cosθ) [W m⁻²] on a receiver of any tilt.

        The rounding bound is that of the cosine, a few 1e-16 of E⊥.
        """
        full = amount(self.irradiance)
        value = full * max(0.0, float(np.dot(self.direction, normal)))
        return Estimate(value, 8 * float(np.finfo(float).eps) * full, "rounding", method="closed form")
