"""Tasks: directional albedos with a known truth, from closed-form cases and from a converged rule."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from radiokit.bsdfs.ggx import GGX
from radiokit.contracts.albedo import integrand
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.errors import RadiokitError
from radiokit.measure.slope import slope_rule
from radiokit.worlds.cases.catalogue import case

__all__ = ["ALPHAS", "FURNACES", "QUICK", "THETAS_DEG", "Task", "ggx_albedo", "tasks", "towards"]

ALPHAS = (0.001, 0.01, 0.05, 0.3, 1.0)
THETAS_DEG = (0.0, 60.0, 89.0, 89.9)
"""Twenty albedos of GGX, from a near mirror to a rough metal, from the normal to a tenth of a degree."""

FURNACES = (
    "lambert-in-furnace",
    *(f"phong-10-in-furnace-at-{theta}deg" for theta in (0, 30, 60, 80)),
    *(f"ggx-1-in-furnace-at-{theta}deg" for theta in (30, 80)),
)
"""Closed-form cases; those of GGX that are among the twenty too are counted there."""

QUICK = ("lambert-in-furnace", "phong-10-in-furnace-at-60deg", "ggx-0.3-at-60deg", "ggx-0.05-at-89deg")

_EXACT = {(0.3, 60.0): "ggx-0.3-in-furnace-at-60deg", (0.05, 89.0): "ggx-0.05-in-furnace-at-89deg"}
_NODES = (256, 192)
_AGREE = 1e-12


@dataclass(frozen=True)
class Task:
    """One directional albedo: of which model, for which direction, its true value and where that is from."""

    name: str
    f: BSDF
    wo: tuple[float, float, float]
    exact: float
    truth: str

    @property
    def theta_deg(self) -> float:
        """The polar angle of ``wo`` in degrees."""
        return math.degrees(math.atan2(math.hypot(self.wo[0], self.wo[1]), self.wo[2]))

    @property
    def broad(self) -> bool:
        """Whether sampling shows its law of errors here at some thousand samples."""
        return (self.f.lobe_width() or 1.0) >= BROAD


BROAD = 0.15
"""Lobe widths, in slope, from which on the weight varies gently over the square of the random numbers."""


def tasks(quick: bool = False) -> tuple[Task, ...]:
    """Return all tasks, or four of them.

    >>> len(tasks()), [task.name for task in tasks(quick=True)][2:]
    (27, ['ggx-0.05-at-89deg', 'ggx-0.3-at-60deg'])
    """
    found = [_furnace(name) for name in FURNACES if not quick or name in QUICK]
    for alpha in ALPHAS:
        for theta in THETAS_DEG:
            name = f"ggx-{alpha:g}-at-{theta:g}deg"
            if not quick or name in QUICK:
                exact, truth = ggx_albedo(alpha, theta)
                found.append(Task(name, GGX(alpha=alpha), towards(theta), exact, truth))
    return tuple(found)


def _furnace(name: str) -> Task:
    furnace = case(name)
    scene: Any = furnace.scene
    return Task(name, scene.f, scene.wo, furnace.exact, "closed form")


def towards(theta_deg: float) -> tuple[float, float, float]:
    """Return the direction at a polar angle, in the xz plane; the cosine keeps its digits near 90°."""
    return (math.sin(math.radians(theta_deg)), 0.0, math.sin(math.radians(90 - theta_deg)))


@cache
def ggx_albedo(alpha: float, theta_deg: float) -> tuple[float, str]:
    """Return the directional albedo of GGX with F = 1, and what the number rests on.

    The closed form for α = 1, the 30 digits of the closed-form cases where there are such, and otherwise
    ``converged``.
    """
    if alpha == 1:
        mu = towards(theta_deg)[2]
        return 1 - mu * math.log1p(1 / mu), "closed form"
    if (alpha, theta_deg) in _EXACT:
        return case(_EXACT[alpha, theta_deg]).exact, "30 digits"
    f = GGX(alpha=alpha)
    value, gap = converged(integrand(f, np.array(towards(theta_deg)), "wo"), alpha, theta_deg)
    return value, f"256² nodes; 192² with twice the width differ by {gap:.0e}"


def converged(value: Callable[[FloatArray], Any], width: float, theta_deg: float) -> tuple[float, float]:
    """Return an integral by a slope rule of 256 × 256 nodes, and how far another is from it.

    The other has 192 × 192 nodes, none of them the same, and is laid out for a lobe of twice the width.

    Raises
    ------
    RadiokitError
        When they differ by more than 1e-12 of the value.
    """
    found = []
    for nodes, factor in zip(_NODES, (1.0, 2.0), strict=True):
        wi, weight = slope_rule(towards(theta_deg), width * factor, nodes, symmetric=True)
        found.append(float(weight @ value(wi)))
    gap = abs(found[0] - found[1])
    if not gap <= _AGREE * abs(found[0]):
        raise RadiokitError(f"two converged rules disagree: {found[0]!r} and {found[1]!r}", values=found)
    return found[0], gap
