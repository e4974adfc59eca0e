"""The child: the program that runs inside a sandbox, loads a submission and calls its functions.

It is started as ``python -P -s -S -B child.pyc RESULTS SITE...``: RESULTS is the file descriptor of the
answers, each SITE a folder of packages; requests come from standard input. It imports nothing of radiokit but
the files that lie beside it. What it says is not believed: the sandbox checks every answer.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import marshal
import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

__all__: list[str] = []

PACKAGE = "radiokit.faces.grading.isolation."
PARTS = ("sources", "imports", "protocol", "loading", "answers", "signature")
HIGH = 40
"""The first file descriptor tried for the private pipes."""
BRANCH_ENDED = 90
"""Exit code of a branch that was told to end."""
CLEARING = 2.0
"""How long it may take to end what a branch has started [s]."""
SET_CHILD_SUBREAPER = 36
"""Of ``prctl`` on Linux."""


def _beside(name: str) -> Any:
    """Import a compiled file that lies beside this one; others of them know it by its full name."""
    module = sys.modules[PACKAGE + name] = type(sys)(f"_{name}")
    with (Path(__file__).parent / f"{name}.pyc").open("rb") as file:
        exec(marshal.loads(file.read()[16:]), module.__dict__)
    return module


def _private(descriptor: int) -> int:
    """Move a descriptor out of the way of what the submission may guess or close."""
    moved = fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, HIGH)
    os.close(descriptor)
    return moved


class _RowError(Exception):
    """Tells at which row a function raised what."""

    def __init__(self, row: int, error: BaseException) -> None:
        self.row, self.error = row, error


class _Child:
    """Reads requests, calls functions, writes answers; holds what it needs before the submission runs."""

    def __init__(self, requests: int, results: int) -> None:
        parts = {name: _beside(name) for name in PARTS}
        for name in PARTS:  # a submission finds them under names that no other module has
            sys.modules[f"_{name}"] = sys.modules.pop(PACKAGE + name)
        self._protocol, self._loading, self._answers, self._signature = (parts[name] for name in PARTS[2:])
        self._finder = parts["imports"].Finder()
        self._requests, self._results = requests, results
        self._pack, self._text = self._protocol.pack, self._protocol.plain_text
        self._read, self._write, self._blocking = os.read, os.write, os.set_blocking
        self._fork, self._wait, self._exit = os.fork, os.waitpid, os._exit
        self._submission: Any = None

    def send(self, header: dict[str, Any], arrays: Any = ()) -> None:
        data = memoryview(self._pack(header, arrays))
        self._blocking(self._results, True)
        while data:
            data = data[self._write(self._results, data) :]

    def serve(self) -> None:
        while True:
            self._blocking(self._requests, True)  # a submission may have changed it, in a copy too
            whole = self._protocol.Assembler(limit=1 << 40)  # the sandbox is trusted
            while whole.wanted:
                data = self._read(self._requests, min(whole.wanted, 1 << 20))
                if not data:
                    return
                whole.feed(data)
            request, arrays = whole.message()
            if "branch" in request:
                self._branch(request)
                continue
            values: Any = ()
            try:
                header, values = self._answer(request, arrays)
            except self._answers.RefusedError as error:
                header = {"refused": self._text(error, 1200)}
            except _RowError as error:
                header = {**self._raised(error.error), "row": error.row}
            except BaseException as error:  # the submission may raise anything, SystemExit too
                header = self._raised(error)
            self._flush()
            self.send({"id": request["id"], **header}, values)

    def _branch(self, request: dict[str, Any]) -> None:
        """Go on in a copy of this process, or end the copy: then all goes on from here, as it was before.

        A copy that ends by itself ends this process in the same way. What a copy started ends with it. That
        it has ended is said by this process alone.
        """
        self._flush()
        if not request["branch"]:
            self._exit(BRANCH_ENDED)
        before = _children()
        _adopt()
        branch = self._fork()
        if branch == 0:
            self.send({"id": request["id"], "facts": {}})
            return
        ended, status = self._wait(-1, 0)
        while ended != branch:  # orphans of the copy
            ended, status = self._wait(-1, 0)
        code = os.waitstatus_to_exitcode(status)
        if code < 0:
            if -code != signal.SIGKILL:
                signal.signal(-code, signal.SIG_DFL)
            os.kill(os.getpid(), -code)
        elif code != BRANCH_ENDED or not _cleared(before):
            self._exit(code)
        self.send({"id": request["end"], "facts": {}})

    def _flush(self) -> None:
        with contextlib.suppress(BaseException):
            sys.stdout.flush()
            sys.stderr.flush()

    def _raised(self, error: BaseException) -> dict[str, Any]:
        return {
            "error": self._text(self._loading.told(error), 1200),
            "type": self._text(type(error).__name__),
            "where": self._submission.where(error.__traceback__) if self._submission else "",
        }

    def _answer(self, request: dict[str, Any], arrays: list[Any]) -> tuple[dict[str, Any], list[Any]]:
        if "load" in request:
            file = Path.cwd() / request["file"]
            sys.path.append(str(file.parent))
            self._loading.prepare()
            self._finder.seed(0)
            sys.meta_path.insert(0, self._finder)
            self._submission = self._loading.Submission(file)
            self._submission.run(seconds=request["load"])
            return {
                "names": [self._text(name, 60) for name in self._submission.names()],
                "problems": [
                    {key: self._text(words, 240) for key, words in each.items()}
                    for each in self._submission.problems
                ],
            }, []
        found: Any = self._submission.module
        for part in request["function"].split("."):
            found = getattr(found, part, None)
        if request.get("facts"):
            return {"facts": {**_facts(found), "parameters": self._signature.listed(found)}}, []
        if found is None:
            return {"refused": f"defines no function {request['function']!r}"}, []
        if not callable(found):
            return {"refused": f"defines {request['function']}, which is no function"}, []
        if request["seed"] is not None:
            self._finder.seed(request["seed"])
        return {}, self._called(found, request, arrays)

    def _called(self, function: Any, request: dict[str, Any], arrays: list[Any]) -> list[Any]:
        # copies may be written into; arrays without dimensions are Python's own numbers
        given = [array.copy() if array.ndim else array.item() for array in arrays]
        mode, keywords, outputs = request["mode"], request["parameters"], request["outputs"]
        rest = []
        if keywords and self._signature.by_position(function, keywords):
            rest, keywords = list(keywords.values()), {}
        taker = self._answers.Taker(request["limit"])
        lengths = [len(array) for array in arrays if array.ndim]
        if mode == "batch" or not lengths:
            return list(taker.outputs(function(*given, *rest, **keywords), outputs))
        rows = []
        for i in range(lengths[0]):
            row = [
                _row(value, i, mode) if array.ndim else value
                for value, array in zip(given, arrays, strict=True)
            ]
            try:
                rows.append(taker.outputs(function(*row, *rest, **keywords), outputs))
            except self._answers.RefusedError:
                raise
            except BaseException as error:
                raise _RowError(i, error) from None
        return list(taker.stacked(rows, outputs, mode == "single"))


def _adopt() -> None:
    """Have the orphans of what is started from here become children of this process, where that is known."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def _children() -> set[int]:
    """Return the processes whose parent this is, where that is told."""
    found: set[int] = set()
    with contextlib.suppress(OSError):
        for task in Path("/proc/self/task").iterdir():
            found |= set(map(int, (task / "children").read_text().split()))
    return found


