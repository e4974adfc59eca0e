"""Scalar models: a BSDF written for one pair of directions at a time, as three kernels."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from radiokit.contracts.bsdf import BSDF, FloatArray
from radiokit.measure.kernels import Kernel, last
from radiokit.measure.passes import run

__all__ = ["Kernels", "ScalarBSDF"]


@dataclass(frozen=True)
class Kernels:
    """A model's arithmetic, for numbers: x, y, z of wi (``ix, iy, iz``) and of wo (``ox, oy, oz``).

    Parameters
    ----------
    value : Kernel
        ``value(ix, iy, iz, ox, oy, oz, *constants)`` is f(wi, wo) [sr⁻¹].
    density : Kernel
        ``density(ix, iy, iz, ox, oy, oz, *constants)`` is the pdf [sr⁻¹] of ``sample``.
    sample : Kernel
        ``sample(u0, u1, ox, oy, oz, *constants)``, with ``u2`` too for three dimensions, returns x, y, z of
        wi and its weight. It is a unit vector for every wo, below the horizon too.
    constants : tuple of float or ndarray
        The parameters, in the order in which all three take them. An array (K,) has one number a
        wavelength: values and weights then have the shape (N, K). Directions may not depend on it.
    """

    value: Kernel
    density: Kernel
    sample: Kernel
    constants: tuple[Any, ...] = ()


class ScalarBSDF(BSDF):
    """A BSDF that is three kernels: few directions are given to NumPy, many to machine code."""

    @abstractmethod
    def kernels(self) -> Kernels:
        """Return the kernels and their constants, for these parameters."""

    def evaluate(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return f(wi, wo) [sr⁻¹]."""
        found = self.kernels()
        return run(found.value, _pair(wi, wo), found.constants)

    def pdf(self, wi: FloatArray, wo: FloatArray) -> FloatArray:
        """Return the density [sr⁻¹] with which ``sample`` picks ``wi``."""
        found = self.kernels()
        return run(found.density, _pair(wi, wo), found.constants)

    def sample(self, u: FloatArray, wo: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ``wi`` (N, 3), and ``weight = f |cos θi| / pdf``."""
        found = self.kernels()
        u, wo = np.asarray(u, dtype=np.float64), np.broadcast_to(wo, (len(u), 3))
        x, y, z, weight = run(found.sample, (*np.ascontiguousarray(u.T), *_columns(wo)), found.constants)
        return np.stack((x, y, z), axis=-1), weight

    def weight_kernel(self, wo: FloatArray) -> tuple[Kernel, tuple[float, ...]] | None:
        """Return the weight of ``sample`` as a kernel of the uniform numbers; None for a spectrum."""
        found = self.kernels()
        if any(np.ndim(value) for value in found.constants):
            return None
        return last(found.sample), (*map(float, wo), *map(float, found.constants))


def _pair(wi: FloatArray, wo: FloatArray) -> tuple[Any, ...]:
    """Return the six columns; a direction that is the same in every row is three numbers."""
    if wi.shape != wo.shape:
        wi, wo = np.broadcast_arrays(wi, wo)
    columns = (*_columns(wi), *_columns(wo))
    return columns if any(np.ndim(c) for c in columns) else (*np.ascontiguousarray(wi.T), *columns[3:])


def _columns(w: FloatArray) -> tuple[Any, ...]:
    if len(w) and w.strides[0] == 0:
        return tuple(w[0].tolist())
    return tuple(np.ascontiguousarray(w.T))
