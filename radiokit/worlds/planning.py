"""Planning: which method computes each light's term, why, and what else could."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.emitter import Emitter
from radiokit.facts.directions import check_directions
from radiokit.facts.errors import ParameterError, RadiokitError, UnknownNameError
from radiokit.measure.lowdiscrepancy import lattice_samples
from radiokit.worlds.scene import Receiver, check_emitter
from radiokit.worlds.terms import DELTA_LIGHT, DELTA_LOBES, MAX_SAMPLES, SMOOTH, Term

__all__ = ["METHODS", "Plan", "Row", "check_direction", "make_plan"]

FloatArray = npt.NDArray[np.float64]

METHODS = ("auto", "sum", "closed form", "quadrature", "mc", "mc-bsdf", "mc-light", "mis", "qmc")
"""What ``shade`` understands; ``mc`` stands for the Monte Carlo method that suits the term best, and ``qmc``
for that method with low-discrepancy points."""

_SAMPLED = ("mc-bsdf", "mc-light", "mis", "qmc")


@dataclass(frozen=True)
class Row:
    """One term of the plan: what it is, how it is computed, why, at what cost, and what else applies."""

    name: str
    method: str
    why: str
    evaluations: int
    alternatives: tuple[str, ...]
    term: Term = field(repr=False, compare=False)

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON-ready data."""
        return {
            "term": self.name,
            "method": self.method,
            "why": self.why,
            "evaluations": self.evaluations,
            "alternatives": list(self.alternatives),
        }


@dataclass(frozen=True)
class Plan:
    """How a shading value is computed: a row for each term. It prints as a table, in a notebook too."""

    subject: str
    rtol: float
    rows: tuple[Row, ...]

    _COLUMNS = ("term", "method", "evaluations", "why", "also possible")

    def _cells(self) -> list[tuple[str, ...]]:
        return [
            (row.name, row.method, str(row.evaluations), row.why, ", ".join(row.alternatives) or "nothing")
            for row in self.rows
        ]

    def __str__(self) -> str:
        lines = [f"{self.subject}, relative tolerance {self.rtol:g}"]
        if not self.rows:
            lines.append("  no light: 0")
        for name, method, evaluations, why, others in self._cells():
            lines.append(f"  {name}: {method}, about {evaluations} evaluations")
            lines.append(f"    because {why}")
            lines.append(f"    also possible: {others}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{escape(name)}</th>" for name in self._COLUMNS)
        rows = ["".join(f"<td>{escape(cell)}</td>" for cell in cells) for cells in self._cells()]
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        caption = f"<caption>{escape(self.subject)}, relative tolerance {self.rtol:g}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def to_json(self) -> dict[str, Any]:
        """Return the plan as JSON-ready data."""
        return {
            "subject": self.subject,
            "rtol": self.rtol,
            "rows": [row.to_json() for row in self.rows],
        }


def check_direction(name: str, value: npt.ArrayLike) -> FloatArray:
    """Return one unit vector (3,)."""
    direction = check_directions(name, value)
    if direction.shape != (3,):
        raise ParameterError(name, np.shape(value), "a single direction of shape (3,)")
    return direction


def make_plan(
    f: Any,
    emitters: Emitter | Iterable[Emitter],
    wo: npt.ArrayLike | None,
    *,
    normal: npt.ArrayLike,
    position: npt.ArrayLike,
    method: str,
    rtol: float,
    samples: int | None,
) -> Plan:
    """Check the arguments of ``shade`` and choose a method for each term."""
    if method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    if not 0 < rtol < 1:
        raise ParameterError("rtol", rtol, "in (0, 1)")
    model = as_bsdf(f)
    receiver = Receiver(normal, position)
    local = receiver.to_local(receiver.axis if wo is None else check_direction("wo", wo))
    lights: Sequence[Any] = [emitters] if isinstance(emitters, Emitter) else list(emitters)
    terms: list[Term] = []
    for light in map(check_emitter, lights):
        parts = (DELTA_LIGHT,) if light.delta else (DELTA_LOBES, SMOOTH)
        found = [Term(model, light, receiver, local, part) for part in parts]
        terms += [term for term in found if term.exists]
    rows = [_row(term, method, rtol, samples) for term in terms]
    if method not in ("auto", "sum") and rows and all(row.method == "sum" for row in rows):
        usable = "'auto' or 'sum'"
        if any("closed form" in row.alternatives for row in rows):
            usable += " or 'closed form'"
        raise RadiokitError(
            f"method {method!r} does not apply: nothing is left to integrate here. Use {usable}",
            method=method,
        )
    return Plan(repr(model), rtol, tuple(rows))


