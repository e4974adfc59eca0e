"""Spot and goniometric lights: intensities and fluxes against 40 digits, and files that must be refused."""

from __future__ import annotations

import itertools
import math
import pickle

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.emitters.directional import Directional
from radiokit.emitters.goniometric import Goniometric
from radiokit.emitters.point import Point
from radiokit.emitters.spot import Spot
from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.measure.twin import ulps
from radiokit.physics.lm63 import read_lm63
from radiokit.worlds.scene import irradiance, solid_angle

UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(40):
        yield


# --- spot ---


def spot_law(cosine, inner, outer):
    low, high = mpmath.cos(mpf(outer)), mpmath.cos(mpf(inner))
    t = min(mpf(1), max(mpf(0), (cosine - low) / (high - low)))
    return t * t * (3 - 2 * t)


CONES = [(0.0, 0.5), (0.3, 0.4), (0.0, math.pi), (1.0, 2.5), (1e-6, 3e-6), (0.5, 0.5 + 1e-9)]


@pytest.mark.parametrize(("inner", "outer"), CONES)
def test_a_spots_irradiance_across_its_cone(inner, outer, rng):
    axis = unit(rng.normal(size=3))
    side = unit(np.cross(axis, rng.normal(size=3)))
    light = Spot(position=(1, 2, 3), direction=axis, intensity=5.0, inner=inner, outer=outer)
    for share in (0.0, 0.1, 0.5, 0.9, 1.0, 1.1):
        for angle in {inner * share, inner + (outer - inner) * share}:
            place = np.array(light.position) + 2 * (math.cos(angle) * axis + math.sin(angle) * side)
            direction, arriving = light.incident(place)
            away = [mpf(float(b)) - mpf(float(a)) for a, b in zip(light.position, place, strict=True)]
            square = mpmath.fsum(x * x for x in away)
            along = mpmath.fsum(x * mpf(float(a)) for x, a in zip(away, light.direction, strict=True))
            length = mpmath.sqrt(mpmath.fsum(mpf(float(a)) ** 2 for a in light.direction))
            # The axis as stored is off by some eps; haversines tell angles where cosines do not.
            truth = 5 * spot_law(along / mpmath.sqrt(square) / length, inner, outer) / square
            found = irradiance(light, position=place, normal=direction[0])
            assert abs(mpf(float(found.value)) - truth) <= mpf(float(found.error)) + mpf("1e-15")
            assert float(arriving[0]) == pytest.approx(float(found.value), rel=1e-15)
            if outer - inner > 1e-2:
                assert found.error <= 2e-13


@pytest.mark.parametrize(("inner", "outer"), [*CONES, (0.0, 1e-150), (0.7, 0.7)])
def test_a_spots_flux(inner, outer):
    found = Spot(position=(0, 0, 0), direction=UP, intensity=3.0, inner=inner, outer=outer).flux()
    with mpmath.workdps(400):
        a, b = mpf(inner), mpf(outer)
        truth = 6 * mpmath.pi * (1 - mpmath.cos(a))
        if b > a:
            truth += (
                6
                * mpmath.pi
                * mpmath.quad(lambda c: spot_law(c, inner, outer), [mpmath.cos(b), mpmath.cos(a)])
            )
        assert abs(found.value - truth) <= mpf(float(found.error))
        assert ulps(float(found.value), truth) <= 8 or float(found.value) == 0


def test_a_sharp_rim_belongs_to_the_cone():
    light = Spot(position=(0, 0, 0), direction=UP, intensity=2.0, inner=0.5, outer=0.5)
    for angle, inside in ((0.5 - 1e-12, 2.0), (0.5 + 1e-12, 0.0)):
        found = irradiance(light, position=(math.sin(angle), 0, math.cos(angle)), normal=(0, 0, -1))
        assert float(found.value) == pytest.approx(inside * math.cos(angle))
        assert found.error < 1e-14
    # On the rim rounding decides, and the bound says so.
    rim = irradiance(light, position=(math.sin(0.5), 0, math.cos(0.5)), normal=(0, 0, -1))
    assert rim.error > 1.0


