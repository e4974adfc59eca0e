"""Assignment 2: its references are the library's models, its solution earns all, mistakes are named."""

from __future__ import annotations

import re
from pathlib import Path

import mpmath
import numpy as np
import pytest

from radiokit.bsdfs import Lambert, Phong
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import bsdf
from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.misconception import LANGUAGES
from radiokit.faces.grading import Laws, Sandbox, Values, grade, load_assignment, student_rng
from radiokit.faces.grading.grader import Isolated
from radiokit.faces.grading.isolation.result import Result
from radiokit.faces.grading.judges import laws
from radiokit.facts.directions import reflect

ASSIGNMENT = load_assignment("brdfs")
SOLUTION = Path(__file__).parents[1] / "lectures" / "solutions" / "brdfs.py"
NAMES = [question.name for question in ASSIGNMENT.questions]


def part_of(question, name):
    return next((part for part in question.parts if part.name == name), None)


def finding(callee, question, part, language="en", student=""):
    return part.judge.judge(
        callee,
        student_rng(ASSIGNMENT, question, part, student=student),
        language=language,
        hints=question.hints,
        shown=part.visibility == "visible",
    )


class Local:
    """A function of this process in the place of a student's."""

    def __init__(self, function):
        self.function, self.name = function, "f"

    def call(self, *arrays, mode="batch", outputs=1, seed=None):
        if mode != "batch":
            return Result(error="takes arrays")
        return Result(values=(np.asarray(self.function(*arrays)),))

    def bsdf(self, parameters=None):
        return as_bsdf(lambda wi, wo: self.function(wi, wo, **(parameters or {})), label="f")


# What is asked


def test_eight_questions_for_twenty_points():
    points = {question.name: question.points for question in ASSIGNMENT.questions}
    assert points == {
        "lambert": 2,
        "mirror_cosine": 2,
        "phong_original": 3,
        "phong": 3,
        "half_cosine": 2,
        "blinn_phong": 3,
        "asymmetry": 2,
        "mixed": 3,
    }
    assert ASSIGNMENT.points == 20
    for question in ASSIGNMENT.questions:
        seen = {part.name: part.visibility for part in question.parts}
        assert seen.pop("ordinary") == "visible"
        assert set(seen.values()) == {"after_published"}
        assert set(seen) <= {"hard", "laws"}


@pytest.mark.parametrize("question", ASSIGNMENT.questions, ids=NAMES)
def test_texts_and_hints_are_in_both_languages(question):
    for text in (question.text, question.title, ASSIGNMENT.intro, *question.hints.values()):
        assert not re.search("[а-яА-Я]", text["en"])
        assert re.search("[а-я]", text["ru"])
        assert text["en"].count("$") % 2 == text["ru"].count("$") % 2 == 0
        formulas = [
            {each.replace("ср", "sr") for each in re.findall(r"\$\$?[^$]+\$\$?", text[language])}
            for language in LANGUAGES
        ]
        assert formulas[0] == formulas[1]
    for name in question.parameters:
        assert all(f"`{name}`" in question.text[language] for language in LANGUAGES)
    variants = {name for each in ASSIGNMENT.questions for name in part_of(each, "hard").judge.variants}
    assert set(question.hints) <= variants | {entry.name for entry in CATALOGUE}


