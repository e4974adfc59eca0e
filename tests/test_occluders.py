"""Occluders: rays against fractions, what is left of lights at 30 digits, and planted wrong shadows."""

from __future__ import annotations

import dataclasses
import itertools
import math
import pickle
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts import holes, sight
from radiokit.contracts.emitter import emitter
from radiokit.contracts.occluder import Occluder, list_occluders, occluder
from radiokit.contracts.shadowed import Shadowed, shadowed
from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.facts.verdict import Outcome
from radiokit.measure.exact import rational
from radiokit.measure.lunes import Region
from radiokit.measure.statistics import sidak, z_test
from radiokit.physics.ball import Ball
from radiokit.physics.eclipse import place, relation
from radiokit.physics.facets import Facets
from radiokit.physics.plate import Plate
from radiokit.worlds.cases.catalogue import case
from radiokit.worlds.scene import irradiance, solid_angle
from radiokit.worlds.shading import explain, shade

ORIGIN = np.zeros(3)
UP = np.array([0.0, 0.0, 1.0])
EPS = float(np.finfo(float).eps)
SQUARE = [(-1.0, -1.0, 2.0), (1.0, -1.0, 2.0), (1.0, 1.0, 2.0), (-1.0, 1.0, 2.0)]
ELL = [(0.0, 0.0, 1.0), (2.0, 0.0, 1.0), (2.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 2.0, 1.0), (0.0, 2.0, 1.0)]


def ball(x, y, z, radius):
    return occluder("sphere", center=(x, y, z), radius=radius)


def screen(x, y, z, radius, normal=(0, 0, 1)):
    return occluder("disk", center=(x, y, z), normal=normal, radius=radius)


def level(x0, x1, y0, y1, height):
    return occluder(
        "polygon", vertices=[(x0, y0, height), (x1, y0, height), (x1, y1, height), (x0, y1, height)]
    )


def panel(width, height=1.0, **more):
    return emitter("rectangle", center=(0, 0, height), normal=(0, 0, -1), width=width, height=width, **more)


def sun(radius=1.0, distance=4.0):
    return emitter("sphere", center=(0, 0, distance), radius=radius, radiance=1.0)


# --- rays, by fractions ---


def fractions(v):
    return [Fraction(float(x)) for x in v]


def inner(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def meets_sphere(item, position, direction):
    """The line's distance from the centre, by the area of a parallelogram."""
    v, d = minus(fractions(item.center), fractions(position)), fractions(direction)
    area = cross(v, d)
    return inner(v, d) > 0 and inner(area, area) <= Fraction(item.radius) ** 2 * inner(d, d)


def meets_disk(item, position, direction):
    """The point in which the ray meets the plane, and its distance from the centre."""
    p, d, c, m = (fractions(v) for v in (position, direction, item.center, item.normal))
    if inner(m, d) == 0:
        return False
    t = inner(m, minus(c, p)) / inner(m, d)
    hit = [x + t * y for x, y in zip(p, d, strict=True)]
    off = minus(hit, c)
    return t > 0 and inner(off, off) <= Fraction(item.radius) ** 2


def meets_polygon(item, position, direction):
    """The point in which the ray meets the plane z = const, and its winding by crossings; edges count."""
    p, d = fractions(position), fractions(direction)
    points = [fractions(v) for v in item.vertices]
    if d[2] == 0:
        return False
    t = (points[0][2] - p[2]) / d[2]
    x, y = p[0] + t * d[0], p[1] + t * d[1]
    inside = False
    for a, b in zip(points, points[1:] + points[:1], strict=True):
        side = (b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])
        if side == 0 and min(a[0], b[0]) <= x <= max(a[0], b[0]) and min(a[1], b[1]) <= y <= max(a[1], b[1]):
            return t > 0
        if (a[1] > y) != (b[1] > y) and (side > 0) == (b[1] > a[1]):
            inside = not inside
    return t > 0 and inside


def nudged(direction, rng, count=6):
    """A direction and its neighbours, a few units in the last place away."""
    yield np.array(direction)
    for _ in range(count):
        yield np.array(
            [
                np.nextafter(x, x + s) if s else x
                for x, s in zip(direction, rng.integers(-1, 2, 3), strict=True)
            ]
        )


def rim_of(item, position, turn):
    """A point of a body's edge as it is seen, rounded."""
    v = np.array(item.center) - position
    if item.name == "disk":
        axis, center, radius = np.array(item.normal), v, item.radius
    else:
        share = (item.radius / np.linalg.norm(v)) ** 2
        axis, center, radius = v / np.linalg.norm(v), v * (1 - share), item.radius * math.sqrt(1 - share)
    first = unit(np.cross(axis, [0.3, -0.5, 0.8]))
    return center + radius * (math.cos(turn) * first + math.sin(turn) * np.cross(axis, first))


ROUND = [
    ball(0, 0, 2, 1),
    ball(1, 0, 1, 1.0),  # whose tangent goes straight up
    ball(3, -2, 5, 1e-9),
    ball(1, 2, 2, 3 - 1e-9),
    screen(0, 0, 2, 1),
    screen(1, 1, 1, 1.0, (1, -2, 3)),
    screen(2, 0, 1e-9, 1, (0, 0, 1)),  # all but edge-on
    screen(3, 1, 4, 1e-10, (1, 0, 5)),
]


@pytest.mark.parametrize("item", ROUND, ids=str)
def test_rays_at_the_rim_of_round_bodies_meet_them_as_fractions_say(item, rng):
    meets = meets_sphere if item.name == "sphere" else meets_disk
    directions = [w for turn in np.linspace(0, 6, 25) for w in nudged(unit(rim_of(item, ORIGIN, turn)), rng)]
    directions += [np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), -np.array(unit(item.center))]
    directions += list(unit(np.array(item.center) + item.radius * rng.normal(size=(20, 3))))
    found = item.blocks(np.array(directions), ORIGIN, np.inf)
    truth = [meets(item, ORIGIN, w) for w in directions]
    assert found.tolist() == truth
    assert any(truth)
    assert not all(truth)


