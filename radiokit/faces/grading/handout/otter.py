"""Otter: the master notebook of an assignment, for ``otter assign``.

Its tests hold no answers: a test case names a question and a part, and ``handout.plugin`` has the grade.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from typing import Any

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.handout.cells import Cell, code, markdown, raw
from radiokit.faces.grading.handout.copies import answer, intro, question_text
from radiokit.faces.grading.handout.texts import tell
from radiokit.faces.grading.handout.worked import INDENT, Solution
from radiokit.faces.grading.question import Part, Question

__all__ = ["FOLDER", "PLUGIN", "otter_cells"]

PLUGIN = "radiokit.faces.grading.handout.plugin.Plugin"
FOLDER = "assignment"
"""Where an assignment of one's own lies in the autograder, apart from the submission."""


def otter_cells(
    assignment: Assignment, language: str = "en", *, solution: Solution | None = None, graded_by: str
) -> list[Cell]:
    """Return the cells of a master notebook for ``otter assign`` (otter-grader 6 and 7).

    Parameters
    ----------
    assignment : Assignment
    language : str
        ``"en"`` or ``"ru"``.
    solution : Solution, optional
        Without it the functions are blank, and ``otter assign`` does not run the tests.
    graded_by : str
        What the autograder loads: a name among ``list_assignments()``, or ``assignment/FILE.py``.
    """
    tested = solution is not None
    configuration = _configuration(graded_by, language, tested)
    cells = [
        raw("otter", configuration),
        intro(assignment, language, checked=False),
        code("setup", "import numpy as np"),
    ]
    helpers = ""
    if solution is not None and solution.helpers:
        helpers = f"# BEGIN SOLUTION NO PROMPT\n{solution.helpers}\n# END SOLUTION"
    for number, question in enumerate(assignment.questions, start=1):
        cells += _question(question, number, language, solution, helpers if number == 1 else "", graded_by)
    return [*cells, markdown("hand-in", tell(language, "hand-in"))]


def _configuration(graded_by: str, language: str, tested: bool) -> str:
    """Return the first cell, YAML written as JSON where it is nested."""
    plugin = [{PLUGIN: {"assignment": graded_by, "language": language}}]
    lines = [
        "# ASSIGNMENT CONFIG",
        "init_cell: true",
        "export_cell: {pdf: false}",
        f"run_tests: {json.dumps(tested)}",
        "tests: {ok_format: false}",
        f"generate: {{plugins: {json.dumps(plugin)}}}",
        "requirements: [radiokit]",
    ]
    if graded_by.startswith(f"{FOLDER}/"):
        lines.append(f"autograder_files: [{FOLDER}]")
    return "\n".join(lines)


def _question(
    question: Question, number: int, language: str, solution: Solution | None, helpers: str, graded_by: str
) -> list[Cell]:
    name = question.name
    functions = answer(question, language, None if solution is None else partial(_marked, solution))
    functions = "\n".join(each for each in (helpers, functions) if each)
    tests = [
        code(f"{name}-test-{part.name}", _test(question, part, language, graded_by))
        for part in question.parts
    ]
    return [
        raw(f"{name}-begin", f"# BEGIN QUESTION\nname: {name}"),
        question_text(question, number, language),
        *_block(name, "SOLUTION", [code(f"{name}-answer", functions)]),
        *_block(name, "TESTS", tests),
        raw(f"{name}-end", "# END QUESTION"),
    ]


def _marked(solution: Solution, name: str) -> str:
    return f"{INDENT}# BEGIN SOLUTION\n{solution.bodies[name]}\n{INDENT}# END SOLUTION"


def _block(name: str, kind: str, cells: Sequence[Cell]) -> list[Cell]:
    key = f"{name}-{kind.lower()}"
    return [raw(f"{key}-begin", f"# BEGIN {kind}"), *cells, raw(f"{key}-end", f"# END {kind}")]


def _test(question: Question, part: Part, language: str, graded_by: str) -> str:
    given: dict[str, Any] = {"assignment": graded_by, "part": part.name, "language": language}
    listed = ", ".join(f"{name}={json.dumps(value)}" for name, value in given.items())
    return "\n".join(
        [
            '""" # BEGIN TEST CONFIG',
            f"points: {question.worth(part)!r}",
            f"hidden: {json.dumps(part.visibility != 'visible')}",
            '""" # END TEST CONFIG',
            f"def {question.name}_{question.parts.index(part) + 1}():",
            f"{INDENT}import radiokit as rk",
            f'{INDENT}rk.grading.kernel_check("{question.name}", {listed})',
        ]
    )
