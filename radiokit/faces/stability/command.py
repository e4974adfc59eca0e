"""Command: ``radiokit stability``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from radiokit.faces.console import show_json, write

__all__ = ["stability"]


def stability(
    name: Annotated[str | None, typer.Argument(help="One row, with its lesson; without it, all.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    figures: Annotated[Path | None, typer.Option(help="Folder to draw the diagram into.")] = None,
) -> None:
    """Measure every kernel, and the textbook's formula beside it, where that loses its digits."""
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
    code = max(result.exit_code for result in found)
    if code:
        raise typer.Exit(code)
