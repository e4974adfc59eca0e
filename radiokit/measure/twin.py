"""Twin: a kernel's symbolic definition, its oracle to any number of digits, and error counted in ulps."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError, RadiokitError

if TYPE_CHECKING:
    import mpmath
    import sympy

    DIRECTION_SYMBOLS: tuple[sympy.Symbol, ...]

__all__ = ["DIRECTION_SYMBOLS", "Twin", "compiled", "scaled_ulps", "ulps", "working_precision"]

_PRECISION = threading.RLock()  # mpmath's working precision is one for the whole process
_EXPONENTS = 700  # digits between a square of the smallest float64 and 1, and some more


@functools.cache
def _direction_symbols() -> tuple[sympy.Symbol, ...]:
    import sympy

    return tuple(sympy.symbols("x_i y_i z_i x_o y_o z_o", real=True))


def __getattr__(name: str) -> Any:
    """Make ``DIRECTION_SYMBOLS`` when it is first asked for, so that importing this loads no SymPy."""
    if name == "DIRECTION_SYMBOLS":
        return _direction_symbols()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


@dataclass(frozen=True)
class Twin:
    r"""A function as a SymPy expression, written from its source and never from the kernel.

    Parameters
    ----------
    expression : sympy.Expr
        Dirac deltas may stand in it; evaluation counts them as 0, as ``BSDF.evaluate`` does.
    parameters : mapping of sympy.Symbol to float
        The model's parameters and their values, taken as exact binary numbers; a spectrum only stands here.
    arguments : tuple of sympy.Symbol
        What the function depends on; ``DIRECTION_SYMBOLS`` (x_i, y_i, z_i, x_o, y_o, z_o) by default.

    >>> import mpmath, sympy
    >>> rho = sympy.Symbol("rho", positive=True)
    >>> twin = Twin(rho / sympy.pi, {rho: 0.5})
    >>> print(mpmath.nstr(twin.evaluate((0, 0, 1), (0, 0, 1)), 30))
    0.159154943091895335768883763373
    >>> twin.latex()
    '\\frac{\\rho}{\\pi}'
    """

    expression: sympy.Expr
    parameters: Mapping[sympy.Symbol, float | tuple[float, ...]] = field(default_factory=dict)
    arguments: tuple[sympy.Symbol, ...] = field(default_factory=_direction_symbols)

    def __post_init__(self) -> None:
        if not hasattr(self.expression, "free_symbols"):
            raise ParameterError("expression", self.expression, "a SymPy expression")
        unbound = self.expression.free_symbols - set(self.arguments) - set(self.parameters)
        if unbound:
            names = ", ".join(sorted(map(str, unbound)))
            raise ParameterError("expression", self.expression, f"without unbound symbols ({names})")

    def evaluate(self, wi: npt.ArrayLike, wo: npt.ArrayLike, digits: int = 50) -> mpmath.mpf:
        """Return the value for one pair of directions (3,), each taken as the exact binary numbers."""
        return self.at(*_components(wi, wo), digits=digits)

    def at(self, *values: float, digits: int = 50) -> mpmath.mpf:
        """Return the value for these arguments, correct to ``digits`` significant digits.

        The precision is raised until two results agree, the second time to where float64's whole range
        of exponents may cancel: the source's formula need not be a stable one.

        Raises
        ------
        RadiokitError
            When the result does not settle.
        """
        import mpmath

        numbers = self._numbers(values)
        value = previous = mpmath.mpf(mpmath.nan)
        for precision in (digits + 10, digits + _EXPONENTS, 2 * (digits + _EXPONENTS)):
            with working_precision(precision):
                previous, value = value, self._real(*numbers)
                if abs(value - previous) <= abs(value) * mpmath.mpf(10) ** -digits:
                    return value
        with working_precision(digits):
            if max(abs(value), abs(previous)) < mpmath.mpf(10) ** (-_EXPONENTS // 2):
                return mpmath.mpf(0)  # rounding noise that shrinks with the precision
        raise RadiokitError(f"no {digits} digits of {self.expression} at {values}", values=values)

    def rough(self, wi: npt.ArrayLike, wo: npt.ArrayLike, precision: int) -> mpmath.mpf:
        """Return the value for one pair as it comes out with so many digits, right or not."""
        numbers = self._numbers(_components(wi, wo))
        with working_precision(precision):
            return self._real(*numbers)

    def condition(self, wi: npt.ArrayLike, wo: npt.ArrayLike, digits: int = 20) -> float:
        """Return the relative condition number Σ|x ∂f/∂x| / |f| for one pair of directions (3,)."""
        return self.condition_at(*_components(wi, wo), digits=digits)

    def condition_at(self, *values: float, digits: int = 20) -> float:
        """Return Σ|x ∂f/∂x| / |f| over the arguments and the parameters: 0 where f vanishes throughout.

        The derivatives are central differences whose step is 10^-digits of x, at three times the digits.
        """
        import mpmath

        numbers = self._numbers(values)
        with working_precision(3 * digits + 10):
            step = mpmath.mpf(10) ** -digits
            total = mpmath.mpf(0)
            for index, number in enumerate(numbers):
                if number:
                    up, down = (
                        self._real(*numbers[:index], number * factor, *numbers[index + 1 :])
                        for factor in (1 + step, 1 - step)
                    )
                    total += abs(up - down) / (2 * step)
            value = abs(self._real(*numbers))
            if not value:
                return np.inf if total else 0.0
            return float(total / value)

    def swapped(self) -> Twin:
        """Return the twin with wi and wo exchanged."""
        symbols = _direction_symbols()
        exchange = dict(zip(symbols, symbols[3:] + symbols[:3], strict=True))
        return replace(self, expression=self.expression.xreplace(exchange))

    def latex(self) -> str:
        """Return the expression as LaTeX."""
        import sympy

        return str(sympy.latex(self.expression))

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self.latex()}$"

    def _numbers(self, values: Sequence[float]) -> list[mpmath.mpf]:
        """Return arguments and parameters as exact multiple-precision numbers."""
        import mpmath

        if len(values) != len(self.arguments):
            raise ParameterError("values", values, f"{len(self.arguments)} numbers")
        numbers = [*values]
        for symbol, value in self.parameters.items():
            if isinstance(value, tuple):
                raise ParameterError(str(symbol), value, "one number: a twin's values are for one wavelength")
            numbers.append(value)
        return [mpmath.mpf(float(number)) for number in numbers]

    def _real(self, *numbers: mpmath.mpf) -> mpmath.mpf:
        """Evaluate at mpmath's present precision and drop the imaginary part, which must be 0.

        Where the formula divides by 0, the limit is meant: arguments that are 0 are moved, less at a higher
        precision, so that only a limit gives the same value at two of them.
        """
        import mpmath

        function = compiled(self.expression, (*self.arguments, *self.parameters))
        try:
            value = mpmath.mpmathify(function(*numbers))
        except ZeroDivisionError:
            places = min(mpmath.mp.dps, 100 + mpmath.mp.dps // 10)  # more, and exp(−1/x²) takes seconds
            beside = mpmath.mpf(10) ** -places
            value = mpmath.mpmathify(function(*(number or beside for number in numbers)))
        if isinstance(value, mpmath.mpc):
            if abs(value.imag) > mpmath.sqrt(mpmath.eps) * abs(value.real):
                raise RadiokitError(f"{self.expression} is complex at {numbers}", values=numbers)
            value = value.real
        return value


@functools.lru_cache(maxsize=256)
def compiled(expression: sympy.Expr, symbols: tuple[sympy.Symbol, ...]) -> Callable[..., Any]:
    """Return an expression as a function of mpmath numbers, compiled once; a Dirac delta is 0."""
    import sympy

    function: Callable[..., Any] = sympy.lambdify(
        symbols, expression, modules=[{"DiracDelta": lambda _: 0}, "mpmath"], cse=True
    )
    return function


@contextmanager
def working_precision(digits: int) -> Iterator[None]:
    """Work with this many digits in mpmath, and keep other threads from changing it meanwhile.

    >>> import mpmath
    >>> with working_precision(30):
    ...     print(mpmath.pi * 1)
    3.14159265358979323846264338328
    """
    import mpmath

    with _PRECISION, mpmath.workdps(digits):
        yield


def _components(wi: npt.ArrayLike, wo: npt.ArrayLike) -> list[float]:
    """Return the six components of a pair of directions."""
    components = [float(x) for direction in (wi, wo) for x in np.asarray(direction, dtype=float)]
    if len(components) != 6:
        raise ParameterError("wi, wo", (wi, wo), "two directions of shape (3,)")
    return components


def ulps(value: npt.ArrayLike, exact: Any, precision: type[np.floating[Any]] = np.float64) -> Any:
    """Return |value − exact| in units of the last place of ``exact``, rounded to ``precision``.

    A unit is never smaller than the smallest denormal, so an underflow to 0 costs at most half a unit. A
    NaN, or an infinity where the truth is finite, is infinitely far away.

    Parameters
    ----------
    value : array_like, shape (...)
        What was computed.
    exact : mpmath.mpf, or a sequence of the same shape
        The truth.
    precision : type
        ``numpy.float64`` or ``numpy.float32``: whose last place is the unit.

    >>> import mpmath
    >>> float(ulps(1.0 + 2**-52, mpmath.mpf(1))), float(ulps(0.0, mpmath.mpf("1e-400"))) < 0.5
    (1.0, True)
    """
    import mpmath

    values, truths = np.asarray(value, dtype=float), np.asarray(exact, dtype=object)
    result = np.empty(np.broadcast_shapes(values.shape, truths.shape))
    for index in np.ndindex(result.shape):
        v = float(np.broadcast_to(values, result.shape)[index])
        truth = mpmath.mpmathify(np.broadcast_to(truths, result.shape)[index])
        with np.errstate(over="ignore", under="ignore"):
            nearest = precision(float(truth))
        if not (np.isfinite(v) and np.isfinite(nearest)):
            result[index] = 0.0 if v == nearest else np.inf
            continue
        with working_precision(50):
            unit = mpmath.mpf(float(np.spacing(abs(nearest))))
            result[index] = float(abs(mpmath.mpf(v) - truth) / unit)
    return result[()]


def scaled_ulps(
    value: npt.ArrayLike,
    exact: Any,
    condition: npt.ArrayLike,
    precision: type[np.floating[Any]] = np.float64,
) -> Any:
    """Return the error in ulps divided by max(1, condition): what a backward-stable kernel keeps small.

    >>> import mpmath
    >>> float(scaled_ulps(1.0 + 2**-50, mpmath.mpf(1), 2.0))
    2.0
    """
    count = np.asarray(ulps(value, exact, precision))
    # Where the truth is 0 or not finite the condition number means nothing, and excuses nothing.
    defined = np.isfinite(condition) & np.isfinite(count)
    return np.where(defined, count / np.maximum(1.0, np.where(defined, condition, 1.0)), count)[()]
