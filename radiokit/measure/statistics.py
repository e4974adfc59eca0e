"""Statistics: hypothesis tests and intervals for judging what was sampled, with corrected levels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate, student_widening

__all__ = ["ChiSquare", "bernstein_test", "binomial_interval", "chi_square", "sidak", "z_test"]


def sidak(level: float, tests: int) -> float:
    """Return the level for each of ``tests`` independent tests, so that ``level`` holds for all together.

    Parameters
    ----------
    level : float
        The probability that one right thing or more is rejected, in (0, 1).
    tests : int
        How many tests there are, at least 1.

    Raises
    ------
    ParameterError
        When an argument is out of its range.

    Source: Šidák (1967), Rectangular confidence regions for the means of multivariate normal
    distributions, Journal of the American Statistical Association 62(318).

    >>> round(sidak(0.05, 10), 6)
    0.005116
    """
    _check_level(level)
    if tests < 1:
        raise ParameterError("tests", tests, "at least 1")
    return -math.expm1(math.log1p(-level) / tests)


def z_test(estimate: Estimate, exact: npt.ArrayLike) -> Any:
    """Return the two-sided p-value of a Monte Carlo mean, were ``exact`` the truth.

    By the normal distribution, or by Student's where the estimate has few degrees of freedom.

    Parameters
    ----------
    estimate : Estimate
        Of kind ``"statistical"``.
    exact : array_like
        The exact mean; the result has the shape of ``estimate.value - exact``.

    Raises
    ------
    ParameterError
        When the estimate's error is a bound and no standard error.

    >>> round(z_test(Estimate(1.0, 0.5, "statistical"), 2.0), 4)
    0.0455
    """
    if estimate.is_bound:
        raise ParameterError("estimate.kind", estimate.kind, "'statistical'")
    difference, error = np.broadcast_arrays(np.abs(np.subtract(estimate.value, exact)), estimate.error)
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.where(difference == 0, 0.0, difference / error)
    if estimate.dof is None:
        p = np.array([math.erfc(score / math.sqrt(2)) for score in z.flat]).reshape(z.shape)
    else:
        from scipy.special import stdtr

        p = np.asarray(2 * stdtr(estimate.dof, -z * student_widening(estimate.dof)))
    return p if p.ndim else float(p)


@dataclass(frozen=True)
class ChiSquare:
    """A chi-square test's result; ``pooled`` counts the cells that were too small to stand alone."""

    statistic: float
    dof: int
    p_value: float
    pooled: int


def chi_square(observed: npt.ArrayLike, expected: npt.ArrayLike, *, min_expected: float = 5.0) -> ChiSquare:
    """Return Pearson's chi-square test of counts against the counts that are expected.

    Cells in which less than ``min_expected`` is expected are pooled in ascending order until each pool has
    enough; a remainder joins the last pool. A count where nothing is expected refutes at once: p is 0.

    Parameters
    ----------
    observed : array_like of int
        Counts, in any shape.
    expected : array_like, same shape
        Probabilities times the number of samples. It sums to the number of samples, to a tenth of its
        square root: give samples that fall outside all cells a cell of their own.
    min_expected : float
        Above 0.

    Raises
    ------
    ParameterError
        When counts are negative, shapes or sums differ, or fewer than two cells remain.

    Source: Cochran (1952), The χ² test of goodness of fit, The Annals of Mathematical Statistics 23(3),
    section 7, on the smallest expectations; doi:10.1214/aoms/1177729380.

    >>> chi_square([10, 12, 8, 0], [10, 10, 9.5, 0.5]).pooled
    1
    """
    counts, means = (np.asarray(x, dtype=np.float64).ravel() for x in (observed, expected))
    if np.shape(observed) != np.shape(expected):
        raise ParameterError(
            "expected", np.shape(expected), f"of the shape of observed, {np.shape(observed)}"
        )
    for name, values in (("observed", counts), ("expected", means)):
        if not (np.isfinite(values) & (values >= 0)).all():
            raise ParameterError(name, values[~(values >= 0)], "finite and at least 0")
    if not min_expected > 0:
        raise ParameterError("min_expected", min_expected, "above 0")
    total = float(counts.sum())
    if abs(float(means.sum()) - total) > 0.1 * math.sqrt(total):
        allowed = f"a sum of {total:g}, the number observed, to {0.1 * math.sqrt(total):.2g}"
        raise ParameterError("expected", float(means.sum()), allowed)
    small = means < min_expected
    if np.any(counts[means == 0] > 0):
        return ChiSquare(math.inf, max(1, int(np.count_nonzero(means)) - 1), 0.0, int(small.sum()))
    pools = _pool(counts[small], means[small], min_expected)
    cells = [*zip(counts[~small], means[~small], strict=True), *pools]
    if len(cells) > 1 and cells[-1][1] < min_expected:  # too little for a pool: joins the smallest cell
        rest = cells.pop()
        at = min(range(len(cells)), key=lambda i: cells[i][1])
        cells[at] = (cells[at][0] + rest[0], cells[at][1] + rest[1])
    if len(cells) < 2:
        raise ParameterError("expected", total, f"enough for two cells of {min_expected:g} or more")
    statistic = math.fsum((count - mean) ** 2 / mean for count, mean in cells)
    from scipy.special import chdtrc

    dof = len(cells) - 1
    return ChiSquare(statistic, dof, float(chdtrc(dof, statistic)), int(small.sum()))


