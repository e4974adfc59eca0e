"""Peer: what the bench asks of another way to compute the directional albedo of GGX with F = 1."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import ClassVar

from radiokit.faces.bench.tasks import ggx_albedo
from radiokit.facts.estimate import Estimate

__all__ = ["Peer", "mean_of"]


class Peer(ABC):
    """Another implementation of the albedo of GGX, at a width α and a polar angle."""

    name: ClassVar[str]
    rival: ClassVar[str]
    """The method of ``radiokit.albedo`` that it is compared with: ``mc`` or ``quadrature``."""

    most: ClassVar[float] = math.inf
    """Samples that it has the memory for."""

    note: ClassVar[str] = ""
    """What must be known to read its errors."""

    def absent(self) -> str | None:
        """Return why it cannot run here, and what would help; None when it can."""
        return None

    @abstractmethod
    def answer(self, alpha: float, theta_deg: float, size: float, seed: int) -> Estimate:
        """Return the albedo from ``size`` samples, or to the relative tolerance ``size``."""

    def truth(self, alpha: float, theta_deg: float) -> float:
        """Return the true value of what it computes."""
        return ggx_albedo(alpha, theta_deg)[0]


def mean_of(total: float, squares: float, samples: int, method: str) -> Estimate:
    """Return the mean and its standard error from a sum and a sum of squares.

    >>> print(mean_of(50.0, 50.0, 100, "a coin"))
    0.500 ± 0.050 (standard error)
    """
    value = total / samples
    variance = max(squares / samples - value * value, 0.0) / (samples - 1)
    return Estimate(value, variance**0.5, "statistical", samples, method=method)
