"""Autograder: what ``run_autograder`` starts on Gradescope: finds the work and whose it is, and grades it.

It is started as ``python -m radiokit.faces.grading.autograder BASE LANGUAGE``; BASE is ``/autograder``
there. It prints no names. With ``--check`` alone it says whether submissions could read the secret.
"""

from __future__ import annotations

import contextlib
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from radiokit.faces.console import fail
from radiokit.faces.grading.assignment import load_assignment
from radiokit.faces.grading.classroom.contents import read_submission
from radiokit.faces.grading.classroom.discovery import Entry
from radiokit.faces.grading.classroom.reasons import NoSubmissionError
from radiokit.faces.grading.formats.gradescope import to_gradescope
from radiokit.faces.grading.formats.writing import json_text, write_file
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.faces.grading.unfinished import no_submission

__all__ = ["main", "student_of"]


def student_of(metadata: Any) -> str:
    """Return who handed in, from Gradescope's metadata: an address, or those of a group in order.

    It is the same whoever of a group hands in, and however often.

    >>> student_of({"users": [{"email": "b@x", "id": 2}, {"email": "a@x", "id": 1}]})
    'a@x,b@x'
    """
    users = metadata.get("users") if isinstance(metadata, dict) else None
    names = [
        plain_text(user.get("email") or user.get("id") or "")
        for user in (users if isinstance(users, list) else [])
        if isinstance(user, dict)
    ]
    return ",".join(sorted(filter(None, names)))


def main(arguments: Sequence[str] | None = None) -> int:
    """Grade what was handed in, and write ``results/results.json``; return 0 when it is there."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words == ["--check"]:
        return _check()
    base, language = words
    place = Path(base)
    source, results = place / "source", place / "results" / "results.json"
    try:
        metadata = json.loads((place / "submission_metadata.json").read_text("utf-8"))
    except (OSError, ValueError):
        metadata = None
    student = student_of(metadata)
    work = load_assignment(source / "assignment.py")
    try:
        handed_in = {place / "submission": "submission"}
        found = read_submission(Entry(key="submission", student=student, paths=handed_in), work.name)
    except NoSubmissionError as error:
        grade = no_submission(work, error.text(language), student=student, language=language)
        write_file(results, json_text(to_gradescope(grade)))
        return 0
    with TemporaryDirectory(prefix="radiokit-") as folder:
        file = Path(folder, f"{work.name}{found.suffix}")
        file.write_bytes(found.content)
        _grade(file, source, results, student, language)
    return 0 if results.is_file() else 1


def _grade(file: Path, source: Path, results: Path, student: str, language: str) -> None:
    from radiokit.faces.cli import main as radiokit

    words = ["grade", str(file), f"--assignment={source / 'assignment.py'}", f"--student={student}"]
    words += [f"--secret-file={source / 'secret.txt'}", f"--language={language}"]
    with contextlib.suppress(SystemExit):  # what it means is in the file
        radiokit([*words, f"--out=gradescope={results}"])


def _check() -> int:
    """Return 0 if a submission is kept from the files of others, by a root or a user of its own."""
    with TemporaryDirectory(prefix="radiokit-") as folder:
        file = Path(folder, "empty.py")
        file.write_text("", encoding="utf-8")
        with Sandbox(file) as sandbox:
            protections = sandbox.load().protections
    if {"root", "user"} & set(protections):
        return 0
    fail("submissions could read the secret here: build the image as root, with a Python that all can read")
    return 1


if __name__ == "__main__":
    sys.exit(main())
