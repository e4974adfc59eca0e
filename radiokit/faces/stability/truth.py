"""Truth: the directional albedo of a twin to thirty digits, without a kernel and without a rule in float64.

Floats plan: which chart, and how many nodes, until three resolutions agree. The integral itself is worked out
with multiple precision at the second of them, and counts only where the third agrees with it: in floats, or,
where these round too much, in multiple precision too.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.faces.stability.charts import Chart, refracted_chart, slope_chart, sphere_chart, turned_chart
from radiokit.faces.stability.kinks import float_function
from radiokit.faces.stability.sides import DIGITS, Rule, Side
from radiokit.measure.refraction import rest_rule
from radiokit.measure.twin import Twin, compiled, working_precision

__all__ = ["AGREE", "DIGITS", "NODES", "NoTruthError", "Truth", "twin_albedo"]

AGREE = 1e-12
"""Relative difference of two resolutions that is allowed."""

NODES = 64_000
"""Values of the twin that one albedo may cost, unless the caller allows more."""

_PLANNED = 4e-13
_ROUNDING = 8 * float(np.finfo(float).eps)  # of a sum in floats, over a lobe's width and cosθo
_TILTED = np.array([1e-20, 0.0, 0.0])
_EVEN = 1e-10
_ROUGHLY = 1e-3
_CHEAP = 2000  # nodes below which no other chart is looked at
_LOOK = Rule(128, 48, eased=False, midpoints=True)
_RADII = (8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160, 200)
_AZIMUTHS = (1, 2, 4, 6, 8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160, 200, 256, 320)


class NoTruthError(Exception):
    """No integral of the twin is to be had within the cost that is allowed; says why."""


@dataclass(frozen=True)
class Truth:
    """A directional albedo: its value as a multiple-precision number, and how it was found.

    Parameters
    ----------
    value : mpmath.mpf
    uncertainty : float
        Difference from a finer resolution; 0 of a closed form.
    method : str
    nodes : int
        Values of the twin that it took.
    """

    value: Any
    uncertainty: float
    method: str
    nodes: int


@dataclass(frozen=True)
class _Plan:
    """Rules of rising size, on one or both sides of the plane of incidence; the cost of the second.

    ``finest`` is the integral by the third, in floats.
    """

    side: Side
    both: bool
    rules: tuple[Rule, ...]
    cost: int
    value: float
    finest: float

    def integral(self, k: int) -> tuple[Any, int]:
        """Return the integral by rule number ``k``, and the number of nodes."""
        value, count = self.side.integral(1, self.rules[k])
        if not self.both:
            return 2 * value, count
        other, more = self.side.integral(-1, self.rules[k])
        return value + other, count + more


class _VanishesError(NoTruthError):
    """Nothing but zeros was seen."""


def _plan(side: Side, eased: bool, most: int, tolerance: float) -> _Plan:
    """Return the smallest rule with which two larger ones agree in floats, and what follows."""
    midpoints = side.periodic(1) and side.periodic(-1)
    azimuths = _AZIMUTHS if midpoints else _AZIMUTHS[3:]
    # Mirrored nodes give the same sums, but for rounding, if f is even: also where they have not converged.
    look = Rule(24, 16, eased, midpoints)
    (one, _), (other, _) = (side.planned(far, look) for far in (1, -1))
    both = not abs(one - other) <= _EVEN * abs(one)

    def at(rule: Rule) -> tuple[float, int]:
        value, cost = side.planned(1, rule)
        if not both:
            return 2 * value, cost
        other, more = side.planned(-1, rule)
        return value + other, cost + more

    def first(rules: list[Rule], what: str) -> tuple[int, float]:
        found: list[float] = []
        for k, rule in enumerate(rules):
            value, cost = at(rule)
            found.append(value)
            # Three that agree: two may do so by chance.
            if k > 1 and value and max(abs(v - value) for v in found[-3:]) <= tolerance * abs(value):
                return k - 2, value
            if cost > 2 * most:
                break
        raise NoTruthError(f"{what} do not converge") if any(found) else _VanishesError("zero")

    j, _ = first([Rule(48, n, eased, midpoints) for n in azimuths], "azimuths")
    i, value = first([Rule(n, azimuths[j], eased, midpoints) for n in _RADII], "radii")
    steps = ((min(i + k, len(_RADII) - 1), min(j + k, len(azimuths) - 1)) for k in range(4))
    rules = tuple(Rule(_RADII[r], azimuths[a], eased, midpoints) for r, a in steps)
    return _Plan(side, both, rules, at(rules[1])[1], value, at(rules[2])[0])


def _charts(f: BSDF, wo: FloatArray, through: bool) -> list[Chart]:
    """Return the charts of a hemisphere in which the twin's integrand may be smooth; wo is above."""
    cos_o, sin_o = float(wo[2]), math.hypot(*wo[:2])
    width = f.lobe_width() or 1.0
    slopes, angles = slope_chart(cos_o, sin_o, width), sphere_chart()
    if not through:
        return [slopes, angles, turned_chart(slopes, -1, 1)]
    return [turned_chart(slopes, 1, -1), turned_chart(angles, 1, -1)]


