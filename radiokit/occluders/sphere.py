"""Sphere: an opaque ball, such as the moon before the sun."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.occluder import Occluder
from radiokit.contracts.parameters import parameter
from radiokit.contracts.vectors import vector
from radiokit.facts.errors import ParameterError
from radiokit.measure.exact import root
from radiokit.physics.ball import Ball

__all__ = ["Sphere"]

_TOUCH = 4 * float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Sphere(Occluder):
    """An opaque hollow sphere: from inside it hides whatever is outside.

    Parameters
    ----------
    center : tuple of 3 floats
        [m].
    radius : float
        [m], above 0.

    Raises
    ------
    ParameterError
        When ``center`` is not three finite numbers, or ``radius`` is out of its range; from the methods, when
        the receiver is on the sphere, within the rounding of their coordinates.

    >>> moon = Sphere(center=(0, 0, 2), radius=1)
    >>> moon.blocks(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.zeros(3), np.inf).tolist()
    [True, False]
    """

    name: ClassVar[str] = "sphere"

    center: tuple[float, float, float] = vector("point", "m", "the sphere's centre")
    radius: float = parameter("(0, inf)", "m", "the sphere's radius")

    def shape(self, position: npt.NDArray[np.float64]) -> Ball:
        """Return the ball."""
        ball = Ball.seen(self.center, self.radius, position)
        size = max(*map(abs, self.center), float(np.abs(position).max()), self.radius)
        # (d − R) of the receiver, by d² − R² over d + R
        if abs(float(ball.tangent / Fraction(size))) <= _TOUCH * (root(ball.square) + self.radius):
            allowed = f"off the sphere of radius {self.radius!r} around {self.center}"
            raise ParameterError("position", tuple(map(float, position)), allowed)
        return ball
