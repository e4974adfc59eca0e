"""The checkup of an assignment: the solution earns all and blanks nothing, or it is said what is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.grading import checkup
from radiokit.faces.grading.assignment import assignment_from_source
from radiokit.faces.grading.unfound import unfound
from radiokit.facts.errors import ParameterError

HERE = Path(__file__).parent
HOMEWORK, SOLUTION = HERE / "homework.py", HERE / "homework_solution.py"


def test_an_assignment_that_is_right(capsys, monkeypatch):
    monkeypatch.setattr(checkup, "SLOW", 100.0)  # whatever machine this is
    with pytest.raises(SystemExit) as ended:
        main(["assignment", str(HOMEWORK), "--check", "--solution", str(SOLUTION), "--students", "2"])
    told = capsys.readouterr()
    assert (ended.value.code, told.err) == (0, "")
    assert told.out.startswith("homework: 2 questions, tried for 2 students\n")
    assert told.out.endswith("✓ blanks earn nothing; the solution earns full marks\n")


def test_a_solution_that_is_wrong_or_an_assignment_that_is(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(checkup, "SLOW", 0.0)
    wrong = tmp_path / "wrong.py"
    wrong.write_text(
        SOLUTION.read_text().replace("def cone(half_angle):", "def cone(half_angle):\n    return 2.0")
    )
    with pytest.raises(SystemExit) as ended:
        main(["assignment", str(HOMEWORK), "--check", "--solution", str(wrong), "--students", "2", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert (ended.value.code, found["ok"], found["solved"]) == (1, False, True)
    ordinary, hard = found["mistakes"]
    assert ordinary.startswith("question cone, part ordinary: the solution falls short for 2 of 2 students: ")
    assert hard.startswith("question cone, part hard: ")
    assert set(found["seconds"]) == {"irradiance", "cone"}
    assert [note.split(" takes ")[0] for note in found["notes"]] == [
        "question irradiance: the solution",
        "question cone: the solution",
    ]
    assert all(note.endswith(", and each part is stopped after 2 s") for note in found["notes"])


def test_blanks_that_earn_points_and_faults_that_only_some_inputs_show(tmp_path):
    text = HOMEWORK.read_text()
    lenient = tmp_path / "lenient.py"
    kind = "class Kind:\n    def judge(self, *_, **__): return rk.grading.Finding(share=0.5, text='ok')"
    text = text.replace("def lamps(", f"{kind}\n\ndef lamps(", 1)
    text = text.replace("judge=rk.grading.Values(inputs=lamps, reference=irradiance)", "judge=Kind()", 1)
    text = text.replace("return 4 * np.pi *", "assert half_angle[0] > 2e-5\n    return 4 * np.pi *", 1)
    lenient.write_text(text)
    found = rk.grading.check_assignment(lenient, students=5)
    assert not found.ok
    assert found.notes == ("no solution was tried",)
    fault, blank = found.mistakes
    assert fault.startswith("question cone, part hard: reference raised AssertionError")
    assert blank == "question irradiance, part ordinary: a blank earns 1 of 2 points"


def test_a_tolerance_of_nothing_is_noted(tmp_path):
    exact = tmp_path / "exact.py"
    exact.write_text(
        HOMEWORK.read_text().replace("reference=irradiance)", "reference=irradiance, rtol=0)", 1)
    )
    found = rk.grading.check_assignment(exact, students=1)
    note = "question irradiance, part ordinary: rtol, ulps and atol are 0: only answers right to the last bit"
    assert found.ok
    assert f"{note} count" in found.notes


NOTED = """
import radiokit as rk
G = rk.grading
TEXT = {"en": "Q"}
def powers(rng): return {"n": rng.uniform(1, 20)}
def lobe(n): return 2 / (n + 1)
def density(n): return {"pdf": 1 / n}
CREDIT = {"pdf-forgotten": 0.5, "doubled + sum-for-mean": 0.5, "pi-too-many": 0.5}
PART = G.Part(name="unbiased", judge=G.Estimator(inputs=powers, reference=lobe, credit=CREDIT))
ASSIGNMENT = G.Assignment(name="noted", title=TEXT, intro=TEXT, questions=(G.Question(
    signature="lobe(n, samples, seed)", points=1, title=TEXT, text=TEXT, parts=(PART,),
    hints={"cosine-forgotten": TEXT, "deviation-for-error": TEXT, "halved": TEXT}),))
"""


def test_hints_and_credit_that_can_come_to_nobody_are_noted():
    known = "told by {}, which neither inputs nor context give"
    assert list(unfound(assignment_from_source(NOTED))) == [
        "question lobe, part unbiased: credit for 'pdf-forgotten' can come to nobody: it is "
        + known.format("pdf"),
        "question lobe: hints for 'cosine-forgotten' can come to nobody: it is " + known.format("cosine"),
    ]
    given = NOTED.replace("credit=CREDIT", "credit=CREDIT, context=density")
    given = given.replace("parts=(PART,)", "parts=(PART, G.Part(name='hard', judge=G.Laws()))")
    assert list(unfound(assignment_from_source(given))) == []


def test_students_are_at_least_one():
    with pytest.raises(ParameterError, match="students = 0"):
        rk.grading.check_assignment("radiometry", students=0)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--check", "--to", "copies"), "check = True is not allowed: it must be alone"),
        (("--solution", "mine.py"), "solution = 'mine.py' is not allowed: it must be beside --check"),
        (("--secret-file", "mine.txt"), "secret-file = 'mine.txt' is not allowed"),
    ],
)
def test_options_that_do_nothing_are_refused(options, said, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["assignment", str(HOMEWORK), *options])
    assert ended.value.code == 2
    assert said in capsys.readouterr().err


def test_a_file_is_suggested_where_its_suffix_is_forgotten(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "homework.py").write_text(HOMEWORK.read_text())
    with pytest.raises(SystemExit) as ended:
        main(["assignment", "homework"])
    assert ended.value.code == 2
    assert "did you mean 'homework.py'?" in capsys.readouterr().err


def test_a_check_needs_a_name(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["assignment", "--check"])
    assert ended.value.code == 2
    assert "radiometry, shading, or FILE.py" in capsys.readouterr().err
