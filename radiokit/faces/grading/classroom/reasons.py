"""Reasons: why an entry has no submission, or a submission no grade, in English and Russian."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from radiokit.faces.grading.words import Words

__all__ = ["NOTHING", "REASONS", "NoSubmissionError", "reason"]

REASONS: Mapping[str, Words] = {
    "absent": {"en": "nothing was handed in", "ru": "ничего не сдано"},
    "empty": {
        "en": "no .py or .ipynb file was handed in",
        "ru": "не сдано ни одного файла .py или .ipynb",
    },
    "several": {
        "en": "{count} files end in .py or .ipynb, where there may be one, or one named {name}",
        "ru": "файлов .py и .ipynb сдано {count}, а нужен один, или один с именем {name}",
    },
    "huge": {
        "en": "it is larger than {limit} MiB (a notebook is smaller without its outputs)",
        "ru": "она больше {limit} МиБ (тетрадь меньше, если очистить вывод ячеек)",
    },
    "crowded": {"en": "it has more than {limit} files", "ru": "в ней больше {limit} файлов"},
    "link": {
        "en": "it is a link that leads elsewhere",
        "ru": "вместо файла сдана ссылка, которая ведёт в другое место",
    },
    "unreadable": {"en": "it cannot be read", "ru": "файл не читается"},
    "archive": {
        "en": "its archive is broken, encrypted, or no .zip",
        "ru": "архив повреждён, зашифрован или не в формате .zip",
    },
    "broke": {
        "en": "grading it ended its worker process {count} times, as when memory runs out; "
        "a teacher will look at it",
        "ru": "при проверке {count} раза завершался рабочий процесс, как бывает при нехватке памяти; "
        "работу посмотрит преподаватель",
    },
    "failed": {
        "en": "it could not be graded ({error}); a teacher will look at it",
        "ru": "работу не удалось проверить ({error}); её посмотрит преподаватель",
    },
}


NOTHING = ("absent", "empty")
"""The reasons for which nobody need look: there is nothing that could be graded."""


class NoSubmissionError(Exception):
    """An entry has no submission that can be graded; ``key`` is one of ``REASONS``."""

    def __init__(self, key: str, **values: Any) -> None:
        super().__init__(key)
        self.key = key
        self.values = values

    def text(self, language: str) -> str:
        """Return the reason in a language."""
        return reason(language, self.key, **self.values)


def reason(language: str, key: str, **values: Any) -> str:
    """Return a reason.

    >>> reason("ru", "huge", limit=16)
    'она больше 16 МиБ (тетрадь меньше, если очистить вывод ячеек)'
    """
    return REASONS[key][language].format(**values)
