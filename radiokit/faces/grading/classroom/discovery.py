"""Discovery: which entries of a folder are whose, as people and learning systems leave them."""

from __future__ import annotations

import csv
import re
import unicodedata
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from radiokit.facts.errors import TargetError

__all__ = ["SKIPPED", "Entry", "discover", "read_roster", "skipped"]

SKIPPED = frozenset({"__MACOSX", "__pycache__", "submission_metadata.yml", "desktop.ini", "Thumbs.db"})
"""What systems leave behind beside what is handed in; hidden files likewise."""

EXPORTS = (
    # Moodle: Name_123_assignsubmission_file_, a folder or the beginning of a file's name; what follows is
    # the student's own, and may look the same.
    re.compile(r"(?P<key>.+?_\d+)_assignsubmission_(?:file|onlinetext)(?:_(?P<name>.*))?"),
    # Canvas: lastfirst_123_456_file.py, or lastfirst_LATE_123_456_file.py
    re.compile(r"(?P<who>[^_]+)(?:_LATE)?_(?P<id>\d{2,})_\d{2,}_(?P<name>.+)"),
)


@dataclass(frozen=True, kw_only=True)
class Entry:
    """What one student handed in.

    Parameters
    ----------
    key : str
        The entry's name without suffix, or its part that an export gives each student; names the result.
    student : str
        Who, for the inputs: the key, unless a roster says otherwise.
    paths : dict of Path to str
        Files and folders that belong to it, each with the name that it was handed in by.
    """

    key: str
    student: str
    paths: Mapping[Path, str]


def skipped(name: str) -> bool:
    """Return whether a file is none of the student's.

    >>> skipped(".DS_Store"), skipped("__MACOSX"), skipped("anna.py")
    (True, True, False)
    """
    return name.startswith(".") or name in SKIPPED


def discover(
    folder: str | Path,
    *,
    roster: Mapping[str, str] | None = None,
    ignore: Collection[Path] = (),
) -> list[Entry]:
    """Return the entries of a folder, sorted by key.

    Each file or folder is an entry; those of one key are one: ``anna.py`` and ``anna.pdf``, or what Moodle
    and Canvas name alike. Of a roster, those who are not in the folder are entries too.

    Parameters
    ----------
    folder : str or Path
    roster : dict, optional
        Students by key.
    ignore : collection of Path
        What is in the folder and no entry, such as the results.

    Raises
    ------
    TargetError
        When the folder is not there or cannot be read, or has no entries.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     for name in ("boris.py", "Anna Petrova_17_assignsubmission_file_hw.py", "leeann_21_345_hw.py"):
    ...         _ = Path(folder, name).write_text("")
    ...     [entry.key for entry in discover(folder)]
    ['Anna Petrova_17', 'boris', 'leeann_21']
    """
    place = Path(folder)
    if not place.is_dir():
        raise TargetError(f"no such folder: {place}")
    home, others = place.resolve(), {path.resolve() for path in ignore}
    found: dict[str, dict[Path, str]] = {}
    try:
        paths = sorted(place.iterdir())
    except OSError as error:
        raise TargetError(f"{place} cannot be read: {error.strerror}") from error
    for path in paths:
        if not skipped(path.name) and home / path.name not in others:
            key, name = _split(path)
            found.setdefault(key, {})[path] = name
    students = roster or {}
    keys = sorted({*found, *students})
    if not keys:
        raise TargetError(f"no submissions in {place}")
    return [Entry(key=key, student=students.get(key, key), paths=found.get(key, {})) for key in keys]


def read_roster(file: str | Path) -> dict[str, str]:
    """Return the students by key, from a CSV file with the columns ``entry`` and ``student``.

    Raises
    ------
    TargetError
        When the file is not there, lacks a column or a value, or names an entry twice.
    """
    path = Path(file)
    found: dict[str, str] = {}
    try:
        with path.open(encoding="utf-8-sig", newline="") as lines:
            rows = csv.DictReader(lines)
            missing = {"entry", "student"} - set(rows.fieldnames or ())
            if missing:
                raise TargetError(f"{path.name} has no column {' and no column '.join(sorted(missing))}")
            for row in rows:
                key, student = (_plain((row[column] or "").strip()) for column in ("entry", "student"))
                if not key or not student:
                    raise TargetError(f"{path.name}, line {rows.line_num}: an entry or a student is missing")
                if key in found:
                    raise TargetError(f"{path.name}, line {rows.line_num}: the entry stands there twice")
                found[key] = student
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise TargetError(f"{path.name} cannot be read: {type(error).__name__}") from error
    return found


def _split(path: Path) -> tuple[str, str]:
    """Return the key of a path, and the name that it was handed in by."""
    name = _plain(path.name)
    whole = path.is_dir() and not path.is_symlink()
    moodle, canvas = EXPORTS
    if match := moodle.fullmatch(name):
        return match["key"], match["name"] or name
    if not whole and (match := canvas.fullmatch(name)):
        return f"{match['who']}_{match['id']}", match["name"]
    stem = name if whole else Path(name).stem.removesuffix(".tar")
    return stem, name


def _plain(name: str) -> str:
    """Return a name that is the same text on every system, and can be written as UTF-8."""
    text = name.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return unicodedata.normalize("NFC", text)
