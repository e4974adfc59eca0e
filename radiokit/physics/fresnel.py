"""Fresnel: the share of power that a smooth interface reflects, unpolarised, in real arithmetic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.physics.interface import (
    INDEX_LIMITS,
    conductor_complement_kernel,
    conductor_kernel,
    dielectric_complement_kernel,
    dielectric_kernel,
    schlick_complement_kernel,
    schlick_kernel,
    transmitted_cosine_kernel,
)
from radiokit.physics.metals import metal

if TYPE_CHECKING:
    import sympy

__all__ = [
    "CONDUCTOR_SOURCE",
    "DIELECTRIC_SOURCE",
    "SCHLICK_SOURCE",
    "clip_index",
    "conductor",
    "conductor_complement_kernel",
    "conductor_kernel",
    "conductor_symbolic",
    "dielectric",
    "dielectric_complement_kernel",
    "dielectric_kernel",
    "dielectric_symbolic",
    "metal",
    "schlick",
    "schlick_complement_kernel",
    "schlick_kernel",
    "schlick_symbolic",
    "transmitted_cosine_kernel",
]

FloatArray = npt.NDArray[np.float64]

DIELECTRIC_SOURCE = Source(
    authors="Born, Wolf",
    year=1999,
    title="Principles of Optics, 7th edition",
    doi="10.1017/CBO9781139644181",
    equation="section 1.5.2, equation 21; section 1.5.4 for total reflection",
)
CONDUCTOR_SOURCE = Source(
    authors="Born, Wolf",
    year=1999,
    title="Principles of Optics, 7th edition",
    doi="10.1017/CBO9781139644181",
    equation="section 14.2: equation 21 of section 1.5.2 with the complex index η + ik",
)
SCHLICK_SOURCE = Source(
    authors="Schlick",
    year=1994,
    title="An Inexpensive BRDF Model for Physically-based Rendering. Computer Graphics Forum 13(3)",
    doi="10.1111/1467-8659.1330233",
    equation="the approximation of the Fresnel factor",
)

_COSINE_TOLERANCE = 1e-6  # a cosine of two directions that are unit vectors to float32 accuracy


def dielectric(cos_i: npt.ArrayLike, eta: npt.ArrayLike) -> Any:
    """Return the unpolarised reflectance [1] of an interface between two transparent media.

    Parameters
    ----------
    cos_i : array_like, shape (...)
        Cosine of the angle of incidence, in [-1, 1]; below 0 the light comes from inside.
    eta : array_like, shape (...)
        Index inside over index outside, above 0.

    Returns
    -------
    float or ndarray, shape (...)
        In [0, 1]; 1 under total internal reflection, and 0 for ``eta`` = 1.

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: Born & Wolf (1999), section 1.5.2, equation 21. The numerators of both amplitudes
    are differences of squares over sums, so that nothing cancels for η near 1.

    >>> round(float(dielectric(1.0, 1.5)), 15), float(dielectric(-0.5, 1.5))
    (0.04, 1.0)
    """
    c = np.clip(_number("cos_i", cos_i, -1.0, 1.0, _COSINE_TOLERANCE), -1.0, 1.0)
    n = np.clip(_number("eta", eta, np.nextafter(0.0, 1.0), np.inf), *INDEX_LIMITS)
    with np.errstate(all="ignore"):
        return dielectric_kernel(c, n)[()]


def conductor(cos_i: npt.ArrayLike, eta: npt.ArrayLike, k: npt.ArrayLike) -> Any:
    """Return the unpolarised reflectance [1] of an absorbing medium seen from a transparent one.

    Parameters
    ----------
    cos_i : array_like, shape (...)
        Cosine of the angle of incidence, in [0, 1].
    eta : array_like, shape (...)
        Real part of the relative index η + ik, above 0.
    k : array_like, shape (...)
        Extinction, the imaginary part of the relative index, at least 0.

    Returns
    -------
    float or ndarray, shape (...)
        In [0, 1].

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: Born & Wolf (1999), section 14.2. With q = a + ib = √((η + ik)² − sin²θ), the s part is
    |(η + ik)² − 1|² / |cos θ + q|⁴, a quotient of sums of squares without cancellation.

    >>> float(round(conductor(1.0, 0.2, 3.0), 12))
    0.92337164751
    """
    c = np.minimum(_number("cos_i", cos_i, 0.0, 1.0, _COSINE_TOLERANCE), 1.0)
    n, k = _number("eta", eta, np.nextafter(0.0, 1.0), np.inf), _number("k", k, 0.0, np.inf)
    with np.errstate(all="ignore"):
        return conductor_kernel(c, *clip_index(n, k))[()]


def clip_index(eta: Any, k: Any) -> tuple[Any, Any]:
    """Return the index in a range beyond which nothing changes: what ``conductor_kernel`` takes."""
    return np.clip(eta, *INDEX_LIMITS), np.minimum(k, INDEX_LIMITS[1])


def schlick(cos_i: npt.ArrayLike, f0: npt.ArrayLike) -> Any:
    """Return Schlick's approximation F0 + (1 − F0)(1 − cos θ)⁵ of the reflectance [1].

    Parameters
    ----------
    cos_i : array_like, shape (...)
        Cosine of the angle of incidence, in [0, 1].
    f0 : array_like, shape (...)
        Reflectance at normal incidence, in [0, 1].

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: Schlick (1994), the approximation of the Fresnel factor.

    >>> float(schlick(1.0, 0.04)), float(schlick(0.0, 0.04))
    (0.04, 1.0)
    """
    c = np.minimum(_number("cos_i", cos_i, 0.0, 1.0, _COSINE_TOLERANCE), 1.0)
    f0 = _number("f0", f0, 0.0, 1.0)
    return schlick_kernel(c, f0)[()]


def dielectric_symbolic(cos_i: sympy.Expr, eta: sympy.Expr) -> sympy.Expr:
    """Return the dielectric reflectance as SymPy, from Fresnel's amplitudes and Snell's law."""
    import sympy

    outside = conductor_symbolic(cos_i, eta, sympy.S.Zero)
    inside = conductor_symbolic(-cos_i, 1 / eta, sympy.S.Zero)
    return sympy.Piecewise((inside, cos_i < 0), (outside, True))


def conductor_symbolic(cos_i: sympy.Expr, eta: sympy.Expr, k: sympy.Expr) -> sympy.Expr:
    """Return the conductor's reflectance as SymPy, from Fresnel's amplitudes with a complex angle."""
    import sympy

    index = eta + sympy.I * k
    cos_t = sympy.sqrt(1 - (1 - cos_i**2) / index**2)
    r_s = (cos_i - index * cos_t) / (cos_i + index * cos_t)
    r_p = (index * cos_i - cos_t) / (index * cos_i + cos_t)
    return (sympy.Abs(r_s) ** 2 + sympy.Abs(r_p) ** 2) / 2


def schlick_symbolic(cos_i: sympy.Expr, f0: sympy.Expr) -> sympy.Expr:
    """Return Schlick's approximation as SymPy."""
    return f0 + (1 - f0) * (1 - cos_i) ** 5


def _number(name: str, value: npt.ArrayLike, low: float, high: float, tolerance: float = 0.0) -> FloatArray:
    """Return a finite float64 array within limits, or raise with the first number that is not."""
    allowed = f"finite and in [{low:g}, {high:g}]" if np.isfinite(high) else "finite and at least 0"
    if low == np.nextafter(0.0, 1.0):
        allowed = "finite and above 0"
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ParameterError(name, value, allowed) from None
    bad = ~(np.isfinite(array) & (array >= low - tolerance) & (array <= high + tolerance))
    if bad.any():
        raise ParameterError(name, float(array[bad].flat[0]), allowed)
    return array
