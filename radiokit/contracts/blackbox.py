"""Black boxes: any callable f(wi, wo) made into a BSDF, whatever its habits."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims, FloatArray
from radiokit.contracts.calling import Mode, describe, invoke, offender, probe, quiet
from radiokit.facts.directions import spherical_to_cartesian
from radiokit.facts.errors import CallableError, ParameterError, RadiokitError
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["BlackBox", "TransmissiveBlackBox", "as_bsdf"]

BELOW = (
    spherical_to_cartesian([0.4, 2.5, 2.2, 2.9], [0.3, 2.0, 4.1, 5.2]),
    spherical_to_cartesian([2.3, 0.7, 2.6, 0.2], [1.2, 0.4, 3.7, 2.8]),
)
"""Pairs across the surface, and one below it."""


@dataclass(frozen=True, kw_only=True)
class BlackBox(BSDF):
    """A callable f(wi, wo) [sr⁻¹] of unknown making, called in the way that it can bear.

    It is handed copies, its results are copied, its prints and warnings are caught and become ``notes``.
    A function that cannot take arrays is called pair by pair. What it raises, or returns in a shape that
    is no value, becomes a ``CallableError`` that names the directions. Without a sampler of its own it is
    sampled over the cosine-weighted hemisphere.
    """

    SOURCE: ClassVar[Source] = Source(authors="the user", year=0, title="A function f(wi, wo)")

    isotropic: ClassVar[bool] = False  # not known: nothing may be assumed

    function: Callable[..., Any]
    label: str
    mode: Mode = "batch"
    pdf_function: Callable[..., Any] | None = None
    sample_function: Callable[..., Any] | None = None
    precision: float = float(np.finfo(float).eps)
    notes: list[str] = field(default_factory=list, compare=False, repr=False)

    @property
    def claims(self) -> Claims | None:
        """None: a stranger's function claims nothing."""
        return None

    @property
    def has_sampler(self) -> bool:
        """Whether it came with a ``sample`` and a ``pdf`` of its own."""
        return self.sample_function is not None and self.pdf_function is not None

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹], of shape (N,) or (N, K)."""
        return self._call(self.function, self.label, wi, wo)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``."""
        if self.pdf_function is None or self.sample_function is None:
            return np.maximum(wi[..., 2], 0.0) / np.pi
        return self._call(self.pdf_function, f"{self.label}.pdf", wi, wo)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` and ``weight = f |cos θi| / pdf``."""
        if self.pdf_function is None or self.sample_function is None:
            radius, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
            wi = np.stack([radius * np.cos(phi), radius * np.sin(phi), np.sqrt(1 - u[:, 0])], axis=-1)
            return wi, np.pi * self.evaluate(wi, wo)
        label = f"{self.label}.sample"
        with quiet(self.notes, label):
            try:
                found = self.sample_function(u.copy(), wo.copy())
                wi, weight = found
                wi, weight = np.array(wi, dtype=float), np.array(weight, dtype=float)
            except (Exception, SystemExit) as error:
                raise CallableError(label, f"raised {describe(error)}") from error
        if wi.shape != (*u.shape[:1], 3) or weight.shape[:1] != u.shape[:1]:
            raise CallableError(label, f"returned shapes {wi.shape} and {weight.shape} for {len(u)} points")
        return wi, weight

    def below_horizon(self) -> str:
        """Return a remark if the function is not 0 below the horizon though light does not pass, or ""."""
        if self.transmissive:
            return ""
        try:
            with quiet([], self.label):
                found = invoke(self.function, self.label, self.mode, *BELOW)
        except (Exception, SystemExit):
            return ""
        if not np.any(np.nan_to_num(found)):
            return ""
        return (
            f"{self.label} is not 0 below the horizon; it is judged as a reflecting surface: "
            "if light passes through, say transmissive=True"
        )

    def symbolic(self) -> Twin:
        """Raise: a black box has no symbolic twin."""
        raise RadiokitError(f"{self.label} is a black box: it has no symbolic twin")

    def _call(self, function: Callable[..., Any], label: str, wi: FloatArray, wo: FloatArray) -> FloatArray:
        wi, wo = np.broadcast_arrays(wi, wo)
        if len(wi) == 0:
            return np.zeros(0)
        with quiet(self.notes, label):
            try:
                return invoke(function, label, self.mode, wi, wo)
            except CallableError:
                raise
            except (Exception, SystemExit) as error:
                row = offender(function, self.mode, wi, wo)
                where = (None, None) if row is None else (wi[row].copy(), wo[row].copy())
                raise CallableError(label, f"raised {describe(error)}", *where) from error

    def __repr__(self) -> str:
        return f"as_bsdf({self.label})"


@dataclass(frozen=True, kw_only=True)
class TransmissiveBlackBox(BlackBox):
    """A black box through which light passes: it is asked for directions on both sides of the surface.

    Its sampler takes three uniform numbers. Without one it is sampled over both cosine-weighted hemispheres,
    each with probability 1/2.
    """

    transmissive: ClassVar[bool] = True
    dimensions: ClassVar[int] = 3

    eta: float = 1.0

    def relative_index(self) -> float:
        """Return η, the index below the surface over that above it, as it was given."""
        return self.eta

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``."""
        if self.has_sampler:
            return super().pdf(wi, wo)
        return np.abs(wi[..., 2]) / (2 * np.pi)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` and ``weight = f |cos θi| / pdf``."""
        if self.has_sampler:
            return super().sample(u, wo)
        radius, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
        z = np.where(u[:, 2] < 0.5, 1.0, -1.0) * np.sqrt(1 - u[:, 0])
        wi = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
        return wi, 2 * np.pi * self.evaluate(wi, wo)


def as_bsdf(
    function: Any,
    *,
    label: str | None = None,
    pdf: Callable[..., Any] | None = None,
    sample: Callable[..., Any] | None = None,
    transmissive: bool | None = None,
    eta: float | None = None,
) -> BSDF:
    """Wrap any callable f(wi, wo) as a BSDF; a BSDF is returned as it is.

    The function may take arrays (N, 3) or one pair (3,) at a time; it may return an array (N,), (N, 1) or
    (N, K), a list, a float, or float32. How it wants to be called is found by trying, and what it did that
    it should not (print, warn, write into its inputs) is kept in ``notes``.

    Parameters
    ----------
    function : callable
        f(wi, wo) [sr⁻¹], without the cosine.
    label : str, optional
        What to call it in reports; its own name by default.
    pdf : callable, optional
        pdf(wi, wo) [sr⁻¹]. A callable attribute ``pdf`` of ``function`` is used when not given.
    sample : callable, optional
        sample(u, wo) -> (wi, weight), for u (N, 2) and wo (N, 3). An attribute likewise. For a function that
        transmits, u is (N, 3).
    transmissive : bool, optional
        Whether light passes through: then the function is asked for directions on both sides of the surface,
        and either may have z < 0. An attribute ``transmissive`` of ``function`` is used when not given.
    eta : float, optional
        η, the refractive index below the surface over that above it, above 0; 1 by default, as for a thin
        sheet. An attribute ``eta`` likewise. It says which reciprocity the function should obey,
        f(wi, wo) / n(wo)² = f(wo, wi) / n(wi)², and where the refracted light is looked for.

    Raises
    ------
    ParameterError
        When ``function`` is not callable, or ``eta`` is no number above 0, or is given for a function that
        does not transmit.
    CallableError
        When it raises, or returns what is no value.

    >>> f = as_bsdf(lambda wi, wo: 0.5 / np.pi, label="half")
    >>> float(f((0.0, 0.0, 1.0), (0.0, 0.6, 0.8)).round(6))
    0.159155
    """
    if isinstance(function, BSDF):
        return function
    if not callable(function):
        raise ParameterError("function", function, "a BSDF or a callable f(wi, wo)")
    label = label or getattr(function, "__name__", None) or type(function).__name__
    notes: list[str] = []
    with quiet(notes, label):
        mode, precision = probe(function, label, notes)
    found: dict[str, Any] = {
        "function": function,
        "label": label,
        "mode": mode,
        "pdf_function": pdf or _method(function, "pdf"),
        "sample_function": sample or _method(function, "sample"),
        "precision": precision,
        "notes": notes,
    }
    if not bool(_fact(function, "transmissive") if transmissive is None else transmissive):
        if eta is not None:
            raise ParameterError("eta", eta, "left out, unless transmissive=True")
        return BlackBox(**found)
    index = _fact(function, "eta") if eta is None else eta
    return TransmissiveBlackBox(**found, eta=1.0 if index is None else _index(index))


def _fact(function: Any, name: str) -> Any:
    """Return what a function says of itself, also when some of its parameters are already filled in."""
    if isinstance(function, functools.partial):
        return function.keywords.get(name, _fact(function.func, name))
    return getattr(function, name, None)


def _index(eta: Any) -> float:
    allowed = "a finite number above 0"
    try:
        index = float(eta)
    except (TypeError, ValueError):
        raise ParameterError("eta", eta, allowed) from None
    if not (np.isfinite(index) and index > 0):
        raise ParameterError("eta", eta, allowed)
    return index


def _method(function: Any, name: str) -> Callable[..., Any] | None:
    found = getattr(function, name, None)
    return found if callable(found) else None
