"""Environment map: the radiance of a whole sphere of directions, tabulated by latitude and longitude."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from radiokit.contracts.emitter import Emitter, Silhouette
from radiokit.contracts.oriented import oriented
from radiokit.contracts.vectors import vector
from radiokit.facts.directions import to_local, to_world
from radiokit.facts.errors import ParameterError
from radiokit.facts.estimate import Estimate, rounding
from radiokit.facts.source import Source
from radiokit.measure.latlong import cell_edges, cell_projections, cell_solid_angles
from radiokit.physics.eclipse import Dome

__all__ = ["Environment"]

FloatArray = npt.NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
_BELOW_ONE = float(np.nextafter(1.0, 0.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Environment(Emitter):
    """An environment infinitely far away, of constant radiance in each cell of a latitude–longitude grid.

    There is no interpolation: the map is what it says, and irradiances are exact for any tilt.

    Parameters
    ----------
    radiance : array_like, shape (H, W) or (H, W, K)
        Radiance [W m⁻² sr⁻¹] of the cells, in [0, 1e100], at one wavelength or at K. Row i spans the polar
        angles π i/H to π (i + 1)/H from the zenith, column j the azimuths 2π j/W to 2π (j + 1)/W.
    normal : tuple of 3 floats, optional
        The zenith, where row 0 begins; any length but 0, stored as a unit vector. z by default.
    forward : tuple of 3 floats, optional
        Where column 0 begins; the azimuth grows counterclockwise as seen from the zenith. x by default; it
        is made perpendicular to the zenith.

    Raises
    ------
    ParameterError
        When ``radiance`` is no such array, or ``forward`` is parallel to ``normal``.

    >>> sky = Environment(radiance=[[1.0, 1.0], [0.0, 0.0]])  # bright above the horizon
    >>> wall = np.array([1.0, 0.0, 0.0])
    >>> round(float(sky.irradiance_at(np.zeros(3), wall).value) / np.pi, 15)
    0.5
    """

    name: ClassVar[str] = "environment"
    SOURCE: ClassVar[Source] = Source(
        authors="Pharr, Jakob, Humphreys",
        year=2023,
        title="Physically Based Rendering, 4th edition",
        equation="section A.5, sampling a piecewise constant function of two variables by its marginal",
    )

    radiance: Any
    normal: tuple[float, float, float] = vector("direction", "1", "the zenith", default=(0.0, 0.0, 1.0))
    forward: tuple[float, float, float] = vector(
        "direction", "1", "where the azimuth is 0", default=(1.0, 0.0, 0.0)
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "radiance", _checked_map(self.radiance))
        _ = self._axes

    def _key(self) -> tuple[Any, ...]:
        return self.radiance.shape, self.radiance.tobytes(), self.normal, self.forward

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Environment):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), np.array(self.radiance), self.normal, self.forward)

    def __repr__(self) -> str:
        size = " x ".join(map(str, self.radiance.shape))
        return f"Environment(radiance=<{size}>, normal={self.normal!r}, forward={self.forward!r})"

    @property
    def wavelengths(self) -> int | None:
        """K, or None for a map of one wavelength."""
        return int(self.radiance.shape[2]) if self.radiance.ndim == 3 else None

    @cached_property
    def _grey(self) -> FloatArray:
        """The means (H, W) over the wavelengths, by which directions are sampled."""
        grey: FloatArray = self.radiance if self.radiance.ndim == 2 else self.radiance.mean(axis=2)
        return grey

    @cached_property
    def _axes(self) -> FloatArray:
        return oriented(self.normal, self.forward, name="normal")

    @cached_property
    def _solid_angles(self) -> FloatArray:
        return cell_solid_angles(*self._grey.shape)

    @cached_property
    def _weights(self) -> FloatArray:
        """What each cell gets of the samples: its solid angle times its share of the largest radiance."""
        largest = float(self._grey.max())
        relative = self._grey / largest if largest > 0 else np.ones(self._grey.shape)
        weights: FloatArray = relative * self._solid_angles[:, None]
        return weights

    @cached_property
    def _marginal(self) -> FloatArray:
        return np.concatenate(([0.0], np.cumsum(self._weights.sum(axis=1))))

    @cached_property
    def _conditional(self) -> FloatArray:
        """The cumulative weights (H, W + 1) along each row, from 0 to 1; all 0 in a dark row."""
        sums = np.cumsum(self._weights, axis=1)
        full = np.where(sums[:, -1:] > 0, sums[:, -1:], 1.0)
        return np.concatenate((np.zeros((len(sums), 1)), sums / full), axis=1)

    @cached_property
    def _last_lit(self) -> npt.NDArray[np.intp]:
        """The last column (H,) of each row that is not dark."""
        columns = np.arange(self._grey.shape[1])
        last: npt.NDArray[np.intp] = np.max(np.where(self._weights > 0, columns, 0), axis=1)
        return last

    def _cell(self, direction: FloatArray) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        rows, columns = self._grey.shape
        x, y, z = to_local(self._axes, direction).T
        turn = np.arctan2(y, x) / (2 * np.pi)
        down = np.arctan2(np.hypot(x, y), z) / np.pi
        row = np.minimum((down * rows).astype(np.intp), rows - 1)
        column = np.minimum((np.where(turn < 0, turn + 1, turn) * columns).astype(np.intp), columns - 1)
        return row, column

    def dome(self, position: FloatArray) -> tuple[FloatArray, ...] | None:
        """Return ``()``, the whole sphere, for a map with one radiance everywhere, and None else."""
        return () if np.all(self.radiance == self.radiance[0, 0]) else None

    def silhouette(self, position: FloatArray) -> Silhouette | None:
        """Return the whole sphere for a map with one radiance everywhere, and None else: cells have edges."""
        return Silhouette(Dome(), float(self.radiance[0, 0])) if self.dome(position) == () else None

    def radiance_from(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return the radiance, (N,) or (N, K), of the cells in which directions (N, 3) lie."""
        found: FloatArray = self.radiance[self._cell(direction)]
        return found

    def sample(self, u: FloatArray, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points (N, 2) into directions (N, 3) of density in proportion to L [sr⁻¹].

        L counts by its mean over the wavelengths.
        """
        rows, columns = self._grey.shape
        mass = np.minimum(u[:, 0], _BELOW_ONE) * self._marginal[-1]
        row = np.clip(np.searchsorted(self._marginal, mass, side="right") - 1, 0, rows - 1)
        down = _share(mass, self._marginal[row], self._marginal[row + 1])
        # One sorted table of all the rows, each a unit apart, finds the columns of all samples at once.
        table = (self._conditional[:, 1:] + np.arange(rows)[:, None]).ravel()
        share = np.minimum(u[:, 1], _BELOW_ONE)
        column = np.searchsorted(table, row + share, side="right") - row * columns
        column = np.minimum(column, self._last_lit[row])
        along = _share(share, self._conditional[row, column], self._conditional[row, column + 1])
        theta, _ = cell_edges(rows, columns)
        haversine = np.sin(theta / 2) ** 2  # uniform in it, like in the cosine
        height = haversine[row] + down * (haversine[row + 1] - haversine[row])
        sine = 2 * np.sqrt(height * (1 - height))
        azimuth = 2 * np.pi * (column + along) / columns
        local = np.stack((sine * np.cos(azimuth), sine * np.sin(azimuth), 1 - 2 * height), axis=-1)
        directions = to_world(self._axes, local)
        return directions, self.pdf(directions, position)

    def pdf(self, direction: FloatArray, position: FloatArray) -> FloatArray:
        """Return L over its integral [sr⁻¹]; 1/4π where all is dark."""
        row, column = self._cell(direction)
        density: FloatArray = self._weights[row, column] / self._solid_angles[row] / self._marginal[-1]
        return density

    def solid_angle(self, position: FloatArray) -> Estimate:
        """Return the solid angle [sr] of the cells that are not dark."""
        lit = np.count_nonzero(self._grey, axis=1)
        return rounding(float(np.sum(lit * self._solid_angles)), ulps=8)

    def irradiance_at(self, position: FloatArray, normal: FloatArray) -> Estimate:
        """Return E = Σ L ∫ max(0, cosθ) dω over the cells, those that the horizon cuts included."""
        rows, columns = self._grey.shape
        seen, error = cell_projections(rows, columns, to_local(self._axes, normal))
        weights = np.stack((seen, error))
        if self.radiance.ndim == 2:
            value, bound = (float(np.sum(self.radiance * weight)) for weight in weights)
        else:
            value, bound = np.einsum("ijk,wij->wk", self.radiance, weights)
        bound = bound + 32 * _EPS * value
        return Estimate(value, bound, "rounding", method="closed form")


def _checked_map(value: Any) -> FloatArray:
    allowed = "an array of shape (H, W) or (H, W, K) of numbers in [0, 1e100]"
    try:
        table = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError("radiance", value, allowed) from None
    if table.ndim not in (2, 3) or not table.size:
        shapes = "(H, W) or (H, W, K), a map of at least one cell"
        raise ParameterError("radiance.shape", table.shape, shapes)
    bad = ~((table >= 0) & (table <= 1e100))
    if bad.any():
        first = tuple(np.argwhere(bad)[0].tolist())
        place = ", ".join(map(str, first))
        raise ParameterError(
            f"radiance[{place}]", float(table[first]), "finite and at least 0, at most 1e100"
        )
    table += 0.0
    table.flags.writeable = False
    return table


def _rebuild(cls: type[Environment], radiance: FloatArray, normal: Any, forward: Any) -> Environment:
    return cls(radiance=radiance, normal=normal, forward=forward)


def _share(x: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """Return where x is between ``low`` and ``high``, from 0 to 1."""
    width = high - low
    share = np.divide(x - low, width, out=np.full_like(x, 0.5), where=width > 0)
    return np.clip(share, 0.0, 1.0)
