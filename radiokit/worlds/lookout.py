"""Lookout: where in the square of a finite light its product with a lobe peaks, and how narrowly."""

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

__all__ = ["Lookout", "edges", "look"]

FloatArray = npt.NDArray[np.float64]
_At = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

GRID = 16
"""Cells along each axis of the square in whose middle the product is looked at."""

EDGE = 33
"""Places along each edge of the square."""

LEVELS, ZOOM, SHRINK = 9, 9, 3.5
"""Rounds by which a peak is closed in on, places along each axis in each, and the factor between them."""

CLOSE, HAIR = 0.25, 1e-5
"""A peak is closed in on until the places extend over less than this share of its width, and what stands for
a width that is not known [rad]."""

STEPS, STEP = 30, 0.5
"""Steps from a peak outwards at which its width is looked for, and the factor from one to the next."""

SLOPE = 1.5
"""Where the product falls to half on one side and grows by more than this on the other is no peak."""

NARROW = 0.3
"""Half-width in the square below which nodes crowd at a peak."""

BROAD = 0.6
"""Lobe's angular radius over the light's size above which no peak is looked for."""

SLIVER, NEARLY = 0.05, 0.01
"""Share of the light on the other side of the horizon below which that sliver's tip is searched for, and the
height from which on, over the light's size, one may have been missed."""

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
    sides = [np.stack([np.full(EDGE, end), t], axis=-1) for end in (0.0, 1.0)]
    sides += [np.stack([t, np.full(EDGE, end)], axis=-1) for end in (0.0, 1.0)]
    near = [(d, 0.37) for d in (1e-4, 1e-6)] + [(1 - d, 0.37) for d in (1e-4, 1e-6)]
    points = np.concatenate([grid, *sides, near, [(b, a) for a, b in near]])
    points.setflags(write=False)
    return points


def edges() -> FloatArray:
    """Return places (N, 2) along the edges of the square."""
    return _places()[GRID * GRID : GRID * GRID + 4 * EDGE]


def look(
    light: Emitter,
    receiver: Receiver,
    product: Callable[[FloatArray], FloatArray] | None = None,
    *,
    width: float | None = None,
    towards: Sequence[FloatArray] = (),
) -> Lookout:
    """Look at the square from which a light samples its directions.

    Parameters
    ----------
    light : Emitter
    receiver : Receiver
    product : callable, optional
        f L cosθ for directions (N, 3) in world coordinates; without it no peak is looked for.
    width : float, optional
        The lobe's angular radius [rad], where it is known.
    towards : ndarray, shape (M, 3), optional
        Directions at which the product may peak, such as that of the mirror.
    """
    points = _places()
    directions, _ = light.sample(points, receiver.origin)
    heights = directions @ receiver.axis
    kinks = bool(np.any(heights > ROUNDING) and np.any(heights < -ROUNDING))
    count = GRID * GRID
    sides = directions[count : count + 4 * EDGE].reshape(4, EDGE, 3)
    shape = [_edge_kind(sides, directions[count + 4 * EDGE :], axis) for axis in (0, 1)]
    middle = sides.reshape(-1, 3).sum(axis=0) + directions[:count].sum(axis=0)
    length = float(np.sqrt(middle @ middle))
    size = np.pi
    if length > 0:
        chord = np.sqrt(np.max(np.sum((directions - middle / length) ** 2, axis=1)))
        size = 2 * float(np.arcsin(min(chord / 2, 1.0)))
    spent = 0
    probes: list[tuple[_At, FloatArray, FloatArray, Sequence[FloatArray], float | None]] = []

    def sees(value: Callable[[FloatArray], FloatArray]) -> _At:
        def at(u: FloatArray) -> tuple[FloatArray, FloatArray]:
            seen, _ = light.sample(u, receiver.origin)
            return seen, value(seen)

        return at

    if product is not None and (width is None or width <= BROAD * size):

        def size_of(w: FloatArray) -> FloatArray:
            nonlocal spent
            spent += len(w)
            return _positive(product(w))

        seeds = [points[int(np.argmax(size_of(directions[:count])))]]
        for direction in towards:
            away = np.sum((directions[: count + 4 * EDGE] - direction) ** 2, axis=1)
            seeds.append(points[int(np.argmin(away))])
        at = sees(size_of)
        peaks, values = _close_in(at, _axes(shape, None), np.array(seeds), towards, width or HAIR)
        probes.append((at, peaks, values, towards, width))
    side = -1.0 if np.median(heights) > 0 else 1.0
    if np.mean(side * heights > ROUNDING) < SLIVER and np.max(side * heights) > -NEARLY * size:
        seed = points[[int(np.argmax(side * heights))]]
        tip, _ = _close_in(
            sees(lambda w: side * (w @ receiver.axis) + 2.0), _axes(shape, None), seed, (), HAIR
        )
        at = sees(lambda w: np.maximum(side * (w @ receiver.axis), 0.0))
        _, value = at(tip)
        kinks = kinks or bool(value[0] > ROUNDING)
        probes.append((at, tip, value, (), None))
    best = probes[0][1][int(np.argmax(probes[0][2]))] if probes else None
    axes = _axes(shape, best)
    foci = tuple(
        focus
        for at, peaks, values, expected, lobe in probes
        for focus in _foci(at, axes, peaks, values, expected, lobe)
    )
    return Lookout(axes, foci, kinks, size, spent)


