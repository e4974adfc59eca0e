"""Rooms: what a wall is made of, and what a closed room must tell of its walls to a random walk."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.combining import spectrum, wavelengths
from radiokit.contracts.parameters import Spectrum
from radiokit.emitters.rectangle import Rectangle
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import ParameterError
from radiokit.measure.lattice import kronecker
from radiokit.worlds.enclosure.lamps import Lamp

__all__ = ["ON_WALL", "FloatArray", "IndexArray", "Room", "Triple", "Wall", "check_wall"]

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.intp]
Triple = tuple[float, float, float]

ON_WALL = 1e-9  # of the room's size: how far off the wall a point may be that is meant to be on it

_PROBE = spherical_to_cartesian([0.1, 0.7, 1.2, 1.5], [0.0, 2.0, 4.0, 5.0])


@dataclass(frozen=True, kw_only=True)
class Wall:
    """What a wall is made of, and what it emits; without both it is a hole, from which nothing returns.

    Parameters
    ----------
    f : BSDF or callable, optional
        f(wi, wo) [sr⁻¹]; black without it. Light does not pass through a wall.
    emitted : float or sequence of float
        Radiance [W m⁻² sr⁻¹] that the wall itself sends in every direction, at least 0; a sequence has one
        number a wavelength.

    Raises
    ------
    ParameterError
        When ``f`` is no BSDF or transmits, or ``emitted`` is not allowed.
    """

    f: Any = None
    emitted: Spectrum = 0.0

    def __post_init__(self) -> None:
        if self.f is not None:
            object.__setattr__(self, "f", as_bsdf(self.f))
            if self.f.transmissive:
                raise ParameterError("f", self.f, "a surface that no light passes")
        object.__setattr__(self, "emitted", spectrum("emitted", self.emitted))

    @property
    def absorbs_nothing(self) -> bool:
        """Whether every sample of every probed direction keeps all of its weight."""
        if self.black:
            return False
        u = kronecker(64, self.f.dimensions)
        for wo in _PROBE:
            _, weight = self.f.sample(u, np.broadcast_to(wo, (len(u), 3)))
            if np.any(np.mean(weight, axis=0) < 1 - 1e-12):
                return False
        return True

    @property
    def black(self) -> bool:
        """Whether the wall is known to reflect nothing."""
        return self.f is None or bool(np.all(self.f.diffuse_reflectance() == 0.0))


class Room(ABC):
    """A closed, convex room: the parts of its wall by their numbers, and its lamps."""

    walls: Any
    lights: tuple[Lamp, ...]

    @property
    @abstractmethod
    def parts(self) -> tuple[Wall, ...]:
        """The wall of each part, by its number."""

    @abstractmethod
    def part_of(self, position: FloatArray) -> IndexArray:
        """Return the numbers (N,) of the parts on which points (N, 3) of the wall lie."""

    @abstractmethod
    def normals(self, position: FloatArray, part: IndexArray) -> FloatArray:
        """Return the unit normals (N, 3) into the room."""

    @abstractmethod
    def follow(self, position: FloatArray, direction: FloatArray) -> FloatArray:
        """Return where rays (N, 3) that leave the wall meet it again (N, 3)."""

    @abstractmethod
    def area(self, part: int) -> float:
        """Return the area of a part [m²]."""

    @abstractmethod
    def spread(self, generator: np.random.Generator, n: int, part: int) -> FloatArray:
        """Return points (n, 3) spread evenly over a part."""

    @abstractmethod
    def contains(self, position: FloatArray) -> bool:
        """Return whether a point (3,) is inside, off the wall."""

    def holds(self, panel: Rectangle) -> bool:
        """Return whether a luminous panel lies in a flat part of the wall and shines into the room."""
        return False

    @abstractmethod
    def snap(self, position: FloatArray) -> FloatArray | None:
        """Return the point of the wall next to one (3,) that is meant to be there, None if it is not."""

    @cached_property
    def wavelengths(self) -> int | None:
        """How many wavelengths the room has; None when all is single numbers."""
        counts = {len(wall.emitted) for wall in self.parts if isinstance(wall.emitted, tuple)}
        counts |= {n for wall in self.parts if wall.f is not None and (n := wavelengths(wall.f)) is not None}
        counts |= {n for light in self.lights if (n := light.wavelengths) is not None}
        if len(counts) > 1:
            allowed = f"of one number of wavelengths, not {' and '.join(map(str, sorted(counts)))}"
            raise ParameterError("walls and lights", [*dict.fromkeys(self.parts), *self.lights], allowed)
        return next(iter(counts), None)

    def _check(self) -> None:
        object.__setattr__(self, "lights", _lights(self.lights))
        for light in self.lights:
            if isinstance(light, Rectangle):
                if not self.holds(light):
                    raise ParameterError("lights", light, "in a face of the box, shining inwards")
            elif not self.contains(np.array(light.position)):
                raise ParameterError("lights", light, "inside the room")
        _ = self.wavelengths  # the walls and the lights agree on their number


def check_wall(name: str, wall: Any) -> None:
    """Raise unless ``wall`` is one."""
    if not isinstance(wall, Wall):
        raise ParameterError(name, wall, "a Wall")


def _lights(lights: Any) -> tuple[Lamp, ...]:
    try:
        found = (lights,) if isinstance(lights, Lamp) else tuple(lights)
    except TypeError:
        found = (lights,)
    for light in found:
        if not isinstance(light, Lamp):
            raise ParameterError("lights", light, "point lights, or rectangles in the faces of a box")
    return found
