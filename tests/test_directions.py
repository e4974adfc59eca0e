"""Directions against 50 digits: every kernel, on ordinary inputs and where the usual formula fails."""

from __future__ import annotations

import itertools

import mpmath
import numpy as np
import pytest

from radiokit.facts import directions
from radiokit.facts.directions import (
    angle_between,
    cap_half_angle,
    cap_solid_angle,
    cartesian_to_spherical,
    check_directions,
    frame,
    half_vector,
    reflect,
    refract,
    spherical_to_cartesian,
    to_local,
    to_world,
    unit,
)
from radiokit.facts.errors import ParameterError
from radiokit.measure.twin import scaled_ulps

ULPS = 4.0  # what every kernel below keeps, after division by the condition number
COUNT = 24  # random inputs for each hardness
HARDNESS = [1.0, 1e-3, 1e-9, 1e-15, 1e-200]


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(50):
        yield


def exact(v):
    return [mpmath.mpf(float(x)) for x in v]


def inner(a, b):
    return mpmath.fsum(x * y for x, y in zip(a, b, strict=True))


def norm(a):
    return mpmath.sqrt(inner(a, a))


def normed(v):
    v = exact(v)
    length = norm(v)
    return [x / length for x in v]


def plus(a, b, factor=1):
    return [x + factor * y for x, y in zip(a, b, strict=True)]


def vector_ulps(value, truth, condition=1.0):
    """The length of the error, in the last place of the length of the truth, over the condition number."""
    error, size = norm(plus(exact(value), truth, -1)), norm(truth)
    return float(error / float(np.spacing(float(size)))) / max(1.0, condition)


def random_units(rng, count=COUNT):
    return unit(rng.normal(size=(count, 3)))


def pairs(rng, apart):
    """Directions about ``apart`` from each other."""
    a = random_units(rng)
    return a, unit(a + apart * rng.normal(size=a.shape))


AXIS = np.array([0.0, 0.0, 1.0])
HARD_NORMALS = [
    *np.vstack((np.eye(3), -np.eye(3))),
    np.array([1e-8, 0.0, -1.0 + 1e-16]),
    np.array([1e-9, -1e-9, -1.0]),
    np.array([1e-200, 1e-300, -1.0]),
    np.array([0.6, 0.8, 1e-17]),
    np.array([0.6, 0.8, -1e-17]),
    np.array([0.6, -0.8, -0.0]),
    np.array([-1.0, 1e-12, 0.0]),
]


# ---------------------------------------------------------------- what is let in


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        ([0, 0, 2], "(0.0, 0.0, 2.0)"),
        ([0, 0, 0], "(0.0, 0.0, 0.0)"),
        ([0, 0, 1 + 2e-6], "(0.0, 0.0, 1.000002)"),
        ([0, np.nan, 1], "(0.0, nan, 1.0)"),
        ([0, np.inf, 1], "(0.0, inf, 1.0)"),
        ([1e200, 0, 0], "(1e+200, 0.0, 0.0)"),
        ([0, 1], "[0, 1]"),
        (1.0, "1.0"),
        ([], "[]"),
        (None, "None"),
        ("up", "'up'"),
        ([[0, 0, 1], [0, 1]], "[[0, 0, 1], [0, 1]]"),
        ([0, 0, 1j], "[0, 0, 1j]"),
        ([True, False, False], "[True, False, False]"),
        (np.zeros((10, 2)), "an array of shape (10, 2)"),
    ],
)
def test_what_is_no_direction_is_named(value, shown):
    with pytest.raises(ParameterError) as caught:
        check_directions("wo", value)
    expected = f"wo = {shown} is not allowed: it must be a finite unit vector of shape (..., 3)"
    assert str(caught.value) == expected


def test_the_offending_direction_is_shown_alone():
    many = np.tile(AXIS, (4, 1000, 1))
    many[2, 17] = 0.5
    with pytest.raises(ParameterError, match=r"^wi\[2, 17\] = \(0\.5, 0\.5, 0\.5\) is not allowed"):
        check_directions("wi", many)


