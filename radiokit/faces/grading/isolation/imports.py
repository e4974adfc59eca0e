"""Imports: what a submission finds when it imports: not its judge, and random numbers that are repeated.

It is run by the child, and imports the standard library alone.
"""

from __future__ import annotations

import importlib.machinery
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any

__all__ = ["Finder"]

HIDDEN = "radiokit"
"""A submission stands alone: the package that judges it is not there for it."""
SEEDED = ("random", "numpy.random")


class Finder:
    """Stands before all that finds modules, and seeds those generators that belong to nobody.

    >>> Finder().find_spec("radiokit.bsdfs")
    Traceback (most recent call last):
        ...
    ModuleNotFoundError: radiokit is not there for a submission, which must stand alone
    """

    def __init__(self) -> None:
        self._seed = 0

    def seed(self, seed: int) -> None:
        """Seed what is imported, now, and what is not, as soon as it is."""
        self._seed = seed
        for name in SEEDED:
            if name in sys.modules:
                self.seeded(sys.modules[name])

    def seeded(self, module: ModuleType) -> None:
        """Set the state of a module's generator."""
        module.seed(self._seed if module.__name__ == "random" else self._seed % (1 << 32))

    def find_spec(self, name: str, path: Sequence[str] | None = None, target: Any = None) -> Any:
        """Find a module that is to be seeded; leave others to others."""
        if name.split(".")[0] == HIDDEN:
            raise ModuleNotFoundError(f"{HIDDEN} is not there for a submission, which must stand alone")
        spec = importlib.machinery.PathFinder.find_spec(name, path, target) if name in SEEDED else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def seeding(module: ModuleType) -> None:
            execute(module)
            self.seeded(module)

        spec.loader.exec_module = seeding  # type: ignore[method-assign]
        return spec