@pytest.mark.parametrize("vertices", [SQUARE, SQUARE[::-1], ELL], ids=["square", "other-side", "ell"])
def test_rays_through_corners_and_edges_meet_polygons_as_fractions_say(vertices, rng):
    item = occluder("polygon", vertices=vertices)
    points = np.array(vertices)
    places = [points, (points + np.roll(points, 1, axis=0)) / 2, rng.uniform(-2.5, 2.5, (60, 3))]
    places[2][:, 2] = points[0, 2]
    targets = np.concatenate(places)
    position = np.array([0.25, 0.5, 0.0])
    directions = [w for target in targets for w in nudged(target - position, rng)]
    directions += [np.array([1.0, 0.0, 0.0]), -UP]
    found = item.blocks(np.array(directions), position, np.inf)
    assert found.tolist() == [meets_polygon(item, position, w) for w in directions]
    assert found.any()
    assert not found.all()


@pytest.mark.parametrize("item", [screen(2, 0, 0, 1), level(1, 3, -1, 1, 0.0)], ids=str)
def test_a_sheet_seen_edge_on_hides_nothing(item, rng):
    turn = rng.uniform(0, 2 * np.pi, 50)
    flat = np.stack((np.cos(turn), np.sin(turn), np.zeros(50)), axis=-1)
    assert not item.blocks(np.concatenate((flat, [[1.0, 0.0, 0.0]])), ORIGIN, np.inf).any()
    assert item.blocks(np.array([[2.0, 0.0, -1.0]]) / math.sqrt(5), UP, np.inf).all()


def test_a_tangent_meets_a_ball_and_one_hair_beside_does_not():
    up = UP[None]
    assert ball(1, 0, 1, 1.0).blocks(up, ORIGIN, np.inf).all()
    assert not ball(1, 0, 1, np.nextafter(1.0, 0)).blocks(up, ORIGIN, np.inf).any()
    assert not ball(np.nextafter(1.0, 2), 0, 1, 1.0).blocks(up, ORIGIN, np.inf).any()
    assert not ball(1, 0, -1, 1.0).blocks(up, ORIGIN, np.inf).any()


# --- distances ---


def far(item, direction, position):
    """The distance along a ray in 40 digits, from the equation of the surface."""
    p, d = [[mpf(float(x)) for x in v] for v in (position, direction)]
    size = mpmath.sqrt(inner(d, d))
    d = [x / size for x in d]
    if hasattr(item, "center") and hasattr(item, "radius") and not hasattr(item, "normal"):
        v = minus([mpf(x) for x in item.center], p)
        b, room = inner(d, v), inner(v, v) - mpf(item.radius) ** 2
        root = mpmath.sqrt(b * b - room)
        return b - root if room > 0 else b + root
    corners = item.vertices if hasattr(item, "vertices") else getattr(item, "corners", None)
    if corners is None:
        m, c = [mpf(x) for x in item.normal], [mpf(x) for x in item.center]
    else:
        a, b, c = ([mpf(float(x)) for x in v] for v in corners[:3])
        m = cross(minus(b, a), minus(c, a))
    return inner(m, minus(c, p)) / inner(m, d)


LIGHTS = [
    sun(),
    sun(1e-6, 1e3),
    emitter("disk", center=(1, 2, 3), normal=(0, -1, -2), radius=2, radiance=1.0),
    emitter("rectangle", center=(0, 1, 2), normal=(0.1, -1, -1), width=1, height=2),
    emitter("triangle", vertices=[(1, 0, 1), (0, 0, 2), (0, 1, 1)]),
    emitter("polygon", vertices=ELL[::-1]),
]


@pytest.mark.parametrize("light", LIGHTS, ids=lambda light: light.name)
def test_lights_say_how_far_they_are(light, rng):
    directions, _ = light.sample(rng.random((40, 2)) * 0.9 + 0.05, ORIGIN)
    found = light.distance_along(directions, ORIGIN)
    with mpmath.workdps(40):
        for w, distance in zip(directions, found, strict=True):
            truth = far(light, w, ORIGIN)
            assert abs(mpf(distance) / truth - 1) < 64 * EPS * (2 if light.name != "sphere" else 32)


def test_points_and_environments_say_how_far_they_are():
    point = emitter("point", position=(0, 3, 4), intensity=1.0)
    assert point.distance_along(np.array([[0.0, 0.6, 0.8]]), ORIGIN).tolist() == [5.0]
    for name in ("constant", "sky_overcast"):
        assert emitter(name).distance_along(UP[None], ORIGIN).tolist() == [math.inf]


@pytest.mark.parametrize(
    "item",
    [ball(0.1, 0.2, 2, 1), ball(0.1, 0, 0.2, 1), screen(0, 0, 2, 1), level(-1, 1, -1, 1, 3.0)],
    ids=str,
)
def test_a_body_hides_what_is_behind_it_and_not_what_it_touches(item):
    direction = unit(np.array([0.05, 0.1, 1.0]))
    with mpmath.workdps(40):
        distance = float(far(item, direction, ORIGIN))
    reach = distance * np.array([0.5, 1 - 1e-13, 1.0, 1 + 1e-13, 1 + 1e-9, 2.0, np.inf])
    found = item.blocks(np.repeat(direction[None], 7, axis=0), ORIGIN, reach)
    assert found.tolist() == [False] * 4 + [True] * 3


