"""Rays: distances to spheres, planes and boxes, against exact arithmetic on the same floats."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.faces.render.camera import Camera
from radiokit.measure.rays import through_box, to_plane, to_sphere
from radiokit.measure.twin import working_precision

LIMIT = 16.0
"""Worst error allowed, in units of eps over the condition number."""

EPS = 2.0**-52


def sphere_distance(origin, direction, center, radius):
    """The nearer root of |o + tw − c|² = r², and the relative condition number of the ray's data."""
    o, w, c = ([mpf(float(x)) for x in v] for v in (origin, direction, center))
    r = mpf(float(radius))
    to = [b - a for a, b in zip(o, c, strict=True)]
    a = sum(x * x for x in w)
    b = sum(x * y for x, y in zip(to, w, strict=True))
    square = sum(x * x for x in to)
    under = b * b - a * (square - r * r)
    if under < 0 or b <= 0:
        return mpmath.inf, 1.0
    half = mpmath.sqrt(under)
    t = (b - half) / a
    # t changes by |D|·δ/(r cosθ) for a turn δ of the ray, with h = r cosθ; so do the other data.
    across = mpmath.sqrt(max(mpf(0), square - b * b / a))
    size = mpmath.sqrt(square)
    return t, float(1 + size * (size + across) / (half * t)) if half else mpmath.inf


def directions(rng, towards, spread, n):
    w = np.asarray(towards, float) + spread * rng.normal(size=(n, 3))
    return w / np.linalg.norm(w, axis=1)[:, None]


@pytest.mark.parametrize(
    ("origin", "center", "radius"),
    [
        ((0, -6, 0), (0, 0, 0), 1.0),
        ((0, -6, 0), (0, 0, 0), 1e-6),  # b² − 4ac has no digit of it left
        ((0, -1.000001, 0), (0, 0, 0), 1.0),  # next to the surface
        ((1e6, 2e6, 3e6), (0, 0, 0), 1e3),
    ],
    ids=repr,
)
def test_distances_to_spheres_at_50_digits(origin, center, radius, rng):
    o, c = np.array(origin, float), np.array(center, float)
    way = c - o
    spread = radius / np.linalg.norm(way) / np.sqrt(3)
    rays = directions(rng, way / np.linalg.norm(way), spread, 200)
    found = to_sphere(o, rays, center=c, radius=radius)
    met = 0
    with working_precision(60):
        for ray, t in zip(rays, found, strict=True):
            truth, condition = sphere_distance(o, ray, c, radius)
            if condition > 1e9 or (math.isinf(truth) and math.isinf(t)):
                continue  # within rounding of the edge, where a hit may be a miss
            met += 1
            assert abs(mpf(float(t)) - truth) <= LIMIT * EPS * condition * truth
    assert 20 <= met < 200


def test_the_textbook_formula_fails_where_ours_does_not():
    """A planted b² − 4ac: a small far sphere, seen through its middle."""
    origin, radius = np.array([0.0, -1e5, 0.0]), 1e-4
    ray = np.array([[0.0, 1.0, 0.0]])
    found = float(to_sphere(origin, ray, center=np.zeros(3), radius=radius)[0])
    b, c = 2 * origin[1], origin[1] ** 2 - radius**2
    textbook = (-b - math.sqrt(b * b - 4 * c)) / 2
    assert abs(found - (1e5 - 1e-4)) <= 2e-11
    assert abs(textbook - (1e5 - 1e-4)) > 5e-5


def test_grazing_rays_of_a_camera_at_50_digits():
    """The pixels at the rim of a sphere: a hit is a hit, and the error is that of the ray's own rounding."""
    camera = Camera(position=(0, -6, 0), field=0.36, width=96, height=96)
    o, c = np.array(camera.position), np.zeros(3)
    rays = camera.rays.reshape(-1, 3)
    found = to_sphere(o, rays, center=c, radius=1.0)
    points = o + np.where(np.isfinite(found), found, 0)[:, None] * rays
    cosine = -(points * rays).sum(axis=1)
    grazing = np.flatnonzero(np.isfinite(found) & (cosine < 0.1))
    assert len(grazing) > 10
    with working_precision(60):
        for k in grazing:
            truth, condition = sphere_distance(o, rays[k], c, 1.0)
            assert abs(mpf(float(found[k])) - truth) <= LIMIT * EPS * condition * truth


