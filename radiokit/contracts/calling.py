"""Calling: how a stranger's function wants to be called, and what its answer means."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable, Iterator
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import CallableError

__all__ = ["Mode", "describe", "invoke", "offender", "probe", "quiet"]

FloatArray = npt.NDArray[np.float64]

Mode = Literal["batch", "single", "row"]

# Five pairs in general position: five is neither 3 (a direction) nor a number of channels in use.
_PROBE_WI = spherical_to_cartesian([0.3, 0.7, 1.1, 0.5, 0.9], [0.2, 1.9, 3.3, 4.4, 5.6])
_PROBE_WO = spherical_to_cartesian([0.6, 0.4, 0.8, 1.2, 0.1], [2.5, 0.7, 5.9, 3.8, 1.3])


def probe(function: Callable[..., Any], label: str, notes: list[str]) -> tuple[Mode, float]:
    """Find how the function wants to be called: with arrays, with arrays of one row, or pair by pair."""
    found: dict[Mode, FloatArray] = {}
    failed: dict[Mode, Exception] = {}
    modes: tuple[Mode, ...] = ("batch", "single", "row")
    for mode in modes:
        try:
            found[mode] = invoke(function, label, mode, _PROBE_WI, _PROBE_WO, notes)
        except (Exception, SystemExit) as error:
            failed[mode] = error if isinstance(error, CallableError) else _located(label, error)
    one_by_one = next((mode for mode in ("row", "single") if mode in found), None)
    chosen: Mode
    if "batch" in found:
        chosen = "batch"
        others = [found[mode] for mode in modes[1:] if mode in found]
        if others and not any(_same(found["batch"], other) for other in others):
            again = invoke(function, label, "batch", _PROBE_WI, _PROBE_WO, notes)
            if _same(found["batch"], again):  # else it answers differently each time, which a judge finds
                chosen = one_by_one or "batch"
                notes.append(f"{label} mixes up the rows of an array: it is called pair by pair")
    elif one_by_one is not None:
        chosen = one_by_one
        notes.append(f"{label} cannot take arrays: it is called pair by pair")
    else:
        raise min(failed.values(), key=lambda error: "returned" in str(error))
    raw = _raw(function, chosen, _PROBE_WI, _PROBE_WO)
    precision = float(np.finfo(float).eps)
    dtype = np.asarray(raw).dtype
    if dtype.kind == "f" and dtype.itemsize < 8:
        precision = float(np.finfo(dtype).eps)
        notes.append(f"{label} returns {dtype}: tolerances are widened to its precision")
    return chosen, precision


def _located(label: str, error: BaseException) -> CallableError:
    return CallableError(label, f"raised {describe(error)}", _PROBE_WI[0], _PROBE_WO[0])


def _raw(function: Callable[..., Any], mode: Mode, wi: FloatArray, wo: FloatArray) -> Any:
    if mode == "batch":
        return function(wi.copy(), wo.copy())
    if mode == "row":
        return function(wi[0].copy(), wo[0].copy())
    return function(wi[:1].copy(), wo[:1].copy())


def invoke(
    function: Callable[..., Any],
    label: str,
    mode: Mode,
    wi: FloatArray,
    wo: FloatArray,
    notes: list[str] | None = None,
) -> FloatArray:
    """Call the function for all pairs and return its values as float64 of shape (N,) or (N, K)."""
    if mode == "batch":
        mine, yours = wi.copy(), wo.copy()
        result = function(mine, yours)
        if notes is not None and not (np.array_equal(mine, wi) and np.array_equal(yours, wo)):
            notes.append(f"{label} writes into its inputs (it was given copies)")
        return _values(label, result, len(wi))
    rows = []
    for i in range(len(wi)):
        part = slice(i, i + 1) if mode == "single" else i
        try:
            value = function(wi[part].copy(), wo[part].copy())
        except (Exception, SystemExit) as error:
            raise CallableError(label, f"raised {describe(error)}", wi[i], wo[i]) from error
        row = np.array(_numbers(label, value))
        if row.ndim > 2 or (row.ndim == 2 and len(row) != 1):
            raise CallableError(label, f"returned shape {row.shape} for one pair", wi[i], wo[i])
        rows.append(row.ravel())
    if len({len(row) for row in rows}) != 1 or len(rows[0]) == 0:
        raise CallableError(label, "returned values of different lengths for different pairs")
    values = np.array(rows)
    return values[:, 0] if values.shape[1] == 1 else values


def _values(label: str, result: Any, count: int) -> FloatArray:
    value = _numbers(label, result)
    if value.ndim == 0:
        return np.full(count, float(value))
    if value.shape[0] != count or value.ndim > 2:
        raise CallableError(label, f"returned shape {value.shape} for {count} pairs of directions")
    if value.ndim == 2 and value.shape[1] == 1:
        return value[:, 0].copy()
    return value


def _numbers(label: str, result: Any) -> FloatArray:
    if result is None:
        raise CallableError(label, "returned None: is a return statement missing?")
    try:
        array = np.array(result)
        if array.dtype.kind == "c" and not np.any(array.imag):
            array = array.real
        if array.dtype.kind not in "fiub":
            raise TypeError
        return np.array(array, dtype=float)
    except (TypeError, ValueError):
        raise CallableError(
            label, f"returned {type(result).__name__} that is no array of real numbers"
        ) from None


def _same(a: FloatArray, b: FloatArray) -> bool:
    return a.shape == b.shape and bool(np.allclose(a, b, rtol=1e-5, atol=1e-12, equal_nan=True))


def offender(function: Callable[..., Any], mode: Mode, wi: FloatArray, wo: FloatArray) -> int | None:
    """Find one row for which the function raises, by halving; None if no row alone makes it raise."""
    low, high = 0, len(wi)
    while high - low > 1:
        middle = (low + high) // 2
        try:
            invoke(function, "", mode, wi[low:middle], wo[low:middle])
            low = middle
        except (Exception, SystemExit):
            high = middle
    try:
        invoke(function, "", mode, wi[low : low + 1], wo[low : low + 1])
    except (Exception, SystemExit):
        return low
    return None


def describe(error: BaseException) -> str:
    """Return an exception as one line: its type and its message."""
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


@contextlib.contextmanager
def quiet(notes: list[str], label: str) -> Iterator[None]:
    """Catch what the function prints and warns, and note it once."""
    printed = io.StringIO()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            try:
                yield
            finally:
                found = [f"{label} warns: {_name_of(item)}" for item in caught]
                text = printed.getvalue().strip()
                if text:
                    found.append(f"{label} prints: {text.splitlines()[0][:80]}")
                for note in found:
                    kind = note.split(": ")[0]
                    if sum(old.startswith(kind) for old in notes) < 3 and note not in notes:
                        notes.append(note)


def _name_of(item: warnings.WarningMessage) -> str:
    return f"{item.category.__name__}: {' '.join(str(item.message).split())[:120]}"
