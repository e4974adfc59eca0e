"""Ledger: the lecture's lines with their verdicts, which are computed from the checks and never stored."""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from html import escape
from numbers import Integral
from typing import Any

from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.facts.report import Report
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness
from radiokit.worlds.lecture.entry import TITLES, Check, Entry, Word

__all__ = ["PARTS", "Claim", "Ledger", "lecture_claims"]

PARTS = ("optics", "assumptions", "quantities", "radiance", "photometry", "reflection", "shading")
"""The modules that hold the entries, in the order of the slides."""


@dataclass(frozen=True)
class Claim:
    """A line of the lecture, with what its checks find. They run when they are first asked for.

    >>> claim = lecture_claims()["irradiance-of-a-beam"]
    >>> print(claim.verdict, claim.found.evidence)
    misprint refuted
    """

    entry: Entry

    @cached_property
    def found(self) -> Verdict:
        """What is found on the printed line as it stands."""
        return _judged(self.entry.checks, self.entry.printed)

    @cached_property
    def amended(self) -> Verdict | None:
        """What is found on the line with its condition, or on the corrected one; None without either."""
        if not self.entry.amended:
            return None
        return _judged(self.entry.amended, self.entry.corrected or self.entry.printed)

    @property
    def verdict(self) -> Word:
        """``holds``, ``holds only if``, ``misprint``, ``wrong`` or ``undecided``, by what was found."""
        if self.found.ok:
            return Word.HOLDS
        outcomes = {self.found.outcome, *(() if self.amended is None else (self.amended.outcome,))}
        if Outcome.INCONCLUSIVE in outcomes:
            return Word.UNDECIDED
        if self.amended is None or not self.amended.ok:
            return Word.WRONG
        return Word.MISPRINT if self.entry.corrected else Word.CONDITIONAL

    @property
    def ok(self) -> bool:
        """True when the checks say what the reading says: a misprint that is found to be one is no fault."""
        return self.verdict is self.entry.as_read

    @property
    def how(self) -> tuple[str, ...]:
        """Which checks decide, in words."""
        return tuple(dict.fromkeys(check.how for check in (*self.entry.checks, *self.entry.amended)))

    @property
    def judgement(self) -> Verdict:
        """The claim that the lecture's line is as it is read, for a report."""
        entry = self.entry
        shown = self.found if self.amended is None or self.amended.ok else self.amended
        message = f"{self.verdict}{f' {entry.condition}' if self.verdict is Word.CONDITIONAL else ''}"
        outcome = Outcome.HOLDS if self.ok else Outcome.VIOLATED
        if self.verdict is Word.UNDECIDED:
            outcome = Outcome.INCONCLUSIVE
        evidence = Evidence.REFUTED if outcome is Outcome.VIOLATED else shown.evidence
        if outcome is Outcome.HOLDS and evidence is Evidence.REFUTED:
            evidence = self.amended.evidence if self.amended is not None else Evidence.MEASURED
        read = {"as_read": str(entry.as_read), "verdict": str(self.verdict)}
        return Verdict(
            check=entry.name,
            claim=f"slide {entry.slide}: {entry.printed}",
            outcome=outcome,
            evidence=evidence,
            message=f"{message}: {shown.message}",
            witness=Witness(values=read) if outcome is Outcome.VIOLATED else None,
            seconds=self.found.seconds + (self.amended.seconds if self.amended else 0.0),
            details=read,
        )

    def __str__(self) -> str:
        entry = self.entry
        lines = [
            f"{entry.name}: {self.verdict}{f' {entry.condition}' if entry.condition else ''}",
            f"  slide {entry.slide}: {entry.title}",
            f"  printed: {entry.printed}",
            *([f"           {entry.sentence}"] if entry.sentence else []),
            f"  read: {entry.english}",
            f"        {entry.russian}",
            *([f"  if:   {entry.condition_ru}"] if entry.condition_ru else []),
            *([f"  correct: {entry.corrected}"] if entry.corrected else []),
            f"  by: {', '.join(self.how)}",
            f"  found: {self.found.message}",
        ]
        if self.amended is not None:
            lines.append(
                f"  {'corrected' if entry.corrected else 'with the condition'}: {self.amended.message}"
            )
        related = [("derivation", entry.derivation), ("case", entry.case)]
        return "\n".join(lines + [f"  {what}: {name}" for what, name in related if name])

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"

    def to_json(self) -> dict[str, Any]:
        """Return the line and its verdict as JSON-ready data."""
        entry = self.entry
        texts: tuple[str, ...] = ("name", "slide", "title", "printed", "sentence", "english", "russian")
        texts += ("condition", "condition_ru", "corrected", "derivation", "case")
        return {
            **{name: getattr(entry, name) for name in texts},
            "verdict": str(self.verdict),
            "as_read": self.ok,
            "how": list(self.how),
            "found": self.found.to_json(),
            "amended": None if self.amended is None else self.amended.to_json(),
        }


