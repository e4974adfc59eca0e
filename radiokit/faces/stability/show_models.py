"""Show models: the tables of ``--models`` and ``--albedos``, for a person to read."""

from __future__ import annotations

from collections.abc import Sequence

from radiokit.faces.console import show_table, write
from radiokit.faces.stability.albedos import RTOL, AlbedoRow
from radiokit.faces.stability.measure import LIMIT
from radiokit.faces.stability.models import ModelStability, shown_parameters
from radiokit.facts.verdict import Outcome

__all__ = ["show_albedos", "show_models"]


def _direction(w: tuple[float, ...]) -> str:
    return f"({', '.join(f'{x:.3g}' for x in w)})"


def show_models(results: Sequence[ModelStability]) -> None:
    """Write one line for each model, where its error is largest, and then each set beyond the limit."""
    lines = []
    for result in results:
        worst = result.worst
        lines.append(
            (
                result.name,
                f"{worst.worst:.3g}",
                shown_parameters(worst.parameters),
                _direction(worst.wi),
                _direction(worst.wo),
                len(result.sets),
                result.refused,
                sum(found.pairs for found in result.sets),
                sum(found.nonfinite for found in result.sets),
                sum(len(found.undecided) for found in result.sets),
                f"{result.seconds:.1f}",
                result.outcome,
            )
        )
    columns = (
        "model",
        "worst",
        "parameters",
        "wi",
        "wo",
        "sets",
        "refused",
        "pairs",
        "not finite",
        "no truth",
    )
    show_table("worst error in ulps / condition number", (*columns, "s", "outcome"), lines)
    for result in results:
        for found in result.sets:
            if not found.ok:
                where = f"wi = {list(found.wi)}, wo = {list(found.wo)}: {found.value!r} for {found.exact!r}"
                write(
                    f"{result.name}({shown_parameters(found.parameters)}): {found.worst:.3g} at {where}, "
                    f"{found.nonfinite} not finite, {len(found.undecided)} without a truth"
                )
                if found.undecided:
                    write(f"  no truth: {found.undecided[0]}")
    held = sum(result.outcome is Outcome.HOLDS for result in results)
    pairs = sum(found.pairs for result in results for found in result.sets)
    write(f"{held} of {len(results)} models stay within {LIMIT:g} ulps × condition number, at {pairs} pairs")


def show_albedos(rows: Sequence[AlbedoRow]) -> None:
    """Write one line for each albedo, and why some have no truth to be compared with."""
    lines = []
    for row in rows:
        known = row.outcome is not None
        lines.append(
            (
                row.model,
                shown_parameters(row.parameters),
                f"{row.theta_deg:g}",
                f"{row.value:.15g}",
                row.truth or "no truth",
                f"{row.relative:.1e}" if known else "",
                f"{row.bound:.1e}",
                row.method or row.reason,
                row.nodes or "",
                f"{row.seconds:.1f}",
                row.outcome or "no truth",
            )
        )
    columns = ("model", "parameters", "θ°", "albedo", "truth", "relative", "bound", "how", "nodes", "s")
    show_table("directional albedos against their twins' integrals", (*columns, "outcome"), lines)
    held = sum(row.outcome is Outcome.HOLDS for row in rows)
    wide = sum(row.outcome is Outcome.INCONCLUSIVE for row in rows)
    bad = sum(row.outcome is Outcome.VIOLATED for row in rows)
    write(
        f"{held} of {len(rows)} albedos are right to {RTOL:g} and within their bounds; {bad} are not; "
        f"{wide} are within bounds that, as they say, are wider; {len(rows) - held - wide - bad} lack a truth"
    )
