"""Assignment 1: its references are true, its solution earns all, and planted mistakes are named."""

from __future__ import annotations

import ast
import itertools
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

import radiokit as rk
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.misconception import LANGUAGES
from radiokit.faces.grading.assignment import list_assignments, load_assignment, student_rng
from radiokit.faces.grading.finding import Mode
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.grades import Grade
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.judges.evidence import LONGEST
from radiokit.faces.grading.judges.values import Values
from radiokit.faces.grading.question import Question
from radiokit.facts.quantities import Q

ASSIGNMENT = load_assignment("radiometry")
SOLUTION = Path(__file__).parents[1] / "lectures" / "solutions" / "radiometry.py"
NAMES = [question.name for question in ASSIGNMENT.questions]
JUDGED = {
    "imprecise",
    "single-precision",
    "out-of-range",
    "not-finite",
    "arguments-swapped",
    "argument-ignored",
}
"""What the judge finds without the catalogue."""


def judge_of(question: Question, part: str) -> Values:
    (found,) = [each.judge for each in question.parts if each.name == part]
    assert isinstance(found, Values)
    return found


def inputs_of(question: Question, part: str, student: str = "") -> Mapping[str, Any]:
    (found,) = [each for each in question.parts if each.name == part]
    return judge_of(question, part).inputs(student_rng(ASSIGNMENT, question, found, student=student))


FOR_HARD_INPUTS = {
    "quadrant-lost",
    "quadrant-folded",
    "sign-of-step",
    "cut-at-zero",
    "step-of-the-first",
    "step-of-the-mean",
    "efficacy-rounded",
}
"""Variants that are right, or all but right, for ordinary inputs."""

# What is asked


def test_ten_questions_in_the_lectures_order_for_twenty_points() -> None:
    assert NAMES == [
        "cone_solid_angle",
        "triangle_solid_angle",
        "spot_flux",
        "isotropic_irradiance",
        "lamp_irradiance",
        "light_irradiance",
        "cone_irradiance",
        "patch_irradiance",
        "luminance",
        "reflected_radiance",
    ]
    assert ASSIGNMENT.points == 20
    for question in ASSIGNMENT.questions:
        parts = {part.name: (question.worth(part), part.visibility) for part in question.parts}
        assert parts == {"ordinary": (1.5, "visible"), "hard": (0.5, "after_published")}
    assert "radiometry" in list_assignments()
    assert not [name for name in list_assignments() if name.startswith("_")]


@pytest.mark.parametrize("question", ASSIGNMENT.questions, ids=NAMES)
def test_texts_say_all_in_both_languages(question: Question) -> None:
    hard = {"en": "**Hard inputs:**", "ru": "**Трудные входы:**"}
    for language in LANGUAGES:
        text = question.text[language]
        assert hard[language] in " ".join(text.split())
        assert text.count("$") % 2 == 0
        for name in question.parameters:
            assert f"`{name}`" in text
        for item in re.findall(r"^- .*(?:\n  .*)*", text, re.MULTILINE):
            pure = {"exponent", "albedo", "cosine", "efficiency", "normal"} & set(
                re.findall(r"`(\w+)`", item)
            )
            assert pure or re.search(r"\[[^]]+\]|degrees|градус", item), item  # a unit
    assert not re.search("[а-яА-Я]", question.text["en"] + question.title["en"])
    formulas = [re.findall(r"\$\$.*?\$\$", question.text[language], re.S) for language in LANGUAGES]
    assert len(formulas[0]) == len(formulas[1])


@pytest.mark.parametrize("question", ASSIGNMENT.questions, ids=NAMES)
def test_each_hint_can_be_given_in_both_languages(question: Question) -> None:
    variants = set(judge_of(question, "ordinary").variants)
    known = {entry.name for entry in CATALOGUE} | variants | JUDGED
    assert set(question.hints) <= known
    assert variants <= set(question.hints) | {entry.name for entry in CATALOGUE}  # each has words
    assert set(judge_of(question, "ordinary").credit) <= known
    for hint in question.hints.values():
        assert set(hint) == set(LANGUAGES)
        assert re.search("[а-я]", hint["ru"])
        assert not re.search("[а-я]", hint["en"])
        assert max(map(len, hint.values())) <= 130


