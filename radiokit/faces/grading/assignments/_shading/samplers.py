"""Questions of assignment 3 on directions that follow a density: cosine-weighted, and Phong's lobe."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.faces.grading.judges.sampler import Sampler
from radiokit.faces.grading.question import Part, Question

__all__ = ["COSINE_SAMPLE", "LOBE_SAMPLE"]

SECONDS = 20.0


# Cosine-weighted directions


def _cosine_density(directions: Any) -> Any:
    return np.maximum(directions[:, 2], 0.0) / np.pi


def _disk_without_root(directions: Any) -> Any:
    radius = np.hypot(directions[:, 0], directions[:, 1])
    return np.maximum(directions[:, 2], 0.0) / (2 * np.pi * np.maximum(radius, 1e-12))


def _uniform_angle(directions: Any) -> Any:
    radius = np.hypot(directions[:, 0], directions[:, 1])
    return (directions[:, 2] > 0) / (np.pi**2 * np.maximum(radius, 1e-12))


_SEEDLESS = {
    "en": "`u` is an array of shape $(N, 2)$ of random numbers in $[0, 1)$: draw none yourself. Rows go "
    "their own way: direction $i$ follows from `u[i]` alone.",
    "ru": "`u` — массив формы $(N, 2)$ случайных чисел из $[0, 1)$; сами случайных чисел не берите. "
    "Направление $i$ определяется только строкой `u[i]`.",
}

COSINE_SAMPLE = Question(
    signature="cosine_sample(u)",
    also=("cosine_pdf(directions)",),
    points=2,
    title={"en": "Cosine-weighted directions", "ru": "Направления с плотностью cos θ/π"},
    text={
        "en": "Write two functions: `cosine_sample(u)` returns unit vectors, shape $(N, "
        "3)$, of the density $p(\\omega) = \\cos\\theta/\\pi$ about the normal $z$; "
        "`cosine_pdf(directions)` returns this density, shape $(N,)$, and 0 below the "
        "horizon. " + _SEEDLESS["en"],
        "ru": "Напишите две функции: `cosine_sample(u)` возвращает единичные векторы, "
        "форма $(N, 3)$, с плотностью $p(\\omega) = \\cos\\theta/\\pi$ относительно "
        "нормали $z$; `cosine_pdf(directions)` возвращает эту плотность, форма $(N,)$, а "
        "под горизонтом — 0. " + _SEEDLESS["ru"],
    },
    parts=(
        Part(
            name="distribution",
            weight=3,
            judge=Sampler(
                density=_cosine_density,
                pdf="cosine_pdf",
                variants={"root-forgotten": _disk_without_root, "angle-uniform": _uniform_angle},
            ),
        ),
        Part(
            name="normalisation",
            function="cosine_pdf",
            judge=Sampler(density=_cosine_density, pdf="cosine_pdf", aspect="density"),
        ),
    ),
    hints={
        "angle-uniform": {
            "en": "Your θ is uniform in [0, π/2]; solid angle is sin θ dθ dφ, and the cosine comes on top.",
            "ru": "У вас θ равномерно распределён на [0, π/2]; но телесный угол — это sin θ dθ dφ, и ещё "
            "нужен косинус.",
        },
    },
    seconds=SECONDS,
)


# Phong's lobe


def _exponents(rng: np.random.Generator) -> dict[str, Any]:
    return {"exponent": rng.uniform(5, 80)}


def _lobe_of(shift: float, over: float) -> Callable[..., Any]:
    """Return the density (n + over)/(2π) cosⁿ⁺ˢʰⁱᶠ θ."""

    def density(directions: Any, exponent: Any) -> Any:
        cosine = np.maximum(directions[:, 2], 0.0)
        return (exponent + over) / (2 * np.pi) * cosine ** (exponent + shift)

    return density


LOBE_SAMPLE = Question(
    signature="lobe_sample(u, exponent)",
    also=("lobe_pdf(directions, exponent)",),
    points=2.5,
    title={"en": "Phong's lobe", "ru": "Лепесток Фонга"},
    text={
        "en": "Write `lobe_sample(u, exponent)`, which returns unit vectors, shape $(N, "
        "3)$, whose density is proportional to $\\cos^n\\theta$ about $z$, with $n$ = "
        "`exponent`, above the horizon; and `lobe_pdf(directions, exponent)`, which "
        "returns this density per solid angle, shape $(N,)$, normalised so that its "
        "integral over the hemisphere is 1, and 0 below the horizon. " + _SEEDLESS["en"],
        "ru": "Напишите `lobe_sample(u, exponent)`, возвращающую единичные векторы, форма "
        "$(N, 3)$, с плотностью, пропорциональной $\\cos^n\\theta$ относительно $z$, где "
        "$n$ = `exponent`, только над горизонтом; и `lobe_pdf(directions, exponent)`, "
        "возвращающую эту плотность по телесному углу, форма $(N,)$, нормированную так, "
        "что её интеграл по полусфере равен 1, а под горизонтом — 0. " + _SEEDLESS["ru"],
    },
    parts=(
        Part(
            name="distribution",
            weight=3,
            judge=Sampler(
                density=_lobe_of(0, 1),
                inputs=_exponents,
                pdf="lobe_pdf",
                variants={"exponent-without-sine": _lobe_of(-1, 0), "exponent-with-cosine": _lobe_of(1, 2)},
            ),
        ),
        Part(
            name="normalisation",
            function="lobe_pdf",
            weight=2,
            judge=Sampler(
                density=_lobe_of(0, 1),
                inputs=_exponents,
                pdf="lobe_pdf",
                aspect="density",
                variants={"lobe-normalisation": _lobe_of(0, 2)},
            ),
        ),
    ),
    hints={
        "exponent-without-sine": {
            "en": "With cos θ = u^(1/n) you get cosⁿ⁻¹θ: solid angle is d(cos θ) dφ, so that the root is the "
            "(n+1)-th.",
            "ru": "При cos θ = u^(1/n) получается cosⁿ⁻¹θ: телесный угол — это d(cos θ) dφ, поэтому нужен "
            "корень степени n + 1.",
        },
        "exponent-with-cosine": {
            "en": "Your directions follow cosⁿ⁺¹θ, the lobe times a cosine: cosⁿθ alone is asked for.",
            "ru": "Ваши направления распределены как cosⁿ⁺¹θ, то есть лепесток, умноженный на косинус: "
            "нужен один cosⁿθ.",
        },
        "lobe-normalisation": {
            "en": "(n+2)/2π normalises Phong's BRDF, where a cosine is under the integral; a density has "
            "(n+1)/2π.",
            "ru": "(n+2)/2π нормирует ДФО Фонга, где под интегралом ещё косинус; у плотности множитель "
            "(n+1)/2π.",
        },
    },
    seconds=SECONDS,
)
