"""Reports: what is written of a whole class: its table, its summary, and how long it took."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.classroom.discovery import Entry
from radiokit.faces.grading.classroom.store import Store, json_text
from radiokit.faces.grading.classroom.summary import Tally, needs_review
from radiokit.faces.grading.classroom.task import write_whole
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import RadiokitError

__all__ = ["write_reports", "write_timings"]


def write_reports(
    store: Store, entries: Sequence[Entry], assignment: Assignment, language: str
) -> dict[str, Any]:
    """Write ``class.csv`` and ``class.json`` from what is stored, and return the summary.

    Raises
    ------
    RadiokitError
        When a result is gone, or a file cannot be written.
    """
    tally = Tally(assignment, language)
    table = io.StringIO(newline="")
    rows = csv.writer(table, lineterminator="\n")
    names = [question.name for question in assignment.questions]
    rows.writerow(["entry", "student", "score", "points", *names, "review"])
    for place, entry in enumerate(entries, start=1):
        data = store.read(entry.key)
        if data is None:
            raise RadiokitError(f"the result of submission {place} of {len(entries)} is gone: run again")
        grade = Grade.from_json(data["grade"])
        tally.add(grade, handed_in=data["handed_in"])
        scores = [question.score for question in grade.questions]
        who = [_cell(entry.key), _cell(entry.student)]
        rows.writerow([*who, grade.score, grade.points, *scores, "yes" if needs_review(grade) else ""])
    summary = tally.to_json()
    _write(store, "class.csv", table.getvalue())
    _write(store, "class.json", json_text(summary))
    return summary


def write_timings(
    store: Store, entries: Sequence[Entry], timings: Mapping[str, Any], *, seconds: float, workers: int
) -> None:
    """Write ``timings.json``: the times of this run, and of earlier ones for what was graded then.

    Raises
    ------
    RadiokitError
        When the file cannot be written.
    """
    earlier: dict[str, Any] = {}
    with suppress(OSError, ValueError, AttributeError):
        earlier = json.loads((store.folder / "timings.json").read_text("utf-8")).get("entries", {})
    found = {entry.key: timings.get(entry.key, earlier.get(entry.key)) for entry in entries}
    whole = {
        "seconds": seconds,
        "workers": workers,
        "graded": len(timings),
        "entries": {key: times for key, times in found.items() if times},
    }
    _write(store, "timings.json", json_text(whole))


def _write(store: Store, name: str, text: str) -> None:
    try:
        write_whole(store.folder / name, text)
    except OSError as error:
        raise RadiokitError(f"{name} cannot be written: {error.strerror}") from None


def _cell(text: str) -> str:
    """Return a text that no spreadsheet takes for a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text
