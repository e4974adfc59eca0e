"""Disk: a flat round lamp that shines on one side, alike in all directions or as a power of the cosine."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import parameter
from radiokit.contracts.vectors import vector
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.exact import inner, rational, root
from radiokit.physics.disk import DISK_SOURCE
from radiokit.physics.plate import Plate

__all__ = ["Disk"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Disk(Emitter):
    """A disk whose radiance is L cosⁿ of the angle from its normal; behind it there is no light.

    Parameters
    ----------
    center : tuple of 3 floats
        [m].
    normal : tuple of 3 floats
        The side that shines; any length but 0, stored as a unit vector.
    radius : float
        [m], above 0.
    radiance : float
        Radiance L along the normal [W m⁻² sr⁻¹], at least 0.
    exponent : float
        n, at least 0; 0 for Lambert's law.

    Raises
    ------
    ParameterError
        When a vector is not three finite numbers, ``normal`` is zero, or a number is out of its range; from
        the methods, when the receiver is on the disk.

    >>> lamp = Disk(center=(0, 0, 2), normal=(0, 0, -1), radius=2, radiance=1.0)
    >>> up = np.array([0.0, 0.0, 1.0])
    >>> round(float(lamp.irradiance_at(np.zeros(3), up).value) / np.pi, 15)  # R²/(R² + h²)
    0.5
    """

    name: ClassVar[str] = "disk"
    SOURCE: ClassVar[Source] = DISK_SOURCE

    center: tuple[float, float, float] = vector("point", "m", "the disk's centre")
    normal: tuple[float, float, float] = vector("direction", "1", "the side that shines")
    radius: float = parameter("(0, inf)", "m", "the disk's radius")
    radiance: float = parameter("[0, inf)", "W/m^2/sr", "radiance along the normal")
    exponent: float = parameter("[0, 1e6]", "1", "n of radiance ∝ cosⁿ of the angle of emission", default=0.0)

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L cosⁿ for directions (N, 3) that meet the disk's bright side, 0 for the others."""
        seen = self._seen(position)
        if seen is None:
            return np.zeros(len(direction))
        emission = np.maximum(-(direction @ np.array(self.normal)), 0.0)
        return np.where(seen.near(direction), self.radiance * emission**self.exponent, 0.0)

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3) within the cone, and their densities [sr⁻¹].

        The density is the same along each half-plane through the cone's axis, and varies by less than 2 from
        one to another: with A ≤ B the cone's half-widths, κ² = (1 + A²)/(1 + B²) and tan of the ellipse's
        angle being κ tanχ, dΩ/dχ = ABκ / (√(1 + A²) (√(1 + A²) + √(cos²χ + κ² sin²χ))). Where the disk is not
        seen the density is 0.
        """
        seen = self._seen(position)
        if seen is None:
            away = np.broadcast_to(-np.array(self.normal), (len(u), 3))
            return away.copy(), np.zeros(len(u))
        a, b = seen.view.semi_axes
        kappa = math.hypot(1.0, a) / math.hypot(1.0, b)
        chi = 2.0 * np.pi * u[:, 1]
        cosine, sine = np.cos(chi), np.sin(chi)
        flat = cosine**2 + (kappa * sine) ** 2
        x, y = a * cosine, b * kappa * sine
        width = np.hypot(x, y)
        far = math.hypot(1.0, a) / np.sqrt(flat)  # from the apex to the ellipse's edge
        depth = u[:, 0] * (width / (1.0 + far)) * (width / far) / flat
        spread = np.sqrt(depth * (2.0 - depth)) / width
        local = np.stack((spread * x, spread * y, 1.0 - depth), axis=-1)
        return local @ seen.axes, _density(a, b, kappa, flat)

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the density of ``sample`` [sr⁻¹], 0 outside the cone."""
        seen = self._seen(position)
        if seen is None:
            return np.zeros(len(direction))
        a, b = seen.view.semi_axes
        kappa = math.hypot(1.0, a) / math.hypot(1.0, b)
        local = direction @ seen.axes.T
        x, y = local[:, 0] / a, local[:, 1] / b
        top, bottom = np.hypot(x, y), np.hypot(x, y / kappa)
        flat = np.divide(top, bottom, out=np.ones_like(top), where=bottom > 0) ** 2
        return np.where(seen.near(direction), _density(a, b, kappa, flat), 0.0)

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return Ω [sr] by one elliptic integral, for any place; 0 from behind and from the disk's plane."""
        seen = self._seen(position)
        return Estimate(0.0, 0.0, "rounding", method="closed form") if seen is None else seen.solid_angle()

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate | None:
        """Return E [W m⁻²] on a receiver of any pose; None for most of those under a disk with an exponent.

        In closed form where the horizon does not cut the disk, and else by an integral of positive strips
        that is bisected down to rounding. What the horizon cuts is decided in rational arithmetic.
        """
        seen = self._seen(position)
        if seen is None:
            return Estimate(0.0, 0.0, "rounding", method="closed form")
        if not self.exponent:
            found = seen.irradiance(normal)
            error = self.radiance * found.error + _EPS * self.radiance * found.value
            return replace(found, value=self.radiance * found.value, error=error)
        n, cut = rational(normal), seen.cut_by(normal)
        if not cut and inner(n, seen.towards) <= 0:
            return Estimate(0.0, 0.0, "rounding", method="closed form")
        view = seen.view
        if cut or view.offset > 0:
            return None
        power = self.exponent + 2.0
        facing = -inner(n, seen.normal)
        size = inner(n, n) * inner(seen.normal, seen.normal)
        share = -math.expm1(-0.5 * power * math.log1p((view.radius / view.depth) ** 2))
        value = self.radiance * root(facing * facing / size) * 2.0 * math.pi / power * share
        return Estimate(value, 16 * _EPS * value, "rounding", method="closed form")

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the disk's plane is along directions (N, 3)."""
        seen = self._seen(position)
        return np.full(len(direction), np.inf) if seen is None else seen.distance(direction)

    def silhouette(self, position: FloatArray) -> Silhouette | None:
        """Return the disk, evenly bright for Lambert's law; None where it is not seen."""
        seen = self._seen(position)
        return None if seen is None else Silhouette(seen, None if self.exponent else self.radiance)

    def flux(self) -> Estimate:
        """Return the radiant flux Φ = 2πL/(n + 2) · πR² [W].

        >>> lamp = Disk(center=(0, 0, 2), normal=(0, 0, -1), radius=2, radiance=1.0, exponent=2)
        >>> round(float(lamp.flux().value) / np.pi**2, 12)
        2.0
        """
        value = 2.0 * math.pi / (self.exponent + 2.0) * math.pi * self.radius * self.radius * self.radiance
        return Estimate(value, 8 * _EPS * value, "rounding", method="closed form")

    def _seen(self, position: FloatArray) -> Plate | None:
        """Return what a point sees of the disk, or None behind it and in its plane."""
        return Plate.seen(self.center, self.normal, self.radius, position)


def _density(a: float, b: float, kappa: float, flat: FloatArray) -> FloatArray:
    far = math.hypot(1.0, a)
    return far / a * ((far + np.sqrt(flat)) / b) / (2.0 * np.pi * kappa)
