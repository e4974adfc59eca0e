"""Otter-grader: what `otter assign` makes of our notebook grades right, wrong and hostile submissions."""

from __future__ import annotations

import json
import os
import pickle
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import nbformat
import pytest

import radiokit as rk
from radiokit.faces.grading.assignment import load_assignment
from radiokit.faces.grading.handout import kernel
from radiokit.faces.grading.handout.worked import read_solution

HERE = Path(__file__).parent
HOMEWORK, SOLUTION = HERE / "homework.py", HERE / "homework_solution.py"
NAIVE = "def cone(half_angle):\n    return 2 * np.pi * (1 - np.cos(half_angle))"
ENDLESS = """def irradiance(intensity, distance, theta):
    while True:
        pass"""
FORGING = """from radiokit.faces.grading.handout import kernel
kernel.kernel_check = lambda *a, **k: None"""
TOP_LEVEL = "while True:\n    pass"
STRAY = ("assignment/homework.py", "radiokit.py", "numpy.py", "ipykernel_launcher.py", "__init__.py")
"""What may not run, though it is handed in beside the notebook."""


class Unpickled:
    """Otter unpickles its log in its own process, where it finds one."""

    def __init__(self, mark):
        self.mark = mark

    def __reduce__(self):
        return (Path.touch, (self.mark,))


def handed_in(folder, notebook, mark):
    """Return a submission of many files, each of which makes the file ``mark`` if it is run."""
    path = folder / "theirs.zip"
    evil = f"import pathlib\npathlib.Path({str(mark)!r}).touch()\n"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("homework.ipynb", nbformat.writes(notebook))
        for name in STRAY:
            archive.writestr(name, evil)
        archive.writestr(".OTTER_LOG", pickle.dumps(Unpickled(mark)))
    return path


def otter(*words, cwd):
    """Run the real tool."""
    environment = {**os.environ, "PYTHONPATH": str(HERE.parent)}
    command = [sys.executable, "-W", "ignore", "-m", "otter", *map(str, words)]
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout + done.stderr


def assigned(folder):
    """Return what `otter assign` makes: it runs the tests on the solutions, and fails if any does."""
    written = rk.grading.write_handout(HOMEWORK, otter=folder, solution=SOLUTION)
    names = [path.relative_to(folder).as_posix() for path in written]
    assert names == ["homework.ipynb", "assignment/homework.py"]
    told = otter("assign", "homework.ipynb", "made", "-v", cwd=folder)
    assert "All autograder tests passed" in told
    return folder / "made"


def told_of_naive(folder):
    """What radiokit's grader itself says of digits that are lost."""
    file = folder / "naive.py"
    file.write_text(f"import numpy as np\n{NAIVE}\n")
    return rk.grading.grade(HOMEWORK, file, questions=["cone"])["cone"].parts[1].text


def look_at_the_student_version(folder):
    """It has neither solutions nor hidden tests nor answers."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    assert [path.name for path in files] == ["homework.ipynb"]
    notebook = nbformat.read(files[0], as_version=4)
    text = json.dumps(notebook, ensure_ascii=False)
    work = load_assignment(HOMEWORK)
    for body in read_solution(SOLUTION, work).bodies.values():
        assert not [line for line in body.split("\n") if len(line.strip()) > 5 and line.strip() in text]
    for secret in ("squared", "np.sin", "reference", 'part="hard"', "part='hard'"):
        assert secret not in text
    assert text.count("...") >= len(work.questions)
    tests = notebook.metadata.otter["tests"]
    assert set(tests) == {"irradiance", "cone"}
    assert all(test.count("kernel_check(") == 1 for test in tests.values())
    return notebook


def look_at_the_autograder(file):
    """It has the assignment, and each part once."""
    with zipfile.ZipFile(file) as found:
        names = found.namelist()
        test = found.read("tests/cone.py").decode()
    assert "files/assignment/homework.py" in names
    assert test.count("kernel_check(") == 2
    assert test.count("hidden=True") == 1
    assert "points=1.5" in test


def test_wrong_and_hostile_answers_cost_their_own_points_alone(tmp_path):
    """A function that never ends, one that loses digits, a forger, a cell that never ends, evil files beside.

    One test, as otter takes its time: what is assigned, and one run.
    """
    made = assigned(tmp_path)
    notebook = look_at_the_student_version(made / "student")
    (autograder,) = (made / "autograder").glob("*.zip")
    look_at_the_autograder(autograder)
    for cell in notebook.cells:
        if cell.cell_type == "code" and "def irradiance" in cell.source:
            cell.source = ENDLESS
        elif cell.cell_type == "code" and "def cone" in cell.source:
            cell.source = NAIVE
    notebook.cells[1:1] = [nbformat.v4.new_code_cell(source) for source in (FORGING, TOP_LEVEL)]
    mark = tmp_path / "mark"
    told = otter(
        "run",
        handed_in(tmp_path, notebook, mark),
        "-a",
        autograder,
        "-o",
        tmp_path,
        "--no-logo",
        cwd=tmp_path,
    )
    assert not mark.exists()
    found = {each["name"]: each for each in json.loads((tmp_path / "results.json").read_text())["tests"]}
    assert (found["irradiance"]["score"], found["irradiance"]["max_score"]) == (0, 2)
    assert (found["cone"]["score"], found["cone"]["max_score"]) == (1.5, 3)
    assert "FeedbackError: irradiance took longer than 2 s" in found["irradiance"]["output"]
    assert f"FeedbackError: {told_of_naive(tmp_path)}" in found["cone"]["output"]
    assert "Traceback" not in found["irradiance"]["output"]
    assert "hard" not in found["Public Tests"]["output"]
    assert "Homework: 1.5 / 5" in told  # the plugin's report


def test_a_test_case_in_a_students_own_kernel_grades_the_executed_cells(monkeypatch, tmp_path):
    cells = ["import radiokit as rk\nimport numpy as np", NAIVE, 'grader.check("cone")', ENDLESS]
    monkeypatch.setattr(kernel, "_executed", lambda: cells)
    assignment = str(HOMEWORK)
    kernel.kernel_check("cone", assignment=assignment, part="ordinary")
    with pytest.raises(kernel.FeedbackError, match=re.escape(told_of_naive(tmp_path))):
        kernel.kernel_check("cone", assignment=assignment, part="hard")
    with pytest.raises(rk.errors.TargetError, match="cone is graded after handing in"):
        kernel.kernel_check("cone", assignment="assignment/absent.py", part="ordinary")


def test_no_cells_are_no_answer():
    with pytest.raises(rk.errors.RadiokitError, match="called in a notebook"):
        rk.grading.kernel_check("cone", assignment=str(HOMEWORK), part="ordinary")
