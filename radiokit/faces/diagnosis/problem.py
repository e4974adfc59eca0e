"""Problem: a student's numbers beside the right ones, the inputs of both, and how close is close enough."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from statistics import NormalDist
from typing import Any

import numpy as np
import numpy.typing as npt

from radiokit.facts.errors import ParameterError
from radiokit.measure.statistics import sidak

__all__ = ["LEVEL", "SHARE", "Array", "Problem", "canonical", "columns"]

Array = npt.NDArray[np.float64]

SHARE = 0.95
"""The share of the inputs that an explanation must reach."""

ROUNDING = 1e-13
"""What of the reference's size rounding may add to an answer, however small the answer is."""

LEVEL = 0.01
"""The probability that sampled answers which an explanation fits are said not to fit it."""

_ALIASES = {
    "cos": "cosine",
    "cos_theta": "cosine",
    "d": "distance",
    "r": "distance",
    "n": "exponent",
    "N": "samples",
    "domega": "solid_angle",
    "cos_light": "cosine_light",
}
_VECTORS = ("wi", "wo")


def columns(inputs: Mapping[str, Any], count: int) -> dict[str, Array]:
    """Return the inputs, each with one row for each of ``count`` answers.

    >>> columns({"distance": 2}, 3)["distance"]
    array([2., 2., 2.])
    """
    if not isinstance(inputs, Mapping):
        raise ParameterError("inputs", inputs, "a mapping of names to numbers, such as {'theta': [0.1, 0.2]}")
    result = {}
    for name, given in inputs.items():
        shape = (count, 3) if name in _VECTORS else (count,)
        try:
            result[name] = np.broadcast_to(np.asarray(given, dtype=float), shape)
        except (TypeError, ValueError):
            raise ParameterError(
                f"inputs[{name!r}]", given, f"numbers that broadcast to {shape}, one row an answer"
            ) from None
        if not np.all(np.isfinite(result[name])):
            raise ParameterError(f"inputs[{name!r}]", given, "finite")
    return result


def canonical(given: Mapping[str, Array]) -> dict[str, Array]:
    """Return inputs under the names that the catalogue uses, with what follows from them.

    An angle gives its cosine and sine, a cosine its angle, and ``wi`` the cosine at the surface.

    >>> sorted(canonical({"cos": np.array([0.6])}))
    ['cosine', 'sine', 'theta']
    """
    found = {_ALIASES.get(name, name): values for name, values in given.items()}
    if "theta" not in found and "theta_deg" in found:
        found["theta"] = np.radians(found["theta_deg"])
    if "theta" in found:
        found.setdefault("cosine", np.cos(found["theta"]))
        found.setdefault("sine", np.sin(found["theta"]))
    if "wi" in found:
        found.setdefault("cosine", found["wi"][:, 2])
        found.setdefault("sine", np.hypot(found["wi"][:, 0], found["wi"][:, 1]))
    if "cosine" in found:
        c = found["cosine"]
        found.setdefault("sine", np.sqrt(np.clip((1 - c) * (1 + c), 0, None)))
        found.setdefault("theta", np.arctan2(found["sine"], c))
    return found


