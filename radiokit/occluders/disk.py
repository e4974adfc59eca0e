"""Disk: a flat round screen without thickness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.occluder import Occluder
from radiokit.contracts.parameters import parameter
from radiokit.contracts.vectors import Triple, vector
from radiokit.physics.plate import Plate

__all__ = ["Disk"]


@dataclass(frozen=True, kw_only=True)
class Disk(Occluder):
    """An opaque disk; seen edge-on it hides nothing.

    Parameters
    ----------
    center : tuple of 3 floats
        [m].
    normal : tuple of 3 floats
        Across it, to either side; any length but 0, stored as a unit vector.
    radius : float
        [m], above 0.

    Raises
    ------
    ParameterError
        When a vector is not three finite numbers, ``normal`` is zero, or ``radius`` is out of its range; from
        the methods, when the receiver is on the disk.

    >>> screen = Disk(center=(0, 0, 2), normal=(0, 0, 1), radius=1)
    >>> screen.blocks(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]), np.zeros(3), np.inf).tolist()
    [True, False]
    """

    name: ClassVar[str] = "disk"

    center: tuple[float, float, float] = vector("point", "m", "the disk's centre")
    normal: tuple[float, float, float] = vector("direction", "1", "across it, to either side")
    radius: float = parameter("(0, inf)", "m", "the disk's radius")

    def shape(self, position: npt.NDArray[np.float64]) -> Plate | None:
        """Return the disk, from the side that is seen."""
        x, y, z = self.normal
        other: Triple = (-x, -y, -z)
        front = Plate.seen(self.center, self.normal, self.radius, position)
        return front or Plate.seen(self.center, other, self.radius, position)
