"""Given: what an assignment's own functions give, checked: a mistake there is never a student's."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Mapping
from pathlib import PurePath
from typing import Any

import numpy as np

from radiokit.faces.grading.isolation.protocol import Array
from radiokit.facts.errors import AssignmentError, ParameterError, RadiokitError

__all__ = [
    "NUMBERS",
    "called",
    "check_functions",
    "check_shares",
    "drawn",
    "is_within",
    "line_of",
    "number",
    "numbers",
    "own",
    "shown",
    "truth",
]

NUMBERS = "fiub"
"""The kinds of arrays that are real numbers."""


def own(what: str, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Any:
    """Return what an assignment's own function gives.

    Raises
    ------
    AssignmentError
        When it raises; ``what`` says what it is.

    >>> own("reference", lambda x: 1 / x, x=0)
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.AssignmentError: reference raised ZeroDivisionError: division by zero
    """
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # what is printed is the grade alone
            return function(*arguments, **named)
    except Exception as error:
        said = str(error) if isinstance(error, RadiokitError) else f"{type(error).__name__}: {error}"
        raise AssignmentError(f"{what} raised {said}{line_of(error)}") from error


def line_of(error: BaseException) -> str:
    """Return where in an assignment's file an error came from, as ``" (light.py, line 3)"``, if anywhere."""
    trace, found = error.__traceback__, ""
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if file.endswith(".py") and not PurePath(file).is_absolute():  # as it is compiled: by its bare name
            found = f" ({file}, line {trace.tb_lineno})"
        trace = trace.tb_next
    return found


def drawn(inputs: Callable[..., Any], rng: np.random.Generator, *, rows: bool = True) -> dict[str, Array]:
    """Return inputs by name, as arrays; with ``rows``, those that are no numbers are equally long.

    Raises
    ------
    AssignmentError
        When they are not, or are no numbers.

    >>> drawn(lambda rng: {"x": rng.random(3), "y": rng.random(2)}, np.random.default_rng(0))
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.AssignmentError: inputs are of unequal length: x 3, y 2
    """
    found = own("inputs", inputs, rng)
    if not isinstance(found, Mapping):
        kind = type(found).__name__
        raise AssignmentError(f'inputs gives a {kind}: it must give the inputs by name, as in {{"x": array}}')
    given = {name: own(f"inputs: {name}", np.asarray, value) for name, value in found.items()}
    for name, array in given.items():
        if not isinstance(name, str) or array.dtype.kind not in f"{NUMBERS}c":
            raise AssignmentError(f"inputs: {name} = {shown(array)} is not allowed: it must be numbers")
        if not array.size:
            raise AssignmentError(f"inputs: {name} is empty: it must have at least one number")
    lengths = {name: len(array) for name, array in given.items() if array.ndim}
    if rows and len(set(lengths.values())) > 1:
        told = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise AssignmentError(f"inputs are of unequal length: {told}")
    return given


def truth(reference: Callable[..., Any], given: Mapping[str, Array], what: str = "reference") -> Array:
    """Return what a reference gives: a finite number, or a row of them, for each of the inputs.

    Raises
    ------
    AssignmentError
        When it gives anything else, or raises.

    >>> truth(lambda x: x[1:], {"x": np.ones(3)})
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.AssignmentError: reference gives an array of shape (2,) for 3 inputs: it must ...
    """
    right = np.atleast_1d(numbers(own(what, reference, **given), what))
    count = next((len(array) for array in given.values() if array.ndim), len(right))
    if len(right) != count:
        told = f"an array of shape {right.shape}" if np.size(right) > 1 else shown(right[0])
        raise AssignmentError(
            f"{what} gives {told} for {count} inputs: it must give a number or a row of numbers for each"
        )
    bad = ~np.isfinite(right.reshape(count, -1)).all(axis=1)
    if bad.any():
        row = int(np.argmax(bad))
        at = ", ".join(
            f"{name} = {shown(array[row] if array.ndim else array)}" for name, array in given.items()
        )
        raise AssignmentError(
            f"{what} gives {shown(right[row])} at {int(bad.sum())} of {count} inputs, such as {at}: "
            "it must give finite numbers"
        )
    return right


