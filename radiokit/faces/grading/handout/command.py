"""Command: ``radiokit assignment``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import progress_bar, show_json, show_table, write
from radiokit.facts.errors import ParameterError, TargetError

__all__ = ["assignment"]


def assignment(
    name: Annotated[
        str | None,
        typer.Argument(
            help="radiometry, brdfs, shading, or FILE.py of your own; without it, all are listed."
        ),
    ] = None,
    to: Annotated[
        Path | None, typer.Option(help="Folder for the students' copies: notebooks and scripts with blanks.")
    ] = None,
    language: Annotated[list[str] | None, typer.Option(help="en (default) or ru; may be repeated.")] = None,
    form: Annotated[
        bool | None, typer.Option("--notebook/--script", help="Only notebooks, or only scripts.")
    ] = None,
    solution: Annotated[
        Path | None, typer.Option(help="Script of solutions, for the instructor's copies and --check.")
    ] = None,
    otter: Annotated[Path | None, typer.Option(help="Folder for otter-grader's master notebook.")] = None,
    nbgrader: Annotated[Path | None, typer.Option(help="Folder of an nbgrader course.")] = None,
    gradescope: Annotated[Path | None, typer.Option(help="Zip file of an autograder for Gradescope.")] = None,
    github: Annotated[
        Path | None,
        typer.Option(
            help="Workflow file (.yml) for repositories of GitHub Classroom; FILE.py must lie in them, for "
            "students to read."
        ),
    ] = None,
    secret_file: Annotated[
        Path | None,
        typer.Option(help="File with the secret that the autograder takes along; else it makes one."),
    ] = None,
    check: Annotated[
        bool,
        typer.Option("--check", help="Try it before the class does; with --solution, that earns full marks."),
    ] = False,
    students: Annotated[int, typer.Option(min=1, help="With --check: for how many students' inputs.")] = 12,
    force: Annotated[bool, typer.Option("--force", help="Write over files that differ.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the assignments, show one, check one, or write what students and instructors hold.

    For example: radiokit assignment light.py --check --solution solution.py

    Exit codes: 0 done, 1 mistakes found by --check, 2 bad usage or input.
    """
    from radiokit.faces.grading.assignment import list_assignments, load_assignment
    from radiokit.faces.grading.rehearsal import rehearsed

    if name is None:
        if check or any((to, otter, nbgrader, gradescope, github, solution)):
            raise ParameterError("name", None, f"one of {', '.join(list_assignments())}, or FILE.py")
        _list([load_assignment(each) for each in list_assignments()], json)
    elif check:
        if any((to, otter, nbgrader, gradescope, github)):
            raise ParameterError("check", True, "alone: what it finds comes before what is handed out")
        _check(name, solution, students, secret_file, json)
    elif not any((to, otter, nbgrader, gradescope, github)):
        for option, value in (("solution", solution), ("secret-file", secret_file)):
            if value is not None:
                raise ParameterError(option, str(value), "beside --check, --to or what takes it along")
        _show(rehearsed(name), (language or ["en"])[0], json)
    else:
        written: list[Path] = []
        if to or otter or nbgrader:
            from radiokit.faces.grading.handout.write import write_handout

            written += write_handout(
                name,
                to=to,
                languages=language or ["en"],
                forms=(".ipynb", ".py") if form is None else (".ipynb",) if form else (".py",),
                solution=solution,
                otter=otter,
                nbgrader=nbgrader,
                force=force,
            )
        written += _systems(name, gradescope, github, secret_file, (language or ["en"])[0], force)
        if json:
            show_json({"assignment": name, "written": [str(path) for path in written]})
        else:
            write("\n".join(map(str, written)))


def _systems(
    name: str,
    gradescope: Path | None,
    github: Path | None,
    secret_file: Path | None,
    language: str,
    force: bool,
) -> list[Path]:
    """Write what Gradescope and GitHub Classroom take, for the systems that are asked for."""
    from radiokit.faces.grading.command import read_secret
    from radiokit.faces.grading.formats.github import github_workflow
    from radiokit.faces.grading.formats.gradescope_zip import gradescope_zip
    from radiokit.faces.grading.handout.write import write_out
    from radiokit.faces.grading.rehearsal import rehearsed
    from radiokit.faces.grading.words import checked_language

    for path in (gradescope, github):
        if path is not None and path.exists() and not force:
            raise TargetError(f"{path} is there; --force writes over it")
    checked_language(language, rehearsed(name).languages)
    written = []
    if gradescope is not None:
        written.append(gradescope_zip(name, gradescope, secret=read_secret(secret_file), language=language))
    if github is not None:
        text = github_workflow(name, f"{rehearsed(name).name}.{language}.ipynb", language=language)
        write_out(github, text)
        written.append(github)
    return written


def _check(name: str, solution: Path | None, students: int, secret_file: Path | None, json: bool) -> None:
    """Show what is wrong with an assignment; exit code 1 if anything is."""
    from radiokit.faces.grading.checkup import check_assignment
    from radiokit.faces.grading.command import read_secret
    from radiokit.faces.workers import available_workers

    with progress_bar("checking", not json) as progress:
        found = check_assignment(
            name,
            solution=solution,
            students=students,
            secret=read_secret(secret_file),
            workers=available_workers(),
            progress=progress,
        )
    if json:
        show_json(found.to_json())
    else:
        write(str(found))
    if not found.ok:
        raise typer.Exit(1)


def _list(found: list[Any], json: bool) -> None:
    if json:
        show_json({"assignments": [_data(each) for each in found]})
        return
    rows = [(each.name, each.title["en"], len(each.questions), f"{each.points:g}") for each in found]
    show_table("assignments", ("name", "title", "questions", "points"), rows)


def _show(found: Any, language: str, json: bool) -> None:
    from radiokit.faces.grading.words import checked_language

    checked_language(language, found.languages)
    if json:
        show_json(_data(found))
        return
    rows = []
    for question in found.questions:
        parts = (
            f"{part.title[language]} ({question.worth(part):g})"
            + ("" if part.visibility == "visible" else f", {part.visibility.replace('_', ' ')}")
            for part in question.parts
        )
        rows.append((question.signature, question.title[language], f"{question.points:g}", "; ".join(parts)))
        rows += [(each, "", "", "") for each in question.also]
    rows.append(("", "", f"{found.points:g}", ""))
    show_table(found.title[language], ("function", "question", "points", "parts"), rows)


def _data(found: Any) -> dict[str, Any]:
    return {
        "name": found.name,
        "title": dict(found.title),
        "points": found.points,
        "questions": [
            {
                "signature": question.signature,
                "also": list(question.also),
                "title": dict(question.title),
                "points": question.points,
                "parts": [
                    {
                        "name": part.name,
                        "title": dict(part.title),
                        "points": question.worth(part),
                        "visibility": part.visibility,
                    }
                    for part in question.parts
                ],
            }
            for question in found.questions
        ],
    }
