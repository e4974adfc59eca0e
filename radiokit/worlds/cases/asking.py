"""Asking: how the cases about closed rooms put their questions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal

import numpy as np

from radiokit.bsdfs.lambert import Lambert
from radiokit.facts.estimate import Estimate, rounding
from radiokit.physics.integrating_sphere import GOEBEL
from radiokit.worlds.cases.catalogue import Case, Method
from radiokit.worlds.enclosure import Room, Wall, flux, irradiance, radiance

__all__ = ["SAMPLES", "Ask", "by_both", "from_above", "grey", "room_case"]

SAMPLES = 1 << 15
"""Paths of a random walk when none are asked for."""


@dataclass(frozen=True)
class Ask:
    """A question about a room, times a factor; of several wavelengths, one is picked."""

    room: Room
    what: Literal["radiance", "irradiance", "flux"]
    where: Any
    factor: float = 1.0
    wavelength: int | None = None
    paths: int = SAMPLES

    def __call__(
        self, method: str, *, rng: int | np.random.Generator | None = None, samples: int | None = None
    ) -> Estimate:
        """Return the answer by a method."""
        ask: Any = {"radiance": radiance, "irradiance": irradiance, "flux": flux}[self.what]
        count = self.paths if samples is None else samples
        found: Estimate = ask(self.room, **self.where, method=method, samples=count, rng=rng)
        if self.wavelength is not None:
            k = self.wavelength
            found = replace(found, value=found.value[k], error=found.error[k])
        return found.scaled(self.factor)


def _known(
    value: float, *, rng: int | np.random.Generator | None = None, samples: int | None = None
) -> Estimate:
    """Return what a formula of physics says, for rooms that have no closed form as a whole."""
    return rounding(value, ulps=32)


def by_both(ask: Ask, known: float | None = None) -> dict[str, Method]:
    """Return both methods; where the room as a whole has no closed form, ``known`` is what physics says."""
    exactly: Method = partial(ask, "closed form") if known is None else partial(_known, known)
    return {"closed form": exactly, "random walk": partial(ask, "random walk")}


def grey(reflectance: Any, emitted: Any = 0.0) -> Wall:
    """Return a diffuse wall."""
    return Wall(f=Lambert(reflectance=reflectance), emitted=emitted)


def from_above(**more: Any) -> dict[str, Any]:
    """Return the question at the sphere's lowest point, looked at from above."""
    return {"position": (0.0, 0.0, -1.0), "direction": (0.0, 0.6, 0.8)} | more


def room_case(
    name: str, title: str, setup: str, exact: float, derivation: str, methods: dict[str, Method], **more: Any
) -> Case:
    """Return a case about a room."""
    options: dict[str, Any] = {"source": GOEBEL, "unit": "W/m^2/sr", "tags": ("interreflection",)} | more
    options["tags"] = ("enclosure", *options["tags"])
    return Case(
        name=name,
        title=title,
        setup=setup,
        exact=exact,
        derivation=derivation,
        methods=methods,
        **options,
    )
