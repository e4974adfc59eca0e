"""Lights: every closed form of the light side, at hard configurations, against 50 digits."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

from radiokit.faces.workers import SerialExecutor
from radiokit.facts.errors import UnknownNameError
from radiokit.facts.estimate import Estimate
from radiokit.facts.jsonable import jsonable
from radiokit.facts.verdict import Outcome
from radiokit.measure.twin import ulps, working_precision

__all__ = ["LIMIT", "Case", "LightResult", "LightRow", "examine_light", "light_rows", "light_stability"]

LIMIT = 16.0
"""Ulps, over the condition number, that a closed form may be wrong by."""

_DIGITS = 50
_STEP = 25  # digits of the steps by which the condition number is found
_NOTHING = 1100  # a power of 2 below which a truth that shrinks with every digit is 0
_CLOSED = (80, 160, 480, 1000)
_SHORT = 4

Case = tuple[str, tuple[float, ...]]
"""What a configuration is called, and the float64 numbers that it is."""


@dataclass(frozen=True, kw_only=True)
class LightRow:
    """A closed form, where it is hard to compute, and the truth.

    Parameters
    ----------
    name : str
        As ``radiokit stability --lights NAME`` takes it.
    truth : str
        How the truth is found, and where from.
    kernel : callable
        Takes a configuration's numbers as floats, returns an ``Estimate``, or a float without a bound.
    exact : callable
        Takes them as multiple-precision numbers, returns the truth at the working precision.
    cases : tuple of Case
    whole : int
        How many numbers, the last ones, are integers, with respect to which there is no condition number.
    textbook : callable, optional
        Takes the floats: the formula that a textbook prints, for comparison.
    digits : tuple of int
        The precisions at which the truth is evaluated until two agree to 50 digits.
    """

    name: str
    truth: str
    kernel: Callable[..., Any]
    exact: Callable[..., Any]
    cases: tuple[Case, ...]
    whole: int = 0
    textbook: Callable[..., float] | None = None
    digits: tuple[int, ...] = _CLOSED


@dataclass(frozen=True)
class LightResult:
    """How a closed form does over its configurations.

    Parameters
    ----------
    name, truth : str
        The row's.
    worst : float
        Largest error, in ulps over max(1, condition number); infinite where the value is not finite.
    raw, condition : float
        The ulps and the condition number there; the latter 1 where an error needs none to be within an ulp.
    where : str
        Which configuration that is.
    numbers : tuple of float
        Its numbers.
    textbook : float or None
        The largest error of the textbook's formula.
    cases, nonfinite, bounds : int
        How many configurations; values that were NaN or infinite; values that had a bound.
    broken : tuple of str
        The configurations whose bound does not hold.
    undecided : tuple of str
        Those whose truth does not settle.
    seconds : float
    """

    name: str
    truth: str
    worst: float
    raw: float
    condition: float
    where: str
    numbers: tuple[float, ...]
    textbook: float | None
    cases: int
    nonfinite: int
    bounds: int
    broken: tuple[str, ...]
    undecided: tuple[str, ...]
    seconds: float

    @property
    def outcome(self) -> Outcome:
        """``holds`` if all is within the limit and the bounds, ``violated`` if not, else ``inconclusive``."""
        if self.worst > LIMIT or self.nonfinite or self.broken:
            return Outcome.VIOLATED
        return Outcome.INCONCLUSIVE if self.undecided else Outcome.HOLDS

    def to_json(self) -> dict[str, Any]:
        """Return the result as JSON-ready data; an infinite error is text."""
        data = {name: getattr(self, name) for name in self.__dataclass_fields__}
        result: dict[str, Any] = jsonable(data | {"limit": LIMIT, "outcome": str(self.outcome)})
        return result


def light_rows() -> dict[str, LightRow]:
    """Return every row by name.

    >>> "sphere irradiance" in light_rows()
    True
    """
    from radiokit.faces.stability import factorrows, flatrows, roundrows, skyrows

    families = (roundrows, flatrows, skyrows, factorrows)
    return {row.name: row for family in families for row in family.rows()}


def light_stability(
    names: Iterable[str] | None = None,
    *,
    short: bool = False,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[LightResult, ...]:
    """Examine the rows called ``names``, or all of them.

    Parameters
    ----------
    names : iterable of str, optional
    short : bool
        Whether a few of each row's configurations suffice.
    executor : concurrent.futures.Executor, optional
        Where the work is done; the findings do not depend on it.
    progress : callable, optional
        Called with the number of finished rows and the number of all.

    Raises
    ------
    UnknownNameError
        When there is no such row.

    >>> [str(result.outcome) for result in light_stability(["point irradiance"])]
    ['holds']
    """
    known = light_rows()
    wanted = list(known) if names is None else list(names)
    for name in wanted:
        if name not in known:
            raise UnknownNameError("row of lights", name, known)
    found = []
    tasks = [(name, short) for name in wanted]
    for done, result in enumerate((executor or SerialExecutor()).map(_task, tasks), start=1):
        found.append(result)
        if progress is not None:
            progress(done, len(tasks))
    return tuple(found)


def _task(task: tuple[str, bool]) -> LightResult:
    return examine_light(light_rows()[task[0]], short=task[1])


def examine_light(row: LightRow, *, short: bool = False) -> LightResult:
    """Return how far a row's kernel is from the truth.

    The condition number is Σ|x ∂f/∂x| / |f| over all numbers of the configuration, as float64 holds them, by
    central differences of the truth. It costs more than the value does: errors of more than an ulp are gone
    through from the largest down, until the next one is below the worst quotient found.
    """
    start = time.perf_counter()
    cases = row.cases[:: max(1, len(row.cases) // _SHORT)] if short else row.cases
    values, truths, known = [], [], []
    broken, undecided = [], []
    nonfinite = bounds = 0
    for case in cases:
        label, numbers = case
        found = row.kernel(*numbers)
        value, error = (found.value, found.error) if isinstance(found, Estimate) else (found, None)
        nonfinite += not math.isfinite(value)
        settled = _settled(row, numbers)
        if settled is None:
            undecided.append(label)
            continue
        truth, digits = settled
        if error is not None:
            bounds += 1
            with working_precision(_DIGITS):
                if not abs(float(value) - truth) <= float(error):
                    broken.append(label)
        values.append(float(value))
        truths.append(truth)
        known.append((case, digits))
    conditions: dict[int, float] = {}
    worst, raw, at = _worst(row, known, values, truths, conditions)
    textbook = None
    if row.textbook is not None:
        theirs = [_quietly(row.textbook, numbers) for (_, numbers), _ in known]
        textbook = _worst(row, known, theirs, truths, conditions)[0]
    return LightResult(
        name=row.name,
        truth=row.truth,
        worst=worst,
        raw=raw,
        condition=conditions.get(at, 1.0),
        where=known[at][0][0] if known else "",
        numbers=known[at][0][1] if known else (),
        textbook=textbook,
        cases=len(cases),
        nonfinite=nonfinite,
        bounds=bounds,
        broken=tuple(broken),
        undecided=tuple(undecided),
        seconds=time.perf_counter() - start,
    )


def _worst(
    row: LightRow,
    cases: list[tuple[Case, int]],
    values: list[float],
    truths: list[Any],
    conditions: dict[int, float],
) -> tuple[float, float, int]:
    """Return the largest error over the condition number, the ulps there, and where."""
    errors = [float(ulps(value, truth)) for value, truth in zip(values, truths, strict=True)]
    worst, raw, at = 0.0, 0.0, 0
    for k in sorted(range(len(cases)), key=lambda k: -errors[k]):
        if errors[k] <= worst:
            break
        if errors[k] > 1 and math.isfinite(errors[k]):
            if k not in conditions:
                conditions[k] = _condition(row, cases[k][0][1], cases[k][1])
            scaled = errors[k] / max(1.0, conditions[k])
        else:
            scaled = errors[k]
        if scaled > worst:
            worst, raw, at = scaled, errors[k], k
    return worst, raw, at


def _quietly(formula: Callable[..., float], numbers: tuple[float, ...]) -> float:
    try:
        return formula(*numbers)
    except (ArithmeticError, ValueError):
        return math.nan


def _settled(row: LightRow, numbers: tuple[float, ...]) -> tuple[Any, int] | None:
    """Return the truth to 50 digits and the precision that has them, or None where no two agree."""
    import mpmath

    before = None
    for digits in row.digits:
        with working_precision(digits):
            try:
                value = row.exact(*map(mpmath.mpf, numbers))
            except ZeroDivisionError:
                continue
            agreed = before is not None and abs(value - before) <= abs(value) * mpmath.mpf(10) ** -_DIGITS
            if value and agreed:
                return value, digits
            nothing = before is not None and max(abs(value), abs(before)) < mpmath.mpf(2) ** -_NOTHING
            if nothing and digits == row.digits[-1]:  # what is 0 with many digits may not be with more
                return mpmath.mpf(0), digits
            before = value
    return None


def _condition(row: LightRow, numbers: tuple[float, ...], digits: int) -> float:
    """Return Σ|x ∂f/∂x| / |f|, where f has 50 digits; 0, which excuses nothing, for f = 0."""
    import mpmath

    with working_precision(digits):
        exact = [mpmath.mpf(x) for x in numbers]
        value = row.exact(*exact)
        if not value:
            return 0.0
        total, step = mpmath.mpf(0), mpmath.mpf(10) ** -_STEP
        for k in range(len(exact) - row.whole):
            if exact[k]:
                up, down = (
                    row.exact(*exact[:k], exact[k] * factor, *exact[k + 1 :])
                    for factor in (1 + step, 1 - step)
                )
                total += abs(up - down) / (2 * step)
        return float(total / abs(value))
