"""Misconception: a name, a sentence for the student in each language, and what it does to the numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from radiokit.faces.diagnosis.problem import Array, Problem
from radiokit.facts.errors import ParameterError

__all__ = ["LANGUAGES", "Guess", "Misconception", "constant", "structural", "varying"]

LANGUAGES = ("en", "ru")


@dataclass(frozen=True)
class Guess:
    """The numbers that a misconception would give, and the factor by which it changes the right ones.

    ``factor`` is None where the change is not a factor. ``detail`` says which of several ways it is.
    """

    values: Array
    factor: Array | None = None
    detail: str = ""


@dataclass(frozen=True)
class Misconception:
    """One entry of the catalogue.

    Parameters
    ----------
    name : str
        By which a program knows it.
    en, ru : str
        One sentence for the student.
    explain : callable
        From a `Problem` to the numbers that the misconception would have given there, in each way it could;
        none where it does not apply.
    kind : str
        ``"constant"`` and ``"varying"`` are factors; ``"structural"`` is anything else.
    needs : tuple of str
        Which inputs must vary to tell it from others.
    prior : float
        How far it is believed where others explain the numbers as well, in (0, 1].
    slack : float
        A relative deviation that the misconception itself leaves open.
    pairs : bool
        Whether it may be one of two at once: two factors, or a factor and what does not look at the answer.
    seen : bool
        Whether it is seen, not inferred: then it has no rivals, and right numbers do not excuse it.

    Examples
    --------
    >>> halved = constant("halved", 0.5, "You halved it.", "Вы взяли половину.")
    >>> halved.kind, halved.hint("ru")
    ('constant', 'Вы взяли половину.')
    """

    name: str
    en: str
    ru: str
    explain: Callable[[Problem], Iterable[Guess]]
    kind: Literal["constant", "varying", "structural"] = "structural"
    needs: tuple[str, ...] = ()
    prior: float = 1.0
    slack: float = 0.0
    pairs: bool = False
    seen: bool = False

    def hint(self, language: str) -> str:
        """Return the sentence for the student in ``"en"`` or ``"ru"``."""
        if language not in LANGUAGES:
            raise ParameterError("language", language, " or ".join(map(repr, LANGUAGES)))
        return self.en if language == "en" else self.ru


def constant(
    name: str, factor: float, en: str, ru: str, *, prior: float = 1.0, pairs: bool = False
) -> Misconception:
    """Return the misconception whose answer is ``factor`` times the right one."""

    def explain(problem: Problem) -> Iterable[Guess]:
        yield Guess(factor * problem.reference, np.full_like(problem.reference, factor))

    return Misconception(name, en, ru, explain, "constant", prior=prior, pairs=pairs)


def varying(
    name: str,
    factor: Callable[..., Array | Mapping[str, Array]],
    en: str,
    ru: str,
    *,
    needs: tuple[str, ...],
    prior: float = 1.0,
    pairs: bool = True,
) -> Misconception:
    """Return the misconception whose factor follows from inputs: ``factor(*arrays named by needs)``.

    Several factors are told apart by the keys of a mapping, which become the detail of the message.
    """

    def explain(problem: Problem) -> Iterable[Guess]:
        if not all(need in problem.inputs for need in needs):
            return
        with np.errstate(all="ignore"):
            found: Any = factor(*(problem.inputs[need] for need in needs))
        for detail, values in (found if isinstance(found, Mapping) else {"": found}).items():
            with np.errstate(all="ignore"):
                changed = np.where(problem.reference == 0, 0.0, values * problem.reference)
            yield Guess(changed, np.where(problem.reference == 0, 1.0, values), detail)

    return Misconception(name, en, ru, explain, "varying", needs, prior, pairs=pairs)


def structural(
    name: str,
    explain: Callable[[Problem], Iterable[Guess]],
    en: str,
    ru: str,
    *,
    needs: tuple[str, ...] = (),
    prior: float = 1.0,
    slack: float = 0.0,
    pairs: bool = False,
    seen: bool = False,
) -> Misconception:
    """Return a misconception that is no factor."""
    return Misconception(name, en, ru, explain, "structural", needs, prior, slack, pairs, seen)
