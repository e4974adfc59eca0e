"""The judge of samplers: right ones pass however they map the square, and each slip is named."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from radiokit.faces.grading.judges.draws import Draws, Fit, cells_of_density, sampled
from radiokit.faces.grading.judges.runtests import LEVEL, ROUNDS, each_level
from radiokit.faces.grading.judges.sampler import Sampler
from radiokit.facts.errors import ParameterError
from radiokit.measure.statistics import binomial_interval

Map = Callable[..., Any]


def _cosine(w: Any) -> Any:
    return np.maximum(w[:, 2], 0.0) / np.pi


def _lobe(w: Any, exponent: Any) -> Any:
    return (exponent + 1) / (2 * np.pi) * np.maximum(w[:, 2], 0.0) ** exponent


def _without_root(w: Any) -> Any:
    return _cosine(w) / (2 * np.maximum(np.hypot(w[:, 0], w[:, 1]), 1e-12))


def around(cosine: Any, turn: Any) -> Any:
    sine, phi = np.sqrt(np.maximum(1 - cosine**2, 0.0)), 2 * np.pi * turn
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=-1)


def polar(u: Any) -> Any:
    return around(np.sqrt(1 - u[:, 0]), u[:, 1])


def concentric(u: Any) -> Any:
    """Shirley and Chiu's map, which is no product of a radius and an azimuth."""
    a, b = (2 * u - 1).T
    wide = np.abs(a) > np.abs(b)
    radius = np.where(wide, a, b)
    ratio = np.where(wide, b, a) / np.where(radius == 0, 1.0, radius)
    phi = np.where(wide, np.pi / 4 * ratio, np.pi / 2 - np.pi / 4 * ratio)
    z = np.sqrt(np.maximum(1 - radius**2, 0.0))
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)


def _one_by_one(u: Any) -> Any:
    first, second = u
    radius, phi = math.sqrt(first), 2 * math.pi * second
    return [radius * math.cos(phi), radius * math.sin(phi), math.sqrt(1 - first)]


def _judge(aspect: Any = "distribution", **options: Any) -> Sampler:
    given: dict[str, Any] = {
        "density": _cosine,
        "pdf": "pdf",
        "variants": {"root-forgotten": _without_root} if aspect == "distribution" else {},
        "integrand": lambda w: np.maximum(w[:, 2], 0.0) * (1 + 0.5 * w[:, 0]),
        "cases": 1,
    }
    return Sampler(**(given | {"aspect": aspect} | options))


def _found(judge: Sampler, callee: Any, rng: np.random.Generator) -> Any:
    return judge.judge(callee, rng, language="en", hints={}, shown=True)


RIGHT: dict[str, Map] = {
    "polar": polar,
    "the other way round": lambda u: around(np.sqrt(u[:, 1]), -u[:, 0]),
    "concentric": concentric,
    "float32": lambda u: polar(u.astype(np.float32)).astype(np.float32),
    "lists": lambda u: polar(u).tolist(),
    "one by one": _one_by_one,
}


@pytest.mark.parametrize("name", RIGHT)
def test_a_right_sampler_passes(name: str, rng: np.random.Generator, local_callee: Any) -> None:
    function = RIGHT[name]
    pdf = (lambda w: max(w[2], 0.0) / math.pi) if name == "one by one" else _cosine
    callee = local_callee(function, {"pdf": pdf})
    for aspect in ("distribution", "density", "efficiency"):
        found = _found(_judge(aspect, samples=8192), callee, rng)
        assert found.share == 1, found.text


@pytest.mark.parametrize("exponent", [0.0, 1.0, 60.0, 3000.0])
def test_right_lobes_pass_however_narrow(
    exponent: float, rng: np.random.Generator, local_callee: Any
) -> None:
    callee = local_callee(
        lambda u, n: around(u[:, 0] ** (1 / (n + 1)), u[:, 1]), {"pdf": lambda w, n: _lobe(w, n)}
    )
    for aspect in ("distribution", "density"):
        judge = _judge(aspect, density=_lobe, variants={}, inputs=lambda rng: {"exponent": exponent})
        assert _found(judge, callee, rng).share == 1


