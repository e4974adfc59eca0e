"""Answers: radiance and irradiance at a point of a room's wall, and the flux that falls on a part of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.vectors import as_point
from radiokit.facts.directions import dot, frame, spherical_to_cartesian, to_world
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.facts.estimate import Estimate
from radiokit.measure.lattice import kronecker
from radiokit.measure.montecarlo import mean
from radiokit.worlds.enclosure.exact import Light, known_light
from radiokit.worlds.enclosure.lamps import arriving
from radiokit.worlds.enclosure.rooms import FloatArray, Room, Wall
from radiokit.worlds.enclosure.walk import BLOCK, gather
from radiokit.worlds.planning import check_direction

__all__ = ["METHODS", "SAMPLES", "absorbs_nothing", "flux", "irradiance", "radiance"]

METHODS = ("auto", "closed form", "random walk")
"""What the questions of this module understand."""

SAMPLES, MOST_SAMPLES = 1 << 16, 1 << 24
"""Paths by default, and at most when a relative error is asked for."""

_PROBE = spherical_to_cartesian([0.1, 0.7, 1.2, 1.5], [0.0, 2.0, 4.0, 5.0])


@dataclass(frozen=True)
class _Effort:
    """How an answer is looked for."""

    method: str
    samples: int | None
    rtol: float | None
    seconds: float | None
    rng: int | np.random.Generator | None
    executor: Executor | None


def radiance(
    room: Room,
    *,
    position: npt.ArrayLike,
    direction: npt.ArrayLike,
    method: str = "auto",
    samples: int | None = None,
    rtol: float | None = None,
    seconds: float | None = None,
    rng: int | np.random.Generator | None = None,
    executor: Executor | None = None,
) -> Estimate:
    """Return the radiance [W m⁻² sr⁻¹] that leaves a point of a wall, after any number of bounces.

    Parameters
    ----------
    room : Sphere or Box
    position : array_like, shape (3,)
        On the wall [m], to within 1e-9 of the room's size.
    direction : array_like, shape (3,)
        Unit vector from the wall into the room.
    method : {"auto", "closed form", "random walk"}
        The closed form serves diffuse spheres with isotropic point lights, and rooms in which each wall
        emits the same multiple of what it absorbs (1 − ρ, the same for all directions); ``auto`` takes it
        where it applies.
    samples : int, optional
        Paths; with ``rtol`` or ``seconds`` the most that are followed. By default 2¹⁶, with ``rtol`` at most
        2²⁴, and with ``seconds`` as many as there is time for. An estimate's ``evaluations`` counts paths.
    rtol : float, optional
        Stop once the standard error is within this share of the mean.
    seconds : float, optional
        Stop after so much time [s].
    rng : int, numpy.random.Generator or None
        The answer is the same for any number of workers.
    executor : concurrent.futures.Executor, optional
        Runs the blocks of paths.

    Returns
    -------
    Estimate
        Of shape () or (K,).

    Raises
    ------
    ParameterError
        When an argument is not allowed, or no wall absorbs anything: then the light grows without bound.
    UnknownNameError
        When there is no such method.
    RadiokitError
        When the closed form is asked for and there is none, or paths do not end.

    Source: Kajiya (1986), doi:10.1145/15886.15902, for the walk; Goebel (1967), doi:10.1364/AO.6.000125, for
    the sphere.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> from radiokit.emitters.point import Point
    >>> from radiokit.worlds.enclosure import Box, Sphere, Wall
    >>> room = Sphere(
    ...     wall=Wall(f=Lambert(reflectance=0.5)), lights=Point(position=(0, 0, 0), intensity=np.pi)
    ... )
    >>> round(float(radiance(room, position=(0, 0, -1), direction=(0, 0, 1))), 12)  # ρ/(1 − ρ) I/πR²
    1.0
    """
    effort = _Effort(method, samples, rtol, seconds, rng, executor)
    place, normal = _place(room, position)
    towards = check_direction("direction", direction)
    if not dot(towards, normal) > 0:
        raise ParameterError("direction", tuple(towards.tolist()), "into the room")
    draw = partial(_radiances, room, place, towards)
    return _answer(room, effort, draw, lambda light: light.radiance(place, normal))


def irradiance(
    room: Room,
    *,
    position: npt.ArrayLike,
    method: str = "auto",
    samples: int | None = None,
    rtol: float | None = None,
    seconds: float | None = None,
    rng: int | np.random.Generator | None = None,
    executor: Executor | None = None,
) -> Estimate:
    """Return the irradiance [W m⁻²] of a point of a wall, from the lamps and from all other walls.

    Parameters and errors are those of ``radiance``.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> from radiokit.worlds.enclosure import Box, Wall
    >>> room = Box(walls=Wall(f=Lambert(reflectance=0.75), emitted=1.0))
    >>> round(float(irradiance(room, position=(0.5, 0.5, 0.0))) / np.pi, 12)
    4.0
    """
    effort = _Effort(method, samples, rtol, seconds, rng, executor)
    place, normal = _place(room, position)
    draw = partial(_irradiances, room, place, normal)
    return _answer(room, effort, draw, lambda light: light.irradiance(place, normal))


def flux(
    room: Room,
    *,
    part: int,
    method: str = "auto",
    samples: int | None = None,
    rtol: float | None = None,
    seconds: float | None = None,
    rng: int | np.random.Generator | None = None,
    executor: Executor | None = None,
) -> Estimate:
    """Return the flux [W] that falls on a part of the wall: what leaves the room through a port.

    Parameters
    ----------
    room : Sphere or Box
    part : int
        0 for a sphere's wall and k for its k-th cap; 0 to 5 for the faces of a box at −x, +x, −y, +y, −z, +z.
    method, samples, rtol, seconds, rng, executor
        As for ``radiance``, whose errors are raised here too.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> from radiokit.worlds.enclosure import Cap, Sphere, Wall
    >>> hole = Cap(direction=(0, 0, 1), half_angle=np.arccos(0.8))  # a tenth of the area
    >>> room = Sphere(wall=Wall(f=Lambert(reflectance=1.0), emitted=1.0), caps=[hole])
    >>> round(float(flux(room, part=1)) / (4 * np.pi**2), 12)  # all that is emitted
    0.9
    """
    effort = _Effort(method, samples, rtol, seconds, rng, executor)
    _check_room(room)
    if not (type(part) is int and 0 <= part < len(room.parts)):
        raise ParameterError("part", part, f"one of the room's {len(room.parts)} parts, counted from 0")
    return _answer(room, effort, partial(_fluxes, room, part), lambda light: light.flux(part))


def _check_room(room: Any) -> None:
    if not isinstance(room, Room):
        raise ParameterError("room", room, "a Sphere or a Box")


def _place(room: Any, position: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return the wall's point (3,) and its normal (3,)."""
    _check_room(room)
    given = as_point("position", position)
    found = room.snap(np.array(given))
    if found is None:
        raise ParameterError("position", given, "on the room's wall")
    rows = found[None, :]
    return found, room.normals(rows, room.part_of(rows))[0]


