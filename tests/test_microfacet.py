"""The kernels of microfacets against the papers' formulas at 50 digits, at inputs that are hard."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
import sympy

from radiokit.facts.directions import spherical_to_cartesian
from radiokit.measure.kernels import Kernel, kernel
from radiokit.measure.twin import DIRECTION_SYMBOLS, Twin, scaled_ulps
from radiokit.physics import microfacet as paper
from radiokit.physics.facet import reflect, refract, refraction_half, refraction_jacobian, refraction_share
from radiokit.physics.masking import (
    correlated_over_cosines,
    correlated_ratio,
    groove_masking,
    groove_over_cosines,
    groove_ratio,
    masking,
    separable_over_cosines,
    separable_ratio,
)
from radiokit.physics.ndf import (
    beckmann_area,
    beckmann_density,
    beckmann_hidden,
    ggx_area,
    ggx_area_isotropic,
    ggx_density,
    ggx_hidden,
)

X, Y = sympy.symbols("alpha_x alpha_y", positive=True)
ETA = sympy.Symbol("eta", positive=True)
WI, WO = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:]
HALF = [i + o for i, o in zip(WI, WO, strict=True)]
LIMIT = 4

WIDTHS = ((0.5, 0.5), (0.3, 0.05), (1.0, 1.0), (1e-3, 1.0), (1e-4, 1e-4))
ANGLES = (
    (0.0, 0.0),
    (1e-9, 1e-9),
    (30.0, 30.0),
    (20.0, 70.0),
    (85.0, 1.0),
    (89.9999, 89.9999),
    (89.9999, 0.1),
)


def direction(theta_deg, phi):
    return tuple(float(x) for x in spherical_to_cartesian(np.radians(theta_deg), phi))


def pairs():
    """Return pairs of directions: the mirror's, nearly the mirror's, and others."""
    for theta_i, theta_o in ANGLES:
        for turn in (np.pi, np.pi + 1e-6, 2.0):
            yield direction(theta_i, 0.4 + turn), direction(theta_o, 0.4)


def values(function: Kernel, mode: str, inputs: Any) -> np.ndarray:
    """Return a kernel's tuples for the inputs: (inputs, outputs)."""
    if mode == "plain":
        return np.stack(np.broadcast_arrays(*function(*np.array(inputs).T)), axis=-1)
    return np.array([function.compiled(*map(float, row)) for row in inputs])


def errors(found: np.ndarray, twins: list[Twin], inputs: Any) -> np.ndarray:
    """Return the errors in ulps over max(1, condition): (inputs, outputs)."""
    return np.array(
        [
            [
                scaled_ulps(value, twin.at(*row), twin.condition_at(*row))
                for value, twin in zip(line, twins, strict=True)
            ]
            for line, row in zip(found, inputs, strict=True)
        ]
    )


def both_forms(function: Kernel, twins: list[Twin], inputs: Any) -> None:
    """Compare both forms of a kernel with the twins, computing the twins once."""
    plain, compiled = values(function, "plain", inputs), values(function, "compiled", inputs)
    assert np.isfinite(plain).all()
    assert np.isfinite(compiled).all()
    worst = errors(plain, twins, inputs).max(axis=0)
    assert (worst <= LIMIT).all(), worst
    # Where the forms differ, the compiled one is judged by the twin too.
    differ = [i for i in range(len(inputs)) if np.any(np.abs(plain[i] - compiled[i]) > np.spacing(plain[i]))]
    if differ:
        worst = errors(compiled[differ], twins, [inputs[i] for i in differ]).max(axis=0)
        assert (worst <= LIMIT).all(), worst


@kernel
def ggx_laws(ix, iy, iz, ox, oy, oz, x, y):
    area_i, area_o = ggx_area(ix, iy, iz, x, y), ggx_area(ox, oy, oz, x, y)
    return (
        ggx_density(ix + ox, iy + oy, iz + oz, x, y),
        area_o,
        ggx_hidden(ox, oy, oz, x, y),
        masking(oz, area_o),
        correlated_over_cosines(iz, oz, area_i, area_o),
        correlated_ratio(iz, oz, area_i, area_o),
        separable_over_cosines(iz, oz, area_i, area_o),
        separable_ratio(iz, oz, area_i, area_o),
    )


