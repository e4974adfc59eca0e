"""GitHub Classroom: a grade as its autograding reporter reads it, and the workflow that makes one.

The format is that of the runners whose results the reporter adds up: JSON in base64, in the environment
variable ``RUNNER_RESULTS``, see https://github.com/classroom-resources/autograding-grading-reporter.
GitHub has ended Classroom itself; the reporter is an action for any repository.
"""

from __future__ import annotations

import base64
import json
import re
from typing import Any

import radiokit
from radiokit.faces.grading.formats.shown import line_of, plain
from radiokit.faces.grading.grades import Grade
from radiokit.faces.grading.words import checked_language
from radiokit.facts.errors import ParameterError

__all__ = ["github_workflow", "to_github", "to_github_output"]

_STATUS = {"full": "pass", "partial": "fail", "none": "fail", "pending": "error"}

_WORKFLOW = """\
# The reporter wants this name and this one job, and that no other workflow ends before it.
name: Autograding Tests
on:
  - push
  - workflow_dispatch
permissions:
  checks: write
  actions: read
  contents: read
jobs:
  run-autograding-tests:
    runs-on: ubuntu-latest
    if: github.actor != 'github-classroom[bot]'
    steps:
      - name: Check out the work
        uses: actions/checkout@v4
      - name: Set up Python
        uses: actions/setup-python@v5
        with:
          python-version: "{python}"
      - name: Install radiokit
        run: python -m pip install "{install}"
      - name: Grade
        id: radiokit
        env:
          RADIOKIT_SECRET: ${{{{ secrets.RADIOKIT_SECRET }}}}
          STUDENT: ${{{{ github.repository }}}}
        run: |
          radiokit grade {submission} --assignment {assignment} --student "$STUDENT" --language {language} \\
            --out "github=$RUNNER_TEMP/result" --out "markdown=$GITHUB_STEP_SUMMARY" || [ $? -ne 2 ]
          echo "result=$(cat "$RUNNER_TEMP/result")" >> "$GITHUB_OUTPUT"
      - name: Autograding Reporter
        uses: classroom-resources/autograding-grading-reporter@v1
        env:
          RADIOKIT_RESULTS: "${{{{ steps.radiokit.outputs.result }}}}"
        with:
          runners: radiokit
"""


def to_github(grade: Grade, *, reveal: bool = False) -> dict[str, Any]:
    """Return a grade as one runner's results for the reporter of GitHub Classroom.

    The reporter prints the names of the tests and adds up the scores; messages are for whoever reads the
    JSON. A part that is not graded yet is an error.

    Parameters
    ----------
    grade : Grade
    reveal : bool
        Whether what was found about hidden parts is told.
    """
    grade = plain(grade)
    tests = []
    for question in grade.questions:
        for part in question.parts:
            line = line_of(part, grade.language, reveal=reveal)
            tests.append(
                {
                    "name": f"{question.name}: {line.title} ({line.score}/{line.points})",
                    "status": _STATUS[line.standing],
                    "score": round(part.score, 4),
                    "message": line.text,
                    "test_code": "",
                    "filename": "",
                    "line_no": 0,
                    "duration": 0,
                }
            )
    statuses = {test["status"] for test in tests}
    status = "error" if "error" in statuses else "fail" if "fail" in statuses else "pass"
    return {"version": 1, "status": status, "max_score": grade.points, "tests": tests}


def to_github_output(grade: Grade, *, reveal: bool = False) -> str:
    """Return ``to_github`` as the reporter wants it: one line of base64."""
    text = json.dumps(to_github(grade, reveal=reveal), ensure_ascii=False, allow_nan=False)
    return base64.b64encode(text.encode()).decode("ascii")


def github_workflow(
    assignment: str, submission: str, *, language: str = "en", install: str = "", python: str = "3.12"
) -> str:
    """Return a workflow for ``.github/workflows/classroom.yml`` that grades every push.

    A student can read and change what a workflow in a repository of his own does, its secrets and the
    assignment among it: use it for feedback, and grade again where students cannot reach for what counts.

    Parameters
    ----------
    assignment, submission : str
        The assignment's name or file, and the file that students hand in, as paths in the repository.
    language : str
    install : str
        What pip installs, by default this version of radiokit.
    python : str

    Raises
    ------
    ParameterError
        When a word would need quotes in a shell.

    >>> print(github_workflow("radiometry", "radiometry.ipynb").splitlines()[1])
    name: Autograding Tests
    """
    words = {
        "assignment": assignment,
        "submission": submission,
        "install": install or f"radiokit[grading]=={radiokit.__version__}",
        "python": python,
    }
    for name, word in words.items():
        if not re.fullmatch(r"[\w./:@+=\[\],-]+", word, flags=re.ASCII) or word.startswith("-"):
            raise ParameterError(name, word, "a word of letters, digits and ./:@+=[],-_")
    return _WORKFLOW.format(**words, language=checked_language(language))
