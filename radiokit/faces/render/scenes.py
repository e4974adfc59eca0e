"""Scenes: what there is to render: a sphere, a plane, or a box, and how each may be lit."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.bsdfs.lambert import Lambert
from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.emitters.constant import Constant
from radiokit.emitters.directional import Directional
from radiokit.emitters.point import Point
from radiokit.emitters.rectangle import Rectangle
from radiokit.emitters.sky_overcast import SkyOvercast
from radiokit.faces.render.camera import Camera
from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.measure.rays import through_box, to_plane, to_sphere
from radiokit.worlds.enclosure import Box, Wall

__all__ = ["SCENES", "Hits", "Setting", "make_setting"]

FloatArray = npt.NDArray[np.float64]

BOX_LOW, BOX_HIGH = np.array([-1.0, -1.0, -1.0]), np.array([1.0, 1.0, 1.0])
BOX_COLOURS = ((0.63, 0.06, 0.05), (0.12, 0.45, 0.09), (0.73, 0.73, 0.73))
"""Reflectances of the walls on the left, on the right, and of the others."""


PANEL = Rectangle(center=(0, 0, 1), normal=(0, 0, -1), width=0.6, height=0.6, radiance=12.0)
"""The luminous panel in the ceiling of the box."""


@dataclass(frozen=True)
class Hits:
    """Where the pixels' rays end: points and normals (H, W, 3), and the material's number or −1.

    ``lamp`` marks the points of a wall on which a luminous panel lies.
    """

    position: FloatArray
    normal: FloatArray
    material: npt.NDArray[np.intp]
    lamp: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Setting:
    """A scene with its camera and its lights. ``trace`` finds what each ray meets."""

    name: str
    light: str
    camera: Camera
    materials: tuple[BSDF, ...]
    lights: tuple[Emitter, ...]
    trace: Callable[[Camera], Hits]

    @cached_property
    def room(self) -> Box | None:
        """The box as an enclosure, in which light bounces on; its front is open."""
        if self.name != "box":
            return None
        left, right, other = (Wall(f=material) for material in self.materials)
        walls = (left, right, Wall(), other, other, other)
        return Box(walls=walls, lights=self.lights, low=tuple(BOX_LOW), high=tuple(BOX_HIGH))

    def seen(self, direction: FloatArray, position: FloatArray) -> float:
        """Return the radiance of the lights themselves along a ray (3,) from a place (3,)."""
        return sum(
            float(light.radiance_from(direction[None, :], position)[0])
            for light in self.lights
            if not light.delta
        )


def _sphere(camera: Camera) -> Hits:
    origin, rays = np.array(camera.position), camera.rays
    distance = to_sphere(origin, rays.reshape(-1, 3), center=np.zeros(3), radius=1.0).reshape(rays.shape[:2])
    met = np.isfinite(distance)
    position = origin + np.where(met, distance, 0.0)[..., None] * rays
    normal = position / np.linalg.norm(position, axis=-1, keepdims=True)
    return Hits(normal, normal, np.where(met, 0, -1), np.zeros_like(met))


def _plane(camera: Camera) -> Hits:
    origin, rays = np.array(camera.position), camera.rays
    up = np.array([0.0, 0.0, 1.0])
    distance = to_plane(origin, rays.reshape(-1, 3), point=np.zeros(3), normal=up).reshape(rays.shape[:2])
    met = np.isfinite(distance)
    position = origin + np.where(met, distance, 0.0)[..., None] * rays
    position[..., 2] = 0.0
    return Hits(position, np.broadcast_to(up, rays.shape), np.where(met, 0, -1), np.zeros_like(met))


def _box(camera: Camera) -> Hits:
    """The inside of a box without its front, which is at −y."""
    origin, rays = np.array(camera.position), camera.rays
    _, leave, first, last = through_box(origin, rays.reshape(-1, 3), low=BOX_LOW, high=BOX_HIGH)
    met = np.isfinite(leave) & (first == 2)
    position = origin + np.where(met, leave, 0.0)[:, None] * rays.reshape(-1, 3)
    position = np.clip(position, BOX_LOW, BOX_HIGH)
    rows = np.flatnonzero(met)
    axis = last[rows] // 2
    ends = np.stack((BOX_LOW, BOX_HIGH))
    position[rows, axis] = ends[last[rows] % 2, axis]
    normal = np.zeros_like(position)
    normal[rows, axis] = np.where(last[rows] % 2, -1.0, 1.0)
    panel = (last == 5) & (np.abs(position[:, :2] - PANEL.center[:2]).max(axis=1) <= PANEL.width / 2)
    material = np.where(met, np.where(last == 0, 0, np.where(last == 1, 1, 2)), -1)
    shape = rays.shape[:2]
    found = position.reshape(rays.shape), normal.reshape(rays.shape), material.reshape(shape)
    return Hits(*found, (met & panel).reshape(shape))


_FURNACE: tuple[Emitter, ...] = (Constant(radiance=1.0),)
_SKY = SkyOvercast(radiance=0.6)
SCENES: dict[str, dict[str, tuple[Emitter, ...]]] = {
    "sphere": {
        "furnace": _FURNACE,
        "isothermal": _FURNACE,
        "lamp": (Point(position=(-3.0, -4.0, 4.0), intensity=100.0),),
        "sky": (_SKY, Directional(direction=(-1.0, -1.5, 1.2), irradiance=2.0)),
    },
    "plane": {
        "furnace": _FURNACE,
        "lamp": (Point(position=(0.5, 2.0, 1.5), intensity=8.0),),
        "sky": (_SKY, Directional(direction=(0.0, 2.0, 1.0), irradiance=0.4)),
    },
    "box": {"panel": (PANEL,)},
}
"""The lights of each scene, the default first; with ``isothermal`` the body also emits what it absorbs."""

_CAMERAS: dict[str, dict[str, Any]] = {
    "sphere": {"position": (0.0, -6.0, 0.0), "field": 0.36},
    "plane": {"position": (0.0, -3.0, 1.5), "target": (0.0, 0.0, 0.6), "field": 0.9},
    "box": {"position": (0.0, -4.6, 0.0), "field": 2 * math.atan(1 / 3.6)},
}
_TRACES = {"sphere": _sphere, "plane": _plane, "box": _box}


def make_setting(scene: str, f: Any = None, *, light: str | None = None, size: int = 64) -> Setting:
    """Return a scene with its camera, materials and lights.

    Parameters
    ----------
    scene : str
        ``sphere``, ``plane`` or ``box``.
    f : BSDF or callable, optional
        The material, Lambert of reflectance 0.8 when not given. The box has its own.
    light : str, optional
        One of those that ``SCENES`` lists for it; the first when not given.
    size : int
        Width and height in pixels.

    Raises
    ------
    UnknownNameError
        When there is no such scene, or no such light in it.
    ParameterError
        When a material is given for the box, or ``size`` is not allowed.
    """
    if scene not in SCENES:
        raise UnknownNameError("scene", scene, SCENES)
    light = next(iter(SCENES[scene])) if light is None else light
    if light not in SCENES[scene]:
        raise UnknownNameError(f"light of scene {scene!r}", light, SCENES[scene])
    if type(size) is not int or size < 1:
        raise ParameterError("size", size, "an integer, at least 1")
    if scene == "box":
        if f is not None:
            raise ParameterError("f", f, "left out: the box has walls of its own")
        materials: tuple[BSDF, ...] = tuple(Lambert(reflectance=colour) for colour in BOX_COLOURS)
    else:
        materials = (Lambert(reflectance=0.8) if f is None else as_bsdf(f),)
    camera = Camera(width=size, height=size, **_CAMERAS[scene])
    return Setting(scene, light, camera, materials, SCENES[scene][light], _TRACES[scene])
