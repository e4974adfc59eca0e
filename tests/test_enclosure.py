"""Enclosure: walks against closed forms, their statistics, and the rooms in which there is no answer."""

from __future__ import annotations

import dataclasses
import math
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.bsdfs.dielectric import Dielectric
from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.emitters.directional import Directional
from radiokit.emitters.point import Point
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.spot import Spot
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.statistics import binomial_interval, sidak, z_test
from radiokit.worlds.cases.catalogue import case
from radiokit.worlds.enclosure import (
    Box,
    Cap,
    Sphere,
    Wall,
    enclosure_radiance,
    flux,
    irradiance,
    radiance,
)

LEVEL = sidak(1e-3, 60)  # all statistical tests in this file


@pytest.mark.parametrize(
    ("reflectance", "samples"), [(0.0, 100), (0.1, 20_000), (0.5, 20_000), (0.9, 20_000), (0.99, 4000)]
)
def test_the_geometric_series(reflectance, samples, seed):
    found = enclosure_radiance(Lambert(reflectance=reflectance), samples=samples, rng=seed)
    assert z_test(found, 1 / (1 - reflectance)) > LEVEL
    # Roulette makes the number of bounces geometric: its deviation is √ρ/(1 − ρ).
    deviation = math.sqrt(reflectance) / (1 - reflectance)
    assert found.error == pytest.approx(deviation / math.sqrt(samples), rel=0.1, abs=1e-12)


def test_a_planted_wrong_walk_is_rejected(seed):
    """A wall that forgets the cosine's normalisation, 1/2π for 1/π, is half as bright."""
    found = enclosure_radiance(lambda wi, wo: 0.5 / (2 * np.pi), samples=20_000, rng=seed)
    assert z_test(found, 1 / (1 - 0.5)) < 1e-9
    assert z_test(found, 1 / (1 - 0.25)) > LEVEL


def test_radius_and_emission(seed):
    room = partial(enclosure_radiance, Lambert(reflectance=0.5), samples=5000, rng=seed)
    base = room()
    assert room(radius=1e-3).value == pytest.approx(base.value, rel=1e-12)
    assert room(radius=1e6).value == pytest.approx(base.value, rel=1e-12)
    assert room(emitted=3.0).value == pytest.approx(3 * base.value, rel=1e-12)
    assert room(emitted=0.0).value == 0.0


