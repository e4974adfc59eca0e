"""Work-precision diagram: error against time, one line for each method, on the furnace of a rough metal."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from radiokit.contracts.albedo import albedo
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.bench.methods import classroom_rule, fixed_slope_rule
from radiokit.facts.estimate import Estimate
from radiokit.worlds.cases.catalogue import Case, case

__all__ = ["FURNACES", "Line", "draw_work_precision", "work_precision"]

FURNACES = ("ggx-0.3-in-furnace-at-60deg", "ggx-0.05-in-furnace-at-89deg")
"""An easy furnace and a hard one: a narrow lobe at grazing incidence."""

STYLES = {
    "slope-space rule": ("#0b6e4f", "o"),
    "Gauss-Legendre in cosθ × φ": ("#999999", "s"),
    "Monte Carlo, BSDF-sampled": ("#1f5fbf", "^"),
    "Monte Carlo, light-sampled": ("#c8553d", "v"),
    "balance heuristic": ("#8e44ad", "D"),
    "shifted lattices": ("#17a2b8", "P"),
    "Monte Carlo, compiled": ("#0a2472", "h"),
    "NumPy, whole arrays": ("#444444", "1"),
    "C, OpenMP": ("#d4a017", "x"),
    "Mitsuba llvm_ad_rgb": ("#e67e22", "+"),
    "Mitsuba llvm_ad_rgb render": ("#d35400", "*"),
    "SciPy dblquad": ("#b03a8c", "<"),
    "SciPy cubature": ("#7f8c2a", ">"),
}
SIZES = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
SAMPLES = tuple(4**k for k in range(3, 9))
MANY_SAMPLES = tuple(4**k for k in range(4, 12))
SEEDS = 8
REPEATS = 3
FLOOR = 1e-16


@dataclass(frozen=True)
class Line:
    """One method: its relative true error at each of several costs, and what it claimed where it claims."""

    method: str
    seconds: list[float]
    evaluations: list[int]
    error: list[float]
    claimed: list[float] | None = None


def work_precision(name: str = FURNACES[0], *, seed: int = 0) -> list[Line]:
    """Measure every method on one furnace case, at rising cost.

    Quadrature errors are those of one run; Monte Carlo errors are the root mean square over eight seeds,
    beside the mean standard error that was claimed. Times are the best of three.
    """
    furnace = case(name)
    scene: Any = furnace.scene
    f, wo = scene.f, np.asarray(scene.wo)
    lines = [
        _rule("slope-space rule", lambda n: fixed_slope_rule(f, wo, n), furnace.exact),
        _rule("Gauss-Legendre in cosθ × φ", lambda n: classroom_rule(f, wo, n), furnace.exact),
    ]
    for label, method in (
        ("Monte Carlo, BSDF-sampled", "mc-bsdf"),
        ("Monte Carlo, light-sampled", "mc-light"),
        ("balance heuristic", "mis"),
        ("shifted lattices", "qmc"),
    ):
        if method in furnace.methods:
            answer = partial(_answer, furnace, method)
            lines.append(_sampled(label, answer, furnace.exact, seed, SAMPLES))
    compiled = partial(_albedo, f, wo)
    compiled(seed, SAMPLES[0])  # compiles, uncounted
    lines.append(_sampled("Monte Carlo, compiled", compiled, furnace.exact, seed, MANY_SAMPLES))
    return lines


def _answer(furnace: Case, method: str, seed: int, samples: int) -> Estimate:
    return furnace.run(method, seed, samples=samples)


def _albedo(f: BSDF, wo: Any, seed: int, samples: int) -> Estimate:
    return albedo(f, wo, method="mc", samples=samples, rng=seed)


def draw_work_precision(
    path: Path,
    *,
    names: Sequence[str] = FURNACES,
    seed: int = 0,
    more: Callable[[str, int], list[Line]] | None = None,
) -> Path:
    """Draw one panel for each furnace case into ``path``, whose folder is made when it is missing.

    ``more(name, seed)`` measures further lines of a panel.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.6 * len(names), 4.8), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(names), sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, names, strict=True):
        lines = work_precision(name, seed=seed) + (more(name, seed) if more else [])
        _draw_panel(axes, name, lines)
    panels[0].set_ylabel("relative error")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=min(len(labels), 4), fontsize=8, frameon=False
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    return path


def _draw_panel(axes: Any, name: str, lines: list[Line]) -> None:
    for line in lines:
        colour, marker = STYLES[line.method]
        milliseconds = np.multiply(1e3, line.seconds)
        error = np.maximum(line.error, FLOOR)
        axes.loglog(milliseconds, error, marker=marker, ms=4, lw=1.2, color=colour, label=line.method)
        if line.claimed is not None:
            axes.loglog(milliseconds, np.maximum(line.claimed, FLOOR), ls=":", lw=1.2, color=colour)
    axes.axhline(np.finfo(float).eps, color="black", lw=0.6, ls="--")
    place = axes.get_yaxis_transform()
    axes.text(0.99, 1.4 * np.finfo(float).eps, "float64", transform=place, ha="right", size=8)
    axes.set_xlabel("time [ms]")
    axes.set_title(f"{case(name).title}\n(dotted: the standard error that was claimed)", size=9)
    axes.grid(which="major", lw=0.3)


def _rule(label: str, rule: Callable[[int], float], exact: float) -> Line:
    seconds, error = [], []
    for n in SIZES:
        best = np.inf
        for _ in range(REPEATS):
            start = time.perf_counter()
            value = rule(n)
            best = min(best, time.perf_counter() - start)
        seconds.append(float(best))
        error.append(abs(value / exact - 1))
    return Line(label, seconds, [n * n for n in SIZES], error)


def _sampled(
    label: str, answer: Callable[[int, int], Estimate], exact: float, seed: int, sizes: Sequence[int]
) -> Line:
    seconds, evaluations, error, claimed = [], [], [], []
    for samples in sizes:
        runs = [answer(seed + k, samples) for k in range(SEEDS)]
        off = np.array([run.value - exact for run in runs]) / exact
        seconds.append(float(np.min([run.seconds for run in runs])))
        evaluations.append(runs[0].evaluations)
        error.append(float(np.sqrt(np.mean(off**2))))
        claimed.append(float(np.sqrt(np.mean([run.error**2 for run in runs])) / exact))
    return Line(label, seconds, evaluations, error, claimed)
