"""Russian: what a submission did instead of answering; the child and its keeper say it in English."""

from __future__ import annotations

import re

__all__ = ["in_russian", "place_in_russian"]

_KNOWN = {
    r"returned None: is a return statement missing\?": "вернулось None: не забыт ли return?",
    r"returned None among its values": "среди возвращённых значений есть None",
    r"returned one value where (\d+) are wanted, as in return (.+)": "вернулось одно значение, а нужно {0}: "
    "return {1}",
    r"returned (\d+) values where (\d+) are wanted": "число возвращённых значений — {0}, а нужно {1}",
    r"returned different numbers of values for different rows": "для разных строк возвращается разное число "
    "значений",
    r"returned shape (\(.*\)) for row 0 and (\(.*\)) for row (\d+)": "для строки 0 вернулась форма {0}, а "
    "для строки {2} — {1}",
    r"returned (.+) of numbers in all: too much": "вернулось слишком много чисел: {0}",
    r"returned an array of shape (.+), (.+): too much": "вернулся слишком большой массив: форма {0}, {1}",
    r"returned a (\w+) whose parts have different lengths": "вернулся {0}, части которого разной длины",
    r"returned more numbers than fit in memory": "вернулось больше чисел, чем помещается в памяти",
    r"returned an array of (\d+) dimensions, shape (.+)": "вернулся массив слишком большой размерности: {0}, "
    "форма {1}",
    r"returned (.+) that is no array of numbers": "вернулся тип {0}, а нужен массив чисел",
    r"returned (\w+) that is no number": "вернулся тип {0}, а нужно число",
    r"returned a number that is too large for a float": "вернулось число, слишком большое для float",
    r"defines no function (\S+)": "функция {0} не определена",
    r"raised (\w+)": "ошибка {0}",
    r"raised (\w+): (.*)": "ошибка {0}: {1}",
    r"it is no Jupyter notebook of format 3 or 4": "это не блокнот Jupyter формата 3 или 4",
    r"it was stopped, as it took too long": "выполнение остановлено: оно длилось слишком долго",
    r"(.+) is left out: IPython alone knows it": "{0} пропущено: это команда одного IPython",
    r"took longer than (\S+) s": "работа длилась дольше {0} с",
    r"took longer than (\S+) s in all": "вместе вызовы длились дольше {0} с",
    r"used more than (\S+) GiB of memory": "занято больше {0} ГиБ памяти",
    r"was ended by (\w+)": "процесс остановлен сигналом {0}",
    r"ended its process with exit code (-?\d+)": "процесс завершился с кодом {0}",
    r"printed more than (\d+) bytes": "напечатано больше {0} байт",
}


def in_russian(error: str) -> str:
    """Return what is said of a submission in Russian, or as it is where that is not known.

    >>> in_russian("raised NameError: name 'pi' is not defined")
    "ошибка NameError: name 'pi' is not defined"
    >>> in_russian("could not be loaded: it took longer than 5 s")
    'не загружается: работа длилась дольше 5 с'
    """
    before, loading, rest = error.partition("could not be loaded: it ")
    if loading and not before:
        return f"не загружается: {in_russian(rest)}"
    for english, russian in _KNOWN.items():
        found = re.fullmatch(english, error, re.DOTALL)
        if found:
            return russian.format(*found.groups())
    return error


def place_in_russian(where: str) -> str:
    """Return a place in a submission in Russian.

    >>> place_in_russian("cell 3, line 2: return x^2")
    'ячейка 3, строка 2: return x^2'
    """
    found = re.fullmatch(r"(?:cell (\d+))?(?:, )?(?:line (\d+))?(:.*)?", where, re.DOTALL)
    if not found:
        return where
    cell, line, rest = found.groups()
    named = [f"ячейка {cell}"] * bool(cell) + [f"строка {line}"] * bool(line)
    return ", ".join(named) + (rest or "")