def twin_albedo(f: BSDF, wo: FloatArray, *, most: int = NODES) -> Truth:
    """Return the directional albedo of the twin of ``f`` for ``wo`` (3,), delta lobes included.

    Raises
    ------
    NoTruthError
        When two resolutions do not agree within the cost that is allowed, with the reason.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> import mpmath
    >>> truth = twin_albedo(bsdf("lambert", reflectance=0.5), np.array([0.0, 0.6, 0.8]))
    >>> mpmath.nstr(truth.value, 20), truth.method
    ('0.5', 'closed form: constant')
    """
    from radiokit.faces.stability.deltas import delta_share

    with working_precision(DIGITS):
        twin, below = f.symbolic(), bool(wo[2] < 0)
        up = wo * [1.0, 1.0, -1.0] if below else wo
        if below:
            twin = _upside_down(twin)
        eta = f.relative_index() ** (-1 if below else 1)
        share = delta_share(twin, up, f.transmissive, eta)
        closed = _constant(f, twin)
        if closed is not None:
            return Truth(closed + share, 0.0, "closed form: constant" if closed else "closed form: delta", 0)
        total, uncertainty, nodes, names = share, 0.0, 0, []
        for through in (False, True) if f.transmissive else (False,):
            try:
                value, off, count, name = _hemisphere(f, twin, up, through, eta, most - nodes)
            except ZeroDivisionError:
                if up[0] or up[1]:
                    raise
                # Where a twin divides by tanθo: an albedo is even in θo, and off by about the tilt's square.
                value, off, count, name = _hemisphere(f, twin, up + _TILTED, through, eta, most - nodes)
            total, uncertainty, nodes = total + value, uncertainty + off, nodes + count
            names.append(name)
        return Truth(total, uncertainty, "integral: " + ", ".join(dict.fromkeys(names)), nodes)


def _constant(f: BSDF, twin: Twin) -> Any:
    """Return π f for a twin that is the same for all pairs of directions, 0 for nothing but delta lobes."""
    import sympy

    plain = twin.expression.replace(sympy.DiracDelta, lambda *_: sympy.S.Zero)
    if plain.free_symbols & set(twin.arguments) or (f.transmissive and plain != 0):
        return None
    from mpmath import mp

    return mp.pi * compiled(plain, tuple(twin.parameters))(*map(mp.mpf, twin.parameters.values()))


def _upside_down(twin: Twin) -> Twin:
    """Return the twin seen from below: both z are negated."""
    z_i, z_o = twin.arguments[2], twin.arguments[5]
    turned = twin.expression.subs({z_i: -z_i, z_o: -z_o}, simultaneous=True)
    return Twin(turned, twin.parameters, twin.arguments)


def _hemisphere(
    f: BSDF, twin: Twin, wo: FloatArray, through: bool, eta: float, most: int
) -> tuple[Any, float, int, str]:
    """Return the integral over one hemisphere, the difference of two resolutions, the cost and the chart."""
    from mpmath import mp

    charts, scale = _charts(f, wo, through), 1.0
    if through:
        scale = eta * eta
        if abs(eta - 1) > 1e-7 and not _beside(twin, wo, eta):
            cos_o, sin_o = float(wo[2]), math.hypot(*wo[:2])
            charts.insert(0, refracted_chart(cos_o, sin_o, eta, f.lobe_width() or 1.0))
    coarse = _ROUNDING / ((f.lobe_width() or 1.0) * float(wo[2]))
    tolerances = (_PLANNED, coarse) if coarse > _PLANNED else (_PLANNED,)
    best: _Plan | None = None
    reasons, seen, zeros = [], 0, 0
    looks: list[float] = []
    plans: list[tuple[Chart, float]] = []
    for cut, chart in itertools.product((False, True), charts):
        if best is not None and best.cost <= _CHEAP:
            break
        side = Side(twin, wo, chart, scale, cut=cut)
        if cut and not side.kinked:
            continue
        if not cut:
            looks.append(sum(side.planned(far, _LOOK)[0] for far in (1, -1)))
        for eased, tolerance in itertools.product((False, True), tolerances):
            seen += 1
            try:
                plan = _plan(side, eased, most, tolerance)
            except NoTruthError as problem:
                zeros += isinstance(problem, _VanishesError)
                reasons.append(f"{chart.name}: {problem}")
                continue
            plans.append((chart, plan.value))
            if best is None or plan.cost < best.cost:
                best = plan
            break
    if best is None:
        if zeros == seen:
            return mp.mpf(0), 0.0, 0, "zero at all nodes"
        raise NoTruthError("; ".join(dict.fromkeys(reasons)))
    name = best.side.chart.name
    # A narrow lobe may stand between the nodes of angles: those made for it, first in the list, would see it.
    # Where nobody knows where the lobe is, any of the charts may be.
    known = f.lobe_width() is not None
    others = [value for chart, value in plans if chart is not best.side.chart]
    made = [value for chart, value in plans if chart is charts[0] is not best.side.chart]
    seers = [*looks[:1], *made] if known else [*looks, *others]
    if not any(abs(best.value - value) <= _ROUGHLY * abs(value) for value in seers):
        raise NoTruthError(f"{name} give {best.value:.4g}, and others about {seers[0]:.4g}")
    if best.cost > most:
        raise NoTruthError(f"{name}: {best.cost} nodes would be needed, and {most} are allowed")
    spent, other = 0, mp.mpf(best.finest)
    for k in (1, 2, 3):
        value, count = best.integral(k)
        spent += count
        off = float(abs(value - other))
        if off <= AGREE * float(abs(value)):
            return value, off, spent, name
        other = value
    raise NoTruthError(f"{name}: two resolutions differ by {off / float(abs(value)):.1e}")


def _beside(twin: Twin, wo: FloatArray, eta: float) -> bool:
    """Return whether something passes into directions to which no facet refracts."""
    wi, _ = rest_rule(wo, eta, 10)
    function = float_function((twin.expression,), (*twin.arguments, *twin.parameters))
    constants = [float(v) for v in twin.parameters.values()]  # type: ignore[arg-type]
    with np.errstate(all="ignore"):
        value = function(*wi.T, *wo, *constants)[0]
    return bool(np.any(np.nan_to_num(np.real(value)) != 0))
