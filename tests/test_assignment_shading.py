"""Assignment 3: the solution earns all points in any style, and each slip costs and is told its own."""

from __future__ import annotations

import importlib.util
import json
import math
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading.assignment import student_rng
from radiokit.faces.grading.words import checked_language

ASSIGNMENT = rk.grading.load_assignment("shading")
FILE = Path(__file__).parents[1] / "lectures" / "solutions" / "shading.py"

Function = Callable[..., Any]


def _solution() -> ModuleType:
    spec = importlib.util.spec_from_file_location("solution_of_shading", FILE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


SOLUTION = _solution()


def _graded(
    functions: dict[str, Function], name: str, local_callee: Any, language: str = "en"
) -> dict[str, Any]:
    """Return points, diagnosis and text of each part of a question, answered by these and the solution."""
    question = ASSIGNMENT.question(checked_language(language) and name)
    callee = local_callee({**vars(SOLUTION), **functions}[name], {**vars(SOLUTION), **functions})
    found = {}
    for part in question.parts:
        finding = part.judge.judge(
            callee,
            student_rng(ASSIGNMENT, question, part, student="planted"),
            language=language,
            hints=question.hints,
            shown=True,
        )
        points = question.worth(part) * finding.share
        found[part.name] = (round(points, 6), finding.diagnosis, finding.text)
    return found


def test_it_is_worth_twenty_points_in_two_languages() -> None:
    assert ASSIGNMENT.points == 20
    assert len(ASSIGNMENT.questions) == 8
    for question in ASSIGNMENT.questions:
        for language in ("en", "ru"):
            assert question.text[language].count("$") % 2 == 0
            assert all(name in question.text[language] for name in question.parameters)
        # A formula is the same in both languages but for the words in it.
        english, russian = (question.text[language].count("$$") for language in ("en", "ru"))
        assert english == russian


@pytest.mark.skipif(sys.platform == "win32", reason="a sandbox needs a POSIX system")
@pytest.mark.parametrize("language", ["en", "ru"])
def test_the_solution_is_right(language: str) -> None:
    grade = rk.grading.grade(ASSIGNMENT, FILE, student="a student", language=language)
    assert grade.score == 20, str(grade)
    assert not any(question.review or question.diagnosis for question in grade.questions)


STYLES = """
import math, random
import numpy as np

def direct_light(f, positions, intensities):  # one point, a loop
    total = 0.0
    for k in range(len(f)):
        x, y, z = positions[k]
        d = math.sqrt(x * x + y * y + z * z)
        total += f[k] * intensities[k] * max(0.0, z / d) / d**2
    return total

def sphere_irradiance(theta, half_angle):  # loops over angles
    n, m, total = 40, 80, 0.0
    for i in range(n):
        a = (i + 0.5) * half_angle / n
        for j in range(m):
            phi = (j + 0.5) * 2 * math.pi / m
            c = math.cos(theta) * math.cos(a) + math.sin(theta) * math.sin(a) * math.cos(phi)
            total += max(c, 0.0) * math.sin(a) * half_angle / n * 2 * math.pi / m
    return total

def furnace(albedo, samples, seed):  # Python's generator, a running sum, a list
    rng, total, square = random.Random(seed), 0.0, 0.0
    for _ in range(samples):
        w = albedo / math.pi * rng.random() * 2 * math.pi
        total, square = total + w, square + w * w
    mean = total / samples
    return [mean, math.sqrt((square / samples - mean * mean) / samples)]

def cosine_sample(u):  # one direction, a list
    r, phi = math.sqrt(u[0]), 2 * math.pi * u[1]
    return [r * math.cos(phi), r * math.sin(phi), math.sqrt(1 - u[0])]

def cosine_pdf(direction):
    return direction[2] / math.pi if direction[2] > 0 else 0

def lobe_sample(u, exponent):  # float32
    u = u.astype(np.float32)
    c = u[:, 0] ** np.float32(1 / (exponent + 1))
    s, phi = np.sqrt(1 - c * c), np.float32(2 * np.pi) * u[:, 1]
    return np.stack([s * np.cos(phi), s * np.sin(phi), c], 1)

def lobe_pdf(directions, exponent):  # a list of lists, from float32
    return [[(exponent + 1) / (2 * math.pi) * max(d[2], 0) ** exponent] for d in np.float32(directions)]

def glossy(exponent, zenith, side, samples, seed):  # another density than the solution's, the old generator
    np.random.seed(seed)
    u = np.random.rand(2, samples)
    c = u[0] ** (1 / (exponent + 2))
    w = zenith * c + side * (1 + np.sqrt(1 - c * c) * np.cos(2 * np.pi * u[1]))
    return np.float32(w.mean()), np.float32(w.std() / samples**0.5)

def window(distance, width, height, samples, seed):
    rng, w = random.Random(seed), []
    for _ in range(samples):
        y, z = rng.uniform(-width / 2, width / 2), rng.uniform(0, height)
        w.append(width * height * z * distance / (distance**2 + y**2 + z**2) ** 2)
    return np.mean(w), np.std(w, ddof=1) / math.sqrt(samples)

def mis_weight(distance, cosine_light, area, pdf):  # numbers
    if cosine_light == 0 or pdf == 0:
        return 1
    p = distance**2 / (area * cosine_light)
    return p / (p + pdf)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a sandbox needs a POSIX system")
def test_no_style_is_punished(tmp_path: Path) -> None:
    file = tmp_path / "styles.py"
    file.write_text(STYLES, encoding="utf-8")
    grade = rk.grading.grade(ASSIGNMENT, file, student="another")
    assert grade.score == 20, str(grade)


def _weights(f: Function) -> Function:
    """Return an estimator of the furnace from ``f(albedo, cosines)``."""

    def furnace(albedo: float, samples: int, seed: int) -> Any:
        weights = f(albedo, np.random.default_rng(seed).random(samples))
        return weights.mean(), weights.std(ddof=1) / math.sqrt(samples)

    return furnace


def _furnace_with(error: Function) -> Function:
    def furnace(albedo: float, samples: int, seed: int) -> Any:
        weights = 2 * albedo * np.random.default_rng(seed).random(samples)
        return weights.mean(), error(weights)

    return furnace


def _furnace_sum(albedo: float, samples: int, seed: int) -> Any:
    value, error = SOLUTION.furnace(albedo, samples, seed)
    return samples * value, samples * error


def _one_sample(albedo: float, samples: int, seed: int) -> Any:
    weights = np.full(samples, 2 * albedo * np.random.default_rng(seed).random())
    return weights.mean(), weights.std() / math.sqrt(samples)


def _window_with(kernel: Function) -> Function:
    """Return an estimator of the window from ``kernel(x, z, d, area)``."""

    def window(distance: float, width: float, height: float, samples: int, seed: int) -> Any:
        u = np.random.default_rng(seed).random((samples, 2))
        y, z = (u[:, 0] - 0.5) * width, u[:, 1] * height
        weights = kernel(distance, z, np.sqrt(distance**2 + y**2 + z**2), width * height)
        return weights.mean(), weights.std(ddof=1) / math.sqrt(samples)

    return window


def _glossy_from(power: float, pdf: Function) -> Function:
    """Return an estimator that samples cosᵐ, m = n ``power``, and divides by ``pdf(cosine, m)``."""

    def glossy(n: float, zenith: float, side: float, samples: int, seed: int) -> Any:
        u, m = np.random.default_rng(seed).random((samples, 2)), power * n
        w = SOLUTION.lobe_sample(u, m)
        f = (n + 2) / (2 * np.pi) * w[:, 2] ** n
        weights = f * (zenith * w[:, 2] + side * (1 + w[:, 0])) * w[:, 2] / pdf(w[:, 2], m)
        return weights.mean(), weights.std(ddof=1) / math.sqrt(samples)

    return glossy


def _more(name: str, factor: int) -> Function:
    """Return the solution's estimator with so many times the samples that it is asked for."""

    def estimate(*given: Any) -> Any:
        *inputs, samples, seed = given
        return getattr(SOLUTION, name)(*inputs, factor * samples, seed)

    return estimate


def _known(name: str, made_up: bool = False) -> Function:
    """Return the exact value with noise: with one number of the right size, or the mean of N of them."""
    exact: Any = vars(ASSIGNMENT.question(name).parts[0].judge)["reference"]

    def estimate(*given: Any) -> Any:
        *inputs, samples, seed = given
        value, rng = float(exact(*inputs)), np.random.default_rng(seed)
        if made_up:
            drawn = rng.normal(value, 0.5 * value, samples)
            return drawn.mean(), drawn.std(ddof=1) / math.sqrt(samples)
        error = 0.5 * value / math.sqrt(samples)
        return rng.normal(value, error), error

    return estimate


def _lobe(cosine: Any, m: Any) -> Any:
    return (m + 1) / (2 * np.pi) * cosine**m


def _direct(f: Any, p: Any, intensities: Any, clamp: Function, power: float = 2.0) -> Any:
    d = np.linalg.norm(p, axis=-1)
    return np.sum(f * intensities * clamp(p[..., 2] / d) / d**power, axis=-1)


def _above(cosine: Any) -> Any:
    return np.maximum(cosine, 0)


around = SOLUTION._around
uniformly = _glossy_from(0.0, _lobe)
FULL = {
    question.name: {p.name: question.worth(p) for p in question.parts} for question in ASSIGNMENT.questions
}

# What is handed in, and for each part that is not right its diagnosis and the share that it earns.
PLANTED: dict[str, tuple[dict[str, Function], dict[str, tuple[str, float]]]] = {
    "missing clamp": (
        {"direct_light": lambda f, p, i: _direct(f, p, i, lambda c: c)},
        {"hard": ("horizon-not-clamped", 0)},
    ),
    "absolute cosine": (
        {"direct_light": lambda f, p, i: _direct(f, p, i, np.abs)},
        {"hard": ("cosine-absolute", 0)},
    ),
    "cosine forgotten": (
        {"direct_light": lambda f, p, i: _direct(f, p, i, lambda c: (c > 0) * 1.0)},
        {"ordinary": ("cosine-forgotten", 0), "hard": ("cosine-forgotten", 0)},
    ),
    "distance not squared": (
        {"direct_light": lambda f, p, i: _direct(f, p, i, _above, 1.0)},
        {"ordinary": ("distance-not-squared", 0), "hard": ("distance-not-squared", 0)},
    ),
    "distance forgotten": (
        {"direct_light": lambda f, p, i: _direct(f, p, i, _above, 0.0)},
        {"ordinary": ("distance-forgotten", 0), "hard": ("distance-forgotten", 0)},
    ),
    "BRDF forgotten": (
        {"direct_light": lambda f, p, i: _direct(1.0, p, i, _above)},
        {"ordinary": ("brdf-forgotten", 0), "hard": ("brdf-forgotten", 0)},
    ),
    "mean of lights": (
        {"direct_light": lambda f, p, i: _direct(f, p, i, _above) / f.shape[-1]},
        {"ordinary": ("mean-of-lights", 0), "hard": ("mean-of-lights", 0)},
    ),
    "solid angle alone": (
        {"sphere_irradiance": lambda t, a: 2 * np.pi * (1 - np.cos(a)) + 0 * t},
        {"ordinary": ("cosine-forgotten", 0), "hard": ("cosine-forgotten", 0)},
    ),
    "small light": (
        {"sphere_irradiance": lambda t, a: 2 * np.pi * (1 - np.cos(a)) * np.maximum(np.cos(t), 0)},
        {"ordinary": ("small-light", 0), "hard": ("small-light", 0)},
    ),
    "clamp outside the integral": (
        {"sphere_irradiance": lambda t, a: np.pi * np.sin(a) ** 2 * np.maximum(np.cos(t), 0)},
        {"hard": ("whole-or-nothing", 0)},
    ),
    "sine of the rings forgotten": (
        {"sphere_irradiance": lambda t, a: 2 * np.pi * np.sin(a) * np.maximum(np.cos(t), 0)},
        {"ordinary": ("sine-forgotten", 0), "hard": ("sine-forgotten", 0)},
    ),
    "1/N forgotten": ({"furnace": _furnace_sum}, {"unbiased": ("sum-for-mean", 0)}),
    "pdf forgotten": (
        {"furnace": _weights(lambda a, c: a / np.pi * c)},
        {"unbiased": ("two-pi-too-few", 0)},
    ),
    "cosine of the furnace forgotten": (
        {"furnace": lambda a, n, s: (2 * a, 0.0)},
        {"unbiased": ("cosine-forgotten", 0)},
    ),
    "cosine twice": (
        {"furnace": _weights(lambda a, c: 2 * a * c * c)},
        {"unbiased": ("cosine-twice", 0)},
    ),
    "σ for σ/√N": ({"furnace": _furnace_with(np.std)}, {"honest": ("deviation-for-error", 0)}),
    "seed ignored": (
        {"furnace": lambda a, n, s: SOLUTION.furnace(a, n, 42)},
        {"unbiased": ("seed-reused", 0), "honest": ("seed-reused", 0)},
    ),
    "seed reused for each sample": (
        {"furnace": _one_sample},
        {"unbiased": ("sample-repeated", 0), "honest": ("sample-repeated", 0)},
    ),
    "samples ignored": (
        {"furnace": lambda a, n, s: SOLUTION.furnace(a, 1000, s)},
        {"unbiased": ("samples-ignored", 0)},
    ),
    "uniform, called cosine-weighted": (
        {"cosine_sample": lambda u: around(u[:, 0], u[:, 1])},
        {"distribution": ("uniform-instead", 0)},
    ),
    "root forgotten": (
        {"cosine_sample": lambda u: around(np.sqrt(1 - u[:, 0] ** 2), u[:, 1])},
        {"distribution": ("root-forgotten", 0)},
    ),
    "θ uniform": (
        {"cosine_sample": lambda u: around(np.cos(np.pi / 2 * u[:, 0]), u[:, 1])},
        {"distribution": ("angle-uniform", 0)},
    ),
    "a quarter of the hemisphere": (
        {"cosine_sample": lambda u: around(np.sqrt(u[:, 0]), u[:, 1] / 4)},
        {"distribution": ("quarter-only", 0)},
    ),
    "pdf not normalised": (
        {"cosine_pdf": lambda w: np.maximum(w[:, 2], 0)},
        {"normalisation": ("pdf-not-normalised", 0)},
    ),
    "root of the lobe": (
        {"lobe_sample": lambda u, n: around(u[:, 0] ** (1 / n), u[:, 1])},
        {"distribution": ("exponent-without-sine", 0)},
    ),
    "Phong's BRDF for the density": (
        {"lobe_pdf": lambda w, n: (n + 2) / (2 * np.pi) * np.maximum(w[:, 2], 0) ** n},
        {"normalisation": ("lobe-normalisation", 0)},
    ),
    "lobe not clamped": (
        {"lobe_pdf": lambda w, n: _lobe(np.abs(w[:, 2]), n)},
        {"normalisation": ("horizon-not-clamped", 0.5)},
    ),
    "uniform directions": (
        {"glossy": _glossy_from(0.0, _lobe)},
        {"efficiency": ("inefficient", 0)},
    ),
    "cosine-weighted directions": (
        {"glossy": _glossy_from(1.0 / 30, _lobe)},
        {"efficiency": ("inefficient", 0)},
    ),
    "(n+2) for (n+1)": (
        {"glossy": _glossy_from(1.0, lambda c, m: _lobe(c, m) * (m + 2) / (m + 1))},
        {"unbiased": ("lobe-normalisation", 0), "efficiency": ("lobe-normalisation", 0)},
    ),
    "the exact value of a glossy surface": (
        {"glossy": lambda n, zenith, side, samples, seed: (zenith * (n + 2) / (n + 3) + side, 0.0)},
        dict.fromkeys(("unbiased", "honest", "efficiency"), ("not-sampled", 0)),
    ),
    "the furnace, ten times the samples": (
        {"furnace": _more("furnace", 10)},
        {"unbiased": ("too-many-samples", 0)},
    ),
    "a glossy surface, twice the samples": (
        {"glossy": _more("glossy", 2)},
        {"unbiased": ("too-many-samples", 0), "efficiency": ("too-many-samples", 0)},
    ),
    "uniform directions, twenty times as many": (
        {"glossy": lambda n, zenith, side, samples, seed: uniformly(n, zenith, side, 20 * samples, seed)},
        {"unbiased": ("too-many-samples", 0), "efficiency": ("too-many-samples", 0)},
    ),
    "the furnace's value with noise": (
        {"furnace": _known("furnace")},
        dict.fromkeys(("unbiased", "honest"), ("noise-invented", 0)),
    ),
    "the exact value of a glossy surface with noise": (
        {"glossy": _known("glossy")},
        dict.fromkeys(("unbiased", "honest", "efficiency"), ("noise-invented", 0)),
    ),
    "the exact value of a window as the mean of made-up samples": (
        {"window": _known("window", made_up=True)},
        dict.fromkeys(("unbiased", "honest"), ("noise-invented", 0)),
    ),
    "pdf of area": (
        {"window": _window_with(lambda x, z, d, area: area * z / d)},
        {"unbiased": ("pdf-of-area", 0)},
    ),
    "light's cosine forgotten": (
        {"window": _window_with(lambda x, z, d, area: area * z / d**3)},
        {"unbiased": ("light-cosine-forgotten", 0)},
    ),
    "cosine at the floor forgotten": (
        {"window": _window_with(lambda x, z, d, area: area * x / d**3)},
        {"unbiased": ("cosine-forgotten", 0)},
    ),
    "area forgotten": (
        {"window": _window_with(lambda x, z, d, area: x * z / d**4)},
        {"unbiased": ("pdf-forgotten", 0)},
    ),
    "weight per area": (
        {"mis_weight": lambda d, c, a, p: (1 / a) / (1 / a + p)},
        {"ordinary": ("pdf-of-area", 0), "hard": ("pdf-of-area", 0)},
    ),
    "weight of the other": (
        {"mis_weight": lambda d, c, a, p: a * c * p / (d**2 + a * c * p)},
        {"ordinary": ("one-minus", 0), "hard": ("one-minus", 0)},
    ),
    "NaN at the light's rim": (
        {"mis_weight": lambda d, c, a, p: (d**2 / (a * c)) / (d**2 / (a * c) + p)},
        {"hard": ("not-finite", 0)},
    ),
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # some slips divide by 0, and run in this process
@pytest.mark.parametrize("name", PLANTED)
def test_a_slip_costs_its_points_and_is_told(name: str, local_callee: Any) -> None:
    functions, wrong = PLANTED[name]
    asked = {"cosine_pdf": "cosine_sample", "lobe_pdf": "lobe_sample"}
    question = next(asked.get(each, each) for each in functions)
    language = "ru" if list(PLANTED).index(name) % 2 else "en"
    found = _graded(functions, question, local_callee, language)
    for part, worth in FULL[question].items():
        diagnosis, share = wrong.get(part, ("", 1))
        points, seen, text = found[part]
        assert (seen, points) == (diagnosis, pytest.approx(share * worth)), (part, text)
        assert part not in wrong or (sum("а" <= letter <= "я" for letter in text) > 8) == (language == "ru")


PRETENDING = """
import numpy as np

def window(distance, width, height, samples, seed):
    y, z = np.random.default_rng(seed).random((2, 10 * samples))
    y, z = (y - 0.5) * width, z * height
    w = width * height * z * distance / (distance**2 + y**2 + z**2) ** 2
    return w.mean(), w.std() / np.sqrt(len(w))

def furnace(albedo, samples, seed):
    error = 0.577 * albedo / np.sqrt(samples)
    return np.random.default_rng(seed).normal(albedo, error), error
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a sandbox needs a POSIX system")
def test_what_only_pretends_to_sample_is_found_in_a_sandbox(tmp_path: Path) -> None:
    file = tmp_path / "pretending.py"
    file.write_text(PRETENDING, encoding="utf-8")
    first, second = (
        rk.grading.grade(ASSIGNMENT, file, student="fourth", questions=["furnace", "window"])
        for _ in range(2)
    )
    assert json.dumps(first.to_json()) == json.dumps(second.to_json())
    found = {question.name: (question.score, question.diagnosis) for question in first.questions}
    assert found["furnace"] == (0, "noise-invented")
    assert found["window"] == (1, "too-many-samples")


BAD = """
import numpy as np

def direct_light(f, positions, intensities):
    d = np.linalg.norm(positions, axis=-1)
    return np.sum(f * intensities * positions[..., 2] / d**3, axis=-1)

def sphere_irradiance(theta, half_angle):
    return np.pi * np.sin(half_angle) ** 2 * np.maximum(np.cos(theta), 0)

def furnace(albedo, samples, seed):
    w = 2 * albedo * np.random.rand(samples)
    return w.mean(), w.std()

def cosine_sample(u):
    z = u[:, 0]
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(2 * np.pi * u[:, 1]), r * np.sin(2 * np.pi * u[:, 1]), z], axis=-1)

def lobe_sample(u, exponent):
    return u

def glossy(exponent, zenith, side, samples, seed):
    return zenith

def window(distance, width, height, samples, seed):
    while True:
        pass
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a sandbox needs a POSIX system")
def test_a_bad_submission_gets_the_same_grade_twice(tmp_path: Path) -> None:
    file = tmp_path / "bad.py"
    file.write_text(BAD.replace("while True:\n        pass", "raise SystemExit"), encoding="utf-8")
    first, second = (rk.grading.grade(ASSIGNMENT, file, student="third", language="ru") for _ in range(2))
    assert json.dumps(first.to_json()) == json.dumps(second.to_json())
    diagnoses = {question.name: question.diagnosis for question in first.questions}
    assert diagnoses == {
        "direct_light": "horizon-not-clamped",
        "sphere_irradiance": "whole-or-nothing",
        "furnace": "not-repeatable",
        "cosine_sample": "uniform-instead",
        "lobe_sample": "",
        "glossy": "",
        "window": "",
        "mis_weight": "",
    }
    assert first.score == 1.5 + 2
    assert not any(question.review for question in first.questions)
