"""Functions of assignment 2: its inputs, and what is right for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from radiokit.bsdfs.blinn_phong import BlinnPhong
from radiokit.bsdfs.lambert import Lambert
from radiokit.bsdfs.phong import Phong
from radiokit.bsdfs.phong_original import PhongOriginal
from radiokit.contracts.bsdf import BSDF
from radiokit.facts.directions import reflect, spherical_to_cartesian

__all__ = [
    "asymmetry",
    "blinn_phong",
    "by_row",
    "half_cosine",
    "hard_pairs",
    "hard_values",
    "lambert",
    "mirror_cosine",
    "mixed",
    "mixed_values",
    "ordinary_pairs",
    "phong",
    "phong_original",
    "unlike",
]

Array = Any
Inputs = dict[str, Any]
Parameter = Callable[[np.random.Generator, int], Array]

ORDINARY = 48
"""Pairs of the ordinary inputs."""


def ordinary_pairs(**parameters: Parameter) -> Callable[[np.random.Generator], Inputs]:
    """Return inputs: pairs up to 75° from the normal, and parameters.

    Half of the pairs are near the mirror pair, and an eighth beyond 90° from it.
    """

    def inputs(rng: np.random.Generator) -> Inputs:
        wo = _upper(rng, ORDINARY, 75.0)
        wi = _upper(rng, ORDINARY, 75.0)
        near = np.arange(ORDINARY) % 2 == 0
        wi[near] = _moved(rng, reflect(wo[near]), 0.3)
        back = np.arange(ORDINARY) % 8 == 1
        oblique = np.radians(rng.uniform(55, 75, back.sum()))
        wo[back] = spherical_to_cartesian(oblique, rng.uniform(0, 2 * np.pi, back.sum()))
        wi[back] = _moved(rng, wo[back], 0.1)
        return {"wi": wi, "wo": wo, **{name: draw(rng, ORDINARY) for name, draw in parameters.items()}}

    return inputs


def hard_pairs(**parameters: Parameter) -> Callable[[np.random.Generator], Inputs]:
    """Return inputs: grazing, at and below the horizon, exact mirror pairs, equal ones, along the normal."""

    def inputs(rng: np.random.Generator) -> Inputs:
        up = _upper(rng, 8, 80.0)
        normal = np.broadcast_to([0.0, 0.0, 1.0], (8, 3))
        low = spherical_to_cartesian(
            np.radians(90 - 10.0 ** rng.uniform(-3, 0.5, 8)), rng.uniform(0, 6.28, 8)
        )
        other = spherical_to_cartesian(
            np.radians(90 - 10.0 ** rng.uniform(-3, 0.5, 8)), rng.uniform(0, 6.28, 8)
        )
        down = up * [1.0, 1.0, -1.0]
        flat = spherical_to_cartesian(np.full(8, np.pi / 2), rng.uniform(0, 6.28, 8)) * [1.0, 1.0, 0.0]
        pairs = [
            (low, other),
            (low, _moved(rng, reflect(low), 1e-3)),
            (low, up),
            (up, reflect(up)),
            (up, up),
            (normal, up),
            (up, normal),
            (normal, normal),
            (down, _upper(rng, 8, 80.0)),
            (_upper(rng, 8, 80.0), down),
            (down, reflect(down)),
            (up, -up),
            (flat, up),
            (up, flat),
        ]
        wi, wo = (np.concatenate([pair[k] for pair in pairs]) for k in (0, 1))
        return {"wi": wi, "wo": wo, **{name: draw(rng, len(wi)) for name, draw in parameters.items()}}

    return inputs


def _upper(rng: np.random.Generator, count: int, most_deg: float) -> Array:
    """Return directions of uniform density up to an angle from the normal."""
    cosine = rng.uniform(np.cos(np.radians(most_deg)), 1.0, count)
    return spherical_to_cartesian(np.arccos(cosine), rng.uniform(0, 2 * np.pi, count))


def _moved(rng: np.random.Generator, w: Array, size: float) -> Array:
    """Return directions about ``size`` [rad] away, but above the horizon."""
    moved = w + size * rng.normal(size=w.shape)
    moved[:, 2] = np.maximum(np.abs(moved[:, 2]), 1e-6)
    return moved / np.linalg.norm(moved, axis=1)[:, None]


def by_row(make: Callable[..., BSDF]) -> Callable[..., Array]:
    """Return f(wi, wo, **parameters) for arrays of parameters: of each row the value of its own model."""

    def values(wi: Array, wo: Array, **parameters: Array) -> Array:
        columns = {name: np.broadcast_to(value, len(wi)) for name, value in parameters.items()}
        models = [
            make(**{name: float(value[row]) for name, value in columns.items()}) for row in range(len(wi))
        ]
        rows = [slice(row, row + 1) for row in range(len(wi))]
        return np.concatenate([f.evaluate(wi[k], wo[k]) for f, k in zip(models, rows, strict=True)])

    return values


def lambert(reflectance: float) -> BSDF:
    """Return the model of the first question."""
    return Lambert(reflectance=reflectance)


def phong_original(exponent: float, coefficient: float) -> BSDF:
    """Return Phong's lobe of 1975 as a BRDF."""
    return PhongOriginal(exponent=exponent, coefficient=coefficient)


