"""Lamp: the cosine law in degrees, up to the horizon and behind it."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._radiometry.common import (
    CLAMP,
    COUNT,
    FloatArray,
    powers,
    put_together,
)

__all__ = ["QUESTION"]


def _cosine(theta_deg: FloatArray) -> FloatArray:
    """Return max(0, cosθ), all digits of it, from degrees: 90 − θ is exact near the horizon."""
    result: FloatArray = np.maximum(0.0, np.sin(np.radians(90.0 - theta_deg)))
    return result


def _lamp(intensity: FloatArray, distance: FloatArray, theta_deg: FloatArray) -> FloatArray:
    result: FloatArray = intensity * _cosine(theta_deg) / distance**2
    return result


def _tilts(rng: np.random.Generator, theta_deg: FloatArray) -> dict[str, Any]:
    return {
        "intensity": rng.uniform(1, 100, COUNT),
        "distance": rng.uniform(0.2, 5, COUNT),
        "theta_deg": rng.permutation(theta_deg),
    }


def _lamps(rng: np.random.Generator) -> dict[str, Any]:
    behind = COUNT // 4
    angles = np.concatenate((rng.uniform(2, 85, COUNT - behind), rng.uniform(95, 178, behind)))
    return _tilts(rng, angles)


def _grazing(rng: np.random.Generator) -> dict[str, Any]:
    some = COUNT - 8
    return _tilts(rng, np.concatenate((90 - powers(rng, -10, -3, some), np.full(4, 90.0), np.full(4, 180.0))))


QUESTION = put_together(
    "lamp_irradiance(intensity, distance, theta_deg)",
    title={"en": "Cosine law", "ru": "Закон косинусов"},
    text={
        "en": r"""
Return the irradiance [W/m²] that a point source gives a surface,
$$E = \frac{I \cos\theta}{d^2}, \qquad E = 0 \text{ if the light is behind the surface.}$$

- `intensity`: $I$ [W/sr], towards the surface;
- `distance`: $d > 0$ [m];
- `theta_deg`: the angle $\theta$ between the normal and the direction to the light, **in degrees**,
  $0 \le \theta \le 180$.

Numbers or arrays of equal length. **Hard inputs:** $\theta$ within $10^{-3}$ to $10^{-10}$ degrees of 90°,
where the rounding of $\pi/2$ spoils the cosine; at 90° and beyond it, exactly 0 is right. The relative
error is to be $10^{-9}$.
""",
        "ru": r"""
Найдите освещённость [Вт/м²], которую точечный источник создаёт на поверхности:
$$E = \frac{I \cos\theta}{d^2}, \qquad E = 0, \text{ если источник позади поверхности.}$$

- `intensity`: $I$ [Вт/ср], сила света в сторону поверхности;
- `distance`: $d > 0$ [м];
- `theta_deg`: угол $\theta$ между нормалью и направлением на источник, **в градусах**,
  $0 \le \theta \le 180$.

Числа или массивы равной длины. **Трудные входы:** $\theta$ отличается от 90° на $10^{-3}$–$10^{-10}$
градуса, и округление числа $\pi/2$ портит косинус; при 90° и больше верен в точности 0. Относительная
ошибка не должна превышать $10^{-9}$.
""",
    },
    reference=_lamp,
    ordinary=_lamps,
    hard=_grazing,
    terms=lambda intensity, distance, theta_deg: intensity / distance**2,
    variants={
        "pi-rounded": lambda intensity, distance, theta_deg: np.maximum(
            0.0, intensity * np.cos(theta_deg * 3.14 / 180) / distance**2
        ),
    },
    credit={"horizon-not-clamped": 0.5, "pi-rounded": 0.5},
    hints={
        "sine-forgotten": {
            "en": "You divided by sin θ, as the cotangent does: the cosine alone belongs there",
            "ru": "У вас деление на sin θ, как в котангенсе: нужен только косинус",
        },
        "sine-twice": {
            "en": "You have a sin θ too many: the cosine alone belongs there",
            "ru": "У вас лишний sin θ: нужен только косинус",
        },
        "cosine-twice": {
            "en": "The cosine enters once: the area that a beam falls on is 1/cos θ as large",
            "ru": "Косинус входит один раз: пучок ложится на площадь в 1/cos θ раз большую",
        },
        "horizon-not-clamped": CLAMP,
        "imprecise": {
            "en": "90° in radians is rounded: cos θ = sin(90° − θ), and degrees subtract without error",
            "ru": "90° в радианах округляются: cos θ = sin(90° − θ), а в градусах разность точна",
        },
    },
)
