"""Lamps: what the point lights in a room send to many points of its wall at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from radiokit.contracts.pointlight import PointLight
from radiokit.emitters.point import Point
from radiokit.facts.directions import dot

__all__ = ["arriving"]

FloatArray = npt.NDArray[np.float64]


def arriving(lights: Sequence[PointLight], position: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the directions (L, N, 3) of the lights from points (N, 3), and E⊥ (L, N) [W m⁻²] of each.

    Rooms are convex: nothing is in the way.
    """
    directions = np.empty((len(lights), *position.shape))
    strength = np.empty((len(lights), len(position)))
    for index, light in enumerate(lights):
        if isinstance(light, Point):
            way = np.array(light.position) - position
            square = dot(way, way)
            directions[index] = way / np.sqrt(square)[:, None]
            strength[index] = light.intensity / square
        else:
            for row, point in enumerate(position):
                found, normal_irradiance = light.incident(point)
                directions[index, row], strength[index, row] = found[0], normal_irradiance[0]
    return directions, strength
