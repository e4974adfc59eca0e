"""Photometry: slide 33, the photometric quantities, their units, and which watts they stand for."""

from __future__ import annotations

from radiokit.worlds.lecture.deciding import Derived, Experiment, Formula, Term, Unit
from radiokit.worlds.lecture.entry import Entry
from radiokit.worlds.lecture.experiments.quantities import (
    equal_units,
    four_pi_lumens,
    lumen,
    observer,
    platinum,
)

__all__ = ["ENTRIES"]

ENTRIES = (
    Entry(
        name="luminous-flux-in-lumens",
        slide=33,
        printed="Световой поток - (люмен – ватт)",
        english="Luminous flux, in lumens, is the twin of radiant flux, in watts.",
        russian="Световой поток (лм) — фотометрический аналог потока излучения (Вт).",
        checks=(
            Term("световой поток", "luminous flux"),
            Unit("luminous_flux", "лм"),
            Unit("radiant_flux", "Вт"),
        ),
    ),
    Entry(
        name="lumen-is-no-watt",
        slide=33,
        printed="поток лучистой энергии, оцениваемый по зрительному ощущению",
        english="Luminous flux is flux as the eye weighs it.",
        russian="Световой поток — поток излучения, оценённый по действию на глаз.",
        checks=(Formula({"Φ_v": "luminous_flux", "K": "lm/W"}, r"\Phi_v = K \Phi"), Experiment(observer)),
        derivation="luminous-flux",
    ),
    Entry(
        name="standard-observer",
        slide=33,
        printed="Поток, взвешенный стандартным наблюдателем",
        english="Φ_v = K_m ∫ V(λ) Φ_λ dλ.",
        russian="Φ_v = K_m ∫ V(λ) Φ_λ dλ.",
        checks=(
            Formula(
                {"Φ_v": "luminous_flux", "K_m": "lm/W", "V": "1", "Φ_λ": "spectral_radiant_flux", "λ": "nm"},
                r"\Phi_v = K_m \int V \Phi_{\lambda} d\lambda",
            ),
            Derived("luminous-flux"),
        ),
        derivation="luminous-flux",
    ),
    Entry(
        name="lumen",
        slide=33,
        printed="Поток внутрь телесного угла 1ср.",
        english="A lumen is the flux into 1 sr.",
        russian="Люмен — поток внутрь телесного угла 1 ср.",
        checks=(
            Formula({"лм": "lm", "ср": "sr"}, r"1 лм = 1 ср"),
            Experiment(lumen, {"candelas": 2.0}),
        ),
        condition="the intensity is 1 cd",
        condition_ru="сила света равна 1 кд",
        amended=(
            Formula({"лм": "lm", "ср": "sr", "кд": "cd"}, r"1 лм = 1 кд \cdot 1 ср"),
            Experiment(lumen, {"candelas": 1.0}),
            Derived("lumen-from-candela"),
        ),
        derivation="lumen-from-candela",
    ),
    Entry(
        name="four-pi-lumens",
        slide=33,
        printed=r"Если 1кд по любому направлению, то полный поток  $4\pi$  лм",
        english="1 cd in every direction makes 4π lm.",
        russian="При силе света 1 кд по всем направлениям полный поток равен 4π лм.",
        checks=(
            Formula({"Φ": "luminous_flux", "I": "luminous_intensity", "π": "sr"}, r"\Phi = 4 \pi I"),
            Experiment(four_pi_lumens),
            Derived("lumen-from-candela"),
        ),
        derivation="lumen-from-candela",
    ),
    Entry(
        name="candela",
        slide=33,
        printed="Сила света - кандела (кд) (ватт на стерадиан)",
        english="Luminous intensity, in candelas, 1 cd = 1 lm/sr, is the twin of watts per steradian.",
        russian="Сила света (кд), 1 кд = 1 лм/ср, — аналог Вт/ср.",
        checks=(
            Term("сила света", "luminous intensity"),
            Unit("luminous_intensity", "кд"),
            Experiment(equal_units, {"left": "1 cd", "right": "1 lm/sr"}),
        ),
    ),
    Entry(
        name="platinum-standard",
        slide=33,
        printed='до платинового эталона была "международная свеча"',
        english="The candela was 1/60 of what 1 cm² of a black body gives at the freezing point of platinum.",
        russian="Канделу задавали как 1/60 силы света 1 см² чёрного тела при затвердевании платины.",
        checks=(Experiment(platinum),),
    ),
    Entry(
        name="lux",
        slide=33,
        printed=r"Освещенность - люкс (1 люмен по площади  $1\text{м}^2$  - ватт /  $\text{M}^2$ )",
        english="Illuminance, in lux, 1 lx = 1 lm/m², is the twin of W/m².",
        russian="Освещённость (лк), 1 лк = 1 лм/м², — аналог Вт/м².",
        checks=(
            Term("освещенность", "illuminance"),
            Experiment(equal_units, {"left": "1 лк", "right": "1 лм/м²"}),
            Derived("lux-from-candela"),
        ),
        derivation="lux-from-candela",
    ),
    Entry(
        name="nit",
        slide=33,
        printed=r"Яркость - (кандела на квм - ватт / стерадиан /  $\text{м}^2$ ) = нит.",
        sentence="Luminance",
        english="Luminance, in nits, 1 nit = 1 cd/m², is the twin of W/(sr m²).",
        russian="Яркость (кд/м², нит) — аналог Вт/(ср·м²).",
        checks=(
            Term("яркость", "luminance"),
            Experiment(equal_units, {"left": "1 нит", "right": "1 кд/м²"}),
            Derived("nit-from-candela"),
        ),
        derivation="nit-from-candela",
    ),
)
