"""Integrating sphere: the books' formulas at 50 digits, on ordinary spheres and on nearly white ones."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.facts.errors import ParameterError
from radiokit.measure.twin import scaled_ulps, working_precision
from radiokit.physics.integrating_sphere import SPEED_OF_LIGHT, IntegratingSphere, port_share

LIMIT = 8.0
"""Worst error allowed, in ulps over the condition number of what is not given as a difference from 1."""

SPHERES = [
    {"reflectance": 0.98, "port_share": [0.01, 0.02], "port_reflectance": [0.5, 0.0]},
    {"reflectance": 0.0, "port_share": [0.25], "port_reflectance": 0.75},
    {"reflectance": 0.3},
    {"reflectance": 1.0, "port_share": 1e-12},
    {"reflectance": 1 - 2.0**-53, "port_share": [2.0**-60]},
    {"absorptance": 1e-30, "port_share": [1e-25, 1e-3], "port_absorptance": [1.0, 1e-28]},
    {"absorptance": 1e-200, "radius": 1e-3},
    {"reflectance": 0.9, "port_share": [0.3, 0.2, 0.4], "port_reflectance": [0.1, 0.99, 0.6], "radius": 7.5},
]


def exactly(arguments):
    """ρ and α of the wall, and their means, of the numbers as they are."""
    shares = [mpf(x) for x in np.atleast_1d(np.asarray(arguments.get("port_share", ()), dtype=float))]

    def alphas(name, other, default):
        values = arguments.get(name)
        if values is None:
            values = arguments.get(other)
            return default if values is None else [mpf(x) for x in np.atleast_1d(values)]
        return [1 - mpf(x) for x in np.atleast_1d(values)]

    (alpha,) = alphas("reflectance", "absorptance", None)
    ports = alphas("port_reflectance", "port_absorptance", [mpf(1)])
    ports = ports * len(shares) if len(ports) == 1 else ports
    mean = (1 - sum(shares)) * alpha + sum(f * a for f, a in zip(shares, ports, strict=True))
    return 1 - alpha, alpha, 1 - mean, mean, shares


@pytest.mark.parametrize("arguments", SPHERES, ids=repr)
def test_every_formula_at_50_digits(arguments):
    sphere = IntegratingSphere(**arguments)
    with working_precision(400):
        rho, _, mean_rho, mean, shares = exactly(arguments)
        radius = mpf(arguments.get("radius", 1.0))
        area = 4 * mpmath.pi * radius**2
        rest = 1 - sum(shares)
        condition = float(1 / rest)  # of the wall's share, which is a difference
        wanted = {
            "average_reflectance": (sphere.average_reflectance, mean_rho),
            "average_absorptance": (sphere.average_absorptance, mean),
            "multiplier": (sphere.multiplier, rho / mean),
            "irradiance": (sphere.irradiance(leaving_flux=2.5), mpf(2.5) / area / mean),
            "wall_radiance": (sphere.wall_radiance(flux=2.5), mpf(2.5) / area / mpmath.pi * rho / mean),
            "time_constant": (
                sphere.time_constant,
                -(mpf(2) / 3) * 2 * radius / mpf(SPEED_OF_LIGHT) / mpmath.log(mean_rho),
            ),
        }
        for k, f in enumerate(shares):
            wanted[f"throughput {k}"] = (sphere.throughput(port=k), f * rho / mean)
        slope = float(abs(1 / mpmath.log(mean_rho)))
        for name, (found, truth) in wanted.items():
            worst = condition * (max(1.0, slope) if name == "time_constant" and mean_rho < 0.9 else 1.0)
            assert scaled_ulps(found, truth, worst) <= LIMIT, name


def test_the_series_of_reflections():
    """M = ρ + ρ·ρ(1−f) + ..., and a multiplier that forgets the port is far from it."""
    rho, f = 0.95, 0.03
    total = sum(rho * (rho * (1 - f)) ** k for k in range(2000))
    found = float(IntegratingSphere(reflectance=rho, port_share=f).multiplier)
    assert found == pytest.approx(total, rel=1e-13)
    assert abs(rho / (1 - rho) / found - 1) > 0.5


def test_a_sample_in_the_place_of_a_standard(rng):
    """By the two signals of which the error is the ratio."""
    for _ in range(20):
        wall, standard, sample, other = rng.uniform(0.05, 0.999, 4)
        shares = rng.uniform(0.001, 0.2, 2)
        before, after = (
            IntegratingSphere(reflectance=wall, port_share=shares, port_reflectance=[other, held])
            for held in (standard, sample)
        )
        measured = sample * after.multiplier / (standard * before.multiplier) * standard
        off = before.substitution_error(sample_reflectance=sample, port=1)
        assert off == pytest.approx(measured / sample - 1, rel=1e-9, abs=1e-13)
    assert before.substitution_error(sample_reflectance=standard, port=1) == 0.0


def test_wavelengths_come_last():
    rho = np.array([0.5, 0.9, 0.98])
    ports = np.array([[0.1, 0.2, 0.3], [0.0, 0.0, 0.0]])
    sphere = IntegratingSphere(reflectance=rho, port_share=[0.02, 0.01], port_reflectance=ports)
    for k in range(3):
        one = IntegratingSphere(reflectance=rho[k], port_share=[0.02, 0.01], port_reflectance=ports[:, k])
        assert sphere.multiplier[k] == one.multiplier
        assert sphere.time_constant[k] == one.time_constant
        off = sphere.substitution_error(sample_reflectance=[0.3, 0.3, 0.3])
        assert off[k] == one.substitution_error(sample_reflectance=0.3)
    assert sphere.substitution_error(sample_reflectance=0.3).shape == (3,)


@pytest.mark.parametrize("x", [1e-160, 1e-9, 1e-4, 0.1, 0.5, 0.999, 1 - 2.0**-53, 1.0])
def test_shares_of_ports_at_50_digits(x):
    with working_precision(400):
        truth = (1 - mpmath.sqrt(1 - mpf(x) ** 2)) / 2
        condition = x * x / max(1e-17, math.sqrt((1 - x) * (1 + x))) if x > 0.9 else 1.0
        assert scaled_ulps(port_share(port_radius=x, radius=1.0), truth, condition) <= 4


def test_the_average_number_of_bounces_takes_its_time():
    """A sphere that reflects 1/e of the light loses it in one mean chord, 4R/3."""
    sphere = IntegratingSphere(reflectance=math.exp(-1), radius=3.0)
    assert sphere.time_constant == pytest.approx(4.0 / SPEED_OF_LIGHT, rel=1e-15)
    assert IntegratingSphere(reflectance=0.0).time_constant == 0.0


@pytest.mark.parametrize(
    ("name", "make"),
    [
        ("reflectance", lambda: IntegratingSphere()),
        ("reflectance", lambda: IntegratingSphere(reflectance=0.5, absorptance=0.5)),
        ("reflectance", lambda: IntegratingSphere(reflectance=1.5)),
        ("absorptance", lambda: IntegratingSphere(absorptance=math.nan)),
        ("radius", lambda: IntegratingSphere(reflectance=0.5, radius=0.0)),
        ("port_share", lambda: IntegratingSphere(reflectance=0.5, port_share=[0.7, 0.7])),
        ("port_share", lambda: IntegratingSphere(reflectance=0.5, port_share=-0.1)),
        (
            "port_reflectance",
            lambda: IntegratingSphere(reflectance=0.5, port_share=[0.1], port_reflectance=[0.1, 0.2]),
        ),
        ("port", lambda: IntegratingSphere(reflectance=0.5).throughput()),
        ("absorptance", lambda: IntegratingSphere(reflectance=1.0).multiplier),
        ("absorptance", lambda: IntegratingSphere(reflectance=1.0).time_constant),
        ("flux", lambda: IntegratingSphere(reflectance=0.5).wall_radiance(flux=-1.0)),
        ("leaving_flux", lambda: IntegratingSphere(reflectance=0.5).irradiance(leaving_flux=math.inf)),
        (
            "sample_reflectance",
            lambda: IntegratingSphere(reflectance=0.5, port_share=0.1).substitution_error(
                sample_reflectance=2
            ),
        ),
        ("port_radius", lambda: port_share(port_radius=2.0, radius=1.0)),
    ],
    ids=lambda x: x if isinstance(x, str) else "",
)
def test_what_is_wrong_is_named(name, make):
    with pytest.raises(ParameterError, match=name):
        make()
