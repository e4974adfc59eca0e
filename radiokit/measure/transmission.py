"""Transmission: quadrature over the hemisphere opposite to ``wo``, resolved as a refracted lobe needs it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import GK21, ROUNDING, Integrand, RuleSum, apply_rule, converge
from radiokit.measure.lattice import kronecker
from radiokit.measure.quadrature import SCAN, STEEPNESS, WIDTHS, hemisphere, missed, scan_of
from radiokit.measure.slope import PROBE_WIDTH, gauss_legendre, mirrored, slope_map

__all__ = ["refracted_rule", "rest_rule", "transmission"]

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


def refracted_rule(
    wo: npt.ArrayLike,
    eta: float,
    width: float,
    n: tuple[int, int],
    *,
    symmetric: bool = False,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return directions and solid-angle weights that resolve a lobe around the refracted direction of ``wo``.

    The nodes are those of the facet normals h that refract ``wo`` into wi, in the stereographic plane, where
    a normal at angle θ from the surface's has the radius q = tan(θ/2). All limits are circles there. With
    S = sinθo cosφ, c = √max(0, 1 − η²) and D = S² + cos²θo − c² the incidence on the facet is

        wo·h − c = (cosθo + c)(q₊ − q)(q − q₋)/(1 + q²),   q± = (S ± √D)/(cosθo + c),

    so that total internal reflection, or for η > 1 the facet's back, begins exactly at q₊; facets end at
    q = 1. Where the mean surface reflects totally, facets that refract wi below the horizon begin at the
    slope (S − √(η² − sin²θo sin²φ))/cosθo. The azimuth is cut where two limits meet.

    Parameters
    ----------
    wo : array_like, shape (3,)
        Unit vector above the horizon.
    eta : float
        Refractive index on wi's side over that on wo's side; not 1.
    width : float
        The lobe's width in the slope of h, > 0: α of a microfacet model.
    n : (int, int)
        Nodes along the radius, and along the azimuth of each panel.
    symmetric : bool
        Whether the integrand is even in the azimuth relative to ``wo``; half the nodes then suffice.

    Returns
    -------
    wi : ndarray, shape (N, 3)
        Unit vectors below the horizon.
    weight : ndarray, shape (N,)
        Weights [sr].
    slope : ndarray, shape (N,)
        The slope of h.

    Source: the generalised half vector and its Jacobian are those of Walter, Marschner, Li, Torrance (2007),
    Microfacet models for refraction through rough surfaces, EGSR, eqs. (16)-(17); the coordinates are ours.

    >>> wi, weight, _ = refracted_rule((0.0, 0.0, 1.0), 1.5, 1.0, (24, 12))
    >>> round(float(weight.sum() / (2 * np.pi)), 12)  # 1 − 1/η: all facets that face wo, to the critical angle
    0.333333333333
    """
    wo = np.asarray(wo, dtype=float)
    cos_o, sin_o = float(wo[2]), float(np.hypot(wo[0], wo[1]))
    least = float(np.sqrt(max(0.0, (1 - eta) * (1 + eta))))
    x, wx = gauss_legendre(n[0])
    phi, sigma_cos, w_phi = _azimuths(cos_o, sin_o, eta, least, n[1])
    cos_phi, sin_phi = np.cos(phi), np.sin(phi)
    along = sin_o * cos_phi
    beyond = eta < 1 and sin_o > eta
    # √D; total reflection from the mean surface leaves azimuths for which it is η cosσ.
    if beyond:
        root = eta * sigma_cos
        steep = (sin_o - eta) * (sin_o + eta) / (along + root) / cos_o
        near = (sin_o - eta) * (sin_o + eta) / (along + root) / (cos_o + least)
        start = steep / (1 + np.sqrt(1 + steep * steep))
    else:
        margin = (eta - sin_o) * (eta + sin_o) if eta < 1 else cos_o * cos_o
        root = np.sqrt(along * along + margin)
        near = -margin / (cos_o + least) / np.where(along < 0, 1.0, along + root)
        near = np.where(along < 0, (along - root) / (cos_o + least), near)
        start = np.zeros_like(phi)
    far = np.where(
        along < 0,
        np.divide(
            (cos_o - least), np.where(along < 0, root - along, 1.0)
        ),
        (along + root) / (cos_o + least),
    )
    end = np.minimum(far, 1.0)
    half = width / 2
    low, high = np.arcsinh(start / half), np.arcsinh(end / half)
    span = np.maximum(high - low, 0.0)
    share, rest, slope = _eased(x) if beyond else (x * (2 - x), (1 - x) ** 2, 2 * (1 - x))
    t = low + span * share[:, None]
    q = half * np.sinh(t)
    gap = 2 * half * np.cosh((high + t) / 2) * np.sinh(span * rest[:, None] / 2) + (far - end)
    square = 1 + q * q
    over = (cos_o + least) * gap * np.maximum(q - near, 0.0) / square  # wo·h − c
    cos_h = least + over
    bent = np.sqrt(cos_h * cos_h + (eta - 1) * (eta + 1)) if eta > 1 else np.sqrt(over * (over + 2 * least))
    kappa = (1 - eta) * (1 + eta) / (cos_h + bent)
    tilt, lift = 2 * q / square, (1 - q) * (1 + q) / square
    in_plane = (kappa * tilt * cos_phi - sin_o) / eta
    across = kappa * tilt * sin_phi / eta
    upright = np.minimum((kappa * lift - cos_o) / eta, -np.finfo(float).tiny)
    c, d = (1.0, 0.0) if sin_o == 0 else (wo[0] / sin_o, wo[1] / sin_o)
    wi = np.stack([c * in_plane - d * across, d * in_plane + c * across, upright], axis=-1)
    radial = half * np.cosh(t) * span * (slope * wx)[:, None]
    weight = np.divide(kappa * kappa, eta * bent, out=np.zeros_like(bent), where=bent > 0)
    weight = weight * (4 * q / (square * square)) * radial * (2 * w_phi)
    tangent = (tilt / np.maximum(lift, np.finfo(float).tiny)).ravel()
    wi, weight = wi.reshape(-1, 3), weight.ravel()
    if not symmetric:
        wi = np.concatenate([wi, mirrored(wi, wo)])
        weight, tangent = np.concatenate([weight, weight]) / 2, np.concatenate([tangent, tangent])
    return wi, weight, tangent


