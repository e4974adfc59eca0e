"""The judge of laws: legal functions pass, planted wrong ones are named, and no clock has a part in it."""

from __future__ import annotations

import functools
import re
import string
import sys
import time

import numpy as np
import pytest

from radiokit.bsdfs import GGX, BlinnPhong, Lambert, Phong, PhongOriginal
from radiokit.checks.probes import pairs
from radiokit.contracts.blackbox import as_bsdf
from radiokit.faces.grading import Laws, Limits, Sandbox, list_diagnoses
from radiokit.faces.grading.grader import Isolated
from radiokit.faces.grading.handout.here import Here
from radiokit.faces.grading.isolation.signature import listed, renamed
from radiokit.faces.grading.judges import laws as module
from radiokit.faces.grading.judges.lawtexts import share_of_light
from radiokit.faces.grading.judges.lawwords import LAW_NAMES, LAW_SENTENCES
from radiokit.faces.grading.judges.likeness import PAIRS, compared
from radiokit.facts.errors import ParameterError


class Local:
    """A function of this process in the place of a student's."""

    def __init__(self, function):
        self.function, self.name = function, "f"

    def bsdf(self, parameters=None):
        return as_bsdf(functools.partial(self.function, **(parameters or {})), label="f")


def judged(function, language="en", hints=None, **options):
    return Laws(**options).judge(
        Local(function), np.random.default_rng(0), language=language, hints=hints or {}, shown=False
    )


def lambert(wi, wo, reflectance=1.0):
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), reflectance / np.pi, 0.0)


def blinn(wi, wo, exponent=10.0, constant=lambda n: (n + 2) * (n + 4) / (8 * np.pi * (2 ** (-n / 2) + n))):
    h = wi + wo
    cosine = h[..., 2] / np.linalg.norm(h, axis=-1)
    lit = (wi[..., 2] > 0) & (wo[..., 2] > 0)
    return np.where(lit, constant(exponent) * np.maximum(cosine, 0.0) ** exponent, 0.0)


@pytest.fixture
def coarse(monkeypatch):
    """Spare evaluations where a fault is gross."""
    monkeypatch.setattr(module, "EVALUATIONS", (100_000, 1_000_000))


def exact_blinn(exponent=10.0):
    return BlinnPhong(exponent=exponent)


def gap(wi, wo):
    return np.where((wi[:, 2] < 0.01) | (wo[:, 2] < 0.01), 1.5, 0.9) / np.pi


def bright_spot(wi, wo):
    return (0.9 + 0.3 * (wi[:, 2] > np.cos(0.02))) / np.pi


def noisy(generator, wi, wo):
    return 0.1 + 0.01 * generator.random(len(wi))


def raises(wi, wo):
    if np.any(wi[:, 2] > 0.9999):
        raise ValueError("too steep")
    return lambert(wi, wo)


# --------------------------------------------------------------------------------------------- legal ones

LEGAL = {
    "white": lambert,
    "narrow": Phong(exponent=5000.0).evaluate,  # above 700 in the middle of its lobe
    "facets": GGX(alpha=0.05).evaluate,
    "anisotropic": GGX(alpha_x=0.1, alpha_y=0.5).evaluate,
    "retro": lambda wi, wo: 6 / np.pi * np.maximum(np.sum(wi * wo, axis=-1), 0) ** 10,
    "spectral": lambda wi, wo: np.outer(lambert(wi, wo), [0.2, 1.0, 0.5]),
    "in stripes": lambda wi, wo: lambert(wi, wo) * (np.sign(np.sin(40 * wi[:, 2] * wo[:, 2])) > 0),
    "float32": lambda wi, wo: lambert(wi, wo).astype(np.float32),
    "of lists": lambda wi, wo: lambert(wi, wo).tolist(),
}


@pytest.mark.parametrize("name", LEGAL)
def test_what_obeys_the_laws_earns_everything(name, request):
    if name == "anisotropic":  # which takes long
        request.getfixturevalue("coarse")
    found = judged(LEGAL[name])
    assert (found.share, found.diagnosis) == (1.0, ""), found.text
    assert found.text.startswith("Right: finite and nowhere negative; reciprocal at all ")
    assert ("float32" in found.text) == (name == "float32")


