"""A class: every submission once, the same bytes in every run, whatever ends meanwhile, and no name said."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from classroom import CLASS, KEYS, NAMES, RIGHT, act, hand_in, holding, left_of, made, start, wait_until

import radiokit as rk
from radiokit.faces.cli import main
from radiokit.faces.grading.classroom import contents, task
from radiokit.faces.grading.classroom.contents import Submission, read_submission
from radiokit.faces.grading.classroom.discovery import Entry, discover, read_roster
from radiokit.faces.grading.classroom.fingerprint import code_digest, fingerprint, secret_digest
from radiokit.faces.grading.classroom.pool import completed
from radiokit.faces.grading.classroom.reasons import REASONS, NoSubmissionError
from radiokit.faces.grading.classroom.run import grade_class
from radiokit.faces.grading.classroom.store import Store
from radiokit.faces.grading.classroom.task import Order, Task, perform
from radiokit.faces.grading.grades import Grade
from radiokit.facts.errors import RadiokitError, TargetError

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the sandbox needs a POSIX system")


# What is handed in


def _read(path: Path, name: str = "tiny") -> Submission:
    return read_submission(Entry(key="x", student="x", paths={path: path.name}), name)


def _refused(path: Path) -> str:
    with pytest.raises(NoSubmissionError) as caught:
        _read(path)
    return caught.value.key


def test_entries_are_found_as_people_and_systems_leave_them(tmp_path: Path) -> None:
    names = [
        "anna.py",
        "boris/deep/er/work.ipynb",
        "Cyril Lee_3_assignsubmission_file_/work.py",
        "Cyril Lee_3_assignsubmission_onlinetext_/onlinetext.html",
        "Dora_4_assignsubmission_file_anna_1_assignsubmission_file_work.py",
        "leeeve_LATE_551_7777_work.py",
        "submission_88/work.py",
        "submission_metadata.yml",
        ".DS_Store",
        "__MACOSX/anna.py",
        "fedor.pdf",
        "out/results/x.json",
    ]
    for name in names:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    entries = {entry.key: entry for entry in discover(tmp_path, ignore=[tmp_path / "out"])}
    keys = ["Cyril Lee_3", "Dora_4", "anna", "boris", "fedor", "leeeve_551", "submission_88"]
    assert list(entries) == keys
    assert [entry.student for entry in entries.values()] == keys
    assert read_submission(entries["boris"], "tiny").suffix == ".ipynb"
    assert read_submission(entries["Cyril Lee_3"], "tiny").content == names[2].encode()
    with pytest.raises(NoSubmissionError, match="empty"):
        read_submission(entries["fedor"], "tiny")


def test_a_person_looks_at_what_was_handed_in_and_cannot_be_taken(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {
        "anna.txt": "ill",
        "boris/a.py": RIGHT,
        "boris/b.py": RIGHT,
        "clara.zip": "no zip",
        "dora.py": RIGHT,
    }
    assignment = hand_in(tmp_path / "class", {**files, "eve.ipynb": "{"})
    given = (str(tmp_path / "class"), "--assignment", str(assignment), "--out", str(tmp_path / "out"))
    with pytest.raises(SystemExit) as ended:
        main(["grade-class", *given, "--workers", "1"])
    assert ended.value.code == 3
    told = capsys.readouterr().out
    assert f"2 for a person to look at: {tmp_path / 'out' / 'class.csv'} says why" in told
    table = (tmp_path / "out/class.csv").read_text("utf-8-sig").splitlines()
    rows = {row["student"]: row for row in csv.DictReader(table)}
    assert rows["anna"]["note"] == "there is no submission: no .py or .ipynb file was handed in"
    assert rows["boris"]["note"].startswith("there is no submission: 2 files end in .py or .ipynb")
    assert rows["boris"]["note"].count("2 files") == 1
    assert rows["clara"]["note"] == "there is no submission: its archive is broken, encrypted, or no .zip"
    assert rows["eve"]["note"] == "it is no Jupyter notebook of format 3 or 4"
    review = {
        key: json.loads((tmp_path / f"out/results/{key}.json").read_text())["questions"][0]["review"]
        for key in rows
    }
    assert {key for key, why in review.items() if why} == {"boris", "clara"}


def test_names_are_the_same_text_on_every_system(tmp_path: Path) -> None:
    (tmp_path / "Zoe\u0308.py").write_text("")  # as macOS writes it
    Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff.py")).write_text("")
    assert [entry.key for entry in discover(tmp_path)] == ["Zo\u00eb", "\\xff"]


def test_of_several_files_the_assignments_own_counts(tmp_path: Path) -> None:
    for name in ("helper.py", "other.ipynb"):
        (tmp_path / name).write_text(name)
    assert _refused(tmp_path) == "several"
    (tmp_path / "Tiny-2.py").write_text("second")
    assert _read(tmp_path).content == b"second"
    (tmp_path / "tiny.py").write_text("first")
    assert _read(tmp_path).content == b"first"
    (tmp_path / "tiny.ipynb").write_text("{}")
    assert _refused(tmp_path) == "several"


def test_what_must_not_be_followed_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    secret = tmp_path / "secret.py"
    secret.write_text("reference = 1")
    folder = tmp_path / "class"
    for name in ("link", "loop", "pipe", "huge", "many", "own"):
        (folder / name).mkdir(parents=True)
    (folder / "link/work.py").symlink_to(secret)
    (folder / "out.py").symlink_to(secret)
    (folder / "elsewhere").symlink_to(tmp_path)
    (folder / "circle").symlink_to(folder / "circle")
    assert [entry.key for entry in discover(folder)][:2] == ["circle", "elsewhere"]
    (folder / "loop/work.py").symlink_to(folder / "loop/work.py")
    os.mkfifo(folder / "pipe/work.py")
    (folder / "huge/work.py").write_bytes(bytes(100))
    for number in range(9):
        (folder / f"many/{number}.txt").write_text("")
    monkeypatch.setattr(contents, "LARGEST", 99)
    monkeypatch.setattr(contents, "MOST", 8)
    (folder / "own/work.py").write_text("mine")
    (folder / "others").symlink_to(folder / "own")
    (folder / "others.py").symlink_to(folder / "own/work.py")
    links = ("link/work.py", "link", "out.py", "elsewhere", "others", "others.py")
    assert {_refused(folder / name) for name in links} == {"link"}
    assert {_refused(folder / name) for name in ("loop", "circle", "pipe")} == {"unreadable"}
    assert _refused(folder / "huge") == "huge"
    assert _refused(folder / "many") == "crowded"


def test_an_archive_is_read_where_there_is_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = tmp_path / "work.zip"
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("__MACOSX/._work.py", "no")
        archive.writestr("../../work.py", RIGHT)
    assert _read(whole) == Submission(RIGHT.encode(), ".py")
    monkeypatch.setattr(contents, "LARGEST", 400)
    with zipfile.ZipFile(tmp_path / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("work.py", "#" * 100_000)
    assert _refused(tmp_path / "bomb.zip") == "huge"
    for name, kind in (("small.zip", zipfile.ZIP_BZIP2), ("tiny.zip", zipfile.ZIP_LZMA)):
        with zipfile.ZipFile(tmp_path / name, "w", kind) as archive:  # of which no part alone is unpacked
            archive.writestr("work.py", "#")
    with zipfile.ZipFile(tmp_path / "unnamed.zip", "w") as archive:
        archive.writestr("x", "")
    nameless = (tmp_path / "unnamed.zip").read_bytes().replace(b"x", b"\0")
    (tmp_path / "unnamed.zip").write_bytes(nameless)
    assert _refused(tmp_path / "unnamed.zip") == "empty"
    (tmp_path / "cut.zip").write_bytes(whole.read_bytes()[:-30])
    (tmp_path / "work.rar").write_bytes(b"Rar!")
    spoilt = bytearray(whole.read_bytes())
    spoilt[-200] ^= 255
    (tmp_path / "spoilt.zip").write_bytes(spoilt)
    broken = ("cut.zip", "work.rar", "spoilt.zip", "small.zip", "tiny.zip")
    assert {_refused(tmp_path / name) for name in broken} == {"archive"}


def test_a_roster_names_the_students_and_those_who_handed_in_nothing(tmp_path: Path) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class/anna.py").write_text("")
    roster = tmp_path / "roster.csv"
    roster.write_text("\ufeffgroup,entry,student\n1,anna,a17\n1,boris,b18\n", encoding="utf-8")
    found = discover(tmp_path / "class", roster=read_roster(roster))
    assert [(entry.key, entry.student) for entry in found] == [("anna", "a17"), ("boris", "b18")]
    with pytest.raises(NoSubmissionError, match="absent"):
        read_submission(found[1], "tiny")
    for text, message in {
        "entry,name\nanna,a17\n": "no column student",
        "entry,student\nanna,a17\nanna,a18\n": "line 3: the entry stands there twice",
        "entry,student\nanna,\n": "line 2: an entry or a student is missing",
    }.items():
        roster.write_text(text)
        with pytest.raises(TargetError, match=message):
            read_roster(roster)


def test_every_reason_is_said_in_both_languages() -> None:
    for key, texts in REASONS.items():
        values = {"count": 2, "limit": 3, "name": "x", "error": "y"}
        error = NoSubmissionError(key, **values)
        assert error.text("en") != error.text("ru"), key
        assert texts.keys() == {"en", "ru"}


# What a grade depends on, and where it lies


def test_a_fingerprint_changes_with_all_that_a_grade_depends_on() -> None:
    whole = {
        "suffix": ".py",
        "source": "s",
        "key": "k",
        "student": "a",
        "secret": "",
        "language": "en",
        "code": "c",
    }
    changes = [{}, *({name: "other"} for name in whole), {"limits": rk.grading.Limits(seconds=2)}]
    marks = [fingerprint(b"x", **{"limits": None, **whole, **change}) for change in changes]  # type: ignore[arg-type]
    assert len({*marks, fingerprint(b"y", limits=None, **whole)}) == len(changes) + 1
    assert len({secret_digest(""), secret_digest("a"), secret_digest("b")}) == 3


def test_no_key_leads_out_of_the_results_or_to_anothers(tmp_path: Path) -> None:
    store = Store(tmp_path)
    keys = ["a", "../a", "..", ".a", "a/b", "a_b", "a\\b", "a\nb", "ж" * 300, "ж" * 301]
    places = [store.place(key) for key in keys]
    assert len(set(places)) == len(keys)
    assert {place.parent for place in places} == {store.results}
    assert all(len(os.fsencode(place.name)) < 200 and not place.name.startswith(".") for place in places)


def test_two_runs_do_not_share_a_folder_and_drafts_are_cleared(tmp_path: Path) -> None:
    with (
        Store(tmp_path).opened(),
        pytest.raises(RadiokitError, match="another run"),
        Store(tmp_path).opened(),
    ):
        pass
    with Store(tmp_path).opened():
        pass


# Tasks and pools


def _order(source: str) -> Order:
    return Order(source, "tiny.py", "", "en", None, code_digest())


def test_a_task_goes_on_where_its_journal_ends_and_shows_nothing_of_itself(tmp_path: Path) -> None:
    assignment = hand_in(tmp_path / "class", {})
    journal = tmp_path / "journal"
    order = _order(assignment.read_text())
    work = Task(order, RIGHT.encode(), ".py", "Zinaida", "mark", str(journal))
    whole = perform(work)
    begun = json.loads(journal.read_text())
    assert [question["name"] for question in begun["questions"]] == ["irradiance"]
    assert not begun["complete"]
    assert perform(work).grade == whole.grade
    begun["questions"][0]["parts"][0]["score"] = 0.5
    journal.write_text(json.dumps(begun))
    assert perform(work).grade["questions"][0]["score"] == 0.5
    journal.write_text(journal.read_text()[:-9])
    assert perform(work).grade == whole.grade
    assert (repr(order), repr(work), repr(whole)) == ("Order()", "Task()", "Done()")
    with pytest.raises(RadiokitError, match="install the same"):
        perform(replace(work, order=replace(order, code="other")))


def test_what_fails_in_a_task_is_for_a_person_and_is_tried_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assignment = hand_in(tmp_path / "class", {"anna.py": RIGHT})
    out = tmp_path / "out"

    def failing(*arguments: object, **options: object) -> Grade:
        raise MemoryError(f"at {arguments[1]}")

    monkeypatch.setattr(task, "grade", failing)
    found = grade_class(tmp_path / "class", assignment, out, workers=1)
    assert found.exit_code == 3
    assert found["anna"].score == 0
    assert found["anna"].problems == (
        "it could not be graded (MemoryError: at submission.py); a teacher will look at it",
    )
    monkeypatch.undo()
    found = grade_class(tmp_path / "class", assignment, out, workers=1)
    assert (found.exit_code, found.graded, found["anna"].score) == (0, 1, 3)


def test_what_breaks_a_pool_harms_no_other_task(tmp_path: Path) -> None:
    names = ["a", "kills", "b", "kills once", "c", "fails", "d"]
    tasks = ((name, (name, str(tmp_path / name))) for name in names)
    found = list(completed(act, tasks, workers=2))
    assert sorted(name for name, _ in found) == sorted(names)
    assert dict(found) == {name: None if name in ("kills", "fails") else name for name in names}


def test_few_tasks_are_taken_ahead() -> None:
    taken: list[int] = []

    def tasks() -> Iterator[tuple[int, int]]:
        for number in range(20):
            taken.append(number)
            yield number, -number

    found = completed(abs, tasks(), workers=2)
    assert next(found)[1] is not None
    assert len(taken) <= 6
    found.close()


# Whole runs


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A class and its grades by one worker."""
    folder = tmp_path_factory.mktemp("grades")
    assignment = hand_in(folder / "class")
    found = grade_class(folder / "class", assignment, folder / "one", workers=1, secret="s")
    assert (found.graded, found.keys) == (7, tuple(KEYS))
    (folder / "secret").write_text("s\n")
    return folder


