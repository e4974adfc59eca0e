"""Explained: which misconception explains wrong numbers, the catalogue's or an assignment's, in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.diagnose import diagnose
from radiokit.faces.diagnosis.result import Diagnosis
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.arguments import argument_mistakes
from radiokit.faces.grading.judges.asking import close
from radiokit.faces.grading.judges.digits import DOUBLE, FEWEST, SINGLE
from radiokit.faces.grading.judges.evidence import clause, guesses, hint_for
from radiokit.faces.grading.judges.given import numbers, own
from radiokit.faces.grading.words import say

__all__ = ["SURE", "diagnosed", "exactly", "worded", "words_of"]

Variants = Mapping[str, Callable[..., Any]]
Hints = Mapping[str, Mapping[str, str]]

SURE = 0.5
"""From which confidence on a misconception is named alone."""
NEAR = 0.01
"""How much nearer to a variant than to what is right an answer must be, to be that variant."""


def diagnosed(
    answer: Array,
    right: Array,
    given: Mapping[str, Array],
    reference: Callable[..., Any],
    *,
    context: Callable[..., Mapping[str, Any]] | None,
    variants: Variants,
    rtol: float,
    language: str,
) -> tuple[Diagnosis, int]:
    """Return what explains the answers or, if nothing does, those where the right one is not 0.

    In that case also at how many inputs 0 is right and the answer is not, if it is so at all of these.
    """
    size = len(right)
    more = dict(own("context", context, **given)) if context is not None else {}
    every = {**given, **more}
    columns = {name: value for name, value in every.items() if _is_column(name, value, size)}
    others = {
        name: numbers(own(f"variants[{name!r}]", variant, **given), f"variants[{name!r}]")
        for name, variant in variants.items()
    }
    rtol = min(max(rtol, SINGLE if answer.dtype == np.float32 else DOUBLE), 0.1)
    answer = answer.astype(float)

    def reference_at(**inputs: Any) -> Any:
        try:  # out of its domain it may give anything, which then explains nothing
            values = np.asarray(reference(**{n: inputs.get(n, given[n]) for n in given}), dtype=float)
        except Exception:
            return np.full(size, math.nan)
        return values if values.shape == right.shape else np.full(size, math.nan)

    found: Diagnosis | None = None
    usual = (*CATALOGUE, *argument_mistakes(reference, given, right, variants))
    for each in ([others] if others else []) + [reference_at]:
        found = diagnose(
            answer, right, inputs=columns, variants=each, language=language, rtol=rtol, catalogue=usual
        )
        if found.right or found.suspicions:
            return found, 0
    assert found is not None
    lit = right != 0
    if lit.all() or np.count_nonzero(lit & (answer != 0)) < FEWEST:
        return found, 0
    lit_given = {name: value[lit] if value.ndim else value for name, value in given.items()}
    partly = diagnose(
        answer[lit],
        right[lit],
        inputs={name: value[lit] if np.ndim(value) else value for name, value in columns.items()},
        variants={name: values[lit] for name, values in others.items()},
        language=language,
        rtol=rtol,
        catalogue=(*CATALOGUE, *argument_mistakes(reference, lit_given, right[lit], variants)),
    )
    if not partly.suspicions:
        return found, 0
    return partly, int(np.count_nonzero(~lit)) if answer[~lit].all() else 0


def exactly(
    answer: Array, right: Array, given: Mapping[str, Array], variants: Variants, allowed: Array
) -> str:
    """Return the variant that an answer is, if that is far nearer to it than what is right; "" for none."""
    for name, variant in variants.items():
        values = np.asarray(own(f"variants[{name!r}]", variant, **given), dtype=float)
        if values.shape != right.shape or close(values, right, allowed).all():
            continue
        slack = NEAR * np.abs(values - right) + 8 * np.spacing(np.abs(values))
        if np.all(np.abs(answer.astype(float) - values) <= slack):
            return name
    return ""


def worded(found: Diagnosis, hints: Hints, language: str, *, shown: bool) -> str:
    """Return what is said of a diagnosis: one misconception, two at once, or which ones it may be.

    Of several pairs that have one part in common, that is what is said.
    """
    first = found.first
    assert first is not None
    if first.confidence >= SURE and not found.ambiguous:
        if _is_pair(first.name, hints):
            return say(language, "both", names=_named(first, hints, language, shown=shown))
        return hint_for(first, hints, language, shown=shown)
    pairs = [set(each.name.split(" + ")) for each in found.suspicions if each.name in found.ambiguous]
    common = set.intersection(*pairs) if len(pairs) > 1 else set()
    if common:
        return guesses([clause(words_of(min(common), hints, language))], language)
    return guesses([_named(each, hints, language, shown=shown) for each in found.suspicions[:2]], language)


def words_of(name: str, hints: Hints, language: str) -> str:
    """Return what is said of one misconception: the question's own hint, or the catalogue's.

    >>> words_of("halved", {"halved": {"en": "It is half."}}, "en")
    'It is half.'
    """
    if name in hints:
        return hints[name][language]
    return next((entry.hint(language) for entry in CATALOGUE if entry.name == name), name)


def _is_pair(name: str, hints: Hints) -> bool:
    return " + " in name and name not in hints


def _named(suspicion: Any, hints: Hints, language: str, *, shown: bool) -> str:
    """Return what a suspicion's words say before they explain; of a pair what both do."""
    if not _is_pair(suspicion.name, hints):
        return clause(hint_for(suspicion, hints, language, shown=shown))
    return " + ".join(clause(words_of(name, hints, language)) for name in suspicion.name.split(" + "))


def _is_column(name: str, value: Any, size: int) -> bool:
    """Return whether the diagnosis can take an input."""
    fits = np.shape(value) in ((), (size,)) or (name in ("wi", "wo") and np.shape(value) == (size, 3))
    return fits and bool(np.isfinite(value).all())
