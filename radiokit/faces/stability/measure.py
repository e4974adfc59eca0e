"""Measuring a row: ulps over the condition number, of kernel and textbook, against 50 digits."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.faces.stability.row import PRECISIONS, Precision, Row
from radiokit.facts.errors import UnknownNameError
from radiokit.facts.jsonable import jsonable
from radiokit.facts.verdict import Outcome
from radiokit.measure.twin import Twin, scaled_ulps, ulps, working_precision

__all__ = ["FAILS", "LIMIT", "Accuracy", "StabilityResult", "agreement", "measure", "rows", "stability"]

LIMIT = 8.0
"""Ulps, over the condition number, that a kernel may be wrong by anywhere on its hard axis."""

FAILS = 100.0
"""Ulps, over the condition number, beyond which a formula has failed."""

_DIGITS = 50
_TEXTBOOK_DIGITS = 900  # more than any of these formulas can cancel


@dataclass(frozen=True)
class Accuracy:
    """How one form does in one precision.

    Parameters
    ----------
    values : tuple of float
        Where on the axis.
    errors : tuple of float
        Error in ulps over max(1, condition number), the worst of the variants at each value of the axis;
        infinite where the form gives NaN or infinity.
    worst, at : float
        The largest of them, and the value of the axis where it is.
    digits : float
        Correct decimal digits where fewest are left, whatever the condition number.
    inside : str
        The precision that the form computes in: a kernel may take float32 and work in float64.
    """

    values: tuple[float, ...]
    errors: tuple[float, ...]
    worst: float
    at: float
    digits: float
    inside: str

    @property
    def finite(self) -> bool:
        """Whether every value was finite."""
        return bool(np.isfinite(self.worst))

    def to_json(self) -> dict[str, Any]:
        """Return the accuracy as JSON-ready data; an infinite error is text."""
        data = {name: getattr(self, name) for name in self.__dataclass_fields__}
        result: dict[str, Any] = jsonable(data | {"finite": self.finite})
        return result


@dataclass(frozen=True)
class StabilityResult:
    """What was measured on one row: kernel and textbook by precision, and the largest condition number."""

    row: Row
    kernel: dict[str, Accuracy]
    textbook: dict[str, Accuracy]
    condition: float

    @property
    def outcome(self) -> Outcome:
        """``holds`` if the kernel is finite and within ``LIMIT`` in every precision, or else ``violated``."""
        return Outcome.HOLDS if all(a.worst <= LIMIT for a in self.kernel.values()) else Outcome.VIOLATED

    @property
    def textbook_fails(self) -> tuple[str, ...]:
        """The precisions in which the textbook's formula was seen to fail."""
        return tuple(name for name, accuracy in self.textbook.items() if not accuracy.worst <= FAILS)

    @property
    def exit_code(self) -> int:
        """0 if the kernel holds, 1 if not."""
        return int(self.outcome is not Outcome.HOLDS)

    def to_json(self) -> dict[str, Any]:
        """Return the result as JSON-ready data, the lesson included."""
        row = self.row
        texts = ("name", "title", "axis", "kernel_name", "kernel_form", "textbook_form", "lesson")
        result: dict[str, Any] = jsonable(
            {name: getattr(row, name) for name in texts}
            | {
                "source": row.source,
                "outcome": str(self.outcome),
                "limit": LIMIT,
                "condition": self.condition,
                "kernel": self.kernel,
                "textbook": self.textbook,
                "textbook_fails": self.textbook_fails,
            }
        )
        return result


def rows() -> dict[str, Row]:
    """Return every row by name.

    >>> rows()["cap-solid-angle"].textbook_form
    '2π (1 − cos θ)'
    """
    from radiokit.faces.stability import directions, estimators, fresnel, microfacet, phong, warps

    families = (directions, warps, fresnel, microfacet, phong, estimators)
    return {row.name: row for family in families for row in family.ROWS}


