"""Pixels: how shaded pixels come back from the workers and are put together."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from radiokit.faces.render.picture import Image
from radiokit.faces.render.scenes import Setting
from radiokit.facts.estimate import Estimate

__all__ = ["Pixels", "assemble", "followed"]

Part = TypeVar("Part")


@dataclass(frozen=True)
class Pixels:
    """Some pixels of a picture: their numbers (n,), counted along the rows, and their estimates."""

    number: npt.NDArray[np.intp]
    found: tuple[Estimate, ...]


def followed(parts: Iterable[Part], count: int, progress: Callable[[int, int], None] | None) -> list[Part]:
    """Return all parts, and say after each how many are done."""
    found = []
    for part in parts:
        found.append(part)
        if progress is not None:
            progress(len(found), count)
    return found


def assemble(setting: Setting, parts: Iterable[Pixels], about: dict[str, Any], start: float) -> Image:
    """Put shaded pixels into the picture, before what is seen of the lights themselves."""
    camera = setting.camera
    shape = (camera.height, camera.width)
    parts = list(parts)
    found = [each for part in parts for each in part.found]
    numbers = np.concatenate([part.number for part in parts])
    count = max((np.shape(each.value) for each in found), default=())
    surface = np.zeros(shape, dtype=bool)
    surface.flat[numbers] = True
    statistical, converged = np.zeros(shape, dtype=bool), np.ones(shape, dtype=bool)
    values, error = np.zeros((*shape, *count)), np.zeros((*shape, *count))
    origin = np.array(camera.position)
    for row, column in np.argwhere(~surface):
        values[row, column] = setting.seen(camera.rays[row, column], origin)
    for number, each in zip(numbers, found, strict=True):
        place = divmod(int(number), camera.width)
        values[place], error[place] = each.value, each.error
        statistical[place], converged[place] = not each.is_bound, each.converged
    return Image(
        values=values,
        error=error,
        statistical=statistical,
        converged=converged,
        surface=surface,
        evaluations=sum(each.evaluations for each in found),
        seconds=time.perf_counter() - start,
        about=about,
    )
