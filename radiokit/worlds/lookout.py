"""Lookout: where in the square of a finite light its product with a lobe peaks, how narrowly, and on what map."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.measure.square import Axis, Focus

if TYPE_CHECKING:
    from radiokit.worlds.scene import Receiver

__all__ = ["Lookout", "look"]

FloatArray = npt.NDArray[np.float64]
_At = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

GRID = 16
"""Cells along each axis of the square in whose middle the product is looked at."""

EDGE = 33
"""Places along each edge of the square."""

LEVELS, ZOOM, SHRINK = 6, 13, 5.0
"""Rounds by which a peak is closed in on, places along each axis in each, and the factor between them."""

FLAT = 0.7
"""A peak is closed in on until the product varies by less than this over the places."""

HALVINGS = 40
"""Steps from a peak outwards, each half of the one before, at which its width is looked for."""

NARROW = 0.3
"""Half-width in the square below which nodes crowd at a peak."""

BROAD = 1.5
"""Lobe's width over the light's size above which no peak is looked for."""

ROUNDING = 1e-14  # of the heights of a light that ends at the horizon
_SAME = 1e-9
_ROOT = 0.75


@dataclass(frozen=True)
class Lookout:
    """What is seen in a light's square: how to map it, its peaks, and whether the horizon cuts it.

    ``size`` is the light's angular radius [rad], and ``evaluations`` how often the product was computed.
    """

    axes: tuple[Axis, Axis]
    foci: tuple[Focus, ...]
    kinks: bool
    size: float
    evaluations: int


@lru_cache(maxsize=1)
def _places() -> FloatArray:
    """Return the grid's middles, then the points of the edges u0 = 0, 1, u1 = 0, 1, then those near poles."""
    x = (np.arange(GRID) + 0.5) / GRID
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    t = np.linspace(0.0, 1.0, EDGE)
    edges = [np.stack([np.full(EDGE, end), t], axis=-1) for end in (0.0, 1.0)]
    edges += [np.stack([t, np.full(EDGE, end)], axis=-1) for end in (0.0, 1.0)]
    near = [(d, 0.37) for d in (1e-4, 1e-6)] + [(1 - d, 0.37) for d in (1e-4, 1e-6)]
    points = np.concatenate([grid, *edges, near, [(b, a) for a, b in near]])
    points.setflags(write=False)
    return points


def look(
    light: Emitter,
    receiver: Receiver,
    product: Callable[[FloatArray], FloatArray] | None = None,
    *,
    width: float | None = None,
    towards: FloatArray | Sequence[FloatArray] = (),
) -> Lookout:
    """Look at the square from which a light samples its directions.

    Parameters
    ----------
    light : Emitter
    receiver : Receiver
    product : callable, optional
        f L cosθ for directions (N, 3) in world coordinates; without it no peak is looked for.
    width : float, optional
        The lobe's width in slope, where it is known.
    towards : ndarray, shape (M, 3), optional
        Directions at which the product may peak, such as that of the mirror.
    """
    points = _places()
    directions, _ = light.sample(points, receiver.origin)
    heights = directions @ receiver.axis
    kinks = bool(np.any(heights > ROUNDING) and np.any(heights < -ROUNDING))
    count = GRID * GRID
    edges = directions[count : count + 4 * EDGE].reshape(4, EDGE, 3)
    shape = [_edge_kind(edges, directions[count + 4 * EDGE :], axis) for axis in (0, 1)]
    middle = edges.reshape(-1, 3).sum(axis=0) + directions[:count].sum(axis=0)
    length = float(np.sqrt(middle @ middle))
    size = np.pi
    if length > 0:
        chord = np.sqrt(np.max(np.sum((directions - middle / length) ** 2, axis=1)))
        size = 2 * float(np.arcsin(min(chord / 2, 1.0)))
    plain = Lookout(_axes(shape, None), (), kinks, size, 0)
    if product is None or (width is not None and width > BROAD * size):
        return plain
    values = _positive(product(directions[:count]))
    seeds, spent = [points[int(np.argmax(values))]], count
    for direction in towards:
        away = np.sum((directions[: count + 4 * EDGE] - direction) ** 2, axis=1)
        seeds.append(points[int(np.argmin(away))])

    def at(u: FloatArray) -> tuple[FloatArray, FloatArray]:
        nonlocal spent
        spent += len(u)
        seen, _ = light.sample(u, receiver.origin)
        return seen, _positive(product(seen))

    peaks, values = _close_in(at, _axes(shape, None), np.array(seeds), towards)
    axes = _axes(shape, peaks[int(np.argmax(values))])
    foci = _foci(at, axes, peaks, values)
    return Lookout(axes, foci, kinks, size, spent)


