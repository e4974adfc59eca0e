"""Quantities: slides 18 to 28, from energy to exitance, their terms, units and formulas."""

from __future__ import annotations

from radiokit.worlds.lecture.deciding import Derived, Evaluated, Experiment, Formula, Term, Unit
from radiokit.worlds.lecture.entry import Entry
from radiokit.worlds.lecture.experiments.beams import from_a_point, lamp
from radiokit.worlds.lecture.experiments.quantities import (
    calorimeter,
    cap_over_square,
    cosine_law,
    irradiance_and_exitance,
    one_steradian,
    total_flux,
)

__all__ = ["ENTRIES"]


def _term(name: str, printed: str, russian: str, english: str, correct: str = "") -> Entry:
    read = f"{correct or russian} ({english})"
    return Entry(
        name=name,
        slide=18,
        printed=printed,
        english=f"The Russian term beside {english}.",
        russian=f"Русский термин: {correct or russian}.",
        checks=(Term(russian, english),),
        corrected=read if correct else "",
        amended=(Term(correct, english),) if correct else (),
    )


def _unit(name: str, slide: int, printed: str, quantity: str, term: str, correct: str = "") -> Entry:
    unit = printed.removeprefix("$").removesuffix("$")
    return Entry(
        name=name,
        slide=slide,
        printed=printed,
        sentence="Единицы измерения",
        english=f"The unit of {quantity.replace('_', ' ')}.",
        russian=f"Единица величины «{term}».",
        checks=(Unit(quantity, _plain(unit)),),
        corrected=correct,
        amended=(Unit(quantity),) if correct else (),
    )


def _plain(unit: str) -> str:
    for mark, plain in ((r"\text{", ""), ("}", ""), ("<sup>2</sup>", "²"), ("^2", "²")):
        unit = unit.replace(mark, plain)
    return unit


