"""Variants: what wrong solutions of assignment 2 give, by the misconception."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from radiokit.faces.grading.assignments._brdfs.functions import half_cosine, mirror_cosine

__all__ = [
    "ASYMMETRY",
    "BLINN_PHONG",
    "HALF_COSINE",
    "MIRROR_COSINE",
    "MIXED",
    "PHONG",
    "PHONG_ORIGINAL",
]

Array = Any
Cosine = Callable[[Array, Array], Array]
Function = Callable[..., Array]
Lobe = Callable[..., Array]
"""``lobe(c, wi, wo, **parameters)``: a BRDF above the horizon, from the cosine that it is a power of."""


def _dot(signs: tuple[int, int, int]) -> Cosine:
    """Return the cosine between wi and wo with the signs of its components changed so."""
    return lambda wi, wo: np.sum(wi * wo * signs, axis=-1)


def _of_half(of: str) -> Cosine:
    """Return the cosine between the half vector and the normal or the viewer."""

    def cosine(wi: Array, wo: Array) -> Array:
        h = wi + wo
        length = np.sqrt(np.sum(h * h, axis=-1))
        axis = {"normal": np.array([0.0, 0.0, 1.0]), "viewer": wo}[of]
        return np.sum(h * axis, axis=-1) / np.where(length > 0, length, 1.0)

    return cosine


def _clamped(c: Array) -> Array:
    return np.maximum(c, 0.0)


def _brdf(lobe: Lobe, cosine: Cosine) -> Function:
    """Return f(wi, wo, **parameters), 0 below the horizon."""

    def f(wi: Array, wo: Array, **parameters: Array) -> Array:
        with np.errstate(all="ignore"):
            found = lobe(_clamped(cosine(wi, wo)), wi, wo, **parameters)
        return np.where((wi[..., 2] > 0) & (wo[..., 2] > 0), found, 0.0)

    return f


def _about_mirror(lobe: Lobe) -> dict[str, Function]:
    return {
        "mirror-about-wrong-axis": _brdf(lobe, _dot((1, 1, -1))),
        "mirror-forgotten": _brdf(lobe, _dot((1, 1, 1))),
        "mirror-of-x-alone": _brdf(lobe, _dot((-1, 1, 1))),
        "mirror-of-y-alone": _brdf(lobe, _dot((1, -1, 1))),
        "half-for-mirror": _brdf(lobe, _of_half("normal")),
        **_powers(lobe, mirror_cosine),
    }


def _powers(lobe: Lobe, cosine: Cosine) -> dict[str, Function]:
    """Return what other exponents give, while the constant is right."""

    def wrong(power: Callable[[Array], Array]) -> Function:
        def other(c: Array, wi: Array, wo: Array, *, exponent: Array, **parameters: Array) -> Array:
            return lobe(np.ones_like(c), wi, wo, exponent=exponent, **parameters) * c ** power(exponent)

        return _brdf(other, cosine)

    return {
        "exponent-one-more": wrong(lambda n: n + 1),
        "exponent-one-less": wrong(lambda n: n - 1),
        "exponent-two-more": wrong(lambda n: n + 2),
        "exponent-ignored": wrong(lambda n: 1.0 + 0 * n),
    }


def _original(c: Array, wi: Array, wo: Array, *, exponent: Array, coefficient: Array) -> Array:
    return coefficient * c**exponent / wi[..., 2]


def _phong(c: Array, wi: Array, wo: Array, *, exponent: Array) -> Array:
    return (exponent + 2) / (2 * np.pi) * c**exponent


def _blinn_phong(c: Array, wi: Array, wo: Array, *, exponent: Array) -> Array:
    n = exponent
    return (n + 2) * (n + 4) / (8 * np.pi * (np.exp2(-n / 2) + n)) * c**n


def _times(lobe: Lobe, factor: Callable[[Array, Array], Array]) -> Function:
    """Return a lobe about the mirror direction times a function of both cosines."""

    def other(c: Array, wi: Array, wo: Array, **parameters: Array) -> Array:
        return lobe(c, wi, wo, **parameters) * factor(wi[..., 2], wo[..., 2])

    return _brdf(other, mirror_cosine)


def _mixed(combine: Callable[[Array, Array, Array], Array], normalised: bool = True) -> Function:
    def lobe(c: Array, wi: Array, wo: Array, *, diffuse: Array, specular: Array, exponent: Array) -> Array:
        scale = (exponent + 2) / (2 * np.pi) if normalised else 1.0
        return combine(diffuse, specular, scale * c**exponent)

    return _brdf(lobe, mirror_cosine)


def _whole(kd: Array, ks: Array) -> Array:
    return np.maximum(1.0, kd + ks)


def _angle(c: Array) -> Array:
    return np.arccos(np.clip(c, -1, 1))


def _ratio(top: Array, bottom: Array) -> Array:
    return np.where(bottom > 0, top / np.where(bottom > 0, bottom, 1.0), 0.0)


MIRROR_COSINE: Mapping[str, Function] = {
    "mirror-about-wrong-axis": lambda wi, wo: _clamped(_dot((1, 1, -1))(wi, wo)),
    "mirror-forgotten": lambda wi, wo: _clamped(_dot((1, 1, 1))(wi, wo)),
    "mirror-of-x-alone": lambda wi, wo: _clamped(_dot((-1, 1, 1))(wi, wo)),
    "mirror-of-y-alone": lambda wi, wo: _clamped(_dot((1, -1, 1))(wi, wo)),
    "half-for-mirror": lambda wi, wo: _clamped(_of_half("normal")(wi, wo)),
    "angle-for-cosine": lambda wi, wo: _angle(_dot((-1, -1, 1))(wi, wo)),
    "angle-in-degrees": lambda wi, wo: np.degrees(_angle(_dot((-1, -1, 1))(wi, wo))),
}

PHONG_ORIGINAL: Mapping[str, Function] = {
    **_about_mirror(_original),
    "divided-by-viewer-cosine": _times(_original, lambda i, o: i / o),
    "coefficient-forgotten": _brdf(
        lambda c, wi, wo, *, exponent, coefficient: c**exponent / wi[..., 2], mirror_cosine
    ),
}

PHONG: Mapping[str, Function] = _about_mirror(_phong)

HALF_COSINE: Mapping[str, Function] = {
    "mirror-for-half": _brdf(lambda c, wi, wo: c, _dot((-1, -1, 1))),
    "half-from-viewer": _brdf(lambda c, wi, wo: c, _of_half("viewer")),
    "angle-for-cosine": _brdf(lambda c, wi, wo: _angle(c), _of_half("normal")),
    "angle-in-degrees": _brdf(lambda c, wi, wo: np.degrees(_angle(c)), _of_half("normal")),
}

BLINN_PHONG: Mapping[str, Function] = {
    "mirror-for-half": _brdf(_blinn_phong, _dot((-1, -1, 1))),
    "half-from-viewer": _brdf(_blinn_phong, _of_half("viewer")),
    **_powers(_blinn_phong, half_cosine),
}

ASYMMETRY: Mapping[str, Function] = {
    "sign-kept": lambda a, b: _ratio(a - b, np.maximum(a, b)),
    "sign-kept-reversed": lambda a, b: _ratio(b - a, np.maximum(a, b)),
    "not-relative": lambda a, b: np.abs(a - b),
    "relative-to-first": lambda a, b: _ratio(np.abs(a - b), a),
    "relative-to-second": lambda a, b: _ratio(np.abs(a - b), b),
    "relative-to-smaller": lambda a, b: _ratio(np.abs(a - b), np.minimum(a, b)),
    "relative-to-sum": lambda a, b: _ratio(np.abs(a - b), a + b),
    "relative-to-mean": lambda a, b: _ratio(np.abs(a - b), (a + b) / 2),
}

MIXED: Mapping[str, Function] = {
    "shares-not-limited": _mixed(lambda kd, ks, lobe: kd / np.pi + ks * lobe),
    "always-divided": _mixed(lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / (kd + ks)),
    "specular-alone-limited": _mixed(lambda kd, ks, lobe: kd / np.pi + np.minimum(ks, 1 - kd) * lobe),
    "diffuse-alone-limited": _mixed(lambda kd, ks, lobe: np.minimum(kd, 1 - ks) / np.pi + ks * lobe),
    "diffuse-without-pi": _mixed(lambda kd, ks, lobe: (kd + ks * lobe) / _whole(kd, ks)),
    "lobe-not-normalised": _mixed(lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / _whole(kd, ks), False),
}