def test_directions_come_back_unchanged(rng):
    w = random_units(rng, 1000)
    assert check_directions("w", w) is w
    single = w.astype(np.float32)
    single /= np.sqrt((single * single).sum(axis=-1, keepdims=True))
    assert check_directions("w", single).dtype == np.float64
    np.testing.assert_array_equal(check_directions("w", single), single)
    assert check_directions("w", np.empty((0, 3))).shape == (0, 3)


# ---------------------------------------------------------------- unit, and spherical coordinates


@pytest.mark.parametrize("scale", [1.0, 1e-300, 5e-324, 1e-160, 1e160, 1e308])
def test_unit_has_length_one_at_any_scale(rng, scale):
    v = np.vstack((rng.uniform(-1, 1, size=(COUNT, 3)), [[1, 1, 1], [0, 0, -1], [1, 1e-200, 0]])) * scale
    v = v[(v != 0).any(axis=-1)]
    assert max(vector_ulps(unit(x), normed(x)) for x in v) <= ULPS


@pytest.mark.parametrize("v", [[0.0, -0.0, 0.0], [np.nan, 0, 1], [np.inf, 0, 0], [1, 2]])
def test_unit_refuses(v):
    with pytest.raises(
        ParameterError, match=r"must be a finite vector of shape \(\.\.\., 3\) other than zero"
    ):
        unit(v)


@pytest.mark.parametrize("theta", [0.0, 1e-300, 1e-9, 1.0, np.pi / 2, np.pi - 1e-9, np.pi, -0.5])
def test_spherical_to_cartesian_has_a_twin(rng, theta):
    for phi in (0.0, np.pi / 2, -np.pi, *rng.uniform(-7, 7, 6)):
        t, p = mpmath.mpf(float(theta)), mpmath.mpf(float(phi))
        truth = [mpmath.sin(t) * mpmath.cos(p), mpmath.sin(t) * mpmath.sin(p), mpmath.cos(t)]
        value = spherical_to_cartesian(theta, phi)
        assert max(scaled_ulps(value, truth, 1.0)) <= ULPS  # each component by itself


def test_spherical_coordinates_go_there_and_back(rng):
    theta = np.concatenate((np.geomspace(1e-300, 3.0, 200), np.pi - np.geomspace(1e-15, 1.0, 50)))
    phi = rng.uniform(-np.pi, np.pi, theta.size)
    again_theta, again_phi = cartesian_to_spherical(spherical_to_cartesian(theta, phi))
    np.testing.assert_allclose(again_theta, theta, rtol=1e-15, atol=0)
    np.testing.assert_allclose(again_phi, phi, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("w", "angles"), [([-0.0, -0.0, 1], (0, 0)), ([-1, -0.0, -0.0], (np.pi / 2, np.pi))])
def test_signed_zeros_do_not_turn_the_azimuth(w, angles):
    assert cartesian_to_spherical(w) == angles


def test_degrees_are_refused():
    with pytest.raises(ParameterError) as caught:
        spherical_to_cartesian([0.1, 45], 0)
    assert str(caught.value) == "theta[1] = 45.0 is not allowed: it must be an angle in [-pi, pi] radians"
    with pytest.raises(ParameterError, match="phi = inf is not allowed"):
        spherical_to_cartesian(0.1, np.inf)


# ---------------------------------------------------------------- frames


def frame_defect(axes):
    rows = mpmath.matrix(axes.tolist())
    return float(max(abs(x) for x in rows * rows.T - mpmath.eye(3)))


def test_frames_are_orthonormal_and_right_handed(rng):
    normals = np.vstack((unit(np.array(HARD_NORMALS)), random_units(rng, 40)))
    for n, axes in zip(normals, frame(normals), strict=True):
        assert frame_defect(axes) <= ULPS * 2**-52, n
        assert mpmath.det(mpmath.matrix(axes.tolist())) > 0.999
        np.testing.assert_array_equal(axes[2], n)


