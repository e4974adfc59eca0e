"""Russian: what sentences that know no language, as the sandbox's and details of a diagnosis, are in Russian.

They have the function or the submission as their subject, which are feminine; what stands in ``{}`` is kept.
"""

from __future__ import annotations

import re
from functools import cache

from radiokit.faces.grading.isolation.protocol import plain_text
from radiokit.faces.grading.words import say, sentence
from radiokit.facts.errors import CallableError, RadiokitError

__all__ = ["OUTCOMES", "did", "told", "translated"]

OUTCOMES: tuple[tuple[str, str], ...] = (
    # what became of a call
    ("raised {kind}: its message cannot be read", "ошибка {kind}, текст которой не читается"),
    ("raised {kind}: {message}", "ошибка {kind}: {message}"),
    ("raised {kind}", "ошибка {kind}"),
    ("took longer than {count} s in all", "выполнялась дольше {count} с в сумме"),
    ("took longer than {count} s", "выполнялась дольше {count} с"),
    ("printed more than {count} bytes", "напечатала больше {count} байт"),
    ("used more than {count} GiB of memory", "заняла больше {count} ГиБ памяти"),
    ("ran more than {count} processes", "превысила допустимое число процессов: {count}"),
    ("was ended by {signal}", "процесс завершён сигналом {signal}"),
    ("ended its process with exit code {count}", "завершила свой процесс с кодом {count}"),
    ("closed its channel of answers", "закрыла канал, по которому передаёт ответы"),
    ("did not answer", "не ответила"),
    ("refused", "ничего не вернула"),
    ("could not be loaded: it {why}", "работа не загрузилась: {why}"),
    ("gave an answer that is not believed: {why}", "дала ответ, которому нельзя верить: {why}"),
    ("defines no function {name}", "функция {name} не определена"),
    ("defines {name}, which is no function", "{name} — не функция"),
    (
        "the submission has no function {name}; did you mean {other}? It defines: {names}",
        "в работе нет функции {name}; может быть, это {other}? В ней есть: {names}",
    ),
    (
        "the submission has no function {name}. It defines: {names}",
        "в работе нет функции {name}. В ней есть: {names}",
    ),
    ("the submission {why}", "работа: {why}"),
    # what came back
    ("returned None: is a return statement missing?", "вернула None: не забыт ли return?"),
    ("returned None among its values", "вернула None среди значений"),
    (
        "returned one value where {count} are wanted, as in return {names}",
        "вернула одно значение, а нужно {count}, например return {names}",
    ),
    ("returned {one} values where {count} are wanted", "число возвращённых значений {one}, а нужно {count}"),
    (
        "returned different numbers of values for different rows",
        "вернула для разных строк разное число значений",
    ),
    (
        "returned shape {first} for row {one} and {second} for row {two}",
        "вернула форму {first} для строки {one} и {second} для строки {two}",
    ),
    ("returned {size} of numbers in all: too much", "вернула слишком много чисел, всего {size}"),
    (
        "returned an array of shape {shape}, {size}: too much",
        "вернула слишком большой массив формы {shape}, {size}",
    ),
    ("returned a {kind} whose parts have different lengths", "вернула {kind} с частями разной длины"),
    ("returned more numbers than fit in memory", "вернула больше чисел, чем помещается в память"),
    (
        "returned an array of {count} dimensions, shape {shape}",
        "вернула массив, размерность которого {count}, форма {shape}",
    ),
    (
        "returned {kind} of {dtype} that is no array of numbers",
        "вернула {kind} типа {dtype}, а не массив чисел",
    ),
    ("returned {kind} that is no array of numbers", "вернула {kind}, а не массив чисел"),
    ("returned a number that is too large for a float", "вернула число, слишком большое для float"),
    ("returned {kind} that is no number", "вернула {kind}, а не число"),
    ("returned {kind} that is no array of real numbers", "вернула {kind}, а не массив вещественных чисел"),
    ("returned shape {shape} for one pair", "вернула форму {shape} для одной пары направлений"),
    (
        "returned values of different lengths for different pairs",
        "вернула для разных пар направлений значения разной длины",
    ),
    (
        "returned shape {shape} for {count} pairs of directions",
        "вернула форму {shape}, а пар направлений {count}",
    ),
    (
        "returned shapes {first} and {second} for {count} points",
        "вернула формы {first} и {second}, а точек {count}",
    ),
    ("returned shape {shape} after {before}", "вернула форму {shape} после {before}"),
    ("has eta = {eta}, which is no refractive index", "имеет eta = {eta}, а это не показатель преломления"),
    ("{count} bytes", "{count} байт"),
    ("{count} kB", "{count} кБ"),
    ("{count} MB", "{count} МБ"),
    ("{count} GB", "{count} ГБ"),
    ("{count} TB", "{count} ТБ"),
    # answers that the submission has tampered with
    ("arrays of {dtype} are not carried", "массивы типа {dtype} не передаются"),
    ("a header of {count} bytes is too long", "заголовок слишком длинный, байт: {count}"),
    ("more bytes than were asked for", "байтов больше, чем запрошено"),
    ("what came is no message", "получено не сообщение"),
    ("a header of {count} bytes is claimed", "заявлен заголовок недопустимой длины, байт: {count}"),
    ("{one} bytes are claimed, of {count} allowed", "заявлено байт: {one}, допускается {count}"),
    ("the message is not whole", "сообщение неполное"),
    ("the header is no JSON", "заголовок не в формате JSON"),
    ("the header is no object", "заголовок — не объект JSON"),
    ("the header lists no arrays, or more than {count}", "в заголовке нет массивов или их больше {count}"),
    ("arrays of {one} bytes are claimed, {count} came", "заявлены массивы, байт: {one}, получено {count}"),
    ("an array is not described by its type and shape", "тип и форма массива не указаны"),
    ("an array is of a type that is not carried", "массивы такого типа не передаются"),
    (
        "an array has no shape, or more than {count} dimensions",
        "у массива нет формы или его размерность больше {count}",
    ),
    ("an array's shape is not of lengths", "форма массива состоит не из длин"),
    ("it answers what was not asked", "это ответ на другой запрос"),
    ("an empty array's shape is too large", "форма пустого массива слишком велика"),
    ("its refractive index is no number", "показатель преломления — не число"),
    ("its problems are none", "список ошибок испорчен"),
    ("its facts are none", "сведения о функции испорчены"),
    ("it has neither values nor an error", "в нём нет ни значений, ни ошибки"),
    ("values are missing", "не хватает значений"),
    # loading
    ("it is no Jupyter notebook of format 3 or 4", "это не блокнот Jupyter формата 3 или 4"),
    ("it was stopped, as it took too long", "остановлено: выполнялось слишком долго"),
    ("its message cannot be read", "текст ошибки не читается"),
    ("{code} is left out: IPython alone knows it", "{code} пропущено: это понимает только IPython"),
    ("cell {cell}, line {line}", "ячейка {cell}, строка {line}"),
    ("cell {cell}", "ячейка {cell}"),
    ("line {line}", "строка {line}"),
    # details of a diagnosis
    ("degrees", "градусы"),
    ("converted twice", "пересчитано дважды"),
    ("ascending", "по возрастанию"),
    ("descending", "по убыванию"),
    ("max", "максимум"),
    ("sum", "сумма"),
    ("mean", "среднее"),
    ("gamma", "гамма"),
    ("8 bit", "8 бит"),
    ("no normalisation ≠ {meant}", "без нормировки ≠ {meant}"),
    ("{used} ≠ no normalisation", "{used} ≠ без нормировки"),
)
"""Sentences with the sentences that say the same in Russian; of several that fit, the first counts."""

