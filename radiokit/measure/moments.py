"""Moments: count, mean, variance and range of values that are not kept."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError

__all__ = ["Moments"]

_UNDERFLOW = 1e-280  # sums of squares below this may have lost terms


@dataclass(frozen=True)
class Moments:
    """Count, mean and sum of squared deviations of values that need not be kept, with their range.

    Batches are merged by the pairwise update, which keeps the digits of a variance that is small beside
    the mean, as the sum of squares does not. All but ``count`` are scalars or have shape ``(K,)``.

    Source: Chan, Golub, LeVeque (1983), Algorithms for computing the sample variance, The American
    Statistician 37(3), doi:10.1080/00031305.1983.10483115: the corrected two-pass algorithm within a batch,
    the pairwise update between batches.

    >>> moments = Moments.of([1e9, 1e9 + 2]).merge(Moments.of([1e9 + 1]))
    >>> float(moments.mean - 1e9), float(moments.variance)
    (1.0, 1.0)
    """

    count: int
    mean: Any
    m2: Any
    low: Any
    high: Any

    @classmethod
    def of(cls, values: npt.ArrayLike) -> Moments:
        """Return the moments of ``values``, shape ``(n,)`` or ``(n, K)`` with n ≥ 1."""
        x = np.asarray(values, dtype=np.float64)
        if x.ndim not in (1, 2) or not len(x):
            raise ParameterError("values", x, "of shape (n,) or (n, K) with n at least 1")
        # About a value of the sample, so that a constant has exactly its own mean and no variance.
        offset = x - x[0]
        shift = np.mean(offset, axis=0)
        offset -= shift
        residue = np.sum(offset, axis=0)
        m2 = np.sum(offset * offset, axis=0) - residue * residue / len(x)
        return cls(len(x), x[0] + shift, np.maximum(m2, 0.0), np.min(x, axis=0), np.max(x, axis=0))

    def merge(self, other: Moments) -> Moments:
        """Return the moments of both batches together."""
        count = self.count + other.count
        delta = other.mean - self.mean
        return Moments(
            count,
            self.mean + delta * (other.count / count),
            self.m2 + other.m2 + delta * delta * (self.count * (other.count / count)),
            np.minimum(self.low, other.low),
            np.maximum(self.high, other.high),
        )

    @property
    def variance(self) -> Any:
        """The unbiased sample variance; infinite for a single value."""
        return self.m2 / (self.count - 1) if self.count > 1 else np.full_like(self.m2, np.inf)[()]

    @property
    def standard_error(self) -> Any:
        """The standard error of the mean; its largest possible value where the squares underflow."""
        most = 0.5 * (self.high - self.low) / np.sqrt(max(1, self.count - 1))
        return np.where(self.m2 < _UNDERFLOW, most, np.sqrt(self.variance / self.count))[()]

    @property
    def dominance(self) -> Any:
        """The share of the variance that comes from the one sample farthest from the mean."""
        farthest = np.maximum(self.high - self.mean, self.mean - self.low)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.m2 > 0, np.minimum(farthest * farthest / self.m2, 1.0), 0.0)[()]
