"""Clamped: a BSDF whose values are cut off, below 0 and above a maximum, to see what that does to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, Claims, DeltaLobe, FloatArray
from radiokit.contracts.combining import OWN, adopt, described, in_delta, times
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["Clamped", "clamped"]


@dataclass(frozen=True, kw_only=True)
class Clamped(BSDF):
    """min(max(f, 0), maximum): what is negative becomes 0, and what is larger becomes the maximum.

    Delta lobes are left as they are: they have a share of the flux, no value that could be cut. It samples as
    f does. A clamped f is as reciprocal as f where the plain law governs, and conserves energy if f does, but
    a lossless f may be lossless no more: then, and where f claims nothing, it claims nothing.

    Parameters
    ----------
    base : BSDF
        f.
    maximum : float
        [sr⁻¹], above 0; infinite to cut off only what is negative.
    """

    name = "clamped"
    isotropic: ClassVar[bool] = True  # what its parts say, for an instance
    SOURCE: ClassVar[Source] = OWN

    base: BSDF
    maximum: float

    def __post_init__(self) -> None:
        try:
            limit = float(self.maximum)
        except (TypeError, ValueError):
            limit = np.nan
        if not limit > 0:
            raise ParameterError("maximum", self.maximum, "a number above 0, or inf")
        object.__setattr__(self, "maximum", limit)
        adopt(self, (self.base,))

    @property
    def claims(self) -> Claims | None:
        """What follows from the claims of f, or None."""
        said = self.base.claims
        if said is None or said.delta or not np.isfinite(self.maximum):
            return said
        rho = self.base.diffuse_reflectance()
        if rho is not None and np.max(rho) / np.pi <= self.maximum:
            return said
        if said.reciprocity != "yes" or not said.conserves or said.lossless:
            return None
        return said

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹] within the limits."""
        return np.asarray(np.clip(self.base.evaluate(wi, wo), 0.0, self.maximum))

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] with which f is sampled."""
        return self.base.pdf(wi, wo)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return f's ``wi``, and its weight in the ratio in which its value is cut."""
        wo = np.broadcast_to(wo, (len(u), 3))
        wi, weight = self.base.sample(u, wo)
        value = np.asarray(self.base.evaluate(wi, wo))
        cut = np.clip(value, 0.0, self.maximum)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(value > 0, np.where(np.isinf(value), 0.0, cut / value), 0.0)
            scale = np.abs(wi[:, 2]) / np.asarray(self.base.pdf(wi, wo))
        kept = np.where(np.isinf(weight), 0.0, weight)
        new = times(kept, ratio) + np.where(np.isinf(value), times(cut, np.nan_to_num(scale)), 0.0)
        delta = in_delta(self.base, wi, wo)
        return wi, np.where(delta if new.ndim == 1 else delta[:, None], weight, new)

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return f's delta lobes as they are."""
        return self.base.delta_lobes(wo)

    @property
    def smooth(self) -> bool:
        """Whether nothing is cut off above, and f is."""
        return self.base.smooth and not np.isfinite(self.maximum)

    def lobe_width(self) -> float | None:
        """Return f's."""
        return self.base.lobe_width()

    def relative_index(self) -> float:
        """Return f's η."""
        return self.base.relative_index()

    def diffuse_reflectance(self) -> Any:
        """Return min(ρ, π · maximum) for a diffuse f, else None."""
        rho = self.base.diffuse_reflectance()
        return None if rho is None else np.minimum(rho, np.pi * self.maximum)[()]

    def symbolic(self) -> Twin:
        """Return min(max(f, 0), maximum) of f's twin.

        Raises
        ------
        RadiokitError
            When f has none, or has delta lobes, which are not clamped.
        """
        import sympy

        twin = self.base.symbolic()
        if twin.expression.has(sympy.DiracDelta):
            raise RadiokitError(f"{self!r} has no symbolic twin: its delta lobes are not clamped")
        limit = sympy.Symbol("f_max", positive=True)
        if not np.isfinite(self.maximum):
            return Twin(sympy.Max(twin.expression, 0), twin.parameters)
        whole = sympy.Min(sympy.Max(twin.expression, 0), limit)
        return Twin(whole, {**twin.parameters, limit: self.maximum})

    def wavelength(self, index: int) -> BSDF:
        """Return the clamped f at one wavelength."""
        return Clamped(base=self.base.wavelength(index), maximum=self.maximum)

    def parameters(self) -> dict[str, Any]:
        """Return the maximum, and f as its name and its parameters."""
        return {"base": described(self.base), "maximum": self.maximum}

    def __repr__(self) -> str:
        return f"clamped({self.base!r}, maximum={self.maximum!r})"


def clamped(f: BSDF | Callable[..., Any], *, maximum: float = np.inf) -> Clamped:
    """Return f with values below 0 made 0, and values above the maximum made the maximum.

    Parameters
    ----------
    f : BSDF or callable
    maximum : float
        [sr⁻¹], above 0; without it only what is negative is cut off.

    Raises
    ------
    ParameterError
        When the maximum is not above 0.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> f = clamped(bsdf("phong", exponent=100.0), maximum=10.0)
    >>> float(f((0, 0, 1), (0, 0, 1))), float(f((0, 0.6, 0.8), (0, 0, 1))) > 0
    (10.0, True)
    """
    return Clamped(base=as_bsdf(f), maximum=maximum)