def _arguments(place: Path, out: Path, *more: str) -> list[str | Path]:
    whole = ["grade-class", place / "class", "--assignment", place / "tiny.py", "--out", out]
    return [*whole, "--secret-file", place / "secret", *more]


def test_each_gets_what_is_his_due(place: Path) -> None:
    summary = json.loads((place / "one/class.json").read_text())
    assert (summary["entries"], summary["handed_in"], summary["need_review"]) == (8, 7, 0)
    grades = {key: Grade.from_json(Store(place / "one").read(key)) for key in KEYS}
    scores = {key: [question.score for question in grade.questions] for key, grade in grades.items()}
    assert scores["Zinaida"] == [2, 1]
    assert scores["Yaroslav"] == [0, 1]
    assert scores["Xenia"] == [2, 0]
    assert scores["Wsewolod"] == [2, 0]
    assert scores["Ulyana"] == [2, 0]
    assert scores["Serafim"] == scores["Rodion_21"] == [0, 0]
    assert "no .py or .ipynb file" in grades["Serafim"].problems[0]
    assert "longer than" in grades["Wsewolod"]["exitance"].explanation
    assert "exit code 3" in grades["Ulyana"]["exitance"].explanation
    irradiance, exitance = summary["questions"]
    assert irradiance["misconceptions"][0]["name"] == "distance-not-squared"
    assert exitance["misconceptions"][0]["name"] == "doubled"
    assert exitance["full"] + exitance["partial"] + exitance["none"] == 7
    assert sum(irradiance["tenths"]) == 7
    text = (place / "one/class.json").read_text()
    assert not [name for name in NAMES if name in text]
    rows = (place / "one/class.csv").read_text().splitlines()
    assert [row.split(",")[0] for row in rows[1:]] == KEYS


