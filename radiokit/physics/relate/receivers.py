"""Receivers: relations to irradiance."""

from __future__ import annotations

import math

from radiokit.physics.relate.common import (
    AXIS,
    CAMERA,
    EVEN,
    ISOTROPIC,
    POINT,
    SMALL,
    above_horizon,
    cos,
    five_times,
    pi,
    row,
    small,
    sr,
)
from radiokit.physics.relate.relation import Relation

__all__ = ["RELATIONS"]

RELATIONS: tuple[Relation, ...] = (
    row(
        "irradiance-from-intensity",
        "irradiance",
        "intensity distance",
        r"E = \frac{I \cos\theta}{r^2} \Omega_0",
        lambda intensity, distance, angle_deg: intensity * cos(angle_deg) / distance**2 * sr(),
        POINT,
        "irradiance-from-intensity",
        may=AXIS,
        notes=("diameter",),
        judge=five_times,
    ),
    row(
        "irradiance-on-area",
        "irradiance",
        "flux area",
        r"E = \frac{\Phi}{A}",
        lambda flux, area: flux / area,
        EVEN,
        "definition-graph",
    ),
    row(
        "irradiance-from-isotropic-flux",
        "irradiance",
        "flux distance",
        r"E = \frac{\Phi \cos\theta}{4 \pi r^2}",
        lambda flux, distance, angle_deg: flux * cos(angle_deg) / (4 * math.pi * distance**2),
        f"{ISOTROPIC}, and a point",
        "inverse-square-law",
        may=AXIS,
        notes=("diameter",),
        judge=five_times,
        pi="1",
    ),
    row(
        "irradiance-at-new-distance",
        "irradiance",
        "irradiance distance new_distance",
        r"E_s = E \frac{r^2}{s^2}",
        lambda irradiance, distance, new_distance: (
            irradiance * (distance / new_distance).to("").magnitude ** 2
        ),
        POINT,
        "inverse-square-law",
    ),
    row(
        "irradiance-from-solid-angle",
        "irradiance",
        "radiance solid_angle",
        r"E = L \Omega \cos\theta",
        lambda radiance, solid_angle, angle_deg: radiance * solid_angle * cos(angle_deg),
        SMALL,
        "irradiance-from-radiance",
        may=AXIS,
        judge=small,
    ),
    row(
        "irradiance-from-hemisphere",
        "irradiance",
        "radiance",
        r"E = \pi L",
        lambda radiance: pi() * radiance,
        "the same radiance arrives from the whole hemisphere",
        "irradiance-from-hemisphere",
    ),
    row(
        "irradiance-from-sphere",
        "irradiance",
        "radiance radius distance",
        r"E = \pi L \frac{R^2}{r^2} \cos\theta",
        lambda radiance, radius, distance, angle_deg: (
            pi() * radiance * (radius / distance) ** 2 * cos(angle_deg)
        ),
        "the source is a Lambertian sphere, r from its centre, all of it above the receiver's horizon",
        "irradiance-from-sphere",
        may=AXIS,
        judge=above_horizon,
    ),
    row(
        "irradiance-under-disk",
        "irradiance",
        "radiance radius distance",
        r"E = \pi L \frac{R^2}{R^2 + r^2}",
        lambda radiance, radius, distance: pi() * radiance * radius**2 / (radius**2 + distance**2),
        "the source is a Lambertian disk that faces the receiver, which is on its axis",
        "irradiance-under-disk",
    ),
    row(
        "irradiance-on-sensor",
        "irradiance",
        "radiance f_number",
        r"E = \frac{\pi \tau L \cos^4\theta}{4 N^2}",
        lambda radiance, f_number, angle_deg, transmittance: (
            pi() * radiance * transmittance * cos(angle_deg) ** 4 / (4 * f_number**2)
        ),
        CAMERA,
        "camera-equation",
        may={"angle_deg": 0.0, "transmittance": 1.0},
    ),
)
