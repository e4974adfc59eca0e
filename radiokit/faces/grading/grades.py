"""Grades: what a submission earned, question by question, as data that is the same in every run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from radiokit.facts.jsonable import jsonable

__all__ = ["Grade", "PartGrade", "QuestionGrade"]


@dataclass(frozen=True, kw_only=True)
class PartGrade:
    """What one part of a question earned: ``score`` of ``points``, one line, and the misconception."""

    name: str
    title: str
    score: float
    points: float
    visibility: str
    text: str
    diagnosis: str = ""
    confidence: float = 0.0

    @property
    def full(self) -> bool:
        """Whether nothing is missing."""
        return self.score >= self.points * (1 - 1e-12)


@dataclass(frozen=True, kw_only=True)
class QuestionGrade:
    """What one question earned; ``review`` says why a person should look at it, if one should."""

    name: str
    title: str
    parts: tuple[PartGrade, ...]
    review: str = ""

    @property
    def score(self) -> float:
        """What was earned."""
        return round(sum(part.score for part in self.parts), 4)

    @property
    def points(self) -> float:
        """What could be earned."""
        return round(sum(part.points for part in self.parts), 4)

    @property
    def explanation(self) -> str:
        """One line: of the first part that is not full, else of the first."""
        part = next((part for part in self.parts if not part.full), self.parts[0])
        return part.text

    @property
    def diagnosis(self) -> str:
        """The misconception of the first part that has one; empty where there is none."""
        return next((part.diagnosis for part in self.parts if part.diagnosis), "")


@dataclass(frozen=True, kw_only=True)
class Grade:
    """What a submission earned.

    ``problems`` are what went wrong while it was loaded; ``protections`` were active, ``missing`` were not;
    ``complete`` is False while questions are still to be graded; ``seconds`` is wall time by question, which
    is no part of the result.
    """

    assignment: str
    title: str
    student: str
    language: str
    questions: tuple[QuestionGrade, ...]
    problems: tuple[str, ...] = ()
    protections: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    complete: bool = True
    seconds: Mapping[str, float] = field(default_factory=dict, compare=False)
    measured: Mapping[str, float] = field(default_factory=dict, compare=False)

    @property
    def score(self) -> float:
        """What was earned."""
        return round(sum(question.score for question in self.questions), 4)

    @property
    def points(self) -> float:
        """What could be earned."""
        return round(sum(question.points for question in self.questions), 4)

    def __getitem__(self, name: str) -> QuestionGrade:
        for question in self.questions:
            if question.name == name:
                return question
        raise KeyError(name)

    def to_json(self) -> dict[str, Any]:
        """Return the grade as JSON-ready data, without times: the same in every run."""
        result: dict[str, Any] = jsonable(
            {
                "assignment": self.assignment,
                "title": self.title,
                "student": self.student,
                "language": self.language,
                "score": self.score,
                "points": self.points,
                "complete": self.complete,
                "questions": [
                    {
                        "name": question.name,
                        "title": question.title,
                        "score": question.score,
                        "points": question.points,
                        "explanation": question.explanation,
                        "diagnosis": question.diagnosis,
                        "review": question.review,
                        "parts": [vars(part) for part in question.parts],
                    }
                    for question in self.questions
                ],
                "problems": list(self.problems),
                "protections": list(self.protections),
                "missing": list(self.missing),
            }
        )
        return result

    @staticmethod
    def from_json(data: Mapping[str, Any]) -> Grade:
        """Return a grade from what ``to_json`` gave.

        >>> grade = Grade(assignment="a", title="A", student="x", language="en", questions=())
        >>> Grade.from_json(grade.to_json()) == grade
        True
        """
        questions = tuple(
            QuestionGrade(
                name=each["name"],
                title=each["title"],
                parts=tuple(PartGrade(**part) for part in each["parts"]),
                review=each["review"],
            )
            for each in data["questions"]
        )
        plain = {name: data[name] for name in ("assignment", "title", "student", "language", "complete")}
        lists: dict[str, Any] = {name: tuple(data[name]) for name in ("problems", "protections", "missing")}
        return Grade(questions=questions, **plain, **lists)

    def __str__(self) -> str:
        lines = [f"{self.title}: {self.score:g} / {self.points:g}"]
        for question in self.questions:
            lines.append(f"  {question.name}: {question.score:g} / {question.points:g}  {question.title}")
            lines += [
                f"    {part.title}: {part.score:g} / {part.points:g}  {part.text}" for part in question.parts
            ]
        return "\n".join([*lines, *(f"  {problem}" for problem in self.problems)])
