"""Machine: what the bench ran on and with, for ratios mean little without it."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from radiokit.faces.bench.peers.compiled import FLAGS, compiler_version
from radiokit.faces.validate import machine
from radiokit.measure.passes import processors

__all__ = ["whole_machine"]


def whole_machine() -> dict[str, str]:
    """Return the versions, the processor, and how many threads radiokit uses.

    >>> whole_machine()["threads"] >= "1"
    True
    """
    found = machine() | {"threads": str(processors())}
    for package in ("numba", "mitsuba", "drjit"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    compiler, model = compiler_version(), _model()
    if compiler is not None:
        found["compiler"] = f"{compiler} {' '.join(FLAGS[:4])}"
    if model is not None:
        found["processor"] = model
    return found


def _model() -> str | None:
    """Return the processor's name, where the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return None
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), None)
