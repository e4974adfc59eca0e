"""Report: the verdicts on one subject, as a terminal table, HTML, or JSON with a written schema."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from importlib import resources
from typing import Any

from radiokit.facts.errors import UnknownNameError
from radiokit.facts.jsonable import jsonable
from radiokit.facts.verdict import Outcome, Verdict

__all__ = ["EXIT_CODES", "Report", "schema"]

EXIT_CODES = {Outcome.HOLDS: 0, Outcome.VIOLATED: 1, Outcome.INCONCLUSIVE: 3}
"""Exit code of a command, by outcome; 2 is kept for bad usage or input."""

_COLOURS = {Outcome.HOLDS: "green", Outcome.VIOLATED: "red", Outcome.INCONCLUSIVE: "yellow"}
_COLUMNS = ("check", "outcome", "evidence", "finding")


def schema() -> dict[str, Any]:
    """Return the JSON schema of ``Report.to_json()``.

    >>> schema()["title"]
    'radiokit report'
    """
    text = resources.files("radiokit.facts").joinpath("report.schema.json").read_text("utf-8")
    result: dict[str, Any] = json.loads(text)
    return result


@dataclass(frozen=True)
class Report:
    """The verdicts on one subject.

    Indexing by a check's name gives its verdict. Printing gives a plain table, a notebook shows HTML,
    and Rich shows colours.

    >>> sums = Verdict(check="sum", claim="1 + 1 = 2", outcome="holds", evidence="proved")
    >>> report = Report("arithmetic", (sums,))
    >>> report.ok, report["sum"].claim
    (True, '1 + 1 = 2')
    """

    subject: str
    verdicts: tuple[Verdict, ...]
    notes: tuple[str, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """True only when every verdict holds."""
        return self.outcome is Outcome.HOLDS

    @property
    def outcome(self) -> Outcome:
        """The worst outcome: one violation violates, else one doubt leaves it inconclusive."""
        found = {verdict.outcome for verdict in self.verdicts}
        for outcome in (Outcome.VIOLATED, Outcome.INCONCLUSIVE):
            if outcome in found:
                return outcome
        return Outcome.HOLDS if found else Outcome.INCONCLUSIVE

    @property
    def exit_code(self) -> int:
        """0 when all hold, 1 on a violation, 3 when something is inconclusive."""
        return EXIT_CODES[self.outcome]

    @property
    def evaluations(self) -> int:
        """How often the model was evaluated, over all verdicts."""
        return sum(verdict.evaluations for verdict in self.verdicts)

    @property
    def seconds(self) -> float:
        """Wall time of all verdicts [s]."""
        return sum(verdict.seconds for verdict in self.verdicts)

    def __getitem__(self, check: str) -> Verdict:
        for verdict in self.verdicts:
            if verdict.check == check:
                return verdict
        raise UnknownNameError("check", check, [verdict.check for verdict in self.verdicts])

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self.verdicts)

    def __len__(self) -> int:
        return len(self.verdicts)

    def _rows(self) -> list[tuple[str, Outcome, str, str]]:
        rows = []
        for verdict in self.verdicts:
            finding = verdict.message
            if verdict.witness is not None:
                finding += f"\nwitness: {verdict.witness}"
            rows.append((verdict.check, verdict.outcome, str(verdict.evidence), finding))
        return rows

    def __str__(self) -> str:
        lines = [f"{self.subject}: {self.outcome}"]
        for check, outcome, evidence, finding in self._rows():
            first, *rest = finding.split("\n")
            lines.append(f"  {check:<22} {outcome:<13} {evidence:<9} {first}")
            lines += [f"  {'':<22} {line}" for line in rest]
        lines += [f"  note: {note}" for note in self.notes]
        lines.append(f"  {self.evaluations} evaluations, {self.seconds:.2f} s")
        return "\n".join(lines)

    def __rich__(self) -> Any:
        from rich.console import Group
        from rich.markup import escape as plain
        from rich.table import Table

        table = Table(title=plain(self.subject), title_justify="left", show_lines=True)
        for column in _COLUMNS:
            table.add_column(column, overflow="fold")
        for check, outcome, evidence, finding in self._rows():
            colour = _COLOURS[outcome]
            table.add_row(check, f"[{colour}]{outcome}[/]", evidence, plain(finding))
        notes = [plain(f"note: {note}") for note in self.notes]
        cost = f"{self.evaluations} evaluations, {self.seconds:.2f} s"
        return Group(table, *notes, f"[bold {_COLOURS[self.outcome]}]{self.outcome}[/]: {cost}")

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{column}</th>" for column in _COLUMNS)
        body = "".join(
            f"<tr><td>{escape(check)}</td>"
            f'<td style="color:{_COLOURS[outcome]};font-weight:bold">{outcome}</td>'
            f'<td>{evidence}</td><td style="text-align:left">'
            f"{escape(finding).replace(chr(10), '<br>')}</td></tr>"
            for check, outcome, evidence, finding in self._rows()
        )
        notes = "".join(f"<li>{escape(note)}</li>" for note in self.notes)
        return (
            f"<table><caption>{escape(self.subject)}: {self.outcome}</caption>"
            f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
            + (f"<ul>{notes}</ul>" if notes else "")
        )

    def to_json(self) -> dict[str, Any]:
        """Return the report as JSON-ready data; ``schema()`` describes it."""
        return {
            "subject": self.subject,
            "parameters": jsonable(self.parameters),
            "outcome": str(self.outcome),
            "ok": self.ok,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
            "notes": list(self.notes),
            "verdicts": [verdict.to_json() for verdict in self.verdicts],
        }
