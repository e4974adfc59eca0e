"""Pool: many tasks by few workers, each exactly once, though workers die; it knows nothing of grades."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from typing import TypeVar

from radiokit.faces.workers import open_executor
from radiokit.facts.errors import RadiokitError

__all__ = ["TRIES", "completed"]

Tag = TypeVar("Tag")
Task = TypeVar("Task")
Found = TypeVar("Found")

TRIES = 2
"""How often a task may end its worker while nothing else runs there, before it is given up."""
MOST = 256
"""How many tasks a cluster is sent ahead."""
WEIGHT = 1 << 26
"""How much they may weigh together; one is always sent."""


def completed(
    perform: Callable[[Task], Found],
    tasks: Iterator[tuple[Tag, Task]],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    weight: Callable[[Task], int] = lambda task: 0,
) -> Generator[tuple[Tag, Found | None], None, None]:
    """Yield each task's tag with its result, as they finish; with None where it ends its worker each time.

    Tasks are taken as they are needed, so that few are in memory. Those that are lost with a worker may not
    be what ended it: they are tried again one by one, while nothing else runs. An error that ``perform``
    raises counts as such an end, but for those below.

    Raises
    ------
    RadiokitError
        When ``perform`` raises it, workers cannot be started, lack what they need, or the scheduler is gone.

    >>> sorted(completed(abs, iter([("a", -1), ("b", 2)])))
    [('a', 1), ('b', 2)]
    """
    most = MOST if scheduler else 2 * workers if workers and workers > 1 else 1
    broken = True
    while broken:
        lost: list[tuple[Tag, Task]] = []
        with open_executor(workers, scheduler) as executor:
            broken = yield from _together(executor, perform, tasks, lost, most, weight)
        for tag, task in lost:
            yield tag, _alone(perform, task, scheduler)


def _together(
    executor: Executor,
    perform: Callable[[Task], Found],
    tasks: Iterator[tuple[Tag, Task]],
    lost: list[tuple[Tag, Task]],
    most: int,
    weight: Callable[[Task], int],
) -> Generator[tuple[Tag, Found | None], None, bool]:
    """Yield what is found until all tasks are done or the executor is broken, and return whether it is."""
    pending: dict[Future[Found], tuple[Tag, Task]] = {}
    broken = False
    heavy = 0
    try:
        while True:
            while not broken and len(pending) < most and heavy < WEIGHT:
                item = next(tasks, None)
                if item is None:
                    break
                try:
                    pending[executor.submit(perform, item[1])] = item
                    heavy += weight(item[1])
                except BrokenExecutor:
                    lost.append(item)
                    broken = True
            if not pending:
                return broken
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                tag, task = pending.pop(future)
                heavy -= weight(task)
                error = _error(future)
                if error is None:
                    yield tag, future.result()
                else:
                    lost.append((tag, task))
                    broken = broken or isinstance(error, BrokenExecutor)
    finally:
        for future in pending:  # none, but when this is left early
            future.cancel()


def _alone(perform: Callable[[Task], Found], task: Task, scheduler: str | None) -> Found | None:
    """Return the result of a task that runs while nothing else does; None where it ends its worker."""
    for _ in range(TRIES):
        with open_executor(None if scheduler else 2, scheduler) as executor:  # of 2: 1 is no other process
            if _error(executor.submit(abs, -1)) is not None:
                raise RadiokitError(
                    "worker processes cannot be started; a script that grades a class with several workers "
                    "does so below `if __name__ == '__main__':`"
                )
            future = executor.submit(perform, task)
            if _error(future) is None:
                return future.result()
    return None


def _error(future: Future[Found]) -> BaseException | None:
    """Wait for a future and return its error, raising those that would meet every task."""
    try:
        error = future.exception()
    except CancelledError:
        raise RadiokitError("the scheduler has gone away; run again to grade what is left") from None
    except BaseException:
        future.cancel()
        raise
    if isinstance(error, RadiokitError):
        raise error
    if isinstance(error, ImportError):
        raise RadiokitError(f"a worker lacks what it needs: {error}") from error
    return error
