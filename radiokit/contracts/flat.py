"""Flat emitter: what flat lights with straight edges share; a subclass only says where its corners are."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import Spectrum, choice, parameter
from radiokit.contracts.piece import Piece, TrianglePatch, tilted
from radiokit.contracts.spectral import amount, weighted
from radiokit.facts.directions import dot
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.outline import area_vector, triangulate
from radiokit.measure.sphericaltriangle import UniformSphericalTriangle
from radiokit.measure.triangle import UniformTriangle
from radiokit.physics import polygon
from radiokit.physics.facets import Facets

__all__ = ["FlatEmitter"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_SLACK = 16 * _EPS
_FARTHEST = 1e150  # so that squares are floats


@dataclass(frozen=True, kw_only=True)
class FlatEmitter(Emitter):
    """A flat light of constant radiance that shines from its front, where its corners turn counter-clockwise.

    Directions are sampled evenly over the solid angle, or, with ``sampling="area"``, evenly over the area.
    """

    SOURCE: ClassVar[Source] = polygon.IRRADIANCE_SOURCE

    radiance: Spectrum = parameter(
        "[0, 1e100]", "W/m^2/sr", "radiance, the same everywhere on it", spectral=True, default=1.0
    )
    sampling: str = choice("solid angle", "area", meaning="over what directions are evenly distributed")

    @property
    @abstractmethod
    def corners(self) -> FloatArray:
        """The corners (N, 3) [m]."""

    @property
    def anchor(self) -> FloatArray:
        """The point (3,) [m] from which ``offsets`` are measured, so that small lights keep their shape."""
        return np.zeros(3)

    @property
    def offsets(self) -> FloatArray:
        """The corners (N, 3) [m] as seen from ``anchor``."""
        return self.corners

    @property
    def blur(self) -> float:
        """How far ``offsets`` may be from what the parameters say [m]: 0 where they are parameters."""
        return 0.0

    @cached_property
    def _indices(self) -> npt.NDArray[np.intp]:
        return triangulate(self.offsets)

    @cached_property
    def _normal(self) -> FloatArray:
        sides = self.offsets - self.offsets[0]
        direction = area_vector(sides / np.abs(sides).max())  # so that no square overflows, or underflows
        normal: FloatArray = direction / np.sqrt(dot(direction, direction))
        return normal

    @property
    def area(self) -> float:
        """The area [m²]."""
        return math.hypot(*area_vector(self.offsets))

    def flux(self) -> Estimate:
        """Return the flux that leaves the front, Φ = πLA [W]."""
        value = math.pi * amount(self.radiance) * self.area
        return Estimate(value, 8 * _EPS * value, "rounding", method="closed form")

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L for directions (N, 3) in which the front of the light lies, 0 for others [W m⁻² sr⁻¹]."""
        return weighted(_view(self, _key(position)).hit(direction), self.radiance)

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3) to the light, and densities (N,) [sr⁻¹].

        The densities are 0 for a receiver that sees no front; the directions then mean nothing.
        """
        view = _view(self, _key(position))
        if view.solid_angle == 0.0:
            return np.broadcast_to(self._normal, (len(u), 3)).copy(), np.zeros(len(u))
        direction = view.towards(u)
        if self.sampling == "area":
            return direction, view.per_area(direction)
        return direction, np.full(len(u), 1 / view.solid_angle)

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the density (N,) [sr⁻¹] with which ``sample`` picks ``direction``; 0 beside the light."""
        view = _view(self, _key(position))
        if view.solid_angle == 0.0:
            return np.zeros(len(direction))
        density = view.per_area(direction) if self.sampling == "area" else 1 / view.solid_angle
        return np.where(view.hit(direction), density, 0.0)

    def pieces(self, position: FloatArray, normal: FloatArray) -> Sequence[Emitter]:
        """Return the triangles that make up what of the light is above a receiver's horizon."""
        found: list[Emitter] = []
        if _view(self, _key(position)).solid_angle == 0.0:
            return found
        corners, origin = self._placed(position)
        for triangle in corners[self._indices]:
            part = np.array(polygon.above((triangle - origin).tolist(), normal.tolist()))
            for k in range(1, len(part) - 1):
                warp = UniformSphericalTriangle(vertices=part[[0, k, k + 1]])
                size, precision = warp.solid_angle, 0.0
                if len(part) == 3 and np.array_equal(part, triangle - origin):
                    size = float(polygon.solid_angle(triangle, origin).value)  # with all its digits
                elif size > 0.0:  # where the horizon cuts is rounded
                    precision = 8 * _EPS * warp.perimeter / size
                if size > 0.0:
                    patch = TrianglePatch(warp, size, precision)
                    loss = tilted(patch, normal)
                    found.append(Piece(light=self, patch=patch, radiance=self.radiance, precision=loss))
        return found

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return the solid angle [sr]: 0 from behind and from within the plane.

        Raises
        ------
        ParameterError
            When ``position`` is on the light.
        """
        corners, origin = self._placed(position)
        self._check_off(corners, origin, position)
        found = polygon.solid_angle(corners, origin)
        return replace(found, error=found.error + self._blurred(corners - origin, found.value))

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return the irradiance on a receiver of any tilt, by Lambert's formula above its horizon [W m⁻²].

        Raises
        ------
        ParameterError
            When ``position`` is on the light.
        """
        corners, origin = self._placed(position)
        self._check_off(corners, origin, position)
        found = polygon.irradiance(corners, origin, np.asarray(normal))
        radiance = amount(self.radiance)
        value = found.value * radiance
        error = (found.error + self._blurred(corners - origin, found.value)) * radiance
        error = error + np.where(value > 0, np.spacing(value), 0.0)[()]
        return Estimate(value, error, "rounding", method="closed form")

    def _placed(self, position: Any) -> tuple[FloatArray, FloatArray]:
        """Return the corners (N, 3) and the receiver (3,) as seen from the anchor; nothing of either is lost.

        What the rounding of the receiver's place takes away is given to the corners.
        """
        point, anchor = np.asarray(position, dtype=float), self.anchor
        if np.abs(point).max() > _FARTHEST:
            raise ParameterError("position", tuple(point.tolist()), f"within {_FARTHEST:g} m of the origin")
        origin = point - anchor
        back = origin - point
        lost = (point - (origin - back)) - (anchor + back)
        return self.offsets - lost, origin

    def _blurred(self, corners: FloatArray, value: float) -> float:
        """Return how far a solid angle may be off for corners that are off by ``blur``: ≤ blur ∮ ds/r²."""
        if not self.blur or (value == 0.0 and abs(float(corners[0] @ self._normal)) > 4 * self.blur):
            return 0.0
        total = 0.0
        edges = np.roll(self.offsets, -1, axis=0) - self.offsets  # far away the corners are one
        for a, along in zip(corners, edges, strict=True):
            length = math.hypot(*along)
            share = min(1.0, max(0.0, -float(a @ along) / length / length))
            nearest = max(math.hypot(*(a + share * along)), self.blur)
            total += min(length / nearest, math.pi) / nearest
        return self.blur * total

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light's plane is along directions (N, 3)."""
        seen = _view(self, _key(position)).facets
        return np.full(len(direction), np.inf) if seen is None else seen.distance(direction)

    def silhouette(self, position: FloatArray) -> Silhouette | None:
        """Return the polygon, evenly bright; None where it is not seen."""
        seen = _view(self, _key(position)).facets
        return None if seen is None else Silhouette(seen, self.radiance)

    def _check_off(self, corners: FloatArray, origin: FloatArray, position: FloatArray) -> None:
        offsets = corners - origin
        scale = float(np.abs(corners).max() + np.abs(origin).max())
        if np.min(np.abs(offsets @ self._normal)) > _SLACK * scale:
            return
        for a, b, c in self._indices:
            edges = ((a, b), (b, c), (c, a))
            sides = [_height(offsets[p], self.offsets[q] - self.offsets[p], self._normal) for p, q in edges]
            if all(side >= -_SLACK * scale for side in sides):
                place = tuple(map(float, position))
                raise ParameterError("position", place, "away from the light, on which it lies")


