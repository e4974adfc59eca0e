"""Enclosure: light that bounces without end inside a closed sphere, followed by a random walk."""

from __future__ import annotations

from concurrent.futures import Executor
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.facts.directions import dot, frame, spherical_to_cartesian, to_local, to_world
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.lattice import kronecker
from radiokit.measure.montecarlo import mean
from radiokit.worlds.planning import check_direction

__all__ = ["SOURCE", "enclosure_radiance"]

FloatArray = npt.NDArray[np.float64]

SOURCE = Source(
    authors="Jacquez, Kuppenheim",
    year=1955,
    title="Theory of the integrating sphere",
    doi="10.1364/JOSA.45.000460",
    equation="the geometric series of the reflections, 1/(1 − ρ)",
)

_BLOCK = 8192
_MEAN_BOUNCES = 5000  # of all paths in a block; an albedo of 0.999 needs 1000
_PROBE = spherical_to_cartesian([0.1, 0.7, 1.2, 1.5], [0.0, 2.0, 4.0, 5.0])


def enclosure_radiance(
    f: Any,
    *,
    emitted: float = 1.0,
    radius: float = 1.0,
    wo: npt.ArrayLike = (0.0, 0.0, 1.0),
    samples: int = 65536,
    rng: int | np.random.Generator | None = None,
    executor: Executor | None = None,
) -> Estimate:
    """Return the radiance [W m⁻² sr⁻¹] that leaves the wall of a sphere whose inside emits and reflects.

    Every wall point emits ``emitted`` in all directions and reflects by ``f``. A path starts at the wall,
    looks along a sampled direction, hits the wall again, and so on; Russian roulette ends it without bias.
    For a diffuse wall the answer is emitted/(1 − ρ), the sum of the geometric series.

    Parameters
    ----------
    f : BSDF or callable
        The wall, f(wi, wo) [sr⁻¹]. Its albedo must be below 1.
    emitted : float
        Radiance [W m⁻² sr⁻¹], at least 0.
    radius : float
        [m], above 0. The answer does not depend on it.
    wo : array_like, shape (3,)
        The viewer's direction in the local frame of the wall, above its horizon.
    samples : int
        Paths, at least 2. An estimate's ``evaluations`` counts paths.
    rng : int, numpy.random.Generator or None
    executor : concurrent.futures.Executor, optional

    Raises
    ------
    ParameterError
        When an argument is not allowed; so is a wall that absorbs nothing, for its radiance grows without
        bound.
    RadiokitError
        When the paths do not end: the albedo is 1 or more, or nearly so.

    Source: Jacquez, Kuppenheim (1955), doi:10.1364/JOSA.45.000460.

    >>> half = lambda wi, wo: 0.5 / np.pi
    >>> enclosure_radiance(half, samples=20_000, rng=1).covers(2.0, level=0.9999)
    True
    """
    model = as_bsdf(f)
    if not (np.isfinite(emitted) and emitted >= 0):
        raise ParameterError("emitted", emitted, "a number in [0, inf)")
    if not (np.isfinite(radius) and radius > 0):
        raise ParameterError("radius", radius, "a number in (0, inf)")
    towards = check_direction("wo", wo)
    if not towards[2] > 0:
        raise ParameterError("wo", tuple(towards.tolist()), "above the horizon (z > 0)")
    if _absorbs_nothing(model):
        allowed = "a material that absorbs: with an albedo of 1 the radiance in a closed room diverges"
        raise ParameterError("f", model, allowed)
    draw = partial(_walk, model, float(emitted), float(radius), towards)
    return mean(draw, samples=samples, rng=rng, block=_BLOCK, executor=executor, method="random walk")


def _absorbs_nothing(f: BSDF) -> bool:
    """Return whether every sample of every probed direction keeps all of its weight."""
    u = kronecker(64, f.dimensions)
    for wo in _PROBE:
        _, weight = f.sample(u, np.broadcast_to(wo, (len(u), 3)))
        if np.any(np.mean(weight, axis=0) < 1 - 1e-12):
            return False
    return True


def _walk(
    f: BSDF, emitted: float, radius: float, wo: FloatArray, generator: np.random.Generator, n: int
) -> FloatArray:
    """Return the radiance that each of ``n`` paths gathers."""
    position = np.tile((0.0, 0.0, -radius), (n, 1))
    local_wo = np.broadcast_to(wo, (n, 3))
    path = np.arange(n)
    throughput: FloatArray | None = None
    total = np.full(n, emitted)
    bounces = 0
    while len(path):
        bounces += len(path)
        if bounces > _MEAN_BOUNCES * n:
            raise RadiokitError(
                f"after {_MEAN_BOUNCES} bounces for each path there is no end: the albedo of {f!r} is 1 "
                "or more, or nearly so, and the radiance diverges or cannot be sampled"
            )
        u = generator.random((len(path), f.dimensions + 1))
        wi, weight = f.sample(u[:, :-1], local_wo)
        if throughput is None:  # now the number of wavelengths is known
            throughput = np.ones(weight.shape)
            total = np.full(weight.shape, emitted)
        throughput = throughput * weight
        survival = np.minimum(throughput.reshape(len(path), -1).max(axis=1), 1.0)
        keep = (u[:, -1] < survival) & (wi[:, 2] > 0)
        path, wi, position = path[keep], wi[keep], position[keep]
        throughput = (throughput[keep].T / survival[keep]).T
        w = to_world(frame(-position / radius), wi)
        hit = position - 2 * dot(position, w)[:, None] * w  # the chord's other end
        position = hit * (radius / np.sqrt(dot(hit, hit)))[:, None]
        local_wo = to_local(frame(-position / radius), -w)
        total[path] += emitted * throughput
    return total
