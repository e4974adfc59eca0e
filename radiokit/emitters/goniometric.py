"""Goniometric light: a point whose intensities a luminaire's IES file tabulates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.oriented import oriented
from radiokit.contracts.parameters import Spectrum, parameter
from radiokit.contracts.pointlight import PointLight
from radiokit.contracts.spectral import amount
from radiokit.contracts.vectors import vector
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source
from radiokit.physics.lm63 import SOURCE, Photometry, read_lm63

__all__ = ["Goniometric"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Goniometric(PointLight):
    r"""A point light with the intensities of an IES file (LM-63-1995 or -2002, Type C, no tilt).

    Between the tabulated angles I is bilinear in polar angle and azimuth; beyond them it is dark. The file
    gives candela. W sr⁻¹ are scale · cd / ``efficacy``: by default those of light at 555 nm that has these
    candela, the least power that can; for white light give its own luminous efficacy, some 300 lm/W.

    Parameters
    ----------
    position : tuple of 3 floats
        Where the light is [m].
    ies : str or path
        The file's path, or its text, which has more than one line. It is read once: the text is kept.
    direction : tuple of 3 floats, optional
        Vertical angle 0, the nadir of a lamp on the ceiling; any length but 0. −z by default.
    forward : tuple of 3 floats, optional
        Horizontal angle 0; the angle grows counterclockwise as seen against ``direction``, from above a lamp
        that points down. x by default; it is made perpendicular to ``direction``.
    scale : float, or sequence of K floats
        Factor of all intensities, in [0, 1e100]; one number, or one a wavelength.
    efficacy : float
        Luminous efficacy K of the radiation [lm W⁻¹], in (0, 683.002].

    Raises
    ------
    ParameterError
        When the file cannot be read, naming the line and what is expected there, ``forward`` is parallel to
        ``direction``, or a number is out of its range.

    >>> lamp = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n1366 0"
    >>> light = Goniometric(position=(0, 0, 1), ies=lamp)
    >>> light.irradiance_at(np.zeros(3), np.array([0.0, 0.0, 1.0])).value
    2.0
    """

    name: ClassVar[str] = "goniometric"
    SOURCE: ClassVar[Source] = SOURCE

    position: tuple[float, float, float] = vector("point", "m", "where the light is")
    ies: Any
    direction: tuple[float, float, float] = vector(
        "direction", "1", "vertical angle 0", default=(0.0, 0.0, -1.0)
    )
    forward: tuple[float, float, float] = vector(
        "direction", "1", "horizontal angle 0", default=(1.0, 0.0, 0.0)
    )
    scale: Spectrum = parameter("[0, 1e100]", "1", "factor of all intensities", spectral=True, default=1.0)
    efficacy: float = parameter("(0, 683.002]", "lm/W", "luminous efficacy of the radiation", default=683.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "ies", _text(self.ies))
        _ = self.photometry, self._axes

    def __repr__(self) -> str:
        described = self.photometry.keywords.get("LUMINAIRE", "IES file")
        names = ("position", "direction", "forward", "scale", "efficacy")
        values = ", ".join(f"{name}={getattr(self, name)!r}" for name in names)
        return f"Goniometric({values}, ies=<{described}>)"

    @cached_property
    def photometry(self) -> Photometry:
        """What the file says."""
        return read_lm63(self.ies)

    @cached_property
    def _axes(self) -> FloatArray:
        """Horizontal angle 0, 90°, and up, in world coordinates."""
        x, y, z = self.direction
        return oriented((-x + 0.0, -y + 0.0, -z + 0.0), self.forward, name="direction")

    @property
    def _factor(self) -> Any:
        return amount(self.scale) / self.efficacy

    def intensity_along(self, direction: FloatArray) -> tuple[Any, Any]:
        """Return I [W sr⁻¹] along a unit vector away from the light, and a bound of its rounding."""
        x, y, up = (float(v) for v in self._axes @ direction)
        polar = math.degrees(math.atan2(math.hypot(x, y), -up))
        value, error = self.photometry.intensity(polar, math.degrees(math.atan2(y, x)))
        return self._factor * value, self._factor * error

    def flux(self) -> Estimate:
        """Return Φ [W], the exact integral of the interpolant."""
        return rounding(self._factor * self.photometry.flux(), ulps=64)


def _text(ies: Any) -> str:
    """Return the text of an IES file."""
    if isinstance(ies, str) and len(ies.splitlines()) > 1:
        return ies
    allowed = "the path of an IES file, or its text"
    if not isinstance(ies, str | Path) or not str(ies):
        raise ParameterError("ies", ies, allowed)
    try:
        return Path(ies).read_text(encoding="latin-1")
    except OSError as error:
        raise ParameterError("ies", str(ies), f"{allowed} ({error.strerror})") from None
