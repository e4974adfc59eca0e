"""Law words: what feedback says of the laws that a BRDF obeys or breaks, in English and Russian."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from radiokit.faces.grading.words import Words

__all__ = ["LAW_NAMES", "LAW_SENTENCES", "LIKENESS_HINTS", "law_name", "tell"]

LAW_SENTENCES: Mapping[str, Words] = {
    "slow": {
        "en": "; judging takes about {pairs} pairs of directions: compute with whole arrays, without loops",
        "ru": "; для проверки нужно около {pairs} пар направлений: считайте целыми массивами, без циклов",
    },
    "keyword": {
        "en": "; its parameters must have the names that the question gives them",
        "ru": "; параметры должны называться так, как в условии",
    },
    "at": {"en": " at {place}", "ru": " при {place}"},
    "directions": {
        "en": "wi: θ = {wi[0]}, φ = {wi[1]}; wo: θ = {wo[0]}, φ = {wo[1]}",
        "ru": "wi: θ = {wi[0]}, φ = {wi[1]}; wo: θ = {wo[0]}, φ = {wo[1]}",
    },
    "given": {"en": "for {parameters}: {text}", "ru": "при {parameters}: {text}"},
    "finite": {"en": "finite and nowhere negative", "ru": "значения конечны и нигде не отрицательны"},
    "not-finite": {"en": "gives {value} at {place}", "ru": "даёт {value} при {place}"},
    "negative": {
        "en": "is negative: f = {value} at {place}",
        "ru": "отрицательна: f = {value} при {place}",
    },
    "reciprocal": {
        "en": "reciprocal at all {pairs} pairs of directions that were tried",
        "ru": "обратимость выполняется на всех проверенных парах направлений ({pairs})",
    },
    "not-reciprocal": {
        "en": "is not reciprocal: f(wi, wo) = {one}, but with the directions exchanged {two} ({place})",
        "ru": "нарушает обратимость: f(wi, wo) = {one}, а если поменять направления местами, {two} ({place})",
    },
    "conserves": {
        "en": "reflects at most {share} of the light, at θ = {theta}",
        "ru": "отражает не более {share} света, больше всего при θ = {theta}",
    },
    "gains": {
        "en": "gains energy: at θ = {theta} it reflects {share} of the light",
        "ru": "нарушает сохранение энергии: при θ = {theta} отражает {share} света",
    },
    "gains-everywhere": {
        "en": "gains energy: reflects {share} of the light at every angle",
        "ru": "нарушает сохранение энергии: отражает {share} света под любым углом",
    },
    "gains-for-viewer": {
        "en": "gains energy: for a viewer at θ = {theta}, ∫ f cos θi dωi = {value}, and at most 1 is right",
        "ru": "нарушает сохранение энергии: для наблюдателя под углом θ = {theta} интеграл "
        "∫ f cos θi dωi = {value}, а должен быть не больше 1",
    },
    "to-grazing": {"en": ", and more as θ → 90°", "ru": ", а при θ → 90° ещё больше"},
    "unclear": {
        "en": "is too near the limit to tell: it reflects {share} of the light ± {error}",
        "ru": "слишком близка к пределу, чтобы сказать точно: отражает {share} света ± {error}",
    },
    "even": {
        "en": "reflects {share} of the light at every angle",
        "ru": "отражает {share} света под любым углом",
    },
    "unjudged": {
        "en": "so it cannot be judged for {laws}",
        "ru": "поэтому нельзя проверить {laws}",
    },
    "as-it-should": {"en": "as it should, {text}", "ru": "как и должна, {text}"},
    "should-break": {
        "en": "one is asked for that breaks this law",
        "ru": "а нужна ДФО, которая этот закон нарушает",
    },
    "black": {
        "en": "reflects at most {share} of the light, and at least {least} is asked for: a black surface "
        "obeys every law",
        "ru": "отражает не более {share} света, а требуется не менее {least}: чёрная поверхность "
        "подчиняется любым законам",
    },
    "stranger": {
        "en": "is not the function that is asked for, so that the laws it obeys earn nothing",
        "ru": "это не та функция, которую просили, поэтому за выполнение законов баллов нет",
    },
    "at-few": {
        "en": "is right at most pairs of directions and wrong at {bad} of {count}, as at {place}",
        "ru": "верна почти всюду, но не на {bad} из {count} пар направлений, например при {place}",
    },
    "factor": {
        "en": "is {factor} times the function that is asked for",
        "ru": "равна нужной функции, умноженной на {factor}",
    },
    "float32": {
        "en": "computed in float32: judged to its seven digits, use float64",
        "ru": "вычислена в float32: проверена с точностью до семи цифр, используйте float64",
    },
    "prints": {
        "en": "it prints while it computes: remove that",
        "ru": "во время вычислений она печатает: уберите это",
    },
    "writes": {
        "en": "it writes into the arrays that it is given: work on copies",
        "ru": "она изменяет переданные ей массивы: работайте с копиями",
    },
    "mixes": {
        "en": "it mixes up the rows of an array, and was called pair by pair: sum over axis=-1",
        "ru": "она смешивает строки массива и вызывалась по одной паре: суммируйте по axis=-1",
    },
    "below": {
        "en": "it is not 0 below the horizon: make it 0 where either cosine is not above 0",
        "ru": "под горизонтом она не равна 0: верните 0, если хотя бы один косинус не больше 0",
    },
}
"""What is said of the laws; what any judge says stands in ``words``."""

LIKENESS_HINTS: Mapping[str, Words] = {
    "cosine-forgotten": {
        "en": "Your values are 1/cos θ times too large, θ the light's angle: a division by that cosine is "
        "one too many, or a factor cos θ is missing.",
        "ru": "Ваши значения в 1/cos θ раз больше верных, где θ — угол падения: лишнее деление на этот "
        "косинус или не хватает множителя cos θ.",
    },
}
"""What is said of a BRDF where the catalogue speaks of an irradiance."""

LAW_NAMES: Mapping[str, Words] = {
    "values": {"en": "its values", "ru": "значения"},
    "reciprocity": {"en": "reciprocity", "ru": "обратимость"},
    "energy": {"en": "conservation of energy", "ru": "сохранение энергии"},
}


def tell(language: str, key: str, **values: Any) -> str:
    """Return a sentence.

    >>> tell("en", "at", place="θ = 30°")
    ' at θ = 30°'
    """
    return LAW_SENTENCES[key][language].format(**values)


def law_name(law: str, language: str) -> str:
    """Return what a law is called in a sentence.

    >>> law_name("energy", "ru")
    'сохранение энергии'
    """
    return LAW_NAMES[law][language]
