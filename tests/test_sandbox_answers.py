"""What goes into a sandbox's functions and comes out: kinds, numbers, sizes, seeds, shared time."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import numpy as np
import pytest
import sympy

from radiokit.faces.grading.isolation import handed, process
from radiokit.faces.grading.isolation.answers import RefusedError, Taker
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.isolation.result import steady
from radiokit.faces.grading.isolation.sandbox import Sandbox
from radiokit.facts.errors import ParameterError, RadiokitError

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the sandbox needs a POSIX system")

SUBMISSION = """
import random, time
import numpy as np
from decimal import Decimal
from fractions import Fraction
calls = 0

def kinds(*given):
    global text
    text = " ".join(f"{type(x).__name__}:{getattr(x, 'dtype', '')}{getattr(x, 'shape', '')}" for x in given)
    print(text)
    return 0
def same(x): return x
def two(x, y): return x + y, [x, y]
def split(x, y): return x + y, x
def three(x): return x, x, x
def ragged(x): return [[1, 2], [3]]
def uneven(x): return [1.0] * int(x)
def pair(x): return np.ones(3), np.ones((2, 2))
def dice(x): return [random.random(), np.random.rand()]
def sleeps(x): time.sleep(x); return x
def dies(x):
    import os; os._exit(1)
def memory(x): return np.broadcast_to(1.0, 10**9)
def described(x): raise ValueError(f"{object()} {kinds} {id} {set('abcdefgh')} {hash('a')}")
def raises_third(x):
    if x > 2: raise ValueError
    return x
