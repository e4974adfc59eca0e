"""Contents: the one script or notebook among what a student handed in, read without being led elsewhere."""

from __future__ import annotations

import io
import os
import re
import stat
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from radiokit.faces.grading.classroom.discovery import Entry, skipped
from radiokit.faces.grading.classroom.reasons import NoSubmissionError

__all__ = ["Submission", "read_submission"]

SUFFIXES = (".py", ".ipynb")
ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar")
MIB = 16
LARGEST = MIB << 20
"""How many bytes a submission may have."""
MOST = 5000
"""How many files one entry may have."""
PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
"""How members of a .zip may be packed: of these alone is as much unpacked as is read, and no more."""


@dataclass(frozen=True)
class Submission:
    """A script's or notebook's bytes, and its suffix."""

    content: bytes
    suffix: str


@dataclass(frozen=True)
class _Candidate:
    name: PurePosixPath
    read: Callable[[], bytes]


def read_submission(entry: Entry, assignment: str) -> Submission:
    """Return the one script or notebook of an entry, or the one that is named as the assignment.

    Folders are searched to their ends, and a .zip where there is nothing else; nothing is unpacked.

    Raises
    ------
    NoSubmissionError
        When there is none, or more than one, or it is too large, broken, or a link out of the entry.
    """
    if not entry.paths:
        raise NoSubmissionError("absent")
    try:
        return _read_submission(entry, assignment)
    except (OSError, RuntimeError) as error:  # RuntimeError: links in a circle
        raise NoSubmissionError("unreadable") from error


def _read_submission(entry: Entry, assignment: str) -> Submission:
    archives: list[_Candidate] = []
    found: list[_Candidate] = []
    for path, name in entry.paths.items():
        for each in _files(path, name):
            suffix = each.name.suffix.lower()
            if suffix in SUFFIXES:
                found.append(each)
            elif suffix in ARCHIVES:
                archives.append(each)
    if not found:
        found = [member for archive in archives for member in _members(archive)]
    chosen = _chosen(found, assignment)
    return Submission(chosen.read(), chosen.name.suffix.lower())


def _chosen(found: list[_Candidate], assignment: str) -> _Candidate:
    if not found:
        raise NoSubmissionError("empty")
    copy = re.compile(rf"{re.escape(assignment)}(?:[-_ ]?\(?\d+\)?)?", re.IGNORECASE)  # hw-1.py, hw (2).py
    exact = [each for each in found if each.name.stem == assignment]
    for named in (found, exact, [each for each in found if copy.fullmatch(each.name.stem)]):
        if len(named) == 1:
            return named[0]
    raise NoSubmissionError("several", count=len(found), name=assignment)


def _files(path: Path, name: str) -> Iterator[_Candidate]:
    """Yield the files at or below a path, all of which must be there and not elsewhere."""
    if path.is_symlink():
        path.stat()  # one in a circle is unreadable
        raise NoSubmissionError("link")  # out of the class, or to what another has handed in
    if not path.is_dir():
        yield _Candidate(PurePosixPath(name), lambda: _read(path, path))
        return
    count = 0
    for folder, folders, files in os.walk(path, onerror=_raise):
        folders[:] = sorted(each for each in folders if not skipped(each))
        count += len(files) + len(folders)
        if count > MOST:
            raise NoSubmissionError("crowded", limit=MOST)
        for each in sorted(files):
            if not skipped(each):
                file = Path(folder, each)
                yield _Candidate(PurePosixPath(each), lambda file=file: _read(file, path))  # type: ignore[misc]


def _raise(error: OSError) -> None:
    raise error


def _read(path: Path, home: Path) -> bytes:
    """Return the bytes of an ordinary file that lies below ``home``, wherever links lead."""
    real = path.resolve(strict=True)
    if not real.is_relative_to(home.resolve()):
        raise NoSubmissionError("link")
    descriptor = os.open(real, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW)  # a pipe must not hold us up
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise NoSubmissionError("unreadable")
        return _bounded(file.read(LARGEST + 1))


def _bounded(content: bytes) -> bytes:
    if len(content) > LARGEST:
        raise NoSubmissionError("huge", limit=MIB)
    return content


def _members(archive: _Candidate) -> list[_Candidate]:
    """Return the scripts and notebooks in a .zip."""
    content = io.BytesIO(archive.read())
    try:
        with zipfile.ZipFile(content) as opened:
            members = opened.infolist()
    except Exception as error:  # zipfile raises many kinds
        raise NoSubmissionError("archive") from error
    if len(members) > MOST:
        raise NoSubmissionError("crowded", limit=MOST)

    def candidate(member: zipfile.ZipInfo) -> _Candidate:
        def read() -> bytes:
            if member.compress_type not in PACKED:
                raise NoSubmissionError("archive")
            try:
                with zipfile.ZipFile(content) as opened, opened.open(member) as file:
                    return _bounded(file.read(LARGEST + 1))
            except Exception as error:  # zlib, lzma and zipfile raise many kinds
                if isinstance(error, NoSubmissionError):
                    raise
                raise NoSubmissionError("archive") from error

        return _Candidate(PurePosixPath(member.filename), read)

    return [
        candidate(member)
        for member in members
        if not member.filename.endswith("/")
        and not any(skipped(part) for part in PurePosixPath(member.filename).parts if part != "..")
        and PurePosixPath(member.filename).suffix.lower() in SUFFIXES
    ]
