"""Shading: every method against exact values and the others, honest errors, plans, and bad input."""

from __future__ import annotations

import json
import math
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import mpmath
import numpy as np
import pytest

from radiokit.bsdfs.ggx import GGX
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.mirror import Mirror
from radiokit.bsdfs.phong import Phong
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, Claims
from radiokit.contracts.emitter import Emitter
from radiokit.emitters.constant import Constant
from radiokit.emitters.directional import Directional
from radiokit.emitters.point import Point
from radiokit.facts.directions import frame, reflect, to_local, to_world, unit
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.facts.estimate import rounding
from radiokit.measure.lune import lune
from radiokit.measure.montecarlo import mean
from radiokit.measure.statistics import binomial_interval, sidak
from radiokit.measure.warps import UniformCone
from radiokit.worlds.cases.catalogue import case
from radiokit.worlds.planning import METHODS
from radiokit.worlds.sampling import Sampler
from radiokit.worlds.scene import Receiver, irradiance
from radiokit.worlds.shading import explain, shade
from radiokit.worlds.terms import SMOOTH, Term

SAMPLED = ("mc-bsdf", "mc-light", "mis", "qmc")
LEVEL = sidak(1e-3, 100)  # all statistical tests in this file


def at(theta_deg, phi=0.0):
    theta = math.radians(theta_deg)
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


@dataclass(frozen=True, kw_only=True)
class Varnish(BSDF):
    """A mirror of reflectance ``gloss`` over a diffuse ground: a delta lobe and a smooth part."""

    name = "varnish"
    gloss: float = 0.25

    @property
    def claims(self):
        return Claims(reciprocity="yes", conserves=True)

    def evaluate(self, wi, wo):
        return np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), (1 - self.gloss) / np.pi, 0.0)

    def pdf(self, wi, wo):
        return 0.5 * Lambert().pdf(wi, wo)

    def sample(self, u, wo):
        shiny = u[:, 0] < 0.5
        again = np.stack([np.where(shiny, 2 * u[:, 0], 2 * u[:, 0] - 1), u[:, 1]], axis=-1)
        diffuse, _ = Lambert().sample(again, wo)
        wi = np.where(shiny[:, None], reflect(wo), diffuse)
        return wi, np.where(shiny, 2 * self.gloss, 2 * (1 - self.gloss))

    def delta_lobes(self, wo):
        return Mirror(reflectance=self.gloss).delta_lobes(wo)

    def symbolic(self):
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class Sun(Emitter):
    """A round light of angular radius ``half_angle`` around the zenith, with neither dome nor closed form."""

    name = "sun"
    half_angle: float = 0.2
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)

    @property
    def cone(self):
        return UniformCone(half_angle=self.half_angle)

    def radiance_from(self, direction, position):
        return np.where(self.pdf(direction, position) > 0, 5.0, 0.0)

    def sample(self, u, position):
        wi = self.cone.sample(u)
        return to_world(frame(self.direction), wi), self.cone.pdf(wi)

    def pdf(self, direction, position):
        return self.cone.pdf(np.einsum("ij,nj->ni", frame(self.direction), direction))

    def solid_angle(self, position):
        return rounding(4 * np.pi * math.sin(self.half_angle / 2) ** 2)


def checkers(wi, wo):
    """A material that no rule can integrate: it jumps across curves that are no coordinate lines."""
    return np.where(np.sin(37 * wi[:, 0]) * np.sin(41 * wi[:, 1] + wi[:, 0]) > 0, 0.5, 0.1) / np.pi


def spectral(wi, wo):
    return np.stack([np.full(len(wi), 0.25), 0.75 * wi[:, 2]], axis=-1) / np.pi


# --- methods agree ---

MATERIALS = [
    Lambert(reflectance=0.7),
    Phong(exponent=20, reflectance=0.8),
    GGX(alpha=0.3),
    GGX(alpha=0.8, eta=0.2, k=3.0),
    Varnish(),
]
LIGHTS = [
    Constant(radiance=1.5),
    Constant(radiance=2.0, normal=(0, 0, 1)),
    Constant(radiance=2.0, normal=(0.6, 0.5, 0.3)),
    Constant(radiance=2.0, normal=(0.5, -0.5, -0.6)),
    Sun(),
    Sun(half_angle=0.5, direction=at(30, 2.0)),
]