def number(function: Callable[..., Any], given: Mapping[str, Any], what: str = "reference") -> float:
    """Return the one finite number that a function gives.

    Raises
    ------
    AssignmentError
        When it gives anything else, or raises.

    >>> number(lambda x: x / 2, {"x": 3.0})
    1.5
    """
    found = numbers(own(what, function, **given), what)
    if found.size != 1 or not np.isfinite(found).all():
        raise AssignmentError(f"{what} gives {shown(found)}: it must give one finite number")
    return float(found.reshape(()))


def numbers(found: Any, what: str) -> Array:
    """Return real numbers as an array of float64.

    Raises
    ------
    AssignmentError
        When they are none.
    """
    array = own(what, np.asarray, found)
    if array.dtype.kind not in NUMBERS:
        kind = "complex numbers" if array.dtype.kind == "c" else shown(found)
        raise AssignmentError(f"{what} gives {kind}: it must give real numbers")
    result: Array = array.astype(float)
    return result


def shown(value: Any) -> str:
    """Return a value in a few letters.

    >>> shown(np.float64(0.5)), shown(np.arange(9.0)), shown(None)
    ('0.5', 'an array of shape (9,)', 'None')
    """
    if isinstance(value, np.ndarray) and value.ndim and value.size > 3:
        return f"an array of shape {value.shape}"
    text = np.array2string(value, precision=6) if isinstance(value, np.ndarray) else repr(value)
    if isinstance(value, float | np.floating) or (isinstance(value, np.ndarray) and not value.ndim):
        text = f"{value:.6g}"
    text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:59]}…"


def is_within(value: Any, least: float, most: float) -> bool:
    """Return whether a value is a number between two others.

    >>> is_within(0.5, 0, 1), is_within("0.5", 0, 1), is_within(float("nan"), 0, 1)
    (True, False, False)
    """
    return isinstance(value, int | float) and least <= value <= most


def check_functions(functions: Mapping[str, Any], variants: Any = None) -> None:
    """Check that what must be called can be, or is None; and that variants are functions by name.

    Raises
    ------
    ParameterError
        When one is none.
    """
    if variants is not None and not isinstance(variants, Mapping):
        raise ParameterError("variants", variants, "functions by the misconception's name")
    named = {f"variants[{name!r}]": variant for name, variant in (variants or {}).items()}
    optional = {"context", "terms", "budget", "uniform", "integrand"}
    for name, function in {**functions, **named}.items():
        if not callable(function) and not (function is None and name in optional):
            raise ParameterError(name, function, "a function")


def check_shares(name: str, shares: Any) -> None:
    """Check shares of points by name.

    Raises
    ------
    ParameterError
        When they are none.
    """
    if not isinstance(shares, Mapping) or not all(is_within(share, 0, 1) for share in shares.values()):
        raise ParameterError(name, shares, "a mapping to shares, numbers in [0, 1]")


def called(
    function: Callable[..., Any], directions: Array, given: Mapping[str, Array], what: str = "density"
) -> Array:
    """Return the finite numbers (N,) that a function of the assignment gives for directions.

    Raises
    ------
    AssignmentError
        When it gives anything else, or raises.
    """
    found = numbers(own(what, function, directions, **given), what)
    if found.shape != (len(directions),) or not np.isfinite(found).all():
        told = f"an array of shape {found.shape}" if found.ndim != 1 else shown(found)
        bad = "" if found.shape != (len(directions),) else ", not all of them finite,"
        raise AssignmentError(
            f"{what} gives {told}{bad} for {len(directions)} directions: it must give finite numbers"
        )
    return found
