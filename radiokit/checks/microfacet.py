"""Microfacet: the facets of a rough surface cover it exactly once, from wherever it is seen."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from radiokit.checks.facets import over_facets, projected_area, white_furnace
from radiokit.checks.probes import pairs, polar
from radiokit.contracts.microfacet import FloatArray, Microfacets
from radiokit.facts.directions import dot, half_vector
from radiokit.facts.errors import NonFiniteError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness
from radiokit.measure.lattice import kronecker

__all__ = ["SOURCE", "microfacet"]

SOURCE = Source(
    authors="Heitz",
    year=2014,
    title="Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs. "
    "Journal of Computer Graphics Techniques 3(2)",
    equation="the normalisation of D, the visible projected area, and the weak white furnace test",
)

CLAIM = "∫ D cosθ dω = 1, ∫ G₁ (wo·h)⁺ D dω = cosθo, ∫ G₁ D / (4 cosθo) dωi = 1, 0 ≤ G₂ ≤ G₁ ≤ 1"

ANGLES_DEG = (0.0, 30.0, 60.0, 80.0, 89.0)
AZIMUTHS = (0.3, 0.3 + np.pi / 2)

TOLERANCE = 1e-7
"""How far from 1 an integral may lie."""

COARSE = 1e-4
"""The largest error with which an integral still tells anything."""

ROUNDING = 1e-12
"""How far beyond its limit a share may lie."""

PAIRS = 1 << 13


def microfacet(facets: Microfacets, *, tolerance: float = TOLERANCE) -> Verdict:
    """Judge whether facets make up a surface: a distribution D with its masking G₁ and shadowing G₂.

    Seen from above, the facets cover the surface once. Seen from any ``wo``, those that are seen cover its
    projected area. A surface whose facets reflect everything, and cast no shadows, therefore scatters all
    light once, some of it below the horizon. A share is in [0, 1], what is seen from both sides is at most
    what is seen from one, and the two sides may be exchanged.

    Parameters
    ----------
    facets : Microfacets
    tolerance : float
        How far from 1 an integral may lie.
    """
    start = time.perf_counter()
    counted = _Counted(facets)
    details: dict[str, Any] = {"tolerance": tolerance, "rows": []}
    common: dict[str, Any] = {"check": "microfacet", "claim": CLAIM, "details": details}

    def verdict(outcome: Outcome, evidence: Evidence, message: str, **more: Any) -> Verdict:
        seconds = time.perf_counter() - start
        return Verdict(
            outcome=outcome,
            evidence=evidence,
            message=message,
            evaluations=counted.evaluations,
            seconds=seconds,
            **common,
            **more,
        )

    width = _width(counted)
    details["width_rad"] = width
    broken = _shares(counted, width)
    if broken is not None:
        return verdict(Outcome.VIOLATED, Evidence.REFUTED, broken[0], witness=broken[1])
    worst, unsure = 0.0, ""
    try:
        for name, wo, estimate in _integrals(counted, width):
            error = float(estimate.error)
            gap = abs(float(estimate.value) - 1)
            theta = float(np.rad2deg(np.arctan2(np.hypot(wo[0], wo[1]), wo[2])))
            details["rows"].append(
                {"law": name, "theta_deg": theta, "value": float(estimate.value), "error": error}
            )
            worst = max(worst, gap)
            if gap > error + tolerance and (estimate.converged or error <= COARSE):
                place = "" if name == COVER else f" at θo = {theta:.4g}°"
                return verdict(
                    Outcome.VIOLATED,
                    Evidence.REFUTED,
                    f"{name} is {float(estimate.value):.8g} ± {error:.1g}{place}, not 1",
                    witness=Witness({"wo": wo.tolist()}, {name: float(estimate.value), "±": error}),
                    estimate=estimate,
                    limit=1.0,
                )
            if error > COARSE:
                unsure = unsure or f"{name} is known only to ± {error:.1g} at θo = {theta:.4g}°"
    except NonFiniteError as error_found:
        return verdict(Outcome.INCONCLUSIVE, Evidence.MEASURED, f"no integral: {error_found}")
    if unsure:
        return verdict(Outcome.INCONCLUSIVE, Evidence.BOUNDED, unsure)
    count = len(details["rows"])
    return verdict(
        Outcome.HOLDS,
        Evidence.BOUNDED,
        f"{count} integrals are 1 within {worst:.1g}; no share is above its limit",
    )


COVER = "∫ D cosθ dω"
AREA = "∫ G₁ (wo·h)⁺ D dω / cosθo"
FURNACE = "∫ G₁ D / (4 cosθo) dωi"


def _integrals(facets: Microfacets, width: float) -> Iterator[tuple[str, FloatArray, Estimate]]:
    up = np.array([0.0, 0.0, 1.0])
    yield COVER, up, over_facets(lambda h: facets.density(h) * h[:, 2], up, width)
    for theta in ANGLES_DEG:
        for phi in AZIMUTHS if theta else AZIMUTHS[:1]:
            wo = polar(np.cos(np.deg2rad([theta])), [phi])[0]
            yield AREA, wo, projected_area(facets, wo, width=width)
            above, below = white_furnace(facets, wo, width=width)
            both = replace(
                above,
                value=above.value + below.value,
                error=above.error + below.error,
                evaluations=above.evaluations + below.evaluations,
                seconds=above.seconds + below.seconds,
                converged=above.converged and below.converged,
            )
            yield FURNACE, wo, both


def _width(facets: Microfacets) -> float:
    """Return the median polar angle of the facets [rad]: about α of a narrow distribution."""
    theta = np.geomspace(1e-6, np.pi / 2, 400)
    phi = (np.arange(16) + 0.5) * (np.pi / 8)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    h = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1)
    density = np.nan_to_num(facets.density(h.reshape(-1, 3))).reshape(t.shape)
    mass = np.cumsum(np.mean(density, axis=1) * np.sin(theta) * np.cos(theta) * theta)
    if not mass[-1] > 0:
        return 1.0
    return float(theta[np.searchsorted(mass, mass[-1] / 2)])


def _shares(facets: Microfacets, width: float) -> tuple[str, Witness] | None:
    """Look for a facet at which D is negative or a share is beyond its limit."""
    wi, wo = pairs(PAIRS)
    u = kronecker(PAIRS, 2)
    theta = np.where(
        np.arange(PAIRS) % 2 == 0, np.arctan(width * np.sinh(np.arcsinh(20.0) * u[:, 0])), np.arccos(u[:, 0])
    )
    h = np.stack(
        [
            np.sin(theta) * np.cos(2 * np.pi * u[:, 1]),
            np.sin(theta) * np.sin(2 * np.pi * u[:, 1]),
            np.cos(theta),
        ],
        axis=-1,
    )
    h = np.where((np.arange(PAIRS) % 4 == 3)[:, None], half_vector(wi, wo), h)
    turned = (dot(wi, h) > 0) & (dot(wo, h) > 0) & (h[:, 2] > 0)
    wi, wo, h = wi[turned], wo[turned], h[turned]
    density = facets.density(h)
    one, other = facets.masking(wi, h), facets.masking(wo, h)
    both, swapped = facets.shadowing(wi, wo, h), facets.shadowing(wo, wi, h)
    low = np.minimum(one, other)
    laws: tuple[tuple[str, Any, dict[str, FloatArray]], ...] = (
        ("D is negative or not finite", ~((density >= 0) & np.isfinite(density)), {"D": density}),
        ("G₁ is not in [0, 1]", ~((one >= 0) & (one <= 1 + ROUNDING)), {"G₁(wi, h)": one}),
        ("G₂ is negative or not finite", ~((both >= 0) & np.isfinite(both)), {"G₂": both}),
        (
            "G₂ is above the smaller G₁",
            both > low * (1 + 1e-9) + ROUNDING,
            {"G₂": both, "G₁(wi, h)": one, "G₁(wo, h)": other},
        ),
        (
            "G₂ is not the same when wi and wo are exchanged",
            np.abs(both - swapped) > 1e-9 * both + ROUNDING,
            {"G₂(wi, wo, h)": both, "G₂(wo, wi, h)": swapped},
        ),
    )
    for message, bad, values in laws:
        if np.any(bad):
            row = int(np.argmax(bad))
            at = {"wi": wi[row].tolist(), "wo": wo[row].tolist(), "h": h[row].tolist()}
            found = f"{message}, at {int(np.sum(bad))} of {len(h)} places"
            return found, Witness(at, {name: float(value[row]) for name, value in values.items()})
    return None


class _Counted:
    """Facets that count how many values of D are asked of them."""

    def __init__(self, facets: Microfacets) -> None:
        self.facets, self.evaluations = facets, 0

    def density(self, h: FloatArray) -> FloatArray:
        self.evaluations += len(h)
        return np.asarray(self.facets.density(h), dtype=float)

    def masking(self, w: FloatArray, h: FloatArray) -> FloatArray:
        return np.asarray(self.facets.masking(w, h), dtype=float)

    def shadowing(self, wi: FloatArray, wo: FloatArray, h: FloatArray) -> FloatArray:
        return np.asarray(self.facets.shadowing(wi, wo, h), dtype=float)
