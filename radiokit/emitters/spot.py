"""Spot light: a point that shines into a cone, with a soft rim. Use it for a lamp with a reflector."""

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
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source

__all__ = ["Spot"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Spot(PointLight):
    """A point light of intensity I within the angle ``inner`` of its axis and 0 beyond ``outer``.

    Between them I falls as the cubic t²(3 − 2t) of t = (cosθ − cos outer)/(cos inner − cos outer). With
    equal angles the rim is sharp and belongs to the cone.

    Parameters
    ----------
    position : tuple of 3 floats
        Where the light is [m].
    direction : tuple of 3 floats
        Along the axis, away from the light; any length but 0, stored as a unit vector.
    intensity : float, or sequence of K floats
        Radiant intensity I [W sr⁻¹] on the axis, in [0, 1e100]; one number, or one a wavelength.
    outer : float
        Half-angle [rad] of the cone, in (0, π].
    inner : float, optional
        Half-angle [rad] within which the intensity is constant, in [0, ``outer``]; 0 by default.

    Raises
    ------
    ParameterError
        When a parameter is out of its range, ``inner`` exceeds ``outer``, or ``direction`` is zero.

    >>> light = Spot(position=(0, 0, 2), direction=(0, 0, -1), intensity=8.0, inner=0.2, outer=0.4)
    >>> light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value
    2.0
    >>> light.irradiance_at(np.array([2.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])).value
    0.0
    """

    name: ClassVar[str] = "spot"
    SOURCE: ClassVar[Source] = Source(
        authors="Pharr, Jakob, Humphreys",
        year=2023,
        title="Physically Based Rendering, 4th edition",
        equation="section 12.2.1, the smoothstep in cosθ and the flux of the cone",
    )

    position: tuple[float, float, float] = vector("point", "m", "where the light is")
    direction: tuple[float, float, float] = vector("direction", "1", "the axis, away from the light")
    intensity: Spectrum = parameter("[0, 1e100]", "W/sr", "radiant intensity on the axis", spectral=True)
    outer: float = parameter("(0, 3.141592653589793]", "rad", "half-angle beyond which it is dark")
    inner: float = parameter("[0, 3.141592653589793]", "rad", "half-angle of constant intensity", default=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.inner > self.outer:
            raise ParameterError("inner", self.inner, f"at most outer, {self.outer!r}")

    def intensity_along(self, direction: FloatArray) -> tuple[Any, Any]:
        """Return I [W sr⁻¹] along a unit vector away from the light, and a bound of its rounding.

        By haversines, h(θ) = sin²(θ/2) = (1 − cosθ)/2 = |w − axis|²/4, since differences of cosines lose all
        digits in a narrow cone: t = (h(outer) − h(θ)) / (h(outer) − h(inner)).
        """
        half = math.hypot(*(direction - np.array(self.direction))) / 2
        rim = math.sin(self.outer / 2)
        band = math.sin((self.outer + self.inner) / 2) * math.sin((self.outer - self.inner) / 2)
        room = (rim - half) * (rim + half)
        slack = 4 * _EPS * (rim + half)  # half and rim are off by some eps, and so is their product's root
        if band <= 0:
            shape, error = float(room >= 0), float(abs(room) <= slack)
        else:
            t = min(1.0, max(0.0, room / band))
            # The cubic's slope 6t(1 − t) may rise by 6 for each unit that t is off.
            off = slack / band + 4 * _EPS * t
            shape, error = t * t * (3 - 2 * t), min(1.0, 6 * off * (t * (1 - t) + off) + 4 * _EPS)
            if room <= -slack or room >= band * (1 + 4 * _EPS) + slack:
                error = 0.0
        intensity = amount(self.intensity)
        return intensity * shape, intensity * error

    def flux(self) -> Estimate:
        """Return Φ = 2πI (1 − (cos inner + cos outer)/2) [W], by the squares of half-angles' sines."""
        share = math.sin(self.inner / 2) ** 2 + math.sin(self.outer / 2) ** 2
        return rounding(2 * math.pi * amount(self.intensity) * share, ulps=8)
