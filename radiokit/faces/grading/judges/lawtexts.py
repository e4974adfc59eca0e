"""Law texts: what the judges' verdicts on a student's BRDF are in his own words, English and Russian."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.checks.probes import channels, polar
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.judges.lawwords import tell
from radiokit.faces.grading.russian import did
from radiokit.faces.grading.words import say
from radiokit.facts.errors import CallableError
from radiokit.facts.verdict import Outcome, Verdict

__all__ = ["failed", "found", "place_of", "remarks", "share_of_light"]

ASKED = 100_000
"""About how many pairs a function is asked for at least."""

_MARKS = {"float32": "returns float", "writes": "writes into its inputs", "mixes": "mixes up the rows"}


def found(verdict: Verdict, model: BSDF, language: str, *, mutual: bool) -> tuple[str, str]:
    """Return the name of what a verdict found and the sentence on it.

    ``mutual`` says that f is reciprocal: then an integral over ``wi`` is also the share that is reflected.
    """
    if verdict.check == "values":
        return _values(verdict, model, language)
    if _is_unjudged(verdict):
        return "unjudged", ""
    if verdict.check == "energy":
        return _energy(verdict, language, mutual)
    if verdict.outcome is not Outcome.VIOLATED:
        return "reciprocal", tell(language, "reciprocal", pairs=verdict.details["pairs"])
    wi, wo = _tidied(verdict, model, _asymmetry)
    one, two = _channel(*(channels(model.evaluate(*pair))[0] for pair in ((wi, wo), (wo, wi))))
    digits = next((n for n in (3, 5, 8) if f"{one:.{n}g}" != f"{two:.{n}g}"), 12)
    place = place_of(wi[0], wo[0], language)
    values = {"one": f"{one:.{digits}g}", "two": f"{two:.{digits}g}", "place": place}
    return "not-reciprocal", tell(language, "not-reciprocal", **values)


def failed(error: CallableError, language: str) -> str:
    """Return the sentence on a function that raised, was stopped, or returned what is no value."""
    function, problem = error.fields["function"], plain_text(error.fields["problem"])
    text = did(language, function, problem)
    if "took longer than" in problem:
        text += tell(language, "slow", pairs=ASKED)
    if "unexpected keyword argument" in problem:
        return text + tell(language, "keyword")
    if error.fields.get("wi") is None:
        return text
    return text + tell(language, "at", place=place_of(error.fields["wi"], error.fields["wo"], language))


def remarks(notes: tuple[str, ...], language: str) -> list[str]:
    """Return a sentence for each habit among a report's notes that the student should know of."""
    said = [key for key, mark in _MARKS.items() if any(mark in note for note in notes)]
    if any(" prints: " in note and "Warning: " not in note for note in notes):
        said.append("prints")
    if any("below the horizon" in note for note in notes):
        said.append("below")
    return [tell(language, key) for key in said]


def share_of_light(value: float, error: float = 0.0) -> str:
    """Return a share as a percentage, in as many digits as are known and as show an excess over the whole.

    >>> share_of_light(1.07478), share_of_light(1.0000012), share_of_light(1), share_of_light(184.7, 10.0)
    ('107.5 %', '100.00012 %', '100 %', '18500 %')
    """
    percent = 100 * float(value)
    digits = 4 if error < 1e-3 * value else 3
    if percent > 100 * (1 + 1e-12):
        digits = next((n for n in (digits, 4, 6, 8, 10) if float(f"{percent:.{n}g}") > 100), 14)
    return f"{float(f'{percent:.{digits}g}'):.12g} %"


def _is_unjudged(verdict: Verdict) -> bool:
    unsure = verdict.outcome is Outcome.INCONCLUSIVE
    return unsure and (verdict.estimate is None or verdict.message.startswith("not repeatable"))


def _values(verdict: Verdict, model: BSDF, language: str) -> tuple[str, str]:
    if verdict.outcome is Outcome.HOLDS or verdict.witness is None:
        return "finite", tell(language, "finite")
    values = verdict.witness.values
    if "f" not in values:
        return "not-repeatable", say(language, "not-repeatable")
    wi, wo = _tidied(verdict, model, _badness)
    place = place_of(wi[0], wo[0], language)
    seen = channels(model.evaluate(wi, wo))[0]
    if np.isfinite(seen).all():
        return "negative", tell(language, "negative", value=f"{seen.min():.3g}", place=place)
    bad = float(seen[~np.isfinite(seen)][0])
    name = "NaN" if np.isnan(bad) else f"{bad:g}"
    return "not-finite", tell(language, "not-finite", value=name, place=place)