NESTED = ("why", "size")
"""The fields that hold another of these sentences."""
DIGITS = ("cell", "count", "line", "one", "two")
"""The fields that hold a number."""


def translated(language: str, text: str) -> str:
    """Return a sentence of the sandbox or a detail of a diagnosis in a language; what is neither, as it is.

    >>> translated("ru", "raised ValueError: no such angle"), translated("ru", "cell 2, line 3")
    ('ошибка ValueError: no such angle', 'ячейка 2, строка 3')
    >>> translated("en", "took longer than 2 s")
    'took longer than 2 s'
    """
    if language != "ru":
        return text
    for pattern, russian in _patterns():
        found = pattern.fullmatch(text)
        if found is not None:
            fields = found.groupdict()
            fields |= {name: translated(language, fields[name]) for name in NESTED if name in fields}
            return russian.format(**fields)
    return text


def did(language: str, function: str, error: str) -> str:
    """Return what a function did instead of answering, by its result's ``error``.

    >>> did("ru", "cone", "took longer than 2 s")
    'cone: выполнялась дольше 2 с'
    """
    text = say(language, "call", function=function, error=translated(language, error))
    caret = "bitwise_xor" in error or " for ^" in error
    return f"{sentence(say(language, 'caret'))} {text}" if caret else text


def told(language: str, error: RadiokitError) -> str:
    """Return what an error of a submission's function, or of the submission, says to a student.

    >>> told("ru", CallableError("f", "returned None: is a return statement missing?"))
    'f: вернула None: не забыт ли return?'
    """
    if not isinstance(error, CallableError):
        return translated(language, plain_text(error))
    function, problem = error.fields["function"], error.fields["problem"]
    place = str(error).removeprefix(f"{function} {problem}")
    if language == "ru":
        place = place.replace(" at ", " при ", 1)
    return plain_text(did(language, function, problem) + place)


@cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    return tuple((re.compile(_pattern(english), re.DOTALL), russian) for english, russian in OUTCOMES)


def _pattern(english: str) -> str:
    """Return the regular expression of a sentence with fields."""
    parts = re.split(r"\{(\w+)\}", english)
    texts, names = map(re.escape, parts[::2]), parts[1::2]
    kinds = [r"[\d.e+-]+" if name in DIGITS else ".+?" for name in names]
    fields = [f"(?P<{name}>{kind})" for name, kind in zip(names, kinds, strict=True)]
    return "".join(text + field for text, field in zip(texts, [*fields, ""], strict=True))
