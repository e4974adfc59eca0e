"""Starts: what the first answer costs in a fresh process, imports included, and the second."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any

import radiokit.facts
from radiokit.facts.errors import RadiokitError
from radiokit.measure.kernels import numba_runs

__all__ = ["Start", "starts"]

_PROGRAM = """
import sys, time
method, samples = sys.argv[1], int(sys.argv[2])
times = [time.perf_counter()]
import numpy
times.append(time.perf_counter())
import radiokit as rk
times.append(time.perf_counter())
more = {"rtol": 1e-6} if method == "quadrature" else {"method": method, "samples": samples}
for seed in range(2):
    rk.albedo(rk.bsdf("ggx", alpha=0.3), (0.6, 0.0, 0.8), rng=seed, **more)
    times.append(time.perf_counter())
sys.stdout.write(str([b - a for a, b in zip(times, times[1:])]))
"""


@dataclass(frozen=True)
class Start:
    """Seconds of the imports, of the first call and of the second, in a process of its own.

    ``import_seconds`` is what ``import radiokit`` adds to ``import numpy``. ``cache`` is the state of Numba's
    cache of machine code: ``cold`` when it is empty, ``warm`` in every later process; empty where nothing is
    compiled.
    """

    method: str
    cache: str
    samples: int
    numpy_seconds: float
    import_seconds: float
    first_seconds: float
    second_seconds: float

    @property
    def total_seconds(self) -> float:
        """Seconds from nothing imported to the first answer."""
        return self.numpy_seconds + self.import_seconds + self.first_seconds

    def to_json(self) -> dict[str, Any]:
        """Return the start as JSON-ready data."""
        return asdict(self) | {"total_seconds": self.total_seconds}


def starts(methods: tuple[str, ...], *, samples: int, repeats: int) -> list[Start]:
    """Measure each method in fresh processes, in turn; medians of the repetitions.

    ``mc`` is compiled: it is measured with an empty cache of Numba's, and again with what that has left.

    Raises
    ------
    RadiokitError
        When a process fails.
    """
    compiled = ("cold", "warm") if numba_runs() else ("",)
    todo = [(method, cache) for method in methods for cache in (compiled if method == "mc" else ("",))]
    seen: dict[tuple[str, str], list[list[float]]] = {each: [] for each in todo}
    for _ in range(repeats):
        with tempfile.TemporaryDirectory(prefix="radiokit-", ignore_cleanup_errors=True) as folder:
            for each in todo:
                seen[each].append(_start(each[0], samples, folder))
    return [
        Start(method, cache, samples, *(median(column) for column in zip(*runs, strict=True)))
        for (method, cache), runs in seen.items()
    ]


def _start(method: str, samples: int, cache: str) -> list[float]:
    root = str(Path(radiokit.facts.__file__).parents[2])
    path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH"))))
    done = subprocess.run(
        [sys.executable, "-c", _PROGRAM, method, str(samples)],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": path, "NUMBA_CACHE_DIR": cache},
    )
    if done.returncode:
        raise RadiokitError(f"a fresh process failed: {done.stderr.strip()[-300:]}", method=method)
    found: list[float] = json.loads(done.stdout)
    return found
