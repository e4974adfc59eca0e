"""Skies and environment maps: closed forms against 40 digits, samples against densities, what they refuse."""

from __future__ import annotations

import math
import pickle

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.contracts.emitter import emitter
from radiokit.emitters.constant import Constant
from radiokit.emitters.environment import Environment
from radiokit.emitters.sky_gradient import SkyGradient
from radiokit.emitters.sky_overcast import SkyOvercast
from radiokit.facts.directions import frame, to_local, unit
from radiokit.facts.errors import ParameterError
from radiokit.measure.cancelling import sine_minus_x_cosine, x_minus_sine
from radiokit.measure.latlong import cell_edges, cell_projections, cell_solid_angles
from radiokit.measure.quadrature import box
from radiokit.measure.statistics import chi_square, sidak
from radiokit.measure.twin import ulps
from radiokit.worlds.scene import irradiance, solid_angle

ORIGIN = np.zeros(3)
UP = np.array([0.0, 0.0, 1.0])

SKIES = {
    "overcast": SkyOvercast(radiance=2.0),
    "linear": SkyGradient(radiance=3.0, horizon=0.5),
    "bright horizon": SkyGradient(radiance=0.5, horizon=4.0, curvature=-0.5),
    "quadratic": SkyGradient(radiance=2.0, horizon=0.0, curvature=1.0),
    "dome": SkyGradient(radiance=1.0, horizon=0.25, curvature=-1.0),
    "uniform": SkyGradient(radiance=1.5, horizon=1.5),
}
MAPS = {
    "uneven": Environment(radiance=(np.arange(24).reshape(4, 6) * 0.618 % 1) ** 3),
    "tilted": Environment(radiance=np.arange(12.0).reshape(3, 4), normal=(1, 2, -2), forward=(0, 1, 0)),
    "one cell": Environment(radiance=np.eye(5, 8)[2][None, :] * np.eye(5)[1][:, None]),
    "one row": Environment(radiance=[[0.0, 1.0, 0.0, 2.0, 0.0]]),
    "furnace": Environment(radiance=np.ones((2, 3))),
}
LEVEL = sidak(1e-3, len(SKIES) + len(MAPS))


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(40):
        yield


def law(sky, c):
    """The radiance at the cosine ``c``, as the emitters' docstrings state it."""
    if isinstance(sky, SkyOvercast):
        return mpf(sky.radiance) * (1 + 2 * c) / 3
    high, low, q = mpf(sky.radiance), mpf(sky.horizon), mpf(sky.curvature)
    return low + (high - low) * ((1 - q) * c + q * c * c)


def clipped(a, b, start, stop):
    """∫ max(0, a cosφ + b) dφ over [start, stop], for a ≥ 0: a sum over what each turn shows."""
    if b >= a:
        return a * (mpmath.sin(stop) - mpmath.sin(start)) + b * (stop - start)
    if b <= -a:
        return mpf(0)
    edge, total = mpmath.acos(-b / a), mpf(0)
    for turn in range(-2, 3):
        low = max(start, 2 * mpmath.pi * turn - edge)
        high = min(stop, 2 * mpmath.pi * turn + edge)
        if low < high:
            total += a * (mpmath.sin(high) - mpmath.sin(low)) + b * (high - low)
    return total


def on_slope(sky, tilt):
    """E in rings about the zenith, each clipped by the receiver's horizon: not the code's coordinates."""

    def ring(theta):
        a, b = mpmath.sin(theta) * mpmath.sin(tilt), mpmath.cos(theta) * mpmath.cos(tilt)
        return law(sky, mpmath.cos(theta)) * mpmath.sin(theta) * clipped(a, b, -mpmath.pi, mpmath.pi)

    bend = abs(mpmath.pi / 2 - tilt)
    inner = [bend] if mpf("1e-30") < bend < mpmath.pi / 2 - mpf("1e-30") else []
    return mpmath.quad(ring, [0, *inner, mpmath.pi / 2])


# --- differences that would cancel ---


@pytest.mark.parametrize("x", [1e-150, 1e-8, 1e-3, 0.1, 0.7, 0.9999, 1.0, 1.3, 2.0, 3.0, math.pi, -0.3, -2.0])
def test_differences_of_sines_keep_their_digits(x):
    with mpmath.workdps(400):
        exact = mpf(x)
        if abs(x) > 1e-100:
            assert ulps(float(x_minus_sine(x)), exact - mpmath.sin(exact)) <= 4
            assert ulps(float(sine_minus_x_cosine(x)), mpmath.sin(exact) - exact * mpmath.cos(exact)) <= 8
        else:
            assert float(x_minus_sine(x)) == float(sine_minus_x_cosine(x)) == 0.0


