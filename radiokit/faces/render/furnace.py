"""Furnace: the picture of a body in a furnace of its own temperature, into which every body must vanish.

In a cavity of one temperature the radiance is the same everywhere and in all directions, whatever is in it
(Kirchhoff): what a body does not reflect of it, it emits. So the radiance 1 of the walls that a body
reflects, found by sampling the material, and its emissivity, the absorptance that a quadrature finds for
light from the viewer's side, must add up to 1 in every pixel. A sampler that is a little off, a gain of
energy and a lack of reciprocity all show as a visible body.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.albedo import albedo
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.emitters.constant import Constant
from radiokit.faces.render.picture import Image
from radiokit.faces.render.pixels import followed
from radiokit.faces.render.scenes import make_setting
from radiokit.faces.workers import SerialExecutor
from radiokit.facts.directions import frame, to_local
from radiokit.facts.estimate import Estimate
from radiokit.facts.verdict import TOLERANCE, Evidence, Outcome, Verdict, Witness
from radiokit.measure.montecarlo import block_generator, seed_from
from radiokit.measure.statistics import sidak, z_test
from radiokit.worlds.shading import shade

__all__ = ["FurnaceImage", "furnace_image"]

FloatArray = npt.NDArray[np.float64]

SAMPLES = 1 << 14
_CHUNK = 8  # directions in a task
_RESOLUTION = 0.05  # a larger error than this proves nothing


@dataclass(frozen=True)
class _Balance:
    """What a direction (3,) receives: reflected of radiance 1, and the emissivity, before it is cut at 0."""

    wo: FloatArray
    reflected: Estimate
    emissivity: Estimate

    @property
    def total(self) -> Estimate:
        """What is reflected and what is emitted; nothing can emit less than 0."""
        return self.reflected + replace(self.emissivity, value=np.maximum(self.emissivity.value, 0.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class FurnaceImage(Image):
    """The picture of a sphere in an isothermal furnace: its values are 1 where it has vanished.

    ``reflected`` and ``emissivity`` (H, W) or (H, W, K) are its two parts, 1 and 0 beside the sphere.
    """

    reflected: FloatArray
    emissivity: FloatArray
    model: BSDF
    balances: tuple[_Balance, ...]

    def verdict(self, level: float = 1e-6) -> Verdict:
        """Judge whether the body vanishes into its background of radiance 1.

        Bounds must hold; statistical pixels are put to a z-test, whose level is shared by all directions
        and wavelengths.
        A negative emissivity is a violation by itself: no body can make up for light that it gains.

        >>> from radiokit.bsdfs.lambert import Lambert
        >>> furnace_image(Lambert(reflectance=0.5), size=6).verdict().outcome.value
        'holds'
        """
        share = sidak(level, sum(np.size(each.total.value) for each in self.balances))
        worst: tuple[float, _Balance] | None = None
        doubt, lowest = "", 1.0
        for each in self.balances:
            total, emitted = each.total, each.emissivity
            off, error = np.abs(np.asarray(total.value) - 1.0), np.asarray(total.error)
            gains = np.asarray(emitted.value) + np.asarray(emitted.error) < -TOLERANCE
            if total.is_bound:
                wrong = bool(np.any(off > error + TOLERANCE))
            else:
                beyond = Estimate(np.maximum(off - TOLERANCE, 0.0), error, "statistical", dof=total.dof)
                p_value = float(np.min(z_test(beyond, 0.0)))
                wrong, lowest = p_value < share, min(lowest, p_value)
            if not np.all(np.isfinite(total.value)) or np.any(gains) or wrong:
                size = float(np.max(off))
                if worst is None or size > worst[0]:
                    worst = (size, each)
            elif not (total.converged and np.all(error <= _RESOLUTION)):
                doubt = doubt or total.note or f"the error is above {_RESOLUTION:g}"
        outcome = Outcome.VIOLATED if worst else Outcome.INCONCLUSIVE if doubt else Outcome.HOLDS
        measured = any(not each.total.is_bound for each in self.balances)
        message = f"{len(self.balances)} directions, error at most {self.worst_error:.1e}"
        if worst:
            message = self._fault(worst[1])
        return Verdict(
            check="furnace",
            claim="in a furnace of its own temperature the body has the radiance of the walls",
            outcome=outcome,
            evidence=Evidence.REFUTED if worst else Evidence.MEASURED if measured else Evidence.BOUNDED,
            message=doubt if doubt and not worst else message,
            witness=_witness(worst[1]) if worst else None,
            limit=1.0,
            p_value=lowest if measured else None,
            evaluations=self.evaluations,
            seconds=self.seconds,
            details={"directions": len(self.balances), "level": level},
        )

    def _fault(self, found: _Balance) -> str:
        theta = math.degrees(math.atan2(math.hypot(found.wo[0], found.wo[1]), abs(found.wo[2])))
        text = f"at {theta:.3g}° it reflects {found.reflected} and emits {found.emissivity}"
        if np.any(np.asarray(found.emissivity.value) < -TOLERANCE):
            text += ", which is less than nothing: it gains energy"
        claims = self.model.claims
        said = [] if claims is None else ["does not conserve energy"] * (not claims.conserves)
        said += ["is not reciprocal"] * (claims is not None and claims.reciprocity == "no")
        return f"{text}; it claims that it {' and '.join(said)}" if said else text

    def to_json(self) -> dict[str, Any]:
        """Return what there is to say of the picture, and the verdict, as JSON-ready data."""
        return super().to_json() | {"verdict": self.verdict().to_json()}


def furnace_image(
    f: BSDF | Callable[..., Any],
    *,
    size: int = 64,
    method: str = "mc-bsdf",
    samples: int | None = None,
    rtol: float | None = None,
    rng: int | np.random.Generator | None = 0,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> FurnaceImage:
    """Return the picture of a sphere in a furnace of its own temperature and of radiance 1.

    The reflected part is that of ``shade`` by ``method``, so by sampling the material unless another is
    named; where light passes, it is the albedo by Monte Carlo, for light comes from both sides. The emitted
    part is the emissivity 1 − ∫ f |cosθ| dω for light that arrives from the viewer, by quadrature. Directions
    that an isotropic material cannot tell apart are computed once.

    Parameters
    ----------
    f : BSDF or callable
    size : int
        Width and height in pixels.
    method : str
        As for ``shade``. Delta lobes are looked up, whatever it says.
    samples : int, optional
        For each direction; 2¹⁴ without a tolerance.
    rtol : float, optional
        As for ``shade``.
    rng, executor, progress
        As for ``render``.

    Raises
    ------
    ParameterError, UnknownNameError, RadiokitError
        As ``render`` does.

    Source: Kirchhoff (1860), doi:10.1002/andp.18601850205.

    >>> from radiokit.bsdfs.ggx import GGX
    >>> picture = furnace_image(GGX(alpha=0.5, eta=0.2, k=3.0), size=8)
    >>> print(picture.verdict().outcome, bool(abs(picture.values - 1).max() < 0.02))
    holds True
    """
    start = time.perf_counter()
    setting = make_setting("sphere", f, light="isothermal", size=size)
    model, seed = as_bsdf(f), seed_from(rng)
    hits, rays = setting.trace(setting.camera), setting.camera.rays
    surface = hits.material >= 0
    wo, which = _directions(model, hits.normal[surface], -rays[surface])
    if samples is None and rtol is None:
        samples = SAMPLES
    chunks = [np.arange(first, min(first + _CHUNK, len(wo))) for first in range(0, len(wo), _CHUNK)]
    work = partial(_balance, model, wo, method, samples, rtol, seed)
    parts = followed((executor or SerialExecutor()).map(work, chunks), len(chunks), progress)
    balances = tuple(each for part in parts for each in part)
    totals = [each.total for each in balances]
    tail = np.shape(totals[0].value)

    def spread(values: list[Any], beside: float) -> FloatArray:
        picture = np.full((size, size, *tail), beside)
        picture[surface] = np.stack([np.broadcast_to(value, tail) for value in values])[which]
        return picture

    def marked(values: list[bool], beside: bool) -> npt.NDArray[np.bool_]:
        picture = np.full((size, size), beside)
        picture[surface] = np.array(values)[which]
        return picture

    return FurnaceImage(
        values=spread([each.value for each in totals], 1.0),
        error=spread([each.error for each in totals], 0.0),
        statistical=marked([not each.is_bound for each in totals], False),
        converged=marked([each.converged for each in totals], True),
        surface=surface,
        evaluations=sum(each.evaluations for each in totals),
        seconds=time.perf_counter() - start,
        about={
            "scene": "sphere",
            "light": "isothermal",
            "materials": [repr(model)],
            "method": method,
            "rtol": rtol,
            "samples": samples,
            "seed": seed,
        },
        reflected=spread([each.reflected.value for each in balances], 1.0),
        emissivity=spread([each.emissivity.value for each in balances], 0.0),
        model=model,
        balances=balances,
    )


def _directions(
    model: BSDF, normal: FloatArray, towards: FloatArray
) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Return the local directions that differ (n, 3), and which of them each pixel has."""
    local = to_local(frame(normal), towards)
    local[:, 2] = np.maximum(local[:, 2], 1e-9)  # what is seen is above the horizon
    local /= np.linalg.norm(local, axis=1)[:, None]
    if not model.isotropic:
        return local, np.arange(len(local))
    _, first, which = np.unique(np.round(local[:, 2], 12), return_index=True, return_inverse=True)
    flat = local[first]
    sine = np.hypot(flat[:, 0], flat[:, 1])
    return np.stack([sine, np.zeros_like(sine), flat[:, 2]], axis=-1), which


def _balance(
    model: BSDF,
    wo: FloatArray,
    method: str,
    samples: int | None,
    rtol: float | None,
    seed: int,
    numbers: npt.NDArray[np.intp],
) -> list[_Balance]:
    """Return the balances of some of the directions."""
    found = []
    only_delta = (claims := model.claims) is not None and claims.delta
    for number in numbers:
        w, generator = wo[number], block_generator(seed, int(number))
        if model.transmissive:
            reflected = albedo(model, w, method="mc", samples=samples, rtol=rtol, rng=generator)
        else:
            reflected = shade(
                model,
                Constant(radiance=1.0),
                w,
                method="auto" if only_delta else method,
                rtol=1e-3 if rtol is None else rtol,
                samples=samples,
                rng=generator,
            )
        absorbed = albedo(model, w, fixed="wi", rtol=1e-8)
        emissivity = replace(absorbed, value=1.0 - absorbed.value)
        found.append(_Balance(w, reflected, emissivity))
    return found


def _witness(found: _Balance) -> Witness:
    return Witness(
        {"wo": found.wo.tolist()},
        {"reflected": found.reflected.value, "emissivity": found.emissivity.value, "sum": found.total.value},
    )
