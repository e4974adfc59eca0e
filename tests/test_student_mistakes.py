"""Students' answers to the shipped assignments: mistakes alone and two at once are named, and named truly."""

from __future__ import annotations

import numpy as np
import pytest

from radiokit.faces.grading.assignment import load_assignment, student_rng
from radiokit.faces.grading.finding import Finding
from radiokit.faces.grading.grader import grade
from radiokit.faces.grading.handout.here import Here

HEADER = "import numpy as np\nfrom numpy import pi\n"
UP = "up = (wi[..., 2] > 0) & (wo[..., 2] > 0); c = np.maximum(np.sum(wi * wo * [-1, -1, 1], -1), 0); "
SUN = "d = light - position; r = np.linalg.norm(d, axis=1); "
LIGHTS = "radiance * np.maximum(cosine, 0) * solid_angle"
FORMULA = (
    "n = lambda v: np.linalg.norm(v, axis=-1); dot = lambda x, y: np.sum(x * y, -1); "
    "top = np.abs(dot(a, np.cross(b - a, c - a))); "
    "below = n(a) * n(b) * n(c) + dot(a, b) * n(c) + dot(b, c) * n(a) + dot(c, a) * n(b); "
)
HALF = "h = wi + wo; c = np.where(up, h[..., 2] / np.linalg.norm(h, axis=-1), 0); n = exponent; "


def finding(assignment: str, name: str, part: str, body: str, language: str = "en") -> Finding:
    """Return what is said of a function with this body."""
    work = load_assignment(assignment)
    question = work.question(name)
    space: dict[str, object] = {}
    exec(f"{HEADER}def {name}({', '.join(question.functions[name])}):\n    {body}\n", space)
    (judged,) = [each for each in question.parts if each.name == part]
    return judged.judge.judge(
        Here(space[name], name),
        student_rng(work, question, judged, student="a student"),
        language=language,
        hints=question.hints,
        shown=judged.visibility == "visible",
    )


