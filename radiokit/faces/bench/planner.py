"""Planner: how far ``auto`` is from the best method that could have been forced, case by case."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from radiokit.facts.estimate import Estimate
from radiokit.facts.jsonable import jsonable
from radiokit.worlds.cases.catalogue import Case, case, list_cases
from radiokit.worlds.shading import shade

__all__ = ["LIMIT", "QUICK", "TOLERANCES", "Choice", "draw", "measure", "table"]

TOLERANCES = (1e-3, 1e-6)

QUICK = ("ggx-0.3-in-furnace-at-60deg", "lambert-under-disk", "phong-20-under-octant")
"""Cases of a run for continuous integration."""

LIMIT = 2.0
"""How many times slower than the best forced method ``auto`` may be."""

GLIMPSE = 0.02
"""Seconds that a Monte Carlo method gets; what it would need for the tolerance follows from its error."""

LONG_ENOUGH, WARM = 4e-3, 3
"""Seconds that are timed at a time, and calls whose quickest tells how many calls that takes."""

AGAIN = 1.4
"""A ratio above this is measured again, thrice as often and by the shortest times, which a busy machine
disturbs least: the largest of many ratios is mostly noise."""

LABELS = 6
"""Choices that are named in the picture, the worst."""

RIVALS = 2
"""Forced methods that are timed in turn with ``auto``, of those that a glimpse found to be fastest."""

RATES = {"qmc": 1.0}
"""Powers of the error by which the time grows: 2 for random samples, and at best 1 for even ones."""


@dataclass(frozen=True)
class Choice:
    """What ``auto`` took for a case at a tolerance, beside the fastest method that could be forced [s]."""

    case: str
    rtol: float
    method: str
    seconds: float
    best: str
    best_seconds: float
    ratio: float
    """How many times slower ``auto`` is."""
    exact: bool
    """Whether a sum or a closed form exists, and ``auto`` took one."""
    missed: bool
    """Whether one exists and ``auto`` did not take it."""

    def to_json(self) -> dict[str, Any]:
        """Return the choice as JSON-ready data."""
        return {name: jsonable(value) for name, value in asdict(self).items()}


def measure(
    names: Sequence[str] | None = None,
    *,
    repeats: int = 7,
    seed: int = 0,
    tolerances: Sequence[float] = TOLERANCES,
    progress: Callable[[int, int], None] | None = None,
) -> list[Choice]:
    """Measure the cases of shading (all of them unless named): medians of calls that alternate.

    A method that reaches the tolerance is timed as it is. One that does not within a glimpse is taken to need
    as much longer as its error, to the power of its rate, is too large.
    """
    cases = [case(name) for name in (list_cases() if names is None else names)]
    todo = [(each, rtol) for each in cases if each.scene is not None for rtol in tolerances]
    found = []
    for done, (each, rtol) in enumerate(todo):
        choice = _choice(each, rtol, repeats, seed)
        found.append(choice if choice.ratio < AGAIN else _choice(each, rtol, 3 * repeats, seed, np.min))
        if progress is not None:
            progress(done + 1, len(todo))
    return found


def _choice(
    problem: Case, rtol: float, repeats: int, seed: int, typical: Callable[..., Any] = np.median
) -> Choice:
    scene: Any = problem.scene

    def call(method: str, seconds: float | None = None) -> Callable[[int], Estimate]:
        return lambda repeat: shade(
            scene.f,
            scene.emitters,
            scene.wo,
            normal=scene.normal,
            position=scene.position,
            occluders=scene.occluders,
            method=method,
            rtol=rtol,
            seconds=seconds,
            rng=seed + repeat,
        )

    forced = [method for method in problem.methods if scene.applies(method)]
    whole = ("sum", "closed form", "quadrature")
    limits = {method: None if method in whole else GLIMPSE for method in forced}
    for method in forced:
        call(method, limits[method])(0)  # what is done once for all is not timed
    glimpses = {method: _needed(method, *_timed(call(method, limits[method])), rtol) for method in forced}
    rivals = sorted(forced, key=lambda method: glimpses[method])[:RIVALS]
    timings = _alternate([call("auto"), *(call(method, limits[method]) for method in rivals)], repeats)
    times = [
        [_needed(method, found, seconds, rtol) for found, seconds in timing]
        for method, timing in zip(("auto", *rivals), timings, strict=True)
    ]
    middle = [float(typical(each)) for each in times]
    best = int(np.argmin(middle[1:]))
    taken = timings[0][-1][0].method
    closed = all(part in ("sum", "closed form") or "integral along" in part for part in taken.split(" + "))
    return Choice(
        case=problem.name,
        rtol=rtol,
        method=taken,
        seconds=middle[0],
        best=rivals[best],
        best_seconds=middle[1 + best],
        ratio=middle[0] / middle[1 + best],
        exact=closed,
        missed=not closed and any(method in ("sum", "closed form") for method in forced),
    )


def _alternate(
    calls: Sequence[Callable[[int], Estimate]], repeats: int
) -> list[list[tuple[Estimate, float]]]:
    """Return the answers and seconds of calls that alternate, each timed for a few milliseconds."""
    counts = [math.ceil(LONG_ENOUGH / min(_timed(call)[1] for _ in range(WARM))) for call in calls]
    found: list[list[tuple[Estimate, float]]] = [[] for _ in calls]
    for repeat in range(repeats):
        for each, call, count in zip(found, calls, counts, strict=True):
            each.append(_timed(call, repeat, count))
    return found


def _timed(call: Callable[[int], Estimate], repeat: int = 0, count: int = 1) -> tuple[Estimate, float]:
    start = time.perf_counter()
    for _ in range(count):
        found = call(repeat)
    return found, (time.perf_counter() - start) / count


def _needed(method: str, found: Estimate, seconds: float, rtol: float) -> float:
    """Return the time [s] that a method needs for the tolerance, by what it reached in a time."""
    error, value = float(np.max(found.error)), float(np.max(np.abs(found.value)))
    if found.converged or (found.kind == "rounding" and error <= rtol * value):
        return seconds
    if found.is_bound or value == 0:
        return math.inf
    rate = next((power for name, power in RATES.items() if name in found.method), 2.0)
    return seconds * max(1.0, error / (rtol * value)) ** rate


def table(found: Sequence[Choice]) -> str:
    """Return the choices as a Markdown table, the worst first."""
    lines = [
        "| case | tolerance | auto took | ms | best forced | ms | auto / best |",
        "|---|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {each.case} | {each.rtol:g} | {each.method} | {1e3 * each.seconds:.3g} | {each.best} | "
        f"{1e3 * each.best_seconds:.3g} | {each.ratio:.2f} |"
        for each in sorted(found, key=lambda each: -each.ratio)
    ]
    return "\n".join(lines) + "\n"


def draw(found: Sequence[Choice], path: Path) -> Path:
    """Draw ``auto``'s time over the best forced method's, sorted, with the limit."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    kinds = {"sum or closed form": "tab:gray", "quadrature": "tab:blue", "Monte Carlo": "tab:orange"}
    order = sorted(found, key=lambda each: each.ratio)
    figure, axes = pyplot.subplots(figsize=(11, 6), layout="constrained")
    for kind, colour in kinds.items():
        places = [k for k, each in enumerate(order) if _kind(each) == kind]
        ratios = [order[k].ratio for k in places]
        if not places:
            continue
        axes.plot(places, ratios, "o", color=colour, markersize=4, label=f"{kind} ({len(places)})")
    axes.axhline(LIMIT, color="tab:red", linewidth=1)
    axes.axhline(1.0, color="black", linewidth=0.5)
    for k, each in list(enumerate(order))[-LABELS:]:
        taken = (
            each.method.split(" + ")[0].split(",")[0].replace("Gauss-Legendre over the light", "quadrature")
        )
        words = f"{each.case}, {each.rtol:g}: {taken}, against {each.best}"
        axes.annotate(
            words,
            (k, each.ratio),
            xytext=(0.8, 0.04 + 0.055 * (k - len(order) + LABELS)),
            textcoords="axes fraction",
            ha="right",
            fontsize=8,
            arrowprops={"arrowstyle": "-", "color": "0.7", "linewidth": 0.5, "relpos": (1.0, 0.5)},
        )
    axes.set_yscale("log")
    axes.set_ylim(top=max(2 * LIMIT, 1.2 * order[-1].ratio))
    axes.set_yticks([0.125, 0.25, 0.5, 1.0, 2.0, 4.0], labels=["1/8", "1/4", "1/2", "1", "2", "4"])
    axes.minorticks_off()
    low = min(0.4, 0.9 * order[0].ratio)
    axes.set_ylim(bottom=low)
    axes.set_xlabel("cases of shading at two tolerances, sorted")
    axes.set_ylabel("time of auto / time of the best forced method")
    axes.legend(loc="upper left")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)
    return path


def _kind(each: Choice) -> str:
    if each.exact:
        return "sum or closed form"
    return "Monte Carlo" if any(word in each.method for word in ("qmc", "mis", "mc-")) else "quadrature"
