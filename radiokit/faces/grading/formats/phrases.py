"""Phrases: the words that a report of a grade is made of, in English and Russian."""

from __future__ import annotations

from collections.abc import Mapping

from radiokit.faces.grading.isolation.limits import PROTECTIONS
from radiokit.faces.grading.words import Words

__all__ = ["PHRASES", "phrase", "protection"]

PHRASES: Mapping[str, Words] = {
    "student": {"en": "Student", "ru": "Студент"},
    "total": {"en": "Total", "ru": "Итого"},
    "points": {"en": "Points", "ru": "Баллы"},
    "part": {"en": "Part", "ru": "Часть"},
    "finding": {"en": "What was found", "ru": "Что найдено"},
    "diagnosis": {"en": "diagnosis", "ru": "диагноз"},
    "full": {"en": "full", "ru": "полностью"},
    "partial": {"en": "partly", "ru": "частично"},
    "none": {"en": "no points", "ru": "без баллов"},
    "pending": {"en": "not graded yet", "ru": "ещё не проверено"},
    "concealed": {
        "en": "the details of this part are not shown",
        "ru": "подробности этой части не показываются",
    },
    "incomplete": {
        "en": "The grading is not complete: some questions are not graded yet.",
        "ru": "Проверка не закончена: некоторые вопросы ещё не проверены.",
    },
    "review": {
        "en": "A teacher will look at this question.",
        "ru": "Этот вопрос посмотрит преподаватель.",
    },
    "problems": {"en": "While the work was loaded", "ru": "При загрузке работы"},
    "protections": {"en": "How the code was run", "ru": "Как выполнялся код"},
    "active": {"en": "Active protections", "ru": "Действовали ограничения"},
    "missing": {"en": "Not granted by the system", "ru": "Система не предоставила"},
}
"""What stands in reports besides the titles and findings of the grade itself."""

_PROTECTIONS_RU = {
    "limits": "время процессора, память, число процессов, открытых файлов и их размер ограничены",
    "memory": "память всех процессов вместе ограничена",
    "processes": "ни один процесс не переживает проверку",
    "privileges": "программы не могут повысить свои права",
    "user": "код выполняется от имени пользователя, которому ничего не принадлежит",
    "calls": "вызовы ядра системы, ненужные вычислениям, запрещены",
    "network": "сети нет",
    "files": "читать можно только Python и саму работу, писать только в её папку",
    "root": "из файловой системы видны только Python и сама работа",
    "proc": "другие процессы не видны",
}


def phrase(language: str, key: str) -> str:
    """Return a phrase.

    >>> phrase("ru", "total")
    'Итого'
    """
    return PHRASES[key][language]


def protection(language: str, name: str) -> str:
    """Return what a protection does, in words; its name where none are known.

    >>> protection("en", "network")
    'there is no network'
    """
    known: Mapping[str, str] = _PROTECTIONS_RU if language == "ru" else PROTECTIONS
    return known.get(name, PROTECTIONS.get(name, name))
