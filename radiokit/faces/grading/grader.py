"""Grader: runs a submission in its sandbox, question by question, and says what each one earned."""

from __future__ import annotations

import difflib
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from radiokit.contracts.bsdf import BSDF
from radiokit.faces.grading.assignment import Assignment, load_assignment, student_rng
from radiokit.faces.grading.finding import Finding, Mode
from radiokit.faces.grading.grades import Grade, PartGrade, QuestionGrade
from radiokit.faces.grading.isolation.protocol import Array, plain_text
from radiokit.faces.grading.isolation.remote import remote_bsdf
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.russian import told, translated
from radiokit.faces.grading.words import checked_language, say
from radiokit.facts.errors import AssignmentError, CallableError, TargetError

__all__ = ["Isolated", "grade"]


@dataclass(frozen=True)
class Isolated:
    """A student's function in a sandbox."""

    sandbox: Sandbox
    name: str

    def call(self, *arrays: Array, mode: Mode = "batch", outputs: int = 1, seed: int | None = None) -> Result:
        """Call it; whatever it does, a result comes back."""
        return self.sandbox.call(self.name, *arrays, mode=mode, outputs=outputs, seed=seed)

    def bsdf(self, parameters: Mapping[str, Any] | None = None) -> BSDF:
        """Return it as a BSDF; parameters that it has other names for are passed by position."""
        return remote_bsdf(self.sandbox, self.name, parameters=parameters, by_position=True)

    def other(self, name: str) -> Isolated:
        """Return another function of the same submission."""
        return Isolated(self.sandbox, name)