@pytest.mark.parametrize("light", LIGHTS, ids=repr)
@pytest.mark.parametrize("f", MATERIALS, ids=repr)
def test_methods_agree(f, light, rng):
    wo = at(50, 0.7)
    fine = shade(f, [light], wo, method="quadrature", rtol=1e-10)
    assert fine.converged
    for rtol in (1e-3, 1e-6):
        coarse = shade(f, [light], wo, method="quadrature", rtol=rtol)
        assert coarse.converged
        assert abs(coarse.value - fine.value) <= coarse.error + fine.error
        assert coarse.error <= rtol * coarse.value
    auto = shade(f, [light], wo)
    assert auto.covers(fine.value) or abs(auto.value - fine.value) <= auto.error + fine.error
    for method in SAMPLED:
        found = shade(f, [light], wo, method=method, samples=20_000, rng=rng)
        assert found.kind == "statistical"
        assert found.covers(fine.value, level=1 - LEVEL), method


@pytest.mark.parametrize("alpha", [0.05, 0.3, 1.0])
@pytest.mark.parametrize("theta_deg", [0, 60, 89])
def test_tilted_skies_add_up_to_the_sphere(alpha, theta_deg):
    """A sky and the sky below it make the whole sphere: two lunes against one hemisphere."""
    f, wo = GGX(alpha=alpha), at(theta_deg, 0.3)
    whole = shade(f, [Constant()], wo, rtol=1e-9)
    for zenith in (np.array([0.5, 0.2, 0.7]), np.array([-0.9, 0.1, 0.02])):
        halves = shade(f, [Constant(normal=zenith), Constant(normal=-zenith)], wo)
        assert halves.converged
        assert abs(halves.value - whole.value) <= halves.error + whole.error


@pytest.mark.parametrize("rest", [2.0, 0.1, 1e-4])
def test_lune_against_mpmath(rest):
    """∫ cosθ² over a lune of angle ``rest``, which is ∫ cos⁴λ dλ ∫ sin²χ dχ cosλ/cosλ: elementary."""
    zenith = (math.sin(rest), 0.0, -math.cos(rest))
    with mpmath.workdps(50):
        t = mpmath.mpf(rest)
        # ∫ cos³λ dλ = 4/3 over [−π/2, π/2] and ∫ sin²χ dχ = (t − sin t cos t)/2 over [0, t].
        truth = mpmath.mpf(4) / 3 * (t - mpmath.sin(t) * mpmath.cos(t)) / 2
        found = lune(lambda w: w[:, 2] ** 2, zenith, rtol=1e-9)
        assert found.converged
        assert abs(found.value - truth) <= found.error
        assert found.error <= 1e-9 * truth


def test_a_lune_of_no_size_and_one_that_is_the_hemisphere():
    assert lune(lambda w: w[:, 2], (0, 0, -1)).value == 0.0
    assert lune(lambda w: w[:, 2], (0, 0, 1)).covers(np.pi)


def test_a_retro_reflector_under_a_sky_is_found():
    wo = np.array(at(40, 0.5))

    def retro(wi, wo):
        return np.exp(-((1 - np.sum(wi * wo, axis=-1)) * 2000)) * 300

    sky = Constant(normal=(0.3, 0.2, 0.9))
    found = shade(retro, sky, wo, method="quadrature")
    assert found.converged
    assert found.covers(shade(retro, sky, wo, method="quadrature", rtol=1e-9).value)
    assert found.value == pytest.approx(300 * 2 * np.pi / 2000 * wo[2], rel=1e-2)


def test_the_world_may_be_turned(rng):
    """Turning lights, viewer and surface together changes nothing, for an anisotropic sky too."""
    f, wo = GGX(alpha=0.4), np.array(at(35, 1.0))
    zenith = unit([0.5, 0.3, 0.6])
    reference = shade(f, [Constant(normal=zenith), Directional(direction=at(20), irradiance=2)], wo)
    for normal in (unit(rng.normal(size=3)), np.array([0.0, 0.0, -1.0])):
        rows = frame(normal)
        lights = [
            Constant(normal=to_world(rows, zenith)),
            Directional(direction=to_world(rows, np.array(at(20))), irradiance=2),
        ]
        turned = shade(f, lights, to_world(rows, wo), normal=7 * normal)
        assert turned.value == pytest.approx(reference.value, rel=1e-12)


def test_the_viewer_may_be_anywhere_for_a_diffuse_surface():
    for wo in ((0, 0, 1), (0.6, 0, 0.8), at(89.9)):
        assert shade(Lambert(reflectance=0.5), [Constant()], wo).covers(0.5)


