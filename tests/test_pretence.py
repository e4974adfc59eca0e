"""What looks right and is none: noise on a known value, and more samples than were asked for."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading.judges.estimator import Estimator
from radiokit.faces.grading.judges.exact import as_function
from radiokit.faces.grading.judges.pretence import pretence
from radiokit.faces.grading.judges.runs import gather
from radiokit.facts.errors import ParameterError

Function = Callable[..., Any]

QUESTIONS = ("furnace", "glossy", "window")
JUDGES: dict[str, list[Estimator]] = {
    question.name: [part.judge for part in question.parts if isinstance(part.judge, Estimator)]
    for question in rk.grading.load_assignment("shading").questions
    if question.name in QUESTIONS
}


def _furnace(u: Any, albedo: float) -> Any:
    return 2 * albedo * u[:, 0]


def _glossy(u: Any, n: float, zenith: float, side: float) -> Any:
    z = (1 - u[:, 0]) ** (1 / (n + 1))
    x = np.sqrt(np.maximum(1 - z * z, 0)) * np.cos(2 * np.pi * u[:, 1])
    return (n + 2) / (n + 1) * z * (zenith * z + side * (1 + x))


def _window(u: Any, distance: float, width: float, height: float) -> Any:
    y, z = (u[:, 0] - 0.5) * width, u[:, 1] * height
    return width * height * distance * z / (distance**2 + y**2 + z**2) ** 2


WEIGHTS: dict[str, Function] = {"furnace": _furnace, "glossy": _glossy, "window": _window}


def _mean(w: Any) -> Any:
    return w.mean(), w.std(ddof=1) / math.sqrt(len(w))


def estimator(name: str, estimate: Function) -> Function:
    """Return a student's function from ``estimate(weights of u (N, 2), samples, seed)``."""

    def function(*given: Any) -> Any:
        *inputs, samples, seed = given
        return estimate(lambda u: WEIGHTS[name](u, *inputs), samples, seed)

    return function


def plain(weights: Function, samples: int, seed: Any) -> Any:
    return _mean(weights(np.random.default_rng(seed).random((samples, 2))))


# Right ones, of every style


def _loop(weights: Function, samples: int, seed: int) -> Any:
    rng, total, square = random.Random(seed), 0.0, 0.0
    for _ in range(samples):
        (w,) = weights(np.array([[rng.random(), rng.random()]])).tolist()
        total, square = total + w, square + w * w
    mean = total / samples
    return mean, math.sqrt(max(square / samples - mean * mean, 0.0) / samples)


def _legacy(weights: Function, samples: int, seed: int) -> Any:
    w = weights(np.random.RandomState(seed).rand(samples, 2)).astype(np.float32)
    return w.mean(), w.std() / np.float32(samples) ** np.float32(0.5)


