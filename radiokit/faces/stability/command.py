"""Command: ``radiokit stability``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, write
from radiokit.facts.errors import ParameterError
from radiokit.facts.report import EXIT_CODES
from radiokit.facts.verdict import Outcome

__all__ = ["stability"]


def stability(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            help="One row, with its lesson; without it, all. Models, with --models or --albedos; "
            "closed forms, with --lights."
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    figures: Annotated[Path | None, typer.Option(help="Folder to draw the diagram into.")] = None,
    models: Annotated[
        bool, typer.Option("--models", help="Every model's values against its twin, at hard directions.")
    ] = False,
    albedos: Annotated[
        bool, typer.Option("--albedos", help="Every model's albedos against its twin's integral.")
    ] = False,
    lights: Annotated[
        bool, typer.Option("--lights", help="Every closed form of the lights, at hard configurations.")
    ] = False,
    dense: Annotated[
        bool, typer.Option("--dense", help="More pairs, and more expensive integrals; takes much longer.")
    ] = False,
    workers: Annotated[
        int | None, typer.Option(help="Local processes for models and lights; all processors by default.")
    ] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a Dask scheduler to use.")] = None,
) -> None:
    """Measure every kernel, and the textbook's formula beside it, where that loses its digits."""
    if lights:
        if models or albedos or dense or figures is not None:
            raise ParameterError("lights", True, "alone, or with names, --json, --workers or --scheduler")
        code = _lights(names or None, json, workers, scheduler)
    elif models or albedos:
        if figures is not None:
            raise ParameterError("figures", str(figures), "left out for models: there is no diagram of them")
        code = _models(names or None, models, albedos, dense, json, workers, scheduler)
    else:
        if len(names or ()) > 1:
            raise ParameterError("names", names, "one row, or several with --models, --albedos or --lights")
        code = _rows(names[0] if names else None, json, figures)
    if code:
        raise typer.Exit(code)


def _models(
    names: list[str] | None,
    values: bool,
    albedos: bool,
    dense: bool,
    json: bool,
    workers: int | None,
    scheduler: str | None,
) -> int:
    from radiokit.faces.stability.albedos import model_albedos
    from radiokit.faces.stability.models import chosen_models, model_stability
    from radiokit.faces.stability.show_models import show_albedos, show_models
    from radiokit.faces.workers import available_workers, open_executor

    chosen = chosen_models(names)
    count = available_workers() if workers is None and scheduler is None else workers
    outcomes: list[Any] = []
    data: dict[str, Any] = {}
    with open_executor(count, scheduler) as executor:
        options: dict[str, Any] = {"names": chosen, "dense": dense, "executor": executor}
        if values:
            with progress_bar("models", not json) as progress:
                found = model_stability(**options, progress=progress)
            outcomes += [result.outcome for result in found]
            data["models"] = [result.to_json() for result in found]
            if not json:
                show_models(found)
        if albedos:
            with progress_bar("albedos", not json) as progress:
                rows = model_albedos(**options, progress=progress)
            outcomes += [row.outcome for row in rows if row.outcome is not None]
            data["albedos"] = [row.to_json() for row in rows]
            if not json:
                show_albedos(rows)
    if json:
        show_json(data)
    return _exit_code(outcomes)


def _lights(names: list[str] | None, json: bool, workers: int | None, scheduler: str | None) -> int:
    from radiokit.faces.stability.lights import light_stability
    from radiokit.faces.stability.show_lights import show_lights
    from radiokit.faces.workers import available_workers, open_executor

    count = available_workers() if workers is None and scheduler is None else workers
    with open_executor(count, scheduler) as executor, progress_bar("closed forms", not json) as progress:
        found = light_stability(names, executor=executor, progress=progress)
    if json:
        show_json({"lights": [result.to_json() for result in found]})
    else:
        show_lights(found)
    return _exit_code([result.outcome for result in found])


def _exit_code(outcomes: list[Any]) -> int:
    order = (Outcome.VIOLATED, Outcome.INCONCLUSIVE, Outcome.HOLDS)
    return EXIT_CODES[next(outcome for outcome in order if outcome in (*outcomes, Outcome.HOLDS))]


def _rows(name: str | None, json: bool, figures: Path | None) -> int:
    from radiokit.faces.stability.measure import stability as run

    found = run(name)
    drawn = None
    if figures is not None:
        from radiokit.faces.plots.stability import draw_row, draw_stability

        one, path = found[0], figures / ("stability.png" if name is None else f"stability-{name}.png")
        drawn = draw_stability(found, path) if name is None else draw_row(one, path)
    if json:
        rows = [result.to_json() for result in found]
        show_json({"rows": rows, "figures": [] if drawn is None else [str(drawn)]})
    else:
        from radiokit.faces.stability.show import show_row, show_rows

        show_rows(found) if name is None else show_row(found[0])
        if drawn is not None:
            write(f"stability diagram: {drawn}")
    return max(result.exit_code for result in found)
