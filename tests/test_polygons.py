"""Polygons: outlines, solid angles, Lambert's formula and axial moments against 45 digits; samples."""

from __future__ import annotations

import dataclasses
import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.contracts.emitter import emitter
from radiokit.emitters.polygon import Polygon
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.triangle import Triangle
from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError
from radiokit.measure.outline import area_vector, check_outline, triangulate
from radiokit.measure.sphericaltriangle import UniformSphericalTriangle
from radiokit.measure.statistics import chi_square, sidak
from radiokit.measure.twin import ulps
from radiokit.physics import polygon
from radiokit.physics.axial_moments import axial_moment, double_axis_moment
from radiokit.worlds.scene import irradiance, solid_angle

ORIGIN = np.zeros(3)
UP = (0.0, 0.0, 1.0)
LEVEL = sidak(1e-3, 16)
ULPS = 16


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(45):
        yield


# --- the truth: shadows and rings about a pole, by quadrature over the azimuth ---


def dot(a, b):
    return mpmath.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit_of(v):
    size = mpmath.sqrt(dot(v, v))
    return [x / size for x in v]


def cut(points, n):
    heights, found = [dot(p, n) for p in points], []
    for k, (p, h) in enumerate(zip(points, heights, strict=True)):
        q, g = points[k - 1], heights[k - 1]
        if (g > 0) != (h > 0):
            found.append([a + (b - a) * g / (g - h) for a, b in zip(q, p, strict=True)])
        if h > 0:
            found.append(p)
    return found


def seen(vertices, position):
    return [[mpf(float(a)) - mpf(float(b)) for a, b in zip(v, position, strict=True)] for v in vertices]


def around(points, pole, ring):
    """−∮ ring(φ, cosθ, sinθ) dφ along the edges of a polygon whose front is seen, about a pole."""
    z = unit_of(pole)
    x = unit_of(cross([1, 0, 0] if abs(z[0]) < 0.7 else [0, 1, 0], z))
    y = cross(z, x)
    local = [[dot(p, axis) for axis in (x, y, z)] for p in points]
    total = mpf(0)
    for p, q in zip(local, local[1:] + local[:1], strict=True):
        start, n = mpmath.atan2(p[1], p[0]), cross(p, q)
        turn = mpmath.atan2(n[2], p[0] * q[0] + p[1] * q[1])
        if not turn:
            continue

        def along(s, start=start, n=n):
            phi = start + s
            cot = -(n[0] * mpmath.cos(phi) + n[1] * mpmath.sin(phi)) / n[2]
            sine = 1 / mpmath.sqrt(1 + cot * cot)
            return ring(mpmath.cos(phi), mpmath.sin(phi), cot * sine, sine)

        size = max(abs(along(turn * k / 4)) for k in range(5)) or mpf(1)  # quad's tolerance is absolute
        total -= size * mpmath.quad(lambda s, f=along, size=size: f(s) / size, mpmath.linspace(0, turn, 5))
    return total, x, y


def true_irradiance(vertices, position, normal):
    """The area that the part above the horizon covers on the base of the hemisphere (Nusselt)."""
    n = [mpf(float(x)) for x in normal]
    points = cut(seen(vertices, position), n)
    if not points:
        return mpf(0)
    value, _, _ = around(points, n, lambda c, s, cosine, sine: sine * sine / 2)
    return value * mpmath.sqrt(dot(n, n))


def true_solid_angle(vertices, position):
    """Rings about the polygon's middle: each edge adds ∫ (1 − cosθ) dφ."""
    points = seen(vertices, position)
    middle = [mpmath.fsum(p) for p in zip(*points, strict=True)]
    return around(points, middle, lambda c, s, cosine, sine: sine * sine / (1 + cosine))[0]


