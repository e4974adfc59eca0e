"""The surface of a scattering lobe: a mesh whose vertices gather where the lobe is narrow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.faces.plots.offscreen import require_pyvista
from radiokit.facts.directions import check_directions, frame, reflect
from radiokit.facts.errors import ParameterError
from radiokit.measure.lattice import kronecker

if TYPE_CHECKING:
    import pyvista

__all__ = ["Scale", "check_options", "lobe_mesh"]

Scale = Literal["linear", "log"]

_LOWEST_POLE = 1e-3
_EDGE = 1.0 - 1e-9
_SCAN = 160
_STRETCH = 9.0
# What a unit of angle and all of its orders of magnitude weigh against the length of the curve: the feet of
# a narrow lobe are too flat to have a length, and still hold some of its integral.
_UNIFORM_SHARE, _LOGARITHMIC_SHARE = 0.6, 0.6


def lobe_mesh(
    f: Any,
    wo: npt.ArrayLike,
    *,
    cosine: bool = True,
    scale: Scale = "linear",
    decades: float = 4.0,
    resolution: int = 96,
) -> pyvista.PolyData:
    """Return the surface of the lobe into which ``f`` reflects, over the hemisphere of ``wi``.

    The vertices lie on great circles that run from the lobe's peak to the horizon, and are spaced by the
    length of the curve that they draw: a lobe of width 0.001 has as many as one of width 1. The peak is
    sought near the mirror direction, the normal and ``wo``, on a coarse grid, and among the model's own
    samples. Delta lobes are no part of the surface.

    Parameters
    ----------
    f : BSDF or callable
        f(wi, wo) [sr⁻¹]. Of several wavelengths the mean is taken.
    wo : array_like, shape (3,)
        Unit vector above the horizon.
    cosine : bool
        Whether the value is f cosθi, whose integral is the albedo, or f alone.
    scale : {"linear", "log"}
        The radius is the value itself [sr⁻¹], or 1 + log₁₀(value/peak)/decades, cut off at 0.
    decades : float
        How far below the peak the logarithmic scale reaches, > 0.
    resolution : int
        Vertices on each great circle, at least 8; there are 3/2 as many circles.

    Returns
    -------
    pyvista.PolyData
        With the point arrays ``value`` [sr⁻¹] and ``wi``. A value that is negative, NaN or infinite has
        radius 0.

    Raises
    ------
    ParameterError
        When an argument is out of its range.
    MissingExtraError
        When PyVista is not installed.

    >>> mesh = lobe_mesh(lambda wi, wo: np.full(len(wi), 0.5), [0.0, 0.0, 1.0], cosine=False)
    >>> bool(np.allclose(np.linalg.norm(mesh.points, axis=-1), 0.5))
    True
    """
    check_options(scale, decades, resolution)
    require_pyvista("drawing a lobe")
    import pyvista

    model = as_bsdf(f)
    view = _above(wo)

    def value(wi: FloatArray) -> FloatArray:
        found: FloatArray = model.evaluate(wi, np.broadcast_to(view, wi.shape))
        if found.ndim > 1:
            found = found.mean(axis=-1)
        return found * wi[:, 2] if cosine else found

    pole = _peak(model, view, value)
    around = frame(pole)
    psi = np.linspace(0.0, 2 * np.pi, resolution * 3 // 2, endpoint=False)
    delta = _spacing(around, psi, resolution, value, scale, decades)
    wi = np.concatenate([pole[None], _rays(around, psi, delta[:, 1:]).reshape(-1, 3)])
    values = value(wi)
    drawable = np.where(np.isfinite(values), values, 0.0)
    points = _radius(drawable, float(drawable.max()), scale, decades)[:, None] * wi
    mesh = pyvista.PolyData(points, faces=_faces(len(psi), resolution - 1))
    mesh["value"] = values
    mesh["wi"] = wi
    return mesh


def check_options(scale: str, decades: float, resolution: int) -> None:
    """Refuse a scale, a range or a resolution that cannot be drawn.

    Raises
    ------
    ParameterError
    """
    if scale not in ("linear", "log"):
        raise ParameterError("scale", scale, "'linear' or 'log'")
    if not (np.isfinite(decades) and decades > 0):
        raise ParameterError("decades", decades, "a number in (0, inf)")
    if not (isinstance(resolution, (int, np.integer)) and resolution >= 8):
        raise ParameterError("resolution", resolution, "a whole number, at least 8")


def _above(wo: npt.ArrayLike) -> FloatArray:
    view = check_directions("wo", wo)
    if view.shape != (3,) or view[2] <= 0:
        raise ParameterError("wo", np.asarray(wo).tolist(), "one unit vector (3,) above the horizon")
    return view


def _radius(value: FloatArray, peak: float, scale: Scale, decades: float) -> FloatArray:
    """Return the radius at which a value is drawn: the value, or its logarithm below the peak."""
    if scale == "linear" or peak <= 0:
        return np.asarray(np.maximum(value, 0.0))
    floor = peak * 10.0**-decades
    return np.asarray(np.log10(np.maximum(value, floor) / floor) / decades)


def _peak(model: BSDF, view: FloatArray, value: Any) -> FloatArray:
    """Return the direction, a little above the horizon, where the value is largest as far as is known."""
    u = (np.stack(np.meshgrid(np.arange(24), np.arange(24)), axis=-1).reshape(-1, 2) + 0.5) / 24
    cos_theta, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    sin_theta = np.sqrt(1 - u[:, 0])
    grid = np.stack([sin_theta * np.cos(phi), sin_theta * np.sin(phi), cos_theta], axis=-1)
    if model.dimensions > 2:
        u = np.concatenate([u, kronecker(len(u), model.dimensions - 2)], axis=1)
    sampled, _ = model.sample(u, np.broadcast_to(view, (len(u), 3)).copy())
    sampled = sampled[np.isfinite(sampled).all(axis=-1) & (sampled[:, 2] > 0)]
    candidates = np.concatenate([[reflect(view), [0.0, 0.0, 1.0], view], grid, sampled])

    angle = np.arange(16) * (np.pi / 8)
    step = 0.5 ** np.arange(1, 21)[:, None]
    ring = np.stack([step * np.cos(angle), step * np.sin(angle)], axis=-1).reshape(-1, 2)
    for _ in range(8):
        found = value(candidates)
        best = candidates[int(np.argmax(np.where(np.isfinite(found), found, -np.inf)))]
        near = best + ring @ frame(best)[:2]
        near = near[near[:, 2] > 0]
        candidates = np.concatenate([[best], near / np.linalg.norm(near, axis=-1, keepdims=True)])
    if best[2] >= _LOWEST_POLE:
        return np.array(best)
    level = best[:2] / np.linalg.norm(best[:2]) * np.sqrt(1 - _LOWEST_POLE**2)
    return np.array([*level, _LOWEST_POLE])


def _rays(around: FloatArray, psi: FloatArray, delta: FloatArray) -> FloatArray:
    """Return directions (P, R, 3), at angles ``delta`` (P, R) from the pole on the circles ``psi`` (P,)."""
    t, b, pole = around
    tangent = np.cos(psi)[:, None] * t + np.sin(psi)[:, None] * b
    wi = np.cos(delta)[..., None] * pole + np.sin(delta)[..., None] * tangent[:, None, :]
    wi[..., 2] = np.maximum(wi[..., 2], 0.0)
    result: FloatArray = wi / np.linalg.norm(wi, axis=-1, keepdims=True)
    return result


def _spacing(
    around: FloatArray, psi: FloatArray, count: int, value: Any, scale: Scale, decades: float
) -> FloatArray:
    """Return angles (P, count) from the pole to the horizon, spaced by the length of the curve drawn."""
    t, b, pole = around
    horizon = _EDGE * np.arctan2(pole[2], -(np.cos(psi) * t[2] + np.sin(psi) * b[2]))
    x = np.linspace(0.0, 1.0, _SCAN)
    fine = np.union1d(np.sinh(_STRETCH * x) / np.sinh(_STRETCH), x)
    delta = horizon[:, None] * fine
    wi = _rays(around, psi, delta)
    values = value(wi.reshape(-1, 3)).reshape(delta.shape)
    values = np.where(np.isfinite(values), values, 0.0)
    peak = float(values.max())
    radius = _radius(values, peak, scale, decades)
    if peak > 0 and scale == "linear":
        radius = radius / peak
    steps = np.linalg.norm(np.diff(radius[..., None] * wi, axis=1), axis=-1)
    steps += _UNIFORM_SHARE * horizon[:, None] / np.pi * np.diff(fine)
    steps += _LOGARITHMIC_SHARE * np.diff(np.arcsinh(fine * np.sinh(_STRETCH)) / _STRETCH)
    length = np.concatenate([np.zeros((len(psi), 1)), np.cumsum(steps, axis=1)], axis=1)
    length /= length[:, -1:]
    even = np.linspace(0.0, 1.0, count)
    return np.stack([np.interp(even, row, angles) for row, angles in zip(length, delta, strict=True)])


def _faces(circles: int, rings: int) -> npt.NDArray[np.int64]:
    """Return the faces around vertex 0, of circles of ``rings`` vertices each, as VTK wants them."""
    here = 1 + rings * np.arange(circles)
    there = np.roll(here, -1)
    fan = np.stack([np.full(circles, 3), np.zeros(circles, dtype=int), here, there], axis=-1)
    ring = np.arange(rings - 1)
    a, d = here[:, None] + ring, there[:, None] + ring
    quads = np.stack([np.full_like(a, 4), a, a + 1, d + 1, d], axis=-1)
    return np.concatenate([fan.ravel(), quads.ravel()])
