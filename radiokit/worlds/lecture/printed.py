"""Printed: what is found on a formula as it is printed: where its units clash, and its sides in numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import sympy

from radiokit.facts.errors import ParameterError
from radiokit.physics.relations.checker import Clash, check_dimensions
from radiokit.physics.relations.notation import SR, Notation
from radiokit.physics.relations.steps import eq
from radiokit.worlds.lecture.reader import Reading, read

__all__ = ["clashes", "read", "values"]


def clashes(reading: Reading) -> tuple[Clash, ...]:
    r"""Return where units, kinds or orders of differentials clash; of ∝, only the orders count.

    >>> print(clashes(read(r"dE = L \cos\theta"))[0].hint)
    a solid angle dω is missing on the right
    """
    found: list[Clash] = []
    for left, sign, right in reading.relations:
        if sign == "∝":
            found += _proportional(left, right, reading.notation)
            continue
        relation = {"=": eq, "≤": _at_most, "≥": lambda a, b: _at_most(b, a)}[sign](left, right)
        found += check_dimensions(relation, reading.notation).clashes
    return tuple(dict.fromkeys(found))


def values(reading: Reading, numbers: Mapping[str, Any]) -> list[float]:
    r"""Return the value of each side of a formula.

    An integral over ω is a sum: "dω" has an array of weights, and what varies has an array of its values.

    Raises
    ------
    ParameterError
        When a symbol has no number, with its indices or without them.

    >>> values(read(r"\Phi = dQ / dt"), {"Φ": 2.0, "dQ": 6.0, "dt": 3.0})
    [2.0, 2.0]
    """

    def number(symbol: Any, prefix: str = "") -> Any:
        name = f"{prefix}{symbol}"
        while name not in numbers:
            shorter = re.sub(r"(?:'|_[^_]*)$", "", name)
            if shorter == name:
                raise ParameterError("numbers", name, f"given; known are {', '.join(numbers)}")
            name = shorter
        return numbers[name]

    def summed(integral: Any) -> Any:
        (variable,) = integral.limits[0]
        symbols = sorted(integral.function.free_symbols, key=str)
        integrand = sympy.lambdify(symbols, integral.function, "numpy")
        weights = number(variable, "d")
        return sympy.Float(float((integrand(*map(number, symbols)) * weights).sum()))

    found = []
    for side in reading.sides:
        plain = side.replace(lambda part: isinstance(part, sympy.Integral), summed)
        known = {symbol: 1 if symbol == SR else number(symbol) for symbol in plain.free_symbols}
        found.append(float(plain.subs(known).doit()))
    return found


def _at_most(left: Any, right: Any) -> Any:
    return sympy.Le(left, right, evaluate=False)


def _proportional(left: Any, right: Any, notation: Notation) -> list[Clash]:
    first, second = check_dimensions(left, notation), check_dimensions(right, notation)
    found = [*first.clashes, *second.clashes]
    if not found and first.order != second.order:
        shown = (
            f"the left side is a differential of order {first.order}, the right side of order {second.order}"
        )
        found.append(Clash("order", f"{left} ∝ {right}", shown, "differentials of the same order"))
    return found
