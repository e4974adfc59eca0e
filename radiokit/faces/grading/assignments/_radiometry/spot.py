"""Spot: the flux of a lobe of intensity into a cone."""

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


def _spot(intensity: FloatArray, exponent: FloatArray, half_angle: FloatArray) -> FloatArray:
    m = exponent + 1
    # 1 − cosᵐα, with ln cosα = ½ ln(1 − sin²α)
    lost = -np.expm1(0.5 * m * np.log1p(-np.square(np.sin(half_angle))))
    result: FloatArray = 2 * math.pi * intensity * lost / m
    return result


def _spots(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "intensity": rng.uniform(1, 100, COUNT),
        "exponent": rng.uniform(1, 20, COUNT),
        "half_angle": rng.uniform(0.2, 1.5, COUNT),
    }


def _narrow_spots(rng: np.random.Generator) -> dict[str, Any]:
    half_angle = powers(rng, -8, -3, COUNT)
    sharp = rng.permutation(np.arange(COUNT) % 2 == 0)
    broad = rng.integers(0, 50, COUNT).astype(float)
    return {
        "intensity": rng.uniform(1, 100, COUNT),
        "exponent": np.where(sharp, np.round(powers(rng, -1, 1, COUNT) / half_angle**2), broad),
        "half_angle": half_angle,
    }


QUESTION = put_together(
    "spot_flux(intensity, exponent, half_angle)",
    title={"en": "Flux of a spotlight", "ru": "Поток прожектора"},
    text={
        "en": r"""
A spotlight has the intensity $I(\theta) = I_0 \cos^n\theta$. Return the flux [W] that it sends into the
cone of half angle $\alpha$ around its axis,
$$\Phi = \int I \, d\omega = 2\pi \int_0^{\alpha} I(\theta) \sin\theta \, d\theta .$$

- `intensity`: $I_0$ [W/sr], on the axis;
- `exponent`: $n \ge 0$, not always an integer; $n = 0$ is the same intensity in all directions of the cone;
- `half_angle`: $\alpha$ [rad], $0 < \alpha < \pi/2$.

Numbers or arrays of equal length. **Hard inputs:** $\alpha$ from $10^{-8}$ to $10^{-3}$, with $n$ from 0 to
$10^{17}$, where $1 - \cos^{n+1}\alpha$ loses its digits (think of `expm1` and `log1p`); the relative error
is to be $10^{-9}$.
""",
        "ru": r"""
Сила света прожектора равна $I(\theta) = I_0 \cos^n\theta$. Найдите поток [Вт], который он посылает в конус
с углом $\alpha$ между осью и образующей,
$$\Phi = \int I \, d\omega = 2\pi \int_0^{\alpha} I(\theta) \sin\theta \, d\theta .$$

- `intensity`: $I_0$ [Вт/ср], сила света на оси;
- `exponent`: $n \ge 0$, не обязательно целое; при $n = 0$ сила света одинакова во всём конусе;
- `half_angle`: $\alpha$ [рад], $0 < \alpha < \pi/2$.

Числа или массивы равной длины. **Трудные входы:** $\alpha$ от $10^{-8}$ до $10^{-3}$ при $n$ от 0 до
$10^{17}$, где разность $1 - \cos^{n+1}\alpha$ теряет цифры (вспомните `expm1` и `log1p`); относительная
ошибка не должна превышать $10^{-9}$.
""",
    },
    reference=_spot,
    ordinary=_spots,
    hard=_narrow_spots,
    terms=lambda intensity, exponent, half_angle: 2 * math.pi * intensity,
    variants={
        "lobe-forgotten": lambda intensity, exponent, half_angle: _spot(intensity, 0 * exponent, half_angle),
        "cone-forgotten": lambda intensity, exponent, half_angle: 2 * math.pi * intensity / (exponent + 1),
        "cosine-included": lambda intensity, exponent, half_angle: _spot(intensity, exponent + 1, half_angle),
        "power-off-by-one": lambda intensity, exponent, half_angle: _spot(
            intensity, exponent - 1, half_angle
        ),
        "divisor-forgotten": lambda intensity, exponent, half_angle: (
            (exponent + 1) * _spot(intensity, exponent, half_angle)
        ),
        "one-outside-the-exponent": lambda intensity, exponent, half_angle: (
            -2 * math.pi * intensity * np.cos(half_angle) ** exponent / (exponent + 1)
        ),
        "angle-unit": lambda intensity, exponent, half_angle: _spot(
            intensity, exponent, np.radians(half_angle)
        ),
    },
    credit={"doubled": 0.25, "two-pi-too-few": 0.25, "cone-forgotten": 0.25},
    hints={
        "lobe-forgotten": {
            "en": "I₀Ω is the flux of an even intensity: cosⁿθ belongs under the integral",
            "ru": "I₀Ω — это поток при постоянной силе света: под интегралом должен стоять cosⁿθ",
        },
        "cone-forgotten": {
            "en": "2πI₀/(n + 1) is the flux into the whole hemisphere: the cone ends at α",
            "ru": "2πI₀/(n + 1) — это поток во всю полусферу: конус кончается при θ = α",
        },
        "cosine-included": {
            "en": "You have one cosine too many, as for an irradiance: dΦ = I dω has none",
            "ru": "У вас лишний косинус, как для освещённости: в dΦ = I dω его нет",
        },
        "power-off-by-one": {
            "en": "The integral of cosⁿθ sin θ is −cosⁿ⁺¹θ/(n + 1): n + 1 stands in both places",
            "ru": "Первообразная cosⁿθ sin θ равна −cosⁿ⁺¹θ/(n + 1): n + 1 стоит в обоих местах",
        },
        "one-outside-the-exponent": {
            "en": "The 1 stands outside of the power: x**n+1 is x**n plus 1, write x**(n + 1)",
            "ru": "Единица осталась вне степени: x**n+1 — это x**n плюс 1, нужно x**(n + 1)",
        },
        "divisor-forgotten": {
            "en": "You forgot to divide by n + 1: the integral of cosⁿθ sin θ is −cosⁿ⁺¹θ/(n + 1)",
            "ru": "Вы забыли разделить на n + 1: первообразная cosⁿθ sin θ равна −cosⁿ⁺¹θ/(n + 1)",
        },
        "doubled": {
            "en": "The azimuth gives 2π, not 4π",
            "ru": "Интеграл по азимуту даёт 2π, а не 4π",
        },
        "pi-too-few": {
            "en": "You forgot π: the azimuth's integral gives 2π",
            "ru": "Вы забыли π: интеграл по азимуту равен 2π",
        },
        "two-pi-too-few": {
            "en": "You forgot the azimuth: its integral gives 2π",
            "ru": "Вы забыли про азимут: интеграл по нему даёт 2π",
        },
        "imprecise": {
            "en": "1 − cosⁿ⁺¹α subtracts nearly equal numbers: it is −expm1((n + 1) ln cos α), and "
            "ln cos α = ½ log1p(−sin²α)",
            "ru": "в 1 − cosⁿ⁺¹α вычитаются почти равные числа: это −expm1((n + 1) ln cos α), а "
            "ln cos α = ½ log1p(−sin²α)",
        },
    },
)