@dataclass(frozen=True)
class Ledger:
    """Lines of the lecture in their order; indexed by a name or a number."""

    claims: tuple[Claim, ...]

    def __iter__(self) -> Iterator[Claim]:
        return iter(self.claims)

    def __len__(self) -> int:
        return len(self.claims)

    def __getitem__(self, key: str | int) -> Claim:
        if isinstance(key, int):
            return self.claims[key]
        names = {claim.entry.name: claim for claim in self.claims}
        if key not in names:
            raise UnknownNameError("line of the lecture", key, names)
        return names[key]

    def only(self, verdict: str) -> Ledger:
        """Return the lines with this verdict.

        Raises
        ------
        ParameterError
            When there is no such verdict.
        """
        words = [str(word) for word in Word]
        if verdict not in words:
            raise ParameterError("verdict", verdict, f"one of {', '.join(words)}")
        return Ledger(tuple(claim for claim in self.claims if str(claim.verdict) == verdict))

    @property
    def ok(self) -> bool:
        """True when every check says what the reading says."""
        return all(claim.ok for claim in self.claims)

    def counts(self) -> dict[str, int]:
        """Return how many lines have which verdict."""
        found = Counter(claim.verdict for claim in self.claims)
        return {str(word): found[word] for word in Word if found[word]}

    def report(self) -> Report:
        """Return the claims that each line is as it is read, as a report."""
        return Report("the lecture", tuple(claim.judgement for claim in self.claims))

    def rows(self) -> list[tuple[int, str, str, str, str]]:
        """Return slide, name, printed line, verdict and what decides, for a table."""
        return [
            (
                claim.entry.slide,
                claim.entry.name,
                claim.entry.printed,
                f"{claim.verdict} {claim.entry.condition}".strip()
                + (f": {claim.entry.corrected}" if claim.entry.corrected else ""),
                ", ".join(claim.how),
            )
            for claim in self.claims
        ]

    def __str__(self) -> str:
        lines = [f"{slide:>2}  {name}: {verdict}" for slide, name, _, verdict, _ in self.rows()]
        return "\n".join([*lines, ", ".join(f"{word}: {count}" for word, count in self.counts().items())])

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{text}</th>" for text in ("slide", "line", "printed", "verdict", "decided by"))
        body = "".join(
            "<tr>"
            + "".join(f'<td style="text-align:left">{escape(str(cell))}</td>' for cell in row)
            + "</tr>"
            for row in self.rows()
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def to_json(self) -> dict[str, Any]:
        """Return the lines and the counts as JSON-ready data."""
        return {"counts": self.counts(), "ok": self.ok, "claims": [claim.to_json() for claim in self.claims]}


def lecture_claims(*, slide: int | str | None = None, verdict: str | None = None) -> Ledger:
    r"""Return the lecture's formulas and statements, slide by slide, each with a verdict.

    Parameters
    ----------
    slide : int or str, optional
        Only those of this slide: its number, counted by titles from 1, or a part of its title.
    verdict : str, optional
        Only those with this verdict, such as ``"misprint"``. All of the slide's checks run for it; otherwise
        a line's checks run when its verdict is asked for.

    Raises
    ------
    ParameterError
        When there is no such slide or verdict.

    Source: the lecture «Свет как энергия. Радиометрия. BRDF» (Ignatenko, 2009).

    >>> (claim,) = lecture_claims(slide=38, verdict="misprint")
    >>> print(claim.entry.corrected)
    dE(p, \omega_i) = L_i(p, \omega_i) \cos \theta_i d\omega_i
    """
    found = Ledger(tuple(map(Claim, _chosen(slide))))
    return found if verdict is None else found.only(verdict)


def entries() -> tuple[Entry, ...]:
    """Return all lines as they are written, slide by slide.

    Raises
    ------
    ParameterError
        When two have one name.
    """
    modules = (importlib.import_module(f"radiokit.worlds.lecture.{part}") for part in PARTS)
    found = sorted((entry for module in modules for entry in module.ENTRIES), key=lambda entry: entry.slide)
    twice = [name for name, count in Counter(entry.name for entry in found).items() if count > 1]
    if twice:
        raise ParameterError("name", twice[0], "one of its own")
    return tuple(found)


def _chosen(slide: int | str | None) -> Iterable[Entry]:
    found = entries()
    if slide is None:
        return found
    if isinstance(slide, str) and not slide.isdigit():
        wanted = {i for i, title in enumerate(TITLES, start=1) if slide.casefold() in title.casefold()}
        if not wanted:
            raise ParameterError("slide", slide, "a part of a slide's title, or its number")
    else:
        number = int(slide) if isinstance(slide, (str, Integral)) else 0
        if not 1 <= number <= len(TITLES):
            raise ParameterError("slide", slide, f"a number from 1 to {len(TITLES)}, or a part of a title")
        wanted = {number}
    return [entry for entry in found if entry.slide in wanted]


def _judged(checks: tuple[Check, ...], printed: str) -> Verdict:
    """Run all the checks. Those that do not hold decide, and tell it together; otherwise all of them do."""
    verdicts = [check.judge(printed) for check in checks]
    for outcome in (Outcome.VIOLATED, Outcome.INCONCLUSIVE, Outcome.HOLDS):
        deciding = [verdict for verdict in verdicts if verdict.outcome is outcome]
        if deciding:
            break
    weakest = max(deciding, key=lambda verdict: list(Evidence).index(verdict.evidence))
    return replace(
        weakest,
        message="; ".join(verdict.message for verdict in deciding),
        seconds=sum(verdict.seconds for verdict in verdicts),
    )
