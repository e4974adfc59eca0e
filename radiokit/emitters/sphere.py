"""Sphere: a ball that shines alike everywhere and in all directions, seen as a circular cone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import parameter
from radiokit.contracts.vectors import vector
from radiokit.facts.directions import frame, to_world
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.warps import UniformCone
from radiokit.physics.ball import Ball
from radiokit.physics.cap import CAP_SOURCE

__all__ = ["Sphere"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Sphere(Emitter):
    """A sphere of uniform radiance: a globe lamp, or the sun as the disk that it appears to be.

    Parameters
    ----------
    center : tuple of 3 floats
        [m].
    radius : float
        [m], above 0.
    radiance : float
        Radiance L [W m⁻² sr⁻¹], at least 0.

    Raises
    ------
    ParameterError
        When ``center`` is not three finite numbers, or another parameter is out of its range; from the
        methods, when the receiver is inside the sphere or on it.

    >>> lamp = Sphere(center=(0, 0, 4), radius=1, radiance=1.0)
    >>> up = np.array([0.0, 0.0, 1.0])
    >>> round(float(lamp.irradiance_at(np.zeros(3), up).value) / np.pi, 15)  # (R/d)²
    0.0625
    """

    name: ClassVar[str] = "sphere"
    SOURCE: ClassVar[Source] = CAP_SOURCE

    center: tuple[float, float, float] = vector("point", "m", "the sphere's centre")
    radius: float = parameter("(0, inf)", "m", "the sphere's radius")
    radiance: float = parameter("[0, inf)", "W/m^2/sr", "radiance, the same everywhere and in all directions")

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L for directions (N, 3) that meet the sphere, 0 for the others."""
        return np.where(self._view(position).near(direction), self.radiance, 0.0)

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3), uniform in the cone, and densities [sr⁻¹].

        Source: Shirley, Wang, Zimmerman (1996), Monte Carlo techniques for direct lighting calculations,
        doi:10.1145/226150.226151, section 3.
        """
        view = self._view(position)
        cone = UniformCone(half_angle=math.atan2(view.sine, view.cosine))
        return to_world(frame(view.axis), cone.sample(u)), np.full(len(u), 1.0 / _cone(view))

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return 1/Ω in the cone and 0 outside [sr⁻¹]."""
        view = self._view(position)
        return np.where(view.near(direction), 1.0 / _cone(view), 0.0)

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return Ω = 4π sin²(σ/2) [sr], with sinσ = R/d: 2π for a sphere touched."""
        return self._view(position).solid_angle()

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return E [W m⁻²] on a receiver of any tilt: πL (R/d)² cosθ, less what the horizon hides.

        Whether the horizon cuts the sphere, and by how much, is decided in rational arithmetic, so that the
        relative error is that of a few operations for every sphere and every tilt.
        """
        value = self.radiance * self._view(position).irradiance(normal).value
        return Estimate(value, 48 * _EPS * value, "rounding", method="closed form")

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the sphere is along directions (N, 3) that meet it."""
        return self._view(position).distance(direction)

    def silhouette(self, position: FloatArray) -> Silhouette:
        """Return the ball, evenly bright."""
        return Silhouette(self._view(position), self.radiance)

    def flux(self) -> Estimate:
        """Return the radiant flux Φ = πL · 4πR² [W].

        >>> round(float(Sphere(center=(0, 0, 4), radius=2, radiance=1.0).flux().value) / np.pi**2, 12)
        16.0
        """
        value = 4.0 * math.pi**2 * self.radius * self.radius * self.radiance
        return Estimate(value, 4 * _EPS * value, "rounding", method="closed form")

    def _view(self, position: FloatArray) -> Ball:
        ball = Ball.seen(self.center, self.radius, position)
        if ball.tangent <= 0:
            allowed = f"outside the sphere of radius {self.radius!r} around {self.center}"
            raise ParameterError("position", tuple(map(float, position)), allowed)
        if ball.sine < 1e-100:
            allowed = "nearer to the sphere, which is a point light at more than 1e100 radii"
            raise ParameterError("position", tuple(map(float, position)), allowed)
        return ball


def _cone(ball: Ball) -> float:
    """Return 2π (1 − cosσ)."""
    return float(ball.solid_angle().value)
