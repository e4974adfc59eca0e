"""Luminance: photometry, from a spectrum of watts to candelas a square metre."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    FloatArray,
    put_together,
)

__all__ = ["QUESTION"]

EFFICACY = 683.0
"""Lumens in a watt of green light, as the question states it."""


def _luminance(wavelength: FloatArray, exitance: FloatArray, efficiency: FloatArray) -> FloatArray:
    middle = 0.5 * (exitance[:, 1:] * efficiency[:, 1:] + exitance[:, :-1] * efficiency[:, :-1])
    result: FloatArray = EFFICACY / math.pi * np.sum(middle * np.abs(np.diff(wavelength)), axis=-1)
    return result


def _spectra(rng: np.random.Generator, wavelength: FloatArray) -> dict[str, Any]:
    bumps = rng.uniform(400, 700, (len(wavelength), 1, 4)), rng.uniform(20, 80, (len(wavelength), 1, 4))
    shape = np.exp(-(((wavelength[..., None] - bumps[0]) / bumps[1]) ** 2))
    return {
        "wavelength": wavelength,
        "exitance": rng.uniform(0.01, 1, (len(wavelength), 1)) * (0.1 + np.sum(shape, axis=-1)),
        # V(λ) to within a few per cent
        "efficiency": 1.019 * np.exp(-285.4 * (wavelength / 1000 - 0.559) ** 2),
    }


def _even_spectra(rng: np.random.Generator) -> dict[str, Any]:
    start, step = rng.uniform(480, 530, (20, 1)), rng.uniform(2, 4, (20, 1))
    return _spectra(rng, start + step * np.arange(31))


def _uneven_spectra(rng: np.random.Generator) -> dict[str, Any]:
    rising = 450 + np.cumsum(rng.uniform(0.5, 10, (20, 31)), axis=-1)
    falls = rng.permutation(np.arange(20) % 2 == 0)
    return _spectra(rng, np.where(falls[:, None], rising[:, ::-1], rising))


def _sums(exitance: FloatArray, efficiency: FloatArray) -> FloatArray:
    result: FloatArray = EFFICACY / math.pi * np.sum(exitance * efficiency, axis=-1)
    return result


def _even(y: FloatArray, step: FloatArray) -> FloatArray:
    """Return the integral by trapezoids of one width in each row (N, 1)."""
    result: FloatArray = EFFICACY / math.pi * np.sum((y[:, 1:] + y[:, :-1]) / 2 * step, axis=-1)
    return result


def _ends(wavelength: FloatArray, y: FloatArray, end: int) -> FloatArray:
    """Return the integral by the value at one end of each step, 0 or 1."""
    steps = np.abs(np.diff(wavelength, axis=-1))
    heights = y[:, end : y.shape[1] - 1 + end]
    result: FloatArray = EFFICACY / math.pi * np.sum(heights * steps, axis=-1)
    return result


QUESTION = put_together(
    "luminance(wavelength, exitance, efficiency)",
    title={"en": "Photometry: the luminance of a spectrum", "ru": "Фотометрия: яркость в кд/м² по спектру"},
    text={
        "en": r"""
A Lambertian surface radiates the spectral exitance $M_\lambda$. Return its luminance [cd/m²]: first the
luminous exitance [lm/m²],
$$M_v = K_m \int V(\lambda)\, M_\lambda \, d\lambda, \qquad K_m = 683\ \text{lm/W},$$
by the **trapezoidal rule** over the samples given, then $L_v$ from it, as for any Lambertian surface.

- `wavelength`: $\lambda$ [nm], array `(N, K)`: each row has a grid of its own;
- `exitance`: $M_\lambda$ [W/(m² nm)] there, `(N, K)`;
- `efficiency`: $V(\lambda)$ there, `(N, K)`.

The answer has shape `(N,)`; a function of one row, `(K,)` arrays, counts as well. **Hard inputs:** the
steps are uneven, and in some rows the wavelengths fall; the answer is never negative.
""",
        "ru": r"""
Ламбертова поверхность имеет спектральную светимость $M_\lambda$. Найдите её яркость в фотометрических
единицах [кд/м²]: сначала светимость [лм/м²]
$$M_v = K_m \int V(\lambda)\, M_\lambda \, d\lambda, \qquad K_m = 683\ \text{лм/Вт},$$
по **формуле трапеций** на данных отсчётах, затем по ней $L_v$, как для всякой ламбертовой поверхности.

- `wavelength`: $\lambda$ [нм], массив `(N, K)`: у каждой строки своя сетка;
- `exitance`: $M_\lambda$ [Вт/(м² нм)] в этих точках, `(N, K)`;
- `efficiency`: $V(\lambda)$ там же, `(N, K)`.

