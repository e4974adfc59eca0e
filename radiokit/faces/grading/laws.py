"""Laws: judges a student's BRDF by the laws that every BRDF obeys, with the judges of ``rk.check``."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from radiokit.checks.judge import check
from radiokit.checks.probes import pairs
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.diagnosis.diagnose import diagnose
from radiokit.faces.diagnosis.result import Diagnosis
from radiokit.faces.grading.finding import Callee, Finding
from radiokit.faces.grading.lawtexts import failed, found, remarks, share_of_light, tell
from radiokit.faces.grading.protocol import Array
from radiokit.faces.grading.remote import is_pairwise
from radiokit.faces.grading.values import SURE, hint_for
from radiokit.faces.grading.words import say
from radiokit.facts.errors import CallableError, ParameterError
from radiokit.facts.report import Report
from radiokit.facts.verdict import Outcome, Verdict

__all__ = ["Laws"]

Expected = Literal["holds", "violated"]

LAWS = ("values", "reciprocity", "energy")

EVALUATIONS = 1_000_000, 16_000_000
"""What a function of arrays may cost at first, and again where energy is too near the limit to tell."""

FEWER_EVALUATIONS = 100_000, 1_000_000
"""The same for a function of one pair, which is looped over."""

COMPARED = 256
"""Pairs at which a function is compared with the one that it should be."""


@dataclass(frozen=True, kw_only=True)
class Laws:
    """Judges whether a function f(wi, wo) obeys the laws, or breaks those that it should.

    What it is judged by are evaluations, never a clock: the same function earns the same on any machine. A
    function of arrays is searched as finely as ``rk.check`` does; one of single pairs more coarsely, every
    1.2° in place of 0.15°. Where its albedo is then too near 1 to tell, it is asked once more, ten times as
    often. If that does not tell either, the law counts as kept where what was measured is within the limit:
    nobody loses points by a fault that was not seen.

    Parameters
    ----------
    laws : sequence of str
        Which of ``values`` (finite, not negative, repeatable), ``reciprocity``, ``energy``.
    expected : mapping
        ``"holds"``, which is the default, or ``"violated"``, by law.
    weights : mapping
        Each law's share of the points, above 0, by law; 1 by default.
    parameters : callable or sequence of mappings
        The keyword arguments with which the function is judged, each in turn; or from a generator to them. A
        law must turn out as expected with all of them.
    reference : callable, optional
        ``reference(**parameters)`` gives the BSDF that the function should be. Where it is another, the
        misconception is named; a constant, or what no known misconception leads to, earns nothing.
    variants : mapping
        What wrong solutions give, by the name of the misconception: ``{name: f(wi, wo, **parameters)}``.
    least : float
        The share of the light that must be reflected in the direction where it is most, in [0, 1].
    tolerance : float
        How far beyond a limit a value may lie, in [0, 1).

    Raises
    ------
    ParameterError
        When an argument is out of its range.

    >>> Laws(expected={"reciprocity": "broken"})
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.ParameterError: expected = {'reciprocity': 'broken'} is not allowed: it must be ...
    """

    laws: Sequence[str] = LAWS
    expected: Mapping[str, Expected] = field(default_factory=dict)
    weights: Mapping[str, float] = field(default_factory=dict)
    parameters: Callable[[np.random.Generator], Sequence[Mapping[str, Any]]] | Sequence[Mapping[str, Any]] = (
        {},
    )
    reference: Callable[..., BSDF] | None = None
    variants: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    least: float = 0.0
    tolerance: float = 1e-6

    def __post_init__(self) -> None:
        if not self.laws or not set(self.laws) <= set(LAWS):
            raise ParameterError("laws", self.laws, f"some of {', '.join(LAWS)}")
        outcomes = set(self.expected.values())
        if not set(self.expected) <= set(self.laws) or not outcomes <= set(get_args(Expected)):
            raise ParameterError("expected", self.expected, "'holds' or 'violated' by a law that is judged")
        if not set(self.weights) <= set(self.laws) or not all(
            0 < w < math.inf for w in self.weights.values()
        ):
            raise ParameterError("weights", self.weights, "finite numbers above 0 by a law that is judged")
        if not callable(self.parameters) and not self.parameters:
            raise ParameterError("parameters", self.parameters, "at least one mapping, such as {}")
        for name, most in (("least", 1.0), ("tolerance", 0.999)):
            if not 0 <= getattr(self, name) <= most:
                raise ParameterError(name, getattr(self, name), f"in [0, {most:g}]")

    def judge(
        self,
        callee: Callee,
        rng: np.random.Generator,
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        """Judge a function; ``shown`` changes nothing, for no right values are told."""
        chosen = list(self.parameters(rng) if callable(self.parameters) else self.parameters)
        wrong: dict[str, tuple[str, str]] = {}  # by law: what was found, and the sentence
        right: dict[str, str] = {}
        notes: list[str] = []
        suspicion: tuple[str, float, str] = "", 0.0, ""
        refused = ""
        try:
            for given in chosen:
                model = callee.bsdf(given)
                report = self._report(model)
                notes += report.notes
                for verdict in report:
                    name, text, good = self._weighed(verdict, report, model, language)
                    law = verdict.check
                    if not good:
                        wrong.setdefault(law, (name, _with(given if len(chosen) > 1 else {}, text, language)))
                    right.setdefault(law, text)
                refused = refused or self._too_dark(report, language)
                if self.reference is not None and not suspicion[2] and not refused:
                    suspicion, stranger = self._compared(model, given, language, hints)
                    refused = tell(language, "stranger") if stranger else ""
        except CallableError as error:
            return Finding(share=0.0, text=failed(error, language))
        kept = sum(self._weight(law) for law in self.laws if law not in wrong)
        share = 0.0 if refused else kept / sum(self._weight(law) for law in self.laws)
        texts = [text for _, text in wrong.values()]
        texts += [each for each in (suspicion[2], refused) if each]
        if not texts:
            texts = [f"{say(language, 'full')}: {', '.join(right[law] for law in self.laws if law in right)}"]
        names = [suspicion[0], *(name for name, _ in wrong.values())]
        return Finding(
            share=share,
            text="; ".join([*texts, *remarks(tuple(notes), language)]),
            diagnosis=next((name for name in names if name), "not-the-model" if refused else ""),
            confidence=suspicion[1] if suspicion[0] else 1.0 if wrong or refused else 0.0,
        )

    def _weight(self, law: str) -> float:
        return self.weights.get(law, 1.0)

    def _report(self, model: BSDF) -> Report:
        """Return the judges' report, with energy's verdict from a finer search where the first is unsure."""
        first, finer = FEWER_EVALUATIONS if is_pairwise(model) else EVALUATIONS
        laws = {*self.laws, "energy"} if self.least else set(self.laws)
        report = check(
            model,
            laws=[law for law in LAWS if law in laws],
            tolerance=self.tolerance,
            evaluations=first,
        )
        unsure = [v for v in report if v.outcome is Outcome.INCONCLUSIVE and v.estimate is not None]
        if not unsure or any(v.outcome is Outcome.VIOLATED and v.check == "values" for v in report):
            return report
        again = check(model, laws=["energy"], tolerance=self.tolerance, evaluations=finer)
        kept = tuple(again["energy"] if v.check == "energy" else v for v in report)
        return Report(subject=report.subject, verdicts=kept, notes=report.notes, parameters=report.parameters)

    def _weighed(self, verdict: Verdict, report: Report, model: BSDF, language: str) -> tuple[str, str, bool]:
        """Return what a verdict found, the sentence on it, and whether it is as it should be."""
        law = verdict.check
        mutual = any(v.check == "reciprocity" and v.outcome is Outcome.HOLDS for v in report)
        name, text = found(verdict, model, language, mutual=mutual)
        if law not in self.laws:
            return name, text, True
        if self.expected.get(law, "holds") == "violated":
            if verdict.outcome is Outcome.VIOLATED:
                return name, text, True
            return f"{law}-holds", f"{text}, {tell(language, 'should-break')}", False
        if verdict.outcome is Outcome.INCONCLUSIVE and name == "unclear":
            assert verdict.estimate is not None
            return name, text, bool(np.max(verdict.estimate.value) <= 1 + self.tolerance)
        return name, text, verdict.outcome is Outcome.HOLDS

    def _too_dark(self, report: Report, language: str) -> str:
        """Return the sentence on a surface that is darker than is allowed, if it is."""
        energy = next((v for v in report if v.check == "energy" and v.estimate is not None), None)
        if not self.least or energy is None or energy.estimate is None:
            return ""
        most = max(float(value) for value in energy.details["supremum"].values())
        if most >= self.least * (1 - self.tolerance):
            return ""
        return tell(language, "black", share=share_of_light(most), least=share_of_light(self.least))

    def _compared(
        self, model: BSDF, given: Mapping[str, Any], language: str, hints: Mapping[str, Mapping[str, str]]
    ) -> tuple[tuple[str, float, str], bool]:
        """Return the misconception, its confidence and its sentence, and whether f was not asked for at all."""
        assert self.reference is not None
        meant = self.reference(**given)
        wi, wo = pairs(COMPARED, meant)
        answer, right = np.asarray(model.evaluate(wi, wo)), np.asarray(meant.evaluate(wi, wo))
        nothing = "", 0.0, ""
        if answer.shape != right.shape or right.ndim != 1:
            return nothing, True
        if not np.isfinite(answer).all():
            return nothing, False  # the judge of values says so
        if np.ptp(answer) == 0 and (np.ptp(right) > 0 or (right.any() and not answer.any())):
            return nothing, True

        def truth(wi: Any, wo: Any, **_: Any) -> Any:
            return meant.evaluate(wi, wo)

        named = {name: np.asarray(wrong(wi, wo, **given)) for name, wrong in self.variants.items()}
        numbers = {name: value for name, value in given.items() if isinstance(value, int | float)}
        inputs = {"wi": wi, "wo": wo, **{k: np.full(COMPARED, float(v)) for k, v in numbers.items()}}
        rtol = 2e-4 if model.precision > 1e-10 else None
        result: Diagnosis | None = None
        for variants in ([named] if named else []) + [truth]:
            result = diagnose(answer, right, inputs=inputs, variants=variants, language=language, rtol=rtol)
            if result.right or _is_sure(result):
                break
        assert result is not None
        if result.right:
            return nothing, False
        if _is_sure(result):
            first = result.suspicions[0]
            return (first.name, round(first.confidence, 2), hint_for(first, hints, language)), False
        if result.suspicions:
            likely = " / ".join(hint_for(each, hints, language) for each in result.suspicions[:2])
            return ("", 0.0, say(language, "one-of", names=likely)), False
        factor = _factor(answer, right, rtol or 1e-6)
        if factor is None:
            return nothing, True
        return ("other-factor", 1.0, tell(language, "factor", factor=f"{factor:.6g}")), False


def _is_sure(result: Diagnosis) -> bool:
    return result.first is not None and result.first.confidence >= SURE and not result.ambiguous


def _factor(answer: Array, right: Array, rtol: float) -> float | None:
    """Return what constant times ``right`` the answer is, if it is one."""
    lit = right != 0
    if not lit.any() or answer[~lit].any():
        return None
    factor = float(np.median(answer[lit] / right[lit]))
    return factor if np.allclose(answer, factor * right, rtol=10 * rtol, atol=0) else None


def _with(given: Mapping[str, Any], text: str, language: str) -> str:
    if not given:
        return text
    named = ", ".join(f"{name} = {value:g}" for name, value in given.items())
    return tell(language, "given", parameters=named, text=text)
