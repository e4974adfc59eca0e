"""Point light: equal intensity in all directions from one point. Use it where a source is far and small."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.pointlight import PointLight
from radiokit.contracts.spectral import amount
from radiokit.contracts.vectors import vector
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source

__all__ = ["Point"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Point(PointLight):
    """An isotropic point light, Φ = 4πI, whose irradiance falls off as the inverse square.

    Parameters
    ----------
    position : tuple of 3 floats
        Where the light is [m].
    intensity : float, or sequence of K floats
        Radiant intensity I [W sr⁻¹], in [0, 1e100]; one number, or one a wavelength.

    Raises
    ------
    ParameterError
        When ``position`` is not three finite numbers, or ``intensity`` is out of its range.

    >>> light = Point(position=(0, 0, 2), intensity=8.0)
    >>> light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value
    2.0
    """

    name: ClassVar[str] = "point"
    SOURCE: ClassVar[Source] = Source(
        authors="Lambert",
        year=1760,
        title="Photometria, sive de mensura et gradibus luminis, colorum et umbrae",
        equation="inverse-square and cosine laws, E = I cosθ / r²",
    )

    position: tuple[float, float, float] = vector("point", "m", "where the light is")
    intensity: Spectrum = parameter(
        "[0, 1e100]", "W/sr", "radiant intensity, the same in all directions", spectral=True
    )

    def intensity_along(self, direction: FloatArray) -> tuple[Any, float]:
        """Return I [W sr⁻¹], which is exact."""
        return amount(self.intensity), 0.0

    def flux(self) -> Estimate:
        """Return Φ = 4πI [W]."""
        return rounding(4 * math.pi * amount(self.intensity))
