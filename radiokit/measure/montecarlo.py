"""Monte Carlo: means of random draws with their standard errors, the same for any number of workers."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import CallableError, NonFiniteError, ParameterError
from radiokit.facts.estimate import Estimate

__all__ = ["BlockDraw", "Draw", "Moments", "block_generator", "mean", "seed_from"]

FloatArray = npt.NDArray[np.float64]

Draw = Callable[[np.random.Generator, int], npt.ArrayLike]
"""``draw(generator, n)`` returns n independent values ``(n,)``, or ``(n, K)``, whose mean is wanted."""

_IN_FLIGHT = 256  # blocks handed to an executor at a time: results are small, and so stays the memory
_UNDERFLOW = 1e-280  # sums of squares below this may have lost terms
_DOMINANCE = 0.1  # above this share of the variance in one sample, the central limit is not near


@dataclass(frozen=True)
class Moments:
    """Count, mean and sum of squared deviations of values that need not be kept, with their range.

    Batches are merged by the pairwise update, which keeps the digits of a variance that is small beside
    the mean, as the sum of squares does not. All but ``count`` are scalars or have shape ``(K,)``.

    Source: Chan, Golub, LeVeque (1983), Algorithms for computing the sample variance, The American
    Statistician 37(3), doi:10.1080/00031305.1983.10483115: the corrected two-pass algorithm within a batch,
    the pairwise update between batches.

    >>> moments = Moments.of([1e9, 1e9 + 2]).merge(Moments.of([1e9 + 1]))
    >>> float(moments.mean - 1e9), float(moments.variance)
    (1.0, 1.0)
    """

    count: int
    mean: Any
    m2: Any
    low: Any
    high: Any

    @classmethod
    def of(cls, values: npt.ArrayLike) -> Moments:
        """Return the moments of ``values``, shape ``(n,)`` or ``(n, K)`` with n ≥ 1."""
        x = np.asarray(values, dtype=np.float64)
        if x.ndim not in (1, 2) or not len(x):
            raise ParameterError("values", x, "of shape (n,) or (n, K) with n at least 1")
        # About a value of the sample, so that a constant has exactly its own mean and no variance.
        offset = x - x[0]
        shift = np.mean(offset, axis=0)
        offset -= shift
        residue = np.sum(offset, axis=0)
        m2 = np.sum(offset * offset, axis=0) - residue * residue / len(x)
        return cls(len(x), x[0] + shift, np.maximum(m2, 0.0), np.min(x, axis=0), np.max(x, axis=0))

    def merge(self, other: Moments) -> Moments:
        """Return the moments of both batches together."""
        count = self.count + other.count
        delta = other.mean - self.mean
        return Moments(
            count,
            self.mean + delta * (other.count / count),
            self.m2 + other.m2 + delta * delta * (self.count * (other.count / count)),
            np.minimum(self.low, other.low),
            np.maximum(self.high, other.high),
        )

    @property
    def variance(self) -> Any:
        """The unbiased sample variance; infinite for a single value."""
        return self.m2 / (self.count - 1) if self.count > 1 else np.full_like(self.m2, np.inf)[()]

    @property
    def standard_error(self) -> Any:
        """The standard error of the mean; its largest possible value where the squares underflow."""
        most = 0.5 * (self.high - self.low) / np.sqrt(max(1, self.count - 1))
        return np.where(self.m2 < _UNDERFLOW, most, np.sqrt(self.variance / self.count))[()]

    @property
    def dominance(self) -> Any:
        """The share of the variance that comes from the one sample farthest from the mean."""
        farthest = np.maximum(self.high - self.mean, self.mean - self.low)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.m2 > 0, np.minimum(farthest * farthest / self.m2, 1.0), 0.0)[()]


class BlockDraw(ABC):
    """A draw that knows its samples by seed and number, and makes the moments of a block itself."""

    @abstractmethod
    def moments(self, seed: int, first: int, count: int) -> Moments:
        """Return the moments of samples ``first`` to ``first + count - 1``."""


def seed_from(rng: int | np.random.Generator | None) -> int:
    """Return a seed: the number itself, one drawn from a generator, or fresh entropy for None.

    Raises
    ------
    ParameterError
        When ``rng`` is neither, or negative.

    >>> seed_from(7)
    7
    """
    if rng is None:
        return int.from_bytes(np.random.default_rng().bytes(16), "big")
    if isinstance(rng, np.random.Generator):
        return int.from_bytes(rng.bytes(16), "big")
    if (type(rng) is int or isinstance(rng, np.integer)) and rng >= 0:
        return int(rng)
    raise ParameterError("rng", rng, "a non-negative int, a numpy.random.Generator, or None")


def block_generator(seed: int, index: int) -> np.random.Generator:
    """Return the generator of one block, independent of all others and of who runs it."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index,)))


