"""Light: both laws with vectors of any length."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    CLAMP,
    COUNT,
    FloatArray,
    directions,
    far_and_near,
    powers,
    put_together,
    turned,
)
from radiokit.facts.directions import dot, unit

__all__ = ["QUESTION"]


def _light(position: FloatArray, normal: FloatArray, light: FloatArray, intensity: FloatArray) -> FloatArray:
    way = light - position
    distance = np.hypot(np.hypot(way[..., 0], way[..., 1]), way[..., 2])
    cosine = np.maximum(0.0, dot(unit(way), unit(normal)))
    result: FloatArray = intensity / distance / distance * cosine
    return result


def _placed(
    rng: np.random.Generator, distance: FloatArray, reach: FloatArray, length: FloatArray
) -> dict[str, Any]:
    """Return receivers of which a quarter turns away from its light, and none is near the horizon."""
    count = len(distance)
    theta = rng.uniform(0.1, 1.4, count)
    way, position = directions(rng, count), reach[:, None] * rng.uniform(-1, 1, (count, 3))
    light = position + distance[:, None] * way
    theta = np.where(rng.permutation(count) % 4 == 0, math.pi - theta, theta)
    normal = turned(rng, unit(light - position), theta)
    return {"position": position, "normal": length[:, None] * normal, "light": light}


def _lights(rng: np.random.Generator) -> dict[str, Any]:
    given = _placed(rng, rng.uniform(0.5, 4, COUNT), np.full(COUNT, 2.0), rng.uniform(0.5, 2, COUNT))
    return {**given, "intensity": rng.uniform(1, 100, COUNT)}


def _far_and_near_lights(rng: np.random.Generator) -> dict[str, Any]:
    drawn = far_and_near(rng)
    usual = np.abs(np.log10(drawn["distance"])) < 100
    length = np.where(usual, powers(rng, -1, 1, COUNT), powers(rng, -200, 200, COUNT))
    given = _placed(rng, drawn["distance"], drawn["distance"], length)
    return {**given, "intensity": drawn["flux"]}


def _context(
    position: FloatArray, normal: FloatArray, light: FloatArray, intensity: FloatArray
) -> dict[str, FloatArray]:
    way = light - position
    distance = np.hypot(np.hypot(way[:, 0], way[:, 1]), way[:, 2])
    return {"distance": distance, "cosine": dot(unit(way), unit(normal))}


QUESTION = put_together(
    "light_irradiance(position, normal, light, intensity)",
    title={
        "en": "Irradiance from a point light, in vectors",
        "ru": "Освещённость от точечного источника: векторы",
    },
    text={
        "en": r"""
Return the irradiance [W/m²] at a point of a surface, from a point light that shines alike in all directions:
the cosine law and the inverse square law, with $\cos\theta$ from the dot product of the unit normal and the
unit vector **from the surface to the light**; 0 if the light is behind the surface.

- `position`: of the point [m], array `(N, 3)`;
- `normal`: of the surface, `(N, 3)`, of **any length** above 0;
- `light`: the position of the light [m], `(N, 3)`;
- `intensity`: $I$ [W/sr], `(N,)`.

The answer has shape `(N,)`. **Hard inputs:** coordinates from $10^{-170}$ to $10^{170}$ m, normals from
$10^{-200}$ to $10^{200}$ long, whose squares are out of range: scale vectors by their largest component
first. The relative error is to be $10^{-9}$.
""",
        "ru": r"""
Найдите освещённость [Вт/м²] в точке поверхности от точечного источника, светящего одинаково во все стороны:
закон косинусов и закон обратных квадратов, где $\cos\theta$ — скалярное произведение единичной нормали и
единичного вектора **от поверхности к источнику**; если источник позади поверхности, ответ 0.

- `position`: координаты точки [м], массив `(N, 3)`;
- `normal`: нормаль к поверхности, `(N, 3)`, **любой длины**, кроме 0;
- `light`: координаты источника [м], `(N, 3)`;
- `intensity`: $I$ [Вт/ср], `(N,)`.

Ответ имеет форму `(N,)`. **Трудные входы:** координаты от $10^{-170}$ до $10^{170}$ м, нормали длиной от
$10^{-200}$ до $10^{200}$: их квадраты не умещаются во float64, поэтому сначала разделите вектор на
наибольшую компоненту. Относительная ошибка не должна превышать $10^{-9}$.
""",
    },
    reference=_light,
    ordinary=_lights,
    hard=_far_and_near_lights,
    context=_context,
    variants={
        "normal-not-normalised": lambda position, normal, light, intensity: (
            _light(position, normal, light, intensity) * np.linalg.norm(normal, axis=-1)
        ),
        "position-for-direction": lambda position, normal, light, intensity: _light(
            0 * position, normal, light, intensity
        ),
    },
    credit={"horizon-not-clamped": 0.5, "arguments-swapped": 0.25, "normal-not-normalised": 0.5},
    hints={
        "cosine-twice": {
            "en": "The cosine enters once: the area that a beam falls on is 1/cos θ as large",
            "ru": "Косинус входит один раз: пучок ложится на площадь в 1/cos θ раз большую",
        },
        "horizon-not-clamped": CLAMP,
        "normal-not-normalised": {
            "en": "The normal may be of any length: divide it by its length first",
            "ru": "Нормаль бывает любой длины: сначала разделите её на длину",
        },
        "position-for-direction": {
            "en": "You took the position of the light for the vector to it: that is light − position",
            "ru": "Вы приняли координаты источника за вектор на него: этот вектор равен light − position",
        },
        "arguments-swapped": {
            "en": "Two vectors are exchanged: the vector to the light is light − position",
            "ru": "Два вектора переставлены: вектор на источник равен light − position",
        },
        "distance-not-squared": {
            "en": "One power of the distance is missing: is the vector to the light divided by its length?",
            "ru": "Не хватает степени расстояния: разделён ли вектор на источник на свою длину?",
        },
        "out-of-range": {
            "en": "divide a vector by its largest component before you take its length; divide by d twice",
            "ru": "разделите вектор на наибольшую компоненту, прежде чем искать длину; делите на d дважды",
        },
    },
)
