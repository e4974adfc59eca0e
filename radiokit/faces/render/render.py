"""Render: a picture of a scene, each pixel by the point shader, with a seed of its own."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from typing import Any, Literal

import numpy as np

from radiokit.contracts.bsdf import BSDF
from radiokit.faces.render.furnace import furnace_image
from radiokit.faces.render.picture import Image
from radiokit.faces.render.pixels import Pixels, assemble, followed
from radiokit.faces.render.scenes import Setting, make_setting
from radiokit.faces.workers import SerialExecutor
from radiokit.facts.errors import ParameterError, UnknownNameError
from radiokit.facts.estimate import rounding
from radiokit.measure.montecarlo import block_generator, seed_from
from radiokit.worlds.enclosure import METHODS, radiance
from radiokit.worlds.shading import shade

__all__ = ["PATHS", "Bounces", "render"]

Bounces = Literal["one", "all"]

PATHS = 256
"""Paths of the random walk for each pixel, when nothing else is asked for."""


def render(
    scene: str,
    f: BSDF | Callable[..., Any] | None = None,
    *,
    light: str | None = None,
    size: int = 64,
    method: str = "auto",
    bounces: Bounces = "one",
    rtol: float | None = None,
    samples: int | None = None,
    rng: int | np.random.Generator | None = 0,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Image:
    """Return a picture of a scene: for each pixel the radiance along the ray through its middle.

    Parameters
    ----------
    scene : {"sphere", "plane", "box"}
        A sphere, a plane to the horizon, or a box whose walls are diffuse, red on the left and green on the
        right (three wavelengths), with a luminous panel in its ceiling and an open front.
    f : BSDF or callable, optional
        The material of the sphere or the plane; Lambert of reflectance 0.8 when not given.
    light : str, optional
        ``furnace`` (radiance 1 from everywhere), ``isothermal`` (the same, and the sphere emits what it
        absorbs, as in a furnace of one temperature: see ``furnace_image``), ``lamp`` (a point light) or
        ``sky`` (overcast, with a sun); ``panel`` in the box.
    size : int
        Width and height in pixels.
    method : str
        As for ``shade``; with ``isothermal`` it is that of the reflected part.
    bounces : {"one", "all"}
        Whether the walls of the box light each other: by a random walk, as in ``enclosure.radiance``. There
        is nothing else in the other scenes.
    rtol : float, optional
        As for ``shade``, 1e-3 by default. The random walk and the isothermal furnace follow ``samples``
        unless it is given.
    samples : int, optional
        As for ``shade``; 256 for each pixel of the random walk, without a tolerance.
    rng : int, numpy.random.Generator or None
        Each pixel, or each row of a random walk, has a generator of its own, made from this seed and its
        number: the picture is the same for any number of workers.
    executor : concurrent.futures.Executor, optional
        Shades the rows of pixels.
    progress : callable, optional
        Called with the number of finished rows and the number of all.

    Raises
    ------
    UnknownNameError
        When there is no such scene, no such light in it, or no such method.
    ParameterError
        When an argument is not allowed.
    RadiokitError
        When the method does not apply to a pixel.

    >>> picture = render("sphere", light="lamp", size=8)
    >>> picture.values.shape, bool(picture.values.max() > 0), int(picture.surface.sum())
    ((8, 8), True, 44)
    """
    setting = make_setting(scene, f, light=light, size=size)
    seed = seed_from(rng)
    if bounces not in ("one", "all"):
        raise ParameterError("bounces", bounces, "'one' or 'all'")
    if bounces == "all" and setting.room is None:
        raise ParameterError("bounces", bounces, "'one', or the scene a box")
    if bounces == "all" and method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    if setting.light == "isothermal":
        own = "mc-bsdf" if method == "auto" else method
        return furnace_image(
            setting.materials[0],
            size=size,
            method=own,
            samples=samples,
            rtol=rtol,
            rng=seed,
            executor=executor,
            progress=progress,
        )
    start = time.perf_counter()
    if bounces == "all":
        samples = PATHS if samples is None and rtol is None else samples
    else:
        rtol = 1e-3 if rtol is None else rtol
    work = partial(_row, setting, bounces, {"method": method, "rtol": rtol, "samples": samples}, seed)
    rows: Iterable[Pixels] = (executor or SerialExecutor()).map(work, range(size))
    parts = followed(rows, size, progress)
    about = {
        "scene": setting.name,
        "light": setting.light,
        "materials": [repr(material) for material in setting.materials],
        "method": method,
        "bounces": bounces,
        "rtol": rtol,
        "samples": samples,
        "seed": seed,
    }
    return assemble(setting, parts, about, start)


def _row(setting: Setting, bounces: Bounces, how: dict[str, Any], seed: int, row: int) -> Pixels:
    """Shade the pixels of one row; a random walk takes them all together."""
    hits, rays, width = setting.trace(setting.camera), setting.camera.rays[row], setting.camera.width
    columns = np.flatnonzero(hits.material[row] >= 0)
    place, towards, normal = hits.position[row, columns], -rays[columns], hits.normal[row, columns]
    numbers = row * width + columns
    if bounces == "all" and setting.room is not None:
        if not len(columns):
            return Pixels(numbers, ())
        generator = block_generator(seed, row)
        every = radiance(setting.room, position=place, direction=towards, rng=generator, **how)
        return Pixels(
            numbers,
            tuple(replace(every, value=v, error=e) for v, e in zip(every.value, every.error, strict=True)),
        )
    found = []
    for k, column in enumerate(columns):
        if hits.lamp[row, column]:
            seen = setting.seen(rays[column], np.array(setting.camera.position))
            found.append(rounding(np.full(3, seen)))
            continue
        found.append(
            shade(
                setting.materials[hits.material[row, column]],
                setting.lights,
                towards[k],
                normal=normal[k],
                position=place[k],
                rng=block_generator(seed, int(numbers[k])),
                **how,
            )
        )
    return Pixels(numbers, tuple(found))
