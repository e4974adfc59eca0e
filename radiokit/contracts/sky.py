"""Skies: half-spaces whose radiance is a parabola in the cosine of the zenith angle."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.spectral import stacked
from radiokit.contracts.vectors import Triple
from radiokit.facts.directions import angle_between, frame, to_world
from radiokit.facts.estimate import Estimate, rounding
from radiokit.measure.cancelling import sine_minus_x_cosine
from radiokit.measure.exact import rational
from radiokit.physics.eclipse import Dome

__all__ = ["CosineSky"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_HALVINGS = 54


class CosineSky(Emitter):
    """A sky of radiance L = b₀(1 − c)² + 2b₁c(1 − c) + b₂c², c the cosine of the angle from the zenith.

    A subclass has a ``normal``, the zenith, and gives b₀, b₁, b₂. None is negative, so neither is L.
    """

    normal: Triple

    @property
    @abstractmethod
    def bernstein(self) -> tuple[Any, Any, Any]:
        """b₀, b₁ and b₂ [W m⁻² sr⁻¹], each at least 0: floats, or arrays (K,) for K wavelengths."""

    @property
    def _sampled(self) -> tuple[float, float, float]:
        """The coefficients by which directions are sampled: the means over the wavelengths."""
        low, middle, high = (float(np.mean(b)) for b in self.bernstein)
        return low, middle, high

    @staticmethod
    def _law(cosine: FloatArray, bernstein: tuple[Any, Any, Any]) -> FloatArray:
        low, middle, high = bernstein
        cosine = cosine[:, None] if np.ndim(low) else cosine
        rest = 1.0 - cosine
        value: FloatArray = (low * rest + 2.0 * middle * cosine) * rest + high * cosine * cosine
        return value

    def dome(self, position: FloatArray) -> tuple[FloatArray, ...]:
        """Return the half-space that the sky fills."""
        return (np.array(self.normal),)

    def silhouette(self, position: FloatArray) -> Silhouette:
        """Return the half-space that the sky fills."""
        return Silhouette(Dome((rational(self.normal),)), None)

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L for directions (N, 3) in the sky, 0 for those below its horizon."""
        return self._above(direction, self.bernstein)

    def _above(self, direction: FloatArray, bernstein: tuple[Any, Any, Any]) -> FloatArray:
        cosine = direction @ np.array(self.normal)
        radiance = self._law(np.clip(cosine, 0.0, 1.0), bernstein)
        radiance[cosine <= 0] = 0.0
        return radiance

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3) of density in proportion to L [sr⁻¹].

        L counts by its mean over the wavelengths.
        """
        cosine = self._quantile(u[:, 0])
        sine = np.sqrt((1.0 - cosine) * (1.0 + cosine))
        turn = 2.0 * np.pi * u[:, 1]
        local = np.stack((sine * np.cos(turn), sine * np.sin(turn), cosine), axis=-1)
        directions = to_world(frame(self.normal), local)
        return directions, self.pdf(directions, position)

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L over its integral [sr⁻¹]; 1/2π in a sky that is all dark, and 0 below the horizon."""
        total = math.fsum(self._sampled) / 3
        if total > 0:
            return self._above(direction, self._sampled) / (2 * math.pi * total)
        return np.where(direction @ np.array(self.normal) > 0, 1 / (2 * math.pi), 0.0)

    def _quantile(self, u: FloatArray) -> FloatArray:
        """Return the cosine up to which the share ``u`` of ∫ L dω lies."""
        low, middle, high = self._sampled
        largest = max(low, middle, high)
        if largest == 0:
            return u
        low, middle, high = low / largest, middle / largest, high / largest
        bend, slope = low - 2 * middle + high, 2 * (middle - low)
        if abs(bend) <= 4 * _EPS:
            mass = u * (low + high) / 2
            root = low + np.sqrt(np.maximum(low * low + 2 * slope * mass, 0.0))
            return np.minimum(np.divide(2 * mass, root, out=np.zeros_like(u), where=root > 0), 1.0)
        # The integral of L is a cubic that rises all the way: halve the interval that holds the root.
        mass = u * ((low + middle + high) / 3)
        cosine = np.zeros_like(u)
        for k in range(1, _HALVINGS):
            middle_of = cosine + 0.5**k
            below = middle_of * (low + middle_of * (slope / 2 + middle_of * bend / 3))
            cosine = np.where(below <= mass, middle_of, cosine)
        return cosine + 0.5**_HALVINGS

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return 2π sr."""
        return rounding(2 * math.pi, ulps=1)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        r"""Return E of a receiver tilted by β from the zenith, for any β.

        Sky and receiver share a lune of angle γ = π − β. In longitude and latitude about its axis the moments
        ∫ cosᵏθ_z cosθ dω are π cos²(β/2), ⅔(sinγ − γ cosγ) and ½π cos⁴(β/2) for k = 0, 1, 2, with the
        coefficients of L in powers of cosθ_z.
        """
        if self.wavelengths is not None:
            each = zip(*self.bernstein, strict=True)
            return stacked([self._received(tuple(map(float, b)), normal) for b in each])
        return self._received(self.bernstein, normal)

    def _received(self, bernstein: tuple[Any, ...], normal: FloatArray) -> Estimate:
        low, middle, high = bernstein
        slope, bend = 2 * (middle - low), low - 2 * middle + high
        zenith = np.array(self.normal)
        half = math.hypot(*(zenith + normal)) / 2  # cos(β/2)
        opening = float(angle_between(normal, -zenith))
        square: float = half * half
        wedge: Any = float(sine_minus_x_cosine(opening))
        terms = (math.pi * low * square, 2 / 3 * slope * wedge, math.pi / 2 * bend * square * square)
        # half and opening are off by some eps each, of 1 at most where they are small
        size = math.fsum(map(abs, terms)) + 4 * (middle + low + high) * (square + 4 * _EPS * half)
        return Estimate(
            max(0.0, math.fsum(terms)),
            16 * _EPS * size + 4 * _EPS * math.pi * low * half,
            "rounding",
            method="closed form",
        )