def true_moment(vertices, axis, exponent, normal=None):
    a = unit_of([mpf(float(x)) for x in axis])
    points = cut(seen(vertices, ORIGIN), a)
    n = None if normal is None else unit_of([mpf(float(x)) for x in normal])
    points = points if n is None else cut(points, n)
    k = exponent

    def ring(c, s, cosine, sine):
        if n is None:
            return (whole - cosine ** (k + 1)) / (k + 1)
        _, x, y = frame
        across = c * dot(x, n) + s * dot(y, n)
        rest = mpmath.betainc(mpf(3) / 2, mpf(k + 1) / 2, 0, sine * sine) / 2
        return dot(a, n) * (1 - cosine ** (k + 2)) / (k + 2) + across * rest

    frame = around(points, a, lambda *_: mpf(1))
    whole = 1 if frame[0] > 1 else 0  # unless the polygon is about the axis, the azimuths add up to nothing
    return around(points, a, ring)[0]


SQUARE = np.array([[-1.0, -1, 1], [-1, 1, 1], [1, 1, 1], [1, -1, 1]])
TRIANGLE = np.array([[-0.3, -0.4, 1.0], [0.1, 0.7, 1.25], [0.5, -0.2, 0.75]])
ELL = np.array([(0.25, 2, 1), (1, 2, 1), (1, 1, 1), (2, 1, 1), (2, 0.125, 1), (0.25, 0.125, 1)], dtype=float)
WALL = np.array([[1.0, 1, 0], [1, -1, 0], [1, -1, 1], [1, 1, 1]])
TILT = (0.6, 0.0, 0.8)
AWAY = np.array([3.0, -2.0, 5.0])


def at(points, scale=(1.0, 1.0, 1.0), shift=(0.0, 0.0, 0.0)):
    return np.array(points) * scale + np.array(shift)


HARD = {
    "square": (SQUARE, ORIGIN, UP),
    "square aslant": (SQUARE, ORIGIN, TILT),
    "triangle": (TRIANGLE, ORIGIN, UP),
    "ell": (ELL, ORIGIN, UP),
    "ell cut": (ELL, ORIGIN, (0.8, -0.48, -0.36)),
    "elsewhere": (at(SQUARE, shift=AWAY), AWAY + 0.1, UP),
    "tiny overhead": (at(SQUARE, (1e-8, 1e-8, 1)), ORIGIN, UP),
    "tiny aside": (at(SQUARE, (1e-8, 1e-8, 1), (0.75, 0.5, 0)), ORIGIN, TILT),
    "tiniest": (at(SQUARE, (1e-100, 1e-100, 1)), ORIGIN, UP),
    "far": (at(SQUARE, shift=(2e7, -1e7, 3e7)), ORIGIN, UP),
    "huge": (at(SQUARE, (1e8, 1e8, 1), (0.1, 0.2, 0)), ORIGIN, UP),
    "huge and cut": (at(SQUARE, (1e8, 1e8, 1)), ORIGIN, TILT),
    "grazing": (at(WALL, (1, 1, 1e-8), (0, 0, 1e-8)), ORIGIN, UP),
    "grazing and tiny": (at(WALL, (1, 1e-8, 1e-8), (0, 0, 1e-8)), ORIGIN, UP),
    "on the horizon": (WALL, ORIGIN, UP),
    "vertex on the horizon": (np.array([[1.0, 0, 0], [1, -0.5, 1], [1, 0.5, 1]]), ORIGIN, UP),
    "vertex beside the horizon": (np.array([[1.0, 0, -1e-16], [1, -0.5, 1], [1, 0.5, 1]]), ORIGIN, UP),
    "cut to a hair": (at(WALL, shift=(0, 0, -1 + 1e-12)), ORIGIN, UP),
    "cut wall": (at(WALL, (1, 1, 2), (0, 0, -1)), ORIGIN, UP),
    "edge-on": (at(SQUARE, (1, 1, 1e-12)), ORIGIN, (0.96, 0.0, 0.28)),
    "all but in the plane": (np.array([[1.0, 0, 0.25], [2, 0, 1], [2, 1e-15, 0.375]]), ORIGIN, TILT),
    "sliver": (np.array([[-1.0, -0.5, 1], [0.0, 0.25 + 1e-14, 1], [1, 1, 1]]), ORIGIN, UP),
    "near a corner": (at(SQUARE, shift=(1 + 1e-9, 1 + 1e-9, -1 + 1e-10)), ORIGIN, UP),
    "near an edge": (at(SQUARE, shift=(1 + 1e-9, 0.25, -1 + 1e-9)), ORIGIN, TILT),
    "from close by": (at(SQUARE, (1, 1, 1e-9), (0.25, 0.125, 0)), ORIGIN, UP),
}
every = pytest.mark.parametrize("name", HARD)