def test_students_have_inputs_of_their_own_and_of_the_shapes_that_are_said() -> None:
    for question in ASSIGNMENT.questions:
        for part in ("ordinary", "hard"):
            first, second = (inputs_of(question, part, student) for student in ("ann", "bob"))
            assert tuple(first) == question.parameters
            counts = {len(value) for value in first.values()}
            assert len(counts) == 1
            assert all(value.shape == second[name].shape for name, value in first.items())
            assert not any(np.array_equal(value, second[name]) for name, value in first.items())
            right = judge_of(question, part).reference(**first)
            assert right.shape == (counts.pop(),)
            assert np.all(np.isfinite(right))
            assert np.all(right >= 0)


# The references are true


def _mp(values: Any) -> Any:
    return [mpmath.mpf(float(value)) for value in values]


def _length(v: Any) -> Any:
    return mpmath.sqrt(sum(x * x for x in v))


def _dot(a: Any, b: Any) -> Any:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _true_triangle(a: Any, b: Any, c: Any) -> Any:
    """Girard: the angles of the spherical triangle, less π."""
    a, b, c = (_mp(v) for v in (a, b, c))

    def angle(p: Any, q: Any, r: Any) -> Any:
        across = [[x - _dot(w, p) / _dot(p, p) * y for x, y in zip(w, p, strict=True)] for w in (q, r)]
        return mpmath.acos(_dot(*across) / (_length(across[0]) * _length(across[1])))

    return angle(a, b, c) + angle(b, c, a) + angle(c, a, b) - mpmath.pi


def _true_light(position: Any, normal: Any, light: Any, intensity: Any) -> Any:
    position, normal, light = _mp(position), _mp(normal), _mp(light)
    way = [x - y for x, y in zip(light, position, strict=True)]
    cosine = _dot(way, normal) / (_length(way) * _length(normal))
    return mpmath.mpf(float(intensity)) * max(cosine, 0) / _length(way) ** 2


def _true_luminance(wavelength: Any, exitance: Any, efficiency: Any) -> Any:
    points = sorted(zip(_mp(wavelength), _mp(exitance), _mp(efficiency), strict=True))
    area = sum((b[0] - a[0]) * (a[1] * a[2] + b[1] * b[2]) / 2 for a, b in itertools.pairwise(points))
    return 683 * area / mpmath.pi


def _true_sum(albedo: Any, radiance: Any, cosine: Any, solid_angle: Any) -> Any:
    columns = zip(_mp(radiance), _mp(cosine), _mp(solid_angle), strict=True)
    return mpmath.mpf(float(albedo)) / mpmath.pi * sum(L * c * w for L, c, w in columns if c > 0)


def _front(theta: Any) -> Any:
    return max(mpmath.cos(theta), 0)


TRUTHS: dict[str, Callable[..., Any]] = {
    "cone_solid_angle": lambda a: 2 * mpmath.pi * (1 - mpmath.cos(a)),
    "triangle_solid_angle": _true_triangle,
    "spot_flux": lambda i, n, a: 2 * mpmath.pi * i * (1 - mpmath.cos(a) ** (n + 1)) / (n + 1),
    "isotropic_irradiance": lambda f, d: f / (4 * mpmath.pi * d**2),
    "lamp_irradiance": lambda i, d, t: i * _front(t * mpmath.pi / 180) / d**2 if t != 90 else mpmath.mpf(0),
    "light_irradiance": _true_light,
    "cone_irradiance": lambda L, a: mpmath.pi * L * (1 - mpmath.cos(a) ** 2),
    "patch_irradiance": lambda L, A, d, t, u: L * A * _front(t) * _front(u) / d**2,
    "luminance": _true_luminance,
    "reflected_radiance": _true_sum,
}
ULPS = {"triangle_solid_angle": 256.0}
"""What radiokit's polygon promises; all others are a few operations."""


