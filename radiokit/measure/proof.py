"""Proof: symbolic identities that SymPy finds in bounded time, and what is no proof is said to be none."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from radiokit.measure.twin import compiled, working_precision

if TYPE_CHECKING:
    import sympy

__all__ = ["TimeIsUp", "proved_zero", "time_limit"]

_MAX_OPERATIONS = 400  # beyond this size, simplify() rarely comes back within the seconds allowed


class TimeIsUp(BaseException):
    """Raised by ``time_limit``; not an Exception, so that no handler inside SymPy swallows it."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise ``TimeIsUp`` in this thread, whatever Python code it runs, once the time has run out.

    >>> try:
    ...     with time_limit(0.01):
    ...         while True:
    ...             pass
    ... except TimeIsUp:
    ...     print("given up")
    given up
    """
    import ctypes

    thread, gate = ctypes.c_ulong(threading.get_ident()), threading.Lock()
    inside = True

    def interrupt() -> None:
        with gate:
            if inside:
                ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, ctypes.py_object(TimeIsUp))

    timer = threading.Timer(seconds, interrupt)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        with gate:
            inside = False
            ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, None)  # what is raised but not yet seen
        timer.cancel()


def proved_zero(expression: sympy.Expr, *, seconds: float = 5.0) -> bool:
    """Return True when SymPy's normal forms reduce the expression to 0, given |wi| = |wo| = 1.

    False means that no proof was found in time, or that a random point refutes the identity; it is no
    proof of the contrary. Reciprocity is ``proved_zero(twin.swapped().expression - twin.expression)``.

    Parameters
    ----------
    expression : sympy.Expr
        ``DIRECTION_SYMBOLS`` in it are components of unit vectors.
    seconds : float
        Time after which the attempt is given up [s].

    >>> from radiokit.measure.twin import DIRECTION_SYMBOLS
    >>> x_i, y_i, z_i, *_ = DIRECTION_SYMBOLS
    >>> proved_zero(x_i**2 + y_i**2 + z_i**2 - 1), proved_zero(x_i**2 + y_i**2 - 1)
    (True, False)
    """
    import sympy

    expression = sympy.sympify(expression)
    if expression == 0:
        return True
    try:
        with time_limit(seconds):
            if _refuted(expression):
                return False
            reduced = _on_unit_sphere(expression)
            forms: list[Callable[[Any], Any]] = [sympy.expand, sympy.cancel, sympy.factor, sympy.simplify]
            for form in forms:
                if form is not sympy.expand and sympy.count_ops(reduced) > _MAX_OPERATIONS:
                    break
                if reduced == 0 or form(reduced) == 0:
                    return True
    except (TimeIsUp, sympy.PolynomialError, NotImplementedError, RecursionError):
        return False
    return False


def _on_unit_sphere(expression: sympy.Expr) -> sympy.Expr:
    """Replace z² by 1 − x² − y² for both directions, from the innermost polynomials outwards."""
    import sympy

    from radiokit.measure.twin import DIRECTION_SYMBOLS

    x_i, y_i, z_i, x_o, y_o, z_o = symbols = DIRECTION_SYMBOLS

    def reduce(part: sympy.Expr) -> sympy.Expr:
        for x, y, z in ((x_i, y_i, z_i), (x_o, y_o, z_o)):
            part = sympy.rem(part, x**2 + y**2 + z**2 - 1, z) if part.has(z) else part
        return sympy.expand(part)

    def is_polynomial(part: sympy.Expr) -> bool:
        return isinstance(part, sympy.Add) and part.has(*symbols) and part.is_polynomial(*symbols)

    return expression.replace(is_polynomial, reduce)


def _refuted(expression: sympy.Expr) -> bool:
    """Return whether the expression is clearly not 0 at some point with |wi| = |wo| = 1."""
    import mpmath

    from radiokit.measure.twin import DIRECTION_SYMBOLS

    directions = DIRECTION_SYMBOLS
    others = tuple(sorted(expression.free_symbols - set(directions), key=str))
    rng = np.random.default_rng(0)
    function = compiled(expression, directions + others)
    for _ in range(4):
        with working_precision(50):
            pairs = [[mpmath.mpf(x) for x in rng.uniform(0.1, 1.0, 3)] for _ in range(2)]
            unit = [x / mpmath.norm(pair) for pair in pairs for x in pair]
            try:
                numbers = map(mpmath.mpf, rng.uniform(0.1, 0.9, len(others)))
                value = mpmath.mpmathify(function(*unit, *numbers))
            except (ArithmeticError, NameError, TypeError, ValueError):
                return False
            if mpmath.isfinite(value) and abs(value) > mpmath.mpf(10) ** -25:
                return True
    return False
