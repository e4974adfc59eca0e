"""View factors: integrals of the definition, the catalogue at 700 digits on hard grids, and their algebra."""

from __future__ import annotations

import itertools

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.facts.errors import ParameterError
from radiokit.measure.twin import scaled_ulps, working_precision
from radiokit.physics import view_factor as vf

LIMIT = 16.0
"""Worst error allowed, in ulps over the condition number."""


# --- the catalogue's own formulas, in so many digits that what cancels does not matter ---


def c41(radius1, radius2, distance):
    x = 1 + (distance**2 + radius2**2) / radius1**2
    return (x - mpmath.sqrt(x * x - 4 * (radius2 / radius1) ** 2)) / 2


def c11(width, length, distance):
    x, y = width / distance, length / distance
    p, q = 1 + x * x, 1 + y * y
    parts = (
        mpmath.log(mpmath.sqrt(p * q / (1 + x * x + y * y))),
        x * mpmath.sqrt(q) * mpmath.atan(x / mpmath.sqrt(q)),
        y * mpmath.sqrt(p) * mpmath.atan(y / mpmath.sqrt(p)),
        -x * mpmath.atan(x),
        -y * mpmath.atan(y),
    )
    return 2 / (mpmath.pi * x * y) * sum(parts)


def c14(edge, width, height):
    h, w = height / edge, width / edge
    a, b = h * h, w * w
    logs = (
        mpmath.log((1 + b) * (1 + a) / (1 + a + b))
        + b * mpmath.log(b * (1 + a + b) / ((1 + b) * (a + b)))
        + a * mpmath.log(a * (1 + a + b) / ((1 + a) * (a + b)))
    )
    far = mpmath.sqrt(a + b)
    angles = w * mpmath.atan(1 / w) + h * mpmath.atan(1 / h) - far * mpmath.atan(1 / far)
    return (angles + logs / 4) / (mpmath.pi * w)


def ball_disk(radius, distance):
    return (1 - 1 / mpmath.sqrt(1 + (radius / distance) ** 2)) / 2


def disk_ball(disk_radius, sphere_radius, distance):
    return 4 * (sphere_radius / disk_radius) ** 2 * ball_disk(disk_radius, distance)


def b13(radius, distance, offset):
    h, r = distance / offset, radius / offset
    z = 1 + h * h + r * r
    return (1 - (z - 2 * r * r) / mpmath.sqrt(z * z - 4 * r * r)) / 2


def aside(radius, distance, offset):
    h, r = distance / offset, radius / offset
    z = 1 + h * h + r * r
    return h / 2 * (z / mpmath.sqrt(z * z - 4 * r * r) - 1)


def b3(width, length, distance):
    x, y = width / distance, length / distance
    p, q = mpmath.sqrt(1 + x * x), mpmath.sqrt(1 + y * y)
    return (x / p * mpmath.atan(y / p) + y / q * mpmath.atan(x / q)) / (2 * mpmath.pi)


def b4(width, length, distance):
    x, y = width / length, distance / length
    far = mpmath.sqrt(x * x + y * y)
    return (mpmath.atan(1 / y) - y / far * mpmath.atan(1 / far)) / (2 * mpmath.pi)


def tilted(radius, distance, tilt):
    """Snyder's form of the cut sphere, with its arcs by acos."""
    s, c, sine = radius / distance, mpmath.cos(tilt), mpmath.sin(tilt)
    if abs(c) >= s:
        return max(c, mpf(0)) * s * s
    root = mpmath.sqrt(1 - s * s)
    turn = mpmath.acos(-root * c / (s * sine))
    azimuth = mpmath.acos(root / sine)
    return (azimuth + s * s * c * turn - s * root * sine * mpmath.sin(turn)) / mpmath.pi


LENGTHS = (1e-150, 1e-8, 1e-3, 0.3, 1.0, 1.0 + 2**-40, 7.0, 1e4, 1e9, 1e150)
MODERATE = (1e-8, 1e-3, 0.3, 1.0, 1.0 + 2**-40, 7.0, 1e4, 1e9)
TILTS = (0.0, 1e-9, 0.5, 1.0, 1.5, np.pi / 2 - 1e-9, np.pi / 2, np.pi / 2 + 1e-9, 1.6, 2.0, 2.6, 3.1)


