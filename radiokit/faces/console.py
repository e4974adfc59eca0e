"""Console: how the commands print, for a person on a terminal, for a pipe, and for a program."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from radiokit.facts.report import Report
from radiokit.facts.verdict import Outcome

__all__ = ["fail", "progress_bar", "show_json", "show_report", "show_table", "write"]

COLOURS = {Outcome.HOLDS: "green", Outcome.VIOLATED: "red", Outcome.INCONCLUSIVE: "yellow"}


def write(text: str) -> None:
    """Write a line to standard output."""
    sys.stdout.write(text + "\n")


def show_json(data: Any) -> None:
    """Write JSON, without NaN or infinity."""
    write(json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False))


def show_report(report: Report) -> None:
    """Write a report: a coloured table on a terminal, plain text into a pipe."""
    console = Console()
    if console.is_terminal:
        console.print(report)
    else:
        write(str(report))


def show_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Write a table: Rich's on a terminal, aligned columns into a pipe. Outcomes get their colours."""
    console = Console()
    texts = [[str(cell) for cell in row] for row in rows]
    if not console.is_terminal:
        widths = [max(len(line[i]) for line in [list(columns), *texts]) for i in range(len(columns))]
        write(title)
        for line in [list(columns), *texts]:
            write(
                "  " + "  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)).rstrip()
            )
        return
    table = Table(title=escape(title), title_justify="left")
    for column in columns:
        table.add_column(column, overflow="fold")
    for row, line in zip(rows, texts, strict=True):
        cells = [
            f"[{COLOURS[cell]}]{escape(text)}[/]" if isinstance(cell, Outcome) else escape(text)
            for cell, text in zip(row, line, strict=True)
        ]
        table.add_row(*cells)
    console.print(table)


@contextmanager
def progress_bar(title: str, wanted: bool = True) -> Iterator[Callable[[int, int], None] | None]:
    """Show a progress bar on a terminal's standard error, and nothing anywhere else."""
    # Bound to the stream of now: while a stranger's function runs, sys.stderr is caught.
    console = Console(file=sys.stderr)
    if not (wanted and console.is_terminal):
        yield None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    bars = Progress(*columns, console=console, transient=True, redirect_stdout=False, redirect_stderr=False)
    with bars as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def fail(message: str) -> None:
    """Write one line to standard error."""
    sys.stderr.write(f"radiokit: {' '.join(message.split())}\n")
