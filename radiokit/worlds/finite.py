"""Finite: integrals over a light that is no dome, in the square from which it samples its directions."""

from __future__ import annotations

import operator
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.facts.estimate import Estimate
from radiokit.measure.square import crowded_square
from radiokit.worlds.lookout import Lookout, edges, look

if TYPE_CHECKING:
    from radiokit.worlds.scene import Receiver

__all__ = ["over_light"]

FloatArray = npt.NDArray[np.float64]
Product = Callable[[Emitter], Callable[[FloatArray], Any]]

MOST = 2_000_000
"""Evaluations when no budget is given."""

UNKNOWN = "a shadow's edge runs through the light: no rule can bound the error"
"""What is said of a light that names no pieces, where refinement does not reach the tolerance."""

_LEAST = 512


def over_light(
    product: Product,
    light: Emitter,
    receiver: Receiver,
    rtol: float,
    *,
    peaked: bool = False,
    width: float | None = None,
    towards: Sequence[FloatArray] = (),
    smooth: bool = True,
    max_evaluations: int = MOST,
    refinement: int = MOST,
    deadline: float = np.inf,
) -> Estimate:
    """Integrate over a light, piece by piece; where it names no pieces, as a whole in which something jumps.

    Parameters
    ----------
    product : callable
        ``product(piece)(directions)`` is the integrand over solid angle for world directions (N, 3).
    light : Emitter
    receiver : Receiver
    rtol : float
        Of each piece.
    peaked : bool
        Whether the product may have a narrow peak, for which the square is then searched.
    width : float, optional
        The peak's angular radius [rad], where it is known.
    towards : sequence of ndarray (3,)
        World directions near which it may be.
    smooth : bool
        Whether the product is known to have no kinks but those that its setting makes.
    max_evaluations, refinement, deadline
        Budgets, as of ``crowded_square``.
    """
    found: list[Estimate] = []
    given: Any = light.pieces(receiver.origin, receiver.axis)
    pieces = (light,) if given is None else given
    if not pieces:
        nothing = np.zeros_like(np.asarray(product(light)(receiver.axis[None, :]))[0])[()]
        return Estimate(nothing, nothing, "truncation", 1, method="none of the light is above the horizon")
    for k, piece in enumerate(pieces):
        share = (max_evaluations - sum(each.evaluations for each in found)) // (len(pieces) - k)
        now = time.perf_counter()
        until = now + (deadline - now) / (len(pieces) - k)
        value = product(piece)
        seen = look(piece, receiver, value if peaked else None, width=width, towards=towards)
        seen = replace(seen, kinks=seen.kinks or given is None)
        limits: dict[str, Any] = {
            "max_evaluations": max(share, _LEAST),
            "refinement": refinement,
            "deadline": until,
        }
        found.append(_over_piece(value, piece, receiver, seen, rtol=rtol, smooth=smooth, **limits))
    total = reduce(operator.add, found)
    converged = total.converged or bool(np.all(total.error <= rtol * np.abs(total.value)))
    note = UNKNOWN if given is None else total.note
    return replace(total, converged=converged, note="" if converged else note)


def _over_piece(
    product: Callable[[FloatArray], Any],
    piece: Emitter,
    receiver: Receiver,
    seen: Lookout,
    *,
    max_evaluations: int,
    **options: Any,
) -> Estimate:
    """Integrate over the square of a single piece."""

    def integrand(u: FloatArray) -> Any:
        directions, density = piece.sample(u, receiver.origin)
        value = np.asarray(product(directions))
        share = np.divide(1.0, density, out=np.zeros_like(density), where=density > 0)
        return (value.T * share).T

    found = crowded_square(
        integrand,
        axes=seen.axes,
        foci=seen.foci,
        kinks=seen.kinks,
        max_evaluations=max_evaluations - seen.evaluations,
        **options,
    )
    error = found.error + getattr(piece, "precision", 0.0) * np.abs(found.value)
    if seen.kinks and not np.any(found.value):
        edge, _ = piece.sample(edges(), receiver.origin)
        most = np.max(np.abs(np.asarray(product(edge))), axis=0)
        error = error + most * piece.solid_angle(receiver.origin).value  # a sliver above the horizon
    where = "the light, around the lobe" if seen.foci else "the light"
    return replace(
        found,
        error=error,
        evaluations=found.evaluations + seen.evaluations,
        method=f"{found.method} over {where}",
    )
