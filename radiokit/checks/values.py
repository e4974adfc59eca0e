"""Values: a BSDF is finite, non-negative, and the same whenever it is asked."""

from __future__ import annotations

import time

import numpy as np

from radiokit.checks.probes import channels, pairs
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.directions import reflect, refract
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness

__all__ = ["values"]

CLAIM = "f(wi, wo) is finite, at least 0, and the same at every call"
NEGATIVE = 1e-12


def values(f: BSDF, *, count: int = 1 << 15) -> Verdict:
    """Judge whether ``f`` is finite, non-negative and repeatable.

    Looks at ``count`` pairs of ``probes.pairs``, and at exact ones where formulas break: normal
    incidence, exact mirror pairs, equal directions, both directions at 89.9999°; for a model that
    transmits also at exact refracted pairs and opposite directions, on all sides.
    """
    start = time.perf_counter()
    wi, wo = _with_exact(f, *pairs(max(count, 64), f))
    first = channels(f.evaluate(wi, wo))
    second = channels(f.evaluate(wi, wo))
    witness, message = _worst(wi, wo, first, second, f.precision)
    violated = witness is not None
    return Verdict(
        check="values",
        claim=CLAIM,
        outcome=Outcome.VIOLATED if violated else Outcome.HOLDS,
        evidence=Evidence.REFUTED if violated else Evidence.MEASURED,
        message=message or f"at {len(wi)} pairs; largest value {first.max():.6g} 1/sr",
        witness=witness,
        evaluations=2 * len(wi),
        seconds=time.perf_counter() - start,
        details={"pairs": len(wi), "largest": float(np.max(first[np.isfinite(first)], initial=0.0))},
    )


def _with_exact(f: BSDF, wi: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
    some = wo[: max(16, len(wo) // 16)]
    normal = np.array([[0.0, 0.0, 1.0]])
    grazing = wo[2::4][: len(some)]
    extra_i = [normal, reflect(some), some, np.repeat(normal, len(some), axis=0), some, reflect(grazing)]
    extra_o = [normal, some, some, some, np.repeat(normal, len(some), axis=0), grazing]
    if f.transmissive:
        to, total = refract(some, eta=f.relative_index())
        there, back = to[~total], some[~total]
        extra_i += [there, back, -some, normal, -normal, -normal, -grazing]
        extra_o += [back, there, some, -normal, normal, -normal, grazing]
    return np.concatenate([wi, *extra_i]), np.concatenate([wo, *extra_o])


def _worst(
    wi: FloatArray, wo: FloatArray, first: FloatArray, second: FloatArray, precision: float
) -> tuple[Witness | None, str]:
    bad = ~np.isfinite(first) | ~np.isfinite(second)
    if np.any(bad):
        row = int(np.argmax(bad.any(axis=1)))
        value = first[row] if np.any(~np.isfinite(first[row])) else second[row]
        kind = "NaN" if np.any(np.isnan(value)) else "infinite"
        share = bad.any(axis=1).sum()
        return _witness(wi, wo, row, {"f": value}), f"{kind} at {share} of {len(wi)} pairs"
    if first.min() < -NEGATIVE:
        row = int(np.argmin(first.min(axis=1)))
        share = (first < -NEGATIVE).any(axis=1).sum()
        found = f"negative at {share} of {len(wi)} pairs, as low as {first.min():.6g} 1/sr"
        return _witness(wi, wo, row, {"f": first[row]}), found
    change = np.abs(first - second)
    if np.any(change > 4 * precision * np.abs(first)):
        row = int(np.argmax(change.max(axis=1)))
        found = (
            f"answers differently when asked again, at {(change > 0).any(axis=1).sum()} of {len(wi)} pairs"
        )
        return _witness(wi, wo, row, {"first": first[row], "second": second[row]}), found
    return None, ""


def _witness(wi: FloatArray, wo: FloatArray, row: int, values: dict[str, FloatArray]) -> Witness:
    plain = {name: value[0] if len(value) == 1 else value for name, value in values.items()}
    return Witness({"wi": wi[row].tolist(), "wo": wo[row].tolist()}, plain)
