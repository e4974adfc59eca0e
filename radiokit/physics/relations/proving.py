"""Proving: what was established is put into a step, and SymPy shows that its sides agree."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import sympy
from sympy.core.function import AppliedUndef

from radiokit.facts.errors import ParameterError
from radiokit.physics.relations.steps import Step

__all__ = ["prepared", "proof", "put_in", "sides"]


def sides(step: Step, earlier: Sequence[Step]) -> tuple[Any, Any]:
    """Return both sides with what was established put in."""
    left, right = step.relation.lhs, step.relation.rhs
    for known in reversed(earlier):
        if known.relation.lhs == left and isinstance(known.relation, sympy.Eq):
            left = known.relation.rhs
            break
    for use in step.using:
        label, target = use if isinstance(use, tuple) else (use, None)
        known = _named(label, earlier)
        left, right = (put_in(side, known.relation, target) for side in (left, right))
    return left, right


def _named(label: str, earlier: Sequence[Step]) -> Step:
    for known in reversed(earlier):
        if known.name == label:
            return known
    names = ", ".join(known.name for known in earlier)
    raise ParameterError("using", label, f"the label of an earlier step ({names})")


def put_in(expression: Any, relation: Any, target: Any = None) -> Any:
    """Return ``expression`` with an equation put in: left side for right, or solved for ``target``.

    A function of symbols, f(x) = ..., is put in for every argument.

    >>> x, y = sympy.symbols("x y")
    >>> put_in(x**2, sympy.Eq(y, 3 * x), x)
    y**2/9
    """
    old, new = relation.lhs, relation.rhs
    if target is not None:
        unknown = sympy.Dummy(positive=target.is_positive)
        try:
            solutions = sympy.solve((old - new).subs(target, unknown), unknown)
        except NotImplementedError:
            solutions = []
        if len(solutions) != 1 or solutions[0].has(target):
            raise ParameterError("using", target, f"what {relation} has one solution for")
        old, new = target, solutions[0]
    if isinstance(old, AppliedUndef) and all(arg.is_Symbol for arg in old.args):

        def at(part: Any) -> Any:
            return new.subs(dict(zip(old.args, part.args, strict=True)), simultaneous=True)

        return expression.replace(lambda part: isinstance(part, AppliedUndef) and part.func == old.func, at)
    if not old.is_Symbol:
        expression = expression.xreplace({old: new})  # under an integral sign, too
    return expression.subs(old, new)


def prepared(step: Step, left: Any, right: Any) -> tuple[Any, Any]:
    """Return both sides after the step's change of variable, and with its antiderivative put in."""
    for new, old in step.change.items():
        right = right.replace(
            lambda part, new=new: isinstance(part, sympy.Integral) and part.variables == [new],
            lambda part, new=new, old=old: _pulled_back(part, new, old, left),
        )
    if step.antiderivative is not None:
        variable, function = step.antiderivative
        left, right = (
            side.replace(
                lambda part: isinstance(part, sympy.Integral) and part.variables[:1] == [variable],
                lambda part: _by_antiderivative(part, variable, function),
            )
            for side in (left, right)
        )
    return left, right


def _pulled_back(integral: Any, new: Any, old: Any, original: Any) -> Any:
    """Return an integral over ``new`` as one over the variable of ``original`` that ``old`` is made of."""
    ranges = [limits for part in original.atoms(sympy.Integral) for limits in part.limits if len(limits) == 3]
    of_old = [limits for limits in ranges if old.has(limits[0])]
    if not of_old:
        raise ParameterError("change", old, "in the variable of an integral on the left")
    variable, low, high = of_old[0]
    _, start, end = integral.limits[0]
    at_low, at_high = sympy.limit(old, variable, low), sympy.limit(old, variable, high)
    integrand = integral.function.subs(new, old) * sympy.diff(old, variable)
    if _is_zero(at_low - start) and _is_zero(at_high - end):
        return sympy.Integral(integrand, (variable, low, high))
    if _is_zero(at_low - end) and _is_zero(at_high - start):
        return sympy.Integral(-integrand, (variable, low, high))
    raise ParameterError("change", f"{new} from {start} to {end}", f"from {at_low} to {at_high}")


def _by_antiderivative(integral: Any, variable: Any, function: Any) -> Any:
    """Return an integral with its innermost one evaluated, once the antiderivative's slope is proved."""
    (_, low, high), *rest = integral.limits
    if not _is_zero(sympy.diff(function, variable) - integral.function):
        raise ParameterError("antiderivative", function, f"one whose derivative is {integral.function}")
    value = function.subs(variable, high) - function.subs(variable, low)
    return sympy.Integral(value, *rest) if rest else value


def proof(step: Step, left: Any, right: Any) -> str:
    """Return by which means SymPy proves the step, or an empty string."""
    if not isinstance(step.relation, sympy.Eq):
        return _proved_order(step.relation, left, right)
    means = ["substitution"] if step.using else []
    means += ["change of variable"] if step.change else []
    means += ["antiderivative"] if step.antiderivative is not None else []
    difference = left - right
    if _is_zero(difference):
        return ", ".join(means) or "algebra"
    kinds: dict[str, Any] = {
        "integration": sympy.Integral,
        "differentiation": sympy.Derivative,
        "limit": sympy.Limit,
        "summation": sympy.Sum,
    }
    means += [word for word, kind in kinds.items() if difference.has(kind)]
    attempts: tuple[Callable[[Any], Any], ...] = (_merged, lambda e: _merged(e.doit(integrals=False)), _done)
    for attempt in attempts:
        if _is_zero(attempt(difference)):
            return ", ".join(means) or "algebra"
    return ""


def _done(expression: Any) -> Any:
    return expression.doit()


def _proved_order(relation: Any, left: Any, right: Any) -> str:
    difference = right - left if isinstance(relation, (sympy.Le, sympy.Lt)) else left - right
    strict = isinstance(relation, (sympy.Lt, sympy.Gt))
    forms: tuple[Callable[[Any], Any], ...] = (_done, sympy.factor, sympy.simplify)
    for form in forms:
        shown = form(difference)
        if shown.is_positive or (not strict and shown.is_nonnegative):
            return "the sign of the difference"
    return ""


def _merged(expression: Any) -> Any:
    """Return a sum whose integrals, or sums, over the same range are one, and drop out if that is 0."""
    total: Any = sympy.Integer(0)
    collected: dict[Any, Any] = {}
    for term in sympy.Add.make_args(sympy.expand(expression)):
        coefficient, rest = term.as_independent(sympy.Integral, sympy.Sum, as_Add=False)
        if isinstance(rest, (sympy.Integral, sympy.Sum)):
            key = rest.func, rest.limits
            collected[key] = collected.get(key, 0) + coefficient * rest.function
        else:
            total += term
    for (kind, limits), inner in collected.items():
        if not _is_zero(inner):
            total += kind(inner, *limits)
    return total


def _is_zero(expression: Any) -> bool:
    """Return whether a normal form of SymPy's is 0."""
    if expression == 0:
        return True
    if expression.has(sympy.Integral, sympy.Limit, sympy.Sum, sympy.Derivative):
        return bool(sympy.expand(expression) == 0)
    forms: Mapping[str, Callable[[Any], Any]] = {
        "expand": sympy.expand,
        "together": lambda e: sympy.expand(sympy.numer(sympy.together(e))),
        "simplify": sympy.simplify,
        "trigsimp": lambda e: sympy.trigsimp(sympy.expand(e, trig=True)),
        "exponentials": lambda e: sympy.simplify(e.rewrite(sympy.exp)),
    }
    return any(form(expression) == 0 for form in forms.values())