def grid(*names, lengths=MODERATE):
    return [dict(zip(names, values, strict=True)) for values in itertools.product(lengths, repeat=len(names))]


FACTORS = {
    "parallel_disks": (vf.parallel_disks, c41, grid("radius1", "radius2", "distance")),
    "parallel_rectangles": (vf.parallel_rectangles, c11, grid("width", "length", "distance")),
    "perpendicular_rectangles": (vf.perpendicular_rectangles, c14, grid("edge", "width", "height")),
    "sphere_to_disk": (vf.sphere_to_disk, ball_disk, grid("radius", "distance", lengths=LENGTHS)),
    "disk_to_sphere": (
        vf.disk_to_sphere,
        disk_ball,
        [row for row in grid("disk_radius", "sphere_radius", "distance")
         if row["sphere_radius"] <= row["distance"]],
    ),
    "differential_to_disk, parallel": (vf.differential_to_disk, b13, grid("radius", "distance", "offset")),
    "differential_to_disk, perpendicular": (
        lambda **row: vf.differential_to_disk(**row, orientation="perpendicular"),
        aside,
        [row for row in grid("radius", "distance", "offset") if row["offset"] >= row["radius"]],
    ),
    "differential_to_rectangle, parallel": (
        vf.differential_to_rectangle, b3, grid("width", "length", "distance"),
    ),
    "differential_to_rectangle, perpendicular": (
        lambda **row: vf.differential_to_rectangle(**row, orientation="perpendicular"),
        b4,
        grid("width", "length", "distance"),
    ),
    "differential_to_sphere": (
        vf.differential_to_sphere,
        tilted,
        [{"radius": 1.0, "distance": d, "tilt": t}
         for d in (1 + 2**-50, 1.0 + 1e-9, 1.01, 1.5, 2.0, 10.0, 1e4, 1e8) for t in TILTS],
    ),
}  # fmt: skip


def condition(formula, row, value):
    """Σ |x ∂F/∂x| / |F|, by differences in 1e-40 of each parameter."""
    total = mpf(0)
    for name, x in row.items():
        if x:
            up, down = (formula(**{**row, name: x * (1 + sign * mpf(10) ** -40)}) for sign in (1, -1))
            total += abs(up - down) / (2 * mpf(10) ** -40)
    return float(total / abs(value))


