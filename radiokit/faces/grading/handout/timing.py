"""Timing: ends a student's own function in this process when its time is up, where signals can do it."""

from __future__ import annotations

import contextlib
import signal
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from types import FrameType

__all__ = ["Clock", "LateError"]

AGAIN = 0.1
"""After how long [s] it is tried once more, for code that catches everything."""


class LateError(BaseException):
    """The time is up; no ``except Exception`` of a student catches it."""


@dataclass
class Clock:
    """Wall time [s] that calls share.

    >>> with contextlib.suppress(LateError), Clock(0.05).running():
    ...     while True:
    ...         pass
    """

    left: float

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        """Raise ``LateError`` inside when no time is left; in the main thread, if no timer runs there."""
        if (
            not hasattr(signal, "setitimer")
            or threading.current_thread() is not threading.main_thread()
            or signal.getitimer(signal.ITIMER_REAL)[0]
        ):
            yield
            return
        inside, began = True, time.monotonic()

        def late(signum: int, frame: FrameType | None) -> None:
            if inside:
                raise LateError

        before = signal.signal(signal.SIGALRM, late)
        try:
            signal.setitimer(signal.ITIMER_REAL, max(self.left, 1e-3), AGAIN)
            yield
        finally:
            inside = False
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before or signal.SIG_DFL)
            self.left -= time.monotonic() - began
