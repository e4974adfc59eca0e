"""Emitters: closed forms against 50 digits, samples against densities, and what they refuse."""

from __future__ import annotations

import math
import pickle

import mpmath
import numpy as np
import pytest

from radiokit.contracts.emitter import emitter, list_emitters
from radiokit.contracts.vectors import as_point, as_unit
from radiokit.emitters.constant import Constant
from radiokit.emitters.directional import Directional
from radiokit.emitters.disk import Disk
from radiokit.emitters.point import Point
from radiokit.emitters.sphere import Sphere
from radiokit.facts.directions import frame, to_local, unit
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.measure.quadrature import box
from radiokit.measure.statistics import chi_square, sidak
from radiokit.worlds.scene import Receiver, irradiance, solid_angle

ORIGIN = np.zeros(3)
UP = np.array([0.0, 0.0, 1.0])
LEVEL = sidak(1e-3, 8)  # all statistical tests in this file


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(50):
        yield


def exact(v):
    return [mpmath.mpf(float(x)) for x in v]


def inner(a, b):
    return mpmath.fsum(x * y for x, y in zip(a, b, strict=True))


def inside_bound(estimate, truth):
    return abs(mpmath.mpf(float(estimate.value)) - truth) <= mpmath.mpf(float(estimate.error))


# --- closed forms ---


@pytest.mark.parametrize("scale", [1.0, 1e-3, 1e6, 1e-140, 1e140])
def test_point_against_50_digits(scale, rng):
    for _ in range(20):
        light = Point(position=scale * rng.normal(size=3), intensity=rng.uniform(0.1, 10))
        normal = unit(rng.normal(size=3))
        d, n = exact(light.position), exact(normal)
        square = inner(d, d)
        truth = max(mpmath.mpf(0), mpmath.mpf(light.intensity) * inner(d, n) / square ** mpmath.mpf(1.5))
        found = irradiance(light, normal=normal)
        assert inside_bound(found, truth)
        # The bound is tight: some eps of the irradiance normal to the light.
        assert found.error <= 1e-14 * light.intensity / math.hypot(*light.position) ** 2


@pytest.mark.parametrize("from_horizon", [1.0, 1e-3, 1e-9, 1e-15, 0.0, -1e-15, -0.5])
def test_directional_cosine_near_the_horizon(from_horizon):
    light = Directional(direction=(math.cos(from_horizon), 0.0, math.sin(from_horizon)), irradiance=1000.0)
    truth = max(mpmath.mpf(0), 1000 * mpmath.sin(mpmath.mpf(from_horizon)))
    found = irradiance(light)
    assert inside_bound(found, truth)
    # The cosine of a receiver along z is a coordinate: relative accuracy, however small it is.
    assert abs(found.value - truth) <= 4e-16 * truth


@pytest.mark.parametrize("rest", [math.pi, 2.0, 1.0, 1e-3, 1e-8, 1e-150, 0.0])
def test_sky_on_a_tilted_receiver(rest, rng):
    """The tilt is given by what is missing to 180°, where 1 + cosβ cancels."""
    sky = Constant(radiance=2.0, normal=(0.0, 0.0, 1.0))
    normal = (math.sin(rest), 0.0, -math.cos(rest))
    truth = 2 * mpmath.pi * mpmath.sin(mpmath.mpf(rest) / 2) ** 2
    found = irradiance(sky, normal=normal)
    assert inside_bound(found, truth)
    assert abs(found.value - truth) <= 1e-15 * truth


def test_sky_of_any_zenith_against_50_digits(rng):
    for _ in range(40):
        zenith, normal = unit(rng.normal(size=(2, 3)))
        half = [(a + b) / 2 for a, b in zip(exact(zenith), exact(normal), strict=True)]
        truth = 3 * mpmath.pi * inner(half, half)
        found = irradiance(Constant(radiance=3.0, normal=zenith), normal=normal)
        assert inside_bound(found, truth)


def test_the_whole_sphere_gives_pi_and_4pi():
    for normal in ((0, 0, 1), (0, -2, 0)):
        assert irradiance(Constant(radiance=2.0), normal=normal).covers(2 * math.pi)
    assert solid_angle(Constant()).covers(4 * math.pi)
    assert solid_angle(Constant(normal=(1, 0, 0))).covers(2 * math.pi)


@pytest.mark.parametrize(
    "light", [Point(position=(0, 0, 1), intensity=1), Directional(direction=(0, 0, 1), irradiance=1)]
)
def test_delta_lights_subtend_nothing(light):
    found = solid_angle(light)
    assert found.value == found.error == 0.0


