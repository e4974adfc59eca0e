"""Task: what one worker is sent and sends back: a submission's bytes, and its grade as data."""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, NoReturn

from radiokit.faces.grading.assignment import Assignment, assignment_from_source
from radiokit.faces.grading.classroom.fingerprint import code_digest
from radiokit.faces.grading.classroom.reasons import reason
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.limits import Limits
from radiokit.faces.grading.protocol import plain_text
from radiokit.facts.errors import RadiokitError

__all__ = ["Done", "Order", "Task", "assignment_of", "nothing", "perform", "write_whole"]

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
    """One submission; ``journal`` is the file to keep what is graded so far, or "" to keep nothing."""

    order: Order
    content: bytes
    suffix: str
    student: str
    journal: str

    def __repr__(self) -> str:
        return "Task()"


@dataclass(frozen=True)
class Done:
    """A grade as data, what was measured, and why there is none if the grader itself failed."""

    grade: Mapping[str, Any]
    seconds: Mapping[str, float] = field(default_factory=dict)
    measured: Mapping[str, float] = field(default_factory=dict)
    failed: bool = False

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
    folder = ""
    with ONE_AT_A_TIME, _ending_cleanly():
        try:
            with tempfile.TemporaryDirectory(prefix="radiokit-") as folder:
                file = Path(folder, f"submission{task.suffix}")
                file.write_bytes(task.content)
                found = grade(
                    assignment_of(order),
                    file,
                    student=task.student,
                    secret=order.secret,
                    language=order.language,
                    earlier=_earlier(task.journal),
                    keep=(lambda grade: _keep(task.journal, grade)) if task.journal else None,
                )
        except Exception as error:
            told = f"{type(error).__name__}: {error}"
            told = plain_text(told.replace(folder, "") if folder else told)
            text = reason(order.language, "failed", error=told)
            return Done(nothing(order, task.student, text, review=text), failed=True)
    return Done(found.to_json(), dict(found.seconds), dict(found.measured))


def nothing(order: Order, student: str, text: str, *, review: str = "") -> dict[str, Any]:
    """Return the grade of what cannot be graded, as data: no points, and why."""
    work, language = assignment_of(order), order.language
    questions = tuple(
        QuestionGrade(
            name=question.name,
            title=question.title[language],
            parts=tuple(
                PartGrade(
                    name=part.name,
                    title=part.title[language],
                    score=0.0,
                    points=question.worth(part),
                    visibility=part.visibility,
                    text=text,
                )
                for part in question.parts
            ),
            review=review,
        )
        for question in work.questions
    )
    return Grade(
        assignment=work.name,
        title=work.title[language],
        student=student,
        language=language,
        questions=questions,
        problems=(text,),
    ).to_json()


def write_whole(path: Path, text: str) -> None:
    """Write a file such that it is there whole or not at all, whenever this process ends."""
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        draft.write_text(text, encoding="utf-8")
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)


def _keep(journal: str, grade: Grade) -> None:
    if not grade.complete:
        write_whole(Path(journal), json.dumps(grade.to_json(), ensure_ascii=False))


def _earlier(journal: str) -> Grade | None:
    """Return what was graded before a run was cut short; its name says of what."""
    if journal:
        with suppress(OSError, ValueError, KeyError, TypeError):
            return Grade.from_json(json.loads(Path(journal).read_text(encoding="utf-8")))
    return None


class _EndedError(BaseException):
    """Raised where a worker is told to end."""


@contextmanager
def _ending_cleanly() -> Iterator[None]:
    """Where this is a worker's main thread, let SIGTERM first close the sandbox and remove its files."""
    if multiprocessing.parent_process() is None or threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _end)
    try:
        yield
    except _EndedError:
        os._exit(128 + signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)


def _end(signum: int, frame: object) -> NoReturn:
    raise _EndedError
