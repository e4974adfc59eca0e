"""Sheet: all models in the isothermal furnace, side by side on one picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from radiokit.faces.render.furnace import FurnaceImage
from radiokit.faces.render.picture import srgb
from radiokit.facts.errors import RadiokitError
from radiokit.facts.verdict import Outcome

__all__ = ["GAIN", "draw_sheet"]

GAIN = 10.0
"""By how much the right halves magnify the difference from the background."""

_COLUMNS = 7
_GREY = 0.5  # what radiance 1 is shown as


def draw_sheet(pictures: Sequence[tuple[str, FurnaceImage]], path: str | Path) -> Path:
    """Draw named furnace pictures on one sheet and return its path.

    The left half of each sphere is what it reflects, without its own emission: what it absorbs is dark. The
    right half is reflection and emission, less the background, ``GAIN`` times.

    Raises
    ------
    RadiokitError
        When the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    rows = math.ceil(len(pictures) / _COLUMNS)
    figure = Figure(figsize=(1.55 * _COLUMNS, 1.85 * rows + 0.7), dpi=110, layout="constrained")
    FigureCanvasAgg(figure)
    axes = np.atleast_1d(figure.subplots(rows, _COLUMNS)).ravel()
    for axis in axes:
        axis.set_axis_off()
    for axis, (name, picture) in zip(axes, pictures, strict=False):
        shown = np.where(
            np.arange(picture.values.shape[1]) < picture.values.shape[1] / 2,
            _GREY * picture.reflected,
            _GREY + GAIN * _GREY * (picture.values - 1.0),
        )
        axis.imshow(srgb(shown), cmap="gray", vmin=0.0, vmax=1.0, interpolation="nearest")
        outcome = picture.verdict().outcome
        colour = "black" if outcome is Outcome.HOLDS else "firebrick"
        axis.set_title(name, fontsize=8, color=colour)
    figure.suptitle(
        "A furnace of radiance 1 (grey). Left halves: what each model reflects. Right halves: with what "
        f"it emits\nat the furnace's temperature, {GAIN:g} times the difference from the background. Red: it "
        "does not vanish.",
        fontsize=9,
    )
    try:
        figure.savefig(path)
    except OSError as error:
        raise RadiokitError(f"cannot write {path}: {error}", path=str(path)) from error
    return Path(path)
