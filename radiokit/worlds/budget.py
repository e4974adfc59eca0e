"""Budget: how much time and how many evaluations a shading call may take, and what of it each term gets."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from radiokit.facts.checking import check_above_zero
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate

__all__ = ["Budget", "Purse"]

SHORTEST = 1e-6
"""What is left [s] when nothing is: 0 is no limit that a sampler takes."""

FEWEST = 2
"""Samples from which a standard error can be had."""


@dataclass(frozen=True)
class Budget:
    """What one term may take: evaluations of the material, and the ``time.perf_counter`` [s] at the end."""

    evaluations: int | None = None
    deadline: float = np.inf

    @property
    def bounded(self) -> bool:
        """Whether there is a limit at all."""
        return self.evaluations is not None or np.isfinite(self.deadline)

    def seconds_left(self) -> float | None:
        """Return the time [s] until the deadline; None without one."""
        return max(self.deadline - time.perf_counter(), SHORTEST) if np.isfinite(self.deadline) else None

    def samples(self, strategy: str, samples: int | None, most: int) -> int | None:
        """Return how many samples may be drawn; None where only time limits them.

        A sample of ``mis`` evaluates the material twice. Without any limit ``most`` are drawn.

        >>> Budget(evaluations=1000).samples("mis", None, 1 << 20)
        500
        """
        affordable = None
        if self.evaluations is not None:
            affordable = max(self.evaluations // (2 if strategy == "mis" else 1), FEWEST)
        elif not np.isfinite(self.deadline):
            affordable = most if samples is None else None
        limits = [count for count in (affordable, samples) if count is not None]
        return min(limits, default=None)

    def less(self, spent: int) -> Budget:
        """Return what is left after so many evaluations."""
        if self.evaluations is None:
            return self
        return replace(self, evaluations=max(self.evaluations - spent, 0))


class Purse:
    """The budget of a whole call. Each term that must be integrated gets an equal share of what is left."""

    def __init__(self, seconds: float | None, evaluations: int | None, terms: int) -> None:
        check_above_zero(seconds=seconds)
        whole = type(evaluations) is int or isinstance(evaluations, np.integer)
        if evaluations is not None and not (whole and evaluations >= 1):
            raise ParameterError("evaluations", evaluations, "an integer, at least 1, or None")
        self.seconds, self.evaluations = seconds, evaluations
        self._start = time.perf_counter()
        self._left = None if evaluations is None else int(evaluations)
        self._terms = terms

    def share(self) -> Budget:
        """Return what the next term may take."""
        terms = max(self._terms, 1)
        deadline = np.inf
        if self.seconds is not None:
            now = time.perf_counter()
            deadline = now + max(self._start + self.seconds - now, 0.0) / terms
        return Budget(None if self._left is None else max(self._left // terms, 0), deadline)

    def pay(self, evaluations: int) -> None:
        """Take off what a term has used."""
        self._terms -= 1
        if self._left is not None:
            self._left -= evaluations

    def judged(self, found: Estimate, rtol: float) -> Estimate:
        """Say in the note what was reached, where the budget did not suffice."""
        if found.converged or (self.seconds is None and self.evaluations is None):
            return found
        limits = [] if self.evaluations is None else [f"{self.evaluations} evaluations"]
        limits += [] if self.seconds is None else [f"{self.seconds:g} s"]
        reached = _largest(found.error)
        asked = rtol * _largest(found.value)
        note = f"reached ± {reached:.2g} of the asked ± {asked:.2g} within {' and '.join(limits)}"
        return replace(found, note="; ".join(filter(None, (note, found.note))))


def _largest(value: Any) -> float:
    return float(np.max(np.abs(value)))
