"""Verdict: a claim, whether it holds, and the evidence that anyone can re-evaluate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.facts.jsonable import jsonable

__all__ = ["TOLERANCE", "Evidence", "Outcome", "Verdict", "Witness", "judge_upper_limit"]

TOLERANCE = 1e-9
"""How far beyond its limit a value may lie, since a lossless model sits on the limit."""


class Outcome(StrEnum):
    """What was found."""

    HOLDS = "holds"
    VIOLATED = "violated"
    INCONCLUSIVE = "inconclusive"


class Evidence(StrEnum):
    """How it was found."""

    PROVED = "proved"  # a symbolic identity
    BOUNDED = "bounded"  # a number whose error bound is on the safe side of the limit
    MEASURED = "measured"  # statistics, or a search of stated resolution
    REFUTED = "refuted"  # a witness


@dataclass(frozen=True)
class Witness:
    """The exact directions and values that show a claim to be false.

    ``str`` prints every float so that it reads back as the same number.

    >>> print(Witness({"wo": [0.0, 0.0, 1.0]}, {"albedo": 1.5}))
    wo = (0.0, 0.0, 1.0): albedo = 1.5
    """

    directions: Mapping[str, Any] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)

    def __str__(self) -> str:
        places = ", ".join(f"{name} = {_plain(value)}" for name, value in self.directions.items())
        values = ", ".join(f"{name} = {_plain(value)}" for name, value in self.values.items())
        return f"{places}: {values}" if places else values

    def to_json(self) -> dict[str, Any]:
        """Return the witness as JSON-ready data."""
        return {"directions": jsonable(self.directions), "values": jsonable(self.values)}


def _plain(value: Any) -> str:
    array = np.asarray(value)
    if array.dtype.kind not in "fiu":
        return str(value)
    if array.ndim == 0:
        return repr(array.item())
    return "(" + ", ".join(_plain(item) for item in array) + ")"


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """One law put to one model, and what came of it.

    Parameters
    ----------
    check : str
        The law's short name, such as ``"energy"``.
    claim : str
        What was tested, as a formula in words.
    outcome : Outcome
        Or its text: ``"holds"``, ``"violated"`` or ``"inconclusive"``.
    evidence : Evidence
        Or its text: ``"proved"``, ``"bounded"``, ``"measured"`` or ``"refuted"``.
    message : str
        One line for a person: by how much, and where.
    witness : Witness, optional
        Present whenever the outcome is ``violated``.
    estimate : Estimate, optional
        The number that was compared with ``limit``.
    limit, p_value : float, optional
    evaluations : int
        How often the model was evaluated for it.
    seconds : float
        What it took [s].
    details : mapping
        Resolution of the search, and whatever else a program may want.

    Raises
    ------
    ParameterError
        When there is no such outcome or evidence.

    >>> Verdict(check="sum", claim="1 + 1 = 2", outcome="holds", evidence="proved").ok
    True
    """

    check: str
    claim: str
    outcome: Outcome
    evidence: Evidence
    message: str = ""
    witness: Witness | None = None
    estimate: Estimate | None = None
    limit: float | None = None
    p_value: float | None = None
    evaluations: int = 0
    seconds: float = 0.0
    details: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, kind in (("outcome", Outcome), ("evidence", Evidence)):
            given = getattr(self, name)
            if not isinstance(given, kind):
                if given not in list(kind):
                    raise ParameterError(name, given, "one of " + ", ".join(kind))
                object.__setattr__(self, name, kind(given))

    @property
    def ok(self) -> bool:
        """True only when the claim holds."""
        return self.outcome is Outcome.HOLDS

    def __str__(self) -> str:
        return f"{self.check}: {self.outcome} ({self.evidence}). {self.message}"

    def to_json(self) -> dict[str, Any]:
        """Return the verdict as JSON-ready data, as ``report.schema.json`` describes it."""
        return {name: jsonable(getattr(self, name)) for name in self.__dataclass_fields__}


def judge_upper_limit(
    estimate: Estimate, limit: float, tolerance: float = TOLERANCE
) -> tuple[Outcome, Evidence]:
    """Compare an estimate with an upper limit, never calling a doubtful case a pass.

    ``holds`` if value + error is within the limit and its tolerance, ``violated`` if value − error is
    beyond it, ``inconclusive`` otherwise.

    >>> judge_upper_limit(Estimate(0.9, 0.2, "truncation"), 1.0)[0].value
    'inconclusive'
    """
    low, high = estimate.interval(0.999)
    bounded = Evidence.BOUNDED if estimate.is_bound else Evidence.MEASURED
    if not (np.isfinite(estimate.value) and np.isfinite(estimate.error)):
        return Outcome.INCONCLUSIVE, bounded
    if high <= limit + tolerance:
        return Outcome.HOLDS, bounded
    if low > limit + tolerance:
        return Outcome.VIOLATED, Evidence.REFUTED
    return Outcome.INCONCLUSIVE, bounded
