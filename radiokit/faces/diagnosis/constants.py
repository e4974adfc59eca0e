"""Constants: misconceptions that multiply every answer by the same number."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from radiokit.faces.diagnosis.misconception import Guess, Misconception, constant
from radiokit.faces.diagnosis.problem import Problem

__all__ = ["ENTRIES"]

_PI = {"3": 3.0, "3.1": 3.1, "3.14": 3.14, "3.141": 3.141, "3.142": 3.142, "3.1415": 3.1415, "22/7": 22 / 7}


def _rounded_pi(problem: Problem) -> Iterable[Guess]:
    for text, value in _PI.items():
        for factor, detail in ((value / math.pi, f"π = {text}"), (math.pi / value, f"1/π, π = {text}")):
            yield Guess(factor * problem.reference, np.full_like(problem.reference, factor), detail)


ENTRIES: tuple[Misconception, ...] = (
    constant(
        "pi-too-many",
        math.pi,
        "Your answer is π times too large: a factor 1/π is missing, such as that of f = ρ/π and L = M/π, or "
        "a π is one too many.",
        "Ваш ответ в π раз больше верного: не хватает деления на π, как в f = ρ/π и L = M/π, "
        "либо есть лишнее π.",
        pairs=True,
    ),
    constant(
        "pi-too-few",
        1 / math.pi,
        "Your answer is π times too small: a factor π is missing, such as the hemisphere's integral of cos "
        "θ, or you divided by π once too often.",
        "Ваш ответ в π раз меньше верного: не хватает множителя π, например интеграла cos θ по полусфере, "
        "либо вы лишний раз разделили на π.",
        pairs=True,
    ),
    constant(
        "pi-multiplied",
        math.pi**2,
        "Your answer is π² times too large: you multiplied by π where you should divide, as x / 2 * π does "
        "for x / (2 * π).",
        "Ваш ответ в π² раз больше верного: вы умножили на π вместо деления, как в x / 2 * π вместо "
        "x / (2 * π).",
    ),
    constant(
        "doubled",
        2.0,
        "Your answer is twice the right one: a factor of 2 is too many, as where both sides count or a "
        "diameter stands for a radius, or a half is lost.",
        "Ваш ответ вдвое больше верного: лишний множитель 2, как при учёте обеих сторон или диаметре вместо "
        "радиуса, либо потеряна половина.",
        pairs=True,
    ),
    constant(
        "halved",
        0.5,
        "Your answer is half of the right one: a factor of 2 is lost, such as a side or half of an interval, "
        "or a half is one too many.",
        "Ваш ответ вдвое меньше верного: потерян множитель 2, например одна сторона или половина промежутка, "
        "либо есть лишнее деление на 2.",
        pairs=True,
    ),
    constant(
        "four-too-many",
        4.0,
        "Your answer is 4 times too large: a division by 4 is missing, such as that of D·G·F/(4 cos θi cos "
        "θo), or a diameter stands for a radius, or the like.",
        "Ваш ответ в 4 раза больше верного: не хватает деления на 4, например в D·G·F/(4 cos θi cos θo), "
        "либо где-то диаметр вместо радиуса или подобное.",
        pairs=True,
    ),
    constant(
        "four-too-few",
        0.25,
        "Your answer is a quarter of the right one: a factor of 4 is missing, such as that of 4πr², "
        "or you divided by 4 once too often.",
        "Ваш ответ вчетверо меньше верного: не хватает множителя 4, например в 4πr², "
        "либо вы лишний раз разделили на 4.",
        pairs=True,
    ),
    constant(
        "four-pi-too-many",
        4 * math.pi,
        "Your answer is 4π times too large: a factor 1/4π is missing, such as that of I = Φ/4π, or a 4π is "
        "one too many.",
        "Ваш ответ в 4π раз больше верного: не хватает деления на 4π, как в I = Φ/4π, либо есть лишнее 4π.",
        pairs=True,
    ),
    constant(
        "four-pi-too-few",
        1 / (4 * math.pi),
        "Your answer is 4π times too small: a factor 4π is missing, such as the sphere's solid angle, or you "
        "divided by it once too often.",
        "Ваш ответ в 4π раз меньше верного: не хватает множителя 4π, например телесного угла сферы, либо вы "
        "лишний раз на него разделили.",
        pairs=True,
    ),
    constant(
        "two-pi-too-many",
        2 * math.pi,
        "Your answer is 2π times too large: a factor 1/2π is missing, as in a lobe's normalisation or a mean "
        "over azimuth, or a 2π is one too many.",
        "Ваш ответ в 2π раз больше верного: не хватает множителя 1/2π, как в нормировке лепестка или среднем "
        "по азимуту, либо есть лишнее 2π.",
        pairs=True,
    ),
    constant(
        "two-pi-too-few",
        1 / (2 * math.pi),
        "Your answer is 2π times too small: a factor 2π is missing, such as the integral over azimuth, or "
        "the division of uniform samples by the density 1/2π.",
        "Ваш ответ в 2π раз меньше верного: не хватает множителя 2π, например интеграла по азимуту или "
        "деления равномерных отсчётов на плотность 1/2π.",
        pairs=True,
    ),
    constant(
        "sign-flipped",
        -1.0,
        "Your answer has the opposite sign, as where a direction points the other way, or the terms of a "
        "difference or limits of integration are exchanged.",
        "У вашего ответа противоположный знак, как при обратном направлении или перестановке членов "
        "разности либо пределов интеграла.",
        pairs=True,
    ),
    constant(
        "lumens-for-watts",
        683.0,
        "Your answer is 683 times too large: it is photometric (lumens) where watts are asked.",
        "Ваш ответ в 683 раза больше верного: он в световых единицах (люменах), а нужны ватты.",
    ),
    constant(
        "watts-for-lumens",
        1 / 683.0,
        "Your answer is 683 times too small: it is radiometric (watts) where lumens are asked.",
        "Ваш ответ в 683 раза меньше верного: он в ваттах, а нужны люмены.",
    ),
    constant(
        "degrees-given",
        180 / math.pi,
        "Your answer is 180/π times too large: it is in degrees where radians are asked.",
        "Ваш ответ в 180/π раз больше верного: он в градусах, а нужны радианы.",
    ),
    constant(
        "radians-given",
        math.pi / 180,
        "Your answer is 180/π times too small: it is in radians where degrees are asked, or was "
        "converted twice.",
        "Ваш ответ в 180/π раз меньше верного: он в радианах, а нужны градусы, либо пересчитан дважды.",
    ),
    constant(
        "thousand-too-many",
        1e3,
        "Your answer is 1000 times too large: a prefix is lost, such as milli, or a kilo in the unit.",
        "Ваш ответ в 1000 раз больше верного: потеряна приставка единицы, например милли или кило.",
    ),
    constant(
        "thousand-too-few",
        1e-3,
        "Your answer is 1000 times too small: a prefix is lost, such as kilo, or millimetres stand "
        "for metres.",
        "Ваш ответ в 1000 раз меньше верного: потеряна приставка единицы, например кило, или миллиметры "
        "вместо метров.",
    ),
    constant(
        "per-metre-of-wavelength",
        1e9,
        "Your answer is 10⁹ times too large: it is per metre of wavelength where per nanometre is asked.",
        "Ваш ответ в 10⁹ раз больше верного: он на метр длины волны, а нужен на нанометр.",
    ),
    constant(
        "per-nanometre-of-wavelength",
        1e-9,
        "Your answer is 10⁹ times too small: it is per nanometre of wavelength where per metre is asked.",
        "Ваш ответ в 10⁹ раз меньше верного: он на нанометр длины волны, а нужен на метр.",
    ),
    constant(
        "square-centimetres",
        1e4,
        "Your answer is 10⁴ times too large: square centimetres and square metres are exchanged.",
        "Ваш ответ в 10⁴ раз больше верного: перепутаны квадратные сантиметры и квадратные метры.",
    ),
    constant(
        "percent",
        100.0,
        "Your answer is 100 times too large: it is in per cent, or in centimetres where metres are asked.",
        "Ваш ответ в 100 раз больше верного: он в процентах или в сантиметрах вместо метров.",
    ),
    Misconception(
        "pi-rounded",
        "You rounded π: use numpy.pi or math.pi.",
        "Вы округлили π: возьмите numpy.pi или math.pi.",
        _rounded_pi,
        "constant",
    ),
)