# --------------------------------------------------------------------------------------------- wrong ones

WRONG = {
    "nan": (
        lambda wi, wo: np.where(wi[:, 2] > 0.9999, np.nan, 0.1),
        0,
        "not-finite",
        "Gives NaN at wi: θ = 0°",
    ),
    "inf": (lambda wi, wo: 0.1 / (wi[:, 2] < 0.99999), 0, "not-finite", "Gives inf at wi: θ = 0°"),
    "negative": (lambda wi, wo: 0.01 * wi[:, 0] * wo[:, 0], 2, "negative", "Is negative: f = -0.00"),
    "raises": (raises, 0, "", r"^f raised ValueError: too steep at wi: θ = 0[.\d]*°"),
    "nothing": (lambda wi, wo: None, 0, "", "returned None: is a return statement missing?"),
    "words": (lambda wi, wo: "0.3", 0, "", "returned str that is no array of real numbers"),
    "one-way": (
        lambda wi, wo: lambert(wi, wo) * wi[:, 2],
        2,
        "not-reciprocal",
        r"Is not reciprocal: f\(wi, wo\) = [\d.]+, but with the directions exchanged [\d.]+ \(wi: θ = \d0°",
    ),
    "gain": (
        lambda wi, wo: 1.075 * lambert(wi, wo),
        2,
        "gains-energy",
        r"^Gains energy: reflects 108 % of the light at every angle\.$",
    ),
    "small gain": (
        lambda wi, wo: 1.00001 * lambert(wi, wo),
        2,
        "gains-energy",
        "reflects 100.001 % of the light at every",
    ),
    "gain at grazing": (gap, 2, "gains-energy", r"at θ = 89\.\d+° it reflects 150 % of the light"),
    "gain in a spot": (
        bright_spot,
        1,
        "not-reciprocal",
        r"Gains energy: at θ = [01][.\d]*° it reflects 120 %",
    ),
    "original": (
        PhongOriginal(exponent=10.0, coefficient=0.5).evaluate,
        1,
        "not-reciprocal",
        "it reflects 18[45]00 % of the light, and more as θ → 90°",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_breaks_a_law_is_told_so_with_a_witness(name, coarse):
    function, kept, diagnosis, says = WRONG[name]
    found = judged(function)
    assert (round(3 * found.share), found.diagnosis) == (kept, diagnosis), found.text
    assert re.search(says, found.text), found.text
    russian = judged(function, "ru")
    assert (russian.share, russian.diagnosis) == (found.share, found.diagnosis)
    assert re.search("[а-я]", russian.text) or "returned" in found.text


def test_a_function_that_answers_differently_is_judged_for_nothing(rng):
    found = judged(functools.partial(noisy, rng))
    assert (found.share, found.diagnosis) == (0.0, "not-repeatable")
    assert "cannot be judged for reciprocity, conservation of energy" in found.text


def test_a_witness_can_be_typed_in(coarse):
    found = judged(lambda wi, wo: lambert(wi, wo) * wi[:, 2])
    numbers = [float(each) for each in re.findall(r"(?:θ|φ) = ([\d.]+)°", found.text)]
    assert all(each % 10 == 0 for each in numbers)
    theta_i, _, theta_o, _ = np.radians(numbers)
    one, two = re.search(r"= ([\d.]+), but with the directions exchanged ([\d.]+)", found.text).groups()
    assert float(one) == pytest.approx(np.cos(theta_i) / np.pi, rel=1e-2)
    assert float(two) == pytest.approx(np.cos(theta_o) / np.pi, rel=1e-2)


def test_habits_are_remarked_upon_and_cost_nothing():
    def everywhere(wi, wo):
        sys.stdout.write("hello")
        value = np.full(len(wi), 0.3)
        wi[:] = 0
        return value

    found = judged(everywhere)
    assert found.share == 1
    for says in ("prints while it computes", "writes into the arrays", "is not 0 below the horizon"):
        assert says in found.text


# ---------------------------------------------------------------------------------- the other way round


def test_a_task_may_ask_for_what_breaks_a_law(coarse):
    asked = {"expected": {"reciprocity": "violated"}, "least": 0.1}
    assert judged(lambda wi, wo: lambert(wi, wo) * wi[:, 2], **asked).share == 1
    tame = judged(lambert, **asked)
    assert (tame.share, tame.diagnosis) == (2 / 3, "reciprocity-holds")
    assert "one is asked for that breaks this law" in tame.text
    greedy = judged(lambda wi, wo: 2 * lambert(wi, wo), **asked, weights={"energy": 2.0})
    assert greedy.share == 1 / 4
    nowhere = judged(lambda wi, wo: np.nan * wi[:, 2], **asked)
    assert (nowhere.share, nowhere.diagnosis) == (0.0, "not-finite")


def test_a_brdf_that_is_divided_by_the_cosine_is_not_told_of_irradiance(coarse):
    def divided(wi, wo):
        return lambert(wi, wo, 0.5) / np.maximum(wi[..., 2], 1e-12)

    found = judged(divided, laws=("values",), reference=lambda: Lambert(reflectance=0.5))
    assert found.diagnosis == "cosine-forgotten"
    assert "a division by that cosine is one too many" in found.text
    own = {"cosine-forgotten": {"en": "Do not divide", "ru": "Не делите"}}
    found = judged(divided, hints=own, laws=("values",), reference=lambda: Lambert(reflectance=0.5))
    assert "Do not divide." in found.text


def test_a_law_that_is_broken_may_have_a_hint(coarse):
    hints = {
        "gains-energy": {"en": "divide by π", "ru": "разделите на π"},
        "not-the-model": {"en": "not so dark", "ru": "светлее"},
        "reciprocity-holds": {"en": "swap them", "ru": "поменяйте"},
    }
    found = judged(lambda wi, wo: 2 * lambert(wi, wo), hints=hints)
    assert found.diagnosis == "gains-energy"
    assert found.text == "Gains energy: reflects 200 % of the light at every angle. Divide by π."
    assert "Разделите на π." in judged(lambda wi, wo: 2 * lambert(wi, wo), "ru", hints=hints).text
    assert judged(lambda wi, wo: 0 * wi[:, 2], hints=hints, least=0.5).text.endswith("Not so dark.")
    kept = judged(lambert, hints=hints, expected={"reciprocity": "violated"})
    assert (kept.diagnosis, kept.text.endswith("Swap them.")) == ("reciprocity-holds", True)
    assert set(hints) <= set(list_diagnoses())


def test_laws_are_weighed_and_may_be_left_out(coarse):
    wrong = {"weights": {"energy": 8.0}}
    assert judged(lambda wi, wo: 2 * lambert(wi, wo), **wrong).share == pytest.approx(0.2)
    assert judged(lambda wi, wo: 2 * lambert(wi, wo), laws=("values", "reciprocity")).share == 1


# ------------------------------------------------------------------------------- what it should be


def test_black_and_constant_earn_nothing_where_something_else_is_asked_for(coarse):
    def nothing(wi, wo, exponent=10.0):
        return np.zeros(len(wi))

    dark = judged(nothing, least=0.5)
    assert (dark.share, dark.diagnosis) == (0.0, "not-the-model")
    assert "Reflects at most 0 % of the light, and at least 50 % is asked for" in dark.text
    for cheat in (nothing, lambda wi, wo: lambert(wi, wo, 0.5), Phong(exponent=10.0).evaluate):
        found = judged(cheat, reference=exact_blinn)
        assert (found.share, found.diagnosis) == (0.0, "not-the-model")
        assert "Is not the function that is asked for" in found.text
    assert judged(lambda wi, wo: lambert(wi, wo, 0.5), reference=lambda: Lambert(reflectance=0.5)).share == 1


@pytest.mark.parametrize(
    ("factor", "name"), [(1 / (2 * np.pi), "two-pi-too-few"), (2 * np.pi, "two-pi-too-many")]
)
def test_too_dark_by_a_slip_costs_what_too_bright_costs(factor, name, coarse):
    asked = {"reference": lambda: Lambert(reflectance=0.8), "least": 0.5}
    found = judged(lambda wi, wo: factor * lambert(wi, wo, 0.8), **asked)
    assert (found.share, found.diagnosis) == (2 / 3, name)
    assert ("at least 50 % is asked for" in found.text) is (factor < 1)


def test_what_hides_from_the_comparison_is_no_model_either(coarse):
    def shy(wi, wo):  # it knows by their number which directions are compared
        return np.full(len(wi), np.nan) if len(wi) == PAIRS else lambert(wi, wo, 0.5)

    found = judged(shy, reference=exact_blinn)
    assert (found.share, found.diagnosis) == (0.0, "not-the-model")


def test_the_misconception_is_named_beside_the_law(coarse):
    parameters = ({"exponent": 10.0}, {"exponent": 40.0})
    options = {"parameters": parameters, "reference": exact_blinn}
    assert judged(blinn, **options).share == 1
    found = judged(functools.partial(blinn, constant=lambda n: (n + 8) / (8 * np.pi)), **options)
    assert (found.share, found.diagnosis) == (2 / 3, "lobe-normalisation")
    assert found.text.startswith(
        "For exponent = 10: gains energy: at θ = 0° it reflects 107.5 % of the light. You"
    )
    phong = functools.partial(blinn, constant=lambda n: (n + 2) / (2 * np.pi))
    own = judged(phong, **options, hints={"lobe-normalisation": {"en": "That is Phong's", "ru": "-"}})
    assert own.text.endswith(" That is Phong's.")
    scaled = judged(lambda wi, wo, exponent: 0.77 * blinn(wi, wo, exponent), **options)
    assert (scaled.share, scaled.diagnosis) == (1.0, "other-factor")
    assert "0.77 times the function" in scaled.text
    few = judged(lambda wi, wo, exponent: blinn(wi, wo, exponent) * (1 - 0.5 * (wo[:, 2] < 2e-3)), **options)
    assert few.diagnosis == "wrong-at-few"
    assert re.search(r"wrong at \d+ of 256, as at wi: .* wo: θ = 89\.9", few.text)


def test_the_directions_of_the_comparison_are_not_foretold():
    known = {wi.tobytes() + wo.tobytes() for wi, wo in zip(*pairs(PAIRS, exact_blinn()), strict=True)}

    def sly(wi, wo):
        """Right where everyone was once looked at, and less elsewhere."""
        right = [i.tobytes() + o.tobytes() in known for i, o in zip(wi, wo, strict=True)]
        return np.where(right, 1.0, 0.77) * blinn(wi, wo)

    rng = np.random.default_rng(0)
    models = [[as_bsdf(sly)], [exact_blinn()], [{}]]
    found = compared(*models, rng, variants={}, hints={}, language="en")
    assert found.name == "other-factor"


def test_variants_of_the_assignment_are_named(coarse):
    def halves(wi, wo, exponent):
        return blinn(wi, wo, exponent / 2)

    found = judged(
        halves,
        parameters=lambda rng: [{"exponent": 10.0}, {"exponent": 20.0 + np.floor(rng.random() * 10)}],
        reference=exact_blinn,
        variants={"half-the-exponent": halves},
        hints={"half-the-exponent": {"en": "Half of n is not n", "ru": "Половина n — не n"}},
        language="ru",
    )
    assert (found.diagnosis, found.share) == ("half-the-exponent", 1.0)
    assert found.text == "Половина n — не n."


# ----------------------------------------------------------------------------------- time, and doubt


@pytest.mark.parametrize("step", [0.0, 3600.0])
def test_no_clock_changes_a_finding(step, monkeypatch):
    wrong = functools.partial(blinn, constant=lambda n: (n + 8) / (8 * np.pi))
    usual = judged(wrong, reference=exact_blinn)
    ticks = iter(range(10**9))
    monkeypatch.setattr(time, "perf_counter", lambda: step * next(ticks))
    assert judged(wrong, reference=exact_blinn) == usual


def test_what_stays_in_doubt_is_said_and_costs_only_what_was_seen(monkeypatch):
    monkeypatch.setattr(module, "EVALUATIONS", (30_000, 30_000))
    found = judged(lambert)
    assert found.share == 1
    assert re.search(r"is too near the limit to tell: it reflects 100 % of the light ± \d %", found.text)
    over = judged(lambda wi, wo: 1.01 * lambert(wi, wo))
    assert (over.share, over.diagnosis) == (2 / 3, "unclear")
    monkeypatch.setattr(module, "EVALUATIONS", (30_000, 300_000))
    assert judged(lambert, tolerance=0.1).text.endswith("reflects 100 % of the light at every angle.")
    monkeypatch.setattr(module, "EVALUATIONS", (30_000, 1_000_000))
    assert judged(lambda wi, wo: 1.01 * lambert(wi, wo)).diagnosis == "gains-energy"
    assert "at every angle" in judged(lambert).text


# ------------------------------------------------------------------------------------- in a sandbox

THEIRS = """
import math
import time
import numpy as np


def loop(wi, wo, exponent):
    if wi[2] <= 0 or wo[2] <= 0:
        return 0.0
    cosine = -wi[0] * wo[0] - wi[1] * wo[1] + wi[2] * wo[2]
    return (exponent + 2) / (2 * math.pi) * max(cosine, 0.0) ** exponent


def greedy(wi, wo, exponent):
    return 1.05 * loop(wi, wo, exponent)


def renamed(wi, wo, n):
    return loop(wi, wo, n)


def further(wi, wo, n, constant):
    return loop(wi, wo, n)


def mixing(wi, wo, exponent):
    mirror = wo * np.array([-1, -1, 1])
    return (exponent + 2) / (2 * np.pi) * max(np.sum(wi * mirror), 0.0) ** exponent


def slow(wi, wo, exponent):
    time.sleep(0.05)
    return loop(wi, wo, exponent)


def array(wi, wo, exponent):
    print("here")
    cosine = np.maximum(np.sum(wi * wo * np.array([-1, -1, 1]), axis=-1), 0)
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), (exponent + 2) / (2 * np.pi) * cosine**exponent, 0)
"""


def test_loops_are_searched_more_coarsely_and_judged_alike(tmp_path, monkeypatch):
    (tmp_path / "theirs.py").write_text(THEIRS)
    judge = Laws(parameters=({"exponent": 9.0},), reference=lambda exponent: Phong(exponent=exponent))

    def finding(name):
        return judge.judge(
            Isolated(sandbox, name), np.random.default_rng(0), language="en", hints={}, shown=True
        )

    with Sandbox(tmp_path / "theirs.py", limits=Limits(seconds=5.0)) as sandbox:
        loop, array = finding("loop"), finding("array")
        assert (loop.share, array.share) == (1.0, 1.0)
        assert "12500 pairs" in loop.text
        assert "65536 pairs" in array.text
        assert "It prints while it computes: remove that." in array.text
        with monkeypatch.context() as patched:  # a clock that stands still
            patched.setattr(time, "perf_counter", lambda: 0.0)
            assert finding("array") == array
        assert finding("renamed") == loop  # a parameter of another name is taken by its position
        further = finding("further")
        assert further.share == 0
        assert further.text.endswith("its parameters must have the names that the question gives them")
        greedy = finding("greedy")
        assert greedy.share == pytest.approx(2 / 3)
        assert "At θ = 0° it reflects 105 % of the light".lower() in greedy.text.lower()
        mixing = finding("mixing")
        assert "mixes up the rows of an array" in mixing.text
        assert mixing.share == 1
    with Sandbox(tmp_path / "theirs.py", limits=Limits(seconds=1.0)) as sandbox:
        slow = finding("slow")
    assert slow.share == 0
    assert "longer than 1 s; judging takes about 100000 pairs of directions: compute with" in slow.text


def test_a_students_own_check_takes_other_names_by_position_too():
    judge = Laws(laws=("values",), parameters=({"exponent": 9.0, "scale": 0.5},))
    for function in (
        lambda wi, wo, exponent, scale: scale * blinn(wi, wo, exponent),
        lambda wi, wo, n, k: k * blinn(wi, wo, n),
        lambda wi, wo, k, exponent: k * blinn(wi, wo, exponent),  # one is known by its name
        lambda wi, wo, *, scale, n: scale * blinn(wi, wo, n),
        lambda wi, wo, **given: given["scale"] * blinn(wi, wo, given["exponent"]),
    ):
        here = Here(lambda wi, wo: blinn(wi, wo, 9.0) / 2, "f").bsdf()
        model = Here(function, "f").bsdf({"exponent": 9.0, "scale": 0.5})
        wi, wo = np.array([[0.6, 0.0, 0.8]]), np.array([[0.0, 0.6, 0.8]])
        assert model.evaluate(wi, wo) == pytest.approx(here.evaluate(wi, wo), rel=1e-15)
    found = judge.judge(
        Here(lambda wi, wo, n: blinn(wi, wo, n), "f"),
        np.random.default_rng(0),
        language="en",
        hints={},
        shown=False,
    )
    assert "unexpected keyword argument" in found.text


@pytest.mark.parametrize(
    ("function", "given", "passed"),
    [
        (lambda wi, wo, n: 0, {"exponent": 1}, {"n": 1}),
        (lambda wi, wo, exponent: 0, {"exponent": 1}, {"exponent": 1}),
        (lambda wi, wo, n, eps=0: 0, {"exponent": 1, "scale": 2}, {"n": 1, "eps": 2}),
        (lambda wi, wo, n, k, eps=0: 0, {"exponent": 1}, {"exponent": 1}),  # too few: left to Python to say
        (lambda wi, wo, n, /: 0, {"exponent": 1}, {"exponent": 1}),
        (lambda *directions: 0, {"exponent": 1}, {"exponent": 1}),
        (np.add, {"exponent": 1}, {"exponent": 1}),
        (5, {"exponent": 1}, {"exponent": 1}),
    ],
)
def test_parameters_are_taken_by_position_only_where_they_fit(function, given, passed):
    assert renamed(listed(function), given) == passed


# --------------------------------------------------------------------------------- words and arguments


def test_every_sentence_is_there_in_both_languages_with_the_same_blanks():
    for texts in (*LAW_SENTENCES.values(), *LAW_NAMES.values()):
        assert set(texts) == {"en", "ru"}
        blanks = [
            sorted({name.split("[")[0] for _, name, _, _ in string.Formatter().parse(text) if name})
            for text in texts.values()
        ]
        assert blanks[0] == blanks[1]


def test_an_excess_is_never_rounded_away():
    for excess in (0.075, 1e-5, 1.2e-9):
        assert float(share_of_light(1 + excess).split()[0]) > 100


@pytest.mark.parametrize(
    "wrong",
    [
        {"laws": ()},
        {"laws": ("sampling",)},
        {"expected": {"energy": "gains"}},
        {"laws": ("values",), "expected": {"energy": "violated"}},
        {"weights": {"energy": 0.0}},
        {"weights": {"energi": 1.0}},
        {"parameters": ()},
        {"least": 1.5},
        {"tolerance": -1.0},
    ],
)
def test_arguments_out_of_range_are_named(wrong):
    with pytest.raises(ParameterError, match=f"^{list(wrong)[-1]} = "):
        Laws(**wrong)


ODD = """
import numpy as np
turns = 0
def flat(wi, wo): return np.full(len(wi), 0.3)
def below(wi, wo): return flat(wi, wo)
def wide(wi, wo): return flat(wi, wo)
below.transmissive = wide.transmissive = True
below.eta, wide.eta = -1.5, 1e290
def huge(wi, wo): return np.full(len(wi), 1e308)
def turning(wi, wo):
    global turns
    turns += 1
    return flat(wi, wo) if turns % 2 else np.full((len(wi), 3), 0.3)
"""


def test_what_is_odd_costs_points_and_needs_no_person(tmp_path, coarse):
    """A judge that raises is looked at by a teacher: no function may make it."""
    (tmp_path / "theirs.py").write_text(ODD, encoding="utf-8")
    texts = {
        "below": "has eta = -1.5, which is no refractive index",
        "wide": "has eta = 1e+290, which is no refractive index",
        "huge": "Is too near the limit to tell: it reflects inf %",
        "turning": "returned shape",
    }
    with Sandbox(tmp_path / "theirs.py", limits=Limits(seconds=5.0)) as sandbox:
        for name, text in texts.items():
            found = Laws().judge(
                Isolated(sandbox, name), np.random.default_rng(0), language="en", hints={}, shown=True
            )
            assert found.share < 1
            assert text in found.text
