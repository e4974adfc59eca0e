"""Truth: the directional albedo of a twin to thirty digits, without a kernel and without a rule in float64.

Extended floats only plan: which chart, and how many nodes. The integral itself is worked out twice, with
multiple precision, at two resolutions, and counts only where they agree.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.faces.stability.charts import (
    FLOATS,
    Chart,
    Numbers,
    digits,
    refracted_chart,
    slope_chart,
    sphere_chart,
    turned_chart,
)
from radiokit.faces.stability.kinks import Lines, boundaries, float_function
from radiokit.measure.refraction import rest_rule
from radiokit.measure.twin import Twin, compiled, working_precision

__all__ = ["AGREE", "DIGITS", "NODES", "NoTruth", "Truth", "twin_albedo"]

DIGITS = 30
AGREE = 1e-12
"""Relative difference of two resolutions that is allowed."""

NODES = 12_000
"""Values of the twin that one albedo may cost, unless the caller allows more."""

_PLANNED = 2e-13
_RADII = (8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160)
_AZIMUTHS = (1, 2, 4, 6, 8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 160)


class NoTruth(Exception):
    """No integral of the twin is to be had within the cost that is allowed; says why."""


@dataclass(frozen=True)
class Truth:
    """A directional albedo: its value as a multiple-precision number, and how it was found.

    Parameters
    ----------
    value : mpmath.mpf
    uncertainty : float
        Difference of the two resolutions; 0 of a closed form.
    method : str
    nodes : int
        Values of the twin that it took.
    """

    value: Any
    uncertainty: float
    method: str
    nodes: int


@dataclass(frozen=True)
class _Rule:
    """Nodes on each piece: Gauss-Legendre, crowded at the ends if ``eased``, or the midpoints of a turn."""

    radii: int
    azimuths: int
    eased: bool
    midpoints: bool


@functools.lru_cache(maxsize=256)
def _gauss(n: int, precise: bool) -> tuple[Any, Any]:
    """Return nodes and weights on [0, 1]: extended floats, or multiple precision by Newton's method."""
    from mpmath import mp

    with working_precision(DIGITS + 5):
        nodes, weights = [], []
        for guess in np.polynomial.legendre.leggauss(n)[0].tolist():
            x = mp.mpf(guess)
            for _ in range(3):
                before, here = mp.mpf(1), x
                for k in range(2, n + 1):
                    before, here = here, ((2 * k - 1) * x * here - (k - 1) * before) / k
                slope = n * (x * here - before) / (x * x - 1)
                x -= here / slope
            nodes.append((1 + x) / 2)
            weights.append(1 / ((1 - x * x) * slope * slope))
        if precise:
            return nodes, weights
        return tuple(np.array([np.longdouble(mp.nstr(v, 25)) for v in vs]) for vs in (nodes, weights))  # type: ignore[return-value]


def _nodes(rule: _Rule, n: int, precise: bool) -> tuple[Any, Any]:
    """Return nodes and weights on [0, 1], moved to its ends where the rule is eased."""
    x, w = _gauss(n, precise)
    if not rule.eased:
        return x, w
    pairs = [(v * v * v * (10 - 15 * v + 6 * v * v), 30 * (v * (1 - v)) ** 2) for v in x]
    moved, slopes = [p[0] for p in pairs], [p[1] * b for p, b in zip(pairs, w, strict=True)]
    return (moved, slopes) if precise else (np.array(moved), np.array(slopes))


