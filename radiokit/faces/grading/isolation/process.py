"""The process: a launcher with the child behind it, and the pipes to them, as the parent sees them."""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import json
import marshal
import os
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

import radiokit
from radiokit.faces.grading.isolation.interrupts import let_in
from radiokit.faces.grading.isolation.limits import PROTECTIONS, Limits
from radiokit.faces.grading.isolation.protocol import Array, Assembler, MalformedError, plain_text
from radiokit.faces.grading.isolation.result import steady
from radiokit.facts.errors import ParameterError, RadiokitError

__all__ = ["ChildProcess", "Files", "LateError", "StoppedError", "carried", "started"]

HERE = Path(__file__).resolve().parent
PROGRAMS = ("child", "sources", "imports", "protocol", "loading", "answers", "signature")
LAUNCHING = ("launcher", "descendants", "landlock", "namespaces", "rights", "seccomp")
STARTUP = 30.0
"""How long Python may take to start [s]."""
ENDING = 5.0
"""How long a launcher may take to clear up [s]."""
TURN = 0.1
"""What one turn of waiting counts at most [s]: where all processes stand still together, no time passes."""
KEPT = 2000
"""How many characters of what is printed are kept."""
Files: TypeAlias = Mapping[str, str | bytes]
"""Paths, or contents, by name."""
SYSTEM = (
    *("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/nix/store", "/gnu/store", "/etc/ld.so.cache"),
    "/etc/fonts",
    *("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"),
)


class StoppedError(Exception):
    """The child cannot be asked again; the message says why, and has the submission as its subject."""


class LateError(StoppedError):
    """It took longer than it may."""


class ChildProcess:
    """A launcher and the child that it starts behind its walls; ``folder`` is its place in the file system.

    ``waited`` is how long the last exchange has taken [s], without the time in which this process was stopped
    or had no turn.

    Parameters
    ----------
    limits : Limits
    files : dict
        What the submission's folder holds: paths, or contents, by name.
    namespaces : bool
        Whether Linux namespaces are asked for; the child does not start where they are not granted.
    """

    def __init__(self, limits: Limits, files: Files, *, namespaces: bool) -> None:
        self.protections: tuple[str, ...] = ()
        self._limits = limits
        self._output = bytearray()
        self._printed = 0
        self.waited = 0.0
        self.folder = os.path.realpath(tempfile.mkdtemp(prefix="radiokit-"))
        try:
            paths = _written(Path(self.folder), files)
            self._results, results = os.pipe()
        except BaseException:
            _remove(self.folder)
            raise
        try:
            self._process = process = subprocess.Popen(
                _command(self.folder, limits, paths, results, namespaces),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,  # what is printed keeps its order
                pass_fds=(results,),
                start_new_session=True,
                env={"PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"},
                cwd="/",
            )
        except BaseException:
            os.close(self._results)
            _remove(self.folder)
            raise
        finally:
            os.close(results)
        assert process.stdin is not None
        assert process.stdout is not None
        self._requests = os.dup(process.stdin.fileno())
        process.stdin.close()
        self._printing = process.stdout
        for descriptor in (self._requests, self._results, self._printing.fileno()):
            os.set_blocking(descriptor, False)

    def exchange(self, request: bytes, seconds: float) -> tuple[dict[str, Any], list[Array]]:
        """Write a request and read the answer, while what is printed is kept within its bounds.

        Raises
        ------
        StoppedError
            When the child ends, prints too much, or, as ``LateError``, takes longer.
        MalformedError
            When what it says is no answer.
        """
        self.waited, before = 0.0, time.monotonic()
        self._printed = 0
        whole = Assembler(self._limits.answer_bytes)
        left = memoryview(request)
        with selectors.DefaultSelector() as selector:
            for stream in (self._results, self._printing.fileno()):
                selector.register(stream, selectors.EVENT_READ)
            if left:
                selector.register(self._requests, selectors.EVENT_WRITE)
            while True:
                if self.waited >= seconds:
                    raise LateError(f"took longer than {seconds:g} s")
                with let_in():
                    ready = selector.select(min(seconds - self.waited, TURN))
                now = time.monotonic()
                self.waited, before = self.waited + min(now - before, TURN), now
                for key, _ in ready:
                    results = key.fd == self._results
                    try:
                        if key.fd == self._requests:
                            left = left[os.write(key.fd, left) :]
                        else:
                            data = os.read(key.fd, min(whole.wanted, 1 << 20) if results else 1 << 16)
                    except BlockingIOError:  # a child of the same user can open its pipes' other ends
                        continue
                    except BrokenPipeError:
                        left = left[len(left) :]
                    if key.fd == self._requests:
                        if not left:
                            selector.unregister(key.fd)
                    elif not results:
                        self._keep(data)
                        if not data:
                            selector.unregister(key.fd)
                    elif not data:
                        raise StoppedError(self._ending())
                    else:
                        whole.feed(data)
                        if not whole.wanted:
                            self._drain()
                            return whole.message()

    def printed(self) -> str:
        """Return the beginning of what was printed since this was asked last, as lines that can be shown."""
        text = steady(bytes(self._output).decode(errors="replace"), self.folder)
        self._output.clear()
        lines = text[:KEPT].replace("\r\n", "\n").replace("\r", "\n").expandtabs()
        return "".join(letter if letter.isprintable() or letter == "\n" else "?" for letter in lines)

    def close(self) -> None:
        """End the child and all its descendants, and remove what it wrote."""
        for descriptor in (self._requests, self._results):
            os.close(descriptor)
        process = self._process
        with contextlib.suppress(ProcessLookupError):
            process.send_signal(signal.SIGTERM)  # the launcher then kills all
        if not self._ended():
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        self._printing.close()
        _remove(self.folder)

    def _keep(self, data: bytes) -> None:
        self._printed += len(data)
        self._output += data[: max(0, 2 * KEPT - len(self._output))]
        if self._printed > self._limits.printed_bytes:
            raise StoppedError(f"printed more than {self._limits.printed_bytes} bytes")

    def _drain(self) -> None:
        """Keep what was printed until now."""
        with contextlib.suppress(StoppedError, BlockingIOError):
            self._keep(os.read(self._printing.fileno(), 1 << 16))

    def _ended(self) -> bool:
        """Wait for the launcher's end, and return whether it came in time."""
        for _ in range(round(ENDING / TURN)):
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(TURN)
                return True
        return False

    def _ending(self) -> str:
        """Say how the child came to its end."""
        if not self._ended():
            return "closed its channel of answers"
        self._drain()
        code = self._process.returncode
        if code == -signal.SIGUSR1:
            return f"used more than {self._limits.memory_bytes / 2**30:.3g} GiB of memory"
        if code == -signal.SIGUSR2:
            return f"ran more than {self._limits.processes} processes"
        number = -code if code < 0 else code - 128
        if number in set(signal.Signals):
            return f"was ended by {signal.Signals(number).name}"
        return f"ended its process with exit code {code}"


