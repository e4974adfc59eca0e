"""Warps: maps of the unit square onto a domain, each a triplet of ``sample``, ``pdf`` and ``invert``.

``invert`` undoes ``sample`` wherever the map is one to one; on a seam, such as the azimuth at a pole, it
gives one of the points that land there. ``u`` is checked; directions are trusted to be of unit length.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from numbers import Real
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import cap_solid_angle, dot
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source

__all__ = [
    "WARPS",
    "CosineHemisphere",
    "UniformCone",
    "UniformDisk",
    "UniformHemisphere",
    "UniformSphere",
    "UniformTriangle",
    "Warp",
]

FloatArray = npt.NDArray[np.float64]

_BELOW_ONE = float(np.nextafter(1.0, 0.0))
_TINY = 2.0**-54  # half the spacing of u below 1: the least distance from the rim that a sample keeps
_SLACK = 2.0**-48  # how far outside its domain rounding may put a sample, relative to the domain


class Warp(ABC):
    """A map of the unit square onto a domain, with the density of what comes out."""

    SOURCE: ClassVar[Source]

    def sample(self, u: npt.ArrayLike) -> FloatArray:
        """Return the points for ``u`` (N, 2) in [0, 1]²: (N, 3), or (N, 2) for the disk.

        Raises
        ------
        ParameterError
            When ``u`` is not of that shape, or leaves the unit square.
        """
        square = np.asarray(u, dtype=np.float64)
        if square.ndim == 0 or square.shape[-1] != 2:
            raise ParameterError("u", square.shape, "an array of shape (N, 2)")
        inside = (square >= 0.0) & (square <= 1.0)
        if not inside.all():
            raise ParameterError("u", float(square[~inside][0]), "in [0, 1]")
        return self._sample(square[..., 0], square[..., 1])

    def pdf(self, points: FloatArray) -> FloatArray:
        """Return the density (N,) with which ``sample`` makes ``points``, 0 outside the domain.

        Per solid angle [sr⁻¹] for directions, per area [m⁻²] for the disk and the triangle.
        """
        return self._pdf(np.asarray(points, dtype=np.float64))

    def invert(self, points: FloatArray) -> FloatArray:
        """Return the ``u`` (N, 2) in [0, 1)² from which ``sample`` makes ``points``."""
        u0, u1 = self._invert(np.asarray(points, dtype=np.float64))
        return np.clip(np.stack((u0, u1), axis=-1), 0.0, _BELOW_ONE) + 0.0  # −0 becomes 0

    @abstractmethod
    def _sample(self, u0: FloatArray, u1: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _pdf(self, points: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _invert(self, points: FloatArray) -> tuple[FloatArray, FloatArray]: ...


def _circle(turn: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return cosine and sine of 2π ``turn``, for turns in [0, 1], exact on the axes."""
    quarter = np.rint(4.0 * turn)
    angle = 2.0 * np.pi * (turn - 0.25 * quarter)  # the difference is exact
    cosine, sine = np.cos(angle), np.sin(angle)
    odd, sign = quarter % 2 == 1, np.where((quarter == 2) | (quarter == 3), -1.0, 1.0)
    return sign * np.where(odd, -sine, cosine), sign * np.where(odd, cosine, sine)


