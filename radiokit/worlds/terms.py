"""Terms: one light on one material, computed by sum, closed form, quadrature or Monte Carlo."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.contracts.bsdf import BSDF
from radiokit.contracts.emitter import Emitter
from radiokit.contracts.spectral import check_wavelengths, times
from radiokit.facts.errors import NonFiniteError, RadiokitError
from radiokit.facts.estimate import Estimate
from radiokit.worlds.scene import Receiver

__all__ = ["DELTA_LIGHT", "DELTA_LOBES", "MAX_SAMPLES", "SMOOTH", "Part", "Term"]

FloatArray = npt.NDArray[np.float64]
Part = Literal["delta light", "delta lobes", "smooth"]

DELTA_LIGHT: Part = "delta light"
DELTA_LOBES: Part = "delta lobes"
SMOOTH: Part = "smooth"

MAX_SAMPLES = 1 << 20
"""Samples drawn at most when only a tolerance is given."""

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Term:
    """The light of one emitter that one material sends towards ``wo`` (3,), in the receiver's frame.

    ``part`` says which product it is: a delta light's, that of a light with the material's delta lobes, or
    that of a light with the rest of the material.
    """

    f: BSDF
    light: Emitter
    receiver: Receiver
    wo: FloatArray
    part: Part

    @cached_property
    def lobes(self) -> FloatArray:
        """The directions (K, 3) of the material's delta lobes."""
        found = [lobe.wi for lobe in self.f.delta_lobes(self.wo[None, :])]
        return np.concatenate(found) if found else np.zeros((0, 3))

    @cached_property
    def only_delta(self) -> bool:
        """Whether the material has nothing but delta lobes."""
        claims: Any = self.f.claims  # None for a stranger's function
        return claims is not None and bool(claims.delta)

    @property
    def exists(self) -> bool:
        """Whether the light and the material make such a product at all."""
        if self.part == DELTA_LOBES:
            return self.only_delta or len(self.lobes) > 0
        return self.part == DELTA_LIGHT or not self.only_delta

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of one value: () for one wavelength, (K,) for K of them, of material and light."""
        up = np.array([[0.0, 0.0, 1.0]])
        value = self.f.evaluate(up, self.wo[None, :])
        count = check_wavelengths(value.shape[1] if np.ndim(value) > 1 else None, self.light.wavelengths)
        return () if count is None else (count,)

    def zero(self, note: str = "") -> Estimate:
        """Return 0, exactly."""
        nothing: Any = np.zeros(self.shape) if self.shape else 0.0
        return Estimate(nothing, nothing, "rounding", method="sum", note=note)

    @cached_property
    def arriving(self) -> Estimate | None:
        """The light's closed-form irradiance [W m⁻²], or None where there is none."""
        return self.light.irradiance_at(self.receiver.origin, self.receiver.axis)

    def add_up(self) -> Estimate:
        """Sum over the directions of a delta light, or over the delta lobes of the material."""
        start = time.perf_counter()
        if self.part == DELTA_LOBES:
            total: Any = 0.0
            lobes = self.f.delta_lobes(self.wo[None, :])
            for lobe in lobes:
                towards = self.receiver.to_world(lobe.wi)
                radiance = self.light.radiance_from(towards, self.receiver.origin)
                total = total + times(lobe.weight, radiance)[0]
            seconds = time.perf_counter() - start
            return Estimate(total, 8 * _EPS * np.abs(total), "rounding", len(lobes), seconds, "sum")
        if self.only_delta:
            return self.zero("a delta light on a delta lobe is a pair of measure zero")
        directions, normal_irradiance = self.light.incident(self.receiver.origin)
        wi = self.receiver.to_local(directions)
        above = wi[:, 2] > 0
        if not np.any(above):
            return self.zero("the light is below the horizon")
        wi, arriving = wi[above], normal_irradiance[above]
        values = self.f.evaluate(wi, np.broadcast_to(self.wo, wi.shape))
        if not np.all(np.isfinite(values)):
            row = int(np.argwhere(~np.isfinite(values))[0][0])
            where = f"wi = {tuple(wi[row].tolist())}, wo = {tuple(self.wo.tolist())}"
            raise NonFiniteError(f"{self.f!r} is {values[row]} at {where}", value=values[row], at=wi[row])
        total = times(values, times(arriving, wi[:, 2])).sum(axis=0)
        # A direction is known to a few eps, the cosine to that of 1, and a narrow lobe is steep.
        width = self.f.lobe_width() or 1e-2
        precision = getattr(self.f, "precision", _EPS)
        steep = 16 * precision * (1 + 1 / width)
        error = times(np.abs(values), times(arriving, 8 * _EPS + steep * wi[:, 2])).sum(axis=0)
        seconds = time.perf_counter() - start
        return Estimate(total[()], error[()], "rounding", len(wi), seconds, "sum")

    def closed_form(self) -> Estimate:
        """Return ρE/π of a diffuse material under an emitter with a closed-form irradiance."""
        start = time.perf_counter()
        reflectance = self.f.diffuse_reflectance()
        if reflectance is None or self.arriving is None:
            raise RadiokitError("there is no closed form for this term")
        found = self.arriving.scaled(reflectance / np.pi)
        error = found.error + 4 * _EPS * np.abs(found.value)
        return replace(found, error=error, seconds=time.perf_counter() - start, method="closed form")

    def reflected(self, wi: FloatArray) -> FloatArray:
        """Return f L cosθ [W m⁻² sr⁻²] for local directions ``wi`` (N, 3)."""
        radiance = self.light.radiance_from(self.receiver.to_world(wi), self.receiver.origin)
        values = self.f.evaluate(wi, np.broadcast_to(self.wo, wi.shape))
        return times(values, times(radiance, np.maximum(wi[:, 2], 0.0)))
