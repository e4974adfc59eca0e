"""Laws: judges a student's BRDF by the laws that every BRDF obeys, with the judges of ``rk.check``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from radiokit.checks.judge import check
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.grading.finding import Callee, Finding
from radiokit.faces.grading.isolation.remote import is_pairwise
from radiokit.faces.grading.judges.given import check_functions, own, shown
from radiokit.faces.grading.judges.lawtexts import failed, found, remarks, share_of_light
from radiokit.faces.grading.judges.lawwords import law_name, tell
from radiokit.faces.grading.judges.likeness import Likeness, compared
from radiokit.faces.grading.words import say, sentence
from radiokit.facts.errors import AssignmentError, CallableError, ParameterError
from radiokit.facts.report import Report
from radiokit.facts.verdict import Outcome, Verdict

__all__ = ["Laws"]

Expected = Literal["holds", "violated"]

LAWS = ("values", "reciprocity", "energy")

EVALUATIONS = 1_000_000, 16_000_000
"""What a function of arrays may cost at first, and again where energy is too near the limit to tell."""

FEWER_EVALUATIONS = 100_000, 1_000_000
"""The same for a function of one pair, which is looped over."""


@dataclass(frozen=True, kw_only=True)
class Laws:
    """Judges whether a function f(wi, wo) obeys the laws, or breaks those that it should.

    It is called with unit vectors, z the normal, ``wi`` to the light and ``wo`` to the viewer: arrays (N, 3),
    or one pair at a time if it cannot bear that. It gives f in sr⁻¹, without the cosine, and 0 where either
    lies below the horizon.

    What it is judged by are evaluations, never a clock: the same function earns the same on any machine. A
    function of arrays is searched as finely as ``rk.check`` does; one of single pairs more coarsely, every
    1.2° or so in place of 0.15°. Where its albedo is then too near 1 to tell, it is asked once more, at
    least ten times as often. If that does not tell either, the law counts as kept where what was measured is
    within the limit: nobody loses points by a fault that was not seen.

    The directions at which the laws are judged are the same for everyone and can be foretold: a function that
    keeps a law there alone is taken to keep it. Those at which it is compared with a reference are drawn.

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
        law must turn out as expected with all of them. They stand in the order of the function's parameters:
        a function that does not know their names is given them in that order.
    reference : callable, optional
        ``reference(**parameters)`` gives the BSDF that the function should be, of one wavelength. Where it is
        another, the misconception is named; a constant, or what no known misconception leads to, earns
        nothing.
    variants : mapping
        What wrong solutions give, by the name of the misconception: ``{name: f(wi, wo, **parameters)}``.
    least : float
        The share of the light that must be reflected in the direction where it is most, in [0, 1]. What is
        darker earns nothing, unless a known slip explains it: then it breaks the law of energy.
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
        mappings = not isinstance(self.parameters, Mapping | str) and isinstance(self.parameters, Iterable)
        if not callable(self.parameters) and not (
            mappings and self.parameters and all(isinstance(each, Mapping) for each in self.parameters)
        ):
            raise ParameterError(
                "parameters", self.parameters, 'mappings in a list, such as [{"alpha": 0.1}]'
            )
        if self.reference is not None and not callable(self.reference):
            raise ParameterError(
                "reference", self.reference, "a function of the parameters that gives a BSDF"
            )
        check_functions({}, self.variants)
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
        with np.errstate(all="ignore"):  # values may be infinite
            return self._judged(callee, rng, language, hints)

    def _judged(
        self,
        callee: Callee,
        rng: np.random.Generator,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
    ) -> Finding:
        chosen = self.chosen(rng)
        meant = [self.meant(given) for given in chosen] if self.reference is not None else []
        wrong: dict[str, tuple[str, str]] = {}  # by law: what was found, and the sentence
        right: dict[str, str] = {}
        notes: list[str] = []
        refused, dark, like = "", "", Likeness()
        try:
            models = [callee.bsdf(given) for given in chosen]
            for model, given in zip(models, chosen, strict=True):
                report = self._report(model)
                notes += report.notes
                finite = True
                for verdict in report:
                    name, text, good = self._weighed(verdict, report, model, language)
                    finite = finite and name != "not-finite"
                    if good and not finite:  # what was found elsewhere says nothing of there
                        name, text, good = "unjudged", "", False
                    if not good:
                        text = _with(given if len(chosen) > 1 else {}, text, language)
                        wrong.setdefault(verdict.check, (name, text))
                    right.setdefault(verdict.check, text)
                dark = dark or self._too_dark(report, language)
            if self.reference is not None:
                like = compared(
                    models, meant, chosen, rng, variants=self.variants, hints=hints, language=language
                )
                refused = tell(language, "stranger") if like.stranger else ""
            if dark and like.name:  # a known slip in the right function, which is too dark for it
                wrong["energy"] = ("too-dark", dark)
            elif dark:
                refused, like = dark, Likeness()
        except CallableError as error:
            return Finding(share=0.0, text=failed(error, language))
        kept = sum(self._weight(law) for law in self.laws if law not in wrong)
        said = {name: hint[language] for name, hint in hints.items()}
        told = [(name, text) for name, text in wrong.values() if name != "unjudged"]
        texts = [each for name, text in told for each in (text, said.get(name, ""))]
        unjudged = [law_name(law, language) for law, (name, _) in wrong.items() if name == "unjudged"]
        texts += [tell(language, "unjudged", laws=", ".join(unjudged))] if unjudged else []
        texts += [refused, said.get("not-the-model", "")] if refused else []
        if not texts and not like.text:
            texts = [f"{say(language, 'full')}: {'; '.join(right[law] for law in self.laws if law in right)}"]
        texts += [like.text, *remarks(tuple(notes), language)]
        names = [like.name, *(name for name, _ in wrong.values()), "not-the-model" if refused else ""]
        return Finding(
            share=0.0 if refused else kept / sum(self._weight(law) for law in self.laws),
            text=" ".join(sentence(each) for each in texts if each),
            diagnosis=next((name for name in names if name), ""),
            confidence=like.confidence if like.name else float(bool(wrong or refused)),
        )

    def chosen(self, rng: np.random.Generator) -> list[Mapping[str, Any]]:
        """Return the keyword arguments with which a function is judged, each in turn.

        Raises
        ------
        AssignmentError
            When they are none.
        """
        found = own("parameters", self.parameters, rng) if callable(self.parameters) else self.parameters
        listed = isinstance(found, Iterable) and not isinstance(found, Mapping | str)
        chosen = list(found) if listed else []
        if not chosen or not all(isinstance(each, Mapping) for each in chosen):
            raise AssignmentError(f"parameters gives {shown(found)}: it must give mappings in a list")
        return chosen

    def meant(self, given: Mapping[str, Any]) -> BSDF:
        """Return the BSDF that the function should be.

        Raises
        ------
        AssignmentError
            When the reference gives none.
        """
        assert self.reference is not None
        found = own("reference", self.reference, **given)
        if not isinstance(found, BSDF):
            raise AssignmentError(
                f"reference gives {shown(found)}: it must give a BSDF, as rk.bsdf(...) does"
            )
        return found

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
                return name, tell(language, "as-it-should", text=text), True
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


def _with(given: Mapping[str, Any], text: str, language: str) -> str:
    if not given:
        return text
    named = ", ".join(
        f"{name} = {value:g}" if isinstance(value, int | float) else f"{name} = {value}"
        for name, value in given.items()
    )
    return tell(language, "given", parameters=named, text=text)
