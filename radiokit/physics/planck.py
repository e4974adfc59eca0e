"""Planck: what a black body of a temperature radiates, at one wavelength and at all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject
from radiokit.facts.source import Source

if TYPE_CHECKING:
    import sympy

__all__ = ["SOURCE", "radiance", "spectral_radiance", "spectral_radiance_symbolic"]

FloatArray = npt.NDArray[np.float64]

SOURCE = Source(
    authors="Planck",
    year=1901,
    title="Ueber das Gesetz der Energieverteilung im Normalspectrum. Annalen der Physik 309(3)",
    doi="10.1002/andp.19013090310",
    equation="the law in wavelengths; h, c and k are those that define the SI since 2019, which are exact",
)

_FIRST = 1.1910429723971884e20  # 2hc² [W m⁻² sr⁻¹ nm⁻¹ nm⁵]
_SECOND = 14387768.775039338  # hc/k [nm K]
_STEFAN = 1.804936235990074e-8  # σ/π = 2π⁴k⁴/(15h³c²) [W m⁻² sr⁻¹ K⁻⁴]


def spectral_radiance(*, wavelength_nm: npt.ArrayLike, temperature: npt.ArrayLike) -> Any:
    """Return the spectral radiance [W m⁻² sr⁻¹ nm⁻¹] of a black body: 2hc²/λ⁵ / (exp(hc/λkT) − 1).

    Parameters
    ----------
    wavelength_nm : array_like, shape (...)
        λ in vacuum [nm], in [1e-3, 1e15].
    temperature : array_like, shape (...)
        T [K], in [0, 1e12].

    Returns
    -------
    float or ndarray, shape (...)
        0 where it is below the range of float64. No digit is lost where λT is large, and the law is that of
        Rayleigh and Jeans.

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: Planck (1901), doi:10.1002/andp.19013090310.

    >>> print(round(float(spectral_radiance(wavelength_nm=500.0, temperature=5772.0)), 4))
    26238.5406
    """
    length = _within("wavelength_nm", wavelength_nm, 1e-3, 1e15)
    heat = _within("temperature", temperature, 0.0, 1e12)
    with np.errstate(all="ignore"):  # 0 K gives x = ∞, and exp(−∞) = 0
        x = _SECOND / (length * heat)
        return (_FIRST / length**5 * (np.exp(-x) / -np.expm1(-x)))[()]


def radiance(*, temperature: npt.ArrayLike) -> Any:
    """Return the radiance [W m⁻² sr⁻¹] of a black body at all wavelengths together: σT⁴/π.

    Parameters
    ----------
    temperature : array_like, shape (...)
        T [K], in [0, 1e12].

    Raises
    ------
    ParameterError
        Naming the argument, its value, and what is allowed.

    Source: Planck (1901), doi:10.1002/andp.19013090310, integrated: Stefan and Boltzmann's law.

    >>> print(round(float(radiance(temperature=300.0)) * np.pi, 4))  # its exitance
    459.3003
    """
    square = _within("temperature", temperature, 0.0, 1e12) ** 2
    return (_STEFAN * square * square)[()]


def spectral_radiance_symbolic(wavelength_nm: sympy.Expr, temperature: sympy.Expr) -> sympy.Expr:
    """Return the spectral radiance as SymPy, from h, c and k."""
    import sympy

    h, c, k = sympy.Rational("6.62607015e-34"), sympy.Integer(299_792_458), sympy.Rational("1.380649e-23")
    nm = sympy.Rational("1e-9")
    length = wavelength_nm * nm
    return nm * 2 * h * c**2 / length**5 / (sympy.exp(h * c / (length * k * temperature)) - 1)


def _within(name: str, value: npt.ArrayLike, low: float, high: float) -> FloatArray:
    allowed = f"a number in [{low:g}, {high:g}]"
    array = numbers(name, value, allowed)
    reject(name, array, np.asarray(~((array >= low) & (array <= high))), allowed)
    return array
