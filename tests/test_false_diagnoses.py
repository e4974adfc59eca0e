"""False diagnoses: what is said of plausible slips is true of them, and names no cause that is not there."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading import Finding, load_assignment, student_rng
from radiokit.faces.grading.handout.here import Here
from radiokit.faces.grading.judges.evidence import guesses


def found(work: str, part: str, code: str, language: str = "en") -> Finding:
    """Judge a part of a question of its function, ``name(arguments): code`` being the only line of it."""
    names: dict[str, Any] = {"np": np, "math": math}
    exec(f"def {code}", names)
    assignment = load_assignment(work)
    question = assignment.question(code.split("(")[0])
    asked = next(each for each in question.parts if each.name == part)
    return asked.judge.judge(
        Here(names[question.name], question.name, names),
        student_rng(assignment, question, asked, student="slips"),
        language=language,
        hints=question.hints,
        shown=asked.visibility == "visible",
    )


FURNACE = "furnace(a, n, seed): c = np.random.default_rng(seed).random(n); w ="
MEAN = "; return w.mean(), w.std() / np.sqrt(n)"
LOBE = "lobe_sample(u, n): p = 2 * np.pi * u[:, 1]; z ="
AROUND = "; r = np.sqrt(1 - z * z); return np.stack([r * np.cos(p), r * np.sin(p), z], -1)"
BLINN = (
    "blinn_phong(wi, wo, n): h = wi + wo; c = h[..., 2] / np.linalg.norm(h, axis=-1); s = (n + 2) * (n + 4)"
)

SLIPS = {
    "numbers 600 decades apart fit no root, no order": (
        ("radiometry", "hard", "isotropic_irradiance(f, d): return f / (4 * np.pi * d**2 + 1e-3)"),
        "",
        "wrong at",
    ),
    "twice for squared": (
        ("radiometry", "ordinary", "isotropic_irradiance(f, d): return f / (4 * np.pi * d * 2)"),
        "distance-doubled",
        "it is d**2, not d*2. ",
    ),
    "twice for squared, multiplied": (
        ("radiometry", "ordinary", "isotropic_irradiance(f, d): return f / (4 * np.pi) / d * 2"),
        "distance-doubled",
        "it is d**2, not d*2. ",
    ),
    "one factor of 8 is not two mistakes": (
        ("brdfs", "ordinary", f"{BLINN}; return s / (np.pi * (2.0 ** (-n / 2) + n)) * c**n"),
        "",
        "8 times the reference",
    ),
    "no sine in a lamp": (
        (
            "radiometry",
            "ordinary",
            "lamp_irradiance(i, d, t): return i * np.maximum(0, 1 / np.tan(t / 57.29577951308232)) / d**2",
        ),
        "sine-forgotten",
        "cotangent",
    ),
    "one angle twice": (
        (
            "radiometry",
            "ordinary",
            "patch_irradiance(L, A, d, t, u): return L * A * np.maximum(0, np.cos(t)) ** 2 / d**2",
        ),
        "theta-twice",
        "the other angle",
    ),
    "one end of a step": (
        (
            "radiometry",
            "ordinary",
            "luminance(w, m, v): return 683 / np.pi * np.sum((m * v)[..., :-1] * np.diff(w), -1)",
        ),
        "one-end",
        "mean of both ends",
    ),
    "the last step": (
        (
            "radiometry",
            "ordinary",
            "luminance(w, m, v): return 683 / np.pi * np.trapezoid((m * v)[..., :-1], w[..., :-1])",
        ),
        "last-step-forgotten",
        "left out the last step",
    ),
    "a missing bracket": (
        ("radiometry", "ordinary", "isotropic_irradiance(f, d): return f / 4 * np.pi / d**2"),
        "pi-multiplied",
        "x / (2 * π)",
    ),
    "arrays mixed, and the horizon": (
        (
            "brdfs",
            "hard",
            "half_cosine(wi, wo): h = wi + wo; return h[..., 2] / (np.linalg.norm(h) + 1e-300)",
        ),
        "horizon-not-clamped",
        "wi or wo is not above the horizon",
    ),
    "division //": (
        ("brdfs", "ordinary", "lambert(wi, wo, rho): return rho // np.pi * (wi[..., 2] > 0)"),
        "constant-answer",
        "look for // in place of /",
    ),
    "no horizon": (
        ("brdfs", "hard", "lambert(wi, wo, rho): return rho / np.pi * (wi[..., 2] > 0)"),
        "horizon-not-clamped",
        "wi or wo is not above the horizon",
    ),
    "^": (
        ("radiometry", "ordinary", "cone_solid_angle(a): return 4 * np.pi * np.sin(a / 2)^2"),
        "",
        "x**2",
    ),
    "a few tiny answers are not the same": (
        ("radiometry", "hard", "reflected_radiance(r, L, c, w): return r * 1e-16 / L[..., 0]"),
        "",
        "wrong at",
    ),
    "a power of the distance in a weight": (
        ("shading", "ordinary", "mis_weight(d, c, A, p): return d / (d**2 + A * c * p)"),
        "distance-cubed",
        "p_ω = p_A d²/cos θ'",
    ),
    "a formula keeps its letters": (
        ("shading", "ordinary", "mis_weight(d, c, A, p): return d**2 / (d**2 + A / c * p)"),
        "cosine-multiplied",
        "p = p_A d²",
    ),
    "the density of the sphere": (
        ("shading", "unbiased", f"{FURNACE} 4 * a * c{MEAN}"),
        "cosine-forgotten",
        "one of these: ",
    ),
    "a uniform angle": (
        ("shading", "unbiased", f"{FURNACE} 2 * a * np.cos(c * np.pi / 2){MEAN}"),
        "angle-uniform",
        "it is cos θ that is uniform",
    ),
    "the density multiplied": (
        ("shading", "unbiased", f"{FURNACE} a * c / 2 / np.pi**2{MEAN}"),
        "pdf-multiplied",
        "perhaps: you multiplied",
    ),
    "values that are cut off to 0": (
        ("shading", "unbiased", f"{FURNACE} 2 * a * (c // 1){MEAN}"),
        "constant-answer",
        "look for // in place of /",
    ),
    "a small error is not 0": (
        ("shading", "honest", f"{FURNACE} 2 * a * c; return w.mean(), w.std() / n**2"),
        "error-too-small",
        "too small",
    ),
    "error and value exchanged": (
        ("shading", "unbiased", f"{FURNACE} 2 * a * c; return w.std() / np.sqrt(n), w.mean()"),
        "error-first",
        "the standard error first",
    ),
    "numbers that are used": (
        ("shading", "distribution", f"{LOBE} u[:, 0] ** (n + 1){AROUND}"),
        "part-only",
        "look at the range of θ",
    ),
    "a range of θ": (
        ("shading", "distribution", f"{LOBE} u[:, 0] / (n + 1){AROUND}"),
        "part-only",
        "look at the range of θ",
    ),
    "a range of φ": (
        ("shading", "distribution", f"{LOBE} u[:, 0] ** (1 / (n + 1)); p = p / 2{AROUND}"),
        "quarter-only",
        "azimuth",
    ),
}


@pytest.mark.parametrize("slip", SLIPS)
@pytest.mark.parametrize("language", ["en", "ru"])
def test_what_is_said_of_a_slip_is_true_of_it(slip: str, language: str) -> None:
    asked, diagnosis, words = SLIPS[slip]
    told = found(*asked, language=language)
    assert told.share < 1
    assert told.diagnosis == diagnosis, told.text
    if language == "en":
        assert words.lower() in told.text.lower()
    else:
        assert sum("а" <= letter <= "я" for letter in told.text) > 8
    assert not (
        set(rk.list_misconceptions()) & {*told.text.lower().replace(".", " ").split()} - {"doubled", "halved"}
    )


def test_two_slips_at_once_are_said_in_words() -> None:
    told = found("shading", "unbiased", f"{FURNACE} a * 0.8 / np.pi**2 * c{MEAN}")
    assert " + " not in told.diagnosis or "fit two mistakes" in told.text
    assert guesses(["this"], "ru") == "возможно: this"


NOTEBOOK = """
{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": [
  {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": null, "id": "a", "source":
    "if __name__ == '__main__':\\n    def cone_irradiance(L, a):\\n        return 3.141592653589793 * L"},
  {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": null, "id": "b", "source":
    "def conical_solid_angle(a):\\n    pass"},
  {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": null, "id": "c", "source": "1 / 0"}
]}
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a sandbox needs a POSIX system")
def test_a_notebook_is_the_main_module_and_its_names_are_not_taken_for_others(tmp_path: Path) -> None:
    file = tmp_path / "theirs.ipynb"
    file.write_text(NOTEBOOK, encoding="utf-8")
    asked = ["cone_irradiance", "cone_solid_angle", "patch_irradiance"]
    graded = rk.grading.grade("radiometry", file, language="ru", questions=asked)
    solid_angle, irradiance, patch = (question.parts[0].text for question in graded.questions)
    assert irradiance.startswith("πL даёт вся полусфера")
    assert "может быть, это conical_solid_angle?" in solid_angle
    assert "может быть" not in patch  # cone_irradiance answers another question
    assert graded.problems == ("ячейка 3, строка 1: ошибка ZeroDivisionError: division by zero",)
