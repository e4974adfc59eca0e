"""Unfound: hints and credit for misconceptions that an assignment's inputs can never show."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.problem import canonical, columns
from radiokit.faces.grading.assignment import Assignment, student_rng
from radiokit.faces.grading.judges.estimator import Estimator
from radiokit.faces.grading.judges.given import drawn, own
from radiokit.faces.grading.judges.samplewords import SLIPS
from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part, Question

__all__ = ["unfound"]

NEEDS: Mapping[str, tuple[str, ...]] = {
    entry.name: entry.needs for entry in CATALOGUE if entry.kind == "varying" and entry.name not in SLIPS
}
"""By which inputs each misconception is told whose factor follows from them."""


def unfound(assignment: Assignment) -> Iterator[str]:
    """Yield what is said of hints and credit that no answer will ever get.

    A misconception such as a forgotten density is told by numbers that are named ``pdf``, among the inputs or
    in the context.

    >>> from radiokit.faces.grading.assignment import load_assignment
    >>> list(unfound(load_assignment("radiometry")))
    []
    """
    for question in assignment.questions:
        seen = {
            part.name: _seen(assignment, question, part)
            for part in question.parts
            if isinstance(part.judge, Values | Estimator)
        }
        for part in question.parts:
            if part.name in seen:
                where = f"question {question.name}, part {part.name}: credit"
                yield from _missing(where, part.judge.credit, seen[part.name])  # type: ignore[attr-defined]
        if len(seen) == len(question.parts):
            yield from _missing(
                f"question {question.name}: hints", question.hints, set().union(*seen.values())
            )


def _seen(assignment: Assignment, question: Question, part: Part) -> set[str]:
    """Return the names by which the catalogue knows what a judge gives to it, and its own variants."""
    judge: Any = part.judge
    given = drawn(judge.inputs, student_rng(assignment, question, part), rows=isinstance(judge, Values))
    context = own("context", judge.context, **given) if judge.context is not None else {}
    more = {"samples": judge.samples} if isinstance(judge, Estimator) else {}
    first = {
        name: np.ravel(value)[:1] if name not in ("wi", "wo") else np.reshape(value, (-1, 3))[:1]
        for name, value in {**given, **context, **more}.items()
    }
    return {*canonical(columns(first, 1)), *judge.variants}


def _missing(where: str, asked: Mapping[str, Any], seen: set[str]) -> Iterator[str]:
    for name in asked:
        for each in str(name).split(" + "):
            lacks = [need for need in NEEDS.get(each, ()) if need not in seen]
            if lacks and each not in seen:
                told = f"it is told by {' and '.join(lacks)}, which neither inputs nor context give"
                yield f"{where} for {name!r} can come to nobody: {told}"