@pytest.mark.parametrize("edge", [0.3, 0.8, 0.99])
def test_a_density_may_have_an_edge(edge: float, rng: np.random.Generator, local_callee: Any) -> None:
    def cone(w: Any) -> Any:
        return (w[:, 2] > edge) / (2 * np.pi * (1 - edge))

    draws = Draws(local_callee(lambda u: around(1 - (1 - edge) * u[:, 0], u[:, 1])), "", {}, "en")
    cells = cells_of_density(cone)
    lowest = [min(sampled(draws, cells, rng.random((1 << 15, 2)), {}).p_values().values()) for _ in range(6)]
    assert min(lowest) > 1e-4
    assert np.median(lowest) > 0.05
    assert _found(_judge(density=cone), draws.callee, rng).share == 1
    narrower = local_callee(lambda u: around(1 - 0.9 * (1 - edge) * u[:, 0], u[:, 1]))
    assert _found(_judge(density=cone), narrower, rng).share == 0


def test_a_density_that_is_none_is_the_teachers_fault(rng: np.random.Generator, local_callee: Any) -> None:
    judge = _judge(density=lambda w: np.maximum(w[:, 2], 0.0))
    with pytest.raises(ParameterError, match="integral 1 over the hemisphere"):
        _found(judge, local_callee(polar), rng)


