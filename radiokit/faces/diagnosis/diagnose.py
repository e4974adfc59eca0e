"""Diagnose: weigh every entry of the catalogue against the answers, and rank those that explain them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.misconception import LANGUAGES, Guess, Misconception, structural
from radiokit.faces.diagnosis.problem import SHARE, Problem
from radiokit.faces.diagnosis.reading import read
from radiokit.faces.diagnosis.result import TEXTS, Diagnosis, Suspicion
from radiokit.facts.errors import ParameterError

__all__ = ["diagnose"]

PAIR_PRIOR = 0.1
FEWEST_FOR_PAIRS = 5
RANGE = math.log(1e4)
"""Over how many e-foldings a wrong factor may lie that no misconception explains."""


@dataclass(frozen=True)
class _Fit:
    entries: tuple[Misconception, ...]
    guess: Guess
    share: float
    prior: float

    @property
    def name(self) -> str:
        return " + ".join(entry.name for entry in self.entries)


def diagnose(
    answer: npt.ArrayLike,
    reference: npt.ArrayLike,
    *,
    inputs: Mapping[str, Any] | None = None,
    variants: Callable[..., Any] | Mapping[str, Any] | None = None,
    error: npt.ArrayLike | None = None,
    language: str = "en",
    rtol: float | None = None,
    catalogue: Sequence[Misconception] | None = None,
) -> Diagnosis:
    """Say which misconception explains a wrong answer.

    A misconception is believed if it explains at least 95 % of the inputs, as far as rounding and chance
    allow, and no other explains them as well: else the diagnosis says what it cannot tell apart.

    Parameters
    ----------
    answer, reference : (N,) array_like
        What the student gave, and what is right, at the same inputs and in the same unit.
    inputs : mapping, optional
        Arrays (N,), or one number, by which factors that vary are known: ``theta`` [rad] or ``theta_deg``
        or ``cosine`` (from the normal), ``distance`` [m], ``cosine_light`` (at the light), ``area`` [m²],
        ``solid_angle`` [sr], ``pdf`` [sr⁻¹], ``samples``, ``exponent``, ``seed``; ``wi``, ``wo`` (N, 3).
    variants : callable or mapping, optional
        The reference as a function of the inputs, called as ``variants(**inputs)`` with wrong ones; or
        the values (N,) that a wrong solution gives, by its name.
    error : array_like, optional
        Standard errors of sampled answers, (N,) or one number, at least 0.
    language : str
        ``"en"`` or ``"ru"``.
    rtol : float, optional
        The relative deviation that rounding explains, in (0, 0.1]; 1e-6, or 2e-5 for answers in float32.
    catalogue : sequence of Misconception, optional
        What to look for, all that is known by default;
        ``(*radiokit.faces.diagnosis.catalogue.CATALOGUE, mine)`` adds one.

    Returns
    -------
    Diagnosis
        Ranked suspicions; none where the answer is right, or where nothing known fits.

    Raises
    ------
    ParameterError
        When shapes differ, or an argument is out of its range.

    Examples
    --------
    >>> import numpy as np
    >>> theta = np.linspace(0, 1.4, 8)
    >>> found = diagnose(5 * np.ones(8), 5 * np.cos(theta), inputs={"theta": theta})
    >>> found.first.name, found.first.confidence > 0.8
    ('cosine-forgotten', True)
    >>> print(diagnose(np.cos(theta), np.cos(theta)))
    agrees to within 0 on 8 inputs
    """
    if language not in LANGUAGES:
        raise ParameterError("language", language, " or ".join(map(repr, LANGUAGES)))
    problem = read(answer, reference, {} if inputs is None else inputs, variants, error, rtol)
    text = TEXTS[language]
    known = CATALOGUE if catalogue is None else catalogue
    entries = (*known, *_variant_entries(variants, known))
    seen, _ = _fits(problem, [entry for entry in entries if entry.seen], -1.0)
    suspicions = [_suspicion(fit, 1.0, language) for fit in seen]
    largest = np.maximum(np.abs(problem.reference), 1e-13 * problem.scale + 1e-300)
    deviations = np.abs(problem.answer - problem.reference) / largest
    deviation = float(np.max(deviations, initial=0.0))
    if problem.agrees(problem.reference):
        if seen:
            return Diagnosis(False, text["wrong"], tuple(suspicions), deviation, language=language)
        summary = text["agrees-sampled" if problem.sampled else "agrees"]
        summary = summary.format(deviation=deviation, count=problem.answer.size)
        hidden = _hidden(problem, entries) if problem.sampled else []
        notes = [text["hidden"].format(names=", ".join(hidden))] if hidden else []
        if not problem.sampled and np.median(deviations) > 1e-9:
            notes = [text["float32"]]
        return Diagnosis(True, summary, (), deviation, (), tuple(notes), language)
    inferred, ambiguous, notes = _infer(problem, [entry for entry in entries if not entry.seen], language)
    suspicions += inferred
    summary = text["wrong" if suspicions else "unknown"]
    return Diagnosis(False, summary, tuple(suspicions), deviation, ambiguous, tuple(notes), language)


def _variant_entries(variants: Any, catalogue: Sequence[Misconception]) -> list[Misconception]:
    """Return an entry for each named variant, with the words of the catalogue's entry of that name."""
    if not isinstance(variants, Mapping):
        return []
    words = {entry.name: (entry.en, entry.ru) for entry in catalogue}

    def entry(name: str) -> Misconception:
        english, russian = words.get(
            name, tuple(TEXTS[language]["variant"].format(name=name) for language in LANGUAGES)
        )

        def explain(problem: Problem) -> Iterable[Guess]:
            if isinstance(problem.variants, Mapping):
                yield Guess(problem.variants[name])

        return structural(name, explain, english, russian)

    return [entry(name) for name in variants]


