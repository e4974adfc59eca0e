"""Rehearsal: what an assignment's judges do without a submission, so that its mistakes are seen in time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from radiokit.faces.grading.assignment import Assignment, load_assignment, student_rng
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.directions import integral
from radiokit.faces.grading.judges.draws import cells_of_density
from radiokit.faces.grading.judges.estimator import Estimator
from radiokit.faces.grading.judges.exact import as_function
from radiokit.faces.grading.judges.given import called, drawn, number, numbers, own, shown, truth
from radiokit.faces.grading.judges.laws import Laws
from radiokit.faces.grading.judges.runs import exact
from radiokit.faces.grading.judges.sampler import Sampler
from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part, Question
from radiokit.facts.errors import AssignmentError, suggestion

__all__ = ["faults", "rehearse", "rehearsed"]

DIRECTIONS = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.8, 0.6], [-0.48, 0.64, 0.6]])
"""Where densities and BRDFs are tried."""
OFF, AGREE = 0.03, 0.01
"""How far the integral of a density must be off, and how well two rules must agree on it, to be an error."""


def rehearse(assignment: Assignment, *, student: str = "", secret: str = "") -> None:
    """Draw a student's inputs, and call whatever the judges will call of the assignment's own functions.

    Raises
    ------
    AssignmentError
        When an input, a reference or anything else of the assignment is wrong: the first that is.

    >>> from radiokit.faces.grading.assignment import load_assignment
    >>> rehearse(load_assignment("radiometry"))
    """
    for fault in faults(assignment, student=student, secret=secret):
        raise fault


def rehearsed(target: str | Path | Assignment) -> Assignment:
    """Return an assignment by its name or from a file, rehearsed if it is no one's but the instructor's.

    Raises
    ------
    RadiokitError
        When it cannot be loaded, or is at fault.
    """
    work = load_assignment(target)
    if not isinstance(target, str) or Path(target).suffix == ".py":  # those that come along are tested
        rehearse(work)
    return work


def faults(assignment: Assignment, *, student: str = "", secret: str = "") -> Iterator[AssignmentError]:
    """Yield what is wrong with an assignment, at most once for each part; arguments as of `rehearse`."""
    asked = [name for question in assignment.questions for name in question.functions]
    for question in assignment.questions:
        for part in question.parts:
            rng = student_rng(assignment, question, part, student=student, secret=secret)
            try:
                with np.errstate(all="ignore"):
                    _tried(part, question, rng)
                pdf = part.judge.pdf if isinstance(part.judge, Sampler) else ""
                if pdf and pdf not in asked:
                    guess = suggestion(pdf, asked) or "; also=(...) of a question asks for it"
                    raise AssignmentError(
                        f"pdf = {pdf!r} is not allowed: it must be a function that is asked for{guess}"
                    )
            except AssignmentError as error:
                yield AssignmentError(
                    f"{assignment.name}: question {question.name}, part {part.name}: {error}",
                    question=question.name,
                    part=part.name,
                )


def _tried(part: Part, question: Question, rng: np.random.Generator) -> None:
    judge: Any = part.judge
    asked = next(each for each in (question.signature, *question.also) if _is_of(each, question.judged(part)))
    question = replace(question, signature=asked, also=(), parts=(replace(part, function=""),))
    for kind, tried in _TRIED.items():
        if isinstance(judge, kind):
            tried(judge, question, rng)
    if callable(getattr(judge, "rehearse", None)):
        own("rehearse", judge.rehearse, question, rng)


def _values(judge: Values, question: Question, rng: np.random.Generator) -> None:
    given, reference = _drawn_again(judge.inputs, rng), as_function(judge.reference)
    _named(question, list(given), after=question.parameters[len(given) :][: _optional(question, given)])
    right = truth(reference, given)
    allowed = judge.allowed(right, judge.rtol)
    _steady(reference, given, right)
    turned = {name: array[::-1] if array.ndim else array for name, array in given.items()}
    if any(array.ndim for array in given.values()):
        off = np.abs(truth(reference, turned)[::-1] - right)
        if not np.all(off <= allowed):
            worst = float(np.max(off / np.maximum(np.abs(right), 1e-300)))
            raise AssignmentError(
                f"rtol = {judge.rtol:g} is not allowed: it must be larger, for in another order the "
                f"reference itself gives other numbers, by {worst:.1g} of them"
            )
    for name, variant in judge.variants.items():
        what = f"variants[{name!r}]"
        found = numbers(own(what, variant, **given), what)
        if right.ndim == 1 and found.shape != right.shape:
            raise AssignmentError(f"{what} gives shape {found.shape}: it must give {right.shape}")
    if judge.context is not None:
        _context(own("context", judge.context, **given))
    if judge.terms is not None:
        numbers(own("terms", judge.terms, **given), "terms")


def _estimator(judge: Estimator, question: Question, rng: np.random.Generator) -> None:
    state, reference = rng.bit_generator.state, as_function(judge.reference)
    given = _drawn_again(judge.inputs, rng, rows=False)
    _named(question, list(given), after=question.parameters[len(given) :][:2])
    if len(question.parameters) != len(given) + 2 or question.parameters[-2:] == ("seed", "samples"):
        wanted = ", ".join([*given, "samples", "seed"])
        raise AssignmentError(
            f"signature = {question.signature!r} is not allowed: it must be {question.name}({wanted})"
        )
    rng.bit_generator.state = state
    given, right = exact(judge.inputs, reference, rng)
    _steady(reference, given, np.array([right]))
    for name, variant in judge.variants.items():
        number(variant, given, f"variants[{name!r}]")
    for what in ("budget", "uniform"):
        function = getattr(judge, what)
        if function is not None and number(function, given, what) <= 0:
            raise AssignmentError(f"{what} gives {number(function, given, what):g}: a variance is above 0")
    if judge.context is not None:
        _context(own("context", judge.context, **given))


def _sampler(judge: Sampler, question: Question, rng: np.random.Generator) -> None:
    given = _drawn_again(judge.inputs, rng, rows=False)
    _named(question, list(given), before=question.parameters[:1])
    functions = {"density": judge.density, "integrand": judge.integrand}
    functions |= {f"variants[{name!r}]": variant for name, variant in judge.variants.items()}
    for what, function in functions.items():
        if function is not None:
            called(function, DIRECTIONS, given, what)
    _whole(partial(called, judge.density, given=given))


def _laws(judge: Laws, question: Question, rng: np.random.Generator) -> None:
    if len(question.parameters) < 2:
        raise AssignmentError(
            f"signature = {question.signature!r} is not allowed: it must be {question.name}(wi, wo), or with "
            "further parameters"
        )
    wi, wo = DIRECTIONS, DIRECTIONS[::-1]
    for given in judge.chosen(rng):
        _named(question, list(given), before=question.parameters[:2])
        if judge.reference is not None:
            judge.meant(given)
        for name, variant in judge.variants.items():
            what = f"variants[{name!r}]"
            found = numbers(own(what, variant, wi, wo, **given), what)
            if found.shape != (len(wi),):
                raise AssignmentError(
                    f"{what} gives shape {found.shape} for {len(wi)} pairs: it must give (N,)"
                )


def _whole(density: Callable[[Array], Array]) -> None:
    """Check that a density is 1 when it is integrated, as far as two rules agree on what it is instead."""
    cells = cells_of_density(density)
    sums = float(cells.shares()[0].sum()), integral(density, cells.width)
    if abs(sums[0] - sums[1]) < AGREE and all(abs(each - 1) > OFF for each in sums):
        raise AssignmentError(
            f"density gives {sums[1]:.4g} when it is integrated over the hemisphere: it must give 1"
        )


_TRIED: Mapping[type, Callable[[Any, Question, np.random.Generator], None]] = {
    Values: _values,
    Estimator: _estimator,
    Sampler: _sampler,
    Laws: _laws,
}


def _is_of(signature: str, function: str) -> bool:
    return signature.partition("(")[0].strip() == function


def _optional(question: Question, given: Mapping[str, Any]) -> int:
    """Return how many of the parameters that get no input need none."""
    return len(question.parameters) - max(len(given), question.needed)


def _drawn_again(
    inputs: Callable[..., Any], rng: np.random.Generator, *, rows: bool = True
) -> dict[str, Array]:
    """Return inputs, and check that the same generator gives the same ones again."""
    state = rng.bit_generator.state
    first = drawn(inputs, rng, rows=rows)
    rng.bit_generator.state = state
    given = drawn(inputs, rng, rows=rows)
    for name, array in given.items():
        if name not in first or not np.array_equal(array, first[name]):
            raise AssignmentError(
                f"inputs gives other numbers for {name} from the same generator: what is random must come "
                "from the generator that it is given"
            )
    return given


def _named(
    question: Question,
    names: list[str],
    *,
    before: tuple[str, ...] = (),
    after: tuple[str, ...] = (),
) -> None:
    """Check that inputs are a question's parameters, between those that are no inputs."""
    wanted = question.parameters[len(before) : len(question.parameters) - len(after)]
    if tuple(names) != wanted:
        order = ", in the same order" if sorted(names) == sorted(wanted) else ""
        taken = f" after {', '.join(before)}" if before else ""
        raise AssignmentError(
            f"inputs are named ({', '.join(names)}), but the parameters of {question.signature}{taken} are "
            f"({', '.join(wanted)}): they must be the same{order}"
        )


def _steady(reference: Callable[..., Any], given: Mapping[str, Array], right: Array) -> None:
    """Check that a reference says the same again."""
    again = np.atleast_1d(numbers(own("reference", reference, **given), "reference"))
    if again.shape != right.shape or not np.array_equal(again, right):
        now, before = float(again.flat[0]), float(right.flat[0])
        raise AssignmentError(
            f"reference gives {now!r} for inputs for which it gave {before!r}: it must depend on them alone"
        )


def _context(found: Any) -> None:
    if not isinstance(found, Mapping):
        raise AssignmentError(
            f'context gives {shown(found)}: it must give inputs by name, as in {{"theta": ...}}'
        )
