"""Factor rows: view factors, far, near and thin."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

from radiokit.faces.stability import factortruth as truth
from radiokit.faces.stability.lights import Case, LightRow
from radiokit.physics import view_factor as vf

__all__ = ["rows"]

_LENGTHS = (1e-8, 1e-3, 0.3, 1.0, 1.0 + 2.0**-40, 7.0, 1e4, 1e9)
_TILTS = (0.0, 1e-9, 0.5, 1.5, math.pi / 2 - 1e-9, math.pi / 2, math.pi / 2 + 1e-9, 2.0, 2.6, 3.1)


def rows() -> tuple[LightRow, ...]:
    """Return the rows."""
    c41 = ("radius1", "radius2", "distance")
    return (
        _row("parallel disks", vf.parallel_disks, truth.c41, c41, "C-41"),
        _row(
            "parallel rectangles", vf.parallel_rectangles, truth.c11, ("width", "length", "distance"), "C-11"
        ),
        _row(
            "perpendicular rectangles",
            vf.perpendicular_rectangles,
            truth.c14,
            ("edge", "width", "height"),
            "C-14",
        ),
        _row("sphere to disk", vf.sphere_to_disk, truth.ball_disk, ("radius", "distance"), "section C"),
        _row(
            "disk to sphere",
            vf.disk_to_sphere,
            truth.disk_ball,
            ("disk_radius", "sphere_radius", "distance"),
            "section C, by reciprocity",
            lambda _, ball, distance: ball <= distance,
        ),
        _row(
            "element to parallel disk",
            vf.differential_to_disk,
            truth.b13,
            ("radius", "distance", "offset"),
            "B-13",
        ),
        _row(
            "element to perpendicular disk",
            lambda **x: vf.differential_to_disk(**x, orientation="perpendicular"),
            truth.b13_aside,
            ("radius", "distance", "offset"),
            "B-13, seen across",
            lambda radius, _, offset: offset >= radius,
        ),
        _row(
            "element to parallel rectangle",
            vf.differential_to_rectangle,
            truth.b3,
            ("width", "length", "distance"),
            "B-3",
        ),
        _row(
            "element to perpendicular rectangle",
            lambda **x: vf.differential_to_rectangle(**x, orientation="perpendicular"),
            truth.b4,
            ("width", "length", "distance"),
            "B-4",
        ),
        LightRow(
            name="element to sphere",
            truth="Lagarde, de Rousiers (2014), the cut sphere by acos and atan",
            kernel=lambda r, d, t: float(vf.differential_to_sphere(radius=r, distance=d, tilt=t)),
            exact=truth.tilted_ball,
            cases=tuple(
                (f"distance {d:.17g}, tilt {t:.10g}", (1.0, d, t))
                for d in (1 + 2.0**-50, 1 + 2.0**-30, 1.01, 2.0, 10.0, 1e4, 1e8)
                for t in _TILTS
            ),
        ),
    )


def _row(
    name: str,
    kernel: Callable[..., Any],
    exact: Callable[..., Any],
    lengths: tuple[str, ...],
    number: str,
    allowed: Callable[..., bool] = lambda *_: True,
) -> LightRow:
    cases: list[Case] = [
        (", ".join(f"{key} {x:g}" for key, x in zip(lengths, values, strict=True)), values)
        for values in itertools.product(_LENGTHS, repeat=len(lengths))
        if allowed(*values)
    ]
    return LightRow(
        name=name,
        truth=f"Howell's catalogue, {number}",
        kernel=lambda *x: float(kernel(**dict(zip(lengths, x, strict=True)))),
        exact=exact,
        textbook=lambda *x: _in_floats(exact, x),
        cases=tuple(cases),
    )


def _in_floats(exact: Callable[..., Any], numbers: tuple[float, ...]) -> float:
    """Return what the catalogue's formula gives at the precision of floats."""
    import mpmath

    from radiokit.measure.twin import working_precision

    with working_precision(15):
        return float(mpmath.re(exact(*map(mpmath.mpf, numbers))))
