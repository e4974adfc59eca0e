"""Lobes: how a surface scatters, as a picture in three dimensions."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from radiokit.faces.plots.lobe_mesh import Scale, lobe_mesh
from radiokit.faces.plots.lobe_scene import lobe_scene
from radiokit.faces.plots.offscreen import offscreen, require_pyvista
from radiokit.facts.errors import MissingExtraError, ParameterError

__all__ = ["lobe_mesh", "save_lobe", "show_lobe"]

_TASK = "drawing a lobe"


def save_lobe(
    f: Any,
    *,
    theta: float,
    phi: float = 0.0,
    png: str | Path,
    cosine: bool = True,
    scale: Scale = "linear",
    decades: float = 4.0,
    resolution: int = 128,
    size: tuple[int, int] = (1200, 900),
) -> Path:
    """Draw the lobe of ``f`` for the viewer at (``theta``, ``phi``) into a PNG file; no display is needed.

    The dome around the lobe is the hemisphere of directions; its radius is the lobe's peak. Delta lobes
    are arrows as long as their share of the flux.

    Parameters
    ----------
    f : BSDF or callable
        f(wi, wo) [sr⁻¹].
    theta, phi : float
        Polar angle in [0, π/2) and azimuth of ``wo`` [rad].
    png : path
        The file to write.
    cosine, scale, decades, resolution
        As in ``lobe_mesh``.
    size : (int, int)
        Width and height in pixels, at least 200 each.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    ParameterError
        When an argument is out of its range.
    MissingExtraError
        When PyVista is not installed.
    RadiokitError
        When there is no OpenGL to draw with.
    """
    path = Path(png)
    if path.suffix.lower() != ".png":
        raise ParameterError("png", str(png), "the name of a .png file")
    if not path.parent.is_dir():
        raise ParameterError("png", str(png), "in a folder that exists")
    picture = _picture(f, theta, phi, cosine, scale, decades, resolution, size)
    picture.save(path)
    return path


def show_lobe(
    f: Any,
    *,
    theta: float,
    phi: float = 0.0,
    cosine: bool = True,
    scale: Scale = "linear",
    decades: float = 4.0,
    resolution: int = 128,
    size: tuple[int, int] = (900, 675),
    backend: str = "static",
) -> Any:
    """Show the lobe of ``f`` in a notebook.

    Parameters
    ----------
    f, theta, phi, cosine, scale, decades, resolution, size
        As in ``save_lobe``.
    backend : {"static", "trame", "html", "client", "server"}
        A picture, which needs nothing but PyVista, or one of PyVista's backends, whose view can be turned.

    Returns
    -------
    PIL.Image.Image or a widget
        Which the notebook shows when it is a cell's last value.

    Raises
    ------
    ParameterError
        When an argument is out of its range.
    MissingExtraError
        When PyVista, or for another backend trame, is not installed.
    RadiokitError
        When there is no OpenGL to draw with.
    """
    if backend == "static":
        return _picture(f, theta, phi, cosine, scale, decades, resolution, size)
    if backend not in ("trame", "html", "client", "server"):
        raise ParameterError("backend", backend, "'static', 'trame', 'html', 'client' or 'server'")
    require_pyvista(_TASK)
    if find_spec("trame") is None:
        raise MissingExtraError("turning a lobe in a notebook", "trame", "viz")
    with offscreen():
        plotter = lobe_scene(f, theta, phi, cosine, scale, decades, resolution, size)
        plotter.notebook = True
        return plotter.show(jupyter_backend=backend, return_viewer=True)


def _picture(f: Any, *options: Any) -> Any:
    import numpy as np
    from PIL import Image

    require_pyvista(_TASK)
    with offscreen():
        plotter = lobe_scene(f, *options)
        try:
            pixels = np.asarray(plotter.screenshot(return_img=True))
        finally:
            plotter.close()
    return Image.fromarray(pixels)
