"""Estimate: a number with its error and its cost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any, Literal

import numpy as np

from radiokit.facts.errors import ParameterError
from radiokit.facts.jsonable import jsonable

__all__ = ["Estimate", "Kind", "rounding", "student_widening"]

Kind = Literal["rounding", "truncation", "statistical"]
_KINDS = ("rounding", "truncation", "statistical")


@dataclass(frozen=True)
class Estimate:
    """A value, how wrong it may be, and what it cost.

    Parameters
    ----------
    value : float or ndarray
    error : float or ndarray
        At least 0, in the unit of ``value``. What it means depends on ``kind``.
    kind : {"rounding", "truncation", "statistical"}
        ``rounding``: a bound on the rounding error of a closed form. ``truncation``: a bound on the error
        of a quadrature. ``statistical``: the standard error of a Monte Carlo mean.
    evaluations : int
        How often the integrand was evaluated; 0 for a closed form.
    seconds : float
        Wall time [s].
    method : str
    converged : bool
        False when the requested tolerance was not reached; ``note`` then says why.
    note : str
    dof : float, optional
        Degrees of freedom of a standard error that comes from few independent replicates. ``error`` is then
        widened by ``student_widening``; None for many samples.

    >>> estimate = Estimate(0.5, 0.01, "statistical", evaluations=1000)
    >>> print(estimate)
    0.500 ± 0.010 (standard error)
    >>> low, high = estimate.interval(0.95)
    >>> bool(low < 0.5 < high), estimate.covers(0.53)
    (True, False)
    """

    value: Any
    error: Any
    kind: Kind
    evaluations: int = 0
    seconds: float = 0.0
    method: str = ""
    converged: bool = True
    note: str = ""
    dof: float | None = None

    def __post_init__(self) -> None:
        if self.kind not in _KINDS:
            raise ParameterError("kind", self.kind, f"one of {', '.join(_KINDS)}")
        if np.any(np.asarray(self.error) < 0) or np.any(np.isnan(self.error)):
            raise ParameterError("error", self.error, "at least 0")

    @property
    def is_bound(self) -> bool:
        """True when ``error`` is a bound, False when it is a standard error."""
        return self.kind != "statistical"

    @property
    def efficiency(self) -> Any:
        """The reciprocal of variance times time, 1/(error² · seconds); None for a bound, or an unknown time.

        It does not grow with the number of samples of a Monte Carlo mean, and so compares methods.

        >>> Estimate(0.5, 0.1, "statistical", seconds=2.0).efficiency.round(6).item()
        50.0
        """
        if self.is_bound or not self.seconds > 0:
            return None
        with np.errstate(divide="ignore"):
            return np.divide(1.0, np.square(self.error) * self.seconds)

    def interval(self, level: float = 0.95) -> tuple[Any, Any]:
        """Return the interval that holds the truth: surely for a bound, with ``level`` otherwise."""
        if not 0 < level < 1:
            raise ParameterError("level", level, "in (0, 1)")
        factor = 1.0 if self.is_bound else _quantile(0.5 + level / 2, self.dof)
        return self.value - factor * self.error, self.value + factor * self.error

    def covers(self, exact: Any, level: float = 0.95) -> bool:
        """Return whether ``exact`` lies in the interval, for every element."""
        low, high = self.interval(level)
        return bool(np.all((low <= exact) & (exact <= high)))

    def ratio(self, exact: Any) -> float:
        """Return the largest ``|value − exact| / error``: at most 1 for an honest bound, a z-score else."""
        difference = np.abs(np.asarray(self.value) - exact)
        error = np.asarray(self.error, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(difference == 0, 0.0, difference / error)
        return float(np.max(ratio))

    def scaled(self, factor: Any) -> Estimate:
        """Return this estimate times an exactly known factor, or one for each wavelength."""
        return replace(self, value=self.value * factor, error=self.error * np.abs(factor))

    def __add__(self, other: Estimate) -> Estimate:
        """Add two independent estimates; bounds add, standard errors add in quadrature.

        A bound beside a standard error is added to it, which only widens the interval.
        """
        if not isinstance(other, Estimate):
            return NotImplemented
        if self.is_bound or other.is_bound:
            error = self.error + other.error
        else:
            error = np.hypot(self.error, other.error)
        kind = max(self.kind, other.kind, key=_KINDS.index)
        return Estimate(
            self.value + other.value,
            error,
            kind,
            self.evaluations + other.evaluations,
            self.seconds + other.seconds,
            " + ".join(dict.fromkeys(filter(None, (self.method, other.method)))),
            self.converged and other.converged,
            "; ".join(dict.fromkeys(filter(None, (self.note, other.note)))),
            # The sum has at least as many (Welch, Satterthwaite), so that its interval is not too short.
            min(filter(None, (self.dof, other.dof)), default=None),
        )

    def __float__(self) -> float:
        return float(self.value)

    def __str__(self) -> str:
        meaning = "bound" if self.is_bound else "standard error"
        if np.ndim(self.value) or np.ndim(self.error):
            return f"{self.value} ± {self.error} ({meaning})"
        return f"{_with_error(float(self.value), float(self.error))} ({meaning})"

    def to_json(self) -> dict[str, Any]:
        """Return the estimate as JSON-ready data."""
        return {name: jsonable(getattr(self, name)) for name in (*self.__dataclass_fields__, "efficiency")}


def student_widening(dof: float) -> float:
    """Return t/z, the ratio of Student's quantile and the normal one at 95 %, two-sided.

    A standard error from ``dof`` + 1 replicates, times this, covers 95 % when it is read as a normal one.
    Good to 2e-5 from 7 degrees of freedom on.

    Source: Abramowitz, Stegun (1964), Handbook of Mathematical Functions, 26.7.5.

    >>> round(student_widening(15) * 1.959963985, 4)
    2.1314
    """
    z = NormalDist().inv_cdf(0.975)
    terms = (
        (z**2 + 1) / 4,
        (5 * z**4 + 16 * z**2 + 3) / 96,
        (3 * z**6 + 19 * z**4 + 17 * z**2 - 15) / 384,
        (79 * z**8 + 776 * z**6 + 1482 * z**4 - 1920 * z**2 - 945) / 92160,
    )
    return 1 + sum(term / dof**power for power, term in enumerate(terms, start=1))


def _quantile(p: float, dof: float | None) -> float:
    """Return the quantile by which a standard error counts: Student's over the widening, or the normal."""
    if dof is None:
        return NormalDist().inv_cdf(p)
    from scipy.special import stdtrit

    return float(stdtrit(dof, p)) / student_widening(dof)


def rounding(value: Any, *, ulps: float = 4.0, method: str = "closed form") -> Estimate:
    """Return a closed form's value, with a rounding bound of ``ulps`` units in the last place.

    >>> print(rounding(1.0).error < 1e-15)
    True
    """
    return Estimate(value, ulps * np.spacing(np.abs(value)), "rounding", method=method)


def _with_error(value: float, error: float) -> str:
    if not np.isfinite(value) or error == 0:
        return f"{value:.15g} ± {error:.2g}"
    if error < 1e-6 * abs(value) or error > abs(value):
        return f"{value:.15g} ± {error:.1e}" if error < abs(value) else f"{value:.3g} ± {error:.2g}"
    digits = max(0, 1 - int(np.floor(np.log10(error))))
    return f"{value:.{digits}f} ± {error:.{digits}f}"
