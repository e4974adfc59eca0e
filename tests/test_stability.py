"""Stability: every kernel holds on its hard axis, and what the lessons say of the textbook is so."""

from __future__ import annotations

import importlib
import json
from dataclasses import replace

import numpy as np
import pytest
import sympy

from radiokit.faces.cli import main
from radiokit.faces.stability.measure import FAILS, LIMIT, agreement, measure, rows, stability
from radiokit.faces.stability.row import PRECISIONS, decades
from radiokit.facts.errors import UnknownNameError
from radiokit.measure.twin import Twin, scaled_ulps, ulps

ROWS = rows()


@pytest.fixture(scope="module")
def results():
    return {result.row.name: result for result in stability()}


@pytest.fixture
def run(capfd):
    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main(["stability", *arguments])
        out, err = capfd.readouterr()
        assert err == ""
        return stop.value.code or 0, out

    return call


@pytest.mark.parametrize("name", ROWS)
def test_the_kernel_holds_in_both_precisions(results, name):
    result = results[name]
    assert result.exit_code == 0
    for accuracy in result.kernel.values():
        assert accuracy.finite
        assert accuracy.worst <= LIMIT
    assert result.kernel["float64"].inside == "float64"


@pytest.mark.parametrize("name", ROWS)
def test_the_textbook_fails_where_the_row_says_so_and_nowhere_else(results, name):
    result = results[name]
    assert result.textbook_fails == ROWS[name].fails
    for precision, accuracy in result.textbook.items():
        assert accuracy.inside == precision  # in float32 throughout, or it would be no comparison


@pytest.mark.parametrize("name", ROWS)
def test_textbook_and_truth_are_one_function(name):
    """With 900 digits the textbook's formula is right: what it loses in floats is rounding, not meaning."""
    assert agreement(ROWS[name]) >= 40


@pytest.mark.parametrize("name", [name for name in ROWS if name != "phong-furnace"])  # its axis is integers
def test_the_kernel_holds_between_the_places_shown_too(name, rng):
    row = ROWS[name]

    def anywhere(values):
        return tuple(np.exp(rng.uniform(*np.log([min(values), max(values)]), 8)).tolist()) if values else ()

    found = measure(replace(row, values=anywhere(row.values), values_float32=anywhere(row.values_float32)))
    assert found.exit_code == 0, found.kernel


def test_a_planted_wrong_truth_is_noticed():
    row = ROWS["cap-solid-angle"]
    theta = sympy.Symbol("theta", positive=True)
    wrong = replace(row, twin=lambda: Twin(sympy.pi * theta**2, {}, (theta,)))  # the small-angle formula
    assert agreement(wrong) < 2
    assert measure(wrong).exit_code == 1


def test_a_planted_bad_kernel_is_reported():
    row = ROWS["cap-solid-angle"]
    bad = measure(replace(row, kernel=lambda theta: 2 * np.pi * (1 - np.cos(theta))))
    assert str(bad.outcome) == "violated"
    assert bad.kernel["float64"].worst > 1e15
    assert bad.kernel["float64"].digits == 0


def test_a_kernel_that_is_bad_in_float32_only_or_at_one_place_only_is_reported():
    row = ROWS["cap-solid-angle"]
    narrow = replace(row, kernel=lambda theta: row.kernel(theta).astype(theta.dtype).astype(np.float16))
    assert measure(narrow).exit_code == 1
    only32 = measure(replace(row, kernel=lambda t: row.kernel(t) * (1 + 1e-5 * (t.dtype == np.float32))))
    assert only32.kernel["float64"].worst <= LIMIT < only32.kernel["float32"].worst
    assert only32.exit_code == 1
    nan = measure(replace(row, kernel=lambda t: np.where(t == t[7], np.nan, row.kernel(t))))
    assert (nan.kernel["float64"].at, nan.kernel["float64"].finite) == (row.values[7], False)
    assert nan.to_json()["kernel"]["float64"]["worst"] == "inf"


