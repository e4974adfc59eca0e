"""The judge of estimators: right ones pass however they are written, and each slip is named."""

from __future__ import annotations

import math
from collections.abc import Callable
from string import Formatter
from typing import Any

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading.judges.estimator import Aspect, Estimator
from radiokit.faces.grading.judges.runs import gather
from radiokit.faces.grading.judges.runtests import LEVEL, ROUNDS, each_level
from radiokit.faces.grading.judges.samplewords import SENTENCES, SLIPS
from radiokit.faces.grading.words import words
from radiokit.facts.errors import ParameterError

Weights = Callable[[np.random.Generator, int], Any]


def _albedo(rng: np.random.Generator) -> dict[str, Any]:
    return {"albedo": rng.uniform(0.2, 1.0)}


def _judge(aspect: Aspect = "value", **options: Any) -> Estimator:
    given: dict[str, Any] = {
        "inputs": _albedo,
        "reference": lambda albedo: albedo,
        "variants": {"cosine-forgotten": lambda albedo: 2 * albedo},
        "uniform": lambda albedo: albedo**2 / 3,
        "budget": lambda albedo: albedo**2 / 6,
    }
    return Estimator(**(given | {"aspect": aspect} | options))


def _error(weights: Any) -> float:
    return float(weights.std(ddof=1) / math.sqrt(len(weights)))


def estimator(
    weights: Weights = lambda rng, count: 2 * rng.random(count), error: Callable[[Any], float] = _error
) -> Callable[..., Any]:
    """Return an estimator of the albedo from weights of mean 1; uniform directions by default."""

    def estimate(albedo: float, samples: int, seed: int) -> Any:
        drawn = albedo * weights(np.random.default_rng(seed), samples)
        return drawn.mean(), error(drawn)

    return estimate


furnace = estimator()


def times(factor: float) -> Callable[..., Any]:
    def estimate(albedo: float, samples: int, seed: int) -> Any:
        value, error = furnace(albedo, samples, seed)
        return factor * value, factor * error

    return estimate


def _listed(albedo: float, samples: int, seed: int) -> Any:
    import random

    rng = random.Random(seed)
    weights = [2 * albedo * rng.random() for _ in range(samples)]
    mean = sum(weights) / samples
    return [mean, math.sqrt(sum((each - mean) ** 2 for each in weights)) / samples]


RIGHT: dict[str, Callable[..., Any]] = {
    "uniform": furnace,
    "population deviation": estimator(error=lambda w: w.std() / math.sqrt(len(w))),
    "no variance": estimator(lambda rng, count: np.ones(count)),
    "no variance in float32": estimator(lambda rng, count: np.ones(count, np.float32) / 3 * 3),
    "float32": lambda *given: tuple(map(np.float32, furnace(*given))),
    "a loop and a list": _listed,
    "a sharp lobe": estimator(lambda rng, count: 101 * rng.random(count) ** 100),
    "a log-normal": estimator(lambda rng, count: np.exp(1.2 * rng.standard_normal(count) - 0.72)),
    "two values": estimator(lambda rng, count: 100.0 * (rng.random(count) < 0.01)),
    "antithetic pairs": estimator(
        lambda rng, count: np.add(*(lambda u: (u, 1 - u**2 * 1.5))(rng.random(count))),
        error=_error,
    ),
}


@pytest.mark.parametrize("aspect", ["value", "error"])
@pytest.mark.parametrize("name", RIGHT)
def test_a_right_estimator_passes(
    name: str, aspect: Aspect, rng: np.random.Generator, local_callee: Any
) -> None:
    for language in ("en", "ru"):
        found = _judge(aspect).judge(local_callee(RIGHT[name]), rng, language=language, hints={}, shown=True)
        assert found.share == 1, found.text


def _constant_seed(albedo: float, samples: int, seed: int) -> Any:
    return furnace(albedo, samples, 1)


def _no_seed(albedo: float, samples: int, seed: int) -> Any:
    return furnace(albedo, samples, None)


def _one_sample(albedo: float, samples: int, seed: int) -> Any:
    drawn = np.full(samples, 2 * albedo * np.random.default_rng(seed).random())
    return drawn.mean(), _error(drawn)


