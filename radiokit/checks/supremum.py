"""Supremum: the largest directional albedo on one side, by a scan of stated step and refinement."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.checks.parts import Part, delta_share, flipped, parts, scattered
from radiokit.checks.probes import GRAZING, channels, polar
from radiokit.contracts.albedo import Side
from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.facts.estimate import Estimate
from radiokit.measure.converge import BLOCK
from radiokit.measure.slope import PROBE, find_lobe, slope_rule, turned

__all__ = ["STEP", "Extremum", "scan_supremum"]

STEP = np.deg2rad(0.15)
"""Step of the scan in polar angle [rad]: a gain in any window wider than this is seen."""

AZIMUTHS = 24
FINE, COARSE, CHEAP = 24, 16, 12
"""Nodes along each axis of the scan's two rules, and of the only rule when evaluations are dear."""

LONG = 3
"""Times as many nodes in azimuth where f is not isotropic: a lobe may be ten times as long as wide."""

MOST = 8
"""Scanned directions from which the search climbs."""

FEWEST = 19
"""Angles of the coarsest scan."""

ENOUGH = 300_000
"""Evaluations that tell which side of the limit an albedo is on, unless it is very near."""

THREE_RULES = 4096
"""Evaluations without which a quadrature cannot bound its error."""


@dataclass(frozen=True)
class Extremum:
    """Where the largest albedo was found, and what the scan saw on the way."""

    estimate: Estimate  # of the largest channel
    direction: FloatArray
    theta_deg: float
    phi_deg: float
    at_grazing: bool  # still rising at the last angle
    least: Estimate  # the smallest albedo that the scan saw, integrated again
    theta: FloatArray  # the scan's polar angles [rad]
    profile: FloatArray  # its largest albedo at each of them
    step_deg: float
    evaluations: int