@pytest.mark.parametrize("f", [Phong(exponent=5, reflectance=0.8), GGX(alpha=0.7, eta=0.2, k=3.0)], ids=repr)
def test_other_walls_solve_the_rendering_equation(f, seed):
    """A chord of a sphere leaves and arrives at one angle, so L(θo) = Le + ∫ f L(θi) cosθi dω."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    theta = (nodes + 1) * np.pi / 4
    wo = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
    phi = (np.arange(128) + 0.5) * np.pi / 64

    kernel = np.empty((24, 24))  # ∫ f dφ cosθi sinθi dθi
    for j, (t, w) in enumerate(zip(theta, weights, strict=True)):
        wi = np.stack([np.sin(t) * np.cos(phi), np.sin(t) * np.sin(phi), np.full(128, np.cos(t))], axis=-1)
        for i in range(24):
            values = f.evaluate(wi, np.broadcast_to(wo[i], wi.shape))
            kernel[i, j] = values.mean() * 2 * np.pi * np.cos(t) * np.sin(t) * w * np.pi / 4
    radiance = np.linalg.solve(np.eye(24) - kernel, np.ones(24))
    first = hemisphere(lambda w: f.evaluate(w, np.tile(wo[10], (len(w), 1))) * w[:, 2], wo=wo[10])
    assert kernel[10].sum() == pytest.approx(first.value, rel=1e-3)
    found = enclosure_radiance(f, wo=wo[10], samples=20_000, rng=seed)
    assert found.error < 0.02 * radiance[10]
    assert abs(found.value - radiance[10]) < 4.5 * found.error + 1e-3 * radiance[10]


def test_a_mirror_sees_itself_for_ever(seed):
    assert z_test(enclosure_radiance(Mirror(reflectance=0.75), samples=20_000, rng=seed), 4.0) > LEVEL


def test_spectra(seed):
    found = enclosure_radiance(
        lambda wi, wo: np.full((len(wi), 2), (0.2, 0.8)) / np.pi, samples=20_000, rng=seed
    )
    assert np.all(z_test(found, np.array([1.25, 5.0])) > LEVEL)


def test_intervals_cover(seed):
    seeds = np.random.SeedSequence(seed).generate_state(200, dtype=np.uint64)
    wall = Lambert(reflectance=0.5)
    hits = sum(enclosure_radiance(wall, samples=500, rng=int(each)).covers(2.0) for each in seeds)
    low, high = binomial_interval(hits, 200, level=1 - LEVEL)
    assert low <= 0.95 <= high


def test_the_same_seed_gives_the_same_answer(seed):
    run = partial(enclosure_radiance, Lambert(reflectance=0.8), samples=20_000)
    with ThreadPoolExecutor(2) as two:
        assert run(rng=seed).value == run(rng=seed, executor=two).value != run(rng=seed + 1).value


@pytest.mark.parametrize(
    "f", [Lambert(reflectance=1.0), Mirror(), lambda wi, wo: 1.2 / np.pi], ids=["lambert", "mirror", "gain"]
)
def test_a_room_that_absorbs_nothing_is_refused(f):
    with pytest.raises(ParameterError, match="diverges"):
        enclosure_radiance(f, samples=100, rng=1)


def test_a_room_that_absorbs_next_to_nothing_ends_with_an_error():
    with pytest.raises(RadiokitError, match="there is no end"):
        enclosure_radiance(Lambert(reflectance=0.99999), samples=10, rng=1)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("emitted", {"emitted": -1.0}),
        ("emitted", {"emitted": math.nan}),
        ("radius", {"radius": 0.0}),
        ("radius", {"radius": math.inf}),
        ("wo", {"wo": (0, 0, -1)}),
        ("wo", {"wo": (0, 0, 3)}),
        ("samples", {"samples": 1}),
        ("function", {"f": None}),
    ],
    ids=str,
)
def test_bad_arguments_are_named(name, change):
    with pytest.raises(ParameterError, match=name):
        enclosure_radiance(**({"f": Lambert(reflectance=0.5)} | change))


# --- rooms with parts and lamps ---


def grey(reflectance, emitted=0.0):
    return Wall(f=Lambert(reflectance=reflectance), emitted=emitted)


CAPS = (
    Cap(direction=(0, 0, 1), half_angle=0.7),
    Cap(direction=(3, 0, -1), half_angle=0.5, wall=grey(0.2, 0.5)),
    Cap(direction=(-1, 2, 0), half_angle=0.3, wall=grey(0.95)),
)
LAMPS = (
    Point(position=(1.0, 2.5, 4.2), intensity=2.0),  # behind the rim of the first cap
    Point(position=(1.4, 2.0, 2.0), intensity=1.0),
)
BALL = Sphere(wall=grey(0.8, 0.1), caps=CAPS, lights=LAMPS, radius=2.0, center=(1, 2, 3))
PLACES = {0: (1, 2, 1), 1: (1, 2, 5), 2: (1 + 6 / math.sqrt(10), 2, 3 - 2 / math.sqrt(10))}


@pytest.mark.parametrize("part", [0, 1, 2, 3])
def test_what_falls_on_each_part_of_a_sphere(part, seed):
    walk = flux(BALL, part=part, method="random walk", samples=8000, rng=seed)
    exact = flux(BALL, part=part)
    assert exact.method == "closed form"
    assert z_test(walk, exact.value) > LEVEL
    assert walk.error < 0.05 * exact.value


@pytest.mark.parametrize("part", PLACES)
def test_what_a_point_of_a_sphere_receives_and_sends(part, seed):
    ask = {"position": PLACES[part], "samples": 8000, "rng": seed}
    walk, exact = irradiance(BALL, method="random walk", **ask), irradiance(BALL, **ask)
    assert z_test(walk, exact.value) > LEVEL
    inward = np.subtract(BALL.center, PLACES[part]) / 2
    walk = radiance(BALL, direction=inward, method="random walk", **ask)
    wall = BALL.parts[part]
    rho = 0.0 if wall.black else wall.f.reflectance
    leaving = radiance(BALL, direction=inward, **ask)
    assert leaving.value == pytest.approx(wall.emitted + rho * exact.value / math.pi, rel=1e-13)
    assert z_test(walk, leaving.value) > LEVEL or (walk.error < 1e-12 and leaving.value == 0)


def test_energy_is_neither_lost_nor_gained():
    sent = 4 * math.pi * 3.0 + sum(math.pi * BALL.area(k) * wall.emitted for k, wall in enumerate(BALL.parts))
    kept = [flux(BALL, part=k).scaled(1 - rho) for k, rho in enumerate((0.8, 0.0, 0.2, 0.95))]
    assert sum(each.value for each in kept) == pytest.approx(sent, rel=1e-13)
    assert abs(sum(each.value for each in kept) - sent) <= sum(each.error for each in kept)


@pytest.mark.parametrize("height", [-0.999, -0.5, 0.0, 0.3, 0.5, 0.7, 0.99])
@pytest.mark.parametrize("half_angle", [1e-3, math.pi / 3, 3.0])
def test_a_lamp_on_the_axis_of_a_cap_at_50_digits(height, half_angle):
    """A white sphere with a black cap returns to it all that falls elsewhere: only the solid angle counts."""
    cap = Cap(direction=(0, 0, 1), half_angle=half_angle)
    lamp = Point(position=(0, 0, height), intensity=1.0)
    found = flux(Sphere(wall=grey(0.5), caps=[cap], lights=lamp), part=1)
    with mpmath.workdps(50):
        theta, z = mpf(half_angle), mpf(height)
        depth = mpmath.cos(theta) - z
        solid = 2 * mpmath.pi * (1 - depth / mpmath.sqrt(depth**2 + mpmath.sin(theta) ** 2))
        f = mpmath.sin(theta / 2) ** 2
        mean = f + (1 - f) / 2
        truth = solid + f * (4 * mpmath.pi - solid) / 2 / mean
        assert abs(truth - mpf(found.value)) <= mpf(found.error)
        assert found.error <= 1e-11 * truth + 1e-12


def test_solid_angles_of_caps_from_anywhere(rng):
    """By summing cosθ/d² over the cap."""
    room = Sphere(wall=grey(0.5), caps=[Cap(direction=(0, 0, 1), half_angle=1.1)])
    x, w = np.polynomial.legendre.leggauss(40)
    h = (x + 1) / 2 * math.sin(0.55) ** 2
    phi = (np.arange(256) + 0.5) * np.pi / 128
    r = 2 * np.sqrt(h * (1 - h))[:, None]
    points = np.stack(
        [r * np.cos(phi), r * np.sin(phi), np.broadcast_to(1 - 2 * h[:, None], (40, 256))], axis=-1
    )
    for place in rng.uniform(-0.5, 0.5, (20, 3)):
        way = points - place
        square = (way**2).sum(axis=-1)
        values = (way * points).sum(axis=-1) / square**1.5
        summed = 2 * np.pi * math.sin(0.55) ** 2 * float(w @ values.mean(axis=1))
        angles, error = room.solid_angles(place)
        assert angles[1] == pytest.approx(summed, rel=1e-9)
        assert angles.sum() == pytest.approx(4 * np.pi, rel=1e-14)
        assert error < 1e-12


def test_white_spheres_keep_their_digits():
    """ρ one unit below 1, and a small hole: the balance is a sum of what is lost."""
    rho = 1 - 2.0**-53
    hole = Cap(direction=(0, 0, 1), half_angle=1e-6)
    lamp = Point(position=(0, 0, 0), intensity=1.0)
    found = irradiance(Sphere(wall=grey(rho), caps=[hole], lights=lamp), position=(0, 0, -1))
    with mpmath.workdps(50):
        f = mpmath.sin(mpf(1e-6) / 2) ** 2
        truth = 1 / (f + (1 - f) * (1 - mpf(rho)))
        assert abs(mpf(found.value) - truth) <= mpf(found.error)
        assert found.error <= 1e-14 * truth


def test_a_walk_that_forgets_the_port_is_rejected(seed, monkeypatch):
    problem = case("integrating-sphere-one-port")
    assert problem.verdict("random walk", seed, samples=8000).ok
    monkeypatch.setattr(Sphere, "part_of", lambda self, position: np.zeros(len(position), dtype=np.intp))
    assert str(problem.verdict("random walk", seed, samples=8000).outcome) == "violated"


def test_a_walk_that_goes_astray_is_rejected(seed, monkeypatch):
    problem = case("furnace-box")
    follow = Box.follow
    monkeypatch.setattr(Box, "follow", lambda self, p, w: follow(self, p, w * (1, 1, 2)))
    assert problem.verdict("random walk", seed, samples=8000).ok  # a furnace cannot see where paths go
    problem = case("black-box-next-wall")
    assert str(problem.verdict("random walk", seed, samples=60_000).outcome) == "violated"


def test_lamps_are_asked_by_their_contract(seed):
    """A spot that shines everywhere is a point."""
    point = Point(position=(0.1, 0.2, 0.3), intensity=2.0)
    spot = Spot(position=(0.1, 0.2, 0.3), direction=(1, 0, 0), intensity=2.0, outer=math.pi, inner=math.pi)
    one, other = (
        radiance(
            Box(walls=grey(0.5), low=(-1, -1, -1), lights=light),
            position=(0.5, 0.5, -1),
            direction=(0, 0, 1),
            samples=500,
            rng=seed,
        )
        for light in (point, spot)
    )
    assert one.value == pytest.approx(other.value, rel=1e-12)
    assert one.method == "random walk"


def test_a_spot_in_a_sphere_of_one_piece(seed):
    spot = Spot(position=(0.2, 0, 0.5), direction=(0, 0.3, -1), intensity=2.0, outer=0.7, inner=0.4)
    room = Sphere(wall=grey(0.6, 0.1), lights=spot)
    for place, lit in (((0, 0, -1), True), ((0, 0, 1), False)):
        ask = {"position": place, "samples": 1000, "rng": seed}
        exact = irradiance(room, **ask)
        assert exact.method == "closed form"
        assert z_test(irradiance(room, method="random walk", **ask), exact.value) > LEVEL
        added = (math.pi * 0.1 * 4 * math.pi + 0.6 * spot.flux().value) / (4 * math.pi * 0.4)
        assert (exact.value > added * (1 + 1e-9)) == lit
        assert lit or exact.value == pytest.approx(added, rel=1e-13)
    total = flux(room, part=0)
    assert total.value * 0.4 == pytest.approx(spot.flux().value + 0.1 * math.pi * 4 * math.pi, rel=1e-13)
    with pytest.raises(RadiokitError, match="no closed form"):
        flux(dataclasses.replace(room, caps=CAPS[:1]), part=0, method="closed form")


def test_a_box_lit_by_a_lamp_sends_on_what_it_gets(seed):
    """The lamp's flux is absorbed by six walls of six reflectances, to within the walks' errors."""
    rho = (0.0, 0.2, 0.5, 0.7, 0.9, 0.4)
    room = Box(
        walls=[grey(r) for r in rho], high=(1, 2, 3), lights=Point(position=(0.2, 0.5, 2.5), intensity=1.0)
    )
    kept = [flux(room, part=k, samples=4000, rng=seed + k).scaled(1 - r) for k, r in enumerate(rho)]
    total = kept[0]
    for each in kept[1:]:
        total = total + each
    assert z_test(total, 4 * math.pi) > LEVEL


def test_rays_in_a_box_end_on_its_faces(rng):
    room = Box(walls=grey(0.5), low=(-1, 0, 2), high=(1, 5, 2.5))
    for part in range(6):
        start = room.spread(rng, 500, part)
        assert np.all(room.part_of(start) == part)
        inward = room.normals(start, np.full(500, part))
        w = rng.normal(size=(500, 3))
        w /= np.linalg.norm(w, axis=1)[:, None]
        w *= np.sign((w * inward).sum(axis=1))[:, None]
        end = room.follow(start, w)
        assert np.all((end >= room.low) & (end <= room.high))
        assert np.all(room.part_of(end) != part)
        off = np.abs(end[:, None, :] - np.array([room.low, room.high]))
        assert np.all(off.min(axis=(1, 2)) == 0)  # exactly on a face
        way = end - start
        aside = np.cross(way, w)
        assert np.abs(aside).max() < 1e-13
    edge = room.follow(np.array([[-1.0, 0.0, 2.0]]), np.array([[0.0, 0.0, 1.0]]))
    assert edge.tolist() == [[-1.0, 0.0, 2.5]]


def test_wavelengths_share_their_paths(seed):
    rho = [0.2, 0.5, 0.9]
    room = Sphere(wall=grey(rho), caps=CAPS[:1], lights=Point(position=(0.3, 0, 0), intensity=1.0))
    ask = {"position": (0, 0, -1), "direction": (0, 0.6, 0.8)}
    walk = radiance(room, method="random walk", samples=8000, rng=seed, **ask)
    exact = radiance(room, **ask)
    assert np.all(z_test(walk, exact.value) > LEVEL)
    for k, r in enumerate(rho):
        alone = Sphere(wall=grey(r), caps=CAPS[:1], lights=room.lights)
        assert radiance(alone, **ask).value == pytest.approx(exact.value[k], rel=1e-14)


def test_lamps_have_wavelengths_too(seed):
    strengths, rho = (1.0, 3.0), (0.3, 0.6)
    spectral = Point(position=(0.3, 0, 0), intensity=strengths)
    room = Sphere(wall=grey(rho), caps=CAPS[:1], lights=spectral)
    ask = {"position": (0, 0, -1), "direction": (0, 0.6, 0.8)}
    walk = radiance(room, method="random walk", samples=8000, rng=seed, **ask)
    exact, whole = radiance(room, **ask), flux(room, part=1)
    assert np.all(z_test(walk, exact.value) > LEVEL)
    panel = Rectangle(center=(0.5, 0.5, 1), normal=(0, 0, -1), width=0.5, height=0.25, radiance=strengths)
    boxes = Box(walls=grey(rho), lights=panel)
    lit = radiance(boxes, position=(0.5, 0.5, 0), direction=(0, 0, 1), samples=4000, rng=seed)
    for k, (r, strength) in enumerate(zip(rho, strengths, strict=True)):
        alone = Sphere(wall=grey(r), caps=CAPS[:1], lights=Point(position=(0.3, 0, 0), intensity=strength))
        assert radiance(alone, **ask).value == pytest.approx(exact.value[k], rel=1e-14)
        assert flux(alone, part=1).value == pytest.approx(whole.value[k], rel=1e-14)
        one = Box(walls=grey(r), lights=dataclasses.replace(panel, radiance=strength))
        found = radiance(one, position=(0.5, 0.5, 0), direction=(0, 0, 1), samples=4000, rng=seed)
        assert abs(found.value - lit.value[k]) < 5 * np.hypot(found.error, lit.error[k])
    with pytest.raises(ParameterError, match="of one number of wavelengths"):
        Sphere(wall=grey((0.1, 0.2, 0.3)), lights=spectral)


def test_a_question_stops_when_it_is_told(seed):
    room = Box(walls=grey(0.5, 1.0))
    ask = {"position": (0.5, 0.5, 0), "direction": (0, 0, 1), "method": "random walk", "rng": seed}
    quick = radiance(room, rtol=0.01, **ask)
    assert quick.converged
    assert quick.error <= 0.01 * quick.value
    assert radiance(room, seconds=0.02, **ask).evaluations >= 8192
    with ThreadPoolExecutor(2) as two:
        alone, shared = (radiance(room, samples=20_000, executor=e, **ask) for e in (None, two))
        assert alone.value == shared.value


def test_many_points_at_once(seed):
    places, inward = [(0.5, 0.5, 0), (1, 0.3, 0.2)], [(0, 0, 1), (-0.6, 0.8, 0)]
    room = Box(walls=[grey(r, 0.2) for r in (0.0, 0.2, 0.5, 0.7, 0.9, 0.4)])
    ask = {"samples": 4000, "rng": seed}
    both = radiance(room, position=places, direction=inward, **ask)
    for k in range(2):
        one = radiance(room, position=places[k], direction=inward[k], samples=4000, rng=seed + 1)
        assert abs(one.value - both.value[k]) < 5 * math.hypot(one.error, both.error[k])
    assert irradiance(room, position=places, **ask).value.shape == (2,)
    exact = irradiance(BALL, position=list(PLACES.values()))
    assert exact.value[2] == irradiance(BALL, position=PLACES[2]).value
    three = Box(walls=grey([0.2, 0.5, 0.9], [1.0, 1.0, 1.0]))
    found = radiance(three, position=places, direction=inward, method="random walk", **ask)
    assert np.all(z_test(found, np.tile([1.25, 2.0, 10.0], (2, 1))) > LEVEL)
    with pytest.raises(ParameterError, match="shape"):
        radiance(room, position=places[0], direction=inward)


def test_an_emitting_face_of_a_black_box_is_a_rectangle(seed):
    room = Box(walls=[Wall(emitted=2.0), *[Wall()] * 5], high=(2, 3, 4))
    face = Rectangle(center=(0, 1.5, 2), normal=(1, 0, 0), width=3, height=4, up=(0, 0, 1), radiance=2.0)
    for place, normal in (((2, 1, 1), (-1, 0, 0)), ((0.5, 0, 3), (0, 1, 0)), ((1, 2, 4), (0, 0, -1))):
        walk = irradiance(room, position=place, samples=20_000, rng=seed)
        exact = face.irradiance_at(np.array(place, float), np.array(normal, float)).value
        assert walk.method == "random walk"
        assert z_test(walk, exact) > LEVEL


def test_a_panel_in_the_ceiling(seed):
    """What it sends directly has a closed form; all that it sends is absorbed."""
    panel = Rectangle(center=(0, 0, 1), normal=(0, 0, -1), width=0.6, height=0.6, radiance=12.0)
    black = Box(walls=Wall(), low=(-1, -1, -1), lights=panel)
    for place, normal in (((0.3, 0.9, -1), (0, 0, 1)), ((1, 0.2, 0.5), (-1, 0, 0))):
        found = irradiance(black, position=place, samples=8000, rng=seed)
        exact = panel.irradiance_at(np.array(place, float), np.array(normal, float))
        assert z_test(found, exact.value) > LEVEL
    rho = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
    room = Box(walls=[grey(r) for r in rho], low=(-1, -1, -1), lights=[panel])
    kept = [flux(room, part=k, samples=4000, rng=seed + k).scaled(1 - r) for k, r in enumerate(rho)]
    total = sum(each.value for each in kept)
    spread = math.sqrt(sum(each.error**2 for each in kept))
    assert abs(total - panel.flux().value) < 4.5 * spread
    shining = radiance(black, position=(0.1, 0.1, 1), direction=(0, 0, -1), samples=10, rng=seed)
    assert (shining.value, shining.error < 1e-13) == (12.0, True)
    mirror = Box(
        walls=[*[Wall()] * 4, Wall(f=0.25 * Mirror() + 0.25 * Lambert()), Wall()],
        low=(-1, -1, -1),
        lights=panel,
    )
    ask = {"position": (0.1, 0.1, -1), "samples": 4000, "rng": seed}
    found = radiance(mirror, direction=(0, 0, 1), **ask)  # the panel in the mirror, and on the paint
    lit = panel.irradiance_at(np.array(ask["position"]), np.array([0.0, 0.0, 1.0])).value
    assert z_test(found, 0.25 * 12.0 + 0.25 * lit / math.pi) > LEVEL
    for wrong in ({"normal": (0, 0, 1)}, {"center": (0.9, 0, 1)}, {"center": (0, 0, 0.5)}):
        with pytest.raises(ParameterError, match="in a face of the box"):
            Box(walls=grey(0.5), low=(-1, -1, -1), lights=dataclasses.replace(panel, **wrong))
    with pytest.raises(ParameterError, match="in a face of the box"):
        Sphere(wall=grey(0.5), radius=2, lights=panel)


@pytest.mark.parametrize("place", [(0, 0, -1), (0.6, 0.0, 0.8), (-0.48, 0.64, 0.6)])
def test_lamps_near_and_far_at_50_digits(place):
    """What four lamps send to a point, and what the sphere adds, for numbers as they are."""
    lamps = [(0.0, 0.0, -0.9999), (0.5, -0.3, 0.2), (-0.4, 0.5, 0.6), (0.59, 0.0, 0.79)]
    room = Sphere(wall=grey(0.9), lights=[Point(position=p, intensity=1.5) for p in lamps])
    found = irradiance(room, position=place)
    with mpmath.workdps(50):
        x = [mpf(float(c)) for c in place]
        length = mpmath.sqrt(sum(c * c for c in x))
        x = [c / length for c in x]
        direct = mpf(0)
        for lamp in lamps:
            way = [mpf(q) - c for q, c in zip(lamp, x, strict=True)]
            square = sum(c * c for c in way)
            direct += mpf(1.5) * -sum(c * n for c, n in zip(way, x, strict=True)) / square ** mpf(1.5)
        truth = direct + 4 * mpf(1.5) * mpf(0.9) / (1 - mpf(0.9))
        assert abs(truth - mpf(found.value)) <= mpf(found.error)
        assert found.error < 1e-9 * truth


@pytest.mark.parametrize(
    ("room", "value"),
    [
        (Box(walls=grey(0.5, 1.0)), 2.0),
        (Box(walls=[grey(r, 3 * (1 - r)) for r in (0.0, 0.3, 0.5, 0.6, 0.7, 0.999)]), 3.0),
        (Sphere(wall=Wall(f=Mirror(reflectance=0.5), emitted=0.5), caps=[CAPS[1]]), None),
        (Box(walls=[Wall(f=Mirror()), *[grey(0.5, 1.0)] * 5]), None),
        (Box(walls=Wall(f=GGX(alpha=0.5), emitted=1.0)), None),
        (Box(walls=grey(0.5, 1.0), lights=Point(position=(0.5, 0.5, 0.5), intensity=1.0)), None),
        (Box(walls=grey(0.5, 1.0), lights=Point(position=(0.5, 0.5, 0.5), intensity=0.0)), 2.0),
        (Sphere(wall=grey(0.5)), 0.0),
    ],
    ids=repr,
)
def test_where_there_is_a_closed_form(room, value):
    position = (0.5, 0.5, 0.0) if isinstance(room, Box) else (0, 0, -1)
    ask = partial(radiance, room, position=position, direction=(0, 0, 1), method="closed form")
    if value is None:
        with pytest.raises(RadiokitError, match="no closed form"):
            ask()
    else:
        assert abs(ask().value - value) <= ask().error + 1e-15


@pytest.mark.parametrize(
    ("message", "make"),
    [
        (
            "must not overlap",
            lambda: Sphere(wall=grey(0.5), caps=[CAPS[0], Cap(direction=(0, 1, 2), half_angle=0.2)]),
        ),
        ("half_angle = nan", lambda: Cap(direction=(0, 0, 1), half_angle=math.nan)),
        ("half_angle = 4", lambda: Cap(direction=(0, 0, 1), half_angle=4)),
        ("direction", lambda: Cap(direction=(0, 0, 0), half_angle=1)),
        ("inside the room", lambda: Sphere(wall=grey(0.5), lights=Point(position=(0, 0, 2), intensity=1))),
        ("inside the room", lambda: Box(walls=grey(0.5), lights=Point(position=(0, 0.5, 0.5), intensity=1))),
        (
            "point lights",
            lambda: Box(walls=grey(0.5), lights=[Directional(direction=(0, 0, 1), irradiance=1)]),
        ),
        ("or six", lambda: Box(walls=[grey(0.5)] * 5)),
        (r"walls\[2\]", lambda: Box(walls=[grey(0.5), grey(0.5), 0.5, *[grey(0.5)] * 3])),
        ("above low", lambda: Box(walls=grey(0.5), high=(1, 0, 1))),
        ("radius", lambda: Sphere(wall=grey(0.5), radius=math.nan)),
        ("center", lambda: Sphere(wall=grey(0.5), center=(0, math.nan, 0))),
        ("emitted", lambda: Wall(emitted=math.nan)),
        ("no light passes", lambda: Wall(f=Dielectric(eta=1.5))),
        (
            "number of wavelengths",
            lambda: Box(walls=[grey([0.1, 0.2]), grey(0.5, [1, 1, 1]), *[grey(0.5)] * 4]),
        ),
        (
            "diverges",
            lambda: radiance(Box(walls=grey(1.0, 1.0)), position=(0.5, 0.5, 0), direction=(0, 0, 1)),
        ),
        ("diverges", lambda: flux(Sphere(wall=Wall(f=Mirror(), emitted=1.0)), part=0)),
        ("on the room's wall", lambda: irradiance(BALL, position=(1, 2, 3))),
        ("on the room's wall", lambda: irradiance(Box(walls=grey(0.5)), position=(0.5, 0.5, 1.5))),
        ("position", lambda: irradiance(BALL, position=(1, math.nan, 3))),
        ("into the room", lambda: radiance(BALL, position=(1, 2, 1), direction=(0, 0, -1))),
        ("part = 4", lambda: flux(BALL, part=4)),
        ("a Sphere or a Box", lambda: flux(None, part=0)),
        ("samples", lambda: flux(BALL, part=0, method="random walk", samples=1)),
    ],
    ids=lambda x: x if isinstance(x, str) else "",
)
def test_wrong_rooms_and_questions_are_refused(message, make):
    with pytest.raises(ParameterError, match=message):
        make()


def test_an_unknown_method_is_named():
    with pytest.raises(UnknownNameError, match="random walk"):
        flux(BALL, part=0, method="walk")
