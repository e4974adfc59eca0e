"""Questions of assignment 3 on Monte Carlo with its error: a furnace, a glossy surface, a window."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.contracts.emitter import emitter
from radiokit.faces.grading.judges.estimator import Estimator
from radiokit.faces.grading.question import Part, Question
from radiokit.measure.gauss import gauss_legendre

__all__ = ["FURNACE", "GLOSSY", "WINDOW"]

SECONDS = 20.0


# The furnace


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
        "density-of-sphere": lambda albedo: 2 * albedo,
        "angle-uniform": lambda albedo: 4 * albedo / math.pi,
    },
}

FURNACE = Question(
    signature="furnace(albedo, samples, seed)",
    points=3,
    title={"en": "A furnace by Monte Carlo", "ru": "Белая печь методом Монте-Карло"},
    text={
        "en": "Around a diffuse surface, $f = \\rho/\\pi$ with $\\rho$ = `albedo`, the radiance is 1 from "
        "everywhere, so that it reflects exactly $L_o = \\int f \\cos\\theta\\, d\\omega = \\rho$. Estimate "
        "this with `samples` directions, uniform over the hemisphere, and return two numbers, `value, "
        "standard_error`. The standard error is that of the mean: $s/\\sqrt N$, where $s$ is the deviation "
        "of the samples' weights $f\\cos\\theta/p$. Draw from `numpy.random.default_rng(seed)`: the same "
        "seed gives the same answer.\n\n"
        "The function is run with many seeds: their mean must be $\\rho$, their spread must be what the "
        "standard error says, and four times as many samples must halve it.",
        "ru": "Вокруг диффузной поверхности, $f = \\rho/\\pi$, где $\\rho$ = `albedo`, яркость отовсюду "
        "равна 1, поэтому отражается ровно $L_o = \\int f \\cos\\theta\\, d\\omega = \\rho$. Оцените эту "
        "величину по `samples` направлениям, равномерно распределённым по полусфере, и верните два числа: "
        "`value, standard_error`. Стандартная ошибка — это ошибка среднего, $s/\\sqrt N$, где $s$ — "
        "среднеквадратичное отклонение весов отсчётов $f\\cos\\theta/p$. Случайные числа берите из "
        "`numpy.random.default_rng(seed)`: при том же seed ответ должен быть тем же.\n\n"
        "Функция запускается с многими seed: среднее должно быть равно $\\rho$, разброс — заявленной "
        "стандартной ошибке, а при вчетверо большем числе отсчётов он должен уменьшаться вдвое.",
    },
    parts=(
        Part(name="unbiased", weight=2, judge=Estimator(**_FURNACE)),
        Part(name="honest", judge=Estimator(**_FURNACE, aspect="error")),
    ),
    hints={
        "density-of-sphere": {
            "en": "You divided by 1/4π, the density of the whole sphere: that of the hemisphere is 1/2π.",
            "ru": "Вы разделили на 1/4π, плотность для всей сферы: для полусферы она равна 1/2π.",
        },
        "angle-uniform": {
            "en": "Your θ is uniform in [0, π/2]: for uniform directions it is cos θ that is uniform.",
            "ru": "У вас равномерно распределён θ на [0, π/2]: у равномерных направлений равномерен cos θ.",
        },
        "halved": {
            "en": "Your value is half of the right one: the density is twice 1/2π, or half of your "
            "directions lie below the horizon, or the like.",
            "ru": "Ваше значение вдвое меньше верного: плотность вдвое больше 1/2π, половина направлений под "
            "горизонтом или подобное.",
        },
    },
    seconds=SECONDS,
)


# A glossy surface, importance sampled


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


def _lobe_twice(exponent: Any, zenith: Any, side: Any) -> Any:
    """Return the mean of f L cos θ over directions of the lobe's density, by which it is not divided."""
    whole = zenith / (2 * exponent + 3) + side / (2 * exponent + 2)
    return (exponent + 1) * (exponent + 2) / (2 * math.pi) * whole


_GLOSSY: dict[str, Any] = {
    "exact": False,
    "alike": False,
    "inputs": _skies,
    "reference": _glossy,
    "variants": {
        "cosine-forgotten": lambda exponent, zenith, side: zenith + side * (exponent + 2) / (exponent + 1),
        "cosine-twice": lambda exponent, zenith, side: (
            (exponent + 2) * (zenith / (exponent + 4) + side / (exponent + 3))
        ),
        "pdf-forgotten": lambda exponent, zenith, side: _lobe_twice(exponent, zenith, side),
        "uniform-density": lambda exponent, zenith, side: 2 * math.pi * _lobe_twice(exponent, zenith, side),
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
        "with `samples` directions, drawn from `seed` as in the furnace, and return `value, "
        "standard_error`. Sample the lobe, not the hemisphere: the variance must be at most a tenth of what "
        "uniform directions give.",
        "ru": "Глянцевая поверхность с ДФО $f = \\frac{n+2}{2\\pi}\\cos^n\\alpha$ видна вдоль нормали, так "
        "что зеркальное направление — $z$ и $\\alpha = \\theta$; $n$ = `exponent`. Свет, падающий с "
        "направления $(x, y, z)$, имеет яркость $L = $ `zenith` $\\cdot z\\ +$ `side` $\\cdot (1 + x)$. "
        "Оцените\n\n"
        "$$L_o = \\int f L \\cos\\theta\\, d\\omega$$\n\n"
        "по `samples` направлениям, взятым из `seed`, как и в белой печи, и верните `value, "
        "standard_error`. Выбирайте направления по лепестку, а не равномерно по полусфере: дисперсия должна "
        "составлять не более одной десятой от той, какую дают равномерные направления.",
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
        "pdf-forgotten": {
            "en": "You did not divide by the density (n+1)/2π cosⁿθ of your directions.",
            "ru": "Вы не разделили на плотность (n+1)/2π cosⁿθ ваших направлений.",
        },
        "uniform-density": {
            "en": "You sample the lobe and divide by 1/2π, the density of uniform directions.",
            "ru": "Вы выбираете направления по лепестку, а делите на 1/2π — плотность равномерных.",
        },
        "lobe-normalisation": {
            "en": "The BRDF has the factor (n+2)/2π, and the density (n+1)/2π: they do not cancel.",
            "ru": "У ДФО множитель (n+2)/2π, а у плотности (n+1)/2π: они не сокращаются.",
        },
    },
    seconds=SECONDS,
)


