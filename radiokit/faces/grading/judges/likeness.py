"""Likeness: whether a student's BRDF is the one that is asked for, or which misconception changed it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.checks.probes import pairs
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.diagnosis.diagnose import diagnose
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.evidence import clause, hint_for
from radiokit.faces.grading.judges.lawtexts import place_of
from radiokit.faces.grading.judges.lawwords import tell
from radiokit.faces.grading.judges.values import SURE
from radiokit.faces.grading.words import say

__all__ = ["Likeness", "compared"]

PAIRS = 256
"""Pairs of directions at which two functions are compared."""

SINGLE = 2e-4
"""The relative deviation that is let pass where a function computes in float32."""


@dataclass(frozen=True, kw_only=True)
class Likeness:
    """The misconception by its name, how sure it is, a sentence, and whether f was not asked for at all."""

    name: str = ""
    confidence: float = 0.0
    text: str = ""
    stranger: bool = False


def compared(
    models: Sequence[BSDF],
    meant: Sequence[BSDF],
    given: Sequence[Mapping[str, Any]],
    rng: np.random.Generator,
    *,
    variants: Mapping[str, Callable[..., Any]],
    hints: Mapping[str, Mapping[str, str]],
    language: str,
) -> Likeness:
    """Compare a function with what it should be, over all its parameters together.

    ``models``, ``meant`` and ``given`` are the function, what it should be, and its keyword arguments, one
    for each choice of parameters; ``variants`` and ``hints`` as for `Laws`. The pairs are drawn, so that none
    can be recognised. Values that are not finite say nothing here, unless most are: then it hides what it is.
    A constant is a stranger unless one is asked for, and so is black.
    """
    count = -(-PAIRS // len(models))
    rows = [slice(k * count, (k + 1) * count) for k in range(len(models))]
    wi, wo = (np.concatenate([w] * len(models)) for w in pairs(count, meant[0], shift=rng.random(4)))

    def over(functions: Sequence[Callable[..., Any]], wi: Array, wo: Array) -> Array:
        return np.concatenate(
            [np.asarray(f(wi[row], wo[row])) for f, row in zip(functions, rows, strict=True)]
        )

    def truth(wi: Any, wo: Any, **_: Any) -> Any:
        return over([model.evaluate for model in meant], wi, wo)

    answer, right = over([model.evaluate for model in models], wi, wo), truth(wi, wo)
    if answer.shape != right.shape or right.ndim != 1:
        return Likeness(stranger=True)
    finite = np.isfinite(answer)
    if finite.mean() < 0.5:
        return Likeness(stranger=True)
    answer = np.where(finite, answer, right)
    constant = all(np.ptp(answer[row]) == 0 for row in rows)
    if constant and (np.ptp(right[rows[0]]) > 0 or (right.any() and not answer.any())):
        return Likeness(stranger=True)
    named = {name: over([_with(f, each) for each in given], wi, wo) for name, f in variants.items()}
    numbers = [name for name, value in given[0].items() if isinstance(value, int | float)]
    inputs = {name: np.repeat([float(each[name]) for each in given], count) for name in numbers}
    rtol = SINGLE if models[0].precision > 1e-10 else None
    found = None
    for others in ([named] if named else []) + [truth]:
        found = diagnose(
            answer,
            right,
            inputs={"wi": wi, "wo": wo, **inputs},
            variants=others,
            language=language,
            rtol=rtol,
        )
        if found.right:
            return Likeness()
        if found.first is not None and found.first.confidence >= SURE and not found.ambiguous:
            first = found.first
            if first.name == "wrong-at-few":
                return _at_few(answer, right, wi, wo, rtol or 1e-6, language)
            text = hint_for(first, hints, language)
            return Likeness(name=first.name, confidence=round(first.confidence, 2), text=text)
    assert found is not None
    if found.suspicions:
        likely = [clause(hint_for(each, hints, language)) for each in found.suspicions[:2]]
        key, text = ("perhaps", likely[0]) if len(likely) == 1 else ("", " / ".join(likely))
        return Likeness(text=tell(language, key, name=text) if key else say(language, "one-of", names=text))
    factor = _factor(answer, right, rtol or 1e-6)
    if factor is None:
        return Likeness(stranger=True)
    text = tell(language, "factor", factor=f"{factor:.6g}")
    return Likeness(name="other-factor", confidence=1.0, text=text)


def _at_few(answer: Array, right: Array, wi: Array, wo: Array, rtol: float, language: str) -> Likeness:
    bad = np.abs(answer - right) > rtol * np.abs(right)
    row = int(np.argmax(np.where(bad, np.abs(answer - right), -1.0)))
    place = place_of(wi[row], wo[row], language)
    text = tell(language, "at-few", bad=int(bad.sum()), count=len(bad), place=place)
    return Likeness(name="wrong-at-few", confidence=1.0, text=text)


def _with(f: Callable[..., Any], given: Mapping[str, Any]) -> Callable[..., Any]:
    return lambda wi, wo: f(wi, wo, **given)


def _factor(answer: Array, right: Array, rtol: float) -> float | None:
    """Return what constant times ``right`` the answer is, if it is one."""
    lit = right != 0
    if not lit.any() or answer[~lit].any():
        return None
    factor = float(np.median(answer[lit] / right[lit]))
    return factor if np.allclose(answer, factor * right, rtol=10 * rtol, atol=0) else None
