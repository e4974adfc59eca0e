"""Record: a grade in a file, with the fingerprint of all that it depends on, so that it can be continued."""

from __future__ import annotations

import hashlib
import hmac
import json
from importlib import resources
from pathlib import Path
from typing import Any

import radiokit
from radiokit.faces.grading.assignment import FOLDER
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import TargetError

__all__ = ["continued", "fingerprint", "grade_schema", "record"]


def grade_schema() -> dict[str, Any]:
    """Return the JSON schema of ``Grade.to_json()`` and of what ``radiokit grade --json`` prints.

    >>> grade_schema()["title"]
    'radiokit grade'
    """
    text = resources.files("radiokit.faces.grading").joinpath("grade.schema.json").read_text("utf-8")
    result: dict[str, Any] = json.loads(text)
    return result


def fingerprint(
    assignment: str | Path,
    submission: str | Path,
    *,
    student: str = "",
    secret: str = "",
    language: str = "en",
) -> str:
    """Return a text that is another for another submission, assignment, student, secret, language or version.

    It does not tell the secret.

    Raises
    ------
    TargetError
        When a file cannot be read.
    """
    path = Path(assignment)
    work = path if path.suffix == ".py" else FOLDER / f"{assignment}.py"
    parts = [radiokit.__version__, student, language, str(assignment), Path(submission).name]
    try:
        parts += [hashlib.sha256(file.read_bytes()).hexdigest() for file in (work, Path(submission))]
    except OSError as error:
        raise TargetError(f"cannot read {error.filename}: {error.strerror}") from error
    return hmac.new(secret.encode(), json.dumps(parts).encode(), "sha256").hexdigest()


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
