"""Slopes: how a method's error falls with its cost, and whether that is as it should be."""

from __future__ import annotations

import math
from collections.abc import Container, Iterable
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from radiokit.faces.bench.rows import ROUNDING, Row
from radiokit.facts.jsonable import jsonable

__all__ = ["DUE", "Slope", "fit"]

DUE = {"mc": "N^-0.5", "qmc": "N^-0.9 or steeper", "slope rule": "geometric"}
"""What each method owes: the sampled ones where the lobe is broad, the rule everywhere."""

_QMC = -0.9
_STEEP = -4.0
"""Over a handful of points an irregular geometric law is hardly told from a power, but no rule that a kink
spoils falls as N⁻⁴, which is n⁻⁸."""
_SIGMAS = 5.0


@dataclass(frozen=True)
class Slope:
    """How a method's error falls on one task: as a power of the evaluations, or by a factor per node.

    ``noise`` is the standard error of a sampled method's ``rate``, whose points are root mean squares of few
    seeds, and ``claimed_rate`` the slope of its standard errors, which are less noisy. ``digits`` is what a
    rule gains per node along an axis. ``met`` says whether the law is the one that is ``due``; both are None
    where none is.
    """

    task: str
    method: str
    law: Literal["power", "geometric"]
    rate: float
    points: int
    noise: float | None = None
    claimed_rate: float | None = None
    digits: float | None = None
    due: str | None = None
    met: bool | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the slope as JSON-ready data."""
        return {name: jsonable(value) for name, value in asdict(self).items()}

    def __str__(self) -> str:
        return f"N^{self.rate:.2f}" if self.law == "power" else f"{self.rate:.2f}^n"


def fit(rows: Iterable[Row], *, broad: Container[str] = (), repeats: int = 7) -> list[Slope]:
    """Return the slopes of all methods on all tasks that leave at least three points above rounding.

    A law is ``geometric``, error ~ rateⁿ for n nodes along an axis, where that fits the logarithms of the
    errors better than a power of the evaluations does; sampled means are always fitted by a power.

    Parameters
    ----------
    rows : iterable of Row
    broad : container of str
        Names of the tasks on which sampling owes its law: a narrow lobe's weight lies in events too rare, or
        behind an edge too steep, for the sizes of a bench.
    repeats : int
        Seeds that each sampled error is the root mean square of.
    """
    groups: dict[tuple[str, str], list[Row]] = {}
    for each in rows:
        if each.method != "quadrature" and each.true_error > 10 * ROUNDING * abs(each.exact):
            groups.setdefault((each.task, each.method), []).append(each)
    return [
        _slope(task, method, group, task in broad, repeats)
        for (task, method), group in groups.items()
        if len(group) >= 3
    ]


def _slope(task: str, method: str, group: list[Row], broad: bool, repeats: int) -> Slope:
    errors = np.log([each.true_error for each in group])
    work = np.log([each.evaluations for each in group])
    power, misfit = _line(work, errors)
    due = DUE.get(method)
    if group[0].kind == "statistical":
        claims = [each.claimed_error or math.nan for each in group]
        claimed = _line(work, np.log(claims))[0] if min(claims) > 0 else None
        # The logarithm of a root mean square of n normal numbers has a standard error of about 1/√(2n).
        noise = 1 / math.sqrt(2 * repeats * float(np.sum((work - work.mean()) ** 2)))
        met = None
        if due is not None and broad:
            rates = [(power, noise), (claimed, noise / math.sqrt(10))] if claimed else [(power, noise)]
            met = all(_falls(method, rate, _SIGMAS * error) for rate, error in rates)
        return Slope(
            task, method, "power", power, len(group), noise, claimed, None, due if broad else None, met
        )
    per_node, other = _line(np.array([each.size for each in group]), errors)
    law: Literal["power", "geometric"] = "geometric" if other <= misfit else "power"
    rate = math.exp(per_node) if law == "geometric" else power
    met = None if due is None else per_node < 0 and (law == "geometric" or power <= _STEEP)
    digits = -per_node / math.log(10)
    return Slope(task, method, law, rate, len(group), digits=digits, due=due, met=met)


def _falls(method: str, rate: float, slack: float) -> bool:
    """Return whether a sampled error falls as it should, within the slack."""
    return rate <= _QMC + slack if method == "qmc" else abs(rate + 0.5) <= slack


def _line(x: Any, y: Any) -> tuple[float, float]:
    """Return the slope of the line through the points, and the sum of squares that it leaves."""
    design = np.stack([np.asarray(x, dtype=float), np.ones(len(x))], axis=1)
    (slope, offset), *_ = np.linalg.lstsq(design, np.asarray(y), rcond=None)
    return float(slope), float(np.sum((design @ [slope, offset] - y) ** 2))
