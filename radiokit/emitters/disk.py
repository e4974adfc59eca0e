"""Disk: a flat round lamp that shines on one side, alike in all directions or as a power of the cosine."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.chords import DiskPatch
from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import Spectrum, choice, parameter
from radiokit.contracts.piece import Piece, tilted
from radiokit.contracts.spectral import amount, flux_estimate, weighted
from radiokit.contracts.vectors import vector
from radiokit.facts.directions import frame, to_world, unit
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.exact import cross, inner
from radiokit.physics.disk import DISK_SOURCE, DiskView, against
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
        [m], in (0, 1e150].
    radiance : float, or sequence of K floats
        Radiance L along the normal [W m⁻² sr⁻¹], in [0, 1e100]; one number, or one a wavelength.
    exponent : float
        n in [0, 1e6]; 0 for Lambert's law.
    sampling : {"solid angle", "area"}
        Over what its directions are sampled evenly, or nearly so for the solid angle.

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
    radius: float = parameter("(0, 1e150]", "m", "the disk's radius")
    radiance: Spectrum = parameter("[0, 1e100]", "W/m^2/sr", "radiance along the normal", spectral=True)
    exponent: float = parameter("[0, 1e6]", "1", "n of radiance ∝ cosⁿ of the angle of emission", default=0.0)
    sampling: str = choice("solid angle", "area", meaning="over what directions are evenly distributed")

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L cosⁿ for directions (N, 3) that meet the disk's bright side, 0 for the others."""
        seen = self._seen(position)
        if seen is None:
            return weighted(np.zeros(len(direction)), self.radiance)
        emission = np.maximum(-(direction @ np.array(self.normal)), 0.0)
        return weighted(np.where(seen.near(direction), emission**self.exponent, 0.0), self.radiance)

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
        if self.sampling == "area":
            return self._over_area(u, seen)
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
        if self.sampling == "area":
            emission = -(direction @ np.array(self.normal))
            return np.where(seen.near(direction), _per_area(emission, seen.view), 0.0)
        a, b = seen.view.semi_axes
        kappa = math.hypot(1.0, a) / math.hypot(1.0, b)
        local = direction @ seen.axes.T
        x, y = local[:, 0] / a, local[:, 1] / b
        top, bottom = np.hypot(x, y), np.hypot(x, y / kappa)
        flat = np.divide(top, bottom, out=np.ones_like(top), where=bottom > 0) ** 2
        return np.where(seen.near(direction), _density(a, b, kappa, flat), 0.0)

    def _over_area(self, u: FloatArray, seen: Plate) -> tuple[FloatArray, FloatArray]:
        radius, turn = seen.view.radius * np.sqrt(u[:, 0]), 2.0 * np.pi * u[:, 1]
        local = np.stack((radius * np.cos(turn), radius * np.sin(turn), np.zeros(len(u))), axis=-1)
        points = np.array([float(x) for x in seen.towards]) + to_world(frame(self.normal), local)
        direction = points / np.sqrt(np.sum(points * points, axis=1))[:, None]
        return direction, _per_area(-(direction @ np.array(self.normal)), seen.view)

    def pieces(self, position: FloatArray, normal: FloatArray) -> Sequence[Emitter]:
        """Return what of the disk is above a receiver's horizon."""
        seen = self._seen(position)
        if seen is None:
            return ()
        horizon = against(normal, seen.normal, seen.towards, seen.radius)
        if horizon.hidden <= 0:
            return (self,) if horizon.along > 0 else ()
        up, share = np.asarray(normal, dtype=float), horizon.towards / horizon.length
        # The level part of the way across to the plane: the chord is square to it.
        level = [-m - share * n for m, n in zip(seen.normal, horizon.up, strict=True)]
        largest = max(map(abs, level))
        side = unit([float(x / largest) for x in level])
        chord = np.cross(up, side)
        aside = inner(cross(horizon.up, seen.normal), seen.towards)
        patch = DiskPatch(
            axes=np.stack((chord, side, up)),
            turn=horizon.turn,
            radius=seen.view.radius,
            depth=seen.view.depth,
            aside=-math.copysign(horizon.aside, aside),
            slope=horizon.slope,
            facing=horizon.facing,
        )
        radiance = None if self.exponent else self.radiance
        return (Piece(light=self, patch=patch, radiance=radiance, precision=tilted(patch, up)),)

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
            return Estimate(0.0, 0.0, "rounding", method="closed form").scaled(amount(self.radiance))
        radiance = amount(self.radiance)
        if not self.exponent:
            return seen.irradiance(normal).scaled(radiance)
        view, horizon = seen.view, against(normal, seen.normal, seen.towards, seen.radius)
        if horizon.hidden <= 0 and horizon.along <= 0:
            return Estimate(0.0, 0.0, "rounding", method="closed form").scaled(radiance)
        if horizon.hidden > 0 or view.offset > 0:
            return None
        power = self.exponent + 2.0
        share = -math.expm1(-0.5 * power * math.log1p((view.radius / view.depth) ** 2))
        value = horizon.facing * 2.0 * math.pi / power * share
        return Estimate(value, 16 * _EPS * value, "rounding", method="closed form").scaled(radiance)

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

        Raises
        ------
        ParameterError
            When it is beyond the range of floats.

        >>> lamp = Disk(center=(0, 0, 2), normal=(0, 0, -1), radius=2, radiance=1.0, exponent=2)
        >>> round(float(lamp.flux().value) / np.pi**2, 12)
        2.0
        """
        share = 2.0 * math.pi / (self.exponent + 2.0)
        with np.errstate(over="ignore"):
            value = share * math.pi * self.radius * self.radius * amount(self.radiance)
        return flux_estimate(value, 8, radius=self.radius)

    def _seen(self, position: FloatArray) -> Plate | None:
        """Return what a point sees of the disk, or None behind it and in its plane."""
        return Plate.seen(self.center, self.normal, self.radius, position)


def _per_area(emission: FloatArray, view: DiskView) -> FloatArray:
    """Return r²/(A cosθ), with θ at the disk, by its cosine: a² / (A cos³θ)."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        density = (view.depth / view.radius) ** 2 / (np.pi * emission**3)
    return np.where(emission > 0, np.minimum(density, np.finfo(float).max), 0.0)


def _density(a: float, b: float, kappa: float, flat: FloatArray) -> FloatArray:
    far = math.hypot(1.0, a)
    return far / a * ((far + np.sqrt(flat)) / b) / (2.0 * np.pi * kappa)
