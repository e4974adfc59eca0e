"""Monte Carlo: means of random draws with their standard errors, the same for any number of workers."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future
from contextlib import closing
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import check_above_zero
from radiokit.facts.errors import CallableError, NonFiniteError, ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.moments import Moments

__all__ = ["ENDLESS", "BlockDraw", "Draw", "block_generator", "but", "mean", "seed_from"]

Draw = Callable[[np.random.Generator, int], npt.ArrayLike]
"""``draw(generator, n)`` returns n independent values ``(n,)``, or ``(n, K)``, whose mean is wanted."""

ENDLESS = 1 << 62
"""More samples than anyone has time for."""

_FIRST_LOOK = 4096  # samples of a ``BlockDraw`` before a tolerance is looked at
_IN_FLIGHT = 256  # blocks handed to an executor at a time: results are small, and so stays the memory
_FORETOLD = 2.0  # times the sample's variance: below it the sample is as good a witness
_UNSEEN = 2.0  # draws' worth of what N draws did not meet; −ln(5 %)/1.96 at least
_EXPLAINED = 4.0  # times the variance that was foretold: up to it one sample may carry what was seen
_DOMINANCE = 0.1  # above this share of the variance in one sample, the central limit is not near


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
    samples: int | None,
    rng: int | np.random.Generator | None = None,
    block: int = 65536,
    rtol: float | None = None,
    seconds: float | None = None,
    executor: Executor | None = None,
    method: str = "Monte Carlo",
    foretold: Any = 0.0,
    edge: bool = False,
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
    samples : int or None
        At least 2; with ``rtol`` or ``seconds``, the most that are drawn. None with ``seconds``: as many as
        there is time for.
    rng : int, numpy.random.Generator or None
        The seed, a generator to draw one from, or None for fresh entropy.
    block : int
        Samples in a block, at least 1. Another size gives another, equally good answer.
    rtol : float, optional
        Above 0. Stop when every standard error is within ``rtol`` of its mean's magnitude. This is looked
        at after 1, 2, 4, 8, ... blocks only: the fewer the looks, the smaller the bias from stopping at a
        lucky moment. A ``BlockDraw`` is looked at within its first block too, at its last few halves.
        Nothing stops while a single sample carries over a tenth of the variance, or while every sample was 0.
    seconds : float, optional
        Above 0. Stop after the first block that ends later than this [s]; the answer then depends on the
        machine's speed.
    executor : concurrent.futures.Executor, optional
        Runs the blocks; this thread does without it.
    method : str
        What the estimate says of its method.
    foretold : float or array_like, shape (K,)
        A variance of the draws that is known otherwise. Where rare draws carry the variance, those that were
        seen may show little of it: this one then counts, wherever it is well above that of the sample.
    edge : bool
        Whether a draw may be 0 where it usually is not. All of N draws miss an event of probability p with
        probability (1 − p)^N, so that the error is never less than that of 2 draws of the mean's size.

    Returns
    -------
    Estimate
        Of kind ``"statistical"``. ``error`` includes the mean's rounding, so it is 0 for a mean of 0 only.
        ``converged`` is False when ``rtol`` was not reached, or ``samples`` not drawn in time; ``note``
        then says what was.

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
    if not (callable(draw) or isinstance(draw, BlockDraw)):
        raise ParameterError("draw", draw, "a function draw(generator, n), or a BlockDraw")
    most = ENDLESS if samples is None and seconds is not None else samples
    for name, count, least in (("samples", most, 2), ("block", block, 1)):
        if not (type(count) is int or isinstance(count, np.integer)) or count < least:
            raise ParameterError(name, count, f"an integer, at least {least}")
    assert most is not None
    check_above_zero(rtol=rtol, seconds=seconds)
    start = time.perf_counter()
    halvings = _halvings(block) if isinstance(draw, BlockDraw) and rtol is not None else 0
    blocks = _blocks(most, block, halvings)
    work = partial(_block, draw, seed_from(rng), block, most, halvings)
    total = Moments(0, 0.0, 0.0, np.inf, -np.inf)
    reached = late = False
    done = 0
    while done < blocks and not (reached or late):
        whole = max(1, done - halvings)  # blocks, once the first one is complete
        goal = blocks if rtol is None else min(done + (whole if done > halvings else 1), blocks)
        with closing(_in_order(work, done, goal, executor)) as parts:
            for part in parts:
                if done and np.shape(part.mean) != np.shape(total.mean):
                    raise CallableError(_name(draw), "returned blocks of different shapes")
                total = total.merge(part) if done else part
                done += 1
                late = seconds is not None and time.perf_counter() - start > seconds
                if late:
                    break
        error, settled = _error(total, done, foretold, edge)
        something = np.any(total.mean) or done == blocks  # only zeros so far: a rare event may be missing
        if rtol is not None and something and np.all(settled | (total.dominance <= _DOMINANCE)):
            reached = bool(np.all(error <= rtol * np.abs(total.mean)))
    notes = []
    if total.count < most and not reached:
        wanted = "" if samples is None else f" of {samples}"
        notes.append(f"stopped after {total.count}{wanted} samples: {seconds:.3g} s were up")
    if rtol is not None and not reached:
        notes.append(f"rtol = {rtol} was not reached with {total.count} samples{but(total.mean, error)}")
    if not np.any(total.low) and not np.any(total.high):
        notes.append("every sample was 0")
    if np.any((total.dominance > _DOMINANCE) & ~settled):
        share = 100 * float(np.max(np.where(settled, 0.0, total.dominance)))
        notes.append(f"one sample carries {share:.0f} % of the variance: the standard error may be far off")
    return Estimate(
        total.mean if np.ndim(total.mean) else float(total.mean),
        error if np.ndim(error) else float(error),
        "statistical",
        evaluations=total.count,
        seconds=time.perf_counter() - start,
        method=method,
        converged=reached or (rtol is None and (samples is None or total.count == samples)),
        note="; ".join(notes),
    )


def but(value: Any, error: Any) -> str:
    """Return what relative error was reached instead of a tolerance, for a note.

    >>> but(0.5, 0.01)
    ', but 2.0e-02'
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        reached = float(np.max(np.divide(error, np.abs(value))))
    return f", but {reached:.1e}" if np.isfinite(reached) else ""