@pytest.mark.parametrize("name", FACTORS)
def test_against_the_catalogue_at_many_digits(name, record_property):
    function, formula, rows = FACTORS[name]
    rows = rows[:: max(1, len(rows) // 150)]
    worst, where = 0.0, rows[0]
    with working_precision(700):
        for row in rows:
            exact = {key: mpf(x) for key, x in row.items()}
            truth = formula(**exact)
            if not truth:
                assert float(function(**row)) == 0.0
                continue
            if abs(truth) < mpf(10) ** -290:
                continue
            error = float(scaled_ulps(float(function(**row)), truth, condition(formula, exact, truth)))
            if error > worst:
                worst, where = error, row
    record_property(f"{name}: points", float(len(rows)))
    record_property(f"{name}: worst ulps over the condition number", worst)
    for key, x in where.items():
        record_property(f"{name}: worst at {key}", float(x))
    assert worst <= LIMIT, where


# --- the definition: ∫∫ cosθ₁ cosθ₂ / πr² dA₂ dA₁, integrated ---


def quad(f, *ranges):
    return mpmath.quad(f, *ranges)


def test_the_formulas_are_the_definition():
    """The catalogue's formulas against the integrals that they are said to be."""
    with mpmath.workdps(20):
        one, h = mpf(1), mpf("0.7")
        parallel = quad(lambda x, y: h * h / (mpmath.pi * (x * x + y * y + h * h) ** 2), [0, 2], [0, one])
        assert abs(parallel - b3(mpf(2), one, h)) < 1e-15
        square = quad(lambda x, y: h * x / (mpmath.pi * (x * x + y * y + h * h) ** 2), [0, 2], [0, one])
        assert abs(square - b4(mpf(2), one, h)) < 1e-15
        # Two surfaces: the pairs of points with the same difference (x, y) make up (w − x)(l − y) of area.
        opposite = quad(
            lambda x, y: 4 * (2 - x) * (1 - y) * h * h / (mpmath.pi * (x * x + y * y + h * h) ** 2),
            [0, 2], [0, 1],
        ) / 2  # fmt: skip
        assert abs(opposite - c11(mpf(2), one, h)) < 1e-15
        offset, r = mpf(3), mpf(2)

        def ring(power, angle, rho):
            x = offset + rho * mpmath.cos(angle)
            square = x * x + (rho * mpmath.sin(angle)) ** 2 + h * h
            return h * (h, x)[power] / (mpmath.pi * square**2) * rho

        for power, formula in ((0, b13), (1, aside)):
            found = 2 * quad(lambda p, rho, k=power: ring(k, p, rho), [0, mpmath.pi], [0, r])
            assert abs(found - formula(r, h, offset)) < 1e-13
        total = quad(lambda rho: 2 * rho * b13(mpf("1.5"), h, rho), [0, 1])
        assert abs(total - c41(one, mpf("1.5"), h)) < 1e-15
        edge = quad(lambda x: 2 * b4_strip(x), [0, one])
        assert abs(edge - c14(one, one, mpf("0.7"))) < 1e-12


def b4_strip(z):
    """From points at depth z of a unit square to a wall of height 0.7 at its edge, averaged over them."""
    height = mpf("0.7")

    def at(y):
        return sum(b4_of(z, side, height) for side in (y, 1 - y))

    return quad(at, [0, mpf(1) / 2])


def b4_of(z, side, height):
    """An element at z from a wall, square to it: b4 with the wall's roles."""
    return b4(height, side, z)


def test_a_cut_sphere_is_the_definition():
    """Rings about the sphere's axis, each clipped by the horizon."""
    with mpmath.workdps(30):
        for distance, tilt in ((2.0, 1.8), (1.01, 1.5), (5.0, 1.7), (1.2, 2.4)):
            t = mpf(tilt)

            def ring(a, t=t):
                p, q = mpmath.cos(t) * mpmath.cos(a), mpmath.sin(t) * mpmath.sin(a)
                if p >= q:
                    return 2 * mpmath.pi * p * mpmath.sin(a)
                if p <= -q:
                    return mpf(0)
                edge = mpmath.acos(-p / q)
                return 2 * (p * edge + q * mpmath.sin(edge)) * mpmath.sin(a)

            end, kink = mpmath.asin(1 / mpf(distance)), abs(mpmath.pi / 2 - t)
            truth = quad(ring, [0, min(kink, end), end]) / mpmath.pi
            assert abs(truth - tilted(mpf(1), mpf(distance), t)) < 1e-16
            found = float(vf.differential_to_sphere(radius=1.0, distance=distance, tilt=tilt))
            assert found == pytest.approx(float(truth), rel=4e-15)


# --- the algebra of view factors ---


def test_reciprocity(rng):
    a, b, c = 10 ** rng.uniform(-3, 3, size=(3, 200))
    there = vf.parallel_disks(radius1=a, radius2=b, distance=c) * a**2
    assert there == pytest.approx(vf.parallel_disks(radius1=b, radius2=a, distance=c) * b**2, rel=1e-14)
    there = vf.perpendicular_rectangles(edge=a, width=b, height=c) * b
    assert there == pytest.approx(vf.perpendicular_rectangles(edge=a, width=c, height=b) * c, rel=1e-14)
    ball = c / (1 + rng.random(200))
    back = vf.disk_to_sphere(disk_radius=a, sphere_radius=ball, distance=c) * a**2
    assert back == pytest.approx(4 * ball**2 * vf.sphere_to_disk(radius=a, distance=c), rel=1e-14)


def test_a_closed_box_receives_everything(rng):
    """Floor to ceiling and four walls: the factors add up to 1."""
    a, b, c = 10 ** rng.uniform(-4, 4, size=(3, 100))
    total = vf.parallel_rectangles(width=a, length=b, distance=c)
    total = total + 2 * vf.perpendicular_rectangles(edge=a, width=b, height=c)
    total = total + 2 * vf.perpendicular_rectangles(edge=b, width=a, height=c)
    assert total == pytest.approx(np.ones(100), abs=1e-14)


def test_four_quadrants_make_the_whole_and_touching_surfaces_see_nothing_else():
    quarter = vf.differential_to_rectangle(width=1e12, length=1e12, distance=1.0)
    assert float(4 * quarter) == pytest.approx(1.0, abs=1e-11)
    assert float(vf.parallel_disks(radius1=1.0, radius2=1.0, distance=0.0)) == 1.0
    assert float(vf.parallel_disks(radius1=2.0, radius2=1.0, distance=0.0)) == 0.25
    assert float(vf.sphere_to_disk(radius=1.0, distance=0.0)) == 0.5
    half = vf.differential_to_sphere(radius=1.0, distance=1 + 1e-12, tilt=np.pi / 2)
    assert float(half) == pytest.approx(0.5, abs=1e-5)


def test_arrays_broadcast():
    found = vf.differential_to_disk(radius=[1.0, 2.0], distance=[[1.0], [3.0], [5.0]], offset=2.0)
    assert found.shape == (3, 2)
    assert found[1, 1] == vf.differential_to_disk(radius=2.0, distance=3.0, offset=2.0)
    assert vf.parallel_rectangles(width=np.ones((2, 1)), length=np.ones(3), distance=1.0).shape == (2, 3)
    assert vf.perpendicular_rectangles(edge=np.ones((2, 1)), width=np.ones(3), height=1.0).shape == (2, 3)
    assert vf.differential_to_sphere(radius=1.0, distance=[2.0, 3.0], tilt=[[0.0], [1.0]]).shape == (2, 2)


# --- a wrong one is found, and wrong input refused ---


def test_the_textbook_form_is_rejected():
    """The same comparison finds what C-41 loses in float64 far away."""
    x = 1 + (1e8**2 + 1.0) / 1.0
    textbook = 0.5 * (x - np.sqrt(x * x - 4))
    with working_precision(60):
        exact = {"radius1": mpf(1), "radius2": mpf(1), "distance": mpf(10) ** 8}
        truth = c41(**exact)
        limit = condition(c41, exact, truth)
        assert scaled_ulps(textbook, truth, limit) > 1e10
        assert scaled_ulps(float(vf.parallel_disks(radius1=1.0, radius2=1.0, distance=1e8)), truth, limit) < 4


@pytest.mark.parametrize("bad", [0.0, -1.0, np.nan, np.inf, "x", None, True])
@pytest.mark.parametrize("name", FACTORS)
def test_bad_lengths_are_named(name, bad):
    function, _, rows = FACTORS[name]
    zero = {"offset", "tilt"} | ({"distance"} if name in ("parallel_disks", "sphere_to_disk") else set())
    for key in rows[0]:
        if bad == 0.0 and key in zero:
            continue
        with pytest.raises(ParameterError, match=key):
            function(**{**rows[-1], key: bad})


def test_other_bad_input_is_named():
    for call, name in (
        (lambda: vf.differential_to_disk(radius=1, distance=1, orientation="skew"), "orientation"),
        (lambda: vf.differential_to_rectangle(width=1, length=1, distance=1, orientation=0), "orientation"),
        (
            lambda: vf.differential_to_disk(radius=2, distance=1, offset=1, orientation="perpendicular"),
            "offset",
        ),
        (lambda: vf.differential_to_sphere(radius=2, distance=1), "distance"),
        (lambda: vf.differential_to_sphere(radius=1, distance=2, tilt=4), "tilt"),
        (lambda: vf.disk_to_sphere(disk_radius=1, sphere_radius=2, distance=1), "distance"),
    ):
        with pytest.raises(ParameterError, match=name):
            call()
