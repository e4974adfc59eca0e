"""Suspects: which misconception explains the means of an estimator, or the density that a sampler claims."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.diagnose import diagnose
from radiokit.faces.diagnosis.result import Suspicion
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.evidence import clause, guesses
from radiokit.faces.grading.judges.given import number, own
from radiokit.faces.grading.judges.runs import Runs
from radiokit.faces.grading.judges.samplewords import PLAIN, slip
from radiokit.faces.grading.russian import translated
from radiokit.faces.grading.words import say

__all__ = ["behind_density", "behind_means"]

Hints = Mapping[str, Mapping[str, str]]

SURE = 0.5
"""From which confidence on a misconception is named alone."""
WIDER = 1.25
"""What the errors are multiplied by before a misconception is looked for: few seeds give them."""


def behind_means(
    runs: Runs,
    *,
    reference: Callable[..., Any],
    variants: Mapping[str, Callable[..., Any]],
    context: Callable[..., Mapping[str, Any]] | None,
    language: str,
    hints: Hints,
) -> tuple[str, str, float]:
    """Return what is said of wrong means, the misconception, and how sure that is; or empty texts."""
    for suspicions, ambiguous in _suspected(runs, reference, variants, context, language):
        first = suspicions[0]
        text = _explained(first, language, hints)
        if first.confidence < SURE or ambiguous:
            names = [_explained(each, language, hints).rstrip(".") for each in suspicions[:2]]
            text = guesses(names, language)
        return text, first.name, first.confidence
    return "", "", 0.0


def behind_density(
    claimed: Array,
    right: Array,
    *,
    inputs: Mapping[str, Array],
    variants: Mapping[str, Array],
    rtol: float,
    language: str,
    hints: Hints,
) -> tuple[str, str, float]:
    """Return what is said of a wrong density, the misconception, and how sure that is; or empty texts.

    The ``variants``, as the question knows them, come first, then a wrong factor, then the whole catalogue.
    """
    for others, catalogue in ((variants, ()), (None, CATALOGUE)):
        found = diagnose(
            claimed, right, inputs=inputs, variants=others, language=language, catalogue=catalogue, rtol=rtol
        )
        first = found.first
        if first is not None and not found.ambiguous and first.confidence >= SURE:
            return _explained(first, language, hints), first.name, first.confidence
        ratio = claimed[right > 0] / right[right > 0]
        steady = np.ptp(ratio) <= rtol * abs(ratio).max()
        if steady and abs(ratio[0] - 1) > rtol:
            return slip(language, "pdf-not-normalised", hints), "pdf-not-normalised", 1.0
    return "", "", 0.0


def _explained(suspicion: Suspicion, language: str, hints: Hints) -> str:
    """Return what is said of a suspicion: the question's own hint, or other words with its detail."""
    if " + " in suspicion.name:
        both = [clause(slip(language, each, hints)) for each in suspicion.name.split(" + ")]
        return say(language, "both", names=" + ".join(both))
    if not suspicion.detail or suspicion.name in hints or suspicion.name in PLAIN:
        return slip(language, suspicion.name, hints)
    return f"{suspicion.message.rstrip('.')} ({translated(language, suspicion.detail)})"


def _suspected(
    runs: Runs,
    exact: Callable[..., Any],
    variants: Mapping[str, Callable[..., Any]],
    context: Callable[..., Mapping[str, Any]] | None,
    language: str,
) -> Iterator[tuple[tuple[Suspicion, ...], bool]]:
    """Yield what explains the means: first among the question's variants, then in the catalogue."""
    others = {
        name: np.array([number(variant, inputs, f"variants[{name!r}]") for inputs in runs.inputs])
        for name, variant in variants.items()
    }
    error = WIDER * np.sqrt(runs.variances / runs.values.shape[1]) + runs.floor / 10

    def reference(**changed: Any) -> Array:
        try:  # out of its domain it may do anything, which then explains nothing
            return np.array(
                [
                    float(exact(**{n: changed[n][k] if n in changed else v for n, v in inputs.items()}))
                    for k, inputs in enumerate(runs.inputs)
                ]
            )
        except Exception:
            return np.full(len(runs.inputs), np.nan)

    for known, catalogue in ((others, ()), (reference, CATALOGUE)):
        if known:
            found = diagnose(
                runs.means,
                runs.right,
                inputs=_numbers(runs, context),
                variants=known,
                error=error,
                language=language,
                catalogue=catalogue,
            )
            if found.suspicions:
                yield found.suspicions, bool(found.ambiguous)


def _numbers(runs: Runs, context: Callable[..., Mapping[str, Any]] | None) -> dict[str, Array]:
    """Return the inputs that are numbers, one for each group, with those of the context."""
    rows = [
        {**inputs, **(own("context", context, **inputs) if context is not None else {}), "samples": count}
        for inputs, count in zip(runs.inputs, runs.samples, strict=True)
    ]
    names = [name for name, value in rows[0].items() if np.ndim(value) == 0]
    return {name: np.array([float(row[name]) for row in rows]) for name in names}
