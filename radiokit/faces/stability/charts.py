"""Charts: coordinates of the hemispheres, written once for floats and for numbers of thirty digits.

Each takes the place of a pair (s, x), azimuth and radius in [0, 1], and gives a direction on one side of the
plane of incidence, where wo has the azimuth 0, with its solid angle. None shares code with the quadrature.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = [
    "Chart",
    "Numbers",
    "digits",
    "floats",
    "refracted_chart",
    "slope_chart",
    "sphere_chart",
    "turned_chart",
]

Point = tuple[Any, Any, Any, Any]
"""Components along the plane of incidence, across it and up, and the solid angle per unit of s and x."""


@dataclass(frozen=True)
class Numbers:
    """The functions of one kind of number: arrays of floats, or multiple precision."""

    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    sinh: Callable[[Any], Any]
    cosh: Callable[[Any], Any]
    asinh: Callable[[Any], Any]
    atan2: Callable[[Any, Any], Any]
    sqrt: Callable[[Any], Any]
    exp: Callable[[Any], Any]
    least: Callable[[Any, Any], Any]
    most: Callable[[Any, Any], Any]
    pick: Callable[[Any, Any, Any], Any]
    number: Callable[[Any], Any]
    pi: Any


def floats() -> Numbers:
    """Return the functions of NumPy, for arrays of floats."""
    return Numbers(
        np.sin, np.cos, np.sinh, np.cosh, np.arcsinh, np.arctan2, np.sqrt, np.exp,
        np.minimum, np.maximum, np.where, np.float64, np.pi,
    )  # fmt: skip


def digits() -> Numbers:
    """Return the functions of mpmath; π has the working precision of this moment."""
    from mpmath import mp

    return Numbers(
        mp.sin, mp.cos, mp.sinh, mp.cosh, mp.asinh, mp.atan2, mp.sqrt, mp.exp,
        min, max, lambda condition, a, b: a if condition else b, mp.mpf, mp.pi * 1,
    )  # fmt: skip


@dataclass(frozen=True)
class Chart:
    """Coordinates: ``azimuth(numbers, panel, s)`` returns the function of x; s is in [0, 1] on each panel.

    ``whole`` says that the panel is half a turn over which a smooth function is even and periodic.
    """

    name: str
    azimuth: Callable[[Numbers, int, Any], Callable[[Any], Point]]
    panels: int = 1
    whole: bool = True


def sphere_chart() -> Chart:
    """Return polar angle and azimuth: equal angles and opposite azimuths are lines in them."""

    def azimuth(n: Numbers, panel: int, s: Any) -> Callable[[Any], Point]:
        cos_phi, sin_phi = n.cos(n.pi * s), n.sin(n.pi * s)

        def point(x: Any) -> Point:
            sine, cosine = n.sin(n.pi / 2 * x), n.sin(n.pi / 2 * (1 - x))
            return sine * cos_phi, sine * sin_phi, cosine, n.pi * n.pi / 2 * sine

        return point

    return Chart("angles", azimuth)


def slope_chart(cos_o: float, sin_o: float, width: float) -> Chart:
    """Return the slope of the half vector, over ``width`` in scale, up to the horizon at ρ = e^y."""

    def azimuth(n: Numbers, panel: int, s: Any) -> Callable[[Any], Point]:
        c_o, s_o, w = n.number(cos_o), n.number(sin_o), n.number(width)
        angle = n.pi * s
        tan_o = s_o / c_o
        if sin_o < 1e-12:
            y, cos_phi, sin_phi, turn = tan_o * n.cos(angle), n.cos(angle), n.sin(angle), n.pi
        else:
            big = n.asinh(tan_o)
            y = big * n.cos(angle)
            low, high = 2 * big * n.sin(angle / 2) ** 2, 2 * big * n.cos(angle / 2) ** 2
            cos_phi, sin_phi = n.sinh(y) / tan_o, n.sqrt(n.sinh(low) * n.sinh(high)) / tan_o
            turn = n.pi * big * n.cosh(y) * n.sin(angle) / (tan_o * sin_phi)
        lean, edge = n.sinh(y), n.exp(y)
        length = n.asinh(edge / w)

        def point(x: Any) -> Point:
            t = length * x * (2 - x)
            rho = w * n.sinh(t)
            gap = 2 * w * n.cosh((length + t) / 2) * n.sinh(length * (1 - x) ** 2 / 2)
            square, inner = 1 + rho * rho, 1 + rho * lean
            lift = 2 * c_o * inner / square * rho
            area = 8 * c_o * inner / (square * square) * rho * w * n.cosh(t) * length * (1 - x) * turn
            return lift * cos_phi - s_o, lift * sin_phi, c_o * gap * (rho + 1 / edge) / square, area

        return point

    return Chart("slopes", azimuth)


def turned_chart(chart: Chart, along: int, up: int) -> Chart:
    """Return a chart turned by half a turn about the normal (``along`` = −1), or mirrored at the surface."""

    def azimuth(n: Numbers, panel: int, s: Any) -> Callable[[Any], Point]:
        inside = chart.azimuth(n, panel, s)

        def point(x: Any) -> Point:
            a, b, z, area = inside(x)
            return along * a, along * b, up * z, area

        return point

    kind = "retro " * (along < 0) + "mirrored " * (up < 0)
    return Chart(kind + chart.name, azimuth, chart.panels, chart.whole)


def refracted_chart(cos_o: float, sin_o: float, eta: float, width: float) -> Chart:
    """Return the stereographic radius of the facet's normal, between the limits of refraction.

    ``eta`` is the index on the other side over that on wo's. The limits are those of
    ``radiokit.measure.refraction``: the facet's front, total reflection, and the horizon.
    """
    beyond = eta < 1 and sin_o > eta
    edges = [0.0, np.pi / 2] if beyond else [0.0, np.pi / 2, np.pi]
    rest = float(np.sqrt(max(0.0, (1 - eta) * (1 + eta))))
    if eta < 1 and sin_o > rest:
        sine = float(np.sqrt((sin_o - rest) * (sin_o + rest)))
        meet = float(np.arcsin(min(1.0, sine / eta)) if beyond else np.arctan2(sine, rest))
        if 0 < meet < np.pi / 2:
            edges.insert(1, meet)
    if beyond:
        scale = float(np.sqrt((sin_o - eta) * (sin_o + eta))) / sin_o
    elif eta < 1:
        scale = float(np.arccosh(eta / sin_o)) if sin_o > 0.1 * eta else 3.0
    else:
        scale = float(np.arctan2(cos_o, sin_o))
    scale = max(scale, 1e-4)

    def azimuth(n: Numbers, panel: int, s: Any) -> Callable[[Any], Point]:
        c_o, s_o, m, half = (n.number(v) for v in (cos_o, sin_o, eta, width / 2))
        least = n.sqrt((1 - m) * (1 + m)) if eta < 1 else n.number(0)
        first, last = (n.asinh((n.number(edge) - n.pi / 2) / scale) for edge in edges[panel : panel + 2])
        v = first + (last - first) * s
        sigma, turn = n.pi / 2 + scale * n.sinh(v), scale * n.cosh(v) * (last - first)
        if beyond:
            cos_sigma = n.cos(sigma)
            cos_phi = n.sqrt((s_o - m) * (s_o + m) + (m * cos_sigma) ** 2) / s_o
            sin_phi = m / s_o * n.sin(sigma)
            turn = turn * (m / s_o) * cos_sigma / cos_phi
        else:
            cos_sigma, cos_phi, sin_phi = None, n.cos(sigma), n.sin(sigma)
        along = s_o * cos_phi
        start = 0 * along
        if beyond:
            margin, root = (s_o - m) * (s_o + m), m * cos_sigma
            steep, near = margin / ((along + root) * c_o), margin / ((along + root) * (c_o + least))
            start = steep / (1 + n.sqrt(1 + steep * steep))
            far = (along + root) / (c_o + least)
        else:
            margin = (m - s_o) * (m + s_o) if eta < 1 else c_o * c_o
            both = abs(along) + n.sqrt(along * along + margin)
            less, more = margin / (both * (c_o + least)), both / (c_o + least)
            near, far = -n.pick(along < 0, more, less), n.pick(along < 0, less, more)
        end = n.least(far, 0 * far + 1)
        low, high = n.asinh(start / half), n.asinh(end / half)
        span = n.most(high - low, 0 * high)

        def point(x: Any) -> Point:
            t = low + span * x * (2 - x)
            q = half * n.sinh(t)
            gap = 2 * half * n.cosh((high + t) / 2) * n.sinh(span * (1 - x) ** 2 / 2) + (far - end)
            square = 1 + q * q
            over = (c_o + least) * gap * n.most(q - near, 0 * q) / square
            cos_h = least + over
            bent = n.sqrt(cos_h * cos_h + (m - 1) * (m + 1)) if eta > 1 else n.sqrt(over * (over + 2 * least))
            kappa = (1 - m) * (1 + m) / (cos_h + bent)
            tilt, lift = 2 * q / square, (1 - q) * (1 + q) / square
            area = kappa * kappa / (m * bent) * 8 * q / (square * square) * half * n.cosh(t) * span * (1 - x)
            return (
                (kappa * tilt * cos_phi - s_o) / m,
                kappa * tilt * sin_phi / m,
                (kappa * lift - c_o) / m,
                area * turn,
            )

        return point

    return Chart("refraction", azimuth, len(edges) - 1, whole=False)
