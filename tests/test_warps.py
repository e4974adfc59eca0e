"""Warps: sample, pdf and invert agree with one another, with 50 digits, and with counted samples."""

from __future__ import annotations

import itertools

import mpmath
import numpy as np
import pytest

from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.statistics import chi_square, sidak
from radiokit.measure.twin import scaled_ulps
from radiokit.measure.warps import (
    WARPS,
    CosineHemisphere,
    UniformCone,
    UniformDisk,
    UniformHemisphere,
    UniformSphere,
    UniformTriangle,
)

LEVEL = 1e-6  # the chance that any of this file's counts rejects what is right
ULPS = 4.0
CORNERS = [(0, 0, 0), (1, 0, 0), (0.5, 2, 0)]
HARD = {
    "cone of 1e-8": UniformCone(half_angle=1e-8),
    "cone of 1e-150": UniformCone(half_angle=1e-150),
    "cone of 3.1": UniformCone(half_angle=3.1),
    "cone of pi": UniformCone(half_angle=np.pi),
    "sliver": UniformTriangle(vertices=[(0, 0, 0), (1, 0, 0), (0.5, 1e-9, 0)]),
    "triangle of 1e-140": UniformTriangle(vertices=1e-140 * np.array(CORNERS)),
}
ALL = {**WARPS, **HARD}
EDGE = [0.0, 1e-300, 2.0**-53, 1e-9, 0.25, 0.5 - 2.0**-54, 0.5, 0.5 + 2.0**-53, 0.75, 1 - 1e-9, 1 - 2.0**-53]

every = pytest.mark.parametrize("warp", ALL.values(), ids=ALL.keys())
common = pytest.mark.parametrize("warp", WARPS.values(), ids=WARPS.keys())


def size(warp):
    """How large the domain is, to judge an error by."""
    if isinstance(warp, UniformTriangle):
        return np.ptp(warp.vertices, axis=0).max()
    return min(1.0, getattr(warp, "half_angle", 1.0))


# ---------------------------------------------------------------- the three agree


@every
def test_invert_undoes_sample(warp, rng):
    u = rng.random((20_000, 2))
    np.testing.assert_allclose(warp.invert(warp.sample(u)), u, rtol=0, atol=1e-14)


@every
def test_the_square_s_rim_is_harmless(warp):
    points = warp.sample(np.array([*itertools.product([*EDGE, 1.0], repeat=2)]))
    assert np.isfinite(points).all()
    assert (warp.pdf(points) > 0).all()
    assert np.isfinite(warp.pdf(points)).all()
    again = warp.invert(points)
    assert ((again >= 0) & (again < 1)).all()
    # on a seam u is one of several that come to the same point
    points = warp.sample(np.array([*itertools.product(EDGE, repeat=2)]))
    assert np.abs(warp.sample(warp.invert(points)) - points).max() <= 1e-15 * size(warp)


@common
def test_density_times_stretch_is_one(warp, rng):
    """The area that ``sample`` gives to a patch of the square is the reciprocal of the density."""
    assert stretch_error(warp, warp.pdf, rng) < 1e-7


def stretch_error(warp, pdf, rng):
    u, h = rng.uniform(0.01, 0.99, (2000, 2)), 1e-6
    centred = np.abs(2 * u - 1)  # the concentric map and the triangle's have a crease on the diagonals
    u = u[np.abs(centred[:, 0] - centred[:, 1]) > 1e-4]
    first, second = ((warp.sample(u + step) - warp.sample(u - step)) / (2 * h) for step in ([h, 0], [0, h]))
    if first.shape[1] == 2:
        stretch = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    else:
        stretch = np.linalg.norm(np.cross(first, second), axis=-1)
    return np.abs(stretch * pdf(warp.sample(u)) - 1).max()


def test_wrong_densities_are_stretched(rng):
    cosine, cone = WARPS["cosine_hemisphere"], WARPS["uniform_cone"]
    assert stretch_error(cosine, WARPS["uniform_hemisphere"].pdf, rng) > 0.1
    assert stretch_error(cosine, lambda points: cosine.pdf(points) * np.pi, rng) > 0.1
    assert stretch_error(cone, UniformCone(half_angle=0.5001).pdf, rng) > 1e-4


# ---------------------------------------------------------------- the density


