"""Autograder: what ``run_autograder`` starts on Gradescope: finds the work and whose it is, and grades it.

It is started as ``python -m radiokit.faces.grading.autograder BASE ASSIGNMENT LANGUAGE``; BASE is
``/autograder`` there. It prints no names.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from radiokit.faces.grading.assignment import load_assignment
from radiokit.faces.grading.formats.gradescope import to_gradescope
from radiokit.faces.grading.formats.writing import json_text, write_file
from radiokit.faces.grading.unfinished import no_submission
from radiokit.facts.errors import TargetError

__all__ = ["find_submission", "main", "student_of"]

SUFFIXES = (".py", ".ipynb")
SHOWN = 5
"""How many file names a message tells."""


def student_of(metadata: Any) -> str:
    """Return who handed in, from Gradescope's metadata: an address, or those of a group in order.

    It is the same whoever of a group hands in, and however often.

    >>> student_of({"users": [{"email": "b@x", "id": 2}, {"email": "a@x", "id": 1}]})
    'a@x,b@x'
    """
    users = metadata.get("users") if isinstance(metadata, dict) else None
    names = [
        str(user.get("email") or user.get("id") or "").strip()
        for user in (users if isinstance(users, list) else [])
        if isinstance(user, dict)
    ]
    return ",".join(sorted(filter(None, names)))


def find_submission(folder: Path, assignment: str) -> Path:
    """Return the one script or notebook of a folder, or the one of the assignment's name.

    Links do not count: they could lead to what a student must not read.

    Raises
    ------
    TargetError
        When there is none, or several.
    """
    found = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith((".", "__")))
        paths = (Path(place, name) for name in sorted(names) if not name.startswith("."))
        found += [path for path in paths if path.suffix in SUFFIXES and not path.is_symlink()]
    if len(found) > 1:
        found = [path for path in found if path.stem == assignment] or found
    if len(found) == 1:
        return found[0]
    wanted = f"one file {assignment}.py or {assignment}.ipynb is wanted"
    if not found:
        raise TargetError(f"{wanted}, there is none")
    listed = ", ".join(str(path.relative_to(folder)) for path in found[:SHOWN])
    raise TargetError(f"{wanted}, there are {listed}{', ...' if len(found) > SHOWN else ''}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Grade what was handed in, and write ``results/results.json``; return 0 when it is there."""
    base, assignment, language = sys.argv[1:] if arguments is None else arguments
    place = Path(base)
    try:
        metadata = json.loads((place / "submission_metadata.json").read_text("utf-8"))
    except (OSError, ValueError):
        metadata = None
    student, results = student_of(metadata), place / "results" / "results.json"
    work = load_assignment(assignment)
    try:
        submission = find_submission(place / "submission", work.name)
    except TargetError as error:
        grade = no_submission(work, str(error), student=student, language=language)
        write_file(results, json_text(to_gradescope(grade)))
        return 0
    from radiokit.faces.cli import main as radiokit

    options = ["--assignment", assignment, "--student", student, "--language", language]
    secret = ["--secret-file", str(place / "source" / "secret.txt")]
    with contextlib.suppress(SystemExit):  # what it means is in the file
        radiokit(["grade", str(submission), *options, *secret, "--out", f"gradescope={results}"])
    return 0 if results.is_file() else 1


if __name__ == "__main__":
    sys.exit(main())
