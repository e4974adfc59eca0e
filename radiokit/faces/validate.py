"""Validate: the main job: derivations, the lecture, every model before the judges, every case."""

from __future__ import annotations

import platform
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import Any

from radiokit.checks.claims import claims
from radiokit.checks.judge import check
from radiokit.contracts.bsdf import REGISTRY, bsdf
from radiokit.faces.proofs import prove
from radiokit.faces.workers import SerialExecutor
from radiokit.facts.errors import RadiokitError, UnknownNameError
from radiokit.facts.jsonable import jsonable
from radiokit.facts.report import EXIT_CODES, Report
from radiokit.facts.verdict import Evidence, Outcome, Verdict
from radiokit.measure.statistics import sidak
from radiokit.physics.relations.catalogue import list_derivations, unverified
from radiokit.physics.relations.derivation import Derivation, Finding
from radiokit.worlds.cases.catalogue import case, list_cases
from radiokit.worlds.lecture.ledger import lecture_claims

__all__ = ["LEVEL", "CaseRow", "Validation", "everything", "validate"]

LEVEL = 1e-6
"""Chance that a run rejects something right, over all its statistical tests together."""

MUST_HOLD = ("values", "claims", "sampling", "microfacet")
"""What must hold of a model; a law that it breaks as claimed is no fault."""


@dataclass(frozen=True)
class CaseRow:
    """One closed-form case by one method: the answer, the truth, and the cost."""

    case: str
    method: str
    exact: float
    verdict: Verdict

    @property
    def true_error(self) -> float | None:
        """Return |value − exact|, or None when the method gave no value."""
        estimate = self.verdict.estimate
        return None if estimate is None else float(abs(estimate.value - self.exact))

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON-ready data."""
        estimate = self.verdict.estimate
        return {
            "case": self.case,
            "method": self.method,
            "exact": jsonable(self.exact),
            "value": None if estimate is None else jsonable(estimate.value),
            "true_error": jsonable(self.true_error),
            "claimed_error": None if estimate is None else jsonable(estimate.error),
            "kind": None if estimate is None else estimate.kind,
            "ratio": None if estimate is None else jsonable(estimate.ratio(self.exact)),
            "p_value": jsonable(self.verdict.p_value),
            "evaluations": self.verdict.evaluations,
            "seconds": self.verdict.seconds,
            "outcome": str(self.verdict.outcome),
            "message": self.verdict.message,
        }


@dataclass(frozen=True)
class Validation:
    """What a run of ``validate`` found, and on which machine."""

    models: tuple[Report, ...]
    cases: tuple[CaseRow, ...]
    seconds: float
    workers: int
    derivations: tuple[Derivation, ...] = ()
    lecture: tuple[Verdict, ...] = ()

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of what must hold."""
        found = {row.verdict.outcome for row in self.cases} | {each.outcome for each in self.derivations}
        found |= {verdict.outcome for verdict in self.lecture}
        found |= {v.outcome for report in self.models for v in report if v.check in MUST_HOLD}
        for outcome in (Outcome.VIOLATED, Outcome.INCONCLUSIVE):
            if outcome in found:
                return outcome
        return Outcome.HOLDS

    @property
    def exit_code(self) -> int:
        """0 when all holds, 1 on a violation, 3 when something is inconclusive."""
        return EXIT_CODES[self.outcome]

    def to_json(self) -> dict[str, Any]:
        """Return the run as JSON-ready data."""
        return {
            "outcome": str(self.outcome),
            "level": LEVEL,
            "seconds": self.seconds,
            "workers": self.workers,
            "machine": machine(),
            "models": [report.to_json() for report in self.models],
            "cases": [row.to_json() for row in self.cases],
            "derivations": [each.verdict.to_json() for each in self.derivations],
            "lecture": [verdict.to_json() for verdict in self.lecture],
        }


def machine() -> dict[str, str]:
    """Return what ran: the versions, the processor and the system."""
    packages = ("numpy", "scipy", "sympy")
    return {
        "radiokit": version("radiokit"),
        "python": platform.python_version(),
        **{name: version(name) for name in packages},
        "machine": platform.machine(),
        "system": platform.system(),
    }