def test_a_frame_that_fails_near_minus_z_is_seen():
    x, y, z = n = unit([3e-8, -2e-8, -1.0])
    a = 1 / (1 + z)  # without the sign of z
    wrong = np.array([[1 - x * x * a, -x * y * a, -x], [-x * y * a, 1 - y * y * a, -y], n])
    assert frame_defect(wrong) > 1e-3
    assert frame_defect(frame(n)) <= ULPS * 2**-52


def test_the_frame_of_z_is_the_identity_without_signed_zeros():
    axes = frame(AXIS)
    np.testing.assert_array_equal(axes, np.eye(3))
    assert not np.signbit(axes).any()


def test_local_and_world_are_inverse(rng):
    axes, w = frame(random_units(rng, 50)), random_units(rng, 50)
    np.testing.assert_allclose(to_world(axes, to_local(axes, w)), w, rtol=0, atol=1e-15)
    np.testing.assert_allclose(to_local(axes, axes[..., 2, :]), np.tile(AXIS, (50, 1)), rtol=0, atol=1e-15)
    assert to_local(axes[0], w).shape == (50, 3)  # one frame, many directions


def test_a_frame_refuses_what_is_no_normal():
    with pytest.raises(ParameterError, match=r"^normal = \(0\.0, 0\.0, 0\.0\) is not allowed"):
        frame([0.0, 0.0, 0.0])


# ---------------------------------------------------------------- half vectors and mirrors


@pytest.mark.parametrize("apart", HARDNESS)
@pytest.mark.parametrize("opposite", [False, True])
def test_half_vector_has_a_twin(rng, apart, opposite):
    a, b = pairs(rng, apart)
    b = -b if opposite else b
    for wi, wo in zip(a, b, strict=True):
        total = plus(exact(wi), exact(wo))
        if any(total):
            truth = [x / norm(total) for x in total]
            assert vector_ulps(half_vector(wi, wo), truth) <= ULPS


def test_opposite_directions_have_a_unit_half_vector_across(rng):
    wi = np.vstack((random_units(rng, 10), AXIS))
    half = half_vector(wi, -wi)
    check_directions("half", half)
    np.testing.assert_allclose(directions.dot(half, wi), 0.0, atol=1e-15)
    mixed = half_vector(np.array([AXIS, AXIS]), np.array([-AXIS, AXIS]))
    np.testing.assert_array_equal(mixed[1], AXIS)


def test_reflect_has_a_twin(rng):
    for w, n in zip(random_units(rng), random_units(rng), strict=True):
        truth = plus([2 * inner(exact(w), exact(n)) * x for x in exact(n)], exact(w), -1)
        assert vector_ulps(reflect(w, n), truth) <= ULPS
    w = random_units(rng)
    np.testing.assert_array_equal(reflect(w), w * [-1, -1, 1])
    np.testing.assert_allclose(reflect(reflect(w, AXIS), AXIS), w, atol=1e-15)


# ---------------------------------------------------------------- refraction


def refracted(w, n, eta):
    """Snell's law with 50 digits: the direction (None under total reflection), and the condition number."""
    w, n, eta = normed(w), normed(n), mpmath.mpf(float(eta))
    cosine = inner(w, n)
    if cosine < 0:
        n, cosine, eta = [-x for x in n], -cosine, 1 / eta
    along = plus(w, n, -cosine)
    square = 1 - inner(along, along) / eta**2
    if square <= 0:
        return None, mpmath.inf
    across = mpmath.sqrt(square)
    slope = mpmath.sqrt(inner(along, along)) / (eta * across)
    truth = plus([-x / eta for x in along], n, -across)
    return truth, 1 + slope + cosine / (eta * across)


