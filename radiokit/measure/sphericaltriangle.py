"""Spherical triangle: the warp of the unit square onto the directions to a flat triangle."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.directions import dot, unit
from radiokit.facts.errors import ParameterError
from radiokit.facts.source import Source
from radiokit.measure.warp import ROUNDING, Warp

__all__ = ["UniformSphericalTriangle"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class UniformSphericalTriangle(Warp):
    """Directions (N, 3) of equal density per solid angle towards a triangle, as seen from the origin.

    The first number cuts the triangle abc from b to a point c' on the side ac, so that abc' has that share of
    the solid angle; the second goes along bc'. With t the angle from a to c', van Oosterom's and Strackee's
    tan(Ω'/2) is a fraction linear in tan(t/2), so c' needs no arccosine and small triangles keep their shape.

    Parameters
    ----------
    vertices : array_like, shape (3, 3)
        The corners a, b, c as seen from the origin; their lengths do not matter.

    Raises
    ------
    ParameterError
        When they are not three finite vectors other than 0, or two of them have opposite directions.

    >>> warp = UniformSphericalTriangle(vertices=np.eye(3))
    >>> round(warp.solid_angle / np.pi, 15), warp.sample([[0.5, 0.0], [0.5, 1.0]]).round(6).tolist()
    (0.5, [[0.0, 1.0, 0.0], [0.707107, 0.0, 0.707107]])
    """

    vertices: Any
    solid_angle: float = field(init=False, repr=False, compare=False)
    _u: FloatArray = field(init=False, repr=False, compare=False)
    _along: FloatArray = field(init=False, repr=False, compare=False)  # at a, towards c
    _form: tuple[float, float, float] = field(init=False, repr=False, compare=False)

    SOURCE = Source(
        authors="Arvo",
        year=1995,
        title="Stratified Sampling of Spherical Triangles",
        doi="10.1145/218380.218500",
        equation="figure 2, with the angles found from tan(Ω/2)",
    )

    def __post_init__(self) -> None:
        allowed = "three finite vectors (3, 3) other than 0, no two of opposite directions"
        try:
            v = np.array(self.vertices, dtype=np.float64)
        except (TypeError, ValueError):
            raise ParameterError("vertices", self.vertices, allowed) from None
        if v.shape != (3, 3) or not np.isfinite(v).all() or not v.any(axis=1).all():
            raise ParameterError("vertices", v.tolist(), allowed)
        v = np.ldexp(v, -np.frexp(np.abs(v).max())[1])
        a, b, c = u = np.stack([unit(corner) for corner in v])
        if min(_length(a + b), _length(b + c), _length(c + a)) == 0.0:
            raise ParameterError("vertices", v.tolist(), allowed)
        # From differences of the corners themselves: they keep their digits where a triangle is small, or
        # so large that corners are nearly opposite.
        r = np.sqrt(dot(v, v))
        across = np.cross(v[0], v[2] - v[0]) / (r[0] * r[2])
        sine, cosine = _length(across), float(dot(a, c))
        along = np.cross(across, a) / max(sine, 5e-324)
        skew = _length(np.cross(v[0], v[1] - v[0])) / (r[0] * r[1])
        lean = float(dot(a, b))
        form = (
            abs(float(dot(np.cross(v[1] - v[0], v[2] - v[0]), a))) / max(r[1] * r[2] * sine, 5e-324),
            float(dot(along, v[1] - v[0])) / float(r[1]),
            1.0 + lean if lean > 0.0 else skew * skew / (1.0 - lean),  # 1 + a·b
        )
        object.__setattr__(self, "vertices", v)
        for name, value in {"_u": u, "_along": along, "_form": form}.items():
            object.__setattr__(self, name, value)
        half = (sine, 1.0 + cosine) if cosine > 0.0 else (1.0 - cosine, sine)
        whole = float(self._angle(np.array(half[0]), np.array(half[1])))
        object.__setattr__(self, "solid_angle", whole)

    @property
    def perimeter(self) -> float:
        """The sum of the chords between the corners' directions, about that of the sides [rad] if small."""
        sides = np.roll(self._u, -1, axis=0) - self._u
        return float(np.sum(np.sqrt(dot(sides, sides))))

    def _angle(self, sine: FloatArray, cosine: FloatArray) -> FloatArray:
        """Return the solid angle of abc', with tan(t/2) = sine/cosine."""
        height, lean, base = self._form
        return 2.0 * np.arctan2(sine * height, cosine * base + sine * lean)

    def _cut(self, t: FloatArray) -> FloatArray:
        """Return the vector from b to c'."""
        a, b, _ = self._u
        return (a - b) + np.sin(t)[..., None] * self._along - 2.0 * np.sin(0.5 * t)[..., None] ** 2 * a

    def _sample(self, u0: FloatArray, u1: FloatArray) -> FloatArray:
        b = self._u[1]
        height, lean, base = self._form
        half = 0.5 * u0 * self.solid_angle
        sine, cosine = np.sin(half), np.cos(half)
        chord = self._cut(2.0 * np.arctan2(sine * base, cosine * height - sine * lean))
        square = dot(chord, chord)
        way = chord + 0.5 * square[..., None] * b
        length = np.sqrt(dot(way, way))[..., None]
        near = 0.25 * u1 * square  # sin² of half the angle from b
        step = 2.0 * np.sqrt(near * (1.0 - near))[..., None]
        w = b + step * way / np.where(length > 0.0, length, 1.0) - 2.0 * near[..., None] * b
        return np.asarray(w / np.sqrt(dot(w, w))[..., None])

    def _pdf(self, points: FloatArray) -> FloatArray:
        if self.solid_angle == 0.0:
            return np.zeros(points.shape[:-1])
        u, after = self._u, np.roll(self._u, -1, axis=0)
        sides = points @ np.cross(u, after - u).T
        turn = np.sign(dot(u[0], np.cross(u[1] - u[0], u[2] - u[0])))
        inside = np.all(sides * turn >= -ROUNDING * np.sqrt(dot(after - u, after - u)), axis=-1)
        return np.where(inside, 1.0 / self.solid_angle, 0.0)

    def _invert(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        a, b, _ = self._u
        plane = np.cross(b, points - b)
        y, x = -(plane @ a), plane @ self._along
        t = np.arctan2(np.abs(y), np.where(y < 0.0, -x, x))
        share = self._angle(np.sin(0.5 * t), np.cos(0.5 * t)) / max(self.solid_angle, 5e-324)
        chord = self._cut(t)
        square = dot(chord, chord)
        return share, dot(points - b, points - b) / np.where(square > 0.0, square, 1.0)


def _length(v: FloatArray) -> float:
    return float(np.sqrt(dot(v, v)))