def test_results_fit_their_schema_and_pages_are_written_when_asked_for(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import jsonschema

    from radiokit.faces.cli import main

    table = place / "class.csv"
    with pytest.raises(SystemExit) as ended:
        main([*map(str, _arguments(place, place / "one", "--html", "--csv", str(table)))])
    assert ended.value.code == 0
    printed, errors = capsys.readouterr()
    assert "nothing had changed" in printed
    assert not [name for name in NAMES if name in printed + errors]
    assert table.read_text() == (place / "one/class.csv").read_text()
    for key in KEYS:
        jsonschema.validate(Store(place / "one").read(key), rk.grading.grade_schema())
        assert key in Store(place / "one").page(key).read_text()
    shutil.rmtree(place / "one/html")


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")
def test_two_workers_write_the_same_bytes_after_any_end_and_no_name_is_said(
    place: Path, tmp_path: Path
) -> None:
    (tmp_path / "tmp").mkdir()
    environment = {**os.environ, "TMPDIR": str(tmp_path / "tmp"), "HOLD": str(tmp_path / "hold")}
    out = tmp_path / "two"
    arguments = _arguments(place, out, "--workers", "2")

    with holding(tmp_path / "hold") as hold:  # until then it cannot end
        killed = start(*arguments, env=environment)
        wait_until(lambda: len(list(out.glob("results/*.json"))) >= 4 and any(hold.iterdir()))
        os.kill(killed.pid, signal.SIGKILL)
        said = b"".join(killed.communicate())
    wait_until(lambda: not left_of(killed.pid, tmp_path / "tmp"))  # workers and sandboxes end with it
    assert not list((tmp_path / "tmp").iterdir())
    assert list(out.glob("partial/*.json"))
    kept = {path: path.read_bytes() for path in out.glob("results/*.json")}
    assert 4 <= len(kept) < 8

    again = start(*arguments, "--json", env=environment)
    printed, errors = again.communicate(timeout=300)
    assert (again.returncode, errors) == (0, b"")
    assert {path: path.read_bytes() for path in kept} == kept
    assert made(out) == made(place / "one")
    timings = json.loads((out / "timings.json").read_text())
    assert timings["graded"] == 8 - len(kept | {out / "results/Serafim.json": b""})
    assert json.loads(printed)["entries"] == 8

    said += printed
    assert not [name for name in NAMES if name in said.decode()]


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")
def test_an_interrupt_ends_a_run_at_once_and_cleanly(place: Path, tmp_path: Path) -> None:
    (tmp_path / "tmp").mkdir()
    out = tmp_path / "out"
    environment = {**os.environ, "TMPDIR": str(tmp_path / "tmp"), "HOLD": str(tmp_path / "hold")}
    with holding(tmp_path / "hold") as hold:  # all but one have a result, and that one is being asked
        run = start(*_arguments(place, out, "--workers", "2"), env=environment)
        wait_until(lambda: len(list(out.glob("results/*.json"))) == 7 and any(hold.iterdir()))
        os.killpg(run.pid, signal.SIGINT)  # as a terminal does
        printed, errors = run.communicate(timeout=120)
    assert (run.returncode, printed, errors) == (130, b"", b"")
    wait_until(lambda: not left_of(run.pid, tmp_path / "tmp"))
    assert not list((tmp_path / "tmp").iterdir())
    assert len(list(out.glob("results/*.json"))) == 7
    assert {name for name in made(out) if name.startswith("results")} < set(made(place / "one"))


def test_only_what_has_changed_is_graded_again(tmp_path: Path) -> None:
    assignment = hand_in(tmp_path / "class", {"anna.py": RIGHT, "boris.py": "def irradiance(: pass"})
    given = (tmp_path / "class", assignment, tmp_path / "out")
    seen: list[tuple[int, int]] = []
    assert grade_class(*given, workers=1, progress=lambda *count: seen.append(count)).graded == 2
    assert seen == [(1, 2), (2, 2)]
    first = made(tmp_path / "out")
    assert grade_class(*given, workers=1).graded == 0
    (tmp_path / "class/boris.py").write_text("def exitance(: pass")
    assert grade_class(*given, workers=1).graded == 1
    (tmp_path / "out/results/anna.json").write_text("{")
    assert grade_class(*given, workers=1).graded == 1
    (tmp_path / "class/boris.py").unlink()
    found = grade_class(*given, workers=1, again=True)
    assert (found.graded, list(found), found.strangers) == (1, ["anna"], 1)
    assert made(tmp_path / "out")["results/anna.json"] == first["results/anna.json"]
    with pytest.raises(KeyError):
        found["boris"]


DEADLY = """
class Deadly:
    def judge(self, callee, rng, **options):
        answer = callee.call(np.ones(1), np.ones(1))
        if answer.ok and answer.values[0] == 666:
            os.kill(os.getpid(), signal.SIGKILL)
        return VALUES.judge(callee, rng, **options)
VALUES = ASSIGNMENT.questions[0].parts[0].judge
object.__setattr__(ASSIGNMENT.questions[0].parts[0], "judge", Deadly())
"""


def test_a_submission_whose_grading_ends_the_worker_is_for_a_person(tmp_path: Path) -> None:
    deadly = RIGHT.replace("intensity / distance**2", "0 * intensity + 666")
    assignment = hand_in(tmp_path / "class", {"anna.py": RIGHT, "boris.py": deadly, "clara.py": RIGHT})
    assignment.write_text(assignment.read_text() + DEADLY)
    found = grade_class(tmp_path / "class", assignment, tmp_path / "out", workers=2)
    assert (found.exit_code, found.summary["need_review"], found.graded) == (3, 1, 3)
    assert [found[key].score for key in found] == [3, 0, 3]
    assert "ended its worker process 2 times" in found["boris"]["exitance"].review


def test_a_roster_may_be_as_excel_writes_it(tmp_path: Path) -> None:
    for text in ("entry,student\na,Anna\n", "\ufeffentry;student\r\na;Anna\r\n", "entry, student\na,Anna\n"):
        (tmp_path / "roster.csv").write_text(text, encoding="utf-8", newline="")
        assert read_roster(tmp_path / "roster.csv") == {"a": "Anna"}


def test_entries_that_a_roster_does_not_name_are_counted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from radiokit.faces.cli import main

    assignment = hand_in(tmp_path / "class", {"anna.rar": "", "boris.rar": ""})
    (tmp_path / "roster.csv").write_text("entry,student\nanna.rar,Anna\nboris,Boris\n")
    words = [
        "grade-class",
        str(tmp_path / "class"),
        f"--assignment={assignment}",
        f"--out={tmp_path / 'out'}",
    ]
    with pytest.raises(SystemExit):
        main([*words, f"--roster={tmp_path / 'roster.csv'}"])
    assert "entries that the roster does not name, whose own names count: 1" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"--assignment": "nothing"}, "unknown assignment 'nothing'"),
        ({"--secret-file": "nowhere"}, "cannot read the secret in nowhere"),
        ({"--language": "de"}, "language = 'de'"),
        ({"--workers": "0"}, "workers = 0"),
        ({"--out": "tiny.py"}, "out = "),
        ({"--out": "class"}, "out = 'class' is not allowed: it must be another folder than that of the sub"),
        ({"--roster": "nowhere.csv"}, "nowhere.csv cannot be read: No such file or directory"),
        ({"--roster": "names.csv"}, "names.csv has no column entry and no column student; it has name, mail"),
        ({"DIR": "nowhere"}, "no such folder"),
    ],
)
def test_a_wrong_argument_is_named(
    change: dict[str, str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    from radiokit.faces.cli import main

    hand_in(tmp_path / "class", {"anna.py": RIGHT})
    (tmp_path / "names.csv").write_text("name,mail\nAnna,anna@example.org\n")
    monkeypatch.chdir(tmp_path)
    given = {"DIR": "class", "--assignment": "tiny.py", "--out": "out", **change}
    words = [word for name, value in given.items() for word in ((value,) if name == "DIR" else (name, value))]
    with pytest.raises(SystemExit) as ended:
        main(["grade-class", *words])
    assert ended.value.code == 2
    printed, errors = capsys.readouterr()
    assert printed == ""
    assert message in errors
    assert len(errors.splitlines()) == 1


def test_the_class_of_the_tests_is_whole() -> None:
    assert len(CLASS) == len(KEYS) == len(NAMES)
