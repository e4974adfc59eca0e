"""Show lights: the table of ``--lights``, for a person to read."""

from __future__ import annotations

import math
from collections.abc import Sequence

from radiokit.faces.console import show_table, write
from radiokit.faces.stability.lights import LIMIT, LightResult
from radiokit.facts.verdict import Outcome

__all__ = ["show_lights"]


def _number(error: float | None) -> str:
    if error is None:
        return ""
    return f"{error:.2g}" if math.isfinite(error) else "not finite"


def show_lights(results: Sequence[LightResult]) -> None:
    """Write one line for each closed form, where its error is largest, and what fails."""
    lines = [
        (
            found.name,
            _number(found.worst),
            _number(found.raw),
            f"{found.condition:.2g}",
            found.where,
            ("no" if found.broken else "yes") if found.bounds else "none",
            found.nonfinite,
            found.cases,
            _number(found.textbook),
            f"{found.seconds:.1f}",
            found.outcome,
        )
        for found in results
    ]
    columns = ("closed form", "worst", "ulps", "condition", "at", "bound holds", "not finite", "cases")
    show_table("worst error in ulps / condition number", (*columns, "textbook", "s", "outcome"), lines)
    for found in results:
        if found.worst > LIMIT or found.nonfinite:
            write(f"{found.name}: {found.worst:.3g} at {found.where}, {list(found.numbers)}")
        for kind, labels in (("its bound does not hold", found.broken), ("no truth", found.undecided)):
            if labels:
                write(f"{found.name}: {kind} at {', '.join(labels)}")
    held = sum(found.outcome is Outcome.HOLDS for found in results)
    cases = sum(found.cases for found in results)
    write(
        f"{held} of {len(results)} closed forms stay within {LIMIT:g} ulps × condition number and within "
        f"their bounds, at {cases} configurations"
    )
