"""Plan: what ``explain`` returns, a row for each term, as text, a notebook's table and JSON."""

from __future__ import annotations

from dataclasses import dataclass, field
from html import escape
from typing import Any

from radiokit.worlds.pilot import Cost
from radiokit.worlds.terms import Term

__all__ = ["Plan", "Row"]


@dataclass(frozen=True)
class Row:
    """One term of the plan: what it is, how it is computed, why, at what cost, and what else applies.

    ``evaluations``, ``seconds`` and ``error`` are foretold in order of magnitude (see ``Cost``), and
    ``costs`` says the same of the alternatives.
    """

    name: str
    method: str
    why: str
    evaluations: int
    alternatives: tuple[str, ...]
    term: Term = field(repr=False, compare=False)
    seconds: float = 0.0
    error: float | None = None
    costs: tuple[Cost, ...] = ()

    @property
    def cost(self) -> Cost:
        """What the chosen method is expected to take."""
        return Cost(self.method, self.evaluations, self.seconds, self.error)

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON-ready data."""
        return {
            "term": self.name,
            "method": self.method,
            "why": self.why,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
            "error": self.error,
            "alternatives": list(self.alternatives),
            "costs": [cost.to_json() for cost in self.costs],
        }


@dataclass(frozen=True)
class Plan:
    """How a shading value is computed: a row for each term. It prints as a table, in a notebook too."""

    subject: str
    rtol: float
    rows: tuple[Row, ...]

    _COLUMNS = ("term", "method", "cost", "why", "also possible")

    def _cells(self) -> list[tuple[str, str, str, str, list[str]]]:
        return [
            (row.name, row.method, str(row.cost), row.why, [f"{cost.method}: {cost}" for cost in row.costs])
            for row in self.rows
        ]

    def __str__(self) -> str:
        lines = [f"{self.subject}, relative tolerance {self.rtol:g}"]
        if not self.rows:
            lines.append("  no light: 0")
        for name, method, cost, why, others in self._cells():
            lines.append(f"  {name}: {method}, {cost}")
            lines.append(f"    because {why}")
            lines += [f"    also possible: {other}" for other in others or ["nothing"]]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{escape(name)}</th>" for name in self._COLUMNS)
        rows = []
        for *cells, others in self._cells():
            last = "<br>".join(map(escape, others)) or "nothing"
            rows.append("".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + f"<td>{last}</td>")
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        caption = f"<caption>{escape(self.subject)}, relative tolerance {self.rtol:g}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def to_json(self) -> dict[str, Any]:
        """Return the plan as JSON-ready data."""
        return {
            "subject": self.subject,
            "rtol": self.rtol,
            "rows": [row.to_json() for row in self.rows],
        }
