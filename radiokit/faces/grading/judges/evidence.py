"""Evidence: what is said of wrong numbers beside the misconception: how many, where, and what comes out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from radiokit.faces.grading.isolation.protocol import Array, plain_text
from radiokit.faces.grading.russian import translated
from radiokit.faces.grading.words import say, sentence

__all__ = ["LONGEST", "at", "clause", "guesses", "hint_for", "joined", "rows", "wrong_at"]

LONGEST = 300
"""How many characters a text for a student should have at most."""
TELLING = ("offset",)
"""Misconceptions whose detail would give a right value away."""
PLAIN = (
    "horizon-not-clamped",
    "degrees-for-radians",
    "distance-doubled",
    "square-root",
    "squared",
    "reciprocal",
    "one-minus",
    "truncated-to-integer",
    "rounded",
)
"""Misconceptions whose detail says no more than their words and the evidence."""


def rows(bad: Array) -> int:
    """Return at how many inputs something is so, of an array of one row for each.

    >>> rows(np.array([[True, True], [False, False]]))
    1
    """
    return int(np.count_nonzero(bad.reshape(len(bad), -1).any(axis=1)))


def joined(*sentences: str) -> str:
    """Return sentences in a row, the first one anyway and each further one while there is room for it.

    >>> joined("one thing", "another.", "")
    'One thing. Another.'
    """
    text = ""
    for each in filter(None, sentences):
        more = f"{text} {sentence(each)}".strip()
        if not text or len(more) <= LONGEST:
            text = more
    return text if len(text) <= LONGEST else plain_text(text, LONGEST)


def clause(text: str) -> str:
    """Return what a sentence says before it explains.

    >>> clause("You forgot the cosine: light spreads.")
    'You forgot the cosine'
    """
    return text.split(": ")[0].split("; ")[0].rstrip(".")


def hint_for(
    suspicion: Any, hints: Mapping[str, Mapping[str, str]], language: str, *, shown: bool = True
) -> str:
    """Return what is said of a suspicion: the question's own hint, or the catalogue's with its detail.

    The detail is left out where it would give a right value away that is not ``shown``.
    """
    if suspicion.name in hints:
        return hints[suspicion.name][language]
    hidden = suspicion.name in (PLAIN if shown else PLAIN + TELLING)
    detail = "" if hidden else translated(language, suspicion.detail)
    hint: str = suspicion.message.rstrip(".")
    return f"{hint} ({detail})" if detail else hint


def wrong_at(
    answer: Array, right: Array, given: Mapping[str, Array], good: Array, language: str, *, shown: bool
) -> tuple[str, str]:
    """Return how often an answer is wrong, with the worst input and what comes out there, and without."""
    row = _worst(answer, right, good)
    value, truth = _told_apart(answer[row], right[row])
    if not given:
        alone = say(language, "number-shown" if shown else "number-hidden", value=value, right=truth)
        return alone, alone
    count = say(language, "wrong", bad=rows(~good), count=len(right))
    key = "witness" if shown else "witness-hidden"
    return at(f"{count}: ", row, given, language, key, value=value, right=truth), count


def at(text: str, row: int, given: Mapping[str, Array], language: str, key: str, **values: str) -> str:
    """Return a text with a sentence behind it that names the inputs of a row."""
    named = [f"{name} = {_brief(_at(each, row))}" for name, each in given.items() if _is_short(each)]
    full = text
    for most in range(len(named), -1, -1):  # fewer inputs where they would be too long
        inputs = ", ".join(named[:most]) + (", …" if most < len(given) else "")
        if not most:
            inputs = say(language, "number", row=row + 1)
        full = f"{text}{say(language, key, inputs=inputs, **values)}"
        if len(full) <= LONGEST // 2:
            break
    return full


def guesses(names: Sequence[str], language: str) -> str:
    """Return that something may be one of these, or perhaps the only one.

    >>> guesses(["You forgot π"], "en"), guesses(["this", "that"], "en")
    ('perhaps: You forgot π', 'one of these: this / that')
    """
    return say(language, "one-of" if len(names) > 1 else "perhaps", names=" / ".join(names))


def _worst(answer: Array, right: Array, good: Array) -> int:
    """Return the first of the inputs where the answer is farthest off, and by more than is allowed."""
    off = np.abs(answer - right) / np.maximum(np.maximum(np.abs(right), np.abs(answer)), 1e-300)
    off = np.where(good, 0.0, off)
    return int(np.argmax(np.round(np.nan_to_num(off.reshape(len(off), -1).max(axis=1)), 6)))


def _at(value: Array, row: int) -> Any:
    return value[row] if value.ndim else value


def _is_short(value: Array) -> bool:
    """Return whether an input is a number or a vector."""
    return value.ndim < 2 or value[0].size <= 3


def _told_apart(value: Any, right: Any) -> tuple[str, str]:
    """Return two numbers with as many digits as tell them apart."""
    for digits in (6, 9, 12, 17):
        texts = _brief(value, digits), _brief(right, digits)
        if texts[0] != texts[1]:
            break
    return texts


def _brief(value: Any, digits: int = 6) -> str:
    array = np.asarray(value)
    if array.ndim == 0:
        return f"{array.item():.{digits}g}"
    if array.size > 3:
        return "[…]"
    return "(" + ", ".join(f"{each:.{max(digits - 2, 4)}g}" for each in array.ravel().tolist()) + ")"
