"""Cache: verified proofs kept in the user's cache folder; a file that is not as expected is ignored."""

from __future__ import annotations

import hashlib
import json
import os
import sys
import tempfile
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from radiokit.facts.verdict import Outcome
from radiokit.physics.relations.verify import Finding, How

if TYPE_CHECKING:
    from radiokit.physics.relations.derivation import Derivation

__all__ = ["folder", "load", "store"]


def folder() -> Path:
    """Return where proofs are kept: ``RADIOKIT_CACHE_DIR``, or the system's folder for caches."""
    if named := os.environ.get("RADIOKIT_CACHE_DIR"):
        return Path(named) / "proofs"
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "radiokit" / "proofs"


@cache
def _tools() -> str:
    """Return the versions that a proof depends on, and a hash of the code that verifies."""
    code = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        code.update(path.read_bytes())
    return f"{version('radiokit')} {version('sympy')} {version('mpmath')} {code.hexdigest()}"


def _key(derivation: Derivation) -> str:
    return hashlib.sha256(f"{_tools()} {derivation.fingerprint()}".encode()).hexdigest()


def load(derivation: Derivation) -> tuple[Finding, ...] | None:
    """Return the kept findings of this very derivation, or None."""
    try:
        data = json.loads((folder() / f"{derivation.name}.json").read_text(encoding="utf-8"))
        if data["key"] != _key(derivation) or len(data["findings"]) != len(derivation.steps):
            return None
        return tuple(map(_finding, data["findings"]))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RuntimeError):
        return None


def _finding(data: dict[str, Any]) -> Finding:
    if data["how"] not in get_args(How) or not isinstance(data["message"], str):
        raise ValueError(data)
    return Finding(
        outcome=Outcome(data["outcome"]),
        how=data["how"],
        message=data["message"],
        seconds=float(data["seconds"]),
    )


def store(derivation: Derivation) -> None:
    """Keep the findings where there is room, unless one is undecided, since more time may decide it."""
    if derivation.outcome is Outcome.INCONCLUSIVE:
        return
    text = json.dumps(
        {"key": _key(derivation), "findings": [finding.to_json() for finding in derivation.findings]}
    )
    try:
        folder().mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=folder(), suffix=".part")
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        Path(name).replace(folder() / f"{derivation.name}.json")
    except (OSError, RuntimeError):
        return
