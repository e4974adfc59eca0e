"""Questions of assignment 3 on numbers: point lights, a sphere of light, the balance heuristic."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part, Question
from radiokit.physics.view_factor import differential_to_sphere

__all__ = ["DIRECT_LIGHT", "SPHERE_IRRADIANCE"]

LIGHTS = 5
SECONDS = 20.0


# The lecture's sum over point lights


def _lights_above(rng: np.random.Generator) -> dict[str, Any]:
    albedo = rng.uniform(0.1, 0.9, (24, 1))
    x, y = rng.uniform(-2, 2, (2, 24, LIGHTS))
    return {
        "f": np.broadcast_to(albedo / np.pi, (24, LIGHTS)).copy(),
        "positions": np.stack([x, y, rng.uniform(0.5, 3, (24, LIGHTS))], axis=-1),
        "intensities": rng.uniform(1, 50, (24, LIGHTS)),
    }


def _lights_around(rng: np.random.Generator) -> dict[str, Any]:
    """Lights on either side of the surface, near and far, and a BRDF that differs from one to the next."""
    directions = rng.standard_normal((24, LIGHTS, 3))
    distance = 10 ** rng.uniform(-2, 2, (24, LIGHTS, 1))
    unit = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    return {
        "f": rng.uniform(0, 2, (24, LIGHTS)),
        "positions": unit * distance,
        "intensities": rng.uniform(0, 50, (24, LIGHTS)),
    }


def _sum_of(
    cosine_power: float = 1.0,
    distance_power: float = 2.0,
    *,
    clamp: Callable[[Any], Any] = lambda z: np.maximum(z, 0.0),
    brdf: bool = True,
    share: float = 1.0,
    lights: slice = slice(None),
) -> Callable[..., Any]:
    """Return the sum over lights, or one with a misconception in it."""

    def total(f: Any, positions: Any, intensities: Any) -> Any:
        distance = np.sqrt(np.sum(positions**2, axis=-1))
        cosine = clamp(positions[..., 2] / distance)
        lit = np.sign(cosine) * np.abs(cosine) ** cosine_power
        terms = (f if brdf else 1.0) * intensities * lit / distance**distance_power
        return share * np.sum(terms[..., lights], axis=-1)

    return total


_SLIPS_OF_SUM: Mapping[str, Callable[..., Any]] = {
    "horizon-not-clamped": _sum_of(clamp=lambda z: z),
    "cosine-absolute": _sum_of(clamp=np.abs),
    "cosine-forgotten": _sum_of(0.0),
    "cosine-twice": _sum_of(2.0),
    "distance-forgotten": _sum_of(1.0, 0.0),
    "distance-not-squared": _sum_of(1.0, 1.0),
    "distance-cubed": _sum_of(1.0, 3.0),
    "brdf-forgotten": _sum_of(brdf=False),
    "mean-of-lights": _sum_of(share=1 / LIGHTS),
    "sum-clamped": lambda f, positions, intensities: np.maximum(
        _sum_of(clamp=lambda z: z)(f, positions, intensities), 0.0
    ),
    "cosine-and-distance": _sum_of(0.0, 1.0),
    "last-light-forgotten": _sum_of(lights=slice(None, -1)),
    "first-light-forgotten": _sum_of(lights=slice(1, None)),
    "last-light-alone": _sum_of(lights=slice(-1, None)),
    "first-light-alone": _sum_of(lights=slice(1)),
}

DIRECT_LIGHT = Question(
    signature="direct_light(f, positions, intensities)",
    points=3,
    title={"en": "A sum over point lights", "ru": "Сумма по точечным источникам"},
    text={
        "en": "A surface lies at the origin, its normal is $z$. Light $j$ is a point at $\\mathbf p_j$ "
        "(`positions`, shape $(N, K, 3)$, in metres) of the intensity $I_j$ (`intensities`, $(N, K)$, in "
        "W/sr). The BRDF's value for the direction to it is $f_j$ (`f`, $(N, K)$, in 1/sr; $\\rho/\\pi$ for "
        "a diffuse surface). Return the reflected radiance, shape $(N,)$:\n\n"
        "$$L_o = \\sum_{j=1}^{K} f_j \\, \\frac{I_j \\max(0, \\cos\\theta_j)}{d_j^2}.$$\n\n"
        "This is the lecture's sum for the discrete case; what stands there as $L_j$ is the irradiance "
        "$I_j/d_j^2$ on a plane normal to the ray. Lights below the horizon give nothing. A function for "
        "one point ($N$ left out) is accepted too.",
        "ru": "Поверхность проходит через начало координат, её нормаль — $z$. Источник $j$ — точка "
        "$\\mathbf p_j$ (`positions`, форма $(N, K, 3)$, в метрах) с силой света $I_j$ (`intensities`, $(N, "
        "K)$, Вт/ср). Значение ДФО для направления на него — $f_j$ (`f`, $(N, K)$, 1/ср; для диффузной "
        "поверхности $\\rho/\\pi$). Верните яркость отражённого света, форма $(N,)$:\n\n"
        "$$L_o = \\sum_{j=1}^{K} f_j \\, \\frac{I_j \\max(0, \\cos\\theta_j)}{d_j^2}.$$\n\n"
        "Это сумма из лекции для дискретного случая; то, что там обозначено $L_j$, — освещённость "
        "$I_j/d_j^2$ площадки, перпендикулярной лучу. Источники под горизонтом вклада не дают. Принимается "
        "и функция для одной точки (без $N$).",
    },
    parts=(
        Part(
            name="ordinary",
            judge=Values(inputs=_lights_above, reference=_sum_of(), rtol=1e-5, variants=_SLIPS_OF_SUM),
        ),
        Part(
            name="hard",
            judge=Values(inputs=_lights_around, reference=_sum_of(), rtol=1e-5, variants=_SLIPS_OF_SUM),
        ),
    ),
    hints={
        "cosine-absolute": {
            "en": "Lights below the horizon count in your sum: take max(0, cos θ), not |cos θ|.",
            "ru": "Источники под горизонтом попали в сумму: нужен max(0, cos θ), а не |cos θ|.",
        },
        "brdf-forgotten": {
            "en": "You gave the irradiance: each term is still to be multiplied by the BRDF.",
            "ru": "Получилась освещённость: каждое слагаемое нужно ещё умножить на ДФО.",
        },
        "sum-clamped": {
            "en": "You clamped the whole sum: each cosine is to be cut off at 0 by itself.",
            "ru": "Вы обнулили всю сумму: каждый косинус нужно ограничивать нулём отдельно.",
        },
        "cosine-and-distance": {
            "en": "Two mistakes at once: the cosine is missing, and the distance is not squared.",
            "ru": "Две ошибки сразу: нет косинуса, и расстояние не в квадрате.",
        },
        "last-light-forgotten": {
            "en": "The last light is missing from your sum: range(K) ends at K − 1 by itself.",
            "ru": "В сумме нет последнего источника: range(K) и так кончается на K − 1.",
        },
        "first-light-forgotten": {
            "en": "The first light is missing from your sum: indices begin at 0.",
            "ru": "В сумме нет первого источника: индексы начинаются с 0.",
        },
        "last-light-alone": {
            "en": "Only the last light counts in your answer: add each term, += in place of =.",
            "ru": "В ответ вошёл только последний источник: слагаемые нужно прибавлять, += вместо =.",
        },
        "first-light-alone": {
            "en": "Only the first light counts in your answer: does return stand inside the loop?",
            "ru": "В ответ вошёл только первый источник: не стоит ли return внутри цикла?",
        },
        "mean-of-lights": {
            "en": "You took the mean over the lights: their contributions add up.",
            "ru": "Вы взяли среднее по источникам, а их вклады складываются.",
        },
    },
)


# A sphere of light, by quadrature


def _balls_above(rng: np.random.Generator) -> dict[str, Any]:
    half_angle = rng.uniform(0.02, 0.8, 12)
    return {"theta": rng.uniform(0, 0.95, 12) * (np.pi / 2 - half_angle), "half_angle": half_angle}


def _balls_cut(rng: np.random.Generator) -> dict[str, Any]:
    half_angle = rng.uniform(0.1, 1.2, 12)
    theta = np.pi / 2 + rng.uniform(-0.8, 0.4, 12) * half_angle
    theta[:2] = np.pi / 2 + 1.2 * half_angle[:2]
    return {"theta": theta, "half_angle": half_angle}


def _ball(theta: Any, half_angle: Any) -> Any:
    turned = np.abs((theta + np.pi) % (2 * np.pi) - np.pi)  # a diagnosis tries degrees for radians
    return np.pi * differential_to_sphere(radius=np.sin(half_angle), distance=1.0, tilt=turned)


def _solid_angle(half_angle: Any) -> Any:
    return 4 * np.pi * np.sin(half_angle / 2) ** 2


def _lit(theta: Any) -> Any:
    return np.maximum(np.cos(theta), 0.0)


_SLIPS_OF_BALL: Mapping[str, Callable[..., Any]] = {
    "cosine-forgotten": lambda theta, half_angle: _solid_angle(half_angle) + 0 * theta,
    "small-light": lambda theta, half_angle: _solid_angle(half_angle) * _lit(theta),
    "full-angle": lambda theta, half_angle: _ball(theta, half_angle / 2),
    "angle-unit": lambda theta, half_angle: _ball(np.radians(theta), np.radians(half_angle)),
    "sine-forgotten": lambda theta, half_angle: 2 * np.pi * np.sin(half_angle) * _lit(theta),
    "horizon-not-clamped": lambda theta, half_angle: np.pi * np.sin(half_angle) ** 2 * np.cos(theta),
    "whole-or-nothing": lambda theta, half_angle: np.pi * np.sin(half_angle) ** 2 * _lit(theta),
}

SPHERE_IRRADIANCE = Question(
    signature="sphere_irradiance(theta, half_angle)",
    points=3,
    title={"en": "The irradiance from a sphere", "ru": "Освещённость от светящегося шара"},
    text={
        "en": "A glowing sphere of radiance 1 W/(m² sr) is seen from a point as a disk of the angular "
        "radius `half_angle`; its centre stands at the angle `theta` from the normal (both in radians, "
        "arrays of shape $(N,)$). Compute the irradiance by quadrature,\n\n"
        "$$E = \\int_{\\Omega} L \\max(0, \\cos\\theta)\\, d\\omega,$$\n\n"
        "to a relative error of $10^{-3}$. The horizon may cut the sphere; what lies below it gives no "
        "light.",
        "ru": "Светящийся шар яркости 1 Вт/(м²·ср) виден из точки как диск углового радиуса `half_angle`; "
        "его центр находится под углом `theta` к нормали (оба угла в радианах, массивы формы $(N,)$). "
        "Вычислите освещённость численным интегрированием,\n\n"
        "$$E = \\int_{\\Omega} L \\max(0, \\cos\\theta)\\, d\\omega,$$\n\n"
        "с относительной погрешностью $10^{-3}$. Горизонт может пересекать шар; то, что ниже горизонта, не "
        "светит.",
    },
    parts=(
        Part(
            name="ordinary",
            weight=2,
            judge=Values(
                inputs=_balls_above,
                reference=_ball,
                rtol=1e-3,
                loose={1e-2: 0.5},
                variants=_SLIPS_OF_BALL,
            ),
        ),
        Part(
            name="hard",
            judge=Values(
                inputs=_balls_cut,
                reference=_ball,
                rtol=1e-3,
                atol=1e-6,
                loose={1e-2: 0.5},
                variants=_SLIPS_OF_BALL,
            ),
        ),
    ),
    hints={
        "full-angle": {
            "en": "The angular radius is half of the sphere's angle already: do not halve it again.",
            "ru": "Угловой радиус — это уже половина углового размера шара: не делите его ещё раз на 2.",
        },
        "small-light": {
            "en": "You multiplied the solid angle by the cosine at the centre: that holds for small lights "
            "only; here the cosine varies over the light.",
            "ru": "Вы умножили телесный угол на косинус в центре: это верно лишь для малых источников, а "
            "здесь косинус меняется по источнику.",
        },
        "whole-or-nothing": {
            "en": "E = π sin²α cos θ holds for a sphere that is wholly above the horizon: where the horizon "
            "cuts it, the clamp belongs under the integral.",
            "ru": "E = π sin²α cos θ верно, лишь если шар целиком над горизонтом: когда горизонт его "
            "пересекает, max(0, cos θ) нужно брать под интегралом.",
        },
    },
    seconds=SECONDS,
)
