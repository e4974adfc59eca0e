"""Worked: an instructor's file of solutions, taken apart so that each function goes where its blank was."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from textwrap import indent

from radiokit.faces.grading.assignment import Assignment
from radiokit.facts.errors import TargetError

__all__ = ["INDENT", "Solution", "read_solution"]

INDENT = "    "


@dataclass(frozen=True, kw_only=True)
class Solution:
    """A file of solutions.

    ``bodies`` are the functions' bodies by the functions' names, without their docstrings, indented by four;
    ``helpers`` is all else that the file defines and imports.
    """

    bodies: Mapping[str, str]
    helpers: str


def read_solution(path: str | Path, assignment: Assignment) -> Solution:
    """Return the solutions in a file.

    Raises
    ------
    TargetError
        When the file is not there or no Python, lacks a function that is asked for, or has one of other
        parameters.

    >>> import tempfile
    >>> from radiokit.faces.grading.assignment import load_assignment
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "my.py")
    ...     _ = file.write_text("answer = 42")
    ...     read_solution(file, load_assignment("radiometry"))
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.TargetError: my.py defines no function ...
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8")
        tree = ast.parse(text, filename=file.name)
    except OSError:
        raise TargetError(f"no such file: {file}") from None
    except (SyntaxError, ValueError) as error:
        raise TargetError(f"{file.name} is no Python: {error}") from None
    lines = text.splitlines()
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    bodies = {}
    wanted = {name: given for question in assignment.questions for name, given in question.functions.items()}
    for name, parameters in wanted.items():
        node = functions.get(name)
        if node is None:
            raise TargetError(f"{file.name} defines no function {name}")
        listed = (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)
        named = tuple(each.arg for each in listed)
        if named != parameters or node.args.vararg or node.args.kwarg:
            shown, asked = ", ".join(named), ", ".join(parameters)
            raise TargetError(f"{file.name}: {name} has parameters ({shown}), not ({asked})")
        if node.decorator_list:
            raise TargetError(f"{file.name}: {name} has a decorator, which a blank has not")
        bodies[name] = _body(node, lines)
    return Solution(bodies=bodies, helpers=_helpers(tree, lines, set(bodies)))


def _body(node: ast.FunctionDef, lines: list[str]) -> str:
    """Return a function's body without its docstring, comments included."""
    assert node.end_lineno is not None
    first = node.body[0]
    if ast.get_docstring(node, clean=False) is not None:
        assert first.end_lineno is not None
        start = first.end_lineno
    elif first.lineno == node.lineno:
        return indent(ast.unparse(ast.Module(node.body, [])), INDENT)
    else:
        start = next(
            end for end in range(node.lineno, first.lineno) if _is_header(lines[node.lineno - 1 : end])
        )
    width = node.body[-1].col_offset
    body = [
        line if width == len(INDENT) else INDENT + line[width:] for line in lines[start : node.end_lineno]
    ]
    return "\n".join(body).strip("\n") or f"{INDENT}return None"


def _is_header(lines: list[str]) -> bool:
    try:
        ast.parse("\n".join([*lines, f"{INDENT}pass"]))
    except SyntaxError:
        return False
    return True


def _helpers(tree: ast.Module, lines: list[str], wanted: set[str]) -> str:
    """Return all else in a file but its docstring, with the comments before."""
    kept: list[str] = []
    start = 0
    for number, node in enumerate(tree.body):
        assert node.end_lineno is not None
        docstring = number == 0 and isinstance(node, ast.Expr) and ast.get_docstring(tree) is not None
        future = isinstance(node, ast.ImportFrom) and node.module == "__future__"
        asked = isinstance(node, ast.FunctionDef) and node.name in wanted
        guarded = isinstance(node, ast.If) and "__name__" in ast.unparse(node.test)
        if not (docstring or future or asked or guarded):
            kept += lines[start : node.end_lineno]
        start = node.end_lineno
    return "\n".join(kept).strip("\n")