def off(name: str, right: Array, given: Mapping[str, Any]) -> float:
    """Return by how many units in the last place an answer is off."""
    with mpmath.workdps(50):
        worst = 0.0
        for row, value in enumerate(right):
            arguments = [each[row] for each in given.values()]
            true = TRUTHS[name](*(mpmath.mpf(float(x)) if np.ndim(x) == 0 else x for x in arguments))
            worst = max(
                worst, float(abs(mpmath.mpf(float(value)) - true) / np.spacing(max(float(true), 1e-300)))
            )
    return worst


@pytest.mark.parametrize("part", ["ordinary", "hard"])
@pytest.mark.parametrize("question", ASSIGNMENT.questions, ids=NAMES)
def test_references_agree_with_fifty_digits(question: Question, part: str) -> None:
    given = inputs_of(question, part)
    if question.name == "reflected_radiance" and part == "hard":
        given = {name: value[:2] for name, value in given.items()}
    right = judge_of(question, part).reference(**given)
    allowed = ULPS.get(question.name, 16.0)
    assert off(question.name, right, given) <= allowed
    # What is allowed of a student is far more, and a reference that is off by it is seen.
    assert judge_of(question, part).rtol > 4 * allowed * np.finfo(float).eps
    assert off(question.name, right * (1 + judge_of(question, part).rtol), given) > allowed


def test_references_agree_with_relations() -> None:
    def by(relation: str, target: str, unit: str, **givens: Any) -> Array:
        found = rk.relate(target, by=relation, **givens)
        return np.asarray(found.value.quantity.to(unit).magnitude)

    def of(name: str) -> tuple[Mapping[str, Any], Array]:
        given = inputs_of(ASSIGNMENT.question(name), "ordinary")
        return given, judge_of(ASSIGNMENT.question(name), "ordinary").reference(**given)

    given, right = of("cone_solid_angle")
    half = np.degrees(given["half_angle"])
    np.testing.assert_allclose(
        by("solid-angle-of-cone", "solid_angle", "sr", half_angle_deg=half), right, 1e-13
    )
    given, right = of("isotropic_irradiance")
    flux, distance = Q(given["flux"], "W"), Q(given["distance"], "m")
    found = by("irradiance-from-isotropic-flux", "irradiance", "W/m^2", flux=flux, distance=distance)
    np.testing.assert_allclose(found, right, 1e-13)
    given, right = of("lamp_irradiance")
    lit = given["theta_deg"] < 90
    found = by(
        "irradiance-from-intensity",
        "irradiance",
        "W/m^2",
        intensity=Q(given["intensity"][lit], "W/sr"),
        distance=Q(given["distance"][lit], "m"),
        angle_deg=given["theta_deg"][lit],
    )
    np.testing.assert_allclose(found, right[lit], 1e-13)
    given, right = of("cone_irradiance")
    found = by(
        "irradiance-from-sphere",
        "irradiance",
        "W/m^2",
        radiance=Q(given["radiance"], "W/m^2/sr"),
        radius=Q(np.sin(given["half_angle"]), "m"),
        distance=Q(np.ones(len(right)), "m"),
    )
    np.testing.assert_allclose(found, right, 1e-13)
    given, right = of("light_irradiance")
    rows = zip(*given.values(), strict=True)
    for (position, normal, light, intensity), value in zip(rows, right, strict=True):
        lamp = rk.emitter("point", position=tuple(light), intensity=intensity)
        found = rk.irradiance(lamp, normal=tuple(normal), position=tuple(position)).value
        assert found == pytest.approx(value, rel=1e-13)


# What solutions earn


def graded(text: str | Path, folder: Path, language: str = "en") -> Grade:
    if isinstance(text, str):
        path = folder / "answers.py"
        path.write_text(text, encoding="utf-8")
        text = path
    found = grade("radiometry", text, language=language)
    assert found.complete
    assert not found.problems
    for question in found.questions:
        assert not question.review
        for part in question.parts:
            assert 0 < len(part.text) <= LONGEST
    return found


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_solution_earns_all(language: str, tmp_path: Path) -> None:
    found = graded(SOLUTION, tmp_path, language)
    assert found.score == found.points == 20
    assert {part.text for each in found.questions for part in each.parts} == {
        {"en": "right", "ru": "верно"}[language]
    }
    again = json.dumps(graded(SOLUTION, tmp_path, language).to_json(), ensure_ascii=False)
    assert again == json.dumps(found.to_json(), ensure_ascii=False)


