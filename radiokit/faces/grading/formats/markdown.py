"""Markdown: a grade for a pull request, a job's summary or a message."""

from __future__ import annotations

import re

from radiokit.faces.grading.formats.phrases import phrase
from radiokit.faces.grading.formats.shown import line_of, notes_of, number, plain
from radiokit.faces.grading.grades import Grade

__all__ = ["to_markdown"]

_SIGNS = {"full": "✅", "partial": "🟡", "none": "❌", "pending": "⏳"}
_MENTION = re.compile(r"(?<!\w)@(?=\w)|#(?=\d)")
_JOINER = "\u2060"
_SPECIAL = re.compile(r"([\\`*_\[\]#|~$<>&]|(?<=:)/|(?<=www)\.)")


def to_markdown(grade: Grade, *, reveal: bool = False) -> str:
    """Return a grade as Markdown, a table for each question; no text in it becomes markup or a link.

    Nor does one notify anybody, as ``@name`` and ``#1`` do on GitHub: an unseen joiner follows the sign.

    Parameters
    ----------
    grade : Grade
    reveal : bool
        Whether what was found about hidden parts is told.
    """
    grade = plain(grade)
    language = grade.language
    lines = [f"# {_escape(grade.title)}: {number(grade.score)} / {number(grade.points)}", ""]
    if grade.student:
        lines += [f"{phrase(language, 'student')}: {_escape(grade.student)}", ""]
    lines += [f"> {_escape(note)}" for note in notes_of(grade)]
    for question in grade.questions:
        score = f"{number(question.score)} / {number(question.points)}"
        lines += ["", f"## {_escape(question.title)} ({_escape(question.name)}): {score}", ""]
        head = [phrase(language, each) for each in ("part", "points", "finding")]
        lines += [f"|  | {' | '.join(head)} |", "|---|---|---|---|"]
        for part in question.parts:
            line = line_of(part, language, reveal=reveal)
            found = f"{line.text} ({phrase(language, 'diagnosis')}: {line.diagnosis})"
            cells = [
                _SIGNS[line.standing],
                _escape(line.title),
                f"{line.score} / {line.points}",
                _escape(found if line.diagnosis else line.text),
            ]
            lines.append(f"| {' | '.join(cells)} |")
        lines += ["", *(f"> {_escape(note)}" for note in notes_of(grade, question, reveal=reveal))]
    return "\n".join(lines).rstrip() + "\n"


def _escape(text: str) -> str:
    """Return one line in which no letter means anything but itself."""
    return _SPECIAL.sub(r"\\\1", _MENTION.sub(rf"\g<0>{_JOINER}", " ".join(text.split())))
