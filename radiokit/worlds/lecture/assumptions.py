"""Assumptions: slides 14 to 17, on what radiometry rests on, and what is lost without it."""

from __future__ import annotations

from radiokit.worlds.lecture.deciding import Derived, Experiment
from radiokit.worlds.lecture.entry import Entry
from radiokit.worlds.lecture.experiments.materials import (
    conservation,
    fluorescent,
    polarisation_added,
    switched_on,
    two_lamps,
)
from radiokit.worlds.lecture.experiments.optics import transverse, two_reflections
from radiokit.worlds.lecture.experiments.quantities import observer

__all__ = ["ENTRIES"]

ENTRIES = (
    Entry(
        name="no-observer",
        slide=14,
        printed="В отличие от колориметрии (и фотометрии), радиометрия не учитывает особенностей "
        "человеческого "
        "восприятия",
        sentence="Радиометрия – наука об измерении электромагнитного излучения",
        english="A watt of red is a watt like one of green; in lumens they differ.",
        russian="Ватт красного света — такой же ватт, как и зелёного; в люменах они различны.",
        checks=(Experiment(observer), Derived("luminous-flux")),
        derivation="luminous-flux",
    ),
    Entry(
        name="elements-of-waves",
        slide=15,
        printed="Тем не менее, возможно включать элементы волновой оптики",
        sentence="Основана на излучении как потоке частиц (геометрическая оптика)",
        english="Fresnel's formulas bring into radiometry what waves do at an interface.",
        russian="Формулы Френеля вносят в радиометрию поведение волн на границе сред.",
        checks=(Experiment(transverse), Derived("fresnel-s"), Derived("fresnel-p")),
        derivation="fresnel-s",
    ),
    Entry(
        name="linearity",
        slide=16,
        printed="Суммарный эффект двух входных сигналов всегда равен сумме эффектов каждого сигнала по "
        "отдельности",
        sentence="Линейность",
        english="Two lights together do what each does alone, added up.",
        russian="Действие двух источников вместе равно сумме их действий порознь.",
        checks=(Experiment(two_lamps, {"power": 2}),),
        condition="the material answers in proportion to the light (no saturation, no two-photon absorption)",
        condition_ru="отклик материала пропорционален облучённости (нет насыщения и двухфотонного "
        "поглощения)",
        amended=(Experiment(two_lamps, {"power": 1}), Derived("reflection-integral")),
        derivation="reflection-integral",
        case="lambert-under-three-lights",
    ),
    Entry(
        name="energy-conservation",
        slide=16,
        printed="Рассеиваемый свет не может выдавать больше энергии, чем было изначально",
        sentence="Сохранение энергии",
        english="What a surface scatters is at most what it receives: no albedo exceeds 1.",
        russian="Рассеянный поток не превышает падающего: альбедо не больше 1.",
        checks=(Experiment(conservation), Derived("energy-conservation")),
        derivation="energy-conservation",
        case="phong-10-in-furnace-at-0deg",
    ),
    Entry(
        name="no-polarisation",
        slide=16,
        printed="Единственное свойство света – распределение по длинам волн (частоте)",
        sentence="Отсутствие поляризации",
        english="A ray is told completely by its spectrum.",
        russian="Луч полностью описывается своим спектром.",
        checks=(Experiment(two_reflections, {"theta_deg": 56.309932474}),),
        condition="nothing on the way has polarised it",
        condition_ru="на пути ничто не поляризовало свет",
        amended=(Experiment(two_reflections, {"theta_deg": 0.0}),),
        derivation="brewster-angle",
    ),
    Entry(
        name="no-fluorescence",
        slide=16,
        printed="Поведение света на одной частоте не зависит от поведения на другой",
        sentence="Отсутствие флюоресценции и фосфоресценции",
        english="Light of one wavelength leaves as light of that wavelength: a reflectance a wavelength is "
        "enough.",
        russian="Длина волны при отражении не меняется: достаточно коэффициента отражения для каждой из них.",
        checks=(Experiment(fluorescent, {"moved": 0.3}),),
        condition="the matrix from wavelength to wavelength is diagonal (no fluorescence)",
        condition_ru="матрица перехода между длинами волн диагональна (нет флуоресценции)",
        amended=(Experiment(fluorescent, {"moved": 0.0}),),
        derivation="flux-balance",
    ),
    Entry(
        name="steady-state",
        slide=16,
        printed="Распределение световой энергии не зависит от времени",
        sentence="Устойчивость состояния",
        english="The light has settled: the sources have shone for long.",
        russian="Световое поле установилось: источники светят достаточно долго.",
        checks=(Experiment(switched_on, {"time_constants": 1.0}),),
        condition="times are long against the time constant of the room",
        condition_ru="времена велики по сравнению с постоянной времени помещения",
        amended=(Experiment(switched_on, {"time_constants": 30.0}),),
        derivation="integrating-sphere",
    ),
    Entry(
        name="easily-added",
        slide=17,
        printed="Последние три легко добавить",
        sentence="Поляризация, Флюоресценция, Фосфоресценция",
        english="Two numbers a ray keep polarisations apart, a matrix moves light to other wavelengths.",
        russian="Две составляющие луча учитывают поляризацию, матрица — переход на другие длины волн.",
        checks=(Experiment(polarisation_added),),
    ),
)