def _height(p: FloatArray, along: FloatArray, normal: FloatArray) -> float:
    """Return how far the origin is to the left of a line through p, in a plane with that normal."""
    size = math.hypot(*along)
    return float(np.cross(p, along / size) @ normal)


class _View:
    """A flat light as one receiver sees it."""

    def __init__(self, light: FlatEmitter, position: FloatArray) -> None:
        self.solid_angle = float(light.solid_angle(position).value)
        self._corners, self._origin = light._placed(position)
        if self.solid_angle == 0.0:
            return  # nothing is seen: no directions are asked for
        self._by_area = light.sampling == "area"
        corners, origin = self._corners, self._origin
        self._offset = corners[0] - origin
        self._normal = light._normal
        self._area = light.area
        triangles = corners[light._indices] - origin
        following = np.roll(triangles, -1, axis=1)
        edges = np.roll(light.offsets[light._indices], -1, axis=1) - light.offsets[light._indices]
        # Near corners and far ones alike give planes whose normals are of length 1, or 0 for a blind edge.
        size = np.sqrt(dot(triangles, triangles)) * np.sqrt(dot(edges, edges))
        self._planes = np.cross(triangles, edges) / size[..., None]
        lengths = np.sqrt(dot(triangles, triangles)), np.sqrt(dot(following, following))
        self._slack = _SLACK * np.maximum(1.0, lengths[1] / lengths[0])
        self._warps: list[UniformSphericalTriangle | UniformTriangle]
        if self._by_area:
            self._warps = [UniformTriangle(vertices=t) for t in triangles]
            shares = [warp.area for warp in self._warps if isinstance(warp, UniformTriangle)]
        else:
            self._warps = [UniformSphericalTriangle(vertices=t) for t in triangles]
            shares = [warp.solid_angle for warp in self._warps if isinstance(warp, UniformSphericalTriangle)]
        total = max(math.fsum(shares), 5e-324)
        self._steps = np.concatenate([[0.0], np.cumsum(shares) / total])
        self._steps[-1] = 1.0

    @cached_property
    def facets(self) -> Facets | None:
        """The polygon in rational numbers; None where it is not seen."""
        return Facets.seen(self._corners, self._origin)

    def hit(self, direction: FloatArray) -> npt.NDArray[np.bool_]:
        """Return whether directions (N, 3) meet the front, with its edges and a few units of rounding."""
        if self.solid_angle == 0.0:
            return np.zeros(len(direction), dtype=bool)
        found = np.zeros(len(direction), dtype=bool)
        for planes, slack in zip(self._planes, self._slack, strict=True):
            sides = planes @ direction.T  # many times as fast to reduce as along the short axis
            found |= np.all(sides <= slack[:, None], axis=0)
        return found

    def towards(self, u: FloatArray) -> FloatArray:
        """Return directions (N, 3) to points of the light: the first number also picks the triangle."""
        index = np.clip(np.searchsorted(self._steps, u[:, 0], side="right") - 1, 0, len(self._warps) - 1)
        directions = np.empty((len(u), 3))
        for k, warp in enumerate(self._warps):
            chosen = index == k
            if chosen.any():
                low, high = self._steps[k : k + 2]
                share = np.clip((u[chosen, 0] - low) / (high - low), 0.0, 1.0)
                directions[chosen] = warp.sample(np.stack((share, u[chosen, 1]), axis=-1))
        if self._by_area:
            directions /= np.sqrt(dot(directions, directions))[:, None]
        return directions

    def per_area(self, direction: FloatArray) -> FloatArray:
        """Return r²/(A cosθ), with θ at the light: a density that is even over the area, per solid angle."""
        cosine = -(direction @ self._normal)
        height = -float(self._offset @ self._normal)
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            density = height * height / (self._area * cosine**3)
        return np.where(cosine > 0, np.nan_to_num(density, posinf=np.finfo(float).max), 0.0)


def _key(position: Any) -> tuple[float, ...]:
    return tuple(np.asarray(position, dtype=float).tolist())


@lru_cache(maxsize=64)
def _view(light: FlatEmitter, position: tuple[float, ...]) -> _View:
    return _View(light, np.array(position))
