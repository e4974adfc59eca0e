"""Quadrature over the hemisphere and over rectangles, each with an error bound and a stated cost."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import check_above_zero, check_integration, vectors
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.box import bent, box
from radiokit.measure.converge import (
    FORGETFUL,
    GK21,
    MEMORY,
    ROUNDING,
    Integrand,
    RuleSum,
    adaptive,
    apply_rule,
    converge,
)
from radiokit.measure.curves import CURVES, Curve
from radiokit.measure.ladders import SLOPE_SIZES, SMOOTH_SIZES, SMOOTH_WIDTHS, SPLIT_SIZES, WIDTHS
from radiokit.measure.polar import POLAR_SIZES, LitRules, polar_rule
from radiokit.measure.scan import DOUBT, SCAN, look_over, missed
from radiokit.measure.slope import Lobe, find_lobe, mirrored, slope_map, slope_rule, turned
from radiokit.measure.split import kinked, split_rule

__all__ = ["box", "hemisphere"]

FloatArray = npt.NDArray[np.float64]

STEEPNESS = 0.01 * float(np.finfo(float).eps)
"""Rounding, relative to the sum of absolute terms, times the lobe's width and cosθo; at most 0.007 eps."""

THIN = 0.08
"""Lobes whose width is a smaller share of their length get panels of azimuth of their own."""

RULES = 130_000
"""Evaluations that product rules may always use; beyond it, a quarter of the budget."""

STEEP = 0.5
"""cosθo above which they do: a grazing lobe is long in slope without being so on the sphere."""

BROAD, BRIEF = 0.3, 20_000
"""Width above which a lobe is diffuse; evaluations in slope space after which polar rules are tried on it."""

CERTAIN = 1e-11
"""Relative agreement of polar rules that is believed: what they are cut for ends in digits, at once."""

HOPELESS = 1e-5
"""Relative difference of two rules of middle size that tells that larger ones will not be certain."""

LOOK = 512
"""Points at which the shape of a smooth lobe is looked at, where it may be long and narrow."""


