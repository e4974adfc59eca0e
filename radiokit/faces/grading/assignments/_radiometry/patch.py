"""Patch: the irradiance that a small patch gives, with a cosine at either end."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    COUNT,
    FloatArray,
    put_together,
)

__all__ = ["QUESTION"]


def _patch(
    radiance: FloatArray, area: FloatArray, distance: FloatArray, theta: FloatArray, theta_light: FloatArray
) -> FloatArray:
    cosines = np.maximum(0.0, np.cos(theta)) * np.maximum(0.0, np.cos(theta_light))
    result: FloatArray = radiance * area / distance**2 * cosines
    return result


def _seen(rng: np.random.Generator, behind: FloatArray, behind_light: FloatArray) -> dict[str, Any]:
    theta, theta_light = rng.uniform(0.1, 1.4, COUNT), rng.uniform(0.1, 1.4, COUNT)
    return {
        "radiance": rng.uniform(1, 100, COUNT),
        "area": rng.uniform(1e-4, 1e-2, COUNT),
        "distance": rng.uniform(1, 5, COUNT),
        "theta": np.where(behind, math.pi - theta, theta),
        "theta_light": np.where(behind_light, math.pi - theta_light, theta_light),
    }


def _patches(rng: np.random.Generator) -> dict[str, Any]:
    kind = rng.permutation(np.arange(COUNT) % 8)
    return _seen(rng, kind == 0, kind == 1)


def _turned_patches(rng: np.random.Generator) -> dict[str, Any]:
    kind = rng.permutation(np.arange(COUNT) % 4)
    return _seen(rng, kind == 0, kind == 0)


QUESTION = put_together(
    "patch_irradiance(radiance, area, distance, theta, theta_light)",
    title={"en": "Irradiance from a small patch", "ru": "Освещённость от малой площадки"},
    text={
        "en": r"""
A small flat patch shines with the radiance $L$ from its front. Return the irradiance [W/m²] that it gives a
surface at the distance $d$, $E = L \cos\theta\, \Delta\omega$ with the solid angle of the patch
$$\Delta\omega = \frac{A \cos\theta'}{d^2} .$$

- `radiance`: $L$ [W/(m² sr)];
- `area`: $A$ [m²], small against $d^2$;
- `distance`: $d$ [m];
- `theta`: $\theta$ [rad], at the surface, from its normal to the patch, $0 \le \theta \le \pi$;
- `theta_light`: $\theta'$ [rad], at the patch, from its normal to the surface, $0 \le \theta' \le \pi$.

Numbers or arrays of equal length. The answer is 0 if the patch is behind the surface **or** the surface
behind the patch. **Hard inputs:** both at once.
""",
        "ru": r"""
Малая плоская площадка светит лицевой стороной с яркостью $L$. Найдите освещённость [Вт/м²], которую она
создаёт на поверхности, удалённой на расстояние $d$: $E = L \cos\theta\, \Delta\omega$, где телесный угол
площадки
$$\Delta\omega = \frac{A \cos\theta'}{d^2} .$$

- `radiance`: яркость $L$ [Вт/(м² ср)];
- `area`: площадь $A$ [м²], малая по сравнению с $d^2$;
- `distance`: $d$ [м];
- `theta`: $\theta$ [рад], угол у поверхности между её нормалью и направлением на площадку,
  $0 \le \theta \le \pi$;
- `theta_light`: $\theta'$ [рад], угол у площадки между её нормалью и направлением на поверхность,
  $0 \le \theta' \le \pi$.

Числа или массивы равной длины. Ответ равен 0, если площадка позади поверхности **или** поверхность позади
площадки. **Трудные входы:** то и другое сразу.
""",
    },
    reference=_patch,
    ordinary=_patches,
    hard=_turned_patches,
    context=lambda radiance, area, distance, theta, theta_light: {
        "cosine_light": np.cos(theta_light),
        "solid_angle": area * np.cos(theta_light) / distance**2,
    },
    variants={
        "area-forgotten": lambda radiance, area, distance, theta, theta_light: _patch(
            radiance, 1 + 0 * area, distance, theta, theta_light
        ),
        "theta-twice": lambda radiance, area, distance, theta, theta_light: _patch(
            radiance, area, distance, theta, theta
        ),
        "theta-light-twice": lambda radiance, area, distance, theta, theta_light: _patch(
            radiance, area, distance, theta_light, theta_light
        ),
        "both-cosines-forgotten": lambda radiance, area, distance, theta, theta_light: (
            radiance * area / distance**2
        ),
        "radiance-for-irradiance": lambda radiance, area, distance, theta, theta_light: (
            radiance + 0 * distance
        ),
        "angle-unit": lambda radiance, area, distance, theta, theta_light: _patch(
            radiance, area, distance, np.radians(theta), np.radians(theta_light)
        ),
    },
    credit={"horizon-not-clamped": 0.5},
    hints={
        "sine-forgotten": {
            "en": "You divided by sin θ, as the cotangent does: the cosine alone belongs there",
            "ru": "У вас деление на sin θ, как в котангенсе: нужен только косинус",
        },
        "sine-twice": {
            "en": "You have a sin θ too many: the cosine alone belongs there",
            "ru": "У вас лишний sin θ: нужен только косинус",
        },
        "theta-twice": {
            "en": "You took θ at the light too: there it is the other angle, θ'",
            "ru": "Вы взяли θ и у источника, а там другой угол, θ'",
        },
        "theta-light-twice": {
            "en": "You took θ' at the receiver too: there it is the other angle, θ",
            "ru": "Вы взяли θ' и у приёмника, а там другой угол, θ",
        },
        "cosine-twice": {
            "en": "The cosine enters once: the area that a beam falls on is 1/cos θ as large",
            "ru": "Косинус входит один раз: пучок ложится на площадь в 1/cos θ раз большую",
        },
        "horizon-not-clamped": {
            "en": "Each cosine is to be cut off at 0 by itself: the product of two negative ones is positive",
            "ru": "Обрежьте нулём каждый косинус отдельно: произведение двух отрицательных положительно",
        },
        "area-forgotten": {
            "en": "You forgot the area: Δω = A cos θ'/d²",
            "ru": "Вы забыли площадь: Δω = A cos θ'/d²",
        },
        "both-cosines-forgotten": {
            "en": "Both cosines are missing, that at the surface and that at the patch",
            "ru": "Нет обоих косинусов: ни у поверхности, ни у площадки",
        },
        "radiance-for-irradiance": {
            "en": "You gave the radiance where the irradiance is asked: E = L cos θ Δω",
            "ru": "Вы дали яркость вместо освещённости: E = L cos θ Δω",
        },
        "pi-too-many": {
            "en": "You have the exitance πL where the radiance L belongs",
            "ru": "У вас светимость πL вместо яркости L",
        },
        "angle-unit": {
            "en": "The angles are in radians already: do not convert them",
            "ru": "Углы уже в радианах: пересчитывать их не нужно",
        },
    },
)
