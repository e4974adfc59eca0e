"""CSV: the grades of a class, a row each."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable

from radiokit.faces.grading.formats.shown import number, plain
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import ParameterError

__all__ = ["to_csv"]

_NUMBER = r"[+-]?(?:[\d.]+(?:e[+-]?\d+)?|inf|nan)(?=[\s;,|)\]}]|$)"
_FORMULA = re.compile(
    rf"""(^|([;,|])["'\s]*(?!{_NUMBER}(?!(?:(?!\2)[^)\]}}])*[-+*/^&<>=%:!])))(?=[=+@-]|[＝＋＠－])""",
    re.IGNORECASE,
)
"""Where a formula may begin, in the letters of wide fonts too; a number within a text is none, unless there
is an operator after it before the cell would end."""
_DIALECTS = {"": ("", ",", "."), "en": ("\ufeff", ",", "."), "ru": ("\ufeff", ";", ",")}


def to_csv(grades: Iterable[Grade], *, excel: str = "") -> str:
    """Return the grades of a class as CSV, a row for each submission, by student.

    The columns: the student, the total and what could be earned, the score of each question, the diagnoses,
    and a note on what a person should look at. A text that a spreadsheet would run as a formula gets an
    apostrophe before it; so does a part of one, as another language's spreadsheet cuts cells elsewhere.

    Parameters
    ----------
    grades : iterable of Grade
        Of one assignment.
    excel : str
        ``"en"`` or ``"ru"`` for what Excel opens in these languages: with a byte order mark and, in Russian,
        semicolons and decimal commas. By default, what everyone else reads.

    Raises
    ------
    ParameterError
        When the grades are of several assignments, or ``excel`` is no such language.

    >>> grade = Grade(assignment="a", title="A", student="=1+1", language="en", questions=())
    >>> print(to_csv([grade]))
    student,total,points,diagnosis,note
    '=1+1,0,0,,
    """
    if excel not in _DIALECTS:
        raise ParameterError("excel", excel, "'en', 'ru' or ''")
    mark, delimiter, point = _DIALECTS[excel]
    rows = sorted(map(plain, grades), key=lambda grade: grade.student)
    assignments = sorted({grade.assignment for grade in rows})
    if len(assignments) > 1:
        raise ParameterError("grades", ", ".join(assignments), "grades of one assignment")
    names = list(dict.fromkeys(question.name for grade in rows for question in grade.questions))
    out = io.StringIO(newline="")
    writer = csv.writer(out, delimiter=delimiter, lineterminator="\n")
    writer.writerow(["student", "total", "points", *map(_text, names), "diagnosis", "note"])
    for grade in rows:
        scores = {question.name: number(question.score) for question in grade.questions}
        diagnoses = [f"{each.name}: {each.diagnosis}" for each in grade.questions if each.diagnosis]
        numbers = [number(grade.score), number(grade.points), *(scores.get(name, "") for name in names)]
        texts = ["; ".join(diagnoses), _note(grade)]
        writer.writerow(
            [_text(grade.student), *(each.replace(".", point) for each in numbers), *map(_text, texts)]
        )
    return mark + out.getvalue()


def _note(grade: Grade) -> str:
    reviews = [
        f"{question.name}: {question.review}"
        for question in grade.questions
        if question.review and question.review not in grade.problems  # which are said already
    ]
    return "; ".join([*([] if grade.complete else ["incomplete"]), *grade.problems, *reviews])


def _text(text: str) -> str:
    """Return a text cell that no spreadsheet takes for a formula, wherever it cuts.

    >>> _text("=1+1"), _text("a;=1+1"), _text("a (3, -4)")
    ("'=1+1", "a;'=1+1", 'a (3, -4)')
    """
    return _FORMULA.sub(r"\1'", text)
