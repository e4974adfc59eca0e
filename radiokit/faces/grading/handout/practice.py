"""Practice: a student's own check of a function, here and now, on the parts that are no secret."""

from __future__ import annotations

import difflib
import dis
import html
import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from radiokit.faces.grading.assignment import Assignment, load_assignment, student_rng
from radiokit.faces.grading.finding import Finding
from radiokit.faces.grading.handout.here import Here
from radiokit.faces.grading.handout.texts import tell
from radiokit.faces.grading.handout.timing import LateError
from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.question import Question
from radiokit.faces.grading.russian import did, told, translated
from radiokit.faces.grading.words import checked_language, say
from radiokit.facts.errors import AssignmentError, CallableError, TargetError

__all__ = ["Check", "Checked", "practice"]

SECRET = "practice"
"""What makes the inputs of practice others than those of any grade."""
NOTHING = frozenset(
    {"RESUME", "NOP", "LOAD_CONST", "LOAD_SMALL_INT", "RETURN_CONST", "RETURN_VALUE", "POP_TOP"}
)
"""The instructions of a function without a body."""
COLOURS = {True: "#2e7d32", False: "#c62828", None: "#757575"}
MARKS = {True: "✓", False: "✗", None: "·"}


@dataclass(frozen=True, kw_only=True)
class Checked:
    """What was found about one function: lines of a mark and a text, as text and as HTML.

    ``right`` is whether each visible part is, or None where nothing could be judged. ``lines`` are pairs:
    True for what is right, False for what is wrong, None for a remark; and the words. ``findings`` are the
    judges' own, by part.
    """

    name: str
    right: bool | None
    lines: tuple[tuple[bool | None, str], ...]
    findings: Mapping[str, Finding]

    def __str__(self) -> str:
        return "\n".join([self.name, *(f"  {MARKS[mark]} {words}" for mark, words in self.lines)])

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<div style="color:{COLOURS[mark]}">{MARKS[mark]} {html.escape(words)}</div>'
            for mark, words in self.lines
        )
        return f'<div style="margin:0.3em 0"><code>{html.escape(self.name)}</code>{rows}</div>'


class Check:
    """Judges functions of this process for an assignment; call it with one, or ask for ``all()``."""

    def __init__(self, assignment: Assignment, language: str, student: str) -> None:
        self._assignment, self._student = assignment, student
        self._language = checked_language(language, assignment.languages)

    def __call__(self, function: Any) -> None:
        """Judge a function, and show what was found: HTML in a notebook, text elsewhere."""
        _show([self.judged(function, namespace=_namespace(function))])

    def all(self) -> None:
        """Judge all functions of the place it is called from, each by its question's name."""
        frame = inspect.currentframe()
        assert frame is not None
        assert frame.f_back is not None
        found = frame.f_back.f_globals
        _show([self._judged(question, found) for question in self._assignment.questions])

    def judged(self, function: Any, *, namespace: Mapping[str, Any] | None = None) -> Checked:
        """Return what is found about a function, without showing it."""
        names = [each for question in self._assignment.questions for each in question.functions]
        name = getattr(function, "__name__", "")
        if not callable(function) or not name:
            given = plain_text(repr(function), 60)
            text = tell(self._language, "not-a-function", given=given, name=names[0])
            return Checked(name="check", right=None, lines=((False, text),), findings={})
        if name not in names:
            close = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
            guess = (
                say(self._language, "did-you-mean", name=close[0])
                if close
                else tell(self._language, "asked-for", names=", ".join(names))
            )
            text = tell(self._language, "no-question", name=name, guess=guess)
            return Checked(name=name, right=None, lines=((False, text),), findings={})
        return self._judged(self._assignment.question(name), {**(namespace or {}), name: function})

    def _judged(self, question: Question, namespace: Mapping[str, Any]) -> Checked:
        missing = {name: _missing(namespace.get(name)) for name in question.functions}
        if all(missing.values()):
            lines = ((None, tell(self._language, missing[question.name])),)
            return Checked(name=question.name, right=None, lines=lines, findings={})
        callees = {
            name: Here(namespace.get(name), name, namespace, question.seconds) for name in question.functions
        }
        findings: dict[str, Finding] = {}
        shown: list[tuple[bool | None, str]] = []
        for part in question.parts:
            if part.visibility != "visible":
                continue
            name = question.judged(part)
            callee = callees[name]
            if missing[name]:
                text = f"{part.title[self._language]}: {name} — {tell(self._language, missing[name])}"
                shown.append((None, text))
                continue
            rng = student_rng(self._assignment, question, part, student=self._student, secret=SECRET)
            callee.raised = callee.where = ""
            try:
                finding = part.judge.judge(
                    callee, rng, language=self._language, hints=question.hints, shown=True
                )
            except LateError:
                late = f"took longer than {question.seconds:g} s in all"
                finding = Finding(share=0.0, text=did(self._language, name, callee.raised or late))
            except (CallableError, TargetError) as error:
                finding = Finding(share=0.0, text=told(self._language, error))
            except AssignmentError as error:
                text = f"{say(self._language, 'assignment-failed')} ({plain_text(error)})"
                finding = Finding(share=0.0, text=text)
            except Exception as error:  # as in the grader: no answer may break the judges
                problem = plain_text(f"{type(error).__name__}: {error}")
                finding = Finding(share=0.0, text=say(self._language, "judge-failed", error=problem))
            findings[part.name] = finding
            full = finding.share >= 1
            raised = callee.where and translated(self._language, callee.raised) in finding.text
            place = f" ({self._place(callee.where)})" if raised else ""
            shown.append((full, f"{part.title[self._language]}: {finding.text}{place}"))
        for callee in callees.values():
            if callee.printed.strip():
                shown.append((None, tell(self._language, "printed", text=plain_text(callee.printed))))
        later = [part.title[self._language] for part in question.parts if part.visibility != "visible"]
        if later:
            shown.append((None, tell(self._language, "later", parts=", ".join(later))))
        done = not any(missing.values())
        right = done and all(finding.share >= 1 for finding in findings.values()) if findings else None
        return Checked(name=question.name, right=right, lines=tuple(shown), findings=findings)

    def _place(self, where: str) -> str:
        """Return where a function raised, in words, with the line that did."""
        place, colon, line = where.partition(": ")
        return f"{translated(self._language, place)}{colon}{line}"


