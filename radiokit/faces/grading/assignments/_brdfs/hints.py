"""Hints: what is said of a misconception in assignment 2, before what the catalogue says."""

from __future__ import annotations

from collections.abc import Mapping

from radiokit.faces.grading.words import Words

__all__ = ["BLINN_HINTS", "HINTS", "LAMBERT_HINTS", "MIRROR_HINTS", "ORIGINAL_HINTS", "PHONG_HINTS"]

HINTS: Mapping[str, Words] = {
    "horizon-not-clamped": {
        "en": "Your value is not 0 where wi or wo is not above the horizon: both are to be looked at.",
        "ru": "У вас не 0 там, где wi или wo не выше горизонта: проверять нужно оба направления.",
    },
    "mirror-about-wrong-axis": {
        "en": "You mirrored at the surface, (x, y, −z), which ends below it: about the normal it is (−x, "
        "−y, z).",
        "ru": "Вы отразили относительно плоскости, (x, y, −z), а это уже под поверхностью: относительно "
        "нормали получается (−x, −y, z).",
    },
    "mirror-forgotten": {
        "en": "You took the angle between wi and wo themselves: mirror one of them about the normal first.",
        "ru": "Вы взяли угол между самими wi и wo: сначала отразите один из них относительно нормали.",
    },
    "all-three-turned": {
        "en": "You changed all three signs: about the normal z, only x and y change theirs.",
        "ru": "Вы сменили все три знака: при отражении относительно нормали z знак меняют только x и y.",
    },
    "horizon-clamped": {
        "en": "You gave 0 below the horizon: here the horizon plays no part.",
        "ru": "Под горизонтом у вас 0, а в этом вопросе горизонт не важен.",
    },
    "reflection-with-plus": {
        "en": "r = 2 (n · wo) n − wo: you added wo.",
        "ru": "r = 2 (n · wo) n − wo: вы прибавили wo, а его нужно вычесть.",
    },
    "reflection-without-two": {
        "en": "r = 2 (n · wo) n − wo: the 2 is missing.",
        "ru": "r = 2 (n · wo) n − wo: пропущена двойка.",
    },
    "angle-without-mirror": {
        "en": "Two mistakes at once: you gave the angle and not its cosine, and nothing is mirrored.",
        "ru": "Две ошибки сразу: это угол, а не его косинус, и ничто не отражено.",
    },
    "half-of-difference": {
        "en": "You took wi − wo: the half vector is that of the sum, wi + wo.",
        "ru": "Вы взяли wi − wo: полувектор — это направление суммы wi + wo.",
    },
    "half-over-square": {
        "en": "You divided by the square of the length of wi + wo: take the root.",
        "ru": "Вы разделили на квадрат длины wi + wo: извлеките корень.",
    },
    "mean-of-angles": {
        "en": "(θi + θo)/2 is the half vector's angle only where wi and wo are on one meridian: use wi + wo.",
        "ru": "(θi + θo)/2 — угол полувектора, лишь если wi и wo на одном меридиане: возьмите wi + wo.",
    },
    **{
        f"power-of-two-{name}": {
            "en": "Your constant is right but for the power of two: what is 1/√2 to the power of n?",
            "ru": "Константа верна, кроме степени двойки: чему равна n-я степень числа 1/√2?",
        }
        for name in ("sign", "whole", "forgotten", "negated")
    },
    "mirror-of-x-alone": {
        "en": "You changed the sign of x alone: about the normal z, both x and y change theirs.",
        "ru": "Вы сменили знак только у x: при отражении относительно нормали z знак меняют и x, и y.",
    },
    "mirror-of-y-alone": {
        "en": "You changed the sign of y alone: about the normal z, both x and y change theirs.",
        "ru": "Вы сменили знак только у y: при отражении относительно нормали z знак меняют и x, и y.",
    },
    "half-for-mirror": {
        "en": "You took the half vector, as Blinn does: Phong's angle α is that from the mirror direction.",
        "ru": "Вы взяли полувектор, как Блинн: у Фонга угол α отсчитывают от зеркального направления.",
    },
    "exponent-one-more": {
        "en": "Your exponent is n + 1: a BRDF does not hold the cosine of the lighting integral.",
        "ru": "У вас показатель n + 1: косинус из интеграла освещения в ДФО не входит.",
    },
    "exponent-one-less": {
        "en": "Your exponent is n − 1 where it is n.",
        "ru": "У вас показатель n − 1, а должен быть n.",
    },
    "exponent-two-more": {
        "en": "Your exponent is n + 2: that number belongs to the normalisation alone.",
        "ru": "У вас показатель n + 2: это число относится только к нормировке.",
    },
    "exponent-ignored": {
        "en": "Your lobe does not depend on the exponent.",
        "ru": "Ваш лепесток не зависит от показателя степени.",
    },
    "angle-for-cosine": {
        "en": "You gave the angle itself, and its cosine is asked for.",
        "ru": "Вы вернули сам угол, а нужен его косинус.",
    },
    "angle-in-degrees": {
        "en": "You gave the angle itself, in degrees, and its cosine is asked for.",
        "ru": "Вы вернули сам угол, да ещё в градусах, а нужен его косинус.",
    },
    "divided-by-viewer-cosine": {
        "en": "You divided by the viewer's cosine: it is the light's, cos θi, that the irradiance holds.",
        "ru": "Вы разделили на косинус наблюдателя, а в освещённость входит косинус источника, cos θi.",
    },
    "coefficient-forgotten": {
        "en": "You forgot the coefficient k_s.",
        "ru": "Вы забыли коэффициент k_s.",
    },
    "mirror-for-half": {
        "en": "You took the angle from the mirror direction, as Phong does: Blinn's is that of the half "
        "vector.",
        "ru": "Вы взяли угол от зеркального направления, как Фонг: у Блинна это угол полувектора с нормалью.",
    },
    "half-from-viewer": {
        "en": "You took the angle between the half vector and wi or wo, which is one: it is that between the "
        "half vector and the normal.",
        "ru": "Вы взяли угол между полувектором и wi или wo (он один и тот же), а нужен угол между "
        "полувектором и нормалью.",
    },
    "sign-kept": {
        "en": "You kept the sign of the difference: take its absolute value.",
        "ru": "У вас остался знак разности: возьмите модуль.",
    },
    "sign-kept-reversed": {
        "en": "You kept the sign of the difference, and it is reversed too: take its absolute value.",
        "ru": "У вас остался знак разности, к тому же обратный: возьмите модуль.",
    },
    "not-relative": {
        "en": "You gave the difference itself: divide it by the larger of the two values.",
        "ru": "Вы вернули саму разность: разделите её на большее из двух значений.",
    },
    **{
        f"relative-to-{name}": {
            "en": f"You divided by {english}: divide by the larger of the two, so that the measure is "
            "symmetric and at most 1.",
            "ru": f"Вы разделили на {russian}: делите на большее из двух, тогда мера симметрична и не "
            "больше 1.",
        }
        for name, english, russian in (
            ("first", "the first value", "первое значение"),
            ("second", "the second value", "второе значение"),
            ("smaller", "the smaller value", "меньшее значение"),
            ("sum", "the sum", "сумму"),
            ("mean", "the mean", "среднее"),
        )
    },
    "shares-not-limited": {
        "en": "You did not limit the shares: where k_d + k_s > 1, divide both by their sum.",
        "ru": "Вы не ограничили доли: если k_d + k_s > 1, разделите обе на их сумму.",
    },
    "always-divided": {
        "en": "You divided by k_d + k_s always: where the sum is at most 1, the rest is absorbed.",
        "ru": "Вы всегда делите на k_d + k_s: если сумма не больше 1, остаток поглощается.",
    },
    "specular-alone-limited": {
        "en": "You limited the specular share alone: divide both by their sum.",
        "ru": "Вы ограничили только зеркальную долю: делить на сумму нужно обе.",
    },
    "diffuse-alone-limited": {
        "en": "You limited the diffuse share alone: divide both by their sum.",
        "ru": "Вы ограничили только диффузную долю: делить на сумму нужно обе.",
    },
    "diffuse-not-divided": {
        "en": "You divided the specular share alone: where k_d + k_s > 1, divide both by their sum.",
        "ru": "Вы разделили только зеркальную долю: если k_d + k_s > 1, на сумму делят обе.",
    },
    "specular-not-divided": {
        "en": "You divided the diffuse share alone: where k_d + k_s > 1, divide both by their sum.",
        "ru": "Вы разделили только диффузную долю: если k_d + k_s > 1, на сумму делят обе.",
    },
    "divided-in-turn": {
        "en": "You divided the second share by a sum that the first had left changed: keep the sum first.",
        "ru": "Вторую долю вы делите на сумму с уже изменённой первой: сначала запомните сумму.",
    },
    "sum-of-values": {
        "en": "You compared k_d/π + k_s with 1: the shares are k_d and k_s, without π.",
        "ru": "Вы сравнили с 1 сумму k_d/π + k_s: доли — это k_d и k_s, без π.",
    },
    "lobe-with-one": {
        "en": "Your lobe has the constant (n + 1)/(2π): a BRDF's is (n + 2)/(2π), as in phong.",
        "ru": "У вашего лепестка константа (n + 1)/(2π): у ДФО она (n + 2)/(2π), как в phong.",
    },
    "neither-limited-nor-with-pi": {
        "en": "Two mistakes at once: the shares are not limited, and the diffuse part lacks 1/π.",
        "ru": "Две ошибки сразу: доли не ограничены, и в диффузной части не хватает 1/π.",
    },
    "neither-limited-nor-normalised": {
        "en": "Two mistakes at once: the shares are not limited, and the lobe is not normalised.",
        "ru": "Две ошибки сразу: доли не ограничены, и лепесток не нормирован.",
    },
    "diffuse-without-pi": {
        "en": "The diffuse part lacks 1/π.",
        "ru": "В диффузной части не хватает 1/π.",
    },
    "lobe-not-normalised": {
        "en": "The specular lobe is not normalised: it lacks (n + 2)/(2π).",
        "ru": "Зеркальный лепесток не нормирован: не хватает (n + 2)/(2π).",
    },
}
"""For every question; the others are for the one that they are called by."""

