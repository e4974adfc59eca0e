"""The command ``radiokit models``: the table of models, on a terminal, in Markdown or as JSON."""

from __future__ import annotations

from typing import Annotated

import typer

from radiokit.faces.console import show_json, show_table, write
from radiokit.facts.errors import RadiokitError

__all__ = ["models"]


def models(
    names: Annotated[list[str] | None, typer.Argument(help="Only these models.", metavar="[NAME]...")] = None,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print Markdown.")] = False,
    no_timing: Annotated[
        bool, typer.Option("--no-timing", help="Measure no time: the same table every time.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the models: source, kind, the laws they keep, how they sample, and what a value costs."""
    from radiokit.faces.modeltable import models_table

    if markdown and json:
        raise RadiokitError("--markdown and --json exclude each other")
    table = models_table(names or None, timing=not no_timing)
    if json:
        show_json({"models": table.to_json()})
    elif markdown:
        write(table.markdown())
    else:
        show_table("models", table.columns, table.cells())
