"""What all tests share: seeds that derive from the test's id, and how tests are dealt out to processes."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
import pytest

from radiokit.faces.plots.offscreen import offscreen
from radiokit.facts.errors import RadiokitError


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
