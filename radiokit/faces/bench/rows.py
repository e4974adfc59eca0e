"""Rows: answers as data, with their true errors, their claims and their costs."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from radiokit.faces.bench.timing import Timing
from radiokit.facts.estimate import Estimate
from radiokit.facts.jsonable import jsonable

__all__ = ["ROUNDING", "Row", "row", "size_text"]

ROUNDING = 1e-14
"""Relative errors below this are rounding, and on no line."""

LEVEL = 1e-9
"""Chance that one row of honest standard errors is called dishonest."""


@dataclass(frozen=True)
class Row:
    """One method at one size on one task; errors are root mean squares over the repetitions' seeds.

    ``honest`` is False when an error is larger than what was claimed allows. ``rare`` is True when a standard
    error is too small because what it lacks are events too rare to have been drawn, as no sampling can know:
    a lobe of α = 0.001 loses its light in one of a million samples.
    """

    task: str
    method: str
    size: float
    value: float
    exact: float
    true_error: float
    claimed_error: float | None
    kind: str | None
    honest: bool
    rare: bool
    converged: bool
    evaluations: int
    seconds: float
    noise: float
    relative_seconds: float
    """Seconds in units of the standard work that was timed in between, by the medians."""
    relative_best: float
    """The same by the shortest times, which a busy machine disturbs least."""

    @property
    def throughput(self) -> float:
        """Evaluations per second."""
        return self.evaluations / self.seconds

    @property
    def efficiency(self) -> float | None:
        """1/(true error² · seconds), for a Monte Carlo method whose error is above rounding."""
        if self.kind != "statistical" or not self.true_error > ROUNDING * abs(self.exact):
            return None
        return 1 / (self.true_error**2 * self.seconds)

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON-ready data."""
        more = {"throughput": self.throughput, "efficiency": self.efficiency}
        return {name: jsonable(value) for name, value in (asdict(self) | more).items()}


def row(task: str, method: str, size: float, exact: float, timing: Timing, unit: Timing) -> Row:
    """Return the row of a timing whose results are Estimates, or values with their evaluations."""
    found = [r if isinstance(r, Estimate) else Estimate(r[0], 0.0, "rounding", r[1]) for r in timing.results]
    claims = isinstance(timing.results[0], Estimate)
    off = np.array([float(each.value) - exact for each in found])
    errors = np.array([float(each.error) for each in found])
    honest = not claims or _honest(found, exact)
    # N samples miss an event of probability p with probability exp(−pN); it adds 1 or so to a sample.
    reach = -math.log(LEVEL) * max(1.0, abs(exact)) / max(1, found[-1].evaluations)
    rare = not honest and not found[0].is_bound and bool(np.all(np.abs(off) <= errors * 6 + reach))
    return Row(
        task=task,
        method=method,
        size=size,
        value=float(found[-1].value),
        exact=exact,
        true_error=_rms(off),
        claimed_error=_rms(errors) if claims else None,
        kind=found[0].kind if claims else None,
        honest=honest or rare,
        rare=rare,
        converged=all(each.converged for each in found),
        evaluations=found[-1].evaluations,
        seconds=timing.median,
        noise=math.hypot(timing.noise, unit.noise),
        relative_seconds=timing.median / unit.median,
        relative_best=timing.best / unit.best,
    )


def _rms(values: Any) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _honest(found: list[Estimate], exact: float) -> bool:
    """Return whether bounds hold, and standard errors are not too small for the errors that were seen."""
    from radiokit.measure.statistics import sidak, z_test

    slack = ROUNDING * abs(exact)
    if found[0].is_bound:
        return all(abs(each.value - exact) <= each.error + slack for each in found)
    beyond = [max(abs(float(each.value) - exact) - slack, 0.0) for each in found]
    p = [
        float(z_test(Estimate(b, each.error, "statistical", dof=each.dof), 0.0))
        for b, each in zip(beyond, found, strict=True)
    ]
    return min(p) >= sidak(LEVEL, len(p))


def size_text(size: float) -> str:
    """Return a number of samples or nodes in full, and a tolerance in short.

    >>> size_text(1048576.0), size_text(1e-6)
    ('1048576', '1e-06')
    """
    return f"{size:.0f}" if size >= 1 else f"{size:g}"
