"""Interfaces: the kernels of ``fresnel``, reflectances and their complements that keep their digits.

A cosine in [-1, 1], or in [0, 1] where a metal or Schlick's formula is meant; indices in ``INDEX_LIMITS``.
Nothing is checked here. The complement 1 − F is a sum of positive terms, where the difference would be noise:
for an index near 1, at grazing angles, for a metal.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.measure.kernels import kernel, select

__all__ = [
    "INDEX_LIMITS",
    "conductor_complement_kernel",
    "conductor_facet_kernel",
    "conductor_kernel",
    "dielectric_complement_kernel",
    "dielectric_kernel",
    "refraction_kernel",
    "schlick_complement_kernel",
    "schlick_kernel",
    "transmitted_cosine_kernel",
    "transmitted_square",
]

INDEX_LIMITS = (1e-60, 1e60)
"""An index beyond these reflects the same to the last bit."""


@kernel
def transmitted_square(n_i: Any, n_t: Any, c: Any) -> Any:
    """Return n_t² − n_i² sin²θ, from the sine near the normal and from the cosine elsewhere.

    >>> float(transmitted_square(1.0, 1.5, 1.0))
    2.25
    """
    sine, cosine = n_i * np.sqrt((1.0 - c) * (1.0 + c)), n_i * c
    return select(c > 0.75, (n_t - sine) * (n_t + sine), (n_t - n_i) * (n_t + n_i) + cosine * cosine)


@kernel
def _sides(cos_i: Any, eta: Any) -> Any:
    """Return the index before and behind the interface, |cosθi|, and (n_t cosθt)², below 0 for none."""
    inside = cos_i < 0.0
    n_i, n_t, c = select(inside, eta, 1.0), select(inside, 1.0, eta), abs(cos_i)
    return n_i, n_t, c, transmitted_square(n_i, n_t, c)


@kernel
def _amplitude(a: Any, b: Any, squares: Any) -> Any:
    """Return |a − b| / (a + b) for a, b ≥ 0, from a² − b² = ``squares`` where the difference would cancel."""
    total = a + b
    inverse = 1.0 / select(total > 0.0, total, 1.0)
    loss = 2.0 * select(a < b, a, b) * inverse
    return select(loss < 0.5, 1.0 - loss, abs(squares) * inverse * inverse)


@kernel
def _passed(a: Any, b: Any) -> Any:
    """Return 4ab/(a + b)², the complement of ((a − b)/(a + b))²."""
    total = a + b
    inverse = 1.0 / select(total > 0.0, total, 1.0)
    return 4.0 * (a * inverse) * (b * inverse)


@kernel
def dielectric_kernel(cos_i: Any, eta: Any) -> Any:
    """Return what ``fresnel.dielectric`` does: the reflectance [1], from inside where the cosine is below 0.

    >>> round(float(dielectric_kernel(1.0, 1.5)), 15)
    0.04
    """
    n_i, n_t, c, square = _sides(cos_i, eta)
    step = (n_t - n_i) * (n_t + n_i)
    s = np.sqrt((1.0 - c) * (1.0 + c))
    g = np.sqrt(select(square > 0.0, square, 0.0))
    product = step * (n_t * c - n_i * s) * (n_t * c + n_i * s)  # (n_t² cosθi)² − (n_i n_t cosθt)²
    r_s, r_p = _amplitude(n_i * c, g, step), _amplitude(n_t * n_t * c, n_i * g, product)
    value = 0.5 * (r_s * r_s + r_p * r_p)
    value = select((square < 0.0) | (value > 1.0), 1.0, value)
    return select(step == 0.0, 0.0, value)


@kernel
def dielectric_complement_kernel(cos_i: Any, eta: Any) -> Any:
    """Return 1 − F [1] of a dielectric: the share of the power that is transmitted.

    >>> float(dielectric_complement_kernel(1e-200, 1.5)) > 0, float(dielectric_complement_kernel(0.5, 1.0))
    (True, 1.0)
    """
    n_i, n_t, c, square = _sides(cos_i, eta)
    g = np.sqrt(select(square > 0.0, square, 0.0))
    value = 0.5 * (_passed(n_i * c, g) + _passed(n_t * n_t * c, n_i * g))
    value = select(value < 1.0, value, 1.0)
    return select(n_i == n_t, 1.0, value)


@kernel
def transmitted_cosine_kernel(cos_i: Any, eta: Any) -> Any:
    """Return |cosθt| [1] behind a dielectric interface, 0 under total reflection.

    >>> float(transmitted_cosine_kernel(0.3, 1.0)), float(transmitted_cosine_kernel(-0.5, 1.5))
    (0.3, 0.0)
    """
    _, n_t, _, square = _sides(cos_i, eta)
    return np.sqrt(select(square > 0.0, square, 0.0)) / n_t


@kernel
def refraction_kernel(ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    """Return x, y, z of the refracted direction, along the surface if there is none, with F and 1 − F.

    For a direction on either side; ``eta`` is the index below over that above, and cosθ has too few digits
    near the critical angle of a steep direction: there the sine is taken. F is found from the rarer side,
    where nothing cancels, and so it is the same for a direction and the one it is refracted into.

    >>> [round(float(x), 6) for x in refraction_kernel(0.6, 0.0, 0.8, 1.5)]
    [-0.4, -0.0, -0.916515, 0.043895, 0.956105]
    """
    near, far = select(oz < 0.0, eta, 1.0), select(oz < 0.0, 1.0, eta)
    z = select(abs(oz) < 1.0, abs(oz), 1.0)
    sine = np.sqrt(ox * ox + oy * oy)
    by_sine = (far - near * sine) * (far + near * sine)
    by_cosine = (far - near) * (far + near) + (near * z) * (near * z)
    square = select((far < near) & (z * z > 0.5), by_sine, by_cosine)
    total = square < 0.0
    behind = np.sqrt(select(total, 0.0, square)) / far
    scale = select(total, 1.0 / select(sine > 0.0, sine, 1.0), near / far)
    rare = select(far < near, behind, z)
    rare = select(eta < 1.0, -rare, rare)
    tz = select(oz < 0.0, behind, -behind)
    return -scale * ox, -scale * oy, tz, dielectric_kernel(rare, eta), dielectric_complement_kernel(rare, eta)


@kernel
def _losses(c: Any, sine: Any, n: Any, k: Any) -> Any:
    """Return 1 − R_s, 1 − R_p/R_s, and what R_s and R_p/R_s are where their complements lose digits."""
    sin2 = sine * sine
    square = select(c > 0.75, (n - sine) * (n + sine), (n - 1.0) * (n + 1.0) + c * c)
    # q² = t + 2iηk; the larger of a and b comes from the sum that does not cancel, the other from ab = ηk.
    t, nk = square - k * k, n * k
    larger = np.sqrt(0.5 * (np.sqrt(t * t + 4.0 * (nk * nk)) + abs(t)))
    smaller = nk / select(larger > 0.0, larger, 1.0)
    a, b = select(t >= 0.0, larger, smaller), select(t >= 0.0, smaller, larger)
    contrast = ((n - 1.0) * (n - 1.0) + k * k) * ((n + 1.0) * (n + 1.0) + k * k)
    ac, bc2 = a * c, (b * c) * (b * c)
    s_sum = (a + c) * (a + c) + b * b
    p_sum = (ac + sin2) * (ac + sin2) + bc2
    s_sum, p_sum = select(s_sum > 0.0, s_sum, 1.0), select(p_sum > 0.0, p_sum, 1.0)
    s_rest, p_rest = contrast / s_sum / s_sum, ((ac - sin2) * (ac - sin2) + bc2) / p_sum
    return 4.0 * ac / s_sum, 4.0 * ac * sin2 / p_sum, s_rest, p_rest, contrast


@kernel
def conductor_kernel(c: Any, n: Any, k: Any) -> Any:
    """Return what ``fresnel.conductor`` does, for a cosine in [0, 1] and an index from ``clip_index``.

    >>> round(float(conductor_kernel(1.0, 0.2, 3.0)), 12)
    0.92337164751
    """
    return conductor_facet_kernel(c, np.sqrt((1.0 - c) * (1.0 + c)), n, k)


@kernel
def conductor_facet_kernel(c: Any, sine: Any, n: Any, k: Any) -> Any:
    """Return the same from cosine and sine: near the normal, the cosine alone has few digits of the sine.

    >>> float(conductor_facet_kernel(0.6, 0.8, 0.2, 3.0)) == float(conductor_kernel(0.6, 0.2, 3.0))
    True
    """
    s_loss, p_loss, s_rest, p_rest, contrast = _losses(c, sine, n, k)
    r_s = select(s_loss < 0.5, 1.0 - s_loss, s_rest)
    ratio = select(p_loss < 0.5, 1.0 - p_loss, p_rest)
    value = 0.5 * r_s * (1.0 + ratio)
    return select(contrast == 0.0, 0.0, select(value < 1.0, value, 1.0))


@kernel
def conductor_complement_kernel(c: Any, n: Any, k: Any) -> Any:
    """Return 1 − F [1] of a conductor: the share of the power that is absorbed.

    >>> float(conductor_complement_kernel(1e-9, 1e-6, 100.0)) > 0.0
    True
    """
    s_loss, p_loss, s_rest, _, contrast = _losses(c, np.sqrt((1.0 - c) * (1.0 + c)), n, k)
    r_s = select(s_loss < 0.5, 1.0 - s_loss, s_rest)
    value = s_loss + 0.5 * p_loss * r_s
    return select(contrast == 0.0, 1.0, select(value < 1.0, value, 1.0))


@kernel
def schlick_kernel(c: Any, f0: Any) -> Any:
    """Return Schlick's F0 + (1 − F0)(1 − cosθ)⁵ [1].

    >>> float(schlick_kernel(1.0, 0.04)), float(schlick_kernel(0.0, 0.04))
    (0.04, 1.0)
    """
    d = 1.0 - c
    return f0 + (1.0 - f0) * (d * d * (d * d) * d)


@kernel
def schlick_complement_kernel(c: Any, f0: Any) -> Any:
    """Return (1 − F0)(1 − (1 − cosθ)⁵) [1].

    >>> float(schlick_complement_kernel(1e-20, 0.0))
    5e-20
    """
    d = 1.0 - c
    return (1.0 - f0) * (c * (1.0 + d * (1.0 + d * (1.0 + d * (1.0 + d)))))
