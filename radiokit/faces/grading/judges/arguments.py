"""Arguments: mistakes that a reference itself can show: two exchanged, one not used, or in degrees."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import combinations
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.misconception import LANGUAGES, Guess, Misconception, structural
from radiokit.faces.diagnosis.problem import Problem
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.words import say

__all__ = ["argument_mistakes"]

(_UNIT,) = (each for each in CATALOGUE if each.name == "angle-unit")


def argument_mistakes(
    reference: Callable[..., Any], given: Mapping[str, Array], right: Array, known: Iterable[str] = ()
) -> tuple[Misconception, ...]:
    """Return the misconceptions that two arguments are exchanged, that one is not used, or is in degrees.

    Where ``reference(**given)`` is ``right``, they give what it is for exchanged arguments, for a 1 in the
    place of one, and for an angle, by its name, in another unit; the catalogue knows ``theta`` alone.
    What is ``known`` to the question by the same name is left to it.
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
    angles = [name for name in given if "angle" in name and given[name].ndim == 1]
    units = [(name, {name: scale * given[name]}) for name in angles for scale in (180 / np.pi, np.pi / 180)]
    swapped = [say(language, "swapped") for language in LANGUAGES]
    ignored = [say(language, "ignored") for language in LANGUAGES]
    found = (
        structural("arguments-swapped", explained(swaps), swapped[0], swapped[1], prior=0.5),
        structural("argument-ignored", explained(ones), ignored[0], ignored[1], prior=0.05),
        structural(_UNIT.name, explained(units), _UNIT.en, _UNIT.ru),
    )
    return tuple(each for each in found if each.name not in known)