def test_a_spot_over_the_whole_sphere_is_a_point_light(rng):
    light = Spot(position=(0, 0, 0), direction=UP, intensity=2.0, inner=math.pi, outer=math.pi)
    point = Point(position=(0, 0, 0), intensity=2.0)
    for place, normal in rng.normal(size=(20, 2, 3)):
        one, other = (irradiance(x, position=place, normal=normal) for x in (light, point))
        assert one.value == other.value
    assert light.flux().covers(float(point.flux().value))
    assert Directional(direction=UP, irradiance=1).flux() is None


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ({"inner": 0.6}, "inner = 0.6 is not allowed: it must be at most outer, 0.5"),
        ({"inner": -0.1}, "inner"),
        ({"outer": 0.0}, "outer"),
        ({"outer": 3.2}, "outer"),
        ({"outer": math.nan}, "outer"),
        ({"intensity": -1}, "intensity"),
        ({"direction": (0, 0, 0)}, "direction"),
        ({"position": (0, math.nan, 0)}, "position"),
    ],
    ids=str,
)
def test_bad_spots_are_refused(values, name):
    with pytest.raises(ParameterError, match=name):
        Spot(**{"position": (0, 0, 0), "direction": (0, 0, 1), "intensity": 1, "outer": 0.5} | values)


# --- goniometric ---

HEADER = "IESNA:LM-63-2002\n[TEST] none\n[LUMINAIRE] two lobes\n[MORE] made up\nTILT=NONE\n"


def ies(vertical, horizontal, candela, *, multiplier=1, ballast=1, kind=1):
    rows = [
        f"1 -1 {multiplier} {len(vertical)} {len(horizontal)} {kind} 2 0 0 0",
        f"{ballast} 1 40",
        " ".join(map(str, vertical)),
        ", ".join(map(str, horizontal)),
        *(" ".join(map(str, row)) for row in candela),
    ]
    return HEADER + "\n".join(rows) + "\n"


AXIAL = ies([0, 30, 90], [0], [[100, 60, 10]])
QUADRANT = ies([0, 45, 90], [0, 40, 90], [[50, 70, 0], [50, 30, 20], [50, 10, 80]], multiplier=2)
BILATERAL = ies([0, 60, 180], [0, 90, 180], [[9, 40, 5], [9, 20, 5], [9, 10, 5]], ballast=0.5)
SIDEWAYS = ies([90, 120, 180], [90, 180, 270], [[9, 40, 5], [9, 20, 5], [9, 10, 5]])
WHOLE = ies([0, 10, 90], [0, 100, 200, 360], [[8, 5, 1], [8, 7, 2], [8, 3, 3], [8, 5, 1]])
FILES = {"axial": AXIAL, "quadrant": QUADRANT, "bilateral": BILATERAL, "sideways": SIDEWAYS, "whole": WHOLE}

TABLES = {  # azimuths all round, and candela at the vertical angles
    "axial": ([0, 360], [[100, 60, 10]] * 2),
    "quadrant": (
        [0, 40, 90, 140, 180, 220, 270, 320, 360],
        [[100, 2 * b, 2 * c] for b, c in [(70, 0), (30, 20), (10, 80), (30, 20)] * 2 + [(70, 0)]],
    ),
    "bilateral": ([0, 90, 180, 270, 360], [[4.5, b, 2.5] for b in (20, 10, 5, 10, 20)]),
    "sideways": ([90, 180, 270, 360, 450], [[9, b, 5] for b in (40, 20, 10, 20, 40)]),
    "whole": ([0, 100, 200, 360], [[8, 5, 1], [8, 7, 2], [8, 3, 3], [8, 5, 1]]),
}


def interpolant(name, polar, azimuth):
    """The intensity [cd] at angles in degrees, from the table written out by hand."""
    vertical = list(read_lm63(FILES[name]).vertical)
    horizontal, table = TABLES[name]
    if not vertical[0] <= polar <= vertical[-1]:
        return mpf(0)
    azimuth = (azimuth - horizontal[0]) % 360 + horizontal[0]
    i = max(k for k in range(len(horizontal) - 1) if horizontal[k] <= azimuth)
    j = max(k for k in range(len(vertical) - 1) if vertical[k] <= polar)
    s = (azimuth - horizontal[i]) / (horizontal[i + 1] - horizontal[i])
    t = (polar - mpf(vertical[j])) / mpf(vertical[j + 1] - vertical[j])
    values = [(1 - t) * mpf(row[j]) + t * mpf(row[j + 1]) for row in (table[i], table[i + 1])]
    return (1 - s) * values[0] + s * values[1]


@pytest.mark.parametrize("name", FILES)
def test_symmetries_are_written_out(name):
    found = read_lm63(FILES[name])
    horizontal, table = TABLES[name]
    assert found.horizontal.tolist() == horizontal
    assert found.candela.tolist() == table
    assert found.keywords == {"TEST": "none", "LUMINAIRE": "two lobes\nmade up"}
    assert found.watts == 40


