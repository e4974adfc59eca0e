"""Starts: what the first answer costs in a fresh process, imports included, and the second."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any

import radiokit.facts
from radiokit.facts.errors import RadiokitError

__all__ = ["Start", "starts"]

_PROGRAM = """
import sys, time
method, samples = sys.argv[1], int(sys.argv[2])
times = [time.perf_counter()]
import radiokit as rk
times.append(time.perf_counter())
for seed in range(2):
    rk.albedo(rk.bsdf("ggx", alpha=0.3), (0.6, 0.0, 0.8), method=method, rtol=1e-6, samples=samples, rng=seed)
    times.append(time.perf_counter())
sys.stdout.write(str([b - a for a, b in zip(times, times[1:])]))
"""


@dataclass(frozen=True)
class Start:
    """Seconds of the import, of the first call and of the second, in a process of its own."""

    method: str
    samples: int
    import_seconds: float
    first_seconds: float
    second_seconds: float

    def to_json(self) -> dict[str, Any]:
        """Return the start as JSON-ready data."""
        return asdict(self)


def starts(methods: tuple[str, ...], *, samples: int, repeats: int) -> list[Start]:
    """Measure each method in fresh processes, in turn; medians of the repetitions.

    Raises
    ------
    RadiokitError
        When a process fails.
    """
    root = str(Path(radiokit.facts.__file__).parents[2])
    path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    seen: dict[str, list[list[float]]] = {method: [] for method in methods}
    for _ in range(repeats):
        for method in methods:
            done = subprocess.run(
                [sys.executable, "-c", _PROGRAM, method, str(samples)],
                capture_output=True,
                text=True,
                check=False,
                env=os.environ | {"PYTHONPATH": path},
            )
            if done.returncode:
                raise RadiokitError(f"a fresh process failed: {done.stderr.strip()[-300:]}", method=method)
            seen[method].append(json.loads(done.stdout))
    return [
        Start(method, samples, *(median(column) for column in zip(*runs, strict=True)))
        for method, runs in seen.items()
    ]
