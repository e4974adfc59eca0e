"""Store: the folder of results: one file for each entry, written whole, by one run at a time."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any

from radiokit.faces.grading.classroom.task import write_whole
from radiokit.facts.errors import ParameterError, RadiokitError

__all__ = ["Store", "json_text"]

LONGEST = 120
"""How many bytes of a key are used in a file's name; file systems end at 255."""


def json_text(data: Any) -> str:
    """Return data as JSON text, the same for the same data."""
    return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


class Store:
    """A folder of results.

    ``results/KEY.json`` holds a grade and the fingerprint of what it depends on; ``partial`` holds grades
    of which some questions are done, until they are complete.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.results = folder / "results"
        self.partial = folder / "partial"

    @contextmanager
    def opened(self) -> Iterator[Store]:
        """Make the folder, and keep other runs out of it for the block.

        Raises
        ------
        ParameterError
            When it cannot be written.
        RadiokitError
            When another run is at work in it.
        """
        try:
            for place in (self.results, self.partial):
                place.mkdir(parents=True, exist_ok=True)
            lock = (self.folder / ".lock").open("w")
        except OSError as error:
            allowed = f"a folder that can be written ({error.strerror})"
            raise ParameterError("out", str(self.folder), allowed) from error
        with lock:
            self._lock(lock.fileno())
            yield self

    def _lock(self, descriptor: int) -> None:
        try:
            import fcntl
        except ImportError:  # where there is no sandbox either
            return
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise RadiokitError(f"another run is at work in {self.folder}") from None
        except OSError:  # a file system without locks
            return

    def place(self, key: str) -> Path:
        """Return the file of a result; no key leads out of the folder or to another's file.

        >>> Store(Path("out")).place("Anna Petrova_17").as_posix()
        'out/results/Anna Petrova_17.json'
        """
        plain = re.sub(r"[/\\\x00-\x1f\x7f]|^\.", "_", key).encode()[:LONGEST].decode(errors="ignore")
        if plain != key:
            plain = f"{plain}-{hashlib.sha256(key.encode()).hexdigest()[:12]}"
        return self.results / f"{plain}.json"

    def journal(self, mark: str) -> Path:
        """Return the file of what is done so far of what has this fingerprint."""
        return self.partial / f"{mark[:40]}.json"

    def read(self, key: str) -> dict[str, Any] | None:
        """Return what is stored for a key; None where that is nothing, or no such data."""
        with suppress(OSError, ValueError):
            data = json.loads(self.place(key).read_text(encoding="utf-8"))
            if isinstance(data, dict) and data.get("key") == key and isinstance(data.get("grade"), dict):
                return data
        return None

    def write(self, key: str, mark: str, grade: Mapping[str, Any], *, handed_in: bool) -> None:
        """Store a grade; with an empty ``mark``, so that the next run grades it again."""
        made = {"key": key, "radiokit": version("radiokit"), "fingerprint": mark, "handed_in": handed_in}
        write_whole(self.place(key), json_text({**made, "grade": grade}))

    def settle(self, mark: str) -> None:
        """Remove what was kept of a grade that is complete."""
        self.journal(mark).unlink(missing_ok=True)

    def strangers(self, keys: set[str]) -> int:
        """Return how many results are of no entry; they are left."""
        mine = {self.place(key).name for key in keys}
        return sum(path.name not in mine for path in self.results.glob("*.json"))

    def close(self) -> None:
        """Remove what no run will need again, once all is graded."""
        shutil.rmtree(self.partial, ignore_errors=True)