def _turn(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the azimuth as a share of the full turn, in [0, 1)."""
    share = np.arctan2(y, x) / (2.0 * np.pi)
    return np.where(share < 0.0, np.minimum(share + 1.0, _BELOW_ONE), share)


class _Cap(Warp):
    """A uniform cap around z, given by ``_height`` and ``_rest``: 1 − cos and 1 + cos of its half-angle."""

    SOURCE = Source(
        authors="Shirley",
        year=1992,
        title="Nonuniform Random Point Sets via Warping. Graphics Gems III",
        equation="1 − z is uniform on a cap (Archimedes)",
    )

    _height: float
    _rest: float
    _density: float

    def _sample(self, u0: FloatArray, u1: FloatArray) -> FloatArray:
        depth = self._height * u0  # 1 − z, which keeps the digits that z loses near the pole
        radius = np.sqrt(depth * (2.0 * (1.0 - u0) + self._rest * u0))
        cosine, sine = _circle(u1)
        return np.stack((radius * cosine, radius * sine, 1.0 - depth), axis=-1)

    def _depth_share(self, points: FloatArray) -> FloatArray:
        """Return (1 − z) / height, for unit vectors; from the radius where z is near 1."""
        z = points[..., 2]
        radius = np.hypot(points[..., 0], points[..., 1]) / np.sqrt(self._height)
        near = radius * radius / (1.0 + np.maximum(z, 0.0))
        far: FloatArray = np.where(z > 0.0, near, (1.0 - z) / self._height)
        return far

    def _pdf(self, points: FloatArray) -> FloatArray:
        return np.where(self._depth_share(points) <= 1.0 + _SLACK, self._density, 0.0)

    def _invert(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        return self._depth_share(points), _turn(points[..., 0], points[..., 1])


@dataclass(frozen=True, kw_only=True)
class UniformSphere(_Cap):
    """Every direction alike.

    >>> UniformSphere().sample([[0.5, 0.0]]).tolist()
    [[1.0, 0.0, 0.0]]
    """

    _height, _rest, _density = 2.0, 0.0, 0.25 / np.pi


@dataclass(frozen=True, kw_only=True)
class UniformHemisphere(_Cap):
    """Every direction above the surface alike.

    >>> float(UniformHemisphere().pdf(np.array([0.0, 0.6, -0.8])))
    0.0
    """

    _height, _rest, _density = 1.0, 1.0, 0.5 / np.pi


@dataclass(frozen=True, kw_only=True)
class UniformCone(_Cap):
    """Every direction within ``half_angle`` of z alike, however narrow the cone.

    Parameters
    ----------
    half_angle : float
        [rad], in [1e-150, π].

    Raises
    ------
    ParameterError
        When ``half_angle`` is out of its range.

    >>> direction = UniformCone(half_angle=1e-8).sample([[0.25, 0.0]])
    >>> round(float(direction[0, 0]) / 1e-8, 12)
    0.5
    """

    half_angle: float

    def __post_init__(self) -> None:
        if not (isinstance(self.half_angle, Real) and 1e-150 <= self.half_angle <= np.pi):
            raise ParameterError("half_angle", self.half_angle, "an angle in [1e-150, pi] radians")
        half = 0.5 * self.half_angle
        object.__setattr__(self, "_height", float(2.0 * np.sin(half) ** 2))
        object.__setattr__(self, "_rest", float(2.0 * np.cos(half) ** 2))
        object.__setattr__(self, "_density", float(1.0 / cap_solid_angle(self.half_angle)))


_CONCENTRIC = Source(
    authors="Shirley, Chiu",
    year=1997,
    title="A Low Distortion Map Between Disk and Square. Journal of Graphics Tools 2(3)",
    doi="10.1080/10867651.1997.10487479",
)


def _concentric(u0: FloatArray, u1: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Map the square's rings onto the disk's; return x, y, and the distance from the rim."""
    a, b = 2.0 * u0 - 1.0, 2.0 * u1 - 1.0
    flat = np.abs(a) > np.abs(b)
    radius = np.where(flat, a, b)  # with a sign
    ratio = np.where(flat, b, a) / np.where(radius == 0.0, 1.0, radius)
    angle = 0.25 * np.pi * ratio
    along, across = radius * np.cos(angle), radius * np.sin(angle)
    ring = np.where(flat, u0, u1)
    rim = 2.0 * np.minimum(ring, 1.0 - ring)  # 1 − |radius|, exactly
    return np.where(flat, along, across), np.where(flat, across, along), rim


def _concentric_inverse(x: FloatArray, y: FloatArray, rim: FloatArray) -> tuple[FloatArray, FloatArray]:
    flat = np.abs(x) > np.abs(y)
    major, minor = np.where(flat, x, y), np.where(flat, y, x)
    ratio = np.arctan(minor / np.where(major == 0.0, 1.0, major)) / (0.25 * np.pi)
    ring = np.where(major < 0.0, 0.5 * rim, 1.0 - 0.5 * rim)
    other = 0.5 * (1.0 + np.copysign(1.0 - rim, major) * ratio)
    return np.where(flat, ring, other), np.where(flat, other, ring)


@dataclass(frozen=True, kw_only=True)
class UniformDisk(Warp):
    """The unit disk, points (N, 2) of equal density; neighbours in the square stay neighbours.

    >>> UniformDisk().sample([[0.5, 0.5], [1.0, 0.5]]).tolist()
    [[0.0, 0.0], [1.0, 0.0]]
    """

    SOURCE = _CONCENTRIC

    def _sample(self, u0: FloatArray, u1: FloatArray) -> FloatArray:
        x, y, _ = _concentric(u0, u1)
        return np.stack((x, y), axis=-1)

    def _pdf(self, points: FloatArray) -> FloatArray:
        return np.where(np.hypot(points[..., 0], points[..., 1]) <= 1.0 + _SLACK, 1.0 / np.pi, 0.0)

    def _invert(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        x, y = points[..., 0], points[..., 1]
        return _concentric_inverse(x, y, 1.0 - np.minimum(np.hypot(x, y), 1.0))


@dataclass(frozen=True, kw_only=True)
class CosineHemisphere(Warp):
    """Directions above the surface, in proportion to their cosine: the disk, lifted (Malley's method).

    Samples stay 1e-8 above the horizon, so their density is never 0.

    >>> float(CosineHemisphere().pdf(np.array([0.6, 0.0, 0.8]))) == 0.8 / np.pi
    True
    """

    SOURCE = _CONCENTRIC

    def _sample(self, u0: FloatArray, u1: FloatArray) -> FloatArray:
        x, y, rim = _concentric(u0, u1)
        rim = np.maximum(rim, _TINY)
        return np.stack((x, y, np.sqrt(rim * (2.0 - rim))), axis=-1)

    def _pdf(self, points: FloatArray) -> FloatArray:
        return np.maximum(points[..., 2], 0.0) / np.pi

    def _invert(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        x, y, z = points[..., 0], points[..., 1], np.maximum(points[..., 2], 0.0)
        return _concentric_inverse(x, y, np.minimum(z * z / (1.0 + np.hypot(x, y)), 1.0))


@dataclass(frozen=True, kw_only=True)
class UniformTriangle(Warp):
    """Points (N, 3) of equal density on a flat triangle; neighbours in the square stay neighbours.

    Parameters
    ----------
    vertices : array_like, shape (3, 3)
        [m], a corner each row.

    Raises
    ------
    ParameterError
        When the vertices are not three finite points, or lie on a line.

    >>> warp = UniformTriangle(vertices=[[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    >>> warp.sample([[0.5, 0.5]]).tolist(), warp.area
    ([[0.25, 0.5, 0.0]], 0.5)
    """

    vertices: Any
    _size: float = field(init=False, repr=False, compare=False)  # the longest edge; all else is in its units
    _normal: FloatArray = field(init=False, repr=False, compare=False)  # its length: twice the area
    _slack: float = field(init=False, repr=False, compare=False)  # what rounding does to weights of vertices

    SOURCE = Source(
        authors="Heitz",
        year=2019,
        title="A Low-Distortion Map Between Triangle and Square. HAL hal-02073696",
    )

    def __post_init__(self) -> None:
        allowed = "three finite points (3, 3) that are not on one line"
        try:
            corners = np.array(self.vertices, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError("vertices", self.vertices, allowed) from None
        if corners.shape != (3, 3) or not np.isfinite(corners).all():
            raise ParameterError("vertices", corners.tolist(), allowed)
        edges = np.roll(corners, -1, axis=0) - corners
        lengths = np.hypot(np.hypot(edges[:, 0], edges[:, 1]), edges[:, 2])
        longest = int(np.argmax(lengths))
        size = float(lengths[longest])
        if not 1e-150 <= size <= 1e150:
            raise ParameterError("vertices", corners.tolist(), allowed)
        edges /= size
        normal = np.cross(edges[longest - 2], edges[longest - 1])  # the two shorter edges lose the least
        height = float(np.sqrt(dot(normal, normal)))
        slack = _SLACK * (1.0 + float(np.abs(corners).max()) / size) / height if height > 0.0 else 1.0
        if slack > 0.01:
            raise ParameterError("vertices", corners.tolist(), allowed)
        corners.setflags(write=False)
        for name, value in {"vertices": corners, "_size": size, "_normal": normal, "_slack": slack}.items():
            object.__setattr__(self, name, value)

    @property
    def area(self) -> float:
        """The triangle's area [m²]."""
        return 0.5 * self._size**2 * float(np.sqrt(dot(self._normal, self._normal)))

    def _sample(self, u0: FloatArray, u1: FloatArray) -> FloatArray:
        small = 0.5 * np.minimum(u0, u1)
        large = np.maximum(u0, u1) - small
        first = np.where(u1 > u0, small, large)[..., None]
        second = np.where(u1 > u0, large, small)[..., None]
        third = (1.0 - np.maximum(u0, u1))[..., None]
        a, b, c = self.vertices
        points: FloatArray = first * a + second * b + third * c
        return points

    def _weights(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the weights of the first two vertices, and the height over the plane in longest edges."""
        a, b, c = self.vertices
        square = dot(self._normal, self._normal)
        offset = (points - c) / self._size
        first = dot(np.cross(offset, (b - c) / self._size), self._normal) / square
        second = dot(np.cross((a - c) / self._size, offset), self._normal) / square
        return first, second, dot(offset, self._normal) / np.sqrt(square)

    def _pdf(self, points: FloatArray) -> FloatArray:
        first, second, height = self._weights(points)
        least = np.minimum(np.minimum(first, second), 1.0 - first - second)
        inside = (least >= -self._slack) & (np.abs(height) <= self._slack)
        return np.where(inside, 1.0 / self.area, 0.0)

    def _invert(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        first, second, _ = self._weights(points)
        total = first + second
        swapped = second > first
        return np.where(swapped, 2.0 * first, total), np.where(swapped, total, 2.0 * second)


WARPS: dict[str, Warp] = {
    "uniform_sphere": UniformSphere(),
    "uniform_hemisphere": UniformHemisphere(),
    "cosine_hemisphere": CosineHemisphere(),
    "uniform_cone": UniformCone(half_angle=0.5),
    "uniform_disk": UniformDisk(),
    "uniform_triangle": UniformTriangle(vertices=[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.5, 2.0, 1.5]]),
}
"""One warp of each kind, by name: what tests and demonstrations go through."""
