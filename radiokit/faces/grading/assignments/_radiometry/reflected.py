"""Reflected: the lecture's discrete sum over lights, on a Lambertian surface."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    COUNT,
    FloatArray,
    powers,
    put_together,
)

__all__ = ["QUESTION"]


def _reflected(
    albedo: FloatArray, radiance: FloatArray, cosine: FloatArray, solid_angle: FloatArray
) -> FloatArray:
    terms = radiance * np.maximum(0.0, cosine) * solid_angle
    return np.array([a / math.pi * math.fsum(row) for a, row in zip(albedo, terms.tolist(), strict=True)])


def _some_lights(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "albedo": rng.uniform(0.05, 0.95, COUNT),
        "radiance": rng.uniform(1, 100, (COUNT, 6)),
        "cosine": np.where(
            rng.random((COUNT, 6)) < 0.25,
            rng.uniform(-1, -0.05, (COUNT, 6)),
            rng.uniform(0.05, 1, (COUNT, 6)),
        ),
        "solid_angle": powers(rng, -3, -1, COUNT * 6).reshape(COUNT, 6),
    }


def _many_lights(rng: np.random.Generator) -> dict[str, Any]:
    """Return a sun among stars, so faint that each is lost when it is added to the sun, and a lamp below."""
    shape = (6, 4096)
    sun = np.arange(shape[1]) == rng.integers(0, 32, (shape[0], 1))
    lamp = np.arange(shape[1]) == rng.integers(32, 64, (shape[0], 1))
    return {
        "albedo": rng.uniform(0.05, 0.95, shape[0]),
        "radiance": np.select([sun, lamp], [2e7, 1e5], rng.uniform(5e-11, 1e-10, shape)),
        "cosine": np.select([sun, lamp], [0.8, -0.5], rng.uniform(-0.5, 1, shape)),
        "solid_angle": np.where(sun, 6.8e-5, 1e-3),
    }


QUESTION = put_together(
    "reflected_radiance(albedo, radiance, cosine, solid_angle)",
    title={"en": "Reflected radiance as a sum", "ru": "Яркость отражённого света: сумма"},
    text={
        "en": r"""
$K$ small lights shine on a Lambertian surface, whose BRDF is $f = \rho/\pi$. Return the radiance of the
reflected light [W/(m² sr)], the lecture's discrete sum with the solid angles written out,
$$L_o = \sum_{j=1}^{K} f \, L_j \cos\theta_j \, \Delta\omega_j ,$$
where lights below the horizon, $\cos\theta_j < 0$, give nothing.

- `albedo`: $\rho$, from 0 to 1, array `(N,)`;
- `radiance`: $L_j$ [W/(m² sr)], array `(N, K)`;
- `cosine`: $\cos\theta_j$, `(N, K)`;
- `solid_angle`: $\Delta\omega_j$ [sr], `(N, K)`.

The answer has shape `(N,)`; a function of one row, a number and `(K,)` arrays, counts as well. **Hard
inputs:** 4096 lights, one of which is a sun and the others are stars, each lost when it is added to the sun
alone: use `numpy.sum` along the last axis or `math.fsum`; the relative error is to be $3\cdot10^{-14}$.
""",
        "ru": r"""
На ламбертову поверхность с ДФО $f = \rho/\pi$ светят $K$ малых источников. Найдите яркость отражённого света
[Вт/(м² ср)] — дискретную сумму из лекции, где телесные углы выписаны явно:
$$L_o = \sum_{j=1}^{K} f \, L_j \cos\theta_j \, \Delta\omega_j ;$$
источники под горизонтом, $\cos\theta_j < 0$, вклада не дают.

- `albedo`: альбедо $\rho$, от 0 до 1, массив `(N,)`;
- `radiance`: яркости $L_j$ [Вт/(м² ср)], массив `(N, K)`;
- `cosine`: $\cos\theta_j$, `(N, K)`;
- `solid_angle`: $\Delta\omega_j$ [ср], `(N, K)`.

