"""Tools: the lines of a notebook that are the grader's and not the student's.

What they ask for is not there where a submission is graded, and so they would only seem to fail.

It may be run by the child, and imports the standard library alone.
"""

from __future__ import annotations

import re

__all__ = ["without_tools"]

_TOOLS = re.compile(
    r"(import\s+radiokit(\s+as\s+\w+)?|import\s+otter"
    r"|\w+\s*=\s*(rk|radiokit)\.grading\.practice\(.*\)|check(\.all)?\(.*\)"
    r"|(rk|radiokit)\.grading\.kernel_(check|points)\(.*\)"
    r"|grader\s*=\s*otter\.Notebook\(.*\)|grader\.(check|check_all|export)\(.*\))\s*(#.*)?"
)


def without_tools(source: str) -> str:
    r"""Return a cell or script without the lines by which a handout's copies ask for checks; line by line.

    >>> without_tools("import radiokit as rk\nx = 1\ncheck(f)\n    check(g)")
    'pass\nx = 1\npass\n    check(g)'
    """
    return "\n".join("pass" if _TOOLS.fullmatch(line) else line for line in source.split("\n"))