# --- delta lights and delta materials ---


@pytest.mark.parametrize(
    "f",
    [Lambert(reflectance=0.7), GGX(alpha=0.3), Varnish(), spectral],
    ids=lambda f: getattr(f, "__name__", repr(f)),
)
def test_delta_lights_are_summed(f):
    position, normal, wo = np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0]), np.array(at(40))
    lights = [
        Point(position=(2, 1, 7), intensity=30.0),
        Directional(direction=(1, 1, 1), irradiance=2.0),
        Point(position=(1, 2, -5), intensity=1e6),
    ]
    expected = 0.0
    for light in lights[:2]:
        towards = (
            np.subtract(light.position, position) if isinstance(light, Point) else np.array(light.direction)
        )
        r = np.linalg.norm(towards)
        wi = towards / r
        arriving = light.intensity / r**2 if isinstance(light, Point) else light.irradiance
        value = f.evaluate if isinstance(f, BSDF) else f
        expected = expected + value(wi[None], wo[None])[0] * arriving * (wi @ normal)
    found = shade(f, lights, wo, position=position)
    assert found.kind == "rounding"
    assert found.method == "sum"
    assert np.allclose(found.value, expected, rtol=1e-13)
    assert found.covers(expected)
    # The lights are exact under a Monte Carlo method too, and the sky beside them is not.
    mixed = shade(f, [*lights, Constant()], wo, position=position, method="mis", samples=5000, rng=1)
    sky = shade(f, [Constant()], wo, rtol=1e-8)
    assert mixed.covers(expected + sky.value, level=1 - LEVEL)


def test_a_mirror_looks_up_the_light_in_it():
    mirror, wo = Mirror(reflectance=0.8), at(30, math.pi)
    bright, dark = Constant(radiance=5.0, normal=(1, 0, 0)), Constant(radiance=5.0, normal=(-1, 0, 0))
    for method in ("auto", "sum"):
        assert shade(mirror, [bright], wo, method=method).value == 4.0
        assert shade(mirror, [dark], wo, method=method).value == 0.0
    with pytest.raises(RadiokitError, match=r"nothing is left to integrate here\. Use 'auto' or 'sum'"):
        shade(mirror, [bright], wo, method="mis")


def test_a_delta_light_on_a_delta_lobe_is_a_pair_of_measure_zero():
    wo = at(30)
    sun = Directional(direction=at(30, math.pi), irradiance=1.0)
    assert shade(Mirror(reflectance=1.0), [sun], wo).value == 0.0
    assert "measure zero" in str(explain(Mirror(reflectance=1.0), [sun], wo))
    found = shade(Varnish(gloss=0.25), [sun], wo)
    assert found.value == pytest.approx(0.75 / np.pi * math.cos(math.radians(30)), rel=1e-14)


def test_sampled_delta_lobes_are_not_counted_twice(rng):
    truth = 1.0  # 0.25 in the mirror, 0.75 off the ground
    for method in ("quadrature", *SAMPLED):
        found = shade(Varnish(gloss=0.25), [Constant()], at(70), method=method, samples=20_000, rng=rng)
        assert found.covers(truth, level=1 - LEVEL), method


# --- spectra and black boxes ---


def test_spectra(rng):
    wo = at(20)
    exact = np.array([0.25, 0.75 * 2 / 3])  # ∫ cos² dω = 2π/3
    for method in ("quadrature", *SAMPLED, "auto"):
        found = shade(spectral, [Constant()], wo, method=method, samples=20_000, rng=rng)
        assert found.value.shape == (2,)
        assert found.covers(exact, level=1 - LEVEL), method
    tilted = shade(spectral, [Constant(normal=(1, 0, 0))], wo)
    assert tilted.covers(exact / 2)
    assert shade(spectral, [Point(position=(0, 0, -1), intensity=1)], wo).value.tolist() == [0.0, 0.0]


def test_a_black_box_is_sampled_over_the_cosine():
    def half(wi, wo):
        return 0.5 / np.pi

    plan = explain(half, [Constant()], method="mc")
    assert plan.rows[0].method == "mis"
    assert explain(Lambert(), [Constant()], method="mc").rows[0].method == "mc-bsdf"
    assert explain(Lambert(), [Sun()], method="mc").rows[0].method == "mis"
    assert shade(half, [Constant()], (0, 0, 1), method="mc-bsdf", samples=100, rng=1).value == 0.5


# --- what quadrature cannot do ---


