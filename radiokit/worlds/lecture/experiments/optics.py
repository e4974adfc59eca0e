"""Optics: rays against waves, the laws of reflection and refraction as shortest times, and polarisation."""

from __future__ import annotations

import math

import numpy as np

from radiokit.contracts.bsdf import bsdf
from radiokit.facts.verdict import Verdict
from radiokit.physics import fresnel
from radiokit.worlds.lecture.deciding import found

__all__ = [
    "channel_means",
    "edge_of_a_shadow",
    "photon_energy",
    "polarised_and_not",
    "reflection_by_least_time",
    "refraction_by_least_time",
    "reversed_path",
    "slit",
    "transverse",
    "two_beams",
    "two_reflections",
]

_PLANCK, _LIGHT, _ELECTRON = 6.62607015e-34, 299_792_458.0, 1.602176634e-19


def photon_energy(
    metal_work: float = 2.28, strong: float = 700.0, weak: float = 400.0
) -> tuple[Verdict, ...]:
    """Sodium (2.28 eV): no electron however strong the red light, one for each of the few violet quanta."""
    energies = [_PLANCK * _LIGHT / (1e-9 * wavelength) / _ELECTRON for wavelength in (strong, weak)]
    return tuple(
        found(
            f"{wavelength:g} nm frees {'an' if expected else 'no'} electron",
            energy > metal_work,
            expected,
            0,
            f"a quantum of {wavelength:g} nm has {energy:.3g} eV, and {metal_work:g} eV are needed",
        )
        for wavelength, energy, expected in zip((strong, weak), energies, (False, True), strict=True)
    )


def channel_means(bounces: int = 2) -> Verdict:
    """Light on a paint that reflects half of the band: the mean of ρⁿ is not the nth power of the mean."""
    reflectance = np.repeat([0.0, 1.0], 500)
    spectral, channel = float(np.mean(reflectance**bounces)), float(np.mean(reflectance) ** bounces)
    return found(
        "a channel's mean must not be multiplied in the place of the spectrum",
        spectral / channel,
        2.0 ** (bounces - 1),
        1e-12,
        f"after {bounces} reflections {spectral:g} of the light is left; one number a channel gives "
        f"{channel:g}",
    )


def edge_of_a_shadow(clearance: float) -> tuple[Verdict, ...]:
    """Light so many √(λz/2) from the edge of a geometric shadow, by Fresnel's integrals."""
    from scipy.special import fresnel as integrals

    verdicts = []
    for v, expected in ((clearance, 1.0), (-clearance, 0.0)):
        s, c = integrals(v)
        light = 0.5 * ((c + 0.5) ** 2 + (s + 0.5) ** 2)
        message = f"{v:g} √(λz/2) from the edge the light is {light:.4g} of {expected:g}"
        verdicts.append(found("rays are straight", light, expected, 1e-3, message))
    return tuple(verdicts)


def two_beams(coherent: bool) -> Verdict:
    """Two beams of strength 1 each where they cross: of one phase relation, or of all in turn."""
    phases = np.array([math.pi]) if coherent else 2 * math.pi * np.arange(64) / 64
    strength = float(np.mean(np.abs(1 + np.exp(1j * phases)) ** 2))
    kind = "coherent beams in opposite phase" if coherent else "incoherent beams"
    return found("1 + 1 = 2", strength, 2.0, 1e-12, f"1 + 1 gives {strength:.3g} for {kind}")


def slit() -> tuple[Verdict, ...]:
    """The pattern of a slit as a sum of elementary waves: only the ratio of width and wavelength counts."""
    sines = np.linspace(0.0, 0.3, 61)

    def pattern(width: float, wavelength: float) -> np.ndarray:
        x = (np.arange(4096) + 0.5) / 4096 - 0.5
        phases = np.exp(2j * math.pi * width / wavelength * np.outer(sines, x))
        return np.abs(phases.mean(axis=1)) ** 2

    narrow, scaled, wide = pattern(5e-6, 5e-7), pattern(1e-5, 1e-6), pattern(1e-5, 5e-7)
    same, other = float(np.max(np.abs(narrow - scaled))), float(np.max(np.abs(narrow - wide)))
    return (
        found(
            "the same ratio, the same pattern",
            same,
            0.0,
            1e-12,
            f"width and λ doubled: they differ by {same:.1g}",
        ),
        found(
            "another ratio, another pattern", other > 0.1, True, 0, f"only the width doubled: by {other:.2g}"
        ),
    )


