"""Assignment 3: light from points, spheres and windows on a surface; Monte Carlo with an honest error."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.contracts.emitter import emitter
from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.estimator import Estimator
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.sampler import Sampler
from radiokit.faces.grading.values import Values
from radiokit.measure.gauss import gauss_legendre
from radiokit.physics.view_factor import differential_to_sphere

__all__ = ["ASSIGNMENT"]

LIGHTS = 5
SECONDS = 20.0


# 1. The lecture's sum over point lights


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


_SLIPS_OF_SUM: dict[str, Callable[..., Any]] = {
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
            judge=Values(
                inputs=_lights_above, reference=_sum_of(), rtol=1e-5, variants=_SLIPS_OF_SUM, credit={}
            ),
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


# 2. A sphere of light, by quadrature


def _balls_above(rng: np.random.Generator) -> dict[str, Any]:
    half_angle = rng.uniform(0.02, 0.8, 12)
    return {"theta": rng.uniform(0, 0.95, 12) * (np.pi / 2 - half_angle), "half_angle": half_angle}


def _balls_cut(rng: np.random.Generator) -> dict[str, Any]:
    half_angle = rng.uniform(0.1, 1.2, 12)
    theta = np.pi / 2 + rng.uniform(-0.8, 0.4, 12) * half_angle
    theta[:2] = np.pi / 2 + 1.2 * half_angle[:2]
    return {"theta": theta, "half_angle": half_angle}


def _ball(theta: Any, half_angle: Any) -> Any:
    return np.pi * differential_to_sphere(radius=np.sin(half_angle), distance=1.0, tilt=theta)


def _sphere_sine_forgotten(theta: Any, half_angle: Any) -> Any:
    return 2 * np.pi * np.sin(half_angle) * np.maximum(np.cos(theta), 0.0)


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
                variants={
                    "cosine-forgotten": lambda theta, half_angle: (
                        4 * np.pi * np.sin(half_angle / 2) ** 2 + 0 * theta
                    ),
                    "small-light": lambda theta, half_angle: (
                        4 * np.pi * np.sin(half_angle / 2) ** 2 * np.cos(theta)
                    ),
                    "sine-forgotten": _sphere_sine_forgotten,
                },
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
                variants={
                    "horizon-not-clamped": lambda theta, half_angle: (
                        np.pi * np.sin(half_angle) ** 2 * np.cos(theta)
                    ),
                    "whole-or-nothing": lambda theta, half_angle: (
                        np.pi * np.sin(half_angle) ** 2 * np.maximum(np.cos(theta), 0.0)
                    ),
                },
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


# 3. The furnace


def _albedos(rng: np.random.Generator) -> dict[str, Any]:
    return {"albedo": rng.uniform(0.2, 1.0)}


_FURNACE: dict[str, Any] = {
    "inputs": _albedos,
    "reference": lambda albedo: albedo,
    "context": lambda albedo: {"pdf": 1 / (2 * math.pi)},
    "variants": {
        "cosine-forgotten": lambda albedo: 2 * albedo,
        "cosine-twice": lambda albedo: 2 * albedo / 3,
        "two-pi-too-few": lambda albedo: albedo / (2 * math.pi),
    },
}

FURNACE = Question(
    signature="furnace(albedo, samples, seed)",
    points=3,
    title={"en": "A furnace by Monte Carlo", "ru": "Белая печь методом Монте-Карло"},
    text={
        "en": "Around a diffuse surface, $f = \\rho/\\pi$, the radiance is 1 from everywhere, so that it "
        "reflects exactly $L_o = \\int f \\cos\\theta\\, d\\omega = \\rho$. Estimate this with `samples` "
        "directions, uniform over the hemisphere, and return two numbers, `value, standard_error`. The "
        "standard error is that of the mean: $s/\\sqrt N$, where $s$ is the deviation of the samples' "
        "weights $f\\cos\\theta/p$. Draw from `numpy.random.default_rng(seed)`: the same seed gives the "
        "same answer.\n\n"
        "The function is run with many seeds: their mean must be $\\rho$, their spread must be what the "
        "standard error says, and four times as many samples must halve it.",
        "ru": "Вокруг диффузной поверхности, $f = \\rho/\\pi$, яркость отовсюду равна 1, поэтому отражается "
        "ровно $L_o = \\int f \\cos\\theta\\, d\\omega = \\rho$. Оцените эту величину по `samples` "
        "направлениям, равномерно распределённым по полусфере, и верните два числа: `value, "
        "standard_error`. Стандартная ошибка — это ошибка среднего, $s/\\sqrt N$, где $s$ — "
        "среднеквадратичное отклонение весов отсчётов $f\\cos\\theta/p$. Случайные числа берите из "
        "`numpy.random.default_rng(seed)`: при том же seed ответ должен быть тем же.\n\n"
        "Функция запускается с многими seed: среднее должно быть равно $\\rho$, разброс — заявленной "
        "стандартной ошибке, а при вчетверо большем числе отсчётов он должен уменьшаться вдвое.",
    },
    parts=(
        Part(name="unbiased", weight=2, judge=Estimator(**_FURNACE)),
        Part(name="honest", judge=Estimator(**_FURNACE, aspect="error")),
    ),
    seconds=SECONDS,
)


# 4. Cosine-weighted directions


def _cosine_density(directions: Any) -> Any:
    return np.maximum(directions[:, 2], 0.0) / np.pi


def _disk_without_root(directions: Any) -> Any:
    radius = np.hypot(directions[:, 0], directions[:, 1])
    return np.maximum(directions[:, 2], 0.0) / (2 * np.pi * np.maximum(radius, 1e-12))


def _uniform_angle(directions: Any) -> Any:
    radius = np.hypot(directions[:, 0], directions[:, 1])
    return (directions[:, 2] > 0) / (np.pi**2 * np.maximum(radius, 1e-12))


_SEEDLESS = {
    "en": "`u` is an array of shape $(N, 2)$ of random numbers in $[0, 1)$: draw none yourself. Rows go "
    "their own way: direction $i$ follows from `u[i]` alone.",
    "ru": "`u` — массив формы $(N, 2)$ случайных чисел из $[0, 1)$; сами случайных чисел не берите. "
    "Направление $i$ определяется только строкой `u[i]`.",
}

COSINE_SAMPLE = Question(
    signature="cosine_sample(u)",
    points=2,
    title={"en": "Cosine-weighted directions", "ru": "Направления с плотностью cos θ/π"},
    text={
        "en": "Write two functions: `cosine_sample(u)` returns unit vectors, shape $(N, "
        "3)$, of the density $p(\\omega) = \\cos\\theta/\\pi$ about the normal $z$; "
        "`cosine_pdf(directions)` returns this density, shape $(N,)$, and 0 below the "
        "horizon. " + _SEEDLESS["en"],
        "ru": "Напишите две функции: `cosine_sample(u)` возвращает единичные векторы, "
        "форма $(N, 3)$, с плотностью $p(\\omega) = \\cos\\theta/\\pi$ относительно "
        "нормали $z$; `cosine_pdf(directions)` возвращает эту плотность, форма $(N,)$, а "
        "под горизонтом — 0. " + _SEEDLESS["ru"],
    },
    parts=(
        Part(
            name="distribution",
            weight=3,
            judge=Sampler(
                density=_cosine_density,
                pdf="cosine_pdf",
                variants={"root-forgotten": _disk_without_root, "angle-uniform": _uniform_angle},
            ),
        ),
        Part(
            name="normalisation",
            judge=Sampler(density=_cosine_density, pdf="cosine_pdf", aspect="density"),
        ),
    ),
    hints={
        "angle-uniform": {
            "en": "Your θ is uniform in [0, π/2]; solid angle is sin θ dθ dφ, and the cosine comes on top.",
            "ru": "У вас θ равномерно распределён на [0, π/2]; но телесный угол — это sin θ dθ dφ, и ещё "
            "нужен косинус.",
        },
    },
    seconds=SECONDS,
)


# 5. Phong's lobe


def _exponents(rng: np.random.Generator) -> dict[str, Any]:
    return {"exponent": rng.uniform(5, 80)}


def _lobe_of(shift: float, over: float) -> Callable[..., Any]:
    """Return the density (n + over)/(2π) cosⁿ⁺ˢʰⁱᶠ θ."""

    def density(directions: Any, exponent: Any) -> Any:
        cosine = np.maximum(directions[:, 2], 0.0)
        return (exponent + over) / (2 * np.pi) * cosine ** (exponent + shift)

    return density


LOBE_SAMPLE = Question(
    signature="lobe_sample(u, exponent)",
    points=2.5,
    title={"en": "Phong's lobe", "ru": "Лепесток Фонга"},
    text={
        "en": "Write `lobe_sample(u, exponent)`, which returns unit vectors, shape $(N, "
        "3)$, whose density is proportional to $\\cos^n\\theta$ about $z$, with $n$ = "
        "`exponent`, above the horizon; and `lobe_pdf(directions, exponent)`, which "
        "returns this density per solid angle, shape $(N,)$, normalised so that its "
        "integral over the hemisphere is 1, and 0 below the horizon. " + _SEEDLESS["en"],
        "ru": "Напишите `lobe_sample(u, exponent)`, возвращающую единичные векторы, форма "
        "$(N, 3)$, с плотностью, пропорциональной $\\cos^n\\theta$ относительно $z$, где "
        "$n$ = `exponent`, только над горизонтом; и `lobe_pdf(directions, exponent)`, "
        "возвращающую эту плотность по телесному углу, форма $(N,)$, нормированную так, "
        "что её интеграл по полусфере равен 1, а под горизонтом — 0. " + _SEEDLESS["ru"],
    },
    parts=(
        Part(
            name="distribution",
            weight=3,
            judge=Sampler(
                density=_lobe_of(0, 1),
                inputs=_exponents,
                pdf="lobe_pdf",
                variants={"exponent-without-sine": _lobe_of(-1, 0), "exponent-with-cosine": _lobe_of(1, 2)},
            ),
        ),
        Part(
            name="normalisation",
            weight=2,
            judge=Sampler(
                density=_lobe_of(0, 1),
                inputs=_exponents,
                pdf="lobe_pdf",
                aspect="density",
                variants={"lobe-normalisation": _lobe_of(0, 2)},
            ),
        ),
    ),
    hints={
        "exponent-without-sine": {
            "en": "cos θ = u^(1/n) gives cosⁿ⁻¹θ: solid angle is d(cos θ) dφ, so that the root is the "
            "(n+1)-th.",
            "ru": "cos θ = u^(1/n) даёт cosⁿ⁻¹θ: телесный угол — это d(cos θ) dφ, поэтому нужен корень "
            "степени n + 1.",
        },
        "exponent-with-cosine": {
            "en": "Your directions follow cosⁿ⁺¹θ, the lobe times a cosine: cosⁿθ alone is asked for.",
            "ru": "Ваши направления распределены как cosⁿ⁺¹θ, то есть лепесток, умноженный на косинус: "
            "нужен один cosⁿθ.",
        },
        "lobe-normalisation": {
            "en": "(n+2)/2π normalises Phong's BRDF, where a cosine is under the integral; a density has "
            "(n+1)/2π.",
            "ru": "(n+2)/2π нормирует ДФО Фонга, где под интегралом ещё косинус; у плотности множитель "
            "(n+1)/2π.",
        },
    },
    seconds=SECONDS,
)


# 6. A glossy surface, importance sampled


def _skies(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "exponent": rng.uniform(15, 60),
        "zenith": rng.uniform(0.5, 2.0),
        "side": rng.uniform(0.2, 1.0),
    }


def _glossy(exponent: Any, zenith: Any, side: Any) -> Any:
    return zenith * (exponent + 2) / (exponent + 3) + side


def _glossy_uniform(exponent: Any, zenith: Any, side: Any) -> float:
    """Return the variance of (2π) f L cos θ for a uniform direction; ∫ z^m dz over [0, 1] is 1/(m + 1)."""
    n, a, b = float(exponent), float(zenith), float(side)
    even = a * a / (2 * n + 5) + 2 * a * b / (2 * n + 4) + b * b / (2 * n + 3)
    odd = b * b / 2 * (1 / (2 * n + 3) - 1 / (2 * n + 5))
    return (n + 2) ** 2 * (even + odd) - float(_glossy(n, a, b)) ** 2


_GLOSSY: dict[str, Any] = {
    "inputs": _skies,
    "reference": _glossy,
    "variants": {
        "cosine-forgotten": lambda exponent, zenith, side: zenith + side * (exponent + 2) / (exponent + 1),
        "cosine-twice": lambda exponent, zenith, side: (
            (exponent + 2) * (zenith / (exponent + 4) + side / (exponent + 3))
        ),
        "lobe-normalisation": lambda exponent, zenith, side: (
            _glossy(exponent, zenith, side) * (exponent + 1) / (exponent + 2)
        ),
        "pdf-normalisation": lambda exponent, zenith, side: (
            _glossy(exponent, zenith, side) * (exponent + 2) / (exponent + 1)
        ),
    },
}

GLOSSY = Question(
    signature="glossy(exponent, zenith, side, samples, seed)",
    points=3,
    title={"en": "A glossy surface", "ru": "Глянцевая поверхность"},
    text={
        "en": "A glossy surface of the BRDF $f = \\frac{n+2}{2\\pi}\\cos^n\\alpha$ is seen along its "
        "normal, so that the mirror direction is $z$ and $\\alpha = \\theta$; $n$ = `exponent`. The light "
        "that falls on it from the direction $(x, y, z)$ has the radiance $L = $ `zenith` $\\cdot z\\ +$ "
        "`side` $\\cdot (1 + x)$. Estimate\n\n"
        "$$L_o = \\int f L \\cos\\theta\\, d\\omega$$\n\n"
        "with `samples` directions and return `value, standard_error`. Sample the lobe, not the hemisphere: "
        "the variance must be at most a tenth of what uniform directions give.",
        "ru": "Глянцевая поверхность с ДФО $f = \\frac{n+2}{2\\pi}\\cos^n\\alpha$ видна вдоль нормали, так "
        "что зеркальное направление — $z$ и $\\alpha = \\theta$; $n$ = `exponent`. Свет, падающий с "
        "направления $(x, y, z)$, имеет яркость $L = $ `zenith` $\\cdot z\\ +$ `side` $\\cdot (1 + x)$. "
        "Оцените\n\n"
        "$$L_o = \\int f L \\cos\\theta\\, d\\omega$$\n\n"
        "по `samples` направлениям и верните `value, standard_error`. Выбирайте направления по лепестку, а "
        "не равномерно по полусфере: дисперсия должна составлять не более одной десятой от той, какую дают "
        "равномерные направления.",
    },
    parts=(
        Part(name="unbiased", judge=Estimator(**_GLOSSY)),
        Part(name="honest", judge=Estimator(**_GLOSSY, aspect="error")),
        Part(
            name="efficiency",
            judge=Estimator(
                **_GLOSSY,
                aspect="efficiency",
                uniform=_glossy_uniform,
                budget=lambda **inputs: _glossy_uniform(**inputs) / 10,
            ),
        ),
    ),
    hints={
        "pdf-normalisation": {
            "en": "You divided by cosⁿθ · (n+1)²/(2π(n+2)) or the like: the density of the lobe is (n+1)/2π "
            "cosⁿθ.",
            "ru": "Плотность лепестка неверно нормирована: она равна (n+1)/2π cosⁿθ.",
        },
        "lobe-normalisation": {
            "en": "The BRDF has the factor (n+2)/2π, and the density (n+1)/2π: they do not cancel.",
            "ru": "У ДФО множитель (n+2)/2π, а у плотности (n+1)/2π: они не сокращаются.",
        },
    },
    seconds=SECONDS,
)


# 7. A window, sampled by area


def _windows(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "distance": rng.uniform(1.0, 3.0),
        "width": rng.uniform(0.5, 3.0),
        "height": rng.uniform(0.5, 2.5),
    }


def _window(distance: Any, width: Any, height: Any) -> float:
    light = emitter(
        "rectangle",
        center=(float(distance), 0.0, float(height) / 2),
        normal=(-1.0, 0.0, 0.0),
        up=(0.0, 0.0, 1.0),
        width=float(width),
        height=float(height),
        radiance=1.0,
    )
    return float(light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value)


def _over_window(kernel: Callable[[Any, Any, Any], Any]) -> Callable[..., float]:
    """Return the integral over the window's area of ``kernel(x, z, d)``."""

    def integral(distance: Any, width: Any, height: Any) -> float:
        t, weight = gauss_legendre(40)
        y, z = np.meshgrid((t - 0.5) * width, t * height, indexing="ij")
        d = np.sqrt(distance**2 + y**2 + z**2)
        return float(width * height * (weight @ kernel(distance, z, d) @ weight))

    return integral


