"""Latitude–longitude grids: the solid angles of their cells, and what a tilted plane sees of each."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from radiokit.measure.cancelling import x_minus_sine

__all__ = ["cell_edges", "cell_projections", "cell_solid_angles"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_SLIVER = 256 * _EPS**2  # of a cell that rounding may have taken for one below the horizon
_X, _W = (0.5 * (x + shift) for x, shift in zip(np.polynomial.legendre.leggauss(16), (1.0, 0.0), strict=True))
_PANEL = 1.5


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
    seen from the pole down to the polar angle Θ_h = atan2(cosβ, −sinβ cosφ). The cells wholly above the
    horizon are products; those that it cuts are integrals over φ of positive terms.

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

    value = np.where(above, np.maximum(whole, 0.0), 0.0)
    # The azimuth is off by some eps of 2π, which moves what is seen of a cell by its height times that.
    error = np.where(above, _EPS * (8 * size + 16 * tilt_sine * radial[:, None]), _SLIVER)
    row, column = np.nonzero(cut)
    value[cut], error[cut] = _cut(theta[row], step_theta, azimuth[column], step_phi, tilt_sine, tilt_cosine)
    if z < 0:  # the grid upside down: azimuths stay, as does the share of x and y
        return value[::-1], error[::-1]
    return value, error


def _visible_down_to(azimuth: FloatArray, tilt_sine: float, tilt_cosine: float) -> FloatArray:
    return np.arctan2(tilt_cosine, -tilt_sine * np.cos(azimuth))


def _contains(azimuth: FloatArray, angle: float) -> npt.NDArray[np.bool_]:
    """Return whether ``angle``, or one that differs by full turns, lies between neighbours in ``azimuth``."""
    turns = (azimuth - angle) / (2 * math.pi)
    return np.ceil(turns[:-1]) <= np.floor(turns[1:])


def _cut(
    top: FloatArray,
    step_theta: float,
    start: FloatArray,
    step_phi: float,
    tilt_sine: float,
    tilt_cosine: float,
) -> tuple[FloatArray, FloatArray]:
    """Return what is seen of the cells (K,) that the horizon cuts, and the bounds.

    A meridian is seen over x = min(Θ_h, Θ₂) − Θ₁, and w·n = R sin(Θ_h − θ) along it, with
    R² = cos²β + sin²β cos²φ. With h = Θ_h − Θ₁ it gives
    R [sin x sin(h − x/2) sin(Θ₁ + x/2) − ½ (x − sin x) cosΘ_h], of which the last term is at most a third.
    The azimuths between which that is smooth are Gauss-Legendre panels in t, φ = φ₀ + c sinh t, with
    c = cotβ the distance of its singularities from φ₀ = ±π/2.
    """
    cell, low, high = _smooth_spans(top, step_theta, start, step_phi, tilt_sine, tilt_cosine)
    middle = 0.5 * (low + high)
    pole = math.pi * (np.floor(middle / math.pi) + 0.5)
    scale = min(max(tilt_cosine / max(tilt_sine, 1e-300), 1e-17), 10.0)
    near, far = np.sort(np.abs(np.stack((low - pole, high - pole))), axis=0)
    first, last = np.arcsinh(near / scale), np.arcsinh(far / scale)
    panels = np.maximum(1, np.ceil((last - first) / _PANEL)).astype(np.intp)
    span = np.repeat(np.arange(len(cell)), panels)
    index = np.arange(len(span)) - np.repeat(np.cumsum(panels) - panels, panels)
    step = (last - first) / panels
    # t is rounded, by much where c is tiny: distances from φ₀ bound the panels, the outermost ones exactly.
    inner, outer = (scale * np.sinh(first[span] + k * step[span]) for k in (index, index + 1))
    inner, outer = (
        np.where(index == 0, near[span], inner),
        np.where(index + 1 == panels[span], far[span], outer),
    )
    slant = np.hypot(scale, inner)
    gap, rest = outer - inner, (outer + inner) / (np.hypot(scale, outer) + slant)
    width = np.log1p(gap * (1 + rest) / (inner + slant))
    t = width[:, None] * _X
    distance = inner[:, None] * np.cosh(t) + slant[:, None] * np.sinh(t)
    phi = pole[span, None] + np.sign(middle - pole)[span, None] * distance
    weight = width[:, None] * _W * (inner[:, None] * np.sinh(t) + slant[:, None] * np.cosh(t))
    above = top[cell[span], None]
    cosine = np.cos(phi)
    edge = np.arctan2(tilt_cosine, -tilt_sine * cosine)
    h = np.maximum(edge - above, 0.0)
    x = np.minimum(h, step_theta)
    slope = np.hypot(tilt_cosine, tilt_sine * cosine)
    seen = np.sin(x) * np.sin(h - x / 2) * np.sin(above + x / 2) - 0.5 * x_minus_sine(x) * np.cos(edge)
    parts = np.stack((slope * seen, 2 * np.sin(x / 2) * np.sin(above + x / 2), np.sign(x)))
    sums = np.sum(parts * weight, axis=-1)
    value, area, turn = np.stack([np.bincount(cell[span], part, len(top)) for part in sums])
    height, length = np.zeros(len(top)), np.zeros(len(top))
    np.maximum.at(height, cell[span], np.max(slope * np.sin(np.minimum(h, math.pi / 2)), axis=-1))
    np.maximum.at(length, cell[span], np.max(x, axis=-1))
    # The cell's edges and the horizon are off by some eps: these move by that times the heights along them.
    return value, 8 * _EPS * (value + area + height * (2 * length + turn)) + _SLIVER


def _smooth_spans(
    top: FloatArray,
    step_theta: float,
    start: FloatArray,
    step_phi: float,
    tilt_sine: float,
    tilt_cosine: float,
) -> tuple[npt.NDArray[np.intp], FloatArray, FloatArray]:
    """Return the spans of azimuth, with their cells, over which the seen part of a meridian is smooth."""
    start = start - 2 * math.pi * np.rint(start / (2 * math.pi))
    tilt = math.atan2(tilt_sine, tilt_cosine)
    breaks = [np.full_like(top, angle) for angle in (0.0, math.pi / 2, math.pi)]
    for theta in (top, top + step_theta):  # where the horizon crosses the parallel: cosφ = −cotβ cotΘ
        square = np.maximum(-np.cos(tilt + theta) * np.cos(tilt - theta), 0.0)
        breaks.append(np.arctan2(np.sqrt(square), -tilt_cosine * np.cos(theta)))
    places = [sign * b + turn for b in breaks for sign in (-1, 1) for turn in (0.0, 2 * math.pi)]
    ends = np.stack((start, *places, start + step_phi), axis=-1)
    ends = np.sort(np.clip(ends, start[:, None], start[:, None] + step_phi), axis=-1)
    cell, k = np.nonzero(np.diff(ends, axis=-1) > 0)
    return cell, ends[cell, k], ends[cell, k + 1]
