"""Round lights that the horizon cuts: their pieces against closed forms and masked rules; area sampling."""

from __future__ import annotations

import dataclasses
import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.contracts.bsdf import bsdf
from radiokit.contracts.chords import CapPatch, DiskPatch
from radiokit.emitters.disk import Disk
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.sphere import Sphere
from radiokit.facts.directions import unit
from radiokit.measure.statistics import chi_square, sidak
from radiokit.worlds.finite import over_light
from radiokit.worlds.scene import Receiver, irradiance
from radiokit.worlds.shading import shade

ORIGIN = np.zeros(3)
UP = (0.0, 0.0, 1.0)

CUT = {
    "sphere below": Sphere(center=(2, 0, -0.5), radius=1, radiance=1.5),
    "sphere above": Sphere(center=(2, 0.3, 0.5), radius=1, radiance=1.5),
    "sphere in half": Sphere(center=(0, 3, 0), radius=1, radiance=1.5),
    "sphere near": Sphere(center=(1.01, 0, -0.3), radius=1, radiance=1.5),
    "sphere all but touched": Sphere(center=(1 + 1e-9, 0, 0.3), radius=1, radiance=1.5),
    "sphere's sliver": Sphere(center=(2, 0, -1 + 1e-9), radius=1, radiance=1.5),
    "sphere all but whole": Sphere(center=(2, 0, 1 - 1e-9), radius=1, radiance=1.5),
    "sphere tiny": Sphere(center=(2, 1, 1e-9), radius=1e-8, radiance=1.5),
    "disk upright": Disk(center=(2, 0.5, 0.3), normal=(-1, 0, 0), radius=1, radiance=1.5),
    "disk aslant": Disk(center=(2, 0.5, -0.3), normal=(-1, 0.2, 0.4), radius=1, radiance=1.5),
    "disk overhead": Disk(center=(2, 0.5, 0.1), normal=(-0.1, 0.1, -1), radius=1, radiance=1.5),
    "disk's sliver": Disk(center=(2, 0.5, -1 + 1e-6), normal=(-1, 0, 0), radius=1, radiance=1.5),
    "disk tiny": Disk(center=(2, 1, 1e-9), normal=(-1, 0, 0), radius=1e-8, radiance=1.5),
}


def by_quadrature(light, normal=UP, position=ORIGIN, rtol=1e-10):
    receiver = Receiver(normal, position)

    def arriving(piece):
        return lambda wi: piece.radiance_from(wi, receiver.origin) * np.maximum(wi @ receiver.axis, 0.0)

    return over_light(arriving, light, receiver, rtol)


@pytest.mark.parametrize("name", CUT)
def test_what_is_left_of_a_cut_light_is_smooth(name):
    light = CUT[name]
    exact = light.irradiance_at(ORIGIN, np.array(UP))
    found = by_quadrature(light)
    assert found.converged
    assert found.evaluations <= 5000
    assert abs(found.value - exact.value) <= found.error + exact.error
    # a height of 1e-9 is known to seven digits
    assert found.value == pytest.approx(
        exact.value, rel=1e-6 if "sliver" in name or "tiny" in name else 1e-12
    )
    (piece,) = light.pieces(ORIGIN, np.array(UP))
    assert isinstance(piece.patch, CapPatch if isinstance(light, Sphere) else DiskPatch)
    x = np.linspace(0, 1, 9)
    wi, density = piece.sample(np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2), ORIGIN)
    assert np.abs(np.linalg.norm(wi, axis=1) - 1).max() < 1e-15
    assert wi[:, 2].min() > -1e-15
    assert (light.radiance_from(wi * (1 - 1e-16), ORIGIN)[density < 1e12] > 0).all()


@pytest.mark.parametrize("kind", ["sphere", "disk"])
def test_pieces_of_lights_of_any_pose(kind, rng):
    for _ in range(20):
        normal, m, aside = unit(rng.normal(size=(3, 3)))
        position = rng.normal(size=3)
        radius = float(rng.uniform(0.2, 1.5))
        across = unit(aside - (aside @ normal) * normal)
        center = position + rng.uniform(-1, 1) * radius * normal + (radius + rng.uniform(0.1, 3)) * across
        if kind == "sphere":
            light = Sphere(center=center, radius=radius, radiance=1.0)
        else:
            m = -m if m @ (center - position) > 0 else m
            light = Disk(center=center, normal=m, radius=radius, radiance=1.0)
        exact = irradiance(light, normal=normal, position=position)
        found = by_quadrature(light, normal, position, rtol=1e-8)
        assert abs(found.value - exact.value) <= found.error + exact.error
        assert found.value == pytest.approx(exact.value, rel=1e-7)


