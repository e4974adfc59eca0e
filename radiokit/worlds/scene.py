"""Scene: the receiver, and what arrives at it: irradiance and solid angle of an emitter."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.occluder import Occluder, check_occluders
from radiokit.contracts.shadowed import Shadowed, shadowed
from radiokit.contracts.vectors import as_point, as_unit
from radiokit.facts.directions import frame, to_local, to_world
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate
from radiokit.measure import lowdiscrepancy
from radiokit.worlds.finite import over_light

__all__ = ["Receiver", "behind", "behind_all", "check_emitter", "irradiance", "solid_angle"]

FloatArray = npt.NDArray[np.float64]

_SCATTERED = 1 << 16


@dataclass(frozen=True)
class Receiver:
    """A point on a surface: its position and its normal, which is normalised.

    >>> Receiver((2, 0, 0)).to_local(np.array([1.0, 0.0, 0.0]))
    array([0., 0., 1.])
    """

    normal: Any = (0.0, 0.0, 1.0)
    position: Any = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "normal", as_unit("normal", self.normal))
        object.__setattr__(self, "position", as_point("position", self.position))

    @cached_property
    def axis(self) -> FloatArray:
        """The unit normal (3,)."""
        return np.array(self.normal)

    @cached_property
    def origin(self) -> FloatArray:
        """The position (3,) [m]."""
        return np.array(self.position)

    @cached_property
    def _frame(self) -> FloatArray:
        return frame(self.axis)

    @cached_property
    def other_side(self) -> Receiver:
        """The same point seen from the other side: the same x and y, and z the other way.

        >>> Receiver((0, 0, 2)).other_side.to_local(np.array([0.6, 0.0, -0.8])).tolist()
        [0.6, 0.0, 0.8]
        """
        found = Receiver(-self.axis, self.origin)
        found.__dict__["_frame"] = self._frame * np.array([[1.0], [1.0], [-1.0]])
        return found

    def to_local(self, w: FloatArray) -> FloatArray:
        """Return world directions (..., 3) in the frame whose z axis is the normal."""
        return to_local(self._frame, w)

    def to_world(self, w: FloatArray) -> FloatArray:
        """Return directions (..., 3) of the local frame in world coordinates."""
        return to_world(self._frame, w)


def check_emitter(emitter: Any) -> Emitter:
    """Return ``emitter`` if it is one.

    Raises
    ------
    ParameterError
        When it is none.
    """
    if not isinstance(emitter, Emitter):
        raise ParameterError("emitter", emitter, "an emitter, such as emitter('point', ...)")
    return emitter


def check_rtol(rtol: Any) -> None:
    """Refuse a relative tolerance that is no number in (0, 1)."""
    if not isinstance(rtol, Real) or not 0 < float(rtol) < 1:
        raise ParameterError("rtol", rtol, "in (0, 1)")


def irradiance(
    emitter: Emitter,
    *,
    normal: npt.ArrayLike = (0.0, 0.0, 1.0),
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    rtol: float = 1e-8,
    occluders: Occluder | Iterable[Occluder] = (),
) -> Estimate:
    """Return the irradiance E = ∫ L cosθ dω [W m⁻²] of an emitter on one side of a receiver.

    By the emitter's closed form where it has one; otherwise by quadrature over the square from which the
    emitter samples its directions.

    Parameters
    ----------
    emitter : Emitter
    normal : array_like, shape (3,)
        The receiver's normal in world coordinates; any length but 0.
    position : array_like, shape (3,)
        Where the receiver is [m].
    rtol : float
        Relative tolerance of the quadrature, in (0, 1).
    occluders : Occluder or iterable of Occluder, optional
        Opaque bodies between the light and the receiver.

    Raises
    ------
    ParameterError
        When ``normal`` or ``position`` is no vector, ``rtol`` is out of range, or the receiver lies on the
        light or an occluder.

    >>> from radiokit.emitters.directional import Directional
    >>> sun = Directional(direction=(0, 3, 4), irradiance=1000.0)
    >>> irradiance(sun).value
    800.0
    """
    check_rtol(rtol)
    receiver = Receiver(normal, position)
    light = behind(emitter, occluders, receiver)
    start = time.perf_counter()
    found = light.irradiance_at(receiver.origin, receiver.axis)
    if found is not None:
        return replace(found, seconds=time.perf_counter() - start)

    def arriving(piece: Emitter) -> Callable[[FloatArray], Any]:
        def product(wi: FloatArray) -> FloatArray:
            radiance = piece.radiance_from(wi, receiver.origin)
            return (radiance.T * np.maximum(wi @ receiver.axis, 0.0)).T

        return product

    return over_light(arriving, light, receiver, rtol)


def _scattered(integrand: Callable[[FloatArray], Any]) -> Estimate:
    """Integrate over a light through which the edge of a shadow runs, by shifted lattices."""
    found = lowdiscrepancy.mean(integrand, dimensions=2, samples=_SCATTERED, rng=0)
    return replace(
        found,
        error=8 * found.error,
        kind="truncation",
        method="lattice over the light",
        converged=False,
        note="a shadow's edge runs through the light: no rule can bound the error",
        dof=None,
    )


def behind(emitter: Any, occluders: Any, receiver: Receiver) -> Emitter:
    """Return a light as a receiver sees it behind occluders."""
    light = check_emitter(emitter)
    found = check_occluders(occluders)
    return shadowed(light, found, receiver.origin) if found else light


def behind_all(emitters: Any, occluders: Any, position: Any) -> Any:
    """Return lights as they are seen from a place behind occluders; as they are given, if there is none."""
    found = check_occluders(occluders)
    if not found:
        return emitters
    receiver = Receiver(position=position)
    lights = [emitters] if isinstance(emitters, Emitter) else list(emitters)
    return [behind(light, found, receiver) for light in lights]


def solid_angle(
    emitter: Emitter,
    *,
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    occluders: Occluder | Iterable[Occluder] = (),
) -> Estimate:
    """Return the solid angle [sr] of an emitter; 0 for a delta light.

    Parameters
    ----------
    emitter : Emitter
    position : array_like, shape (3,)
        Where it is seen from [m].
    occluders : Occluder or iterable of Occluder
        Only what is seen of the emitter behind them counts.

    Raises
    ------
    ParameterError
        When ``position`` is no point, or lies on the light or an occluder.

    >>> from radiokit.emitters.constant import Constant
    >>> round(float(solid_angle(Constant()).value) / np.pi, 12)
    4.0
    """
    receiver = Receiver(position=position)
    light = behind(emitter, occluders, receiver)
    found = light.solid_angle(receiver.origin)
    if found.converged or not isinstance(light, Shadowed):
        return found

    def seen(u: FloatArray) -> FloatArray:
        towards, density = light.sample(u, receiver.origin)
        lit = light.visible(towards, receiver.origin) & (density > 0)
        return np.divide(1.0, density, out=np.zeros_like(density), where=lit)

    return _scattered(seen)
