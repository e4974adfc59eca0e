"""Workers: where long runs take place: in this process, in local processes, or on a Dask cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from typing import Any

from radiokit.facts.errors import MissingExtraError, ParameterError, RadiokitError

__all__ = ["SerialExecutor", "available_workers", "open_executor"]

CONNECT_TIMEOUT = 30.0
"""How long a scheduler may take to answer [s]."""
GRACE = 10.0
"""How long a task may take to clear up when the process that gave it is gone [s]."""


class SerialExecutor(Executor):
    """An executor that runs each task at once, in the caller's thread.

    >>> with SerialExecutor() as executor:
    ...     executor.submit(pow, 2, 10).result()
    1024
    """

    _closed = False

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run ``fn`` and return its finished future; an exception waits there for ``result()``."""
        if self._closed:
            raise RuntimeError("cannot schedule new futures after shutdown")
        future: Future[Any] = Future()
        future.set_running_or_notify_cancel()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future

    def map(
        self,
        fn: Callable[..., Any],
        *iterables: Iterable[Any],
        timeout: float | None = None,
        chunksize: int = 1,
        **options: Any,
    ) -> Iterator[Any]:
        """Return the results in order, each computed when it is asked for, so that progress can be seen."""
        if self._closed:
            raise RuntimeError("cannot schedule new futures after shutdown")
        return map(fn, *iterables)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no further tasks; none is pending."""
        self._closed = True


def available_workers() -> int:
    """Return the number of processors that this process may use.

    >>> available_workers() >= 1
    True
    """
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def open_executor(workers: int | None = None, scheduler: str | None = None) -> Iterator[Executor]:
    """Open the executor for a long run, and close it when the block ends.

    Results must not depend on the choice: hand every task its own seed, and keep the order of the results,
    as ``Executor.map`` does. An interrupt ends local processes at once, and they do not outlive this one.

    Parameters
    ----------
    workers : int, optional
        How many local processes, at least 1. ``None`` and 1 run in this process; ``available_workers()``
        is as many as there are processors. The processes are spawned: tasks and their arguments must
        pickle.
    scheduler : str, optional
        The address of a Dask scheduler, such as ``"tcp://10.0.0.1:8786"``, whose workers do the work.
        They need radiokit of the same version.

    Yields
    ------
    concurrent.futures.Executor

    Raises
    ------
    ParameterError
        When ``workers`` is no positive integer, or is given together with ``scheduler``.
    MissingExtraError
        When ``scheduler`` is given and Dask is not installed.
    RadiokitError
        When the scheduler does not answer.

    >>> with open_executor() as executor:
    ...     list(executor.map(abs, [-1, 2, -3]))
    [1, 2, 3]
    """
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int) or workers < 1):
        raise ParameterError("workers", workers, "a whole number, at least 1")
    if scheduler is not None:
        if workers is not None:
            raise ParameterError("workers", workers, "left out when a scheduler is given")
        with _cluster(scheduler) as executor:
            yield executor
    elif workers is None or workers == 1:
        with SerialExecutor() as executor:
            yield executor
    else:
        with _processes(workers) as executor:
            yield executor


@contextmanager
def _processes(workers: int) -> Iterator[Executor]:
    import multiprocessing
    import signal
    from concurrent.futures import ProcessPoolExecutor

    class Pool(ProcessPoolExecutor):
        """Starts workers, as tasks are submitted, which no interrupt meets before they can ignore it."""

        def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            if not hasattr(signal, "pthread_sigmask"):
                return super().submit(fn, *args, **kwargs)
            before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])  # a worker inherits it
            try:
                return super().submit(fn, *args, **kwargs)
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, before)

    # Forking a process whose threads hold locks can hang; spawning is the same on every system.
    context = multiprocessing.get_context("spawn")
    executor = Pool(workers, mp_context=context, initializer=_start_worker)
    others = set(multiprocessing.active_children())
    try:
        yield executor
    except BaseException as error:
        if not isinstance(error, Exception):  # an interrupt does not wait for what is running
            for process in set(multiprocessing.active_children()) - others:
                process.terminate()
        executor.shutdown(wait=True, cancel_futures=True)
        raise
    executor.shutdown()


def _start_worker() -> None:
    """Leave interrupts, which a terminal sends to all its processes, to the parent; end when it is gone."""
    import multiprocessing
    import signal
    import threading
    import time

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)  # a task may clear up
        time.sleep(GRACE)
        os._exit(1)

    threading.Thread(target=watch, name="parent", daemon=True).start()


@contextmanager
def _cluster(address: str) -> Iterator[Executor]:
    try:
        from distributed import Client
    except ImportError:
        raise MissingExtraError("running on a Dask cluster", "distributed", "cluster") from None

    try:
        client = Client(address, timeout=CONNECT_TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise RadiokitError(
            f"no Dask scheduler answers at {address!r}: {error}", scheduler=address
        ) from error
    with client, client.get_executor(pure=False) as executor:  # what failed is run again when it is asked for
        yield executor
