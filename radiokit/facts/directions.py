"""Directions: unit vectors, angles, frames and caps, without losing digits.

``check_directions``, ``unit``, ``frame``, the spherical coordinates and the caps check what they are given.
The other functions are kernels: they trust vectors to be of unit length, as a model's ``evaluate`` does.
``dot`` comes from ``triples``, ``reflect`` and ``refract`` from ``deflection``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject, vectors
from radiokit.facts.deflection import reflect, refract
from radiokit.facts.source import Source
from radiokit.facts.triples import cross, dot, every, length, normalise

__all__ = [
    "FRAME_SOURCE",
    "UNIT_TOLERANCE",
    "angle_between",
    "cap_half_angle",
    "cap_solid_angle",
    "cartesian_to_spherical",
    "check_directions",
    "dot",
    "frame",
    "half_vector",
    "reflect",
    "refract",
    "spherical_to_cartesian",
    "to_local",
    "to_world",
    "unit",
]

FloatArray = npt.NDArray[np.float64]

UNIT_TOLERANCE = 1e-6
"""How far a direction's length may be from 1: room for vectors that were normalised in float32."""

FRAME_SOURCE = Source(
    authors="Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin",
    year=2017,
    title="Building an Orthonormal Basis, Revisited. Journal of Computer Graphics Techniques 6(1)",
    equation="Listing 3",
)


def check_directions(name: str, value: npt.ArrayLike) -> FloatArray:
    """Return ``value`` as float64 directions, unchanged, once each is known to be a unit vector.

    Parameters
    ----------
    name : str
        What the error message calls the argument.
    value : array_like, shape (..., 3)
        Lengths may differ from 1 by ``UNIT_TOLERANCE``.

    Raises
    ------
    ParameterError
        Naming the argument, the first offending direction, and what is allowed.

    >>> check_directions("wo", [0, 0, 1])
    array([0., 0., 1.])
    >>> check_directions("wo", [[0, 0, 1], [0, 0, 2]])
    Traceback (most recent call last):
    ...
    radiokit.facts.errors.ParameterError: wo[1] = (0.0, 0.0, 2.0) is not allowed: it must be a finite unit \
vector of shape (..., 3)
    """
    allowed = "a finite unit vector of shape (..., 3)"
    array = vectors(name, value, allowed)
    with np.errstate(over="ignore", invalid="ignore"):
        good = np.abs(np.sqrt(dot(array, array)) - 1.0) <= UNIT_TOLERANCE
    reject(name, array, np.asarray(~good), allowed)
    return array


def unit(v: npt.ArrayLike) -> FloatArray:
    """Return vectors ``v`` (..., 3) scaled to length 1, however long or short they are.

    Raises
    ------
    ParameterError
        When a vector is zero or not finite.

    >>> unit([0.0, 3e-300, 4e-300])
    array([0. , 0.6, 0.8])
    """
    allowed = "a finite vector of shape (..., 3) other than zero"
    array = vectors("v", v, allowed)
    bad = ~every(np.isfinite(array)) | every(array == 0.0)
    reject("v", array, np.asarray(bad), allowed)
    return normalise(array)


def spherical_to_cartesian(theta: npt.ArrayLike, phi: npt.ArrayLike) -> FloatArray:
    """Return the directions at polar angle ``theta`` from z and azimuth ``phi`` from x.

    Parameters
    ----------
    theta : array_like
        [rad], in [−π, π]; a negative angle is the positive one on the other side of the axis.
    phi : array_like
        [rad], finite; broadcast against ``theta``.

    Raises
    ------
    ParameterError
        When an angle is not finite, or ``theta`` is so large that it must be in degrees.

    >>> spherical_to_cartesian(0.0, 1.0)
    array([0., 0., 1.])
    """
    allowed = "an angle in [-pi, pi] radians"
    polar = numbers("theta", theta, allowed)
    reject("theta", polar, np.asarray(~(np.abs(polar) <= np.pi + UNIT_TOLERANCE)), allowed)
    azimuth = numbers("phi", phi, "a finite angle in radians")
    reject("phi", azimuth, np.asarray(~np.isfinite(azimuth)), "a finite angle in radians")
    polar, azimuth = np.broadcast_arrays(polar, azimuth)
    sine = np.sin(polar)
    return np.stack((sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(polar)), axis=-1)


def cartesian_to_spherical(w: npt.ArrayLike) -> tuple[Any, Any]:
    """Return polar angle [rad] in [0, π] and azimuth [rad] in (−π, π] of directions ``w`` (..., 3).

    The azimuth on the axis itself is 0.

    Raises
    ------
    ParameterError
        When a direction is not a finite unit vector.

    >>> theta, phi = cartesian_to_spherical([0.0, 1.0, 0.0])
    >>> round(float(theta), 15), round(float(phi), 15)
    (1.570796326794897, 1.570796326794897)
    """
    w = check_directions("w", w) + 0.0  # −0 becomes 0, or else the azimuth could be −π
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    return np.arctan2(np.hypot(x, y), z), np.arctan2(y, x)


