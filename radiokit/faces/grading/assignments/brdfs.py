"""Assignment 2: Lambert, Phong and Blinn-Phong as BRDFs, and the laws that they obey or break."""

from __future__ import annotations

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.assignments._brdfs import functions as brdf
from radiokit.faces.grading.assignments._brdfs import hints
from radiokit.faces.grading.assignments._brdfs import variants as wrong
from radiokit.faces.grading.assignments._brdfs.common import SECONDS, exponents, parts, shares, text, values
from radiokit.faces.grading.judges.laws import Laws
from radiokit.faces.grading.question import Part, Question

__all__ = ["ASSIGNMENT"]

ASSIGNMENT = Assignment(
    name="brdfs",
    title={"en": "Assignment 2: BRDFs and their laws", "ru": "Задание 2: ДФО и их законы"},
    intro={
        "en": r"""
A bidirectional reflectance distribution function (BRDF) says how much of the light from $\omega_i$ leaves
towards $\omega_o$:

$$f_r(\omega_i, \omega_o) = \frac{\mathrm{d}L_o}{L_i \cos\theta_i \, \mathrm{d}\omega_i}.$$

A physical one is reciprocal, $f_r(\omega_i, \omega_o) = f_r(\omega_o, \omega_i)$, and conserves energy:
$\int f_r \cos\theta_o \, \mathrm{d}\omega_o \le 1$ for every $\omega_i$. Write the classical models, find
which of the laws each one obeys, and mend the one that does not. Keep the names of the functions and of
their parameters. NumPy suffices; a function that takes one pair of directions at a time counts as well.

You see how you fare with **ordinary inputs**. **Hard inputs** (grazing directions, the horizon, exact mirror
pairs) are hidden, and so are the **laws**, by which BRDFs are judged over the whole hemisphere. A relative
error of $10^{-9}$ is allowed, and of values [1/sr] below $10^{-9}$ any; what float32 computes earns half.
""",
        "ru": r"""
Двунаправленная функция отражения (ДФО, BRDF) показывает, какая часть света, пришедшего с направления
$\omega_i$, уходит в направлении $\omega_o$:

$$f_r(\omega_i, \omega_o) = \frac{\mathrm{d}L_o}{L_i \cos\theta_i \, \mathrm{d}\omega_i}.$$

Физически корректная ДФО обратима, $f_r(\omega_i, \omega_o) = f_r(\omega_o, \omega_i)$, и сохраняет энергию:
$\int f_r \cos\theta_o \, \mathrm{d}\omega_o \le 1$ для любого $\omega_i$. Напишите классические модели,
выясните, какие законы выполняет каждая из них, и исправьте ту, которая их нарушает. Сохраните имена функций
и их параметров. Достаточно NumPy; годится и функция, принимающая по одной паре направлений за раз.

Результат на **обычных входах** вы видите сразу. **Трудные входы** (скользящие направления, горизонт, точные
зеркальные пары) скрыты, как и проверка **законов** по всей полусфере. Допускается относительная ошибка
$10^{-9}$, а для значений меньше $10^{-9}$ [1/ср] — любая; вычисления в float32 дают половину баллов.
""",
    },
    questions=(
        Question(
            signature="lambert(wi, wo, reflectance)",
            points=2,
            title={"en": "Diffuse reflection", "ru": "Диффузное отражение"},
            text=text(
                "The BRDF of a diffuse surface is the same for all directions. Which constant makes it "
                r"reflect the share `reflectance` $= \rho$ of the light, whatever its direction?",
                "ДФО диффузной поверхности одинакова для всех направлений. При какой константе она "
                r"отражает долю `reflectance` $= \rho$ падающего света независимо от его направления?",
            ),
            parts=parts(
                brdf.by_row(brdf.lambert),
                {},
                Laws(
                    parameters=({"reflectance": 0.9},),
                    reference=brdf.lambert,
                    least=0.5,
                ),
                reflectance=shares,
            ),
            hints=hints.LAMBERT_HINTS,
            seconds=SECONDS,
        ),
        Question(
            signature="mirror_cosine(wi, wo)",
            points=2,
            title={"en": "The angle from the mirror direction", "ru": "Угол от зеркального направления"},
            text={
                "en": "A mirror reflects light from $r$ towards `wo`, where $r$ is `wo` turned by half a "
                r"turn about the normal $z$. Return $\max(0, \cos\alpha)$ for the angle $\alpha$ between "
                "`wi` and $r$. The horizon plays no part here. `wi` and `wo` are unit vectors of shape "
                "`(3,)` or `(N, 3)`.",
                "ru": "Зеркало отражает в направлении `wo` свет, пришедший с направления $r$; оно "
                r"получается из `wo` поворотом на пол-оборота вокруг нормали $z$. Верните $\max(0, "
                r"\cos\alpha)$, где $\alpha$ — угол между `wi` и $r$. Горизонт здесь не важен. `wi` и `wo` "
                "— единичные векторы формы `(3,)` или `(N, 3)`.",
            },
            parts=parts(brdf.mirror_cosine, wrong.MIRROR_COSINE),
            hints=hints.MIRROR_HINTS,
        ),
        Question(
            signature="phong_original(wi, wo, exponent, coefficient)",
            points=3,
            title={"en": "Phong's model of 1975", "ru": "Модель Фонга 1975 года"},
            text=text(
                r"Phong drew highlights as $k_s \cos^n\alpha$ for unit flux on a plane that faces the "
                r"light, without the cosine of incidence. As a BRDF this is $f = k_s \cos^n\alpha / "
                r"\cos\theta_i$, with $k_s$ = `coefficient` in $\mathrm{sr}^{-1}$, $n$ = `exponent`, and "
                r"$\cos\alpha$ as in `mirror_cosine`. Write it as it stands. It breaks both laws: find out "
                "why, and at which angles.",
                r"Фонг изображал блики как $k_s \cos^n\alpha$ при единичном потоке на площадку, повёрнутую "
                r"к источнику, без косинуса угла падения. В виде ДФО это $f = k_s \cos^n\alpha / "
                r"\cos\theta_i$, где $k_s$ = `coefficient` в $\mathrm{ср}^{-1}$, $n$ = `exponent`, а "
                r"$\cos\alpha$ — как в `mirror_cosine`. Запишите её как есть. Она нарушает оба закона: "
                "выясните, почему и при каких углах.",
            ),
            parts=parts(
                brdf.by_row(brdf.phong_original),
                wrong.PHONG_ORIGINAL,
                Laws(
                    expected={"reciprocity": "violated", "energy": "violated"},
                    parameters=({"exponent": 10.0, "coefficient": 0.3},),
                    reference=brdf.phong_original,
                    variants=wrong.PHONG_ORIGINAL,
                ),
                exponent=exponents(100),
                coefficient=shares,
            ),
            hints=hints.ORIGINAL_HINTS,
            seconds=SECONDS,
        ),
        Question(
            signature="phong(wi, wo, exponent)",
            points=3,
            title={"en": "The modified Phong lobe", "ru": "Модифицированный лепесток Фонга"},
            text=text(
                r"Drop the division, and the lobe $f = N(n) \cos^n\alpha$ is reciprocal. Find the $N(n)$ "
                r"for which it reflects exactly all light at normal incidence: there $\alpha = \theta$, and "
                r"$\int f \cos\theta\, \mathrm{d}\omega = 1$ over the hemisphere. $n$ = `exponent`.",
                r"Без деления на косинус лепесток $f = N(n) \cos^n\alpha$ обратим. Найдите $N(n)$, при "
                r"котором он отражает ровно весь свет, падающий по нормали: тогда $\alpha = \theta$ и $\int "
                r"f \cos\theta\, \mathrm{d}\omega = 1$ по полусфере. $n$ = `exponent`.",
            ),
            parts=parts(
                brdf.by_row(brdf.phong),
                wrong.PHONG,
                Laws(
                    parameters=({"exponent": 10.0}, {"exponent": 50.0}),
                    reference=brdf.phong,
                    variants=wrong.PHONG,
                    least=0.5,
                ),
                exponent=exponents(100),
            ),
            hints=hints.PHONG_HINTS,
            seconds=SECONDS,
        ),
        Question(
            signature="half_cosine(wi, wo)",
            points=2,
            title={"en": "The half vector", "ru": "Полувектор"},
            text={
                "en": r"Return $\cos\delta = h \cdot n$ for the half vector $h = (\omega_i + \omega_o) / "
                r"|\omega_i + \omega_o|$ and the normal $n = z$, and 0 where either direction is not above "
                "the horizon. `wi` and `wo` are unit vectors of shape `(3,)` or `(N, 3)`; they may be "
                "opposite.",
                "ru": r"Верните $\cos\delta = h \cdot n$ для полувектора $h = (\omega_i + \omega_o) / "
                r"|\omega_i + \omega_o|$ и нормали $n = z$ и 0, если хотя бы одно из направлений не выше "
                "горизонта. `wi` и `wo` — единичные векторы формы `(3,)` или `(N, 3)`; они могут быть "
                "противоположны.",
            },
            parts=parts(brdf.half_cosine, wrong.HALF_COSINE),
            hints=hints.HINTS,
        ),
        Question(
            signature="blinn_phong(wi, wo, exponent)",
            points=3,
            title={"en": "Blinn-Phong, normalised", "ru": "Нормированная модель Блинна-Фонга"},
            text=text(
                r"Blinn's lobe is $f = N(n) \cos^n\delta$, with $n$ = `exponent` and $\delta$ the angle "
                r"between half vector and normal. The constant met in books, $(n + 8)/(8\pi)$, gains 7.5 % "
                "of energy at $n = 10$. Find the one for which exactly all light is reflected at normal "
                r"incidence; there $\delta = \theta/2$. (With $c = \cos\delta$: $\cos\theta = 2c^2 - 1$ and "
                r"$\mathrm{d}\omega = 8\pi\, c\, |\mathrm{d}c|$, where $c$ goes from $1/\sqrt 2$ to 1.)",
                r"Лепесток Блинна — $f = N(n) \cos^n\delta$, где $n$ = `exponent`, а $\delta$ — угол между "
                r"полувектором и нормалью. Константа из книг, $(n + 8)/(8\pi)$, при $n = 10$ даёт лишние "
                "7.5 % энергии. Найдите ту, при которой свет, падающий по нормали, отражается ровно весь; "
                r"тогда $\delta = \theta/2$. (При $c = \cos\delta$: $\cos\theta = 2c^2 - 1$ и "
                r"$\mathrm{d}\omega = 8\pi\, c\, |\mathrm{d}c|$, где $c$ меняется от $1/\sqrt 2$ до 1.)",
            ),
            parts=parts(
                brdf.by_row(brdf.blinn_phong),
                wrong.BLINN_PHONG,
                Laws(
                    parameters=({"exponent": 10.0}, {"exponent": 100.0}),
                    reference=brdf.blinn_phong,
                    variants=wrong.BLINN_PHONG,
                    least=0.5,
                ),
                exponent=exponents(100),
            ),
            hints=hints.BLINN_HINTS,
            seconds=SECONDS,
        ),
        Question(
            signature="asymmetry(a, b)",
            points=2,
            title={"en": "How far from reciprocal?", "ru": "Насколько нарушена обратимость?"},
            text={
                "en": r"You check someone else's BRDF: `a` holds its values $f(\omega_i, \omega_o)$ for "
                "some pairs of directions, and `b` those with the directions exchanged, at least 0. For "
                r"each pair return the relative asymmetry $|a - b| / \max(a, b)$, and 0 where both values "
                "are 0. Try it on your own models.",
                "ru": r"Вы проверяете чужую ДФО: в `a` её значения $f(\omega_i, \omega_o)$ для нескольких "
                "пар направлений, в `b` — значения для тех же пар, взятых наоборот; все они "
                r"неотрицательны. Для каждой пары верните относительную асимметрию $|a - b| / \max(a, b)$ и "
                "0, если оба значения равны 0. Испытайте её на своих моделях.",
            },
            parts=(
                Part(name="ordinary", judge=values(brdf.unlike, brdf.asymmetry, wrong.ASYMMETRY), weight=2),
                Part(
                    name="hard",
                    judge=values(brdf.hard_values, brdf.asymmetry, wrong.ASYMMETRY),
                    visibility="after_published",
                ),
            ),
            hints=hints.HINTS,
        ),
        Question(
            signature="mixed(wi, wo, diffuse, specular, exponent)",
            points=3,
            title={"en": "Diffuse and specular together", "ru": "Диффузное и зеркальное вместе"},
            text=text(
                "A surface reflects the share $k_d$ = `diffuse` diffusely, and a share in the modified "
                r"Phong lobe: $f = k_d/\pi + k_s N(n) \cos^n\alpha$, with $k_s$ = `specular`, $n$ = "
                "`exponent` and the $N(n)$ of `phong`. Users may ask for too much: where $k_d + k_s > 1$, "
                "divide both by their sum, so that energy is conserved.",
                "Поверхность отражает долю $k_d$ = `diffuse` диффузно, а ещё одну — в модифицированном "
                r"лепестке Фонга: $f = k_d/\pi + k_s N(n) \cos^n\alpha$, где $k_s$ = `specular`, $n$ = "
                "`exponent`, а $N(n)$ — из `phong`. Пользователь может задать слишком много: если $k_d + "
                "k_s > 1$, разделите обе доли на их сумму, чтобы энергия сохранялась.",
            ),
            parts=parts(
                brdf.mixed_values,
                wrong.MIXED,
                Laws(
                    parameters=({"diffuse": 0.9, "specular": 0.8, "exponent": 20.0},),
                    reference=brdf.mixed,
                    variants=wrong.MIXED,
                    least=0.5,
                ),
                diffuse=shares,
                specular=shares,
                exponent=exponents(100),
            ),
            hints=hints.PHONG_HINTS,
            seconds=SECONDS,
        ),
    ),
)