LAMBERT_HINTS: Mapping[str, Words] = {
    **HINTS,
    "halved": {
        "en": "You divided by 2π, the hemisphere's solid angle: the integral of cos θ over it is π.",
        "ru": "Вы разделили на 2π, телесный угол полусферы, а интеграл cos θ по полусфере равен π.",
    },
    "constant-answer": {
        "en": "Your value does not depend on the reflectance ρ.",
        "ru": "Ваше значение не зависит от коэффициента отражения ρ.",
    },
}

BLINN_HINTS: Mapping[str, Words] = {
    **HINTS,
    "lobe-normalisation": {
        "en": "Your lobe has another constant than is asked, such as Phong's (n + 2)/(2π) or the (n + "
        "8)/(8π) of books: integrate cosⁿδ cos θ over the hemisphere, where δ = θ/2, and divide by that.",
        "ru": "У вашего лепестка не та константа — например, (n + 2)/(2π) Фонга или (n + 8)/(8π) из книг: "
        "проинтегрируйте cosⁿδ cos θ по полусфере, где δ = θ/2, и разделите на результат.",
    },
}

MIRROR_HINTS: Mapping[str, Words] = {
    **HINTS,
    "horizon-not-clamped": {
        "en": "Where cos α is negative the answer is 0, and yours is not: take max(0, cos α), not |cos α|.",
        "ru": "Там, где cos α отрицателен, ответ равен 0, а у вас нет: нужно max(0, cos α), а не |cos α|.",
    },
}

