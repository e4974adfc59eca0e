"""Words: the sentences of feedback, in English and Russian, and the check of an assignment's own texts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from radiokit.faces.diagnosis.misconception import LANGUAGES
from radiokit.facts.errors import ParameterError

__all__ = ["SENTENCES", "Words", "checked_language", "languages", "say", "sentence", "words"]

Words = Mapping[str, str]
"""A text by language, ``{"en": ..., "ru": ...}``; one of them may be left out."""

SENTENCES: Mapping[str, Words] = {
    "full": {"en": "right", "ru": "верно"},
    "full-one-by-one": {
        "en": "right, called with one input at a time",
        "ru": "верно при вызове для каждого набора данных отдельно",
    },
    "wrong": {
        "en": "wrong at {bad} of {count} {noun}",
        "ru": "неверно для {bad} из {count} {noun}",
    },
    "imprecise": {
        "en": "digits are lost: the relative error reaches {error}, and {rtol:g} is allowed",
        "ru": "теряются значащие цифры: относительная ошибка достигает {error}, а допускается {rtol:g}",
    },
    "float32": {
        "en": "this is computed in {kind}: the relative error reaches {error}, and {rtol:g} is allowed; "
        "use float64",
        "ru": "вычислено в {kind}: относительная ошибка достигает {error}, а допускается {rtol:g}; "
        "используйте float64",
    },
    "float32-range": {
        "en": "the formula is right, but numbers leave the range of {kind} at {bad} of {count} {noun}: "
        "use float64",
        "ru": "формула верна, но числа выходят за пределы {kind} ({bad} из {count} {noun}): "
        "используйте float64",
    },
    "constant-rounded": {
        "en": "a constant is rounded, such as π: the relative error is {error} at all inputs, "
        "and {rtol:g} is allowed",
        "ru": "округлена константа, например π: относительная ошибка всюду {error}, а допускается {rtol:g}",
    },
    "out-of-range": {
        "en": "the formula is right, but an intermediate number overflows or underflows at {bad} of {count} "
        "{noun}: change the order of the operations",
        "ru": "формула верна, но промежуточное число слишком велико или слишком мало для float64 "
        "({bad} из {count} {noun}): измените порядок действий",
    },
    "constant": {
        "en": "the answer is {value} for all inputs: it does not depend on them",
        "ru": "ответ равен {value} для всех входных данных: он от них не зависит",
    },
    "zero": {
        "en": "the answer is 0 for all inputs: look for // in place of /, a rounding, a wrong unit, or a "
        "condition that is never true",
        "ru": "ответ равен 0 для всех входных данных: поищите // вместо /, округление, не те единицы или "
        "условие, которое никогда не выполняется",
    },
    "not-finite": {
        "en": "gives {value} at {bad} of {count} {noun}",
        "ru": "даёт {value} для {bad} из {count} {noun}",
    },
    "swapped": {
        "en": "your function takes its arguments in another order: see the signature",
        "ru": "аргументы вашей функции стоят в другом порядке: сверьтесь с условием",
    },
    "ignored": {
        "en": "your answer does not depend on one of its arguments",
        "ru": "ваш ответ не зависит от одного из аргументов",
    },
    "shape": {
        "en": "returns an array of shape {shape} where {expected} is right",
        "ru": "возвращает массив формы {shape}, а нужна форма {expected}",
    },
    "one-number": {
        "en": "returns an array of shape {shape} where one number is right",
        "ru": "возвращает массив формы {shape}, а нужно одно число",
    },
    "complex": {
        "en": "returns complex numbers, and real ones are asked for",
        "ru": "возвращает комплексные числа, а нужны вещественные",
    },
    "beside-others": {
        "en": "right for one input at a time, and wrong for arrays: an answer depends on the other inputs, "
        "as where a maximum, a sum or a condition is of the whole array",
        "ru": "верно для каждого набора данных отдельно, но не для массивов: ответ зависит от соседних "
        "данных, как если максимум, сумма или условие берутся по всему массиву",
    },
    "not-repeatable": {
        "en": "gives other values when it is asked again in another order: it must depend on its arguments "
        "alone",
        "ru": "на те же данные в другом порядке отвечает иначе: ответ должен зависеть только от аргументов",
    },
    "witness": {
        "en": "at {inputs} it gives {value}, right is {right}",
        "ru": "при {inputs} получено {value}, верно {right}",
    },
    "witness-hidden": {
        "en": "at {inputs} it gives {value}",
        "ru": "при {inputs} получено {value}",
    },
    "such-as": {"en": "such as {inputs}", "ru": "например при {inputs}"},
    "number-shown": {"en": "it gives {value}, right is {right}", "ru": "получено {value}, верно {right}"},
    "number-hidden": {"en": "it gives {value}", "ru": "получено {value}"},
    "number": {"en": "input no. {row}", "ru": "наборе данных № {row}"},
    "both": {
        "en": "your numbers fit two mistakes at once: {names}",
        "ru": "такие числа дают две ошибки сразу: {names}",
    },
    "besides": {
        "en": "besides, 0 is right at {bad} of {count} {noun} where you give another number",
        "ru": "кроме того, для {bad} из {count} {noun} верен 0, а у вас другое число",
    },
    "one-of": {"en": "one of these: {names}", "ru": "одно из: {names}"},
    "perhaps": {"en": "perhaps: {names}", "ru": "возможно: {names}"},
    "caret": {
        "en": "in Python a power is written x**2: ^ is another operation",
        "ru": "степень в Python пишется x**2: знак ^ означает другое действие",
    },
    "not-loaded": {"en": "the submission {error}", "ru": "работа не загрузилась: {error}"},
    "no-function": {
        "en": "defines no function {function}{guess}",
        "ru": "функция {function} не определена{guess}",
    },
    "did-you-mean": {"en": "; is it {name}?", "ru": "; может быть, это {name}?"},
    "method": {
        "en": "; {name} is a method of the class {where}: define the function outside of any class",
        "ru": "; {name} — метод класса {where}: определите функцию вне классов",
    },
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
    "assignment-failed": {
        "en": "the question itself is at fault, not your answer; a teacher will look at it",
        "ru": "ошибка в самом задании, а не в вашем ответе; его посмотрит преподаватель",
    },
    "not-graded": {"en": "not graded yet", "ru": "ещё не проверено"},
    "no-submission": {"en": "there is no submission: {error}", "ru": "работы нет: {error}"},
}
"""What feedback can say; the sentences on misconceptions stand in the catalogue of diagnoses."""


def checked_language(language: str, known: Sequence[str] = LANGUAGES) -> str:
    """Return ``language`` if there are words in it; ``known`` are the languages of an assignment's texts.

    Raises
    ------
    ParameterError
        When it is none of them.
    """
    if language not in known:
        those = " or ".join(map(repr, known))
        only = those if len(known) == len(LANGUAGES) else f"{those}: the assignment has no texts in another"
        raise ParameterError("language", language, only)
    return language


def say(language: str, key: str, **values: Any) -> str:
    """Return a sentence.

    A ``count`` also gives the noun that stands after it, ``{noun}``, in its right form.

    >>> say("en", "wrong", bad=1, count=1)
    'wrong at 1 of 1 input'
    >>> say("ru", "wrong", bad=2, count=40)
    'неверно для 2 из 40 наборов данных'
    """
    if "count" in values:
        values.setdefault("noun", _noun(language, values["count"]))
    return SENTENCES[key][language].format(**values)


def sentence(text: str) -> str:
    """Return a text as one sentence: a capital first, unless it is a symbol, and one full stop last.

    >>> sentence("wrong at 1 of 2 inputs"), sentence("π is lost."), sentence("why?"), sentence("p = 1/A")
    ('Wrong at 1 of 2 inputs.', 'π is lost.', 'Why?', 'p = 1/A.')
    >>> sentence("half_cosine returned None")
    'half_cosine returned None.'
    """
    text = text.strip().rstrip(".;")
    word, _, rest = text.partition(" ")
    symbol = "Α" <= text[:1] <= "ω" or "_" in word or rest.startswith("= ")
    first = text[:1] if symbol else text[:1].upper()
    return f"{first}{text[1:]}{'' if text.endswith(('?', '!')) else '.'}" if text else ""


def _noun(language: str, count: int) -> str:
    """Return what is counted, after ``of 40`` or ``из 40``: the genitive in Russian."""
    if language == "ru":
        return "набора данных" if count % 10 == 1 and count % 100 != 11 else "наборов данных"
    return "input" if count == 1 else "inputs"


def words(name: str, given: Words, needed: Sequence[str] = ()) -> Words:
    """Return ``given`` if it has texts, of known languages, and one in each that is needed.

    Raises
    ------
    ParameterError
        When one is missing or empty; ``name`` is the argument that is named.
    """
    if not isinstance(given, Mapping) or not given or not set(given) <= set(LANGUAGES):
        raise ParameterError(name, given, 'texts {"en": ..., "ru": ...}, or in one of these languages')
    if not all(isinstance(text, str) and text.strip() for text in given.values()):
        raise ParameterError(name, given, "texts that are not empty")
    if not set(needed) <= set(given):
        texts = ", ".join(f'"{each}": ...' for each in needed)
        raise ParameterError(name, given, f"texts {{{texts}}}, in each language of the title")
    return given


def languages(given: Words) -> tuple[str, ...]:
    """Return the languages of a text.

    >>> languages({"ru": "Свет", "en": "Light"})
    ('en', 'ru')
    """
    return tuple(each for each in LANGUAGES if each in given)
