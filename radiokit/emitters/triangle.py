"""Triangle light: the piece of which meshes that shine are made."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.flat import FlatEmitter
from radiokit.facts.errors import ParameterError
from radiokit.measure.outline import check_outline

__all__ = ["Triangle"]


@dataclass(frozen=True, kw_only=True)
class Triangle(FlatEmitter):
    """A triangle of constant radiance that shines from one side.

    Parameters
    ----------
    vertices : array_like, shape (3, 3)
        Its corners [m], counter-clockwise as seen from the side that shines.
    radiance : float, or sequence of K floats
        L [W m⁻² sr⁻¹], in [0, 1e100]; one number, or one a wavelength.
    sampling : {"solid angle", "area"}
        Over what its directions are sampled evenly.

    Raises
    ------
    ParameterError
        When the vertices are not three finite points around an area, or ``radiance`` is out of its range.

    >>> octant = Triangle(vertices=[(1, 0, 0), (0, 0, 1), (0, 1, 0)])  # it shines on the origin
    >>> round(float(octant.solid_angle(np.zeros(3)).value) / np.pi, 14)
    0.5
    """

    name: ClassVar[str] = "triangle"

    vertices: Any = field()

    def __post_init__(self) -> None:
        super().__post_init__()
        corners = check_outline("vertices", self.vertices)
        if len(corners) != 3:
            raise ParameterError("vertices", self.vertices, "three points; 'polygon' takes more")
        object.__setattr__(self, "vertices", corners)

    @cached_property
    def corners(self) -> npt.NDArray[np.float64]:
        """The vertices (3, 3) [m]."""
        return np.array(self.vertices)