def integral(warp, pdf):
    """∫ pdf over a domain larger than the warp's, split where the density may jump."""
    x, w = np.polynomial.legendre.leggauss(32)
    x, w = 0.5 * (x + 1), 0.5 * w
    if isinstance(warp, UniformTriangle):
        a, b, c = warp.vertices
        total = 0.0
        for p, q, r in ((a, b, c), (b, a + 2 * (b - a), c), (2 * a - c, a, b)):  # itself, and two outside
            s, t = (g.ravel() for g in np.meshgrid(x, x))
            points = p + s[:, None] * ((1 - t[:, None]) * (q - p) + t[:, None] * (r - p))
            jacobian = s * np.linalg.norm(np.cross(q - p, r - p))
            total += float(np.sum(pdf(points) * jacobian * np.outer(w, w).ravel()))
        return total
    phi = 2 * np.pi * (np.arange(64) + 0.5) / 64
    if isinstance(warp, UniformDisk):
        radii = [(0, 1), (1, 2)]
        return sum(
            float(
                np.sum(pdf(np.stack((r * np.cos(phi), r * np.sin(phi)), axis=-1))) * r * dr * 2 * np.pi / 64
            )
            for low, high in radii
            for r, dr in zip(low + (high - low) * x, (high - low) * w, strict=True)
        )
    edges = sorted({-1.0, 0.0, float(np.cos(getattr(warp, "half_angle", 0.5))), 1.0})
    total = 0.0
    for low, high in itertools.pairwise(edges):
        z = np.repeat(low + (high - low) * x, 64)
        r, turn = np.sqrt((1 - z) * (1 + z)), np.tile(phi, 32)
        weights = np.repeat((high - low) * w, 64) * 2 * np.pi / 64
        total += float(np.sum(weights * pdf(np.stack((r * np.cos(turn), r * np.sin(turn), z), axis=-1))))
    return total


@common
def test_the_density_integrates_to_one(warp):
    assert abs(integral(warp, warp.pdf) - 1) < 1e-12


@common
def test_densities_that_do_not_integrate_to_one_are_seen(warp):
    assert abs(integral(warp, lambda points: 1.001 * warp.pdf(points)) - 1) > 5e-4
    if not isinstance(warp, UniformSphere):  # a density that forgets its domain
        inside = warp.pdf(warp.sample([[0.3, 0.4]]))[0]
        assert abs(integral(warp, lambda points: np.full(len(points), inside)) - 1) > 0.1


@pytest.mark.parametrize(
    ("warp", "outside"),
    [
        (UniformHemisphere(), (0.6, 0.0, -0.8)),
        (CosineHemisphere(), (0.6, 0.0, -0.8)),
        (UniformCone(half_angle=1e-8), (1.0001e-8, 0.0, 1.0)),
        (UniformCone(half_angle=1.0), (np.sin(1.0001), 0.0, np.cos(1.0001))),
        (UniformCone(half_angle=3.0), (np.sin(3.0001), 0.0, np.cos(3.0001))),
        (UniformDisk(), (0.8, 0.6001)),
        (UniformTriangle(vertices=CORNERS), (-1e-9, 0.0, 0.0)),
        (UniformTriangle(vertices=CORNERS), (0.5, 0.5, 1e-9)),
    ],
)
def test_the_density_is_zero_outside(warp, outside):
    assert warp.pdf(np.array([outside])).tolist() == [0.0]


# ---------------------------------------------------------------- the twins


def cap_twin(height):
    def twin(u0, u1):
        z = 1 - height * u0
        r, phi = mpmath.sqrt(1 - z * z), 2 * mpmath.pi * u1
        return [r * mpmath.cos(phi), r * mpmath.sin(phi), z]

    return twin


def disk_twin(u0, u1):
    a, b = 2 * u0 - 1, 2 * u1 - 1
    if a == b == 0:
        return [mpmath.mpf(0)] * 2
    quarter = mpmath.pi / 4
    r, phi = (a, quarter * b / a) if abs(a) > abs(b) else (b, 2 * quarter - quarter * a / b)
    return [r * mpmath.cos(phi), r * mpmath.sin(phi)]


def cosine_twin(u0, u1):
    x, y = disk_twin(u0, u1)
    return [x, y, mpmath.sqrt(1 - x * x - y * y)]


