"""Warp: a map of the unit square onto a domain, as a triplet of ``sample``, ``pdf`` and ``invert``.

``invert`` undoes ``sample`` wherever the map is one to one; on a seam, such as the azimuth at a pole, it
gives one of the points that land there. ``u`` is checked; directions are trusted to be of unit length.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source

__all__ = ["ROUNDING", "Warp"]

FloatArray = npt.NDArray[np.float64]

ROUNDING = 2.0**-48
"""How far outside its domain rounding may put a sample, relative to the domain."""

_BELOW_ONE = float(np.nextafter(1.0, 0.0))


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