def test_the_solution_is_plain() -> None:
    tree = ast.parse(SOLUTION.read_text(encoding="utf-8"))
    imported = {name.name for each in tree.body if isinstance(each, ast.Import) for name in each.names}
    assert imported == {"math", "numpy"}
    assert not any(isinstance(each, ast.ImportFrom) for each in ast.walk(tree))
    assert {each.name for each in tree.body if isinstance(each, ast.FunctionDef)} > set(NAMES)


def _wrapped(answer: str) -> str:
    """Return the solution with each function's arguments and answer passed through an expression."""
    lines = [SOLUTION.read_text(encoding="utf-8")]
    for name in NAMES:
        lines.append(f"_{name} = {name}\n\n\ndef {name}(*a):\n    return {answer.format(f=f'_{name}')}\n")
    return "\n\n".join(lines)


def test_lists_columns_and_long_numbers_earn_all(tmp_path: Path) -> None:
    for answer in (
        "[float(x) for x in {f}(*a)]",
        "{f}(*a)[:, None]",
        "{f}(*(np.asarray(x, dtype=np.longdouble) for x in a))",
        "(tuple({f}(*a)), [x.fill(7) for x in a])[0]",  # and spoils what it was handed
    ):
        assert graded(_wrapped(answer), tmp_path).score == 20


def test_float32_passes_ordinary_parts_and_is_told_why_not_the_hard_ones(tmp_path: Path) -> None:
    single = "np.asarray({f}(*(np.asarray(x, dtype=np.float32) for x in a)), dtype=np.float32)"
    for language in LANGUAGES:
        found = graded(_wrapped(single), tmp_path, language)
        for each in found.questions:
            ordinary, hard = each.parts
            assert ordinary.full
            assert hard.score <= 0.25
            assert hard.diagnosis == "single-precision"
            assert "float32" in hard.text
            assert "float64" in hard.text


SCALAR = """
import math

def dot(a, b): return sum(x * y for x, y in zip(a, b))
def minus(a, b): return [x - y for x, y in zip(a, b)]
def cross(a, b): return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
def cone_solid_angle(a): return 4 * math.pi * math.sin(a / 2) ** 2
def triangle_solid_angle(a, b, c):
    x, y, z = (math.sqrt(dot(v, v)) for v in (a, b, c))
    below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y
    return 2 * math.atan2(abs(dot(a, cross(minus(b, a), minus(c, a)))), below)
def spot_flux(i, n, a):
    return -2 * math.pi * i * math.expm1((n + 1) * 0.5 * math.log1p(-math.sin(a) ** 2)) / (n + 1)
def isotropic_irradiance(f, d): return float(f) / 4 / math.pi / d / d
def lamp_irradiance(i, d, t):
    if t >= 90:
        return 0
    return i * math.sin(math.radians(90 - t)) / d**2
def light_irradiance(p, n, l, i):
    way = minus(l, p)
    d, m = math.hypot(*way), math.hypot(*n)
    return i / d / d * max(0.0, dot([x / d for x in way], [x / m for x in n]))
def cone_irradiance(L, a): return math.pi * L * math.sin(a) ** 2
def patch_irradiance(L, A, d, t, u):
    if math.cos(t) <= 0 or math.cos(u) <= 0:
        return 0
    return L * A * math.cos(t) * math.cos(u) / d**2
def luminance(w, m, v):
    total = 0
    for k in range(len(w) - 1):
        total += abs(w[k + 1] - w[k]) * (m[k] * v[k] + m[k + 1] * v[k + 1]) / 2
    return 683 * total / math.pi
def reflected_radiance(rho, L, c, w):
    return rho / math.pi * math.fsum(x * max(0.0, y) * z for x, y, z in zip(L, c, w))
"""


def test_loops_over_single_inputs_earn_all(tmp_path: Path) -> None:
    found = graded(SCALAR, tmp_path)
    assert found.score == 20
    texts = {part.text for each in found.questions for part in each.parts}
    assert texts == {"right, called with one input at a time"}


