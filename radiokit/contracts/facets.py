"""Facets: what the models of rough mirrors share, whatever the law of their slopes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.bsdf import FloatArray
from radiokit.contracts.parameters import Spectrum, choice, parameter
from radiokit.contracts.scalar import Kernels, ScalarBSDF
from radiokit.facts.errors import ParameterError
from radiokit.measure.twin import Twin
from radiokit.physics import fresnel
from radiokit.physics.microfacet import (
    correlated_symbolic,
    cosine_symbolic,
    groove_symbolic,
    separable_symbolic,
)
from radiokit.physics.reflection import (
    Law,
    Reflection,
    metal_share,
    reflecting,
    schlick_share,
    shares,
    tinted,
)

__all__ = ["FacetBSDF", "Facets", "RoughMirror"]

WIDTH = "[1e-4, 1]"
"""The widths for which kernels and samplers are tested."""

DEFAULT_WIDTH = 0.3


@dataclass(frozen=True)
class Facets:
    """The facets of a rough mirror, for the judges: a law of slopes, two widths, and a masking."""

    law: Law
    hiding: str
    widths: tuple[float, float]

    def density(self, h: FloatArray) -> FloatArray:
        """Return D(h) [sr⁻¹] (N,)."""
        with np.errstate(all="ignore"):
            return self.law.density(*h.T, *self.widths)

    def masking(self, w: FloatArray, h: FloatArray) -> FloatArray:
        """Return G₁(w, h) [1] (N,)."""
        return self._shares(w, w, h)[0]

    def shadowing(self, wi: FloatArray, wo: FloatArray, h: FloatArray) -> FloatArray:
        """Return G₂(wi, wo, h) [1] (N,)."""
        return self._shares(wi, wo, h)[1]

    def _shares(self, wi: FloatArray, wo: FloatArray, h: FloatArray) -> tuple[FloatArray, FloatArray]:
        with np.errstate(all="ignore"):
            return shares(self.law, self.hiding, wi.T, wo.T, h.T, *self.widths)


@dataclass(frozen=True, kw_only=True)
class FacetBSDF(ScalarBSDF):
    """A rough surface of tiny mirrors: metal by ``eta`` and ``k``, Schlick's by ``f0``, or perfect.

    A subclass gives its ``LAW``; it is in V-grooves and of one width unless it is a ``RoughMirror``.
    """

    kind = "microfacet"
    LAW: ClassVar[Law]

    alpha: float | None = parameter(WIDTH, "1", "width of the slope distribution", default=None)
    eta: Spectrum | None = parameter(
        "(0, inf)", "1", "real part of the relative index", spectral=True, default=None
    )
    k: Spectrum | None = parameter("[0, inf)", "1", "extinction", spectral=True, default=None)
    f0: Spectrum | None = parameter(
        "[0, 1]", "1", "reflectance of a facet at normal incidence", spectral=True, default=None
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.eta is None) != (self.k is None):
            alone, other = ("eta", "k") if self.k is None else ("k", "eta")
            raise ParameterError(other, None, f"given, as {alone} is: an index has both parts")
        if self.eta is not None and self.f0 is not None:
            raise ParameterError(
                "f0", self.f0, "left out, as eta and k are given: either says what facets do"
            )
        if self.alpha is None and not self._has_widths():
            object.__setattr__(self, "alpha", DEFAULT_WIDTH)

    def _has_widths(self) -> bool:
        """Whether there are two widths in place of ``alpha``."""
        return False

    @property
    def hiding(self) -> str:
        """How facets hide one another: one of ``physics.reflection.MASKINGS``."""
        return "v-groove"

    @property
    def widths(self) -> tuple[float, float]:
        """The widths along x and y."""
        assert self.alpha is not None
        return self.alpha, self.alpha

    @property
    def law(self) -> Law:
        """The law of the slopes, for these parameters."""
        return self.LAW

    @property
    def dimensions(self) -> int:  # type: ignore[override]
        """How many uniform numbers ``sample`` takes: a V-groove has two facets to choose from."""
        return 3 if self.hiding == "v-groove" else 2

    @property
    def smooth(self) -> bool:
        """Whether f is: a V-groove's masking has kinks, and so has F where total reflection begins."""
        if self.hiding == "v-groove":
            return False
        if self.eta is None or self.k is None:
            return True
        return bool(np.all((np.asarray(self.eta) >= 1.0) | (np.asarray(self.k) >= 0.1)))

    def lobe_width(self) -> float:
        """Return the geometric mean of the widths."""
        return float(np.sqrt(self.widths[0] * self.widths[1]))

    def microfacets(self) -> Facets:
        """Return the facets, for the judges."""
        return Facets(self.law, self.hiding, self.widths)

    def reflection(self) -> tuple[Reflection, tuple[Any, ...]]:
        """Return the kernels of F D G₂ / (4 cosθi cosθo), and their constants."""
        if self.eta is not None and self.k is not None:
            index = fresnel.clip_index(self.eta, self.k)
            return tinted(self.law, self.hiding, metal_share), (*self.widths, *index)
        if self.f0 is not None:
            f0 = np.asarray(self.f0)[()]
            return tinted(self.law, self.hiding, schlick_share), (*self.widths, f0)
        return reflecting(self.law, self.hiding), self.widths

    def reflection_kernels(self) -> Kernels:
        """Return the same as a model's kernels."""
        found, constants = self.reflection()
        return Kernels(found.value, found.density, found.sample, constants)

    def reflectance(self, cosine: Any) -> Any:
        """Return F [1] for the cosine (...) of the angle at a facet; (K, ...) for K wavelengths."""
        index: tuple[Any, ...] = ()
        if self.eta is not None and self.k is not None:
            index = fresnel.clip_index(self.eta, self.k)
        elif self.f0 is not None:
            index = (self.f0,)
        else:
            return np.ones_like(cosine)
        form = fresnel.schlick_kernel if len(index) == 1 else fresnel.conductor_kernel
        shape = (-1, *(1,) * np.ndim(cosine))
        with np.errstate(all="ignore"):
            return form(cosine, *(np.reshape(i, shape) if np.ndim(i) else i for i in index))

    def reflectance_symbolic(self, cosine: Any) -> tuple[Any, dict[Any, Any]]:
        """Return F as SymPy for the cosine of the angle at a facet, and its parameters' values."""
        import sympy

        if self.eta is not None and self.k is not None:
            eta, k = sympy.symbols("eta k", positive=True)
            return fresnel.conductor_symbolic(cosine, eta, k), {eta: self.eta, k: self.k}
        if self.f0 is not None:
            f0 = sympy.Symbol("F_0", nonnegative=True)
            return fresnel.schlick_symbolic(cosine, f0), {f0: self.f0}
        return sympy.S.One, {}

    def reflection_twin(self) -> Twin:
        """Return F D G₂ / (4 cosθi cosθo) from the papers' formulas; with one symbol α for one width."""
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        alpha, alpha_x, alpha_y = sympy.symbols("alpha alpha_x alpha_y", positive=True)
        x, y = self.widths
        widths = (alpha, alpha) if x == y else (alpha_x, alpha_y)
        wi, wo = DIRECTION_SYMBOLS[:3], DIRECTION_SYMBOLS[3:]
        half = [i + o for i, o in zip(wi, wo, strict=True)]
        share, values = self.reflectance_symbolic(cosine_symbolic(wi, half))
        if self.hiding == "v-groove":
            hidden = groove_symbolic(half, wi, wo)
        else:
            form = separable_symbolic if self.hiding == "separable" else correlated_symbolic
            hidden = form(*(self.law.lambda_symbolic(w, *widths) for w in (wi, wo)))
        expression = share * self.law.d_symbolic(half, *widths) * hidden / (4 * wi[2] * wo[2])
        return Twin(expression, dict(zip(widths, (x, y), strict=True)) | values)


