"""Sampler: judges a function that samples directions, with the density that it claims."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal, get_args

import numpy as np

from radiokit.faces.grading.finding import Callee, Finding
from radiokit.faces.grading.isolation.protocol import Array
from radiokit.faces.grading.judges.directions import (
    ABOVE,
    ASKED,
    integral,
    moments,
    probes,
    uniform_density,
    uniform_variance,
    weighed_by,
)
from radiokit.faces.grading.judges.draws import Draws, Fit, cells_of_density, sampled, u_slip
from radiokit.faces.grading.judges.exact import no_inputs
from radiokit.faces.grading.judges.given import called, check_functions, check_shares, drawn
from radiokit.faces.grading.judges.runs import UnusableError
from radiokit.faces.grading.judges.runtests import each_level, settled
from radiokit.faces.grading.judges.samplewords import line, slip, tell
from radiokit.faces.grading.judges.suspects import behind_density
from radiokit.facts.errors import ParameterError
from radiokit.measure.slope import find_lobe
from radiokit.measure.statistics import bernstein_test

__all__ = ["Sampler", "SamplerAspect"]

SamplerAspect = Literal["distribution", "density", "efficiency"]

FITS = 1e-3
"""The p-value from which samples are said to follow another density than the one that is asked for."""


@dataclass(frozen=True, kw_only=True)
class Sampler:
    """Judges ``sample(u, *inputs) -> directions`` (N, 3) and, if it has a name, ``pdf(directions, *inputs)``.

    ``u`` (N, 2) holds random numbers in [0, 1); z is the normal. Both functions are handed arrays; if one
    cannot bear that, rows. What is judged is one aspect:

    - ``"distribution"``: unit vectors above the horizon, each from its own row of u, continuous in both of
      its numbers, that follow the density (chi-square);
    - ``"density"``: the claimed density is the one asked for, above and below the horizon;
    - ``"efficiency"``: the mean of f/p is the integral of f over the hemisphere, those of z f/p and
      (1 + x) f/p likewise, and the variance of f/p is at most 1/``factor`` of what uniform directions have;
      time counts only where it is out of all proportion.

    A right sampler is rejected at most once in 1.6e7 gradings: a test counts when it fails three times, each
    time with other random numbers.

    Parameters
    ----------
    density : callable
        ``density(directions, **inputs)`` gives the density that is asked for [sr⁻¹], (N,); 0 below the
        horizon, and 1 when it is integrated.
    inputs : callable, optional
        From a generator to further inputs by name, numbers, in the order of the parameters.
    aspect : {"distribution", "density", "efficiency"}
    pdf : str
        The name of the student's other function; needed but for ``"distribution"``.
    integrand : callable, optional
        f, as ``density`` is called, at least 0; needed for ``"efficiency"``.
    factor : float
        Above 1.
    samples : int
        For each of ``cases`` inputs, at least 4096.
    cases : int
        At least 1.
    rtol : float
        The relative error that is allowed in a density, in (0, 0.1); float32 has 1e-5.
    variants : mapping
        The densities that wrong samplers have, or give, by the misconception's name, called as ``density``.
    credit : mapping
        The share that a slip still earns, by its name.
    slowest : float
        Wall time of a sample [s], of the best call, above which no variance is efficient.

    Raises
    ------
    ParameterError
        When an argument is out of its range; while judging, when the integral of ``density`` is not 1.

    Examples
    --------
    >>> def cosine(directions):
    ...     return np.maximum(directions[:, 2], 0) / np.pi
    >>> Sampler(density=cosine, pdf="cosine_pdf", aspect="density").samples
    32768
    """

    density: Callable[..., Any]
    inputs: Callable[[np.random.Generator], Mapping[str, Any]] = no_inputs
    aspect: SamplerAspect = "distribution"
    pdf: str = ""
    integrand: Callable[..., Any] | None = None
    factor: float = 2.0
    samples: int = 1 << 15
    cases: int = 2
    rtol: float = 1e-4
    variants: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    credit: Mapping[str, float] = field(default_factory=lambda: {"u-torn": 0.5, "horizon-not-clamped": 0.5})
    slowest: float = 1e-3

    @property
    def needs(self) -> tuple[str, ...]:
        """The names of the further functions without which nothing is judged."""
        return () if self.aspect == "distribution" else (self.pdf,)

    def __post_init__(self) -> None:
        if self.aspect not in get_args(SamplerAspect):
            raise ParameterError("aspect", self.aspect, ", ".join(get_args(SamplerAspect)))
        if self.aspect != "distribution" and not self.pdf:
            raise ParameterError("pdf", self.pdf, f"the name of a function, to judge {self.aspect}")
        if self.aspect == "efficiency" and self.integrand is None:
            raise ParameterError("integrand", None, "a function, to judge efficiency")
        for name, least in (("samples", 4096), ("cases", 1)):
            value = getattr(self, name)
            if type(value) is not int or value < least:
                raise ParameterError(name, value, f"an integer of at least {least}")
        for name, low, high in (("factor", 1, math.inf), ("rtol", 0, 0.1), ("slowest", 0, math.inf)):
            if not low < getattr(self, name) < high:
                raise ParameterError(name, getattr(self, name), f"above {low} and below {high}")
        functions = {name: getattr(self, name) for name in ("density", "inputs", "integrand")}
        check_functions(functions, self.variants)
        check_shares("credit", self.credit)

    def judge(
        self,
        callee: Callee,
        rng: np.random.Generator,
        *,
        language: str,
        hints: Mapping[str, Mapping[str, str]],
        shown: bool,
    ) -> Finding:
        """Judge a sampler: right, or what is wrong with it and why."""
        ways = {
            "distribution": self._distribution,
            "density": self._density,
            "efficiency": self._efficiency,
        }
        found = Finding(share=1.0, text="")
        for _ in range(self.cases):
            given = drawn(self.inputs, rng, rows=False)
            draws = Draws(callee, self.pdf, given, language)
            try:
                found = ways[self.aspect](draws, rng, hints)
            except UnusableError as error:
                return error.finding
            if found.share < 1:
                return found
        return found

    def _distribution(
        self, draws: Draws, rng: np.random.Generator, hints: Mapping[str, Mapping[str, str]]
    ) -> Finding:
        language = draws.language
        cells = cells_of_density(partial(self._right, given=draws.inputs))
        level = each_level(len(Fit.TESTS) * self.cases)
        name = ""
        rounds: list[set[str]] = []
        while not settled(rounds):
            u = rng.random((self.samples, 2))
            fit = sampled(draws, cells, u, hints)
            name = name if rounds else u_slip(draws, u, fit.directions, rng)
            if name in ("rows-mixed", "u-unused"):
                return self._found(slip(language, name, hints), name=name)
            rounds.append({test for test, p in fit.p_values().items() if not p >= level})
            if not rounds[-1]:
                if name:
                    return self._found(slip(language, name, hints), name=name)
                return Finding(share=1.0, text=tell(language, "sampled", samples=self.samples))
        return self._mismatch(draws, fit, hints)

    def _mismatch(self, draws: Draws, fit: Fit, hints: Mapping[str, Mapping[str, str]]) -> Finding:
        """Say what samples follow that do not follow the density."""
        language = draws.language
        told = [tell(language, "no-match")]
        own = self._own(draws, fit)
        if own:
            told.append(tell(language, "consistent", function=self.pdf))
        for name, variant in {**self.variants, "uniform-instead": uniform_density}.items():
            density = partial(called, variant, given=draws.inputs, what=f"variants[{name!r}]")
            if min(fit.p_values(density).values()) > FITS:
                return self._found(slip(language, name, hints), *told, name=name)
        if fit.never() > 0.1:
            name = "quarter-only" if fit.lacks_azimuths() else "part-only"
            return self._found(slip(language, name, hints), *told, name=name)
        right = integral(lambda w: w[:, 2] * self._right(w, draws.inputs), fit.cells.width)
        mean = float(np.mean(fit.directions[:, 2]))
        told.append(tell(language, "cosine", value=f"{mean:.3f}", right=f"{right:.3f}"))
        return self._found(*told)

    def _own(self, draws: Draws, fit: Fit) -> bool:
        """Return whether the samples follow the density that is claimed."""
        if not self.pdf:
            return False
        try:
            return min(fit.p_values(draws.density).values()) > FITS
        except UnusableError:
            return False

    def _density(
        self, draws: Draws, rng: np.random.Generator, hints: Mapping[str, Mapping[str, str]]
    ) -> Finding:
        language = draws.language
        asked = partial(self._right, given=draws.inputs)
        cells = cells_of_density(asked)
        directions = probes(cells, rng)
        right = asked(directions)
        claimed = draws.claimed(directions)
        close = np.abs(claimed - right) <= self.rtol * right + 1e-9 * right.max()
        if close.all():
            return Finding(share=1.0, text=tell(language, "density"))
        told = tell(
            language,
            "density-wrong",
            bad=int(np.count_nonzero(~close)),
            count=ASKED,
            integral=f"{integral(draws.claimed, cells.width):.4g}",
        )
        known = {"uniform-instead": uniform_density, **self.variants}
        numbers = {key: value for key, value in draws.inputs.items() if value.ndim == 0}
        text, name, confidence = behind_density(
            claimed,
            right,
            inputs={**numbers, "cosine": directions[:, 2]},
            variants={
                key: called(each, directions, draws.inputs, f"variants[{key!r}]")
                for key, each in known.items()
            },
            rtol=self.rtol,
            language=language,
            hints=hints,
        )
        return self._found(text, told, name=name, confidence=confidence)

    def _efficiency(
        self, draws: Draws, rng: np.random.Generator, hints: Mapping[str, Mapping[str, str]]
    ) -> Finding:
        assert self.integrand is not None
        language = draws.language
        integrand = partial(called, self.integrand, given=draws.inputs, what="integrand")
        exact, uniform = uniform_variance(integrand)
        level = each_level(4 * self.cases)
        width = find_lobe(integrand, ABOVE, around=(False,)).width
        weighed = [integral(partial(weighed_by, k, integrand), width) for k in range(2)]
        rounds: list[set[str]] = []
        while not settled(rounds):
            directions = draws.sample(rng.random((self.samples, 2)))
            claimed = draws.density(directions)
            value = np.where(directions[:, 2] > 0, integrand(directions), 0.0)
            if (claimed[value > 0] == 0).any():
                raise UnusableError(
                    Finding(share=0.0, text=line(tell(language, "density-zero", function=self.pdf)))
                )
            weights = np.divide(value, claimed, out=np.zeros_like(value), where=claimed > 0)
            mean, variance = float(weights.mean()), float(weights.var())
            error = math.sqrt(float(np.mean(((weights - mean) ** 2 - variance) ** 2)) / self.samples)
            rounds.append({"weights", "variance", "moments"})
            if bernstein_test(weights, exact, 1e-6 * exact) >= level:
                rounds[-1].discard("weights")
            # a density that is made for the integrand alone has no variance, whatever is sampled
            tails = [
                bernstein_test(weights * each, right, 1e-4 * exact)
                for each, right in zip(moments(directions), weighed, strict=True)
            ]
            if min(tails) >= level:
                rounds[-1].discard("moments")
            if variance - 3 * error <= uniform / self.factor:
                rounds[-1].discard("variance")
            if not rounds[-1]:
                break
        failing = settled(rounds)
        measured = {"seconds_per_sample": draws.quickest}
        if variance > 0 and draws.quickest > 0:
            measured["efficiency"] = 1 / (variance * draws.quickest)
        if "weights" in failing:
            told = {"value": f"{mean:.4g}", "right": f"{exact:.4g}"}
            return Finding(share=0.0, text=line(tell(language, "weights", **told)), measured=measured)
        if "moments" in failing:
            return Finding(share=0.0, text=line(tell(language, "forged")), measured=measured)
        ratio = {"ratio": f"{variance / uniform:.1g}"}
        if "variance" in failing:
            text = tell(language, "inefficient", most=f"{1 / self.factor:.2g}", **ratio)
            found = self._found(slip(language, "inefficient", hints), text, name="inefficient")
            return replace(found, measured=measured)
        if draws.quickest > self.slowest:
            return Finding(share=0.0, text=line(tell(language, "slow")), diagnosis="slow", measured=measured)
        return Finding(share=1.0, text=tell(language, "efficient", **ratio), measured=measured)

    def _right(self, directions: Array, given: Mapping[str, Array]) -> Array:
        return called(self.density, directions, given=given)

    def _found(self, *text: str, name: str = "", confidence: float = 1.0) -> Finding:
        sure = round(confidence, 2) if name else 0.0
        return Finding(share=self.credit.get(name, 0.0), text=line(*text), diagnosis=name, confidence=sure)