def _fits(problem: Problem, entries: Iterable[Misconception], baseline: float) -> tuple[list[_Fit], int]:
    """Return each entry's best guess that explains more than the reference does, and how many were tried."""
    found, tried = [], 0
    for entry in entries:
        best: _Fit | None = None
        for guess in entry.explain(problem):
            tried += 1
            share = 1.0 if entry.seen else problem.share(guess.values, entry.slack)
            if share >= SHARE and share > max(baseline, best.share if best else 0.0):
                best = _Fit((entry,), guess, share, entry.prior)
        if best:
            found.append(best)
    return found, tried


def _pairs(problem: Problem, entries: Sequence[Misconception], baseline: float) -> tuple[list[_Fit], int]:
    """Return the pairs of factors that explain the answers together, and how many were tried."""
    known = [
        (entry, guess)
        for entry in entries
        if entry.pairs
        for guess in entry.explain(problem)
        if guess.factor is not None and np.all(np.isfinite(guess.factor))
    ]
    found, tried = [], 0
    for (first, one), (second, other) in combinations(known, 2):
        assert one.factor is not None
        assert other.factor is not None
        if first.kind == second.kind == "constant":
            continue  # together they are a constant that nobody has named
        tried += 1
        factor = one.factor * other.factor
        values = factor * problem.reference
        share = problem.share(values)
        if share >= SHARE and share > baseline:
            prior = PAIR_PRIOR * first.prior * second.prior
            found.append(_Fit((first, second), Guess(values, factor), share, prior))
    return found, tried


def _hidden(problem: Problem, entries: Sequence[Misconception]) -> list[str]:
    """Return the common factors that sampled answers which agree cannot rule out."""
    fits, _ = _fits(problem, [entry for entry in entries if entry.pairs], -1.0)
    return [fit.name for fit in fits]


def _infer(
    problem: Problem, entries: Sequence[Misconception], language: str
) -> tuple[list[Suspicion], tuple[str, ...], list[str]]:
    """Return the suspicions, the names that stay ambiguous, and what else is to be said."""
    text = TEXTS[language]
    baseline = problem.share(problem.reference)
    fits, tried = _fits(problem, entries, baseline)
    # How many of the tried would fit a wrong answer by chance, if its factor may be anything in RANGE.
    width = 2 * problem.resolution(problem.answer) / RANGE
    chance = width * tried
    if not fits and np.count_nonzero(problem.answer) >= FEWEST_FOR_PAIRS:
        fits, tried = _pairs(problem, entries, baseline)
        chance = PAIR_PRIOR * width * tried
    if not fits:
        return [], (), _constant_note(problem, text)
    if chance > max(fit.prior for fit in fits):
        return [], (), [text["coarse"]]
    misfits = [problem.misfit(fit.guess.values) for fit in fits]
    weights = [
        fit.prior * (1.0 if fit.share == 1 else 0.1) * math.exp((min(misfits) - misfit) / 2)
        for fit, misfit in zip(fits, misfits, strict=True)
    ]
    still = [_is_still(problem, fit) for fit in fits]
    # A factor from inputs that do not vary is no better than a constant that nobody has named.
    unnamed = max((w for w, s in zip(weights, still, strict=True) if s), default=0.0) if all(still) else 0.0
    total = sum(weights) + chance * max(fit.prior for fit in fits) + unnamed
    ranked = sorted(zip(weights, fits, strict=True), key=lambda pair: -pair[0])
    suspicions = [_suspicion(fit, fit.share * weight / total, language) for weight, fit in ranked]
    tied = [fit for weight, fit in ranked if weight > 0.5 * ranked[0][0]]
    notes, names = [], tuple(fit.name for fit in tied)
    if len(tied) > 1:
        notes.append(text["ambiguous"].format(names=", ".join(names)))
    if len(tied) > 1 or unnamed:
        needs = sorted({need for fit in tied for entry in fit.entries for need in entry.needs})
        if unnamed:
            factor = next(s.factor for s in suspicions if s.factor is not None)
            notes.append(text["constant"].format(factor=factor))
        if needs:
            notes.append(text["vary"].format(needs=", ".join(needs)))
    kept = [suspicion for suspicion in suspicions if suspicion.confidence > 0.01]
    return kept, names if len(tied) > 1 else (), notes


def _is_still(problem: Problem, fit: _Fit) -> bool:
    """Return whether a fit rests on a factor that should vary and does not."""
    if fit.guess.factor is None or all(entry.kind == "constant" for entry in fit.entries):
        return False
    factor = fit.guess.factor[problem.reference != 0]
    width = 2 * problem.resolution(problem.answer) * float(np.max(np.abs(factor), initial=0.0))
    return bool(factor.size == 0 or np.ptp(factor) <= width)


def _constant_note(problem: Problem, text: Mapping[str, str]) -> list[str]:
    """Return a note where the answer is some constant times the reference."""
    telling = problem.reference != 0
    if np.count_nonzero(telling) < 2:
        return []
    factor = float(np.median(problem.answer[telling] / problem.reference[telling]))
    fits = factor != 0 and problem.share(factor * problem.reference) >= SHARE
    return [text["factor"].format(factor=factor)] if fits else []


def _suspicion(fit: _Fit, confidence: float, language: str) -> Suspicion:
    hints = [entry.hint(language) for entry in fit.entries]
    message = hints[0]
    if len(hints) == 2:
        message = TEXTS[language]["both"].format(first=hints[0], second=hints[1])
    factor = None
    if fit.guess.factor is not None:
        factor = float(np.median(fit.guess.factor))
    return Suspicion(fit.name, min(confidence, 1.0), factor, message, fit.guess.detail, fit.share)