def scan_supremum(
    f: BSDF, *, fixed: Side, turns: bool, budget: int, tolerance: float, below: bool = False
) -> Extremum:
    """Find the supremum of the directional albedo, with one of the two directions held fixed.

    Scans polar angles up to 89.99° (all azimuths too, unless ``turns`` says that f is isotropic) with two
    rules, climbs from the highest few by bounded optimisation, and integrates there with a bound. For a model
    that transmits the albedo is of both hemispheres together, and angles crowd at the critical one.

    Parameters
    ----------
    f : BSDF
    fixed : {"wo", "wi"}
    turns : bool
        Whether f is unchanged by a turn about the normal.
    budget : int
        Evaluations that may be spent; a smaller one gives a coarser scan, and says so.
    tolerance : float
        The error that the final integral should have.
    below : bool
        Whether the fixed direction is below the surface; the polar angle is then from the inner normal.
    """
    pieces = parts(f, fixed, below)
    sides = (1 if f.isotropic else 2) * len(pieces)
    least = sides * (FINE**2 + COARSE**2) * (GRAZING / STEP + 40)
    long = 1 if turns or 0.7 * budget < LONG * least else LONG
    rich = 0.7 * budget >= long * least
    fine, coarse = (FINE, COARSE) if rich else (CHEAP, 0)
    per_angle = long * sides * (fine**2 + coarse**2)
    affordable = int(0.7 * budget / per_angle)
    count = int(np.clip(affordable, FEWEST, GRAZING / STEP + 1))
    theta = np.linspace(0.0, GRAZING, count)
    step = float(theta[1])
    if rich:
        theta = np.union1d(theta, np.pi / 2 - np.geomspace(np.pi / 2 - GRAZING, 2 * STEP, 24))
        theta = np.union1d(theta, _critical(f, below))
    phi = np.full(len(theta), 0.3)
    if not turns:
        rows = max(9, min(120, (affordable - count) // AZIMUTHS))
        grid_t, grid_p = np.meshgrid(
            np.linspace(0.0, GRAZING, rows), np.arange(AZIMUTHS) * (2 * np.pi / AZIMUTHS), indexing="ij"
        )
        theta, phi = np.concatenate([theta, grid_t.ravel()]), np.concatenate([phi, grid_p.ravel()])

    aimed = [_aim(piece, theta, phi, rich) for piece in pieces]
    aims, evaluations = tuple(aim for aim, _ in aimed), sum(spent for _, spent in aimed)
    w = polar(np.cos(theta), phi)
    one = _scan(pieces, w, aims, 1.0, (fine, long * fine))
    two = _scan(pieces, w, aims, 1.3, (coarse, long * coarse)) if coarse else one
    evaluations += len(theta) * per_angle
    doubt = np.abs(one - two)
    # The ends, what is surely highest, and what may be higher still.
    sure, possible = (np.argsort(-(one + sign * doubt), kind="stable") for sign in (-1, 1))
    order = np.concatenate([[0, int(np.argmax(theta))], sure[:MOST], possible]) if rich else sure
    tops = _separate(order, theta, phi, step, MOST if rich else 1)

    best: Estimate | None = None
    place = w[0]
    left = budget - evaluations
    share = max(left // (2 * len(tops)), THREE_RULES)

    def integrate(index: int, direction: FloatArray, **tolerances: Any) -> Estimate:
        """Integrate with few evaluations, and with all that are left only where the limit is in doubt."""
        nonlocal evaluations
        widths = tuple(None if rich or aim.retro[index] else float(aim.width[index]) for aim in aims)
        for most in dict.fromkeys((min(share, ENOUGH), share)):
            found = scattered(
                f,
                flipped(direction, below),
                fixed=fixed,
                widths=widths,
                max_evaluations=most,
                **tolerances,
            )
            evaluations += found.evaluations
            if found.converged or np.all(np.abs(found.value - 1) > found.error + tolerance):
                break
        return found

    for index in tops:
        most = left // (8 * len(tops))
        direction, spent = _refined(pieces, theta, phi, aims, index, step, turns, most, long)
        evaluations += spent
        for candidate in (w[index], direction):
            found = _worst_channel(integrate(index, candidate, rtol=0.0, atol=tolerance))
            if best is None or found.value - found.error > best.value:  # a tie keeps the first
                best, place = found, candidate
            if np.array_equal(direction, w[index]):
                break
    assert best is not None
    lowest = int(np.argmin(one))
    least = integrate(lowest, w[lowest], rtol=1e-6)
    angle = float(np.arctan2(np.hypot(place[0], place[1]), place[2]))
    last = float(theta.max())
    return Extremum(
        estimate=best,
        direction=flipped(place, below),
        theta_deg=float(np.rad2deg(angle)),
        phi_deg=float(np.rad2deg(np.arctan2(place[1], place[0]))),
        at_grazing=bool(angle >= last - 1e-9 and _rises(theta, one)),
        least=_worst_channel(least, -1),
        theta=theta,
        profile=one,
        step_deg=float(np.rad2deg(step)),
        evaluations=evaluations,
    )


def _rises(theta: FloatArray, profile: FloatArray) -> bool:
    order = np.argsort(theta)
    return bool(profile[order[-1]] > profile[order[-2]])


@dataclass(frozen=True)
class _Aim:
    """A part's lobe width, and whether it is a retro-reflective one, at each scanned direction."""

    width: FloatArray
    retro: npt.NDArray[np.bool_]

    def __getitem__(self, index: slice) -> _Aim:
        return _Aim(self.width[index], self.retro[index])


def _critical(f: BSDF, below: bool) -> FloatArray:
    """Return angles that crowd at the critical one, if there is one on this side."""
    eta = 1 / f.relative_index() if below else f.relative_index()  # the other side's index over this one's
    if not f.transmissive or eta >= 1:
        return np.zeros(0)
    angle = np.arctan2(eta, np.sqrt((1 - eta) * (1 + eta)))
    gap = np.geomspace(1e-6, STEP, 12)
    near: FloatArray = np.concatenate([angle - gap, angle + gap])
    return near[(near > 0) & (near < GRAZING)]


def _aim(part: Part, theta: FloatArray, phi: FloatArray, rich: bool) -> tuple[_Aim, int]:
    """Return where to aim at every angle: by the model's own word, or found at some and interpolated."""
    known = None if part.through else part.f.lobe_width()
    if known is not None:
        return _Aim(np.full(len(theta), known), np.zeros(len(theta), dtype=bool)), 0
    knots = np.deg2rad([*np.linspace(0.0, 85.0, 7), 89.0, 89.9] if rich else [0.0, 60.0, 89.0])
    probe = PROBE if rich else (24, 6)
    places = polar(np.cos(knots), np.full(len(knots), phi[0]))
    found = [find_lobe(part.integrand(w), part.aim(w), probe) for w in places]
    width = np.exp(np.interp(theta, knots, np.log([lobe.width for lobe in found])))
    retro = np.interp(theta, knots, [float(lobe.retro) for lobe in found]) > 0.5
    return _Aim(width, retro), sum(lobe.evaluations for lobe in found)


def _scan(
    pieces: tuple[Part, ...], w: FloatArray, aims: tuple[_Aim, ...], scale: float, n: tuple[int, int]
) -> FloatArray:
    """Integrate at every direction of ``w`` (M, 3) with one rule; the largest channel of each."""
    first = pieces[0]
    blocks = _blocks(len(w), 2 * n[0] * n[1])
    found = []
    for block in blocks:
        sums = delta_share(first.f, flipped(w[block], first.below))
        for part, aim in zip(pieces, aims, strict=True):
            sums = sums + _integrals(part, w[block], aim[block], scale, n)
        found.append(sums.max(axis=1))
    return np.concatenate(found)


def _blocks(count: int, cost: int) -> Iterator[slice]:
    size = max(1, BLOCK // cost)
    for start in range(0, count, size):
        yield slice(start, start + size)


def _integrals(part: Part, w: FloatArray, aim: _Aim, scale: float, n: tuple[int, int]) -> FloatArray:
    other, weight = slope_rule(part.aim(w), scale * aim.width, n, symmetric=part.f.isotropic)
    other[aim.retro] = turned(other[aim.retro])
    flat = other.reshape(-1, 3)
    held = np.repeat(w, other.shape[1], axis=0)
    terms = channels(part.values(held, flat)) * (flat[:, 2] * weight.ravel())[:, None]
    sums: FloatArray = terms.reshape(len(w), -1, terms.shape[1]).sum(axis=1)
    return sums


def _separate(order: Any, theta: FloatArray, phi: FloatArray, step: float, most: int) -> list[int]:
    """Pick the highest few that are no neighbours of one another."""
    picked: list[int] = []
    for index in order:
        apart = [
            abs(theta[index] - theta[old]) > 3 * step or abs(phi[index] - phi[old]) > np.pi / AZIMUTHS
            for old in picked
        ]
        if all(apart):
            picked.append(int(index))
        if len(picked) == most:
            break
    return picked


def _refined(
    pieces: tuple[Part, ...],
    theta: FloatArray,
    phi: FloatArray,
    aims: tuple[_Aim, ...],
    index: int,
    step: float,
    turns: bool,
    budget: int,
    long: int,
) -> tuple[FloatArray, int]:
    """Climb from a scanned angle to the highest albedo between its neighbours."""
    from scipy.optimize import minimize, minimize_scalar

    n = 32 if budget > 60_000 else CHEAP
    cost = long * n * n * len(pieces) * (1 if pieces[0].f.isotropic else 2)
    here = tuple(aim[index : index + 1] for aim in aims)
    start = polar(np.cos(theta[index : index + 1]), phi[index : index + 1])[0]
    evaluations = int(min(budget // cost, 25))
    if evaluations < 5:
        return start, 0
    low, high = max(0.0, theta[index] - step), min(GRAZING, theta[index] + step)
    spent = 0

    def negative(t: float, p: float) -> float:
        nonlocal spent
        spent += cost
        w = polar(np.cos([t]), [p])
        return -float(_scan(pieces, w, here, 1.0, (n, long * n))[0])

    if turns:
        found = minimize_scalar(
            negative,
            bounds=(low, high),
            args=(phi[index],),
            method="bounded",
            options={"maxiter": evaluations, "xatol": 1e-7},
        )
        best = found.x, phi[index], found.fun
    else:
        wide = 2 * np.pi / AZIMUTHS
        result: Any = minimize(
            lambda x: negative(x[0], x[1]),
            [theta[index], phi[index]],
            bounds=[(low, high), (phi[index] - wide, phi[index] + wide)],
            method="Nelder-Mead",
            options={"maxfev": 3 * evaluations, "xatol": 1e-6},
        )
        best = result.x[0], result.x[1], result.fun
    if -best[2] <= -negative(theta[index], phi[index]):
        return start, spent
    return polar(np.cos([best[0]]), [best[1]])[0], spent


def _worst_channel(estimate: Estimate, sign: int = 1) -> Estimate:
    """Return the channel that reaches highest, or lowest for a negative sign."""
    if np.ndim(estimate.value) == 0:
        return estimate
    value, error = np.asarray(estimate.value), np.broadcast_to(estimate.error, np.shape(estimate.value))
    k = int(np.argmax(sign * value - error))
    return replace(estimate, value=float(value[k]), error=float(error[k]))
