"""Gradient sky: one radiance at the horizon and one at the zenith, joined by a parabola in cosθ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.sky import CosineSky
from radiokit.contracts.spectral import amount
from radiokit.contracts.vectors import vector
from radiokit.facts.source import Source

__all__ = ["SkyGradient"]


@dataclass(frozen=True, kw_only=True)
class SkyGradient(CosineSky):
    """The sky L = L_h + (L_z − L_h) [(1 − q) cosθ + q cos²θ], which is monotone from horizon to zenith.

    Parameters
    ----------
    radiance : float, or sequence of K floats
        Radiance L_z [W m⁻² sr⁻¹] at the zenith, in [0, 1e100]; one number, or one a wavelength.
    horizon : float, or sequence of K floats
        Radiance L_h [W m⁻² sr⁻¹] at the horizon, in [0, 1e100]; it may be the greater one, as in clear skies.
    curvature : float
        q in [−1, 1]: 0 is the linear law, 1 the purely quadratic one.
    normal : tuple of 3 floats, optional
        The zenith; any length but 0, stored as a unit vector. z by default.

    Raises
    ------
    ParameterError
        When ``normal`` is zero or not three finite numbers, or a number is out of its range.

    >>> sky = SkyGradient(radiance=3.0, horizon=0.0)
    >>> round(float(sky.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value) / np.pi, 14)
    2.0
    """

    name: ClassVar[str] = "sky_gradient"
    SOURCE: ClassVar[Source] = Source(
        authors="Steven, Unsworth",
        year=1980,
        title="The angular distribution and interception of diffuse solar radiation below overcast skies. "
        "Quarterly Journal of the Royal Meteorological Society 106(447)",
        equation="the linear law L ∝ 1 + b cosθ, and what a slope gets of it",
    )

    radiance: Spectrum = parameter(
        "[0, 1e100]", "W/m^2/sr", "radiance at the zenith", spectral=True, default=1.0
    )
    horizon: Spectrum = parameter(
        "[0, 1e100]", "W/m^2/sr", "radiance at the horizon", spectral=True, default=0.0
    )
    curvature: float = parameter("[-1, 1]", "1", "share of cos²θ in the law, beside cosθ", default=0.0)
    normal: tuple[float, float, float] = vector("direction", "1", "the zenith", default=(0.0, 0.0, 1.0))

    @property
    def bernstein(self) -> tuple[Any, Any, Any]:
        """L_h, ½((1 + q) L_h + (1 − q) L_z) and L_z, none negative for q in [−1, 1]."""
        low, high = np.broadcast_arrays(amount(self.horizon), amount(self.radiance))
        middle = (1 + self.curvature) / 2 * low + (1 - self.curvature) / 2 * high
        return low[()], middle[()], high[()]
