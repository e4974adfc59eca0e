"""Show: the table of all rows, and one row with its lesson, for a person to read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from radiokit.faces.console import show_table, write
from radiokit.faces.stability.measure import FAILS, LIMIT, StabilityResult
from radiokit.faces.stability.row import PRECISIONS

__all__ = ["show_row", "show_rows"]


def _number(error: float) -> str:
    if not np.isfinite(error):
        return "not finite"
    return "< 0.01" if error < 0.01 else f"{error:.2g}" if error < 1e4 else f"{error:.0e}".replace("e+", "e")


def show_rows(results: Sequence[StabilityResult]) -> None:
    """Write one line for each row: the worst errors, and the digits that the textbook has left."""
    columns = ["row"]
    for name in PRECISIONS:
        columns += [f"{name}: kernel", "textbook", "at", "digits left"]
    lines = []
    for result in results:
        line: list[object] = [result.row.name]
        for name in PRECISIONS:
            kernel, textbook = result.kernel[name], result.textbook[name]
            inside = "" if kernel.inside == name else f" in {kernel.inside}"
            line += [_number(kernel.worst) + inside, _number(textbook.worst), f"{textbook.at:.1g}"]
            line.append(f"{kernel.digits:.1f} / {textbook.digits:.1f}")
        lines.append((*line, result.outcome))
    show_table("worst error in ulps / condition number", (*columns, "outcome"), lines)
    over = [result.row.name for result in results if result.exit_code]
    fails = sum(bool(result.textbook_fails) for result in results)
    held = len(results) - len(over)
    write(
        f"{held} of {len(results)} kernels stay within {LIMIT:g} ulps × condition number; "
        f"{fails} of the textbook's formulas go beyond {FAILS:g}"
    )
    for name in over:
        write(f"over the limit: {name}")


def show_row(result: StabilityResult) -> None:
    """Write one row: both formulas, their errors along the axis, and the lesson."""
    row = result.row
    write(f"{row.name}: {row.title}")
    write(f"  radiokit: {row.kernel_form}  ({row.kernel_name})")
    write(f"  textbook: {row.textbook_form}")
    write(f"  largest condition number: {result.condition:.1e}")
    for name in PRECISIONS:
        kernel, textbook = result.kernel[name], result.textbook[name]
        inside = "" if kernel.inside == name else f", the kernel in {kernel.inside} inside"
        show_table(
            f"{name}{inside}: error in ulps / condition number",
            (row.axis, "radiokit", "textbook"),
            [
                (f"{value:.3g}", _number(ours), _number(theirs))
                for value, ours, theirs in zip(kernel.values, kernel.errors, textbook.errors, strict=True)
            ],
        )
        write(f"  fewest digits left: radiokit {kernel.digits:.1f}, textbook {textbook.digits:.1f}")
    write(f"lesson: {row.lesson}")
    write(f"source: {row.source.cite()}")
    write(f"{result.outcome}")
