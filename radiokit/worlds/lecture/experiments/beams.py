"""Beams: numbers for the symbols of a printed formula, from radiokit's lights and materials."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import bsdf
from radiokit.contracts.emitter import emitter
from radiokit.worlds.scene import irradiance, solid_angle
from radiokit.worlds.shading import shade

__all__ = ["diffuse", "from_a_point", "hemisphere", "lamp", "onto_a_surface", "reflected", "two_lamps"]

_TILT = 0.7  # of the surface against the beam [rad]
_AREA = 1e-6  # dS [m²]
_WO = (0.0, 0.6, 0.8)


def onto_a_surface() -> Mapping[str, float]:
    """A narrow beam from a small disk of radiance 3 onto a tilted surface, and the same beam sent back."""
    towards = np.array([math.sin(_TILT), 0.0, math.cos(_TILT)])
    disk = emitter("disk", center=tuple(2 * towards), radius=1e-4, normal=tuple(-towards), radiance=3.0)
    arriving, cone = float(irradiance(disk).value), float(solid_angle(disk).value)
    flux = arriving * _AREA
    return {
        "L": 3.0,
        "θ": _TILT,
        "dω": cone,
        "dS": _AREA,
        "d2Φ": flux,
        "dE": arriving,
        "dM": arriving,
        "dI": flux / cone,
    }


def from_a_point() -> Mapping[str, float]:
    """The flux of a point light of 5 W/sr onto a small square that faces it from 2 m."""
    light = emitter("point", position=(0, 0, 2), intensity=5.0)
    flux = float(irradiance(light).value) * _AREA
    value = flux / _AREA
    return {"I": 5.0, "dΦ": flux, "dω": _AREA / 4, "dS": _AREA, "E": value, "M": value}


def lamp(isotropic: bool) -> Mapping[str, float]:
    """The flux of an isotropic lamp, or of a spotlight, of 2 W/sr along its axis."""
    more = {} if isotropic else {"direction": (0, 0, 1), "inner": 0.3, "outer": 0.6}
    light = emitter("point" if isotropic else "spot", position=(0, 0, 0), intensity=2.0, **more)
    flux = light.flux()
    assert flux is not None
    return {"I": 2.0, "Полный поток": float(flux.value)}


def reflected() -> Mapping[str, float]:
    """What a rough surface reflects of the narrow beam."""
    beam = onto_a_surface()
    towards = np.array([math.sin(_TILT), 0.0, math.cos(_TILT)])
    disk = emitter("disk", center=tuple(2 * towards), radius=1e-4, normal=tuple(-towards), radiance=3.0)
    f = bsdf("ggx", alpha=0.5)
    radiance = float(shade(f, disk, _WO).value)
    return {**beam, "L_i": 3.0, "dL_o": radiance, "f_r": float(f(towards, _WO))}


def hemisphere(name: str = "phong", **parameters: Any) -> Mapping[str, Any]:
    """A surface under a sky of radiance 2: its BRDF on a grid of directions, and what it reflects."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    mu, phi = np.meshgrid(0.5 * (nodes + 1), 2 * math.pi * np.arange(64) / 64, indexing="ij")
    sine = np.sqrt((1 - mu) * (1 + mu))
    wi = np.stack([sine * np.cos(phi), sine * np.sin(phi), mu], axis=-1).reshape(-1, 3)
    f = bsdf(name, **parameters)
    seen = float(shade(f, emitter("constant", radiance=2.0), (0.0, 0.0, 1.0)).value)
    return {
        "L": seen,
        "f_r": np.asarray(f(wi, np.broadcast_to((0.0, 0.0, 1.0), wi.shape))),
        "L_i": np.full(len(wi), 2.0),
        "θ": np.arccos(mu).ravel(),
        "dω": np.repeat(0.5 * weights * 2 * math.pi / 64, 64),
    }


def diffuse(reflectance: float) -> Mapping[str, float]:
    """The value of a diffuse BRDF."""
    return {"f": float(bsdf("lambert", reflectance=reflectance)(_WO, _WO))}


def two_lamps(factor: str) -> Mapping[str, float]:
    """Two small balls alike, on both sides of a diffuse surface; L_i is their radiance, or irradiance."""
    x, z, radius = 1.2, 1.6, 1e-3
    balls = [emitter("sphere", center=(side * x, 0, z), radius=radius, radiance=3.0) for side in (-1, 1)]
    f = bsdf("lambert", reflectance=0.5)
    light = {"radiance": 3.0, "irradiance": 3.0 * math.pi * radius**2 / (x * x + z * z)}[factor]
    seen = float(shade(f, balls, _WO).value)
    return {"L": seen, "f_r": 0.5 / math.pi, "L_i": light, "θ": math.atan2(x, z), "n": 2}
