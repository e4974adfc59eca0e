"""Samplers of normals: their densities integrate to 1, and they draw what their densities say."""

from __future__ import annotations

import numpy as np
import pytest

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.measure.kernels import kernel
from radiokit.measure.passes import run
from radiokit.measure.special import erfcx
from radiokit.measure.statistics import chi_square, sidak
from radiokit.physics.facet import reflect, reflection_jacobian
from radiokit.physics.masking import (
    correlated_over_cosines,
    correlated_ratio,
    groove_over_cosines,
    groove_ratio,
)
from radiokit.physics.ndf import (
    beckmann_area,
    beckmann_density,
    beckmann_normal,
    ggx_area,
    ggx_density,
    ggx_hidden,
    ggx_normal,
)
from radiokit.physics.visible import (
    beckmann_slope,
    beckmann_visible,
    ggx_visible,
    groove_reflected_density,
    groove_visible,
    groove_visible_density,
    reflected_density,
    visible_density,
)

LEVEL = 1e-6
WIDTHS = ((0.4, 0.4), (0.7, 0.1), (1e-3, 1e-3), (1e-3, 1.0))
VIEWS = (0.0, 30.0, 80.0, 89.99)
both = pytest.mark.parametrize("mode", ["plain", "compiled"])


def along(o, h):
    return np.tensordot(o, h, axes=1)


def view(theta_deg):
    return spherical_to_cartesian(np.radians(theta_deg), 0.7)


@kernel
def ggx_groove(u0, u1, u2, ox, oy, oz, x, y):
    hx, hy, hz = ggx_normal(u0, u1, x, y)
    return groove_visible(u2, ox, oy, oz, hx, hy, hz)


@kernel
def beckmann_groove(u0, u1, u2, ox, oy, oz, x, y):
    hx, hy, hz = beckmann_normal(u0, u1, x, y)
    return groove_visible(u2, ox, oy, oz, hx, hy, hz)


@kernel
def wider(u0, u1, ox, oy, oz, x, y):
    """Planted: slopes 3 % too steep."""
    hx, hy, hz = beckmann_visible(u0, u1, ox, oy, oz, x, y)
    return 1.03 * hx, 1.03 * hy, hz


@kernel
def one_facet(u0, u1, u2, ox, oy, oz, x, y):
    """Planted: a V-groove of which the first facet is always seen."""
    return ggx_normal(u0, u1, x, y)


def smith(density, area):
    def pdf(h, o, x, y):
        return visible_density(density(*h, x, y), along(o, h), area(*o, x, y))

    return pdf


def groove(density):
    def pdf(h, o, x, y):
        return groove_visible_density(density(*h, x, y), o[2], h[2], along(o, h))

    return pdf


LAWS = {
    "ggx": (ggx_visible, smith(ggx_density, ggx_area)),
    "beckmann": (beckmann_visible, smith(beckmann_density, beckmann_area)),
    "ggx-groove": (ggx_groove, groove(ggx_density)),
    "beckmann-groove": (beckmann_groove, groove(beckmann_density)),
}
laws = pytest.mark.parametrize("law", LAWS)
widths = pytest.mark.parametrize("width", WIDTHS, ids=str)


def axes(o, x, y):
    """Return the unit vector towards the viewer among the slopes over their widths, and where they end."""
    across = np.hypot(x * o[0], y * o[1])
    if across == 0:
        return (1.0, 0.0), np.inf
    return (x * o[0] / across, y * o[1] / across), o[2] / across


def slope_pdf(law, t, q, o, x, y):
    """Return the density of the slopes over their widths, t towards the viewer and q across."""
    (a, b), _ = axes(o, x, y)
    h = np.array([x * (t * a - q * b), y * (t * b + q * a), np.ones_like(t)])
    length = np.sqrt(np.sum(h * h, axis=0))
    return LAWS[law][1](h / length, o, x, y) * x * y / length**3


def nodes(edges, n):
    """Return Gauss points and weights (cells, n) between the edges, of the line mapped by x/(1 − x²)."""
    z, w = np.polynomial.legendre.leggauss(n)
    low, high = edges[:-1, None], edges[1:, None]
    x = 0.5 * (low + high) + 0.5 * (high - low) * z
    slope = x / ((1 - x) * (1 + x))
    return slope, 0.5 * (high - low) * w * (1 + x * x) / ((1 - x) * (1 + x)) ** 2


def compress(slope):
    return 2 * slope / (1 + np.sqrt(1 + 4 * slope * slope))


def cells(end, count):
    """Return edges in the compressed line, the kinks at −end and end among them."""
    edges = np.linspace(-1, 1, count + 1)
    kinks = [compress(s) for s in (-end, end) if abs(s) < 1e6]
    edges = np.sort(np.concatenate([edges, kinks]))
    return edges[np.concatenate([[True], np.diff(edges) > 1e-9])]