def stability(names: str | Iterable[str] | None = None) -> tuple[StabilityResult, ...]:
    """Measure the rows called ``names``, or all of them.

    Raises
    ------
    UnknownNameError
        When there is no such row.

    >>> result = stability("cap-solid-angle")[0]
    >>> str(result.outcome), result.textbook_fails, result.textbook["float64"].digits
    ('holds', ('float64', 'float32'), 0.0)
    """
    known = rows()
    wanted = list(known) if names is None else [names] if isinstance(names, str) else list(names)
    for name in wanted:
        if name not in known:
            raise UnknownNameError("stability row", name, known)
    return tuple(measure(known[name]) for name in wanted)


def measure(row: Row) -> StabilityResult:
    """Return how far kernel and textbook are from the truth, in float64 and in float32.

    Both are given the same arguments, rounded to the precision; the truth is that of the rounded arguments,
    to 50 digits. An error is counted in units of the last place of that precision and divided by
    max(1, Σ|x ∂f/∂x| / |f|): what is left is the form's fault and not the problem's.
    """
    twin = row.twin()
    kernel: dict[str, Accuracy] = {}
    textbook: dict[str, Accuracy] = {}
    largest = 0.0
    for name, precision in PRECISIONS.items():
        columns = row.columns(precision)
        flat = [column.ravel() for column in columns]
        truth, condition = _truth(twin, flat)
        largest = max(largest, float(np.max(condition, where=np.isfinite(condition), initial=0.0)))
        with np.errstate(all="ignore"):
            values = row.kernel(*flat), row.textbook(np, *flat)
        kernel[name], textbook[name] = (
            _accuracy(row, value, truth, condition, precision, columns[0].shape) for value in values
        )
    return StabilityResult(row, kernel, textbook, largest)


def agreement(row: Row) -> float:
    """Return the digits to which the textbook's formula, worked out with 900, agrees with the truth.

    At most 50: both are then one function, and what the formula loses in floats is lost by rounding alone.
    0 where the truth, or the formula, is another.
    """
    import mpmath

    twin = row.twin()
    worst = 0.0
    for precision in PRECISIONS.values():
        for point in zip(*(column.ravel().tolist() for column in row.columns(precision)), strict=True):
            truth = twin.at(*point, digits=_DIGITS)
            with working_precision(_TEXTBOOK_DIGITS):
                value = row.textbook(mpmath, *map(mpmath.mpf, point))
                off = abs(value - truth) / abs(truth) if truth else abs(value)
            worst = max(worst, float(off))
    return float(min(_DIGITS, -np.log10(worst))) if 0.0 < worst < 1.0 else _DIGITS * (worst == 0.0)


def _truth(twin: Twin, columns: list[Any]) -> tuple[list[Any], Any]:
    """Return the truth to 50 digits, and the condition number, at each point."""
    points = list(zip(*(column.tolist() for column in columns), strict=True))
    return (
        [twin.at(*point, digits=_DIGITS) for point in points],
        np.array([twin.condition_at(*point) for point in points]),
    )


def _accuracy(
    row: Row, value: Any, truth: list[Any], condition: Any, precision: Precision, shape: tuple[int, ...]
) -> Accuracy:
    errors = np.max(np.reshape(scaled_ulps(value, truth, condition, precision), shape), axis=1)
    size = np.abs(np.array([float(t) for t in truth]))
    unit = np.spacing(size.astype(precision)).astype(np.float64)
    off = np.asarray(ulps(value, truth, precision)) * unit
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(off > 0.0, off / size, 0.0)
        left = np.clip(-np.log10(relative), 0.0, -np.log10(np.finfo(precision).eps / 2))
    worst = int(np.argmax(errors))
    values = row.along(precision)
    return Accuracy(
        values=values,
        errors=tuple(errors.tolist()),
        worst=float(errors[worst]),
        at=values[worst],
        digits=float(np.min(left)) + 0.0,
        inside=np.asarray(value).dtype.name,
    )