def _antithetic(weights: Function, samples: int, seed: int) -> Any:
    u = np.random.default_rng(seed).random((samples // 2, 2))
    return _mean((weights(u) + weights(1 - u)) / 2)


def _antithetic_pairs(weights: Function, samples: int, seed: int) -> Any:
    u = np.random.default_rng(seed).random((samples, 2))
    return _mean((weights(u) + weights(1 - u)) / 2)


def _cells(weights: Function, samples: int, seed: int, least: int = 1) -> Any:
    """Two samples in each cell of a square grid."""
    k = max(least, math.isqrt(samples // 2))
    cell = np.stack(np.meshgrid(range(k), range(k)), axis=-1).reshape(-1, 1, 2)
    u = (cell + np.random.default_rng(seed).random((k * k, 2, 2))) / k
    w = weights(u.reshape(-1, 2)).reshape(-1, 2)
    return w.mean(), math.sqrt(np.sum((w[:, 0] - w[:, 1]) ** 2)) / 2 / len(w)


def _strata(weights: Function, samples: int, seed: int) -> Any:
    return _cells(weights, samples, seed, least=0)  # 0/0 for one sample


def _lattices(weights: Function, samples: int, seed: int) -> Any:
    """Quasi-Monte Carlo: eight random shifts of a lattice, of one point at least."""
    rng, k = np.random.default_rng(seed), np.arange(max(1, samples // 8))
    points = np.stack([k / len(k), k * (math.sqrt(5) - 1) / 2], axis=-1)
    return _mean(np.array([weights((points + rng.random(2)) % 1).mean() for _ in range(8)]))


def _grid(weights: Function, samples: int, seed: int) -> Any:
    """One grid, shifted: in the furnace it deviates by one random number over √N."""
    k = math.isqrt(samples)
    cell = np.stack(np.meshgrid(range(k), range(k)), axis=-1).reshape(-1, 2)
    return _mean(weights((cell + np.random.default_rng(seed).random(2)) / k))


def _regression(weights: Function, samples: int, seed: int) -> Any:
    u = np.random.default_rng(seed).random((samples, 2))
    w, control = weights(u), u[:, 1] - 0.5
    return _mean(w - np.cov(w, control)[0, 1] / control.var(ddof=1) * control)


def _control(weights: Function, samples: int, seed: int) -> Any:
    u = np.random.default_rng(seed).random((samples, 2))
    return _mean(weights(u) - 0.3 * (u[:, 0] - 0.5))


def _importance(weights: Function, samples: int, seed: int) -> Any:
    u = np.random.default_rng(seed).random((samples, 2))
    u[:, 0] = np.sqrt(1 + 3 * u[:, 0]) - 1  # of the density (1 + u)/1.5
    return _mean(weights(u) * 1.5 / (1 + u[:, 0]))


def _batches(weights: Function, samples: int, seed: int) -> Any:
    w = weights(np.random.default_rng(seed).random((samples, 2)))
    batches = w[: samples // 16 * 16].reshape(16, -1).mean(axis=1)
    return w.mean(), batches.std(ddof=1) / 4


def _welford(weights: Function, samples: int, seed: int) -> Any:
    mean = square = 0.0
    for k, w in enumerate(weights(np.random.default_rng(seed).random((samples, 2))).tolist()):
        change = w - mean
        mean += change / (k + 1)
        square += change * (w - mean)
    return mean, math.sqrt(square / (samples - 1) / samples)  # ZeroDivisionError for one sample


def _convention(weights: Function, samples: int, seed: int) -> Any:
    value, error = plain(weights, samples, seed)
    return value, error if samples > 1 else abs(value) / 2


def _at_least(weights: Function, samples: int, seed: int) -> Any:
    return plain(weights, max(samples, 16), seed)


def _one_more(weights: Function, samples: int, seed: int) -> Any:
    return plain(weights, samples + 1, seed)


def _own_seed(weights: Function, samples: int, seed: int) -> Any:
    return plain(weights, samples, [seed, samples, 12345])


def _refuses(weights: Function, samples: int, seed: int) -> Any:
    if samples < 30:
        raise ValueError("too few samples")
    return plain(weights, samples, seed)


HONEST: dict[str, Function] = {
    "plain": plain,
    "a loop over Python's generator": _loop,
    "NumPy's old generator, float32": _legacy,
    "antithetic": _antithetic,
    "N antithetic pairs": _antithetic_pairs,
    "cells": _cells,
    "strata": _strata,
    "lattices": _lattices,
    "a control variate": _control,
    "a control variate by regression": _regression,
    "importance": _importance,
    "batches": _batches,
    "a running variance": _welford,
    "half the value as the error of one sample": _convention,
    "16 samples at least": _at_least,
    "one sample too many": _one_more,
    "a seed of its own": _own_seed,
    "not below 30 samples": _refuses,
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # one sample has no deviation
@pytest.mark.parametrize("style", HONEST)
@pytest.mark.parametrize("name", ["glossy", "window"])
def test_no_style_is_taken_for_pretence(name: str, style: str, seed: int, local_callee: Any) -> None:
    """Fifteen times for each, 540 in all: each alarm would be one too many."""
    judge, callee = JUDGES[name][0], local_callee(estimator(name, HONEST[style]))
    runs = gather(
        callee,
        np.random.default_rng(seed),
        inputs=judge.inputs,
        reference=as_function(judge.reference),
        cases=4,
        samples=64,
        runs=24,
        language="en",
        hints={},
    )
    for trial in range(15):
        rng = np.random.default_rng([seed, trial])
        found = pretence(callee, rng, runs, alike=judge.alike, counted=True, language="en")
        assert found == ("", ""), trial


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", QUESTIONS)
def test_a_shifted_grid_is_no_noise(name: str, rng: np.random.Generator, local_callee: Any) -> None:
    """Whatever it claims for an error, it is in step with itself in the furnace, in no ratio of noise."""
    judge, callee = JUDGES[name][0], local_callee(estimator(name, _grid))
    found = judge.judge(callee, rng, language="en", hints={}, shown=True)
    assert (found.share, found.diagnosis) == (1, ""), found.text


# And what pretends


@cache
def _deviation(name: str, inputs: tuple[float, ...]) -> float:
    u = (np.stack(np.meshgrid(range(20), range(20)), axis=-1).reshape(-1, 2) + 0.5) / 20
    return float(WEIGHTS[name](u, *inputs).std())


def invented(noise: Function) -> Callable[[str], Function]:
    """Return a question's exact value with ``noise(value, deviation of a sample, samples, seed)``."""

    def of(name: str) -> Function:
        exact = as_function(JUDGES[name][0].reference)

        def function(*given: Any) -> Any:
            *inputs, samples, seed = given
            return noise(float(exact(*inputs)), _deviation(name, tuple(inputs)), samples, seed)

        return function

    return of


def _normal(value: float, deviation: float, samples: int, seed: int) -> Any:
    error = deviation / math.sqrt(samples)
    return np.random.default_rng(seed).normal(value, error), error


def _with_uneven_errors(value: float, deviation: float, samples: int, seed: int) -> Any:
    rng, error = np.random.default_rng(seed), deviation / math.sqrt(samples)
    freedom = max(samples - 1, 1)
    return value + error * rng.standard_normal(), error * math.sqrt(rng.chisquare(freedom) / freedom)


def _uniform_in_float32(value: float, deviation: float, samples: int, seed: int) -> Any:
    error = deviation / math.sqrt(samples)
    noise = math.sqrt(3) * np.random.RandomState(seed).uniform(-1, 1)
    return np.float32(value + error * noise), np.float32(error)


def _over_root_of_one_less(value: float, deviation: float, samples: int, seed: int) -> Any:
    error = deviation / math.sqrt(max(samples - 1, 1))
    return random.Random(seed).gauss(value, error), error


def _made_up_samples(value: float, deviation: float, samples: int, seed: int) -> Any:
    return _mean(np.random.default_rng(seed).normal(value, deviation, samples))


def _after_samples_for_show(value: float, deviation: float, samples: int, seed: int) -> Any:
    rng, error = np.random.default_rng(seed), deviation / math.sqrt(samples)
    rng.random((samples, 2))
    return value + error * rng.standard_normal(), error


def multiplied(factor: int, estimate: Function = plain) -> Callable[[str], Function]:
    def function(weights: Function, samples: int, seed: int) -> Any:
        return estimate(weights, factor * samples, seed)

    return lambda name: estimator(name, function)


def uniform(factor: int) -> Callable[[str], Function]:
    """Return uniform directions for the glossy surface, so many more that they seem efficient."""

    def glossy(n: float, zenith: float, side: float, samples: int, seed: int) -> Any:
        z, turn = np.random.default_rng(seed).random((2, factor * samples))
        radiance = zenith * z + side * (1 + np.sqrt(1 - z * z) * np.cos(2 * np.pi * turn))
        return _mean((n + 2) * z ** (n + 1) * radiance)

    return lambda name: glossy


def _piloted(weights: Function, samples: int, seed: int) -> Any:
    rng = np.random.default_rng(seed)
    pilot = weights(rng.random((500, 2))).std()
    return weights(rng.random((samples, 2))).mean(), pilot / math.sqrt(samples)


INVENTED = dict.fromkeys(("value", "error", "efficiency"), "noise-invented")
TOO_MANY = dict.fromkeys(("value", "efficiency"), "too-many-samples")
PRETENDED: dict[str, tuple[Callable[[str], Function], tuple[str, ...], dict[str, str]]] = {
    # the function for a question, the questions, and the diagnosis of each aspect that is not right
    "normal noise": (invented(_normal), QUESTIONS, INVENTED),
    "noise with errors that vary": (invented(_with_uneven_errors), ("furnace",), INVENTED),
    "uniform noise in float32": (invented(_uniform_in_float32), ("glossy",), INVENTED),
    "noise of σ/√(N − 1)": (invented(_over_root_of_one_less), ("furnace",), INVENTED),
    "the mean of N made-up samples": (invented(_made_up_samples), ("glossy", "window"), INVENTED),
    "noise after samples for show": (invented(_after_samples_for_show), ("window",), INVENTED),
    "2 N": (multiplied(2), QUESTIONS, TOO_MANY),
    "10 N": (multiplied(10), QUESTIONS, TOO_MANY),
    "10 N in NumPy's old generator": (multiplied(10, _legacy), ("window",), TOO_MANY),
    "10 N antithetic": (multiplied(10, _antithetic), ("glossy", "window"), TOO_MANY),
    "10 N uniform directions": (uniform(10), ("glossy",), TOO_MANY),
    "20 N uniform directions": (uniform(20), ("glossy",), TOO_MANY),
    "500 samples for the error": (lambda name: estimator(name, _piloted), ("window",), TOO_MANY),
}


@pytest.mark.parametrize(
    ("case", "name"), [(case, name) for case in PRETENDED for name in PRETENDED[case][1]]
)
def test_what_pretends_is_told_and_earns_nothing(
    case: str, name: str, rng: np.random.Generator, local_callee: Any
) -> None:
    make, _, wrong = PRETENDED[case]
    callee = local_callee(make(name))
    for judge, language in zip(JUDGES[name], ("en", "ru", "ru"), strict=False):
        found = judge.judge(callee, rng, language=language, hints={}, shown=True)
        diagnosis = wrong.get(judge.aspect, "")
        assert (found.share, found.diagnosis) == (float(not diagnosis), diagnosis), (judge.aspect, found.text)
        assert (sum("а" <= letter <= "я" for letter in found.text) > 8) == (language == "ru")


def test_what_is_said_is_what_was_found(rng: np.random.Generator, local_callee: Any) -> None:
    told = {
        "normal noise": "at 64 and 128 samples are always in the ratio √2",
        "the mean of N made-up samples": "at different inputs are always in the same ratio",
        "10 N": "Even for a single sample you give a standard error",
    }
    for case, words in told.items():
        callee = local_callee(PRETENDED[case][0]("window"))
        found = JUDGES["window"][0].judge(callee, rng, language="en", hints={}, shown=True)
        assert words in found.text


def test_inputs_that_only_scale_may_deviate_alike(rng: np.random.Generator, local_callee: Any) -> None:
    """Which is why the furnace lets made-up samples pass, and cannot be told that inputs change its shape."""
    furnace, callee = JUDGES["furnace"][0], local_callee(estimator("furnace", plain))
    options: dict[str, Any] = {"inputs": furnace.inputs, "reference": furnace.reference}
    for alike, diagnosis in ((True, ""), (False, "noise-invented")):
        found = Estimator(**options, alike=alike).judge(callee, rng, language="en", hints={}, shown=True)
        assert found.diagnosis == diagnosis
    with pytest.raises(ParameterError, match="alike"):
        Estimator(reference=1.0, alike=False)


def test_equal_inputs_tell_nothing(rng: np.random.Generator, local_callee: Any) -> None:
    judge, given = JUDGES["window"][0], {"distance": 1.0, "width": 2.0, "height": 1.5}
    same = Estimator(inputs=lambda _: given, reference=judge.reference, alike=False)
    callee = local_callee(estimator("window", plain))
    assert same.judge(callee, rng, language="en", hints={}, shown=True).share == 1


def test_counts_of_few_hits_are_no_noise(seed: int, local_callee: Any) -> None:
    """Of a value that samples hit rarely, and alike for inputs that differ little."""

    def visible(part: float, samples: int, generator: int) -> Any:
        return _mean(1.0 * (np.random.default_rng(generator).random(samples) < part))

    judge = Estimator(
        inputs=lambda rng: {"part": rng.uniform(0.01, 0.012)}, reference=lambda part: part, alike=False
    )
    for trial in range(8):
        rng = np.random.default_rng([seed, trial])
        found = judge.judge(local_callee(visible), rng, language="en", hints={}, shown=True)
        assert found.share == 1, found.text


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_an_input_may_be_an_array(rng: np.random.Generator, local_callee: Any) -> None:
    def sky(rng: np.random.Generator) -> dict[str, Any]:
        return {"radiance": rng.uniform(0.5, 2.0, 7)}

    judge = Estimator(inputs=sky, reference=lambda radiance: radiance.mean(), alike=False)
    for factor, diagnosis in ((1, ""), (10, "too-many-samples")):

        def estimate(radiance: Any, samples: int, seed: int, factor: int = factor) -> Any:
            drawn = np.random.default_rng(seed).integers(7, size=factor * samples)
            return _mean(radiance[drawn])

        found = judge.judge(local_callee(estimate), rng, language="en", hints={}, shown=True)
        assert found.diagnosis == diagnosis, found.text
