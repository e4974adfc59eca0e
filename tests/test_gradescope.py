"""Gradescope's autograder, run as Gradescope runs it: its folders, and submissions of every kind."""

from __future__ import annotations

import json
import os
import signal
import stat
import subprocess
import sys
import tempfile
import time
import zipfile
from dataclasses import replace
from functools import partial
from pathlib import Path

import jsonschema
import pytest

import radiokit as rk
from radiokit.faces.grading import autograder, grader
from radiokit.faces.grading.autograder import main, student_of
from radiokit.faces.grading.formats.gradescope_zip import pinned_requirements
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.facts.errors import ParameterError, RadiokitError, TargetError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Gradescope runs Linux")

RESULTS = json.loads(Path(__file__).with_name("gradescope.schema.json").read_text("utf-8"))
SECRET = "d41d8cd98f00b204"
ASSIGNMENT = """\
import radiokit as rk

def both(text):
    return {"en": text, "ru": text}

def question(name, visibility="visible"):
    judge = rk.grading.Values(inputs=lambda rng: {"x": rng.uniform(1, 2, 8)}, reference=lambda x: x**2)
    part = rk.grading.Part(name="ordinary", judge=judge, visibility=visibility)
    return rk.grading.Question(
        signature=f"{name}(x)", points=2, title=both(name), text=both(name), parts=(part,), seconds=600
    )

ASSIGNMENT = rk.grading.Assignment(
    name="work", title=both("Work"), intro=both("Work"), limits=rk.grading.Limits(seconds=600),
    questions=(question("first"), question("second", "hidden")),
)
"""
RIGHT = "def first(x): return x * x\nsecond = first\n"
HOSTILE = """\
import os, sys
BASE = {base!r}
found = []
for path in ("source/secret.txt", "source/assignment.py", "submission_metadata.json", "results/results.json"):
    try:
        found.append(open(f"{{BASE}}/{{path}}").read())
    except OSError as error:
        found.append(type(error).__name__)
for path in ("results/results.json", "results/x", "source/x"):
    try:
        open(f"{{BASE}}/{{path}}", "w").write('{{"score": 4}}')
        found.append("wrote")
    except OSError as error:
        found.append(type(error).__name__)
print('{{"score": 4, "tests": []}}', flush=True)
def first(x):
    raise ValueError(" ".join(found))
def second(x):
    print('{{"score": 4, "tests": []}}', flush=True)
    os.write(2, b"{{}}")
    os._exit(0)
"""
METADATA = {"users": [{"email": "b@x", "id": 2, "name": "B"}, {"email": "a@x", "id": 1, "name": "A"}]}


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    folder = tmp_path_factory.mktemp("zip")
    (folder / "work.py").write_text(ASSIGNMENT, encoding="utf-8")
    return rk.grading.gradescope_zip(folder / "work.py", folder / "autograder.zip", secret=SECRET)


@pytest.fixture(scope="module")
def base(archive):
    """The folder that Gradescope calls /autograder, as it is before the first submission: open to all."""
    with tempfile.TemporaryDirectory(prefix="autograder-") as folder:
        yield laid_out(Path(folder), archive)


def laid_out(base: Path, archive: Path) -> Path:
    base.chmod(0o755)
    with zipfile.ZipFile(archive) as opened:
        opened.extractall(base / "source")
        for info in opened.infolist():
            (base / "source" / info.filename).chmod(info.external_attr >> 16 & 0o777)
    (base / "run_autograder").write_bytes((base / "source" / "run_autograder").read_bytes())
    (base / "results").mkdir()
    (base / "submission").mkdir()
    (base / "submission_metadata.json").write_text(json.dumps(METADATA), encoding="utf-8")
    return base


@pytest.fixture
def hand_in(base):
    def hand_in(**files: str) -> None:
        for folder in ("results", "submission"):
            for path in (base / folder).iterdir():
                path.unlink()
        for name, text in files.items():
            (base / "submission" / name.replace("_py", ".py")).write_text(text, encoding="utf-8")

    return hand_in


