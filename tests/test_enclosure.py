"""Enclosure: the geometric series, its statistics, and the rooms in which there is no answer."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.statistics import binomial_interval, sidak, z_test
from radiokit.worlds.enclosure import enclosure_radiance

LEVEL = sidak(1e-3, 20)  # all statistical tests in this file


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