# --- skies ---


@pytest.mark.parametrize("tilt_deg", [0, 17, 45, 90, 101, 150, 179])
@pytest.mark.parametrize("name", SKIES)
def test_a_sky_on_a_tilted_receiver(name, tilt_deg):
    sky, tilt = SKIES[name], math.radians(tilt_deg)
    normal = (math.sin(tilt), 0.0, math.cos(tilt))
    truth = on_slope(sky, mpmath.atan2(mpf(normal[0]), mpf(normal[2])))
    found = irradiance(sky, normal=normal)
    assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error))
    assert found.error <= 1e-13 * float(truth) + 4e-15
    assert found.method == "closed form"


@pytest.mark.parametrize("rest", [1e-2, 1e-5, 1e-9, 1e-120])
def test_the_sliver_of_sky_that_a_ceiling_sees(rest):
    """An overcast sky, where the receiver all but faces the ground; both moments come from series there."""
    found = irradiance(SkyOvercast(radiance=3.0), normal=(math.sin(rest), 0.0, -math.cos(rest)))
    with mpmath.workdps(400):
        r = mpf(rest)
        lune = mpmath.sin(r) - r * mpmath.cos(r)
        truth = mpmath.pi * mpmath.sin(r / 2) ** 2 + mpf(4) / 3 * lune
        assert abs(found.value - truth) <= 1e-14 * truth
        assert abs(found.value - truth) <= mpf(float(found.error))


def test_known_horizontal_irradiances():
    assert irradiance(SkyOvercast(radiance=9.0)).covers(7 * math.pi)
    assert irradiance(SkyGradient(radiance=3.0)).covers(2 * math.pi)  # ∫ 3c · c dω
    assert irradiance(SkyGradient(radiance=2.0, curvature=1.0)).covers(math.pi)
    wall = irradiance(SkyOvercast(radiance=1.0), normal=(1, 0, 0))
    assert wall.covers(math.pi / 6 + 4 / 9)
    # Steven, Unsworth (1980): b = 2, the part of a slope relative to the horizontal.
    beta = 0.7
    share = math.cos(beta / 2) ** 2 + 4 / (7 * math.pi) * (
        math.sin(beta) - beta * math.cos(beta) - math.pi * math.sin(beta / 2) ** 2
    )
    slope = irradiance(SkyOvercast(radiance=1.0), normal=(math.sin(beta), 0, math.cos(beta)))
    assert float(slope.value) == pytest.approx(7 * math.pi / 9 * share, rel=1e-14)


def test_a_gradient_without_slope_is_the_constant_sky(rng):
    for normal in unit(rng.normal(size=(20, 3))):
        zenith = unit(rng.normal(size=3))
        flat = irradiance(SkyGradient(radiance=2.0, horizon=2.0, normal=zenith), normal=normal)
        constant = irradiance(Constant(radiance=2.0, normal=zenith), normal=normal)
        assert abs(flat.value - constant.value) <= flat.error + constant.error


@pytest.mark.parametrize("name", SKIES)
def test_a_skys_radiance_is_its_law(name):
    sky = SKIES[name]
    c = np.linspace(1e-3, 1, 50)
    directions = np.stack((np.sqrt(1 - c * c), 0 * c, c), axis=-1)
    truth = [float(law(sky, mpf(x))) for x in c]
    assert np.allclose(sky.radiance_from(directions, ORIGIN), truth, rtol=1e-14)
    assert np.all(sky.radiance_from(-directions, ORIGIN) == 0)
    assert np.all(sky.pdf(-directions, ORIGIN) == 0)
    assert solid_angle(sky).covers(2 * math.pi)


