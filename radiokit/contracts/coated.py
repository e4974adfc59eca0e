"""Coated: a base below a coat, which lets through to the base what it does not reflect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, Claims, DeltaLobe, FloatArray
from radiokit.contracts.coatalbedo import CoatAlbedo, coat_albedo
from radiokit.contracts.combining import absorbed, adopt, described, in_delta, is_lit, merged, plus, times
from radiokit.facts.errors import ParameterError, RadiokitError
from radiokit.facts.source import Source
from radiokit.facts.verdict import TOLERANCE
from radiokit.measure.twin import Twin

__all__ = ["Coated", "Scaling", "coated"]

Scaling = Literal["product", "max"]


@dataclass(frozen=True, kw_only=True)
class Coated(BSDF):
    """f = f_coat + s(wi, wo) f_base, where s is what the coat lets in and out again.

    With E the coat's directional albedo, light from ``wo`` is scattered by E(wo) + ∫ s f_base cosθi dωi in
    all. Reciprocity asks for an s that is the same both ways, energy for an integral of at most 1 − E(wo).

    ``product`` is Kelemen and Szirmay-Kalos' s = (1 − E(wi)) (1 − E(wo)) / (1 − E_avg). Over f_base = ρ/π the
    integral is ρ (1 − E(wo)), since E_avg = ∫ E cosθ dω / π: nothing is lost for ρ = 1. Over any other base
    it may gain: below glass (η = 1.5) a mirror at normal incidence has 0.96² / 0.908 + 0.04 = 1.0547.

    ``max`` is s = 1 − max(E(wi), E(wo)). Over a base that conserves energy the integral is at most 1 − E(wo),
    for s is nowhere larger; and no s that is the same both ways and bounded by 1 − E(wo) is larger anywhere.
    Over a mirror nothing is lost, over a white diffuser something is.

    Of a coat that transmits only what it reflects counts. Light is not bent on its way to the base.

    Parameters
    ----------
    base : BSDF
        Not transmissive.
    coat : BSDF
        Isotropic, and lossless but for what it lets through: what it absorbs would go to the base.
    scaling : {"product", "max"}
    """

    name = "coated"
    isotropic: ClassVar[bool] = True  # what its parts say, for an instance
    SOURCE: ClassVar[Source] = Source(
        authors="Kelemen, Szirmay-Kalos",
        year=2001,
        title="A Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling. "
        "Eurographics Short Presentations",
        equation="the matte component, with the albedo of the specular one",
    )

    base: BSDF
    coat: BSDF
    scaling: Scaling

    def __post_init__(self) -> None:
        if self.scaling not in ("product", "max"):
            raise ParameterError("scaling", self.scaling, "'product' or 'max'")
        if self.base.transmissive:
            raise ParameterError("base", self.base, "a surface through which no light passes")
        adopt(self, (self.base, self.coat), extra=1)
        object.__setattr__(self, "transmissive", False)
        object.__setattr__(self, "albedo", coat_albedo(self.coat))

    albedo: ClassVar[CoatAlbedo]
    """E of the coat, with the bound of its error."""

    @property
    def claims(self) -> Claims | None:
        """What follows from the claims of base and coat, or None."""
        base, coat = self.base.claims, self.coat.claims
        if base is None or coat is None or not (base.conserves and coat.conserves):
            return None
        broken = [said.reciprocity == "no" for said in (base, coat)]
        if all(broken) or (self.scaling == "product" and self.base.diffuse_reflectance() is None):
            return None
        return Claims(
            reciprocity="no" if any(broken) else "yes",
            conserves=True,
            lossless=self._lossless(base),
            delta=base.delta and coat.delta,
        )

    def _lossless(self, base: Claims) -> bool:
        if self.albedo.bound > 0.1 * TOLERANCE:
            return False
        z = np.linspace(0.01, 1.0, 100)
        seen = self.albedo(np.stack([np.sqrt(1 - z * z), 0 * z, z], axis=-1))
        if np.all(seen >= 1 - TOLERANCE):
            return True
        level = bool(np.ptp(seen, axis=0).max() <= TOLERANCE)  # then s is 1 − E for every pair
        same_angle = base.delta  # a mirror's, or back: then s is, at the only pair
        return base.lossless and (self.scaling == "product" or level or same_angle)

    def _let_in(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return s (N,) or (N, K)."""
        one, other = 1.0 - self.albedo(wi), 1.0 - self.albedo(wo)
        if self.scaling == "max":
            return np.minimum(one, other)
        rest = 1.0 - np.asarray(self.albedo.average)
        return np.asarray(np.where(rest > 0, one * other / np.where(rest > 0, rest, 1.0), 0.0))

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f_coat + s f_base [sr⁻¹]."""
        wi, wo = np.broadcast_arrays(wi, wo)
        lit = is_lit(self, wi, wo)
        under = times(self.base.evaluate(wi, wo), self._let_in(wi, wo))
        total = plus(np.asarray(self.coat.evaluate(wi, wo)), under)
        return np.where(lit if total.ndim == 1 else lit[:, None], total, 0.0)

    def _chance(self, wo: FloatArray) -> FloatArray:
        """Return how often the coat is sampled: by its albedo; half of the time if its samples also pass."""
        albedo = self.albedo(wo)
        mean = albedo if albedo.ndim == 1 else albedo.mean(axis=1)
        return np.full(len(wo), 0.5) if self.coat.transmissive and not self.albedo.exact else mean

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return p pdf_coat + (1 − p) pdf_base [sr⁻¹]."""
        wi, wo = np.broadcast_arrays(wi, wo)
        p = self._chance(wo)
        total = p * np.asarray(self.coat.pdf(wi, wo)) + (1 - p) * np.asarray(self.base.pdf(wi, wo))
        return np.where(is_lit(self, wi, wo), total, 0.0)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` of coat or base, picked by the last column of ``u``, and the whole f cosθi / pdf."""
        u, wo = np.asarray(u, dtype=np.float64), np.broadcast_to(wo, (len(u), 3))
        p = self._chance(wo)
        top = u[:, -1] < p
        wi = wo * [-1.0, -1.0, 1.0]
        own: FloatArray = np.zeros(len(u))
        apart = top & self.albedo.exact  # in a delta lobe, or absorbed
        if self.albedo.exact:
            own = times(self.albedo(wo), np.where(top & (wo[:, 2] > 0), 1.0 / np.where(top, p, 1.0), 0.0))
        for f, rows in ((self.coat, np.flatnonzero(top & ~apart)), (self.base, np.flatnonzero(~top))):
            if not len(rows):
                continue
            to, weight = f.sample(u[rows, : f.dimensions], wo[rows])
            delta = in_delta(f, to, wo[rows])
            wi[rows] = to
            apart[rows] = delta | absorbed(f, to, wo[rows], weight) | (to[:, 2] <= 0)
            chance = p[rows] if f is self.coat else 1 - p[rows]
            part = times(weight, np.where(delta & (to[:, 2] > 0), 1.0, 0.0) / chance)
            if f is self.base:
                part = times(part, self._let_in(np.where(delta[:, None], to, wo[rows]), wo[rows]))
            whole = np.zeros((len(u), *part.shape[1:]))
            whole[rows] = part
            own = plus(own, whole)
        safe = np.where(apart[:, None], wo, wi)
        density = self.pdf(safe, wo)
        usable = ~apart & (density > 0)
        scale = np.where(usable, np.abs(safe[:, 2]), 0.0) / np.where(usable, density, 1.0)
        return wi, plus(own, times(self.evaluate(safe, wo), scale))

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return the coat's mirror lobe, and the base's delta lobes times s."""
        found = []
        for lobe in self.coat.delta_lobes(wo):
            up = ((lobe.wi[:, 2] > 0) & (wo[:, 2] > 0)).astype(float)
            if up.any():
                found.append(DeltaLobe(lobe.wi, times(lobe.weight, up)))
        for lobe in self.base.delta_lobes(wo):
            found.append(DeltaLobe(lobe.wi, times(lobe.weight, self._let_in(lobe.wi, wo))))
        return merged(found)

    def lobe_width(self) -> float | None:
        """Return the narrower width of those beside the delta lobes."""
        parts = [f for f in (self.coat, self.base) if not ((said := f.claims) and said.delta)]
        widths = [f.lobe_width() for f in parts]
        known = [width for width in widths if width is not None]
        return None if len(known) < len(widths) else min(known, default=1.0)

    def symbolic(self) -> Twin:
        """Raise: E is an integral, and has no closed form in general."""
        raise RadiokitError(f"{self!r} has no symbolic twin: the coat's albedo is an integral")

    def wavelength(self, index: int) -> BSDF:
        """Return the coated base at one wavelength."""
        return Coated(
            base=self.base.wavelength(index), coat=self.coat.wavelength(index), scaling=self.scaling
        )

    def parameters(self) -> dict[str, Any]:
        """Return base and coat, each as its name and its parameters, and the scaling."""
        return {"base": described(self.base), "coat": described(self.coat), "scaling": self.scaling}

    def __repr__(self) -> str:
        return f"coated({self.base!r}, coat={self.coat!r}, scaling={self.scaling!r})"


def coated(base: BSDF | Callable[..., Any], *, coat: BSDF, scaling: Scaling | None = None) -> Coated:
    """Return a base below a coat, reciprocal, and without gain over any base that has none.

    Parameters
    ----------
    base : BSDF or callable
        A surface through which no light passes.
    coat : BSDF
        Isotropic: ``dielectric`` for varnish, a rough one for satin. Of what transmits only the reflection
        counts.
    scaling : {"product", "max"}, optional
        How the base is dimmed, see ``Coated``; ``product`` for a diffuse base and ``max`` for any other by
        default, which is where each gains nothing.

    Raises
    ------
    ParameterError
        When light passes through the base, or the coat is no BSDF or not isotropic.

    >>> from radiokit.contracts.albedo import albedo
    >>> from radiokit.contracts.bsdf import bsdf
    >>> varnished = coated(bsdf("lambert"), coat=bsdf("dielectric", eta=1.5))
    >>> round(float(albedo(varnished, (0.0, 0.6, 0.8))), 9)
    1.0
    """
    under = as_bsdf(base)
    if not isinstance(coat, BSDF):
        raise ParameterError("coat", coat, "a BSDF, such as bsdf('dielectric', eta=1.5)")
    chosen: Scaling = "max" if under.diffuse_reflectance() is None else "product"
    return Coated(base=under, coat=coat, scaling=scaling or chosen)
