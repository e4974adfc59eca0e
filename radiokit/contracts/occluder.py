"""The occluder contract: what an opaque body must say of itself to stand between a light and a receiver."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.parameters import check_parameters
from radiokit.contracts.registry import Registry
from radiokit.contracts.vectors import check_vectors
from radiokit.facts.errors import ParameterError
from radiokit.physics.eclipse import TIE, Body

__all__ = ["REGISTRY", "Occluder", "check_occluders", "list_occluders", "occluder"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


class Occluder(ABC):
    """An opaque body in world coordinates, which hides what is behind it from both of its sides.

    Subclasses are frozen, keyword-only dataclasses, one a file. Each says what a point sees of it, as a
    ``Ball``, a ``Plate`` or ``Facets`` of ``radiokit.physics``; all else follows from that.
    """

    name: ClassVar[str] = ""

    def __post_init__(self) -> None:
        check_parameters(self)
        check_vectors(self)

    @abstractmethod
    def shape(self, position: FloatArray) -> Body | None:
        """Return what ``position`` (3,) [m] sees of the body, or None where it hides nothing: edge-on.

        Raises
        ------
        ParameterError
            When ``position`` is on the body.
        """

    def blocks(self, direction: FloatArray, position: FloatArray, reach: npt.ArrayLike) -> BoolArray:
        """Return whether (N,) the body is met nearer than ``reach`` (N,) [m] along directions (N, 3).

        Whether a ray meets the body at all, its edge included, is decided without rounding. What is as far
        as ``reach``, within 2⁻⁴⁰ of it, is not nearer: what touches a light, or is its own surface, hides
        nothing there. A ray in the plane of a flat body does not meet it.

        Raises
        ------
        ParameterError
            When ``position`` is on the body.
        """
        body = self.shape(np.asarray(position, dtype=float))
        return np.zeros(len(direction), dtype=bool) if body is None else blocked(body, direction, reach)


def blocked(body: Body, direction: FloatArray, reach: npt.ArrayLike) -> BoolArray:
    """Return whether (N,) a body is met nearer than ``reach`` along directions (N, 3)."""
    near = body.distance(direction) < np.asarray(reach) * (1.0 - float(TIE))
    found = np.zeros(len(direction), dtype=bool)
    found[near] = body.contains(direction[near])
    return found


def check_occluders(value: Any) -> tuple[Occluder, ...]:
    """Return one occluder, or several, as a tuple.

    Raises
    ------
    ParameterError
        When something else is among them.
    """
    allowed = "an occluder, such as occluder('sphere', ...), or several of them"
    if isinstance(value, Occluder):
        return (value,)
    if not isinstance(value, Iterable) or isinstance(value, str | bytes):
        raise ParameterError("occluders", value, allowed)
    found = tuple(value)
    for k, item in enumerate(found):
        if not isinstance(item, Occluder):
            raise ParameterError(f"occluders[{k}]", item, allowed)
    return found


REGISTRY: Registry[Occluder] = Registry("occluder", "radiokit.occluders", Occluder, "radiokit.occluders")


def list_occluders() -> list[str]:
    """Return the names of all occluders, third-party ones included.

    >>> list_occluders()[:3]
    ['disk', 'polygon', 'sphere']
    """
    return REGISTRY.names()


def occluder(name: str, **parameters: Any) -> Occluder:
    """Return the occluder called ``name``.

    Parameters
    ----------
    name : str
        One of ``list_occluders()``.
    **parameters
        Those of its class, such as ``radius=1.0``; the help of its class gives their ranges and units.

    Raises
    ------
    UnknownNameError
        When there is no such occluder.
    RadiokitError
        When a parameter is unknown, missing, or out of its range.

    >>> moon = occluder("sphere", center=(0, 0, 1), radius=0.25)
    >>> moon.blocks(np.array([[0.0, 0.0, 1.0]]), np.zeros(3), [2.0]).tolist()
    [True]
    """
    return REGISTRY.make(name, parameters)
