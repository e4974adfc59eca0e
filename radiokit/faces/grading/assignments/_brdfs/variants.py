"""What wrong solutions of assignment 2 give, by the misconception, and what is said of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._brdfs.functions import half_cosine, mirror_cosine
from radiokit.faces.grading.words import Words

__all__ = [
    "ASYMMETRY",
    "BLINN_HINTS",
    "BLINN_PHONG",
    "HALF_COSINE",
    "HINTS",
    "LAMBERT_HINTS",
    "MIRROR_COSINE",
    "MIRROR_HINTS",
    "MIXED",
    "ORIGINAL_HINTS",
    "PHONG",
    "PHONG_HINTS",
    "PHONG_ORIGINAL",
]

Array = Any
Cosine = Callable[[Array, Array], Array]
Function = Callable[..., Array]
Lobe = Callable[..., Array]
"""``lobe(c, wi, wo, **parameters)``: a BRDF above the horizon, from the cosine that it is a power of."""


def _dot(signs: tuple[int, int, int]) -> Cosine:
    """Return the cosine between wi and wo with the signs of its components changed so."""
    return lambda wi, wo: np.sum(wi * wo * signs, axis=-1)


def _of_half(of: str) -> Cosine:
    """Return the cosine between the half vector and the normal or the viewer."""

    def cosine(wi: Array, wo: Array) -> Array:
        h = wi + wo
        length = np.sqrt(np.sum(h * h, axis=-1))
        axis = {"normal": np.array([0.0, 0.0, 1.0]), "viewer": wo}[of]
        return np.sum(h * axis, axis=-1) / np.where(length > 0, length, 1.0)

    return cosine


def _clamped(c: Array) -> Array:
    return np.maximum(c, 0.0)


def _brdf(lobe: Lobe, cosine: Cosine) -> Function:
    """Return f(wi, wo, **parameters), 0 below the horizon."""

    def f(wi: Array, wo: Array, **parameters: Array) -> Array:
        with np.errstate(all="ignore"):
            found = lobe(_clamped(cosine(wi, wo)), wi, wo, **parameters)
        return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), found, 0.0)

    return f


def _about_mirror(lobe: Lobe) -> dict[str, Function]:
    return {
        "mirror-about-wrong-axis": _brdf(lobe, _dot((1, 1, -1))),
        "mirror-forgotten": _brdf(lobe, _dot((1, 1, 1))),
        "mirror-of-x-alone": _brdf(lobe, _dot((-1, 1, 1))),
        "mirror-of-y-alone": _brdf(lobe, _dot((1, -1, 1))),
        "half-for-mirror": _brdf(lobe, _of_half("normal")),
        **_powers(lobe, mirror_cosine),
    }


def _powers(lobe: Lobe, cosine: Cosine) -> dict[str, Function]:
    """Return what other exponents give, while the constant is right."""

    def wrong(power: Callable[[Array], Array]) -> Function:
        def other(c: Array, wi: Array, wo: Array, *, exponent: Array, **parameters: Array) -> Array:
            return lobe(np.ones_like(c), wi, wo, exponent=exponent, **parameters) * c ** power(exponent)

        return _brdf(other, cosine)

    return {
        "exponent-one-more": wrong(lambda n: n + 1),
        "exponent-one-less": wrong(lambda n: n - 1),
        "exponent-two-more": wrong(lambda n: n + 2),
        "exponent-ignored": wrong(lambda n: 1.0 + 0 * n),
    }


def _original(c: Array, wi: Array, wo: Array, *, exponent: Array, coefficient: Array) -> Array:
    return coefficient * c**exponent / wi[..., 2]


def _phong(c: Array, wi: Array, wo: Array, *, exponent: Array) -> Array:
    return (exponent + 2) / (2 * np.pi) * c**exponent


def _blinn_phong(c: Array, wi: Array, wo: Array, *, exponent: Array) -> Array:
    n = exponent
    return (n + 2) * (n + 4) / (8 * np.pi * (np.exp2(-n / 2) + n)) * c**n


def _times(lobe: Lobe, factor: Callable[[Array, Array], Array]) -> Function:
    """Return a lobe about the mirror direction times a function of both cosines."""

    def other(c: Array, wi: Array, wo: Array, **parameters: Array) -> Array:
        return lobe(c, wi, wo, **parameters) * factor(wi[..., 2], wo[..., 2])

    return _brdf(other, mirror_cosine)


def _mixed(combine: Callable[[Array, Array, Array], Array], normalised: bool = True) -> Function:
    def lobe(c: Array, wi: Array, wo: Array, *, diffuse: Array, specular: Array, exponent: Array) -> Array:
        scale = (exponent + 2) / (2 * np.pi) if normalised else 1.0
        return combine(diffuse, specular, scale * c**exponent)

    return _brdf(lobe, mirror_cosine)


def _whole(kd: Array, ks: Array) -> Array:
    return np.maximum(1.0, kd + ks)


def _angle(c: Array) -> Array:
    return np.arccos(np.clip(c, -1, 1))


def _ratio(top: Array, bottom: Array) -> Array:
    return np.where(bottom > 0, top / np.where(bottom > 0, bottom, 1.0), 0.0)


MIRROR_COSINE: Mapping[str, Function] = {
    "mirror-about-wrong-axis": lambda wi, wo: _clamped(_dot((1, 1, -1))(wi, wo)),
    "mirror-forgotten": lambda wi, wo: _clamped(_dot((1, 1, 1))(wi, wo)),
    "mirror-of-x-alone": lambda wi, wo: _clamped(_dot((-1, 1, 1))(wi, wo)),
    "mirror-of-y-alone": lambda wi, wo: _clamped(_dot((1, -1, 1))(wi, wo)),
    "half-for-mirror": lambda wi, wo: _clamped(_of_half("normal")(wi, wo)),
    "angle-for-cosine": lambda wi, wo: _angle(_dot((-1, -1, 1))(wi, wo)),
    "angle-in-degrees": lambda wi, wo: np.degrees(_angle(_dot((-1, -1, 1))(wi, wo))),
}

PHONG_ORIGINAL: Mapping[str, Function] = {
    **_about_mirror(_original),
    "divided-by-viewer-cosine": _times(_original, lambda i, o: i / o),
    "coefficient-forgotten": _brdf(
        lambda c, wi, wo, *, exponent, coefficient: c**exponent / wi[..., 2], mirror_cosine
    ),
}

PHONG: Mapping[str, Function] = _about_mirror(_phong)

HALF_COSINE: Mapping[str, Function] = {
    "mirror-for-half": _brdf(lambda c, wi, wo: c, _dot((-1, -1, 1))),
    "half-from-viewer": _brdf(lambda c, wi, wo: c, _of_half("viewer")),
    "angle-for-cosine": _brdf(lambda c, wi, wo: _angle(c), _of_half("normal")),
    "angle-in-degrees": _brdf(lambda c, wi, wo: np.degrees(_angle(c)), _of_half("normal")),
}

BLINN_PHONG: Mapping[str, Function] = {
    "mirror-for-half": _brdf(_blinn_phong, _dot((-1, -1, 1))),
    "half-from-viewer": _brdf(_blinn_phong, _of_half("viewer")),
    **_powers(_blinn_phong, half_cosine),
}

ASYMMETRY: Mapping[str, Function] = {
    "sign-kept": lambda a, b: _ratio(a - b, np.maximum(a, b)),
    "sign-kept-reversed": lambda a, b: _ratio(b - a, np.maximum(a, b)),
    "not-relative": lambda a, b: np.abs(a - b),
    "relative-to-first": lambda a, b: _ratio(np.abs(a - b), a),
    "relative-to-second": lambda a, b: _ratio(np.abs(a - b), b),
    "relative-to-smaller": lambda a, b: _ratio(np.abs(a - b), np.minimum(a, b)),
    "relative-to-sum": lambda a, b: _ratio(np.abs(a - b), a + b),
    "relative-to-mean": lambda a, b: _ratio(np.abs(a - b), (a + b) / 2),
}

MIXED: Mapping[str, Function] = {
    "shares-not-limited": _mixed(lambda kd, ks, lobe: kd / np.pi + ks * lobe),
    "always-divided": _mixed(lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / (kd + ks)),
    "specular-alone-limited": _mixed(lambda kd, ks, lobe: kd / np.pi + np.minimum(ks, 1 - kd) * lobe),
    "diffuse-alone-limited": _mixed(lambda kd, ks, lobe: np.minimum(kd, 1 - ks) / np.pi + ks * lobe),
    "diffuse-without-pi": _mixed(lambda kd, ks, lobe: (kd + ks * lobe) / _whole(kd, ks)),
    "lobe-not-normalised": _mixed(lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / _whole(kd, ks), False),
}

HINTS: Mapping[str, Words] = {
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
        "en": "You took the angle between the half vector and wo: it is that between the half vector and "
        "the normal.",
        "ru": "Вы взяли угол между полувектором и wo, а нужен угол между полувектором и нормалью.",
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
    "diffuse-without-pi": {
        "en": "The diffuse part lacks 1/π.",
        "ru": "В диффузной части не хватает 1/π.",
    },
    "lobe-not-normalised": {
        "en": "The specular lobe is not normalised: it lacks (n + 2)/(2π).",
        "ru": "Зеркальный лепесток не нормирован: не хватает (n + 2)/(2π).",
    },
}
"""What is said of a misconception in this assignment, before what the catalogue says."""

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
        "en": "Your value is not 0 where it should be: below the horizon, and where cos α < 0. There an "
        "even power or |cos α| makes a second lobe.",
        "ru": "У вас не 0 там, где он должен быть: под горизонтом и при cos α < 0, где чётная степень или "
        "|cos α| даёт второй лепесток.",
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
