"""Planning: which method computes each light's term, why, at what cost, and what else could."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.oneside import OneSide
from radiokit.facts.directions import check_directions
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.worlds.budget import Budget
from radiokit.worlds.pilot import Pilot, foretell
from radiokit.worlds.plan import Row
from radiokit.worlds.sampling import best_sampling
from radiokit.worlds.scene import Receiver, check_emitter, check_rtol
from radiokit.worlds.terms import DELTA_LIGHT, DELTA_LOBES, SMOOTH, Term

__all__ = [
    "METHODS",
    "applies",
    "check_direction",
    "choose",
    "explained",
    "find_terms",
    "integrates",
]

FloatArray = npt.NDArray[np.float64]

METHODS = ("auto", "sum", "closed form", "quadrature", "mc", "mc-bsdf", "mc-light", "mis", "qmc")
"""What ``shade`` understands; ``mc`` stands for the Monte Carlo method that suits the term best, and ``qmc``
for that method with low-discrepancy points."""

SAMPLED = ("mc-bsdf", "mc-light", "mis", "qmc")

ROUGH = 4000
"""Evaluations below which a budget is better spent on low-discrepancy samples than on a quadrature."""


def check_direction(name: str, value: npt.ArrayLike) -> FloatArray:
    """Return one unit vector (3,)."""
    direction = check_directions(name, value)
    if direction.shape != (3,):
        raise ParameterError(name, np.shape(value), "a single direction of shape (3,)")
    return direction


def find_terms(
    f: Any,
    emitters: Emitter | Iterable[Emitter],
    wo: npt.ArrayLike | None,
    *,
    normal: npt.ArrayLike,
    position: npt.ArrayLike,
    method: str,
    rtol: float,
) -> tuple[str, list[Term]]:
    """Check the arguments of ``shade`` and return the material's name and the terms."""
    if method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    check_rtol(rtol)
    model = as_bsdf(f)
    receiver = Receiver(normal, position)
    local = receiver.to_local(receiver.axis if wo is None else check_direction("wo", wo))
    lights: Sequence[Any] = [emitters]
    if isinstance(emitters, Iterable) and not isinstance(emitters, Emitter):
        lights = list(emitters)
    terms: list[Term] = []
    for light in map(check_emitter, lights):
        parts = (DELTA_LIGHT,) if light.delta else (DELTA_LOBES, SMOOTH)
        found = [Term(model, light, receiver, local, part) for part in parts]
        _ = found[0].shape  # material and light agree on the number of wavelengths
        if model.transmissive and found[-1].exists:
            found[-1:] = _both_sides(found[-1])
        terms += [term for term in found if term.exists]
    options = [_options(term) for term in terms]
    exact = all(each[0] == "sum" for each in options)
    if method not in ("auto", "sum") and terms and exact and not any(method in each for each in options):
        usable = "'auto' or 'sum'"
        if any("closed form" in each for each in options):
            usable += " or 'closed form'"
        raise RadiokitError(
            f"method {method!r} does not apply: nothing is left to integrate here. Use {usable}",
            method=method,
        )
    return repr(model), terms


def _both_sides(term: Term) -> list[Term]:
    """Return what a material reflects, and what passes through it, as two terms that reflect."""
    below = bool(term.wo[2] < 0)
    here, there = term.receiver, term.receiver.other_side
    wo = np.array([term.wo[0], term.wo[1], abs(term.wo[2])])
    own = OneSide(f=term.f, through=False, below=below)
    passed = OneSide(f=term.f, through=True, below=below)
    return [
        replace(term, f=own, receiver=there if below else here, wo=wo),
        replace(term, f=passed, receiver=here if below else there, wo=wo),
    ]


def choose(term: Term, method: str, budget: Budget) -> str:
    """Choose the method of one term; delta lights and delta lobes are exact whatever was asked for."""
    options = _options(term)
    wanted = best_sampling(term) if method == "mc" else method
    exact = term.part != SMOOTH or options == ("sum",)
    if method == "auto" or (exact and wanted not in options):
        scarce = budget.evaluations is not None and budget.evaluations < ROUGH
        return "qmc" if options[0] == "quadrature" and scarce else options[0]
    if wanted in options:
        return wanted
    usable = ", ".join(repr(option) for option in options)
    raise RadiokitError(
        f"method {method!r} does not apply to {_name(term)}: {_why_not(method)}. Use 'auto' or {usable}",
        method=method,
        usable=options,
    )