ANGLES = {
    "anywhere": lambda rng, eta: rng.uniform(0, np.pi),
    "near the normal": lambda rng, eta: 1e-8 * rng.uniform(),
    "grazing": lambda rng, eta: np.pi / 2 + rng.uniform(-1e-9, 1e-9),
    "near-critical": lambda rng, eta: np.arcsin(min(eta, 1.0)) * (1 - 1e-10 * rng.uniform()),
}


@pytest.mark.parametrize("eta", [1.5, 1 / 1.5, 1.0, 1 + 1e-12, 1 - 1e-12, 1e-3, 1e3, 1e-6])
@pytest.mark.parametrize("angle", ANGLES)
def test_refract_has_a_twin(rng, eta, angle):
    for n in random_units(rng, 12):
        local = spherical_to_cartesian(ANGLES[angle](rng, eta), rng.uniform(0, 6))
        w = unit(to_world(frame(n), local))
        truth, condition = refracted(w, n, eta)
        direction, total = refract(w, n, eta=eta)
        assert abs(norm(exact(direction)) - 1) <= ULPS * 2**-52  # under total reflection too
        if truth is not None:
            assert vector_ulps(direction, truth, float(condition)) <= ULPS
        if truth is None or condition < 1e6:
            assert bool(total) == (truth is None)


def test_refraction_by_the_textbook_is_seen():
    w = unit([1.0, 0.0, 1e-9])
    sine2 = (1 - w[2] ** 2) / 1.0
    textbook = np.array([-w[0], -w[1], -np.sqrt(1 - sine2)])  # equal indices: straight on, were it exact
    truth, _ = refracted(w, AXIS, 1.0)
    assert abs(float(textbook[2] / truth[2]) - 1) > 0.9
    assert abs(float(refract(w, eta=1.0)[0][2] / truth[2]) - 1) < 1e-15


def test_refraction_obeys_snell_and_is_reversible(rng):
    w, n = random_units(rng, 200), random_units(rng, 200)
    eta = rng.uniform(0.5, 2.0, 200)
    direction, total = refract(w, n, eta=eta)
    assert 0 < total.sum() < 200
    sine_i, sine_t = (np.linalg.norm(np.cross(v, n), axis=-1) for v in (w, direction))
    ratio = np.where(directions.dot(w, n) > 0, eta, 1 / eta)
    np.testing.assert_allclose(sine_i[~total], (ratio * sine_t)[~total], rtol=1e-13)
    back, lost = refract(direction[~total], n[~total], eta=eta[~total])
    assert not lost.any()
    np.testing.assert_allclose(back, w[~total], atol=1e-12)
    np.testing.assert_allclose(directions.dot(direction, n)[total], 0.0, atol=1e-15)  # along the surface


def test_refraction_of_equal_indices_goes_straight_on():
    for w in (AXIS, -AXIS, np.array([1.0, 0.0, 0.0]), np.array([0.6, 0.0, -0.8])):
        direction, total = refract(w, eta=1.0)
        np.testing.assert_array_equal(direction, -w)
        assert not total


@pytest.mark.parametrize("eta", [0.0, -1.5, np.nan, np.inf, 1e200, "glass"])
def test_refract_refuses(eta):
    with pytest.raises(
        ParameterError, match=r"^eta = .* is not allowed: it must be a number in \[1e-100, 1e100\]$"
    ):
        refract(AXIS, eta=eta)
    for extreme, w in itertools.product((1e-100, 1e100), (AXIS, -AXIS, unit([1, 0, 1e-9]))):
        assert np.isfinite(refract(w, eta=extreme)[0]).all()


# ---------------------------------------------------------------- angles


def angle_error(angle, rng, apart, opposite=False):
    worst = 0.0
    for a, b in zip(*pairs(rng, apart), strict=True):
        b = -b if opposite else b
        x, y = normed(a), normed(b)
        truth = 2 * mpmath.atan2(norm(plus(x, y, -1)), norm(plus(x, y)))
        # Two floats of nearly one direction may differ in length by more than in direction.
        apart_or_across = min(norm(plus(exact(a), exact(b), sign)) for sign in (-1, 1))
        least = min(truth, mpmath.pi - truth)
        condition = apart_or_across / least if least > 0 else 1.0
        worst = max(worst, float(scaled_ulps(angle(a, b), truth, float(condition))))
    return worst


