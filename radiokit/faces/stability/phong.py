"""Phong: cosⁿα for large n, evaluated and sampled."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.bsdfs.phong import Phong
from radiokit.faces.stability.row import Row
from radiokit.measure.twin import Twin

__all__ = ["ROWS"]

_EXPONENTS = (1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6)


def _lobe(xi: Any, yi: Any, zi: Any, xo: Any, yo: Any, zo: Any, n: Any) -> Any:
    wi, wo = np.stack((xi, yi, zi), axis=-1), np.stack((xo, yo, zo), axis=-1)
    return np.array(
        [Phong(exponent=float(k)).evaluate(wi[i : i + 1], wo[i : i + 1])[0] for i, k in enumerate(n)]
    )


def _lobe_textbook(m: Any, xi: Any, yi: Any, zi: Any, xo: Any, yo: Any, zo: Any, n: Any) -> Any:
    lengths = m.sqrt(xi * xi + yi * yi + zi * zi) * m.sqrt(xo * xo + yo * yo + zo * zo)
    cosine = (zi * zo - xi * xo - yi * yo) / lengths
    return (n + 2) / (2 * m.pi) * cosine**n


def _lobe_twin() -> Twin:
    import sympy

    symbols = sympy.symbols("x_i y_i z_i x_o y_o z_o n", real=True)
    wi, mirror = sympy.Matrix(symbols[:3]), sympy.Matrix([-symbols[3], -symbols[4], symbols[5]])
    across, n = wi.cross(mirror), symbols[6]
    tan2 = across.dot(across) / wi.dot(mirror) ** 2
    return Twin((n + 2) / (2 * sympy.pi) * sympy.exp(-n / 2 * sympy.log(1 + tan2)), {}, symbols)


def _about_mirror(n: Any) -> tuple[Any, ...]:
    """Return viewers on the normal and off it, and light a tenth of the lobe's width from the mirror."""
    theta, alpha = np.array([0.0, 0.7]), 0.1 / np.sqrt(n)
    return np.sin(theta + alpha), 0.0, np.cos(theta + alpha), -np.sin(theta), 0.0, np.cos(theta), n


def _sine(u: Any, n: Any) -> Any:
    zero = 0.0 * u[:1]
    wo = np.stack((zero, zero, zero + 1), axis=-1)
    return np.array(
        [
            Phong(exponent=float(k)).sample(np.stack((u[i : i + 1], zero), axis=-1), wo)[0][0, 0]
            for i, k in enumerate(n)
        ]
    )


def _sine_textbook(m: Any, u: Any, n: Any) -> Any:
    cosine = (1 - u) ** (1 / (n + 1))
    return m.sqrt(1 - cosine * cosine)


def _sine_twin() -> Twin:
    import sympy

    u, n = symbols = sympy.symbols("u n", positive=True)
    return Twin(sympy.sqrt(1 - sympy.exp(2 * sympy.log(1 - u) / (n + 1))), {}, symbols)


ROWS = (
    Row(
        name="phong-narrow-lobe",
        title="Phong's cosⁿα for a large exponent, near the mirror direction",
        axis="exponent n [1]",
        values=_EXPONENTS,
        inputs=_about_mirror,
        kernel=_lobe,
        textbook=_lobe_textbook,
        twin=_lobe_twin,
        kernel_name="radiokit.bsdfs.phong.Phong.evaluate",
        kernel_form="exp(n log1p(−|r − wi|²/2))",
        textbook_form="(r·wi)ⁿ",
        lesson="A power multiplies the relative error of its base by n, and the base, a cosine next to 1, "
        "was rounded to ε: five digits go at n = 10⁶, and in float32 two are left. The square of the "
        "distance between wi and r holds what the cosine lost, and log1p takes it without adding it "
        "to 1.",
        source=Phong.SOURCE,
    ),
    Row(
        name="phong-sample",
        title="Sample of a narrow Phong lobe",
        axis="exponent n [1]",
        values=_EXPONENTS,
        inputs=lambda n: (np.array([0.5, 1e-3]), n),
        kernel=_sine,
        textbook=_sine_textbook,
        twin=_sine_twin,
        kernel_name="radiokit.bsdfs.phong.Phong.sample",
        kernel_form="sin α = √(−expm1(2 log1p(−u)/(n + 1)))",
        textbook_form="cos α = (1 − u)^(1/(n + 1)), sin α = √(1 − cos²α)",
        lesson="The n-th root of a number is next to 1, and one minus its square is mostly rounding. expm1 "
        "computes eˣ − 1 without ever forming eˣ: the subtraction is done in the series.",
        source=Phong.SOURCE,
    ),
)
