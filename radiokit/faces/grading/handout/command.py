"""Command: ``radiokit assignment``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from radiokit.faces.console import show_json, show_table, write

__all__ = ["assignment"]


def assignment(
    name: Annotated[
        str | None, typer.Argument(help="A name, or FILE.py; without it, all are listed.")
    ] = None,
    to: Annotated[Path | None, typer.Option(help="Folder for the students' copies.")] = None,
    language: Annotated[list[str] | None, typer.Option(help="en (default) or ru; may be repeated.")] = None,
    form: Annotated[
        bool | None, typer.Option("--notebook/--script", help="Only notebooks, or only scripts.")
    ] = None,
    solution: Annotated[
        Path | None, typer.Option(help="A file of solutions, for the instructor's copies.")
    ] = None,
    otter: Annotated[Path | None, typer.Option(help="Folder for otter-grader's master notebook.")] = None,
    nbgrader: Annotated[Path | None, typer.Option(help="Folder of an nbgrader course.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Write over files that differ.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the assignments, show one, or write what students and instructors hold."""
    from radiokit.faces.grading.assignment import list_assignments, load_assignment

    if name is None:
        _list([load_assignment(each) for each in list_assignments()], json)
    elif to is None and otter is None and nbgrader is None:
        _show(load_assignment(name), (language or ["en"])[0], json)
    else:
        from radiokit.faces.grading.handout.write import write_handout

        written = write_handout(
            name,
            to=to,
            languages=language or ["en"],
            forms=(".ipynb", ".py") if form is None else (".ipynb",) if form else (".py",),
            solution=solution,
            otter=otter,
            nbgrader=nbgrader,
            force=force,
        )
        if json:
            show_json({"assignment": name, "written": [str(path) for path in written]})
        else:
            write("\n".join(map(str, written)))


def _list(found: list[Any], json: bool) -> None:
    if json:
        show_json({"assignments": [_data(each) for each in found]})
        return
    rows = [(each.name, each.title["en"], len(each.questions), f"{each.points:g}") for each in found]
    show_table("assignments", ("name", "title", "questions", "points"), rows)


def _show(found: Any, language: str, json: bool) -> None:
    from radiokit.faces.grading.words import checked_language

    checked_language(language)
    if json:
        show_json(_data(found))
        return
    rows = [
        (
            question.signature,
            question.title[language],
            f"{question.points:g}",
            ", ".join(f"{part.title[language]} ({question.worth(part):g})" for part in question.parts),
        )
        for question in found.questions
    ]
    show_table(found.title[language], ("function", "question", "points", "parts"), rows)


def _data(found: Any) -> dict[str, Any]:
    return {
        "name": found.name,
        "title": dict(found.title),
        "points": found.points,
        "questions": [
            {
                "signature": question.signature,
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
