"""Refraction: directions and weights that resolve a lobe which facets refract, up to each of its limits."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.slope import mirrored

__all__ = ["panels", "refracted", "refracted_inverse", "refracted_map", "refracted_rule", "rest_rule"]

FloatArray = npt.NDArray[np.float64]

TABLE = 12 * (1 << 10)
"""Intervals of the tables by which the map is inverted."""


def refracted_map(
    wo: FloatArray, eta: float, width: float, x: FloatArray, s: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Map the unit square's (x, s) to the directions to which some facet refracts ``wo``, on one side.

    The coordinates are those of the facet's normal h in the stereographic plane, where a normal at the angle
    θ from the surface's has the radius q = tan(θ/2). All limits are circles there. With S = sinθo cosφ,
    c = √max(0, 1 − η²) and D = S² + cos²θo − c² the incidence on the facet is

        wo·h − c = (cosθo + c)(q₊ − q)(q − q₋)/(1 + q²),   q± = (S ± √D)/(cosθo + c),

    so that total internal reflection, or for η > 1 the facet's back, begins exactly at q₊; facets end at
    q = 1. Where the mean surface reflects totally, facets that refract below the horizon begin at the slope
    (S − √(η² − sin²θo sin²φ))/cosθo. The azimuth is cut into ``panels`` where two limits meet, and s runs
    over them in turn.

    Parameters
    ----------
    wo : ndarray, shape (3,)
        Unit vector above the horizon.
    eta : float
        Refractive index on wi's side over that on wo's side; not 1.
    width : float
        The lobe's width in the slope of h, > 0: α of a microfacet model.
    x, s : ndarray, broadcast to a shape (...)
        Points of the unit square.

    Returns
    -------
    wi : ndarray, shape (..., 3)
        Unit vectors below the horizon.
    weight : ndarray, shape (...)
        Solid angle per unit of x and s [sr], for both halves together.
    slope : ndarray, shape (...)
        The slope of h.

    Source: the generalised half vector and its Jacobian are those of Walter, Marschner, Li, Torrance (2007),
    Microfacet models for refraction through rough surfaces, EGSR, eqs. (16)-(17); the coordinates are ours.
    """
    cos_o, sin_o = float(wo[2]), float(np.hypot(wo[0], wo[1]))
    least = float(np.sqrt(max(0.0, (1 - eta) * (1 + eta))))
    beyond = eta < 1 and sin_o > eta  # the mean surface reflects totally
    phi, cos_sigma, w_phi = _azimuths(cos_o, sin_o, eta, s)
    cos_phi, sin_phi = np.cos(phi), np.sin(phi)
    near, far, start = _limits(cos_o, sin_o, eta, cos_phi, cos_sigma)
    share, rest, slope = _leaning(x) if beyond else (x * (2 - x), (1 - x) ** 2, 2 * (1 - x))
    end = np.minimum(far, 1.0)
    half = width / 2
    low, high = np.arcsinh(start / half), np.arcsinh(end / half)
    span = np.maximum(high - low, 0.0)
    t = low + span * share
    q = half * np.sinh(t)
    gap = width * np.cosh((high + t) / 2) * np.sinh(span * rest / 2) + (far - end)  # q₊ − q
    square = 1 + q * q
    over = (cos_o + least) * gap * np.maximum(q - near, 0.0) / square  # wo·h − c
    cos_h = least + over
    bent = np.sqrt(cos_h * cos_h + (eta - 1) * (eta + 1)) if eta > 1 else np.sqrt(over * (over + 2 * least))
    kappa = (1 - eta) * (1 + eta) / (cos_h + bent)  # η wi = κ h − wo, and bent = −η wi·h
    tilt, lift = 2 * q / square, (1 - q) * (1 + q) / square
    upright = np.minimum((kappa * lift - cos_o) / eta, -np.finfo(float).tiny)
    wi = _turned_to(wo, (kappa * tilt * cos_phi - sin_o) / eta, kappa * tilt * sin_phi / eta, upright)
    weight = np.divide(kappa * kappa, eta * bent, out=np.zeros_like(bent), where=bent > 0)
    weight = weight * (4 * q / (square * square)) * (half * np.cosh(t) * span * slope) * (2 * w_phi)
    return wi, weight, tilt / np.maximum(lift, np.finfo(float).tiny)


