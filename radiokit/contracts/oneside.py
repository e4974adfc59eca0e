"""One side: what a material that light passes does with the light from one side, as if it reflected it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from radiokit.contracts.albedo import radiance_to_flux
from radiokit.contracts.bsdf import BSDF, Claims, FloatArray

if TYPE_CHECKING:
    from radiokit.measure.twin import Twin

__all__ = ["OneSide"]

_FLIP = np.array([1.0, 1.0, -1.0])


@dataclass(frozen=True, kw_only=True)
class OneSide(BSDF):
    """The smooth part of f for light from the viewer's side of the surface, or from the other one.

    Both directions are given above the horizon of a frame whose z axis points to the side that they are on;
    x and y are those of f. Radiances are basic ones, L/n²: for light that passes, f is multiplied by
    n(wi)²/n(wo)². Delta lobes are left out.

    Parameters
    ----------
    f : BSDF
    through : bool
        Whether the light is on the other side than the viewer.
    below : bool
        Whether the viewer is below the surface.

    >>> from radiokit.contracts.bsdf import bsdf
    >>> sheet = bsdf("lambert_transmitter", reflectance=0.2, transmittance=0.7)
    >>> passed = OneSide(f=sheet, through=True, below=False)
    >>> round(float(passed([0.0, 0.6, 0.8], [0.0, 0.0, 1.0])) * np.pi, 12)
    0.7
    """

    name = "one_side"

    f: BSDF
    through: bool
    below: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "dimensions", self.f.dimensions)
        object.__setattr__(self, "precision", self.f.precision)

    @property
    def claims(self) -> Claims | None:
        """Those of f, whose other side is left out: it is delta only if f is."""
        return self.f.claims

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹], of basic radiances."""
        wi, wo = self._of_f(wi, wo)
        value = self.f.evaluate(wi, wo)
        return self._scaled(value, wi, wo)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] of ``sample``, which falls short of 1 by the other side's share."""
        return self.f.pdf(*self._of_f(wi, wo))

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Turn uniform points ``u`` (N, dimensions) into ``wi`` and weights; below the horizon that is 0."""
        _, held = self._of_f(wo, wo)
        wi, weight = self.f.sample(u, held)
        here, _ = self._of_f(wi, wo)  # the same flip leads there and back
        live = (here[:, 2] > 0) & weight.reshape(len(weight), -1).any(axis=1)
        # What was absorbed has any direction: let none of them be taken for a sample of the pdf.
        here = np.where(live[:, None], here, [0.0, 0.0, -1.0])
        return here, np.asarray((self._scaled(weight, wi, held).T * live).T)

    @property
    def isotropic(self) -> bool:
        """Whether f is."""
        return self.f.isotropic

    @property
    def smooth(self) -> bool:
        """Whether f is."""
        return self.f.smooth

    def lobe_width(self) -> float | None:
        """Return that of f for reflection; None for a lobe of refraction, which is not where mirrors' are."""
        wide = self.f.lobe_width()
        if not self.through or self.f.relative_index() == 1.0:
            return wide
        return None

    def diffuse_reflectance(self) -> Any:
        """Return ρ or τ of a diffuse sheet, of shape () or (K,), None for another f."""
        sides = self.f.diffuse_sides()
        return None if sides is None else sides[int(self.through)]

    @property
    def beyond(self) -> float:
        """The index on the other side over that on the viewer's."""
        return self.f.relative_index() ** (-1.0 if self.below else 1.0)

    @property
    def eta(self) -> float:
        """The index on the light's side over that on the viewer's."""
        return self.beyond if self.through else 1.0

    def refracted(self, wo: FloatArray) -> FloatArray | None:
        """Return the direction (3,) that a smooth surface would refract light from, or None beyond it."""
        across = -wo[:2] / self.eta
        square = float(across @ across)
        return None if square >= 1.0 else np.array([*across, np.sqrt(1.0 - square)])

    def symbolic(self) -> Twin:
        """Return the twin of f."""
        return self.f.symbolic()

    def _of_f(self, wi: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        flipped = self.below != self.through
        return wi * _FLIP if flipped else wi, wo * _FLIP if self.below else wo

    def _scaled(self, value: Any, wi: FloatArray, wo: FloatArray) -> FloatArray:
        if not self.through or self.f.relative_index() == 1.0:
            return np.asarray(value)
        return np.asarray((np.asarray(value).T * radiance_to_flux(self.f, wi, wo)).T)

    def __repr__(self) -> str:
        return repr(self.f)
