"""Sphere: a room whose wall is a sphere, with round ports, samples, detectors and lamps in it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from numbers import Real
from typing import Any

import numpy as np

from radiokit.contracts.vectors import as_point, as_unit
from radiokit.emitters.disk import Disk
from radiokit.facts.directions import angle_between, cap_solid_angle, dot, frame, to_world
from radiokit.facts.errors import ParameterError
from radiokit.worlds.enclosure.rooms import ON_WALL, FloatArray, IndexArray, Room, Triple, Wall, check_wall

__all__ = ["Cap", "Sphere"]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Cap:
    """A round part of a sphere's wall: a port, a sample, a detector, or a lamp.

    Parameters
    ----------
    direction : tuple of 3 floats
        From the sphere's centre to the cap's middle, of any length but 0.
    half_angle : float
        θ [rad] in (0, π), seen from the centre; ``math.asin(r/R)`` for a port of radius r.
    wall : Wall
        A hole by default.
    """

    direction: Triple
    half_angle: float
    wall: Wall = field(default_factory=Wall)

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", as_unit("direction", self.direction))
        if not 0 < self.half_angle < math.pi:
            raise ParameterError("half_angle", self.half_angle, "an angle in (0, π) radians")
        check_wall("wall", self.wall)

    @property
    def share(self) -> float:
        """The share of the sphere's area, sin²(θ/2)."""
        return math.sin(self.half_angle / 2) ** 2


@dataclass(frozen=True, kw_only=True)
class Sphere(Room):
    """The inside of a sphere. Part 0 is its wall; its caps are parts 1, 2, ... and must not overlap.

    Parameters
    ----------
    wall : Wall
    caps : sequence of Cap
    lights : sequence of point lights
        Emitters with a ``position`` inside, such as ``point``, ``spot`` or ``goniometric``.
    radius : float
        [m], above 0.
    center : tuple of 3 floats
        [m].

    Raises
    ------
    ParameterError
        When an argument is not allowed, caps overlap, or a light is not inside.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> port = Cap(direction=(0, 0, 1), half_angle=0.2)
    >>> room = Sphere(wall=Wall(f=Lambert(reflectance=0.98)), caps=[port])
    >>> round(room.area(1) / (room.area(0) + room.area(1)), 6), port.wall
    (0.009967, Wall(f=None, emitted=0.0))
    """

    wall: Wall
    caps: Sequence[Cap] = ()
    lights: Any = ()
    radius: float = 1.0
    center: Triple = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        check_wall("wall", self.wall)
        object.__setattr__(self, "caps", tuple(self.caps))
        object.__setattr__(self, "center", as_point("center", self.center))
        if not (isinstance(self.radius, Real) and 0 < self.radius < math.inf):
            raise ParameterError("radius", self.radius, "a number in (0, inf)")
        for index, cap in enumerate(self.caps):
            if not isinstance(cap, Cap):
                raise ParameterError(f"caps[{index}]", cap, "a Cap")
            for other in self.caps[:index]:
                apart = angle_between(np.array(cap.direction), np.array(other.direction))
                if apart < (cap.half_angle + other.half_angle) * (1 - 1e-12):
                    allowed = f"apart from the cap towards {other.direction}: caps must not overlap"
                    raise ParameterError(f"caps[{index}]", cap, allowed)
        self._check()

    @property
    def parts(self) -> tuple[Wall, ...]:
        """The wall, then the caps'."""
        return (self.wall, *(cap.wall for cap in self.caps))

    @property
    def shares(self) -> tuple[float, ...]:
        """The share of the area that each part takes."""
        caps = [cap.share for cap in self.caps]
        return (max(0.0, 1.0 - math.fsum(caps)), *caps)

    def part_of(self, position: FloatArray) -> IndexArray:
        """Return 0 for the wall and k for cap k, by haversines: no digit of a small cap is lost."""
        found = np.zeros(len(position), dtype=np.intp)
        towards = (position - self.center) / self.radius
        for index, cap in enumerate(self.caps, start=1):
            off = towards - cap.direction
            found[dot(off, off) <= 4.0 * cap.share] = index
        return found

    def normals(self, position: FloatArray, part: IndexArray) -> FloatArray:
        """Return the unit vectors to the centre."""
        inward = self.center - position
        return np.asarray(inward / np.sqrt(dot(inward, inward))[:, None])

    def follow(self, position: FloatArray, direction: FloatArray) -> FloatArray:
        """Return the other ends of the chords, put back on the sphere."""
        start = position - self.center
        end = start - 2.0 * dot(start, direction)[:, None] * direction
        return np.asarray(self.center + end * (self.radius / np.sqrt(dot(end, end)))[:, None])

    def area(self, part: int) -> float:
        """Return the share times 4πR²."""
        return 4.0 * math.pi * self.shares[part] * self.radius * self.radius

    def spread(self, generator: np.random.Generator, n: int, part: int) -> FloatArray:
        """Return points of a cap, by haversines; of the wall, those of the sphere that are in no cap."""
        if part:
            cap = self.caps[part - 1]
            return self._around(generator.random((n, 2)), cap.share, np.array(cap.direction))
        found = np.empty((n, 3))
        rows = np.arange(n)
        while len(rows):
            found[rows] = self._around(generator.random((len(rows), 2)), 1.0, np.array([0.0, 0.0, 1.0]))
            rows = rows[self.part_of(found[rows]) > 0]
        return found

    def _around(self, u: FloatArray, share: float, axis: FloatArray) -> FloatArray:
        h, phi = share * u[:, 0], 2.0 * np.pi * u[:, 1]
        r = 2.0 * np.sqrt(h * (1.0 - h))
        local = np.stack([r * np.cos(phi), r * np.sin(phi), 1.0 - 2.0 * h], axis=-1)
        return np.asarray(self.center + self.radius * to_world(frame(axis), local))

    def contains(self, position: FloatArray) -> bool:
        """Return whether the distance from the centre is less than the radius, by more than rounding."""
        return math.dist(position, self.center) < self.radius * (1 - ON_WALL)

    def snap(self, position: FloatArray) -> FloatArray | None:
        """Return the point of the sphere in the same direction."""
        distance = math.dist(position, self.center)
        if not abs(distance / self.radius - 1) <= ON_WALL:
            return None
        return np.asarray(self.center + (position - self.center) * (self.radius / distance))

    def solid_angles(self, position: FloatArray) -> tuple[FloatArray, float]:
        """Return the solid angles [sr] of all parts from a point inside, and a bound of their errors."""
        angles, error = [], 0.0
        start = position - self.center
        for cap in self.caps:
            if not start.any():
                angles.append(float(cap_solid_angle(cap.half_angle)))
                error += 4 * _EPS * angles[-1]
                continue
            axis = np.array(cap.direction)
            middle = self.radius * math.cos(cap.half_angle) * axis
            depth = float(dot(middle - start, axis))
            side = math.copysign(1.0, depth)
            rim = self.radius * math.sin(cap.half_angle)
            near = math.hypot(depth, rim - float(np.linalg.norm(np.cross(start, axis))))
            disk = 2.0 * math.pi  # within the plane of its rim a cap fills half the directions
            if abs(depth) > 16 * _EPS * self.radius:
                lid = Disk(center=tuple(middle), normal=tuple(-side * axis), radius=rim, radiance=1.0)
                disk = float(lid.solid_angle(start).value)
            angles.append(disk if side > 0 else 4.0 * math.pi - disk)
            error += 128 * _EPS * (angles[-1] + self.radius / near * min(1.0, (rim / near) ** 2))
        return np.array([max(0.0, 4.0 * math.pi - math.fsum(angles)), *angles]), error
