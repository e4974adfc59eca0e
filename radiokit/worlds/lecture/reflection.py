"""Reflection: slides 35 to 45, the BRDF, its properties, and its first examples."""

from __future__ import annotations

from radiokit.worlds.lecture.deciding import Case, Derived, Evaluated, Experiment, Formula
from radiokit.worlds.lecture.entry import Entry
from radiokit.worlds.lecture.experiments.beams import diffuse, hemisphere, onto_a_surface, reflected
from radiokit.worlds.lecture.experiments.materials import (
    conservation,
    diffuse_albedo,
    elsewhere,
    kinds_of_scattering,
    proportional,
    reciprocal,
    share_passed,
    shrinking_lamp,
    there_and_back,
)

__all__ = ["ENTRIES"]

ENTRIES = (
    Entry(
        name="kinds-of-scattering",
        slide=35,
        printed="Отражение: Зеркальное, Диффузное, Смешанное, Ретро-зеркальное, Блеск; Преломление "
        "(пропускание): "
        "Зеркальное, Диффузное, Смешанное",
        english="Specular, diffuse, mixed, retroreflecting and glossy surfaces, and what lets light pass.",
        russian="Зеркальное, диффузное, смешанное, световозвращающее и глянцевое отражение; пропускание.",
        checks=(Experiment(kinds_of_scattering),),
    ),
    Entry(
        name="energy-towards-the-viewer",
        slide=36,
        printed="Задача – рассчитать количество энергии, излучаемой в сторону наблюдателя при заданном "
        "входящем "
        "излучении",
        english="What is sought for a viewer is no energy but a radiance, L_o = ∫ f L_i cosθ_i dω_i.",
        russian="Для наблюдателя ищут не энергию, а яркость, L_o = ∫ f L_i cosθ_i dω_i.",
        checks=(Formula(latex=r"Q = \int f_r L_i \cos \theta_i d\omega_i"),),
        corrected=r"L_o = \int f_r L_i \cos \theta_i d\omega_i",
        amended=(Formula(), Derived("reflection-integral")),
        derivation="reflection-integral",
    ),
    Entry(
        name="light-of-one-point",
        slide=37,
        printed="Предполагается, что исходящее излучение зависит только от входящего излучения для данной "
        "точки!",
        english="Light leaves where it arrives.",
        russian="Свет выходит в той же точке, куда пришёл.",
        checks=(Experiment(elsewhere, {"scatter_mm": 2.0}),),
        condition="light wanders less under the surface than the eye resolves there (wax and skin need a "
        "BSSRDF)",
        condition_ru="путь света под поверхностью меньше разрешаемого (для воска и кожи нужна ФОР)",
        amended=(Experiment(elsewhere, {"scatter_mm": 0.01}), Derived("bssrdf-limit")),
        derivation="bssrdf-limit",
    ),
    Entry(
        name="irradiance-of-a-beam",
        slide=38,
        printed=r"dE(p, \omega_i) = L_i(p, \omega_i) \cos \theta_i",
        sentence="Рассмотрим дифференциальную освещенность поверхности в точке p в зависимости от яркости",
        english="The irradiance from the solid angle dω_i is dE = L_i cosθ_i dω_i.",
        russian="Облучённость от телесного угла dω_i равна dE = L_i cosθ_i dω_i.",
        checks=(Formula(),),
        corrected=r"dE(p, \omega_i) = L_i(p, \omega_i) \cos \theta_i d\omega_i",
        amended=(Formula(), Evaluated(onto_a_surface), Derived("irradiance-from-radiance")),
        derivation="irradiance-from-radiance",
    ),
    Entry(
        name="reflected-in-proportion",
        slide=38,
        printed=r"dL_o(p, \omega_o) \propto dE(p, \omega_i)",
        sentence="Из предположения линейности и сохранения энергии",
        english="The radiance reflected is proportional to the irradiance; linearity alone is enough for it.",
        russian="Отражённая яркость пропорциональна облучённости; достаточно одной линейности.",
        checks=(Formula(), Experiment(proportional)),
        derivation="brdf-definition",
    ),
    Entry(
        name="brdf",
        slide=39,
        printed=r"f_r(p, \omega_o, \omega_i) = \frac{dL_o(p, \omega_o)}{dE(p, \omega_i)} = "
        r"\frac{dL_o(p, \omega_o)}{dL_i(p, \omega_i) \cos \theta_i d\omega_i}",
        sentence="ДФО",
        english="A BRDF is the radiance that leaves over the irradiance that arrives, dE = L_i cosθ_i dω_i.",
        russian="ДФО — отношение отражённой яркости к облучённости, dE = L_i cosθ_i dω_i.",
        checks=(Formula(),),
        corrected=r"f_r(p, \omega_o, \omega_i) = \frac{dL_o(p, \omega_o)}{dE(p, \omega_i)} = "
        r"\frac{dL_o(p, \omega_o)}{L_i(p, \omega_i) \cos \theta_i d\omega_i}",
        amended=(Formula(), Evaluated(reflected), Derived("brdf-definition")),
        derivation="brdf-definition",
    ),
    Entry(
        name="reciprocity",
        slide=41,
        printed=r"\forall \omega_o, \omega_i \ f_r(p, \omega_o, \omega_i) = f_r(p, \omega_i, \omega_o)",
        sentence="Обратимость",
        english="Lamp and viewer may change places; a formula that breaks this is no BRDF of a real surface.",
        russian="Источник и наблюдатель взаимозаменяемы; иначе формула не описывает реальную поверхность.",
        checks=(Formula(), Experiment(reciprocal), Derived("reciprocity")),
        derivation="reciprocity",
    ),
    Entry(
        name="brdf-conserves-energy",
        slide=42,
        printed=r"\int f_r(p, \omega_i, \omega') \cos \theta' d\omega' \leq 1",
        sentence="Сохранение энергии",
        english="The directional albedo is at most 1.",
        russian="Альбедо для каждого направления не превышает 1.",
        checks=(Formula(), Evaluated(hemisphere), Experiment(conservation), Derived("energy-conservation")),
        derivation="energy-conservation",
        case="ggx-1-in-furnace-at-0deg",
    ),
    Entry(
        name="diffuse-brdf",
        slide=43,
        printed=r"f_{r,d}(p, \omega_i, \omega') = f_{r,d}(p) = C",
        english="The BRDF of a diffuse surface is the same for all directions.",
        russian="ДФО диффузной поверхности не зависит от направлений.",
        checks=(Formula({"C": "bsdf"}), Case("lambert-under-disk", "closed form")),
        derivation="lambertian-brdf",
        case="lambert-under-disk",
    ),
    Entry(
        name="diffuse-one-over-pi",
        slide=43,
        printed=r"f_{r,d}(p, \omega_i) = \frac{1}{\pi}",
        sentence="Для идеального диффузного отражения",
        english="f = 1/π, with π in steradians; in general f = ρ/π.",
        russian="f = 1/π, где π в стерадианах; в общем случае f = ρ/π.",
        checks=(
            Formula(),
            Evaluated(diffuse, {"reflectance": 0.5}),
            Experiment(diffuse_albedo, {"reflectance": 0.5}),
        ),
        condition="the albedo is 1: the surface absorbs nothing",
        condition_ru="альбедо равно 1: поверхность ничего не поглощает",
        amended=(
            Formula({"π": "sr"}),
            Evaluated(diffuse, {"reflectance": 1.0}),
            Experiment(diffuse_albedo, {"reflectance": 1.0}),
            Derived("lambertian-brdf"),
        ),
        derivation="lambertian-brdf",
        case="lambert-in-furnace",
    ),
    Entry(
        name="mirror-brdf",
        slide=44,
        printed=r"f_{r,s}(p, \omega_i, \omega_o) = f_{r,d}(p, \omega_i)",
        sentence="Идеальное зеркальное отражение",
        english="A mirror has a delta over the cosine, no finite value: it shows the lamp, however small.",
        russian="ДФО зеркала — дельта-функция, делённая на косинус: в зеркале видна сама лампа.",
        checks=(Formula(), Experiment(shrinking_lamp, {"mirror": False})),
        corrected=r"f_{r,s}(p, \omega_i, \omega_o) = \frac{\rho \delta(\omega_i, \omega_r)}{\cos \theta_i}",
        amended=(
            Formula({"ρ": "1", "δ": "1/sr"}),
            Experiment(shrinking_lamp, {"mirror": True}),
            Derived("mirror-brdf"),
        ),
        derivation="mirror-brdf",
        case="mirror-under-sphere",
    ),
    Entry(
        name="btdf",
        slide=45,
        printed="Определение аналогично ДФО, но для другой стороны поверхности",
        sentence="BTDF – Bidirectional Transmittance Distribution Function",
        english="A BTDF has the properties of a BRDF, reciprocity among them.",
        russian="ДФП обладает свойствами ДФО, в том числе обратимостью.",
        checks=(Experiment(there_and_back, {"divided": False}),),
        condition="f is divided by n², n the index on the side that light goes to",
        condition_ru="f делят на n², где n — показатель преломления той стороны, куда идёт свет",
        amended=(Experiment(there_and_back, {"divided": True}), Derived("btdf-reciprocity")),
        derivation="btdf-reciprocity",
    ),
    Entry(
        name="flux-balance",
        slide=45,
        printed=r"D\Phi_R = D\Phi_O + D\Phi_T",
        english="What arrives is reflected or passes.",
        russian="Падающий поток делится на отражённый и прошедший.",
        checks=(Formula(), Experiment(share_passed, {"name": "conductor", "eta": 0.2, "k": 3.0})),
        condition="nothing is absorbed; in general Φ_i = Φ_r + Φ_t + Φ_a",
        condition_ru="поглощения нет; в общем случае Φ_i = Φ_r + Φ_t + Φ_a",
        amended=(
            Formula(),
            Experiment(share_passed, {"name": "dielectric", "eta": 1.5}),
            Derived("flux-balance"),
        ),
        derivation="flux-balance",
    ),
)