def _halvings(block: int) -> int:
    """Return how often a block's first look is halved: down to ``_FIRST_LOOK`` samples or so."""
    return max(0, (block // _FIRST_LOOK).bit_length() - 1)


def _bounds(index: int, block: int, halvings: int) -> tuple[int, int]:
    """Return the first sample of a block and the first of the next.

    The block 0 comes in parts: of the samples up to ``block >> halvings``, then as many again, and so on.

    >>> [_bounds(index, 8, 2) for index in range(5)]
    [(0, 2), (2, 4), (4, 8), (8, 16), (16, 24)]
    """
    if index <= halvings:
        return (block >> (halvings + 1 - index) if index else 0), block >> (halvings - index)
    return (index - halvings) * block, (index - halvings + 1) * block


def _blocks(samples: int, block: int, halvings: int) -> int:
    """Return how many blocks ``samples`` make, the parts of the first counted.

    >>> [_blocks(samples, 8, 2) for samples in (1, 2, 3, 8, 9, 17)]
    [1, 1, 2, 3, 4, 5]
    """
    if samples > block:
        return halvings - (-samples // block)
    return next(index for index in range(halvings + 1) if samples <= block >> (halvings - index)) + 1


def _block(draw: Draw | BlockDraw, seed: int, block: int, samples: int, halvings: int, index: int) -> Moments:
    """Draw one block and return its moments."""
    first, end = _bounds(index, block, halvings)
    size = min(end, samples) - first
    if isinstance(draw, BlockDraw):
        return draw.moments(seed, first, size)
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


def _error(total: Moments, blocks: int, foretold: Any, edge: bool) -> tuple[Any, Any]:
    """Return the standard error, not less than the mean's rounding, and whether it is no surprise."""
    rounding = np.finfo(np.float64).eps * (4.0 + np.sqrt(blocks))
    floor = max(rounding, _UNSEEN / total.count if edge else 0.0) * np.abs(total.mean)
    known = np.asarray(foretold)
    spread = np.where(known > _FORETOLD * total.variance, np.sqrt(known / total.count), total.standard_error)
    settled = known * _EXPLAINED > total.variance
    return (np.maximum(spread, floor) if edge else np.hypot(spread, floor))[()], settled


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