def probabilities(law, o, x, y, count, n):
    """Return the probabilities of cells of slopes t and q/√(1 + t²), and the cells' edges."""
    _, end = axes(o, x, y)
    rows, columns = cells(end, count), np.linspace(-1, 1, count + 1)
    (t, wt), (p, wp) = nodes(rows, n), nodes(columns, n)
    root = np.sqrt(1 + t * t)
    density = slope_pdf(law, *np.broadcast_arrays(t[:, :, None, None], np.multiply.outer(root, p)), o, x, y)
    return np.einsum("aibj,ai,bj->ab", density, wt * root, wp), rows, columns


@laws
@widths
@pytest.mark.parametrize("theta", VIEWS)
def test_a_density_of_visible_normals_integrates_to_1(law, width, theta):
    """For Smith's: that the visible facets' area is σ; for the V-groove's: that cosθ is what it conserves."""
    found, *_ = probabilities(law, view(theta), *width, 24, 12)
    assert found.sum() == pytest.approx(1, rel=1e-8)


@pytest.mark.parametrize("density", [ggx_density, beckmann_density], ids=["ggx", "beckmann"])
@widths
def test_the_facets_cover_the_surface_once(density, width):
    """∫ D cosθ dω = 1."""
    x, y = width
    r, weight = (v.ravel() for v in nodes(np.linspace(0, 1, 17), 12))
    phi = np.arange(32)[:, None] * np.pi / 16
    h = np.array([x * r * np.cos(phi), y * r * np.sin(phi), np.ones((32, len(r)))])
    length2 = np.sum(h * h, axis=0)
    found = np.mean(density(*h, x, y) * x * y * r / length2**2 @ weight) * 2 * np.pi
    assert found == pytest.approx(1, rel=1e-12)


def draw(sampler, u, o, x, y, mode):
    u = u[:, :3] if sampler in (ggx_groove, beckmann_groove, one_facet) else u[:, :2]
    constants = (*map(float, o), x, y)
    if mode == "compiled":
        return np.array(run(sampler, tuple(u.T), constants, compiled=True))
    return np.array(sampler(*u.T, *constants))


def p_value(law, sampler, o, x, y, rng, mode="compiled", samples=1 << 16):
    expected, rows, columns = probabilities(law, o, x, y, 16, 6)
    h = draw(sampler, rng.random((samples, 3)), o, x, y, mode)
    assert np.isfinite(h).all()
    assert (h[2] > 0).all()
    (a, b), _ = axes(o, x, y)
    s, r = h[0] / (x * h[2]), h[1] / (y * h[2])
    t, q = a * s + b * r, a * r - b * s
    p = compress(q / np.sqrt(1 + t * t))
    counts = np.histogram2d(compress(t), p, bins=(rows, columns))[0]
    return chi_square(counts, samples * expected).p_value


@laws
def test_samplers_follow_their_densities(law, rng):
    cases = [(theta, width) for theta in VIEWS for width in WIDTHS]
    sampler, _ = LAWS[law]
    found = [p_value(law, sampler, view(theta), *width, rng) for theta, width in cases]
    assert min(found) > sidak(LEVEL, len(cases) * len(LAWS))


def test_wrong_samplers_are_rejected(rng):
    assert p_value("beckmann", wider, view(30.0), 0.4, 0.4, rng) < LEVEL
    assert p_value("ggx-groove", one_facet, view(80.0), 0.4, 0.4, rng) < LEVEL
    assert p_value("ggx", beckmann_visible, view(30.0), 0.4, 0.4, rng) < LEVEL


@laws
def test_both_forms_of_a_sampler_agree(law, rng):
    ends = np.array([0.0, 2.0**-53, 0.25, 0.5, 1 - 2.0**-30, 1 - 2.0**-53])
    u = np.concatenate(
        [np.stack(np.meshgrid(ends, ends, ends), axis=-1).reshape(-1, 3), rng.random((300, 3))]
    )
    for theta in (0.0, 1e-7, 60.0, 89.9999):
        for width in WIDTHS:
            plain, compiled = (draw(LAWS[law][0], u, view(theta), *width, m) for m in ("plain", "compiled"))
            assert np.isfinite(plain).all()
            assert (along(view(theta), plain) > -1e-15 * np.linalg.norm(plain, axis=0)).all()
            scale = np.max(np.abs(plain / np.array([*width, 1.0])[:, None]), axis=0)
            off = np.abs(plain - compiled) / np.array([*width, 1.0])[:, None] / scale
            # Next to the slopes' end, a slope is as uncertain as the root of what u is rounded by.
            assert np.max(off[:, u[:, 0] > 1e-9]) < 1e-11


def share(t, sine, cosine):
    """Return the shares of visible slopes below and above t, each accurate where it is the smaller."""
    root, ratio = np.sqrt(np.pi), erfcx(np.abs(t))
    end = cosine / sine if sine else np.inf
    bell = np.exp(-end * end)
    hidden = 0.5 * bell * (sine / root - cosine * erfcx(end)) if sine else 0.0
    tail = 0.5 * np.exp(-t * t)
    above, below = tail * (sine / root + cosine * ratio), hidden - tail * (sine / root - cosine * ratio)
    area = cosine + hidden
    return np.where(t >= 0, 1 - above / area, below / area), np.where(t >= 0, above / area, 1 - below / area)


