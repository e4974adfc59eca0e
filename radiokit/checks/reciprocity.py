"""Reciprocity: f is the same both ways, proved where there is a formula, else searched for its worst pair.

Where light passes into another medium it is f / n(wo)², with n the index on the side of the radiance.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from radiokit.checks.delta import way_back
from radiokit.checks.parts import index_squared
from radiokit.checks.probes import GRAZING, channels, pairs, polar
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.errors import RadiokitError
from radiokit.facts.verdict import TOLERANCE, Evidence, Outcome, Verdict, Witness

__all__ = ["reciprocity"]

CLAIM = "f(wi, wo) = f(wo, wi) for all pairs of directions"
CLAIM_SCALED = "f(wi, wo) / n(wo)² = f(wo, wi) / n(wi)² for all pairs of directions"
FLOOR = 1e-12
"""Values [sr⁻¹] below which an asymmetry is not looked at."""

SUSPECTS = 4096
"""How many differing pairs, evenly from the worst to the least, are held against their rounding noise."""

NEGLIGIBLE = 1e-3
"""Share of the mean value below which values count for less, so that the witness is no far tail."""

NOISE = 16.0
"""How many times its own rounding noise a difference must be before it is called an asymmetry."""


def reciprocity(f: BSDF, *, count: int = 1 << 16, tolerance: float = TOLERANCE, refine: int = 4) -> Verdict:
    """Judge whether ``f`` is reciprocal.

    The law is f(wi, wo) = f(wo, wi); for a model that transmits into another index it is the scaled one,
    f(wi, wo) / n(wo)² = f(wo, wi) / n(wi)², and the details then say whether the plain one holds as well.
    Delta lobes are followed back, and must return with the same share of the flux.

    A symbolic proof of the plain law is tried first. The search looks at ``count`` pairs (uniform, grazing
    and near-mirror ones), climbs from the worst few, and holds a difference against the rounding noise of f
    at that very pair, measured by moving the directions by some units in the last place.

    Parameters
    ----------
    tolerance : float
        Largest allowed |f(wi, wo) − f(wo, wi)| relative to the larger of the two.
    refine : int
        How many of the worst pairs are climbed from.
    """
    start = time.perf_counter()
    scaled = f.transmissive and f.relative_index() != 1
    proved = not scaled and _proved(f)
    wi, wo = pairs(max(count, 64), f)
    f_io, f_oi = _basic(f, wi, wo), _basic(f, wo, wi)
    evaluations = 2 * len(wi)
    usable = np.isfinite(f_io).all(axis=1) & np.isfinite(f_oi).all(axis=1)
    skipped = int((~usable).sum())
    wi, wo, f_io, f_oi = wi[usable], wo[usable], f_io[usable], f_oi[usable]
    tolerance = max(tolerance, 64 * f.precision)
    uniform = (f_io + f_oi)[::4]  # every fourth pair is
    floor = max(FLOOR, NEGLIGIBLE * float(np.mean(uniform)) if len(uniform) else 0.0)
    severity = _severity(f_io, f_oi, floor)
    order = np.argsort(-severity, kind="stable")
    order = order[severity[order] > tolerance]
    order = order[:: max(1, -(-len(order) // SUSPECTS))]
    noise, spent = _noise(f, wi[order], wo[order])
    evaluations += spent
    real = order[_excess(f_io[order], f_oi[order], noise, tolerance) > 0]
    cap = 2 * np.pi * np.log(100) / max(1, len(wi))  # a region this large is missed once in a hundred
    details: dict[str, Any] = {
        "pairs": len(wi),
        "tolerance": tolerance,
        "symbolic_proof": proved,
        "region_found_with_99_percent_sr": float(cap),
        "not_finite": skipped,
        "beyond_rounding": len(real),
    }
    plain = ""
    if scaled:
        one_way, other_way = f_io * index_squared(f, wo)[:, None], f_oi * index_squared(f, wi)[:, None]
        gap = float(np.max(_severity(one_way, other_way, floor), initial=0.0))
        details |= {"law": "eta-scaled", "plain_holds": gap <= tolerance, "plain_relative_difference": gap}
        if gap <= tolerance:
            plain = "; the plain law f(wi, wo) = f(wo, wi) holds: is the factor n² missing?"
    followed, detour = way_back(f, tolerance=tolerance)
    if followed:
        details["delta_lobes_followed"] = followed
    common: dict[str, Any] = {
        "check": "reciprocity",
        "claim": CLAIM_SCALED if scaled else CLAIM,
        "details": details,
    }
    if len(real):
        best = real[0]
        pair = wi[best], wo[best]
        if refine:
            pair, spent = _climb(f, wi[real[:refine]], wo[real[:refine]], tolerance, floor)
            evaluations += spent
        a, b = _at(f, *pair), _at(f, pair[1], pair[0])
        channel = int(np.argmax(np.abs(a - b)))
        one, two = float(a[channel]), float(b[channel])
        seen = {"f(wi, wo)": one, "f(wo, wi)": two}
        if scaled:
            n2_i, n2_o = (float(index_squared(f, w)) for w in pair)
            seen = {"f(wi, wo)": one * n2_o, "f(wo, wi)": two * n2_i, "n(wi)²": n2_i, "n(wo)²": n2_o}
        low, high = sorted((one, two))
        ratio = f"{high / low:.6g} times" if low > 0 else f"{low:.6g} against {high:.6g}"
        return Verdict(
            outcome=Outcome.VIOLATED,
            evidence=Evidence.REFUTED,
            message=f"the two values differ: {ratio}; relative difference {_severity(one, two, 0.0):.3g}"
            + plain,
            witness=Witness({"wi": pair[0].tolist(), "wo": pair[1].tolist()}, seen),
            evaluations=evaluations,
            seconds=time.perf_counter() - start,
            **common,
        )
    if detour is not None:
        return Verdict(
            outcome=Outcome.VIOLATED,
            evidence=Evidence.REFUTED,
            message=detour[0],
            witness=detour[1],
            evaluations=evaluations,
            seconds=time.perf_counter() - start,
            **common,
        )
    if skipped:
        outcome, message = Outcome.INCONCLUSIVE, f"f is not finite at {skipped} pairs, see values"
    else:
        outcome = Outcome.HOLDS
        message = f"no asymmetry above {tolerance:.0e} in {len(wi)} pairs; one of {cap:.1e} sr would be seen"
        if len(order):
            message += f" ({len(order)} differences were rounding noise)"
        if followed:
            message += f"; {followed} delta lobes come back with their share"
        if proved:
            message = "f(wi, wo) − f(wo, wi) simplifies to 0; " + message
    return Verdict(
        outcome=outcome,
        evidence=Evidence.PROVED if proved and outcome is Outcome.HOLDS else Evidence.MEASURED,
        message=message,
        evaluations=evaluations,
        seconds=time.perf_counter() - start,
        **common,
    )


def _proved(f: BSDF) -> bool:
    try:
        twin = f.symbolic()
    except RadiokitError:
        return False
    from radiokit.measure.proof import proved_zero

    return proved_zero(twin.swapped().expression - twin.expression)


def _basic(f: BSDF, wi: FloatArray, wo: FloatArray) -> FloatArray:
    """Return f(wi, wo) / n(wo)², as (N, K)."""
    value = channels(f.evaluate(wi, wo))
    return value / index_squared(f, wo)[:, None] if f.transmissive else value


def _severity(a: Any, b: Any, floor: float) -> Any:
    """Relative difference, the worst over the channels, less where the values are near ``floor`` or below."""
    a, b = np.asarray(a), np.asarray(b)
    larger = np.maximum(np.abs(a), np.abs(b))
    severity = np.abs(a - b) / (larger + floor + 1e-300)
    return severity.max(axis=-1) if severity.ndim else float(severity)


def _at(f: BSDF, wi: FloatArray, wo: FloatArray) -> FloatArray:
    return _basic(f, wi.reshape(-1, 3), wo.reshape(-1, 3))[0]


def _noise(f: BSDF, wi: FloatArray, wo: FloatArray) -> tuple[FloatArray, int]:
    """Measure how much f varies when its directions move by some units in the last place."""
    if len(wi) == 0:
        return np.zeros((0, 1)), 0
    spread: Any = 0.0
    shifts = f.precision * np.array([[1, -2, 3], [-3, 1, -1], [2, 3, -2], [-1, -3, 1.0]])
    base = _basic(f, wi, wo), _basic(f, wo, wi)
    for shift in shifts:
        a, b = wi * (1 + shift), wo * (1 + shift[::-1])
        for reference, value in zip(base, (_basic(f, a, b), _basic(f, b, a)), strict=True):
            moved = np.abs(value - reference)
            spread = np.maximum(spread, np.where(np.isfinite(moved), moved, np.inf))
    return np.asarray(spread), len(wi) * 2 * (len(shifts) + 1)


def _excess(a: FloatArray, b: FloatArray, noise: FloatArray, tolerance: float) -> FloatArray:
    """How far a difference exceeds the tolerance and the noise; positive for a true asymmetry."""
    larger = np.maximum(np.abs(a), np.abs(b))
    allowed = tolerance * larger + NOISE * noise + FLOOR
    excess: FloatArray = (np.abs(a - b) - allowed).max(axis=-1, initial=-np.inf)
    return excess


def _climb(
    f: BSDF, wi: FloatArray, wo: FloatArray, tolerance: float, floor: float
) -> tuple[tuple[FloatArray, FloatArray], int]:
    """Climb from each pair to a larger relative difference; return the worst pair that is no noise."""
    from scipy.optimize import minimize

    spent = 0

    side = np.ones(2)

    def directions(p: FloatArray) -> tuple[FloatArray, FloatArray]:
        cosine = np.clip(np.cos(p[[0, 2]]), np.cos(GRAZING), 1.0)
        w = polar(side * cosine, p[[1, 3]])
        return w[0], w[1]

    def objective(p: FloatArray) -> float:
        nonlocal spent
        spent += 2
        a, b = directions(p)
        value = _severity(_at(f, a, b), _at(f, b, a), floor)
        return -float(value) if np.isfinite(value) else 0.0

    best = wi[0], wo[0]
    worst = float(_severity(_at(f, *best), _at(f, best[1], best[0]), floor))
    for a, b in zip(wi, wo, strict=True):
        side = np.where(np.array([a[2], b[2]]) < 0, -1.0, 1.0)
        x0 = np.array([_theta(a), np.arctan2(a[1], a[0]), _theta(b), np.arctan2(b[1], b[0])])
        found = minimize(objective, x0, method="Nelder-Mead", options={"maxfev": 200, "xatol": 1e-6})
        pair = directions(found.x)
        noise, used = _noise(f, pair[0][None], pair[1][None])
        spent += used + 2
        values = _at(f, *pair)[None], _at(f, pair[1], pair[0])[None]
        if -found.fun > worst and _excess(*values, noise, tolerance)[0] > 0:
            best, worst = pair, -float(found.fun)
    return best, spent


def _theta(w: FloatArray) -> float:
    return float(np.arctan2(np.hypot(w[0], w[1]), abs(w[2])))
