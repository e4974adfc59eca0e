"""Shadowed: a light behind opaque bodies, as a light of its own, exact where its shadows' edges are known."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, reduce
from itertools import combinations, product
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.occluder import Occluder, blocked
from radiokit.contracts.parameters import Spectrum
from radiokit.contracts.piece import Patch, Piece, fan, tilted
from radiokit.contracts.spectral import amount, times
from radiokit.facts.estimate import Estimate
from radiokit.measure.circlecone import CircleCone
from radiokit.measure.clip import Cone, sides
from radiokit.measure.exact import RationalVector, cross, inner, rational
from radiokit.measure.lattice import kronecker
from radiokit.measure.lunes import NODES, Region
from radiokit.physics.ball import Ball
from radiokit.physics.eclipse import Body, Dome, Relation, place, relation
from radiokit.physics.facets import Facets
from radiokit.physics.litparts import above, cones_irradiance, cones_solid_angle, corners, joined, lit_parts
from radiokit.physics.plate import Plate

__all__ = ["Shadowed", "shadowed"]

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

_EPS = float(np.finfo(float).eps)
_NOTHING = Estimate(0.0, 0.0, "rounding", method="closed form")


def shadowed(light: Emitter, occluders: Sequence[Occluder], position: FloatArray) -> Emitter:
    """Return a light as ``position`` (3,) sees it behind occluders: itself, if none of them hides any of it.

    Raises
    ------
    ParameterError
        When ``position`` is on an occluder or a light.
    """
    behind = Shadowed(light=light, occluders=tuple(occluders))
    return behind if occluders and behind.hides(position) else light


@dataclass(frozen=True, kw_only=True)
class Shadowed(Emitter):
    """A light with opaque bodies in front of it.

    Occluders that hide nothing of it from where the receiver is do not count: those beside its cone or beyond
    it. The rest is exact for what is hidden wholly, for polygons in front of polygons and even skies however
    they overlap, and for bodies whose cones lie apart from each other within an evenly bright light.

    Parameters
    ----------
    light : Emitter
    occluders : tuple of Occluder

    >>> from radiokit.contracts.emitter import emitter
    >>> from radiokit.contracts.occluder import occluder
    >>> sky, ball = emitter("constant"), occluder("sphere", center=(0, 0, 2), radius=1)
    >>> seen = Shadowed(light=sky, occluders=(ball,))
    >>> left = seen.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    >>> round(float(left.value) / np.pi, 14)  # 1 − (R/d)²
    0.75
    """

    light: Emitter
    occluders: tuple[Occluder, ...]
    delta: ClassVar[bool] = False

    def __post_init__(self) -> None:
        bodies = " and ".join(dict.fromkeys(item.name for item in self.occluders))
        object.__setattr__(self, "name", f"{self.light.name} behind {bodies}")
        object.__setattr__(self, "delta", self.light.delta)

    def hides(self, position: FloatArray) -> bool:
        """Return whether an occluder may hide some of the light from ``position`` (3,)."""
        return bool(self._sight(position).bodies)

    def visible(self, direction: FloatArray, position: FloatArray) -> BoolArray:
        """Return whether nothing is before the light along directions (N, 3)."""
        if self._sight(position).dark:
            return np.zeros(len(direction), dtype=bool)
        reach = self.light.distance_along(direction, position)
        found = np.ones(len(direction), dtype=bool)
        for body in self._sight(position).bodies:
            found[found] = ~blocked(body, direction[found], reach[found])
        return found

    # --- what every light does ---

    @property
    def wavelengths(self) -> int | None:
        """Those of the light."""
        return self.light.wavelengths

    def incident(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the directions of a delta light that are not blocked, and their irradiances."""
        directions, arriving = self.light.incident(position)
        seen = self.visible(directions, position)
        return directions[seen], arriving[seen]

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the light's radiance, 0 where it is hidden."""
        value = self.light.radiance_from(direction, position)
        return times(value, self.visible(direction, position))

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Sample the whole light, what is hidden of it as well."""
        return self.light.sample(u, position)

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the density of ``sample`` [sr⁻¹]."""
        return self.light.pdf(direction, position)

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light is."""
        return self.light.distance_along(direction, position)

    def dome(self, position: FloatArray) -> tuple[FloatArray, ...] | None:
        """Return the light's own dome, or None where something is in front of it."""
        return None if self.hides(position) else self.light.dome(position)

    def flux(self) -> Estimate | None:
        """Return the flux [W] that the light sends out, whatever stops it on its way."""
        return self.light.flux()

    # --- what is left of it ---

    def pieces(self, position: FloatArray, normal: FloatArray) -> Sequence[Emitter] | None:
        """Return the parts of the light that are lit, each smooth; None where their edges are not known."""
        sight = self._sight(position)
        found = sight.above(normal)
        if not found.bodies:
            return self.light.pieces(position, normal)
        if found.dark:
            return ()
        patches = found.patches(normal)
        if patches is None or sight.silhouette is None:
            return None
        radiance = sight.silhouette.radiance
        return [
            Piece(light=self.light, patch=patch, radiance=radiance, precision=tilted(patch, normal))
            for patch in patches
        ]

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return the solid angle [sr] of what is seen of the light, by the sizes of its patches at the worst.

        ``converged`` is False, and the bound all that could be hidden, where neither is known.
        """
        sight = self._sight(position)
        whole = self.light.solid_angle(position)
        if self.delta or not sight.bodies:
            return whole
        if sight.dark:
            return _NOTHING
        found = sight.solid_angle(whole)
        if found is not None:
            return found
        value = 0.5 * float(whole.value)
        note = "no closed form for what is hidden"
        return Estimate(value, value + whole.error, "truncation", method="bound", converged=False, note=note)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate | None:
        """Return the closed-form irradiance [W m⁻²] of what is seen, or None where there is none."""
        if self.delta:
            directions, arriving = self.light.incident(position)
            seen = self.visible(directions, position)
            if np.all(seen):
                return self.light.irradiance_at(position, normal)
            cosine = np.maximum(directions[seen] @ normal, 0.0)
            value = np.sum(times(arriving[seen], cosine), axis=0)[()]
            bound = 8 * _EPS * np.sum(arriving[seen], axis=0)[()]
            return Estimate(value, bound, "rounding", method="closed form")
        found = self._sight(position).above(normal)
        if not found.bodies:
            return self.light.irradiance_at(position, normal)
        if found.dark:
            return _NOTHING if self.wavelengths is None else _NOTHING.scaled(np.zeros(self.wavelengths))
        return found.irradiance(normal)

    def _sight(self, position: FloatArray) -> _Sight:
        return _sight(self, tuple(np.asarray(position, dtype=float).tolist()))


@lru_cache(maxsize=64)
def _sight(behind: Shadowed, position: tuple[float, ...]) -> _Sight:
    light, origin = behind.light, np.array(position)
    shapes = [item.shape(origin) for item in behind.occluders]
    bodies = [body for body in shapes if body is not None]
    if light.delta:
        directions, _ = light.incident(origin)
        reach = light.distance_along(directions, origin)
        bodies = [body for body in bodies if np.any(blocked(body, directions, reach))]
        return _Sight(light, origin, None, tuple((body, "unsure") for body in bodies))
    if not light.solid_angle(origin).value > 0:
        return _Sight(light, origin, None, ())
    silhouette = light.silhouette(origin)
    if silhouette is None:
        return _Sight(light, origin, None, tuple((body, "unsure") for body in bodies))
    placed = [(body, relation(body, silhouette.body)) for body in bodies]
    kept = [pair for pair in placed if pair[1] != "apart"]
    around = [pair for pair in kept if pair[1] == "around"]
    return _Sight(light, origin, silhouette, tuple(around[:1] or _undoubled(kept)))


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
class _Sight:
    """A light from one point, and the bodies that may hide some of it."""

    light: Emitter
    position: FloatArray
    silhouette: Silhouette | None
    placed: tuple[tuple[Body, Relation], ...]

    @cached_property
    def bodies(self) -> list[Body]:
        return [body for body, _ in self.placed]

    @property
    def dark(self) -> bool:
        """Whether nothing is seen of the light."""
        return any(how == "around" for _, how in self.placed)

    @property
    def sure(self) -> bool:
        return self.silhouette is not None and not any(how == "unsure" for _, how in self.placed)

    @cached_property
    def facets(self) -> list[Facets]:
        return [body for body in self.bodies if isinstance(body, Facets)]

    @cached_property
    def rounds(self) -> list[tuple[Ball | Plate, Relation]]:
        return [(body, how) for body, how in self.placed if not isinstance(body, Facets)]

    def above(self, normal: FloatArray) -> _Sight:
        """Return the same without the bodies that are wholly below a receiver's horizon.

        A sky's own horizon does not count where it is the receiver's.
        """
        up, silhouette = rational(normal), self.silhouette
        kept = [pair for pair in self.placed if place(pair[0], Dome((up,))) != "apart"]
        if silhouette is not None and isinstance(silhouette.body, Dome):
            others = [n for n in silhouette.body.normals if any(cross(n, up)) or inner(n, up) < 0]
            silhouette = replace(silhouette, body=Dome(tuple(others)))
            kept = [(body, relation(body, silhouette.body)) for body, _ in kept]
        return _Sight(self.light, self.position, silhouette, tuple(kept))

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
            return _joined(_around(cone, holes) for cone in cones)
        horizon = rational(normal)
        if isinstance(light, Dome):
            return _pierced([horizon, *light.normals], None, normal, holes)
        beside: list[list[RationalVector]] = [[horizon]]
        for body in self.facets:
            for part in body.parts:
                beside = [rest for planes in beside for rest in _outside(planes, sides(part))]
        axis = _axis(light)
        return _joined(_pierced(planes, light.cone, axis, holes) for planes in beside)


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


def _joined(parts: Any) -> list[Patch] | None:
    found: list[Patch] = []
    for part in parts:
        if part is None:
            return None
        found += part
    return found


def _outside(planes: list[RationalVector], edges: Sequence[RationalVector]) -> Iterator[list[RationalVector]]:
    """Yield the parts of a region that are outside a convex cone of these edges."""
    inside = list(planes)
    for x, y, z in edges:
        yield [*inside, (-x, -y, -z)]
        inside = [*inside, (x, y, z)]


def _around(cone: Cone, holes: Sequence[Ball | Plate]) -> Sequence[Patch] | None:
    """Return patches of a convex cone of straight sides outside of round holes."""
    met = []
    for hole in holes:
        if all(hole.cone.holds(p) for p in cone):
            return ()
        crossed = any(hole.cone.crossed_by(cone[k - 1], p) for k, p in enumerate(cone))
        if crossed or all(_positive(side, hole.cone.center) for side in sides(cone)):
            met.append(hole)
    if not met:
        return fan(corners(cone))
    return _pierced(sides(cone), None, _axis(met[0]), met)


def _positive(side: RationalVector, w: RationalVector) -> bool:
    return side[0] * w[0] + side[1] * w[1] + side[2] * w[2] > 0


def _pierced(
    planes: Sequence[RationalVector], cone: CircleCone | None, axis: FloatArray, holes: Sequence[Ball | Plate]
) -> list[Patch] | None:
    """Return patches between planes and within a cone, outside of round holes.

    Planes part holes that lie apart; those that overlap must have a direction in common.
    """
    for first, second in combinations(holes, 2):
        plane = _between(first, second)
        if plane is None:
            continue
        halves = []
        for sign in (1, -1):
            side = (sign * plane[0], sign * plane[1], sign * plane[2])
            left = [hole for hole in holes if hole.cone.to_half_space(side) != "apart"]
            halves.append(_pierced([*planes, side], cone, axis, left))
        return _joined(halves)
    middle = _common(holes) if holes else axis
    return None if middle is None else list(Region(middle, planes, cone, [hole.cone for hole in holes]).arcs)


def _common(holes: Sequence[Ball | Plate]) -> FloatArray | None:
    """Return a direction inside of all of these cones, if one is found."""
    axes = np.array([_axis(hole) for hole in holes])
    for weights in (np.ones(len(axes)), *np.eye(len(axes)), *(np.eye(len(axes)) + 0.2), *_mixed(axes)):
        middle = weights @ axes
        size = float(np.sqrt(middle @ middle))
        if size > 0 and all(hole.cone.holds(middle / size) for hole in holes):
            return np.asarray(middle / size)
    return None


def _mixed(axes: FloatArray) -> FloatArray:
    """Return weights (N, K), the evenly spread ones of K axes."""
    weights = kronecker(64, max(len(axes), 2))[:, : len(axes)]
    return np.asarray(weights / weights.sum(axis=1)[:, None])


def _axis(body: Ball | Plate) -> FloatArray:
    return body.axis if isinstance(body, Ball) else body.axes[2]


def _between(first: Ball | Plate, second: Ball | Plate) -> RationalVector | None:
    """Return a plane with one cone on its positive side and another on its negative one, if one is found."""
    a, b = _axis(first), _axis(second)
    across = np.cross(np.cross(a, b), a)
    size = float(np.sqrt(across @ across))
    if not size > 0:
        return None
    across /= size
    angle = float(np.arctan2(size, a @ b))
    for share in (0.5, *(np.arange(1, 32) / 32)):
        s = angle * float(share)
        plane = rational(np.sin(s) * a - np.cos(s) * across)
        if (first.cone.to_half_space(plane), second.cone.to_half_space(plane)) == ("within", "apart"):
            return plane
    return None
