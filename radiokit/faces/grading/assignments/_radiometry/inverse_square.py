"""Inverse square: the irradiance from the flux of an isotropic source."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    COUNT,
    FloatArray,
    far_and_near,
    put_together,
)

__all__ = ["QUESTION"]


def _isotropic(flux: FloatArray, distance: FloatArray) -> FloatArray:
    result: FloatArray = flux / (4 * math.pi) / distance / distance  # the square may overflow
    return result


def _bulbs(rng: np.random.Generator) -> dict[str, Any]:
    return {"flux": rng.uniform(1, 1000, COUNT), "distance": rng.uniform(0.2, 5, COUNT)}


QUESTION = put_together(
    "isotropic_irradiance(flux, distance)",
    title={"en": "Inverse square law", "ru": "Закон обратных квадратов"},
    text={
        "en": r"""
A point source radiates the flux $\Phi$ evenly in all directions. Return the irradiance [W/m²] of a surface
that faces it at the distance $d$.

- `flux`: $\Phi$ [W];
- `distance`: $d > 0$ [m].

Numbers or arrays of equal length. **Hard inputs:** $d$ from $10^{-170}$ to $10^{170}$, where $d^2$ is too
small or too large for float64 and the irradiance is not; a relative error of $10^{-9}$ is asked for there
too.
""",
        "ru": r"""
Точечный источник излучает поток $\Phi$ одинаково во все стороны. Найдите освещённость [Вт/м²] поверхности,
повёрнутой к нему и удалённой на расстояние $d$.

- `flux`: $\Phi$ [Вт];
- `distance`: $d > 0$ [м].

Числа или массивы равной длины. **Трудные входы:** $d$ от $10^{-170}$ до $10^{170}$, где $d^2$ не умещается
во float64, а освещённость умещается; относительная ошибка и там не должна превышать $10^{-9}$.
""",
    },
    reference=_isotropic,
    ordinary=_bulbs,
    hard=far_and_near,
    variants={
        "parentheses-forgotten": lambda flux, distance: flux / 4 * math.pi * distance**2,
        "multiplied": lambda flux, distance: flux * 4 * math.pi * distance**2,
        "centimetres": lambda flux, distance: 1e-4 * _isotropic(flux, distance),
        "volume-for-area": lambda flux, distance: flux / (4 / 3 * math.pi * distance**3),
    },
    credit={"four-pi-too-many": 0.25, "doubled": 0.25, "four-too-many": 0.25},
    hints={
        "pi-too-many": {
            "en": "You forgot π: the flux is spread over the sphere's area, 4πd²",
            "ru": "Вы забыли π: поток проходит через всю сферу площадью 4πd²",
        },
        "parentheses-forgotten": {
            "en": "You multiplied by π d²: x / 4 * π * d² does so, and x / (4 * π * d²) does not",
            "ru": "Вы умножили на π d²: так делает x / 4 * π * d², а нужно x / (4 * π * d²)",
        },
        "multiplied": {
            "en": "You multiplied by the sphere's area: the flux is divided by it",
            "ru": "Вы умножили на площадь сферы: поток на неё делят",
        },
        "centimetres": {
            "en": "Your answer is 10⁴ times too small: the distance is in metres already, as W/m² need it",
            "ru": "Ответ в 10⁴ раз меньше: расстояние уже в метрах, и ответ нужен в Вт/м²",
        },
        "volume-for-area": {
            "en": "You divided by the volume of the sphere: the flux passes through its area, 4πd²",
            "ru": "Вы разделили на объём шара: поток проходит через площадь сферы, 4πd²",
        },
        "four-pi-too-many": {
            "en": "You forgot the 4π: the flux is spread over the sphere's area, 4πd²",
            "ru": "Вы забыли 4π: поток распределён по площади сферы, 4πd²",
        },
        "doubled": {
            "en": "2πd² is the area of half a sphere: the source shines in all directions, over 4πd²",
            "ru": "2πd² — площадь половины сферы: источник светит во все стороны, на 4πd²",
        },
        "four-too-many": {
            "en": "πd² is the area of a disk: the flux is spread over the sphere, 4πd²",
            "ru": "πd² — площадь круга: поток распределён по сфере, 4πd²",
        },
        "square-centimetres": {
            "en": "Your answer is 10⁴ times too large: the distance is in metres, and W/m² are asked for",
            "ru": "Ответ в 10⁴ раз больше: расстояние дано в метрах, и ответ нужен в Вт/м²",
        },
        "out-of-range": {
            "en": "divide by d twice",
            "ru": "разделите на d дважды",
        },
    },
)