def test_references_are_the_models_of_the_library():
    def inputs(name, part="hard"):
        question = ASSIGNMENT.question(name)
        judge = part_of(question, part).judge
        assert isinstance(judge, Values)
        given = judge.inputs(student_rng(ASSIGNMENT, question, part_of(question, part)))
        return given, judge.reference(**given)

    rows = {
        "lambert": lambda reflectance: bsdf("lambert", reflectance=reflectance),
        "phong": lambda exponent: bsdf("phong", exponent=exponent),
        "phong_original": lambda **p: bsdf("phong_original", **p),
        "blinn_phong": lambda exponent: bsdf("blinn_phong", exponent=exponent),
        "mixed": part_of(ASSIGNMENT.question("mixed"), "laws").judge.reference,
    }
    for name, make in rows.items():
        for part in ("ordinary", "hard"):
            given, right = inputs(name, part)
            wi, wo = given.pop("wi"), given.pop("wo")
            for row in range(0, len(wi), 7):
                model = make(**{key: float(value[row]) for key, value in given.items()})
                assert right[row] == pytest.approx(model(wi[row], wo[row]), rel=1e-13)
            dark = (wi[:, 2] <= 0) | (wo[:, 2] <= 0)
            assert not right[dark].any()
            assert dark.any() == (part == "hard")
    given, right = inputs("mirror_cosine")
    cosine = np.sum(given["wi"] * reflect(given["wo"]), axis=1)
    assert right == pytest.approx(np.maximum(cosine, 0), rel=1e-15)
    assert (cosine < -0.1).any()
    given, right = inputs("half_cosine")
    h = given["wi"] + given["wo"]
    lit = (given["wi"][:, 2] > 0) & (given["wo"][:, 2] > 0)
    assert right[lit] == pytest.approx(h[lit, 2] / np.linalg.norm(h[lit], axis=1), rel=1e-9)
    assert not right[~lit].any()


def test_values_of_hard_pairs_agree_with_fifty_digits_far_beyond_what_is_asked():
    question = ASSIGNMENT.question("blinn_phong")
    judge = part_of(question, "hard").judge
    given = judge.inputs(student_rng(ASSIGNMENT, question, part_of(question, "hard")))
    right = judge.reference(**given)
    with mpmath.workdps(50):
        for row, (wi, wo, n) in enumerate(zip(given["wi"], given["wo"], given["exponent"], strict=True)):
            if wi[2] <= 0 or wo[2] <= 0:
                continue
            n = mpmath.mpf(float(n))
            h = [mpmath.mpf(float(a)) + mpmath.mpf(float(b)) for a, b in zip(wi, wo, strict=True)]
            cosine = h[2] / mpmath.sqrt(sum(each * each for each in h))
            constant = (n + 2) * (n + 4) / (8 * mpmath.pi * (2 ** (-n / 2) + n))
            assert right[row] == pytest.approx(float(constant * cosine**n), rel=judge.rtol / 100)


def test_a_mixture_is_never_more_than_the_whole():
    mixed = part_of(ASSIGNMENT.question("mixed"), "laws").judge.reference
    up = np.array([[0.0, 0.0, 1.0]])
    half = mixed(diffuse=0.2, specular=0.3, exponent=8.0).evaluate(up, up)
    whole = mixed(diffuse=0.8, specular=1.2, exponent=8.0).evaluate(up, up)
    assert half == pytest.approx(0.2 / np.pi + 0.3 * 10 / (2 * np.pi))
    assert whole == pytest.approx(0.4 / np.pi + 0.6 * 10 / (2 * np.pi))
    assert whole == pytest.approx((0.4 * Lambert() + 0.6 * Phong(exponent=8.0)).evaluate(up, up))


# The solution


@pytest.fixture
def coarse(monkeypatch):
    """Spare evaluations: what is planted here is gross."""
    monkeypatch.setattr(laws, "EVALUATIONS", (100_000, 1_000_000))


def test_the_solution_earns_all():
    earns_all("en")


def test_the_solution_earns_all_in_russian(coarse):
    earns_all("ru")


def earns_all(language):
    result = grade(ASSIGNMENT, SOLUTION, language=language, student="a" if language == "ru" else "")
    assert (result.score, result.points, result.complete) == (20.0, 20.0, True)
    assert not result.problems
    for question in result.questions:
        assert not question.review
        assert not question.diagnosis
    text = result["phong_original"].parts[2].text
    assert ("as it should, is not reciprocal" if language == "en" else "как и должна, нарушает") in text


def test_the_solution_is_plain():
    text = SOLUTION.read_text()
    assert "radiokit" not in text
    assert re.findall(r"^def (\w+)", text, re.M)[1:] == NAMES


