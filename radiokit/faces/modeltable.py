"""The table of models: what each is, which laws it keeps, how it samples, and what it costs."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from radiokit.checks.parts import index_squared, scattered
from radiokit.checks.probes import pairs, polar
from radiokit.contracts.albedo import Side
from radiokit.contracts.bsdf import BSDF, FloatArray, bsdf, list_bsdfs
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.jsonable import jsonable
from radiokit.facts.source import Source
from radiokit.measure.lattice import kronecker

__all__ = ["COLUMNS", "ModelRow", "ModelTable", "models_table"]

COLUMNS = (
    "model",
    "year",
    "source",
    "kind",
    "reciprocal",
    "conserves",
    "largest albedo",
    "lossless",
    "sampling",
    "weight at 60°",
    "ns",
)

ANGLES_DEG = (0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0, 88.0, 89.5, 89.99)
SAMPLES = 1 << 13
_FLAT = 1e-6  # albedos that differ by less are called the same
_ACCURACY = 1e-7  # of an albedo
_REPEATS = 7


@dataclass(frozen=True)
class ModelRow:
    """One model at its default parameters.

    Parameters
    ----------
    supremum : float
    supremum : float
        The largest directional albedo of a scan in polar angle, refined; on both sides and for either fixed
        direction, where they differ.
    where_deg : float or None
        Its polar angle [°]; None where the albedo is the same at every angle.
    weight_largest, weight_spread : float
        Of the sampler's weights at θo = 60°, over their mean: the largest, and the standard deviation. 1
        and 0 are perfect.
    nanoseconds : float or None
        For one value, by NumPy in blocks; None where it was not timed.
    """

    name: str
    source: Source
    kind: str
    parameters: dict[str, Any]
    reciprocity: str
    conserves: bool | None
    lossless: bool | None
    supremum: float
    where_deg: float | None
    sampling: str
    weight_largest: float
    weight_spread: float
    nanoseconds: float | None = None

    def cells(self) -> tuple[str, ...]:
        """Return the row as text, in the order of ``COLUMNS``."""
        place = "at every angle" if self.where_deg is None else f"at {self.where_deg:.0f}°"
        if self.where_deg is not None and self.where_deg > 89.5:
            place = "towards 90°"
        return (
            self.name,
            str(self.source.year),
            _short(self.source.authors),
            self.kind,
            self.reciprocity,
            _word(self.conserves),
            f"{self.supremum:.4f} {place}",
            _word(self.lossless),
            self.sampling,
            f"≤ {self.weight_largest:.2f}, σ {self.weight_spread:.2f}",
            "" if self.nanoseconds is None else f"{self.nanoseconds:.0f}",
        )

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON-ready data."""
        return {name: jsonable(getattr(self, name)) for name in self.__dataclass_fields__}


