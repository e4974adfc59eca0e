"""Verify: each step of a derivation checked for dimensions, and proved by SymPy or tried at 50 digits."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import sympy

from radiokit.facts.errors import ParameterError
from radiokit.facts.verdict import Outcome
from radiokit.measure.proof import TimeIsUp, time_limit
from radiokit.physics.relations.checker import check_dimensions
from radiokit.physics.relations.notation import Notation
from radiokit.physics.relations.numeric import DIGITS, compared, evaluated
from radiokit.physics.relations.proving import prepared, proof, sides
from radiokit.physics.relations.steps import Step

__all__ = ["NUMERICALLY", "Finding", "How", "verify"]

How = Literal["premise", "proved", "numerically at 50 digits", "refuted", "undecided"]

NUMERICALLY: How = "numerically at 50 digits"

_AGREE, _DIFFER = 1e-45, 1e-12  # relative, at 50 digits; between them nothing is said
_POINTS, _FEW, _ROUGH = 6, 2, 20  # points; points of a multiple integral; digits that refute

_GIVEN_UP = (
    ArithmeticError,
    NotImplementedError,
    RecursionError,
    TypeError,
    ValueError,
    sympy.PolynomialError,
)


@dataclass(frozen=True, kw_only=True)
class Finding:
    """What came of one step.

    Parameters
    ----------
    outcome : Outcome
    how : str
        ``premise``, ``proved``, ``numerically at 50 digits``, ``refuted`` or ``undecided``.
    message : str
        By which means, or what is wrong.
    seconds : float
    """

    outcome: Outcome
    how: How
    message: str = ""
    seconds: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Return the finding as JSON-ready data."""
        return {
            "outcome": str(self.outcome),
            "how": self.how,
            "message": self.message,
            "seconds": self.seconds,
        }


def verify(name: str, steps: Sequence[Step], notation: Notation) -> tuple[Finding, ...]:
    """Return a finding for each step; ``name`` seeds the random points."""
    findings = []
    for i, step in enumerate(steps):
        start = time.perf_counter()
        outcome, how, message = _step(f"{name} {i}", step, steps[:i], notation)
        seconds = time.perf_counter() - start
        findings.append(Finding(outcome=outcome, how=how, message=message, seconds=seconds))
    return tuple(findings)


def _step(name: str, step: Step, earlier: Sequence[Step], notation: Notation) -> tuple[Outcome, How, str]:
    checked = check_dimensions(step.relation, notation)
    if not checked.ok:
        return Outcome.VIOLATED, "refuted", str(checked)
    if step.premise:
        return Outcome.HOLDS, "premise", "taken as given; units, kinds and differentials agree"
    means = ""
    try:
        left, right = sides(step, earlier)
        with time_limit(step.seconds):
            means = proof(step, *prepared(step, left, right))
    except ParameterError as error:
        return Outcome.VIOLATED, "refuted", str(error)
    except (TimeIsUp, *_GIVEN_UP):
        pass  # numbers may still decide
    try:
        with time_limit(step.seconds):
            return _with_numbers(name, step, left, right, notation, means)
    except TimeIsUp:
        if means:
            return Outcome.HOLDS, "proved", means
        return Outcome.INCONCLUSIVE, "undecided", f"no proof and no number within {step.seconds:g} s"


def _with_numbers(
    name: str, step: Step, left: Any, right: Any, notation: Notation, means: str
) -> tuple[Outcome, How, str]:
    """Try the step in numbers: one point where there is a proof, more where there is none."""
    if not isinstance(step.relation, sympy.Eq):
        return _order_with_numbers(name, step, left, right, notation, means)
    nested = any(_nested(side) for side in (left, right))
    if means and nested and step.antiderivative is None:  # which may jump between the bounds
        return Outcome.HOLDS, "proved", means
    found = compared(left, right, name, notation.ranges, 1, _ROUGH)  # enough to refute
    points = _FEW if nested else _POINTS
    if found is not None and not means and found[0] <= _DIFFER:
        found = compared(left, right, name, notation.ranges, points, DIGITS)
    if found is None:
        if means:
            return Outcome.HOLDS, "proved", means
        return Outcome.INCONCLUSIVE, "undecided", "SymPy finds no proof, and it cannot be evaluated"
    worst, where = found
    if worst > _DIFFER:
        message = f"the sides differ by {worst:.2g} of their size at {_shown(where)}"
        return Outcome.VIOLATED, "refuted", message
    if means:
        return Outcome.HOLDS, "proved", means
    if worst < _AGREE:
        return Outcome.HOLDS, NUMERICALLY, f"agreement to {DIGITS} digits at {points} random points"
    return Outcome.INCONCLUSIVE, "undecided", f"the sides differ by {worst:.2g} of their size"


def _order_with_numbers(
    name: str, step: Step, left: Any, right: Any, notation: Notation, means: str
) -> tuple[Outcome, How, str]:
    """Look for a point where an inequality is false; none is no proof."""
    greater = isinstance(step.relation, (sympy.Ge, sympy.Gt))
    for first, second, where in evaluated(left, right, name, notation.ranges, _POINTS, _ROUGH) or ():
        beyond = float(second - first if greater else first - second)
        if beyond > _DIFFER * float(abs(first) + abs(second)):
            return Outcome.VIOLATED, "refuted", f"beyond the limit by {beyond:.2g} at {_shown(where)}"
    if means:
        return Outcome.HOLDS, "proved", means
    return Outcome.INCONCLUSIVE, "undecided", "the sign of the difference is not known"


def _shown(where: Mapping[str, float]) -> str:
    return ", ".join(f"{symbol} = {value:.4g}" for symbol, value in where.items())


def _nested(expression: Any) -> bool:
    """Return whether numbers would cost a multiple integral."""
    integrals = expression.atoms(sympy.Integral)
    return any(len(part.limits) > 1 or part.function.has(sympy.Integral) for part in integrals)
