"""Values: judges a function by the numbers it returns, beside a reference that never leaves this process."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from radiokit.faces.grading.finding import Callee, Finding
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.judges.asking import asked, close, fitted, is_extreme, is_right
from radiokit.faces.grading.judges.digits import lost
from radiokit.faces.grading.judges.evidence import at, hint_for, joined, wrong_at
from radiokit.faces.grading.judges.exact import Reference, as_function, no_inputs
from radiokit.faces.grading.judges.explained import diagnosed, exactly, worded, words_of
from radiokit.faces.grading.judges.given import (
    check_functions,
    check_shares,
    drawn,
    is_within,
    own,
    truth,
)
from radiokit.faces.grading.russian import did
from radiokit.faces.grading.words import say, sentence
from radiokit.facts.errors import ParameterError

__all__ = ["Values", "hint_for"]

NAMES = {
    "float32": "single-precision",
    "float32-range": "single-precision",
    "constant": "constant-answer",
    "zero": "constant-answer",
}
"""Diagnoses by sentences, where they differ."""


@dataclass(frozen=True, kw_only=True)
class Values:
    """Judges the numbers that a function returns.

    The function is handed all inputs at once; if it cannot bear that, or is wrong so, one by one. It may
    return arrays, lists or numbers. It is asked twice, the second time in reverse order.

    Parameters
    ----------
    reference : callable, Case or array_like
        ``reference(**inputs)`` gives what is right, an array of one number or vector for each input; or a
        closed-form case, whose exact value is right; or what is right itself.
    inputs : callable, optional
        From a generator to the inputs by name, arrays whose first axes agree, or numbers. The names are those
        of the function's parameters, and stand in their order. Without it the function has none, and one
        number is asked for.
    rtol : float
        The relative error that is allowed, in [0, 1).
    ulps : float
        Or so many units in the last place, at least 0; what allows more counts.
    atol : float
        Or this absolute error, at least 0.
    loose : mapping
        The share of the points that a larger relative error still earns, by that error: ``{1e-6: 0.5}``.
    credit : mapping
        The share that a misconception still earns, by its name: ``{"pi-too-many": 0.5}``.
    context : callable, optional
        ``context(**inputs)`` gives further inputs to the diagnosis, by the names that it knows, such as
        ``theta``, ``distance``, ``solid_angle``.
    variants : mapping or callable, optional
        What wrong solutions give, by the name of the misconception: ``{name: f(**inputs)}``.
    terms : callable, optional
        ``terms(**inputs)`` gives the size of what a right but careless formula subtracts: an answer that is
        off by its rounding is called imprecise.

    Raises
    ------
    ParameterError
        When a number is out of its range.

    >>> import radiokit as rk
    >>> Values(reference=rk.case("lambert-under-square-of-2m")).rtol
    1e-09
    """

    reference: Reference
    inputs: Callable[[np.random.Generator], Mapping[str, Any]] = no_inputs
    rtol: float = 1e-9
    ulps: float = 0.0
    atol: float = 0.0
    loose: Mapping[float, float] = field(default_factory=dict)
    credit: Mapping[str, float] = field(default_factory=dict)
    context: Callable[..., Mapping[str, Any]] | None = None
    variants: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    terms: Callable[..., Any] | None = None

    def __post_init__(self) -> None:
        as_function(self.reference)
        functions = ("inputs", "context", "terms")
        check_functions({name: getattr(self, name) for name in functions}, self.variants)
        if not is_within(self.rtol, 0, 1) or self.rtol == 1:
            raise ParameterError("rtol", self.rtol, "a number in [0, 1)")
        for name in ("ulps", "atol"):
            if not is_within(getattr(self, name), 0, sys.float_info.max):
                raise ParameterError(name, getattr(self, name), "a number, finite and at least 0")
        for name in ("loose", "credit"):
            check_shares(name, getattr(self, name))
        if not all(is_within(error, self.rtol, math.inf) and error > self.rtol for error in self.loose):
            raise ParameterError("loose", self.loose, f"shares by errors larger than rtol = {self.rtol:g}")

    def judge(
        self,
        callee: Callee,
        rng: np.random.Generator,
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        """Judge a function: right, imprecise, or wrong and why."""
        with np.errstate(all="ignore"):  # a wrong answer may be of any size
            return self._judged(callee, rng, language, hints, shown)

    def _judged(
        self,
        callee: Callee,
        rng: np.random.Generator,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        given = drawn(self.inputs, rng)
        right = truth(self._right, given)
        seed = int(rng.integers(1 << 32))
        allowed = self.allowed(right, self.rtol)
        first, mode = asked(callee, given, right, seed, allowed)
        if not first.ok:
            return _raised(callee.name, first, given, language, hints)
        answer, problem = fitted(first, right, language)
        if problem:
            return Finding(share=0.0, text=joined(problem))
        good = close(answer, right, allowed)
        if not good.all():
            found = self._wrong(answer, right, given, good, language=language, hints=hints, shown=shown)
            if (
                not found.diagnosis
                and mode == "batch"
                and max((each.ndim for each in given.values()), default=0) == 1
            ):
                alone = callee.call(*given.values(), mode="scalar", seed=seed)
                if is_right(alone, right, allowed):
                    text = joined(say(language, "beside-others"), found.text)
                    return replace(found, text=text, diagnosis="beside-others", confidence=1.0)
            return found
        turned = [array[::-1] if array.ndim else array for array in given.values()]
        if any(array.ndim for array in turned):
            right = right[::-1]
        second = callee.call(*turned, mode=mode, seed=seed)
        if not is_right(second, right, self.allowed(right, self.rtol)):
            text = joined(say(language, "not-repeatable"))
            return Finding(share=0.0, text=text, diagnosis="not-repeatable")
        if mode == "batch":
            return Finding(share=1.0, text=say(language, "full"))
        return Finding(share=1.0, text=say(language, "full-one-by-one"))

    @property
    def _right(self) -> Callable[..., Any]:
        return as_function(self.reference)

    def allowed(self, right: Array, rtol: float) -> Array:
        """Return the absolute errors that are allowed, if the relative one is ``rtol``."""
        size = np.abs(right)
        allowed: Array = np.maximum(np.maximum(rtol * size, self.ulps * np.spacing(size)), self.atol)
        return allowed

    def _wrong(
        self,
        answer: Array,
        right: Array,
        given: Mapping[str, Array],
        good: Array,
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        """Say what is wrong with numbers of the right shape."""
        share = max(
            (s for r, s in self.loose.items() if close(answer, right, self.allowed(right, r)).all()),
            default=0.0,
        )
        allowed = self.allowed(right, self.rtol)
        terms = 0.0 if self.terms is None else own("terms", self.terms, **given)
        key, values = lost(answer, right, given, good, atol=self.atol, rtol=self.rtol, terms=terms)
        slip = exactly(answer, right, given, self.variants, allowed) if key == "imprecise" else ""
        if slip:  # near the right numbers by the inputs' doing, and another formula
            full, _ = wrong_at(answer, right, given, good, language, shown=shown)
            text = joined(words_of(slip, hints, language), full)
            return Finding(share=share, text=text, diagnosis=slip, confidence=1.0)
        if key:
            name = NAMES.get(key, key)
            said = say(language, key, **values)
            hint = "" if key == "zero" else hints.get(name, {}).get(language, "")
            if key == "not-finite":
                row = int(np.argmin(np.isfinite(answer).reshape(len(answer), -1).all(axis=1)))
                said = at(f"{said}, ", row, given, language, "such-as")
            text = joined(said, hint)
            return Finding(share=share, text=text, diagnosis=name, confidence=1.0)
        full, count = wrong_at(answer, right, given, good, language, shown=shown)
        if right.ndim > 1:
            return Finding(share=share, text=joined(full))
        found, besides = diagnosed(
            answer,
            right,
            given,
            self._right,
            context=self.context,
            variants=self.variants,
            rtol=self.rtol,
            language=language,
        )
        first = found.first
        if first is None:
            notes = "; ".join(found.notes) if shown and not found.right else ""
            return Finding(share=share, text=joined(full, notes))
        if first.name == "wrong-at-few":  # the evidence says more
            return Finding(share=share, text=joined(full), diagnosis=first.name)
        text = worded(found, hints, language, shown=shown)
        if besides:
            text = joined(text, say(language, "besides", bad=besides, count=len(right)))
        best = joined(text, full)
        earned = math.prod(self.credit.get(name, 0.0) for name in first.name.split(" + "))
        return Finding(
            share=max(share, self.credit.get(first.name, earned) * (0.5 if besides else 1.0)),
            text=best if len(best) > len(joined(text)) else joined(text, count),
            diagnosis=first.name,
            confidence=round(first.confidence, 2),
        )


def _raised(
    name: str,
    result: Result,
    given: Mapping[str, Array],
    language: str,
    hints: Mapping[str, Mapping[str, str]],
) -> Finding:
    """Say what a function did instead of answering, and why if its inputs leave the range of numbers."""
    text = did(language, name, result.error)
    if result.raised in ("OverflowError", "ZeroDivisionError") and any(map(is_extreme, given.values())):
        hint = hints.get("out-of-range", {}).get(language, "")
        text = f"{text}. {sentence(hint)}" if hint else text
        return Finding(share=0.0, text=text, diagnosis="out-of-range", confidence=1.0)
    return Finding(share=0.0, text=text)
