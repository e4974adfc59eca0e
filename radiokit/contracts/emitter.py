"""The emitter contract: what a light source must provide to a point that it shines on."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.parameters import Spectrum, check_parameters, spectrum_length
from radiokit.contracts.registry import Registry
from radiokit.contracts.vectors import check_vectors
from radiokit.facts.errors import RadiokitError
from radiokit.facts.estimate import Estimate
from radiokit.physics.eclipse import Body, Dome

__all__ = ["REGISTRY", "Emitter", "Silhouette", "emitter", "list_emitters"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Silhouette:
    """The directions from which a light shines, as one point sees them; within them its radiance is smooth.

    ``radiance`` [W m⁻² sr⁻¹] is None where it is not the same in all of them.
    """

    body: Body | Dome
    radiance: Spectrum | None


class Emitter(ABC):
    """A light source in world coordinates, seen from the receiver at ``position`` (3,).

    Subclasses are frozen, keyword-only dataclasses, one a file. Directions are world-space unit vectors
    ``(N, 3)`` from the receiver towards the light. An emitter is either *delta* (it arrives from a finite
    number of directions: ``incident``) or it has a radiance (``radiance_from``, ``sample``, ``pdf``). The
    methods are named apart from the parameters ``radiance`` and ``irradiance``.
    """

    name: ClassVar[str] = ""
    delta: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_parameters(self)
        check_vectors(self)

    @property
    def wavelengths(self) -> int | None:
        """How many wavelengths the light's strength is given for; None for a single number.

        Radiances, irradiances and fluxes then have them on the last axis.
        """
        return spectrum_length(self)

    def incident(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return a delta light's M directions (M, 3) and the irradiances normal to them [W m⁻²].

        These are (M,), or (M, K) for K wavelengths.
        """
        raise RadiokitError(f"{self.name} is no delta light: it has a radiance")

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the radiance that arrives from ``direction`` (N, 3): (N,) or (N, K) [W m⁻² sr⁻¹]."""
        raise RadiokitError(f"{self.name} is a delta light: it has no radiance")

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points ``u`` (N, 2) into directions (N, 3) and their densities (N,) [sr⁻¹]."""
        raise RadiokitError(f"{self.name} is a delta light: its direction is not sampled")

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the density (N,) [sr⁻¹] with which ``sample`` picks ``direction``."""
        raise RadiokitError(f"{self.name} is a delta light: its direction is not sampled")

    def dome(self, position: FloatArray) -> tuple[FloatArray, ...] | None:
        """Return the half-spaces that an environment fills smoothly, by their unit normals (3,).

        ``()`` is the whole sphere, ``(n,)`` the half-space around ``n``, and None, the default, anything
        else. Quadrature takes its coordinates from it.
        """
        return None

    def pieces(self, position: FloatArray, normal: FloatArray) -> Sequence[Emitter] | None:
        """Return lights that together are this one, as far as it is above the receiver's horizon.

        Quadrature sums over them, each in the square from which it is sampled: a light with corners gives
        parts on which that is smooth. The default is the light itself. None means that there are no such
        parts: a jump runs through the light, and no rule can bound its error.
        """
        return (self,)

    def distance_along(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return how far (N,) [m] the light is along directions (N, 3) in which it is seen.

        Infinite, the default, for environments. Along other directions the number means nothing.
        """
        return np.full(len(direction), np.inf)

    def silhouette(self, position: FloatArray) -> Silhouette | None:
        """Return the directions from which a light with a radiance shines; None where they are not known.

        What hides part of the light is then found without samples.
        """
        return None

    @abstractmethod
    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return the solid angle [sr] that the light subtends at ``position``; 0 for a delta light."""

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate | None:
        """Return the closed-form irradiance [W m⁻²] on a receiver, or None where there is none."""
        return None

    def flux(self) -> Estimate | None:
        """Return the radiant flux Φ [W] that the source sends out; None for one infinitely far away."""
        return None


REGISTRY: Registry[Emitter] = Registry("emitter", "radiokit.emitters", Emitter, "radiokit.emitters")


def list_emitters() -> list[str]:
    """Return the names of all emitters, third-party ones included.

    >>> "point" in list_emitters()
    True
    """
    return REGISTRY.names()


def emitter(name: str, **parameters: Any) -> Emitter:
    """Return the emitter called ``name``.

    Parameters
    ----------
    name : str
        One of ``list_emitters()``.
    **parameters
        Those of its class, such as ``radiance=1.0``; the help of its class gives their ranges and units.

    Raises
    ------
    UnknownNameError
        When there is no such emitter.
    RadiokitError
        When a parameter is unknown, missing, or out of its range.

    >>> emitter("constant", radiance=1.0).name
    'constant'
    """
    return REGISTRY.make(name, parameters)
