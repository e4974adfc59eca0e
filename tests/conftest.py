"""Fixtures that every test may use: seeds that derive from the test's id."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest

from radiokit.faces.plots.offscreen import offscreen
from radiokit.facts.errors import RadiokitError


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
