"""Texts: what stands in every copy of an assignment beside its own words, in English and Russian."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from radiokit.faces.grading.words import Words

__all__ = ["tell"]

TEXTS: Mapping[str, Words] = {
    "how": {
        "en": """\
Write the body of each function in place of `...`. Keep the names of the functions and of their parameters.

- Unless a question says otherwise: parameters are NumPy arrays of float64 of one length, or numbers, and the
  function returns an array of that length; angles are in radians, all else in SI units.
- Functions are graded alone: what one of them needs must be defined or imported in this file. NumPy is there,
  radiokit is not.""",
        "ru": """\
Напишите тело каждой функции вместо `...`. Имена функций и их параметров не меняйте.

- Если в вопросе не сказано иначе, параметры — массивы NumPy типа float64 одной длины или числа, а функция
  возвращает массив той же длины; углы — в радианах, остальное — в единицах СИ.
- Функции проверяются отдельно: всё, что им нужно, должно быть определено или импортировано в этом файле.
  NumPy доступен, radiokit — нет.""",
    },
    "check": {
        "en": "- Your functions are graded on other numbers than those they are checked on here.\n"
        "- `check(function)` judges a function at once, and names the mistake where it knows it.",
        "ru": "- Оцениваются функции на других числах, не на тех, на которых они проверяются здесь.\n"
        "- `check(функция)` сразу проверяет функцию и называет ошибку, если узнаёт её.",
    },
    "points": {"en": "points: {points:g}", "ru": "баллы: {points:g}"},
    "beside": {
        "en": "*Also graded, and not shown before: {parts}.*",
        "ru": "*Оценивается и то, что заранее не показано: {parts}.*",
    },
    "all": {"en": "## All questions at once", "ru": "## Все вопросы сразу"},
    "hand-in": {
        "en": """\
## How to hand in

Restart the kernel and run all cells once more, so that nothing depends on a cell that is gone; save, and hand
in this file under its own name. A function that you leave as it is costs its own points only.""",
        "ru": """\
## Как сдать работу

Перезапустите ядро и выполните все ячейки ещё раз, чтобы ничто не зависело от удалённых ячеек; сохраните файл
и сдайте его под тем же именем. Ненаписанная функция стоит только своих баллов.""",
    },
    "solved": {
        "en": "**The instructor's copy: it holds the solutions.**",
        "ru": "**Экземпляр преподавателя: здесь решения.**",
    },
    "helpers": {"en": "# Imports and functions of your own", "ru": "# Свои функции и импорт"},
    "helpers-title": {
        "en": "## Functions of your own\n\nWhat several questions need goes here.",
        "ru": "## Свои функции\n\nЗдесь место для того, что нужно нескольким вопросам.",
    },
    "blank": {"en": "not written yet", "ru": "ещё не написана"},
    "later": {
        "en": "judged after handing in: {parts}",
        "ru": "будет проверено после сдачи: {parts}",
    },
    "not-a-function": {
        "en": "{given} is no function: write its name without quotes or brackets, as in check({name})",
        "ru": "{given} — не функция: напишите её имя без кавычек и скобок, например check({name})",
    },
    "no-question": {
        "en": "no question asks for a function {name}{guess}",
        "ru": "функции {name} ни в одном вопросе нет{guess}",
    },
    "asked-for": {"en": "; asked for: {names}", "ru": "; есть: {names}"},
    "printed": {"en": "it printed: {text}", "ru": "напечатано: {text}"},
    "absent": {"en": "not defined here", "ru": "здесь не определена"},
    "elsewhere": {
        "en": "{question} is graded after handing in, where the assignment is",
        "ru": "{question}: оценивается после сдачи, там, где находится задание",
    },
    "earned": {"en": "{score:g} of {points:g} points", "ru": "баллы: {score:g} из {points:g}"},
    "too-long": {
        "en": "grading took longer than {seconds:g} s",
        "ru": "проверка заняла больше {seconds:g} с",
    },
}


def tell(language: str, key: str, **values: Any) -> str:
    """Return a text.

    >>> tell("ru", "points", points=2.5)
    'баллы: 2.5'
    """
    text = TEXTS[key][language]
    return text.format(**values) if values else text