def test_a_planted_wrong_piece_is_found():
    light = CUT["sphere below"]
    (piece,) = light.pieces(ORIGIN, np.array(UP))
    wrong = dataclasses.replace(
        piece, patch=dataclasses.replace(piece.patch, turn=piece.patch.turn * (1 + 1e-7))
    )
    exact = light.irradiance_at(ORIGIN, np.array(UP)).value
    x, w = np.polynomial.legendre.leggauss(40)
    u = np.stack(np.meshgrid(0.5 * (x + 1), 0.5 * (x + 1), indexing="ij"), axis=-1).reshape(-1, 2)

    def integral(p):
        wi, density = p.sample(u, ORIGIN)
        return float(np.sum(np.outer(w, w).ravel() / 4 * 1.5 * wi[:, 2] / density))

    assert integral(piece) == pytest.approx(exact, rel=1e-12)
    assert integral(wrong) != pytest.approx(exact, rel=1e-12)


def test_lights_that_are_not_cut_are_themselves_or_nothing():
    up = np.array(UP)
    for light in (Sphere(center=(0, 0, 2), radius=1, radiance=1),
                  Disk(center=(0, 0, 2), normal=(0, 0, -1), radius=1, radiance=1)):  # fmt: skip
        assert list(light.pieces(ORIGIN, up)) == [light]
        assert not light.pieces(ORIGIN, -up)
    behind = Disk(center=(0, 0, 2), normal=(0, 0, 1), radius=1, radiance=1)
    assert not behind.pieces(ORIGIN, up)
    assert irradiance(dataclasses.replace(behind, exponent=2.0), position=(0.1, 0, 0)).value == 0.0


def test_a_cut_disk_with_an_exponent_to_twelve_digits():
    """Over the part of the disk above the horizon, by mpmath."""
    light = Disk(center=(2, 0.5, 0.3), normal=(-1, 0, 0), radius=1, radiance=1.0, exponent=3.0)
    found = irradiance(light, rtol=1e-10)

    with mpmath.workdps(18):

        def across(z):
            half = mpmath.sqrt(max(1 - (z - mpf(0.3)) ** 2, 0))

            def point(y):
                return 16 * z / (4 + y * y + z * z) ** mpf(3.5)  # cosθ cos⁴θ'/r²

            return mpmath.quad(point, [mpf(0.5) - half, mpf(0.5) + half])

        truth = mpmath.quad(across, [0, 1 + mpf(0.3)])
    assert found.value == pytest.approx(float(truth), rel=1e-12)
    assert found.error <= 1e-10 * found.value
    assert found.evaluations <= 5000


@pytest.mark.parametrize("height", [0.3, -0.3])
def test_a_glossy_surface_under_a_cut_sphere(height):
    """GGX: evaluations stay as few as for a light that is wholly seen, and light samples agree."""
    light = Sphere(center=(2, 0, height), radius=1, radiance=1.0)
    f, wo = bsdf("ggx", alpha=0.3), (-0.8, 0.0, 0.6)
    found = shade(f, light, wo, rtol=1e-8, method="quadrature")
    assert found.converged
    assert found.evaluations <= 20_000
    x = (np.arange(1500) + 0.5) / 1500
    wi, density = light.sample(np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2), ORIGIN)
    kept = wi[:, 2] > 0
    values = f.evaluate(wi[kept], np.broadcast_to(wo, wi[kept].shape)) * wi[kept, 2] / density[kept]
    assert found.value == pytest.approx(float(np.sum(values)) / len(wi), rel=1e-4)


# --- evenly over the area ---

BY_AREA = {
    "sphere": Sphere(center=(0.5, 0.2, 3), radius=1, radiance=2.0, sampling="area"),
    "sphere near": Sphere(center=(0, 0.6, 0.9), radius=1, radiance=2.0, sampling="area"),
    "disk": Disk(center=(1, -2, 2), normal=(-1, 1, -3), radius=1.5, radiance=2.0, sampling="area"),
    "disk near": Disk(center=(0.4, 0.2, 0.5), normal=(0, 0, -1), radius=2, radiance=2.0, sampling="area"),
}
LEVEL = sidak(1e-3, 2 * len(BY_AREA))


