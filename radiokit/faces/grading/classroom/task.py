"""Task: what one worker is sent and sends back: a submission's bytes, and its grade as data."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from radiokit.faces.grading.assignment import Assignment, assignment_from_source
from radiokit.faces.grading.classroom.fingerprint import code_digest
from radiokit.faces.grading.classroom.reasons import reason
from radiokit.faces.grading.formats.writing import json_text, write_file
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.grades import Grade
from radiokit.faces.grading.isolation.interrupts import held
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.record import continued, record
from radiokit.faces.grading.unfinished import nothing_yet, with_pending
from radiokit.facts.errors import RadiokitError

__all__ = ["Done", "Order", "Task", "assignment_of", "failed", "perform"]

ONE_AT_A_TIME = threading.Lock()
"""What a submission prints is caught process-wide, so threads of one worker take turns."""


@dataclass(frozen=True)
class Order:
    """What all tasks of a run share; what it is made of is in no log, as its text does not show it.

    ``source`` and ``file`` are the assignment's, ``code`` is the digest of the radiokit that gave the order.
    """

    source: str
    file: str
    secret: str
    language: str
    limits: Limits | None
    code: str

    def __repr__(self) -> str:
        return "Order()"


@dataclass(frozen=True)
class Task:
    """One submission and its fingerprint; ``journal`` is a file to keep what is graded so far, or ""."""

    order: Order
    content: bytes
    suffix: str
    student: str
    mark: str
    journal: str

    def __repr__(self) -> str:
        return "Task()"


@dataclass(frozen=True)
class Done:
    """A grade as data, and what was measured."""

    grade: Mapping[str, Any]
    seconds: Mapping[str, float] = field(default_factory=dict)
    measured: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        return "Done()"


@lru_cache(maxsize=2)
def assignment_of(order: Order) -> Assignment:
    """Return the assignment of an order, within its limits."""
    found = assignment_from_source(order.source, order.file)
    return found if order.limits is None else replace(found, limits=order.limits)


def perform(task: Task) -> Done:
    """Grade a submission, whatever happens; the same wherever it runs.

    Raises
    ------
    RadiokitError
        When the radiokit here is not the one that gave the order.
    """
    order = task.order
    if order.code != code_digest():
        raise RadiokitError("a worker has another radiokit than this one: install the same everywhere")
    with ONE_AT_A_TIME, held():
        try:
            found = grade(
                assignment_of(order),
                f"submission{task.suffix}",
                content=task.content,
                student=task.student,
                secret=order.secret,
                language=order.language,
                earlier=continued(Path(task.journal), task.mark) if task.journal else None,
                keep=(lambda grade: _keep(task, grade)) if task.journal else None,
            )
        except Exception as error:
            return failed(order, task.student, "failed", error=plain_text(f"{type(error).__name__}: {error}"))
    return Done(found.to_json(), dict(found.seconds), dict(found.measured))


def failed(order: Order, student: str, key: str, **values: Any) -> Done:
    """Return the grade of what could not be graded: no points so far, and why a person should look."""
    text = reason(order.language, key, **values)
    work = assignment_of(order)
    blank = with_pending(nothing_yet(work, student=student, language=order.language), work)
    questions = tuple(replace(question, review=text) for question in blank.questions)
    return Done(replace(blank, questions=questions, problems=(text,), complete=True).to_json())


def _keep(task: Task, grade: Grade) -> None:
    if not grade.complete:
        with suppress(RadiokitError):  # then more is graded again, should this run be stopped
            write_file(Path(task.journal), json_text(record(grade, task.mark)))
