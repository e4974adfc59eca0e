"""Quadrature over the hemisphere and over rectangles, each with an error bound and a stated cost."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import NonFiniteError, ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.slope import find_lobe, gauss_legendre, mirrored, slope_map, slope_rule, turned

__all__ = ["BLOCK", "box", "converge", "hemisphere"]

FloatArray = npt.NDArray[np.float64]
Integrand = Callable[[FloatArray], Any]

SIZES = (16, 24, 32, 48, 64, 96, 128, 192)
"""Nodes along each axis, tried in turn until rules agree."""

WIDTHS = (1.0, 1.35, 0.8, 1.2, 0.9, 1.1, 0.85, 1.0)
"""Factors on the lobe's width, so that consecutive rules do not fail in the same way."""

SAFETY = 2.0
"""Factor on the difference of two rules; the coarser one errs far more than the finer one."""

MEMORY = 0.01
"""Share of the last-but-one difference that the bound keeps, against an accidental agreement."""

ROUNDING = 64 * float(np.finfo(float).eps)
"""Rounding of a weighted sum, relative to the sum of absolute terms; 21 eps is the most seen."""

BLOCK = 1 << 16
"""Points in one call of an integrand, so that its temporaries stay in cache."""

_GK21 = 2 * 21 * 21 * 4  # points of a subdivision of SciPy's cubature in two dimensions: value and error


@dataclass(frozen=True)
class _Sum:
    """What one rule gave: the sum, the sum of absolute terms, and the points used."""

    value: Any
    size: Any
    points: int


def _apply(integrand: Integrand, points: FloatArray, weight: FloatArray) -> _Sum:
    """Sum weighted values in blocks, refusing values that are not finite."""
    value: Any = 0.0
    size: Any = 0.0
    for start in range(0, len(points), BLOCK):
        part = points[start : start + BLOCK]
        found = np.asarray(integrand(part), dtype=float)
        if not np.all(np.isfinite(found)):
            row = int(np.argwhere(~np.isfinite(found))[0][0])
            raise NonFiniteError(
                f"the integrand is {found[row]} at {tuple(part[row].tolist())}",
                value=found[row],
                at=part[row].copy(),
            )
        w = weight[start : start + BLOCK]
        value = value + w @ found
        size = size + w @ np.abs(found)
    return _Sum(value, size, len(points))


def converge(rules: Iterable[_Sum], rtol: float, atol: float) -> Estimate:
    """Go through ever finer rules until their differences bound the error as asked.

    The bound is ``SAFETY`` times the last difference, never less than a hundredth of the one before, plus
    rounding. Without convergence the finest rule is returned with ``converged=False``.
    """
    start = time.perf_counter()
    values: list[Any] = []
    evaluations = 0
    error: Any = np.inf
    for found in rules:
        evaluations += found.points
        values.append(found.value)
        if len(values) < 3:
            continue
        last, before = np.abs(values[-1] - values[-2]), np.abs(values[-2] - values[-3])
        error = SAFETY * np.maximum(last, MEMORY * before) + ROUNDING * found.size
        if np.all(error <= np.maximum(atol, rtol * np.abs(values[-1]))):
            break
    else:
        seconds = time.perf_counter() - start
        return Estimate(values[-1], error, "truncation", evaluations, seconds, "", False)
    return Estimate(values[-1], error, "truncation", evaluations, time.perf_counter() - start)


