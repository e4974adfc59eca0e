"""Quantities: experiments on flux, intensity, irradiance, radiance, and their photometric twins."""

from __future__ import annotations

import math

import numpy as np

from radiokit.contracts.emitter import emitter
from radiokit.facts.errors import QuantityKindError
from radiokit.facts.quantities import Q, quantity
from radiokit.facts.verdict import Verdict
from radiokit.physics import photometry, planck
from radiokit.worlds.lecture.deciding import found
from radiokit.worlds.scene import irradiance, solid_angle

__all__ = [
    "calorimeter",
    "cap_over_square",
    "cosine_law",
    "equal_units",
    "four_pi_lumens",
    "irradiance_and_exitance",
    "lumen",
    "observer",
    "one_steradian",
    "patch",
    "pixel",
    "platinum",
    "point_source",
    "through_vacuum",
    "total_flux",
]

_DOWN = (0.0, 0.0, -1.0)


def calorimeter(losses: float, absorptance: float = 1.0) -> Verdict:
    """A plate in a flux of 1 W: its heating, when it also loses ``losses`` times its heat meanwhile."""
    kept = 1.0 if losses == 0 else -math.expm1(-losses) / losses
    shown = absorptance * kept
    message = f"the heating shows {shown:.3f} W of 1 W"
    return found("heat gained per time is the flux", shown, 1.0, 1e-12, message)


def total_flux(isotropic: bool) -> Verdict:
    """∫ I dω over all directions, for an isotropic lamp and for a flat Lambertian one with I = I₀ cosθ."""
    nodes, weights = np.polynomial.legendre.leggauss(32)
    halves = [(0.5 * (nodes + 1) - side, 0.5 * weights) for side in (0, 1)]
    flux = sum(
        2 * math.pi * float(np.sum(w * (1.0 if isotropic else np.maximum(mu, 0.0)))) for mu, w in halves
    )
    lamp = "an isotropic lamp" if isotropic else "a flat Lambertian lamp"
    message = f"{lamp} of 1 W/sr along its axis gives {flux:.4f} W; 4π I is {4 * math.pi:.4f} W"
    return found("Φ = 4π I", flux, 4 * math.pi, 1e-12, message)


def cap_over_square() -> tuple[Verdict, ...]:
    """The cap that a cone cuts from spheres of several radii, over r², beside the solid angle by radiokit."""
    verdicts = []
    for radius in (0.5, 1.0, 3.0):
        half = 0.7
        disk = emitter("disk", center=(0, 0, 1), radius=math.tan(half), normal=_DOWN, radiance=1.0)
        cap = 4 * math.pi * radius**2 * math.sin(0.5 * half) ** 2
        value = float(solid_angle(disk).value)
        message = (
            f"r = {radius:g} m: {cap:.4f} m² / r² = {cap / radius**2:.6f}, radiokit finds {value:.6f} sr"
        )
        verdicts.append(found("Ω = A/r²", cap / radius**2, value, 1e-12, message))
    return tuple(verdicts)


def one_steradian() -> Verdict:
    """The cone that cuts 1 m² from the sphere of radius 1 m: sin²(α/2) = 1/(4π)."""
    half = 2 * math.asin(math.sqrt(1 / (4 * math.pi)))
    disk = emitter("disk", center=(0, 0, 1), radius=math.tan(half), normal=_DOWN, radiance=1.0)
    value = float(solid_angle(disk).value)
    return found(
        "it is 1 sr", value, 1.0, 1e-12, f"a cone of half-angle {math.degrees(half):.2f}° has {value:.9f} sr"
    )


def irradiance_and_exitance() -> tuple[Verdict, ...]:
    """Both are W/m², and radiokit refuses to add them."""
    first, second = quantity("irradiance")("1 W/m^2"), quantity("radiant_exitance")("1 W/m^2")
    try:
        first + second
        refused = False
    except QuantityKindError:
        refused = True
    same = quantity("irradiance").dimensionality == quantity("radiant_exitance").dimensionality
    return (
        found("the unit is the same", same, True, 0, "both are in W/m²"),
        found("the quantity is not", refused, True, 0, "they do not add: one arrives, the other leaves"),
    )


def equal_units(left: str, right: str) -> Verdict:
    """One unit in terms of others."""
    first, second = Q(left), Q(right)
    if first.dimensionality != second.dimensionality:
        units = f"{first.to_base_units()} and {second.to_base_units()}"
        message = f"{left} and {right} have different dimensions: {units}"
        return found(f"{left} = {right}", False, True, 0, message)
    ratio = float((first / second).to_base_units().magnitude)
    return found(f"{left} = {right}", ratio, 1.0, 1e-12, f"{left} = {ratio:.12g} × {right}")