ENTRIES = (
    _term(
        "term-energy",
        "Световая энергия (radiant energy)",
        "световая энергия",
        "radiant energy",
        "энергия излучения",
    ),
    _term("term-flux", "Световой поток (radiant flux)", "световой поток", "radiant flux", "поток излучения"),
    _term(
        "term-intensity", "Энергетическая сила света (intensity)", "энергетическая сила света", "intensity"
    ),
    _term(
        "term-irradiance",
        "Энергетическая освещенность (irradiance)",
        "энергетическая освещенность",
        "irradiance",
    ),
    _term(
        "term-exitance",
        "Энергетическая светимость (radiant exitance)",
        "энергетическая светимость",
        "radiant exitance",
    ),
    _term("term-radiance", "Энергетическая яркость (radiance)", "энергетическая яркость", "radiance"),
    _term("term-radiation", "= излучение", "излучение", "radiance", "энергетическая яркость"),
    _unit("unit-energy", 19, "Дж", "radiant_energy", "энергия излучения"),
    Entry(
        name="flux",
        slide=20,
        printed=r"$\Phi = dQ / dt$",
        sentence="Поток: энергия, излучаемая в единицу времени",
        english="Flux is energy per time.",
        russian="Поток излучения — энергия в единицу времени.",
        checks=(Formula(), Derived("flux-from-energy")),
        derivation="flux-from-energy",
    ),
    _unit("unit-flux", 20, "Вт", "radiant_flux", "поток излучения"),
    _unit("watt", 20, "Дж/с", "radiant_flux", "поток излучения"),
    Entry(
        name="flux-by-heating",
        slide=21,
        printed="Замерить изменение температуры площадки за заданное время",
        sentence="Поставить источник света",
        english="The flux on a plate is what it gains in heat per time, Φ = C dT/dt.",
        russian="Поток, падающий на площадку, равен скорости роста её теплоты, Φ = C dT/dt.",
        checks=(
            Formula({"C": "J/K", "T": "K"}, r"\Phi = C \frac{dT}{dt}"),
            Experiment(calorimeter, {"losses": 0.5}),
        ),
        condition="the plate absorbs all light and loses no heat meanwhile",
        condition_ru="площадка поглощает весь свет и не теряет теплоты за время опыта",
        amended=(
            Formula({"C": "J/K", "T": "K"}, r"\Phi = C \frac{dT}{dt}"),
            Experiment(calorimeter, {"losses": 0.0}),
        ),
    ),
    Entry(
        name="whole-flux",
        slide=22,
        printed="Полный световой поток",
        sentence="Часто бывает нужно замерить полное излучение источника света",
        english="The whole flux is the integral of intensity over all directions, Φ = ∫ I dω.",
        russian="Полный поток — интеграл силы излучения по всем направлениям, Φ = ∫ I dω.",
        checks=(Formula(latex=r"\Phi = \int I d\omega"), Derived("lambertian-disk-flux")),
        derivation="lambertian-disk-flux",
    ),
    Entry(
        name="solid-angle",
        slide=23,
        printed="Измеряется отношением площади части сферы с центром в вершине угла, которая вырезается "
        "этим телесным "
        "углом, к квадрату радиуса сферы",
        english="A solid angle is the area that it cuts from a sphere over the square of the radius, in sr.",
        russian="Телесный угол — отношение вырезаемой им площади сферы к квадрату радиуса, в стерадианах.",
        checks=(
            Formula({"A": "m^2", "r": "m", "ω_0": "sr"}, r"\omega = \omega_0 \frac{A}{r^2}"),
            Experiment(cap_over_square),
            Derived("solid-angle-of-cone"),
        ),
        derivation="solid-angle-of-cone",
    ),
    Entry(
        name="steradian",
        slide=23,
        printed="Стерадиан равен телесному углу, вырезающему из сферы единичного радиуса поверхность с "
        "площадью в 1 "
        "квадратную единицу",
        english="The cone that cuts 1 m² from a sphere of radius 1 m is 1 sr.",
        russian="Конус, вырезающий 1 м² из сферы радиуса 1 м, есть 1 ср.",
        checks=(Experiment(one_steradian),),
        derivation="solid-angle-of-cone",
    ),
    Entry(
        name="term-luminous-intensity",
        slide=24,
        printed="Сила света (intensity)",
        sentence="Единицы измерения: Вт / Ст",
        english="The term beside radiant intensity: luminous intensity is in candelas.",
        russian="Термин для величины в Вт/ср: «сила излучения»; сила света измеряется в канделах.",
        checks=(Term("сила света", "radiant intensity"),),
        corrected="Сила излучения (radiant intensity)",
        amended=(Term("сила излучения", "radiant intensity"),),
    ),
    _unit("unit-intensity", 24, "Вт / Ст", "radiant_intensity", "сила излучения", "Вт / ср"),
    Entry(
        name="intensity",
        slide=24,
        printed=r"I = \frac{d\Phi}{d\omega}",
        sentence="Плотность потока света, проходящего через телесный угол",
        english="Intensity is flux per solid angle.",
        russian="Сила излучения — поток на единицу телесного угла.",
        checks=(Formula(), Evaluated(from_a_point), Derived("definition-graph")),
        derivation="definition-graph",
    ),
    Entry(
        name="flux-of-a-point-source",
        slide=24,
        printed=r"Полный поток = $4\pi \cdot I$",
        english="Φ = 4π I, where 4π is the number of steradians all round.",
        russian="Φ = 4π I, где 4π — число стерадиан в полном телесном угле.",
        checks=(
            Formula({"Полный поток": "radiant_flux"}),
            Evaluated(lamp, {"isotropic": False}, {"Полный поток": "radiant_flux"}),
            Experiment(total_flux, {"isotropic": False}),
        ),
        condition="the source is isotropic, and 4π is in steradians",
        condition_ru="источник изотропный, а 4π измеряется в стерадианах",
        amended=(
            Formula({"Полный поток": "radiant_flux", "π": "sr"}),
            Evaluated(lamp, {"isotropic": True}, {"Полный поток": "radiant_flux"}),
            Experiment(total_flux, {"isotropic": True}),
            Derived("isotropic-flux"),
        ),
        derivation="isotropic-flux",
    ),
    Entry(
        name="two-symmetric-terms",
        slide=25,
        printed="Не знаем направления, поэтому два симметричных термина",
        sentence="освещенность, светимость",
        english="Irradiance arrives and exitance leaves: one unit, two quantities.",
        russian="Облучённость относится к приходящему потоку, светимость — к уходящему: единица одна.",
        checks=(Experiment(irradiance_and_exitance),),
    ),
    Entry(
        name="irradiance",
        slide=26,
        printed=r"E = \frac{d\Phi}{dS}",
        english="Irradiance is the flux that arrives per area.",
        russian="Облучённость — падающий поток на единицу площади.",
        checks=(Formula(), Evaluated(from_a_point), Derived("definition-graph")),
        derivation="definition-graph",
    ),
    _unit("unit-irradiance", 26, r"$\text{Вт}/\text{м}^2$", "irradiance", "облучённость"),
    Entry(
        name="cosine",
        slide=27,
        printed=r"Во многих моделях освещения встречается $\cos$ в качестве множителя",
        english="A tilted surface receives E = E₀ cosθ.",
        russian="На наклонной поверхности облучённость E = E₀ cosθ.",
        checks=(
            Formula(latex=r"E = E_0 \cos\theta"),
            Experiment(cosine_law),
            Derived("irradiance-from-intensity"),
        ),
        derivation="irradiance-from-intensity",
        case="lambert-under-sun-at-60deg",
    ),
    Entry(
        name="exitance",
        slide=28,
        printed=r"M = \frac{d\Phi}{dS}",
        english="Exitance is the flux that leaves per area.",
        russian="Энергетическая светимость — испускаемый поток на единицу площади.",
        checks=(Formula(), Evaluated(from_a_point), Derived("definition-graph")),
        derivation="definition-graph",
    ),
    _unit("unit-exitance", 28, "Вт/м<sup>2</sup>", "radiant_exitance", "энергетическая светимость"),
    Entry(
        name="term-radiosity",
        slide=28,
        printed="В компьютерной графике еще называют **radiosity**",
        english="Radiosity is radiant exitance.",
        russian="Radiosity — другое название энергетической светимости.",
        checks=(Term("энергетическая светимость", "radiosity"),),
    ),
)