WRONG: dict[str, tuple[Map, str, float]] = {
    "uniform": (lambda u: around(u[:, 0], u[:, 1]), "uniform-instead", 0.0),
    "no root": (lambda u: around(np.sqrt(1 - u[:, 0] ** 2), u[:, 1]), "root-forgotten", 0.0),
    "a quarter": (lambda u: around(np.sqrt(u[:, 0]), u[:, 1] / 4), "quarter-only", 0.0),
    "a half": (lambda u: around(np.sqrt(u[:, 0]), u[:, 1] / 2), "quarter-only", 0.0),
    "one number twice": (lambda u: around(np.sqrt(u[:, 0]), u[:, 0]), "u-unused", 0.0),
    "numbers of its own": (lambda u: polar(np.random.default_rng(0).random(u.shape)), "rows-mixed", 0.0),
    "sorted": (lambda u: polar(u[np.argsort(u[:, 0])]), "rows-mixed", 0.0),
    "torn": (lambda u: polar(100 * u % 1), "u-torn", 0.5),
    "a sphere": (lambda u: around(2 * u[:, 0] - 1, u[:, 1]), "below", 0.0),
    "a little off": (lambda u: around(u[:, 0] ** 0.46, u[:, 1]), "", 0.0),
    "crowded by 5 %": (lambda u: around(np.sqrt(u[:, 0]), u[:, 1] + 0.01 * np.sin(12 * u[:, 1])), "", 0.0),
    "not of unit length": (lambda u: 1.001 * polar(u), "", 0.0),
    "transposed": (lambda u: polar(u).T, "", 0.0),
    "NaN": (lambda u: polar(u) / (u[:, :1] > 0.5), "", 0.0),
    "raises": (lambda u: u.missing, "", 0.0),
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", WRONG)
def test_a_slip_of_a_sampler_is_named(name: str, rng: np.random.Generator, local_callee: Any) -> None:
    function, diagnosis, share = WRONG[name]
    texts = set()
    for language in ("en", "ru"):
        callee = local_callee(function, {"pdf": _cosine})
        found = _judge().judge(callee, rng, language=language, hints={}, shown=True)
        expected = "not-finite" if name == "NaN" else diagnosis
        assert (found.share, found.diagnosis) == (share, expected), found.text
        texts.add(found.text)
    assert len(texts) == 2 or name == "raises"


def test_a_sampler_that_follows_its_own_density_is_told_so(
    rng: np.random.Generator, local_callee: Any
) -> None:
    squared = {"pdf": lambda w: 1.5 * np.maximum(w[:, 2], 0.0) ** 2 / np.pi}
    sample = WRONG["uniform"][0]
    own = _found(_judge(), local_callee(lambda u: around(np.cbrt(u[:, 0]), u[:, 1]), squared), rng)
    not_own = _found(_judge(), local_callee(sample, squared), rng)
    assert own.share == not_own.share == 0
    assert "They do follow the density that pdf gives" in own.text
    assert "They do follow" not in not_own.text


DENSITIES: dict[str, tuple[Map, str, float]] = {
    "uniform": (lambda w: np.full(len(w), 0.5 / np.pi), "uniform-instead", 0.0),
    "no 1/π": (lambda w: np.maximum(w[:, 2], 0.0), "pdf-not-normalised", 0.0),
    "twice": (lambda w: 2 * _cosine(w), "pdf-not-normalised", 0.0),
    "squared": (lambda w: _cosine(w) * w[:, 2], "cosine-twice", 0.0),
    "not clamped": (lambda w: w[:, 2] / np.pi, "horizon-not-clamped", 0.5),
    "another": (lambda w: np.maximum(w[:, 2], 0.0) ** 1.1 / 3, "", 0.0),
    "absent": (lambda w: {}["pdf"], "", 0.0),
}


@pytest.mark.parametrize("name", DENSITIES)
def test_a_slip_of_a_density_is_named(name: str, rng: np.random.Generator, local_callee: Any) -> None:
    density, diagnosis, share = DENSITIES[name]
    found = _found(_judge("density"), local_callee(polar, {"pdf": density}), rng)
    assert (found.share, found.diagnosis) == (share, diagnosis), found.text
    assert name == "absent" or "its integral over the hemisphere is" in found.text


def test_efficiency_counts_variance_and_lets_time_be(rng: np.random.Generator, local_callee: Any) -> None:
    uniform, flat = WRONG["uniform"][0], DENSITIES["uniform"][0]
    for sample, pdf, seconds, expected in (
        (polar, _cosine, 0.0, ("", 1.0)),
        (polar, _cosine, 1.0, ("", 1.0)),
        (polar, _cosine, 1e3, ("slow", 0.0)),
        (uniform, flat, 0.0, ("inefficient", 0.0)),
        (polar, flat, 0.0, ("", 0.0)),
        (polar, lambda w: 0.9 * _cosine(w), 0.0, ("", 0.0)),
        (uniform, lambda w: _cosine(w) * (1 + 0.5 * w[:, 0]), 0.0, ("", 0.0)),  # f over its integral
        (polar, lambda w: _cosine(w) * (1 + 0.5 * w[:, 0]), 0.0, ("", 0.0)),
        (polar, lambda w: 0.0 * w[:, 2], 0.0, ("", 0.0)),
        (polar, lambda w: -_cosine(w), 0.0, ("", 0.0)),
    ):
        found = _found(_judge("efficiency"), local_callee(sample, {"pdf": pdf}, seconds), rng)
        assert (found.diagnosis, found.share) == expected, found.text
        assert "second" not in found.text


def test_a_density_that_is_forged_in_some_rounds_alone_is_forged(
    rng: np.random.Generator, local_callee: Any
) -> None:
    """Uniform directions are right and vary too much; weights that are forged are wrong and do not vary."""
    asked = [0]

    def pdf(w: Any) -> Any:
        asked[0] += 1
        forged = np.maximum(w[:, 2], 0.0) * (1 + 0.5 * w[:, 0])
        return np.full(len(w), 0.5 / np.pi) if asked[0] % 2 else forged

    judge = _judge("efficiency", integrand=lambda w: np.maximum(w[:, 2], 0.0) * (1 + 0.5 * w[:, 0]))
    found = _found(judge, local_callee(lambda u: around(u[:, 0], u[:, 1]), {"pdf": pdf}), rng)
    assert found.share == 0, found.text


@pytest.mark.parametrize("name", ["polar", "concentric"])
def test_false_alarms_are_as_rare_as_is_said(name: str, seed: int, local_callee: Any) -> None:
    """A test fails in one round with the probability of its level, so that three in a row are its cube."""
    trials, level = 200, 0.05
    draws = Draws(local_callee(RIGHT[name]), "", {}, "en")
    cells = cells_of_density(_cosine)
    fails = dict.fromkeys(Fit.TESTS, 0)
    for trial in range(trials):
        u = np.random.default_rng([seed, trial]).random((8192, 2))
        for test, p in sampled(draws, cells, u, {}).p_values().items():
            fails[test] += p < level
    for test, count in fails.items():
        assert binomial_interval(count, trials, 1 - 1e-4)[0] <= level, (test, count)
    assert len(Fit.TESTS) * each_level(len(Fit.TESTS)) ** ROUNDS <= 1.0001 * LEVEL


def test_five_per_cent_of_uniform_directions_are_always_found(seed: int, local_callee: Any) -> None:
    def mixed(u: Any) -> Any:
        share = 0.05
        rest = np.sqrt(np.clip((u[:, 0] - share) / (1 - share), 0, 1))
        return around(np.where(u[:, 0] < share, u[:, 0] / share, rest), u[:, 1])

    for trial in range(10):
        found = _found(_judge(), local_callee(mixed), np.random.default_rng([seed, trial]))
        assert found.share == 0


@pytest.mark.parametrize(
    "options",
    [
        {"aspect": "worth"},
        {"aspect": "density", "pdf": ""},
        {"aspect": "efficiency", "integrand": None},
        {"samples": 100},
        {"cases": 0},
        {"factor": 1.0},
        {"rtol": 0.5},
        {"credit": {"u-torn": 2}},
    ],
)
def test_wrong_arguments_of_a_sampler_are_named(options: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match=next(name for name in reversed(options))):
        _judge(**options)