def pencil(turned):
    """A lobe without tails, half a milliradian wide, ``turned`` from the mirror direction, of albedo 1."""
    cone = UniformCone(half_angle=2.5e-4)

    def towards(wo):
        return frame(unit(reflect(wo) + turned))

    def in_lobe(wi, wo):
        return cone.pdf(to_local(towards(wo), wi))

    def f(wi, wo):
        return in_lobe(wi, wo) / np.maximum(wi[:, 2], 1e-9)

    def sample(u, wo):
        wi = to_world(towards(wo[0]), cone.sample(u))
        return wi, np.ones(len(u))

    return as_bsdf(f, label="pencil", pdf=lambda wi, wo: in_lobe(wi, wo[0]), sample=sample)


def test_a_lobe_that_slips_between_the_nodes_is_noticed(seed):
    """In a light a radian wide, where no one expects it, every rule agrees on 0."""
    wo, turned = np.array(at(20)), np.array([-0.1, 0.15, 0.0])
    model = pencil(turned)
    light = Sun(half_angle=0.5, direction=tuple(unit(reflect(wo) + np.array([0.05, 0.1, 0.0]))))
    forced = shade(model, [light], wo, method="quadrature")
    assert not forced.converged
    assert "narrow lobe" in forced.note
    assert abs(forced.value - 5.0) <= forced.error
    auto = shade(model, [light], wo, rng=seed)
    assert auto.kind == "statistical"
    assert auto.value == pytest.approx(5.0, rel=1e-3)


def test_a_lobe_without_tails_is_found_where_it_is_expected(seed):
    wo = np.array(at(20))
    light = Sun(half_angle=0.5, direction=tuple(unit(reflect(wo) + np.array([0.05, 0.1, 0.0]))))
    found = shade(pencil(np.zeros(3)), [light], wo, method="quadrature", rtol=1e-2)
    assert abs(found.value - 5.0) <= found.error < 0.5
    assert "around the lobe" in found.method


@pytest.mark.parametrize("f", [GGX(alpha=1e-4), Phong(exponent=1e6)], ids=repr)
def test_a_lobe_whose_tails_show_the_way_is_found(f):
    wo = np.array(at(20))
    light = Sun(half_angle=0.5, direction=tuple(unit(reflect(wo) + np.array([0.05, 0.1, 0.0]))))
    found = shade(f, [light], wo)
    assert found.converged
    whole = shade(f, [Constant(radiance=5.0)], wo)
    assert found.value == pytest.approx(whole.value, rel=1e-5)  # all but the tails see the light


def test_what_does_not_converge_says_so():
    auto = shade(checkers, Constant(), (0, 0, 1), rng=3)
    assert not auto.converged
    assert auto.note
    truth = shade(checkers, Constant(), (0, 0, 1), method="mis", samples=200_000, rng=4)
    assert abs(auto.value - truth.value) <= 4 * (auto.error + truth.error)


def setting_sun(theta_deg, half_angle):
    """Irradiance of a cone of radiance 5 at ``theta_deg``, in rings that the horizon clips."""
    theta = math.radians(theta_deg)
    n = 100_000
    a = (np.arange(n) + 0.5) * half_angle / n
    p, q = math.cos(theta) * np.cos(a), math.sin(theta) * np.sin(a)
    edge = np.arccos(np.clip(-p / q, -1, 1))
    return 5 * half_angle / n * np.sin(a) @ (2 * (p * edge + q * np.sin(edge)))


@pytest.mark.parametrize("half_angle", [0.2, 1.5])
@pytest.mark.parametrize("theta_deg", [60, 80, 85, 90, 95, 101])
def test_bounds_hold_where_the_horizon_cuts_the_light(theta_deg, half_angle):
    """Product rules agree here by chance, on values that are wrong by 27 times their bound."""
    light = Sun(half_angle=half_angle, direction=at(theta_deg, 0.3))
    truth = setting_sun(theta_deg, half_angle)
    for rtol in (1e-2, 1e-3):
        arriving = irradiance(light, rtol=rtol)
        assert arriving.converged
        assert abs(arriving.value - truth) <= arriving.error + 1e-8 * truth
        found = shade(Lambert(), light, (0, 0, 1), method="quadrature", rtol=rtol)
        assert abs(found.value - truth / np.pi) <= found.error + 1e-8 * truth