def hemisphere(
    integrand: Integrand,
    *,
    wo: npt.ArrayLike = (0.0, 0.0, 1.0),
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    symmetric: bool = False,
    smooth: bool = False,
    edges: tuple[Curve, ...] = (),
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Integrate over the upper hemisphere: ∫ g(ω) dω, with nodes around the mirror direction of ``wo``.

    Rules of rising size and varying width are compared until they agree. When they do not, SciPy's
    adaptive cubature takes over in the same coordinates, twice and with different panels: the two runs
    must confirm each other. An unknown integrand is also scanned for mass between the nodes.

    The bound holds for integrands that are smooth up to the horizon, or have a kink; one that is a mere
    1e-4 rad from where a rough diffuse surface bends may be missed, which costs the square of that. Where
    jumps run
    through the hemisphere no finite number of evaluations can bound anything: there the error is an
    estimate, which about one integrand in a hundred exceeds (``tests/test_quadrature.py``).

    Parameters
    ----------
    integrand : callable
        Takes unit vectors (N, 3), returns (N,) or (N, K).
    wo : array_like, shape (3,)
        The direction whose mirror image the integrand may peak at; above the horizon.
    width : float, optional
        The lobe's width in slope (α of a microfacet model, 1 for a diffuse one); found when not given.
    rtol, atol : float
        The error may be ``max(atol, rtol |value|)``.
    symmetric : bool
        Whether the integrand is even in the azimuth relative to ``wo``.
    smooth : bool
        Whether the integrand is known to have no kink or jump, so that rules that agree a little are
        believed, and no scan is made.
    edges : tuple of Curve
        Where the integrand is known to bend, or to go as a root; bends elsewhere are looked for.
    max_evaluations : int
        A budget. The estimate says ``converged=False`` when it did not suffice.

    Returns
    -------
    Estimate
        Of kind "truncation", of shape () or (K,).

    Raises
    ------
    ParameterError
        When ``wo`` is not above the horizon, the integrand is not callable, ``width`` is not above 0, or a
        tolerance is negative.
    NonFiniteError
        When the integrand is NaN or infinite somewhere.

    >>> estimate = hemisphere(lambda w: w[:, 2], rtol=1e-12)
    >>> bool(abs(estimate.value - np.pi) <= estimate.error < 1e-11)
    True
    """
    start = time.perf_counter()
    check_integration(integrand, rtol=rtol, atol=atol)
    check_above_zero(width=width)
    above = "a direction of shape (3,) above the horizon (z > 0)"
    wo = vectors("wo", wo, above)
    if wo.ndim > 1 or not (np.all(np.isfinite(wo)) and wo[2] > 0):
        raise ParameterError("wo", wo.tolist(), above)
    spent = 0
    if width is not None:
        core = width
    else:
        lobe = find_lobe(integrand, wo)
        spent = lobe.evaluations
        if lobe.retro and max_evaluations - spent > 8 * SCAN:
            lobe = _confirmed(integrand, wo, lobe)
            spent += lobe.evaluations
        width, core = lobe.width, lobe.core
        if lobe.retro:
            original = integrand
            integrand = lambda w: original(turned(w))  # noqa: E731
    sides = 1 if symmetric else 2
    curves: tuple[Curve, ...] = ()
    scan, ridge = None, None
    if max_evaluations - spent > 2 * SCAN:
        if not smooth:
            curves, looked = kinked(integrand, wo, core)
            curves += edges
            if not curves and core >= BROAD:
                curves, more = kinked(lambda w: integrand(turned(w)), wo, core, CURVES[-1:])
                looked += more
                if curves:  # a lobe around wo that is too wide to be seen as one
                    straight = integrand
                    integrand = lambda w: straight(turned(w))  # noqa: E731
            scan = look_over(integrand, wo, core)
            spent += SCAN + looked
            ridge = None if symmetric else scan.ridge
        elif not symmetric:
            ridge = look_over(integrand, wo, core, LOOK).ridge
            spent += LOOK
    steep = wo[2] > STEEP and ridge is not None and ridge.ratio < THIN
    cut = bool(curves) or steep
    plain = (
        smooth and symmetric and not cut
    )  # a lobe that is alike on both sides, of which the width is known
    sizes, widths = (SMOOTH_SIZES, SMOOTH_WIDTHS) if plain else (SLOPE_SIZES, WIDTHS)
    sizes = SPLIT_SIZES if cut else sizes

    def rule(n: tuple[int, int], factor: float) -> tuple[FloatArray, FloatArray]:
        if cut:
            return split_rule(wo, width * factor, n, ridge=ridge, symmetric=symmetric, curves=curves)
        return slope_rule(wo, width * factor, n, symmetric=symmetric)

    def rules(most: int) -> Iterator[RuleSum]:
        most, used = min(most, max_evaluations - spent), 0
        for k, (n, factor) in enumerate(zip(sizes, widths, strict=False)):
            least = (1.5 if cut else 1.0) * sides * n[0] * n[1]
            if k > 2 and used + least > most:
                return
            wi, weight = rule(n, factor)
            used += len(wi)
            if k > 2 and used > most:
                return
            yield apply_rule(integrand, wi, weight)

    # A direction is known to an eps; a narrow lobe magnifies that, and a grazing one more.
    rounding = ROUNDING + STEEPNESS / (core * float(wo[2]))
    memory = FORGETFUL if plain else MEMORY
    compare = partial(converge, smooth=smooth, rounding=rounding, memory=memory)

    found: Estimate

    def slopes(most: int = max(RULES, max_evaluations // 4)) -> Estimate:  # the rest is for refinement
        return compare(rules(most), rtol, atol)

    def around(sums: Iterator[RuleSum]) -> Estimate:
        # Where they are cut in the right places they end in digits, at once; nothing less is believed.
        certain = min(atol, CERTAIN * float(np.min(np.abs(found.value))))
        return compare(hopeful(sums), min(rtol, CERTAIN), certain)

    def polar() -> Iterator[RuleSum]:
        return (apply_rule(integrand, *polar_rule(wo, n, symmetric=symmetric)) for n in POLAR_SIZES)

    def lit() -> Iterator[RuleSum]:
        ends, before = LitRules(integrand, wo, symmetric=symmetric), 0
        for n in POLAR_SIZES:
            one = apply_rule(integrand, *ends.rule(n))
            yield replace(one, points=one.points + ends.evaluations - before)
            before = ends.evaluations

    stages: list[tuple[str, Callable[[], Estimate]]] = [("slope-space quadrature", slopes)]
    if not smooth and core >= BROAD and max_evaluations >= 4 * BRIEF:
        stages = [(stages[0][0], lambda: slopes(BRIEF)), ("polar quadrature", lambda: around(polar()))]
        if scan is not None and scan.dark:
            stages.append(("polar quadrature", lambda: around(lit())))
        stages.append(("slope-space quadrature", slopes))
    method, first = stages[0]
    found = first()
    for name, stage in stages[1:]:
        if found.converged:
            break
        spent += found.evaluations
        method, found = name, stage()

    def lost() -> float:
        return 0.0 if scan is None else missed(found, scan.mean, scan.spread)

    budget = max_evaluations - found.evaluations - spent
    if (not found.converged or lost() > 0) and budget > 4 * GK21:

        def panels(scale: float) -> Integrand:
            def square(points: FloatArray) -> Any:
                wi, weight, _ = slope_map(wo, core * scale, points[:, 0], points[:, 1])
                if symmetric:
                    value = np.asarray(integrand(wi))
                else:
                    both = np.asarray(integrand(np.concatenate([wi, mirrored(wi, wo)])))
                    value = (both[: len(wi)] + both[len(wi) :]) / 2
                return (value.T * weight).T

            return square

        refined = adaptive(panels(1.0), bent(panels(1.0 / 3.0)), rtol, atol, budget // sides)
        evaluations = refined.evaluations * sides + found.evaluations
        if refined.converged or np.all(refined.error <= found.error):
            found, method = refined, "adaptive cubature in slope space"
        found = replace(found, evaluations=evaluations)
    unseen = lost()
    if unseen > 0:
        note = "a scan of the hemisphere found mass that the rules missed"
        found = replace(found, error=np.maximum(found.error, 2 * unseen), converged=False, note=note)
    return replace(
        found,
        evaluations=found.evaluations + spent,
        seconds=time.perf_counter() - start,
        method=method,
        note=found.note if found.note or found.converged else "the tolerance was not reached",
    )


def _confirmed(integrand: Integrand, wo: FloatArray, lobe: Lobe) -> Lobe:
    """Return the lobe around ``wo`` or that around its mirror direction, whichever is seen more evenly."""
    other = find_lobe(integrand, wo, around=(False,))
    there = look_over(lambda w: integrand(turned(w)), wo, lobe.core)
    here = look_over(integrand, wo, other.core)
    least = np.abs(there.mean) - DOUBT * there.spread
    blind = np.any(np.abs(here.mean) + DOUBT * here.spread < least)  # it looks even where nothing is seen
    best = other if not blind and np.max(here.spread) < np.max(there.spread) else lobe
    return replace(best, evaluations=other.evaluations + 2 * SCAN)


def hopeful(rules: Iterator[RuleSum]) -> Iterator[RuleSum]:
    """Go through rules until four of them do not look as if larger ones would be certain."""
    values: list[Any] = []
    for rule in rules:
        yield rule
        values.append(rule.value)
        if len(values) > 3 and np.any(np.abs(values[-1] - values[-2]) > HOPELESS * rule.size):
            return
