"""Polygon light: flat, with any number of straight edges, convex or not. Use it for windows and signs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.flat import FlatEmitter
from radiokit.measure.outline import check_outline

__all__ = ["Polygon"]


@dataclass(frozen=True, kw_only=True)
class Polygon(FlatEmitter):
    """A simple, flat polygon of constant radiance that shines from one side.

    Parameters
    ----------
    vertices : array_like, shape (N, 3)
        Its corners [m], at least 3, counter-clockwise as seen from the side that shines.
    radiance : float, or sequence of K floats
        L [W m⁻² sr⁻¹], in [0, 1e100]; one number, or one a wavelength.
    sampling : {"solid angle", "area"}
        Over what its directions are sampled evenly.

    Raises
    ------
    ParameterError
        Naming the vertex that is not finite, equals its neighbour, is off the plane by more than 1e-9 of the
        size, or starts an edge that meets another; or when ``radiance`` is out of its range.

    >>> ell = [(0, 0, 1), (0, 2, 1), (1, 2, 1), (1, 1, 1), (2, 1, 1), (2, 0, 1)]  # it shines down
    >>> light = Polygon(vertices=ell, radiance=2.0)
    >>> light.area, round(light.flux().value / np.pi, 12)
    (3.0, 6.0)
    >>> round(float(light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value), 12)
    1.232876654799
    """

    name: ClassVar[str] = "polygon"

    vertices: Any = field()

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "vertices", check_outline("vertices", self.vertices))

    @cached_property
    def corners(self) -> npt.NDArray[np.float64]:
        """The vertices (N, 3) [m]."""
        return np.array(self.vertices)
