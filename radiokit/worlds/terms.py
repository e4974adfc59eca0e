"""Terms: one light on one material, computed by sum, closed form, quadrature or Monte Carlo."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.facts.errors import NonFiniteError, RadiokitError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure import lowdiscrepancy
from radiokit.measure.lattice import kronecker
from radiokit.measure.lune import lune
from radiokit.measure.montecarlo import mean
from radiokit.measure.quadrature import hemisphere
from radiokit.worlds.finite import over_light
from radiokit.worlds.scene import Receiver

__all__ = ["DELTA_LIGHT", "DELTA_LOBES", "SMOOTH", "Part", "Term"]

FloatArray = npt.NDArray[np.float64]
Part = Literal["delta light", "delta lobes", "smooth"]

DELTA_LIGHT: Part = "delta light"
DELTA_LOBES: Part = "delta lobes"
SMOOTH: Part = "smooth"

MIS_SOURCE = Source(
    authors="Veach, Guibas",
    year=1995,
    title="Optimally combining sampling techniques for Monte Carlo rendering",
    doi="10.1145/218380.218498",
    equation="balance heuristic, section 3.2",
)

MAX_SAMPLES = 1 << 20
"""Samples drawn at most when only a tolerance is given."""

_SAME_DIRECTION = 1e-9  # a sample this near a delta lobe came from it: any other does so once in 1e18
_EPS = float(np.finfo(float).eps)
_GUARD = 512  # lattice points that must confirm a quadrature over the light's own square
_BLIND = 4096  # the same for a material that is sampled without regard to its lobe


@dataclass(frozen=True, eq=False)
class Term:
    """The light of one emitter that one material sends towards ``wo`` (3,), in the receiver's frame.

    ``part`` says which product it is: a delta light's, that of a light with the material's delta lobes, or
    that of a light with the rest of the material.
    """

    f: BSDF
    light: Emitter
    receiver: Receiver
    wo: FloatArray
    part: Part

    @cached_property
    def lobes(self) -> FloatArray:
        """The directions (K, 3) of the material's delta lobes."""
        found = [lobe.wi for lobe in self.f.delta_lobes(self.wo[None, :])]
        return np.concatenate(found) if found else np.zeros((0, 3))

    @cached_property
    def only_delta(self) -> bool:
        """Whether the material has nothing but delta lobes."""
        claims: Any = self.f.claims  # None for a stranger's function
        return claims is not None and bool(claims.delta)

    @property
    def exists(self) -> bool:
        """Whether the light and the material make such a product at all."""
        if self.part == DELTA_LOBES:
            return self.only_delta or len(self.lobes) > 0
        return self.part == DELTA_LIGHT or not self.only_delta

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of one value: () for one wavelength, (K,) for K of them."""
        up = np.array([[0.0, 0.0, 1.0]])
        return tuple(np.shape(self.f.evaluate(up, self.wo[None, :]))[1:])

    def zero(self, note: str = "") -> Estimate:
        """Return 0, exactly."""
        nothing: Any = np.zeros(self.shape) if self.shape else 0.0
        return Estimate(nothing, nothing, "rounding", method="sum", note=note)

    # --- what is exact ---

    def add_up(self) -> Estimate:
        """Sum over the directions of a delta light, or over the delta lobes of the material."""
        start = time.perf_counter()
        if self.part == DELTA_LOBES:
            total: Any = 0.0
            lobes = self.f.delta_lobes(self.wo[None, :])
            for lobe in lobes:
                towards = self.receiver.to_world(lobe.wi)
                radiance = self.light.radiance_from(towards, self.receiver.origin)
                total = total + _times(lobe.weight, radiance)[0]
            seconds = time.perf_counter() - start
            return Estimate(total, 8 * _EPS * np.abs(total), "rounding", len(lobes), seconds, "sum")
        if self.only_delta:
            return self.zero("a delta light on a delta lobe is a pair of measure zero")
        directions, normal_irradiance = self.light.incident(self.receiver.origin)
        wi = self.receiver.to_local(directions)
        above = wi[:, 2] > 0
        if not np.any(above):
            return self.zero("the light is below the horizon")
        wi, arriving = wi[above], normal_irradiance[above]
        values = self.f.evaluate(wi, np.broadcast_to(self.wo, wi.shape))
        if not np.all(np.isfinite(values)):
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            where = f"wi = {tuple(wi[row].tolist())}, wo = {tuple(self.wo.tolist())}"
            raise NonFiniteError(f"{self.f!r} is {values[row]} at {where}", value=values[row], at=wi[row])
        total = _times(values, arriving * wi[:, 2]).sum(axis=0)
        # A direction is known to a few eps, the cosine to that of 1, and a narrow lobe is steep.
        width = self.f.lobe_width() or 1e-2
        precision = getattr(self.f, "precision", _EPS)
        steep = 16 * precision * (1 + 1 / width)
        error = _times(np.abs(values), arriving * (8 * _EPS + steep * wi[:, 2])).sum(axis=0)
        seconds = time.perf_counter() - start
        return Estimate(total[()], error[()], "rounding", len(wi), seconds, "sum")

    def closed_form(self) -> Estimate:
        """Return ρE/π of a diffuse material under an emitter with a closed-form irradiance."""
        start = time.perf_counter()
        reflectance = self.f.diffuse_reflectance()
        arriving = self.light.irradiance_at(self.receiver.origin, self.receiver.axis)
        if reflectance is None or arriving is None:
            raise RadiokitError("there is no closed form for this term")
        found = arriving.scaled(reflectance / np.pi)
        error = found.error + 4 * _EPS * np.abs(found.value)
        return replace(found, error=error, seconds=time.perf_counter() - start, method="closed form")

    # --- quadrature ---

    def reflected(self, wi: FloatArray) -> FloatArray:
        """Return f L cosθ [W m⁻² sr⁻²] for local directions ``wi`` (N, 3)."""
        radiance = self.light.radiance_from(self.receiver.to_world(wi), self.receiver.origin)
        values = self.f.evaluate(wi, np.broadcast_to(self.wo, wi.shape))
        return _times(values, radiance * np.maximum(wi[:, 2], 0.0))

    def quadrature(self, rtol: float) -> Estimate:
        """Integrate by the rule that fits the light: hemisphere, lune, or the light's own square."""
        dome = self.light.dome(self.receiver.origin)
        if dome is None:
            return self._over_light(rtol)
        width = self.f.lobe_width()
        if not dome:
            return hemisphere(self.reflected, wo=self.wo, width=width, rtol=rtol, smooth=self.f.smooth)
        zenith = self.receiver.to_local(dome[0])
        return lune(self.reflected, zenith, wo=self.wo, width=width, rtol=rtol)

    def _over_light(self, rtol: float) -> Estimate:
        """Integrate over the square from which the light samples its directions.

        A lobe much narrower than the light can slip between the nodes of every rule, so that they agree on
        a wrong value. A lattice in the squares of both the light and the material sees such a lobe.
        """
        start = time.perf_counter()

        def product(piece: Emitter) -> Callable[[FloatArray], Any]:
            lit = replace(self, light=piece)
            return lambda directions: lit.reflected(self.receiver.to_local(directions))

        width = self.f.lobe_width()
        if width is not None:  # in azimuth a lobe narrows towards the horizon
            width *= float(np.clip(self.wo[2] + width, 0.0, 1.0))
        mirror = self.receiver.to_world(self.wo * np.array([-1.0, -1.0, 1.0]))
        found = over_light(
            product,
            self.light,
            self.receiver,
            rtol,
            peaked=True,
            width=width,
            towards=(mirror, self.receiver.to_world(self.wo)),
            smooth=self.f.smooth,
        )
        count = _GUARD if getattr(self.f, "has_sampler", True) else _BLIND
        values = self._both(kronecker(count, 2 + self.f.dimensions))
        means = values.reshape(16, -1, *self.shape).mean(axis=1)
        guard, spread = means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))
        gap = np.maximum(guard - found.value, 0.0)  # what is missed is missing
        missed = gap > 6 * spread + 0.01 * guard
        found = replace(
            found,
            evaluations=found.evaluations + 2 * count,
            seconds=time.perf_counter() - start,
        )
        if np.any(missed):
            note = f"a lattice over light and lobe finds {guard}: the rules missed a narrow lobe"
            return replace(found, error=found.error + 2 * gap + 6 * spread, converged=False, note=note)
        return found

    # --- Monte Carlo ---

    def monte_carlo(
        self,
        method: str,
        *,
        rtol: float | None,
        samples: int | None,
        rng: int | np.random.Generator | None,
        executor: Executor | None = None,
    ) -> Estimate:
        """Estimate by sampling the material, the light, or both with the balance heuristic.

        ``qmc`` does what suits the term best, with low-discrepancy points and without the executor.
        """
        strategy = self.best_sampling if method == "qmc" else method
        sampler: Callable[[FloatArray], FloatArray]
        sampler = {"mc-bsdf": self._from_bsdf, "mc-light": self._from_light, "mis": self._both}[strategy]
        dimensions = {"mc-bsdf": 0, "mc-light": 2, "mis": 2}[strategy]
        dimensions += 0 if strategy == "mc-light" else self.f.dimensions
        count = MAX_SAMPLES if samples is None else samples
        rtol = rtol if samples is None else None
        if method == "qmc":
            return lowdiscrepancy.mean(
                sampler, dimensions=dimensions, samples=count, rtol=rtol, rng=rng, method=f"qmc, {strategy}"
            )
        return mean(
            partial(_draw, sampler, dimensions),
            samples=count,
            rtol=rtol,
            rng=rng,
            executor=executor,
            method=method,
        )

    @property
    def best_sampling(self) -> str:
        """Both, but for an environment, which shines from everywhere: there a material's sampler suffices."""
        everywhere = not self.light.delta and self.light.dome(self.receiver.origin) is not None
        return "mc-bsdf" if everywhere and getattr(self.f, "has_sampler", True) else "mis"

    def _from_bsdf(self, u: FloatArray) -> FloatArray:
        wi, weight = self.f.sample(u, np.broadcast_to(self.wo, (len(u), 3)))
        use = (wi[:, 2] > 0) & ~self._is_delta(wi)
        radiance = self.light.radiance_from(self.receiver.to_world(wi[use]), self.receiver.origin)
        return self._scatter(use, _times(weight[use], radiance))

    def _from_light(self, u: FloatArray) -> FloatArray:
        towards, density = self.light.sample(u, self.receiver.origin)
        wi = self.receiver.to_local(towards)
        use = (wi[:, 2] > 0) & (density > 0)
        return self._scatter(use, _times(self.reflected(wi[use]), 1 / density[use]))

    def _both(self, u: FloatArray) -> FloatArray:
        """Return f L cosθ / (p_material + p_light), summed over a sample of each."""
        rows = np.broadcast_to(self.wo, (len(u), 3))
        by_material, _ = self.f.sample(u[:, :-2], rows)
        towards, _ = self.light.sample(u[:, -2:], self.receiver.origin)
        total: Any = 0.0
        for wi in (by_material, self.receiver.to_local(towards)):
            use = (wi[:, 2] > 0) & ~self._is_delta(wi)
            kept = wi[use]
            density = self.f.pdf(kept, rows[use])
            density = density + self.light.pdf(self.receiver.to_world(kept), self.receiver.origin)
            value = self.reflected(kept)
            share = np.divide(1.0, density, out=np.zeros_like(density), where=density > 0)
            total = total + self._scatter(use, _times(value, share))
        return np.asarray(total)

    def _is_delta(self, wi: FloatArray) -> npt.NDArray[np.bool_]:
        near = np.zeros(len(wi), dtype=bool)
        for lobe in self.lobes:
            near |= np.abs(wi - lobe).max(axis=1) < _SAME_DIRECTION
        return near

    def _scatter(self, use: npt.NDArray[np.bool_], values: FloatArray) -> FloatArray:
        """Put values at the rows ``use``, and 0 at the others."""
        result = np.zeros((len(use), *self.shape))
        if np.any(use):
            result[use] = values
        return result


def _times(values: FloatArray, factor: FloatArray) -> FloatArray:
    """Return values (N,) or (N, K) times a factor (N,)."""
    result: FloatArray = (values.T * factor).T
    return result


def _draw(
    sampler: Callable[[FloatArray], FloatArray], dimensions: int, generator: np.random.Generator, n: int
) -> FloatArray:
    return sampler(generator.random((n, dimensions)))
