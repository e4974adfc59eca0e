"""Shading: slides 46 to 49, the radiance of a point on a surface, by an integral and by a sum over lamps."""

from __future__ import annotations

from radiokit.worlds.lecture.deciding import Case, Derived, Evaluated, Experiment, Formula, Term
from radiokit.worlds.lecture.entry import Entry
from radiokit.worlds.lecture.experiments.beams import hemisphere, reflected, two_lamps
from radiokit.worlds.lecture.experiments.materials import (
    by_wavelength,
    elsewhere,
    facets_scatter,
    fluorescent,
    furnace,
    glowing,
    sum_of_lamps,
)
from radiokit.worlds.lecture.experiments.optics import two_reflections
from radiokit.worlds.lecture.experiments.quantities import cosine_law

__all__ = ["ENTRIES"]

_BSSRDF = {"S": "1/(m^2 sr)", "A": "m^2"}

ENTRIES = (
    Entry(
        name="each-wavelength",
        slide=46,
        printed="Для каждой длины волны!",
        english="The integral is taken for each wavelength for itself.",
        russian="Интеграл вычисляют для каждой длины волны отдельно.",
        checks=(Experiment(by_wavelength),),
        derivation="spectral-flux",
        case="spectral-sphere",
    ),
    Entry(
        name="reflection-only",
        slide=46,
        printed="Здесь учитываем только отражение",
        english="All the light that leaves is reflected light.",
        russian="Весь уходящий свет — отражённый.",
        checks=(Experiment(glowing, {"emissivity": 0.7}),),
        condition="the surface gives out no light of its own; else L_e is added",
        condition_ru="поверхность сама не излучает; иначе добавляется L_e",
        amended=(Experiment(glowing, {"emissivity": 0.0}),),
        derivation="white-furnace",
        case="lambert-in-furnace",
    ),
    Entry(
        name="sum-of-reflections",
        slide=46,
        printed=r"L(p, \omega_o) = \int_{\Omega} L_{\text{отражение}}(p, \omega_o, \omega_i) d\omega_i",
        english="The radiance that leaves is the sum of what each solid angle dω_i contributes, dL.",
        russian="Яркость — сумма вкладов dL от каждого телесного угла dω_i.",
        checks=(Formula(),),
        corrected=r"L(p, \omega_o) = \int_{\Omega} dL_{\text{отражение}}(p, \omega_o, \omega_i)",
        amended=(Formula(), Derived("reflection-integral")),
        derivation="reflection-integral",
    ),
    Entry(
        name="brdf-again",
        slide=46,
        printed=r"f_r(p, \omega_o, \omega_i) = \frac{dL_o(p, \omega_o)}{dL_i(p, \omega_i) \cos \theta_i "
        r"d\omega_i}",
        english="The definition of the BRDF, again with the differential of what arrives.",
        russian="Определение ДФО, снова с дифференциалом падающей яркости.",
        checks=(Formula(),),
        corrected=r"f_r(p, \omega_o, \omega_i) = \frac{dL_o(p, \omega_o)}{L_i(p, \omega_i) \cos \theta_i "
        r"d\omega_i}",
        amended=(Formula(), Evaluated(reflected), Derived("brdf-definition")),
        derivation="brdf-definition",
    ),
    Entry(
        name="reflection-integral",
        slide=46,
        printed=r"L(p, \omega_o) = \int_{\Omega} f_r(p, \omega_o, \omega_i) L_i \cos \theta_i d\omega_i",
        english="The reflection integral.",
        russian="Интеграл отражения.",
        checks=(
            Formula(),
            Evaluated(hemisphere),
            Experiment(furnace),
            Derived("reflection-integral"),
            Case("phong-10-under-sphere"),
        ),
        derivation="reflection-integral",
        case="phong-10-under-sphere",
    ),
    Entry(
        name="sum-over-lamps",
        slide=47,
        printed=r"L(p, \omega_o) = \sum_{j=0}^{n-1} f_r(p, \omega_o, \omega_i^j) L_i^j \cos \theta_i^j",
        english="A sum over n lamps in the place of the integral.",
        russian="Сумма по n источникам вместо интеграла.",
        checks=(
            Formula(),
            Evaluated(two_lamps, {"factor": "radiance"}),
            Experiment(sum_of_lamps, {"factor": "radiance"}),
        ),
        condition="L_i^j is no radiance but the irradiance on a surface that faces the lamp (or carries "
        "Δω_j)",
        condition_ru="L_i^j — не яркость, а облучённость площадки, обращённой к источнику (или стоит "
        "множитель Δω_j)",
        amended=(
            Formula({"L_i_j": "irradiance"}),
            Evaluated(two_lamps, {"factor": "irradiance"}),
            Experiment(sum_of_lamps, {"factor": "irradiance"}),
            Derived("sum-over-delta-lights"),
        ),
        derivation="sum-over-delta-lights",
        case="lambert-under-three-lights",
    ),
    Entry(
        name="angle-to-the-lamp",
        slide=47,
        printed=r"$\theta_i^j$  - Угол между направлением на j-й источник и нормалью к поверхности",
        sentence=r"$\omega_i^j$  - Направление на j-й источник света",
        english="The cosine is that of the angle between the surface's normal and the direction to the lamp.",
        russian="Косинус берётся для угла между нормалью и направлением на источник.",
        checks=(Experiment(cosine_law),),
        case="lambert-under-sun-at-60deg",
    ),
    Entry(
        name="brdf-without-polarisation",
        slide=48,
        printed="Отсутствие поляризации",
        english="A BRDF tells all about a path of several reflections.",
        russian="ДФО достаточно для пути с несколькими отражениями.",
        checks=(Experiment(two_reflections, {"theta_deg": 56.309932474}),),
        condition="polarisation does not matter on it",
        condition_ru="поляризация на этом пути не важна",
        amended=(Experiment(two_reflections, {"theta_deg": 0.0}),),
        derivation="brewster-angle",
    ),
    Entry(
        name="brdf-without-fluorescence",
        slide=48,
        printed="Отсутствие флюоресценции и фосфоресценции",
        english="A BRDF a wavelength tells all about a material.",
        russian="Материал описывается своей ДФО для каждой длины волны.",
        checks=(Experiment(fluorescent, {"moved": 0.3}),),
        condition="no light changes its wavelength, or comes later",
        condition_ru="свет не меняет длины волны и не запаздывает",
        amended=(Experiment(fluorescent, {"moved": 0.0}),),
        derivation="flux-balance",
    ),
    Entry(
        name="no-subsurface-scattering",
        slide=48,
        printed="Отсутствие поверхностного рассеивания (Surface scattering)",
        english="A BRDF describes what a surface scatters; what it lacks is scattering below the surface.",
        russian="Рассеяние поверхностью ДФО описывает; ей недоступно подповерхностное рассеяние.",
        checks=(Experiment(facets_scatter),),
        corrected="Отсутствие подповерхностного рассеяния (Subsurface scattering)",
        amended=(Experiment(elsewhere, {"scatter_mm": 0.01}), Derived("bssrdf-limit")),
        derivation="bssrdf-limit",
    ),
    Entry(
        name="bssrdf",
        slide=48,
        printed="Задачу решает ФОР (Функция Объемного Рассеивания) – обобщение модели ДФР",
        english="A BSSRDF S, in 1/(m² sr), is more general: its integral over the places where light "
        "enters is f.",
        russian="ФОР S, в 1/(м²·ср), общее: её интеграл по точкам входа света даёт ДФО.",
        checks=(Formula(_BSSRDF, r"f_r = \int S dA"), Derived("bssrdf-limit")),
        derivation="bssrdf-limit",
    ),
    Entry(
        name="main-concept",
        slide=49,
        printed="Основное понятие - излучение",
        sentence="Для измерения света используем радиометрию",
        english="The concept that all rests on is radiance.",
        russian="Основное понятие — энергетическая яркость.",
        checks=(Term("излучение", "radiance"),),
        corrected="Основное понятие — энергетическая яркость",
        amended=(Term("энергетическая яркость", "radiance"),),
    ),
)