# A window, sampled by area


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
    found = light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    assert found is not None  # a rectangle has a closed form
    return float(found.value)


def _over_window(kernel: Callable[[Any, Any, Any], Any]) -> Callable[..., float]:
    """Return the integral over the window's area of ``kernel(x, z, d)``."""

    def integral(distance: Any, width: Any, height: Any) -> float:
        t, weight = gauss_legendre(40)
        y, z = np.meshgrid((t - 0.5) * width, t * height, indexing="ij")
        d = np.sqrt(distance**2 + y**2 + z**2)
        return float(width * height * (weight @ kernel(distance, z, d) @ weight))

    return integral


_WINDOW: dict[str, Any] = {
    "exact": False,
    "alike": False,
    "inputs": _windows,
    "reference": _window,
    "variants": {
        "light-cosine-forgotten": _over_window(lambda x, z, d: z / d**3),
        "cosine-forgotten": _over_window(lambda x, z, d: x / d**3),
        "distance-forgotten": _over_window(lambda x, z, d: x * z / d**2),
        "distance-not-squared": _over_window(lambda x, z, d: x * z / d**3),
        "both-cosines-forgotten": _over_window(lambda x, z, d: 1 / d**2),
        "cosines-exchanged": _over_window(lambda x, z, d: z * z / d**4),
        "distance-of-the-wall": _over_window(lambda x, z, d: z / (x * d**2)),
        "half-window": lambda distance, width, height: _window(distance, 2 * width, height) / 2,
        "distance-and-pdf-forgotten": lambda distance, width, height: (
            _over_window(lambda x, z, d: x * z / d**2)(distance, width, height) / (width * height)
        ),
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
        "where $\\theta'$ is the angle at the window, and return `value, standard_error`, with numbers from "
        "`seed`. Per solid angle these points have the density $p_\\omega = p_A\\, d^2/\\cos\\theta'$ with "
        "$p_A = 1/A$.",
        "ru": "Вы стоите на полу в начале координат, нормаль пола — $z$. Окно яркости 1 Вт/(м²·ср) занимает "
        "прямоугольник $x =$ `distance`, $|y| \\le$ `width`$/2$, $0 \\le z \\le$ `height` и светит в вашу "
        "сторону. Оцените освещённость пола по `samples` точкам, равномерно распределённым по площади "
        "окна:\n\n"
        "$$E = \\int L \\cos\\theta\\, d\\omega = \\int_A L\\, \\frac{\\cos\\theta \\cos\\theta'}{d^2}\\, "
        "dA,$$\n\n"
        "где $\\theta'$ — угол при окне, и верните `value, standard_error`; случайные числа — из `seed`. По "
        "телесному углу плотность этих точек равна $p_\\omega = p_A\\, d^2/\\cos\\theta'$, где $p_A = 1/A$.",
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
        "both-cosines-forgotten": {
            "en": "Both cosines are missing, that at the floor and that at the window.",
            "ru": "Нет обоих косинусов: ни у пола, ни у окна.",
        },
        "cosines-exchanged": {
            "en": "You took the cosine at the floor, z/d, twice: that at the window is distance/d.",
            "ru": "Вы дважды взяли косинус у пола, z/d, а у окна он равен distance/d.",
        },
        "distance-of-the-wall": {
            "en": "You divided by `distance`², that of the wall: d is the distance of the sampled point.",
            "ru": "Вы разделили на `distance`², до стены: d — это расстояние до точки окна.",
        },
        "half-window": {
            "en": "Your y runs from 0 to `width`: the window lies on both sides, |y| ≤ width/2.",
            "ru": "У вас y меняется от 0 до `width`, а окно лежит по обе стороны: |y| ≤ width/2.",
        },
        "distance-and-pdf-forgotten": {
            "en": "Both are missing: the division by d² and that by the density 1/A.",
            "ru": "Не хватает обоих делений: и на d², и на плотность 1/A.",
        },
        "pdf-of-area": {
            "en": "You took the density per area, 1/A, for one per solid angle: cos θ'/d² is missing.",
            "ru": "Вы приняли плотность по площади 1/A за плотность по телесному углу: не хватает cos θ'/d².",
        },
    },
    seconds=SECONDS,
)