def _edge_kind(sides: FloatArray, near: FloatArray, axis: int) -> tuple[bool, bool, bool]:
    """Return whether an axis has a pole at its low and high end, and whether it is periodic."""
    low, high = sides[2 * axis], sides[2 * axis + 1]
    poles = []
    for end, (far, close) in zip((low, high), near[4 * axis : 4 * axis + 4].reshape(2, 2, 3), strict=True):
        pole = bool(np.max(np.abs(end - end[0])) < _SAME)
        if pole:
            steps = [float(np.sqrt(np.sum((w - end[0]) ** 2))) for w in (far, close)]
            # A distance that goes as the root of u shrinks by 10 while u does by 100.
            pole = steps[1] > 0 and steps[0] / steps[1] < 100.0**_ROOT
        poles.append(pole)
    periodic = not any(poles) and bool(np.max(np.abs(low - high)) < _SAME)
    return poles[0], poles[1], periodic


def _axes(shape: list[tuple[bool, bool, bool]], peak: FloatArray | None) -> tuple[Axis, Axis]:
    """Return the map of each axis, with a periodic one opened opposite the peak."""
    found = []
    for axis, (low, high, periodic) in enumerate(shape):
        start = None if not periodic else 0.0 if peak is None else float(peak[axis]) - 0.5
        found.append(Axis(low_pole=low, high_pole=high, start=start))
    return found[0], found[1]


def _close_in(
    at: _At,
    axes: tuple[Axis, Axis],
    seeds: FloatArray,
    towards: Sequence[FloatArray],
    width: float,
) -> tuple[FloatArray, FloatArray]:
    """Return where the product is largest near the first seed, and the places nearest to given directions."""
    t = np.linspace(-1.0, 1.0, ZOOM)
    star = np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1).reshape(-1, 2)
    place = np.array([[axis.to_v(float(u)) for axis, u in zip(axes, seed, strict=True)] for seed in seeds])
    turns = np.array([axis.start is not None for axis in axes])
    reach, each = np.where(turns, 0.5, 1.0 / GRID), np.arange(len(seeds))
    for _ in range(LEVELS):
        v = place[:, None, :] + reach * star
        v = np.where(turns, v % 1.0, np.clip(v, 0.0, 1.0))
        directions, values = at(_points(axes, v.reshape(-1, 2)))
        directions, values = directions.reshape(*v.shape[:2], 3), values.reshape(v.shape[:2])
        keys = values.copy()
        for k, direction in enumerate(towards, start=1):
            keys[k] = -np.sum((directions[k] - direction) ** 2, axis=1)
        chosen = np.argmax(keys, axis=1)
        place, best = v[each, chosen], values[each, chosen]
        extent = np.abs(directions - directions[each, chosen][:, None, :]).max()
        if extent < CLOSE * width:
            break
        reach = reach / SHRINK
    return _points(axes, place), best


def _points(axes: tuple[Axis, Axis], v: FloatArray) -> FloatArray:
    return np.stack([axis.to_u(v[:, k])[0] for k, axis in enumerate(axes)], axis=-1)


def _foci(
    at: _At,
    axes: tuple[Axis, Axis],
    peaks: FloatArray,
    values: FloatArray,
    towards: Sequence[FloatArray],
    width: float | None,
) -> tuple[Focus, ...]:
    """Return the peaks that are narrow, by where the product falls to half on the way out.

    Near a direction in which a lobe of known width must lie, where the product may be hidden under something
    broader, the way over which it changes is that width, or the distance if that is larger.
    """
    steps: FloatArray = 0.5 * STEP ** np.arange(float(STEPS))
    ways = np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    foci: list[Focus] = []
    for index in sorted(range(len(peaks)), key=lambda k: -values[k]):
        place = np.array([axis.to_v(float(u)) for axis, u in zip(axes, peaks[index], strict=True)])
        if not values[index] > 0 or any(_near(place, focus) for focus in foci):
            continue
        v = np.concatenate([place[None, :], (place + ways[:, None, :] * steps[:, None]).reshape(-1, 2)])
        inside = np.all((v >= 0) & (v <= 1), axis=-1)
        directions, seen = at(_points(axes, np.clip(v, 0.0, 1.0)))
        arms = np.where(inside, seen, np.inf)[1:].reshape(2, 2, STEPS)
        reach = [_halved(arm, steps, values[index]) for arm in arms]
        if index > 0 and width is not None and not min(reach) < NARROW:
            away = float(np.sqrt(np.sum((directions[0] - towards[index - 1]) ** 2)))
            moved = np.sqrt(np.sum((directions[1:] - directions[0]) ** 2, axis=-1)).reshape(2, 2, STEPS)
            left = (moved > np.hypot(width, away)) & inside[1:].reshape(2, 2, STEPS)
            reach = [float(np.where(arm, steps, np.inf).min()) for arm in left]
        found = [w if w < NARROW else np.inf for w in reach]
        if min(found) < NARROW:
            foci.append(Focus((float(place[0]), float(place[1])), (found[0], found[1])))
    return tuple(foci)


def _halved(arms: FloatArray, steps: FloatArray, value: float) -> float:
    """Return the least step (S,) at which one of two opposite arms (2, S) falls to half; infinite if none."""
    falls = np.flatnonzero(arms.min(axis=0) < value / 2)
    if not len(falls):
        return np.inf
    beside = arms[:, falls[-1]]
    peaked = np.all(~np.isfinite(beside) | (beside < SLOPE * value))
    return float(steps[falls[-1]]) if peaked else np.inf


def _near(place: FloatArray, focus: Focus) -> bool:
    """Return whether a place lies within the peak of a focus."""
    return all(abs(place[k] - focus.place[k]) <= min(focus.width[k], 1.0) for k in (0, 1))


def _positive(values: FloatArray) -> FloatArray:
    """Return the size (N,) of values (N,) or (N, K); those that are not finite are left to the integral."""
    size: FloatArray = np.nan_to_num(np.abs(values.reshape(len(values), -1)).sum(axis=1), posinf=0.0)
    return size