def practice(assignment: str | Path | Assignment, *, language: str = "en", student: str = "") -> Check:
    """Return what checks one's own functions for an assignment.

    ``check(function)`` runs the function in this process, on the parts that the student may see, with other
    inputs than any that are graded, and shows what is right, what is wrong, and the mistake if it is known.
    A function that takes longer than it may when it is graded is stopped, but not on Windows.
    ``check.all()`` does it for all questions. Nothing is isolated: it is for one's own code.

    Parameters
    ----------
    assignment : str, Path or Assignment
        A name among ``list_assignments()``, or a file.
    language : str
        ``"en"`` or ``"ru"``.
    student : str
        Who; each has inputs of his own.

    Raises
    ------
    RadiokitError
        When there is no such assignment, or no such language.

    >>> check = practice("radiometry")
    >>> check(len)
    len
      ✗ no question asks for a function len; asked for: ...
    """
    return Check(load_assignment(assignment), language, student)


def _missing(function: Any) -> str:
    """Return the key of the text on a function that is not there, or not written; empty for any other."""
    if not callable(function):
        return "absent"
    return "blank" if _is_blank(function) else ""


def _is_blank(function: Callable[..., Any]) -> bool:
    """Whether a function has no body but a docstring, ``...``, ``pass`` and ``return None``."""
    code = getattr(function, "__code__", None)
    if code is None or {each.opname for each in dis.get_instructions(code)} - NOTHING:
        return False
    returned = [
        each.argval
        for each in dis.get_instructions(code)
        if each.opname in ("LOAD_CONST", "RETURN_CONST", "LOAD_SMALL_INT")
    ]
    return all(value is None for value in returned)


def _namespace(function: Any) -> Mapping[str, Any]:
    found = getattr(function, "__globals__", {})
    return found if isinstance(found, Mapping) else {}


def _show(found: list[Checked]) -> None:
    """Show in a notebook, else write."""
    if "ipykernel" in sys.modules:
        from IPython import get_ipython
        from IPython.display import display

        if hasattr(get_ipython(), "kernel"):
            for each in found:
                display(each)
            return
    sys.stdout.write("".join(f"{each}\n" for each in found))
