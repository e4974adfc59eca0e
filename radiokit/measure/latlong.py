"""Latitude–longitude grids: the solid angles of their cells, and what a tilted plane sees of each."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.cancelling import x_minus_sine

__all__ = ["cell_edges", "cell_projections", "cell_solid_angles"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


def cell_edges(rows: int, columns: int) -> tuple[FloatArray, FloatArray]:
    """Return the edges: polar angles (rows + 1,) in [0, π] and azimuths (columns + 1,) in [0, 2π]."""
    return np.pi * np.arange(rows + 1) / rows, 2 * np.pi * np.arange(columns + 1) / columns


def cell_solid_angles(rows: int, columns: int) -> FloatArray:
    """Return the solid angles (rows,) [sr] of a cell of each row, which sum to 4π over the grid.

    >>> round(float(cell_solid_angles(2, 4)[0]) / np.pi, 15)
    0.5
    """
    middles = np.pi * (np.arange(rows) + 0.5) / rows
    size: FloatArray = 4 * np.pi / columns * np.sin(middles) * math.sin(np.pi / 2 / rows)
    return size


def cell_projections(rows: int, columns: int, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    r"""Return ∫ max(0, w·n) dω over each cell (rows, columns) [sr], and a bound of its rounding.

    With β the angle of the plane's normal n from the pole and φ the azimuth from it, the meridian at φ is
    seen from the pole down to the polar angle Θ_h = atan2(cosβ, −sinβ cosφ). What is seen of a sector down
    to Θ is an integral over φ: of ½[sinβ cosφ (Θ − sinΘ cosΘ) + cosβ sin²Θ] where Θ ≤ Θ_h, and of the
    same at Θ_h beyond, whose primitive is ½[sinβ sinφ Θ_h + atan2(cosβ sinφ, cosφ)]. Differences of these
    give the cells that the horizon cuts; the others are products.

    Parameters
    ----------
    rows, columns : int
        Of the grid, from the pole down and counterclockwise from x.
    normal : ndarray, shape (3,)
        Unit normal of the plane, with the pole along z.

    >>> seen, _ = cell_projections(2, 4, np.array([0.0, 0.0, 1.0]))
    >>> (seen / np.pi).round(15)[:, 0] + 0.0
    array([0.25, 0.  ])
    """
    theta, phi = cell_edges(rows, columns)
    x, y, z = (float(v) for v in normal)
    tilt_sine, tilt_cosine = math.hypot(x, y), abs(z)
    azimuth = phi - math.atan2(y, x)
    edge = _visible_down_to(azimuth, tilt_sine, tilt_cosine)
    tilt = math.atan2(tilt_sine, tilt_cosine)
    lowest = np.where(_contains(azimuth, 0.0), math.pi / 2 + tilt, np.maximum(edge[:-1], edge[1:]))
    highest = np.where(_contains(azimuth, math.pi), math.pi / 2 - tilt, np.minimum(edge[:-1], edge[1:]))
    above = theta[1:, None] <= highest
    cut = ~above & (theta[:-1, None] < lowest)

    step_theta, step_phi = math.pi / rows, 2 * math.pi / columns
    double = theta[:-1] + theta[1:]
    radial = x_minus_sine(step_theta) + 2 * math.sin(step_theta) * np.sin(double / 2) ** 2
    across = tilt_sine * 2 * np.cos((azimuth[:-1] + azimuth[1:]) / 2) * math.sin(step_phi / 2)
    along = tilt_cosine * step_phi * np.sin(double) * math.sin(step_theta)
    whole = 0.5 * (radial[:, None] * across + along[:, None])
    size = 0.5 * (np.abs(radial[:, None] * across) + np.abs(along[:, None]))

    corners = _seen_down_to(theta[:, None], azimuth, tilt_sine, tilt_cosine)
    pieces = np.maximum(np.diff(np.diff(corners, axis=0), axis=1), 0.0)
    value = np.where(above, np.maximum(whole, 0.0), np.where(cut, pieces, 0.0))
    # The azimuth is off by some eps of 2π, which moves what is seen of a cell by its height times that.
    error = np.where(
        above, _EPS * (8 * size + 16 * tilt_sine * radial[:, None]), np.where(cut, 64 * _EPS, 0.0)
    )
    if z < 0:  # the grid upside down: azimuths stay, as does the share of x and y
        return value[::-1], error[::-1]
    return value, error


def _visible_down_to(azimuth: FloatArray, tilt_sine: float, tilt_cosine: float) -> FloatArray:
    return np.arctan2(tilt_cosine, -tilt_sine * np.cos(azimuth))


def _contains(azimuth: FloatArray, angle: float) -> npt.NDArray[np.bool_]:
    """Return whether ``angle``, or one that differs by full turns, lies between neighbours in ``azimuth``."""
    turns = (azimuth - angle) / (2 * math.pi)
    return np.ceil(turns[:-1]) <= np.floor(turns[1:])


def _seen_down_to(theta: FloatArray, azimuth: FloatArray, tilt_sine: float, tilt_cosine: float) -> Any:
    """Return what the plane sees between azimuth 0 and ``azimuth``, from the pole down to ``theta``."""
    turns = np.rint(azimuth / (2 * math.pi))
    rest = azimuth - 2 * math.pi * turns
    part = _half_turn(theta, np.abs(rest), tilt_sine, tilt_cosine)
    return np.sign(rest) * part + 2 * turns * _half_turn(theta, np.float64(math.pi), tilt_sine, tilt_cosine)


def _half_turn(theta: FloatArray, azimuth: Any, tilt_sine: float, tilt_cosine: float) -> Any:
    """The same for azimuths in [0, π], along which Θ_h falls and passes ``theta`` once."""
    up, along = tilt_cosine * np.cos(theta), tilt_sine * np.sin(theta)
    passing = np.arctan2(np.sqrt(np.maximum((along - up) * (along + up), 0.0)), -up)

    def on_parallel(phi: Any) -> Any:
        radial = 0.5 * x_minus_sine(2 * theta)
        return 0.5 * (tilt_sine * np.sin(phi) * radial + tilt_cosine * np.sin(theta) ** 2 * phi)

    def on_horizon(phi: Any) -> Any:
        edge = _visible_down_to(phi, tilt_sine, tilt_cosine)
        turned = np.arctan2(tilt_cosine * np.sin(phi), np.cos(phi))
        return 0.5 * (tilt_sine * np.sin(phi) * edge + turned)

    beyond = np.maximum(azimuth, passing)
    return on_parallel(np.minimum(azimuth, passing)) + (on_horizon(beyond) - on_horizon(passing))
