"""Point lights: what sources of no extent share; each says how its intensity depends on direction."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.vectors import Triple
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate, rounding

__all__ = ["PointLight"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


class PointLight(Emitter):
    """A light at one point: a subclass has a ``position``, and gives the intensity in each direction."""

    delta: ClassVar[bool] = True
    position: Triple

    @abstractmethod
    def intensity_along(self, direction: FloatArray) -> tuple[Any, Any]:
        """Return I [W sr⁻¹] along a unit vector (3,) away from the light, and a bound of its rounding.

        Both are floats, or arrays (K,) for K wavelengths.

        The bound allows for a direction that is off by a few units in the last place of 1.
        """

    def _arriving(self, position: FloatArray) -> tuple[FloatArray, Any, Any]:
        """Return the direction (3,) to the light, E⊥ = I/r² [W m⁻²] and the bound of I over r²."""
        x, y, z = (p - float(q) for p, q in zip(self.position, position, strict=True))
        distance = math.hypot(x, y, z)
        allowed = f"away from the {self.name} light at {self.position}, where the irradiance is infinite"
        if distance == 0:
            raise ParameterError("position", tuple(map(float, position)), allowed)
        direction = np.array([x / distance, y / distance, z / distance])
        intensity, error = self.intensity_along(-direction)
        with np.errstate(over="ignore"):
            normal_irradiance = intensity / distance / distance
        if not np.all(np.isfinite(normal_irradiance)):
            raise ParameterError("position", tuple(map(float, position)), allowed)
        return direction, normal_irradiance, error / distance / distance

    def incident(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the direction (1, 3) of the light and E⊥ = I/r² [W m⁻²], (1,) or (1, K).

        Raises
        ------
        ParameterError
            When ``position`` is the light's own, or so near that I/r² overflows.
        """
        direction, normal_irradiance, _ = self._arriving(position)
        return direction[None, :], np.array([normal_irradiance])

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light is, whatever the direction (N, 3)."""
        distance = math.hypot(*(p - float(q) for p, q in zip(self.position, position, strict=True)))
        return np.full(len(direction), distance)

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return 0 sr: a point subtends no solid angle."""
        return rounding(0.0, ulps=0)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return E = I max(0, cosθ) / r² [W m⁻²] on a receiver of any tilt.

        The rounding bound is that of the cosine, a few 1e-16 of E⊥, and of the intensity; the differences
        of coordinates are taken as given.
        """
        direction, full, error = self._arriving(position)
        cosine = max(0.0, float(direction @ normal))
        bound = 8 * _EPS * full + error * cosine
        return Estimate(full * cosine, bound, "rounding", method="closed form")
