"""Cone: the solid angle of a circular cone, narrow ones too."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    COUNT,
    powers,
    put_together,
)
from radiokit.facts.directions import cap_solid_angle

__all__ = ["QUESTION"]


def _cones(rng: np.random.Generator) -> dict[str, Any]:
    return {"half_angle": rng.uniform(0.05, math.pi, COUNT)}


def _narrow_cones(rng: np.random.Generator) -> dict[str, Any]:
    return {"half_angle": powers(rng, -9, -3, COUNT)}


QUESTION = put_together(
    "cone_solid_angle(half_angle)",
    title={"en": "Solid angle of a cone", "ru": "Телесный угол конуса"},
    text={
        "en": r"""
Return the solid angle of a circular cone [sr],
$$\Omega = \int_0^{2\pi}\!\!\int_0^{\alpha} \sin\theta \, d\theta \, d\varphi .$$

- `half_angle`: $\alpha$ [rad], from the axis to the edge, $0 < \alpha \le \pi$; a number or an array.

The whole sphere, $\alpha = \pi$, gives $4\pi$ sr. **Hard inputs:** $\alpha$ from $10^{-9}$ to $10^{-3}$,
where all digits of $1 - \cos\alpha$ may be lost; a relative error of $10^{-9}$ is asked for there too.
""",
        "ru": r"""
Найдите телесный угол кругового конуса [ср],
$$\Omega = \int_0^{2\pi}\!\!\int_0^{\alpha} \sin\theta \, d\theta \, d\varphi .$$

- `half_angle`: $\alpha$ [рад], угол между осью и образующей, $0 < \alpha \le \pi$; число или массив.

Вся сфера, $\alpha = \pi$, даёт $4\pi$ ср. **Трудные входы:** $\alpha$ от $10^{-9}$ до $10^{-3}$, где в
разности $1 - \cos\alpha$ могут пропасть все цифры; относительная ошибка и там не должна превышать
$10^{-9}$.
""",
    },
    reference=lambda half_angle: cap_solid_angle(half_angle),
    ordinary=_cones,
    hard=_narrow_cones,
    terms=lambda half_angle: 2 * math.pi,
    variants={
        "sine-for-cosine": lambda half_angle: 2 * math.pi * (1 - np.sin(half_angle)),
        "small-angle": lambda half_angle: math.pi * half_angle**2,
        "projected-solid-angle": lambda half_angle: math.pi * np.sin(half_angle) ** 2,
        "cosine-added": lambda half_angle: 2 * math.pi * (1 + np.cos(half_angle)),
        "sine-not-integrated": lambda half_angle: 2 * math.pi * half_angle,
        "square-degrees": lambda half_angle: np.degrees(np.degrees(cap_solid_angle(half_angle))),
        "full-angle": lambda half_angle: 4 * math.pi * np.sin(half_angle / 4) ** 2,
        "angle-unit": lambda half_angle: 4 * math.pi * np.sin(np.radians(half_angle) / 2) ** 2,
    },
    credit={"doubled": 0.25, "halved": 0.25, "full-angle": 0.25, "angle-unit": 0.25},
    hints={
        "pi-too-few": {
            "en": "You forgot π: the integral over φ gives 2π",
            "ru": "Вы забыли π: интеграл по φ равен 2π",
        },
        "two-pi-too-few": {
            "en": "You forgot the integral over φ: it gives 2π",
            "ru": "Вы забыли интеграл по φ: он равен 2π",
        },
        "doubled": {
            "en": "2π stands before 1 − cos α, not 4π: try α = π, which is the whole sphere",
            "ru": "Перед 1 − cos α стоит 2π, а не 4π: проверьте на α = π, то есть на всей сфере",
        },
        "sine-for-cosine": {
            "en": "You have sin α where cos α belongs: the integral of sin θ is −cos θ",
            "ru": "У вас sin α вместо cos α: первообразная sin θ равна −cos θ",
        },
        "cosine-added": {
            "en": "1 + cos α is the rest of the sphere: the integral of sin θ from 0 to α is 1 − cos α",
            "ru": "1 + cos α — это остальная часть сферы: интеграл sin θ от 0 до α равен 1 − cos α",
        },
        "sine-not-integrated": {
            "en": "You left out sin θ: dω = sin θ dθ dφ, so that the integral over θ is 1 − cos α, not α",
            "ru": "Вы пропустили sin θ: dω = sin θ dθ dφ, поэтому интеграл по θ равен 1 − cos α, а не α",
        },
        "square-degrees": {
            "en": "Your answer is in square degrees, (180/π)² times too large: steradians are asked for",
            "ru": "Ваш ответ дан в квадратных градусах, он в (180/π)² раз больше: нужны стерадианы",
        },
        "small-angle": {
            "en": "πα² is the area of a flat disk: it is the solid angle of narrow cones only",
            "ru": "πα² — это площадь плоского круга: телесному углу она равна лишь для узких конусов",
        },
        "projected-solid-angle": {
            "en": "π sin²α is the projected solid angle: there is no cosine under this integral",
            "ru": "π sin²α — это проекция телесного угла: под этим интегралом косинуса нет",
        },
        "full-angle": {
            "en": "The angle is the half angle already, from the axis to the edge: do not halve it again",
            "ru": "Угол уже отсчитан от оси до образующей: ещё раз делить его пополам не нужно",
        },
        "imprecise": {
            "en": "1 − cos α subtracts nearly equal numbers: express it by the sine of α/2",
            "ru": "в 1 − cos α вычитаются почти равные числа: выразите разность через синус α/2",
        },
    },
)
