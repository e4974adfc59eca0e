"""Budgets: time limits that several calls of a sandbox share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from radiokit.facts.errors import ParameterError

__all__ = ["Budgets"]

MOST = 0.9
"""The part of a budget that is all of it, as far as a call is told: looking for names costs little."""


@dataclass
class _Budget:
    """Wall time that calls share; each sandbox's first loading within it is free."""

    seconds: float
    left: float
    loaded: set[int] = field(default_factory=set)


class Budgets:
    """The budgets that hold at a time, one within another: what is spent is spent of each.

    >>> budgets = Budgets()
    >>> with budgets.within(3.0):
    ...     budgets.spend(1.0)
    ...     budgets.left(5.0)
    (2.0, 'took longer than 3 s in all')
    >>> budgets.left(5.0)
    (5.0, 'took longer than 5 s')
    """

    def __init__(self) -> None:
        self._open: list[_Budget] = []

    @contextmanager
    def within(self, seconds: float) -> Iterator[None]:
        """Let what is spent inside share this time [s]."""
        if not 0 < seconds < float("inf"):
            raise ParameterError("seconds", seconds, "a finite number above 0")
        self._open.append(_Budget(seconds, seconds))
        try:
            yield
        finally:
            self._open.pop()

    def left(self, seconds: float) -> tuple[float, str]:
        """Return what is left to a call that may take this time [s], and what is said when it is over."""
        late = f"took longer than {seconds:g} s"
        for budget in self._open:
            if budget.left < seconds:
                seconds, late = budget.left, f"took longer than {budget.seconds:g} s in all"
                if budget.left >= MOST * budget.seconds:
                    late = f"took longer than {budget.seconds:g} s"
        return seconds, late

    def spend(self, seconds: float) -> None:
        """Take time from all [s]."""
        for budget in self._open:
            budget.left -= seconds

    def spend_loading(self, seconds: float, sandbox: object) -> None:
        """Take the time of a loading [s] from those in which it was not the sandbox's first."""
        for budget in self._open:
            budget.left -= seconds if id(sandbox) in budget.loaded else 0.0
            budget.loaded.add(id(sandbox))
