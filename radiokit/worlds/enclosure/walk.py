"""Walk: paths that start at a wall and gather, bounce by bounce, what walls emit and lamps send.

At each wall that a path meets, the wall's own emission and the reflected light of every lamp are added; then
a direction is sampled from the wall's material and followed to the next wall. At every bounce Russian
roulette lets a path live with a chance equal to its throughput, which those that do live are given back: no
bias, and no last bounce.
"""

from __future__ import annotations

import numpy as np

from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.combining import in_delta
from radiokit.emitters.rectangle import Rectangle
from radiokit.facts.directions import dot, frame, to_local, to_world
from radiokit.facts.errors import RadiokitError
from radiokit.worlds.enclosure.lamps import arriving, shown
from radiokit.worlds.enclosure.rooms import FloatArray, IndexArray, Room

__all__ = ["BLOCK", "fluxes", "gather", "irradiances", "radiances"]

BLOCK = 8192
"""Paths in a block."""

_MEAN_BOUNCES = 5000  # of all paths in a block; an albedo of 0.999 needs 1000


def gather(
    room: Room,
    position: FloatArray,
    direction: FloatArray,
    generator: np.random.Generator,
    *,
    panels: bool = True,
) -> FloatArray:
    """Return the radiance that leaves points (N, 3) of the wall in unit directions (N, 3).

    Parameters
    ----------
    room : Room
    position, direction : ndarray, shape (N, 3)
        World coordinates; the directions point into the room.
    generator : numpy.random.Generator
    panels : bool
        Whether the first points show the panels that they lie on. Later points do only in delta lobes:
        through all else a panel is looked for from where it shines to, and must not be counted twice.

    Returns
    -------
    ndarray, shape (N, K)
        With K = 1 where the room has no wavelengths.

    Raises
    ------
    RadiokitError
        When the paths do not end.
    """
    n = len(position)
    total = np.zeros((n, room.wavelengths or 1))
    throughput = np.ones_like(total)
    path = np.arange(n)
    sees = np.full(n, panels)
    has_panels = any(isinstance(light, Rectangle) for light in room.lights)
    bounces = 0
    while len(path):
        bounces += len(path)
        if bounces > _MEAN_BOUNCES * n:
            walls = ", ".join(repr(wall.f) for wall in dict.fromkeys(room.parts) if not wall.black)
            raise RadiokitError(
                f"after {_MEAN_BOUNCES} bounces for each path there is no end: the albedo of {walls} is 1 "
                "or more, or nearly so, and the radiance diverges or cannot be sampled"
            )
        part = room.part_of(position)
        axes = frame(room.normals(position, part))
        wo = to_local(axes, direction)
        lamps = arriving(room.lights, position, generator)
        if has_panels:
            total[path] += throughput * np.where(sees[:, None], shown(room.lights, position), 0.0)
        sees = np.zeros(len(path), dtype=bool)
        alive = np.zeros(len(path), dtype=bool)
        onward = np.empty_like(wo)
        for number, wall in enumerate(room.parts):
            rows = np.flatnonzero(part == number)
            if not len(rows):
                continue
            total[path[rows]] += throughput[rows] * np.asarray(wall.emitted)
            if wall.black:
                continue
            total[path[rows]] += throughput[rows] * _lit(wall.f, axes[rows], wo[rows], lamps, rows)
            u = generator.random((len(rows), wall.f.dimensions + 1))
            wi, weight = wall.f.sample(u[:, :-1], wo[rows])
            carried = throughput[rows] * weight.reshape(len(rows), -1)
            survival = np.minimum(carried.max(axis=1), 1.0)
            keep = (u[:, -1] < survival) & (wi[:, 2] > 0)
            stay = rows[keep]
            throughput[stay] = carried[keep] / survival[keep][:, None]
            onward[stay] = wi[keep]
            alive[stay] = True
            if has_panels:
                sees[stay] = in_delta(wall.f, wi[keep], wo[stay])
        path, throughput, sees = path[alive], throughput[alive], sees[alive]
        w = to_world(axes[alive], onward[alive])
        position, direction = room.follow(position[alive], w), -w
    return total


def _lit(
    f: BSDF, axes: FloatArray, wo: FloatArray, lamps: tuple[FloatArray, FloatArray], rows: IndexArray
) -> FloatArray:
    """Return the lamps' light that points of one material reflect: (N, K) or (N, 1)."""
    total = np.zeros((len(rows), 1))
    for towards, strength in zip(*lamps, strict=True):
        wi = to_local(axes, towards[rows])
        value = f.evaluate(wi, wo).reshape(len(rows), -1)
        total = total + value * np.maximum(wi[:, 2:], 0.0) * strength[rows]
    return total


def radiances(
    room: Room, place: FloatArray, towards: FloatArray, generator: np.random.Generator, n: int
) -> FloatArray:
    """Return n samples of the radiance from each of N points: (n, N), or (n, N K) for K wavelengths."""
    return _rows(room, gather(room, np.tile(place, (n, 1)), np.tile(towards, (n, 1)), generator), len(place))


def irradiances(
    room: Room, place: FloatArray, normal: FloatArray, generator: np.random.Generator, n: int
) -> FloatArray:
    """Return n samples of the irradiance of each of N points, as ``radiances`` does."""
    return _rows(room, _falling(room, np.tile(place, (n, 1)), np.tile(normal, (n, 1)), generator), len(place))


def fluxes(room: Room, part: int, generator: np.random.Generator, n: int) -> FloatArray:
    """Return n samples of the flux that falls on a part: (n,), or (n, K)."""
    position = room.spread(generator, n, part)
    normal = room.normals(position, np.full(n, part))
    return _rows(room, room.area(part) * _falling(room, position, normal, generator), 1)


def _rows(room: Room, values: FloatArray, points: int) -> FloatArray:
    single = points == 1 and room.wavelengths is None
    return values[:, 0] if single else values.reshape(-1, points * values.shape[1])


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
        found += np.maximum(dot(towards, normal), 0.0)[:, None] * strength
    return np.asarray(found)
