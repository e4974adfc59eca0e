"""Black boxes: any callable f(wi, wo) made into a BSDF, whatever its habits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import BSDF, Claims, FloatArray
from radiokit.contracts.calling import Mode, describe, invoke, offender, probe, quiet
from radiokit.facts.errors import CallableError, ParameterError, RadiokitError
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["BlackBox", "as_bsdf"]


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


def as_bsdf(
    function: Any,
    *,
    label: str | None = None,
    pdf: Callable[..., Any] | None = None,
    sample: Callable[..., Any] | None = None,
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
        sample(u, wo) -> (wi, weight), for u (N, 2) and wo (N, 3). An attribute likewise.

    Raises
    ------
    ParameterError
        When ``function`` is not callable.
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
    return BlackBox(
        function=function,
        label=label,
        mode=mode,
        pdf_function=pdf or _method(function, "pdf"),
        sample_function=sample or _method(function, "sample"),
        precision=precision,
        notes=notes,
    )


def _method(function: Any, name: str) -> Callable[..., Any] | None:
    found = getattr(function, name, None)
    return found if callable(found) else None