SELVES = [
    (sun(), ball(0, 0, 4, 1.0)),
    (
        emitter("disk", center=(0, 1, 2), normal=(0, -1, -2), radius=1, radiance=1.0),
        screen(0, 1, 2, 1, (0, 1, 2)),
    ),
    (panel(2.0), level(-1, 1, -1, 1, 1.0)),
    (panel(2.0), level(-3, 0.5, -1, 1, 1.0)),
    (
        emitter("triangle", vertices=[(1, 0, 1), (0.1, 0, 2), (0, 1.3, 1)]),
        occluder("polygon", vertices=[(1, 0, 1), (0.1, 0, 2), (0, 1.3, 1)]),
    ),
]


@pytest.mark.parametrize(("light", "item"), SELVES, ids=lambda x: x.name)
def test_a_light_does_not_hide_itself(light, item, rng):
    directions, _ = light.sample(rng.random((500, 2)), ORIGIN)
    behind = Shadowed(light=light, occluders=(item,))
    assert behind.visible(directions, ORIGIN).all()
    assert not item.blocks(directions, ORIGIN, light.distance_along(directions, ORIGIN)).any()
    assert shadowed(light, (item,), ORIGIN) is light


# --- how bodies lie ---


def seen(x, y, z, radius):
    return Ball.seen((x, y, z), radius, ORIGIN)


HAIR = 2.0**-45
PLACES = [
    (seen(0, 0, 2, 0.5), seen(0, 0, 4, 1.0), "around"),  # equal cones
    (seen(0, 0, 2, 0.5 - HAIR), seen(0, 0, 4, 1.0), "within"),
    (seen(0, 0, 2, 0.5 + HAIR), seen(0, 0, 4, 1.0), "around"),
    (seen(0, 3, 4, 3.0), seen(0, 0, 9, 1e-9), "across"),  # its rim goes through the zenith
    (seen(0, 3, 4, 3.0 - 1e-6), seen(0, 0, 9, 1e-9), "apart"),
    (seen(0, 3, 4, 3.0 + 1e-6), seen(0, 0, 9, 1e-9), "around"),
    (seen(0, 0, -2, 1.0), seen(0, 0, 2, 1.0), "apart"),
    (seen(1e-13, 0, 1, 1e-12), seen(0, 0, 1, 2e-12), "within"),
    (seen(1e-12, 0, 1, 1.1e-12), seen(0, 0, 1, 2e-12), "across"),
    (
        Plate.seen((0, 0, 1), (0, 0, -1), 0.25, ORIGIN),
        Plate.seen((0, 0, 2), (0, 0, -1), 0.5, ORIGIN),
        "around",
    ),
    (
        Plate.seen((0.25, 0, 1), (0, 0, -1), 0.25, ORIGIN),
        Plate.seen((0, 0, 2), (0, 0, -1), 1.0, ORIGIN),
        "within",
    ),
    (
        Plate.seen((0.26, 0, 1), (0, 0, -1), 0.25, ORIGIN),
        Plate.seen((0, 0, 2), (0, 0, -1), 1.0, ORIGIN),
        "across",
    ),
    (
        Plate.seen((0.75, 0, 1), (0, 0, -1), 0.25, ORIGIN),
        Plate.seen((0, 0, 2), (0, 0, -1), 1.0, ORIGIN),
        "apart",
    ),
]


@pytest.mark.parametrize(("body", "light", "expected"), PLACES)
def test_cones_that_touch_or_all_but_touch_are_told_apart(body, light, expected):
    assert place(body, light) == expected


def test_cones_lie_as_their_directions_do(rng):
    """A cone is within another if its rim's directions are, tried in a thousand places."""
    for _ in range(60):
        first, second = (
            Ball.seen(rng.normal(size=3), r, ORIGIN)
            if rng.random() < 0.5
            else Plate.seen(tuple(rng.normal(size=3)), tuple(unit(rng.normal(size=3))), r, ORIGIN)
            for r in rng.uniform(0.05, 0.5, 2)
        )
        if first is None or second is None or any(getattr(b, "surrounds", False) for b in (first, second)):
            continue
        w = unit(rng.normal(size=(20000, 3)))
        a, b = first.contains(w), second.contains(w)
        found = place(first, second)
        assert not (found == "apart" and np.any(a & b))
        assert not (found == "within" and np.any(a & ~b))
        assert not (found == "around" and np.any(b & ~a))
        assert found != "across" or np.any(a) or np.any(b)


def test_regions_are_as_large_as_random_directions_say(rng):
    """Between planes, in a cone and outside of overlapping holes, by the share of directions within."""
    w = unit(rng.normal(size=(40_000, 3)))
    z = []
    for k in range(24):
        planes = [rational(rng.normal(size=3)) for _ in range(k % 4)]
        lamp = (
            Plate.seen((0, 0, 3), tuple(unit([0.5, 0.3, -1])), rng.uniform(1, 4), ORIGIN) if k % 3 else None
        )
        holes = [Ball.seen((0.1, 0, 1), r, ORIGIN) for r in rng.uniform(0.1, 0.8, k % 2)]
        holes += [Ball.seen((0, 0.2, 1), r, ORIGIN) for r in rng.uniform(0.21, 0.8, k % 2)]
        cone = None if lamp is None else lamp.cone
        region = Region(unit([0.05, 0.05, 1.0]), planes, cone, [hole.cone for hole in holes])
        inside = np.ones(len(w), dtype=bool)
        for plane in planes:
            inside &= w @ np.array([float(x) for x in plane]) >= 0
        for hole in holes:
            inside &= ~hole.contains(w)
        if lamp is not None:
            inside &= lamp.contains(w)
        share = inside.mean()
        size = sum(arc.size for arc in region.arcs) / (4 * np.pi)
        z.append((share - size) / max(math.sqrt(size * (1 - size) / len(w)), 1e-9))
    assert max(map(abs, z)) < 4.5
    assert np.std(z) < 2


