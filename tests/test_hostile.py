"""Hostile submissions: none gains a point, sees an answer, outlives its grading, or harms the other question.

Every attack is bounded by itself, so that a failing defence cannot take the machine along.
"""

from __future__ import annotations

import contextlib
import dataclasses
import os
import re
import signal
import socket
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

import radiokit as rk
from radiokit.faces.grading.isolation.sandbox import Sandbox

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="these attacks are written for Linux")

G = rk.grading
BOTH = {"en": "A question", "ru": "Вопрос"}
ANSWER = 271828.1828
"""What the reference multiplies with; nobody can guess it."""

SLOW = r"took longer than .* s"
WRONG = r"Wrong at 8 of 8 inputs|The answer is \S+ for all inputs"


def attacks():
    """Return the prelude, and each attack's code and what is said of it, by its name."""
    text = (Path(__file__).parent / "attacks.txt").read_text(encoding="utf-8")
    found = {}
    for section in text.split("\n=== ")[1:]:
        head, code = section.split("\n", 1)
        name, said = head.split(" | ") if " | " in head else (head.removesuffix(" |"), "")
        found[name] = (code, said.replace("SLOW", SLOW).replace("WRONG", WRONG))
    return found.pop("prelude")[0], found


PRELUDE, ATTACKS = attacks()
UNREADABLE = {
    "bytes that are no text": b"\xff\xfe\x00\x00",
    "null bytes": b"def honest(x):\0 return x",
    "deep nesting": b"x = " + b"(" * 5000 + b")" * 5000,
    "nothing": b"",
}


def the_reference(x):
    return ANSWER * np.asarray(x)


def the_honest_reference(x):
    return 2.0 * np.asarray(x)


def numbers(rng):
    return {"x": rng.uniform(1, 2, 8)}


def question(name, reference, seconds):
    judge = G.Values(inputs=numbers, reference=reference)
    return G.Question(
        signature=f"{name}(x)",
        points=1,
        title=BOTH,
        text=BOTH,
        seconds=seconds,
        parts=(G.Part(name="hard", judge=judge, visibility="hidden"),),
    )


def assignment(seconds):
    limits = G.Limits(
        seconds=5, memory_bytes=1 << 30, file_bytes=2 << 20, disk_bytes=1 << 23, printed_bytes=1 << 18
    )
    return G.Assignment(
        name="hostile",
        title=BOTH,
        intro=BOTH,
        limits=limits,
        questions=(question("attack", the_reference, seconds), question("honest", the_honest_reference, 5)),
    )


@pytest.fixture
def mark(seed):
    return f"rk-{seed % 10**4}-{os.getpid()}"  # 15 characters at most; another run has others


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setenv("RADIOKIT_SECRET", str(ANSWER))
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(0)
        yield server


def running(mark):
    """Whether a process of this name runs anywhere on this machine."""
    for comm in Path("/proc").glob("[0-9]*/comm"):
        with contextlib.suppress(OSError):
            if comm.read_text().strip() == mark:
                return True
    return False


