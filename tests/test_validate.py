"""The main job: every model as it claims, every case by every method, the same for any number of workers."""

from __future__ import annotations

import json
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context

import numpy as np
import pytest

import radiokit as rk
from radiokit.bsdfs.lambert import Lambert
from radiokit.checks.claims import claims
from radiokit.checks.sampling import P_VALUES
from radiokit.contracts.bsdf import REGISTRY, Claims
from radiokit.contracts.parameters import parameters_of
from radiokit.faces.plots.work_precision import FURNACES, draw_work_precision, work_precision
from radiokit.faces.validate import LEVEL, MUST_HOLD, everything, validate
from radiokit.facts.errors import UnknownNameError
from radiokit.facts.report import Report
from radiokit.facts.verdict import Outcome
from radiokit.measure.statistics import sidak

SOME = ("lambert", "mirror", "thin_slab", "phong", "blinn_phong", "ggx")
"""Models of every kind of finding, quickly judged; the command ``radiokit validate`` judges all of them."""

CASES = rk.list_cases()[::6]
"""Every sixth case; ``tests/test_cases.py`` asks all of them by every method."""


@pytest.fixture(scope="module")
def found():
    return validate(names=(*SOME, *CASES))


def test_everything_holds(found):
    wrong = [str(v) for report in found.models for v in report if v.check in MUST_HOLD and not v.ok]
    wrong += [f"{row.case} {row.method}: {row.verdict}" for row in found.cases if not row.verdict.ok]
    assert not wrong
    assert found.exit_code == 0


def test_every_model_and_every_method_of_every_case_is_there(found):
    models, cases = everything()
    assert models == [(name, values) for name in rk.list_bsdfs() for values in REGISTRY.get(name).EXAMPLES]
    assert set(cases) == {(name, method) for name in rk.list_cases() for method in rk.case(name).methods}
    judged = [(report.subject, report.parameters) for report in found.models]
    assert judged == [(name, rk.bsdf(name, **values).parameters()) for name, values in models if name in SOME]
    asked = [(row.case, row.method) for row in found.cases]
    assert asked == [pair for pair in cases if pair[0] in CASES]
    with pytest.raises(UnknownNameError, match="unknown model or case 'gxg'; did you mean 'ggx'"):
        everything(["gxg"])


def test_the_run_is_json(found):
    data = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert data["outcome"] == "holds"
    row = data["cases"][0]
    assert {
        "exact",
        "value",
        "true_error",
        "claimed_error",
        "ratio",
        "p_value",
        "evaluations",
        "seconds",
    } <= set(row)


def test_bounds_hold_with_nothing_to_spare_but_rounding(found):
    for row in found.cases:
        if row.verdict.estimate.is_bound:
            assert row.true_error <= row.verdict.estimate.error + 16 * np.finfo(float).eps * abs(row.exact)


def test_the_findings_do_not_depend_on_the_workers(found):
    """A task knows nothing of those before it: every third alone, in two other processes, finds the same."""
    some = slice(None, None, 3)

    class Elsewhere(Executor):
        def map(self, fn, tasks):
            with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
                return executor.map(fn, tasks[some])

    again = validate(names=(*SOME, *CASES), executor=Elsewhere(), workers=2)
    assert len(again.models) > len(SOME)

    def essence(tasks):
        for item in tasks:
            if isinstance(item, Report):
                yield item.subject, item.parameters, [(v.check, v.outcome, v.witness) for v in item]
            else:
                yield item.case, item.method, item.verdict.estimate.value

    assert [*essence([*again.models, *again.cases])] == [*essence([*found.models, *found.cases][some])]


def test_a_wrong_case_and_a_false_claim_are_not_let_pass(found):
    report = found.models[0]
    bad = replace(report["claims"], outcome=Outcome.VIOLATED)
    wrong = replace(report, verdicts=(*[v for v in report if v.check != "claims"], bad))
    assert replace(found, models=(wrong, *found.models[1:])).exit_code == 1
    row = found.cases[0]
    doubtful = replace(row, verdict=replace(row.verdict, outcome=Outcome.INCONCLUSIVE))
    assert replace(found, cases=(doubtful,)).exit_code == 3


