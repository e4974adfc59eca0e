"""Checker: says where the units, kinds or differentials of a formula clash, and what is probably missing."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy

from radiokit.physics.relations.dimension import Dimension
from radiokit.physics.relations.notation import Notation
from radiokit.physics.relations.walker import Clash, Walker

__all__ = ["Clash", "Dimensions", "check_dimensions"]


@dataclass(frozen=True)
class Dimensions:
    """What a formula is, and what in it does not fit.

    ``dimension`` is None where a clash leaves it open, and for 0, which has every unit.
    """

    dimension: Dimension | None
    kind: str
    order: Fraction | None
    clashes: tuple[Clash, ...]

    @property
    def ok(self) -> bool:
        """True when nothing clashes."""
        return not self.clashes

    def __str__(self) -> str:
        return "\n".join(map(str, self.clashes)) or "units, kinds and differentials agree"


def check_dimensions(expression: Any, notation: Notation) -> Dimensions:
    """Return what ``expression`` is, and every place where units, kinds or orders of differentials clash.

    Parameters
    ----------
    expression : sympy.Basic
        Sums, products, powers, integrals, derivatives, sums over an index, limits, functions, cases,
        equations and inequalities. Write equations with ``eq``, which keeps both sides.
    notation : Notation
        What the symbols mean.

    >>> n = Notation()
    >>> dE, L = n.quantity("dE", "irradiance", order=1), n.quantity("L", "radiance")
    >>> theta, dw = n.angle("θ"), n.differential("dω", "sr")
    >>> check_dimensions(sympy.Eq(dE, L * sympy.cos(theta) * dw), n).ok
    True
    >>> print(check_dimensions(sympy.Eq(dE, L * sympy.cos(theta)), n).clashes[0].hint)
    a solid angle dω is missing on the right
    """
    walker = Walker(notation)
    found = walker.find(sympy.sympify(expression))
    return Dimensions(found.dimension, found.kind, found.order, tuple(dict.fromkeys(walker.clashes)))
