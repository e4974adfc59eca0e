"""The bench: right slopes, right peers, and a comparison that sees what got worse and nothing else."""

from __future__ import annotations

import copy
import itertools
import json
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from radiokit.faces.bench import compare as comparing
from radiokit.faces.bench import starts as starting
from radiokit.faces.bench.compare import compare, load
from radiokit.faces.bench.diagram import peer_lines
from radiokit.faces.bench.methods import METHODS, Method
from radiokit.faces.bench.peers import all_peers
from radiokit.faces.bench.peers.compiled import Compiled, build
from radiokit.faces.bench.peers.mitsuba import Mitsuba, MitsubaRender
from radiokit.faces.bench.peers.peer import Peer
from radiokit.faces.bench.rows import row as row_of
from radiokit.faces.bench.run import Bench, bench, measure, measure_peers
from radiokit.faces.bench.slopes import DUE, fit
from radiokit.faces.bench.tasks import ALPHAS, THETAS_DEG, converged, ggx_albedo, tasks
from radiokit.faces.bench.timing import Timing, interleave
from radiokit.faces.cli import main
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.estimate import Estimate
from radiokit.measure.fused import processors
from radiokit.measure.kernels import numba_runs
from radiokit.measure.statistics import sidak, z_test

PRESENT = [peer for peer in all_peers() if peer.absent() is None]
LEVEL = 1e-6  # chance that a right thing is rejected in a test of this file


COMPILED: list[tuple[str, set[str]]] = []
"""For each fresh process of ``found`` its method, and what it left in Numba's cache that was not there."""


@pytest.fixture(scope="module")
def found() -> Iterator[Bench]:
    started = starting._start

    def start(method: str, samples: int, cache: str) -> list[float]:
        before = files(cache)
        seconds = started(method, samples, cache)
        COMPILED.append((method, files(cache) - before))
        return seconds

    def files(folder: str) -> set[str]:
        return {f"{path} {path.stat().st_mtime_ns}" for path in Path(folder).rglob("*") if path.is_file()}

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(starting, "_start", start)
        yield bench(quick=True)


@pytest.fixture
def run(capfd):
    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main(list(arguments))
        out, err = capfd.readouterr()
        return stop.value.code or 0, out, err

    return call


# The truth


def test_the_twenty_references_agree_with_closed_forms_where_there_are_such():
    assert {(alpha, theta) for alpha in ALPHAS for theta in THETAS_DEG} <= {
        (task.f.parameters()["alpha"], round(task.theta_deg, 9)) for task in tasks() if task.f.name == "ggx"
    }
    from radiokit.bsdfs.ggx import GGX
    from radiokit.contracts.albedo import integrand
    from radiokit.faces.bench.tasks import towards

    for alpha, theta in ((1.0, 60.0), (1.0, 89.9), (0.3, 60.0), (0.05, 89.0)):
        value, _ = converged(integrand(GGX(alpha=alpha), np.array(towards(theta)), "wo"), alpha, theta)
        assert value == pytest.approx(ggx_albedo(alpha, theta)[0], rel=1e-13)


def test_two_rules_that_disagree_are_no_truth():
    with pytest.raises(RadiokitError, match="two converged rules disagree"):
        converged(lambda wi: np.sign(wi[:, 1] - 0.3), 0.3, 60.0)


# The measurements


def test_the_quick_run_has_every_row_and_is_json(found):
    data = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert {row["method"] for row in data["rows"]} == {method.name for method in METHODS}
    assert len(data["rows"]) == 4 * sum(len(method.quick) for method in METHODS)
    assert {row["method"] for row in data["starts"]} == {"quadrature", "mc", "qmc"}
    caches = {row["cache"] for row in data["starts"] if row["method"] == "mc"}
    assert caches == ({"cold", "warm"} if numba_runs() else {""})
    assert data["settings"]["throughput_samples"] > data["settings"]["samples"]
    assert int(data["machine"]["threads"]) == processors()
    assert data["machine"]["numpy"] == np.__version__
    assert all(row["seconds"] > 0 and row["throughput"] > 0 for row in data["rows"])
    assert {ratio["peer"] for ratio in data["ratios"]} | set(data["absent"]) == {
        peer.name for peer in all_peers()
    }
    assert all(ratio["speed"] > 0 for ratio in data["ratios"])
    sampling = [peer.name for peer in PRESENT if peer.rival == "mc"]
    assert [row["method"] for row in data["throughput"]] == ["mc", *sampling]
    by_name = {row["method"]: row for row in data["throughput"]}
    for ratio in data["throughput_ratios"]:
        ours, theirs = by_name["mc"], by_name[ratio["peer"]]
        assert ours["evaluations"] == theirs["evaluations"] == data["settings"]["throughput_samples"]
        assert ratio["speed"] == pytest.approx(ours["throughput"] / theirs["throughput"])
        assert ratio["qmc_efficiency"] is None


