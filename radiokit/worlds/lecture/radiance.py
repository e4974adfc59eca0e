"""Radiance: slides 29 to 32, its definition, unit and properties, and how it follows from the others."""

from __future__ import annotations

from radiokit.worlds.lecture.deciding import Derived, Evaluated, Experiment, Formula, Unit
from radiokit.worlds.lecture.entry import Entry
from radiokit.worlds.lecture.experiments.beams import onto_a_surface
from radiokit.worlds.lecture.experiments.quantities import patch, pixel, point_source, through_vacuum

__all__ = ["ENTRIES"]

ENTRIES = (
    Entry(
        name="radiance-of-areas",
        slide=29,
        printed="Источник не точечный",
        english="A point of finite intensity has no radiance: as the source shrinks, L grows without bound.",
        russian="У точечного источника конечной силы нет яркости: при сжатии источника L растёт "
        "неограниченно.",
        checks=(
            Formula({"r": "m"}, r"I = L \pi r^2"),
            Experiment(point_source),
        ),
        derivation="irradiance-from-sphere",
        case="lambert-under-sphere-at-100m",
    ),
    Entry(
        name="radiance-in-words",
        slide=29,
        printed="Плотность потока, попадающего на площадку единичной площади, проходя через единичный "
        "телесный угол",
        english="Radiance is the flux per area and per solid angle.",
        russian="Яркость — поток на единицу площади и телесного угла.",
        checks=(Experiment(patch, {"theta_deg": 60.0}),),
        condition="the area is perpendicular to the ray, as dS cosθ in the formula beside it says",
        condition_ru="площадка перпендикулярна лучу, как и сказано в формуле рядом: dS cosθ",
        amended=(Experiment(patch, {"theta_deg": 0.0}), Formula(latex=r"L = \frac{d^2\Phi}{d\omega dS}")),
        derivation="definition-graph",
    ),
    Entry(
        name="unit-radiance",
        slide=29,
        printed=r"$\text{Вт} / (\text{Ст} * \text{м}^2)$",
        sentence="Единицы измерения",
        english="The unit of radiance.",
        russian="Единица энергетической яркости.",
        checks=(Unit("radiance", "Вт / (Ст * м²)"),),
        corrected="Вт / (ср * м²)",
        amended=(Unit("radiance"),),
    ),
    Entry(
        name="radiance",
        slide=29,
        printed=r"L = \frac{d^2\Phi}{d\omega dS \cos\theta}",
        english="Radiance is the flux per solid angle and projected area.",
        russian="Энергетическая яркость — поток на единицу телесного угла и проекции площади.",
        checks=(Formula(), Evaluated(onto_a_surface), Derived("definition-graph")),
        derivation="definition-graph",
    ),
    Entry(
        name="radiance-keeps",
        slide=31,
        printed="Передается в вакууме без потерь!",
        english="Radiance does not change along a ray in vacuum.",
        russian="Яркость вдоль луча в вакууме не меняется.",
        checks=(Experiment(through_vacuum), Derived("radiance-along-a-ray")),
        derivation="radiance-along-a-ray",
        case="lambert-under-sphere-at-2m",
    ),
    Entry(
        name="camera-records-radiance",
        slide=31,
        printed="Фотокамера записывает именно яркость",
        english="A pixel's signal is proportional to the radiance, E = π L cos⁴θ/(4N²).",
        russian="Сигнал пикселя пропорционален яркости, E = π L cos⁴θ/(4N²).",
        checks=(Experiment(pixel, {"fills": False}),),
        condition="what it sees fills the pixel (a star does not), and aperture and exposure stay the same",
        condition_ru="изображение заполняет пиксель (у звезды — нет), диафрагма и выдержка постоянны",
        amended=(
            Formula({"N": "1", "π": "sr"}, r"E = \frac{\pi L \cos^4 \theta}{4 N^2}"),
            Experiment(pixel, {"fills": True}),
            Derived("camera-equation"),
        ),
        derivation="camera-equation",
    ),
    Entry(
        name="eye-sees-luminance",
        slide=31,
        printed="Глаз реагирует на яркость",
        english="The eye answers to luminance.",
        russian="Глаз реагирует на яркость (фотометрическую).",
        checks=(Experiment(pixel, {"fills": False, "twin": "luminance"}),),
        condition="what it sees is wider than what the eye resolves; of a star it sees the illuminance",
        condition_ru="угловой размер больше разрешения глаза; от звезды важна освещённость на зрачке",
        amended=(Experiment(pixel, {"fills": True, "twin": "luminance"}),),
        derivation="camera-equation",
    ),
    Entry(
        name="radiance-from-others",
        slide=32,
        printed=r"L = \frac{dI}{dS \cos \theta} = \frac{dE}{d\omega \cos \theta} = \frac{dM}{d\omega \cos "
        r"\theta}",
        sentence="Сила света, Освещенность, Светимость",
        english="Radiance by intensity per projected area, and by irradiance or exitance per projected "
        "solid angle.",
        russian="Яркость через силу излучения, облучённость и светимость.",
        checks=(Formula(), Evaluated(onto_a_surface), Derived("radiance-from-others")),
        derivation="radiance-from-others",
    ),
)
