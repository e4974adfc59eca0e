"""An instructor's mistakes: each is named in one line with what is right, and is never a student's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.grading.assignment import assignment_from_source, list_assignments, load_assignment
from radiokit.faces.grading.grades import Grade
from radiokit.faces.grading.rehearsal import faults, rehearse, rehearsed
from radiokit.facts.errors import AssignmentError, ParameterError, RadiokitError, TargetError

RIGHT = """
import numpy as np
import radiokit as rk
G = rk.grading
def both(text): return {"en": text, "ru": text}
def lamps(rng):
    distance = rng.uniform(1, 2, 8)
    return {"intensity": rng.uniform(1, 9, 8), "distance": distance, "theta": rng.uniform(0, 1.5, 8)}
def lamp(intensity, distance, theta):
    return intensity * np.cos(theta) / distance**2
def powers(rng): return {"n": rng.uniform(1, 20)}
def lobe(n): return 2 * np.pi / (n + 1)
def halves(wi, wo, albedo): return albedo / (2 * np.pi) * np.ones(len(wi))
def cosine(directions): return np.maximum(directions[:, 2], 0) / np.pi
def question(signature, judge):
    part = G.Part(name="ordinary", judge=judge)
    return G.Question(signature=signature, points=2, title=both("Q"), text=both("Q"), parts=(part,))
