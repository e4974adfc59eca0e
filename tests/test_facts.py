"""Floor 0: errors, sources, estimates, verdicts and reports say what they should, to people and programs."""

from __future__ import annotations

import io
import json
import pickle

import jsonschema
import numpy as np
import pytest

import radiokit as rk
from radiokit.facts.errors import (
    CallableError,
    MissingExtraError,
    ParameterError,
    RadiokitError,
    UnknownNameError,
)
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.jsonable import jsonable
from radiokit.facts.report import Report, schema
from radiokit.facts.source import Source
from radiokit.facts.verdict import Evidence, Outcome, Verdict, Witness, judge_upper_limit


def verdict(outcome=Outcome.HOLDS, **more):
    return Verdict(check="law", claim="x ≤ 1", outcome=outcome, evidence=Evidence.MEASURED, **more)


# ---------------------------------------------------------------------------------------------- errors


@pytest.mark.parametrize(
    "error",
    [
        ParameterError("alpha", -1, "in (0, 1]"),
        UnknownNameError("BSDF", "gxg", ["ggx"]),
        CallableError("f", "raised ValueError", [0, 0, 1], [0, 1, 0]),
        MissingExtraError("drawing", "pyvista", "viz"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_errors_cross_processes_and_become_json(error):
    back = pickle.loads(pickle.dumps(error))
    assert type(back) is type(error)
    assert str(back) == str(error)
    assert back.fields.keys() == error.fields.keys()
    assert json.loads(json.dumps(error.to_json()))["message"] == str(error)
    assert isinstance(error, RadiokitError)


def test_errors_can_be_caught_as_pythons_own():
    assert isinstance(ParameterError("a", 1, "2"), ValueError)
    assert isinstance(UnknownNameError("a", "b", []), LookupError)
    assert isinstance(MissingExtraError("a", "b", "c"), ImportError)


def test_a_source_cites_itself():
    source = Source(authors="Heitz", year=2018, title="VNDF", doi="10.1/x", equation="eq. 3")
    assert source.cite() == "Heitz (2018). VNDF. eq. 3. doi:10.1/x"
    assert source.to_json()["year"] == 2018


# ------------------------------------------------------------------------------------------- estimates


def test_an_interval_is_a_bound_or_has_its_level():
    assert Estimate(1.0, 0.1, "truncation").interval(0.5) == (0.9, 1.1)
    low, high = Estimate(0.0, 1.0, "statistical").interval(0.95)
    assert (low, high) == pytest.approx((-1.959964, 1.959964), abs=1e-6)


def test_sums_of_estimates_are_honest():
    bound, other = Estimate(1.0, 0.1, "truncation", 3, 1.0, "a"), Estimate(2.0, 0.2, "rounding", 4, 1.0, "b")
    total = bound + other
    assert (total.value, total.kind, total.evaluations, total.method) == (3.0, "truncation", 7, "a + b")
    assert total.error == pytest.approx(0.3)
    one, two = Estimate(1.0, 3.0, "statistical"), Estimate(1.0, 4.0, "statistical")
    assert (one + two).error == 5.0
    assert (one + bound).kind == "statistical"
    assert (one + bound).error == pytest.approx(3.1)
    assert not (one + Estimate(0.0, 0.0, "rounding", converged=False)).converged


def test_ratio_is_zero_for_an_exact_value_and_infinite_for_a_false_certainty():
    assert Estimate(1.0, 0.0, "rounding").ratio(1.0) == 0
    assert Estimate(1.0, 0.0, "rounding").ratio(2.0) == np.inf
    assert Estimate(np.array([1.0, 2.0]), 0.5, "statistical").ratio(1.0) == 2.0


@pytest.mark.parametrize(
    ("estimate", "text"),
    [
        (Estimate(0.8217, 0.0005, "statistical"), "0.82170 ± 0.00050 (standard error)"),
        (Estimate(1.0, 1e-12, "truncation"), "1 ± 1.0e-12 (bound)"),
        (Estimate(0.0, 0.0, "rounding"), "0 ± 0 (bound)"),
        (Estimate(1.0, 50.0, "truncation"), "1 ± 50 (bound)"),
    ],
)
def test_an_estimate_prints_as_many_digits_as_it_has(estimate, text):
    assert str(estimate) == text


@pytest.mark.parametrize("error", [-1.0, np.nan])
def test_an_error_must_be_an_error(error):
    with pytest.raises(ParameterError, match="error = "):
        Estimate(1.0, error, "truncation")
    with pytest.raises(ParameterError, match="kind = 'guess'"):
        Estimate(1.0, 0.0, "guess")


def test_rounding_scales_with_the_value():
    assert rounding(1e10).error == 4 * np.spacing(1e10)
    assert float(rounding(2.0).scaled(-3.0).value) == -6.0
    assert rounding(2.0).scaled(-3.0).error > 0


# -------------------------------------------------------------------------------------------- verdicts


@pytest.mark.parametrize(
    ("value", "error", "kind", "outcome", "evidence"),
    [
        (0.9, 0.05, "truncation", "holds", "bounded"),
        (1.0, 1e-12, "truncation", "holds", "bounded"),
        (1.0, 1e-6, "truncation", "inconclusive", "bounded"),
        (1.1, 0.05, "truncation", "violated", "refuted"),
        (0.9, 0.01, "statistical", "holds", "measured"),
        (0.99, 0.01, "statistical", "inconclusive", "measured"),
        (np.nan, 0.0, "truncation", "inconclusive", "bounded"),
        (2.0, np.inf, "truncation", "inconclusive", "bounded"),
    ],
)
def test_a_limit_is_never_passed_in_doubt(value, error, kind, outcome, evidence):
    assert judge_upper_limit(Estimate(value, error, kind), 1.0) == (outcome, evidence)


def test_a_witness_reads_back_to_the_last_bit():
    direction = [0.1 + 0.2, 1 / 3, 2 / 3]
    text = str(Witness({"wi": direction}, {"f": 1e-17}))
    start, end = text.index("("), text.index(")")
    assert [float(x) for x in text[start + 1 : end].split(",")] == direction
    assert text.endswith("f = 1e-17")


def test_a_report_has_the_worst_outcome_and_its_exit_code():
    for outcomes, worst, code in (
        ([Outcome.HOLDS], Outcome.HOLDS, 0),
        ([Outcome.HOLDS, Outcome.INCONCLUSIVE], Outcome.INCONCLUSIVE, 3),
        ([Outcome.INCONCLUSIVE, Outcome.VIOLATED], Outcome.VIOLATED, 1),
        ([], Outcome.INCONCLUSIVE, 3),
    ):
        report = Report("s", tuple(verdict(outcome) for outcome in outcomes))
        assert (report.outcome, report.exit_code, report.ok) == (worst, code, code == 0)


def test_a_report_prints_as_text_as_html_and_with_rich():
    from rich.console import Console

    witness = Witness({"wi": [0.0, 0.0, 1.0]}, {"f": 2.0})
    report = Report("<mine>", (verdict(Outcome.VIOLATED, message="a < b", witness=witness),), notes=("hm",))
    assert "violated" in str(report)
    assert "witness: wi = (0.0, 0.0, 1.0): f = 2.0" in str(report)
    html = report._repr_html_()
    assert "&lt;mine&gt;" in html
    assert "a &lt; b" in html
    console = Console(width=100, record=True, file=io.StringIO())
    console.print(report)
    text = console.export_text()
    assert "<mine>" in text
    assert "a < b" in text
    assert "[bold" not in text
    with pytest.raises(UnknownNameError, match="unknown check 'lwa'; did you mean 'law'"):
        report["lwa"]


@pytest.mark.parametrize(
    "f",
    [
        rk.bsdf("ggx"),
        rk.bsdf("mirror"),
        lambda wi, wo: np.where(wi[:, 2] > 0.9, np.nan, 0.3),
        lambda wi, wo: (1 + wi[:, 2]) / 3,
        lambda wi, wo: np.outer(wi[:, 2], [0.1, 0.2, 3.0]),
    ],
    ids=["ggx", "mirror", "nan", "gain", "channels"],
)
def test_reports_follow_their_written_schema(f):
    data = rk.check(f).to_json()
    text = json.dumps(data, allow_nan=False)
    jsonschema.Draft202012Validator.check_schema(schema())
    jsonschema.validate(json.loads(text), schema())


def test_the_schema_rejects_what_is_no_report():
    data = rk.check(rk.bsdf("lambert")).to_json()
    data["verdicts"][0]["outcome"] = "fine"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(data, schema())


def test_jsonable_leaves_nothing_that_json_cannot_say():
    data = {
        "a": np.array([1, np.nan]),
        "b": (np.int64(3), np.True_),
        "c": -np.inf,
        "d": 1j,
        "e": None,
        5: "x",
    }
    assert jsonable(data) == {"a": [1.0, "nan"], "b": [3, True], "c": "-inf", "d": "1j", "e": None, "5": "x"}
