"""Grid: the pairs of directions, and the parameters, at which a model's arithmetic is hardest."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.contracts.parameters import Parameter, parameters_of
from radiokit.facts.directions import reflect, refract, spherical_to_cartesian, unit
from radiokit.facts.errors import RadiokitError
from radiokit.measure.twin import Twin, scaled_ulps

__all__ = [
    "DARK",
    "edge_pairs",
    "examples",
    "extremes",
    "hard_pairs",
    "parameter_ends",
    "value_ulps",
    "worst_ulps",
]

ANGLES = np.radians([0.0, 1e-7, 30.0, 60.0, 89.0, 89.9999])
"""Polar angles of both directions: normal and nearly so, ordinary, grazing."""

NEAR = 1e-9
"""How close to a mirror pair, to the normal, to a kink and to the critical angle the edges come [rad]."""

BEYOND = 1e6
"""What stands for the end of an interval that has none; its inverse is the step away from an open end."""

Pairs = list[tuple[FloatArray, FloatArray]]


def hard_pairs(f: BSDF, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Return pairs above the horizon: normal, grazing, retro, exact and nearly mirror pairs, random ones.

    Where light passes they go round all four combinations of sides, and beside the mirror pairs stand those
    of refraction: exact, by tilted facets, and near the critical angle.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> wi, wo = hard_pairs(bsdf("ggx"), np.random.default_rng(1))
    >>> wi.shape == wo.shape, bool((wi[:, 2] > 0).all())
    (True, True)
    """
    facets = _facets(f)
    found: Pairs = []
    for theta_o in ANGLES:
        wo = spherical_to_cartesian(theta_o, 0.4)
        found += [(spherical_to_cartesian(t, phi), wo) for t in ANGLES for phi in (0.4, 1.3, 0.4 + np.pi)]
        found += [(reflect(wo), wo), *((reflect(wo, h), wo) for h in facets)]
    for _ in range(20):
        i, o = (unit(np.abs(v) * [rng.choice([-1, 1]), 1, 1]) for v in rng.normal(size=(2, 3)))
        found.append((i, o))
    return _sides(f, found, _refracted(f, [*ANGLES, *_critical(f, 1e-6)], [facets[0], facets[3]]))


def edge_pairs(f: BSDF) -> tuple[FloatArray, FloatArray]:
    """Return pairs a billionth of a radian from where formulas change or cancel.

    Mirror and retro pairs, the normal, equal polar angles (where some models have a kink), the horizon; where
    light passes the pairs of refraction, and the critical angle, 1e-9 and 1e-3 from it.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> wi, wo = edge_pairs(bsdf("lambert"))
    >>> len(wi) > 30, bool((wi == wo).all(axis=1).any())
    (True, True)
    """
    found: Pairs = []
    for theta in np.radians([0.0, 45.0, 80.0, 89.9999]):
        wo = spherical_to_cartesian(theta, 0.4)
        found += [
            (spherical_to_cartesian(theta + step, 0.4 + turn), wo)
            for step in (-NEAR, 0.0, NEAR)
            for turn in (0.0, 2.0, np.pi)
            if theta + step >= 0
        ]
    found += [(spherical_to_cartesian(NEAR, phi), spherical_to_cartesian(NEAR, 0.4)) for phi in (0.4, 2.0)]
    found += [(spherical_to_cartesian(np.pi / 2 - NEAR, 1.0), spherical_to_cartesian(NEAR, 0.4))]
    found += [(spherical_to_cartesian(np.pi / 2 - NEAR, 3.0), spherical_to_cartesian(np.pi / 2 - NEAR, 0.4))]
    near = unit([NEAR * np.cos(1.0), NEAR * np.sin(1.0), 1.0])
    return _sides(f, found, _refracted(f, [0.5, *_critical(f, 1e-9), *_critical(f, 1e-3)], [near]))


DARK = 1e-290
"""Values below this [sr⁻¹] count as 0: an exponential in them may have underflowed, below e⁻⁷⁰⁸."""


def worst_ulps(kernel: Any, twin: Twin, wi: FloatArray, wo: FloatArray, *, least: float = 0.0) -> float:
    """Return the largest error of ``kernel(wi, wo)``, in ulps over max(1, condition number).

    Condition numbers, which cost a score of evaluations each, are taken from the largest error in ulps
    downwards, until no error that is left can exceed what was found. Where no error exceeds ``least``, that
    is returned: who only asks whether one does, is soon answered.
    """
    values = kernel(wi, wo)
    exact = [twin.evaluate(*pair) for pair in zip(wi, wo, strict=True)]
    raw = np.array([value_ulps(*row) for row in zip(values, exact, strict=True)])
    worst = least
    for k in np.argsort(-raw, kind="stable"):
        if raw[k] <= worst:
            break
        worst = max(worst, value_ulps(values[k], exact[k], twin.condition(wi[k], wo[k])))
    return worst


def value_ulps(value: float, exact: Any, condition: float = 1.0) -> float:
    """Return the error of f [sr⁻¹] in ulps over max(1, condition); 0 where both are darker than ``DARK``.

    >>> value_ulps(0.0, 1e-300, 1.0), value_ulps(0.5, 0.5, 1.0)
    (0.0, 0.0)
    """
    if abs(value) < DARK and abs(exact) < DARK:
        return 0.0
    return float(scaled_ulps(value, exact, condition))