class _Side:
    """The twin's integrand on one hemisphere in one chart, on either side of the plane of incidence."""

    def __init__(self, twin: Twin, wo: FloatArray, chart: Chart, scale: float) -> None:
        self.chart, self.twin, self.scale = chart, twin, scale
        self.symbols = (*twin.arguments, *twin.parameters)
        self.parameters = [float(v) for v in twin.parameters.values()]  # type: ignore[arg-type]
        self.wo = wo.tolist()
        self.sin_o = math.hypot(*self.wo[:2])
        self.edges = boundaries(twin)
        self.lines = [Lines(self._boundaries(far), len(self.edges), chart.panels) for far in (1, -1)]

    def _frame(self, n: Numbers) -> tuple[list[Any], Any, Any]:
        """Return wo as a unit vector, and cosine and sine of its azimuth."""
        x, y, z = (n.number(v) for v in self.wo)
        length = n.sqrt(x * x + y * y + z * z)
        x, y, z = x / length, y / length, z / length
        radius = n.sqrt(x * x + y * y)
        return [x, y, z], *((x / radius, y / radius) if self.sin_o else (n.number(1), n.number(0)))

    def _directions(self, panel: int, s: Any, x: Any, far: int) -> tuple[list[Any], Any]:
        wo, c, d = self._frame(FLOATS)
        along, across, up, area = self.chart.azimuth(FLOATS, panel, s)(x)
        across = far * across
        parts = np.broadcast_arrays(c * along - d * across, d * along + c * across, up, area)
        return [*parts[:3], *wo, *map(np.longdouble, self.parameters)], parts[3]

    def _boundaries(self, far: int) -> Any:
        function = float_function(self.edges, self.symbols)

        def place(panel: int, s: Any, x: Any) -> Any:
            arguments, area = self._directions(panel, s, x, far)
            return np.array([np.broadcast_to(np.real(g), area.shape) for g in function(*arguments)])

        return place

    def _pieces(self, far: int, rule: _Rule) -> Iterator[tuple[int, Any, list[tuple[int, Any, Any]], Any]]:
        """Yield (panel, azimuths, intervals of x, azimuths' weights as (node, length)) for each cut of s."""
        lines = self.lines[0 if far == 1 else 1]
        for panel in range(self.chart.panels):
            ends = [0.0, *lines.breaks[panel], 1.0]
            for k, low in enumerate(ends[:-1]):
                if rule.midpoints:
                    s = (np.arange(rule.azimuths, dtype=np.longdouble) + 0.5) / rule.azimuths
                else:
                    s = low + (ends[k + 1] - low) * _nodes(rule, rule.azimuths, False)[0]
                yield panel, s, lines.intervals(panel, s), (low, ends[k + 1])

    def periodic(self, far: int) -> bool:
        """Whether midpoints of azimuth will do: one panel of half a turn that nothing cuts."""
        return self.chart.whole and not any(self.lines[0 if far == 1 else 1].breaks)

    def planned(self, far: int, rule: _Rule) -> tuple[float, int]:
        """Return the integral in extended floats, and the number of nodes."""
        function = float_function((self.twin.expression,), self.symbols)
        x, w = _nodes(rule, rule.radii, False)
        total, count = np.longdouble(0), 0
        for panel, s, intervals, (low, high) in self._pieces(far, rule):
            w_s = self._azimuth_weights(rule, low, high, False)
            index, a, b = (np.array(column) for column in zip(*intervals, strict=True))
            radius = a[:, None] + (b - a)[:, None] * x
            arguments, area = self._directions(panel, s[index][:, None], radius, far)
            with np.errstate(all="ignore"):
                value = np.real(np.broadcast_to(function(*arguments)[0], area.shape))
                weight = area * np.abs(arguments[2]) * ((b - a)[:, None] * w) * np.asarray(w_s)[index][:, None]
                total += np.sum(np.where(weight == 0, 0, value * weight))
            count += value.size
        return float(total) * self.scale, count

    @staticmethod
    def _azimuth_weights(rule: _Rule, low: Any, high: Any, precise: bool) -> list[Any]:
        if rule.midpoints:
            return [1 / _number(precise)(rule.azimuths)] * rule.azimuths
        length = _number(precise)(high) - _number(precise)(low)
        return [length * w for w in _nodes(rule, rule.azimuths, precise)[1]]

    def integral(self, far: int, rule: _Rule) -> tuple[Any, int]:
        """Return the integral in mpmath's present precision, and the number of nodes."""
        from mpmath import mp

        n = digits()
        function = compiled(self.twin.expression, self.symbols)
        parameters = [mp.mpf(v) for v in self.parameters]
        wo, c, d = self._frame(n)
        x, w = _nodes(rule, rule.radii, True)
        terms = []
        for panel, _, intervals, (low, high) in self._pieces(far, rule):
            if rule.midpoints:
                places = [(mp.mpf(k) + 0.5) / rule.azimuths for k in range(rule.azimuths)]
            else:
                nodes = _nodes(rule, rule.azimuths, True)[0]
                places = [low + (mp.mpf(high) - low) * v for v in nodes]
            w_s = self._azimuth_weights(rule, low, high, True)
            points = [self.chart.azimuth(n, panel, s) for s in places]
            for index, a, b in intervals:
                start = mp.mpf(float(a))
                length = mp.mpf(float(b)) - start
                for v, weight in zip(x, w, strict=True):
                    along, across, up, area = points[index](start + length * v)
                    across *= far
                    value = function(c * along - d * across, d * along + c * across, up, *wo, *parameters)
                    terms.append(mp.re(value) * area * abs(up) * (weight * length * w_s[index]))
        return mp.fsum(terms) * mp.mpf(self.scale), len(terms)


def _number(precise: bool) -> Any:
    if not precise:
        return np.longdouble
    from mpmath import mp

    return mp.mpf


