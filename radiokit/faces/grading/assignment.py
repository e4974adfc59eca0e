"""Assignment: a list of questions as data, from an instructor's file or one that comes with radiokit."""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

import numpy as np

from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.judges.given import line_of
from radiokit.faces.grading.names import check_names
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.words import Words, words
from radiokit.facts.errors import ParameterError, RadiokitError, TargetError, UnknownNameError

__all__ = [
    "Assignment",
    "assignment_from_source",
    "assignment_source",
    "list_assignments",
    "load_assignment",
    "student_rng",
]

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
        When a name is no identifier, a text is missing, a function is asked for twice, or hints, credit or
        variants name a misconception that is none.
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
        if not isinstance(self.limits, Limits):
            raise ParameterError("limits", self.limits, "rk.grading.Limits(...)")
        if not isinstance(self.questions, tuple | list) or not all(
            isinstance(question, Question) for question in self.questions
        ):
            allowed = "a tuple of rk.grading.Question(...); one alone is (Question(...),)"
            kinds = (
                [type(each).__name__ for each in self.questions]
                if isinstance(self.questions, tuple | list)
                else None
            )
            raise ParameterError("questions", kinds or type(self.questions).__name__, allowed)
        names = [name for question in self.questions for name in question.functions]
        if not names or len(set(names)) != len(names):
            raise ParameterError("questions", names, "at least one question, each for functions of its own")
        object.__setattr__(self, "questions", tuple(self.questions))
        check_names(self.questions)

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
            if name in question.functions:
                return question
        also = [each for question in self.questions for each in question.functions]
        raise UnknownNameError("question", name, [question.name for question in self.questions], also)


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

    The file stands alone: its text is sent to wherever it grades, without modules and data beside it.

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
    return assignment_from_source(*assignment_source(target))


def assignment_source(target: str | Path) -> tuple[str, str]:
    """Return the source text and the file name of an assignment, by its name or its file.

    Raises
    ------
    UnknownNameError
        When there is no assignment of that name.
    TargetError
        When the file is not there, or is no text.

    >>> assignment_source("radiometry")[1]
    'radiometry.py'
    """
    path = Path(target)
    if path.suffix != ".py":
        if str(target) not in list_assignments():
            own = [f"{target}.py"] if Path(f"{target}.py").is_file() else []
            raise UnknownNameError("assignment", str(target), list_assignments(), own)
        path = FOLDER / f"{target}.py"
    if not path.is_file():
        raise TargetError(f"no such file: {path}")
    try:
        return path.read_text(encoding="utf-8"), path.name
    except (OSError, UnicodeDecodeError) as error:
        raise TargetError(f"{path.name} cannot be read: {error}") from error


def assignment_from_source(source: str, file: str = "assignment.py") -> Assignment:
    """Return the assignment that a source text sets as ``ASSIGNMENT``; ``file`` is what errors call it.

    Raises
    ------
    TargetError
        When the text does not run, or sets no ``ASSIGNMENT``.

    >>> assignment_from_source("x = 1 / 0", "mine.py")
    Traceback (most recent call last):
        ...
    radiokit.facts.errors.TargetError: mine.py, line 1: ZeroDivisionError: division by zero
    """
    name = f"_assignment_{hashlib.sha256(source.encode()).hexdigest()[:16]}"
    module = ModuleType(name)
    module.__file__, module.__package__ = file, ""  # so that a relative import says what it lacks
    sys.modules[name] = module  # where its own dataclasses look for their module
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # what is printed is the grade alone
            exec(compile(source, file, "exec", dont_inherit=True), vars(module))
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise TargetError(_told(error, file)) from error
    assignment = vars(module).get("ASSIGNMENT")
    if not isinstance(assignment, Assignment):
        kind = f", but a {type(assignment).__name__}" if "ASSIGNMENT" in vars(module) else ""
        raise TargetError(f"{file} sets no ASSIGNMENT = rk.grading.Assignment(...){kind}")
    return assignment


def _told(error: BaseException, file: str) -> str:
    """Return in one line what an assignment's file did instead of running, where, and what would be right."""
    where, said = line_of(error), " ".join(str(error).split()).replace(".__init__()", "(...)")
    if isinstance(error, SyntaxError):
        where, said = f" ({file}, line {error.lineno})", error.msg
    at = where.strip(" ()") or file
    if isinstance(error, RadiokitError):
        return f"{at}: {said}"
    missing = isinstance(error, FileNotFoundError) or (
        isinstance(error, ImportError) and not (error.name or "").startswith("radiokit")
    )
    alone = "; an assignment is one file, without modules and data beside it" if missing else ""
    return f"{at}: {type(error).__name__}: {said}{alone}"