def start(base: Path) -> subprocess.Popen[str]:
    """Start the autograder by bash, with this Python in place of the one that setup.sh would make."""
    (base.parent / "tmp").mkdir(exist_ok=True)
    environment = {
        "PATH": os.environ["PATH"],
        "TMPDIR": str(base.parent / "tmp"),  # where one that is killed leaves a file, as its container may
        "AUTOGRADER_BASE": str(base),
        "AUTOGRADER_PYTHON": sys.executable,
    }
    return subprocess.Popen(
        ["bash", base / "run_autograder"],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def results_of(base: Path) -> dict[str, object]:
    results = json.loads((base / "results" / "results.json").read_text("utf-8"))
    jsonschema.Draft202012Validator(RESULTS).validate(results)
    return results


def graded(base: Path) -> dict[str, object]:
    process = start(base)
    printed, _ = process.communicate(timeout=300)
    assert process.returncode == 0, printed
    assert not any(secret in printed for secret in (SECRET, "a@x", "Traceback"))
    return results_of(base)


def test_the_archive_has_what_it_needs_and_no_more(archive):
    with zipfile.ZipFile(archive) as opened:
        modes = {info.filename: stat.S_IMODE(info.external_attr >> 16) for info in opened.infolist()}
        requirements = opened.read("requirements.txt").decode().split()
        assert opened.read("assignment.py").decode() == ASSIGNMENT
        assert opened.read("secret.txt").decode() == f"{SECRET}\n"
    assert modes["setup.sh"] == modes["run_autograder"] == 0o755
    assert modes["secret.txt"] == modes["assignment.py"] == 0o600
    assert {"package/radiokit/__init__.pyi", "package/radiokit/facts/report.schema.json"} <= set(modes)
    assert not [name for name in modes if "solution" in name or "__pycache__" in name or "/tests/" in name]
    assert requirements == pinned_requirements()
    assert {each.partition("==")[0] for each in requirements} >= {
        "numpy",
        "scipy",
        "rich",
        "typer",
        "lazy-loader",
    }
    assert not [each for each in requirements if each.startswith(("radiokit", "pytest=="))]


def test_equal_arguments_make_equal_archives(archive, tmp_path):
    again = rk.grading.gradescope_zip(archive.with_name("work.py"), tmp_path / "again.zip", secret=SECRET)
    assert again.read_bytes() == archive.read_bytes()


def test_an_assignment_of_radiokits_own_and_a_new_secret(tmp_path):
    files = [rk.grading.gradescope_zip("radiometry", tmp_path / name) for name in ("a.zip", "b.zip")]
    secrets = {zipfile.ZipFile(file).read("secret.txt") for file in files}
    assert len(secrets) == 2
    assert all(len(secret) == 65 for secret in secrets)


def test_what_cannot_be_archived_is_told(tmp_path):
    with pytest.raises(RadiokitError, match="unknown assignment"):
        rk.grading.gradescope_zip("radiomerty", tmp_path / "a.zip")
    with pytest.raises(ParameterError, match="its name or its file"):
        rk.grading.gradescope_zip(rk.grading.load_assignment("radiometry"), tmp_path / "a.zip")
    with pytest.raises(TargetError, match="cannot write"):
        rk.grading.gradescope_zip("radiometry", tmp_path / "no" / "a.zip")
    with pytest.raises(ParameterError, match="language"):
        rk.grading.gradescope_zip("radiometry", tmp_path / "a.zip", language="de")


@pytest.mark.parametrize("script", ["setup.sh", "run_autograder"])
def test_the_scripts_are_bash(base, script):
    text = (base / "source" / script).read_text("utf-8")
    assert text.startswith("#!/usr/bin/env bash\n")
    subprocess.run(["bash", "-n"], input=text, text=True, check=True)
    assert subprocess.run(["bash", "-n"], input=f"{text}\nif", text=True, capture_output=True).returncode != 0


def test_right_work_gets_all_points(base, hand_in):
    hand_in(homework_py=RIGHT)
    results = graded(base)
    assert [test["score"] for test in results["tests"]] == [2, 2]
    assert [test["visibility"] for test in results["tests"]] == ["visible", "hidden"]
    assert results["extra_data"]["complete"]
    closed = [stat.S_IMODE((base / name).stat().st_mode) for name in ("source", "results")]
    assert closed == [0o700, 0o700]


def test_hostile_work_gets_none(base, hand_in):
    hand_in(homework_py=HOSTILE.format(base=str(base)))
    results = graded(base)
    assert [test["score"] for test in results["tests"]] == [0, 0]
    told = results["tests"][0]["output"]
    assert SECRET not in json.dumps(results)
    if {"root", "user"} & set(results["extra_data"]["protections"]):
        assert told.count("FileNotFoundError") + told.count("PermissionError") == 7
    assert "exit code 0" in results["tests"][1]["output"]
    assert sorted(path.name for path in (base / "results").iterdir()) == ["results.json"]


def test_work_that_is_missing_or_several_is_told(base, hand_in, capsys):
    hand_in()
    assert main([str(base), "en"]) == 0
    assert "no .py or .ipynb file" in results_of(base)["output"]
    hand_in(a_py=RIGHT, b_py=RIGHT)
    assert main([str(base), "ru"]) == 0
    assert "нужен один" in results_of(base)["output"]
    assert sum(test["score"] for test in results_of(base)["tests"]) == 0
    hand_in()
    (base / "submission" / "a.py").symlink_to(base / "source" / "secret.txt")
    assert main([str(base), "en"]) == 0
    assert "a link that leads elsewhere" in results_of(base)["output"]
    assert SECRET not in json.dumps(results_of(base))
    assert capsys.readouterr() == ("", "")


def test_who_is_killed_leaves_what_was_graded(base, hand_in):
    hand_in(homework_py="import time\ndef first(x): return x * x\ndef second(x): time.sleep(600)\n")
    process = start(base)
    try:
        deadline = time.monotonic() + 120
        scores: list[float] = []
        while sum(scores) < 2:
            assert process.poll() is None
            assert time.monotonic() < deadline
            if (base / "results" / "results.json").is_file():  # at any moment, it is whole
                scores = [test["score"] for test in results_of(base)["tests"]]
            time.sleep(0.02)
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    results = results_of(base)
    assert [test["score"] for test in results["tests"]] == [2, 0]
    assert results["tests"][1]["output"] == "not graded yet"
    assert "not complete" in results["output"]


def test_without_namespaces_the_secret_is_closed_too(base, hand_in, monkeypatch):
    monkeypatch.setattr(grader, "Sandbox", partial(Sandbox, namespaces=False))
    for name in ("source", "results"):
        (base / name).chmod(0o700)
    (base / "submission_metadata.json").chmod(0o600)
    hand_in(homework_py=HOSTILE.format(base=str(base)))
    assert main([str(base), "en"]) == 0
    results = results_of(base)
    assert "root" not in results["extra_data"]["protections"]
    assert [test["score"] for test in results["tests"]] == [0, 0]
    if "user" in results["extra_data"]["protections"]:  # root can become another, if others can read Python
        assert results["tests"][0]["output"].count("PermissionError") == 7


def test_an_image_that_would_show_the_secret_is_not_built(monkeypatch, capsys):
    class Open(Sandbox):
        def load(self, timeout=None):
            return replace(super().load(timeout), protections=("limits", "privileges"))

    monkeypatch.setattr(autograder, "Sandbox", Open)
    assert main(["--check"]) == 1
    assert "could read the secret" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("metadata", "student"),
    [
        (METADATA, "a@x,b@x"),
        ({"users": [{"id": 7, "email": ""}]}, "7"),
        ({"users": [{"email": "a\x1b\n\ud800@x "}]}, "a? ?@x"),
        ({"users": []}, ""),
        ({}, ""),
        (None, ""),
        ([], ""),
        ({"users": ["x", None]}, ""),
    ],
)
def test_who_handed_in(metadata, student):
    assert student_of(metadata) == student