def cosine_law(theta_deg: float = 60.0) -> Verdict:
    """Sunlight of 1 W/m² on a surface that is tilted away from it."""
    theta = math.radians(theta_deg)
    sun = emitter("directional", direction=(math.sin(theta), 0, math.cos(theta)), irradiance=1.0)
    value = float(irradiance(sun).value)
    return found(
        "E = E₀ cosθ", value, math.cos(theta), 1e-12, f"at {theta_deg:g}° arrives {value:.6f} of 1 W/m²"
    )


def point_source() -> tuple[Verdict, ...]:
    """Spheres of 1 W/sr at 1 m, smaller and smaller: the same irradiance, ever more radiance."""
    verdicts = []
    for radius in (0.1, 0.001):
        radiance = 1 / (math.pi * radius**2)
        value = float(irradiance(emitter("sphere", center=(0, 0, 1), radius=radius, radiance=radiance)).value)
        message = f"r = {radius:g} m: L = {radiance:.3g} W/(m² sr), E = {value:.6f} W/m²"
        verdicts.append(found("E = I/d² whatever the size", value, 1.0, 1e-12, message))
    return tuple(verdicts)


def patch(theta_deg: float) -> Verdict:
    """A Lambertian patch of radiance 1: its flux per solid angle and per unit of its own area."""
    theta = math.radians(theta_deg)
    disk = emitter(
        "disk", center=(math.sin(theta), 0, math.cos(theta)), radius=1e-4, normal=_DOWN, radiance=1.0
    )
    arriving = irradiance(disk, normal=(math.sin(theta), 0, math.cos(theta)))
    per_area = float(arriving.value) / (math.pi * 1e-8)
    message = f"seen at {theta_deg:g}°, flux per solid angle and area is {per_area:.6f} of the radiance"
    return found("L is flux per solid angle and area", per_area, 1.0, 1e-6, message)


def through_vacuum() -> tuple[Verdict, ...]:
    """The radiance of a ball, from the irradiance and the projected solid angle at several distances."""
    verdicts = []
    for distance in (2.0, 20.0, 1e6):
        ball = emitter("sphere", center=(0, 0, distance), radius=1.0, radiance=3.0)
        value = float(irradiance(ball).value) / (math.pi / distance**2)
        message = f"at {distance:g} m: {value:.12g} W/(m² sr)"
        verdicts.append(found("L does not change on the way", value, 3.0, 1e-11, message))
    return tuple(verdicts)


def pixel(fills: bool, twin: str = "") -> Verdict:
    """What a pixel of half-angle 1 mrad gets from a disk of 10 m, or 10 µm, at 1 m and at 10 m."""
    radius, cone = (10.0 if fills else 1e-5), 1e-3
    signals = []
    for distance in (1.0, 10.0):
        seen = min(radius, distance * math.tan(cone))
        disk = emitter("disk", center=(0, 0, distance), radius=seen, normal=_DOWN, radiance=1.0)
        signals.append(float(irradiance(disk).value))
    ratio = signals[1] / signals[0]
    what = "an object that fills the pixel" if fills else "a star"
    message = f"ten times as far, {what} gives {ratio:.4g} of the signal, though its {twin or 'radiance'} "
    "is the same"
    return found("the signal tells the radiance", ratio, 1.0, 1e-9, message)


def lumen(candelas: float) -> Verdict:
    """The flux of a source of so many candelas into 1 sr."""
    flux = (Q(f"{candelas} cd") * Q("1 sr")).to("lm").magnitude
    return found("1 lm", flux, 1.0, 1e-12, f"{candelas:g} cd into 1 sr is {flux:g} lm")


def four_pi_lumens() -> Verdict:
    """1 cd in every direction: ∫ I dω over the sphere."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    flux = 2 * math.pi * float(np.sum(weights * np.ones_like(nodes)))
    return found("4π lm", flux, 4 * math.pi, 1e-12, f"1 cd everywhere gives {flux:.6f} lm")


def observer() -> tuple[Verdict, ...]:
    """1 W of green and of red as the standard observer weighs them."""
    green, red = (683 * float(photometry.luminous_efficiency(wavelength_nm=nm)) for nm in (555.0, 680.0))
    return (
        found("1 W of green is 683 lm", green, 683.0, 0.01, f"1 W at 555 nm is {green:.1f} lm"),
        found("of red far less", red < 0.05 * green, True, 0, f"1 W at 680 nm is {red:.1f} lm"),
    )


def platinum() -> Verdict:
    """The luminance of a black body at the freezing point of platinum, once the candela's standard."""
    nm = np.linspace(380.0, 780.0, 2001)
    radiance = planck.spectral_radiance(wavelength_nm=nm, temperature=2041.4)
    efficacy = photometry.luminous_efficacy(wavelength_nm=nm, spectrum=radiance)
    luminance = efficacy * float(np.trapezoid(radiance, nm))
    message = f"1 cm² of a black body at 2041.4 K has {1e-4 * luminance:.1f} cd; 60 made the standard"
    return found("60 cd/cm²", 1e-4 * luminance, 60.0, 0.5, message)