"""


class Floats:
    def __float__(self):
        return 0.5


class Symbolic(Floats):
    def __float__(self):
        raise TypeError("Cannot convert expression to float")


class Series:
    shape = (2,)

    def __array__(self, dtype=None, copy=None):
        return np.array([1.0, 2.0])


@pytest.fixture(scope="module")
def theirs(tmp_path_factory):
    path = tmp_path_factory.mktemp("answers") / "theirs.py"
    path.write_text(SUBMISSION)
    with Sandbox(path, limits=Limits(answer_bytes=1 << 20)) as sandbox:
        yield sandbox


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        ("batch", "int: float: bool: complex: ndarray:float64(2,) ndarray:int64(2,) ndarray:bool(2, 1)"),
        ("single", "int: float: bool: complex: ndarray:float64(1,) ndarray:int64(1,) ndarray:bool(1, 1)"),
        ("row", "int: float: bool: complex: float64:float64() int64:int64() ndarray:bool(1,)"),
        ("scalar", "int: float: bool: complex: float: int: ndarray:bool(1,)"),
    ],
)
def test_arguments_arrive_as_they_are_meant(theirs, mode, expected):
    given = (3, 0.5, True, 1j, np.array([1.0, 2.0]), np.array([1, 2], "i4"), np.array([[True], [False]]))
    printed = theirs.call("kinds", *given, mode=mode).output.splitlines()
    assert set(printed) == {expected}
    assert len(printed) == (1 if mode == "batch" else 2)


def test_arguments_are_checked(theirs):
    for options in ({"outputs": 0}, {"outputs": 9}, {"seed": -1}, {"seed": 1.0}):
        with pytest.raises(ParameterError, match=next(iter(options))):
            theirs.call("same", 1.0, **options)
    with pytest.raises(ParameterError, match="equally many rows"):
        theirs.call("two", np.ones(2), np.ones(3), mode="row")
    for wrong in (np.array([object()]), "text", np.array([2**64 - 1], "u8")):
        with pytest.raises(ParameterError, match="at most 64 bits"):
            theirs.call("same", wrong)


def test_outputs_are_counted(theirs):
    x, y = np.array([1.0, 2.0, 3.0]), np.array([5.0, 6.0, 7.0])
    total, listed = theirs.call("two", x, y, outputs=2).values
    np.testing.assert_array_equal(total, x + y)
    np.testing.assert_array_equal(listed, [x, y])
    total, listed = theirs.call("two", x, y, outputs=2, mode="row").values
    np.testing.assert_array_equal(total, x + y)
    np.testing.assert_array_equal(listed, np.stack([x, y], axis=1))
    total, first = theirs.call("split", x, y, outputs=2, mode="single").values
    np.testing.assert_array_equal([total, first], [x + y, x])
    assert theirs.call("three", x, outputs=2).error == "returned 3 values where 2 are wanted"
    wanted = "returned one value where 2 are wanted, as in return a, b"
    assert theirs.call("same", x, outputs=2).error == wanted
    assert [value.shape for value in theirs.call("pair", x).values] == [(3,), (2, 2)]
    assert theirs.call("uneven", x, mode="row").error == "returned shape (1,) for row 0 and (2,) for row 1"
    assert theirs.call("ragged", x).error == "returned a list whose parts have different lengths"
    assert [each.shape for each in theirs.call("two", x[:0], y[:0], outputs=2, mode="row").values] == [
        (0,)
    ] * 2
    assert theirs.call("same", 3.0, mode="row").values[0] == 3
    assert theirs.call("raises_third", x, mode="scalar").row == 2


def test_seeds_repeat_what_is_random(theirs):
    first, again, other = (theirs.call("dice", 1.0, seed=seed).values[0] for seed in (5, 5, 2**40))
    np.testing.assert_array_equal(first, again)
    assert not np.any(first == other)
    assert np.all(theirs.call("dice", 1.0).values[0] != theirs.call("dice", 1.0).values[0])


def test_random_numbers_of_loading_repeat(tmp_path):
    path = tmp_path / "caf\udce9.py"  # a name that is no text
    path.write_text("import random, numpy as np\nx = random.random(), np.random.rand()\ndef f(): return x")
    found = []
    for _ in range(2):
        with Sandbox(path) as sandbox:
            found.append(sandbox.call("f").values[0])
    np.testing.assert_array_equal(*found)


def test_calls_share_a_time(theirs):
    with theirs.within(2.0):
        first = theirs.call("sleeps", 0.5)
        assert first.ok
        late = theirs.call("sleeps", 60.0)
        assert late.error == "took longer than 2 s in all"
        assert late.seconds <= 2 - first.seconds + process.TURN
        late = theirs.call("same", 1.0)
        assert (late.error, late.seconds) == ("took longer than 2 s in all", 0)
        with theirs.within(60.0):
            assert theirs.call("same", 1.0).error == "took longer than 2 s in all"
    with theirs.within(60.0):
        assert theirs.call("sleeps", 60.0, timeout=0.1).error == "took longer than 0.1 s"
        assert theirs.call("sleeps", 0.1).ok
    with theirs.within(1.0):
        results = [theirs.call("dies", 1.0)]
        while results[-1].error == "ended its process with exit code 1":
            results.append(theirs.call("dies", 1.0))
    assert len(results) > 1
    assert results[-1].error == "took longer than 1 s in all"
    with pytest.raises(ParameterError, match="seconds = 0"), theirs.within(0):
        pass


def test_time_in_which_the_whole_machine_stands_still_is_not_counted(theirs, monkeypatch):
    hours = iter(range(0, 10**9, 3600))
    monkeypatch.setattr(process, "time", SimpleNamespace(monotonic=lambda: next(hours)))
    found = theirs.call("same", 1.0, timeout=10.0)
    assert found.ok
    assert found.seconds < 10
    assert theirs.call("sleeps", 60.0, timeout=0.3).error == "took longer than 0.3 s"


def test_nothing_differs_from_run_to_run(theirs, tmp_path):
    path = tmp_path / "theirs.py"
    path.write_text(SUBMISSION)
    with Sandbox(path) as sandbox:
        assert sandbox.call("described", 1.0).error == theirs.call("described", 1.0).error
    assert "<object object at 0x…> <function kinds at 0x…>" in theirs.call("described", 1.0).error


def test_words_are_steady():
    folder = "/tmp/radiokit-ab12"
    assert steady("getpwuid(): uid not found: 61234") == "getpwuid(): uid not found: …"
    text = f"pid=17, uid: 61234 [pid 8] {folder}/home/tmpab12cd_8/x 0x1F 0x7ffff7a01234 rapid 3 pid"
    assert steady(text, folder) == "pid=…, uid: … [pid …] /home/tmp…/x 0x1F 0x… rapid 3 pid"


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (float("nan"), np.nan),
        ([np.inf, 1], [np.inf, 1.0]),
        (np.ma.array([1, 2], mask=[0, 1]), [1.0, np.nan]),
        (np.ma.array([1, 2]), [1, 2]),
        (np.array([[1.0, 2.0]]).view(np.matrix), [[1.0, 2.0]]),
        ([2**70, 1], [2.0**70, 1.0]),
        (np.array([2**64 - 1], "u8"), [2.0**64]),
        (np.float16(0.5), np.float32(0.5)),
        (np.longdouble(0.5), 0.5),
        ([Floats(), 1], [0.5, 1.0]),
        (np.arange(3, dtype=">i4"), [0, 1, 2]),
        (np.broadcast_to(2.0, (3, 2)), np.full((3, 2), 2.0)),
        (np.zeros((0, 3)), np.zeros((0, 3))),
        ([], []),
        (True, True),
        (range(3), [0, 1, 2]),
        ((1, 2), [1, 2]),
    ],
)
def test_numbers_of_every_kind_are_taken(value, expected):
    (found,) = Taker(1 << 20).outputs(value, 1)
    np.testing.assert_array_equal(found, expected)
    assert found.dtype.str in ("<f8", "<f4", "<i8", "|b1", "<c16")


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (None, "returned None: is a return statement missing"),
        ([1.0, None], "returned list that is no array of numbers"),
        (np.broadcast_to(1.0, 10**9), r"returned an array of shape \(1000000000,\), 8 GB: too much"),
        (np.broadcast_to(np.float16(1), 400_000), r"shape \(400000,\), 1.6 MB: too much"),
        ([1] * 200_000, r"returned an array of shape \(200000,\), 1.6 MB: too much"),
        ((np.zeros(80_000), np.zeros(60_000)), "returned 1.12 MB of numbers in all: too much"),
        (np.zeros((1, 1, 1, 1, 2)), r"returned an array of 5 dimensions, shape \(1, 1, 1, 1, 2\)"),
        (np.zeros(2, [("a", "f8")]), r"returned ndarray of \[\('a', '<f8'\)\] that is no array of numbers"),
        (np.zeros(2, "M8[s]"), r"returned ndarray of datetime64\[s\] that is no array of numbers"),
        (10**400, "returned a number that is too large for a float"),
        (Symbolic(), "returned Symbolic that is no number"),
        ("0.5", "returned str that is no array of numbers"),
        ([0.5, "a"], "returned list that is no array of numbers"),
        (np.array([0.5, "a"], dtype=object), "returned ndarray that is no array of numbers"),
        ({1.0}, "returned set that is no array of numbers"),
        ({"a": 1.0}, "returned dict that is no array of numbers"),
        ((x for x in "ab"), "returned generator that is no array of numbers"),
        (len, "returned builtin_function_or_method that is no array of numbers"),
        (((1, 2), (3,), "a"), "returned str that is no array of numbers"),
    ],
)
def test_what_is_no_number_is_refused_in_a_sentence(value, message):
    with pytest.raises(RefusedError, match=message):
        Taker(1 << 20).outputs(value, 1)


def test_numbers_of_other_packages_are_taken():
    for value, expected in [
        (sympy.Rational(1, 3), 1 / 3),
        ([sympy.pi, 1], [np.pi, 1.0]),
        (sympy.Matrix([1, 2]), [[1.0], [2.0]]),
        (Series(), [1.0, 2.0]),
    ]:
        np.testing.assert_array_equal(Taker(1 << 20).outputs(value, 1)[0], expected)
    for value in (sympy.Symbol("x"), sympy.I):
        with pytest.raises(RefusedError, match="is no number"):
            Taker(1 << 20).outputs(value, 1)


def test_a_large_answer_is_never_made(theirs):
    assert theirs.call("memory", 1.0).error == "returned an array of shape (1000000000,), 8 GB: too much"


def test_what_is_too_large_is_not_handed_over(tmp_path, monkeypatch):
    file = tmp_path / "theirs.py"
    file.write_text("x = 1")
    assert handed.handed(file, None, []) == {"theirs.py": str(file.resolve())}
    monkeypatch.setattr(handed, "LARGEST", 4)
    for content in (None, b"x = 1"):
        with pytest.raises(RadiokitError, match=r"theirs\.py has more than 4 bytes"):
            Sandbox(file, content=content)
    with pytest.raises(RadiokitError, match=r"no such file: .*absent"):
        Sandbox("theirs.py", content=b"", files=[tmp_path / "absent"])
