"""Fused sums: random numbers, values and their moments in one loop that stores nothing."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np

from radiokit.facts.errors import NonFiniteError, ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.elementary import key_of, stream, uniform
from radiokit.measure.kernels import Kernel, bind, compile_with, numba_runs
from radiokit.measure.moments import Moments
from radiokit.measure.montecarlo import BlockDraw, mean
from radiokit.measure.passes import processors

__all__ = ["FusedDraw", "fused_mean", "fused_means", "points"]

BLOCK = 1 << 20
"""Samples in a block, which is what a thread takes at a time: a few milliseconds of work."""

_PIECE = 1 << 13  # of a block where NumPy does the work: its temporaries stay in the cache
_PILOT = 64  # samples whose mean the deviations are taken from
_ZERO, _ONE, _TWO = np.uint64(0), np.uint64(1), np.uint64(2)
_sample: Any = None  # stands for the kernel in the functions below


def _planar(start0: Any, start1: Any, start2: Any, index: Any, *parameters: Any) -> Any:
    return _sample(uniform(start0, index), uniform(start1, index), *parameters)


def _spatial(start0: Any, start1: Any, start2: Any, index: Any, *parameters: Any) -> Any:
    return _sample(uniform(start0, index), uniform(start1, index), uniform(start2, index), *parameters)


def _accumulate(key: Any, first: Any, count: Any, parameters: Any) -> Any:
    """Return the pivot, the sums of deviations from it and of their squares, and the largest deviation.

    The largest is found among the bits, as an integer: a maximum of floats would not be vectorised, since
    NaN has no place in their order.
    """
    start0, start1, start2 = stream(key, _ZERO), stream(key, _ONE), stream(key, _TWO)
    origin = _sample(start0, start1, start2, first, *parameters)
    total = 0.0
    pilot = min(count, _PILOT)
    for j in range(pilot):
        index = first + np.uint64(j)
        total += _sample(start0, start1, start2, index, *parameters) - origin
    pivot = origin + total / pilot
    total = squares = 0.0
    largest = np.int64(0)
    for j in range(count):
        index = first + np.uint64(j)
        deviation = _sample(start0, start1, start2, index, *parameters) - pivot
        total += deviation
        squares += deviation * deviation
        largest = max(largest, np.float64(abs(deviation)).view(np.int64))
    return pivot, total, squares, largest


@lru_cache(maxsize=64)
def _compiled(function: Kernel, width: int, dimensions: int) -> Any:
    def types(numba: Any) -> tuple[Any, ...]:
        return numba.uint64, numba.uint64, numba.int64, numba.types.UniTuple(numba.float64, width)

    drawn = bind(_planar if dimensions == 2 else _spatial, _sample=function)
    return compile_with(_accumulate, types, _sample=drawn)  # type: ignore[arg-type]


def points(key: np.uint64, first: int, count: int, dimensions: int = 2) -> tuple[Any, ...]:
    """Return the uniform numbers of samples ``first``, ``first + 1``, ...: arrays (count,), one a dimension.

    >>> u0, u1 = points(key_of(3), 10, 5)
    >>> bool(np.all(u0[2:] == points(key_of(3), 12, 3)[0]))
    True
    """
    index = np.arange(first, first + count, dtype=np.uint64)
    with np.errstate(over="ignore"):
        return tuple(uniform(stream(key, np.uint64(d)), index) for d in range(dimensions))


@dataclass(frozen=True)
class FusedDraw(BlockDraw):
    """Values of ``function(u0, u1, *parameters)`` for random points of the unit square, never stored.

    Parameters
    ----------
    function : Kernel or callable
        A kernel is compiled; any other function is called with arrays u0 and u1 (n,), and returns (n,) or,
        for K wavelengths, (n, K). Both see the same points for the same seed.
    parameters : tuple of float
    dimensions : int
        2, or 3 for a function of ``u0, u1, u2``.
    """

    function: Any
    parameters: tuple[float, ...] = ()
    dimensions: int = 2

    def prepare(self) -> None:
        """Compile the kernel, once: threads then share it."""
        if isinstance(self.function, Kernel) and numba_runs():
            _compiled(self.function, len(self.parameters), self.dimensions)

    def moments(self, seed: int, first: int, count: int) -> Moments:
        """Return the moments of samples ``first`` to ``first + count - 1``.

        ``low`` and ``high`` are as far from the pivot as the sample farthest from it.
        """
        key = key_of(seed)
        if not (isinstance(self.function, Kernel) and numba_runs()):
            pieces = range(first, first + count, _PIECE)
            found = [self._plain(key, at, min(_PIECE, first + count - at)) for at in pieces]
            whole = found[0]
            for part in found[1:]:
                whole = whole.merge(part)
            return whole
        run = _compiled(self.function, len(self.parameters), self.dimensions)
        pivot, total, squares, bits = run(key, np.uint64(first), count, self.parameters)
        if not np.isfinite(total):
            for at in range(first, first + count, _PIECE):
                self._plain(key, at, min(_PIECE, first + count - at))
            raise NonFiniteError(f"{self._name} overflows between samples {first} and {first + count}")
        farthest = float(np.int64(bits).view(np.float64))
        shift = total / count
        m2 = max(squares - total * shift, 0.0)
        return Moments(count, pivot + shift, m2, pivot - farthest, pivot + farthest)

    def _plain(self, key: np.uint64, first: int, count: int) -> Moments:
        """Return the moments by NumPy, or say which value is none."""
        with np.errstate(all="ignore") if isinstance(self.function, Kernel) else nullcontext():
            u = points(key, first, count, self.dimensions)
            values = np.asarray(self.function(*u, *self.parameters), dtype=np.float64)
        if values.ndim > 2 or values.shape[:1] not in ((), (count,)):
            raise ParameterError("function", values.shape, f"one that returns shape ({count},)")
        values = np.broadcast_to(values, (count,)) if values.ndim == 0 else values
        bad = np.argwhere(~np.isfinite(values))
        if len(bad):
            value, sample = float(values[tuple(bad[0])]), first + int(bad[0][0])
            raise NonFiniteError(
                f"{self._name} returned {value} as sample {sample}", value=value, sample=sample
            )
        return Moments.of(values)

    @property
    def _name(self) -> str:
        return str(getattr(self.function, "__qualname__", type(self.function).__qualname__))


@dataclass(frozen=True)
class _Together(BlockDraw):
    """Several draws, of which each block has its share: they get equally far, whatever ends them."""

    draws: tuple[FusedDraw, ...]

    def moments(self, seed: int, first: int, count: int) -> Moments:
        found = [draw.moments(seed, first, count) for draw in self.draws]
        fields = ("mean", "m2", "low", "high")
        return Moments(count, *(np.array([getattr(each, name) for each in found]) for name in fields))


def fused_mean(
    function: Any,
    parameters: tuple[float, ...] = (),
    *,
    dimensions: int = 2,
    samples: int | None,
    rng: int | np.random.Generator | None = None,
    rtol: float | None = None,
    seconds: float | None = None,
    workers: int | None = None,
    method: str = "Monte Carlo",
) -> Estimate:
    """Return the mean of ``function(u0, u1, *parameters)`` over the unit square (or cube), by Monte Carlo.

    Sample i of a seed is the same whoever draws it, and the blocks' moments are merged in their order: the
    answer is the same to the last bit for any number of threads. Memory does not grow with ``samples``.

    Parameters
    ----------
    function : Kernel or callable
        Of two numbers in [0, 1) and the parameters; a callable that is no kernel is given arrays.
    parameters : tuple of float
    dimensions : int
        Of the points: 2 or 3.
    samples : int or None
        At least 2; with ``rtol`` or ``seconds``, the most that are drawn. None with ``seconds``: as many as
        there is time for.
    rng : int, numpy.random.Generator or None
        The seed, a generator to draw one from, or None for fresh entropy.
    rtol, seconds : float, optional
        When to stop early, as for ``montecarlo.mean``: at this standard error beside the mean, which is
        looked at after 4096, 8192, ... samples, or after so much time [s], to within a block: 2²⁰ samples of
        a kernel, 8192 of another function.
    workers : int, optional
        Threads; by default as many as there are processors, and one for a callable that is no kernel.
    method : str
        What the estimate says of its method.

    Raises
    ------
    ParameterError
        When an argument is out of its range.
    NonFiniteError
        When a value is NaN or infinite, naming the sample.

    >>> estimate = fused_mean(lambda u0, u1: u0 * u1, samples=100_000, rng=1, workers=1)
    >>> estimate.covers(0.25, level=0.9999)
    True
    """
    draw = _draw(function, parameters, dimensions)
    block, threads = _blocking([function], workers)
    return _run(draw, block, threads, samples=samples, rng=rng, rtol=rtol, seconds=seconds, method=method)


def fused_means(
    terms: Sequence[tuple[Any, tuple[float, ...]]],
    *,
    dimensions: int = 2,
    samples: int | None,
    rng: int | np.random.Generator | None = None,
    rtol: float | None = None,
    seconds: float | None = None,
    workers: int | None = None,
    method: str = "Monte Carlo",
) -> Estimate:
    """Return the means of several functions, each over equally many of the same points.

    They take turns, block by block: when the time is up, or all are within ``rtol``, none has had more than
    another. Each is what ``fused_mean`` gives for that many samples.

    Parameters
    ----------
    terms : sequence of (Kernel or callable, tuple of float)
        At least one: functions with their parameters.
    dimensions, samples, rng, rtol, seconds, workers, method
        As for ``fused_mean``; ``samples`` are those of each. The estimate's ``evaluations`` are of all.

    >>> found = fused_means([(lambda u0, u1: u0, ()), (lambda u0, u1: u1, ())], samples=1000, rng=1)
    >>> found.value.shape, found.evaluations
    ((2,), 2000)
    """
    draw = _Together(tuple(_draw(function, parameters, dimensions) for function, parameters in terms))
    block, threads = _blocking([function for function, _ in terms], workers)
    found = _run(draw, block, threads, samples=samples, rng=rng, rtol=rtol, seconds=seconds, method=method)
    return replace(found, evaluations=len(terms) * found.evaluations)


def _draw(function: Any, parameters: tuple[float, ...], dimensions: int) -> FusedDraw:
    if dimensions not in (2, 3):
        raise ParameterError("dimensions", dimensions, "2 or 3")
    draw = FusedDraw(function, tuple(map(float, parameters)), dimensions)
    draw.prepare()
    return draw


def _blocking(functions: Sequence[Any], workers: int | None) -> tuple[int, int]:
    """Return the samples in a block, and how many threads draw them."""
    kernels = all(isinstance(function, Kernel) for function in functions)
    threads = workers
    if threads is None:
        threads = processors() if kernels else 1
    if type(threads) is not int or threads < 1:
        raise ParameterError("workers", workers, "an integer, at least 1, or None")
    return BLOCK if kernels else _PIECE, threads  # what is no kernel may be slow


def _run(draw: BlockDraw, block: int, threads: int, *, samples: int | None, **options: Any) -> Estimate:
    run = partial(mean, draw, block=block, samples=samples, **options)
    if threads == 1 or (samples is not None and (type(samples) is not int or samples <= block)):
        return run()
    with ThreadPoolExecutor(threads) as pool:
        return run(executor=pool)
