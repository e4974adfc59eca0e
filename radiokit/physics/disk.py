"""Disk: what a disk of uniform radiance gives to a point, whole or cut by the receiver's horizon."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
import numpy.typing as npt

from radiokit.facts.source import Source
from radiokit.measure.exact import RationalVector, cross, inner, rational, root

__all__ = ["DISK_SOURCE", "SOLID_ANGLE_SOURCE", "DiskView", "Horizon", "against", "panels"]

FloatArray = npt.NDArray[np.float64]

DISK_SOURCE = Source(
    authors="Lambert",
    year=1760,
    title="Photometria, sive de mensura et gradibus luminis, colorum et umbrae",
    equation="E/L = ½∮ n·(r × dr)/r², around the disk: its integrand is a ratio of first harmonics",
)
SOLID_ANGLE_SOURCE = Source(
    authors="Carlson",
    year=1995,
    title="Numerical computation of real or complex elliptic integrals",
    doi="10.1007/BF02198293",
    equation="R_J by duplication",
)

_EPS = float(np.finfo(float).eps)
_X, _W = (0.5 * (x + shift) for x, shift in zip(np.polynomial.legendre.leggauss(20), (1.0, 0.0), strict=True))
_ENDLESS = 1e14  # distances to its plane that a disk's edge is away, for it to be as good as endless
_LEVELS = 80
_MOST = 300_000  # evaluations after which the bound is what the last halves leave


@dataclass(frozen=True, kw_only=True)
class DiskView:
    """A disk from a point in front of it.

    Parameters
    ----------
    radius : float
        R, above 0; all lengths in any one unit.
    depth, offset : float
        a above 0 and b at least 0: the centre's distances from the point, across the disk's plane and along.
    rim, power : float
        b − R and a² + b² − R², which the caller knows without cancellation.
    """

    radius: float
    depth: float
    offset: float
    rim: float
    power: float

    @cached_property
    def reach(self) -> tuple[float, float]:
        """The least and the largest distance from the point to the disk's edge."""
        return math.hypot(self.depth, self.rim), math.hypot(self.depth, self.offset + self.radius)

    @cached_property
    def _sum(self) -> float:
        """K = Q + a² + b² − R², with Q the product of the two distances."""
        product = self.reach[0] * self.reach[1]
        if self.power > 0:
            return product + self.power
        return (2 * self.depth * self.radius) ** 2 / (product - self.power)

    @cached_property
    def semi_axes(self) -> tuple[float, float]:
        """The half-widths A ≤ B of the cone at distance 1 along its axis: in the plane of offset, and across.

        The extreme rays in the plane of offset enclose 2 atan A, and sin² of half that is 2a²R²/QK; the other
        one follows from the cone's section.
        """
        return 2 * self.depth * self.radius / self._sum, self.radius * math.sqrt(2 / self._sum)

    def solid_angle(self) -> float:
        """Return Ω = 4/3 AB R_J(0, 1 + A², 1 + B², 1) [sr], a single term.

        Strips across the cone's section give Ω = 4AB ∫ cos²θ dθ / ((1 + A² sin²θ) √(1 + A² sin²θ + B² cos²θ))
        over a quarter turn, and t = tan²θ makes it Carlson's integral (1995), as SciPy computes it.

        >>> half = DiskView(radius=1.0, depth=1.0, offset=0.0, rim=-1.0, power=0.0)
        >>> round(half.solid_angle() / (2 * math.pi * (1 - math.sqrt(0.5))), 14)
        1.0
        """
        from scipy.special import elliprj

        a, b = (min(half, 1e100) for half in self.semi_axes)
        scale = max(1.0, a)  # R_J is homogeneous: keep its arguments within the range of floats
        value = elliprj(0.0, (1 + a * a) / scale**2, (1 + b * b) / scale**2, 1 / scale**2)
        return float(4.0 / 3.0 * (a / scale) * (b / scale) * value / scale)

    def facing(self) -> float:
        """Return E/L [sr] on a receiver that is parallel to the disk and faces it: π sin²α, α = atan A."""
        nearest, farthest = self.reach
        return 2 * math.pi * (self.depth / nearest) * (self.depth / farthest) * self.radius**2 / self._sum

    def whole(self, *, height: float, facing: float) -> float:
        """Return E/L [sr] on a receiver that sees the whole disk.

        Of ``height`` of the disk's centre above its horizon, and cosine ``facing`` between its normal and the
        way across to the disk's plane. The sum keeps its digits: its second term is at most half the first
        where it is negative.
        """
        nearest, farthest = self.reach
        middle = 0.5 * (nearest + farthest)
        lifted = height + facing * self.depth * 2 * self.radius**2 / self._sum
        return math.pi * self.depth / nearest * (self.radius / middle) ** 2 * lifted / farthest

    def cut(self, *, turn: float, slope: float, facing: float, aside: float) -> tuple[float, float, int]:
        """Return E/L [sr] on a receiver whose horizon cuts the disk, its error, and the evaluations.

        Turn the receiver about the horizon's chord: E″ + E = C, the integral of cos² along the chord, so that
        E = ∫ sin(τ₁ − τ) C(τ) dτ from where the horizon touches the disk. Every term is positive, however
        thin the part that is seen.

        Parameters
        ----------
        turn : float
            Half the angle of the disk's edge that is above the horizon [rad], in (0, π).
        slope, facing : float
            Sine and cosine of the angle between the receiver's normal and the way across to the plane.
        aside : float
            How far the centre is from the point along the chord.
        """
        if -self.rim > _ENDLESS * self.depth:
            # All but a band along its plane, at most 2π a/(R − b), of the half-space of an endless plane.
            lit = 0.5 * (1.0 + facing) if facing > 0 else 0.5 * slope * slope / (1.0 - facing)
            band = 2 * math.pi * self.depth / -self.rim
            return math.pi * lit, band + 8 * _EPS * math.pi * lit, 1
        a, radius, last = self.depth, self.radius, -self.depth * facing / slope

        def strip(psi: FloatArray, rest: FloatArray) -> FloatArray:
            rise = 2 * radius * np.sin(0.5 * rest) * np.sin(turn - 0.5 * rest)  # above the last chord
            length = np.hypot(a, last + rise)
            half = radius * np.sin(psi)
            left, right = aside - half, aside + half
            angle = np.arctan2(2 * length * half, length * length + left * right)
            middle = 0.5 * (np.arctan2(length, left) + np.arctan2(length, right))
            chord = 0.5 * (_bulge(angle) + 2 * np.sin(angle) * np.sin(middle) ** 2)
            value = slope * rise / length * chord * (a / length) * (half / length)
            return np.stack((value, value * abs(last) / length))

        (value, shaken), error, evaluations = panels(strip, turn)
        return value, error + _EPS * (64 * value + 8 * shaken), evaluations


