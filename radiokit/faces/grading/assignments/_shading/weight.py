"""Weight: the question on the balance heuristic, and what wrong weights give."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part, Question

__all__ = ["MIS_WEIGHT"]


def _strategies(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "distance": rng.uniform(0.5, 5, 32),
        "cosine_light": rng.uniform(0.05, 1, 32),
        "area": rng.uniform(0.1, 4, 32),
        "pdf": rng.uniform(0.05, 8, 32),
    }


def _extreme_strategies(rng: np.random.Generator) -> dict[str, Any]:
    given = _strategies(rng)
    given["cosine_light"][:4] = 0.0
    given["pdf"][4:8] = 0.0
    given["area"][8:16] = 10 ** rng.uniform(-12, -6, 8)
    given["pdf"][16:24] = 10 ** rng.uniform(6, 12, 8)
    return given


def _balance(distance: Any, cosine_light: Any, area: Any, pdf: Any) -> Any:
    return distance**2 / (distance**2 + area * cosine_light * pdf)


def _weight_of(light: Callable[[Any, Any, Any], Any], power: float = 1.0) -> Callable[..., Any]:
    def weight(distance: Any, cosine_light: Any, area: Any, pdf: Any) -> Any:
        p = light(distance, np.maximum(cosine_light, 1e-300), area)
        with np.errstate(all="ignore"):
            return 1 / (1 + (pdf / p) ** power)

    return weight


_SLIPS_OF_WEIGHT: Mapping[str, Callable[..., Any]] = {
    "pdf-of-area": _weight_of(lambda d, c, a: 1 / a),
    "light-cosine-forgotten": _weight_of(lambda d, c, a: d**2 / a),
    "cosine-multiplied": _weight_of(lambda d, c, a: d**2 * c / a),
    "distance-not-squared": _weight_of(lambda d, c, a: d / (c * a)),
    "geometry-upside-down": _weight_of(lambda d, c, a: c / (d**2 * a)),
    "area-multiplied": _weight_of(lambda d, c, a: d**2 * a / c),
    "power-heuristic": _weight_of(lambda d, c, a: d**2 / (c * a), 2.0),
}

MIS_WEIGHT = Question(
    signature="mis_weight(distance, cosine_light, area, pdf)",
    points=1,
    title={"en": "The balance heuristic", "ru": "Балансная эвристика"},
    text={
        "en": "A direction was found by sampling a light uniformly over its `area` $A$: the point is at the "
        "`distance` $d$, the cosine at the light is `cosine_light` $= \\cos\\theta'$. Sampling the BRDF "
        "would have given it with the density `pdf` per solid angle. One sample is taken of each. Return "
        "the weight of the balance heuristic for the light's sample,\n\n"
        "$$w = \\frac{p_\\text{light}}{p_\\text{light} + p_\\text{BRDF}},$$\n\n"
        "with both densities per solid angle. All inputs are arrays of shape $(N,)$; $\\cos\\theta' = 0$ "
        "and $p_\\text{BRDF} = 0$ occur, and the weight is then 1.",
        "ru": "Направление получено равномерной выборкой источника по его площади `area` $= A$: точка "
        "находится на расстоянии `distance` $= d$, косинус у источника — `cosine_light` $= \\cos\\theta'$. "
        "Выборка по ДФО дала бы это направление с плотностью `pdf` по телесному углу. Берётся по одному "
        "отсчёту каждым способом. Верните вес балансной эвристики для отсчёта, взятого по источнику:\n\n"
        "$$w = \\frac{p_\\text{ист}}{p_\\text{ист} + p_\\text{ДФО}},$$\n\n"
        "где обе плотности — по телесному углу. Все входы — массивы формы $(N,)$; встречаются "
        "$\\cos\\theta' = 0$ и $p_\\text{ДФО} = 0$, тогда вес равен 1.",
    },
    parts=(
        Part(
            name="ordinary",
            judge=Values(inputs=_strategies, reference=_balance, rtol=1e-5, variants=_SLIPS_OF_WEIGHT),
        ),
        Part(
            name="hard",
            judge=Values(
                inputs=_extreme_strategies, reference=_balance, rtol=1e-5, variants=_SLIPS_OF_WEIGHT
            ),
        ),
    ),
    hints={
        **{
            name: {
                "en": "The distance has a wrong power somewhere: p_ω = p_A d²/cos θ', with the same d² above "
                "and below.",
                "ru": "Где-то не та степень расстояния: p_ω = p_A d²/cos θ', и в числителе, и в знаменателе "
                "одно и то же d².",
            }
            for name in (
                "distance-cubed",
                "distance-doubled",
                "distance-forgotten",
                "distance-not-squared",
                "distance-squared-twice",
            )
        },
        "geometry-upside-down": {
            "en": "p = p_A d²/cos θ': you multiplied by cos θ'/d², which takes a solid angle to an area.",
            "ru": "p = p_A d²/cos θ': вы умножили на cos θ'/d², а это пересчёт в обратную сторону.",
        },
        "area-multiplied": {
            "en": "p_A = 1/A: divide by the area, do not multiply.",
            "ru": "p_A = 1/A: на площадь нужно делить, а не умножать.",
        },
        "cosine-multiplied": {
            "en": "p = p_A d²/cos θ': divide by the cosine at the light, do not multiply.",
            "ru": "p = p_A d²/cos θ': на косинус у источника нужно делить, а не умножать.",
        },
        "power-heuristic": {
            "en": "This is the power heuristic, with squares; the balance heuristic has none.",
            "ru": "Это степенная эвристика, с квадратами; в балансной их нет.",
        },
        "one-minus": {
            "en": "This is the weight of the BRDF's sample, 1 − w; that of the light's is asked for.",
            "ru": "Это вес отсчёта по ДФО, 1 − w; а нужен вес отсчёта по источнику.",
        },
    },
)
