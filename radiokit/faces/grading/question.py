"""Question: what an assignment asks for, as data: a function, its points, and the judges of its parts."""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from radiokit.faces.grading.finding import Judge
from radiokit.faces.grading.words import Words, languages, words
from radiokit.facts.errors import ParameterError

__all__ = ["PARTS", "Part", "Question", "Visibility"]

Visibility = Literal["visible", "hidden", "after_due_date", "after_published"]

PARTS: Mapping[str, Words] = {
    "ordinary": {"en": "ordinary inputs", "ru": "обычные входы"},
    "hard": {"en": "hard inputs", "ru": "трудные входы"},
    "reciprocity": {"en": "reciprocity", "ru": "обратимость"},
    "energy": {"en": "conservation of energy", "ru": "сохранение энергии"},
    "normalisation": {"en": "normalisation", "ru": "нормировка"},
    "honest": {"en": "honest standard error", "ru": "честная стандартная ошибка"},
    "unbiased": {"en": "no bias", "ru": "несмещённость"},
    "distribution": {"en": "distribution of the samples", "ru": "распределение выборки"},
    "density": {"en": "density", "ru": "плотность"},
    "efficiency": {"en": "efficiency", "ru": "эффективность"},
    "laws": {"en": "laws", "ru": "законы"},
}
"""Titles of parts by their usual names."""


@dataclass(frozen=True, kw_only=True)
class Part:
    """One part of a question: what is judged, and what it weighs.

    Parameters
    ----------
    name : str
        Such as ``"ordinary"`` or ``"hard"``.
    judge : Judge
        ``Values``, ``Laws``, ``Estimator``, ``Sampler``, or one of your own.
    weight : float
        Its weight among the question's parts, above 0.
    visibility : str
        ``"visible"``: the student sees it at once, right values included; ``"hidden"``, ``"after_due_date"``,
        ``"after_published"``: never, or later.
    function : str
        Which of the question's functions is judged; its own by default.
    title : mapping, optional
        ``{"en": ..., "ru": ...}``; the usual names have one.

    Raises
    ------
    ParameterError
        When an argument is out of its range.
    """

    name: str
    judge: Judge
    weight: float = 1.0
    visibility: Visibility = "visible"
    function: str = ""
    title: Words = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not isinstance(self.weight, int | float) or not 0 < self.weight < math.inf:
            raise ParameterError("weight", self.weight, "a finite number above 0")
        if self.visibility not in get_args(Visibility):
            raise ParameterError("visibility", self.visibility, ", ".join(get_args(Visibility)))
        if isinstance(self.judge, type) or not callable(getattr(self.judge, "judge", None)):
            raise ParameterError("judge", self.judge, "an object with a method judge, such as Values(...)")
        if not isinstance(self.name, str) or not self.name:
            raise ParameterError("name", self.name, "a text")
        usual = f'texts {{"en": ..., "ru": ...}}; only these names have one: {", ".join(PARTS)}'
        if not self.title and self.name not in PARTS:
            raise ParameterError(f"title of part {self.name}", self.title, usual)
        title = words(f"title of part {self.name}", self.title or PARTS[self.name])
        object.__setattr__(self, "title", title)


