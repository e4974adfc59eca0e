"""Enclosure: the radiance in a closed sphere whose diffuse wall emits and reflects."""

from __future__ import annotations

import numpy as np

from radiokit.bsdfs.lambert import Lambert
from radiokit.facts.estimate import Estimate
from radiokit.worlds.cases.catalogue import Case
from radiokit.worlds.enclosure import SOURCE, enclosure_radiance

__all__ = ["CASES"]

SAMPLES = 1 << 16


class _Walk:
    """The random walk at one reflectance."""

    def __init__(self, reflectance: float) -> None:
        self.wall = Lambert(reflectance=reflectance)

    def __call__(
        self, *, rng: int | np.random.Generator | None = None, samples: int | None = None
    ) -> Estimate:
        return enclosure_radiance(self.wall, samples=SAMPLES if samples is None else samples, rng=rng)


CASES: tuple[Case, ...] = tuple(
    Case(
        name=f"lambert-enclosure-{reflectance:g}",
        title=f"A closed sphere with an emitting wall of reflectance {reflectance:g}",
        setup=(
            "The inside of a sphere emits radiance 1 in all directions and reflects diffusely with "
            f"reflectance {reflectance:g}; nothing else is there. Wanted: the radiance that leaves any "
            "point of the wall, in any direction."
        ),
        exact=1 / (1 - reflectance),
        derivation=(
            r"By symmetry $L$ is the same everywhere, so $L = L_e + \rho L$: "
            r"$L = L_e/(1-\rho) = L_e \sum_k \rho^k$, a term for each number of bounces."
        ),
        source=SOURCE,
        unit="W/m^2/sr",
        methods={"random walk": _Walk(reflectance)},
        tags=("enclosure", "lambert", "interreflection"),
    )
    for reflectance in (0.1, 0.5, 0.9)
)
