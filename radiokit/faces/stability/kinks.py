"""Kinks: where a twin is not smooth, found from its expression and followed through a chart."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from radiokit.measure.twin import Twin

if TYPE_CHECKING:
    import sympy

__all__ = ["Lines", "boundaries", "float_function"]

Place = Callable[[int, Any, Any], Any]
"""Values of all boundaries (G, ...) at a panel, azimuths and radii."""

_RADII, _AZIMUTHS = 1025, 96  # lines that meet are lost where they are closer than a radius
_BISECTIONS = 54
_SAME = 1e-9  # how close zeros of two functions are that vanish together


def boundaries(twin: Twin) -> tuple[sympy.Expr, ...]:
    """Return expressions of the directions at whose zeros the twin may have a jump or a kink.

    Both sides of the conditions of a ``Piecewise``, pairs that ``Max`` and ``Min`` compare, the insides of
    ``Abs`` and ``sign``, and what stands under a root.
    """
    import sympy
    from sympy.core.relational import Relational

    found: dict[sympy.Expr, None] = {}
    for part in sympy.preorder_traversal(twin.expression):
        if isinstance(part, Relational):
            found[part.lhs - part.rhs] = None
        elif isinstance(part, sympy.Max | sympy.Min):
            found.update(dict.fromkeys(a - b for a, b in itertools.combinations(part.args, 2)))
        elif isinstance(part, sympy.Abs | sympy.sign) or (part.is_Pow and part.exp.is_integer is not True):
            found[part.args[0]] = None
    directions = set(twin.arguments)
    kept = (g for g in found if g.free_symbols & directions and not g.has(sympy.DiracDelta))
    return tuple(g for g in kept if g.is_positive is not True and g.is_negative is not True)


@functools.lru_cache(maxsize=64)
def float_function(
    expressions: tuple[sympy.Expr, ...], symbols: tuple[sympy.Symbol, ...]
) -> Callable[..., list[Any]]:
    """Return expressions as a function of arrays of floats; a Dirac delta is 0."""
    import sympy

    def extreme(pick: Any, *values: Any) -> Any:
        return functools.reduce(pick, values)

    def root(value: Any) -> Any:
        value = np.asarray(value)
        if value.dtype.kind != "c" and np.any(value < 0):
            value = value.astype(np.result_type(value, np.complex64))
        return np.sqrt(value)

    def through_scipy(name: str) -> Any:
        def function(value: Any) -> Any:
            from scipy import special

            return getattr(special, name)(np.asarray(value, dtype=float))

        return function

    names = {
        "DiracDelta": lambda *_: 0.0,
        "largest": lambda *values: extreme(np.maximum, *values),
        "smallest": lambda *values: extreme(np.minimum, *values),
        "sqrt": root,
        **{name: through_scipy(name) for name in ("erf", "erfc", "erfinv", "gamma")},
    }
    largest, smallest = sympy.Function("largest"), sympy.Function("smallest")
    plain = [e.replace(sympy.Max, largest).replace(sympy.Min, smallest) for e in expressions]
    function: Callable[..., list[Any]] = sympy.lambdify(symbols, plain, modules=[names, "numpy"], cse=True)
    return function


class Lines:
    """The zeros of functions of (panel, s, x) along x, and the azimuths at which their number changes."""

    def __init__(self, place: Place, count: int, panels: int) -> None:
        self._place, self._panels = place, panels
        self._live: list[int] = list(range(count))
        # The ends are looked at from close by: a zero there is a line's end.
        self._x = np.concatenate([[1e-9], np.linspace(0, 1, _RADII)[1:-1], [1 - 1e-9]])
        self.breaks: list[list[float]] = [[] for _ in range(panels)]
        if not count:
            return
        s = (np.arange(_AZIMUTHS) + 0.5) / _AZIMUTHS
        s = np.concatenate([[1e-9], s, [1 - 1e-9]])
        signs = [self._signs(panel, s[:, None], self._x[None, :]) for panel in range(panels)]
        self._live = [g for g in range(count) if any(each[g].any() and not each[g].all() for each in signs)]
        for panel in range(panels):
            cuts: set[float] = set()
            for g in self._live:
                marks = _signature(signs[panel][g])
                for k in np.flatnonzero(marks[1:] != marks[:-1]):
                    cuts.add(self._where(panel, g, s[k], s[k + 1], marks[k]))
            self.breaks[panel] = _apart(cuts | self._crossings(panel, s))

    def _crossings(self, panel: int, s: Any) -> set[float]:
        """Return the azimuths at which lines cross, so that the order of the zeros changes."""
        found: set[float] = set()
        if len(self._live) < 2:
            return found
        orders = self._orders(panel, s)
        for k in range(len(s) - 1):
            if orders[k] == orders[k + 1] or sorted(orders[k]) != sorted(orders[k + 1]):
                continue
            low, high = s[k], s[k + 1]
            for _ in range(_BISECTIONS):
                middle = (low + high) / 2
                same = self._orders(panel, np.array([middle]))[0] == orders[k]
                low, high = (middle, high) if same else (low, middle)
            found.add(float((low + high) / 2))
        return found

    def _orders(self, panel: int, s: Any) -> list[tuple[tuple[int, ...], ...]]:
        """Return which functions vanish along x, in order, for each of ``s``; in one group where together."""
        orders = []
        for roots in self._zeros(panel, s):
            groups: list[tuple[float, list[int]]] = []
            for x, g in sorted(roots):
                if groups and x - groups[-1][0] < _SAME:
                    groups[-1][1].append(g)
                else:
                    groups.append((x, [g]))
            orders.append(tuple(tuple(sorted(members)) for _, members in groups))
        return orders

    def _zeros(self, panel: int, s: Any) -> list[list[tuple[float, int]]]:
        """Return the zeros along x, each with its function, for each of ``s`` (N,)."""
        signs = self._signs(panel, s[:, None], self._x[None, :])
        found: list[list[tuple[float, int]]] = [[] for _ in s]
        for g in self._live:
            rows, places = np.nonzero(signs[g][:, 1:] != signs[g][:, :-1])
            if not len(rows):
                continue
            low, high, before = self._x[places], self._x[places + 1], signs[g][rows, places]
            for _ in range(_BISECTIONS):
                middle = (low + high) / 2
                same = self._signs(panel, s[rows], middle)[g] == before
                low, high = np.where(same, middle, low), np.where(same, high, middle)
            for row, x in zip(rows.tolist(), (low + high) / 2, strict=True):
                found[row].append((x, g))
        return found

    def _signs(self, panel: int, s: Any, x: Any) -> Any:
        with np.errstate(all="ignore"):
            return np.asarray(self._place(panel, s, x)) > 0

    def _where(self, panel: int, g: int, low: Any, high: Any, mark: Any) -> float:
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            same = _signature(self._signs(panel, np.array([[middle]]), self._x[None, :])[g])[0] == mark
            low, high = (middle, high) if same else (low, middle)
        return float((low + high) / 2)

    @property
    def any(self) -> bool:
        """Whether some boundary crosses the chart."""
        return bool(self._live)

    def intervals(self, panel: int, s: Any) -> list[tuple[int, Any, Any]]:
        """Return (index of s, start, end) of the pieces of [0, 1] between zeros, for each of ``s`` (N,)."""
        if not self._live:
            return [(k, 0.0, 1.0) for k in range(len(s))]
        found = []
        for k, roots in enumerate(self._zeros(panel, s)):
            ends = [0.0, *_apart(x for x, _ in roots), 1.0]
            found += [(k, a, b) for a, b in itertools.pairwise(ends)]
        return found


def _signature(signs: Any) -> Any:
    """Return a number for each row that tells apart its sequences of signs."""
    return 2 * np.count_nonzero(signs[..., 1:] != signs[..., :-1], axis=-1) + signs[..., 0]


def _apart(values: Any) -> list[Any]:
    """Return sorted values in (0, 1), of those that are as good as the same only one."""
    kept: list[Any] = []
    for value in sorted(values):
        if 1e-8 < value < 1 - 1e-8 and (not kept or value - kept[-1] > 1e-12):
            kept.append(value)
    return kept
