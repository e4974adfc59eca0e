"""Warps: maps of the unit square onto the sphere, its caps, and the disk; ``WARPS`` has one of each kind."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import cap_solid_angle
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.triangle import UniformTriangle
from radiokit.measure.warp import ROUNDING, Warp

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
        return np.where(self._depth_share(points) <= 1.0 + ROUNDING, self._density, 0.0)

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
        return np.where(np.hypot(points[..., 0], points[..., 1]) <= 1.0 + ROUNDING, 1.0 / np.pi, 0.0)

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


WARPS: dict[str, Warp] = {
    "uniform_sphere": UniformSphere(),
    "uniform_hemisphere": UniformHemisphere(),
    "cosine_hemisphere": CosineHemisphere(),
    "uniform_cone": UniformCone(half_angle=0.5),
    "uniform_disk": UniformDisk(),
    "uniform_triangle": UniformTriangle(vertices=[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.5, 2.0, 1.5]]),
}
"""One warp of each kind, by name: what tests and demonstrations go through."""
