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
        "Your answer is π times too large: divide by π, as in f = ρ/π and L = M/π; "
        "or you gave an irradiance or exitance where a radiance is asked.",
        "Ваш ответ в π раз больше: разделите на π, как в f = ρ/π и L = M/π; "
        "либо вместо яркости дана освещённость или светимость.",
        pairs=True,
    ),
    constant(
        "pi-too-few",
        1 / math.pi,
        "Your answer is π times too small: you divided by π once too often, "
        "or forgot that the hemisphere's integral of cos θ is π.",
        "Ваш ответ в π раз меньше: вы лишний раз разделили на π "
        "или забыли, что интеграл cos θ по полусфере равен π.",
        pairs=True,
    ),
    constant(
        "doubled",
        2.0,
        "Your answer is twice the right one: something is counted twice, such as both sides or a "
        "diameter for a radius.",
        "Ваш ответ вдвое больше: что-то учтено дважды, например обе стороны или диаметр вместо радиуса.",
        pairs=True,
    ),
    constant(
        "halved",
        0.5,
        "Your answer is half of the right one: a factor of 2 is lost, such as a side or half of an interval.",
        "Ваш ответ вдвое меньше: потерян множитель 2, например одна сторона или половина промежутка.",
        pairs=True,
    ),
    constant(
        "four-too-many",
        4.0,
        "Your answer is 4 times too large: the 4 in the denominator of D·G·F/(4 cos θi cos θo) or of "
        "dωh/dωi is missing, "
        "or a diameter stands for a radius in an area.",
        "Ваш ответ в 4 раза больше: нет четвёрки в знаменателе D·G·F/(4 cos θi cos θo) или в dωh/dωi, "
        "либо в площади диаметр вместо радиуса.",
        pairs=True,
    ),
    constant(
        "four-too-few",
        0.25,
        "Your answer is a quarter of the right one: you divided by 4 once too often, "
        "or took a disk's area πr² where a sphere's, 4πr², is meant.",
        "Ваш ответ вчетверо меньше: вы лишний раз разделили на 4 "
        "или взяли площадь круга πr² вместо площади сферы 4πr².",
        pairs=True,
    ),
    constant(
        "four-pi-too-many",
        4 * math.pi,
        "Your answer is 4π times too large: a flux was not divided by the sphere's 4π steradians (I = Φ/4π).",
        "Ваш ответ в 4π раз больше: поток не разделён на 4π стерадиан сферы (I = Φ/4π).",
    ),
    constant(
        "four-pi-too-few",
        1 / (4 * math.pi),
        "Your answer is 4π times too small: you divided by the sphere's 4π steradians once too often.",
        "Ваш ответ в 4π раз меньше: вы лишний раз разделили на 4π стерадиан сферы.",
    ),
    constant(
        "two-pi-too-many",
        2 * math.pi,
        "Your answer is 2π times too large: the density 1/2π of the hemisphere or the mean over "
        "azimuth is missing.",
        "Ваш ответ в 2π раз больше: забыта плотность 1/2π полусферы или среднее по азимуту.",
    ),
    constant(
        "two-pi-too-few",
        1 / (2 * math.pi),
        "Your answer is 2π times too small: the integral over azimuth gives 2π, "
        "and uniform samples of the hemisphere are divided by the density 1/2π.",
        "Ваш ответ в 2π раз меньше: интеграл по азимуту даёт 2π, "
        "а равномерные отсчёты по полусфере делят на плотность 1/2π.",
    ),
    constant(
        "sign-flipped",
        -1.0,
        "Your answer has the opposite sign: a direction points the other way, or limits of "
        "integration are exchanged.",
        "У вашего ответа противоположный знак: направление смотрит в другую сторону или пределы "
        "интеграла переставлены.",
        pairs=True,
    ),
    constant(
        "lumens-for-watts",
        683.0,
        "Your answer is 683 times too large: it is photometric (lumens) where watts are asked.",
        "Ваш ответ в 683 раза больше: он в световых единицах (люменах), а нужны ватты.",
    ),
    constant(
        "watts-for-lumens",
        1 / 683.0,
        "Your answer is 683 times too small: it is radiometric (watts) where lumens are asked.",
        "Ваш ответ в 683 раза меньше: он в ваттах, а нужны люмены.",
    ),
    constant(
        "degrees-given",
        180 / math.pi,
        "Your answer is 180/π times too large: it is in degrees where radians are asked.",
        "Ваш ответ в 180/π раз больше: он в градусах, а нужны радианы.",
    ),
    constant(
        "radians-given",
        math.pi / 180,
        "Your answer is 180/π times too small: it is in radians where degrees are asked, or was "
        "converted twice.",
        "Ваш ответ в 180/π раз меньше: он в радианах, а нужны градусы, либо пересчитан дважды.",
    ),
    constant(
        "thousand-too-many",
        1e3,
        "Your answer is 1000 times too large: a prefix is lost, such as milli, or a kilo in the unit.",
        "Ваш ответ в 1000 раз больше: потеряна приставка единицы, например милли или кило.",
    ),
    constant(
        "thousand-too-few",
        1e-3,
        "Your answer is 1000 times too small: a prefix is lost, such as kilo, or millimetres stand "
        "for metres.",
        "Ваш ответ в 1000 раз меньше: потеряна приставка единицы, например кило, или миллиметры "
        "вместо метров.",
    ),
    constant(
        "per-metre-of-wavelength",
        1e9,
        "Your answer is 10⁹ times too large: it is per metre of wavelength where per nanometre is asked.",
        "Ваш ответ в 10⁹ раз больше: он на метр длины волны, а нужен на нанометр.",
    ),
    constant(
        "per-nanometre-of-wavelength",
        1e-9,
        "Your answer is 10⁹ times too small: it is per nanometre of wavelength where per metre is asked.",
        "Ваш ответ в 10⁹ раз меньше: он на нанометр длины волны, а нужен на метр.",
    ),
    constant(
        "square-centimetres",
        1e4,
        "Your answer is 10⁴ times too large: square centimetres and square metres are exchanged.",
        "Ваш ответ в 10⁴ раз больше: перепутаны квадратные сантиметры и квадратные метры.",
    ),
    constant(
        "percent",
        100.0,
        "Your answer is 100 times too large: it is in per cent, or in centimetres where metres are asked.",
        "Ваш ответ в 100 раз больше: он в процентах или в сантиметрах вместо метров.",
    ),
    Misconception(
        "pi-rounded",
        "You rounded π: use numpy.pi or math.pi.",
        "Вы округлили π: возьмите numpy.pi или math.pi.",
        _rounded_pi,
        "constant",
    ),
)