def test_what_is_beyond_the_light_hides_nothing():
    bulb = Ball.seen((0, 0, 4), 1.0, ORIGIN)
    assert relation(seen(0, 0, 2, 0.4), bulb) == "within"
    assert relation(seen(0, 0, 9, 1.0), bulb) == "apart"
    assert relation(seen(0, 0, 4, 2.0), bulb) == "around"  # a shade around the bulb
    assert relation(seen(0, 0, 4, 0.5), bulb) == "apart"  # a filament inside it
    assert relation(seen(0, 0, 3, 1.0), bulb) == "unsure"  # they pierce each other
    assert relation(seen(0, 0, 0.5, 1.0), bulb) == "around"  # the receiver is inside
    assert relation(seen(0, 0, 3, 5.0), bulb) == "apart"  # and so is the bulb
    assert relation(Plate.seen((0, 0, 5), (0, 0, -1), 9.0, ORIGIN), bulb) == "apart"
    assert relation(Plate.seen((0, 0, 3), (0, 0, -1), 0.1, ORIGIN), bulb) == "within"


def test_an_upright_wall_before_a_lamp_is_nearer_though_its_plane_cuts_the_lamp():
    lamp = Ball.seen((0, 0, 2), 0.5, ORIGIN)
    wall = np.array([(0.1, -3, 0.5), (0.1, 3, 0.5), (0.1, 3, 1.4), (0.1, -3, 1.4)])
    front, back = (Facets.seen(np.add(wall, (0, 0, z)), ORIGIN, two_sided=True) for z in (0, 2.5))
    assert relation(front, lamp) == "across"
    assert relation(back, lamp) == "apart"
    assert relation(lamp, front) == "apart"
    assert relation(lamp, back) == "across"
    blade = Plate.seen((0.2, 0, 1), (-1, 0, 0), 0.45, ORIGIN)
    assert relation(blade, lamp) == "across"


# --- what is left, at 30 digits ---


def arcs_left(light, hidden, theta):
    """The part of a ring about the normal that is lit [rad]: the light's arc less the others."""

    def arc(cone):
        tilt, azimuth, sigma = cone
        x = (mpmath.cos(sigma) - mpmath.cos(theta) * mpmath.cos(tilt)) / max(
            mpmath.sin(theta) * mpmath.sin(tilt), mpf(10) ** -60
        )
        half = mpmath.pi if x <= -1 else mpf(0) if x >= 1 else mpmath.acos(x)
        return azimuth - half, azimuth + half

    low, high = (-mpmath.pi, mpmath.pi) if light is None else arc(light)
    pieces = []
    for cone in hidden:
        a, b = arc(cone)
        for turn in (-2 * mpmath.pi, 0, 2 * mpmath.pi):
            x, y = max(a + turn, low), min(b + turn, high)
            if x < y:
                pieces.append((x, y))
    total, end = high - low, low
    for a, b in sorted(pieces):
        total -= max(b - max(a, end), mpf(0))
        end = max(end, b)
    return total


def cone_of(item, normal):
    """A ball as the tilt from the normal, the azimuth and the half-angle of its cone."""
    n = [mpf(float(x)) for x in normal]
    v = [mpf(x) for x in item.center]
    size = mpmath.sqrt(inner(n, n))
    n = [x / size for x in n]
    x = cross([0, 1, 0], n)
    x = [c / mpmath.sqrt(inner(x, x)) for c in x]
    y = cross(n, x)
    length = mpmath.sqrt(inner(v, v))
    flat = mpmath.hypot(inner(v, x), inner(v, y))
    return (
        mpmath.atan2(flat, inner(v, n)),
        mpmath.atan2(inner(v, y), inner(v, x)),
        mpmath.asin(mpf(item.radius) / length),
    )


def rings_left(light, items, normal, weight=mpmath.cos):
    """∫ cosθ dω of what is lit, ring by ring about the normal, cut where arcs begin, end or meet."""
    cones = [cone_of(item, normal) for item in items]
    bulb = None if light is None else cone_of(light, normal)
    ends = {mpf(0), mpmath.pi / 2}
    known = cones + ([bulb] if bulb else [])
    for tilt, _, sigma in known:
        ends |= {abs(tilt - sigma), tilt + sigma}
    for first, second in itertools.combinations(known, 2):
        ends |= set(crossings(first, second))
    ends = sorted(e for e in ends if 0 <= e <= mpmath.pi / 2)
    return sum(
        mpmath.quad(lambda t: arcs_left(bulb, cones, t) * mpmath.sin(t) * weight(t), [a, b])
        for a, b in itertools.pairwise(ends)
        if b - a > mpf(10) ** -25
    )


def crossings(first, second):
    """The angles from the normal at which two circles on the sphere cross."""

    def axis(cone):
        tilt, azimuth, _ = cone
        s = mpmath.sin(tilt)
        return [s * mpmath.cos(azimuth), s * mpmath.sin(azimuth), mpmath.cos(tilt)]

    a, b = axis(first), axis(second)
    c = inner(a, b)
    det = 1 - c * c
    if det < mpf(10) ** -25:
        return
    ca, cb = mpmath.cos(first[2]), mpmath.cos(second[2])
    p, q = (ca - c * cb) / det, (cb - c * ca) / det
    middle = [p * x + q * y for x, y in zip(a, b, strict=True)]
    rest = 1 - inner(middle, middle)
    if rest < 0:
        return
    n = cross(a, b)
    scale = mpmath.sqrt(rest / det)
    for sign in (-1, 1):
        yield mpmath.acos(middle[2] + sign * scale * n[2])


