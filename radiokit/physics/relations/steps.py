"""Steps: the premises of a derivation and what follows from them, each as data that a machine can verify."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy

__all__ = ["Step", "eq", "follows", "holds", "premise"]


@dataclass(frozen=True, kw_only=True)
class Step:
    """One line of a derivation.

    Parameters
    ----------
    relation : sympy.Eq, or an inequality
        Its left side takes its last established value; what is left to prove is that the two sides agree.
    why : str
        The justification, in words.
    label : str
        By which later steps refer to it; for an equation whose left side is a symbol, that symbol's name.
    premise : bool
        A definition or a law of physics: not proved, and listed as what it is.
    using : tuple of str or (str, sympy.Expr)
        Labels of earlier equations that are put in, in this order: their left side is replaced by their
        right side, or the equation is solved for the expression that stands beside the label.
    change : mapping
        New variable to its expression in the old one: a change of variable under the integral.
    antiderivative : (sympy.Symbol, sympy.Expr), optional
        Of the integrand in that variable; its derivative is checked, then its values at the bounds are used.
    seconds : float
        The time limit.
    """

    relation: Any
    why: str
    label: str = ""
    premise: bool = False
    using: tuple[str | tuple[str, Any], ...] = ()
    change: Mapping[Any, Any] = field(default_factory=dict)
    antiderivative: tuple[Any, Any] | None = None
    seconds: float = 60.0

    @property
    def name(self) -> str:
        """The label, or the left side where there is none."""
        return self.label or str(self.relation.lhs)

    def content(self) -> str:
        """Return all that decides whether the step holds, as text."""
        parts: list[Any] = [self.premise, self.using, sorted(self.change.items(), key=str)]
        parts += [self.antiderivative]
        return sympy.srepr(self.relation) + "".join(map(sympy.srepr, map(_plain, parts)))


def _plain(value: Any) -> Any:
    if isinstance(value, (tuple, list)):
        return tuple(map(_plain, value))
    return value


def eq(left: Any, right: Any) -> Any:
    """Return an equation that SymPy leaves as it is written.

    >>> eq(sympy.Integer(1), sympy.Integer(1))
    Eq(1, 1)
    """
    return sympy.Eq(sympy.sympify(left), sympy.sympify(right), evaluate=False)


def premise(left: Any, right: Any, why: str, label: str = "") -> Step:
    """Return a definition or a law that the derivation starts from."""
    return Step(relation=eq(left, right), why=why, label=label, premise=True)


def follows(
    left: Any,
    right: Any,
    why: str,
    *using: str | tuple[str, Any],
    label: str = "",
    change: Mapping[Any, Any] | None = None,
    antiderivative: tuple[Any, Any] | None = None,
) -> Step:
    """Return an equation that follows from earlier ones; ``using`` names those that are put in."""
    return Step(
        relation=eq(left, right),
        why=why,
        label=label,
        using=tuple(using),
        change=change or {},
        antiderivative=antiderivative,
    )


def holds(relation: Any, why: str, *using: str | tuple[str, Any], label: str = "") -> Step:
    """Return an inequality that follows from earlier steps."""
    return Step(relation=relation, why=why, label=label or "limit", using=tuple(using))