def triangle_twin(u0, u1):
    b0, b1 = (u0 / 2, u1 - u0 / 2) if u1 > u0 else (u0 - u1 / 2, u1 / 2)
    corners = [[mpmath.mpf(x) for x in row] for row in CORNERS]
    return [b0 * x + b1 * y + (1 - b0 - b1) * z for x, y, z in zip(*corners, strict=True)]


def cone(half_angle):
    return UniformCone(half_angle=half_angle), lambda: cap_twin(1 - mpmath.cos(mpmath.mpf(half_angle)))


TWINS = {
    "sphere": (UniformSphere(), lambda: cap_twin(2)),
    "hemisphere": (UniformHemisphere(), lambda: cap_twin(1)),
    "cosine": (CosineHemisphere(), lambda: cosine_twin),
    "disk": (UniformDisk(), lambda: disk_twin),
    "triangle": (UniformTriangle(vertices=CORNERS), lambda: triangle_twin),
    **{f"cone of {angle}": cone(angle) for angle in (1e-8, 1e-3, 1.0, 3.1)},
}


def twin_error(sample, twin, rng):
    """The worst error of (x, y) and of z, in ulps; z comes from 1 − z, and so has a condition number."""
    u = np.vstack((rng.random((20, 2)), [(1e-15, 0.3), (1e-200, 0.9), (1 - 2**-53, 0.1), (0.5, 0.5)]))
    if sample == TWINS["cosine"][0].sample:
        u = u[(u > 2**-54).all(axis=-1)]  # nearer to the horizon it stays where it is, on purpose
    worst = 0.0
    for (u0, u1), point in zip(u, sample(u), strict=True):
        truth = twin(mpmath.mpf(u0), mpmath.mpf(u1))
        for part in (slice(0, 2), slice(2, None)):
            exact = truth[part]
            if any(exact):
                length = mpmath.sqrt(mpmath.fsum(x * x for x in exact))
                off = [mpmath.mpf(float(v)) - x for v, x in zip(point[part], exact, strict=True)]
                error = mpmath.sqrt(mpmath.fsum(x * x for x in off))
                condition = max(1, abs(1 - truth[-1]) / length) if part.stop is None else 1
                worst = max(worst, float(error / np.spacing(float(length)) / condition))
    return worst


@pytest.mark.parametrize("name", TWINS)
def test_samples_have_a_twin(name, rng):
    warp, twin = TWINS[name]
    with mpmath.workdps(450):  # u of 1e-200 is lost in 1 − u² otherwise
        assert twin_error(warp.sample, twin(), rng) <= ULPS


def test_a_cone_by_its_cosine_is_seen(rng):
    def textbook(u, half_angle=1e-6):
        z = 1 - u[:, 0] * (1 - np.cos(half_angle))
        r, phi = np.sqrt(1 - z * z), 2 * np.pi * u[:, 1]
        return np.stack((r * np.cos(phi), r * np.sin(phi), z), axis=-1)

    with mpmath.workdps(450):
        assert twin_error(textbook, cone(1e-6)[1](), rng) > 1e6
        assert twin_error(UniformCone(half_angle=1e-6).sample, cone(1e-6)[1](), rng) <= ULPS


@pytest.mark.parametrize("half_angle", [1e-150, 1e-8, 1e-3, 1.0, np.pi / 2, 3.1, np.pi])
def test_the_cone_s_density_has_a_twin(half_angle):
    with mpmath.workdps(450):
        truth = 1 / (2 * mpmath.pi * (1 - mpmath.cos(mpmath.mpf(half_angle))))
    value = UniformCone(half_angle=half_angle).pdf(np.array([[0.0, 0.0, 1.0]]))[0]
    assert scaled_ulps(value, truth, 1.0) <= ULPS


# ---------------------------------------------------------------- the counts

CELLS = 8
SAMPLES = 40_000


def cell_of(warp, points):
    """Number each point by its cell; ``cells`` below gives the cells' exact shares by the same numbers."""
    if isinstance(warp, UniformTriangle):  # a quarter of a quarter of the triangle, by the vertex it is near
        a, b, c = warp.vertices
        weights = np.linalg.lstsq(np.stack((a - c, b - c), axis=-1), (points - c).T, rcond=None)[0]
        weights = np.vstack((weights, 1 - weights.sum(axis=0)))
        number = np.zeros(len(points), dtype=int)
        for _ in range(3):
            near = np.argmax(weights, axis=0)
            middle = weights.max(axis=0) < 0.5
            number = 4 * number + np.where(middle, 3, near)
            weights = np.where(middle, 1 - 2 * weights, 2 * weights - (np.arange(3)[:, None] == near))
        return number
    turn = np.floor((np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1.0) * CELLS).astype(int)
    ring = np.floor(height(warp, points) * CELLS).astype(int)
    return np.minimum(ring, CELLS - 1) * CELLS + np.minimum(turn, CELLS - 1)


