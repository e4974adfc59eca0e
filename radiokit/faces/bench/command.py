"""Command: ``radiokit bench``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Annotated, Any

import typer

from radiokit.faces.bench.rows import size_text
from radiokit.faces.console import progress_bar, show_json, show_table, write

__all__ = ["bench"]


def bench(
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    quick: Annotated[bool, typer.Option("--quick", help="A run for continuous integration.")] = False,
    compare: Annotated[Path | None, typer.Option(help="An earlier run's JSON, to compare with.")] = None,
    repeats: Annotated[int | None, typer.Option(help="Repetitions, whose medians count; 7, or 3.")] = None,
    seed: Annotated[int, typer.Option(help="Seed of the Monte Carlo methods.")] = 0,
    figures: Annotated[Path, typer.Option(help="Folder of the work-precision diagram.")] = Path("figures"),
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Draw nothing.")] = False,
    planner: Annotated[bool, typer.Option("--planner", help="Only auto beside every forced method.")] = False,
) -> None:
    """Measure accuracy and speed, beside other implementations; exit code 1 if something got worse."""
    if planner:
        _planner(json, quick, repeats, seed, None if no_figures else figures)
        return
    from radiokit.faces.bench.compare import compare as find_changes
    from radiokit.faces.bench.compare import load
    from radiokit.faces.bench.run import bench as run

    earlier = None if compare is None else load(compare)
    with progress_bar("measuring", not json) as progress:
        found = run(quick=quick, seed=seed, repeats=repeats, progress=progress)
    changes = [] if earlier is None else find_changes(earlier, found.to_json())
    drawn = None
    if not (no_figures or quick):
        from radiokit.faces.bench.diagram import draw

        drawn = draw(figures / "work-precision-peers.png", seed=seed)
    if json:
        more: dict[str, Any] = {"figures": [] if drawn is None else [str(drawn)]}
        if earlier is not None:
            more["changes"] = [change.to_json() for change in changes]
        show_json(found.to_json() | more)
    else:
        _show(found)
        if drawn is not None:
            write(f"work-precision diagram: {drawn}")
        for change in changes:
            write(f"{change.kind}: {change.what}: {change.message}")
        if earlier is not None and not changes:
            write(f"nothing is slower or less accurate than in {compare}")
    if changes or found.dishonest:
        raise typer.Exit(1)


def _planner(json: bool, quick: bool, repeats: int | None, seed: int, figures: Path | None) -> None:
    """Measure ``auto`` on the cases of shading; exit code 1 if it misses a closed form or takes too long."""
    from radiokit.faces.bench.planner import LIMIT, QUICK, draw, measure, table

    with progress_bar("measuring", not json) as progress:
        found = measure(
            QUICK if quick else None, repeats=repeats or (3 if quick else 7), seed=seed, progress=progress
        )
    worst = max(found, key=lambda each: each.ratio)
    missed = [each for each in found if each.missed]
    files: list[str] = []
    if figures is not None and not quick:
        files = [str(draw(found, figures / "planner.png")), str(figures / "planner.md")]
        Path(files[1]).write_text(table(found), encoding="utf-8")
    if json:
        data = {"choices": [each.to_json() for each in found], "limit": LIMIT, "figures": files}
        show_json(data)
    else:
        ordered = sorted(found, key=lambda each: -each.ratio)
        show_table(
            "auto beside the fastest method that could be forced, the worst first",
            ("case", "tolerance", "auto took", "ms", "best forced", "ms", "auto / best"),
            [
                (
                    each.case,
                    f"{each.rtol:g}",
                    each.method,
                    f"{1e3 * each.seconds:.3g}",
                    each.best,
                    f"{1e3 * each.best_seconds:.3g}",
                    f"{each.ratio:.2f}",
                )
                for each in (ordered if quick else ordered[:30])
            ],
        )
        write(f"auto is at worst {worst.ratio:.2f} times slower: {worst.case}, {worst.rtol:g}")
        for name in files:
            write(f"written: {name}")
    if missed or worst.ratio > LIMIT:
        raise typer.Exit(1)


def _show(found: Any) -> None:
    kinds = ", ".join(f"{name} {value}" for name, value in found.machine.items())
    write(f"measured in turn, medians of {found.settings['repeats']} repetitions; {kinds}")
    show_table(
        "radiokit / peer: how many times faster, and more efficient (1 / (variance × time))",
        ("albedo", "peer", "radiokit", "faster", "efficiency", "qmc efficiency", "error", "peer's error"),
        [
            (
                each.task,
                each.peer,
                f"{each.rival}, {size_text(each.size)}",
                f"{each.speed:.3g} ± {100 * each.noise:.0f} %",
                _number(each.efficiency),
                _number(each.qmc_efficiency),
                f"{each.error:.1e}",
                f"{each.peer_error:.1e}",
            )
            for each in found.ratios
        ],
    )
    show_table(
        f"throughput: {found.throughput[0].task}, {size_text(found.throughput[0].size)} samples, "
        f"{found.machine['threads']} threads",
        ("method", "million samples / s", "radiokit / it", "efficiency", "error", "claimed"),
        list(_throughput(found)),
    )
    for name, note in found.notes.items():
        write(f"{name}: {note}")
    for name, reason in found.absent.items():
        write(f"no row for {name}: {reason}")
    show_table(
        f"all {len(found.truths)} tasks, relative errors",
        ("method", "size", "median error", "worst error", "on", "evaluations", "ms", "per second"),
        list(_methods(found.rows)),
    )
    show_table(
        "how the error falls with the evaluations N, or the nodes n along an axis",
        ("method", "tasks", "law", "median", "from", "to", "digits a node", "due", "met by"),
        list(_slopes(found.slopes)),
    )
    for slope in found.slopes:
        if slope.met is False:
            write(f"not as due: {slope.task} by {slope.method}: {slope}, where {slope.due} is due")
    show_table(
        "fresh processes, ms",
        ("method", "Numba cache", "samples", "numpy", "+ radiokit", "+ first call", "= total", "second call"),
        [
            (
                each.method,
                each.cache,
                "" if each.method == "quadrature" else each.samples,
                f"{1e3 * each.numpy_seconds:.0f}",
                f"{1e3 * each.import_seconds:.0f}",
                f"{1e3 * each.first_seconds:.0f}",
                f"{1e3 * each.total_seconds:.0f}",
                f"{1e3 * each.second_seconds:.2f}",
            )
            for each in found.starts
        ],
    )
    rare = sum(each.rare for each in found.rows)
    if rare:
        write(f"{rare} standard errors miss events too rare to have been drawn (narrow lobes)")
    for each in found.dishonest:
        write(
            f"claims too little: {each.task} by {each.method} ({size_text(each.size)}): an error of "
            f"{each.true_error:.1e}, claimed {each.claimed_error:.1e}"
        )


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.3g}"


def _methods(rows: Any) -> Iterator[tuple[Any, ...]]:
    groups: dict[tuple[str, float], list[Any]] = {}
    for each in rows:
        groups.setdefault((each.method, each.size), []).append(each)
    for (method, size), group in groups.items():
        worst = max(group, key=lambda each: each.true_error / abs(each.exact))
        yield (
            method,
            size_text(size),
            f"{median(each.true_error / abs(each.exact) for each in group):.1e}",
            f"{worst.true_error / abs(worst.exact):.1e}",
            worst.task,
            f"{median(each.evaluations for each in group):.0f}",
            f"{1e3 * median(each.seconds for each in group):.3g}",
            f"{median(each.throughput for each in group):.2g}",
        )


def _throughput(found: Any) -> Iterator[tuple[Any, ...]]:
    ratios = {each.peer: each for each in found.throughput_ratios}
    for each in found.throughput:
        ratio = ratios.get(each.method)
        yield (
            each.method if ratio else f"radiokit, {each.method}",
            f"{each.throughput / 1e6:.0f}",
            f"{ratio.speed:.3g} ± {100 * ratio.noise:.0f} %" if ratio else "",
            _number(ratio.efficiency) if ratio else "",
            f"{each.true_error / abs(each.exact):.1e}",
            f"{each.claimed_error / abs(each.exact):.1e}",
        )


def _slopes(slopes: Any) -> Iterator[tuple[Any, ...]]:
    groups: dict[tuple[str, str, str], list[Any]] = {}
    for each in slopes:
        groups.setdefault((each.method, each.law, each.due or ""), []).append(each)
    for (method, law, due), group in sorted(groups.items()):
        rates = [each.rate for each in group]
        digits = [each.digits for each in group if each.digits is not None]
        yield (
            method,
            len(group),
            "N^p" if law == "power" else "q^n",
            *(f"{rate:.2f}" for rate in (median(rates), min(rates), max(rates))),
            f"{median(digits):.2f}" if digits else "",
            due,
            f"{sum(each.met for each in group)} of {len(group)}" if due else "",
        )
