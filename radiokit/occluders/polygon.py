"""Polygon: a flat screen with straight edges, convex or not: a wall, a roof, a blade."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.occluder import Occluder
from radiokit.facts.errors import ParameterError
from radiokit.measure.outline import check_outline, triangulate
from radiokit.physics.facets import Facets, lies_on

__all__ = ["Polygon"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Polygon(Occluder):
    """A simple, flat, opaque polygon; seen edge-on it hides nothing.

    Parameters
    ----------
    vertices : array_like, shape (N, 3)
        Its corners [m], at least 3, in either sense of turning.

    Raises
    ------
    ParameterError
        Naming the vertex that is not finite, equals its neighbour, is off the plane by more than 1e-9 of the
        size, or starts an edge that meets another; from the methods, when the receiver is on the polygon.

    >>> wall = Polygon(vertices=[(1, -1, 0), (1, 1, 0), (1, 1, 2), (1, -1, 2)])
    >>> wall.blocks(np.array([[0.8, 0.0, 0.6], [0.0, 0.0, 1.0]]), np.zeros(3), [5.0, 5.0]).tolist()
    [True, False]
    """

    name: ClassVar[str] = "polygon"

    vertices: Any = field()

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "vertices", check_outline("vertices", self.vertices))

    @cached_property
    def _corners(self) -> FloatArray:
        return np.array(self.vertices)

    @cached_property
    def _triangles(self) -> FloatArray:
        return self._corners[triangulate(self._corners)]

    def shape(self, position: FloatArray) -> Facets | None:
        """Return the polygon, from the side that is seen."""
        if lies_on(self._corners, self._triangles, position):
            place = tuple(map(float, position))
            raise ParameterError("position", place, "off the polygon, on which it lies")
        return Facets.seen(self._corners, position, two_sided=True)
