"""Lamps: what point lights in a room and luminous panels in its walls send to many points at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from radiokit.contracts.pointlight import PointLight
from radiokit.contracts.spectral import amount
from radiokit.emitters.point import Point
from radiokit.emitters.rectangle import Rectangle
from radiokit.facts.directions import dot

__all__ = ["Lamp", "arriving", "shown"]

FloatArray = npt.NDArray[np.float64]

Lamp = PointLight | Rectangle


def arriving(
    lights: Sequence[Lamp], position: FloatArray, generator: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Return directions (L, N, 3) to the lamps from points (N, 3), and E⊥ of each, (L, N, K) [W m⁻²].

    K is 1 for lamps without wavelengths.

    A panel is seen at one point of it, evenly chosen, with E⊥ = L A cosθ'/d²: right on average. Rooms are
    convex: nothing is in the way.
    """
    directions = np.empty((len(lights), *position.shape))
    strength = np.empty((len(lights), len(position), _wavelengths(lights)))
    for index, light in enumerate(lights):
        if isinstance(light, Point):
            directions[index], square = _towards(np.array(light.position) - position)
            strength[index] = amount(light.intensity) / square[:, None]
        elif isinstance(light, Rectangle):
            first, right, _, up = light.corners
            u = generator.random((len(position), 2))
            point = first + u[:, :1] * (right - first) + u[:, 1:] * (up - first)
            directions[index], square = _towards(point - position)
            facing = np.maximum(-(directions[index] @ np.array(light.normal)), 0.0)
            strength[index] = amount(light.radiance) * (light.area * facing / square)[:, None]
        else:
            for row, place in enumerate(position):
                found, normal_irradiance = light.incident(place)
                directions[index, row], strength[index, row] = found[0], normal_irradiance[0]
    return directions, strength


def shown(lights: Sequence[Lamp], position: FloatArray) -> FloatArray:
    """Return the radiance (N, K) of the panels themselves at points (N, 3) of the walls."""
    total = np.zeros((len(position), _wavelengths(lights)))
    for light in lights:
        if isinstance(light, Rectangle):
            first, right, _, up = light.corners
            across, along, off = right - first, up - first, position - first
            x, y = dot(off, across) / dot(across, across), dot(off, along) / dot(along, along)
            level = np.abs(off @ np.array(light.normal)) <= 1e-9 * max(light.width, light.height)
            inside = level & (x >= 0) & (x <= 1) & (y >= 0) & (y <= 1)
            total[inside] += amount(light.radiance)
    return total


def _wavelengths(lights: Sequence[Lamp]) -> int:
    return max((light.wavelengths or 1 for light in lights), default=1)


def _towards(way: FloatArray) -> tuple[FloatArray, FloatArray]:
    square = np.asarray(dot(way, way))
    apart = square > 0  # a point of a panel that is chosen where it is seen from sends it nothing
    unit = way / np.sqrt(np.where(apart, square, 1.0))[:, None]
    return unit, np.where(apart, square, np.inf)