@pytest.mark.parametrize("planted", [False, True], ids=["right", "planted"])
@pytest.mark.parametrize("name", SKIES)
def test_a_skys_samples_follow_its_law(name, planted, rng):
    zenith = unit(rng.normal(size=3))
    values = {
        f: getattr(SKIES[name], f) for f in ("radiance", "horizon", "curvature") if hasattr(SKIES[name], f)
    }
    sky = type(SKIES[name])(**values, normal=zenith)
    count = 40_000
    u = rng.random((count, 2))
    if planted:
        u[:, 0] **= 1.1
    directions, density = sky.sample(u, ORIGIN)
    local = to_local(frame(zenith), directions)
    height = np.clip((local[:, 2] * 8).astype(int), 0, 7)
    turn = np.clip((np.arctan2(local[:, 1], local[:, 0]) / (2 * np.pi) % 1 * 8).astype(int), 0, 7)
    observed = np.bincount(height * 8 + turn, minlength=64)
    bands = [float(mpmath.quad(lambda c: law(sky, c), [mpf(k) / 8, mpf(k + 1) / 8])) for k in range(8)]
    expected = np.repeat(np.array(bands) / sum(bands), 8) / 8 * count
    p_value = chi_square(observed, expected).p_value
    assert p_value < 1e-9 if planted else p_value > LEVEL
    assert np.array_equal(density, sky.pdf(directions, ORIGIN))
    lit = density > 0
    ratio = sky.radiance_from(directions[lit], ORIGIN) / density[lit]
    assert np.allclose(ratio, 2 * np.pi * sum(bands), rtol=1e-12)  # in proportion to the radiance
    assert np.allclose(np.linalg.norm(directions, axis=1), 1, atol=1e-15)


@pytest.mark.parametrize("name", SKIES)
def test_quantiles_reach_the_ends(name):
    directions, density = SKIES[name].sample(np.array([[0.0, 0.0], [0.5, 0.3], [1.0, 0.9]]), ORIGIN)
    assert directions[0, 2] == pytest.approx(0.0, abs=1e-15)
    assert directions[2, 2] == pytest.approx(1.0, abs=1e-15)
    assert np.all(np.isfinite(directions))
    assert density[1] > 0


def test_a_dark_sky_is_sampled_evenly(rng):
    for sky in (SkyOvercast(radiance=0.0), Environment(radiance=np.zeros((2, 2)))):
        directions, density = sky.sample(rng.random((100, 2)), ORIGIN)
        size = 2 * math.pi if isinstance(sky, SkyOvercast) else 4 * math.pi
        assert density == pytest.approx(1 / size)
        assert np.all(sky.radiance_from(directions, ORIGIN) == 0)
        assert irradiance(sky).value == 0


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf, "x"])
def test_bad_strengths_of_skies_are_refused(bad):
    for make, name in (
        (lambda: SkyOvercast(radiance=bad), "radiance"),
        (lambda: SkyGradient(radiance=bad), "radiance"),
        (lambda: SkyGradient(horizon=bad), "horizon"),
        (lambda: SkyGradient(curvature=2 if bad == -1.0 else bad), "curvature"),
    ):
        with pytest.raises(ParameterError, match=f"{name} = "):
            make()
    for bad_normal in ((0, 0, 0), (0, 1), None, "up"):
        for cls in (SkyOvercast, SkyGradient):
            with pytest.raises(ParameterError, match="normal"):
                cls(normal=bad_normal)


# --- environment maps ---


def cell_truth(rows, columns, normal, i, j):
    """∫ max(0, w·n) dω over a cell, in rings: closed in the azimuth, by quadrature in the polar angle."""
    x, y, z = (mpf(float(v)) for v in normal)
    length = mpmath.sqrt(x * x + y * y + z * z)
    across, along = mpmath.sqrt(x * x + y * y) / length, z / length
    start = 2 * mpmath.pi * j / columns - mpmath.atan2(y, x)
    stop = 2 * mpmath.pi * (j + 1) / columns - mpmath.atan2(y, x)
    low, high = mpmath.pi * i / rows, mpmath.pi * (i + 1) / rows

    def ring(theta):
        sine = mpmath.sin(theta)
        return sine * clipped(across * sine, along * mpmath.cos(theta), start, stop)

    tilt = mpmath.atan2(across, along)
    bends = [abs(mpmath.pi / 2 - tilt), mpmath.pi - abs(mpmath.pi / 2 - tilt)]
    bends += [mpmath.atan2(along, -across * mpmath.cos(phi)) % mpmath.pi for phi in (start, stop)]
    inner = sorted(b for b in bends if low + mpf("1e-20") < b < high - mpf("1e-20"))
    return mpmath.quad(ring, [low, *inner, high])


NORMALS = {
    "zenith": (0, 0, 1),
    "nadir": (0, 0, -1),
    "along an edge": (1, 0, 0),
    "wall": (0.6, -0.8, 0),
    "slope": (0.48, 0.36, 0.8),
    "ceiling": (0.1, 0.7, -0.7),
    "nearly up": (1e-9, 2e-9, 1),
}