def _azimuths(
    cos_o: float, sin_o: float, eta: float, least: float, n: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return azimuths in [0, π], cosσ where these are limited by sinφ = (η/sinθo) sinσ, and weights."""
    beyond = eta < 1 and sin_o > eta
    edges = [0.0, np.pi / 2] if beyond else [0.0, np.pi / 2, np.pi]
    if beyond:
        scale = float(np.sqrt((sin_o - eta) * (sin_o + eta))) / sin_o
    elif eta < 1:
        scale = float(np.arccosh(eta / sin_o)) if sin_o > 0.1 * eta else 3.0
    else:
        scale = float(np.arctan2(cos_o, sin_o))
    scale = max(scale, 1e-4)
    if eta < 1 and sin_o > least:  # where total reflection and the end of all facets meet
        meet = float(np.arctan2(np.sqrt(max(0.0, (sin_o - least) * (sin_o + least))), least))
        if beyond:
            meet = float(np.arcsin(min(1.0, np.sin(meet) * sin_o / eta)))
        if 0 < meet < np.pi / 2:
            edges.insert(1, meet)
    x, w = gauss_legendre(n)
    angles, weights = [], []
    for a, b in zip(edges, edges[1:], strict=False):  # crowded towards π/2
        va, vb = np.arcsinh((a - np.pi / 2) / scale), np.arcsinh((b - np.pi / 2) / scale)
        share, _, slope = _eased(x) if eta < 1 else (x, 1 - x, np.ones_like(x))
        v = va + (vb - va) * share
        angles.append(np.pi / 2 + scale * np.sinh(v))
        weights.append(scale * np.cosh(v) * (vb - va) * slope * w)
    sigma, weight = np.concatenate(angles), np.concatenate(weights)
    if not beyond:
        return sigma, np.ones_like(sigma), weight
    cos_sigma = np.cos(sigma)
    cos_phi = np.sqrt((sin_o - eta) * (sin_o + eta) + (eta * cos_sigma) ** 2) / sin_o
    phi = np.arctan2(eta / sin_o * np.sin(sigma), cos_phi)
    return phi, cos_sigma, weight * (eta / sin_o) * cos_sigma / cos_phi


def _eased(x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Map [0, 1] to itself, crowded towards both ends; return the map, its complement and its slope."""
    y = 1 - x
    return x**3 * (10 - 15 * x + 6 * x * x), y**3 * (10 - 15 * y + 6 * y * y), 30 * (x * y) ** 2


def rest_rule(
    wo: FloatArray, eta: float, n: int, *, symmetric: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Return directions and weights over the part below the horizon to which no facet refracts ``wo``.

    With m = min(η, 1/η) these are the directions farther than arccos m from −wo, and those whose facet would
    have its normal below the horizon: |cosθi| below cosθo/η for η > 1, above it for η < 1. The coordinates
    are stereographic about −z, where all limits are circles.

    >>> wi, weight = rest_rule(np.array([0.0, 0.0, 1.0]), 1.5, 16)
    >>> round(float(weight.sum() / (2 * np.pi)), 12)
    0.666666666667
    """
    cos_o, sin_o = float(wo[2]), float(np.hypot(wo[0], wo[1]))
    m = min(eta, 1 / eta)
    level = min(1.0, cos_o / eta)
    edge = float(np.sqrt((1 - level) / (1 + level)))
    cuts = [0.0, np.pi / 2, np.pi]
    if sin_o > 0:
        cosines = [m / sin_o, -m / sin_o]
        if level < 1:
            cosines.append((m - cos_o * level) / (sin_o * np.sqrt((1 - level) * (1 + level))))
        sine = np.sqrt((1 - m) * (1 + m)) / sin_o
        angles = [float(np.arccos(cosine)) for cosine in cosines if abs(cosine) < 1]
        angles += [float(np.arcsin(sine))] if sine < 1 else []
        cuts = sorted({*cuts, *angles})
    x, w = gauss_legendre(n)
    share, _, slope = _eased(x)
    spans = np.diff(cuts)
    phi = (np.array(cuts[:-1])[:, None] + spans[:, None] * share).ravel()
    w_phi = (spans[:, None] * (slope * w)).ravel()
    along = sin_o * np.cos(phi)
    square = along * along + (cos_o - m) * (cos_o + m)
    root = np.sqrt(np.maximum(square, 0.0))
    low, high = (0.0, edge) if eta > 1 else (edge if level < 1 else 0.0, 1.0)
    first = np.clip((along - root) / (cos_o + m), low, high)
    last = np.maximum(np.clip((along + root) / (cos_o + m), low, high), first)
    first = np.where(square < 0, 0.0, first)
    last = np.where(square < 0, 0.0, last)
    empty = last <= first
    begin = np.concatenate([np.zeros_like(first), np.where(empty, 0.0, last)])
    end = np.concatenate([np.where(empty, 0.0, first), np.ones_like(last)])
    keep = end > begin
    phi, w_phi = np.tile(phi, 2)[keep], np.tile(w_phi, 2)[keep]
    begin, end = begin[keep], end[keep]
    r = begin + (end - begin) * share[:, None]
    one = 1 + r * r
    tilt = 2 * r / one
    c, d = (1.0, 0.0) if sin_o == 0 else (wo[0] / sin_o, wo[1] / sin_o)
    along, across = -tilt * np.cos(phi), tilt * np.sin(phi)
    upright = np.minimum(-(1 - r) * (1 + r) / one, -np.finfo(float).tiny)
    wi = np.stack([c * along - d * across, d * along + c * across, upright], axis=-1).reshape(-1, 3)
    weight = (4 * r / (one * one) * (end - begin) * (slope * w)[:, None] * (2 * w_phi)).ravel()
    if not symmetric:
        wi = np.concatenate([wi, mirrored(wi, wo)])
        weight = np.concatenate([weight, weight]) / 2
    return wi, weight


def _refracted(wi: FloatArray, wo: FloatArray, eta: float) -> npt.NDArray[np.bool_]:
    """Return whether a facet above the horizon refracts ``wo`` into ``wi``."""
    turned_away = -(wi @ wo) > min(eta, 1 / eta)
    above = eta * -wi[:, 2] > wo[2] if eta > 1 else eta * -wi[:, 2] < wo[2]
    return turned_away & above


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
    wo = np.asarray(wo, dtype=float)
    if wo[2] == 0 or not np.isfinite(wo[2]):
        raise ParameterError("wo", wo.tolist(), "not in the surface (z = 0)")
    if not (np.isfinite(eta) and eta > 0):
        raise ParameterError("eta", eta, "finite and greater than 0")
    if width is not None and not width > 0:
        raise ParameterError("width", width, "greater than 0")
    below = integrand
    if wo[2] < 0:
        wo = wo * _FLIP
        below = lambda w: integrand(w * _FLIP)  # noqa: E731

    def flipped(w: FloatArray) -> Any:
        return below(w * _FLIP)

    options: dict[str, Any] = {"rtol": rtol, "atol": atol, "symmetric": symmetric}
    if abs(eta - 1) < THIN:
        found = hemisphere(
            flipped, wo=wo, width=width, smooth=smooth, max_evaluations=max_evaluations, **options
        )
        return replace(found, method=f"{found.method}, mirrored", seconds=time.perf_counter() - start)

    spent = 0
    if width is None:
        width, spent = _find_width(below, wo, eta)
    look, _, _ = slope_map(wo, 1.0, *kronecker(LOOK_SMOOTH if smooth else SCAN, 2).T)
    look[::2] = mirrored(look[::2], wo)
    look = look[~_refracted(look * _FLIP, wo, eta)] * _FLIP
    spent += len(look)
    rest = bool(np.any(np.asarray(below(look)))) if len(look) else False

    scan = None
    if not smooth and max_evaluations - spent > 2 * SCAN:
        scan = scan_of(flipped, wo, width)
        spent += SCAN

    def rules() -> Iterator[RuleSum]:
        used = spent
        for k, (n, factor) in enumerate(zip(SIZES, WIDTHS, strict=False)):
            wi, weight, _ = refracted_rule(wo, eta, width * factor, n, symmetric=symmetric)
            if rest:
                other, other_weight = rest_rule(wo, eta, REST_SIZES[k], symmetric=symmetric)
                wi, weight = np.concatenate([wi, other]), np.concatenate([weight, other_weight])
            used += len(wi)
            if k > 2 and used > max_evaluations:
                return
            yield apply_rule(below, wi, weight)

    # The normal of a facet between media of nearly the same index is known to an eps of their difference.
    rounding = ROUNDING + STEEPNESS / width * (1 / float(wo[2]) + 4 / abs(eta - 1))
    found = converge(rules(), rtol, atol, smooth=smooth, rounding=rounding)
    method = "slope-space quadrature of refraction"
    budget = max_evaluations - found.evaluations - spent
    if (not found.converged or missed(found, scan) > 0) and budget > 4 * GK21:
        other_way = hemisphere(flipped, wo=wo, smooth=smooth, max_evaluations=budget, **options)
        spent += other_way.evaluations
        if other_way.converged or np.all(other_way.error <= found.error):
            spent += found.evaluations - other_way.evaluations
            found, method = other_way, f"{other_way.method}, mirrored"
    lost = missed(found, scan)
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


def _find_width(below: Integrand, wo: FloatArray, eta: float) -> tuple[float, int]:
    """Return the median slope of facets under the integrand's own mass, and the evaluations."""
    wi, weight, slope = refracted_rule(wo, eta, PROBE_WIDTH, PROBE)
    value = np.abs(np.asarray(below(wi), dtype=float).reshape(len(wi), -1)).sum(axis=1)
    order = np.argsort(slope)
    mass = np.cumsum((weight * value)[order])
    if not (np.isfinite(mass[-1]) and mass[-1] > 0):
        return 1.0, len(wi)
    median = slope[order][np.searchsorted(mass, mass[-1] / 2)]
    return float(np.clip(median, 10 * PROBE_WIDTH, 1.0)), len(wi)
