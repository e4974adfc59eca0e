"""Mitsuba 3: its roughconductor on the CPU (``llvm_ad_rgb``), sampled alone and in a rendered furnace."""

from __future__ import annotations

import math
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

__all__ = ["Mitsuba", "MitsubaRender"]

VARIANT = "llvm_ad_rgb"
LANES = 1 << 16
"""Samples drawn side by side. Of 2²⁴ samples, two cores draw 416 to 427 million a second in a loop of 2¹⁶
lanes, 426 of 2¹⁴, 388 to 410 of 2¹⁸, 385 of 2²⁰; without a loop 185 to 192, or 355 to 370 with sums in single
precision, in wavefronts of 2²⁰ to 2²⁴."""
PIXELS = 1 << 16
"""Of the image: as fast as 2¹² or 2²⁰, and enough for a standard error good to a third of a percent."""
_AWAY = 8.0  # from the surface to the sensor, whose image is 2 wide

_PROBE = f"""
import mitsuba as mi
mi.set_variant({VARIANT!r})
import drjit as dr
assert dr.sum(mi.Float([1.0, 2.0]))[0] == 3.0
"""


class _OnMitsuba(Peer):
    rival = "mc"

    def absent(self) -> str | None:
        """Return why it cannot run; tried in a process of its own, for a wrong LLVM aborts."""
        return _absent()

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


class Mitsuba(_OnMitsuba):
    """``roughconductor`` with ``material: none``, sampled as fast as Mitsuba can: in a recorded loop.

    ``BSDF.sample`` runs in one kernel of single precision, ``LANES`` samples at a time; the sums are kept in
    double precision within the loop, at no cost, and evaluated together. The seed and the number of rounds
    are no literals of the kernel, so that it is compiled once. Its G is Smith's **separable** one.
    """

    name = f"Mitsuba {VARIANT}"
    note = "in single precision; its G is separable, so its error is against the truth of that"

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo from ``size`` samples, rounded down to a multiple of ``LANES`` above that."""
        import drjit as dr

        mi, bsdf, context = _plugin(alpha)
        lanes = min(LANES, int(size))
        rounds = int(size) // lanes
        view, ends = towards(theta_deg), dr.opaque(mi.UInt32, rounds)

        def step(done: Any, random: Any, total: Any, squares: Any) -> tuple[Any, ...]:
            interaction = dr.zeros(mi.SurfaceInteraction3f)
            interaction.wi = mi.Vector3f(*view)
            points = mi.Point2f(random.next_float32(), random.next_float32())
            _, weight = bsdf.sample(context, interaction, mi.Float(0.5), points)
            value = mi.Float64(weight[0])
            return done + 1, random, total + value, squares + value * value

        _, _, total, squares = dr.while_loop(
            (
                mi.UInt32(0),
                mi.PCG32(size=lanes, initstate=dr.opaque(mi.UInt64, seed % 2**62)),
                dr.zeros(mi.Float64, lanes),
                dr.zeros(mi.Float64, lanes),
            ),
            lambda done, *_: done < ends,
            step,
        )
        dr.eval(total, squares)
        return mean_of(float(np.sum(total)), float(np.sum(squares)), lanes * rounds, self.name)


class MitsubaRender(_OnMitsuba):
    """``mi.render`` of a furnace: a rectangle of that ``roughconductor`` in an environment of radiance 1.

    An orthographic sensor looks at it, so that each camera ray meets it at the same polar angle. The
    integrator is ``direct`` with one sample of the BSDF and none of the emitter, which is faster than
    ``path`` here. With a box filter each pixel is the mean of its own samples, and the pixels' spread gives
    the standard error.
    """

    name = f"Mitsuba {VARIANT} render"
    note = "camera, ray tracing and film included; in single precision, against the truth of a separable G"

    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the mean of an image of ``size`` samples, rounded down to a multiple of its pixels."""
        bits = min(PIXELS, int(size)).bit_length() - 1
        per_pixel = int(size) >> bits
        mi, scene = _furnace(alpha, theta_deg, bits)
        image = np.asarray(mi.render(scene, spp=per_pixel, seed=seed % 2**32), dtype=np.float64)
        error = float(np.std(image, ddof=1)) / math.sqrt(image.size)
        return Estimate(float(np.mean(image)), error, "statistical", per_pixel << bits, method=self.name)


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


def _material(alpha: float) -> dict[str, Any]:
    return {"type": "roughconductor", "distribution": "ggx", "alpha": alpha, "material": "none"}


@cache
def _plugin(alpha: float) -> tuple[Any, Any, Any]:
    import mitsuba as mi

    mi.set_variant(VARIANT)
    return mi, mi.load_dict(_material(alpha)), mi.BSDFContext()


@cache
def _furnace(alpha: float, theta_deg: float, bits: int) -> tuple[Any, Any]:
    import mitsuba as mi

    mi.set_variant(VARIANT)
    # The rectangle is seen whole: its part in view is 2 long, divided by the cosine.
    view = towards(theta_deg)
    film = {"width": 1 << (bits + 1) // 2, "height": 1 << bits // 2, "rfilter": {"type": "box"}}
    film |= {"pixel_format": "luminance", "component_format": "float32"}
    at = {"origin": [(_AWAY + 1 / view[2]) * x for x in view], "target": [0, 0, 0], "up": [0, 1, 0]}
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "bsdf_samples": 1, "emitter_samples": 0},
        "sensor": {
            "type": "orthographic",
            "to_world": mi.ScalarTransform4f().look_at(**at),
            "film": {"type": "hdrfilm", **film},
            "sampler": {"type": "independent"},
        },
        "surface": {
            "type": "rectangle",
            "to_world": mi.ScalarTransform4f().scale(4 / view[2]),
            "bsdf": _material(alpha),
        },
        "environment": {"type": "constant", "radiance": 1.0},
    }
    return mi, mi.load_dict(scene)