def where_hit(light, wi):
    """Coordinates in [0, 1]² of the points hit that are even over the area, and r²/(A cosθ)."""
    center, radius = np.array(light.center), light.radius
    if isinstance(light, Sphere):
        distance = float(np.linalg.norm(center))
        axis, along = center / distance, wi @ center
        slant = np.sqrt(np.maximum(radius**2 - distance**2 + along**2, 0.0))
        reach = along - slant
        q = (wi * reach[:, None] - center) / radius
        height = (-(q @ axis) - radius / distance) / (1 - radius / distance)
        area, cosine = 2 * np.pi * radius**2 * (1 - radius / distance), slant / radius
    else:
        axis = np.array(light.normal)
        cosine = -(wi @ axis)
        reach = -(center @ axis) / cosine
        q = (wi * reach[:, None] - center) / radius
        height = np.sum(q * q, axis=1)
        area = np.pi * radius**2
    first = unit(np.cross(axis, [0.3, 0.8, -0.2]))
    turn = np.arctan2(q @ np.cross(axis, first), q @ first) / (2 * np.pi) % 1.0
    return np.stack((height, turn), axis=-1), reach**2 / (area * cosine)


@pytest.mark.parametrize("planted", [False, True], ids=["right", "planted"])
@pytest.mark.parametrize("name", BY_AREA)
def test_points_are_spread_evenly_over_the_area(name, planted, rng):
    light = BY_AREA[name]
    u = rng.random((40_000, 2))
    if planted:
        u[:, 0] **= 1.1
    directions, density = light.sample(u, ORIGIN)
    assert np.abs(np.linalg.norm(directions, axis=1) - 1).max() < 1e-15
    assert (light.radiance_from(directions, ORIGIN) > 0).all()
    places, exact = where_hit(light, directions)
    inside = places[:, 0] < 0.9999 if "disk" in name else places[:, 0] > 0.01  # the rim is a pole of 1/cosθ
    assert density[inside] == pytest.approx(exact[inside], rel=1e-8)
    assert light.pdf(directions, ORIGIN)[inside] == pytest.approx(density[inside], rel=1e-8)
    counts = np.histogram2d(*places.T, bins=8, range=[[-1e-9, 1 + 1e-9], [0, 1]])[0]
    p_value = chi_square(counts.ravel(), np.full(64, len(u) / 64)).p_value
    assert p_value < 1e-6 if planted else p_value > LEVEL


@pytest.mark.parametrize("name", BY_AREA)
def test_the_density_of_the_area_is_one_of_directions(name, rng):
    """Its mean over directions that are even in solid angle is 1/Ω, and beside the light it is 0."""
    light = BY_AREA[name]
    even = dataclasses.replace(light, sampling="solid angle")
    u = rng.random((200_000, 2))
    directions, density = even.sample(u, ORIGIN)
    ratio = light.pdf(directions, ORIGIN) / density
    ratio = ratio[np.isfinite(ratio)]
    assert abs(ratio.mean() - 1) <= 6 * ratio.std() / math.sqrt(len(ratio))
    assert not light.pdf(-directions[:9], ORIGIN).any()
    back = 3 * np.array(light.center)
    if isinstance(light, Disk):
        assert not light.sample(u[:9], back)[1].any()
        assert not light.pdf(-directions[:9], back).any()


@pytest.mark.parametrize("light", [
    *BY_AREA.values(),
    Rectangle(center=(0.2, 0.1, 1), normal=(0, 0, -1), width=2, height=0.5, radiance=2.0, sampling="area"),
    Sphere(center=(2, 0, 0.3), radius=1, radiance=2.0, sampling="area"),
    Disk(center=(2, 0, 0.3), normal=(-1, 0, 0), radius=1, radiance=2.0, sampling="area", exponent=2.0),
], ids=[*BY_AREA, "rectangle", "sphere cut", "disk cut"])  # fmt: skip
def test_shading_does_not_depend_on_how_a_light_is_sampled(light, seed):
    f, wo = bsdf("ggx", alpha=0.4), (0.0, 0.6, 0.8)
    truth = shade(f, dataclasses.replace(light, sampling="solid angle"), wo, rtol=1e-7)
    for method in ("mc-light", "mis"):
        found = shade(f, light, wo, method=method, samples=1 << 15, rng=seed)
        assert abs(found.value - truth.value) <= 5 * found.error
        assert found.error <= 0.1 * found.value