def everything(
    names: Iterable[str] | None = None,
) -> tuple[list[tuple[str, dict[str, Any]]], list[tuple[str, str]]]:
    """Return what is validated: models with their parameters, and cases with their methods.

    Raises
    ------
    UnknownNameError
        When one of ``names`` is no model, case or derivation, nor "lecture".

    >>> everything(["lambert"])[0][1]
    ('lambert', {'reflectance': 0.5})
    """
    models = [(name, dict(values)) for name, cls in REGISTRY.classes.items() for values in cls.EXAMPLES]
    rows = [(name, method) for name in list_cases() for method in case(name).methods]
    if names is None:
        return models, rows
    wanted, known = list(names), [*REGISTRY.classes, *list_cases(), *list_derivations(), "lecture"]
    for name in wanted:
        if name not in known:
            raise UnknownNameError("model or case", name, known)
    return [one for one in models if one[0] in wanted], [one for one in rows if one[0] in wanted]


def validate(
    *,
    names: Iterable[str] | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> Validation:
    """Verify every derivation, put every model before every judge, answer every case by every method.

    Parameters
    ----------
    names : iterable of str, optional
        Only these models, cases and derivations; "lecture" for the lecture's claims.
    executor : concurrent.futures.Executor, optional
        Where the work is done; the findings do not depend on it.
    workers : int
        How many workers it has, for the record.
    seed : int
        For the Monte Carlo methods.
    progress : callable, optional
        Called with the number of finished tasks and the number of all.
    """
    start = time.perf_counter()
    names = None if names is None else list(names)
    models, rows = everything(names)
    count = len(models) + len(rows)  # all share the level, whether or not they are statistical
    tasks: list[tuple[Any, ...]] = [("model", name, values, count) for name, values in models]
    tasks += [("case", name, method, count, seed + i) for i, (name, method) in enumerate(rows)]
    tasks += [("derivation", name) for name in list_derivations() if names is None or name in names]
    if names is None or "lecture" in names:
        tasks += [("lecture", claim.entry.name) for claim in lecture_claims()]
    found = list(_run(executor or SerialExecutor(), tasks, progress))
    return Validation(
        models=tuple(item for item in found if isinstance(item, Report)),
        cases=tuple(item for item in found if isinstance(item, CaseRow)),
        seconds=time.perf_counter() - start,
        workers=workers,
        derivations=tuple(item for item in found if isinstance(item, Derivation)),
        lecture=tuple(item for item in found if isinstance(item, Verdict)),
    )


def _run(
    executor: Executor, tasks: Sequence[tuple[Any, ...]], progress: Callable[[int, int], None] | None
) -> Iterator[Report | CaseRow | Derivation | Verdict]:
    for done, item in enumerate(executor.map(_task, tasks), start=1):
        if progress is not None:
            progress(done, len(tasks))
        if isinstance(item, tuple):  # findings travel between processes, symbols do not
            name, findings = item
            yield replace(unverified(name), findings=findings)
        else:
            yield item


def _task(task: tuple[Any, ...]) -> Report | CaseRow | Verdict | tuple[str, tuple[Finding, ...]]:
    if task[0] == "derivation":
        return prove((task[1], False))
    if task[0] == "lecture":
        return lecture_claims()[task[1]].judgement
    if task[0] == "model":
        return _judge_model(*task[1:])
    return _answer_case(*task[1:])


def _judge_model(name: str, values: dict[str, Any], tests: int) -> Report:
    model = bsdf(name, **values)
    report = check(model, tests=tests)
    return replace(report, verdicts=(*report.verdicts, claims(model, report)))


def _answer_case(name: str, method: str, tests: int, seed: int) -> CaseRow:
    problem = case(name)
    try:
        verdict = problem.verdict(method, seed, level=sidak(LEVEL, tests))
    except RadiokitError as error:
        verdict = Verdict(
            check=name,
            claim=problem.title,
            outcome=Outcome.VIOLATED,
            evidence=Evidence.MEASURED,
            message=f"the method failed: {error}",
        )
    return CaseRow(name, method, problem.exact, verdict)