@both
def test_the_slopes_distribution_is_inverted_to_rounding(mode, rng):
    tails = np.concatenate([2.0 ** -np.arange(1, 30.0), 10 ** rng.uniform(-9, 0, 500)])
    u = np.sort(
        np.concatenate([tails, 1 - tails, 1 - 2.0 ** -np.arange(30, 54.0), np.linspace(0.001, 0.999, 999)])
    )
    grazing = [np.radians(0.01) / alpha for alpha in (1e-3, 1e-4, 1.0)]
    for cotangent in (*grazing, 0.0, 1e-9, 0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 99.0, 101.0, 1e9):
        sine, cosine = 1 / np.hypot(1, cotangent), cotangent / np.hypot(1, cotangent)
        t = beckmann_slope(u, sine, cosine)
        if mode == "compiled":
            t = run(beckmann_slope, (u, sine, cosine), compiled=True)
        below, above = share(t, sine, cosine)
        assert np.max(np.abs(below - u)) < 2e-15
        upper = u > 0.5
        assert np.max(np.abs(above / (1 - u) - 1)[upper]) < 3e-14
        assert (np.diff(t) >= 0).all()
        assert (t >= -cotangent * (1 + 1e-15)).all()
    upright = beckmann_slope(u, 0.0, 1.0)
    np.testing.assert_allclose(share(upright, 0.0, 1.0)[0], u, atol=2e-15)


def test_a_slope_of_three_steps_less_is_rejected():
    """Planted: the start, not improved."""
    space = beckmann_slope.function.__globals__
    u = np.linspace(0.001, 0.999, 99)
    sine, cosine = 0.6, 0.8
    hidden = 0.5 * np.exp(-((cosine / sine) ** 2)) * (sine / np.sqrt(np.pi) - cosine * erfcx(cosine / sine))
    start = space["_start"](u, 1 - u, sine, cosine, cosine / sine, hidden)
    assert 1e-4 < np.max(np.abs(share(start, sine, cosine)[0] - u)) < 0.2


@pytest.mark.parametrize("theta", [0.0, 40.0, 85.0])
def test_a_weight_is_the_value_over_the_density(theta, rng):
    """F = 1: G₂/G₁ of a sample is D G₂/(4 cosθi cosθo) · cosθi over the density of its direction."""
    o, (x, y) = view(theta), (0.4, 0.15)
    for law in LAWS:
        h = draw(LAWS[law][0], rng.random((300, 3)), o, x, y, "plain")
        i = np.array(reflect(*o, *h))
        lit = i[2] > 0.01
        i, h = i[:, lit], h[:, lit]
        o_h, length = along(o, h), np.linalg.norm(h, axis=0)
        density, area = (
            (ggx_density, ggx_area) if law.startswith("ggx") else (beckmann_density, beckmann_area)
        )
        d = density(*h, x, y)
        if law.endswith("groove"):
            pdf = groove_reflected_density(d, o[2], h[2], o_h)
            value = d * groove_over_cosines(i[2], o[2], h[2], o_h, o_h)
            weight = groove_ratio(i[2], o[2], h[2], o_h, o_h)
        else:
            pdf = reflected_density(d, area(*o, x, y))
            value = d * correlated_over_cosines(i[2], o[2], area(*i, x, y), area(*o, x, y))
            weight = correlated_ratio(i[2], o[2], area(*i, x, y), area(*o, x, y))
        np.testing.assert_allclose(value * i[2] / pdf, weight, rtol=1e-12)
        spread = LAWS[law][1](h / length, o, x, y) * reflection_jacobian(o_h, length)
        np.testing.assert_allclose(pdf, spread, rtol=1e-12)
        assert (weight <= 1 + 1e-12).all()


def test_facets_face_or_hide():
    """σ(w) − σ(−w) = cosθ, and σ(w) = ∫ max(w·m, 0) D(m) dm for a normal made by the other sampler."""
    o = view(70.0)
    assert ggx_area(*o, 0.3, 0.6) - ggx_hidden(*o, 0.3, 0.6) == pytest.approx(o[2], rel=1e-14)
    u = (np.arange(2000) + 0.5) / 2000
    u0, u1 = (v.ravel() for v in np.meshgrid(u, u[::10]))
    for normal, area in ((ggx_normal, ggx_area), (beckmann_normal, beckmann_area)):
        h = np.array(normal(u0, u1, 0.3, 0.6))
        found = np.mean(np.maximum(along(o, h), 0) / h[2])  # D cosθ is what the normals have
        assert found == pytest.approx(area(*o, 0.3, 0.6), rel=2e-2 if normal is ggx_normal else 1e-3)