@kernel
def beckmann_laws(ix, iy, iz, ox, oy, oz, x, y):
    area_i, area_o = beckmann_area(ix, iy, iz, x, y), beckmann_area(ox, oy, oz, x, y)
    return (
        beckmann_density(ix + ox, iy + oy, iz + oz, x, y),
        area_o,
        beckmann_hidden(ox, oy, oz, x, y),
        masking(oz, area_o),
        correlated_over_cosines(iz, oz, area_i, area_o),
        correlated_ratio(iz, oz, area_i, area_o),
        separable_over_cosines(iz, oz, area_i, area_o),
        separable_ratio(iz, oz, area_i, area_o),
    )


@kernel
def groove_laws(ix, iy, iz, ox, oy, oz):
    hx, hy, hz = ix + ox, iy + oy, iz + oz
    i_h, o_h = ix * hx + iy * hy + iz * hz, ox * hx + oy * hy + oz * hz
    return (
        groove_masking(oz, hz, o_h),
        groove_over_cosines(iz, oz, hz, i_h, o_h),
        groove_ratio(iz, oz, hz, i_h, o_h),
    )


def law_twins(density, smith, arguments):
    i, o = smith(WI, X, Y), smith(WO, X, Y)
    correlated, separable = paper.correlated_symbolic(i, o), paper.separable_symbolic(i, o)
    four, masked = 4 * WI[2] * WO[2], paper.masking_symbolic(o)
    found = (
        density(HALF, X, Y),
        WO[2] * (1 + o),
        WO[2] * o,
        masked,
        correlated / four,
        correlated / masked,
        separable / four,
        separable / masked,
    )
    return [Twin(expression, {}, arguments) for expression in found]


ARGUMENTS = (*DIRECTION_SYMBOLS, X, Y)
GGX = law_twins(paper.ggx_d_symbolic, paper.ggx_lambda_symbolic, ARGUMENTS)
BECKMANN = law_twins(paper.beckmann_d_symbolic, paper.beckmann_lambda_symbolic, ARGUMENTS)


def law_inputs():
    """Return directions and widths; straight up, where Λ is 0/0 in the paper, is tested by itself."""
    return [(*i, *o, *w) for (i, o), w in itertools.product(pairs(), WIDTHS) if o[0] or o[1]]


def test_ggx_agrees_with_the_papers():
    both_forms(ggx_laws, GGX, law_inputs())


def test_beckmann_agrees_with_the_papers():
    both_forms(beckmann_laws, BECKMANN, law_inputs()[::2])


def test_the_groove_agrees_with_the_paper():
    g_i, g_o = paper.groove_symbolic(HALF, WI), paper.groove_symbolic(HALF, WO)
    both = paper.groove_symbolic(HALF, WI, WO)
    # The paper's cosines are those of unit vectors, the kernel's are z: with unit vectors the same.
    found = (g_o, both / (4 * WI[2] * WO[2]), sympy.Min(g_i, g_o) / g_o)
    twins = [Twin(expression, {}, DIRECTION_SYMBOLS) for expression in found]
    both_forms(groove_laws, twins, [(*i, *o) for i, o in pairs()])


@pytest.mark.parametrize(
    ("laws", "area_at_the_horizon"),
    [(ggx_laws, 0.1), (beckmann_laws, 0.1 / np.sqrt(np.pi))],
    ids=["ggx", "beckmann"],
)
def test_the_pole_and_the_horizon(laws, area_at_the_horizon):
    up, along = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
    density, area, hidden, *rest = laws(*up, *up, 0.2, 0.1)
    assert density == pytest.approx(1 / (0.02 * np.pi), rel=1e-15)
    assert (area, hidden) == (1, 0)
    assert rest == pytest.approx([1, 0.25, 1, 0.25, 1], rel=1e-15)
    for function in (laws, laws.compiled):
        found = np.array(function(*along, *along, 0.2, 0.1))
        assert np.isfinite(found).all()
        assert (found[3:] == 0).all()
        assert found[1] == pytest.approx(found[2], rel=1e-15) == pytest.approx(area_at_the_horizon, rel=1e-15)
        assert np.isfinite(function(*up, *(-x for x in up), 0.2, 0.1)).all()
        assert function(-0.6, 0.0, 0.8, 0.6, 0.0, -0.8, 0.2, 0.1)[0] == 0


