"""Warps: samples in narrow cones, at the rim of the hemisphere, and at a lobe's horizon."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.stability.row import Row, decades
from radiokit.facts.source import Source
from radiokit.measure.slope import slope_map
from radiokit.measure.twin import Twin
from radiokit.measure.warps import CosineHemisphere, UniformCone

__all__ = ["ROWS"]

_SLOPE = Source(
    authors="The radiokit developers",
    year=2026,
    title="radiokit",
    equation="the horizon in slope space, in the docstring of radiokit.measure.slope.slope_map",
)


def _cone(half_angle: Any, u: Any) -> Any:
    return np.array(
        [
            UniformCone(half_angle=float(h)).sample([[v, 0.0]])[0, 0]
            for h, v in zip(half_angle, u, strict=True)
        ]
    )


def _cone_textbook(m: Any, half_angle: Any, u: Any) -> Any:
    cosine = 1 - u * (1 - m.cos(half_angle))
    return m.sqrt(1 - cosine * cosine)


def _cone_twin() -> Twin:
    import sympy

    h, u = symbols = sympy.symbols("h u", positive=True)
    return Twin(sympy.sin(2 * sympy.asin(sympy.sqrt(u) * sympy.sin(h / 2))), {}, symbols)


def _share(half_angle: Any, x: Any, z: Any) -> Any:
    points = np.stack((x, 0.0 * x, z), axis=-1)
    return np.array(
        [UniformCone(half_angle=float(h)).invert(points[i : i + 1])[0, 0] for i, h in enumerate(half_angle)]
    )


def _share_textbook(m: Any, half_angle: Any, x: Any, z: Any) -> Any:
    return (1 - z / m.sqrt(x * x + z * z)) / (1 - m.cos(half_angle))


def _share_twin() -> Twin:
    import sympy

    h, x, z = symbols = sympy.symbols("h x z", positive=True)
    return Twin((sympy.sin(sympy.atan2(x, z) / 2) / sympy.sin(h / 2)) ** 2, {}, symbols)


def _rim_textbook(m: Any, u: Any) -> Any:
    radius = 1 - 2 * u
    return m.sqrt(1 - radius * radius)


def _rim_twin() -> Twin:
    import sympy

    u = sympy.Symbol("u", positive=True)
    return Twin(2 * sympy.sqrt(u * (1 - u)), {}, (u,))


def _slope(x: Any, s: Any, width: Any, sine: Any, cosine: Any) -> Any:
    return slope_map(np.stack((sine, 0.0 * sine, cosine), axis=-1), width, x, s)[0][..., 2]


def _slope_textbook(m: Any, x: Any, s: Any, width: Any, sine: Any, cosine: Any) -> Any:
    tangent = sine / cosine
    y = m.asinh(tangent) * m.cos(m.pi * s)
    rho = width * m.sinh(m.asinh(m.exp(y) / width) * (x * (2 - x)))
    length = m.sqrt(1 + rho * rho)
    inner = (sine * rho * m.sinh(y) / tangent + cosine) / length
    return 2 * inner / length - cosine


def _slope_twin() -> Twin:
    import sympy

    x, s, width, sine, cosine = symbols = sympy.symbols("x s w S C", positive=True)
    y = sympy.asinh(sine / cosine) * sympy.cos(sympy.pi * s)
    rho = width * sympy.sinh(sympy.asinh(sympy.exp(y) / width) * (1 - (1 - x) ** 2))
    height = cosine * (sympy.exp(y) - rho) * (rho + sympy.exp(-y)) / (1 + rho**2)
    return Twin(height, {}, symbols)


ROWS = (
    Row(
        name="cone-sample",
        title="Uniform sample of a narrow cone",
        axis="half-angle [rad]",
        values=decades(0, -15),
        inputs=lambda h: (h, np.array([0.25, 0.875])),
        kernel=_cone,
        textbook=_cone_textbook,
        twin=_cone_twin,
        kernel_name="radiokit.measure.warps.UniformCone.sample",
        kernel_form="d = 2 sin²(θ/2) u, radius √(d (2(1 − u) + 2 cos²(θ/2) u))",
        textbook_form="c = 1 − u (1 − cos θ), radius √(1 − c²)",
        lesson="The cosine of a sample in a narrow cone is 1 up to rounding: samples sit on a few rings √ε "
        "apart, and below θ = 10⁻⁸ all of them on the axis, so that a distant lamp has no size. "
        "Keeping the depth 1 − c, instead of c, keeps every digit of the radius.",
        source=UniformCone.SOURCE,
    ),
    Row(
        name="cone-invert",
        title="From a direction in a narrow cone back to its random number",
        axis="half-angle [rad]",
        values=decades(0, -15),
        inputs=lambda h: (h, np.sin(0.5 * h), np.cos(0.5 * h)),
        kernel=_share,
        textbook=_share_textbook,
        twin=_share_twin,
        kernel_name="radiokit.measure.warps.UniformCone.invert",
        kernel_form="(x² + y²) / (1 + z) / (2 sin²(θ/2))",
        textbook_form="(1 − z) / (1 − cos θ)",
        lesson="Two differences, both made of rounding, and in the end 0/0: a test of the sampler by its "
        "inverse would test noise. 1 − z is (x² + y²)/(1 + z), where nothing cancels.",
        source=UniformCone.SOURCE,
    ),
    Row(
        name="cosine-sample-rim",
        title="Cosine-weighted sample near the horizon",
        axis="u, from the rim [1]",
        values=decades(-1, -15),
        inputs=lambda u: (u,),
        kernel=lambda u: CosineHemisphere().sample(np.stack((u, np.full_like(u, 0.5)), axis=-1))[..., 2],
        textbook=_rim_textbook,
        twin=_rim_twin,
        kernel_name="radiokit.measure.warps.CosineHemisphere.sample",
        kernel_form="√(d (2 − d)) with the distance d = 2 min(u, 1 − u) from the rim",
        textbook_form="√(1 − r²) with r = 1 − 2u",
        lesson="Lifting the disk to the hemisphere by √(1 − x² − y²) asks how far r is from 1 after r was "
        "rounded. In float32 such samples land on z = 0, where their density is 0 and their weight "
        "0/0. The distance from the rim is known exactly: it is u.",
        source=CosineHemisphere.SOURCE,
    ),
    Row(
        name="slope-node-horizon",
        title="A quadrature node just above the horizon",
        axis="1 − x, from the horizon [1]",
        values=tuple(2.0**-k for k in range(2, 24, 2)),
        inputs=lambda d: (1.0 - d, 0.25, 0.25, 0.6, 0.8),
        kernel=_slope,
        textbook=_slope_textbook,
        twin=_slope_twin,
        kernel_name="radiokit.measure.slope.slope_map",
        kernel_form="cosθo (e^y − ρ)(ρ + e^−y)/(1 + ρ²), the gap e^y − ρ as one sinh",
        textbook_form="2 (wo·h) h_z − cosθo",
        lesson="Reflecting at h gives the height as a difference of two cosines that agree at the horizon. "
        "There the height is quadratic in the distance, so twice as many digits go as the problem "
        "itself loses. Factorised, the height is a product, and its one small factor is computed as "
        "what it is.",
        source=_SLOPE,
    ),
)
