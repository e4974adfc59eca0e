"""Rectangle light: a luminaire, a window or a screen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.flat import FlatEmitter
from radiokit.contracts.parameters import parameter
from radiokit.contracts.vectors import vector
from radiokit.facts.directions import frame, unit
from radiokit.facts.errors import ParameterError
from radiokit.measure.outline import check_outline

__all__ = ["Rectangle"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Rectangle(FlatEmitter):
    """A rectangle of constant radiance that shines to the side of its normal.

    Parameters
    ----------
    center : tuple of 3 floats
        Its middle [m].
    normal : tuple of 3 floats
        To where it shines; any length but 0, stored as a unit vector.
    width, height : float
        Its sides [m], in [1e-100, 1e100].
    up : tuple of 3 floats, optional
        Along its height, as far as that is possible; any length but 0. Without it, the first axis of
        ``frame(normal)`` is along its width.
    radiance : float, or sequence of K floats
        L [W m⁻² sr⁻¹], in [0, 1e100]; one number, or one a wavelength.
    sampling : {"solid angle", "area"}
        Over what its directions are sampled evenly.

    Raises
    ------
    ParameterError
        When ``up`` is along the normal, the sides are too small for their distance from the origin, or
        another parameter is out of its range.

    >>> panel = Rectangle(center=(0, 0, 1), normal=(0, 0, -1), width=2.0, height=2.0, radiance=10.0)
    >>> round(float(panel.solid_angle(np.zeros(3)).value) / np.pi, 14), bool(panel.flux().value == 40 * np.pi)
    (0.66666666666667, True)
    """

    name: ClassVar[str] = "rectangle"

    center: tuple[float, float, float] = vector("point", "m", "its middle")
    normal: tuple[float, float, float] = vector("direction", "1", "to where it shines")
    width: float = parameter("[1e-100, 1e100]", "m", "side across up")
    height: float = parameter("[1e-100, 1e100]", "m", "side along up")
    up: tuple[float, float, float] | None = vector("direction", "1", "along its height", default=None)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.up is not None and not np.sum(np.cross(self.normal, self.up) ** 2) > 1e-24:
            raise ParameterError("up", self.up, f"no vector along the normal {self.normal}")
        sides = f"larger than the spacing of floats at {self.center}, and within 1e13 of the other side"
        if min(self.width, self.height) <= np.spacing(np.abs(self.center).max()):
            raise ParameterError("width, height", (self.width, self.height), sides)
        try:
            check_outline("corners", self.offsets)
        except ParameterError:
            raise ParameterError("width, height", (self.width, self.height), sides) from None

    @cached_property
    def corners(self) -> FloatArray:
        """The corners (4, 3) [m], counter-clockwise from the lower left as seen from the front."""
        corners: FloatArray = self.anchor + self.offsets
        return corners

    @property
    def anchor(self) -> FloatArray:
        """The middle (3,) [m]."""
        return np.array(self.center)

    @cached_property
    def offsets(self) -> FloatArray:
        """The corners (4, 3) [m] as seen from the middle."""
        axes = frame(self.normal)
        right, up = axes[0], axes[1]
        if self.up is not None:
            right = unit(np.cross(self.up, self.normal))
            up = np.cross(self.normal, right)
        across, along = 0.5 * self.width * right, 0.5 * self.height * up
        return np.array([-across - along, across - along, across + along, along - across])

    @property
    def blur(self) -> float:
        """How far rounding may put the corners [m]."""
        return 8 * float(np.finfo(float).eps) * math.hypot(self.width, self.height)

    @property
    def area(self) -> float:
        """The area [m²]."""
        return self.width * self.height