def test_a_material_that_is_not_finite_is_named():
    def broken(wi, wo):
        return np.where(wi[:, 2] > 0.99, np.nan, 1.0)

    for light in (Point(position=(0, 0, 1), intensity=1), Constant()):
        with pytest.raises(RadiokitError, match="nan"):
            shade(broken, light, (0, 0, 1))
        if not light.delta:
            with pytest.raises(RadiokitError, match="nan"):
                shade(broken, light, (0, 0, 1), method="mis", samples=1000, rng=1)


# --- statistics ---


def coverage(seed, shrink, count=200, samples=400, **options):
    """Of 200 furnaces, how many 95 % intervals hold the truth, and the interval for the probability."""
    f, wo, truth = GGX(alpha=1.0), at(60), 1 - 0.5 * math.log(3.0)
    seeds = np.random.SeedSequence(seed).generate_state(count, dtype=np.uint64)
    hits = 0
    for each in seeds:
        found = shade(f, [Constant()], wo, samples=samples, rng=int(each), **options)
        hits += abs(found.value - truth) <= 1.959963984540054 * found.error * shrink
    return binomial_interval(hits, count, level=1 - LEVEL)


@pytest.mark.parametrize("method", SAMPLED)
def test_intervals_cover_the_furnace(method, seed):
    low, high = coverage(seed, 1.0, method=method)
    assert low <= 0.95 <= high


def test_planted_intervals_that_are_too_short_are_rejected(seed):
    low, high = coverage(seed, 0.5, method="mis")
    assert not low <= 0.95 <= high


def covered(name, method, samples, seed, count, **options):
    """Of ``count`` answers to a case, how many 95 % intervals hold the truth."""
    problem = case(name)
    seeds = np.random.SeedSequence(seed).generate_state(count, dtype=np.uint64)
    answers = [problem.scene.shade(method, samples=samples, rng=int(each)) for each in seeds]
    return sum(answer.covers(problem.exact) for answer in answers)


@pytest.mark.parametrize("method", ["mc-bsdf", "mc-light", "mis"])
def test_intervals_of_500_seeds_cover_95_percent(method, seed):
    hits = sum(
        covered(name, method, 256, seed + k, 250)
        for k, name in enumerate(("ggx-1-in-furnace-at-60deg", "ggx-1-under-bright-cell"))
    )
    assert 0.93 <= hits / 500 <= 0.97


@pytest.mark.parametrize(
    "name",
    [
        "lambert-under-sphere-at-100m",
        "lambert-under-square-of-2cm",
        "lambert-under-sliver",
        "lambert-under-disk-huge",
    ],
)
@pytest.mark.parametrize("method", ["mis", "qmc"])
def test_rare_hits_and_rare_misses_are_foretold(name, method, seed):
    """Material samples hardly ever meet a tiny light, or miss a huge one: the interval allows for that."""
    _, high = binomial_interval(covered(name, method, 256, seed, 100), 100, level=1 - LEVEL)
    assert high >= 0.95


def test_planted_errors_without_what_is_foretold_are_too_small(seed):
    """What samples show of their variance is 0 where the rare ones, which carry it, are not among them."""
    problem = case("lambert-under-sphere-at-100m")
    term = term_of(problem)
    seeds = np.random.SeedSequence(seed).generate_state(50, dtype=np.uint64)
    sampler = Sampler(term, "mis")
    draw = lambda generator, n: sampler(generator.random((n, 4)))  # noqa: E731
    plain = [mean(draw, samples=256, rng=int(each)) for each in seeds]
    assert sum(answer.covers(problem.exact) for answer in plain) < 25


def term_of(problem):
    scene = problem.scene
    receiver = Receiver(scene.normal, scene.position)
    return Term(scene.f, scene.emitters[0], receiver, receiver.to_local(np.array(scene.wo)), SMOOTH)


def test_samples_of_the_material_that_meet_no_light_say_so(seed):
    problem = case("lambert-under-square-of-2cm")
    found = problem.scene.shade("mc-bsdf", samples=1000, rng=seed)
    assert not found.converged
    assert "hit the light about 0.1" in found.note
    assert abs(found.value - problem.exact) <= 4 * found.error
    seen = case("lambert-under-square-of-2m").scene.shade("mc-bsdf", samples=1000, rng=seed)
    assert seen.converged


STEPS = ("phong-10-under-disk", "phong-10-under-sphere", "phong-10-under-sphere-at-mirror")


