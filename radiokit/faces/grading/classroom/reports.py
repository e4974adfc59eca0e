"""Reports: what is written of a whole class: its table, its summary, its pages, and how long it took."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.classroom.discovery import Entry
from radiokit.faces.grading.classroom.store import Store
from radiokit.faces.grading.classroom.summary import Tally
from radiokit.faces.grading.formats.page import to_html
from radiokit.faces.grading.formats.table import to_csv
from radiokit.faces.grading.formats.writing import json_text, write_file
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import ParameterError, RadiokitError

__all__ = ["write_nameless", "write_reports", "write_timings"]


def write_reports(
    store: Store,
    entries: Sequence[Entry],
    assignment: Assignment,
    language: str,
    *,
    absent: Collection[int] = (),
    html: bool = False,
) -> dict[str, Any]:
    """Write ``class.csv`` and ``class.json`` from what is stored, and return the summary.

    Parameters
    ----------
    store : Store
    entries : sequence of Entry
    assignment : Assignment
    language : str
    absent : collection of int
        The places of entries without a submission.
    html : bool
        Whether to write each student's page, too.

    Raises
    ------
    RadiokitError
        When a result is gone, or a file cannot be written.
    """
    tally = Tally(assignment, language)

    def grades() -> Iterator[Grade]:
        for place, entry in enumerate(entries):
            called = f"submission {place + 1} of {len(entries)}"
            try:
                grade = Grade.from_json(store.read(entry.key))
            except (LookupError, TypeError):
                raise RadiokitError(f"the result of {called} is gone: run again") from None
            tally.add(grade, handed_in=place not in absent)
            if html:
                write_nameless(store.page(entry.key), to_html(grade), f"the page of {called}")
            yield grade

    table = to_csv(grades())
    summary = tally.to_json()
    write_nameless(store.folder / "class.csv", table, "class.csv")
    write_nameless(store.folder / "class.json", json_text(summary), "class.json")
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
    write_nameless(store.folder / "timings.json", json_text(whole), "timings.json")


def write_nameless(path: Path, text: str, called: str) -> None:
    """Write a file whose name may be a student's, which the error must not say.

    Raises
    ------
    RadiokitError
        When it cannot be written.
    """
    try:
        write_file(path, text)
    except ParameterError as error:
        cause = error.__cause__
        told = cause.strerror if isinstance(cause, OSError) else ""
        raise RadiokitError(f"{called} cannot be written: {told or 'the system refuses'}") from None
