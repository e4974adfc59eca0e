"""Nbgrader: what it makes of our notebook, and what it gives for right, wrong and hostile submissions."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

import radiokit as rk
from radiokit.faces.grading.assignment import load_assignment
from radiokit.faces.grading.handout import kernel
from radiokit.faces.grading.handout.nbgrader import CONFIG
from radiokit.faces.grading.handout.worked import read_solution

HERE = Path(__file__).parent
HOMEWORK, SOLUTION = HERE / "homework.py", HERE / "homework_solution.py"
RIGHT = {
    "irradiance-answer": """def irradiance(intensity, distance, theta):
    return intensity * np.cos(theta) / distance**2""",
    "cone-answer": """def cone(half_angle):
    return 4 * np.pi * np.sin(half_angle / 2) ** 2""",
    "helpers": 'import sys, warnings\nsys.stderr.write("a word")\nwarnings.warn("another")',
}
HOSTILE = {
    "irradiance-answer": """def irradiance(intensity, distance, theta):
    while True:
        pass""",
    "cone-answer": """def cone(half_angle):
    return 2 * np.pi * (1 - np.cos(half_angle))""",
    "helpers": """import radiokit as rk
rk.grading.kernel_points = lambda *a, **k: np.float64(3)
class In(list): pass
In = In()""",
}


EVIL = """import pathlib, radiokit as rk
pathlib.Path({mark!r}).touch()"""


def nbgrader(*words, cwd):
    """Run the real tool; it finds its helpers and kernel beside this interpreter."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PYTHONPATH": str(HERE.parent), "PATH": path}
    command = [sys.executable, "-W", "ignore", "-m", "nbgrader", *map(str, words)]
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout + done.stderr


def cells_by_id(path):
    cells = nbformat.read(path, as_version=4).cells
    return {cell.metadata.nbgrader["grade_id"]: cell for cell in cells if "nbgrader" in cell.metadata}


def with_an_essay(path):
    """Let the instructor ask for code that a person reads: a graded cell that a student writes."""
    notebook = nbformat.read(path, as_version=4)
    about = {"grade_id": "essay", "grade": True, "solution": True, "locked": False, "points": 0}
    metadata = {"nbgrader": {**about, "schema_version": 3, "task": False}}
    notebook.cells.append(nbformat.v4.new_code_cell("...", metadata=metadata))
    nbformat.write(notebook, path)


def graded_course(folder):
    """Make a course in a folder: the release, two submissions, and their grades."""
    rk.grading.write_handout(HOMEWORK, nbgrader=folder, solution=SOLUTION)
    with_an_essay(folder / "source/homework/homework.ipynb")
    evil = folder / "evil.py"
    evil.write_text(EVIL.format(mark=str(folder / "mark")))
    essay = f'pass\nrk.grading.kernel_points("cone", assignment={str(evil)!r}, language="en")'
    nbgrader("generate_assignment", "homework", cwd=folder)
    for student, answers in (("right", RIGHT), ("hostile", {**HOSTILE, "essay": essay})):
        notebook = nbformat.read(folder / "release/homework/homework.ipynb", as_version=4)
        for cell in notebook.cells:
            cell.source = answers.get(cell.metadata.get("nbgrader", {}).get("grade_id"), cell.source)
        place = folder / "submitted" / student / "homework"
        place.mkdir(parents=True)
        nbformat.write(notebook, place / "homework.ipynb")
    nbgrader("autograde", "homework", cwd=folder)
    nbgrader("export", cwd=folder)


def look_at_the_release(cells):
    """It has no solutions, and runs blank."""
    text = json.dumps([cell.source for cell in cells.values()])
    for body in read_solution(SOLUTION, load_assignment(HOMEWORK)).bodies.values():
        assert not [line for line in body.split("\n") if len(line.strip()) > 5 and line.strip() in text]
    assert "squared" not in text
    assert "NotImplementedError" not in text
    assert cells["cone-answer"].source.endswith("\n    ...")
    assert cells["cone-test"].metadata.nbgrader["points"] == 3
    assert not cells["cone-test"].metadata.get("editable", True)


def look_at_the_reasons(cells):
    """They are in the test cells, and those of hidden parts are not."""
    words, points = cells["irradiance-test"].outputs
    assert words.text == "irradiance: 0 of 2 points\n  ordinary inputs: irradiance took longer than 2 s\n"
    assert points.data["text/plain"] == "0.0"
    words, points = cells["cone-test"].outputs
    assert words.text == "cone: 1.5 of 3 points\n  ordinary inputs: right\n"
    assert points.data["text/plain"] == "1.5"


def test_each_gets_what_is_earned_and_nothing_that_is_shown_or_forged(tmp_path):
    """Words on standard error cost nothing, digits that are lost cost a part, forging gains nothing.

    One test, as nbgrader takes its time.
    """
    graded_course(tmp_path)
    assert not (tmp_path / "mark").exists()  # no assignment that a student names is run
    look_at_the_release(cells_by_id(tmp_path / "release/homework/homework.ipynb"))
    with (tmp_path / "grades.csv").open() as file:
        rows = list(csv.DictReader(file))
    scores = {row["student_id"]: (float(row["score"]), float(row["max_score"])) for row in rows}
    assert scores == {"right": (5, 5), "hostile": (1.5, 5)}
    look_at_the_reasons(cells_by_id(tmp_path / "autograded/hostile/homework/homework.ipynb"))
    # a student asks in the own kernel: there the cells that were executed are graded, on the visible parts
    told = nbgrader("validate", "submitted/right/homework/homework.ipynb", cwd=tmp_path)
    assert "Success! Your notebook passes all the tests." in told


def test_in_a_students_kernel_the_visible_parts_stand_for_all(monkeypatch, capsys):
    monkeypatch.setattr(kernel, "_executed", lambda: ["import numpy as np", HOSTILE["cone-answer"]])
    monkeypatch.delenv("NBGRADER_EXECUTION", raising=False)
    earned = rk.grading.kernel_points("cone", assignment=str(HOMEWORK), language="ru")
    assert (type(earned), earned) == (float, 3.0)
    assert capsys.readouterr().out == "cone: баллы: 1.5 из 1.5\n  обычные входы: верно\n"
    monkeypatch.setenv("NBGRADER_EXECUTION", "autograde")
    assert rk.grading.kernel_points("cone", assignment=str(HOMEWORK), language="ru") == 1.5
    monkeypatch.setenv(kernel.GRADED, kernel.LATER)
    assert rk.grading.kernel_points("cone", assignment=str(HOMEWORK), language="ru") == 0.0


def test_a_grader_that_takes_too_long_is_ended(monkeypatch):
    monkeypatch.setattr(kernel, "_executed", lambda: ["def cone(half_angle): return 1.0"])
    with pytest.raises(rk.errors.RadiokitError, match=r"took longer than 1e-09 s"):
        rk.grading.kernel_points("cone", assignment=str(HOMEWORK), seconds=1e-9)


def test_a_course_that_has_a_configuration_keeps_it_if_it_makes_points_safe(tmp_path):
    config = tmp_path / "nbgrader_config.py"
    config.write_text("c = get_config()\n")
    with pytest.raises(rk.errors.TargetError, match="could give themselves points"):
        rk.grading.write_handout(HOMEWORK, nbgrader=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["nbgrader_config.py"]
    config.write_text(f"{CONFIG}\nc.CourseDirectory.course_id = 'light'\n")
    written = rk.grading.write_handout(HOMEWORK, nbgrader=tmp_path)
    assert [path.name for path in written] == ["homework.ipynb"]
    assert config.read_text().endswith("'light'\n")
