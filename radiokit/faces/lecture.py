"""The command ``radiokit lecture``: what the lecture prints, slide by slide, and whether it holds."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, show_table, write
from radiokit.facts.report import EXIT_CODES
from radiokit.facts.verdict import Outcome

__all__ = ["lecture"]


def lecture(
    name: Annotated[str | None, typer.Argument(help="One line; without it, a table of all.")] = None,
    slide: Annotated[
        str | None, typer.Option(help="Only this slide: its number, or a part of its title.")
    ] = None,
    verdict: Annotated[str | None, typer.Option(help="Only 'holds', 'holds only if' or 'misprint'.")] = None,
    details: Annotated[
        bool, typer.Option("--details", help="Print each line with its reading and evidence.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Show the lecture's formulas and statements, each with the verdict that its checks come to.

    Exit code 1 when a check says something else than the line's reading; a misprint that is found is none.
    """
    from radiokit.worlds.lecture.ledger import Ledger, lecture_claims

    found = lecture_claims(slide=slide)
    if name is not None:
        found = Ledger((found[name],))
    with progress_bar("judging", not json) as progress:
        for done, claim in enumerate(found, start=1):
            assert claim.verdict  # judged here, once, for all that follows
            if progress is not None:
                progress(done, len(found))
    if verdict is not None:
        found = found.only(verdict)
    _show(found, json, details or name is not None)
    outcome = found.report().outcome if len(found) else Outcome.HOLDS
    if EXIT_CODES[outcome]:
        raise typer.Exit(EXIT_CODES[outcome])


def _show(found: Any, json: bool, details: bool) -> None:
    if json:
        show_json(found.to_json())
    elif details:
        write("\n\n".join(map(str, found)))
    else:
        show_table("the lecture", ("slide", "line", "printed", "verdict", "decided by"), found.rows())
        write(", ".join(f"{word}: {count}" for word, count in found.counts().items()))
