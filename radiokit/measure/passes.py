"""Passes: a kernel run over arrays, in blocks that stay in the cache, as machine code where that pays."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.measure.kernels import Kernel, compile_with, numba_runs

__all__ = ["PAYS", "processors", "run"]

PAYS = 1 << 18
"""Rows from which a pass is run as machine code: fewer take less time than loading the compiler."""

_BLOCK = 1 << 13  # rows that NumPy is given at a time
_SHARE = 1 << 17  # rows that a thread is given at a time


def run(
    function: Kernel,
    columns: Sequence[Any],
    constants: Sequence[Any] = (),
    *,
    compiled: bool | None = None,
) -> Any:
    """Return a kernel's values for columns of arguments: (n,) for one number, a tuple of them for several.

    Machine code and NumPy give the same numbers, to the last bit where the kernel is made of arithmetic and
    of the functions in ``elementary``, and whatever the number of threads. Nothing warns: what ``select``
    drops may be NaN.

    Parameters
    ----------
    function : Kernel
    columns : sequence of array_like
        The first arguments: arrays (n,), of which there must be one, and numbers, which are the same for
        every row.
    constants : sequence of float or array_like
        The other arguments. Where there are arrays (K,), values that depend on them have the shape (n, K).
    compiled : bool, optional
        Whether to run machine code, where Numba can; by default when there are ``PAYS`` rows.

    Raises
    ------
    ParameterError
        When the columns differ in length, or none is an array.

    >>> from radiokit.measure.kernels import kernel
    >>> scaled = kernel(lambda a, b, scale: scale * a * b)
    >>> run(scaled, ([1.0, 2.0], 3.0), (0.5,)).tolist()
    [1.5, 3.0]
    >>> run(scaled, ([1.0, 2.0], 3.0), ([0.5, 1.0],)).tolist()
    [[1.5, 3.0], [3.0, 6.0]]
    """
    found = [np.asarray(column, dtype=np.float64) for column in columns]
    shapes = {column.shape for column in found if column.ndim}
    if len(shapes) != 1 or len(next(iter(shapes))) != 1:
        allowed = "arrays of one shape (n,), at least one of them, and numbers"
        raise ParameterError("columns", [column.shape for column in found], allowed)
    (rows,) = next(iter(shapes))
    spectral = [np.ndim(value) > 0 for value in constants]
    if compiled is None:
        compiled = rows >= PAYS
    if rows and compiled and not any(spectral) and numba_runs():
        return _machine(function, found, tuple(map(float, constants)), rows)
    if not any(spectral):
        return _plain(function, found, constants, rows)
    found = [column[:, None] if column.ndim else column for column in found]
    values = [np.asarray(value, dtype=np.float64) for value in constants]
    if any(value.shape[-1:] not in ((), (1,)) for value in values):
        return _plain(function, found, values, rows)
    # Two wavelengths in place of one tell what depends on it from what does not.
    two = _plain(function, found, [np.repeat(v, 2) if v.ndim else v for v in values], rows)
    parts = [part[:, :1] if part.ndim == 2 else part for part in (two if isinstance(two, tuple) else (two,))]
    return tuple(parts) if isinstance(two, tuple) else parts[0]


def processors() -> int:
    """Return how many processors this process may use.

    >>> processors() >= 1
    True
    """
    if sys.platform == "emscripten":  # a browser, where no thread can be started
        return 1
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def _plain(
    function: Kernel, columns: list[npt.NDArray[np.float64]], constants: Sequence[Any], rows: int
) -> Any:
    """Run NumPy on a block of rows at a time."""
    outs: list[npt.NDArray[np.float64]] = []
    spectral, several = any(np.ndim(value) for value in constants), False
    with np.errstate(all="ignore"):
        for first in range(0, max(rows, 1), _BLOCK):
            part = slice(first, min(first + _BLOCK, rows))
            values = function.plain(*(c[part] if c.ndim else float(c) for c in columns), *constants)
            several = isinstance(values, tuple)
            values = [np.asarray(value) for value in (values if several else (values,))]
            if not outs:
                outs = [np.empty((rows, *_wavelengths(value, spectral))) for value in values]
            for out, value in zip(outs, values, strict=True):
                out[part] = value[..., 0] if spectral and out.ndim == 1 and value.ndim else value
    return tuple(outs) if several else outs[0]


def _wavelengths(value: npt.NDArray[np.float64], spectral: bool) -> tuple[int, ...]:
    """Return the shape that a value has beside its rows: one that depends on no spectrum has none."""
    return value.shape[-1:] if spectral and value.shape[-1:] != (1,) else ()


def _machine(
    function: Kernel, columns: list[npt.NDArray[np.float64]], constants: tuple[float, ...], rows: int
) -> Any:
    """Run machine code, on all processors when there is enough to do."""
    with np.errstate(all="ignore"):
        probe = function.plain(*(float(c[0] if c.ndim else c) for c in columns), *constants)
    several = isinstance(probe, tuple)
    loop = _loop(function, tuple(c.ndim > 0 for c in columns), len(constants), len(probe) if several else 0)
    arguments = [np.ascontiguousarray(c) if c.ndim else float(c) for c in columns]
    out = np.empty((len(probe), rows) if several else rows)

    def work(first: int) -> None:
        loop(*arguments, constants, out, first, min(first + _SHARE, rows))

    starts, workers = range(0, rows, _SHARE), processors()
    if len(starts) > 1 and workers > 1:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(work, starts))
    else:
        for first in starts:
            work(first)
    return tuple(out) if several else out


@lru_cache(maxsize=256)
def _loop(function: Kernel, varies: tuple[bool, ...], constants: int, outputs: int) -> Any:
    """Compile the loop over the rows; its text is the only part that depends on the number of columns."""
    names = [f"c{j}" for j in range(len(varies))]
    at = ", ".join(f"{name}[i]" if array else name for name, array in zip(names, varies, strict=True))
    values = ", ".join(f"out[{j}, i]" for j in range(outputs)) or "out[i]"
    text = (
        f"def loop({', '.join(names)}, constants, out, first, last):\n"
        f"    for i in range(first, last):\n"
        f"        {values} = function({at}, *constants)\n"
    )
    space: dict[str, Any] = {"__name__": __name__}
    exec(compile(text, __file__, "exec"), space)

    def types(numba: Any) -> tuple[Any, ...]:
        number, index = numba.float64, numba.int64
        out = number[:, ::1] if outputs else number[::1]
        columns = [number[::1] if array else number for array in varies]
        return (*columns, numba.types.UniTuple(number, constants), out, index, index)

    return compile_with(space["loop"], types, strict=True, function=function)
