"""Piece: a part of a light over which quadrature is smooth, with its map of the unit square."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.parameters import Spectrum
from radiokit.contracts.spectral import weighted
from radiokit.facts.estimate import Estimate, rounding
from radiokit.measure.sphericaltriangle import UniformSphericalTriangle

__all__ = ["Patch", "Piece", "TrianglePatch", "fan", "tilted"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


class Patch(Protocol):
    """A region of directions as the image of the unit square."""

    @property
    def size(self) -> float:
        """The solid angle [sr]."""

    @property
    def spread(self) -> float:
        """How far off ``size`` may be, but for rounding [sr]."""

    @property
    def precision(self) -> float:
        """What rounding may change of an integral over it, relative to its value."""

    def sample(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn points (N, 2) into directions (N, 3) and densities (N,) [sr⁻¹]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece(Emitter):
    """A patch of a light, all of it seen: only its own directions are asked about.

    ``radiance`` [W m⁻² sr⁻¹] is None where it varies; ``precision`` is what quadrature adds to its bound.
    """

    name: ClassVar[str] = "piece"

    light: Emitter
    patch: Patch
    radiance: Spectrum | None
    precision: float

    @property
    def wavelengths(self) -> int | None:
        """Those of the light."""
        return self.light.wavelengths

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the light's radiance, (N,) or (N, K) [W m⁻² sr⁻¹]."""
        if self.radiance is None:
            return self.light.radiance_from(direction, position)
        return weighted(np.ones(len(direction)), self.radiance)

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the patch's directions and densities."""
        return self.patch.sample(u)

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light is."""
        return self.light.distance_along(direction, position)

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return the solid angle [sr]."""
        return rounding(self.patch.size)


@dataclass(frozen=True)
class TrianglePatch:
    """A spherical triangle; the square on the second number smooths the root at its corner."""

    warp: UniformSphericalTriangle
    size: float
    precision: float
    spread: float = 0.0

    def sample(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return directions (N, 3) and their densities (N,) [sr⁻¹]."""
        direction = self.warp.sample(np.stack((u[:, 0], u[:, 1] ** 2), axis=-1))
        with np.errstate(divide="ignore"):
            density = 1 / (2 * u[:, 1] * self.size)
        return direction, density


def fan(corners: FloatArray) -> Sequence[TrianglePatch]:
    """Return the triangles of a convex cone's corners (N, 3), which are rounded, but for those of no size.

    >>> round(sum(patch.size for patch in fan(np.eye(3))) / np.pi, 14)
    0.5
    """
    found = []
    for k in range(1, len(corners) - 1):
        warp = UniformSphericalTriangle(vertices=corners[[0, k, k + 1]])
        if warp.solid_angle > 0.0:
            size = warp.solid_angle
            found.append(TrianglePatch(warp, size, 8 * _EPS * warp.perimeter / size))
    return found


def tilted(patch: Patch, normal: FloatArray) -> float:
    """Return the precision of a patch for a receiver: a direction is known to an eps, and so is a cosine."""
    middle = patch.sample(np.array([[0.5, 0.5]]))[0][0]
    return patch.precision + 8 * _EPS / max(float(middle @ normal), _EPS)
