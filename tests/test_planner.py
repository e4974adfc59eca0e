"""The planner's bench: ratios to the best forced method, closed forms that are missed, and what it writes."""

from __future__ import annotations

import dataclasses
import json
import math

import pytest

from radiokit.faces.bench import planner
from radiokit.faces.bench.planner import LIMIT, Choice, draw, measure, table
from radiokit.faces.cli import main
from radiokit.facts.estimate import Estimate

CHOICE = Choice(
    case="c",
    rtol=1e-3,
    method="sum",
    seconds=2e-3,
    best="qmc",
    best_seconds=1e-3,
    ratio=2.0,
    exact=True,
    missed=False,
)


@pytest.fixture
def run(capfd):
    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main(list(arguments))
        out, err = capfd.readouterr()
        return stop.value.code or 0, out, err

    return call


def test_what_auto_takes_is_measured_beside_what_could_be_forced():
    names = ("ggx-0.3-in-furnace-at-60deg", "lambert-under-point-at-1m")
    found = measure(names, repeats=2, tolerances=(1e-3,))
    assert [each.case for each in found] == list(names)
    assert [each.exact for each in found] == [False, True]
    assert not any(each.missed for each in found)
    for each in found:
        assert each.seconds > 0
        assert each.best_seconds > 0
        assert math.isfinite(each.ratio)
    json.dumps([each.to_json() for each in found], allow_nan=False)


def test_a_planted_planner_that_takes_the_slow_way_is_seen(monkeypatch):
    """Forced to sample where there is a closed form, auto misses it and is far too slow."""
    shade = planner.shade

    def slow(*scene, method, seconds=None, **options):
        if method == "auto":
            return shade(*scene, method="mis", samples=100_000, **{**options, "rtol": 1e-3})
        return shade(*scene, method=method, seconds=seconds, **options)

    monkeypatch.setattr(planner, "shade", slow)
    (found,) = measure(["lambert-in-furnace"], repeats=2, tolerances=(1e-3,))
    assert found.missed
    assert found.ratio > 10 * LIMIT
    assert found.best == "closed form"


def test_what_a_method_needs_follows_from_what_it_reached():
    half = Estimate(1.0, 1e-2, "statistical", converged=False, method="mis")
    assert planner._needed("mis", half, 1.0, 1e-3) == pytest.approx(100.0)
    even = dataclasses.replace(half, method="qmc, mis")
    assert planner._needed("qmc", even, 1.0, 1e-3) == pytest.approx(10.0)
    assert planner._needed("mis", dataclasses.replace(half, converged=True), 1.0, 1e-3) == 1.0
    bound = Estimate(1.0, 1e-2, "truncation", converged=False, method="quadrature")
    assert planner._needed("quadrature", bound, 1.0, 1e-3) == math.inf


def test_the_table_and_the_picture(tmp_path):
    choices = [
        dataclasses.replace(CHOICE, case=f"case-{k}", ratio=0.5 + 0.1 * k, exact=k % 2 == 0, method=method)
        for k, method in enumerate(("sum", "slope-space quadrature", "qmc, mis") * 4)
    ]
    lines = table(choices).splitlines()
    assert "case-11" in lines[2]  # the worst first
    assert len(lines) == 14
    path = draw(choices, tmp_path / "deep" / "planner.png")
    assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_the_command_writes_both_and_fails_where_auto_is_too_slow(run, tmp_path, monkeypatch):
    monkeypatch.setattr(planner, "measure", lambda *names, **options: [CHOICE])
    code, out, err = run("bench", "--planner", "--figures", str(tmp_path))
    assert (code, err) == (0, "")
    assert "at worst 2.00 times slower" in out
    assert sorted(each.name for each in tmp_path.iterdir()) == ["planner.md", "planner.png"]
    for planted in ({"ratio": 2.1}, {"missed": True}):
        choice = dataclasses.replace(CHOICE, **planted)
        monkeypatch.setattr(planner, "measure", lambda *names, c=choice, **options: [c])
        code, out, _ = run("bench", "--planner", "--json", "--no-figures")
        assert code == 1
        assert json.loads(out)["choices"][0]["case"] == "c"
