"""Constant environment: the same radiance from everywhere, or from one half-space, the overcast sky."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.spectral import amount, weighted
from radiokit.contracts.vectors import vector
from radiokit.facts.directions import frame, to_world
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source
from radiokit.measure.exact import rational
from radiokit.measure.warps import UniformHemisphere, UniformSphere
from radiokit.physics.eclipse import Dome

__all__ = ["Constant"]

FloatArray = npt.NDArray[np.float64]

_SPHERE, _HEMISPHERE = UniformSphere(), UniformHemisphere()


@dataclass(frozen=True, kw_only=True)
class Constant(Emitter):
    """An environment of constant radiance, infinitely far away: the white furnace, or a uniform sky.

    Parameters
    ----------
    radiance : float, or sequence of K floats
        Radiance L [W m⁻² sr⁻¹], in [0, 1e100]; one number, or one a wavelength.
    normal : tuple of 3 floats, optional
        The zenith of a sky that shines from the half-space around it only; any length but 0, stored as a unit
        vector. Without it the environment is the whole sphere.

    Raises
    ------
    ParameterError
        When ``normal`` is zero or not three finite numbers, or ``radiance`` is out of its range.

    >>> sky = Constant(radiance=1.0, normal=(0, 0, 1))
    >>> wall = np.array([1.0, 0.0, 0.0])  # tilted by 90°: it sees half the sky
    >>> round(float(sky.irradiance_at(np.zeros(3), wall).value) / np.pi, 15)
    0.5
    """

    name: ClassVar[str] = "constant"
    SOURCE: ClassVar[Source] = Source(
        authors="Liu, Jordan",
        year=1963,
        title="The long-term average performance of flat-plate solar-energy collectors",
        doi="10.1016/0038-092X(63)90006-9",
        equation="the sky's share on a tilted plane, (1 + cosβ)/2",
    )

    radiance: Spectrum = parameter(
        "[0, 1e100]", "W/m^2/sr", "radiance, the same from everywhere", spectral=True, default=1.0
    )
    normal: tuple[float, float, float] | None = vector(
        "direction", "1", "zenith of a sky that fills a half-space", default=None
    )

    def dome(self, position: FloatArray) -> tuple[FloatArray, ...]:
        """Return the half-space that the sky fills, or nothing for the whole sphere."""
        return () if self.normal is None else (np.array(self.normal),)

    def silhouette(self, position: FloatArray) -> Silhouette:
        """Return the half-space that the sky fills, or the whole sphere, evenly bright."""
        return Silhouette(Dome(() if self.normal is None else (rational(self.normal),)), self.radiance)

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L for directions (N, 3) in the sky, 0 for those below its horizon."""
        if self.normal is None:
            return weighted(np.ones(len(direction)), self.radiance)
        return weighted(direction @ np.array(self.normal) > 0, self.radiance)

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3), uniform over the sky, and densities [sr⁻¹]."""
        density = np.full(len(u), self._density)
        if self.normal is None:
            return _SPHERE.sample(u), density
        return to_world(frame(self.normal), _HEMISPHERE.sample(u)), density

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return 1/4π, or 1/2π in the half-space of a sky and 0 outside [sr⁻¹]."""
        if self.normal is None:
            return np.full(len(direction), self._density)
        return np.where(direction @ np.array(self.normal) > 0, self._density, 0.0)

    @property
    def _density(self) -> float:
        return 1 / (4 * math.pi) if self.normal is None else 1 / (2 * math.pi)

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return 4π sr, or 2π sr for a sky."""
        return rounding(4 * math.pi if self.normal is None else 2 * math.pi, ulps=1)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return πL, or πL (1 + cosβ)/2 for a sky whose zenith is β away from the receiver's normal.

        (1 + cosβ)/2 = cos²(β/2) = |n + s|²/4, which keeps its digits for a receiver that all but faces away.
        """
        full = math.pi * amount(self.radiance)
        if self.normal is None:
            return rounding(full)
        half = math.hypot(*(np.array(self.normal) + normal)) / 2  # cos(β/2)
        eps = float(np.finfo(float).eps)
        value = full * half * half
        return Estimate(value, 4 * eps * (value + full * half), "rounding", method="closed form")
