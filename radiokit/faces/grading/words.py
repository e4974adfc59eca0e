"""Words: the sentences of feedback, in English and Russian, and the check that a text has both."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from radiokit.faces.diagnosis.misconception import LANGUAGES
from radiokit.facts.errors import ParameterError

__all__ = ["SENTENCES", "Words", "checked_language", "say", "words"]

Words = Mapping[str, str]
"""A text by language, ``{"en": ..., "ru": ...}``."""

SENTENCES: Mapping[str, Words] = {
    "full": {"en": "right", "ru": "верно"},
    "wrong": {
        "en": "differs from what is right at {bad} of {count} inputs",
        "ru": "отличается от верного на {bad} из {count} входов",
    },
    "imprecise": {
        "en": "the formula is right, but digits are lost: the relative error is up to {error}, "
        "and {rtol:g} is asked for",
        "ru": "формула верна, но теряются цифры: относительная ошибка до {error}, а требуется {rtol:g}",
    },
    "float32": {
        "en": "the formula is right, but it is computed in float32, and {rtol:g} is asked for: use float64",
        "ru": "формула верна, но вычислена в float32, а требуется {rtol:g}: используйте float64",
    },
    "not-finite": {
        "en": "gives {value} at {bad} of {count} inputs",
        "ru": "даёт {value} на {bad} из {count} входов",
    },
    "shape": {
        "en": "returns an array of shape {shape} where {expected} is right",
        "ru": "возвращает массив формы {shape}, а верна форма {expected}",
    },
    "complex": {"en": "returns complex numbers", "ru": "возвращает комплексные числа"},
    "not-repeatable": {
        "en": "gives other values when it is asked the same again",
        "ru": "на тот же вопрос во второй раз отвечает иначе",
    },
    "witness": {
        "en": "at {inputs} it gives {value}, right is {right}",
        "ru": "при {inputs} даёт {value}, верно {right}",
    },
    "witness-hidden": {
        "en": "at {inputs} it gives {value}",
        "ru": "при {inputs} даёт {value}",
    },
    "one-of": {"en": "one of these: {names}", "ru": "одно из: {names}"},
    "not-loaded": {"en": "the submission {error}", "ru": "работа не загрузилась: {error}"},
    "no-function": {
        "en": "defines no function {function}{guess}",
        "ru": "функция {function} не определена{guess}",
    },
    "did-you-mean": {"en": "; is it {name}?", "ru": "; может быть, это {name}?"},
    "problem": {
        "en": "{where} raised {raised}: {message}",
        "ru": "{where}: ошибка {raised}: {message}",
    },
    "remark": {"en": "{where}: {message}", "ru": "{where}: {message}"},
    "call": {"en": "{function} {error}", "ru": "{function}: {error}"},
    "judge-failed": {
        "en": "the answer could not be judged ({error}); a teacher will look at it",
        "ru": "ответ не удалось оценить ({error}); его посмотрит преподаватель",
    },
    "not-graded": {"en": "not graded yet", "ru": "ещё не проверено"},
    "no-submission": {"en": "there is no submission: {error}", "ru": "работы нет: {error}"},
}
"""What feedback can say; the sentences on misconceptions stand in the catalogue of diagnoses."""


def checked_language(language: str) -> str:
    """Return ``language`` if there are words in it.

    Raises
    ------
    ParameterError
        When it is not ``"en"`` or ``"ru"``.
    """
    if language not in LANGUAGES:
        raise ParameterError("language", language, " or ".join(map(repr, LANGUAGES)))
    return language


def say(language: str, key: str, **values: Any) -> str:
    """Return a sentence.

    >>> say("ru", "wrong", bad=2, count=40)
    'отличается от верного на 2 из 40 входов'
    """
    return SENTENCES[key][language].format(**values)


def words(name: str, given: Words) -> Words:
    """Return ``given`` if it has a text in each language.

    Raises
    ------
    ParameterError
        When one is missing or empty; ``name`` is the argument that is named.
    """
    if not isinstance(given, Mapping) or not all(
        isinstance(given.get(each), str) and given[each] for each in LANGUAGES
    ):
        raise ParameterError(name, given, 'texts {"en": ..., "ru": ...}')
    return given
