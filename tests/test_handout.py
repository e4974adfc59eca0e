"""What students and instructors hold: it is made anew the same, it runs, and students have no solutions."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import nbformat
import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.grading.assignment import list_assignments, load_assignment
from radiokit.faces.grading.handout.cells import notebook, script
from radiokit.faces.grading.handout.copies import instructor_cells, student_cells
from radiokit.faces.grading.handout.nbgrader import nbgrader_cells
from radiokit.faces.grading.handout.otter import otter_cells
from radiokit.faces.grading.handout.worked import read_solution
from radiokit.faces.grading.words import SENTENCES

HERE = Path(__file__).parent
HOMEWORK, SOLUTION = HERE / "homework.py", HERE / "homework_solution.py"
LECTURES = HERE.parent / "lectures"
LANGUAGES = ("en", "ru")


def solved(name):
    """Return an assignment's file of solutions, where there is one."""
    return SOLUTION if name == "homework" else LECTURES / "solutions" / f"{name}.py"


def bodies(path):
    """Return the lines of all functions of a file that say more than a bracket."""
    found = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)]
    lines = path.read_text().splitlines()
    inner = [line.strip() for node in found for line in lines[node.body[0].lineno - 1 : node.end_lineno]]
    return {line for line in inner if len(line) > 5}


@pytest.mark.parametrize("name", list_assignments())
def test_the_committed_copies_are_those_of_the_assignment(name, tmp_path):
    written = rk.grading.write_handout(name, to=tmp_path, languages=LANGUAGES)
    assert len(written) == 4
    for path in written:
        kept = LECTURES / "assignments" / path.name
        assert kept.read_bytes() == path.read_bytes(), f"radiokit assignment {name} --to lectures/assignments"


def test_nothing_else_is_kept_beside_them():
    kept = {path.name for path in (LECTURES / "assignments").iterdir()}
    made = {
        f"{name}.{language}{form}"
        for name in list_assignments()
        for language in LANGUAGES
        for form in (".ipynb", ".py")
    }
    assert kept == made


@pytest.mark.parametrize("name", [*list_assignments(), "homework"])
def test_no_line_of_a_solution_is_in_a_students_copy(name):
    if not solved(name).is_file():
        pytest.skip("has no solutions yet")
    work = load_assignment(HOMEWORK if name == "homework" else name)
    lines = bodies(solved(name))
    assert len(lines) > 3
    for language in LANGUAGES:
        copy = {line.strip() for cell in student_cells(work, language) for line in cell.source.split("\n")}
        assert not lines & copy
        solution = read_solution(solved(name), work)
        theirs = instructor_cells(work, language, solution=solution)
        told = {line.strip() for cell in theirs for line in cell.source.split("\n")}
        assert lines & told  # the same test finds them where they are


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_notebook_is_valid_and_says_all_that_is_asked(language):
    work = load_assignment(HOMEWORK)
    solution = read_solution(SOLUTION, work)
    for cells in (
        student_cells(work, language, checked_by="homework"),
        instructor_cells(work, language, solution=solution),
        otter_cells(work, language, solution=solution, graded_by="homework"),
        otter_cells(work, language, graded_by="homework"),
        nbgrader_cells(work, language, solution=solution, graded_by="homework"),
    ):
        found = nbformat.reads(notebook(cells), as_version=4)
        nbformat.validate(found)
        assert nbformat.writes(found) + "\n" == notebook(cells)  # as Jupyter would save it
        ids = [cell.id for cell in found.cells]
        assert len(set(ids)) == len(ids)
        text = "\n".join(cell.source for cell in found.cells)
        for question in work.questions:
            assert question.title[language] in text
            assert question.text[language] in text
            assert f"def {question.signature}:" in text


@pytest.mark.parametrize("name", list_assignments())
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_students_script_runs_and_every_function_is_blank(name, language, capsys):
    work = load_assignment(name)
    source = script(student_cells(work, language, checked_by=name))
    assert source.count("# %%") == source.count("\n\n# %%") + 1
    space = {"__name__": "theirs"}
    exec(compile(source, "theirs.py", "exec"), space)
    blank = {"en": "not written yet", "ru": "ещё не написана"}[language]
    assert capsys.readouterr().out.count(blank) == 2 * len(work.questions)
    titles = [question.title[language] for question in work.questions]
    assert [space[question.name].__doc__ for question in work.questions] == [f"{title}." for title in titles]


@pytest.mark.parametrize("name", ["intro", "setup", "helpers", "all", "hand", "otter"])
def test_no_question_is_taken_for_a_cell_of_ours(name):
    words = {"en": name, "ru": name}
    judge = rk.grading.Values(inputs=lambda rng: {"x": rng.random(3)}, reference=lambda x: x)
    parts = (rk.grading.Part(name="ordinary", judge=judge),)
    question = rk.grading.Question(signature=f"{name}(x)", points=1, title=words, text=words, parts=parts)
    work = rk.grading.Assignment(name="a", title=words, intro=words, questions=(question,))
    for cells in (
        student_cells(work, checked_by="a"),
        otter_cells(work, graded_by="a"),
        nbgrader_cells(work, graded_by="a"),
    ):
        assert len({cell.id for cell in cells}) == len(cells)
        marks = [cell.metadata["nbgrader"]["grade_id"] for cell in cells if "nbgrader" in cell.metadata]
        assert len(set(marks)) == len(marks)


