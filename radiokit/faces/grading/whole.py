"""Whole: files that are never half written, for all that writes grades."""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ["clear_drafts", "write_whole"]


def write_whole(path: Path, text: str) -> None:
    """Write a file such that it is there whole, or as it was, whenever this process ends.

    Raises
    ------
    OSError
        When it cannot be written.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}.draft")
    try:
        draft.write_text(text, encoding="utf-8")
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)


def clear_drafts(folder: Path) -> None:
    """Remove from a folder what is left of processes that were killed while they wrote."""
    for draft in folder.glob(".*.draft"):
        draft.unlink(missing_ok=True)
