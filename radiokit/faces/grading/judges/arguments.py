"""Arguments: the mistakes that a reference itself can show: two arguments exchanged, or one not used."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import combinations
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.misconception import LANGUAGES, Guess, Misconception, structural
from radiokit.faces.diagnosis.problem import Problem
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.words import say

__all__ = ["argument_mistakes"]


def argument_mistakes(
    reference: Callable[..., Any], given: Mapping[str, Array], right: Array
) -> tuple[Misconception, Misconception]:
    """Return the misconceptions that two arguments are exchanged, and that one is not used.

    Where ``reference(**given)`` is ``right``, they give what it is for exchanged arguments, and for a 1 in
    the place of one.
    """

    def explained(changes: Iterable[tuple[str, dict[str, Array]]]) -> Callable[[Problem], Iterable[Guess]]:
        def explain(problem: Problem) -> Iterable[Guess]:
            for detail, changed in changes:
                try:
                    values = np.asarray(reference(**{**given, **changed}), dtype=float)
                except Exception:  # out of its domain: then this is not what happened
                    continue
                if values.shape == right.shape:
                    yield Guess(values[problem.index], detail=detail)

        return explain

    alike = [(a, b) for a, b in combinations(given, 2) if given[a].shape == given[b].shape]
    swaps = [(f"{a} ↔ {b}", {a: given[b], b: given[a]}) for a, b in alike]
    ones = [(name, {name: np.ones_like(value)}) for name, value in given.items() if value.ndim == 1]
    swapped = [say(language, "swapped") for language in LANGUAGES]
    ignored = [say(language, "ignored") for language in LANGUAGES]
    return (
        structural("arguments-swapped", explained(swaps), swapped[0], swapped[1], prior=0.5),
        structural("argument-ignored", explained(ones), ignored[0], ignored[1], prior=0.05),
    )