def test_one_width_needs_the_cosine_alone():
    z, alpha = sympy.symbols("z alpha", positive=True)
    smith = (sympy.sqrt(1 + alpha**2 * (1 - z**2) / z**2) - 1) / 2
    twin = Twin(z * (1 + smith), {}, (z, alpha))
    inputs = [(c, a) for c in (1.0, 1 - 2.0**-53, 0.5, 1.7e-6) for a in (1.0, 0.3, 1e-3, 1e-4)]
    both_forms(isotropic, [twin], inputs)


@kernel
def isotropic(z, alpha):
    return (ggx_area_isotropic(z, alpha),)


def test_far_tails_vanish_quietly():
    h = np.array([1.0, 1.0, 1e-3, 1.0])
    found = beckmann_density(h, 0.0 * h, np.array([1e-3, 0.0, 1e-160, 5e-324]), 1e-4, 1e-4)
    assert found.tolist() == [0, 0, 0, 0]
    rough = beckmann_density(1.0, 0.0, 0.04, 1.0, 1.0)
    assert 0 < rough < 1e-250


@kernel
def textbook_d(ix, iy, iz, ox, oy, oz, x, y):
    """Planted: the cosine's form of D."""
    hx, hy, hz = ix + ox, iy + oy, iz + oz
    c2, a2 = hz * hz / (hx * hx + hy * hy + hz * hz), x * x
    root = (a2 - 1) * c2 + 1
    return (a2 / (np.pi * root * root),)


@kernel
def textbook_smith(ix, iy, iz, ox, oy, oz, x, y):
    """Planted: Λ as a root less 1."""
    return (oz * 0.5 * (np.sqrt(1 + (x * x * ox * ox + y * y * oy * oy) / (oz * oz)) - 1),)


def test_textbook_forms_are_rejected():
    from scipy.special import erf

    inputs = [(*i, *o, 1e-4, 1e-4) for i, o in pairs() if 0.1 < o[2] < 0.999]
    for planted, twin in ((textbook_d, GGX[0]), (textbook_smith, GGX[2])):
        assert errors(values(planted, "plain", inputs), [twin], inputs).max() > LIMIT
    row = (*direction(60.0, 1.0), *direction(60.0, 0.4), 0.15, 0.15)
    a = row[5] / (0.15 * np.hypot(row[3], row[4]))
    planted = row[5] * (0.5 * (erf(a) - 1) + np.exp(-a * a) / (2 * a * np.sqrt(np.pi)))
    assert errors(np.array([[planted]]), [BECKMANN[2]], [row]).max() > LIMIT


# Facets

RATIOS = (1.5, 1 / 1.5, 2.4, 1 + 1e-12, 1 - 1e-9, 0.3)


@kernel
def window(ix, iy, iz, ox, oy, oz, eta):
    hx, hy, hz = refraction_half(ix, iy, iz, ox, oy, oz, eta)
    i_h, o_h = ix * hx + iy * hy + iz * hz, ox * hx + oy * hy + oz * hz
    length2 = hx * hx + hy * hy + hz * hz
    return hx, hy, hz, refraction_share(i_h, o_h, length2), refraction_jacobian(i_h, length2, eta)


@kernel
def bent(ox, oy, oz, hx, hy, hz, eta):
    return refract(ox, oy, oz, hx, hy, hz, eta)


def crossing():
    """Return directions on both sides of a window, and its index: by Snell's law about a tilted facet."""
    for eta, theta, tilt in itertools.product(RATIOS, (0.0, 1e-9, 35.0, 80.0), (0.0, 3e-7, 20.0)):
        o, h = direction(theta, 0.4), direction(tilt, 1.3)
        *i, cosine = refract(*o, *h, eta)
        if cosine > 0.01 and i[2] < 0 and sum(a * b for a, b in zip(o, h, strict=True)) > 0.01:
            yield tuple(float(x) for x in i), o, eta


def test_windows_agree_with_the_paper():
    arguments = (*DIRECTION_SYMBOLS, ETA)
    h = paper.refraction_half_symbolic(WI, WO, ETA)
    side = sympy.sign(h[2])
    length2 = paper.dot_symbolic(h, h)
    i_h, o_h = (sympy.Abs(paper.dot_symbolic(w, h)) / sympy.sqrt(length2) for w in (WI, WO))
    jacobian = paper.refraction_jacobian_symbolic(WI, WO, ETA)
    expressions = (side * h[0], side * h[1], side * h[2], i_h * o_h / length2, jacobian)
    twins = [Twin(expression, {}, arguments) for expression in expressions]
    inputs = [(*i, *o, eta) for i, o, eta in crossing()]
    assert len(inputs) > 40
    # The paper's Jacobian divides by o·h + η i·h, which equals |o + η i| for its own h only.
    both_forms(window, twins, inputs)