ASSIGNMENT = G.Assignment(
    name="light", title=both("Light"), intro=both("Light"), questions=(
        question("lamp(intensity, distance, theta)", G.Values(inputs=lamps, reference=lamp, rtol=1e-5)),
        question("matt(wi, wo, albedo)", G.Laws(
            parameters=[{"albedo": 0.5}], reference=lambda albedo: rk.bsdf("lambert", reflectance=albedo),
            variants={"halved": halves})),
        question("lobe(n, samples, seed)", G.Estimator(inputs=powers, reference=lobe)),
        question("draw(u)", G.Sampler(density=cosine)),
    ),
)
"""
LAMP = "return intensity * np.cos(theta) / distance**2"
JUDGE = "reference=lamp, rtol=1e-5"
FAULTS = {  # what is replaced, what with, and what must be said of it
    "names": (
        '"theta": rng',
        '"angle": rng',
        "lamp, part ordinary: inputs are named (intensity, distance, angle)",
    ),
    "order": (
        '"lamp(intensity, distance,',
        '"lamp(distance, intensity,',
        "they must be the same, in the same order",
    ),
    "too few": (
        ', "theta": rng.uniform(0, 1.5, 8)',
        "",
        "the parameters of lamp(intensity, distance, theta)",
    ),
    "raises": (LAMP, "return intensty", "NameError: name 'intensty' is not defined (light.py, line 10)"),
    "nan": (LAMP, "return np.sqrt(theta - 0.7)", "reference gives nan at "),
    "complex": (LAMP, "return np.sqrt(theta - 0.7 + 0j)", "reference gives complex numbers"),
    "shorter": (LAMP, "return theta[1:]", "reference gives an array of shape (7,) for 8 inputs"),
    "one number": (LAMP, "return 5.0", "reference gives 5 for 8 inputs"),
    "constant": (JUDGE, "reference=3.0", "reference gives 3 for 8 inputs"),
    "no return": (LAMP, "pass", "reference gives None: it must give real numbers"),
    "random": (LAMP, "return theta + np.random.default_rng().random()", "it must depend on them alone"),
    "too exact": (
        LAMP,
        "return theta + 1e-4 * np.arange(8)",
        "rtol = 1e-05 is not allowed: it must be larger",
    ),
    "unequal": ("rng.uniform(1, 2, 8)", "rng.uniform(1, 2, 7)", "intensity 8, distance 7, theta 8"),
    "no inputs": ("rng.uniform(1, 2, 8)", "rng.uniform(1, 2, 0)", "distance is empty"),
    "texts": ("rng.uniform(1, 2, 8)", '["a"] * 8', "distance = an array of shape (8,) is not allowed"),
    "tuple": ('return {"intensity": rng', 'return 1, {"intensity": rng', "inputs gives a tuple"),
    "no generator": ("def lamps(rng):", "def lamps():", "lamps() takes 0 positional arguments"),
    "variant": (
        JUDGE,
        JUDGE + ', variants={"halved": lambda **_: 1 / 0}',
        "variants['halved'] raised ZeroDivisionError",
    ),
    "context": (JUDGE, JUDGE + ", context=lambda **_: [1]", "context gives [1]: it must give inputs by name"),
    "parameters": ('[{"albedo": 0.5}]', '[{"rho": 0.5}]', "matt, part ordinary: inputs are named (rho)"),
    "no BSDF": (
        'rk.bsdf("lambert", reflectance=albedo)',
        "albedo",
        "reference gives 0.5: it must give a BSDF",
    ),
    "unknown BSDF": (
        '"lambert"',
        '"lamber"',
        "reference raised unknown BSDF 'lamber'; did you mean 'lambert'?",
    ),
    "one direction": ("matt(wi, wo, albedo)", "matt(wo)", "it must be matt(wi, wo)"),
    "zero": ("2 * np.pi / (n + 1)", "0.0", "lobe, part ordinary: reference gives 0 at n = "),
    "infinite": ("2 * np.pi / (n + 1)", "np.inf", "reference gives inf: it must give one finite number"),
    "seed first": ("(n, samples, seed)", "(n, seed, samples)", "it must be lobe(n, samples, seed)"),
    "no seed": ("(n, samples, seed)", "(n)", "it must be lobe(n, samples, seed)"),
    "no density": (
        "directions[:, 2], 0) / np.pi",
        "directions, 0)",
        "density gives an array of shape (4, 3)",
    ),
    "density's name": (
        "density=cosine",
        'density=cosine, pdf="drwa", aspect="density"',
        "did you mean 'draw'?",
    ),
    "density's integral": (
        "directions[:, 2], 0) / np.pi",
        "directions[:, 2], 0) / 3",
        "density gives 1.047 when it is integrated over the hemisphere: it must give 1",
    ),
    "own random numbers": (
        '"theta": rng.uniform(0, 1.5, 8)',
        '"theta": np.random.default_rng().random(8)',
        "inputs gives other numbers for theta from the same generator",
    ),
    "random power": (
        "rng.uniform(1, 20)",
        "np.random.default_rng().random()",
        "inputs gives other numbers for n from the same generator",
    ),
    "u missing": ('"draw(u)"', '"draw(u, n)"', "the parameters of draw(u, n) after u are (n)"),
}
UNLOADABLE = {
    "hint": (
        "points=2",
        'points=2, hints={"cosine-forgoten": both("?")}',
        "did you mean 'cosine-forgotten'?",
    ),
    "unknown hint": (
        "points=2",
        'points=2, hints={"xyz": both("?")}',
        "rk.grading.list_diagnoses() has them",
    ),
    "credit": (JUDGE, JUDGE + ', credit={"pi-to-many": 0.5}', "lamp, part ordinary: credit = 'pi-to-many'"),
    "variant": (
        JUDGE,
        JUDGE + ', variants={"half-the-power": lamp}',
        "a known misconception, or one with a hint",
    ),
    "credit's share": (JUDGE, JUDGE + ', credit={"doubled": "0.5"}', "shares, numbers in [0, 1]"),
    "loose": (JUDGE, JUDGE + ", loose={1e-9: 0.5}", "errors larger than rtol = 1e-05"),
    "rtol": ("rtol=1e-5", 'rtol="1e-5"', "light.py, line 20: rtol = '1e-5' is not allowed"),
    "reference": (JUDGE, 'reference="lamp"', "reference = 'lamp' is not allowed: it must be a function"),
    "points": ("points=2", 'points="2"', "lamp: points = '2' is not allowed"),
    "language": ('text=both("Q")', 'text={"en": "Q"}', "lamp: text = {'en': 'Q'} is not allowed"),
    "another language": ('text=both("Q")', 'text={"de": "Q"}', "or in one of these languages"),
    "hint's language": (
        "points=2",
        'points=2, hints={"doubled": {"en": "?"}}',
        """lamp: hints['doubled'] = {'en': '?'} is not allowed: it must be texts {"en": ..., "ru": ...}""",
    ),
    "question's languages": (
        'title=both("Q"), text=both("Q")',
        'title={"en": "Q"}, text={"en": "Q"}',
        "lamp: title = {'en': 'Q'} is not allowed",
    ),
    "star": ('"lamp(intensity, distance, theta)"', '"lamp(*inputs)"', "without * and **"),
    "one part": ("parts=(part,)", "parts=part", "lamp: parts = 'Part' is not allowed"),
    "judge for part": ("parts=(part,)", "parts=(judge,)", "lamp: parts = ['Values'] is not allowed"),
    "class for judge": ("judge=judge", "judge=G.Values", "such as Values(...)"),
    "part's title": ('name="ordinary"', 'name="first"', "title of part first = {}"),
    "mapping for list": ('[{"albedo": 0.5}]', '{"albedo": 0.5}', 'such as [{"alpha": 0.1}]'),
    "limits": ('name="light"', 'name="light", limits={"seconds": 3}', "it must be rk.grading.Limits(...)"),
    "misspelt argument": (JUDGE, "reference=lamp, rtoll=1e-5", "argument 'rtoll'; did you mean 'rtol'?"),
    "unknown argument": (
        JUDGE,
        "reference=lamp, x=1",
        "'x'; it has atol, context, credit, inputs, loose, ref",
    ),
    "misspelt judge": ("G.Estimator(", "G.Estimater(", "attribute Estimater; did you mean 'Estimator'?"),
    "missing": (
        ', intro=both("Light")',
        "",
        "Assignment(...) missing 1 required keyword-only argument: 'intro'",
    ),
    "syntax": ("questions=(", "questions=((", "SyntaxError: '(' was never closed"),
    "relative": ("import numpy as np", "from . import helpers", "an assignment is one file, without modules"),
    "beside": ("import numpy as np", "import helpers_of_mine", "an assignment is one file, without modules"),
    "data": ("import numpy as np", "DATA = open('data.csv')", "without modules and data beside it"),
    "exit": ("import numpy as np", "raise SystemExit(3)", "light.py, line 2: SystemExit: 3"),
    "misspelt": ("ASSIGNMENT = ", "ASIGNMENT = ", "sets no ASSIGNMENT = rk.grading.Assignment(...)"),
    "function": ("ASSIGNMENT = ", "ASSIGNMENT = lambda: ", "Assignment(...), but a function"),
}


def changed(old, new):
    """Return the assignment's text with a mistake in it."""
    assert old in RIGHT
    return RIGHT.replace(old, new, 1)


