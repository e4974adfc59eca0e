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

__all__ = ["NUMERICALLY", "Finding", "How", "verify", "verify_step"]

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
        outcome, how, message = verify_step(f"{name} {i}", step, steps[:i], notation)
        seconds = time.perf_counter() - start
        findings.append(Finding(outcome=outcome, how=how, message=message, seconds=seconds))
    return tuple(findings)


def verify_step(
    name: str, step: Step, earlier: Sequence[Step], notation: Notation
) -> tuple[Outcome, How, str]:
    """Return outcome, evidence and message of one step, given the earlier ones."""
    checked = check_dimensions(step.relation, notation)
    if not checked.ok:
        return Outcome.VIOLATED, "refuted", str(checked)
    if step.premise:
        return Outcome.HOLDS, "premise", "taken as given; units, kinds and differentials agree"
    try:
        left, right = sides(step, earlier)
        trial = _Trial(name, step, left, right, notation)
        wrong = "" if trial.costly else trial.refuted()
        means = "" if wrong else trial.means()
    except ParameterError as error:
        return Outcome.VIOLATED, "refuted", str(error)
    if not (wrong or means):
        wrong = trial.refuted()
    if wrong:
        return Outcome.VIOLATED, "refuted", wrong
    if means:
        return Outcome.HOLDS, "proved", means
    return trial.agreement()


@dataclass(frozen=True)
class _Trial:
    """A step with what was established put in, to be proved or tried in numbers, each within its time."""

    name: str
    step: Step
    left: Any
    right: Any
    notation: Notation

    @property
    def costly(self) -> bool:
        """Whether numbers need multiple integrals; an antiderivative, which may jump, is worth them."""
        integrals = self.left.atoms(sympy.Integral) | self.right.atoms(sympy.Integral)
        nested = any(len(part.limits) > 1 or part.function.has(sympy.Integral) for part in integrals)
        return nested and self.step.antiderivative is None

    def means(self) -> str:
        """Return by which means SymPy proves the step, or an empty string."""
        try:
            with time_limit(self.step.seconds):
                return proof(self.step, *prepared(self.step, self.left, self.right))
        except ParameterError:
            raise
        except (TimeIsUp, *_GIVEN_UP):
            return ""

    def refuted(self) -> str:
        """Return at which random point the step is false, or an empty string where none is found."""
        try:
            with time_limit(self.step.seconds):
                return self._refuted()
        except (TimeIsUp, *_GIVEN_UP):
            return ""

    def _refuted(self) -> str:
        name, ranges, relation = self.name, self.notation.ranges, self.step.relation
        if isinstance(relation, sympy.Eq):
            found = compared(self.left, self.right, name, ranges, 1, _ROUGH)
            if found is None:
                found = compared(self.left.doit(), self.right.doit(), name, ranges, 1, _ROUGH)
            worst, where = found or (0.0, {})
            return f"the sides differ by {worst:.2g} of their size{_at(where)}" if worst > _DIFFER else ""
        greater = isinstance(relation, (sympy.Ge, sympy.Gt))
        for first, second, where in evaluated(self.left, self.right, name, ranges, _POINTS, _ROUGH) or ():
            beyond = float(second - first if greater else first - second)
            if beyond > _DIFFER * float(abs(first) + abs(second)):
                return f"beyond the limit by {beyond:.2g}{_at(where)}"
        return ""

    def agreement(self) -> tuple[Outcome, How, str]:
        """Return whether the sides agree to all digits, for want of a proof."""
        if not isinstance(self.step.relation, sympy.Eq):
            return Outcome.INCONCLUSIVE, "undecided", "the sign of the difference is not known"
        points = _FEW if self.costly else _POINTS
        try:
            with time_limit(self.step.seconds):
                found = compared(self.left, self.right, self.name, self.notation.ranges, points, DIGITS)
        except (TimeIsUp, *_GIVEN_UP):
            found = None
        if found is None:
            message = f"SymPy finds no proof, and mpmath no number, within {self.step.seconds:g} s"
            return Outcome.INCONCLUSIVE, "undecided", message
        if found[0] < _AGREE:
            return Outcome.HOLDS, NUMERICALLY, f"agreement to {DIGITS} digits at {points} random points"
        return Outcome.INCONCLUSIVE, "undecided", f"the sides differ by {found[0]:.2g} of their size"


def _at(where: Mapping[str, float]) -> str:
    return " at " * bool(where) + ", ".join(f"{symbol} = {value:.4g}" for symbol, value in where.items())
