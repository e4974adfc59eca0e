"""Scene: the receiver, and what arrives at it: irradiance and solid angle of an emitter."""

from __future__ import annotations

import operator
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property, partial, reduce
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
from radiokit.measure.quadrature import box

__all__ = ["Receiver", "behind", "check_emitter", "irradiance", "over_light", "solid_angle"]

FloatArray = npt.NDArray[np.float64]

_SCATTERED = 1 << 16
_ROUNDING = 1e-14  # of the heights of a piece that ends at the horizon


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
        When ``normal`` or ``position`` is no vector, or the receiver lies on the light or an occluder.

    >>> from radiokit.emitters.directional import Directional
    >>> sun = Directional(direction=(0, 3, 4), irradiance=1000.0)
    >>> irradiance(sun).value
    800.0
    """
    receiver = Receiver(normal, position)
    light = behind(emitter, occluders, receiver)
    start = time.perf_counter()
    found = light.irradiance_at(receiver.origin, receiver.axis)
    if found is not None:
        return replace(found, seconds=time.perf_counter() - start)

    def arriving(piece: Emitter, u: FloatArray) -> FloatArray:
        wi, density = piece.sample(u, receiver.origin)
        cosine = np.maximum(wi @ receiver.axis, 0.0)
        value = piece.radiance_from(wi, receiver.origin) * cosine
        return np.divide(value, density, out=np.zeros_like(value), where=density > 0)

    return over_light(arriving, light, receiver, rtol)


def over_light(
    integrand: Callable[[Emitter, FloatArray], Any], light: Emitter, receiver: Receiver, rtol: float
) -> Estimate:
    """Integrate over a light, piece by piece, with points in the square from which a piece is sampled."""
    pieces = light.pieces(receiver.origin, receiver.axis)
    if pieces is None:
        return _scattered(partial(integrand, light))
    if not pieces:
        nothing = np.zeros_like(np.asarray(integrand(light, np.full((1, 2), 0.5)))[0])[()]
        return Estimate(nothing, nothing, "truncation", 1, method="none of the light is seen")
    found = [_over_piece(partial(integrand, piece), piece, receiver, rtol) for piece in pieces]
    return reduce(operator.add, found)


def _over_piece(
    integrand: Callable[[FloatArray], Any], light: Emitter, receiver: Receiver, rtol: float
) -> Estimate:
    """Integrate over the square of a single piece, aware of the kink that its setting makes."""
    kinks = crosses_horizon(light, receiver)
    # Adaptive cubature stops as soon as it is near the tolerance: aim below it, then judge by it.
    aim = rtol / 4 if kinks else rtol
    found = box(integrand, (0.0, 0.0), (1.0, 1.0), rtol=aim, kinks=kinks)
    converged = bool(np.all(found.error <= rtol * np.abs(found.value)))
    note = "" if converged else found.note
    error = found.error + getattr(light, "precision", 0.0) * np.abs(found.value)
    method = f"{found.method} over the light"
    return replace(found, error=error, method=method, converged=converged, note=note)


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


def crosses_horizon(light: Emitter, receiver: Receiver) -> bool:
    """Return whether a light that is sampled lies on both sides of the receiver's horizon."""
    x = np.linspace(0.0, 1.0, 65)
    grid = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    towards, _ = light.sample(grid, receiver.origin)
    height = towards @ receiver.axis
    return bool(np.any(height > _ROUNDING) and np.any(height < -_ROUNDING))


def solid_angle(
    emitter: Emitter,
    *,
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    occluders: Occluder | Iterable[Occluder] = (),
) -> Estimate:
    """Return the solid angle [sr] of an emitter from ``position`` (3,) [m]; 0 for a delta light.

    With ``occluders``, that of what is seen of it behind them.

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