@pytest.mark.parametrize("name", NORMALS)
def test_what_a_plane_sees_of_each_cell(name):
    normal, rows, columns = unit(NORMALS[name]), 3, 5
    seen, error = cell_projections(rows, columns, normal)
    for i in range(rows):
        for j in range(columns):
            with mpmath.workdps(25):
                truth = cell_truth(rows, columns, normal, i, j)
            assert abs(mpf(float(seen[i, j])) - truth) <= mpf(float(error[i, j])) + mpf("1e-22"), (i, j)
    assert np.max(error) < 2e-14


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (2, 4), (5, 1), (16, 32)])
def test_cells_add_up_to_the_hemisphere(shape, rng):
    rows, columns = shape
    assert columns * cell_solid_angles(rows, columns).sum() == pytest.approx(4 * math.pi, rel=1e-14)
    for normal in [*unit(rng.normal(size=(20, 3))), *map(unit, NORMALS.values())]:
        seen, error = cell_projections(rows, columns, normal)
        assert abs(seen.sum() - math.pi) <= error.sum() + 1e-14
        assert np.all(seen >= 0)


@pytest.mark.parametrize("name", MAPS)
def test_a_maps_irradiance_is_its_integral(name, rng):
    """Against a midpoint rule over the sphere, which knows neither cells nor horizon."""
    sky = MAPS[name]
    z = (np.arange(900) + 0.5) / 450 - 1
    phi = (np.arange(1800) + 0.5) / 900 * np.pi
    ring = np.sqrt(1 - z * z)
    w = np.stack(
        (ring[:, None] * np.cos(phi), ring[:, None] * np.sin(phi), np.broadcast_to(z[:, None], (900, 1800))),
        -1,
    ).reshape(-1, 3)
    radiance = sky.radiance_from(w, ORIGIN)
    for normal in (UP, *unit(rng.normal(size=(2, 3)))):
        rough = np.mean(radiance * np.maximum(w @ normal, 0)) * 4 * np.pi
        assert float(irradiance(sky, normal=normal).value) == pytest.approx(rough, rel=1e-2, abs=1e-3)
    assert np.mean(radiance > 0) * 4 * np.pi == pytest.approx(float(solid_angle(sky).value), rel=5e-3)


@pytest.mark.parametrize("planted", [False, True], ids=["right", "planted"])
@pytest.mark.parametrize("name", MAPS)
def test_a_maps_samples_follow_its_radiance(name, planted, rng):
    sky, count = MAPS[name], 40_000
    rows, columns = sky.radiance.shape
    u = rng.random((count, 2))
    if planted:
        u[:, 0] **= 1.1
    directions, density = sky.sample(u, ORIGIN)
    z = np.array(sky.normal)
    y = unit(np.cross(z, sky.forward))
    local = np.stack((directions @ np.cross(y, z), directions @ y, directions @ z), axis=-1)
    theta, phi = np.arccos(np.clip(local[:, 2], -1, 1)), np.arctan2(local[:, 1], local[:, 0]) % (2 * np.pi)
    # Four bins to a cell, so that samples are also seen to be even within.
    row = np.clip((theta / np.pi * 2 * rows).astype(int), 0, 2 * rows - 1)
    column = np.clip((phi / np.pi * columns).astype(int), 0, 2 * columns - 1)
    observed = np.bincount(row * 2 * columns + column, minlength=4 * rows * columns)
    expected = np.kron(sky.radiance, np.ones((2, 2))) * cell_solid_angles(2 * rows, 2 * columns)[:, None]
    p_value = chi_square(observed, expected.ravel() / expected.sum() * count).p_value
    assert p_value < 1e-6 if planted else p_value > LEVEL
    assert np.array_equal(density, sky.pdf(directions, ORIGIN))
    assert np.mean(density > 0) > 0.999
    lit = density > 0
    radiance = sky.radiance_from(directions[lit], ORIGIN)
    assert np.allclose(radiance / density[lit], expected.sum(), rtol=1e-12)
    assert np.allclose(np.linalg.norm(directions, axis=1), 1, atol=4e-16)


def test_the_corners_of_the_square_find_lit_cells():
    ends = np.array([0.0, 0.25, 0.5, 1 - 2**-53, 1.0])
    u = np.stack(np.meshgrid(ends, ends), axis=-1).reshape(-1, 2)
    dark_ends = np.zeros((4, 4))
    dark_ends[1:3, 1:3] = 1.0
    for sky in (*MAPS.values(), Environment(radiance=dark_ends)):
        directions, density = sky.sample(u, ORIGIN)
        assert np.all(np.isfinite(directions))
        assert np.all(np.isfinite(density))