@every
def test_irradiance_to_the_last_digits(name):
    vertices, position, normal = HARD[name]
    truth = true_irradiance(vertices, position, normal)
    found = polygon.irradiance(vertices, position, np.array(normal))
    assert ulps(found.value, truth) <= ULPS
    assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error))
    assert found.error <= 2.0**-44 * found.value


@every
def test_solid_angle_to_the_last_digits(name):
    vertices, position, _ = HARD[name]
    truth = true_solid_angle(vertices, position)
    found = polygon.solid_angle(vertices, position)
    assert ulps(found.value, truth) <= ULPS
    assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error))
    assert found.error <= 2.0**-44 * found.value


def gauss(n):
    x, _ = np.polynomial.legendre.leggauss(n)
    for k in range(n):  # to the working precision
        node = mpf(float(x[k]))
        for _ in range(3):
            before, now = mpf(1), node
            for j in range(2, n + 1):
                before, now = now, ((2 * j - 1) * node * now - (j - 1) * before) / j
            slope = n * (node * now - before) / (node * node - 1)
            node -= now / slope
        yield (1 + node) / 2, 1 / ((1 - node * node) * slope * slope)


def test_the_truth_is_the_integral_over_the_area():
    """∫ cosθ cosθ'/r² dA and ∫ cosθ'/r² dA, as they are defined, over a square seen from a corner's side."""
    corners, n = at(SQUARE, (0.25, 0.25, 1), (0.5, 0.375, 0)), [mpf(float(x)) for x in TILT]
    flux, angle, rule = mpf(0), mpf(0), list(gauss(24))
    for s, ws in rule:
        for t, wt in rule:
            p = [(1 + 2 * s) / 4, (1 + 4 * t) / 8, mpf(1)]
            square = dot(p, p)
            part = ws * wt / 4 / square ** mpf(1.5)
            angle += part
            flux += part * dot(p, n) / mpmath.sqrt(square)
    assert abs(true_irradiance(corners, ORIGIN, TILT) / flux - 1) < mpf(10) ** -20
    assert abs(true_solid_angle(corners, ORIGIN) / angle - 1) < mpf(10) ** -20


def by_arccosine(vertices, normal):
    """Lambert's formula as textbooks print it."""
    total = 0.0
    v = [p / np.linalg.norm(p) for p in vertices]
    for a, b in zip(v, v[1:] + v[:1], strict=True):
        across = np.cross(a, b)
        total -= math.acos(min(1.0, a @ b)) * (across @ normal) / max(np.linalg.norm(across), 1e-300) / 2
    return total


@pytest.mark.parametrize(("size", "least"), [(1e-2, 1e3), (1e-4, 1e6), (1e-6, 1e11)])
def test_the_textbook_s_arccosine_is_rejected(size, least):
    vertices = at(TRIANGLE, size, (0.0, 0.0, 1.0))
    truth = true_irradiance(vertices, ORIGIN, UP)
    assert ulps(by_arccosine(vertices, np.array(UP)), truth) > least
    assert ulps(polygon.irradiance(vertices, ORIGIN, np.array(UP)).value, truth) <= ULPS