def test_each_row_says_what_a_reader_needs():
    assert len(ROWS) >= 14
    for name, row in ROWS.items():
        assert row.name == name
        assert len(row.lesson) > 80
        assert row.source.cite()
        module, _, attribute = row.kernel_name.rpartition(".")
        try:
            owner = importlib.import_module(module)
        except ModuleNotFoundError:
            package, _, cls = module.rpartition(".")
            owner = getattr(importlib.import_module(package), cls)
        assert callable(getattr(owner, attribute))


def test_inputs_are_exact_in_the_precision_in_question():
    for row in ROWS.values():
        for precision in PRECISIONS.values():
            columns = row.columns(precision)
            assert {column.dtype for column in columns} == {np.dtype(precision)}
            assert all(np.isfinite(column).all() for column in columns)
            assert len({column.shape for column in columns}) == 1


def test_names_are_checked_and_kept_in_order():
    assert [r.row.name for r in stability(["phong-sample", "cap-solid-angle"])] == [
        "phong-sample",
        "cap-solid-angle",
    ]
    with pytest.raises(UnknownNameError, match=r"did you mean 'cap-solid-angle'\?"):
        stability("cap-solid-angel")


def test_ulps_of_float32_are_those_of_float32():
    assert ulps(np.float32(1) + np.spacing(np.float32(1)), 1, np.float32) == 1
    assert ulps(1 + 2.0**-52, 1, np.float32) == 2.0**-29
    assert ulps(0.0, 1e-60, np.float32) < 0.5
    assert ulps(np.inf, 1e60, np.float32) == 0  # beyond float32's range, infinity is the nearest
    assert scaled_ulps(1 + 2.0**-21, 1, 2.0, np.float32) == 2


def test_decades():
    assert decades(2, 4) == (100.0, 1000.0, 10000.0)
    assert decades(-1, -5, 2) == (0.1, 0.001, 1e-5)


def test_the_command_prints_a_table_and_json(run):
    code, out = run("cap-solid-angle", "--json")
    data = json.loads(out)
    (row,) = data["rows"]
    assert (code, row["outcome"], row["limit"], data["figures"]) == (0, "holds", LIMIT, [])
    assert row["textbook"]["float32"]["worst"] > FAILS
    assert "1 − cos θ" in row["lesson"]
    code, out = run("cap-solid-angle")
    assert code == 0
    assert f"lesson: {ROWS['cap-solid-angle'].lesson}" in out
    assert "the kernel in float64 inside" in out


def test_all_rows_are_drawn(run, tmp_path):
    code, out = run("--figures", str(tmp_path))
    assert code == 0
    assert all(name in out for name in ROWS)
    assert f"{len(ROWS)} of {len(ROWS)} kernels" in out
    assert (tmp_path / "stability.png").stat().st_size > 10_000


@pytest.mark.parametrize("name", ["variance-large-mean", "frame-near-minus-z"])
def test_one_row_is_drawn(run, tmp_path, name):
    code, out = run(name, "--figures", str(tmp_path))
    assert code == 0
    assert f"stability-{name}.png" in out
    assert (tmp_path / f"stability-{name}.png").stat().st_size > 10_000


def test_a_bad_kernel_gives_exit_code_1_and_its_name(run, monkeypatch):
    row = ROWS["cap-solid-angle"]
    planted = {row.name: replace(row, kernel=lambda theta: row.textbook(np, theta))}
    monkeypatch.setattr("radiokit.faces.stability.measure.rows", lambda: planted)
    code, out = run()
    assert code == 1
    assert "0 of 1 kernels" in out
    assert "over the limit: cap-solid-angle" in out
    assert run("cap-solid-angle", "--json")[0] == 1


def test_an_unknown_row_gives_one_line_and_exit_code_2(capfd):
    with pytest.raises(SystemExit) as stop:
        main(["stability", "nosuch"])
    out, err = capfd.readouterr()
    assert (stop.value.code, out, err.count("\n")) == (2, "", 1)
    assert "unknown stability row 'nosuch'" in err
