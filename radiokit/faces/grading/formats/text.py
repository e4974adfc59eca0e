"""Plain text: a grade for a terminal, a pipe or a letter."""

from __future__ import annotations

from rich.markup import escape
from rich.table import Table

from radiokit.faces.grading.formats.phrases import phrase
from radiokit.faces.grading.formats.shown import line_of, notes_of, number, plain
from radiokit.faces.grading.grades import Grade

__all__ = ["to_rich", "to_text"]

_SIGNS = {"full": "✓", "partial": "~", "none": "✗", "pending": "…"}
_COLOURS = {"full": "green", "partial": "yellow", "none": "red", "pending": "dim"}


def to_text(grade: Grade, *, reveal: bool = False) -> str:
    """Return a grade as plain text, a line for each part.

    Parameters
    ----------
    grade : Grade
    reveal : bool
        Whether what was found about hidden parts is told.
    """
    grade = plain(grade)
    lines = [f"{grade.title}: {number(grade.score)} / {number(grade.points)}"]
    lines += [f"  {note}" for note in notes_of(grade)]
    for question in grade.questions:
        score = f"{number(question.score)} / {number(question.points)}"
        lines.append(f"  {question.name}: {score}  {question.title}")
        for part in question.parts:
            line = line_of(part, grade.language, reveal=reveal)
            sign = _SIGNS[line.standing]
            lines.append(f"    {sign} {line.title}: {line.score} / {line.points}  {line.text}")
        lines += [f"    {note}" for note in notes_of(grade, question, reveal=reveal)]
    return "\n".join(lines) + "\n"


def to_rich(grade: Grade, *, reveal: bool = False) -> Table:
    """Return a grade as a table of Rich's, with colours."""
    grade = plain(grade)
    table = Table(
        title=escape(f"{grade.title}: {number(grade.score)} / {number(grade.points)}"), title_justify="left"
    )
    table.add_column(phrase(grade.language, "part"), overflow="fold")
    table.add_column(phrase(grade.language, "points"), justify="right", no_wrap=True)
    table.add_column(phrase(grade.language, "finding"), overflow="fold")
    for question in grade.questions:
        score = f"{number(question.score)} / {number(question.points)}"
        notes = "".join(f"\n[yellow]{escape(note)}[/]" for note in notes_of(grade, question, reveal=reveal))
        table.add_row(
            f"[bold]{escape(question.name)}[/]",
            f"[bold]{score}[/]",
            f"[bold]{escape(question.title)}[/]{notes}",
        )
        for place, part in enumerate(question.parts, 1):
            line = line_of(part, grade.language, reveal=reveal)
            colour = _COLOURS[line.standing]
            table.add_row(
                f"  [{colour}]{_SIGNS[line.standing]}[/] {escape(line.title)}",
                f"{line.score} / {line.points}",
                escape(line.text),
                end_section=place == len(question.parts),
            )
    # A note is wrapped, and no line of a log may begin as a command: see ``plain_text``.
    table.caption = escape("\n".join(notes_of(grade)).replace("::", ": :"))
    return table
