"""Sources: texts of scripts and notebooks before Python reads them: cells, magics, where statements begin.

It is run by the child, and imports the standard library alone.
"""

from __future__ import annotations

import json
import re

__all__ = ["cells", "starts", "without_magics", "without_tools"]

_LINE_MAGIC = re.compile(r"\s*([%!?]|\?{0,2}[\w.]+\?{1,2}\s*$)")
_ASSIGNED_MAGIC = re.compile(r"\s*[\w, ]+=\s*[%!]\s*[\w./]")
_FRESH = re.compile(r"(async\s+def|def|class)\s+\w|@\w|import\s+\w|from\s+[\w.]+\s+import\b")
_PYTHON_CELLS = ("time", "capture", "prun")
_NOTED_MAGICS = ("run", "load", "loadpy", "paste", "macro")
_TOOLS = re.compile(
    r"(\w+\s*=\s*(rk|radiokit)\.grading\.practice\(.*\)|check(\.all)?\(.*\)"
    r"|(rk|radiokit)\.grading\.kernel_(check|points)\(.*\)"
    r"|grader\s*=\s*otter\.Notebook\(.*\)|grader\.(check|check_all|export)\(.*\))\s*(#.*)?"
)
_THEIR_IMPORTS = re.compile(r"import\s+(radiokit(\s+as\s+\w+)?|otter)\s*(#.*)?")


def cells(text: str) -> list[str]:
    r"""Return the sources of a notebook's code cells, of format 3 or 4.

    >>> cells('{"cells": [{"cell_type": "code", "source": ["a = 1\\n", "b = 2"]}]}')
    ['a = 1\nb = 2']
    """
    notebook = json.loads(text)
    found = notebook.get("cells")
    if found is None:
        found = [cell for sheet in notebook["worksheets"] for cell in sheet["cells"]]
    sources = [cell.get("source", cell.get("input", "")) for cell in found if cell["cell_type"] == "code"]
    return ["".join(source).replace("\r\n", "\n") for source in sources]


def starts(lines: list[str], *, magics: bool = False) -> list[bool]:
    r"""Return on which lines a statement may begin: not within a string, brackets or a continued line.

    What can only begin a statement at the margin, as ``def name``, ends brackets that were never closed.

    >>> starts(["a = (1 +", "2)", "b = '''", "c'''", "d = 1 + \\", "2"])
    [True, False, True, False, True, False]
    """
    depth, quote, continued, found = 0, "", False, []
    for line in lines:
        if depth and not quote and _FRESH.match(line):
            depth = 0
        found.append(not (depth or quote or continued))
        if found[-1] and magics and (_LINE_MAGIC.match(line) or _ASSIGNED_MAGIC.match(line)):
            continue
        at, continued = 0, False
        while at < len(line):
            letter = line[at]
            if letter == "\\":
                continued = at == len(line) - 1
                at += 2
            elif quote:
                ended = line.startswith(quote, at)
                at += len(quote) if ended else 1
                quote = "" if ended else quote
            elif letter == "#":
                break
            elif letter in "\"'":
                quote = letter * 3 if line.startswith(letter * 3, at) else letter
                at += len(quote)
            else:
                depth = max(0, depth + (letter in "([{") - (letter in ")]}"))
                at += 1
        if len(quote) == 1 and not continued:
            quote = ""  # it is an error, and ends here
    return found


def without_magics(source: str) -> tuple[str, list[tuple[int, str]]]:
    r"""Return a cell without what only IPython understands, and what of it may be missed: line and words.

    >>> without_magics("%matplotlib inline\nfor i in x:\n    !pip install y\nb = !ls")
    ('pass\nfor i in x:\n    pass\npass', [(4, 'b = !ls')])
    """
    lines = source.split("\n")
    first = next((i for i, line in enumerate(lines) if line.strip()), 0)
    if lines[first].startswith("%%"):
        name = (lines[first][2:].split() or [""])[0]
        if name not in _PYTHON_CELLS:
            return "", [(first + 1, lines[first].strip())]
        lines[first] = ""
    noted, dropping = [], False
    for number, begins in enumerate(starts(lines, magics=True)):
        line = lines[number]
        assigned = _ASSIGNED_MAGIC.match(line)
        if dropping or (begins and (assigned or _LINE_MAGIC.match(line))):
            words = line.strip()
            if not dropping and (assigned or words.lstrip("%").split(" ")[0] in _NOTED_MAGICS):
                noted.append((number + 1, words))
            lines[number] = "" if dropping else line[: len(line) - len(line.lstrip())] + "pass"
            dropping = line.endswith("\\")
    return "\n".join(lines), noted


def without_tools(source: str) -> str:
    r"""Return a cell or script without the lines by which an assignment's copies ask for checks.

    What they ask for is not there where a submission is graded, so they would only seem to fail.

    >>> without_tools("import radiokit as rk\ncheck = rk.grading.practice('a')\nx = 1\ncheck(f)")
    'pass\npass\nx = 1\npass'
    >>> without_tools("import radiokit as rk\nx = 1")
    'import radiokit as rk\nx = 1'
    """
    lines = source.split("\n")
    own = [number for number, begins in enumerate(starts(lines)) if begins]
    tools = [number for number in own if _TOOLS.fullmatch(lines[number])]
    imports = [number for number in own if tools and _THEIR_IMPORTS.fullmatch(lines[number])]
    for number in (*tools, *imports):
        lines[number] = "pass"
    return "\n".join(lines)
