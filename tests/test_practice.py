"""A student's own check: what is right, what is wrong and why, on numbers that are not graded."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading.assignment import load_assignment, student_rng
from radiokit.faces.grading.handout.here import Here
from radiokit.faces.grading.handout.practice import SECRET

HOMEWORK_FILE = Path(__file__).with_name("homework.py")
HOMEWORK = load_assignment(HOMEWORK_FILE)


@pytest.fixture
def check():
    return rk.grading.practice(HOMEWORK)


def test_a_right_function_is_right_and_the_hidden_part_comes_later(check, capsys):
    def cone(half_angle):
        return 2 * np.pi * (1 - np.cos(half_angle))

    check(cone)
    assert (
        capsys.readouterr().out
        == "cone\n  ✓ ordinary inputs: right\n  · judged after handing in: hard inputs\n"
    )
    assert rk.grading.practice(HOMEWORK, language="ru").judged(cone).lines[0] == (
        True,
        "обычные входы: верно",
    )


def test_a_wrong_function_is_diagnosed(check):
    def irradiance(intensity, distance, theta):
        return intensity / distance**2

    found = check.judged(irradiance)
    assert found.right is False
    assert found.findings["ordinary"].diagnosis == "cosine-forgotten"
    assert "cosine" in str(found)
    assert " right is " in str(found)


def blank(half_angle):
    """Nothing."""
    ...


def passes(half_angle):
    pass


def returns_none(half_angle):
    return None


@pytest.mark.parametrize("function", [blank, passes, returns_none])
def test_a_blank_is_not_written_yet(function, check):
    function.__name__ = "cone"
    found = check.judged(function)
    assert str(found) == "cone\n  · not written yet"
    assert found.right is None


def test_a_function_that_forgets_to_return_is_told_so(check):
    def cone(half_angle):
        value = 2 * np.pi * (1 - np.cos(half_angle))  # noqa: F841

    assert "returned None: is a return statement missing?" in str(check.judged(cone))


def test_a_wrong_name_is_told_the_right_one(check):
    def con(half_angle):
        return half_angle

    assert str(check.judged(con)).endswith("no question asks for a function con; is it cone?")
    assert str(check.judged(np.cos)).endswith("; asked for: irradiance, cone")
    assert "'cone' is no function" in str(check.judged("cone"))
    assert "3.0 is no function" in str(check.judged(3.0))


def test_what_it_raises_is_placed_at_the_students_line(check):
    def helper(x):
        raise ValueError("no such angle")

    def cone(half_angle):
        return helper(half_angle)

    line = helper.__code__.co_firstlineno + 1
    (text,) = [words for mark, words in check.judged(cone).lines if mark is False]
    assert text.endswith(
        f'cone raised ValueError: no such angle (line {line}: raise ValueError("no such angle"))'
    )


def test_what_it_prints_is_shown_once_and_its_warnings_are_not(check, capsys):
    def cone(half_angle):
        print("angle is", half_angle.shape)  # noqa: T201
        return 2 * np.pi * (1 - np.cos(half_angle)) + 0 * np.log(half_angle * 0)

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(cone)
    shown = capsys.readouterr()
    assert shown.out.count("angle is") == 1
    assert shown.err == ""


def test_all_are_found_where_it_is_called(check, capsys):
    space = {"check": check}
    exec("def cone(half_angle): ...\ncheck.all()", space)
    assert capsys.readouterr().out == "irradiance\n  · not defined here\ncone\n  · not written yet\n"


def test_the_inputs_are_no_graded_ones(check):
    seen = []

    def cone(half_angle):
        seen.append(half_angle)
        return half_angle

    check.judged(cone)
    question = HOMEWORK.question("cone")
    part = question.parts[0]
    graded = part.judge.inputs(student_rng(HOMEWORK, question, part))["half_angle"]
    mine = part.judge.inputs(student_rng(HOMEWORK, question, part, secret=SECRET))["half_angle"]
    assert np.array_equal(seen[0], mine)
    assert not np.isclose(seen[0], graded).any()
    seen.clear()
    rk.grading.practice(HOMEWORK, student="ann").judged(cone)
    assert not np.isclose(seen[0], mine).any()


def test_a_judge_that_fails_stops_nothing():
    class Broken:
        def judge(self, callee, rng, **more):
            raise RuntimeError("broken")

    words = {"en": "f", "ru": "f"}
    parts = (rk.grading.Part(name="ordinary", judge=Broken()),)
    question = rk.grading.Question(signature="f(x)", points=1, title=words, text=words, parts=parts)
    work = rk.grading.Assignment(name="a", title=words, intro=words, questions=(question,))

    def f(x):
        return x

    assert "could not be judged (RuntimeError: broken)" in str(rk.grading.practice(work).judged(f))


def test_the_html_shows_a_students_words_as_text(check):
    def cone(half_angle):
        print("<script>")  # noqa: T201
        return half_angle

    text = check.judged(cone)._repr_html_()
    assert "<script>" not in text
    assert "&lt;script&gt;" in text
    assert re.sub(r"<[^>]+>", "", text).startswith("cone✗ ordinary inputs")


def test_no_words_in_another_language():
    with pytest.raises(rk.errors.ParameterError, match="'en' or 'ru'"):
        rk.grading.practice(HOMEWORK, language="de")


THEIRS = """
import numpy as np
from fractions import Fraction