Ответ имеет форму `(N,)`; годится и функция одной строки, то есть массивов `(K,)`. **Трудные входы:** шаг
сетки переменный, а в некоторых строках длины волн убывают; ответ неотрицателен.
""",
    },
    reference=_luminance,
    ordinary=_even_spectra,
    hard=_uneven_spectra,
    variants={
        "efficiency-forgotten": lambda wavelength, exitance, efficiency: _luminance(
            wavelength, exitance, 0 * efficiency + 1
        ),
        "step-forgotten": lambda wavelength, exitance, efficiency: _sums(exitance, efficiency),
        "mean-for-integral": lambda wavelength, exitance, efficiency: (
            _sums(exitance, efficiency) / wavelength.shape[-1]
        ),
        "rectangle-rule": lambda wavelength, exitance, efficiency: (
            _sums(exitance, efficiency) * (wavelength[:, 1] - wavelength[:, 0])
        ),
        "one-end": lambda wavelength, exitance, efficiency: _ends(wavelength, exitance * efficiency, 0),
        "other-end": lambda wavelength, exitance, efficiency: _ends(wavelength, exitance * efficiency, 1),
        "last-step-forgotten": lambda wavelength, exitance, efficiency: _luminance(
            wavelength[:, :-1], exitance[:, :-1], efficiency[:, :-1]
        ),
        "sign-of-step": lambda wavelength, exitance, efficiency: (
            _luminance(wavelength, exitance, efficiency) * np.sign(wavelength[:, 1] - wavelength[:, 0])
        ),
        "step-of-the-first": lambda wavelength, exitance, efficiency: _even(
            exitance * efficiency, wavelength[:, 1:2] - wavelength[:, 0:1]
        ),
        "step-of-the-mean": lambda wavelength, exitance, efficiency: _even(
            exitance * efficiency, np.mean(np.diff(wavelength), axis=-1, keepdims=True)
        ),
        "cut-at-zero": lambda wavelength, exitance, efficiency: np.where(
            wavelength[:, 1] > wavelength[:, 0], _luminance(wavelength, exitance, efficiency), 0.0
        ),
        "pi-and-efficacy-forgotten": lambda wavelength, exitance, efficiency: (
            math.pi / EFFICACY * _luminance(wavelength, exitance, efficiency)
        ),
        "efficacy-rounded": lambda wavelength, exitance, efficiency: (
            683.002 / EFFICACY * _luminance(wavelength, exitance, efficiency)
        ),
    },
    credit={
        "pi-too-many": 0.5,
        "watts-for-lumens": 0.5,
        "rectangle-rule": 0.5,
        "pi-and-efficacy-forgotten": 0.25,
    },
    hints={
        **{
            name: {
                "en": "The steps of these wavelengths are not even: each trapezoid has a width of its own",
                "ru": "Шаг сетки здесь переменный: у каждой трапеции своя ширина",
            }
            for name in ("step-of-the-first", "step-of-the-mean")
        },
        "cut-at-zero": {
            "en": "Where the wavelengths fall, dλ is negative: take |dλ|, and do not cut the sum off at 0",
            "ru": "Там, где длины волн убывают, dλ отрицательно: возьмите |dλ|, а не обнуляйте сумму",
        },
        "pi-and-efficacy-forgotten": {
            "en": "You forgot both K_m = 683 lm/W and the division by π, L_v = M_v/π",
            "ru": "Вы забыли и K_m = 683 лм/Вт, и деление на π: L_v = M_v/π",
        },
        "one-end": {
            "en": "You took the value at one end of each step: a trapezoid takes the mean of both ends",
            "ru": "Вы взяли значение на одном конце шага: в трапеции берут среднее двух концов",
        },
        "other-end": {
            "en": "You took the value at the far end of each step: a trapezoid takes the mean of both ends",
            "ru": "Вы взяли значение на дальнем конце шага: в трапеции берут среднее двух концов",
        },
        "last-step-forgotten": {
            "en": "You left out the last step: N points have N − 1 steps",
            "ru": "Вы пропустили последний шаг: у N точек N − 1 шагов",
        },
        "doubled": {
            "en": "Your answer is twice the right one: a trapezoid takes the mean of its ends, not the sum",
            "ru": "Ваш ответ вдвое больше верного: в трапеции берут среднее двух концов, а не сумму",
        },
        "pi-too-many": {
            "en": "You gave the luminous exitance M_v: a Lambertian surface has the luminance L_v = M_v/π",
            "ru": "Вы дали светимость M_v: яркость ламбертовой поверхности L_v = M_v/π",
        },
        "watts-for-lumens": {
            "en": "You forgot K_m = 683 lm/W: your answer is in watts, not lumens",
            "ru": "Вы забыли K_m = 683 лм/Вт: ваш ответ в ваттах, а не в люменах",
        },
        "efficiency-forgotten": {
            "en": "You forgot V(λ): the eye does not see all wavelengths alike",
            "ru": "Вы забыли V(λ): глаз видит разные длины волн по-разному",
        },
        "step-forgotten": {
            "en": "You forgot the step dλ: a sum of samples is not yet an integral",
            "ru": "Вы забыли шаг dλ: сумма отсчётов — ещё не интеграл",
        },
        "mean-for-integral": {
            "en": "You took the mean of the samples: the integral is a sum with the steps dλ",
            "ru": "Вы взяли среднее отсчётов: интеграл — это сумма с шагами dλ",
        },
        "rectangle-rule": {
            "en": "You took a sum of rectangles with one step: take trapezoids with each step",
            "ru": "Вы взяли сумму прямоугольников с одним шагом: нужны трапеции, у каждой свой шаг",
        },
        "sign-of-step": {
            "en": "Where the wavelengths fall, dλ is negative and so is your answer: take |dλ|",
            "ru": "Там, где длины волн убывают, dλ < 0 и ответ отрицателен: возьмите |dλ|",
        },
        "efficacy-rounded": {
            "en": "You took 683.002 lm/W: here K_m = 683 lm/W is agreed upon",
            "ru": "Вы взяли 683,002 лм/Вт: здесь условлено, что K_m = 683 лм/Вт",
        },
    },
)
