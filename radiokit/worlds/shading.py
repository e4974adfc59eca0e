"""Shading: the radiance that a material sends to the viewer, by the cheapest method that can say it."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.occluder import Occluder
from radiokit.facts.estimate import Estimate
from radiokit.measure.montecarlo import seed_from
from radiokit.worlds.budget import Budget, Purse
from radiokit.worlds.integral import integrate, patience
from radiokit.worlds.plan import Plan
from radiokit.worlds.planning import choose, explained, find_terms, integrates
from radiokit.worlds.sampling import monte_carlo, sampling_is_better
from radiokit.worlds.scene import behind_all
from radiokit.worlds.terms import SMOOTH, Term

__all__ = ["explain", "shade"]

SURER = 4.0
"""A bound is given up for a standard error that is so many times smaller."""


def shade(
    f: Any,
    emitters: Emitter | Iterable[Emitter],
    wo: npt.ArrayLike,
    *,
    normal: npt.ArrayLike = (0.0, 0.0, 1.0),
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    method: str = "auto",
    rtol: float = 1e-6,
    samples: int | None = None,
    seconds: float | None = None,
    evaluations: int | None = None,
    rng: int | np.random.Generator | None = None,
    executor: Executor | None = None,
    occluders: Occluder | Iterable[Occluder] = (),
) -> Estimate:
    """Return the radiance Lo = ∫ f L cosθ dω [W m⁻² sr⁻¹] that a surface reflects towards ``wo``.

    Each light makes one term, or two if the material has delta lobes. Delta lights are summed and delta
    lobes are looked up, whatever ``method`` says, for there is nothing to integrate; a delta light on a
    delta lobe is a pair of measure zero and adds 0. The rest goes by ``method``; ``explain`` tells which one
    ``auto`` takes and why.

    Where light passes, what comes from the other side of the surface makes terms of its own. A light's
    radiance is taken to be the basic one, L/n², on either side.

    Parameters
    ----------
    f : BSDF or callable
        The material, f(wi, wo) [sr⁻¹].
    emitters : Emitter or iterable of Emitter
        The lights; none give 0.
    wo : array_like, shape (3,)
        Unit vector to the viewer in world coordinates.
    normal : array_like, shape (3,)
        The surface's normal in world coordinates; any length but 0.
    position : array_like, shape (3,)
        Where the surface is [m].
    method : str
        ``auto``, ``sum``, ``closed form``, ``quadrature``, ``mc-bsdf`` (samples of the material),
        ``mc-light`` (of the light), ``mis`` (of both, by the balance heuristic), ``mc``, the best of these,
        or ``qmc``, the same with low-discrepancy points.
    rtol : float
        Relative tolerance of each term, in (0, 1).
    samples : int, optional
        Monte Carlo draws exactly so many for each term; ``qmc`` rounds down to 16 times a power of 2.
        Without it, it stops at ``rtol`` or after 2²⁰. With a budget it is the most that are drawn.
    seconds : float, optional
        A budget of time for the whole call [s], above 0. Each term that must be integrated gets an equal
        share of what the ones before have left; what is exact is always computed. Monte Carlo then draws as
        many samples as there is time for. It may be exceeded by a block of 16384 samples, a rule of the
        quadrature, or a round of its refinement.
    evaluations : int, optional
        A budget of evaluations of the material, at least 1, shared alike. A sample of ``mis`` counts as two.
        It may be exceeded by what a term takes at the least: 1024 samples to foretell a variance, or the
        search for a lobe and the first three rules of a quadrature over each piece of a light. Within a small
        budget ``auto`` takes low-discrepancy samples.
    rng : int, numpy.random.Generator or None
        For Monte Carlo.
    executor : concurrent.futures.Executor, optional
        Runs the blocks of Monte Carlo; the answer does not depend on it.
    occluders : Occluder or iterable of Occluder, optional
        Opaque bodies between the lights and the surface; what they would reflect does not count.

    Returns
    -------
    Estimate
        Of shape () or (K,). ``converged`` is False when ``rtol`` was not reached; ``note`` then says what was
        within the budget.

    Raises
    ------
    ParameterError
        When an argument is not allowed, or the surface lies on a light or an occluder.
    UnknownNameError
        When there is no such method.
    RadiokitError
        When the method cannot compute a term; the message says which can.

    Source: Kajiya (1986), The rendering equation, doi:10.1145/15886.15902, for the integral; Veach, Guibas
    (1995), doi:10.1145/218380.218498, section 3.2, for the balance heuristic.

    >>> from radiokit.emitters.constant import Constant
    >>> from radiokit.emitters.point import Point
    >>> half = lambda wi, wo: 0.5 / np.pi
    >>> lights = [Constant(radiance=1.0), Point(position=(0, 0, 2), intensity=4 * np.pi)]
    >>> round(float(shade(half, lights, (0.0, 0.6, 0.8))), 9)  # 0.5 · 1 + 0.5/π · π
    1.0
    """
    _, terms = find_terms(
        f,
        behind_all(emitters, occluders, position),
        wo,
        normal=normal,
        position=position,
        method=method,
        rtol=rtol,
    )
    purse = Purse(seconds, evaluations, sum(integrates(term, method) for term in terms))
    generator = np.random.default_rng(seed_from(rng))
    total: Estimate | None = None
    for term in terms:
        shared = integrates(term, method)
        budget = purse.share() if shared else Budget()
        chosen = choose(term, method, budget)
        found = _compute(term, chosen, method, rtol, samples, generator, executor, budget)
        if shared:
            purse.pay(found.evaluations * (2 if "mis" in found.method else 1))
        total = found if total is None else total + found
    if total is None:
        return Estimate(0.0, 0.0, "rounding", method="sum", note="no light")
    return purse.judged(total, rtol)


def _compute(
    term: Term,
    chosen: str,
    method: str,
    rtol: float,
    samples: int | None,
    rng: np.random.Generator,
    executor: Executor | None,
    budget: Budget,
) -> Estimate:
    if chosen == "sum":
        return term.zero("the viewer is not above the horizon") if term.part == SMOOTH else term.add_up()
    if chosen == "closed form":
        return term.closed_form()
    options: dict[str, Any] = {"rtol": rtol, "samples": samples, "rng": rng, "executor": executor}
    if chosen != "quadrature":
        return monte_carlo(term, chosen, budget=budget, **options)
    found = integrate(term, rtol, budget, patience(rtol) if method == "auto" else None)
    left = budget.less(found.evaluations)
    if found.converged or method != "auto" or not sampling_is_better(term, found, samples, left):
        return found
    # What quadrature cannot resolve is left to Monte Carlo.
    sampled = monte_carlo(term, "qmc", budget=left, **options)
    if sampled.converged or np.all(SURER * sampled.error < found.error):
        note = f"quadrature reached only ± {np.max(found.error):.2g}: {found.note}"
        best, other = sampled, found
    else:
        note, best, other = found.note, found, sampled
    return replace(
        best,
        evaluations=found.evaluations + sampled.evaluations,
        seconds=best.seconds + other.seconds,
        note="; ".join(filter(None, (note, best.note if best is sampled else ""))),
    )


def explain(
    f: Any,
    emitters: Emitter | Iterable[Emitter],
    wo: npt.ArrayLike | None = None,
    *,
    normal: npt.ArrayLike = (0.0, 0.0, 1.0),
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    method: str = "auto",
    rtol: float = 1e-6,
    samples: int | None = None,
    seconds: float | None = None,
    evaluations: int | None = None,
    occluders: Occluder | Iterable[Occluder] = (),
) -> Plan:
    """Return the plan that ``shade`` would follow with the same arguments: a row for each term.

    Each row says which method is taken and why, what it should cost and reach, and what the others would
    cost for the same tolerance. That is foretold, in order of magnitude, from some thousand evaluations.

    Parameters
    ----------
    f, emitters, normal, position, method, rtol, samples, seconds, evaluations,
    occluders
        As in ``shade``.
    wo : array_like, shape (3,), optional
        Unit vector to the viewer; along the normal when not given.

    Raises
    ------
    RadiokitError
        As ``shade`` does.

    >>> from radiokit.emitters.point import Point
    >>> print(explain(lambda wi, wo: 0.5 / np.pi, [Point(position=(0, 0, 2), intensity=1.0)]))
    as_bsdf(<lambda>), relative tolerance 1e-06
      point, delta light: sum, about 1 evaluations, 0.2 ms
        because the light arrives from single directions: the integral is a sum
        also possible: nothing
    """
    subject, terms = find_terms(
        f,
        behind_all(emitters, occluders, position),
        wo,
        normal=normal,
        position=position,
        method=method,
        rtol=rtol,
    )
    integrals = sum(integrates(term, method) for term in terms)
    purse = Purse(seconds, evaluations, integrals)
    share, time_share = purse.share(), None if seconds is None else seconds / max(integrals, 1)
    rows = [explained(term, choose(term, method, share), rtol, samples, share, time_share) for term in terms]
    return Plan(subject, rtol, tuple(rows))
