"""Sky: the irradiance of a cone of even radiance."""

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


def _sky(radiance: FloatArray, half_angle: FloatArray) -> FloatArray:
    result: FloatArray = math.pi * radiance * np.sin(half_angle) ** 2
    return result


def _skies(rng: np.random.Generator) -> dict[str, Any]:
    return {"radiance": rng.uniform(0.1, 100, COUNT), "half_angle": rng.uniform(0.1, 1.5, COUNT)}


def _suns(rng: np.random.Generator) -> dict[str, Any]:
    half_angle = np.append(powers(rng, -9, -3, COUNT - 1), math.pi / 2)
    return {"radiance": powers(rng, 0, 7, COUNT), "half_angle": rng.permutation(half_angle)}


QUESTION = put_together(
    "cone_irradiance(radiance, half_angle)",
    title={"en": "Irradiance from a radiance", "ru": "Освещённость по яркости"},
    text={
        "en": r"""
Light of the radiance $L$ falls on a surface evenly from a circular cone around its normal. Return the
irradiance [W/m²],
$$E = \int L \cos\theta \, d\omega = 2\pi \int_0^{\alpha} L \cos\theta \sin\theta \, d\theta .$$

- `radiance`: $L$ [W/(m² sr)];
- `half_angle`: $\alpha$ [rad], from the normal to the edge of the cone, $0 < \alpha \le \pi/2$.

Numbers or arrays of equal length. The whole hemisphere, $\alpha = \pi/2$, gives $\pi L$, as a Lambertian
surface has the exitance $M = \pi L$. **Hard inputs:** $\alpha$ from $10^{-9}$ to $10^{-3}$, where
$1 - \cos^2\alpha$ loses its digits; the relative error is to be $10^{-9}$.
""",
        "ru": r"""
На поверхность падает свет яркости $L$, одинаковой во всех направлениях кругового конуса вокруг нормали.
Найдите освещённость [Вт/м²]
$$E = \int L \cos\theta \, d\omega = 2\pi \int_0^{\alpha} L \cos\theta \sin\theta \, d\theta .$$

- `radiance`: яркость $L$ [Вт/(м² ср)];
- `half_angle`: $\alpha$ [рад], угол между нормалью и образующей конуса, $0 < \alpha \le \pi/2$.

Числа или массивы равной длины. Вся полусфера, $\alpha = \pi/2$, даёт $\pi L$, как и светимость ламбертовой
поверхности $M = \pi L$. **Трудные входы:** $\alpha$ от $10^{-9}$ до $10^{-3}$, где разность
$1 - \cos^2\alpha$ теряет цифры; относительная ошибка не должна превышать $10^{-9}$.
""",
    },
    reference=_sky,
    ordinary=_skies,
    hard=_suns,
    terms=lambda radiance, half_angle: math.pi * radiance,
    variants={
        "cosine-forgotten": lambda radiance, half_angle: 4 * math.pi * radiance * np.sin(half_angle / 2) ** 2,
        "radiance-for-irradiance": lambda radiance, half_angle: radiance + 0 * half_angle,
        "cone-forgotten": lambda radiance, half_angle: math.pi * radiance + 0 * half_angle,
        "sine-not-squared": lambda radiance, half_angle: math.pi * radiance * np.sin(half_angle),
        "cosine-for-sine": lambda radiance, half_angle: math.pi * radiance * np.cos(half_angle) ** 2,
        "cosine-of-the-edge": lambda radiance, half_angle: (
            4 * math.pi * radiance * np.sin(half_angle / 2) ** 2 * np.cos(half_angle)
        ),
        "full-angle": lambda radiance, half_angle: _sky(radiance, half_angle / 2),
        "small-angle": lambda radiance, half_angle: math.pi * radiance * half_angle**2,
        "angle-unit": lambda radiance, half_angle: _sky(radiance, np.radians(half_angle)),
    },
    credit={"doubled": 0.25, "cosine-forgotten": 0.25, "cone-forgotten": 0.25},
    hints={
        "cosine-forgotten": {
            "en": "LΩ holds for light along the normal: cos θ belongs under the integral over the cone",
            "ru": "LΩ верно для света вдоль нормали: под интегралом по конусу должен стоять cos θ",
        },
        "radiance-for-irradiance": {
            "en": "You gave the radiance where the irradiance is asked: integrate L cos θ over the cone",
            "ru": "Вы дали яркость вместо освещённости: проинтегрируйте L cos θ по конусу",
        },
        "cone-forgotten": {
            "en": "πL is what the whole hemisphere gives: the cone ends at α",
            "ru": "πL даёт вся полусфера: конус кончается при θ = α",
        },
        "sine-not-squared": {
            "en": "The sine is to be squared: the integral of cos θ sin θ is sin²θ/2",
            "ru": "Синус нужен в квадрате: первообразная cos θ sin θ равна sin²θ/2",
        },
        "cosine-for-sine": {
            "en": "You have cos²α where sin²α belongs: a cone of angle 0 gives nothing",
            "ru": "У вас cos²α вместо sin²α: конус с нулевым углом ничего не даёт",
        },
        "cosine-of-the-edge": {
            "en": "The angle differs within the cone: LΩ cos α takes the edge for all of it",
            "ru": "Угол внутри конуса меняется: LΩ cos α берёт его на краю, а нужен интеграл",
        },
        "full-angle": {
            "en": "The angle is the half angle already, from the axis to the edge: do not halve it again",
            "ru": "Угол — это уже половина раствора, от оси до края: не делите его ещё раз на 2",
        },
        "small-angle": {
            "en": "πLα² holds for narrow cones only: it is sin²α",
            "ru": "πLα² верно лишь для узких конусов: нужен sin²α",
        },
        "pi-too-few": {
            "en": "You forgot π: the cone's integral of cos θ is π sin²α",
            "ru": "Вы забыли π: интеграл cos θ по конусу равен π sin²α",
        },
        "doubled": {
            "en": "The integral of cos θ sin θ is sin²θ/2: its 2 cancels that of 2π",
            "ru": "Первообразная cos θ sin θ равна sin²θ/2: двойка сокращается с той, что в 2π",
        },
        "imprecise": {
            "en": "1 − cos²α and 1 − cos 2α subtract nearly equal numbers: sin²α loses none",
            "ru": "в 1 − cos²α и 1 − cos 2α вычитаются почти равные числа: sin²α цифр не теряет",
        },
    },
)
