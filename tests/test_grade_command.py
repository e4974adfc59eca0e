"""``radiokit grade``: what it prints and writes, its exit codes, its secret, and that it goes on."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import jsonschema
import pytest

from radiokit.faces.cli import main
from radiokit.faces.grading.record import grade_schema
from radiokit.faces.grading.words import SENTENCES

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the sandbox needs a POSIX system")

ASSIGNMENT = """\
import os
import numpy as np
import radiokit as rk

def both(text):
    return {"en": text, "ru": f"{text} по-русски"}

class Stops:
    def judge(self, callee, rng, *, language, hints, shown):
        if os.environ.get("STOP") == "break":
            raise ZeroDivisionError("judge")
        if os.environ.get("STOP"):
            raise KeyboardInterrupt
        return rk.grading.Finding(share=1.0, text="judged")

def question(name, judge, **more):
    parts = (rk.grading.Part(name="ordinary", judge=judge, **more),)
    title = both(name)
    return rk.grading.Question(signature=f"{name}(x)", points=2, title=title, text=title, parts=parts)

square = rk.grading.Values(inputs=lambda rng: {"x": rng.uniform(1, 2, 8)}, reference=lambda x: x**2)
ASSIGNMENT = rk.grading.Assignment(
    name="work", title=both("Work"), intro=both("Work"),
    questions=(question("square", square), question("other", Stops(), visibility="hidden")),
)
"""
RIGHT = "def square(x): return x * x\ndef other(x): return x\n"
WRONG = "def square(x): return x\ndef other(x): return x\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "work.py").write_text(ASSIGNMENT, encoding="utf-8")
    (tmp_path / "right.py").write_text(RIGHT, encoding="utf-8")
    (tmp_path / "wrong.py").write_text(WRONG, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("RADIOKIT_SECRET", raising=False)
    return tmp_path


@pytest.fixture
def run(folder, capsys):
    def run(*words: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main(["grade", *words])
        printed = capsys.readouterr()
        return ended.value.code, printed.out, printed.err

    return run


def test_full_marks_are_zero(run):
    code, out, err = run("right.py", "--assignment", "work.py")
    assert (code, err) == (0, "")
    assert out.startswith("Work: 4 / 4\n")
    assert "judged" not in out


def test_less_is_one_and_all_files_are_written_alike_in_every_run(run, folder):
    files = ("a.html", "a.json", "a.xml", "a.md", "a.csv", "a.txt", "gradescope=b.json", "github=b.txt")
    words = ["wrong.py", "--assignment", "work.py", "--student", "anna", "--language", "ru", "--json"]
    words += [f"--out={file}" for file in files]
    runs = []
    for _ in range(2):
        code, out, err = run(*words)
        written = {name: (folder / name.split("=")[-1]).read_bytes() for name in files}
        assert (code, err) == (1, "")
        assert json.loads(written["a.json"]) == json.loads(out)
        runs.append((out, written))
    assert runs[0] == runs[1]
    data = json.loads(out)
    jsonschema.Draft202012Validator(grade_schema()).validate(data)
    assert (data["score"], data["points"], data["complete"], data["student"]) == (2, 4, True, "anna")
    assert all(b"anna" in written[name] for name in ("a.html", "a.md", "a.csv"))
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


def test_the_secret_counts_and_is_not_told(run, folder, monkeypatch):
    (folder / "secret.txt").write_text("some secret\n", encoding="utf-8")
    words = ("wrong.py", "--assignment", "work.py", "--json")
    _, without, _ = run(*words)
    _, from_file, _ = run(*words, "--secret-file", "secret.txt")
    monkeypatch.setenv("RADIOKIT_SECRET", "some secret")
    _, from_environment, _ = run(*words)
    assert from_file == from_environment
    texts = [json.loads(out)["questions"][0]["parts"][0]["text"] for out in (without, from_file)]
    assert texts[0] != texts[1]
    assert "some secret" not in from_file


def test_what_was_interrupted_goes_on(run, folder, monkeypatch):
    words = (
        "wrong.py",
        "--assignment",
        "work.py",
        "--student",
        "anna",
        "--out=a.json",
        "--out=gradescope=b.json",
    )
    monkeypatch.setenv("STOP", "yes")
    code, _, _ = run(*words)
    assert code == 130
    data = json.loads((folder / "a.json").read_text("utf-8"))
    assert (data["complete"], [each["name"] for each in data["questions"]]) == (False, ["square"])
    tests = json.loads((folder / "b.json").read_text("utf-8"))["tests"]
    assert [test["output"] for test in tests][1] == SENTENCES["not-graded"]["en"]
    assert (tests[1]["score"], tests[1]["max_score"]) == (0, 2)
    data["questions"][0]["parts"][0]["text"] = "from the file"
    monkeypatch.delenv("STOP")
    for student, told in (("ben", False), ("anna", True)):
        (folder / "a.json").write_text(json.dumps(data), encoding="utf-8")
        code, out, _ = run(*words[:3], "--student", student, *words[5:])
        assert (code, "from the file" in out) == (1, told)
        assert json.loads((folder / "a.json").read_text("utf-8"))["complete"]
    code, out, _ = run(*words)
    assert "from the file" not in out  # a complete one is graded again


def test_a_judge_that_fails_is_three(run, monkeypatch):
    monkeypatch.setenv("STOP", "break")
    code, out, err = run("right.py", "--assignment", "work.py", "--reveal")
    assert (code, err) == (3, "")
    assert "A teacher will look at this question." in out
    assert "ZeroDivisionError" in out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["gone.py", "--assignment=work.py"], "no such file: gone.py"),
        (["work", "--assignment=work.py"], "a script (.py) or a notebook (.ipynb)"),
        (["right.py"], "--assignment"),
        (["right.py", "--assignment=wrok"], "unknown assignment 'wrok'"),
        (["right.py", "--assignment=right.py"], "sets no ASSIGNMENT"),
        (["right.py", "--assignment=gone.py"], "no such file: gone.py"),
        (["right.py", "--assignment=work.py", "--language=de"], "'en' or 'ru'"),
        (["right.py", "--assignment=work.py", "--student=a\nb"], "printable"),
        (["right.py", "--assignment=work.py", "--out=a.pdf"], "ends in .txt, .json"),
        (["right.py", "--assignment=work.py", "--out=pdf=a"], "text, json, html"),
        (["right.py", "--assignment=work.py", "--out=gone/a.html"], "in a folder that is there"),
        (["right.py", "--assignment=work.py", "--secret-file=gone"], "cannot read the secret in gone"),
        (["right.py", "--assignment=work.py", "--secret-file=empty"], "a file with a secret in it"),
        (["right.py", "--assignment=work.py", "--secret-file=binary"], "UTF-8"),
    ],
)
def test_a_users_mistake_is_two_and_one_line(run, folder, words, told):
    Path("empty").write_text("\n", encoding="utf-8")
    Path("binary").write_bytes(b"\xff\xfe\xff")
    before = sorted(folder.iterdir())
    code, out, err = run(*words)
    assert (code, out) == (2, "")
    assert told in err
    assert err.count("\n") == 1
    assert sorted(folder.iterdir()) == before
