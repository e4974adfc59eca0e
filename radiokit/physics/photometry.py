"""Photometry: how much light a radiant quantity is to the eye, by the spectrum that it has."""

from __future__ import annotations

from functools import cache
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject, short
from radiokit.facts.errors import NonFiniteError, ParameterError
from radiokit.facts.source import Source

__all__ = ["CANDELA_NM", "SOURCE", "Vision", "luminous_efficacy", "luminous_efficiency"]

FloatArray = npt.NDArray[np.float64]

Vision = Literal["photopic", "scotopic"]
"""Of the eye that is adapted to the day, or to the night."""

SOURCE = Source(
    authors="CIE",
    year=2020,
    title="ILV: International Lighting Vocabulary, 2nd edition. CIE S 017/E:2020",
    doi="10.25039/S017.2020",
    equation="17-21-035, V(λ); 17-21-090, the efficacy of radiation; 17-21-092, note 2, its maximum",
)

CANDELA_NM = 555.017
"""The wavelength in air of 540 THz [nm], for which the candela is defined as 683 lm/W."""

_OBSERVERS = {
    "photopic": "CIE 1924 Photopic Standard Observer",
    "scotopic": "CIE 1951 Scotopic Standard Observer",
}


def luminous_efficiency(*, wavelength_nm: npt.ArrayLike, vision: Vision = "photopic") -> Any:
    """Return the spectral luminous efficiency V(λ) of the CIE's standard observer, or V'(λ) at night.

    It is linear between the whole nanometres of the table, and 0 beyond its ends: 360 to 830 nm by day, 380
    to 780 nm by night.

    Parameters
    ----------
    wavelength_nm : array_like, shape (...)
        Wavelengths in air [nm], above 0.
    vision : {"photopic", "scotopic"}

    Returns
    -------
    float or ndarray, shape (...)
        V [1], in [0, 1].

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: CIE S 017 (2020), doi:10.25039/S017.2020, 17-21-035; the tables are those of colour-science.

    >>> luminous_efficiency(wavelength_nm=[555.0, 680.0, 1000.0])
    array([1.   , 0.017, 0.   ])
    >>> float(luminous_efficiency(wavelength_nm=507.0, vision="scotopic"))
    1.0
    """
    table, values = _table(vision)
    wavelength = _above_zero(wavelength_nm)
    return np.interp(wavelength, table, values, left=0.0, right=0.0)[()]


def luminous_efficacy(
    *, wavelength_nm: npt.ArrayLike, spectrum: npt.ArrayLike, vision: Vision = "photopic"
) -> Any:
    """Return the luminous efficacy of radiation K = K_m ∫ V(λ) X_λ dλ / ∫ X_λ dλ of a spectrum X_λ.

    A flux of Φ_e watts with this spectrum is one of Φ_v = K Φ_e lumens, and so with intensity and candela,
    irradiance and lux, radiance and nit: ``relate(..., luminous_efficacy=K)`` takes it. The spectrum is
    taken as linear between its wavelengths and 0 beyond; of this function, as of V, the integrals are exact
    but for rounding. K_m = 683 lm/W / V(555.017 nm), which is 683.002 lm/W by day and 1700.13 by night.

    Parameters
    ----------
    wavelength_nm : array_like, shape (M,)
        Wavelengths in air [nm], above 0 and increasing; at least 2.
    spectrum : array_like, shape (..., M)
        A spectral radiant quantity there, each at least 0 and not all 0; its unit does not matter.
    vision : {"photopic", "scotopic"}

    Returns
    -------
    float or ndarray, shape (...)
        K [lm W⁻¹], in [0, K_m].

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.
    NonFiniteError
        When the spectrum has NaN or infinity.

    Source: CIE S 017 (2020), doi:10.25039/S017.2020, 17-21-090, and for K_m 17-21-092, note 2.

    >>> round(luminous_efficacy(wavelength_nm=[380.0, 780.0], spectrum=[1.0, 1.0]), 2)  # white to physicists
    182.46
    >>> from radiokit.physics.planck import spectral_radiance
    >>> nm = np.linspace(200.0, 20_000.0, 19_801)
    >>> lamp = spectral_radiance(wavelength_nm=nm, temperature=2856.0)
    >>> round(luminous_efficacy(wavelength_nm=nm, spectrum=lamp), 1)
    16.5
    """
    wavelength = _above_zero(wavelength_nm)
    if wavelength.ndim != 1 or len(wavelength) < 2 or not np.all(np.diff(wavelength) > 0):
        raise ParameterError(
            "wavelength_nm", short(wavelength_nm), "of shape (M,), M at least 2, and increasing"
        )
    x = numbers("spectrum", spectrum, "at least 0, and not all 0")
    if x.shape[-1:] != wavelength.shape:
        raise ParameterError("spectrum", x.shape, f"of shape (..., {len(wavelength)})")
    if not np.all(np.isfinite(x)):
        raise NonFiniteError("spectrum has NaN or infinity")
    largest = x.max(axis=-1, keepdims=True)
    if np.any(x < 0) or np.any(largest == 0):
        raise ParameterError("spectrum", short(spectrum), "at least 0, and not all 0")
    x = x / largest
    table, values = _table(vision)
    nodes = np.union1d(wavelength, table)
    nodes = nodes[(nodes >= max(wavelength[0], table[0])) & (nodes <= min(wavelength[-1], table[-1]))]
    steps = np.diff(nodes)
    seen = np.interp(nodes, table, values)
    light = _between(nodes, wavelength, x)
    left, right = light[..., :-1], light[..., 1:]
    ends = left * (2 * seen[:-1] + seen[1:]) + right * (seen[:-1] + 2 * seen[1:])
    weighed = np.sum(ends * steps, axis=-1) / 6
    whole = np.sum((x[..., :-1] + x[..., 1:]) * np.diff(wavelength), axis=-1) / 2
    most = 683.0 / float(np.interp(CANDELA_NM, table, values))
    found = most * (weighed / whole)
    return found if found.ndim else float(found)


@cache
def _table(vision: Vision) -> tuple[FloatArray, FloatArray]:
    """Return the wavelengths [nm] and values of an observer."""
    if vision not in _OBSERVERS:
        raise ParameterError("vision", vision, "'photopic' or 'scotopic'")
    options = np.get_printoptions()
    try:
        from colour.colorimetry import SDS_LEFS  # which takes a second, and changes how arrays are printed
    finally:
        np.set_printoptions(**options)
    observer = SDS_LEFS[_OBSERVERS[vision]]
    return np.array(observer.domain, dtype=np.float64), np.minimum(observer.range, 1.0)


def _between(nodes: FloatArray, wavelength: FloatArray, x: FloatArray) -> FloatArray:
    """Return a spectrum (..., M) at nodes within its range; nothing cancels, as all is at least 0."""
    place = np.clip(np.searchsorted(wavelength, nodes, side="right") - 1, 0, len(wavelength) - 2)
    low, high = wavelength[place], wavelength[place + 1]
    part = high - low
    found: FloatArray = x[..., place] * ((high - nodes) / part) + x[..., place + 1] * ((nodes - low) / part)
    return found


def _above_zero(wavelength_nm: npt.ArrayLike) -> FloatArray:
    allowed = "finite and above 0"
    wavelength = numbers("wavelength_nm", wavelength_nm, allowed)
    reject("wavelength_nm", wavelength, np.asarray(~((wavelength > 0) & (wavelength < np.inf))), allowed)
    return wavelength