@pytest.fixture
def boxes(monkeypatch):
    """Where the sandboxes of this test write, and must leave nothing."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        monkeypatch.setattr(tempfile, "tempdir", folder)
        yield Path(folder)


def handed_in(folder, server, mark, code):
    secret = folder / "secret" / "answer.txt"
    secret.parent.mkdir(mode=0o700)
    secret.write_text(str(ANSWER))
    names = {
        "PORT": server.getsockname()[1],
        "PARENT": os.getpid(),
        "SECRET_FILE": str(secret),
        "MARK": mark,
    }
    lines = "".join(f"{name} = {value!r}\n" for name, value in names.items())
    path = folder / "submission.py"
    path.write_text(f"{lines}{PRELUDE}\n{code}", encoding="utf-8")
    return path


@pytest.fixture
def signals():
    """The signals that reach this process, which must be none."""
    came = []
    before = signal.signal(signal.SIGURG, lambda number, frame: came.append(number))
    yield came
    signal.signal(signal.SIGURG, before)


def check_nothing_is_left(server, mark, boxes):
    deadline = time.monotonic() + 60
    while running(mark) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not running(mark)
    with pytest.raises(BlockingIOError):
        server.accept()
    assert not list(boxes.iterdir())


def check_line(line):
    assert line.isprintable()
    assert 0 < len(line) < 500
    assert str(ANSWER)[:8] not in line


@pytest.mark.parametrize("attack", [name for name in ATTACKS if not name.startswith("load: ")])
def test_an_attack_costs_its_question_alone(attack, tmp_path, server, mark, signals, boxes):
    code, expected = ATTACKS[attack]
    seconds = 0.7 if expected.startswith(SLOW) else 5
    found = G.grade(assignment(seconds), handed_in(tmp_path, server, mark, code))
    assert found.complete
    assert found["attack"].score == 0
    assert re.search(expected, found["attack"].explanation), found["attack"].explanation
    check_line(found["attack"].explanation)
    assert found["honest"].score == found["honest"].points == 1, found["honest"].explanation
    assert not any(each.review for each in found.questions)
    assert not signals
    check_nothing_is_left(server, mark, boxes)


@pytest.mark.parametrize("attack", [name for name in ATTACKS if name.startswith("load: ")])
def test_an_attack_while_it_is_loaded_costs_the_submission_at_most(attack, tmp_path, server, mark, boxes):
    code, expected = ATTACKS[attack]
    work = dataclasses.replace(assignment(5), limits=G.Limits(load_seconds=2, printed_bytes=1 << 18))
    found = G.grade(work, handed_in(tmp_path, server, mark, code))
    assert found.complete
    assert found["attack"].score == 0
    assert re.search(expected, found["attack"].explanation), found["attack"].explanation
    for each in found.questions:
        check_line(each.explanation)
    check_nothing_is_left(server, mark, boxes)


@pytest.mark.parametrize("content", UNREADABLE)
def test_a_file_that_is_no_program_gets_a_line(content, tmp_path):
    path = tmp_path / "submission.py"
    path.write_bytes(UNREADABLE[content])
    found = G.grade(assignment(5), path)
    assert found.complete
    assert found.score == 0
    check_line(found["honest"].explanation)


def test_the_attacks_are_many():
    assert len(ATTACKS) >= 60


def test_a_channel_that_no_longer_waits_is_mended_for_the_next_part(tmp_path):
    """Copies share their pipes' flags with the process that they are copies of."""
    file = tmp_path / "theirs.py"
    file.write_text(
        "import os\n"
        "def attack(x):\n"
        "    for descriptor in range(3, 64):\n"
        "        try: os.set_blocking(descriptor, False)\n"
        "        except OSError: pass\n"
        "    return x\n"
        "def honest(x): return x\n"
    )
    with Sandbox(file) as sandbox:
        for name in ("attack", "honest"):
            with sandbox.apart():
                assert sandbox.call(name, np.arange(3.0)).ok
                time.sleep(0.1)  # the child is waiting
                assert sandbox.call(name, np.arange(3.0)).ok
            time.sleep(0.1)
        large = sandbox.call("attack", np.arange(1e6))
        assert large.ok, large.error


def test_a_pipe_whose_other_end_is_open_to_others_is_waited_for(tmp_path, monkeypatch):
    """A submission that runs as the grader's own user may read what it writes, and write what it reads."""
    calls, missed = {name: getattr(os, name) for name in ("read", "write")}, []

    def late(name):
        def call(*arguments):
            if missed.count(name) < 2:
                missed.append(name)
                raise BlockingIOError
            return calls[name](*arguments)

        return call

    with Sandbox("theirs.py", content=b"def honest(x): return 2 * x") as sandbox:
        assert sandbox.load().ok
        for name in calls:
            monkeypatch.setattr(os, name, late(name))
        assert sandbox.call("honest", 1.0).values == (2.0,)
    assert sorted(missed) == ["read", "read", "write", "write"]


