"""Overcast sky: the standard overcast sky of the CIE, thrice as bright at the zenith as at the horizon."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.sky import CosineSky
from radiokit.contracts.spectral import amount
from radiokit.contracts.vectors import vector
from radiokit.facts.source import Source

__all__ = ["SkyOvercast"]


@dataclass(frozen=True, kw_only=True)
class SkyOvercast(CosineSky):
    """The sky L = L_z (1 + 2 cosθ)/3; a horizontal receiver gets E = 7π/9 L_z.

    Parameters
    ----------
    radiance : float, or sequence of K floats
        Radiance L_z [W m⁻² sr⁻¹] at the zenith, in [0, 1e100]; one number, or one a wavelength.
    normal : tuple of 3 floats, optional
        The zenith; any length but 0, stored as a unit vector. z by default.

    Raises
    ------
    ParameterError
        When ``normal`` is zero or not three finite numbers, or ``radiance`` is out of its range.

    >>> import numpy as np
    >>> flat = SkyOvercast(radiance=9.0).irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    >>> round(float(flat.value) / np.pi, 14)
    7.0
    """

    name: ClassVar[str] = "sky_overcast"
    SOURCE: ClassVar[Source] = Source(
        authors="Moon, Spencer",
        year=1942,
        title="Illumination from a non-uniform sky. Illuminating Engineering 37",
        equation="L = L_z (1 + 2 cosθ)/3, a standard of the CIE since 1955",
    )

    radiance: Spectrum = parameter(
        "[0, 1e100]", "W/m^2/sr", "radiance at the zenith", spectral=True, default=1.0
    )
    normal: tuple[float, float, float] = vector("direction", "1", "the zenith", default=(0.0, 0.0, 1.0))

    @property
    def bernstein(self) -> tuple[Any, Any, Any]:
        """L_z/3, 2L_z/3 and L_z."""
        zenith = amount(self.radiance)
        return zenith / 3, 2 * (zenith / 3), zenith
