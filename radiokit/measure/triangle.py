"""Triangle: the warp of the unit square onto a flat triangle."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import dot
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.warp import ROUNDING, Warp

__all__ = ["UniformTriangle"]

FloatArray = npt.NDArray[np.float64]


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
        slack = ROUNDING * (1.0 + float(np.abs(corners).max()) / size) / height if height > 0.0 else 1.0
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
