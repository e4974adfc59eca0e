"""The scene around a lobe: the surface, the hemisphere of directions, arrows, and what they mean."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.faces.plots.lobe_mesh import Scale, check_options, lobe_mesh
from radiokit.facts.directions import reflect, spherical_to_cartesian
from radiokit.facts.errors import ParameterError

if TYPE_CHECKING:
    import pyvista

__all__ = ["lobe_scene"]

_INK, _GREY, _PALE, _DISK = "#1f2933", "#7b8794", "#b4bfca", "#eef1f5"
_VIEW, _DELTA, _BAD = "#c2185b", "#e8710a", "#ff00ff"
_COLOURS = "viridis"
_FONT_FILE = 4  # VTK_FONT_FILE


_Side = Literal["left", "center", "right"]
_Level = Literal["top", "center", "bottom"]


class _Label(NamedTuple):
    place: FloatArray
    text: str
    colour: str
    side: _Side = "center"
    level: _Level = "center"


def lobe_scene(
    f: Any,
    theta: float,
    phi: float,
    cosine: bool,
    scale: Scale,
    decades: float,
    resolution: int,
    size: tuple[int, int],
) -> pyvista.Plotter:
    """Return the scene: the surface, the dome of directions, the lobe, the arrows, and what they mean."""
    check_options(scale, decades, resolution)
    if not 0 <= theta < math.pi / 2:
        raise ParameterError("theta", theta, "an angle in [0, pi/2) radians")
    if len(size) != 2 or min(size) < 200:
        raise ParameterError("size", size, "a width and a height of at least 200 pixels")
    import pyvista as pv

    model = as_bsdf(f)
    wo = spherical_to_cartesian(theta, phi)
    mesh = lobe_mesh(model, wo, cosine=cosine, scale=scale, decades=decades, resolution=resolution)
    values = mesh["value"]
    finite = np.isfinite(values)
    best = int(np.argmax(np.where(finite, values, -np.inf)))
    peak = float(values[best])
    unit = min(size[0] / 1200, size[1] / 900)

    plotter = pv.Plotter(off_screen=True, window_size=list(size), theme=pv.themes.DocumentTheme())
    plotter.enable_anti_aliasing("ssaa")
    labels: list[_Label] = []
    symbol = "f cos θᵢ" if cosine else "f"
    lines = [f"θₒ = {math.degrees(theta):.4g}°, φₒ = {math.degrees(phi):.4g}°"]
    if peak > 0:
        if scale == "linear":
            mesh.points /= peak
        _add_lobe(plotter, mesh, peak, symbol, scale, decades, unit)
        at = _polar(mesh["wi"][best])
        lines[0] += f",  peak of {symbol} = {peak:.4g} sr⁻¹ at θᵢ = {at:.1f}°"
        if scale == "log":
            lines[0] += f",  logarithmic over {decades:g} decades"
    if not finite.all():
        lines.append(f"{np.count_nonzero(~finite)} of {len(values)} values are NaN or infinite")

    mirror = reflect(wo)
    below = False
    for lobe in model.delta_lobes(wo[None]):
        weight = float(np.mean(lobe.weight[0]))
        if weight > 0:
            below = below or bool(lobe.wi[0, 2] < 0)
            _add_arrow(plotter, lobe.wi[0] * weight, _DELTA, radius=0.018)
            # To the left of an arrow that points to the left: under it when it rises, over it when it falls.
            level: _Level = "bottom" if lobe.wi[0, 2] < 0 else "top"
            place = lobe.wi[0] * 0.6 * weight
            labels.append(_Label(place, f"δ, weight {weight:.3g}     ", _DELTA, "right", level))
            lines.append(f"delta lobe at θᵢ = {_polar(lobe.wi[0]):.1f}°: {weight:.4g} of the flux")
    _add_arrow(plotter, wo * 1.1, _VIEW)
    if theta < math.radians(4):
        labels.append(_Label(np.array([0.0, 0.0, 1.16]), "n, ωₒ, mirror direction", _VIEW))
    else:
        labels.append(_Label(np.array([0.0, 0.0, 1.16]), "n", _GREY))
        labels.append(_Label(wo * 1.13, " ωₒ", _VIEW, "left"))
        labels.append(_Label(mirror * 1.13, "mirror ", _GREY, "right"))
        _add_dashes(plotter, mirror * 1.1, unit)
        _add_dashes(plotter, np.array([0.0, 0.0, 1.1]), unit)
    _add_dome(plotter, phi, unit, opacity=0.55 if below else 0.85)
    _add_texts(plotter, labels, _title(model), lines, unit)
    _aim(plotter, phi, below, size[1] / (900 * unit))
    return plotter


def _polar(w: FloatArray) -> float:
    return math.degrees(math.atan2(math.hypot(w[0], w[1]), w[2]))


def _title(model: BSDF) -> str:
    name = model.name or getattr(model, "label", type(model).__name__)
    values = {} if not model.name else model.parameters()
    shown = ", ".join(
        f"{key} = {value:.4g}" if isinstance(value, float) else f"{key} = {value}"
        for key, value in values.items()
        if value is not None
    )
    return f"{name}: {shown}" if shown else name


def _add_dome(plotter: Any, phi: float, unit: float, opacity: float) -> None:
    """Add the surface, and circles of the hemisphere of directions: the horizon, 30°, 60°, two meridians."""
    import pyvista as pv

    disk = pv.Disc(center=(0, 0, -0.004), inner=0.0, outer=1.0, r_res=1, c_res=180)
    plotter.add_mesh(disk, color=_DISK, lighting=False, opacity=opacity)
    turn = np.linspace(0.0, 2 * np.pi, 181)
    arc = np.linspace(-np.pi / 2, np.pi / 2, 91)
    for curve, colour, width in (
        (spherical_to_cartesian(np.pi / 2, turn), _GREY, 2.5),
        (spherical_to_cartesian(np.pi / 3, turn), _PALE, 1.4),
        (spherical_to_cartesian(np.pi / 6, turn), _PALE, 1.4),
        (spherical_to_cartesian(arc, phi), _GREY, 1.4),
        (spherical_to_cartesian(arc, phi + np.pi / 2), _PALE, 1.4),
    ):
        plotter.add_mesh(pv.lines_from_points(curve), color=colour, line_width=width * unit)


def _add_lobe(
    plotter: Any, mesh: Any, peak: float, symbol: str, scale: Scale, decades: float, unit: float
) -> None:
    import pyvista as pv

    low = peak * 10.0**-decades if scale == "log" else 0.0
    plotter.add_mesh(
        mesh,
        scalars="value",
        cmap=_COLOURS,
        clim=(low, peak),
        log_scale=scale == "log",
        nan_color=_BAD,
        smooth_shading=True,
        ambient=0.25,
        diffuse=0.75,
        specular=0.12,
        show_scalar_bar=False,
    )
    bar = plotter.add_scalar_bar(
        title=f"{symbol}  [sr⁻¹]\n",
        vertical=True,
        position_x=0.87,
        position_y=0.14,
        width=0.055,
        height=0.64,
        n_labels=5,
        fmt="%g",
        color=_INK,
        unconstrained_font_size=True,
    )
    bar.SetCustomLabels(pv.convert_array(_ticks(low, peak, scale), deep=True))
    bar.SetUseCustomLabels(True)
    bar.SetTextPad(round(8 * unit))
    _set_font(bar.GetTitleTextProperty(), 21 * unit)
    _set_font(bar.GetLabelTextProperty(), 19 * unit)


def _ticks(low: float, high: float, scale: Scale) -> FloatArray:
    """Return round numbers from ``low`` to ``high``; powers of ten on a logarithmic scale.

    >>> _ticks(0.0, 1.2, "linear").round(12).tolist()
    [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2]
    >>> _ticks(0.03, 300.0, "log").tolist()
    [0.1, 1.0, 10.0, 100.0]
    """
    if scale == "log":
        first, last = math.ceil(math.log10(low)), math.floor(math.log10(high))
        step = 1 + (last - first) // 8
        powers = [float(f"1e{power}") for power in range(first, last + 1, step)]
        return np.array(powers or [low, high])
    from matplotlib.ticker import MaxNLocator

    ticks = MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    return np.array([tick for tick in ticks if low <= tick <= high * (1 + 1e-12)])


def _add_arrow(plotter: Any, tip: FloatArray, colour: str, radius: float = 0.011) -> None:
    import pyvista as pv

    length = float(np.linalg.norm(tip))
    arrow = pv.Arrow(
        start=(0.0, 0.0, 0.0),
        direction=tip / length,
        scale=length,
        tip_length=min(0.5, 0.09 / length),
        tip_radius=2.6 * radius / length,
        shaft_radius=radius / length,
        tip_resolution=40,
        shaft_resolution=40,
    )
    plotter.add_mesh(arrow, color=colour, ambient=0.4, diffuse=0.6, smooth_shading=False)


def _add_dashes(plotter: Any, tip: FloatArray, unit: float, dashes: int = 22) -> None:
    import pyvista as pv

    stops = np.linspace(0.0, 1.0, 2 * dashes)[:, None] * tip
    block = pv.MultiBlock([pv.lines_from_points(np.stack(pair)) for pair in list(pairwise(stops))[::2]])
    plotter.add_mesh(block, color=_GREY, line_width=2.5 * unit)


def _add_texts(plotter: Any, labels: list[_Label], title: str, lines: list[str], unit: float) -> None:
    for label in labels:
        plotter.add_point_labels(
            label.place[None],
            [label.text],
            text_color=label.colour,
            font_size=round(24 * unit),
            font_file=_font(),
            bold=False,
            show_points=False,
            shape=None,
            always_visible=True,
            justification_horizontal=label.side,
            justification_vertical=label.level,
        )
    for row, text in enumerate([title, *lines]):
        place = (0.03, 0.945 - 0.05 * (row > 0) - 0.038 * max(row - 1, 0))
        added = plotter.add_text(text, position=place, viewport=True, color=_GREY if row else _INK)
        _set_font(added.prop, (21 if row else 27) * unit)


def _aim(plotter: Any, phi: float, below: bool, stretch: float) -> None:
    """Look at the plane of incidence nearly from the side, with ``wo`` on the right."""
    azimuth = phi - np.pi / 2 + np.radians(20)
    away = spherical_to_cartesian(np.radians(70), azimuth)
    right = spherical_to_cartesian(np.pi / 2, azimuth + np.pi / 2)
    focus = np.array([0.0, 0.0, 0.34 if below else 0.5]) + 0.16 * right
    plotter.camera.position = tuple(focus + (7.6 if below else 6.3) * stretch * away)
    plotter.camera.focal_point = tuple(focus)
    plotter.camera.up = (0.0, 0.0, 1.0)
    plotter.camera.view_angle = 20.0
    plotter.reset_camera_clipping_range()


def _font() -> str:
    """Return a font file with Greek letters and subscripts; Matplotlib always brings one."""
    import matplotlib

    return str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf")


def _set_font(text: Any, points: float) -> None:
    text.SetFontFamily(_FONT_FILE)
    text.SetFontFile(_font())
    text.SetFontSize(round(points))
    text.BoldOff()
    text.ItalicOff()
    text.ShadowOff()
