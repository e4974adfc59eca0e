"""Walker: goes through a formula, part by part, and collects where units, kinds or differentials clash."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy
from sympy.core.function import AppliedUndef
from sympy.core.relational import Relational
from sympy.functions.elementary.hyperbolic import HyperbolicFunction, InverseHyperbolicFunction
from sympy.functions.elementary.trigonometric import InverseTrigonometricFunction, TrigonometricFunction

from radiokit.physics.relations.dimension import NUMBER, Dimension
from radiokit.physics.relations.hints import Found, describe, equation_clash, kind_difference, kinds_differ
from radiokit.physics.relations.notation import Notation

__all__ = ["Clash", "Walker"]

_OF_NUMBERS = (
    TrigonometricFunction,
    InverseTrigonometricFunction,
    HyperbolicFunction,
    InverseHyperbolicFunction,
    sympy.exp,
    sympy.log,
    sympy.erf,
    sympy.erfc,
)
_SAME = (sympy.Abs, sympy.Max, sympy.Min, sympy.re, sympy.im, sympy.conjugate)
_LOGIC = (sympy.And, sympy.Or, sympy.Not)


@dataclass(frozen=True)
class Clash:
    """Something that does not fit.

    Parameters
    ----------
    code : str
        For programs: ``unit``, ``kind`` or ``order`` of a sum or an equation, ``function``, ``exponent``,
        ``unknown``.
    where : str
        The sub-expression.
    found, expected : str
        What stands there, and what should.
    hint : str
        What is probably missing; may be empty.
    """

    code: str
    where: str
    found: str
    expected: str
    hint: str = ""

    def __str__(self) -> str:
        text = f"in {self.where}: {self.found}; expected {self.expected}"
        return f"{text}; {self.hint}" if self.hint else text

    def to_json(self) -> dict[str, str]:
        """Return the clash as JSON-ready data."""
        return {name: getattr(self, name) for name in self.__dataclass_fields__}


class Walker:
    """Finds what each part of a formula is, and collects the clashes on its way."""

    def __init__(self, notation: Notation) -> None:
        self.notation = notation
        self.clashes: list[Clash] = []
        self.indices: set[Any] = set()

    def _clash(self, code: str, where: Any, found: str, expected: str, hint: str = "") -> Found:
        self.clashes.append(Clash(code, str(where), found, expected, hint))
        return Found(None, "", None)

    def find(self, e: Any) -> Found:
        """Return what ``e`` is."""
        if e.is_Number or e.is_NumberSymbol or e is sympy.I:
            return Found(None, "", None) if e.is_zero or e.is_infinite else Found()
        if isinstance(e, sympy.Symbol):
            return self._symbol(e)
        if isinstance(e, Relational):
            return self._relation(e)
        for kind, method in _RULES:
            if isinstance(e, kind):
                return getattr(self, f"_{method}")(e)
        if isinstance(e, (sympy.logic.boolalg.BooleanAtom, sympy.Set, sympy.ImmutableDenseMatrix)):
            return Found()
        return self._clash(
            "unknown", e, f"{type(e).__name__} is not understood", "a function that the checker knows"
        )

    def _symbol(self, e: Any) -> Found:
        if e in self.indices:
            return Found()
        if e not in self.notation.meanings:
            return self._clash("unknown", e, "nothing says what it means", "a symbol of the notation")
        meaning = self.notation.meanings[e]
        return Found(meaning.dimension, meaning.kind, meaning.order)

    def _sum(self, e: Any) -> Found:
        return self._alike(e, [(arg, self.find(arg)) for arg in sympy.Add.make_args(e)], "a sum")

    def _same(self, e: Any) -> Found:
        return self._alike(e, [(arg, self.find(arg)) for arg in e.args], type(e).__name__)

    def _alike(self, where: Any, parts: Sequence[tuple[Any, Found]], what: str) -> Found:
        """Return what all the parts are; the first of known unit sets the rule for the rest."""
        known = [(e, found) for e, found in parts if found.dimension is not None]
        if not known:
            return parts[0][1]
        first, base = known[0]
        for e, found in known[1:]:
            shown = f"{first} is {describe(base)}, {e} is {describe(found)}"
            if found.dimension != base.dimension:
                return self._clash(
                    "unit",
                    where,
                    shown,
                    f"terms of one unit in {what}",
                    _difference(found, base),
                )
            if None not in (found.order, base.order) and found.order != base.order:
                return self._clash("order", where, shown, f"differentials of one order in {what}")
            if kinds_differ(found, base):
                return self._clash(
                    "kind", where, shown, f"terms of one kind in {what}", kind_difference(base, found)
                )
            base = replace(base, kind=base.kind or found.kind)
        return base

    def _product(self, e: Any) -> Found:
        dimension, order, kinds, open_ = NUMBER, Fraction(0), [], False
        for arg in e.args:
            found = self.find(arg)
            if found.dimension is None or found.order is None:
                open_ = True
                continue
            dimension, order = dimension * found.dimension, order + found.order
            if found.kind or found.dimension or found.order:
                kinds.append(found.kind)
        if open_:
            return Found(None, "", None)
        return Found(dimension, kinds[0] if len(kinds) == 1 else "", order)

    def _power(self, e: Any) -> Found:
        base, exponent = self.find(e.base), self.find(e.exp)
        if exponent.dimension or exponent.order:
            return self._clash("exponent", e, f"the exponent {e.exp} is {describe(exponent)}", "a number")
        if base.dimension is None or base.order is None:
            return base
        if e.exp.is_Rational:
            p = Fraction(int(e.exp.p), int(e.exp.q))
            return Found(base.dimension**p, base.kind if p == 1 else "", base.order * p)
        if base.dimension or base.order:
            shown = f"{e.base} is {describe(base)}, and the exponent {e.exp} is not known"
            return self._clash("exponent", e, shown, "a base without unit, or a number as exponent")
        return Found()

    def _of_number(self, e: Any) -> Found:
        for arg in e.args:
            found = self.find(arg)
            if found.dimension or found.order:
                name = type(e).__name__
                hint = _cancel(found)
                self._clash(
                    "function", e, f"the argument {arg} of {name} is {describe(found)}", "a number", hint
                )
        return Found()

    def _quotient_of(self, e: Any) -> Found:
        """Treat atan2(y, x): both of one unit."""
        self._same(e)
        return Found()

    def _sign_of(self, e: Any) -> Found:
        for arg in e.args:
            self.find(arg)
        return Found()

    def _delta(self, e: Any) -> Found:
        found = self.find(e.args[0])
        return Found(None if found.dimension is None else found.dimension**-1)

    def _applied(self, e: Any) -> Found:
        meaning = self.notation.meanings.get(e.func)
        if meaning is None:
            return self._clash(
                "unknown", e, f"nothing says what {e.func} means", "a function of the notation"
            )
        for arg, wanted in zip(e.args, meaning.arguments, strict=False):
            found = self.find(arg)
            if found.dimension is not None and found.dimension != wanted:
                shown = f"the argument {arg} is {describe(found)}"
                self._clash("function", e, shown, describe(Found(wanted)))
        return Found(meaning.dimension, meaning.kind, meaning.order)

    def _integral(self, e: Any) -> Found:
        found = self.find(e.function)
        for limits in e.limits:
            variable = self.find(limits[0])
            for bound in limits[1:]:
                self._alike(
                    e, [(limits[0], variable), (bound, self.find(bound))], "a variable and its bounds"
                )
            found = self._times(found, variable, 1)
        return found

    def _derivative(self, e: Any) -> Found:
        found = self.find(e.expr)
        for variable, count in e.variable_count:
            found = self._times(found, self.find(variable), -int(count))
        return found

    def _times(self, found: Found, by: Found, power: int) -> Found:
        if found.dimension is None or by.dimension is None:
            return Found(None, "", None)
        kind = found.kind if not by.dimension and not by.kind else ""
        return Found(found.dimension * by.dimension**power, kind, found.order)

    def _indexed_sum(self, e: Any) -> Found:
        fresh = {limits[0] for limits in e.limits} - set(self.notation.meanings)
        self.indices |= fresh
        return self.find(e.function)

    def _limit(self, e: Any) -> Found:
        self._alike(e, [(e.args[1], self.find(e.args[1])), (e.args[2], self.find(e.args[2]))], "a limit")
        return self.find(e.args[0])

    def _at_point(self, e: Any) -> Found:
        pairs = zip(e.variables, e.point, strict=True)
        for variable, point in pairs:
            self._alike(e, [(variable, self.find(variable)), (point, self.find(point))], "a substitution")
        return self.find(e.expr)

    def _cases(self, e: Any) -> Found:
        for _, condition in e.args:
            self.find(condition)
        return self._alike(e, [(value, self.find(value)) for value, _ in e.args], "the cases")

    def _logic(self, e: Any) -> Found:
        for arg in e.args:
            self.find(arg)
        return Found()

    def _below(self, side: Any) -> list[str]:
        """Return the differentials of quantities that stand below a fraction bar."""
        symbols = sorted(sympy.fraction(side)[1].free_symbols, key=str)
        known = [(symbol, self.notation.meanings.get(symbol)) for symbol in symbols]
        return [str(symbol) for symbol, meaning in known if meaning and meaning.order and meaning.kind]

    def _relation(self, e: Any) -> Found:
        left, right = self.find(e.lhs), self.find(e.rhs)
        clash = equation_clash(left, right, self._below(e.lhs), self._below(e.rhs))
        if clash is not None:
            code, expected, hint = clash
            shown = f"the left side is {describe(left)}, the right side is {describe(right)}"
            self._clash(code, f"{e.lhs} {_SIGNS.get(e.rel_op, e.rel_op)} {e.rhs}", shown, expected, hint)
        return left if left.dimension is not None else right


_SIGNS = {"==": "=", "<=": "≤", ">=": "≥", "!=": "≠"}

_RULES: tuple[tuple[Any, str], ...] = (
    (sympy.Add, "sum"),
    (sympy.Mul, "product"),
    (sympy.Pow, "power"),
    (sympy.exp, "of_number"),
    (sympy.atan2, "quotient_of"),
    (_OF_NUMBERS, "of_number"),
    (_SAME, "same"),
    ((sympy.sign, sympy.Heaviside), "sign_of"),
    (sympy.DiracDelta, "delta"),
    (AppliedUndef, "applied"),
    (sympy.Integral, "integral"),
    (sympy.Derivative, "derivative"),
    (sympy.Sum, "indexed_sum"),
    (sympy.Limit, "limit"),
    (sympy.Subs, "at_point"),
    (sympy.Piecewise, "cases"),
    (_LOGIC, "logic"),
)


def _difference(left: Found, right: Found) -> str:
    if left.dimension is None or right.dimension is None:
        return ""
    return f"they differ by a factor in {left.dimension / right.dimension}"


def _cancel(found: Found) -> str:
    if found.order:
        return "a function takes no differential"
    if found.dimension == Dimension.of("sr"):
        return "divide by the unit solid angle Ω₀ = 1 sr"
    return f"divide by something in {found.dimension}"