def mean(
    draw: Draw | BlockDraw,
    *,
    samples: int,
    rng: int | np.random.Generator | None = None,
    block: int = 65536,
    rtol: float | None = None,
    seconds: float | None = None,
    executor: Executor | None = None,
    method: str = "Monte Carlo",
) -> Estimate:
    """Return the mean of random draws, and its standard error.

    Each block of samples has a generator of its own, made from the seed and the block's number, and blocks
    are merged in their order: the same seed gives the same answer, to the last bit, for any number of
    workers, and memory does not grow with ``samples``.

    Parameters
    ----------
    draw : callable or BlockDraw
        ``draw(generator, n)`` returns ``(n,)`` or ``(n, K)`` finite values. It must be picklable for an
        executor of processes and thread-safe for one of threads. A ``BlockDraw`` has no generators.
    samples : int
        At least 2; with ``rtol`` or ``seconds``, the most that are drawn.
    rng : int, numpy.random.Generator or None
        The seed, a generator to draw one from, or None for fresh entropy.
    block : int
        Samples in a block, at least 1. Another size gives another, equally good answer.
    rtol : float, optional
        Above 0. Stop when every standard error is within ``rtol`` of its mean's magnitude. This is looked
        at after 1, 2, 4, 8, ... blocks only: the fewer the looks, the smaller the bias from stopping at a
        lucky moment. Nothing stops while a single sample carries over a tenth of the variance, or while
        every sample was 0.
    seconds : float, optional
        Above 0. Stop after the first block that ends later than this [s]; the answer then depends on the
        machine's speed.
    executor : concurrent.futures.Executor, optional
        Runs the blocks; this thread does without it.
    method : str
        What the estimate says of its method.

    Returns
    -------
    Estimate
        Of kind ``"statistical"``. ``error`` includes the mean's rounding, so it is 0 for a mean of 0 only.
        ``converged`` is False when ``rtol`` was not reached, or ``samples`` not drawn in time.

    Raises
    ------
    ParameterError
        When an argument is out of its range.
    CallableError
        When ``draw`` returns another shape than it should.
    NonFiniteError
        When a sample is NaN or infinite, naming it and its block.

    >>> estimate = mean(lambda generator, n: generator.random(n), samples=100_000, rng=1)
    >>> estimate.covers(0.5, level=0.9999), estimate.evaluations
    (True, 100000)
    """
    for name, count, least in (("samples", samples, 2), ("block", block, 1)):
        if not (type(count) is int or isinstance(count, np.integer)) or count < least:
            raise ParameterError(name, count, f"an integer, at least {least}")
    for name, limit in (("rtol", rtol), ("seconds", seconds)):
        if limit is not None and not limit > 0:
            raise ParameterError(name, limit, "above 0, or None")
    start = time.perf_counter()
    blocks = -(-samples // block)
    work = partial(_block, draw, seed_from(rng), block, samples)
    total = Moments(0, 0.0, 0.0, np.inf, -np.inf)
    reached = late = False
    done = 0
    while done < blocks and not (reached or late):
        goal = blocks if rtol is None else min(max(1, 2 * done), blocks)
        with closing(_in_order(work, done, goal, executor)) as parts:
            for part in parts:
                if done and np.shape(part.mean) != np.shape(total.mean):
                    raise CallableError(_name(draw), "returned blocks of different shapes")
                total = total.merge(part) if done else part
                done += 1
                late = seconds is not None and time.perf_counter() - start > seconds
                if late:
                    break
        error = _error(total, done)
        something = np.any(total.mean) or done == blocks  # only zeros so far: a rare event may be missing
        if rtol is not None and something and np.all(total.dominance <= _DOMINANCE):
            reached = bool(np.all(error <= rtol * np.abs(total.mean)))
    notes = []
    if total.count < samples and not reached:
        notes.append(f"stopped after {total.count} of {samples} samples: {seconds} s were up")
    elif rtol is not None and not reached:
        notes.append(f"rtol = {rtol} was not reached with {samples} samples")
    if not np.any(total.low) and not np.any(total.high):
        notes.append("every sample was 0")
    if np.any(total.dominance > _DOMINANCE):
        share = 100 * float(np.max(total.dominance))
        notes.append(f"one sample carries {share:.0f} % of the variance: the standard error may be far off")
    return Estimate(
        total.mean if np.ndim(total.mean) else float(total.mean),
        error if np.ndim(error) else float(error),
        "statistical",
        evaluations=total.count,
        seconds=time.perf_counter() - start,
        method=method,
        converged=reached or (rtol is None and total.count == samples),
        note="; ".join(notes),
    )


def _block(draw: Draw | BlockDraw, seed: int, block: int, samples: int, index: int) -> Moments:
    """Draw one block and return its moments."""
    size = min(block, samples - index * block)
    if isinstance(draw, BlockDraw):
        return draw.moments(seed, index * block, size)
    values = np.asarray(draw(block_generator(seed, index), size), dtype=np.float64)
    if values.ndim not in (1, 2) or len(values) != size:
        problem = f"returned shape {values.shape} where ({size},) or ({size}, K) is due"
        raise CallableError(_name(draw), problem)
    finite = np.isfinite(values)
    if not finite.all():
        where = tuple(int(i) for i in np.argwhere(~finite)[0])
        value = float(values[where])
        problem = f"{_name(draw)} returned {value} as sample {where[0]} of block {index}"
        raise NonFiniteError(problem, value=value, sample=where[0], block=index)
    return Moments.of(values)


def _name(draw: Draw | BlockDraw) -> str:
    return str(getattr(draw, "__qualname__", type(draw).__qualname__))


def _error(total: Moments, blocks: int) -> Any:
    """Return the standard error, and not less than the rounding of the mean itself."""
    floor = np.finfo(np.float64).eps * (4.0 + np.sqrt(blocks)) * np.abs(total.mean)
    return np.hypot(total.standard_error, floor)


def _in_order(
    work: Callable[[int], Moments], first: int, last: int, executor: Executor | None
) -> Generator[Moments, None, None]:
    """Yield ``work(first)``, ..., ``work(last - 1)`` in this order, whoever is done first."""
    if executor is None:
        yield from map(work, range(first, last))
        return
    pending: deque[Future[Moments]] = deque()
    try:
        for index in range(first, last):
            if len(pending) == _IN_FLIGHT:
                yield pending.popleft().result()
            pending.append(executor.submit(work, index))
        while pending:
            yield pending.popleft().result()
    finally:
        for future in pending:
            future.cancel()
