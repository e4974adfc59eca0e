"""Names: the misconceptions that an assignment can speak of in its hints, credit and variants."""

from __future__ import annotations

from collections.abc import Iterable

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.grading.judges.samplewords import SLIPS
from radiokit.faces.grading.question import Question
from radiokit.facts.errors import ParameterError, suggestion

__all__ = ["JUDGED", "check_names", "list_diagnoses"]

JUDGED = frozenset(
    {
        "argument-ignored",
        "arguments-swapped",
        "below",
        "beside-others",
        "constant-answer",
        "constant-rounded",
        "energy-holds",
        "gains-energy",
        "imprecise",
        "negative",
        "not-finite",
        "not-reciprocal",
        "not-repeatable",
        "not-the-model",
        "other-factor",
        "out-of-range",
        "reciprocity-holds",
        "single-precision",
        "slow",
        "unclear",
        "values-holds",
    }
)
"""What the judges find beside the misconceptions of the catalogue."""


def list_diagnoses() -> list[str]:
    """Return all that a judge can find: names for a question's hints, and for a judge's credit.

    They are those of ``rk.list_misconceptions()`` and what the judges find beside, such as lost digits, a law
    that is broken, or a standard error that is none.

    >>> {"pi-too-many", "imprecise", "not-reciprocal", "deviation-for-error"} <= set(list_diagnoses())
    True
    """
    return sorted({entry.name for entry in CATALOGUE} | SLIPS.keys() | JUDGED)


def check_names(questions: Iterable[Question]) -> None:
    """Check that every misconception that is named is one that a judge can find.

    That is one of the catalogue, one that the judges know, or a variant of any of the questions, for they may
    share their hints. What is no variant of the catalogue needs a hint: students are told that, not a name.
    A judge of one's own lists what it finds as ``diagnoses``.

    Raises
    ------
    ParameterError
        When one is not; the message names the question and suggests what may be meant.
    """
    questions = tuple(questions)
    worded = {entry.name for entry in CATALOGUE} | SLIPS.keys()
    known = worded | JUDGED
    for question in questions:
        for part in question.parts:
            known |= set(getattr(part.judge, "variants", ())) | set(getattr(part.judge, "diagnoses", ()))
    for question in questions:
        for part in question.parts:
            where = f"{question.name}, part {part.name}"
            for name in getattr(part.judge, "variants", ()):
                if name not in worded and name not in question.hints:
                    _refuse(f"{where}: variants", name, worded, "a known misconception, or one with a hint")
            for name in getattr(part.judge, "credit", ()):
                if not set(str(name).split(" + ")) <= known:
                    _refuse(f"{where}: credit", name, known, "for a known misconception or a variant")
        for name in question.hints:
            if not set(str(name).split(" + ")) <= known:
                _refuse(f"{question.name}: hints", name, known, "for a known misconception or a variant")


def _refuse(where: str, name: str, known: Iterable[str], allowed: str) -> None:
    guess = suggestion(str(name), sorted(known))
    raise ParameterError(where, name, f"{allowed}{guess or '; rk.grading.list_diagnoses() has them'}")
