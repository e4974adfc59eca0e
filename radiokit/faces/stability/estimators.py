"""Estimators: sums of many terms that nearly cancel, in statistics and in a closed form."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.bsdfs.phong import Phong
from radiokit.faces.stability.row import Row, decades
from radiokit.facts.source import Source
from radiokit.measure.moments import Moments
from radiokit.measure.twin import Twin
from radiokit.worlds.cases.furnace import phong_albedo

__all__ = ["ROWS"]

_OFFSETS = (-192.3, 64.7, 256.1, -64.9, 320.3, -128.7, 0.1, 128.9)
_EVEN = (2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0)
_CHAN = Source(
    authors="Chan, Golub, LeVeque",
    year=1983,
    title="Algorithms for computing the sample variance. The American Statistician 37(3)",
    doi="10.1080/00031305.1983.10483115",
    equation="the corrected two-pass algorithm, and the pairwise update",
)


def _variance(*columns: Any) -> Any:
    """Return the variance of the columns at each point: two batches of half of them, merged."""
    values = np.stack(columns)
    half = len(values) // 2
    return Moments.of(values[:half]).merge(Moments.of(values[half:])).variance


def _variance_textbook(m: Any, *columns: Any) -> Any:
    total = squares = 0
    for x in columns:
        total, squares = total + x, squares + x * x
    return (squares - total * total / len(columns)) / (len(columns) - 1)


def _variance_twin() -> Twin:
    import sympy

    symbols = sympy.symbols(f"x_1:{len(_OFFSETS) + 1}", real=True)
    pairs = sum((a - b) ** 2 for i, a in enumerate(symbols) for b in symbols[:i])
    return Twin(pairs / (len(symbols) * (len(symbols) - 1)), {}, symbols)


def _albedo(n: Any, theta_deg: Any) -> Any:
    return np.array([phong_albedo(int(k), float(t)) for k, t in zip(n, theta_deg, strict=True)])


def _albedo_textbook(m: Any, n: Any, theta_deg: Any) -> Any:
    if np.ndim(n):
        one = n.dtype.type
        return np.array([_albedo_sum(np, k, t, one) for k, t in zip(n, theta_deg, strict=True)])
    return _albedo_sum(m, n, theta_deg, m.mpf)


def _albedo_sum(m: Any, n: Any, theta_deg: Any, number: Any) -> Any:
    """Expand (1 − s²)^(n/2) by the binomial theorem and integrate term by term."""
    half = int(n) // 2
    cosine, sine2 = m.cos(theta_deg * m.pi / 180), m.sin(theta_deg * m.pi / 180) ** 2
    total, term = number(0), number(1)
    latitude = number(int(n) + 2) / 2
    for k in range(half + 1):
        total = total + term * (cosine ** (2 * k + 1) + 1) / (2 * k + 1)
        term = -term * (half - k) / (k + 1)
    for k in range(half + 1):
        latitude = latitude * number(2 * k + 1) / number(2 * k + 2)
    return latitude * (cosine * total + sine2 ** (half + 1) / (int(n) + 1))


def _albedo_twin() -> Twin:
    import sympy

    n, theta = symbols = sympy.symbols("n theta", positive=True)
    beta = theta * sympy.pi / 180
    branches = [(_albedo_fourier(int(k), beta), n < k + 1) for k in _EVEN]
    return Twin(sympy.Piecewise(*branches), {}, symbols)


def _albedo_fourier(n: int, beta: Any) -> Any:
    """Return the albedo for one exponent, from the Fourier series of cosⁿχ against cos(χ + β)."""
    import sympy

    def primitive(j: int, chi: Any) -> Any:
        up, down = 2 * j + 1, 2 * j - 1
        return sympy.sin(up * chi + beta) / (2 * up) + sympy.sin(down * chi - beta) / (2 * down)

    total = sympy.S.Zero
    for j in range(n // 2 + 1):
        weight = sympy.binomial(n, n // 2 - j) * (2 if j else 1) / sympy.Integer(2) ** n
        total += weight * (primitive(j, sympy.pi / 2 - beta) - primitive(j, -sympy.pi / 2))
    return total * (n + 2) * sympy.binomial(n + 2, n // 2 + 1) / sympy.Integer(2) ** (n + 3)


ROWS = (
    Row(
        name="variance-large-mean",
        title="Variance of samples far from 0",
        axis="mean [1]",
        values=decades(0, 9),
        inputs=lambda mean: tuple(mean + offset for offset in _OFFSETS),
        kernel=_variance,
        textbook=_variance_textbook,
        twin=_variance_twin,
        kernel_name="radiokit.measure.montecarlo.Moments",
        kernel_form="Σ(x − x̄)² − (Σ(x − x̄))²/n in a batch, pairwise between batches",
        textbook_form="(Σx² − (Σx)²/n) / (n − 1)",
        lesson="Both sums are as large as n x̄², and their difference is the variance: with a mean of 10⁹ "
        "and a spread of 10² thirteen of the digits of each are alike. The standard error of a Monte "
        "Carlo mean is then noise, or the root of a negative number. Subtract the mean first: the "
        "differences are exact.",
        source=_CHAN,
    ),
    Row(
        name="phong-furnace",
        title="Albedo of a Phong lobe in closed form",
        axis="exponent n, even [1]",
        values=_EVEN,
        inputs=lambda n: (n, np.array([0.0, 45.0, 80.0])),
        kernel=_albedo,
        textbook=_albedo_textbook,
        twin=_albedo_twin,
        kernel_name="radiokit.worlds.cases.furnace.phong_albedo",
        kernel_form="∫ cosᵐχ dχ by parts, from m = 1 up: every term is positive",
        textbook_form="Σ (−1)ᵏ C(n/2, k) (1 + cos²ᵏ⁺¹θ) / (2k + 1)",
        lesson="Expanding (1 − s²)^(n/2) is exact algebra and hopeless arithmetic: binomial coefficients of "
        "size 2^(n/2) alternate in sign and add up to less than 1, so about n/2 bits go. A closed "
        "form is worth no more than the order in which it is summed.",
        source=Phong.SOURCE,
    ),
)