def integrates(term: Term, method: str) -> bool:
    """Return whether something is left to integrate, by whatever method: neither a sum nor a closed form."""
    return choose(term, method, Budget()) not in ("sum", "closed form")


def applies(method: str, *scene: Any, normal: npt.ArrayLike, position: npt.ArrayLike) -> bool:
    """Return whether ``shade`` can use a method for f, the emitters and wo."""
    try:
        _, terms = find_terms(*scene, normal=normal, position=position, method=method, rtol=1e-6)
        for term in terms:
            choose(term, method, Budget())
    except RadiokitError:
        return False
    return True


def explained(
    term: Term, chosen: str, rtol: float, samples: int | None, budget: Budget, seconds: float | None
) -> Row:
    """Return the row of a term: the method, why it was chosen, what it costs, and what others would."""
    others = tuple(option for option in _options(term) if option != chosen)
    pilot = Pilot(term, rtol, budget.bounded or seconds is not None)
    cost, *costs = (foretell(pilot, each, rtol, samples, budget, seconds) for each in (chosen, *others))
    cost = cost.limited
    return Row(
        _name(term),
        chosen,
        _why(pilot, chosen, budget),
        round(cost.evaluations),
        others,
        term,
        cost.seconds,
        cost.error,
        tuple(costs),
    )


def _options(term: Term) -> tuple[str, ...]:
    """Return the methods that can compute a term, the best first."""
    diffuse = term.f.diffuse_reflectance() is not None and term.wo[2] > 0
    if term.part == DELTA_LOBES:
        return ("sum",)
    if term.part == DELTA_LIGHT:
        return ("sum", "closed form") if diffuse else ("sum",)
    if term.wo[2] <= 0:
        return ("sum",)
    options: tuple[str, ...] = ("quadrature", *SAMPLED)
    return ("closed form", *options) if diffuse and term.arriving is not None else options


def _name(term: Term) -> str:
    through = isinstance(term.f, OneSide) and term.f.through
    return f"{term.light.name}, {term.part}{', through the surface' if through else ''}"


def _why(pilot: Pilot, method: str, budget: Budget) -> str:
    term = pilot.term
    if method == "sum":
        if term.part == DELTA_LIGHT:
            if term.only_delta:
                return "a delta light on delta lobes only is a pair of measure zero, which adds 0"
            return "the light arrives from single directions: the integral is a sum"
        if term.part == DELTA_LOBES:
            return "the material scatters into single directions, where the radiance is looked up"
        return "the viewer is not above the horizon: nothing is reflected there"
    if method == "closed form":
        return "the material is diffuse and the emitter's irradiance has a closed form: ρE/π"
    if method == "quadrature":
        return _why_quadrature(pilot)
    if method == "qmc" and budget.evaluations is not None and budget.evaluations < ROUGH:
        return f"low-discrepancy points, put to {best_sampling(term)}, make most of so small a budget"
    return {
        "mc-bsdf": "samples of the material suffice for a light that is everywhere",
        "mc-light": "asked for: samples of the light",
        "mis": "samples of material and light, weighted by the balance heuristic, miss neither",
        "qmc": f"low-discrepancy points in place of random ones, put to {best_sampling(term)}",
    }[method]


def _why_quadrature(pilot: Pilot) -> str:
    term = pilot.term
    dome = term.light.dome(term.receiver.origin)
    if dome is not None:
        if dome:
            return "the sky's and the surface's horizons bound a lune, in which the product is smooth"
        return "the light fills the hemisphere, where the product is smooth in slope coordinates"
    if pilot.within:
        return "the lobe lies within the light, whose radiance is constant: slope coordinates follow it"
    seen = pilot.lookouts
    if any(each.kinks for each in seen):
        return (
            "the horizon cuts the square from which the light is sampled: panels are refined along the kink"
        )
    if any(each.foci for each in seen):
        return (
            "the lobe is narrower than the light: nodes crowd around it in the square that samples the light"
        )
    return "the light is narrower than the lobe: the product is smooth over the square that samples the light"


def _why_not(method: str) -> str:
    if method == "sum":
        return "light arrives from a continuum of directions"
    return "it needs a diffuse material and an emitter with a closed-form irradiance"
