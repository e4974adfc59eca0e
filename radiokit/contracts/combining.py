"""Combining: what BSDFs that are made of other BSDFs have in common, whatever they do with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.bsdf import BSDF, DeltaLobe, FloatArray
from radiokit.contracts.parameters import Spectrum
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source

__all__ = [
    "OWN",
    "absorbed",
    "adopt",
    "any_channel",
    "described",
    "in_delta",
    "is_lit",
    "merged",
    "plus",
    "same",
    "spectrum",
    "times",
    "wavelengths",
]

OWN = Source(
    authors="radiokit", year=2026, title="A combination of BSDFs", equation="the docstring of its class"
)

SAME = 1e-9
"""Distance of two unit vectors that are called the same."""


def adopt(model: BSDF, parts: Sequence[BSDF], *, extra: int = 0) -> None:
    """Give a frozen combination what follows from its parts: dimensions, symmetry, sides and precision.

    Raises
    ------
    ParameterError
        When the parts have different numbers of wavelengths, or refract by different indices.
    """
    counts = {count for count in map(wavelengths, parts) if count is not None}
    if len(counts) > 1:
        allowed = f"of one number of wavelengths, not {' and '.join(map(str, sorted(counts)))}"
        raise ParameterError("components", list(parts), allowed)
    indices = {part.relative_index() for part in parts if part.transmissive}
    if len(indices) > 1:
        allowed = f"of one relative index, not {' and '.join(map(str, sorted(indices)))}"
        raise ParameterError("components", list(parts), allowed)
    for name, value in (
        ("dimensions", max((part.dimensions for part in parts), default=2) + extra),
        ("isotropic", all(part.isotropic for part in parts)),
        ("transmissive", any(part.transmissive for part in parts)),
        ("precision", max((part.precision for part in parts), default=float(np.finfo(float).eps))),
    ):
        object.__setattr__(model, name, value)


def wavelengths(f: BSDF) -> int | None:
    """Return how many wavelengths the values of ``f`` have, None for a single number.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> wavelengths(bsdf("lambert")), wavelengths(bsdf("lambert", reflectance=[0.1, 0.2]))
    (None, 2)
    """
    normal = np.array([[0.0, 0.0, 1.0]])
    value = np.asarray(f.evaluate(normal, normal))
    return value.shape[1] if value.ndim > 1 else None


def spectrum(name: str, value: Any) -> Spectrum:
    """Return a number at least 0 and finite, or a tuple of them, one a wavelength.

    Raises
    ------
    ParameterError
    """
    allowed = "a number in [0, inf), or a sequence of them, one a wavelength"
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(name, value, allowed) from None
    if value is None or numbers.ndim > 1 or not numbers.size:
        raise ParameterError(name, value, allowed)
    if not np.all(np.isfinite(numbers) & (numbers >= 0)):
        raise ParameterError(name, value, allowed)
    return float(numbers) if numbers.ndim == 0 else tuple(numbers.tolist())


def times(values: npt.ArrayLike, factor: Spectrum | FloatArray) -> FloatArray:
    """Return values (N,) or (N, K) times a number, a spectrum (K,) or values (N,), (N, K).

    >>> times(np.ones(3), (1.0, 2.0)).shape, times(np.ones((3, 2)), np.ones(3)).shape
    ((3, 2), (3, 2))
    """
    values = np.asarray(values, dtype=float)
    if isinstance(factor, tuple):
        return (values[:, None] if values.ndim == 1 else values) * np.asarray(factor)
    factor = np.asarray(factor)
    if factor.ndim and factor.ndim != values.ndim:
        values, factor = (part[:, None] if part.ndim == 1 else part for part in (values, factor))
    return np.asarray(values * factor)


def plus(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the sum of values (N,) or (N, K): what is no spectrum is the same at every wavelength."""
    if one.ndim != other.ndim:
        one, other = (part[:, None] if part.ndim == 1 else part for part in (one, other))
    return np.asarray(one + other)


def any_channel(values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Return where values (N,) or (N, K) are not 0 at some wavelength."""
    values = np.asarray(values)
    return np.asarray(values != 0 if values.ndim == 1 else values.any(axis=1))


def is_lit(f: BSDF, wi: FloatArray, wo: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which pairs ``f`` may scatter: both above the surface, unless light passes through."""
    if f.transmissive:
        return np.ones(len(wi), dtype=bool)
    return np.asarray((wi[:, 2] > 0) & (wo[:, 2] > 0))


def same(one: FloatArray, other: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which unit vectors (N, 3) are the same but for rounding."""
    return np.asarray(np.linalg.norm(one - other, axis=1) <= SAME)


def in_delta(f: BSDF, wi: FloatArray, wo: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which samples ``wi`` (N, 3) of ``f`` for ``wo`` (N, 3) went into one of its delta lobes."""
    found = np.zeros(len(wi), dtype=bool)
    for lobe in f.delta_lobes(wo):
        found |= same(wi, lobe.wi) & any_channel(lobe.weight)
    return found


def absorbed(f: BSDF, wi: FloatArray, wo: FloatArray, weight: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which samples of ``f`` went nowhere: their weight is 0, though f is not, or the pdf is 0 too."""
    gone = ~any_channel(weight)
    rows = np.flatnonzero(gone)
    unit = np.abs(np.linalg.norm(wi[rows], axis=1) - 1) < 1e-6
    safe = np.where(unit[:, None], wi[rows], wo[rows])
    bright = any_channel(f.evaluate(safe, wo[rows])) & is_lit(f, safe, wo[rows])
    gone[rows] = ~unit | bright | ~(np.asarray(f.pdf(safe, wo[rows])) > 0)
    return gone


def merged(lobes: Iterable[DeltaLobe]) -> tuple[DeltaLobe, ...]:
    """Return delta lobes of which, for each direction, those into the same one are one."""
    found: list[DeltaLobe] = []
    for lobe in lobes:
        left = np.ones(len(lobe.wi))
        for k, other in enumerate(found):
            here = left * same(other.wi, lobe.wi)
            found[k] = DeltaLobe(other.wi, plus(other.weight, times(lobe.weight, here)))
            left = left - here
        if left.any() or not len(left):
            found.append(DeltaLobe(lobe.wi, times(lobe.weight, left)))
    return tuple(found)


def described(value: Any) -> Any:
    """Return a parameter as data: a BSDF is its name and its parameters.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> described(bsdf("lambert", reflectance=0.5))
    {'model': 'lambert', 'parameters': {'reflectance': 0.5}}
    """
    if isinstance(value, BSDF):
        if not value.name:
            return {"model": getattr(value, "label", repr(value)), "parameters": {}}
        return {"model": value.name, "parameters": value.parameters()}
    if isinstance(value, tuple) and any(isinstance(item, BSDF) for item in value):
        return list(_each(value))
    return value


def _each(values: tuple[Any, ...]) -> Iterator[Any]:
    return (described(value) for value in values)
