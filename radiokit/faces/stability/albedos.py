"""Albedos: what ``rk.albedo`` says of each model, against the integral of its twin to thirty digits."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.albedo import albedo
from radiokit.contracts.bsdf import BSDF
from radiokit.faces.stability.grid import examples
from radiokit.faces.stability.models import chosen_models
from radiokit.faces.stability.truth import AGREE, NODES, NoTruthError, Truth, twin_albedo
from radiokit.faces.workers import SerialExecutor
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import RadiokitError
from radiokit.facts.estimate import Estimate
from radiokit.facts.jsonable import jsonable
from radiokit.facts.verdict import Outcome

__all__ = ["ANGLES_DEG", "AZIMUTH", "DENSE", "RTOL", "AlbedoRow", "albedo_row", "model_albedos"]

ANGLES_DEG = (0.0, 60.0, 85.0)
AZIMUTH = 0.4
RTOL = 1e-10
"""Relative error that is asked of ``rk.albedo``, and allowed."""

DENSE = 10 * NODES
"""Values of the twin that one albedo may cost where time does not matter."""


@dataclass(frozen=True)
class AlbedoRow:
    """One directional albedo: what quadrature says, and the truth.

    Parameters
    ----------
    model : str
    parameters : dict
    theta_deg : float
        Polar angle of wo: above 90 for light that arrives from below.
    value, bound : float
        Of ``rk.albedo`` at a relative tolerance of ``RTOL``.
    converged : bool
        Whether it says that it reached that.
    truth : str
        To twenty digits; empty where there is none.
    method : str
        A closed form, or the charts of the integral.
    uncertainty : float
        Difference of the truth's two resolutions.
    nodes : int
        Values of the twin that the truth took.
    off : float
        value − truth.
    reason : str
        Why there is no truth.
    seconds : float
    """

    model: str
    parameters: dict[str, Any]
    theta_deg: float
    value: float
    bound: float
    converged: bool
    truth: str
    method: str
    uncertainty: float
    nodes: int
    off: float
    reason: str
    seconds: float

    @property
    def relative(self) -> float:
        """|value − truth| over the truth, or as it is where that is 0."""
        return abs(self.off) / (abs(float(self.truth or "nan")) or 1.0)

    @property
    def outcome(self) -> Outcome | None:
        """None without a truth; ``inconclusive`` for a bound that holds but is, as it says, too wide."""
        if not self.truth:
            return None
        if not abs(self.off) <= self.bound + self.uncertainty:
            return Outcome.VIOLATED
        if not self.converged:
            return Outcome.INCONCLUSIVE
        return Outcome.HOLDS if self.relative <= RTOL + AGREE else Outcome.VIOLATED

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON-ready data."""
        data = {name: getattr(self, name) for name in self.__dataclass_fields__}
        outcome = "no truth" if self.outcome is None else str(self.outcome)
        result: dict[str, Any] = jsonable(
            data
            | {"relative": self.relative if self.truth else None, "off": self.off if self.truth else None}
            | {"outcome": outcome}
        )
        return result


def model_albedos(
    names: Iterable[str] | None = None,
    *,
    dense: bool = False,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[AlbedoRow, ...]:
    """Compare the albedos of the models called ``names``, or of all, with the truth, at each example.

    Parameters
    ----------
    names : iterable of str, optional
    dense : bool
        Whether each truth may cost ten times as much.
    executor : concurrent.futures.Executor, optional
        Where the work is done; the findings do not depend on it.
    progress : callable, optional
        Called with the number of finished albedos and the number of all.

    >>> [(row.theta_deg, str(row.outcome)) for row in model_albedos(["mirror"])][:2]
    [(0.0, 'holds'), (60.0, 'holds')]
    """
    most = DENSE if dense else NODES
    tasks = [
        (f, theta, most)
        for cls in chosen_models(names).values()
        for f in examples(cls)
        for theta in (*ANGLES_DEG, *((180.0 - 60.0,) if f.transmissive else ()))
    ]
    found = []
    for done, row in enumerate((executor or SerialExecutor()).map(_task, tasks), start=1):
        found.append(row)
        if progress is not None:
            progress(done, len(tasks))
    return tuple(found)


def _task(task: tuple[BSDF, float, int]) -> AlbedoRow:
    return albedo_row(*task)


def albedo_row(
    f: BSDF,
    theta_deg: float,
    most: int = NODES,
    integrate: Callable[..., Estimate] = albedo,
) -> AlbedoRow:
    """Compare one directional albedo, as ``integrate(f, wo, rtol=...)`` gives it, with the truth.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> row = albedo_row(bsdf("lambert", reflectance=0.5), 60.0)
    >>> row.truth, row.relative < 1e-13
    ('0.5', True)
    """
    import mpmath

    start = time.perf_counter()
    wo = spherical_to_cartesian(np.radians(theta_deg), AZIMUTH)
    estimate = integrate(f, wo, rtol=RTOL)
    truth: Truth | None = None
    reason = ""
    try:
        truth = twin_albedo(f, wo, most=most)
    except NoTruthError as problem:
        reason = str(problem)
    except (RadiokitError, ArithmeticError) as problem:
        reason = f"the twin fails: {problem}"
    return AlbedoRow(
        model=f.name,
        parameters=f.parameters(),
        theta_deg=theta_deg,
        value=float(estimate.value),
        bound=float(estimate.error),
        converged=estimate.converged,
        truth="" if truth is None else mpmath.nstr(truth.value, 20),
        method="" if truth is None else truth.method,
        uncertainty=0.0 if truth is None else truth.uncertainty,
        nodes=0 if truth is None else truth.nodes,
        off=float("nan") if truth is None else float(float(estimate.value) - truth.value),
        reason=reason,
        seconds=time.perf_counter() - start,
    )
