"""Mitsuba 3: its roughconductor on the CPU (``llvm_ad_rgb``), a wavefront of samples at a time."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from radiokit.bsdfs.ggx import GGX
from radiokit.contracts.albedo import integrand
from radiokit.contracts.bsdf import FloatArray
from radiokit.faces.bench.peers.peer import Peer, mean_of
from radiokit.faces.bench.tasks import converged, towards
from radiokit.facts.estimate import Estimate

__all__ = ["Mitsuba"]

VARIANT = "llvm_ad_rgb"
WAVEFRONT = 1 << 20

_PROBE = f"""
import mitsuba as mi
mi.set_variant({VARIANT!r})
import drjit as dr
assert dr.sum(mi.Float([1.0, 2.0]))[0] == 3.0
"""


class Mitsuba(Peer):
    """``roughconductor`` with ``material: none``, in single precision; its G is Smith's **separable** one."""

    name = f"Mitsuba {VARIANT}"
    rival = "mc"
    note = "in single precision; its G is separable, so its error is against the truth of that"

    def absent(self) -> str | None:
        """Return why it cannot run; tried in a process of its own, for a wrong LLVM aborts."""
        return _absent()

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo from ``size`` samples."""
        import drjit as dr

        samples, total, squares = int(size), 0.0, 0.0
        mi, bsdf, context = _plugin(alpha)
        for first in range(0, samples, WAVEFRONT):
            lanes = min(WAVEFRONT, samples - first)
            random = mi.PCG32(size=lanes, initstate=seed % 2**62 + first)
            interaction = dr.zeros(mi.SurfaceInteraction3f, lanes)
            interaction.wi = mi.Vector3f(*towards(theta_deg))
            points = mi.Point2f(random.next_float32(), random.next_float32())
            _, weight = bsdf.sample(context, interaction, mi.Float(0.5), points)
            # Each lane's sum is in single precision; the tree of the reduction keeps its digits.
            value = mi.Float64(weight[0])
            sums = dr.sum(value), dr.sum(value * value)
            total, squares = total + float(sums[0][0]), squares + float(sums[1][0])
        return mean_of(total, squares, samples, self.name)

    def truth(self, alpha: float, theta_deg: float) -> float:
        """Return the albedo with G₁(i) G₁(o) in place of the height-correlated G₂."""
        wo = np.array(towards(theta_deg))
        correlated = integrand(GGX(alpha=alpha), wo, "wo")

        def smith(w: Any) -> Any:  # Λ
            tan2 = (w[..., 0] ** 2 + w[..., 1] ** 2) / w[..., 2] ** 2
            return alpha**2 * tan2 / (2 * (np.sqrt(1 + alpha**2 * tan2) + 1))

        def separable(wi: FloatArray) -> Any:
            a, b = smith(wi), smith(wo)
            return correlated(wi) * (1 + a + b) / ((1 + a) * (1 + b))

        return converged(separable, alpha, theta_deg)[0]


@cache
def _absent() -> str | None:
    if find_spec("mitsuba") is None:
        return "mitsuba is not installed: pip install 'radiokit[mitsuba]'"
    done = subprocess.run([sys.executable, "-c", _PROBE], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return None
    named = os.environ.get("DRJIT_LIBLLVM_PATH")
    where = f"with DRJIT_LIBLLVM_PATH = {named!r}" if named else "and DRJIT_LIBLLVM_PATH is not set"
    return (
        f"mitsuba is installed, but {VARIANT} does not run {where}: install LLVM 16 or later (Debian: "
        "libllvm19) and name its libLLVM.so there"
    )


@cache
def _plugin(alpha: float) -> tuple[Any, Any, Any]:
    import mitsuba as mi

    mi.set_variant(VARIANT)
    bsdf = mi.load_dict({"type": "roughconductor", "distribution": "ggx", "alpha": alpha, "material": "none"})
    return mi, bsdf, mi.BSDFContext()