def examples(cls: type[BSDF]) -> tuple[BSDF, ...]:
    """Return the model with each of its ``EXAMPLES``, a spectrum taken apart into its wavelengths."""
    return tuple(one for values in cls.EXAMPLES for one in _wavelengths(cls(**values)))


def extremes(cls: type[BSDF]) -> tuple[tuple[BSDF, ...], int]:
    """Return the model at the ends of its parameters' declared ranges, and how many of them it refuses.

    From the first example of each choice that is no number (a distribution's name): one parameter after the
    other at either end, and of two parameters all four corners. What an example gives together is also moved
    together, to the low or the high ends. A parameter that none of these give is moved in the first example
    that gives it. Examples are not repeated.

    >>> from radiokit.contracts.bsdf import REGISTRY
    >>> [f.exponent for f in extremes(REGISTRY.get("phong"))[0] if f.reflectance == 1]
    [1000000.0]
    """
    declared = parameters_of(cls)
    given = examples(cls)
    seen: dict[BSDF, None] = dict.fromkeys(given)
    refused = 0
    for values in _extreme_values(cls, declared, given):
        try:
            f = cls(**values)
        except RadiokitError:
            refused += 1
        else:
            seen.setdefault(f)
    return tuple(f for f in seen if f not in given), refused


def _extreme_values(
    cls: type[BSDF], declared: dict[str, Parameter], given: Iterable[BSDF]
) -> list[dict[str, Any]]:
    found = []
    bases: dict[Any, dict[str, Any]] = {}
    models = [f.parameters() for f in given]
    for values in models:
        bases.setdefault(tuple(v for name, v in values.items() if name not in declared), values)
    ends = {name: parameter_ends(each) for name, each in declared.items()}
    for base in bases.values():
        live = [name for name in declared if base[name] is not None]
        found += [{**base, name: end} for name in live for end in ends[name]]
        if len(live) == 2:
            corners = itertools.product(*(ends[name] for name in live))
            found += [base | dict(zip(live, corner, strict=True)) for corner in corners]
    first = next(iter(bases.values()))
    for name in declared:
        if all(base[name] is None for base in bases.values()):
            moved = next((values for values in models if values[name] is not None), first)
            found += [{**moved, name: end} for end in ends[name]]
    given_together = {
        tuple(name for name in declared if values[name] is not None): values for values in models
    }
    found += [
        values | {name: ends[name][k] for name in names}
        for names, values in given_together.items()
        for k in (0, 1)
    ]
    return found


def parameter_ends(declared: Parameter) -> tuple[float, float]:
    """Return the two ends of a parameter's interval, or what is close to one that is open or infinite.

    >>> parameter_ends(Parameter("(0, 1]", "1", "width")), parameter_ends(Parameter("[1, inf)", "1", "index"))
    ((1e-06, 1.0), (1.0, 1000000.0))
    """
    low, high = (float(end) for end in declared.interval[1:-1].split(","))
    step = 1 / BEYOND
    first = -BEYOND if np.isinf(low) else low + step if declared.interval[0] == "(" else low
    last = BEYOND if np.isinf(high) else high - step if declared.interval[-1] == ")" else high
    return float(first), float(last)


def _wavelengths(f: BSDF) -> list[BSDF]:
    lengths = [len(v) for v in f.parameters().values() if isinstance(v, tuple)]
    return [f.wavelength(k) for k in range(max(lengths))] if lengths else [f]


def _facets(f: BSDF) -> list[FloatArray]:
    """Return facet normals at a tenth of the lobe's width, at the width, and at ten of them."""
    width = f.lobe_width() or 1.0
    slopes = [(slope * width, turn) for slope in (0.1, 1.0, 10.0) for turn in (0.0, 2.0)]
    return [unit([slope * np.cos(turn), slope * np.sin(turn), 1.0]) for slope, turn in slopes]


def _critical(f: BSDF, gap: float) -> list[float]:
    """Return polar angles just below and above the critical one; none where nothing is bent."""
    eta = f.relative_index()
    if not f.transmissive or eta == 1.0:
        return []
    angle = float(np.arcsin(min(eta, 1 / eta)))
    return [a for a in (angle - gap, angle + gap) if 0 < a < np.pi / 2]


def _refracted(f: BSDF, angles: Iterable[float], facets: list[FloatArray]) -> Pairs:
    """Return pairs across the surface which it, or one of the facets, refracts into each other."""
    if not f.transmissive:
        return []
    found: Pairs = []
    for theta, side in itertools.product(angles, (1.0, -1.0)):
        wo = spherical_to_cartesian(theta, 0.4) * [1.0, 1.0, side]
        for h in (np.array([0.0, 0.0, 1.0]), *facets):
            wi, total = refract(wo, h, eta=f.relative_index())
            if not total and wi[2] * wo[2] < 0:
                found.append((wi, wo))
    return found


def _sides(f: BSDF, found: Pairs, through: Pairs) -> tuple[FloatArray, FloatArray]:
    """Return the pairs above the horizon as arrays, sent round the sides of a surface that transmits."""
    wi, wo = (np.array(side) for side in zip(*found, strict=True))
    above = wi[:, 2] > 0
    wi, wo = wi[above], wo[above]
    if not f.transmissive:
        return wi, wo
    turn = np.arange(len(wi))
    wi[turn % 2 == 1, 2] *= -1
    wo[turn // 2 % 2 == 1, 2] *= -1
    more = [np.array([pair[k] for pair in through]).reshape(-1, 3) for k in (0, 1)]
    return np.concatenate([wi, more[0]]), np.concatenate([wo, more[1]])
