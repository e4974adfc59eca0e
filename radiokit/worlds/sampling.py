"""Sampling: a term by random or low-discrepancy samples of the material, the light, or both."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.spectral import times
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure import lowdiscrepancy
from radiokit.measure.lattice import kronecker
from radiokit.measure.montecarlo import mean
from radiokit.worlds.budget import SHORTEST, Budget
from radiokit.worlds.terms import MAX_SAMPLES, Term

__all__ = [
    "BLOCK",
    "MIS_SOURCE",
    "ZENITH",
    "Sampler",
    "best_sampling",
    "monte_carlo",
    "sampling_is_better",
]

FloatArray = npt.NDArray[np.float64]

MIS_SOURCE = Source(
    authors="Veach, Guibas",
    year=1995,
    title="Optimally combining sampling techniques for Monte Carlo rendering",
    doi="10.1145/218380.218498",
    equation="balance heuristic, section 3.2",
)

BLOCK = 1 << 14
"""Samples between two looks at the clock."""

PILOT = 512
"""Samples of the other kind that foretell a variance; a quarter of the samples if that is less."""

RARE = 10.0
"""Expected hits below which samples of the material alone say too little about a light."""

ZENITH = 1 - 1e-15
"""Cosine of a tilt that hides nothing."""

_SAME_DIRECTION = 1e-9  # a sample this near a delta lobe came from it: any other does so once in 1e18


def best_sampling(term: Term) -> str:
    """Both, but for an environment, which shines from everywhere: there a material's sampler suffices."""
    everywhere = not term.light.delta and term.light.dome(term.receiver.origin) is not None
    return "mc-bsdf" if everywhere and getattr(term.f, "has_sampler", True) else "mis"


