"""Box: a room of six rectangular walls along the axes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from radiokit.contracts.vectors import as_point
from radiokit.emitters.rectangle import Rectangle
from radiokit.facts.errors import ParameterError
from radiokit.worlds.enclosure.rooms import ON_WALL, FloatArray, IndexArray, Room, Triple, Wall, check_wall

__all__ = ["Box"]


@dataclass(frozen=True, kw_only=True)
class Box(Room):
    """The inside of a box along the axes. Its parts are the faces at −x, +x, −y, +y, −z and +z, 0 to 5.

    Parameters
    ----------
    walls : Wall or sequence of six
        All faces alike, or each.
    lights : sequence of emitters
        Point lights inside, as for ``Sphere``, and ``rectangle`` panels that lie in a face and shine inwards;
        what falls on a panel is reflected as by the face around it.
    low, high : tuple of 3 floats
        Opposite corners [m], each coordinate of ``high`` above that of ``low``.

    Raises
    ------
    ParameterError
        When an argument is not allowed, or a light is not inside.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> room = Box(walls=Wall(f=Lambert(reflectance=0.5)), high=(2, 3, 4))
    >>> room.area(5), len(room.parts)
    (6.0, 6)
    """

    walls: Any
    lights: Any = ()
    low: Triple = (0.0, 0.0, 0.0)
    high: Triple = (1.0, 1.0, 1.0)

    def __post_init__(self) -> None:
        try:
            walls = (self.walls,) * 6 if isinstance(self.walls, Wall) else tuple(self.walls)
        except TypeError:
            walls = ()
        if len(walls) != 6:
            raise ParameterError("walls", self.walls, "one Wall, or six: at −x, +x, −y, +y, −z, +z")
        for index, wall in enumerate(walls):
            check_wall(f"walls[{index}]", wall)
        object.__setattr__(self, "walls", walls)
        for name in ("low", "high"):
            object.__setattr__(self, name, as_point(name, getattr(self, name)))
        if not all(a < b for a, b in zip(self.low, self.high, strict=True)):
            raise ParameterError("high", self.high, f"above low = {self.low} in every coordinate")
        self._check()

    @property
    def parts(self) -> tuple[Wall, ...]:
        """The six walls."""
        return tuple(self.walls)

    @cached_property
    def _ends(self) -> FloatArray:
        return np.array([self.low, self.high])

    def part_of(self, position: FloatArray) -> IndexArray:
        """Return the face on which each point lies, the first of those at an edge."""
        off = np.abs(position[:, None, :] - self._ends)  # (N, 2, 3)
        return np.asarray(np.argmin(off.transpose(0, 2, 1).reshape(-1, 6), axis=1))

    def normals(self, position: FloatArray, part: IndexArray) -> FloatArray:
        """Return plus or minus the axes."""
        found = np.zeros((len(part), 3))
        found[np.arange(len(part)), part // 2] = np.where(part % 2, -1.0, 1.0)
        return found

    def follow(self, position: FloatArray, direction: FloatArray) -> FloatArray:
        """Return where the first of the three faces ahead is met, exactly on it."""
        ahead = (direction > 0).astype(np.intp)
        goal = self._ends[ahead, np.arange(3)]
        with np.errstate(divide="ignore", invalid="ignore"):
            way = np.where(direction != 0, np.maximum((goal - position) / direction, 0.0), np.inf)
        axis = np.argmin(way, axis=1)
        rows = np.arange(len(position))
        end = position + way[rows, axis][:, None] * direction
        end = np.clip(end, self._ends[0], self._ends[1])
        end[rows, axis] = goal[rows, axis]
        return np.asarray(end)

    def area(self, part: int) -> float:
        """Return the product of the face's two edges."""
        edges = self._ends[1] - self._ends[0]
        return float(math.prod(np.delete(edges, part // 2)))

    def spread(self, generator: np.random.Generator, n: int, part: int) -> FloatArray:
        """Return points of the face."""
        u = generator.random((n, 2))
        found = np.empty((n, 3))
        axis = part // 2
        found[:, axis] = self._ends[part % 2, axis]
        for column, k in enumerate(k for k in range(3) if k != axis):
            low, high = self._ends[:, k]
            found[:, k] = np.clip(low + (high - low) * u[:, column], low, high)
        return found

    def contains(self, position: FloatArray) -> bool:
        """Return whether a point is off all faces, by more than rounding."""
        margin = ON_WALL * (self._ends[1] - self._ends[0])
        return bool(np.all((position > self._ends[0] + margin) & (position < self._ends[1] - margin)))

    def holds(self, panel: Rectangle) -> bool:
        """Return whether all corners lie in one face, whose normal the panel's is."""
        corners, size = panel.corners, self._ends[1] - self._ends[0]
        inside = np.all(np.abs(np.clip(corners, *self._ends) - corners) <= ON_WALL * size)
        for part in range(6):
            axis, inward = part // 2, -1.0 if part % 2 else 1.0
            flat = np.all(np.abs(corners[:, axis] - self._ends[part % 2, axis]) <= ON_WALL * size[axis])
            if inside and flat and inward * panel.normal[axis] > 0:
                return True
        return False

    def snap(self, position: FloatArray) -> FloatArray | None:
        """Return the point moved onto the nearest face."""
        size = self._ends[1] - self._ends[0]
        off = np.abs(position - self._ends) / size
        end, axis = np.unravel_index(np.argmin(off), off.shape)
        inside = np.clip(position, self._ends[0], self._ends[1])
        if off[end, axis] > ON_WALL or np.any(np.abs(inside - position) > ON_WALL * size):
            return None
        inside[axis] = self._ends[end, axis]
        return np.asarray(inside)
