"""Facets: what a tiny mirror or window does to a direction, and how it spreads a solid angle.

Kernels for a facet whose normal h has any length. ``eta`` is the index on the side of i over that on the side
of o; i and o point away from the surface.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.facts.source import Source
from radiokit.measure.kernels import kernel, select
from radiokit.physics.interface import transmitted_square

__all__ = [
    "FACET_SOURCE",
    "reflect",
    "reflection_jacobian",
    "refract",
    "refraction_half",
    "refraction_jacobian",
    "refraction_share",
]

FACET_SOURCE = Source(
    authors="Walter, Marschner, Li, Torrance",
    year=2007,
    title="Microfacet Models for Refraction through Rough Surfaces. Eurographics Symposium on Rendering",
    doi="10.2312/EGWR/EGSR07/195-206",
    equation="13, 14, 39 (reflection); 16, 17, 21, 40 (refraction)",
)


@kernel
def reflect(ox: Any, oy: Any, oz: Any, hx: Any, hy: Any, hz: Any) -> Any:
    """Return the direction (wx, wy, wz) that the facet reflects to o.

    >>> [float(c) for c in reflect(0.6, 0.0, 0.8, 0.0, 0.0, 2.0)]
    [-0.6, 0.0, 0.8]
    """
    scale = 2.0 * (ox * hx + oy * hy + oz * hz) / (hx * hx + hy * hy + hz * hz)
    return scale * hx - ox, scale * hy - oy, scale * hz - oz


@kernel
def reflection_jacobian(along: Any, length: Any) -> Any:
    """Return dωh/dωi = 1/(4 o·ĥ) [1], for ``along`` = o·h above 0 and ``length`` = |h|.

    >>> float(reflection_jacobian(1.0, 2.0))
    0.5
    """
    return 0.25 * length / along


@kernel
def refraction_half(ix: Any, iy: Any, iz: Any, ox: Any, oy: Any, oz: Any, eta: Any) -> Any:
    """Return the normal ±(o + η i) (hx, hy, hz) of the facet that refracts i to o, with hz at least 0.

    o + i is near 0 for an index near 1, and exact there: the small rest is added to it.

    >>> [float(c) for c in refraction_half(0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 1.5)]
    [-0.0, -0.0, 0.5]
    """
    step = eta - 1.0
    hx, hy, hz = (ox + ix) + step * ix, (oy + iy) + step * iy, (oz + iz) + step * iz
    down = hz < 0.0
    return select(down, -hx, hx), select(down, -hy, hy), select(down, -hz, hz)


@kernel
def refract(ox: Any, oy: Any, oz: Any, hx: Any, hy: Any, hz: Any, eta: Any) -> Any:
    """Return the direction (wx, wy, wz) from which the facet refracts light to o, and the cosine |i·ĥ|.

    Under total reflection the cosine is 0, and the direction has no meaning (but is finite).

    >>> [round(float(c), 15) for c in refract(0.6, 0.0, 0.8, 0.0, 0.0, 2.0, 1.0)]
    [-0.6, 0.0, -0.8, 0.8]
    """
    inverse = 1.0 / np.sqrt(hx * hx + hy * hy + hz * hz)
    along = (ox * hx + oy * hy + oz * hz) * inverse
    c = select(abs(along) < 1.0, abs(along), 1.0)
    square = transmitted_square(1.0, eta, c)
    root = np.sqrt(select(square > 0.0, square, 0.0))  # η |i·ĥ|
    total = c + root
    # |o·ĥ| − η |i·ĥ|, as the quotient of their squares' difference and their sum.
    bend = (1.0 - eta) * (1.0 + eta) / select(total > 0.0, total, 1.0)
    bend = select(along < 0.0, -bend, bend) * inverse
    return (bend * hx - ox) / eta, (bend * hy - oy) / eta, (bend * hz - oz) / eta, root / eta


@kernel
def refraction_share(along_i: Any, along_o: Any, length2: Any) -> Any:
    """Return |i·ĥ| |o·ĥ|/|h|² [1], for h from ``refraction_half``, i·h, o·h and |h|² in its length.

    The transmitted f is this times D, 1 − F and G₂/(cosθi cosθo), with a factor for what is transported:
    1 for radiance from the side of i to that of o, η² the other way. 0 unless h lies between the sides.

    >>> float(refraction_share(-0.5, 0.5, 0.25))
    4.0
    """
    between = (along_i * along_o < 0.0) & (length2 > 0.0)
    inverse = 1.0 / select(between, length2, 1.0)
    return select(between, -(along_i * inverse) * (along_o * inverse), 0.0)


@kernel
def refraction_jacobian(along_i: Any, length2: Any, eta: Any) -> Any:
    """Return dωh/dωi = η² |i·ĥ|/|h|² [1], for h from ``refraction_half``, i·h and |h|² in its length.

    >>> float(refraction_jacobian(-0.5, 0.25, 1.5))
    9.0
    """
    square = select(length2 > 0.0, length2, 1.0)
    return eta * eta * abs(along_i) / (square * np.sqrt(square))
