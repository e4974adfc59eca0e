"""Result: what a diagnosis says, to a student in words, to a notebook in HTML, and to a program in JSON."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

from radiokit.facts.jsonable import jsonable

__all__ = ["TEXTS", "Diagnosis", "Suspicion"]

TEXTS = {
    "en": {
        "agrees": "agrees to within {deviation:.2g} on {count} inputs",
        "agrees-sampled": "agrees within the standard errors on {count} inputs",
        "unknown": "no known misconception fits",
        "wrong": "the answer differs from the reference",
        "ambiguous": "these inputs cannot tell between: {names}",
        "vary": "inputs that differ in {needs} would tell",
        "constant": "these inputs vary too little: any constant factor of {factor:.4g} looks the same",
        "factor": "the answer is {factor:.6g} times the reference at all inputs",
        "hidden": "the standard errors are so large that these would fit as well: {names}",
        "float32": "the last digits differ as float32 rounds: that is not wrong",
        "coarse": "the errors are too large to tell one misconception from another",
        "both": "Two things at once. {first} {second}",
        "variant": "Your numbers are those of this variant: {name}.",
    },
    "ru": {
        "agrees": "совпадает с точностью {deviation:.2g} на входах, число которых {count}",
        "agrees-sampled": "совпадает в пределах стандартных ошибок на входах, число которых {count}",
        "unknown": "ни одна известная ошибка не подходит",
        "wrong": "ответ отличается от верного",
        "ambiguous": "эти входы не позволяют различить: {names}",
        "vary": "различить помогут входы с разными значениями {needs}",
        "constant": "эти входы меняются слишком мало: так же выглядит любой постоянный множитель "
        "{factor:.4g}",
        "factor": "ответ на всех входах равен верному, умноженному на {factor:.6g}",
        "hidden": "стандартные ошибки так велики, что подходит и это: {names}",
        "float32": "последние цифры отличаются, как округляет float32: это не ошибка",
        "coarse": "погрешности слишком велики, чтобы отличить одну ошибку от другой",
        "both": "Две ошибки сразу. {first} {second}",
        "variant": "Ваши числа отвечают такому варианту: {name}.",
    },
}
"""The sentences of a diagnosis by language; those of the misconceptions stand in the catalogue."""


@dataclass(frozen=True)
class Suspicion:
    """One misconception that explains the answers.

    ``confidence`` is in [0, 1]; ``factor`` the median factor on the right answer, None where it is none;
    ``share`` the share of the inputs explained.
    """

    name: str
    confidence: float
    factor: float | None
    message: str
    detail: str = ""
    share: float = 1.0

    def __str__(self) -> str:
        detail = f" ({self.detail})" if self.detail else ""
        return f"{self.confidence:4.0%}  {self.name}: {self.message}{detail}"

    def to_json(self) -> dict[str, Any]:
        """Return the suspicion as JSON-ready data."""
        result: dict[str, Any] = jsonable(
            {
                "name": self.name,
                "confidence": self.confidence,
                "factor": self.factor,
                "message": self.message,
                "detail": self.detail,
                "share": self.share,
            }
        )
        return result


@dataclass(frozen=True)
class Diagnosis:
    """What is wrong with an answer: suspicions, the most likely first; none where it is right or unexplained.

    ``right`` says whether the answer agrees; ``deviation`` is the largest relative deviation;
    ``ambiguous`` names the suspicions that the inputs cannot tell apart. True when there is a suspicion.

    >>> from radiokit.faces.diagnosis.diagnose import diagnose
    >>> found = diagnose([2.0, 6.0], [1.0, 3.0])
    >>> found.right, bool(found), found.first.name, found.deviation
    (False, True, 'doubled', 1.0)
    """

    right: bool
    summary: str
    suspicions: tuple[Suspicion, ...]
    deviation: float
    ambiguous: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    language: str = "en"

    def __bool__(self) -> bool:
        return bool(self.suspicions)

    @property
    def first(self) -> Suspicion | None:
        """The most likely suspicion, if there is any."""
        return self.suspicions[0] if self.suspicions else None

    def __str__(self) -> str:
        lines = [self.summary, *(f"  {suspicion}" for suspicion in self.suspicions)]
        return "\n".join(lines + [f"  {note}" for note in self.notes])

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{suspicion.confidence:.0%}</td><td><code>{escape(suspicion.name)}</code></td>"
            f"<td>{escape(suspicion.message)} {escape(suspicion.detail)}</td></tr>"
            for suspicion in self.suspicions
        )
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes)
        table = f"<table>{rows}</table>" if rows else ""
        return f"<p><b>{escape(self.summary)}</b></p>{table}{notes}"

    def to_json(self) -> dict[str, Any]:
        """Return the diagnosis as JSON-ready data."""
        result: dict[str, Any] = jsonable(
            {
                "right": self.right,
                "summary": self.summary,
                "deviation": self.deviation,
                "suspicions": [suspicion.to_json() for suspicion in self.suspicions],
                "ambiguous": list(self.ambiguous),
                "notes": list(self.notes),
                "language": self.language,
            }
        )
        return result