@pytest.mark.parametrize("name", STEPS)
def test_lattices_that_agree_by_chance_on_a_step_do_not_claim_too_much(name, seed):
    """The light's edge is a step in one coordinate: sixteen counts of the points within it may agree."""
    problem = case(name)
    seeds = np.random.SeedSequence(seed).generate_state(60, dtype=np.uint64)
    found = [problem.scene.shade("qmc", samples=1024, rng=int(each)) for each in seeds]
    assert max(answer.ratio(problem.exact) for answer in found) < 5
    _, high = binomial_interval(sum(answer.covers(problem.exact) for answer in found), 60, level=1 - LEVEL)
    assert high >= 0.95


@pytest.mark.parametrize("method", SAMPLED)
def test_the_same_seed_gives_the_same_answer(method, seed):
    def run(rng, executor=None):
        lights = [Constant(normal=(1, 0, 1)), Sun()]
        return shade(
            GGX(alpha=0.5),
            lights,
            at(45),
            method=method,
            samples=150_000 if executor else 2000,
            rng=rng,
            executor=executor,
        )

    assert run(seed).value == run(seed).value
    assert run(np.random.default_rng(seed)).value == run(np.random.default_rng(seed)).value
    assert run(seed).value != run(seed + 1).value
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(3) as three:
        assert run(seed, one).value == run(seed, three).value


def test_two_terms_do_not_share_their_random_numbers(seed):
    """Else the errors of two equal lights would add up in step, and twice the light be half as certain."""
    light = Sun()
    once = shade(Lambert(), [light], (0, 0, 1), method="mc-light", samples=500, rng=seed)
    twice = shade(Lambert(), [light, light], (0, 0, 1), method="mc-light", samples=500, rng=seed)
    assert twice.value != 2 * once.value
    assert twice.error == pytest.approx(math.sqrt(2) * once.error, rel=0.2)


def test_sampling_stops_at_the_tolerance(seed):
    found = shade(Lambert(), [Constant()], (0, 0, 1), method="mc-light", rtol=5e-3, rng=seed)
    assert found.converged
    assert found.evaluations < 1 << 20
    assert found.error <= 5e-3 * found.value
    short = shade(Lambert(), [Constant()], (0, 0, 1), method="mis", samples=1000, rng=seed)
    assert short.evaluations == 1000
    assert short.converged


# --- budgets ---


BROAD, NARROW = Sun(half_angle=0.5), Sun(half_angle=0.01, direction=at(30, 2.0))


@pytest.mark.parametrize("method", ["auto", "quadrature", "mc-bsdf", "mc-light", "mis", "qmc"])
@pytest.mark.parametrize("evaluations", [100, 3000, 20_000])
def test_a_budget_of_evaluations_is_kept(method, evaluations, seed):
    f, lights = GGX(alpha=0.05), [BROAD, Constant(), NARROW]
    found = shade(f, lights, at(20), method=method, rtol=1e-9, evaluations=evaluations, rng=seed)
    spent = found.evaluations * (2 if "mis" in found.method else 1)
    assert spent <= max(evaluations, 0) + 3 * 6000  # three terms, each by a search and the first rules
    if method in SAMPLED:
        assert spent <= max(2 * evaluations, 3 * 32)
    assert found.converged or "of the asked" in found.note
    if method != "quadrature" or evaluations > 3000:
        exact = shade(f, lights, at(20), rtol=1e-8)
        assert abs(found.value - exact.value) <= 5 * found.error + exact.error


def test_what_a_budget_does_not_reach_is_said(seed):
    found = shade(Lambert(), [BROAD], (0, 0, 1), method="mis", rtol=1e-6, evaluations=10_000, rng=seed)
    assert not found.converged
    assert found.evaluations == 5000
    assert "reached ± " in found.note
    assert "within 10000 evaluations" in found.note
    ample = shade(GGX(alpha=0.3), [BROAD], at(20), rtol=1e-6, evaluations=10**6)
    assert ample.converged
    assert ample.value == shade(GGX(alpha=0.3), [BROAD], at(20), rtol=1e-6).value
    cut = shade(Lambert(), [BROAD], (0, 0, 1), method="mis", samples=10_000, evaluations=10_000, rng=seed)
    assert not cut.converged
    assert "the budget allowed for 5000 of 10000 samples" in cut.note
    exact = shade(Lambert(), [Constant()], (0, 0, 1), evaluations=1)
    assert exact.method == "closed form"


