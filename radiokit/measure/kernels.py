"""Kernels: readable scalar functions that Numba compiles, and that are plain NumPy where it cannot run.

A kernel is written once, for numbers: arithmetic, ``np.sqrt`` and its like, other kernels, and ``select`` in
place of ``if``. Numba makes machine code of it, without branches, so that the loop round it is vectorised;
without Numba the same lines run on arrays. In the loops of ``fused`` sums are put in any order, so that no
error term of an addition survives: a kernel cannot compensate. In those of ``passes`` arithmetic is strict.
Numba is imported when the first kernel is compiled. Setting ``RADIOKIT_NO_NUMBA=1`` in the environment does
without it.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import threading
from collections.abc import Callable
from functools import cached_property, lru_cache
from types import CodeType, FunctionType
from typing import Any, overload

import numpy as np

__all__ = ["Kernel", "bind", "compile_with", "kernel", "last", "numba_runs", "select"]

_FLAGS: dict[str, Any] = {
    "error_model": "numpy",  # a division by 0 gives inf: no branch for an exception
    "nogil": True,
}
_FAST = {"reassoc", "nsz", "contract", "arcp"}  # sums in lanes; NaN and inf stay what they are
_lock = threading.RLock()


class Kernel:
    """A scalar function that can be compiled; calling it from Python runs its plain form, arrays included.

    Parameters
    ----------
    function : callable
        Takes and returns numbers, or tuples of them. Its globals may be numbers, NumPy, and other kernels.
    plain : callable, optional
        What runs without Numba; ``function`` itself, unless it cannot take arrays.
    """

    def __init__(self, function: Callable[..., Any], plain: Callable[..., Any] | None = None) -> None:
        if not isinstance(function, FunctionType):
            raise TypeError(f"a kernel is made from a function, not from {type(function).__name__}")
        self.function = function
        self.plain: Callable[..., Any] = plain or function
        self.__doc__ = function.__doc__
        self.__name__ = function.__name__
        self.__qualname__ = function.__qualname__
        self.__module__ = function.__module__
        self.__wrapped__ = function

    def __call__(self, *arguments: Any) -> Any:
        """Run the plain form, with numbers or arrays."""
        return self.plain(*arguments)

    def __repr__(self) -> str:
        return f"kernel({self.__module__}.{self.__qualname__})"

    def __reduce__(self) -> str:
        return self.__qualname__  # like a function: by its name

    @cached_property
    def fingerprint(self) -> str:
        """A digest of all that its machine code depends on: its own code and that of the kernels it calls."""
        return _fingerprint(self.function, {}, set())

    @cached_property
    def inlined(self) -> Any:
        """The Numba function that other compiled functions take in whole; Python cannot call it."""
        return _inlined(self, _FAST)

    @cached_property
    def compiled(self) -> Any:
        """The Numba function of numbers that Python can call."""
        import numba

        inlined = self.inlined
        return numba.njit(lambda *arguments: inlined(*arguments))

    @cached_property
    def strict(self) -> Any:
        """The same in strict IEEE arithmetic, which gives what the plain form gives."""
        return _inlined(self, set())


@overload
def kernel(function: Callable[..., Any], /) -> Kernel: ...
@overload
def kernel(*, plain: Callable[..., Any]) -> Callable[[Callable[..., Any]], Kernel]: ...
def kernel(function: Any = None, /, *, plain: Any = None) -> Any:
    """Make a kernel of a scalar function: the decorator.

    Parameters
    ----------
    function : callable
        Takes and returns numbers, or tuples of them.
    plain : callable, optional
        Another form of it for arrays.

    Raises
    ------
    TypeError
        When ``function`` is no Python function.

    >>> @kernel
    ... def hypotenuse(a, b):
    ...     return np.sqrt(a * a + b * b)
    >>> float(hypotenuse(3.0, 4.0)), hypotenuse(np.array([3.0, 6.0]), np.array([4.0, 8.0])).tolist()
    (5.0, [5.0, 10.0])
    """
    return Kernel(function) if function is not None else lambda made: Kernel(made, plain)


def numba_runs() -> bool:
    """Return whether kernels can be compiled: Numba is installed, works, and is not switched off.

    >>> isinstance(numba_runs(), bool)
    True
    """
    if os.environ.get("RADIOKIT_NO_NUMBA", "0") not in ("", "0"):
        return False
    if importlib.util.find_spec("numba") is None:
        return False
    try:
        import numba
    except ImportError:  # it refuses a NumPy that it does not know
        return False
    return not numba.config.DISABLE_JIT


def compile_with(
    driver: FunctionType,
    argument_types: Callable[[Any], tuple[Any, ...]],
    *,
    strict: bool = False,
    **bound: Kernel,
) -> Any:
    """Compile a driver, a function with loops, in which global names stand for the kernels ``bound`` to them.

    The machine code is kept in Numba's cache, under a name that contains the fingerprint of everything
    that went into it: a change in any kernel, in whichever file, is a new entry.

    Parameters
    ----------
    driver : function
    argument_types : callable
        Returns the types of the driver's arguments, given the module ``numba``.
    strict : bool
        Keep the order of every sum, and round every product: no error differs from NumPy's.
    **bound : Kernel
    """
    import numba

    math: set[str] = set() if strict else _FAST
    with _lock:
        linked = _linked(driver, bound, math)
        linked.__qualname__ = f"{driver.__qualname__}-{_fingerprint(driver, bound, math)[:16]}"
        types = argument_types(numba)
        try:
            found = numba.njit(cache=True, fastmath=math, **_FLAGS)(linked)
            found.compile(types)
        except (RuntimeError, OSError):  # nowhere to keep the cache
            found = numba.njit(fastmath=math, **_FLAGS)(linked)
            found.compile(types)
        return found


def _inlined(function: Kernel, math: set[str]) -> Any:
    import numba

    alone = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # only compiled functions call it
    return numba.njit(forceinline=True, fastmath=math, **alone, **_FLAGS)(
        _linked(function.function, {}, math)
    )


def _named(function: Callable[..., Any], bound: dict[str, Kernel]) -> dict[str, Any]:
    """Return the globals and the enclosed variables that a function uses, in a fixed order."""
    assert isinstance(function, FunctionType)
    values = {
        name: bound.get(name, function.__globals__.get(name))
        for name in sorted(set(function.__code__.co_names))
        if name in bound or name in function.__globals__
    }
    cells = zip(function.__code__.co_freevars, function.__closure__ or (), strict=True)
    return values | {name: cell.cell_contents for name, cell in cells}


def _linked(function: Callable[..., Any], bound: dict[str, Kernel], math: set[str]) -> FunctionType:
    """Return the same code, which finds compiled functions where the original finds kernels."""
    assert isinstance(function, FunctionType)
    values = _named(function, bound)
    link = {
        name: value.inlined if math else value.strict
        for name, value in values.items()
        if isinstance(value, Kernel)
    }
    code = function.__code__
    enclosed = set(code.co_freevars) & set(link)
    if enclosed:
        raise TypeError(
            f"a kernel calls kernels of its module, not enclosed ones: {', '.join(sorted(enclosed))}"
        )
    made = FunctionType(
        code, function.__globals__ | link, function.__name__, function.__defaults__, function.__closure__
    )
    made.__qualname__, made.__module__ = function.__qualname__, function.__module__
    return made


def _fingerprint(function: Callable[..., Any], bound: dict[str, Kernel], math: set[str]) -> str:
    assert isinstance(function, FunctionType)
    parts: list[Any] = [sorted(math), *_code_parts(function.__code__), function.__defaults__]
    for name, value in _named(function, bound).items():
        if isinstance(value, Kernel):
            parts.append((name, value.fingerprint))
        elif isinstance(value, bool | int | float | np.generic | str | tuple):
            parts.append((name, repr(value)))
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def _code_parts(code: CodeType) -> tuple[Any, ...]:
    inner = [_code_parts(part) if isinstance(part, CodeType) else repr(part) for part in code.co_consts]
    return (code.co_code, inner, code.co_names, code.co_varnames, code.co_freevars)


def bind(function: Callable[..., Any], **bound: Kernel) -> Kernel:
    """Return a kernel of ``function``, in which global names stand for the kernels ``bound`` to them."""
    assert isinstance(function, FunctionType)
    space = function.__globals__ | bound
    made = FunctionType(function.__code__, space, function.__name__, function.__defaults__)
    made.__qualname__ = f"{function.__qualname__}({', '.join(k.__qualname__ for k in bound.values())})"
    made.__module__ = function.__module__
    return Kernel(made)


def _last(*arguments: Any) -> Any:
    return _whole(*arguments)[-1]


_whole: Any = None  # stands for a kernel above


@lru_cache(maxsize=256)
def last(function: Kernel) -> Kernel:
    """Return the kernel that gives the last of the numbers that ``function`` returns.

    What only the others need is not computed by the machine code.

    >>> last(kernel(lambda a, b: (b, a + b)))(1.0, 2.0)
    3.0
    """
    return bind(_last, _whole=function)


@kernel(plain=np.where)
def select(condition: Any, a: Any, b: Any) -> Any:
    """Return ``a`` where the condition holds and ``b`` elsewhere; both are computed.

    >>> float(select(True, 1.0, 2.0))
    1.0
    """
    return a if condition else b
