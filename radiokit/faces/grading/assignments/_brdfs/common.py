"""Common: what the questions of assignment 2 share: their parts, conventions and draws of parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._brdfs import functions as brdf
from radiokit.faces.grading.judges.laws import Laws
from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part
from radiokit.faces.grading.words import Words

__all__ = ["SECONDS", "exponents", "parts", "shares", "text", "values"]

Array = Any
Generator = np.random.Generator
Function = Callable[..., Array]
Draw = Callable[[Generator, int], Array]

SECONDS = 60.0
"""For all calls of one question [s]: functions of single pairs take a few seconds before the laws."""

LAWS: Words = {"en": "the laws of a BRDF", "ru": "законы ДФО"}

LOOSE = {1e-6: 0.8, 1e-3: 0.5}
"""What a value of fewer digits still earns, as float32 gives."""

FAINT = 1e-9
"""Below which value [sr⁻¹] a lobe's tail need not be right."""


def exponents(most: int) -> Draw:
    """Return what draws whole exponents from 1 to ``most``, as many small ones as large ones."""
    return lambda rng, count: np.floor(np.exp(rng.uniform(0, np.log(most + 1), count)))


def shares(rng: Generator, count: int) -> Array:
    """Return shares of the light in (0, 1)."""
    return rng.uniform(0.05, 0.95, count)


def values(
    inputs: Callable[[Generator], Mapping[str, Any]], reference: Function, variants: Mapping[str, Function]
) -> Values:
    """Return the judge of a question's numbers."""
    return Values(inputs=inputs, reference=reference, variants=variants, loose=LOOSE, atol=FAINT)


def parts(
    reference: Function, variants: Mapping[str, Function], laws: Laws | None = None, **parameters: Draw
) -> tuple[Part, ...]:
    """Return a question's parts: values that the student sees, and hard ones and laws that he does not."""
    ordinary = values(brdf.ordinary_pairs(**parameters), reference, variants)
    hard = values(brdf.hard_pairs(**parameters), reference, variants)
    found: tuple[Part, ...] = (
        Part(name="ordinary", judge=ordinary, weight=2),
        Part(name="hard", judge=hard, visibility="after_published"),
    )
    return (
        found
        if laws is None
        else (*found, Part(name="laws", judge=laws, visibility="after_published", title=LAWS))
    )


CONVENTIONS: Words = {
    "en": "`wi` points to the light and `wo` to the viewer. Both are unit vectors, arrays of shape `(3,)` "
    "or `(N, 3)`; $z$ is the normal. A parameter is one number, or one number for each pair. Return one "
    r"number for each pair of directions, in $\mathrm{sr}^{-1}$ and without the cosine of the lighting "
    r"integral. A surface reflects only above the horizon: where $\cos\theta_i \le 0$ or $\cos\theta_o \le "
    "0$, the value is 0.",
    "ru": "`wi` направлен на источник света, `wo` — на наблюдателя. Оба — единичные векторы, массивы формы "
    "`(3,)` или `(N, 3)`; ось $z$ — нормаль. Параметр — одно число или по числу на каждую пару. Верните по "
    r"одному числу на каждую пару направлений, в $\mathrm{ср}^{-1}$ и без косинуса из интеграла освещения. "
    r"Поверхность отражает только над горизонтом: если $\cos\theta_i \le 0$ или $\cos\theta_o \le 0$, "
    "значение равно 0.",
}


def text(english: str, russian: str) -> Words:
    """Return a question's text with the conventions after it."""
    return {"en": f"{english}\n\n{CONVENTIONS['en']}", "ru": f"{russian}\n\n{CONVENTIONS['ru']}"}
