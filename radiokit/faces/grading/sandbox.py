"""The sandbox: the parent's side: starts the child, asks it, doubts its answers, and ends it."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import secrets
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Literal

import numpy as np

import radiokit
from radiokit.faces.grading.limits import PROTECTIONS, Limits
from radiokit.faces.grading.protocol import Array, Assembler, MalformedError, pack, plain_text
from radiokit.faces.grading.result import Result, judged
from radiokit.facts.errors import RadiokitError

__all__ = ["Sandbox"]

HERE = Path(__file__).resolve().parent
STARTUP = 30.0
"""How long Python and NumPy may take to start [s]."""
KEPT = 2000
"""How many bytes of what is printed are kept."""
SYSTEM = (
    *("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/nix/store", "/gnu/store", "/etc/ld.so.cache"),
    *("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"),
)


class _StoppedError(Exception):
    """The child cannot be asked again; the message says why."""


class Sandbox:
    """Runs functions of a file that is not trusted in a process of its own, behind what walls there are.

    Each call costs at most its time limit: a child that hangs, dies or answers nonsense is ended with all its
    descendants, and the next call starts another. Which walls there are is found by trying. The file is
    copied: what lies beside it is not there unless it is named in ``files``. Not for several threads at once.

    Parameters
    ----------
    path : str or Path
        The submission, a Python file.
    limits : Limits, optional
    files : sequence of str or Path, optional
        Further files for the submission's folder.
    namespaces : bool, optional
        False to do without Linux namespaces, even where they are granted.

    Raises
    ------
    RadiokitError
        When a file is not there, or no child can be started.

    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "theirs.py")
    ...     _ = file.write_text("def double(x): return 2 * x")
    ...     with Sandbox(file) as sandbox:
    ...         sandbox.call("double", np.array([1.0, 2.0])).values
    ...         sandbox.call("triple", np.array([1.0, 2.0])).error
    (array([2., 4.]),)
    "defines no function 'triple'"
    """

    def __init__(
        self,
        path: str | Path,
        *,
        limits: Limits | None = None,
        files: Sequence[str | Path] = (),
        namespaces: bool = True,
    ) -> None:
        if os.name != "posix":
            raise RadiokitError("isolation needs a POSIX system: run it in WSL or a container")
        self.limits = limits or Limits()
        self._files = {Path(file).name: str(Path(file).resolve()) for file in (*files, path)}
        self._name = Path(path).name
        for file in self._files.values():
            if not Path(file).is_file():
                raise RadiokitError(f"no such file: {file}")
        self._levels = [True, False] if namespaces and sys.platform == "linux" else [False]
        self._process: subprocess.Popen[bytes] | None = None
        self._protections: tuple[str, ...] = ()
        self._requests = self._results = -1
        self._streams: tuple[IO[bytes], ...] = ()
        self._box = ""
        self._output = bytearray()
        self._printed = 0

    def __enter__(self) -> Sandbox:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def call(
        self,
        function: str,
        *arrays: Array,
        mode: Literal["batch", "single", "row"] = "batch",
        parameters: Mapping[str, Any] | None = None,
        timeout: float | None = None,
    ) -> Result:
        """Call a function with arrays.

        Parameters
        ----------
        function : str
            Its name; dots lead to attributes.
        *arrays : ndarray
            Its positional arguments, of numbers.
        mode : {"batch", "single", "row"}
            Whether it is handed the arrays at once, row by row as arrays of one row, or row by row.
        parameters : dict, optional
            Its keyword arguments, as far as JSON carries them.
        timeout : float, optional
            Wall time [s]; ``limits.seconds`` by default.

        Returns
        -------
        Result
            Whatever the function does; nothing that it does is raised here.
        """
        return self._request(function, arrays, timeout, mode=mode, parameters=dict(parameters or {}))

    def facts(self, function: str) -> Result:
        """Ask what a function says of itself: ``facts`` has callable, pdf, sample, transmissive, eta."""
        return self._request(function, (), None, facts=True)

    def close(self) -> None:
        """End the child and all its descendants, and remove what it wrote."""
        process, self._process = self._process, None
        if process is None:
            return
        for descriptor in (self._requests, self._results):
            os.close(descriptor)
        with contextlib.suppress(ProcessLookupError):
            process.send_signal(signal.SIGTERM)  # the launcher then kills all
        try:
            process.wait(5)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        for stream in self._streams:
            stream.close()
        _remove(self._box)

    def _request(
        self, function: str, arrays: tuple[Array, ...], timeout: float | None, **request: Any
    ) -> Result:
        began = time.monotonic()
        self._output.clear()
        self._printed = 0
        found: dict[str, Any] = {}
        try:
            if self._process is None:
                self._start()
            token = secrets.token_hex(8)
            asked = pack({"id": token, "file": self._name, "function": function, **request}, arrays)
            header, values = self._exchange(asked, self.limits.seconds if timeout is None else timeout)
            found = judged(header, values, token)
        except (_StoppedError, MalformedError) as error:
            malformed = isinstance(error, MalformedError)
            found = {"error": f"gave an answer that is not believed: {error}" if malformed else str(error)}
            self.close()
        except BaseException:
            self.close()
            raise
        return Result(
            **found,
            seconds=time.monotonic() - began,
            output=bytes(self._output).decode(errors="replace"),
            protections=self._protections,
        )

    def _start(self) -> None:
        """Start a child behind the highest walls that can be built."""
        told = ""
        while self._levels:
            self._spawn(self._levels[0])
            try:
                header, _ = self._exchange(b"", STARTUP)
                ready = header.get("ready")
                if isinstance(ready, list):
                    self._protections = tuple(name for name in PROTECTIONS if name in ready)
                    return
            except (_StoppedError, MalformedError) as error:
                told = plain_text(f"{error} {bytes(self._output).decode(errors='replace')}")
            self.close()
            self._output.clear()
            self._printed = 0
            if len(self._levels) == 1:
                break
            self._levels.pop(0)
        raise RadiokitError(f"no sandbox can be started here: {told}")

    def _spawn(self, namespaces: bool) -> None:
        self._box = tempfile.mkdtemp(prefix="radiokit-")
        Path(self._box).chmod(0o755)
        self._results, results = os.pipe()
        site = str(Path(np.__file__).resolve().parents[1])
        python = os.path.realpath(sys.executable)
        spec = {
            "box": os.path.realpath(self._box),
            "namespaces": namespaces,
            "limits": dataclasses.asdict(self.limits),
            "python": python,
            "site": site,
            "results": results,
            "uid": 61184 + os.getpid() % 4000,
            "needs": [python, np.__file__, os.__file__],
            "files": {
                "child.py": str(HERE / "child.py"),
                "protocol.py": str(HERE / "protocol.py"),
                **self._files,
            },
            "visible": [*SYSTEM, os.path.realpath(sys.base_prefix), sys.base_prefix, site],
            "hidden": [str(Path(folder).resolve()) for folder in radiokit.__path__],
        }
        command = [python, "-I", "-B", "-S", str(HERE / "launcher.py"), json.dumps(spec)]
        try:
            self._process = process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                pass_fds=(results,),
                start_new_session=True,
                env={"PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"},
                cwd="/",
            )
        finally:
            os.close(results)
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        self._requests = os.dup(process.stdin.fileno())
        process.stdin.close()
        self._streams = (process.stdout, process.stderr)
        for descriptor in (self._requests, self._results, *(each.fileno() for each in self._streams)):
            os.set_blocking(descriptor, False)

    def _exchange(self, request: bytes, seconds: float) -> tuple[dict[str, Any], list[Array]]:
        """Write a request and read the answer, while what is printed is kept within its bounds."""
        deadline = time.monotonic() + seconds
        whole = Assembler(self.limits.answer_bytes)
        left = memoryview(request)
        with selectors.DefaultSelector() as selector:
            for stream in (self._results, *(each.fileno() for each in self._streams)):
                selector.register(stream, selectors.EVENT_READ)
            if left:
                selector.register(self._requests, selectors.EVENT_WRITE)
            while True:
                remaining = deadline - time.monotonic()
                if remaining <= 0:
                    raise _StoppedError(f"took longer than {seconds:g} s")
                for key, _ in selector.select(remaining):
                    if key.fd == self._requests:
                        try:
                            left = left[os.write(key.fd, left) :]
                        except BrokenPipeError:
                            left = left[len(left) :]
                        if not left:
                            selector.unregister(self._requests)
                        continue
                    results = key.fd == self._results
                    data = os.read(key.fd, min(whole.wanted, 1 << 20) if results else 1 << 16)
                    if not results:
                        self._keep(data)
                        if not data:
                            selector.unregister(key.fd)
                    elif not data:
                        raise _StoppedError(self._ending())
                    else:
                        whole.feed(data)
                        if not whole.wanted:
                            self._drain()
                            return whole.message()

    def _keep(self, data: bytes) -> None:
        self._printed += len(data)
        self._output += data[: max(0, KEPT - len(self._output))]
        if self._printed > self.limits.printed_bytes:
            raise _StoppedError(f"printed more than {self.limits.printed_bytes} bytes")

    def _drain(self) -> None:
        """Keep what was printed until now."""
        for stream in self._streams:
            with contextlib.suppress(_StoppedError, BlockingIOError):
                self._keep(os.read(stream.fileno(), 1 << 16))

    def _ending(self) -> str:
        """Say how the child came to its end."""
        assert self._process is not None
        try:
            code = self._process.wait(5)
        except subprocess.TimeoutExpired:
            return "closed its channel of answers"
        self._drain()
        number = -code if code < 0 else code - 128
        if number in set(signal.Signals):
            return f"was ended by {signal.Signals(number).name}"
        return f"ended its process with exit code {code}"


def _remove(folder: str) -> None:
    """Remove a folder of which some parts may have been locked by the one who wrote them."""
    for place, _, _ in os.walk(folder):
        with contextlib.suppress(OSError):
            Path(place).chmod(0o700)
    shutil.rmtree(folder, ignore_errors=True)