PHONG_HINTS: Mapping[str, Words] = {
    **HINTS,
    "lobe-normalisation": {
        "en": "Your lobe has another constant than is asked: at normal incidence integrate cosⁿθ cos θ "
        "over the hemisphere, and divide by that.",
        "ru": "У вашего лепестка не та константа: проинтегрируйте cosⁿθ cos θ по полусфере при падении по "
        "нормали и разделите на результат.",
    },
    "horizon-not-clamped": {
        "en": "Your value is not 0 where it should be: where wi or wo is not above the horizon, or where "
        "cos α < 0, so that an even power or |cos α| makes a second lobe.",
        "ru": "У вас не 0 там, где он должен быть: где wi или wo не выше горизонта либо где cos α < 0, так "
        "что чётная степень или |cos α| даёт второй лепесток.",
    },
    "cosine-forgotten": {
        "en": "You divided by cos θi, as in the model of 1975: the modified lobe has no cosine below, and "
        "so it is reciprocal.",
        "ru": "Вы разделили на cos θi, как в модели 1975 года: у модифицированного лепестка косинуса в "
        "знаменателе нет, поэтому он и обратим.",
    },
}

ORIGINAL_HINTS: Mapping[str, Words] = {
    **PHONG_HINTS,
    "viewer-cosine-forgotten": {
        "en": "You divided by both cosines: only cos θi stands below.",
        "ru": "Вы разделили на оба косинуса: в знаменателе только cos θi.",
    },
    "cosine-twice": {
        "en": "You forgot to divide by cos θi: Phong gave the light that is seen, and a BRDF is that over "
        "the irradiance.",
        "ru": "Вы забыли разделить на cos θi: у Фонга это видимый свет, а ДФО — его отношение к "
        "освещённости.",
    },
    "cosine-forgotten": {
        "en": "You divided by cos θi twice.",
        "ru": "Вы дважды разделили на cos θi.",
    },
}
