"""Executors: the same results and the same errors wherever the tasks run."""

from __future__ import annotations

import math
import os
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager

import numpy as np
import pytest

from radiokit.faces import workers as workers_module
from radiokit.faces.workers import SerialExecutor, available_workers, open_executor
from radiokit.facts.errors import MissingExtraError, ParameterError, RadiokitError


def _mean(seed: int) -> float:
    return float(np.random.default_rng(seed).random(1000).mean())


def _fail(value: float) -> float:
    raise ParameterError("alpha", value, "in (0, 1]")


@contextmanager
def _local_cluster() -> Iterator[Executor]:
    distributed = pytest.importorskip("distributed", reason="needs radiokit[cluster]")
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as cluster,
        open_executor(scheduler=cluster.scheduler_address) as executor,
    ):
        yield executor


@contextmanager
def _opened(where: str) -> Iterator[Executor]:
    if where == "dask":
        with _local_cluster() as executor:
            yield executor
    else:
        with open_executor(None if where == "default" else int(where)) as executor:
            yield executor


@pytest.mark.parametrize("where", ["default", "1", "2", "dask"])
def test_results_and_errors_are_the_same_everywhere(where: str, seed: int) -> None:
    # The seed is the test's own, so the expected values are computed here, in this process.
    seeds = [seed + k for k in range(20)]
    with _opened(where) as executor:
        assert list(executor.map(_mean, seeds)) == [_mean(s) for s in seeds]
        with pytest.raises(ParameterError, match=r"alpha = -1 is not allowed") as caught:
            executor.submit(_fail, -1).result()
        assert caught.value.fields["name"] == "alpha"
        assert executor.submit(math.sqrt, 4.0).result() == 2.0  # a failed task does not spoil the next


def test_processes_are_others_and_one_worker_is_this_one() -> None:
    with open_executor(2) as executor:
        assert executor.submit(os.getpid).result() != os.getpid()
    with open_executor(1) as executor:
        assert executor.submit(os.getpid).result() == os.getpid()


def _signals() -> tuple[bool, bool]:
    blocked = signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ())
    return blocked, signal.getsignal(signal.SIGINT) is signal.SIG_IGN


@pytest.mark.skipif(sys.platform == "win32", reason="needs signal masks")
def test_no_interrupt_meets_a_worker_even_while_it_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    masks: list[bool] = []
    spawned = ProcessPoolExecutor._spawn_process

    def spawn(executor: ProcessPoolExecutor) -> None:
        masks.append(_signals()[0])
        spawned(executor)

    monkeypatch.setattr(ProcessPoolExecutor, "_spawn_process", spawn)
    with open_executor(2) as executor:
        assert executor.submit(_signals).result() == (False, True)
        assert masks == [True]
        assert not _signals()[0]


def test_an_error_in_the_block_leaves_it_and_closes_the_executor() -> None:
    with pytest.raises(ZeroDivisionError), open_executor(2) as executor:  # noqa: PT012
        executor.submit(abs, -1).result()
        raise ZeroDivisionError
    with pytest.raises(RuntimeError, match="after shutdown"):
        executor.submit(abs, -1)


def test_serial_executor_is_an_executor() -> None:
    with SerialExecutor() as executor:
        future = executor.submit(_fail, 2.0)
        assert future.done()
        assert isinstance(future.exception(), ParameterError)
        seen: list[int] = []
        results = executor.map(lambda k: seen.append(k) or k, range(3))
        assert next(results) == 0
        assert seen == [0]  # one at a time, so that progress can be shown
    with pytest.raises(RuntimeError, match="after shutdown"):
        executor.map(abs, [-1])
    with pytest.raises(RuntimeError, match="after shutdown"):
        executor.submit(abs, -1)


@pytest.mark.parametrize("workers", [0, -1, 1.5, True])
def test_a_wrong_number_of_workers_is_named(workers: int) -> None:
    with pytest.raises(ParameterError, match="workers = "), open_executor(workers):
        pass


def test_workers_and_scheduler_exclude_each_other() -> None:
    with pytest.raises(ParameterError, match="workers = 2"), open_executor(2, "tcp://127.0.0.1:1"):
        pass


def test_a_scheduler_without_dask_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"radiokit\[cluster\]"), open_executor(None, "tcp://x:1"):
        pass


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense"])
def test_a_scheduler_that_does_not_answer_is_named(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed", reason="needs radiokit[cluster]")
    monkeypatch.setattr(workers_module, "CONNECT_TIMEOUT", 0.5)
    message = f"no Dask scheduler answers at '{address}'"
    with pytest.raises(RadiokitError, match=message), open_executor(scheduler=address):
        pass


def test_available_workers_is_what_this_process_may_use() -> None:
    assert 1 <= available_workers() <= (os.cpu_count() or 1)
