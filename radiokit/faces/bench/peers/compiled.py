"""C: the estimate as a vectorised, threaded loop, built by the system's compiler when it is first wanted."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import tempfile
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from radiokit.faces.bench.peers.peer import Peer, mean_of
from radiokit.faces.bench.tasks import towards
from radiokit.facts.estimate import Estimate

__all__ = ["FLAGS", "Compiled", "build", "compiler_version"]

FLAGS = ("-O3", "-march=native", "-ffast-math", "-fopenmp", "-fPIC")


class Compiled(Peer):
    """Visible normals with the weight G₂/G₁ in C with OpenMP and double precision: ``ggx.c`` beside this."""

    name = "C, OpenMP"
    rival = "mc"

    def absent(self) -> str | None:
        """Return what is wrong with the compiler, if something is."""
        return build()[1] or None

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo from ``size`` samples."""
        sums = (ctypes.c_double * 2)()
        sine, _, cosine = towards(theta_deg)
        build()[0](alpha, sine, cosine, int(size), seed % 2**64, sums)
        return mean_of(sums[0], sums[1], int(size), self.name)


@cache
def compiler_version() -> str | None:
    """Return what the compiler calls itself; None when it is not there."""
    found = shutil.which(os.environ.get("CC") or "cc")
    if found is None:
        return None
    done = subprocess.run([found, "--version"], capture_output=True, text=True, check=False)
    return next(iter(done.stdout.splitlines()), None)


@cache
def build(compiler: str | None = None) -> tuple[Any, str]:
    """Return the compiled function and no reason, or None and the reason why there is none.

    ``compiler`` is what the environment variable CC names, or ``cc``.

    >>> build("no-such-compiler")[1]
    "no C compiler: 'no-such-compiler' was not found; install one, or name it in CC"
    """
    wanted = compiler or os.environ.get("CC") or "cc"
    found = shutil.which(wanted)
    if found is None:
        return None, f"no C compiler: {wanted!r} was not found; install one, or name it in CC"
    source = files("radiokit.faces.bench.peers").joinpath("ggx.c").read_text(encoding="utf-8")
    # Windows does not delete a library that is loaded; its folder is left to the system.
    with tempfile.TemporaryDirectory(prefix="radiokit-", ignore_cleanup_errors=True) as folder:
        unit, library = Path(folder) / "ggx.o", Path(folder) / "ggx.so"
        # Linked with -ffast-math, a library turns denormals off in the process that loads it.
        for arguments in (
            (*FLAGS, "-c", "-x", "c", "-", "-o", str(unit)),
            ("-shared", "-fopenmp", str(unit), "-o", str(library), "-lm"),
        ):
            done = subprocess.run(
                [found, *arguments], input=source, capture_output=True, text=True, check=False
            )
            if done.returncode:
                lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
                return None, f"{wanted} {' '.join(FLAGS)} failed: {lines[0]}"
        function = ctypes.CDLL(str(library)).ggx_albedo
    function.argtypes = [ctypes.c_double] * 3 + [ctypes.c_int64, ctypes.c_uint64, ctypes.c_void_p]
    function.restype = None
    return function, ""
