"""Exact: the rooms whose light is known in closed form, and what it is there.

Two arguments serve. In a diffuse sphere every part sends every other the share of its flux that the other
takes of the area, whatever it looks like, so one balance gives the interreflected irradiance. In a room in
which each wall emits (1 − ρ)L, with ρ the same for all directions, the radiance is L everywhere, as in
Kirchhoff's cavity: what a wall does not reflect of L it emits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.bsdfs.mirror import Mirror
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.mixture import Mixture
from radiokit.contracts.spectral import amount
from radiokit.emitters.point import Point
from radiokit.facts.estimate import Estimate
from radiokit.worlds.enclosure.rooms import FloatArray, Room, Wall
from radiokit.worlds.enclosure.sphere import Sphere

__all__ = ["Light", "constant_albedo", "known_light"]

_EPS = float(np.finfo(float).eps)
_ALIKE = 1e-12  # relative difference of temperatures that are meant to be one


@dataclass(frozen=True)
class Light:
    """The light in a room whose answer is known.

    With ``isothermal`` its radiance is ``value`` everywhere, and otherwise ``value`` is the irradiance that
    interreflection adds at every point of a sphere; lamps and a wall's own emission come on top. ``error``
    bounds it. Both are of shape () or (K,).
    """

    room: Room
    value: Any
    error: Any
    isothermal: bool

    def irradiance(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return the irradiance [W m⁻²] of a wall point (3,)."""
        if self.isothermal:
            return _bounded(math.pi * self.value, math.pi * self.error)
        value, error = self.value, self.error
        for light in self.room.lights:
            found = light.irradiance_at(position, normal)
            assert found is not None
            # The point itself is rounded, and 1/r² and cosθ of a lamp near by feel it.
            near = 8 * _EPS * _reach(self.room, position, light) * np.abs(found.value)
            value, error = value + found.value, error + found.error + near
        return _bounded(value, error + 4 * _EPS * np.abs(value))

    def radiance(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return the radiance [W m⁻² sr⁻¹] that leaves a wall point (3,), the same in all directions."""
        if self.isothermal:
            return _bounded(self.value, self.error)
        wall = self.room.parts[int(self.room.part_of(position[None, :])[0])]
        rho, emitted = _number(constant_albedo(wall)), _number(wall.emitted)
        found = self.irradiance(position, normal)
        value = emitted + rho * found.value / math.pi
        return _bounded(value, rho * found.error / math.pi + 4 * _EPS * value)

    def flux(self, part: int) -> Estimate:
        """Return the flux [W] that falls on a part."""
        area = self.room.area(part)
        if self.isothermal:
            return _bounded(math.pi * area * self.value, math.pi * area * self.error)
        assert isinstance(self.room, Sphere)
        value, error = area * self.value, area * self.error
        for light in self.room.lights:
            sent, off = _direct(self.room, light)
            value, error = value + sent[part], error + off
        return _bounded(value, error + 16 * _EPS * np.abs(value))


def _bounded(value: Any, error: Any) -> Estimate:
    return Estimate(value, error + 8 * _EPS * np.abs(value), "rounding", method="closed form")


def _number(value: Any) -> Any:
    return np.asarray(value)[()]


def _reach(room: Room, position: FloatArray, light: Any) -> float:
    """Return the room's extent over the lamp's distance from a point."""
    size = math.sqrt(sum(room.area(part) for part in range(len(room.parts))))
    return 1.0 + (size + float(np.linalg.norm(position))) / math.dist(position, light.position)


def constant_albedo(wall: Wall) -> Any:
    """Return the albedo () or (K,) of a wall if it is known to be the same for every direction, else None.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> constant_albedo(Wall(f=0.5 * Lambert(reflectance=0.6) + 0.5 * Mirror(reflectance=0.8))).item()
    0.7
    """
    return 0.0 if wall.f is None else _albedo(wall.f)


def _albedo(f: BSDF) -> Any:
    diffuse: Any = f.diffuse_reflectance()
    if diffuse is not None:
        return diffuse
    if isinstance(f, Mirror):
        return np.asarray(f.reflectance)
    if isinstance(f, Mixture):
        parts = [_albedo(g) for g in f.components]
        if any(part is None for part in parts):
            return None
        return sum(np.asarray(w) * part for w, part in zip(f.weights, parts, strict=True))
    return None  # also where a model claims to be lossless: that is true to a tolerance only


def _worn(wall: Wall) -> float:
    """Return by how much an albedo that is a sum of rounded products may be off."""
    return 4 * _EPS * len(wall.f.components) if isinstance(wall.f, Mixture) else 0.0


def known_light(room: Room) -> Light | None:
    """Return the light in a room if there is a closed form for it, else None."""
    return _isothermal(room) or (_balance(room) if isinstance(room, Sphere) else None)


def _isothermal(room: Room) -> Light | None:
    """Return the light of a room in which every wall emits (1 − ρ) L with the same L, without lamps."""
    if any(np.any(light.intensity) if isinstance(light, Point) else True for light in room.lights):
        return None
    albedos = [constant_albedo(wall) for wall in room.parts]
    if any(albedo is None for albedo in albedos):
        return None
    low: Any = np.inf
    high: Any = -np.inf
    blur: Any = 0.0
    for wall, albedo in zip(room.parts, albedos, strict=True):
        emitted, absorbed = np.asarray(wall.emitted), 1.0 - np.asarray(albedo)
        emitted, absorbed = np.broadcast_arrays(emitted, absorbed)
        if np.any(absorbed < 0) or np.any((absorbed == 0) & (emitted > 0)):
            return None
        if np.any(absorbed == 0) and (claims := wall.f.claims) is not None and claims.delta:
            return None  # between perfect mirrors light may circle for ever and meet nothing else
        level = np.divide(emitted, absorbed, out=np.full(emitted.shape, np.nan), where=absorbed > 0)
        low, high = np.fmin(low, level), np.fmax(high, level)
        worn = np.divide(_worn(wall), absorbed, out=np.zeros(emitted.shape), where=absorbed > 0)
        blur = np.fmax(blur, worn)
    if not (np.all(np.isfinite(low)) and np.all(high - low <= _ALIKE * high)):
        return None
    # What each wall emits lies between those of two isothermal rooms, and so does the light.
    value, error = np.broadcast_arrays(low + (high - low) / 2, (high - low) / 2 + (2 * _EPS + blur) * high)
    shape = () if room.wavelengths is None else (room.wavelengths,)
    return Light(room, np.broadcast_to(value, shape)[()], np.broadcast_to(error, shape)[()], True)


def _balance(room: Sphere) -> Light | None:
    """Return the light of a sphere that is diffuse throughout."""
    rho = [wall.f.diffuse_reflectance() if wall.f is not None else 0.0 for wall in room.parts]
    if any(each is None for each in rho):
        return None
    rho = [np.asarray(each) for each in rho]
    if not all(isinstance(light, Point) or len(rho) == 1 for light in room.lights):
        return None
    shares = room.shares
    area = 4.0 * math.pi * room.radius * room.radius
    mean = sum(share * (1.0 - each) for share, each in zip(shares, rho, strict=True))
    if np.any(mean == 0):
        return None
    off: Any = 8 * _EPS * mean + 4 * _EPS * (1.0 - rho[0])  # the wall's share is a difference from 1
    off = off + sum(share * _worn(wall) for share, wall in zip(shares, room.parts, strict=True))
    leaving: Any = sum(
        math.pi * area * share * np.asarray(wall.emitted)
        for share, wall in zip(shares, room.parts, strict=True)
    )
    error = 4 * _EPS * math.pi * area * np.asarray(room.wall.emitted) + 16 * _EPS * leaving
    for light in room.lights:
        sent, rounded = _direct(room, light)
        leaving = leaving + sum(each * flux for each, flux in zip(rho, sent, strict=True))
        error = error + rounded * len(sent)
    value = leaving / area / mean
    error = (error + leaving * (8 * _EPS + off / mean)) / area / mean
    shape = () if room.wavelengths is None else (room.wavelengths,)
    value, error = np.broadcast_to(value, shape), np.broadcast_to(error, shape)
    return Light(room, value[()], error[()], False)


def _direct(room: Sphere, light: Any) -> tuple[FloatArray, Any]:
    """Return the flux [W] that each part receives from a lamp, (P,) or (P, K), and a bound of its error."""
    if not isinstance(light, Point):  # the sphere is of one piece, which receives all
        whole = light.flux()
        return np.array([whole.value]), whole.error
    angles, error = room.solid_angles(np.array(light.position))
    strength = amount(light.intensity)
    return np.multiply.outer(angles, strength), strength * (error + 16 * _EPS * math.pi)
