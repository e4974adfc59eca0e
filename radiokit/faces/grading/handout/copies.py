"""Copies: a student's copy of an assignment, with blank functions, and the instructor's, with solutions.

A student's copy is made without the file of solutions, so nothing of it can be in there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.handout.cells import Cell, code, markdown
from radiokit.faces.grading.handout.texts import tell
from radiokit.faces.grading.handout.worked import INDENT, Solution
from radiokit.faces.grading.question import Question
from radiokit.faces.grading.words import checked_language

__all__ = ["answer", "instructor_cells", "intro", "question_text", "student_cells"]

BLANK = f"{INDENT}..."


def student_cells(assignment: Assignment, language: str = "en", *, checked_by: str = "") -> list[Cell]:
    """Return a student's copy.

    Parameters
    ----------
    assignment : Assignment
    language : str
        ``"en"`` or ``"ru"``.
    checked_by : str
        The assignment's name, where a student's radiokit has it; empty to leave out the checks of one's own.
    """
    return _cells(assignment, language, checked_by, None)


def instructor_cells(
    assignment: Assignment, language: str = "en", *, solution: Solution, checked_by: str = ""
) -> list[Cell]:
    """Return the instructor's copy: the student's, with the bodies of the solution."""
    return _cells(assignment, language, checked_by, solution)


def _cells(assignment: Assignment, language: str, checked_by: str, solution: Solution | None) -> list[Cell]:
    checked_language(language, assignment.languages)
    cells = [intro(assignment, language, checked=bool(checked_by), solved=solution is not None)]
    setup = "import numpy as np\n"
    if checked_by:
        setup += (
            f'\nimport radiokit as rk\n\ncheck = rk.grading.practice("{checked_by}", language="{language}")'
        )
    cells.append(code("setup", setup))
    if solution is not None and solution.helpers:
        cells.append(code("helpers", solution.helpers))
    for number, question in enumerate(assignment.questions, start=1):
        cells.append(question_text(question, number, language))
        body = None if solution is None else solution.bodies.__getitem__
        cells.append(code(f"{question.name}-answer", answer(question, language, body)))
        if checked_by:
            cells.append(code(f"{question.name}-check", f"check({question.name})"))
    if checked_by:
        cells += [markdown("all-title", tell(language, "all")), code("all", "check.all()")]
    return [*cells, markdown("hand-in", tell(language, "hand-in"))]


def intro(assignment: Assignment, language: str, *, checked: bool, solved: bool = False) -> Cell:
    """Return the first cell: title, intro, and what holds for all questions."""
    how = "\n".join([tell(language, "how"), *([tell(language, "check")] if checked else [])])
    note = [tell(language, "solved")] if solved else []
    texts: Sequence[str] = [f"# {assignment.title[language]}", *note, assignment.intro[language].strip(), how]
    return markdown("intro", "\n\n".join(texts))


def question_text(question: Question, number: int, language: str) -> Cell:
    """Return a question's title, points and text, and what is graded unseen."""
    points = tell(language, "points", points=question.points)
    texts = [f"## {number}. {question.title[language]} ({points})", question.text[language].strip()]
    unseen = [part.title[language] for part in question.parts if part.visibility != "visible"]
    if unseen:
        texts.append(tell(language, "beside", parts=", ".join(unseen)))
    return markdown(f"{question.name}-text", "\n\n".join(texts))


def answer(question: Question, language: str, body: Callable[[str], str] | None = None) -> str:
    """Return the functions of a question, the first with a docstring, each with ``body(name)`` or blank."""
    title = question.title[language].replace("\\", r"\\").replace('"""', "'''").rstrip('"')
    documented = f'def {question.signature}:\n{INDENT}"""{title}."""'
    headers = [documented, *(f"def {signature}:" for signature in question.also)]
    pairs = zip(headers, question.functions, strict=True)
    return "\n\n\n".join(f"{header}\n{body(name) if body else BLANK}" for header, name in pairs)
