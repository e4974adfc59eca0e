"""Plugin: grades in otter-grader's own process, so that its kernel runs no student's code.

``otter run``, ``otter grade`` and otter's Gradescope images load it by the name in the master notebook.
Before anything is executed it grades the submission in radiokit's sandbox, and hands otter a notebook in
which no cell is left to be executed: the test cases then read the grade that is there. So an endless loop
costs its own question alone, and a submission cannot reach the tests, the references or its points.
"""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import Any

from radiokit.faces.grading.command import read_secret
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.handout.kernel import GRADED, submitted

__all__ = ["Plugin"]


class Plugin:
    """An otter plugin; otter gives it the submission's path, its metadata, and what the master says of it.

    That is ``assignment`` and ``language``. Inputs are unforeseeable where the environment has a secret.
    """

    def __init__(self, submission_path: str, submission_metadata: Any, plugin_config: dict[str, str]) -> None:
        self._config = plugin_config
        self._student = _student(submission_metadata)
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._report = ""

    def before_execution(self, submission: Any) -> Any:
        """Grade the submission, and return it with nothing in it to execute."""
        self._folder = tempfile.TemporaryDirectory(prefix="radiokit-otter-")
        cells = [cell for cell in submission.cells if cell.cell_type == "code"]
        copy = Path(self._folder.name, "submission.ipynb")
        copy.write_text(submitted(cell.source for cell in cells), encoding="utf-8")
        found = grade(
            self._config["assignment"],
            copy,
            student=self._student,
            secret=read_secret(None),
            language=self._config["language"],
        )
        self._report = str(found)
        file = Path(self._folder.name, "grade.json")
        file.write_text(json.dumps(found.to_json()), encoding="utf-8")
        os.environ[GRADED] = str(file)
        self._grade = found
        for cell in cells:
            cell.source = ""
        return submission

    def after_grading(self, results: Any) -> None:
        """Set the points that each question earned, parts of points included."""
        os.environ.pop(GRADED, None)
        if self._folder is not None:
            self._folder.cleanup()
        for question in self._grade.questions:
            if question.name in results.results:
                results.update_score(question.name, question.score)

    def generate_report(self) -> str:
        """Return the grade in words, for the instructor's log."""
        return self._report


def _student(metadata: Any) -> str:
    """Return who it is, as far as Gradescope says."""
    users = metadata.get("users") if isinstance(metadata, dict) else None
    names = [str(user.get("email", "")) for user in users or () if isinstance(user, dict)]
    return ",".join(sorted(names))