def test_float64_stays_within_its_bound(rng, monkeypatch):
    """The fast sums vouch for themselves: their bounds hold against the refined ones, in hard cases too."""
    worst = [0.0, 0.0]
    for _ in range(200):
        size = 10 ** rng.uniform(-4, 1)
        vertices = rng.normal(size=(3, 3)) * size + rng.normal(size=3)
        vertices[:, 2] += 1e-3 - min(vertices[:, 2].min(), 0.0)
        monkeypatch.setattr(polygon, "TRUSTED", math.inf)
        quick = polygon.irradiance(vertices, ORIGIN, np.array(UP)), polygon.solid_angle(vertices, ORIGIN)
        monkeypatch.setattr(polygon, "TRUSTED", -1.0)
        sure = polygon.irradiance(vertices, ORIGIN, np.array(UP)), polygon.solid_angle(vertices, ORIGIN)
        for k in range(2):
            if quick[k].value > 0 and sure[k].value > 0:
                worst[k] = max(worst[k], quick[k].ratio(sure[k].value))
    assert min(worst) > 1e-3
    assert max(worst) < 0.5


@pytest.mark.parametrize("scale", [1e-90, 1e-30, 1e30, 1e90])
def test_scale_does_not_matter(scale):
    unscaled = polygon.irradiance(ELL, ORIGIN, np.array(TILT)).value
    assert polygon.irradiance(ELL * scale, ORIGIN, np.array(TILT)).value == pytest.approx(unscaled, rel=1e-14)
    assert polygon.solid_angle(ELL * scale, ORIGIN).value == pytest.approx(
        polygon.solid_angle(ELL, ORIGIN).value, rel=1e-14
    )


def test_what_is_not_seen_is_dark():
    for vertices, normal in (
        (SQUARE[::-1], UP),  # from behind
        (SQUARE, (0.0, 0.0, -1.0)),  # below the horizon
        (at(SQUARE, (1, 1, 0), (3, 0, 0)), TILT),  # in its plane
        (at(SQUARE, (1, 1, 0), (3, 0, 0)), UP),
    ):
        found = polygon.irradiance(vertices, ORIGIN, np.array(normal))
        assert (found.value, found.error) == (0.0, 0.0)
    assert polygon.solid_angle(SQUARE[::-1], ORIGIN).value == 0.0
    assert polygon.solid_angle(at(SQUARE, (1, 1, 0), (3, 0, 0)), ORIGIN).value == 0.0


def test_irradiance_adds_up(rng):
    """A polygon is its triangles, whatever the tilt; the horizon cuts both alike."""
    for _ in range(20):
        normal = unit(rng.normal(size=3))
        parts = [polygon.irradiance(ELL[t], ORIGIN, normal) for t in triangulate(ELL)]
        whole = polygon.irradiance(ELL, ORIGIN, normal)
        gap = abs(float(whole.value) - math.fsum(float(p.value) for p in parts))
        assert gap <= whole.error + sum(p.error for p in parts) + 1e-17


# --- axial moments ---

MOMENTS = {
    "square": (at(SQUARE, shift=(0.3, 0.2, 0.0)), TILT),
    "beside the lobe": (at(SQUARE, shift=(1.5, 0.2, 0.0)), (-0.6, 0.0, 0.8)),
    "small": (at(TRIANGLE, 1e-3, (0.1, 0.2, 1.0)), (0.28, 0.0, 0.96)),
    "cut by both horizons": (at(WALL, (1, 1, 2), (0, 0.3, -1)), (-0.36, 0.48, 0.8)),
    "ell": (ELL, (0.48, 0.6, 0.64)),
}


@pytest.mark.parametrize("exponent", [0, 1, 50, 200])
@pytest.mark.parametrize("name", MOMENTS)
def test_moments_to_the_last_digits(name, exponent):
    vertices, axis = MOMENTS[name]
    with mpmath.workdps(34):
        truth = true_moment(vertices, axis, exponent)
    found = axial_moment(vertices=vertices, axis=axis, exponent=exponent)
    assert ulps(found.value, truth) <= 2
    assert found.error <= 4 * np.spacing(found.value)


