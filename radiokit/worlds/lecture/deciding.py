"""Deciding: the kinds of checks that judge a line of the lecture, and how they say what they found."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.quantities import Q, quantity
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness

__all__ = ["Case", "Derived", "Evaluated", "Experiment", "Formula", "Term", "Unit", "found"]


def found(claim: str, value: float, expected: float, within: float, message: str = "") -> Verdict:
    """Return whether ``value`` lies within ``within`` of ``expected``, with the numbers as evidence.

    >>> found("two and two are four", 2 + 2, 4, 0).outcome.value
    'holds'
    >>> print(found("two and two are five", 2 + 2, 5, 0.5).witness)
    found = 4.0, expected = 5.0
    """
    value, expected = float(value), float(expected)
    holds = abs(value - expected) <= within
    return Verdict(
        check="experiment",
        claim=claim,
        outcome=Outcome.HOLDS if holds else Outcome.VIOLATED,
        evidence=Evidence.BOUNDED if holds else Evidence.REFUTED,
        message=message or f"{value:.6g} where {expected:.6g} is expected",
        witness=None if holds else Witness(values={"found": value, "expected": expected}),
        details={"found": value, "expected": expected, "within": within},
    )


@dataclass(frozen=True)
class Formula:
    """The dimension checker on the printed formula.

    Parameters
    ----------
    symbols : mapping
        As ``printed.read`` takes them.
    latex : str
        The formula that a sentence says, where none is printed.
    """

    symbols: Mapping[str, str] = field(default_factory=dict)
    latex: str = ""

    how = "dimension checker"

    def judge(self, printed: str) -> Verdict:
        """Parse the formula, and walk it."""
        from radiokit.worlds.lecture.printed import clashes, read

        latex = self.latex or printed
        clash = [str(one) for one in clashes(read(latex, self.symbols))]
        return Verdict(
            check="dimensions",
            claim=f"units, kinds and differentials agree in {latex}",
            outcome=Outcome.VIOLATED if clash else Outcome.HOLDS,
            evidence=Evidence.REFUTED if clash else Evidence.PROVED,
            message="; ".join(clash) or "units, kinds and differentials agree",
            witness=Witness(values={"formula": latex, "clash": "; ".join(clash)}) if clash else None,
        )


@dataclass(frozen=True)
class Evaluated:
    """The printed formula in numbers: all its sides agree when measured values are put in.

    Parameters
    ----------
    numbers : callable
        Returns the value of each symbol; one with indices that is not named has the value without them.
    settings : mapping
        Its keywords.
    symbols : mapping
        As ``printed.read`` takes them.
    within : float
        The relative difference allowed: a differential is a small number here.
    """

    numbers: Callable[..., Mapping[str, float]]
    settings: Mapping[str, Any] = field(default_factory=dict)
    symbols: Mapping[str, str] = field(default_factory=dict)
    within: float = 1e-5

    how = "numbers in the formula"

    def judge(self, printed: str) -> Verdict:
        """Put the numbers in."""
        from radiokit.worlds.lecture.printed import read, values

        try:
            reading = read(printed, self.symbols)
            sides = values(reading, self.numbers(**self.settings))
        except ParameterError as error:  # a symbol that was not measured
            return Verdict(
                check="experiment",
                claim=f"in numbers, both sides agree: {printed}",
                outcome=Outcome.INCONCLUSIVE,
                evidence=Evidence.MEASURED,
                message=error.message,
            )
        within = self.within * abs(sides[0])
        off = [_excess(sides[0], sign, value) for sign, value in zip(reading.signs, sides[1:], strict=True)]
        message = f"in numbers the sides are {', '.join(f'{value:.6g}' for value in sides)}"
        return found(f"in numbers, the sides agree: {printed}", max(off), 0.0, within, message)


def _excess(left: float, sign: str, right: float) -> float:
    """Return by how much two sides break their sign."""
    return {"=": abs(left - right), "≤": max(0.0, left - right), "≥": max(0.0, right - left)}[sign]


@dataclass(frozen=True)
class Term:
    """A Russian term means the quantity that the English one beside it means."""

    russian: str
    english: str

    how = "terms of the standard"

    def judge(self, printed: str) -> Verdict:
        """Look both up."""
        claim = f"«{self.russian}» is {self.english}"
        wanted = quantity(self.english)
        try:
            means = quantity(self.russian)
        except LookupError:
            return self._verdict(claim, f"«{self.russian}» is no term of the standard", wanted)
        if means.name == wanted.name:
            return self._verdict(claim, "", wanted)
        return self._verdict(claim, f"«{self.russian}» is {means.english} [{means.unit}]", wanted)

    def _verdict(self, claim: str, wrong: str, wanted: Any) -> Verdict:
        right = f"{wanted.english} [{wanted.unit}] is «{wanted.russian}»"
        return Verdict(
            check="term",
            claim=claim,
            outcome=Outcome.VIOLATED if wrong else Outcome.HOLDS,
            evidence=Evidence.REFUTED if wrong else Evidence.PROVED,
            message=f"{wrong}; {right}" if wrong else right,
            witness=Witness(values={"term": self.russian, "finding": wrong}) if wrong else None,
        )


@dataclass(frozen=True)
class Unit:
    """A printed unit is read, and is the unit of the quantity."""

    quantity: str
    unit: str = ""

    how = "dimension checker"

    def judge(self, printed: str) -> Verdict:
        """Read the unit, and compare its dimension."""
        unit = self.unit or printed
        kind = quantity(self.quantity)
        claim = f"{unit} is a unit of {kind.english}"
        try:
            kind(f"1 {unit}")
        except RadiokitError as error:
            return Verdict(
                check="unit",
                claim=claim,
                outcome=Outcome.VIOLATED,
                evidence=Evidence.REFUTED,
                message=f"{error.message}; {kind.english} is in {kind.unit}",
                witness=Witness(values={"unit": unit, "finding": error.message}),
            )
        return Verdict(
            check="unit",
            claim=claim,
            outcome=Outcome.HOLDS,
            evidence=Evidence.PROVED,
            message=f"{unit} has the dimension of {Q(kind.unit).units}",
        )


@dataclass(frozen=True)
class Derived:
    """A derivation whose every step is verified."""

    name: str

    @property
    def how(self) -> str:
        """Name the derivation."""
        return f"derivation {self.name}"

    def judge(self, printed: str) -> Verdict:
        """Verify it, or remember that it was."""
        from radiokit.physics.relations import derive

        return derive(self.name).verdict


@dataclass(frozen=True)
class Case:
    """A closed-form case, answered by a method."""

    name: str
    method: str = "quadrature"

    @property
    def how(self) -> str:
        """Name the case."""
        return f"case {self.name}"

    def judge(self, printed: str) -> Verdict:
        """Answer it."""
        from radiokit.worlds.cases.catalogue import case

        return case(self.name).verdict(self.method, 0)


@dataclass(frozen=True)
class Experiment:
    """A numeric experiment with radiokit; ``settings`` are its keywords."""

    run: Callable[..., Verdict | Sequence[Verdict]]
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def how(self) -> str:
        """Name the experiment."""
        return f"experiment {self.run.__name__}"

    def judge(self, printed: str) -> Verdict:
        """Run it; of several findings the first that does not hold counts."""
        start = time.perf_counter()
        result = self.run(**self.settings)
        verdicts = (result,) if isinstance(result, Verdict) else tuple(result)
        wrong = [verdict for verdict in verdicts if not verdict.ok]
        message = "; ".join(verdict.message for verdict in wrong or verdicts)
        return replace((wrong or list(verdicts))[0], message=message, seconds=time.perf_counter() - start)
