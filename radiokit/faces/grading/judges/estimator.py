"""Estimator: judges a Monte Carlo estimate with its standard error, by running it with many seeds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from radiokit.faces.grading.finding import Callee, Finding
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.exact import Reference, as_function, no_inputs
from radiokit.faces.grading.judges.given import check_functions, check_shares, number
from radiokit.faces.grading.judges.runs import FLOOR, Runs, UnusableError, gather
from radiokit.faces.grading.judges.runtests import (
    bias,
    claims,
    each_level,
    error_slip,
    excess,
    honest,
    rate,
    rate_slip,
    settled,
    swapped,
)
from radiokit.faces.grading.judges.samplewords import line, slip, tell
from radiokit.faces.grading.judges.suspects import behind_means
from radiokit.faces.grading.words import say
from radiokit.facts.errors import ParameterError

__all__ = ["Aspect", "Estimator"]

Aspect = Literal["value", "error", "efficiency"]


@dataclass(frozen=True, kw_only=True)
class Estimator:
    """Judges a function that estimates by sampling: ``f(*inputs, samples, seed) -> (value, standard_error)``.

    It is run with ``runs`` seeds for each of ``cases`` inputs at N = ``samples`` and at 4 N. Inputs without
    dimensions arrive as Python's numbers. What is judged is one aspect:

    - ``"value"``: the same seed gives the same answer and another seed another; the mean is right (Student's
      t for each input, and all together); four times as many samples halve the spread (variance ratios);
    - ``"error"``: the standard errors are the spread between seeds, neither less nor more (variance ratios);
      where the value is wrong, it must be so by a misconception that is known, and no constant;
    - ``"efficiency"``: the value is right, and the variance of one sample is at most ``budget``.

    Estimators without variance are right, unless ``exact`` is False. A right estimator whose runs are nearly
    normal is rejected at most once in 1.6e7 gradings; see ``LEVEL``, ``ROUNDS`` and ``MOST``.

    What cannot be told from answers: whether the exact value was computed and given noise and an error that
    suit each other, and whether more than N samples were drawn, as time is bounded only by ``slowest``. Where
    that matters, read the code, or ask for a `Sampler`, whose random numbers are the judge's.

    Parameters
    ----------
    reference : callable, Case or float
        ``reference(**inputs)`` gives the exact value, which is not 0; or a closed-form case, or the value.
    inputs : callable, optional
        From a generator to the inputs by name, numbers or arrays, in the order of the parameters, without
        ``samples`` and ``seed``; none by default.
    aspect : {"value", "error", "efficiency"}
    samples : int
        N, at least 64.
    runs : int
        Seeds, at least 8.
    cases : int
        Inputs, at least 1; misconceptions are told apart only by inputs that differ.
    context : callable, optional
        ``context(**inputs)`` gives further inputs to the diagnosis, numbers by the names that it knows, such
        as ``pdf``, ``theta``, ``distance``.
    variants : mapping
        What wrong solutions give on average, by the misconception's name: ``{name: f(**inputs)}``.
    credit : mapping
        The share that a slip still earns, by its name: ``{"samples-ignored": 0.5}``.
    budget : callable, optional
        ``budget(**inputs)`` gives the largest variance of one sample that is efficient; needed for that
        aspect. What a right solution has should be smaller by a half or more.
    uniform : callable, optional
        ``uniform(**inputs)`` gives the variance of uniform sampling, to which the text compares.
    exact : bool
        Whether the exact value without variance is right: False where nothing that samples can have it.
    noise : float
        The largest deviation of one sample, by the value, that is no mere noise; above 0.
    slowest : float
        Wall time of a sample [s] above which no variance is efficient, for the best of all runs. Loops in
        Python take some 1e-5.

    Raises
    ------
    ParameterError
        When an argument is out of its range.

    Examples
    --------
    >>> def albedos(rng):
    ...     return {"albedo": rng.uniform(0.2, 1.0)}
    >>> judge = Estimator(inputs=albedos, reference=lambda albedo: albedo, aspect="error")
    >>> judge.cases * judge.runs * 2
    192
    """

    reference: Reference
    inputs: Callable[[np.random.Generator], Mapping[str, Any]] = no_inputs
    aspect: Aspect = "value"
    samples: int = 256
    runs: int = 24
    cases: int = 4
    context: Callable[..., Mapping[str, Any]] | None = None
    variants: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    credit: Mapping[str, float] = field(default_factory=dict)
    budget: Callable[..., float] | None = None
    uniform: Callable[..., float] | None = None
    exact: bool = True
    noise: float = 20.0
    slowest: float = 1e-3

    def __post_init__(self) -> None:
        as_function(self.reference)
        if self.aspect not in get_args(Aspect):
            raise ParameterError("aspect", self.aspect, ", ".join(get_args(Aspect)))
        for name, least in (("samples", 64), ("runs", 8), ("cases", 1)):
            value = getattr(self, name)
            if type(value) is not int or value < least:
                raise ParameterError(name, value, f"an integer of at least {least}")
        functions = ("inputs", "context", "budget", "uniform")
        check_functions({name: getattr(self, name) for name in functions}, self.variants)
        check_shares("credit", self.credit)
        if self.aspect == "efficiency" and (self.budget is None or self.uniform is None):
            raise ParameterError("budget, uniform", None, "variances, where efficiency is judged")
        for name in ("noise", "slowest"):
            if not 0 < getattr(self, name) < math.inf:
                raise ParameterError(name, getattr(self, name), "a finite number above 0")

    def judge(
        self,
        callee: Callee,
        rng: np.random.Generator,
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        """Judge an estimator: right, or what is wrong with it and why."""
        rounds: list[set[str]] = []
        while not settled(rounds):
            try:
                runs = gather(
                    callee,
                    rng,
                    inputs=self.inputs,
                    reference=as_function(self.reference),
                    cases=self.cases,
                    samples=self.samples,
                    runs=self.runs,
                    language=language,
                    hints=hints,
                )
            except UnusableError as error:
                return error.finding
            if not rounds:
                measured = {"seconds_per_sample": runs.seconds}
            with np.errstate(all="ignore"):  # values may be of any size
                tests = dict(self._tests(runs))
            level = each_level(len(tests))
            rounds.append({name for name, p in tests.items() if not p >= level})
            if (runs.exact and not self.exact) or (runs.frozen and not runs.exact):
                rounds[-1].add("frozen")
            if not rounds[-1]:
                return self._right(runs, language, measured)
        with np.errstate(all="ignore"):
            return self._wrong(
                runs, settled(rounds), language=language, hints=hints, shown=shown, measured=measured
            )

    def _tests(self, runs: Runs) -> Iterator[tuple[str, float]]:
        """Yield the tests of this aspect, and their p-values."""
        yield "noise", 1.0 if runs.noise <= self.noise else 0.0
        one, together = bias(runs)
        yield "bias", together
        yield "bias at one", one
        if self.aspect == "value":
            yield "rate", rate(runs)
        elif self.aspect == "error":
            yield "honest", honest(runs, slice(None))
            halves = [honest(runs, slice(k, k + 2)) for k in range(0, len(runs.right), 2)]
            yield "honest at one", min(1.0, min(halves) * len(halves))
        else:
            yield "variance", excess(runs, self._given(self.budget, runs))
            yield "time", 0.0 if runs.seconds > self.slowest else 1.0

    def _given(self, function: Callable[..., float] | None, runs: Runs) -> Array:
        assert function is not None
        what = "budget" if function is self.budget else "uniform"
        return np.array([number(function, inputs, what) for inputs in runs.inputs])

    def _right(self, runs: Runs, language: str, measured: dict[str, float]) -> Finding:
        if self.aspect == "efficiency":
            variance, ratio = runs.samples * runs.variances, self._ratio(runs)
            if float(np.mean(variance)) > 0 and runs.seconds > 0:
                measured["efficiency"] = 1 / (float(np.mean(variance)) * runs.seconds)
            text = tell(language, "efficient", ratio=f"{ratio:.1g}")
            return Finding(
                share=1.0, text=tell(language, "no-variance") if ratio < FLOOR else text, measured=measured
            )
        if runs.exact and (runs.errors <= runs.floor[:, None]).all():
            return Finding(share=1.0, text=tell(language, "exact"), measured=measured)
        key = "unbiased" if self.aspect == "value" else "honest"
        return Finding(share=1.0, text=tell(language, key, runs=runs.values.size), measured=measured)

    def _ratio(self, runs: Runs) -> float:
        """Return the variance of one sample, of what uniform sampling has; its geometric mean."""
        shares = runs.samples * (runs.variances + 1e-300) / self._given(self.uniform, runs)
        return float(np.exp(np.mean(np.log(shares))))

    def _wrong(
        self,
        runs: Runs,
        failing: set[str],
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
        measured: Mapping[str, float],
    ) -> Finding:
        def found(*text: str, name: str = "", confidence: float = 1.0) -> Finding:
            share = self.credit.get(name, 0.0)
            rounded = round(confidence, 2) if name else 0.0
            return Finding(
                share=share, text=line(*text), diagnosis=name, confidence=rounded, measured=measured
            )

        if "noise" in failing:
            told = f"{runs.noise:.2g}" if math.isfinite(runs.noise) else "∞"
            return found(
                slip(language, "noise-only", hints), tell(language, "noise", ratio=told), name="noise-only"
            )
        if runs.exact and not self.exact:
            return found(slip(language, "not-sampled", hints), name="not-sampled")
        if not runs.values.any() and runs.right.any():
            return found(say(language, "zero"), name="constant-answer")
        frozen = runs.frozen and not runs.exact
        biased = any(name.startswith("bias") for name in failing)
        if biased and swapped(runs):
            return found(slip(language, "error-first", hints), name="error-first")
        why, about, sure = self._value(runs, language, hints, shown) if biased or frozen else ([], "", 0.0)
        if frozen and not about:
            return found(slip(language, "seed-reused", hints), name="seed-reused")
        if self.aspect == "error":
            if why and (runs.constant or not about):  # some misconception leads to any constant
                return found(tell(language, "wrong-value"), *why)
            if not any(name.startswith("honest") for name in failing):
                return self._right(runs, language, dict(measured))
            name = error_slip(runs)
            ratio = math.exp(float(claims(runs)[0].mean()) / 2)
            told = "" if name in ("error-zero", "sample-repeated") else f"{ratio:.2g}"
            return found(slip(language, name, hints), told and tell(language, "ratio", ratio=told), name=name)
        if why:
            first = [tell(language, "biased-first")] if self.aspect == "efficiency" else []
            return found(*first, *why, name=about, confidence=sure)
        if self.aspect == "value":
            name = rate_slip(runs)
            return found(slip(language, name, hints), name=name)
        if "variance" not in failing:
            return found(tell(language, "slow"), name="slow")
        shares = self._given(self.budget, runs) / self._given(self.uniform, runs)
        most = f"{float(np.exp(np.mean(np.log(shares)))):.2g}"
        told = tell(language, "inefficient", ratio=f"{self._ratio(runs):.2g}", most=most)
        return found(slip(language, "inefficient", hints), told, name="inefficient")

    def _value(
        self, runs: Runs, language: str, hints: Mapping[str, Mapping[str, str]], shown: bool
    ) -> tuple[list[str], str, float]:
        """Return what is wrong with the mean of the values, by which misconception, and how sure that is."""
        worst = int(np.argmax(np.abs(runs.means - runs.right) / np.maximum(runs.floor, 1e-300)))
        count = runs.values.shape[1]
        told = {"inputs": runs.brief(worst), "runs": count, "value": f"{runs.means[worst]:.4g}"}
        seen = tell(language, "biased-shown", right=f"{runs.right[worst]:.4g}", **told)
        if not shown:
            ratio = f"{float(np.mean(runs.means / runs.right)):.4g}"
            seen = tell(language, "biased", runs=runs.values.size, ratio=ratio)
        why, name, sure = behind_means(
            runs,
            reference=as_function(self.reference),
            variants=self.variants,
            context=self.context,
            language=language,
            hints=hints,
        )
        return [*filter(None, [why]), seen], name, sure
