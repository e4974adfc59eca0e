"""Reading: what the caller of a diagnosis gives, checked and made into a problem."""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.problem import Array, Problem, columns
from radiokit.facts.errors import ParameterError

__all__ = ["read"]


def _numbers(name: str, given: Any) -> Array:
    try:
        array: Array = np.atleast_1d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        raise ParameterError(name, given, "real numbers") from None
    if array.ndim != 1 or not array.size:
        raise ParameterError(name, given, f"of shape (N,), not {array.shape}")
    return array


def read(
    answer: Any, reference: Any, inputs: Mapping[str, Any], variants: Any, error: Any, rtol: float | None
) -> Problem:
    """Return the problem, without the answers that are NaN or infinite; arguments as of `diagnose`.

    Raises
    ------
    ParameterError
        When shapes differ, or an argument is out of its range.
    """
    right, given = _numbers("reference", reference), _numbers("answer", answer)
    if rtol is None:
        rtol = 2e-5 if np.asarray(answer).dtype == np.float32 else 1e-6
    if not isinstance(rtol, Real) or not 0 < rtol <= 0.1:
        raise ParameterError("rtol", rtol, "in (0, 0.1]")
    if not np.all(np.isfinite(right)):
        raise ParameterError("reference", reference, "finite")
    if given.shape != right.shape:
        raise ParameterError("answer", answer, f"of the reference's shape {right.shape}, not {given.shape}")
    try:
        spread = np.broadcast_to(np.asarray(0.0 if error is None else error, dtype=float), right.shape)
    except (TypeError, ValueError):
        raise ParameterError("error", error, f"numbers that broadcast to {right.shape}") from None
    finite = np.isfinite(given)
    if not np.all(spread[finite] >= 0) or not np.all(np.isfinite(spread[finite])):
        raise ParameterError("error", error, "finite and at least 0")
    rows = {name: values[finite] for name, values in columns(inputs, right.size).items()}
    if isinstance(variants, Mapping):
        variants = {name: values[finite] for name, values in _variant_columns(variants, right.size).items()}
    index, lost = np.flatnonzero(finite), np.flatnonzero(~finite)
    return Problem(given[finite], right[finite], rows, variants, spread[finite], rtol, index, lost)


def _variant_columns(variants: Mapping[str, Any], count: int) -> dict[str, Array]:
    found = {name: _numbers(f"variants[{name!r}]", values) for name, values in variants.items()}
    for name, values in found.items():
        if values.shape != (count,):
            raise ParameterError(f"variants[{name!r}]", variants[name], f"of shape ({count},)")
    return found