def test_an_instructors_copy_has_the_solutions_and_their_helpers():
    work = load_assignment(HOMEWORK)
    cells = instructor_cells(work, "ru", solution=read_solution(SOLUTION, work))
    space = {}
    exec(compile(script(cells), "ours.py", "exec"), space)
    check = rk.grading.practice(work, language="ru")
    for question in work.questions:
        assert check.judged(space[question.name], namespace=space).right is True
    assert space["cone"].__doc__ == "Конус."
    assert "\nnot indented" in script(cells)
    assert "halves" in script(cells)
    assert "__main__" not in script(cells)


def test_a_title_with_quotes_and_backslashes_is_a_docstring():
    work = load_assignment(HOMEWORK)
    space = {}
    exec(script(student_cells(work, "en")), space)
    assert space["cone"].__doc__ == 'The "cone" of \\(ω\\).'
    assert space["cone"](1.0) is None


def test_no_check_is_offered_where_a_student_has_no_assignment(tmp_path):
    (notebook,) = rk.grading.write_handout(HOMEWORK, to=tmp_path, forms=[".ipynb"])
    assert "check" not in notebook.read_text().replace("checked on", "")


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("def cone(a): pass", "defines no function irradiance"),
        ("def irradiance(a, b): pass", r"irradiance has parameters \(a, b\), not \(intensity,"),
        ("import x\n@x\ndef irradiance(intensity, distance, theta): pass", "decorator"),
        ("def irradiance(", "is no Python"),
    ],
)
def test_a_file_of_solutions_that_does_not_fit_is_refused(text, complaint, tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(text)
    with pytest.raises(rk.errors.TargetError, match=complaint):
        read_solution(file, load_assignment(HOMEWORK))


def run(*words):
    with pytest.raises(SystemExit) as ended:
        main(["assignment", *map(str, words)])
    return ended.value.code


def test_the_command_lists_and_shows(capsys):
    assert run() == 0
    assert "radiometry" in capsys.readouterr().out
    assert run("--json") == 0
    assert [each["name"] for each in json.loads(capsys.readouterr().out)["assignments"]] == list_assignments()
    assert run(HOMEWORK, "--language", "ru") == 0
    assert "трудные входы (1.5)" in capsys.readouterr().out
    assert run("radiometri") == 2
    assert "did you mean 'radiometry'?" in capsys.readouterr().err


def test_the_command_writes_and_spares_what_somebody_has_changed(tmp_path, capsys):
    words = (HOMEWORK, "--to", tmp_path, "--language", "ru", "--script", "--solution", SOLUTION)
    assert run(*words, "--json") == 0
    names = ["homework.ru.py", "homework.ru.solution.py"]
    assert json.loads(capsys.readouterr().out)["written"] == [str(tmp_path / name) for name in names]
    assert run(*words) == 0  # the same again
    mine = tmp_path / names[0]
    mine.write_text(mine.read_text() + "mine")
    assert run(*words) == 2
    assert "is there and differs" in capsys.readouterr().err
    assert mine.read_text().endswith("mine")
    assert run(*words, "--force") == 0
    assert not mine.read_text().endswith("mine")


@pytest.mark.parametrize("form", [".ipynb", ".py"])
def test_a_copy_that_is_handed_in_as_it_is_has_no_problems(form, tmp_path):
    """Its checks are not there where it is graded, and are not missed."""
    (copy,) = rk.grading.write_handout("radiometry", to=tmp_path, forms=[form])
    question = load_assignment("radiometry").questions[0].name
    found = rk.grading.grade("radiometry", copy, questions=[question])
    assert found.problems == ()
    assert "returned None" in found[question].explanation


def test_some_of_the_questions_are_graded_as_all_are(tmp_path):
    file = tmp_path / "theirs.py"
    file.write_text("import numpy as np\ndef cone(half_angle): return 2 * np.pi * (1 - np.cos(half_angle))\n")
    whole, part = (rk.grading.grade(HOMEWORK, file, questions=names) for names in (None, ["cone"]))
    assert [question.name for question in part.questions] == ["cone"]
    assert part["cone"] == whole["cone"]
    assert (part.score, part.points) == (1.5, 3)
    assert np.isclose(whole.points, 5)
    with pytest.raises(rk.errors.UnknownNameError, match="did you mean 'cone'"):
        rk.grading.grade(HOMEWORK, file, questions=["cones"])


def test_a_question_is_graded_alone_though_it_shares_its_hints(tmp_path):
    file = tmp_path / "theirs.py"
    file.write_text("")
    found = rk.grading.grade("brdfs", file, questions=["phong"])
    assert (found.complete, [question.name for question in found.questions]) == (True, ["phong"])


def test_the_texts_have_both_languages():
    from radiokit.faces.grading.handout.texts import TEXTS

    assert not set(TEXTS) & set(SENTENCES)
    for texts in TEXTS.values():
        assert set(texts) == set(LANGUAGES)
        assert all(texts.values())
