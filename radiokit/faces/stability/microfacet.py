"""Microfacet: the GGX lobe where it is narrow, grazing, or sampled next to the mirror direction."""

from __future__ import annotations

from typing import Any

import numpy as np

from radiokit.bsdfs.ggx import GGX
from radiokit.faces.stability.row import Row, decades
from radiokit.facts.source import Source
from radiokit.measure.twin import Twin

__all__ = ["ROWS"]

_WALTER = GGX.SOURCE
_CAPS = Source(
    authors="Dupuy, Benyoub",
    year=2023,
    title="Sampling Visible GGX Normals with Spherical Caps. Computer Graphics Forum 42(8)",
    doi="10.1111/cgf.14867",
    equation="the cap's sampling; at normal incidence it is equation 35 of Walter et al. (2007), "
    "tanθm = α √(u/(1 − u))",
)


def _evaluated(name: str) -> Any:
    """Return ``GGX.evaluate`` or ``GGX.pdf`` as a function of six components and α."""

    def kernel(*columns: Any) -> Any:
        wi, wo = np.stack(columns[:3], axis=-1), np.stack(columns[3:6], axis=-1)
        return np.array(
            [
                getattr(GGX(alpha=float(alpha)), name)(wi[i : i + 1], wo[i : i + 1])[0]
                for i, alpha in enumerate(columns[6])
            ]
        )

    return kernel


def _textbook_parts(m: Any, c: tuple[Any, ...]) -> tuple[Any, Any, Any, Any, Any]:
    """Return D, Λ of both directions, and both cosines, as the papers print them."""
    xi, yi, zi, xo, yo, zo, alpha = c
    x, y, z = xi + xo, yi + yo, zi + zo
    cos_m = z / m.sqrt(x * x + y * y + z * z)
    root = (alpha * alpha - 1) * cos_m * cos_m + 1
    density = alpha * alpha / (m.pi * root * root)

    def smith(cosine: Any) -> Any:
        return (m.sqrt(1 + alpha * alpha * (1 - cosine * cosine) / (cosine * cosine)) - 1) / 2

    cos_i, cos_o = zi / m.sqrt(xi * xi + yi * yi + zi * zi), zo / m.sqrt(xo * xo + yo * yo + zo * zo)
    return density, smith(cos_i), smith(cos_o), cos_i, cos_o


def _value_textbook(m: Any, *columns: Any) -> Any:
    density, lambda_i, lambda_o, cos_i, cos_o = _textbook_parts(m, columns)
    return density / (1 + lambda_i + lambda_o) / (4 * cos_i * cos_o)


def _pdf_textbook(m: Any, *columns: Any) -> Any:
    density, _, lambda_o, _, cos_o = _textbook_parts(m, columns)
    return density / (1 + lambda_o) / (4 * cos_o)


def _twin(pdf: bool) -> Any:
    def twin() -> Twin:
        import sympy

        symbols = sympy.symbols("x_i y_i z_i x_o y_o z_o alpha", real=True)
        wi, wo, alpha = sympy.Matrix(symbols[:3]), sympy.Matrix(symbols[3:6]), symbols[6]

        def tan2(w: Any) -> Any:
            return (w[0] ** 2 + w[1] ** 2) / w[2] ** 2

        def cosine(w: Any) -> Any:
            return 1 / sympy.sqrt(1 + tan2(w))

        half = wi + wo
        # D as a density of slopes, P22(slope) / cos⁴.
        density = 1 / (sympy.pi * alpha**2 * (1 + tan2(half) / alpha**2) ** 2 * cosine(half) ** 4)
        root_i, root_o = (sympy.sqrt(1 + alpha**2 * tan2(w)) for w in (wi, wo))
        masked = 2 / (1 + root_o) if pdf else 2 / (root_i + root_o)
        below = 4 * cosine(wo) * (1 if pdf else cosine(wi))
        return Twin(density * masked / below, {}, symbols)

    return twin


def _near_pole(alpha: Any) -> tuple[Any, ...]:
    """Return directions about z whose half vector is off z by 0, α/4 and α/2; and α."""
    tilt = 2.0 * np.arctan(np.array([0.0, 0.25, 0.5]) * alpha)
    return np.sin(tilt), 0.0, np.cos(tilt), 0.0, 0.0, 1.0, alpha


