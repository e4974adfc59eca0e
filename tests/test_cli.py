"""The command line: what it prints, where, and with which exit code."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.facts.report import schema

THEIRS = """
import numpy as np

print("imported")

def blinn_phong(wi, wo, n=10):
    h = wi + wo
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    return (n + 8) / (8 * np.pi) * h[..., 2] ** n

def oren_nayar(wi, wo, sigma=0.3, rho=1.0):
    A = 1 - 0.5 * sigma**2 / (sigma**2 + 0.33)
    B = 0.45 * sigma**2 / (sigma**2 + 0.09)
    ti, to = np.arccos(wi[..., 2]), np.arccos(wo[..., 2])
    turn = np.arctan2(wi[..., 1], wi[..., 0]) - np.arctan2(wo[..., 1], wo[..., 0])
    alpha, beta = np.maximum(ti, to), np.minimum(ti, to)
    return rho / np.pi * (A + B * np.maximum(0, np.cos(turn)) * np.sin(alpha) * np.tan(beta))

def phong_over_cos(wi, wo, n=10):
    r = np.stack([-wo[..., 0], -wo[..., 1], wo[..., 2]], axis=-1)
    return (n + 2) / (2 * np.pi) * np.maximum((r * wi).sum(-1), 0) ** n / wi[..., 2]

def raises(wi, wo):
    raise ZeroDivisionError("oh no")

def lambert(wi, wo, reflectance=0.5):
    return np.full(len(wi), reflectance / np.pi)

number = 3
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "theirs.py").write_text(THEIRS, encoding="utf-8")
    (tmp_path / "typo.py").write_text("def f(wi, wo):\n    return 1 +\n", encoding="utf-8")
    (tmp_path / "crash.py").write_text("x = 1\ny = x / 0\n", encoding="utf-8")
    (tmp_path / "notes.txt").write_text("f", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def run(capfd):
    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main(list(arguments))
        out, err = capfd.readouterr()
        return stop.value.code or 0, out, err

    return call


def test_blinn_phong_of_a_stranger_gains_energy_at_normal_incidence(folder, run):
    code, out, err = run("check", "theirs.py:blinn_phong", "--json")
    report = json.loads(out)
    jsonschema.validate(report, schema())
    energy = next(verdict for verdict in report["verdicts"] if verdict["check"] == "energy")
    assert (code, err, energy["outcome"], energy["evidence"]) == (1, "", "violated", "refuted")
    assert energy["estimate"]["value"] == pytest.approx(1.0748, abs=5e-5)
    assert energy["details"]["theta_deg"] == 0


def test_oren_nayar_of_a_stranger_gains_energy_only_near_grazing(folder, run):
    code, out, _ = run("check", "theirs.py:oren_nayar", "--json")
    energy = next(verdict for verdict in json.loads(out)["verdicts"] if verdict["check"] == "energy")
    assert code == 1
    assert energy["details"]["above_limit_deg"][0] > 85
    assert energy["details"]["approached_at_grazing"] is True
    code, out, _ = run("albedo", "theirs.py:oren_nayar", "--theta", "89", "--json")
    assert json.loads(out)["value"] == pytest.approx(1.0041, abs=5e-5)


def test_phong_over_cosine_is_not_reciprocal_and_its_witness_shows_it(folder, run):
    code, out, _ = run("check", "theirs.py:phong_over_cos", "--json")
    verdict = next(verdict for verdict in json.loads(out)["verdicts"] if verdict["check"] == "reciprocity")
    assert (code, verdict["outcome"]) == (1, "violated")
    values = verdict["witness"]["values"]
    assert values["f(wi, wo)"] != values["f(wo, wi)"]


def test_parameters_reach_models_and_functions(folder, run):
    assert run("check", "theirs.py:lambert", "--reflectance", "1.5")[0] == 1
    assert run("check", "theirs.py:lambert", "--reflectance=0.9")[0] == 0
    code, out, _ = run("check", "theirs.py:lambert", "--reflectance", "1.5", "--evaluations=30000", "--json")
    assert code == 1
    assert json.loads(out)["verdicts"][0]["details"]["pairs"] < 1000
    code, out, err = run("albedo", "ggx", "--alpha", "1", "--theta", "60", "--json")
    assert (code, err) == (0, "")
    assert json.loads(out)["value"] == pytest.approx(0.450693855665945, rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["check", "nosuch.py:f"], "no such file: nosuch.py"),
        (["check", "typo.py:f"], "typo.py, line 2: syntax error: invalid syntax"),
        (
            ["check", "crash.py:f"],
            "crash.py, line 2: ZeroDivisionError while it was imported: division by zero",
        ),
        (
            ["check", "notes.txt:f"],
            "cannot check 'notes.txt:f': a target is a model's name, or file.py:function",
        ),
        (
            ["check", "theirs.py:blin_phong"],
            "theirs.py has no function 'blin_phong'; did you mean 'blinn_phong'?",
        ),
        (
            ["check", "theirs.py"],
            "name the function, as in theirs.py:FUNCTION. It defines: blinn_phong, oren_nayar",
        ),
        (["check", "theirs.py:number"], "theirs.py:number is no function: it is int"),
        (["check", "theirs.py:raises"], "raises raised ZeroDivisionError: oh no at wi = ("),
        (["check", "theirs.py:lambert", "--rho", "1"], "got an unexpected keyword argument 'rho'"),
        (["check", "ggx", "--alpha=-1"], "alpha = -1 is not allowed: it must be a number in "),
        (
            ["check", "ggx", "--alfa=1"],
            "BSDF 'ggx' has no parameter 'alfa'; did you mean 'alpha'? It has: alpha, eta, k",
        ),
        (["check", "ggx", "--alpha"], "parameter --alpha has no value"),
        (["check", "ggx", "extra"], "unexpected argument 'extra'"),
        (["check", "gxg"], "unknown model 'gxg'; did you mean 'ggx'? Known: "),
        (["check", "lambert", "--law", "enrgy"], "unknown law 'enrgy'; did you mean 'energy'?"),
        (["check", "lambert", "--seconds", "0"], "seconds = 0.0 is not allowed: it must be greater than 0"),
        (["check"], "Missing argument 'TARGET'"),
        (["albedo", "ggx", "--theta", "90"], "theta = 90.0 is not allowed: it must be in [0, 90) degrees"),
        (["albedo", "ggx", "--method", "guess"], "method = 'guess' is not allowed"),
        (["albedo", "ggx", "--seconds", "1"], "seconds = 1.0 is not allowed: it must be None, or method"),
        (["albedo", "ggx", "--samples", "many"], "Invalid value for '--samples'"),
        (["cases", "nosuch"], "unknown case 'nosuch'"),
        (["validate", "--workers", "0"], "workers = 0 is not allowed"),
        (["frobnicate"], "No such command 'frobnicate'"),
    ],
)
def test_a_mistake_gives_one_line_and_exit_code_2(folder, run, arguments, says):
    code, out, err = run(*arguments)
    assert code == 2
    assert out == ""
    assert says in err
    assert err.count("\n") == 1


