"""Proofs: derivations verified by whatever workers there are, and how much of them is proved."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from radiokit.faces.workers import SerialExecutor
from radiokit.facts.report import EXIT_CODES
from radiokit.facts.verdict import Outcome

if TYPE_CHECKING:  # SymPy loads when the first derivation is asked for
    from radiokit.physics.relations.derivation import Derivation, Finding

__all__ = ["SHARE", "Proofs", "prove", "verify_all"]

SHARE = 0.85
"""Of all steps that are no premises, at least so many must be proved symbolically."""


@dataclass(frozen=True)
class Proofs:
    """Derivations with their findings, and what it cost."""

    derivations: tuple[Derivation, ...]
    seconds: float
    workers: int

    @property
    def outcome(self) -> Outcome:
        """The worst outcome."""
        found = {each.outcome for each in self.derivations}
        for outcome in (Outcome.VIOLATED, Outcome.INCONCLUSIVE):
            if outcome in found:
                return outcome
        return Outcome.HOLDS

    @property
    def counts(self) -> tuple[int, int]:
        """How many steps were proved symbolically, and how many there are besides the premises."""
        pairs = [each.counts for each in self.derivations]
        return sum(proved for proved, _ in pairs), sum(count for _, count in pairs)

    @property
    def exit_code(self) -> int:
        """0 when every step is verified, 1 when one fails, 3 when one is inconclusive."""
        return EXIT_CODES[self.outcome]

    def to_json(self) -> dict[str, Any]:
        """Return the derivations as JSON-ready data."""
        proved, count = self.counts
        return {
            "outcome": str(self.outcome),
            "proved": proved,
            "to_prove": count,
            "share_proved": proved / count if count else 1.0,
            "share_needed": SHARE,
            "seconds": self.seconds,
            "workers": self.workers,
            "derivations": [each.to_json() for each in self.derivations],
        }


def prove(task: tuple[str, bool]) -> tuple[str, tuple[Finding, ...]]:
    """Return the findings of one derivation, wherever this runs; the task is its name and ``fresh``."""
    from radiokit.physics.relations.catalogue import derive as verified

    name, fresh = task
    return name, verified(name, fresh=fresh).findings


def verify_all(
    names: Sequence[str],
    *,
    fresh: bool = False,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Proofs:
    """Verify derivations; ``fresh`` proves anew what is kept in the cache.

    >>> verify_all(["lambertian-intensity"]).outcome.value
    'holds'
    """
    from radiokit.physics.relations.catalogue import unverified

    start = time.perf_counter()
    found = []
    tasks = [(name, fresh) for name in names]
    for done, (name, findings) in enumerate((executor or SerialExecutor()).map(prove, tasks), start=1):
        found.append(replace(unverified(name), findings=findings))
        if progress is not None:
            progress(done, len(tasks))
    return Proofs(tuple(found), time.perf_counter() - start, workers)
