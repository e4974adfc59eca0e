"""Loading: reads a submission, script or notebook, and runs it piece by piece; what fails costs only itself.

It is run by the child, and imports the standard library alone, and a file beside it.
"""

from __future__ import annotations
import __future__

import ast
import builtins
import importlib.util
import linecache
import re
import signal
import sys
import time
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from radiokit.faces.grading.isolation.sources import cells, starts, without_magics, without_tools

__all__ = ["Submission", "prepare", "told"]

PROBLEMS = 20
NAMES = 60

TURNS = 8
"""In how many parts a time limit is waited for; each counts once, however long the machine stands still."""

_MAIN = re.compile(r"__name__ == .__main__.|.__main__. == __name__")
_FLOW = re.compile(r"(elif|else|except|finally)\b|[\s#)\]}]|$")


class _LateError(BaseException):
    """A piece took its time, and more; no ``except Exception`` of a submission catches it."""


class _Alarm:
    """Raises ``_LateError`` once the time is up; what was computed counts in full, and waiting in turns."""

    def __init__(self) -> None:
        self._wall, self._spent = time.monotonic, time.process_time
        self._left = self._turn = self._seen = self._cost = 0.0
        self._set = False

    def start(self, seconds: float) -> None:
        self._left, self._turn = seconds, seconds / TURNS
        self._seen, self._cost = self._wall(), self._spent()
        self._set = True
        signal.setitimer(signal.ITIMER_REAL, self._turn, self._turn)

    def stop(self) -> float:
        """Return how much is left [s]."""
        self._set = False
        signal.setitimer(signal.ITIMER_REAL, 0)
        self._count()
        return self._left

    def _count(self) -> None:
        seen, cost = self._wall(), self._spent()
        self._left -= min(seen - self._seen, max(cost - self._cost, self._turn))
        self._seen, self._cost = seen, cost

    def __call__(self, signum: int, frame: types.FrameType | None) -> None:
        if not self._set:
            return
        self._count()
        if self._left <= 0:
            self._set = False
            raise _LateError


_alarm = _Alarm()


class _Silent:
    """Stands for IPython's shell: whatever it is told, it does nothing."""

    def __getattr__(self, name: str) -> _Silent:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __call__(self, *arguments: Any, **keywords: Any) -> None:
        return None


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
        self._is_script = path.suffix.lower() != ".ipynb"
        if self._is_script:
            self.module.__file__ = str(path)
        self.module.__dict__.update(get_ipython=_Silent, display=_Silent())

    def run(self, *, seconds: float) -> None:
        """Run all of it, each statement for at most half of the time that is left [s]."""
        sys.modules["submission"] = self.module
        left = seconds
        for prefix, name, source in self._parts():
            self._prefixes[name] = prefix
            linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
            for statement in self._statements(prefix, name, source):
                left -= self._execute(statement, prefix, name, max(0.01, left / 2))

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
        if self._is_script:
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
        source = without_tools(source)
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
            if prefix and isinstance(statement, ast.If) and _MAIN.fullmatch(ast.unparse(statement.test)):
                yield from statement.body  # in a notebook it is so
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

    def _execute(self, statement: ast.stmt, prefix: str, name: str, seconds: float) -> float:
        """Run a statement, and return how long it took [s]."""
        try:
            code = compile(ast.Module([statement], []), name, "exec", self._flags, dont_inherit=True)
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            self._note_syntax(prefix, error)
            return 0.0
        left = seconds
        try:
            _alarm.start(seconds)
            exec(code, self.module.__dict__)
            left = _alarm.stop()
        except BaseException as error:  # a submission may raise anything, SystemExit too
            left = _alarm.stop()
            where = self.where(error.__traceback__) or f"{prefix}line {statement.lineno}"
            if isinstance(error, _LateError):
                self._note(where, "", "it was stopped, as it took too long")
            else:
                self._note(where, type(error).__name__, told(error))
        return seconds - left

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
    vars(builtins).update(exit=sys.exit, quit=sys.exit)
    signal.signal(signal.SIGALRM, _alarm)
