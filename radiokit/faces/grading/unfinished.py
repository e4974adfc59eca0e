"""Grades of what is not graded: questions that are still to come, and work that was never handed in."""

from __future__ import annotations

from dataclasses import replace

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.question import Question
from radiokit.faces.grading.words import SENTENCES, checked_language, say

__all__ = ["is_pending", "no_submission", "nothing_yet", "with_pending"]


def nothing_yet(assignment: Assignment, *, student: str = "", language: str = "en") -> Grade:
    """Return the grade before anything is graded, without questions.

    >>> from radiokit.faces.grading.assignment import load_assignment
    >>> grade = nothing_yet(load_assignment("radiometry"))
    >>> grade.score, grade.complete
    (0, False)
    """
    checked_language(language, assignment.languages)
    return Grade(
        assignment=assignment.name,
        title=assignment.title[language],
        student=student,
        language=language,
        questions=(),
        complete=False,
    )


def with_pending(grade: Grade, assignment: Assignment) -> Grade:
    """Return a grade with the questions that are still to be graded, at no points."""
    done = {question.name: question for question in grade.questions}
    text = say(grade.language, "not-graded")
    questions = tuple(
        done.get(question.name) or _without_points(question, text, grade.language)
        for question in assignment.questions
    )
    return replace(grade, questions=questions)


def no_submission(
    assignment: Assignment, error: str, *, student: str = "", language: str = "en", review: bool = False
) -> Grade:
    """Return the grade of work that is not there: no points, complete, and ``error`` says what was found.

    ``review`` says that a person should look at it.
    """
    text = say(checked_language(language, assignment.languages), "no-submission", error=error)
    grade = nothing_yet(assignment, student=student, language=language)
    questions = tuple(_without_points(question, text, language) for question in assignment.questions)
    if review:
        questions = tuple(replace(question, review=text) for question in questions)
    return replace(grade, questions=questions, problems=(text,), complete=True)


def is_pending(part: PartGrade) -> bool:
    """Whether a part is still to be graded; no judge says just this sentence."""
    return part.text in SENTENCES["not-graded"].values()


def _without_points(question: Question, text: str, language: str) -> QuestionGrade:
    parts = tuple(
        PartGrade(
            name=part.name,
            title=part.title[language],
            score=0.0,
            points=question.worth(part),
            visibility=part.visibility,
            text=text,
        )
        for part in question.parts
    )
    return QuestionGrade(name=question.name, title=question.title[language], parts=parts)