def test_a_question_of_two_parts_has_its_time_once(tmp_path, monkeypatch):
    spent = []
    call = G.Sandbox.call

    def spy(*arguments, **options):
        result = call(*arguments, **options)
        spent.append(result.seconds)
        return result

    monkeypatch.setattr(G.Sandbox, "call", spy)
    path = tmp_path / "submission.py"
    path.write_text("def attack(x):\n    while True: pass\ndef honest(x): return 2 * x\n", encoding="utf-8")
    (first, other) = assignment(1).questions
    parts = (*first.parts, dataclasses.replace(first.parts[0], name="ordinary"))
    work = dataclasses.replace(assignment(1), questions=(dataclasses.replace(first, parts=parts), other))
    found = G.grade(work, path)
    assert [re.search(SLOW, part.text) is not None for part in found["attack"].parts] == [True, True]
    assert spent[0] >= 1  # the second part is told at once
    assert spent[1] == 0
    assert found["honest"].score == 1


def test_loading_anew_costs_the_next_question_nothing(tmp_path):
    """Not even where it is loaded twice, for parts that are hidden and for those that are not."""
    path = tmp_path / "submission.py"
    path.write_text(
        "import time\ntime.sleep(1.5)\ndef attack(x):\n    while True: pass\ndef honest(x): return 2 * x\n",
        encoding="utf-8",
    )
    work = assignment(1)
    attack, honest = (dataclasses.replace(each, seconds=1) for each in work.questions)
    (hidden,) = honest.parts
    seen = dataclasses.replace(hidden, name="ordinary", visibility="visible")
    attack = dataclasses.replace(attack, parts=(dataclasses.replace(attack.parts[0], visibility="visible"),))
    honest = dataclasses.replace(honest, parts=(seen, hidden))
    found = G.grade(dataclasses.replace(work, questions=(attack, honest)), path)
    assert found["attack"].score == 0
    assert found["honest"].score == 1


def test_copies_and_names_take_their_time_from_their_question(tmp_path):
    path = tmp_path / "submission.py"
    path.write_text(
        "import os, time\n"
        "os.register_at_fork(before=lambda: time.sleep(0.6))\n"
        "def attack(x): return x\n"
        "def __getattr__(name):\n"
        "    time.sleep(20 * (name == 'honest'))\n"
        "    raise AttributeError(name)\n",
        encoding="utf-8",
    )
    work = assignment(1)
    (first, other) = (dataclasses.replace(each, seconds=1) for each in work.questions)
    parts = [dataclasses.replace(first.parts[0], name=name) for name in ("hard", "ordinary", "energy")]
    found = G.grade(
        dataclasses.replace(work, questions=(dataclasses.replace(first, parts=parts), other)), path
    )
    assert all(re.search(SLOW, part.text) for part in found["attack"].parts[1:])
    assert "defines no function honest" in found["honest"].explanation
    assert found.seconds["honest"] < work.limits.seconds


TATTLER = """
from pathlib import Path
import numpy as np
KEPT = Path("kept.txt")
def first(x):
    with KEPT.open("a") as file:
        print(*np.asarray(x).tolist(), file=file)
    return 2.0 * np.asarray(x)
def second(x):
    raise ValueError(KEPT.read_text() if KEPT.exists() else "nothing")
"""


@pytest.mark.parametrize("visibility", ["visible", "hidden"])
def test_inputs_of_hidden_parts_cannot_be_shown_by_others(visibility, tmp_path):
    file = tmp_path / "tattler.py"
    file.write_text(TATTLER)
    judge = G.Values(inputs=lambda rng: {"x": 3.0 + np.arange(8)}, reference=the_honest_reference)
    questions = [
        G.Question(
            signature=f"{name}(x)",
            points=1,
            title=BOTH,
            text=BOTH,
            parts=(G.Part(name="hard", judge=judge, visibility=seen),),
        )
        for name, seen in (("first", visibility), ("second", "visible"))
    ]
    work = G.Assignment(name="a", title=BOTH, intro=BOTH, questions=tuple(questions))
    found = G.grade(work, file)
    assert found["first"].score == 1
    told = found["second"].explanation
    assert ("3.0 4.0 5.0" in told) is (visibility == "visible")  # which it may tell
    assert ("ValueError: nothing" in told) is (visibility == "hidden")
