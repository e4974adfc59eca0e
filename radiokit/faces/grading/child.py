"""The child: the program that runs inside a sandbox, loads a submission and calls its functions.

It is started as ``python -I -B child.py SITE RESULTS``: SITE is the folder that NumPy is in, RESULTS the file
descriptor of the answers; requests come from standard input. It imports nothing of radiokit but the
protocol, whose file lies beside it. What it says is not believed: the sandbox checks every answer.
"""

from __future__ import annotations

import contextlib
import fcntl
import importlib.util
import json
import os
import sys
from pathlib import Path
from typing import Any

__all__: list[str] = []

HIGH = 40
"""The first file descriptor tried for the private pipes."""


def _module(name: str, file: Path) -> Any:
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"cannot import {file.name}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _private(descriptor: int) -> int:
    """Move a descriptor out of the way of what the submission may guess or close."""
    moved = fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, HIGH)
    os.close(descriptor)
    return moved


class _Child:
    """Reads requests, calls functions, writes answers; holds what it needs before the submission runs."""

    def __init__(self, numpy: Any, protocol: Any, requests: int, results: int) -> None:
        self._asarray, self._stack = numpy.asarray, numpy.stack
        self._protocol, self._requests, self._results = protocol, requests, results
        self._pack, self._text = protocol.pack, protocol.plain_text
        self._read, self._write = os.read, os.write
        self._module: Any = None

    def send(self, header: dict[str, Any], arrays: Any = ()) -> None:
        data = memoryview(self._pack(header, arrays))
        while data:
            data = data[self._write(self._results, data) :]

    def serve(self) -> None:
        while True:
            whole = self._protocol.Assembler(limit=1 << 40)  # the sandbox is trusted
            while whole.wanted:
                data = self._read(self._requests, min(whole.wanted, 1 << 20))
                if not data:
                    return
                whole.feed(data)
            request, arrays = whole.message()
            try:
                header, values = self._answer(request, arrays)
                self._flush()
                self.send({"id": request["id"], **header}, values)
            except BaseException as error:  # the submission may raise anything, SystemExit too
                text = self._described(error)
                self._flush()
                self.send({"id": request["id"], "error": text, "type": self._text(type(error).__name__)})

    def _flush(self) -> None:
        with contextlib.suppress(BaseException):
            sys.stdout.flush()
            sys.stderr.flush()

    def _described(self, error: BaseException) -> str:
        try:
            return str(self._text(error))
        except BaseException:
            return "its message cannot be read"

    def _answer(self, request: dict[str, Any], arrays: list[Any]) -> tuple[dict[str, Any], list[Any]]:
        file = Path.cwd() / request["file"]
        if self._module is None:
            sys.path.insert(0, str(file.parent))
            self._module = _module("submission", file)
        found: Any = self._module
        for part in request["function"].split("."):
            found = getattr(found, part, None)
        if request.get("facts"):
            return {"facts": _facts(found), "names": _names(self._module)}, []
        if found is None:
            return {"refused": f"defines no function {request['function']!r}"}, []
        if not callable(found):
            return {"refused": f"defines {request['function']}, which is no function"}, []
        arrays = [array.copy() for array in arrays]  # may be written into
        mode, keywords = request["mode"], request["parameters"]
        if mode == "batch":
            return self._numbers(found(*arrays, **keywords))
        rows = [
            self._asarray(
                found(*(array[i if mode == "row" else slice(i, i + 1)] for array in arrays), **keywords)
            )
            for i in range(len(arrays[0]))
        ]
        return self._numbers(self._stack([row.reshape(-1) for row in rows]))

    def _numbers(self, result: Any) -> tuple[dict[str, Any], list[Any]]:
        """Return the answer's arrays: one, or those of a tuple that is not one array."""
        if result is None:
            return {"refused": "returned None: is a return statement missing?"}, []
        values = [result]
        if isinstance(result, tuple):
            try:
                values = [self._asarray(result)]
            except ValueError:
                values = list(result)
        arrays = []
        for value in values:
            array = self._asarray(value)
            if array.dtype.kind not in "fiubc":
                kind = self._text(type(value).__name__, 60)
                return {"refused": f"returned {kind} that is no array of numbers"}, []
            small = {"f": "<f8", "i": "<i8", "u": "<i8", "b": "|b1", "c": "<c16"}[array.dtype.kind]
            if array.dtype.kind == "f" and array.dtype.itemsize <= 4:
                small = "<f4"
            arrays.append(self._asarray(array, dtype=small))
        return {}, arrays


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


def _names(module: Any) -> list[str]:
    found = vars(module).items()
    mine = [name for name, value in found if getattr(value, "__module__", "") == "submission"]
    return [name for name in mine if not name.startswith("_")][:50]


def _main() -> None:
    here = Path(__file__).resolve()
    sys.path.append(sys.argv[1])
    requests, results = _private(0), _private(int(sys.argv[2]))
    os.open(os.devnull, os.O_RDONLY)  # becomes standard input
    import numpy

    child = _Child(numpy, _module("_protocol", here.with_name("protocol.py")), requests, results)
    child.send({"ready": json.loads(os.environ.pop("SANDBOX", "[]"))})
    sys.argv = [""]
    child.serve()


if __name__ == "__main__":
    _main()
