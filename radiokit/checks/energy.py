"""Energy: no direction scatters more flux than arrives, whichever of the two directions is held fixed."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from radiokit.checks.parts import flipped, share
from radiokit.checks.probes import isotropic, polar
from radiokit.checks.supremum import Extremum, scan_supremum
from radiokit.contracts.albedo import Side
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.errors import NonFiniteError
from radiokit.facts.verdict import TOLERANCE, Evidence, Outcome, Verdict, Witness, judge_upper_limit

__all__ = ["energy"]

CLAIM = "∫ f cosθ dω ≤ 1 for every fixed wo, and for every fixed wi"
CLAIM_THROUGH = "∫ f |cosθo| dωo over both hemispheres ≤ 1 for every fixed wi above and below"

BALANCE_DEG = (0.0, 30.0, 60.0, 80.0, 89.0)
"""Angles of incidence, on either side, at which what is reflected, transmitted and absorbed is reported."""

BALANCE_EVALUATIONS = 200_000
"""What one row of them may cost."""


def energy(
    f: BSDF, *, tolerance: float = TOLERANCE, budget: int = 8_000_000, reciprocal: bool = False
) -> Verdict:
    """Judge whether ``f`` conserves energy: the supremum of its directional albedo, on both sides.

    For a function that is not reciprocal the two sides differ, and the physical one is the fixed incident
    direction. A loss is allowed and reported; a gain is a violation. Near the limit by less than the error
    is inconclusive.

    A model that transmits is judged by the light itself, for fixed ``wi`` on either side: what is reflected
    and transmitted is at most what is incident. (For fixed ``wo`` the integral is of radiance, which grows
    with the square of the index.) The details give the balance, incident = reflected + transmitted +
    absorbed, where most comes out and at five angles on either side.

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
    claim = CLAIM_THROUGH if f.transmissive else CLAIM
    sides: tuple[tuple[str, Side, bool], ...] = (("wo", "wo", False),)
    if not reciprocal:
        sides += (("wi", "wi", False),)
    if f.transmissive:
        sides = (("wi above", "wi", False), ("wi below", "wi", True))
    try:
        turns = f.isotropic or isotropic(f)
        found = {
            key: scan_supremum(
                f,
                fixed=fixed,
                turns=turns,
                budget=budget // len(sides),
                tolerance=tolerance / 4,
                below=below,
            )
            for key, fixed, below in sides
        }
        balance = _balances(f, found, budget) if f.transmissive else {}
    except NonFiniteError as error:
        return Verdict(
            check="energy",
            claim=claim,
            outcome=Outcome.INCONCLUSIVE,
            evidence=Evidence.MEASURED,
            message=f"no integral: {error}",
            seconds=time.perf_counter() - start,
        )
    side, worst = max(found.items(), key=lambda item: item[1].estimate.value - item[1].estimate.error)
    outcome, evidence = judge_upper_limit(worst.estimate, 1.0, tolerance)
    name = side[:2]
    witness = None
    if outcome is Outcome.VIOLATED:
        integral = "∫ f cosθi dωi" if side == "wo" else "∫ f cosθo dωo"
        if f.transmissive:
            integral = "∫ f |cosθo| dωo"
        values = {integral: float(worst.estimate.value), "±": float(worst.estimate.error)}
        witness = Witness({name: worst.direction.tolist()}, values)
    return Verdict(
        check="energy",
        claim=claim,
        outcome=outcome,
        evidence=evidence,
        message=_message(worst, side, outcome, tolerance, reciprocal, found)
        + (_split(balance["at_supremum"]) if balance else ""),
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
            **balance,
        },
    )


def _balances(f: BSDF, found: dict[str, Extremum], budget: int) -> dict[str, Any]:
    """Return the balance where most comes out, and at some angles on either side if the budget allows."""
    worst = max(found.values(), key=lambda item: item.estimate.value - item.estimate.error)
    most = min(BALANCE_EVALUATIONS, budget // 8)
    rows = {"at_supremum": _balance(f, worst.direction, most)}
    if budget < 20 * BALANCE_EVALUATIONS:
        return rows
    phi = np.arctan2(worst.direction[1], worst.direction[0])
    places = polar(np.cos(np.deg2rad(BALANCE_DEG)), phi)
    return rows | {
        "balance": [_balance(f, w, most) for below in (False, True) for w in flipped(places, below)]
    }


def _balance(f: BSDF, wi: FloatArray, most: int) -> dict[str, Any]:
    """Return what becomes of light from ``wi``, as shares of the flux."""
    tolerances: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-9, "max_evaluations": most // 2}
    back = share(f, wi, fixed="wi", side="reflected", **tolerances)
    through = share(f, wi, fixed="wi", side="transmitted", **tolerances)
    return {
        "side": "below" if wi[2] < 0 else "above",
        "theta_deg": float(np.rad2deg(np.arctan2(np.hypot(wi[0], wi[1]), abs(wi[2])))),
        "reflected": back.value,
        "transmitted": through.value,
        "absorbed": 1 - back.value - through.value,
        "error": back.error + through.error,
    }


def _split(row: dict[str, Any]) -> str:
    shares = [f"{float(np.max(row[name])):.6g} {name}" for name in ("reflected", "transmitted")]
    return f"; there {' and '.join(shares)}"


def _lossless(found: dict[str, Extremum], tolerance: float) -> bool:
    """Whether both the smallest albedo and the largest are 1."""
    ends = [end for item in found.values() for end in (item.least, item.estimate)]
    return all(abs(end.value - 1) <= tolerance + end.error for end in ends)


def _range(worst: Extremum, tolerance: float) -> list[float]:
    """The smallest and largest polar angle at which the scan saw more than the limit [degrees]."""
    above = worst.theta[worst.profile > 1 + max(tolerance, 1e-6)]
    return [float(np.rad2deg(above.min())), float(np.rad2deg(above.max()))] if len(above) else []


def _message(
    worst: Extremum,
    side: str,
    outcome: Outcome,
    tolerance: float,
    reciprocal: bool,
    found: dict[str, Extremum],
) -> str:
    value, error = float(worst.estimate.value), float(worst.estimate.error)
    place = f"θ{side[1]} = {worst.theta_deg:.4g}°"
    if worst.theta_deg < 0.01:
        place = "normal incidence"
    if side[3:]:
        place += f" from {side[3:]}"
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
    if not reciprocal and side == "wi":
        text += f" (with wi fixed; with wo fixed {float(found['wo'].estimate.value):.6g})"
    text += f"; scanned every {worst.step_deg:.2g}°"
    if "disagree" in worst.estimate.note or (outcome is Outcome.INCONCLUSIVE and worst.estimate.note):
        text += f". {worst.estimate.note}"
    return text
