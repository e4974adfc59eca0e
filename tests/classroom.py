"""A small assignment, a class that hands it in, and how to compare what was made of it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

ASSIGNMENT = """
import os
import signal
from contextlib import suppress
from pathlib import Path

import numpy as np

from radiokit.faces.grading.assignment import Assignment
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.question import Part, Question
from radiokit.faces.grading.judges.values import Values


def both(text):
    return {"en": text, "ru": text}


class Patient:
    # asks who is too slow again and again, while the folder is there that a test names

    def __init__(self, values):
        self.values = values

    def judge(self, callee, rng, **options):
        found = self.values.judge(callee, rng, **options)
        place = Path(os.environ.get("HOLD", "/nowhere"))
        while "longer" in found.text and place.is_dir():
            with suppress(FileNotFoundError):
                (place / str(os.getpid())).touch()
            callee.call(np.ones(1))
        return found


def question(signature, points, inputs, reference):
    judge = Patient(Values(inputs=inputs, reference=reference))
    part = Part(name="ordinary", judge=judge)
    said = {"title": both("Q"), "text": both("Q")}
    return Question(signature=signature, points=points, parts=(part,), seconds=600.0, **said)


def lamps(rng):
    return {"intensity": rng.uniform(1, 9, 12), "distance": rng.uniform(1, 3, 12)}


def irradiance(intensity, distance):
    return intensity / distance**2


def exitance(radiance):
    return np.pi * radiance


ASSIGNMENT = Assignment(
    name="tiny",
    title=both("Tiny"),
    intro=both("Two questions."),
    limits=Limits(seconds=2.0),
    questions=(
        question("irradiance(intensity, distance)", 2, lamps, irradiance),
        question("exitance(radiance)", 1, lambda rng: {"radiance": rng.random(12)}, exitance),
    ),
)
"""

RIGHT = """
import numpy as np
def irradiance(intensity, distance):
    return intensity / distance**2
def exitance(radiance):
    return np.pi * radiance
"""

CLASS = {
    "Zinaida.py": RIGHT,
    "Yaroslav.py": RIGHT.replace("distance**2", "distance"),
    "Xenia/solution.py": RIGHT.replace("np.pi *", "2 * np.pi *"),
    "Wsewolod.py": RIGHT.replace("return np.pi * radiance", "import time\n    while True: time.sleep(1)"),
    "Ulyana.py": RIGHT.replace("return np.pi", "import os; os._exit(3)\n    return np.pi"),
    "Тимофей_77_assignsubmission_file_/tiny.py": RIGHT + "raise ValueError('Тимофей')\n",
    "Serafim/notes.txt": "I was ill.",
    "Rodion_21_345_tiny.py": "def irradiance(: pass",
}
KEYS = ["Rodion_21", "Serafim", "Ulyana", "Wsewolod", "Xenia", "Yaroslav", "Zinaida", "Тимофей_77"]
NAMES = ["Zinaida", "Yaroslav", "Xenia", "Wsewolod", "Ulyana", "Тимофей", "Serafim", "Rodion"]


def hand_in(folder: Path, files: dict[str, str] = CLASS) -> Path:
    """Write a class's submissions into a folder, and the assignment beside it, whose path is returned."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    assignment = folder.parent / "tiny.py"
    assignment.write_text(ASSIGNMENT)
    return assignment


def made(out: Path) -> dict[str, bytes]:
    """Return what must be the same in every run, by file; all else must be known to differ."""
    found = {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}
    return {name: found[name] for name in found.keys() - {"timings.json", ".lock"}}


def act(order: tuple[str, str]) -> str:
    """Do what a task's name says to the process that it runs in, and return it."""
    name, marker = order
    if name == "kills" or (name == "kills once" and not Path(marker).exists()):
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if name == "fails":
        raise ValueError(name)
    return name


def start(*arguments: str | Path, **options: object) -> subprocess.Popen[bytes]:
    """Start ``radiokit`` with arguments, in a process group of its own, where it can be interrupted.

    It could not if these tests run in the background of a shell, which then has all ignore interrupts.
    """
    code = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler);"
    code += "from radiokit.faces.cli import main; main()"
    command = [sys.executable, "-c", code, *map(str, arguments)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, start_new_session=True, **{**pipes, **options})  # type: ignore[call-overload]


@contextmanager
def holding(folder: Path) -> Iterator[Path]:
    """Keep Wsewolod's task from ending inside; a file in the folder then tells which process has it."""
    folder.mkdir()
    try:
        yield folder
    finally:
        folder.rename(folder.with_name("released"))


def wait_until(true: Callable[[], bool], seconds: float = 120.0) -> None:
    """Wait until something is true."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "it did not come true"
        time.sleep(0.01)


def left_of(leader: int, folder: Path) -> list[int]:
    """Return the processes of a session that are left, and those whose command line names a folder.

    Sandboxes have sessions of their own; their folders are temporary ones.
    """
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            with suppress(OSError):
                state, _, _, session, *_ = (entry / "stat").read_text().rpartition(")")[2].split()
                named = os.fsencode(folder) in (entry / "cmdline").read_bytes()
                if state != "Z" and (int(session) == leader or named):
                    found.append(int(entry.name))
    return found
