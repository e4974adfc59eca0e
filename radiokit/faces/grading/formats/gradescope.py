"""Gradescope: a grade as the ``results.json`` of its autograders.

The format: https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

from __future__ import annotations

from typing import Any

import radiokit
from radiokit.faces.grading.formats.phrases import phrase
from radiokit.faces.grading.formats.shown import notes_of, plain
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade

__all__ = ["to_gradescope"]


def to_gradescope(grade: Grade) -> dict[str, Any]:
    """Return a grade as the content of Gradescope's ``results.json``.

    Each part of a question is a test with its own visibility, which Gradescope enforces: it shows students
    no total while some parts are still to be shown. All is plain text, that Gradescope escapes. What the
    autograder prints is shown to instructors alone. The time is left out, so that the same submission gives
    the same file.

    Parameters
    ----------
    grade : Grade
        A complete one, or one that ``with_pending`` has filled up.

    Returns
    -------
    dict
        Ready for ``json.dumps``.

    >>> part = {"name": "ordinary", "title": "ordinary inputs", "score": 1.0, "points": 2.0, "text": "close"}
    >>> question = QuestionGrade(name="f", title="F", parts=(PartGrade(**part, visibility="hidden"),))
    >>> grade = Grade(assignment="a", title="A", student="x", language="en", questions=(question,))
    >>> test = to_gradescope(grade)["tests"][0]
    >>> test["name"], test["score"], test["max_score"], test["visibility"], test["status"]
    ('f: ordinary inputs', 1.0, 2.0, 'hidden', 'failed')
    """
    grade = plain(grade)
    result: dict[str, Any] = {
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "output": "\n".join([f"{grade.title}", *notes_of(grade)]),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "tests": [
            _test(grade, question, part, f"{i}.{j}")
            for i, question in enumerate(grade.questions, 1)
            for j, part in enumerate(question.parts, 1)
        ],
        "extra_data": {
            "radiokit": radiokit.__version__,
            "assignment": grade.assignment,
            "complete": grade.complete,
            "protections": list(grade.protections),
            "missing": list(grade.missing),
            "review": {question.name: question.review for question in grade.questions if question.review},
        },
    }
    return result


def _test(grade: Grade, question: QuestionGrade, part: PartGrade, number: str) -> dict[str, Any]:
    review = [phrase(grade.language, "review")] if question.review else []
    return {
        "number": number,
        "name": f"{question.name}: {part.title}",
        "name_format": "text",
        "score": round(part.score, 4),
        "max_score": round(part.points, 4),
        "status": "passed" if part.full else "failed",
        "output": "\n".join([part.text, *review]),
        "output_format": "text",
        "visibility": part.visibility,
        "extra_data": {"question": question.name, "part": part.name, "diagnosis": part.diagnosis},
    }
