"""Integral: a term by quadrature over the hemisphere, a lune, or the square of a finite light."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.oneside import OneSide
from radiokit.contracts.spectral import times
from radiokit.emitters.disk import Disk
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.sphere import Sphere
from radiokit.emitters.triangle import Triangle
from radiokit.facts.estimate import Estimate
from radiokit.measure.lattice import kronecker
from radiokit.measure.lune import lune
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.slope import slope_rule
from radiokit.measure.transmission import reflection_edges, transmission
from radiokit.worlds.budget import Budget
from radiokit.worlds.finite import MOST, over_light
from radiokit.worlds.sampling import ZENITH, Sampler
from radiokit.worlds.terms import Term

__all__ = ["GUARD", "expected_peaks", "integrate", "lobe_angle", "patience", "product_of", "whole_lobe"]

FloatArray = npt.NDArray[np.float64]

GUARD, BLIND = 256, 4096
"""Lattice points that must confirm a quadrature over a light's own square, for a material that is sampled by
its lobe and for one that is not."""

DOME_MOST = 4_000_000
"""Evaluations under a dome when no budget is given."""

LONG = 0.35
"""cosθo below which a lobe is long on the sphere."""

CONVEX = (Disk, Rectangle, Sphere, Triangle)
"""Lights of constant radiance without holes; a disk with an exponent is found not to be constant."""

PROBE_RULE = (40, 28)
"""Radii and azimuths at which it is looked at whether a lobe lies within the light."""

BESIDE, MARGIN = 20.0, 3.0
"""What lies beside the light may be that part of the tolerance; so many times it is added to the error."""

_FLIP = np.array([1.0, 1.0, -1.0])
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
    if not dome and isinstance(term.f, OneSide) and term.f.eta != 1.0:
        return transmission(
            lambda w: term.reflected(w * _FLIP),
            wo=term.wo,
            eta=term.f.eta,
            width=term.f.f.lobe_width(),
            rtol=rtol,
            smooth=term.f.smooth,
            max_evaluations=most,
        )
    if all(float(zenith @ term.receiver.axis) > ZENITH for zenith in dome):
        return hemisphere(
            term.reflected,
            wo=term.wo,
            width=width,
            rtol=rtol,
            smooth=term.f.smooth,
            edges=reflection_edges(term.f.beyond) if isinstance(term.f, OneSide) else (),
            max_evaluations=most,
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
    """Return world directions (3,) of lobes: the mirror's, and ``wo`` where nothing is known of the lobe.

    That of light that passes is where a smooth surface would refract it from.
    """
    if isinstance(term.f, OneSide) and term.f.through:
        straight = term.f.refracted(term.wo)
        return () if straight is None else (term.receiver.to_world(straight),)
    mirror = term.receiver.to_world(term.wo * np.array([-1.0, -1.0, 1.0]))
    return (mirror,) if term.f.lobe_width() is not None else (mirror, term.receiver.to_world(term.wo))


def product_of(term: Term) -> Callable[[Emitter], Callable[[FloatArray], Any]]:
    """Return f L cosθ of a piece of the light, as a function of world directions (N, 3)."""

    def product(piece: Emitter) -> Callable[[FloatArray], Any]:
        lit = replace(term, light=piece)
        return lambda directions: lit.reflected(term.receiver.to_local(directions))

    return product


def whole_lobe(term: Term, rtol: float) -> tuple[Any, Any] | None:
    """Return a light's radiance, and what of ∫ f cosθ dω lies beside it, if that hardly counts.

    Such a lobe under a light of constant radiance is integrated in slope coordinates, as under a sky. That is
    cheaper than to follow it in the light's square where it is long, at grazing incidence, and where the
    material has kinks, of which slope coordinates know the course. Only a light that is known to be convex,
    and so has no holes or notches that a few nodes might not see, is asked: None for all others.
    """
    width = term.f.lobe_width()
    if width is None or type(term.light) not in CONVEX or (term.f.smooth and term.wo[2] > LONG):
        return None
    wi, weight = slope_rule(term.wo, width, PROBE_RULE)
    radiance = np.asarray(term.light.radiance_from(term.receiver.to_world(wi), term.receiver.origin))
    largest = radiance.max(axis=0)
    lit = radiance.reshape(len(wi), -1).max(axis=1) > 0
    if not np.any(lit) or not np.all(radiance[lit] == largest):
        return None
    mass = times(term.f.evaluate(wi, np.broadcast_to(term.wo, wi.shape)), wi[:, 2] * weight)
    beside = mass[~lit].sum(axis=0)
    hardly = np.all(BESIDE * beside <= rtol * mass.sum(axis=0))
    return (largest, beside) if hardly else None


def _in_slope(term: Term, rtol: float, radiance: Any, beside: Any) -> Estimate:
    """Integrate over a lobe that lies within the light, as if the light filled the hemisphere."""

    def under_a_sky(wi: FloatArray) -> FloatArray:
        return times(term.f.evaluate(wi, np.broadcast_to(term.wo, wi.shape)), np.maximum(wi[:, 2], 0.0))

    found = hemisphere(
        under_a_sky, wo=term.wo, width=term.f.lobe_width(), rtol=rtol / 2, smooth=term.f.smooth
    )
    found = replace(found, error=found.error + MARGIN * beside).scaled(radiance)
    evaluations = found.evaluations + 2 * PROBE_RULE[0] * PROBE_RULE[1]
    converged = bool(np.all(found.error <= rtol * np.abs(found.value)))
    return replace(found, evaluations=evaluations, converged=converged)


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
    within = None if budget.bounded else whole_lobe(term, rtol)
    if within is not None:
        found = _in_slope(term, rtol, *within)
        if found.converged:
            return replace(found, seconds=time.perf_counter() - start)
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