def test_a_budget_is_shared_among_the_terms(seed):
    """Each gets an equal part of what is left: what the first does not need, the others may use."""
    lights = [Constant(), BROAD, Point(position=(0, 0, 1), intensity=1.0)]
    found = shade(spectral, lights, (0, 0, 1), method="mc-light", rtol=1e-9, evaluations=40_000, rng=seed)
    assert found.evaluations == pytest.approx(40_000, rel=0.01)
    one = shade(spectral, BROAD, (0, 0, 1), method="mc-light", rtol=1e-9, evaluations=40_000, rng=seed)
    assert one.evaluations == 40_000


@pytest.mark.parametrize("method", ["auto", "quadrature", "mis", "qmc"])
def test_a_budget_of_time_is_kept(method, seed):
    start = time.perf_counter()
    found = shade(checkers, [BROAD, Constant()], at(20), method=method, rtol=1e-9, seconds=0.05, rng=seed)
    assert time.perf_counter() - start < 60  # a bound that holds on a busy machine
    assert not found.converged
    assert "within 0.05 s" in found.note


# --- degenerate input ---


def test_no_light_is_dark():
    found = shade(GGX(alpha=0.3), [], (0, 0, 1))
    assert found.value == found.error == 0.0
    assert "no light" in str(explain(GGX(alpha=0.3), []))


@pytest.mark.parametrize("f", [Lambert(), GGX(alpha=0.3), Mirror()], ids=repr)
def test_light_from_behind_does_not_count(f):
    behind = [
        Point(position=(0, 0, -1), intensity=1),
        Directional(direction=(1, 0, 0), irradiance=1),
        Constant(normal=(0, 0, -1)),
    ]
    assert shade(f, behind, at(30)).value == 0.0


@pytest.mark.parametrize("wo", [(0.0, 0.6, -0.8), (1.0, 0.0, 0.0)])
def test_a_viewer_below_the_horizon_sees_nothing(wo):
    lights = [Constant(), Point(position=(0, 0, 1), intensity=1)]
    for f in (Lambert(), GGX(alpha=0.3), Mirror()):
        found = shade(f, lights, wo)
        assert found.value == 0.0
    assert "not above the horizon" in shade(Lambert(), lights, wo).note


BAD = [
    ("wo", {"wo": (0, 0, 2)}),
    ("wo", {"wo": (math.nan, 0, 1)}),
    ("wo", {"wo": [(0, 0, 1), (0, 0, 1)]}),
    ("normal", {"normal": (0, 0, 0)}),
    ("normal", {"normal": (0, math.nan, 1)}),
    ("position", {"position": (math.nan, 0, 0)}),
    ("position", {"position": (0, 0, 1)}),
    ("rtol", {"rtol": 0.0}),
    ("rtol", {"rtol": math.nan}),
    ("emitter", {"emitters": ["sun"]}),
    ("function", {"f": 3}),
    ("samples", {"emitters": [Constant()], "method": "mis", "samples": 0}),
    ("rng", {"rng": -1}),
    ("seconds", {"seconds": 0.0}),
    ("seconds", {"seconds": math.nan}),
    ("seconds", {"seconds": "soon"}),
    ("evaluations", {"evaluations": 0}),
    ("evaluations", {"evaluations": 10.5}),
]


@pytest.mark.parametrize(("name", "change"), BAD, ids=str)
def test_bad_arguments_are_named(name, change):
    arguments = {
        "f": Lambert(),
        "emitters": [Point(position=(0, 0, 1), intensity=1)],
        "wo": (0, 0, 1),
    } | change
    with pytest.raises(ParameterError, match=name):
        shade(**arguments)


def test_methods_that_do_not_apply_name_those_that_do():
    lambert, rough, sky = Lambert(), GGX(alpha=0.3), Constant()
    point = Point(position=(0, 0, 1), intensity=1)
    with pytest.raises(UnknownNameError, match="did you mean 'quadrature'"):
        shade(lambert, [sky], (0, 0, 1), method="quadratur")
    with pytest.raises(RadiokitError, match=r"'closed form' does not apply to constant, smooth.*'mis'"):
        shade(rough, [sky], (0, 0, 1), method="closed form")
    with pytest.raises(RadiokitError, match=r"'sum' does not apply .* continuum"):
        shade(rough, [point, sky], (0, 0, 1), method="sum")
    with pytest.raises(RadiokitError, match="'auto' or 'sum' or 'closed form'"):
        shade(lambert, [point], (0, 0, 1), method="quadrature")
    assert shade(lambert, [point], (0, 0, 1), method="closed form").covers(1 / np.pi)
    assert shade(lambert, [point, sky], (0, 0, 1), method="closed form").covers(1 + 1 / np.pi)


