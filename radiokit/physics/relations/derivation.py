"""Derivation: a formula, its premises and its steps, their findings, and how they are shown."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from typing import Any

from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness
from radiokit.physics.relations.notation import Notation
from radiokit.physics.relations.steps import Step
from radiokit.physics.relations.verify import NUMERICALLY, Finding, How, verify

__all__ = ["Derivation", "Finding"]

_EVIDENCE: dict[How, Evidence] = {
    "proved": Evidence.PROVED,
    NUMERICALLY: Evidence.MEASURED,
    "undecided": Evidence.MEASURED,
    "refuted": Evidence.REFUTED,
}


@dataclass(frozen=True, kw_only=True)
class Derivation:
    """A formula and how it follows, step by step.

    Parameters
    ----------
    name : str
        As ``radiokit.derive`` takes it.
    title : str
    statement : str
        What is shown, in words.
    assumptions : tuple of str
        Under which it holds.
    notation : Notation
        What the symbols mean.
    steps : tuple of Step
        The last one's relation is the result.
    source : Source
    tags : tuple of str
    findings : tuple of Finding
        One for each step, once verified.
    """

    name: str
    title: str
    statement: str
    notation: Notation
    steps: tuple[Step, ...]
    source: Source
    assumptions: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()

    def __post_init__(self) -> None:
        if not self.steps or self.steps[-1].premise:
            raise ParameterError("steps", f"of {self.name}", "ended by a step that follows")

    @property
    def result(self) -> Any:
        """The relation that the last step establishes."""
        return self.steps[-1].relation

    @property
    def premises(self) -> tuple[Step, ...]:
        """The definitions and laws that are taken as given."""
        return tuple(step for step in self.steps if step.premise)

    def verified(self) -> Derivation:
        """Return the derivation with every step verified anew."""
        return replace(self, findings=verify(self.name, self.steps, self.notation))

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of the steps; inconclusive before they are verified."""
        found = {finding.outcome for finding in self.findings}
        for outcome in (Outcome.VIOLATED, Outcome.INCONCLUSIVE):
            if outcome in found:
                return outcome
        return Outcome.HOLDS if self.findings else Outcome.INCONCLUSIVE

    @property
    def ok(self) -> bool:
        """True when every step is verified."""
        return self.outcome is Outcome.HOLDS

    @property
    def counts(self) -> tuple[int, int]:
        """How many steps were proved symbolically, and how many there are besides the premises."""
        return (
            sum(finding.how == "proved" for finding in self.findings),
            sum(not step.premise for step in self.steps),
        )

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """A verdict for each step that is verified; premises have none, unless their units clash."""
        pairs = zip(self.steps, self.findings, strict=False)
        return tuple(
            Verdict(
                check=f"{self.name}, step {i}",
                claim=str(step.relation),
                outcome=finding.outcome,
                evidence=_EVIDENCE[finding.how],
                message=finding.message,
                witness=Witness(values={"step": i}) if finding.outcome is Outcome.VIOLATED else None,
                seconds=finding.seconds,
            )
            for i, (step, finding) in enumerate(pairs, start=1)
            if finding.how != "premise"
        )

    @property
    def verdict(self) -> Verdict:
        """The claim that all steps hold; ``proved`` when none rests on numbers."""
        hows = {finding.how for finding in self.findings}
        evidence = Evidence.MEASURED if hows & {NUMERICALLY, "undecided"} or not hows else Evidence.PROVED
        wrong = [
            f"step {i} ({step.relation}): {finding.message}"
            for i, (step, finding) in enumerate(zip(self.steps, self.findings, strict=False), start=1)
            if finding.outcome is not Outcome.HOLDS
        ]
        proved, count = self.counts
        message = "; ".join(wrong) or f"{proved} of {count} steps proved symbolically"
        violated = self.outcome is Outcome.VIOLATED
        return Verdict(
            check="derivation",
            claim=self.statement,
            outcome=self.outcome,
            evidence=Evidence.REFUTED if violated else evidence,
            message=message if self.findings else "not verified yet",
            witness=Witness(values={"step": wrong[0]}) if violated else None,
            seconds=sum(finding.seconds for finding in self.findings),
            details={"derivation": self.name, "proved": proved, "steps": count},
        )

    def fingerprint(self) -> str:
        """Return a hash of all that decides whether the steps hold."""
        parts = [self.name, *(step.content() for step in self.steps)]
        parts += [f"{symbol} {meaning}" for symbol, meaning in self.notation.meanings.items()]
        parts += [f"{symbol} {limits}" for symbol, limits in self.notation.ranges.items()]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()

    def latex(self) -> str:
        """Return the steps as an aligned environment, each with its justification."""
        from radiokit.physics.relations.rendering import aligned

        return aligned(self)

    def _repr_latex_(self) -> str:
        return f"$$\n{self.latex()}\n$$"

    def _repr_markdown_(self) -> str:
        from radiokit.physics.relations.rendering import markdown

        return markdown(self)

    def __str__(self) -> str:
        from radiokit.physics.relations.rendering import plain

        return plain(self)

    def __repr__(self) -> str:
        return f"<Derivation {self.name!r}: {self.outcome if self.findings else 'not verified'}>"

    def to_json(self) -> dict[str, Any]:
        """Return the derivation and its findings as JSON-ready data."""
        proved, count = self.counts
        findings = self.findings or (None,) * len(self.steps)
        return {
            "name": self.name,
            "title": self.title,
            "statement": self.statement,
            "assumptions": list(self.assumptions),
            "symbols": [self.notation.describe(symbol) for symbol in self.notation.meanings],
            "steps": [
                {
                    "relation": str(step.relation),
                    "latex": self.notation.latex(step.relation),
                    "why": step.why,
                    "premise": step.premise,
                    "finding": None if finding is None else finding.to_json(),
                }
                for step, finding in zip(self.steps, findings, strict=True)
            ],
            "result": self.notation.latex(self.result),
            "source": self.source.to_json(),
            "tags": list(self.tags),
            "outcome": str(self.outcome),
            "proved": proved,
            "to_prove": count,
        }
