"""Enclosure: rooms whose walls light each other without end, by a random walk or in closed form.

``Sphere`` and ``Box`` are the rooms, ``Wall`` what their inside is made of, ``Cap`` a port, a sample or a
lamp on the sphere. ``radiance`` and ``irradiance`` ask for one point of a wall, ``flux`` for what falls on a
whole part of it, such as through a port.
"""

from radiokit.worlds.enclosure.answers import METHODS, flux, irradiance, radiance
from radiokit.worlds.enclosure.box import Box
from radiokit.worlds.enclosure.furnace import SOURCE, enclosure_radiance
from radiokit.worlds.enclosure.rooms import Room, Wall
from radiokit.worlds.enclosure.sphere import Cap, Sphere

__all__ = [
    "METHODS",
    "SOURCE",
    "Box",
    "Cap",
    "Room",
    "Sphere",
    "Wall",
    "enclosure_radiance",
    "flux",
    "irradiance",
    "radiance",
]