def test_what_radiokit_claims_is_so(found):
    assert not found.dishonest
    for row in found.rows:
        if row.method == "quadrature":
            assert row.converged
            assert row.true_error <= row.claimed_error + 1e-14
            assert row.claimed_error <= row.size * row.exact


def test_a_fresh_start_is_all_that_is_done_before_the_first_answer(found):
    for start in found.starts:
        assert min(start.numpy_seconds, start.import_seconds, start.second_seconds) > 0
        assert start.total_seconds > start.first_seconds > 0


def test_what_is_measured_comes_to_its_place(monkeypatch):
    """Made-up times, of which medians are taken."""
    times = itertools.cycle([[0.2, 0.3, 5.0, 0.1], [0.2, 0.3, 7.0, 0.1], [0.2, 0.3, 6.0, 0.1]])
    monkeypatch.setattr(starting, "_start", lambda *given: next(times))
    (start,) = starting.starts(("quadrature",), samples=8, repeats=3)
    assert (start.numpy_seconds, start.import_seconds) == (0.2, 0.3)
    assert (start.first_seconds, start.second_seconds) == (6.0, 0.1)
    assert start.total_seconds == 6.5


@pytest.mark.skipif(not numba_runs(), reason="looks at what Numba compiles, and it does not run here")
def test_an_empty_cache_costs_a_compilation(found):
    assert {start.cache for start in found.starts if start.method == "mc"} == {"cold", "warm"}
    cold, warm = (files for method, files in COMPILED if method == "mc")
    assert any(".nbc" in name for name in cold)
    assert not any(".nbc" in name for name in warm)


def sized(*names, sizes):
    return [
        Method(method.name, method.size, sizes, sizes, method.answer)
        for method in METHODS
        if method.name in names
    ]


@pytest.mark.parametrize("name", ["ggx-0.3-at-60deg", "ggx-0.05-at-89deg"])
def test_errors_fall_as_they_should(name, seed):
    task = next(task for task in tasks(quick=True) if task.name == name)
    rule = [method for method in METHODS if method.name == "slope rule"]
    sampled = sized("mc", "qmc", sizes=tuple(4**k for k in range(5, 10)))
    slopes = {each.method: each for each in fit(measure(task, rule + sampled, seed=seed % 1000, repeats=12))}
    assert slopes["mc"].law == slopes["qmc"].law == "power"
    assert slopes["mc"].rate == pytest.approx(-0.5, abs=0.2)
    assert slopes["mc"].claimed_rate == pytest.approx(-0.5, abs=0.03)
    assert slopes["qmc"].claimed_rate <= -0.9
    assert slopes["qmc"].rate <= -0.9
    assert slopes["slope rule"].law == "geometric"
    assert slopes["slope rule"].rate < 0.8


def test_a_power_law_is_not_called_geometric():
    """Planted: a midpoint rule's n⁻², which a kinked integrand gives."""
    task = next(task for task in tasks(quick=True) if task.name == "ggx-0.3-at-60deg")
    slow = Method(
        "midpoint",
        "nodes",
        (8, 16, 32, 64, 128),
        (),
        lambda f, wo, n, seed: (task.exact * (1 + n**-2.0), int(n) ** 2),
    )
    (slope,) = fit(measure(task, [slow], repeats=3))
    assert (slope.law, slope.rate) == ("power", pytest.approx(-1.0))


def series(method, kind, law, sizes=(2**10, 2**13, 2**16, 2**19)):
    """Rows of one method whose errors follow a law of the evaluations, or of the nodes."""
    task = next(task for task in tasks(quick=True) if task.name == "ggx-0.3-at-60deg")
    timing = Timing((1.0,) * 3, ())
    rows = []
    for size in sizes:
        error = 0.1 * law(size)
        result = (
            Estimate(task.exact + error, error, kind, int(size)) if kind else (task.exact + error, size**2)
        )
        rows.append(row_of(task.name, method, size, task.exact, Timing(timing.seconds, (result,)), timing))
    return task, rows


