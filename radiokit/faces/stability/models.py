"""Models: each BSDF's value kernel against its twin, at hard directions and at the ends of its parameters."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, REGISTRY, FloatArray
from radiokit.faces.stability.grid import DARK, edge_pairs, examples, extremes, hard_pairs, value_ulps
from radiokit.faces.stability.measure import LIMIT
from radiokit.faces.workers import SerialExecutor
from radiokit.facts.errors import RadiokitError
from radiokit.facts.jsonable import jsonable
from radiokit.facts.verdict import Outcome
from radiokit.measure.twin import Twin, working_precision

__all__ = ["Examined", "ModelStability", "chosen_models", "examine", "model_stability", "shown_parameters"]

_DIGITS = 50
_FEW, _MORE = 60, 130  # digits of two evaluations that usually agree, so that thousands are not needed
_MOST = 2000
_ULP_DIGITS = 16  # a step of 1e-16, which is what float64 does to its inputs
_THIN = 2  # of the ordinary pairs one in so many, unless the grid is dense


@dataclass(frozen=True)
class Examined:
    """One parameter set of a model on the hard grid.

    Parameters
    ----------
    parameters : dict
        The model's.
    worst : float
        Largest error, in ulps over max(1, condition number); infinite where the kernel is not finite.
    wi, wo : tuple of float
        The pair where it is.
    value, exact, condition : float
        What the kernel gives there, the truth rounded to float64, and the condition number.
    pairs, nonfinite : int
        How many pairs, and how many values that were NaN or infinite.
    undecided : tuple of str
        Why the twin gives no value, for each pair where it does not.
    seconds : float
    """

    parameters: dict[str, Any]
    worst: float
    wi: tuple[float, ...]
    wo: tuple[float, ...]
    value: float
    exact: float
    condition: float
    pairs: int
    nonfinite: int
    undecided: tuple[str, ...]
    seconds: float

    @property
    def ok(self) -> bool:
        """Whether the kernel is finite and within the limit, and the twin has a value, everywhere."""
        return self.worst <= LIMIT and not self.nonfinite and not self.undecided

    def to_json(self) -> dict[str, Any]:
        """Return the findings as JSON-ready data; an infinite error is text."""
        data = {name: getattr(self, name) for name in self.__dataclass_fields__}
        result: dict[str, Any] = jsonable(data | {"ok": self.ok})
        return result


@dataclass(frozen=True)
class ModelStability:
    """A model over all its parameter sets; ``refused`` counts ends of ranges that it does not allow."""

    name: str
    sets: tuple[Examined, ...]
    refused: int

    @property
    def worst(self) -> Examined:
        """The parameter set with the largest error."""
        return max(self.sets, key=lambda found: (bool(found.nonfinite), found.worst))

    @property
    def seconds(self) -> float:
        """Processor time of all sets."""
        return sum(found.seconds for found in self.sets)

    @property
    def outcome(self) -> Outcome:
        """``holds`` if all sets are within the limit, ``violated`` if one is not, else ``inconclusive``."""
        if any(found.worst > LIMIT or found.nonfinite for found in self.sets):
            return Outcome.VIOLATED
        return Outcome.HOLDS if all(found.ok for found in self.sets) else Outcome.INCONCLUSIVE

    def to_json(self) -> dict[str, Any]:
        """Return the findings as JSON-ready data; an infinite error is text."""
        result: dict[str, Any] = jsonable(
            {
                "model": self.name,
                "outcome": str(self.outcome),
                "limit": LIMIT,
                "worst": self.worst.worst,
                "refused": self.refused,
                "seconds": self.seconds,
                "sets": self.sets,
            }
        )
        return result


def chosen_models(names: Iterable[str] | None) -> dict[str, type[BSDF]]:
    """Return the model classes called ``names``, or all of them.

    Raises
    ------
    UnknownNameError
        When there is no such model.
    """
    return {name: REGISTRY.get(name) for name in (REGISTRY.names() if names is None else names)}


def model_stability(
    names: Iterable[str] | None = None,
    *,
    dense: bool = False,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[ModelStability, ...]:
    """Examine the models called ``names``, or all, at their examples and at the ends of their parameters.

    Parameters
    ----------
    names : iterable of str, optional
    dense : bool
        Whether to look at all pairs of the grid, and not at all edges and half of the rest.
    executor : concurrent.futures.Executor, optional
        Where the work is done; the findings do not depend on it.
    progress : callable, optional
        Called with the number of finished parameter sets and the number of all.

    >>> [(r.name, str(r.outcome), len(r.sets)) for r in model_stability(["lambert"])]
    [('lambert', 'holds', 3)]
    """
    tasks: list[tuple[str, BSDF, bool]] = []
    refused = {}
    for name, cls in chosen_models(names).items():
        ends, refused[name] = extremes(cls)
        tasks += [(name, f, dense) for f in (*examples(cls), *ends)]
    found: dict[str, list[Examined]] = {name: [] for name in refused}
    results = (executor or SerialExecutor()).map(_task, tasks)
    for done, (task, result) in enumerate(zip(tasks, results, strict=True), start=1):
        found[task[0]].append(result)
        if progress is not None:
            progress(done, len(tasks))
    return tuple(ModelStability(name, tuple(sets), refused[name]) for name, sets in found.items())


def _task(task: tuple[str, BSDF, bool]) -> Examined:
    return examine(task[1], dense=task[2])


def examine(f: BSDF, *, dense: bool = False) -> Examined:
    """Return how far the values of ``f`` are from its twin's, where they are hardest to compute.

    Condition numbers cost far more than values: they are worked out from the largest error down, until the
    next error is below the worst quotient found.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> examine(bsdf("lambert")).worst <= 1
    True
    """
    start = time.perf_counter()
    seed = int.from_bytes(hashlib.sha256(repr(f).encode()).digest()[:8], "big")
    wi, wo = hard_pairs(f, np.random.default_rng(seed))
    step = 1 if dense else _THIN
    wi, wo = (np.concatenate([few[::step], edge]) for few, edge in zip((wi, wo), edge_pairs(f), strict=True))
    twin = f.symbolic()
    with np.errstate(all="ignore"):
        values = np.asarray(f.evaluate(wi, wo), dtype=float)
    truths: list[Any] = []
    undecided = []
    for i, o in zip(wi, wo, strict=True):
        try:
            truths.append(_truth(twin, i, o))
        except (RadiokitError, ArithmeticError, TypeError, ValueError) as problem:
            undecided.append(f"{type(problem).__name__} at wi = {i.tolist()}, wo = {o.tolist()}")
            truths.append(None)
    known = np.array([k for k, truth in enumerate(truths) if truth is not None], dtype=int)
    raw = np.array([value_ulps(values[k], truths[k]) for k in known])
    worst, where, condition = -1.0, int(known[0]) if len(known) else 0, 0.0
    for k, error in sorted(zip(known.tolist(), raw.tolist(), strict=True), key=lambda item: -item[1]):
        if error <= worst:
            break
        here = _condition(twin, wi[k], wo[k])
        scaled = value_ulps(values[k], truths[k], here)
        if scaled > LIMIT:  # beside a zero of high order a rounding is no small step: take one as it is
            here = max(here, _condition(twin, wi[k], wo[k], _ULP_DIGITS))
            scaled = value_ulps(values[k], truths[k], here)
        if scaled > worst:
            worst, where, condition = scaled, k, here
    truth = truths[where]
    return Examined(
        parameters=f.parameters(),
        worst=max(worst, 0.0),
        wi=tuple(wi[where].tolist()),
        wo=tuple(wo[where].tolist()),
        value=float(values[where]),
        exact=float("nan") if truth is None else float(truth),
        condition=condition,
        pairs=len(wi),
        nonfinite=int(np.count_nonzero(~np.isfinite(values))),
        undecided=tuple(undecided),
        seconds=time.perf_counter() - start,
    )


def _truth(twin: Twin, wi: FloatArray, wo: FloatArray) -> Any:
    """Return the twin's value to 50 digits, by two cheap evaluations where they agree and are not 0."""
    few, more = twin.rough(wi, wo, _FEW), twin.rough(wi, wo, _MORE)
    with working_precision(_MORE):
        if more and abs(few - more) <= abs(more) / 10**_DIGITS:
            return more
    try:
        return twin.evaluate(wi, wo, digits=_DIGITS)
    except RadiokitError:
        last = twin.rough(wi, wo, _MOST)
        if abs(last) < DARK and abs(last) <= abs(more) / 10**_DIGITS:
            return last  # what shrinks with every digit is 0
        raise


def _condition(twin: Twin, wi: FloatArray, wo: FloatArray, digits: int = 20) -> float:
    """Return the condition number; infinite, which excuses nothing, where there is none."""
    try:
        return twin.condition(wi, wo, digits=digits)
    except (RadiokitError, ArithmeticError):
        return float("inf")


def shown_parameters(parameters: dict[str, Any]) -> str:
    """Return parameters as a line of text, without those that are not given.

    >>> shown_parameters({"alpha": 0.5, "eta": None, "distribution": "ggx"})
    'alpha=0.5, distribution=ggx'
    """
    return ", ".join(
        f"{name}={value:g}" if isinstance(value, float) else f"{name}={value}"
        for name, value in parameters.items()
        if value is not None
    )
