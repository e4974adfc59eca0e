"""Timing: seconds of calls that alternate, so that a busy machine slows all of them alike."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

import numpy as np

__all__ = ["Timing", "interleave", "standard_work"]

_AT_LEAST = 4e-3
"""Calls shorter than this [s] are timed several at a time."""


@dataclass(frozen=True)
class Timing:
    """The seconds of one call in each repetition, and what was returned."""

    seconds: tuple[float, ...]
    results: tuple[Any, ...]

    @property
    def median(self) -> float:
        """The median of the repetitions [s]."""
        return median(self.seconds)

    @property
    def best(self) -> float:
        """The shortest of the repetitions [s]."""
        return min(self.seconds)

    @property
    def noise(self) -> float:
        """The standard error of the median's logarithm, from the middle two thirds of the repetitions.

        On a machine that others use, times cluster at one or two speeds; the median absolute deviation
        would look at one cluster only.
        """
        low, high = np.quantile(np.log(self.seconds), (0.1587, 0.8413))
        return float(1.2533 * (high - low) / 2 / math.sqrt(len(self.seconds)))


def interleave(
    calls: Sequence[Callable[[int], Any]],
    repeats: int,
    *,
    pause: float = 0.0,
    tick: Callable[[], None] | None = None,
) -> list[Timing]:
    """Run each call once untimed, then all of them in turn, ``repeats`` times over.

    A call gets the number of the repetition. Short calls are repeated within it, and their mean counts. After
    a ``pause`` [s] before each, the threads of the one before have stopped waiting for more work, as those of
    OpenBLAS, OpenMP and Dr.Jit do in a busy loop, on the processors that the next one wants.

    >>> [timing.results for timing in interleave([lambda i: i, lambda i: 2 * i], 3)]
    [(0, 1, 2), (0, 2, 4)]
    """
    counts = []
    for call in calls:
        call(0)
        start = time.perf_counter()
        call(0)
        counts.append(max(1, min(64, math.ceil(_AT_LEAST / max(time.perf_counter() - start, 1e-9)))))
        if tick is not None:
            tick()
    seconds: list[list[float]] = [[] for _ in calls]
    results: list[list[Any]] = [[] for _ in calls]
    for repeat in range(repeats):
        for i, (call, count) in enumerate(zip(calls, counts, strict=True)):
            if pause:
                time.sleep(pause)
            start = time.perf_counter()
            for _ in range(count):
                found = call(repeat)
            seconds[i].append((time.perf_counter() - start) / count)
            results[i].append(found)
    return [Timing(tuple(s), tuple(r)) for s, r in zip(seconds, results, strict=True)]


def standard_work(repeat: int = 0) -> float:
    """Do a fixed piece of NumPy work of about a millisecond, which tells how fast the machine is just now."""
    x = np.linspace(0.1, 1.0, 16384)
    for _ in range(4):
        x = np.sqrt(x * x + 0.25 * np.cos(x) ** 2) / 1.1
    return float(x.sum())
