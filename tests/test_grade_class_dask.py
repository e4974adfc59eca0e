"""A class graded by a real cluster: a worker that is killed loses nothing and doubles nothing."""

from __future__ import annotations

import json
import logging
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest
from classroom import KEYS, NAMES, hand_in, holding, left_of, made, wait_until

from radiokit.faces.grading.classroom.run import grade_class

pytest.importorskip("distributed", reason="needs radiokit[cluster]")
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")


class Cluster:
    """A scheduler and two workers, each a process with a log."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.processes = folder, ExitStack()
        self.file, self.temporary = folder / "scheduler.json", folder / "tmp"
        self.hold = folder / "hold"
        self.temporary.mkdir()

    def start(self, name: str, *words: str) -> subprocess.Popen[bytes]:
        """Start one of them."""
        common = ["--scheduler-file", str(self.file), "--no-dashboard"]
        with (self.folder / f"{name}.log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.{words[0]}", *common, *words[1:]],
                stdout=log,
                stderr=log,
                cwd=self.folder,
                env={**os.environ, "TMPDIR": str(self.temporary), "HOLD": str(self.hold)},
                start_new_session=True,
            )
        self.processes.callback(self.stop, process)
        return process

    def is_announced(self) -> bool:
        """Return whether the scheduler's file is there and whole: workers that find a half end."""
        with suppress(OSError, ValueError):
            return bool(json.loads(self.file.read_text()))
        return False

    def stop(self, process: subprocess.Popen[bytes]) -> None:
        """End one, and see that nothing of it is left."""
        process.terminate()
        try:
            process.wait(60)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        wait_until(lambda: not left_of(process.pid, self.temporary))

    def logs(self) -> str:
        """Return what all of them said."""
        return "\n".join(path.read_text() for path in sorted(self.folder.glob("*.log")))


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    folder = tmp_path / "cluster"
    folder.mkdir()
    found = Cluster(folder)
    with found.processes:
        found.start("scheduler", "dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        wait_until(found.is_announced)
        yield found


def test_a_killed_worker_loses_nothing_and_doubles_nothing(
    cluster: Cluster,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.DEBUG)
    single = ("--nthreads", "1", "--no-nanny", "--host", "127.0.0.1")
    workers = [cluster.start(name, "dask_worker", *single) for name in ("first", "second")]
    wait_until(lambda: cluster.logs().count("Registered to:") == 2)
    assignment = hand_in(tmp_path / "class")
    address = cluster.logs().partition("Scheduler at:")[2].split()[0]
    counts: list[int] = []
    killed: list[int] = []
    release = ExitStack()
    hold = release.enter_context(holding(cluster.hold))

    def progress(done: int, count: int) -> None:
        assert count == len(KEYS)
        counts.append(done)
        if done == 3:
            wait_until(lambda: any(hold.iterdir()))
            killed.extend(int(path.name) for path in hold.iterdir())
            os.kill(killed[0], signal.SIGKILL)
            release.close()

    found = grade_class(
        tmp_path / "class", assignment, tmp_path / "cluster-out", scheduler=address, progress=progress
    )
    assert counts == list(range(1, len(KEYS) + 1))
    assert (list(found), found.graded, found.exit_code) == (KEYS, len(KEYS) - 1, 0)
    (first, second) = sorted(workers, key=lambda worker: worker.pid != killed[0])
    assert first.wait(60) == -signal.SIGKILL
    assert second.poll() is None
    grade_class(tmp_path / "class", assignment, tmp_path / "local-out", workers=1)
    assert made(tmp_path / "cluster-out") == made(tmp_path / "local-out")

    cluster.processes.close()
    said = "".join([cluster.logs(), *capfd.readouterr(), caplog.text])
    assert "Registered to:" in said  # the logs are those that are meant
    assert not [name for name in NAMES if name in said]
