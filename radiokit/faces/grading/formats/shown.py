"""What a reader is shown of a part: its standing, its points, and its finding unless that is hidden."""

from __future__ import annotations

from dataclasses import dataclass

from radiokit.faces.grading.formats.phrases import phrase
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.protocol import plain_text
from radiokit.faces.grading.unfinished import is_pending

__all__ = ["Line", "line_of", "notes_of", "number"]

LONGEST = 1000
"""How many letters of a finding are shown."""


@dataclass(frozen=True, kw_only=True)
class Line:
    """One part as a report shows it: its texts are single lines of printable letters.

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
        title=plain_text(part.title),
        score=number(part.score),
        points=number(part.points),
        standing=standing,
        text=plain_text(part.text, LONGEST) if told else phrase(language, "concealed"),
        diagnosis=plain_text(part.diagnosis) if told else "",
    )


def notes_of(grade: Grade, question: QuestionGrade | None = None) -> list[str]:
    """Return what a person should know of a whole grade, or of one question."""
    if question is not None:
        return [phrase(grade.language, "review")] if question.review else []
    problems = [plain_text(problem, LONGEST) for problem in grade.problems]
    return [*problems, *([] if grade.complete else [phrase(grade.language, "incomplete")])]
