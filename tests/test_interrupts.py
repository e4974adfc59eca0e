"""Interrupts: wherever a signal comes, a sandbox is ended and nothing is left of it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from classroom import left_of, wait_until

from radiokit.faces.grading.isolation.interrupts import held, let_in
from radiokit.faces.grading.isolation.sandbox import Sandbox

DOUBLE = b"def double(x): return 2 * x"


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """Where these tests run in the background of a shell, interrupts are ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def received() -> Iterator[list[int]]:
    """The signals that got through to handlers, which raise nothing."""
    numbers: list[int] = []
    before = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    for each in before:
        signal.signal(each, lambda number, frame: numbers.append(number))
    yield numbers
    for each, handler in before.items():
        signal.signal(each, handler)


def test_what_is_held_comes_at_the_end_in_its_order(received: list[int]) -> None:
    with held():
        signal.raise_signal(signal.SIGTERM)
        with held():
            signal.raise_signal(signal.SIGINT)
        assert received == []
    assert received == [signal.SIGTERM, signal.SIGINT]
    signal.raise_signal(signal.SIGINT)
    assert len(received) == 3


def test_what_is_let_in_comes_at_once(received: list[int]) -> None:
    with held():
        signal.raise_signal(signal.SIGINT)
        with let_in():
            assert received == [signal.SIGINT]
            signal.raise_signal(signal.SIGTERM)
            assert received == [signal.SIGINT, signal.SIGTERM]
        signal.raise_signal(signal.SIGTERM)
        assert len(received) == 2
    assert len(received) == 3
    with let_in():
        signal.raise_signal(signal.SIGINT)
    assert len(received) == 4


def test_after_an_interrupt_was_let_in_the_rest_is_cleared_up_undisturbed() -> None:
    done = []

    def interrupted() -> None:
        try:
            with let_in():
                signal.raise_signal(signal.SIGINT)
                done.append("not this")
        finally:
            signal.raise_signal(signal.SIGINT)
            with let_in():
                done.append("cleared up")

    with pytest.raises(KeyboardInterrupt), held():
        interrupted()
    assert done == ["cleared up"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


ENDED = """
import signal
from pathlib import Path
from radiokit.faces.grading.isolation.interrupts import held, let_in
with held():
    try:
        if {waits}:
            with let_in():
                signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGTERM)
        print("went on", flush=True)
    finally:
        print("cleared up", flush=True)
print("never")
"""


@pytest.mark.skipif(os.name != "posix", reason="a process is ended by a signal on POSIX systems alone")
@pytest.mark.parametrize(("waits", "printed"), [(False, "went on\ncleared up\n"), (True, "cleared up\n")])
def test_what_ends_a_process_does_so_when_it_has_cleared_up(waits: bool, printed: str) -> None:
    code = ENDED.format(waits=waits)
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (-signal.SIGTERM, printed)


def test_ignored_signals_stay_ignored_and_other_threads_change_nothing() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with held():
            assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
    found: list[Any] = []

    def look() -> None:
        with held(), let_in():
            found.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=look)
    thread.start()
    thread.join()
    assert found == [before]


def _work() -> None:
    with Sandbox("theirs.py", content=DOUBLE) as sandbox:
        assert sandbox.call("double", np.ones(3)).values[0].tolist() == [2, 2, 2]


def _lines(work: Callable[[], None], interrupted: int) -> int:
    """Run some work, with an interrupt before one of the lines of the sandbox, and count these."""
    count = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal count
        if f"{os.sep}isolation{os.sep}" not in frame.f_code.co_filename:
            return None
        if event == "line" and not frame.f_code.co_filename.endswith("interrupts.py"):
            count += 1
            if count == interrupted:
                sys.settrace(None)
                signal.raise_signal(signal.SIGINT)
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        work()
    finally:
        sys.settrace(before)
    return count


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")
def test_an_interrupt_before_any_line_of_the_sandbox_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    _work()  # which levels of walls there are is asked anew, but the programs are compiled once
    lines = _lines(_work, 0)
    assert lines > 100
    assert not list(tmp_path.iterdir())
    interrupted = 0
    for line in (1 + rng.permutation(lines)).tolist():
        try:
            _lines(_work, line)
        except KeyboardInterrupt:  # a line that comes only when there is long to wait need not come again
            interrupted += 1
        wait_until(lambda: not left_of(-1, tmp_path))
        assert not list(tmp_path.iterdir()), f"before line {line} of {lines}"
        if interrupted == 12:
            return
    pytest.fail(f"only {interrupted} interrupts of {lines}")
