"""Transforms: misconceptions that give a function of the right answer: a root, a logarithm, a rounding."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from radiokit.faces.diagnosis.misconception import Guess, Misconception, structural
from radiokit.faces.diagnosis.problem import Array, Problem

__all__ = ["ENTRIES"]


def _absolute(problem: Problem) -> Iterable[Guess]:
    if np.any(problem.reference < 0):
        yield Guess(np.abs(problem.reference))


def _clipped(problem: Problem) -> Iterable[Guess]:
    lowest, highest = problem.reference.min(initial=0.0), problem.reference.max(initial=0.0)
    if lowest < 0:
        yield Guess(np.maximum(problem.reference, 0), detail="≥ 0")
    if highest > 1:
        yield Guess(np.clip(problem.reference, 0, 1), detail="≤ 1")


def _transform(**transforms: Callable[[Array], Array]) -> Callable[[Problem], Iterable[Guess]]:
    def explain(problem: Problem) -> Iterable[Guess]:
        for detail, transform in transforms.items():
            with np.errstate(all="ignore"):
                yield Guess(transform(problem.reference), detail=detail)

    return explain


def _srgb(values: Array) -> Array:
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)


def _truncated(problem: Problem) -> Iterable[Guess]:
    for detail, rounded in (("trunc", np.trunc), ("floor", np.floor), ("round", np.round)):
        yield Guess(rounded(problem.reference), detail=detail)


def _digits(problem: Problem) -> Iterable[Guess]:
    for digits in (4, 3, 2, 1):
        yield Guess(np.round(problem.reference, digits), detail=f"{digits}")
    yield Guess(np.round(problem.reference * 255) / 255, detail="8 bit")


def _single(problem: Problem) -> Iterable[Guess]:
    if np.any(problem.answer != problem.reference) and np.any(problem.answer.astype(np.float32) != 0):
        yield Guess(problem.reference.astype(np.float32).astype(float))


ENTRIES: tuple[Misconception, ...] = (
    structural(
        "absolute-value",
        _absolute,
        "You took the absolute value: here the answer may be negative.",
        "Вы взяли модуль: здесь ответ бывает отрицательным.",
    ),
    structural(
        "clipped",
        _clipped,
        "You clipped the answer to a range: values outside it are right here, and a BRDF may exceed 1.",
        "Вы обрезали ответ по диапазону: значения вне его здесь верны, и BRDF может превышать 1.",
    ),
    structural(
        "square-root",
        _transform(sqrt=np.sqrt),
        "You gave the square root of the answer.",
        "Вы дали квадратный корень из ответа.",
    ),
    structural(
        "squared",
        _transform(square=np.square),
        "You gave the square of the answer, such as a variance for a standard deviation.",
        "Вы дали квадрат ответа, например дисперсию вместо стандартного отклонения.",
    ),
    structural(
        "logarithm",
        _transform(ln=np.log, log10=np.log10, log2=np.log2, ln1p=np.log1p, dB=lambda x: 10 * np.log10(x)),
        "You gave the logarithm of the answer.",
        "Вы дали логарифм ответа.",
    ),
    structural(
        "reciprocal",
        _transform(reciprocal=np.reciprocal),
        "You gave the reciprocal of the answer: numerator and denominator are exchanged.",
        "Вы дали обратную величину: числитель и знаменатель переставлены.",
    ),
    structural(
        "one-minus",
        _transform(one_minus=lambda x: 1 - x),
        "You gave one minus the answer, such as the transmitted share for the reflected one.",
        "Вы дали единицу минус ответ, например прошедшую долю вместо отражённой.",
    ),
    structural(
        "gamma-encoded",
        _transform(sRGB=_srgb, gamma=lambda x: x ** (1 / 2.2)),
        "Your answer is encoded for a display (gamma, sRGB): give linear radiometric numbers.",
        "Ваш ответ закодирован для экрана (гамма, sRGB): нужны линейные радиометрические числа.",
    ),
    structural(
        "normalised-to-one",
        _transform(max=lambda x: x / np.max(x), sum=lambda x: x / np.sum(x), mean=lambda x: x / np.mean(x)),
        "You scaled the answers so that their maximum, sum or mean is 1: the absolute value is asked.",
        "Вы отнормировали ответы на максимум, сумму или среднее: нужны абсолютные значения.",
        prior=0.5,
    ),
    structural(
        "running-sum",
        _transform(sum=np.cumsum, mean=lambda x: np.cumsum(x) / np.arange(1, x.size + 1)),
        "You gave the running sum or mean: a variable is not set back between inputs.",
        "Вы дали накопленную сумму или среднее: переменная не обнуляется между входами.",
    ),
    structural(
        "truncated-to-integer",
        _truncated,
        "Your answers are whole numbers: an integer type or the division // cut off the fraction.",
        "Ваши ответы — целые числа: целый тип или деление // отбросили дробную часть.",
    ),
    structural(
        "rounded",
        _digits,
        "You rounded the answer to a few digits: give all of them, and round when printing.",
        "Вы округлили ответ до нескольких знаков: дайте все, а округляйте при печати.",
    ),
    structural(
        "single-precision",
        _single,
        "Your answers are right to seven digits, as float32 is: use float64.",
        "Ваши ответы верны до семи знаков, как float32: возьмите float64.",
        slack=2e-6,
    ),
)
