"""Degenerate lights and receivers: the right answer, often 0, or one error that names what is wrong."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import radiokit as rk
from radiokit.contracts.parameters import parameters_of
from radiokit.facts.errors import ParameterError, UnknownNameError

NAN, INF = math.nan, math.inf
UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
IES = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n1366 0"
SQUARE = ((-1, -1, 1), (-1, 1, 1), (1, 1, 1), (1, -1, 1))
GOOD = {
    "point": {"position": (0, 0, 2), "intensity": 1.0},
    "spot": {"position": (0, 0, 2), "direction": DOWN, "intensity": 1.0, "outer": 0.5, "inner": 0.2},
    "goniometric": {"position": (0, 0, 1), "ies": IES, "scale": 1.0, "direction": DOWN, "forward": (1, 0, 0)},
    "directional": {"direction": UP, "irradiance": 1.0},
    "sphere": {"center": (0, 0, 4), "radius": 1.0, "radiance": 1.0},
    "disk": {"center": (0, 0, 4), "normal": DOWN, "radius": 1.0, "radiance": 1.0, "exponent": 0.5},
    "polygon": {"vertices": SQUARE, "radiance": 1.0},
    "triangle": {"vertices": SQUARE[:3], "radiance": 1.0},
    "rectangle": {"center": (0, 0, 4), "normal": DOWN, "width": 1.0, "height": 2.0, "radiance": 1.0},
    "constant": {"radiance": 1.0, "normal": UP},
    "sky_overcast": {"radiance": 1.0, "normal": UP},
    "sky_gradient": {"radiance": 1.0, "horizon": 0.5, "curvature": 0.1, "normal": UP},
    "environment": {"radiance": ((1.0, 2.0), (0.0, 1.0)), "normal": UP, "forward": (1, 0, 0)},
}
GREY, GLOSS = rk.bsdf("lambert", reflectance=0.5), rk.bsdf("ggx", alpha=0.3)
VIEW = (0.0, 0.6, 0.8)


def light(name, **change):
    return rk.emitter(name, **{**GOOD[name], **change})


def view(receiver):
    """A viewer straight above the receiver, if that is turned."""
    return receiver.get("normal", VIEW)


def answers(e, **receiver):
    """What the public functions say of a light: a few dozen numbers, or what they raise."""
    yield rk.irradiance(e, **receiver)
    yield rk.solid_angle(e, **({"position": receiver["position"]} if "position" in receiver else {}))
    for f in (GREY, GLOSS):
        yield rk.shade(f, e, view(receiver), rtol=1e-2, **receiver)
    if not e.delta:
        yield rk.shade(GLOSS, e, view(receiver), method="mis", samples=32, rng=0, **receiver)
    flux = e.flux()
    if flux is not None:
        yield flux


def refusal(call):
    """Return what a ParameterError says, or nothing."""
    try:
        call()
    except ParameterError as problem:
        return str(problem)
    return ""


def check_finite(e, **receiver):
    for found in answers(e, **receiver):
        assert np.all(np.isfinite(found.value))
        assert np.all(np.asarray(found.value) >= 0)
        assert np.all(np.isfinite(found.error))


def check_dark(e, **receiver):
    assert rk.irradiance(e, **receiver).value == 0.0
    for f in (GREY, GLOSS):
        assert rk.shade(f, e, view(receiver), rtol=1e-2, **receiver).value == 0.0


def test_all_lights_are_here():
    assert sorted(GOOD) == rk.list_emitters()
    for name in GOOD:
        check_finite(light(name))


# --- parameters ---

NUMBERS = (NAN, INF, -INF, -1.0, None, "x", 1e300, [[1.0]], 1j, ())
LENGTHS = ("radius", "width", "height", "outer")
VECTORS = ((NAN, 0, 1), (0, INF, 0), (1, 2), None, "up", (0, 0, 1, 0), (1j, 0, 0))


@pytest.mark.parametrize("name", GOOD)
def test_bad_numbers_are_named(name):
    for field, declared in parameters_of(type(light(name))).items():
        low, high = declared.interval[1:-1].split(", ")
        for bad in (*NUMBERS, *((0.0, -0.0) if field in LENGTHS else ())):
            if isinstance(bad, float) and declared.contains(bad):
                continue
            with pytest.raises(ParameterError) as raised:
                light(name, **{field: bad})
            text = str(raised.value)
            assert text.startswith(f"{field} = ")
            assert low in text
            assert high in text


@pytest.mark.parametrize("name", GOOD)
def test_bad_vectors_are_named(name):
    for field in dataclasses.fields(light(name)):
        if "vector" not in field.metadata:
            continue
        zero = ((0, 0, 0),) if field.metadata["vector"].kind == "direction" else ()
        for bad in (*VECTORS, *zero):
            if bad is None and field.default is None:
                continue
            with pytest.raises(ParameterError, match=f"^{field.name} = .*must be"):
                light(name, **{field.name: bad})


@pytest.mark.parametrize("name", GOOD)
def test_strengths_and_lengths_at_their_ends_are_finite(name):
    """Zero, the smallest and the largest numbers that are allowed."""
    allowed = {"outer": (0.2, math.pi), "inner": (0.0, 0.5), "exponent": (0.0, 1e3)}
    for field, declared in parameters_of(type(light(name))).items():
        end = float(declared.interval[1:-1].split(", ")[1])
        low, high = allowed.get(field, (0.0, INF))
        for value in (0.0, -0.0, 5e-324, 1e-300, end):
            if declared.contains(value) and low <= value <= high:
                problem = refusal(lambda f=field, v=value: check_finite(light(name, **{f: v})))
                assert problem.split(" = ")[0] in ("", "position", "radius", "width, height")


VERTICES = {
    "none": ([], "vertices = "),
    "one": ([(0, 0, 1)], "vertices = "),
    "two": ([(0, 0, 1), (1, 0, 1)], "vertices = .*at least 3"),
    "in two dimensions": ([(0, 0), (1, 0), (0, 1)], "vertices = "),
    "ragged": ([(0, 0, 1), (1, 0), (0, 1, 1)], "vertices = "),
    "words": ("square", "vertices = "),
    "nan": ([(0, 0, 1), (NAN, 0, 1), (0, 1, 1)], r"vertices\[1\] = .*finite"),
    "infinite": ([(0, 0, 1), (1, 0, 1), (0, INF, 1)], r"vertices\[2\] = .*finite"),
    "too far": ([(0, 0, 1), (1e300, 0, 1), (0, 1, 1)], r"vertices\[1\] = .*1e100"),
    "a point": ([(1, 1, 1)] * 3, r"vertices\[1\] = .*another point"),
    "a duplicate": ([(0, 0, 1), (0, 0, 1), (1, 0, 1), (0, 1, 1)], r"vertices\[1\] = .*another point"),
    "the first again": ([(0, 0, 1), (1, 0, 1), (0, 1, 1), (0, 0, 1)], r"vertices\[0\] = .*another point"),
    "on a line": ([(0, 0, 1), (1, 0, 1), (2, 0, 1)], "vertices = .*an area that is not 0"),
    "all but on a line": ([(0, 0, 1), (1, 0, 1), (2, 1e-15, 1)], "vertices = .*an area that is not 0"),
    "there and back": ([(0, 0, 1), (1, 0, 1), (1, 1, 1), (1, 0, 1)], "vertices = .*an area that is not 0"),
    "a bow tie": ([(0, 0, 1), (1, 1, 1), (1, 0, 1), (0, 2, 1)], r"vertices\[0\] = .*meets no other"),
    "a star of five": (
        [(math.cos(t), math.sin(t), 1) for t in 4 * np.pi / 5 * np.arange(5)],
        r"vertices\[0\] = .*meets no other",
    ),
    "not flat": ([(0, 0, 1), (1, 0, 1), (1, 1, 1.1), (0, 1, 1)], r"vertices\[\d\] = .*in the plane"),
    "of 1e-300": ([(0, 0, 0), (1e-300, 0, 0), (0, 1e-300, 0)], r"vertices\[1\] = .*1e-100 m"),
}  # fmt: skip


@pytest.mark.parametrize("case", VERTICES)
def test_bad_polygons_are_named(case):
    vertices, message = VERTICES[case]
    for name in ("polygon", *(("triangle",) if len(vertices) <= 3 else ())):
        with pytest.raises(ParameterError, match=f"^{message}"):
            light(name, vertices=vertices)


def test_collinear_corners_of_an_area_change_nothing():
    plain = light("polygon")
    more = light("polygon", vertices=(SQUARE[0], (-1, 0, 1), *SQUARE[1:]))
    assert rk.irradiance(more).value == pytest.approx(rk.irradiance(plain).value, rel=1e-15)
    assert rk.shade(GLOSS, more, VIEW).value == pytest.approx(rk.shade(GLOSS, plain, VIEW).value, rel=1e-7)


@pytest.mark.parametrize(("name", "change", "field"), [
    ("rectangle", {"up": DOWN}, "up"),
    ("rectangle", {"center": (1e18, 0, 4)}, "width, height"),
    ("rectangle", {"width": 1e-15, "height": 1.0}, "width, height"),
    ("spot", {"inner": 0.6}, "inner"),
    ("goniometric", {"forward": UP}, "forward"),
    ("goniometric", {"ies": ""}, "ies"),
    ("goniometric", {"ies": "\n\n"}, "line 1 of the IES file"),
    ("goniometric", {"ies": "TILT=NONE\n"}, "ies"),
    ("goniometric", {"ies": 3}, "ies"),
    ("goniometric", {"ies": IES.replace("1366", "nan")}, "line 7 of the IES file"),
    ("goniometric", {"ies": IES.replace("1366", "-1")}, "line 7 of the IES file"),
    ("environment", {"forward": DOWN}, "forward"),
    ("environment", {"radiance": ()}, "radiance"),
    ("environment", {"radiance": ((1.0, NAN),)}, "radiance"),
    ("environment", {"radiance": ((1.0, -1e-9),)}, "radiance"),
    ("environment", {"radiance": ((1.0, INF),)}, "radiance"),
    ("environment", {"radiance": ((1.0, 1e300),)}, "radiance"),
    ("environment", {"radiance": 1.0}, "radiance"),
    ("environment", {"radiance": np.ones((2, 3, 0))}, "radiance"),
    ("sphere", {"sampling": "cosine"}, "sampling"),
    ("disk", {"sampling": None}, "sampling"),
])  # fmt: skip
def test_bad_combinations_are_named(name, change, field):
    with pytest.raises(ParameterError) as raised:
        light(name, **change)
    assert str(raised.value).startswith(field)
    assert "must be" in str(raised.value)


# --- receivers ---


@pytest.mark.parametrize("name", GOOD)
def test_bad_receivers_are_named(name):
    e = light(name)
    for bad in ((NAN, 0, 0), (0, INF, 0), (0, 0), "here", None):
        for call in (
            rk.irradiance,
            rk.solid_angle,
            lambda e, position: rk.shade(GREY, e, VIEW, position=position),
        ):
            with pytest.raises(ParameterError, match=r"^position = .*three finite numbers"):
                call(e, position=bad)
    for bad in ((0, 0, 0), (NAN, 0, 1), (0, 0), "up"):
        for call in (rk.irradiance, lambda e, normal: rk.shade(GREY, e, VIEW, normal=normal)):
            with pytest.raises(ParameterError, match=r"^normal = .*must be"):
                call(e, normal=bad)


ON = {
    "on a point light": ("point", (0, 0, 2), "away from the point light"),
    "on a spot": ("spot", (0, 0, 2), "away from the spot light"),
    "on a luminaire": ("goniometric", (0, 0, 1), "away from the goniometric light"),
    "beside a point light, where I/r² overflows": ("point", (0, 1e-200, 2), None),
    "at a sphere's centre": ("sphere", (0, 0, 4), "outside the sphere"),
    "inside a sphere": ("sphere", (0.5, 0, 4), "outside the sphere"),
    "on a sphere": ("sphere", (0, 0, 3), "outside the sphere"),
    "at a disk's centre": ("disk", (0, 0, 4), "off the disk"),
    "on a disk's edge": ("disk", (1, 0, 4), "off the disk"),
    "on a polygon": ("polygon", (0.3, 0.2, 1), "away from the light"),
    "on a polygon's edge": ("polygon", (1, 0.2, 1), "away from the light"),
    "on a polygon's corner": ("polygon", (1, 1, 1), "away from the light"),
    "on a triangle": ("triangle", (-0.5, 0.5, 1), "away from the light"),
    "on a rectangle": ("rectangle", (0.1, 0, 4), "away from the light"),
}  # fmt: skip


@pytest.mark.parametrize("case", ON)
def test_a_receiver_on_a_light_is_refused(case):
    name, position, allowed = ON[case]
    e = light(name)
    if allowed is None:
        position = (0, 1e-200, 0)
        e, allowed = light(name, position=(0, 0, 0)), "where the irradiance is infinite"
    calls = [rk.irradiance, lambda e, position: rk.shade(GREY, e, VIEW, position=position)]
    if not e.delta:
        calls += [
            rk.solid_angle,
            lambda e, position: rk.shade(GLOSS, e, VIEW, position=position, method="mis"),
        ]
    for call in calls:
        with pytest.raises(ParameterError, match=f"^position = .*{allowed}"):
            call(e, position=position)


ELL = ((0, 0, 1), (0, 2, 1), (1, 2, 1), (1, 1, 1), (2, 1, 1), (2, 0, 1))
DARK = {
    "behind the receiver": [("point", {}, {"normal": DOWN}), ("spot", {}, {"normal": DOWN}),
        ("goniometric", {}, {"normal": DOWN}), ("directional", {}, {"normal": DOWN}),
        ("sphere", {}, {"normal": DOWN}),
        ("disk", {}, {"normal": DOWN}), ("polygon", {}, {"normal": DOWN}), ("triangle", {}, {"normal": DOWN}),
        ("rectangle", {}, {"normal": DOWN}), ("constant", {}, {"normal": DOWN}),
        ("sky_overcast", {}, {"normal": DOWN}), ("sky_gradient", {}, {"normal": DOWN})],
    "in the receiver's plane": [("point", {}, {"position": (1, 0, 2)}),
        ("directional", {"direction": (1, 0, 0)}, {})],
    "behind the light": [("disk", {}, {"position": (0, 0, 9), "normal": DOWN}),
        ("polygon", {}, {"position": (0, 0, 9), "normal": DOWN}),
        ("triangle", {}, {"position": (0, 0, 9), "normal": DOWN}),
        ("rectangle", {}, {"position": (0, 0, 9), "normal": DOWN}),
        ("spot", {}, {"position": (0, 0, 9), "normal": DOWN})],
    "in the light's plane, beside it": [("disk", {}, {"position": (3, 0, 4), "normal": (-1, 0, 0)}),
        ("polygon", {}, {"position": (3, 0, 1), "normal": (-1, 0, 0)}),
        ("polygon", {"vertices": ELL}, {"position": (1.5, 1.5, 1), "normal": (-1, 0, 0)}),
        ("triangle", {}, {"position": (3, 0, 1), "normal": (-1, 0, 0)}),
        ("rectangle", {}, {"position": (3, 0, 4), "normal": (-1, 0, 0)})],
    "touching the horizon from below": [("sphere", {"center": (4, 0, -1)}, {}),
        ("disk", {"center": (4, 0, -1), "normal": (-1, 0, 0)}, {}),
        ("polygon", {"vertices": ((2, 1, 0), (2, -1, 0), (2, -1, -1), (2, 1, -1))[::-1]}, {})],
    "of no strength": [(name, {field: 0.0}, {}) for name, field in (
        ("point", "intensity"), ("spot", "intensity"), ("goniometric", "scale"),
        ("directional", "irradiance"),
        ("sphere", "radiance"), ("disk", "radiance"), ("polygon", "radiance"), ("triangle", "radiance"),
        ("rectangle", "radiance"), ("constant", "radiance"), ("sky_overcast", "radiance"))],
    "a dark map": [("environment", {"radiance": np.zeros((2, 3))}, {})],
}  # fmt: skip


@pytest.mark.parametrize("case", DARK)
def test_what_sends_nothing_is_dark(case):
    for name, change, receiver in DARK[case]:
        check_dark(light(name, **change), **receiver)
        check_finite(light(name, **change), **receiver)


@pytest.mark.parametrize("name", GOOD)
@pytest.mark.parametrize("size", [1e-300, 1e-90, 1e60, 1e300])
def test_scenes_of_any_size(name, size):
    """All lengths times one number: the same answer, or a refusal that says how large it may be."""
    scaled = {}
    for field, value in GOOD[name].items():
        if field in ("position", "center", "vertices", "radius", "width", "height"):
            scaled[field] = (np.array(value, dtype=float) * size).tolist()
    problem = refusal(lambda: rk.shade(GREY, light(name, **scaled), VIEW))
    if problem:
        assert name not in ("directional", "constant", "environment", "sky_overcast", "sky_gradient")
        assert size in (
            (1e-300, 1e-90, 1e300) if name in ("point", "spot", "goniometric") else (1e-300, 1e300)
        )
        assert any(word in problem for word in ("1e100", "1e-100", "1e150", "infinite"))
        return
    e = light(name, **scaled)
    found, angle = rk.irradiance(e, normal=(0.6, 0, 0.8)), rk.solid_angle(e)
    shaded = rk.shade(GLOSS, e, VIEW, rtol=1e-4)
    factor = 1 / size / size if e.delta and name != "directional" else 1.0
    plain = light(name)
    assert found.value == pytest.approx(rk.irradiance(plain, normal=(0.6, 0, 0.8)).value * factor, rel=1e-7)
    assert shaded.value == pytest.approx(rk.shade(GLOSS, plain, VIEW, rtol=1e-4).value * factor, rel=1e-3)
    assert angle.value == pytest.approx(rk.solid_angle(plain).value, rel=1e-12)


@pytest.mark.parametrize("name", GOOD)
def test_receivers_anywhere(name):
    for position in ((1e-300, 0, 0), (0, 0, -1e-300), (1e60, 0, 0), (0, 1e90, -1e90), (1e300, 0, 0)):
        problem = refusal(lambda p=position: check_finite(light(name), position=p))
        assert problem.startswith("position = " if position[0] == 1e300 and problem else "")
        assert position[0] == 1e300 or not problem


def test_names_and_kinds_are_checked():
    with pytest.raises(UnknownNameError, match="sphere"):
        rk.emitter("spheer", center=(0, 0, 4), radius=1.0, radiance=1.0)
    for call in (rk.irradiance, rk.solid_angle, lambda e: rk.shade(GREY, e, VIEW)):
        for bad in (None, "sun", 3.0):
            with pytest.raises((ParameterError, TypeError)):
                call(bad)


def test_a_planted_flaw_is_found():
    """A light that answers NaN, or that is bright from behind, fails these checks."""

    class Flawed(type(light("sphere"))):
        def irradiance_at(self, position, normal):
            found = super().irradiance_at(position, normal)
            return dataclasses.replace(found, value=NAN if normal[2] > 0 else 1.0)

    flawed = Flawed(**GOOD["sphere"])
    with pytest.raises(AssertionError):
        check_finite(flawed)
    with pytest.raises(AssertionError):
        check_dark(flawed, normal=DOWN)
