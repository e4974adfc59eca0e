"""Point light: equal intensity in all directions from one point. Use it where a source is far and small."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.parameters import parameter
from radiokit.contracts.vectors import vector
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source

__all__ = ["Point"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Point(Emitter):
    """An isotropic point light, Φ = 4πI, whose irradiance falls off as the inverse square.

    Parameters
    ----------
    position : tuple of 3 floats
        Where the light is [m].
    intensity : float
        Radiant intensity I [W sr⁻¹], at least 0.

    Raises
    ------
    ParameterError
        When ``position`` is not three finite numbers, or ``intensity`` is negative or infinite.

    >>> light = Point(position=(0, 0, 2), intensity=8.0)
    >>> light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value
    2.0
    """

    name: ClassVar[str] = "point"
    delta: ClassVar[bool] = True
    SOURCE: ClassVar[Source] = Source(
        authors="Lambert",
        year=1760,
        title="Photometria, sive de mensura et gradibus luminis, colorum et umbrae",
        equation="inverse-square and cosine laws, E = I cosθ / r²",
    )

    position: tuple[float, float, float] = vector("point", "m", "where the light is")
    intensity: float = parameter("[0, inf)", "W/sr", "radiant intensity, the same in all directions")

    def incident(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the direction (1, 3) of the light and E⊥ = I/r² (1,) [W m⁻²].

        Raises
        ------
        ParameterError
            When ``position`` is the light's own, or so near that I/r² overflows.
        """
        x, y, z = (p - float(q) for p, q in zip(self.position, position, strict=True))
        distance = math.hypot(x, y, z)
        allowed = f"away from the point light at {self.position}, where the irradiance is infinite"
        if distance == 0:
            raise ParameterError("position", tuple(map(float, position)), allowed)
        normal_irradiance = self.intensity / distance / distance
        if not math.isfinite(normal_irradiance):
            raise ParameterError("position", tuple(map(float, position)), allowed)
        direction = np.array([[x / distance, y / distance, z / distance]])
        return direction, np.array([normal_irradiance])

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return 0 sr: a point subtends no solid angle."""
        return rounding(0.0, ulps=0)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return E = I max(0, cosθ) / r² [W m⁻²] on a receiver of any tilt.

        The rounding bound is that of the cosine, a few 1e-16 of E⊥; the differences of coordinates are
        taken as given.
        """
        direction, normal_irradiance = self.incident(position)
        full = float(normal_irradiance[0])
        value = full * max(0.0, float(direction[0] @ normal))
        return Estimate(value, 8 * np.finfo(float).eps * full, "rounding", method="closed form")