# What mistakes earn

ARGUMENTS = {
    "cone_solid_angle": "a",
    "triangle_solid_angle": "a, b, c",
    "spot_flux": "i, n, a",
    "isotropic_irradiance": "f, d",
    "lamp_irradiance": "i, d, t",
    "light_irradiance": "p, n, l, i",
    "cone_irradiance": "L, a",
    "patch_irradiance": "L, A, d, t, u",
    "luminance": "w, m, v",
    "reflected_radiance": "rho, L, c, w",
}
PRELUDE = """
import math
from numpy import abs, arctan, arctan2, cos, cross, cumsum, degrees, floor, maximum, mean, pi, radians, sin
from numpy import sort, sqrt, sum, trapezoid, where
from numpy.linalg import norm

def dot(a, b): return sum(a * b, -1)
def up(x): return maximum(0, x)
def unit(v): return v / norm(v, axis=-1, keepdims=True)
def size(v): return norm(v, axis=-1)
def over(a, b, c):
    return dot(a, cross(b - a, c - a))
def below(a, b, c):
    return size(a) * size(b) * size(c) + dot(a, b) * size(c) + dot(b, c) * size(a) + dot(c, a) * size(b)
"""


@dataclass(frozen=True)
class Planted:
    """A wrong answer to a question, what it earns, and what it betrays."""

    question: str
    code: str
    points: float
    diagnosis: str


