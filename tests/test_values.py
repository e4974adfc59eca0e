"""The judge of values: what it bears, what it tells, and what it never gives away."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

import radiokit as rk
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.diagnosis.misconception import LANGUAGES
from radiokit.faces.grading.finding import Finding, Mode
from radiokit.faces.grading.isolation.answers import RefusedError, Taker
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.judges.evidence import LONGEST, clause, joined
from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.words import SENTENCES, say, sentence
from radiokit.facts.errors import ParameterError


class Local:
    """A function that is called as the sandbox calls it, but here."""

    name = "f"

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.modes: list[str] = []

    def call(self, *arrays: Array, mode: Mode = "batch", outputs: int = 1, seed: int | None = None) -> Result:
        self.modes.append(mode)
        taker = Taker(1 << 28)
        try:
            with np.errstate(all="ignore"):
                return Result(values=tuple(self._values(taker, arrays, mode, outputs)))
        except RefusedError as error:
            return Result(error=str(error))
        except Exception as error:
            kind = type(error).__name__
            return Result(error=f"raised {kind}: {error}", raised=kind)

    def _values(self, taker: Taker, arrays: tuple[Array, ...], mode: Mode, outputs: int) -> list[Any]:
        given = [array.copy() if array.ndim else array.item() for array in arrays]
        lengths = [len(array) for array in arrays if array.ndim]
        if mode == "batch" or not lengths:
            return taker.outputs(self.function(*given), outputs)

        def part(value: Any, row: int) -> Any:
            if not np.ndim(value):
                return value
            if mode == "single":
                return value[row : row + 1]
            return value[row].item() if mode == "scalar" and value.ndim == 1 else value[row]

        rows = [
            taker.outputs(self.function(*(part(value, row) for value in given)), outputs)
            for row in range(lengths[0])
        ]
        return taker.stacked(rows, outputs, mode == "single")

    def bsdf(self, parameters: Mapping[str, Any] | None = None) -> BSDF:
        raise NotImplementedError

    def other(self, name: str) -> Local:
        raise NotImplementedError


def lamp(intensity: Any, distance: Any, theta: Any) -> Any:
    return intensity * np.maximum(0, np.cos(theta)) / distance**2


def _lamps(rng: np.random.Generator) -> dict[str, Any]:
    theta = np.where(np.arange(24) % 4 == 0, rng.uniform(1.7, 3, 24), rng.uniform(0.1, 1.4, 24))
    return {"intensity": rng.uniform(1, 50, 24), "distance": rng.uniform(0.5, 4, 24), "theta": theta}


LAMP = Values(inputs=_lamps, reference=lamp)


def told(
    judge: Values,
    function: Callable[..., Any],
    rng: np.random.Generator | int = 0,
    *,
    language: str = "en",
    shown: bool = True,
    hints: Mapping[str, Mapping[str, str]] | None = None,
) -> Finding:
    generator = np.random.default_rng(rng)
    return judge.judge(Local(function), generator, language=language, hints=hints or {}, shown=shown)


def _scalar_lamp(intensity: float, distance: float, theta: float) -> float:
    return intensity * max(0.0, math.cos(theta)) / distance**2


def _branching(intensity: float, distance: float, theta: float) -> float:
    if theta > math.pi / 2:
        return 0
    return intensity * math.cos(theta) / distance**2


def _written_into(intensity: Array, distance: Array, theta: Array) -> Array:
    distance *= distance
    intensity *= np.maximum(0, np.cos(theta))
    intensity /= distance
    return intensity


def _only_batch(intensity: Array, distance: Array, theta: Array) -> Array:
    out = np.zeros(intensity.shape)
    lit = theta < np.pi / 2
    out[lit] = (intensity * np.cos(theta) / distance**2)[lit]
    return out


RIGHT: dict[str, Callable[..., Any]] = {
    "array": lamp,
    "math": _scalar_lamp,
    "branch": _branching,
    "list": lambda *a: lamp(*a).tolist(),
    "tuple": lambda *a: tuple(lamp(*a).tolist()),
    "column": lambda *a: lamp(*a)[:, None],
    "row": lambda *a: lamp(*a)[None, :],
    "longdouble": lambda *a: lamp(*a).astype(np.longdouble),
    "objects": lambda *a: lamp(*a).astype(object),
    "writes": _written_into,
    "only-batch": _only_batch,
    "0-d": lambda *a: np.array(_scalar_lamp(*a)),
    "single": lambda i, d, t: [_scalar_lamp(i[0], d[0], t[0])] if len(i) == 1 else [1, 2, []],
}


@pytest.mark.parametrize("name", RIGHT)
def test_right_in_any_form(name: str, rng: np.random.Generator) -> None:
    for language in LANGUAGES:
        finding = told(LAMP, RIGHT[name], rng, language=language)
        alone = name in ("math", "branch", "0-d", "single")
        assert finding == Finding(share=1.0, text=say(language, "full-one-by-one" if alone else "full"))


def test_integers_booleans_and_lone_numbers() -> None:
    count = Values(inputs=lambda rng: {"n": rng.integers(1, 90, 12)}, reference=lambda n: n * n)
    assert told(count, lambda n: n * n).share == 1
    assert told(count, lambda n: int(n) ** 2).share == 1
    sign = Values(inputs=lambda rng: {"x": rng.normal(size=12)}, reference=lambda x: x > 0)
    assert told(sign, lambda x: x > 0).share == 1
    alone = Values(inputs=lambda rng: {"x": rng.random()}, reference=lambda x: 2 * x)
    assert told(alone, lambda x: 2 * x).share == 1
    assert told(alone, lambda x: [2 * x]).share == 1
    assert told(alone, lambda x: 3 * x).share == 0


def test_a_number_beside_arrays() -> None:
    judge = Values(
        inputs=lambda rng: {"x": rng.random(9), "scale": rng.random()}, reference=lambda x, scale: scale * x
    )
    assert told(judge, lambda x, scale: scale * x).share == 1
    assert told(judge, lambda x, scale: math.fsum([scale * x])).share == 1


def test_float32_is_told_why() -> None:
    def single(i: Array, d: Array, t: Array) -> Array:
        return lamp(*(each.astype(np.float32) for each in (i, d, t)))

    found = told(LAMP, single)
    assert (found.share, found.diagnosis) == (0, "single-precision")
    assert "float32" in found.text
    again = told(LAMP, lambda *a: single(*a).astype(float))
    assert (again.share, again.diagnosis) == (0, "single-precision")
    coarse = Values(inputs=_lamps, reference=lamp, rtol=1e-5)
    assert told(coarse, single).share == 1
    loose = Values(inputs=_lamps, reference=lamp, loose={1e-5: 0.5, 1e-2: 0.1})
    assert told(loose, single).share == 0.5
    assert told(loose, lambda *a: 1.001 * lamp(*a)).share == 0.1


def test_lost_digits_are_no_misconception() -> None:
    judge = Values(
        inputs=lambda rng: {"angle": 10.0 ** rng.uniform(-9, -3, 30)},
        reference=lambda angle: 2 * np.sin(angle / 2) ** 2,
        terms=lambda angle: 1.0,
    )
    found = told(judge, lambda angle: 1 - np.cos(angle))
    assert (found.share, found.diagnosis, found.confidence) == (0, "imprecise", 1)
    assert told(judge, lambda angle: 1 - np.cos(angle.astype(np.float32))).diagnosis == "single-precision"
    assert told(judge, lambda angle: angle**2).diagnosis == "doubled"
    hint = {"imprecise": {"en": "use the half angle", "ru": "возьмите половинный угол"}}
    text = told(judge, lambda angle: 1 - np.cos(angle), hints=hint).text
    assert text.startswith("Digits are lost")
    assert text.endswith("Use the half angle.")


def test_a_rounded_constant_is_no_loss_of_digits() -> None:
    for factor in (3.14159 / np.pi, np.pi / 3.1415926, float(np.float32(np.pi)) / np.pi):
        for language in LANGUAGES:
            found = told(LAMP, lambda *a, f=factor: f * lamp(*a), language=language)
            assert (found.share, found.diagnosis) == (0, "constant-rounded")
            assert "π" in found.text


def _wide(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "x": np.concatenate((rng.random(5) + 1, [1e170, 1e-170])),
        "y": np.append(np.ones(5), [1e300, 1e-200]),
    }


def test_overflow_is_told_and_escapes_nowhere() -> None:
    judge = Values(inputs=_wide, reference=lambda x, y: y / x / x)
    found = told(judge, lambda x, y: y / x**2)
    assert (found.share, found.diagnosis) == (0, "out-of-range")
    assert "2 of 7" in found.text
    assert told(judge, lambda x, y: y / x**3).diagnosis != "out-of-range"
    single = told(judge, lambda x, y: (y.astype("f4") / x.astype("f4")) / x.astype("f4"))
    assert single.diagnosis == "single-precision"


def test_overflow_of_python_numbers_is_told_too() -> None:
    judge = Values(inputs=_wide, reference=lambda x, y: y / x / x)
    hints = {"out-of-range": {"en": "divide twice", "ru": "разделите дважды"}}
    found = told(judge, lambda x, y: y / math.pow(x, 2), hints=hints)
    assert (found.share, found.diagnosis) == (0, "out-of-range")
    assert found.text.endswith("Divide twice.")
    assert told(judge, lambda x, y: math.pow(x, 2) / (y - y), language="ru").diagnosis == "out-of-range"
    assert told(LAMP, lambda i, d, t: math.pow(i, 2) / (d - d), hints=hints).diagnosis == ""


@pytest.mark.parametrize("value", [1e308, -1e308, 1.7e308, 5e-324, float(np.finfo(np.float32).max)])
def test_answers_of_any_size(value: float) -> None:
    for function in (lambda *a: np.full(24, value), lambda i, *_: value * i, lambda i, *_: value + i):
        assert told(LAMP, function).share == 0


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_not_finite(value: float) -> None:
    found = told(LAMP, lambda i, d, t: np.where(t > 2, value, lamp(i, d, t)))
    assert (found.share, found.diagnosis) == (0, "not-finite")
    shown = "NaN" if math.isnan(value) else str(value)
    where = r"such as intensity = [\d.]+, distance = [\d.]+, theta = [\d.]+"
    assert re.fullmatch(rf"Gives {shown} at [1-9] of 24 inputs, {where}\.", found.text)
    everywhere = told(LAMP, lambda *_: np.full(24, value), language="ru")
    assert everywhere.text.startswith(f"Даёт {shown} для 24 из 24 наборов данных, например при intensity = ")


REFUSED: dict[str, tuple[Callable[..., Any], str]] = {
    "none": (lambda *_: None, "returned None"),
    "text": (lambda *_: "7", "no array of numbers"),
    "complex": (lambda *a: lamp(*a) + 0j, "complex"),
    "longer": (lambda i, d, t: np.ones(np.size(i) + 1), "shape"),
    "pairs": (lambda i, d, t: np.ones((np.size(i), 2)), "shape"),
    "square": (lambda i, d, t: np.ones((np.size(i) + 1, np.size(i) + 1)), "shape"),
    "two": (lambda i, d, t: (np.ones(np.size(i)), np.ones(3)), "shape"),
    "nothing": (lambda *_: [], "shape"),
    "raises": (lambda *_: 1 / 0, "f raised ZeroDivisionError"),
    "unknown": (lambda i, d, t: undefined_name, "f raised NameError"),  # type: ignore[name-defined] # noqa: F821
    "domain": (lambda i, d, t: math.sqrt(-float(i)), "math domain error"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(name: str) -> None:
    function, words = REFUSED[name]
    if name == "domain":
        words = "ValueError"
    for language in LANGUAGES:
        found = told(LAMP, function, language=language)
        assert found.share == 0
        assert found.text
    assert words in told(LAMP, function).text


def test_what_code_for_numbers_says_counts_more_than_what_arrays_do_to_it() -> None:
    text = told(LAMP, lambda i, d, t: math.log(-i)).text
    assert "ValueError" in text
    assert "array" not in text


def test_answers_that_depend_on_their_neighbours_are_wrong() -> None:
    assert told(LAMP, lambda *a: np.sort(lamp(*a))).diagnosis == "sorted"
    assert told(LAMP, lambda *a: np.cumsum(lamp(*a))).diagnosis == "running-sum"
    assert told(LAMP, lambda *a: lamp(*a)[::-1]).diagnosis == "reversed"
    assert told(LAMP, lambda *a: np.roll(lamp(*a), 1)).diagnosis == "shifted"


def test_rows_may_be_asked_for_one_by_one() -> None:
    judge = Values(inputs=lambda rng: {"rows": rng.random((8, 5))}, reference=lambda rows: rows.sum(axis=-1))
    assert told(judge, lambda rows: rows.sum(axis=-1)).text == "right"
    assert told(judge, sum).share == 1
    assert told(judge, np.sum).share == 1
    assert told(judge, lambda rows: np.sum(rows) * np.ones(8)).share == 0


def test_not_repeatable() -> None:
    calls = itertools.count()
    found = told(LAMP, lambda *a: lamp(*a) * (1 + 1e-3 * next(calls)))
    assert (found.share, found.diagnosis) == (0, "not-repeatable")
    store: list[Array] = []

    def remembers(i: Array, d: Array, t: Array) -> Array:
        store.append(lamp(i, d, t))
        return store[0]

    assert told(LAMP, remembers).diagnosis == "not-repeatable"
    total = [0.0]

    def adds_up(i: Array, d: Array, t: Array) -> Array:
        total[0] += 1
        return lamp(i, d, t) if total[0] < 2 else lamp(i, d, t) + total[0]

    assert told(LAMP, adds_up).diagnosis == "not-repeatable"
    broken = iter([True])
    assert told(LAMP, lambda *a: lamp(*a) if next(broken) else None).diagnosis == "not-repeatable"


def test_one_buffer_for_all_calls_is_no_fault() -> None:
    buffer = np.empty(24)

    def reuses(i: Array, d: Array, t: Array) -> Array:
        buffer[:] = lamp(i, d, t)
        return buffer

    assert told(LAMP, reuses).share == 1


WRONG: dict[str, tuple[Callable[..., Any], str]] = {
    "constant": (lambda i, d, t: 3.0, "constant-answer"),
    "zeros": (lambda i, d, t: 0 * i, "constant-answer"),
    "swapped": (lambda i, d, t: lamp(d, i, t), "arguments-swapped"),
    "ignored": (lambda i, d, t: lamp(1, d, t), "argument-ignored"),
    "pi": (lambda *a: np.pi * lamp(*a), "pi-too-many"),
    "cosine": (lambda i, d, t: i / d**2, "cosine-forgotten"),
    "degrees": (lambda i, d, t: lamp(i, d, np.degrees(t)), "angle-unit"),
    "clamp": (lambda i, d, t: i * np.cos(t) / d**2, "horizon-not-clamped"),
    "absolute": (lambda i, d, t: i * np.abs(np.cos(t)) / d**2, "horizon-not-clamped"),
    "integer": (lambda *a: lamp(*a).astype(int), "truncated-to-integer"),
    "offset": (lambda *a: lamp(*a) + 0.25, "offset"),
    "two": (lambda i, d, t: np.where(t < 1.6, i / d, 0), "cosine-forgotten + distance-not-squared"),
    "few": (lambda i, d, t: np.where(t == t[1], 9, lamp(i, d, t)), "wrong-at-few"),
    "odd": (lambda i, d, t: np.sin(i * d * t), ""),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_and_why(name: str) -> None:
    function, diagnosis = WRONG[name]
    texts = {}
    for language, shown in itertools.product(LANGUAGES, (True, False)):
        found = told(LAMP, function, language=language, shown=shown)
        assert found == told(LAMP, function, language=language, shown=shown)  # the same in every run
        assert (found.share, found.diagnosis) == (0, diagnosis)
        assert len(found.text) <= LONGEST
        assert found.text[0].isupper()
        assert found.text[-1] == "."
        texts[language, shown] = found.text
    assert re.search("[а-я]{4}", texts["ru", True])
    assert not re.search("[а-я]", texts["en", True])


def _sine(half_angle: Array) -> Any:
    return np.sin(half_angle)


def test_an_angle_of_any_name_may_be_in_degrees() -> None:
    judge = Values(inputs=lambda rng: {"half_angle": rng.uniform(0.1, 1.5, 24)}, reference=_sine)
    for wrong in (np.radians, np.degrees):
        found = told(judge, lambda half_angle, f=wrong: np.sin(f(half_angle)))
        assert (found.share, found.diagnosis) == (0, "angle-unit")
        assert found.text.startswith("The angle reached the function in a wrong unit")
        assert "(half_angle)" in found.text


@pytest.mark.parametrize("name", WRONG)
def test_hidden_parts_give_no_right_value_away(name: str, seed: int) -> None:
    function, _ = WRONG[name]
    given = _lamps(np.random.default_rng(seed))
    right, answer = lamp(**given), np.broadcast_to(function(*given.values()), 24)
    for language in LANGUAGES:
        text = told(LAMP, function, seed, language=language, shown=False).text
        numbers = {float(each) for each in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", text)}
        secret = {float(f"{r:.6g}") for r, a in zip(right, answer, strict=True) if abs(r - a) > 1e-6 and r}
        assert not numbers & secret
        assert not re.search("right is|верно \\d|[+]0.25", text)


def test_shown_parts_have_the_worst_input_and_what_is_right_there() -> None:
    def off_at_one(i: Array, d: Array, t: Array) -> Array:
        values = np.array(lamp(i, d, t))
        values[np.argmax(values)] *= 1.5
        values[np.argmin(t)] *= 1 + 1e-7
        return values

    given = _lamps(np.random.default_rng(0))
    row = int(np.argmax(lamp(**given)))
    text = told(LAMP, off_at_one).text
    assert f"intensity = {given['intensity'][row]:.6g}" in text
    assert f"right is {lamp(**given)[row]:.6g}" in text
    # Numbers that look alike are told apart.
    text = told(LAMP, lambda i, d, t: lamp(i, d, t) * np.where(t < 1, 1 + 3e-8, 1)).text
    assert "Digits are lost" in text
    text = told(LAMP, lambda i, d, t: lamp(i, d, t) * np.where(t < 1, 1 + 2e-6, 1)).text
    value, right = re.search(r"it gives (\S+), right is (\S+)\.$", text).groups()  # type: ignore[union-attr]
    assert value != right


def test_long_inputs_are_numbered() -> None:
    judge = Values(inputs=lambda rng: {"rows": rng.random((8, 5))}, reference=lambda rows: rows.sum(axis=-1))
    assert "at input no. " in told(judge, lambda rows: rows.mean(axis=-1)).text
    assert "при наборе данных № " in told(judge, lambda rows: rows.mean(axis=-1), language="ru").text
    vectors = Values(inputs=lambda rng: {"v": rng.random((8, 3))}, reference=lambda v: v[:, 0])
    assert re.search(r"at v = \(0\.\d+, 0\.\d+, 0\.\d+\)", told(vectors, lambda v: v[:, 1]).text)


def test_vectors_are_judged_row_by_row() -> None:
    judge = Values(inputs=lambda rng: {"v": rng.normal(size=(8, 3))}, reference=lambda v: 2 * v)
    assert told(judge, lambda v: 2 * v).share == 1
    assert told(judge, lambda v: [2 * x for x in v]).share == 1
    found = told(judge, lambda v: 2 * v + (v > 1))
    assert found.share == 0
    assert re.search(r"wrong at \d of 8 inputs", found.text, re.I)


def test_credit_hints_and_variants() -> None:
    judge = Values(
        inputs=_lamps,
        reference=lamp,
        credit={"pi-too-many": 0.25, "squared-cosine": 0.5},
        variants={
            "squared-cosine": lambda intensity, distance, theta: (
                lamp(intensity, distance, theta) * np.cos(theta)
            )
        },
    )
    hints = {
        "pi-too-many": {"en": "no π here", "ru": "здесь нет π"},
        "squared-cosine": {"en": "one cosine", "ru": "один косинус"},
    }
    found = told(judge, lambda *a: np.pi * lamp(*a), hints=hints)
    assert (found.share, found.diagnosis) == (0.25, "pi-too-many")
    assert found.text.startswith("No π here. Wrong at 18 of 24 inputs: at intensity = ")
    ambiguous = told(judge, lambda i, d, t: lamp(i, d, t) * np.cos(t), hints=hints, language="ru")
    assert (ambiguous.share, ambiguous.diagnosis) in ((0.0, "cosine-twice"), (0.5, "squared-cosine"))
    assert ambiguous.text.startswith("Одно из: ")
    assert "Один косинус" in ambiguous.text or "один косинус" in ambiguous.text


def test_context_tells_what_inputs_do_not() -> None:
    def light(position: Array, light: Array) -> Array:
        return 1 / np.sum((light - position) ** 2, axis=-1)

    judge = Values(
        inputs=lambda rng: {"position": rng.random((20, 3)), "light": 2 + rng.random((20, 3))},
        reference=light,
        context=lambda position, light: {"distance": np.linalg.norm(light - position, axis=-1)},
    )
    found = told(judge, lambda p, q: 1 / np.linalg.norm(q - p, axis=-1))
    assert found.diagnosis == "distance-not-squared"


def test_each_student_has_inputs_of_his_own(rng: np.random.Generator) -> None:
    texts = {told(LAMP, lambda i, d, t: i / d**2, rng.integers(1 << 40)).text for _ in range(3)}
    assert len(texts) == 3


@pytest.mark.parametrize(
    "arguments",
    [
        {"rtol": -1},
        {"rtol": 1},
        {"ulps": -1},
        {"atol": math.inf},
        {"loose": {1e-3: 2}},
        {"credit": {"a": -1}},
    ],
)
def test_arguments_out_of_range(arguments: dict[str, Any]) -> None:
    with pytest.raises(ParameterError):
        Values(inputs=_lamps, reference=lamp, **arguments)


def test_tolerances() -> None:
    def off(relative: float, absolute: float = 0.0) -> Callable[..., Any]:
        return lambda *a: lamp(*a) * (1 + relative) + absolute

    assert told(Values(inputs=_lamps, reference=lamp, rtol=1e-3), off(9e-4)).share == 1
    assert told(Values(inputs=_lamps, reference=lamp, rtol=1e-3), off(1.1e-3)).share == 0
    assert told(Values(inputs=_lamps, reference=lamp, rtol=0, ulps=4), off(4e-16)).share == 1
    assert told(Values(inputs=_lamps, reference=lamp, rtol=0, ulps=4), off(4e-15)).share == 0
    assert told(Values(inputs=_lamps, reference=lamp, atol=0.1), off(0, 0.09)).share == 1
    assert told(Values(inputs=_lamps, reference=lamp, atol=0.1), off(0, 0.11)).share == 0


def test_each_sentence_is_in_both_languages_with_the_same_fields() -> None:
    for key, words in SENTENCES.items():
        fields = [sorted(re.findall(r"{(\w+)", words[language])) for language in LANGUAGES]
        assert fields[0] == fields[1], key
        if re.search("[a-z]", re.sub("{.*?}", "", words["en"])):  # it is not all fields
            assert re.search("[а-я]", words["ru"]), key


def test_russian_counts() -> None:
    forms = {
        count: say("ru", "wrong", bad=1, count=count).rsplit(" ", 2)[1:]
        for count in (1, 2, 5, 11, 21, 40, 111)
    }
    one = ["набора", "данных"]
    assert {count for count, words in forms.items() if words == one} == {1, 21}
    assert {tuple(words) for words in forms.values()} == {("набора", "данных"), ("наборов", "данных")}
    assert say("en", "wrong", bad=1, count=1) == "wrong at 1 of 1 input"


def test_sentences_are_joined_while_there_is_room() -> None:
    long = "a" * (LONGEST - 20)
    assert joined(long, "this does not fit any more", "but this") == f"{sentence(long)} But this."
    assert len(joined("a" * 500)) == LONGEST
    assert clause("This; and why") == "This"


SQUARE = rk.case("lambert-under-square-of-2m")
"""A reflectance of 0.5 under 2 m × 2 m of radiance 1, 1 m above."""


def _square(scale: float) -> float:
    """Return the light under the square, from the view factor of one quarter, derived by hand."""
    return scale * 0.5 * 4 / (math.pi * math.sqrt(2)) * math.atan(1 / math.sqrt(2))


@pytest.mark.parametrize(
    "answer", [float, np.array, lambda value: [value], lambda value: np.array([[value]])]
)
def test_a_closed_form_case_is_a_question_for_one_number(answer: Callable[..., Any]) -> None:
    judge = Values(reference=SQUARE)
    assert told(judge, lambda: answer(_square(1))).share == 1
    found = told(judge, lambda: answer(_square(math.pi)))
    assert (found.share, found.diagnosis) == (0, "pi-too-many")
    assert found.text.endswith("It gives 0.87042, right is 0.277063.")
    assert "right is" not in told(judge, lambda: answer(_square(math.pi)), shown=False).text


def test_a_number_may_be_the_reference() -> None:
    judge = Values(reference=math.pi)
    assert told(judge, lambda: math.pi).share == 1
    found = told(judge, lambda: 2 * math.pi, language="ru")
    assert (found.share, found.diagnosis) == (0, "doubled")
    assert found.text.endswith("Получено 6.28319, верно 3.14159.")
    assert told(judge, lambda: 3.14).diagnosis == "pi-rounded"
    assert told(judge, lambda: 0).share == 0
    assert told(judge, lambda: [1, 2]).text == "Returns an array of shape (2,) where one number is right."
    assert told(judge, lambda: None).text.startswith("f returned None")


def test_inputs_of_numbers_alone_ask_for_one_number() -> None:
    """The right value has no dimensions."""
    disk = Values(
        inputs=lambda rng: {"radius": rng.uniform(1, 2)}, reference=lambda radius: math.pi * radius**2
    )
    assert told(disk, lambda radius: math.pi * radius**2).share == 1
    found = told(disk, lambda radius: 2 * math.pi * radius**2)
    assert (found.share, found.diagnosis) == (0, "doubled")
    assert re.search(r"at radius = 1\.\d+ it gives", found.text)


@pytest.mark.parametrize("reference", ["π", None, math.nan, [1, math.inf], object()])
def test_what_is_no_reference_is_refused(reference: Any) -> None:
    with pytest.raises(ParameterError, match="a function, a case, or finite numbers"):
        Values(reference=reference)