@dataclass(frozen=True, kw_only=True)
class Boastful(Lambert):
    """A Lambert surface that claims what it is told to."""

    boast: Claims | None = None

    @property
    def claims(self):
        return self.boast or super().claims


@pytest.mark.parametrize(
    ("boast", "says"),
    [
        (Claims(reciprocity="no", conserves=True), "reciprocity: claimed no, observed holds"),
        (Claims(reciprocity="yes", conserves=False), "conserves: claimed no, observed holds"),
        (
            Claims(reciprocity="yes", conserves=True, lossless=True),
            "lossless: claimed yes, observed violated",
        ),
        (Claims(reciprocity="yes", conserves=True, delta=True), "delta: claimed yes, observed violated"),
    ],
)
def test_a_false_claim_is_seen_in_either_direction(boast, says):
    f = Boastful(reflectance=0.5, boast=boast)
    verdict = claims(f, rk.check(f))
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.message == says


def test_a_true_claim_is_accepted_and_none_is_no_claim():
    f = Boastful(reflectance=0.5)
    assert claims(f, rk.check(f)).outcome is Outcome.HOLDS
    box = rk.as_bsdf(lambda wi, wo: 0.1 + 0 * wi[:, 2])
    assert claims(box, rk.check(box)).outcome is Outcome.INCONCLUSIVE


def test_the_work_precision_diagram_shows_the_right_slopes(tmp_path, seed):
    lines = {line.method: line for line in work_precision(FURNACES[0], seed=seed % 1000)}
    rule = lines["slope-space rule"]
    assert min(rule.error) < 1e-13
    for name in ("Monte Carlo, BSDF-sampled", "balance heuristic"):
        line = lines[name]
        slope = np.polyfit(np.log(line.evaluations), np.log(line.error), 1)[0]
        assert -0.7 < slope < -0.3
    path = draw_work_precision(tmp_path / "new" / "picture.png", names=FURNACES[1:])
    assert path.stat().st_size > 10_000


def test_one_level_is_shared_by_the_whole_run(found):
    """Over all samplers and all cases together; the numbers are in the JSON."""
    data = json.loads(json.dumps(found.to_json(), allow_nan=False))
    count = len(data["models"]) + len(data["cases"])
    total = 0.0
    for report in data["models"]:
        (verdict,) = [v for v in report["verdicts"] if v["check"] == "sampling"]
        details = verdict["details"]
        assert details["angles_deg"] == [0.0, 30.0, 60.0, 80.0, 85.0, 89.5]
        assert details["verdicts"] == count
        assert details["level_of_all"] == data["level"] == LEVEL
        rows = details["rows"]
        assert [row["theta_deg"] for row in rows] == details["angles_deg"] * (len(rows) // 6)
        p_values = [row[name] for row in rows for name in P_VALUES if name in row]
        assert p_values
        assert all("p_chi_square" in row or "p_delta" in row for row in rows)
        assert min(p_values) == verdict["p_value"] > details["level"]
        assert details["level"] == sidak(LEVEL, count * len(P_VALUES) * len(rows))
        total += details["level"] * len(p_values)
    total += len(data["cases"]) * sidak(LEVEL, count)
    assert total <= LEVEL * (1 + 1e-9)


def test_narrow_lobes_are_among_the_examples():
    """Every model with a width α is sampled at 1e-3, or at the least that it allows."""
    for name, cls in REGISTRY.classes.items():
        widths = [n for n in parameters_of(cls) if n in ("alpha", "alpha_x")]
        for width in widths[:1]:
            judged = [cls(**values).parameters()[width] for values in cls.EXAMPLES]
            given = [value for value in judged if value is not None]
            least = float(parameters_of(cls)[width].interval[1:].split(",")[0])
            assert min(given) <= max(1e-3, least), f"{name}: add an example with {width} = 1e-3"
