"""Ridge: azimuths in slope space for lobes that are long in one direction and narrow in the other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Ridge", "find_ridge"]

FloatArray = npt.NDArray[np.float64]

ROUND = 0.4
"""A lobe whose width is at least this share of its length gets no nodes for its shape."""

FLAT = 1e-6
"""tanθo below which the incidence is normal."""

THINNEST = 0.002
"""The least width over length that nodes are placed for."""


@dataclass(frozen=True)
class Ridge:
    """The line through the lobe's centre along which it is long, and its width there.

    ``place`` in [0, 1] is the line's azimuth in the units of ``slope_map``'s s, on the side of positive
    azimuths; on the other side the line is at 1 − ``place``. ``aspect`` / π is its width in the same units.
    ``angle`` is the true azimuth of the line relative to wo's, and ``ratio`` the true width over length.
    """

    place: float
    aspect: float
    angle: float
    ratio: float

    def width(self, wo: FloatArray, width: float, s: FloatArray, far: Any) -> FloatArray:
        """Return the lobe's width at the azimuths s: an ellipse of the mean ``width`` and the ``ratio``."""
        tan_o = float(np.hypot(wo[0], wo[1]) / wo[2])
        off = azimuth(tan_o, s, far) - self.angle
        return width * np.sqrt(self.ratio) / np.hypot(self.ratio * np.cos(off), np.sin(off))


def azimuth(tan_o: float, s: FloatArray, far: Any) -> FloatArray:
    """Return the half vector's azimuth relative to wo's at ``slope_map``'s s, negative where ``far``."""
    cos_phi = np.cos(np.pi * s)
    if tan_o >= FLAT:
        cos_phi = np.sinh(np.arcsinh(tan_o) * cos_phi) / tan_o
    result: FloatArray = np.where(far, -1.0, 1.0) * np.arccos(np.clip(cos_phi, -1.0, 1.0))
    return result


def find_ridge(wo: FloatArray, s: FloatArray, far: npt.NDArray[np.bool_], mass: FloatArray) -> Ridge | None:
    """Return the ridge of a lobe from its mass (N,) at places s (N,), on the mirrored side where ``far``.

    An ellipse whose axes have the ratio r spreads its mass over the azimuth φ so that the mean of exp(2iφ)
    is (1 − r)/(1 + r), turned by twice the azimuth of its long axis.

    >>> s, far = (np.arange(400) % 200 + 0.5) / 200, np.arange(400) >= 200
    >>> phi = np.where(far, -s, s) * np.pi
    >>> mass = 1 / (np.sin(phi - 0.5) ** 2 + 0.01 * np.cos(phi - 0.5) ** 2)
    >>> ridge = find_ridge(np.array([0.0, 0.0, 1.0]), s, far, mass)
    >>> round(ridge.place * np.pi, 9), round(ridge.aspect, 9)
    (0.5, 0.1)
    """
    tan_o = float(np.hypot(wo[0], wo[1]) / wo[2])
    big_y = float(np.arcsinh(tan_o))
    phi = azimuth(tan_o, s, far)
    total = float(mass.sum())
    if not (np.isfinite(total) and total > 0):
        return None
    moment = complex(mass @ np.exp(2j * phi)) / total
    aspect = (1 - abs(moment)) / (1 + abs(moment))
    if aspect > ROUND:
        return None
    angle = float(np.angle(moment)) / 2 % np.pi
    aspect = max(aspect, THINNEST)
    if tan_o < FLAT:
        return Ridge(angle / np.pi, aspect, angle, aspect)
    # dσ/dφ for σ = π s, on the line: there the ridge is so much narrower in σ.
    y = float(np.arcsinh(tan_o * np.cos(angle)))
    sigma = float(np.arccos(np.clip(y / big_y, -1.0, 1.0)))
    steep = tan_o * np.sin(angle) / (np.cosh(y) * big_y * max(np.sin(sigma), 1e-3))
    return Ridge(sigma / np.pi, float(np.clip(aspect * max(steep, 1e-3), THINNEST, 1.0)), angle, aspect)
