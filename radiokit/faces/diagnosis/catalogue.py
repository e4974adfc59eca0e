"""Catalogue: every misconception that is known here, one entry each."""

from __future__ import annotations

from radiokit.faces.diagnosis import constants, factors, structures, transforms
from radiokit.faces.diagnosis.misconception import Misconception

__all__ = ["CATALOGUE", "list_misconceptions"]

CATALOGUE: tuple[Misconception, ...] = (
    *constants.ENTRIES,
    *factors.ENTRIES,
    *transforms.ENTRIES,
    *structures.ENTRIES,
)
"""The known misconceptions. `diagnose` takes longer ones: ``catalogue=(*CATALOGUE, mine)``."""


def list_misconceptions() -> list[str]:
    """Return the names of the known misconceptions.

    >>> list_misconceptions()[:2]
    ['pi-too-many', 'pi-too-few']
    """
    return [entry.name for entry in CATALOGUE]
