"""Rectangles: their view factors, in sums of positive terms; ``view_factor`` is where to look for them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.physics.lengths import Orientation, check_orientation, positive

__all__ = ["differential_to_rectangle", "parallel_rectangles", "perpendicular_rectangles"]

FloatArray = npt.NDArray[np.float64]

_X, _W = (0.5 * (x + shift) for x, shift in zip(np.polynomial.legendre.leggauss(20), (1.0, 0.0), strict=True))
_PANELS = 32
_FAR = 40.0  # beyond sinh 40 the rest of the integral is 1e-17 of it


def differential_to_rectangle(
    *,
    width: npt.ArrayLike,
    length: npt.ArrayLike,
    distance: npt.ArrayLike,
    orientation: Orientation = "parallel",
) -> Any:
    """Return F from an element to a rectangle with one corner opposite the element.

    Parameters
    ----------
    width, length : array_like
        The rectangle's sides, above 0. A perpendicular element lies in the plane through the side ``length``
        across to it, so that its normal is along ``width``.
    distance : array_like
        From the element to that corner, above 0, square to the rectangle.
    orientation : {"parallel", "perpendicular"}
        Of the element, to the rectangle.

    Raises
    ------
    ParameterError
        When a length or the orientation is not allowed.

    Source: Howell's catalogue, B-3 (parallel) and B-4 (perpendicular).

    >>> round(
    ...     float(differential_to_rectangle(width=1e9, length=1e9, distance=1.0)), 9
    ... )  # a quarter of the sky
    0.25
    """
    check_orientation(orientation)
    a, b, c = (
        positive("width", width),
        positive("length", length),
        positive("distance", distance),
    )
    if orientation == "parallel":
        first, second = np.hypot(a, c), np.hypot(b, c)
        total = a / first * np.arctan2(b, first) + b / second * np.arctan2(a, second)
        return (total / (2 * np.pi))[()]
    # atan(b/c) − (c/ρ) atan(b/ρ), ρ² = a² + c²: the difference of angles, and 1 − c/ρ, each as one quotient
    far = np.hypot(a, c)
    beyond = a * (a / (far + c))  # ρ − c
    angle = np.arctan2(b * (beyond / far), c + b * (b / far))
    return ((angle + beyond / far * np.arctan2(b, far)) / (2 * np.pi))[()]


def parallel_rectangles(*, width: npt.ArrayLike, length: npt.ArrayLike, distance: npt.ArrayLike) -> Any:
    """Return F from a rectangle to its equal, directly opposite.

    The catalogue's logarithm and four arcus tangents are G(X, Y) with ∂²G/∂X² = Y atan(Y/c)/c³, c² = 1 + x²,
    so that F = 2/(πX) ∫₀^X (X − x) atan(Y/c)/c³ dx, of positive terms, is summed in asinh x.

    Parameters
    ----------
    width, length, distance : array_like
        Above 0.

    Raises
    ------
    ParameterError
        When a length is not allowed.

    Source: Howell's catalogue, C-11.

    >>> round(float(parallel_rectangles(width=1.0, length=1.0, distance=1.0)), 12)
    0.199824895698
    """
    a, b, c = (
        positive("width", width),
        positive("length", length),
        positive("distance", distance),
    )
    x, y = np.broadcast_arrays(a / c, b / c)
    x, y = np.maximum(x, y)[..., None], np.minimum(x, y)[..., None]
    end = np.arcsinh(x)
    last = np.minimum(end, _FAR)
    share = ((np.arange(_PANELS)[:, None] + _X) / _PANELS).ravel()
    weight = np.tile(_W, _PANELS) / _PANELS
    xi = last * share
    rest = (end - last) + last * (1 - share)
    cosh = np.cosh(xi)
    half = 0.5 * np.minimum(rest, 1.0)
    close = 2 * np.sinh(half) * np.cosh(xi + half) / x  # X − sinh ξ, from the difference of the arguments
    left = np.where(rest < 1.0, close, 1 - np.sinh(xi) / x)
    values = left * np.arctan2(y, cosh) / (cosh * cosh)
    return (2 / np.pi * last[..., 0] * np.sum(values * weight, axis=-1))[()]


def perpendicular_rectangles(*, edge: npt.ArrayLike, width: npt.ArrayLike, height: npt.ArrayLike) -> Any:
    """Return F from a rectangle to another, square to it, with which it shares an edge.

    Over the squared distance ρ from the edge in the plane across it, W F = 1/2π ∫ atan(1/ρ) s(ρ) dρ, with W
    and H the sides over the edge and s the difference of sin² at the ends of the arc of radius ρ within
    W × H: 1, then (min/ρ)², then (W² + H² − ρ²)/ρ². Every part is positive.

    Parameters
    ----------
    edge : array_like
        The common edge, above 0.
    width, height : array_like
        The other sides of the rectangle from which the flux comes, and of the one that it reaches, above 0.

    Raises
    ------
    ParameterError
        When a length is not allowed.

    Source: Howell's catalogue, C-14.

    >>> round(float(perpendicular_rectangles(edge=1.0, width=1.0, height=1.0)), 12)
    0.200043776075
    """
    e, w, h = (
        positive("edge", edge),
        positive("width", width),
        positive("height", height),
    )
    wide, high = np.broadcast_arrays(w / e, h / e)
    low, top = np.minimum(wide, high), np.maximum(wide, high)
    corner = np.arctan2(1.0, low) + _log_part(low)
    between = low * _between(low, top)
    step = low * (low / (np.hypot(low, top) + top))  # from top to the diagonal
    rho = top[..., None] + step[..., None] * _X
    share = (1 - _X) * (step[..., None] / rho) * (1 + np.hypot(low, top)[..., None] / rho)
    beyond = step / low * np.sum(_W * np.arctan2(1.0, rho) * share, axis=-1)
    return (low / wide * (corner + between + beyond) / (2 * np.pi))[()]


def _log_part(low: FloatArray) -> FloatArray:
    """Return log(1 + m²)/2m."""
    square = np.log1p(np.minimum(low, 1e8) ** 2)
    return np.where(low < 1e8, square, 2 * np.log(low)) / (2 * low)


def _between(low: FloatArray, top: FloatArray) -> FloatArray:
    """Return ∫ atan(1/ρ)/ρ² dρ from ``low`` to ``top``."""
    step = (top - low)[..., None]
    rho = low[..., None] + step * _X
    near = np.sum(_W * np.arctan2(1.0, rho) / rho * (step / rho), axis=-1)
    return np.where(top < 3 * low, near, _primitive(low) - _primitive(top))


def _primitive(rho: FloatArray) -> FloatArray:
    """Return atan(1/ρ)/ρ − log(1 + 1/ρ²)/2."""
    inverse = 1 / rho
    square = np.log1p(np.minimum(inverse, 1e8) ** 2)
    return np.arctan2(1.0, rho) * inverse - 0.5 * np.where(inverse < 1e8, square, 2 * np.log(inverse))