def test_isotropic_point_light_sends_out_4_pi_i():
    """Φ = ∮ E dA over a sphere around the light, whatever its radius."""
    light = Point(position=(1.0, -2.0, 0.5), intensity=3.0)

    def flux_density(p, radius):
        sine = np.sin(p[:, 0])
        out = np.stack([sine * np.cos(p[:, 1]), sine * np.sin(p[:, 1]), np.cos(p[:, 0])], axis=-1)
        places = np.array(light.position) + radius * out
        values = [float(light.irradiance_at(place, -w).value) for place, w in zip(places, out, strict=True)]
        return np.array(values) * radius**2 * sine

    for radius in (0.1, 7.0):
        found = box(lambda p, r=radius: flux_density(p, r), (0, 0), (np.pi, 2 * np.pi), rtol=1e-10)
        assert found.converged
        assert float(found.value) == pytest.approx(4 * np.pi * 3.0, rel=1e-10)


# --- samples and densities ---


def histogram(directions, axis):
    """Counts in cells of equal solid angle about ``axis``: 8 heights times 8 azimuths."""
    local = to_local(frame(axis), directions)
    height = np.clip(((local[:, 2] + 1) * 4).astype(int), 0, 7)
    turn = np.clip((np.arctan2(local[:, 1], local[:, 0]) / (2 * np.pi) % 1 * 8).astype(int), 0, 7)
    return np.bincount(height * 8 + turn, minlength=64).reshape(8, 8)


@pytest.mark.parametrize("normal", [None, (0.0, 0.0, 1.0), (0.3, -0.5, -0.8)])
@pytest.mark.parametrize("planted", [False, True], ids=["right", "planted"])
def test_samples_follow_the_density(normal, planted, rng):
    sky = Constant(normal=normal)
    count = 40_000
    u = rng.random((count, 2))
    if planted:  # crowded towards the zenith
        u[:, 0] **= 1.1
    directions, density = sky.sample(u, ORIGIN)
    axis = UP if normal is None else unit(normal)
    expected = np.full((8, 8), count / 64) if normal is None else np.full((8, 8), count / 32)
    if normal is not None:
        expected[:4] = 0.0
    p_value = chi_square(histogram(directions, axis), expected).p_value
    assert p_value < 1e-9 if planted else p_value > LEVEL
    assert np.allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-15)
    assert np.array_equal(density, sky.pdf(directions, ORIGIN))
    assert np.mean(1 / density) == pytest.approx(float(sky.solid_angle(ORIGIN).value), rel=1e-12)
    assert np.all(sky.radiance_from(directions, ORIGIN) == 1.0)


def test_a_sky_has_nothing_below_its_horizon():
    sky = Constant(radiance=2.0, normal=(0, 1, 0))
    directions = np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.6, 0.8], [0.0, -1e-9, 1.0]])
    assert sky.radiance_from(directions, ORIGIN).tolist() == [2.0, 0.0, 2.0, 0.0]
    assert (sky.pdf(directions, ORIGIN) > 0).tolist() == [True, False, True, False]


def test_irradiance_without_a_closed_form_is_integrated():
    class Unknown(Constant):
        def irradiance_at(self, position, normal):
            return None

    whole = irradiance(Unknown(radiance=2.0, normal=(0, 0, 1)), rtol=1e-10)
    assert whole.kind == "truncation"
    assert whole.covers(2 * np.pi)
    assert whole.converged
    # A receiver that the sky's horizon cuts has a kink inside the square; the bound must still hold.
    tilted = irradiance(Unknown(radiance=2.0, normal=(0, 0, 1)), normal=(1, 0, 0), rtol=1e-5)
    assert tilted.covers(np.pi)


# --- what is accepted and refused ---


def test_vectors_become_tuples_of_floats_and_directions_unit_vectors():
    light = Directional(direction=np.array([0, 3, 4]), irradiance=1)
    assert light.direction == (0.0, 0.6, 0.8)
    assert hash(light) == hash(Directional(direction=(0.0, 3 * 2.0**-900, 4 * 2.0**-900), irradiance=1))
    assert Directional(direction=light.direction, irradiance=1).direction == light.direction
    assert pickle.loads(pickle.dumps(light)) == light
    assert repr(Point(position=[1, 2, 3], intensity=4)) == "Point(position=(1.0, 2.0, 3.0), intensity=4.0)"


def test_normalising_is_idempotent(rng):
    for v in rng.normal(size=(200, 3)) * 10 ** rng.uniform(-300, 300, size=(200, 1)):
        once = as_unit("v", v)
        assert as_unit("v", once) == once
        assert abs(math.hypot(*once) - 1) <= 4e-16


