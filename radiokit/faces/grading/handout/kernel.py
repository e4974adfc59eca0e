"""Kernel: what the test cells of otter-grader and nbgrader call.

A test cell holds no answers. It hands the source of the cells that were executed to a process of its own, in
which radiokit's grader runs the student's code in its sandbox and compares with the references.

What cannot be defended there: a notebook's kernel belongs to the notebook, so a student's code may put
anything in place of these functions, of the cells' history, or of a cell's result. So otter has
``handout.plugin`` and nbgrader ``handout.graded``, which grade in another process than the kernel; both are
set up by `radiokit assignment`. Where they are not, as in a student's own notebook, believe no points.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from radiokit.faces.grading.assignment import list_assignments
from radiokit.faces.grading.grades import Grade, QuestionGrade
from radiokit.faces.grading.handout.cells import code, notebook
from radiokit.faces.grading.handout.texts import tell
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.facts.errors import RadiokitError, TargetError

__all__ = ["GRADED", "LATER", "FeedbackError", "in_words", "kernel_check", "kernel_points", "submitted"]

GRADED = "RADIOKIT_GRADE"
"""The variable of the environment that names a grade that is already there, where a plugin has graded."""
LATER = "later"
"""Its value where the points of a test cell will be put in afterwards, by ``handout.graded``."""


class FeedbackError(AssertionError):
    """What a test case raises for an answer that is not right: one line for the student."""


def kernel_check(
    question: str,
    *,
    assignment: str,
    part: str,
    language: str = "en",
    seconds: float = 120.0,
) -> None:
    """Raise unless a part of a question is right; for otter-grader's test cases.

    Parameters
    ----------
    question, part : str
        Their names.
    assignment : str
        A name among ``list_assignments()``, or a file.
    language : str
        ``"en"`` or ``"ru"``.
    seconds : float
        How long grading the question may take [s].

    Raises
    ------
    FeedbackError
        When it is not right: one line that says what is wrong.
    RadiokitError
        When there is no notebook, no such assignment, or nothing can be graded here.
    """
    found = _graded(question, assignment, language, seconds)
    (judged,) = (each for each in found.parts if each.name == part)
    if not judged.full:
        raise FeedbackError(judged.text)


def kernel_points(question: str, *, assignment: str, language: str = "en", seconds: float = 120.0) -> float:
    """Return the points that a question earns, and print why; for nbgrader's test cells.

    What the student may not see is not printed. In the student's own notebook it does not count either:
    what is visible then stands for all. Parameters as for ``kernel_check``.

    Returns
    -------
    float
        In [0, the question's points]: Python's own, which nbgrader takes as partial credit.

    Raises
    ------
    RadiokitError
        When there is no notebook, no such assignment, or nothing can be graded here.
    """
    autograded = os.environ.get("NBGRADER_EXECUTION") == "autograde"
    if autograded and os.environ.get(GRADED) == LATER:
        return 0.0
    found = _graded(question, assignment, language, seconds)
    earned = found.score
    if not autograded:
        seen = [part for part in found.parts if part.visibility == "visible"]
        most = sum(part.points for part in seen)
        earned = found.points * sum(part.score for part in seen) / most if most else found.points
        found = replace(found, parts=tuple(seen))
    sys.stdout.write(in_words(found, language))
    return float(round(earned, 4))


def in_words(found: QuestionGrade, language: str) -> str:
    """Return what a question earned, and what is said of its visible parts."""
    points = tell(language, "earned", score=found.score, points=found.points)
    lines = [f"{part.title}: {part.text}" for part in found.parts if part.visibility == "visible"]
    return "\n  ".join([f"{found.name}: {points}", *lines]) + "\n"


def submitted(sources: Iterable[str]) -> str:
    """Return a notebook of cells for the grader."""
    return notebook([code(f"cell-{number}", source) for number, source in enumerate(sources, start=1)])


def _is_here(assignment: str) -> bool:
    return assignment in list_assignments() or Path(assignment).is_file()


def _graded(question: str, assignment: str, language: str, seconds: float) -> QuestionGrade:
    """Return what a question earned, from the grade that is there, or else of what was executed here."""
    done = os.environ.get(GRADED, "")
    if done and done != LATER:
        return Grade.from_json(json.loads(Path(done).read_text(encoding="utf-8")))[question]
    if not _is_here(assignment):
        raise TargetError(tell(language, "elsewhere", question=question))
    target = str(Path(assignment).resolve()) if Path(assignment).suffix == ".py" else assignment
    return _apart(submitted(_executed()), question, target, language, seconds)


def _executed() -> list[str]:
    """Return the cells that were executed in this kernel, in order."""
    if "IPython" in sys.modules:
        from IPython import get_ipython

        shell = get_ipython()
        if shell is not None:
            return [str(source) for source in shell.user_ns.get("In", ())[1:]]
    raise RadiokitError("there are no cells here: this is called in a notebook")


@functools.lru_cache(maxsize=8)
def _apart(source: str, question: str, assignment: str, language: str, seconds: float) -> QuestionGrade:
    """Grade a notebook in another process."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "submission.ipynb").write_text(source, encoding="utf-8")
        request = {
            "folder": folder,
            "assignment": assignment,
            "questions": [question],
            "language": language,
        }
        command = [sys.executable, "-P", "-m", __name__, json.dumps(request)]
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        try:
            output, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            raise RadiokitError(tell(language, "too-long", seconds=seconds)) from None
        finally:
            _end(process)
        answer = Path(folder, "grade.json")
        if not answer.is_file():
            raise RadiokitError(f"nothing was graded: {plain_text(output.decode(errors='replace')[-300:])}")
        found: dict[str, Any] = json.loads(answer.read_text(encoding="utf-8"))
    if "error" in found:
        raise RadiokitError(found["message"])
    return Grade.from_json(found)[question]


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a grader so that it can end its sandbox."""
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(10)
        process.kill()
        process.wait()
    if process.stdout is not None:
        process.stdout.close()


def _main() -> None:
    """Grade what a kernel left in a folder, and leave the grade there."""
    from radiokit.faces.grading.grader import grade

    request = json.loads(sys.argv[1])
    folder = Path(request["folder"])
    try:
        found = grade(
            request["assignment"],
            folder / "submission.ipynb",
            questions=request["questions"],
            language=request["language"],
        ).to_json()
    except RadiokitError as error:
        found = error.to_json()
    (folder / "grade.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    _main()