PLANTED = [
    Planted(*row)
    for row in (
        # Cancellation and range: right but for hard inputs
        ("cone_solid_angle", "2 * pi * (1 - cos(a))", 1.5, "imprecise"),
        ("triangle_solid_angle", "2 * arctan2(abs(dot(a, cross(b, c))), below(a, b, c))", 1.5, "imprecise"),
        ("triangle_solid_angle", "2 * arctan(abs(over(a, b, c)) / below(a, b, c))", 1.5, "quadrant-lost"),
        ("spot_flux", "2 * pi * i * (1 - cos(a) ** (n + 1)) / (n + 1)", 1.5, "imprecise"),
        ("isotropic_irradiance", "f / (4 * pi * d**2)", 1.5, "out-of-range"),
        ("lamp_irradiance", "i * up(cos(radians(t))) / d**2", 1.5, "imprecise"),
        ("light_irradiance", "i * up(dot(unit(l - p), unit(n))) / size(l - p) ** 2", 1.5, "out-of-range"),
        ("cone_irradiance", "pi * L * (1 - cos(a) ** 2)", 1.5, "imprecise"),
        ("cone_irradiance", "pi * L * (1 - cos(2 * a)) / 2", 1.5, "imprecise"),
        ("patch_irradiance", "L * A * up(cos(t) * cos(u)) / d**2", 1.5, "horizon-not-clamped"),
        ("luminance", "683 / pi * trapezoid(m * v, w, axis=-1)", 1.5, "sign-of-step"),
        ("luminance", "683.002 / pi * abs(trapezoid(m * v, w, axis=-1))", 1.75, "efficacy-rounded"),
        ("reflected_radiance", "rho / pi * cumsum(L * up(c) * w, -1)[..., -1]", 1.75, "imprecise"),
        ("isotropic_irradiance", "f / (4 * pi * math.pow(d, 2))", 1.5, "out-of-range"),
        ("cone_irradiance", "3.14159 * L * sin(a) ** 2", 1.75, "constant-rounded"),
        # Constants
        ("cone_solid_angle", "4 * pi * (1 - cos(a))", 0.375, "doubled"),
        ("cone_solid_angle", "2 * 3.14 * (1 - cos(a))", 0.75, "pi-rounded"),
        ("cone_solid_angle", "2 * (1 - cos(a))", 0, "pi-too-few"),
        ("cone_solid_angle", "2 * pi * (cos(a) - 1)", 0, "sign-flipped"),
        ("cone_solid_angle", "degrees(2 * pi * (1 - cos(a)))", 0, "degrees-given"),
        ("triangle_solid_angle", "arctan2(abs(over(a, b, c)), below(a, b, c))", 0.75, "halved"),
        ("spot_flux", "i * (1 - cos(a) ** (n + 1)) / (n + 1)", 0.375, "two-pi-too-few"),
        ("isotropic_irradiance", "f / d**2", 0.375, "four-pi-too-many"),
        ("isotropic_irradiance", "f / (pi * d**2)", 0.375, "four-too-many"),
        ("isotropic_irradiance", "f / (2 * pi * d**2)", 0.375, "doubled"),
        ("isotropic_irradiance", "f / (4 * pi * (2 * d) ** 2)", 0, "four-too-few"),
        ("isotropic_irradiance", "f / (4 * pi * (d / 100) ** 2)", 0, "square-centimetres"),
        ("isotropic_irradiance", "f / (4 * 22 / 7 * d**2)", 0.75, "pi-rounded"),
        ("isotropic_irradiance", "f / (4 * pi * d**2) / 1000", 0, "thousand-too-few"),
        ("lamp_irradiance", "pi * i * up(cos(radians(t))) / d**2", 0, "pi-too-many"),
        ("lamp_irradiance", "683 * i * up(cos(radians(t))) / d**2", 0, "lumens-for-watts"),
        ("cone_irradiance", "L * sin(a) ** 2", 0, "pi-too-few"),
        ("cone_irradiance", "2 * pi * L * sin(a) ** 2", 0.375, "doubled"),
        ("patch_irradiance", "pi * L * A * up(cos(t)) * up(cos(u)) / d**2", 0, "pi-too-many"),
        ("luminance", "683 * trapezoid(m * v, w, axis=-1)", 0.75, "pi-too-many"),
        ("luminance", "trapezoid(m * v, w, axis=-1) / pi", 0.75, "watts-for-lumens"),
        ("luminance", "683 / pi * trapezoid(m * v * 1e9, w, axis=-1)", 0, "per-metre-of-wavelength"),
        ("luminance", "683 / pi * trapezoid(m * v, w * 1e-9, axis=-1)", 0, "per-nanometre-of-wavelength"),
        ("reflected_radiance", "rho * sum(L * up(c) * w, -1)", 0.75, "pi-too-many"),
        # Cosines and angles
        ("cone_solid_angle", "2 * pi * (1 - sin(a))", 0, "sine-for-cosine"),
        ("cone_solid_angle", "2 * pi * (1 - cos(radians(a)))", 0.375, "angle-unit"),
        ("cone_solid_angle", "2 * pi * (1 - cos(a / 2))", 0.375, "full-angle"),
        ("cone_solid_angle", "pi * sin(a) ** 2", 0.25, "projected-solid-angle"),
        ("lamp_irradiance", "i / d**2", 0, "cosine-forgotten"),
        ("lamp_irradiance", "i * up(cos(radians(t))) ** 2 / d**2", 0, "cosine-twice"),
        ("lamp_irradiance", "i * sin(radians(t)) / d**2", 0, "sine-for-cosine"),
        ("lamp_irradiance", "i * cos(t) / d**2", 0, "degrees-for-radians"),
        ("lamp_irradiance", "i * up(cos(t)) / d**2", 0, "degrees-for-radians"),
        ("lamp_irradiance", "i * cos(radians(t)) / d**2", 0.75, "horizon-not-clamped"),
        ("lamp_irradiance", "i * abs(cos(radians(t))) / d**2", 0.75, "horizon-not-clamped"),
        ("light_irradiance", "i * dot(unit(l - p), unit(n)) / size(l - p) ** 2", 0.75, "horizon-not-clamped"),
        ("light_irradiance", "i / size(l - p) ** 2", 0, "cosine-forgotten"),
        ("cone_irradiance", "2 * pi * L * (1 - cos(a))", 0.375, "cosine-forgotten"),
        ("cone_irradiance", "2 * pi * L * (1 - cos(a)) * cos(a)", 0, "cosine-of-the-edge"),
        ("patch_irradiance", "L * A * up(cos(t)) / d**2", 0, "light-cosine-forgotten"),
        ("patch_irradiance", "L * A * up(cos(u)) / d**2", 0, "cosine-forgotten"),
        ("patch_irradiance", "L * A / d**2", 0, "both-cosines-forgotten"),
        ("reflected_radiance", "rho / pi * sum(L * w, -1)", 0, "cosine-forgotten"),
        ("reflected_radiance", "rho / pi * sum(L * c * w, -1)", 0.75, "horizon-not-clamped"),
        ("reflected_radiance", "rho / pi * sum(L * abs(c) * w, -1)", 0.375, "absolute-value"),
        # Distances, areas, solid angles
        ("triangle_solid_angle", "size(cross(b - a, c - a)) / 2", 0, "area-for-solid-angle"),
        ("isotropic_irradiance", "f / (4 * pi * d)", 0, "distance-not-squared"),
        ("isotropic_irradiance", "f / (4 * pi) + 0 * d", 0, "distance-forgotten"),
        ("isotropic_irradiance", "f / (4 / 3 * pi * d**3)", 0, "volume-for-area"),
        ("lamp_irradiance", "i * up(cos(radians(t))) / d**3", 0, "distance-cubed"),
        ("light_irradiance", "i * up(dot(l - p, unit(n))) / size(l - p) ** 2", 0, "distance-not-squared"),
        ("patch_irradiance", "L * up(cos(t)) * up(cos(u)) / d**2", 0, "area-forgotten"),
        ("patch_irradiance", "L * up(cos(t))", 0, "solid-angle-forgotten"),
        ("reflected_radiance", "rho / pi * sum(L * up(c), -1)", 0, "solid-angle-forgotten"),
        ("reflected_radiance", "rho / pi * mean(L * up(c) * w, -1)", 0.375, "mean-for-sum"),
        # One quantity for another
        ("lamp_irradiance", "i + 0 * t", 0, "intensity-for-irradiance"),
        ("cone_irradiance", "L + 0 * a", 0, "radiance-for-irradiance"),
        ("cone_irradiance", "pi * L + 0 * a", 0.375, "cone-forgotten"),
        ("patch_irradiance", "L + 0 * d", 0, "radiance-for-irradiance"),
        ("patch_irradiance", "L * A * up(cos(u))", 0, "intensity-for-irradiance"),
        ("reflected_radiance", "sum(L * up(c) * w, -1)", 0, "irradiance-for-radiance"),
        ("luminance", "683 / pi * trapezoid(m, w, axis=-1)", 0, "efficiency-forgotten"),
        ("luminance", "683 / pi * sum(m * v, -1)", 0, "step-forgotten"),
        # Programming
        ("triangle_solid_angle", "2 * arctan2(over(a, b, c), below(a, b, c))", 0.75, "sign-of-winding"),
        ("spot_flux", "2 * pi * n * (1 - cos(a) ** (i + 1)) / (i + 1)", 0, "arguments-swapped"),
        ("isotropic_irradiance", "floor(f / (4 * pi * d**2)).astype(int)", 0, "truncated-to-integer"),
        ("isotropic_irradiance", "sort(f / (4 * pi * d**2))", 0, "sorted"),
        ("isotropic_irradiance", "cumsum(f / (4 * pi * d**2))", 0, "running-sum"),
        ("isotropic_irradiance", "4 * pi * d**2 / f", 0, "reciprocal"),
        ("spot_flux", "sqrt(2 * pi * i * (1 - cos(a) ** (n + 1)) / (n + 1))", 0, "square-root"),
        (
            "light_irradiance",
            "i * up(dot(unit(p - l), unit(n))) / size(l - p) ** 2",
            0.375,
            "arguments-swapped",
        ),
        ("light_irradiance", "i * up(dot(unit(l - p), n)) / size(l - p) ** 2", 0.75, "normal-not-normalised"),
        ("light_irradiance", "i * up(dot(unit(l), unit(n))) / size(l) ** 2", 0, "position-for-direction"),
        ("light_irradiance", "up(dot(unit(l - p), unit(n))) / size(l - p) ** 2", 0, "argument-ignored"),
        ("lamp_irradiance", "where(t < 90, i / d, 0)", 0, "cosine-forgotten + distance-not-squared"),
        ("spot_flux", "3 + 0 * i", 0, "constant-answer"),
        ("lamp_irradiance", "where(t < 90, i * sin(radians(90 - t)) / d**2, 0 / (0 * d))", 0, "not-finite"),
    )
]


