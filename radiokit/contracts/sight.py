"""Sight: a light from one point and the bodies before it: what is left, in closed form and in patches."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import combinations, product

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.holes import around, axis_of, joined_patches, pierced
from radiokit.contracts.occluder import Occluder, blocked
from radiokit.contracts.parameters import Spectrum
from radiokit.contracts.piece import Patch
from radiokit.contracts.spectral import amount
from radiokit.facts.estimate import Estimate
from radiokit.measure.clip import sides
from radiokit.measure.exact import RationalVector, cross, inner, rational
from radiokit.measure.lunes import NODES
from radiokit.physics.ball import Ball
from radiokit.physics.eclipse import Body, Dome, Relation, place, relation
from radiokit.physics.facets import Facets
from radiokit.physics.litparts import (
    above,
    cones_irradiance,
    cones_solid_angle,
    joined,
    lit_parts,
)
from radiokit.physics.plate import Plate

__all__ = ["Sight", "sight"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


def sight(light: Emitter, occluders: Sequence[Occluder], origin: FloatArray) -> Sight:
    """Return a light from a point, with those of the bodies that may hide some of it.

    Raises
    ------
    ParameterError
        When the point is on an occluder or the light.
    """
    shapes = [item.shape(origin) for item in occluders]
    bodies = [body for body in shapes if body is not None]
    if light.delta:
        directions, _ = light.incident(origin)
        reach = light.distance_along(directions, origin)
        bodies = [body for body in bodies if np.any(blocked(body, directions, reach))]
        return Sight(light, origin, None, tuple((body, "unsure") for body in bodies))
    if not light.solid_angle(origin).value > 0:
        return Sight(light, origin, None, ())
    silhouette = light.silhouette(origin)
    if silhouette is None:
        return Sight(light, origin, None, tuple((body, "unsure") for body in bodies))
    placed = [(body, relation(body, silhouette.body)) for body in bodies]
    kept = [pair for pair in placed if pair[1] != "apart"]
    covering = [pair for pair in kept if pair[1] == "around"]
    return Sight(light, origin, silhouette, tuple(covering[:1] or _undoubled(kept)))


def _undoubled(placed: list[tuple[Body, Relation]]) -> list[tuple[Body, Relation]]:
    """Leave out bodies in the shadow of a round one, which is nearer than the light wherever it is met."""
    found: list[tuple[Body, Relation]] = []
    for body, how in placed:
        if any(_covers(other, body) for other in found):
            continue
        found = [other for other in found if not _covers((body, how), other[0])]
        found.append((body, how))
    return found


def _covers(other: tuple[Body, Relation], body: Body) -> bool:
    nearer, how = other
    return not isinstance(nearer, Facets) and how != "unsure" and place(nearer, body) == "around"


@dataclass(frozen=True, eq=False)
class Sight:
    """A light from one point, and the bodies that may hide some of it, with how each lies before the light.

    ``silhouette`` is None, and nothing is known of the edges, for a light that does not tell its own.
    """

    light: Emitter
    position: FloatArray
    silhouette: Silhouette | None
    placed: tuple[tuple[Body, Relation], ...]

    @cached_property
    def bodies(self) -> list[Body]:
        """The bodies alone."""
        return [body for body, _ in self.placed]

    @property
    def dark(self) -> bool:
        """Whether nothing is seen of the light."""
        return any(how == "around" for _, how in self.placed)

    @property
    def sure(self) -> bool:
        """Whether it is known how every body lies."""
        return self.silhouette is not None and not any(how == "unsure" for _, how in self.placed)

    @cached_property
    def facets(self) -> list[Facets]:
        """The polygons."""
        return [body for body in self.bodies if isinstance(body, Facets)]

    @cached_property
    def rounds(self) -> list[tuple[Ball | Plate, Relation]]:
        """The others."""
        return [(body, how) for body, how in self.placed if not isinstance(body, Facets)]

    def above(self, normal: FloatArray) -> Sight:
        """Return the same without the bodies that are wholly below a receiver's horizon.

        A sky's own horizon does not count where it is the receiver's.
        """
        up, silhouette = rational(normal), self.silhouette
        kept = [pair for pair in self.placed if place(pair[0], Dome((up,))) != "apart"]
        if silhouette is not None and isinstance(silhouette.body, Dome):
            others = [n for n in silhouette.body.normals if any(cross(n, up)) or inner(n, up) < 0]
            silhouette = replace(silhouette, body=Dome(tuple(others)))
            kept = [(body, relation(body, silhouette.body)) for body, _ in kept]
        return Sight(self.light, self.position, silhouette, tuple(kept))

    # --- closed forms ---

    def irradiance(self, normal: FloatArray) -> Estimate | None:
        """Return what is left of an even light, where what is hidden is a sum."""
        silhouette = self.silhouette
        if silhouette is None or silhouette.radiance is None or not self._adds:
            return None
        light, radiance = silhouette.body, silhouette.radiance
        hidden = [body.irradiance(normal) for body, _ in self.rounds]
        whole: Estimate | None
        if isinstance(light, Facets | Dome) and self.facets:
            whole = _times(cones_irradiance(lit_parts(light, self.facets, normal), normal), radiance)
        else:
            whole = self.light.irradiance_at(self.position, normal)
            hidden.append(cones_irradiance(above(joined(self.facets), normal), normal))
        return None if whole is None else _less(whole, [_times(part, radiance) for part in hidden])

    def solid_angle(self, whole: Estimate) -> Estimate | None:
        """Return what is left of the solid angle, by the sizes of what is lit if need be."""
        if self._adds and self.silhouette is not None:
            light, hidden = self.silhouette.body, [body.solid_angle() for body, _ in self.rounds]
            if isinstance(light, Facets | Dome) and self.facets:
                cones = [cone for up in _BOTH for cone in lit_parts(light, self.facets, up)]
                return _less(cones_solid_angle(cones), hidden)
            return _less(whole, [*hidden, cones_solid_angle(joined(self.facets))])
        halves = [self.above(up).patches(up) for up in _BOTH]
        if any(half is None for half in halves):
            return None
        patches = [patch for half in halves for patch in half or ()]
        value = math.fsum(patch.size for patch in patches)
        error = math.fsum(patch.size * patch.precision + 2 * patch.spread for patch in patches)
        count = 2 * NODES * len(patches)
        return Estimate(value, error, "truncation", count, method="Gauss-Legendre around what is lit")

    @property
    def _adds(self) -> bool:
        """Whether round bodies are within the light, and apart from each other and from the polygons.

        Polygons may overlap: of a light with straight edges they are cut out, and within a round one joined.
        """
        if not self.sure or self.silhouette is None:
            return False
        straight = isinstance(self.silhouette.body, Facets | Dome)
        rounds = [body for body, _ in self.rounds]
        if any(how != "within" for body, how in self.placed if not (straight and isinstance(body, Facets))):
            return False
        pairs = [*combinations(rounds, 2), *product(rounds, self.facets)]
        return all(place(first, second) == "apart" for first, second in pairs)

    # --- patches ---

    def patches(self, normal: FloatArray) -> list[Patch] | None:
        """Return smooth maps of what is lit above the horizon; None where its edges are not known."""
        if not self.sure or self.silhouette is None:
            return None
        light = self.silhouette.body
        holes = [body for body, _ in self.rounds]
        if isinstance(light, Facets) or (isinstance(light, Dome) and self.facets):
            cones = lit_parts(light, self.facets, normal)
            return joined_patches(around(cone, holes) for cone in cones)
        horizon = rational(normal)
        if isinstance(light, Dome):
            return pierced([horizon, *light.normals], None, normal, holes)
        beside: list[list[RationalVector]] = [[horizon]]
        for body in self.facets:
            for part in body.parts:
                beside = [rest for planes in beside for rest in _outside(planes, sides(part))]
        axis = axis_of(light)
        return joined_patches(pierced(planes, light.cone, axis, holes) for planes in beside)


_BOTH = (np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0]))


def _times(found: Estimate, radiance: Spectrum) -> Estimate:
    """Return an estimate times a radiance, with the rounding of the product."""
    factor = amount(radiance)
    value = found.value * factor
    return replace(found, value=value, error=found.error * factor + 2 * _EPS * value)


def _less(whole: Estimate, hidden: Sequence[Estimate]) -> Estimate:
    """Return what is left, with the bounds of all terms: they say how much of it has cancelled."""
    hidden = [part for part in hidden if part.value > 0]
    if not hidden:
        return whole
    taken = reduce(operator.add, hidden)
    value = whole.value - taken.value
    error = whole.error + taken.error + (len(hidden) + 1) * _EPS * (whole.value + taken.value)
    return replace(whole + taken, value=np.maximum(value, 0.0)[()], error=error)


def _outside(planes: list[RationalVector], edges: Sequence[RationalVector]) -> Iterator[list[RationalVector]]:
    """Yield the parts of a region that are outside a convex cone of these edges."""
    inside = list(planes)
    for x, y, z in edges:
        yield [*inside, (-x, -y, -z)]
        inside = [*inside, (x, y, z)]