NAMED = {  # assignment, function, part, body; the diagnosis, and words that must be said
    "degrees and 4π": (
        ("radiometry", "cone_solid_angle", "ordinary", "return 4*pi*(1 - np.cos(np.radians(half_angle)))"),
        ("angle-unit + doubled", "wrong unit + 2π stands before 1 − cos α"),
    ),
    "degrees and no π": (
        (
            "radiometry",
            "cone_irradiance",
            "ordinary",
            "return radiance * np.sin(np.radians(half_angle))**2",
        ),
        ("angle-unit + pi-too-few", "You forgot π"),
    ),
    "radians and no square": (
        (
            "radiometry",
            "lamp_irradiance",
            "ordinary",
            "return np.maximum(0, intensity * np.cos(theta_deg) / distance)",
        ),
        ("degrees-for-radians + distance-not-squared", "and not by its square"),
    ),
    "normal and no square": (
        (
            "radiometry",
            "light_irradiance",
            "ordinary",
            SUN + "return intensity * np.maximum(np.sum(d * normal, 1), 0) / r**2",
        ),
        ("normal-not-normalised + distance-not-squared", "The normal may be of any length"),
    ),
    "no π and no cosine": (
        (
            "radiometry",
            "reflected_radiance",
            "ordinary",
            "return albedo * np.sum(radiance * solid_angle, -1)",
        ),
        ("cosine-forgotten + pi-too-many", "You forgot to divide by π"),
    ),
    "no π and n + 1": (
        ("brdfs", "phong", "ordinary", UP + "return np.where(up, (exponent + 1) / 2 * c**exponent, 0)"),
        ("pi-too-many + lobe-normalisation", "another constant than is asked"),
    ),
    "books' constant and Phong's angle": (
        (
            "brdfs",
            "blinn_phong",
            "ordinary",
            UP + "return np.where(up, (exponent + 8) / (8 * pi) * c**exponent, 0)",
        ),
        ("mirror-for-half + lobe-normalisation", "as Phong does"),
    ),
    "no cosine and f/π": (
        (
            "shading",
            "direct_light",
            "ordinary",
            "return np.sum(f / pi * intensities / np.sum(positions**2, -1), -1)",
        ),
        ("cosine-forgotten + pi-too-few", "π times too small"),
    ),
    "the last light": (
        (
            "radiometry",
            "reflected_radiance",
            "ordinary",
            f"return albedo / pi * np.sum(({LIGHTS})[:, :-1], -1)",
        ),
        ("last-light-forgotten", "range(K)"),
    ),
    "return in the loop": (
        ("radiometry", "reflected_radiance", "ordinary", f"return albedo / pi * ({LIGHTS})[:, 0]"),
        ("first-light-alone", "does return stand inside the loop?"),
    ),
    "= for +=": (
        ("radiometry", "reflected_radiance", "ordinary", f"return albedo / pi * ({LIGHTS})[:, -1]"),
        ("last-light-alone", "+= in place of ="),
    ),
    "halved angle of a cone": (
        ("radiometry", "cone_irradiance", "ordinary", "return pi * radiance * np.sin(half_angle / 2)**2"),
        ("full-angle", "do not halve it again"),
    ),
    "3.14 in an angle": (
        (
            "radiometry",
            "lamp_irradiance",
            "ordinary",
            "return np.maximum(0, intensity * np.cos(theta_deg * 3.14 / 180) / distance**2)",
        ),
        ("pi-rounded", "You rounded π"),
    ),
    "1 + cos is no offset": (
        ("radiometry", "cone_solid_angle", "hard", "return 2 * pi * (1 + np.cos(half_angle))"),
        ("cosine-added", "the rest of the sphere"),
    ),
    "a flat disk loses no digits": (
        ("radiometry", "cone_solid_angle", "hard", "return pi * half_angle**2"),
        ("small-angle", "the area of a flat disk"),
    ),
    "upside down": (
        ("radiometry", "triangle_solid_angle", "ordinary", FORMULA + "return 2 * np.arctan2(below, top)"),
        ("fraction-upside-down", "upside down"),
    ),
    "|arctan|": (
        ("radiometry", "triangle_solid_angle", "hard", FORMULA + "return np.abs(2 * np.arctan(top / below))"),
        ("quadrant-folded", "2π − Ω"),
    ),
    "x**n+1": (
        (
            "radiometry",
            "spot_flux",
            "ordinary",
            "return 2*pi*intensity * (1 - (np.cos(half_angle)**exponent+1)) / (exponent + 1)",
        ),
        ("one-outside-the-exponent", "outside of the power"),
    ),
    "no parentheses": (
        ("radiometry", "isotropic_irradiance", "ordinary", "return flux / 4 * pi * distance**2"),
        ("parentheses-forgotten", "x / (4 * π * d²)"),
    ),
    "2^-n": (
        (
            "brdfs",
            "blinn_phong",
            "ordinary",
            UP + HALF + "return (n + 2) * (n + 4) / (8 * pi * (2.0**-n + n)) * c**n",
        ),
        ("power-of-two-whole", "1/√2"),
    ),
    "maximum of all": (
        ("brdfs", "asymmetry", "ordinary", "return np.abs(a - b) / np.max([a, b])"),
        ("beside-others", "Right for one input at a time"),
    ),
    "float16": (
        ("brdfs", "lambert", "ordinary", "return np.float16(reflectance / pi) + 0 * np.float16(wi[..., 2])"),
        ("single-precision", "computed in float16"),
    ),
}


@pytest.mark.parametrize(("asked", "said"), NAMED.values(), ids=NAMED)
def test_a_mistake_is_named(asked: tuple[str, str, str, str], said: tuple[str, str]) -> None:
    found = finding(*asked)
    assert found.diagnosis == said[0], found.text
    assert said[1] in found.text
    assert finding(*asked, language="ru").diagnosis == said[0]