@pytest.mark.parametrize(
    ("method", "kind", "law", "met"),
    [
        ("mc", "statistical", lambda n: n**-0.5, True),
        ("mc", "statistical", lambda n: n**-0.25, False),
        ("mc", "statistical", lambda n: n**-0.8, False),
        ("qmc", "statistical", lambda n: n**-0.95, True),
        ("qmc", "statistical", lambda n: n**-2.0, True),
        ("qmc", "statistical", lambda n: n**-0.5, False),
        ("slope rule", None, lambda n: 0.6**n, True),
        ("slope rule", None, lambda n: n**-2.0, False),
        ("slope rule", None, lambda n: 1.1**n, False),
    ],
)
def test_a_planted_wrong_slope_is_rejected(method, kind, law, met):
    task, rows = series(method, kind, law, (8, 12, 16, 24) if kind is None else (2**10, 2**13, 2**16, 2**19))
    (slope,) = fit(rows, broad={task.name})
    assert slope.met is met
    assert slope.due == DUE[method]
    if method == "slope rule":
        assert slope.digits == pytest.approx(-np.log10(law(24) / law(8)) / 16, rel=0.2)
    else:
        (elsewhere,) = fit(rows)
        assert (elsewhere.due, elsewhere.met) == (None, None)


def test_narrow_lobes_owe_no_law_of_sampling():
    assert {task.name for task in tasks(quick=True) if not task.broad} == {"ggx-0.05-at-89deg"}


def test_the_noise_of_a_slope_is_its_spread(rng):
    """Errors that are root mean squares of 7 normal numbers, at four sizes."""
    rates, noise = [], 0.0
    for _ in range(300):
        jitter = iter(np.sqrt(np.mean(rng.standard_normal((4, 7)) ** 2, axis=1)))
        _, rows = series("mc", "statistical", lambda n, jitter=jitter: n**-0.5 * next(jitter))
        (slope,) = fit(rows, repeats=7)
        rates.append(slope.rate)
        noise = slope.noise
    assert np.std(rates) == pytest.approx(noise, rel=0.25)


def test_calls_take_turns():
    order = []

    def slow(name):
        order.append(name)
        time.sleep(5e-3)

    interleave([lambda i: slow("a"), lambda i: slow("b")], 3)
    assert "".join(order) == "aabb" + "ab" * 3


def test_events_too_rare_to_be_drawn_are_told_from_lies(seed):
    task = next(task for task in tasks() if task.name == "ggx-0.001-at-0deg")
    rows = measure(task, sized("mc", sizes=(1024,)), seed=seed % 1000, repeats=3)
    assert rows[0].rare
    assert rows[0].honest
    assert rows[0].true_error == pytest.approx(1 - task.exact, rel=1e-3)


def test_planted_claims_that_are_too_small_are_seen(seed):
    task = tasks(quick=True)[1]
    for kind, error in (("truncation", 1e-9), ("statistical", 1e-6)):
        liar = Method(
            "liar",
            "n",
            (1,),
            (),
            lambda f, wo, n, s, k=kind, e=error: Estimate(task.exact + 1e-3, e, k, 10**6),
        )
        honest = Method("honest", "n", (1,), (), lambda f, wo, n, s, k=kind: Estimate(task.exact, 1e-5, k, 1))
        first, second = measure(task, [liar, honest], repeats=3)
        assert not first.honest
        assert not first.rare
        assert second.honest


# The peers


@pytest.mark.parametrize("peer", PRESENT, ids=lambda peer: peer.name)
@pytest.mark.parametrize(("alpha", "theta"), [(0.3, 60.0), (1.0, 0.0), (0.05, 60.0)])
def test_a_peer_agrees_with_the_truth_within_its_error(peer, alpha, theta, seed):
    truth = peer.truth(alpha, theta)
    if peer.rival == "quadrature":
        answer = peer.answer(alpha, theta, 1e-6, 0)
        assert answer.value == pytest.approx(truth, rel=1e-6)
        return
    answer = peer.answer(alpha, theta, 1 << 18, seed)
    assert z_test(answer, truth) > sidak(LEVEL, 3 * len(PRESENT))
    assert z_test(answer, 1.02 * truth) < LEVEL
    assert answer.value == pytest.approx(peer.answer(alpha, theta, 1 << 18, seed).value, rel=1e-12)
    assert abs(answer.value - peer.answer(alpha, theta, 1 << 18, seed + 1).value) > 1e-9