# Planted mistakes: question, share of the ordinary, hard and law parts (None: not judged here), diagnosis

PLANTED = {
    "lambert_pi_forgotten": (0, 0, 2 / 3, "pi-too-many"),
    "lambert_with_cosine": (0, 0, 2 / 3, "cosine-twice"),
    "lambert_over_2pi": (0, 0, None, "halved"),
    "lambert_everywhere": (1, 0, 1, "horizon-not-clamped"),
    "lambert_black": (0, 0, 0, None),
    "mirror_cosine_at_surface": (0, 0, None, "mirror-about-wrong-axis"),
    "mirror_cosine_absolute": (0, 0, None, "horizon-not-clamped"),
    "mirror_cosine_unclamped": (0, 0, None, "horizon-not-clamped"),
    "mirror_cosine_degrees": (0, 0, None, "angle-in-degrees"),
    "phong_original_not_divided": (0, 0, 1 / 3, "cosine-twice"),
    "phong_original_swapped": (0, 0, None, "divided-by-viewer-cosine"),
    "phong_original_inf": (1, 0, None, "not-finite"),
    "phong_n_plus_1": (0, 0, None, "lobe-normalisation"),
    "phong_absolute": (0, 0, None, "horizon-not-clamped"),
    "phong_divided": (0, 0, 1 / 3, "cosine-forgotten"),
    "phong_two_more": (0, 0, None, "exponent-two-more"),
    "phong_below_horizon": (1, 0, None, "horizon-not-clamped"),
    "half_cosine_unnormalised": (0, 0, None, "half-vector-not-normalised"),
    "half_cosine_from_viewer": (0, 0, None, "half-from-viewer"),
    "half_cosine_nan": (1, 0, None, "not-finite"),
    "blinn_phong_as_phong": (0, 0, 2 / 3, "lobe-normalisation"),
    "blinn_phong_n_plus_8": (0, 0, 2 / 3, "lobe-normalisation"),
    "blinn_phong_unnormalised": (0, 0, None, "half-vector-not-normalised-in-lobe"),
    "blinn_phong_one_more": (0, 0, None, "exponent-one-more"),
    "blinn_phong_one_way": (0, 0, 2 / 3, "cosine-twice"),
    "blinn_phong_constant": (0, 0, 0, "constant-answer"),
    "asymmetry_signed": (0, 0, None, "sign-kept"),
    "asymmetry_of_mean": (0, 0, None, "relative-to-mean"),
    "asymmetry_nan": (1, 0, None, "not-finite"),
    "mixed_unlimited": (0, 0, 2 / 3, "shares-not-limited"),
    "mixed_without_pi": (0, 0, None, "diffuse-without-pi"),
    "mixed_always": (0, 0, 1, "always-divided"),
    "phong_loop": (1, 1, 1, ""),
    "phong_list": (1, 1, None, ""),
    "phong_float32": (0.5, 0.5, 1, "single-precision"),
}

