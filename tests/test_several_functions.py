"""A question that asks for several functions: each has its blank, its check, its parts and its sentence."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading.assignment import load_assignment
from radiokit.faces.grading.handout.cells import script
from radiokit.faces.grading.handout.copies import instructor_cells, student_cells
from radiokit.faces.grading.handout.nbgrader import nbgrader_cells
from radiokit.faces.grading.handout.otter import otter_cells
from radiokit.faces.grading.handout.worked import read_solution
from radiokit.facts.errors import ParameterError, TargetError, UnknownNameError

G = rk.grading
BOTH = {"en": "A cone", "ru": "Конус"}
SOLUTION = """\
import numpy as np

def solid_angle(half_angle):
    return 4 * np.pi * np.sin(half_angle / 2) ** 2

def half_angle_of(solid_angle):
    return 2 * np.arcsin(np.sqrt(solid_angle / (4 * np.pi)))
"""


def _part(name, function=""):
    inverse = function == "half_angle_of"
    judge = G.Values(
        inputs=lambda rng: {"solid_angle" if inverse else "half_angle": rng.uniform(0.5, 3, 8)},
        reference=(lambda solid_angle: 2 * np.arcsin(np.sqrt(solid_angle / (4 * np.pi))))
        if inverse
        else (lambda half_angle: 4 * np.pi * np.sin(half_angle / 2) ** 2),
    )
    return G.Part(name=name, title=BOTH, judge=judge, function=function)


QUESTION = G.Question(
    signature="solid_angle(half_angle)",
    also=("half_angle_of(solid_angle)",),
    points=2,
    title=BOTH,
    text=BOTH,
    parts=(_part("forth"), _part("back", "half_angle_of")),
)
WORK = G.Assignment(name="cones", title=BOTH, intro=BOTH, questions=(QUESTION,))


@pytest.fixture
def solution(tmp_path):
    file = tmp_path / "solution.py"
    file.write_text(SOLUTION)
    return file


def _space(cells):
    space = {"__name__": "theirs"}
    exec(script([cell for cell in cells if cell.kind == "code" and "test" not in cell.key]), space)
    return space


def test_every_copy_has_each_function_in_the_cell_of_the_first(solution):
    solved = read_solution(solution, WORK)
    assert solved.helpers == "import numpy as np"
    for made in (
        lambda given: student_cells(WORK) if given is None else instructor_cells(WORK, solution=given),
        lambda given: otter_cells(WORK, solution=given, graded_by="cones"),
        lambda given: nbgrader_cells(WORK, solution=given, graded_by="cones"),
    ):
        (cell,) = [each for each in made(solved) if each.key == "solid_angle-answer"]
        assert "def half_angle_of(solid_angle):" in cell.source
        blank, full = _space(made(None)), _space(made(solved))
        assert blank["solid_angle"](1.0) is None
        assert blank["half_angle_of"](1.0) is None
        assert full["half_angle_of"](full["solid_angle"](1.0)) == pytest.approx(1.0)


def test_a_solution_without_one_of_them_is_refused(solution):
    solution.write_text(SOLUTION.replace("half_angle_of", "other"))
    with pytest.raises(TargetError, match="defines no function half_angle_of"):
        read_solution(solution, WORK)


def test_each_is_graded_and_one_that_is_not_there_costs_its_own_parts(tmp_path):
    file = tmp_path / "theirs.py"
    file.write_text(SOLUTION.replace("half_angle_of", "half_angle_off"))
    forth, back = G.grade(WORK, file)["solid_angle"].parts
    assert forth.full
    assert (back.score, back.text) == (0, "defines no function half_angle_of; is it half_angle_off?")
    file.write_text(SOLUTION.replace("def solid_angle(", "def solid_angel("))
    forth, back = G.grade(WORK, file, language="ru")["solid_angle"].parts
    assert back.full
    assert (forth.score, forth.text) == (
        0,
        "функция solid_angle не определена; может быть, это solid_angel?",
    )


def test_a_density_that_is_misspelt_is_guessed(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(
        "import numpy as np\ndef cosine_sample(u): return u\ndef cosine_PDF(directions): return 0\n"
    )
    found = G.grade("shading", file, questions=["cosine_sample"])["cosine_sample"]
    assert found.parts[1].text == "defines no function cosine_pdf; is it cosine_PDF?"


def test_a_students_check_of_either_leads_to_the_question(solution):
    check = G.practice(WORK)
    space = _space(instructor_cells(WORK, solution=read_solution(solution, WORK)))
    for name in QUESTION.functions:
        found = check.judged(space[name], namespace=space)
        assert (found.name, found.right, len(found.lines)) == ("solid_angle", True, 2)
    blank = _space(student_cells(WORK))
    both = check.judged(blank["half_angle_of"], namespace=blank)
    assert str(both) == "solid_angle\n  · not written yet"
    half = check.judged(space["solid_angle"], namespace=blank)
    assert half.right is False
    assert str(half).endswith("A cone: right\n  · A cone: half_angle_of — not written yet")
    alone = check.judged(space["half_angle_of"])
    assert str(alone).endswith("· A cone: solid_angle — not defined here\n  ✓ A cone: right")


def test_the_third_assignment_asks_for_densities_beside_samplers():
    work = load_assignment("shading")
    assert work.question("cosine_pdf").name == "cosine_sample"
    assert work.question("lobe_sample").functions["lobe_pdf"] == ("directions", "exponent")
    with pytest.raises(UnknownNameError, match="did you mean 'lobe_pdf'"):
        work.question("lobe_pdff")


@pytest.mark.parametrize(
    "change",
    [
        {"also": "half_angle_of(solid_angle)"},
        {"also": ("half_angle_of(",)},
        {"also": ("solid_angle(x)",)},
        {"also": ()},  # a part is on a function that is no longer there
    ],
)
def test_further_functions_are_checked_as_the_first(change):
    with pytest.raises(ParameterError):
        dataclasses.replace(QUESTION, **change)


def test_no_function_is_asked_for_twice_in_an_assignment():
    second = dataclasses.replace(QUESTION, signature="other(x)", parts=(_part("forth"),), also=QUESTION.also)
    with pytest.raises(ParameterError, match="functions of its own"):
        dataclasses.replace(WORK, questions=(QUESTION, second))