def _pool(
    counts: npt.NDArray[np.float64], means: npt.NDArray[np.float64], least: float
) -> list[tuple[float, float]]:
    """Pool cells in ascending order of expectation; only a lone last pool may hold less than ``least``."""
    pools: list[tuple[float, float]] = []
    count = mean = 0.0
    for index in np.argsort(means, kind="stable"):
        count, mean = count + float(counts[index]), mean + float(means[index])
        if mean >= least:
            pools.append((count, mean))
            count = mean = 0.0
    if mean > 0 and pools:
        last = pools.pop()
        pools.append((last[0] + count, last[1] + mean))
    elif mean > 0:
        pools.append((count, mean))
    return pools


def binomial_interval(successes: int, trials: int, level: float = 0.95) -> tuple[float, float]:
    """Return the Clopper–Pearson interval for a probability: it covers with ``level`` or more.

    Parameters
    ----------
    successes, trials : int
        0 ≤ successes ≤ trials, trials ≥ 1.
    level : float
        In (0, 1).

    Raises
    ------
    ParameterError
        When an argument is out of its range.

    Source: Clopper, Pearson (1934), The use of confidence or fiducial limits illustrated in the case of
    the binomial, Biometrika 26(4); doi:10.1093/biomet/26.4.404.

    >>> [round(end, 4) for end in binomial_interval(95, 100)]
    [0.8872, 0.9836]
    """
    _check_level(level)
    if trials < 1:
        raise ParameterError("trials", trials, "at least 1")
    if not 0 <= successes <= trials:
        raise ParameterError("successes", successes, f"in [0, {trials}]")
    from scipy.special import betaincinv

    tail, failures = 0.5 * (1.0 - level), trials - successes
    low = float(betaincinv(successes, failures + 1, tail)) if successes else 0.0
    high = float(betaincinv(successes + 1, failures, 1.0 - tail)) if failures else 1.0
    return low, high


def bernstein_test(values: npt.ArrayLike, exact: float, error: float = 0.0) -> float:
    """Return a p-value for the mean of non-negative samples that is safe when rare ones matter.

    A z-test trusts the sample variance, which is 0 when the events that carry the difference were never
    drawn. The empirical Bernstein bound adds what such events could do, for values that range from 0 to
    the largest seen; it rejects a right mean no more often than it says, and a wrong one a little later.

    Parameters
    ----------
    values : array_like, shape (N,)
        At least 0.
    exact : float
        The mean under test.
    error : float
        What ``exact`` may itself be off by.

    Source: Audibert, Munos, Szepesvári (2009), Exploration-exploitation tradeoff using variance estimates,
    Theoretical Computer Science 410(19), theorem 1; doi:10.1016/j.tcs.2009.01.016.

    >>> bernstein_test([1.0] * 1000, 1.0), bernstein_test([1.0] * 1000, 1.5) < 1e-50
    (1.0, True)
    """
    values = np.asarray(values, dtype=float)
    difference = abs(float(values.mean()) - exact) - error
    if difference <= 0:
        return 1.0
    spread = math.sqrt(2 * float(values.var()) / values.size)
    reach = 3 * float(values.max()) / values.size
    if spread == reach == 0:
        return 0.0
    # |mean − exact| ≤ spread √x + reach x with probability 1 − 3 exp(−x), solved for x
    root = 2 * difference / (spread + math.sqrt(spread * spread + 4 * reach * difference))
    return min(1.0, 3 * math.exp(-root * root))


def _check_level(level: float) -> None:
    if not 0 < level < 1:
        raise ParameterError("level", level, "in (0, 1)")
