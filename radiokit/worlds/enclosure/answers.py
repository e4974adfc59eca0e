"""Answers: radiance and irradiance at a point of a room's wall, and the flux that falls on a part of it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.vectors import as_point
from radiokit.facts.checking import check_above_zero, reject
from radiokit.facts.directions import check_directions, dot
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.facts.estimate import Estimate
from radiokit.measure.montecarlo import mean
from radiokit.worlds.enclosure.exact import Light, known_light
from radiokit.worlds.enclosure.rooms import FloatArray, Room
from radiokit.worlds.enclosure.walk import BLOCK, fluxes, irradiances, radiances

__all__ = ["METHODS", "flux", "irradiance", "radiance"]

METHODS = ("auto", "closed form", "random walk")
"""What the questions of this module understand."""

SAMPLES, MOST_SAMPLES = 1 << 16, 1 << 24
"""Paths by default, and at most when a relative error is asked for."""


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
    position : array_like, shape (3,) or (N, 3)
        On the wall [m], to within 1e-9 of the room's size.
    direction : array_like, shape (3,) or (N, 3)
        Unit vector from the wall into the room; one for all points, or one for each.
    method : {"auto", "closed form", "random walk"}
        The closed form serves diffuse spheres with isotropic point lights, or any point lights if there are
        no caps, and rooms in which each wall emits the same multiple of what it absorbs (1 − ρ, the same for
        all directions); ``auto`` takes it where it applies.
    samples : int, optional
        Paths from each point; with ``rtol`` or ``seconds`` the most that are followed. By default 2¹⁶, with
        ``rtol`` at most 2²⁴, and with ``seconds`` as many as there is time for. An estimate's ``evaluations``
        counts them.
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
        Of shape () or (N,), with (..., K) for K wavelengths.

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
    points = _Points.of(room, position)
    towards = check_directions("direction", direction)
    if towards.shape not in ((3,), (*points.shape, 3)):
        raise ParameterError(
            "direction", towards.shape, f"of shape (3,), or as position is, {points.place.shape}"
        )
    towards = np.broadcast_to(towards, points.place.shape)
    reject("direction", towards, ~(dot(towards, points.normal) > 0), "into the room")
    draw = partial(radiances, room, points.place, towards)
    return _answer(room, effort, draw, lambda light: points.each(light.radiance), points.shape)


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

    Parameters
    ----------
    room : Sphere or Box
    position : array_like, shape (3,) or (N, 3)
        Of the points [m], on the room's wall.
    method, samples, rtol, seconds, rng, executor
        As for ``radiance``.

    Raises
    ------
    ParameterError
        When a point is not on the wall, or another argument is out of its range.
    UnknownNameError
        When there is no such method.

    >>> from radiokit.bsdfs.lambert import Lambert
    >>> from radiokit.worlds.enclosure import Box, Wall
    >>> room = Box(walls=Wall(f=Lambert(reflectance=0.75), emitted=1.0))
    >>> round(float(irradiance(room, position=(0.5, 0.5, 0.0))) / np.pi, 12)
    4.0
    """
    effort = _Effort(method, samples, rtol, seconds, rng, executor)
    points = _Points.of(room, position)
    draw = partial(irradiances, room, points.place, points.normal)
    return _answer(room, effort, draw, lambda light: points.each(light.irradiance), points.shape)


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
        As for ``radiance``.

    Raises
    ------
    ParameterError
        When there is no such part, or another argument is out of its range.
    UnknownNameError
        When there is no such method.

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
    return _answer(room, effort, partial(fluxes, room, part), lambda light: light.flux(part))


def _check_room(room: Any) -> None:
    if not isinstance(room, Room):
        raise ParameterError("room", room, "a Sphere or a Box")


@dataclass(frozen=True)
class _Points:
    """Points (N, 3) of a wall with their normals; ``shape`` is () for a single one and (N,) for many."""

    place: FloatArray
    normal: FloatArray
    shape: tuple[int, ...]

    @classmethod
    def of(cls, room: Any, position: npt.ArrayLike) -> _Points:
        _check_room(room)
        many = np.ndim(position) == 2 and np.size(position) > 0
        given = [as_point("position", each) for each in (np.asarray(position) if many else [position])]
        found = [room.snap(np.array(each)) for each in given]
        for each, snapped in zip(given, found, strict=True):
            if snapped is None:
                raise ParameterError("position", each, "on the room's wall")
        place = np.array(found)
        return cls(place, room.normals(place, room.part_of(place)), (len(place),) if many else ())

    def each(self, ask: Callable[[FloatArray, FloatArray], Estimate]) -> Estimate:
        """Return the closed-form answers of all points as one."""
        found = [ask(place, normal) for place, normal in zip(self.place, self.normal, strict=True)]
        if not self.shape:
            return found[0]
        value, error = (np.array([getattr(one, name) for one in found]) for name in ("value", "error"))
        return replace(found[0], value=value, error=error)


def _answer(
    room: Room,
    effort: _Effort,
    draw: Callable[[np.random.Generator, int], FloatArray],
    exactly: Callable[[Light], Estimate],
    shape: tuple[int, ...] = (),
) -> Estimate:
    """Return the answer in closed form or by following paths."""
    if effort.method not in METHODS:
        raise UnknownNameError("method", effort.method, METHODS)
    check_above_zero(rtol=effort.rtol, seconds=effort.seconds)
    start = time.perf_counter()
    if all(wall.absorbs_nothing for wall in room.parts):
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
    found = mean(
        draw,
        samples=most,
        rng=effort.rng,
        block=max(1, BLOCK // math.prod(shape)),
        rtol=effort.rtol,
        seconds=effort.seconds,
        executor=effort.executor,
        method="random walk",
    )
    if not shape:
        return found
    shape = shape if room.wavelengths is None else (*shape, room.wavelengths)
    return replace(found, value=np.reshape(found.value, shape), error=np.reshape(found.error, shape))
