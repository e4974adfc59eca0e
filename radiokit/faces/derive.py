"""The command ``radiokit derive``: derivations of formulas, and whether each step is verified."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, show_table, write
from radiokit.faces.workers import SerialExecutor, available_workers, open_executor
from radiokit.facts.errors import RadiokitError
from radiokit.facts.report import EXIT_CODES
from radiokit.facts.verdict import Outcome

if TYPE_CHECKING:  # SymPy loads when the first derivation is asked for
    from radiokit.physics.relations.derivation import Derivation, Finding

__all__ = ["SHARE", "Proofs", "derive", "prove", "verify_all"]

SHARE = 0.85
"""Of all steps that are no premises, at least so many must be proved symbolically."""


@dataclass(frozen=True)
class Proofs:
    """Derivations with their findings, and what it cost."""

    derivations: tuple[Derivation, ...]
    seconds: float
    workers: int

    @property
    def outcome(self) -> Outcome:
        """The worst outcome."""
        found = {each.outcome for each in self.derivations}
        for outcome in (Outcome.VIOLATED, Outcome.INCONCLUSIVE):
            if outcome in found:
                return outcome
        return Outcome.HOLDS

    @property
    def counts(self) -> tuple[int, int]:
        """How many steps were proved symbolically, and how many there are besides the premises."""
        pairs = [each.counts for each in self.derivations]
        return sum(proved for proved, _ in pairs), sum(count for _, count in pairs)

    @property
    def exit_code(self) -> int:
        """0 when every step is verified, 1 when one fails, 3 when one is inconclusive."""
        return EXIT_CODES[self.outcome]

    def to_json(self) -> dict[str, Any]:
        """Return the derivations as JSON-ready data."""
        proved, count = self.counts
        return {
            "outcome": str(self.outcome),
            "proved": proved,
            "to_prove": count,
            "share_proved": proved / count if count else 1.0,
            "share_needed": SHARE,
            "seconds": self.seconds,
            "workers": self.workers,
            "derivations": [each.to_json() for each in self.derivations],
        }


def prove(task: tuple[str, bool]) -> tuple[str, tuple[Finding, ...]]:
    """Return the findings of one derivation, wherever this runs; the task is its name and ``fresh``."""
    from radiokit.physics.relations.catalogue import derive as verified

    name, fresh = task
    return name, verified(name, fresh=fresh).findings


def verify_all(
    names: Sequence[str],
    *,
    fresh: bool = False,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Proofs:
    """Verify derivations; ``fresh`` proves anew what is kept in the cache.

    >>> verify_all(["lambertian-intensity"]).outcome.value
    'holds'
    """
    from radiokit.physics.relations.catalogue import unverified

    start = time.perf_counter()
    found = []
    tasks = [(name, fresh) for name in names]
    for done, (name, findings) in enumerate((executor or SerialExecutor()).map(prove, tasks), start=1):
        found.append(replace(unverified(name), findings=findings))
        if progress is not None:
            progress(done, len(tasks))
    return Proofs(tuple(found), time.perf_counter() - start, workers)


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
