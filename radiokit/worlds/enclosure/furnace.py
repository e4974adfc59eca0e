"""Furnace: the room of one material whose wall emits, asked in the wall's own frame."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.worlds.enclosure.answers import radiance
from radiokit.worlds.enclosure.rooms import Wall
from radiokit.worlds.enclosure.sphere import Sphere
from radiokit.worlds.planning import check_direction

__all__ = ["SOURCE", "enclosure_radiance"]

SOURCE = Source(
    authors="Jacquez, Kuppenheim",
    year=1955,
    title="Theory of the integrating sphere",
    doi="10.1364/JOSA.45.000460",
    equation="the geometric series of the reflections, 1/(1 − ρ)",
)


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
    towards = check_direction("wo", wo)
    if not towards[2] > 0:
        raise ParameterError("wo", tuple(towards.tolist()), "above the horizon (z > 0)")
    if Wall(f=model).absorbs_nothing:
        allowed = "a material that absorbs: with an albedo of 1 the radiance in a closed room diverges"
        raise ParameterError("f", model, allowed)
    room = Sphere(wall=Wall(f=model, emitted=emitted), radius=radius)
    return radiance(
        room,
        position=(0.0, 0.0, -radius),
        direction=towards,
        method="random walk",
        samples=samples,
        rng=rng,
        executor=executor,
    )
