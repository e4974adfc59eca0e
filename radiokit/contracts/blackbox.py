"""Black boxes: any callable f(wi, wo) made into a BSDF, whatever its habits."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims, FloatArray
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import CallableError, ParameterError, RadiokitError
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["BlackBox", "as_bsdf"]

Mode = Literal["batch", "single", "row"]

# Five pairs in general position: five is neither 3 (a direction) nor a number of channels in use.
_PROBE_WI = spherical_to_cartesian([0.3, 0.7, 1.1, 0.5, 0.9], [0.2, 1.9, 3.3, 4.4, 5.6])
_PROBE_WO = spherical_to_cartesian([0.6, 0.4, 0.8, 1.2, 0.1], [2.5, 0.7, 5.9, 3.8, 1.3])


@dataclass(frozen=True, kw_only=True)
class BlackBox(BSDF):
    """A callable f(wi, wo) [sr⁻¹] of unknown making, called in the way that it can bear.

    It is handed copies, its results are copied, its prints and warnings are caught and become ``notes``.
    A function that cannot take arrays is called pair by pair. What it raises, or returns in a shape that
    is no value, becomes a ``CallableError`` that names the directions. Without a sampler of its own it is
    sampled over the cosine-weighted hemisphere.
    """

    SOURCE: ClassVar[Source] = Source(authors="the user", year=0, title="A function f(wi, wo)")

    isotropic: ClassVar[bool] = False  # not known: nothing may be assumed

    function: Callable[..., Any]
    label: str
    mode: Mode = "batch"
    pdf_function: Callable[..., Any] | None = None
    sample_function: Callable[..., Any] | None = None
    precision: float = float(np.finfo(float).eps)
    notes: list[str] = field(default_factory=list, compare=False, repr=False)

    @property
    def claims(self) -> Claims | None:
        """None: a stranger's function claims nothing."""
        return None

    @property
    def has_sampler(self) -> bool:
        """Whether it came with a ``sample`` and a ``pdf`` of its own."""
        return self.sample_function is not None and self.pdf_function is not None

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹], of shape (N,) or (N, K)."""
        return self._call(self.function, self.label, wi, wo)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``."""
        if self.pdf_function is None or self.sample_function is None:
            return np.maximum(wi[..., 2], 0.0) / np.pi
        return self._call(self.pdf_function, f"{self.label}.pdf", wi, wo)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` and ``weight = f |cos θi| / pdf``."""
        if self.pdf_function is None or self.sample_function is None:
            radius, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
            wi = np.stack([radius * np.cos(phi), radius * np.sin(phi), np.sqrt(1 - u[:, 0])], axis=-1)
            return wi, np.pi * self.evaluate(wi, wo)
        label = f"{self.label}.sample"
        with _quiet(self.notes, label):
            try:
                found = self.sample_function(u.copy(), wo.copy())
                wi, weight = found
                wi, weight = np.array(wi, dtype=float), np.array(weight, dtype=float)
            except (Exception, SystemExit) as error:
                raise CallableError(label, f"raised {_name(error)}") from error
        if wi.shape != (*u.shape[:1], 3) or weight.shape[:1] != u.shape[:1]:
            raise CallableError(label, f"returned shapes {wi.shape} and {weight.shape} for {len(u)} points")
        return wi, weight

    def symbolic(self) -> Twin:
        """Raise: a black box has no symbolic twin."""
        raise RadiokitError(f"{self.label} is a black box: it has no symbolic twin")

    def _call(self, function: Callable[..., Any], label: str, wi: FloatArray, wo: FloatArray) -> FloatArray:
        wi, wo = np.broadcast_arrays(wi, wo)
        if len(wi) == 0:
            return np.zeros(0)
        with _quiet(self.notes, label):
            try:
                return _invoke(function, label, self.mode, wi, wo)
            except CallableError:
                raise
            except (Exception, SystemExit) as error:
                row = _offender(function, self.mode, wi, wo)
                where = (None, None) if row is None else (wi[row].copy(), wo[row].copy())
                raise CallableError(label, f"raised {_name(error)}", *where) from error

    def __repr__(self) -> str:
        return f"as_bsdf({self.label})"


def as_bsdf(
    function: Any,
    *,
    label: str | None = None,
    pdf: Callable[..., Any] | None = None,
    sample: Callable[..., Any] | None = None,
) -> BSDF:
    """Wrap any callable f(wi, wo) as a BSDF; a BSDF is returned as it is.

    The function may take arrays (N, 3) or one pair (3,) at a time; it may return an array (N,), (N, 1) or
    (N, K), a list, a float, or float32. How it wants to be called is found by trying, and what it did that
    it should not (print, warn, write into its inputs) is kept in ``notes``.

    Parameters
    ----------
    function : callable
        f(wi, wo) [sr⁻¹], without the cosine.
    label : str, optional
        What to call it in reports; its own name by default.
    pdf : callable, optional
        pdf(wi, wo) [sr⁻¹]. A callable attribute ``pdf`` of ``function`` is used when not given.
    sample : callable, optional
        sample(u, wo) -> (wi, weight), for u (N, 2) and wo (N, 3). An attribute likewise.

    Raises
    ------
    ParameterError
        When ``function`` is not callable.
    CallableError
        When it raises, or returns what is no value.

    >>> f = as_bsdf(lambda wi, wo: 0.5 / np.pi, label="half")
    >>> float(f((0.0, 0.0, 1.0), (0.0, 0.6, 0.8)).round(6))
    0.159155
    """
    if isinstance(function, BSDF):
        return function
    if not callable(function):
        raise ParameterError("function", function, "a BSDF or a callable f(wi, wo)")
    label = label or getattr(function, "__name__", None) or type(function).__name__
    notes: list[str] = []
    with _quiet(notes, label):
        mode, precision = _probe(function, label, notes)
    return BlackBox(
        function=function,
        label=label,
        mode=mode,
        pdf_function=pdf or _method(function, "pdf"),
        sample_function=sample or _method(function, "sample"),
        precision=precision,
        notes=notes,
    )


def _method(function: Any, name: str) -> Callable[..., Any] | None:
    found = getattr(function, name, None)
    return found if callable(found) else None


def _probe(function: Callable[..., Any], label: str, notes: list[str]) -> tuple[Mode, float]:
    """Find how the function wants to be called: with arrays, with arrays of one row, or pair by pair."""
    found: dict[Mode, FloatArray] = {}
    failed: dict[Mode, Exception] = {}
    modes: tuple[Mode, ...] = ("batch", "single", "row")
    for mode in modes:
        try:
            found[mode] = _invoke(function, label, mode, _PROBE_WI, _PROBE_WO, notes)
        except (Exception, SystemExit) as error:
            failed[mode] = error if isinstance(error, CallableError) else _located(label, error)
    one_by_one = next((mode for mode in ("row", "single") if mode in found), None)
    chosen: Mode
    if "batch" in found:
        chosen = "batch"
        others = [found[mode] for mode in modes[1:] if mode in found]
        if others and not any(_same(found["batch"], other) for other in others):
            again = _invoke(function, label, "batch", _PROBE_WI, _PROBE_WO, notes)
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
    return CallableError(label, f"raised {_name(error)}", _PROBE_WI[0], _PROBE_WO[0])


def _raw(function: Callable[..., Any], mode: Mode, wi: FloatArray, wo: FloatArray) -> Any:
    if mode == "batch":
        return function(wi.copy(), wo.copy())
    if mode == "row":
        return function(wi[0].copy(), wo[0].copy())
    return function(wi[:1].copy(), wo[:1].copy())


def _invoke(
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
            raise CallableError(label, f"raised {_name(error)}", wi[i], wo[i]) from error
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


def _offender(function: Callable[..., Any], mode: Mode, wi: FloatArray, wo: FloatArray) -> int | None:
    """Find one row for which the function raises, by halving; None if no row alone makes it raise."""
    low, high = 0, len(wi)
    while high - low > 1:
        middle = (low + high) // 2
        try:
            _invoke(function, "", mode, wi[low:middle], wo[low:middle])
            low = middle
        except (Exception, SystemExit):
            high = middle
    try:
        _invoke(function, "", mode, wi[low : low + 1], wo[low : low + 1])
    except (Exception, SystemExit):
        return low
    return None


def _name(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


@contextlib.contextmanager
def _quiet(notes: list[str], label: str) -> Any:
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
