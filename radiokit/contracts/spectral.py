"""Spectra of lights: strengths that are one number or one a wavelength, and the products of what has them.

Wavelengths are on the last axis: a radiance along N directions is (N,) or (N, K).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.parameters import Spectrum
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate

__all__ = ["amount", "check_wavelengths", "flux_estimate", "stacked", "times", "weighted"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


def amount(strength: Spectrum) -> Any:
    """Return a strength to calculate with: a float, or an array (K,).

    >>> amount(2.0), amount((1.0, 2.0)).tolist()
    (2.0, [1.0, 2.0])
    """
    return np.array(strength) if isinstance(strength, tuple) else strength


def weighted(weights: npt.ArrayLike, strength: Spectrum) -> FloatArray:
    """Return weights (N,) times a strength: (N,), or (N, K) for one of K wavelengths.

    >>> weighted([1.0, 0.0], (2.0, 3.0)).tolist()
    [[2.0, 3.0], [0.0, 0.0]]
    """
    return np.multiply.outer(np.asarray(weights, dtype=np.float64), amount(strength))


def times(first: npt.ArrayLike, second: npt.ArrayLike) -> FloatArray:
    """Return the product along N directions of two factors, each (N,) or (N, K).

    Raises
    ------
    ParameterError
        When both have wavelengths, and not equally many.

    >>> times([1.0, 2.0], [[1.0, 3.0], [1.0, 3.0]]).tolist()
    [[1.0, 3.0], [2.0, 6.0]]
    """
    a, b = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    if a.ndim == b.ndim == 2 and a.shape[1] != b.shape[1]:
        check_wavelengths(a.shape[1], b.shape[1])
    if a.ndim < b.ndim:
        a = a[:, None]
    elif b.ndim < a.ndim:
        b = b[:, None]
    product: FloatArray = a * b
    return product


def check_wavelengths(material: int | None, light: int | None) -> int | None:
    """Return how many wavelengths a material and a light have together; None for single numbers.

    Raises
    ------
    ParameterError
        When both have some, and not equally many.

    >>> check_wavelengths(None, 3)
    3
    """
    if material is not None and light is not None and material != light:
        raise ParameterError(
            "wavelengths of the light", light, f"the material's, {material}, or a single number"
        )
    return light if material is None else material


def flux_estimate(value: Any, ulps: float, **size: float) -> Estimate:
    """Return the flux of a light of the size given as a keyword, with a rounding bound.

    Raises
    ------
    ParameterError
        When it is beyond the range of floats.

    >>> flux_estimate(2.0, 4, radius=1.0).value
    2.0
    """
    if not np.all(np.isfinite(value)):
        ((name, given),) = size.items()
        raise ParameterError(name, given, "so small that the flux is a float, below 1.8e308 W")
    return Estimate(value, ulps * _EPS * value, "rounding", method="closed form")


def stacked(estimates: Sequence[Estimate]) -> Estimate:
    """Return the estimates at K wavelengths as one of shape (K,)."""
    first = estimates[0]
    return Estimate(
        np.array([float(found.value) for found in estimates]),
        np.array([float(found.error) for found in estimates]),
        first.kind,
        sum(found.evaluations for found in estimates),
        method=first.method,
        converged=all(found.converged for found in estimates),
    )