# --- plans ---


def test_the_plan_says_what_is_done_and_why():
    lights = [
        Point(position=(0, 0, 1), intensity=1),
        Constant(),
        Constant(normal=(1, 0, 1)),
        Sun(),
    ]
    plan = explain(Varnish(), lights)
    assert [row.name for row in plan.rows] == [
        "point, delta light",
        "constant, delta lobes",
        "constant, smooth",
        "constant, delta lobes",
        "constant, smooth",
        "sun, delta lobes",
        "sun, smooth",
    ]
    methods = [row.method for row in plan.rows]
    assert methods == ["sum", "sum", "quadrature", "sum", "quadrature", "sum", "quadrature"]
    assert "slope coordinates" in plan.rows[2].why
    assert "lune" in plan.rows[4].why
    assert "square" in plan.rows[6].why
    data = json.loads(json.dumps(plan.to_json(), allow_nan=False))
    assert data["rows"][2]["alternatives"] == list(SAMPLED)
    html = plan._repr_html_()
    assert html.count("<tr>") == 8
    for row in plan.rows:
        assert row.why in str(plan)
        assert row.evaluations >= 0


def test_the_plan_is_what_happens():
    for f in (Lambert(), GGX(alpha=0.3), Mirror()):
        for light in (Constant(), Point(position=(0, 0, 1), intensity=1)):
            (row,) = explain(f, [light], at(30)).rows
            found = shade(f, [light], at(30))
            assert {"sum": "sum", "closed form": "closed form"}.get(row.method, "slope-space") in found.method
            assert found.evaluations / 4 <= row.evaluations <= 4 * found.evaluations
            for method in row.alternatives:
                assert method in METHODS
                shade(f, [light], at(30), method=method, samples=100, rng=1)


FORETOLD = (
    "ggx-1-in-furnace-at-60deg",
    "ggx-1-under-bright-cell",
    "lambert-under-disk-off-axis",
    "phong-20-under-square",
    "phong-10-under-sphere-at-mirror",
    "lambert-under-square-tilted-much",
)


@pytest.mark.parametrize("name", FORETOLD)
def test_costs_are_foretold_in_order_of_magnitude(name, seed):
    scene = case(name).scene
    place = {"normal": scene.normal, "position": scene.position}
    for method, rtol in (("quadrature", 1e-3), ("quadrature", 1e-6), *((each, 1e-2) for each in SAMPLED)):
        (row,) = explain(scene.f, scene.emitters, scene.wo, method=method, rtol=rtol, **place).rows
        found = shade(scene.f, scene.emitters, scene.wo, method=method, rtol=rtol, rng=seed, **place)
        spent = found.evaluations * (2 if "mis" in found.method else 1)
        assert found.converged, method
        assert 0.1 < row.evaluations / spent < 10, (method, rtol)
        assert row.error <= rtol * 1.01
        (again,) = explain(scene.f, scene.emitters, scene.wo, method=method, rtol=rtol, **place).rows
        assert again == row


def test_the_plan_says_what_the_alternatives_would_cost():
    plan = explain(GGX(alpha=0.3), BROAD, at(20), rtol=1e-6)
    (row,) = plan.rows
    assert [cost.method for cost in row.costs] == list(row.alternatives) == list(SAMPLED)
    by_name = {cost.method: cost for cost in row.costs}
    assert by_name["mis"].evaluations > 1e9  # (σ/(rtol μ))²
    assert 1e-5 < by_name["mis"].error < 1e-2  # with the 2²⁰ samples at which it stops
    assert by_name["mis"].seconds > 60
    assert row.seconds < 0.1
    assert "mis: about" in str(plan)
    assert "reaching ±" in str(plan)
    data = json.loads(json.dumps(plan.to_json(), allow_nan=False))
    assert data["rows"][0]["costs"][0]["method"] == "mc-bsdf"
    few = explain(GGX(alpha=0.3), BROAD, at(20), rtol=1e-6, evaluations=1000)
    assert few.rows[0].method == "qmc"
    assert "budget" in few.rows[0].why
    assert few.rows[0].evaluations <= 1000
    quick = explain(GGX(alpha=0.3), BROAD, at(20), method="mis", seconds=1e-3)
    assert quick.rows[0].error > by_name["mis"].error


def test_a_plan_escapes_html():
    def f(wi, wo):
        return 1 / np.pi

    f.__name__ = "<b>"
    assert "&lt;b&gt;" in explain(f, [Constant()])._repr_html_()