def test_without_a_mistake_nothing_is_said():
    rehearse(assignment_from_source(RIGHT, "light.py"))


@pytest.mark.parametrize("name", list_assignments())
def test_what_comes_along_has_no_mistakes(name):
    assert not list(faults(load_assignment(name), student="anna"))


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_found_before_anything_is_graded(name):
    old, new, said = FAULTS[name]
    work = assignment_from_source(changed(old, new), "light.py")
    (found,) = faults(work)
    assert said in str(found)
    assert str(found).startswith("light: question ")
    assert "\n" not in str(found)


@pytest.mark.parametrize("name", UNLOADABLE)
def test_a_mistake_is_found_when_the_file_is_loaded(name):
    old, new, said = UNLOADABLE[name]
    with pytest.raises(TargetError) as caught:
        assignment_from_source(changed(old, new), "light.py")
    assert said in str(caught.value)
    assert str(caught.value).startswith("light.py")
    assert "\n" not in str(caught.value)


def test_one_language_is_enough_and_the_other_is_refused_by_name(tmp_path, capsys):
    text = changed('{"en": text, "ru": text}', '{"en": text}')
    file = tmp_path / "light.py"
    file.write_text(text, encoding="utf-8")
    work = load_assignment(file)
    assert work.languages == ("en",)
    wanted = "language = 'ru' is not allowed: it must be 'en': the assignment has no texts in another"
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "anna.py").write_text("")
    commands = (
        ["assignment", str(file), "--language", "ru"],
        ["assignment", str(file), "--language", "ru", "--to", str(tmp_path / "handouts")],
        ["assignment", str(file), "--language", "ru", "--gradescope", str(tmp_path / "zip.zip")],
        ["assignment", str(file), "--language", "ru", "--github", str(tmp_path / "x.yml")],
        ["grade", str(tmp_path / "class" / "anna.py"), "--assignment", str(file), "--language", "ru"],
        ["grade-class", str(tmp_path / "class"), "--assignment", str(file), "--language", "ru", "--out=out"],
    )
    for words in commands:
        with pytest.raises(SystemExit) as caught:
            main(words)
        assert caught.value.code == 2
        assert wanted in capsys.readouterr().err
    with pytest.raises(ParameterError, match="no texts in another"):
        rk.grading.practice(work, language="ru")
    with pytest.raises(ParameterError, match="no texts in another"):
        rk.grading.grade(work, tmp_path / "class" / "anna.py", language="ru")
    assert rk.grading.check_assignment(work, students=1).ok