def started(limits: Limits, files: Files, levels: list[bool]) -> ChildProcess:
    """Return a child behind the highest walls that can be built; its ``protections`` say which.

    ``levels`` are to be tried in turn, whether namespaces are asked for; one that fails is taken out.

    Raises
    ------
    RadiokitError
        When none can be started.
    """
    while True:
        child = ChildProcess(limits, files, namespaces=levels[0])
        try:
            ready = child.exchange(b"", STARTUP)[0].get("ready")
            if isinstance(ready, list):
                child.protections = tuple(name for name in PROTECTIONS if name in ready)
                return child
            told = "it is not ready"
        except (StoppedError, MalformedError) as error:
            told = plain_text(f"{error} {child.printed()}")
        except BaseException:
            child.close()
            raise
        child.close()
        if len(levels) == 1:
            raise RadiokitError(f"no sandbox can be started here: {told}")
        levels.pop(0)


def carried(given: npt.ArrayLike) -> Array:
    """Return an argument as an array of a type that messages carry."""
    array = np.asarray(given)
    kind = {"i": "<i8", "u": "<i8", "b": "|b1", "c": "<c16", "f": "<f8"}.get(array.dtype.kind)
    if kind is None or (array.dtype.kind == "u" and array.size and array.max() > np.iinfo("i8").max):
        raise ParameterError("arrays", array.dtype, "numbers of at most 64 bits")
    return array.astype("<f4" if array.dtype == np.float32 else kind)


def _written(folder: Path, files: Files) -> dict[str, str]:
    """Write the programs, and the files that are none yet; return the files' paths by name."""
    for name in (*PROGRAMS, *LAUNCHING):  # compiled once, as a class has many submissions
        Path(folder, f"{name}.pyc").write_bytes(_compiled(name))
    paths = {}
    for number, (name, given) in enumerate(files.items()):
        paths[name] = given if isinstance(given, str) else str(folder / f"{number}.file")
        if isinstance(given, bytes):
            Path(paths[name]).write_bytes(given)
    return paths


@functools.cache
def _compiled(name: str) -> bytes:
    """Return one of the programs, as Python would keep it in a cache of its own."""
    code = compile((HERE / f"{name}.py").read_bytes(), f"{name}.py", "exec", dont_inherit=True)
    return importlib.util.MAGIC_NUMBER + bytes(12) + marshal.dumps(code)


def _command(folder: str, limits: Limits, files: dict[str, str], results: int, namespaces: bool) -> list[str]:
    """Return the launcher's command line."""
    python = os.path.realpath(sys.executable)
    site = str(Path(np.__file__).resolve().parents[1])
    visible = [*SYSTEM, os.path.realpath(sys.base_prefix), sys.base_prefix, site]
    spec = {
        "box": folder,
        "namespaces": namespaces,
        "limits": vars(limits),
        "python": python,
        "sites": [site, *_packages(site, visible)],
        "results": results,
        "needs": [python, np.__file__, os.__file__],
        "programs": {f"{name}.pyc": f"{folder}/{name}.pyc" for name in PROGRAMS},
        "files": files,
        "visible": visible,
        "hidden": [str(Path(folder).resolve()) for folder in radiokit.__path__],
    }
    return [python, "-I", "-B", "-S", f"{folder}/launcher.pyc", json.dumps(spec)]


def _packages(site: str, visible: Sequence[str]) -> list[str]:
    """Return the other folders of packages that are in sight."""
    folders = [os.path.realpath(path) for path in sys.path if path.endswith("-packages")]
    return [
        folder
        for folder in dict.fromkeys(folders)
        if folder != site and any(folder.startswith(f"{place}/") for place in visible)
    ]


def _remove(folder: str) -> None:
    """Remove a folder of which some parts may have been locked by the one who wrote them."""
    for place, _, _ in os.walk(folder):
        with contextlib.suppress(OSError):
            Path(place).chmod(0o700)
    shutil.rmtree(folder, ignore_errors=True)
