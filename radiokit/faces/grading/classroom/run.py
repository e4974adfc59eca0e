"""Run: grades a class: each submission once, whatever ends meanwhile, and the same bytes in every run."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import radiokit
from radiokit.faces.grading.assignment import assignment_source
from radiokit.faces.grading.classroom.contents import read_submission
from radiokit.faces.grading.classroom.discovery import Entry, discover, read_roster
from radiokit.faces.grading.classroom.fingerprint import code_digest, fingerprint, secret_digest
from radiokit.faces.grading.classroom.pool import TRIES, completed
from radiokit.faces.grading.classroom.reasons import NOTHING, NoSubmissionError
from radiokit.faces.grading.classroom.reports import write_nameless, write_reports, write_timings
from radiokit.faces.grading.classroom.store import Store
from radiokit.faces.grading.classroom.task import Done, Order, Task, assignment_of, failed, perform
from radiokit.faces.grading.formats.writing import json_text
from radiokit.faces.grading.grades import Grade
from radiokit.faces.grading.isolation.limits import Limits
from radiokit.faces.grading.rehearsal import rehearse
from radiokit.faces.grading.unfinished import no_submission
from radiokit.faces.grading.words import checked_language
from radiokit.faces.workers import available_workers
from radiokit.facts.errors import ParameterError

__all__ = ["ClassGrades", "grade_class"]


@dataclass(frozen=True)
class ClassGrades:
    """The grades of a class, as they lie in a folder.

    ``keys`` are the entries; ``summary`` is what ``class.json`` holds, counts alone; ``graded`` were graded
    in this run, in ``seconds`` of wall time by ``workers`` (0 on a cluster); ``strangers`` is how many
    results in the folder are of no entry, and ``unlisted`` how many entries a roster does not name.
    """

    folder: Path
    keys: tuple[str, ...]
    summary: Mapping[str, Any]
    graded: int
    seconds: float = field(compare=False)
    workers: int = field(compare=False)
    strangers: int = 0
    unlisted: int = 0

    def __len__(self) -> int:
        return len(self.keys)

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys)

    def __getitem__(self, key: str) -> Grade:
        found = Store(self.folder).read(key) if key in self.keys else {}
        if not found:
            raise KeyError(key)
        return Grade.from_json(found)

    @property
    def exit_code(self) -> int:
        """0 when all is graded, 3 when a person should look at something."""
        return 3 if self.summary["need_review"] else 0


def grade_class(
    folder: str | Path,
    assignment: str | Path,
    out: str | Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    secret: str = "",
    language: str = "en",
    roster: str | Path | None = None,
    limits: Limits | None = None,
    html: bool = False,
    again: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> ClassGrades:
    """Grade a folder of submissions; what an earlier run has graded is graded again only if it has changed.

    Each entry of the folder is a submission: a script, a notebook, or a folder or .zip with one of them, or
    with one that is named as the assignment. The student is the entry's name without its suffix, or what
    Moodle and Canvas put before their numbers, unless a roster says otherwise. Into ``out`` go
    ``results/KEY.json``, ``class.csv`` and ``class.json``: for the same submissions the same bytes, wherever
    and however often they were graded, as long as none is near its time limits. ``timings.json`` is not.

    Parameters
    ----------
    folder : str or Path
    assignment : str or Path
        A name among ``list_assignments()``, or a file of your own.
    out : str or Path
        Where the results go; made if it is not there.
    workers : int, optional
        Local processes; as many as there are processors by default.
    scheduler : str, optional
        The address of a Dask scheduler whose workers grade instead. They are sent the submissions, the
        assignment and the secret, need the same radiokit, and should run one thread each. Without it,
        nothing leaves this machine.
    secret : str
        What makes the inputs unforeseeable; keep it between runs.
    language : str
        ``"en"`` or ``"ru"``.
    roster : str or Path, optional
        A CSV file with the columns ``entry`` and ``student``; who has no entry gets no points.
    limits : Limits, optional
        In place of the assignment's.
    html : bool
        Whether to write ``html/KEY.html``, too, the pages that students may be given.
    again : bool
        Whether to grade all again.
    progress : callable, optional
        Called with the number of finished submissions and of all.

    Returns
    -------
    ClassGrades

    Raises
    ------
    RadiokitError
        When the folder, the assignment, the roster or the scheduler is not there or is unusable, the results
        cannot be written, or another run is at work there. What is graded is kept.
    """
    began = time.monotonic()
    if workers is None and scheduler is None:
        workers = available_workers()
    source, file = assignment_source(assignment)
    order = Order(source, file, secret, language, limits, code_digest())
    work = assignment_of(order)
    checked_language(language, work.languages)
    if Path(assignment).suffix == ".py":
        rehearse(work)
    if Path(out).resolve() == Path(folder).resolve():
        raise ParameterError("out", str(out), "another folder than that of the submissions")
    students = None if roster is None else read_roster(roster)
    ignored = [Path(each) for each in (out, roster) if each is not None]
    entries = discover(folder, roster=students, ignore=ignored)
    with Store(Path(out)).opened(pages=html) as store:
        run = _Run(order, store, entries, work.name, again=again, local=scheduler is None, progress=progress)
        found = completed(
            perform,
            run.tasks(),
            workers=workers,
            scheduler=scheduler,
            weight=lambda task: len(task.content),
        )
        with closing(found):
            for item, done in found:
                run.receive(item, done)
        summary = write_reports(store, entries, work, order.language, absent=run.absent, html=html)
        seconds = time.monotonic() - began
        write_timings(store, entries, run.timings, seconds=seconds, workers=workers or 0)
        store.close()
    keys = [entry.key for entry in entries]
    return ClassGrades(
        folder=Path(out),
        keys=tuple(keys),
        summary=summary,
        graded=len(run.timings),
        seconds=seconds,
        workers=workers or 0,
        strangers=store.strangers(set(keys)),
        unlisted=len(set(keys) - students.keys()) if students is not None else 0,
    )


@dataclass(frozen=True)
class _Item:
    """Which entry a task is of, by its place, and the fingerprint of what it was sent."""

    place: int
    mark: str


class _Run:
    """One run: what is to be graded, what has come back, and what is made of it."""

    def __init__(
        self,
        order: Order,
        store: Store,
        entries: list[Entry],
        name: str,
        *,
        again: bool,
        local: bool,
        progress: Callable[[int, int], None] | None,
    ) -> None:
        self.order, self.store, self.entries, self.name = order, store, entries, name
        self.again, self.local, self.progress = again, local, progress
        self.done = 0
        self.absent: set[int] = set()
        self.timings: dict[str, Any] = {}
        self.secret = secret_digest(order.secret)

    def tasks(self) -> Iterator[tuple[_Item, Task]]:
        """Yield what is to be graded, read when it is asked for; store what cannot be."""
        for place, entry in enumerate(self.entries):
            try:
                found = read_submission(entry, self.name)
            except NoSubmissionError as error:
                self._absent(place, error)
                continue
            mark = self._mark(entry, found.content, found.suffix)
            stored = self.store.read(entry.key)
            if not self.again and stored.get("fingerprint") == mark and not _needs_review(stored):
                self._advance()
                continue
            journal = self.store.journal(mark) if self.local else None
            if journal is not None and self.again:
                journal.unlink(missing_ok=True)
            task = Task(self.order, found.content, found.suffix, entry.student, mark, str(journal or ""))
            yield _Item(place, mark), task

    def receive(self, item: _Item, done: Done | None) -> None:
        """Store what came back, or that nothing did."""
        entry = self.entries[item.place]
        if done is None:
            done = failed(self.order, entry.student, "broke", count=TRIES)
        self._write(item.place, item.mark, done.grade)
        self.store.settle(item.mark)
        self.timings[entry.key] = {"seconds": done.seconds, "measured": done.measured}
        self._advance()

    def _mark(self, entry: Entry, content: bytes, suffix: str) -> str:
        return fingerprint(
            content,
            suffix=suffix,
            source=self.order.source,
            key=entry.key,
            student=entry.student,
            secret=self.secret,
            language=self.order.language,
            limits=self.order.limits,
            code=self.order.code,
        )

    def _absent(self, place: int, error: NoSubmissionError) -> None:
        """Store that there is no submission; what was handed in and cannot be taken, a person looks at."""
        entry, language = self.entries[place], self.order.language
        grade = no_submission(
            assignment_of(self.order),
            error.text(language),
            student=entry.student,
            language=language,
            review=error.key not in NOTHING,
        )
        self.absent.add(place)
        self._write(place, self._mark(entry, b"", ""), grade.to_json())
        self._advance()

    def _write(self, place: int, mark: str, grade: Mapping[str, Any]) -> None:
        data = {"radiokit": radiokit.__version__, "fingerprint": mark, **grade}
        called = f"the result of submission {place + 1} of {len(self.entries)}"
        write_nameless(self.store.place(self.entries[place].key), json_text(data), called)

    def _advance(self) -> None:
        self.done += 1
        if self.progress is not None:
            self.progress(self.done, len(self.entries))


def _needs_review(stored: Mapping[str, Any]) -> bool:
    """Return whether a person should look at a stored grade: such are graded again."""
    return any(question.get("review") for question in stored.get("questions", ()))