def _energy(verdict: Verdict, language: str, mutual: bool) -> tuple[str, str]:
    assert verdict.estimate is not None
    value = float(np.max(verdict.estimate.value))
    details = verdict.details
    theta = _degrees(details["theta_deg"])
    if not details["isotropic"] and details["theta_deg"] > 0:
        theta += f", φ = {_degrees(details['phi_deg'])}"
    share = share_of_light(value, float(np.max(verdict.estimate.error)))
    even = value - details["least"] < 1e-6 * value
    if verdict.outcome is Outcome.HOLDS and even:
        return "conserves", tell(language, "even", share=share_of_light(min(value, 1.0)))
    if verdict.outcome is Outcome.HOLDS:
        return "conserves", tell(language, "conserves", share=share_of_light(min(value, 1.0)), theta=theta)
    if verdict.outcome is Outcome.INCONCLUSIVE:
        error = f"{100 * float(np.max(verdict.estimate.error)):.1g} %"
        return "unclear", tell(language, "unclear", share=f"{100 * value:.4g} %", error=error)
    if even:
        return "gains-energy", tell(language, "gains-everywhere", share=share)
    key = "gains" if mutual or details["fixed"] == "wi" else "gains-for-viewer"
    text = tell(language, key, share=share, theta=theta, value=f"{value:.6g}")
    if details["approached_at_grazing"]:
        text += tell(language, "to-grazing")
    return "gains-energy", text


def _tidied(
    verdict: Verdict, model: BSDF, severity: Callable[[BSDF, FloatArray, FloatArray], FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return a witness's pair as (1, 3) arrays, at angles that are easily typed if those tell as much."""
    assert verdict.witness is not None
    wi, wo = (np.asarray(verdict.witness.directions[name], dtype=float) for name in ("wi", "wo"))
    angles = np.array([_angles(wi), _angles(wo)])
    steps = np.array([10.0, 5.0, 1.0])
    near = steps[:, None, None] * np.round(angles / steps[:, None, None])
    near[:, :, 0] = np.minimum(near[:, :, 0], 90 - steps[:, None])
    w = polar(np.cos(np.radians(near[:, :, 0])), np.radians(near[:, :, 1]))
    first, second = np.vstack([w[:, 0], wi]), np.vstack([w[:, 1], wo])
    worst = severity(model, first, second)
    row = int(np.argmax(worst >= 0.5 * worst[-1]))
    return first[row : row + 1], second[row : row + 1]


def _asymmetry(model: BSDF, wi: FloatArray, wo: FloatArray) -> FloatArray:
    one, two = channels(model.evaluate(wi, wo)), channels(model.evaluate(wo, wi))
    with np.errstate(all="ignore"):
        gap = np.abs(one - two) / np.maximum(np.maximum(np.abs(one), np.abs(two)), 1e-300)
    worst: FloatArray = gap.max(axis=1)
    return worst


def _badness(model: BSDF, wi: FloatArray, wo: FloatArray) -> FloatArray:
    values = channels(model.evaluate(wi, wo))
    return np.where(np.isfinite(values), np.maximum(-values, 0.0), np.inf).max(axis=1)


def _channel(one: FloatArray, two: FloatArray) -> tuple[float, float]:
    """Return the values of the wavelength at which they differ most."""
    k = int(np.argmax(np.abs(one - two)))
    return float(one[k]), float(two[k])


def _angles(w: Any) -> tuple[float, float]:
    """Return θ and φ [degrees]."""
    return (
        float(np.degrees(np.arctan2(np.hypot(w[0], w[1]), w[2]))),
        float(np.degrees(np.arctan2(w[1], w[0])) % 360),
    )


def _degrees(angle: float) -> str:
    """Return an angle in as few digits as tell it from the horizon."""
    rough = f"{angle:.4g}"
    return f"{rough if rough != '90' else f'{angle:.8g}'}°"


def place_of(wi: Any, wo: Any, language: str) -> str:
    """Return a pair of directions (3,) as angles."""
    pairs = {name: tuple(_degrees(angle) for angle in _angles(w)) for name, w in (("wi", wi), ("wo", wo))}
    return tell(language, "directions", **pairs)
