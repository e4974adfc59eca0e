"""Summary: what an instructor wants to know of a class: counts alone, never who."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.grades import Grade

__all__ = ["Tally", "needs_review"]

BINS = 10
SLACK = 1e-9
"""Below this share of the points nothing is missing, or nothing earned."""


def needs_review(grade: Grade) -> bool:
    """Return whether a person should look at a grade."""
    return any(question.review for question in grade.questions)


class Tally:
    """Counts grades one after another, so that they need not be in memory together."""

    def __init__(self, assignment: Assignment, language: str) -> None:
        self.assignment, self.language = assignment, language
        self.entries = self.review = 0
        self.totals: list[float] = []
        self.shares: dict[str, list[float]] = {each.name: [] for each in assignment.questions}
        self.parts: dict[tuple[str, str], list[float]] = {}
        self.found: dict[str, Counter[str]] = {each.name: Counter() for each in assignment.questions}

    def add(self, grade: Grade, *, handed_in: bool) -> None:
        """Count a grade."""
        self.entries += 1
        self.review += needs_review(grade)
        if not handed_in:
            return
        self.totals.append(grade.score)
        for question in grade.questions:
            self.shares[question.name].append(_share(question.score, question.points))
            for part in question.parts:
                self.parts.setdefault((question.name, part.name), []).append(_share(part.score, part.points))
            self.found[question.name].update({part.diagnosis for part in question.parts if part.diagnosis})

    def to_json(self) -> dict[str, Any]:
        """Return the summary as JSON-ready data.

        Of each question: its mean, how many earned all, some or nothing of its points, how many earned each
        tenth of them, and the misconceptions, the most frequent first.
        """
        work, language = self.assignment, self.language
        together: Counter[str] = sum(self.found.values(), Counter())
        return {
            "assignment": work.name,
            "title": work.title[language],
            "language": language,
            "entries": self.entries,
            "handed_in": len(self.totals),
            "need_review": self.review,
            "score": {"points": round(work.points, 4), **_spread(self.totals, work.points)},
            "questions": [
                {
                    "name": question.name,
                    "title": question.title[language],
                    "points": question.points,
                    **_shares(self.shares[question.name]),
                    "parts": [
                        {
                            "name": part.name,
                            "title": part.title[language],
                            **_shares(self.parts.get((question.name, part.name), [])),
                        }
                        for part in question.parts
                    ],
                    "misconceptions": self._misconceptions(self.found[question.name]),
                }
                for question in work.questions
            ],
            "misconceptions": self._misconceptions(together),
        }

    def _misconceptions(self, found: Counter[str]) -> list[dict[str, Any]]:
        texts = {entry.name: entry.hint(self.language) for entry in CATALOGUE}
        ranked = sorted(found.items(), key=lambda item: (-item[1], item[0]))
        return [{"name": name, "count": count, "text": texts.get(name, "")} for name, count in ranked]


def _share(score: float, points: float) -> float:
    return score / points if points else 0.0


def _mean(values: list[float]) -> float | None:
    return round(math.fsum(values) / len(values), 4) if values else None


def _spread(totals: list[float], points: float) -> Mapping[str, Any]:
    ranked = sorted(totals)

    def quantile(share: float) -> float | None:
        if not ranked:
            return None
        at = share * (len(ranked) - 1)
        low = ranked[math.floor(at)]
        return round(low + (ranked[math.ceil(at)] - low) * (at - math.floor(at)), 4)

    return {
        "mean": _mean(totals),
        "quartiles": [quantile(share) for share in (0.25, 0.5, 0.75)],
        "tenths": _tenths(_share(total, points) for total in totals),
    }


def _shares(shares: list[float]) -> Mapping[str, Any]:
    """Return how shares of the points are spread, the mean among them."""
    full = sum(share >= 1 - SLACK for share in shares)
    none = sum(share <= SLACK for share in shares)
    counts = {"full": full, "partial": len(shares) - full - none, "none": none}
    return {"mean_share": _mean(shares), **counts, "tenths": _tenths(shares)}


def _tenths(shares: Iterable[float]) -> list[int]:
    counts = [0] * BINS
    for share in shares:
        counts[min(max(math.floor(share * BINS + SLACK), 0), BINS - 1)] += 1
    return counts
