"""What a reader is shown of a part: its standing, its points, and its finding unless that is hidden."""

from __future__ import annotations

from dataclasses import dataclass, replace

from radiokit.faces.grading.formats.phrases import phrase
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.unfinished import is_pending

__all__ = ["Line", "line_of", "notes_of", "number", "plain"]

LONGEST = 1000
"""How many letters of a finding are shown."""


def plain(grade: Grade) -> Grade:
    r"""Return a grade with all its texts as single lines of printable letters, whatever they were.

    >>> plain(Grade(assignment="a", title="A\x1b[1m", student="x", language="en", questions=())).title
    'A?[1m'
    """
    return Grade(
        assignment=plain_text(grade.assignment),
        title=plain_text(grade.title),
        student=plain_text(grade.student),
        language=grade.language,
        questions=tuple(
            QuestionGrade(
                name=plain_text(question.name),
                title=plain_text(question.title),
                parts=tuple(map(_plain_part, question.parts)),
                review=plain_text(question.review),
            )
            for question in grade.questions
        ),
        problems=tuple(plain_text(problem, LONGEST) for problem in grade.problems),
        protections=tuple(map(plain_text, grade.protections)),
        missing=tuple(map(plain_text, grade.missing)),
        complete=grade.complete,
    )


def _plain_part(part: PartGrade) -> PartGrade:
    return replace(
        part,
        name=plain_text(part.name),
        title=plain_text(part.title),
        text=plain_text(part.text, LONGEST),
        diagnosis=plain_text(part.diagnosis),
    )


@dataclass(frozen=True, kw_only=True)
class Line:
    """One part as a report shows it.

    ``standing`` is ``"full"``, ``"partial"``, ``"none"`` or ``"pending"``.
    """

    title: str
    score: str
    points: str
    standing: str
    text: str
    diagnosis: str


def number(value: float) -> str:
    """Return points as they are printed: at most four decimals, no trailing zeros.

    >>> number(2 / 3), number(2.0)
    ('0.6667', '2')
    """
    return f"{value:.4f}".rstrip("0").rstrip(".")


def line_of(part: PartGrade, language: str, *, reveal: bool = False) -> Line:
    """Return what is shown of a part.

    What was found about a part that is not ``"visible"`` gives way to a phrase, unless ``reveal`` is true.
    """
    if is_pending(part):
        standing = "pending"
    else:
        standing = "full" if part.full else "partial" if part.score > 0 else "none"
    told = reveal or part.visibility == "visible" or standing == "pending"
    return Line(
        title=part.title,
        score=number(part.score),
        points=number(part.points),
        standing=standing,
        text=part.text if told else phrase(language, "concealed"),
        diagnosis=part.diagnosis if told else "",
    )


def notes_of(grade: Grade, question: QuestionGrade | None = None, *, reveal: bool = False) -> list[str]:
    """Return what a person should know of a whole grade, or of a question; if ``reveal``, why, too."""
    if question is not None:
        told = phrase(grade.language, "review")
        cause = f" ({question.review})" if reveal and question.review not in grade.problems else ""
        return [told + cause] if question.review else []
    return [*grade.problems, *([] if grade.complete else [phrase(grade.language, "incomplete")])]
