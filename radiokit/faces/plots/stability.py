"""Stability diagram: the worst error of each kernel and of the textbook's formula, joined by a line."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from radiokit.faces.stability.measure import LIMIT, StabilityResult
from radiokit.faces.stability.row import PRECISIONS

__all__ = ["draw_row", "draw_stability"]

KERNEL, TEXTBOOK = "#0b6e4f", "#c8553d"
FLOOR = 0.1
"""Errors below this, in ulps, are drawn here: the rounding of the result alone is half an ulp."""


def draw_stability(results: Sequence[StabilityResult], path: Path) -> Path:
    """Draw all rows into ``path``, a panel for each precision, whose folder is made when it is missing."""
    figure = _figure(11.0, 1.6 + 0.3 * len(results))
    panels = figure.subplots(1, len(PRECISIONS), sharey=True)
    right = _right(results)
    for axes, name in zip(panels, PRECISIONS, strict=True):
        _draw_panel(axes, results, name, right)
    panels[0].set_yticks(range(len(results)), [result.row.title for result in results], fontsize=8)
    panels[0].set_ylim(len(results) - 0.4, -0.6)
    _legend(figure, panels[0])
    return _save(figure, path)


def draw_row(result: StabilityResult, path: Path) -> Path:
    """Draw the errors of one row along its hard axis into ``path``, a panel for each precision."""
    figure = _figure(9.0, 4.2)
    panels = figure.subplots(1, len(PRECISIONS), sharey=True)
    right = _right([result])
    for axes, name in zip(panels, PRECISIONS, strict=True):
        for accuracy, colour, label in _forms(result, name):
            errors = np.array(accuracy.errors)
            drawn = np.where(np.isfinite(errors), np.clip(errors, FLOOR, right / 10), right)
            axes.plot(accuracy.values, drawn, color=colour, marker="o", ms=4, lw=1.3, label=label)
        axes.axhline(LIMIT, color="black", lw=0.7, ls="--")
        axes.set_xscale("log")
        if accuracy.values[0] > accuracy.values[-1]:
            axes.invert_xaxis()
        axes.tick_params(axis="x", labelsize=8)
        axes.set_yscale("log")
        axes.set_ylim(FLOOR / 2, 3 * right)
        _infinite(axes.yaxis, right)
        axes.set_title(name, fontsize=10)
        axes.set_xlabel(f"{result.row.axis}, harder to the right", fontsize=9)
        axes.grid(which="major", lw=0.3)
    panels[0].set_ylabel("error [ulps / condition number]", fontsize=9)
    figure.suptitle(result.row.title, fontsize=11)
    _legend(figure, panels[0])
    return _save(figure, path)


def _draw_panel(axes: Any, results: Sequence[StabilityResult], name: str, right: float) -> None:
    axes.axvspan(FLOOR / 3, LIMIT, color=KERNEL, alpha=0.07, lw=0)
    axes.axvline(LIMIT, color="black", lw=0.7, ls="--")
    for place, result in enumerate(results):
        ends = []
        for (accuracy, colour, label), size in zip(_forms(result, name), (7.5, 6.0), strict=True):
            end = float(np.clip(accuracy.worst, FLOOR, right / 10)) if accuracy.finite else right
            ends.append(end)
            style = {"color": colour, "ms": size, "mec": "white", "mew": 0.6, "zorder": 3}
            kept = label if place == 0 else None
            axes.plot([end], [place], "o" if accuracy.finite else "X", label=kept, **style)
        axes.plot(ends, [place, place], color="#b8b8b8", lw=1.6, zorder=2, solid_capstyle="round")
        text = f"{result.kernel[name].digits:.0f} → {result.textbook[name].digits:.0f}"
        axes.text(1.01, place, text, transform=axes.get_yaxis_transform(), va="center", fontsize=7.5)
    axes.text(1.01, -1.0, "digits left", transform=axes.get_yaxis_transform(), va="bottom", fontsize=7.5)
    axes.set_xscale("log")
    axes.set_xlim(FLOOR / 3, 4 * right)
    _infinite(axes.xaxis, right)
    axes.set_title(name, fontsize=11)
    axes.set_xlabel("worst error [ulps / condition number]", fontsize=9)
    axes.grid(axis="x", which="major", lw=0.3)
    axes.tick_params(axis="y", length=0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)


def _forms(result: StabilityResult, name: str) -> tuple[tuple[Any, str, str], ...]:
    return (
        (result.kernel[name], KERNEL, "radiokit's kernel"),
        (result.textbook[name], TEXTBOOK, "the textbook's formula"),
    )


def _right(results: Sequence[StabilityResult]) -> float:
    """Return where what is not finite is drawn: a hundred times beyond the worst finite error."""
    worst = [
        error
        for result in results
        for form in (result.kernel, result.textbook)
        for accuracy in form.values()
        for error in accuracy.errors
        if np.isfinite(error)
    ]
    return float(10.0 ** (np.ceil(np.log10(max(*worst, 1e3))) + 2))


def _infinite(axis: Any, right: float) -> None:
    """Label decades, and the place where NaN and infinity are drawn."""
    ticks = [10.0**k for k in range(0, round(np.log10(right)) - 1, 4)]
    axis.set_ticks(
        [*ticks, right], [*(f"$10^{{{round(np.log10(t))}}}$" for t in ticks), "NaN, ∞"], fontsize=8
    )
    axis.set_ticks([], minor=True)


def _figure(width: float, height: float) -> Any:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _legend(figure: Any, axes: Any) -> None:
    from matplotlib.lines import Line2D

    handles, labels = axes.get_legend_handles_labels()
    handles = [Line2D([], [], marker="o", ls="none", ms=7, color=handle.get_color()) for handle in handles]
    handles.append(Line2D([], [], color="black", lw=0.7, ls="--"))
    labels = [*labels, f"the limit: {LIMIT:g} ulps × condition number"]
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8, frameon=False)


def _save(figure: Any, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    return path
