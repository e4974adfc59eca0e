"""Transmission: quadrature over the hemisphere opposite to ``wo``, resolved as a refracted lobe needs it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import GK21, ROUNDING, Integrand, RuleSum, apply_rule, converge
from radiokit.measure.curves import Curve, critical
from radiokit.measure.ladders import WIDTHS
from radiokit.measure.lattice import kronecker
from radiokit.measure.quadrature import STEEPNESS, hemisphere
from radiokit.measure.refraction import refracted, refracted_map, refracted_rule, rest_rule
from radiokit.measure.scan import SCAN, missed
from radiokit.measure.slope import PROBE_WIDTH, mirrored, slope_map

__all__ = ["THIN", "find_width", "reflection_edges", "sphere", "transmission"]

FloatArray = npt.NDArray[np.float64]

SIZES = ((16, 10), (20, 14), (28, 18), (36, 24), (48, 32), (64, 44), (88, 60), (120, 84))
"""Radii and azimuths of each panel."""

REST_SIZES = (10, 14, 18, 24, 32, 44, 60, 84)
"""Nodes along each axis of each panel of the directions to which no facet refracts."""

LOOK_SMOOTH = 512
"""Points at which a smooth integrand is looked at for anything that no facet refracts."""

PROBE = (40, 12)
"""Radii and azimuths of each panel at which an unknown integrand is looked at for its lobe."""

THIN = 1e-7
"""Media whose relative index is closer to 1 do not refract: −wo is the lobe's direction."""

_FLIP = np.array([1.0, 1.0, -1.0])


