"""Interrupts: signals that end this process wait while something must not be left half done."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

__all__ = ["held", "let_in"]

ENDING = (signal.SIGTERM, signal.SIGINT)


class _EndedError(BaseException):
    """Raised where a signal is let in that would otherwise end the process without clearing up."""


class _Hold:
    """The handlers that were there before, and the signals that wait for them."""

    def __init__(self) -> None:
        self.before: dict[signal.Signals, Any] = {}
        self.waiting: list[int] = []
        self.open = self.taken = False

    def begin(self) -> None:
        for number in ENDING:
            before = signal.getsignal(number)
            if before not in (None, signal.SIG_IGN):
                self.before[number] = before
                signal.signal(number, self.receive)

    def receive(self, number: int, frame: FrameType | None) -> None:
        """Let a signal wait, or, where it is let in, end what is under way: once, and then no more."""
        if not self.open:
            self.waiting.append(number)
            return
        self.open, self.taken = False, True
        before = self.before[signal.Signals(number)]
        if not callable(before):
            self.waiting.append(number)
            raise _EndedError
        before(number, frame)  # which usually raises KeyboardInterrupt
        self.open, self.taken = True, False

    def end(self) -> None:
        for number, before in self.before.items():  # SIGINT last, as its handler raises
            signal.signal(number, before)


_hold: _Hold | None = None


@contextmanager
def held() -> Iterator[None]:
    """Let SIGTERM and SIGINT wait for the end of the block, and then do what they would have done.

    Within it they are let in only where ``let_in`` says so. Where this is not the main thread, or they are
    held already, it changes nothing: Python runs handlers in the main thread alone.

    >>> before = signal.signal(signal.SIGTERM, lambda number, frame: print("ended"))
    >>> with held():
    ...     signal.raise_signal(signal.SIGTERM)
    ...     print("cleared up")
    cleared up
    ended
    >>> _ = signal.signal(signal.SIGTERM, before)
    """
    global _hold
    if _hold is not None or threading.current_thread() is not threading.main_thread():
        yield
        return
    hold = _Hold()
    try:
        hold.begin()
        _hold = hold
        yield
    finally:
        _hold = None
        hold.end()
        for number in hold.waiting:
            if not (hold.taken and callable(hold.before[signal.Signals(number)])):
                signal.raise_signal(number)


@contextmanager
def let_in() -> Iterator[None]:
    """Let in the signals that are held, as this is a place where the block can end."""
    hold = _hold
    if hold is None or hold.taken or threading.current_thread() is not threading.main_thread():
        yield
        return
    try:
        hold.open = True
        while hold.waiting:
            hold.receive(hold.waiting.pop(), None)
        yield
    finally:
        hold.open = False