def _limits(
    cos_o: float, sin_o: float, eta: float, cos_phi: FloatArray, cos_sigma: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return q₋ and q₊, and the q at which the facets that refract downwards begin."""
    least = float(np.sqrt(max(0.0, (1 - eta) * (1 + eta))))
    along = sin_o * cos_phi
    if eta < 1 and sin_o > eta:
        margin = (sin_o - eta) * (sin_o + eta)
        total = along + eta * cos_sigma
        steep = margin / (total * cos_o)
        near, far = margin / (total * (cos_o + least)), total / (cos_o + least)
        return near, far, steep / (1 + np.sqrt(1 + steep * steep))
    margin = (eta - sin_o) * (eta + sin_o) if eta < 1 else cos_o * cos_o
    both = np.abs(along) + np.sqrt(along * along + margin)
    less, more = margin / (both * (cos_o + least)), both / (cos_o + least)
    return -np.where(along < 0, more, less), np.where(along < 0, less, more), np.zeros_like(cos_phi)


def refracted_inverse(
    wo: FloatArray, eta: float, width: float, wi: FloatArray
) -> tuple[FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    """Invert ``refracted_map``: return x, s, and whether ``wi`` (N, 3) lies on the mirrored side.

    By tables, whose nodes are exact and lie on the edges of a dozen cells. What no facet refracts gets the
    nearest x and s: see ``refracted``.

    >>> wo = np.array([0.6, 0.0, 0.8])
    >>> wi, _, _ = refracted_map(wo, 1.5, 0.3, np.array([0.25]), np.array([0.75]))
    >>> x, s, far = refracted_inverse(wo, 1.5, 0.3, wi)
    >>> round(float(x[0]), 6), round(float(s[0]), 6), bool(far[0])
    (0.25, 0.75, False)
    """
    cos_o, sin_o = float(wo[2]), float(np.hypot(wo[0], wo[1]))
    h = wo + eta * wi
    h = np.where(h[:, 2:] < 0, -h, h)
    c, d = (1.0, 0.0) if sin_o == 0 else (wo[0] / sin_o, wo[1] / sin_o)
    along, across = c * h[:, 0] + d * h[:, 1], c * h[:, 1] - d * h[:, 0]
    radius = np.hypot(along, across)
    q = radius / (h[:, 2] + np.hypot(radius, h[:, 2]))
    table = np.linspace(0.0, 1.0, TABLE + 1)
    phi = np.arctan2(np.abs(across), along)
    s = np.interp(phi, _azimuths(cos_o, sin_o, eta, table)[0], table)
    sine = np.sin(phi) * (sin_o / eta)
    _, far, start = _limits(cos_o, sin_o, eta, np.cos(phi), np.sqrt(np.clip(1 - sine * sine, 0.0, 1.0)))
    low, high = np.arcsinh(2 * start / width), np.arcsinh(2 * np.minimum(far, 1.0) / width)
    span = np.maximum(high - low, np.finfo(float).tiny)
    share = np.clip((np.arcsinh(2 * q / width) - low) / span, 0.0, 1.0)
    beyond = eta < 1 and sin_o > eta
    x = np.interp(share, _leaning(table)[0], table) if beyond else share / (1 + np.sqrt(1 - share))
    return x, s, across < 0


def _turned_to(wo: FloatArray, along: FloatArray, across: FloatArray, upright: FloatArray) -> FloatArray:
    """Return vectors given in the plane of incidence, across it, and along the normal."""
    sin_o = float(np.hypot(wo[0], wo[1]))
    c, d = (1.0, 0.0) if sin_o == 0 else (wo[0] / sin_o, wo[1] / sin_o)
    return np.stack(np.broadcast_arrays(c * along - d * across, d * along + c * across, upright), axis=-1)


def panels(wo: FloatArray, eta: float) -> tuple[float, ...]:
    """Return the edges in [0, π] of the panels of azimuth; of σ, sinφ = (η/sinθo) sinσ, where that limits φ.

    >>> [round(edge, 3) for edge in panels(np.array([0.8, 0.0, 0.6]), 1.5)]
    [0.0, 1.571, 3.142]
    """
    sin_o = float(np.hypot(wo[0], wo[1]))
    beyond = eta < 1 and sin_o > eta
    edges = [0.0, np.pi / 2] if beyond else [0.0, np.pi / 2, np.pi]
    least = float(np.sqrt(max(0.0, (1 - eta) * (1 + eta))))
    if eta < 1 and sin_o > least:  # total reflection meets the end of all facets
        sine = float(np.sqrt((sin_o - least) * (sin_o + least)))
        meet = float(np.arcsin(min(1.0, sine / eta))) if beyond else float(np.arctan2(sine, least))
        if 0 < meet < np.pi / 2:
            edges.insert(1, meet)
    return tuple(edges)


def _azimuths(
    cos_o: float, sin_o: float, eta: float, s: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return azimuths φ in [0, π], cosσ, and dφ/ds, for s that runs over the panels in turn."""
    edges = np.array(panels(np.array([sin_o, 0.0, cos_o]), eta))
    beyond = len(edges) and eta < 1 and sin_o > eta
    if beyond:
        scale = float(np.sqrt((sin_o - eta) * (sin_o + eta))) / sin_o
    elif eta < 1:
        scale = float(np.arccosh(eta / sin_o)) if sin_o > 0.1 * eta else 3.0
    else:
        scale = float(np.arctan2(cos_o, sin_o))
    scale = max(scale, 1e-4)  # the distance from π/2 at which the limits bend: nodes crowd there
    count = len(edges) - 1
    panel = np.minimum((s * count).astype(int), count - 1)
    part = s * count - panel
    share, _, slope = _eased(part) if eta < 1 else (part, 1 - part, np.ones_like(part))
    crowded = np.arcsinh((edges - np.pi / 2) / scale)
    span = np.diff(crowded)[panel]
    v = crowded[panel] + span * share
    sigma, weight = np.pi / 2 + scale * np.sinh(v), scale * np.cosh(v) * span * slope * count
    if not beyond:
        return sigma, np.ones_like(sigma), weight
    cos_sigma = np.cos(sigma)
    cos_phi = np.sqrt((sin_o - eta) * (sin_o + eta) + (eta * cos_sigma) ** 2) / sin_o
    phi = np.arctan2(eta / sin_o * np.sin(sigma), cos_phi)
    return phi, cos_sigma, weight * (eta / sin_o) * cos_sigma / cos_phi


def refracted_rule(
    wo: npt.ArrayLike,
    eta: float,
    width: float,
    n: tuple[int, int],
    *,
    symmetric: bool = False,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return directions and solid-angle weights that resolve a lobe around the refracted direction of ``wo``.

    Gauss-Legendre in both coordinates of ``refracted_map``, in each panel of azimuth.

    Parameters
    ----------
    n : (int, int)
        Nodes along the radius, and along the azimuth of each panel.
    symmetric : bool
        Whether the integrand is even in the azimuth relative to ``wo``; half the nodes then suffice.

    Returns
    -------
    wi : ndarray, shape (N, 3)
    weight : ndarray, shape (N,)
        Weights [sr].
    slope : ndarray, shape (N,)

    >>> wi, weight, _ = refracted_rule((0.0, 0.0, 1.0), 1.5, 1.0, (24, 12))
    >>> round(
    ...     float(weight.sum() / (2 * np.pi)), 12
    ... )  # 1 − 1/η: all facets that face wo, to the critical angle
    0.333333333333
    """
    wo = np.asarray(wo, dtype=float)
    (x, wx), (y, wy) = gauss_legendre(n[0]), gauss_legendre(n[1])
    count = len(panels(wo, eta)) - 1
    s, ws = np.concatenate([p + y for p in range(count)]) / count, np.tile(wy, count) / count
    wi, weight, slope = refracted_map(wo, eta, width, x[:, None], s)
    wi, weight, slope = wi.reshape(-1, 3), (weight * (wx[:, None] * ws)).ravel(), slope.ravel()
    if not symmetric:
        wi = np.concatenate([wi, mirrored(wi, wo)])
        weight, slope = np.concatenate([weight, weight]) / 2, np.concatenate([slope, slope])
    return wi, weight, slope


def _eased(x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Map [0, 1] to itself, crowded towards both ends; return the map, its complement and its slope."""
    y = 1 - x
    return x**3 * (10 - 15 * x + 6 * x * x), y**3 * (10 - 15 * y + 6 * y * y), 30 * (x * y) ** 2


def _leaning(x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The same, of third order at 0 and of second order at 1: a square root there becomes smooth."""
    y = 1 - x
    return x**3 * (4 - 3 * x), y * y * (1 + 2 * x + 3 * x * x), 12 * x * x * y


def rest_rule(
    wo: FloatArray, eta: float, n: int, *, symmetric: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Return directions and weights over the part below the horizon to which no facet refracts ``wo``.

    With m = min(η, 1/η) these are the directions farther than arccos m from −wo, and those whose facet would
    have its normal below the horizon: |cosθi| below cosθo/η for η > 1, above it for η < 1. The coordinates
    are stereographic about −z, where all limits are circles.

    >>> wi, weight = rest_rule(np.array([0.0, 0.0, 1.0]), 1.5, 32)
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
    upright = np.minimum(-(1 - r) * (1 + r) / one, -np.finfo(float).tiny)
    wi = _turned_to(wo, -tilt * np.cos(phi), tilt * np.sin(phi), upright).reshape(-1, 3)
    weight = (4 * r / (one * one) * (end - begin) * (slope * w)[:, None] * (2 * w_phi)).ravel()
    if not symmetric:
        wi = np.concatenate([wi, mirrored(wi, wo)])
        weight = np.concatenate([weight, weight]) / 2
    return wi, weight


def refracted(wi: FloatArray, wo: FloatArray, eta: float) -> npt.NDArray[np.bool_]:
    """Return whether a facet above the horizon refracts ``wo`` into ``wi``."""
    turned_away = -(wi @ wo) > min(eta, 1 / eta)
    above = eta * -wi[:, 2] > wo[2] if eta > 1 else eta * -wi[:, 2] < wo[2]
    return turned_away & above
