"""Parts: the hemispheres into which a surface scatters, each turned so that it is seen from above."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.checks.probes import channels
from radiokit.contracts.albedo import Side, directional_albedo
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.directions import refract
from radiokit.facts.estimate import Estimate

__all__ = [
    "Part",
    "brighter",
    "delta_share",
    "flipped",
    "index_squared",
    "mean_weight",
    "parts",
    "scattered",
    "share",
]

LEAST_COSINE = 0.01
"""The aim at light that leaves along the surface: close to it, and above it."""


@dataclass(frozen=True)
class Part:
    """Scattering into one hemisphere, in a frame where the fixed and the other direction have z > 0."""

    f: BSDF
    fixed: Side
    below: bool = False  # whether the fixed direction is below the surface
    through: bool = False  # whether the other one is on the other side of it

    def aim(self, w: FloatArray) -> FloatArray:
        """Return the directions (..., 3) at whose mirror images the lobe lies: ``w`` itself in reflection."""
        if not self.through:
            return w
        eta = self.f.relative_index()
        to, _ = refract(w, eta=1 / eta if self.below else eta)
        across = -to[..., :2]
        up = np.maximum(-to[..., 2:], LEAST_COSINE)
        length = np.sqrt(across[..., :1] ** 2 + across[..., 1:] ** 2 + up**2)
        return np.concatenate([across, up], axis=-1) / length

    def values(self, held: FloatArray, other: FloatArray) -> Any:
        """Return f [sr⁻¹] for pairs of this frame."""
        return self._call(self.f.evaluate, held, other)

    def density(self, held: FloatArray, other: FloatArray) -> Any:
        """Return the sampler's density [sr⁻¹] for pairs of this frame."""
        return self._call(self.f.pdf, held, other)

    def integrand(self, w: FloatArray) -> Callable[[FloatArray], Any]:
        """Return other ↦ f cosθ with ``w`` (3,) held fixed."""

        def value(other: FloatArray) -> Any:
            return (self.values(np.broadcast_to(w, other.shape), other).T * other[:, 2]).T

        return value

    def _call(self, function: Callable[..., Any], held: FloatArray, other: FloatArray) -> Any:
        held, other = flipped(held, self.below), flipped(other, self.below != self.through)
        return function(other, held) if self.fixed == "wo" else function(held, other)


def parts(f: BSDF, fixed: Side, below: bool = False) -> tuple[Part, ...]:
    """Return what a surface does with light: it reflects, and it may transmit."""
    reflected = Part(f, fixed, below)
    return (reflected, Part(f, fixed, below, through=True)) if f.transmissive else (reflected,)


def flipped(w: FloatArray, below: bool) -> FloatArray:
    """Return directions mirrored at the surface if ``below``, else as they are."""
    return w * np.array([1.0, 1.0, -1.0]) if below else w


def index_squared(f: BSDF, w: FloatArray) -> npt.NDArray[np.float64]:
    """Return n(w)², the squared index on the side of each direction, relative to that above the surface."""
    below = f.relative_index() ** 2 if f.transmissive else 1.0
    return np.where(w[..., 2] < 0, below, 1.0)


def delta_share(
    f: BSDF, w: FloatArray, side: Literal["reflected", "transmitted"] | None = None
) -> FloatArray:
    """Return the share of the flux of ``w`` (N, 3) that is in delta lobes, all or one side's, as (N, K)."""
    total = np.zeros((len(w), 1))
    for lobe in f.delta_lobes(w):
        weight = channels(lobe.weight)
        if side is not None:
            crosses = (lobe.wi[..., 2] < 0) != (w[..., 2] < 0)
            weight = weight * (crosses == (side == "transmitted"))[:, None]
        total = total + weight
    return total


def brighter(f: BSDF, wo: FloatArray) -> float:
    """Return n(wo)² / n(wi)² for light that came through the surface: by how much its radiance has grown."""
    return float(index_squared(f, wo) / index_squared(f, -wo))


def share(
    f: BSDF,
    w: FloatArray,
    *,
    fixed: Side,
    side: Literal["reflected", "transmitted"],
    width: float | None = None,
    rtol: float = 1e-8,
    atol: float = 0.0,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Return the share of the flux of ``w`` (3,), on either side, that is reflected or transmitted.

    For fixed wi it is ∫ f |cosθo| dωo over the hemisphere of ``w`` or over the other one; for fixed wo the
    same of f n(wi)² / n(wo)², which for a reciprocal f is the same number. Delta lobes are included.
    """
    tolerances: dict[str, Any] = {"rtol": rtol, "atol": atol, "max_evaluations": max_evaluations}
    return directional_albedo(f, w, fixed=fixed, side=side, width=width, **tolerances)


def scattered(
    f: BSDF,
    w: FloatArray,
    *,
    fixed: Side,
    widths: tuple[float | None, ...] = (None, None),
    rtol: float = 1e-8,
    atol: float = 0.0,
    max_evaluations: int = 4_000_000,
) -> Estimate:
    """Return the share of the flux of ``w`` (3,) that is scattered anywhere, delta lobes included."""
    if not f.transmissive:
        return directional_albedo(
            f, w, fixed=fixed, width=widths[0], rtol=rtol, atol=atol, max_evaluations=max_evaluations
        )
    tolerances: dict[str, Any] = {"rtol": rtol, "atol": atol / 2, "max_evaluations": max_evaluations // 2}
    one = share(f, w, fixed=fixed, side="reflected", width=widths[0], **tolerances)
    two = share(f, w, fixed=fixed, side="transmitted", width=widths[1], **tolerances)
    return _sum(one, two)


def mean_weight(f: BSDF, wo: FloatArray, *, rtol: float, max_evaluations: int) -> Estimate:
    """Return ∫ f |cosθi| dωi and the delta lobes' part of it: the mean weight of a right sampler at ``wo``.

    A weight is one of radiance: what comes through the surface is not a share of the flux but brighter.
    """
    if not f.transmissive:
        return scattered(f, wo, fixed="wo", rtol=rtol, max_evaluations=max_evaluations)
    tolerances: dict[str, Any] = {"rtol": rtol, "max_evaluations": max_evaluations // 2}
    one = share(f, wo, fixed="wo", side="reflected", **tolerances)
    return _sum(one, share(f, wo, fixed="wo", side="transmitted", **tolerances), brighter(f, wo))


def _sum(one: Estimate, two: Estimate, scale: float = 1.0) -> Estimate:
    return replace(
        one,
        value=one.value + scale * two.value,
        error=one.error + scale * two.error,
        evaluations=one.evaluations + two.evaluations,
        seconds=one.seconds + two.seconds,
        converged=one.converged and two.converged,
        note="; ".join(dict.fromkeys(note for note in (one.note, two.note) if note)),
    )