def _answer(
    room: Room,
    effort: _Effort,
    draw: Callable[[np.random.Generator, int], FloatArray],
    exactly: Callable[[Light], Estimate],
) -> Estimate:
    """Return the answer in closed form or by following paths."""
    if effort.method not in METHODS:
        raise UnknownNameError("method", effort.method, METHODS)
    start = time.perf_counter()
    if all(absorbs_nothing(wall) for wall in room.parts):
        allowed = "with a wall that absorbs: with an albedo of 1 the radiance in a closed room diverges"
        raise ParameterError("room", room, allowed)
    light = known_light(room) if effort.method != "random walk" else None
    if light is not None:
        return replace(exactly(light), seconds=time.perf_counter() - start)
    if effort.method == "closed form":
        raise RadiokitError(
            "there is no closed form for this room: it is no diffuse sphere with isotropic point lights, and "
            "not all of its walls emit the same multiple of what they absorb. Use 'random walk'",
            method=effort.method,
        )
    most = effort.samples
    if most is None and effort.seconds is None:
        most = SAMPLES if effort.rtol is None else MOST_SAMPLES
    return mean(
        draw,
        samples=most,
        rng=effort.rng,
        block=BLOCK,
        rtol=effort.rtol,
        seconds=effort.seconds,
        executor=effort.executor,
        method="random walk",
    )


def absorbs_nothing(wall: Wall) -> bool:
    """Return whether every sample of every probed direction keeps all of its weight."""
    if wall.black:
        return False
    u = kronecker(64, wall.f.dimensions)
    for wo in _PROBE:
        _, weight = wall.f.sample(u, np.broadcast_to(wo, (len(u), 3)))
        if np.any(np.mean(weight, axis=0) < 1 - 1e-12):
            return False
    return True


def _shaped(room: Room, values: FloatArray) -> FloatArray:
    return values[:, 0] if room.wavelengths is None else values


def _radiances(
    room: Room, place: FloatArray, towards: FloatArray, generator: np.random.Generator, n: int
) -> FloatArray:
    return _shaped(room, gather(room, np.tile(place, (n, 1)), np.tile(towards, (n, 1)), generator))


def _irradiances(
    room: Room, place: FloatArray, normal: FloatArray, generator: np.random.Generator, n: int
) -> FloatArray:
    return _shaped(room, _falling(room, np.tile(place, (n, 1)), np.tile(normal, (n, 1)), generator))


def _fluxes(room: Room, part: int, generator: np.random.Generator, n: int) -> FloatArray:
    position = room.spread(generator, n, part)
    normal = room.normals(position, np.full(n, part))
    return _shaped(room, room.area(part) * _falling(room, position, normal, generator))


def _falling(
    room: Room, position: FloatArray, normal: FloatArray, generator: np.random.Generator
) -> FloatArray:
    """Return irradiances (N, K): the lamps', and π times the radiance from a cosine-weighted direction."""
    u = generator.random((len(position), 2))
    radius, phi = np.sqrt(u[:, 0]), 2.0 * np.pi * u[:, 1]
    local = np.stack([radius * np.cos(phi), radius * np.sin(phi), np.sqrt(1.0 - u[:, 0])], axis=-1)
    w = to_world(frame(normal), local)
    found = np.pi * gather(room, room.follow(position, w), -w, generator, panels=False)
    for towards, strength in zip(*arriving(room.lights, position, generator), strict=True):
        found += (np.maximum(dot(towards, normal), 0.0) * strength)[:, None]
    return np.asarray(found)
