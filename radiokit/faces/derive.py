"""The command ``radiokit derive``: derivations of formulas, and whether each step is verified."""

from __future__ import annotations

from typing import Annotated

import typer

from radiokit.faces.console import progress_bar, show_json, show_table, write
from radiokit.faces.proofs import Proofs, verify_all
from radiokit.faces.workers import available_workers, open_executor
from radiokit.facts.errors import RadiokitError

__all__ = ["derive"]


def derive(
    name: Annotated[str | None, typer.Argument(help="A derivation; without it, all are listed.")] = None,
    every: Annotated[bool, typer.Option("--all", help="Verify all of them.")] = False,
    latex: Annotated[bool, typer.Option("--latex", help="Print LaTeX.")] = False,
    fresh: Annotated[bool, typer.Option("--fresh", help="Prove anew what the cache remembers.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    workers: Annotated[int | None, typer.Option(help="Local processes; all processors by default.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a Dask scheduler to use.")] = None,
) -> None:
    """Derive a formula step by step, each step verified; or list the formulas; or verify them all."""
    from radiokit.physics.relations.catalogue import list_derivations, unverified

    if name is not None and every:
        raise RadiokitError("NAME and --all exclude each other")
    if json and latex:
        raise RadiokitError("--latex and --json exclude each other")
    if name is None and not every:
        _list(json, latex)
        return
    if name is not None:
        unverified(name)
        proofs = verify_all([name], fresh=fresh)
    else:
        count = workers
        if count is None and scheduler is None:
            count = available_workers()
        with open_executor(count, scheduler) as executor, progress_bar("deriving", not json) as progress:
            proofs = verify_all(
                list_derivations(), fresh=fresh, executor=executor, workers=count or 0, progress=progress
            )
    if json:
        show_json(proofs.to_json() if every else proofs.derivations[0].to_json())
    elif latex:
        for each in proofs.derivations:
            write(f"% {each.name}: {each.title}\n\\[\n{each.latex()}\n\\]")
    elif name is not None:
        write(str(proofs.derivations[0]))
    else:
        _show(proofs)
    if proofs.exit_code:
        raise typer.Exit(proofs.exit_code)


def _list(json: bool, latex: bool) -> None:
    from radiokit.physics.relations.catalogue import list_derivations, unverified

    known = [unverified(each) for each in list_derivations()]
    if json:
        rows = [
            {"name": each.name, "title": each.title, "statement": each.statement, "tags": list(each.tags)}
            for each in known
        ]
        show_json({"derivations": rows})
    elif latex:
        for each in known:
            write(f"% {each.name}: {each.title}\n\\[ {each.notation.latex(each.result)} \\]")
    else:
        show_table("derivations", ("name", "title"), [(each.name, each.title) for each in known])


def _show(proofs: Proofs) -> None:
    rows = []
    for each in proofs.derivations:
        proved, count = each.counts
        seconds = sum(finding.seconds for finding in each.findings)
        rows.append((each.name, len(each.premises), f"{proved} of {count}", f"{seconds:.2f}", each.outcome))
    show_table("derivations", ("name", "premises", "steps proved", "seconds", "outcome"), rows)
    for each in proofs.derivations:
        if not each.ok:
            write(f"not as it should be: {each.name}: {each.verdict.message}")
    proved, count = proofs.counts
    write(
        f"{proofs.outcome}: {len(proofs.derivations)} derivations, {proved} of {count} steps "
        f"({proved / count:.1%}) proved symbolically, {proofs.seconds:.1f} s with {proofs.workers} workers"
    )