def _grazing(elevation: Any) -> tuple[Any, ...]:
    x, z = np.cos(elevation), np.sin(elevation)
    return -x, 0.0, z, x, 0.0, z, np.array([1.1e-4, 0.01])


def _sample(u: Any, alpha: Any) -> Any:
    zero = 0.0 * u[:1]
    wo = np.stack((zero, zero, zero + 1), axis=-1)
    return np.array(
        [
            GGX(alpha=float(a)).sample(np.stack((u[i : i + 1], zero), axis=-1), wo)[0][0, 0]
            for i, a in enumerate(alpha)
        ]
    )


def _sample_textbook(m: Any, u: Any, alpha: Any) -> Any:
    cosine = (1 - u) * 2 - 1
    x, z = alpha * m.sqrt(1 - cosine * cosine), cosine + 1
    return 2 * x * z / (x * x + z * z)


def _sample_twin() -> Twin:
    import sympy

    u, alpha = symbols = sympy.symbols("u alpha", positive=True)
    return Twin(sympy.sin(2 * sympy.atan(alpha * sympy.sqrt(u / (1 - u)))), {}, symbols)


ROWS = (
    Row(
        name="ggx-narrow-lobe",
        title="GGX value of a nearly smooth metal, near its peak",
        axis="α [1]",
        values=(1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1.1e-4),
        inputs=_near_pole,
        kernel=_evaluated("evaluate"),
        textbook=_value_textbook,
        twin=_twin(pdf=False),
        kernel_name="radiokit.bsdfs.ggx.GGX.evaluate",
        kernel_form="D = ((h⊥² + h_z²) / (h⊥²/α + α h_z²))² / π, h not normalised",
        textbook_form="D = α² / (π ((α² − 1) cos²θ + 1)²)",
        lesson="At the peak, cos θ is 1 and (α² − 1) + 1 has to give α² back: it comes back with an error "
        "of ε, so D is wrong by ε/α², in float32 by more than itself for α below 2·10⁻⁴. Written as "
        "α² cos²θ + sin²θ it is a sum of positive terms, if the sine comes from the vector and not "
        "from the cosine.",
        source=_WALTER,
    ),
    Row(
        name="ggx-pdf-grazing",
        title="Density of visible GGX normals at grazing incidence, mirror direction",
        axis="elevation [rad]",
        values=decades(0, -6),
        inputs=_grazing,
        kernel=_evaluated("pdf"),
        textbook=_pdf_textbook,
        twin=_twin(pdf=True),
        kernel_name="radiokit.bsdfs.ggx.GGX.pdf",
        kernel_form="D / (2 (cosθ + √(α² sin²θ + cos²θ)))",
        textbook_form="G₁ D / (4 cosθ), Λ = (√(1 + α² tan²θ) − 1)/2, tan²θ = (1 − cos²θ)/cos²θ",
        lesson="At 89.9999° G₁ tends to 0 and is divided by a cosine that does so too; multiplied out, "
        "cosine and root add, and neither vanishing number is formed. What fails in print is D "
        "again: its (α² − 1) + 1 is in every density that a sampler reports.",
        source=_WALTER,
    ),
    Row(
        name="ggx-sample-mirror",
        title="GGX sample next to the mirror direction",
        axis="u [1]",
        values=decades(-1, -18),
        inputs=lambda u: (u, np.array([1.0, 1e-3])),
        kernel=_sample,
        textbook=_sample_textbook,
        twin=_sample_twin,
        kernel_name="radiokit.bsdfs.ggx.GGX.sample",
        kernel_form="radius √(u (1 + z) ((1 − u)(1 + z) + sin²θ/(1 + z)))",
        textbook_form="c = (1 − u)(1 + z) − z, radius √(1 − c²)",
        lesson="The height of a point on the cap is 1 up to rounding when u is small, and its distance from "
        "the axis is then made of that rounding: the innermost samples fall on rings. The radius is "
        "√u to begin with; it needs no height.",
        source=_CAPS,
    ),
)
