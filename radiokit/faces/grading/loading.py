"""Loading: reads a submission, script or notebook, and runs it piece by piece; what fails costs only itself.

It is run by the child, and imports the standard library alone.
"""

from __future__ import annotations
import __future__

import ast
import builtins
import importlib.util
import json
import linecache
import re
import signal
import sys
import time
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

__all__ = ["Submission", "cells", "prepare", "starts", "told", "without_magics"]

PROBLEMS = 20
NAMES = 60
HIDDEN = "radiokit"
"""A submission stands alone: the package that judges it is not there for it."""

_LINE_MAGIC = re.compile(r"\s*([%!?]|\?{0,2}[\w.]+\?{1,2}\s*$)")
_ASSIGNED_MAGIC = re.compile(r"\s*[\w, ]+=\s*[%!]\s*[\w./]")
_FLOW = re.compile(r"(elif|else|except|finally)\b|[\s#)\]}]|$")
_FRESH = re.compile(r"(async\s+def|def|class)\s+\w|@\w|import\s+\w|from\s+[\w.]+\s+import\b")
_PYTHON_CELLS = ("time", "capture", "prun")
_NOTED_MAGICS = ("run", "load", "loadpy", "paste", "macro")


class _LateError(BaseException):
    """A piece took its time, and more; no ``except Exception`` of a submission catches it."""


class _Silent:
    """Stands for IPython's shell: whatever it is told, it does nothing."""

    def __getattr__(self, name: str) -> _Silent:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __call__(self, *arguments: Any, **keywords: Any) -> None:
        return None


class _Hider:
    """Finds no module, and says of one that it is not there."""

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> None:
        if name.split(".")[0] == HIDDEN:
            raise ModuleNotFoundError(f"{HIDDEN} is not there for a submission, which must stand alone")


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