@dataclass(frozen=True)
class Sampler:
    """Estimates of a term's radiance from uniform points: by ``mc-bsdf``, ``mc-light`` or ``mis``."""

    term: Term
    strategy: str

    @cached_property
    def dimensions(self) -> int:
        """How many uniform numbers a sample takes."""
        return (0 if self.strategy == "mc-light" else self.term.f.dimensions) + 2 * (
            self.strategy != "mc-bsdf"
        )

    @cached_property
    def edged(self) -> bool:
        """Whether some of the material's samples may miss the light."""
        dome = self.term.light.dome(self.term.receiver.origin)
        return dome is None or any(float(zenith @ self.term.receiver.axis) < ZENITH for zenith in dome)

    def __call__(self, u: FloatArray) -> FloatArray:
        """Return the estimates (N,) or (N, K) of points u (N, dimensions)."""
        if self.strategy == "mc-bsdf":
            return self._from_bsdf(u)
        if self.strategy == "mc-light":
            return self._from_light(u)
        return self._by_material(u[:, :-2]) + self._by_light(u[:, -2:])

    def stepped(self, u: FloatArray) -> FloatArray:
        """Return the estimates, and beside them the parts that jump where a sample's light ends."""
        if self.strategy == "mc-light":
            whole = self._from_light(u)
            part = np.zeros_like(whole)
        elif self.strategy == "mc-bsdf":
            whole = part = self._from_bsdf(u)
        else:
            part = self._by_material(u[:, :-2])
            whole = part + self._by_light(u[:, -2:])
        return np.concatenate([whole.reshape(len(u), -1), part.reshape(len(u), -1)], axis=1)

    # --- estimates ---

    def _from_bsdf(self, u: FloatArray) -> FloatArray:
        term = self.term
        wi, weight = term.f.sample(u, np.broadcast_to(term.wo, (len(u), 3)))
        use = (wi[:, 2] > 0) & ~self._is_delta(wi)
        radiance = term.light.radiance_from(term.receiver.to_world(wi[use]), term.receiver.origin)
        return self._scatter(use, times(weight[use], radiance))

    def _from_light(self, u: FloatArray) -> FloatArray:
        term = self.term
        towards, density = term.light.sample(u, term.receiver.origin)
        wi = term.receiver.to_local(towards)
        use = (wi[:, 2] > 0) & (density > 0)
        return self._scatter(use, times(term.reflected(wi[use]), 1 / density[use]))

    def _by_material(self, u: FloatArray) -> FloatArray:
        """Return f L cosθ / (p_material + p_light) for samples of the material."""
        wi, _ = self.term.f.sample(u, np.broadcast_to(self.term.wo, (len(u), 3)))
        return self._balanced(wi)

    def _by_light(self, u: FloatArray) -> FloatArray:
        """Return the same for samples of the light."""
        towards, _ = self.term.light.sample(u, self.term.receiver.origin)
        return self._balanced(self.term.receiver.to_local(towards))

    def _balanced(self, wi: FloatArray) -> FloatArray:
        use = (wi[:, 2] > 0) & ~self._is_delta(wi)
        kept = wi[use]
        density = sum(self._densities(kept))
        share = np.divide(1.0, density, out=np.zeros(len(kept)), where=density > 0)
        return self._scatter(use, times(self.term.reflected(kept), share))

    def _densities(self, wi: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the densities (N,) [sr⁻¹] with which the material and the light pick local directions."""
        term = self.term
        by_material = term.f.pdf(wi, np.broadcast_to(term.wo, wi.shape))
        return by_material, term.light.pdf(term.receiver.to_world(wi), term.receiver.origin)

    def _is_delta(self, wi: FloatArray) -> npt.NDArray[np.bool_]:
        near = np.zeros(len(wi), dtype=bool)
        for lobe in self.term.lobes:
            near |= np.abs(wi - lobe).max(axis=1) < _SAME_DIRECTION
        return near

    def _scatter(self, use: npt.NDArray[np.bool_], values: FloatArray) -> FloatArray:
        """Put values at the rows ``use``, and 0 at the others."""
        result = np.zeros((len(use), *self.term.shape))
        if np.any(use):
            result[use] = values
        return result

    # --- what samples of the other kind foretell ---

    def foretold(self, count: int) -> tuple[Any, Any, float]:
        """Return variances () or (K,) of a sample as far as samples of the other kind see them, and the hits.

        The first is that of the material's samples as the light's see it, the second that of the light's.

        Rare samples carry the variance where a light is small, or a lobe: they do not show among the samples
        that were drawn, but samples of the light, or of the lobe, see all of their weights. With g = f L cosθ
        and densities p, q of the sampler and the other one, a sample's second moment is ∫ w² p dω =
        E_q[w² p/q], w being g/p, or g/(p + q) under the balance heuristic. The hits are the share of the
        material's samples that meet the light, E_q[p/q].
        """
        material, light, hits = np.zeros(self.term.shape), np.zeros(self.term.shape), 1.0
        if self.strategy != "mc-light":
            material, hits = self._seen_from(count, of_light=True)
        if self.strategy != "mc-bsdf":
            light, _ = self._seen_from(count, of_light=False)
        return material, light, hits

    def _seen_from(self, count: int, of_light: bool) -> tuple[Any, float]:
        """Return the variance of one kind of samples, as samples of the light or the material see it."""
        term = self.term
        if of_light:
            towards, _ = term.light.sample(kronecker(count, 2), term.receiver.origin)
            wi = term.receiver.to_local(towards)
        else:
            points = kronecker(count, term.f.dimensions)
            wi, _ = term.f.sample(points, np.broadcast_to(term.wo, (count, 3)))
        wi = wi[(wi[:, 2] > 0) & ~self._is_delta(wi)]
        material, light = self._densities(wi)
        p, q = (material, light) if of_light else (light, material)
        whole = p + q if self.strategy == "mis" else p
        use = (q > 0) & (whole > 0)
        ratio = np.where(use, p / np.where(q > 0, q, 1.0), 0.0)
        weight = times(term.reflected(wi), np.divide(1.0, whole, out=np.zeros(len(wi)), where=use))
        first = times(weight, ratio).sum(axis=0) / count
        second = times(weight**2, ratio).sum(axis=0) / count
        return np.maximum(second - first**2, 0.0), float(ratio.sum()) / count


def sampling_is_better(term: Term, found: Estimate, samples: int | None, budget: Budget) -> bool:
    """Return whether samples may reach a smaller error than a quadrature did, by a few of them."""
    sampler = Sampler(term, "mis")
    most = budget.samples("mis", samples, MAX_SAMPLES)
    if most is None:
        return budget.seconds_left() != SHORTEST
    values = sampler(kronecker(PILOT, sampler.dimensions))
    error = values.std(axis=0) / np.sqrt(max(most, 1))
    return bool(np.all(error < 2 * found.error))  # lattices err less than random samples do


def monte_carlo(
    term: Term,
    method: str,
    *,
    rtol: float | None,
    samples: int | None,
    rng: int | np.random.Generator | None,
    executor: Executor | None = None,
    budget: Budget | None = None,
) -> Estimate:
    """Estimate a term by sampling the material, the light, or both with the balance heuristic.

    ``qmc`` does what suits the term best, with low-discrepancy points and without the executor.
    """
    budget = Budget() if budget is None else budget
    sampler = Sampler(term, best_sampling(term) if method == "qmc" else method)
    rtol = rtol if samples is None else None
    count = budget.samples(sampler.strategy, samples, MAX_SAMPLES)
    seconds = budget.seconds_left()
    pilot = PILOT if count is None else int(np.clip(count // 4, 32, PILOT))
    by_material, by_light, hits = sampler.foretold(pilot)
    if method == "qmc":
        found = lowdiscrepancy.mean(
            sampler.stepped if sampler.edged else sampler,
            dimensions=sampler.dimensions,
            samples=None if count is None else max(count, lowdiscrepancy.REPLICATES),
            rtol=rtol,
            rng=rng,
            seconds=seconds,
            stepped=sampler.edged,
            foretold=by_material,
            method=f"qmc, {sampler.strategy}",
        )
        found = found if term.shape or not sampler.edged else _scalar(found)
        return _doubted(found, sampler, hits, by_material)
    draw = partial(_draw, sampler)
    found = mean(
        draw,
        samples=count,
        rtol=rtol,
        rng=rng,
        seconds=seconds,
        block=BLOCK,
        executor=executor,
        method=method,
        foretold=np.maximum(by_material, by_light),
        edge=sampler.edged and sampler.strategy == "mc-bsdf",
    )
    found = _doubted(found, sampler, hits, by_material)
    if samples is not None and found.evaluations < samples and found.converged:
        note = f"the budget allowed for {found.evaluations} of {samples} samples"
        found = replace(found, converged=False, note="; ".join(filter(None, (note, found.note))))
    return found


def _doubted(found: Estimate, sampler: Sampler, hits: float, variance: Any) -> Estimate:
    """Return an estimate as one that has not converged, if it rests on hits that hardly ever occur."""
    expected = hits * found.evaluations
    if sampler.strategy != "mc-bsdf" or expected >= RARE or not np.any(variance):
        return found
    note = f"samples of the material hit the light about {expected:.2g} times"
    return replace(found, converged=False, note="; ".join(filter(None, (note, found.note))))


def _scalar(found: Estimate) -> Estimate:
    return replace(found, value=float(found.value[0]), error=float(found.error[0]))


def _draw(sampler: Sampler, generator: np.random.Generator, n: int) -> FloatArray:
    return sampler(generator.random((n, sampler.dimensions)))
