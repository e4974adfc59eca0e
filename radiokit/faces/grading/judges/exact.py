"""Exact: what a reference may be: a function of the inputs, a closed-form case, or the right number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError

if TYPE_CHECKING:
    from radiokit.worlds.cases.catalogue import Case

__all__ = ["Reference", "as_function", "no_inputs"]

Reference: TypeAlias = "Callable[..., Any] | Case | npt.ArrayLike"


@dataclass(frozen=True)
class _Constant:
    """A function that gives one value, whatever it is asked."""

    value: Any

    def __call__(self, **inputs: Any) -> Any:
        return self.value


def as_function(reference: Reference) -> Callable[..., Any]:
    """Return a reference as ``reference(**inputs)``: of a closed-form case it is the exact value.

    Raises
    ------
    ParameterError
        When it is no function, no case, and no finite number or array of them.

    >>> import radiokit as rk
    >>> float(as_function(rk.case("lambert-in-furnace"))())
    0.5
    >>> float(as_function(2)(radius=1.0))
    2.0
    """
    if callable(reference):
        return reference
    try:
        value = np.asarray(getattr(reference, "exact", reference), dtype=float)
    except (TypeError, ValueError):
        value = np.asarray(np.nan)
    if not np.isfinite(value).all():
        raise ParameterError("reference", reference, "a function, a case, or finite numbers")
    return _Constant(value)


def no_inputs(rng: np.random.Generator) -> Mapping[str, Any]:
    """Return the inputs of a question that has none."""
    return {}
