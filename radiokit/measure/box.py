"""Box: integrals over rectangles."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import check_integration, numbers
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import GK21, Integrand, RuleSum, adaptive, apply_rule, converge
from radiokit.measure.gauss import gauss_legendre

__all__ = ["bent", "box"]

FloatArray = npt.NDArray[np.float64]

SIZES = (16, 24, 32, 48, 64, 96, 128, 192)
"""Nodes along each axis, tried in turn until rules agree."""


def box(
    integrand: Integrand,
    low: npt.ArrayLike,
    high: npt.ArrayLike,
    *,
    rtol: float = 1e-8,
    atol: float = 0.0,
    max_evaluations: int = 4_000_000,
    kinks: bool = False,
) -> Estimate:
    """Integrate over the rectangle from ``low`` (2,) to ``high`` (2,).

    Product Gauss-Legendre rules of rising size are compared, then SciPy's adaptive cubature is run twice
    with different panels.

    Parameters
    ----------
    integrand : callable
        Takes points (N, 2), returns (N,) or (N, K).
    low, high : array_like, shape (2,)
        Opposite corners, no coordinate of ``high`` below that of ``low``.
    rtol, atol : float
        The error may be ``max(atol, rtol |value|)``.
    max_evaluations : int
        A budget. The estimate says ``converged=False`` when it did not suffice.
    kinks : bool
        Whether kinks are known to be inside. Product rules, which then converge slowly and agree by chance,
        are left out.

    Raises
    ------
    ParameterError
        When ``high`` is below ``low`` or not finite, the integrand is not callable, or a tolerance is
        negative.
    NonFiniteError
        When the integrand is NaN or infinite somewhere.

    >>> estimate = box(lambda p: p[:, 0] * p[:, 1] ** 2, (0, 0), (1, 3))
    >>> round(float(estimate.value), 12)
    4.5
    """
    start = time.perf_counter()
    check_integration(integrand, rtol=rtol, atol=atol)
    low, high = numbers("low", low, "two finite numbers"), numbers("high", high, "two finite numbers")
    span = high - low
    if not (np.all(np.isfinite(span)) and np.all(span >= 0)):
        raise ParameterError("high", high.tolist(), f"finite and not below low = {low.tolist()}")
    area = float(np.prod(span))

    def unit(points: FloatArray) -> Any:
        return np.asarray(integrand(low + span * points)) * area

    def rules() -> Iterator[RuleSum]:
        for n in SIZES:
            if n * n > max_evaluations:
                return
            x, w = gauss_legendre(n)
            grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
            yield apply_rule(unit, grid, np.outer(w, w).ravel())

    found = None if kinks else converge(rules(), rtol, atol)
    method = "Gauss-Legendre"
    budget = max_evaluations - (0 if found is None else found.evaluations)
    if found is None or (not found.converged and budget > 4 * GK21):
        spent = max_evaluations - budget
        found = adaptive(unit, bent(unit), rtol, atol, budget)
        found = replace(found, evaluations=found.evaluations + spent)
        method = "adaptive cubature"
    note = found.note if found.note or found.converged else "the tolerance was not reached"
    return replace(found, seconds=time.perf_counter() - start, method=method, note=note)


def bent(unit: Integrand) -> Integrand:
    """Return the same integral over the unit square in coordinates whose panels have other edges."""

    def value(points: FloatArray) -> Any:
        bend = 0.35
        moved = points + bend * points * (1 - points)
        jacobian = np.prod(1 + bend * (1 - 2 * points), axis=1)
        return (np.asarray(unit(moved)).T * jacobian).T

    return value
