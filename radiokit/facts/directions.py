"""Directions: unit vectors, angles, frames and caps, without losing digits.

``check_directions``, ``unit``, ``frame``, the spherical coordinates and the caps check what they are given.
The other functions are kernels: they trust vectors to be of unit length, as a model's ``evaluate`` does.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.checking import numbers, reject, vectors
from radiokit.facts.source import Source

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


def dot(a: FloatArray, b: FloatArray) -> Any:
    """Return the dot products of vectors ``a`` and ``b`` (..., 3): shape (...).

    >>> float(dot(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 2.0])))
    6.0
    """
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    (ax, ay, az), (bx, by, bz) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    return np.stack((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), axis=-1)


def _every(components: npt.NDArray[np.bool_]) -> Any:
    """Return whether all three of (..., 3) are true; many times as fast as ``all`` along so short an axis."""
    return components[..., 0] & components[..., 1] & components[..., 2]


def _length(v: FloatArray) -> Any:
    """Return the lengths of vectors whose squares may underflow."""
    return np.hypot(np.hypot(v[..., 0], v[..., 1]), v[..., 2])


def _normalise(v: FloatArray) -> FloatArray:
    """Divide finite non-zero vectors by their lengths; a power of two keeps extreme squares in range."""
    with np.errstate(over="ignore"):
        square = np.asarray(dot(v, v))
    if not ((square > 1e-280) & (square < 1e280)).all():
        _, exponent = np.frexp(np.max(np.abs(v), axis=-1, keepdims=True))
        v = np.ldexp(v, -exponent)
        square = np.asarray(dot(v, v))
    result: FloatArray = v / np.sqrt(square)[..., None]
    return result


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
    bad = ~_every(np.isfinite(array)) | _every(array == 0.0)
    reject("v", array, np.asarray(bad), allowed)
    return _normalise(array)


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
    opposite = _every(total == 0.0)
    if opposite.any():
        total = np.where(opposite[..., None], frame(wo)[..., 0, :], total)
    return _normalise(total)


def reflect(w: FloatArray, normal: FloatArray | None = None) -> FloatArray:
    """Return the mirror directions 2(w·n)n − w of ``w`` (..., 3); ``normal`` (..., 3) is z by default.

    >>> reflect(np.array([0.6, 0.0, 0.8]))
    array([-0.6, -0. ,  0.8])
    """
    w = np.asarray(w, dtype=np.float64)
    if normal is None:
        return np.multiply(w, (-1.0, -1.0, 1.0))
    normal = np.asarray(normal, dtype=np.float64)
    result: FloatArray = 2.0 * dot(w, normal)[..., None] * normal - w
    return result


def refract(
    w: FloatArray, normal: FloatArray | None = None, *, eta: npt.ArrayLike
) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """Return the refracted directions and where total internal reflection leaves none.

    Parameters
    ----------
    w : ndarray, shape (..., 3)
        Unit vectors away from the surface, towards where the light comes from.
    normal : ndarray, shape (..., 3)
        z by default.
    eta : array_like, shape (...)
        Index on the side that the normal leaves behind, over the index on the side that it points to
        (η_t/η_i for light from outside), in [1e-100, 1e100]. For ``w`` below the surface it is inverted.

    Returns
    -------
    direction : ndarray, shape (..., 3)
        Unit vectors away from the surface on the other side. Under total internal reflection, the limit
        at the critical angle: along the surface.
    total : ndarray of bool, shape (...)

    Raises
    ------
    ParameterError
        When ``eta`` is not in that range.

    Source: Pharr, Jakob, Humphreys (2023), Physically Based Rendering, 4th edition, section 9.3.3.

    >>> direction, total = refract(np.array([0.6, 0.0, 0.8]), eta=1.5)
    >>> [round(float(x), 6) for x in direction], bool(total)
    ([-0.4, 0.0, -0.916515], False)
    """
    allowed = "a number in [1e-100, 1e100]"
    ratio = numbers("eta", eta, allowed)
    reject("eta", ratio, np.asarray(~((ratio >= 1e-100) & (ratio <= 1e100))), allowed)
    w = np.asarray(w, dtype=np.float64)
    n = np.array([0.0, 0.0, 1.0]) if normal is None else np.asarray(normal, dtype=np.float64)
    cosine = dot(w, n)
    side = np.copysign(1.0, cosine)[..., None]
    # Indices of the far and the near side: 1/η is never rounded, so η next to 1 keeps its digits both ways.
    far = np.where(side[..., 0] > 0.0, ratio, 1.0)
    near = np.where(side[..., 0] > 0.0, 1.0, ratio)
    # The part along the surface, w − (w·n)n, from the small w ∓ n: it keeps its digits near the normal.
    offset = w - side * n
    along = offset - dot(offset, n)[..., None] * n
    sine = _length(along)
    # (far cos θt)² = far² − near² sin² = far² − near² + near² cos²: each is good where the other cancels.
    by_sine = (far - near * sine) * (far + near * sine)
    by_cosine = (far - near) * (far + near) + (near * cosine) ** 2
    square = np.where((far < near) & (cosine * cosine > 0.5), by_sine, by_cosine)
    total = np.asarray(square < 0.0)
    across = np.sqrt(np.maximum(square, 0.0))[..., None]
    limit = -along / np.where(sine > 0.0, sine, 1.0)[..., None]
    direction = -(near[..., None] * along + side * across * n) / far[..., None]
    return np.where(total[..., None], limit, direction) + 0.0, total


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
    return np.arctan2(0.5 * _length(_cross(a - b, a + b)), dot(a, b))


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