def _row(term: Term, method: str, rtol: float, samples: int | None) -> Row:
    """Choose the method of one term; delta lights and delta lobes are exact whatever was asked for."""
    options = _options(term)
    wanted = term.best_sampling if method == "mc" else method
    exact = term.part != SMOOTH or options == ("sum",)
    if method == "auto" or (exact and wanted not in options):
        chosen = options[0]
    elif wanted in options:
        chosen = wanted
    else:
        usable = ", ".join(repr(option) for option in options)
        raise RadiokitError(
            f"method {method!r} does not apply to {_name(term)}: {_why_not(method)}. Use 'auto' or {usable}",
            method=method,
            usable=options,
        )
    others = tuple(option for option in options if option != chosen)
    return Row(_name(term), chosen, _why(term, chosen), _cost(term, chosen, rtol, samples), others, term)


def _options(term: Term) -> tuple[str, ...]:
    """Return the methods that can compute a term, the best first."""
    diffuse = term.f.diffuse_reflectance() is not None and term.wo[2] > 0
    if term.part == DELTA_LOBES:
        return ("sum",)
    if term.part == DELTA_LIGHT:
        return ("sum", "closed form") if diffuse else ("sum",)
    if term.wo[2] <= 0:
        return ("sum",)
    options: tuple[str, ...] = ("quadrature", *_SAMPLED)
    if diffuse and term.light.irradiance_at(term.receiver.origin, term.receiver.axis) is not None:
        return ("closed form", *options)
    return options


def _name(term: Term) -> str:
    return f"{term.light.name}, {term.part}"


def _why(term: Term, method: str) -> str:
    if method == "sum":
        if term.part == DELTA_LIGHT:
            if term.only_delta:
                return "a delta light on delta lobes only is a pair of measure zero, which adds 0"
            return "the light arrives from single directions: the integral is a sum"
        if term.part == DELTA_LOBES:
            return "the material scatters into single directions, where the radiance is looked up"
        return "the viewer is not above the horizon: nothing is reflected there"
    if method == "closed form":
        return "the material is diffuse and the emitter's irradiance has a closed form: ρE/π"
    if method == "quadrature":
        dome = term.light.dome(term.receiver.origin)
        if dome is None:
            return "the product is smooth over the square from which the light is sampled"
        if dome:
            return "the sky's and the surface's horizons bound a lune, in which the product is smooth"
        return "the light fills the hemisphere, where the product is smooth in slope coordinates"
    return {
        "mc-bsdf": "samples of the material suffice for a light that is everywhere",
        "mc-light": "asked for: samples of the light",
        "mis": "samples of material and light, weighted by the balance heuristic, miss neither",
        "qmc": f"low-discrepancy points in place of random ones, put to {term.best_sampling}",
    }[method]


def _why_not(method: str) -> str:
    if method == "sum":
        return "light arrives from a continuum of directions"
    return "it needs a diffuse material and an emitter with a closed-form irradiance"


def _cost(term: Term, method: str, rtol: float, samples: int | None) -> int:
    """Predict the evaluations of the material, in order of magnitude."""
    if method == "sum":
        if term.part == DELTA_LIGHT and not term.only_delta:
            return len(term.light.incident(term.receiver.origin)[0])
        return len(term.lobes) if term.part == DELTA_LOBES else 0
    if method == "closed form":
        return 0
    if method == "quadrature":
        return 4000 if rtol >= 1e-5 else 8000 if rtol >= 1e-7 else 40000
    count = MAX_SAMPLES if samples is None else samples
    if method == "qmc":
        method, count = term.best_sampling, lattice_samples(count)
    return 2 * count if method == "mis" else count