@dataclass(frozen=True, kw_only=True)
class RoughMirror(FacetBSDF):
    """Facets of one width, ``alpha``, or of two, ``alpha_x`` and ``alpha_y``, with Smith's masking."""

    alpha_x: float | None = parameter(WIDTH, "1", "width of the slopes along x", default=None)
    alpha_y: float | None = parameter(WIDTH, "1", "width of the slopes along y", default=None)
    masking: str = choice("height-correlated", "separable", meaning="how facets hide one another")

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.alpha_x is None) != (self.alpha_y is None):
            alone, other = ("alpha_x", "alpha_y") if self.alpha_y is None else ("alpha_y", "alpha_x")
            raise ParameterError(other, None, f"given, as {alone} is: or give alpha, the width both ways")
        if self.alpha is not None and self.alpha_x is not None:
            raise ParameterError("alpha", self.alpha, "left out, as alpha_x and alpha_y are given")

    def _has_widths(self) -> bool:
        return self.alpha_x is not None or self.alpha_y is not None

    @property
    def hiding(self) -> str:
        """How facets hide one another, as ``masking`` says."""
        return self.masking

    @property
    def widths(self) -> tuple[float, float]:
        """The widths along x and y."""
        if self.alpha_x is None or self.alpha_y is None:
            return super().widths
        return self.alpha_x, self.alpha_y

    @property
    def isotropic(self) -> bool:
        """Whether the widths are the same."""
        return self.widths[0] == self.widths[1]
