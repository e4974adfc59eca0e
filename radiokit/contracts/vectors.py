"""Vectors: how a model declares a point or a direction in the world, and how they are checked."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError

__all__ = ["Triple", "VectorParameter", "as_point", "as_unit", "check_vectors", "vector"]

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class VectorParameter:
    """What a model says of one vector: whether its length counts, its unit and its meaning."""

    kind: Literal["point", "direction"]
    unit: str
    meaning: str


def vector(kind: Literal["point", "direction"], unit: str, meaning: str, **field: Any) -> Any:
    """Declare a dataclass field that is a point, or a direction, which is normalised.

    ``default=None`` makes it optional: then ``None`` is allowed too.
    """
    return dataclasses.field(metadata={"vector": VectorParameter(kind, unit, meaning)}, **field)


def as_point(name: str, value: Any) -> Triple:
    """Return three finite numbers as a tuple of floats.

    Raises
    ------
    ParameterError
        When ``value`` is anything else.

    >>> as_point("position", [0, 0, 4])
    (0.0, 0.0, 4.0)
    """
    allowed = "three finite numbers"
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise ParameterError(name, value, allowed) from None
    if array.shape != (3,) or array.dtype.kind not in "fiu" or not np.all(np.isfinite(array)):
        raise ParameterError(name, value, allowed)
    x, y, z = array.astype(float).tolist()
    return (x, y, z)


def as_unit(name: str, value: Any) -> Triple:
    """Return a vector of any length as a unit vector; a unit vector is returned as it is.

    Raises
    ------
    ParameterError
        When ``value`` is not three finite numbers, or is zero.

    >>> as_unit("normal", (3e300, 0, 4e300))
    (0.6, 0.0, 0.8)
    """
    point = as_point(name, value)
    if not any(point):
        raise ParameterError(name, value, "a nonzero vector")
    if abs(math.hypot(*point) - 1) <= 4e-16:
        return point
    x, y, z = unit(point).tolist()
    return (x, y, z)


def check_vectors(model: Any) -> None:
    """Turn every declared vector of a frozen dataclass into a tuple of floats, which is hashable.

    Raises
    ------
    ParameterError
        Naming the vector, its value and what is allowed.
    """
    for field in dataclasses.fields(model):
        declared = field.metadata.get("vector")
        value = getattr(model, field.name)
        if declared is None or (value is None and field.default is None):
            continue
        convert = as_unit if declared.kind == "direction" else as_point
        object.__setattr__(model, field.name, convert(field.name, value))
