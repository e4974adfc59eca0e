"""Handed: the files that a submission consists of, as they are handed to a sandbox."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from radiokit.facts.errors import RadiokitError

__all__ = ["LARGEST", "handed"]

LARGEST = 1 << 28
"""Files of more bytes are no submission."""


def handed(path: Path, content: bytes | None, files: Sequence[Path]) -> dict[str, str | bytes]:
    """Return paths, or contents, by name: of further files and, last, the submission itself.

    Raises
    ------
    RadiokitError
        When a file is not there or too large.

    >>> handed(Path("theirs.py"), b"x = 1", [])
    {'theirs.py': b'x = 1'}
    """
    found: dict[str, str | bytes] = {file.name: _checked(file) for file in files}
    if content is None:
        found[path.name] = _checked(path)
    elif len(content) <= LARGEST:
        found[path.name] = content
    else:
        raise RadiokitError(f"{path.name} has more than {LARGEST} bytes")
    return found


def _checked(file: Path) -> str:
    path = file.resolve()
    if not path.is_file():
        raise RadiokitError(f"no such file: {path}")
    if path.stat().st_size > LARGEST:
        raise RadiokitError(f"{path} has more than {LARGEST} bytes")
    return str(path)