Ответ имеет форму `(N,)`; годится и функция одной строки, то есть числа и массивов `(K,)`. **Трудные
входы:** 4096 источников, один из которых — солнце, а остальные — звёзды, и каждая пропадает, если прибавить
её к солнцу: возьмите `numpy.sum` по последней оси или `math.fsum`; относительная ошибка не должна превышать
$3\cdot10^{-14}$.
""",
    },
    reference=_reflected,
    ordinary=_some_lights,
    hard=_many_lights,
    precision=3e-14,
    variants={
        "solid-angle-forgotten": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance, cosine, 0 * solid_angle + 1
        ),
        "cosine-forgotten": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance, 0 * cosine + 1, solid_angle
        ),
        "cosine-twice": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance, np.maximum(0, cosine) ** 2, solid_angle
        ),
        "horizon-not-clamped": lambda albedo, radiance, cosine, solid_angle: (
            _reflected(albedo, radiance, cosine, solid_angle)
            - _reflected(albedo, radiance, -cosine, solid_angle)
        ),
        "absolute-value": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance, np.abs(cosine), solid_angle
        ),
        "mean-for-sum": lambda albedo, radiance, cosine, solid_angle: (
            _reflected(albedo, radiance, cosine, solid_angle) / radiance.shape[-1]
        ),
        "last-light-forgotten": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance[:, :-1], cosine[:, :-1], solid_angle[:, :-1]
        ),
        "first-light-forgotten": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance[:, 1:], cosine[:, 1:], solid_angle[:, 1:]
        ),
        "last-light-alone": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance[:, -1:], cosine[:, -1:], solid_angle[:, -1:]
        ),
        "first-light-alone": lambda albedo, radiance, cosine, solid_angle: _reflected(
            albedo, radiance[:, :1], cosine[:, :1], solid_angle[:, :1]
        ),
        "sum-clamped": lambda albedo, radiance, cosine, solid_angle: np.maximum(
            _reflected(albedo, radiance, cosine, solid_angle)
            - _reflected(albedo, radiance, -cosine, solid_angle),
            0.0,
        ),
        "albedo-forgotten": lambda albedo, radiance, cosine, solid_angle: _reflected(
            0 * albedo + 1, radiance, cosine, solid_angle
        ),
        "irradiance-for-radiance": lambda albedo, radiance, cosine, solid_angle: _reflected(
            0 * albedo + math.pi, radiance, cosine, solid_angle
        ),
    },
    credit={"pi-too-many": 0.5, "horizon-not-clamped": 0.5, "absolute-value": 0.25, "mean-for-sum": 0.25},
    hints={
        "pi-too-many": {
            "en": "You forgot to divide by π: the BRDF of a Lambertian surface is ρ/π",
            "ru": "Вы забыли разделить на π: ДФО ламбертовой поверхности равна ρ/π",
        },
        "horizon-not-clamped": {
            "en": "Lights below the horizon are subtracted: leave out the terms of negative cosine",
            "ru": "Источники под горизонтом вычитаются: отбросьте слагаемые с отрицательным косинусом",
        },
        "last-light-forgotten": {
            "en": "The last light is missing from your sum: range(K) ends at K − 1 by itself",
            "ru": "В сумме нет последнего источника: range(K) и так кончается на K − 1",
        },
        "first-light-forgotten": {
            "en": "The first light is missing from your sum: indices begin at 0",
            "ru": "В сумме нет первого источника: индексы начинаются с 0",
        },
        "last-light-alone": {
            "en": "Only the last light counts in your answer: add each term, += in place of =",
            "ru": "В ответ вошёл только последний источник: слагаемые нужно прибавлять, += вместо =",
        },
        "first-light-alone": {
            "en": "Only the first light counts in your answer: does return stand inside the loop?",
            "ru": "В ответ вошёл только первый источник: не стоит ли return внутри цикла?",
        },
        "sum-clamped": {
            "en": "You clamped the whole sum: leave out each term of negative cosine by itself",
            "ru": "Вы обнулили всю сумму: отбрасывать нужно каждое слагаемое с отрицательным косинусом",
        },
        "absolute-value": {
            "en": "You took |cos θ|: lights below the horizon give nothing, take max(0, cos θ)",
            "ru": "Вы взяли |cos θ|: источники под горизонтом вклада не дают, нужен max(0, cos θ)",
        },
        "mean-for-sum": {
            "en": "You took the mean over the lights: their light adds up",
            "ru": "Вы взяли среднее по источникам: их свет складывается",
        },
        "albedo-forgotten": {
            "en": "You forgot the albedo: the BRDF is ρ/π",
            "ru": "Вы забыли альбедо: ДФО равна ρ/π",
        },
        "irradiance-for-radiance": {
            "en": "You gave the irradiance E: the reflected radiance is ρE/π",
            "ru": "Вы дали освещённость E: яркость отражённого света равна ρE/π",
        },
        "imprecise": {
            "en": "each small term is lost in the large sum: use numpy.sum along the last axis or math.fsum",
            "ru": "каждое малое слагаемое теряется в большой сумме: возьмите numpy.sum по последней оси "
            "или math.fsum",
        },
    },
)