def test_answers_that_are_nearly_right_are_not_told_that_they_round_pi() -> None:
    body = (
        "out = []\n    for t, a in zip(theta, half_angle):\n"
        "        al = ((np.arange(8) + .5) * a / 8)[:, None]; ph = np.arange(8) * pi / 4\n"
        "        c = np.cos(t) * np.cos(al) + np.sin(t) * np.sin(al) * np.cos(ph)\n"
        "        out.append(np.sum(np.maximum(c, 0) * np.sin(al)) * a / 8 * pi / 4)\n    return np.array(out)"
    )
    found = finding("shading", "sphere_irradiance", "ordinary", body)
    assert 0 < found.share < 1
    assert found.diagnosis == "wrong-at-few"
    assert "π" not in found.text
    assert "times the reference" not in found.text


def test_two_mistakes_earn_less_than_one() -> None:
    one = SUN + "return intensity * np.maximum(np.sum(d * normal, 1), 0) / r**3"
    two = SUN + "return intensity * np.sum(d * normal, 1) / r**3"
    shares = [finding("radiometry", "light_irradiance", "ordinary", body) for body in (one, two)]
    assert [each.share for each in shares] == [0.5, 0.25]
    assert [each.diagnosis for each in shares] == ["normal-not-normalised"] * 2
    assert "0 is right" not in shares[0].text
    assert "Besides, 0 is right at 10 of 40 inputs" in shares[1].text


def test_a_question_graded_alone_keeps_the_hints_of_others() -> None:
    content = b"def lambert(wi, wo, reflectance):\n    return 0 * wi[..., 2]\n"
    found = grade("brdfs", "answers.py", content=content, questions=["half_cosine"])
    assert [each.name for each in found.questions] == ["half_cosine"]
    assert found.points == 2


def test_a_decorator_may_pass_its_arguments_by_position() -> None:
    content = b"""
import functools
import numpy as np
def above(f):
    @functools.wraps(f)
    def g(wi, wo, *rest):
        return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), f(wi, wo, *rest), 0)
    return g
@above
def lambert(wi, wo, reflectance):
    return reflectance / np.pi
"""
    assert grade("brdfs", "answers.py", content=content, questions=["lambert"]).score == 2


def test_two_numbers_may_come_in_an_array() -> None:
    pair = Here(lambda x: np.array([x, 2 * x]), "pair").call(np.asarray(1.0), outputs=2)
    assert [float(each) for each in pair.values] == [1.0, 2.0]


def test_what_is_missing_is_told_where_it_is() -> None:
    content = b"""
class Answers:
    def cone_solid_angle(self, half_angle):
        return half_angle
def cone_irradianse(radiance, half_angle):
    return radiance
"""
    names = ["cone_solid_angle", "cone_irradiance", "lamp_irradiance"]
    found = grade("radiometry", "answers.py", content=content, questions=names)
    assert "Answers.cone_solid_angle is a method" in found["cone_solid_angle"].explanation
    assert found["cone_irradiance"].explanation.endswith("; is it cone_irradianse?")
    assert found["lamp_irradiance"].explanation == "defines no function lamp_irradiance"


def test_a_function_that_is_there_is_not_suggested_for_one_that_is_not() -> None:
    content = b"def cosine_sample(u):\n    return u\n"
    found = grade("shading", "answers.py", content=content, questions=["cosine_sample"])
    assert found["cosine_sample"].parts[1].text == "defines no function cosine_pdf"


def test_every_judge_says_that_a_power_is_no_caret() -> None:
    sampler = finding("shading", "lobe_sample", "distribution", "return (1 - u)^(1 / (exponent + 1))")
    values = finding("radiometry", "isotropic_irradiance", "ordinary", "return flux / distance^2")
    for found in (sampler, values):
        assert found.text.startswith("In Python a power is written x**2")
        assert found.text.count("x**2") == 1
