"""Camera: a pinhole, with one ray through the middle of each pixel."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from radiokit.contracts.vectors import Triple, as_point
from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError

__all__ = ["Camera"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A pinhole camera. A pixel's value is the radiance along one ray, not a mean over the pixel.

    Parameters
    ----------
    position : tuple of 3 floats
        The pinhole [m].
    target : tuple of 3 floats
        What is in the middle of the picture [m].
    up : tuple of 3 floats
        What is up in the picture, as far as the view allows.
    field : float
        Angle [rad] between the top and the bottom edge, in (0, π).
    width, height : int
        Pixels, at least 1. Pixels are square; row 0 is the top one.

    Raises
    ------
    ParameterError
        When an argument is not allowed, or the camera looks along ``up``.

    >>> camera = Camera(position=(0, -4, 0), target=(0, 0, 0), field=1.0, width=3, height=3)
    >>> camera.rays[1, 1].tolist()
    [0.0, 1.0, 0.0]
    """

    position: Triple
    target: Triple = (0.0, 0.0, 0.0)
    up: Triple = (0.0, 0.0, 1.0)
    field: float = 0.6
    width: int = 64
    height: int = 64

    def __post_init__(self) -> None:
        for name in ("position", "target", "up"):
            object.__setattr__(self, name, as_point(name, getattr(self, name)))
        for name in ("width", "height"):
            count = getattr(self, name)
            if type(count) is not int or count < 1:
                raise ParameterError(name, count, "an integer, at least 1")
        if not 0 < self.field < math.pi:
            raise ParameterError("field", self.field, "an angle in (0, π) radians")
        ahead = np.subtract(self.target, self.position)
        if not np.linalg.norm(np.cross(ahead, self.up)) > 1e-9 * np.linalg.norm(ahead) * np.linalg.norm(
            self.up
        ):
            raise ParameterError("up", self.up, "off the line from position to target")

    @cached_property
    def rays(self) -> FloatArray:
        """The unit vectors (height, width, 3) from the pinhole through the pixels' middles."""
        ahead = unit(np.subtract(self.target, self.position))
        right = unit(np.cross(ahead, self.up))
        above = np.cross(right, ahead)
        scale = 2.0 * math.tan(self.field / 2) / self.height
        # Doubled, so that a pixel and its mirror image have exactly opposite coordinates.
        x = 0.5 * scale * (2 * np.arange(self.width) + 1 - self.width)
        y = 0.5 * scale * (self.height - 1 - 2 * np.arange(self.height))
        return unit(ahead + x[None, :, None] * right + y[:, None, None] * above)