def hemisphere(
    integrand: Integrand,
    *,
    wo: npt.ArrayLike = (0.0, 0.0, 1.0),
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    symmetric: bool = False,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Integrate over the upper hemisphere: ∫ g(ω) dω, with nodes around the mirror direction of ``wo``.

    Rules of rising size and varying width are compared until they agree. When they do not, SciPy's
    adaptive cubature takes over in the same coordinates, twice and with different panels: the two runs
    must confirm each other.

    Parameters
    ----------
    integrand : callable
        Takes unit vectors (N, 3), returns (N,) or (N, K).
    wo : array_like, shape (3,)
        The direction whose mirror image the integrand may peak at; above the horizon.
    width : float, optional
        The lobe's width in slope (α of a microfacet model, 1 for a diffuse one); found when not given.
    rtol, atol : float
        The error may be ``max(atol, rtol |value|)``.
    symmetric : bool
        Whether the integrand is even in the azimuth relative to ``wo``.
    max_evaluations : int
        A budget. The estimate says ``converged=False`` when it did not suffice.

    Returns
    -------
    Estimate
        Of kind "truncation", of shape () or (K,).

    Raises
    ------
    NonFiniteError
        When the integrand is NaN or infinite somewhere.

    >>> estimate = hemisphere(lambda w: w[:, 2], rtol=1e-12)
    >>> bool(abs(estimate.value - np.pi) <= estimate.error < 1e-11)
    True
    """
    start = time.perf_counter()
    wo = np.asarray(wo, dtype=float)
    spent = 0
    if width is None:
        lobe = find_lobe(integrand, wo)
        width, spent = lobe.width, lobe.evaluations
        if lobe.retro:
            original = integrand
            integrand = lambda w: original(turned(w))  # noqa: E731
    sides = 1 if symmetric else 2
    sizes = [n for n in SIZES if sides * n * n <= max_evaluations]

    def rules() -> Iterator[_Sum]:
        for n, factor in zip(sizes, WIDTHS, strict=False):
            wi, weight = slope_rule(wo, width * factor, n, symmetric=symmetric)
            yield _apply(integrand, wi, weight)

    found = converge(rules(), rtol, atol)
    method = "slope-space quadrature"
    budget = max_evaluations - found.evaluations - spent
    if not found.converged and budget > 4 * _GK21:

        def panels(scale: float) -> Integrand:
            def square(points: FloatArray) -> Any:
                wi, weight, _ = slope_map(wo, width * scale, points[:, 0], points[:, 1])
                if symmetric:
                    value = np.asarray(integrand(wi))
                else:
                    both = np.asarray(integrand(np.concatenate([wi, mirrored(wi, wo)])))
                    value = (both[: len(wi)] + both[len(wi) :]) / 2
                return (value.T * weight).T

            return square

        adaptive = _adaptive(panels(1.0), panels(1.0 / 3.0), rtol, atol, budget // sides)
        if np.all(adaptive.error <= found.error) or not adaptive.converged:
            adaptive = replace(adaptive, evaluations=adaptive.evaluations * sides + found.evaluations)
            found, method = adaptive, "adaptive cubature in slope space"
    return replace(
        found,
        evaluations=found.evaluations + spent,
        seconds=time.perf_counter() - start,
        method=method,
        note=found.note if found.note or found.converged else "the tolerance was not reached",
    )


def box(
    integrand: Integrand,
    low: npt.ArrayLike,
    high: npt.ArrayLike,
    *,
    rtol: float = 1e-8,
    atol: float = 0.0,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Integrate over the rectangle from ``low`` (2,) to ``high`` (2,).

    Product Gauss-Legendre rules of rising size are compared, then SciPy's adaptive cubature is run twice
    with different panels.

    Parameters
    ----------
    integrand : callable
        Takes points (N, 2), returns (N,) or (N, K).

    Raises
    ------
    ParameterError
        When ``high`` is below ``low`` or not finite.
    NonFiniteError
        When the integrand is NaN or infinite somewhere.

    >>> estimate = box(lambda p: p[:, 0] * p[:, 1] ** 2, (0, 0), (1, 3))
    >>> round(float(estimate.value), 12)
    4.5
    """
    start = time.perf_counter()
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    span = high - low
    if not (np.all(np.isfinite(span)) and np.all(span >= 0)):
        raise ParameterError("high", high.tolist(), f"finite and not below low = {low.tolist()}")
    area = float(np.prod(span))

    def unit(points: FloatArray) -> Any:
        return np.asarray(integrand(low + span * points)) * area

    def rules() -> Iterator[_Sum]:
        for n in SIZES:
            if n * n > max_evaluations:
                return
            x, w = gauss_legendre(n)
            grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
            yield _apply(unit, grid, np.outer(w, w).ravel())

    found = converge(rules(), rtol, atol)
    method = "Gauss-Legendre"
    budget = max_evaluations - found.evaluations
    if not found.converged and budget > 4 * _GK21:
        adaptive = _adaptive(unit, _bent(unit), rtol, atol, budget)
        found = replace(adaptive, evaluations=adaptive.evaluations + found.evaluations)
        method = "adaptive cubature"
    note = found.note if found.note or found.converged else "the tolerance was not reached"
    return replace(found, seconds=time.perf_counter() - start, method=method, note=note)


def _bent(unit: Integrand) -> Integrand:
    """The same integral over the unit square in coordinates whose panels have other edges."""

    def bent(points: FloatArray) -> Any:
        bend = 0.35
        moved = points + bend * points * (1 - points)
        jacobian = np.prod(1 + bend * (1 - 2 * points), axis=1)
        return (np.asarray(unit(moved)).T * jacobian).T

    return bent


def _adaptive(one: Integrand, two: Integrand, rtol: float, atol: float, budget: int) -> Estimate:
    """Run SciPy's cubature on two forms of the same integral over the unit square and compare them."""
    from scipy.integrate import cubature

    counted = 0

    def guarded(integrand: Integrand) -> Integrand:
        def count(points: FloatArray) -> Any:
            nonlocal counted
            counted += len(points)
            value = np.asarray(integrand(points), dtype=float)
            if not np.all(np.isfinite(value)):
                raise NonFiniteError("the integrand is not finite", value=value)
            return value

        return count

    limit = max(1, budget // (2 * _GK21))
    runs = [
        cubature(
            guarded(form),
            [0.0, 0.0],
            [1.0, 1.0],
            rule="gk21",
            rtol=rtol / 2,
            atol=atol / 2,
            max_subdivisions=limit,
        )
        for form in (one, two)
    ]
    first, second = runs
    difference = np.abs(first.estimate - second.estimate)
    claimed = first.error + second.error
    size = np.abs(first.estimate)
    error = np.maximum(claimed, SAFETY * difference) + ROUNDING * size
    converged = bool(np.all(error <= np.maximum(atol, rtol * size)))
    note = ""
    if np.any(difference > np.maximum(claimed, 1e3 * ROUNDING * size)):
        note = (
            f"two independent rules disagree beyond their claims: {_short(first)} and {_short(second)}; "
            "the integrand may have a kink on a panel's edge, or no finite integral"
        )
    value = (first.estimate + second.estimate) / 2
    return Estimate(value[()], error[()], "truncation", counted, converged=converged, note=note)


def _short(run: Any) -> str:
    worst = int(np.argmax(np.atleast_1d(run.error)))
    value, error = np.atleast_1d(run.estimate)[worst], np.atleast_1d(run.error)[worst]
    return f"{value:.6g} ± {error:.1g}"