@dataclass(frozen=True)
class ModelTable:
    """All models, one a row; printing gives text, a notebook shows HTML."""

    rows: tuple[ModelRow, ...]

    def __iter__(self) -> Iterator[ModelRow]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, name: str) -> ModelRow:
        return {row.name: row for row in self.rows}[name]

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns: without the cost, if nothing was timed."""
        timed = any(row.nanoseconds is not None for row in self.rows)
        return COLUMNS if timed else COLUMNS[:-1]

    def cells(self) -> list[tuple[str, ...]]:
        """Return all rows as text."""
        return [row.cells()[: len(self.columns)] for row in self.rows]

    def markdown(self) -> str:
        """Return the table in Markdown."""
        lines = [self.columns, ("---",) * len(self.columns), *self.cells()]
        return "\n".join(f"| {' | '.join(line)} |" for line in lines)

    def to_json(self) -> list[dict[str, Any]]:
        """Return the rows as JSON-ready data."""
        return [row.to_json() for row in self.rows]

    def __str__(self) -> str:
        lines = [self.columns, *self.cells()]
        widths = [max(len(line[k]) for line in lines) for k in range(len(self.columns))]
        texts = ("  ".join(cell.ljust(w) for cell, w in zip(line, widths, strict=True)) for line in lines)
        return "\n".join(text.rstrip() for text in texts)

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{escape(column)}</th>" for column in self.columns)
        body = "".join(
            f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in line)}</tr>" for line in self.cells()
        )
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def models_table(names: str | Iterable[str] | None = None, *, timing: bool = True) -> ModelTable:
    """Return the table of models, each at its default parameters.

    Parameters
    ----------
    names : str or iterable of str, optional
        Which models; all by default.
    timing : bool
        Whether to measure what an evaluation costs; without it, every run gives the same table.

    Raises
    ------
    UnknownNameError
        When there is no such model.

    >>> table = models_table(["lambert", "mirror"], timing=False)
    >>> table["lambert"].kind, round(table["lambert"].supremum, 6), table["mirror"].sampling
    ('diffuse', 1.0, 'delta')
    """
    wanted = list_bsdfs() if names is None else [names] if isinstance(names, str) else names
    models = [bsdf(name) for name in wanted]
    costs = _costs(models) if timing else [None] * len(models)
    return ModelTable(tuple(_row(f, cost) for f, cost in zip(models, costs, strict=True)))


def _row(f: BSDF, cost: float | None) -> ModelRow:
    said = f.claims
    supremum, where = _supremum(f)
    largest, spread = _weights(f)
    return ModelRow(
        name=f.name,
        source=f.SOURCE,
        kind=f.kind,
        parameters=f.parameters(),
        reciprocity="" if said is None else said.reciprocity,
        conserves=None if said is None else said.conserves,
        lossless=None if said is None else said.lossless,
        supremum=supremum,
        where_deg=where,
        sampling=_sampler(f),
        weight_largest=largest,
        weight_spread=spread,
        nanoseconds=cost,
    )


def _supremum(f: BSDF) -> tuple[float, float | None]:
    """Scan the albedo in polar angle, and climb between the neighbours of the highest."""
    from scipy.optimize import minimize_scalar

    said = f.claims
    sides: Sequence[Side] = ("wo",) if said is not None and said.reciprocity != "no" else ("wo", "wi")
    places = [
        (side, azimuth, below)
        for side in sides
        for azimuth in ((0.3,) if f.isotropic else (0.0, np.pi / 4, np.pi / 2))
        for below in ((False, True) if f.transmissive else (False,))
    ]

    def at(degrees: float, side: Side, azimuth: float, below: bool) -> float:
        w = polar([np.cos(np.deg2rad(degrees))], [azimuth])[0] * [1.0, 1.0, -1.0 if below else 1.0]
        found = scattered(f, w, fixed=side, rtol=_ACCURACY, atol=_ACCURACY, max_evaluations=400_000)
        return float(np.max(found.value))

    scan = np.array([[at(angle, *place) for angle in ANGLES_DEG] for place in places])
    if np.ptp(scan) <= _FLAT:
        return float(scan.max()), None
    row, column = divmod(int(np.argmax(scan)), len(ANGLES_DEG))
    best, where = float(scan[row, column]), ANGLES_DEG[column]
    low, high = ANGLES_DEG[max(column - 1, 0)], ANGLES_DEG[min(column + 1, len(ANGLES_DEG) - 1)]
    found = minimize_scalar(
        lambda angle: -at(angle, *places[row]),
        bounds=(low, high),
        method="bounded",
        options={"xatol": 0.05, "maxiter": 12},
    )
    if -found.fun > best + _FLAT:
        best, where = -float(found.fun), float(found.x)
    return best, where


def _weights(f: BSDF) -> tuple[float, float]:
    """Return the largest weight at 60° and the standard deviation, over the mean; 0 for black."""
    wo = np.broadcast_to(spherical_to_cartesian(np.deg2rad(60.0), 0.4), (SAMPLES, 3))
    wi, weight = f.sample(kronecker(SAMPLES, f.dimensions), wo)
    weight = np.asarray(weight) if np.ndim(weight) == 1 else np.mean(weight, axis=1)
    flux: FloatArray = weight * index_squared(f, wi) / index_squared(f, wo)
    mean = float(flux.mean())
    return (float(flux.max()) / mean, float(flux.std()) / mean) if mean > 0 else (0.0, 0.0)


def _sampler(f: BSDF) -> str:
    """Return how a model samples: its delta lobes, the cosine, or its own lobe."""
    said = f.claims
    if said is not None and said.delta:
        return "delta"
    wi, wo = pairs(64)
    density = np.asarray(f.pdf(wi, wo))
    return "cosine" if np.allclose(density, wi[:, 2] / np.pi, rtol=1e-12, atol=0.0) else "own"


def _costs(models: Sequence[BSDF]) -> list[float | None]:
    """Time one evaluation of each [ns], in turns, so that a busy moment is no model's alone; the medians."""
    wi, wo = pairs(1 << 13)
    seconds = np.empty((_REPEATS, len(models)))
    for repeat in range(-1, _REPEATS):  # the first warms up
        for k, f in enumerate(models):
            start = time.perf_counter()
            f.evaluate(wi, wo)
            seconds[max(repeat, 0), k] = time.perf_counter() - start
    return [float(cost) for cost in 1e9 * np.median(seconds, axis=0) / len(wi)]


def _short(authors: str) -> str:
    names = authors.split(", ")
    return names[0] if len(names) == 1 else " & ".join(names) if len(names) == 2 else f"{names[0]} et al."


def _word(claim: bool | None) -> str:
    return "" if claim is None else "yes" if claim else "no"