BAD_VECTORS = [
    (0, 0),
    (0, 0, 1, 0),
    (math.nan, 0, 1),
    (math.inf, 0, 1),
    "up",
    None,
    5.0,
    [[0, 0, 1]],
    (True, False, True),
    (1j, 0, 0),
    (1, (2, 3), 4),
]


@pytest.mark.parametrize("bad", BAD_VECTORS, ids=str)
def test_bad_vectors_are_named(bad):
    for make, name in (
        (lambda: Point(position=bad, intensity=1), "position"),
        (lambda: Directional(direction=bad, irradiance=1), "direction"),
        (lambda: Sphere(center=bad, radius=1, radiance=1), "center"),
        (lambda: Disk(center=bad, normal=(0, 0, 1), radius=1, radiance=1), "center"),
        (lambda: Disk(center=(0, 0, 1), normal=bad, radius=1, radiance=1), "normal"),
        (lambda: as_point("here", bad), "here"),
        (lambda: Receiver(normal=bad), "normal"),
        (lambda: irradiance(Constant(), position=bad), "position"),
    ):
        with pytest.raises(ParameterError, match=name):
            make()
    if bad is not None:
        with pytest.raises(ParameterError, match="normal"):
            Constant(normal=bad)


def test_zero_directions_are_refused():
    for make in (
        lambda: Directional(direction=(0, 0, 0), irradiance=1),
        lambda: Constant(normal=(0, 0, 0)),
        lambda: Disk(center=(0, 0, 1), normal=(0, 0, 0), radius=1, radiance=1),
        lambda: irradiance(Constant(), normal=(0, 0, 0)),
    ):
        with pytest.raises(ParameterError, match="a nonzero vector"):
            make()


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf, "x"])
def test_bad_strengths_are_refused(bad):
    for make, name in (
        (lambda: Point(position=(0, 0, 1), intensity=bad), "intensity"),
        (lambda: Directional(direction=(0, 0, 1), irradiance=bad), "irradiance"),
        (lambda: Constant(radiance=bad), "radiance"),
        (lambda: Sphere(center=(0, 0, 1), radius=bad, radiance=1), "radius"),
        (lambda: Sphere(center=(0, 0, 1), radius=0.5, radiance=bad), "radiance"),
        (lambda: Disk(center=(0, 0, 1), normal=(0, 0, 1), radius=bad, radiance=1), "radius"),
        (lambda: Disk(center=(0, 0, 1), normal=(0, 0, 1), radius=1, radiance=bad), "radiance"),
        (lambda: Disk(center=(0, 0, 1), normal=(0, 0, 1), radius=1, radiance=1, exponent=bad), "exponent"),
    ):
        with pytest.raises(ParameterError, match=name):
            make()


def test_a_receiver_at_the_light_is_refused():
    light = Point(position=(1, 2, 3), intensity=1)
    with pytest.raises(ParameterError, match=r"position = \(1\.0, 2\.0, 3\.0\) .* away from the point light"):
        irradiance(light, position=(1, 2, 3))
    with pytest.raises(ParameterError, match="away from"):
        irradiance(Point(position=(0, 0, 1e-200), intensity=1))


def test_an_emitter_is_asked_for():
    for call in (irradiance, solid_angle):
        with pytest.raises(ParameterError, match="an emitter"):
            call("sun")


def test_delta_lights_have_no_radiance_and_others_no_incident_rays():
    light = Point(position=(0, 0, 1), intensity=1)
    for call in (
        lambda: light.radiance_from(UP[None], ORIGIN),
        lambda: light.sample(np.zeros((1, 2)), ORIGIN),
        lambda: light.pdf(UP[None], ORIGIN),
        lambda: Constant().incident(ORIGIN),
    ):
        with pytest.raises(RadiokitError, match="delta light"):
            call()


def test_the_registry_knows_them():
    assert {"point", "directional", "constant", "sphere", "disk"} <= set(list_emitters())
    assert {"point", "directional", "constant", "spot", "goniometric"} <= set(list_emitters())
    assert {"sky_overcast", "sky_gradient", "environment"} <= set(list_emitters())
    known = {"point", "directional", "constant", "polygon", "rectangle", "triangle"}
    assert known <= set(list_emitters())
    assert emitter("constant", radiance=2) == Constant(radiance=2.0)
    with pytest.raises(UnknownNameError, match="did you mean 'point'"):
        emitter("pont")
    with pytest.raises(RadiokitError, match="needs position, intensity"):
        emitter("point")
