"""Delta lobes: light finds its way back with the same share, and the sampler gives each lobe its due."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.checks.parts import index_squared
from radiokit.checks.probes import channels, pairs
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.triples import dot
from radiokit.facts.verdict import Witness

__all__ = ["in_lobe", "lobe_means", "way_back"]

SAME = 1e-9
"""Distance of two unit vectors that are called the same."""

RARE = 20.0
"""What is expected fewer times than this may never be seen, but for a chance of exp(−20)."""


def way_back(f: BSDF, *, count: int = 1 << 12, tolerance: float) -> tuple[int, tuple[str, Witness] | None]:
    """Follow each delta lobe back: from its direction a lobe must return to ``wo`` with the same share.

    The share of the flux is what is the same both ways; radiance carries the factor n(wo)² / n(wi)² besides.

    Returns
    -------
    count : int
        How many lobes were followed.
    problem : tuple of message and witness, or None
    """
    _, wo = pairs(count, f)
    followed, worst = 0, 0.0
    problem: tuple[str, Witness] | None = None
    for lobe in f.delta_lobes(wo):
        share = channels(lobe.weight)
        live = share.any(axis=1) | ~np.isfinite(share).all(axis=1)
        to, held, share = lobe.wi[live], wo[live], share[live]
        followed += len(to)
        # Refraction magnifies rounding by 1/cosθ on either side, and Fresnel's slope there is no larger.
        eta = f.relative_index()
        steep = (eta + 1 / eta) / np.minimum(np.abs(to[:, 2]), np.abs(held[:, 2]))
        slack = 64 * f.precision * steep
        returned = np.zeros_like(share)
        for back in f.delta_lobes(to):
            near = _distance(back.wi, held) <= SAME + slack
            returned = returned + np.where(near[:, None], channels(back.weight), 0.0)
        allowed = (tolerance + slack)[:, None] * np.maximum(share, 1.0)
        excess = (np.abs(returned - share) - allowed).max(axis=1)
        excess = np.where(np.isfinite(excess), excess, np.inf)
        if len(excess) and excess.max() > worst:
            row = int(np.argmax(excess))
            worst = float(excess[row])
            there, home = _plain(share[row]), _plain(returned[row])
            problem = (
                "a delta lobe's way back differs: the share of the flux is "
                f"{np.max(there):.6g} one way and {np.max(home):.6g} the other",
                Witness(
                    {"wi": to[row].tolist(), "wo": held[row].tolist()},
                    {"share of the lobe wi for wo": there, "share of the lobe wo for wi": home},
                ),
            )
    return followed, problem


def in_lobe(f: BSDF, wi: FloatArray, wo: FloatArray) -> Any:
    """Return which samples ``wi`` (N, 3) for one ``wo`` (3,) went into a delta lobe."""
    found = np.zeros(len(wi), dtype=bool)
    for lobe in f.delta_lobes(wo[None, :]):
        found |= _distance(wi, lobe.wi) <= SAME
    return found


def lobe_means(f: BSDF, wi: FloatArray, weight: FloatArray, wo: FloatArray) -> list[dict[str, Any]]:
    """Compare, lobe by lobe, the mean of the weights that samples brought there with what is due.

    What is due is the share of the flux, times n(wo)² / n(wi)² since a weight is one of radiance. Lobes that
    coincide are one.
    """
    from radiokit.measure.statistics import bernstein_test

    rows: list[dict[str, Any]] = []
    places: list[FloatArray] = []
    lobes = f.delta_lobes(wo[None, :])
    weights = channels(weight)
    for lobe in lobes:
        if any(_distance(lobe.wi, place)[0] <= SAME for place in places):
            continue
        places.append(lobe.wi[0])
        same = [other for other in lobes if _distance(other.wi, lobe.wi)[0] <= SAME]
        share = sum((channels(other.weight)[0] for other in same), start=np.zeros(1))
        due = share * index_squared(f, wo) / index_squared(f, lobe.wi[0])
        here = _distance(wi, lobe.wi) <= SAME
        brought = np.where(here[:, None], weights, 0.0)
        # A lobe that was hardly ever picked may bring as much, when it is, as any other sample brought.
        unseen = RARE * weights.max(axis=0) / len(wi) if np.sum(here) < 5 * RARE else np.zeros(len(due))
        p = [
            bernstein_test(brought[:, k], due[k], 1e-9 * max(1.0, due[k]) + unseen[k])
            for k in range(len(due))
        ]
        rows.append(
            {
                "wi": lobe.wi[0].tolist(),
                "due": _plain(due),
                "mean": _plain(brought.mean(axis=0)),
                "frequency": float(here.mean()),
                "p": min(1.0, min(p) * len(p)),
            }
        )
    return rows


def _distance(a: FloatArray, b: FloatArray) -> FloatArray:
    way = np.atleast_2d(a - b)
    return np.asarray(np.sqrt(dot(way, way)))


def _plain(values: FloatArray) -> Any:
    return float(values[0]) if len(values) == 1 else values