def arrays(a, b): return a + b
def numbers(a, b): return a + b if a > 0 else b
def pairs(a, b): return a, b
def listed(a, b): return list(a)
def words(a, b): return "one"
def ragged(a, b): return [[1.0], [1.0, 2.0]]
def nothing(a, b): pass
def fails(a, b): return a / Fraction(0)
def leaves(a, b): raise SystemExit(3)
def draws(a, b): return np.random.random(3)
def spoils(a, b):
    a[:] = 0
    return b
"""


def test_a_function_here_answers_as_it_does_in_the_sandbox(tmp_path, seed):
    file = tmp_path / "theirs.py"
    file.write_text(THEIRS)
    space = {}
    exec(compile(THEIRS, str(file), "exec"), space)
    a, b = np.array([1.0, 2.0, 3.0]), np.array([0.5, 0.25, 0.125])
    given = a.copy()
    names = [name for name, value in space.items() if callable(value) and name not in ("np", "Fraction")]
    assert len(names) == 11
    with rk.grading.Sandbox(file) as sandbox:
        sandbox.load()
        for name in [*names, "absent"]:
            callee = Here(space.get(name), name, space)
            for mode in ("batch", "single", "row", "scalar"):
                for outputs in (1, 2):
                    here = callee.call(a, b, mode=mode, outputs=outputs, seed=seed)
                    there = sandbox.call(name, a, b, mode=mode, outputs=outputs, seed=seed)
                    what = (name, mode, outputs)
                    assert (here.error, here.raised, here.where) == (
                        there.error,
                        there.raised,
                        there.where,
                    ), what
                    assert len(here.values) == len(there.values), what
                    for mine, its in zip(here.values, there.values, strict=True):
                        assert mine.dtype == its.dtype, what
                        assert np.array_equal(mine, its), what
    assert np.array_equal(a, given)


def test_the_callers_random_numbers_are_not_touched(seed):
    before = np.random.get_state()[1].copy()  # noqa: NPY002
    Here(lambda x: np.random.random(3), "f").call(np.ones(3), seed=seed)  # noqa: NPY002
    assert np.array_equal(np.random.get_state()[1], before)  # noqa: NPY002


def test_a_function_here_is_a_bsdf_with_its_parameters():
    def lobe(wi, wo, albedo=1.0):
        return np.full(len(wi), albedo / np.pi)

    up = (0.0, 0.0, 1.0)
    assert np.isclose(Here(lobe, "lobe").bsdf()(up, up), 1 / np.pi)
    assert np.isclose(Here(lobe, "lobe").bsdf({"albedo": 0.5})(up, up), 0.5 / np.pi)
    beside = Here(None, "f", {"lobe": lobe, "number": 3}).other
    assert beside("lobe").function is lobe
    assert "defines no function 'number'" in beside("number").call(np.ones(1)).error


def test_a_script_shows_text_and_loads_no_notebook(tmp_path):
    file = tmp_path / "theirs.py"
    file.write_text(
        "import sys\nimport radiokit as rk\n"
        f"check = rk.grading.practice({str(HOMEWORK_FILE)!r})\n"
        "def cone(half_angle): ...\n"
        "check(cone)\n"
        "assert 'IPython' not in sys.modules and 'scipy' not in sys.modules\n"
    )
    done = subprocess.run([sys.executable, file], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "cone\n  · not written yet\n", "")


def test_an_endless_function_is_stopped_and_told_where():
    def cone(half_angle):
        while True:
            half_angle = half_angle + 1

    hasty = replace(HOMEWORK, questions=(replace(HOMEWORK.question("cone"), seconds=0.2),))
    (line, *_) = rk.grading.practice(hasty).judged(cone).lines
    assert line[0] is False
    assert line[1].startswith("ordinary inputs: cone took longer than 0.2 s in all (line ")
    assert "half_angle" in line[1] or "while True" in line[1]
    russian = rk.grading.practice(hasty, language="ru").judged(cone)
    assert "cone: выполнялась дольше 0.2 с в сумме" in str(russian)
    assert signal.getitimer(signal.ITIMER_REAL)[0] == 0
    assert signal.getsignal(signal.SIGALRM) == signal.SIG_DFL


def test_another_timer_is_left_alone():
    def twice(x):
        return 2 * x

    signal.setitimer(signal.ITIMER_REAL, 60)
    try:
        found = Here(twice, "twice", seconds=1e-6).call(np.ones(3))
        assert found.ok
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 50
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def test_an_interrupt_is_the_student_s_own(check):
    def cone(half_angle):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        check.judged(cone)
    assert signal.getitimer(signal.ITIMER_REAL)[0] == 0