def _plan(side: _Side, far: int, eased: bool, most: int) -> tuple[list[_Rule], int, float]:
    """Return the rule that suffices with those that follow it, the cost of two, and the value."""
    midpoints = side.periodic(far)

    def at(radii: int, azimuths: int) -> tuple[float, int]:
        return side.planned(far, _Rule(radii, azimuths, eased, midpoints))

    def settled(values: list[float]) -> bool:
        return abs(values[-1] - values[-2]) <= _PLANNED * abs(values[-1])

    sizes = _AZIMUTHS if midpoints else _AZIMUTHS[2:]
    found: list[float] = []
    for j, azimuths in enumerate(sizes):
        value, cost = at(48, azimuths)
        found.append(value)
        if len(found) > 1 and settled(found):
            break
        if cost > 12 * most:
            raise NoTruth("azimuths do not converge")
    else:
        raise NoTruth("azimuths do not converge")
    j -= 1
    found = []
    for i, radii in enumerate(_RADII):
        value, cost = at(radii, sizes[j])
        found.append(value)
        if len(found) > 1 and settled(found):
            break
        if cost > 12 * most:
            raise NoTruth("radii do not converge")
    else:
        raise NoTruth("radii do not converge")
    i -= 1
    rules = [
        _Rule(_RADII[min(i + k, len(_RADII) - 1)], sizes[min(j + k, len(sizes) - 1)], eased, midpoints)
        for k in range(3)
    ]
    return rules, sum(at(rule.radii, rule.azimuths)[1] for rule in rules[:2]), found[-1]


def _charts(f: BSDF, wo: FloatArray, through: bool) -> list[Chart]:
    """Return the charts of a hemisphere in which the twin's integrand may be smooth; wo is above."""
    cos_o, sin_o = float(wo[2]), math.hypot(*wo[:2])
    width = f.lobe_width() or 1.0
    slopes, angles = slope_chart(cos_o, sin_o, width), sphere_chart()
    if not through:
        return [slopes, angles, turned_chart(slopes, -1, 1)]
    found = [turned_chart(slopes, 1, -1), turned_chart(angles, 1, -1)]
    return found


def twin_albedo(f: BSDF, wo: FloatArray, *, most: int = NODES) -> Truth:
    """Return the directional albedo of the twin of ``f`` for ``wo`` (3,), delta lobes included.

    Raises
    ------
    NoTruth
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
            value, off, count, name = _hemisphere(f, twin, up, through, eta, most - nodes)
            total, uncertainty, nodes = total + value, uncertainty + off, nodes + count
            names.append(name)
        return Truth(total, uncertainty, "integral: " + ", ".join(dict.fromkeys(names)), nodes)


def _constant(f: BSDF, twin: Twin) -> Any:
    """Return π f for a twin that is the same for all pairs of directions, 0 for nothing but delta lobes."""
    import sympy

    plain = twin.expression.replace(sympy.DiracDelta, lambda *_: sympy.S.Zero)
    if plain.free_symbols & set(twin.arguments) or f.transmissive and plain != 0:
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
    best: tuple[int, list[_Rule], list[_Rule] | None, _Side] | None = None
    reasons = []
    for chart in charts:
        side = _Side(twin, wo, chart, scale)
        for eased in (False, True):
            try:
                near, cost, value = _plan(side, 1, eased, most)
                far, more, other = _plan(side, -1, eased, most)
            except NoTruth as problem:
                reasons.append(f"{chart.name}: {problem}")
                continue
            same = abs(value - other) <= 2 * _PLANNED * abs(value)
            cost = 2 * cost if False else cost + (0 if same else more)
            if best is None or cost < best[0]:
                best = cost, near, None if same else far, side
        if best is not None and best[0] <= most // 4:
            break
    if best is None:
        raise NoTruth("; ".join(dict.fromkeys(reasons)))
    cost, near, far_rules, side = best
    if cost > most:
        raise NoTruth(f"{side.chart.name}: {cost} nodes would be needed, and {most} are allowed")
    values, spent = [], 0
    for k in range(3):
        value, count = side.integral(1, near[k])
        other, more = (value, 0) if far_rules is None else side.integral(-1, far_rules[k])
        values.append(value + other)
        spent += count + more
        if k:
            off = float(abs(values[k] - values[k - 1]))
            if off <= AGREE * float(abs(values[k])):
                return values[k], off, spent, side.chart.name
    off = float(abs(values[-1] - values[-2]) / mp.mpf(abs(values[-1])))
    raise NoTruth(f"{side.chart.name}: two resolutions differ by {off:.1e}")


def _beside(twin: Twin, wo: FloatArray, eta: float) -> bool:
    """Return whether something passes into directions to which no facet refracts."""
    wi, _ = rest_rule(wo, eta, 10)
    function = float_function((twin.expression,), (*twin.arguments, *twin.parameters))
    constants = [np.longdouble(v) for v in twin.parameters.values()]  # type: ignore[arg-type]
    with np.errstate(all="ignore"):
        value = function(*wi.T.astype(np.longdouble), *map(np.longdouble, wo), *constants)[0]
    return bool(np.any(np.nan_to_num(np.real(value)) != 0))