def _cleared(before: set[int]) -> bool:
    """End all children but those of before, and their own in turn; return whether that was done in time."""
    deadline = time.monotonic() + CLEARING
    while left := _children() - before:
        if time.monotonic() > deadline:
            return False
        for pid in left:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
                os.waitpid(pid, 0)
    return True


def _row(array: Any, i: int, mode: str) -> Any:
    if mode == "single":
        return array[i : i + 1]
    return array[i].item() if mode == "scalar" and array.ndim == 1 else array[i]


def _facts(function: Any) -> dict[str, Any]:
    """Return what a function says of itself in its attributes."""
    eta = getattr(function, "eta", None)
    return {
        "callable": callable(function),
        "pdf": callable(getattr(function, "pdf", None)),
        "sample": callable(getattr(function, "sample", None)),
        "transmissive": bool(getattr(function, "transmissive", False)),
        "eta": None if eta is None else float(eta),
    }


def _main() -> None:
    requests, results = _private(0), _private(int(sys.argv[1]))
    sys.path += sys.argv[2:]
    os.open(os.devnull, os.O_RDONLY)  # becomes standard input
    child = _Child(requests, results)
    child.send({"ready": json.loads(os.environ.pop("SANDBOX", "[]"))})
    sys.argv = [""]
    child.serve()


if __name__ == "__main__":
    _main()
