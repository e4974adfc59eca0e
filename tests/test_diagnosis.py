"""Diagnosis: every misconception is found where it is planted, and no one else is accused."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.diagnosis.catalogue import CATALOGUE
from radiokit.faces.diagnosis.misconception import constant
from radiokit.faces.diagnosis.result import TEXTS

ENTRIES = {entry.name: entry for entry in CATALOGUE}
COUNT = 24


@dataclass
class World:
    """Lit patches: E = I cos θ/d², and all that may be known of them."""

    inputs: dict[str, Any]
    E: np.ndarray


def directions(rng: np.random.Generator, cosine: np.ndarray) -> np.ndarray:
    phi, sine = 2 * np.pi * rng.random(cosine.size), np.sqrt(1 - cosine**2)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1)


@pytest.fixture
def world(rng: np.random.Generator) -> World:
    cosine = rng.uniform(0.1, 0.95, COUNT)
    distance = rng.uniform(0.5, 4, COUNT)
    inputs = {
        "theta": np.arccos(cosine),
        "distance": distance,
        "cosine_light": rng.uniform(0.1, 0.95, COUNT),
        "area": rng.uniform(0.1, 5, COUNT),
        "solid_angle": rng.uniform(0.01, 0.5, COUNT),
        "pdf": rng.uniform(0.05, 3, COUNT),
        "samples": rng.integers(10, 300, COUNT),
        "exponent": rng.uniform(1, 60, COUNT),
        "wi": directions(rng, cosine),
        "wo": directions(rng, rng.uniform(0.1, 0.95, COUNT)),
    }
    return World(inputs, rng.uniform(1, 50, COUNT) * cosine / distance**2)


def h(i: dict[str, Any]) -> Any:
    return np.linalg.norm(i["wi"] + i["wo"], axis=1)


# What each misconception makes of E, written here from its meaning and not from the catalogue.
FACTORS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "pi-too-many": lambda i: math.pi,
    "pi-too-few": lambda i: 1 / math.pi,
    "pi-multiplied": lambda i: math.pi**2,
    "doubled": lambda i: 2,
    "halved": lambda i: 0.5,
    "four-too-many": lambda i: 4,
    "four-too-few": lambda i: 0.25,
    "four-pi-too-many": lambda i: 4 * math.pi,
    "four-pi-too-few": lambda i: 0.25 / math.pi,
    "two-pi-too-many": lambda i: 2 * math.pi,
    "two-pi-too-few": lambda i: 0.5 / math.pi,
    "sign-flipped": lambda i: -1,
    "lumens-for-watts": lambda i: 683,
    "watts-for-lumens": lambda i: 1 / 683,
    "degrees-given": lambda i: 57.29577951308232,
    "radians-given": lambda i: 0.017453292519943295,
    "thousand-too-many": lambda i: 1000,
    "thousand-too-few": lambda i: 0.001,
    "per-metre-of-wavelength": lambda i: 1e9,
    "per-nanometre-of-wavelength": lambda i: 1e-9,
    "square-centimetres": lambda i: 1e4,
    "percent": lambda i: 100,
    "pi-rounded": lambda i: 3.14 / math.pi,
    "cosine-forgotten": lambda i: 1 / np.cos(i["theta"]),
    "cosine-twice": lambda i: np.cos(i["theta"]),
    "sine-for-cosine": lambda i: np.tan(i["theta"]),
    "sine-forgotten": lambda i: 1 / np.sin(i["theta"]),
    "sine-twice": lambda i: np.sin(i["theta"]),
    "degrees-for-radians": lambda i: np.cos(i["theta"] * 180 / math.pi) / np.cos(i["theta"]),
    "distance-not-squared": lambda i: i["distance"],
    "distance-forgotten": lambda i: i["distance"] ** 2,
    "distance-cubed": lambda i: 1 / i["distance"],
    "distance-squared-twice": lambda i: i["distance"] ** -2.0,
    "distance-doubled": lambda i: i["distance"] / 2,
    "intensity-for-irradiance": lambda i: i["distance"] ** 2 / np.cos(i["theta"]),
    "intensity-for-radiance": lambda i: i["area"] * np.cos(i["theta"]),
    "flux-for-irradiance": lambda i: i["area"],
    "solid-angle-forgotten": lambda i: 1 / i["solid_angle"],
    "solid-angle-twice": lambda i: i["solid_angle"],
    "pdf-forgotten": lambda i: i["pdf"],
    "pdf-divided-twice": lambda i: 1 / i["pdf"],
    "pdf-multiplied": lambda i: i["pdf"] ** 2,
    "pdf-of-area": lambda i: i["distance"] ** 2 / i["cosine_light"],
    "light-cosine-forgotten": lambda i: 1 / i["cosine_light"],
    "sum-for-mean": lambda i: i["samples"],
    "divided-by-samples-twice": lambda i: 1 / i["samples"],
    "one-sample-off": lambda i: i["samples"] / (i["samples"] - 1),
    "lobe-normalisation": lambda i: 4 * (i["exponent"] + 2) / (i["exponent"] + 8),
    "viewer-cosine-forgotten": lambda i: 1 / i["wo"][:, 2],
    "viewer-cosine-twice": lambda i: i["wo"][:, 2],
    "microfacet-denominator": lambda i: 4 * i["wi"][:, 2] * i["wo"][:, 2],
    "pdf-of-half-vector": lambda i: 4 * np.sum(i["wo"] * (i["wi"] + i["wo"]), axis=1) / h(i),
    "half-vector-not-normalised": h,
    "half-vector-not-normalised-in-lobe": lambda i: h(i) ** i["exponent"],
}

STRUCTURES: dict[str, Callable[[np.ndarray], Any]] = {
    "square-root": np.sqrt,
    "squared": lambda E: E * E,
    "logarithm": np.log10,
    "reciprocal": lambda E: 1 / E,
    "one-minus": lambda E: 1 - E,
    "gamma-encoded": lambda E: E ** (1 / 2.2),
    "clipped": lambda E: np.minimum(E, 1),
    "normalised-to-one": lambda E: E / E.max(),
    "running-sum": np.cumsum,
    "truncated-to-integer": lambda E: E.astype(int),
    "rounded": lambda E: [round(float(x), 3) for x in E],
    "sorted": np.sort,
    "reversed": lambda E: E[::-1],
    "shifted": lambda E: np.concatenate([[0.0], E[:-1]]),
    "constant-answer": lambda E: np.full(E.size, 1.2345),
    "offset": lambda E: E + 0.1,
    "permuted": lambda E: E[np.arange(E.size) ^ 1],
    "wrong-at-few": lambda E: np.where(np.arange(E.size) % 10 == 3, 7.77 + np.arange(E.size), E),
}
ELSEWHERE = {
    "directions-swapped",
    "angle-unit",
    "horizon-not-clamped",
    "absolute-value",
    "single-precision",
    "seed-reused",
    "not-finite",
}


def assert_found(found: rk.Diagnosis, name: str) -> None:
    assert not found.right
    assert found.first is not None, str(found)
    assert found.first.name == name, str(found)
    assert found.first.confidence > 0.8, str(found)
    assert found.first.message == ENTRIES[name].en
    assert not found.ambiguous


def test_every_entry_is_planted_somewhere():
    assert {*FACTORS, *STRUCTURES} | ELSEWHERE == set(rk.list_misconceptions())
    assert len(ENTRIES) == len(CATALOGUE) >= 30


@pytest.mark.parametrize("name", FACTORS)
def test_a_planted_factor_is_found(world, name):
    factor = FACTORS[name](world.inputs)
    found = rk.diagnose(world.E * factor, world.E, inputs=world.inputs)
    assert_found(found, name)
    assert found.first.factor == pytest.approx(np.median(np.broadcast_to(factor, COUNT)), rel=1e-9)


@pytest.mark.parametrize("name", [name for name in FACTORS if name not in ("pi-rounded", "one-sample-off")])
def test_a_planted_factor_is_found_in_sampled_answers(world, rng, name):
    answer = world.E * FACTORS[name](world.inputs)
    error = 1e-3 * np.abs(answer)
    found = rk.diagnose(answer + error * rng.normal(size=COUNT), world.E, inputs=world.inputs, error=error)
    assert_found(found, name)


@pytest.mark.parametrize("name", STRUCTURES)
def test_a_planted_structure_is_found(world, name):
    assert_found(rk.diagnose(STRUCTURES[name](world.E), world.E, inputs=world.inputs), name)


def test_swapped_directions_are_found_by_the_function_and_by_the_pairs(world):
    def brdf(wi, wo, **_):
        return 0.2 + wi[:, 2] ** 2 * wo[:, 2]

    wi, wo = world.inputs["wi"], world.inputs["wo"]
    given = {"wi": wi, "wo": wo}
    assert_found(rk.diagnose(brdf(wo, wi), brdf(wi, wo), inputs=given, variants=brdf), "directions-swapped")
    both = {"wi": np.concatenate([wi, wo]), "wo": np.concatenate([wo, wi])}
    right, wrong = brdf(**both), brdf(both["wo"], both["wi"])
    assert_found(rk.diagnose(wrong, right, inputs=both), "directions-swapped")
    named = rk.diagnose(
        brdf(wo, wi), brdf(wi, wo), inputs=given, variants={"directions-swapped": brdf(wo, wi)}
    )
    assert_found(named, "directions-swapped")


def test_an_angle_in_degrees_is_found_by_the_function(rng):
    theta = rng.uniform(0, 1.4, COUNT)

    def reference(theta):
        return 0.3 + np.cos(theta) ** 3

    found = rk.diagnose(
        reference(np.degrees(theta)), reference(theta), inputs={"theta": theta}, variants=reference
    )
    assert_found(found, "angle-unit")
    assert found.first.detail == "degrees"


def test_a_variant_by_a_name_of_its_own_is_found(world):
    found = rk.diagnose(world.E**1.5, world.E, variants={"power of 1.5": world.E**1.5, "cube": world.E**3})
    assert found.first.name == "power of 1.5"
    assert found.first.message == "Your numbers are those of this variant: power of 1.5."


@pytest.mark.parametrize(
    ("wrong", "detail"), [(lambda c: c, "< 0"), (np.abs, "> 0")], ids=["negative", "positive"]
)
def test_a_missing_clamp_is_found(rng, wrong, detail):
    cosine = rng.uniform(-1, 1, 40)
    found = rk.diagnose(3 * wrong(cosine), 3 * np.maximum(cosine, 0), inputs={"cosine": cosine})
    assert_found(found, "horizon-not-clamped")
    assert found.first.detail == detail


def test_answers_of_zero_are_a_constant(world):
    assert_found(rk.diagnose(np.zeros(COUNT), world.E, inputs=world.inputs), "constant-answer")


def test_right_answers_with_large_errors_say_what_they_may_hide(world):
    found = rk.diagnose(world.E, world.E, error=0.5 * world.E)
    assert found.right
    assert "halved" in found.notes[0]
    assert not rk.diagnose(world.E, world.E, error=0.01 * world.E).notes


def test_an_absolute_value_is_found(rng):
    signed = rng.normal(size=COUNT)
    assert_found(rk.diagnose(np.abs(signed), signed), "absolute-value")


def test_single_precision_is_named_only_where_more_is_asked(world):
    rounded = world.E.astype(np.float32).astype(float)
    lenient = rk.diagnose(rounded, world.E)
    assert lenient.right
    assert not lenient
    assert lenient.notes == (TEXTS["en"]["float32"],)
    assert_found(rk.diagnose(rounded, world.E, rtol=1e-12), "single-precision")


def test_answers_that_ignore_their_seed_are_found_even_if_they_are_right():
    seeds = np.arange(8)
    found = rk.diagnose(np.full(8, 1.01), np.ones(8), error=0.01, inputs={"seed": seeds})
    assert_found(found, "seed-reused")
    differing = 1 + 0.01 * np.cos(seeds)
    assert rk.diagnose(differing, np.ones(8), error=0.01, inputs={"seed": seeds}).right


def test_lost_answers_are_listed_and_the_rest_is_diagnosed(world):
    answer = 2 * world.E
    answer[[3, 7]] = np.nan, np.inf
    found = rk.diagnose(answer, world.E, inputs=world.inputs)
    assert_found(found, "not-finite")
    assert found.first.detail == "[3, 7]"
    assert found.suspicions[1].name == "doubled"
    answer = world.E.copy()
    answer[5] = np.nan
    found = rk.diagnose(answer, world.E)
    assert_found(found, "not-finite")
    assert len(found.suspicions) == 1
    assert_found(rk.diagnose(np.full(COUNT, np.nan), world.E, inputs=world.inputs), "not-finite")


def test_wrong_answers_keep_their_numbers_beside_lost_ones(world):
    answer = world.E.copy()
    answer[2], answer[9] = np.nan, 100.0
    details = {s.name: s.detail for s in rk.diagnose(answer, world.E).suspicions}
    assert details == {"not-finite": "[2]", "wrong-at-few": "[9]"}


@pytest.mark.parametrize(
    "give",
    [
        lambda E: E,
        lambda E: E.tolist(),
        lambda E: E.astype(np.float32),
        lambda E: [float(math.fsum([x / 3] * 3)) for x in E],
        lambda E: tuple(np.float32(x) for x in E),
        lambda E: E * (1 + 3e-7),
    ],
    ids=["array", "list", "float32", "loop", "float32 scalars", "3.14159 and the like"],
)
def test_right_answers_are_not_accused(world, give):
    found = rk.diagnose(give(world.E), world.E, inputs=world.inputs)
    assert found.right
    assert not found
    assert str(found).startswith("agrees to within")


def test_right_sampled_answers_are_accused_no_oftener_than_the_level_says(rng):
    runs, theta = 300, np.linspace(0.1, 1.4, COUNT)
    reference, error = np.cos(theta), 0.02 * np.cos(theta)
    accused = sum(
        bool(
            rk.diagnose(
                reference + error * rng.normal(size=COUNT), reference, error=error, inputs={"theta": theta}
            )
        )
        for _ in range(runs)
    )
    # z's own level is 1 %: the binomial's tail beyond 15 of 300 has probability 1e-7.
    assert accused <= 15


@pytest.mark.parametrize("error", [None, 0.01, 0.3])
def test_noise_is_not_accused(world, rng, error):
    for _ in range(40):
        answer = rng.lognormal(0, 1, COUNT)
        spread = None if error is None else error * answer
        found = rk.diagnose(answer, world.E, inputs=world.inputs, error=spread)
        assert not found, str(found)
        assert not found.right
        assert found.summary == "no known misconception fits"


@pytest.mark.parametrize("count", [1, 2])
def test_few_noisy_answers_accuse_nobody(rng, count):
    for _ in range(40):
        answer = rng.lognormal(3, 1, count)
        assert not rk.diagnose(answer, np.ones(count), error=0.3 * answer, inputs={"cosine": 0.4})


CONFUSABLE = [
    ("cosine-forgotten", "doubled", {"cosine": 0.5}),
    ("distance-not-squared", "distance-forgotten", {"distance": 1 + 1e-8}),
    ("distance-forgotten", "four-too-many", {"distance": 2.0}),
    ("sum-for-mean", "thousand-too-many", {"samples": 1000}),
    ("solid-angle-forgotten", "two-pi-too-few", {"solid_angle": 2 * math.pi}),
    ("pdf-forgotten", "pi-too-few", {"pdf": 1 / math.pi}),
]


@pytest.mark.parametrize(("varies", "rival", "still"), CONFUSABLE, ids=[pair[0] for pair in CONFUSABLE])
def test_confusable_pairs_are_told_apart_only_where_the_inputs_vary(world, varies, rival, still):
    (name,) = still
    factor = FACTORS[varies]({**world.inputs, **still, "theta": math.acos(min(still.get("cosine", 1), 1))})
    if rival != "distance-forgotten":  # at d = 1 both are right
        found = rk.diagnose(world.E * factor, world.E, inputs=still)
        assert {varies, rival} <= set(found.ambiguous)
        assert found.first.confidence <= 0.5
        assert "cannot tell between" in str(found)
        assert name in found.notes[-1]
    for planted in (varies, rival):
        answer = world.E * FACTORS[planted](world.inputs)
        assert_found(rk.diagnose(answer, world.E, inputs=world.inputs), planted)


def test_a_factor_whose_input_does_not_vary_is_said_to_be_any_constant(world):
    found = rk.diagnose(world.E / 0.7, world.E, inputs={"cosine": 0.7})
    assert found.first.name == "cosine-forgotten"
    assert found.first.confidence <= 0.5
    assert any("any constant factor of 1.429" in note for note in found.notes)


def test_two_at_once_are_found_only_where_no_single_one_fits(world):
    answer = math.pi * world.E / np.cos(world.inputs["theta"])
    found = rk.diagnose(answer, world.E, inputs=world.inputs)
    assert found.first.name == "pi-too-many + cosine-forgotten"
    assert found.first.confidence > 0.8
    assert found.first.message.startswith("Two things at once. Your answer is π times too large")
    single = rk.diagnose(2 * world.E, world.E, inputs=world.inputs)
    assert all("+" not in suspicion.name for suspicion in single.suspicions)


def test_an_unnamed_constant_is_noted(world):
    found = rk.diagnose(1.37 * world.E, world.E)
    assert not found
    assert found.notes == ("the answer is 1.37 times the reference at all inputs",)


@pytest.mark.parametrize("entry", CATALOGUE, ids=lambda entry: entry.name)
def test_both_languages_say_it_in_whole_sentences(entry):
    for text in (entry.en, entry.ru):
        assert len(text) > 20
        assert text.endswith(".")
        assert not {"{", "}"} & set(text)
    assert entry.en != entry.ru
    assert any("а" <= letter <= "я" for letter in entry.ru.lower())
    assert not any("а" <= letter <= "я" for letter in entry.en.lower())


def test_hints_differ_from_each_other():
    assert len({entry.en for entry in CATALOGUE}) == len({entry.ru for entry in CATALOGUE}) == len(CATALOGUE)
    assert TEXTS["en"].keys() == TEXTS["ru"].keys()


def test_a_diagnosis_is_said_in_russian_html_and_json(world):
    found = rk.diagnose(2 * world.E, world.E, language="ru")
    assert str(found).startswith("ответ отличается от верного")
    assert found.first.message == ENTRIES["doubled"].ru
    assert "<code>doubled</code>" in found._repr_html_()
    data = json.loads(json.dumps(found.to_json()))
    assert data["suspicions"][0]["factor"] == 2
    assert data["deviation"] == pytest.approx(1)
    assert "{" not in str(found)
    markup = rk.diagnose([1.0, 2.0], [3.0, 4.0], variants={"<b>": [1.0, 2.0]})
    assert "<b> " not in markup._repr_html_().replace("<b>the", "")


def blinn(wi, wo, n=40.0, *, scale=1.0):
    half = wi + wo
    return scale * (half[..., 2] / np.linalg.norm(half, axis=-1)) ** n


def test_a_function_is_diagnosed_beside_a_model():
    def right(wi, wo):
        return blinn(wi, wo, scale=48 / (8 * math.pi))

    def student(**changes):
        return lambda wi, wo: blinn(wi, wo, **{"scale": 48 / (8 * math.pi), **changes})

    assert rk.diagnose_function(lambda wi, wo: float(right(wi, wo)), right).right
    assert_found(rk.diagnose_function(student(scale=3 / math.pi), right), "halved")
    found = rk.diagnose_function(lambda wi, wo: right(wi, wo) * wi[..., 2], right)
    assert_found(found, "cosine-twice")
    assert not rk.diagnose_function(student(n=41.0), right)


def test_a_model_of_the_package_is_diagnosed_beside_another():
    model = rk.bsdf("lafortune", exponent=20.0)
    assert rk.diagnose_function(model, model).right
    ggx = rk.bsdf("ggx", alpha=0.3)
    assert_found(
        rk.diagnose_function(lambda wi, wo: ggx(wi, wo) * 4 * wi[..., 2] * wo[..., 2], ggx),
        "microfacet-denominator",
    )
    with pytest.raises(rk.errors.ParameterError, match="one wavelength"):
        rk.diagnose_function(ggx, rk.bsdf("lambert", reflectance=(0.2, 0.5)))
    with pytest.raises(rk.errors.ParameterError, match="count"):
        rk.diagnose_function(ggx, ggx, count=1)


def test_an_unnormalised_half_vector_is_found_in_a_function():
    model = rk.bsdf("blinn_phong", exponent=12.0)

    def stretched(wi, wo):
        return model(wi, wo) * np.linalg.norm(wi + wo, axis=-1) ** 12.0

    assert_found(rk.diagnose_function(stretched, model), "half-vector-not-normalised-in-lobe")


def test_a_wrong_normalisation_is_named_though_one_exponent_cannot_prove_it():
    asked, given = (rk.bsdf("blinn_phong", exponent=12.0, normalization=name) for name in ("exact", "n+8"))
    found = rk.diagnose_function(given, asked)
    assert found.first.name == "lobe-normalisation"
    assert found.first.detail == "(n+8)/(8π) ≠ (n+2)(n+4)/(8π(2^(-n/2)+n))"
    assert found.first.confidence <= 0.5
    assert found.notes[-1] == "inputs that differ in exponent would tell"


def test_swapped_directions_are_found_in_a_function():
    def brdf(wi, wo):
        return 0.2 + wi[..., 2] ** 2 * wo[..., 2]

    assert_found(rk.diagnose_function(lambda wi, wo: brdf(wo, wi), brdf), "directions-swapped")
    reciprocal = rk.bsdf("ashikhmin_shirley")
    assert rk.diagnose_function(lambda wi, wo: reciprocal(wo, wi), reciprocal).right


def test_other_packages_add_their_own(world):
    mine = constant("dozen", 12, "You counted in dozens.", "Вы считали дюжинами.")
    assert not rk.diagnose(12 * world.E, world.E)
    found = rk.diagnose(12 * world.E, world.E, catalogue=(*CATALOGUE, mine))
    assert found.first.message == "You counted in dozens."


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"answer": [1.0]}, "answer"),
        ({"answer": [[1.0, 2.0]]}, "answer"),
        ({"answer": ["a", "b"]}, "answer"),
        ({"answer": [1.0, [2.0, 3.0]]}, "answer"),
        ({"answer": []}, "answer"),
        ({"reference": [1.0, math.nan]}, "reference"),
        ({"inputs": {"theta": [1, 2, 3]}}, "theta"),
        ({"inputs": {"pdf": math.inf}}, "pdf"),
        ({"variants": {"cube": [1.0]}}, "cube"),
        ({"variants": lambda theta: 1.0, "inputs": {"theta": 0.5}}, "variants"),
        ({"error": -1.0}, "error"),
        ({"error": [1.0, 2.0, 3.0]}, "error"),
        ({"rtol": 0.5}, "rtol"),
        ({"language": "de"}, "language"),
    ],
)
def test_bad_input_is_named(arguments, message):
    given = {"answer": [1.0, 2.0], "reference": [1.0, 3.0], **arguments}
    with pytest.raises(rk.errors.ParameterError, match=message):
        rk.diagnose(given.pop("answer"), given.pop("reference"), **given)
