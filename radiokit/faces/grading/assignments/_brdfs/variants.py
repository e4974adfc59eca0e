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


def _half_of_difference(wi: Array, wo: Array) -> Array:
    h = wi - wo
    length = np.sqrt(np.sum(h * h, axis=-1))
    return h[..., 2] / np.where(length > 0, length, 1.0)


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


def _blinn_phong_with(power: Callable[[Array], Array]) -> Lobe:
    """Return the lobe with something else in place of 2^(−n/2)."""

    def lobe(c: Array, wi: Array, wo: Array, *, exponent: Array) -> Array:
        n = exponent
        return (n + 2) * (n + 4) / (8 * np.pi * (power(n) + n)) * c**n

    return lobe


def _times(lobe: Lobe, factor: Callable[[Array, Array], Array]) -> Function:
    """Return a lobe about the mirror direction times a function of both cosines."""

    def other(c: Array, wi: Array, wo: Array, **parameters: Array) -> Array:
        return lobe(c, wi, wo, **parameters) * factor(wi[..., 2], wo[..., 2])

    return _brdf(other, mirror_cosine)


def _phong_scale(n: Array) -> Array:
    return (n + 2) / (2 * np.pi)


def _mixed(
    combine: Callable[[Array, Array, Array], Array],
    scale: Callable[[Array], Array] = _phong_scale,
    cosine: Cosine = mirror_cosine,
) -> Function:
    def lobe(c: Array, wi: Array, wo: Array, *, diffuse: Array, specular: Array, exponent: Array) -> Array:
        return combine(diffuse, specular, scale(exponent) * c**exponent)

    return _brdf(lobe, cosine)


def _whole(kd: Array, ks: Array) -> Array:
    return np.maximum(1.0, kd + ks)


def _in_turn(kd: Array, ks: Array, lobe: Array) -> Array:
    """Return the mixture if the second share is divided by a sum that holds the new first one."""
    first = kd / _whole(kd, ks)
    second = np.where(kd + ks > 1, ks / (first + ks), ks)
    return first / np.pi + second * lobe


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
    "all-three-turned": lambda wi, wo: _clamped(_dot((-1, -1, -1))(wi, wo)),
    "horizon-clamped": _brdf(lambda c, wi, wo: c, mirror_cosine),
    "reflection-with-plus": lambda wi, wo: _clamped(_dot((1, 1, 3))(wi, wo)),
    "reflection-without-two": lambda wi, wo: _clamped(_dot((-1, -1, 0))(wi, wo)),
    "angle-without-mirror": lambda wi, wo: _angle(_dot((1, 1, 1))(wi, wo)),
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
    "half-of-difference": _brdf(lambda c, wi, wo: _half_of_difference(wi, wo), mirror_cosine),
    "half-over-square": _brdf(
        lambda c, wi, wo: c / np.sqrt(np.sum((wi + wo) ** 2, axis=-1)), _of_half("normal")
    ),
    "mean-of-angles": _brdf(
        lambda c, wi, wo: np.cos((_angle(wi[..., 2]) + _angle(wo[..., 2])) / 2), _of_half("normal")
    ),
    "angle-for-cosine": _brdf(lambda c, wi, wo: _angle(c), _of_half("normal")),
    "angle-in-degrees": _brdf(lambda c, wi, wo: np.degrees(_angle(c)), _of_half("normal")),
}

BLINN_PHONG: Mapping[str, Function] = {
    **{
        name: _brdf(_blinn_phong_with(power), _of_half("normal"))
        for name, power in {
            "power-of-two-sign": lambda n: np.exp2(n / 2),
            "power-of-two-whole": lambda n: np.exp2(-n),
            "power-of-two-forgotten": lambda n: 0.0 * n,
            "power-of-two-negated": lambda n: -np.exp2(-n / 2),
        }.items()
    },
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
    "diffuse-not-divided": _mixed(lambda kd, ks, lobe: kd / np.pi + ks * lobe / _whole(kd, ks)),
    "specular-not-divided": _mixed(lambda kd, ks, lobe: kd / np.pi / _whole(kd, ks) + ks * lobe),
    "divided-in-turn": _mixed(_in_turn),
    "sum-of-values": _mixed(lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / _whole(kd / np.pi, ks)),
    "lobe-with-one": _mixed(
        lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / _whole(kd, ks), lambda n: (n + 1) / (2 * np.pi)
    ),
    "half-for-mirror": _mixed(
        lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / _whole(kd, ks), cosine=_of_half("normal")
    ),
    "neither-limited-nor-with-pi": _mixed(lambda kd, ks, lobe: kd + ks * lobe),
    "neither-limited-nor-normalised": _mixed(lambda kd, ks, lobe: kd / np.pi + ks * lobe, lambda n: 1.0),
    "lobe-not-normalised": _mixed(
        lambda kd, ks, lobe: (kd / np.pi + ks * lobe) / _whole(kd, ks), lambda n: 1.0
    ),
}