SKY = emitter("constant", radiance=1.0)
BALLS = [
    (None, [ball(0.5, 0, 2, 1)], (0, 0, 1)),
    (None, [ball(2, 0, 0.3, 1)], (0, 0, 1)),  # cut by the horizon
    (None, [ball(2, 0, 0.3, 1), ball(-2, 0.1, 1, 0.5)], (0.3, 0.2, 1)),
    (None, [ball(0, 0.2, 2, 1), ball(0.1, -2, 2, 1)], (0, 0, 1)),  # overlapping
    (sun(), [ball(0.1, 0, 2, 0.3)], (0.2, 0, 1)),
    (sun(), [ball(0.1, 0, 2, 0.3999)], (0, 0.6, 0.8)),
    (sun(), [ball(0.3, 0, 2, 0.4)], (0.6, 0, 0.8)),
    (sun(), [ball(0.3, 0.1, 2, 0.4), ball(-0.3, 0.1, 2, 0.2)], (0.1, 0, 0.9)),
    (sun(), [ball(0.3, 0.1, 2, 0.4), ball(-0.02, 0.1, 2, 0.2), ball(0.05, -0.2, 1, 0.1)], (0.1, 0, 0.9)),
    (emitter("sphere", center=(3, 0, 0.5), radius=1, radiance=1.0), [ball(1.5, 0.2, 0.2, 0.4)], (0, 0, 1)),
    (emitter("sphere", center=(3, 0, 0.5), radius=1, radiance=1.0), [ball(1.5, 0.1, 0.1, 0.2)], (0, 0, 1)),
    (sun(1e-3, 100.0), [ball(1e-5, 0, 10, 5e-5)], (0.3, 0.4, 0.8)),
    (sun(1e-3, 100.0), [ball(4e-5, 0, 10, 8e-5)], (0.3, 0.4, 0.8)),
]


@pytest.mark.parametrize(("light", "items", "normal"), BALLS)
def test_what_balls_leave_is_within_its_bound(light, items, normal):
    given = SKY if light is None else light
    found = irradiance(given, normal=normal, occluders=items)
    with mpmath.workdps(30):
        truth = rings_left(light, items, normal)
        assert found.converged
        assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error))
    assert found.error <= 1e-8 * found.value


def test_a_ring_that_all_but_vanishes_keeps_its_digits():
    """Cones that differ by 1e-10 leave a difference with few digits, which its bound tells."""
    for gap in (1e-3, 1e-6, 1e-8, 1e-10):
        found = irradiance(sun(), occluders=[ball(0, 0, 2, 0.5 - gap)])
        with mpmath.workdps(40):
            truth = mpmath.pi * (mpf(1) / 16 - mpf(0.5 - gap) ** 2 / 4)
            assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error))
        assert found.converged
        assert found.error <= 1e-4 * found.value


def contour(points, normal):
    """½∮ n·(r × dr)/r² along the edges of what of a polygon is above the horizon, by quadrature."""
    n = [mpf(float(x)) for x in normal]
    size = mpmath.sqrt(inner(n, n))
    n = [x / size for x in n]
    points = half(points, lambda p: inner(p, n))
    total = mpf(0)
    for a, b in zip(points, points[1:] + points[:1], strict=True):
        step = minus(b, a)
        lift = inner(n, cross(a, step))

        def along(t, a=a, step=step, lift=lift):
            r = [x + t * y for x, y in zip(a, step, strict=True)]
            return lift / inner(r, r)

        total += mpmath.quad(along, mpmath.linspace(0, 1, 4)) / 2
    return abs(total)


def half(points, height):
    """Sutherland and Hodgman's cut, in whatever numbers."""
    out = []
    for p, q in zip(points[-1:] + points[:-1], points, strict=True):
        a, b = height(p), height(q)
        if (a < 0) != (b < 0):
            out.append([x + a / (a - b) * (y - x) for x, y in zip(p, q, strict=True)])
        if b >= 0:
            out.append(q)
    return out


def shadow_on(height, item):
    """A level screen's shadow on the plane at a height, of a light at the origin."""
    return [
        [mpf(x) * height / mpf(z) for x, _, z in [v]] + [mpf(v[1]) * height / mpf(v[2]), mpf(height)]
        for v in item.vertices
    ]


def overlap(square, points):
    """What of a polygon lies in |x| ≤ s, |y| ≤ s."""
    for axis, sign in itertools.product((0, 1), (1, -1)):
        points = half(points, lambda p, axis=axis, sign=sign: square - sign * p[axis])
        if not points:
            return points
    return points


SCREENS = [
    (level(0.1, 0.3, -0.2, 0.2, 0.5), (0, 0, 1)),  # within
    (level(0.1, 0.9, -0.2, 0.7, 0.5), (0.2, 0.1, 1)),
    (level(-0.49999999, 3, -3, 3, 0.5), (0, 0, 1)),  # leaves a strip of 2e-8
    (level(-3, 3, -3, 0.4999999999, 0.5), (0.6, 0, 0.8)),
    (level(-0.1, 0.1, -3, 3, 0.5), (1, 0, 0.1)),  # the horizon cuts the light
    (level(1e-9, 2e-9, 0, 1e-9, 0.5), (0, 0, 1)),  # a speck
    (occluder("polygon", vertices=[(0.1, -0.2, 0.5), (0.6, 0, 0.9), (-0.1, 0.3, 0.2)]), (0, 0, 1)),
]


@pytest.mark.parametrize(("item", "normal"), SCREENS, ids=lambda x: getattr(x, "name", str(x)))
def test_what_a_screen_leaves_of_a_square_is_exact(item, normal):
    found = irradiance(panel(2.0), normal=normal, occluders=[item])
    with mpmath.workdps(45):
        square = [[mpf(x), mpf(y), mpf(1)] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        truth = contour(square, normal) - contour(overlap(1, shadow_on(1, item)), normal)
        assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error))
    assert found.error <= 4 * EPS * found.value
    assert found.method == "closed form"


