"""Shadowed: a light behind opaque bodies, as a light of its own, exact where its shadows' edges are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.occluder import Occluder, blocked
from radiokit.contracts.piece import Piece, tilted
from radiokit.contracts.sight import Sight, sight
from radiokit.contracts.spectral import times
from radiokit.facts.estimate import Estimate

__all__ = ["Shadowed", "shadowed"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_EPS = float(np.finfo(float).eps)
_NOTHING = Estimate(0.0, 0.0, "rounding", method="closed form")


def shadowed(light: Emitter, occluders: Sequence[Occluder], position: FloatArray) -> Emitter:
    """Return a light as ``position`` (3,) sees it behind occluders: itself, if none of them hides any of it.

    Raises
    ------
    ParameterError
        When ``position`` is on an occluder or a light.
    """
    behind = Shadowed(light=light, occluders=tuple(occluders))
    return behind if occluders and behind.hides(position) else light


@dataclass(frozen=True, kw_only=True)
class Shadowed(Emitter):
    """A light with opaque bodies in front of it.

    Occluders that hide nothing of it from where the receiver is do not count: those beside its cone or beyond
    it. The rest is exact for what is hidden wholly, for polygons in front of polygons and even skies however
    they overlap, and for bodies whose cones lie apart from each other within an evenly bright light.

    Parameters
    ----------
    light : Emitter
    occluders : tuple of Occluder

    >>> from radiokit.contracts.emitter import emitter
    >>> from radiokit.contracts.occluder import occluder
    >>> sky, ball = emitter("constant"), occluder("sphere", center=(0, 0, 2), radius=1)
    >>> seen = Shadowed(light=sky, occluders=(ball,))
    >>> left = seen.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    >>> round(float(left.value) / np.pi, 14)  # 1 − (R/d)²
    0.75
    """

    light: Emitter
    occluders: tuple[Occluder, ...]
    delta: ClassVar[bool] = False

    def __post_init__(self) -> None:
        bodies = " and ".join(dict.fromkeys(item.name for item in self.occluders))
        object.__setattr__(self, "name", f"{self.light.name} behind {bodies}")
        object.__setattr__(self, "delta", self.light.delta)

    def hides(self, position: FloatArray) -> bool:
        """Return whether an occluder may hide some of the light from ``position`` (3,)."""
        return bool(self._sight(position).bodies)

    def visible(self, direction: FloatArray, position: FloatArray) -> BoolArray:
        """Return whether nothing is before the light along directions (N, 3)."""
        if self._sight(position).dark:
            return np.zeros(len(direction), dtype=bool)
        reach = self.light.distance_along(direction, position)
        found = np.ones(len(direction), dtype=bool)
        for body in self._sight(position).bodies:
            found[found] = ~blocked(body, direction[found], reach[found])
        return found

    # --- what every light does ---

    @property
    def wavelengths(self) -> int | None:
        """Those of the light."""
        return self.light.wavelengths

    def incident(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the directions of a delta light that are not blocked, and their irradiances."""
        directions, arriving = self.light.incident(position)
        seen = self.visible(directions, position)
        return directions[seen], arriving[seen]

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the light's radiance, 0 where it is hidden."""
        value = self.light.radiance_from(direction, position)
        return times(value, self.visible(direction, position))

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Sample the whole light, what is hidden of it as well."""
        return self.light.sample(u, position)

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the density of ``sample`` [sr⁻¹]."""
        return self.light.pdf(direction, position)

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light is."""
        return self.light.distance_along(direction, position)

    def dome(self, position: FloatArray) -> tuple[FloatArray, ...] | None:
        """Return the light's own dome, or None where something is in front of it."""
        return None if self.hides(position) else self.light.dome(position)

    def flux(self) -> Estimate | None:
        """Return the flux [W] that the light sends out, whatever stops it on its way."""
        return self.light.flux()

    # --- what is left of it ---

    def pieces(self, position: FloatArray, normal: FloatArray) -> Sequence[Emitter] | None:
        """Return the parts of the light that are lit, each smooth; None where their edges are not known."""
        sight = self._sight(position)
        found = sight.above(normal)
        if not found.bodies:
            return self.light.pieces(position, normal)
        if found.dark:
            return ()
        patches = found.patches(normal)
        if patches is None or sight.silhouette is None:
            return None
        radiance = sight.silhouette.radiance
        return [
            Piece(light=self.light, patch=patch, radiance=radiance, precision=tilted(patch, normal))
            for patch in patches
        ]

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return the solid angle [sr] of what is seen of the light, by the sizes of its patches at the worst.

        ``converged`` is False, and the bound all that could be hidden, where neither is known.
        """
        sight = self._sight(position)
        whole = self.light.solid_angle(position)
        if self.delta or not sight.bodies:
            return whole
        if sight.dark:
            return _NOTHING
        found = sight.solid_angle(whole)
        if found is not None:
            return found
        value = 0.5 * float(whole.value)
        note = "no closed form for what is hidden"
        return Estimate(value, value + whole.error, "truncation", method="bound", converged=False, note=note)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate | None:
        """Return the closed-form irradiance [W m⁻²] of what is seen, or None where there is none."""
        if self.delta:
            directions, arriving = self.light.incident(position)
            seen = self.visible(directions, position)
            if np.all(seen):
                return self.light.irradiance_at(position, normal)
            cosine = np.maximum(directions[seen] @ normal, 0.0)
            value = np.sum(times(arriving[seen], cosine), axis=0)[()]
            bound = 8 * _EPS * np.sum(arriving[seen], axis=0)[()]
            return Estimate(value, bound, "rounding", method="closed form")
        found = self._sight(position).above(normal)
        if not found.bodies:
            return self.light.irradiance_at(position, normal)
        if found.dark:
            return _NOTHING if self.wavelengths is None else _NOTHING.scaled(np.zeros(self.wavelengths))
        return found.irradiance(normal)

    def _sight(self, position: FloatArray) -> Sight:
        return _sight(self, tuple(np.asarray(position, dtype=float).tolist()))


@lru_cache(maxsize=64)
def _sight(behind: Shadowed, position: tuple[float, ...]) -> Sight:
    return sight(behind.light, behind.occluders, np.array(position))