def transmission(
    integrand: Integrand,
    *,
    wo: npt.ArrayLike,
    eta: float = 1.0,
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    symmetric: bool = False,
    smooth: bool = False,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Integrate over the hemisphere opposite to ``wo``: ∫ g(ω) dω, with nodes around the refracted direction.

    Where η is 1 (a thin sheet, or a refraction that nobody knows of) the reflection rule is used, mirrored
    at the surface, so that its lobe lies around −wo. Otherwise the directions to which some facet refracts
    and all others are two regions, each with rules of rising size that are compared until they agree; the
    second is left out where the integrand is 0 at every one of thousands of points (hundreds, if ``smooth``).

    Parameters
    ----------
    integrand : callable
        Takes unit vectors (N, 3) on the other side of the surface, returns (N,) or (N, K).
    wo : array_like, shape (3,)
        On either side of the surface.
    eta : float
        Refractive index on the other side over that on wo's side, > 0.
    width : float, optional
        The lobe's width in the slope of facet normals (α of a microfacet model); found when not given.
    rtol, atol : float
        The error may be ``max(atol, rtol |value|)``.
    symmetric, smooth, max_evaluations
        As for ``hemisphere``; ``smooth`` is meant within each of the two regions.

    Returns
    -------
    Estimate
        Of kind "truncation", of shape () or (K,).

    Raises
    ------
    ParameterError
        When ``wo`` lies in the surface, or ``eta`` or ``width`` is not positive.
    NonFiniteError
        When the integrand is NaN or infinite somewhere.

    >>> diffuse = transmission(lambda w: -w[:, 2] / np.pi, wo=(0.0, 0.6, 0.8), eta=1.5, rtol=1e-10)
    >>> bool(abs(diffuse.value - 1) <= diffuse.error <= 1e-10)
    True
    """
    start = time.perf_counter()
    direction: FloatArray = np.asarray(wo, dtype=float)
    if direction[2] == 0 or not np.isfinite(direction[2]):
        raise ParameterError("wo", direction.tolist(), "not in the surface (z = 0)")
    if not (np.isfinite(eta) and eta > 0):
        raise ParameterError("eta", eta, "finite and greater than 0")
    if width is not None and not width > 0:
        raise ParameterError("width", width, "greater than 0")
    below = integrand
    if direction[2] < 0:
        direction = direction * _FLIP
        below = lambda w: integrand(w * _FLIP)  # noqa: E731

    def flipped(w: FloatArray) -> Any:
        return below(w * _FLIP)

    options: dict[str, Any] = {"rtol": rtol, "atol": atol, "symmetric": symmetric}
    if abs(eta - 1) < THIN:
        found = hemisphere(
            flipped, wo=direction, width=width, smooth=smooth, max_evaluations=max_evaluations, **options
        )
        return replace(found, method=f"{found.method}, mirrored", seconds=time.perf_counter() - start)

    spent = 0
    if width is None:
        width, spent = find_width(below, direction, eta)
    budget = max_evaluations - spent
    aside = _aside(below, direction, eta, LOOK_SMOOTH if smooth or budget < 8 * SCAN else SCAN)
    spent += aside.points
    rest = bool(np.any(aside.mean != 0) or np.any(aside.spread != 0))
    scan = None
    if not smooth and budget > 2 * SCAN:
        lobe = _lobe_scan(below, direction, eta, width)
        spent += lobe.points
        scan = lobe.mean + aside.mean, np.hypot(lobe.spread, aside.spread)

    def rules() -> Iterator[RuleSum]:
        used = spent
        for k, (n, factor) in enumerate(zip(SIZES, WIDTHS, strict=False)):
            wi, weight, _ = refracted_rule(direction, eta, width * factor, n, symmetric=symmetric)
            if rest:
                other, other_weight = rest_rule(direction, eta, REST_SIZES[k], symmetric=symmetric)
                wi, weight = np.concatenate([wi, other]), np.concatenate([weight, other_weight])
            used += len(wi)
            if k > 2 and used > max_evaluations:
                return
            yield apply_rule(below, wi, weight)

    # The normal of a facet between media of nearly the same index is known to an eps of their difference.
    rounding = ROUNDING + STEEPNESS / width * (1 / float(direction[2]) + 4 / abs(eta - 1))
    found = converge(rules(), rtol, atol, smooth=smooth, rounding=rounding)
    method = "slope-space quadrature of refraction"
    budget = max_evaluations - found.evaluations - spent
    if (not found.converged or (scan is not None and missed(found, *scan) > 0)) and budget > 4 * GK21:
        other_way = hemisphere(flipped, wo=direction, smooth=smooth, max_evaluations=budget, **options)
        spent += other_way.evaluations
        if other_way.converged or np.all(other_way.error <= found.error):
            spent += found.evaluations - other_way.evaluations
            found, method = other_way, f"{other_way.method}, mirrored"
    lost = 0.0 if scan is None else missed(found, *scan)
    if lost > 0:
        note = "a scan of the hemisphere found mass that the rules missed"
        found = replace(found, error=np.maximum(found.error, 2 * lost), converged=False, note=note)
    return replace(
        found,
        evaluations=found.evaluations + spent,
        seconds=time.perf_counter() - start,
        method=method,
        note=found.note if found.note or found.converged else "the tolerance was not reached",
    )


def sphere(
    integrand: Integrand,
    *,
    wo: npt.ArrayLike,
    eta: float = 1.0,
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    symmetric: bool = False,
    smooth: bool = False,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Integrate over all directions: wo's own side by ``hemisphere``, the other one by ``transmission``.

    The tolerance is that of the sum, so that a side that adds little costs little.

    Parameters
    ----------
    integrand, wo, eta, width, rtol, atol, symmetric, smooth, max_evaluations
        As for ``transmission``; the integrand is asked for directions on both sides.

    >>> estimate = sphere(lambda w: np.abs(w[:, 2]), wo=(0.0, 0.6, -0.8), eta=1.5)
    >>> round(float(estimate.value) / np.pi, 9)
    2.0
    """
    start = time.perf_counter()
    direction: FloatArray = np.asarray(wo, dtype=float)
    own = integrand if not direction[2] < 0 else lambda w: integrand(w * _FLIP)
    options: dict[str, Any] = {"width": width, "symmetric": symmetric, "smooth": smooth}
    reflected = hemisphere(
        own,
        wo=direction * [1.0, 1.0, np.copysign(1.0, direction[2])],
        rtol=rtol / 2,
        atol=atol / 2,
        max_evaluations=max_evaluations // 2,
        edges=reflection_edges(eta),
        **options,
    )
    enough = max(atol / 2, rtol / 2 * float(np.min(np.abs(reflected.value))))
    left = max_evaluations - reflected.evaluations
    transmitted = transmission(
        integrand, wo=direction, eta=eta, rtol=rtol / 2, atol=enough, max_evaluations=left, **options
    )
    found = reflected + transmitted
    converged = bool(np.all(found.error <= np.maximum(atol, rtol * np.abs(found.value))))
    converged = converged and not any("scan" in note for note in (reflected.note, transmitted.note))
    note = "" if converged else found.note or "the tolerance was not reached"
    seconds = time.perf_counter() - start
    return replace(found, converged=converged, note=note, seconds=seconds)


def reflection_edges(eta: float) -> tuple[Curve, ...]:
    """Return where facets between media begin to reflect all light that comes from the side of ``wo``.

    >>> reflection_edges(1.5)
    ()
    """
    return critical(float(np.sqrt((1 - eta) * (1 + eta)))) if eta < 1 else ()


@dataclass(frozen=True)
class _Scan:
    """A rough integral and its uncertainty."""

    mean: Any
    spread: Any
    points: int


def _aside(below: Integrand, wo: FloatArray, eta: float, count: int) -> _Scan:
    """Scan the directions to which no facet refracts, where most integrands are 0."""
    wi, weight, _ = slope_map(wo, 1.0, *kronecker(count, 2).T)
    wi[::2] = mirrored(wi[::2], wo)
    wi = wi * _FLIP
    there = ~refracted(wi, wo, eta)
    if not np.any(there):
        return _Scan(0.0, 0.0, 0)
    value = np.asarray(below(wi[there]), dtype=float)
    terms = np.zeros((count, *value.shape[1:]))
    terms[there] = (value.T * weight[there]).T
    return _Scan(terms.mean(axis=0), terms.std(axis=0) / np.sqrt(count), len(value))


def _lobe_scan(below: Integrand, wo: FloatArray, eta: float, width: float) -> _Scan:
    """Scan the directions to which some facet refracts."""
    wi, weight, _ = refracted_map(wo, eta, width, *kronecker(SCAN, 2).T)
    wi[::2] = mirrored(wi[::2], wo)
    terms = (np.asarray(below(wi), dtype=float).T * weight).T
    return _Scan(terms.mean(axis=0), terms.std(axis=0) / np.sqrt(SCAN), SCAN)


def find_width(below: Integrand, wo: FloatArray, eta: float) -> tuple[float, int]:
    """Return the median slope of facets under the integrand's own mass, and the evaluations."""
    wi, weight, slope = refracted_rule(wo, eta, PROBE_WIDTH, PROBE)
    value = np.abs(np.asarray(below(wi), dtype=float).reshape(len(wi), -1)).sum(axis=1)
    order = np.argsort(slope)
    mass = np.cumsum((weight * value)[order])
    if not (np.isfinite(mass[-1]) and mass[-1] > 0):
        return 1.0, len(wi)
    median = slope[order][np.searchsorted(mass, mass[-1] / 2)]
    return float(np.clip(median, 10 * PROBE_WIDTH, 1.0)), len(wi)
