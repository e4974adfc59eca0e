"""Assignment 1: solid angle, flux, the inverse square, the cosine law, radiance, and photometry."""

from __future__ import annotations

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.assignments._radiometry import (
    cone,
    inverse_square,
    lamp,
    light,
    luminance,
    patch,
    reflected,
    sky,
    spot,
    triangle,
)

__all__ = ["ASSIGNMENT"]

ASSIGNMENT = Assignment(
    name="radiometry",
    title={"en": "Assignment 1: radiometry", "ru": "Задание 1. Радиометрия"},
    intro={
        "en": r"""
Write ten functions with the names and arguments given. Each takes **numbers or NumPy arrays of equal
length** and returns as many numbers; vectors are arrays `(N, 3)`. A function that takes one input at a time
counts as well. The module `math` and NumPy suffice.

All is in SI units: metres, watts, steradians. Angles are in **radians**, unless a name ends in `_deg`.
Arguments are not to be changed.

Each question has two parts. **Ordinary inputs** (1.5 points) allow a relative error of $10^{-5}$. **Hard
inputs** (0.5 points) are hidden, and ask for $10^{-9}$ where the question says nothing else: there float64
is needed, and a formula that loses no digits.
""",
        "ru": r"""
Напишите десять функций с данными именами и аргументами. Каждая принимает **числа или массивы NumPy равной
длины** и возвращает столько же чисел; векторы — массивы `(N, 3)`. Годится и функция, принимающая по одному
набору данных. Достаточно модуля `math` и NumPy.

Все величины — в единицах СИ: метры, ватты, стерадианы. Углы — в **радианах**, если имя не кончается на
`_deg`. Аргументы менять нельзя.

В каждом вопросе две части. **Обычные входы** (1,5 балла) допускают относительную ошибку $10^{-5}$.
**Трудные входы** (0,5 балла) скрыты и требуют $10^{-9}$, если в вопросе не сказано иное: здесь нужны
float64 и формула, которая не теряет цифр.
""",
    },
    questions=tuple(
        each.QUESTION
        for each in (cone, triangle, spot, inverse_square, lamp, light, sky, patch, luminance, reflected)
    ),
)
