"""Orientation: the axes of an emitter that has an axis and a direction of azimuth 0."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from radiokit.contracts.vectors import Triple
from radiokit.facts.directions import unit
from radiokit.facts.errors import ParameterError

__all__ = ["oriented"]

FloatArray = npt.NDArray[np.float64]

_LEAST_SINE = 1e-6  # between axis and forward: fewer than 10 digits of the azimuth are left below it


def oriented(axis: Triple, forward: Triple, *, name: str) -> FloatArray:
    """Return the right-handed frame (3, 3) whose rows are x, along ``forward`` as far as it can, y and z.

    Parameters
    ----------
    axis : tuple of 3 floats
        Unit vector, the z axis.
    forward : tuple of 3 floats
        Unit vector, made perpendicular to the axis.
    name : str
        What the error message calls the axis.

    Raises
    ------
    ParameterError
        When ``forward`` is parallel to the axis.

    >>> oriented((0.0, 0.0, 1.0), (0.8, 0.0, 0.6), name="normal")
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    z = np.array(axis)
    y = np.cross(z, forward)
    if not np.hypot(np.hypot(y[0], y[1]), y[2]) >= _LEAST_SINE:
        raise ParameterError("forward", forward, f"a direction that is not parallel to {name}, {axis}")
    y = unit(y)
    return np.stack((unit(np.cross(y, z)), y, z)) + 0.0
