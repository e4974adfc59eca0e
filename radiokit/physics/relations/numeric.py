"""Numeric: formulas tried at random points with 50 digits, as a last resort and against wrong proofs."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from radiokit.measure.twin import working_precision

__all__ = ["DIGITS", "compared", "evaluated"]

DIGITS = 50
_RANGE = (0.2, 1.3)
_GUARD = 12

_UNTRIABLE = (sympy.Limit, sympy.DiracDelta, sympy.Subs, sympy.Derivative)


def points(
    expression: Any, name: str, ranges: Mapping[Any, tuple[float, float]], count: int
) -> Iterator[dict[Any, float]]:
    """Yield random values for the free symbols, the same ones for the same ``name``."""
    rng = np.random.default_rng(int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "big"))
    symbols = sorted(expression.free_symbols, key=str)
    for _ in range(count if symbols else 1):
        yield {
            symbol: int(rng.integers(1, 9))
            if symbol.is_integer
            else float(rng.uniform(*ranges.get(symbol, _RANGE)))
            for symbol in symbols
        }


def with_trial_functions(expression: Any, name: str) -> Any:
    """Put exp(Σ c x) with c of its own in the place of every function that is not given."""

    def trial(applied: Any) -> Any:
        digest = hashlib.sha256(f"{name} {applied.func}".encode()).digest()
        return sympy.exp(
            sum(
                sympy.Rational(1 + byte % 7, 9) * arg for byte, arg in zip(digest, applied.args, strict=False)
            )
        )

    return expression.replace(lambda part: isinstance(part, AppliedUndef), trial)


@lru_cache(maxsize=64)
def _function(expression: Any, symbols: tuple[Any, ...]) -> Any:
    """Compile for mpmath; common parts stay in their place, which may be under an integral sign."""
    return sympy.lambdify(symbols, expression, modules="mpmath", cse=False)


def evaluated(
    left: Any,
    right: Any,
    name: str,
    ranges: Mapping[Any, tuple[float, float]],
    count: int,
    digits: int = DIGITS,
) -> list[tuple[Any, Any, dict[str, float]]] | None:
    """Return the values of two expressions at random points, and where; None where there are none."""
    import mpmath

    parts = (with_trial_functions(side, name).doit(integrals=False) for side in (left, right))
    pair = sympy.Tuple(*parts)
    if pair.has(*_UNTRIABLE):
        return None
    found = []
    for values in points(pair, name, ranges, count):
        symbols = tuple(values)
        with working_precision(digits + _GUARD):
            numbers = [value if isinstance(value, int) else mpmath.mpf(value) for value in values.values()]
            try:
                first, second = (mpmath.mpmathify(_function(part, symbols)(*numbers)) for part in pair)
            except (ArithmeticError, AttributeError, NameError, TypeError, ValueError, KeyError):
                return None
            if not mpmath.isfinite(abs(first) + abs(second)):
                return None
        found.append((first, second, {str(symbol): value for symbol, value in values.items()}))
    return found


def compared(
    left: Any,
    right: Any,
    name: str,
    ranges: Mapping[Any, tuple[float, float]],
    count: int,
    digits: int = DIGITS,
) -> tuple[float, dict[str, float]] | None:
    """Return the largest relative difference of two expressions at random points, and where it is.

    None means that they cannot be evaluated there.
    """
    found = evaluated(left, right, name, ranges, count, digits)
    if found is None:
        return None
    worst: tuple[float, dict[str, float]] = (0.0, {})
    for first, second, where in found:
        with working_precision(digits + _GUARD):
            size = abs(first) + abs(second)
            difference = float(abs(first - second) / size) if size else 0.0
        if difference >= worst[0]:
            worst = difference, where
    return worst