@pytest.mark.parametrize("apart", HARDNESS)
@pytest.mark.parametrize("opposite", [False, True])
def test_angle_between_has_a_twin(rng, apart, opposite):
    assert angle_error(angle_between, rng, apart, opposite) <= ULPS


@pytest.mark.parametrize(
    ("wrong", "apart"),
    [
        (lambda a, b: np.arccos(np.clip(np.dot(a, b), -1, 1)), 1e-3),
        (lambda a, b: np.arccos(np.clip(np.dot(a, b), -1, 1)), 1e-9),
        (lambda a, b: np.arcsin(np.linalg.norm(np.cross(a, b))), 1e-9),
        (lambda a, b: 2 * np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)), 1e-12),
    ],
)
def test_angles_that_lose_digits_are_seen(rng, wrong, apart):
    assert angle_error(wrong, rng, apart) > 10 * ULPS


def test_angles_of_special_pairs():
    x = np.array([1.0, 0.0, 0.0])
    assert angle_between(x, x) == 0.0
    assert angle_between(x, -x) == np.pi
    assert angle_between(x, AXIS) == np.pi / 2
    single = unit([0.3, 0.4, 0.5]).astype(np.float32)
    assert angle_between(single, single.astype(float) * (1 + 3e-7)) < 1e-16  # lengths are no angles
    assert angle_between(np.tile(x, (2, 5, 1)), AXIS).shape == (2, 5)


# ---------------------------------------------------------------- caps

CAPS = [0.0, 1e-160, 1e-9, 1e-8, 1e-3, 1.0, np.pi / 2, 3.0, np.pi - 1e-9, np.pi]


def cap_error(solid_angle):
    return max(
        float(scaled_ulps(solid_angle(angle), 2 * mpmath.pi * (1 - mpmath.cos(mpmath.mpf(angle))), 1.0))
        for angle in CAPS
    )


def test_cap_solid_angle_has_a_twin_and_its_textbook_form_fails():
    with mpmath.workdps(400):  # 1 − cos needs as many digits as it loses
        assert cap_error(cap_solid_angle) <= ULPS
        assert cap_error(lambda angle: 2 * np.pi * (1 - np.cos(angle))) > 1e6


@pytest.mark.parametrize("omega", [0.0, 1e-300, 1e-18, 1.0, 2 * np.pi, 12.0, 12.566370614, 4 * np.pi])
def test_cap_half_angle_has_a_twin(omega):
    share = mpmath.mpf(float(omega)) / (4 * mpmath.pi)
    truth = 2 * mpmath.asin(mpmath.sqrt(min(share, mpmath.mpf(1))))
    condition = mpmath.tan(truth / 2) / truth if 0 < omega < 4 * np.pi else 1.0
    value = cap_half_angle(omega)
    assert scaled_ulps(value, truth, float(condition)) <= (ULPS if omega < 4 * np.pi else 2**28)


def test_caps_go_there_and_back():
    angles = np.concatenate((np.geomspace(1e-150, 3.0, 100), [0.0, np.pi]))
    np.testing.assert_allclose(cap_half_angle(cap_solid_angle(angles)), angles, rtol=1e-14)
    assert cap_half_angle(4 * np.pi) == np.pi


@pytest.mark.parametrize("function", [cap_solid_angle, cap_half_angle])
@pytest.mark.parametrize("value", [-1e-9, 12.6, np.nan, None, "wide"])
def test_caps_refuse(function, value):
    with pytest.raises(
        ParameterError, match=r"is not allowed: it must be an? (solid )?angle in \[0, (4 )?pi\]"
    ):
        function(value)