@pytest.mark.skipif(Compiled().absent() is not None, reason="the peer in C needs a compiler")
def test_the_kernel_in_c_covers_and_does_not_repeat_itself(seed):
    values = [Compiled().answer(0.3, 60.0, 4096, seed + i) for i in range(400)]
    exact = ggx_albedo(0.3, 60.0)[0]
    covered = sum(each.covers(exact) for each in values)
    assert 400 * 0.95 - 5 * 4.4 <= covered <= 400 * 0.95 + 4 * 4.4
    spread = np.std([each.value for each in values], ddof=1)
    assert spread == pytest.approx(values[0].error, rel=0.2)


@pytest.mark.skipif(Compiled().absent() is not None, reason="the peer in C needs a compiler")
def test_loading_the_kernel_leaves_denormals_alone():
    Compiled().answer(0.3, 60.0, 4096, 1)
    assert np.float64(1e-310) * np.float64(0.5) > 0


def test_what_is_absent_says_why_and_what_helps(monkeypatch, tmp_path):
    assert "name it in CC" in build("no-such-compiler")[1]
    broken = tmp_path / "cc"
    broken.write_text("#!/bin/sh\necho 'no such flag' >&2\nexit 1\n", encoding="utf-8")
    broken.chmod(0o755)
    assert build(str(broken))[1].endswith("failed: no such flag")
    assert MitsubaRender().absent() == Mitsuba().absent()
    reason = Mitsuba().absent()
    assert reason is None or "pip install 'radiokit[mitsuba]'" in reason or "DRJIT_LIBLLVM_PATH" in reason


class Half(Peer):
    """Sleeps, and so is slower than anything."""

    name = "sleeper"
    rival = "mc"

    def answer(self, alpha, theta_deg, size, seed):
        time.sleep(0.05)
        return Estimate(ggx_albedo(alpha, theta_deg)[0], 1e-3, "statistical", int(size))


def test_ratios_are_those_of_the_times():
    rows, (ratio,) = measure_peers(0.3, 60.0, [Half()], samples=1 << 10, repeats=3)
    by_name = {row.method: row for row in rows}
    assert ratio.speed == by_name["sleeper"].seconds / by_name["mc"].seconds > 1
    assert ratio.efficiency == pytest.approx(ratio.speed * (1e-3 / by_name["mc"].claimed_error) ** 2)
    assert ratio.qmc_efficiency > ratio.efficiency


def test_the_diagram_has_a_line_for_each_peer_that_is_there(seed, monkeypatch):
    monkeypatch.setattr("radiokit.faces.bench.diagram.SAMPLES", (64, 4096))
    lines = peer_lines("ggx-0.3-in-furnace-at-60deg", seed % 1000)
    assert [line.method for line in lines] == [peer.name for peer in PRESENT]
    from radiokit.faces.plots.work_precision import STYLES

    assert {peer.name for peer in all_peers()} <= set(STYLES)
    assert all(len(line.seconds) == len(line.error) for line in lines)


# The comparison


def test_an_identical_run_is_accepted(found):
    data = found.to_json()
    assert compare(data, copy.deepcopy(data)) == []


def changed(data, method, **factors):
    new = copy.deepcopy(data)
    for row in new["rows"]:
        if row["method"] == method:
            for name, factor in factors.items():
                row[name] *= factor
    return new


def quiet(data, noise=0.01):
    new = copy.deepcopy(data)
    for row in new["rows"]:
        row["noise"] = noise
    return new


def test_a_planted_slowdown_is_detected_and_noise_is_not(found):
    data = quiet(found.to_json())
    for factor in (1.25, 2.0):
        changes = compare(data, changed(data, "mc", relative_seconds=factor, relative_best=factor))
        assert {change.kind for change in changes} == {"slower"}
        assert any(change.what == "mc, all rows" for change in changes)
        assert all("mc" in change.what for change in changes)
    assert len(compare(data, changed(data, "mc", relative_seconds=2.0, relative_best=2.0))) == 12 + 1
    assert compare(data, changed(data, "mc", relative_seconds=0.5, relative_best=0.5)) == []
    assert compare(data, changed(data, "mc", relative_seconds=1.1, relative_best=1.1)) == []
    assert compare(data, changed(data, "mc", relative_seconds=3.0)) == []  # a burst that not all calls met
    loud = quiet(data, noise=0.3)
    one = copy.deepcopy(loud)
    one["rows"][0]["relative_seconds"] *= 2.0
    one["rows"][0]["relative_best"] *= 2.0
    assert compare(loud, one) == []
    assert "evaluations in place of" in compare(data, changed(data, "quadrature", evaluations=2))[0].message