@dataclass(frozen=True)
class Problem:
    """What an entry of the catalogue sees: finite answers, the reference, and the inputs.

    Parameters
    ----------
    answer, reference : (N,) arrays
        In the same unit, at the same inputs.
    given : mapping of arrays
        The inputs by the caller's names; ``inputs`` has them by the catalogue's.
    variants : callable or mapping or None
        The reference at other inputs, ``variants(**inputs)``; or values (N,) by the name of what yields them.
    error : (N,) array
        Standard errors of the answers, 0 where they are not sampled.
    rtol : float
        The relative deviation that rounding explains.
    index, lost : (N,) and (M,) arrays of int
        Where these answers stand among all that were given, and which of those were NaN or infinite.
    """

    answer: Array
    reference: Array
    given: Mapping[str, Array]
    variants: Callable[..., Any] | Mapping[str, Any] | None
    error: Array
    rtol: float
    index: npt.NDArray[np.intp]
    lost: npt.NDArray[np.intp]

    @cached_property
    def inputs(self) -> dict[str, Array]:
        """The inputs by the catalogue's names."""
        return canonical(self.given)

    def variant(self, **changes: Array) -> Array:
        """Return the reference at changed inputs; only where ``variants`` is a function."""
        assert callable(self.variants)
        values = np.asarray(self.variants(**{**self.given, **changes}), dtype=float)
        if values.shape != self.answer.shape:
            raise ParameterError("variants", self.variants, f"returning shape {self.answer.shape}")
        return values

    @cached_property
    def scale(self) -> float:
        """The size by which absolute rounding is judged: of the largest number of the reference.

        Where numbers lie so far apart that its rounding would hide half of them, it is that of the middle.
        """
        size = np.abs(self.reference[self.reference != 0])
        largest, middle = (float(np.max(size)), float(np.median(size))) if size.size else (0.0, 0.0)
        return largest if middle > ROUNDING * largest else middle

    @property
    def sampled(self) -> bool:
        """Whether any answer has a standard error."""
        return bool(np.any(self.error > 0))

    @cached_property
    def _z(self) -> float:
        return -NormalDist().inv_cdf(sidak(LEVEL, max(self.answer.size, 1)) / 2)

    def tolerance(self, values: Array, slack: float = 0.0) -> Array:
        """Return how far an answer may lie from ``values`` by rounding and chance."""
        rounding = max(self.rtol, slack) * np.abs(values) + ROUNDING * self.scale
        return rounding + self._z * self.error

    def close(self, values: Array, slack: float = 0.0) -> npt.NDArray[np.bool_]:
        """Return where the answer is ``values``."""
        close: npt.NDArray[np.bool_] = np.abs(self.answer - values) <= self.tolerance(values, slack)
        return close

    def misfit(self, values: Array) -> float:
        """Return χ² of the answers about ``values``, 0 where none is sampled."""
        if not self.sampled:
            return 0.0
        spread = np.hypot(self.error, self.rtol * np.abs(values) + ROUNDING * self.scale + 1e-300)
        return float(np.sum(((self.answer - values) / spread) ** 2))

    def share(self, values: Array, slack: float = 0.0) -> float:
        """Return the share of the telling inputs, those not 0 throughout, at which the answer is ``values``.

        What is below the rounding of the reference counts as 0. Sampled answers must fit together: 0 where
        the sum of z² over all is too large.
        """
        least = ROUNDING * self.scale
        telling = (np.abs(values) > least) | (np.abs(self.answer) > least) | (np.abs(self.reference) > least)
        if not telling.any() or not np.all(np.isfinite(values)):
            return 0.0
        share = float(np.mean(self.close(values, slack)[telling]))
        if share < SHARE or not self.sampled:
            return share
        from scipy.special import gammaincc

        p_value = gammaincc(np.count_nonzero(telling) / 2, self.misfit(values) / 2)
        return share if p_value > LEVEL / 10 else 0.0

    def agrees(self, values: Array) -> bool:
        """Return whether the answer is ``values`` everywhere."""
        return bool(np.all(self.close(values))) and (
            not self.sampled or not values.any() or self.share(values) > 0
        )

    def varies(self, values: Array) -> bool:
        """Return whether ``values`` differ by more than rounding and chance could."""
        spread = self.tolerance(values)
        return bool(np.ptp(values) > 4 * np.max(spread)) if values.size else False

    def resolution(self, values: Array) -> float:
        """Return the relative uncertainty of a factor fitted to all answers."""
        size = np.maximum(np.abs(values), ROUNDING * self.scale + 1e-300)
        return self.rtol + 2 * float(np.median(self.error / size)) / math.sqrt(max(values.size, 1))
