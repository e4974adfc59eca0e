"""Lunes: regions of directions between planes and circular cones, with a hole or not, as smooth squares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.measure.circlecone import CircleCone
from radiokit.measure.exact import RationalVector, inner, rational
from radiokit.measure.gauss import gauss_legendre

__all__ = ["NODES", "Arc", "Region"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_TURN = 2 * np.pi
NODES = 48
"""Nodes along an arc with which it is measured."""

_SAME = 1e-12  # azimuths that are nearer than this to each other bound nothing


@dataclass(frozen=True, eq=False)
class Region:
    """The directions on the positive side of all ``planes``, within ``cone``, and outside of ``holes``.

    They are described by the angle θ from an ``axis`` and the azimuth φ about it. In a half-plane of azimuth
    each of them leaves an interval of θ, the ends of which are smooth functions of φ, except where another
    one takes over: the ``arcs`` end there.

    Parameters
    ----------
    axis : ndarray, shape (3,)
        A unit vector, inside all the holes, which therefore have a point in common.
    planes : sequence of rational vectors
        Normals of half-spaces.
    cone : CircleCone, optional
    holes : sequence of CircleCone

    >>> from fractions import Fraction
    >>> up = rational((0, 0, 1))
    >>> sky = Region(np.array([0.0, 0.0, 1.0]), [up], holes=[CircleCone(up, up, Fraction(1, 3))])
    >>> round(sum(arc.size for arc in sky.arcs) / np.pi, 14)  # 2 cos 30°
    1.73205080756888
    """

    axis: FloatArray
    planes: Sequence[RationalVector]
    cone: CircleCone | None = None
    holes: Sequence[CircleCone] = ()

    @cached_property
    def frame(self) -> FloatArray:
        """Rows (3, 3): azimuth 0, azimuth 90°, and the axis."""
        least = int(np.argmin(np.abs(self.axis)))
        first = np.cross(np.eye(3)[least], self.axis)
        first /= np.sqrt(first @ first)
        return np.stack((first, np.cross(self.axis, first), self.axis))

    @cached_property
    def _sides(self) -> FloatArray:
        """The planes' normals (P, 3) in the frame, each component to its own last digit."""
        rows = [rational(row) for row in self.frame]
        sides = [[float(x) for x in _small([inner(n, row) for row in rows])] for n in self.planes]
        return np.array(sides).reshape(-1, 3)

    @cached_property
    def _forms(self) -> list[FloatArray]:
        """The quadratic forms (3, 3) of the cone and the holes in the frame, which are above 0 inside."""
        return [self._form(cone) for cone in self._cones]

    @property
    def _cones(self) -> list[CircleCone]:
        return [*([] if self.cone is None else [self.cone]), *self.holes]

    def _form(self, cone: CircleCone) -> FloatArray:
        rows = [rational(row) for row in self.frame]
        own = [cone.level(row) for row in rows]
        flat = [
            own[i] if i == j else (cone.level(_plus(rows[i], rows[j])) - own[i] - own[j]) / 2
            for i in range(3)
            for j in range(3)
        ]
        return np.array([float(x) for x in _small(flat)]).reshape(3, 3)

    def bounds(self, azimuth: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the least and the largest θ (N,) of azimuths (N,); empty where the first is not below."""
        low, high = np.zeros(len(azimuth)), np.full(len(azimuth), np.pi)
        c, s = np.cos(azimuth), np.sin(azimuth)
        for x, y, z in self._sides:
            across = x * c + y * s
            if z >= 0:
                high = np.minimum(high, np.arctan2(z, -across))
            else:
                low = np.maximum(low, np.arctan2(-z, across))
        for cone, form in zip(self._cones, self._forms, strict=True):
            first, last = self._crossings(cone, form, c, s)
            if cone is self.cone:
                low, high = np.maximum(low, first), np.minimum(high, last)
            else:
                low = np.maximum(low, last)
        return low, high

    def _crossings(
        self, cone: CircleCone, form: FloatArray, c: FloatArray, s: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return where half-planes enter and leave a cone: A + 2Bt + Ct² = 0 with t = tanθ."""
        a = form[2, 2]
        b = form[0, 2] * c + form[1, 2] * s
        q = form[0, 0] * c * c + 2 * form[0, 1] * c * s + form[1, 1] * s * s
        square = b * b - a * q
        root = np.sqrt(np.maximum(square, 0.0))
        if a >= 0 and self.axis @ cone.way < 0:  # the cone is about the opposite way
            leave = np.where(b <= 0, np.arctan2(root - b, -q), np.arctan2(a, root + b))
            return np.pi - leave, np.full(len(c), np.pi)
        if a >= 0:
            return np.zeros(len(c)), np.where(b >= 0, np.arctan2(b + root, -q), np.arctan2(a, root - b))
        # (A + C)/2 + ((A − C)/2) cos2θ + B sin2θ is above 0 about its top, in the cone or its opposite.
        turn = np.arctan2(b, 0.5 * (a - q)) % _TURN
        width = np.arctan2(root, -0.5 * (a + q))
        first, last = 0.5 * (turn - width), 0.5 * (turn + width)
        middle = 0.5 * turn
        w = np.stack((np.sin(middle) * c, np.sin(middle) * s, np.cos(middle)), axis=-1) @ self.frame
        seen = (square > 0) & (w @ cone.way > 0)
        return np.where(seen, first, np.pi), np.where(seen, last, 0.0)

    @cached_property
    def arcs(self) -> list[Arc]:
        """The parts of the region, each between two azimuths at which nothing else takes over."""
        turns = sorted(float(t) % _TURN for t in self._corners())
        turns = [t for k, t in enumerate(turns) if not k or t - turns[k - 1] > _SAME]
        if not turns:
            ends = [(k * _TURN / 4, (k + 1) * _TURN / 4, False) for k in range(4)]
        else:
            ends = [(low, high, True) for low, high in pairwise([*turns, turns[0] + _TURN])]
            ends = [part for end in ends for part in _halved(*end)]
        found = [Arc(self, *end) for end in ends]
        return [arc for arc in found if arc.size > 0]

    def _corners(self) -> list[float]:
        """Return the azimuths at which two boundaries meet, or a half-plane touches the cone."""
        scale = self._scale()
        sides, forms = self._sides * scale, [form * np.outer(scale, scale) for form in self._forms]
        found: list[float] = []
        for k, side in enumerate(sides):
            for other in sides[:k]:
                w = np.cross(side, other)
                found += [np.arctan2(w[1], w[0]), np.arctan2(-w[1], -w[0])] if np.any(w[:2]) else []
            first, second = _span(side)
            for form in forms:
                basis = np.stack((first, second))
                for t in _zeros(basis @ form @ basis.T):
                    w = np.cos(t) * first + np.sin(t) * second
                    found += [np.arctan2(w[1], w[0])]
        for form in forms:
            if form[2, 2] < 0:  # the axis is outside
                found += _zeros(np.outer(form[2, :2], form[2, :2]) - form[2, 2] * form[:2, :2])
        for cone, other in combinations(self._cones, 2):
            found += [np.arctan2(w[1], w[0]) for w in other.meetings(cone, self.frame)]
        return found

    def _scale(self) -> FloatArray:
        """Return factors (3,) of the coordinates that make the cones about as wide as high."""
        if not self._forms:
            return np.ones(3)
        form = self._forms[-1]
        width = float(np.sqrt(np.abs(form[2, 2]) / max(np.abs(form[0, 0]), np.abs(form[1, 1]), 1e-300)))
        width = min(max(width, 1e-150), 1.0)
        return np.array([width, width, 1.0])


@dataclass(frozen=True, eq=False)
class Arc:
    """A part of a region, from one azimuth to another, as the image of the unit square.

    With ``smooth`` the azimuth is φ₀ + (φ₁ − φ₀) x²(3 − 2x), which makes the roots analytic that an interval
    of θ has where a half-plane touches the boundary.
    """

    region: Region
    start: float
    stop: float
    smooth: bool

    def sample(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn points (N, 2) of the square into directions (N, 3) and densities (N,) [sr⁻¹]."""
        azimuth, slope = self._azimuth(u[:, 0])
        low, high = self.region.bounds(azimuth)
        width = np.maximum(high - low, 0.0)
        theta = low + width * u[:, 1]
        sine = np.sin(theta)
        local = np.stack((sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(theta)), axis=-1)
        with np.errstate(divide="ignore"):
            density = 1.0 / (sine * width * slope)
        return local @ self.region.frame, density

    def _azimuth(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        span = self.stop - self.start
        if not self.smooth:
            return self.start + span * x, np.full(len(x), span)
        return self.start + span * x * x * (3 - 2 * x), 6 * span * x * (1 - x)

    def _measure(self, nodes: int) -> tuple[float, float]:
        """Return the solid angle [sr] and the length of the edges [rad], by a rule."""
        x, w = gauss_legendre(nodes)
        azimuth, slope = self._azimuth(x)
        low, high = self.region.bounds(azimuth)
        open_ = high > low
        rings = np.where(open_, 2 * np.sin(0.5 * (low + high)) * np.sin(0.5 * (high - low)), 0.0)
        edges = np.where(open_, np.sin(low) + np.sin(high) + (high - low), 0.0)
        return float(np.sum(w * slope * rings)), float(np.sum(w * slope * edges))

    @cached_property
    def _measured(self) -> tuple[float, float]:
        return self._measure(NODES)

    @property
    def size(self) -> float:
        """The solid angle [sr], by a rule of ``NODES`` nodes."""
        return self._measured[0]

    @property
    def spread(self) -> float:
        """How far a smaller rule is from ``size`` [sr]."""
        return abs(self.size - self._measure(2 * NODES // 3)[0])

    @property
    def precision(self) -> float:
        """What rounding of the boundaries may change, relative to the solid angle."""
        size, edges = self._measured
        return 8 * _EPS * (1 + edges / size) if size > 0 else 1.0


def _halved(low: float, high: float, smooth: bool) -> list[tuple[float, float, bool]]:
    """Return an interval of azimuths in parts of at most 120°."""
    n = max(1, int(np.ceil((high - low) / (_TURN / 3))))
    return [(low + (high - low) * k / n, low + (high - low) * (k + 1) / n, smooth) for k in range(n)]


def _zeros(form: FloatArray) -> list[float]:
    """Return the angles t in a turn at which the form of (cos t, sin t) is 0; none for a double zero."""
    mean, half, mixed = 0.5 * (form[0, 0] + form[1, 1]), 0.5 * (form[0, 0] - form[1, 1]), form[0, 1]
    room = mixed * mixed - form[0, 0] * form[1, 1]
    if not room > 0:
        return []
    way, width = np.arctan2(mixed, half), np.arctan2(np.sqrt(room), -mean)
    return [float(0.5 * (way + sign * width) + turn) for sign in (-1, 1) for turn in (0.0, np.pi)]


def _span(normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two perpendicular unit vectors in the plane of a normal."""
    least = int(np.argmin(np.abs(normal)))
    first = np.cross(np.eye(3)[least], normal)
    first /= np.sqrt(first @ first)
    second = np.cross(normal, first)
    return first, second / np.sqrt(second @ second)


def _plus(a: RationalVector, b: RationalVector) -> RationalVector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _small(values: list[Any]) -> list[Any]:
    """Return fractions over the largest of them."""
    largest = max(map(abs, values)) or 1
    return [value / largest for value in values]
