"""Common: how each question of assignment 1 is put together, and the random inputs that several share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.words import Words

__all__ = [
    "CLAMP",
    "COUNT",
    "FloatArray",
    "Inputs",
    "directions",
    "far_and_near",
    "powers",
    "put_together",
    "turned",
]

FloatArray = npt.NDArray[np.float64]
Inputs = Callable[[np.random.Generator], Mapping[str, Any]]

COUNT = 40
"""Of how many inputs most parts consist."""
ORDINARY, ROUGH = 1e-5, 1e-3
"""The relative error of ordinary answers: float32 passes, and 3.14 for π earns half."""

CLAMP: Words = {
    "en": "The light is behind the surface there, and the irradiance is 0: take max(0, cos θ)",
    "ru": "Там источник позади поверхности, и освещённость равна 0: возьмите max(0, cos θ)",
}
"""What is said where light from behind a surface is counted."""


def put_together(
    signature: str,
    *,
    title: Words,
    text: Words,
    reference: Callable[..., Any],
    ordinary: Inputs,
    hard: Inputs,
    precision: float = 1e-9,
    context: Callable[..., Mapping[str, Any]] | None = None,
    variants: Mapping[str, Callable[..., Any]],
    hints: Mapping[str, Words],
    terms: Callable[..., Any] | None = None,
    credit: Mapping[str, float] | None = None,
) -> Question:
    """Return a question of two points: 1.5 for ordinary inputs, 0.5 for hard ones, which are hidden.

    ``precision`` is the relative error on hard inputs; one of 1e-5 still earns half. ``credit`` is for
    ordinary inputs alone. The rest is as in `Values` and `Question`.
    """
    judge = Values(
        inputs=ordinary,
        reference=reference,
        rtol=ORDINARY,
        loose={ROUGH: 0.5},
        credit=credit or {},
        context=context,
        variants=variants,
        terms=terms,
    )
    strict = replace(judge, inputs=hard, rtol=precision, loose={ORDINARY: 0.5}, credit={})
    return Question(
        signature=signature,
        points=2,
        title=title,
        text=text,
        hints=hints,
        parts=(
            Part(name="ordinary", judge=judge, weight=3),
            Part(name="hard", judge=strict, weight=1, visibility="after_published"),
        ),
    )


def powers(rng: np.random.Generator, low: float, high: float, count: int) -> FloatArray:
    """Return numbers whose decimal logarithms are even between two exponents."""
    result: FloatArray = 10.0 ** rng.uniform(low, high, count)
    return result


def directions(rng: np.random.Generator, count: int) -> FloatArray:
    """Return unit vectors (count, 3), evenly over the sphere."""
    z, phi = rng.uniform(-1, 1, count), rng.uniform(0, 2 * np.pi, count)
    r = np.sqrt((1 - z) * (1 + z))
    return np.stack((r * np.cos(phi), r * np.sin(phi), z), axis=-1)


def turned(rng: np.random.Generator, axis: FloatArray, theta: FloatArray) -> FloatArray:
    """Return unit vectors (N, 3) at angles (N,) [rad] from the axes (N, 3), to any side."""
    aside = np.cross(axis, directions(rng, len(axis)))
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    result: FloatArray = np.cos(theta)[:, None] * axis + np.sin(theta)[:, None] * aside
    return result


def far_and_near(rng: np.random.Generator) -> dict[str, Any]:
    """Return fluxes and distances: a quarter is huge, a quarter tiny, and half usual."""
    kind = rng.permutation(np.arange(COUNT) % 4)
    distance = np.select(
        [kind == 0, kind == 1],
        [powers(rng, 158, 170, COUNT), powers(rng, -170, -163, COUNT)],
        powers(rng, -3, 3, COUNT),
    )
    flux = np.select(
        [kind == 0, kind == 1],
        [powers(rng, 200, 300, COUNT), powers(rng, -250, -200, COUNT)],
        powers(rng, 0, 3, COUNT),
    )
    return {"flux": flux, "distance": distance}
