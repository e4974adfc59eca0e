"""Values: judges a function by the numbers it returns, beside a reference that never leaves this process."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.diagnose import diagnose
from radiokit.faces.diagnosis.result import Diagnosis
from radiokit.faces.grading.finding import Callee, Finding, Mode
from radiokit.faces.grading.protocol import Array
from radiokit.faces.grading.result import Result
from radiokit.faces.grading.words import say
from radiokit.facts.errors import ParameterError

__all__ = ["Values", "hint_for"]

SURE = 0.5
"""From which confidence on a misconception is named alone."""
INPUTS_SHOWN = 4


@dataclass(frozen=True, kw_only=True)
class Values:
    """Judges the numbers that a function returns.

    The function is handed all inputs at once; if it cannot bear that, or is wrong so, one by one. It may
    return arrays, lists or numbers. It is asked twice.

    Parameters
    ----------
    inputs : callable
        From a generator to the inputs by name, arrays whose first axes agree, or numbers, in the order of
        the function's parameters.
    reference : callable
        ``reference(**inputs)`` gives what is right, an array of one number or vector for each input.
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

    Raises
    ------
    ParameterError
        When a number is out of its range.
    """

    inputs: Callable[[np.random.Generator], Mapping[str, Any]]
    reference: Callable[..., Any]
    rtol: float = 1e-9
    ulps: float = 0.0
    atol: float = 0.0
    loose: Mapping[float, float] = field(default_factory=dict)
    credit: Mapping[str, float] = field(default_factory=dict)
    context: Callable[..., Mapping[str, Any]] | None = None
    variants: Mapping[str, Callable[..., Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not 0 <= self.rtol < 1:
            raise ParameterError("rtol", self.rtol, "in [0, 1)")
        for name in ("ulps", "atol"):
            if not 0 <= getattr(self, name) < math.inf:
                raise ParameterError(name, getattr(self, name), "finite and at least 0")
        for name in ("loose", "credit"):
            if not all(0 <= share <= 1 for share in getattr(self, name).values()):
                raise ParameterError(name, getattr(self, name), "shares in [0, 1]")

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
        given = {name: np.asarray(value) for name, value in self.inputs(rng).items()}
        right = np.asarray(self.reference(**given), dtype=float)
        seed = int(rng.integers(1 << 32))
        first, mode = _asked(callee, given, right, seed, self._allowed(right, self.rtol))
        if not first.ok:
            return Finding(share=0.0, text=say(language, "call", function=callee.name, error=first.error))
        answer, problem = _fitted(first, right, language)
        if problem:
            return Finding(share=0.0, text=problem)
        good = _close(answer, right, self._allowed(right, self.rtol))
        if good.all():
            again = callee.call(*given.values(), mode=mode, seed=seed)
            second, problem = _fitted(again, right, language) if again.ok else (answer, again.error)
            if problem or not _close(second, right, self._allowed(right, self.rtol)).all():
                return Finding(share=0.0, text=say(language, "not-repeatable"), diagnosis="not-repeatable")
            return Finding(share=1.0, text=say(language, "full"))
        return self._wrong(answer, right, given, good, language=language, hints=hints, shown=shown)

    def _allowed(self, right: Array, rtol: float) -> Array:
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
        """Say what is wrong with finite or infinite numbers of the right shape."""
        share = max(
            (s for r, s in self.loose.items() if _close(answer, right, self._allowed(right, r)).all()),
            default=0.0,
        )
        finite = np.isfinite(answer)
        if not finite.all():
            worst = answer[~finite].flat[0]
            value = "NaN" if math.isnan(worst) else "inf" if worst > 0 else "-inf"
            text = say(language, "not-finite", value=value, bad=_rows(~finite), count=len(finite))
            return Finding(share=0.0, text=text, diagnosis="not-finite", confidence=1.0)
        found = self._diagnosed(answer.astype(float), right, given, language) if right.ndim == 1 else None
        bad = _rows(~good)
        if found is not None and found.right:
            with np.errstate(all="ignore"):
                error = np.max(np.abs(answer - right) / np.abs(right))
            key = "float32" if answer.dtype == np.float32 else "imprecise"
            text = say(language, key, error=f"{error:.0e}", rtol=self.rtol)
            return Finding(share=share, text=text, diagnosis="imprecise", confidence=1.0)
        text = say(language, "wrong", bad=bad, count=len(right))
        witness = _witness(answer, right, given, language, shown)
        if found is None or found.first is None:
            notes = "; ".join(found.notes) if found is not None else ""
            return Finding(share=share, text="; ".join(each for each in (text, notes, witness) if each))
        first = found.first
        share = max(share, self.credit.get(first.name, 0.0))
        if first.confidence < SURE or found.ambiguous:
            likely = " / ".join(hint_for(each, hints, language) for each in found.suspicions[:2])
            text = f"{text}; {say(language, 'one-of', names=likely)}"
        else:
            text = f"{hint_for(first, hints, language)} ({text})"
        return Finding(
            share=share,
            text=f"{text}; {witness}" if witness else text,
            diagnosis=first.name,
            confidence=round(first.confidence, 2),
        )

    def _diagnosed(
        self, answer: Array, right: Array, given: Mapping[str, Array], language: str
    ) -> Diagnosis | None:
        size = len(right)
        context = dict(self.context(**given)) if self.context is not None else {}
        rows = {name: value for name, value in {**given, **context}.items() if _is_column(value, size)}
        others = {name: np.asarray(variant(**given), dtype=float) for name, variant in self.variants.items()}

        def reference(**inputs: Any) -> Any:
            return self.reference(**{name: inputs.get(name, given[name]) for name in given})

        found: Diagnosis | None = None
        for variants in ([others] if others else []) + [reference]:
            found = diagnose(
                answer,
                right,
                inputs=rows,
                variants=variants,
                language=language,
                catalogue=CATALOGUE,
            )
            if found.right or found.suspicions:
                break
        return found


def hint_for(suspicion: Any, hints: Mapping[str, Mapping[str, str]], language: str) -> str:
    """Return what is said of a suspicion: the question's own hint before the catalogue's."""
    hint = hints.get(suspicion.name, {}).get(language)
    detail = f" ({suspicion.detail})" if suspicion.detail else ""
    return f"{hint or suspicion.message.rstrip('.')}{detail}"


def _asked(
    callee: Callee, given: Mapping[str, Array], right: Array, seed: int, allowed: Array
) -> tuple[Result, Mode]:
    """Return the answer to all inputs at once or, if that is none or wrong and it helps, one by one."""
    arrays = list(given.values())
    best = callee.call(*arrays, mode="batch", seed=seed)
    mode: Mode = "batch"
    if _is_right(best, right, allowed) or not any(array.ndim for array in arrays):
        return best, mode
    one_by_one: tuple[Mode, ...] = ("scalar", "single")
    for other in one_by_one:
        result = callee.call(*arrays, mode=other, seed=seed)
        if _is_right(result, right, allowed) or (_usable(result, right) and not _usable(best, right)):
            best, mode = result, other
        if _is_right(best, right, allowed):
            break
    return best, mode


def _usable(result: Result, right: Array) -> bool:
    return result.ok and len(result.values) == 1 and result.values[0].size == right.size


def _is_right(result: Result, right: Array, allowed: Array) -> bool:
    if not _usable(result, right) or result.values[0].dtype.kind == "c":
        return False
    return bool(_close(result.values[0].reshape(right.shape), right, allowed).all())


def _fitted(result: Result, right: Array, language: str) -> tuple[Array, str]:
    """Return the answer in the shape of what is right, or what is wrong with it."""
    (answer, *more) = result.values
    if more:
        shape = " × ".join(str(value.shape) for value in result.values)
        return answer, say(language, "shape", shape=shape, expected=right.shape)
    if answer.dtype.kind == "c":
        return answer, say(language, "complex")
    if answer.size != right.size or (answer.ndim > right.ndim and max(answer.shape) != answer.size):
        return answer, say(language, "shape", shape=answer.shape, expected=right.shape)
    if answer.dtype.kind != "f":
        answer = answer.astype(float)
    return answer.reshape(right.shape), ""


def _close(answer: Array, right: Array, allowed: Array) -> Array:
    with np.errstate(all="ignore"):
        close: Array = np.abs(answer.astype(float) - right) <= allowed
    return close


def _rows(bad: Array) -> int:
    return int(np.count_nonzero(bad.reshape(len(bad), -1).any(axis=1)))


def _is_column(value: Any, size: int) -> bool:
    shape = np.shape(value)
    return shape in ((), (size,), (size, 3))


def _witness(answer: Array, right: Array, given: Mapping[str, Array], language: str, shown: bool) -> str:
    """Return the input where the answer is farthest off, and what it gives there."""
    with np.errstate(all="ignore"):
        off = np.abs(answer - right) / np.maximum(np.abs(right), 1e-300)
    row = int(np.argmax(off.reshape(len(off), -1).max(axis=1)))
    named = [f"{name} = {_brief(value[row] if value.ndim else value)}" for name, value in given.items()]
    inputs = ", ".join(named[:INPUTS_SHOWN])
    values = {"inputs": inputs, "value": _brief(answer[row]), "right": _brief(right[row])}
    return say(language, "witness" if shown else "witness-hidden", **values)


def _brief(value: Any) -> str:
    array = np.asarray(value)
    if array.ndim == 0:
        return f"{array.item():.6g}"
    if array.size > 3:
        return "[…]"
    return "(" + ", ".join(f"{each:.4g}" for each in array.ravel().tolist()) + ")"