def _fixed_samples(albedo: float, samples: int, seed: int) -> Any:
    return furnace(albedo, 1000, seed)


def _few_samples(albedo: float, samples: int, seed: int) -> Any:
    return furnace(albedo, int(samples**0.5), seed)


def _sum(albedo: float, samples: int, seed: int) -> Any:
    value, error = furnace(albedo, samples, seed)
    return samples * value, samples * error


def _noise(albedo: float, samples: int, seed: int) -> Any:
    return 3 + np.random.default_rng(seed).random(), 0.3


def _zero(albedo: float, samples: int, seed: int) -> Any:
    error = 500 / math.sqrt(samples)
    return error * np.random.default_rng(seed).standard_normal(), error


WRONG: dict[str, tuple[Callable[..., Any], str | None, str | None]] = {
    # the function, the diagnosis of its value, that of its error; None where that part is right
    "1/N forgotten": (_sum, "sum-for-mean", None),
    "pdf forgotten": (times(1 / (2 * math.pi)), "two-pi-too-few", None),
    "divided by pi": (times(1 / math.pi), "pi-too-few", None),
    "cosine forgotten": (times(2.0), "cosine-forgotten", None),
    "cosine forgotten, exactly": (lambda a, n, s: (2 * a, 0.0), "cosine-forgotten", None),
    "some noise": (_noise, "", ""),
    "honest noise about 0": (_zero, "noise-only", "noise-only"),
    "noise that overflows": (
        lambda a, n, s: (1e200 * np.random.default_rng(s).standard_normal(), 1e200),
        "noise-only",
        "noise-only",
    ),
    "some percent": (times(1.06), "", ""),
    "a constant seed": (_constant_seed, "seed-reused", "seed-reused"),
    "no seed": (_no_seed, "not-repeatable", "not-repeatable"),
    "one sample N times": (_one_sample, "sample-repeated", "sample-repeated"),
    "N ignored": (_fixed_samples, "samples-ignored", None),
    "σ": (estimator(error=lambda w: w.std()), None, "deviation-for-error"),
    "σ²/N": (estimator(error=lambda w: w.var() / len(w)), None, "variance-for-error"),
    "σ²": (estimator(error=lambda w: w.var()), None, "sample-variance-for-error"),
    "σ/N": (estimator(error=lambda w: w.std() / len(w)), None, "error-divided-by-samples"),
    "σ√N": (estimator(error=lambda w: w.std() * len(w) ** 0.5), None, "error-of-sum"),
    "1.96 σ/√N": (estimator(error=lambda w: 1.96 * _error(w)), None, "interval-for-error"),
    "half": (estimator(error=lambda w: 0.5 * _error(w)), None, "error-too-small"),
    "four thirds": (estimator(error=lambda w: 4 / 3 * _error(w)), None, "error-too-large"),
    "an error where there is none": (lambda a, n, s: (a, 0.1), None, "error-too-large"),
    "no error": (estimator(error=lambda w: 0.0), None, "error-zero"),
    "NaN": (lambda a, n, s: (math.nan, 0.0), "not-finite", "not-finite"),
    "negative": (lambda a, n, s: (a, -1.0), "", ""),
    "one number": (lambda a, n, s: (a,), "", ""),
    "three numbers": (lambda a, n, s: (a, 0.0, 1.0), "", ""),
    "raises": (lambda a, n, s: 1 / 0, "", ""),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_slip_is_named_and_costs_its_own_part(
    name: str, rng: np.random.Generator, local_callee: Any
) -> None:
    function, *diagnoses = WRONG[name]
    for aspect, diagnosis in zip(("value", "error"), diagnoses, strict=True):
        texts = set()
        for language in ("en", "ru"):
            found = _judge(aspect).judge(
                local_callee(function), np.random.default_rng(5), language=language, hints={}, shown=True
            )
            assert (found.share, found.diagnosis) == (float(diagnosis is None), diagnosis or ""), found.text
            texts.add(found.text)
        assert len(texts) == 2
        assert all(texts)


def test_every_sentence_has_its_words_in_both_languages() -> None:
    fields = Formatter()
    for key, sentence in {**SENTENCES, **SLIPS}.items():
        assert words(key, sentence)
        english, russian = (
            {each[1] for each in fields.parse(sentence[name])} - {None} for name in ("en", "ru")
        )
        assert english == russian, key
        assert key not in SLIPS or (sentence["en"].endswith(".") and sentence["ru"].endswith("."))


def test_hints_and_credit_of_the_question_count(local_callee: Any) -> None:
    judge = _judge("error", credit={"deviation-for-error": 0.25})
    found = judge.judge(
        local_callee(WRONG["σ"][0]),
        np.random.default_rng(0),
        language="en",
        hints={"deviation-for-error": {"en": "Mind the root.", "ru": "Не забудьте корень."}},
        shown=True,
    )
    assert found.share == 0.25
    assert found.text.startswith("Mind the root.")


def test_what_is_hidden_is_not_told(local_callee: Any) -> None:
    for shown in (True, False):
        found = _judge().judge(
            local_callee(times(1.06)), np.random.default_rng(0), language="en", hints={}, shown=shown
        )
        assert ("right is" in found.text) == shown


def test_a_closed_form_case_may_be_the_reference(local_callee: Any) -> None:
    judge = Estimator(reference=rk.case("lambert-in-furnace"), cases=2)  # of reflectance 0.5
    for factor, diagnosis in ((1.0, ""), (math.pi, "pi-too-many")):

        def estimate(samples: int, seed: int, factor: float = factor) -> tuple[float, float]:
            weights = factor * np.random.default_rng(seed).random(samples)  # f cos θ / p = ρ/π cos θ 2π
            return float(weights.mean()), float(weights.std(ddof=1)) / math.sqrt(samples)

        found = judge.judge(
            local_callee(estimate), np.random.default_rng(0), language="en", hints={}, shown=True
        )
        assert (found.share, found.diagnosis) == (float(not diagnosis), diagnosis)


def test_where_nothing_exact_can_be_sampled_the_exact_value_is_no_estimate(
    rng: np.random.Generator, local_callee: Any
) -> None:
    for function, diagnosis in ((RIGHT["no variance"], "not-sampled"), (furnace, "")):
        found = _judge(exact=False).judge(local_callee(function), rng, language="en", hints={}, shown=True)
        assert (found.diagnosis, found.share) == (diagnosis, float(not diagnosis))


@pytest.mark.parametrize("answer", [(1.0, 0.0), (-1.0, 5e-324), (1e155, 0.0), (1.0, 1e-3)])
def test_no_constant_is_honest(answer: Any, rng: np.random.Generator, local_callee: Any) -> None:
    """Some misconception always leads to it, and it has no spread: it would earn the part for nothing."""
    value, error = answer
    callee = local_callee(
        lambda albedo, samples, seed: (value + error * np.random.default_rng(seed).normal(), error)
    )
    found = _judge("error").judge(callee, rng, language="en", hints={}, shown=True)
    assert found.share == 0
    assert "no standard error is honest" in found.text


def test_efficiency_is_a_matter_of_variance(rng: np.random.Generator, local_callee: Any) -> None:
    better = estimator(lambda rng, count: 0.8 + 0.4 * rng.random(count))
    cases = {
        (better, 1e-6): ("", 1.0),
        (RIGHT["no variance"], 1e-6): ("", 1.0),
        (furnace, 1e-6): ("inefficient", 0.0),
        (times(0.5), 1e-6): ("halved", 0.0),
        (better, 10.0): ("slow", 0.0),
    }
    for (function, seconds), expected in cases.items():
        found = _judge("efficiency").judge(
            local_callee(function, seconds=seconds), rng, language="en", hints={}, shown=True
        )
        assert (found.diagnosis, found.share) == expected, found.text
        assert "seconds_per_sample" in found.measured
        assert "second" not in found.text


def test_an_error_that_falls_too_slowly_is_told_from_one_that_does_not_fall(
    rng: np.random.Generator, local_callee: Any
) -> None:
    found = _judge(runs=96).judge(local_callee(_few_samples), rng, language="en", hints={}, shown=True)
    assert (found.share, found.diagnosis) == (0, "error-not-falling")


def test_the_same_generator_gives_the_same_finding(seed: int, local_callee: Any) -> None:
    first, second = (
        _judge().judge(
            local_callee(times(1.06), seconds=seconds),
            np.random.default_rng(seed),
            language="en",
            hints={},
            shown=True,
        )
        for seconds in (1e-6, 2e-6)
    )
    assert (first.share, first.text, first.confidence) == (second.share, second.text, second.confidence)


@pytest.mark.parametrize(("name", "slack"), [("uniform", 1.0), ("a sharp lobe", 1.0), ("a log-normal", 2.5)])
def test_false_alarms_are_as_rare_as_is_said(name: str, slack: float, seed: int, local_callee: Any) -> None:
    """A test fails in one round with the probability of its level, so that three in a row are its cube."""
    from radiokit.measure.statistics import binomial_interval

    trials, level = 100, 0.05
    fails: dict[str, int] = {}
    judges = [_judge("value"), _judge("error")]
    for trial in range(trials):
        runs = gather(
            local_callee(RIGHT[name]),
            np.random.default_rng([seed, trial]),
            inputs=_albedo,
            reference=lambda albedo: albedo,
            cases=3,
            samples=64,
            runs=12,
            language="en",
            hints={},
        )
        for test, p in {test: p for judge in judges for test, p in judge._tests(runs)}.items():
            fails[test] = fails.get(test, 0) + (p < level)
    assert set(fails) == {"noise", "bias", "bias at one", "rate", "honest", "honest at one"}
    for test, count in fails.items():
        assert binomial_interval(count, trials, 1 - 1e-4)[0] <= slack * level, (test, count)
    assert 4 * each_level(4) ** ROUNDS <= 1.0001 * LEVEL


def test_right_solutions_are_not_rejected(seed: int, local_callee: Any) -> None:
    for trial in range(60):
        for aspect in ("value", "error"):
            found = _judge(aspect, samples=64, runs=8, cases=2).judge(
                local_callee(furnace),
                np.random.default_rng([seed, trial]),
                language="en",
                hints={},
                shown=True,
            )
            assert found.share == 1, (trial, found.text)


@pytest.mark.parametrize("aspect", ["value", "error", "efficiency"])
def test_what_is_wrong_in_another_way_in_each_round_is_wrong(
    aspect: Aspect, rng: np.random.Generator, local_callee: Any
) -> None:
    """Mere noise has no bias, and a number that is wrong has no noise: each fails what the other passes."""
    judge, calls = _judge(aspect, samples=64, runs=8, cases=2), [0]
    memory: dict[Any, Any] = {}

    def sly(*asked: Any) -> Any:
        turn = calls[0] // (2 * judge.cases * (judge.runs + 1))
        calls[0] += 1
        error = 1 / math.sqrt(asked[-2])
        off = np.random.default_rng(asked[-1]).normal() * error
        return memory.setdefault(asked, (7 + off, error) if turn % 2 else (1e4 * off, 1e4 * error))

    found = judge.judge(local_callee(sly), rng, language="en", hints={}, shown=True)
    assert found.share == 0, found.text
    assert calls[0] > ROUNDS * 2 * judge.cases * judge.runs


def test_a_bias_of_five_per_cent_is_always_found(seed: int, local_callee: Any) -> None:
    for trial in range(5):
        for factor in (0.95, 1.05):
            found = _judge().judge(
                local_callee(times(factor)),
                np.random.default_rng([seed, trial]),
                language="en",
                hints={},
                shown=True,
            )
            assert found.share == 0


@pytest.mark.parametrize(
    "options",
    [
        {"aspect": "worth"},
        {"samples": 32},
        {"runs": 2},
        {"cases": 0},
        {"credit": {"biased": 2}},
        {"aspect": "efficiency", "budget": None},
        {"slowest": 0.0},
        {"noise": math.nan},
    ],
)
def test_wrong_arguments_are_named(options: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match=next(name for name in reversed(options))):
        _judge(**options)
