"""Sphere: a ball that shines alike everywhere and in all directions, seen as a circular cone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.chords import CapPatch
from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import Spectrum, choice, parameter
from radiokit.contracts.piece import Piece, tilted
from radiokit.contracts.spectral import amount, flux_estimate, weighted
from radiokit.contracts.vectors import vector
from radiokit.facts.directions import frame, to_world, unit
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.exact import inner, rational, root
from radiokit.measure.warps import UniformCone
from radiokit.physics.ball import Ball
from radiokit.physics.cap import CAP_SOURCE

__all__ = ["Sphere"]

FloatArray = npt.NDArray[np.float64]

_MOST = float(np.finfo(float).max)


@dataclass(frozen=True, kw_only=True)
class Sphere(Emitter):
    """A sphere of uniform radiance: a globe lamp, or the sun as the disk that it appears to be.

    Parameters
    ----------
    center : tuple of 3 floats
        [m].
    radius : float
        [m], in (0, 1e150].
    radiance : float, or sequence of K floats
        Radiance L [W m⁻² sr⁻¹], in [0, 1e100]; one number, or one a wavelength.
    sampling : {"solid angle", "area"}
        Over what its directions are sampled evenly: the solid angle, or the area that is seen.

    Raises
    ------
    ParameterError
        When ``center`` is not three finite numbers, or another parameter is out of its range; from the
        methods, when the receiver is inside the sphere or on it.

    >>> lamp = Sphere(center=(0, 0, 4), radius=1, radiance=1.0)
    >>> up = np.array([0.0, 0.0, 1.0])
    >>> round(float(lamp.irradiance_at(np.zeros(3), up).value) / np.pi, 15)  # (R/d)²
    0.0625
    """

    name: ClassVar[str] = "sphere"
    SOURCE: ClassVar[Source] = CAP_SOURCE

    center: tuple[float, float, float] = vector("point", "m", "the sphere's centre")
    radius: float = parameter("(0, 1e150]", "m", "the sphere's radius")
    radiance: Spectrum = parameter(
        "[0, 1e100]", "W/m^2/sr", "radiance, the same everywhere and in all directions", spectral=True
    )
    sampling: str = choice("solid angle", "area", meaning="over what directions are evenly distributed")

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L for directions (N, 3) that meet the sphere, 0 for the others."""
        return weighted(self._view(position).near(direction), self.radiance)

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3) within the cone, and densities [sr⁻¹].

        Source: Shirley, Wang, Zimmerman (1996), Monte Carlo techniques for direct lighting calculations,
        doi:10.1145/226150.226151, section 3.
        """
        view = self._view(position)
        if self.sampling == "area":
            return _over_area(u, view)
        cone = UniformCone(half_angle=math.atan2(view.sine, view.cosine))
        return to_world(frame(view.axis), cone.sample(u)), np.full(len(u), 1.0 / _cone(view))

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the density of ``sample`` [sr⁻¹]: 1/Ω, or r²/(A cosθ), in the cone, and 0 outside."""
        view = self._view(position)
        density: Any = 1.0 / _cone(view)
        if self.sampling == "area":
            density = _per_area(np.sqrt(np.sum((direction - view.axis) ** 2, axis=1)), view)
        return np.where(view.near(direction), density, 0.0)

    def pieces(self, position: FloatArray, normal: FloatArray) -> Sequence[Emitter]:
        """Return what of the sphere is above a receiver's horizon."""
        view, n = self._view(position), rational(normal)
        length, along = inner(n, n), inner(n, view.towards)
        hidden = view.radius**2 * length - along * along
        if hidden <= 0:
            return (self,) if along > 0 else ()
        level = [x - along / length * y for x, y in zip(view.towards, n, strict=True)]
        largest = max(map(abs, level))
        side, up = unit([float(x / largest) for x in level]), np.asarray(normal, dtype=float)
        patch = CapPatch(
            axes=np.stack((np.cross(up, side), side, up)),
            turn=math.atan2(root(hidden), math.copysign(root(along * along), -along)),
            sine=view.sine,
            cosine=view.cosine,
        )
        return (Piece(light=self, patch=patch, radiance=self.radiance, precision=tilted(patch, up)),)

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return Ω = 4π sin²(σ/2) [sr], with sinσ = R/d: 2π for a sphere touched."""
        return self._view(position).solid_angle()

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return E [W m⁻²] on a receiver of any tilt: πL (R/d)² cosθ, less what the horizon hides.

        Whether the horizon cuts the sphere, and by how much, is decided in rational arithmetic, so that the
        relative error is that of a few operations for every sphere and every tilt.
        """
        return self._view(position).irradiance(normal).scaled(amount(self.radiance))

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the sphere is along directions (N, 3) that meet it."""
        return self._view(position).distance(direction)

    def silhouette(self, position: FloatArray) -> Silhouette:
        """Return the ball, evenly bright."""
        return Silhouette(self._view(position), self.radiance)

    def flux(self) -> Estimate:
        """Return the radiant flux Φ = πL · 4πR² [W].

        Raises
        ------
        ParameterError
            When it is beyond the range of floats.

        >>> round(float(Sphere(center=(0, 0, 4), radius=2, radiance=1.0).flux().value) / np.pi**2, 12)
        16.0
        """
        with np.errstate(over="ignore"):
            value = 4.0 * math.pi**2 * self.radius * self.radius * amount(self.radiance)
        return flux_estimate(value, 4, radius=self.radius)

    def _view(self, position: FloatArray) -> Ball:
        ball = Ball.seen(self.center, self.radius, position)
        if ball.tangent <= 0:
            allowed = f"outside the sphere of radius {self.radius!r} around {self.center}"
            raise ParameterError("position", tuple(map(float, position)), allowed)
        if ball.sine < 1e-100:
            allowed = "nearer to the sphere, which is a point light at more than 1e100 radii"
            raise ParameterError("position", tuple(map(float, position)), allowed)
        return ball


def _over_area(u: FloatArray, view: Ball) -> tuple[FloatArray, FloatArray]:
    """Return directions to points spread evenly over what is seen of the surface, and their densities.

    In units of the distance d, with γ the point's angle at the centre from the way to the receiver and
    g = 1 − cosγ at most 1 − R/d.
    """
    facing = view.cosine * view.cosine / (1.0 + view.sine)  # 1 − R/d
    g = u[:, 0] * facing
    across, along = view.sine * np.sqrt(g * (2.0 - g)), facing + view.sine * g
    length = np.hypot(across, along)
    sine, cosine = across / length, along / length
    turn = 2.0 * np.pi * u[:, 1]
    local = np.stack((sine * np.cos(turn), sine * np.sin(turn), cosine), axis=-1)
    # The surface turns from the ray by cosθ = (cosγ − R/d)/r, which is 0 at the rim.
    with np.errstate(divide="ignore"):
        density = length**3 / (2.0 * np.pi * view.sine**2 * facing * (facing - g))
    return to_world(frame(view.axis), local), np.minimum(density, _MOST)


def _per_area(chord: FloatArray, view: Ball) -> FloatArray:
    """Return r²/(A cosθ) for directions at a distance from the axis' unit vector."""
    sine = chord * np.sqrt(np.maximum(1.0 - 0.25 * chord * chord, 0.0))
    slant = np.sqrt(np.maximum((view.sine - sine) * (view.sine + sine), 0.0))  # R/d cosθ
    length = view.cosine * view.cosine / (np.sqrt((1.0 - sine) * (1.0 + sine)) + slant)
    facing = view.cosine * view.cosine / (1.0 + view.sine)
    with np.errstate(divide="ignore"):
        density = length * length / (2.0 * np.pi * view.sine * facing * slant)
    return np.minimum(density, _MOST)


def _cone(view: Ball) -> float:
    """Return 2π (1 − cosσ)."""
    return 2.0 * math.pi * view.sine * view.sine / (1.0 + view.cosine)
