"""Questions of assignment 3 on numbers: point lights, a sphere of light, the balance heuristic."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Part, Question
from radiokit.physics.view_factor import differential_to_sphere

__all__ = ["DIRECT_LIGHT", "MIS_WEIGHT", "SPHERE_IRRADIANCE"]

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
) -> Callable[..., Any]:
    """Return the sum over lights, or one with a misconception in it."""

    def total(f: Any, positions: Any, intensities: Any) -> Any:
        distance = np.sqrt(np.sum(positions**2, axis=-1))
        cosine = clamp(positions[..., 2] / distance)
        lit = np.sign(cosine) * np.abs(cosine) ** cosine_power
        return share * np.sum((f if brdf else 1.0) * intensities * lit / distance**distance_power, axis=-1)

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


# The balance heuristic


def _strategies(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "distance": rng.uniform(0.5, 5, 32),
        "cosine_light": rng.uniform(0.05, 1, 32),
        "area": rng.uniform(0.1, 4, 32),
        "pdf": rng.uniform(0.05, 8, 32),
    }


def _extreme_strategies(rng: np.random.Generator) -> dict[str, Any]:
    given = _strategies(rng)
    given["cosine_light"][:4] = 0.0
    given["pdf"][4:8] = 0.0
    given["area"][8:16] = 10 ** rng.uniform(-12, -6, 8)
    given["pdf"][16:24] = 10 ** rng.uniform(6, 12, 8)
    return given


def _balance(distance: Any, cosine_light: Any, area: Any, pdf: Any) -> Any:
    return distance**2 / (distance**2 + area * cosine_light * pdf)


def _weight_of(light: Callable[[Any, Any, Any], Any], power: float = 1.0) -> Callable[..., Any]:
    def weight(distance: Any, cosine_light: Any, area: Any, pdf: Any) -> Any:
        p = light(distance, np.maximum(cosine_light, 1e-300), area)
        with np.errstate(all="ignore"):
            return 1 / (1 + (pdf / p) ** power)

    return weight


_SLIPS_OF_WEIGHT: Mapping[str, Callable[..., Any]] = {
    "pdf-of-area": _weight_of(lambda d, c, a: 1 / a),
    "light-cosine-forgotten": _weight_of(lambda d, c, a: d**2 / a),
    "cosine-multiplied": _weight_of(lambda d, c, a: d**2 * c / a),
    "power-heuristic": _weight_of(lambda d, c, a: d**2 / (c * a), 2.0),
}

MIS_WEIGHT = Question(
    signature="mis_weight(distance, cosine_light, area, pdf)",
    points=1,
    title={"en": "The balance heuristic", "ru": "Балансная эвристика"},
    text={
        "en": "A direction was found by sampling a light uniformly over its `area` $A$: the point is at the "
        "`distance` $d$, the cosine at the light is `cosine_light` $= \\cos\\theta'$. Sampling the BRDF "
        "would have given it with the density `pdf` per solid angle. One sample is taken of each. Return "
        "the weight of the balance heuristic for the light's sample,\n\n"
        "$$w = \\frac{p_\\text{light}}{p_\\text{light} + p_\\text{BRDF}},$$\n\n"
        "with both densities per solid angle. All inputs are arrays of shape $(N,)$; $\\cos\\theta' = 0$ "
        "and $p_\\text{BRDF} = 0$ occur, and the weight is then 1.",
        "ru": "Направление получено равномерной выборкой источника по его площади `area` $= A$: точка "
        "находится на расстоянии `distance` $= d$, косинус у источника — `cosine_light` $= \\cos\\theta'$. "
        "Выборка по ДФО дала бы это направление с плотностью `pdf` по телесному углу. Берётся по одному "
        "отсчёту каждым способом. Верните вес балансной эвристики для отсчёта, взятого по источнику:\n\n"
        "$$w = \\frac{p_\\text{ист}}{p_\\text{ист} + p_\\text{ДФО}},$$\n\n"
        "где обе плотности — по телесному углу. Все входы — массивы формы $(N,)$; встречаются "
        "$\\cos\\theta' = 0$ и $p_\\text{ДФО} = 0$, тогда вес равен 1.",
    },
    parts=(
        Part(
            name="ordinary",
            judge=Values(inputs=_strategies, reference=_balance, rtol=1e-5, variants=_SLIPS_OF_WEIGHT),
        ),
        Part(
            name="hard",
            judge=Values(
                inputs=_extreme_strategies, reference=_balance, rtol=1e-5, variants=_SLIPS_OF_WEIGHT
            ),
        ),
    ),
    hints={
        **{
            name: {
                "en": "The distance has a wrong power somewhere: p_ω = p_A d²/cos θ', with the same d² above "
                "and below.",
                "ru": "Где-то не та степень расстояния: p_ω = p_A d²/cos θ', и в числителе, и в знаменателе "
                "одно и то же d².",
            }
            for name in (
                "distance-cubed",
                "distance-doubled",
                "distance-forgotten",
                "distance-not-squared",
                "distance-squared-twice",
            )
        },
        "cosine-multiplied": {
            "en": "p = p_A d²/cos θ': divide by the cosine at the light, do not multiply.",
            "ru": "p = p_A d²/cos θ': на косинус у источника нужно делить, а не умножать.",
        },
        "power-heuristic": {
            "en": "This is the power heuristic, with squares; the balance heuristic has none.",
            "ru": "Это степенная эвристика, с квадратами; в балансной их нет.",
        },
        "one-minus": {
            "en": "This is the weight of the BRDF's sample, 1 − w; that of the light's is asked for.",
            "ru": "Это вес отсчёта по ДФО, 1 − w; а нужен вес отсчёта по источнику.",
        },
    },
)