@pytest.mark.parametrize("name", FILES)
def test_intensities_between_the_tabulated_angles(name, rng):
    light = Goniometric(position=(0, 0, 0), ies=FILES[name], efficacy=100.0, scale=3.0)
    for place in unit(rng.normal(size=(60, 3))):
        x, y, z = (mpf(float(v)) for v in place)
        polar = mpmath.degrees(mpmath.atan2(mpmath.hypot(x, y), -z))
        truth = interpolant(name, polar, mpmath.degrees(mpmath.atan2(y, x))) * 3 / 100
        found = irradiance(light, position=place, normal=-place)
        square = x * x + y * y + z * z
        assert abs(mpf(float(found.value)) - truth / square) <= mpf(float(found.error))
        assert found.error < 1e-12


@pytest.mark.parametrize("name", FILES)
def test_the_flux_is_the_interpolants(name):
    """By quadrature over every cell: nothing but the table by hand and the element sinθ dθ dφ."""
    light = Goniometric(position=(0, 0, 0), ies=FILES[name], efficacy=200.0)
    horizontal, _ = TABLES[name]
    vertical = [mpf(v) for v in read_lm63(FILES[name]).vertical]
    total = mpf(0)
    for a, b in itertools.pairwise(vertical):
        for c, d in itertools.pairwise(horizontal):
            middle = (mpf(c) + d) / 2  # linear in the azimuth: the midpoint is exact
            ring = mpmath.quad(
                lambda p, m=middle: interpolant(name, mpmath.degrees(p), m) * mpmath.sin(p),
                [mpmath.radians(a) + mpf("1e-38"), mpmath.radians(b) - mpf("1e-38")],
            )
            total += ring * mpmath.radians(d - c)
    found = light.flux()
    assert abs(mpf(float(found.value)) - total / 200) <= mpf(float(found.error))


def test_a_fine_table_keeps_the_digits_of_its_flux():
    angles = [round(k * 0.1, 1) for k in range(1801)]
    found = Goniometric(position=(0, 0, 0), ies=ies(angles, [0], [[7] * 1801]), efficacy=1.0).flux()
    assert abs(mpf(float(found.value)) - 28 * mpmath.pi) <= mpf(float(found.error))


def test_orientation():
    """The lamp turned: vertical angle 0 along x, horizontal angle 0 along z."""
    light = Goniometric(position=(0, 0, 0), ies=WHOLE, direction=(1, 0, 0), forward=(0, 0, 1), efficacy=1)
    for polar, azimuth in ((5, 50), (45, 100), (60, 250), (80, 359)):
        a, b = math.radians(polar), math.radians(azimuth)
        # Seen against the direction, from +x back, z then ... counterclockwise about −x.
        place = np.array([math.cos(a), math.sin(a) * math.sin(b), math.sin(a) * math.cos(b)])
        truth = float(interpolant("whole", mpf(polar), mpf(azimuth)))
        assert float(light.incident(place)[1][0]) == pytest.approx(truth, rel=1e-13)


def test_a_quadrant_looks_the_same_from_four_sides():
    light = Goniometric(position=(0, 0, 0), ies=QUADRANT)
    values = [float(light.incident(np.array([x, y, -0.6]))[1][0]) for x in (-0.5, 0.5) for y in (-0.3, 0.3)]
    assert values == pytest.approx([values[0]] * 4, rel=1e-14)


def test_beyond_the_table_it_is_dark():
    light = Goniometric(position=(0, 0, 0), ies=AXIAL)
    assert irradiance(light, position=(1, 0, 0.1), normal=(-1, 0, 0)).value == 0
    edge = irradiance(light, position=(1, 0, 0), normal=(-1, 0, 0))
    assert edge.error >= float(edge.value) > 0  # rounding decides
    assert solid_angle(light).value == 0


def test_files_and_texts_are_read_alike(tmp_path):
    path = tmp_path / "lamp.ies"
    path.write_text(WHOLE, encoding="latin-1")
    lights = [Goniometric(position=(0, 0, 1), ies=source) for source in (WHOLE, path, str(path))]
    path.unlink()
    assert lights[0] == lights[1] == lights[2]
    assert pickle.loads(pickle.dumps(lights[1])) == lights[0]
    assert len({hash(light) for light in lights}) == 1
    assert "two lobes" in repr(lights[0])
    with pytest.raises(ParameterError, match=r"ies = .*lamp\.ies.*No such file"):
        Goniometric(position=(0, 0, 1), ies=path)
    for bad in (None, 5, ""):
        with pytest.raises(ParameterError, match=r"ies = .* path of an IES file, or its text"):
            Goniometric(position=(0, 0, 1), ies=bad)