def test_a_busier_machine_is_not_a_slower_program(found):
    data = quiet(found.to_json())
    new = changed(data, "mc", seconds=3.0, throughput=1 / 3)
    assert compare(data, new) == []


@pytest.mark.parametrize(
    ("method", "factors"),
    [("mc", {"claimed_error": 2.0}), ("qmc", {"claimed_error": 2.0}), ("slope rule", {"true_error": 10.0})],
)
def test_a_planted_loss_of_accuracy_is_detected(found, method, factors):
    data = found.to_json()
    changes = compare(data, changed(data, method, **factors))
    assert changes
    assert {change.kind for change in changes} == {"less accurate"}
    assert all(f"by {method}" in change.what for change in changes)


def test_a_claim_that_no_longer_holds_or_converges_or_is_gone_is_detected(found):
    data = found.to_json()
    new = copy.deepcopy(data)
    new["rows"][8] |= {"honest": False, "claimed_error": 1e-20, "true_error": 1e-3}
    assert compare(data, new)[0].kind == "less accurate"
    new = copy.deepcopy(data)
    new["rows"][8]["converged"] = False
    assert [change.message for change in compare(data, new)] == ["it no longer converges"]
    new = copy.deepcopy(data)
    del new["rows"][3]
    assert [change.kind for change in compare(data, new)] == ["gone"]
    new["settings"] = {**new["settings"], "quick": False}
    assert compare(data, new) == []


# The command


def test_the_command_compares_with_an_earlier_run(run, tmp_path, monkeypatch, found):
    monkeypatch.setattr("radiokit.faces.bench.run.bench", lambda **options: found)
    path = tmp_path / "old.json"
    code, out, err = run("bench", "--quick", "--json")
    assert (code, err) == (0, "")
    path.write_text(out, encoding="utf-8")
    assert load(path)["settings"]["quick"] is True
    code, out, err = run("bench", "--quick", "--compare", str(path))
    assert (code, err) == (0, "")
    assert "nothing is slower or less accurate than in" in out
    assert "radiokit / peer" in out
    assert "throughput: ggx-0.3-at-60deg, 262144 samples" in out
    assert "Numba cache" in out
    better = changed(quiet(found.to_json()), "mc", relative_seconds=0.1, relative_best=0.1)
    path.write_text(json.dumps(better), encoding="utf-8")
    monkeypatch.setattr(comparing, "NOISE", 0.0)
    code, out, _ = run("bench", "--quick", "--compare", str(path))
    assert code == 1
    assert "slower: mc, all rows: 10.00 times as long over 12 rows" in out
    code, out, _ = run("bench", "--quick", "--json", "--compare", str(path))
    assert code == 1
    assert {change["kind"] for change in json.loads(out)["changes"]} == {"slower"}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (None, "cannot read"),
        ("{", "is no JSON"),
        ("[]", "is no run of the bench"),
        ('{"format": 9}', "is no run"),
    ],
)
def test_a_file_that_is_no_run_is_refused_at_once(run, tmp_path, text, says):
    path = tmp_path / "old.json"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    code, out, err = run("bench", "--quick", "--compare", str(path))
    assert (code, out) == (2, "")
    assert says in err
    assert err.count("\n") == 1


def test_arguments_out_of_range_are_named():
    with pytest.raises(ParameterError, match="repeats = 1"):
        bench(quick=True, repeats=1)
    with pytest.raises(ParameterError, match="seed = -1"):
        bench(quick=True, seed=-1)


def test_the_noise_is_that_of_the_median(rng):
    """Of 41 times with a spread of 10 %, the median is uncertain by about 1.25 · 10 % / √41."""
    noise = [Timing(tuple(np.exp(0.1 * rng.standard_normal(41))), ()).noise for _ in range(100)]
    assert np.mean(noise) == pytest.approx(0.1253 / np.sqrt(41), rel=0.15)


def test_the_source_of_the_kernel_is_shipped():
    import radiokit.faces.bench.peers as package

    assert Path(package.__file__).with_name("ggx.c").is_file()