def _edge_kind(edges: FloatArray, near: FloatArray, axis: int) -> tuple[bool, bool, bool]:
    """Return whether an axis has a pole at its low and high end, and whether it is periodic."""
    low, high = edges[2 * axis], edges[2 * axis + 1]
    poles = []
    for end, (far, close) in zip((low, high), near[4 * axis : 4 * axis + 4].reshape(2, 2, 3), strict=True):
        pole = bool(np.max(np.abs(end - end[0])) < _SAME)
        if pole:
            steps = [float(np.sqrt(np.sum((w - end[0]) ** 2))) for w in (far, close)]
            # A distance that goes as the root of u shrinks by 10 while u does by 100.
            pole = 0 < steps[1] and steps[0] / steps[1] < 100.0**_ROOT
        poles.append(pole)
    periodic = not any(poles) and bool(np.max(np.abs(low - high)) < _SAME)
    return poles[0], poles[1], periodic


def _axes(shape: list[tuple[bool, bool, bool]], peak: FloatArray | None) -> tuple[Axis, Axis]:
    """Return the map of each axis, with a periodic one opened opposite the peak."""
    found = []
    for axis, (low, high, periodic) in enumerate(shape):
        start = None if peak is None or not periodic else float(peak[axis]) - 0.5
        found.append(Axis(low_pole=low, high_pole=high, start=start))
    return found[0], found[1]


def _close_in(
    at: _At, axes: tuple[Axis, Axis], seeds: FloatArray, towards: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return where the product is largest near the first seed, and the places nearest to given directions."""
    t = np.linspace(-1.0, 1.0, ZOOM)
    star = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1).reshape(-1, 2)
    place = np.array([[axis.to_v(float(u)) for axis, u in zip(axes, seed, strict=True)] for seed in seeds])
    reach, each = 1.0 / GRID, np.arange(len(seeds))
    for _ in range(LEVELS):
        v = np.clip(place[:, None, :] + reach * star, 0.0, 1.0)
        directions, values = at(_points(axes, v.reshape(-1, 2)))
        directions, values = directions.reshape(*v.shape[:2], 3), values.reshape(v.shape[:2])
        keys = values.copy()
        for k, direction in enumerate(towards, start=1):
            keys[k] = -np.sum((directions[k] - direction) ** 2, axis=1)
        chosen = np.argmax(keys, axis=1)
        place, best = v[each, chosen], values[each, chosen]
        if np.all(values.min(axis=1) >= FLAT * values.max(axis=1)):
            break
        reach /= SHRINK
    return _points(axes, place), best


def _points(axes: tuple[Axis, Axis], v: FloatArray) -> FloatArray:
    return np.stack([axis.to_u(v[:, k])[0] for k, axis in enumerate(axes)], axis=-1)


def _foci(at: _At, axes: tuple[Axis, Axis], peaks: FloatArray, values: FloatArray) -> tuple[Focus, ...]:
    """Return the peaks that are narrow, by where the product falls to half on the way out."""
    steps = 0.5 ** np.arange(1.0, HALVINGS + 1)
    ways = np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    foci: list[Focus] = []
    for peak, value in sorted(zip(peaks, values, strict=True), key=lambda each: -each[1]):
        place = np.array([axis.to_v(float(u)) for axis, u in zip(axes, peak, strict=True)])
        if not value > 0 or any(_near(place, focus) for focus in foci):
            continue
        v = place + ways[:, None, :] * steps[:, None]
        inside = np.all((v >= 0) & (v <= 1), axis=-1)
        _, seen = at(_points(axes, np.clip(v, 0.0, 1.0).reshape(-1, 2)))
        fallen = inside & (seen.reshape(4, HALVINGS) < value / 2)
        reach = np.where(fallen, steps, np.inf).min(axis=1)
        width = [float(w) if w < NARROW else np.inf for w in (min(reach[:2]), min(reach[2:]))]
        if min(width) < NARROW:
            foci.append(Focus((float(place[0]), float(place[1])), (width[0], width[1])))
    return tuple(foci)


def _near(place: FloatArray, focus: Focus) -> bool:
    """Return whether a place lies within the peak of a focus."""
    return all(abs(place[k] - focus.place[k]) <= min(focus.width[k], 1.0) for k in (0, 1))


def _positive(values: FloatArray) -> FloatArray:
    """Return the size (N,) of values (N,) or (N, K); those that are not finite are left to the integral."""
    size: FloatArray = np.nan_to_num(np.abs(values.reshape(len(values), -1)).sum(axis=1), posinf=0.0)
    return size
