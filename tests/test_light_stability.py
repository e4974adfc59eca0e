"""Closed forms of lights at hard configurations: they hold, their truths are right, wrong ones are found."""

from __future__ import annotations

import dataclasses
import json
import math

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from radiokit.faces.cli import main
from radiokit.faces.stability import lighttruth
from radiokit.faces.stability.lights import LIMIT, examine_light, light_rows, light_stability
from radiokit.faces.stability.measure import FAILS
from radiokit.facts.errors import UnknownNameError
from radiokit.facts.estimate import Estimate
from radiokit.facts.verdict import Outcome

ROWS = light_rows()
SLOW = {name for name, row in ROWS.items() if row.digits[0] < 60 and "flux" not in name}
UP = (0.0, 0.0, 1.0)
EXACT_UP = (mpf(0), mpf(0), mpf(1))


def thinned(row, count):
    return dataclasses.replace(row, cases=row.cases[:: max(1, len(row.cases) // count)])


@pytest.mark.parametrize(
    "name", [name for name in ROWS if name != "double-axis moment"]
)  # whose truth is slow
def test_closed_forms_hold(name):
    found = examine_light(thinned(ROWS[name], 1)) if name in SLOW else examine_light(ROWS[name], short=True)
    assert found.worst <= LIMIT
    assert (found.nonfinite, found.broken, found.undecided) == (0, (), ())
    assert found.outcome is Outcome.HOLDS


@pytest.mark.parametrize("name", [
    "sphere solid angle", "sphere irradiance", "polygon irradiance", "triangle solid angle", "cosine lobe",
    "spot flux", "parallel disks", "constant sky irradiance",
])  # fmt: skip
def test_the_textbook_s_formula_is_found_out(name):
    """Planted: 2π(1 − cosσ), edges by acos, cosines to a power, and the catalogue as it is printed."""
    row = ROWS[name]
    planted = dataclasses.replace(row, kernel=row.textbook, textbook=None)
    found = examine_light(planted)
    assert found.outcome is Outcome.VIOLATED
    assert found.worst > FAILS


@pytest.mark.parametrize("change", [
    lambda e: Estimate(e.value * (1 + 1e-13), e.error, "rounding"),
    lambda e: Estimate(math.nan, e.error, "rounding"),
    lambda e: Estimate(e.value, 0.0, "rounding"),
], ids=["off", "nan", "no bound"])  # fmt: skip
def test_a_planted_fault_is_found(change):
    row = ROWS["disk irradiance"]
    found = examine_light(
        dataclasses.replace(row, kernel=lambda *x: change(row.kernel(*x)), cases=row.cases[:6])
    )
    assert found.outcome is Outcome.VIOLATED


def test_a_planted_fault_that_the_condition_does_not_excuse():
    """A sliver's irradiance is badly conditioned in the heights, but not by more than they say."""
    row = ROWS["sphere irradiance"]
    cases = tuple(case for case in row.cases if case[0] == "sliver of 2^-30")
    right = examine_light(dataclasses.replace(row, cases=cases))
    assert right.outcome is Outcome.HOLDS

    def loose(*x):
        found = row.kernel(*x)
        return dataclasses.replace(found, value=found.value * (1 + 1e-4), error=found.value)

    assert examine_light(dataclasses.replace(row, kernel=loose, cases=cases)).worst > LIMIT


# --- the truths against their definitions: rules in the angles, without a contour ---


def gauss(n, low, high):
    x, w = np.polynomial.legendre.leggauss(n)
    return low + (high - low) * (x + 1) / 2, (high - low) * w / 2


def over_disk(center, m, radius, n):
    """∫ max(0, cosθ) cosθ'/r² dA and ∫ cosθ'/r² dA over a disk, in polar coordinates about its centre."""
    rho, wr = gauss(60, 0.0, radius)
    phi = (np.arange(400) + 0.5) * 2 * np.pi / 400
    first = np.cross(m, [0.3, 0.8, -0.1])
    first /= np.linalg.norm(first)
    second = np.cross(m, first)
    ring = np.cos(phi)[:, None] * first + np.sin(phi)[:, None] * second
    r = np.array(center) + rho[:, None, None] * ring
    square = np.sum(r * r, axis=-1)
    angle = np.maximum(-(r @ m), 0) / square**1.5 * (wr * rho)[:, None] * (2 * np.pi / 400)
    return float(np.sum(angle * np.maximum(r @ n, 0) / np.sqrt(square))), float(np.sum(angle))


@pytest.mark.parametrize(("center", "tolerance"), [((1.0, -2.0, 3.0), 1e-12), ((2.0, 0.3, 0.2), 1e-3)])
def test_the_disk_s_truth_is_its_definition(center, tolerance):
    m, n = np.array([-0.6, 0.0, -0.8]), np.array(UP)
    flux, angle = over_disk(center, m, 0.9, n)
    exact = tuple(map(mpf, center)), tuple(map(mpf, m.tolist())), mpf(0.9), (mpf(0),) * 3
    assert float(lighttruth.disk_irradiance(*exact, EXACT_UP)) == pytest.approx(flux, rel=tolerance)
    assert float(lighttruth.disk_solid_angle(*exact)) == pytest.approx(angle, rel=1e-12)


@pytest.mark.parametrize("height", [2.0, 0.5, 0.0, -0.5])
def test_the_sphere_s_truth_is_its_definition(height):
    """Rings about the centre's direction, each clipped by the horizon."""
    center = (3.0, 0.0, height)
    distance = math.hypot(*center)
    c, sine = height / distance, 3.0 / distance
    half = math.asin(1 / distance)
    kink = min(abs(math.atan2(c, sine)), half)
    total = 0.0
    for low, high in ((0.0, kink), (kink, half)):
        t, w = gauss(60, 0.0, 1.0)
        a = low + (high - low) * t * t * (3 - 2 * t)
        w = w * (high - low) * 6 * t * (1 - t)
        p, q = c * np.cos(a), sine * np.sin(a)
        edge = np.arccos(np.clip(-p / np.maximum(q, 1e-300), -1, 1))
        total += float(np.sum(w * 2 * (p * edge + q * np.sin(edge)) * np.sin(a)))
    found = lighttruth.sphere_irradiance(tuple(map(mpf, center)), mpf(1), (mpf(0),) * 3, EXACT_UP)
    assert float(found) == pytest.approx(total, rel=1e-8)


def test_the_polygon_s_truths_are_their_definitions():
    corners = [[mpf(x) for x in v] for v in ((0.25, 0.5, 1), (0.25, 1, 1), (1, 1, 1), (1, 0.5, 1))]
    x, wx = gauss(30, 0.25, 1.0)
    y, wy = gauss(30, 0.5, 1.0)
    square = x[:, None] ** 2 + y**2 + 1
    part = wx[:, None] * wy / square**1.5
    n = np.array([0.6, 0.0, 0.8])
    flux = np.sum(part * (x[:, None] * n[0] + n[2]) / np.sqrt(square))
    here = (mpf(0),) * 3
    assert float(lighttruth.lambert_sum(corners, here, list(map(mpf, n.tolist())))) == pytest.approx(
        flux, rel=1e-13
    )
    assert float(lighttruth.angles_of_polygon(corners, here)) == pytest.approx(float(np.sum(part)), rel=1e-13)
    for exponent, normal in ((3, None), (4, EXACT_UP)):
        lobe = ((x[:, None] * n[0] + n[2]) / np.sqrt(square)) ** exponent
        exact = np.sum(part * lobe / (np.sqrt(square) if normal else 1))
        with mpmath.workdps(20):
            found = lighttruth.moment(corners, list(map(mpf, n.tolist())), mpf(exponent), normal)
        assert float(found) == pytest.approx(float(exact), rel=1e-13)


# --- the command ---


def test_the_command_prints_a_table_and_json(capfd):
    for arguments, code in ((["point flux", "sphere solid angle"], 0), (["point flux", "--json"], 0)):
        with pytest.raises(SystemExit) as stopped:
            main(["stability", "--lights", "--workers", "1", *arguments])
        assert (stopped.value.code or 0) == code
        out = capfd.readouterr().out
        if "--json" in arguments:
            (row,) = json.loads(out)["lights"]
            assert row["name"] == "point flux"
            assert row["outcome"] == "holds"
            assert row["worst"] <= row["limit"] == LIMIT
        else:
            assert "2 of 2 closed forms stay within 16 ulps" in out


def test_unknown_rows_and_idle_options_are_refused(capfd):
    with pytest.raises(UnknownNameError, match="polygon flux"):
        light_stability(["polygons flux"])
    for arguments in (["cone"], ["--models"], ["--dense"]):
        with pytest.raises(SystemExit) as stopped:
            main(["stability", "--lights", *arguments])
        assert stopped.value.code == 2
        assert len(capfd.readouterr().err.splitlines()) == 1