def height(warp, points):
    """A coordinate in [0, 1] along which each warp's density is known by hand."""
    if isinstance(warp, UniformDisk):
        return np.hypot(points[:, 0], points[:, 1]) ** 2
    if isinstance(warp, UniformSphere):
        return 0.5 * (1 + points[:, 2])
    if isinstance(warp, UniformCone):
        return (1 - points[:, 2]) / (1 - np.cos(warp.half_angle))
    return points[:, 2]


def shares(warp):
    """The probability of each cell, from the density's primitive."""
    if isinstance(warp, UniformTriangle):
        return np.full(64, 1 / 64)
    edges = np.linspace(0, 1, CELLS + 1)
    rings = np.diff(edges**2 if isinstance(warp, CosineHemisphere) else edges)
    return np.repeat(rings / CELLS, CELLS)


def p_value(warp, points):
    expected = shares(warp)
    return chi_square(
        np.bincount(cell_of(warp, points), minlength=expected.size), len(points) * expected
    ).p_value


@common
def test_samples_are_distributed_as_the_density_says(warp, rng):
    assert p_value(warp, warp.sample(rng.random((SAMPLES, 2)))) > sidak(LEVEL, len(WARPS))


@pytest.mark.parametrize("name", WARPS)
def test_a_bent_warp_is_rejected(name, rng):
    u = rng.random((SAMPLES, 2))
    assert p_value(WARPS[name], WARPS[name].sample(np.column_stack((u[:, 0] ** 1.2, u[:, 1])))) < LEVEL


def test_a_warp_of_another_density_is_rejected(rng):
    points = WARPS["uniform_hemisphere"].sample(rng.random((SAMPLES, 2)))
    assert p_value(WARPS["cosine_hemisphere"], points) < LEVEL
    square = rng.random((SAMPLES, 2))
    r, phi = square[:, 0], 2 * np.pi * square[:, 1]  # r = u instead of √u
    assert p_value(WARPS["uniform_disk"], np.stack((r * np.cos(phi), r * np.sin(phi)), axis=-1)) < LEVEL


# ---------------------------------------------------------------- what is refused, and the sources


@common
@pytest.mark.parametrize("u", [[0.5], [[0.1, 0.2, 0.3]], 0.5, [[0.5, 1.5]], [[-1e-9, 0.5]], [[np.nan, 0.5]]])
def test_what_is_no_square_is_refused(warp, u):
    with pytest.raises(
        ParameterError, match=r"^u = .* is not allowed: it must be (in \[0, 1\]|an array of shape)"
    ):
        warp.sample(u)


@pytest.mark.parametrize("half_angle", [0.0, -1.0, 4.0, np.nan, 1e-200, None, "wide"])
def test_no_cone_is_refused(half_angle):
    with pytest.raises(ParameterError, match=r"^half_angle = .* an angle in \[1e-150, pi\] radians$"):
        UniformCone(half_angle=half_angle)


@pytest.mark.parametrize(
    "vertices",
    [
        [(0, 0, 0), (1, 1, 1), (2, 2, 2)],
        [(0, 0, 0), (0, 0, 0), (1, 0, 0)],
        [(0, 0, 0)] * 3,
        [(0, 0), (1, 0), (0, 1)],
        [(0, 0, 0), (1, 0), (0, 1, 0)],
        "abc",
        [(0, 0, np.nan), (1, 0, 0), (0, 1, 0)],
        1e-200 * np.array(CORNERS),
    ],
)
def test_no_triangle_is_refused(vertices):
    with pytest.raises(ParameterError, match=r"three finite points \(3, 3\) that are not on one line$"):
        UniformTriangle(vertices=vertices)


@common
def test_each_warp_names_its_source(warp):
    assert isinstance(warp.SOURCE, Source)
    assert warp.SOURCE.cite()
