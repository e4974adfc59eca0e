"""Writing: the formats by name, which one a file's name means, and files that are never half written."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from radiokit.faces.grading.classroom.task import write_whole
from radiokit.faces.grading.formats.github import to_github_output
from radiokit.faces.grading.formats.gradescope import to_gradescope
from radiokit.faces.grading.formats.junit import to_junit
from radiokit.faces.grading.formats.markdown import to_markdown
from radiokit.faces.grading.formats.page import to_html
from radiokit.faces.grading.formats.table import to_csv
from radiokit.faces.grading.formats.text import to_text
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import ParameterError

__all__ = ["FORMATS", "Output", "json_text", "output", "write_file"]


def json_text(data: Any) -> str:
    """Return data as JSON text, the same for the same data."""
    return json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


FORMATS: Mapping[str, Callable[[Grade, bool], str]] = {
    "text": lambda grade, reveal: to_text(grade, reveal=reveal),
    "json": lambda grade, reveal: json_text(grade.to_json()),
    "html": lambda grade, reveal: to_html(grade, reveal=reveal),
    "markdown": lambda grade, reveal: to_markdown(grade, reveal=reveal),
    "csv": lambda grade, reveal: to_csv([grade]),
    "junit": lambda grade, reveal: to_junit(grade, reveal=reveal),
    "gradescope": lambda grade, reveal: json_text(to_gradescope(grade)),
    "github": lambda grade, reveal: to_github_output(grade, reveal=reveal) + "\n",
}
"""What a grade becomes, by the format's name; the flag says whether findings on hidden parts are told.

JSON, CSV and Gradescope's file tell all in any case: they are for the teacher, or say what is visible.
"""

SUFFIXES = {
    ".txt": "text",
    ".json": "json",
    ".html": "html",
    ".md": "markdown",
    ".csv": "csv",
    ".xml": "junit",
}


@dataclass(frozen=True)
class Output:
    """A file that is to be written, and its format."""

    format: str
    path: Path


def output(target: str) -> Output:
    """Return what ``FILE`` or ``FORMAT=FILE`` means; a format that is not named follows from the suffix.

    Raises
    ------
    ParameterError
        When there is no such format, or the file's folder is not there.

    >>> output("gradescope=results.json").format, output("a.html").format
    ('gradescope', 'html')
    """
    name, equals, rest = target.partition("=")
    if equals and name.isidentifier():
        if name not in FORMATS:
            raise ParameterError("out", target, f"FILE or FORMAT=FILE, with one of {', '.join(FORMATS)}")
        found = Output(name, Path(rest))
    else:
        suffix = Path(target).suffix.lower()
        if suffix not in SUFFIXES:
            known = ", ".join(SUFFIXES)
            raise ParameterError("out", target, f"a file that ends in {known}, or FORMAT=FILE")
        found = Output(SUFFIXES[suffix], Path(target))
    if not found.path.name or found.path.is_dir():
        raise ParameterError("out", target, "a file, not a folder")
    if not found.path.parent.is_dir():
        raise ParameterError("out", target, "in a folder that is there")
    return found


def write_file(path: Path, text: str) -> None:
    """Write a file so that whoever reads it, even after a crash, finds the old text or the new one, whole.

    Raises
    ------
    ParameterError
        When it cannot be written.
    """
    try:
        write_whole(path, text)
    except OSError as error:
        raise ParameterError("out", str(path), f"a file that can be written ({error.strerror})") from error
