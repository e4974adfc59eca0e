"""Plugin: grades in otter-grader's own process, so that its kernel runs no student's code.

``otter run``, ``otter grade`` and otter's Gradescope images load it by the name in the master notebook.
Before anything is executed it grades the submission in radiokit's sandbox, and hands otter a notebook in
which no cell is left to be executed: the test cases then read the grade that is there. So an endless loop
costs its own question alone, and a submission cannot reach the tests, the references or its points.

A submission may be many files, and otter and its kernel work among them: they would import a ``numpy.py``,
unpickle otter's log, and find an assignment there rather than the one that otter then leaves out. So all of
them are put aside first, and what is the instructor's is taken from where otter unpacked it.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

from radiokit.faces.grading.command import read_secret
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.handout.kernel import GRADED, submitted
from radiokit.facts.errors import TargetError

__all__ = ["Plugin"]

TESTS = "tests"
"""What otter itself puts beside a submission, anew."""


class Plugin:
    """An otter plugin; otter gives it the submission's path, its metadata, and what the master says of it.

    That is ``assignment`` and ``language``. Inputs are unforeseeable where the environment has a secret.
    """

    def __init__(
        self, submission_path: str | None, submission_metadata: Any, plugin_config: dict[str, str]
    ) -> None:
        self._config = plugin_config
        self._student = _student(submission_metadata)
        self._file = Path.cwd() / (submission_path or "")  # none while otter builds an autograder
        self._source = self._file.parent.parent / "source" / "files"
        self._folder = tempfile.TemporaryDirectory(prefix="radiokit-otter-")
        self._report = ""

    def before_grading(self, config: Any) -> None:
        """Put aside what was handed in beside the submission; put the instructor's files there."""
        place = self._file.parent
        for name in sorted({each.name for each in place.iterdir()} - {TESTS, self._file.name}):
            self._put_aside(name)
        for each in self._source.iterdir() if self._source.is_dir() else ():
            if each.is_dir() and each.name != TESTS:
                shutil.copytree(each, place / each.name)
            elif each.is_file() and each.name != self._file.name:
                shutil.copy(each, place)

    def before_execution(self, submission: Any) -> Any:
        """Grade the submission, and return it with nothing in it to execute."""
        self._put_aside(self._file.name)  # a script may be named as a module
        cells = [cell for cell in submission.cells if cell.cell_type == "code"]
        copy = Path(self._folder.name, "submission.ipynb")
        copy.write_text(submitted(cell.source for cell in cells), encoding="utf-8")
        found = grade(
            self._assignment(),
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
        shutil.move(self._store / self._file.name, self._file)
        self._folder.cleanup()
        for question in self._grade.questions:
            if question.name in results.results:
                results.update_score(question.name, question.score)

    def _assignment(self) -> str:
        """Return the assignment's name, or its file as the instructor gave it."""
        assignment = self._config["assignment"]
        if Path(assignment).suffix != ".py":
            return assignment
        file = self._source / assignment
        if not file.is_file():
            raise TargetError(f"the autograder has no file {assignment}")
        return str(file)

    @property
    def _store(self) -> Path:
        store = Path(self._folder.name, "aside")
        store.mkdir(mode=0o700, exist_ok=True)
        return store

    def _put_aside(self, name: str) -> None:
        shutil.move(self._file.parent / name, self._store / name)  # of a link, the link

    def generate_report(self) -> str:
        """Return the grade in words, for the instructor's log."""
        return self._report


def _student(metadata: Any) -> str:
    """Return who it is, as far as Gradescope says."""
    users = metadata.get("users") if isinstance(metadata, dict) else None
    names = [str(user.get("email", "")) for user in users or () if isinstance(user, dict)]
    return ",".join(sorted(names))
