"""Assignment: a list of questions as data, from an instructor's file or one that comes with radiokit."""

from __future__ import annotations

import hashlib
import importlib.util
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from radiokit.faces.grading.limits import Limits
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.words import Words, words
from radiokit.facts.errors import ParameterError, TargetError, UnknownNameError

__all__ = ["Assignment", "list_assignments", "load_assignment", "student_rng"]

FOLDER = Path(__file__).parent / "assignments"


@dataclass(frozen=True, kw_only=True)
class Assignment:
    """An assignment.

    Parameters
    ----------
    name : str
        An identifier, as in ``"radiometry"``.
    title, intro : mapping
        ``{"en": ..., "ru": ...}``, the intro in Markdown with LaTeX.
    questions : tuple of Question
    limits : Limits
        What a submission may use.

    Raises
    ------
    ParameterError
        When a name is no identifier, a text is missing, or two questions ask for one function.
    """

    name: str
    title: Words
    intro: Words
    questions: tuple[Question, ...]
    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.isidentifier():
            raise ParameterError("name", self.name, "an identifier")
        words("title", self.title)
        words("intro", self.intro)
        names = [question.name for question in self.questions]
        if not names or len(set(names)) != len(names):
            raise ParameterError("questions", names, "at least one question, each for a function of its own")

    @property
    def points(self) -> float:
        """The sum of all points."""
        return sum(question.points for question in self.questions)

    def question(self, name: str) -> Question:
        """Return the question that asks for a function.

        Raises
        ------
        UnknownNameError
            When none does.
        """
        for question in self.questions:
            if question.name == name:
                return question
        raise UnknownNameError("question", name, [question.name for question in self.questions])


def student_rng(
    assignment: Assignment, question: Question, part: Part, *, student: str = "", secret: str = ""
) -> np.random.Generator:
    """Return the generator of a student's inputs: the same in every run, another for each part and student.

    With a ``secret`` no student can foretell it.
    """
    key = json.dumps([assignment.name, question.name, part.name, student, secret])
    digest = hashlib.sha256(key.encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:16], "big"))


def list_assignments() -> list[str]:
    """Return the names of the assignments that come with radiokit.

    >>> "radiometry" in list_assignments()
    True
    """
    return sorted(path.stem for path in FOLDER.glob("*.py") if not path.stem.startswith("_"))


def load_assignment(target: str | Path | Assignment) -> Assignment:
    """Return an assignment by its name, or from a Python file that sets ``ASSIGNMENT``.

    Raises
    ------
    UnknownNameError
        When there is no assignment of that name.
    TargetError
        When the file is not there, does not run, or sets no ``ASSIGNMENT``.

    >>> load_assignment("radiometry").points > 0
    True
    """
    if isinstance(target, Assignment):
        return target
    path = Path(target)
    if path.suffix != ".py":
        if str(target) not in list_assignments():
            raise UnknownNameError("assignment", str(target), list_assignments())
        path = FOLDER / f"{target}.py"
    if not path.is_file():
        raise TargetError(f"no such file: {path}")
    module = f"{__package__}.assignments.{path.stem}" if path.parent == FOLDER else f"_assignment_{path.stem}"
    spec = importlib.util.spec_from_file_location(module, path)
    assert spec is not None
    assert spec.loader is not None
    loaded = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(loaded)
    except Exception as error:
        raise TargetError(f"{path.name} raised {type(error).__name__}: {error}") from error
    found: Mapping[str, object] = vars(loaded)
    assignment = found.get("ASSIGNMENT")
    if not isinstance(assignment, Assignment):
        raise TargetError(f"{path.name} sets no ASSIGNMENT = rk.grading.Assignment(...)")
    return assignment