@dataclass(frozen=True)
class Horizon:
    """A receiver's horizon beside a disk: squares and inner products without rounding, and what follows.

    ``along`` and ``towards`` are the inner products of the receiver's normal ``up``, of squared length
    ``length``, with the ways to the centre and across to the disk's plane. The horizon cuts the disk where
    ``hidden`` is above 0. ``slope`` and ``facing`` are sine and cosine of the angle between the normal and
    the way across, and ``aside`` how far the centre is from the receiver along the chord.
    """

    up: RationalVector
    length: Fraction
    along: Fraction
    towards: Fraction
    hidden: Fraction
    slope: float
    facing: float
    aside: float

    @property
    def turn(self) -> float:
        """Half the angle of the disk's edge that is above the horizon [rad]."""
        return math.atan2(root(self.hidden), math.copysign(root(self.along * self.along), -self.along))


def against(
    normal: npt.ArrayLike, disk_normal: RationalVector, towards: RationalVector, radius: Fraction
) -> Horizon:
    """Return the horizon of a receiver with this normal beside a disk whose centre is ``towards`` it."""
    n, v, m = rational(np.asarray(normal, dtype=float).tolist()), towards, disk_normal
    length, across = inner(n, n), inner(m, m)
    along, opposite, chord = inner(n, v), -inner(n, m), cross(n, m)
    steep = inner(chord, chord) / across  # the square of the normal's part in the disk's plane
    return Horizon(
        up=n,
        length=length,
        along=along,
        towards=opposite,
        hidden=radius**2 * steep - along * along,
        slope=root(steep / length),
        facing=math.copysign(root(opposite * opposite / (length * across)), opposite),
        aside=root(inner(chord, v) ** 2 / inner(chord, chord)) if steep else 0.0,
    )


def _bulge(angle: FloatArray) -> FloatArray:
    """Return x − sin x for x in [0, π]."""
    square = angle * angle
    series = np.ones_like(angle)
    for n in range(11, 1, -1):
        series = 1 - square / (2 * n * (2 * n + 1)) * series
    return np.where(angle < 1.0, angle * square / 6 * series, angle - np.sin(angle))


def panels(
    integrand: Callable[[FloatArray, FloatArray], FloatArray], end: float
) -> tuple[FloatArray, float, int]:
    """Integrate positive functions (K, N) over [0, end] by bisection, to rounding of the first of them.

    ``integrand`` takes the place and what is left to ``end``, each without cancellation. Returns the values
    (K,), the bound of the first, and the evaluations.
    """
    left, width = np.zeros(1), np.ones(1)
    coarse = _rule(integrand, left, width, end)
    total, error, evaluations = np.zeros(len(coarse)), 0.0, len(_X)
    for level in range(_LEVELS):
        halves = np.stack((left, left + 0.5 * width))
        fine = _rule(integrand, halves.ravel(), np.repeat(0.5 * width[None], 2, axis=0).ravel(), end)
        fine = fine.reshape(len(coarse), 2, -1)
        evaluations += fine.shape[1] * fine.shape[2] * len(_X)
        both = fine.sum(axis=1)
        gap = np.abs(both - coarse)[0]
        size = total[0] + both[0].sum()
        good = gap <= 4 * _EPS * size
        if level == _LEVELS - 1 or evaluations > _MOST:
            good[:] = True
        total += both[:, good].sum(axis=1)
        error += float(gap[good].sum())
        left, width = halves[:, ~good].ravel(), np.tile(0.5 * width[~good], 2)
        coarse = fine[:, :, ~good].reshape(len(coarse), -1)
        if not len(left):
            break
    return total, error, evaluations


def _rule(
    integrand: Callable[[FloatArray, FloatArray], FloatArray],
    left: FloatArray,
    width: FloatArray,
    end: float,
) -> FloatArray:
    share = left[:, None] + width[:, None] * _X
    rest = (1 - left - width)[:, None] + width[:, None] * (1 - _X)
    values = integrand(end * share, end * rest)
    result: FloatArray = end * width * np.sum(values * _W, axis=-1)
    return result