_WINDOW: dict[str, Any] = {
    "inputs": _windows,
    "reference": _window,
    "variants": {
        "light-cosine-forgotten": _over_window(lambda x, z, d: z / d**3),
        "cosine-forgotten": _over_window(lambda x, z, d: x / d**3),
        "distance-forgotten": _over_window(lambda x, z, d: x * z / d**2),
        "distance-not-squared": _over_window(lambda x, z, d: x * z / d**3),
        "pdf-of-area": _over_window(lambda x, z, d: z / d),
        "pdf-forgotten": lambda distance, width, height: _window(distance, width, height) / (width * height),
    },
}

WINDOW = Question(
    signature="window(distance, width, height, samples, seed)",
    points=2.5,
    title={"en": "A window, sampled by area", "ru": "Окно: выборка по площади"},
    text={
        "en": "You stand at the origin of a floor, its normal is $z$. A window of radiance 1 W/(m² sr) "
        "fills the rectangle $x =$ `distance`, $|y| \\le$ `width`$/2$, $0 \\le z \\le$ `height` and shines "
        "towards you. Estimate the irradiance of the floor, with `samples` points uniform over the window's "
        "area, by\n\n"
        "$$E = \\int L \\cos\\theta\\, d\\omega = \\int_A L\\, \\frac{\\cos\\theta \\cos\\theta'}{d^2}\\, "
        "dA,$$\n\n"
        "where $\\theta'$ is the angle at the window, and return `value, standard_error`. Per solid angle "
        "these points have the density $p_\\omega = p_A\\, d^2/\\cos\\theta'$ with $p_A = 1/A$.",
        "ru": "Вы стоите на полу в начале координат, нормаль пола — $z$. Окно яркости 1 Вт/(м²·ср) занимает "
        "прямоугольник $x =$ `distance`, $|y| \\le$ `width`$/2$, $0 \\le z \\le$ `height` и светит в вашу "
        "сторону. Оцените освещённость пола по `samples` точкам, равномерно распределённым по площади "
        "окна:\n\n"
        "$$E = \\int L \\cos\\theta\\, d\\omega = \\int_A L\\, \\frac{\\cos\\theta \\cos\\theta'}{d^2}\\, "
        "dA,$$\n\n"
        "где $\\theta'$ — угол при окне, и верните `value, standard_error`. По телесному углу плотность "
        "этих точек равна $p_\\omega = p_A\\, d^2/\\cos\\theta'$, где $p_A = 1/A$.",
    },
    parts=(
        Part(name="unbiased", weight=3, judge=Estimator(**_WINDOW)),
        Part(name="honest", weight=2, judge=Estimator(**_WINDOW, aspect="error")),
    ),
    hints={
        "pdf-forgotten": {
            "en": "You did not divide by the density 1/A: multiply the mean by the window's area.",
            "ru": "Вы не разделили на плотность 1/A: умножьте среднее на площадь окна.",
        },
        "pdf-of-area": {
            "en": "You took the density per area, 1/A, for one per solid angle: cos θ'/d² is missing.",
            "ru": "Вы приняли плотность по площади 1/A за плотность по телесному углу: не хватает cos θ'/d².",
        },
    },
    seconds=SECONDS,
)