def test_refracted_directions_agree_with_the_paper():
    h = sympy.symbols("h_x h_y h_z", real=True)
    arguments = (*WO, *h, ETA)
    w = paper.refract_symbolic(WO, h, ETA)
    cosine = -paper.dot_symbolic(w, h) / sympy.sqrt(paper.dot_symbolic(h, h))
    twins = [Twin(expression, {}, arguments) for expression in (*w, cosine)]
    critical = np.degrees(np.arcsin(1 / 1.5))
    inputs = [
        (*direction(theta, 0.4), *(2.5 * x for x in direction(tilt, 1.3)), eta)
        for eta, theta, tilt in itertools.product(RATIOS, (1e-9, 16.0, 35.0, 80.0), (1e-7, 20.0))
        if eta > 1 or theta + tilt < np.degrees(np.arcsin(eta))
    ]
    inputs += [(*direction(critical - d, 0.4), 0.0, 0.0, 1.0, 1 / 1.5) for d in (1e-3, 1e-9, 1e-12)]
    both_forms(bent, twins, inputs)


def test_the_cancelling_refraction_is_rejected():
    """Planted: c/η − cosθt as a difference, for an index near 1."""
    h = sympy.symbols("h_x h_y h_z", real=True)
    bend = Twin(paper.refract_symbolic(WO, h, ETA)[0] + WO[0] / ETA, {}, (*WO, *h, ETA))
    o, tilt, eta = direction(30.0, 0.4), direction(20.0, 1.3), 1 + 1e-12
    c = float(np.dot(o, tilt))
    planted = (c / eta - np.sqrt(1 - (1 - c * c) / eta**2)) * tilt[0]
    stable = (1 - eta) * (1 + eta) / (eta * (c + np.sqrt(eta * eta - (1 - c * c)))) * tilt[0]
    row = [(*o, *tilt, eta)]
    weighed = errors(np.array([[planted]]), [bend], row), errors(np.array([[stable]]), [bend], row)
    assert weighed[1].max() <= LIMIT
    from radiokit.measure.twin import ulps

    assert ulps(planted, bend.at(*row[0])) > 1e3 * (1 + ulps(stable, bend.at(*row[0])))


def test_what_is_refracted_or_reflected_comes_back(rng):
    o = spherical_to_cartesian(np.arccos(rng.random(500)), 7 * rng.random(500)).T
    h = rng.uniform(0.2, 3, 500) * spherical_to_cartesian(rng.random(500), 7 * rng.random(500)).T
    for eta in (1.5, 1 / 1.5, 1 + 1e-9):
        *i, cosine = refract(*o, *h, eta)
        through = (cosine > 0.01) & (i[2] < 0) & (np.sum(o * h, axis=0) > 0)
        i = np.array(i)[:, through]
        np.testing.assert_allclose(np.sum(i * i, axis=0), 1, rtol=1e-14)
        again = np.array(refraction_half(*i, *o[:, through], eta))
        unit = h[:, through] / np.linalg.norm(h[:, through], axis=0)
        noise = 1e-14 / np.linalg.norm(again, axis=0)
        assert (np.abs(again / np.linalg.norm(again, axis=0) - unit) < noise).all()
    back = reflect(*reflect(*o, *h), *h)
    np.testing.assert_allclose(back, o, atol=1e-14)


def test_total_reflection_and_nothing_between():
    *w, cosine = refract(*direction(60.0, 0.0), 0.0, 0.0, 1.0, 1 / 1.5)
    assert cosine == 0
    assert np.isfinite(w).all()
    assert refract(*direction(60.0, 0.0), 0.0, 0.0, 1.0, 1.0)[3] == pytest.approx(0.5, rel=1e-15)
    assert refraction_share(0.5, 0.5, 1.0) == 0
    nowhere = refraction_half(*(-x for x in direction(30.0, 0.4)), *direction(30.0, 0.4), 1.0)
    assert np.all(np.array(nowhere) == 0)
    assert refraction_share(0.0, 0.0, 0.0) == refraction_jacobian(0.0, 0.0, 1.0) == 0
    below = refract(*(-x for x in direction(30.0, 0.4)), 0.0, 0.0, 1.0, 1.5)
    np.testing.assert_allclose(below[2], np.sqrt(1 - 1 / 9), rtol=1e-15)