def submissions() -> list[list[Planted]]:
    """Return the planted mistakes in as few submissions as hold each question once."""
    left, found = list(PLANTED), []
    while left:
        found.append(list({each.question: each for each in reversed(left)}.values()))
        left = [each for each in left if each not in found[-1]]
    return found


@pytest.mark.parametrize("planted", submissions())
def test_planted_mistakes_earn_what_they_are_worth_and_are_named(
    planted: list[Planted], tmp_path: Path
) -> None:
    functions = [
        f"def {each.question}({ARGUMENTS[each.question]}):\n    return {each.code}\n" for each in planted
    ]
    found = graded(PRELUDE + "\n" + "\n".join(functions), tmp_path)
    got = [
        Planted(each.question, each.code, found[each.question].score, found[each.question].diagnosis)
        for each in planted
    ]
    assert got == planted
    for each in planted:
        for part in found[each.question].parts:
            assert part.visibility == "visible" or "right is" not in part.text


def test_planted_mistakes_cover_the_catalogue_and_every_question() -> None:
    assert {each.question for each in PLANTED} == set(NAMES)
    named = {each.diagnosis for each in PLANTED}
    assert len(named & {entry.name for entry in CATALOGUE}) >= 35
    for question in ASSIGNMENT.questions:
        assert sum(each.question == question.name for each in PLANTED) >= 5


