"""Cells: a hemisphere cut into cells that are fine where a lobe is, and what a pdf puts into each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from radiokit.checks.parts import Part, flipped
from radiokit.checks.refined import Shares, refined_shares
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.estimate import Estimate
from radiokit.measure.gauss import gauss_legendre
from radiokit.measure.quadrature import hemisphere
from radiokit.measure.refraction import refracted, refracted_inverse, refracted_map
from radiokit.measure.slope import find_lobe, mirrored, slope_inverse, slope_map, turned
from radiokit.measure.transmission import THIN, find_width, transmission

__all__ = ["Cells", "cells_of"]

CELLS = (12, 12)  # along radius and azimuth, on each side of the plane of incidence
COUNT = 2 * CELLS[0] * CELLS[1]
NODES = 8  # Gauss-Legendre nodes along each side of a cell, where that will do

Density = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Cells:
    """Cells in the slopes of the facets that reflect; of a lobe about wo, turned to the mirror direction."""

    density: Density
    aim: FloatArray
    width: float
    retro: bool = False

    def integral(self, most: int) -> Estimate:
        """Return the pdf's integral over the hemisphere."""
        return hemisphere(self._seen, wo=self.aim, width=self.width, rtol=1e-7, max_evaluations=most)

    def shares(self) -> tuple[FloatArray, int]:
        """Return the pdf's integral over each cell, and the evaluations."""
        wi, weight, _ = slope_map(self.aim, self.width, *_grid())
        return _masses(self._seen, wi, weight, self.aim)

    def refined(self, wi: FloatArray, count: int, most: int) -> Shares:
        """Return the same where lobes may be much narrower than cells, led by the samples (M, 3)."""

        def mass(x: FloatArray, s: FloatArray, far: Any) -> FloatArray:
            w, weight, _ = slope_map(self.aim, self.width, x, s)
            return self._seen(np.where(far[:, None], mirrored(w, self.aim), w)) * weight / 2

        wi = turned(wi) if self.retro else wi
        return refined_shares(mass, CELLS, slope_inverse(self.aim, self.width, wi), count, most)

    def counts(self, wi: FloatArray) -> Any:
        """Return how many of the directions (N, 3) are in each cell."""
        wi = turned(wi) if self.retro else wi
        return np.bincount(_index(*slope_inverse(self.aim, self.width, wi)), minlength=COUNT)[:COUNT]

    def _seen(self, w: FloatArray) -> FloatArray:
        return self.density(turned(w) if self.retro else w)


@dataclass(frozen=True)
class RefractedCells:
    """Cells in the slopes of the facets that refract; what no facet refracts is a cell of its own."""

    density: Density
    up: FloatArray
    eta: float
    width: float

    def integral(self, most: int) -> Estimate:
        """Return the pdf's integral over the hemisphere."""
        options: dict[str, Any] = {"eta": self.eta, "width": self.width}
        return transmission(self._below, wo=self.up, rtol=1e-7, max_evaluations=most, **options)

    def shares(self) -> tuple[FloatArray, int]:
        """Return the pdf's integral over each cell, and the evaluations."""
        wi, weight, *_ = refracted_map(self.up, self.eta, self.width, *_grid())
        found, spent = _masses(self._below, wi, weight, self.up)
        return np.append(found, max(0.0, self._total - float(found.sum()))), spent

    def refined(self, wi: FloatArray, count: int, most: int) -> Shares:
        """Return the same where lobes may be much narrower than cells, led by the samples (M, 3)."""

        def mass(x: FloatArray, s: FloatArray, far: Any) -> FloatArray:
            w, weight, *_ = refracted_map(self.up, self.eta, self.width, x, s)
            return self._below(np.where(far[:, None], mirrored(w, self.up), w)) * weight / 2

        w = flipped(wi, True)
        w = w[refracted(w, self.up, self.eta)]
        found = refined_shares(mass, CELLS, refracted_inverse(self.up, self.eta, self.width, w), count, most)
        rest = max(0.0, self._total - float(found.shares.sum()))
        return replace(found, shares=np.append(found.shares, rest))

    def counts(self, wi: FloatArray) -> Any:
        """Return how many of the directions (N, 3) are in each cell."""
        w = flipped(wi, True)
        inside = _index(*refracted_inverse(self.up, self.eta, self.width, w))
        cell = np.where(refracted(w, self.up, self.eta), inside, COUNT)
        return np.bincount(cell.astype(int), minlength=COUNT + 1)[: COUNT + 1]

    @cached_property
    def _total(self) -> float:
        return float(self.integral(1_000_000).value)

    def _below(self, w: FloatArray) -> FloatArray:
        return self.density(flipped(w, True))


def cells_of(f: BSDF, piece: Part, up: FloatArray) -> Cells | RefractedCells:
    """Return the cells that suit what ``f`` sends into one hemisphere, for a wo that is ``up``."""

    def density(w: FloatArray) -> FloatArray:
        return np.asarray(piece.density(np.broadcast_to(up, w.shape), w), dtype=float)

    eta = f.relative_index() ** (-1.0 if piece.below else 1.0)
    width = f.lobe_width()
    if piece.through and abs(eta - 1) >= THIN:
        if width is None:
            width, _ = find_width(lambda w: density(flipped(w, True)), up, eta)
        return RefractedCells(density, up, eta, width)
    aim = piece.aim(up)
    if width is not None and not piece.through:
        return Cells(density, aim, width)
    lobe = find_lobe(density, aim)
    return Cells(density, aim, lobe.width, lobe.retro)


def _grid() -> tuple[FloatArray, FloatArray]:
    """Return x and s of the nodes in all cells of the square."""
    x, s = np.meshgrid(_panels(CELLS[0])[0], _panels(CELLS[1])[0], indexing="ij")
    return x.ravel(), s.ravel()


def _masses(density: Density, wi: FloatArray, weight: FloatArray, wo: FloatArray) -> tuple[FloatArray, int]:
    """Integrate over every cell of the square of coordinates, on both sides of the plane of incidence."""
    weight = weight * np.outer(_panels(CELLS[0])[1], _panels(CELLS[1])[1]).ravel() / 2
    sides = []
    for points in (wi, mirrored(wi, wo)):
        mass = (density(points) * weight).reshape(CELLS[0], NODES, CELLS[1], NODES)
        sides.append(mass.sum(axis=(1, 3)).ravel())
    return np.concatenate(sides), 2 * len(wi)


def _panels(count: int) -> tuple[FloatArray, FloatArray]:
    x, w = gauss_legendre(NODES)
    return ((np.arange(count)[:, None] + x) / count).ravel(), np.tile(w / count, count)


def _index(x: FloatArray, s: FloatArray, far: Any) -> Any:
    i = np.minimum((x * CELLS[0]).astype(int), CELLS[0] - 1)
    j = np.minimum((s * CELLS[1]).astype(int), CELLS[1] - 1)
    return (far.astype(int) * CELLS[0] + i) * CELLS[1] + j
