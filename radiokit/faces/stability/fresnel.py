"""Fresnel: reflectances that nearly vanish."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.faces.stability.row import Row, decades
from radiokit.measure.twin import Twin
from radiokit.physics import fresnel

__all__ = ["ROWS"]


def _conductor_textbook(m: Any, c: Any, eta: Any, k: Any) -> Any:
    c2, s2 = c * c, 1 - c * c
    t0 = eta * eta - k * k - s2
    squares = m.sqrt(t0 * t0 + 4 * eta * eta * k * k)  # a² + b²
    a = m.sqrt((squares + t0) / 2)
    t1, t2 = squares + c2, 2 * a * c
    r_s = (t1 - t2) / (t1 + t2)
    t3, t4 = c2 * squares + s2 * s2, t2 * s2
    return (r_s + r_s * (t3 - t4) / (t3 + t4)) / 2


def _conductor_twin() -> Twin:
    import sympy

    symbols = sympy.symbols("c eta k", positive=True)
    return Twin(fresnel.conductor_symbolic(*symbols), {}, symbols)


def _dielectric_textbook(m: Any, c: Any, eta: Any) -> Any:
    t = m.sqrt(1 - (1 - c * c) / (eta * eta))
    r_s, r_p = (c - eta * t) / (c + eta * t), (eta * c - t) / (eta * c + t)
    return (r_s * r_s + r_p * r_p) / 2


def _dielectric_twin() -> Twin:
    import sympy

    symbols = sympy.symbols("c eta", positive=True)
    return Twin(fresnel.conductor_symbolic(*symbols, sympy.S.Zero), {}, symbols)


ROWS = (
    Row(
        name="conductor-thin-absorber",
        title="Reflectance of an absorber whose index is nearly 1",
        axis="extinction k [1]",
        values=decades(0, -12),
        inputs=lambda k: (np.array([1.0, 0.75, 0.1]), 1.0, k),
        kernel=fresnel.conductor,
        textbook=_conductor_textbook,
        twin=_conductor_twin,
        kernel_name="radiokit.physics.fresnel.conductor",
        kernel_form="|(η + ik)² − 1|² / |cos θ + q|⁴, with q² = (η + ik)² − sin²θ",
        textbook_form="(a² + b² + cos²θ − 2a cos θ) / (a² + b² + cos²θ + 2a cos θ), and so for p",
        lesson="The reflectance of a smoke whose index is 1 goes with k², but the numerator subtracts numbers "
        "near 2 and is left with ε: below k = √ε a gas would shine, or have a negative reflectance. The same "
        "numerator is |n² − 1|² over a sum of squares, and η − 1 is an exact difference.",
        source=fresnel.CONDUCTOR_SOURCE,
    ),
    Row(
        name="dielectric-index-matched",
        title="Reflectance between nearly equal indices (hard for every formula)",
        axis="η − 1 [1]",
        values=tuple(2.0**-k for k in range(1, 22, 2)),
        inputs=lambda d: (np.array([1.0, 0.75]), 1.0 + d),
        kernel=fresnel.dielectric,
        textbook=_dielectric_textbook,
        twin=_dielectric_twin,
        kernel_name="radiokit.physics.fresnel.dielectric",
        kernel_form="|a² − b²| / (a + b)², the difference of squares from (n_t − n_i)(n_t + n_i)",
        textbook_form="((cos θ − η cos θt) / (cos θ + η cos θt))², and so for p",
        lesson="The textbook's digits go, one for each that η shares with 1, but so does what η says: its last bit "
        "is 2/(η − 1) last bits of the reflectance. By the condition number the textbook is without fault. "
        "Where the index is exact, as in a test, the difference of squares still gives every digit.",
        source=fresnel.DIELECTRIC_SOURCE,
        fails=(),
    ),
)
