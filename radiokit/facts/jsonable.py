"""Turning values into JSON: NumPy numbers and arrays become plain ones, NaN and infinities become text."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["jsonable"]


def jsonable(value: Any) -> Any:
    """Return ``value`` as data that ``json.dumps(..., allow_nan=False)`` accepts.

    >>> jsonable({"x": np.float64(1.5), "y": np.array([1.0, np.inf])})
    {'x': 1.5, 'y': [1.0, 'inf']}
    """
    if hasattr(value, "to_json"):
        return value.to_json()
    if isinstance(value, Mapping):
        return {str(key): jsonable(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return jsonable(value.tolist())
    if isinstance(value, (list, tuple)):
        return [jsonable(item) for item in value]
    if isinstance(value, np.generic):
        return jsonable(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, complex):
        return str(value)
    if value is None or isinstance(value, (bool, int, float)):
        return value
    return str(value)
