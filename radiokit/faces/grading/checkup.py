"""Checkup: tries an assignment before its class does: blanks earn nothing, its solution all."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from radiokit.faces.grading.assignment import (
    Assignment,
    assignment_from_source,
    assignment_source,
)
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.handout.cells import script
from radiokit.faces.grading.handout.copies import student_cells
from radiokit.faces.grading.handout.worked import read_solution
from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.rehearsal import faults
from radiokit.faces.grading.unfound import unfound
from radiokit.faces.workers import open_executor
from radiokit.facts.errors import ParameterError

__all__ = ["Checkup", "check_assignment"]

STUDENTS = 12
SLOW = 0.5
"""The share of a question's time above which it is said to be slow: a class's computers are slower."""


@dataclass(frozen=True, kw_only=True)
class Checkup:
    """What was found about an assignment.

    ``mistakes`` are lines that name the question, the part, and what is wrong; ``notes`` are what need not be
    wrong. ``seconds`` are the median and the largest wall time of each question, where a solution was graded.
    """

    assignment: str
    students: int
    solved: bool
    questions: tuple[str, ...]
    mistakes: tuple[str, ...]
    notes: tuple[str, ...]
    seconds: Mapping[str, tuple[float, float]]

    @property
    def ok(self) -> bool:
        """Whether there are no mistakes."""
        return not self.mistakes

    def to_json(self) -> dict[str, Any]:
        """Return all as JSON-ready data."""
        return {
            "assignment": self.assignment,
            "ok": self.ok,
            "students": self.students,
            "solved": self.solved,
            "questions": list(self.questions),
            "mistakes": list(self.mistakes),
            "notes": list(self.notes),
            "seconds": {name: {"median": low, "largest": high} for name, (low, high) in self.seconds.items()},
        }

    def __str__(self) -> str:
        lines = [f"{self.assignment}: {len(self.questions)} questions, tried for {self.students} students"]
        lines += [f"  ✗ {mistake}" for mistake in self.mistakes]
        lines += [f"  · {note}" for note in self.notes]
        for name, (middle, most) in self.seconds.items():
            lines.append(f"  {name}: {middle:.2g} s, at most {most:.2g} s")
        told = "; the solution earns full marks" if self.solved else ""
        return "\n".join([*lines, f"  ✓ blanks earn nothing{told}"] if self.ok else lines)


@dataclass(frozen=True)
class _Try:
    """A submission to be graded for a student; of the assignment's text, so that any process can."""

    assignment: Assignment | tuple[str, str]
    submission: str
    content: bytes | None
    student: str
    secret: str
    language: str
    questions: tuple[str, ...]


