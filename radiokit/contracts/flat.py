"""Flat emitter: what flat lights with straight edges share; a subclass only says where its corners are."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.parameters import choice, parameter
from radiokit.contracts.piece import Piece, TrianglePatch, tilted
from radiokit.facts.directions import dot
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.facts.source import Source
from radiokit.measure.outline import area_vector, triangulate
from radiokit.measure.sphericaltriangle import UniformSphericalTriangle
from radiokit.measure.triangle import UniformTriangle
from radiokit.physics import polygon
from radiokit.physics.facets import Facets, lies_on

__all__ = ["FlatEmitter"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_SLACK = 16 * _EPS


@dataclass(frozen=True, kw_only=True)
class FlatEmitter(Emitter):
    """A flat light of constant radiance that shines from its front, where its corners turn counter-clockwise.

    Directions are sampled evenly over the solid angle, or, with ``sampling="area"``, evenly over the area.
    """

    SOURCE: ClassVar[Source] = polygon.IRRADIANCE_SOURCE

    radiance: float = parameter("[0, inf)", "W/m^2/sr", "radiance, the same everywhere on it", default=1.0)
    sampling: str = choice("solid angle", "area", meaning="over what directions are evenly distributed")

    @property
    @abstractmethod
    def corners(self) -> FloatArray:
        """The corners (N, 3) [m]."""

    @cached_property
    def _triangles(self) -> FloatArray:
        return self.corners[triangulate(self.corners)]

    @cached_property
    def _normal(self) -> FloatArray:
        size = float(np.abs(self.corners).max())  # so that no square overflows
        direction = area_vector(self.corners / size)
        normal: FloatArray = direction / np.sqrt(dot(direction, direction))
        return normal

    @property
    def area(self) -> float:
        """The area [m²]."""
        return math.hypot(*area_vector(self.corners))

    def flux(self) -> Estimate:
        """Return the flux that leaves the front, Φ = πLA [W]."""
        value = math.pi * self.radiance * self.area
        return Estimate(value, 8 * float(np.finfo(float).eps) * value, "rounding", method="closed form")

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L for directions (N, 3) in which the front of the light lies, 0 for others [W m⁻² sr⁻¹]."""
        return np.where(_view(self, _key(position)).hit(direction), self.radiance, 0.0)

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
        for triangle in self._triangles:
            part = np.array(polygon.above((triangle - position).tolist(), normal.tolist()))
            for k in range(1, len(part) - 1):
                warp = UniformSphericalTriangle(vertices=part[[0, k, k + 1]])
                size, precision = warp.solid_angle, 0.0
                if len(part) == 3 and np.array_equal(part, triangle - position):
                    size = float(polygon.solid_angle(triangle, position).value)  # with all its digits
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
        self._check_off(position)
        return polygon.solid_angle(self.corners, np.asarray(position, dtype=float))

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return the irradiance on a receiver of any tilt, by Lambert's formula above its horizon [W m⁻²].

        Raises
        ------
        ParameterError
            When ``position`` is on the light.
        """
        self._check_off(position)
        found = polygon.irradiance(self.corners, np.asarray(position, dtype=float), np.asarray(normal))
        value = found.value * self.radiance
        error = found.error * self.radiance + (float(np.spacing(value)) if value else 0.0)
        return Estimate(value, error, "rounding", method="closed form")

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light's plane is along directions (N, 3)."""
        seen = _view(self, _key(position)).facets
        return np.full(len(direction), np.inf) if seen is None else seen.distance(direction)

    def silhouette(self, position: FloatArray) -> Silhouette | None:
        """Return the polygon, evenly bright; None where it is not seen."""
        seen = _view(self, _key(position)).facets
        return None if seen is None else Silhouette(seen, self.radiance)

    def _check_off(self, position: FloatArray) -> None:
        if lies_on(self.corners, self._triangles, position):
            place = tuple(map(float, position))
            raise ParameterError("position", place, "away from the light, on which it lies")


class _View:
    """A flat light as one receiver sees it."""

    def __init__(self, light: FlatEmitter, position: FloatArray) -> None:
        self.solid_angle = float(light.solid_angle(position).value)
        self._corners, self._position = light.corners, position
        self._by_area = light.sampling == "area"
        self._offset = light.corners[0] - position
        self._normal = light._normal
        self._area = light.area
        triangles = light._triangles - position
        following = np.roll(triangles, -1, axis=1)
        edges = np.roll(light._triangles, -1, axis=1) - light._triangles
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
        return Facets.seen(self._corners, self._position)

    def hit(self, direction: FloatArray) -> npt.NDArray[np.bool_]:
        """Return whether directions (N, 3) meet the front, with its edges and a few units of rounding."""
        if self.solid_angle == 0.0:
            return np.zeros(len(direction), dtype=bool)
        found = np.zeros(len(direction), dtype=bool)
        for planes, slack in zip(self._planes, self._slack, strict=True):
            found |= np.all(direction @ planes.T <= slack, axis=-1)
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
