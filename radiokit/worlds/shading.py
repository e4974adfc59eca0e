"""Shading: the radiance that a material sends to the viewer, by the cheapest method that can say it."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter
from radiokit.contracts.occluder import Occluder, check_occluders
from radiokit.facts.estimate import Estimate
from radiokit.measure.montecarlo import seed_from
from radiokit.worlds.planning import Plan, Row, make_plan
from radiokit.worlds.scene import Receiver, behind

__all__ = ["explain", "shade"]


def shade(
    f: Any,
    emitters: Emitter | Iterable[Emitter],
    wo: npt.ArrayLike,
    *,
    normal: npt.ArrayLike = (0.0, 0.0, 1.0),
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    method: str = "auto",
    rtol: float = 1e-6,
    samples: int | None = None,
    rng: int | np.random.Generator | None = None,
    executor: Executor | None = None,
    occluders: Occluder | Iterable[Occluder] = (),
) -> Estimate:
    """Return the radiance Lo = ∫ f L cosθ dω [W m⁻² sr⁻¹] that a surface reflects towards ``wo``.

    Each light makes one term, or two if the material has delta lobes. Delta lights are summed and delta
    lobes are looked up, whatever ``method`` says, for there is nothing to integrate; a delta light on a
    delta lobe is a pair of measure zero and adds 0. The rest goes by ``method``; ``explain`` tells which one
    ``auto`` takes and why.

    Only delta lobes reach below the horizon, and see there the basic radiance L/n²; the smooth part of a
    material is taken to reflect.

    Parameters
    ----------
    f : BSDF or callable
        The material, f(wi, wo) [sr⁻¹].
    emitters : Emitter or iterable of Emitter
        The lights; none give 0.
    wo : array_like, shape (3,)
        Unit vector to the viewer in world coordinates.
    normal : array_like, shape (3,)
        The surface's normal in world coordinates; any length but 0.
    position : array_like, shape (3,)
        Where the surface is [m].
    method : str
        ``auto``, ``sum``, ``closed form``, ``quadrature``, ``mc-bsdf`` (samples of the material),
        ``mc-light`` (of the light), ``mis`` (of both, by the balance heuristic), ``mc``, the best of these,
        or ``qmc``, the same with low-discrepancy points.
    rtol : float
        Relative tolerance of each term, in (0, 1).
    samples : int, optional
        Monte Carlo draws exactly so many for each term; ``qmc`` rounds down to 16 times a power of 2.
        Without it, it stops at ``rtol`` or after 2²⁰.
    rng : int, numpy.random.Generator or None
        For Monte Carlo.
    executor : concurrent.futures.Executor, optional
        Runs the blocks of Monte Carlo; the answer does not depend on it.
    occluders : Occluder or iterable of Occluder, optional
        Opaque bodies between the lights and the surface; what they would reflect does not count.

    Returns
    -------
    Estimate
        Of shape () or (K,). ``converged`` is False when ``rtol`` was not reached.

    Raises
    ------
    ParameterError
        When an argument is not allowed, or the surface lies on a light or an occluder.
    UnknownNameError
        When there is no such method.
    RadiokitError
        When the method cannot compute a term; the message says which can.

    Source: Kajiya (1986), The rendering equation, doi:10.1145/15886.15902, for the integral; Veach, Guibas
    (1995), doi:10.1145/218380.218498, section 3.2, for the balance heuristic.

    >>> from radiokit.emitters.constant import Constant
    >>> from radiokit.emitters.point import Point
    >>> half = lambda wi, wo: 0.5 / np.pi
    >>> lights = [Constant(radiance=1.0), Point(position=(0, 0, 2), intensity=4 * np.pi)]
    >>> round(float(shade(half, lights, (0.0, 0.6, 0.8))), 9)  # 0.5 · 1 + 0.5/π · π
    1.0
    """
    plan = make_plan(
        f,
        _behind(emitters, occluders, position),
        wo,
        normal=normal,
        position=position,
        method=method,
        rtol=rtol,
        samples=samples,
    )
    generator = np.random.default_rng(seed_from(rng))
    total: Estimate | None = None
    for row in plan.rows:
        found = _compute(row, method, rtol, samples, generator, executor)
        total = found if total is None else total + found
    return Estimate(0.0, 0.0, "rounding", method="sum", note="no light") if total is None else total


def _behind(emitters: Any, occluders: Any, position: Any) -> Any:
    """Return lights as they are seen behind occluders; as they are given, if there is none."""
    found = check_occluders(occluders)
    if not found:
        return emitters
    receiver = Receiver(position=position)
    lights = [emitters] if isinstance(emitters, Emitter) else list(emitters)
    return [behind(light, found, receiver) for light in lights]


def _compute(
    row: Row,
    method: str,
    rtol: float,
    samples: int | None,
    rng: np.random.Generator,
    executor: Executor | None,
) -> Estimate:
    term = row.term
    if row.method == "sum":
        viewer_below = term.part == "smooth"
        return term.zero("the viewer is not above the horizon") if viewer_below else term.add_up()
    if row.method == "closed form":
        return term.closed_form()
    if row.method != "quadrature":
        return term.monte_carlo(row.method, rtol=rtol, samples=samples, rng=rng, executor=executor)
    found = term.quadrature(rtol)
    if found.converged or method != "auto":
        return found
    # What quadrature cannot resolve is left to Monte Carlo, if that is nearer to the truth.
    sampled = term.monte_carlo("mis", rtol=rtol, samples=samples, rng=rng, executor=executor)
    if np.all(4 * sampled.error < found.error):
        note = f"quadrature reached only ± {np.max(found.error):.2g}: {found.note}"
        chosen, other = sampled, found
    else:
        note, chosen, other = found.note, found, sampled
    return replace(
        chosen,
        evaluations=found.evaluations + sampled.evaluations,
        seconds=chosen.seconds + other.seconds,
        note="; ".join(filter(None, (note, chosen.note if chosen is sampled else ""))),
    )


def explain(
    f: Any,
    emitters: Emitter | Iterable[Emitter],
    wo: npt.ArrayLike | None = None,
    *,
    normal: npt.ArrayLike = (0.0, 0.0, 1.0),
    position: npt.ArrayLike = (0.0, 0.0, 0.0),
    method: str = "auto",
    rtol: float = 1e-6,
    samples: int | None = None,
    occluders: Occluder | Iterable[Occluder] = (),
) -> Plan:
    """Return the plan that ``shade`` would follow with the same arguments: a row for each term.

    Parameters
    ----------
    f, emitters, normal, position, method, rtol, samples, occluders
        As in ``shade``.
    wo : array_like, shape (3,), optional
        Unit vector to the viewer; along the normal when not given.

    Raises
    ------
    RadiokitError
        As ``shade`` does.

    >>> from radiokit.emitters.point import Point
    >>> print(explain(lambda wi, wo: 0.5 / np.pi, [Point(position=(0, 0, 2), intensity=1.0)]))
    as_bsdf(<lambda>), relative tolerance 1e-06
      point, delta light: sum, about 1 evaluations
        because the light arrives from single directions: the integral is a sum
        also possible: nothing
    """
    return make_plan(
        f,
        _behind(emitters, occluders, position),
        wo,
        normal=normal,
        position=position,
        method=method,
        rtol=rtol,
        samples=samples,
    )