def test_rays_that_miss_or_look_away(rng):
    away = np.array([[0.0, -1.0, 0.0], [0.0, 0.6, 0.8]])
    assert np.all(np.isinf(to_sphere(np.array([0.0, -6.0, 0.0]), away, center=np.zeros(3), radius=1.0)))
    up = np.array([0.0, 0.0, 1.0])
    level = np.array([[1.0, 0.0, 0.0], [0.6, 0.0, 0.8]])
    assert np.all(np.isinf(to_plane(np.array([0.0, 0.0, 2.0]), level, point=np.zeros(3), normal=up)))


def test_planes_in_exact_arithmetic(rng):
    origin, point, normal = rng.normal(size=3), rng.normal(size=3), np.array([0.0, 0.0, 1.0])
    rays = directions(rng, (0, 0, 0), 1.0, 100)
    found = to_plane(origin, rays, point=point, normal=normal)
    for ray, t in zip(rays, found, strict=True):
        truth = (Fraction(point[2]) - Fraction(origin[2])) / Fraction(ray[2])
        if truth > 0:
            assert abs(Fraction(float(t)) - truth) <= 2 * Fraction(EPS) * truth
        else:
            assert np.isinf(t)


def test_boxes_in_exact_arithmetic(rng):
    low, high = np.array([-1.0, 0.0, 2.0]), np.array([1.0, 0.5, 7.0])
    rays = directions(rng, (0, 0, 0), 1.0, 300)
    rays[:20, 0] = 0.0
    rays[10:30, 1] = 0.0
    outside, inside = np.array([-1.5, -0.25, 1.0]), np.array([0.3, 0.1, 3.0])
    for origin in (outside, inside):
        enter, leave, first, last = through_box(origin, rays, low=low, high=high)
        hits = 0
        for k, ray in enumerate(rays):
            near, far = [], []
            for axis in range(3):
                ends = [Fraction(low[axis]), Fraction(high[axis])]
                if ray[axis]:
                    way = [(e - Fraction(origin[axis])) / Fraction(ray[axis]) for e in ends]
                    near.append((min(way), 2 * axis + (ray[axis] < 0)))
                    far.append((max(way), 2 * axis + (ray[axis] > 0)))
                elif not ends[0] <= Fraction(origin[axis]) <= ends[1]:
                    far.append((Fraction(-1), 0))
            t_in, t_out = max(near), min(far)
            if t_in[0] <= t_out[0] and t_out[0] > 0:
                hits += 1
                assert abs(Fraction(float(enter[k])) - t_in[0]) <= 4 * Fraction(EPS) * abs(t_in[0])
                assert abs(Fraction(float(leave[k])) - t_out[0]) <= 4 * Fraction(EPS) * t_out[0]
                assert (first[k], last[k]) == (t_in[1], t_out[1])
            else:
                assert np.isinf(leave[k])
        assert hits == len(rays) if origin is inside else hits > 3


def test_a_camera_is_symmetric_and_square():
    camera = Camera(position=(1, 2, 3), target=(4, -2, 3.5), field=0.7, width=6, height=4)
    rays = camera.rays
    assert rays.shape == (4, 6, 3)
    assert np.allclose(np.linalg.norm(rays, axis=-1), 1.0, rtol=0, atol=4e-16)
    ahead = (rays[0, 0] + rays[3, 5]) / np.linalg.norm(rays[0, 0] + rays[3, 5])
    truth = np.subtract((4, -2, 3.5), (1, 2, 3))
    assert np.allclose(ahead, truth / np.linalg.norm(truth), atol=1e-15)
    assert rays[0, 2, 2] > rays[3, 2, 2]  # the top row looks up
    edge = Camera(position=(0, -1, 0), field=0.7, width=1, height=10001).rays
    assert math.atan2(edge[0, 0, 2], edge[0, 0, 1]) == pytest.approx(0.35, rel=1e-3)
