"""Energy: no direction scatters more flux than arrives, whichever of the two directions is held fixed."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from radiokit.checks.probes import isotropic
from radiokit.checks.supremum import Extremum, scan_supremum
from radiokit.contracts.albedo import Side
from radiokit.contracts.bsdf import BSDF
from radiokit.facts.errors import NonFiniteError
from radiokit.facts.verdict import TOLERANCE, Evidence, Outcome, Verdict, Witness, judge_upper_limit

__all__ = ["energy"]

CLAIM = "∫ f cosθ dω ≤ 1 for every fixed wo, and for every fixed wi"


def energy(
    f: BSDF, *, tolerance: float = TOLERANCE, budget: int = 8_000_000, reciprocal: bool = False
) -> Verdict:
    """Judge whether ``f`` conserves energy: the supremum of its directional albedo, on both sides.

    For a function that is not reciprocal the two sides differ, and the physical one is the fixed incident
    direction. A loss is allowed and reported; a gain is a violation. Near the limit by less than the error
    is inconclusive.

    Parameters
    ----------
    tolerance : float
        How far beyond 1 the albedo may lie; widened to the precision of the function's own values.
    budget : int
        Evaluations that may be spent on both sides together.
    reciprocal : bool
        Whether reciprocity is proved, so that one side stands for both.
    """
    start = time.perf_counter()
    tolerance = max(tolerance, 16 * f.precision)
    sides: tuple[Side, ...] = ("wo",) if reciprocal else ("wo", "wi")
    try:
        turns = f.isotropic or isotropic(f)
        found = {
            side: scan_supremum(
                f, fixed=side, turns=turns, budget=budget // len(sides), tolerance=tolerance / 4
            )
            for side in sides
        }
    except NonFiniteError as error:
        return Verdict(
            check="energy",
            claim=CLAIM,
            outcome=Outcome.INCONCLUSIVE,
            evidence=Evidence.MEASURED,
            message=f"no integral: {error}",
            seconds=time.perf_counter() - start,
        )
    side, worst = max(found.items(), key=lambda item: item[1].estimate.value - item[1].estimate.error)
    outcome, evidence = judge_upper_limit(worst.estimate, 1.0, tolerance)
    name = "wo" if side == "wo" else "wi"
    witness = None
    if outcome is Outcome.VIOLATED:
        integral = "∫ f cosθi dωi" if side == "wo" else "∫ f cosθo dωo"
        values = {integral: float(worst.estimate.value), "±": float(worst.estimate.error)}
        witness = Witness({name: worst.direction.tolist()}, values)
    return Verdict(
        check="energy",
        claim=CLAIM,
        outcome=outcome,
        evidence=evidence,
        message=_message(worst, name, outcome, tolerance, reciprocal, found),
        witness=witness,
        estimate=worst.estimate,
        limit=1.0,
        evaluations=sum(extremum.evaluations for extremum in found.values()),
        seconds=time.perf_counter() - start,
        details={
            "tolerance": tolerance,
            "fixed": name,
            "theta_deg": worst.theta_deg,
            "phi_deg": worst.phi_deg,
            "approached_at_grazing": worst.at_grazing,
            "scan_step_deg": worst.step_deg,
            "isotropic": turns,
            "supremum": {key: float(item.estimate.value) for key, item in found.items()},
            "least": min(float(item.least.value) for item in found.values()),
            "lossless": _lossless(found, tolerance),
            "above_limit_deg": _range(worst, tolerance),
        },
    )


def _lossless(found: dict[Side, Extremum], tolerance: float) -> bool:
    """Whether even the smallest albedo is 1."""
    return all(abs(item.least.value - 1) <= tolerance + item.least.error for item in found.values())


def _range(worst: Extremum, tolerance: float) -> list[float]:
    """The smallest and largest polar angle at which the scan saw more than the limit [degrees]."""
    above = worst.theta[worst.profile > 1 + max(tolerance, 1e-6)]
    return [float(np.rad2deg(above.min())), float(np.rad2deg(above.max()))] if len(above) else []


def _message(
    worst: Extremum,
    name: str,
    outcome: Outcome,
    tolerance: float,
    reciprocal: bool,
    found: dict[Side, Any],
) -> str:
    value, error = float(worst.estimate.value), float(worst.estimate.error)
    place = f"θ{name[1]} = {worst.theta_deg:.4g}°"
    if worst.theta_deg < 0.01:
        place = "normal incidence"
    if worst.at_grazing:
        place += ", still rising: approached only as θ → 90°"
    text = f"sup {value:.6g} ± {error:.1g} at {place}"
    if outcome is Outcome.VIOLATED:
        gain = f"gains {100 * (value - 1):.3g} %" if value < 2 else f"scatters {value:.4g} times what arrives"
        text = f"{gain}: {text}"
        span = _range(worst, tolerance)
        if span:
            text += f"; above 1 from {span[0]:.4g}° to {span[1]:.4g}°"
    elif outcome is Outcome.INCONCLUSIVE:
        text = "too close to 1 to tell: " + text
    else:
        least = min(float(item.least.value) for item in found.values())
        text += f"; loses up to {100 * (1 - least):.3g} %" if least < 1 - tolerance else "; loses nothing"
    if not reciprocal and name == "wi":
        text += f" (with wi fixed; with wo fixed {float(found['wo'].estimate.value):.6g})"
    text += f"; scanned every {worst.step_deg:.2g}°"
    if "disagree" in worst.estimate.note or (outcome is Outcome.INCONCLUSIVE and worst.estimate.note):
        text += f". {worst.estimate.note}"
    return text
