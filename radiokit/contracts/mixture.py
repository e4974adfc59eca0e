"""Mixture: a weighted sum of BSDFs, such as the diffuse and the specular part of a plastic."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.blackbox import as_bsdf
from radiokit.contracts.bsdf import BSDF, Claims, DeltaLobe, FloatArray
from radiokit.contracts.combining import (
    OWN,
    absorbed,
    adopt,
    described,
    in_delta,
    is_lit,
    merged,
    plus,
    spectrum,
    times,
)
from radiokit.contracts.parameters import Spectrum
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.facts.verdict import TOLERANCE
from radiokit.measure.twin import Twin

__all__ = ["Mixture", "added", "mixture", "multiplied", "scaled"]

_ROUNDING = 1e-12  # of a sum of weights


@dataclass(frozen=True, kw_only=True)
class Mixture(BSDF):
    """Σ w f, of BSDFs f and numbers w ≥ 0: the lecture's mixed reflection.

    Its sampler picks a component by its weight with one more uniform number, the last, and its pdf is the sum
    of theirs: no weight is larger than Σ w times the largest of theirs. A component's delta lobes stay delta
    lobes.

    It claims what follows from the claims of its components. It is reciprocal if all are, not if exactly one
    is not; it conserves energy if all do and the weights' sum is at most 1, and is lossless if all are and
    the sum is 1. Where nothing follows (two that are not reciprocal may make up for each other) it claims
    nothing.

    Parameters
    ----------
    weights : tuple of float or of tuple of float
        At least 0 [1]; a tuple has one number a wavelength.
    components : tuple of BSDF
    """

    name = "mixture"
    isotropic: ClassVar[bool] = True  # what its parts say, for an instance
    SOURCE: ClassVar[Source] = OWN

    weights: tuple[Spectrum, ...]
    components: tuple[BSDF, ...]

    def __post_init__(self) -> None:
        if not self.components or len(self.weights) != len(self.components):
            allowed = f"as many as there are components, {len(self.components)}, and at least one"
            raise ParameterError("weights", self.weights, allowed)
        checked = tuple(spectrum("weights", w) for w in self.weights)
        object.__setattr__(self, "weights", checked)
        lengths = {len(w) for w in checked if isinstance(w, tuple)}
        if len(lengths) > 1:
            raise ParameterError("weights", checked, "of one number of wavelengths")
        adopt(self, self.components, extra=int(len(self.components) > 1))

    @property
    def claims(self) -> Claims | None:
        """What follows from the components' claims, or None."""
        live = [(w, f) for w, f in zip(self.weights, self.components, strict=True) if np.any(w)]
        said = [claim for _, f in live if (claim := f.claims) is not None]
        broken = sum(claim.reciprocity == "no" for claim in said)
        if len(said) < len(live) or broken > 1:
            return None
        total = sum((np.asarray(w) for w, _ in live), start=np.zeros(()))
        alike = len({f.transmissive for _, f in live}) <= 1
        lossless = bool(live) and all(claim.lossless for claim in said)
        if all(claim.conserves for claim in said) and np.all(total <= 1 + TOLERANCE):
            conserves = True
        elif lossless or (len(live) == 1 and not said[0].conserves and np.any(total >= 1)):
            conserves = False
        else:
            return None
        law = "no" if broken else "yes" if self.relative_index() == 1 else "eta-scaled"
        return Claims(
            reciprocity=law,  # type: ignore[arg-type]
            conserves=conserves,
            lossless=lossless and alike and bool(np.all(np.abs(total - 1) <= TOLERANCE)),
            delta=bool(live) and all(claim.delta for claim in said),
        )

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return Σ w f(wi, wo) [sr⁻¹]."""
        wi, wo = np.broadcast_arrays(wi, wo)
        return self._sum([np.asarray(f.evaluate(wi, wo)) for f in self.components], wi, wo)

    def _sum(self, values: Sequence[FloatArray], wi: FloatArray, wo: FloatArray) -> FloatArray:
        total = np.zeros(len(wi))
        for w, f, value in zip(self.weights, self.components, values, strict=True):
            dark = ~is_lit(f, wi, wo)
            value = np.where(dark if value.ndim == 1 else dark[:, None], 0.0, value)
            total = plus(total, times(value, w))
        return total

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return Σ p pdf(wi, wo) [sr⁻¹], with p the chance of each component."""
        wi, wo = np.broadcast_arrays(wi, wo)
        chances = self._chances(wo)
        densities = (np.asarray(f.pdf(wi, wo)) for f in self.components)
        return np.asarray(sum(p * density for p, density in zip(chances.T, densities, strict=True)))

    def _chances(self, wo: FloatArray) -> FloatArray:
        """Return the chance of each component (N, n): its mean weight, 0 from below if no light passes it."""
        share = np.array([float(np.mean(w)) for w in self.weights])
        share = share if share.any() else np.ones(len(share))
        passes = np.array([f.transmissive for f in self.components])
        seen = np.logical_or(passes, wo[:, 2:] >= 0)
        blind = ~(seen * share).any(axis=1)
        chances = share * np.logical_or(seen, blind[:, None])
        return np.asarray(chances / chances.sum(axis=1)[:, None])

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` of a component picked by the last column of ``u``, and the whole f |cosθi| / pdf."""
        if len(self.components) == 1:
            wi, weight = self.components[0].sample(u, wo)
            return wi, times(weight, self.weights[0])
        u, wo = np.asarray(u, dtype=np.float64), np.broadcast_to(wo, (len(u), 3))
        chances = self._chances(wo)
        picked = (u[:, -1:] >= np.cumsum(chances, axis=1)[:, :-1]).sum(axis=1)
        wi = np.empty((len(u), 3))
        apart = np.zeros(len(u), dtype=bool)  # in a delta lobe, or absorbed
        own: FloatArray = np.zeros(len(u))
        for k, f in enumerate(self.components):
            rows = np.flatnonzero(picked == k)
            if not len(rows):
                continue
            to, weight = f.sample(u[rows, : f.dimensions], wo[rows])
            wi[rows] = to
            delta = in_delta(f, to, wo[rows])
            part = times(times(weight, self.weights[k]), delta / chances[rows, k])
            whole = np.zeros((len(u), *part.shape[1:]))
            whole[rows] = part
            own = plus(own, whole)
            apart[rows] = delta | absorbed(f, to, wo[rows], weight)
        safe = np.where(apart[:, None], wo, wi)
        density = self.pdf(safe, wo)
        usable = ~apart & (density > 0)
        value = self.evaluate(safe, wo)
        weight = times(value, np.where(usable, np.abs(safe[:, 2]), 0.0) / np.where(usable, density, 1.0))
        return wi, plus(own, weight)

    def delta_lobes(self, wo: FloatArray) -> tuple[DeltaLobe, ...]:
        """Return the components' delta lobes, weighted; those into the same direction are one."""
        return merged(
            DeltaLobe(lobe.wi, times(lobe.weight, w))
            for w, f in zip(self.weights, self.components, strict=True)
            for lobe in f.delta_lobes(wo)
        )

    @property
    def smooth(self) -> bool:
        """Whether all components are."""
        return all(f.smooth for f in self.components)

    def lobe_width(self) -> float | None:
        """Return the narrowest width of those beside the delta lobes: its nodes see a broad one too."""
        widths = [f.lobe_width() for f in self.components if not ((said := f.claims) and said.delta)]
        known = [width for width in widths if width is not None]
        return None if len(known) < len(widths) else min(known, default=1.0)

    def relative_index(self) -> float:
        """Return η of the components through which light passes."""
        return next((f.relative_index() for f in self.components if f.transmissive), 1.0)

    def diffuse_reflectance(self) -> Any:
        """Return Σ w ρ where all components are diffuse, else None."""
        parts = [f.diffuse_reflectance() for f in self.components]
        if any(part is None for part in parts):
            return None
        total = sum(np.asarray(w) * part for w, part in zip(self.weights, parts, strict=True))
        return float(total) if np.ndim(total) == 0 else np.asarray(total)

    def symbolic(self) -> Twin:
        """Return the sum of the components' twins, whose parameters are numbered as they are.

        Raises
        ------
        RadiokitError
            When a component has none.
        """
        import sympy

        from radiokit.measure.twin import DIRECTION_SYMBOLS

        above = (DIRECTION_SYMBOLS[2] > 0) & (DIRECTION_SYMBOLS[5] > 0)
        total = sympy.S.Zero
        values: dict[Any, Spectrum] = {}
        for number, (w, f) in enumerate(zip(self.weights, self.components, strict=True), start=1):
            twin = f.symbolic()
            names = {
                s: sympy.Symbol(f"{s.name}_{number}", **s.assumptions0) if len(self.components) > 1 else s
                for s in twin.parameters
            }
            part = twin.expression.xreplace(names)
            if self.transmissive and not f.transmissive:
                part = sympy.Piecewise((part, above), (0, True))
            weight = sympy.Symbol(f"w_{number}", nonnegative=True)
            values |= {weight: w} | {names[s]: value for s, value in twin.parameters.items()}
            total += weight * part
        return Twin(total, values)

    def wavelength(self, index: int) -> BSDF:
        """Return the mixture at one wavelength."""
        weights = tuple(w[index] if isinstance(w, tuple) else w for w in self.weights)
        return Mixture(weights=weights, components=tuple(f.wavelength(index) for f in self.components))

    def parameters(self) -> dict[str, Any]:
        """Return weights and components, each as its name and its parameters."""
        return {"weights": list(self.weights), "components": [described(f) for f in self.components]}

    def __repr__(self) -> str:
        texts = (f"({f!r})" if isinstance(f, Mixture) else repr(f) for f in self.components)
        return " + ".join(f"{w!r}*{text}" for w, text in zip(self.weights, texts, strict=True))


def mixture(
    parts: Iterable[tuple[Any, BSDF | Callable[..., Any]]] | None = None,
    *,
    weights: Sequence[Any] | None = None,
    components: Sequence[BSDF | Callable[..., Any]] | None = None,
) -> Mixture:
    """Return a mixture of BSDFs, Σ w f.

    Parameters
    ----------
    parts : iterable of (weight, BSDF or callable)
        Or else ``weights`` and ``components``, of equal length.
    weights : sequence of float or of sequence of float
        Each at least 0, their sum at most 1 [1]; a sequence in place of a number has one a wavelength.
        Sums above 1 can be made, ``f + g``: what scatters each only a part of the light is a fair sum.
    components : sequence of BSDF or callable
        A callable f(wi, wo) [sr⁻¹] is wrapped by ``as_bsdf``.

    Raises
    ------
    ParameterError
        When a weight is below 0 or their sum above 1, or the components do not fit together.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> mixture([(0.25, bsdf("lambert")), (0.5, bsdf("mirror"))])
    0.25*Lambert(reflectance=1.0) + 0.5*Mirror(reflectance=1.0)
    """
    if (parts is None) == (weights is None or components is None):
        raise ParameterError("parts", parts, "pairs of a weight and a BSDF, or else weights= and components=")
    if parts is not None:
        try:
            pairs = [(w, f) for w, f in parts]
        except (TypeError, ValueError):
            raise ParameterError("parts", parts, "pairs of a weight and a BSDF") from None
        weights, components = [w for w, _ in pairs], [f for _, f in pairs]
    assert weights is not None
    assert components is not None
    found = Mixture(weights=tuple(weights), components=tuple(as_bsdf(f) for f in components))
    total = np.max(sum(np.asarray(w) for w in found.weights))
    if total > 1 + _ROUNDING:
        raise ParameterError("weights", list(found.weights), f"at most 1 together, not {total:g}")
    return found


def scaled(f: BSDF | Callable[..., Any], *, factor: Any) -> Mixture:
    """Return factor · f.

    Parameters
    ----------
    f : BSDF or callable
    factor : float or sequence of float
        At least 0 [1]; a sequence has one number a wavelength. Above 1 it may gain energy.

    Raises
    ------
    ParameterError
        When the factor is below 0 or not finite.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> scaled(bsdf("mirror"), factor=0.5).delta_lobes(np.array([[0.0, 0.0, 1.0]]))[0].weight.tolist()
    [0.5]
    """
    return multiplied(as_bsdf(f), spectrum("factor", factor))


def multiplied(f: BSDF, factor: Any) -> Mixture:
    """Return factor · f, a mixture's weights multiplied out: what ``0.5 * f`` means."""
    number = spectrum("factor", factor)
    terms = [(_product(number, w), g) for w, g in _terms(f)]
    return Mixture(weights=tuple(w for w, _ in terms), components=tuple(g for _, g in terms))


def added(one: BSDF, other: BSDF) -> Mixture:
    """Return the sum of two BSDFs: what ``f + g`` means."""
    terms = [*_terms(one), *_terms(other)]
    return Mixture(weights=tuple(w for w, _ in terms), components=tuple(g for _, g in terms))


def _terms(f: BSDF) -> list[tuple[Spectrum, BSDF]]:
    return list(zip(f.weights, f.components, strict=True)) if isinstance(f, Mixture) else [(1.0, f)]


def _product(one: Spectrum, other: Spectrum) -> Spectrum:
    both = np.asarray(one) * np.asarray(other)
    return float(both) if both.ndim == 0 else tuple(both.tolist())