def reflection_by_least_time() -> tuple[Verdict, ...]:
    """The shortest way from A by a flat mirror to B, found by a search, and the mirror's lobe."""
    from scipy.optimize import minimize_scalar

    a, b = (-1.0, 0.7), (2.0, 1.1)
    length = lambda x: math.hypot(x - a[0], a[1]) + math.hypot(b[0] - x, b[1])  # noqa: E731
    x = minimize_scalar(length, bounds=(-1.0, 2.0), method="bounded", options={"xatol": 1e-12}).x
    arriving, leaving = math.atan2(x - a[0], a[1]), math.atan2(b[0] - x, b[1])
    wo = np.array([[math.sin(leaving), 0.0, math.cos(leaving)]])
    (lobe,) = bsdf("mirror").delta_lobes(wo)
    wi = lobe.wi[0]
    return (
        found(
            "the angles are equal",
            math.degrees(leaving),
            math.degrees(arriving),
            1e-4,
            f"the shortest way arrives at {math.degrees(arriving):.5f}° and leaves at "
            f"{math.degrees(leaving):.5f}°",
        ),
        found("the mirror's lobe lies there", math.atan2(-wi[0], wi[2]), arriving, 1e-6, "so does the model"),
    )


def refraction_by_least_time(eta: float = 1.5) -> tuple[Verdict, ...]:
    """The fastest way from air into glass, found by a search, and the dielectric's lobe."""
    from scipy.optimize import minimize_scalar

    a, b = (-1.0, 0.7), (0.8, -1.1)
    length = lambda x: math.hypot(x - a[0], a[1]) + eta * math.hypot(b[0] - x, b[1])  # noqa: E731
    x = minimize_scalar(length, bounds=(-1.0, 0.8), method="bounded", options={"xatol": 1e-12}).x
    outside, inside = math.atan2(x - a[0], a[1]), math.atan2(b[0] - x, -b[1])
    lobes = bsdf("dielectric", eta=eta).delta_lobes(np.array([[-math.sin(outside), 0.0, math.cos(outside)]]))
    below = next(lobe.wi[0] for lobe in lobes if lobe.wi[0, 2] < 0)
    return (
        found(
            "n sinθ is the same on both sides",
            eta * math.sin(inside),
            math.sin(outside),
            1e-6,
            f"the fastest way has n sinθ = {math.sin(outside):.7f} above and {eta * math.sin(inside):.7f} "
            f"below",
        ),
        found("the model refracts there", math.atan2(below[0], -below[2]), inside, 1e-6, "so does the model"),
    )


def reversed_path(eta: float = 1.5) -> tuple[Verdict, ...]:
    """There and back through a surface: the same path, and the same share is reflected."""
    cosines = np.linspace(0.05, 1.0, 20)
    sines = np.sqrt((1 - cosines) * (1 + cosines))
    inside = np.sqrt(1 - (sines / eta) ** 2)
    there, back = fresnel.dielectric(cosines, eta), fresnel.dielectric(inside, 1 / eta)
    worst = float(np.max(np.abs(there - back)))
    wi = bsdf("dielectric", eta=eta).delta_lobes(np.array([[0.6, 0.0, 0.8]]))[1].wi
    returned = [lobe.wi[0] for lobe in bsdf("dielectric", eta=eta).delta_lobes(wi)]
    gap = min(float(np.linalg.norm(w - (0.6, 0.0, 0.8))) for w in returned)
    return (
        found(
            "one share both ways",
            worst,
            0.0,
            1e-12,
            f"the shares reflected there and back differ by {worst:.1g}",
        ),
        found("one path both ways", gap, 0.0, 1e-12, f"the path back ends {gap:.1g} from where it began"),
    )


def polarised_and_not(theta_deg: float, eta: float = 1.5) -> tuple[float, float]:
    """Return the reflectances of the two polarisations, s and p, by Fresnel's formulas.

    >>> s, p = polarised_and_not(56.309932474)
    >>> round(s, 4), p < 1e-15
    (0.1479, True)
    """
    cosine = math.cos(math.radians(theta_deg))
    inside = math.sqrt(1 - (math.sin(math.radians(theta_deg)) / eta) ** 2)
    s = (cosine - eta * inside) / (cosine + eta * inside)
    p = (eta * cosine - inside) / (eta * cosine + inside)
    return s * s, p * p


def transverse() -> tuple[Verdict, ...]:
    """A wave that swings across its way has two polarisations: at Brewster's angle glass reflects one."""
    brewster = math.degrees(math.atan(1.5))
    s, p = polarised_and_not(brewster)
    mean = float(fresnel.dielectric(math.cos(math.radians(brewster)), 1.5))
    return (
        found(
            "p vanishes", p, 0.0, 1e-15, f"at {brewster:.2f}° glass reflects {s:.4f} of s and {p:.1g} of p"
        ),
        found("s does not", s > 0.1, True, 0, "so the light that is reflected is polarised"),
        found("radiokit's value is the mean", mean, 0.5 * (s + p), 1e-15, f"the mean is {mean:.4f}"),
    )


def two_reflections(theta_deg: float) -> Verdict:
    """Unpolarised light off two glasses in one plane: the square of the mean, and the mean of the squares."""
    s, p = polarised_and_not(theta_deg)
    without, truth = (0.5 * (s + p)) ** 2, 0.5 * (s * s + p * p)
    return found(
        "the unpolarised reflectance may be multiplied",
        without / truth,
        1.0,
        1e-9,
        f"two reflections at {theta_deg:.4g}° leave {truth:.5f}; without polarisation it would be "
        f"{without:.5f}",
    )