class Submission:
    r"""A submission's module, its problems and where they are; a script or notebook that is not trusted.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "theirs.py")
    ...     _ = file.write_text("import nosuch\ndef f(x): return x\nf(1)(2)")
    ...     theirs = Submission(file)
    ...     theirs.run(seconds=5.0)
    >>> theirs.names()
    ['f']
    >>> [(each["where"], each["raised"]) for each in theirs.problems]
    [('line 1', 'ModuleNotFoundError'), ('line 3', 'TypeError')]
    """

    def __init__(self, path: Path) -> None:
        self.module = types.ModuleType("submission")
        self.problems: list[dict[str, str]] = []
        self._path = path
        self._prefixes: dict[str, str] = {}
        self._flags = 0
        if path.suffix != ".ipynb":
            self.module.__file__ = str(path)
        self.module.__dict__.update(get_ipython=_Silent, display=_Silent())

    def run(self, *, seconds: float) -> None:
        """Run all of it, each statement for at most half of the time that is left [s]."""
        sys.modules["submission"] = self.module
        end = time.monotonic() + seconds
        for prefix, name, source in self._parts():
            self._prefixes[name] = prefix
            linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
            for statement in self._statements(prefix, name, source):
                self._execute(statement, prefix, name, max(0.01, (end - time.monotonic()) / 2))

    def where(self, trace: types.TracebackType | None) -> str:
        """Return the last place in the submission that a traceback goes through, as "cell 3, line 2"."""
        found = ""
        while trace is not None:
            prefix = self._prefixes.get(trace.tb_frame.f_code.co_filename)
            found = found if prefix is None else f"{prefix}line {trace.tb_lineno}"
            trace = trace.tb_next
        return found

    def names(self) -> list[str]:
        """Return the names of the functions and classes that it defines, in order."""
        found = []
        for name, value in self.module.__dict__.copy().items():
            try:
                mine = callable(value) and value.__module__ == "submission" and not name.startswith("_")
            except BaseException:  # an object may raise anything when it is looked at
                continue
            found += [name] if mine else []
        return found[:NAMES]

    def _parts(self) -> Iterator[tuple[str, str, str]]:
        """Yield for each part the beginning of its places, its file name and its source."""
        data = self._path.read_bytes()
        if self._path.suffix != ".ipynb":
            yield "", self._path.name, self._decoded(data)
            return
        try:
            found = cells(data.decode("utf-8-sig"))
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            self._note("", "", "it is no Jupyter notebook of format 3 or 4")
            return
        for number, source in enumerate(found, 1):
            yield f"cell {number}, ", f"cell {number}", source

    def _decoded(self, data: bytes) -> str:
        try:
            return importlib.util.decode_source(data)
        except (SyntaxError, UnicodeDecodeError) as error:
            self._note("", type(error).__name__, str(error))
            return data.decode("utf-8", errors="replace").replace("\r\n", "\n")

    def _statements(self, prefix: str, name: str, source: str) -> Iterator[ast.stmt]:
        try:
            body = ast.parse(source, name).body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            source, noted = without_magics(source)
            for line, words in noted:
                self._note(f"{prefix}line {line}", "", f"{words[:60]} is left out: IPython alone knows it")
            try:
                body = ast.parse(source, name).body
            except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
                if prefix or not isinstance(error, SyntaxError):
                    self._note_syntax(prefix, error)
                    return
                body = self._salvaged(source.split("\n"), name)
        for statement in body:
            if isinstance(statement, ast.Import):  # each name for itself: one that is missing costs no other
                for alias in statement.names:
                    yield ast.copy_location(ast.Import([alias]), statement)
                continue
            if isinstance(statement, ast.ImportFrom) and statement.module == "__future__":
                for alias in statement.names:
                    self._flags |= getattr(getattr(__future__, alias.name, None), "compiler_flag", 0)
            yield statement

    def _salvaged(self, lines: list[str], name: str) -> list[ast.stmt]:
        """Return the statements of a script around those with an error."""
        margin = [
            i for i, begins in enumerate(starts(lines)) if begins and lines[i] and not _FLOW.match(lines[i])
        ]
        body: list[ast.stmt] = []
        begin = 0
        for _ in range(PROBLEMS):
            try:
                return body + _parsed(lines, begin, len(lines), name)
            except SyntaxError as error:
                self._note_syntax("", error)
                last = min(error.lineno or 1, len(lines)) - 1
            cut = begin
            for cut in [*[i for i in margin if begin < i <= last][: -PROBLEMS - 1 : -1], begin]:
                try:
                    body += _parsed(lines, begin, cut, name)
                    break
                except SyntaxError:
                    continue
            begin = next((i for i in margin if i > cut), len(lines))
        return body

    def _execute(self, statement: ast.stmt, prefix: str, name: str, seconds: float) -> None:
        try:
            code = compile(ast.Module([statement], []), name, "exec", self._flags, dont_inherit=True)
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            self._note_syntax(prefix, error)
            return
        try:
            signal.setitimer(signal.ITIMER_REAL, seconds)
            exec(code, self.module.__dict__)
            signal.setitimer(signal.ITIMER_REAL, 0)
        except BaseException as error:  # a submission may raise anything, SystemExit too
            signal.setitimer(signal.ITIMER_REAL, 0)
            where = self.where(error.__traceback__) or f"{prefix}line {statement.lineno}"
            if isinstance(error, _LateError):
                self._note(where, "", "it was stopped, as it took too long")
            else:
                self._note(where, type(error).__name__, told(error))

    def _note_syntax(self, prefix: str, error: Exception) -> None:
        line = getattr(error, "lineno", None)
        text = error.msg if isinstance(error, SyntaxError) else str(error)
        self._note(f"{prefix}line {line}" if line else prefix.rstrip(", "), type(error).__name__, text)

    def _note(self, where: str, raised: str, message: str) -> None:
        problem = {"where": where, "raised": raised[:60], "message": message[:1000]}
        if len(self.problems) < PROBLEMS and problem not in self.problems:
            self.problems.append(problem)


def told(error: BaseException) -> str:
    """Return an exception's message, whatever it does when it is asked."""
    try:
        return str(error)
    except BaseException:
        return "its message cannot be read"


def _parsed(lines: list[str], begin: int, end: int, name: str) -> list[ast.stmt]:
    return ast.parse("\n" * begin + "\n".join(lines[begin:end]), name).body


def prepare() -> None:
    """Make this process one in which submissions are run."""
    sys.meta_path.insert(0, _Hider())
    vars(builtins).update(exit=sys.exit, quit=sys.exit)
    signal.signal(signal.SIGALRM, _late)


def _late(signum: int, frame: types.FrameType | None) -> None:
    raise _LateError
