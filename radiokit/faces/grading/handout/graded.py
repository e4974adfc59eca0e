"""Graded: gives an nbgrader submission's points in nbgrader's own process, whatever its kernel has shown.

``nbgrader_config.py``, as `radiokit assignment --nbgrader` writes it, puts it behind nbgrader's ``Execute``.
It takes the submission from its file and grades it in radiokit's sandbox, far from the points. What a test
cell asks for is read from nbgrader's records of the release, never from what was handed in: an assignment's
file is run here.
The kernel still runs a submission's other cells as the user who grades, as nbgrader always does: what
that user may read or write, the secret and the gradebook among it, a submission may, too.
"""

from __future__ import annotations

import ast
import tempfile
from pathlib import Path
from typing import Any

from radiokit.faces.grading.command import read_secret
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.handout.kernel import in_words, submitted

__all__ = ["graded"]


def graded(notebook: Any, resources: Any) -> tuple[Any, Any]:
    """Put the points and their reasons into a handout's test cells; other cells are left as they are."""
    released = _released(resources["nbgrader"])
    tests = [
        (cell, *call)
        for cell in notebook.cells
        if cell.cell_type == "code" and cell.metadata.get("nbgrader", {}).get("grade")
        if (call := _asked(released.get(cell.metadata["nbgrader"].get("grade_id"), ""))) is not None
    ]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "submission.ipynb")
        sources = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
        file.write_text(submitted(sources), encoding="utf-8")
        for key in sorted({_key(given) for _, _, given in tests}):
            mine = [(cell, name) for cell, name, given in tests if _key(given) == key]
            assignment, language = key
            found = grade(
                assignment,
                file,
                student=str(resources["nbgrader"]["student"]),
                secret=read_secret(None),
                language=language,
                questions=[name for _, name in mine],
            )
            for cell, name in mine:
                _answer(cell, in_words(found[name], language), found[name].score)
    return notebook, resources


def _key(given: dict[str, Any]) -> tuple[str, str]:
    return given["assignment"], given["language"]


def _released(about: Any) -> dict[str, str]:
    """Return the sources of the cells that students may not change, as they were released, by their ids."""
    from nbgrader.api import Gradebook

    with Gradebook(about["db_url"]) as gradebook:
        cells = gradebook.find_notebook(about["notebook"], about["assignment"]).source_cells
        return {cell.name: cell.source for cell in cells if cell.locked and cell.cell_type == "code"}


def _asked(source: str) -> tuple[str, dict[str, Any]] | None:
    """Return the question that a released test cell asks for, and how; None for any other cell."""
    try:
        last = ast.parse(source).body[-1]
    except (SyntaxError, IndexError):
        return None
    call = last.value if isinstance(last, ast.Expr) else None
    if not isinstance(call, ast.Call) or getattr(call.func, "attr", "") != "kernel_points":
        return None
    given = {each.arg or "": ast.literal_eval(each.value) for each in call.keywords}
    return ast.literal_eval(call.args[0]), given


def _answer(cell: Any, words: str, score: float) -> None:
    from nbformat.v4 import new_output

    data = {"text/plain": repr(float(score))}
    cell.outputs = [
        new_output("stream", name="stdout", text=words),
        new_output("execute_result", data=data, execution_count=cell.execution_count),
    ]