@dataclass
class Answers:
    """A function that gives what a formula of the inputs says."""

    name: str
    formula: Callable[..., Any]

    def call(self, *arrays: Array, mode: Mode = "batch", outputs: int = 1, seed: int | None = None) -> Result:
        if mode != "batch":
            return Result(error="takes arrays")
        with np.errstate(all="ignore"):
            return Result(values=(np.asarray(self.formula(*arrays), dtype=float),))

    def bsdf(self, parameters: Mapping[str, Any] | None = None) -> BSDF:
        raise NotImplementedError

    def other(self, name: str) -> Answers:
        raise NotImplementedError


@pytest.mark.parametrize("question", ASSIGNMENT.questions, ids=NAMES)
def test_every_variant_and_hint_is_found_in_both_languages(question: Question, seed: int) -> None:
    judge = judge_of(question, "ordinary")
    constants = {entry.name: entry for entry in CATALOGUE if entry.kind == "constant"}
    formulas: dict[str, Callable[..., Any]] = {}
    for name, variant in judge.variants.items():
        if name not in FOR_HARD_INPUTS:
            formulas[name] = lambda *a, f=variant: f(**dict(zip(question.parameters, a, strict=True)))
    for name in set(question.hints) & set(constants):
        formulas[name] = lambda *a, n=name: FACTORS[n] * np.asarray(judge.reference(*a))
    for name in sorted(formulas):
        for language in LANGUAGES:
            found = judge.judge(
                Answers(question.name, formulas[name]),
                np.random.default_rng(seed),
                language=language,
                hints=question.hints,
                shown=True,
            )
            assert found.diagnosis == name
            assert found.confidence > 0.6
            hint = question.hints.get(name, {}).get(language, "")
            assert hint in found.text
            assert found.share == judge.credit.get(name, 0.0)


FACTORS = {
    "doubled": 2,
    "halved": 0.5,
    "four-too-many": 4,
    "four-pi-too-many": 4 * np.pi,
    "two-pi-too-few": 0.5 / np.pi,
    "pi-too-many": np.pi,
    "pi-too-few": 1 / np.pi,
    "square-centimetres": 1e4,
    "watts-for-lumens": 1 / 683,
}


def test_what_cannot_be_loaded_or_is_not_there_is_told(tmp_path: Path) -> None:
    text = SOLUTION.read_text(encoding="utf-8").replace("def spot_flux(", "def spotflux(")
    found = grade("radiometry", _saved(tmp_path, text), language="ru")
    assert found.score == 18
    assert "spotflux" in found["spot_flux"].explanation


def _saved(folder: Path, text: str) -> Path:
    path = folder / "answers.py"
    path.write_text(text, encoding="utf-8")
    return path
