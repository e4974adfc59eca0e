"""The sandbox: the parent's side: starts a child, asks it, doubts its answers, and ends it."""

from __future__ import annotations

import os
import secrets
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any, Literal

import numpy.typing as npt

from radiokit.faces.grading.isolation.budgets import Budgets
from radiokit.faces.grading.isolation.handed import handed
from radiokit.faces.grading.isolation.interrupts import held
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.isolation.process import ChildProcess, LateError, StoppedError, carried, started
from radiokit.faces.grading.isolation.protocol import ARRAYS, Array, MalformedError, pack
from radiokit.faces.grading.isolation.result import Result, judged
from radiokit.facts.errors import ParameterError, RadiokitError

__all__ = ["Sandbox"]

BRANCHING = 5.0
"""How long a child may take to make a copy of itself, or to end one, if its calls have so much left [s]."""
CLEARING = 1.0
"""How long it may take to end one if they have less [s]."""
ENDING = 1.0
"""What is left to a child to say that it came to the end of its time [s]."""


class Sandbox:
    """Runs functions of a file that is not trusted in a process of its own, behind what walls there are.

    Each call costs at most its time limit: a child that hangs, dies or answers nonsense is ended with all its
    descendants, and the next call starts another. Which walls there are is found by trying. The file is
    copied: what lies beside it is not there unless it is named in ``files``. It is run statement by
    statement, and what raises costs itself alone; it is the module ``submission``, and not ``__main__``.
    Python's hashes are fixed. Not for several threads at once.

    Parameters
    ----------
    path : str or Path
        The submission, a Python file or a Jupyter notebook.
    content : bytes, optional
        What it holds, where it is no file: then ``path`` is its name alone.
    limits : Limits, optional
    files : sequence of str or Path, optional
        Further files for the submission's folder.
    namespaces : bool, optional
        False to do without Linux namespaces, even where they are granted.
    beside : Sandbox, optional
        Another one, whose limits that calls share are this one's, too.

    Raises
    ------
    RadiokitError
        When a file is not there or too large, or no child can be started.

    >>> import tempfile
    >>> import numpy as np
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
        content: bytes | None = None,
        limits: Limits | None = None,
        files: Sequence[str | Path] = (),
        namespaces: bool = True,
        beside: Sandbox | None = None,
    ) -> None:
        if os.name != "posix":
            raise RadiokitError("isolation needs a POSIX system: run it in WSL or a container")
        self.limits = limits or Limits()
        self._name = Path(path).name
        self._files = handed(Path(path), content, [Path(file) for file in files])
        self._levels = [True, False] if namespaces and sys.platform == "linux" else [False]
        self._held = ExitStack()
        self._child: ChildProcess | None = None
        self._protections: tuple[str, ...] = ()
        self._loaded: Result | None = None
        self._budgets: Budgets = Budgets() if beside is None else beside._budgets
        self._apart = self._branched = False
        self._end = self._output = ""
        self._waited = self._stood = 0.0

    def __enter__(self) -> Sandbox:
        """Hold interrupts from here on; they are let in while a child is waited for."""
        self._held.enter_context(held())
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._held:
            self.close()

    def load(self, timeout: float | None = None) -> Result:
        """Start a child and load the submission, if that is still to be done.

        A statement may take half of the time that is left; then it is stopped, and the next one begins.

        Parameters
        ----------
        timeout : float, optional
            Wall time [s]; ``limits.load_seconds`` by default.

        Returns
        -------
        Result
            Its ``facts`` have ``names``, of the functions and classes that the submission defines, in order,
            and ``problems``, a list of {where, raised, message}; ``raised`` is empty where nothing was.
        """
        if self._child is None or self._loaded is None or self._loaded.error:
            seconds = self.limits.load_seconds if timeout is None else timeout
            began = time.monotonic()
            self._loaded = self._request(
                {"load": seconds}, (), seconds + ENDING, f"took longer than {seconds:g} s"
            )
            self._budgets.spend_loading(time.monotonic() - began, self)
        return self._loaded

    def call(
        self,
        function: str,
        *arrays: npt.ArrayLike,
        mode: Literal["batch", "single", "row", "scalar"] = "batch",
        outputs: int = 1,
        seed: int | None = None,
        parameters: Mapping[str, Any] | None = None,
        timeout: float | None = None,
    ) -> Result:
        """Call a function with arrays; the submission is loaded first, where it is not, for its own time.

        Parameters
        ----------
        function : str
            Its name; dots lead to attributes.
        *arrays : array_like
            Its positional arguments, of numbers, at most 8; those without dimensions arrive as int, float,
            complex or bool.
        mode : {"batch", "single", "row", "scalar"}
            Whether it is handed the arrays at once, row by row as arrays of one row, or row by row; with
            "scalar" the rows of arrays of one dimension arrive as Python's numbers.
        outputs : int, optional
            How many values it must return, 1 to 8; if several, as a tuple or list.
        seed : int, optional
            What the generators of ``random`` and ``numpy.random`` are seeded with before, at least 0.
        parameters : dict, optional
            Its keyword arguments, as far as JSON carries them.
        timeout : float, optional
            Wall time [s]; ``limits.seconds`` by default.

        Returns
        -------
        Result
            Whatever the function does; nothing that it does is raised here.

        Raises
        ------
        ParameterError
            When the arguments are not of these kinds.
        """
        if type(outputs) is not int or not 1 <= outputs <= ARRAYS:
            raise ParameterError("outputs", outputs, f"an integer from 1 to {ARRAYS}")
        if seed is not None and (type(seed) is not int or seed < 0):
            raise ParameterError("seed", seed, "an integer of at least 0")
        given = [carried(array) for array in arrays]
        if mode != "batch" and len({len(array) for array in given if array.ndim}) > 1:
            raise ParameterError("arrays", [array.shape for array in given], "arrays of equally many rows")
        return self._called(
            {
                "function": function,
                "mode": mode,
                "outputs": outputs,
                "seed": seed,
                "parameters": dict(parameters or {}),
                "limit": self.limits.answer_bytes,
            },
            given,
            timeout,
        )

    def facts(self, function: str) -> Result:
        """Ask what a function says of itself: callable, pdf, sample, transmissive, eta and parameters."""
        return self._called({"function": function, "facts": True}, (), None)

    @contextmanager
    def within(self, seconds: float) -> Iterator[None]:
        """Let all calls inside share this wall time [s], with the copies that `apart` makes for them.

        A first loading, and what is between, are free.
        """
        with self._budgets.within(seconds):
            yield

    @contextmanager
    def apart(self) -> Iterator[None]:
        """Let the calls inside begin from the submission as it was loaded; what they change is forgotten.

        They take place in a copy of the process, and what that starts ends with it. What they write into
        files stays. The copy runs the submission's own code: one that is hostile can keep more, to nobody's
        harm but its own.
        """
        self._apart = True
        try:
            yield
        finally:
            self._apart = False
            if self._branched:
                self._branch(False)

    def close(self) -> None:
        """End the child and all its descendants, and remove what it wrote."""
        self._branched = False
        with held():
            child, self._child = self._child, None
            if child is not None:
                self._output = child.printed()
                child.close()

    def _called(self, request: dict[str, Any], arrays: Sequence[Array], timeout: float | None) -> Result:
        limit, branched = self.limits.seconds if timeout is None else timeout, 0.0
        for last in (False, True):
            if self._child is None or self._loaded is None:
                failed = self._loaded is not None and bool(self._loaded.error)  # then it would fail again
                loaded = self._loaded if failed and self._loaded is not None else self.load()
                if loaded.error:
                    error = f"could not be loaded: it {loaded.error}"
                    return Result(error=error, protections=self._protections)
            seconds, late = self._budgets.left(limit)
            if self._branched or not self._apart or seconds <= 0:
                break
            branch = self._branch(True)
            branched += branch.seconds
            seconds, late = self._budgets.left(limit)
            if branch.ok or seconds <= 0:
                break
            if last:  # the first time, it may be what earlier calls have left
                return branch
        if seconds <= 0:
            return Result(error=late, ended=True, protections=self._protections)
        result = self._charged(request, arrays, seconds, late)
        return replace(result, seconds=branched + result.seconds)

    def _charged(self, request: dict[str, Any], arrays: Sequence[Array], *more: Any) -> Result:
        """Ask the child, and take from what calls share the time of that, and of ending it where it must."""
        began = time.monotonic()
        result = self._request(request, arrays, *more)
        self._budgets.spend(time.monotonic() - began - self._stood if result.ended else result.seconds)
        return result

    def _branch(self, begins: bool) -> Result:
        """Begin or end a copy of the process that the submission was loaded in."""
        if begins:
            self._end = secrets.token_hex(8)
        token, least = ("", 0.0) if begins else (self._end, CLEARING)
        seconds = max(self._budgets.left(BRANCHING)[0], least)
        asked = {"branch": begins, "end": self._end}
        result = self._charged(asked, (), seconds, "did not answer", token)
        if result.error:  # the next call loads it anew
            self.close()
        self._branched = begins and result.ok
        return result

    def _request(
        self, request: dict[str, Any], arrays: Sequence[Array], seconds: float, late: str, token: str = ""
    ) -> Result:
        """Ask the child, and return what becomes of it."""
        found: dict[str, Any] = {}
        try:
            with held():
                child = self._child = self._child or self._started()
            token = token or secrets.token_hex(8)
            asked = pack({"id": token, "file": self._name, **request}, arrays)
            began = time.monotonic()
            try:
                header, values = child.exchange(asked, seconds)
            finally:
                self._waited = child.waited
                self._stood = max(0.0, time.monotonic() - began - child.waited)
            found = judged(header, values, token, outputs=request.get("outputs", 1), folder=child.folder)
            self._output = child.printed()
        except (StoppedError, MalformedError) as error:
            malformed = isinstance(error, MalformedError)
            found = {"error": f"gave an answer that is not believed: {error}" if malformed else str(error)}
            found = {"error": late} if isinstance(error, LateError) else found
            found["ended"] = True
            self.close()
        except BaseException:
            self.close()
            raise
        return Result(
            **found,
            seconds=self._waited,
            output=self._output,
            protections=self._protections,
        )

    def _started(self) -> ChildProcess:
        """Return a child behind the highest walls that can be built."""
        child = started(self.limits, self._files, self._levels)
        self._protections = child.protections
        return child
