"""Chords: what the horizon leaves of a round light, swept in chords parallel to it, for quadrature.

The square's first number turns a half-plane about the chord's direction, from the top of the light down to
the horizon, and the second goes along it. Neither the horizon nor the light's round edge is a kink then.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from radiokit.measure.gauss import gauss_legendre

__all__ = ["CapPatch", "DiskPatch"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Swept(ABC):
    """A part of a round light; directions are made along (chord, level, up), the rows of ``axes``."""

    axes: FloatArray
    turn: float

    @property
    def precision(self) -> float:
        """What rounding does beside that of the directions: nothing."""
        return 0.0

    @cached_property
    def size(self) -> float:
        """The solid angle [sr]."""
        return self._measured(32)

    @cached_property
    def spread(self) -> float:
        """How far off ``size`` may be, but for rounding [sr]: how far fewer nodes are."""
        return abs(self.size - self._measured(20))

    def _measured(self, count: int) -> float:
        x, w = gauss_legendre(count)
        u = np.stack((x, np.full_like(x, 0.5)), axis=-1)  # alike all along a chord
        return float(np.sum(w / self.sample(u)[1]))

    @abstractmethod
    def sample(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return directions (N, 3) and their densities (N,) [sr⁻¹]."""

    def _directions(self, along: FloatArray, level: FloatArray, up: FloatArray) -> FloatArray:
        across = np.sqrt((1.0 - along) * (1.0 + along))
        return np.stack((along, across * level, across * up), axis=-1) @ self.axes


@dataclass(frozen=True, kw_only=True, eq=False)
class CapPatch(_Swept):
    """The part above the horizon of a circular cone of directions.

    With x the angle of the half-plane from the cone's axis, sin x = sinσ cos y makes the cone's edge smooth
    in y: dω = 2 sin²σ sin²y/cos²x du dy, for y from 0 to ``turn``, where the horizon is.

    Parameters
    ----------
    axes : ndarray, shape (3, 3)
        Along the chord, level to the cone's side, and up.
    turn : float
        Half the angle of the cone's edge that is above the horizon [rad], about the way to its centre.
    sine, cosine : float
        Of the cone's half-angle σ.
    """

    sine: float
    cosine: float

    def sample(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return directions (N, 3) and their densities (N,) [sr⁻¹]."""
        y, s, c = self.turn * u[:, 0], self.sine, self.cosine
        x_sine, x_cosine = s * np.cos(y), np.hypot(c, s * np.sin(y))
        low_sine, low_cosine = s * math.cos(self.turn), math.hypot(c, s * math.sin(self.turn))
        # The sine of the half-plane's angle from the horizon, x − x₀, without the difference.
        rise = 2 * s * np.sin(0.5 * (self.turn - y)) * np.sin(0.5 * (self.turn + y))
        up = rise * (low_cosine + low_sine * (x_sine + low_sine) / (x_cosine + low_cosine))
        level = x_cosine * low_cosine + x_sine * low_sine
        half = s * np.sin(y) / x_cosine
        with np.errstate(divide="ignore"):
            density = 1 / (2 * self.turn * half * half)
        return self._directions((2 * u[:, 1] - 1) * half, level, up), density


@dataclass(frozen=True, kw_only=True, eq=False)
class DiskPatch(_Swept):
    """The part above the horizon of a disk.

    Parameters
    ----------
    axes, turn
        As in ``CapPatch``; ``turn`` is about the disk's centre.
    radius, depth, aside : float
        R, the distance a of the disk's plane, and that of its centre along the chord; in any one unit.
    slope, facing : float
        Sine and cosine of the angle between up and the way across to the disk's plane.
    """

    radius: float
    depth: float
    aside: float
    slope: float
    facing: float

    def sample(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return directions (N, 3) and their densities (N,) [sr⁻¹]."""
        y = self.turn * u[:, 0]
        rise = 2 * self.radius * np.sin(0.5 * (self.turn - y)) * np.sin(0.5 * (self.turn + y))
        up, level = self.slope * rise, self.depth / self.slope - self.facing * rise
        length, half = np.hypot(up, level), self.radius * np.sin(y)
        left, right = self.aside - half, self.aside + half
        first, last = np.hypot(length, left), np.hypot(length, right)
        # The difference of the sines right/last and left/first of the chord's ends.
        product, square = left * right, length * length
        far = square * ((left * left + right * right + square) / (first * last + np.maximum(product, 0.0)))
        apart = np.where(product > 0, far, first * last - product)
        spread = 2 * half * (square + apart) / (first * last * (first + last))
        with np.errstate(divide="ignore"):
            density = length / self.depth * (length / half) / (self.turn * spread)
        return self._directions(left / first + u[:, 1] * spread, level / length, up / length), density