def grade(
    assignment: str | Path | Assignment,
    submission: str | Path,
    *,
    content: bytes | None = None,
    student: str = "",
    secret: str = "",
    language: str = "en",
    questions: Sequence[str] | None = None,
    earlier: Grade | None = None,
    keep: Callable[[Grade], None] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Grade:
    """Grade a submission.

    Its code runs in a sandbox and is handed inputs alone; references and points stay in this process. Parts
    that are not visible have a sandbox of their own, for what a function keeps of their inputs it could show
    in another part's message.

    Parameters
    ----------
    assignment : str, Path or Assignment
        A name among ``list_assignments()``, or a file of your own.
    submission : str or Path
        A script or a notebook.
    content : bytes, optional
        What it holds, where it is no file: then ``submission`` is its name alone.
    student : str
        Who; each student has inputs of his own.
    secret : str
        What makes the inputs unforeseeable; keep it between runs, for they depend on it.
    language : str
        ``"en"`` or ``"ru"``, if the assignment has texts in it.
    questions : sequence of str, optional
        Only these, by their functions' names, as if the assignment had no others.
    earlier : Grade, optional
        An incomplete grade of the same submission: its questions are not graded again.
    keep : callable, optional
        Called with the grade so far, after each question.
    progress : callable, optional
        Called with the number of finished questions and of all, before each.

    Returns
    -------
    Grade
        The same in every run, if the submission's functions are. Nothing that the submission does is
        raised here.

    Raises
    ------
    RadiokitError
        When the assignment, a question or the submission is not there, or no sandbox can be started.
    """
    work = load_assignment(assignment)
    taken = {name for each in work.questions for name in each.functions}
    wanted = {work.question(name).name for name in questions} if questions is not None else taken
    asked = [each for each in work.questions if each.name in wanted]
    checked_language(language, work.languages)
    done = {question.name: question for question in earlier.questions} if earlier is not None else {}
    grades: list[QuestionGrade] = []
    result = Grade(
        assignment=work.name,
        title=work.title[language],
        student=student,
        language=language,
        questions=(),
        complete=False,
    )
    with (
        Sandbox(submission, content=content, limits=work.limits) as sandbox,
        Sandbox(submission, content=content, limits=work.limits, beside=sandbox) as unseen,
    ):
        loaded = sandbox.load()
        names = list(loaded.facts.get("names", ())) if loaded.ok else []
        problems = _problems(loaded, language)
        result = replace(result, problems=problems, protections=loaded.protections, missing=loaded.missing)
        seconds, measured = {}, {}
        for question in asked:
            if progress is not None:
                progress(len(grades), len(asked))
            began = time.monotonic()
            if question.name in done:
                grades.append(done[question.name])
            else:
                with sandbox.within(question.seconds):  # what hangs costs it once
                    absent = {
                        name: _absent(sandbox, name, loaded, names, taken, problems, language)
                        for name in question.functions
                    }
                    found, review, numbers = _judged(
                        sandbox, unseen, work, question, absent, student, secret, language
                    )
                measured.update({f"{question.name}.{name}": value for name, value in numbers.items()})
                grades.append(_graded(question, found, review, language))
            seconds[question.name] = time.monotonic() - began
            result = replace(
                result,
                questions=tuple(grades),
                complete=len(grades) == len(asked),
                seconds=seconds,
                measured=measured,
            )
            if keep is not None:
                keep(result)
    return result


def _judged(
    sandbox: Sandbox,
    unseen: Sandbox,
    work: Assignment,
    question: Question,
    absent: Mapping[str, Finding | None],
    student: str,
    secret: str,
    language: str,
) -> tuple[dict[str, Finding], str, dict[str, float]]:
    """Return the finding of each part, why a person should look, and what was measured."""
    found: dict[str, Finding] = {}
    review = ""
    numbers: dict[str, float] = {}
    for part in question.parts:
        name = question.judged(part)
        needed = (name, *getattr(part.judge, "needs", ()))
        missing = next((absent[each] for each in needed if absent.get(each) is not None), None)
        if missing is not None:
            found[part.name] = missing
            continue
        rng = student_rng(work, question, part, student=student, secret=secret)
        shown = part.visibility == "visible"
        try:
            place = sandbox if shown else unseen
            with place.apart():
                finding = part.judge.judge(
                    Isolated(place, name),
                    rng,
                    language=language,
                    hints=question.hints,
                    shown=shown,
                )
        except (CallableError, TargetError) as error:
            finding = Finding(share=0.0, text=told(language, error))
        except AssignmentError as error:  # the student is told no more, for it may tell what is right
            review = plain_text(f"the assignment is at fault, part {part.name}: {error}")
            finding = Finding(share=0.0, text=say(language, "assignment-failed"))
        except Exception as error:  # no answer may stop the grading: a person will look
            review = plain_text(f"{type(error).__name__}: {error}")
            finding = Finding(share=0.0, text=say(language, "judge-failed", error=review))
        found[part.name] = finding
        numbers.update({f"{part.name}.{key}": value for key, value in finding.measured.items()})
    return found, review, numbers


def _graded(question: Question, found: Mapping[str, Finding], review: str, language: str) -> QuestionGrade:
    def graded(part: Part) -> PartGrade:
        finding, points = found[part.name], question.worth(part)
        return PartGrade(
            name=part.name,
            title=part.title[language],
            score=points * min(max(finding.share, 0.0), 1.0),
            points=points,
            visibility=part.visibility,
            text=plain_text(finding.text, 1000),
            diagnosis=finding.diagnosis,
            confidence=finding.confidence,
        )

    parts = tuple(graded(part) for part in question.parts)
    return QuestionGrade(name=question.name, title=question.title[language], parts=parts, review=review)


def _problems(loaded: Result, language: str) -> tuple[str, ...]:
    if not loaded.ok:
        return (say(language, "not-loaded", error=translated(language, loaded.error)),)
    return tuple(_problem(each, language) for each in loaded.facts.get("problems", ()))


def _problem(found: Mapping[str, str], language: str) -> str:
    key = "problem" if found["raised"] else "remark"
    where, message = (translated(language, found[name]) for name in ("where", "message"))
    text = say(language, key, where=where, raised=found["raised"], message=message)
    return text.lstrip(": ")  # where no place is known


def _absent(
    sandbox: Sandbox,
    function: str,
    loaded: Result,
    names: Sequence[str],
    taken: Collection[str],
    problems: tuple[str, ...],
    language: str,
) -> Finding | None:
    """Return why a function cannot be graded at all, if so.

    Of the submission's own ``names`` one is suggested that is like this function, and more so than like any
    other that is asked for, ``taken``.
    """
    if not loaded.ok:
        return Finding(share=0.0, text=problems[0])
    if sandbox.facts(function).facts.get("callable"):
        return None
    others = [name for name in names if name not in taken]
    owner = next((name for name in others if sandbox.facts(f"{name}.{function}").facts.get("callable")), "")
    own = [name for name in others if difflib.get_close_matches(name, sorted(taken), n=1) == [function]]
    close = difflib.get_close_matches(function, own, n=1)
    guess = say(language, "did-you-mean", name=close[0]) if close else ""
    guess = say(language, "method", name=f"{owner}.{function}", where=owner) if owner else guess
    text = say(language, "no-function", function=function, guess=guess)
    return Finding(share=0.0, text="; ".join([text, *problems[:1]]))