def test_screens_that_overlap_are_not_counted_twice():
    items = [
        level(-0.5, 0.1, -0.5, 0.1, 0.5),
        level(-0.06, 0.3, -0.06, 0.3, 0.3),
        level(-0.5, 0.1, -0.5, 0.1, 0.5),
    ]
    one = [level(-0.5, 0.1, -0.5, 0.1, 0.5)]
    assert (
        irradiance(panel(2.0), occluders=items[:1] * 3).value == irradiance(panel(2.0), occluders=one).value
    )
    found = irradiance(panel(2.0), occluders=items)
    with mpmath.workdps(30):
        corners = {k: overlap(1, shadow_on(1, item)) for k, item in enumerate(items)}
        shared = [[mpf(x), mpf(y), mpf(1)] for x, y in itertools.product((-0.2, 0.2), repeat=2)]
        shared = [shared[0], shared[2], shared[3], shared[1]]
        square = [[mpf(x), mpf(y), mpf(1)] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        truth = contour(square, UP) - contour(corners[0], UP) - contour(corners[1], UP) + contour(shared, UP)
        assert abs(mpf(float(found.value)) - truth) < mpf(10) ** -14


def test_screens_before_a_round_light_are_not_counted_twice():
    """One behind the other, overlapping and half below the horizon; the disk is as good as a huge square."""
    items = [level(-0.1, 0.3, -0.2, 0.1, 0.5), level(0.1, 0.9, -0.4, 0.9, 0.9)]
    disk = emitter("disk", center=(0, 0, 1), normal=(0, 0, -1), radius=2, radiance=1.0)
    for normal in ((0, 0, 1), (0.5, -0.3, 1), (1, 0, 0)):
        for given in (items, items[::-1]):
            found = irradiance(disk, normal=normal, occluders=given)
            hidden = irradiance(panel(4.0), normal=normal).value
            hidden -= irradiance(panel(4.0), normal=normal, occluders=given).value
            expected = irradiance(disk, normal=normal)
            assert abs(found.value - (expected.value - hidden)) <= found.error + expected.error + 1e-15
            assert found.error < 1e-13
    angle = solid_angle(disk).value - solid_angle(disk, occluders=items).value
    assert (
        abs(angle - (solid_angle(panel(4.0)).value - solid_angle(panel(4.0), occluders=items).value)) < 1e-14
    )


def test_a_screen_that_pierces_a_light_hides_what_is_beyond_it():
    """Half of an upright wall is nearer than the panel's plane; only that half has a shadow."""
    tall = occluder("polygon", vertices=[(0.2, -1, 0.5), (0.2, 1, 0.5), (0.2, 1, 3), (0.2, -1, 3)])
    low = occluder("polygon", vertices=[(0.2, -1, 0.5), (0.2, 1, 0.5), (0.2, 1, 1), (0.2, -1, 1)])
    found, other = (irradiance(panel(2.0), occluders=[item]).value for item in (tall, low))
    assert abs(found - other) < 1e-11


def test_a_concave_screen_is_the_sum_of_its_parts():
    ell = occluder("polygon", vertices=[(x / 4, y / 4, 0.5) for x, y, _ in ELL])
    parts = [level(0, 0.5, 0, 0.25, 0.5), level(0, 0.25, 0, 0.5, 0.5)]
    for light in (panel(2.0), SKY, emitter("sky_overcast")):
        found, expected = (irradiance(light, occluders=items, rtol=1e-10) for items in ([ell], parts))
        assert abs(found.value - expected.value) <= found.error + expected.error


# --- solid angles ---


def test_visible_solid_angles():
    assert solid_angle(sun(), occluders=ball(0, 0, 2, 0.5)).value == 0.0
    half_left = solid_angle(SKY, occluders=[screen(0, 0, 1e-6, 1e6)])
    assert abs(half_left.value - 2 * math.pi) < 1e-11
    ring = solid_angle(sun(), occluders=[ball(0, 0, 2, 0.3)])
    exact = 2 * math.pi * (math.sqrt(1 - 0.15**2) - math.sqrt(1 - 1 / 16))
    assert abs(ring.value - exact) <= ring.error + 1e-16
    corner = solid_angle(panel(2.0), occluders=[level(0, 1, 0, 1, 0.5)])
    assert abs(corner.value - math.pi / 2) <= corner.error + 1e-15
    lens = solid_angle(sun(), occluders=[ball(0.3, 0, 2, 0.4)])
    with mpmath.workdps(25):
        truth = rings_left(sun(), [ball(0.3, 0, 2, 0.4)], UP, weight=lambda t: 1)
        assert abs(mpf(float(lens.value)) - truth) <= mpf(float(lens.error))
    assert lens.converged
    assert (
        solid_angle(emitter("point", position=(0, 0, 2), intensity=1), occluders=ball(0, 0, 1, 0.1)).value
        == 0
    )


# --- shading: methods against each other ---


SCENES = {
    "glossy, behind a screen": (Phong(exponent=20.0), panel(2.0), [level(0.1, 0.6, -0.3, 0.4, 0.5)]),
    "glossy, behind a ball": (GGX(alpha=0.4), panel(2.0), [ball(0.2, 0.1, 0.5, 0.2)]),
    "glossy, partial eclipse": (GGX(alpha=0.3), sun(2.0), [ball(0.25, 0.05, 1, 0.3)]),
    "screen before a disk": (
        Lambert(reflectance=0.5),
        emitter("disk", center=(0.3, 0, 2), normal=(0, 0, -1), radius=1.5, radiance=1.0),
        [level(0.1, 0.6, -0.3, 0.4, 0.5)],
    ),
    "disk with an exponent": (
        Lambert(reflectance=0.5),
        emitter("disk", center=(0.3, 0, 2), normal=(0, 0, -1), radius=1.5, radiance=1.0, exponent=3),
        [screen(0.2, 0.1, 1, 0.5, (1, 0, 3)), ball(-0.2, 0.1, 1, 0.3)],
    ),
    "roofs under a sky": (
        Lambert(reflectance=0.5),
        emitter("sky_overcast", normal=(0.3, 0, 1)),
        [level(0.5, 3, -1, 2, 1.0), level(-3, -0.5, -1, 2, 1.0), ball(0, 2, 1, 0.5)],
    ),
    "overlapping balls": (Lambert(reflectance=0.5), sun(2.0), [ball(0.25, 0, 1, 0.3), ball(0, 0.2, 1, 0.25)]),
}
LEVEL = sidak(1e-3, 3 * len(SCENES))


@pytest.mark.parametrize("name", SCENES)
def test_samples_agree_with_quadrature(name, seed):
    f, light, items = SCENES[name]
    wo = (0.28, 0.0, 0.96)
    exact = shade(f, light, wo, occluders=items, rtol=1e-6)
    assert exact.is_bound
    assert exact.converged
    for k, method in enumerate(("mc-bsdf", "mc-light", "mis")):
        found = shade(f, light, wo, occluders=items, method=method, samples=40_000, rng=seed + k)
        p = z_test(dataclasses.replace(found, value=abs(found.value - exact.value)), 0.0)
        assert p > LEVEL, (method, found, exact)


def test_a_mirror_shows_what_hides():
    mirror = Mirror(reflectance=0.5)
    wo = (0.6, 0.0, 0.8)
    assert shade(mirror, SKY, wo).value == 0.5
    assert shade(mirror, SKY, wo, occluders=ball(-0.6, 0, 0.8, 0.1)).value == 0.0
    assert shade(mirror, SKY, wo, occluders=ball(0.6, 0, 0.8, 0.1)).value == 0.5


def test_delta_lights_are_seen_or_not():
    lamp = emitter("point", position=(0, 0, 2), intensity=4.0)
    noon = emitter("directional", direction=(0, 0, 1), irradiance=1.0)
    f = Lambert(reflectance=0.5)
    between, beyond = ball(0, 0, 1, 0.1), ball(0, 0, 3, 0.5)
    assert [shade(f, x, UP, occluders=between).value for x in (lamp, noon)] == [0.0, 0.0]
    assert shade(f, lamp, UP, occluders=beyond).value == shade(f, lamp, UP).value
    assert shade(f, noon, UP, occluders=beyond).value == 0.0
    assert irradiance(lamp, occluders=between).value == 0.0
    assert (
        shade(f, [lamp, noon], UP, occluders=[beyond, ball(1, 0, 1, 0.9)]).value == shade(f, lamp, UP).value
    )


def test_inside_a_ball_the_light_inside_counts_alone():
    room = ball(0, 0, 1, 5.0)
    assert irradiance(sun(), occluders=room).value == irradiance(sun()).value
    assert irradiance(sun(distance=9.0), occluders=room).value == 0.0
    assert irradiance(SKY, occluders=room).value == 0.0
    assert irradiance(emitter("point", position=(0, 0, 5.5), intensity=1.0), occluders=room).value > 0
    assert irradiance(emitter("point", position=(0, 0, 6.5), intensity=1.0), occluders=room).value == 0.0


# --- nothing in the way, and nothing known ---


@pytest.mark.parametrize(
    "item", [ball(5, 0, 1, 1), ball(0, 0, 9, 1), ball(0, 0, -3, 1), level(3, 4, 0, 1, 0.1)]
)
def test_what_cannot_matter_is_dropped_at_once(item):
    light = panel(2.0)
    assert shadowed(light, (item,), ORIGIN) is light
    plain, found = (
        explain(Lambert(reflectance=0.5), light),
        explain(Lambert(reflectance=0.5), light, occluders=item),
    )
    assert plain.to_json() == found.to_json()


def test_a_dome_is_one_until_something_hides_it():
    below, before = ball(0, 0, -3, 1), ball(0, 0, 3, 1)
    sky = emitter("constant", radiance=1.0, normal=(0, 0, 1))
    assert shadowed(sky, (below,), ORIGIN) is sky
    behind = shadowed(sky, (before,), ORIGIN)
    assert behind.dome(ORIGIN) is None
    assert behind.name == "constant behind sphere"
    assert behind.flux() is None
    assert pickle.loads(pickle.dumps(behind)) == behind
    assert "mis" in explain(GGX(alpha=0.3), sky, occluders=before).rows[0].alternatives


UNKNOWN = [
    (emitter("environment", radiance=[[1.0], [0.0]]), [ball(0, 0, 2, 1)], math.pi * 0.75),
    (sun(), [ball(0, 0, 3.2, 0.4)], None),  # it pierces the light
]


@pytest.mark.parametrize(("light", "items", "exact"), UNKNOWN)
def test_where_edges_are_unknown_quadrature_says_so(light, items, exact, seed):
    found = irradiance(light, occluders=items)
    assert not found.converged
    assert "no rule can bound" in found.note
    if exact is not None:
        assert abs(found.value - exact) <= found.error
    f = Lambert(reflectance=0.5)
    plan = explain(f, light, occluders=items)
    assert "closed form" not in (plan.rows[0].method, *plan.rows[0].alternatives)
    auto = shade(f, light, UP, occluders=items, rng=seed, samples=1 << 18)
    assert not auto.is_bound or not auto.converged
    angle = solid_angle(light, occluders=items)
    assert not angle.converged
    assert abs(auto.value - found.value * 0.5 / math.pi) < 8 * auto.error + 0.5 / math.pi * found.error


# --- what a judge must find ---


def test_wrong_shadows_are_rejected(monkeypatch, seed):
    eclipse, wall = case("lambert-in-annular-eclipse"), case("lambert-under-square-below-wall")

    def verdict(item):
        return item.verdict("mc-light", seed, samples=60_000).outcome

    assert verdict(eclipse) is verdict(wall) is Outcome.HOLDS
    right = Shadowed.visible
    with monkeypatch.context() as planted:
        planted.setattr(Shadowed, "visible", lambda self, w, p: np.ones(len(w), dtype=bool))
        assert verdict(eclipse) is Outcome.VIOLATED
    with monkeypatch.context() as planted:  # the wrong side
        planted.setattr(Shadowed, "visible", lambda self, w, p: ~right(self, w, p))
        assert verdict(eclipse) is Outcome.VIOLATED
    with monkeypatch.context() as planted:  # shadows of what is behind the light
        planted.setattr(
            type(wall.scene.emitters[0]), "distance_along", lambda self, w, p: np.full(len(w), np.inf)
        )
        behind = Shadowed(light=wall.scene.emitters[0], occluders=wall.scene.occluders)
        directions, _ = behind.sample(np.random.default_rng(seed).random((100, 2)), ORIGIN)
        assert (
            wall.scene.occluders[0]
            .blocks(directions, ORIGIN, behind.distance_along(directions, ORIGIN))
            .any()
        )


def test_wrong_closed_forms_and_wrong_patches_are_rejected(monkeypatch):
    def verdict(name, method):
        return case(name).verdict(method).outcome

    shadows = ("lambert-in-annular-eclipse", "lambert-under-sky-behind-two-balls")
    for name in shadows:
        assert verdict(name, "closed form") is verdict(name, "quadrature") is Outcome.HOLDS
    with monkeypatch.context() as planted:  # nothing is taken away
        planted.setattr(sight, "_less", lambda whole, hidden: whole)
        assert all(verdict(name, "closed form") is Outcome.VIOLATED for name in shadows)
    with monkeypatch.context() as planted:  # the holes are filled, which the lattice beside the rule sees
        planted.setattr(holes, "Region", lambda axis, planes, cone, gaps: Region(axis, planes, cone))
        assert all(verdict(name, "quadrature") is not Outcome.HOLDS for name in shadows)
    with monkeypatch.context() as planted:  # what is behind a light hides it
        planted.setattr(sight, "relation", place)
        wall = case("lambert-under-square-below-wall").scene
        behind = Shadowed(light=dataclasses.replace(wall.emitters[0], radiance=2.0), occluders=wall.occluders)
        assert behind.hides(ORIGIN)
        ball_behind = Shadowed(light=sun(1.5), occluders=(ball(0, 0, 9, 0.5),))
        assert ball_behind.irradiance_at(ORIGIN, UP).value < irradiance(sun(1.5)).value


# --- the registry, and errors ---


def test_the_registry():
    assert {"sphere", "disk", "polygon"} <= set(list_occluders())
    assert isinstance(ball(0, 0, 1, 0.5), Occluder)
    with pytest.raises(UnknownNameError, match="unknown occluder 'spere'; did you mean 'sphere'"):
        occluder("spere")
    with pytest.raises(RadiokitError, match="occluder 'sphere' needs radius"):
        occluder("sphere", center=(0, 0, 1))


BAD = [
    ("sphere", {"center": (0, 0, 1), "radius": 0}, "radius = 0"),
    ("sphere", {"center": (0, 0, math.nan), "radius": 1}, "center = "),
    ("disk", {"center": (0, 0, 1), "normal": (0, 0, 0), "radius": 1}, "normal = "),
    ("disk", {"center": (0, 0, 1), "normal": (0, 0, 1), "radius": math.nan}, "radius = nan"),
    ("polygon", {"vertices": [(0, 0, 1), (1, 1, 1), (1, 0, 1), (0, 2, 1)]}, "meets no other"),
    ("polygon", {"vertices": [(0, 0, 1), (1, 1, 1)]}, "at least 3 vertices"),
    ("polygon", {"vertices": [(0, 0, 1), (1, 1, 1), (1, 0, math.inf)]}, "finite numbers"),
]


@pytest.mark.parametrize(("name", "parameters", "message"), BAD)
def test_bad_parameters_are_one_clear_error(name, parameters, message):
    with pytest.raises(ParameterError, match=message):
        occluder(name, **parameters)


@pytest.mark.parametrize(
    "item",
    [ball(0, 0, 1, 1), ball(0.1, 0.2, 0.2, 0.3), screen(0.5, 0, 0, 1), level(-1, 1, -1, 1, 0.0)],
    ids=str,
)
def test_a_receiver_on_an_occluder_is_one_clear_error(item):
    for light in (SKY, sun(), panel(2.0), emitter("point", position=(0, 0, 2), intensity=1.0)):
        for call in (
            lambda light=light: irradiance(light, occluders=item),
            lambda light=light: shade(Lambert(reflectance=0.5), light, UP, occluders=item),
            lambda light=light: solid_angle(light, occluders=item),
        ):
            with pytest.raises(ParameterError, match="position = "):
                call()


@pytest.mark.parametrize("wrong", [None, 3, "sphere", [None], [ball(0, 0, 1, 0.5), sun()]])
def test_what_is_no_occluder_is_one_clear_error(wrong):
    for call in (
        lambda: irradiance(SKY, occluders=wrong),
        lambda: solid_angle(SKY, occluders=wrong),
        lambda: shade(Lambert(reflectance=0.5), SKY, UP, occluders=wrong),
        lambda: explain(Lambert(reflectance=0.5), SKY, occluders=wrong),
    ):
        with pytest.raises(ParameterError, match="an occluder, such as"):
            call()
