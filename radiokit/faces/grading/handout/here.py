"""Here: a function of this process as a grader's callee, for one's own code: nothing is isolated."""

from __future__ import annotations

import contextlib
import functools
import io
import linecache
import math
import random
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any

import numpy as np

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.grading.finding import Mode
from radiokit.faces.grading.handout.timing import Clock, LateError
from radiokit.faces.grading.isolation.answers import RefusedError, Taker
from radiokit.faces.grading.isolation.protocol import Array, plain_text
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.isolation.signature import listed, renamed

__all__ = ["Here"]

LIMIT = 1 << 28
"""How many bytes an answer may have."""
LONGEST = 3600.0
"""How long calls may take [s] at most."""
KEPT = 2000
"""How many letters of what is printed are kept."""


@dataclass
class Here:
    """A function of this process, that is called as a sandbox would call it.

    Parameters
    ----------
    function : callable or None
        None where there is none of that name.
    name : str
    namespace : mapping
        Where its other functions are found.
    seconds : float
        How long all its calls may take, where signals can end them; then ``LateError`` is raised.
    printed, raised, where : str
        What it printed first, what it raised last, and where, with the line that did.

    >>> twice = Here(lambda x: 2 * x, "twice")
    >>> twice.call(np.array([1.0, 2.0])).values
    (array([2., 4.]),)
    >>> twice.call(np.array([1.0, 2.0, 3.0]), outputs=2).error
    'returned one value where 2 are wanted, as in return a, b'
    """

    function: Callable[..., Any] | None
    name: str
    namespace: Mapping[str, Any] = field(default_factory=dict)
    seconds: float = math.inf
    printed: str = ""
    raised: str = ""
    where: str = ""

    def __post_init__(self) -> None:
        self._clock = Clock(min(self.seconds, LONGEST))

    def call(self, *arrays: Array, mode: Mode = "batch", outputs: int = 1, seed: int | None = None) -> Result:
        """Call it with copies; whatever it does, but for what interrupts, a result comes back."""
        if self.function is None:
            return Result(error=f"defines no function {self.name!r}")
        began = time.monotonic()
        found: dict[str, Any] = {}
        with self._quiet(seed) as printed:
            try:
                with self._clock.running():
                    values = tuple(self._called(arrays, mode, outputs))
                found = {"values": values}
            except RefusedError as error:
                found = {"error": plain_text(error)}
            except (Exception, SystemExit) as error:
                kind, text = type(error).__name__, plain_text(_told(error))
                found = {"error": f"raised {kind}: {text}" if text else f"raised {kind}", "raised": kind}
                found["where"], line = self._where(error.__traceback__)
                self.raised = found["error"]
                self.where = f"{found['where']}: {line}" if line else found["where"]
            except LateError as error:
                self.raised = f"took longer than {self.seconds:g} s in all"
                place, line = self._where(error.__traceback__)
                self.where = f"{place}: {line}" if line else place
                raise
        text = printed.getvalue()[:KEPT]
        self.printed = self.printed or text
        return Result(**found, seconds=time.monotonic() - began, output=text)

    def bsdf(self, parameters: Mapping[str, Any] | None = None) -> BSDF:
        """Return it as a BSDF; parameters that it has other names for are passed by position."""
        if self.function is None or not parameters:
            return as_bsdf(self.function, label=self.name)
        bound = functools.partial(self.function, **renamed(listed(self.function), parameters))
        about = {name: getattr(self.function, name, None) for name in ("transmissive", "eta")}
        given = {name: parameters.get(name, value) for name, value in about.items()}
        light = bool(given["transmissive"])
        return as_bsdf(bound, label=self.name, transmissive=light, eta=given["eta"] if light else None)

    def other(self, name: str) -> Here:
        """Return another function from beside it."""
        found = self.namespace.get(name)
        return Here(found if callable(found) else None, name, self.namespace, self.seconds)

    def _called(self, arrays: tuple[Array, ...], mode: Mode, outputs: int) -> list[Array]:
        assert self.function is not None
        given = [array.copy() if array.ndim else array.item() for array in map(np.asarray, arrays)]
        taker = Taker(LIMIT)
        lengths = [len(array) for array in given if isinstance(array, np.ndarray)]
        if mode == "batch" or not lengths:
            return list(taker.outputs(self.function(*given), outputs))
        rows = [
            taker.outputs(self.function(*(_row(each, i, mode) for each in given)), outputs)
            for i in range(lengths[0])
        ]
        return list(taker.stacked(rows, outputs, mode == "single"))

    @contextlib.contextmanager
    def _quiet(self, seed: int | None) -> Iterator[io.StringIO]:
        """Keep what is printed, drop warnings, and give nobody's random numbers back their state."""
        printed = io.StringIO()
        states = random.getstate(), np.random.get_state()  # noqa: NPY002 - a student's function uses it
        with warnings.catch_warnings(), contextlib.redirect_stdout(printed):
            warnings.simplefilter("ignore")
            try:
                if seed is not None:
                    random.seed(seed)
                    np.random.seed(seed % (1 << 32))  # noqa: NPY002
                yield printed
            finally:
                random.setstate(states[0])
                np.random.set_state(states[1])  # noqa: NPY002

    def _where(self, trace: TracebackType | None) -> tuple[str, str]:
        """Return the last line of the student's that a traceback goes through, and what stands in it."""
        mine = getattr(getattr(self.function, "__code__", None), "co_filename", None)
        cells, found = _cells(), ("", "")
        while trace is not None:
            file, number = trace.tb_frame.f_code.co_filename, trace.tb_lineno
            if file == mine or file in cells:
                cell = f"cell {cells[file]}, " if file in cells else ""
                found = f"{cell}line {number}", plain_text(linecache.getline(file, number), 80)
            trace = trace.tb_next
        return found


def _row(value: Any, i: int, mode: Mode) -> Any:
    if not isinstance(value, np.ndarray):
        return value
    if mode == "single":
        return value[i : i + 1]
    return value[i].item() if mode == "scalar" and value.ndim == 1 else value[i]


def _told(error: BaseException) -> str:
    try:
        return str(error)
    except Exception:
        return "its message cannot be read"


def _cells() -> Mapping[str, int]:
    """Return the numbers of a notebook's cells by the names of their files."""
    if "IPython" not in sys.modules:
        return {}
    from IPython import get_ipython

    shell = get_ipython()
    found = getattr(getattr(shell, "compile", None), "_filename_map", None)
    return found if isinstance(found, dict) else {}
