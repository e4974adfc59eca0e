"""Nbgrader: the source notebook of an assignment, from which nbgrader makes a release and grades it.

Its test cells hold no answers: see ``handout.kernel``. What they earn is found by ``handout.graded``.
"""

from __future__ import annotations

import json
from functools import partial
from typing import Any

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.handout.cells import Cell, code, markdown
from radiokit.faces.grading.handout.copies import answer, intro, question_text
from radiokit.faces.grading.handout.kernel import GRADED, LATER
from radiokit.faces.grading.handout.texts import tell
from radiokit.faces.grading.handout.worked import INDENT, Solution
from radiokit.faces.grading.question import Question

__all__ = ["CONFIG", "STEP", "nbgrader_cells"]

STEP = "radiokit.faces.grading.handout.graded.graded"
"""What nbgrader calls after it has executed a notebook."""

CONFIG = f'''\
"""What radiokit's assignments need of nbgrader."""

import os

from nbgrader.converters.autograde import Autograde
from nbgrader.preprocessors import Execute

c = get_config()  # noqa: F821 - nbgrader defines it

# What is not written runs, and returns None.
c.ClearSolutions.code_stub = {{"python": "..."}}

# nbgrader's own process gives the points: what a submission's kernel shows in a test cell does not count.
os.environ["{GRADED}"] = "{LATER}"
steps = list(Autograde.autograde_preprocessors.default())
steps.insert(steps.index(Execute) + 1, "{STEP}")
c.Autograde.autograde_preprocessors = steps
'''
"""The course's ``nbgrader_config.py``."""

STARTING = 30.0
"""How long radiokit and the sandbox may take to start, and a submission to load [s]."""


def nbgrader_cells(
    assignment: Assignment, language: str = "en", *, solution: Solution | None = None, graded_by: str
) -> list[Cell]:
    """Return the cells of a source notebook for ``nbgrader generate_assignment`` (metadata of version 3).

    Parameters
    ----------
    assignment : Assignment
    language : str
        ``"en"`` or ``"ru"``.
    solution : Solution, optional
        Without it the functions are blank.
    graded_by : str
        What the test cells load: a name among ``list_assignments()``, or the path of a file.
    """
    helpers = tell(language, "helpers")
    if solution is not None and solution.helpers:
        helpers += f"\n### BEGIN SOLUTION\n{solution.helpers}\n### END SOLUTION"
    first = intro(assignment, language, checked=False)
    cells = [
        markdown(first.key, first.source, **_metadata("intro")),
        code("setup", "import numpy as np", **_metadata("setup")),
        markdown("helpers-title", tell(language, "helpers-title"), **_metadata("helpers-title")),
        code("helpers", helpers, **_metadata("helpers", solution=True)),
    ]
    for number, question in enumerate(assignment.questions, start=1):
        cells += _question(question, number, language, solution, graded_by)
    return [*cells, markdown("hand-in", tell(language, "hand-in"), **_metadata("hand-in"))]


def _question(
    question: Question, number: int, language: str, solution: Solution | None, graded_by: str
) -> list[Cell]:
    name, text = question.name, question_text(question, number, language)
    functions = answer(question, language, None if solution is None else partial(_marked, solution))
    given = {"assignment": graded_by, "language": language, "seconds": _seconds(question)}
    listed = ", ".join(f"{key}={json.dumps(value, ensure_ascii=False)}" for key, value in given.items())
    test = f'import radiokit as rk\n\nrk.grading.kernel_points("{name}", {listed})'
    return [
        markdown(text.key, text.source, **_metadata(f"{name}-text")),
        code(f"{name}-answer", functions, **_metadata(f"{name}-answer", solution=True)),
        code(f"{name}-test", test, **_metadata(f"{name}-test", points=question.points)),
    ]


def _marked(solution: Solution, name: str) -> str:
    return f"{INDENT}### BEGIN SOLUTION\n{solution.bodies[name]}\n{INDENT}### END SOLUTION"


def _seconds(question: Question) -> float:
    """Return how long grading a question may take [s]."""
    return STARTING + question.seconds * len(question.parts)


def _metadata(name: str, *, solution: bool = False, points: float | None = None) -> dict[str, Any]:
    """Return what makes a cell one to answer, one that gives points, or one that must not be changed."""
    found: dict[str, Any] = {
        "grade": points is not None,
        "grade_id": name,
        "locked": not solution,
        "schema_version": 3,
        "solution": solution,
        "task": False,
    }
    if points is not None:
        found["points"] = points
    return {"nbgrader": found}