def test_what_an_assignment_prints_is_not_shown(capsys):
    text = changed(LAMP, "print('debugging'); " + LAMP)
    rehearse(assignment_from_source(text, "light.py"))
    assert capsys.readouterr().out == ""


def test_defaults_and_annotations_may_stand_in_a_signature():
    text = changed(
        '"lamp(intensity, distance, theta)"', '"lamp(intensity: float, distance, theta, scale=1.0) -> float"'
    )
    rehearse(assignment_from_source(text, "light.py"))


def test_hints_may_speak_of_variants_and_of_two_misconceptions_at_once():
    words = {"halved + cosine-forgotten": "both('?')", "own": "both('?')"}
    hints = "{" + ", ".join(f"{key!r}: {value}" for key, value in words.items()) + "}"
    text = changed("points=2", f"points=2, hints={hints}").replace(JUDGE, JUDGE + ', variants={"own": lamp}')
    assert assignment_from_source(text, "light.py").points == 8


def test_a_judge_of_ones_own_says_what_it_finds_and_may_be_rehearsed():
    class Mine:
        diagnoses = ("my-own",)

        def judge(self, callee, rng, **_):
            return rk.grading.Finding(share=1.0, text="fine")

        def rehearse(self, question, rng):
            raise LookupError(question.name)

    both = {"en": "?", "ru": "?"}
    part = rk.grading.Part(name="ordinary", judge=Mine())
    asked = rk.grading.Question(
        signature="f(x)", points=1, title=both, text=both, parts=(part,), hints={"my-own": both}
    )
    work = rk.grading.Assignment(name="mine", title=both, intro=both, questions=(asked,))
    assert [str(found) for found in faults(work)] == [
        "mine: question f, part ordinary: rehearse raised LookupError: f"
    ]
    with pytest.raises(ParameterError, match=r"f: hints = 'my-owns' is not allowed.*did you mean 'my-own'"):
        replace(work, questions=(replace(asked, hints={"my-owns": both}),))


