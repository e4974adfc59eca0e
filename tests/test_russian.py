"""Feedback in Russian is wholly Russian: whatever the sandbox says, and those who call a function in it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.reading import read
from radiokit.faces.grading.judges.lawtexts import failed
from radiokit.faces.grading.russian import OUTCOMES, told, translated
from radiokit.facts.errors import CallableError, TargetError

G = rk.grading
PACKAGE = Path(rk.__path__[0])
SANDBOX = ("sandbox", "budgets", "process", "result", "protocol", "child", "loading", "answers", "remote")
FILES = [
    *(PACKAGE / "faces" / "grading" / "isolation" / f"{name}.py" for name in SANDBOX),
    PACKAGE / "faces" / "grading" / "handout" / "here.py",
    *(PACKAGE / "contracts" / f"{name}.py" for name in ("calling", "blackbox")),
]
RAISED = {"RefusedError": 0, "MalformedError": 0, "StoppedError": 0, "LateError": 0, "CallableError": 1}
KEPT = {"None", "return", "a", "b", "eta", "JSON", "Jupyter", "IPython", "float"}
"""What is code, or a name, and stays as it is."""


def texts(node: ast.expr | None) -> Iterator[str]:
    """Yield what an expression can be, with 7 in the place of each value."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.JoinedStr):
        yield "".join(each.value if isinstance(each, ast.Constant) else "7" for each in node.values)
    elif isinstance(node, ast.IfExp):
        yield from (*texts(node.body), *texts(node.orelse))
    elif isinstance(node, ast.BoolOp):
        for value in node.values:
            yield from texts(value)


