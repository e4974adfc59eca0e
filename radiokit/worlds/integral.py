"""Integral: a term by quadrature over the hemisphere, a lune, or the square of a finite light."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.facts.estimate import Estimate
from radiokit.measure.lattice import kronecker
from radiokit.measure.lune import lune
from radiokit.measure.quadrature import hemisphere
from radiokit.worlds.budget import Budget
from radiokit.worlds.finite import MOST, over_light
from radiokit.worlds.sampling import ZENITH, Sampler
from radiokit.worlds.terms import Term

__all__ = ["GUARD", "expected_peaks", "integrate", "lobe_angle", "patience", "product_of"]

FloatArray = npt.NDArray[np.float64]

GUARD, BLIND = 256, 4096
"""Lattice points that must confirm a quadrature over a light's own square, for a material that is sampled by
its lobe and for one that is not."""

DOME_MOST = 4_000_000
"""Evaluations under a dome when no budget is given."""

_PROBE = 256  # evaluations that tell how long one takes
_CAREFUL = 0.7  # share of the time that is planned for
_LEAST = 1024  # evaluations that a quadrature gets in any case


def patience(rtol: float) -> int:
    """Return the evaluations after which the refinement of panels over a light is better given up.

    Low-discrepancy samples need a small multiple of 1/rtol. Where the product jumps, panels need more.

    >>> patience(1e-2), patience(1e-3)
    (8000, 20000)
    """
    return max(8_000, round(20.0 / rtol))


def integrate(term: Term, rtol: float, budget: Budget | None = None, most: int | None = None) -> Estimate:
    """Integrate by the rule that fits the light: hemisphere, lune, or the light's own square.

    ``most`` limits the evaluations by which panels over a light's square are refined.
    """
    budget = Budget() if budget is None else budget
    dome = term.light.dome(term.receiver.origin)
    if dome is None:
        return _over_square(term, rtol, budget, MOST if most is None else most)
    most = min(_affordable(term, budget), DOME_MOST)
    width = term.f.lobe_width()
    if all(float(zenith @ term.receiver.axis) > ZENITH for zenith in dome):
        return hemisphere(
            term.reflected, wo=term.wo, width=width, rtol=rtol, smooth=term.f.smooth, max_evaluations=most
        )
    zenith = term.receiver.to_local(dome[0])
    return lune(term.reflected, zenith, wo=term.wo, width=width, rtol=rtol, max_evaluations=most)


def lobe_angle(term: Term) -> float | None:
    """Return the angular radius [rad] of the material's lobe at its narrowest, or None if it is unknown.

    In azimuth a lobe narrows towards the horizon.
    """
    width = term.f.lobe_width()
    return None if width is None else 2 * width * float(np.clip(term.wo[2] + width, 0.0, 1.0))


def expected_peaks(term: Term) -> tuple[FloatArray, ...]:
    """Return world directions (3,) of lobes: the mirror's, and ``wo`` where nothing is known of the lobe."""
    mirror = term.receiver.to_world(term.wo * np.array([-1.0, -1.0, 1.0]))
    return (mirror,) if term.f.lobe_width() is not None else (mirror, term.receiver.to_world(term.wo))


def product_of(term: Term) -> Callable[[Emitter], Callable[[FloatArray], Any]]:
    """Return f L cosθ of a piece of the light, as a function of world directions (N, 3)."""

    def product(piece: Emitter) -> Callable[[FloatArray], Any]:
        lit = replace(term, light=piece)
        return lambda directions: lit.reflected(term.receiver.to_local(directions))

    return product


def _affordable(term: Term, budget: Budget) -> int:
    """Return the evaluations that a budget allows, with the time that one takes measured."""
    most = DOME_MOST if budget.evaluations is None else max(budget.evaluations, _LEAST)
    if not np.isfinite(budget.deadline):
        return most
    directions = np.broadcast_to([0.0, 0.0, 1.0], (_PROBE, 3))
    start = time.perf_counter()
    term.reflected(directions)
    now = time.perf_counter()
    left = _CAREFUL * max(budget.deadline - now, 0.0)
    return int(np.clip(left / (now - start) * _PROBE, _LEAST, most))


def _over_square(term: Term, rtol: float, budget: Budget, refinement: int) -> Estimate:
    """Integrate over the square from which the light samples its directions.

    A lobe much narrower than the light can slip between the nodes of every rule, so that they agree on a
    wrong value. Where it should be is known, and the square is searched for it; a lattice in the squares of
    both the light and the material sees a lobe that is elsewhere.
    """
    start = time.perf_counter()

    count = GUARD if getattr(term.f, "has_sampler", True) else BLIND
    most = MOST
    if budget.evaluations is not None:
        most = max(budget.evaluations, _LEAST)
        count = min(count, 16 * max(most // 256, 1))
        most = max(most - 2 * count, _LEAST)
    found = over_light(
        product_of(term),
        term.light,
        term.receiver,
        rtol,
        peaked=True,
        width=lobe_angle(term),
        towards=expected_peaks(term),
        smooth=term.f.smooth,
        max_evaluations=most,
        refinement=refinement,
        deadline=budget.deadline,
    )
    if found.evaluations == 1:  # no light is above the horizon
        return found
    sampler = Sampler(term, "mis")
    values = sampler(kronecker(count, sampler.dimensions))
    means = values.reshape(16, -1, *term.shape).mean(axis=1)
    guard, spread = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))
    gap = np.maximum(guard - found.value, 0.0)  # what is missed is missing
    missed = gap > found.error + 6 * spread + 0.01 * guard
    found = replace(found, evaluations=found.evaluations + 2 * count, seconds=time.perf_counter() - start)
    if np.any(missed):
        note = f"a lattice over light and lobe finds {guard}: the rules missed a narrow lobe"
        return replace(found, error=found.error + 2 * gap + 6 * spread, converged=False, note=note)
    return found