@pytest.mark.parametrize(
    "arguments",
    [
        ("assignment", "light.py"),
        ("assignment", "light.py", "--to", "copies"),
        ("assignment", "light.py", "--gradescope", "auto.zip"),
        ("assignment", "light.py", "--github", "classroom.yml"),
        ("grade", "work.py", "--assignment", "light.py"),
        ("grade-class", "class", "--assignment", "light.py", "--out", "out"),
    ],
    ids=lambda words: " ".join(words),
)
def test_every_command_names_a_fault_before_it_does_anything(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    old, new, said = FAULTS["shorter"]
    (tmp_path / "light.py").write_text(changed(old, new))
    (tmp_path / "class").mkdir()
    for path in ("work.py", "class/anna.py"):
        (tmp_path / path).write_text("def lamp(intensity, distance, theta): return theta")
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    told = capsys.readouterr()
    assert (ended.value.code, told.out) == (2, "")
    assert said in told.err
    assert told.err.count("\n") == 1
    assert {path.name for path in tmp_path.iterdir()} == {"light.py", "class", "work.py"}


def test_a_fault_that_shows_while_grading_costs_nobody_points_unseen(tmp_path, capsys):
    some = "return theta if rng_of_today else theta[1:]"
    text = changed(LAMP, some).replace("import numpy as np", "import numpy as np\nrng_of_today = []")
    work = assignment_from_source(text, "light.py")
    (tmp_path / "work.py").write_text("def lamp(intensity, distance, theta): return theta")
    given = rk.grading.grade(work, tmp_path / "work.py", questions=["lamp"])
    (question,) = given.questions
    assert question.review.startswith(
        "the assignment is at fault, part ordinary: reference gives an array of"
    )
    assert (
        question.parts[0].text
        == "the question itself is at fault, not your answer; a teacher will look at it"
    )
    assert "array" not in rk.grading.to_text(given)
    assert "array of shape (7,)" in rk.grading.to_text(given, reveal=True)
    assert Grade.from_json(given.to_json()) == given


def test_practice_says_that_the_question_is_at_fault(capsys):
    work = assignment_from_source(changed(LAMP, "return theta[1:]"), "light.py")

    def lamp(intensity, distance, theta):
        return theta

    rk.grading.practice(work)(lamp)
    assert "the question itself is at fault, not your answer" in capsys.readouterr().out


def test_a_reference_that_refuses_wrong_arguments_breaks_no_diagnosis(tmp_path):
    guarded = "assert np.all(distance < 2.1) and np.all(theta < 1.6)\n    " + LAMP
    work = assignment_from_source(changed(LAMP, guarded), "light.py")
    (tmp_path / "work.py").write_text(f"import numpy as np\ndef lamp(intensity, distance, theta): {LAMP} * 2")
    found = rk.grading.grade(work, tmp_path / "work.py", questions=["lamp"])["lamp"]
    assert (found.diagnosis, found.review) == ("doubled", "")


def test_inputs_that_are_infinite_break_no_diagnosis(tmp_path):
    text = changed(LAMP, LAMP.replace("distance**2", "np.minimum(distance, 9)**2"))
    text = text.replace("    return {", "    distance[0] = np.inf\n    return {", 1)
    (tmp_path / "work.py").write_text("def lamp(intensity, distance, theta): return intensity")
    found = rk.grading.grade(
        assignment_from_source(text, "light.py"), tmp_path / "work.py", questions=["lamp"]
    )
    assert (found["lamp"].score, found["lamp"].review) == (0, "")


def test_what_is_printed_while_an_assignment_loads_is_not_among_the_grades(capsys):
    assignment_from_source(changed("G = rk.grading", "G = rk.grading; print('loading')"), "light.py")
    assert capsys.readouterr().out == ""


def test_an_assignments_object_is_rehearsed_as_its_file_is():
    with pytest.raises(AssignmentError, match="inputs are named"):
        rehearsed(assignment_from_source(changed(*FAULTS["names"][:2]), "light.py"))
    assert isinstance(rehearsed("radiometry"), rk.grading.Assignment)


def test_a_mistake_is_an_error_of_radiokit():
    assert issubclass(AssignmentError, RadiokitError)
    assert not issubclass(AssignmentError, TargetError)  # which are a submission's, where it is graded
    assert np.isfinite(rehearsed("shading").points)