# 8. The balance heuristic


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
    "other-strategy": lambda **inputs: 1 - _balance(**inputs),
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
        "cosine-multiplied": {
            "en": "p = p_A d²/cos θ': divide by the cosine at the light, do not multiply.",
            "ru": "p = p_A d²/cos θ': на косинус у источника нужно делить, а не умножать.",
        },
        "power-heuristic": {
            "en": "This is the power heuristic, with squares; the balance heuristic has none.",
            "ru": "Это степенная эвристика, с квадратами; в балансной их нет.",
        },
        "other-strategy": {
            "en": "This is the weight of the BRDF's sample, 1 − w; that of the light's is asked for.",
            "ru": "Это вес отсчёта по ДФО, 1 − w; а нужен вес отсчёта по источнику.",
        },
    },
)


ASSIGNMENT = Assignment(
    name="shading",
    title={"en": "Assignment 3: shading and Monte Carlo", "ru": "Задание 3: расчёт освещения и Монте-Карло"},
    intro={
        "en": "What a point of a surface sends to the viewer: first a sum over point lights, then an "
        "integral over large ones, by quadrature and by Monte Carlo. Every estimate comes with its standard "
        "error, and the error is judged as well as the value. Write each function under the name that is "
        "given; NumPy is there. Loops are allowed, and arrays are faster.",
        "ru": "Сколько света точка поверхности посылает наблюдателю: сначала сумма по точечным источникам, "
        "затем интеграл по протяжённым — квадратурой и методом Монте-Карло. К каждой оценке прилагается "
        "стандартная ошибка, и проверяется не только значение, но и ошибка. Пишите функции под указанными "
        "именами; NumPy доступен. Циклы разрешены, но с массивами быстрее.",
    },
    questions=(
        DIRECT_LIGHT,
        SPHERE_IRRADIANCE,
        FURNACE,
        COSINE_SAMPLE,
        LOBE_SAMPLE,
        GLOSSY,
        WINDOW,
        MIS_WEIGHT,
    ),
)
