"""What all tests share: seeds that derive from the test's id, and how tests are dealt out to processes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.grading.finding import Callee, Mode
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.plots.offscreen import offscreen
from radiokit.facts.errors import RadiokitError

LONGEST = frozenset(
    {"test_validate.py", "test_otter.py", "test_nbgrader.py", "test_bench.py", "test_lectures.py"}
)
"""Files with a test, or a fixture of many, that takes 5 seconds or more."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Let a process that has nothing left to do take over half of another's tests.

    Unless told otherwise ``pytest -n`` deals tests out in advance, and ends with one process working alone
    for as long as its last tests take.
    """
    if config.getvalue("dist") != "load":
        return None
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with what takes longest, so that no process is left alone with it at the end.

    Tests are taken over from the end of what a process was dealt: those that come first stay together, and
    what their modules share is computed once.
    """
    items.sort(key=lambda item: item.path.name not in LONGEST)


@pytest.fixture
def seed(request: pytest.FixtureRequest) -> int:
    """A seed of the test's own, the same in every run and on every machine."""
    return int.from_bytes(hashlib.sha256(request.node.nodeid.encode()).digest()[:8], "big")


@pytest.fixture
def rng(seed: int) -> np.random.Generator:
    """A generator seeded by the test's id."""
    return np.random.default_rng(seed)


@pytest.fixture(scope="session")
def missing_opengl() -> str:
    """Why nothing can be drawn in three dimensions here; empty where it can."""
    try:
        with offscreen():
            return ""
    except RadiokitError as error:
        return str(error)


@dataclass(frozen=True)
class LocalCallee:
    """A student's function in this process: called as a sandbox calls, and hundreds of times as fast."""

    function: Callable[..., Any]
    others: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    seconds: float = 1e-6

    @property
    def name(self) -> str:
        return self.function.__name__

    def call(self, *arrays: Any, mode: Mode = "batch", outputs: int = 1, seed: int | None = None) -> Result:
        given = [np.array(array) for array in arrays]
        try:
            if mode == "batch":
                values = [self.function(*(each if each.ndim else each.item() for each in given))]
                if outputs > 1:
                    (values,) = values
                return Result(values=tuple(map(np.asarray, values)), seconds=self.seconds)
            count = max(len(each) for each in given if each.ndim)

            def row(array: Any, i: int) -> Any:
                if array.ndim == 0:
                    return array.item()
                if mode == "single":
                    return array[i : i + 1]
                return array[i].item() if mode == "scalar" and array.ndim == 1 else array[i]

            rows = [self.function(*(row(array, i) for array in given)) for i in range(count)]
            return Result(values=(np.array(rows),), seconds=self.seconds)
        except Exception as error:
            return Result(error=f"raised {type(error).__name__}: {error}", raised=type(error).__name__)

    def bsdf(self, parameters: Mapping[str, Any] | None = None) -> BSDF:
        return as_bsdf(self.function)

    def other(self, name: str) -> Callee:
        def absent(*_: Any) -> Any:
            raise NameError(f"defines no function {name!r}")

        return LocalCallee(self.others.get(name, absent), self.others, self.seconds)


@pytest.fixture(scope="session")
def local_callee() -> type[LocalCallee]:
    """What hands a function of a test's own to a judge, without a sandbox."""
    return LocalCallee
