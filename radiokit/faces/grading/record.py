"""Record: a grade in a file, with the fingerprint of all that it depends on, so that it can be continued."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Any

import radiokit
from radiokit.faces.grading.classroom.fingerprint import code_digest, fingerprint, secret_digest
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import TargetError

__all__ = ["continued", "grade_schema", "mark_of", "record"]


def grade_schema() -> dict[str, Any]:
    """Return the JSON schema of ``Grade.to_json()`` and of what ``radiokit grade --json`` prints.

    >>> grade_schema()["title"]
    'radiokit grade'
    """
    text = resources.files("radiokit.faces.grading").joinpath("grade.schema.json").read_text("utf-8")
    result: dict[str, Any] = json.loads(text)
    return result


def mark_of(
    source: str, submission: Path, *, student: str = "", secret: str = "", language: str = "en"
) -> str:
    """Return the digest of what a grade depends on; it is slow to find the secret from it.

    Raises
    ------
    TargetError
        When the submission cannot be read.
    """
    try:
        content = submission.read_bytes()
    except OSError as error:
        raise TargetError(f"cannot read {submission}: {error.strerror}") from error
    return fingerprint(
        content,
        suffix=submission.suffix,
        source=source,
        key="",
        student=student,
        secret=secret_digest(secret),
        language=language,
        limits=None,
        code=code_digest(),
    )


def record(grade: Grade, mark: str) -> dict[str, Any]:
    """Return a grade as JSON-ready data that says what made it."""
    return {"radiokit": radiokit.__version__, "fingerprint": mark, **grade.to_json()}


def continued(path: Path, mark: str) -> Grade | None:
    """Return the grade in a file if it is incomplete and of this fingerprint; anything else is none.

    Questions that a person should look at are left out, so that they are graded again.
    """
    try:
        data = json.loads(path.read_text("utf-8"))
        if data["fingerprint"] != mark or data["complete"]:
            return None
        questions = [question for question in data["questions"] if not question["review"]]
        return Grade.from_json({**data, "questions": questions})
    except (OSError, ValueError, LookupError, TypeError):
        return None