SUBMISSION = """
import math
import numpy as np

FLIP = np.array([-1.0, -1.0, 1.0])


def lit(wi, wo, value):
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), value, 0.0)


def mirror(wi, wo, flip=FLIP):
    return np.maximum(np.sum(wi * wo * flip, axis=-1), 0)


def half(wi, wo):
    h = wi + wo
    return h[..., 2] / np.maximum(np.linalg.norm(h, axis=-1), 1e-300)


def exact(n):
    return (n + 2) * (n + 4) / (8 * np.pi * (2.0 ** (-n / 2) + n))


def lambert_pi_forgotten(wi, wo, reflectance):
    return lit(wi, wo, reflectance)


def lambert_with_cosine(wi, wo, reflectance):
    return lit(wi, wo, reflectance / np.pi * wi[..., 2])


def lambert_over_2pi(wi, wo, reflectance):
    return lit(wi, wo, reflectance / (2 * np.pi))


def lambert_everywhere(wi, wo, reflectance):
    return np.ones(wi.shape[:-1]) * reflectance / np.pi


def lambert_black(wi, wo, reflectance):
    return 0 * wi[..., 2]


def mirror_cosine_at_surface(wi, wo):
    return mirror(wi, wo, np.array([1, 1, -1]))


def mirror_cosine_absolute(wi, wo):
    return np.abs(np.sum(wi * wo * FLIP, axis=-1))


def mirror_cosine_unclamped(wi, wo):
    return np.sum(wi * wo * FLIP, axis=-1)


def mirror_cosine_degrees(wi, wo):
    return np.degrees(np.arccos(np.clip(np.sum(wi * wo * FLIP, axis=-1), -1, 1)))


def phong_original_not_divided(wi, wo, exponent, coefficient):
    return lit(wi, wo, coefficient * mirror(wi, wo) ** exponent)


def phong_original_swapped(wi, wo, exponent, coefficient):
    below = np.where(wo[..., 2] > 0, wo[..., 2], 1)
    return lit(wi, wo, coefficient * mirror(wi, wo) ** exponent / below)


def phong_original_inf(wi, wo, exponent, coefficient):
    with np.errstate(all="ignore"):
        return coefficient * mirror(wi, wo) ** exponent / np.maximum(wi[..., 2], 0) * (wo[..., 2] > 0)


def phong_n_plus_1(wi, wo, exponent):
    return lit(wi, wo, (exponent + 1) / (2 * np.pi) * mirror(wi, wo) ** exponent)


def phong_absolute(wi, wo, exponent):
    return lit(wi, wo, (exponent + 2) / (2 * np.pi) * np.abs(np.sum(wi * wo * FLIP, axis=-1)) ** exponent)


def phong_divided(wi, wo, exponent):
    below = np.where(wi[..., 2] > 0, wi[..., 2], 1)
    return lit(wi, wo, (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** exponent / below)


def phong_two_more(wi, wo, exponent):
    return lit(wi, wo, (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** (exponent + 2))


def phong_below_horizon(wi, wo, exponent):
    return (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** exponent


def half_cosine_unnormalised(wi, wo):
    return lit(wi, wo, (wi + wo)[..., 2] / 2)


def half_cosine_from_viewer(wi, wo):
    h = wi + wo
    return lit(wi, wo, np.sum(h * wo, axis=-1) / np.maximum(np.linalg.norm(h, axis=-1), 1e-300))


def half_cosine_nan(wi, wo):
    h = wi + wo
    with np.errstate(all="ignore"):
        return lit(wi, wo, 1.0) * (h / np.linalg.norm(h, axis=-1, keepdims=True))[..., 2]


def blinn_phong_as_phong(wi, wo, exponent):
    return lit(wi, wo, (exponent + 2) / (2 * np.pi) * half(wi, wo) ** exponent)


def blinn_phong_n_plus_8(wi, wo, exponent):
    return lit(wi, wo, (exponent + 8) / (8 * np.pi) * half(wi, wo) ** exponent)


def blinn_phong_unnormalised(wi, wo, exponent):
    return lit(wi, wo, exact(exponent) * np.maximum((wi + wo)[..., 2] / 2, 0) ** exponent)


def blinn_phong_one_more(wi, wo, exponent):
    return lit(wi, wo, exact(exponent) * half(wi, wo) ** (exponent + 1))


def blinn_phong_one_way(wi, wo, exponent):
    return lit(wi, wo, exact(exponent) * half(wi, wo) ** exponent * wi[..., 2])


def blinn_phong_constant(wi, wo, exponent):
    return lit(wi, wo, 1 / np.pi)


def asymmetry_signed(a, b):
    return (a - b) / np.where(np.maximum(a, b) > 0, np.maximum(a, b), 1)


def asymmetry_of_mean(a, b):
    return 2 * np.abs(a - b) / np.where(a + b > 0, a + b, 1)


def asymmetry_nan(a, b):
    with np.errstate(all="ignore"):
        return np.abs(a - b) / np.maximum(a, b)


def mixed_unlimited(wi, wo, diffuse, specular, exponent):
    lobe = (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** exponent
    return lit(wi, wo, diffuse / np.pi + specular * lobe)


def mixed_without_pi(wi, wo, diffuse, specular, exponent):
    lobe = (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** exponent
    return lit(wi, wo, diffuse + specular * lobe) / np.maximum(1, diffuse + specular)


def mixed_always(wi, wo, diffuse, specular, exponent):
    lobe = (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** exponent
    return lit(wi, wo, diffuse / np.pi + specular * lobe) / (diffuse + specular)


def phong_loop(wi, wo, exponent):
    if wi[2] <= 0 or wo[2] <= 0:
        return 0.0
    cosine = -wi[0] * wo[0] - wi[1] * wo[1] + wi[2] * wo[2]
    return (exponent + 2) / (2 * math.pi) * max(cosine, 0.0) ** exponent


def phong_list(wi, wo, exponent):
    return lit(wi, wo, (exponent + 2) / (2 * np.pi) * mirror(wi, wo) ** exponent).tolist()


def phong_float32(wi, wo, exponent):
    wi, wo, n = np.float32(wi), np.float32(wo), np.float32(exponent)
    value = (n + 2) / np.float32(2 * np.pi) * mirror(wi, wo, np.float32(FLIP)) ** n
    return lit(wi, wo, value).astype(np.float32)
"""