def frame(normal: npt.ArrayLike) -> FloatArray:
    """Return the orthonormal right-handed frames (..., 3, 3) whose rows are (t, b, n).

    ``n`` is ``normal`` (..., 3) itself; t and b are continuous except across n_z = 0 from below, and are x
    and y for n = z.

    Raises
    ------
    ParameterError
        When a normal is not a finite unit vector.

    Source: Duff et al. (2017), listing 3.

    >>> frame([0.0, 0.0, 1.0])
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    n = check_directions("normal", normal)
    x, y, z = n[..., 0], n[..., 1], n[..., 2]
    sign = np.copysign(1.0, z)
    a = -1.0 / (sign + z)  # |sign + z| ≥ 1: nothing to cancel
    b = x * y * a
    tangent = np.stack((1.0 + sign * x * x * a, sign * b, -sign * x), axis=-1)
    bitangent = np.stack((b, sign + y * y * a, -y), axis=-1)
    return np.stack((tangent, bitangent, n), axis=-2) + 0.0


def to_local(frame: FloatArray, w: FloatArray) -> FloatArray:
    """Return world vectors ``w`` (..., 3) in the coordinates of ``frame`` (..., 3, 3).

    >>> to_local(frame([1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    array([0., 0., 1.])
    """
    result: FloatArray = np.einsum("...ij,...j->...i", frame, w)
    return result


def to_world(frame: FloatArray, w: FloatArray) -> FloatArray:
    """Return local vectors ``w`` (..., 3) of ``frame`` (..., 3, 3) in world coordinates.

    >>> to_world(frame([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    array([1., 0., 0.])
    """
    result: FloatArray = np.einsum("...ji,...j->...i", frame, w)
    return result


def half_vector(wi: FloatArray, wo: FloatArray) -> FloatArray:
    """Return the unit vectors half-way between directions ``wi`` and ``wo`` (..., 3).

    Exactly opposite directions have no half-way: every vector across is a limit. The first axis of
    ``frame(wo)`` is returned for them, so the result is always a unit vector.

    >>> half_vector(np.array([0.6, 0.0, 0.8]), np.array([-0.6, 0.0, 0.8]))
    array([0., 0., 1.])
    """
    total = np.add(wi, wo, dtype=np.float64)  # cancels only where it is exact
    opposite = every(total == 0.0)
    if opposite.any():
        total = np.where(opposite[..., None], frame(wo)[..., 0, :], total)
    return normalise(total)


def angle_between(a: FloatArray, b: FloatArray) -> Any:
    """Return the angles [rad] in [0, π] between directions ``a`` and ``b`` (..., 3).

    Kahan's 2 atan2(|a − b|, |a + b|) keeps the digits that the arccosine of the dot product loses for
    nearly parallel and nearly opposite directions, but it takes a rounded length for an angle: for vectors
    1e-15 apart no digit is right. The cross product (a − b) × (a + b) = 2 a × b of the same two exact vectors
    is blind to lengths, so every digit is kept, and float32-normalised vectors are served as well.

    Source: Kahan (2006), How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?,
    section 12, for the difference and the sum.

    >>> float(angle_between(np.array([0.0, 0.0, 1.0]), np.array([1e-16, 0.0, 1.0])))
    1e-16
    """
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    return np.arctan2(0.5 * length(cross(a - b, a + b)), dot(a, b))


def cap_solid_angle(half_angle: npt.ArrayLike) -> Any:
    """Return the solid angle [sr] of a cone of ``half_angle`` [rad] in [0, π]: 4π sin²(θ/2).

    Raises
    ------
    ParameterError
        When the angle is not in [0, π].

    >>> float(cap_solid_angle(1e-9)), float(cap_solid_angle(np.pi)) == 4 * np.pi
    (3.141592653589793e-18, True)
    """
    allowed = "an angle in [0, pi] radians"
    angle = numbers("half_angle", half_angle, allowed)
    reject("half_angle", angle, np.asarray(~((angle >= 0.0) & (angle <= np.pi))), allowed)
    return 4.0 * np.pi * np.sin(0.5 * angle) ** 2


def cap_half_angle(solid_angle: npt.ArrayLike) -> Any:
    """Return the half-angle [rad] of the cone that has a ``solid_angle`` [sr] in [0, 4π].

    Raises
    ------
    ParameterError
        When the solid angle is not in [0, 4π].

    >>> round(float(cap_half_angle(2 * np.pi) / np.pi), 15)
    0.5
    """
    allowed = "a solid angle in [0, 4 pi] steradians"
    omega = numbers("solid_angle", solid_angle, allowed)
    reject("solid_angle", omega, np.asarray(~((omega >= 0.0) & (omega <= 4.0 * np.pi))), allowed)
    return 2.0 * np.arctan2(np.sqrt(omega), np.sqrt(4.0 * np.pi - omega))