@pytest.mark.parametrize(
    ("name", "exponent"), [("square", 1), ("small", 20), ("cut by both horizons", 9), ("ell", 90)]
)
def test_double_moments_to_the_last_digits(name, exponent):
    vertices, axis = MOMENTS[name]
    with mpmath.workdps(30):
        truth = true_moment(vertices, axis, exponent, UP)
    found = double_axis_moment(vertices=vertices, axis=axis, exponent=exponent, normal=UP)
    assert ulps(found.value, truth) <= 2


def in_float64(vertices, axis, exponent):
    """The recurrence of axial moments as it is usually programmed, for an odd exponent."""
    v = [p / np.linalg.norm(p) for p in vertices]
    total = np.zeros(exponent // 2 + 1)
    for p, q in zip(v, v[1:] + v[:1], strict=True):
        side = np.cross(p, q)
        sine = np.linalg.norm(side)
        side, angle = side / sine, math.atan2(sine, p @ q)
        a, b = axis @ p, axis @ np.cross(side, p)
        f = [angle]
        first, last, slope, final = a, axis @ q, b, b * math.cos(angle) - a * math.sin(angle)
        f.append(slope - final)
        for k in range(2, exponent):
            f.append(
                ((k - 1) * (a * a + b * b) * f[k - 2] + slope * first ** (k - 1) - final * last ** (k - 1))
                / k
            )
        total -= axis @ side * np.array(f[0:exponent:2])
    value = 0.0
    for k in range(1, exponent + 1, 2):
        value = ((k - 1) * value + total[k // 2]) / (k + 1)
    return value


def test_the_recurrence_in_float64_is_rejected():
    """It is right for a large light, and loses digits as the light gets small: where, is stated here."""
    axis = np.array(UP)
    lost = {}
    for size in (1.0, 1e-1, 1e-3, 1e-6):
        vertices = at(SQUARE, (size, size, 1.0), (0.3, 0.1, 0.0))
        right = axial_moment(vertices=vertices, axis=UP, exponent=199).value
        lost[size] = abs(in_float64(vertices, axis, 199) / right - 1)
    assert lost[1.0] < 1e-14
    assert lost[1e-1] < 1e-11
    assert lost[1e-3] > 1e-9
    assert lost[1e-6] > 1e-5


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"exponent": 1.5}, "exponent = 1.5"),
        ({"exponent": -1}, "exponent = -1"),
        ({"exponent": 10_001}, "exponent"),
        ({"exponent": math.nan}, "exponent"),
        ({"exponent": "two"}, "exponent"),
        ({"axis": (0, 0, 0)}, "axis"),
        ({"axis": (0, 1)}, "axis"),
        ({"normal": (0, 0, math.nan)}, "normal"),
        ({"position": (math.inf, 0, 0)}, "position"),
        ({"vertices": SQUARE[:2]}, "vertices"),
    ],
    ids=str,
)
def test_bad_moments_are_refused(change, match):
    given = {"vertices": SQUARE, "axis": UP, "exponent": 2, "normal": UP, **change}
    with pytest.raises(ParameterError, match=match):
        double_axis_moment(**given)


# --- outlines ---


def test_triangles_make_up_the_polygon(rng):
    for count in (3, 4, 9, 30):
        turn = np.sort(rng.random(count)) * 2 * np.pi
        radius = rng.uniform(0.2, 1.0, count)
        basis = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        star = np.stack((radius * np.cos(turn), radius * np.sin(turn), 0 * turn), axis=-1) @ basis
        if np.diff(turn, append=turn[0] + 2 * np.pi).max() > 3.0:
            continue
        whole = area_vector(np.array(check_outline("vertices", star)))
        parts = np.array([area_vector(star[t]) for t in triangulate(star)])
        np.testing.assert_allclose(parts.sum(axis=0), whole, rtol=0, atol=1e-14)
        assert (parts @ whole > 0).all()


