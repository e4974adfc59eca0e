"""HTML: a grade as a page of its own, for the student to read or print."""

from __future__ import annotations

from html import escape

import radiokit
from radiokit.faces.grading.formats.phrases import phrase, protection
from radiokit.faces.grading.formats.shown import line_of, notes_of, number, plain
from radiokit.faces.grading.grades import Grade, QuestionGrade

__all__ = ["to_html"]

_SIGNS = {"full": "✓", "partial": "◐", "none": "✗", "pending": "…"}

_STYLE = """\
:root { color-scheme: light; }
body { margin: 0 auto; padding: 1.5rem 1rem; max-width: 52rem; background: #fff; color: #1b1b1b;
  font: 1rem/1.5 system-ui, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
h1 { margin: 0 0 .25rem; font-size: 1.6rem; line-height: 1.25; }
h2 { margin: 2rem 0 .25rem; font-size: 1.15rem; line-height: 1.3; }
code { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .92em; }
.score { float: right; margin-left: 1rem; font-variant-numeric: tabular-nums; white-space: nowrap; }
.total { margin: .25rem 0 0; font-size: 1.25rem; font-weight: 600; }
.bar { height: .6rem; margin: .5rem 0; border: 1px solid #595959; border-radius: .3rem; overflow: hidden; }
.bar div { height: 100%; background: #1c6b30; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.note { margin: .75rem 0; padding: .5rem .75rem; border-left: .3rem solid #8a5300; background: #fff6e5;
  overflow-wrap: anywhere; }
table { width: 100%; border-collapse: collapse; }
th, td { padding: .4rem .5rem; border-bottom: 1px solid #c4c4c4; text-align: left; vertical-align: top; }
thead th { font-size: .85rem; color: #444; }
thead th:nth-child(2) { text-align: right; }
tbody th { width: 27%; font-weight: 400; }
td { overflow-wrap: anywhere; }
td.points { width: 5.5rem; white-space: nowrap; text-align: right; font-variant-numeric: tabular-nums; }
.sign { display: inline-block; width: 1.2em; font-weight: 700; }
.full .sign { color: #1c6b30; }
.partial .sign { color: #7a4a00; }
.none .sign { color: #a3121f; }
.pending .sign { color: #444; }
.diagnosis { color: #444; font-size: .9rem; }
.unseen { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
section.how { margin-top: 2.5rem; border-top: 1px solid #c4c4c4; color: #444; font-size: .9rem; }
section.how h2 { margin-top: 1rem; font-size: 1rem; color: #1b1b1b; }
@media print {
  body { max-width: none; padding: 0; font-size: 10.5pt; }
  tr, .note { break-inside: avoid; }
  h2, thead { break-after: avoid; }
}
@page { margin: 18mm 16mm; }
"""


def to_html(grade: Grade, *, reveal: bool = False) -> str:
    """Return a grade as one HTML page that needs nothing else, and in which no script can run.

    Parameters
    ----------
    grade : Grade
    reveal : bool
        Whether what was found about hidden parts is told.
    """
    grade = plain(grade)
    language, title = grade.language, escape(grade.title)
    score = f"{number(grade.score)} / {number(grade.points)}"
    share = 100 * grade.score / grade.points if grade.points else 0.0
    student = f"<p>{phrase(language, 'student')}: {escape(grade.student)}</p>\n" if grade.student else ""
    return (
        f'<!DOCTYPE html>\n<html lang="{language}">\n<head>\n<meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; '
        "style-src 'unsafe-inline'\">\n"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="generator" content="radiokit {radiokit.__version__}">\n'
        f"<title>{title}: {score}</title>\n<style>\n{_STYLE}</style>\n</head>\n<body>\n<main>\n<header>\n"
        f"<h1>{title}</h1>\n{student}"
        f'<p class="total">{phrase(language, "total")}: {score}</p>\n'
        f'<div class="bar" aria-hidden="true"><div style="width: {share:.1f}%"></div></div>\n'
        f"</header>\n{_notes(notes_of(grade))}"
        + "".join(_question(grade, question, reveal) for question in grade.questions)
        + _protections(grade)
        + "</main>\n</body>\n</html>\n"
    )


def _question(grade: Grade, question: QuestionGrade, reveal: bool) -> str:
    language = grade.language
    score = f"{number(question.score)} / {number(question.points)}"
    rows = []
    for part in question.parts:
        line = line_of(part, language, reveal=reveal)
        diagnosis = f"{phrase(language, 'diagnosis')}: <code>{escape(line.diagnosis)}</code>"
        rows.append(
            f'<tr class="{line.standing}"><th scope="row">'
            f'<span class="sign" aria-hidden="true">{_SIGNS[line.standing]}</span>'
            f'<span class="unseen">{phrase(language, line.standing)}: </span>{escape(line.title)}</th>'
            f'<td class="points">{line.score} / {line.points}</td><td>{escape(line.text)}'
            + (f' <span class="diagnosis">({diagnosis})</span>' if line.diagnosis else "")
            + "</td></tr>\n"
        )
    head = "".join(f'<th scope="col">{phrase(language, each)}</th>' for each in ("part", "points", "finding"))
    return (
        f'<section>\n<h2><span class="score">{score}</span>{escape(question.title)} '
        f"<code>{escape(question.name)}</code></h2>\n{_notes(notes_of(grade, question, reveal=reveal))}"
        f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{''.join(rows)}</tbody>\n</table>\n</section>\n"
    )


def _notes(notes: list[str]) -> str:
    return "".join(f'<p class="note">{escape(note)}</p>\n' for note in notes)


def _protections(grade: Grade) -> str:
    """Return which protections held while the code ran."""
    language = grade.language
    lists = "".join(
        f"<p>{phrase(language, key)}:</p>\n<ul>\n"
        + "".join(f"<li>{escape(protection(language, name))}</li>\n" for name in names)
        + "</ul>\n"
        for key, names in (("active", grade.protections), ("missing", grade.missing))
        if names
    )
    if not lists:
        return ""
    return f'<section class="how">\n<h2>{phrase(language, "protections")}</h2>\n{lists}</section>\n'