@dataclass(frozen=True, kw_only=True)
class Question:
    """One question: a function that the student writes, and what he is to write beside it.

    Parameters
    ----------
    signature : str
        Such as ``"solid_angle(half_angle)"``; the function's name is the question's. Its parameters are the
        judges' inputs, by the same names and in the same order. Defaults and annotations may stand in it.
    points : float
        Above 0; shared by the parts by their weights.
    title, text : mapping
        ``{"en": ..., "ru": ...}``, the text in Markdown with LaTeX; in the languages of the assignment.
    parts : tuple of Part
    also : tuple of str
        The signatures of further functions that it asks for, such as ``"cosine_pdf(directions)"`` beside
        ``"cosine_sample(u)"``. A judge finds them with ``callee.other(name)``; a part may be on one of them.
    hints : mapping
        Further sentences ``{"en": ..., "ru": ...}`` by the misconception that they answer, one of
        ``rk.grading.list_diagnoses()`` or of a judge's ``variants``.
    seconds : float
        Wall time for all calls of all its parts together [s], above 0.

    Raises
    ------
    ParameterError
        When an argument is out of its range, two parts or functions have one name, or a part is on a function
        that is not asked for.

    Examples
    --------
    >>> from radiokit.faces.grading.judges.values import Values
    >>> import numpy as np
    >>> judge = Values(inputs=lambda rng: {"x": rng.random(8)}, reference=lambda x: x**2)
    >>> both = {"en": "Square", "ru": "Квадрат"}
    >>> square = Question(
    ...     signature="square(x)",
    ...     points=2,
    ...     title=both,
    ...     text=both,
    ...     parts=(Part(name="ordinary", judge=judge),),
    ... )
    >>> square.name, square.functions
    ('square', {'square': ('x',)})
    """

    signature: str
    points: float
    title: Words
    text: Words
    parts: tuple[Part, ...]
    also: tuple[str, ...] = ()
    hints: Mapping[str, Words] = field(default_factory=dict)
    seconds: float = 10.0

    def __post_init__(self) -> None:
        for signature in (self.signature, *((self.also,) if isinstance(self.also, str) else self.also)):
            arguments = _function(signature).args
            if arguments.vararg or arguments.kwarg:
                raise ParameterError(
                    "signature", signature, "without * and **: inputs are handed over by place"
                )
        if isinstance(self.also, str):
            raise ParameterError("also", self.also, "a tuple of signatures")
        if len(self.functions) != 1 + len(self.also):
            raise ParameterError("also", self.also, "signatures, each of a name of its own")
        for name in ("points", "seconds"):
            value = getattr(self, name)
            if not isinstance(value, int | float) or not 0 < value < math.inf:
                raise ParameterError(f"{self.name}: {name}", value, "a finite number above 0")
        has = languages(words(f"{self.name}: title", self.title))
        words(f"{self.name}: text", self.text, has)
        if not isinstance(self.hints, Mapping):
            raise ParameterError(f"{self.name}: hints", self.hints, "texts by misconception")
        for hint, said in self.hints.items():
            words(f"{self.name}: hints[{hint!r}]", said, has)
        if not isinstance(self.parts, tuple | list) or not all(isinstance(part, Part) for part in self.parts):
            allowed = "a tuple of rk.grading.Part(name=..., judge=...); one alone is (Part(...),)"
            kinds = (
                [type(each).__name__ for each in self.parts] if isinstance(self.parts, tuple | list) else None
            )
            raise ParameterError(f"{self.name}: parts", kinds or type(self.parts).__name__, allowed)
        names = [part.name for part in self.parts]
        if not names or len(set(names)) != len(names):
            raise ParameterError(f"{self.name}: parts", names, "at least one part, each of a name of its own")
        object.__setattr__(self, "parts", tuple(self.parts))
        for part in self.parts:
            words(f"{self.name}: title of part {part.name}", part.title, has)
            if self.judged(part) not in self.functions:
                raise ParameterError("function", part.function, f"among {', '.join(self.functions)}")

    @property
    def name(self) -> str:
        """The function's name."""
        return _function(self.signature).name

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of its parameters, in order."""
        return self.functions[self.name]

    @property
    def functions(self) -> Mapping[str, tuple[str, ...]]:
        """The parameters of each function that it asks for by that function's name, its own first."""
        found = [_function(signature) for signature in (self.signature, *self.also)]
        return {
            each.name: tuple(
                one.arg for one in (*each.args.posonlyargs, *each.args.args, *each.args.kwonlyargs)
            )
            for each in found
        }

    def judged(self, part: Part) -> str:
        """Return the name of the function that a part is on."""
        return part.function or self.name

    @property
    def needed(self) -> int:
        """How many parameters have no default value."""
        arguments = _function(self.signature).args
        given = len(arguments.posonlyargs) + len(arguments.args) - len(arguments.defaults)
        return given + sum(each is None for each in arguments.kw_defaults)

    def worth(self, part: Part) -> float:
        """Return how many of the points a part is worth."""
        return self.points * part.weight / sum(each.weight for each in self.parts)


def _function(signature: str) -> ast.FunctionDef:
    try:
        (found,) = ast.parse(f"def {signature}: pass").body
    except (SyntaxError, ValueError):
        raise ParameterError("signature", signature, "as in 'solid_angle(half_angle)'") from None
    assert isinstance(found, ast.FunctionDef)
    return found