def test_rows_go_down_from_the_zenith_and_columns_counterclockwise():
    sky = Environment(radiance=np.arange(1.0, 9.0).reshape(2, 4))
    a = math.sqrt(0.5)
    towards = [(0.1, 0.1, 1), (-0.1, 0.1, 1), (0.1, -0.1, 1), (a, a, -0.1), (a, -a, -0.1)]
    assert sky.radiance_from(unit(towards), ORIGIN).tolist() == [1.0, 2.0, 4.0, 5.0, 8.0]
    turned = Environment(radiance=sky.radiance, normal=(1, 0, 0), forward=(0, 1, 0))
    assert turned.radiance_from(unit([(1, 0.1, 0.1), (-0.1, 1, 1)]), ORIGIN).tolist() == [1.0, 5.0]


def test_a_map_of_a_half_space_is_the_constant_sky(rng):
    half = Environment(radiance=np.repeat([[2.0], [0.0]], 3, axis=1))
    for normal in unit(rng.normal(size=(20, 3))):
        one, other = (
            irradiance(half, normal=normal),
            irradiance(Constant(radiance=2.0, normal=UP), normal=normal),
        )
        assert abs(one.value - other.value) <= one.error + other.error


def test_the_irradiance_of_a_fine_map_is_sharp(rng):
    """A smooth sky, tabulated by its means over ever smaller cells: the error falls with their size."""
    truth = float(irradiance(SKIES["overcast"], normal=(0.6, 0, 0.8)).value)
    gaps = []
    for rows in (16, 32, 64):
        theta, _ = cell_edges(rows, 1)
        c = np.cos(theta)
        mean = np.where((c[:-1] + c[1:]) / 2 > 0, 2 * (1 + (c[:-1] + c[1:])) / 3, 0.0)
        sky = Environment(radiance=np.repeat(mean[:, None], 2 * rows, axis=1))
        found = irradiance(sky, normal=(0.6, 0, 0.8))
        assert found.error < 1e-9
        gaps.append(abs(float(found.value) - truth))
    assert gaps[0] > 3 * gaps[1] > 9 * gaps[2]


def test_irradiance_of_a_single_cell_by_quadrature():
    """The square from which it is sampled shows the same."""
    sky, normal = MAPS["one cell"], np.array([0.0, 0.0, 1.0])

    def arriving(u):
        w, density = sky.sample(u, ORIGIN)
        return sky.radiance_from(w, ORIGIN) * np.maximum(w @ normal, 0) / density

    found = box(arriving, (1e-9, 1e-9), (1 - 1e-9, 1 - 1e-9), rtol=1e-8)
    assert float(found.value) == pytest.approx(float(irradiance(sky).value), rel=1e-7)


def test_maps_are_values():
    one, two = (Environment(radiance=[[1, 2], [3, 4]]) for _ in range(2))
    assert one == two
    assert hash(one) == hash(two)
    assert one != Environment(radiance=[[1, 2], [3, 5]])
    assert one != Environment(radiance=[[1, 2], [3, 4]], forward=(0, 1, 0))
    assert one != 1
    assert "radiance=<2 x 2>" in repr(one)
    again = pickle.loads(pickle.dumps(one))
    assert again == one
    assert not again.radiance.flags.writeable
    source = np.ones((2, 2))
    sky = Environment(radiance=source)
    source[0, 0] = -1.0  # the map is a copy
    assert sky.radiance.min() == 1.0
    assert emitter("environment", radiance=[[1.0]]).dome(ORIGIN) == ()
    assert one.dome(ORIGIN) is None


@pytest.mark.parametrize(
    ("bad", "name"),
    [
        ([1.0, 2.0], r"radiance\.shape = \(2,\)"),
        (np.ones((2, 2, 3, 1)), r"radiance\.shape = \(2, 2, 3, 1\)"),
        (np.zeros((0, 3)), r"radiance\.shape"),
        ([[1.0, -1.0]], r"radiance\[0, 1\] = -1\.0"),
        ([[1.0], [math.nan]], r"radiance\[1, 0\] = nan"),
        ([[math.inf]], r"radiance\[0, 0\] = inf"),
        ([["x"]], "radiance = "),
        ([[1.0], [1.0, 2.0]], "radiance = "),
        (None, r"radiance\.shape"),
    ],
    ids=str,
)
def test_bad_maps_are_refused(bad, name):
    with pytest.raises(ParameterError, match=name):
        Environment(radiance=bad)


def test_forward_must_not_be_the_axis():
    with pytest.raises(ParameterError, match=r"forward = .* not parallel to normal"):
        Environment(radiance=[[1.0]], normal=(2, 0, 0))
    with pytest.raises(ParameterError, match="forward"):
        Environment(radiance=[[1.0]], forward=(0, 0))
