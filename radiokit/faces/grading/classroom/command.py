"""Command: ``radiokit grade-class``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, show_table, write

__all__ = ["grade_class"]

SHOWN = 3
"""How many misconceptions are shown of a question; class.json has all."""


def grade_class(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of submissions; Moodle's and Canvas's exports, too.")
    ],
    assignment: Annotated[str, typer.Option(help="radiometry, brdfs, shading, or FILE.py of your own.")],
    out: Annotated[Path, typer.Option(help="Folder of the results: class.csv, class.json and results/.")],
    workers: Annotated[
        int | None, typer.Option(help="Local processes; as many as there are processors by default.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            help="Address of a Dask scheduler, whose workers are sent the submissions and the secret."
        ),
    ] = None,
    secret_file: Annotated[
        Path | None,
        typer.Option(help="File with the text that makes inputs unforeseeable; else $RADIOKIT_SECRET."),
    ] = None,
    roster: Annotated[
        Path | None,
        typer.Option(help="CSV file with the columns entry and student; else the entry's name counts."),
    ] = None,
    language: Annotated[str, typer.Option(help="Of the feedback: en or ru.")] = "en",
    again: Annotated[
        bool, typer.Option("--again", help="Grade all again, also what has not changed.")
    ] = False,
    html: Annotated[bool, typer.Option("--html", help="Also write a page for each student, html/.")] = False,
    csv: Annotated[Path | None, typer.Option(help="Also write class.csv here.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")] = False,
) -> None:
    """Grade a folder of submissions; a run that was stopped goes on where it was.

    For example: radiokit grade-class submissions --assignment radiometry --out grades --html

    Exit codes: 0 all graded, 2 bad usage or input, 3 some need a person.
    """
    from radiokit.faces.grading.classroom.reports import write_nameless
    from radiokit.faces.grading.classroom.run import grade_class as run
    from radiokit.faces.grading.command import read_secret

    secret = read_secret(secret_file)
    with progress_bar("grading", not json) as progress:
        found = run(
            folder,
            assignment,
            out,
            workers=workers,
            scheduler=scheduler,
            secret=secret,
            language=language,
            roster=roster,
            html=html,
            again=again,
            progress=progress,
        )
    if csv is not None:
        write_nameless(csv, (out / "class.csv").read_text("utf-8"), str(csv))
    if json:
        show_json(found.summary)
    else:
        _show(found)
    if found.exit_code:
        raise typer.Exit(found.exit_code)


def _show(found: Any) -> None:
    """Write the summary for a person: counts alone."""
    summary = found.summary
    rows = [
        (
            question["name"],
            f"{question['points']:g}",
            "" if question["mean_share"] is None else f"{100 * question['mean_share']:.0f} %",
            *(question[name] for name in ("full", "partial", "none")),
            ", ".join(f"{each['name']} {each['count']}" for each in question["misconceptions"][:SHOWN]),
        )
        for question in summary["questions"]
    ]
    columns = ("question", "points", "mean", "full", "partial", "none", "misconceptions")
    show_table(summary["title"], columns, rows)
    score = summary["score"]
    if score["mean"] is not None:
        low, middle, high = score["quartiles"]
        write(f"score: mean {score['mean']:g}, quartiles {low:g} {middle:g} {high:g}, of {score['points']:g}")
    missing = summary["entries"] - summary["handed_in"]
    write(
        f"{summary['entries']} entries: {summary['handed_in']} handed in, {missing} not, "
        f"{summary['need_review']} for a person to look at"
        + (f": {found.folder / 'class.csv'} says why" if summary["need_review"] else "")
    )
    if found.graded:
        by = f"{found.workers} workers" if found.workers > 1 else "1 worker" if found.workers else "a cluster"
        write(
            f"{found.graded} graded in {found.seconds:.1f} s by {by}: "
            f"{60 * found.graded / found.seconds:.0f} a minute"
        )
    else:
        write("nothing had changed")
    if found.unlisted:
        write(f"entries that the roster does not name, whose own names count: {found.unlisted}")
    if found.strangers:
        write(f"{found.strangers} results in {found.folder / 'results'} are of no entry")
