"""Command: ``radiokit grade``, a submission's grade, for people and for the systems that collect grades."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from radiokit.faces.console import progress_bar, show_json, write
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import ParameterError, TargetError

__all__ = ["exit_code", "grade", "read_secret"]

SECRET = "RADIOKIT_SECRET"
"""The environment variable that a secret is taken from where no file is named."""
NOT_FULL, UNFINISHED = 1, 3


def grade(
    submission: Annotated[
        Path, typer.Argument(help="A script (.py) or a notebook (.ipynb).", metavar="SUBMISSION")
    ],
    assignment: Annotated[
        str, typer.Option(help="radiometry, brdfs, shading, or FILE.py that sets ASSIGNMENT.")
    ],
    student: Annotated[str, typer.Option(help="Who, in any words; each student has inputs of his own.")] = "",
    secret_file: Annotated[
        Path | None,
        typer.Option(help=f"File with the text that makes inputs unforeseeable; else ${SECRET} counts."),
    ] = None,
    language: Annotated[str, typer.Option(help="Of the feedback: en or ru.")] = "en",
    out: Annotated[
        list[str] | None,
        typer.Option(
            metavar="[FORMAT=]FILE",
            help="File to write after each question; may be repeated. Formats: text, json, html, markdown, "
            "csv, junit, gradescope, github; by default the one that the file's name ends in. An incomplete "
            "json of the same submission is continued.",
        ),
    ] = None,
    reveal: Annotated[
        bool,
        typer.Option(
            "--reveal", help="Tell what was found about hidden parts, and why a person should look."
        ),
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON, which tells all.")] = False,
) -> None:
    """Grade a submission; its code runs in a sandbox.

    For example: radiokit grade anna.ipynb --assignment radiometry --student anna --out anna.html

    Exit codes: 0 full marks, 1 not full marks, 2 bad usage or input, 3 incomplete or a person should look.
    """
    from radiokit.faces.grading.assignment import assignment_from_source, assignment_source
    from radiokit.faces.grading.formats.text import to_rich, to_text
    from radiokit.faces.grading.formats.writing import FORMATS, json_text, output, write_file
    from radiokit.faces.grading.grader import grade as graded
    from radiokit.faces.grading.record import continued, mark_of, record
    from radiokit.faces.grading.rehearsal import rehearse
    from radiokit.faces.grading.unfinished import nothing_yet, with_pending
    from radiokit.faces.grading.words import checked_language

    files = [output(target) for target in out or ()]
    if not student.isprintable():
        raise ParameterError("student", student, "of printable letters")
    source, name = assignment_source(assignment)
    work = assignment_from_source(source, name)
    checked_language(language, work.languages)
    if Path(assignment).suffix == ".py":
        rehearse(work)
    if submission.suffix not in (".py", ".ipynb"):
        raise ParameterError("submission", str(submission), "a script (.py) or a notebook (.ipynb)")
    if not submission.is_file():
        raise TargetError(f"no such file: {submission}")
    secret = read_secret(secret_file)
    mark = mark_of(source, submission, student=student, secret=secret, language=language)
    candidates = (continued(each.path, mark) for each in files if each.format == "json")
    earlier = next((each for each in candidates if each is not None), None)

    def keep(so_far: Grade) -> None:
        for each in files:
            if each.format == "json":
                write_file(each.path, json_text(record(so_far, mark)))
            else:
                write_file(each.path, FORMATS[each.format](with_pending(so_far, work), reveal))

    keep(earlier or nothing_yet(work, student=student, language=language))
    with progress_bar("grading", not json) as progress:
        result = graded(
            work,
            submission,
            student=student,
            secret=secret,
            language=language,
            earlier=earlier,
            keep=keep,
            progress=progress,
        )
    console = Console()
    if json:
        show_json(record(result, mark))
    elif console.is_terminal:
        console.print(to_rich(result, reveal=reveal))
    else:
        write(to_text(result, reveal=reveal).rstrip("\n"))
    code = exit_code(result)
    if code:
        raise typer.Exit(code)


def exit_code(result: Grade) -> int:
    """Return 0 for full marks, 1 for less, 3 where questions are left or a person should look."""
    if not result.complete or any(question.review for question in result.questions):
        return UNFINISHED
    full = all(part.full for question in result.questions for part in question.parts)
    return 0 if full else NOT_FULL


def read_secret(file: Path | None) -> str:
    """Return the secret of a file, or of the environment; empty where there is none.

    Raises
    ------
    TargetError
        When the file cannot be read.
    ParameterError
        When it is empty.
    """
    if file is None:
        return os.environ.get(SECRET, "").strip()
    try:
        secret = file.read_text("utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no text in UTF-8"
        raise TargetError(f"cannot read the secret in {file}: {reason}") from error
    if not secret:
        raise ParameterError("secret-file", str(file), "a file with a secret in it")
    return secret