def edited(line, text):
    """AXIAL with one line, counted from 1, replaced."""
    lines = AXIAL.splitlines()
    lines[line - 1] = text
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (edited(1, "IESNA91"), r"line 1 of the IES file = 'IESNA91' .* 'IESNA:LM-63-1995'"),
        (edited(2, "TEST"), r"line 2 .* 'TEST' .* '\[KEYWORD\] text'"),
        (edited(5, "TILT=INCLUDE"), r"line 5 .* 'TILT=INCLUDE' .* 'TILT=NONE'"),
        ("\n".join(AXIAL.splitlines()[:4]), r"line 4 .* followed by 'TILT=NONE'"),
        (edited(6, "1.5 -1 1 3 1 1 2 0 0 0"), r"line 6 .* '1.5' .* number of lamps: an integer, at least 1"),
        (edited(6, "1 -1 0 3 1 1 2 0 0 0"), r"line 6 .* '0' .* candela multiplier: above 0"),
        (edited(6, "1 -1 1 x 1 1 2 0 0 0"), r"line 6 .* 'x' .* number of vertical angles"),
        (edited(6, "1 -1 1 3 1 2 2 0 0 0"), r"line 6 .* '2' .* photometric type: 1, Type C"),
        (edited(6, "1 -1 1 3 1 1 3 0 0 0"), r"line 6 .* '3' .* unit of lengths"),
        (edited(6, "1 -1 1 3 1 1 2 0 0 nan"), r"line 6 .* 'nan' .* height of the luminous opening"),
        (edited(7, "1 1 -2"), r"line 7 .* '-2' .* input power: at least 0"),
        (edited(8, "0 30 30"), r"line 8 .* '30' .* vertical angle 3 of 3: above the one before"),
        (edited(8, "0 30 80"), r"line 8 .* '0° to 80°' .* 0° to 90°"),
        (edited(9, "5"), r"line 9 .* '5° to 5°' .* 0°"),
        (
            edited(10, "100 60 -1"),
            r"line 10 .* '-1' .* candela at vertical angle 90°, horizontal 0°: at least 0",
        ),
        (edited(10, "100 60"), r"line 10 .* 'the end of the file' .* followed by the candela at vertical"),
        (edited(10, "100 60 10 10"), r"line 10 .* '10' .* end of the file, after 3 candela values"),
        (edited(10, "1e308 60 10").replace("1 -1 1 ", "1 -1 99 "), "line 10 .* finite"),
        (WHOLE.replace("8 3 3\n8 5 1", "8 3 3\n8 5 2"), r"line 13 .* candela at 360°.* what they are at 0°"),
    ],
    ids=range(19),
)
def test_a_bad_file_is_refused_by_its_line(text, message):
    with pytest.raises(ParameterError, match=message):
        Goniometric(position=(0, 0, 0), ies=text)


@pytest.mark.parametrize(
    ("values", "name"),
    [({"efficacy": 0}, "efficacy"), ({"efficacy": 700}, "efficacy"), ({"scale": -1}, "scale")],
    ids=str,
)
def test_bad_goniometric_lights_are_refused(values, name):
    with pytest.raises(ParameterError, match=f"{name} = "):
        Goniometric(position=(0, 0, 0), ies=AXIAL, **values)
    with pytest.raises(ParameterError, match=r"forward = .* not parallel to direction"):
        Goniometric(position=(0, 0, 0), ies=AXIAL, forward=(0, 0, 1))


@pytest.mark.parametrize(
    "light",
    [
        Spot(position=(0, 0, 0), direction=(0, 0, 1), intensity=1, outer=1),
        Goniometric(position=(0, 0, 0), ies=AXIAL),
    ],
    ids=["spot", "goniometric"],
)
def test_they_are_delta_lights(light):
    for call in (
        lambda: light.radiance_from(UP[None], np.zeros(3)),
        lambda: light.sample(np.zeros((1, 2)), np.zeros(3)),
        lambda: light.pdf(UP[None], np.zeros(3)),
    ):
        with pytest.raises(RadiokitError, match="delta light"):
            call()
    with pytest.raises(ParameterError, match=f"away from the {light.name} light"):
        irradiance(light, position=(0, 0, 0))
