"""Command: ``radiokit validate``, the main job, and how what it found is shown."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, show_table, write

__all__ = ["case_cells", "validate"]


def validate(
    names: Annotated[list[str] | None, typer.Argument(help="Models, cases, derivations; or all.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    workers: Annotated[int | None, typer.Option(help="Local processes; all processors by default.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a Dask scheduler to use.")] = None,
    seed: Annotated[int, typer.Option(help="Seed of the Monte Carlo methods.")] = 0,
    figures: Annotated[Path, typer.Option(help="Folder of the work-precision diagram.")] = Path("figures"),
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Draw nothing.")] = False,
) -> None:
    """Check every model, every case by every method that applies, every derivation, and the lecture."""
    from radiokit.faces.validate import validate as run
    from radiokit.faces.workers import available_workers, open_executor

    count = available_workers() if workers is None else workers
    with open_executor(count, scheduler) as executor, progress_bar("validating", not json) as progress:
        found = run(names=names or None, executor=executor, workers=count, seed=seed, progress=progress)
    drawn = None
    if not no_figures:
        from radiokit.faces.plots.work_precision import draw_work_precision

        drawn = draw_work_precision(figures / "work-precision.png", seed=seed)
    if json:
        show_json(found.to_json() | {"figures": [] if drawn is None else [str(drawn)]})
    else:
        _show_validation(found)
        if drawn is not None:
            write(f"work-precision diagram: {drawn}")
    if found.exit_code:
        raise typer.Exit(found.exit_code)


def _show_validation(found: Any) -> None:
    from radiokit.contracts.bsdf import bsdf
    from radiokit.faces.validate import MUST_HOLD

    rows = []
    for report in found.models:
        usual = bsdf(report.subject).parameters()
        values = ", ".join(
            f"{name}={value:g}" if isinstance(value, float) else f"{name}={value}"
            for name, value in report.parameters.items()
            if value is not None and value != usual.get(name)
        )
        for verdict in report:
            rows.append((report.subject, values, verdict.check, verdict.outcome, verdict.message))
    show_table("models", ("model", "parameters", "check", "outcome", "finding"), rows)
    show_table(
        "closed-form cases",
        ("case", "method", "value", "exact", "true error", "claimed", "evaluations", "ms", "outcome"),
        [case_cells(row) for row in found.cases],
    )
    show_table(
        "derivations",
        ("derivation", "finding", "outcome"),
        [(each.name, each.verdict.message, each.outcome) for each in found.derivations],
    )
    show_table(
        "the lecture",
        ("line", "finding", "as it is read"),
        [(verdict.check, verdict.message, verdict.outcome) for verdict in found.lecture],
    )
    worst = [
        f"{r.subject} {v.check}: {v.message}"
        for r in found.models
        for v in r
        if v.check in MUST_HOLD and not v.ok
    ]
    worst += [f"{r.case} by {r.method}: {r.verdict.message}" for r in found.cases if not r.verdict.ok]
    worst += [f"{each.name}: {each.verdict.message}" for each in found.derivations if not each.ok]
    worst += [f"the lecture's {v.check}: {v.message}" for v in found.lecture if not v.ok]
    for line in worst:
        write(f"not as it should be: {line}")
    write(
        f"{found.outcome}: {len(found.models)} models, {len(found.cases)} answers to closed-form cases, "
        f"{len(found.derivations)} derivations, {len(found.lecture)} lines of the lecture, "
        f"{found.seconds:.1f} s with {found.workers} workers"
    )


def case_cells(row: Any) -> tuple[Any, ...]:
    """Return the cells of one answer to a case."""
    estimate = row.verdict.estimate
    if estimate is None:
        return (row.case, row.method, "", f"{row.exact:.10g}", "", "", "", "", row.verdict.outcome)
    kind = "≤" if estimate.is_bound else "σ"
    return (
        row.case,
        row.method,
        f"{float(estimate.value):.10g}",
        f"{row.exact:.10g}",
        f"{row.true_error:.1e}",
        f"{kind} {float(estimate.error):.1e}",
        estimate.evaluations,
        f"{1e3 * estimate.seconds:.1f}",
        row.verdict.outcome,
    )