def check_assignment(
    assignment: str | Path | Assignment,
    *,
    solution: str | Path | None = None,
    students: int = STUDENTS,
    secret: str = "",
    workers: int | None = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Checkup:
    """Try an assignment before its class does.

    For some students' inputs, all that the judges call of the assignment's own is called: it must give finite
    numbers, and the same ones again. A student's copy with its blanks must earn nothing. A solution must earn
    full marks with each student's inputs, in each of its languages in turn.

    Parameters
    ----------
    assignment : str, Path or Assignment
        A name among ``list_assignments()``, or a file of your own.
    solution : str or Path, optional
        A script with the right functions.
    students : int
        For how many students, at least 1.
    secret : str
        As for the grades.
    workers : int, optional
        Local processes; as many as there are processors where it is None. An ``Assignment`` has one.
    progress : callable, optional
        Called with the number of finished submissions and of all.

    Raises
    ------
    RadiokitError
        When the assignment or the solution cannot be loaded.

    >>> found = check_assignment("radiometry", students=1)
    >>> found.ok, found.notes
    (True, ('no solution was tried',))
    """
    if type(students) is not int or students < 1:
        raise ParameterError("students", students, "an integer of at least 1")
    text = None if isinstance(assignment, Assignment) else assignment_source(assignment)
    work = assignment if isinstance(assignment, Assignment) else assignment_from_source(*(text or ("", "")))
    if solution is not None:
        read_solution(solution, work)
    names = [f"student {number}" for number in range(1, students + 1)]
    wrong: dict[tuple[str, str], str] = {}
    for name in names:
        for fault in faults(work, student=name, secret=secret):
            wrong.setdefault((fault.fields["question"], fault.fields["part"]), f"{fault}".split(": ", 1)[1])
    mistakes = list(wrong.values())
    sound = tuple(each.name for each in work.questions if each.name not in {name for name, _ in wrong})
    blanks = [
        _Try(
            text or work,
            "blank.py",
            script(student_cells(work, language)).encode(),
            names[0],
            secret,
            language,
            sound,
        )
        for language in work.languages
    ]
    solved = []
    for number, name in enumerate(names if solution is not None else ()):
        language = work.languages[number % len(work.languages)]
        solved.append(_Try(text or work, str(solution), None, name, secret, language, sound))
    grades = list(_graded([*blanks, *solved] if sound else [], workers if text else 1, progress))
    for given in grades[: len(blanks)]:
        for question, part in _parts(given):
            if part.score > 0:
                worth = f"{part.score:g} of {part.points:g}"
                mistakes.append(f"question {question.name}, part {part.name}: a blank earns {worth} points")
    mistakes += _short(grades[len(blanks) :])
    seconds = _seconds(grades[len(blanks) :])
    notes = [] if solution is not None else ["no solution was tried"]
    notes += [
        f"question {question.name}, part {part.name}: rtol, ulps and atol are 0: "
        "only answers right to the last bit count"
        for question in work.questions
        for part in question.parts
        if isinstance(part.judge, Values) and part.judge.rtol == part.judge.ulps == part.judge.atol == 0
    ]
    notes += [] if wrong else unfound(work)
    for name, (_, most) in seconds.items():
        allowed = work.question(name).seconds
        if most > SLOW * allowed:
            told = f"the solution takes up to {most:.2g} s, and each part is stopped after {allowed:g} s"
            notes.append(f"question {name}: {told}")
    return Checkup(
        assignment=work.name,
        students=students,
        solved=solution is not None,
        questions=tuple(question.name for question in work.questions),
        mistakes=tuple(dict.fromkeys(mistakes)),
        notes=tuple(notes),
        seconds=seconds,
    )


def _graded(
    tries: Sequence[_Try], workers: int | None, progress: Callable[[int, int], None] | None
) -> Iterator[Grade]:
    with open_executor(workers) as executor:
        for number, found in enumerate(executor.map(_grade, tries), start=1):
            if progress is not None:
                progress(number, len(tries))
            yield found


def _grade(one: _Try) -> Grade:
    of = one.assignment
    return grade(
        of if isinstance(of, Assignment) else assignment_from_source(*of),
        one.submission,
        content=one.content,
        student=one.student,
        secret=one.secret,
        language=one.language,
        questions=one.questions,
    )


def _parts(grade: Grade) -> Iterator[tuple[QuestionGrade, PartGrade]]:
    for question in grade.questions:
        for part in question.parts:
            yield question, part


def _short(grades: Sequence[Grade]) -> list[str]:
    """Return what is said where a solution falls short, once for each part."""
    found: dict[str, list[str]] = {}
    for given in grades:
        for question, part in _parts(given):
            if not part.full:
                said = question.review or part.text
                said = f"{said} ({part.score:g} of {part.points:g} points, for {given.student})"
                found.setdefault(f"question {question.name}, part {part.name}", []).append(said)
    return [
        f"{where}: the solution falls short for {len(said)} of {len(grades)} students: {said[0]}"
        for where, said in found.items()
    ]


def _seconds(grades: Sequence[Grade]) -> dict[str, tuple[float, float]]:
    """Return the median and the largest wall time of each question."""
    times: dict[str, list[float]] = {}
    for given in grades:
        for name, seconds in given.seconds.items():
            times.setdefault(name, []).append(seconds)
    return {name: (statistics.median(each), max(each)) for name, each in times.items()}
