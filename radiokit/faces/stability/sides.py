"""Sides: a twin's integrand over one hemisphere in one chart, summed in floats or to thirty digits."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import FloatArray
from radiokit.faces.stability.charts import Chart, Numbers, digits, floats
from radiokit.faces.stability.kinks import Lines, boundaries, float_function
from radiokit.measure.twin import Twin, compiled, working_precision

__all__ = ["DIGITS", "Rule", "Side"]

DIGITS = 30


@dataclass(frozen=True)
class Rule:
    """Nodes on each piece: Gauss-Legendre, crowded at the ends if ``eased``, or the midpoints of a turn."""

    radii: int
    azimuths: int
    eased: bool
    midpoints: bool


@functools.lru_cache(maxsize=256)
def _gauss(n: int) -> tuple[list[Any], list[Any]]:
    """Return nodes and weights on [0, 1], by Newton's method, to all digits and some more."""
    from mpmath import mp

    with working_precision(DIGITS + 5):
        nodes, weights = [], []
        for guess in np.polynomial.legendre.leggauss(n)[0].tolist():
            x = mp.mpf(guess)
            for _ in range(2):
                before, here = mp.mpf(1), x
                for k in range(2, n + 1):
                    before, here = here, ((2 * k - 1) * x * here - (k - 1) * before) / k
                slope = n * (x * here - before) / (x * x - 1)
                x -= here / slope
            nodes.append((1 + x) / 2)
            weights.append(1 / ((1 - x * x) * slope * slope))
        return nodes, weights


@functools.lru_cache(maxsize=256)
def _rounded(n: int) -> tuple[Any, Any]:
    """Return the same as arrays of floats."""
    nodes, weights = (np.array([float(v) for v in column]) for column in _gauss(n))
    return nodes, weights


def _nodes(rule: Rule, n: int, precise: bool) -> tuple[Any, Any]:
    """Return nodes and weights on [0, 1], moved to its ends where the rule is eased."""
    x, w = _gauss(n) if precise else _rounded(n)
    if not rule.eased:
        return x, w
    moved = [v * v * v * (10 - 15 * v + 6 * v * v) for v in x]
    weights = [30 * (v * (1 - v)) ** 2 * b for v, b in zip(x, w, strict=True)]
    return (moved, weights) if precise else (np.array(moved), np.array(weights))


class Side:
    """The twin's integrand on one hemisphere in one chart, on either side of the plane of incidence."""

    def __init__(self, twin: Twin, wo: FloatArray, chart: Chart, scale: float, *, cut: bool) -> None:
        self.chart, self.twin, self.scale = chart, twin, scale
        self.symbols = (*twin.arguments, *twin.parameters)
        self.parameters = [float(v) for v in twin.parameters.values()]  # type: ignore[arg-type]
        self.wo = wo.tolist()
        self.edges = boundaries(twin) if cut else ()
        self.lines = {far: Lines(self._boundaries(far), len(self.edges), chart.panels) for far in (1, -1)}

    @property
    def kinked(self) -> bool:
        """Whether something cuts the hemisphere."""
        return any(lines.any for lines in self.lines.values())

    def _frame(self, n: Numbers) -> tuple[list[Any], Any, Any]:
        """Return wo as a unit vector, and cosine and sine of its azimuth."""
        x, y, z = (n.number(v) for v in self.wo)
        length = n.sqrt(x * x + y * y + z * z)
        x, y, z = x / length, y / length, z / length
        radius = n.sqrt(x * x + y * y)
        return [x, y, z], *((x / radius, y / radius) if radius else (n.number(1), n.number(0)))

    def _arguments(self, panel: int, s: Any, x: Any, far: int) -> tuple[list[Any], Any]:
        """Return what the twin takes, as arrays of floats, and the solid angle per unit of s and x."""
        numbers = floats()
        wo, c, d = self._frame(numbers)
        along, across, up, area = self.chart.azimuth(numbers, panel, s)(x)
        across = far * across
        parts = np.broadcast_arrays(c * along - d * across, d * along + c * across, up, area)
        return [*parts[:3], *wo, *self.parameters], parts[3]

    def _boundaries(self, far: int) -> Any:
        function = float_function(self.edges, self.symbols) if self.edges else None

        def place(panel: int, s: Any, x: Any) -> Any:
            arguments, area = self._arguments(panel, s, x, far)
            found = function(*arguments) if function else []
            return np.array([np.broadcast_to(np.real(g), area.shape) for g in found])

        return place

    def _pieces(self, far: int, rule: Rule) -> Iterator[tuple[int, Any, list[tuple[int, Any, Any]], Any]]:
        """Yield panel, azimuths, intervals of x, and the ends of s, for each cut of s."""
        for panel in range(self.chart.panels):
            cuts = [] if rule.midpoints else self.lines[far].breaks[panel]
            for low, high in itertools.pairwise([0.0, *cuts, 1.0]):
                if rule.midpoints:
                    s = (np.arange(rule.azimuths) + 0.5) / rule.azimuths
                else:
                    s = low + (high - low) * _nodes(rule, rule.azimuths, False)[0]
                yield panel, s, self.lines[far].intervals(panel, s), (low, high)

    def periodic(self, far: int) -> bool:
        """Whether midpoints of azimuth will do: one panel of half a turn that nothing cuts."""
        return self.chart.whole and not any(self.lines[far].breaks)

    def planned(self, far: int, rule: Rule) -> tuple[float, int]:
        """Return the integral in floats, and the number of nodes."""
        function = float_function((self.twin.expression,), self.symbols)
        x, w = _nodes(rule, rule.radii, False)
        total, count = 0.0, 0
        for panel, s, intervals, (low, high) in self._pieces(far, rule):
            if rule.midpoints:
                places, w_s = (np.arange(rule.azimuths) + 0.5) / rule.azimuths, np.ones(len(s)) / len(s)
            else:
                places, w_s = _nodes(rule, rule.azimuths, False)
                places, w_s = low + (high - low) * places, (high - low) * w_s
            index, a, b = (np.array(column) for column in zip(*intervals, strict=True))
            radius = a[:, None] + (b - a)[:, None] * x
            with np.errstate(all="ignore"):
                arguments, area = self._arguments(panel, places[index][:, None], radius, far)
                value = np.real(np.broadcast_to(function(*arguments)[0], area.shape))
                weight = area * np.abs(arguments[2]) * ((b - a)[:, None] * w) * w_s[index][:, None]
                total += np.sum(np.where(weight == 0, 0, value * weight))
            count += value.size
        return float(total) * self.scale, count

    def integral(self, far: int, rule: Rule) -> tuple[Any, int]:
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
                w_s = [mp.mpf(1) / rule.azimuths] * rule.azimuths
            else:
                length = mp.mpf(high) - low
                places, w_s = ([length * v for v in vs] for vs in _nodes(rule, rule.azimuths, True))
                places = [low + v for v in places]
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