def test_a_mistake_is_machine_readable_too(folder, run):
    code, out, _ = run("check", "ggx", "--alpha=-1", "--json")
    assert code == 2
    assert json.loads(out)["error"] == "ParameterError"


def test_an_inconclusive_check_exits_with_3(folder, run):
    (folder / "odd.py").write_text(
        "import numpy as np\ndef f(wi, wo):\n    return np.where(wi[:, 2] < 2e-4, np.nan, 0.1)\n",
        encoding="utf-8",
    )
    assert run("check", "odd.py:f", "--law", "reciprocity")[0] == 3


@pytest.mark.parametrize("method", ["mc", "qmc"])
def test_a_sampled_albedo_stops_at_its_tolerance_and_says_when_it_could_not(run, method):
    arguments = (
        "albedo",
        "ggx",
        "--alpha",
        "0.3",
        "--theta",
        "60",
        "--method",
        method,
        "--seed",
        "1",
        "--json",
    )
    code, out, err = run(*arguments, "--rtol", "2e-3")
    found = json.loads(out)
    assert (code, err, found["converged"]) == (0, "", True)
    assert found["error"] <= 2e-3 * found["value"]
    assert found["evaluations"] < 1 << 20
    code, out, _ = run(*arguments, "--rtol", "1e-12", "--samples", "4096")
    assert (code, json.loads(out)["converged"]) == (3, False)
    assert "rtol = 1e-12 was not reached with 4096 samples, but " in json.loads(out)["note"]
    code, out, _ = run(*arguments, "--seconds", "0.02", "--samples", str(1 << 28))
    assert (code, json.loads(out)["converged"]) == (3, False)
    assert run(*arguments, "--seconds", "0.02")[0] == 0


def test_cases_are_listed_shown_and_run(run):
    code, out, err = run("cases", "--json")
    data = json.loads(out)
    assert (code, err) == (0, "")
    assert [each["name"] for each in data["cases"]] == rk.list_cases()
    code, out, _ = run("cases", "lambert-in-furnace", "--run", "--json")
    assert code == 0
    assert {row["outcome"] for row in json.loads(out)["answers"]} == {"holds"}
    assert "derivation: " in run("cases", "lambert-in-furnace")[1]


def test_plain_output_is_text_without_escape_codes(run):
    code, out, err = run("check", "lambert")
    assert (code, err) == (0, "")
    assert "\x1b" not in out
    assert out.startswith("lambert: holds")


def test_the_installed_command_runs_and_is_silent_on_stderr(folder):
    command = [sys.executable, "-m", "radiokit.faces.cli", "check", "theirs.py:lambert"]
    env = {**os.environ, "TERM": "dumb"}
    found = subprocess.run(command, capture_output=True, text=True, env=env, check=False, cwd=Path.cwd())
    assert (found.returncode, found.stderr) == (0, "")
    assert "imported" not in found.stdout


def test_an_albedo_from_below_needs_a_surface_that_light_passes(run):
    code, out, err = run("albedo", "rough_dielectric", "--theta", "120", "--json")
    assert (code, err) == (0, "")
    assert json.loads(out)["value"] == pytest.approx(0.780186799, rel=1e-7)
    assert "in [0, 90) or (90, 180] degrees" in run("albedo", "rough_dielectric", "--theta", "90")[2]
    assert (
        "theta = 120.0 is not allowed: it must be in [0, 90) degrees"
        in run("albedo", "ggx", "--theta=120")[2]
    )