@pytest.fixture(scope="module")
def sandbox(tmp_path_factory):
    file = tmp_path_factory.mktemp("planted") / "theirs.py"
    file.write_text(SUBMISSION)
    with Sandbox(file) as opened:
        yield opened


@pytest.mark.parametrize("name", PLANTED)
def test_planted_mistakes_earn_what_they_are_worth_and_are_named(name, sandbox, coarse):
    *shares, diagnosis = PLANTED[name]
    question = max(
        (each for each in ASSIGNMENT.questions if name.startswith(each.name)), key=lambda each: len(each.name)
    )
    for part, share in zip(("ordinary", "hard", "laws"), shares, strict=True):
        judged = part_of(question, part)
        if judged is None or share is None:
            continue
        for language in LANGUAGES if part == "ordinary" else ("ru",):
            found = finding(Isolated(sandbox, name), question, judged, language)
            assert found.share == pytest.approx(share), found.text
            named = "not-the-model" if part == "laws" and share == 0 else diagnosis
            if (share < 1 or part == "laws") and found.diagnosis and named is not None:
                assert found.diagnosis == named, found.text
            assert bool(found.diagnosis) or share == 1, found.text
            assert len(found.text) < 400


def test_every_question_has_planted_mistakes():
    for question in ASSIGNMENT.questions:
        assert sum(name.startswith(question.name) for name in PLANTED) >= 3
    assert len(PLANTED) > 30


@pytest.mark.parametrize("question", ASSIGNMENT.questions, ids=NAMES)
def test_every_variant_is_told_from_every_other(question):
    for name, variant in part_of(question, "ordinary").judge.variants.items():
        part = part_of(question, "hard" if name == "horizon-clamped" else "ordinary")

        def theirs(*arrays, variant=variant):
            return variant(**dict(zip(question.parameters, arrays, strict=True)))

        found = finding(Local(theirs), question, part, "ru")
        assert (found.share, found.diagnosis) == (0.0, name), found.text
        hint = question.hints[name]["ru"].rstrip(".")
        assert hint in found.text


def test_laws_never_show_what_is_right(coarse):
    for question in ASSIGNMENT.questions:
        part = part_of(question, "laws")
        if part is None:
            continue
        assert isinstance(part.judge, Laws)
        found = finding(Local(lambda wi, wo, **_: 0.3 + 0.1 * wi[..., 2] * wo[..., 2]), question, part)
        assert found.share <= 1 / 3
        assert "right is" not in found.text