def sentences(tree: ast.AST) -> Iterator[str]:
    """Yield every sentence that a result's error, a problem of loading or a callable's problem can hold."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            place = RAISED.get(name)
            if place is not None:
                yield from texts(node.args[place])
            elif name == "_note":
                yield from texts(node.args[2])
            elif name in ("_request", "_charged") and len(node.args) > 3:
                yield from texts(node.args[3])
            elif name == "Result":
                yield from (
                    text for each in node.keywords if each.arg == "error" for text in texts(each.value)
                )
        elif isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and key.value in ("error", "refused"):
                    yield from texts(value)
        elif isinstance(node, ast.Assign):
            named = {
                each.id for target in node.targets for each in ast.walk(target) if isinstance(each, ast.Name)
            }
            values = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value]
            if named & {"late", "error"}:
                yield from (text for value in values for text in texts(value))
        elif isinstance(node, ast.FunctionDef) and node.name in ("_ending", "told"):
            for each in ast.walk(node):
                yield from texts(each.value) if isinstance(each, ast.Return) else ()


def untold(sentence: str) -> str:
    """Return what is left in English in the Russian form of a sentence."""
    words = re.findall(r"[A-Za-z]+", translated("ru", sentence))
    return " ".join(word for word in words if word not in KEPT)


FOUND = sorted({text for file in FILES for text in sentences(ast.parse(file.read_text()))} - {""})


@pytest.mark.parametrize("sentence", FOUND)
def test_every_sentence_of_the_sandbox_has_its_russian_form(sentence: str) -> None:
    assert untold(sentence) == ""
    assert re.search("[а-я]", translated("ru", sentence))
    assert translated("en", sentence) == sentence


def test_all_sentences_are_looked_at_and_one_without_words_is_seen() -> None:
    for known in (
        "took longer than 7 s in all",
        "ended its process with exit code 7",
        "was ended by 7",
        "returned None: is a return statement missing?",
        "could not be loaded: it 7",
        "gave an answer that is not believed: 7",
        "raised 7: 7",
        "7 is left out: IPython alone knows it",
        "returned shape 7 for 7 pairs of directions",
        "its message cannot be read",
        "did not answer",
    ):
        assert known in FOUND
    planted = ast.parse("def f(self):\n    raise RefusedError(f'returned {x} of no use')")
    (sentence,) = sentences(planted)
    assert untold(sentence) == "returned of no use"


def test_no_words_are_kept_that_nobody_says() -> None:
    """Each sentence of the table is one that some module says."""
    first = OUTCOMES.index(("degrees", "градусы"))
    said = {re.sub(r"\d+", "7", translated("ru", sentence)) for sentence in FOUND}
    composed = ("{count} ", "cell", "line", "the submission", "raised {kind}: its", "returned {kind} of")
    for english, russian in OUTCOMES[:first]:
        filled = re.sub(r"\{\w+\}|\d+", "7", russian)
        assert filled in said or english.startswith(composed), english


def test_the_amounts_places_and_reasons_within_a_sentence_are_translated_too() -> None:
    for english, russian in {
        "returned 8.1 GB of numbers in all: too much": "вернула слишком много чисел, всего 8.1 ГБ",
        "could not be loaded: it took longer than 20 s": "работа не загрузилась: выполнялась дольше 20 с",
        "gave an answer that is not believed: the header is no JSON": "дала ответ, которому нельзя верить: "
        "заголовок не в формате JSON",
        "cell 3, line 2": "ячейка 3, строка 2",
        "returned ndarray of <U3 that is no array of numbers": "вернула ndarray типа <U3, а не массив чисел",
        "no normalisation ≠ (n+1)/(2π)": "без нормировки ≠ (n+1)/(2π)",
        "raised ValueError: took longer than 2 s": "ошибка ValueError: took longer than 2 s",  # not ours
        "the submission could not be loaded: it did not answer": "работа: работа не загрузилась: не ответила",
    }.items():
        assert translated("ru", english) == russian


def test_errors_of_callables_are_told_as_they_are_in_english_and_in_russian_words() -> None:
    error = CallableError("f", "returned shape (2,) for one pair", (0.0, 0.0, 1.0), (0.0, 0.0, 1.0))
    assert told("en", error) == str(error)
    assert told("ru", error).startswith("f: вернула форму (2,) для одной пары направлений при wi = (0.0,")
    assert failed(error, "ru").startswith("f: вернула форму (2,) для одной пары направлений при wi: θ = 0°")
    raised = CallableError("f", "raised ValueError: no")
    assert (failed(raised, "en"), failed(raised, "ru")) == (
        "f raised ValueError: no",
        "f: ошибка ValueError: no",
    )
    lost = TargetError("the submission has no function 'f'; did you mean 'g'? It defines: g")
    assert told("en", lost) == str(lost)
    assert told("ru", lost) == "в работе нет функции 'f'; может быть, это 'g'? В ней есть: g"


def test_the_details_of_a_diagnosis_are_translated() -> None:
    rng = np.random.default_rng(5)
    theta, exponent = rng.uniform(0.1, 1.4, 20), rng.uniform(2, 40, 20)
    inputs = {"theta": theta, "cosine": np.cos(theta), "exponent": exponent, "distance": theta + 1}
    problem = read(np.cos(theta), np.cos(theta), inputs, lambda theta, **_: np.cos(theta), None, 1e-6)
    details = set()
    for entry in CATALOGUE:
        if all(need in problem.given for need in entry.needs):
            details |= {guess.detail for guess in entry.explain(problem)}
    assert {"degrees", "ascending"} <= details
    known = {"sqrt", "square", "reciprocal", "one_minus", "trunc", "floor", "round", "gamma", "sRGB", "dB"}
    code = {"ln", "log", "cos", "sin", "max", "wi", "wo", "p", "n"}
    for detail in details:
        words = set(re.findall("[A-Za-z]+(?:_[a-z]+)?", translated("ru", detail)))
        assert words <= known | code, detail


SLIPS = {
    "none": "return None",
    "text": "return 'π'",
    "raises": "raise ValueError('no such angle')",
    "ends": "import os; os._exit(1)",
    "prints": "print('x' * (1 << 21)); return 1.0",
    "sleeps": "import time; time.sleep(60)",
    "pair": "return [1.0, [2.0, 3.0]]",
    "mute": "class Mute(Exception): __str__ = None\n    raise Mute",
}


def test_a_grade_in_russian_has_no_english_but_pythons_own(tmp_path: Path) -> None:
    file = tmp_path / "theirs.py"
    bodies = "\n".join(f"def {name}():\n    {body}" for name, body in SLIPS.items())
    file.write_text(f"import nosuch\n%run other\n{bodies}\n")
    both = {"en": "f", "ru": "ф"}
    part = G.Part(name="ordinary", judge=G.Values(reference=1.0))
    questions = tuple(
        G.Question(signature=f"{name}()", points=1, title=both, text=both, parts=(part,)) for name in SLIPS
    )
    limits = G.Limits(seconds=2)
    work = G.Assignment(name="work", title=both, intro=both, questions=questions, limits=limits)
    grade = G.grade(work, file, language="ru")
    told = {question.name: question.parts[0].text for question in grade.questions}
    assert told == {
        "none": "none: вернула None: не забыт ли return?",
        "text": "text: вернула str, а не массив чисел",
        "raises": "raises: ошибка ValueError: no such angle",
        "ends": "ends: завершила свой процесс с кодом 1",
        "prints": "prints: напечатала больше 1048576 байт",
        "sleeps": "sleeps: выполнялась дольше 2 с",
        "pair": "pair: вернула list с частями разной длины",
        "mute": "mute: ошибка Mute, текст которой не читается",
    }
    assert grade.problems == (
        "строка 2: %run other пропущено: это понимает только IPython",
        "строка 1: ошибка ModuleNotFoundError: No module named 'nosuch'",
    )


@pytest.mark.parametrize(
    ("language", "problem"),
    [
        ("en", "it is no Jupyter notebook of format 3 or 4"),
        ("ru", "это не блокнот Jupyter формата 3 или 4"),
    ],
)
def test_a_problem_without_a_place_is_told_without_one(language: str, problem: str, tmp_path: Path) -> None:
    file = tmp_path / "theirs.ipynb"
    file.write_text("[]")
    assert G.grade("radiometry", file, language=language, questions=["luminance"]).problems == (problem,)


def test_a_students_own_check_places_what_was_raised_in_russian() -> None:
    both = {"en": "f", "ru": "ф"}
    part = G.Part(name="ordinary", judge=G.Values(reference=1.0))
    question = G.Question(signature="f()", points=1, title=both, text=both, parts=(part,))
    check = G.practice(
        G.Assignment(name="work", title=both, intro=both, questions=(question,)), language="ru"
    )

    def f() -> float:
        raise ValueError("no")

    line = f.__code__.co_firstlineno + 1
    ((_, text),) = check.judged(f).lines
    assert text == f'обычные входы: f: ошибка ValueError: no (строка {line}: raise ValueError("no"))'