BAD = {
    "two": (SQUARE[:2], r"\(N, 3\), with N at least 3"),
    "flat array": (SQUARE[:, :2], r"\(N, 3\)"),
    "words": ("square", r"\(N, 3\)"),
    "nothing": (None, r"\(N, 3\)"),
    "nan": ([[0, 0, 0], [1, math.nan, 0], [0, 1, 0]], r"vertices\[1\]"),
    "infinite": ([[0, 0, 0], [1, 0, 0], [0, math.inf, 0]], r"vertices\[2\]"),
    "enormous": ([[0, 0, 0], [1, 0, 0], [0, 1e101, 0]], r"vertices\[2\]"),
    "twice": ([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]], r"vertices\[2\] .* another point"),
    "a point": ([[1, 1, 1]] * 3, r"another point"),
    "a line": ([[0, 0, 0], [1, 1, 1], [2, 2, 2]], "area"),
    "bent": ([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]], r"in the plane"),
    "spike": ([[0, 0, 0], [1, 0, 0], [3, 0, 0], [1, 0, 0.0], [0, 1, 0]], r"vertices\[2\]"),
    "crossing": ([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 2, 0]], r"vertices\[0\] .* one from vertices\[2\]"),
    "touching": ([[0, 0, 0], [4, 0, 0], [4, 2, 0], [2, 0, 0], [0, 2, 0]], r"vertices\[0\] .* meets no other"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_outlines_are_named(name):
    value, match = BAD[name]
    with pytest.raises(ParameterError, match=match):
        Polygon(vertices=value)


def test_bad_lights_are_refused():
    good = {"center": (0, 0, 1), "normal": (0, 0, -1), "width": 1, "height": 2}
    for change, match in (
        ({"width": 0}, "width"),
        ({"height": -1}, "height"),
        ({"height": math.inf}, "height"),
        ({"normal": (0, 0, 0)}, "normal"),
        ({"up": (0, 0, 3)}, "up"),
        ({"center": (0, 0, math.nan)}, "center"),
        ({"center": (1e17, 0, 1)}, "width, height"),
        ({"radiance": -1}, "radiance"),
        ({"sampling": "cosine"}, "sampling"),
    ):
        with pytest.raises(ParameterError, match=match):
            Rectangle(**{**good, **change})
    with pytest.raises(ParameterError, match="three points"):
        Triangle(vertices=SQUARE)


@pytest.mark.parametrize("place", [(0, 0, 1), (1, 1, 1), (1, 0.3, 1), (-0.3, 0.9, 1)])
def test_a_receiver_on_the_light_is_refused(place):
    light = Polygon(vertices=SQUARE)
    for call in (irradiance, solid_angle):
        with pytest.raises(ParameterError, match=r"position = .* away from the light"):
            call(light, position=place)


# --- emitters ---

LIGHTS = {
    "triangle": Triangle(vertices=TRIANGLE, radiance=2.0),
    "rectangle": Rectangle(
        center=(0.2, 0.1, 1), normal=(0.1, 0.2, -1), width=2, height=0.5, up=(1, 1, 0), radiance=2.0
    ),
    "polygon": Polygon(vertices=ELL, radiance=2.0),
    "huge": Polygon(vertices=at(SQUARE, (50, 70, 1)), radiance=2.0),
    "tiny": Polygon(vertices=at(ELL, (1e-6, 1e-6, 1), (0.3, 0.1, 0)), radiance=2.0),
}  # fmt: skip
SAMPLINGS = [(name, how) for name in LIGHTS for how in ("solid angle", "area")]


def fields_of(light):
    return {field.name: getattr(light, field.name) for field in dataclasses.fields(light)}


def sampled(name, how):
    light = LIGHTS[name]
    return type(light)(**fields_of(light) | {"sampling": how})


@pytest.mark.parametrize("name", LIGHTS)
def test_flux_is_pi_l_a(name):
    light = LIGHTS[name]
    assert light.area == pytest.approx(np.linalg.norm(area_vector(light.corners)), rel=1e-9)
    assert light.flux().value == pytest.approx(np.pi * 2.0 * light.area, rel=1e-15)
    assert emitter(light.name, **fields_of(light)) == light


@pytest.mark.parametrize(("name", "how"), SAMPLINGS)
def test_samples_hit_the_light_with_their_density(name, how, rng):
    light = sampled(name, how)
    u = rng.random((20_000, 2))
    directions, density = light.sample(u, ORIGIN)
    assert np.abs(np.linalg.norm(directions, axis=1) - 1).max() < 1e-15
    assert (light.radiance_from(directions, ORIGIN) == 2.0).all()
    np.testing.assert_allclose(density, light.pdf(directions, ORIGIN), rtol=1e-12)
    omega = float(light.solid_angle(ORIGIN).value)
    if how == "solid angle":
        np.testing.assert_allclose(density * omega, 1.0, rtol=1e-12)
    else:
        value = 1 / density
        assert abs(value.mean() - omega) <= 5 * value.std() / math.sqrt(len(u)) + 1e-12 * omega
    beside = unit(rng.normal(size=(1000, 3)) * [1, 1, 0.01])
    low = beside[beside[:, 2] < 0]
    assert not light.radiance_from(low, ORIGIN).any()
    assert not light.pdf(low, ORIGIN).any()
    back = np.array([0.0, 0.0, 9.0])
    assert light.sample(u[:3], back)[1].tolist() == [0.0] * 3
    assert light.pdf(-directions[:3], back).tolist() == [0.0] * 3


@pytest.mark.parametrize("planted", [False, True], ids=["right", "planted"])
@pytest.mark.parametrize(("name", "how"), [p for p in SAMPLINGS if p[0] in ("rectangle", "polygon", "huge")])
def test_samples_fill_cells_as_they_should(name, how, planted, rng):
    """Each of 36 cells of the plane gets its share: of the area, or of the solid angle by its own formula."""
    light, count = sampled(name, how), 40_000
    u = rng.random((count, 2))
    if planted:
        u[:, 1] **= 1.1
    directions, _ = light.sample(u, ORIGIN)
    corners = light.corners
    normal = unit(area_vector(corners))
    points = directions * ((corners[0] @ normal) / (directions @ normal))[:, None]
    x = unit(corners[1] - corners[0])
    y = np.cross(normal, x)
    flat = np.stack((points @ x, points @ y), axis=-1)
    edges = [np.linspace(c.min(), c.max(), 7) for c in (corners @ x, corners @ y)]
    counts = np.histogram2d(flat[:, 0], flat[:, 1], bins=[np.r_[-1e9, e[1:-1], 1e9] for e in edges])[0]
    shares, depth = np.zeros((6, 6)), corners[0] @ normal
    for i in range(6):
        for j in range(6):
            shares[i, j] = share_of_cell(
                corners, [e[k : k + 2] for e, k in zip(edges, (i, j), strict=True)], x, y, depth * normal, how
            )
    assert shares.sum() == pytest.approx(1.0, rel=1e-9)
    kept = shares > 1e-12
    assert counts[~kept].sum() == 0
    p_value = chi_square(counts[kept], count * shares[kept] / shares.sum()).p_value
    assert p_value < 1e-6 if planted else p_value > LEVEL


def share_of_cell(corners, cell, x, y, foot, how):
    """The share of a light, cut by its cell's four sides, by exact area or solid angle."""
    (x0, x1), (y0, y1) = cell
    parts = []
    for triangle in corners[triangulate(corners)]:
        piece = triangle.tolist()
        for axis, bound, sign in ((x, x0, 1), (x, x1, -1), (y, y0, 1), (y, y1, -1)):
            moved = [[*p, 1.0] for p in piece]
            n = sign * np.array([*axis, -bound])
            piece = clip_affine(moved, n)
        if len(piece) > 2:
            parts.append(np.array(piece))
    measure = (
        (lambda p: float(polygon.solid_angle(p, ORIGIN).value))
        if how == "solid angle"
        else (lambda p: np.linalg.norm(area_vector(p)))
    )
    return sum(map(measure, parts)) / measure(corners)


def clip_affine(points, n):
    heights, found = [float(np.dot(p, n)) for p in points], []
    for k, (p, h) in enumerate(zip(points, heights, strict=True)):
        if (heights[k - 1] > 0) != (h > 0):
            t = heights[k - 1] / (heights[k - 1] - h)
            found.append([a + t * (b - a) for a, b in zip(points[k - 1][:3], p[:3], strict=True)])
        if h > 0:
            found.append(p[:3])
    return found


@pytest.mark.parametrize("name", LIGHTS)
@pytest.mark.parametrize("normal", [UP, TILT, (0.96, 0.0, -0.28)])
def test_the_closed_form_is_what_quadrature_finds(name, normal):
    light = LIGHTS[name]

    class Unknown(type(light)):
        def irradiance_at(self, position, normal):
            return None

    same = Unknown(**fields_of(light))
    exact, found = irradiance(light, normal=normal), irradiance(same, normal=normal, rtol=1e-9)
    assert found.converged
    assert float(found.value) == pytest.approx(float(exact.value), rel=1e-9)


@pytest.mark.parametrize("size", [1e-2, 1e-4, 1e-6])
def test_quadrature_of_what_is_cut_keeps_its_bound(size, rng):
    """Where the horizon cuts a small light, rounding moves the cut by more than the rules differ."""
    for _ in range(4):
        shift = unit(rng.normal(size=3) * [1, 1, 0]) * rng.uniform(1, 2) + [0, 0, rng.choice([0, size])]
        facing = Rectangle(center=shift, normal=-shift, width=size, height=size, up=rng.normal(size=3))
        exact = irradiance(facing)

        class Unknown(Rectangle):
            def irradiance_at(self, position, normal):
                return None

        found = irradiance(Unknown(**fields_of(facing)), rtol=1e-8)
        assert found.converged
        assert abs(float(found.value) - float(exact.value)) <= float(found.error) + float(exact.error)


# --- the warp ---

WARPS = {
    "octant": np.eye(3),
    "small": at(TRIANGLE, 1e-3, (0.1, 0.2, 1.0)),
    "large": np.array([[1.0, 0.1, 0.01], [-0.7, 0.9, 0.02], [-0.4, -1.0, 0.03]]),
    "turned": TRIANGLE[::-1],
}


@pytest.mark.parametrize("name", WARPS)
def test_the_warp_is_a_triplet(name, rng):
    warp = UniformSphericalTriangle(vertices=WARPS[name])
    u = rng.uniform(0.02, 0.98, (5000, 2))
    points = warp.sample(u)
    assert np.abs(warp.invert(points) - u).max() < 1e-10
    assert (warp.pdf(points) == 1 / warp.solid_angle).all()
    assert abs(warp.solid_angle / abs(true_solid_angle(WARPS[name], ORIGIN)) - 1) < 1e-12
    h = 1e-5
    first, second = ((warp.sample(u + s) - warp.sample(u - s)) / (2 * h) for s in ([h, 0], [0, h]))
    stretch = np.linalg.norm(np.cross(first, second), axis=-1)
    assert np.abs(stretch / warp.solid_angle - 1).max() < 1e-5
    rim = np.array([(a, b) for a in (0.0, 1e-300, 0.5, 1.0) for b in (0.0, 1e-300, 0.5, 1.0)])
    assert np.isfinite(warp.sample(rim)).all()
    assert (warp.pdf(warp.sample(rim)) > 0).all()
    assert warp.pdf(-points[:5]).tolist() == [0.0] * 5


@pytest.mark.parametrize(
    "bad", [np.eye(2), "x", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 0, 0], [-1, 0, 0], [0, 1, 0]]], ids=str
)
def test_bad_spherical_triangles_are_refused(bad):
    with pytest.raises(ParameterError, match="vertices"):
        UniformSphericalTriangle(vertices=bad)