def phong(exponent: float) -> BSDF:
    """Return the modified lobe."""
    return Phong(exponent=exponent)


def blinn_phong(exponent: float) -> BSDF:
    """Return the lobe about the half vector that is 1 at normal incidence."""
    return BlinnPhong(exponent=exponent)


def mixed(diffuse: float, specular: float, exponent: float) -> BSDF:
    """Return the mixture, scaled down where the two shares exceed the whole."""
    whole = max(1.0, diffuse + specular)
    return diffuse / whole * Lambert() + specular / whole * Phong(exponent=exponent)


def mixed_values(wi: Array, wo: Array, diffuse: Array, specular: Array, exponent: Array) -> Array:
    """Return the values of ``mixed`` for arrays of parameters."""
    lobe = by_row(phong)(wi, wo, exponent=exponent)
    return (diffuse * Lambert().evaluate(wi, wo) + specular * lobe) / np.maximum(1.0, diffuse + specular)


def mirror_cosine(wi: Array, wo: Array) -> Array:
    """Return max(0, wi · r) with r the mirror direction of wo."""
    return np.maximum(np.sum(wi * wo * [-1, -1, 1], axis=-1), 0.0)


def half_cosine(wi: Array, wo: Array) -> Array:
    """Return h · n, 0 where a direction is not above the horizon."""
    h = wi + wo
    length = np.sqrt(np.sum(h * h, axis=-1))
    cosine = h[..., 2] / np.where(length > 0, length, 1.0)
    return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), cosine, 0.0)


def unlike(rng: np.random.Generator) -> Inputs:
    """Return values of a BRDF both ways, up to three times as large one way as the other."""
    a = 10.0 ** rng.uniform(-3, 2, 24)
    return {"a": a, "b": a * 10.0 ** rng.uniform(-0.5, 0.5, 24)}


def hard_values(rng: np.random.Generator) -> Inputs:
    """Return such values that are alike, 0 on one side or on both, tiny, or differ in their last digits."""
    a, b = unlike(rng).values()
    a[:4], b[2:6] = 0.0, 0.0
    b[6:9] = a[6:9]
    a[9:12], b[9:12] = a[9:12] * 1e-200, b[9:12] * 1e-200
    b[12:14] = a[12:14] * (1 + 2.0**-20)
    return {"a": a, "b": b}


def asymmetry(a: Array, b: Array) -> Array:
    """Return |a − b| / max(a, b), 0 where both are 0."""
    larger = np.maximum(a, b)
    return np.abs(a - b) / np.where(larger > 0, larger, 1.0)
