"""Integrating sphere: what a sphere of diffuse walls, ports and samples does to the light inside it.

From any point of a sphere to any other the cosines and the distance cancel to 1/A: a patch sends to each part
the share of its flux that the part takes of the whole area, A = 4πR². So the light that interreflection adds
is the same everywhere, and one number decides: the mean absorptance ᾱ = Σ fⱼαⱼ over parts of shares fⱼ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject, short
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.physics.lengths import at_least_zero, positive

__all__ = ["GOEBEL", "LABSPHERE", "SPEED_OF_LIGHT", "IntegratingSphere", "port_share"]

FloatArray = npt.NDArray[np.float64]

SPEED_OF_LIGHT = 299_792_458.0
"""c [m s⁻¹], exact."""

GOEBEL = Source(
    authors="Goebel",
    year=1967,
    title="Generalized Integrating-Sphere Theory. Applied Optics 6(1)",
    doi="10.1364/AO.6.000125",
    equation="the efficiency of a sphere with areas of different reflectances",
    errata="its 1 − Σ fρ loses the digits of a white sphere: here it is the sum of the absorptances, Σ fα",
)
LABSPHERE = Source(
    authors="Labsphere",
    year=2017,
    title="A Guide to Integrating Sphere Theory and Applications",
    equation="the sphere multiplier, the radiance of the sphere, and its time constant",
)


def port_share(*, port_radius: npt.ArrayLike, radius: npt.ArrayLike) -> Any:
    """Return the share of a sphere's area that lies behind a round port: ½(1 − √(1 − (r/R)²)).

    Parameters
    ----------
    port_radius : array_like
        r, of the flat rim, in [0, R].
    radius : array_like
        R, the sphere's, above 0.

    Raises
    ------
    ParameterError
        When a radius is not allowed.

    Source: Goebel (1967), doi:10.1364/AO.6.000125, whose difference loses the digits of a small port.

    >>> port_share(port_radius=1e-9, radius=1.0).item()
    2.5e-19
    """
    r, whole = at_least_zero("port_radius", port_radius), positive("radius", radius)
    r, whole = np.broadcast_arrays(r, whole)
    reject("port_radius", r, r > whole, "at most the sphere's radius")
    x = r / whole
    return (0.5 * x * x / (1.0 + np.sqrt((1.0 - x) * (1.0 + x))))[()]


@dataclass(frozen=True, kw_only=True, eq=False)
class IntegratingSphere:
    """A sphere with a diffuse wall, and with ports, samples and detectors that are diffuse too, or holes.

    Parameters
    ----------
    radius : float
        R [m], above 0.
    reflectance, absorptance : array_like, shape () or (K,)
        Of the wall, in [0, 1]: ρ, or else α = 1 − ρ where that is too small to be told from ρ = 1. K numbers
        are for K wavelengths.
    port_share : array_like, shape () or (n,)
        Shares of the sphere's area, together at most 1; see ``port_share``. Without it there are no ports.
    port_reflectance, port_absorptance : array_like, shape (), (n,) or (n, K), optional
        Of the ports, one of the two; without either they are holes.

    Raises
    ------
    ParameterError
        When a number is not allowed; from the methods, where nothing absorbs and the light grows without
        bound.

    Source: Goebel (1967), doi:10.1364/AO.6.000125; Jacquez, Kuppenheim (1955), doi:10.1364/JOSA.45.000460.

    >>> sphere = IntegratingSphere(reflectance=0.99, port_share=0.05)
    >>> round(float(sphere.multiplier), 4)
    16.6387
    """

    radius: Any = 1.0
    reflectance: Any = None
    absorptance: Any = None
    port_share: Any = ()
    port_reflectance: Any = None
    port_absorptance: Any = None

    def __post_init__(self) -> None:
        if positive("radius", self.radius).ndim:
            raise ParameterError("radius", self.radius, "one number")
        if self._wall[0].ndim > 1:
            raise ParameterError("reflectance", self.reflectance, "a number, or one for each wavelength")
        if self._shares.sum() > 1:
            raise ParameterError("port_share", self.port_share, "at most 1 together")
        assert self._ports is not None

    @cached_property
    def _wall(self) -> tuple[FloatArray, FloatArray]:
        return _pair("reflectance", self.reflectance, "absorptance", self.absorptance)

    @cached_property
    def _shares(self) -> FloatArray:
        allowed = "a share in [0, 1], or one for each port"
        given = self.port_share if np.size(self.port_share) else np.zeros(0)
        array = np.atleast_1d(numbers("port_share", given, allowed))
        if array.ndim > 1:
            raise ParameterError("port_share", self.port_share, allowed)
        reject("port_share", array, ~((array >= 0) & (array <= 1)), allowed)
        return array

    @cached_property
    def _ports(self) -> tuple[FloatArray, FloatArray]:
        absorptance = self.port_absorptance
        if absorptance is None and self.port_reflectance is None:
            absorptance = 1.0
        found = _pair("port_reflectance", self.port_reflectance, "port_absorptance", absorptance)
        count = len(self._shares)
        if found[0].ndim == 0:
            found = (np.full(count, found[0]), np.full(count, found[1]))
        if len(found[0]) != count or found[0].ndim > 2:
            allowed = f"a number, or one for each of {count} ports, with the wavelengths on the last axis"
            raise ParameterError("port_reflectance", short(self.port_reflectance), allowed)
        return found

    def _mean(self, which: int) -> FloatArray:
        rest = max(0.0, 1.0 - float(self._shares.sum()))
        parts = (self._shares * self._ports[which].T).T
        return np.asarray(rest * self._wall[which] + parts.sum(axis=0))

    @property
    def area(self) -> float:
        """A = 4πR² [m²], ports included."""
        return float(4.0 * np.pi * self.radius * self.radius)

    @property
    def average_reflectance(self) -> Any:
        """ρ̄ = ρ(1 − Σf) + Σ fⱼρⱼ, of shape () or (K,).

        >>> round(float(IntegratingSphere(reflectance=0.98, port_share=[0.01, 0.02]).average_reflectance), 6)
        0.9506
        """
        return self._mean(0)[()]

    @property
    def average_absorptance(self) -> Any:
        """ᾱ = 1 − ρ̄ as a sum of absorptances, which keeps its digits where ρ̄ is next to 1.

        >>> float(IntegratingSphere(absorptance=1e-20).average_absorptance)
        1e-20
        """
        return self._mean(1)[()]

    def _lossy(self) -> FloatArray:
        found = self._mean(1)
        if np.any(found == 0):
            allowed = "above 0: where nothing absorbs, the light inside grows without bound"
            raise ParameterError("average absorptance", 0.0, allowed)
        return found

    @property
    def multiplier(self) -> Any:
        """M = ρ/ᾱ, how often light that falls on the wall arrives there again; ρ/(1 − ρ(1 − f)) with holes.

        Labsphere's guide: the sphere multiplier.
        """
        return (self._wall[0] / self._lossy())[()]

    def irradiance(self, *, leaving_flux: npt.ArrayLike) -> Any:
        """Return E = Φ/(Aᾱ) [W m⁻²], which every point receives of flux that leaves the walls diffusely.

        Parameters
        ----------
        leaving_flux : array_like
            Φ [W], at least 0: emitted by walls, or reflected by them for the first time. What falls on a
            point from a lamp comes on top.

        >>> round(float(IntegratingSphere(reflectance=0.75).irradiance(leaving_flux=4 * np.pi)), 12)
        4.0
        """
        return (_flux("leaving_flux", leaving_flux) / self.area / self._lossy())[()]

    def wall_radiance(self, *, flux: npt.ArrayLike) -> Any:
        """Return L = ΦM/(πA) [W m⁻² sr⁻¹], the sphere's mean radiance for a flux that enters it.

        It is E/π with E the irradiance of every point after the first reflection: the mean over all that a
        point sees, dark ports counted. A wall point out of the beam itself leaves ρL.

        Parameters
        ----------
        flux : array_like
            Φ [W], at least 0, which falls on the wall first.

        Source: Labsphere's guide, the radiance of the sphere.

        >>> round(float(IntegratingSphere(reflectance=0.5).wall_radiance(flux=4 * np.pi**2)), 12)
        1.0
        """
        return (_flux("flux", flux) / self.area * self.multiplier / np.pi)[()]

    def throughput(self, *, port: int = 0) -> Any:
        """Return fM, the share of a flux which falls on the wall first that arrives at a port.

        >>> round(float(IntegratingSphere(reflectance=1.0, port_share=[0.01, 0.03]).throughput(port=1)), 12)
        0.75
        """
        return (self._shares[self._port(port)] * self.multiplier)[()]

    def substitution_error(self, *, sample_reflectance: npt.ArrayLike, port: int = 0) -> Any:
        """Return the relative error of a reflectance measured by putting the sample in a standard's place.

        The standard is what the port holds, of reflectance ρ₀. The signal with the sample over that with the
        standard is (ρ/ρ₀)(ᾱ₀/ᾱ), for the sample changes the sphere's mean too: off by f(ρ − ρ₀)/ᾱ.

        Parameters
        ----------
        sample_reflectance : array_like, shape () or (K,)
            ρ in [0, 1].
        port : int
            Where both lie.

        Source: Jacquez, Kuppenheim (1955), doi:10.1364/JOSA.45.000460.

        >>> sphere = IntegratingSphere(reflectance=0.98, port_share=0.01, port_reflectance=0.99)
        >>> round(float(sphere.substitution_error(sample_reflectance=0.5)), 4)
        -0.1976
        """
        index = self._port(port)
        sample, absorptance = _pair("sample_reflectance", sample_reflectance, "", None)
        standard = self._ports[0][index]
        if sample.ndim > 1:
            raise ParameterError("sample_reflectance", short(sample), "a number, or one for each wavelength")
        shape = np.broadcast_shapes(self._ports[1].T.shape, (*absorptance.shape, len(self._shares)))
        rows = np.broadcast_to(self._ports[1].T, shape).copy().T
        rows[index] = absorptance
        with_sample = IntegratingSphere(
            absorptance=self._wall[1], port_share=self._shares, port_absorptance=rows
        )
        return (self._shares[index] * (sample - standard) / with_sample._lossy())[()]

    @property
    def time_constant(self) -> Any:
        """τ = −(2/3)(2R/c)/ln ρ̄ [s], in which the light falls to 1/e once the source is off.

        4R/3 is the sphere's mean chord, four volumes over its area. Source: Labsphere's guide.

        >>> round(float(IntegratingSphere(radius=0.15, reflectance=0.98).time_constant) * 1e9, 2)
        33.02
        """
        reflectance, absorptance = self._mean(0), self._lossy()
        with np.errstate(divide="ignore"):  # of a black sphere: no time at all
            dark, light = np.log(reflectance), np.log1p(-np.minimum(absorptance, 0.75))
        decay = -np.where(reflectance < 0.5, dark, light)
        return (4.0 / 3.0 * self.radius / SPEED_OF_LIGHT / decay)[()]

    def _port(self, port: int) -> int:
        if not (type(port) is int and 0 <= port < len(self._shares)):
            raise ParameterError("port", port, f"one of the {len(self._shares)} ports, counted from 0")
        return port


def _pair(name: str, reflectance: Any, other: str, absorptance: Any) -> tuple[FloatArray, FloatArray]:
    """Return ρ and α from whichever is given; each is the other's difference from 1, rounded once."""
    if (reflectance is None) == (absorptance is None):
        raise ParameterError(name, short(reflectance), f"given, or else {other}: one of the two")
    name, given = (name, reflectance) if absorptance is None else (other, absorptance)
    allowed = "in [0, 1]"
    array = numbers(name, given, allowed)
    reject(name, array, np.asarray(~((array >= 0) & (array <= 1))), allowed)
    return (array, 1.0 - array) if absorptance is None else (1.0 - array, array)


def _flux(name: str, value: npt.ArrayLike) -> FloatArray:
    allowed = "a finite flux, at least 0"
    flux = numbers(name, value, allowed)
    reject(name, flux, np.asarray(~((flux >= 0) & np.isfinite(flux))), allowed)
    return flux
